"""The pier on a footing in OpenSees: a rigid bar on springs without tension, which share nothing with rockbatch.

    pip install openseespy
    python benchmarks/opensees_footing.py > benchmarks/opensees_footing.csv

As in benchmarks/opensees.py, but with 40 springs under the foot, at the middles of as many strips, drawn apart until they have
the rocking stiffness of the bed. Rows: case, peak rotation over α in the motion, steps of OpenSees to a sample.
tests/verification/test_footing.py holds rockbatch against them.
"""

import math
import sys
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

import numpy as np

import rockbatch as rb

NEAR_FAULT = Path(__file__).parents[1] / "motions" / "near_fault"
STRIPS = 40
LINK = 1e4
"""Stiffness of the links over that of all springs."""
WITHIN = 1e-10

COLUMNS = ("case", "theta_max_over_alpha", "steps_per_sample")


class Case(NamedTuple):
    """A pier on a footing without dashpots, and a motion."""

    pier: rb.Pier
    base: rb.FootingBase
    motion: rb.Motion


def record(folder: str, name: str, start: float, end: float) -> rb.Motion:
    """Return a component of ``motions/near_fault`` between two times [s]."""
    motion = next(m for m in rb.read_motions(NEAR_FAULT / folder).motions if m.name == name)
    first, last = (round(t / motion.dt) for t in (start, end))
    return rb.Motion(name, motion.dt, motion.horizontal[first:last])


def cases() -> dict[str, Case]:
    """Return six piers, by name: three sizes, each on an elastic bed and on one that yields."""
    meloland = record("imperialvalley1979_meloland", "CHAN24", 0.0, 12.0)
    wtmc = record("kaikoura2016_wtmc", "20161113_110259_WTMC_20.N28W", 46.0, 54.0)
    made = {}
    for half, height, settlement, motion in (
        (3.0, 15.0, 0.004, meloland),
        (4.5, 24.0, 0.010, meloland),
        (5.0, 20.0, 0.008, wtmc),
    ):
        size, inertia = math.hypot(half, height), height**2 / 3.0
        pier = rb.Pier.from_size(math.atan2(half, height), size, size**2 / inertia)
        beta = math.sqrt(pier.gravity / settlement) / pier.p
        for safety in (None, 3.0):
            base = rb.FootingBase(beta, safety, zeta=0.0, kinematics="finite", strips=STRIPS)
            made[f"{2 * half:g} m by {height:g} m, {'elastic' if safety is None else f'FS {safety:g}'}"] = Case(
                pier, base, motion
            )
    return made


def build(case: Case) -> None:
    """Build the pier, and let it come to rest under its weight."""
    from plane_frame import BEAM, begin, come_to_rest, ops, without_tension

    pier, base = case.pier, case.base
    h, total = pier.height, (base.beta * pier.p) ** 2
    places = pier.half_width * ((2.0 * np.arange(STRIPS) + 1.0) / STRIPS - 1.0) / math.sqrt(1.0 - 1.0 / STRIPS**2)
    begin()
    ops.node(1, 0.0, 0.0)
    ops.node(2, 0.0, h)
    ops.fix(1, 1, 0, 0)
    ops.mass(2, 1.0, 1.0, pier.inertia)
    tags, links = [], (LINK * total * h, 1.0, LINK * total * h**3, BEAM)
    ops.element("elasticBeamColumn", 1, 1, 2, *links)
    strength = None if base.safety_factor is None else base.safety_factor * pier.gravity / STRIPS
    without_tension(4, total / STRIPS, strength)
    for i, x in enumerate(places.tolist()):
        foot, ground = 10 + i, 1000 + i
        ops.node(foot, x, 0.0)
        ops.node(ground, x, 0.0)
        ops.fix(ground, 1, 1, 1)
        ops.element("zeroLength", ground, ground, foot, "-mat", 4, "-dir", 2)
        tags += [1, foot] if i == STRIPS // 2 else [foot]
    for link, (start, end) in enumerate(pairwise(tags), start=10):
        ops.element("elasticBeamColumn", link, start, end, *links)
    come_to_rest({2: pier.gravity}, WITHIN)


def peak(case: Case, steps: int) -> float:
    """Return the greatest rotation over α at the samples of the motion, by ``steps`` a sample."""
    from plane_frame import ops, shake, solve

    build(case)
    shake(case.motion.dt, case.motion.horizontal)
    solve("Newmark", 0.5, 0.25, within=WITHIN)
    ops.analysis("Transient")
    greatest = 0.0
    for _ in range(case.motion.npts - 1):
        assert ops.analyze(steps, case.motion.dt / steps) == 0
        greatest = max(greatest, abs(ops.nodeDisp(2, 3)))
    return greatest / case.pier.alpha


def main() -> None:
    """Print a row for each case, by two steps a sample and their halves, extrapolated."""
    print(",".join(COLUMNS))
    for name, case in cases().items():
        coarse, fine = peak(case, 2), peak(case, 4)
        print(f'"{name}",{fine + (fine - coarse) / 3.0:.7f},4', flush=True)
        print(f"{name}: {coarse:.6f} {fine:.6f}", file=sys.stderr, flush=True)


if __name__ == "__main__":
    main()
