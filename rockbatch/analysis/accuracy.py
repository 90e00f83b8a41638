"""Error of θ_max/α against time per run, on this machine: what a step, the location of events and SciPy cost."""

import hashlib
import math
import platform
import statistics
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from rockbatch.batch.groups import outcomes_of
from rockbatch.batch.plan import PlannedRun
from rockbatch.batch.threads import cores
from rockbatch.pier import RigidBase
from rockbatch.results.outcome import Outcome
from rockbatch.simulation import Stop, first_substeps, run_all_fixed, run_fixed
from rockbatch.study import Study

if TYPE_CHECKING:
    import pandas as pd

COLUMNS = (
    "method",  # located, not located, study, SciPy DOP853, SciPy LSODA
    "substeps",  # steps per sample, where they are given
    "tolerance",  # where it is given: on θ_max/α, or SciPy's rtol
    "runs",
    "error_median",  # of θ_max/α, over the runs that end as the reference does and do not overturn
    "error_95",
    "error_max",
    "seconds_per_run",
    "status_differs",  # runs that end otherwise than the reference
    "reference_change",  # what the last halving still changed in the least settled reference
    "machine",
    "study",  # SHA-256 of the study file
)

SUBSTEPS = (1, 2, 4, 8, 16, 32)
SCIPY = ("DOP853", "LSODA")
SCIPY_TOLERANCES = (1e-4, 1e-6, 1e-8, 1e-10)
SCIPY_RUNS = 2
REPEATS = 5

SETTLED = 1e-12
"""Change of θ_max/α at which a reference is not refined further: a few hundred times the rounding of θ_max/α = 1."""

ACCEPTED = 1e-9
"""Largest change with which it still serves as one, where rounding or sensitivity keeps it from settling."""

HALVINGS = 10


Simulate = Callable[[Sequence[PlannedRun]], list[tuple[str, float]]]
"""From runs to their status and θ_max [rad]."""


@dataclass(frozen=True)
class Reference:
    """A run, its outcome with a step so fine that it does not matter, and what the last halving changed [θ_max/α]."""

    run: PlannedRun
    outcome: Outcome
    change: float


def spread(runs: Sequence[PlannedRun], most: int) -> list[PlannedRun]:
    """At most ``most`` of ``runs``, evenly over the study, the first and the last among them."""
    if len(runs) <= most:
        return list(runs)
    return [runs[i] for i in np.linspace(0, len(runs) - 1, most).round().astype(int)]


def reference(run: PlannedRun, quiet_s: float) -> Reference | None:
    """Halve the step until it does not matter any more; None for a run that does not get there."""
    pier, base = run.case.pier, run.case.base
    substeps = 2 * first_substeps(pier, base, run.motion.dt)
    outcome, change = run_fixed(pier, base, run.motion, substeps, quiet_s), math.inf
    for _ in range(HALVINGS):
        substeps *= 2
        fine = run_fixed(pier, base, run.motion, substeps, quiet_s)
        # The greatest rotation of a pier that overturns is where its run ended: only the outcome counts
        moved = 0.0 if fine.status == "overturned" else abs(fine.theta_max - outcome.theta_max) / pier.alpha
        change = moved if fine.status == outcome.status and fine.status != "failed" else math.inf
        outcome = fine
        if change <= SETTLED:
            break
    return Reference(run, outcome, change) if change <= ACCEPTED else None


def measure(study: Study, references: Sequence[Reference], scipy: bool = True) -> "pd.DataFrame":
    """Time and error of fixed steps, with and without the location of events, of the study's own setting, and of SciPy.

    Everything runs in one thread, and its processor time counts, whatever else the machine does: medians of
    :data:`REPEATS` passes over all runs. SciPy: one pass over at most :data:`SCIPY_RUNS` runs, on springs, until ours
    end.

    Returns
    -------
    DataFrame with the columns :data:`COLUMNS`, one row per method and setting.
    """
    import pandas as pd

    numerics = study.numerics

    def fixed(substeps: int, locate: bool) -> Simulate:
        def simulate(runs: Sequence[PlannedRun]) -> list[tuple[str, float]]:
            simulated = [planned.run for planned in runs]
            return _ends(run_all_fixed(simulated, [substeps] * len(simulated), numerics.quiet_s, Stop(), locate))

        return simulate

    rows = []
    for method, locate in (("located", True), ("not located", False)):
        for substeps in SUBSTEPS:
            setting = {"method": method, "substeps": substeps, "tolerance": None}
            rows.append(setting | _measured(references, fixed(substeps, locate), REPEATS))
    setting = {"method": "study", "substeps": numerics.substeps, "tolerance": numerics.tolerance}
    rows.append(setting | _measured(references, lambda runs: _ends(outcomes_of(runs, numerics)), REPEATS))
    if scipy:
        rows += _yardstick(references)
    table = pd.DataFrame(rows, columns=list(COLUMNS))
    table["substeps"] = table["substeps"].astype("Int64")
    table["tolerance"] = table["tolerance"].astype("float64")
    table["machine"] = f"{platform.system()} {platform.machine()}, {cores()} processors"
    table["study"] = hashlib.sha256(study.text.encode()).hexdigest()
    return table


def _ends(outcomes: Sequence[Outcome | None]) -> list[tuple[str, float]]:
    return [(outcome.status, outcome.theta_max) for outcome in outcomes if outcome is not None]  # none was stopped


def _yardstick(references: Sequence[Reference]) -> list[dict[str, Any]]:
    from rockbatch.simulation.yardstick import solve

    chosen = [one for one in references if not isinstance(one.run.case.base, RigidBase) and one.outcome.status == "ok"]
    if len(chosen) > SCIPY_RUNS:  # from the middle of the study's halves
        chosen = [chosen[(2 * i + 1) * len(chosen) // (2 * SCIPY_RUNS)] for i in range(SCIPY_RUNS)]
    if not chosen:
        return []

    after = {id(one.run): one.outcome.t_end - one.run.motion.duration for one in chosen}

    def solver(method: str, tolerance: float) -> Simulate:
        return lambda runs: [
            solve(run.case.pier, run.case.base, run.motion, method, tolerance, after[id(run)])  # type: ignore[arg-type]
            for run in runs
        ]

    solver("LSODA", 1e-3)([chosen[0].run])  # compiles what is called from Python
    return [
        {"method": f"SciPy {method}", "substeps": None, "tolerance": tolerance}
        | _measured(chosen, solver(method, tolerance), 1)
        for method in SCIPY
        for tolerance in SCIPY_TOLERANCES
    ]


def _measured(references: Sequence[Reference], simulate: Simulate, repeats: int) -> dict[str, Any]:
    """Errors and times of ``simulate`` over the referenced runs."""
    runs = [one.run for one in references]
    times = []
    for _ in range(repeats):
        start = time.thread_time()
        found = simulate(runs)
        times.append(time.thread_time() - start)
    done = sum(math.isfinite(theta_max) for _, theta_max in found)  # a step that would blow up is not run
    same = [status == one.outcome.status for one, (status, _) in zip(references, found, strict=True)]
    errors = [
        abs(theta_max - one.outcome.theta_max) / one.run.case.pier.alpha
        for one, alike, (status, theta_max) in zip(references, same, found, strict=True)
        if alike and status != "overturned"
    ]
    return {
        "runs": len(references),
        "error_median": float(np.median(errors)) if errors else None,
        "error_95": float(np.quantile(errors, 0.95)) if errors else None,
        "error_max": max(errors, default=None),
        "seconds_per_run": statistics.median(times) / done if done else None,
        "status_differs": same.count(False),
        "reference_change": max(one.change for one in references),
    }
