"""Finished results as the report sees them: ``peaks.csv`` and ``run.json`` read, named and put in order."""

import csv
import json
import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rockbatch.errors import InputError
from rockbatch.study import PIER_KEYS

TEXTS = ("record", "case", "polarity", "status", "reason")
NUMBERS = (
    "scale", "theta_max_over_alpha", "theta_max_error", "t_max_s", "theta_res_over_alpha", "settlement_m",
    "impacts", "separations", "flight_s", "substeps", "t_end_s", "base_tilt_rad", "ductility_left",
    "ductility_right", "dissipated_left_J_kg", "dissipated_right_J_kg",
)  # fmt: skip
ASKED_FOR = ("theta_res_error", "settlement_other_law_m")
"""Numbers that are there where a study asks for them; and the terms of the energy ledger, ``energy_…``."""

SECTIONS = (
    "rockbatch", "created", "command", "study", "versions", "machine", "numerics", "varied", "cases",
    "records", "unusable", "references", "runs", "jobs", "wall_s",
)  # fmt: skip

SYMBOLS = {
    "alpha": ("α", "rad"),
    "p": ("p", "rad/s"),
    "mu": ("μ", ""),
    "gravity": ("g", "m/s²"),
    "size_m": ("R0", "m"),
    "width_m": ("width", "m"),
    "height_m": ("height", "m"),
    "beta": ("β", ""),
    "eta": ("η", ""),
    "epsilon": ("ε", ""),
    "n": ("n", ""),
    "restitution": ("e", ""),
    "stiffness_kN_m": ("K", "kN/m"),
    "yield_kN": ("F_y", "kN"),
    "mass_t": ("M", "t"),
}
BASE_KEYS = ("beta", "eta", "epsilon", "spring", "n", "kinematics", "flight", "restitution")


@dataclass(frozen=True)
class Series:
    """One foundation: a marker in the figures, a column in the tables."""

    label: str
    tick: str
    rigid: bool
    index: int  # among those of its kind, rigid or not


@dataclass(frozen=True)
class Run:
    """One row of ``peaks.csv`` that is a run.

    ``theta`` is θ_max/α and ``error`` its estimated error; ``alpha`` the slenderness [rad]; ``pier`` counts the
    varied piers.
    """

    record: str
    polarity: str
    scale: float
    status: str
    theta: float | None
    error: float | None
    alpha: float
    pier: int
    series: Series
    row: dict[str, Any]


@dataclass(frozen=True)
class Finished:
    """All that a folder of results holds.

    ``rows`` are those of ``peaks.csv``, also of files that could not be used; ``runs`` those that were
    simulated. ``piers`` are the words for the varied values of the pier, one for each; [""] where none varies.
    """

    info: dict[str, Any]
    rows: list[dict[str, Any]]
    runs: list[Run]
    piers: list[str]
    foundations: dict[tuple[object, ...], Series]

    def series(self, case: str, columns: dict[str, Any]) -> Series | None:
        """The foundation of a case with the given varied values, if the study has it."""
        return self.foundations.get(_foundation(case, columns, self.info))

    def record(self, name: str) -> dict[str, Any]:
        """What ``run.json`` knows about a ground motion; empty if nothing."""
        return next((record for record in self.info["records"] if record["record"] == name), {})

    def by_pga(self, runs: Sequence[Run]) -> list[str]:
        """Names of the records in ``runs``, the weakest first."""
        pga = {record["record"]: record["pga_g"] for record in self.info["records"]}
        return sorted({run.record for run in runs}, key=lambda name: (pga.get(name, math.inf), name))


def read(directory: Path) -> Finished:
    """Read ``peaks.csv`` and ``run.json``; raises ``InputError`` where one is missing or damaged."""
    problems: list[str] = []
    info = _read_info(directory / "run.json", problems)
    rows = _read_rows(directory / "peaks.csv", info.get("varied", []), problems)
    if problems:
        raise InputError(*problems)
    piers, pier_of = _piers(rows, info)
    foundations = _series(info)
    cases = {(_foundation(c["case"], c["columns"], info), _pier(c["columns"], info)): c for c in info["cases"]}
    runs, unknown = [], set()
    for row in (row for row in rows if row["case"]):
        foundation, pier = _foundation(row["case"], row, info), _pier(row, info)
        if (foundation, pier) not in cases:
            unknown.add(row["case"])
            continue
        alpha = float(cases[foundation, pier]["pier"]["alpha"])
        peak = (row["theta_max_over_alpha"], row["theta_max_error"])
        names = (row["record"], row["polarity"], row["scale"], row["status"])
        runs.append(Run(*names, *peak, alpha, pier_of[pier], foundations[foundation], row))
    if unknown:
        raise InputError(
            f"{directory}: peaks.csv has runs of case {', '.join(sorted(unknown))} that run.json does not list; "
            "the two files belong to different runs; start `rockbatch run` again"
        )
    return Finished(info, rows, runs, piers, foundations)


