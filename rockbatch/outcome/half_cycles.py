"""Half cycles of rocking: times and angular velocities at the passages through upright, and amplitudes in between.

The first half cycle is from the start of the run, such as a release, to the first impact.
"""

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from rockbatch.motions.motion import Samples
from rockbatch.pier import Pier

Rows = npt.NDArray[np.intp]
"""Indices of rows in a history."""

HALVINGS = 50
"""Bisections of the interval between two rows in which the pier passes through upright."""

COLUMNS = ("t", "omega_before", "omega_after", "amplitude", "t_amplitude", "apparent_restitution")

HALF_CYCLE_COLUMNS = (
    "t_s",
    "omega_before_rad_s",
    "omega_after_rad_s",
    "amplitude_rad",
    "t_amplitude_s",
    "apparent_restitution",
)
"""The same in files, with their units."""


class HalfCycles(NamedTuple):
    """Half cycles of a run, each from an impact to the next; the first begins with the run. Shape (n,) each.

    ``t`` [s] is the beginning, with the angular velocities before and after it [rad/s], NaN for the first; ``amplitude`` [rad]
    is the greatest |θ|, at ``t_amplitude`` [s], both NaN if it still grew as the run ended.
    """

    t: Samples
    omega_before: Samples
    omega_after: Samples
    amplitude: Samples
    t_amplitude: Samples


class Path(NamedTuple):
    """Rows of a history: time [s], rotation [rad], and its rate [rad/s]; shape (n,) each."""

    t: Samples
    theta: Samples
    omega: Samples


def half_cycles(path: Path, landed: Rows | None) -> HalfCycles:
    """Return the half cycles of a run, whose ``path`` has a row before and after every event.

    ``landed``, shape (k,), are the rows after impacts, each next to the row before it; None on springs, where the pier lands
    before it is upright, and half cycles begin at θ = 0 instead. Amplitudes are |θ|. A run that never lands is one half cycle,
    of amplitude NaN if θ does not turn at its greatest.
    """
    if landed is None:
        before, after, t, omega = _through_upright(path)
        rates = omega, omega
    else:
        before, after, t = landed - 1, landed, path.t[landed]
        rates = path.omega[before], path.omega[after]
    ends = np.concatenate([before + 1, [len(path.t)]])
    starts = np.concatenate([[0], after])
    peaks = [_peak(path, int(first), int(end)) for first, end in zip(starts, ends, strict=True)]
    amplitude, times = np.array(peaks).reshape(-1, 2).T
    omega_before, omega_after = (np.concatenate([[math.nan], rate]) for rate in rates)
    return HalfCycles(np.concatenate([path.t[:1], t]), omega_before, omega_after, amplitude, times)


def apparent_restitution(pier: Pier, amplitude: Samples) -> Samples:
    """Return the restitution of a block on rigid ground by which each amplitude [rad] would follow from the previous one.

    √(E(θ_n)/E(θ_n−1)), E(θ) = cos(α − θ) − cos α, the work against the weight over M g R0; NaN for the first.
    """
    alpha = pier.alpha
    work = 2.0 * np.sin(alpha - 0.5 * amplitude) * np.sin(0.5 * amplitude)  # cos(α − θ) − cos α, to its last digit
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.concatenate([[math.nan], np.sqrt(work[1:] / work[:-1])])


def _through_upright(path: Path) -> tuple[Rows, Rows, Samples, Samples]:
    """Return the rows before and after each passage through θ = 0, and its time [s] and angular velocity [rad/s]."""
    leans = np.flatnonzero(path.theta)
    turns = np.flatnonzero(path.theta[leans[:-1]] * path.theta[leans[1:]] < 0.0)
    before, after = leans[turns], leans[turns + 1]
    h = np.maximum(path.t[after] - path.t[before], 1e-300)
    low, high = np.zeros(len(h)), np.ones(len(h))
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        stays = _cubic(path, before, after, h, middle)[0] * path.theta[before] > 0.0
        low, high = np.where(stays, middle, low), np.where(stays, high, middle)
    return before, after, path.t[before] + h * low, _cubic(path, before, after, h, low)[1]


def _cubic(path: Path, before: Rows, after: Rows, h: Samples, s: Samples) -> tuple[Samples, Samples]:
    """Return θ [rad] and its rate [rad/s] by cubic Hermite polynomials between two rows ``h`` [s] apart, at shares ``s``."""
    start, travel = path.theta[before], path.theta[after] - path.theta[before]
    first, last = h * path.omega[before] - travel, travel - h * path.omega[after]
    value = start + s * travel + s * (1.0 - s) * ((1.0 - s) * first + s * last)
    rate = travel + (1.0 - s) * (1.0 - 3.0 * s) * first + s * (2.0 - 3.0 * s) * last
    return value, rate / h


def _peak(path: Path, first: int, end: int) -> tuple[float, float]:
    """Return the greatest |θ| [rad] from row ``first`` until before row ``end``, by cubics between rows, and its time [s].

    Both are NaN unless θ turns at this value, or starts from it at rest, tilted: it may still grow at the end of a run.
    """
    theta, omega = path.theta[first:end], path.omega[first:end]
    top = int(np.abs(theta).argmax())
    best, t = abs(float(theta[top])), float(path.t[first + top])
    turned = top == 0 and omega[0] == 0.0 and best > 0.0
    for i in (top - 1, top):
        if not (0 <= i < len(theta) - 1 and omega[i] * omega[i + 1] < 0.0):
            continue
        turned, h = True, float(path.t[first + i + 1] - path.t[first + i])
        # θ turns where its rate, a parabola, is 0
        travel = float(theta[i + 1] - theta[i])
        a, b = h * float(omega[i]), h * float(omega[i + 1])
        square, linear = 3.0 * (a + b - 2.0 * travel), 2.0 * (3.0 * travel - 2.0 * a - b)
        larger = -0.5 * (linear + math.copysign(math.sqrt(linear * linear - 4.0 * square * a), linear))
        # One of the two roots is between 0 and 1, unless the rate only touches 0 at an end
        for s in (larger / square if square else math.inf, a / larger if larger else math.inf):
            if not 0.0 < s < 1.0:
                continue
            value = float(theta[i]) + s * travel + s * (1 - s) * ((1 - s) * (a - travel) + s * (travel - b))
            if abs(value) > best:
                best, t = abs(value), float(path.t[first + i]) + s * h
    return (best, t) if turned else (math.nan, math.nan)
