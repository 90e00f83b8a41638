"""Elongations of devices from the motion of the base (THEORY.md, Dampers and tendons, Stops and deck springs).

A device at the offset s from the middle of the base has the elongation e = u/cos(θ/2), where u is the rise of its place from
rest. For a block that turns about a point of the ground at the distance d this is 2 d sin(θ/2), the chord of the place's arc.
In first-order kinematics e = u. The elongation of a device at the deck is the deck's displacement over the ground.
"""

import math
from typing import NamedTuple

from rockbatch.core.kernel import inlined
from rockbatch.core.system import shift, sines_in_pass
from rockbatch.core.table import record
from rockbatch.core.trigonometry import sine_and_cosine


class Attitude(NamedTuple):
    """Position and inclination of the base at one moment."""

    sine: float  # of θ; in first-order kinematics θ
    cosine: float
    tangent: float  # of θ/2
    by_rise: float  # 1/cos(θ/2)
    rise: float  # of the middle of the base above that at rest [m]
    shift: float  # of devices to the right of their offsets [m]


class Gap(NamedTuple):
    """Elongation e of a device at one moment, and its derivatives."""

    elongation: float  # [m]
    speed: float  # ė [m/s]
    by_v: float  # ∂e/∂v
    by_theta: float  # ∂e/∂θ [m]
    bend: float  # ë − (v̈ ∂e/∂v + θ̈ ∂e/∂θ) [m/s²]
    arm: float  # of the force about the centre of mass [m], with first-order P–Δ


GAP = record(Gap)


@inlined
def put_gap(line, at):
    """Write the Gap ``at`` into a ``line`` of a table."""
    line.elongation, line.speed, line.by_v = at.elongation, at.speed, at.by_v
    line.by_theta, line.bend, line.arm = at.by_theta, at.bend, at.arm


@inlined
def attitude(m, y, contact, level):
    """Return the Attitude in state ``y``; its rise is above ``level`` [m], v at rest."""
    return _tilted(m, y, contact, level, sine_and_cosine(y.theta))


@inlined
def attitude_in_pass(m, y, contact, level):
    """Return the Attitude in state ``y`` of a pass."""
    return _tilted(m, y, contact, level, sines_in_pass(m, y.theta))


@inlined
def _tilted(m, y, contact, level, sines):
    """Return the Attitude in state ``y``, whose rotation has the ``sines``: sine and cosine."""
    if m.finite is None:
        return Attitude(y.theta, 1.0, 0.0, 1.0, y.v - level, 0.0)
    sine, cosine = sines
    tangent = sine / (1.0 + cosine)
    rise = y.v - level + m.height * sine * tangent
    return Attitude(sine, cosine, tangent, math.sqrt(1.0 + tangent * tangent), rise, shift(m, contact))


@inlined
def gap(m, s, at, y):
    """Return the Gap of a device at the offset ``s`` [m] in state ``y``, whose Attitude is ``at``."""
    up, arm = at.rise - s * at.sine, m.height * at.sine - s * at.cosine  # u and ∂u/∂θ
    if m.finite is None:
        return Gap(up, y.v_rate - s * y.omega, 1.0, -s, 0.0, arm)
    by_v, tangent = at.by_rise, at.tangent
    curve = m.height * at.cosine + s * at.sine  # ∂²u/∂θ²
    by_theta = by_v * (arm + 0.5 * tangent * up)
    twist = curve + tangent * arm + up * (0.25 + 0.5 * tangent * tangent)  # cos(θ/2) ∂²e/∂θ²
    bend = by_v * y.omega * (tangent * y.v_rate + twist * y.omega)
    return Gap(by_v * up, by_v * y.v_rate + by_theta * y.omega, by_v, by_theta, bend, by_theta)


@inlined
def across(m, of, at, y):
    """Return the Gap of the device ``of`` at the deck, positive along its ``way``.

    To the side to which the pier leans it is h_d sin θ, and b (1 − cos θ) more if the pier turns about its pivots; h_d θ with
    linearised kinematics.
    """
    if m.finite is None:
        by_theta = of.way * of.height
        return Gap(by_theta * y.theta, by_theta * y.omega, 0.0, by_theta, 0.0, by_theta)
    swing = math.copysign(of.swing, at.sine)
    by_theta = of.way * (of.height * at.cosine + swing * at.sine)
    way = of.way * at.sine * (of.height + swing * at.tangent)
    bend = of.way * (swing * at.cosine - of.height * at.sine) * y.omega * y.omega
    return Gap(way, by_theta * y.omega, 0.0, by_theta, bend, by_theta)


@inlined
def gap_of(m, of, at, y):
    """Return the Gap of the device ``of`` in state ``y``, whose Attitude is ``at``."""
    return gap(m, of.offset + at.shift, at, y) if of.height == 0.0 else across(m, of, at, y)


@inlined
def chosen(first, a, b):
    """Return the Gap ``a`` if ``first``, else ``b``; fields are selected, since a loop with a branch stays scalar."""
    return Gap(
        a.elongation if first else b.elongation,
        a.speed if first else b.speed,
        a.by_v if first else b.by_v,
        a.by_theta if first else b.by_theta,
        a.bend if first else b.bend,
        a.arm if first else b.arm,
    )


@inlined
def gap_in_pass(m, of, at, y):
    """Return the Gap of the device ``of`` in state ``y`` of a pass, whose Attitude is ``at``."""
    return chosen(of.height != 0.0, across(m, of, at, y), gap(m, of.offset + at.shift, at, y))


@inlined
def lifted(at, k):
    """Return ë [m/s²] of a device with the Gap ``at``, from the pier's rates ``k``."""
    return at.by_v * k.v_rate + at.by_theta * k.omega + at.bend