def quantity(key: str, value: object) -> str:
    """A value in words that stay on one line: "β = 40", "p = 0.38 rad/s", "kinematics finite"."""
    symbol, unit = SYMBOLS.get(key, (key, ""))
    if isinstance(value, float | int):
        return f"{symbol} = {value:.10g} {unit}".strip().replace(" ", "\u00a0")
    return f"{symbol} {value}"


def _read_info(path: Path, problems: list[str]) -> dict[str, Any]:
    try:
        info: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        problems.append(f"{path}: not there; give a folder that `rockbatch run` has written")
        return {}
    except ValueError as error:
        line = getattr(error, "lineno", 1)
        problems.append(f"{path}:{line}: not JSON ({error}); start `rockbatch run` again")
        return {}
    missing = [name for name in SECTIONS if name not in info]
    if missing:
        problems.append(f"{path}: has no {', '.join(missing)}; start `rockbatch run` again with this version")
    return info


def _read_rows(path: Path, varied: list[str], problems: list[str]) -> list[dict[str, Any]]:
    try:
        with path.open(encoding="utf-8", newline="") as file:
            reader = csv.DictReader(file)
            head = reader.fieldnames or []
            missing = [name for name in (*TEXTS, *NUMBERS, *varied) if name not in head]
            if missing:
                problems.append(f"{path}:1: has no column {', '.join(missing)}; start `rockbatch run` again")
                return []
            return [_row(raw, varied, f"{path}:{reader.line_num}", problems) for raw in reader]
    except FileNotFoundError:
        problems.append(f"{path}: not there; give a folder that `rockbatch run` has written")
        return []


def _row(raw: dict[str, str], varied: list[str], place: str, problems: list[str]) -> dict[str, Any]:
    row: dict[str, Any] = dict(raw)
    more = [name for name in raw if name in ASKED_FOR or str(name).startswith("energy_")]
    for name in (*NUMBERS, *more):
        try:
            value = float(raw[name]) if raw[name] else math.nan
        except (TypeError, ValueError):
            problems.append(f'{place}: {name} = "{raw[name]}": expected a number or nothing')
            value = math.nan
        row[name] = None if math.isnan(value) else value
    for name in varied:
        row[name] = _value(raw[name])
    return row


def _value(text: str) -> float | str:
    """A varied value: a number, or a word such as "finite"."""
    try:
        return float(text)
    except ValueError:
        return text


def _pier(columns: dict[str, Any], info: dict[str, Any]) -> tuple[object, ...]:
    return tuple(columns.get(key) for key in info["varied"] if key in PIER_KEYS)


def _foundation(case: str, columns: dict[str, Any], info: dict[str, Any]) -> tuple[object, ...]:
    """What tells one foundation from another: the case and its varied values, those of the pier apart."""
    # peaks.csv leaves a cell empty where run.json leaves the key out
    return (case, *(columns.get(key, "") for key in info["varied"] if key not in PIER_KEYS))


def _piers(rows: list[dict[str, Any]], info: dict[str, Any]) -> tuple[list[str], dict[tuple[object, ...], int]]:
    keys = [key for key in info["varied"] if key in PIER_KEYS]
    values = list(dict.fromkeys(_pier(row, info) for row in rows if row["case"])) or [()]
    words = [", ".join(map(quantity, keys, value)) for value in values]
    return words, {value: index for index, value in enumerate(values)}


def _series(info: dict[str, Any]) -> dict[tuple[object, ...], Series]:
    grouped: dict[tuple[object, ...], list[dict[str, Any]]] = {}
    for case in info["cases"]:
        grouped.setdefault(_foundation(case["case"], case["columns"], info), []).append(case)
    constants = {key: _constants(cases) for key, cases in grouped.items()}
    rigid = {key for key, cases in grouped.items() if cases[0]["base"] == "rigid"}

    names = [key[0] for key in grouped if key not in rigid]
    short = len(set(names)) == len(names) and all(len(str(name)) <= 3 for name in names)
    series: dict[tuple[object, ...], Series] = {}
    count = {True: 0, False: 0}
    for key in grouped:
        is_rigid = key in rigid
        alike = [constants[other] for other in grouped if (other in rigid) == is_rigid]
        keys = (*BASE_KEYS, *info["varied"])
        differs = [name for name in keys if len({str(other.get(name)) for other in alike}) > 1]
        shown = [name for name in dict.fromkeys(differs) if name in constants[key]]
        words = [quantity(name, constants[key][name]) for name in shown]
        case = str(key[0])
        index = count[is_rigid]
        count[is_rigid] += 1
        label = f"{case}: {', '.join(words)}" if words else case
        tick = case if short else chr(ord("a") + index) if index < 26 else str(index + 1)
        series[key] = Series(label, tick, is_rigid, index)
    return series


def _constants(cases: list[dict[str, Any]]) -> dict[str, object]:
    """Values that a foundation keeps on every pier; β of a given stiffness, for one, follows the pier."""
    first = {**cases[0]["parameters"], **cases[0]["columns"]}
    return {
        key: value
        for key, value in first.items()
        if key not in PIER_KEYS
        and value is not None
        and all({**case["parameters"], **case["columns"]}.get(key) == value for case in cases)
    }
