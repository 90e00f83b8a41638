"""Every record in every case: the runs of a study, in groups side by side, and the groups in threads."""

import os
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from rockbatch.errors import InputError
from rockbatch.histories import energies, written
from rockbatch.motions import Motion
from rockbatch.outcome import Outcome
from rockbatch.plan import Plan, Run
from rockbatch.results import TERMS, as_table, row, unusable_rows
from rockbatch.simulation import Scene, Stop, first_substeps, run_all_fixed, run_all_to_tolerance, steps_of
from rockbatch.structure import YieldingBase
from rockbatch.study import Numerics, Output, Study, load_study
from rockbatch.study.suite import ground_motions

if TYPE_CHECKING:
    import pandas as pd

MOST_STEPS_OF_A_LEDGER = 1_000_000
"""Longer runs have no ledger in the table: each is written down whole, 100 bytes a step."""

LEAST_GROUP, MOST_GROUP = 32, 1024
"""Runs in a group: enough to fill the lanes; few enough that little is lost when the last ones leave them empty."""

STEPS_OF_A_GROUP = 2e7
"""About a second of work: how long an interrupt or the progress may have to wait."""

AHEAD = 2
"""Groups handed to each thread beforehand, so that none waits."""

NOTHING_MORE = Output(both_laws=False)


def outcomes_of(
    runs: Sequence[Run], numerics: Numerics, output: Output = NOTHING_MORE, stop: Stop | None = None
) -> list[Outcome | None]:
    """Simulate a group of runs, with what ``output`` asks for; ``None`` for those that ``stop`` has stopped."""
    stop = stop or Stop()
    scenes = [Scene(run.case.pier, run.case.base, run.motion) for run in runs]
    quiet_s = numerics.quiet_s
    if numerics.substeps is not None:
        outcomes = run_all_fixed(scenes, [numerics.substeps] * len(scenes), quiet_s, stop)
    else:
        assert numerics.tolerance is not None  # load_study gives one of the two
        outcomes = run_all_to_tolerance(scenes, numerics.tolerance, quiet_s, stop)
    if output.both_laws:
        outcomes = _with_other_law(scenes, outcomes, quiet_s, stop)
    if output.ledger:
        outcomes = [
            outcome and _with_ledger(scene, outcome, quiet_s, stop)
            for scene, outcome in zip(scenes, outcomes, strict=True)
        ]
    return outcomes


def _with_other_law(
    scenes: list[Scene], outcomes: list[Outcome | None], quiet_s: float, stop: Stop
) -> list[Outcome | None]:
    """With the settlement of yielding springs by the other spring law, at the steps that were kept."""
    yielding = {
        i: replace(scene, base=replace(scene.base, spring="epp" if scene.base.spring == "bouc-wen" else "bouc-wen"))
        for i, (scene, outcome) in enumerate(zip(scenes, outcomes, strict=True))
        if isinstance(scene.base, YieldingBase) and outcome is not None and outcome.was_run
    }
    substeps = [outcomes[i].substeps for i in yielding]  # type: ignore[union-attr]
    others = run_all_fixed(list(yielding.values()), substeps, quiet_s, stop)
    for i, other in zip(yielding, others, strict=True):
        outcome = outcomes[i]
        assert outcome is not None
        outcomes[i] = other and replace(outcome, settlement_other_law=other.settlement)
    return outcomes


def _with_ledger(scene: Scene, outcome: Outcome, quiet_s: float, stop: Stop) -> Outcome | None:
    """With the energy ledger at the end of the run, unless that is very long or was refused."""
    if stop:
        return None
    if not outcome.was_run or steps_of(scene.motion, outcome.substeps, quiet_s) > MOST_STEPS_OF_A_LEDGER:
        return outcome
    rows = written(scene.pier, scene.base, scene.motion, outcome, quiet_s, every_step=True)
    terms = energies(scene.pier, scene.base, scene.motion, rows)
    at_end = dict(zip(TERMS, map(float, terms[-1]), strict=True))
    return replace(outcome, energies=at_end | {"remainder": float(abs(terms[:, -1]).max())})


