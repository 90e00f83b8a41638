"""Answer Ctrl-C at once, even while a kernel compiles, and end soon after."""

import os
import signal
import socket
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress

from rockbatch.terminal.streams import say

QUICK_S = 0.2
"""Time [s] after Ctrl-C within which a command may end without a message."""

GRACE_S = 1.2
"""Further time [s] before the process is ended; finished runs are on disk by then."""

_END, _LATE = 0, -1


@contextmanager
def answered_interrupts() -> Iterator[None]:
    """Context manager: after Ctrl-C say that the command stops, and end the process at a second one, or after :data:`GRACE_S`.

    Nothing is said if the command ends within :data:`QUICK_S`.

    Python handles signals between bytecode instructions only, and compiling a kernel is one instruction of many seconds. A thread
    that the signal wakes through a socket need not wait for it. Outside the main thread, or if the program handles Ctrl-C itself,
    nothing changes.
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
        with suppress(RuntimeError):  # without a further thread Python handles Ctrl-C as usual
            watcher.start()
        yield
    finally:
        signal.set_wakeup_fd(earlier)
        rope.close()
        if watcher.is_alive():
            watcher.join()
        bell.close()


def _watch(bell: socket.socket) -> None:
    """Wait for Ctrl-C until the other end of the socket is closed; announce the end :data:`QUICK_S` after it, if still open.

    Then end the process with 130 at a second Ctrl-C, or after :data:`GRACE_S`, unless the other end is closed before.
    """
    number = _next(bell)
    while number not in (_END, signal.SIGINT):
        number = _next(bell)
    if number == signal.SIGINT:
        number = _next(bell, QUICK_S)
    if number == _LATE:
        say("stopping within a second; finished runs are kept; press again to stop now")
        number = _next(bell, GRACE_S)
    if number != _END:
        say("rockbatch: interrupted")
        os._exit(130)


def _next(bell: socket.socket, patience: float | None = None) -> int:
    """Return the next signal's number; _LATE if none arrives within ``patience`` [s], _END if the socket was closed."""
    bell.settimeout(patience)
    try:
        return next(iter(bell.recv(1)), _END)
    except TimeoutError:
        return _LATE
