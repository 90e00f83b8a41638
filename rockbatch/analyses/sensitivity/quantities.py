"""Quantities of a sensitivity study: columns of its files, and heads and formats on the terminal and the page."""

from collections.abc import Callable

from rockbatch.analyses.sensitivity.figures import written
from rockbatch.common.analyses import Entry
from rockbatch.reporting.table import Head

_ENDS = {"low": "low", "base": "study", "high": "high"}
_INDICES = {"first": "first-order", "total": "total"}


def _value(end: str) -> Callable[[Entry], str]:
    return lambda row: written(row[end])


def _answer(end: str, overturned: float) -> Callable[[Entry], float | str]:
    """Return a function from a row to its answer there, "≥ 1.0000" of one that reaches the value at which runs are cut."""

    def answer(row: Entry) -> float | str:
        value = float(row[f"answer_{end}"])
        return f"≥ {value:.4f}" if value >= overturned else value

    return answer


def of_inputs(info: Entry) -> list[Head]:
    """Return the heads of a table of inputs, whose rows have the columns of both files."""
    return [
        *(Head(head, value=_value(end)) for end, head in _ENDS.items()),
        *(Head(head, ".4f", group="answer at", value=_answer(end, info["overturned"])) for end, head in _ENDS.items()),
        *(
            Head(head, ".3f", group="Sobol index", value=column)
            for index, name in _INDICES.items()
            for head, column in ((name, index), ("±", f"{index}_error"))
        ),
    ]
