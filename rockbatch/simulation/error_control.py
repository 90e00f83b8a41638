"""Step-halving error control: smaller steps until the results converge (THEORY.md, The error that a row reports)."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

from rockbatch.core.clock import ON_ITS_SIDE, window_of
from rockbatch.motions.motion import Motion, Samples
from rockbatch.outcome.changes import change_of_devices
from rockbatch.outcome.outcome import Failure, Outcome
from rockbatch.pier import Base, Damper, Pier
from rockbatch.simulation.agreement import COUNTS, Agreement, agreement, converged_extent, flight_of, windows
from rockbatch.simulation.chaos import MARGIN, lingers, look_for_chaos, magnifies, residuals_wander, without_error
from rockbatch.simulation.coarser import (
    share_of_strips,
    tolerances_beside,
    with_fewer_modes,
    with_fewer_strips,
    with_modes_error,
    with_strips_error,
)
from rockbatch.simulation.relaxation import add_later_yield, add_relaxation
from rockbatch.simulation.runs import MOST_STEPS, Run, Stop, Trial, quiet_samples, steps_of, try_all
from rockbatch.simulation.steps import first_substeps, readings

HALVINGS = 8
"""Greatest number of halvings of the step before a run counts as not converged."""

ROUNDING = 1e-12
"""Least error of θ/α that is claimed without a viscous damper of exponent < 1."""

ROUGH = 3e-8
"""Least error of θ/α that is claimed with a viscous damper of exponent < 1: its error at a velocity reversal does not fall
smoothly with the step, so that two runs may agree better than either is right."""

CHANCE = 4.0
"""Claimed error over the change by halving the step, for results that need not converge: peaks in a motion, device demands."""


ERRORS = (
    "theta_max_error",
    "theta_res_error",
    "settlement_error",
    "deflection_max_error",
    "top_drift_max_error",
    "devices_error",
)
"""Fields of an Outcome that hold errors of its results."""


def run_to_tolerance(pier: Pier, base: Base, motion: Motion, tolerance: float, quiet_s: float = 2.0) -> Outcome:
    """Return the converged outcome of one run, as :func:`run_all_to_tolerance` of several."""
    outcome = run_all_to_tolerance([Run(pier, base, motion)], tolerance, quiet_s, Stop())[0]
    assert outcome is not None
    return outcome


def run_all_to_tolerance(runs: Sequence[Run], tolerance: float, quiet_s: float, stop: Stop) -> list[Outcome | None]:
    """Return the converged outcome of each run: halve its step until results agree to ``tolerance`` on θ_max/α and on θ_res/α.

    The finer result is kept, and its difference from the coarser one is its estimated error, which is on the safe side. The
    trajectories, times of overturning and of flight have to agree too, since an early peak says nothing about later motion:
    if they do not, more halvings are needed (:data:`PAIRS`). The first step respects the springs' frequency, because two coarse
    runs that agree prove nothing otherwise. A run that has not converged after :data:`HALVINGS`, or would take more than
    :data:`rockbatch.simulation.runs.MOST_STEPS` steps, keeps its best values and fails with the reason; counts that have not
    converged are a note. Results that may be chaotic are repeated under a tiny change of the motion, and claim no error if it
    moves them beyond the tolerance. With fewer strips of a bed, or modes of a shaft, runs are repeated for their share in the
    errors. ``None`` for runs that were stopped.
    """
    outcomes: list[Outcome | None] = [None] * len(runs)
    first = [first_substeps(run.pier, run.base, run.motion.dt) for run in runs]
    levels = {i: [trial] for i, trial in enumerate(try_all(runs, first, quiet_s, stop)) if trial is not None}
    agreements: dict[int, list[Agreement]] = {i: [] for i in levels}
    beds: dict[int, tuple[Trial, Trial]] = {}
    last: dict[int, Trial] = {}
    while levels:
        for i in [i for i in levels if _steps_of_next(runs[i], levels[i], quiet_s) > MOST_STEPS]:
            more = f"; the next try would take {_steps_of_next(runs[i], levels[i], quiet_s):.0e} steps"
            outcomes[i] = _not_converged(runs[i].pier, levels.pop(i), tolerance, more)
        unfinished, doubtful = list(levels), dict[int, Trial]()
        substeps = [2 * levels[i][-1].outcome.substeps for i in unfinished]
        beds |= _on_beds(runs, levels, quiet_s, stop)
        for i, fine in zip(unfinished, try_all([runs[i] for i in unfinished], substeps, quiet_s, stop), strict=True):
            if fine is None:
                del levels[i]
                continue
            pier, coarse = runs[i].pier, levels[i][-1]
            share = share_of_strips(*beds[i], pier.half_width) if i in beds else None
            tolerances = tolerances_beside(tolerance * pier.alpha, share)
            fine = replace(fine, outcome=_with_errors(runs[i], fine.outcome, coarse.outcome))
            levels[i].append(fine)
            agreements[i].append(agreement(fine, coarse, tolerances, pier))
            if extent := converged_extent(agreements[i]):
                until = _window_at(runs[i], runs[i].motion.duration, quiet_s)
                peak = _window_at(runs[i], fine.outcome.t_max, quiet_s)
                outcome = _with_notes(fine, coarse, agreements[i][-1], tolerances.extremes, peak)
                outcome = _with_peak_in_motion(runs[i], fine, coarse, outcome, tolerances.peak, until)
                outcome = _with_drift(runs[i], outcome)
                magnified = magnifies(runs[i], fine, coarse, outcome, until)
                if magnified and extent == Agreement.RESULTS:
                    outcome = without_error(outcome, "other peaks near it follow the step")
                doubts = magnified or outcome.chaotic or residuals_wander(levels[i], tolerance * pier.alpha, pier)
                if doubts or lingers(runs[i], fine, quiet_s):
                    doubtful[i] = fine
                outcomes[i], last[i] = outcome, coarse
                del levels[i]
            elif len(agreements[i]) == HALVINGS:
                outcomes[i] = _not_converged(pier, levels.pop(i), tolerance, "")
        look_for_chaos(runs, outcomes, doubtful, tolerance, quiet_s, stop)
    add_relaxation(runs, outcomes, last, stop)
    for i, bed in beds.items():
        if (found := outcomes[i]) is not None:
            outcomes[i] = with_strips_error(found, *bed, runs[i].pier.half_width)
    add_later_yield(runs, outcomes, last, stop)
    return _with_modes_errors(runs, outcomes, quiet_s, stop)


def _on_beds(
    runs: Sequence[Run], levels: Mapping[int, Sequence[Trial]], quiet_s: float, stop: Stop
) -> dict[int, tuple[Trial, Trial]]:
    """Return the last of the ``levels`` of each run on a footing, and the trial on half as many strips at the same step."""
    fewer = {i: other for i in levels if (other := with_fewer_strips(runs[i]))}
    steps = [levels[i][-1].outcome.substeps for i in fewer]
    trials = try_all(list(fewer.values()), steps, quiet_s, stop) if fewer else []
    return {i: (levels[i][-1], trial) for i, trial in zip(fewer, trials, strict=True) if trial is not None}


def _with_modes_errors(
    runs: Sequence[Run], outcomes: Sequence[Outcome | None], quiet_s: float, stop: Stop
) -> list[Outcome | None]:
    """Return ``outcomes`` with the share of the modes of shafts in their errors, by runs with one fewer; None if stopped."""
    found = list(outcomes)
    fewer = list[tuple[int, Run, int]]()
    for i, (run, outcome) in enumerate(zip(runs, outcomes, strict=True)):
        if outcome is not None and outcome.status == "ok" and (other := with_fewer_modes(run)):
            fewer.append((i, other, outcome.substeps))
    trials = try_all([run for _, run, _ in fewer], [steps for *_, steps in fewer], quiet_s, stop) if fewer else []
    for (i, *_), trial in zip(fewer, trials, strict=True):
        outcome = found[i]
        found[i] = (
            with_modes_error(outcome, trial.outcome, CHANCE) if trial is not None and outcome is not None else None
        )
    return found


def _window_at(run: Run, t: float, quiet_s: float) -> int:
    """Return the index of the window of a run's extremes that contains ``t`` [s]."""
    samples = run.motion.npts - 1 + quiet_samples(quiet_s, run.motion.dt)
    return int(window_of(t / run.motion.dt, float(samples))[0])


