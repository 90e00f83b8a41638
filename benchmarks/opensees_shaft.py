"""Piers whose shaft bends in OpenSees: a column of finite elements that shares nothing with rockbatch.

    pip install openseespy
    python benchmarks/opensees_shaft.py > benchmarks/opensees_shaft.csv
    python benchmarks/opensees_shaft.py --forces > benchmarks/opensees_shaft_forces.csv
    python benchmarks/opensees_shaft.py --springs > benchmarks/opensees_shaft_on_springs.csv

Twenty corotational beams with masses at their nodes, a mass at the top, a stiff base whose middle cannot move sideways, and under
both its corners a spring of 10⁹ kN/m without tension beside a dashpot. Not damped otherwise: damping by the first stiffness
would resist rotation, too. HHT with α = 0.9 and steps of 0.5 ms, halved where they do not converge. The ground makes one sine.
Rows: case, and the greatest θ [rad] of the first two half cycles, with their times. All modes bend, so that what parts the two
after an impact is the impact and higher modes; tests/verification/test_elastic_shaft.py holds rockbatch against them.
With --forces the columns alone have 1 % of critical damping in their first mode, in proportion to their stiffness, two piers are
added, and rows have the greatest base shear and moment at mid-height of the elements, without the damping force. With --springs
they have both, with that damping, on springs of 3·10⁶ kN/m beside dashpots, on which the corners' contacts stand: a dashpot that
holds on to a corner until its spring is unstressed pulls the foot down as it leaves.
"""

import math
import sys
from typing import NamedTuple

import numpy as np

G, B, HEIGHT, ELEMENTS = 9.81, 4.0, 40.0, 20
CONTACT, STEP, END = 1e9, 5e-4, 8.5
AMPLITUDE, PERIOD = 4.0, 2.0
"""Of the ground's sine [m/s², s]."""


class Case(NamedTuple):
    """Masses of shaft and top [t], and the first period of the column fixed at its foot [s]."""

    shaft: float
    top: float
    period: float


CASES = {
    "tower": Case(3000.0, 1500.0, 0.9),
    "stiff tower": Case(3000.0, 1500.0, 0.4),
    "heavy top": Case(500.0, 4000.0, 1.2),
}
FURTHER = {"even": Case(2000.0, 2000.0, 0.7), "light deck": Case(3000.0, 300.0, 0.9)}
DAMPING = 0.01
"""Of the first mode, where forces are asked for."""


class Ground(NamedTuple):
    """Stiffness under a corner [kN/m], and damping ratio of the vertical vibration on both."""

    stiffness: float = CONTACT
    damping: float = 1.0


SPRINGS = Ground(3e6, 0.3)
COLUMNS = ("case", "first_rad", "t_first_s", "second_rad", "t_second_s")
OF_FORCES = ("case", "base_shear_kN", "moment_kNm")


def build(case: Case, bending: float, ground: Ground | None) -> list[float]:
    """Build the column with a stiffness in bending [kN m²], on its corners or fixed at its foot; return its nodes' masses [t]."""
    import openseespy.opensees as ops

    ops.wipe()
    ops.model("basic", "-ndm", 2, "-ndf", 3)
    ops.geomTransf("Corotational", 1)
    masses = []
    axial = 1e5 * bending / HEIGHT**2
    for i in range(ELEMENTS + 1):
        ops.node(100 + i, 0.0, HEIGHT * i / ELEMENTS)
        ends = i in (0, ELEMENTS)
        masses.append(case.shaft / ELEMENTS * (0.5 if ends else 1.0) + (case.top if i == ELEMENTS else 0.0))
        ops.mass(100 + i, masses[-1], masses[-1], 1e-4 * masses[-1])
        if i > 0:
            ops.element("elasticBeamColumn", 300 + i, 99 + i, 100 + i, axial, 1.0, bending, 1)
    if ground is None:
        ops.fix(100, 1, 1, 1)
        return masses
    ops.fix(100, 1, 0, 0)
    ops.uniaxialMaterial("ENT", 2, CONTACT)
    ops.uniaxialMaterial("Elastic", 3, 1e-9 * CONTACT)  # without it the first tangent is singular
    ops.uniaxialMaterial("Parallel", 1, 2, 3)
    ops.uniaxialMaterial("Elastic", 4, ground.stiffness)
    for j, x in enumerate((-B, B)):
        ops.node(1 + j, x, 0.0)
        ops.node(11 + j, x, 0.0)
        ops.fix(11 + j, 1, 1, 1)
        ops.element("elasticBeamColumn", 400 + j, 100, 1 + j, 100.0 * axial, 1.0, 1e4 * bending, 1)
        below = 11 + j
        if ground.stiffness < CONTACT:
            below = 31 + j
            ops.node(below, x, 0.0)
            ops.fix(below, 1, 0, 1)
            ops.element("zeroLength", 41 + j, 11 + j, below, "-mat", 4, "-dir", 2, "-doRayleigh", 1)
        ops.element("zeroLength", 21 + j, below, 1 + j, "-mat", 1, "-dir", 2, "-doRayleigh", 1)
    by_stiffness = 2.0 * ground.damping / math.sqrt(2.0 * ground.stiffness / (case.shaft + case.top))
    damped = (41, 42) if ground.stiffness < CONTACT else (21, 22)
    ops.region(1, "-ele", *damped, "-rayleigh", 0.0, by_stiffness, 0.0, 0.0)
    return masses


