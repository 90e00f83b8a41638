"""Accelerations of a motion."""

from collections.abc import Mapping

import numpy as np
import numpy.typing as npt

from rockbatch.common.figures.description import Axis, Figure, Look, Panel, Polyline, spanning
from rockbatch.common.units import GRAVITY


def record(components: Mapping[str, npt.NDArray[np.float64]], dt: float, title: str) -> Figure:
    """Return a figure of the accelerations [g] of components against time: a panel for each, one scale for all."""
    y = spanning("", *(samples / GRAVITY for samples in components.values()))
    panels = []
    for place, (name, samples) in enumerate(components.items(), 1):
        last = place == len(components)
        x = Axis("time [s]" if last else "", 0.0, max(len(samples) - 1, 1) * dt, about=8, numbered=last)
        line = Polyline(dt * np.arange(len(samples), dtype=float), samples / GRAVITY, look=Look("curve"))
        panels.append(Panel(x, Axis(f"{name} [g]", y.low, y.high), [line], width=440.0, height=100.0))
    return Figure(panels, "Ground acceleration against time", title, stacked=True)
