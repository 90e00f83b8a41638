"""The picture of ``rockbatch accuracy``: error of θ_max/α against time per run."""

import csv
import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from rockbatch.report.markup import Markup
from rockbatch.report.svg import INK, MUTED, PAPER, SERIES, drawing, inline
from rockbatch.report.tables import Head, table

if TYPE_CHECKING:
    from matplotlib.axes import Axes

LEAST = 1e-14  # errors below are drawn there: rounding
METHODS = {  # marker, colour, legend, and on which side the notes stand, so that neighbours keep clear of each other
    "located": ("o", SERIES[0], "events located inside the step", -1),
    "not located": ("s", SERIES[1], "events at the end of the step", 1),
    "SciPy DOP853": ("^", SERIES[2], "SciPy DOP853", 1),
    "SciPy LSODA": ("v", SERIES[3], "SciPy LSODA", -1),
}
NUMBERS = (
    "substeps", "tolerance", "runs", "error_median", "error_95", "error_max", "seconds_per_run", "status_differs",
    "reference_change",
)  # fmt: skip


@dataclass(frozen=True)
class Level:
    """One row of ``accuracy.csv``: a method at one setting; errors of θ_max/α, times in seconds per run."""

    method: str
    machine: str
    substeps: float | None
    tolerance: float | None
    runs: float | None
    error_median: float | None
    error_95: float | None
    error_max: float | None
    seconds_per_run: float | None
    status_differs: float | None
    reference_change: float | None


def read(path: Path, study: str) -> list[Level]:
    """Levels of ``accuracy.csv`` as measured for the study with the SHA-256 ``study``.

    Empty where the file is missing, of another state of the study, or not such a table: the report does without.
    """
    try:
        with path.open(encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(file))
        if any(row["study"] != study for row in rows):
            return []
        return [Level(row["method"], row["machine"], *(_number(row[name]) for name in NUMBERS)) for row in rows]
    except (OSError, KeyError, TypeError, ValueError):
        return []


def _number(text: str) -> float | None:
    return float(text) if text else None


def levels_table(levels: Sequence[Level]) -> Markup:
    """Every level in numbers."""
    heads = [
        Head("method"),
        Head("k", ".0f", "substeps: steps per sample"),
        Head("tolerance", ".0e", "on θ_max/α; SciPy's rtol"),
        Head("runs", ".0f"),
        Head("median error", ".1e"),
        Head("95 %", ".1e", "error that 95 % of the runs keep"),
        Head("largest", ".1e"),
        Head("time per run [ms]", ".3g"),
        Head("other outcome", ".0f", "runs that end otherwise than the reference: overturned, flight"),
    ]
    rows = [
        [
            level.method, level.substeps, level.tolerance, level.runs, level.error_median, level.error_95,
            level.error_max, _milliseconds(level), level.status_differs or None,
        ]
        for level in levels
    ]  # fmt: skip
    return table(heads, rows)


def _milliseconds(level: Level) -> str:
    if level.seconds_per_run is None:
        return ""
    value = 1000 * level.seconds_per_run
    return f"{value:.0f}" if value >= 100 else f"{value:.3g}"


def draw(levels: Sequence[Level]) -> Markup:
    """Error against time per run, both logarithmic, as SVG: the largest error solid, the median dashed."""
    from matplotlib.figure import Figure
    from matplotlib.ticker import FuncFormatter

    with drawing("accuracy"):
        figure = Figure(figsize=(7.5, 4.6))
        axes = figure.add_axes((0.1, 0.24, 0.86, 0.74))
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.grid()
        for axis in (axes.xaxis, axes.yaxis):
            axis.set_major_formatter(FuncFormatter(_power_of_ten))
        for method, (marker, colour, label, side) in METHODS.items():
            at = [level for level in levels if level.method == method and level.seconds_per_run]
            if not at:
                continue
            _line(axes, at, [level.error_median for level in at], linestyle=":", color=colour)
            style = {"color": colour, "marker": marker, "markersize": 5, "label": label}
            _line(axes, at, [level.error_max for level in at], **style)
            for level in at:
                if level.error_max is not None:
                    _note(axes, level, colour, side)
        chosen = next((level for level in levels if level.method == "study"), None)
        if chosen is not None and chosen.error_max is not None and chosen.seconds_per_run:
            setting = f"tolerance {chosen.tolerance:g}" if chosen.tolerance else f"{chosen.substeps:.0f} substeps"
            if chosen.tolerance:
                axes.axhline(chosen.tolerance, color=MUTED, linewidth=0.8, linestyle="--", zorder=1)
            style = {"color": INK, "markeredgecolor": PAPER, "marker": "*", "markersize": 14, "linestyle": "none"}
            _line(axes, [chosen], [chosen.error_max], label=f"this study: {setting}", zorder=4, **style)
        axes.plot([], [], color=MUTED, label="largest error")
        axes.plot([], [], color=MUTED, linestyle=":", label="median error")
        axes.set_xlabel("time per run [ms]")
        axes.set_ylabel("error of θmax/α")
        figure.legend(loc="lower center", ncols=3, fontsize=8, borderpad=0.2, columnspacing=1.5)
        return inline(figure, "Error of θmax/α against time per run")


def _power_of_ten(value: float, position: int) -> str:
    exponent = round(math.log10(value))
    if 0 <= exponent <= 4:
        return f"{10**exponent}"
    return "10" + str(exponent).translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))


def _line(axes: "Axes", levels: Sequence[Level], errors: Sequence[float | None], **style: object) -> None:
    x = [1000 * (level.seconds_per_run or math.nan) for level in levels]
    y = [math.nan if error is None else max(error, LEAST) for error in errors]
    axes.plot(x, y, **{"linewidth": 1.1, **style})  # type: ignore[arg-type]


def _note(axes: "Axes", level: Level, colour: str, side: int) -> None:
    """The number of steps per sample, or SciPy's tolerance, beside a point."""
    text = f"k = {level.substeps:.0f}" if level.substeps else f"{level.tolerance:.0e}"
    at = 1000 * (level.seconds_per_run or math.nan), max(level.error_max or 0.0, LEAST)
    axes.annotate(
        text, at, xytext=(6 * side, 4 * side), textcoords="offset points", fontsize=7, color=colour,
        ha="left" if side > 0 else "right", va="bottom" if side > 0 else "top",
    )  # fmt: skip


def lead(levels: Sequence[Level]) -> str:
    """What the picture shows, in a sentence about the study's own setting; empty without it."""
    chosen = next((level for level in levels if level.method == "study"), None)
    if chosen is None or chosen.error_max is None or not chosen.seconds_per_run:
        return ""
    return (
        f"With the setting of this study a run takes {1000 * chosen.seconds_per_run:.3g} ms "
        f"and its peak is off by {chosen.error_max:.1e} at most, over the runs measured."
    )
