"""Error of θ_max/α against time per run, on this machine: what a step and the location of events cost."""

import hashlib
import math
import platform
import statistics
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from rockbatch.analyses.accuracy.levels import COLUMNS
from rockbatch.batch.groups import outcomes_of
from rockbatch.batch.listening import Listener, count
from rockbatch.batch.plan import Plan, simulations
from rockbatch.batch.threads import cores
from rockbatch.common.errors import InputError
from rockbatch.common.grouping import spread
from rockbatch.common.lazy import pd
from rockbatch.motions import MotionSet
from rockbatch.outcome.outcome import Outcome
from rockbatch.results.columns import StudyRun
from rockbatch.simulation.runs import Stop, run_all_fixed, run_fixed
from rockbatch.simulation.steps import first_substeps
from rockbatch.study import Study

SUBSTEPS = (1, 2, 4, 8, 16, 32)
REPEATS = 5

CONVERGED = 1e-12
"""Change of θ_max/α at which a reference is not refined further: a few hundred times the rounding of θ_max/α = 1."""

ACCEPTED = 1e-9
"""Largest change of a reference that is accepted, if rounding or sensitivity keeps it from converging."""

HALVINGS = 10

REFERENCES = 0.5
"""Share of the time by which the references are to be finished; the rest is for the settings."""

Setting = dict[str, object]
Simulate = Callable[[Sequence[StudyRun]], list[tuple[str, float]]]
"""From runs to their status and θ_max [rad]."""


class Clock:
    """Time budget of a measurement: ``seconds`` from now on."""

    def __init__(self, seconds: float = math.inf) -> None:
        self.seconds, self.started = seconds, time.monotonic()

    def remaining(self, share: float = 1.0) -> float:
        """Return the seconds until ``share`` of the time is over; negative afterwards."""
        return self.started + share * self.seconds - time.monotonic()


@dataclass(frozen=True)
class Reference:
    """A run, its converged outcome, and the uncertainty of its θ_max/α: the last change by halving, 1e-12 at least."""

    run: StudyRun
    outcome: Outcome
    change: float


def reference(run: StudyRun, quiet_s: float, seconds: float = math.inf) -> Reference | None:
    """Return a run with its converged outcome: the step is halved until θ_max/α changes by CONVERGED, 1e-12, or less.

    Halving stops after HALVINGS, 10, times, or if the next would take more of the ``seconds`` than remain. Returns None if the
    last change is above ACCEPTED, 1e-9, if the status changed or is "failed", or without any halving. For a run that overturns
    only the status is compared.
    """
    (simulation,) = simulations([run])
    pier, base, motion = simulation.pier, simulation.base, simulation.motion
    clock, took = Clock(seconds), 0.0
    substeps = 2 * first_substeps(pier, base, motion.dt)
    outcome, change = run_fixed(pier, base, motion, substeps, quiet_s), math.inf
    for _ in range(HALVINGS):
        if 2 * took > clock.remaining():  # half the step takes twice the time
            break
        started = time.monotonic()
        substeps *= 2
        fine = run_fixed(pier, base, motion, substeps, quiet_s)
        took = time.monotonic() - started
        # The greatest rotation of a pier that overturns is where its run ended: only the outcome counts
        moved = 0.0 if fine.status == "overturned" else abs(fine.theta_max - outcome.theta_max) / pier.alpha
        change = moved if fine.status == outcome.status and fine.status != "failed" else math.inf
        outcome = fine
        if change <= CONVERGED:
            break
    return Reference(run, outcome, max(change, CONVERGED)) if change <= ACCEPTED else None


def references(
    study: Study, motions: MotionSet, most: int, listener: Listener, clock: Clock | None = None
) -> list[Reference]:
    """Return converged references of at most ``most`` runs of the study, as many as the clock allows.

    Until one has converged they may take all the time, then half of it. Raises ``InputError`` if none converges.
    """
    clock = clock or Clock()
    runs = Plan(study, motions)
    chosen = spread(runs, most)
    listener.say(f"{len(chosen)} of {count(len(runs), 'run')}: their references, with ever smaller steps")
    converged: dict[int, Reference] = {}
    tried = 0
    with listener.progress(len(chosen)) as advance:
        for i in sorted(range(len(chosen)), key=_scattered):
            remaining = clock.remaining(REFERENCES if converged else 1.0)
            if remaining <= 0:
                break
            refined = reference(chosen[i], study.numerics.quiet_s, remaining)
            converged |= {} if refined is None else {i: refined}
            tried += 1
            advance(1)
    if not converged:
        raise InputError(
            f"{study.path}: no run settles with ever smaller steps, so there is nothing to measure errors against; "
            "give it more time, or look at the runs that failed"
        )
    if len(converged) < tried:
        listener.say(
            f"left out: {count(tried - len(converged), 'run')} that did not settle with ever smaller steps in time"
        )
    if tried < len(chosen):
        listener.say(f"left out, for want of time: {count(len(chosen) - tried, 'run')} (--seconds gives more)")
    return [converged[i] for i in sorted(converged)]


