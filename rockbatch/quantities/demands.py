"""Demands: quantities that a check may limit, evaluated from rows of peaks.csv and a case of run.json.

Rotations are small: the heel of a pier that tilts by θ stands 2 b θ above its toe, and its top moves by its height times θ.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from rockbatch.common.units import with_unit
from rockbatch.pier import tilt_over_residual
from rockbatch.quantities.arrays import Rows
from rockbatch.quantities.cases import ONE, Case, Condition, Lever, alpha, bends, has_device, holds_a_tilt, width
from rockbatch.quantities.statistics import Values

AT_HEIGHTS = {"sections": "sections = 5", "interaction": "interaction_m = [0.0]"}
"""Tables that demands in sections of the shaft need, and the line under [output] that brings each."""

OF_BASE = "interaction_base"
"""Key of [output] for shear and normal force of the base at the same moment."""

FORCES = "base_shear_m_s2"
"""A column that every run with forces has."""


class Estimated(NamedTuple):
    """Values of a demand, shape (n,), and their estimated errors; NaN if unknown, and an infinite error of a lower bound."""

    value: Values
    error: Values


Evaluate = Callable[[Rows, Case], Estimated]


class Ceiling(NamedTuple):
    """A value of the case beyond which a limit decides nothing, such as that at θ = α, words for it, and what to do instead.

    ``unreachable`` if no run exceeds it, so that a check with a limit beyond it does not apply to the case.
    """

    value: Lever
    beyond: str
    remedy: str = "check the unit"
    unreachable: bool = False


class OtherEnd(NamedTuple):
    """The other end of a demand's range: its values in the same runs by another model, which an observer brings.

    ``column`` of peaks.csv has them, with the key ``needs`` of [output], and ``evaluate`` returns the demand by them, shape (n,),
    for a case that ``has_range``. With the key ``asked_by`` of a check nothing passes without them. ``model`` and ``models`` are
    the words for one model, and for both.
    """

    column: str
    needs: str
    asked_by: str
    evaluate: Callable[[Rows, Case], Values]
    has_range: Callable[[Case], bool]
    model: str
    models: str


@dataclass(frozen=True, kw_only=True)
class Facts:
    """Facts about a quantity that the demands on it share."""

    # key of [output] that brings it: "forces", "rocking", OF_BASE, or one of AT_HEIGHTS; empty if none does
    needs: str = ""
    device: str = ""  # kind of device that brings it, one of :attr:`Device.kinds`; empty if none does
    weighed: bool = False  # true if it takes the mass of the pier
    # true if the blow of a landing enters it (THEORY.md, Forces): on rigid ground, where that is an impulse, it is a lower bound
    landing: bool = False
    bending: bool = False  # true if the bending of the shaft enters it, which a rigid shaft leaves out
    pointwise: bool = False  # true if it is an acceleration of one point of the shaft
    # true if it leaves out moments with a normal force below [output] least_normal_share of the weight
    while_pressed: bool = False
    # True if each axis of the pier has one by itself, so that those of two axes add up. Of others, such as settlements, axial
    # forces and counts, which have the weight or the whole pier in them on either axis, the greater counts.
    directed: bool = False
    settlement: bool = False  # true if it is a settlement of the supports
    yielding: bool = False  # true if supports that go on yielding raise it
    cumulative: bool = False  # true if it grows until the run ends, when its peak is decided
    # cases in which landings after the greatest rotation may raise it; None by its kind (:meth:`Demand.grows_with_landings`)
    later: Callable[[Case], bool] | None = None
    condition: Condition | None = None  # what a case of its bases must have for it to be anything but 0


@dataclass(frozen=True)
class Demand(Facts):
    """A quantity that a check limits; less is better, except for properties of the case."""

    name: str  # by which a rule calls it; it ends with the unit
    meaning: str
    evaluate: Evaluate  # its values from the rows of one case, n of them, and the case
    unit: str = ""  # as people write it; "" is none
    # bases to which it applies; "held" stands for every base on which dampers may hold the pier at a tilt
    bases: tuple[str, ...] = ("rigid", "elastic", "yielding", "footing")
    event: bool = False  # true for an outcome of a run, 1 or 0
    per_case: bool = False  # true if it is the same for all records
    residual: bool = False  # true if it is what remains after a motion
    other_end: OtherEnd | None = None  # the other end of its range, where two models give one; the worse counts
    ceiling: Ceiling | None = None  # value beyond which a limit decides nothing
    verb: str = ""  # of an event: the words for a record that causes it
    # values that runs had reached when their motion ended, n of them, with errors: lower bounds for those that failed later
    reached: Evaluate | None = None
    height: Lever | None = None  # of a case: the height above the pivots at which it is read [m]
    over_capacity: bool = False  # true for a share of a capacity that depends on the axial force, which a check states

    def applies_to(self, case: Case) -> bool:
        """Return whether the demand applies to a case."""
        return not self.why_absent(case)

    def why_absent(self, case: Case) -> str:
        """Return why the demand does not apply to a case: its base, device, or ``condition``; "" if it does.

        Of ``bases``, "held" stands for dampers that hold a tilt, "bending" for a shaft that bends.
        """
        held = "held" in self.bases and holds_a_tilt(case)
        if not (case["base"] in self.bases or held or ("bending" in self.bases and bends(case))):
            return f"{'an' if case['base'] == 'elastic' else 'a'} {case['base']} base has no {self.name}"
        if self.device and not has_device(case, self.device):
            return f"the pier has no {self.device}"
        return self.condition.lack if self.condition and not self.condition.holds(case) else ""

    @property
    def in_section(self) -> bool:
        """True if it is about a section of the shaft, at the height of the check."""
        return self.needs in AT_HEIGHTS

    def grows_with_landings(self, case: Case) -> bool:
        """Return whether landings after the greatest rotation may raise it in a case.

        They do if it has no cases of its own (``later``): forces, speeds, what devices do, and what grows until the run ends.
        """
        if self.later is not None:
            return self.later(case)
        return self.landing or self.cumulative or self.needs == "forces" or self.in_section or bool(self.device)

    @property
    def brings(self) -> set[str]:
        """Keys of [output] that a check of it switches on: that of the other end of its range, if any, else OF_BASE if needed.

        Other keys that it ``needs`` have to be in the study.
        """
        return {self.other_end.needs} if self.other_end else {self.needs} & {OF_BASE}

    @property
    def words(self) -> str:
        """The meaning, with the unit in brackets if there is one."""
        return with_unit(self.meaning, self.unit)

    @property
    def of_motion(self) -> bool:
        """True for what the motion of a pier decides: no property of the case, nor whether a run came to an end."""
        return not self.per_case and self.name != "failed"

    @property
    def per_run(self) -> bool:
        """True for a quantity of every run, which is uncertain for a run that was cut short."""
        return not (self.event or self.per_case)


def without_error(value: Values) -> Estimated:
    """Return values with unknown errors."""
    return Estimated(value, np.full(len(value), np.nan))


def largest(columns: tuple[str, ...], times: Lever = ONE, error: str = "", share: str = "") -> Evaluate:
    """Return the evaluation of the largest magnitude of some columns times a factor of the case.

    ``error`` is the column of its error, to be multiplied by the factor too, or ``share`` that of its relative error; without
    either the error is NaN. The value is NaN where one of the columns is.
    """

    def evaluate(runs: Rows, case: Case) -> Estimated:
        value = times(case) * magnitude(runs, columns)
        return Estimated(value, value * runs.numbers(share) if share else times(case) * runs.numbers(error))

    return evaluate


def magnitude(runs: Rows, columns: tuple[str, ...]) -> Values:
    return np.maximum.reduce([np.abs(runs.numbers(name)) for name in columns])


def largest_force(columns: tuple[str, ...], times: Lever, share: str) -> Evaluate:
    """Return the evaluation of the largest magnitude of some columns of forces, times a factor of the case.

    ``share`` is the column of its relative error. The value is 0 for a run with forces but without this one, such as one
    without impacts; NaN in results of an earlier version without the column.
    """

    def evaluate(runs: Rows, case: Case) -> Estimated:
        value = magnitude(runs, columns)
        if all(name in runs for name in columns):
            value = np.where(np.isnan(value) & ~np.isnan(runs.numbers(FORCES)), 0.0, value)
        value = times(case) * value
        return Estimated(value, value * runs.numbers(share))

    return evaluate


SECTIONS, INTERACTION = "sections.csv", "interaction.csv"
"""Tables of forces in sections beside peaks.csv."""

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

OF_INTERACTION = {
    "height_m": "height of the section above the pivots [m]; empty for the base",
    "axial_kN": "axial force of the section, or normal force of the base, positive in compression [kN], ascending",
    "moment_kNm": "greatest moment about the middle of the section beside it [kN m]; empty for the base",
    "shear_kN": "greatest shear of the base beside it, along the ground [kN]; empty for a section",
    "interaction_error": "error of all corners of a section, over its greatest axial force and moment, or of the base likewise: "
    "four times the change when the step was halved, and what leaving corners out may change; empty with a fixed step",
}
"""Columns of interaction.csv behind those that name the run, with their meanings: corners of envelopes of sections and bases."""


def in_flight(column: str) -> Evaluate:
    """Return a function for a column of flights, without errors; 0 for a run that stood or overturned without a flight."""

    def evaluate(runs: Rows, case: Case) -> Estimated:
        value, status = runs.numbers(column), runs.texts("status")
        went_through = (status == "ok") | (status == "overturned")
        absent = np.isnan(value) & np.isnan(runs.numbers("flight_s")) & went_through
        return without_error(np.where(absent, 0.0, value))

    return evaluate


def tilt(times: Lever) -> Evaluate:
    """Return the evaluation of the base's |tilt| times a factor; its error is proportional to that of the residual rotation."""

    def evaluate(runs: Rows, case: Case) -> Estimated:
        pier = case["pier"]
        ratio = tilt_over_residual(
            pier["gravity"], pier["height_m"], pier["half_width_m"], case["parameters"]["omega_v"]
        )
        error = alpha(case) * float(ratio) * runs.numbers("theta_res_error")
        return Estimated(times(case) * np.abs(runs.numbers("base_tilt_rad")), times(case) * error)

    return evaluate


