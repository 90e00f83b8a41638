"""The force of a landing foot by the speed of rigid runs, beside elastic runs on feet of that stiffness: random pairs.

    python benchmarks/landing_forces.py --seed 1 --pairs 200

Each pair is a pier of its own, with a deck or without, under a component of motions/near_fault by a random factor, with its
vertical component or without, once on rigid ground with ``contact_stiffness_kN_m`` and once on elastic feet of that stiffness,
ζ = 0.02 to 0.1. Printed: how many pairs land on both and stand, and quantiles over these of

    v        the speed of the hardest landing, rigid over elastic
    F        landing_force_kN of the rigid run over the greatest force of a foot of the elastic one
    F(v_e)   the same formula with the speed of the elastic run
    bound    the force of the elastic run over W + 1.5 v √(K M_s)

all together, and below and above 0.6 g of vertical motion. No times.
"""

import argparse
import math
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np

import rockbatch as rb
from rockbatch.common.errors import InputError
from rockbatch.pier import landing_force

RECORDS = Path(__file__).parents[1] / "motions" / "near_fault"
QUANTILES = (0.0, 0.1, 0.25, 0.5, 0.75, 0.9, 1.0)
STRONG = 0.6
"""Of g: vertical motion from which the two runs soon part."""


class Pair(NamedTuple):
    """Peak vertical acceleration over g, and the four quotients."""

    vertical_g: float
    speed: float
    force: float
    by_own_speed: float
    over_bound: float


def pairs(seed: int, number: int) -> Iterator[Pair | None]:
    """Yield the quotients of each pair; None for one that does not land, overturns or takes too many steps on either base."""
    rng = np.random.default_rng(seed)
    motions = rb.read_motions(RECORDS).motions
    for _ in range(number):
        pier = random_pier(rng)
        motion = motions[int(rng.integers(len(motions)))]
        motion = motion.scaled(float(rng.uniform(0.5, 1.5)))
        if rng.random() < 0.3:
            motion = rb.Motion(motion.name, motion.dt, motion.horizontal, np.zeros_like(motion.horizontal))
        assert pier.mass_t is not None
        stiffness = 0.5 * pier.mass_t * pier.gravity / float(np.exp(rng.uniform(math.log(2e-4), math.log(1e-2))))
        feet = rb.ElasticBase.from_stiffness(pier, stiffness, zeta=float(rng.uniform(0.02, 0.1)))
        try:
            yield compared(pier, stiffness, feet, motion)
        except InputError:
            yield None


def random_pier(rng: np.random.Generator) -> rb.Pier:
    """Return a pier of 3 to 12 m width and 3 to 9 times that height, half of them with a deck."""
    width = float(rng.uniform(3.0, 12.0))
    height = min(width * float(rng.uniform(3.0, 9.0)), 80.0)
    mass = float(rng.uniform(0.1, 0.8)) * width * width * height
    if rng.random() < 0.5:
        return rb.Pier.rectangle(width, height, mass_t=mass, confirm=("mass_t",))
    deck = mass * float(np.exp(rng.uniform(math.log(0.1), math.log(4.0))))
    return rb.Pier.with_deck(width, height, mass, deck, confirm=("mass_t", "deck_mass_t"))


def compared(pier: rb.Pier, stiffness: float, feet: rb.ElasticBase, motion: rb.Motion) -> Pair | None:
    """Return the quotients of a pair of runs."""
    rigid, elastic = (
        rb.simulate(pier, base, motion, forces=True).row
        for base in (rb.RigidBase(contact_stiffness_kN_m=stiffness), feet)
    )
    assert rigid is not None
    assert elastic is not None
    assert pier.mass_t is not None
    if "landing_force_kN" not in rigid or "landing_velocity_m_s" not in elastic:
        return None
    if not rigid["status"] == elastic["status"] == "ok" or not elastic["landing_velocity_m_s"] > 0.0:
        return None
    force = max(elastic["pivot_force_left_kN"], elastic["pivot_force_right_kN"])
    v, own = rigid["landing_velocity_m_s"], elastic["landing_velocity_m_s"]
    moved = pier.mass_t / (1.0 + pier.half_width**2 / (pier.inertia + pier.height**2))
    bound = pier.mass_t * pier.gravity + 1.5 * v * math.sqrt(stiffness * moved)
    vertical = float(np.abs(motion.vertical).max()) / pier.gravity
    by_own = pier.mass_t * landing_force(pier, stiffness, own)
    return Pair(vertical, v / own, rigid["landing_force_kN"] / force, by_own / force, force / bound)


def described(found: list[Pair], words: str) -> str:
    """Return the quantiles of these pairs, a line for each quotient."""
    lines = [f"{words}: {len(found)} pairs" + "".join(f"{q:>8.0%}" for q in QUANTILES)]
    for name, label in (("speed", "v"), ("force", "F"), ("by_own_speed", "F(v_e)"), ("over_bound", "bound")):
        values = np.array([getattr(pair, name) for pair in found])
        lines.append(f"{label:>8}" + "".join(f"{value:8.2f}" for value in np.quantile(values, QUANTILES)))
    within, beyond = (
        np.mean([test(pair) for pair in found]) for test in (_is_near, lambda pair: pair.over_bound > 1.0)
    )
    return "\n".join([*lines, f"  F within 30 %: {within:.0%}; beyond the bound: {beyond:.0%}"])


def _is_near(pair: Pair) -> bool:
    return 0.7 <= pair.force <= 1.3


def main() -> None:
    """Print the quantiles."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--pairs", type=int, default=200)
    arguments = parser.parse_args()
    found = [pair for pair in pairs(arguments.seed, arguments.pairs) if pair is not None]
    print(f"seed {arguments.seed}: {len(found)} of {arguments.pairs} pairs land on both bases and stand")
    groups = {
        "all": found,
        f"below {STRONG:g} g of vertical motion": [pair for pair in found if pair.vertical_g < STRONG],
        f"from {STRONG:g} g on": [pair for pair in found if pair.vertical_g >= STRONG],
    }
    for words, group in groups.items():
        if group:
            print(described(group, words))


if __name__ == "__main__":
    main()
