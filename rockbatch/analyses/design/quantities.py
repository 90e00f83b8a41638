"""Heads of the table of intervals, on the terminal and the page."""

from collections.abc import Callable

from rockbatch.analyses.design.answer import governs, plain
from rockbatch.analyses.design.search import WORSE
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
        *(Head(f"governs {outer}", value=_end(inner, outer)) for inner, outer in (("low", "below"), ("high", "above"))),
    ]


def _end(inner: str, outer: str) -> Callable[[Entry], str]:
    """Return the function that gives what governs an end of an interval, after the value where it does: the worse of the two."""

    def words(row: Entry) -> str:
        if not is_known(row[outer]):
            return "end of the scan"
        place = max(outer, inner, key=lambda end: WORSE.index(row["verdict" if end == inner else f"{outer}_verdict"]))
        return f"{plain(row[place])}: {governs(row, outer, short=True)}"

    return words
