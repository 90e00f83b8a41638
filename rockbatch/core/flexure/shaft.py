"""A shaft that bends on ground that gives, springs or a bed: its equations, by Lagrange, and its part of lanes.

v and θ are those of the base, of a straight shaft, and the ground knows no other (THEORY.md, A shaft that bends). ``m`` is a pier
with a ``shaft``, None if it is rigid.
"""

from typing import NamedTuple

from rockbatch.core.flexure.displacements import Displacements, displacements_in, displacements_within
from rockbatch.core.flexure.ending import bending_energy
from rockbatch.core.flexure.equations import straightening
from rockbatch.core.flexure.model import Shaft, ShaftNumbers, shaft_in
from rockbatch.core.flexure.modes import PerMode, deflection_rates, deflections, dot
from rockbatch.core.kernel import hook, inlined, optional_hook
from rockbatch.core.table import along, get, put, taken
from rockbatch.core.trigonometry import sine_and_cosine


class Accelerations(NamedTuple):
    """Accelerations of a pier whose shaft bends."""

    v: float  # [m/s²]
    theta: float  # [rad/s²]
    u: PerMode  # [m/s²]


@inlined
def accelerations_over(m, y, lever, slope, up, moment, ground):
    """Return the Accelerations of a pier by E6 to E8 (THEORY.md, A shaft that bends).

    ``up`` [m/s²] is the force of the ground and of devices less the weight, ``moment`` [m²/s²] theirs about the centre of mass
    of a straight shaft, to the right; ``lever`` is H [m], and ``slope`` dH/dθ [m].
    """
    shaft, squared = m.shaft, y.omega * y.omega
    sine, cosine = sine_and_cosine(y.theta)
    across = slope * squared + ground.horizontal
    weight = m.gravity + ground.vertical
    u, u_rate = deflections(y), deflection_rates(y)
    moved, speed = dot(shaft.share, u), dot(shaft.share, u_rate)
    bending = along(along(straightening(shaft, y), u, squared), shaft.share, sine * weight - cosine * across)
    coupling = along(shaft.lever, shaft.share, cosine * lever)
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
def velocity_of_centre(m, y, lever):
    """Return the velocity of the centre of mass over the ground [m/s], to the right and upwards; ``lever`` is H [m]."""
    sine, cosine = sine_and_cosine(y.theta)
    moved, speed = dot(m.shaft.share, deflections(y)), dot(m.shaft.share, deflection_rates(y))
    return (lever - moved * sine) * y.omega + speed * cosine, y.v_rate - speed * sine - moved * cosine * y.omega


@hook
def power_of_ground(shaft, m, y, lever, ground):
    """Return the power of the ground's inertia forces [W/kg]; the centre of a straight shaft moves at ``lever`` [m] θ̇."""


@power_of_ground.of(type(None))
def _on_rigid_pier(shaft, m, y, lever, ground):
    return -ground.horizontal * lever * y.omega - ground.vertical * y.v_rate


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


@optional_hook
def energies_of_modes(shaft, m, y, lever):
    """Return what the modes of the shaft add to the kinetic, potential and elastic energy [J/kg]; zeros for a rigid one.

    ``lever`` is H [m].
    """
    return 0.0, 0.0, 0.0


@energies_of_modes.of(Shaft)
def _of_bending(shaft, m, y, lever):
    lowered = m.gravity * dot(shaft.share, deflections(y)) * sine_and_cosine(y.theta)[0]
    return kinetic_of_modes(m, y, lever), -lowered, bending_energy(shaft, deflections(y))


@optional_hook
def overhang(shaft, m):
    """Return how far the centre of mass hangs over the axis of a leaning pier at rest, over sin θ [m]: g Σ μ²/ω²; 0 if rigid."""
    return 0.0


@overhang.of(Shaft)
def _overhang(shaft, m):
    ratio = PerMode(
        shaft.share.first / shaft.frequency.first,
        shaft.share.second / shaft.frequency.second,
        shaft.share.third / shaft.frequency.third,
        shaft.share.fourth / shaft.frequency.fourth,
    )
    return m.gravity * dot(ratio, ratio)


@inlined
def leaning_height(m):
    """Return the height h [m] for which the weight's moment is at most M g h sin θ: the centre's, or more if the shaft bends."""
    return m.height + overhang(m.shaft, m)


@optional_hook
def begin_shaft(shaft, lanes, i, run):
    """Put the modes of the shaft of a ``run`` into lane ``i``; nothing if it is rigid."""


@begin_shaft.of(Shaft)
def _begin_shaft(shaft, lanes, i, run):
    put(lanes.shaft, i, taken(run, ShaftNumbers))


@optional_hook
def begin_displacements(shaft, lanes, i, y):
    """Set the greatest displacements of lane ``i`` to those in state ``y``; nothing if its shaft is rigid."""


@begin_displacements.of(Shaft)
def _begin_displacements(shaft, lanes, i, y):
    put(lanes.displaced, i, displacements_in(shaft_in(shaft, lanes, i), y))


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
