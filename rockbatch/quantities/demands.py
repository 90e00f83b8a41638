"""Demands on a pier and its foundation, from the rows of peaks.csv and the case in run.json.

Rotations are small: the heel of a pier that tilts by θ stands 2 b θ above its toe, and its top moves by its height times θ.
"""

import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from rockbatch.common.grouping import grouped
from rockbatch.common.lazy import pd
from rockbatch.pier import MOST_ETA, tilt_over_residual
from rockbatch.pier.bases import RATCHETING
from rockbatch.pier.restraints import KINDS, what_of
from rockbatch.quantities.statistics import Values

MOST_DUCTILITY = 100.0
"""Greatest over yield deflection of a support: soils bear some 2 to 10."""

Case = Mapping[str, Any]
"""A case as run.json has it: ``case``, ``columns``, ``pier``, ``base``, ``parameters``."""


class Estimated(NamedTuple):
    """Values of a demand, shape (n,), and their estimated errors; NaN if unknown."""

    value: Values
    error: Values


Of = Callable[["pd.DataFrame", Case], Estimated]
Lever = Callable[[Case], float]
"""Factor of a case, such as a length by which a rotation becomes a displacement."""


class Most(NamedTuple):
    """A value of the case, such as that at θ = α, and words for one beyond it."""

    value: Lever
    beyond: str


@dataclass(frozen=True)
class Demand:
    """A quantity that a check limits; the less the better, but for those of the case.

    Attributes
    ----------
    words : str
        Its meaning, with its unit.
    evaluate : function
        Its values from the rows of one case, n of them, and the case.
    bases : tuple of str
        Bases to which it applies.
    event : bool
        True for an outcome of a run, 1 or 0.
    of_the_case : bool
        True if it is the same for all records.
    other_law : function or None
        Values by the other spring law, shape (n,); the worse counts.
    most : Most or None
        Value beyond which a limit says nothing.
    verb : str
        Of an event: the words for a record that causes it.
    needs : "", "forces" or "rocking"
        Key of [output] that brings the columns it takes.
    weighed : bool
        True if it takes the mass of the pier.
    device : "", "damper", "tendon", "stop" or "deck_spring"
        Device that the pier has to have.
    held : bool
        True if it applies on every base to a pier that dampers may hold at a tilt.
    reached : function or None
        Values that runs had reached when their motion ended, n of them, with errors: lower bounds for those that failed later.
    """

    words: str
    evaluate: Of
    bases: tuple[str, ...] = ("rigid", "elastic", "yielding")
    event: bool = False
    of_the_case: bool = False
    other_law: Callable[["pd.DataFrame", Case], Values] | None = None
    most: Most | None = None
    verb: str = ""
    needs: str = ""
    weighed: bool = False
    device: str = ""
    held: bool = False
    reached: Of | None = None

    def applies_to(self, case: Case) -> bool:
        """Return True if it applies to the base of a case."""
        return case["base"] in self.bases or (self.held and _holds_a_tilt(case))

    @property
    def unit(self) -> str:
        """Unit of its values, which stands in brackets in its words; empty for a pure number."""
        unit = re.search(r"\[(.+)\]", self.words)
        return unit[1] if unit else ""

    @property
    def of_runs(self) -> bool:
        """Whether every run has this quantity, so that it is uncertain for a run that was cut short."""
        return not (self.event or self.of_the_case)


_SPRINGS = ("elastic", "yielding")
_OVERTURNS = "is past the edge of overturning"

FORCES = "base_shear_m_s2"
"""A column that every run with forces has."""

OTHER_LAW = "settlement_other_law_m"
MIRROR_OF = "mirror_of"
"""Column of the polarity of the run whose mirror image a row is; only where a study has both polarities."""

ROCKING = "theta_rocking_over_alpha"
"""A column that every run with rocking has."""

IN_MOTION, IN_MOTION_ERROR = "theta_max_in_motion_over_alpha", "theta_max_in_motion_error"
"""Columns of the peak until a motion ends, which a run that failed later has reached, and of its error."""

DEVICES_ERROR = "devices_error"
"""Column of the error of all demands on devices but counts, as a share."""

