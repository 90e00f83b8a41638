"""``run.json``: what was run, under which motions, with what."""

import hashlib
import json
import math
from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

from rockbatch.files import write_whole
from rockbatch.motions import MotionSet, measures
from rockbatch.motions.motion import Motion
from rockbatch.motions.spectrum import suite_spectra
from rockbatch.pier import (
    Base,
    ElasticBase,
    Pier,
    Restraint,
    RigidBase,
    YieldingBase,
    described,
    in_kilonewtons,
    static_deflection,
    vertical_frequency,
    yield_deflection,
)
from rockbatch.results.columns import units
from rockbatch.study import Case, Study

INFO = "run.json"

MOST_SPECTRA = 200
"""Motions whose spectra go into run.json; each takes about 10 ms."""


def describe(study: Study, motions: MotionSet) -> dict[str, Any]:
    """What run.json says about a study and its motions."""
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
        "units": units(study),
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
        "pier": described(pier),
        "base": case.base.name,
        "parameters": _describe_base(pier, case.base),
    }


def _describe_base(pier: Pier, base: Base) -> dict[str, Any]:
    if isinstance(base, RigidBase):
        of_frame = None if pier.deck_over_columns is None else pier.restitution  # None stands for Housner's
        own: dict[str, Any] = {"restitution": of_frame if base.restitution is None else base.restitution}
        return own | ({"restraints": [_described(each) for each in base.restraints]} if base.restraints else {})
    told = _springs(pier, base)
    if isinstance(base, YieldingBase):
        told |= {
            "eta": base.eta,
            "spring": base.spring,
            "n": base.n,
            "delta_y_m": yield_deflection(pier, base),
        }
        if not base.has_exponent:
            del told["n"]
    return told


def _described(restraint: Restraint) -> dict[str, Any]:
    values = {name: value for name, value in asdict(restraint).items() if value is not None}
    return {name: None if value == math.inf else value for name, value in values.items()}


def _springs(pier: Pier, base: ElasticBase) -> dict[str, Any]:
    return {
        "beta": base.beta,
        **({"epsilon": base.epsilon} if base.zeta is None else {"zeta": base.zeta}),
        "kinematics": base.kinematics,
        "flight": base.flight,
        "omega_v": vertical_frequency(pier, base),
        "delta_s_m": static_deflection(pier, base),
        **in_kilonewtons(pier, base),
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


def write_info(directory: Path, info: Mapping[str, Any]) -> None:
    """Write run.json into ``directory``, whole or not at all."""
    write_whole(directory / INFO, json.dumps(info, indent=1, ensure_ascii=False) + "\n")
