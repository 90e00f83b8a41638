"""Draw figures as inline SVG: text stays text, colours come from the style sheet, curves are in tenths of a pixel."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import singledispatch
from itertools import repeat, starmap
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from rockbatch.common.figures.description import (
    Area,
    Array,
    Axis,
    Figure,
    Look,
    Mark,
    Panel,
    Points,
    Polyline,
    Rule,
    Span,
    Words,
    subscripts,
)
from rockbatch.reporting.markup import Markup, join, tag

FINE = 10  # steps per pixel of a curve's coordinates
_FAR = 1e6
"""Pixels: points beyond, from an edited table, say, are not drawn."""

_OUTLINES = {
    "disc": "M-4 0a4 4 0 1 0 8 0a4 4 0 1 0-8 0z",
    "dot": "M-2.2 0a2.2 2.2 0 1 0 4.4 0a2.2 2.2 0 1 0-4.4 0z",
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


class Box(NamedTuple):
    """A panel and the rectangle between its axes in a picture [px]."""

    panel: Panel
    left: float
    top: float
    width: float
    height: float

    @property
    def right(self) -> float:
        return self.left + self.width

    @property
    def foot(self) -> float:
        return self.top + self.height

    def across(self, values: float | Array) -> Array:
        """Return the abscissae [px] of values on the x axis."""
        return self.left + self.width * self.panel.x.fraction(values)

    def down(self, values: float | Array) -> Array:
        """Return the ordinates [px], from the top of the picture, of values on the y axis."""
        return self.foot - self.height * self.panel.y.fraction(values)


def markers() -> Markup:
    """Return the definitions of all markers, which a page needs once."""
    paths = [tag("path", id=f"m-{name}", d=d) for name, d in _OUTLINES.items()]
    return tag("svg", tag("defs", *paths), width=0, height=0, class_="markers", aria_hidden="true")


def drawn(figure: Figure) -> Markup:
    """Draw a figure with its legend: panels side by side as room permits, each with its caption.

    One picture if they are stacked, or a single panel has no caption.
    """
    if figure.stacked or (len(figure.panels) == 1 and not figure.panels[0].caption):
        picture = _picture(figure.rows, figure.description, " alone")
        return join(picture, key_of(figure))
    width = max((panel.width for panel in figure.panels), default=0.0)
    shown = [
        tag("figure", _caption(panel), _picture([[panel]], _description(figure, panel))) for panel in figure.panels
    ]
    # Panels from which the script reads values handle the arrow keys themselves
    keys = {} if any(panel.reads for panel in figure.panels) else {"tabindex": "0"}
    grid = tag(
        "div",
        *shown,
        class_="panels",
        style=f"--w:{width:.0f}px",
        role="group",
        **keys,
        aria_label=f"{figure.description}; arrow keys go through the values",
    )
    return join(grid, key_of(figure))


def sketch(figure: Figure) -> Markup:
    """Draw a figure of one panel in its own size, with its caption, if any."""
    (panel,) = figure.panels
    caption = tag("figcaption", panel.caption) if panel.caption else ""
    return tag("figure", caption, _picture([[panel]], figure.description), style=f"width:{panel.width:.0f}px")


def _caption(panel: Panel) -> Markup:
    note = join(" ", tag("span", panel.note, class_="muted")) if panel.note else ""
    return tag("figcaption", tag("span", panel.caption), note)


def _description(figure: Figure, panel: Panel) -> str:
    """Return the description of one panel of a figure: that of the figure and the panel's caption, with a comma, if any."""
    return ", ".join(filter(None, (figure.description, panel.caption)))


class Entry(NamedTuple):
    """An entry of a legend: its words, its marks, and the attribute by which the page's script hides the marks' runs."""

    words: str
    marks: Sequence[Mark]
    kind: str = ""
    value: str = ""