def toe_settlement(runs: Rows, case: Case) -> Estimated:
    """Return the settlement of the lower support [m]; its error is that of the mean and half of that of the difference."""
    of_difference = tilt(width)(runs, case).error
    return Estimated(toe("settlement_m")(runs, case), runs.numbers("settlement_error_m") + 0.5 * of_difference)


def toe(settlement: str) -> Callable[[Rows, Case], Values]:
    """Return the function for the lower support's settlement [m]: the mean, in column ``settlement``, and half the difference."""
    return lambda runs, case: runs.numbers(settlement) + 0.5 * width(case) * np.abs(runs.numbers("base_tilt_rad"))


def event(name: str, meaning: str, happened: Callable[[Rows], npt.NDArray[np.bool_]], verb: str) -> Demand:
    """Return a demand that is 1 for runs in which the event ``happened``, 0 for others."""
    return Demand(
        name,
        meaning,
        lambda runs, case: without_error(happened(runs).astype(np.float64)),
        event=True,
        verb=verb,
    )


def parameter(
    name: str,
    meaning: str,
    unit: str,
    bases: tuple[str, ...],
    ceiling: Ceiling | None = None,
    of: Lever | None = None,
    condition: Condition | None = None,
) -> Demand:
    """Return the demand on a value ``of`` the case, by default its parameter of this ``name`` in run.json.

    Its value has shape (1,), NaN if the case lacks it; its error is NaN.
    """

    def evaluate(runs: Rows, case: Case) -> Estimated:
        value = of(case) if of else float(case["parameters"].get(name, np.nan))
        return without_error(np.array([value]))

    return Demand(name, meaning, evaluate, unit, bases, per_case=True, ceiling=ceiling, condition=condition)
