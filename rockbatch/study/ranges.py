"""Ranges in a study file: ``[low, high]``."""

from collections.abc import Sequence
from typing import Any

from rockbatch.toml.kinds import shown
from rockbatch.toml.reader import Setting, Table

Range = tuple[float, float]


def range_of(table: Table, name: str, settings: Sequence[Setting] | None) -> Range | None:
    """The two values of a key that was read with ``many=True``, in order; what is wrong about them is noted."""
    if settings is None:  # missing, or noted already
        return None
    values: list[Any] = [setting.value for setting in settings]
    if len(values) != 2 or values[0] >= values[1]:
        written = shown(table.data[name])
        table.complain(f"{name} = {written}: expected a range; write for example {name} = {_example(values)}", name)
        return None
    return values[0], values[1]


def _example(values: Sequence[float]) -> str:
    """The range that was probably meant."""
    low, high = min(values), max(values)
    return shown([low, high] if low < high else [0.5 * low, 2.0 * low])
