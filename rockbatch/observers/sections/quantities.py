"""Demands in sections of the shaft, which are no columns of peaks.csv."""

import numpy as np

from rockbatch.quantities.arrays import Rows
from rockbatch.quantities.cases import Case
from rockbatch.quantities.demands import Demand, Estimated, Evaluate, largest, magnitude


def _axial(sign: float) -> Evaluate:
    """Return the evaluation of the greatest compression (``sign`` 1) or tension (−1) in a section [kN]; 0 if it has none."""
    columns = ("section_axial_least_kN", "section_axial_greatest_kN")

    def evaluate(runs: Rows, case: Case) -> Estimated:
        least, greatest = (sign * runs.numbers(name) for name in columns)
        error = magnitude(runs, columns) * runs.numbers("sections_error")
        return Estimated(np.maximum(np.maximum(least, greatest), 0.0), error)

    return evaluate


def _in_section(name: str, meaning: str, evaluate: Evaluate | None = None, unit: str = "kN") -> Demand:
    """Return a demand on a section of the shaft; the largest of its column unless ``evaluate`` says otherwise.

    Bending is across the axis: axial forces, which ``evaluate`` gives, have none of it, and the weight in them on either axis.
    """
    return Demand(
        name,
        meaning,
        evaluate or largest((name,), share="sections_error"),
        unit,
        needs="sections",
        weighed=True,
        landing=True,
        bending=evaluate is None,
        directed=evaluate is None,
    )


DEMANDS = (
    _in_section("section_shear_kN", "greatest shear in a section of the shaft, across its axis"),
    _in_section("section_moment_kNm", "greatest moment in a section of the shaft", unit="kN m"),
    _in_section("section_axial_kN", "greatest compression of a section of the shaft", _axial(1.0)),
    _in_section("section_tension_kN", "greatest tension of a section of the shaft, 0 if it has none", _axial(-1.0)),
)
