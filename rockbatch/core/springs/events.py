"""Event functions of the pivots: positive until an event, at which one falls through zero.

Each pivot has two signals. On its spring: −z (separation) and the spring law's switching_point (reversal of the velocity, or
yield). Free: the gap to the waiting support (landing). Held: the two conditions under which it stops being held.
"""

from rockbatch.core import system
from rockbatch.core.kernel import inlined, kernel
from rockbatch.core.roots import NO_ACCELERATION, surely
from rockbatch.core.springs.equations import geometry, holding, pivot_acceleration, touching, without
from rockbatch.core.springs.laws import branch_of_landing, switching_point
from rockbatch.core.springs.model import Springs
from rockbatch.core.springs.recovery import acceleration_of_top, lag, top, velocity_of_top
from rockbatch.core.types import LEFT, RIGHT, Signals

NO_GAP = 1e-12
"""Of δ_y: a gap that rounding can open or close."""


@system.at_rest.of(Springs)
def at_rest(m):
    """Return the velocity [m/s] below which a pivot counts as having none: rounding, next to g/ω_v."""
    return 1e-12 * m.gravity * (m.yield_deflection / m.yield_force) ** 0.5 * 0.7071067811865476


@inlined
def _gap(m, gap, velocity, acceleration, rest):
    """Return a gap; one that is nothing but rounding, of a pivot that has no velocity either, opens unless it is pressed down."""
    rounding = NO_GAP * m.yield_deflection
    if abs(velocity) <= rest and acceleration > -NO_ACCELERATION * m.gravity and abs(gap) <= rounding:
        return rounding
    return gap


@inlined
def _compression(m, z, z_rate, velocity, acceleration):
    """Return the force over F_y with which a pivot presses its support, and its rate [1/s]."""
    if m.damped is None:
        return -z, -z_rate
    slower = lag(m)
    rising = z_rate / slower + acceleration
    if abs(rising) <= NO_ACCELERATION * m.gravity:
        rising = 0.0
    return -(z + slower * velocity), -slower * rising


@inlined
def _above(m, position, velocity, acceleration, support, z, rest):
    """Return the gap [m] of a free pivot over its support, and the velocity [m/s] with which it opens."""
    velocity -= velocity_of_top(m, z)
    acceleration -= acceleration_of_top(m, z)
    gap = _gap(m, position - top(m, support, z), velocity, acceleration, rest)
    return gap, surely(velocity, acceleration, rest)


@inlined
def _on_spring(m, z, z_rate, yields, point, velocity, acceleration, rest):
    """Return values and slopes of the two event functions of a pivot on its spring."""
    if abs(velocity) <= rest:
        if abs(acceleration) <= NO_ACCELERATION * m.gravity:
            acceleration = 0.0
        z_rate = surely(velocity, acceleration, rest) * m.stiffness
    contact, contact_slope = _compression(m, z, z_rate, velocity, acceleration)
    law, law_slope = switching_point(m.law, yields, point, z, z_rate, velocity, acceleration)
    return contact, contact_slope, law, law_slope


@kernel
def _held(m, y, contact, side, horizontal, vertical):
    """Return the event functions of a grazing contact: it lasts while contact would lift the pivot and freedom press it down."""
    lifted = pivot_acceleration(m, y, touching(contact, side, 0.0), side, horizontal, vertical)
    pressed = -pivot_acceleration(m, y, without(contact, side), side, horizontal, vertical)
    return lifted, pressed


@system.longest.of(Springs)
def longest(m, y, k, contact, h):
    """Return all of ``h`` [s]: steps that resolve the springs show what happens."""
    return h


@system.event_functions.of(Springs)
def event_functions(m, devices, y, k, contact, supports, rest, ground):
    """Return Signals of state ``y`` with rates ``k``, and their slopes; ``supports`` are those of free pivots [m]."""
    horizontal, vertical = ground.horizontal, ground.vertical
    at = geometry(m, y.theta)
    left_velocity = y.v_rate + at.arm_left * y.omega
    right_velocity = y.v_rate + at.arm_right * y.omega
    turning = y.omega * y.omega
    left_acceleration = k.v_rate + at.arm_left * k.omega + at.bend_left * turning
    right_acceleration = k.v_rate + at.arm_right * k.omega + at.bend_right * turning

    left_law, left_law_slope, right_law, right_law_slope = 1.0, 0.0, 1.0, 0.0
    if contact.left != 0.0:
        left, left_slope, left_law, left_law_slope = _on_spring(
            m, y.z_left, k.z_left, contact.left_yields, supports.yield_left,
            left_velocity, left_acceleration, rest,
        )  # fmt: skip
    else:
        position = y.v + at.lift_left
        left, left_slope = _above(m, position, left_velocity, left_acceleration, supports.left, y.z_left, rest)
    if contact.right != 0.0:
        right, right_slope, right_law, right_law_slope = _on_spring(
            m, y.z_right, k.z_right, contact.right_yields, supports.yield_right,
            right_velocity, right_acceleration, rest,
        )  # fmt: skip
    else:
        position = y.v + at.lift_right
        right, right_slope = _above(m, position, right_velocity, right_acceleration, supports.right, y.z_right, rest)
    if contact.held < 0.0:
        left, left_law = _held(m, y, contact, LEFT, horizontal, vertical)
        left_slope = 0.0
    elif contact.held > 0.0:
        right, right_law = _held(m, y, contact, RIGHT, horizontal, vertical)
        right_slope = 0.0
    return Signals(left, right, left_law, right_law), Signals(left_slope, right_slope, left_law_slope, right_law_slope)


@kernel
def settle(m, y, contact, side, horizontal, vertical):
    """Return the contacts of a pivot that is at its support and goes as it does: the accelerations decide.

    Contact equations that press it down keep it there; else free ones that lift it let it go; else neither has a
    solution, and it is held (Filippov's sliding mode).
    """
    at = geometry(m, y.theta)
    arm = at.arm_left if side == LEFT else at.arm_right
    yields = branch_of_landing(m, y.v_rate + arm * y.omega)
    on = touching(contact, side, yields)
    if pivot_acceleration(m, y, on, side, horizontal, vertical) < 0.0:
        return on
    off = without(contact, side)
    if pivot_acceleration(m, y, off, side, horizontal, vertical) > NO_ACCELERATION * m.gravity:
        return off
    return holding(contact, side, yields)
