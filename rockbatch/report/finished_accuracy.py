"""What ``rockbatch accuracy`` left in a folder."""

import csv
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from rockbatch.files import opened_text

NUMBERS = (
    "substeps", "tolerance", "runs", "error_median", "error_95", "error_max", "seconds_per_run", "status_differs",
    "reference_change",
)  # fmt: skip


@dataclass(frozen=True)
class Level:
    """One row of ``accuracy.csv``: a method at one setting; errors of θ_max/α, times in seconds per run."""

    method: str
    machine: str
    substeps: float | None
    tolerance: float | None
    runs: float | None
    error_median: float | None
    error_95: float | None
    error_max: float | None
    seconds_per_run: float | None
    status_differs: float | None
    reference_change: float | None

    @property
    def milliseconds(self) -> str:
        """Time per run [ms] in words; empty where it was not measured."""
        if self.seconds_per_run is None:
            return ""
        value = 1000 * self.seconds_per_run
        return f"{value:.0f}" if value >= 100 else f"{value:.3g}"


def read(path: Path, study: str) -> list[Level]:
    """Levels of ``accuracy.csv`` as measured for the study with the SHA-256 ``study``.

    Empty where the file is missing, of another state of the study, or not such a table: the report does without.
    """
    try:
        with opened_text(path) as file:
            rows = list(csv.DictReader(file))
        if any(row["study"] != study for row in rows):
            return []
        return [Level(row["method"], row["machine"], *(_number(row[name]) for name in NUMBERS)) for row in rows]
    except (OSError, KeyError, TypeError, ValueError):
        return []


def _number(text: str) -> float | None:
    return float(text) if text else None


def chosen(levels: Sequence[Level]) -> Level | None:
    """The study's own setting, where it was measured."""
    own = next((level for level in levels if level.method == "study"), None)
    return own if own is not None and own.error_max is not None and own.seconds_per_run else None