def key(legend: Sequence[Entry]) -> Markup:
    """Return a legend as an HTML list, a small drawing and words for each entry; empty without entries."""
    entries = []
    for entry in legend:
        drawn = map(_in_key, sorted(entry.marks, key=lambda mark: isinstance(mark, Points)))
        sample = tag("svg", *drawn, class_="plot", viewBox="0 0 22 14", width=22, height=14, aria_hidden="true")
        words = tag("span", entry.words)
        entries.append(tag("li", sample, words, data_of=entry.kind or None, data_value=entry.value or None))
    return tag("ul", *entries, class_="key") if entries else Markup("")


def key_of(figure: Figure) -> Markup:
    """Draw the legend of a figure; empty without entries."""
    return key([*starmap(Entry, figure.legend.items())])


def _in_key(mark: Mark) -> Markup:
    """Draw a mark in a legend, 22 × 14 px."""
    if isinstance(mark, Points):
        return marker(mark.look, 11, 7)
    if isinstance(mark, Area | Span):
        return tag("rect", x=1, y=1, width=20, height=12, class_=classes(mark.look))
    if isinstance(mark, Rule) and mark.look.kind == "limit":  # with serifs, to differ from the stroke of a rigid base
        return tag("path", d="M11 0v14M7 0h8M7 14h8", class_=classes(mark.look))
    if isinstance(mark, Rule) and mark.axis == "x":
        return tag("line", x1=11, x2=11, y1=0, y2=14, class_=classes(mark.look))
    return tag("line", x1=0, x2=22, y1=7, y2=7, class_=classes(mark.look))


def timed(figure: Figure, whole: Axis) -> Markup:
    """Draw panels against time below each other, as wide as the page: curves are stretched, words keep their size.

    The script switches between the time span of the panels and the ``whole`` duration: elements of one view only have
    class ``v0`` or ``v1``.
    """
    boxes, height = _boxes([[panel] for panel in figure.panels])
    views = list(dict.fromkeys([figure.panels[-1].x, whole]))
    content = [part for box in boxes for part in _stretched(box, views)]
    picture = tag("svg", *content, class_="plot readings", role="img", aria_label=figure.description)
    return tag("div", picture, class_="timed", style=f"--h:{height:.0f}px")


def _stretched(box: Box, views: Sequence[Axis]) -> Iterator[Markup]:
    """Draw a panel as wide as the page in an SVG of its own, then its words, which are not stretched."""
    panel, rows = box.panel, box.panel.y.ticks()
    shown = Box(panel, 0.0, 0.0, panel.width, panel.height)
    ends = [shown.across(np.array([view.low, view.high])).tolist() for view in views]
    low, high = ends[-1]
    inner = Box(replace(panel, x=views[-1]), low, 0.0, high - low, panel.height)
    grid = "".join(f"M{low:.1f} {at:.1f}H{high:.1f}" for at in inner.down(np.array([*rows])))
    parts = [tag("path", d=grid, class_="grid")]
    for place, view in enumerate(views):
        grid = "".join(f"M{at:.1f} 0V{inner.foot:.1f}" for at in inner.across(np.array([*view.ticks()])))
        parts.append(tag("path", d=grid, class_=f"grid v{place}"))
    parts += [_draw(mark, inner) for mark in panel.marks if isinstance(mark, Span)]
    parts.append(_readable(inner, [_draw(mark, inner) for mark in panel.marks if isinstance(mark, Polyline)]))
    parts += [_draw(mark, inner) for mark in panel.marks if isinstance(mark, Rule)]
    sizes = [f"{first:.1f} 0 {last - first:.1f} {panel.height:g}" for first, last in ends]
    yield tag(
        "svg",
        *parts,
        y=_short(box.top),
        height=_short(panel.height),
        viewBox=sizes[0],
        preserveAspectRatio="none",
        data_views="|".join(sizes) if len(sizes) > 1 else None,
    )
    yield tag("path", d=f"M0 {box.top:.1f}V{box.foot:.1f}", class_="edge")
    yield tag("line", x1="0", x2="100%", y1=_short(box.foot), y2=_short(box.foot), class_="edge")
    yield text(-34.0, box.top - 9.0, *_lettered(panel.y.label), class_="q")
    yield from (text(-4.0, float(box.down(at)) + 4.0, words, class_="e") for at, words in rows.items())
    for place, view in enumerate(views):
        words = [_beside(mark, view, box) for mark in panel.marks if isinstance(mark, Points | Words)]
        if panel.x.numbered:
            words += [
                text(_percentage(view, at), box.foot + 15.0, tick, class_="m") for at, tick in view.ticks().items()
            ]
        yield tag("g", *words, class_=f"v{place}")
    if panel.x.label:
        yield text("50%", box.foot + 29.0, *_lettered(panel.x.label), class_="m q")


