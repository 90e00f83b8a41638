"""Write the results of finished runs into a folder: peaks.csv, run.json, histories and further tables."""

import json
from collections.abc import Callable, Collection, Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

from rockbatch.batch.beside import rows_beside
from rockbatch.batch.journal import Journal
from rockbatch.batch.kept_histories import keep_histories, to_keep
from rockbatch.batch.listening import announced_if_slow
from rockbatch.batch.preparing import OUTPUTS, Batch
from rockbatch.batch.threads import cores
from rockbatch.common.errors import InputError
from rockbatch.common.files import is_plain, remove
from rockbatch.common.observers import parts, tables
from rockbatch.quantities.rows import PEAKS
from rockbatch.results.beside_peaks import write
from rockbatch.results.columns import unusable_rows
from rockbatch.results.histories_file import HISTORIES
from rockbatch.results.labelled import Row
from rockbatch.results.opened import Results, open_results
from rockbatch.results.run_json import INFO, write_info
from rockbatch.study import Study

_OF_COMMAND = ("created", "command", "machine", "jobs", "wall_s", "kept", "peaks")
"""Entries of run.json about the command instead of its results."""


@dataclass(frozen=True, eq=False)
class Written:
    """Results written into a folder: the opened folder, its files, and the reason if histories are missing, else None."""

    saved: Results
    files: tuple[Path, ...]
    without: InputError | None


def unchanged(batch: Batch) -> Written | None:
    """Return the results in the folder of a finished ``batch`` if writing them again would change nothing; else None."""
    directory, study, runs = batch.directory, batch.study, batch.runs
    saved = open_results(directory)
    info = json.loads(json.dumps(batch.info))
    if any(saved.info.get(name) != value for name, value in info.items() if name not in _OF_COMMAND):
        return None
    kept = len(to_keep(study, runs, saved.peaks.iloc[: len(runs)]).numbers)
    try:
        histories = [HISTORIES] if len(saved.responses) else []
        if len(saved.responses) < kept:
            return None
    except (InputError, OSError):  # damaged, or of an earlier run
        return None
    files = tuple(directory / name for name in (PEAKS, INFO, *_beside_peaks(batch), *histories))
    return Written(saved, files, None) if all(map(is_plain, files)) else None


def write_peaks(batch: Batch, journal: Journal) -> Row:
    """Write peaks.csv, after removing the files of an earlier one, so that they cannot be mixed up.

    Returns its number of rows and its digest for run.json.
    """
    for name in (*OUTPUTS[1:], *batch.later):
        remove(batch.directory / name)
    return journal.write_in_order(batch.directory / PEAKS, unusable_rows(batch.motions))._asdict()


def finish(batch: Batch, journal: Journal, cost: Row, records: Collection[str] = ()) -> Written:
    """Write run.json, tables beside peaks.csv and histories: the study's and all of ``records``.

    ``cost`` holds the entries ``peaks``, ``jobs``, ``wall_s`` and ``kept`` of run.json.
    """
    directory, listener = batch.directory, batch.listener
    for name in batch.later:  # these are written last: their presence shows that the folder is complete
        remove(directory / name)
    with announced_if_slow(listener, f"writing {INFO}"):
        write_info(directory, batch.info | cost)
        saved = open_results(directory)
    histories, refusal = _keep_histories(batch, saved, records)
    beside = [write(directory / name, rows) for name, rows in _tables(batch, saved, journal)]
    files = (directory / PEAKS, directory / INFO, *beside, histories)
    return Written(saved, tuple(path for path in files if path), refusal)


def _of_peaks(study: Study) -> dict[str, Callable[..., Iterable[Row]]]:
    """Return the functions of observers that make a table beside peaks.csv of finished peaks, by its name."""
    return {table: rows for requested, rows in parts("observe.TABLE_OF_PEAKS") if (table := requested(study))}


def _beside_peaks(batch: Batch) -> list[str]:
    """Return the names of the tables that stand beside peaks.csv: those made of the peaks, then those of observers."""
    return [*_of_peaks(batch.study), *(observer.table for observer in batch.observers)]


def _tables(batch: Batch, saved: Results, journal: Journal) -> Iterator[tuple[str, Iterable[Row]]]:
    """Yield name and rows of the tables beside peaks.csv, after removing those no longer requested."""
    for name in set(tables()).difference(_beside_peaks(batch)):
        remove(batch.directory / name)
    for name, rows in _of_peaks(batch.study).items():
        yield name, rows(saved.peaks, batch.study, batch.motions.motions)
    jobs = min(int(saved.info["jobs"]) or cores(), cores())
    yield from rows_beside(batch.observers, batch.study, batch.runs, saved.peaks, journal, jobs, batch.listener).items()


def _keep_histories(batch: Batch, saved: Results, records: Collection[str]) -> tuple[Path | None, InputError | None]:
    """Write the histories of the study and of ``records``; return (file, None), or (None, None) if none are kept.

    (None, error) if the disk is full, or if some are too long for memory; the file then has the others. If none are kept, an
    earlier file is removed.
    """
    study, runs, listener = batch.study, batch.runs, batch.listener
    chosen = to_keep(study, runs, saved.peaks.iloc[: len(runs)], records)
    if chosen.left_out:
        number = len(chosen.numbers)
        listener.say(
            f"{HISTORIES}: {number} of the {number + chosen.left_out} worst runs, those with the greatest rotations; more would "
            f"exceed [output] histories_MB = {study.output.histories_MB:g}"
        )
    try:
        with announced_if_slow(listener, f"writing {HISTORIES}"), listener.progress(len(chosen.numbers)) as progress:
            path = keep_histories(saved, study, runs, progress, records)
    except InputError as error:
        return None, error
    if path is None:
        remove(saved.directory / HISTORIES)
    return path, None
