"""The tables of a study: rows of peaks.csv, what run.json says about them, and both on disk."""

import json
from collections.abc import Iterable, Mapping
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rockbatch.checks.suite import MIRROR_OF
from rockbatch.files import write_whole
from rockbatch.motions import MotionSet, measures
from rockbatch.motions.motion import Motion
from rockbatch.motions.spectrum import suite_spectra
from rockbatch.pier import Base, ElasticBase, Pier, RigidBase, YieldingBase
from rockbatch.results.outcome import Outcome
from rockbatch.study import Case, Study

if TYPE_CHECKING:
    import pandas as pd

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

MOST_SPECTRA = 200
"""Motions whose spectra go into run.json; each takes about 10 ms."""

TEXTS = ("record", "case", "polarity", "status", "reason", "note", MIRROR_OF)
COUNTS = ("impacts", "separations", "substeps")

HISTORIES = "histories.h5"
"""File of the histories that were kept, beside peaks.csv."""


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


def describe(study: Study, motions: MotionSet) -> dict[str, Any]:
    """What run.json says about a study and its motions."""
    import hashlib

    return {
        "study": {
            "path": str(study.path),
            "title": study.title,
            "notes": study.notes,
            "text": study.text,
            "sha256": hashlib.sha256(study.text.encode()).hexdigest(),
        },
        "numerics": {
            "tolerance": study.numerics.tolerance,
            "substeps": study.numerics.substeps,
            "quiet_s": study.numerics.quiet_s,
        },
        "varied": list(study.varied),
        "cases": [describe_case(case) for case in study.cases],
        "without_vertical": motions.without_vertical,
        "records": [_describe_motion(motion, study.cases[0].pier.gravity) for motion in motions.motions],
        "spectra": _spectra(motions.motions, study.cases[0].pier.gravity),
        "unusable": [asdict(file) for file in motions.unusable],
        "left_out": [asdict(file) for file in motions.left_out],
        "references": [
            {
                "record": reference.record,
                "case": reference.case,
                "columns": reference.columns,
                "theta_max_over_alpha": reference.theta_max_over_alpha,
                "source": reference.source,
            }
            for reference in study.references
        ],
    }


def _spectra(motions: list[Motion], gravity: float) -> dict[str, Any] | None:
    """Response spectra of the suite, where that is soon done."""
    return suite_spectra(motions, gravity) if len(motions) <= MOST_SPECTRA else None


def describe_case(case: Case) -> dict[str, Any]:
    """What run.json says about a case."""
    pier = case.pier
    return {
        "case": case.name,
        "columns": case.columns,
        "pier": {
            "alpha": pier.alpha,
            "p": pier.p,
            "mu": pier.mu,
            "gravity": pier.gravity,
            "size_m": pier.size,
            "half_width_m": pier.half_width,
            "height_m": pier.height,
        },
        "base": case.base.name,
        "parameters": _describe_base(pier, case.base),
    }


def _describe_base(pier: Pier, base: Base) -> dict[str, Any]:
    if isinstance(base, RigidBase):
        return {"restitution": base.restitution}
    told = _springs(pier, base)
    if isinstance(base, YieldingBase):
        told |= {
            "eta": base.eta,
            "spring": base.spring,
            "n": base.n,
            "delta_y_m": base.eta * told["delta_s_m"],
        }
        if base.spring == "epp":
            del told["n"]
    return told


def _springs(pier: Pier, base: ElasticBase) -> dict[str, Any]:
    omega_v = base.beta * pier.p
    return {
        "beta": base.beta,
        "epsilon": base.epsilon,
        "kinematics": base.kinematics,
        "flight": base.flight,
        "omega_v": omega_v,
        "delta_s_m": pier.gravity / omega_v**2,
    }


def _describe_motion(motion: Motion, gravity: float) -> dict[str, Any]:
    vertical = motion.pga_vertical
    return {
        "record": motion.name,
        "dt_s": motion.dt,
        "npts": motion.npts,
        "duration_s": motion.duration,
        "pga_g": motion.pga / gravity,
        "pga_v_g": None if vertical is None else vertical / gravity,
        "pgv_m_s": measures.pgv(motion.horizontal, motion.dt, motion.initial),
        "pgd_m": measures.believable_pgd(motion),
        "arias_m_s": measures.arias_intensity(motion.horizontal, motion.dt, gravity),
        "d5_95_s": measures.significant_duration(motion.horizontal, motion.dt),
        "azimuth_deg": motion.azimuth,
        "magnitude": motion.magnitude,
        "distance_km": motion.distance_km,
        "factor": motion.factor,
        "source": motion.source,
        "vertical_source": motion.vertical_source,
        "processed": motion.processed,
        "findings": [asdict(finding) for finding in motion.findings],
        "notes": list(motion.notes),
    }


PEAKS = "peaks.csv"
PART = f"{PEAKS}.part"
"""Finished runs of a table that is under way."""
INFO = "run.json"
REPORT = "report.html"


def write_info(directory: Path, info: Mapping[str, Any]) -> None:
    """Write run.json into ``directory``, whole or not at all."""
    write_whole(directory / INFO, json.dumps(info, indent=1, ensure_ascii=False) + "\n")
