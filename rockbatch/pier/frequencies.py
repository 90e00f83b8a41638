"""Frequencies of a pier in full contact with its springs, the period of a free block, and static deflections.

See THEORY.md, eqs. 12 and 20, and Statics.
"""

import math
from typing import Protocol

from rockbatch.pier.block import Pier


class Ground(Protocol):
    """A base with β, its vertical frequency over p; infinite on rigid ground."""

    @property
    def beta(self) -> float: ...


class Springs(Ground, Protocol):
    """Ground that gives: its damping ratio, if any, η, by which deflections are measured, and its rocking stiffness over the
    stiffness of the same springs at both edges."""

    @property
    def zeta(self) -> float | None: ...

    @property
    def reference_eta(self) -> float: ...

    @property
    def rocking_share(self) -> float: ...


def vertical_frequency(pier: Pier, base: Ground) -> float:
    """Return the circular frequency ω_v = β p [rad/s] of vertical vibration in full contact; infinite on a rigid base."""
    return base.beta * pier.p


def static_deflection(pier: Pier, base: Ground) -> float:
    """Return δ_s = g/ω_v² [m], the elastic deflection of the springs under the weight; 0 on a rigid base."""
    return pier.gravity / vertical_frequency(pier, base) ** 2


def yield_deflection(pier: Pier, base: Springs) -> float:
    """Return δ_y = η δ_s [m], the yield deflection; δ_s for elastic springs, η = 1."""
    return base.reference_eta * pier.gravity / vertical_frequency(pier, base) ** 2


def tilt_over_residual(gravity: float, height: float, half_width: float, omega_v: float) -> float:
    """Return the tilt of the base over the residual rotation, 1 − g h/(ω_v² b²): the weight leans the pier (THEORY.md, eq. 20).

    ``gravity`` g [m/s²]; ``height`` h and ``half_width`` b [m], of the centre of mass from the pivots; ``omega_v`` [rad/s].
    """
    return 1.0 - gravity * height / (omega_v * half_width) ** 2


def rocking_frequency(pier: Pier, base: Springs) -> float:
    """Return the circular frequency ω_r [rad/s] of elastic rocking in full contact (THEORY.md, eq. 12); 0 if it topples."""
    mu, alpha = pier.mu, pier.alpha
    stiffness = mu * base.rocking_share * (math.sin(alpha) * base.beta * pier.p) ** 2 - (1 + mu) * pier.p**2 * math.cos(
        alpha
    )
    return math.sqrt(max(stiffness, 0.0) / (1 + mu * math.cos(alpha) ** 2))


def fastest(pier: Pier, base: Springs) -> float:
    """Return the greatest rate [rad/s] in full contact: of vertical vibration or rocking, or of decay if overdamped.

    A vibration ω with the decay rate d has the rate ω if d ≤ ω, and d + √(d² − ω²) otherwise; d is ζ ω_v of the vertical one,
    and ζ ω_v c μ sin²α/(1 + μ cos²α) of rocking, where c is the base's ``rocking_share`` (THEORY.md, Damped supports).
    """
    damping = (base.zeta or 0.0) * vertical_frequency(pier, base)
    share = base.rocking_share * pier.mu * math.sin(pier.alpha) ** 2 / (1 + pier.mu * math.cos(pier.alpha) ** 2)

    def rate(omega: float, decay: float) -> float:
        return omega if decay <= omega else decay + math.sqrt(decay**2 - omega**2)

    return max(
        rate(vertical_frequency(pier, base), damping),
        rate(rocking_frequency(pier, base), damping * share),
    )


def block_period(pier: Pier, rotation: float) -> float:
    """Return the period [s] of a free slender block that rocks with the amplitude ``rotation`` [rad]; inf from α on.

    It is 4/p arcosh(1/(1 − θ/α)), Housner's (THEORY.md, Statics).
    """
    left = 1.0 - rotation / pier.alpha
    return 4.0 / pier.p * math.acosh(1.0 / left) if left > 0.0 else math.inf
