"""Tables beside peaks.csv, with a row for each run that was simulated, in the same order and by the same names."""

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from rockbatch.checks.suite import simulated
from rockbatch.files import csv_text, write_whole
from rockbatch.lazy import pd
from rockbatch.motions import Motion
from rockbatch.pier import Pier
from rockbatch.study import Study

NAMING = ("record", "case", "polarity", "scale")
"""Columns that name a run, with those of the varied keys."""


class Ran(NamedTuple):
    """A run that was simulated: its names and its peak as in peaks.csv, its motion before ``scale``, and its pier."""

    row: dict[str, Any]
    motion: Motion
    scale: float
    pier: Pier


def runs(peaks: "pd.DataFrame", study: Study, motions: Sequence[Motion]) -> Iterator[Ran]:
    """The runs of ``peaks``, without mirror images."""
    by_name = {motion.name: motion for motion in motions}
    piers = {_key(case.name, case.columns, study.varied): case.pier for case in study.cases}
    kept = [*NAMING, *study.varied, "status", "theta_max_over_alpha"]
    table = simulated(peaks[peaks["case"] != ""])[kept]
    for row in ({str(name): value for name, value in each.items()} for each in table.to_dict("records")):
        pier = piers[_key(row["case"], row, study.varied)]
        yield Ran(row, by_name[row["record"]], float(row["scale"]), pier)


def write(path: Path, rows: Sequence[Mapping[str, Any]]) -> Path:
    """Write ``rows``, which have the same names, as a CSV; whole or not at all."""
    write_whole(path, csv_text(list(rows[0]) if rows else list(NAMING), rows))
    return path


def _key(case: str, columns: Mapping[str, Any], varied: Sequence[str]) -> tuple[object, ...]:
    """What tells a case from others; numbers as peaks.csv has them, in ten digits."""
    return (case, *(_plain(columns.get(name)) for name in varied))


def _plain(value: object) -> object:
    if value is None or value != value:
        return ""
    return float(f"{value:.10g}") if isinstance(value, float | int) else value
