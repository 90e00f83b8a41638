"""Listeners: receivers of the messages and progress of a batch."""

import sys
import time
import warnings
from collections.abc import Callable
from contextlib import AbstractContextManager, contextmanager, nullcontext, suppress
from threading import Event, RLock, Thread, Timer
from typing import TYPE_CHECKING, Any

from rockbatch.common.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rockbatch.motions import MotionSet
    from rockbatch.study import Study

PATIENCE_S = 1.5
"""Time [s] after which a listener receives a message on a slow step."""

Advance = Callable[[int], object]
"""Called with the number of items finished since the last call."""

MOVES_S = 0.5
"""Time [s] after which a bar is redrawn even if nothing was finished."""

SHORT = 1.0
"""Delay [s] before a bar appears, unless one was requested."""


def silent(done: int) -> None:
    """Ignore finished items."""


class Listener:
    """Receiver of the messages of a batch; this one ignores them."""

    def motions(self, motion_set: "MotionSet") -> None:
        """Receive the motions that were read, and the files that could not be used."""

    def say(self, text: str) -> None:
        """Receive a sentence about the state of the batch."""

    def progress(self, total: int) -> AbstractContextManager[Advance]:
        """Return a context for ``total`` items; its value is called with the number of newly finished ones."""
        return nullcontext(silent)


class Bars(Listener):
    """Listener that shows a progress bar in a terminal or a notebook, once ``delay`` [s] have passed.

    The elapsed time is updated even if nothing is finished for long, as while kernels compile.
    """

    def __init__(self, delay: float = 0.0) -> None:
        self.delay = delay
        self._bar: Any = None
        self._drawing = RLock()  # tqdm keeps its own for ever if a write fails

    @contextmanager
    def progress(self, total: int) -> "Iterator[Advance]":
        """Return a context that shows a bar of ``total`` runs; its value advances the bar."""
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # raised in notebooks without widgets, which get a text bar
            from tqdm.auto import tqdm

        ended = Event()

        def keep_moving() -> None:
            while not ended.wait(max(self.delay - time.monotonic() + started, MOVES_S)):
                with self._drawing, suppress(OSError):  # the caller of advance gets the error, too
                    bar.refresh(nolock=True)

        def advance(done: int) -> None:
            with self._drawing:
                bar.update(done)

        started = time.monotonic()
        with tqdm(total=total, unit="run", leave=False, delay=self.delay, dynamic_ncols=True) as bar:
            mover = Thread(target=keep_moving, daemon=True)
            with suppress(RuntimeError):  # if no further thread can start, the bar moves only when items finish
                mover.start()
            self._bar = bar
            try:
                yield advance
            finally:
                self._bar = None
                ended.set()
                if mover.is_alive():
                    mover.join()

    @contextmanager
    def making_room(self) -> "Iterator[None]":
        """Return a context in which the bar is cleared, so that lines can be printed on stderr."""
        with self._drawing, nullcontext() if self._bar is None else self._bar.external_write_mode(sys.stderr):
            yield


class Calls(Listener):
    """Listener that calls a function with the numbers of finished items and of all items."""

    def __init__(self, function: Callable[[int, int], object]) -> None:
        self.function = function

    @contextmanager
    def progress(self, total: int) -> "Iterator[Advance]":
        """Return a context whose value calls the function with the numbers of finished items so far, and of all, ``total``."""
        done = 0

        def advance(more: int) -> None:
            nonlocal done
            done += more
            self.function(done, total)

        yield advance


Progress = bool | Callable[[int, int], object] | Listener | None
"""Values of the argument ``progress``."""


def listener_of(progress: Progress) -> Listener:
    """Return the listener for ``progress``: a bar (True), none (False), one that calls a function, or a listener itself.

    None means a bar if stderr is a terminal, else no bar. ``InputError`` for anything else.
    """
    if progress is None:
        return Bars(SHORT) if sys.stderr is not None and sys.stderr.isatty() else Listener()
    if isinstance(progress, Listener):
        return progress
    if callable(progress):
        return Calls(progress)
    if not isinstance(progress, bool):
        raise InputError(
            f"progress = {progress!r}: expected True, False or a function of two numbers, finished and all"
        )
    return Bars() if progress else Listener()


@contextmanager
def announced_if_slow(listener: Listener, words: str) -> "Iterator[None]":
    """Send ``listener`` the message ``words`` if the context takes more than :data:`PATIENCE_S`."""
    timer = Timer(PATIENCE_S, listener.say, [words])
    timer.daemon = True
    with suppress(RuntimeError):  # without a further thread nothing is announced
        timer.start()
    try:
        yield
    finally:
        timer.cancel()
        if timer.is_alive():
            timer.join()  # where few threads are allowed, the next may need its place


def once(study: "Study") -> str:
    """Return " (polarity: mirror images, counted once)" if a study has both polarities; else ""."""
    return " (polarity: mirror images, counted once)" if len(study.motions.polarity) > 1 else ""


def count(n: int, noun: str) -> str:
    """Return a count with its noun: "1 run", "2 runs"."""
    return f"{n} {noun}" if n == 1 else f"{n} {noun}s"
