"""Bounds on free vibration: how far a pier's energy carries it, and whether beyond the unstable equilibrium.

The ground is at rest. Between impacts energy is kept, at impacts and by yielding it is lost, so the energy of this
moment bounds every later rotation (THEORY.md, When a run is over); impacts by Housner's e may add a little. Energies
are per unit mass [J/kg]. ``load`` is what the supports carry at rest [m/s²]: g, and what tendons add to it without an
arm h θ of their own.
"""

import math
from typing import NamedTuple

from rockbatch.core.kernel import kernel
from rockbatch.core.springs.equations import geometry
from rockbatch.core.springs.laws import give, limited
from rockbatch.core.springs.model import HOUSNER

PARTS = 24
"""Parts of the way to the supports' capacity over which their work is summed."""

GAINED = 0.1
"""Share of the most that a landing by Housner's e can add to the energy, which landings have added on average (measured: 0.06
at most)."""

SEEN = 1e-6
"""Relative error of an extreme that has been seen, by which it may lie below the amplitude of its vibration."""


@kernel
def _capacity(m, load):
    """Return the supports' greatest moment about the base's centre, over load · b: one carries all, or what it can."""
    return min(1.0, 2.0 * m.yield_force / load - 1.0) if limited(m.law) != 0.0 else 1.0


@kernel
def unstable_equilibrium(m, load):
    """Return the unstable equilibrium: the rotation [rad] at which the weight's moment equals the greatest of the supports."""
    tangent = _capacity(m, load) * (load / m.gravity) * m.half_width / m.height
    return math.atan(tangent) if m.finite is not None else tangent


@kernel
def rocking_stiffness(m):
    """Return the restoring moment per rotation in full contact, on elastic springs [m²/s²]."""
    return 2.0 * m.yield_force * m.stiffness * m.half_width * m.half_width - m.gravity * m.height


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
    """Return the moment of the weight about the centre of the base over g, per b cos θ of the supports' arm [m]."""
    return m.height * (travel / math.sqrt(1.0 - travel * travel) if m.finite is not None else travel)


@kernel
def _climb(m, lean, target, load, point):
    """Return the energy that it takes at least to turn from rest at ``lean`` to ``target`` [rad], or to the unstable equilibrium.

    The pier turns towards the support on the right, which is loaded by x, the supports' moment over load · b; the other one
    is unloaded, elastic. A Bouc–Wen spring takes 1/(1 − zⁿ) of the elastic deflection, a hardening one beyond its yield
    ``point``. From the capacity on, the moment stays and the pier turns about its far support. For the other direction
    reverse both angles. A pier that leans beyond ``target`` is there already: −inf.
    """
    if lean >= target:
        return -math.inf
    b, weight = m.half_width, m.gravity / load
    static_force = 0.5 * load / m.yield_force
    deflection = static_force * m.yield_deflection
    capacity = _capacity(m, load)
    travel, goal, work = _travel(m, lean), _travel(m, target), 0.0
    x = weight * _weight_moment(m, travel) / b
    dx = (capacity - x) / PARTS
    for i in range(PARTS):
        middle = x + (i + 0.5) * dx
        turn = 0.5 * deflection * dx * (1.0 + give(m, static_force * (1.0 + middle), point)) / b
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
            capacity * b * (math.sin(end) - math.sin(theta)) + weight * m.height * (math.cos(end) - math.cos(theta))
        )
    return work + load * (capacity * b * (end - theta) - 0.5 * weight * m.height * (end * end - theta * theta))


@kernel
def _returned(m, theta):
    """Return the share of the energy that may come back on the way to ``theta`` [rad]: 2 b h θ/(I0/M + h² + b²).

    First-order P–Δ moments have no potential: what the vertical inertia v̈ does with the arm h θ is no energy of the
    model. It integrates to v̇ h θ θ̇, of which v̇ ≤ b θ̇. In finite kinematics H jumps by as much with a contact.
    """
    b, h = m.half_width, m.height
    return 2.0 * b * h * theta / (m.inertia + h * h + b * b)


@kernel
def growth(m, seconds):
    """Return the factor by which impacts may raise the energy within ``seconds``: 1 but by Housner's e.

    A landing by it adds (1 − e)/(1 + e) · b²/(I0/M + h²) of the kinetic energy at most (THEORY.md, eq. 11b). As many are
    counted as both pivots can have at the frequency of the vertical vibration.
    """
    if m.impact != HOUSNER:
        return 1.0
    omega_v = math.sqrt(2.0 * m.yield_force * m.stiffness)
    most = (1.0 - m.restitution) / (1.0 + m.restitution) * m.half_width**2 / (m.inertia + m.height**2)
    return (1.0 + most) ** (GAINED * seconds * omega_v / math.pi)


