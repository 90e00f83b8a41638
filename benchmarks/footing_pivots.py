"""How far two springs stand for a footing: peaks and moment capacity by three places of the pivots, over those on a bed.

    python benchmarks/footing_pivots.py

The bed has 31 strips without tension, each elastic–perfectly plastic with a dashpot, of the same stiffness and strength in total,
and is solved here without any code of the program (Runge–Kutta of order 4, first-order kinematics). Two piers under the ten
near-fault components of motions/near_fault, horizontal alone.
"""

import math
from pathlib import Path
from typing import NamedTuple

import numba
import numpy as np

import rockbatch as rb

STRIPS = 31
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


FOOTINGS = (Footing(6.0, 15.0, 80.0, 0.005), Footing(9.0, 24.0, 200.0, 0.015))
SAFETY = (1.5, 2.0, 3.0, 5.0, 20.0, math.inf)
PLACES = {
    "±B/2": lambda safety: 1.0,
    "±B/(2√3)": lambda safety: 1.0 / math.sqrt(3.0),
    "equal capacity": lambda safety: max(1.0 - 1.0 / safety, 1.0 / safety),
}
"""Half the distance of the pivots over B/2, by Q_ult/W. On two springs M_ult = W b min(1, Q_ult/W − 1)."""


@numba.njit
def _rates(state, sunk, ground, model):
    """Return the accelerations of height and rotation, for plastic sets ``sunk`` of the strips."""
    v, theta, speed, turning = state
    half, height, inertia, stiffness, strength, dashpot = model
    up, moment = 0.0, 0.0
    for i in range(len(sunk)):
        x = half * ((2 * i + 1) / len(sunk) - 1.0)
        pressed = -v + x * theta - sunk[i]
        if pressed > 0.0:
            push = min(max(stiffness * pressed + dashpot * (-speed + x * turning), 0.0), strength) / len(sunk)
            up += push
            moment += push * (height * theta - x)
    return up - GRAVITY, (moment - height * ground) / (inertia + height**2)


@numba.njit
def _peak_on_bed(model, acceleration, dt, count, quiet):
    """Return the greatest |θ| [rad], infinite if the pier falls; ``count`` steps a sample."""
    half, stiffness, strength = model[0], model[3], model[4]
    state, sunk = np.array([-GRAVITY / stiffness, 0.0, 0.0, 0.0]), np.zeros(STRIPS)
    yielded = strength / stiffness
    weights, at, h = (1.0, 2.0, 2.0, 1.0), (0.0, 0.5, 0.5, 1.0), dt / count
    k, peak = np.zeros((4, 4)), 0.0
    for step in range((len(acceleration) - 1 + int(quiet / dt)) * count):
        for stage in range(4):
            t = (step + at[stage]) / count
            i = int(t)
            ground = 0.0
            if i < len(acceleration) - 1:
                ground = acceleration[i] + (t - i) * (acceleration[i + 1] - acceleration[i])
            y = state + at[stage] * h * k[stage - 1] if stage else state
            k[stage, 0], k[stage, 1] = y[2], y[3]
            k[stage, 2], k[stage, 3] = _rates(y, sunk, ground, model)
        for stage in range(4):
            state = state + h / 6.0 * weights[stage] * k[stage]
        for i in range(STRIPS):
            x = half * ((2 * i + 1) / STRIPS - 1.0)
            sunk[i] = max(sunk[i], -state[0] + x * state[1] - yielded)
        peak = max(peak, abs(state[1]))
        if peak > 0.5 * math.pi:
            return math.inf
    return peak


def peak_on_bed(footing: Footing, safety: float, motion: rb.Motion) -> float:
    """Return the greatest |θ| [rad] on the bed; infinite if the pier falls."""
    stiffness = GRAVITY / footing.settlement
    dashpot = 2.0 * ZETA * math.sqrt(stiffness)
    model = (footing.width / 2, footing.height, footing.inertia, stiffness, safety * GRAVITY, dashpot)
    count = math.ceil(motion.dt * math.sqrt(stiffness) / 0.05)
    return float(_peak_on_bed(model, motion.horizontal, motion.dt, count, QUIET))


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


def row(safety: float, place: str, motions: list[rb.Motion]) -> str:
    """Return a line of the table."""
    share, ratios, fallen = PLACES[place](safety), [], [0, 0]
    for footing in FOOTINGS:
        pier, base = on_springs(footing, safety, share)
        for motion in motions:
            bed = peak_on_bed(footing, safety, motion)
            run = rb.simulate(pier, base, motion, quiet_s=QUIET)
            fallen = [fallen[0] + math.isinf(bed), fallen[1] + (run.status == "overturned")]
            if math.isfinite(bed) and run.status == "ok":
                ratios.append(run.theta_max / bed)
    spread = f"{np.median(ratios):.2f} | {min(ratios):.2f} to {max(ratios):.2f}"
    name = "elastic" if math.isinf(safety) else f"{safety:g}"
    return f"| {name} | {place} | {capacity(FOOTINGS[0], safety, share):.2f} | {spread} | {fallen[1]}, {fallen[0]} |"


if __name__ == "__main__":
    records = [motion for motion in rb.read_motions(RECORDS, vertical=False)]
    print("| Q_ult/W | pivots at | capacity | peak: median | least to greatest | overturned: springs, bed |")
    print("| --- | --- | --- | --- | --- | --- |")
    for q in SAFETY:
        for name in PLACES:
            print(row(q, name, records), flush=True)
