"""Limits of time and memory for tests: a hang, or memory that only a header asks for, fails the test and not the machine."""

import resource
import signal
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path


class HangError(BaseException):
    """The time given was over."""


@contextmanager
def bounds(seconds: float, megabytes: float) -> Iterator[None]:
    """Fail what takes more computing time [s] or more additional memory [MiB] than given."""

    def stop(*_: object) -> None:
        raise HangError(f"more than {seconds:g} s")

    soft, hard = resource.getrlimit(resource.RLIMIT_AS)
    now = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
    before = signal.signal(signal.SIGVTALRM, stop)
    resource.setrlimit(resource.RLIMIT_AS, (now + int(megabytes * 2**20), hard))
    signal.setitimer(signal.ITIMER_VIRTUAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_VIRTUAL, 0)
        resource.setrlimit(resource.RLIMIT_AS, (soft, hard))
        signal.signal(signal.SIGVTALRM, before)