def _percentage(x: Axis, value: float) -> str:
    """Return the position of ``value`` along an axis as a share of the width: "25.00%"."""
    return f"{100.0 * float(x.fraction(value)):.2f}%"


def _beside(mark: Points | Words, view: Axis, box: Box) -> Markup:
    """Draw the first marker of points, or words, at its share of the width; nothing outside the view."""
    x, y = (float(mark.x), float(mark.y)) if isinstance(mark, Words) else (float(mark.x[0]), float(mark.y[0]))
    if not view.low <= x <= view.high:
        return Markup("")
    if isinstance(mark, Points):
        return marker(mark.look, _percentage(view, x), float(box.down(y)))
    return _words(mark, _percentage(view, x), float(box.down(y)))


def _boxes(rows: Sequence[Sequence[Panel]]) -> tuple[list[Box], float]:
    """Lay rows of panels out in a picture; return their boxes and its height [px]. A panel without a frame is alone in it."""
    boxes, height, width = [], 0.0, max(sum(panel.width for panel in row) for row in rows)
    left = max(_room_left(row[0]) for row in rows)
    if not rows[0][0].framed:
        return [Box(rows[0][0], 0.0, 0.0, width, rows[0][0].height)], rows[0][0].height
    for row in rows:
        top = height + (22.0 if any(panel.y.label or (panel.caption and len(rows) > 1) for panel in row) else 6.0)
        height = top + max(panel.height + 14.0 * panel.x.numbered + 18.0 * bool(panel.x.label) for panel in row) + 3.0
        inner = (width - left - 8.0 - 10.0 * (len(row) - 1)) / len(row)
        boxes += [Box(panel, left + i * (inner + 10.0), top, inner, panel.height) for i, panel in enumerate(row)]
    return boxes, height


def _picture(rows: Sequence[Sequence[Panel]], description: str, more: str = "") -> Markup:
    """Draw rows of panels as one picture; ``more`` adds to its classes."""
    boxes, height = _boxes(rows)
    content = [part for box in boxes for part in _panel(box, len(rows) > 1)]
    marks = [mark for box in boxes for mark in box.panel.marks]
    said = any(mark.title or (isinstance(mark, Points) and mark.titles) for mark in marks)
    kinds = " marks" * said + " readings" * any(box.panel.reads for box in boxes) + more
    width = max(sum(panel.width for panel in row) for row in rows)
    return svg(width, height, *content, description=description, class_=f"plot{kinds}")


def svg(width: float, height: float, *content: object, description: str, class_: str = "plot") -> Markup:
    """Return an SVG element that shows ``width`` × ``height`` px, scaled to its place; screen readers read ``description``."""
    return tag("svg", *content, class_=class_, role="img", aria_label=description, viewBox=f"0 0 {width:g} {height:g}")


def _room_left(panel: Panel) -> float:
    """Return the width [px] left of the axes for the numbers of the ordinate, room for two letters or more."""
    longest = max(map(len, panel.y.ticks().values()), default=0) if panel.y.numbered else 0
    return 10.0 + 6.6 * max(longest, 2)


