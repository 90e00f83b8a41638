"""A figure as data: panels with axes and marks. The report draws it as SVG, ``paper`` with matplotlib.

Subscripts are written "θ_max/α" in the labels of axes; all other text is shown as it is.
"""

import math
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

COLOURS = 7
DASHES = 4
SHAPES = ("disc", "square", "up", "diamond", "down", "cross", "star", "left", "right", "hexagon")
ENDED = {
    "overturned": "overturned",
    "flight": "flight: both pivots off the ground",
    "failed": "no result: the run failed",
}
"""Statuses of runs without a largest rotation, in words; each has its own shape, "failed" a question mark."""


@dataclass(frozen=True)
class Look:
    """Style of a mark.

    ``kind`` is its role, for which each renderer has a width and a colour; ``colour``, from 1 to :data:`COLOURS`, is that of
    a series; 0 is that of the role. ``open`` marks are not filled.
    """

    kind: str = ""
    colour: int = 0
    dash: int = 0
    shape: str = "disc"
    open: bool = False


def line_of(place: int, kind: str = "level") -> Look:
    """Return the look of the line at ``place``, from 0: 28 differ in colour or dashes, neighbours in both; then they repeat."""
    return Look(kind, place % COLOURS + 1, place % DASHES)


def marks_of(place: int, is_open: bool = False) -> Look:
    """Return the look of the marks at ``place``, from 0: 70 differ in colour or shape, neighbours in both; then they repeat."""
    return Look("", place % COLOURS + 1, shape=SHAPES[place % len(SHAPES)], open=is_open)


def sign_of(status: str) -> Look:
    """Return the look of a run without a largest rotation: the shape of its ``status``, in alarm unless it failed."""
    return Look("none" if status == "failed" else "alarm", shape=status)


@dataclass(frozen=True, eq=False, kw_only=True)
class Mark:
    """A mark with its look; ``label`` is its entry in the legend, none if empty, and ``title`` its tooltip on the page."""

    look: Look = Look("level")
    label: str = ""
    title: str = ""


@dataclass(frozen=True, eq=False)
class Polyline(Mark):
    """A polyline, interrupted at NaN. The script of the page reads values from a line with a ``name``."""

    x: Array
    y: Array
    name: str = ""


@dataclass(frozen=True, eq=False)
class Area(Mark):
    """Areas within outlines, separated by NaN."""

    x: Array
    y: Array


@dataclass(frozen=True, eq=False)
class Points(Mark):
    """Markers with half the lengths of error bars, none where 0, and tooltips; ``shade`` is a scale and values, drawn as tone."""

    x: Array
    y: Array
    error: Array | None = None
    titles: Sequence[str] = ()
    shade: "tuple[Axis, Array] | None" = None


@dataclass(frozen=True, eq=False)
class Rule(Mark):
    """Straight lines across the panel at ``at`` on the axis "x" or "y", from the share ``low`` of it to ``high``."""

    axis: str
    at: Array
    low: float = 0.0
    high: float = 1.0


@dataclass(frozen=True, eq=False)
class Span(Mark):
    """A strip across the panel from ``low`` to ``high`` on the axis "x" or "y"."""

    axis: str
    low: float
    high: float


@dataclass(frozen=True, eq=False)
class Words(Mark):
    """Text beside a point: to its right with ``side`` 1, to its left with -1, on it with 0; ``lift`` px above it."""

    x: float
    y: float
    text: str
    side: int = 1
    lift: float = 0.0
    look: Look = field(default=Look(), kw_only=True)


@dataclass(frozen=True)
class Axis:
    """Values ``low``..``high`` along one axis; ``log`` for powers of ten.

    ``about`` as many ticks or fewer, up to ``last``; ``names`` are ticks with names instead of numbers, ``numbered`` whether
    any are written.
    """

    label: str
    low: float
    high: float
    log: bool = False
    about: int = 5
    last: float = math.inf
    names: Mapping[float, str] | None = None
    numbered: bool = True

    def fraction(self, values: float | Array) -> Array:
        """Return places along the axis: 0 at ``low``, 1 at ``high``, beyond outside; on a ``log`` axis −inf at 0, NaN below."""
        values = np.asarray(values, dtype=np.float64)
        if self.log:
            return np.log(values / self.low) / math.log(self.high / self.low)
        return (values - self.low) / (self.high - self.low)

    def ticks(self) -> dict[float, str]:
        """Return the labels of ticks by their values: ``names`` if given, else round steps, on a ``log`` axis :meth:`_powers`."""
        if self.names is not None:
            return dict(self.names)
        places = self._powers() if self.log else self._steps()
        return dict(zip(places, written(places), strict=True))

    def _steps(self) -> list[float]:
        rough = (self.high - self.low) / self.about
        power = 10.0 ** math.floor(math.log10(rough))
        step = next(power * round_ for round_ in (1, 2, 2.5, 5, 10) if power * round_ >= rough * (1 - 1e-9))
        first, last = math.ceil(self.low / step - 1e-9), math.floor(min(self.high, self.last) / step + 1e-9)
        return [i * step for i in range(first, last + 1)]

    def _powers(self) -> list[float]:
        """Return 1, 2 and 5 times the powers of ten on the axis, powers of ten alone if these are over 9, steps if under 2.

        Of more than ``about`` powers only every second, third or so is returned.
        """
        low, high = self.low * (1 - 1e-9), self.high * (1 + 1e-9)
        powers = [10.0**n for n in range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)]
        fine = [tick for power in powers for step in (1, 2, 5) if low <= (tick := step * power) <= high]
        coarse = [power for power in powers if low <= power <= high]
        if len(fine) < 2:
            return self._steps()
        return fine if len(fine) <= 9 else coarse[:: max(1, math.ceil(len(coarse) / self.about))]

    @property
    def plain(self) -> str:
        """Return the label without the signs of subscripts: "θmax/α" of "θ_max/α"."""
        return "".join(words for words, _ in subscripts(self.label))


