"""Figures drawn by matplotlib, for notebooks and papers. Loads matplotlib: imported where one is drawn.

Colours and dashes are those of the page; letters have the size in which they are printed, whatever the width.
"""

import itertools
import math
import textwrap
from collections.abc import Callable, Collection, Sequence
from dataclasses import replace
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
from matplotlib.figure import FigureBase
from matplotlib.patches import PathPatch
from matplotlib.path import Path
from matplotlib.patheffects import withStroke
from matplotlib.ticker import FixedLocator, NullLocator
from matplotlib.transforms import ScaledTranslation

from rockbatch.common.errors import InputError, Problem, WrongType, refuse
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
from rockbatch.common.showing import shown

PALETTE = ("#1c2126", "#0b62a8", "#b4470c", "#00755a", "#8b3f94", "#806000", "#00788f", "#b01e5b")
"""Ink, and the colours of series."""
ALARM = "#b3261e"
MUTED, PALE = "#5f6a74", "#eef1f3"

MM = 0.25
"""Millimetres of the paper for a pixel of the page."""
LETTERS, BESIDE = 0.62, 10.0
"""Letters in a line of a caption for each millimetre of the axes, and room beside these [mm]."""
LETTER = 1.4
"""Width of a letter of numbers and legends [mm]."""
PROPORTION, NARROWEST, LOWEST = 1.2, 20.0, 9.0
"""Height over width of all panels together, so that the figure fits A4; narrowest panel and lowest axes for its sake [mm]."""
COLUMN = 88.0
"""Width of a column of a paper [mm]."""
LEAST_SIZE = 0.5
"""Height of panels that share their axes, over that on the page."""
LEAST_WIDTH = 0.6
"""Width to which panels are narrowed so that more stand abreast, over that on the page."""
CROWDED = 1.25
"""Height of a figure over that of the place for it, above which its panels would not be legible."""

Style = dict[str, Any]
"""Keyword arguments of matplotlib's functions."""
_DASHES: tuple[object, ...] = ("-", (0, (6, 3)), (0, (2, 2)), (0, (8, 2, 2, 2)))
_MARKERS = {
    "disc": "o",
    "square": "s",
    "up": "^",
    "diamond": "D",
    "down": "v",
    "cross": "P",
    "star": "*",
    "left": "<",
    "right": ">",
    "hexagon": "h",
    "dot": ".",
    "overturned": "X",
    "flight": r"$\uparrow$",
    "failed": "$?$",
}
_KINDS: dict[str, Style] = {
    "alarm": {"color": ALARM},
    "none": {"color": "#8a5a00"},
    "limit": {"color": ALARM, "linewidth": 1.2},
    "curve": {"linewidth": 0.7},
    "behind": {"linewidth": 0.5},
    "right": {"linewidth": 0.7, "alpha": 0.5},
    "faint": {"color": MUTED, "linewidth": 0.5, "alpha": 0.6},
    "target": {"linewidth": 2.0},
    "bar": {"linewidth": 0.8},
    "edge": {"color": MUTED, "linewidth": 0.6},
    "event": {"color": MUTED, "linewidth": 0.6},
    "flown": {"color": MUTED, "linewidth": 0.6, "linestyle": "--"},
    "band": {"color": PALE},
    "filled": {"alpha": 0.45},
    "area": {"alpha": 0.15},
    "unsure": {"alpha": 0.07},
    "deck": {"color": MUTED},
}
"""Differences from a line or an area in the colour of its series, by the role of a mark."""
_STYLE: Any = {
    "font.size": 8.0,
    "axes.titlesize": 7.0,
    "axes.labelsize": 8.0,
    "figure.titlesize": 9.0,
    "figure.labelsize": 8.0,
    "legend.fontsize": 7.0,
    "xtick.labelsize": 7.0,
    "ytick.labelsize": 7.0,
    "legend.frameon": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.alpha": 0.3,
    "lines.linewidth": 1.0,
    "lines.markersize": 4.0,
}


Entries = dict[str, dict[type[Mark], Artist]]
"""What stands for each label of a legend, one artist for each type of mark."""

Arranged = tuple[list[list[Panel]], list[float], float]
"""Rows of panels, their heights [mm], and the distance of columns that share their axes [mm], else 0."""


