"""Estimate the cost of a batch, time and disk space, from a few of its runs."""

import time
from collections.abc import Collection, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from itertools import accumulate

from rockbatch.batch.compiling import make_ready
from rockbatch.batch.execution import to_simulate
from rockbatch.batch.groups import least_steps, outcomes_of
from rockbatch.batch.listening import Listener
from rockbatch.batch.observers import observers_beside, observers_of
from rockbatch.batch.plan import Plan, some_of
from rockbatch.batch.preparing import check_records, run_count, share_of
from rockbatch.common.errors import starting_threads
from rockbatch.outcome.outcome import Outcome
from rockbatch.results.columns import StudyRun, columns, row
from rockbatch.results.histories_file import history_bytes
from rockbatch.simulation.observing import Observer
from rockbatch.simulation.runs import Stop
from rockbatch.study import Study
from rockbatch.study.suite import ground_motions

TRIED = 256
"""Most runs to try, spread over the whole study."""

STEPS_TRIED = 3e7
"""Most steps of all tried runs together, as far as foreseeable: a second or two."""

SECONDS_TRIED = 0.5
"""Time after which no further runs are begun [s]."""

BYTES_OF_A_CELL = 9.0
"""Average size of a cell of peaks.csv [bytes]."""


@dataclass(frozen=True)
class Expected:
    """Estimate of the cost of a batch."""

    what: str  # the number of runs in words: "2 records × 5 cases = 10 runs"
    runs: int  # number of simulations; mirror images count once
    tried: int  # number of simulations tried
    seconds: float  # time of all runs on ``jobs`` threads, without report and histories
    jobs: int
    # sizes of peaks.csv and of the kept histories [bytes]
    table: float
    histories: float


def expected(
    study: Study,
    jobs: int,
    listener: Listener,
    share: tuple[int, int] | None = None,
    records: Collection[str] = (),
) -> Expected:
    """Return the cost of a batch, estimated by timing a few runs, spread over the study, on ``jobs`` threads.

    Time goes with the least number of steps. ``share`` and ``records`` as in :func:`rockbatch.workflow.running.run_into`; a
    share keeps no histories.
    """
    motions = ground_motions(study)
    listener.motions(motions)
    check_records(records, motions)
    plan = Plan(study, motions)
    requested = share_of(plan, *share) if share else range(len(plan))
    simulated = some_of(plan, to_simulate(plan, requested))
    steps = [least_steps(run, study.numerics) for run in simulated]
    observers = (*observers_of(study.output), *observers_beside(study.output, motions.motions))
    make_ready(study, listener, observers)
    started = time.perf_counter()
    tried = _tried(study, simulated, _spread(steps), observers, jobs, listener)
    took = time.perf_counter() - started
    seconds = took * sum(steps) / sum(steps[i] for i in tried)
    ended = [simulated[i]._replace(outcome=outcome) for i, outcome in tried.items()]
    size = sum(history_bytes(run, row(run)) for run in ended) / len(tried)
    histories = {"none": 0.0, "all": len(plan) * size}.get(
        "none" if share else study.output.histories, min(len(study.cases) * size, 1e6 * study.output.histories_MB)
    )
    table = len(requested) * len(columns(study)) * BYTES_OF_A_CELL
    of_share = f"; share {share[0]} of {share[1]} is {len(simulated)} of them" if share else ""
    what = run_count(study, motions) + of_share
    return Expected(what, len(simulated), len(tried), seconds, jobs, table, histories)


def _tried(
    study: Study,
    runs: Sequence[StudyRun],
    chosen: Sequence[int],
    observers: Sequence[Observer],
    jobs: int,
    listener: Listener,
) -> dict[int, Outcome]:
    """Return outcomes of ``chosen`` runs by index: a run for each thread, then ever twice as many, until time is up."""
    outcomes: dict[int, Outcome | None] = {}
    stop, begun = Stop(), 0

    def carried_out(share: Sequence[int]) -> list[Outcome | None]:
        """Simulate the runs of one thread; None for those stopped."""
        return outcomes_of([runs[i] for i in share], study.numerics, observers, stop)

    with listener.progress(len(chosen)) as progress, ThreadPoolExecutor(jobs) as pool:
        started = time.perf_counter()
        try:
            while begun < len(chosen) and (begun == 0 or time.perf_counter() - started < SECONDS_TRIED):
                wave = chosen[begun : 2 * begun + jobs]
                shares = [wave[i::jobs] for i in range(min(jobs, len(wave)))]
                with starting_threads(", or write --jobs 1" * (jobs > 1)):
                    groups = pool.map(carried_out, shares)
                for share, results in zip(shares, groups, strict=True):
                    outcomes |= zip(share, results, strict=True)
                begun += len(wave)
                progress(len(wave))
        finally:
            stop.set()
    return {i: outcome for i, outcome in outcomes.items() if outcome is not None}


def _spread(steps: Sequence[float]) -> list[int]:
    """Return up to TRIED indices, even over all runs, in shuffled order, whose ``steps`` sum to at most :data:`STEPS_TRIED`.

    At least one, whatever its steps.
    """
    number = min(TRIED, len(steps))
    chosen = [round((i + 0.5) * len(steps) / number - 0.5) for i in range(number)]
    chosen = sorted(
        chosen, key=lambda i: (i * 7919) % len(steps)
    )  # shuffled, so that the runs of a list cut off are still spread
    sums = accumulate(steps[i] for i in chosen)
    return [i for place, (i, total) in enumerate(zip(chosen, sums, strict=True)) if total <= STEPS_TRIED or place == 0]
