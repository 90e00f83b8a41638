"""Ctrl-C: answered at once, whatever the program is in, and over soon."""

import os
import signal
import socket
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress

from rockbatch.terminal.streams import say

QUICK_S = 0.2
"""Time [s] within which a command ends without a word on it."""

GRACE_S = 1.2
"""Time [s] that it has from then on to end by itself. What is finished is on disk before."""

_END, _LATE = 0, -1


@contextmanager
def answered_interrupts() -> Iterator[None]:
    """Answer an interrupt at once, and end the process at the second one, or if it does not end soon.

    Python hears of it only between two of its own instructions, and compiling a kernel is one that takes seconds. A thread
    that the signal wakes need not wait for that.
    """
    ours = signal.getsignal(signal.SIGINT) is signal.default_int_handler
    if not ours or threading.current_thread() is not threading.main_thread():
        yield
        return
    bell, rope = socket.socketpair()
    rope.setblocking(False)
    earlier = signal.set_wakeup_fd(rope.fileno(), warn_on_full_buffer=False)
    watcher = threading.Thread(target=_watch, args=(bell,), daemon=True)
    try:
        with suppress(RuntimeError):  # no more threads: Ctrl-C is heard of as Python does
            watcher.start()
        yield
    finally:
        signal.set_wakeup_fd(earlier)
        rope.close()
        if watcher.is_alive():
            watcher.join()
        bell.close()


def _watch(bell: socket.socket) -> None:
    """Wait for signals until the other end is closed."""
    number = _next(bell)
    while number not in (_END, signal.SIGINT):
        number = _next(bell)
    if number == signal.SIGINT:
        number = _next(bell, QUICK_S)
    if number == _LATE:
        say("stopping, a second at most; what is finished is kept; again to stop now")
        number = _next(bell, GRACE_S)
    if number != _END:
        say("rockbatch: interrupted")
        os._exit(130)


def _next(bell: socket.socket, patience: float | None = None) -> int:
    """Return the number of the next signal, _LATE where none comes in time, or _END."""
    bell.settimeout(patience)
    try:
        return next(iter(bell.recv(1)), _END)
    except TimeoutError:
        return _LATE