class ShownFigure(MatplotlibFigure):
    """A matplotlib Figure that is not pyplot's, and shows itself in a notebook nevertheless, also without ``%matplotlib``."""

    def _repr_png_(self) -> bytes:
        picture = BytesIO()
        self.savefig(picture, format="png", dpi=110)
        return picture.getvalue()


def drawn(figure: Figure, width_mm: float, ax: Axes | None = None) -> MatplotlibFigure:
    """Return the matplotlib figure in which ``figure`` is drawn, ``width_mm`` wide, or that of ``ax``.

    One panel is drawn in ``ax`` as by :func:`panel_in`, several in its place. Raises ``InputError`` for an ``ax`` that is no
    Axes, and if there are several panels and it is in no grid, in one inside a cell of another, or too low for them.
    """
    _check_axes(ax)
    with mpl.rc_context(_STYLE):
        if ax is None:
            own = ShownFigure(layout="constrained")
            height = _drawn_in(own, figure, width_mm, PROPORTION * width_mm)
            own.set_size_inches(width_mm / 25.4, height / 25.4)
            return own
        whole = ax.figure.figure
        if len(figure.panels) == 1:
            panel_in(figure, ax)
        else:
            _in_place_of(ax, figure)
        if whole.get_layout_engine() is None:
            whole.set_layout_engine("constrained")  # or labels of neighbours overlap
        return whole


def _in_place_of(ax: Axes, figure: Figure) -> None:
    """Draw several panels in the cell of the grid in which ``ax`` is, and remove it."""
    place, parent = ax.get_subplotspec(), ax.figure
    if place is None:
        raise InputError("ax: is in no grid, and this figure has several panels; make it by matplotlib's subplots()")
    if place.get_topmost_subplotspec() is not place:
        raise InputError(
            "ax: is in a grid inside a cell of another, and this figure has several panels; "
            "make it by subplots(), or in a subfigure"
        )
    grid = place.get_gridspec()
    across, down = (np.asarray(ratios, dtype=float) for ratios in (grid.get_width_ratios(), grid.get_height_ratios()))
    share = across[list(place.colspan)].sum() / across.sum(), down[list(place.rowspan)].sum() / down.sum()
    width, height = (25.4 / parent.dpi * float(length) for length in np.array(parent.bbox.size) * share)
    _, lowest = _sized(figure, width, height)
    if lowest > CROWDED * height:
        raise InputError(
            f"ax: {len(figure.panels)} panels and their legend need {lowest:.0f} mm of height here, and it has {height:.0f} mm; "
            f"make the figure wider or higher{', or give it fewer rows' if grid.nrows > 1 else ''}"
        )
    ax.remove()
    _drawn_in(parent.add_subfigure(place), figure, width, height)


def panel_in(figure: Figure, ax: Axes | None, name: str = "") -> Axes:
    """Draw one panel of a figure into ``ax``, or into a figure of one column of a paper; return the axes.

    It is the first panel, or the first with the caption ``name``. The legend stands below the axes, where it covers nothing.
    Raises ``InputError`` for an unknown caption, with those of the figure, and for an ``ax`` that is no Axes.
    """
    _check_axes(ax)
    panels = [panel for panel in figure.panels if name in ("", panel.caption)]
    if not panels:
        captions = ", ".join(dict.fromkeys(panel.caption for panel in figure.panels)) or "none"
        raise InputError(f"there is no panel {shown(name)}; there are {captions}")
    with mpl.rc_context(_STYLE):
        if ax is None:
            ax = ShownFigure(figsize=(COLUMN / 25.4, 0.8 * COLUMN / 25.4), layout="constrained").add_subplot()
        elif ax.figure.figure.get_layout_engine() is None:
            ax.figure.figure.set_layout_engine("constrained")  # or the legend below stands beyond the figure
        width = 25.4 / ax.figure.dpi * ax.bbox.width
        entries: Entries = {}
        _panel(ax, panels[0], width, entries)
        if not ax.get_title():
            ax.set_title(" ", pad=1.5 * _STYLE["axes.labelsize"] + 4.0)  # room for the label above the axes
        ax.tick_params(labelsize=_STYLE["xtick.labelsize"])
        for label in (ax.xaxis.label, ax.yaxis.label):
            label.set_fontsize(_STYLE["axes.labelsize"])
        if panels[0].framed:
            ax.grid(True, axis="both" if panels[0].x.names is None else "y", alpha=_STYLE["grid.alpha"])
        ax.set_axisbelow(True)
        _colour_bar(ax.figure, [ax], replace(figure, panels=panels[:1]))
        if entries:
            below = 4.0 + 4.0 * panels[0].x.numbered + 4.0 * bool(panels[0].x.label)
            columns = _columns_of_legend(entries, width)
            letters = max(int((width - 8.0) / LETTER), 12)
            lines = {"\n".join(textwrap.wrap(words, letters)): artists for words, artists in entries.items()}
            ax.legend(
                **_legend_of(lines),
                loc="upper left",
                bbox_to_anchor=(0.0, 0.0),
                bbox_transform=ax.transAxes + ScaledTranslation(0.0, -below / 25.4, ax.figure.dpi_scale_trans),
                ncols=columns,
                borderaxespad=0.0,
            )
    return ax


