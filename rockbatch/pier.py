"""The pier and what it stands on: a rigid block and three kinds of base (Palmeri & Makris 2007).

Values are checked where they meet: :func:`problems` says what is impossible about a pier on a base, and the limit.
"""

import math
from dataclasses import dataclass, field
from typing import Literal

from rockbatch.errors import InputError
from rockbatch.units import GRAVITY

LEAST_ETA = 1.000001
"""Closer to 1, Bouc–Wen springs would have to sink without end to carry the weight."""

Kinematics = Literal["first-order", "finite"]
Flight = Literal["stop", "guided"]
SpringLaw = Literal["bouc-wen", "epp"]


@dataclass(frozen=True)
class Pier:
    """A rigid block that can pivot about its two lower corners.

    Attributes
    ----------
    alpha : float
        Slenderness α [rad]: the angle at a pivot between the vertical and the line to the centre of mass.
    p : float
        Frequency parameter [rad/s], p² = μ/(1+μ) g/R0 (paper, eq. 2).
    mu : float
        Shape factor μ = M R0²/I0; 3 for a rectangle.
    gravity : float
        g [m/s²].
    """

    alpha: float
    p: float
    mu: float = 3.0
    gravity: float = GRAVITY

    def __post_init__(self) -> None:
        wrong = [
            f"{name} = {value:g}: must be a number above 0{hint}"
            for name, value, hint in (
                ("alpha", self.alpha, " [rad]"),
                ("p", self.p, " [rad/s]"),
                ("mu", self.mu, " (3 for a rectangle)"),
                ("gravity", self.gravity, " [m/s²]"),
            )
            if not (math.isfinite(value) and value > 0)
        ]
        if self.alpha >= math.pi / 2:
            wrong.append(
                f"alpha = {self.alpha:g}: must be below π/2 = 1.5708 rad; "
                f"if it is in degrees, write {math.radians(self.alpha):.4g}"
            )
        if wrong:
            raise InputError(*wrong)

    @classmethod
    def from_size(cls, alpha: float, size_m: float, mu: float = 3.0, gravity: float = GRAVITY) -> "Pier":
        """Pier from its size R0 [m], the distance from a pivot to the centre of mass."""
        if not (math.isfinite(size_m) and size_m > 0):
            raise InputError(f"size_m = {size_m:g}: must be a number above 0 [m]")
        if not (math.isfinite(mu) and mu > 0):
            raise InputError(f"mu = {mu:g}: must be a number above 0 (3 for a rectangle)")
        return cls(alpha, math.sqrt(mu / (1 + mu) * gravity / size_m), mu, gravity)

    @classmethod
    def rectangle(cls, width_m: float, height_m: float, gravity: float = GRAVITY) -> "Pier":
        """Solid rectangular block; its width and height [m] give α, R0 and μ = 3."""
        wrong = [
            f"{name} = {value:g}: must be a number above 0 [m]"
            for name, value in (("width_m", width_m), ("height_m", height_m))
            if not (math.isfinite(value) and value > 0)
        ]
        if wrong:
            raise InputError(*wrong)
        return cls.from_size(math.atan2(width_m, height_m), math.hypot(width_m, height_m) / 2, 3.0, gravity)

    @property
    def size(self) -> float:
        """R0 [m], from a pivot to the centre of mass."""
        return self.mu / (1 + self.mu) * self.gravity / self.p**2

    @property
    def half_width(self) -> float:
        """b = R0 sin α [m]."""
        return self.size * math.sin(self.alpha)

    @property
    def height(self) -> float:
        """h = R0 cos α [m], of the centre of mass above the pivots."""
        return self.size * math.cos(self.alpha)

    @property
    def inertia(self) -> float:
        """I0/M = R0²/μ [m²], about the centre of mass, per unit mass."""
        return self.size**2 / self.mu

    @property
    def inertia_about_pivot(self) -> float:
        """I0/M + R0² [m²], about a pivot, per unit mass."""
        return self.inertia + self.size**2

    @property
    def least_beta(self) -> float:
        """β = ω_v/p below which the pier topples on its springs under its own weight (g h < ω_v² b²)."""
        return math.sqrt((1 + self.mu) * math.cos(self.alpha) / self.mu) / math.sin(self.alpha)


@dataclass(frozen=True)
class RigidBase:
    """Ground that neither gives nor yields (Housner 1963).

    ``restitution`` is the factor e on the angular velocity at an impact; ``None`` means Housner's
    e = 1 − 2μ/(1+μ) sin²α, which conserves the angular momentum about the new pivot, or 0 where that is negative.
    """

    restitution: float | None = None

    name = "rigid"


@dataclass(frozen=True)
class ElasticBase:
    """Two elastic springs that take no tension.

    Attributes
    ----------
    beta : float
        β = ω_v/p, vertical over rocking frequency parameter.
    epsilon : float
        Restitution ε of the landing pivot's velocity, 0..1.
    kinematics : "first-order" or "finite"
        The paper's equations, or those that hold for large rotations.
    flight : "stop" or "guided"
        What happens when both pivots are off the ground: the analysis ends, or shear keys guide the pier down.
    """

    beta: float
    epsilon: float = 0.0
    kinematics: Kinematics = "first-order"
    flight: Flight = "stop"

    name = "elastic"