def _steps_of_next(run: Run, levels: Sequence[Trial], quiet_s: float) -> float:
    """Return the steps of a run with half the step of the last of its ``levels``."""
    return steps_of(run.motion, 2 * levels[-1].outcome.substeps, quiet_s)


def _least_error(base: Base) -> float:
    """Return the least error of θ/α that is claimed: ROUGH with a viscous damper of exponent < 1 on ``base``, else ROUNDING."""
    rough = any(isinstance(d, Damper) and d.kind == "viscous" and d.exponent < 1.0 for d in base.restraints)
    return ROUGH if rough else ROUNDING


def _with_errors(run: Run, fine: Outcome, coarse: Outcome) -> Outcome:
    """Return ``fine`` with its differences from ``coarse`` as errors, at least rounding, of devices :data:`CHANCE` times these.

    Unchanged if it overturned or failed, or if the statuses differ.
    """
    if fine.status != coarse.status or fine.status in (
        "overturned",
        "failed",
    ):  # θ_max is the rotation at which the run ended
        return fine
    least = _least_error(run.base) * run.pier.alpha
    errors = {"theta_max_error": max(abs(fine.theta_max - coarse.theta_max), least)}
    if fine.theta_res is not None and coarse.theta_res is not None:
        errors["theta_res_error"] = max(abs(fine.theta_res - coarse.theta_res), least)
    if run.base.yields and fine.settlement is not None and coarse.settlement is not None:
        errors["settlement_error"] = max(abs(fine.settlement - coarse.settlement), least * run.pier.half_width)
    if fine.deflection_max is not None and coarse.deflection_max is not None:
        rounding = least * run.pier.size
        errors["deflection_max_error"] = max(abs(fine.deflection_max - coarse.deflection_max), rounding)
        errors["top_drift_max_error"] = max(abs((fine.top_drift_max or 0.0) - (coarse.top_drift_max or 0.0)), rounding)
    of_devices = change_of_devices(fine, coarse, run.pier)
    return fine.changed(devices_error=of_devices and CHANCE * of_devices, **errors)


