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
from rockbatch.core.block.model import Stance
from rockbatch.core.flexure.model import FlexibleBlock, Flexing, Grounded
from rockbatch.core.flexure.modes import PerMode, deflection_rates, deflections, dot, scaled, times
from rockbatch.core.kernel import hook, inlined
from rockbatch.core.table import along
from rockbatch.core.trigonometry import sine_and_cosine


class Masses(NamedTuple):
    """Terms of the mass matrix of deflection and rotation about a point of the base, per unit mass."""

    offset: float  # of that point to the right of the centre of mass, along the base [m]
    turning: float  # of θ̇² [m²]
    spread: PerMode  # half of its derivatives by the coordinates of the modes [m]


@inlined
def masses_about(m, u, key):
    """Return Masses about the point of the base at the share ``key`` of half its width to the right, with ``u`` of each mode."""
    moved, b = dot(m.share, u), key * m.half_width
    turning = m.inertia + m.height * m.height + b * b + dot(u, u) - 2.0 * moved * b
    return Masses(b - moved, turning, along(u, m.share, -b))


@inlined
def straightening(m, y):
    """Return the acceleration [m/s²] of each mode by the shaft's stiffness and damping."""
    stiff = times(times(m.frequency, m.frequency), deflections(y))
    return scaled(along(stiff, times(m.damping, deflection_rates(y)), 1.0), -1.0)


@hook
def _flies(contact):
    """Return True if both pivots are in the air; in a pass the compiler knows that they are not."""


@_flies.of(Stance)
def _stance_flies(contact):
    return contact.left == 0.0 and contact.right == 0.0


@_flies.of(Grounded)
def _never(contact):
    return False


@inlined
def _accelerations(m, y, contact, ground):
    """Return v̈ [m/s²], θ̈ [rad/s²] and ü of each mode [m/s²]; with both pivots down ``side`` and θ are 0."""
    flies, side = _flies(contact), side_of(contact)
    key = key_of(m, contact) if flies else side
    sine, cosine = sine_and_cosine(y.theta)
    about, weight, u_rate = masses_about(m, deflections(y), key), m.gravity + ground.vertical, deflection_rates(y)
    slope, arm = about.offset * cosine - m.height * sine, about.offset * sine + m.height * cosine
    straight_slope, straight_arm = arms_about(m, y.theta, key)
    down, back = pull_down(m.pull)
    squared = y.omega * y.omega
    across = weight * sine - ground.horizontal * cosine
    bending = along(along(straightening(m, y), about.spread, squared), m.share, across)
    turning = (
        -2.0 * dot(about.spread, u_rate) * y.omega
        - ground.horizontal * arm
        - weight * slope
        - back
        - down * straight_slope
    )
    turning -= dot(m.coupling, bending)
    inertia = about.turning - dot(m.coupling, m.coupling)
    if not flies:
        omega_rate = abs(side) * turning / inertia
        v_acceleration = straight_slope * omega_rate - straight_arm * squared
        return v_acceleration, omega_rate, along(bending, m.coupling, -omega_rate)
    # The corner rises, too: its equation and that of the rotation remain once those of the modes are solved
    falls = weight + down - arm * squared - 2.0 * dot(m.share, u_rate) * cosine * y.omega
    lifting = falls - sine * dot(m.share, bending)
    of_rise, of_both = 1.0 - sine * sine * dot(m.share, m.share), slope + sine * dot(m.share, m.coupling)
    determinant = of_rise * inertia - of_both * of_both
    omega_rate = (of_rise * turning + of_both * lifting) / determinant
    rise_rate = -(inertia * lifting + of_both * turning) / determinant
    v_acceleration = straight_slope * omega_rate - straight_arm * squared + rise_rate
    return v_acceleration, omega_rate, along(along(bending, m.coupling, -omega_rate), m.share, sine * rise_rate)


@inlined
def flexing(v, theta, v_rate, omega, u, u_rate):
    """Return the Flexing with the coordinates ``u`` of the modes and their rates."""
    return Flexing(
        v,
        theta,
        v_rate,
        omega,
        u.first,
        u.second,
        u.third,
        u.fourth,
        u_rate.first,
        u_rate.second,
        u_rate.third,
        u_rate.fourth,
    )


@system.rates.of(FlexibleBlock)
def rates(m, y, contact, ground):
    """Return the rates of state ``y``: the right-hand side."""
    v_acceleration, theta_acceleration, accelerations = _accelerations(m, y, contact, ground)
    return flexing(y.v_rate, y.omega, v_acceleration, theta_acceleration, deflection_rates(y), accelerations)


@constrained.of(FlexibleBlock)
def _constrained(m, y, contact):
    if _flies(contact):
        return y
    v, slope = on_pivot(m, y.theta, side_of(contact))
    return flexing(v, y.theta, slope * y.omega, y.omega, deflections(y), deflection_rates(y))


@system.end_step.of(FlexibleBlock)
def end_step(m, y, start, contact, remaining):
    """Return the end of a step, projected onto the pivot that is on the ground."""
    return constrained(m, y, contact)


@inlined
def velocity_of_centre(m, y, contact):
    """Return the velocity of the centre of mass over the ground [m/s], to the right and upwards."""
    side, u = side_of(contact), deflections(y)
    offset = masses_about(m, u, side if side != 0.0 else key_of(m, contact)).offset
    sine, cosine = sine_and_cosine(y.theta)
    moved, rate = dot(m.share, u), dot(m.share, deflection_rates(y))
    to_right = (offset * sine + m.height * cosine) * y.omega + rate * cosine
    return to_right, y.v_rate - rate * sine - moved * cosine * y.omega


@system.ground_power.of(FlexibleBlock)
def ground_power(m, y, contact, ground):
    """Return the power of the ground's inertia forces [W/kg]."""
    to_right, up = velocity_of_centre(m, y, contact)
    return -ground.horizontal * to_right - ground.vertical * up


@inlined
def bent_across(shape, y, k):
    """Return the horizontal acceleration [m/s²] of a point by the motion of its modes, which move it by ``shape``.

    It is relative to the turning base, Coriolis's included; ``k`` are the rates of state ``y``.
    """
    sine, cosine = sine_and_cosine(y.theta)
    return dot(shape, deflection_rates(k)) * cosine - 2.0 * dot(shape, deflection_rates(y)) * y.omega * sine


@inlined
def rise_of_bending(m, y, k):
    """Return the vertical acceleration [m/s²] of the centre of mass less that of a straight shaft."""
    sine, cosine = sine_and_cosine(y.theta)
    rate = dot(m.share, deflection_rates(y))
    turned = k.omega * cosine - y.omega * y.omega * sine
    bent = dot(m.share, deflection_rates(k)) * sine + 2.0 * rate * y.omega * cosine
    return -bent - dot(m.share, deflections(y)) * turned


@normal_force.of(FlexibleBlock)
def _normal_force(m, y, k, vertical):
    return m.gravity + vertical + k.v_rate + rise_of_bending(m, y, k) + pull_down(m.pull)[0]
