"""Tables of the page."""

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from itertools import groupby
from typing import Any, NamedTuple

from rockbatch.reporting.markup import Markup, escape, join, number, tag

WHOLE = ".10g"  # all digits as given
MOST_ROWS = 1000
LEAST_COMMON = 3
"""Rows from which on a column that says the same in all of them stands above the table."""
MOST_OPEN = 60
"""Rows of the longest table that is shown unfolded; longer ones are folded, and not printed."""


class Head(NamedTuple):
    """Head of a column: its text, the format of its numbers, an explanation, and the head over several columns.

    ``value`` is the key of its values in the items of :func:`listed`, or a function of such an item. By a column with
    ``filter`` the script of the page chooses rows.
    """

    text: str
    form: str = WHOLE
    note: str | None = None
    group: str = ""
    value: str | Callable[[Any], object] = ""
    filter: bool = False

    def value_in(self, item: Mapping[str, Any]) -> object:
        """Return the value of an item, None without one."""
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
    """Return a table in a container that scrolls if it is too wide. Columns without a value are left out.

    Of a ``sortable`` one, which has many rows, columns that say the same in all of them stand in a line above it.
    ``prose``: its cells hold text of several lines. ``worst_of`` is the number of rows of which these are the worst.

    Of more than :data:`MOST_ROWS` rows the first are shown, and a sentence says so; more than :data:`MOST_OPEN` are folded unless
    the table is ``open_``.
    """
    whole = list(rows)
    rows, total = whole[:MOST_ROWS], worst_of or len(whole)
    used = [i for i in range(len(heads)) if i == 0 or any(number(row[i]) for row in rows)]
    same = [i for i in used[1:] if sortable and len(whole) > LEAST_COMMON and len({str(row[i]) for row in whole}) == 1]
    used = [i for i in used if i not in same]
    numeric = {i for i in used if heads[i].form != WHOLE or any(isinstance(row[i], float | int) for row in rows)}

    classes = {i: "n" if i in numeric else None for i in used}
    heading = (
        tag(
            "th",
            _with_unit(heads[i].text),
            class_=classes[i],
            scope="col",
            title=heads[i].note,
            data_filter=heads[i].filter,
        )
        for i in used
    )
    top = [tag("tr", *heading)]
    if any(heads[i].group for i in used):
        spans = [(spanning, len(list(group))) for spanning, group in groupby(used, key=lambda i: heads[i].group)]
        spanning = (tag("th", label, scope="colgroup" if label else None, colspan=wide) for label, wide in spans)
        top.insert(0, tag("tr", *spanning, class_="over"))
    columns = [
        _cells(
            "td" if i else "th", [row[i] for row in rows], heads[i].form, class_=classes[i], scope=None if i else "row"
        )
        for i in used
    ]
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


def _with_unit(text: str) -> Markup:
    """Return the text of a head, no line of which ends within its unit."""
    name, bracket, unit = escape(text).rpartition(" [")
    return Markup(f'{name} <span class="unit">[{unit}</span>') if bracket else Markup(unit)


def _common(heads: Sequence[Head], values: Sequence[object], complete: bool) -> Markup:
    """Return the line on columns that say the same in every row, of all if the table is ``complete``."""
    words = [join(head.text, " ", value if isinstance(value, Markup) else number(value, head.form))
             for head, value in zip(heads, values, strict=True)]  # fmt: skip
    rows = "In every row: " if complete else "In each of these rows: "
    return tag("p", rows, join(*words, between="; "), ".", class_="legend")


def listed(heads: Sequence[Head], items: Iterable[Mapping[str, Any]], **options: Any) -> Markup:
    """Return a :func:`table` with a row for each item; ``head.value`` gives its cell under each head."""
    return table(heads, ([head.value_in(item) for head in heads] for item in items), **options)


def _cells(kind: str, values: Iterable[object], form: str, **attributes: object) -> list[Markup]:
    """Return the cells of a column, its numbers with their decimal points below each other."""
    start, end = tag(kind, _HERE, **attributes).split(_HERE)
    shown = [_text(value, form) for value in values]
    if form.endswith("g"):  # decimals that differ from row to row
        shown = _aligned(shown)
    return [Markup(f"{start}{value}{end}") for value in shown]


def _text(value: object, form: str) -> str:
    """Return a value as HTML; a number has nothing to escape, and there are many."""
    if isinstance(value, Markup):
        return value
    return number(value, form) if isinstance(value, float) else escape(number(value, form))


def _aligned(values: Sequence[str]) -> list[str]:
    """Return numbers with as much space behind them as the decimals of others take; words stay."""
    tails = [len(match[1] or "") if (match := _DECIMALS.fullmatch(value)) else None for value in values]
    most = max((tail for tail in tails if tail is not None), default=0)
    spaces = ("\u2008" + "\u2007" * (most - 1), "\u2007")  # as wide as a point and digits, as wide as a digit
    return [
        value if tail is None or tail == most else value + (spaces[0] if tail == 0 else spaces[1] * (most - tail))
        for value, tail in zip(values, tails, strict=True)
    ]


_DECIMALS = re.compile(r"-?[\d,]+(\.\d+)?")
_HERE = Markup("\0")


def shown_of(shown: int, all_: int, chosen_by: str = "first") -> Markup:
    """Return the sentence that not all rows are shown; empty if they are."""
    if shown >= all_:
        return Markup("")
    return tag("p", f"The {chosen_by} {shown:,} of {all_:,} rows are shown.", class_="muted")


def alarm(words: str) -> Markup:
    """Mark words that must not be missed: bold as well as coloured."""
    return tag("span", words, class_="alarm")


def sub(base: str, index: str, remainder: str = "") -> Markup:
    """Return a symbol with its subscript: θ_max."""
    return join(base, tag("sub", index), remainder)


THETA = sub("θ", "max", "/α")
THETA_FORMAT = ".4f"