def _with_peak_in_motion(
    run: Run, fine: Trial, coarse: Trial, outcome: Outcome, tolerance: float, until: int
) -> Outcome:
    """Return the ``outcome`` of ``fine`` with the error of the peak within the motion, which ends in the window ``until``.

    It is :data:`CHANCE` times the greatest change of any extreme until then from ``coarse``, of twice the step; unchanged if that
    exceeds the ``tolerance`` [rad], or if the pier lay on its side by then.
    """
    peaks = abs(fine.outcome.theta_max_in_motion - coarse.outcome.theta_max_in_motion)
    change = CHANCE * max(peaks, float(windows(fine, coarse)[1][:until].max(initial=0.0)))
    if outcome.theta_max_in_motion == ON_ITS_SIDE or not change <= tolerance:
        return outcome
    return outcome.changed(change_in_motion=max(change, _least_error(run.base) * run.pier.alpha))


def _with_drift(run: Run, outcome: Outcome) -> Outcome:
    """Return ``outcome`` with twice the drift of its residuals between the readings added to their errors.

    Undamped vibration comes and goes, so that the residuals depend by as much on when the record ends.
    """
    if outcome.theta_res_error is None or outcome.settlement_error is None or outcome.theta_res_drift is None:
        return outcome
    seconds = MARGIN * readings(run.pier, run.base, run.motion.dt)[1] * run.motion.dt
    return outcome.changed(
        theta_res_error=outcome.theta_res_error + abs(outcome.theta_res_drift) * seconds,
        settlement_error=outcome.settlement_error + abs(outcome.settlement_drift or 0.0) * seconds,
    )


def _with_notes(fine: Trial, coarse: Trial, extent: Agreement, tolerances: Samples, peak: int) -> Outcome:
    """Return the outcome of ``fine`` with notes on other results that did not converge, ``tolerances`` [rad] of each window.

    If rotations up to the window ``peak`` of the peak have not converged, no error is claimed: the peak then depends on digits
    that no record has, and runs that agree on it do so by chance. Unless the run failed, ``may_overturn`` is
    set to False, and ``chaotic`` to whether that is the case.
    """
    finer, coarser, notes = fine.outcome, coarse.outcome, list[str]()
    if finer.status != "failed":
        finer = finer.changed(chaotic=False, may_overturn=False)
    greatest, change = windows(fine, coarse)
    differs = change > tolerances
    if extent < Agreement.THROUGHOUT and differs.any():
        notes.append(f"lesser rotations, up to {greatest[differs].max():.2g} rad, have not settled")
        if differs[: peak + 1].any() and finer.status == "ok":
            finer = finer.changed(theta_max_error=None, devices_error=None, chaotic=True)
            notes.append("some of them before the peak, which is chaotic: no error of it is claimed")
    for name in COUNTS:
        fewer, more = sorted((getattr(coarser, name) or 0, getattr(finer, name) or 0))
        if fewer != more:
            notes.append(f"{name} not settled: {fewer} or {more}")
    if finer.status == "ok" and finer.t_flight != coarser.t_flight:
        times = [flight_of(coarser), flight_of(finer)]
        if not abs(times[1] - times[0]) <= 1e-3:
            moments = [f"at {t:.3f} s" if t == t else "none" for t in times]
            notes.append(f"first flight not settled: {moments[0]} or {moments[1]}")
    return finer.noted(*notes)


def _not_converged(pier: Pier, levels: Sequence[Trial], tolerance: float, more: str) -> Outcome:
    """Return the finest of a run's ``levels`` as a failed outcome, which keeps its values and claims no errors.

    One that failed by itself is returned as it is.
    """
    finest = levels[-1].outcome
    if finest.status == "failed":
        return finest
    change = "the outcome"
    if len(levels) > 1:
        coarser = levels[-2].outcome
        errors = (("theta_max", finest.theta_max_error), ("theta_res", finest.theta_res_error))
        large = [(name, error) for name, error in errors if error is not None and error > tolerance * pier.alpha]
        changes = [f"{name} by {error:.1e} rad" for name, error in large]
        if finest.status == coarser.status == "overturned":
            changes = [f"the time of overturning, from {coarser.t_end:.2f} to {finest.t_end:.2f} s"]
        elif finest.status == coarser.status == "flight" and not changes:
            changes = [f"the time of flight, from {flight_of(coarser):.3f} to {flight_of(finest):.3f} s"]
        elif finest.status == coarser.status and not changes:
            changes = ["rotations almost as large as the peak"]
        change = " and ".join(changes) or f"the outcome, from {coarser.status} to {finest.status}"
    reason = (
        f"not settled: halving the step still changed {change}; at {finest.substeps} substeps: {finest.status}{more}"
    )
    return finest.changed(status="failed", failure=Failure.NOT_SETTLED, reason=reason, note="", **dict.fromkeys(ERRORS))
