"""Start of a run: a pier stands in its static state, or is held at a rotation and let go (THEORY.md, Release from a rotation).

A laboratory pulls the pier there slowly, by a horizontal force, and holds it. So the vertical forces balance, springs and dampers
have been loaded once, and those that yield are on the curve of their first loading.
"""

import math
from collections.abc import Callable
from functools import lru_cache

import numpy as np

from rockbatch.core.devices.laws import CONTACT, FRICTION, HYSTERETIC, SPRING, TENDON, Element
from rockbatch.pier import Base, ElasticBase, FootingBase, Pier, YieldingBase
from rockbatch.simulation.models import Start, elements, prestress, springs

_STANDING = Start()

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(16)

_STRAIGHT = 50.0
"""w beyond which a Bouc–Wen spring yields by 1/n for each unit of w, to rounding."""

_DAMPER_EXPONENT = 5.0

Curve = Callable[[float], tuple[float, float]]
"""Deflection over δ_y and force over F_y on first loading, by a parameter that grows from 0 with both."""


@lru_cache(maxsize=4096)
def start_of(pier: Pier, base: Base) -> Start:
    """Return the state in which a run begins."""
    theta = pier.initial_rotation_rad
    if theta == 0.0:
        return _STANDING
    if isinstance(base, FootingBase):
        return Start(theta=theta)  # the core finds its level
    if base.on_springs:
        return _on_springs(pier, base)
    states = []
    for law in elements(pier, base):  # about a corner: the chord of the device's way
        distance = pier.half_width - math.copysign(law.offset, theta * law.offset)
        chord = 2.0 * distance * math.sin(0.5 * abs(theta))
        states.append(_force_and_state(law, chord if law.height == 0.0 else _on_deck(law, theta, True))[1])
    return Start(theta=theta, states=tuple(states), level=0.0)


def _on_springs(pier: Pier, base: ElasticBase) -> Start:
    """Return the vertical equilibrium of a pier on springs at its initial rotation: one equation for the pressed spring."""
    m, theta, laws = springs(pier, base), pier.initial_rotation_rad, elements(pier, base)
    curve, delta, side = _curve(base), m.yield_deflection, math.copysign(1.0, theta)
    static = 0.5 * (m.gravity + prestress(pier, base)) / m.yield_force
    level = -delta * _solved(curve, 1, static)[0]
    tilt, drop, by_v = abs(theta), 0.0, 1.0
    if m.finite is not None:
        tilt, drop = math.sin(abs(theta)), m.height * (1.0 - math.cos(theta))
        by_v = 1.0 / math.cos(0.5 * theta)
    rise = m.half_width * tilt

    def state(parameter: float) -> tuple[float, float, float]:
        """Return v [m], and the forces over F_y of the pressed and of the lifted spring."""
        deflection, pressed = curve(parameter)
        v = -delta * deflection + rise - drop
        return v, pressed, max(static - (v + rise + drop - level) / delta, 0.0)

    def devices(v: float) -> list[tuple[float, float]]:
        up = v - level + drop
        return [
            _force_and_state(law, _on_deck(law, theta, m.finite is not None))
            if law.height != 0.0
            else _force_and_state(law, by_v * (up - side * tilt * law.offset))
            for law in laws
        ]

    def excess(parameter: float) -> float:
        v, pressed, lifted = state(parameter)
        pull = by_v * sum(force for (force, _), law in zip(devices(v), laws, strict=True) if law.height == 0.0)
        return m.yield_force * (pressed + lifted) - m.gravity - pull

    v, pressed, lifted = state(_root(excess))
    z_left, z_right = (-lifted, -pressed) if side > 0.0 else (-pressed, -lifted)
    states = tuple(device_state for _, device_state in devices(v))
    return Start(v, theta, z_left + 0.0, z_right + 0.0, states, level, level + delta * static)


def _force_and_state(law: Element, elongation: float) -> tuple[float, float]:
    """Return force [m/s²] and state of a device that was drawn out slowly from rest to this ``elongation`` [m]."""
    if law.kind == TENDON:
        pull = law.prestress + law.stiffness * elongation
        plastic = (pull - law.strength) / law.stiffness if pull > law.strength else 0.0
        return min(max(pull, 0.0), law.strength), plastic
    if law.kind == FRICTION:
        return math.copysign(law.strength, elongation) if elongation else 0.0, 0.0
    if law.kind == HYSTERETIC:
        z = math.copysign(_solved(_braced(law.give), 0, abs(elongation) * law.stiffness)[1], elongation)
        return law.strength * z, z
    if law.kind == CONTACT:
        return max(law.stiffness * (elongation - law.start), 0.0), 0.0
    return law.stiffness * elongation if law.kind == SPRING else 0.0, 0.0  # viscous


def _braced(give: float) -> Curve:
    """Return the curve of a hysteretic damper with its brace, which gives by ``give`` times its yield deflection at its force."""
    steel = _bouc_wen(_DAMPER_EXPONENT)

    def curve(w: float) -> tuple[float, float]:
        deflection, z = steel(w)
        return deflection + give * z, z

    return curve


def _on_deck(law: Element, theta: float, finite: bool) -> float:
    """Return the elongation of a device at the deck [m]."""
    if not finite:
        return law.way * law.height * theta
    swing = math.copysign(law.swing, theta)
    return law.way * (law.height * math.sin(theta) + swing * (1.0 - math.cos(theta)))


def _curve(base: ElasticBase) -> Curve:
    """Return the curve of first loading of the springs of ``base``."""
    if not isinstance(base, YieldingBase):
        return lambda deflection: (deflection, deflection)
    if base.has_exponent:
        return _bouc_wen(base.n)
    return lambda deflection: (deflection, min(deflection, 1.0))


def _bouc_wen(n: float) -> Curve:
    """Return the curve of a Bouc–Wen spring: ∫ dz/(1 − zⁿ) over z = 1 − e⁻ʷ is ∫ e⁻ʷ/(1 − zⁿ) dw, whose integrand is smooth."""

    def curve(w: float) -> tuple[float, float]:
        curved = min(w, _STRAIGHT)
        parts = max(1, math.ceil(curved / 0.5))
        half = 0.5 * curved / parts
        points = half * (2.0 * np.arange(parts)[:, None] + 1.0 + _NODES)
        deficit = np.exp(-points)  # 1 − z
        stiffness = -np.expm1(n * np.log1p(-deficit)) if w > 0.0 else np.ones_like(points)  # 1 − zⁿ
        return float(half * (deficit / stiffness @ _WEIGHTS).sum()) + (w - curved) / n, -math.expm1(-w)

    return curve


def _solved(curve: Curve, which: int, value: float) -> tuple[float, float]:
    """Return the point of a curve whose deflection (``which`` = 0) or force (1) is ``value``."""
    return curve(_root(lambda parameter: curve(parameter)[which] - value))


def _root(rising: Callable[[float], float]) -> float:
    """Return the parameter above 0 at which a rising function becomes 0: doubled until it is above, then between."""
    from scipy.optimize import brentq

    low, high = 0.0, 1.0
    while rising(high) < 0.0:
        low, high = high, 2.0 * high
    return float(brentq(rising, low, high, xtol=1e-300, rtol=1e-15)) if rising(low) < 0.0 else low
