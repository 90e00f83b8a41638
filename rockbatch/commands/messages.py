"""Messages of a batch on the terminal, and its progress."""

import io
import os
import sys
import time
from contextlib import AbstractContextManager
from types import TracebackType
from typing import Any, TextIO

from rockbatch.batch.listening import Advance, Listener, count
from rockbatch.commands.streams import give_up, say, tell
from rockbatch.motions import MotionSet

SECONDS_BETWEEN_LINES = 2.0


class Terminal(Listener):
    """Listener that prints on stderr what it hears of a batch."""

    def motions(self, motion_set: MotionSet) -> None:
        """Print which files are not used and why, and how many are left out."""
        for file in motion_set.unusable:
            say(f"not used: {file.source}: {file.reason}")
        for first, repeat in _twice(motion_set):
            say(f"{first} and {repeat} have the same samples: checks count them once, curves twice; leave one out")
        if lacking := [motion.named for motion in motion_set.motions if motion.lacks_vertical]:
            say(f"no vertical: {'; '.join(lacking)}")
        if motion_set.left_out:
            say(
                f"{count(len(motion_set.left_out), 'file')} left out: `rockbatch motions FOLDER` lists them and says why"
            )

    def say(self, text: str) -> None:
        """See :class:`Listener`."""
        say(text)

    def progress(self, total: int) -> AbstractContextManager[Advance]:
        """See :class:`Listener`."""
        return Progress(total)


def _twice(motions: MotionSet) -> list[tuple[str, str]]:
    """Return the names of motions with the same samples: the first, and each that repeats it."""
    first: dict[tuple[float, bytes], str] = {}
    names = [(first.setdefault((m.dt, m.horizontal.tobytes()), m.name), m.name) for m in motions.motions]
    return [(name, repeat) for name, repeat in names if name != repeat]


class Progress(AbstractContextManager["Progress"]):
    """Progress of a batch: a bar with the time remaining on a terminal, plain lines elsewhere.

    Call it with the number of runs that are finished since the last call; use it as a context.
    """

    def __init__(self, total: int, stream: TextIO | None = None) -> None:
        self.total = total
        self.done = 0
        self.stream = stream or sys.stderr or io.StringIO()
        self.started = self.last_line = time.monotonic()
        self.bar: Any = None
        # A terminal that a program makes may have no size
        if self.stream.isatty() and min(os.get_terminal_size(self.stream.fileno())) > 0:
            from tqdm import tqdm

            self.bar = tqdm(total=total, unit="run", file=self.stream, dynamic_ncols=True, leave=False)

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self.bar is not None:
            self.bar.close()

    def __call__(self, runs: int = 1) -> None:
        self.done += runs
        if self.bar is not None:
            try:
                self.bar.update(runs)
            except OSError as error:
                self.bar = None
                give_up(self.stream, error)
            return
        now = time.monotonic()
        if now - self.last_line >= SECONDS_BETWEEN_LINES:
            self.last_line = now
            remaining = (now - self.started) * (self.total - self.done) / self.done
            tell(self.stream, f"{self.done} of {count(self.total, 'run')}, {remaining:.0f} s left")