TILTS = frozenset(("theta_res_over_alpha", "theta_res_rad", "base_tilt_rad", "differential_settlement_m"))
RESIDUAL = TILTS | {"settlement_m", "toe_settlement_m"}
"""Demands on what remains after a motion, and those of them that are tilts."""

BROUGHT = {"forces": FORCES, "rocking": ROCKING}
"""By keys of [output], a column that each brings."""

MOST_FRICTION = 2.0
"""Coefficient of friction: concrete on concrete has 0.4 to 1."""


def _alpha(case: Case) -> float:
    return float(case["pier"]["alpha"])


def _width(case: Case) -> float:
    return 2.0 * float(case["pier"]["half_width_m"])


def _top(case: Case) -> float:
    """Return the height at which drift is read: twice that of the centre of mass unless the pier gives it."""
    pier = case["pier"]
    return float(pier.get("top_m", 2.0 * pier["height_m"]))


def _weight(case: Case) -> float:
    return float(case["pier"]["mass_t"]) * float(case["pier"]["gravity"])


def _always(value: float) -> Lever:
    return lambda case: value


_ONE = _always(1.0)


def _numbers(runs: "pd.DataFrame", column: str) -> Values:
    """Return a column, shape (n,); NaN for one that an earlier version did not write."""
    if column not in runs:
        return np.full(len(runs), np.nan)
    return runs[column].to_numpy(dtype=np.float64, na_value=np.nan)


def _without_error(value: Values) -> Estimated:
    return Estimated(value, np.full(len(value), np.nan))


def _largest(*columns: str, times: Lever = _ONE) -> Of:
    """Return the largest of some columns, times a factor of the case."""
    return lambda runs, case: _without_error(
        times(case) * np.maximum.reduce([_numbers(runs, name) for name in columns])
    )


def _rotation(words: str, name: str, lever: Lever, **more: Any) -> Demand:
    """Return |θ|/α times ``lever``, from the columns NAME_over_alpha and NAME_error."""
    reached = _angle(IN_MOTION, IN_MOTION_ERROR, lever) if name == "theta_max" else None
    values = _angle(f"{name}_over_alpha", f"{name}_error", lever)
    return Demand(words, values, most=Most(lever, _OVERTURNS), reached=reached, **more)


def _angle(column: str, of_error: str, lever: Lever) -> Of:
    """Return a column of |θ|/α and that of its error, times ``lever``."""
    return lambda runs, case: Estimated(
        lever(case) * np.abs(_numbers(runs, column)), lever(case) * _numbers(runs, of_error)
    )


def _tilt(words: str, lever: Lever) -> Demand:
    """Return the tilt of the base times ``lever``; its error is that of the residual rotation, to which it is proportional."""

    def values(runs: "pd.DataFrame", case: Case) -> Estimated:
        pier = case["pier"]
        ratio = tilt_over_residual(
            pier["gravity"], pier["height_m"], pier["half_width_m"], case["parameters"]["omega_v"]
        )
        error = _alpha(case) * float(ratio) * _numbers(runs, "theta_res_error")
        return Estimated(lever(case) * np.abs(_numbers(runs, "base_tilt_rad")), lever(case) * error)

    return Demand(words, values, _SPRINGS, most=Most(lambda case: lever(case) * _alpha(case), _OVERTURNS))


def _settlement(runs: "pd.DataFrame", case: Case) -> Estimated:
    """Return the mean settlement of the supports."""
    return Estimated(_numbers(runs, "settlement_m"), _numbers(runs, "settlement_error_m"))


def _toe_settlement(runs: "pd.DataFrame", case: Case) -> Estimated:
    """Return the settlement of the support that has settled more; its error is that of the mean and half of the difference."""
    of_difference = _tilt("", _width).evaluate(runs, case).error
    return Estimated(_toe("settlement_m")(runs, case), _numbers(runs, "settlement_error_m") + 0.5 * of_difference)


def _toe(settlement: str) -> Callable[["pd.DataFrame", Case], Values]:
    """Return the settlement of the support that has settled more: the mean and half of the difference."""
    return lambda runs, case: _numbers(runs, settlement) + 0.5 * _width(case) * np.abs(_numbers(runs, "base_tilt_rad"))


