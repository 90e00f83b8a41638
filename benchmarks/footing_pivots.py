"""How far two springs stand for a footing: peaks and moment capacity by three places of the pivots, over those on a bed.

    python benchmarks/footing_pivots.py

The bed is ``FootingBase``; the springs have its stiffness, strength and damping ratio in total. First-order kinematics; three
piers under the ten near-fault components of motions/near_fault, horizontal alone.
"""

import math
from pathlib import Path
from typing import NamedTuple

import numpy as np

import rockbatch as rb

ZETA = 0.05
QUIET = 5.0
"""Time after the record [s]."""
RECORDS = Path(__file__).parents[1] / "motions" / "near_fault"
GRAVITY = 9.81


class Footing(NamedTuple):
    """A pier on a footing: width B, height h of the centre of mass and static settlement δ_s [m], I0/M [m²]."""

    width: float
    height: float
    inertia: float
    settlement: float


FOOTINGS = (Footing(4.0, 10.0, 35.0, 0.003), Footing(6.0, 15.0, 80.0, 0.005), Footing(9.0, 24.0, 200.0, 0.015))
SAFETY = (1.5, 3.0, 10.0)
PLACES = {
    "±B/2": lambda safety: 1.0,
    "±B/(2√3)": lambda safety: 1.0 / math.sqrt(3.0),
    "equal capacity": lambda safety: max(1.0 - 1.0 / safety, 1.0 / safety),
}
"""Half the distance of the pivots over B/2, by Q_ult/W. On two springs M_ult = W b min(1, Q_ult/W − 1)."""


def on_bed(footing: Footing, safety: float) -> tuple[rb.Pier, rb.FootingBase]:
    """Return the pier on its bed."""
    pier, base = on_springs(footing, safety, 1.0)
    return pier, rb.FootingBase(base.beta, None if math.isinf(safety) else safety, ZETA)


def peak_on_bed(footing: Footing, safety: float, motion: rb.Motion) -> float:
    """Return the greatest |θ| [rad] on the bed; infinite if the pier falls."""
    run = rb.simulate(*on_bed(footing, safety), motion, quiet_s=QUIET)
    return math.inf if run.status == "overturned" else float(run.theta_max)


def on_springs(footing: Footing, safety: float, share: float) -> tuple[rb.Pier, rb.ElasticBase]:
    """Return the pier with pivots at ±``share`` B/2, and its two springs."""
    half = share * footing.width / 2
    size = math.hypot(half, footing.height)
    pier = rb.Pier.from_size(math.atan2(half, footing.height), size, size**2 / footing.inertia)
    beta = math.sqrt(GRAVITY / footing.settlement) / pier.p
    if math.isinf(safety):
        return pier, rb.ElasticBase(beta, zeta=ZETA)
    return pier, rb.YieldingBase(beta, eta=safety, zeta=ZETA, spring="epp")


def capacity(footing: Footing, safety: float, share: float) -> float:
    """Return the greatest moment on two springs over that of the footing, W (B/2) (1 − W/Q_ult)."""
    return share * min(1.0, safety - 1.0) / (1.0 - 1.0 / safety)


def row(safety: float, place: str, motions: list[rb.Motion], beds: list[list[float]]) -> str:
    """Return a line of the table; ``beds`` are peaks on the bed, by footing and motion."""
    share, ratios, fallen = PLACES[place](safety), [], [0, 0]
    for footing, on_it in zip(FOOTINGS, beds, strict=True):
        pier, base = on_springs(footing, safety, share)
        for motion, bed in zip(motions, on_it, strict=True):
            run = rb.simulate(pier, base, motion, quiet_s=QUIET)
            fallen = [fallen[0] + math.isinf(bed), fallen[1] + (run.status == "overturned")]
            if math.isfinite(bed) and run.status == "ok":
                ratios.append(run.theta_max / bed)
    low, middle, high = np.quantile(ratios, (0.1, 0.5, 0.9))
    spread = f"{middle:.2f} | {low:.2f} to {high:.2f}"
    return (
        f"| {safety:g} | {place} | {capacity(FOOTINGS[0], safety, share):.2f} | {spread} | {fallen[1]}, {fallen[0]} |"
    )


if __name__ == "__main__":
    records = list(rb.read_motions(RECORDS, vertical=False))
    print("| Q_ult/W | pivots at | capacity | peak: median | 10 to 90 % | overturned: springs, bed |")
    print("| --- | --- | --- | --- | --- | --- |")
    for q in SAFETY:
        peaks = [[peak_on_bed(footing, q, motion) for motion in records] for footing in FOOTINGS]
        for name in PLACES:
            print(row(q, name, records, peaks), flush=True)
