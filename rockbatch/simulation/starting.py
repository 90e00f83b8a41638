"""Initial state of a run: at rest, or held at a rotation and released (THEORY.md, Release from a rotation).

A laboratory pulls the pier there slowly by a horizontal force and holds it. So the vertical forces balance, springs and dampers
have been loaded once, and those that yield are on their curve of first loading.
"""

import math
from collections.abc import Callable
from functools import lru_cache

import numpy as np

from rockbatch.core.devices.laws import CONTACT, FRICTION, HYSTERETIC, SPRING, TENDON, Element
from rockbatch.pier import Base, ElasticBase, FootingBase, Pier
from rockbatch.pier.first_loading import steel
from rockbatch.simulation.elements import elements, prestress
from rockbatch.simulation.models import Start, springs

_STANDING = Start()


@lru_cache(maxsize=4096)
def start_of(pier: Pier, base: Base) -> Start:
    """Return the initial state of a run: all 0 without an initial rotation, and on a footing but for ``theta``, ``level`` NaN."""
    theta = pier.initial_rotation_rad
    if theta == 0.0:
        return _STANDING
    if isinstance(base, FootingBase):
        return Start(theta=theta)  # the core finds its level
    if base.on_springs:
        return _on_springs(pier, base)
    states = []
    for law in elements(pier, base):  # rotation about a corner: the elongation is the chord of the arc
        distance = pier.half_width - math.copysign(law.offset, theta * law.offset)
        chord = 2.0 * distance * math.sin(0.5 * abs(theta))
        states.append(_force_and_state(law, chord if law.height == 0.0 else _deck_elongation(law, theta, True))[1])
    return Start(theta=theta, states=tuple(states), level=0.0)


def unstressed_at_rest(pier: Pier, base: ElasticBase) -> float:
    """Return the position at which the supports are unstressed when the pier stands at rest, before any pull [m]."""
    m = springs(pier, base)
    return m.level + m.yield_deflection * _static(pier, base)


def _static(pier: Pier, base: ElasticBase) -> float:
    """Return the force of each spring at rest over F_y."""
    m = springs(pier, base)
    return 0.5 * (m.gravity + prestress(pier, base)) / m.yield_force


def _on_springs(pier: Pier, base: ElasticBase) -> Start:
    """Return the state of a pier held on springs at its initial rotation, where vertical forces balance."""
    m, theta, laws = springs(pier, base), pier.initial_rotation_rad, elements(pier, base)
    curve, delta, side = base.first_loading, m.yield_deflection, math.copysign(1.0, theta)
    static = _static(pier, base)
    level = m.level
    tilt, drop, by_v = abs(theta), 0.0, 1.0
    if m.finite is not None:
        tilt, drop = math.sin(abs(theta)), m.height * (1.0 - math.cos(theta))
        by_v = 1.0 / math.cos(0.5 * theta)
    rise = m.half_width * tilt

    def state(deflection: float) -> tuple[float, float, float]:
        """Return v [m], and force/F_y of the spring pressed to ``deflection``/δ_y and of the other one."""
        v = -delta * deflection + rise - drop
        return v, float(curve.force(np.array([deflection]))[0]), max(static - (v + rise + drop - level) / delta, 0.0)

    def elongation(law: Element, v: float) -> float:
        if law.height != 0.0:
            return _deck_elongation(law, theta, m.finite is not None)
        return by_v * (v - level + drop - side * tilt * law.offset)

    def devices(v: float) -> list[tuple[float, float]]:
        """Return force [m/s²] and state of each device with the centre of mass at v [m]."""
        return [_force_and_state(law, elongation(law, v)) for law in laws]

    def excess(deflection: float) -> float:
        """Return the upward force less weight and tensions [m/s²]: it rises with the deflection."""
        v, pressed, lifted = state(deflection)
        pull = by_v * sum(force for (force, _), law in zip(devices(v), laws, strict=True) if law.height == 0.0)
        return m.yield_force * (pressed + lifted) - m.gravity - pull

    v, pressed, lifted = state(_nonnegative_root(excess))
    z_left, z_right = (-lifted, -pressed) if side > 0.0 else (-pressed, -lifted)
    states = tuple(device_state for _, device_state in devices(v))
    return Start(v, theta, z_left + 0.0, z_right + 0.0, states, level, unstressed_at_rest(pier, base))


def _force_and_state(law: Element, elongation: float) -> tuple[float, float]:
    """Return force [m/s²] and state of a device after slow loading from rest to ``elongation`` [m]; 0 and 0 if viscous."""
    if law.kind == TENDON:
        pull = law.prestress + law.stiffness * elongation
        plastic = (pull - law.strength) / law.stiffness if pull > law.strength else 0.0
        return min(max(pull, 0.0), law.strength), plastic
    if law.kind == FRICTION:
        return math.copysign(law.strength, elongation) if elongation else 0.0, 0.0
    if law.kind == HYSTERETIC:
        z = math.copysign(float(steel(law.give).force(np.array([abs(elongation) * law.stiffness]))[0]), elongation)
        return law.strength * z, z
    if law.kind == CONTACT:
        return max(law.stiffness * (elongation - law.start), 0.0), 0.0
    return law.stiffness * elongation if law.kind == SPRING else 0.0, 0.0  # viscous


def _deck_elongation(law: Element, theta: float, finite: bool) -> float:
    """Return the elongation of a device at the deck [m]."""
    if not finite:
        return law.way * law.height * theta
    swing = math.copysign(law.swing, theta)
    return law.way * (law.height * math.sin(theta) + swing * (1.0 - math.cos(theta)))


def _nonnegative_root(rising: Callable[[float], float]) -> float:
    """Return x ≥ 0 at which a rising function is 0, or 0 if it is not negative there; never returns if it stays negative."""
    from scipy.optimize import brentq

    low, high = 0.0, 1.0
    while rising(high) < 0.0:
        low, high = high, 2.0 * high
    return float(brentq(rising, low, high, xtol=1e-300, rtol=1e-15)) if rising(low) < 0.0 else low
