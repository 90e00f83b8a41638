"""Tables of the page."""

import re
from collections.abc import Callable, Iterable, Sequence
from itertools import groupby
from typing import NamedTuple

from rockbatch.reporting.markup import Markup, escape, join, number, tag
from rockbatch.results.labelled import Item

WHOLE = ".10g"  # all digits as given
MOST_ROWS = 1000
LEAST_COMMON = 3
"""A constant column is written above the table if the table has more rows than this."""
MOST_OPEN = 60
"""Most rows of a table that is not folded; folded ones are not printed."""


class Head(NamedTuple):
    """Head of a column: its text, the format of its numbers, a tooltip, and a head over several columns.

    ``value`` is the key of its cells in the items of :func:`listed`, or a function of an item. The page's script lets
    readers select rows by a column with ``filter``.
    """

    text: str
    form: str = WHOLE
    note: str | None = None
    group: str = ""
    value: str | Callable[[Item], object] = ""
    filter: bool = False

    def value_in(self, item: Item) -> object:
        """Return the cell of an item; None if the item lacks the key."""
        return item.get(self.value) if isinstance(self.value, str) else self.value(item)


def table(
    heads: Sequence[Head],
    rows: Iterable[Sequence[object]],
    *,
    sortable: bool = False,
    prose: bool = False,
    name: str | None = None,
    worst_of: int | None = None,
    open_: bool = False,
) -> Markup:
    """Return a table in a container that scrolls if too wide; columns without a value are left out.

    Constant columns of a ``sortable`` table stand in a line above it. ``prose`` cells hold several lines of text.
    ``worst_of`` is the number of rows of which these are the worst. Only the first :data:`MOST_ROWS` rows are shown, with a
    sentence that says so; tables of more than :data:`MOST_OPEN` are folded unless ``open_``.
    """
    whole = list(rows)
    rows, total = whole[:MOST_ROWS], worst_of or len(whole)
    used = [i for i in range(len(heads)) if i == 0 or any(number(row[i]) for row in rows)]
    same = [i for i in used[1:] if sortable and len(whole) > LEAST_COMMON and len({str(row[i]) for row in whole}) == 1]
    used = [i for i in used if i not in same]
    numeric = {i for i in used if heads[i].form != WHOLE or any(isinstance(row[i], float | int) for row in rows)}

    classes = {i: "n" if i in numeric else None for i in used}
    top = [tag("tr", *(_heading(heads[i], classes[i]) for i in used))]
    if any(heads[i].group for i in used):
        spans = [(spanning, len(list(group))) for spanning, group in groupby(used, key=lambda i: heads[i].group)]
        spanning = (tag("th", label, scope="colgroup" if label else None, colspan=wide) for label, wide in spans)
        top.insert(0, tag("tr", *spanning, class_="over"))
    columns = []
    for i in used:
        kind, scope = ("td", None) if i else ("th", "row")
        columns.append(_cells(kind, [row[i] for row in rows], heads[i].form, class_=classes[i], scope=scope))
    body = [tag("tr", *cells) for cells in zip(*columns, strict=True)]
    drawn = tag("table", tag("thead", *top), tag("tbody", *body), class_="sortable" if sortable else None)
    wide = tag(
        "div", drawn, class_="wide prose" if prose else "wide", tabindex="0", role="region", aria_label=name or "Table"
    )
    if len(rows) > MOST_OPEN and not open_:
        wide = tag("details", tag("summary", f"{name or 'Table'}: {len(rows):,} rows"), wide)
    return join(
        shown_of(len(rows), total, "worst" if worst_of else "first"),
        _common([heads[i] for i in same], [whole[0][i] for i in same], len(whole) == total) if same else "",
        wide,
    )


def _heading(head: Head, class_: str | None) -> Markup:
    text = _with_unit(head.text)
    return tag("th", text, class_=class_, scope="col", title=head.note, data_filter=head.filter)


def _with_unit(text: str) -> Markup:
    """Return the text of a head as HTML, without line breaks inside its unit."""
    name, bracket, unit = escape(text).rpartition(" [")
    return Markup(f'{name} <span class="unit">[{unit}</span>') if bracket else Markup(unit)


def _common(heads: Sequence[Head], values: Sequence[object], complete: bool) -> Markup:
    """Return a line with the values of constant columns; ``complete`` if the table shows every row."""
    words = []
    for head, value in zip(heads, values, strict=True):
        words.append(join(head.text, " ", value if isinstance(value, Markup) else number(value, head.form)))
    rows = "In every row: " if complete else "In each of these rows: "
    return tag("p", rows, join(*words, between="; "), ".", class_="legend")


def listed(
    heads: Sequence[Head],
    items: Iterable[Item],
    *,
    sortable: bool = False,
    prose: bool = False,
    name: str | None = None,
) -> Markup:
    """Return a :func:`table` with a row for each item, its cells given by ``head.value``."""
    rows = ([head.value_in(item) for head in heads] for item in items)
    return table(heads, rows, sortable=sortable, prose=prose, name=name)


def _cells(kind: str, values: Iterable[object], form: str, **attributes: object) -> list[Markup]:
    """Return the cells of a column as HTML, numbers aligned on the decimal point."""
    start, end = tag(kind, _HERE, **attributes).split(_HERE)
    shown = [_text(value, form) for value in values]
    if form.endswith("g"):  # decimals that differ from row to row
        shown = _aligned(shown)
    return [Markup(f"{start}{value}{end}") for value in shown]


def _text(value: object, form: str) -> str:
    """Return a value as HTML, formatted by ``form``; numbers, which are many, need no escaping."""
    if isinstance(value, Markup):
        return value
    return number(value, form) if isinstance(value, float) else escape(number(value, form))


def _aligned(values: Sequence[str]) -> list[str]:
    """Pad numbers with spaces as wide as the decimals they lack; words stay as they are."""
    tails = [len(match[1] or "") if (match := _DECIMALS.fullmatch(value)) else None for value in values]
    most = max((tail for tail in tails if tail is not None), default=0)
    digit, no_decimals = "\u2007", "\u2008" + "\u2007" * (most - 1)  # as wide as a digit, as a point and all decimals
    padding = [no_decimals, *(digit * (most - tail) for tail in range(1, most)), ""] if most else [""]
    return [value if tail is None else value + padding[tail] for value, tail in zip(values, tails, strict=True)]


_DECIMALS = re.compile(r"-?[\d,]+(\.\d+)?")
_HERE = Markup("\0")


def shown_of(shown: int, all_: int, chosen_by: str = "first") -> Markup:
    """Return a sentence that only ``shown`` of ``all_`` rows are shown; empty if all are."""
    if shown >= all_:
        return Markup("")
    return tag("p", f"The {chosen_by} {shown:,} of {all_:,} rows are shown.", class_="muted")


def alarm(words: str) -> Markup:
    """Return words in bold and colour, so that they are not missed."""
    return tag("span", words, class_="alarm")


def sub(base: str, index: str, remainder: str = "") -> Markup:
    """Return a symbol with a subscript as HTML, followed by ``remainder``: θ_max/α."""
    return join(base, tag("sub", index), remainder)


THETA = sub("θ", "max", "/α")
THETA_FORMAT = ".4f"
