"""Tables of the page."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from itertools import groupby
from typing import Any, NamedTuple

from rockbatch.reporting.markup import Markup, escape, join, number, tag

WHOLE = ".10g"  # all digits as given
MOST_ROWS = 1000
MOST_OPEN = 60
"""Rows of the longest table that is shown unfolded; longer ones are folded, and not printed."""


class Head(NamedTuple):
    """Head of a column: its text, the format of its numbers, an explanation, and the head over several columns.

    ``value`` is the key of its values in the items of :func:`listed`, or a function of such an item.
    """

    text: str
    form: str = WHOLE
    note: str | None = None
    group: str = ""
    value: str | Callable[[Any], object] = ""

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
) -> Markup:
    """Return a table in a container that scrolls if it is too wide. Columns without a value are left out.

    ``prose``: its cells hold text of several lines.

    Of more than :data:`MOST_ROWS` rows the first are shown, and a sentence says so; more than :data:`MOST_OPEN` are folded.
    """
    whole = list(rows)
    rows = whole[:MOST_ROWS]
    used = [i for i in range(len(heads)) if i == 0 or any(row[i] not in (None, "") for row in rows)]
    numeric = {i for i in used if heads[i].form != WHOLE or any(isinstance(row[i], float | int) for row in rows)}

    classes = {i: "n" if i in numeric else None for i in used}
    top = [tag("tr", *(tag("th", heads[i].text, class_=classes[i], scope="col", title=heads[i].note) for i in used))]
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
    if len(rows) > MOST_OPEN:
        wide = tag("details", tag("summary", f"{name or 'Table'}: {len(rows):,} rows"), wide)
    return join(shown_of(len(rows), len(whole)), wide)


def listed(heads: Sequence[Head], items: Iterable[Mapping[str, Any]], **options: Any) -> Markup:
    """Return a :func:`table` with a row for each item; ``head.value`` gives its cell under each head."""
    return table(heads, ([head.value_in(item) for head in heads] for item in items), **options)


def _cells(kind: str, values: Iterable[object], form: str, **attributes: object) -> list[Markup]:
    """Return the cells of a column."""
    start, end = tag(kind, _HERE, **attributes).split(_HERE)
    return [
        Markup(f"{start}{escape(value if isinstance(value, Markup) else number(value, form))}{end}") for value in values
    ]


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
