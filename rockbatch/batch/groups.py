"""Simulate runs in groups, side by side."""

from collections.abc import Iterable, Iterator, Sequence

from rockbatch.batch.plan import simulations
from rockbatch.outcome.outcome import Outcome
from rockbatch.results.columns import StudyRun
from rockbatch.simulation.error_control import run_all_to_tolerance
from rockbatch.simulation.leaning import with_lean
from rockbatch.simulation.observing import Observer, observed
from rockbatch.simulation.runs import Run, Stop, run_all_fixed, steps_of
from rockbatch.simulation.steps import first_substeps
from rockbatch.study import Numerics

LEAST_GROUP, MOST_GROUP = 32, 1024
"""Fewest and most runs of a group: enough to fill the lanes, few enough that lanes idle little at the end."""

STEPS_OF_A_GROUP = 2e7
"""Most steps of a group, about a second of work: the delay of progress and interrupts, and the loss in a crash."""

Group = dict[int, StudyRun]
"""Runs by index."""


def groups(runs: Sequence[StudyRun], numerics: Numerics, jobs: int, most: int = MOST_GROUP) -> Iterator[Group]:
    """Split runs, in order, into groups of a third of the share of each of ``jobs`` threads, but 32 to ``most`` runs.

    A group also ends when it reaches a second of work, :data:`STEPS_OF_A_GROUP` steps, and the last where the runs end.
    """
    share = len(runs) // (3 * jobs)
    most = min(max(share, LEAST_GROUP), most)
    group, work = Group(), 0.0
    for i, run in enumerate(runs):
        group[i] = run
        work += least_steps(run, numerics)
        if len(group) == most or work >= STEPS_OF_A_GROUP:
            yield group
            group, work = Group(), 0.0
    if group:
        yield group


def least_steps(run: StudyRun, numerics: Numerics) -> float:
    """Return the least number of steps of a run: at its fixed step, or in the first two trials, the second at half the step."""
    substeps = numerics.substeps or 3 * first_substeps(run.case.pier, run.case.base, run.record.dt)
    return steps_of(run.record, substeps, numerics.quiet_s)


def outcomes_of(
    runs: Iterable[StudyRun], numerics: Numerics, observers: Sequence[Observer] = (), stop: Stop | None = None
) -> list[Outcome | None]:
    """Simulate a group of runs, with the results of ``observers``, in order; all None if ``stop`` was set meanwhile."""
    stop = Stop() if stop is None else stop
    simulated = simulations(runs)
    outcomes = _run_all(simulated, numerics, stop)
    for observer in observers:
        outcomes = _with_comparisons(observer, simulated, outcomes, numerics, stop)
    done = [i for i, outcome in enumerate(outcomes) if outcome is not None]
    ended, results = [simulated[i] for i in done], [outcome for outcome in outcomes if outcome is not None]
    if not any(observer.separates_lean for observer in observers):
        results = with_lean(ended, results, numerics.quiet_s, stop=stop)
    results = observed(ended, results, observers, numerics.quiet_s, error=numerics.substeps is None, stop=stop)
    for i, outcome in zip(done, results, strict=True):
        outcomes[i] = None if stop.is_set else outcome
    return outcomes


def _run_all(runs: list[Run], numerics: Numerics, stop: Stop) -> list[Outcome | None]:
    """Simulate with the fixed step of ``numerics``, or to its tolerance; None for stopped runs."""
    if numerics.substeps is not None:
        return run_all_fixed(runs, [numerics.substeps] * len(runs), numerics.quiet_s, stop)
    assert numerics.tolerance is not None  # load_study gives one of the two
    return run_all_to_tolerance(runs, numerics.tolerance, numerics.quiet_s, stop)


def _with_comparisons(
    observer: Observer, runs: list[Run], outcomes: list[Outcome | None], numerics: Numerics, stop: Stop
) -> list[Outcome | None]:
    """Simulate the runs that an ``observer`` compares with ``runs``; return ``outcomes`` with the comparison added.

    Unchanged if it compares a run with none; None if the run or its comparison was stopped.
    """
    beside = dict[int, Run]()
    for i, (run, outcome) in enumerate(zip(runs, outcomes, strict=True)):
        if outcome is not None and (another := observer.beside(run, outcome)) is not None:
            beside[i] = another
    compared = list(outcomes)
    for i, other in zip(beside, _run_all(list(beside.values()), numerics, stop), strict=True):
        outcome = outcomes[i]
        compared[i] = None if outcome is None or other is None else observer.compare(outcome, other)
    return compared
