"""Style of the pictures that matplotlib draws, for notebooks and papers; the report draws its own. Loads matplotlib.

Lines differ in colour and in dashes, marks in colour and shape, so that they differ in grey and for the colour-blind
(colours of Okabe & Ito 2008). Letters have the size in which they are printed, whatever the width of the picture.
"""

import functools
import math
from collections.abc import Callable, Sequence
from io import BytesIO
from typing import Any, ParamSpec, TypeVar

import matplotlib as mpl
from matplotlib.axes import Axes
from matplotlib.figure import Figure

Arguments = ParamSpec("Arguments")
Drawn = TypeVar("Drawn")

WIDTH_MM = 160.0
"""Width of a picture across a page [mm]; a column of a journal has 88."""

COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#000000", "#E69F00", "#56B4E9")
_DASHES = ("-", "--", ":", "-.")
_MARKERS = "osD^vP*"
_STYLE: Any = {
    "font.size": 8.0, "axes.titlesize": 8.0, "axes.labelsize": 8.0, "figure.titlesize": 9.0, "figure.labelsize": 8.0,
    "legend.fontsize": 7.0, "xtick.labelsize": 7.0, "ytick.labelsize": 7.0, "legend.frameon": False,
    "axes.grid": True, "grid.alpha": 0.3, "lines.linewidth": 1.0, "lines.markersize": 4.0,
}  # fmt: skip


class ShownFigure(Figure):
    """A matplotlib Figure that is not pyplot's, and shows itself in a notebook nevertheless, also without ``%matplotlib``."""

    def _repr_png_(self) -> bytes:
        picture = BytesIO()
        self.savefig(picture, format="png", dpi=110)
        return picture.getvalue()


def styled(draw: Callable[Arguments, Drawn]) -> Callable[Arguments, Drawn]:
    """Have a function draw in this module's style."""

    @functools.wraps(draw)
    def drawn(*args: Arguments.args, **kwargs: Arguments.kwargs) -> Drawn:
        with mpl.rc_context(_STYLE):
            return draw(*args, **kwargs)

    return drawn


def figure(width_mm: float, height_mm: float) -> ShownFigure:
    """Return an empty figure of this size."""
    return ShownFigure(figsize=(width_mm / 25.4, height_mm / 25.4), layout="constrained")


def line(place: int) -> dict[str, Any]:
    """Return colour and dashes of a line among several; 28 differ."""
    return {"color": COLOURS[place % len(COLOURS)], "linestyle": _DASHES[place % len(_DASHES)]}


def marks(place: int) -> dict[str, Any]:
    """Return colour and shape of marks among several; 7 differ."""
    return {
        "color": COLOURS[place % len(COLOURS)],
        "marker": _MARKERS[place % len(_MARKERS)],
        "linestyle": "",
        "mfc": "none",
    }


def panels(count: int, width_mm: float) -> tuple[Figure, list[Axes]]:
    """Return a figure with this many panels, in as many columns as its width bears, and their axes."""
    columns = max(1, min(count, int(width_mm / 70.0)))
    rows = math.ceil(count / columns)
    drawn = figure(width_mm, 10.0 + 60.0 * rows)
    grid = drawn.subplots(rows, columns, squeeze=False).ravel().tolist()
    for axes in grid[count:]:
        axes.set_visible(False)
    return drawn, grid[:count]


def with_legend(drawn: Figure, panels: Sequence[Axes]) -> Figure:
    """Return the figure with one legend of all panels below."""
    entries = {
        label: handle for axes in panels for handle, label in zip(*axes.get_legend_handles_labels(), strict=True)
    }
    drawn.legend(list(entries.values()), list(entries), loc="outside lower center", ncols=3)
    return drawn
