"""Output of commands: messages on stderr, what they were asked for on stdout."""

import shutil
import sys
from contextlib import AbstractContextManager
from typing import TYPE_CHECKING

from rockbatch.batch.listening import Listener, Told, count
from rockbatch.commands.streams import tell
from rockbatch.lazy import pd

if TYPE_CHECKING:
    from rockbatch.motions import MotionSet


class Terminal(Listener):
    """Listener that prints on stderr what it hears of a batch."""

    def motions(self, found: "MotionSet") -> None:
        """See :class:`Listener`."""
        tell_motions(found)

    def say(self, text: str) -> None:
        """See :class:`Listener`."""
        say(text)

    def progress(self, total: int) -> AbstractContextManager[Told | None]:
        """See :class:`Listener`."""
        from rockbatch.commands.progress import Progress

        return Progress(total)


def say(text: str) -> None:
    """Print a message on stderr, apart from what a command was asked for."""
    tell(sys.stderr, text)


def show(text: str) -> None:
    """Print on stdout what a command was asked for."""
    tell(sys.stdout, text)


def in_width(table: "pd.DataFrame", index: bool = True) -> str:
    """Return a table as text; on a terminal its columns go below each other rather than beyond the edge."""
    width = shutil.get_terminal_size().columns if sys.stdout.isatty() else None
    return table.to_string(index=index, line_width=width)


def tell_motions(motions: "MotionSet") -> None:
    """Print which files are not used and why, and how many are left out."""
    for file in motions.unusable:
        say(f"not used: {file.source}: {file.reason}")
    for first, repeat in _twice(motions):
        say(f"{first} and {repeat} have the same samples: checks count them once, curves twice; leave one out")
    if lacking := [motion.named for motion in motions.motions if motion.lacks_vertical]:
        say(f"no vertical: {'; '.join(lacking)}")
    if motions.left_out:
        say(f"{count(len(motions.left_out), 'file')} left out: `rockbatch motions FOLDER` lists them and says why")


def _twice(motions: "MotionSet") -> list[tuple[str, str]]:
    """Return the names of motions with the same samples: the first, and each that repeats it."""
    first: dict[tuple[float, bytes], str] = {}
    pairs = []
    for motion in motions.motions:
        name = first.setdefault((motion.dt, motion.horizontal.tobytes()), motion.name)
        if name != motion.name:
            pairs.append((name, motion.name))
    return pairs
