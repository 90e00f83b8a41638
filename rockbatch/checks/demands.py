"""What a foundation has to bear: each demand from the rows of peaks.csv and what run.json says about the case.

Rotations are small: the heel of a pier that tilts by θ stands 2 b θ above its toe, and its top moves by 2 h θ.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from rockbatch.checks.statistics import Values
from rockbatch.pier import tilt_over_residual

if TYPE_CHECKING:
    import pandas as pd

Case = Mapping[str, Any]
"""A case as run.json has it: ``case``, ``columns``, ``pier``, ``base``, ``parameters``."""


class Found(NamedTuple):
    """Values of a demand, shape (n,), and their estimated errors; NaN where there is none."""

    value: Values
    error: Values


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
        Values by the other spring law, shape (n,).
    """

    words: str
    of: Callable[["pd.DataFrame", Case], Found]
    bases: tuple[str, ...] = ("rigid", "elastic", "yielding")
    event: bool = False
    of_the_case: bool = False
    other_law: Callable[["pd.DataFrame", Case], Values] | None = None

    @property
    def of_runs(self) -> bool:
        """Whether it is a quantity that every run has, and for which a run that was cut short is a question."""
        return not (self.event or self.of_the_case)


def _numbers(runs: "pd.DataFrame", column: str) -> Values:
    return runs[column].to_numpy(dtype=np.float64, na_value=np.nan)


def _without_error(value: Values) -> Found:
    return Found(value, np.full(len(value), np.nan))


def _rotation(name: str, lever: Callable[[Case], float]) -> Callable[["pd.DataFrame", Case], Found]:
    """|θ| times ``lever`` [m/rad or rad/rad], from the columns theta_max_… or theta_res_…, which are over α."""

    def found(runs: "pd.DataFrame", case: Case) -> Found:
        factor = lever(case)
        value = np.abs(_numbers(runs, f"{name}_over_alpha"))
        return Found(factor * value, factor * _numbers(runs, f"{name}_error"))

    return found


def _alpha(case: Case) -> float:
    return float(case["pier"]["alpha"])


def _width(case: Case) -> float:
    return 2.0 * float(case["pier"]["half_width_m"])


def _height(case: Case) -> float:
    """Twice that of the centre of mass."""
    return 2.0 * float(case["pier"]["height_m"])


def _tilt_over_residual(case: Case) -> float:
    pier = case["pier"]
    omega_v = case["parameters"]["omega_v"]
    return float(tilt_over_residual(pier["gravity"], pier["height_m"], pier["half_width_m"], omega_v))


def _tilt(lever: Callable[[Case], float]) -> Callable[["pd.DataFrame", Case], Found]:
    """Tilt of the base times ``lever``; its error is that of the residual rotation, to which it is proportional."""

    def found(runs: "pd.DataFrame", case: Case) -> Found:
        error = _alpha(case) * _tilt_over_residual(case) * _numbers(runs, "theta_res_error")
        return Found(lever(case) * np.abs(_numbers(runs, "base_tilt_rad")), lever(case) * error)

    return found


def _toe(settlement: str) -> Callable[["pd.DataFrame", Case], Values]:
    """Settlement of the support that has settled more: the mean and half of the difference."""

    def found(runs: "pd.DataFrame", case: Case) -> Values:
        return _numbers(runs, settlement) + 0.5 * _width(case) * np.abs(_numbers(runs, "base_tilt_rad"))

    return found


def _ductility(runs: "pd.DataFrame", case: Case) -> Found:
    return _without_error(np.maximum(_numbers(runs, "ductility_left"), _numbers(runs, "ductility_right")))


def _column(name: str) -> Callable[["pd.DataFrame", Case], Found]:
    return lambda runs, case: _without_error(_numbers(runs, name))


def _event(happened: Callable[["pd.DataFrame"], "pd.Series[bool]"]) -> Callable[["pd.DataFrame", Case], Found]:
    return lambda runs, case: _without_error(happened(runs).to_numpy().astype(np.float64))


def _parameter(name: str) -> Callable[["pd.DataFrame", Case], Found]:
    return lambda runs, case: _without_error(np.array([float(case["parameters"][name])]))


_SPRINGS = ("elastic", "yielding")

DEMANDS = {
    "theta_max_over_alpha": Demand("greatest rotation over α", _rotation("theta_max", lambda case: 1.0)),
    "theta_max_rad": Demand("greatest rotation [rad]", _rotation("theta_max", _alpha)),
    "top_drift_m": Demand(
        "greatest drift of the top [m], which is twice as high as the centre of mass",
        _rotation("theta_max", lambda case: _height(case) * _alpha(case)),
    ),
    "heel_uplift_m": Demand(
        "greatest rise of the heel above the toe [m]",
        _rotation("theta_max", lambda case: _width(case) * _alpha(case)),
    ),
    "theta_res_over_alpha": Demand("residual rotation over α", _rotation("theta_res", lambda case: 1.0), _SPRINGS),
    "theta_res_rad": Demand("residual rotation [rad]", _rotation("theta_res", _alpha), _SPRINGS),
    "base_tilt_rad": Demand("residual tilt of the base [rad]", _tilt(lambda case: 1.0), _SPRINGS),
    "differential_settlement_m": Demand("settlement of one support against the other [m]", _tilt(_width), _SPRINGS),
    "settlement_m": Demand(
        "mean settlement of the supports [m]",
        _column("settlement_m"),
        _SPRINGS,
        other_law=lambda runs, case: _numbers(runs, "settlement_other_law_m"),
    ),
    "toe_settlement_m": Demand(
        "settlement of the support that settles more [m]",
        lambda runs, case: _without_error(_toe("settlement_m")(runs, case)),
        _SPRINGS,
        other_law=_toe("settlement_other_law_m"),
    ),
    "ductility": Demand("greatest deflection of a support over its yield deflection", _ductility, ("yielding",)),
    "impacts": Demand("number of impacts", _column("impacts")),
    "separations": Demand("number of separations", _column("separations")),
    "flight": Demand("both pivots off the ground", _event(lambda runs: runs["flight_s"].notna()), event=True),
    "overturned": Demand("overturned", _event(lambda runs: runs["status"] == "overturned"), event=True),
    "failed": Demand("not run, or not settled", _event(lambda runs: runs["status"] == "failed"), event=True),
    "eta": Demand(
        "bearing capacity index, a support's yield force over its static one",
        _parameter("eta"),
        ("yielding",),
        of_the_case=True,
    ),
    "static_deflection_m": Demand(
        "deflection of the supports under the weight at rest, while elastic [m]",
        _parameter("delta_s_m"),
        _SPRINGS,
        of_the_case=True,
    ),
}
"""Demands by the name that a rule gives them; signs are dropped."""