def _scattered(i: int) -> float:
    """Return the fractional part of i × 0.618…, the golden section: by it, the first few of a range are spread over all of it."""
    return i * 0.6180339887498949 % 1.0


def measure(
    study: Study,
    references: Sequence[Reference],
    listener: Listener | None = None,
    clock: Clock | None = None,
) -> "pd.DataFrame":
    """Return time and error of fixed steps, with and without the location of events, and of the study's own setting, a row each.

    Everything runs in one thread, and its processor time counts, whatever else the machine does: medians of
    :data:`REPEATS` passes over all runs, of fewer where ``clock`` says so.
    """
    listener, clock = listener or Listener(), clock or Clock()
    table = pd.DataFrame(_of_steps(study, references, listener, clock), columns=list(COLUMNS))
    table["substeps"] = table["substeps"].astype("Int64")
    table["tolerance"] = table["tolerance"].astype("float64")
    table["machine"] = f"{platform.system()} {platform.machine()}, {cores()} processors"
    table["study"] = hashlib.sha256(study.text.encode()).hexdigest()
    return table


def _of_steps(
    study: Study, references: Sequence[Reference], listener: Listener, clock: Clock
) -> list[dict[str, object]]:
    """Return rows of the study's own setting, measured first, below those with fixed steps for which there is time."""
    numerics = study.numerics

    def fixed(substeps: int, locate: bool) -> Simulate:
        def simulate(runs: Sequence[StudyRun]) -> list[tuple[str, float]]:
            return _ends(run_all_fixed(simulations(runs), [substeps] * len(runs), numerics.quiet_s, Stop(), locate))

        return simulate

    of_study: Setting = {"method": "study", "substeps": numerics.substeps, "tolerance": numerics.tolerance}
    settings: list[tuple[Setting, Simulate]] = [(of_study, lambda runs: _ends(outcomes_of(runs, numerics)))]
    for substeps in SUBSTEPS:
        for method, locate in (("located", True), ("not located", False)):
            settings.append(({"method": method, "substeps": substeps, "tolerance": None}, fixed(substeps, locate)))
    listener.say(f"errors and times of {len(settings)} settings on {count(len(references), 'run')}")
    rows: list[dict[str, object]] = []
    took = 0.0
    with listener.progress(len(settings) * len(references)) as advance:
        for place, (setting, simulate) in enumerate(settings):
            if rows and 2 * took > clock.remaining():  # twice the steps take twice the time
                listener.say(f"left out, for want of time: from {setting['substeps']} steps per sample on")
                break
            started, share = time.monotonic(), (place + 1) / len(settings)
            deadline = clock.remaining(REFERENCES + share * (1.0 - REFERENCES))
            rows.append(setting | _measured(references, simulate, deadline))
            took = time.monotonic() - started
            advance(len(references))
    order = ("located", "not located", "study")
    return sorted(rows, key=lambda row: order.index(row["method"]))


def _ends(outcomes: Sequence[Outcome | None]) -> list[tuple[str, float]]:
    return [(outcome.status, outcome.theta_max) for outcome in outcomes if outcome is not None]  # none was stopped


def _measured(references: Sequence[Reference], simulate: Simulate, seconds: float) -> dict[str, object]:
    """Return errors of θ_max/α and the time per run of ``simulate``, called REPEATS, 5, times, or as often as ``seconds`` allow.

    Errors are of runs that end as their references do and do not overturn, None without any, and no smaller than the
    uncertainty of the reference. The time is per run that was not stopped as unstable, None without any.
    """
    runs = [ref.run for ref in references]
    times: list[float] = []
    clock = Clock(seconds)
    while not times or (len(times) < REPEATS and clock.remaining() > 0):
        start = time.thread_time()
        ends = simulate(runs)
        times.append(time.thread_time() - start)
    finished = sum(math.isfinite(theta_max) for _, theta_max in ends)  # a step that would blow up is not run
    same_status = [status == ref.outcome.status for ref, (status, _) in zip(references, ends, strict=True)]
    errors = []
    for ref, alike, (status, theta_max) in zip(references, same_status, ends, strict=True):
        if alike and status != "overturned":
            errors.append(max(abs(theta_max - ref.outcome.theta_max) / ref.run.case.pier.alpha, ref.change))
    return {
        "runs": len(references),
        "compared": len(errors),
        "error_median": float(np.median(errors)) if errors else None,
        "error_95": float(np.quantile(errors, 0.95)) if errors else None,
        "error_max": max(errors, default=None),
        "seconds_per_run": statistics.median(times) / finished if finished else None,
        "status_differs": same_status.count(False),
        "reference_change": max(ref.change for ref in references),
    }
