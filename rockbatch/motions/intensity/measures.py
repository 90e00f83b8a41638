"""Intensity measures: peak acceleration, velocity and displacement, Arias intensity, CAV and durations.

For velocity and displacement the acceleration, linear between its samples, is integrated from the velocity and displacement
that the record's file states for its first sample, else from rest: no baseline is fitted.
"""

import math

import numpy as np

from rockbatch.common.units import GRAVITY
from rockbatch.motions.motion import Initial, Motion, Samples

_REST = Initial()
_STRAIGHT = 2.5  # times: half of a permanent displacement, however sudden, stays beside any straight line
_BELONG = 0.2  # of its peak: scatter of a file's velocity about the integral of its accelerations


def velocity(acceleration: Samples, dt: float, initial: Initial | None = None) -> Samples:
    """Return the ground velocity [m/s] at the samples, shape (npts,), by an acceleration [m/s²] from ``initial``, or rest."""
    increments = 0.5 * dt * (acceleration[:-1] + acceleration[1:])
    return (initial or _REST).velocity + np.concatenate(([0.0], np.cumsum(increments)))


def displacement(acceleration: Samples, dt: float, initial: Initial | None = None) -> Samples:
    """Return the ground displacement [m] at the samples, shape (npts,), by an acceleration [m/s²] from ``initial``, or rest."""
    v = velocity(acceleration, dt, initial)
    increments = dt * v[:-1] + dt**2 / 6.0 * (2.0 * acceleration[:-1] + acceleration[1:])
    return (initial or _REST).displacement + np.concatenate(([0.0], np.cumsum(increments)))


def initial_of(
    acceleration: Samples, dt: float, velocities: Samples | None, displacements: Samples | None
) -> Initial | None:
    """Return the ground's state at the first sample from the velocities [m/s] and displacements [m] of a record's file.

    It is the mean difference, over the record, from the integral from rest: a file's first values are rounded, and
    accelerations that were thinned out after their integration drift from them. ``None`` without as many velocities, or if these
    scatter about the integral of the acceleration by over 20 % of their peak; displacement 0 without as many displacements.
    """
    if velocities is None or len(velocities) != len(acceleration):
        return None
    offsets = velocities - velocity(acceleration, dt)
    initial = Initial(float(offsets.mean()))
    if offsets.std() > _BELONG * np.abs(velocities).max():
        return None
    if displacements is None or len(displacements) != len(acceleration):
        return initial
    return Initial(initial.velocity, float((displacements - displacement(acceleration, dt, initial)).mean()))


def state_at(acceleration: Samples, dt: float, initial: Initial, time: float) -> Initial:
    """Return velocity [m/s] and displacement [m] at a ``time`` [s after the first sample] up to the last sample."""
    k = min(int(time / dt), len(acceleration) - 2)
    remainder = time - k * dt
    v, d = (float(series(acceleration, dt, initial)[k]) for series in (velocity, displacement))
    a, slope = float(acceleration[k]), float(acceleration[k + 1] - acceleration[k]) / dt
    return Initial(
        v + remainder * (a + remainder * slope / 2.0),
        d + remainder * (v + remainder * (a / 2.0 + remainder * slope / 6.0)),
    )


def pga(acceleration: Samples) -> float:
    """Return the peak ground acceleration [m/s²], by its absolute value."""
    return float(np.abs(acceleration).max())


def pgv(acceleration: Samples, dt: float, initial: Initial | None = None) -> float:
    """Return the peak absolute ground velocity [m/s] at the samples, from ``initial``, else from rest."""
    return float(np.abs(velocity(acceleration, dt, initial)).max())


def pgd(acceleration: Samples, dt: float, initial: Initial | None = None) -> float:
    """Return the peak absolute ground displacement [m] at the samples, from ``initial``, else from rest."""
    return float(np.abs(displacement(acceleration, dt, initial)).max())


def runs_away(displacements: Samples) -> bool:
    """Return whether a displacement is mostly linear drift, which is not the ground's; False for no displacement.

    Subtracting the best line through the first sample then divides its peak by more than 2.5. A permanent displacement, however
    sudden, is not reduced so much.
    """
    moved = displacements - displacements[0]
    steps = np.arange(len(moved), dtype=float)
    straight = float(moved @ steps) / max(float(steps @ steps), 1.0) * steps
    return float(np.abs(moved).max()) > _STRAIGHT * float(np.abs(moved - straight).max())


