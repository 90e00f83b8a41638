"""The response spectra of the suite in one picture."""

import math
from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import Any

import numpy as np

from rockbatch.report.drawing.axes import Axes, Scale
from rockbatch.report.drawing.svg import COLOURS, Array, curve, key, line, rectangle, svg, text
from rockbatch.report.markup import Markup, join

LABELLED = COLOURS
"""Most records whose spectra are labelled one by one; larger suites show their spread."""


def drawable(spectra: Mapping[str, Any]) -> bool:
    """Return whether periods rise, and every spectrum has a value for each; run.json may come from anybody."""
    periods, more = spectra["period_s"], [spectra[name] for name in ("mean_sa_g", "target_sa_g") if name in spectra]
    shown = [*spectra["sa_g"], *more]
    rising = len(periods) > 1 and all(a < b for a, b in pairwise([0.0, *periods]))
    values = (value for spectrum in shown for value in spectrum)
    fitting = len(more) != 1 and all(len(spectrum) == len(periods) for spectrum in shown)
    return rising and fitting and all(value is None or value >= 0 for value in values)


def draw(spectra: dict[str, Any], names: Sequence[str], fitted: tuple[float, float] | None = None) -> Markup:
    """Draw pseudo-spectral acceleration [g] over the period [s], both logarithmic.

    ``spectra`` is that of run.json: ``damping``, ``period_s``, ``sa_g`` in the order of ``names``, and optionally
    ``target_sa_g``, to which the suite's ``mean_sa_g`` is ``fitted`` between two periods [s].
    """
    periods, values = np.array(spectra["period_s"], dtype=float), np.array(spectra["sa_g"], dtype=float)
    target = np.array(spectra.get("target_sa_g", ()), dtype=float)
    shown = np.concatenate((values[values > 0], target[target > 0]))
    top = float(shown.max(initial=1e-3))
    low = max(float(shown.min(initial=top)), 1e-4 * top)  # a record of nearly zeros must not flatten the rest
    axes = Axes(44, 20, 384, 260, Scale(periods[0], periods[-1], log=True), Scale(low / 1.2, 1.2 * top, log=True))
    few = len(names) <= LABELLED
    drawn = [axes.frame(_ticks(axes.x), _ticks(axes.y))]
    if fitted is not None:
        left, right = (float(axes.across(period)) for period in fitted)
        drawn.insert(0, rectangle(left, axes.top, right - left, axes.height, "band"))
    entries = []

    def add(spectrum: Array, class_: str, name: str, named: bool = True) -> None:
        y = axes.down(np.maximum(spectrum, axes.y.low))
        drawn.append(curve(axes.across(periods), y, class_, name))
        if named:
            entries.append((line(0, 7, 22, 7, class_), name if len(name) <= 40 else f"{name[:20]}…{name[-19:]}"))

    for i, (name, spectrum) in enumerate(zip(names, values, strict=True)):
        add(spectrum, f"level s{i + 1}" if few else "level faint", name, named=few)
    if len(target):
        add(np.array(spectra["mean_sa_g"], dtype=float), "level ink d1", "mean of the records")
        add(target, "target", "target")
    elif len(names) > 1:
        add(np.median(values, axis=0), "level ink", "median")
    if not few:
        for percent in (16, 84):
            add(np.percentile(values, percent, axis=0), "level ink d2", f"{percent} %")
    drawn.append(text(axes.left + axes.width / 2, 312, "period [s]", class_="m q"))
    drawn.append(text(axes.left - 40, 11, "SA [g]", class_="q"))
    description = f"Response spectra of {len(names)} ground motions" + (" and their target" if len(target) else "")
    return join(svg(440, 318, *drawn, description=description, class_="plot spectra alone"), key(entries))


def _ticks(scale: Scale) -> list[float]:
    """Return 1, 2 and 5 times the powers of ten, as usual for spectra; fewer if they would crowd."""
    decades = range(math.floor(math.log10(scale.low)), math.ceil(math.log10(scale.high)) + 1)
    ticks = [m * 10.0**i for i in decades for m in (1, 2, 5) if scale.low <= m * 10.0**i <= scale.high]
    return ticks if len(ticks) <= 9 else scale.ticks(8)
