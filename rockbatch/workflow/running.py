"""Run a study: return its table, or write its results into a folder, checked and reported."""

import os
import time
from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from rockbatch.batch.carrying_out import execute
from rockbatch.batch.execution import InMemory, execute_runs, to_simulate
from rockbatch.batch.finishing import Written, finish, unchanged, write_peaks
from rockbatch.batch.listening import Listener, Progress, announced_if_slow, count, listener_of
from rockbatch.batch.observers import observers_of
from rockbatch.batch.plan import Plan
from rockbatch.batch.preparing import Batch, cost_of_finished, prepare, share_of, to_be_replaced
from rockbatch.batch.threads import Engine, engine_of
from rockbatch.checks import Verdict, write_verdicts
from rockbatch.checks.suite_target import suite_verdicts
from rockbatch.checks.verdicts import CHECKS
from rockbatch.common.arguments import checked
from rockbatch.common.errors import InputError
from rockbatch.common.files import is_plain
from rockbatch.common.lazy import pd
from rockbatch.motions import MotionSet
from rockbatch.reporting import REPORT, write_report
from rockbatch.results.checking import verdicts
from rockbatch.results.columns import JOURNAL, as_table, columns, units, unusable_rows, with_units
from rockbatch.results.reading import Saved
from rockbatch.results.run_json import MOTIONS_FROM_PYTHON, STUDY_FROM_PYTHON
from rockbatch.study import Motions, Study, given_study
from rockbatch.study.suite import ground_motions


@dataclass(frozen=True, eq=False)
class FinishedBatch:
    """Results written into a folder, checked and reported.

    Attributes
    ----------
    saved : Saved
        ``peaks.csv`` and ``run.json``.
    motions : MotionSet
        The study's ground motions, and the files that could not be used.
    verdicts : list of Verdict
        Verdicts on the study's checks and its target spectrum; empty if it has neither.
    files : tuple of Path
        Paths of the table, run.json, and histories, checks and report if written.
    without : InputError or None
        The reason why requested histories are missing; None if none are.
    """

    saved: Saved
    motions: MotionSet
    verdicts: list[Verdict]
    files: tuple[Path, ...]
    without: InputError | None


@checked
def run(
    study: str | os.PathLike[str] | Study,
    out: str | os.PathLike[str] | None = None,
    *,
    motions: Motions = None,
    jobs: int | Engine | None = None,
    fresh: bool = False,
    progress: Progress = None,
) -> "pd.DataFrame":
    """Run every record of a study in every case.

    Parameters
    ----------
    study : path or Study
        A study file, or a loaded study.
    out : path, optional
        Folder for the results of ``rockbatch run``: ``peaks.csv``, ``run.json``, the study's histories and checks, and
        ``report.html``. Runs finished there earlier are kept, so that an interrupted batch continues. Without ``out``
        nothing is written, and no histories are kept.
    motions : path, MotionSet, Motion or list of Motion, optional
        Replacement for all motions of the study: a file, a folder, or motions.
    jobs : int or Engine, optional
        Number of threads, all processors by default; or a cluster, :class:`rockbatch.batch.dask.Dask`. The table does not
        depend on it.
    fresh : bool
        Whether to start over instead of keeping the finished runs in ``out``.
    progress : bool or function of two ints, optional
        True for a progress bar, also in notebooks; False for none; by default a bar if stderr is a terminal. A function is
        called with the numbers of finished items and of all: first of runs, then of kept histories.

    Returns
    -------
    DataFrame, shape (rows of peaks.csv, columns)
        The rows and columns of ``peaks.csv``: lengths in m, times in s, rotations over α; with ``out`` to the ten digits
        on disk. ``attrs["units"]`` has the unit of each column of numbers.

    Raises
    ------
    InputError
        With every mistake in the study; if ``out`` has finished runs of another version of the study, or another process is
        writing into it; if requested histories are too long to keep.

    Examples
    --------
    >>> table = rb.run("pier4.toml")
    >>> table.groupby("case")["theta_max_over_alpha"].median().round(4)
    case
    pads     0.1741
    rigid    0.2100
    Name: theta_max_over_alpha, dtype: float64
    >>> kept = rb.run("pier4.toml", out="reports/pier4")
    >>> rb.open_results("reports/pier4").history(record="one-sine", case="rigid")[["t", "theta"]].tail(1)
           t     theta
    407  4.0  0.019396
    """
    loaded, listener, engine = given_study(study, motions), listener_of(progress), engine_of(jobs)
    if out is None:
        return with_units(_in_memory(loaded, engine, listener), units(loaded))
    command = ["run", str(loaded.path) if loaded.in_file else STUDY_FROM_PYTHON, "--out", os.fspath(out)]
    if motions is not None:
        path = os.fspath(motions) if isinstance(motions, str | os.PathLike) else MOTIONS_FROM_PYTHON
        command += ["--motions", path]
    finished = run_into(Path(out), loaded, engine, listener, command=command, fresh=fresh)
    assert finished is not None  # None only for a share
    if finished.without:
        raise finished.without
    return with_units(finished.saved.peaks, units(loaded))


def _in_memory(study: Study, engine: Engine, listener: Listener) -> "pd.DataFrame":
    """Carry out a study without a folder; return its table, with a row for each unusable file at the end."""
    motions = ground_motions(study)
    listener.motions(motions)
    runs, rows = Plan(study, motions), InMemory(columns(study))
    with engine, listener.progress(len(to_simulate(runs, range(len(runs))))) as progress:
        execute_runs(runs, study.numerics, rows, engine, observers_of(study.output), progress=progress)
    return as_table([*(rows[i] for i in sorted(rows)), *unusable_rows(motions)], study)


