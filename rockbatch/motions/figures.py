"""Figures of ground motions: the record, and the response spectra of a suite."""

from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import NotRequired, TypedDict

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
    spanning,
)
from rockbatch.common.units import GRAVITY

LABELLED = COLOURS
"""Greatest number of records whose spectra are labelled one by one; larger suites show their percentiles."""


class Spectra(TypedDict):
    """Response spectra of a suite, as in run.json: ``sa_g`` in the order of the motions; ``None`` where undefined."""

    damping: float
    period_s: list[float]
    sa_g: list[list[float]]
    mean_sa_g: NotRequired[list[float | None]]
    target_sa_g: NotRequired[list[float | None]]


def record(components: Mapping[str, npt.NDArray[np.float64]], dt: float, title: str) -> Figure:
    """Return a figure of the accelerations [g] of a motion's components against time, on one scale."""
    y = spanning("", *(samples / GRAVITY for samples in components.values()))
    panels = []
    for place, (name, samples) in enumerate(components.items(), 1):
        last = place == len(components)
        x = Axis("time [s]" if last else "", 0.0, max(len(samples) - 1, 1) * dt, about=8, numbered=last)
        line = Polyline(dt * np.arange(len(samples), dtype=float), samples / GRAVITY, look=Look("curve"))
        panels.append(Panel(x, Axis(f"{name} [g]", y.low, y.high), [line], width=440.0, height=100.0))
    return Figure(panels, "Ground acceleration against time", title, stacked=True)


def drawable(spectra: Spectra) -> bool:
    """Return whether periods rise and every spectrum has a value ≥ 0, or None, for each; run.json may come from anybody."""
    periods = spectra["period_s"]
    fits = [fit for fit in (spectra.get("mean_sa_g"), spectra.get("target_sa_g")) if fit is not None]
    shown: list[Sequence[float | None]] = [*spectra["sa_g"], *fits]
    rising = len(periods) > 1 and all(a < b for a, b in pairwise([0.0, *periods]))
    complete = len(fits) != 1 and all(len(spectrum) == len(periods) for spectrum in shown)
    return rising and complete and all(value is None or value >= 0 for spectrum in shown for value in spectrum)


def response_spectra(spectra: Spectra, names: Sequence[str], fitted: tuple[float, float] | None = None) -> Figure:
    """Return a figure of pseudo-spectral acceleration [g] over period [s], both logarithmic, of records by ``names``.

    The suite's mean is ``fitted`` to the target, if there is one, between two periods [s].
    """
    periods, values = np.array(spectra["period_s"], dtype=float), np.array(spectra["sa_g"], dtype=float)
    target = np.array(spectra.get("target_sa_g", ()), dtype=float)
    shown = np.concatenate((values[values > 0], target[target > 0]))
    top = float(shown.max(initial=1e-3))
    low = max(float(shown.min(initial=top)), 1e-4 * top)  # a record of nearly zeros would flatten all others
    y = log_spanning("SA [g]", np.array([low, top]), margin=0.2)
    few = len(names) <= LABELLED
    marks: list[Mark] = [] if fitted is None else [Span("x", *fitted, look=Look("band"))]

    def add(spectrum: npt.NDArray[np.float64], look: Look, name: str, named: bool = True) -> None:
        label = name if len(name) <= 40 else f"{name[:20]}…{name[-19:]}"
        marks.append(Polyline(periods, np.maximum(spectrum, y.low), name, look=look, label=label if named else ""))

    for i, (name, spectrum) in enumerate(zip(names, values, strict=True)):
        add(spectrum, line_of(i) if few else Look("faint"), name, named=few)
    if len(target):
        add(np.array(spectra["mean_sa_g"], dtype=float), Look("level", dash=1), "mean of the records")
        add(target, Look("target"), "target")
    elif len(names) > 1:
        add(np.median(values, axis=0), Look("level"), "median")
    if not few:
        for percent in (16, 84):
            add(np.percentile(values, percent, axis=0), Look("level", dash=2), f"{percent} %")
    x = Axis("period [s]", float(periods[0]), float(periods[-1]), log=True)
    words = f"Response spectra of {len(names)} ground motions" + (" and their target" if len(target) else "")
    return Figure([Panel(x, y, marks, width=440.0, height=260.0)], words)