def _in_flight(name: str) -> Of:
    """Return a column of flights; 0 for a run that went through and has none."""

    def values(runs: "pd.DataFrame", case: Case) -> Estimated:
        value, went_through = _numbers(runs, name), runs["status"].isin(["ok", "overturned"])
        none = np.isnan(value) & (went_through & runs["flight_s"].isna()).to_numpy()
        return _without_error(np.where(none, 0.0, value))

    return values


def _event(words: str, happened: Callable[["pd.DataFrame"], "pd.Series[bool]"], verb: str) -> Demand:
    return Demand(
        words, lambda runs, case: _without_error(happened(runs).to_numpy().astype(np.float64)), event=True, verb=verb
    )


def _parameter(words: str, name: str, bases: tuple[str, ...], most: Most | None = None) -> Demand:
    """Return a parameter of the case; NaN if it is missing, as a force is if no mass is known."""

    def values(runs: "pd.DataFrame", case: Case) -> Estimated:
        return _without_error(np.array([float(case["parameters"].get(name, np.nan))]))

    return Demand(words, values, bases, of_the_case=True, most=most)


def _forces(words: str, *columns: str, times: Lever = _ONE, **more: Any) -> Demand:
    """Return the largest of some columns of forces, times a factor of the case.

    0 for a run with forces that has none of this, such as no impact; unknown if an earlier version wrote no such column.
    """

    def values(runs: "pd.DataFrame", case: Case) -> Estimated:
        value, _ = _largest(*columns)(runs, case)
        if set(columns) <= set(runs):
            value = times(case) * np.where(np.isnan(value) & ~np.isnan(_numbers(runs, FORCES)), 0.0, value)
        return Estimated(value, value * _numbers(runs, "forces_error"))

    return Demand(words, values, needs="forces", weighed=columns[0].endswith(("_kN", "_kN_s", "_kNm")), **more)


def _of_device(words: str, column: str, times: Lever = _ONE, **more: Any) -> Demand:
    """Return a column of devices, times a factor of the case."""

    def values(runs: "pd.DataFrame", case: Case) -> Estimated:
        value = times(case) * _numbers(runs, column)
        return Estimated(value, value * _numbers(runs, DEVICES_ERROR))

    return Demand(words, values, **more)


def _in_kilonewtons(device: str) -> Demand:
    """Return the largest force of a device in kN, from that over the weight: earlier results have no other."""
    words = f"greatest force of a {device.replace('_', ' ')} [kN]"
    return _of_device(words, f"{device}_force_over_weight", _weight, weighed=True)


def has_device(case: Case, device: str) -> bool:
    """Return True if the pier has a device of this kind."""
    return any(what_of(restraint) == device for restraint in _devices(case))


def creeps(case: Case) -> bool:
    """Return True if the springs of a case settle cyclically, so that another law gives its settlement a range."""
    return case["parameters"].get("spring") in RATCHETING


def _devices(case: Case) -> Iterable[Mapping[str, Any]]:
    """Return the devices of a case, as its file has them."""
    return case["parameters"].get("restraints", ()) if "parameters" in case else ()


def _holds_a_tilt(case: Case) -> bool:
    """Return True if a damper keeps a force at rest, as friction does."""
    holding = ("friction", "hysteretic")
    return any(damper.get("kind") in holding and damper.get("f") != 0.0 for damper in _devices(case))


_WIDER = Most(_width, "is more than the pier is wide")
_WIDER_MM = Most(lambda case: 1000.0 * _width(case), _WIDER.beyond)
_SLIDES = Most(_always(MOST_FRICTION), "is more than any interface has")
_GAP, _GAPS = "greatest height of a pivot above its support", ("heel_gap_left_m", "heel_gap_right_m")
_DECK = "greatest absolute horizontal acceleration of the deck"
_KEYS = "greatest base shear on shear keys, while the normal force is small,"
_UPLIFT = "greatest rise of the heel above the toe"