def run_into(
    directory: Path,
    study: Study,
    engine: Engine,
    listener: Listener,
    *,
    command: Sequence[str],
    fresh: bool = False,
    share: tuple[int, int] | None = None,
    records: Collection[str] = (),
) -> FinishedBatch | None:
    """Carry out the unfinished runs of ``study`` and write its results into ``directory``; return them, None for a share.

    ``command`` holds the words after ``rockbatch`` that repeat it, for run.json. With ``share`` (i, n) only the i-th of n
    shares is carried out, and stays in its journal, unless the folder has all results already: they are returned. All histories
    of ``records`` are kept in addition to the study's. Raises ``InputError`` as :func:`run`.
    """
    started = time.monotonic()
    batch = prepare(directory, study, listener, command, records=records, later=(CHECKS, REPORT))
    requested = share_of(batch.runs, *share) if share else range(len(batch.runs))
    with batch.journal(fresh) as journal:
        cost = None if fresh or len(journal) else cost_of_finished(directory, batch.info)
        if cost is not None:
            state = f"{batch.run_count} are finished in {directory}"
            listener.say(f"{state}; nothing is left to run (--fresh runs them again)")
            if not records and (finished := _unchanged(batch)):
                return finished
            return _check_and_report(batch, finish(batch, journal, cost, records))
        replaced = None if fresh or share else to_be_replaced(directory, study)
        if replaced:
            listener.say(f"{replaced}, will be replaced")
        of_share = f"; share {share[0]} of {share[1]} is {{}}" if share else ""
        with engine:
            every = count(len(to_simulate(batch.runs, requested)), "run")
            listener.say(f"{batch.run_count} on {engine}{of_share.format(every)}")
            cost = execute(batch, requested, journal, engine)
        if share:
            listener.say(
                f"{journal.path}: share {share[0]} of {share[1]} is finished; `rockbatch merge` joins the shares"
            )
            return None
        cost |= {"peaks": write_peaks(batch, journal), "wall_s": round(time.monotonic() - started, 3)}
        return _check_and_report(batch, finish(batch, journal, cost, records))


def merge(
    directory: Path, study: Study, shares: Iterable[Path], listener: Listener, command: Sequence[str]
) -> FinishedBatch:
    """Join the journals in the folders ``shares``, write the results into ``directory`` and return them.

    ``command`` as in :func:`run_into`. Raises ``InputError`` with everything wrong or missing in the shares; joined rows stay in
    ``directory``, so that the rest can be carried out there.
    """
    batch = prepare(directory, study, listener, command, later=(CHECKS, REPORT))
    with batch.journal() as journal:
        problems = []
        for share in shares:
            try:
                journal.add_from(share / JOURNAL)
            except FileNotFoundError:
                problems.append(f"{share / JOURNAL}: not there; give folders written by `rockbatch run --shard`")
            except InputError as error:
                problems += error.messages
        missing = [number for number in range(len(batch.runs)) if number not in journal]
        if missing and not problems:
            problems.append(
                f"{len(missing)} of {len(batch.runs)} rows are missing in these folders: {_ranges(missing)}; finish their "
                f"shares and merge again, or carry them out here: rockbatch run {study.path} --out {directory}"
            )
        if problems:
            raise InputError(*problems)
        cost = {"peaks": write_peaks(batch, journal), "jobs": 0, "wall_s": 0.0, "kept": batch.info["runs"]}
        return _check_and_report(batch, finish(batch, journal, cost))


def _check_and_report(batch: Batch, written: Written) -> FinishedBatch:
    """Write the verdicts of a batch, if any, and its report; return all results."""
    study, directory, saved = batch.study, batch.directory, written.saved
    with announced_if_slow(batch.listener, f"applying {len(study.checks)} checks to {len(study.cases)} cases"):
        judged = _verdicts(saved, study)
        checks = [write_verdicts(directory, judged)] if judged else []
    with announced_if_slow(batch.listener, f"writing {REPORT}"):
        report = write_report(directory, saved=saved)
    return FinishedBatch(saved, batch.motions, judged, (*written.files, *checks, report), written.without)


def _unchanged(batch: Batch) -> FinishedBatch | None:
    """Return the results of a finished ``batch`` if its tables are as written, and checks and report are there; else None."""
    if not (written := unchanged(batch)):
        return None
    try:
        judged = _verdicts(written.saved, batch.study)
    except InputError:  # a table beside peaks.csv is not as it was written
        return None
    more = [batch.directory / name for name in (*([CHECKS] if judged else []), REPORT)]
    if not all(map(is_plain, more)):
        return None
    return FinishedBatch(written.saved, batch.motions, judged, (*written.files, *more), None)


def _verdicts(saved: Saved, study: Study) -> list[Verdict]:
    """Return the verdicts on the study's checks and its target spectrum; empty if it has neither."""
    return verdicts(saved) if study.checks or suite_verdicts(saved.info, ()) else []


def _ranges(numbers: Sequence[int], most: int = 5) -> str:
    """Return rising indices, one or more, as ranges from 1: "1 to 12, 17"; of more than ``most`` the first, then "…"."""
    starts = [i for i, number in enumerate(numbers) if i == 0 or number != numbers[i - 1] + 1]
    ends = [i - 1 for i in starts[1:]] + [len(numbers) - 1]
    ranges = []
    for start, end in zip(starts, ends, strict=True):
        first, last = numbers[start] + 1, numbers[end] + 1
        ranges.append(f"{first} to {last}" if last > first else str(first))
    return ", ".join(ranges[:most]) + (", …" if len(ranges) > most else "")
