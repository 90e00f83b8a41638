"""Figure of the response spectra of a study's ground motions."""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
import numpy.typing as npt

from rockbatch.common.figures.description import (
    COLOURS,
    Axis,
    Figure,
    Look,
    Mark,
    Panel,
    Polyline,
    Span,
    line_of,
    log_spanning,
)
from rockbatch.results.labelled import Item

LABELLED = COLOURS
"""Most records whose spectra are labelled; larger suites show percentiles instead."""


def drawable(spectra: Item) -> bool:
    """Return whether spectra of run.json, which is untrusted, can be drawn.

    There are two or more periods, above 0 and rising; every spectrum has a value for each, not negative, or None; and a target
    and its mean are both there or both missing.
    """
    periods, more = spectra["period_s"], [spectra[name] for name in ("mean_sa_g", "target_sa_g") if name in spectra]
    shown = [*spectra["sa_g"], *more]
    rising = len(periods) > 1 and all(a < b for a, b in pairwise([0.0, *periods]))
    values = (value for spectrum in shown for value in spectrum)
    fitting = len(more) != 1 and all(len(spectrum) == len(periods) for spectrum in shown)
    return rising and fitting and all(value is None or value >= 0 for value in values)


def response_spectra(spectra: Item, names: Sequence[str], fitted: tuple[float, float] | None = None) -> Figure:
    """Return a figure of pseudo-spectral acceleration [g] over period [s], both logarithmic.

    ``spectra``, from run.json, has ``damping``, ``period_s``, ``sa_g`` in the order of ``names`` and, optionally,
    ``target_sa_g``, to which the suite's ``mean_sa_g`` is ``fitted`` between two periods [s]. Without a target the median of
    several records is drawn; more than :data:`LABELLED` records are faint, with the 16 and 84 % quantiles.
    """
    periods, values = np.array(spectra["period_s"], dtype=float), np.array(spectra["sa_g"], dtype=float)
    target = np.array(spectra.get("target_sa_g", ()), dtype=float)
    shown = np.concatenate((values[values > 0], target[target > 0]))
    top = float(shown.max(initial=1e-3))
    low = max(float(shown.min(initial=top)), 1e-4 * top)  # nearly zero records must not flatten the rest
    y = log_spanning("SA [g]", np.array([low, top]), margin=0.2)
    few = len(names) <= LABELLED
    marks: list[Mark] = [] if fitted is None else [Span("x", *fitted, look=Look("band"))]

    def add(spectrum: npt.NDArray[np.float64], look: Look, name: str, label: str | None = None) -> None:
        short = name if len(name) <= 40 else f"{name[:20]}…{name[-19:]}"
        label = short if label is None else label
        marks.append(Polyline(periods, np.maximum(spectrum, y.low), name, look=look, label=label))

    for i, (name, spectrum) in enumerate(zip(names, values, strict=True)):
        add(spectrum, line_of(i) if few else Look("faint"), name, None if few else "")
    if len(target):
        add(np.array(spectra["mean_sa_g"], dtype=float), Look("level", dash=1), "mean of the records")
        add(target, Look("target"), "target")
    elif len(names) > 1:
        add(np.median(values, axis=0), Look("level"), "median")
    if not few:
        for percent in (16, 84):
            add(np.percentile(values, percent, axis=0), Look("level", dash=2), f"{percent} %", "16 and 84 %")
    x = Axis("period [s]", float(periods[0]), float(periods[-1]), log=True)
    words = f"Response spectra of {len(names)} ground motions" + (" and their target" if len(target) else "")
    return Figure([Panel(x, y, marks, width=440.0, height=260.0)], words)
