"""Print messages and progress of a batch."""

import io
import os
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TextIO

from rockbatch.batch.listening import Advance, Bars, Listener, count
from rockbatch.common.grouping import grouped
from rockbatch.motions import MotionSet
from rockbatch.terminal.streams import give_up, say, tell

SECONDS_BETWEEN_LINES = 2.0
MOST_NAMES = 3
"""Most records without a vertical component that are named; the report names all."""


class Terminal(Listener):
    """Listener that prints the messages and progress of a batch on stderr."""

    def __init__(self) -> None:
        self._bars = Bars()

    def motions(self, motion_set: MotionSet) -> None:
        """Print files that are not used, records to check, repeated ones, missing vertical components, and the number of files
        left out.

        Of files or records with one reason the first is named, the others are counted.
        """
        unusable = [(file.cause, file.source, file.reason) for file in motion_set.unusable]
        doubtful = [
            (found.what, motion.named, found.text) for motion in motion_set.motions for found in motion.findings
        ]
        for words, entries in (("not used", unusable), ("to check", doubtful)):
            for (_, source, reason), *others in grouped(entries, lambda entry: entry[0]).values():
                beside = f" and {count(len(others), 'other')}" if others else ""
                say(f"{words}: {source}{beside}: {reason}")
        for first, repeat in _repeated(motion_set):
            say(f"{first} and {repeat} have the same samples: checks count them once, curves twice; leave one out")
        if lacking := [motion.named for motion in motion_set.motions if motion.lacks_vertical]:
            more = len(lacking) - MOST_NAMES
            say(f"no vertical: {'; '.join(lacking[:MOST_NAMES])}" + (f"; and {more:,} more" if more > 0 else ""))
        if motion_set.left_out:
            files = count(len(motion_set.left_out), "file")
            say(f"{files} left out: `rockbatch motions FOLDER` lists them with reasons")

    def say(self, text: str) -> None:
        """Print a message on stderr, above the bar if one is shown."""
        with self._bars.making_room():
            say(text)

    @contextmanager
    def progress(self, total: int) -> Iterator[Advance]:
        """Context manager: yield a function that takes numbers of finished runs, and shows a bar, or lines outside a terminal."""
        stream = sys.stderr or io.StringIO()
        # A pseudo-terminal may have size 0
        if not (stream.isatty() and min(os.get_terminal_size(stream.fileno())) > 0):
            yield _lines(total, stream)
            return
        with self._bars.progress(total) as advance:

            def guarded(runs: int) -> None:
                try:
                    advance(runs)
                except OSError as error:
                    give_up(stream, error)

            yield guarded


def _repeated(motions: MotionSet) -> list[tuple[str, str]]:
    """Return pairs of names of motions with the same horizontal samples and interval: the first, and one that repeats it."""
    first: dict[tuple[float, bytes], str] = {}
    names = [(first.setdefault((m.dt, m.horizontal.tobytes()), m.name), m.name) for m in motions.motions]
    return [(name, repeat) for name, repeat in names if name != repeat]


def _lines(total: int, stream: TextIO) -> Advance:
    """Return a function that takes numbers of finished runs, and every 2 s at most prints their sum and the time left [s]."""
    started = printed = time.monotonic()
    done = 0

    def advance(runs: int) -> None:
        nonlocal printed, done
        done += runs
        now = time.monotonic()
        if now - printed >= SECONDS_BETWEEN_LINES:
            printed = now
            tell(stream, f"{done} of {count(total, 'run')}, {(now - started) * (total - done) / done:.0f} s left")

    return advance