def _panel(box: Box, captioned: bool) -> Iterator[Markup]:
    """Draw the marks of a panel, areas behind its frame, the others before it, and its labels."""
    panel = box.panel
    behind = [mark for mark in panel.marks if isinstance(mark, Span | Area)]
    named = [mark for mark in panel.marks if isinstance(mark, Polyline) and mark.name and panel.reads]
    yield from (_draw(mark, box) for mark in behind)
    if panel.framed:
        yield _frame(box)
    if named:
        yield _readable(box, [_draw(line, box) for line in named])
    yield from (_draw(mark, box) for mark in panel.marks if mark not in behind and mark not in named)
    if panel.y.label:
        yield text(max(box.left - 34.0 * panel.y.numbered, 2.0), box.top - 9.0, *_lettered(panel.y.label), class_="q")
    if panel.x.label:
        yield text(
            box.left + box.width / 2, box.foot + 14.0 * panel.x.numbered + 15.0, *_lettered(panel.x.label), class_="m q"
        )
    if captioned and panel.caption:
        yield text(box.right, box.top - 9.0, panel.caption, class_="e")


def _frame(box: Box) -> Markup:
    """Draw axes, grid and numbers; an axis of names has no grid lines, and along x only as many names as have room."""
    x, y = box.panel.x, box.panel.y
    columns, rows = x.ticks(), y.ticks()
    lines = "".join(
        f"M{box.left:.1f} {at:.1f}H{box.right:.1f}" for at in box.down(np.array([*rows])) if y.names is None
    )
    lines += "".join(
        f"M{at:.1f} {box.top:.1f}V{box.foot:.1f}" for at in box.across(np.array([*columns])) if x.names is None
    )
    parts = [tag("path", d=lines, class_="grid")] if lines else []
    parts.append(tag("path", d=f"M{box.left:.1f} {box.top:.1f}V{box.foot:.1f}H{box.right:.1f}", class_="edge"))
    if y.numbered:
        parts += [text(box.left - 4, float(box.down(at)) + 4, words, class_="e") for at, words in rows.items()]
    if x.numbered:
        every = math.ceil(7.0 * max(map(len, columns.values()), default=1) * len(columns) / box.width) if x.names else 1
        shown = list(columns.items())[::every]  # names of all columns would overlap
        parts += [text(float(box.across(at)), box.foot + 15, words, class_="m") for at, words in shown]
    return join(*parts)


def _readable(box: Box, lines: Sequence[Markup]) -> Markup:
    """Group lines with the axes' data, by which the script converts pixels to values."""
    x, y = box.panel.x, box.panel.y
    return tag(
        "g",
        *lines,
        class_="axes",
        data_kind=box.panel.reads,
        data_box=f"{box.left:g} {box.top:g} {box.width:g} {box.height:g}",
        data_x=f"{x.low:.6g} {x.high:.6g}",
        data_y=f"{y.low:.6g} {y.high:.6g}",
        data_names=f"{x.plain}|{y.plain}" if box.panel.reads == "plane" else None,
    )


def _lettered(label: str) -> Iterator[Markup]:
    """Yield the parts of a label, subscripts lowered."""
    raise_back = False
    for words, low in subscripts(label):
        if low:
            yield tag("tspan", words, dy="2", class_="sub")
        else:
            yield tag("tspan", words, dy="-2") if raise_back else join(words)
        raise_back = low


def classes(look: Look) -> str:
    """Return the CSS classes of a look: "curve s1 d2 open" for a kind, a colour, dashes and an open mark; "ink" for black."""
    colour = f"s{look.colour}" if look.colour else "ink" if look.kind in ("", "level", "filled") else ""
    return " ".join(filter(None, (look.kind, colour, f"d{look.dash}" * bool(look.dash), "open" * look.open)))


def text(x: float | str, y: float, *content: object, class_: str = "") -> Markup:
    """Draw text at (x, y); ``x`` in pixels, or a share of the width: "50%"."""
    return tag("text", *content, x=_short(x), y=_short(y), class_=class_ or None)


