"""Intensity measures: peak acceleration, velocity and displacement, Arias intensity and significant duration.

For velocity and displacement the acceleration is linear between its samples, from rest, and is integrated as it
stands: no baseline is fitted.
"""

import math

import numpy as np

from rockbatch.motions.motion import Samples
from rockbatch.units import GRAVITY


def velocity(acceleration: Samples, dt: float) -> Samples:
    """Ground velocity [m/s] at the samples, shape (npts,), of an acceleration [m/s²]; ``dt`` in s."""
    increments = 0.5 * dt * (acceleration[:-1] + acceleration[1:])
    return np.concatenate(([0.0], np.cumsum(increments)))


def displacement(acceleration: Samples, dt: float) -> Samples:
    """Ground displacement [m] at the samples, shape (npts,), of an acceleration [m/s²]; ``dt`` in s."""
    v = velocity(acceleration, dt)
    increments = dt * v[:-1] + dt**2 / 6.0 * (2.0 * acceleration[:-1] + acceleration[1:])
    return np.concatenate(([0.0], np.cumsum(increments)))


def pga(acceleration: Samples) -> float:
    """Peak ground acceleration [m/s²]."""
    return float(np.abs(acceleration).max())


def pgv(acceleration: Samples, dt: float) -> float:
    """Peak ground velocity [m/s], at the samples."""
    return float(np.abs(velocity(acceleration, dt)).max())


def pgd(acceleration: Samples, dt: float) -> float:
    """Peak ground displacement [m], at the samples."""
    return float(np.abs(displacement(acceleration, dt)).max())


def arias_intensity(acceleration: Samples, dt: float, gravity: float = GRAVITY) -> float:
    """Arias intensity π/(2g) ∫a² dt [m/s] (Arias 1970)."""
    return math.pi / (2.0 * gravity) * float(_energy(acceleration, dt)[-1])


def significant_duration(acceleration: Samples, dt: float, start: float = 0.05, end: float = 0.95) -> float:
    """Time [s] in which ∫a² dt grows from ``start`` to ``end`` of its final value; D5–95 (Trifunac & Brady 1975).

    Between samples the integral is taken to grow evenly. 0 for a record without any acceleration.
    """
    energy = _energy(acceleration, dt)
    # where a record is silent the integral stays level: the first time that it has a value counts
    grows = np.concatenate(([True], np.diff(energy) > 0))
    times = np.interp([start * energy[-1], end * energy[-1]], energy[grows], np.flatnonzero(grows) * dt)
    return float(times[1] - times[0])


def _energy(acceleration: Samples, dt: float) -> Samples:
    """∫a² dt [m²/s³] until each sample, shape (npts,).

    By trapezoids of a², as other programs do it: chords of a would lose (ωΔ)²/6 of the energy of a wave.
    """
    squares = acceleration * acceleration
    return np.concatenate(([0.0], np.cumsum(0.5 * dt * (squares[:-1] + squares[1:]))))
