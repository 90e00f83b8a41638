"""Correction of a step for velocity reversals of springs, without a search (THEORY.md, Reversals of springs)."""

from typing import NamedTuple

from rockbatch.core.kernel import inlined
from rockbatch.core.springs.equations import geometry
from rockbatch.core.springs.laws import stiffness_loss
from rockbatch.core.springs.model import State

SHARP = 1e-3
"""Greatest change of z by a corrected reversal."""


class Pivot(NamedTuple):
    """Vertical position and velocity of a pivot."""

    position: float  # v_i [m]
    velocity: float  # [m/s]


class Reversal(NamedTuple):
    """Reversal of one spring in a step; without one ``after`` and ``added`` are 0."""

    after: float  # time from the reversal to the end of the step [s], above 0 if it happened
    z: float  # at the reversal
    unstressed: float  # position then [m]
    added: float  # change of z at the end of the step by the other branch
    softness: (
        float  # δ_y dz per change of the pivot's position at the end of the step: 1 − |z|ⁿ on the inelastic branch
    )
    surely: float  # positive unless there may be two reversals, or one too sharp for a correction


@inlined
def pivots(m, y):
    """Return the Pivots of the left and the right side in state ``y``: vertical position [m] and velocity [m/s]."""
    at = geometry(m, y.theta)
    return (
        Pivot(y.v + at.lift_left, y.v_rate + at.arm_left * y.omega),
        Pivot(y.v + at.lift_right, y.v_rate + at.arm_right * y.omega),
    )


@inlined
def pivot_accelerations(m, y, k):
    """Return the accelerations [m/s²] of both pivots in state ``y`` with rates ``k``."""
    at, turning = geometry(m, y.theta), y.omega * y.omega
    left = k.v_rate + at.arm_left * k.omega + at.bend_left * turning
    right = k.v_rate + at.arm_right * k.omega + at.bend_right * turning
    return left, right


@inlined
def _size(z):
    """Return −z within 0 to 1: |z| in compression, where z is negative, and 0 in tension."""
    return min(max(-z, 0.0), 1.0)


@inlined
def reversal(m, sign, start, acceleration, end, z_end, h):
    """Return the Reversal of a spring in a step of ``h`` [s] on a single branch, from Pivot ``start`` to ``end``.

    Parameters
    ----------
    sign : float
        Sign of the velocity on the branch, :func:`rockbatch.core.springs.laws.kept_sign`.
    acceleration : float
        Acceleration of the pivot at the start [m/s²].
    z_end : float
        z at the end of the step by the branch.
    """
    w0, w1 = sign * start.velocity, sign * end.velocity
    part = stiffness_loss(m, _size(z_end))
    if not w1 < -m.rest:
        softness = 1.0 if sign >= 0.0 else 1.0 - part
        unstressed = end.position - m.yield_deflection * z_end
        return Reversal(0.0, z_end, unstressed, 0.0, softness, min(once(m, sign, start, end, h), SHARP))
    share = w1 / (w1 - max(w0, 0.0))  # of the step after the reversal, by the chord
    before = 1.0 - share
    way = end.position - start.position
    # The position has an extremum at the reversal, so that an error of its time counts squared; a quartic gives it
    cubic = share * (h * start.velocity - way) + before * (way - h * end.velocity)
    quartic = h * (0.5 * h * acceleration + 2.0 * start.velocity + end.velocity) - 3.0 * way
    unit = share * (way - before * (cubic + before * share * quartic)) * m.stiffness  # way after the reversal/δ_y
    middle = z_end - 0.5 * unit * (1.0 + sign * part)
    added = stiffness_loss(m, _size(middle)) * abs(unit)
    unloads = sign < 0.0  # the branch at the end is elastic
    z = z_end - unit + (added if unloads else 0.0)
    unstressed = end.position - m.yield_deflection * (z + unit)
    return Reversal(share * h, z, unstressed, added, 1.0 if unloads else 1.0 - part, SHARP - added)


@inlined
def once(m, sign, start, end, h):
    """Return a number [m] that is negative if a velocity with ``sign`` at both ends may reverse twice in between.

    It bounds the parabola through both velocities and the displacement.
    """
    speed, speed_end = h * (sign * start.velocity), h * (sign * end.velocity)
    sag = 1.5 * (speed + speed_end) - 3.0 * sign * (end.position - start.position)
    return min(speed, speed_end) + h * m.rest - 0.5 * sag


@inlined
def corrected(m, contact, y, left, right):
    """Return the end of a step, ``y``, after the reversals ``left`` and ``right``.

    The added z grows like the square of the time t since the reversal. Its force changes velocities by the impulse F_y δz t/3,
    and positions by F_y δz t²/12, which both springs follow.
    """
    at = geometry(m, y.theta)
    third = m.yield_force * (1.0 / 3.0)
    push_left, push_right = third * left.added * left.after, third * right.added * right.after
    way_left, way_right = 0.25 * left.after * push_left, 0.25 * right.after * push_right
    lever = m.height
    if m.finite is not None:
        lever = at.lever + (contact.right - contact.left) * at.swing
    turn = -1.0 / (m.inertia + lever * lever)
    v = -(way_left + way_right)
    theta = turn * (at.moment_left * way_left + at.moment_right * way_right)
    if m.damped is not None:  # impulse of the dashpots by these displacements
        push_left += m.damping * contact.left * (v + at.arm_left * theta)
        push_right += m.damping * contact.right * (v + at.arm_right * theta)
    return State(
        y.v + v,
        y.theta + theta,
        y.v_rate - (push_left + push_right),
        y.omega + turn * (at.moment_left * push_left + at.moment_right * push_right),
        y.z_left + left.added + contact.left * m.stiffness * (v + at.arm_left * theta) * left.softness,
        y.z_right + right.added + contact.right * m.stiffness * (v + at.arm_right * theta) * right.softness,
    )
