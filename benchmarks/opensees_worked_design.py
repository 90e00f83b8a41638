"""The worked design in OpenSees: its parts on strips that push and never pull, which share nothing with rockbatch.

    pip install openseespy
    python benchmarks/opensees_worked_design.py > benchmarks/opensees_worked_design.csv
    python benchmarks/opensees_worked_design.py --beside        # beside rockbatch, without OpenSees: the table of the page

The study gives masses, bed, dampers and scaled records. Parts of the pier are masses on a stiff column of corotational beams, cut
where forces are asked for, on a stiff bar. Under the bar are 40 strips, drawn apart until they have the rocking stiffness of
the bed: a spring beside a dashpot, and below them one of 200 times its stiffness that pushes only and yields, so that the whole
stays between nothing and the strength. The dampers are Bouc-Wen springs, n = 5. Newmark's average acceleration.
Rows: bound, record, and the greatest of each quantity in the strong part of the records that govern, by steps of 5 and 2.5 ms,
extrapolated; `steps_differ` has the greatest relative change from the one to the other.
tests/verification/test_worked_design.py holds rockbatch against them.
"""

import csv
import math
import sys
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

import numpy as np

import rockbatch as rb
from rockbatch.study.suite import ground_motions

STUDY = Path(__file__).parents[1] / "configs" / "worked_design.toml"
G, STRIPS, GAP, LINK, WITHIN = 9.81, 40, 200.0, 1e4, 1e-9
"""GAP: stiffness of the spring that pushes only over that beside the dashpot; LINK: of the links over the bed; displacements
converge to WITHIN [m]."""

TABLE = Path(__file__).with_suffix(".csv")
NAMES = {"CHAN15_az035": "Meloland", "20161113_110300_HSES_20_az035": "Hanmer Springs"}
WINDOWS = {"CHAN15_az035": (2.5, 22.5), "20161113_110300_HSES_20_az035": (48.0, 68.0)}
"""Parts of the records that govern, from and to [s]."""
RUNS = (
    ("", "CHAN15_az035"),
    ("", "20161113_110300_HSES_20_az035"),
    ("soft ground", "CHAN15_az035"),
    ("stiff ground", "20161113_110300_HSES_20_az035"),
    ("strong ground", "20161113_110300_HSES_20_az035"),
)
"""Bounds and records that are compared: nominal, and those that govern drift, stroke and push, and moments."""
STEP = 0.005
"""Longest step [s]."""

GROUND, MIDDLE, FOOT, EDGE, COLUMN = 1000, 2000, 3000, 4000, 1
QUANTITIES = (
    "theta_max_rad",
    "damper_stroke_m",
    "edge_depth_m",
    "bed_force_over_weight",
    "base_shear_kN",
    "base_moment_kNm",
    "section_moment_kNm",
    "section_moment_at_mid_height_kNm",
)
COLUMNS = ("bound", "record", *QUANTITIES, "steps_differ")


class Model(NamedTuple):
    """A pier on its bed, in kN, m and s; ``sections`` are heights, the lowest first."""

    pier: rb.Pier
    base: rb.FootingBase
    sections: tuple[float, ...]

    @property
    def weight(self) -> float:
        """Return the weight [kN]."""
        assert self.pier.mass_t is not None
        return self.pier.mass_t * G

    @property
    def stiffness(self) -> float:
        """Return the vertical stiffness of the bed [kN/m]."""
        return (self.base.beta * self.pier.p) ** 2 * self.weight / G

    @property
    def strength(self) -> float:
        """Return the strength of the bed [kN]."""
        assert self.base.safety_factor is not None
        return self.base.safety_factor * self.weight


def masses(model: Model) -> list[tuple[float, float, float]]:
    """Return height [m], mass [t] and rotary inertia [t m²] of all parts, cut at the sections."""
    points = []
    for part in model.pier.parts:
        length = part.length_m or 0.0
        low, high = part.height_m - 0.5 * length, part.height_m + 0.5 * length
        ends = [low, *(z for z in model.sections if low < z < high), high]
        across = part.inertia_t_m2 - part.mass_t * length**2 / 12.0
        for start, end in pairwise(ends) if length else [(low, high)]:
            share = (end - start) / length if length else 1.0
            mass = share * part.mass_t
            points.append((0.5 * (start + end), mass, share * across + mass * (end - start) ** 2 / 12.0))
    return points