def cores() -> int:
    """Processors that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def compile_kernels(study: Study) -> None:
    """Have every kernel that the study needs compiled, or loaded, before the clock starts."""
    still = Motion("still", 1e-3, np.zeros(2))
    runs = [Run(still, "+", 1.0, case) for case in study.cases]
    outcomes_of(runs, replace(study.numerics, quiet_s=0.0), study.output)


def groups(runs: Sequence[Run], numerics: Numerics, jobs: int) -> Iterator[range]:
    """Consecutive runs to be simulated side by side, in order: a share for every thread, a second's work at most."""
    share = len(runs) // (3 * jobs)
    most = min(max(share, LEAST_GROUP), MOST_GROUP)
    first, work = 0, 0.0
    for i, run in enumerate(runs):
        substeps = numerics.substeps or 3 * first_substeps(run.case.pier, run.case.base, run.motion.dt)
        work += steps_of(run.motion, substeps, numerics.quiet_s)
        if i + 1 - first == most or work >= STEPS_OF_A_GROUP:
            yield range(first, i + 1)
            first, work = i + 1, 0.0
    if first < len(runs):
        yield range(first, len(runs))


def outcomes(
    runs: Sequence[Run], numerics: Numerics, jobs: int, output: Output = NOTHING_MORE
) -> Iterator[tuple[int, Outcome]]:
    """Index and outcome of every run, as they finish, on ``jobs`` threads; the kernels release the interpreter.

    What a run comes to depends neither on ``jobs`` nor on the others of its group, only the order does. After Ctrl-C
    comes what is finished by then, and ``KeyboardInterrupt``.
    """
    waiting = groups(runs, numerics, jobs)
    pending: dict[Future[list[Outcome | None]], range] = {}
    stop = Stop()
    pool = ThreadPoolExecutor(jobs)
    try:
        while True:
            while len(pending) < AHEAD * jobs and (group := next(waiting, None)):
                members = runs[group.start : group.stop]
                pending[pool.submit(outcomes_of, members, numerics, output, stop)] = group
            if not pending:
                return
            done, _ = wait(pending, return_when=FIRST_COMPLETED)
            for future in done:
                found = future.result()
                yield from _finished(pending.pop(future), found)
    except KeyboardInterrupt:
        stop.set()
        pool.shutdown(wait=True, cancel_futures=True)
        for future, group in pending.items():
            if not future.cancelled() and future.exception() is None:
                yield from _finished(group, future.result())
        raise
    finally:
        stop.set()
        pool.shutdown(wait=True, cancel_futures=True)


def _finished(group: range, found: list[Outcome | None]) -> Iterator[tuple[int, Outcome]]:
    return ((i, outcome) for i, outcome in zip(group, found, strict=True) if outcome is not None)


def run(
    study: str | os.PathLike[str] | Study,
    *,
    motions: str | os.PathLike[str] | None = None,
    jobs: int | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> "pd.DataFrame":
    """Run a study: the rows of peaks.csv.

    Parameters
    ----------
    study : path or Study
        A study file, or one that is loaded.
    motions : path, optional
        A file or folder that replaces all motions of a study file.
    jobs : int, optional
        Number of threads; all processors by default. The table does not depend on it.
    progress : function of two ints, optional
        Called with the number of finished runs and of all.

    Raises
    ------
    InputError
        With every mistake in the study.
    """
    if jobs is not None and jobs < 1:
        raise InputError(f"jobs = {jobs}: must be at least 1, or left out for all processors")
    if not isinstance(study, Study):
        study = load_study(Path(study), motions=motions)
    found = ground_motions(study)
    runs = Plan(study, found)
    rows: dict[int, dict[str, object]] = {}
    for index, outcome in outcomes(runs, study.numerics, jobs or cores(), study.output):
        rows[index] = row_of(runs[index], outcome)
        if progress:
            progress(len(rows), len(runs))
    return as_table([*(rows[i] for i in sorted(rows)), *unusable_rows(found)], study)


def row_of(run: Run, outcome: Outcome) -> dict[str, object]:
    """Row of peaks.csv of a run that is finished."""
    return row(run.motion.name, run.polarity, run.scale, run.case, outcome)
