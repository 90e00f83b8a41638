"""Event functions of the pivots: positive until an event, where one falls through zero.

Each pivot has two functions. On its spring: −z (separation), or what is left to the corner of a backbone at which an inelastic
branch ends; and the law's switching_point (velocity reversal, or yield). Free: the gap to its support (landing). In grazing
contact: the two conditions that end it.
"""

import math
from typing import NamedTuple

from rockbatch.core import system
from rockbatch.core.kernel import inlined, kernel
from rockbatch.core.roots import NO_ACCELERATION, surely
from rockbatch.core.springs.backbone import corner_beyond
from rockbatch.core.springs.equations import geometry, holding, pivot_acceleration, touching, without
from rockbatch.core.springs.laws import branch_of_landing, switching_point
from rockbatch.core.springs.model import Springs
from rockbatch.core.springs.recovery import acceleration_of_top, lag, top, velocity_of_top
from rockbatch.core.types import LEFT, RIGHT, Signals

NO_GAP = 1e-12
"""Gap over δ_y that rounding can open or close."""


class Side(NamedTuple):
    """One side of the pier: position of its pivot [m], z of its spring, and their rates; what is constant between events."""

    position: float  # v_i [m]
    velocity: float  # [m/s]
    acceleration: float  # [m/s²]
    z: float
    z_rate: float  # [1/s]
    yields: float  # inelastic branch of the spring, 0 on the elastic one
    support: float  # position at which it is unstressed without its pivot [m]
    point: float  # yield point


@inlined
def _gap(m, gap, velocity, acceleration):
    """Return a gap [m]; one within rounding of a pivot at rest is made positive, unless the pivot accelerates downwards."""
    rounding = NO_GAP * m.yield_deflection
    if abs(velocity) <= m.rest and acceleration > -NO_ACCELERATION * m.gravity and abs(gap) <= rounding:
        return rounding
    return gap


@inlined
def _compression(m, z, z_rate, velocity, acceleration):
    """Return the compression of a support over F_y, with its dashpot, and its rate [1/s]."""
    if m.damped is None:
        return -z, -z_rate
    slower = lag(m)
    rising = z_rate / slower + acceleration
    if abs(rising) <= NO_ACCELERATION * m.gravity:
        rising = 0.0
    return -(z + slower * velocity), -slower * rising


@inlined
def _free_functions(m, side):
    """Return the gap [m] of a free pivot over its support, and its opening velocity [m/s]."""
    velocity = side.velocity - velocity_of_top(m, side.z)
    acceleration = side.acceleration - acceleration_of_top(m, side.z)
    gap = _gap(m, side.position - top(m, side.support, side.z), velocity, acceleration)
    return gap, surely(velocity, acceleration, m.rest)


@inlined
def _contact_functions(m, side):
    """Return the two event functions of a pivot on its spring, each followed by its slope.

    The first is separation; but a spring on an inelastic branch is pressed and cannot separate, so that it is then the corner at
    which that branch ends, if it does. The second is the change to and from the elastic branch.
    """
    z, z_rate, velocity, acceleration = side.z, side.z_rate, side.velocity, side.acceleration
    if abs(velocity) <= m.rest:
        if abs(acceleration) <= NO_ACCELERATION * m.gravity:
            acceleration = 0.0
        z_rate = surely(velocity, acceleration, m.rest) * m.stiffness
    contact, contact_slope = _compression(m, z, z_rate, velocity, acceleration)
    corner = corner_beyond(m.backbone, side.yields)
    if side.yields != 0.0 and corner < math.inf:
        contact, contact_slope = z + corner, z_rate
    law, law_slope = switching_point(m.law, side, z_rate, acceleration)
    return contact, contact_slope, law, law_slope


@kernel
def _grazing_functions(m, y, contact, side, ground):
    """Return the event functions of a grazing contact, which lasts while contact would lift the pivot and flight lower it."""
    lifted = pivot_acceleration(m, y, touching(contact, side, 0.0), side, ground)
    pressed = -pivot_acceleration(m, y, without(contact, side), side, ground)
    return lifted, pressed


@inlined
def _sides(m, y, k, contact, supports):
    """Return both sides in state ``y`` with rates ``k``."""
    at, turning = geometry(m, y.theta), y.omega * y.omega
    velocity = y.v_rate + at.arm_left * y.omega
    acceleration = k.v_rate + at.arm_left * k.omega + at.bend_left * turning
    yields, support, point = contact.left_yields, supports.left, supports.yield_left
    left = Side(y.v + at.lift_left, velocity, acceleration, y.z_left, k.z_left, yields, support, point)
    velocity = y.v_rate + at.arm_right * y.omega
    acceleration = k.v_rate + at.arm_right * k.omega + at.bend_right * turning
    yields, support, point = contact.right_yields, supports.right, supports.yield_right
    return left, Side(y.v + at.lift_right, velocity, acceleration, y.z_right, k.z_right, yields, support, point)


@system.event_functions.of(Springs)
def event_functions(m, devices, now):
    """Return the Signals of both pivots, and their slopes."""
    y, k, contact, supports, ground = now
    left_side, right_side = _sides(m, y, k, contact, supports)
    left_law, left_law_slope, right_law, right_law_slope = 1.0, 0.0, 1.0, 0.0
    if contact.left != 0.0:
        left, left_slope, left_law, left_law_slope = _contact_functions(m, left_side)
    else:
        left, left_slope = _free_functions(m, left_side)
    if contact.right != 0.0:
        right, right_slope, right_law, right_law_slope = _contact_functions(m, right_side)
    else:
        right, right_slope = _free_functions(m, right_side)
    if contact.held < 0.0:
        left, left_law = _grazing_functions(m, y, contact, LEFT, ground)
        left_slope = 0.0
    elif contact.held > 0.0:
        right, right_law = _grazing_functions(m, y, contact, RIGHT, ground)
        right_slope = 0.0
    return Signals(left, right, left_law, right_law), Signals(left_slope, right_slope, left_law_slope, right_law_slope)


@kernel
def settle(m, y, contact, side, ground):
    """Return the contacts of a pivot at its support with the same velocity, as the accelerations decide.

    It is in contact if the equations of contact press it down; else free if those of flight lift it; else neither has a
    solution, and the contact grazes (Filippov's sliding mode).
    """
    at = geometry(m, y.theta)
    arm = at.arm_left if side == LEFT else at.arm_right
    yields = branch_of_landing(m, y.v_rate + arm * y.omega)
    on = touching(contact, side, yields)
    if pivot_acceleration(m, y, on, side, ground) < 0.0:
        return on
    off = without(contact, side)
    if pivot_acceleration(m, y, off, side, ground) > NO_ACCELERATION * m.gravity:
        return off
    return holding(contact, side, yields)