class Drift(NamedTuple):
    """Greatest further tilt of the base that can be foreseen: yielding springs settle on with each cycle of vibration."""

    right: float  # amplified to the rotation of a pier on it [rad]
    left: float
    growth: float  # share of its lean by which it leans further


@kernel
def further(m, right, left, sinking):
    """Return the Drift of a base that tilts by ``right`` or ``left`` [rad] and sinks by ``sinking`` [m] if it goes on as it has.

    A Bouc–Wen support under a share 1 + h θ/b of its load sinks (1 + h θ/b)ⁿ times as fast: the lean grows by itself,
    by the factor exp(n h amplification · sinking/b²) while both sink by ``sinking`` on average.
    """
    amplification = _amplification(m)
    right, left = max(right * amplification, 0.0), max(left * amplification, 0.0)
    if m.creep == 0.0:
        return Drift(right, left, 0.0)
    grows = m.creep * m.height * amplification * sinking / (m.half_width * m.half_width)
    if grows <= 1e-6:
        return Drift(right, left, 0.0)
    growth = math.expm1(min(grows, 50.0))
    return Drift(right * growth / grows, left * growth / grows, growth)


@kernel
def _amplification(m):
    """Return the rotation of a pier at rest over the tilt of its base."""
    stiffness = rocking_stiffness(m)
    return (stiffness + m.gravity * m.height) / stiffness


@kernel
def lean_on(m, base):
    """Return the rotation [rad] at which a pier rests on its ``base``."""
    return 0.5 * (base.left - base.right) / m.half_width * _amplification(m)


class Load(NamedTuple):
    """Load of the supports at rest [m/s²], what devices may give back beyond its work [J/kg], and :func:`growth` by impacts."""

    weight: float
    stored: float
    growth: float = 1.0


@kernel
def peak_is_final(m, now, carried, peak, calm, drift):
    """Return whether nothing that comes after the Moment ``now`` can exceed the peak, nor overturn the pier.

    Parameters
    ----------
    now : Moment
        Its supports tell where both are unstressed [m], also under their pivots, and their yield points.
    carried : Load
    peak : float
        Greatest |θ| so far [rad].
    calm : bool
        Both pivots have stayed on the ground, and the ground at rest, for a period of rocking: what rocks then keeps
        apart from what vibrates vertically, but for the P–Δ moment of the latter.
    drift : Drift
    """
    y, contact, base = now
    load, lean = carried.weight, lean_on(m, base)
    drift_right = drift.right + max(lean, 0.0) * drift.growth
    drift_left = drift.left + max(-lean, 0.0) * drift.growth
    if max(lean + drift_right, drift_left - lean) > peak * (
        1.0 + SEEN
    ):  # first, for it is what most that go on wait for
        return False
    unstable = unstable_equilibrium(m, load)
    if max(abs(lean), abs(y.theta)) >= unstable:
        return False
    b, h, g, limit = m.half_width, m.height, m.gravity, min(peak, unstable)
    stiffness = rocking_stiffness(m)
    softness = 0.5 * load / (m.yield_force * m.stiffness)  # static deflection
    middle = 0.5 * (base.left + base.right)
    if calm:
        mean = middle - softness  # of v
        if m.finite is not None:
            mean -= _drop(m, y.theta)
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
        gained, at_lean = (load - g) * _drop(m, y.theta), -g * _drop(m, lean)
    kinetic = 0.5 * y.v_rate * y.v_rate + 0.5 * (m.inertia + lever * lever) * y.omega * y.omega
    spring = m.yield_force * m.yield_deflection
    stored = load * y.v + gained + 0.5 * spring * (y.z_left * y.z_left + y.z_right * y.z_right) + carried.stored
    at_lean += load * (middle - softness) + 0.5 * load * softness * (1.0 + uneven * uneven)
    energy = carried.growth * (1.0 + _returned(m, limit)) * (kinetic + stored - at_lean)
    to_right = _climb(m, lean, limit - drift_right, load, base.yield_right)
    least = min(to_right, _climb(m, -lean, limit - drift_left, load, base.yield_left))
    return energy <= least + 1e-12 * load * softness


@kernel
def _drop(m, theta):
    """Return h (1 − cos θ) [m]."""
    half = math.sin(0.5 * theta)
    return 2.0 * m.height * half * half
