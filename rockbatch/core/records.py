"""Records that kernels read and write by name, made from named tuples of numbers."""

from collections.abc import Mapping
from typing import NamedTuple, get_type_hints

import numpy as np

LANES = 16
"""Runs that a table holds side by side."""

_CODES = {float: "f8", int: "i8"}


def record(kind: type[NamedTuple]) -> np.dtype:
    """One ``kind``: a field for each of its own."""
    return np.dtype([(name, _CODES[hint]) for name, hint in get_type_hints(kind).items()])


def side_by_side(parts: Mapping[str, type[NamedTuple]]) -> tuple[np.dtype, np.dtype]:
    """Records of ``parts``, all floats: of one run, and of as many as there are lanes.

    In the second the numbers of one field lie next to each other, as an instruction takes them that works on several
    lanes at once. Both have their numbers in the same order.
    """
    alone = [(part, [(name, "f8") for name in kind._fields]) for part, kind in parts.items()]
    together = [(part, [(name, "f8", LANES) for name in kind._fields]) for part, kind in parts.items()]
    return np.dtype(alone), np.dtype(together)


def numbers(runs: np.ndarray) -> np.ndarray:
    """The numbers of records of single runs: a row for each run, in the same memory."""
    return runs.view("f8").reshape(len(runs), runs.dtype.itemsize // 8)


def table(lanes: np.dtype) -> tuple[np.record, np.ndarray]:
    """One record of ``lanes``, and its numbers as rows with a column for each lane, in the same memory."""
    memory = np.zeros(1, lanes)
    return memory.view(np.recarray)[0], memory.view("f8").reshape(-1, LANES)
