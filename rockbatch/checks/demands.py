"""What a foundation has to bear: each demand from the rows of peaks.csv and what run.json says about the case.

Rotations are small: the heel of a pier that tilts by θ stands 2 b θ above its toe, and its top moves by its height times θ.
"""

import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from rockbatch.checks.statistics import Values
from rockbatch.lazy import pd
from rockbatch.pier import MOST_ETA, tilt_over_residual

MOST_DUCTILITY = 100.0
"""Of a support, greatest over yield deflection: soils bear some 2 to 10."""

Case = Mapping[str, Any]
"""A case as run.json has it: ``case``, ``columns``, ``pier``, ``base``, ``parameters``."""


class Found(NamedTuple):
    """Values of a demand, shape (n,), and their estimated errors; NaN if unknown."""

    value: Values
    error: Values


class Most(NamedTuple):
    """A value of the case, such as that at θ = α, and what one beyond it would be."""

    of: Callable[[Case], float]
    told: str


@dataclass(frozen=True)
class Demand:
    """One demand; the less the better, but for those of the case.

    Attributes
    ----------
    words : str
        What it is, with its unit.
    of : function
        Of the rows of one case, n of them, and the case.
    bases : tuple of str
        Bases to which it applies.
    event : bool
        Whether it is about the outcome of a run, 1 or 0.
    of_the_case : bool
        Whether it is the same for all records.
    other_law : function or None
        Values by the other spring law, shape (n,); the worse counts.
    most : Most or None
        Beyond which a limit says nothing.
    verb : str
        Of an event: what a record then does.
    needs : "", "forces" or "rocking"
        Key of [output] that brings the columns it takes.
    weighed : bool
        Whether it takes the mass of the pier.
    device : "", "damper" or "tendon"
        What the pier has to be tied with.
    held : bool
        Whether it applies on every base to a pier that dampers may hold at a tilt.
    """

    words: str
    of: Callable[["pd.DataFrame", Case], Found]
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

    def on(self, case: Case) -> bool:
        """Return whether it applies to the base of a case."""
        return case["base"] in self.bases or (self.held and _holds_a_tilt(case))

    @property
    def unit(self) -> str:
        """That of its values, which stands in brackets in its words; empty for a pure number."""
        found = re.search(r"\[(.+)\]", self.words)
        return found[1] if found else ""

    @property
    def of_runs(self) -> bool:
        """Whether it is a quantity that every run has, and for which a run that was cut short is a question."""
        return not (self.event or self.of_the_case)


_SPRINGS = ("elastic", "yielding")
_OVERTURNS = "is past the edge of overturning"


def _numbers(runs: "pd.DataFrame", column: str) -> Values:
    return runs[column].to_numpy(dtype=np.float64, na_value=np.nan)


def _without_error(value: Values) -> Found:
    return Found(value, np.full(len(value), np.nan))


def _rotation(words: str, name: str, lever: Callable[[Case], float], **more: Any) -> Demand:
    """|θ|/α times ``lever``, from the columns theta_max_… or theta_res_…, which are over α."""

    def found(runs: "pd.DataFrame", case: Case) -> Found:
        factor = lever(case)
        value = np.abs(_numbers(runs, f"{name}_over_alpha"))
        return Found(factor * value, factor * _numbers(runs, f"{name}_error"))

    return Demand(words, found, most=Most(lever, _OVERTURNS), **more)


def _alpha(case: Case) -> float:
    return float(case["pier"]["alpha"])


def _width(case: Case) -> float:
    return 2.0 * float(case["pier"]["half_width_m"])


def _top(case: Case) -> float:
    """Where drift is read: twice as high as the centre of mass unless the pier says it."""
    pier = case["pier"]
    return float(pier.get("top_m", 2.0 * pier["height_m"]))


def _tilt_over_residual(case: Case) -> float:
    pier = case["pier"]
    omega_v = case["parameters"]["omega_v"]
    return float(tilt_over_residual(pier["gravity"], pier["height_m"], pier["half_width_m"], omega_v))


def _tilt(words: str, lever: Callable[[Case], float]) -> Demand:
    """Tilt of the base times ``lever``; its error is that of the residual rotation, to which it is proportional."""

    def found(runs: "pd.DataFrame", case: Case) -> Found:
        error = _alpha(case) * _tilt_over_residual(case) * _numbers(runs, "theta_res_error")
        return Found(lever(case) * np.abs(_numbers(runs, "base_tilt_rad")), lever(case) * error)

    return Demand(words, found, _SPRINGS, most=Most(lambda case: lever(case) * _alpha(case), _OVERTURNS))