def column(
    points: list[tuple[float, float, float]], sections: tuple[float, ...], links: tuple[float, ...]
) -> list[int]:
    """Build the column, and return the elements above the foot and above each section."""
    from plane_frame import ops

    heights = sorted({0.0, *sections, *(z for z, _, _ in points)})
    for tag, z in enumerate(heights, start=COLUMN):
        ops.node(tag, 0.0, z)
    ops.fix(COLUMN, 1, 0, 0)
    for z, mass, inertia in points:
        ops.mass(COLUMN + heights.index(z), mass, mass, inertia)
    for tag in range(COLUMN, COLUMN + len(heights) - 1):
        ops.element("elasticBeamColumn", tag, tag, tag + 1, *links)
    return [COLUMN + heights.index(z) for z in (0.0, *sections)]


def bed(model: Model, links: tuple[float, ...]) -> np.ndarray:
    """Build the strips under a bar between the places of the dampers, and return the places of the strips."""
    from plane_frame import ops

    b, one = model.pier.half_width, model.stiffness / STRIPS
    dashpot = 2.0 * model.base.zeta * math.sqrt(model.stiffness * model.weight / G) / STRIPS
    ops.uniaxialMaterial("Elastic", 10, one * GAP / (GAP - 1.0))
    ops.uniaxialMaterial("Viscous", 11, dashpot, 1.0)
    ops.uniaxialMaterial("Parallel", 12, 10, 11)
    ops.uniaxialMaterial("ElasticPPGap", 13, GAP * one, -model.strength / STRIPS, 0.0, 0.0, "damage")
    ops.uniaxialMaterial("Elastic", 14, 1e-7 * one)
    ops.uniaxialMaterial("Parallel", 15, 13, 14)
    places = b * ((2.0 * np.arange(STRIPS) + 1.0) / STRIPS - 1.0) / math.sqrt(1.0 - 1.0 / STRIPS**2)
    bar = [(0.0, COLUMN), (-b, EDGE), (b, EDGE + 1)]
    for side, edge in ((-1.0, EDGE), (1.0, EDGE + 1)):
        ops.node(edge, side * b, 0.0)
        ops.node(edge + 10, side * b, 0.0)
        ops.fix(edge + 10, 1, 1, 1)
    for i, x in enumerate(places.tolist()):
        for first, held in ((GROUND, (1, 1, 1)), (MIDDLE, (1, 0, 1)), (FOOT, (0, 0, 0))):
            ops.node(first + i, x, 0.0)
            ops.fix(first + i, *held)
        ops.element("zeroLength", GROUND + i, GROUND + i, MIDDLE + i, "-mat", 12, "-dir", 2)
        ops.element("zeroLength", MIDDLE + i, MIDDLE + i, FOOT + i, "-mat", 15, "-dir", 2)
        bar.append((x, FOOT + i))
    for tag, ((_, start), (_, end)) in enumerate(pairwise(sorted(bar)), start=2 * EDGE):
        ops.element("elasticBeamColumn", tag, start, end, *links)
    return places


def build(model: Model) -> tuple[list[int], np.ndarray]:
    """Build the pier, let it come to rest, and fix its dampers; return its elements of interest and the places of the strips."""
    from plane_frame import BEAM, begin, come_to_rest, ops

    begin()
    points = masses(model)
    high = max(z for z, _, _ in points)
    links = (LINK * model.stiffness * high, 1.0, LINK * model.stiffness * high**3, BEAM)
    elements, places = column(points, model.sections, links), bed(model, links)
    heights = sorted({0.0, *model.sections, *(z for z, _, _ in points)})
    come_to_rest({COLUMN + heights.index(z): mass * G for z, mass, _ in points}, WITHIN)
    (damper,) = model.base.restraints
    slope = 1.0 / damper.yield_m  # the hysteretic variable is the force over that at yield
    ops.uniaxialMaterial(
        "BoucWen", 20, 0.0, damper.f * model.weight, 5.0, 0.5 * slope, 0.5 * slope, slope, 0.0, 0.0, 0.0
    )
    for edge in (EDGE, EDGE + 1):  # an element has no force in the place in which it is put
        ops.element("zeroLength", edge + 100, edge + 10, edge, "-mat", 20, "-dir", 2)
    return elements, places


class Extremes:
    """The greatest of each quantity, brought up to every step."""

    def __init__(self, model: Model, elements: list[int], places: np.ndarray) -> None:
        from plane_frame import ops

        self.model, self.elements = model, elements
        self.strips = [GROUND + i for i in range(STRIPS)]
        self.at_rest = [ops.nodeDisp(edge, 2) for edge in (EDGE, EDGE + 1)]
        self.values = dict.fromkeys(QUANTITIES, 0.0)

    def include(self) -> None:
        """Bring them up to the present step."""
        from plane_frame import ops

        model, now = self.model, {}
        low = [ops.nodeDisp(edge, 2) for edge in (EDGE, EDGE + 1)]
        forces = [ops.eleForce(element) for element in self.elements]
        now["theta_max_rad"] = abs(ops.nodeDisp(COLUMN, 3))
        now["damper_stroke_m"] = max(abs(z - rest) for z, rest in zip(low, self.at_rest, strict=True))
        now["edge_depth_m"] = -min(low)
        now["bed_force_over_weight"] = sum(ops.eleForce(strip, 2) for strip in self.strips) / model.weight
        now["base_shear_kN"], now["base_moment_kNm"] = abs(forces[0][0]), abs(forces[0][2])
        now["section_moment_kNm"], now["section_moment_at_mid_height_kNm"] = (abs(force[2]) for force in forces[1:])
        for name, value in now.items():
            self.values[name] = max(self.values[name], value)


