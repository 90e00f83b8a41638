"""Lists in a study file: every combination of their values."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import product

from rockbatch.toml.reader import Setting, Table

Chosen = dict[str, Setting]
"""One value of each key."""


def combinations(settings: Mapping[str, Sequence[Setting]]) -> Iterator[Chosen]:
    """Every combination, the last key varying fastest."""
    for chosen in product(*settings.values()):
        yield dict(zip(settings, chosen, strict=True))


def listed(table: Table, names: Iterable[str]) -> tuple[str, ...]:
    """The keys of the table that are lists, in the order of the file."""
    names = set(names)
    return tuple(name for name, value in table.data.items() if name in names and isinstance(value, list))