def _toe(settlement: str) -> Callable[["pd.DataFrame", Case], Values]:
    """Settlement of the support that has settled more: the mean and half of the difference."""

    def found(runs: "pd.DataFrame", case: Case) -> Values:
        return _numbers(runs, settlement) + 0.5 * _width(case) * np.abs(_numbers(runs, "base_tilt_rad"))

    return found


def _ductility(runs: "pd.DataFrame", case: Case) -> Found:
    return _without_error(np.maximum(_numbers(runs, "ductility_left"), _numbers(runs, "ductility_right")))


def _of_device(words: str, column: str, device: str, factor: float = 1.0) -> Demand:
    return Demand(words, lambda runs, case: _without_error(factor * _numbers(runs, column)), device=device)


def _device_force(device: str) -> Demand:
    """The greatest force of a device in kN, from that over the weight: earlier results have no other."""

    def found(runs: "pd.DataFrame", case: Case) -> Found:
        weight = float(case["pier"]["mass_t"]) * float(case["pier"]["gravity"])
        return _without_error(weight * _numbers(runs, f"{device}_force_over_weight"))

    return Demand(f"greatest force of a {device} [kN]", found, device=device, weighed=True)


def has_device(case: Case, device: str) -> bool:
    """Whether the pier is tied with a damper, or a tendon; a damper has a kind."""
    return any(("kind" in each) == (device == "damper") for each in _ties(case))


def _ties(case: Case) -> Iterable[Mapping[str, Any]]:
    """Dampers and tendons of a case, as its file has them."""
    return case["parameters"].get("restraints", ()) if "parameters" in case else ()


def _holds_a_tilt(case: Case) -> bool:
    """Whether a damper keeps a force at rest, as friction does."""
    return any(each.get("kind") in ("friction", "hysteretic") and each.get("f") != 0.0 for each in _ties(case))


def _rocking(runs: "pd.DataFrame", case: Case) -> Found:
    """Rocking with its error; tables of earlier versions have none."""
    error = _numbers(runs, ROCKING_ERROR) if ROCKING_ERROR in runs else np.full(len(runs), np.nan)
    return Found(_numbers(runs, ROCKING), error)


def _column(name: str) -> Callable[["pd.DataFrame", Case], Found]:
    return lambda runs, case: _without_error(_numbers(runs, name))


def _in_flight(name: str) -> Callable[["pd.DataFrame", Case], Found]:
    """A column of flights; 0 of a run that went through and has none."""

    def found(runs: "pd.DataFrame", case: Case) -> Found:
        value, went_through = _numbers(runs, name), runs["status"].isin(["ok", "overturned"])
        none = np.isnan(value) & (went_through & runs["flight_s"].isna()).to_numpy()
        return _without_error(np.where(none, 0.0, value))

    return found


def _event(happened: Callable[["pd.DataFrame"], "pd.Series[bool]"]) -> Callable[["pd.DataFrame", Case], Found]:
    return lambda runs, case: _without_error(happened(runs).to_numpy().astype(np.float64))


def _parameter(name: str) -> Callable[["pd.DataFrame", Case], Found]:
    """A parameter of the case; NaN where it has none, as of a force where no mass is known."""
    return lambda runs, case: _without_error(np.array([float(case["parameters"].get(name, np.nan))]))


def _forces(words: str, *columns: str, factor: Callable[[Case], float] = lambda case: 1.0, **more: Any) -> Demand:
    """The greatest of some columns of forces, times ``factor``.

    0 where a run has forces, and of this none: no impact, say. Unknown where an earlier version wrote no such column.
    """

    def found(runs: "pd.DataFrame", case: Case) -> Found:
        if not set(columns) <= set(runs):
            return _without_error(np.full(len(runs), np.nan))
        value = np.maximum.reduce([_numbers(runs, column) for column in columns])
        none = np.isnan(value) & ~np.isnan(_numbers(runs, FORCES))
        value = factor(case) * np.where(none, 0.0, value)
        share = _numbers(runs, FORCES_ERROR) if FORCES_ERROR in runs else np.full(len(runs), np.nan)
        return Found(value, value * share)

    return Demand(words, found, needs="forces", weighed=columns[0].endswith(("_kN", "_kN_s", "_kNm")), **more)


def _thousand(case: Case) -> float:
    return 1000.0


def _per_g(case: Case) -> float:
    return 1.0 / float(case["pier"]["gravity"])


