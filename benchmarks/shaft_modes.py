"""How a bending shaft's forces converge with its modes, and whether the claimed errors hold what a further mode changes.

    python benchmarks/shaft_modes.py [--cases 40] [--seed 1] [--damping modal|stiffness] [--springs]

Random piers on rigid ground, a shaft under a deck of a tenth to twice its mass, under a horizontal and in two of three cases a
vertical wave packet, in one to four modes with 5 % of critical damping, or with 1 % in the first as by stiffness.
Of each quantity the table has the ratio to that of four modes: the median, and between which values 68 of 100 are. "Held" are the
claims of two and three modes whose error covers the result of four, of those that claim one. With --springs the piers stand on
damped springs, with a vertical period of a tenth of that of rocking. No times.
"""

import argparse
import math
from dataclasses import replace
from typing import Any

import numpy as np

import rockbatch as rb
from rockbatch.motions import Motion

DT, MODES = 0.01, 4
QUANTITIES = {
    "peak rotation": "theta_max_over_alpha",
    "deflection": "deflection_max_m",
    "base shear": "base_shear_m_s2",
    "moment at the foot": "foot",
    "moment at mid-height": "middle",
    "acceleration of the deck": "deck_acceleration_m_s2",
}
ERRORS = {"theta_max_over_alpha": "theta_max_error", "deflection_max_m": "deflection_error_m"}


def case(number: int, seed: int) -> tuple[rb.Pier, Motion]:
    """Return pier and motion number ``number`` of a pool."""
    rng = np.random.default_rng([seed, number, 75])
    width, mass = rng.uniform(4.0, 12.0), 2000.0
    height = width * rng.uniform(2.5, 6.0)
    deck = mass * rng.uniform(0.1, 2.0)
    parts = [rb.Part.shaft(0.5 * width, height, mass), rb.Part(deck, 1.03 * height, 2.0 * deck, 0.0)]
    rigid = rb.Pier.of_parts(width, parts)
    rocking = 4.0 / rigid.p * math.acosh(1.0 / 0.9)  # at 0.1 α
    pier = replace(rigid, flexural_period_s=rocking * rng.uniform(0.1, 0.5))
    t = np.arange(0.0, 5.0, DT)
    packet = np.exp(-(((t - 1.8) / 0.9) ** 2))
    horizontal = rng.uniform(1.2, 3.0) * pier.alpha * 9.81 * np.sin(2.0 * math.pi * t / rng.uniform(0.6, 2.0)) * packet
    vertical = rng.uniform(0.1, 0.5) * 9.81 * np.sin(2.0 * math.pi * t / 0.31) * packet if number % 3 else None
    return pier, Motion(f"case {number}", DT, horizontal, vertical)


def base_of(pier: rb.Pier, springs: bool, **shaft: Any) -> rb.RigidBase | rb.ElasticBase:
    """Return the base of a pier with a ``shaft`` that bends."""
    if not springs:
        return rb.RigidBase(shaft="elastic", **shaft)
    rocking = 4.0 * math.acosh(1.0 / 0.9)  # at 0.1 α, over 1/p
    return rb.ElasticBase(20.0 * math.pi / rocking, zeta=0.3, kinematics="finite", shaft="elastic", **shaft)


def results(
    pier: rb.Pier, motion: Motion, base: rb.RigidBase | rb.ElasticBase
) -> dict[str, tuple[float, float]] | None:
    """Return each quantity with its claimed error; None for a run that does not end standing."""
    run = rb.simulate(pier, base, motion, forces=True, sections=3)
    if run.status != "ok" or run.row.theta_max_over_alpha < 1e-3:
        return None
    sections = run.sections.set_index("height_m")
    found = {}
    for name in QUANTITIES.values():
        if name in ("foot", "middle"):
            row = sections.iloc[0 if name == "foot" else 1]
            found[name] = row.section_moment_m2_s2, row.section_moment_m2_s2 * row.sections_error
        elif name in ERRORS:
            found[name] = run.row[name], run.row[ERRORS[name]]
        else:
            found[name] = run.row[name], run.row[name] * run.row.forces_error
    return found


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=str(__doc__).split("\n\n")[0])
    parser.add_argument("--cases", type=int, default=40)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--damping", choices=("modal", "stiffness"), default="modal")
    parser.add_argument("--springs", action="store_true")
    arguments = parser.parse_args()
    damping = {"flexural_damping": 0.05 if arguments.damping == "modal" else 0.01}
    runs = []
    for number in range(arguments.cases):
        pier, motion = case(number, arguments.seed)
        bases = [
            base_of(pier, arguments.springs, flexural_damping_kind=arguments.damping, flexural_modes=n, **damping)
            for n in range(1, MODES + 1)
        ]
        of_modes = [results(pier, motion, base) for base in bases]
        if all(of_modes):
            runs.append(of_modes)
    print(f"{len(runs)} of {arguments.cases} piers rock and stand in every number of modes")
    print("| quantity | 1 mode | 2 | 3 | held, 2 modes | held, 3 |")
    print("| --- | --- | --- | --- | --- | --- |")
    for words, name in QUANTITIES.items():
        values = np.array([[found[name] for found in of_modes] for of_modes in runs])  # (piers, modes, 2)
        ratios = np.quantile(values[:, :-1, 0] / values[:, -1:, 0], (0.16, 0.5, 0.84), axis=0)
        cells = [f"{middle:.3f} ({low:.3f}–{high:.3f})" for low, middle, high in ratios.T]
        for n in (2, 3):
            off = np.abs(values[:, n - 1, 0] - values[:, -1, 0])
            claims = np.isfinite(values[:, n - 1, 1])
            cells.append(f"{int((off <= values[:, n - 1, 1])[claims].sum())} of {int(claims.sum())}")
        print("|", " | ".join([words, *cells]), "|")


if __name__ == "__main__":
    main()
