"""The pier on two springs in OpenSees: a model of finite elements that shares nothing with rockbatch.

    pip install openseespy
    python benchmarks/opensees.py > benchmarks/opensees.csv

Corotational beams, 10⁴ times as stiff as the springs, hold the mass above a base whose middle cannot move sideways; under both
ends is a zeroLength element without tension: ENT, or ElasticPPGap with accumulating gap where it yields. Newmark's average
acceleration, in steps that are halved until the peak changes by less than 10⁻⁴. Rows: case, and of θ/α the peak and its time [s],
and how deep each pivot was pressed in, over δ_s, all at the samples of the motion. tests/verification/test_against_opensees.py
holds rockbatch against them, and says what parts the two.
"""

import math
from pathlib import Path
from typing import NamedTuple

import numpy as np

import rockbatch as rb

NEAR_FAULT = Path(__file__).parents[1] / "motions" / "near_fault"
LINK = 1e4
"""Stiffness of the links over that of the springs."""
WITHIN = 1e-11

COLUMNS = ("case", "theta_max_over_alpha", "t_max_s", "left_over_delta_s", "right_over_delta_s", "steps_per_sample")


class Case(NamedTuple):
    """A pier on springs, and a motion; ``end`` [s] is where the comparison ends."""

    pier: rb.Pier
    base: rb.ElasticBase
    motion: rb.Motion
    end: float

    @property
    def samples(self) -> int:
        """Number of samples until the end of the comparison."""
        return round(self.end / self.motion.dt) + 1


def one_sine(pier: rb.Pier, amplitude: float) -> rb.Motion:
    """Return a one-sine of ``amplitude`` g tan α with ω_p/p = 5 and 200 samples, and zeros for seven times as long."""
    period = 2.0 * math.pi / (5.0 * pier.p)
    peak = amplitude * pier.gravity * math.tan(pier.alpha)
    return rb.pulse("sine", name="one-sine", amplitude=peak, period=period, dt=period / 200, duration=8 * period)


def record(folder: str, name: str, *, vertical: bool = False) -> rb.Motion:
    """Return a component of ``motions/near_fault``, alone or with the station's vertical one."""
    motions = rb.read_motions(NEAR_FAULT / folder, vertical=vertical).motions
    return next(motion for motion in motions if motion.name == name)


def cases() -> dict[str, Case]:
    """Return the cases, by their names."""
    blocks = {alpha: rb.Pier(alpha, 1.0) for alpha in (0.05, 0.1, 0.2)}
    tower = rb.Pier(0.15, 0.6)
    made = {
        f"one-sine, alpha {alpha:g}": Case(pier, rb.ElasticBase(beta, 1.0, "finite"), one_sine(pier, amplitude), 3.2)
        for (alpha, pier), beta, amplitude in zip(blocks.items(), (100.0, 80.0, 50.0), (2.0, 2.0, 1.8), strict=True)
    }
    for eta in (2.2, 3.0):
        base = rb.YieldingBase(50.0, 1.0, "finite", eta=eta, spring="epp")
        made[f"one-sine, yielding at {eta:g}"] = Case(blocks[0.2], base, one_sine(blocks[0.2], 1.8), 3.2)
    meloland = record("imperialvalley1979_meloland", "CHAN24")
    made["Meloland 270"] = Case(tower, rb.ElasticBase(60.0, 1.0, "finite"), meloland, 12.0)
    both = record("imperialvalley1979_meloland", "CHAN24", vertical=True)
    made["Meloland 270 with its vertical"] = Case(tower, rb.ElasticBase(60.0, 1.0, "finite"), both, 10.0)
    whole = record("kaikoura2016_wtmc", "20161113_110259_WTMC_20.N28W", vertical=True)
    strong = rb.Motion("Te Mara", whole.dt, whole.horizontal[2300:], whole.vertical[2300:])
    made["Te Mara N28W with its vertical, flying"] = Case(tower, rb.ElasticBase(60.0, 1.0, "finite"), strong, 3.6)
    return made


def model(case: Case) -> None:
    """Build the block, and let it come to rest under its weight."""
    from plane_frame import BEAM, begin, come_to_rest, ops, without_tension

    pier, base = case.pier, case.base
    b, h = pier.half_width, pier.height
    stiffness = 0.5 * (base.beta * pier.p) ** 2
    begin()
    for tag, x, y in ((1, -b, 0.0), (2, -b, 0.0), (3, b, 0.0), (4, b, 0.0), (5, 0.0, h), (6, 0.0, 0.0)):
        ops.node(tag, x, y)
    for tag, fixed in ((1, (1, 1, 1)), (3, (1, 1, 1)), (6, (1, 0, 0))):
        ops.fix(tag, *fixed)
    ops.mass(5, 1.0, 1.0, pier.inertia)
    for tag, (start, end) in enumerate(((6, 5), (2, 6), (6, 4)), start=1):
        ops.element("elasticBeamColumn", tag, start, end, LINK * stiffness * h, 1.0, LINK * stiffness * h**3, BEAM)
    without_tension(1, stiffness, 0.5 * base.eta * pier.gravity if base.yields else None)
    ops.element("zeroLength", 11, 1, 2, "-mat", 1, "-dir", 2)
    ops.element("zeroLength", 12, 3, 4, "-mat", 1, "-dir", 2)
    come_to_rest({5: pier.gravity}, WITHIN)


def history(case: Case, steps: int) -> np.ndarray:
    """Return t, θ, v_L and v_R at each sample of the motion, shape (n, 4), by ``steps`` a sample."""
    from plane_frame import ops, shake, solve

    model(case)
    shake(case.motion.dt, case.motion.horizontal, case.motion.vertical)
    solve("Newmark", 0.5, 0.25, within=WITHIN)
    ops.analysis("Transient")
    rows = np.zeros((case.samples, 4))
    for i in range(1, case.samples):
        assert ops.analyze(steps, case.motion.dt / steps) == 0
        rows[i] = i * case.motion.dt, -ops.nodeDisp(5, 3), ops.nodeDisp(2, 2), ops.nodeDisp(4, 2)
    return rows


def summary(case: Case, rows: np.ndarray) -> list[float]:
    """Return the peak of θ/α, its time, and how deep both pivots were, over δ_s, at the samples in ``rows``."""
    delta = case.pier.gravity / (case.base.beta * case.pier.p) ** 2
    theta = np.abs(rows[:, 1])
    at = int(theta.argmax())
    return [theta[at] / case.pier.alpha, rows[at, 0], -rows[:, 2].min() / delta, -rows[:, 3].min() / delta]


if __name__ == "__main__":
    print(",".join(COLUMNS))
    for name, case in cases().items():
        steps, before = 4, [0.0]
        while True:
            found = summary(case, history(case, steps))
            if abs(found[0] - before[0]) < 1e-4 * found[0]:
                break
            steps, before = 2 * steps, found
        print(",".join([f'"{name}"', *(f"{value:.6g}" for value in found), str(steps)]))
