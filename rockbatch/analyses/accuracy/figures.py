"""The figure of accuracy: error of θ_max/α against time per run."""

import math
from collections.abc import Iterator, Sequence

import numpy as np

from rockbatch.analyses.accuracy.levels import Level, chosen
from rockbatch.common.figures.description import Figure, Look, Mark, Panel, Points, Polyline, Rule, Words, decades

LEAST = 1e-14  # smaller errors, of rounding, are drawn there
METHODS = {  # colour and marker, words, and the side of the notes, so that neighbours do not overlap
    "located": (Look("", 1, shape="disc"), "events located inside the step", -1),
    "not located": (Look("", 2, shape="square"), "events at the end of the step", 1),
}
ERRORS = {
    "error_max": ("largest error", 0),
    "error_95": ("error that 95 % of the runs keep", 1),
    "error_median": ("median error", 2),
}
"""Words and dashes of each error."""


def error_and_time(levels: Sequence[Level]) -> Figure:
    """Return a figure of error against time per run, both logarithmic, with a star at the setting of this study.

    The line of the largest error is solid, of the 95 % quantile dashed, of the median dotted. Levels without a time are left out;
    errors below LEAST are drawn there.
    """
    timed = [level for level in levels if level.seconds_per_run]
    errors = [max(error, LEAST) for level in timed for name in ERRORS if (error := getattr(level, name)) is not None]
    x, y = decades("time per run [ms]", [level.time for level in timed]), decades("error of θ_max/α", errors, about=8)
    marks = [mark for method in METHODS for mark in _of_method(method, [one for one in timed if one.method == method])]
    own = chosen(levels)
    if own is not None:
        setting = f"tolerance {own.tolerance:g}" if own.tolerance else f"{own.substeps:.0f} substeps"
        if own.tolerance:
            marks.append(Rule("y", np.array([own.tolerance]), look=Look("flown"), title=setting))
        at = np.array([own.time]), np.array([max(own.error_max or 0.0, LEAST)])
        marks.append(Points(*at, None, [_label(own)], look=Look("", shape="star"), label=f"this study: {setting}"))
    return Figure([Panel(x, y, marks, width=440.0, height=260.0)], "Error of θmax/α against time per run")


def _of_method(method: str, levels: Sequence[Level]) -> Iterator[Mark]:
    """Yield the errors of a method as lines, if it has several levels, and a marker with k, steps per sample, at each greatest
    error.
    """
    look, words, side = METHODS[method]
    times = np.array([level.time for level in levels])
    for name, (kind, dash) in ERRORS.items() if len(levels) > 1 else ():
        up = np.array([math.nan if (error := getattr(level, name)) is None else max(error, LEAST) for level in levels])
        yield Polyline(times, up, look=Look("level", look.colour, dash), label=kind)
    shown = [(level, max(level.error_max, LEAST)) for level in levels if level.error_max is not None]
    if shown:
        at = np.array([level.time for level, _ in shown]), np.array([error for _, error in shown])
        yield Points(*at, None, [_label(level) for level, _ in shown], look=look, label=words)
    for level, error in shown:
        yield Words(level.time, error, f"k = {level.substeps:.0f}", side, 5.0 * side, look=Look("", look.colour))


def _label(level: Level) -> str:
    setting = f"k = {level.substeps:.0f}" if level.substeps else f"tolerance {level.tolerance:.0e}"
    return f"{level.method}, {setting}: {level.error_max:.1e} at most in {level.milliseconds} ms"
