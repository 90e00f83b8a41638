"""Estimate of the contact force of a landing foot, from the landing speed on rigid ground and a contact stiffness."""

import math

from rockbatch.pier.block import Pier


def landing_force(pier: Pier, stiffness_kN_m: float, speed: float) -> float:
    """Return the peak contact force over the pier's mass [m/s²] of a foot landing at ``speed`` [m/s] (THEORY.md, eq. 21a).

    The foot, with the effective mass M_s = M/(1 + b²/I), compresses a spring of ``stiffness_kN_m`` while half of its weight
    acts on it. ``pier.mass_t`` must be given.
    """
    assert pier.mass_t is not None
    share = 1.0 / (1.0 + pier.half_width**2 / (pier.inertia + pier.height**2))
    weight, stiffness = 0.5 * share * pier.gravity, stiffness_kN_m / pier.mass_t
    return weight + math.sqrt(weight**2 + share * stiffness * speed**2)
