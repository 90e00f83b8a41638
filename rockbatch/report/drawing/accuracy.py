"""The picture of ``rockbatch accuracy``: error of θ_max/α against time per run."""

import math
from collections.abc import Sequence

import numpy as np

from rockbatch.report.drawing.axes import Axes, Scale
from rockbatch.report.drawing.svg import curve, key, line, lowered, marker, svg, text
from rockbatch.report.finished_accuracy import Level, chosen
from rockbatch.report.markup import Markup, join

LEAST = 1e-14  # smaller errors, of rounding, are drawn there
METHODS = {  # marker, colour, words, and the side of the notes, so that neighbours do not overlap
    "located": ("disc", 1, "events located inside the step", -1),
    "not located": ("square", 2, "events at the end of the step", 1),
    "SciPy DOP853": ("up", 3, "SciPy DOP853", 1),
    "SciPy LSODA": ("down", 4, "SciPy LSODA", -1),
}


def draw(levels: Sequence[Level]) -> Markup:
    """Draw error against time per run, both logarithmic: the largest error solid, the median dotted."""
    timed = [level for level in levels if level.seconds_per_run]
    times = [1000 * (level.seconds_per_run or 0) for level in timed]
    errors = [
        max(error, LEAST) for level in timed for error in (level.error_median, level.error_max) if error is not None
    ]
    axes = Axes(44, 20, 384, 260, _decades(times), _decades(errors))
    drawn = [axes.frame(axes.x.ticks(6), axes.y.ticks(8))]
    for method, (shape, colour, _, side) in METHODS.items():
        same = [level for level in timed if level.method == method]
        drawn += _lines(axes, same, f"s{colour}")
        drawn += [_point(axes, level, shape, f"s{colour}", side) for level in same if level.error_max is not None]
    own = chosen(levels)
    if own is not None:
        if own.tolerance:
            y = float(axes.down(own.tolerance))
            drawn.append(line(axes.left, y, axes.left + axes.width, y, "flown", f"tolerance {own.tolerance:g}"))
        drawn.append(marker("star", *_at(axes, own), colour="ink large", title=_said(own)))
    drawn.append(text(axes.left + axes.width / 2, 312, "time per run [ms]", class_="m q"))
    drawn.append(text(axes.left - 40, 11, join("error of ", lowered("θ", "max", "/α")), class_="q"))
    present = {level.method for level in timed}
    entries = [
        (marker(shape, 11, 7, colour=f"s{colour}"), words)
        for name, (shape, colour, words, _) in METHODS.items()
        if name in present
    ]
    if own is not None:
        setting = f"tolerance {own.tolerance:g}" if own.tolerance else f"{own.substeps:.0f} substeps"
        entries.append((marker("star", 11, 7, colour="ink large"), f"this study: {setting}"))
    entries += [(line(0, 7, 22, 7, "level"), "largest error"), (line(0, 7, 22, 7, "level d2"), "median error")]
    said = "Error of θmax/α against time per run"
    return join(svg(440, 318, *drawn, description=said, class_="plot marks alone"), key(entries))


def _decades(values: Sequence[float]) -> Scale:
    """Return a logarithmic scale over whole powers of ten that holds all values."""
    low, high = min(values, default=1.0), max(values, default=1.0)
    return Scale(10.0 ** math.floor(math.log10(low)), 10.0 ** (math.floor(math.log10(high)) + 1), log=True)


def _at(axes: Axes, level: Level) -> tuple[float, float]:
    error = max(level.error_max or 0.0, LEAST)
    return float(axes.across(1000 * (level.seconds_per_run or math.nan))), float(axes.down(error))


def _lines(axes: Axes, levels: Sequence[Level], class_: str) -> list[Markup]:
    """Draw the largest and the median errors as lines from level to level."""
    x = axes.across(np.array([1000 * (level.seconds_per_run or math.nan) for level in levels]))
    drawn = []
    for name, dashes in (("error_max", ""), ("error_median", " d2")):
        errors = [getattr(level, name) for level in levels]
        y = axes.down(np.array([math.nan if error is None else max(error, LEAST) for error in errors]))
        if len(levels) > 1:
            drawn.append(curve(x, y, f"level {class_}{dashes}"))
    return drawn


def _point(axes: Axes, level: Level, shape: str, class_: str, side: int) -> Markup:
    """Draw a level's marker with its number of steps per sample, or SciPy's tolerance, beside it."""
    x, y = _at(axes, level)
    words = f"k = {level.substeps:.0f}" if level.substeps else f"{level.tolerance:.0e}"
    place = text(x + 7 * side, y - 4 * side + 3, words, class_=class_ if side > 0 else f"{class_} e")
    return join(marker(shape, x, y, colour=class_, title=_said(level)), place)


def _said(level: Level) -> str:
    setting = f"k = {level.substeps:.0f}" if level.substeps else f"tolerance {level.tolerance:.0e}"
    return f"{level.method}, {setting}: {level.error_max:.1e} at most in {level.milliseconds} ms"