_OF_FORCES: dict[str, str | Demand] = {
    "base_shear_m_s2": "greatest base shear over the mass [m/s²]",
    "base_shear_kN": "greatest base shear [kN]",
    "base_moment_m2_s2": "greatest moment about the middle of the base over the mass [m²/s²]",
    "base_moment_kNm": "greatest moment about the middle of the base [kN m]",
    "normal_force_m_s2": "greatest normal force of all supports over the mass [m/s²]",
    "normal_force_kN": "greatest normal force of all supports [kN]",
    "friction_demand": _forces(
        "greatest base shear over the normal force at the time, while that is not small", "friction_demand", most=_SLIDES
    ),
    "impact_friction_demand": _forces(
        "greatest horizontal over vertical impulse of an impact", "impact_friction_demand", most=_SLIDES
    ),
    "pivot_force": _forces("greatest force of a support over half the weight", "pivot_force_left", "pivot_force_right"),
    "pivot_force_kN": _forces("greatest force of a support [kN]", "pivot_force_left_kN", "pivot_force_right_kN"),
    "heel_gap_m": _forces(f"{_GAP} [m]", *_GAPS, most=_WIDER),
    "heel_gap_mm": _forces(
        f"{_GAP} [mm]", *_GAPS, times=_always(1000.0), most=_WIDER_MM
    ),
    "heel_speed_m_s": _forces(
        "greatest speed of a pivot from or to its support [m/s]", "heel_speed_left_m_s", "heel_speed_right_m_s"
    ),
    "deck_acceleration_m_s2": f"{_DECK} [m/s²]",
    "deck_acceleration_g": _forces(
        f"{_DECK} [g]", "deck_acceleration_m_s2", times=lambda case: 1.0 / float(case["pier"]["gravity"])
    ),
    "landing_velocity_m_s": "speed of the pivot at the hardest impact [m/s]",
    "impulse_m_s": "vertical impulse of the hardest impact over the mass [m/s]",
    "impulse_kN_s": "vertical impulse of the hardest impact [kN s]",
    "omega_max_over_p": "greatest angular velocity over p",
    "key_shear_m_s2": f"{_KEYS} over the mass [m/s²]",
    "key_shear_kN": f"{_KEYS} [kN]",
    "flight_longest_s": "longest flight [s]",
}  # fmt: skip
"""Demands that need the forces: in words alone if it is the column of that name."""


def _lengths(name: str, words: str) -> dict[str, Demand]:
    """Return the demands of a column NAME_m, in m and in mm."""
    return {
        f"{name}_m": _of_device(f"{words} [m]", f"{name}_m", most=_WIDER),
        f"{name}_mm": _of_device(f"{words} [mm]", f"{name}_m", _always(1000.0), most=_WIDER_MM),
    }


_OF_DEVICES: dict[str, str | Demand] = {
    "damper_force_over_weight": "greatest force of a damper over the pier's weight",
    "damper_force_kN": _in_kilonewtons("damper"),
    **_lengths("damper_stroke", "greatest elongation of a damper"),
    "damper_speed_m_s": "greatest speed of a damper [m/s]",
    "damper_energy_J_kg": "energy that all dampers take, over the pier's mass [J/kg]",
    "tendon_force_over_weight": "greatest force of a tendon over the pier's weight",
    "tendon_force_kN": _in_kilonewtons("tendon"),
    "tendon_yield_m": _of_device("by how much a tendon is longer for good [m]", "tendon_yield_m", most=_WIDER),
    "tendon_slack": Demand("how often tendons go slack", _largest("tendon_slack")),
    "stop_force_over_weight": "greatest force of a stop over the pier's weight",
    "stop_force_kN": _in_kilonewtons("stop"),
    **_lengths("stop_deflection", "greatest deflection of a stop beyond its gap"),
    "stop_blows": Demand("how often stops are met", _largest("stop_blows")),
    "stop_energy_J_kg": "energy that all stops take, over the pier's mass [J/kg]",
    "deck_spring_force_over_weight": "greatest force of a deck spring over the pier's weight",
    "deck_spring_force_kN": _in_kilonewtons("deck_spring"),
    **_lengths("deck_spring_deflection", "greatest deflection of a deck spring beyond its gap"),
    "deck_spring_blows": Demand("how often gaps beside the deck close", _largest("deck_spring_blows")),
    "deck_spring_energy_J_kg": "energy that all deck springs take, over the pier's mass [J/kg]",
}
"""Demands that need devices: words alone if the column has the demand's name, and an error, which counts have not."""


def _with_device(name: str, demand: str | Demand) -> Demand:
    demand = _of_device(demand, name) if isinstance(demand, str) else demand
    return replace(demand, device=next(device for device in KINDS if name.startswith(f"{device}_")))


