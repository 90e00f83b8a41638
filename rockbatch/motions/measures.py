"""Peak ground acceleration, velocity and displacement.

The acceleration is linear between its samples, from rest, and is integrated as it stands: no baseline is
fitted.
"""

import numpy as np

from rockbatch.motions.motion import Samples


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