def _check_axes(ax: object) -> None:
    """Raise ``InputError`` for what is neither axes nor None."""
    if ax is not None and not isinstance(ax, Axes):
        text = f"ax = {repr(ax)[:60]}: must be an Axes, as matplotlib's subplots() makes, or None"
        refuse([Problem("ax", None, text, kind=WrongType, named=False)])


def _sized(figure: Figure, width_mm: float, tallest: float) -> tuple[Arranged, float]:
    """Return panels in rows, lowered within limits if they are over ``tallest`` mm together, and the figure's height [mm]."""
    rows, heights, across = _arranged(figure, width_mm, tallest)
    spare = MM * min((panel.height for panel in figure.panels), default=0.0) * (LEAST_SIZE if across else 0.8) - LOWEST
    lower = min(max(sum(heights) - tallest, 0.0) / len(rows), spare)
    heights = [height - lower for height in heights]
    lines = len(_title(figure, width_mm)) + math.ceil(len(figure.legend) / _columns_of_legend(figure.legend, width_mm))
    return (rows, heights, across), sum(heights) + 4.0 * lines + 5.0


def _title(figure: Figure, width_mm: float) -> list[str]:
    """Return the lines of a figure's title."""
    return textwrap.wrap(figure.title, int(0.5 * width_mm))


def _columns_of_legend(labels: Collection[str], width_mm: float) -> int:
    """Return how many entries of a legend of this width stand side by side, one at least."""
    longest = 8.0 + LETTER * max(map(len, labels), default=0)
    return max(1, min(len(labels), int(width_mm / longest)))


def _drawn_in(place: FigureBase, figure: Figure, width_mm: float, tallest: float) -> float:
    """Draw a figure in ``place``; return its height [mm]. Panels over ``tallest`` mm together are lowered, within limits."""
    (rows, heights, across), height = _sized(figure, width_mm, tallest)
    columns = [len(row if figure.stacked else rows[0]) for row in rows]
    grid = place.add_gridspec(len(rows), math.lcm(*columns), height_ratios=heights)
    entries: Entries = {}
    made = []
    for at, (row, abreast) in enumerate(zip(rows, columns, strict=True)):
        each = grid.ncols // abreast
        for column, panel in enumerate(row):
            axes = place.add_subplot(grid[at, column * each : (column + 1) * each])
            _panel(axes, panel, across or width_mm / abreast - BESIDE, entries)
            made.append(axes)
    _colour_bar(place, made, figure)
    if title := _title(figure, width_mm):
        place.suptitle("\n".join(map(_text, title)))
    if entries:
        ncols = _columns_of_legend(entries, width_mm)
        place.legend(**_legend_of(entries), loc="outside lower center", ncols=ncols)
    return height


def _legend_of(entries: Entries) -> Style:
    return {"handles": [tuple(artists.values()) for artists in entries.values()], "labels": list(map(_text, entries))}


def _colour_bar(place: FigureBase, axes: Sequence[Axes], figure: Figure) -> None:
    """Draw the scale of tones of the first marks that have any; nothing without them."""
    for mark in (mark for panel in figure.panels for mark in panel.marks):
        if isinstance(mark, Points) and mark.shade:
            scale = mark.shade[0]
            tones = ScalarMappable(LogNorm(scale.low, scale.high), "cividis")
            place.colorbar(tones, ax=axes, label=_label(scale))
            return


