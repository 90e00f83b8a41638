"""The picture of ``rockbatch accuracy``: error of θ_max/α against time per run."""

import math
from collections.abc import Sequence

import numpy as np

from rockbatch.analyses.accuracy.levels import Level, chosen
from rockbatch.report.drawing.axes import Axes, Scale
from rockbatch.report.drawing.svg import Array, curve, key, line, lowered, marker, svg, text
from rockbatch.report.markup import Markup, join

LEAST = 1e-14  # smaller errors, of rounding, are drawn there
METHODS = {  # marker, colour, words, and the side of the notes, so that neighbours do not overlap
    "located": ("disc", 1, "events located inside the step", -1),
    "not located": ("square", 2, "events at the end of the step", 1),
}


def draw(levels: Sequence[Level]) -> Markup:
    """Draw error against time per run, both logarithmic: the largest error solid, the median dotted."""
    timed = [level for level in levels if level.seconds_per_run]
    errors = [max(e, LEAST) for level in timed for e in (level.error_median, level.error_max) if e is not None]
    axes = Axes(44, 20, 384, 260, _decades([level.time for level in timed]), _decades(errors))
    drawn = [axes.frame(axes.x.ticks(6), axes.y.ticks(8))]
    entries = []
    for method, (shape, colour, words, side) in METHODS.items():
        group, class_ = [level for level in timed if level.method == method], f"s{colour}"
        x = axes.across(np.array([level.time for level in group]))
        for name, dashes in (("error_max", ""), ("error_median", " d2")) if len(group) > 1 else ():
            drawn.append(curve(x, _down(axes, [getattr(level, name) for level in group]), f"level {class_}{dashes}"))
        drawn += [_point(axes, level, shape, class_, side) for level in group if level.error_max is not None]
        entries += [(marker(shape, 11, 7, colour=class_), words)] if group else []
    own = chosen(levels)
    if own is not None:
        setting = f"tolerance {own.tolerance:g}" if own.tolerance else f"{own.substeps:.0f} substeps"
        if own.tolerance:
            y = float(axes.down(own.tolerance))
            drawn.append(line(axes.left, y, axes.left + axes.width, y, "flown", setting))
        drawn.append(marker("star", *_position(axes, own), colour="ink large", title=_label(own)))
        entries.append((marker("star", 11, 7, colour="ink large"), f"this study: {setting}"))
    drawn.append(text(axes.left + axes.width / 2, 312, "time per run [ms]", class_="m q"))
    drawn.append(text(axes.left - 40, 11, join("error of ", lowered("θ", "max", "/α")), class_="q"))
    entries += [(line(0, 7, 22, 7, "level"), "largest error"), (line(0, 7, 22, 7, "level d2"), "median error")]
    description = "Error of θmax/α against time per run"
    return join(svg(440, 318, *drawn, description=description, class_="plot marks alone"), key(entries))


def _decades(values: Sequence[float]) -> Scale:
    """Return a logarithmic scale over whole powers of ten that holds all values."""
    low, high = min(values, default=1.0), max(values, default=1.0)
    return Scale(10.0 ** math.floor(math.log10(low)), 10.0 ** (math.floor(math.log10(high)) + 1), log=True)


def _down(axes: Axes, errors: Sequence[float | None]) -> Array:
    return axes.down(np.array([math.nan if error is None else max(error, LEAST) for error in errors]))


def _position(axes: Axes, level: Level) -> tuple[float, float]:
    return float(axes.across(level.time)), float(_down(axes, [level.error_max or 0.0])[0])


def _point(axes: Axes, level: Level, shape: str, class_: str, side: int) -> Markup:
    """Draw a level's marker with its number of steps per sample beside it."""
    x, y = _position(axes, level)
    words = f"k = {level.substeps:.0f}" if level.substeps else f"{level.tolerance:.0e}"
    place = text(x + 7 * side, y - 4 * side + 3, words, class_=class_ if side > 0 else f"{class_} e")
    return join(marker(shape, x, y, colour=class_, title=_label(level)), place)


def _label(level: Level) -> str:
    setting = f"k = {level.substeps:.0f}" if level.substeps else f"tolerance {level.tolerance:.0e}"
    return f"{level.method}, {setting}: {level.error_max:.1e} at most in {level.milliseconds} ms"