DEMANDS = {
    "theta_max_over_alpha": _rotation("greatest rotation over α", "theta_max", _ONE),
    "theta_max_rad": _rotation("greatest rotation [rad]", "theta_max", _alpha),
    "top_drift_m": _rotation("greatest drift of the top [m]", "theta_max", lambda case: _top(case) * _alpha(case)),
    "heel_uplift_m": _rotation(f"{_UPLIFT} [m]", "theta_max", lambda case: _width(case) * _alpha(case)),
    "top_drift_mm": _rotation(
        "greatest drift of the top [mm]", "theta_max", lambda case: 1000.0 * _top(case) * _alpha(case)
    ),
    "heel_uplift_mm": _rotation(f"{_UPLIFT} [mm]", "theta_max", lambda case: 1000.0 * _width(case) * _alpha(case)),
    ROCKING: _rotation(
        "greatest rotation over α about where the pier would rest on its base as it then is", "theta_rocking", _ONE,
        needs="rocking",
    ),
    "theta_res_over_alpha": _rotation(
        "residual rotation over α", "theta_res", _ONE, bases=_SPRINGS, held=True
    ),
    "theta_res_rad": _rotation("residual rotation [rad]", "theta_res", _alpha, bases=_SPRINGS, held=True),
    "base_tilt_rad": _tilt("residual tilt of the base [rad]", _ONE),
    "differential_settlement_m": _tilt("settlement of one support against the other [m]", _width),
    "settlement_m": Demand(
        "mean settlement of the supports [m]", _settlement, _SPRINGS, most=_WIDER,
        other_law=lambda runs, case: _numbers(runs, "settlement_other_law_m"),
    ),
    "toe_settlement_m": Demand(
        "settlement of the support that settles more [m]", _toe_settlement, _SPRINGS, most=_WIDER,
        other_law=_toe("settlement_other_law_m"),
    ),
    "ductility": Demand(
        "greatest deflection of a support over its yield deflection", _largest("ductility_left", "ductility_right"),
        ("yielding",), most=Most(_always(MOST_DUCTILITY), "is more than any support bears"),
    ),
    "impacts": Demand("number of impacts", _largest("impacts")),
    "separations": Demand("number of separations", _largest("separations")),
    "flights": Demand("number of flights", _in_flight("flights")),
    "flight_duration_s": Demand("time with both pivots in the air [s]", _in_flight("flight_duration_s")),
    "flight_height_m": Demand("height of the lower pivot in flight [m]", _in_flight("flight_height_m"), most=_WIDER),
    "flight": _event("both pivots off the ground", lambda runs: runs["flight_s"].notna(), "makes the pier fly"),
    "overturned": _event("overturned", lambda runs: runs["status"] == "overturned", "overturns the pier"),
    "failed": _event(
        "not run, or not settled", lambda runs: runs["status"] == "failed", "has a run that is missing or not settled"
    ),
    **{name: _forces(row, name) if isinstance(row, str) else row for name, row in _OF_FORCES.items()},
    **{name: _with_device(name, row) for name, row in _OF_DEVICES.items()},
    "eta": _parameter(
        "bearing capacity index, a support's yield force over its static one", "eta", ("yielding",),
        Most(_always(MOST_ETA), "is more than any foundation has"),
    ),
    "yield_kN": _parameter("yield force of a support [kN]", "yield_kN", ("yielding",)),
    "stiffness_kN_m": _parameter("stiffness of a support [kN/m]", "stiffness_kN_m", _SPRINGS),
    "static_deflection_m": _parameter(
        "deflection of the supports under the weight at rest, while elastic [m]", "delta_s_m", _SPRINGS, _WIDER
    ),
}  # fmt: skip
"""Demands by the name that a rule gives them; signs are dropped."""


def listed() -> dict[str, list[str]]:
    """Return the names of all demands, grouped by what they depend on: the list in the example of checks."""

    def group(name: str) -> str:
        demand = DEMANDS[name]
        return (
            "yes or no, 1 or 0" if demand.event
            else "of the foundation, and not of a run" if demand.of_the_case
            else f"with [output] {demand.needs} = true" if demand.needs
            else f"of a {demand.device}" if demand.device
            else "of every run"
        )  # fmt: skip

    return grouped(DEMANDS, group)
