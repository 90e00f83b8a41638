"""What a batch would take: how many runs, how long, how much disk; found by running a few of them."""

import time
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import accumulate

from rockbatch.batch.carrying_out import row_of, to_simulate
from rockbatch.batch.groups import outcomes_of
from rockbatch.batch.kept_histories import history_bytes
from rockbatch.batch.listening import Listener, make_ready
from rockbatch.batch.plan import Chosen, Plan, PlannedRun
from rockbatch.batch.running import told
from rockbatch.results.columns import columns
from rockbatch.simulation import first_substeps, steps_of
from rockbatch.study import Study
from rockbatch.study.suite import ground_motions

TRIED = 256
"""Runs that are tried at most, spread over the whole study."""

STEPS_TRIED = 3e7
"""Steps of all of them, at most, as far as that can be foreseen: a second or two."""

BYTES_OF_A_CELL = 9.0
"""Of peaks.csv, on average."""


@dataclass(frozen=True)
class Expected:
    """What a batch would take.

    Attributes
    ----------
    what : str
        The runs, and how they come about: "2 records × 5 cases = 10 runs".
    runs : int
        Simulations; of mirror images one counts.
    tried : int
        Those that were tried.
    seconds : float
        Time of all runs on ``jobs`` threads; the report and the histories come on top.
    table, histories : float
        Size of peaks.csv, and of the histories that are kept [bytes].
    """

    what: str
    runs: int
    tried: int
    seconds: float
    jobs: int
    table: float
    histories: float


def expected(study: Study, jobs: int, listener: Listener) -> Expected:
    """Run a few runs, spread over the study, and extrapolate by the number of samples."""
    motions = ground_motions(study)
    listener.motions(motions)
    plan = Plan(study, motions)
    simulated = Chosen(plan, to_simulate(plan, range(len(plan))))
    steps = [_steps(study, run) for run in simulated]
    tried = _spread(steps)
    make_ready(study, listener)
    some = [simulated[i] for i in tried]
    started = time.perf_counter()
    found = outcomes_of(some, study.numerics, study.output)
    took = time.perf_counter() - started
    seconds = took * sum(steps) / max(sum(steps[i] for i in tried), 1.0) / jobs
    rows = [row_of(run, outcome) for run, outcome in zip(some, found, strict=True) if outcome is not None]
    size = sum(history_bytes(run, row) for run, row in zip(some, rows, strict=True)) / max(len(rows), 1)
    histories = {"none": 0.0, "all": len(plan) * size}.get(
        study.output.histories, min(len(study.cases) * size, 1e6 * study.output.histories_MB)
    )
    table = len(plan) * len(columns(study)) * BYTES_OF_A_CELL
    return Expected(told(study, motions), len(simulated), len(tried), seconds, jobs, table, histories)


def _steps(study: Study, run: PlannedRun) -> float:
    """Steps of a run that settles at once."""
    substeps = study.numerics.substeps or 3 * first_substeps(run.case.pier, run.case.base, run.motion.dt)
    return steps_of(run.motion, substeps, study.numerics.quiet_s)


def _spread(steps: Sequence[float]) -> list[int]:
    """Indices of runs spread evenly over all, at least one, with not more steps than :data:`STEPS_TRIED` together."""
    number = min(TRIED, len(steps))
    chosen = [round((i + 0.5) * len(steps) / number - 0.5) for i in range(number)]
    chosen = sorted(chosen, key=lambda i: (i * 7919) % len(steps))  # so that what is cut off is spread, too
    sums = accumulate(steps[i] for i in chosen)
    return [i for place, (i, total) in enumerate(zip(chosen, sums, strict=True)) if total <= STEPS_TRIED or place == 0]
