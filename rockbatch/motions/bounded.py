"""A bound for the time that one file may take: no file costs the others."""

import ctypes
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager

_LEAST, _PER_MIB = 20.0, 2.0  # s: twenty times what the slowest reader takes, that of text columns
_LOOKS = 0.5  # s between looks at the clock, at most


class TooLongError(BaseException):
    """Ends the reading of a file; no ``Exception``, so that no reader takes it for a fault of the file that it knows."""


@contextmanager
def bounded(size: int) -> Iterator[None]:
    """Ends what is done within by ``TooLongError`` after 20 s, and 2 s per MiB of ``size`` [bytes], of computing time.

    Time of the process counts, not of the clock: a computer may sleep, or a disk be slow. The exception comes between two
    steps of Python's; one call of a library in C is not ended, and those that are used here end by themselves.
    """
    seconds = _LEAST + _PER_MIB * size / 2**20
    reader, ended, lock = threading.get_ident(), threading.Event(), threading.Lock()
    started = time.process_time()

    def look() -> None:
        while not ended.wait(min(_LOOKS, seconds)):
            with lock:
                if not ended.is_set() and time.process_time() - started > seconds:
                    ctypes.pythonapi.PyThreadState_SetAsyncExc(ctypes.c_ulong(reader), ctypes.py_object(TooLongError))
                    return

    threading.Thread(target=look, name="rockbatch-bounded", daemon=True).start()
    try:
        yield
    finally:
        with lock:
            ended.set()