def _arranged(figure: Figure, width_mm: float, tallest: float) -> Arranged:
    """Return panels in rows, stacked as they are or as many abreast as have room, with heights and distance of columns.

    More stand abreast, of panels that share their axes also lower, if the rows would together be higher than ``tallest`` mm.
    """
    if figure.stacked:
        rows = []
        for row in figure.rows:
            abreast = len(row) if width_mm >= 50.0 * len(row) else 1
            rows += [row[i : i + abreast] for i in range(0, len(row), abreast)]
        return rows, [max(_height(panel, width_mm / len(row)) for panel in row) for row in rows], 0.0
    first, count = figure.panels[0], len(figure.panels)
    widest = MM * max(panel.width for panel in figure.panels)
    columns = max(1, min(count, round(width_mm / widest)))
    if count == columns or any((panel.x, panel.y) != (first.x, first.y) for panel in figure.panels):
        arranged = _grid(figure.panels, columns, width_mm, 0.8)
        while columns < count and sum(arranged[1]) > tallest and width_mm >= LEAST_WIDTH * widest * (columns + 1):
            columns += 1
            arranged = _grid(figure.panels, columns, width_mm, 0.8)
        return arranged
    for abreast in itertools.count(columns):
        across = (width_mm - BESIDE) / abreast
        rows, heights, _ = _grid(_inner(figure.panels, abreast), abreast, width_mm, LEAST_SIZE, across)
        if sum(heights) <= tallest or width_mm < NARROWEST * (abreast + 1):
            break
    return rows, heights, across


def _grid(panels: Sequence[Panel], columns: int, width_mm: float, least: float, across: float = 0.0) -> Arranged:
    """Return the panels in rows of ``columns``, as much higher than on the page as they are wider: ``least`` to 1.5 times."""
    size = min(max(width_mm / columns / (MM * max(panel.width for panel in panels)), least), 1.5)
    rows = [list(panels[i : i + columns]) for i in range(0, len(panels), columns)]
    heights = [max(_height(panel, width_mm / columns, size, across) for panel in row) for row in rows]
    return rows, heights, across


def _inner(panels: Sequence[Panel], columns: int) -> list[Panel]:
    """Return panels that share their axes: numbers at the left and at the foot, the upper label above the first row."""
    inner = []
    for place, panel in enumerate(panels):
        left, foot = place % columns == 0, place + columns >= len(panels)
        label = panel.y.label if place == 0 else " " * (place < columns)  # a blank keeps the height of the first row
        x = replace(panel.x, numbered=panel.x.numbered and foot, label=panel.x.label * foot)
        y = replace(panel.y, numbered=panel.y.numbered and left, label=label)
        inner.append(replace(panel, x=x, y=y))
    return inner


def _height(panel: Panel, width_mm: float, size: float = 1.0, across: float = 0.0) -> float:
    """Return the height of a panel with what stands above and below it [mm]."""
    lines = len(_caption(panel, across or width_mm - BESIDE)) + bool(panel.y.label and panel.framed)
    return MM * panel.height * size + 3.2 * lines + 4.0 * panel.x.numbered + 4.0 * bool(panel.x.label) + 2.0


def _caption(panel: Panel, across: float) -> list[str]:
    """Return the lines of a panel's caption above axes of this width [mm]."""
    words = ", ".join(filter(None, (panel.caption, panel.note)))
    return textwrap.wrap(words, max(int(LETTERS * across), 6))


def _panel(axes: Axes, panel: Panel, across: float, entries: Entries) -> None:
    """Draw a panel, and add the artist of each labelled mark to the ``entries`` of the legend."""
    for mark in panel.marks:
        artist = _draw(mark, axes)
        if mark.label:
            entries.setdefault(mark.label, {}).setdefault(type(mark), artist)
    for axis, scale in (("x", panel.x), ("y", panel.y)):
        _axis(axes, axis, scale, across)
    axes.yaxis.label.set(rotation=0.0, horizontalalignment="left", verticalalignment="bottom")
    axes.yaxis.set_label_coords(0.0, 1.02)
    pad = 1.5 * float(axes.yaxis.label.get_fontsize()) if panel.y.label else 0.0
    axes.set_title("\n".join(map(_text, _caption(panel, across))), pad=pad + 4.0)
    if not panel.framed:
        axes.set_axis_off()
        axes.set_aspect("equal")


