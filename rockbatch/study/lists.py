"""Lists in a study file: every combination of their values."""

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import product

from rockbatch.common.errors import Problem
from rockbatch.toml.reader import Setting, Table, in_table
from rockbatch.toml.section import Key

Chosen = dict[str, Setting]
"""One value of each key."""

MOST_CASES = 100_000
"""Greatest number of cases of a study, piers times foundations: run.json, the report and the memory hold each of them."""


@dataclass(frozen=True)
class Grid:
    """The values of several keys, each to be combined with every other, and the names of the keys that are lists."""

    settings: dict[str, Sequence[Setting]] = field(default_factory=dict)
    varied: tuple[str, ...] = ()

    @classmethod
    def of(cls, table: Table, keys: Mapping[str, Key], prefix: str = "", other: Iterable[str] = ()) -> "Grid":
        """Return the values of a table's keys, called "part_1_mass_t" with the ``prefix`` "part_1_".

        ``other`` keys are read elsewhere. Wrong values become problems of the table's file and are left out.
        """
        settings = {}
        for name, value in table.read(keys, other=other, places=True).items():
            settings[prefix + name] = value if keys[name].many else [Setting(value, (*table.key_path, name))]
        lists = [
            name for name, value in table.data.items() if name in keys and keys[name].many and isinstance(value, list)
        ]
        return cls(settings, tuple(prefix + name for name in lists if name != "confirm"))

    def __add__(self, other: "Grid") -> "Grid":
        """Return the values of both; those of ``other`` count for keys in both."""
        return Grid(self.settings | other.settings, self.varied + other.varied)

    def __len__(self) -> int:
        """Return the number of combinations, 1 without any key."""
        return math.prod(map(len, self.settings.values()))

    def __iter__(self) -> Iterator[Chosen]:
        """Yield every combination, the last key varying fastest."""
        for chosen in product(*self.settings.values()):
            yield dict(zip(self.settings, chosen, strict=True))


def too_many(number: int, what: str) -> str:
    """Return a message about more than :data:`MOST_CASES` cases or piers (``what``); "" for no more."""
    if number <= MOST_CASES:
        return ""
    return (
        f"{number:,} {what}, more than {MOST_CASES:,}: every value of a list is combined with every other; write shorter "
        "lists, or several studies; `rockbatch sensitivity` samples instead of combining all"
    )


def complain_where_due(table: Table, chosen: Chosen, problem: Problem) -> None:
    """Add a problem to the table, at the chosen value of its key, or at the table itself if no value of that key is chosen."""
    if problem.key in chosen:
        table.complain_about(chosen[problem.key], in_table(problem))
    else:
        table.complain(in_table(problem))
