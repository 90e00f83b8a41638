"""``run.json``: the study, its motions, and the versions of the packages used."""

import functools
import hashlib
import json
import math
import platform
from collections.abc import Sequence
from dataclasses import asdict, fields
from pathlib import Path

import numpy as np

from rockbatch.common.files import is_plain, read_text, replacing
from rockbatch.common.version import commit
from rockbatch.motions import MotionSet
from rockbatch.motions.description import entry, spectra
from rockbatch.motions.suites.scaling import verticals
from rockbatch.motions.suites.spectrum_target import PAIRS, SpectrumTarget
from rockbatch.motions.unused import Unusable
from rockbatch.pier import Base, Pier, described
from rockbatch.pier.bases import BASES
from rockbatch.pier.free_rocking import FreeRocking
from rockbatch.pier.restraints import DEVICE, KINDS
from rockbatch.pier.statics import COMPARED
from rockbatch.pier.traits import BOUNDS, WORDS
from rockbatch.quantities.rows import PEAKS
from rockbatch.results.columns import units
from rockbatch.results.labelled import Item, Row
from rockbatch.results.shape import Maybe
from rockbatch.study import Case, Study

INFO = "run.json"
STUDY_FROM_PYTHON, MOTIONS_FROM_PYTHON = "(study from Python)", "(motions from Python)"
"""Placeholders in the command of :func:`rockbatch.run` for what no file holds: it cannot be repeated."""

_NUMBER = (float, None)
_VALUES = {str: (float, str)}
_NUMBERS_OF_BASE = (*BOUNDS, "beta", "omega_v", "delta_s_m", "delta_y_m", "stiffness_kN_m", "yield_kN")
_OF_DEVICES = [field.name for kind in KINDS.values() for field in fields(kind)]
_RESTRAINT = {name: Maybe(_NUMBER) for name in _OF_DEVICES if name != "confirm"} | {
    "kind": Maybe(str),
    DEVICE: tuple(KINDS),
    "at": Maybe((float, str)),
    "side": Maybe(str),
}
_OPTIONAL_OF_PIER = (
    "mass_t",
    "top_m",
    "highest_m",
    "deck_height_m",
    "deck_over_columns",
    "flexural_period_s",
    "shaft_share",
)
_OF_FILE = {"name": str, "source": str, "reason": str, "station": Maybe(str), "named": Maybe(bool)}
_SPECTRA = {
    "damping": float,
    "period_s": [float],
    "sa_g": [[float]],
    "mean_sa_g": Maybe([_NUMBER]),
    "target_sa_g": Maybe([_NUMBER]),
}
_TARGET = {
    "spectrum": str,
    "range_s": [float],
    "factors": ("each", "suite", "both", "none"),
    "pairs": tuple(PAIRS),
    "alone": int,
    "at_least": float,
    "required": Maybe(bool),
    "period_s": [float],
    "sa_g": [float],
    "mean_sa_g": [float],
    "components_sa_g": Maybe([float]),
    "remarks": Maybe([str]),
    "code": Maybe(str),
    "stations": Maybe(int),
    "events": Maybe(int),
    "defined_to_s": Maybe(float),
    "record_factors": Maybe([float]),
    "family_factors": Maybe([float]),
    "zero_sa_g": Maybe([float]),
    "rocking_s": Maybe([float]),
}

