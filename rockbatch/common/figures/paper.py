"""Figures drawn by matplotlib, for notebooks and papers. Loads matplotlib: imported where one is drawn.

Colours and dashes are those of the page; letters have the size in which they are printed, whatever the width.
"""

import math
import textwrap
from collections.abc import Callable, Iterator, Sequence
from functools import singledispatch
from io import BytesIO
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure as MatplotlibFigure
from matplotlib.patches import PathPatch
from matplotlib.path import Path
from matplotlib.patheffects import withStroke
from matplotlib.ticker import FixedLocator, NullLocator

from rockbatch.common.figures.description import (
    Area,
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

PALETTE = ("#1c2126", "#0b62a8", "#b4470c", "#00755a", "#8b3f94", "#806000", "#00788f", "#b01e5b")
"""Ink, and the colours of series."""
ALARM = "#b3261e"
MUTED, PALE = "#5f6a74", "#eef1f3"

MM = 0.25
"""Millimetres of the paper for a pixel of the page."""
LETTERS, BESIDE = 0.62, 10.0
"""Letters in a line of a caption for each millimetre of the axes, and room beside these [mm]."""

_DASHES: tuple[Any, ...] = ("-", (0, (6, 3)), (0, (2, 2)), (0, (8, 2, 2, 2)))
_MARKERS = {
    "disc": "o", "square": "s", "up": "^", "diamond": "D", "down": "v", "cross": "P", "star": "*", "left": "<", "right": ">",
    "hexagon": "h", "dot": ".", "overturned": "X", "flight": r"$\uparrow$", "failed": "$?$",
}  # fmt: skip
_KINDS: dict[str, dict[str, Any]] = {
    "alarm": {"color": ALARM}, "none": {"color": "#8a5a00"}, "limit": {"color": ALARM, "linewidth": 1.2},
    "curve": {"linewidth": 0.7}, "behind": {"linewidth": 0.5}, "right": {"linewidth": 0.7, "alpha": 0.5},
    "faint": {"color": MUTED, "linewidth": 0.5, "alpha": 0.6}, "target": {"linewidth": 2.0}, "bar": {"linewidth": 0.8},
    "edge": {"color": MUTED, "linewidth": 0.6}, "event": {"color": MUTED, "linewidth": 0.6},
    "flown": {"color": MUTED, "linewidth": 0.6, "linestyle": "--"}, "band": {"color": PALE}, "filled": {"alpha": 0.45},
    "area": {"alpha": 0.15}, "unsure": {"alpha": 0.07}, "deck": {"color": MUTED},
}  # fmt: skip
"""Differences from a line or an area in the colour of its series, by the role of a mark."""
_STYLE: Any = {
    "font.size": 8.0, "axes.titlesize": 7.0, "axes.labelsize": 8.0, "figure.titlesize": 9.0, "figure.labelsize": 8.0,
    "legend.fontsize": 7.0, "xtick.labelsize": 7.0, "ytick.labelsize": 7.0, "legend.frameon": False,
    "axes.grid": True, "axes.axisbelow": True, "grid.alpha": 0.3, "lines.linewidth": 1.0, "lines.markersize": 4.0,
}  # fmt: skip


class ShownFigure(MatplotlibFigure):
    """A matplotlib Figure that is not pyplot's, and shows itself in a notebook nevertheless, also without ``%matplotlib``."""

    def _repr_png_(self) -> bytes:
        picture = BytesIO()
        self.savefig(picture, format="png", dpi=110)
        return picture.getvalue()


def drawn(figure: Figure, width_mm: float) -> MatplotlibFigure:
    """Draw a figure ``width_mm`` wide."""
    with mpl.rc_context(_STYLE):
        rows = list(_rows(figure, width_mm))
        columns = [len(row if figure.stacked else rows[0]) for row in rows]
        heights = [
            max(_height(panel, width_mm / abreast, figure.stacked) for panel in row)
            for row, abreast in zip(rows, columns, strict=True)
        ]
        result = ShownFigure(layout="constrained")
        grid = result.add_gridspec(len(rows), math.lcm(*columns), height_ratios=heights)
        entries: dict[str, dict[type, Artist]] = {}
        for place, (row, abreast) in enumerate(zip(rows, columns, strict=True)):
            each = grid.ncols // abreast
            for column, panel in enumerate(row):
                axes = result.add_subplot(grid[place, column * each : (column + 1) * each])
                for mark, artist in _panel(axes, panel, width_mm / abreast):
                    entries.setdefault(mark.label, {}).setdefault(type(mark), artist)
        entries.pop("", None)
        _colour_bar(result, figure)
        height = sum(heights) + _legend(result, entries, width_mm) + 7.0 * bool(figure.title) + 2.0
        if figure.title:
            result.suptitle(_text(figure.title))
        result.set_size_inches(width_mm / 25.4, height / 25.4)
        return result


def _legend(result: MatplotlibFigure, entries: dict[str, dict[type, Artist]], width_mm: float) -> float:
    """Draw the legend of all panels below them; return its height [mm]."""
    if not entries:
        return 0.0
    columns = max(1, min(len(entries), int(width_mm / (8.0 + 1.4 * max(map(len, entries))))))
    together: Any = [tuple(artists.values()) for artists in entries.values()]
    result.legend(together, list(map(_text, entries)), loc="outside lower center", ncols=columns)
    return 4.0 * math.ceil(len(entries) / columns)


def _colour_bar(result: MatplotlibFigure, figure: Figure) -> None:
    """Draw the scale of tones, if marks have any."""
    for mark in (mark for panel in figure.panels for mark in panel.marks):
        if isinstance(mark, Points) and mark.shade:
            scale = mark.shade[0]
            tones = ScalarMappable(LogNorm(scale.low, scale.high), "cividis")
            result.colorbar(tones, ax=result.axes, label=_label(scale))
            return


def _rows(figure: Figure, width_mm: float) -> Iterator[Sequence[Panel]]:
    """Yield the panels of each row: as many as there is room for, or as they are stacked."""
    if not figure.stacked:
        columns = max(1, min(len(figure.panels), round(width_mm / (MM * max(panel.width for panel in figure.panels)))))
        yield from (figure.panels[i : i + columns] for i in range(0, len(figure.panels), columns))
        return
    for row in figure.rows:
        abreast = len(row) if width_mm >= 50.0 * len(row) else 1
        yield from (row[i : i + abreast] for i in range(0, len(row), abreast))


def _height(panel: Panel, width_mm: float, stacked: bool) -> float:
    """Return the height of a panel with what stands above and below it [mm]."""
    wider = 1.0 if stacked else min(max(width_mm / (MM * panel.width), 0.8), 1.5)
    beside = 3.2 * len(_caption(panel, width_mm)) + 4.0 * panel.x.numbered + 4.0 * bool(panel.x.label) + 2.0
    return MM * panel.height * wider + beside


def _caption(panel: Panel, width_mm: float) -> list[str]:
    """Return the lines of a panel's caption."""
    words = ", ".join(filter(None, (panel.caption, panel.note)))
    return textwrap.wrap(words, int(LETTERS * (width_mm - BESIDE)))


def _panel(axes: Axes, panel: Panel, width_mm: float) -> Iterator[tuple[Mark, Artist]]:
    """Draw a panel; yield its marks as they are drawn."""
    for mark in panel.marks:
        yield mark, _draw(mark, axes)
    axes.set_title("\n".join(map(_text, _caption(panel, width_mm))))
    for axis, scale in (("x", panel.x), ("y", panel.y)):
        _axis(axes, axis, scale)
    if not panel.framed:
        axes.set_axis_off()
        axes.set_aspect("equal")


def _axis(axes: Axes, which: str, scale: Axis) -> None:
    axis = axes.xaxis if which == "x" else axes.yaxis
    if scale.log:
        axis.set_major_locator(FixedLocator([scale.low, scale.high]))  # or it looks for ticks of a range not set yet
        getattr(axes, f"set_{which}scale")("log")
    getattr(axes, f"set_{which}lim")(scale.low, scale.high)
    ticks = scale.ticks()
    axis.set_minor_locator(NullLocator())
    axis.set_ticks(list(ticks), list(map(_text, ticks.values())) if scale.numbered else [""] * len(ticks))
    axis.set_label_text(
        "".join(rf"$_\mathrm{{{words}}}$" if low else _text(words) for words, low in subscripts(scale.label))
    )
    if scale.names is not None:
        axis.grid(False)


def _label(scale: Axis) -> str:
    return "".join(rf"$_\mathrm{{{words}}}$" if low else _text(words) for words, low in subscripts(scale.label))


def _text(words: str) -> str:
    """Return text that matplotlib shows as it is: no formulas, and no label that it hides."""
    return (" " * words.startswith("_") + words).replace("$", r"\$").replace("θ̇", r"$\dot{\theta}$")


def _style(look: Look) -> dict[str, Any]:
    reverse = {"alpha": 0.6, "linestyle": (0, (3, 2))} if look.open and look.kind == "rigid" else {}
    return {"color": PALETTE[look.colour], "linestyle": _DASHES[look.dash]} | _KINDS.get(look.kind, {}) | reverse


def _area(look: Look) -> dict[str, Any]:
    return {"linewidth": 0.0, "facecolor": PALETTE[look.colour]} | {
        {"color": "facecolor"}.get(key, key): value for key, value in _KINDS.get(look.kind, {}).items()
    }


@singledispatch
def _draw(mark: Any, axes: Axes) -> Artist:
    """Draw a mark; return what stands for it in the legend."""
    raise TypeError(f"{type(mark).__name__}: no mark of a figure")


@_draw.register
def _(mark: Polyline, axes: Axes) -> Artist:
    return axes.plot(mark.x, mark.y, **_style(mark.look))[0]


@_draw.register
def _(mark: Area, axes: Axes) -> Artist:
    gaps = np.flatnonzero(np.isnan(mark.x))
    pieces = np.split(np.column_stack([mark.x, mark.y]), gaps)
    outlines = [
        Path(np.vstack([piece, piece[:1]]), closed=True) for each in pieces if len(piece := each[~np.isnan(each[:, 0])])
    ]
    together = Path.make_compound_path(*outlines) if outlines else Path(np.empty((0, 2)))  # or a hair stays between two
    return axes.add_patch(PathPatch(together, **_area(mark.look)))


@_draw.register
def _(mark: Points, axes: Axes) -> Artist:
    style = _style(mark.look) | {"linestyle": "", "marker": _MARKERS[mark.look.shape]}
    if mark.error is not None and np.any(longer := mark.error > 0.0):
        axes.errorbar(
            mark.x[longer],
            mark.y[longer],
            mark.error[longer],
            fmt="none",
            ecolor=PALETTE[0],
            elinewidth=0.6,
            capsize=1.5,
        )
    if mark.shade is not None:
        scale, values = mark.shade
        toned = axes.scatter(mark.x, mark.y, 14.0, values, norm=LogNorm(scale.low, scale.high), cmap="cividis")
        return toned
    return axes.plot(
        mark.x, mark.y, **style, clip_on=False, **({"mfc": "none"} if mark.look.open else {"mew": 0.3, "mec": "w"})
    )[0]


@_draw.register
def _(mark: Rule, axes: Axes) -> Artist:
    across: Callable[..., Any] = axes.axvline if mark.axis == "x" else axes.axhline
    return (
        [across(at, mark.low, mark.high, **_style(mark.look)) for at in mark.at]
        or axes.plot([], [], **_style(mark.look))
    )[0]


@_draw.register
def _(mark: Span, axes: Axes) -> Artist:
    across: Callable[..., Any] = axes.axvspan if mark.axis == "x" else axes.axhspan
    return across(mark.low, mark.high, zorder=0.5, **_area(mark.look))


@_draw.register
def _(mark: Words, axes: Axes) -> Artist:
    return axes.annotate(
        _text(mark.text), (mark.x, mark.y), (4.0 * mark.side, 0.7 * mark.lift), textcoords="offset points", fontsize=6.0,
        color=_style(mark.look)["color"], va="center", path_effects=[withStroke(linewidth=1.5, foreground="w")], zorder=4.0,
        ha={-1: "right", 0: "center", 1: "left"}[mark.side],
    )  # fmt: skip
