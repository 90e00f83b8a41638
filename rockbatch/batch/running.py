"""From a study to its table of peaks: in memory, in a folder that may hold a part of it, or joined from shares."""

import math
import os
import time
from collections.abc import Collection, Iterable, Sequence
from pathlib import Path
from typing import Any

from rockbatch.batch.compiling import make_ready
from rockbatch.batch.digests import study_digests
from rockbatch.batch.execution import InMemory, execute_runs, to_simulate
from rockbatch.batch.finishing import (
    OUTPUTS,
    FinishedBatch,
    cost_of_finished,
    finish,
    to_be_replaced,
    unchanged,
    what_was_run,
    write_peaks,
)
from rockbatch.batch.journal import Journal
from rockbatch.batch.listening import Listener, Progress, count, listener_of, once
from rockbatch.batch.observers import observers_beside, observers_of
from rockbatch.batch.plan import Plan
from rockbatch.batch.threads import Engine, engine_of
from rockbatch.common.arguments import checked
from rockbatch.common.errors import InputError
from rockbatch.common.files import refuse_irregular
from rockbatch.common.grouping import closest
from rockbatch.common.lazy import pd
from rockbatch.motions import MotionSet
from rockbatch.results.columns import JOURNAL, as_table, columns, unusable_rows
from rockbatch.results.run_json import FROM_PYTHON
from rockbatch.simulation.observing import Observer
from rockbatch.study import Motions, Study, given_study
from rockbatch.study.suite import ground_motions


