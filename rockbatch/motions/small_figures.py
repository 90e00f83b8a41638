"""Small figures of ground motions, for a table of many: the record, and its response spectrum."""

from collections.abc import Sequence

import numpy as np

from rockbatch.common.figures.description import Axis, Figure, Look, Panel, Polyline, Rule, Words, thin
from rockbatch.common.units import GRAVITY
from rockbatch.motions.motion import Motion
from rockbatch.motions.spectrum import spectral_acceleration

MOST_POINTS = 300
"""Greatest number of points of a trace; thinning keeps its extremes."""

PERIODS = np.geomspace(0.05, 5.0, 31)
"""Periods of the spectra [s]."""

_HEIGHT = 44.0  # [px]


def trace(motion: Motion) -> Figure:
    """Return a figure of the horizontal acceleration on its own scale, ± PGA, thinned, with the duration [s] at its end."""
    times = motion.dt * np.arange(motion.npts, dtype=float)
    x, y = thin(times, motion.horizontal / GRAVITY, MOST_POINTS // 4)
    peak, end = motion.pga_g or 1.0, motion.duration or motion.dt
    marks = [Polyline(x, y, look=Look("behind")), Words(end, -peak, f"{end:.3g} s", -1, 4.0)]
    panel = Panel(Axis("", 0.0, end), Axis("", -peak, peak), marks, width=160.0, height=_HEIGHT, framed=False)
    return Figure([panel], f"Acceleration of {motion.label}, {motion.pga_g:.3g} g at most")


def spectra(motions: Sequence[Motion]) -> list[Figure]:
    """Return a figure of each motion's response spectrum, 5 % damped, all on one log scale: three decades below the greatest."""
    ordinates = [spectral_acceleration(motion.horizontal, motion.dt, PERIODS, 0.05) / GRAVITY for motion in motions]
    top = max((float(sa.max()) for sa in ordinates), default=0.0) or 1.0
    x, y = Axis("", float(PERIODS[0]), float(PERIODS[-1]), log=True), Axis("", 1e-3 * top, top, log=True)
    powers = np.array([power for power in 10.0 ** np.arange(-9, 9) if y.low < power < top])
    figures = []
    for motion, sa in zip(motions, ordinates, strict=True):
        marks = [Rule("y", powers, look=Look("grid")), Polyline(PERIODS, sa, look=Look("curve", 1))]
        panel = Panel(x, y, marks, width=80.0, height=_HEIGHT, framed=False)
        figures.append(Figure([panel], f"Response spectrum of {motion.label}"))
    return figures
