"""A shaft that bends, on damped springs: its contacts, and its part of the pass over lanes (THEORY.md, A shaft that bends).

The pivots and their supports know only the base, v and θ of the straight shaft: their events are those of a rigid one.
"""

from rockbatch.core.flexure.displacements import Displacements, displacements_at_end, no_greater_inside
from rockbatch.core.flexure.ending import hanging
from rockbatch.core.flexure.model import Shaft
from rockbatch.core.flexure.modes import deflection_rates, deflections, dot, scaled
from rockbatch.core.flexure.shaft import Accelerations, accelerations_over, velocity_of_centre
from rockbatch.core.kernel import hook, inlined
from rockbatch.core.springs.equations import accelerations_of, geometry, rates_of, touching, with_forces, without
from rockbatch.core.springs.model import BentState, State
from rockbatch.core.springs.passing import correct_reversals, leave_reversals, nothing_new_of_shaft, take_in_end
from rockbatch.core.springs.recovery import acceleration_of_top, forces
from rockbatch.core.springs.transitions import mirrored
from rockbatch.core.table import along, get, put
from rockbatch.core.trigonometry import sine_and_cosine
from rockbatch.core.types import LEFT


@inlined
def bent_state(y, u, u_rate):
    """Return the state ``y`` of a straight shaft with the coordinates ``u`` of its modes and their rates; likewise its rates."""
    return BentState(
        y.v,
        y.theta,
        y.v_rate,
        y.omega,
        y.z_left,
        y.z_right,
        u.first,
        u.second,
        u.third,
        u.fourth,
        u_rate.first,
        u_rate.second,
        u_rate.third,
        u_rate.fourth,
    )


@inlined
def _accelerations(m, y, contact, at, ground):
    """Return the Accelerations without a grazing contact."""
    side = contact.right - contact.left
    force_left, force_right = forces(m, y, contact, at)
    moment = -force_left * at.moment_left - force_right * at.moment_right
    weight = m.gravity + ground.vertical
    up, moment = with_forces(m.pull, -weight - force_left - force_right, moment)
    lever, slope = at.lever + side * at.swing, at.lever_slope + side * at.swing_slope
    return accelerations_over(m, y, lever, slope, up, moment, ground)


@inlined
def _away(m, y, side, at, k):
    """Return the acceleration [m/s²] by which the pivot on ``side`` leaves the top of its support."""
    arm, bend, z = (at.arm_left, at.bend_left, y.z_left) if side == LEFT else (at.arm_right, at.bend_right, y.z_right)
    return k.v + arm * k.theta + bend * y.omega * y.omega - acceleration_of_top(m, z)


@inlined
def accelerations(m, y, contact, at, ground):
    """Return the Accelerations; of a grazing pivot those, between contact and none, by which it stays at its support."""
    side = contact.held
    if side == 0.0:
        return _accelerations(m, y, contact, at, ground)
    off = _accelerations(m, y, without(contact, side), at, ground)
    on = _accelerations(m, y, touching(contact, side, 0.0), at, ground)
    away, pressed = _away(m, y, side, at, off), _away(m, y, side, at, on)
    share = min(max(away / (away - pressed), 0.0), 1.0) if away != pressed else 0.0
    u = along(off.u, along(on.u, off.u, -1.0), share)
    return Accelerations(off.v + share * (on.v - off.v), off.theta + share * (on.theta - off.theta), u)


@accelerations_of.of(Shaft)
def _accelerations_of_base(shaft, m, y, contact, at, ground):
    k = accelerations(m, y, contact, at, ground)
    return k.v, k.theta


@rates_of.of(Shaft)
def _rates(shaft, m, y, contact, ground, z_rates):
    k = accelerations(m, y, contact, geometry(m, y.theta), ground)
    return bent_state(State(y.v_rate, y.omega, k.v, k.theta, z_rates[0], z_rates[1]), deflection_rates(y), k.u)


@inlined
def momenta(m, y, lever):
    """Return the momenta of v, θ and the modes, over the mass; ``lever`` is H [m]."""
    sine, cosine = sine_and_cosine(y.theta)
    u, u_rate, shaft = deflections(y), deflection_rates(y), m.shaft
    to_right, up = velocity_of_centre(m, y, lever)
    turning = lever * to_right + (m.inertia + dot(u, u)) * y.omega + dot(shaft.lever, u_rate)
    turning -= dot(shaft.share, u) * (sine * lever * y.omega + cosine * y.v_rate)
    across = cosine * lever * y.omega - sine * y.v_rate
    return up, turning, along(along(u_rate, shaft.share, across), shaft.lever, y.omega)


@mirrored.of(BentState)
def _mirrored(y):
    straight = State(y.v, -y.theta, y.v_rate, -y.omega, y.z_right, y.z_left)
    return bent_state(straight, scaled(deflections(y), -1.0), scaled(deflection_rates(y), -1.0))


@correct_reversals.of(Shaft)
def _repeat_reversals(shaft, traits, lanes, count):
    leave_reversals(lanes, count)


@nothing_new_of_shaft.of(Shaft)
def _nothing_new_of_shaft(shaft, lanes, i, y, end, h):
    return no_greater_inside(shaft, y, end, h, get(lanes.displaced, i, Displacements))


@take_in_end.of(Shaft)
def _take_in_end(shaft, lanes, i, end, calm):
    put(lanes.displaced, i, displacements_at_end(shaft, end, calm, get(lanes.displaced, i, Displacements)))


@hook
def at_start(shaft, m, y):
    """Return the state at the start of a run from that of a straight shaft, ``y``: bent by the weight of a leaning pier."""


@at_start.of(type(None))
def _straight_at_start(shaft, m, y):
    return y


@at_start.of(Shaft)
def _bent_at_start(shaft, m, y):
    u = hanging(shaft, m.gravity * sine_and_cosine(y.theta)[0])
    return bent_state(y, u, scaled(u, 0.0))
