"""Times that can be compared: every task once, then every task again, so that all see the same machine."""

import os
import platform
import statistics
import time
from collections.abc import Callable, Mapping, Sequence
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from rockbatch.batch.threads import cores

Times = Sequence[float]
"""Of one task, one for each repeat [s]."""


def interleaved(
    tasks: Mapping[str, Callable[[], object]], repeats: int, clock: Callable[[], float] = time.thread_time
) -> dict[str, Times]:
    """Times of every task, after one call of each that does not count.

    The default clock is this thread's processor time, whatever else the machine does; tasks with threads of their own
    take ``time.perf_counter``.
    """
    for task in tasks.values():
        task()
    times: dict[str, list[float]] = {name: [] for name in tasks}
    for _ in range(repeats):
        for name, task in tasks.items():
            start = clock()
            task()
            times[name].append(clock() - start)
    return dict(times)


def ratio(times: Times, unit: Times, scale: float = 1.0) -> str:
    """``times`` over ``unit``, times ``scale``: of the best ones, and the median of the repeats' own ratios."""
    each = [scale * a / b for a, b in zip(times, unit, strict=True)]
    return f"{scale * min(times) / min(unit):.3g} | {statistics.median(each):.3g}"


def machine(*packages: str) -> str:
    """Processor, load, and the versions of Python, what compiles, and ``packages``."""
    model = platform.processor() or platform.machine()
    if (information := Path("/proc/cpuinfo")).exists():
        lines = information.read_text(encoding="utf-8").splitlines()
        model = next((line.partition(":")[2].strip() for line in lines if line.startswith("model name")), model)
    load = f", load {os.getloadavg()[0]:.1f}" if hasattr(os, "getloadavg") else ""
    versions = [f"Python {platform.python_version()}"]
    for package in ("rockbatch", "numpy", "numba", "llvmlite", *packages):
        try:
            versions.append(f"{package} {version(package)}")
        except PackageNotFoundError:
            versions.append(f"{package} not installed")
    return f"{model}, {cores()} cores{load}; {platform.system()}; {', '.join(versions)}"
