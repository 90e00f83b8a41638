"""Groups of runs that are simulated side by side, and their outcomes."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace

from rockbatch.batch.plan import simulations
from rockbatch.common.errors import InputError
from rockbatch.results.columns import StudyRun
from rockbatch.simulation.error_control import run_all_to_tolerance
from rockbatch.simulation.histories import rocking_from_lean, with_observed
from rockbatch.simulation.models import first_substeps
from rockbatch.simulation.outcome import Outcome
from rockbatch.simulation.runs import Run, Stop, run_all_fixed, steps_of
from rockbatch.study import Numerics, Output

MOST_STEPS_OF_A_LEDGER = 1_000_000
"""Longer runs have no energy balance in the table: each is recorded whole, 100 bytes a step, and its energies beside it."""

MOST_STEPS_OF_FORCES = 5_000_000
"""Longer runs have no forces, and no work of devices, in the table: each is recorded whole, half a gigabyte."""

LEAST_GROUP, MOST_GROUP = 32, 1024
"""Runs in a group: enough to fill the lanes; few enough that little is lost when the last ones leave them empty."""

STEPS_OF_A_GROUP = 2e7
"""About a second of work: the longest wait of an interrupt or the progress, and the most that a crash can lose."""

NOTHING_MORE = Output(both_laws=False)


Group = dict[int, StudyRun]
"""Runs by their indices."""


def groups(runs: Sequence[StudyRun], numerics: Numerics, jobs: int, most: int = MOST_GROUP) -> Iterator[Group]:
    """Yield consecutive runs to simulate side by side, in order: a share for every thread, a second's work at most.

    ``most`` is the greatest number of runs in a group.
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
    """Return the steps of a run that converges at once."""
    substeps = numerics.substeps or 3 * first_substeps(run.case.pier, run.case.base, run.record.dt)
    return steps_of(run.record, substeps, numerics.quiet_s)


def outcomes_of(
    runs: Iterable[StudyRun], numerics: Numerics, output: Output = NOTHING_MORE, stop: Stop | None = None
) -> list[Outcome | None]:
    """Simulate a group of runs with the results of ``output``; ``None`` for those that ``stop`` has stopped."""
    stop = Stop() if stop is None else stop
    simulated = simulations(runs)
    outcomes = _run_all(simulated, numerics, stop)
    if output.both_laws:
        outcomes = _with_other_law(simulated, outcomes, numerics, stop)
    done = [i for i, outcome in enumerate(outcomes) if outcome is not None]
    observed = rocking_from_lean(
        [simulated[i] for i in done],
        [o for o in outcomes if o is not None],
        numerics.quiet_s,
        output.rocking,
        stop=stop,
    )
    for i, outcome in zip(done, observed, strict=True):
        outcomes[i] = _observed(simulated[i], outcome, numerics, output, stop)
    return outcomes


def _run_all(runs: list[Run], numerics: Numerics, stop: Stop) -> list[Outcome | None]:
    """Simulate with the study's fixed step, or to its tolerance."""
    if numerics.substeps is not None:
        return run_all_fixed(runs, [numerics.substeps] * len(runs), numerics.quiet_s, stop)
    assert numerics.tolerance is not None  # load_study gives one of the two
    return run_all_to_tolerance(runs, numerics.tolerance, numerics.quiet_s, stop)


def _with_other_law(
    runs: list[Run], outcomes: list[Outcome | None], numerics: Numerics, stop: Stop
) -> list[Outcome | None]:
    """Return ``outcomes`` with the settlement of ratcheting springs by the other law too; with a note unless that converged."""
    creeping = {
        i: replace(run, base=run.base.by_other_law())
        for i, (run, outcome) in enumerate(zip(runs, outcomes, strict=True))
        if run.base.ratchets and outcome is not None and outcome.was_run
    }
    others = _run_all(list(creeping.values()), numerics, stop)
    for i, by_other in zip(creeping, others, strict=True):
        outcome = outcomes[i]
        assert outcome is not None
        failed = f"by the other spring law: {by_other.reason}" if by_other and by_other.status == "failed" else ""
        outcomes[i] = by_other and outcome.noted(failed, settlement_other_law=by_other.settlement)
    return outcomes


def _observed(run: Run, outcome: Outcome, numerics: Numerics, output: Output, stop: Stop) -> Outcome | None:
    """Return ``outcome`` with what observers make of the recorded run: energy balance, forces; unless it is very long."""
    if stop.is_set:
        return None
    if not outcome.was_run or not (output.ledger or output.forces or output.devices_work):
        return outcome
    steps = steps_of(run.motion, outcome.substeps, numerics.quiet_s)
    ledger = output.ledger and steps <= MOST_STEPS_OF_A_LEDGER
    sized = output.forces and steps <= MOST_STEPS_OF_FORCES
    try:
        least = output.least_normal_share if sized else None
        fixed = numerics.substeps is not None
        stroke = output.least_stroke if steps <= MOST_STEPS_OF_FORCES else None
        return with_observed(
            run, outcome, numerics.quiet_s, ledger=ledger, least_normal=least, error=not fixed, least_stroke=stroke
        )
    except InputError:  # too many impacts to be written down
        return outcome