def marker(
    look: Look, x: float | str, y: float, title: str = "", shade: float | None = None, case: str | None = None
) -> Markup:
    """Return a marker at (x, y) [px, or "50%"] with a tooltip; "?" for failed runs. ``shade``, 0 to 1, makes it darker."""
    tooltip = tag("title", title) if title else Markup("")
    if look.shape == "failed":
        return text(x, y + 4, "?", tooltip, class_="m none")
    opacity = None if shade is None else f"{0.15 + 0.85 * shade:.2f}"
    return tag(
        "use",
        tooltip,
        href=f"#m-{look.shape}",
        x=_short(x),
        y=_short(y),
        class_=classes(look),
        fill_opacity=opacity,
        data_case=case,
    )


@singledispatch
def _draw(mark: object, box: Box) -> Markup:
    """Return a mark of a figure as drawn in its panel; ``TypeError`` for what is no mark."""
    raise TypeError(f"{type(mark).__name__}: no mark of a figure")


@_draw.register
def _(mark: Polyline, box: Box) -> Markup:
    x, y = mark.x, mark.y
    within = (box.panel.x.low <= x) & (x <= box.panel.x.high) & (box.panel.y.low <= y) & (y <= box.panel.y.high)
    inside = np.where(within, y, np.nan)  # the curve of an overturning pier leaves the panel
    return curve(box.across(x), box.down(inside), classes(mark.look), mark.name or None, mark.title)


@_draw.register
def _(mark: Area, box: Box) -> Markup:
    return curve(box.across(mark.x), box.down(mark.y), classes(mark.look), None, mark.title)


@_draw.register
def _(mark: Points, box: Box) -> Markup:
    across, down = box.across(mark.x), box.down(mark.y)
    shades = repeat(None) if mark.shade is None else mark.shade[0].fraction(mark.shade[1])
    points = zip(across.tolist(), down.tolist(), mark.titles or repeat(mark.title), shades, strict=False)
    shown = [marker(mark.look, x, y, title, shade) for x, y, title, shade in points if math.isfinite(x + y)]
    return join(*_error_bars(mark, box), *shown)


def _error_bars(mark: Points, box: Box) -> Iterator[Markup]:
    """Draw the positive errors of points as bars, clipped to the axis."""
    axis, errors = box.panel.y, np.zeros(len(mark.x)) if mark.error is None else mark.error
    for x, y, error in zip(mark.x, mark.y, errors, strict=True):
        if error > 0.0:
            at, (top, foot) = float(box.across(x)), box.down(np.clip([y + error, y - error], axis.low, axis.high))
            yield tag("path", d=f"M{at - 2.5:.1f} {top:.1f}h5m-2.5 0V{foot:.1f}m-2.5 0h5", class_="bar")


@_draw.register
def _(mark: Rule, box: Box) -> Markup:
    if mark.axis == "x":
        low, high = box.foot - mark.low * box.height, box.foot - mark.high * box.height
        strokes = [f"M{x:.1f} {low:.1f}V{high:.1f}" for x in box.across(mark.at)]
    else:
        left, right = box.left + mark.low * box.width, box.left + mark.high * box.width
        strokes = [f"M{left:.1f} {y:.1f}H{right:.1f}" for y in box.down(mark.at)]
    if not strokes:
        return Markup("")
    return tag("path", tag("title", mark.title) if mark.title else "", d="".join(strokes), class_=classes(mark.look))


@_draw.register
def _(mark: Span, box: Box) -> Markup:
    x, y, width, height = box.left, box.top, box.width, box.height
    if mark.axis == "x":
        x, end = box.across(np.clip([mark.low, mark.high], box.panel.x.low, box.panel.x.high)).tolist()
        width = end - x
    else:
        end, y = box.down(np.clip([mark.low, mark.high], box.panel.y.low, box.panel.y.high)).tolist()
        height = end - y
    return tag("rect", x=_short(x), y=_short(y), width=_short(width), height=_short(height), class_=classes(mark.look))


@_draw.register
def _(mark: Words, box: Box) -> Markup:
    return _words(mark, float(box.across(mark.x)), float(box.down(mark.y)))


