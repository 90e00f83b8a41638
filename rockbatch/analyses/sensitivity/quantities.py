"""Quantities of a sensitivity study: columns of its files, and heads and formats on the terminal and the page."""

from collections.abc import Callable

from rockbatch.analyses.sensitivity.figures import written
from rockbatch.common.analyses import Entry
from rockbatch.reporting.table import Head

_ENDS = {"low": "low", "base": "study", "high": "high"}
_INDICES = {"first": "first-order", "total": "total"}


def _value(end: str) -> Callable[[Entry], str]:
    return lambda row: written(row[end])


QUANTITIES = (
    *(Head(head, value=_value(end)) for end, head in _ENDS.items()),
    *(Head(head, ".4f", group="answer at", value=f"answer_{end}") for end, head in _ENDS.items()),
    *(
        Head(head, ".3f", group="Sobol index", value=column)
        for index, name in _INDICES.items()
        for head, column in ((name, index), ("±", f"{index}_error"))
    ),
)
"""Heads of a table of inputs, whose rows have the columns of both files."""
