"""Heads of the table of intervals, on the terminal and the page."""

from collections.abc import Callable

from rockbatch.analyses.design.answer import governs, plain
from rockbatch.analyses.design.tables import is_known
from rockbatch.common.analyses import Entry
from rockbatch.reporting.table import WHOLE, Head


def heads(info: Entry) -> list[Head]:
    """Return the heads of the intervals of designs, rows of design.csv."""
    path, others = info["vary"][0]["path"], [varied["path"] for varied in info["vary"][1:]]
    varied = (Head(name, value=name) for name in info["varied"])
    return [
        Head("case", value="case"),
        *varied,
        *(Head(other, WHOLE, value=other) for other in others),
        Head("verdict", value="verdict"),
        Head("from", group=path, value=lambda row: plain(row["low"])),
        Head("to", group=path, value=lambda row: plain(row["high"])),
        Head("runs at", ".0f", note="number of values that were run in the interval", value="values"),
        *(Head(f"governs {end}", value=_end(end)) for end in ("below", "above")),
    ]


def _end(end: str) -> Callable[[Entry], str]:
    def words(row: Entry) -> str:
        return f"{plain(row[end])}: {governs(row, end, short=True)}" if is_known(row[end]) else "end of the scan"

    return words
