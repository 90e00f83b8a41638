"""Lists in a study file: every combination of their values."""

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import product

from rockbatch.toml.reader import Setting, Table

Chosen = dict[str, Setting]
"""One value of each key."""

MOST_CASES = 100_000
"""Of a study: piers times foundations. Each stands in run.json and in the report, and is held in memory."""


def how_many(settings: Mapping[str, Sequence[Setting]]) -> int:
    """Return the number of combinations."""
    return math.prod(map(len, settings.values()))


def too_many(number: int, what: str) -> str:
    """Return what is said of more than :data:`MOST_CASES`; empty for fewer."""
    if number <= MOST_CASES:
        return ""
    return (
        f"{number:,} {what}, more than {MOST_CASES:,}: every value of a list is combined with every other; write shorter "
        "lists, or several studies; `rockbatch sensitivity` samples what has no room for a grid"
    )


def combinations(settings: Mapping[str, Sequence[Setting]]) -> Iterator[Chosen]:
    """Return every combination, the last key varying fastest."""
    for chosen in product(*settings.values()):
        yield dict(zip(settings, chosen, strict=True))


def listed(table: Table, names: Iterable[str]) -> tuple[str, ...]:
    """Return the keys of the table that are lists of values to combine, in the order of the file."""
    names = {*names} - {"confirm"}
    return tuple(name for name, value in table.data.items() if name in names and isinstance(value, list))
