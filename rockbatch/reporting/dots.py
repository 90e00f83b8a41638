"""Draw peaks as dots on a common axis, a row for each record or foundation.

Positions along the axis are shares of the width, so that only the axis stretches and labels keep their size.
"""

import math
from collections.abc import Callable, Iterable, Sequence
from functools import cache
from typing import NamedTuple

import numpy as np

from rockbatch.common.figures.description import DASHES, ENDED, Axis, Look, Mark, Points, Rule, marks_of, sign_of
from rockbatch.common.lazy import pd
from rockbatch.reporting.markup import Markup, escape, join, number, tag
from rockbatch.reporting.svg import Entry, classes, key, marker, text
from rockbatch.reporting.table import THETA, THETA_FORMAT
from rockbatch.results.labelled import Row as Run
from rockbatch.results.labelled import as_dicts
from rockbatch.results.labels import Series

FIRST, LAST = 1.5, 97.0
"""Ends of the axis [% of the width]."""
MOST_LETTERS = 20
"""Most characters of the list of foundations without a peak; a longer one is replaced by their number."""
MIDDLE = 10
"""Middle of a row of 20 px [px]."""

DOT = Look("dot", 1)
"""Look of runs that foundations do not distinguish."""


class Row(NamedTuple):
    """A row: its label, whose ``end`` is never cut off, its tooltip ``more``, and its runs in each column.

    ``role`` is "rest" for the row of all other records together and "folded" for the rows that it unfolds to.
    """

    words: str
    end: str
    more: str
    runs: "Sequence[pd.DataFrame]"
    role: str = ""


class Limit(NamedTuple):
    """A limit of a check: its description, and the rotation θ/α it allows."""

    words: str
    theta: float


class Marks(NamedTuple):
    """Style of the marks of runs: by foundation in ``series``, or all alike if None; and a function for tooltips."""

    series: Sequence[Series] | None
    describe: Callable[[Run], str]
    kind: str
    """What a mark stands for, in the legend, if all are alike: "foundation"."""


def draw(
    rows: Sequence[Row], columns: Sequence[str], top: float, marks: Marks, limits: Sequence[Sequence[Limit]] = ()
) -> Markup:
    """Draw the legend, the rows in every column, and the common axis, which ends at ``top`` [θ_max/α].

    ``limits`` are those of each column.
    """
    limits = limits or [[] for _ in columns]
    ticks = Axis("", 0.0, top, about=4).ticks()
    grids = [_grid(ticks, of_column, top) for of_column in limits]
    cells: list[Markup] = []
    if any(columns):
        cells.append(tag("span", class_="of"))
        cells += [tag("span", words, class_="column") for words in columns]
    for row in rows:
        end = tag("span", row.end, class_="end") if row.end else ""
        of_row = [tag("span", tag("span", row.words, class_="words"), end, class_="of", title=row.more)]
        for words, runs, grid in zip(columns, row.runs, grids, strict=True):
            label = ", ".join(filter(None, (f"{row.words}{row.end}", words)))
            of_row += [_strip(runs, top, grid, marks, label), _without_peak(runs, marks)]
        cells.append(tag("div", *of_row, class_=f"row {row.role}".rstrip(), data_pga=_pga(row.runs)))
    axis = [text(f"{_across(tick, top)}%", 14, words, class_="m") for tick, words in ticks.items()]
    cells.append(tag("span", tag("span", THETA), class_="of axis"))
    for _ in columns:
        cells += [tag("svg", *axis, class_="plot strip", aria_hidden="true"), tag("span")]
    drawn = tag(
        "div",
        *cells,
        class_="dots",
        style=f"--n:{len(columns)}",
        tabindex="0",
        role="group",
        aria_label="Peaks, a row each; arrow keys go through the values",
    )
    entries = _legend([runs for row in rows for runs in row.runs], marks)
    return join(key([*entries, *_of_limits(limits, top)]), drawn)


def _grid(ticks: Iterable[float], limits: Sequence[Limit], top: float) -> list[Markup]:
    """Draw the grid lines of a column, then its limits within the axis."""
    lines = [_line(_across(tick, top), "grid") for tick in ticks]
    for place, limit in enumerate(limits):
        if limit.theta <= top:
            look = Look("limit", dash=place % DASHES)
            lines.append(_line(_across(limit.theta, top), classes(look), tag("title", limit.words)))
    return lines


def _pga(runs: "Sequence[pd.DataFrame]") -> str | None:
    """Return the largest PGA [g] of a row's motions, "0.4317", by which the page's script sorts; None if unknown."""
    values = [float(of_column["pga"].max()) for of_column in runs if len(of_column)]
    return f"{max(values):.4g}" if values and not math.isnan(max(values)) else None


def _of_limits(limits: Sequence[Sequence[Limit]], top: float) -> list[Entry]:
    """Return legend entries of the distinct limits, with the value of those beyond the axis."""
    entries: dict[str, Entry] = {}
    for place, limit in (numbered for of_column in limits for numbered in enumerate(of_column)):
        words = limit.words if limit.theta <= top else f"{limit.words}: beyond the axis, at θ/α = {limit.theta:.3g}"
        entries.setdefault(words, Entry(words, [_rule(Look("limit", dash=place % DASHES))]))
    return list(entries.values())


def _rule(look: Look) -> Mark:
    return Rule("x", np.empty(0), look=look)