_GAPS = ("heel_gap_left_m", "heel_gap_right_m")
_DECK = "greatest absolute horizontal acceleration of the deck"
_KEYS = "greatest base shear on shear keys, while the normal force is small,"

FORCES = "base_shear_m_s2"
"""A column that every run with forces has."""

FORCES_ERROR = "forces_error"
"""The column of their error; tables of earlier versions have none."""

ROCKING = "theta_rocking_over_alpha"
"""Likewise with rocking."""

ROCKING_ERROR = "theta_rocking_error"
"""The column of its error."""

BROUGHT = {"forces": FORCES, "rocking": ROCKING}
"""By keys of [output], a column that each brings."""

MOST_FRICTION = 2.0
"""Coefficient of friction: concrete on concrete has 0.4 to 1."""

_OF_FORCES = {
    "base_shear_m_s2": _forces("greatest base shear over the mass [m/s²]", "base_shear_m_s2"),
    "base_shear_kN": _forces("greatest base shear [kN]", "base_shear_kN"),
    "base_moment_m2_s2": _forces(
        "greatest moment about the middle of the base over the mass [m²/s²]", "base_moment_m2_s2"
    ),
    "base_moment_kNm": _forces("greatest moment about the middle of the base [kN m]", "base_moment_kNm"),
    "normal_force_m_s2": _forces("greatest normal force of all supports over the mass [m/s²]", "normal_force_m_s2"),
    "normal_force_kN": _forces("greatest normal force of all supports [kN]", "normal_force_kN"),
    "friction_demand": _forces(
        "greatest base shear over the normal force at the time, while that is not small",
        "friction_demand",
        most=Most(lambda case: MOST_FRICTION, "is more than any interface has"),
    ),
    "impact_friction_demand": _forces(
        "greatest horizontal over vertical impulse of an impact",
        "impact_friction_demand",
        most=Most(lambda case: MOST_FRICTION, "is more than any interface has"),
    ),
    "pivot_force": _forces("greatest force of a support over half the weight", "pivot_force_left", "pivot_force_right"),
    "pivot_force_kN": _forces("greatest force of a support [kN]", "pivot_force_left_kN", "pivot_force_right_kN"),
    "heel_gap_m": _forces(
        "greatest height of a pivot above its support [m]", *_GAPS, most=Most(_width, "is more than the pier is wide")
    ),
    "heel_gap_mm": _forces(
        "greatest height of a pivot above its support [mm]",
        *_GAPS,
        factor=_thousand,
        most=Most(lambda case: 1000.0 * _width(case), "is more than the pier is wide"),
    ),
    "heel_speed_m_s": _forces(
        "greatest speed of a pivot from or to its support [m/s]", "heel_speed_left_m_s", "heel_speed_right_m_s"
    ),
    "deck_acceleration_m_s2": _forces(f"{_DECK} [m/s²]", "deck_acceleration_m_s2"),
    "deck_acceleration_g": _forces(f"{_DECK} [g]", "deck_acceleration_m_s2", factor=_per_g),
    "landing_velocity_m_s": _forces("speed of the pivot at the hardest impact [m/s]", "landing_velocity_m_s"),
    "impulse_m_s": _forces("vertical impulse of the hardest impact over the mass [m/s]", "impulse_m_s"),
    "impulse_kN_s": _forces("vertical impulse of the hardest impact [kN s]", "impulse_kN_s"),
    "omega_max_over_p": _forces("greatest angular velocity over p", "omega_max_over_p"),
    "key_shear_m_s2": _forces(f"{_KEYS} over the mass [m/s²]", "key_shear_m_s2"),
    "key_shear_kN": _forces(f"{_KEYS} [kN]", "key_shear_kN"),
    "flight_longest_s": _forces("longest flight [s]", "flight_longest_s"),
}

_OF_DEVICES = {
    "damper_force_over_weight": _of_device(
        "greatest force of a damper over the pier's weight", "damper_force_over_weight", "damper"
    ),
    "damper_force_kN": _device_force("damper"),
    "damper_stroke_m": _of_device("greatest elongation of a damper [m]", "damper_stroke_m", "damper"),
    "damper_stroke_mm": _of_device("greatest elongation of a damper [mm]", "damper_stroke_m", "damper", 1000.0),
    "damper_speed_m_s": _of_device("greatest speed of a damper [m/s]", "damper_speed_m_s", "damper"),
    "damper_energy_J_kg": _of_device(
        "energy that all dampers take, over the pier's mass [J/kg]", "damper_energy_J_kg", "damper"
    ),
    "tendon_force_over_weight": _of_device(
        "greatest force of a tendon over the pier's weight", "tendon_force_over_weight", "tendon"
    ),
    "tendon_force_kN": _device_force("tendon"),
    "tendon_yield_m": _of_device("by how much a tendon is longer for good [m]", "tendon_yield_m", "tendon"),
    "tendon_slack": _of_device("how often tendons go slack", "tendon_slack", "tendon"),
}