def believable_pgd(motion: Motion) -> float | None:
    """Return the PGD [m] of a motion; ``None`` if its displacement drifts and its initial state is unknown."""
    moved = displacement(motion.horizontal, motion.dt, motion.initial)
    return None if motion.initial is None and runs_away(moved) else float(np.abs(moved).max())


def duration_of_shaking(motion: Motion) -> float | None:
    """Return the significant duration D5–95 [s] of a motion; ``None`` for a sequence, whose pauses are no shaking."""
    return None if len(motion.records) > 1 else significant_duration(motion.horizontal, motion.dt)


def arias_intensity(acceleration: Samples, dt: float, gravity: float = GRAVITY) -> float:
    """Return the Arias intensity π/(2g) ∫a² dt [m/s] (Arias 1970)."""
    return math.pi / (2.0 * gravity) * float(_energy(acceleration, dt)[-1])


def significant_duration(acceleration: Samples, dt: float, start: float = 0.05, end: float = 0.95) -> float:
    """Return the time [s] in which ∫a² dt grows from ``start`` to ``end`` of its final value; D5–95 (Trifunac & Brady 1975).

    The integral is interpolated linearly between samples. 0 for a record without any acceleration.
    """
    energy = _energy(acceleration, dt)
    # the integral is constant over silence; interpolation needs one time, the first, for each value
    grows = np.concatenate(([True], np.diff(energy) > 0))
    times = np.interp([start * energy[-1], end * energy[-1]], energy[grows], np.flatnonzero(grows) * dt)
    return float(times[1] - times[0])


def _energy(acceleration: Samples, dt: float) -> Samples:
    """Return ∫a² dt [m²/s³] up to each sample, shape (npts,).

    By trapezoids of a², as other programs do it: squaring a linear a would lose (ωΔ)²/6 of the energy of a wave.
    """
    squares = acceleration * acceleration
    return np.concatenate(([0.0], np.cumsum(0.5 * dt * (squares[:-1] + squares[1:]))))


def cumulative_absolute_velocity(acceleration: Samples, dt: float) -> float:
    """Return CAV = ∫|a| dt [m/s] over the whole record (EPRI 1988).

    By trapezoids of |a|, as other programs do it. They are too large where a changes its sign between samples, by about as much
    as a linear a cuts off the peaks of a wave.
    """
    sizes = np.abs(acceleration)
    return float(0.5 * dt * (sizes[:-1] + sizes[1:]).sum())


def bracketed_duration(acceleration: Samples, dt: float, threshold: float) -> float:
    """Return the time [s] from the first to the last exceedance of ``threshold`` [m/s²] by |a| (Bolt 1973); 0 without any."""
    above = np.flatnonzero(np.abs(acceleration) > threshold)
    if len(above) == 0:
        return 0.0

    def beyond(last_above: int, outside: int) -> float:
        """Return the share of the interval to the sample ``outside`` in which |a| exceeds the threshold; 0 past either end."""
        if not 0 <= outside < len(acceleration):
            return 0.0
        a = acceleration[last_above]
        return float((abs(a) - threshold) / (abs(a) - math.copysign(1.0, a) * acceleration[outside]))

    first, last = int(above[0]), int(above[-1])
    return (last - first + beyond(first, first - 1) + beyond(last, last + 1)) * dt


def uniform_duration(acceleration: Samples, dt: float, threshold: float) -> float:
    """Return the time [s] during which |a| exceeds ``threshold`` [m/s²], all exceedances together (Bolt 1973); 0 without any."""

    def above(a: Samples) -> float:
        least, largest = np.minimum(a[:-1], a[1:]), np.maximum(a[:-1], a[1:])
        level = largest == least
        share = np.clip((largest - threshold) / np.where(level, 1.0, largest - least), 0.0, 1.0)
        return float(np.where(level, largest > threshold, share).sum())

    return dt * (above(acceleration) + above(-acceleration))
