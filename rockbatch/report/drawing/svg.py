"""Pictures as inline SVG: text stays text, colours come from the style sheet, and curves are in tenths of a pixel."""

from collections.abc import Collection, Iterable, Sequence

import numpy as np
import numpy.typing as npt

from rockbatch.report.markup import Markup, join, tag

Array = npt.NDArray[np.float64]

FINE = 10  # steps per pixel of a curve's coordinates
COLOURS = 7
NO_PEAK = {
    "overturned": "overturned", "flight": "flight: both pivots off the ground", "failed": "no result: the run failed",
}  # fmt: skip
"""Statuses of runs without a largest rotation, in words."""

SHAPES = {
    "disc": "M-4 0a4 4 0 1 0 8 0a4 4 0 1 0-8 0z",
    "cross": "M-1.5-4.5h3v3h3v3h-3v3h-3v-3h-3v-3h3z",
    "overturned": "M-4.5-2.5l2-2 2.5 2.5 2.5-2.5 2 2L2 0l2.5 2.5-2 2L0 2l-2.5 2.5-2-2L-2 0z",
    "flight": "M-1.7 5v-5h-3.3l5-5 5 5h-3.3v5z",
    "square": "M3.3 -3.3L-3.3 -3.3L-3.3 3.3L3.3 3.3z",
    "up": "M0.0 -5.4L-4.7 2.7L4.7 2.7z",
    "diamond": "M5.0 -0.0L0.0 -5.0L-5.0 -0.0L-0.0 5.0z",
    "down": "M0.0 5.4L4.7 -2.7L-4.7 -2.7z",
    "star": "M0.0 -5.8L-1.4 -2.0L-5.5 -1.8L-2.3 0.8L-3.4 4.7L-0.0 2.4L3.4 4.7L2.3 0.8L5.5 -1.8L1.4 -2.0z",
    "left": "M-5.4 -0.0L2.7 4.7L2.7 -4.7z",
    "right": "M5.4 -0.0L-2.7 -4.7L-2.7 4.7z",
    "hexagon": "M4.6 -0.0L2.3 -4.0L-2.3 -4.0L-4.6 -0.0L-2.3 4.0L2.3 4.0z",
}
"""Outlines of the markers around (0, 0) [px]."""
MARKERS = ("disc", "square", "up", "diamond", "down", "cross", "star", "left", "right", "hexagon")


def style_of(index: int) -> tuple[str, int]:
    """Return marker and colour of the ``index``-th foundation: no common factor, so 70 different pairs."""
    return MARKERS[index % len(MARKERS)], index % COLOURS + 1


def markers() -> Markup:
    """Return the definitions of all markers, once for the page."""
    paths = [tag("path", id=f"m-{name}", d=d) for name, d in SHAPES.items()]
    return tag("svg", tag("defs", *paths), width=0, height=0, class_="markers", aria_hidden="true")


def marker(name: str, x: float | str, y: float, *, colour: str, title: str | None = None) -> Markup:
    """Draw a marker at (x, y); ``colour`` are classes of the style sheet, ``title`` is its tooltip."""
    tooltip = tag("title", title) if title else Markup("")
    return tag("use", tooltip, href=f"#m-{name}", x=_short(x), y=_short(y), class_=colour)


def text(x: float | str, y: float, *content: object, class_: str = "") -> Markup:
    """Draw text at (x, y); ``x`` in pixels, or a share of the width: "50%"."""
    return tag("text", *content, x=_short(x), y=_short(y), class_=class_ or None)


def lowered(base: str, index: str, remainder: str = "") -> Markup:
    """Return text with a subscript: ("θ", "max", "/α")."""
    raised = tag("tspan", remainder, dy="-2") if remainder else Markup("")
    return join(base, tag("tspan", index, dy="2", class_="sub"), raised)


def rectangle(x: float, y: float, width: float, height: float, class_: str) -> Markup:
    return tag(
        "rect", x=_short(x), y=_short(y), width=_short(max(width, 0)), height=_short(max(height, 0)), class_=class_
    )


def line(x1: float, y1: float, x2: float, y2: float, class_: str, title: str | None = None) -> Markup:
    tooltip = tag("title", title) if title else Markup("")
    return tag("line", tooltip, x1=_short(x1), y1=_short(y1), x2=_short(x2), y2=_short(y2), class_=class_)


def svg(width: float, height: float, *content: object, description: str, class_: str = "plot") -> Markup:
    """Return a picture of that size [px]; ``description`` is for those who cannot see it."""
    return tag("svg", *content, class_=class_, role="img", aria_label=description, viewBox=f"0 0 {width:g} {height:g}")


Entry = tuple[Markup, str]
"""Entry of a legend: a drawing for 22 × 14 px, and its text."""