SHAPE = {
    "rockbatch": str,
    "created": str,
    "command": [str],
    "study": {"path": str, "title": str, "notes": str, "text": str, "sha256": str}
    | {"checks": Maybe([{"path": str, "text": str}])},
    "versions": {str: str},
    "machine": str,
    "numerics": {"tolerance": _NUMBER, "substeps": (int, None), "quiet_s": float},
    "varied": [str],
    "cases": [
        {
            "case": str,
            "columns": _VALUES,
            "pier": dict.fromkeys(("alpha", "p", "mu", "gravity", "size_m", "half_width_m", "height_m"), float)
            | dict.fromkeys(_OPTIONAL_OF_PIER, Maybe(_NUMBER)),
            "base": tuple(BASES),
            "parameters": {name: Maybe(_NUMBER) for name in _NUMBERS_OF_BASE}
            | {"backbone": Maybe([[float]])}
            | {name: Maybe((str, None)) for name in WORDS}
            | {"restraints": Maybe([_RESTRAINT])},
            "across_of": Maybe(str),
        }
    ],
    "records": [
        {"record": str, "source": str, "vertical_source": (str, None), "notes": [str], "npts": int}
        | dict.fromkeys(("dt_s", "duration_s", "pga_g"), float)
        | dict.fromkeys(("pga_v_g", "pgv_m_s", "pgd_m"), _NUMBER)
        | dict.fromkeys(("arias_m_s", "d5_95_s", "azimuth_deg", "magnitude", "distance_km"), Maybe(_NUMBER))
        | {"pulse_period_s": Maybe(_NUMBER), "sha256": Maybe(str), "stations_of_shocks": Maybe([str])}
        | {name: Maybe((str, None)) for name in ("label", "event", "station", "station_name", "direction")}
        | {
            "factor": Maybe(float),
            "vertical_factor": Maybe(float),
            "processed": Maybe((bool, None)),
            "recorded": Maybe(bool),
            "digest": Maybe(str),
            "findings": Maybe([{"what": str, "text": str}]),
        }
    ],
    "unusable": [_OF_FILE],
    "references": [{"record": str, "case": str, "columns": _VALUES, "theta_max_over_alpha": float, "source": str}],
    "runs": int,
    "jobs": int,
    "wall_s": float,
    "kept": Maybe(int),
    "peaks": Maybe({"rows": int, "sha256": str}),
    "without_vertical": Maybe([str]),
    "spectra": Maybe((_SPECTRA, None)),
    "target": Maybe(_TARGET),
    "vertical_target": Maybe(_TARGET),
    "digest": Maybe({str: str}),
    "count": Maybe(("station", "component")),
    "left_out": Maybe([_OF_FILE]),
    "bounds": Maybe(
        [{"bound": str, "source": str, "changes": [str], "lacking": [{"case": str, "keys": [str]}]}],
    ),
}
"""Shape of the entries of run.json that programs read; the rest is for people."""

VERSIONS_OF = ("numba", "numpy", "pandas", "obspy", "h5py")
"""Packages whose versions are recorded with results."""


@functools.cache
def _of_packages() -> dict[str, str]:
    from importlib.metadata import version  # takes 20 ms, not needed to read results

    return {name: version(name) for name in VERSIONS_OF}


def versions() -> dict[str, str]:
    """Return the versions of Python and the packages that results depend on, and the commit of a checkout."""
    return {"python": platform.python_version(), **_of_packages()} | ({"commit": commit()} if commit() else {})


def describe(study: Study, motions: MotionSet) -> Row:
    """Return the entries of run.json on a study and its motions."""
    gravity = study.cases[0].pier.gravity
    target = study.motions.target if isinstance(study.motions.target, SpectrumTarget) else None
    compared = target is not None and target.factors == "none"
    fitted = [motion for motion in motions.motions if compared or motion.recorded]
    with_pulses = target is not None or study.output.has("intensity")
    labels = motions.labels
    return {
        "study": describe_study(study)
        | {"checks": [{"path": str(path), "text": text} for path, text in study.check_files]},
        "numerics": asdict(study.numerics),
        "varied": list(study.varied),
        "count": study.count,
        "units": units(study),
        "cases": [describe_case(case) for case in study.cases],
        **({"bounds": [bound.as_in_run_json() for bound in study.bounds]} if study.bounds else {}),
        "without_vertical": motions.without_vertical,
        "records": [entry(motion, labels[motion.name], gravity, with_pulse=with_pulses) for motion in motions.motions],
        "spectra": spectra(motions.motions, fitted, gravity, target),
        **(
            {}
            if target is None
            else {"target": target.run_json_entry(fitted, gravity) | rocking_periods(study.cases, target)}
        ),
        **_vertical_target(study, motions, gravity),
        "unusable": [_not_used(file) for file in motions.unusable],
        "left_out": [
            {"source": file.source} | asdict(file) | {"sources": list(file.sources)} for file in motions.left_out
        ],
        "references": [asdict(reference) for reference in study.references],
    }


