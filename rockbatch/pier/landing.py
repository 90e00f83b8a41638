"""The force of a foot that lands on ground of a given stiffness, by the speed of a landing on rigid ground: an orientation."""

import math

from rockbatch.pier.block import Pier


def landing_force(pier: Pier, stiffness_kN_m: float, speed: float) -> float:
    """Return the greatest force of a foot over the mass of the pier [m/s²] as it lands at ``speed`` [m/s] (THEORY.md, eq. 21a).

    The foot, with the mass M_s = M/(1 + b²/I) that a force there moves, presses a spring of ``stiffness_kN_m`` that it meets
    under half of its weight. The mass of the pier is known.
    """
    assert pier.mass_t is not None
    share = 1.0 / (1.0 + pier.half_width**2 / (pier.inertia + pier.height**2))
    weight, stiffness = 0.5 * share * pier.gravity, stiffness_kN_m / pier.mass_t
    return weight + math.sqrt(weight**2 + share * stiffness * speed**2)
