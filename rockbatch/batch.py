"""Every record in every case: the runs of a study, side by side in threads."""

import math
import os
from collections.abc import Callable, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from dataclasses import dataclass, replace
from pathlib import Path
from threading import Event
from typing import TYPE_CHECKING

import numpy as np

from rockbatch.errors import InputError
from rockbatch.histories import energies, written
from rockbatch.motions import Motion, MotionSet, ReadOptions, pulse, read_motions
from rockbatch.outcome import Outcome
from rockbatch.results import TERMS, as_table, row, unusable_rows
from rockbatch.simulation import least_substeps, run_fixed, run_to_tolerance, steps_of
from rockbatch.structure import RigidBase, YieldingBase
from rockbatch.study import Case, Numerics, Output, Study, load_study

if TYPE_CHECKING:
    import pandas as pd

MOST_STEPS_OF_A_LEDGER = 1_000_000
"""Longer runs have no ledger in the table: each is written down whole, 100 bytes a step."""

AHEAD = 8
"""Runs handed to each thread beforehand, so that none waits and an interrupt has little to undo."""


NOTHING_MORE = Output(both_laws=False)


@dataclass(frozen=True)
class Run:
    """One simulation: a motion, already scaled and turned, in a case."""

    motion: Motion
    polarity: str
    scale: float
    case: Case


def ground_motions(study: Study) -> MotionSet:
    """All motions of a study: its files, packaged records and pulses, and what could not be used."""
    spec = study.motions
    gravity = study.cases[0].pier.gravity
    options = ReadOptions(unit=spec.unit, dt=spec.dt, columns=spec.columns, sensitivity=spec.sensitivity)
    found = read_motions(
        spec.paths,
        vertical=spec.vertical,
        gravity=gravity,
        options=options,
        fema=[(record.station, record.azimuth) for record in spec.fema_p695],
    )
    pulses = [
        pulse(
            shape.shape,
            name=shape.name,
            amplitude=shape.amplitude_g * gravity,
            period=shape.period_s,
            dt=shape.dt_s,
            duration=shape.duration_s,
            gamma=shape.gamma,
            nu=shape.nu,
        )
        for shape in spec.pulses
    ]
    if not found.motions and not pulses:
        reasons = [f"{file.source}: {file.reason}" for file in found.unusable]
        where = ", ".join(str(path) for path in spec.paths)
        raise InputError(f"{where}: no ground motion that can be used; `rockbatch motions PATH` shows why", *reasons)
    return replace(found, motions=[*found.motions, *pulses])


def scaled(motion: Motion, scale: float, polarity: str) -> Motion:
    """A motion times ``scale``; with polarity "-" its horizontal component is reversed."""
    if scale == 1.0 and polarity == "+":
        return motion
    vertical = None if motion.vertical is None else motion.vertical * scale
    sign = -scale if polarity == "-" else scale
    return replace(motion, horizontal=motion.horizontal * sign, vertical=vertical)


def plan(study: Study, motions: MotionSet) -> list[Run]:
    """The runs of a study, in the order of its table: record, polarity, scale, case."""
    runs = []
    for motion in motions.motions:
        for polarity in study.motions.polarity:
            for scale in study.motions.scale:
                variant = scaled(motion, scale, polarity)
                runs += [Run(variant, polarity, scale, case) for case in study.cases]
    return runs


def outcome_of(run: Run, numerics: Numerics, output: Output = NOTHING_MORE, stop: Event | None = None) -> Outcome:
    """Simulate one run, with what ``output`` asks for; ``InterruptedError`` if ``stop`` is set before it is done."""
    pier, base, motion, quiet_s = run.case.pier, run.case.base, run.motion, numerics.quiet_s
    if numerics.substeps is not None:
        outcome = run_fixed(pier, base, motion, numerics.substeps, quiet_s)
    else:
        assert numerics.tolerance is not None  # load_study gives one of the two
        outcome = run_to_tolerance(pier, base, motion, numerics.tolerance, quiet_s, stop)
    if math.isnan(outcome.theta_max):  # nothing was run
        return outcome
    if output.both_laws and isinstance(base, YieldingBase):
        other = replace(base, spring="epp" if base.spring == "bouc-wen" else "bouc-wen")
        by_other_law = run_fixed(pier, other, motion, outcome.substeps, quiet_s)
        outcome = replace(outcome, settlement_other_law=by_other_law.settlement)
    if output.ledger and steps_of(motion, outcome.substeps, quiet_s) <= MOST_STEPS_OF_A_LEDGER:
        terms = energies(pier, base, motion, written(pier, base, motion, outcome, quiet_s, every_step=True))
        at_end = dict(zip(TERMS, map(float, terms[-1]), strict=True))
        outcome = replace(outcome, energies=at_end | {"remainder": float(abs(terms[:, -1]).max())})
    return outcome


def cores() -> int:
    """Processors that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def compile_kernels(runs: list[Run], output: Output = NOTHING_MORE) -> None:
    """Have every kernel that ``runs`` need compiled, or loaded, before the clock starts."""
    still = Motion("still", 0.01, np.zeros(2))
    for run in {isinstance(run.case.base, RigidBase): run for run in runs}.values():
        substeps = least_substeps(run.case.pier, run.case.base, still.dt)
        outcome_of(replace(run, motion=still), Numerics(None, substeps, 0.0), output)


def outcomes(
    runs: list[Run], numerics: Numerics, jobs: int, output: Output = NOTHING_MORE
) -> Iterator[tuple[int, Outcome]]:
    """Index and outcome of every run, as they finish, on ``jobs`` threads; the kernels release the interpreter.

    What a run comes to does not depend on ``jobs``, only the order does.
    """
    waiting = iter(enumerate(runs))
    pending: dict[Future[Outcome], int] = {}
    stop = Event()
    pool = ThreadPoolExecutor(jobs)
    try:
        while True:
            while len(pending) < AHEAD * jobs and (entry := next(waiting, None)):
                pending[pool.submit(outcome_of, entry[1], numerics, output, stop)] = entry[0]
            if not pending:
                return
            done, _ = wait(pending, return_when=FIRST_COMPLETED)
            for future in done:
                yield pending.pop(future), future.result()
    except KeyboardInterrupt:  # what is finished by then is kept
        stop.set()
        pool.shutdown(wait=True, cancel_futures=True)
        for future, index in pending.items():
            if not future.cancelled() and future.exception() is None:
                yield index, future.result()
        raise
    finally:
        stop.set()
        pool.shutdown(wait=True, cancel_futures=True)


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
    runs = plan(study, found)
    finished: dict[int, Outcome] = {}
    for index, outcome in outcomes(runs, study.numerics, jobs or cores(), study.output):
        finished[index] = outcome
        if progress:
            progress(len(finished), len(runs))
    return table_of(study, found, runs, finished)


def table_of(study: Study, motions: MotionSet, runs: list[Run], finished: dict[int, Outcome]) -> "pd.DataFrame":
    """Table of the finished runs in the order of the study, then of the files that could not be used."""
    rows = [
        row(runs[i].motion.name, runs[i].polarity, runs[i].scale, runs[i].case, finished[i]) for i in sorted(finished)
    ]
    return as_table([*rows, *unusable_rows(motions)], study)
