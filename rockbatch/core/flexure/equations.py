"""Equations of a pier with an elastic shaft: full contact, rocking, flight (THEORY.md, A shaft that bends)."""

from typing import NamedTuple

from rockbatch.core import system
from rockbatch.core.block.equations import (
    arms_about,
    constrained,
    key_of,
    normal_force,
    on_pivot,
    pull_down,
    side_of,
)
from rockbatch.core.flexure.model import FlexibleBlock, Flexing
from rockbatch.core.kernel import inlined
from rockbatch.core.trigonometry import sine_and_cosine


class Masses(NamedTuple):
    """Terms of the mass matrix of deflection and rotation about a point of the base, per unit mass."""

    offset: float  # of that point to the right of the centre of mass, along the base [m]
    turning: float  # of θ̇² [m²]
    spread: float  # half of its derivative by u [m]


@inlined
def masses_about(m, u, key):
    """Return Masses about the point of the base at the share ``key`` of half its width to the right."""
    moved, b = m.first * u, key * m.half_width
    turning = m.inertia + m.height * m.height + b * b + u * (m.second * u - 2.0 * m.first * b)
    return Masses(b - moved, turning, m.second * u - m.first * b)


@inlined
def _accelerations(m, y, contact, ground):
    """Return v̈ [m/s²], θ̈ [rad/s²] and ü [m/s²]."""
    spring = m.frequency * m.frequency * y.u + m.damping * y.u_rate
    if contact.left != 0.0 and contact.right != 0.0:
        return 0.0, 0.0, -spring - ground.horizontal * m.first / m.second
    side = side_of(contact)
    key = side if side != 0.0 else key_of(m, contact)
    sine, cosine = sine_and_cosine(y.theta)
    about, weight = masses_about(m, y.u, key), m.gravity + ground.vertical
    slope, arm = about.offset * cosine - m.height * sine, about.offset * sine + m.height * cosine
    straight_slope, straight_arm = arms_about(m, y.theta, key)
    down, back = pull_down(m.pull)
    squared = y.omega * y.omega
    bending = about.spread * squared - m.second * spring + m.first * (weight * sine - ground.horizontal * cosine)
    turning = (
        -2.0 * about.spread * y.u_rate * y.omega
        - ground.horizontal * arm
        - weight * slope
        - back
        - down * straight_slope
    )
    of_u, of_both, of_theta, lift, falls = m.second, m.coupling, about.turning, 0.0, 0.0
    if side == 0.0:
        lift = -m.first * sine
        falls = weight + down - arm * squared - 2.0 * m.first * cosine * y.u_rate * y.omega
        of_u, of_both, of_theta = of_u - lift * lift, of_both - lift * slope, of_theta - slope * slope
        bending, turning = bending + lift * falls, turning + slope * falls
    determinant = of_u * of_theta - of_both * of_both
    theta_acceleration = (of_u * turning - of_both * bending) / determinant
    u_acceleration = (of_theta * bending - of_both * turning) / determinant
    v_acceleration = straight_slope * theta_acceleration - straight_arm * squared
    if side == 0.0:
        v_acceleration -= falls + slope * theta_acceleration + lift * u_acceleration
    return v_acceleration, theta_acceleration, u_acceleration


@system.rates.of(FlexibleBlock)
def rates(m, y, contact, ground):
    """Return the rates of state ``y``: the right-hand side."""
    v_acceleration, theta_acceleration, u_acceleration = _accelerations(m, y, contact, ground)
    return Flexing(y.v_rate, y.omega, v_acceleration, theta_acceleration, y.u_rate, u_acceleration)


@constrained.of(FlexibleBlock)
def _constrained(m, y, contact):
    side = side_of(contact)
    if side == 0.0:
        return y
    v, slope = on_pivot(m, y.theta, side)
    return Flexing(v, y.theta, slope * y.omega, y.omega, y.u, y.u_rate)


@system.end_step.of(FlexibleBlock)
def end_step(m, y, start, contact, remaining):
    """Return the end of a step, projected onto the pivot that is on the ground."""
    return constrained(m, y, contact)


@inlined
def velocity_of_centre(m, y, contact):
    """Return the velocity of the centre of mass over the ground [m/s], to the right and upwards."""
    side = side_of(contact)
    offset = masses_about(m, y.u, side if side != 0.0 else key_of(m, contact)).offset
    sine, cosine = sine_and_cosine(y.theta)
    along = (offset * sine + m.height * cosine) * y.omega + m.first * cosine * y.u_rate
    return along, y.v_rate - m.first * (y.u_rate * sine + y.u * cosine * y.omega)


@system.ground_power.of(FlexibleBlock)
def ground_power(m, y, contact, ground):
    """Return the power of the ground's inertia forces [W/kg]."""
    along, up = velocity_of_centre(m, y, contact)
    return -ground.horizontal * along - ground.vertical * up


@inlined
def rise_of_bending(m, y, k):
    """Return the vertical acceleration [m/s²] of the centre of mass less that of a straight shaft."""
    sine, cosine = sine_and_cosine(y.theta)
    turned = k.omega * cosine - y.omega * y.omega * sine
    return -m.first * (k.u_rate * sine + 2.0 * y.u_rate * y.omega * cosine + y.u * turned)


@normal_force.of(FlexibleBlock)
def _normal_force(m, y, k, vertical):
    return m.gravity + vertical + k.v_rate + rise_of_bending(m, y, k) + pull_down(m.pull)[0]
