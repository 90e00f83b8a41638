"""Results of ``rockbatch accuracy`` in a folder."""

import csv
import math
from collections.abc import Sequence
from dataclasses import dataclass, fields
from pathlib import Path

from rockbatch.common.files import opened_text
from rockbatch.common.lazy import pd


@dataclass(frozen=True)
class Level:
    """One row of ``accuracy.csv``: a method at one setting, on this machine."""

    method: str  # "located", "not located" (events, at fixed steps), or "study", the setting of the study
    machine: str  # operating system, architecture and number of processors
    # steps per sample, and tolerance on θ_max/α, if given
    substeps: float | None
    tolerance: float | None
    runs: float | None  # number of runs
    compared: float | None  # number of runs with an error: those that end as the reference does and do not overturn
    # errors of θ_max/α of these runs, each no smaller than the uncertainty of its reference
    error_median: float | None
    error_95: float | None
    error_max: float | None
    seconds_per_run: float | None  # time per run [s]
    status_differs: float | None  # number of runs that end otherwise than the reference
    # change of θ_max/α by the last halving of the step of the least converged reference: the uncertainty of all
    reference_change: float | None

    @property
    def time(self) -> float:
        """Return the time per run [ms]; NaN if it was not measured."""
        return 1000 * (self.seconds_per_run or math.nan)

    @property
    def milliseconds(self) -> str:
        """Return the time per run [ms] as text, of three digits or, from 100 on, whole: "1.23"; empty if it was not measured."""
        return "" if self.seconds_per_run is None else f"{self.time:.0f}" if self.time >= 100 else f"{self.time:.3g}"


NUMBERS = [field.name for field in fields(Level)[2:]]
COLUMNS = ("method", *NUMBERS, "machine", "study")
"""Columns of ``accuracy.csv``; the last one is the SHA-256 of the study file."""


def read(path: Path, study: str) -> list[Level] | None:
    """Return the levels of ``accuracy.csv`` measured for the study with the SHA-256 ``study``.

    None if an earlier version wrote it, without the column ``compared``. Empty if the file is missing, belongs to another state
    of the study, or is no such table; the report then omits it.
    """
    try:
        with opened_text(path) as file:
            rows = list(csv.DictReader(file))
        if any(row["study"] != study for row in rows):
            return []
        if rows and {*COLUMNS} - rows[0].keys() == {"compared"}:
            return None
        return [Level(row["method"], row["machine"], *(_number(row[name]) for name in NUMBERS)) for row in rows]
    except (OSError, KeyError, TypeError, ValueError):
        return []


def _number(text: str) -> float | None:
    return float(text) if text else None


def of_table(table: "pd.DataFrame") -> list[Level]:
    """Return the levels of the table of which ``accuracy.csv`` is made, with None for NaN."""
    numbers = table[NUMBERS].astype(float)
    rows = zip(table["method"], table["machine"], numbers.to_numpy().tolist(), strict=True)
    return [Level(method, machine, *(None if x != x else x for x in row)) for method, machine, row in rows]


NO_ERROR = (
    "No error is known for the setting of this study: no measured run with it ends standing as its reference does."
)


def chosen(levels: Sequence[Level]) -> Level | None:
    """Return the level at the study's own setting; None if it lacks an error or a time, or was not measured."""
    of_study = next((level for level in levels if level.method == "study"), None)
    return of_study if of_study is not None and of_study.error_max is not None and of_study.seconds_per_run else None