def _not_used(file: Unusable) -> Row:
    """Return the entry of a file that is not used: its fields without the motion, what it ``lacks``, and its problem's class."""
    entry = {name: value for name, value in vars(file).items() if name != "motion"}
    return (
        {"source": file.source}
        | entry
        | {"sources": list(file.sources), "lacks": list(file.lacks), "kind": file.kind.__name__}
    )


def describe_study(study: Study) -> dict[str, str]:
    """Return path, title, notes and text of a study, and the SHA-256 of the text, which identifies its results."""
    sha256 = hashlib.sha256(study.text.encode()).hexdigest()
    named = {"path": str(study.path), "title": study.title, "notes": study.notes}
    return named | {"text": study.text, "sha256": sha256}


def is_of(directory: Path, sha256: str, records: Sequence[str] | None = None) -> bool:
    """Return whether a folder has results of the study with digest ``sha256``, of exactly ``records`` (in order) if given.

    False if run.json is missing or damaged, or peaks.csv is not a plain file.
    """
    try:
        info = json.loads(read_text(directory / INFO))
        alike = records is None or [record["record"] for record in info["records"]] == records
        is_same = bool(info["study"]["sha256"] == sha256 and alike)
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        return False
    return is_same and is_plain(directory / PEAKS)


def rocking_periods(cases: Sequence[Case], target: SpectrumTarget) -> dict[str, list[float]]:
    """Return {"rocking_s": [shortest, longest]}, the free-rocking periods [s] at 0.1 α of all cases, to five digits.

    {} if the target follows no code, or no case has a period.
    """
    kinds = [(case.pier, case.base) for case in cases] if target.code else []
    distinct = [kind for i, kind in enumerate(kinds) if kind not in kinds[:i]]
    periods = [period for kind in distinct for period in _period_at(*kind)]
    return {"rocking_s": [float(f"{period:.5g}") for period in (min(periods), max(periods))]} if periods else {}


def _period_at(pier: Pier, base: Base) -> list[float]:
    """Return the free-rocking period [s] at a tenth of α in a list; [] if the pier overturns there or its swings are uneven."""
    free, amplitude = FreeRocking(pier, base), COMPARED * pier.alpha
    if free.turn.unstable is not None and free.turn.unstable <= amplitude:
        return []
    period = float(free.swings(np.array([amplitude])).period[0])
    return [period] if math.isfinite(period) else []


def _vertical_target(study: Study, motions: MotionSet, gravity: float) -> Row:
    """Return {"vertical_target": …}, the entry of the vertical target spectrum; {} without one."""
    target = study.motions.vertical_target
    if not isinstance(target, SpectrumTarget):
        return {}
    return {"vertical_target": target.run_json_entry(verticals(motions.motions), gravity)}


def describe_case(case: Case) -> Row:
    """Return the entry of a case in run.json: name, columns, pier, base and its parameters; ``across_of`` only of one across."""
    pier = case.pier
    return {
        "case": case.name,
        "columns": case.columns,
        "pier": described(pier),
        "base": case.base.name,
        "parameters": case.base.parameters(pier),
        **({"across_of": case.across_of} if case.across_of else {}),
    }


def write_info(directory: Path, info: Item) -> None:
    """Write run.json completely or not at all: a line for each entry and each item of lists of objects."""
    with replacing(directory / INFO) as temporary, temporary.open("w", encoding="utf-8", newline="") as file:
        for number, (name, value) in enumerate(info.items()):
            file.write(("{" if number == 0 else ",") + f"\n {_json(name)}: ")
            if isinstance(value, list) and value and isinstance(value[0], dict):
                for place, item in enumerate(value):
                    file.write(("[" if place == 0 else ",") + f"\n  {_json(item)}")
                file.write("\n ]")
            else:
                file.write(_json(value))
        file.write("\n}\n")


def _json(value: object) -> str:
    return json.dumps(value, ensure_ascii=False).encode(errors="backslashreplace").decode()  # bytes that are no text
