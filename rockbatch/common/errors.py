"""Mistakes of the user, reported all at once and without a traceback, and warnings about results that are opened."""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Any


class InputError(ValueError):
    """Input that cannot be used.

    ``problems`` holds one message per mistake. Each names the place, what was found, what was expected and
    what to write instead.

    Examples
    --------
    >>> try:
    ...     rb.Pier(alpha=7.4, p=0.0)
    ... except rb.InputError as error:
    ...     for problem in error.problems:
    ...         print(problem)
    alpha = 7.4: must be below π/2 = 1.5708 rad; if it is in degrees, write 0.1292
    p = 0: must be a number above 0 [rad/s]
    """

    def __init__(self, *problems: str) -> None:
        super().__init__("\n".join(problems))
        self.problems = problems


class UnstatedError(InputError):
    """A record that lacks what its user can state; ``keys`` are those of a manifest that state it.

    ``choices`` are statements that may be meant, of which any is enough; without them all keys are needed.
    """

    def __init__(self, problem: str, *keys: str, choices: Sequence[Mapping[str, Any]] = ()) -> None:
        super().__init__(problem)
        self.keys = keys
        self.choices = choices


def remedy(name: str) -> str:
    """Return the advice on an unusual value: check the unit, or confirm it by ``name``."""
    return f'check the unit; if it is right, write confirm = ["{name}"]'


class NoRecordError(InputError):
    """A file without accelerations, such as spectra, velocities or notes; of a ``station``, if a record of it replaces it."""

    def __init__(self, problem: str, station: str = "") -> None:
        super().__init__(problem)
        self.station = station


@contextmanager
def starting_threads(otherwise: str = "") -> Iterator[None]:
    """Context manager: turn the failure to start a thread into ``InputError``, with advice besides raising the limit."""
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
