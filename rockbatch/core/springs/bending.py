"""A shaft that bends, on damped springs: its equations, by Lagrange, and its part of lanes (THEORY.md, A shaft that bends).

The pivots and their supports know only the base, v and θ of the straight shaft: their events are those of a rigid one.
"""

from typing import NamedTuple

from rockbatch.core.flexure.displacements import (
    Displacements,
    displacements_at_end,
    displacements_in,
    displacements_within,
    no_greater_inside,
)
from rockbatch.core.flexure.ending import bending_energy, hanging
from rockbatch.core.flexure.equations import straightening
from rockbatch.core.flexure.modes import PerMode, deflection_rates, deflections, dot, scaled
from rockbatch.core.kernel import hook, inlined, optional_hook
from rockbatch.core.springs.equations import (
    accelerations_of,
    geometry,
    power_of_ground,
    rates_of,
    touching,
    with_forces,
    without,
)
from rockbatch.core.springs.free_vibration import energy_of_modes, leaning_height
from rockbatch.core.springs.model import BentState, Shaft, ShaftNumbers, State, shaft_in, state_in
from rockbatch.core.springs.passing import correct_reversals, nothing_new_of_shaft, take_in_end
from rockbatch.core.springs.recovery import acceleration_of_top, forces
from rockbatch.core.springs.transitions import mirrored
from rockbatch.core.table import along, get, put, taken
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


class Accelerations(NamedTuple):
    """Accelerations of a pier whose shaft bends."""

    v: float  # [m/s²]
    theta: float  # [rad/s²]
    u: PerMode  # [m/s²]


@inlined
def _accelerations(m, y, contact, at, ground):
    """Return the Accelerations without a grazing contact (THEORY.md, A shaft that bends, E6 to E8)."""
    shaft, side = m.shaft, contact.right - contact.left
    sine, cosine = sine_and_cosine(y.theta)
    lever, squared = at.lever + side * at.swing, y.omega * y.omega
    across = (at.lever_slope + side * at.swing_slope) * squared + ground.horizontal
    weight = m.gravity + ground.vertical
    u, u_rate = deflections(y), deflection_rates(y)
    moved, speed = dot(shaft.share, u), dot(shaft.share, u_rate)
    bending = along(along(straightening(shaft, y), u, squared), shaft.share, sine * weight - cosine * across)
    coupling = along(shaft.lever, shaft.share, cosine * lever)
    force_left, force_right = forces(m, y, contact, at)
    moment = -force_left * at.moment_left - force_right * at.moment_right
    up, moment = with_forces(m.pull, -weight - force_left - force_right, moment)
    up += sine * dot(shaft.share, bending) + 2.0 * cosine * y.omega * speed - sine * moved * squared
    moment += lever * (2.0 * sine * y.omega * speed + cosine * moved * squared - across)
    moment += moved * (sine * across + cosine * weight) - 2.0 * dot(u, u_rate) * y.omega - dot(coupling, bending)
    of_rise, of_both = (
        1.0 - sine * sine * dot(shaft.share, shaft.share),
        sine * dot(shaft.share, coupling) - cosine * moved,
    )
    inertia = m.inertia + lever * lever + dot(u, u) - 2.0 * lever * sine * moved - dot(coupling, coupling)
    determinant = of_rise * inertia - of_both * of_both
    rises, turns = (inertia * up - of_both * moment) / determinant, (of_rise * moment - of_both * up) / determinant
    return Accelerations(rises, turns, along(along(bending, coupling, -turns), shaft.share, sine * rises))


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
def velocity_of_centre(m, y, lever):
    """Return the velocity of the centre of mass over the ground [m/s], to the right and upwards; ``lever`` is H [m]."""
    sine, cosine = sine_and_cosine(y.theta)
    moved, speed = dot(m.shaft.share, deflections(y)), dot(m.shaft.share, deflection_rates(y))
    return (lever - moved * sine) * y.omega + speed * cosine, y.v_rate - speed * sine - moved * cosine * y.omega


@power_of_ground.of(Shaft)
def _on_bending_pier(shaft, m, y, lever, ground):
    to_right, up = velocity_of_centre(m, y, lever)
    return -ground.horizontal * to_right - ground.vertical * up


@inlined
def kinetic_of_modes(m, y, lever):
    """Return the kinetic energy [J/kg] less that of a straight shaft with the same base; ``lever`` is H [m]."""
    u, u_rate = deflections(y), deflection_rates(y)
    to_right, up = velocity_of_centre(m, y, lever)
    by_centre = lever * y.omega * (to_right - lever * y.omega) + y.v_rate * (up - y.v_rate)
    spun = 0.5 * (dot(u_rate, u_rate) + dot(u, u) * y.omega * y.omega)
    return spun + by_centre + dot(m.shaft.lever, u_rate) * y.omega


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


@energy_of_modes.of(Shaft)
def _energy(shaft, m, y, lever):
    lowered = m.gravity * dot(shaft.share, deflections(y)) * sine_and_cosine(y.theta)[0]
    return kinetic_of_modes(m, y, lever) + bending_energy(shaft, deflections(y)) - lowered


@leaning_height.of(Shaft)
def _leaning_height(shaft, m):
    ratio = PerMode(
        shaft.share.first / shaft.frequency.first,
        shaft.share.second / shaft.frequency.second,
        shaft.share.third / shaft.frequency.third,
        shaft.share.fourth / shaft.frequency.fourth,
    )
    return m.height + m.gravity * dot(ratio, ratio)


@mirrored.of(BentState)
def _mirrored(y):
    straight = State(y.v, -y.theta, y.v_rate, -y.omega, y.z_right, y.z_left)
    return bent_state(straight, scaled(deflections(y), -1.0), scaled(deflection_rates(y), -1.0))


@correct_reversals.of(Shaft)
def _repeat_reversals(shaft, traits, lanes, count):
    for i in range(count):
        lanes.reversals.surely[i] = -1.0


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


@optional_hook
def begin_shaft(shaft, lanes, i, run):
    """Put the modes of the shaft of a ``run`` into lane ``i``; nothing if it is rigid."""


@begin_shaft.of(Shaft)
def _begin_shaft(shaft, lanes, i, run):
    put(lanes.shaft, i, taken(run, ShaftNumbers))


@optional_hook
def begin_displacements(shaft, lanes, i):
    """Set the greatest displacements of lane ``i`` to those at its start; nothing if its shaft is rigid."""


@begin_displacements.of(Shaft)
def _begin_displacements(shaft, lanes, i):
    put(lanes.displaced, i, displacements_in(shaft_in(shaft, lanes, i), state_in(shaft, lanes.now, i)))


@optional_hook
def include_bending(shaft, lanes, i, part):
    """Raise the greatest displacements of lane ``i`` to those of a Part; nothing if its shaft is rigid."""


@include_bending.of(Shaft)
def _include_bending(shaft, lanes, i, part):
    put(lanes.displaced, i, displacements_within(shaft, part, get(lanes.displaced, i, Displacements)))


@optional_hook
def write_displacements(shaft, lanes, i, result):
    """Write the greatest displacements of lane ``i`` into its ``result``; nothing if its shaft is rigid."""


@write_displacements.of(Shaft)
def _write_displacements(shaft, lanes, i, result):
    result.deflection_max, result.drift_max = lanes.displaced.deflection[i], lanes.displaced.drift[i]