def advance(step: float, halvings: int = 6) -> None:
    """Take a step by Newton's method, else by Krylov's subspaces, else by two of half the length."""
    from plane_frame import ops

    for algorithm in ("Newton", "KrylovNewton"):
        ops.algorithm(algorithm)
        if ops.analyze(1, step) == 0:
            return
    assert halvings > 0
    for _ in range(2):
        advance(0.5 * step, halvings - 1)


def greatest(model: Model, motion: rb.Motion, steps: int) -> np.ndarray:
    """Return the greatest of each quantity in the motion, by ``steps`` a sample."""
    from plane_frame import ops, shake, solve

    extremes = Extremes(model, *build(model))
    shake(motion.dt, motion.horizontal)
    solve("Newmark", 0.5, 0.25, within=WITHIN)
    ops.analysis("Transient")
    for _ in range((motion.npts - 1) * steps):
        advance(motion.dt / steps)
        extremes.include()
    return np.array(list(extremes.values.values()))


def runs(study: rb.Study) -> Iterator[tuple[str, str, Model, rb.Motion]]:
    """Yield bound and record of each run with its model and the strong part of the scaled record."""
    heights = tuple(check.at_m for check in study.checks if check.capacity)
    of_bound = {str(case.columns["bound"]): case for case in study.cases}
    of_record = {motion.name: motion for motion in ground_motions(study).motions}
    for bound, record in RUNS:
        case, motion = of_bound[bound], of_record[record]
        first, last = (round(t / motion.dt) for t in WINDOWS[record])
        strong = rb.Motion(record, motion.dt, motion.horizontal[first:last])
        yield bound, record, Model(case.pier, case.base, heights), strong


def own(model: Model, motion: rb.Motion) -> list[float]:
    """Return the same by rockbatch, the quantities in their order."""
    response = rb.simulate(model.pier, model.base, motion, forces=True, sections=model.sections)
    row, history, b = response.row, response.history, model.pier.half_width
    depth = float((b * history["theta"].abs() - history["v"]).max())
    moments = response.sections["section_moment_kNm"]
    at_mid_height = moments.iloc[1]
    return [
        row["theta_max_over_alpha"] * model.pier.alpha,
        row["damper_stroke_m"],
        depth,
        row["bed_force_over_weight"],
        row["base_shear_kN"],
        row["base_moment_kNm"],
        moments.iloc[0],
        at_mid_height,
    ]


def beside() -> Iterator[tuple[str, str, list[float], list[float]]]:
    """Yield bound and record of each run with the quantities by rockbatch and, from the table, by OpenSees."""
    with TABLE.open(encoding="utf-8") as file:
        rows = {(row["bound"], row["record"]): row for row in csv.DictReader(file)}
    for bound, record, model, motion in runs(rb.load_study(STUDY)):
        yield bound, record, own(model, motion), [float(rows[bound, record][name]) for name in QUANTITIES]


def show() -> None:
    """Print the table of the page."""
    units = (1e3, 1e3, 1e3, 1.0, 1e-3, 1e-3, 1e-3, 1e-3)
    for bound, record, ours, theirs in beside():
        pairs = (f"{a * unit:.4g} / {b * unit:.4g}" for a, b, unit in zip(ours, theirs, units, strict=True))
        print(f"| {bound or 'nominal'}, {NAMES[record]} | {' | '.join(pairs)} |")


def main() -> None:
    """Print a row for each record and bound."""
    if sys.argv[1:] == ["--beside"]:
        return show()
    print(",".join(COLUMNS))
    for bound, record, model, motion in runs(rb.load_study(STUDY)):
        steps = round(motion.dt / STEP)
        coarse, fine = (greatest(model, motion, n) for n in (steps, 2 * steps))
        differ = np.max(np.abs(fine - coarse) / np.maximum(fine, 1e-9))
        values = ",".join(f"{value:.6g}" for value in fine + (fine - coarse) / 3.0)
        print(f"{bound},{record},{values},{differ:.2g}", flush=True)
        print(f"{bound or 'nominal'}, {record}: {coarse} {fine}", file=sys.stderr, flush=True)


if __name__ == "__main__":
    main()
