"""``rockbatch cache``: show or clear the cache of compiled kernels."""

import argparse
import time

from rockbatch.batch.listening import count
from rockbatch.simulation import kept
from rockbatch.terminal.streams import show


def main(arguments: argparse.Namespace) -> int:
    """Print folder, number and size of the compiled kernels, or of those removed with --clear; return 0."""
    kernels = kept.clear() if arguments.clear else kept.files()
    size = f"{count(len(kernels), 'compiled kernel')}, {sum(kernel.size for kernel in kernels) / 1e6:.1f} MB"
    if arguments.clear:
        show(f"{kept.folder()}: removed {size}")
        return 0
    show(f"{kept.folder()}: {size} of at most {kept.MOST_BYTES / 1e6:.0f} MB")
    if kernels:
        days = f"{_day(kernels[0].used)} and {_day(kernels[-1].used)}"
        show(f"last used between {days}; removed when unused for {kept.UNUSED_DAYS} days")
    return 0


def _day(seconds: float) -> str:
    return time.strftime("%Y-%m-%d", time.localtime(seconds))