DEMANDS = {
    "theta_max_over_alpha": _rotation("greatest rotation over α", "theta_max", lambda case: 1.0),
    "theta_max_rad": _rotation("greatest rotation [rad]", "theta_max", _alpha),
    "top_drift_m": _rotation("greatest drift of the top [m]", "theta_max", lambda case: _top(case) * _alpha(case)),
    "heel_uplift_m": _rotation(
        "greatest rise of the heel above the toe [m]", "theta_max", lambda case: _width(case) * _alpha(case)
    ),
    "top_drift_mm": _rotation(
        "greatest drift of the top [mm]", "theta_max", lambda case: 1000.0 * _top(case) * _alpha(case)
    ),
    "heel_uplift_mm": _rotation(
        "greatest rise of the heel above the toe [mm]", "theta_max", lambda case: 1000.0 * _width(case) * _alpha(case)
    ),
    ROCKING: Demand(
        "greatest rotation over α about where the pier would rest on its base as it then is",
        _rocking,
        most=Most(lambda case: 1.0, _OVERTURNS),
        needs="rocking",
    ),
    "theta_res_over_alpha": _rotation(
        "residual rotation over α", "theta_res", lambda case: 1.0, bases=_SPRINGS, held=True
    ),
    "theta_res_rad": _rotation("residual rotation [rad]", "theta_res", _alpha, bases=_SPRINGS, held=True),
    "base_tilt_rad": _tilt("residual tilt of the base [rad]", lambda case: 1.0),
    "differential_settlement_m": _tilt("settlement of one support against the other [m]", _width),
    "settlement_m": Demand(
        "mean settlement of the supports [m]",
        _column("settlement_m"),
        _SPRINGS,
        other_law=lambda runs, case: _numbers(runs, "settlement_other_law_m"),
        most=Most(_width, "is more than the pier is wide"),
    ),
    "toe_settlement_m": Demand(
        "settlement of the support that settles more [m]",
        lambda runs, case: _without_error(_toe("settlement_m")(runs, case)),
        _SPRINGS,
        other_law=_toe("settlement_other_law_m"),
        most=Most(_width, "is more than the pier is wide"),
    ),
    "ductility": Demand(
        "greatest deflection of a support over its yield deflection",
        _ductility,
        ("yielding",),
        most=Most(lambda case: MOST_DUCTILITY, "is more than any support bears"),
    ),
    "impacts": Demand("number of impacts", _column("impacts")),
    "separations": Demand("number of separations", _column("separations")),
    "flights": Demand("number of flights", _in_flight("flights")),
    "flight_duration_s": Demand("time with both pivots in the air [s]", _in_flight("flight_duration_s")),
    "flight_height_m": Demand("height of the lower pivot in flight [m]", _in_flight("flight_height_m")),
    "flight": Demand(
        "both pivots off the ground",
        _event(lambda runs: runs["flight_s"].notna()),
        event=True,
        verb="makes the pier fly",
    ),
    "overturned": Demand(
        "overturned", _event(lambda runs: runs["status"] == "overturned"), event=True, verb="overturns the pier"
    ),
    "failed": Demand(
        "not run, or not settled",
        _event(lambda runs: runs["status"] == "failed"),
        event=True,
        verb="has a run that is missing or not settled",
    ),
    **_OF_FORCES,
    **_OF_DEVICES,
    "eta": Demand(
        "bearing capacity index, a support's yield force over its static one",
        _parameter("eta"),
        ("yielding",),
        of_the_case=True,
        most=Most(lambda case: MOST_ETA, "is more than any foundation has"),
    ),
    "yield_kN": Demand("yield force of a support [kN]", _parameter("yield_kN"), ("yielding",), of_the_case=True),
    "stiffness_kN_m": Demand("stiffness of a support [kN/m]", _parameter("stiffness_kN_m"), _SPRINGS, of_the_case=True),
    "static_deflection_m": Demand(
        "deflection of the supports under the weight at rest, while elastic [m]",
        _parameter("delta_s_m"),
        _SPRINGS,
        of_the_case=True,
        most=Most(_width, "is more than the pier is wide"),
    ),
}
"""Demands by the name that a rule gives them; signs are dropped."""
