"""Mistakes of the user, as values and by classes, and warnings about results that are opened.

A check returns a :class:`Problem` for each mistake; what raises them picks the class, that of all its problems if they share
one. So a caller catches a kind of mistake by its class, and no message is read for that:

    InputError                 input that cannot be used
    ├── UnknownKey             a key, a table or a name that is not known
    ├── MissingKey             a key that has to be written
    ├── WrongType              a value of another type than is expected
    ├── OutOfRange             a value that is impossible
    ├── Unusual                a value that is probably wrong, unless ``confirm`` names it
    ├── Contradiction          statements that exclude each other
    ├── NotFound               a file or a folder that is not there
    ├── BadSyntax              a text that is not TOML, or no text
    └── UnusableRecord         a file of a record that cannot be used
        ├── UnknownFormat      it has none of the formats that are read
        ├── NoRecord           it holds no accelerations
        ├── Truncated          it ends before its header says, or is cut
        └── Unstated           it lacks what its user can state
            ├── NoUnit         the unit of its numbers
            ├── NoStep         its sampling interval
            └── NoDirection    the direction of a component
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from typing import Any, ClassVar


@dataclass(frozen=True)
class Problem:
    """A mistake: what is wrong about a value, and where.

    Attributes
    ----------
    key : str
        The key, field or argument that it is about; empty if it is about none, or about several.
    value : object
        Its value; None if it has none.
    text : str
        What is wrong about it, what was expected, and what to write instead.
    place : str
        Where it stands: file and line, or the device.
    confirm : str
        The name in ``confirm`` that accepts the value; empty if nothing does.
    kind : type, optional
        The class of :class:`InputError` that it is.
    named : bool
        Whether key and value stand before the text, which else names them itself.

    Examples
    --------
    >>> problem = rb.Problem("width_m", 8000.0, "more than 400 m", "pier.toml:3")
    >>> print(problem)
    pier.toml:3: width_m = 8000: more than 400 m
    """

    key: str
    value: Any = field(hash=False)
    text: str
    place: str = ""
    confirm: str = ""
    kind: "type[InputError] | None" = field(default=None, compare=False)
    named: bool = True

    def __str__(self) -> str:
        """Return the problem as a sentence: place, key and value if ``named``, text, and how to confirm it if it can be."""
        parts = [self.place, self._name if self.named else "", self.text]
        return ": ".join(filter(None, parts)) + (f"; {remedy(self.confirm)}" if self.confirm else "")

    @property
    def _name(self) -> str:
        if self.value is None or not self.key:
            return self.key
        if isinstance(self.value, str):
            return f'{self.key} = "{self.value}"'
        return f"{self.key} = {self.value:g}" if isinstance(self.value, float) else f"{self.key} = {self.value}"


class InputError(ValueError):
    """Input that cannot be used.

    ``problems`` holds a :class:`Problem` for each mistake, and ``messages`` its sentence: it names the place, what was found,
    what was expected and what to write instead.

    Examples
    --------
    >>> try:
    ...     rb.Pier(alpha=7.4, p=0.0)
    ... except rb.OutOfRange as error:
    ...     for problem in error.problems:
    ...         print(problem)
    alpha = 7.4: must be below π/2 = 1.5708 rad; if it is in degrees, write 0.1292
    p = 0: must be a number above 0 [rad/s]
    """

    def __init__(self, *problems: Problem | str) -> None:
        given = (Problem("", None, problem) if isinstance(problem, str) else problem for problem in problems)
        self.problems = tuple(problem if problem.kind else replace(problem, kind=type(self)) for problem in given)
        super().__init__("\n".join(self.messages))

    @property
    def messages(self) -> tuple[str, ...]:
        """Return the problems as sentences."""
        return tuple(map(str, self.problems))


class UnknownKey(InputError):
    """A key, a table or a name that is not known."""


class MissingKey(InputError):
    """A key that has to be written."""


class WrongType(InputError):
    """A value of another type than is expected."""


class OutOfRange(InputError):
    """A value that is impossible."""


class Unusual(InputError):
    """A value that is probably wrong, unless ``confirm`` names it."""


class Contradiction(InputError):
    """Statements that exclude each other."""


class NotFound(InputError):
    """A file or a folder that is not there."""


class BadSyntax(InputError):
    """A text that is not TOML, or no text at all."""


class UnusableRecord(InputError):
    """A file of a record that cannot be used."""


class UnknownFormat(UnusableRecord):
    """A file in none of the formats that are read."""


class NoRecord(UnusableRecord):
    """A file without accelerations, such as spectra, velocities or notes; of a ``station``, if a record of it replaces it."""

    def __init__(self, *problems: Problem | str, station: str = "") -> None:
        super().__init__(*problems)
        self.station = station


class Truncated(UnusableRecord):
    """A file that ends before its header says, or in the middle of a number."""


class Unstated(UnusableRecord):
    """A record that lacks what its user can state; ``keys`` are those of a manifest that state it.

    ``choices`` are statements that may be meant, of which any is enough; without them all keys are needed.
    """

    usual_keys: ClassVar[tuple[str, ...]] = ()

    def __init__(
        self, *problems: Problem | str, keys: Sequence[str] = (), choices: Sequence[Mapping[str, Any]] = ()
    ) -> None:
        super().__init__(*problems)
        self.keys = tuple(keys) or self.usual_keys
        self.choices = choices


class NoUnit(Unstated):
    """A record whose numbers have no unit."""

    usual_keys = ("unit",)


class NoStep(Unstated):
    """A record without a sampling interval."""

    usual_keys = ("dt",)


class NoDirection(Unstated):
    """A component whose direction is not known."""


def refuse(problems: Iterable[Problem | str]) -> None:
    """Raise the problems as the most special class that all share, a plain sentence as ``InputError``; do nothing without any."""
    if problems := InputError(*problems).problems:
        lines = [(problem.kind or InputError).__mro__ for problem in problems]
        raise next(kind for kind in lines[0] if all(kind in line for line in lines))(*problems)


def placed(problems: Iterable[Problem], place: str) -> list[Problem]:
    """Return the problems with ``place`` before their own: "tendon 2" makes "tendon 2: psi = 7: …"."""
    return [replace(problem, place=": ".join(filter(None, (place, problem.place)))) for problem in problems]


def remedy(name: str) -> str:
    """Return the advice on an unusual value: to check the unit, or to write ``name`` in ``confirm``."""
    return f'check the unit; if it is right, write confirm = ["{name}"]'


@contextmanager
def starting_threads(otherwise: str = "") -> Iterator[None]:
    """Context manager: turn the failure to start a thread into ``InputError``; other errors pass.

    ``otherwise`` ends the message: advice besides raising the limit.
    """
    try:
        yield
    except RuntimeError as error:
        if "start new thread" not in str(error):
            raise
        raise InputError(
            "no more threads can be started: the number of processes is limited here (ulimit -u, or a container's limit); "
            f"allow more{otherwise}"
        ) from error


class PlainRemark(Warning):
    """A warning that the command shows in plain words, and each once."""


class Superseded(PlainRemark, DeprecationWarning):
    """A key or an argument without effect, which a later version will refuse."""


class AboutResults(PlainRemark, UserWarning):
    """A remark on a folder of results that is opened."""


class MissingColumns(AboutResults):
    """Results of an earlier version, without columns that it did not have yet."""


class EditedTable(AboutResults):
    """A table, or what an analysis has written of itself, that was edited."""
