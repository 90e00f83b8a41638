"""Keep histories beside the peaks by repeating and recording their runs."""

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from rockbatch.batch.listening import Advance, silent
from rockbatch.batch.observers import observers_of
from rockbatch.batch.plan import simulations
from rockbatch.common.errors import InputError
from rockbatch.common.lazy import pd
from rockbatch.outcome.outcome import Outcome
from rockbatch.outcome.response import Response
from rockbatch.results.columns import StudyRun
from rockbatch.results.histories_file import HISTORIES, has_value, history_bytes, write
from rockbatch.results.reading import Saved
from rockbatch.simulation.histories import histories
from rockbatch.simulation.recording import recorded
from rockbatch.study import Study


def keep_histories(
    saved: Saved,
    study: Study,
    runs: Sequence[StudyRun],
    progress: Advance = silent,
    records: Collection[str] = (),
) -> Path | None:
    """Write ``histories.h5`` beside finished results: the histories the study requests, and all of ``records``.

    Histories are written one by one, with at most two in memory. Returns the path, or None if there is nothing to keep; an
    earlier file is replaced completely or not at all. Raises ``InputError`` if the disk is full and, after writing all
    others, if a history was too long for memory.
    """
    table = saved.peaks.iloc[: len(runs)]  # further rows are of files that could not be used
    chosen = to_keep(study, runs, table, records).numbers
    if not chosen:
        return None
    path = saved.directory / HISTORIES
    too_long: list[str] = []

    def responses() -> Iterator[Response]:
        for number in chosen:
            try:
                yield _response(study, runs[number], table.iloc[number])
            except InputError as error:
                too_long.extend(error.messages)
            progress(1)

    write(path, responses(), saved.info)
    if too_long:
        raise InputError(*too_long)
    return path


@dataclass(frozen=True)
class Kept:
    """Numbers of the runs whose histories are kept, in order, and the number left out because of their size."""

    numbers: list[int]
    left_out: int = 0


def to_keep(study: Study, runs: Sequence[StudyRun], table: "pd.DataFrame", records: Collection[str] = ()) -> Kept:
    """Choose the runs whose histories the study requests, and all of ``records``, except runs that were refused.

    ``table`` has a row for each of ``runs``. With histories = "worst", the :func:`worst` run of each case is taken, by decreasing
    rotation, until the file would exceed ``histories_MB``, but one whatever its size; ``records`` are taken whatever their size.
    """
    output, ran = study.output, table["theta_max_over_alpha"].notna()
    if output.histories == "all":
        return Kept([int(number) for number in ran.to_numpy().nonzero()[0]])
    named = [int(number) for number in (ran & table["record"].isin(records)).to_numpy().nonzero()[0]]
    if output.histories == "none":
        return Kept(named)
    chosen = worst(table, len(study.cases))
    rotations = table["theta_max_over_alpha"].to_numpy(float)
    numbers: list[int] = []
    size = 0.0
    for number in sorted(chosen, key=lambda number: -rotations[number]):
        size += history_bytes(runs[number], table.iloc[number])
        if numbers and size > 1e6 * output.histories_MB:
            break
        numbers.append(number)
    every = dict.fromkeys([*numbers, *named])
    return Kept(sorted(every, key=lambda number: number % len(study.cases)), len(chosen) - len(numbers))


def worst(table: "pd.DataFrame", cases: int) -> list[int]:
    """Return the number of each case's worst run, in the order of cases, without cases whose runs all failed; [] without runs.

    Overturned runs are worse than any rotation, the earliest worst. A run that stopped in flight counts by its rotation
    until then. Of equal runs the first is taken.
    """
    if table.empty:
        return []
    status = table["status"].to_numpy()
    falls = table["t_end_s"].where(status == "overturned", np.inf).fillna(np.inf).to_numpy(float).reshape(-1, cases)
    peaks = table["theta_max_over_alpha"].where(status != "failed").fillna(-np.inf)
    rotations = peaks.to_numpy(float).reshape(-1, cases)
    fell, stood = np.isfinite(falls).any(axis=0), np.isfinite(rotations).any(axis=0)
    of_case = np.where(fell, falls.argmin(axis=0), rotations.argmax(axis=0))
    return [int(cases * of_case[case] + case) for case in np.flatnonzero(fell | stood)]


def _response(study: Study, planned: StudyRun, row: "pd.Series") -> Response:
    """Repeat a run with the steps of its ``row``, and return its histories; ``InputError`` if they are too long for memory."""
    (run,), case = simulations([planned]), planned.case
    observers = [o for o in observers_of(study.output) if o.column and has_value(row, o.column)]
    counts = int(row["impacts"]), int(row["separations"])
    ended = Outcome(row["status"], row["reason"], 0.0, 0.0, *counts, None, row["t_end_s"], int(row["substeps"]))
    every_step = run.base.remembers or any(o.histories_of_steps for o in observers)
    recording = recorded(run, ended, study.numerics.quiet_s, every_step)
    return histories(
        recording, row["status"], case.name, case.columns, observers, polarity=planned.polarity, scale=planned.scale
    )