def key(entries: Sequence[Entry]) -> Markup:
    """Return a legend."""
    pictures = [
        tag("svg", drawn, class_="plot", viewBox="0 0 22 14", width=22, height=14, aria_hidden="true")
        for drawn, _ in entries
    ]
    return tag(
        "ul",
        *(tag("li", shown, tag("span", label)) for shown, (_, label) in zip(pictures, entries, strict=True)),
        class_="key",
    )


def sign_of(status: str, x: float, y: float, title: str | None = None) -> Markup:
    """Draw the sign of a run without a largest rotation."""
    if status == "failed":
        return text(x, y + 4, "?", *([tag("title", title)] if title else []), class_="m none")
    return marker(status, x, y, colour="alarm", title=title)


def ends(statuses: Collection[str]) -> list[Entry]:
    """Return the legend's entries of runs without a largest rotation."""
    return [(sign_of(status, 11, 7), words) for status, words in NO_PEAK.items() if status in statuses]


def side_by_side(drawn: Iterable[tuple[str, Markup, Sequence[Entry]]], width: float) -> Markup:
    """Arrange pictures with titles beside each other as room permits, over one legend without repeated entries."""
    entries: dict[str, Markup] = {}
    pictures = []
    for title, picture, entries_of_picture in drawn:
        pictures.append(tag("figure", tag("figcaption", title), picture))
        entries |= {words: shown for shown, words in entries_of_picture if words not in entries}
    grid = tag("div", *pictures, class_="panels", style=f"--w:{width:.0f}px")
    return join(grid, key([(shown, words) for words, shown in entries.items()]))


def _short(value: float | str) -> str:
    if isinstance(value, str):
        return value
    return f"{value:.1f}".removesuffix(".0")


def curve(x: Array, y: Array, class_: str, name: str | None = None) -> Markup:
    """Draw a curve through points in pixels, interrupted at NaN; ``name`` is its name in the script."""
    return tag("path", d=_relative(x, y), transform=f"scale({1 / FINE:g})", class_=class_, data_name=name)


_FAR = 1e6
"""Pixels: what lies beyond, as numbers in a table that somebody changed may, is not there."""


def _relative(x: Array, y: Array) -> str:
    """Return points as a path of whole steps, without repeated points and those on a straight line between two others."""
    in_range = (np.abs(x) < _FAR) & (np.abs(y) < _FAR)
    parts = []
    for piece in np.split(np.arange(len(x)), np.flatnonzero(np.diff(in_range.astype(np.int8))) + 1):
        if len(piece) == 0 or not in_range[piece[0]]:
            continue
        points = np.rint(FINE * np.column_stack([x[piece], y[piece]])).astype(np.int64)
        points = points[_bends(points)]
        steps = np.diff(points, axis=0)
        parts.append(f"M{points[0, 0]} {points[0, 1]}" + (f"l{_compact(steps.ravel())}" if len(steps) else "h0"))
    return "".join(parts)


def _bends(points: npt.NDArray[np.int64]) -> npt.NDArray[np.int64]:
    """Return the places of the points without which the drawing would change."""
    moved = np.flatnonzero(np.any(np.diff(points, axis=0) != 0, axis=1)) + 1
    kept = np.concatenate(([0], moved))
    if len(kept) < 3:
        return kept
    steps = np.diff(points[kept], axis=0)
    across = steps[:-1, 0] * steps[1:, 1] - steps[:-1, 1] * steps[1:, 0]
    along = (steps[:-1] * steps[1:]).sum(axis=1)
    return kept[np.concatenate(([True], (across != 0) | (along < 0), [True]))]


def _compact(numbers: Sequence[int] | npt.NDArray[np.int64]) -> str:
    return " ".join(map(str, numbers)).replace(" -", "-")


def thin(x: Array, y: Array, buckets: int) -> tuple[Array, Array]:
    """Return fewer points of a history that draw the same: of each bucket the first, least, largest and last.

    Parameters
    ----------
    x, y : ndarray, shape (n,)
        Abscissae in order, and ordinates; NaN is allowed in ``y``.
    buckets : int
        One for each pixel across.

    Returns
    -------
    x, y : ndarray, shape (≤ 4 buckets,)
    """
    if len(x) <= 4 * buckets:
        return x, y
    edges = np.linspace(0, len(x), buckets + 1).astype(int)
    first, last = edges[:-1], edges[1:] - 1
    rising = np.lexsort((y, np.repeat(np.arange(buckets), np.diff(edges))))  # bucket by bucket, NaN at its end
    numbers = np.add.reduceat(~np.isnan(y), first)
    largest = first + np.maximum(numbers, 1) - 1
    kept = np.unique(np.concatenate((first, last, rising[first], rising[largest])))
    return x[kept], y[kept]
