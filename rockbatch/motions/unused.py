"""Files and records that are not used, with the reason."""

from collections.abc import Hashable
from dataclasses import dataclass, field

from rockbatch.common.errors import InputError, Truncated, UnknownFormat, Unstated, UnusableRecord
from rockbatch.motions.motion import Motion
from rockbatch.motions.sources.source import Sourced


@dataclass(frozen=True)
class Unusable(Sourced):
    """A file or component that cannot be used, with the reason; it stays in the tables as a row.

    ``label`` and ``number``, from 1, are the component's in its file; "" and 0 for the whole file. ``lacks`` has the keys of a
    manifest that would state what the file does not say. ``companion`` is the station beside whose records such files lie
    (spectra, notes), "" for any station, None for other files. ``station`` is the name under which it would count, by its header
    or its file's name, "" if unknown. ``kind`` is the class of error by which it is refused, such as ``NoUnit``. ``motion`` is
    the motion read, with its findings, if these have to be confirmed before it is used.
    """

    name: str
    sources: tuple[str, ...]
    reason: str
    label: str = ""
    lacks: tuple[str, ...] = ()
    number: int = 0
    companion: str | None = None
    station: str = ""
    kind: type[InputError] = UnusableRecord
    motion: Motion | None = field(default=None, repr=False)

    @property
    def cause(self) -> Hashable:
        """Return what files refused for one reason share: the names of gross findings, or the error and the missing keys.

        The reason itself where the class of error has several.
        """
        if self.motion is not None:
            return tuple(finding.what for finding in self.motion.findings if finding.gross)
        return (self.kind, self.lacks) if issubclass(self.kind, (Unstated, Truncated, UnknownFormat)) else self.reason

    def __str__(self) -> str:
        return f"{self.source}: {self.reason}"


@dataclass(frozen=True)
class LeftOut(Sourced):
    """A file or record that is left out on purpose, with the reason: not selected, excluded, a copy, or no record.

    It is ``named`` if a manifest or the study names it; ``station`` is the name under which it would count, if known. ``of``
    is the source of the original of a copy.
    """

    name: str
    sources: tuple[str, ...]
    reason: str
    station: str = ""
    named: bool = False
    of: str = ""

    def __str__(self) -> str:
        return f"{self.source}: {self.reason}"
