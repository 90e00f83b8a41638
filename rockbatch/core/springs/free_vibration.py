"""Bounds on free vibration: the greatest rotation that a pier's energy allows, and whether it may overturn.

The ground is at rest. Energy is conserved between impacts, and lost at impacts and by yielding, so the present energy
bounds every later rotation (THEORY.md, When a run is over); impacts by Housner's e may add a little. Energies are per unit
mass [J/kg]. ``load`` is the load of the supports at rest [m/s²]: g and the tendons' forces, which have no P–Δ moment.
"""

import math
from typing import NamedTuple

from rockbatch.core.flexure.shaft import energies_of_modes, leaning_height
from rockbatch.core.kernel import kernel
from rockbatch.core.springs.backbone import give_at, greatest
from rockbatch.core.springs.equations import geometry
from rockbatch.core.springs.laws import give, limited
from rockbatch.core.springs.model import HOUSNER

PARTS = 24
"""Intervals up to the supports' capacity over which their work is summed."""

GAINED = 0.1
"""Mean gain of energy of landings by Housner's e over the greatest possible one (measured: at most 0.06)."""

SEEN = 1e-6
"""Relative amount by which the extremes of a sampled vibration may lie below its amplitude."""


@kernel
def _capacity(m, load):
    """Return the supports' greatest moment about the base's centre over load · b; below 1 if one cannot carry all."""
    return min(1.0, 2.0 * m.yield_force * greatest(m.backbone) / load - 1.0) if limited(m.law) != 0.0 else 1.0


@kernel
def unstable_equilibrium(m, load):
    """Return the unstable equilibrium: the rotation [rad] at which the weight's moment equals the greatest of the supports."""
    tangent = _capacity(m, load) * (load / m.gravity) * m.half_width / leaning_height(m)
    return math.atan(tangent) if m.finite is not None else tangent


@kernel
def rocking_stiffness(m):
    """Return the restoring moment per rotation in full contact on elastic springs, less that of the weight [m²/s²]."""
    return 2.0 * m.yield_force * m.stiffness * m.half_width * m.half_width - m.gravity * leaning_height(m)


@kernel
def rocking_period(m):
    """Return the period of rocking in full contact [s]: 2π/ω_r (THEORY.md, eq. 12)."""
    return 2.0 * math.pi * math.sqrt((m.inertia + m.height * m.height) / rocking_stiffness(m))


@kernel
def _travel(m, theta):
    """Return the travel of a support over b: sin θ, or θ in first-order kinematics."""
    return math.sin(theta) if m.finite is not None else theta


@kernel
def _weight_moment(m, travel):
    """Return the weight's moment about the centre of the base over g cos θ [m]: h tan θ, or h θ in first-order kinematics.

    ``travel`` is that of :func:`_travel`.
    """
    return leaning_height(m) * (travel / math.sqrt(1.0 - travel * travel) if m.finite is not None else travel)


@kernel
def _climb(m, lean, target, load, point):
    """Return the least energy to turn from rest at ``lean`` to ``target`` [rad], or to the unstable equilibrium.

    The pier turns towards the support on the right, which is loaded by x, the supports' moment over load · b; the other one
    is unloaded elastically. A Bouc–Wen spring has 1/(1 − zⁿ) of the elastic deflection rate, a hardening one beyond its yield
    ``point``. At the capacity the moment is constant and the pier turns about its far support. For the other direction
    reverse both angles. −inf if ``lean`` is at ``target`` or beyond.
    """
    if lean >= target:
        return -math.inf
    b, weight, height = m.half_width, m.gravity / load, leaning_height(m)
    static_force = 0.5 * load / m.yield_force
    deflection = static_force * m.yield_deflection
    capacity = _capacity(m, load)
    travel, goal, work = _travel(m, lean), _travel(m, target), 0.0
    x = weight * _weight_moment(m, travel) / b
    dx = (capacity - x) / PARTS
    for i in range(PARTS):
        middle = x + (i + 0.5) * dx
        at = x + (i + give_at(m.backbone)) * dx
        turn = 0.5 * deflection * dx * (1.0 + give(m, static_force * (1.0 + at), point)) / b
        part = min(turn, goal - travel)
        middle = x + (i + 0.5 * part / turn) * dx
        moment = load * (b * middle - weight * _weight_moment(m, travel + 0.5 * part))
        if moment <= 0.0:
            return work
        work += moment * part
        travel += part
        if part < turn:
            return work
    theta = math.asin(travel) if m.finite is not None else travel
    end = min(target, unstable_equilibrium(m, load))
    if end <= theta:
        return work
    if m.finite is not None:
        return work + load * (
            capacity * b * (math.sin(end) - math.sin(theta)) + weight * height * (math.cos(end) - math.cos(theta))
        )
    return work + load * (capacity * b * (end - theta) - 0.5 * weight * height * (end * end - theta * theta))


