"""A bound for the time that one file may take: no file costs the others."""

import ctypes
import math
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from types import TracebackType
from typing import Self

from rockbatch.errors import starting_threads

_LEAST, _PER_MIB = 20.0, 2.0  # s: twenty times what the slowest reader takes, that of text columns
_LOOKS = 0.5  # s between looks at the clock


class TooLongError(BaseException):
    """Ends the reading of a file; no ``Exception``, so that no reader takes it for a fault of the file that it knows."""


class Watch:
    """Ends the reading of a file by ``TooLongError`` after 20 s, and 2 s per MiB of it, of computing time.

    Time of the process counts, not of the clock: a computer may sleep, or a disk be slow. The exception comes between two
    steps of Python's; one call of a library in C is not ended, and those that are used here end by themselves.

    A context, within which one thread looks at the clock for all files, one after another: whether it can be started does not
    decide over one file and not over the next. Raises ``InputError`` where it cannot.
    """

    def __init__(self) -> None:
        self._lock, self._ended = threading.Lock(), threading.Event()
        self._reader, self._until = 0, math.inf
        self._thread = threading.Thread(target=self._look, name="rockbatch-bounded", daemon=True)

    def __enter__(self) -> Self:
        with starting_threads():
            self._thread.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._ended.set()
        self._thread.join()  # where few are allowed, the next one may need its place

    @contextmanager
    def bounded(self, size: int) -> Iterator[None]:
        """Bound what is done within, with a file of ``size`` [bytes]."""
        with self._lock:
            self._reader = threading.get_ident()
            self._until = time.process_time() + _LEAST + _PER_MIB * size / 2**20
        try:
            yield
        finally:
            with self._lock:
                self._until = math.inf

    def _look(self) -> None:
        while not self._ended.wait(_LOOKS):
            with self._lock:
                if time.process_time() > self._until:
                    self._until = math.inf  # once is enough
                    ctypes.pythonapi.PyThreadState_SetAsyncExc(
                        ctypes.c_ulong(self._reader), ctypes.py_object(TooLongError)
                    )