def _words(mark: Words, x: float | str, y: float) -> Markup:
    anchor = {-1: "e", 0: "m", 1: ""}[mark.side]
    class_ = " ".join(filter(None, (classes(mark.look), anchor)))
    place = {"x": _short(x), "y": _short(y + 3.5 - mark.lift), "dx": 7 * mark.side or None}
    return tag("text", mark.text, **place, class_=class_ or None)


def _short(value: float | str) -> str:
    return value if isinstance(value, str) else f"{value:.1f}".removesuffix(".0")


def curve(x: Array, y: Array, class_: str, name: str | None = None, title: str = "") -> Markup:
    """Draw a curve through points in pixels, interrupted at NaN and beyond ±10⁶; ``name`` is its name in the script."""
    tooltip = tag("title", title) if title else ""
    return tag("path", tooltip, d=_relative(x, y), transform=f"scale({1 / FINE:g})", class_=class_, data_name=name)


def _relative(x: Array, y: Array) -> str:
    """Return SVG path data in whole steps of a tenth of a pixel, thinned by :func:`_bends`; NaN and far points interrupt it."""
    drawn = (np.abs(x) < _FAR) & (np.abs(y) < _FAR)
    points = np.rint(FINE * np.column_stack([x[drawn], y[drawn]])).astype(np.int64)
    begins = (drawn & ~np.concatenate(([False], drawn[:-1])))[drawn]
    places = _bends(points, begins)
    parts = []
    for piece in np.split(points[places], np.flatnonzero(begins[places])[1:]) if len(places) else ():
        steps = " ".join(map(str, np.diff(piece, axis=0).ravel().tolist())).replace(" -", "-")
        parts.append(f"M{piece[0, 0]} {piece[0, 1]}" + (f"l{steps}" if steps else "h0"))
    return "".join(parts)


def _bends(points: npt.NDArray[np.int64], begins: npt.NDArray[np.bool_]) -> npt.NDArray[np.int64]:
    """Return the indices of the points to keep, so that no curve moves by more than a step (Ramer, Douglas, Peucker).

    ``points`` has shape (n, 2); ``begins``, shape (n,), is True where a new curve starts. Turning points are kept, so that
    extremes are exact; between them, points are added where they lie farthest from their chord, until none is over a step away.
    """
    places = np.flatnonzero(
        begins | np.concatenate(([False], np.any(np.diff(points, axis=0) != 0, axis=1)))[: len(points)]
    )
    points, begins = points[places], begins[places]
    kept = begins | np.concatenate((begins[1:], [True]))[: len(points)]
    ways = np.sign(np.diff(points, axis=0))
    known = np.where((ways != 0) | begins[:-1, None], np.arange(len(ways))[:, None], 0)
    ways = np.take_along_axis(
        ways, np.maximum.accumulate(known, axis=0), axis=0
    )  # a level stretch keeps the direction before it
    kept[1:-1] |= np.any(ways[1:] * ways[:-1] < 0, axis=1)
    (x, y), inner = np.ascontiguousarray(points.T), np.flatnonzero(~kept)
    while len(inner):
        ends = np.flatnonzero(kept)
        first = np.searchsorted(inner, ends)
        count = first[1:] - first[:-1]
        open_ = np.flatnonzero(count)  # chords with points between their ends
        first, count, start, end = first[open_], count[open_], ends[open_], ends[open_ + 1]
        across, down = x[end] - x[start], y[end] - y[start]
        offset, length = across * y[start] - down * x[start], np.hypot(across, down)
        across, down, offset, length = (np.repeat(of_chord, count) for of_chord in (across, down, offset, length))
        away = np.abs(across * y[inner] - down * x[inner] - offset) / length
        largest = np.maximum.reduceat(away, first)
        farthest = away == np.repeat(np.where(largest > 1.0, largest, -1.0), count)
        kept[inner[farthest]] = True
        inner = inner[np.repeat(largest > 1.0, count) & ~farthest]
    return places[kept]