@kernel
def _returned(m, theta):
    """Return the relative gain of energy that is possible up to ``theta`` [rad]: 2 b h θ/(I0/M + h² + b²).

    First-order P–Δ moments have no potential: the work of the vertical inertia v̈ on the arm h θ integrates to v̇ h θ θ̇,
    where v̇ ≤ b θ̇. In finite kinematics H jumps by as much with a contact.
    """
    b, h = m.half_width, m.height
    return 2.0 * b * h * theta / (m.inertia + h * h + b * b)


@kernel
def growth(m, seconds):
    """Return the factor by which impacts may raise the energy within ``seconds``: 1 unless by Housner's e.

    Each such landing adds at most (1 − e)/(1 + e) · b²/(I0/M + h²) of the kinetic energy (THEORY.md, eq. 11b), and a share
    ``GAINED`` of them does: both pivots land once in each period of the vertical vibration.
    """
    if m.impact != HOUSNER:
        return 1.0
    omega_v = math.sqrt(2.0 * m.yield_force * m.stiffness)
    most = (1.0 - m.restitution) / (1.0 + m.restitution) * m.half_width**2 / (m.inertia + m.height**2)
    return (1.0 + most) ** (GAINED * seconds * omega_v / math.pi)


class Drift(NamedTuple):
    """Greatest further tilt of the base that is foreseen, as yielding springs settle with each cycle of vibration."""

    right: float  # rotation of a pier on it to the right [rad]
    left: float
    growth: float  # relative growth of its lean


@kernel
def further(m, right, left, sinking):
    """Return the Drift of a base that will tilt by ``right`` or ``left`` [rad] and sink by ``sinking`` [m].

    A Bouc–Wen support under 1 + h θ/b times its load sinks (1 + h θ/b)ⁿ times as fast: the lean grows exponentially, by the
    factor exp(n h amplification · sinking/b²) while both sink by ``sinking`` on average.
    """
    amplification = _amplification(m)
    right, left = max(right * amplification, 0.0), max(left * amplification, 0.0)
    if m.creep == 0.0:
        return Drift(right, left, 0.0)
    grows = m.creep * leaning_height(m) * amplification * sinking / (m.half_width * m.half_width)
    if grows <= 1e-6:
        return Drift(right, left, 0.0)
    growth = math.expm1(min(grows, 50.0))
    return Drift(right * growth / grows, left * growth / grows, growth)


@kernel
def _amplification(m):
    """Return the rotation of a pier at rest over the tilt of its base, above 1 by its P–Δ moment."""
    stiffness = rocking_stiffness(m)
    return (stiffness + m.gravity * leaning_height(m)) / stiffness


@kernel
def lean_on(m, base):
    """Return the rotation [rad] at which a pier rests on both springs; 0 if they have settled alike.

    It is that of its ``base``, Supports with the unstressed positions of both, also in contact [m], to the right if the right one
    is the lower, times what the weight adds as it leans (P–Δ). Rotations are small: it may exceed the unstable equilibrium.
    """
    return 0.5 * (base.left - base.right) / m.half_width * _amplification(m)