def _axis(axes: Axes, which: str, scale: Axis, across: float) -> None:
    """Set limits, ticks and label of an axis; of numbers along an x axis ``across`` mm long as many as have room are written."""
    axis = axes.xaxis if which == "x" else axes.yaxis
    if scale.log:
        # without a fixed locator matplotlib looks for ticks in a range that is not set yet
        axis.set_major_locator(FixedLocator([scale.low, scale.high]))
        getattr(axes, f"set_{which}scale")("log")
    getattr(axes, f"set_{which}lim")(scale.low, scale.high)
    ticks = scale.ticks()
    axis.set_minor_locator(NullLocator())
    words = list(map(_text, ticks.values())) if scale.numbered else [""] * len(ticks)
    if which == "x" and scale.names is None and not scale.log and words:
        every = math.ceil(len(words) * (max(map(len, words)) * LETTER + 1.0) / across)
        words = [word if place % every == 0 else "" for place, word in enumerate(words)]
    axis.set_ticks(list(ticks), words)
    axis.set_label_text(_label(scale))
    if scale.names is not None:
        axis.grid(False)


def _label(scale: Axis) -> str:
    return "".join(rf"$_\mathrm{{{words}}}$" if low else _text(words) for words, low in subscripts(scale.label))


def _text(words: str) -> str:
    """Return text that matplotlib shows as it is: $ begins no formula, _ hides no label. θ̇ alone is set as a formula."""
    return (" " * words.startswith("_") + words).replace("$", r"\$").replace("θ̇", r"$\dot{\theta}$")


def _style(look: Look) -> Style:
    reverse = {"alpha": 0.6, "linestyle": (0, (3, 2))} if look.open and look.kind == "rigid" else {}
    return {"color": PALETTE[look.colour], "linestyle": _DASHES[look.dash]} | _KINDS.get(look.kind, {}) | reverse


def _area(look: Look) -> Style:
    return {"linewidth": 0.0, "facecolor": PALETTE[look.colour]} | {
        {"color": "facecolor"}.get(key, key): value for key, value in _KINDS.get(look.kind, {}).items()
    }


@singledispatch
def _draw(mark: Mark, axes: Axes) -> Artist:
    """Draw a mark; return the artist that stands for it in the legend. Raises ``TypeError`` for another object."""
    raise TypeError(f"{type(mark).__name__}: no mark of a figure")


@_draw.register
def _(mark: Polyline, axes: Axes) -> Artist:
    return axes.plot(mark.x, mark.y, **_style(mark.look))[0]


@_draw.register
def _(mark: Area, axes: Axes) -> Artist:
    gaps = np.flatnonzero(np.isnan(mark.x))
    pieces = np.split(np.column_stack([mark.x, mark.y]), gaps)
    outlines = [Path(piece) for each in pieces if len(piece := each[~np.isnan(each[:, 0])])]
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
    across: Callable[..., Artist] = axes.axvline if mark.axis == "x" else axes.axhline
    return (
        [across(at, mark.low, mark.high, **_style(mark.look)) for at in mark.at]
        or axes.plot([], [], **_style(mark.look))
    )[0]


@_draw.register
def _(mark: Span, axes: Axes) -> Artist:
    across: Callable[..., Artist] = axes.axvspan if mark.axis == "x" else axes.axhspan
    return across(mark.low, mark.high, zorder=0.5, **_area(mark.look))


@_draw.register
def _(mark: Words, axes: Axes) -> Artist:
    return axes.annotate(
        _text(mark.text),
        (mark.x, mark.y),
        (4.0 * mark.side, 0.7 * mark.lift),
        textcoords="offset points",
        fontsize=6.0,
        color=_style(mark.look)["color"],
        va="center",
        path_effects=[withStroke(linewidth=1.5, foreground="w")],
        zorder=4.0,
        ha={-1: "right", 0: "center", 1: "left"}[mark.side],
    )
