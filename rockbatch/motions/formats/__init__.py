"""Formats of records: which reader reads a file, by its suffix and its own header.

A format is a module with ``SUFFIXES``, a check of the first bytes and a reader that gives components; it
joins by a line in ``FORMATS``. No format is guessed from content alone, and ObsPy is never left to guess (see
``with_obspy``).
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from rockbatch.errors import InputError
from rockbatch.motions.component import Component
from rockbatch.motions.formats import at2, columns, knet, miniseed, sac
from rockbatch.motions.formats.record_file import ReadOptions, RecordFile
from rockbatch.motions.motion import Unusable

__all__ = ["FORMATS", "Format", "ReadOptions", "RecordFile", "has_reader", "read_record"]

_HEAD = 4096


@dataclass(frozen=True)
class Format:
    """A format: its name, suffixes in lower case, the check of the first bytes, and the reader."""

    name: str
    suffixes: frozenset[str]
    matches: Callable[[bytes], bool]
    read: Callable[[RecordFile], Sequence[Component | Unusable]]


FORMATS = (
    Format("PEER AT2", at2.SUFFIXES | columns.SUFFIXES, at2.looks_like_at2, at2.read_component),
    Format("MiniSEED", miniseed.SUFFIXES, miniseed.is_miniseed, miniseed.read_miniseed),
    Format("SAC", sac.SUFFIXES, sac.is_sac, sac.read_sac),
    Format("K-NET/KiK-net", knet.SUFFIXES, knet.is_knet, knet.read_knet),
    Format("text columns", columns.SUFFIXES, columns.is_columns, columns.read_columns),
)
"""In the order in which they are tried: an AT2 file saved as .txt is AT2, other text is columns."""


def has_reader(suffix: str) -> bool:
    """Whether files with this suffix (with its dot, any case) are records of a known format."""
    return any(suffix.lower() in known.suffixes for known in FORMATS)


def read_record(file: RecordFile) -> Sequence[Component | Unusable]:
    """Components of a file, or ``InputError`` with the reason why there are none."""
    by_suffix = [known for known in FORMATS if file.path.suffix.lower() in known.suffixes]
    for known in by_suffix:
        if known.matches(file.data[:_HEAD]):
            return known.read(file)
    if not by_suffix:
        raise InputError("not a format that rockbatch reads")
    if not file.data:
        raise InputError("the file is empty")
    raise InputError(
        f"not a {by_suffix[0].name} file, as its suffix {file.path.suffix} says: its header is another one"
    )