def _points(look: Look) -> Mark:
    return Points(np.empty(0), np.empty(0), look=look)


def _across(theta: float, top: float) -> float:
    """Return the position of a rotation θ/α [% of the width], to a tenth: ``FIRST``, 1.5, at 0, and ``LAST``, 97, at ``top``."""
    return round(FIRST + (LAST - FIRST) * theta / top, 1)


def _line(
    x: float | str, class_: str, *content: object, low: int = 20, high: int = 0, case: str | None = None
) -> Markup:
    return tag("line", *content, x1=f"{x}%", x2=f"{x}%", y1=high, y2=low, class_=class_, data_case=case)


def _strip(runs: "pd.DataFrame", top: float, grid: Sequence[Markup], marks: Marks, words: str) -> Markup:
    """Draw the peaks of a row's standing runs in one column; of those of a foundation that would coincide, the largest alone."""
    peaks = runs["theta_max_over_alpha"].to_numpy(dtype=np.float64)
    order = np.argsort(-peaks, kind="stable")
    order = order[((runs["status"] == "ok").to_numpy() & ~np.isnan(peaks))[order]]
    thetas = peaks[order].tolist()
    series = runs["series"].to_numpy()[order].tolist() if marks.series else [None] * len(order)
    first: dict[tuple[object, float], int] = {}
    for foundation, theta, place in zip(series, thetas, order.tolist(), strict=True):
        first.setdefault((foundation, _across(theta, top)), place)  # further marks would be hidden beneath
    drawn = [_mark(run, x, marks) for (_, x), run in zip(first, as_dicts(runs.iloc[list(first.values())]), strict=True)]
    low, high = (number(theta, THETA_FORMAT) for theta in (thetas[-1:] + thetas[:1] or [math.nan, math.nan]))
    label = f"{words}: θmax/α {low} to {high}" if len(thetas) > 1 else f"{words}: θmax/α {high}"
    return tag(
        "svg",
        *grid,
        *drawn,
        class_="plot strip marks",
        role="img",
        data_of=words,
        aria_label=label if thetas else f"{words}: no peak",
    )


def _mark(run: Run, x: float, marks: Marks) -> Markup:
    place = None if marks.series is None else run["series"]
    series = None if marks.series is None else marks.series[run["series"]]
    return Markup(_template(series, place).format(x=x, said=escape(marks.describe(run))))


@cache
def _template(series: Series | None, place: int | None) -> Markup:
    """Return a mark's HTML with placeholders {x} for its position [%] and {said} for its tooltip; a dot without a ``series``.

    ``place`` is the number of the series. The result is cached, as thousands of marks are alike.
    """
    if series is None:
        return marker(DOT, "{x}%", MIDDLE, "{said}")
    if series.rigid:
        title = tag("title", "{said}")
        return _line("{x}", classes(_rigid(series)), title, low=MIDDLE + 7, high=MIDDLE - 7, case=str(place))
    return marker(marks_of(series.index), "{x}%", MIDDLE, "{said}", case=str(place))


def _rigid(series: Series) -> Look:
    return Look("rigid", dash=series.index % DASHES)


def _without_peak(runs: "pd.DataFrame", marks: Marks) -> Markup:
    """Return the signs of runs without a peak, by status, with the letters of their foundations.

    Rigid ones are named in full. The number of runs stands in place of a list longer than :data:`MOST_LETTERS` characters, and
    if foundations have no marks of their own.
    """
    shown: list[Markup] = []
    statuses, places = (runs[column].to_numpy() for column in ("status", "series"))
    for status, words in ENDED.items():
        ended = places[statuses == status].tolist()
        if ended:
            series = [] if marks.series is None else [marks.series[place] for place in dict.fromkeys(ended)]
            names = ", ".join(strip.label if strip.rigid else strip.tick for strip in series)
            names = names if 0 < len(names) <= MOST_LETTERS else str(len(ended))
            sign = tag(
                "svg",
                marker(sign_of(status), 11, 7),
                class_="plot",
                viewBox="4 0 14 14",
                width=14,
                height=14,
                aria_hidden="true",
            )
            class_ = "undecided" if status == "failed" else "alarm"
            shown.append(tag("span", sign, names, title=f"{len(ended)} × {words}", class_=class_, data_status=status))
    return tag("span", *shown, class_="ends")


def _legend(drawn: "Sequence[pd.DataFrame]", marks: Marks) -> list[Entry]:
    """Return legend entries of the cases, rigid ones first, and of the statuses without a peak that are drawn.

    Clicking one hides its runs. If ``marks`` do not distinguish cases, one entry says what a mark stands for.
    """
    present = {place for runs in drawn for place in runs["series"].unique().tolist()}
    if marks.series is None:
        entries = [Entry(f"a {marks.kind}", [_points(DOT)])]
    else:
        series, entries = marks.series, []
        for place in sorted(present, key=lambda place: series[place].order):
            case = series[place]
            mark = _rule(_rigid(case)) if case.rigid else _points(marks_of(case.index))
            entries.append(Entry(case.keyed, [mark], "case", str(place)))
    statuses = {status for runs in drawn for status in runs["status"].unique().tolist()}
    for status, words in ENDED.items():
        if status in statuses:
            entries.append(Entry(words, [_points(sign_of(status))], "status", status))
    return entries