@dataclass(frozen=True)
class YieldingBase(ElasticBase):
    """Two yielding springs that take no tension (Palmeri & Makris 2007).

    Attributes, beside those of :class:`ElasticBase`
    ----------
    eta : float
        Bearing capacity index η = δ_y/δ_s > 1.
    spring : "bouc-wen" or "epp"
        The paper's smooth law (eq. 8), or elastic–perfectly plastic.
    n : float
        Bouc–Wen exponent ≥ 1; 5 in the paper.
    """

    eta: float = field(kw_only=True)
    spring: SpringLaw = "bouc-wen"
    n: float = 5.0

    name = "yielding"


def least_beta(pier: Pier, base: ElasticBase) -> float:
    """β below which the pier topples on its springs under its own weight, or at the least push (THEORY.md, 9).

    A Bouc–Wen spring under the weight, z = −1/η, is softer where it is loaded than where it is unloaded, by the factor
    r = 1 − η⁻ⁿ; both together have 2r/(1 + r) of the elastic springs' stiffness in rotation.
    """
    if not (isinstance(base, YieldingBase) and base.spring == "bouc-wen" and base.eta > 1 and base.n >= 1):
        return pier.least_beta
    softer = -math.expm1(-base.n * math.log(base.eta))
    return pier.least_beta * math.sqrt((1.0 + softer) / (2.0 * softer))


def vertical_frequency(pier: Pier, base: ElasticBase) -> float:
    """Circular frequency ω_v = β p [rad/s] of vertical vibration in full contact."""
    return base.beta * pier.p


def static_deflection(pier: Pier, base: ElasticBase) -> float:
    """δ_s = g/ω_v² [m], of the springs under the weight at rest, while elastic."""
    return pier.gravity / vertical_frequency(pier, base) ** 2


def yield_deflection(pier: Pier, base: ElasticBase) -> float:
    """δ_y = η δ_s [m], at which a spring yields; elastic springs are measured by δ_s, η = 1."""
    eta = base.eta if isinstance(base, YieldingBase) else 1.0
    return eta * pier.gravity / vertical_frequency(pier, base) ** 2


def tilt_over_residual(gravity: float, height: float, half_width: float, omega_v: float) -> float:
    """Tilt of the base over the residual rotation, 1 − g h/(ω_v² b²): the weight leans the pier (THEORY.md, eq. 14).

    ``gravity`` g [m/s²]; ``height`` h and ``half_width`` b [m], of the centre of mass from the pivots; ``omega_v`` [rad/s].
    """
    return 1.0 - gravity * height / (omega_v * half_width) ** 2


def rocking_frequency(pier: Pier, base: ElasticBase) -> float:
    """Circular frequency ω_r [rad/s] of rocking in full contact, on elastic springs (THEORY.md, 13)."""
    mu, alpha = pier.mu, pier.alpha
    stiffness = mu * (math.sin(alpha) * base.beta * pier.p) ** 2 - (1 + mu) * pier.p**2 * math.cos(alpha)
    return math.sqrt(max(stiffness, 0.0) / (1 + mu * math.cos(alpha) ** 2))


def highest_frequency(pier: Pier, base: ElasticBase) -> float:
    """Greatest circular frequency [rad/s] in full contact: vertical, ω_v, or rocking."""
    return max(vertical_frequency(pier, base), rocking_frequency(pier, base))


Base = RigidBase | ElasticBase | YieldingBase


def problems(pier: Pier, base: Base) -> list[str]:
    """What is impossible about ``pier`` on ``base``: one sentence each, with the limit; empty if nothing."""
    if isinstance(base, RigidBase):
        e = base.restitution
        if e is not None and not 0 <= e <= 1:
            return [f"restitution = {e:g}: must be within 0..1 (leave it out for Housner's value)"]
        return []
    wrong = []
    least = least_beta(pier, base)
    if not (math.isfinite(base.beta) and base.beta > pier.least_beta):
        wrong.append(
            f"beta = {base.beta:g}: the pier topples on its springs under its own weight; beta must be above "
            f"sqrt((1+mu) cos(alpha)/mu)/sin(alpha) = {pier.least_beta:.4g}"
            + (f", for these Bouc–Wen springs above {least:.4g}" if least > pier.least_beta else "")
        )
    elif not base.beta > least and isinstance(base, YieldingBase):
        wrong.append(
            f"beta = {base.beta:g}: the least push topples the pier, because Bouc–Wen springs near their yield force "
            f"(eta = {base.eta:g}, n = {base.n:g}) give way on the loaded side; beta must be above {least:.4g}"
        )
    if not 0 <= base.epsilon <= 1:
        wrong.append(f"epsilon = {base.epsilon:g}: the landing pivot's restitution must be within 0..1")
    if base.kinematics not in ("first-order", "finite"):
        wrong.append(f'kinematics = "{base.kinematics}": must be "first-order" or "finite"')
    if base.flight not in ("stop", "guided"):
        wrong.append(f'flight = "{base.flight}": must be "stop" or "guided"')
    if isinstance(base, YieldingBase):
        if not (math.isfinite(base.eta) and base.eta >= LEAST_ETA):
            wrong.append(
                f"eta = {base.eta:.10g}: the springs cannot carry the weight; eta = yield force over static force must "
                f"be above 1 (at least {LEAST_ETA:.6f})"
            )
        if base.spring not in ("bouc-wen", "epp"):
            wrong.append(f'spring = "{base.spring}": must be "bouc-wen" or "epp"')
        if not (math.isfinite(base.n) and base.n >= 1):
            wrong.append(f"n = {base.n:g}: the Bouc–Wen exponent must be at least 1")
    return wrong
