"""Greatest rates at which a pier vibrates, or creeps back if overdamped, without devices (THEORY.md, A shaft that bends)."""

import math
from collections.abc import Iterator

import numpy as np

from rockbatch.pier.bases import ElasticBase, RigidBase
from rockbatch.pier.bending import Values
from rockbatch.pier.block import Pier
from rockbatch.pier.footing_base import FootingBase
from rockbatch.pier.frequencies import fastest, vertical_frequency

PRESSED = (1.0, 0.8, 0.6, 0.4, 0.2, 0.1, 0.05, 0.0)
"""Shares of a bed, from an edge on, for which the greatest rate of a pier whose shaft bends is looked for."""


def greatest_rate(pier: Pier, base: ElasticBase | FootingBase) -> float:
    """Return the greatest rate [1/s] on ground that gives: in full contact if the shaft is rigid, in any contact if it bends."""
    if not base.bends:
        return fastest(pier, base)
    modes, omega_v = base.modes(pier), vertical_frequency(pier, base)
    n = 2 + len(modes.frequency)  # v, θ and the modes
    masses = np.diag([1.0, pier.inertia + pier.height**2, *np.ones(n - 2)])
    masses[1, 2:] = masses[2:, 1] = modes.coupling
    greatest = 0.0
    for share, places in _contacts(pier, base):
        stiffness = np.diag([0.0, 0.0, *modes.frequency**2])
        damping = np.diag([0.0, 0.0, *2.0 * base.damping_ratios(pier) * modes.frequency])
        for place in places:
            arm = np.array([1.0, -place, *np.zeros(n - 2)])
            stiffness += 0.5 * share * omega_v**2 * np.outer(arm, arm)
            damping += share * (base.zeta or 0.0) * omega_v * np.outer(arm, arm)
        greatest = max(greatest, _greatest(masses, stiffness, damping))
    return greatest


def greatest_rate_of_shaft(pier: Pier, base: RigidBase, turning: float) -> float:
    """Return the greatest rate [1/s] of the shaft's modes coupled with a rotation of the inertia ``turning`` [m²]."""
    modes = base.modes(pier)
    # Without the rotation, whose acceleration is −Σ λ_i ü_i/J
    masses = np.eye(len(modes.frequency)) - np.outer(modes.coupling, modes.coupling) / turning
    damping = np.diag(2.0 * base.damping_ratios(pier) * modes.frequency)
    return _greatest(masses, np.diag(modes.frequency**2), damping)


def _contacts(pier: Pier, base: ElasticBase | FootingBase) -> Iterator[tuple[float, list[float]]]:
    """Yield, for each contact with the ground, the share that is pressed of two equal halves of it, and their places [m].

    Two springs: both, one, none. A part of a bed is replaced by two supports of its stiffness, vertical and in rocking.
    """
    b = float(pier.half_width)
    if base.two_springs:
        yield from ((1.0, [-b, b]), (1.0, [b]), (1.0, []))
        return
    for share in PRESSED:
        middle, apart = b * (1.0 - share), b * share / math.sqrt(3.0)
        yield share, [middle - apart, middle + apart]


def _greatest(masses: Values, stiffness: Values, damping: Values) -> float:
    """Return the greatest modulus [1/s] of the eigenvalues of M ẍ + C ẋ + K x = 0; ``masses`` etc. of shape (n, n)."""
    n = len(masses)
    rates = np.linalg.solve(masses, np.hstack((stiffness, damping)))
    system = np.vstack((np.hstack((np.zeros((n, n)), np.eye(n))), -rates))
    return float(np.abs(np.linalg.eigvals(system)).max())
