"""Tables of the page."""

import re
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from html import unescape
from itertools import groupby, takewhile
from typing import NamedTuple

from rockbatch.reporting.markup import Markup, escape, join, number, tag
from rockbatch.results.labelled import Item

WHOLE = ".10g"  # all digits as given
MOST_ROWS = 1000
LEAST_COMMON = 3
"""A constant column is written above the table if the table has more rows than this."""
MOST_OPEN = 60
"""Most rows of a table that is not folded; folded ones are not printed."""
MOST_PRINTED = 100
"""Most rows of a table on the calculation sheet."""
PAPER, GAP = 140, 2
"""Characters in a line of A4 in the size of tables, and those between columns."""
WRAPPED, WRAPPED_PROSE = 46, 16
"""Longest text that stays in one line on paper, and in a table of prose."""


class Head(NamedTuple):
    """Head of a column: its text, the format of its numbers, a tooltip, a head over several columns, and the unit, "" for none.

    ``value`` is the key of its cells in the items of :func:`listed`, or a function of an item. The page's script lets
    readers select rows by a column with ``filter``. A table too wide for paper has its columns that identify a row in each
    part: the first, and those next to it that have a ``filter`` or are a ``key``.
    """

    text: str
    form: str = WHOLE
    note: str | None = None
    group: str = ""
    unit: str = ""
    value: str | Callable[[Item], object] = ""
    filter: bool = False
    key: bool = False

    @property
    def words(self) -> Markup:
        """Return the text with the unit as HTML: "drift [mm]"."""
        return join(self.text, f" [{self.unit}]" if self.unit else "")

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
    """Return a table in a container that scrolls if too wide; columns without a value are left out but for the first.

    Constant columns of a ``sortable`` table of more than :data:`LEAST_COMMON` rows stand in a line above it. ``prose`` cells hold
    several lines of text. ``worst_of`` is the number of rows of which these are the worst. Only the first :data:`MOST_ROWS` rows
    are shown, on paper :data:`MOST_PRINTED`, with a sentence that says so; tables of more than :data:`MOST_OPEN` are folded
    unless ``open_``.
    """
    whole = list(rows)
    rows, total = whole[: MOST_PRINTED if for_paper() else MOST_ROWS], worst_of or len(whole)
    used = [i for i in range(len(heads)) if i == 0 or any(number(row[i]) for row in rows)]
    same = [i for i in used[1:] if sortable and len(whole) > LEAST_COMMON and len({str(row[i]) for row in whole}) == 1]
    used = [i for i in used if i not in same]
    numeric = {i for i in used if heads[i].form != WHOLE or any(isinstance(row[i], float | int) for row in rows)}

    parts = _parts(heads, rows, used, WRAPPED_PROSE if prose else WRAPPED) if for_paper() else [used]
    drawn = [_part(heads, rows, part, numeric, class_="sortable" if sortable else None) for part in parts]
    label = name or "Table"
    wide = [
        tag("div", part, class_="wide prose" if prose else "wide", tabindex="0", role="region", aria_label=label)
        for part in drawn
    ]
    shown = join(*wide) if len(wide) == 1 else join(*_numbered(wide, label))
    if len(rows) > MOST_OPEN and not open_ and not for_paper():
        shown = tag("details", tag("summary", f"{label}: {len(rows):,} rows"), shown)
    return join(
        shown_of(len(rows), total, "worst" if worst_of else "first"),
        _common([heads[i] for i in same], [whole[0][i] for i in same], len(whole) == total) if same else "",
        shown,
    )


@contextmanager
def on_paper() -> Iterator[None]:
    """Draw the tables made inside for paper: unfolded, wide ones in parts that repeat their first columns, long ones cut."""
    token = _ON_PAPER.set(True)
    try:
        yield
    finally:
        _ON_PAPER.reset(token)


def for_paper() -> bool:
    """Return whether what is drawn now is for paper."""
    return _ON_PAPER.get()


_ON_PAPER: ContextVar[bool] = ContextVar("on_paper", default=False)


def _part(
    heads: Sequence[Head],
    rows: Sequence[Sequence[object]],
    used: Sequence[int],
    numeric: Collection[int],
    class_: str | None,
) -> Markup:
    """Return a table of the columns ``used``, those in ``numeric`` aligned to the right."""
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
    return tag("table", tag("thead", *top), tag("tbody", *body), class_=class_)


def _parts(
    heads: Sequence[Head], rows: Sequence[Sequence[object]], used: Sequence[int], longest: int
) -> list[list[int]]:
    """Return the columns ``used`` in parts as wide as the paper; each begins with the columns that identify a row.

    Texts of more than ``longest`` characters wrap.
    """
    wide = {i: _width(heads[i], [row[i] for row in rows], longest) for i in used}
    keys = [used[0], *takewhile(lambda i: heads[i].filter or heads[i].key, used[1:])]
    parts = [[*keys]]
    for i in used[len(keys) :]:
        if sum(wide[place] for place in parts[-1]) + wide[i] > PAPER and len(parts[-1]) > len(keys):
            parts.append([*keys])
        parts[-1].append(i)
    return parts


def _width(head: Head, cells: Iterable[object], longest: int) -> int:
    """Return the width of a column in characters, at most ``longest`` for its cells, with the gap to the next one."""
    of_head = max((len(word) for word in re.split(r"[ \n]+", _plain(head.words))), default=0)
    return GAP + max(of_head, max((min(len(_plain(_text(cell, head.form))), longest) for cell in cells), default=0))


def _plain(content: str) -> str:
    """Return HTML as the text that a reader sees."""
    return unescape(re.sub(r"<[^>]+>", "", content))


def _numbered(parts: Sequence[Markup], name: str) -> Iterator[Markup]:
    """Yield the parts of a table, each below a line that numbers it."""
    for place, part in enumerate(parts, start=1):
        yield tag("p", f"{name}, part {place} of {len(parts)}", class_="legend part")
        yield part


def _heading(head: Head, class_: str | None) -> Markup:
    unit = join(" ", tag("span", f"[{head.unit}]", class_="unit")) if head.unit else ""
    return tag("th", head.text, unit, class_=class_, scope="col", title=head.note, data_filter=head.filter)


def _common(heads: Sequence[Head], values: Sequence[object], complete: bool) -> Markup:
    """Return a line with the values of constant columns and their units; ``complete`` if the table shows every row."""
    words = []
    for head, value in zip(heads, values, strict=True):
        shown = value if isinstance(value, Markup) else number(value, head.form)
        words.append(join(head.text, " ", shown, f"\u00a0{head.unit}" if head.unit else ""))
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
    """Return the cells of a column as HTML; numbers in a format "g", whose decimals differ, are padded by :func:`_aligned`."""
    start, end = tag(kind, _HERE, **attributes).split(_HERE)
    shown = [_text(value, form) for value in values]
    if form.endswith("g"):  # decimals that differ from row to row
        shown = _aligned(shown)
    return [Markup(f"{start}{value}{end}") for value in shown]


def _text(value: object, form: str) -> str:
    """Return a value as escaped HTML, a float formatted by ``form``; "" for None and NaN."""
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
    """Return a sentence that only ``shown`` of ``all_`` rows are shown, the ``chosen_by`` ones; empty if all are."""
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
