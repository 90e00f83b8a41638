"""A design and its bounds in tables: the column that names the bound under which a case ran."""

from collections.abc import Mapping
from typing import TypeVar

BOUND = "bound"
"""Column of peaks.csv and checks.csv with the name of the bound; empty for the nominal design."""

_V = TypeVar("_V")


def of_design(columns: Mapping[str, _V]) -> dict[str, _V]:
    """Return the varied values of a case without its bound: those of its design."""
    return {name: value for name, value in columns.items() if name != BOUND}


def under(columns: Mapping[str, object]) -> str:
    """Return the bound of a case in words, "under stiff ground"; empty for the nominal design."""
    return f"under {columns[BOUND]}" if columns.get(BOUND) else ""
