"""Demands: what a check may limit, and how the rows of peaks.csv and a case of run.json give it.

Rotations are small: the heel of a pier that tilts by θ stands 2 b θ above its toe, and its top moves by its height times θ.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from rockbatch.pier import tilt_over_residual
from rockbatch.quantities.arrays import Rows
from rockbatch.quantities.cases import ONE, Case, Lever, alpha, bends, holds_a_tilt, width
from rockbatch.quantities.statistics import Values

FORCES = "base_shear_m_s2"
"""A column that every run with forces has."""


class Estimated(NamedTuple):
    """Values of a demand, shape (n,), and their estimated errors; NaN if unknown."""

    value: Values
    error: Values


Evaluate = Callable[[Rows, Case], Estimated]


class Ceiling(NamedTuple):
    """A value of the case beyond which a limit says nothing, such as that at θ = α, and words for it."""

    value: Lever
    beyond: str


@dataclass(frozen=True)
class Demand:
    """A quantity that a check limits; the less the better, but for those of the case.

    Attributes
    ----------
    name : str
        By which a rule calls it; it ends with the unit.
    meaning, unit : str
        Its meaning, and its unit as people write it; "" is none.
    evaluate : function
        Its values from the rows of one case, n of them, and the case.
    bases : tuple of str
        Bases to which it applies; "held" stands for every base on which dampers may hold the pier at a tilt.
    event : bool
        True for an outcome of a run, 1 or 0.
    per_case : bool
        True if it is the same for all records.
    residual : bool
        True if it is what remains after a motion.
    other_law : function or None
        Values by the other spring law, shape (n,); the worse counts.
    ceiling : Ceiling or None
        Value beyond which a limit says nothing.
    verb : str
        Of an event: the words for a record that causes it.
    needs : "", "forces", "rocking" or "sections"
        Key of [output] that brings the columns it takes; those of "sections" are of sections.csv, at the height of the check.
    weighed : bool
        True if it takes the mass of the pier.
    device : "", "damper", "tendon", "yielding tendon", "stop" or "deck_spring"
        Device that the pier has to have.
    reached : function or None
        Values that runs had reached when their motion ended, n of them, with errors: lower bounds for those that failed later.
    height : function or None
        Of a case: the height above the pivots at which it is read [m].
    landing, bending : bool
        True if the blow of a landing, or the bending of the shaft, enters it (THEORY.md, Forces).
    """

    name: str
    meaning: str
    evaluate: Evaluate
    unit: str = ""
    bases: tuple[str, ...] = ("rigid", "elastic", "yielding", "footing")
    event: bool = False
    per_case: bool = False
    residual: bool = False
    other_law: Callable[[Rows, Case], Values] | None = None
    ceiling: Ceiling | None = None
    verb: str = ""
    needs: str = ""
    weighed: bool = False
    device: str = ""
    reached: Evaluate | None = None
    height: Lever | None = None
    landing: bool = False
    bending: bool = False

    def applies_to(self, case: Case) -> bool:
        """Return True if it applies to the base of a case."""
        held = "held" in self.bases and holds_a_tilt(case)
        return case["base"] in self.bases or held or ("bending" in self.bases and bends(case))

    @property
    def words(self) -> str:
        """Its meaning with its unit in brackets."""
        return f"{self.meaning} [{self.unit}]" if self.unit else self.meaning

    @property
    def per_run(self) -> bool:
        """Whether every run has this quantity, so that it is uncertain for a run that was cut short."""
        return not (self.event or self.per_case)


def without_error(value: Values) -> Estimated:
    """Return values whose errors are unknown."""
    return Estimated(value, np.full(len(value), np.nan))


def largest(columns: tuple[str, ...], times: Lever = ONE, error: str = "", share: str = "") -> Evaluate:
    """Return the largest magnitude of some columns times a factor of the case.

    ``error`` is the column of its error, times the factor too, or ``share`` that of its error as a share of itself.
    """

    def evaluate(runs: Rows, case: Case) -> Estimated:
        value = times(case) * _magnitude(runs, columns)
        return Estimated(value, value * runs.numbers(share) if share else times(case) * runs.numbers(error))

    return evaluate


def _magnitude(runs: Rows, columns: tuple[str, ...]) -> Values:
    return np.maximum.reduce([np.abs(runs.numbers(name)) for name in columns])


def largest_force(columns: tuple[str, ...], times: Lever, share: str) -> Evaluate:
    """Return the largest of some columns of forces, times a factor of the case.

    0 for a run with forces that has none of this, such as no impact; unknown if an earlier version wrote no such column.
    """

    def evaluate(runs: Rows, case: Case) -> Estimated:
        value = _magnitude(runs, columns)
        if all(name in runs for name in columns):
            value = np.where(np.isnan(value) & ~np.isnan(runs.numbers(FORCES)), 0.0, value)
        value = times(case) * value
        return Estimated(value, value * runs.numbers(share))

    return evaluate


def axial(sign: float) -> Evaluate:
    """Return the greatest axial force in a section [kN], compression with ``sign`` 1, tension with −1; 0 if it has none."""
    columns = ("section_axial_least_kN", "section_axial_greatest_kN")

    def evaluate(runs: Rows, case: Case) -> Estimated:
        least, greatest = (sign * runs.numbers(name) for name in columns)
        error = _magnitude(runs, columns) * runs.numbers("sections_error")
        return Estimated(np.maximum(np.maximum(least, greatest), 0.0), error)

    return evaluate


OF_SECTIONS = {
    "height_m": "height of the section above the pivots [m]",
    "section_shear_m_s2": "greatest shear across the axis, over the mass of the pier [m/s²]",
    "section_moment_m2_s2": "greatest moment about the middle of the section, over the mass of the pier [m²/s²]",
    "section_axial_least_m_s2": "least axial force, positive in compression, over the mass of the pier [m/s²]",
    "section_axial_greatest_m_s2": "greatest axial force, likewise [m/s²]",
    "section_axial_at_moment_m_s2": "axial force when the moment is greatest, likewise [m/s²]",
    "section_shear_kN": "greatest shear across the axis [kN]; this and the following if mass_t is given",
    "section_moment_kNm": "greatest moment about the middle of the section [kN m]",
    "section_axial_least_kN": "least axial force, positive in compression [kN]",
    "section_axial_greatest_kN": "greatest axial force, likewise [kN]",
    "section_axial_at_moment_kN": "axial force when the moment is greatest, likewise [kN]",
    "sections_error": "largest relative error of shear, moment and axial extremes: four times the change when the step was "
    "halved; empty with a fixed step",
}
"""Columns of sections.csv behind those that name the run, with their meanings."""


def in_section(name: str, meaning: str, evaluate: Evaluate | None = None) -> Demand:
    """Return a demand on a section of the shaft, in kN or kN m; the largest of its column unless ``evaluate`` says otherwise.

    Bending is across the axis: axial forces, which ``evaluate`` gives, have none of it.
    """
    unit = "kN m" if name.endswith("kNm") else "kN"
    return Demand(
        name,
        meaning,
        evaluate or largest((name,), share="sections_error"),
        unit,
        needs="sections",
        weighed=True,
        landing=True,
        bending=evaluate is None,
    )


def in_flight(column: str) -> Evaluate:
    """Return a column of flights; 0 for a run that went through and has none."""

    def evaluate(runs: Rows, case: Case) -> Estimated:
        value, status = runs.numbers(column), runs.texts("status")
        went_through = (status == "ok") | (status == "overturned")
        absent = np.isnan(value) & np.isnan(runs.numbers("flight_s")) & went_through
        return without_error(np.where(absent, 0.0, value))

    return evaluate


def tilt(times: Lever) -> Evaluate:
    """Return the tilt of the base times a factor; its error is that of the residual rotation, to which it is proportional."""

    def evaluate(runs: Rows, case: Case) -> Estimated:
        pier = case["pier"]
        ratio = tilt_over_residual(
            pier["gravity"], pier["height_m"], pier["half_width_m"], case["parameters"]["omega_v"]
        )
        error = alpha(case) * float(ratio) * runs.numbers("theta_res_error")
        return Estimated(times(case) * np.abs(runs.numbers("base_tilt_rad")), times(case) * error)

    return evaluate


def toe_settlement(runs: Rows, case: Case) -> Estimated:
    """Return the settlement of the support that has settled more; its error is that of the mean and half of the difference."""
    of_difference = tilt(width)(runs, case).error
    return Estimated(toe("settlement_m")(runs, case), runs.numbers("settlement_error_m") + 0.5 * of_difference)


def toe(settlement: str) -> Callable[[Rows, Case], Values]:
    """Return the settlement of the support that has settled more: the mean and half of the difference."""
    return lambda runs, case: runs.numbers(settlement) + 0.5 * width(case) * np.abs(runs.numbers("base_tilt_rad"))


def event(name: str, meaning: str, happened: Callable[[Rows], npt.NDArray[np.bool_]], verb: str) -> Demand:
    """Return a demand that is 1 for a run in which something happened."""
    return Demand(
        name,
        meaning,
        lambda runs, case: without_error(happened(runs).astype(np.float64)),
        event=True,
        verb=verb,
    )


def parameter(
    name: str, meaning: str, unit: str, bases: tuple[str, ...], ceiling: Ceiling | None = None, of: str = ""
) -> Demand:
    """Return a parameter of the case, ``of`` this name if not the same; NaN if it is missing, as a force if no mass is known."""

    def evaluate(runs: Rows, case: Case) -> Estimated:
        return without_error(np.array([float(case["parameters"].get(of or name, np.nan))]))

    return Demand(name, meaning, evaluate, unit, bases, per_case=True, ceiling=ceiling)
