"""A bound for the time that one file may take: no file costs the others."""

import ctypes
import math
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager

from rockbatch.errors import starting_threads

_LEAST, _PER_MIB = 20.0, 2.0  # s: twenty times what the slowest reader takes, that of text columns
_LOOKS = 0.5  # s between looks at the clock


class TooLongError(BaseException):
    """Ends the reading of a file; no ``Exception``, so that no reader takes it for a fault of the file that it knows."""


@contextmanager
def watch() -> Iterator[Callable[[int], AbstractContextManager[None]]]:
    """Yield a context for a file's size [bytes]; reading in it is ended by ``TooLongError`` after 20 s, and 2 s per MiB.

    Computing time of the process counts, not that of the clock: a computer may sleep, or a disk be slow. The exception comes
    between two steps of Python's; one call of a library in C is not ended, and those that are used here end by themselves.

    One thread looks at the clock for all files, one after another: whether it can be started does not decide over one file and
    not over the next. Raises ``InputError`` if it cannot.
    """
    lock, ended = threading.Lock(), threading.Event()
    reader, until = 0, math.inf

    @contextmanager
    def bounded(size: int) -> Iterator[None]:
        nonlocal reader, until
        with lock:
            reader = threading.get_ident()
            until = time.process_time() + _LEAST + _PER_MIB * size / 2**20
        try:
            yield
        finally:
            with lock:
                until = math.inf

    def look() -> None:
        nonlocal until
        while not ended.wait(_LOOKS):
            with lock:
                if time.process_time() > until:
                    until = math.inf  # once is enough
                    ctypes.pythonapi.PyThreadState_SetAsyncExc(ctypes.c_ulong(reader), ctypes.py_object(TooLongError))

    thread = threading.Thread(target=look, name="rockbatch-bounded", daemon=True)
    with starting_threads():
        thread.start()
    try:
        yield bounded
    finally:
        ended.set()
        thread.join()  # where few are allowed, the next one may need its place
