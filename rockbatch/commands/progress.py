"""Progress of a batch: a bar with the time remaining on a terminal, plain lines elsewhere."""

import io
import os
import sys
import time
from types import TracebackType
from typing import Any, Self, TextIO

from rockbatch.commands.streams import give_up, tell

SECONDS_BETWEEN_LINES = 2.0


class Progress:
    """Progress of a batch: call it with the number of runs that are finished since the last call; use it as a context."""

    def __init__(self, total: int, stream: TextIO | None = None) -> None:
        self.total = total
        self.done = 0
        self.stream = stream or sys.stderr or io.StringIO()
        self.started = time.monotonic()
        self.last_line = self.started
        self.bar: Any = None
        if _can_draw(self.stream):
            from tqdm import tqdm

            self.bar = tqdm(total=total, unit="run", file=self.stream, dynamic_ncols=True, leave=False)

    def __enter__(self) -> Self:
        return self

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
            tell(self.stream, f"{self.done} of {self.total} runs, {remaining:.0f} s left")


def _can_draw(stream: TextIO) -> bool:
    """Return whether ``stream`` is a terminal that has a size; some that are made by programs have none."""
    return stream.isatty() and min(os.get_terminal_size(stream.fileno())) > 0
