"""Histories files that somebody changes on purpose."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import h5py

from rockbatch.results.histories_file import seal


@contextmanager
def altered(path: Path) -> Iterator[h5py.File]:
    """Open a histories file to be changed, and give it a digest that fits afterwards."""
    with h5py.File(path, "r+") as file:
        yield file
    seal(path)
