"""The columns of peaks.csv, and its rows."""

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

from rockbatch.checks.suite import MIRROR_OF
from rockbatch.motions import MotionSet
from rockbatch.results.outcome import Outcome
from rockbatch.study import Case, Study

if TYPE_CHECKING:
    import pandas as pd

PEAKS = "peaks.csv"
PART = f"{PEAKS}.part"
"""Finished runs of a table that is under way."""

COLUMNS = (
    "record",
    "case",
    "polarity",
    "scale",
    "status",
    "theta_max_over_alpha",
    "theta_max_error",
    "t_max_s",
    "theta_res_over_alpha",
    "settlement_m",
    "impacts",
    "separations",
    "flight_s",
    "substeps",
)
"""Columns that stay; then come those of the keys that the study varies, then :data:`MORE_COLUMNS`."""

MORE_COLUMNS = (
    "theta_res_error",
    "t_end_s",
    "base_tilt_rad",
    "ductility_left",
    "ductility_right",
    "dissipated_left_J_kg",
    "dissipated_right_J_kg",
    "residual_s",
    "theta_res_drift_per_s",
    "settlement_drift_m_s",
    "reason",
    "note",
)

TERMS = ("kinetic", "potential", "elastic", "input", "plastic", "impact", "p_delta", "constraint", "remainder")
"""Terms of the energy ledger, in the order in which the core returns them."""

TEXTS = ("record", "case", "polarity", "status", "reason", "note", MIRROR_OF)
COUNTS = ("impacts", "separations", "substeps")


def row(record: str, polarity: str, scale: float, case: Case, outcome: Outcome) -> dict[str, Any]:
    """Row of peaks.csv: the names of a run, and its outcome over α."""
    alpha = case.pier.alpha
    return {
        "record": record,
        "case": case.name,
        "polarity": polarity,
        "scale": scale,
        "status": outcome.status,
        "theta_max_over_alpha": outcome.theta_max / alpha,
        "theta_max_error": _over(outcome.theta_max_error, alpha),
        "t_max_s": outcome.t_max,
        "theta_res_over_alpha": _over(outcome.theta_res, alpha),
        "settlement_m": outcome.settlement,
        "impacts": outcome.impacts,
        "separations": outcome.separations,
        "flight_s": outcome.t_flight,
        "substeps": outcome.substeps,
        **case.columns,
        "theta_res_error": _over(outcome.theta_res_error, alpha),
        "t_end_s": outcome.t_end,
        "base_tilt_rad": outcome.base_tilt,
        "ductility_left": outcome.ductility_left,
        "ductility_right": outcome.ductility_right,
        "dissipated_left_J_kg": outcome.dissipated_left,
        "dissipated_right_J_kg": outcome.dissipated_right,
        "residual_s": outcome.t_read,
        "theta_res_drift_per_s": _over(outcome.theta_res_drift, alpha),
        "settlement_drift_m_s": outcome.settlement_drift,
        "reason": outcome.reason,
        "note": outcome.note,
        "settlement_other_law_m": outcome.settlement_other_law,
        **{f"energy_{term}_J_kg": value for term, value in (outcome.energies or {}).items()},
    }


def _over(value: float | None, alpha: float) -> float | None:
    return None if value is None else value / alpha


def unusable_rows(motions: MotionSet) -> list[dict[str, Any]]:
    """One row for each file that could not be used, with the reason."""
    return [
        {"record": file.name, "status": "failed", "reason": f"{file.source}: {file.reason}"}
        for file in motions.unusable
    ]


def columns(study: Study) -> list[str]:
    """Columns of the table of ``study``: those that stay, its varied keys, more, and what it asks for."""
    asked = [MIRROR_OF] if len(study.motions.polarity) > 1 else []
    if study.output.both_laws:
        asked.append("settlement_other_law_m")
    if study.output.ledger:
        asked += [f"energy_{term}_J_kg" for term in TERMS]
    return [*COLUMNS, *study.varied, *MORE_COLUMNS, *asked]


def as_table(rows: Iterable[Mapping[str, Any]], study: Study) -> "pd.DataFrame":
    """The rows of peaks.csv as a DataFrame: NaN where a number does not apply, counts that can be missing."""
    import pandas as pd

    varied = study.varied
    table = pd.DataFrame(list(rows), columns=columns(study))
    texts = [name for name in table if name in TEXTS]
    table[texts] = table[texts].fillna("")
    for name in table.columns.difference([*TEXTS, *varied, *COUNTS]):
        table[name] = table[name].astype("float64")
    for name in COUNTS:
        table[name] = table[name].astype("Int64")
    return table