class Load(NamedTuple):
    """Load of the supports at rest [m/s²], energy of devices beyond its work [J/kg], and :func:`growth` by impacts."""

    weight: float
    stored: float
    growth: float = 1.0


@kernel
def peak_is_final(m, now, carried, peak, calm, drift):
    """Return True if nothing after the Moment ``now`` can exceed the peak or overturn the pier.

    Parameters
    ----------
    now : Moment
        Its supports have the unstressed positions of both [m], also in contact, and their yield points.
    carried : Load
    peak : float
        Greatest |θ| so far [rad].
    calm : bool
        Both pivots have been in contact, and the ground at rest, for a period of rocking: rocking and vertical vibration are
        then coupled by the P–Δ moment only.
    drift : Drift
    """
    y, contact, base = now
    load, lean = carried.weight, lean_on(m, base)
    drift_right = drift.right + max(lean, 0.0) * drift.growth
    drift_left = drift.left + max(-lean, 0.0) * drift.growth
    if max(lean + drift_right, drift_left - lean) > peak * (
        1.0 + SEEN
    ):  # first, since most runs that go on wait for this
        return False
    unstable = unstable_equilibrium(m, load)
    if max(abs(lean), abs(y.theta)) >= unstable:
        return False
    b, h, g, limit = m.half_width, leaning_height(m), m.gravity, min(peak, unstable)
    stiffness = rocking_stiffness(m)
    softness = 0.5 * load / (m.yield_force * m.stiffness)  # static deflection
    middle = 0.5 * (base.left + base.right)
    if calm:
        mean = middle - softness  # of v
        if m.finite is not None:
            mean -= _drop(h, y.theta)
        swing = math.sqrt((y.v - mean) * (y.v - mean) + y.v_rate * y.v_rate * softness / load)  # vertical
        swing /= softness  # of the load
        softened = stiffness - load * h * swing
        if softened <= 0.0:
            return False
        rocking = (m.inertia + h * h) * y.omega * y.omega + stiffness * (y.theta - lean) * (y.theta - lean)
        reach = math.sqrt(rocking / softened)
        sway = lean * (stiffness / softened)  # the lean swells with the weight
        if m.finite is not None:  # to second order, sin² θ stores less than θ²
            reach *= 1.0 + _amplification(m) * limit * limit / 6.0
        furthest = max(max(sway, lean) + drift_right, max(-sway, -lean) + drift_left) + reach
        return furthest <= limit * (1.0 + SEEN)
    at = geometry(m, y.theta)
    uneven = g / load * h * lean / b
    lever, gained, at_lean = h, -0.5 * g * h * y.theta * y.theta, -0.5 * g * h * lean * lean
    if m.finite is not None:
        lever = at.lever + (contact.right - contact.left) * at.swing
        gained, at_lean = (load - g) * _drop(m.height, y.theta), -g * _drop(h, lean)
    kinetic = 0.5 * y.v_rate * y.v_rate + 0.5 * (m.inertia + lever * lever) * y.omega * y.omega
    by_motion, by_height, by_bending = energies_of_modes(m.shaft, m, y, lever)
    kinetic += by_motion + by_bending + by_height
    spring = m.yield_force * m.yield_deflection
    stored = load * y.v + gained + 0.5 * spring * (y.z_left * y.z_left + y.z_right * y.z_right) + carried.stored
    at_lean += load * (middle - softness) + 0.5 * load * softness * (1.0 + uneven * uneven)
    energy = carried.growth * (1.0 + _returned(m, limit)) * (kinetic + stored - at_lean)
    to_right = _climb(m, lean, limit - drift_right, load, base.yield_right)
    least = min(to_right, _climb(m, -lean, limit - drift_left, load, base.yield_left))
    return energy <= least + 1e-12 * load * softness


@kernel
def _drop(h, theta):
    """Return h (1 − cos θ) [m]."""
    half = math.sin(0.5 * theta)
    return 2.0 * h * half * half