def subscripts(label: str) -> Iterator[tuple[str, bool]]:
    """Yield the parts of a label, and whether each is a subscript: "θ", "max", "/α"."""
    for place, words in enumerate(re.split(r"_([a-z0]+)", label)):
        if words:
            yield words, place % 2 == 1


def spanning(label: str, *arrays: Array, margin: float = 0.06, about: int = 5) -> Axis:
    """Return an axis that holds every finite value, and zero, with a share ``margin`` beyond, none below if none is negative.

    It is from −1 to 1 without a value other than 0.
    """
    finite = [array[np.isfinite(array)] for array in arrays]
    low = min((float(array.min()) for array in finite if len(array)), default=0.0)
    high = max((float(array.max()) for array in finite if len(array)), default=0.0)
    low, high = min(low, 0.0), max(high, 0.0)
    room = margin * (high - low) or 1.0
    return Axis(label, low - room * (low < 0 or high == low), high + room, about=about)


def log_spanning(label: str, *arrays: Array, margin: float = 0.15) -> Axis:
    """Return a logarithmic axis that holds every positive finite value with a margin; about 0.1 to 1 without any."""
    values = np.concatenate([array[(array > 0) & np.isfinite(array)] for array in arrays])
    low, high = (float(values.min()), float(values.max())) if len(values) else (0.1, 1.0)
    return Axis(label, low / (1.0 + margin), high * (1.0 + margin), log=True, about=6)


def decades(label: str, values: Iterable[float], about: int = 6) -> Axis:
    """Return a logarithmic axis of whole decades that holds positive ``values``, the highest below its end; 1 to 10 for none."""
    powers = [math.log10(value) for value in values] or [0.0]
    low = math.floor(min(powers))
    return Axis(label, 10.0**low, 10.0 ** (math.floor(max(powers)) + 1), log=True, about=about)


def written(ticks: Sequence[float]) -> list[str]:
    """Return labels of ticks with as many decimals as their step needs, or powers of ten if they are far apart; [] for none.

    From 10,000 on thousands are grouped.
    """
    if len(ticks) > 1 and ticks[0] > 0 and ticks[1] / ticks[0] > 9:
        return [_power_of_ten(tick) for tick in ticks]
    step = min((b - a for a, b in pairwise(ticks)), default=sum(ticks)) or 1.0
    decimals = next((d for d in range(9) if math.isclose(step, round(step, d), rel_tol=1e-6)), 9)
    return [f"{tick + 0.0:{',' if abs(tick) >= 1e4 else ''}.{decimals}f}".replace("-", "−") for tick in ticks]


def _power_of_ten(value: float) -> str:
    exponent = round(math.log10(value))
    if 0 <= exponent <= 4:
        return f"{10**exponent}"
    return "10" + str(exponent).translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))


@dataclass(frozen=True, eq=False)
class Panel:
    """Axes with marks, which are drawn in their order over spans, areas and the grid."""

    x: Axis
    y: Axis
    marks: Sequence[Mark]
    # its title, and what stands in paler words beside it
    caption: str = ""
    note: str = ""
    # width with all that stands beside the axes, and height of the axes alone [px of 1/96 inch]
    width: float = 300.0
    height: float = 132.0
    reads: str = ""  # "time" or "plane" if the script of the page reads values from its lines
    framed: bool = True  # whether its axes are drawn; without them its marks have one scale both ways


@dataclass(frozen=True, eq=False)
class Figure:
    """Panels beside each other as room permits, or ``stacked`` in rows that are as wide as the widest; and one legend.

    ``description`` is for those who cannot see it.
    """

    panels: Sequence[Panel]
    description: str
    title: str = ""
    stacked: bool = False

    @property
    def legend(self) -> dict[str, list[Mark]]:
        """Return the marks behind each entry of the legend: one of each type that has its label."""
        entries: dict[str, dict[type[Mark], Mark]] = {}
        for panel in self.panels:
            for mark in panel.marks:
                if mark.label:
                    entries.setdefault(mark.label, {}).setdefault(type(mark), mark)
        return {label: list(marks.values()) for label, marks in entries.items()}

    @property
    def rows(self) -> list[list[Panel]]:
        """Return the panels in rows, one below another: in each as many side by side as the widest panel is wide."""
        widest = max((panel.width for panel in self.panels), default=0.0)
        rows: list[list[Panel]] = []
        for panel in self.panels:
            if not rows or sum(other.width for other in rows[-1]) + panel.width > 1.001 * widest:
                rows.append([])
            rows[-1].append(panel)
        return rows


def thin(x: Array, y: Array, buckets: int) -> tuple[Array, Array]:
    """Return fewer points of a history that draw the same: of each bucket, a pixel wide, the first, last, least and largest.

    ``x``, shape (n,), is in order; ``y`` may have NaN. Four points for a bucket, or fewer, come back as they are.
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


def without_repeats(x: Array, y: Array, pixels: int) -> tuple[Array, Array]:
    """Return the points of a curve without those that round to the same tenth of a pixel as the one before, in x and y."""
    moved = np.arange(len(x)) == 0
    for values in (x, y):
        finite = values[np.isfinite(values)]
        grain = float(np.ptp(finite)) / (10.0 * pixels) if len(finite) else 0.0
        places = np.nan_to_num(np.rint(values / (grain or 1.0)), nan=math.inf)
        moved[1:] |= places[1:] != places[:-1]
    return x[moved], y[moved]