def solve(integrator: str, *parameters: float) -> None:
    """Choose how OpenSees solves each step."""
    import openseespy.opensees as ops

    ops.constraints("Plain")
    ops.numberer("RCM")
    ops.system("BandGeneral")
    ops.test("NormDispIncr", 1e-9, 30)
    ops.algorithm("Newton")
    ops.integrator(integrator, *parameters)


def advance(step: float, halvings: int = 0) -> None:
    """Take a step [s], in halves where it does not converge."""
    import openseespy.opensees as ops

    for algorithm in ("Newton", "KrylovNewton"):
        ops.algorithm(algorithm)
        if ops.analyze(1, step) == 0:
            return
    assert halvings < 10
    advance(0.5 * step, halvings + 1)
    advance(0.5 * step, halvings + 1)


def follow(case: Case, damping: float, step: float, under: Ground) -> np.ndarray:
    """Return t [s], θ [rad], base shear [kN] and moment at mid-height [kN m] after each step, shape (n, 4)."""
    import openseespy.opensees as ops

    build(case, 1e6, None)
    frequency = math.sqrt(ops.eigen("-fullGenLapack", 1)[0])
    masses = build(case, 1e6 * (2.0 * math.pi / case.period / frequency) ** 2, under)
    if damping:
        by_stiffness = damping * case.period / math.pi
        ops.region(2, "-ele", *range(301, 301 + ELEMENTS), "-rayleigh", 0.0, by_stiffness, 0.0, 0.0)
    ops.timeSeries("Linear", 1)
    ops.pattern("Plain", 1, 1)
    for i, mass in enumerate(masses):
        ops.load(100 + i, 0.0, -mass * G, 0.0)
    solve("LoadControl", 0.1)
    ops.analysis("Static")
    assert ops.analyze(10) == 0
    ops.loadConst("-time", 0.0)
    ops.wipeAnalysis()
    t = np.arange(0.0, END, 0.005)
    ground = AMPLITUDE * np.sin(2.0 * math.pi * t / PERIOD) * (t < PERIOD)
    ops.timeSeries("Path", 2, "-dt", 0.005, "-values", *ground.tolist())
    ops.pattern("UniformExcitation", 2, 1, "-accel", 2)
    solve("HHT", 0.9)
    ops.analysis("Transient")
    rows = np.zeros((round(END / step), 4))
    for k in range(len(rows)):
        advance(step)
        foot, middle = ops.eleForce(301), ops.eleForce(300 + ELEMENTS // 2)
        rows[k] = (k + 1) * step, -ops.nodeDisp(100, 3), foot[0], middle[5]
    return rows


def extremes(rows: np.ndarray) -> list[float]:
    """Return the greatest |θ| to the left, and then to the right, with their times: the ground goes to the right first."""
    t, theta = rows.T[:2]
    second = int(theta.argmax())
    first = int(theta[:second].argmin())
    return [abs(theta[first]), t[first], theta[second], t[second]]


def main() -> None:
    """Print the table."""
    if sys.argv[1:] == ["--forces"]:
        print(",".join(OF_FORCES))
        for name, case in (CASES | FURTHER).items():
            print(
                ",".join(
                    [
                        name,
                        *(f"{value:.5g}" for value in abs(follow(case, DAMPING, 0.5 * STEP, Ground())).max(axis=0)[2:]),
                    ]
                )
            )
        return
    if sys.argv[1:] == ["--springs"]:
        print(",".join((*COLUMNS, *OF_FORCES[1:])))
        for name, case in (CASES | FURTHER).items():
            rows = follow(case, DAMPING, STEP, SPRINGS)
            values = *extremes(rows), *abs(rows).max(axis=0)[2:]
            print(",".join([name, *(f"{value:.5g}" for value in values)]), flush=True)
        return
    print(",".join(COLUMNS))
    for name, case in CASES.items():
        print(",".join([name, *(f"{value:.5g}" for value in extremes(follow(case, 0.0, STEP, Ground())))]))


if __name__ == "__main__":
    main()