@checked
def run(
    study: str | os.PathLike[str] | Study, out: str | os.PathLike[str] | None = None, *, motions: Motions = None,
    jobs: int | Engine | None = None, fresh: bool = False, progress: Progress = None,
) -> "pd.DataFrame":  # fmt: skip
    """Run every record of a study in every case.

    Parameters
    ----------
    study : path or Study
        A study file, or one that is loaded.
    out : path, optional
        Folder for the results of ``rockbatch run``: ``peaks.csv``, ``run.json``, the histories and checks that the study asks
        for, and ``report.html``. Runs that an earlier process finished there are kept; an interrupted one is
        continued. Without it nothing is kept on disk, and there are no histories.
    motions : path, MotionSet, Motion or list of Motion, optional
        What replaces all motions of the study: a file or folder, or motions.
    jobs : int or Engine, optional
        Number of threads, all processors by default; or a cluster, :class:`rockbatch.batch.dask.Dask`. The table does not
        depend on it.
    fresh : bool
        Whether to start over, instead of going on with what is finished in ``out``.
    progress : bool or function of two ints, optional
        True for a bar, in a notebook too; False for none; by default one where stderr is a terminal. Or what is called with
        the number of things that are done, and of all: first of the runs, then of the histories that are kept.

    Returns
    -------
    DataFrame, shape (rows of peaks.csv, columns)
        Row by row, by name, as in ``peaks.csv``: lengths in m, times in s, rotations over α; with ``out`` to the ten digits
        that are on disk.

    Raises
    ------
    InputError
        With every mistake in the study; for a folder with finished runs of another state of the study, and for one
        into which another process is writing; where histories that the study asks for are too long to be kept.

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
        return _in_memory(loaded, engine, listener)
    command = ["run", str(loaded.path) if loaded.in_file else f"(study {FROM_PYTHON}", "--out", os.fspath(out)]
    if motions is not None:
        command += [
            "--motions",
            os.fspath(motions) if isinstance(motions, str | os.PathLike) else f"(motions {FROM_PYTHON}",
        ]
    finished = run_into(Path(out), loaded, engine, listener, command=command, fresh=fresh)
    assert finished is not None  # no share is asked for
    if finished.without:
        raise finished.without
    return finished.saved.peaks


def _in_memory(study: Study, engine: Engine, listener: Listener) -> "pd.DataFrame":
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
    """Carry out what is not finished in ``directory`` yet, and write the results; return what is in it, None after a share.

    ``command`` are the words after ``rockbatch`` that do it again, for run.json. Of a ``share``, (i, n), the i-th of n shares
    alone is carried out, and left in its journal. All histories of ``records`` are kept, beside those that the study asks for.
    Raises ``InputError`` as :func:`run`.
    """
    started = time.monotonic()
    refuse_irregular(*(directory / name for name in OUTPUTS))
    motions = ground_motions(study)
    listener.motions(motions)
    check_records(records, motions)
    runs = Plan(study, motions)
    requested = share_of(len(runs), *share) if share else range(len(runs))
    digest = study_digests(study, motions)
    info = what_was_run(study, motions, runs, digest, command)
    beside = observers_beside(study.output, motions.motions)
    with Journal(
        directory / JOURNAL, columns(study), digest, fresh, runs=len(runs), tell=listener.say, beside=_tables(beside)
    ) as journal:
        cost = None if fresh or len(journal) else cost_of_finished(directory, info)
        if cost is not None:
            state = f"{described(study, motions)} are finished in {directory}"
            listener.say(f"{state}; nothing is left to run (--fresh runs them again)")
            if not records and (finished := unchanged(directory, beside, study, motions, runs, info)):
                return finished
            return finish(journal, beside, study, motions, runs, info | cost, listener, records)
        replaced = None if fresh or share else to_be_replaced(directory, study)
        if replaced:
            listener.say(f"{replaced}, will be replaced")
        of_share = f"; share {share[0]} of {share[1]} is {{}}" if share else ""
        with engine:
            every = count(len(to_simulate(runs, requested)), "run")
            listener.say(f"{described(study, motions)} on {engine}{of_share.format(every)}")
            cost = _execute_remaining(study, runs, requested, journal, beside, engine, listener)
        if share:
            listener.say(
                f"{journal.path}: share {share[0]} of {share[1]} is finished; `rockbatch merge` joins the shares"
            )
            return None
        cost |= {"peaks": write_peaks(journal, motions), "wall_s": round(time.monotonic() - started, 3)}
        return finish(journal, beside, study, motions, runs, info | cost, listener, records)


def merge(
    directory: Path, study: Study, shares: Iterable[Path], listener: Listener, command: Sequence[str]
) -> FinishedBatch:
    """Join the journals in the folders ``shares``, and write the results into ``directory``.

    ``command`` as in :func:`run_into`. Raises ``InputError`` with all that is wrong or missing in the
    shares; joined rows stay, so that the rest can be carried out there.
    """
    motions = ground_motions(study)
    listener.motions(motions)
    runs = Plan(study, motions)
    digest = study_digests(study, motions)
    beside = observers_beside(study.output, motions.motions)
    with Journal(
        directory / JOURNAL, columns(study), digest, runs=len(runs), tell=listener.say, beside=_tables(beside)
    ) as journal:
        problems = []
        for share in shares:
            try:
                journal.add_from(share / JOURNAL)
            except FileNotFoundError:
                problems.append(f"{share / JOURNAL}: not there; give folders that `rockbatch run --shard` has written")
            except InputError as error:
                problems += error.problems
        missing = [number for number in range(len(runs)) if number not in journal]
        if missing and not problems:
            problems.append(
                f"{len(missing)} of {len(runs)} rows are missing in these folders: {_ranges(missing)}; finish their shares "
                f"and merge again, or carry them out here: rockbatch run {study.path} --out {directory}"
            )
        if problems:
            raise InputError(*problems)
        info = what_was_run(study, motions, runs, digest, command)
        info |= {"peaks": write_peaks(journal, motions), "jobs": 0, "wall_s": 0.0, "kept": info["runs"]}
        return finish(journal, beside, study, motions, runs, info, listener)


def _tables(observers: Iterable[Observer]) -> list[str]:
    return [observer.table for observer in observers]


def _ranges(numbers: Sequence[int], most: int = 5) -> str:
    """Return numbers, counted from 1, as ranges: "1 to 12, 17"."""
    starts = [i for i, number in enumerate(numbers) if i == 0 or number != numbers[i - 1] + 1]
    ends = [i - 1 for i in starts[1:]] + [len(numbers) - 1]
    ranges = [
        f"{numbers[a] + 1} to {numbers[b] + 1}" if b > a else str(numbers[a] + 1)
        for a, b in zip(starts, ends, strict=True)
    ]
    return ", ".join(ranges[:most]) + (", …" if len(ranges) > most else "")


def check_records(records: Collection[str], motions: MotionSet) -> None:
    """Raise ``InputError`` for names of records that do not exist."""
    names = [motion.name for motion in motions.motions]
    wrong = []
    for name in (name for name in records if name not in names):
        near = closest(name, names)
        wrong.append(
            f"--history {name}: no such record; "
            + (f"did you mean {near}?" if near else f"there is {', '.join(names)}")
        )
    if wrong:
        raise InputError(*wrong)


def share_of(runs: int, share: int, shares: int) -> range:
    """Return the indices of a share of so many runs; ``InputError`` for more shares than runs."""
    if shares > runs:
        raise InputError(f"--shard {share}/{shares}: the study has {count(runs, 'run')}; make as many shares or fewer")
    return range(runs * (share - 1) // shares, runs * share // shares)


def _execute_remaining(
    study: Study,
    runs: Plan,
    requested: range,
    journal: Journal,
    beside: Sequence[Observer],
    engine: Engine,
    listener: Listener,
) -> dict[str, Any]:
    """Carry out the runs that are missing in the journal; return their entry in run.json."""
    every, remaining = (len(to_simulate(runs, requested, finished)) for finished in ((), journal))
    n_finished = every - remaining
    if n_finished:
        listener.say(f"{n_finished} of them are finished already, {remaining} are left (--fresh starts over)")
    try:
        with listener.progress(remaining) as progress:
            observers = (*observers_of(study.output), *beside)
            make_ready(study, listener, observers)
            execute_runs(runs, study.numerics, journal, engine, observers, among=requested, progress=progress)
    except KeyboardInterrupt:
        if n_done := every - len(to_simulate(runs, requested, journal)):
            listener.say(
                f"interrupted: {n_done} of {count(every, 'run')} are finished and kept in {journal.path}; "
                "the same command continues from there"
            )
        raise
    return {"jobs": engine.jobs, "kept": n_finished}


def described(study: Study, motions: MotionSet) -> str:
    """Return how many runs there are, and why: "2 records × 5 cases = 10 runs"."""
    factors = {
        "record": len(motions.motions),
        "scale": len(study.motions.scale),
        "case": len(study.cases),
    }
    counted = [count(n, noun) for noun, n in factors.items() if n > 1 or noun in ("record", "case")]
    stations = len({motion.of_station for motion in motions.motions})
    if stations < factors["record"]:
        counted[0] += f" of {count(stations, 'station')}"
    return f"{' × '.join(counted)} = {count(math.prod(factors.values()), 'run')}{once(study)}"
