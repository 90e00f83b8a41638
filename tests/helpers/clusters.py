"""Clusters of real processes on this machine, for tests that kill some of them."""

import contextlib
import json
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple


class Cluster(NamedTuple):
    """The address of a scheduler, its process and those of its workers."""

    address: str
    scheduler: "subprocess.Popen[bytes]"
    workers: "list[subprocess.Popen[bytes]]"


@contextlib.contextmanager
def cluster(folder: Path, worker: list[str], workers: int = 1) -> Iterator[Cluster]:
    """Start a scheduler, which writes its address into ``folder``, and workers: ``worker`` are Python's arguments for one.

    "ADDRESS" in them stands for the scheduler's address. All are killed at the end.
    """
    file = folder / "scheduler.json"
    words = ["-m", "distributed.cli.dask_scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard"]
    with contextlib.ExitStack() as processes:
        scheduler = processes.enter_context(_process([*words, "--scheduler-file", str(file)]))
        address = _address_in(file)
        arguments = [word.replace("ADDRESS", address) for word in worker]
        yield Cluster(address, scheduler, [processes.enter_context(_process(arguments)) for _ in range(workers)])


WORKER = ["-m", "distributed.cli.dask_worker", "ADDRESS", "--no-nanny", "--nthreads", "1", "--no-dashboard"]


@contextlib.contextmanager
def _process(arguments: list[str]) -> "Iterator[subprocess.Popen[bytes]]":
    process = subprocess.Popen([sys.executable, *arguments], stderr=subprocess.DEVNULL)
    try:
        yield process
    finally:
        process.kill()
        process.wait()


def _address_in(file: Path) -> str:
    until = time.monotonic() + 60
    while time.monotonic() < until:
        with contextlib.suppress(OSError, ValueError, KeyError):
            return str(json.loads(file.read_text())["address"])
        time.sleep(0.1)
    raise AssertionError("no scheduler")
