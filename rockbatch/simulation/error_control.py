"""Step-halving error control: smaller steps until the results converge (THEORY.md, The error that a row reports)."""

import math
from collections.abc import Sequence
from dataclasses import replace
from enum import IntEnum

import numpy as np

from rockbatch.core.clock import ON_ITS_SIDE, window_of
from rockbatch.motions.motion import Motion
from rockbatch.pier import Base, Damper, Pier
from rockbatch.simulation.changes import change_of_devices
from rockbatch.simulation.models import first_substeps, readings
from rockbatch.simulation.outcome import Outcome
from rockbatch.simulation.runs import LEFT_ALONE, MOST_STEPS, Run, Stop, Trial, quiet_samples, steps_of, try_all

HALVINGS = 8
"""Greatest number of halvings of the step before a run counts as not converged."""

ROUNDING = 1e-12
"""Least error of θ/α that is ever claimed."""

ROUGH = 3e-8
"""Least error of θ/α that is claimed with a viscous damper whose force is a root of the speed: its error at a velocity reversal
does not fall evenly with the step, so that two runs may agree better than either is right."""

SAME_TIME = 0.01
"""In units of 1/p: tolerance on the time of overturning, of flight and of the peak."""

SAME_FALL = 0.02
"""In units of α: tolerance on the rotations before a pier overturned."""

CHANGE = 1e-8
"""Relative change of a motion, less than a record resolves. If it changes the peak beyond the tolerance, no error is claimed."""

COUNTS = ("impacts", "separations", "flights", "tendon_slack", "stop_blows", "deck_spring_blows")

FAR_BELOW = 3.0
"""An extreme that has not converged is harmless if it is below the peak by so many times its change."""


class Agreement(IntEnum):
    """Extent to which two trials of a run agree."""

    NONE = 0
    RESULTS = 1  # in outcome, peak and residual rotation; its time, or other extremes near the peak, have not converged
    APART = 2  # likewise, and the extremes that have not converged are far below the peak
    THROUGHOUT = 3  # in the extremes of all windows too


PAIRS = {Agreement.THROUGHOUT: 1, Agreement.APART: 2, Agreement.RESULTS: 4}
"""Halvings in a row that have to agree to this extent at least: the less two runs have in common, the more it takes."""


def run_to_tolerance(pier: Pier, base: Base, motion: Motion, tolerance: float, quiet_s: float = 2.0) -> Outcome:
    """Run with step halving; see :func:`run_all_to_tolerance`."""
    outcome = run_all_to_tolerance([Run(pier, base, motion)], tolerance, quiet_s, Stop())[0]
    assert outcome is not None
    return outcome


def run_all_to_tolerance(runs: Sequence[Run], tolerance: float, quiet_s: float, stop: Stop) -> list[Outcome | None]:
    """Return the converged outcome of each run: halve its step until results agree to ``tolerance`` on θ_max/α and on θ_res/α.

    The finer result is kept, and the difference is its estimated error: the coarser one's, hence on the safe side. The
    trajectories, times of overturning and of flight have to agree too, since an early peak says nothing of what comes after it:
    if they do not, it takes more halvings (:data:`PAIRS`). The first step respects the springs' frequency, because two coarse
    runs that agree prove nothing otherwise. A run that has not converged after :data:`HALVINGS`, or would take more than
    :data:`rockbatch.simulation.runs.MOST_STEPS` steps, keeps its best values and fails with the reason; counts that have not
    converged are a note. ``None`` for those that were stopped.
    """
    outcomes: list[Outcome | None] = [None] * len(runs)
    first = [first_substeps(run.pier, run.base, run.motion.dt) for run in runs]
    levels = {i: [trial] for i, trial in enumerate(try_all(runs, first, quiet_s, stop)) if trial is not None}
    agreements: dict[int, list[Agreement]] = {i: [] for i in levels}
    while levels:
        for i in [i for i in levels if _steps_of_next(runs[i], levels[i], quiet_s) > MOST_STEPS]:
            more = f"; the next try would take {_steps_of_next(runs[i], levels[i], quiet_s):.0e} steps"
            outcomes[i] = _not_converged(runs[i], levels.pop(i), tolerance, quiet_s, more)
        unfinished, doubtful = list(levels), []
        substeps = [2 * levels[i][-1].outcome.substeps for i in unfinished]
        for i, fine in zip(unfinished, try_all([runs[i] for i in unfinished], substeps, quiet_s, stop), strict=True):
            if fine is None:
                del levels[i]
                continue
            pier, coarse = runs[i].pier, levels[i][-1]
            least = _least_error(runs[i].base) * pier.alpha
            fine = Trial(_with_errors(fine.outcome, coarse.outcome, least, pier), fine.extremes)
            levels[i].append(fine)
            agreements[i].append(agreement(fine, coarse, tolerance * pier.alpha, pier))
            if enough(agreements[i]):
                samples = runs[i].motion.npts - 1 + quiet_samples(quiet_s, runs[i].motion.dt)
                peak = int(window_of(fine.outcome.t_max / runs[i].motion.dt, float(samples))[0])
                outcome = _noted(fine, coarse, agreements[i][-1], tolerance * pier.alpha, peak)
                outcome = _with_peak_in_motion(outcome, fine, coarse, runs[i], tolerance, quiet_s)
                outcomes[i] = _with_drift(runs[i], outcome)
                if len(agreements[i]) > 1 or not _same_counts(fine.outcome, coarse.outcome):
                    doubtful.append(i)
                del levels[i]
            elif len(agreements[i]) == HALVINGS:
                outcomes[i] = _not_converged(runs[i], levels.pop(i), tolerance, quiet_s, "")
        _look_for_chaos(runs, outcomes, doubtful, tolerance, quiet_s, stop)
    return outcomes


def _same_counts(fine: Outcome, coarse: Outcome) -> bool:
    """Return whether two outcomes have the same counts of events."""
    return all(getattr(fine, name) == getattr(coarse, name) for name in COUNTS)


def _look_for_chaos(
    runs: Sequence[Run],
    outcomes: list[Outcome | None],
    doubtful: Sequence[int],
    tolerance: float,
    quiet_s: float,
    stop: Stop,
) -> None:
    """Drop the errors of ``doubtful`` runs whose θ_max depends on digits that no record has: their agreement is chance."""
    checked = [
        (i, result) for i in doubtful if (result := outcomes[i]) is not None and result.theta_max_error is not None
    ]
    if not checked:
        return
    changed = [replace(runs[i], motion=runs[i].motion.times(1.0 + CHANGE)) for i, _ in checked]
    perturbed = try_all(changed, [result.substeps for _, result in checked], quiet_s, stop)
    for (i, result), trial in zip(checked, perturbed, strict=True):
        if trial is None:
            outcomes[i] = None
        elif not abs(trial.outcome.theta_max - result.theta_max) <= tolerance * runs[i].pier.alpha:
            becomes = (
                "overturns" if trial.outcome.status == "overturned" else f"comes to {trial.outcome.theta_max:.3g} rad"
            )
            chaos = (
                f"the peak is chaotic, under a motion {CHANGE:g} stronger the pier {becomes}: no error of it is claimed"
            )
            outcomes[i] = result.noted(chaos, theta_max_error=None)


def _steps_of_next(run: Run, levels: Sequence[Trial], quiet_s: float) -> float:
    return steps_of(run.motion, 2 * levels[-1].outcome.substeps, quiet_s)


def _least_error(base: Base) -> float:
    """Return the least error of θ/α that is claimed on ``base``."""
    rough = any(isinstance(d, Damper) and d.kind == "viscous" and d.exponent < 1.0 for d in base.restraints)
    return ROUGH if rough else ROUNDING


def _with_errors(fine: Outcome, coarse: Outcome, least: float, pier: Pier) -> Outcome:
    """Return ``fine`` with its differences from ``coarse`` as errors, ``least`` [rad] at least."""
    if fine.status != coarse.status or fine.status in ("overturned", "failed"):  # θ_max is where the run ended
        return fine
    residual = None
    if fine.theta_res is not None and coarse.theta_res is not None:
        residual = max(abs(fine.theta_res - coarse.theta_res), least)
    return fine.changed(
        theta_max_error=max(abs(fine.theta_max - coarse.theta_max), least),
        theta_res_error=residual,
        devices_error=change_of_devices(fine, coarse, pier),
    )


def _with_peak_in_motion(
    outcome: Outcome, fine: Trial, coarse: Trial, run: Run, tolerance: float, quiet_s: float
) -> Outcome:
    """Return ``outcome``, that of ``fine``, with the error of the peak within the motion.

    It has none where the two trials, of which ``coarse`` has twice the step, do not agree to the ``tolerance`` until then.
    """
    finer, coarser, alpha = fine.outcome, coarse.outcome, run.pier.alpha
    change = abs(finer.theta_max_in_motion - coarser.theta_max_in_motion)
    if finer.theta_max_in_motion == ON_ITS_SIDE or not change <= tolerance * alpha:
        return outcome
    last = run.motion.npts - 1.0
    until = int(window_of(last, last + quiet_samples(quiet_s, run.motion.dt))[0])
    if (np.abs(fine.extremes[:until] - coarse.extremes[:until]) > tolerance * alpha).any():
        return outcome
    return outcome.changed(change_in_motion=max(change, _least_error(run.base) * alpha))


def _with_drift(run: Run, outcome: Outcome) -> Outcome:
    """Return ``outcome`` with the drift of the residual rotation between its readings as a part of its error.

    The residual rotation depends by as much on when the record ends.
    """
    if outcome.theta_res_error is None or outcome.theta_res_drift is None:
        return outcome
    changed = abs(outcome.theta_res_drift) * readings(run.pier, run.base, run.motion.dt)[1] * run.motion.dt
    return outcome.changed(theta_res_error=outcome.theta_res_error + changed)


def agreement(fine: Trial, coarse: Trial, tolerance: float, pier: Pier) -> Agreement:
    """Return how far two runs agree; ``tolerance`` on rotations [rad]."""
    finer, coarser = fine.outcome, coarse.outcome
    if finer.status != coarser.status:
        return Agreement.NONE
    if finer.status == "failed":
        alike = finer.reason == coarser.reason and abs(finer.theta_max - coarser.theta_max) <= tolerance
        return Agreement.THROUGHOUT if alike and finer.reason in LEFT_ALONE else Agreement.NONE
    greatest = np.fmax(fine.extremes, coarse.extremes)
    change = np.abs(fine.extremes - coarse.extremes)
    change[np.isnan(greatest)] = 0.0  # a window that neither has reached
    if finer.status == "overturned":
        standing = greatest < pier.alpha
        fell_together = abs(finer.t_end - coarser.t_end) <= SAME_TIME / pier.p
        together = fell_together and not (change[standing] > max(tolerance, SAME_FALL * pier.alpha)).any()
        return Agreement.THROUGHOUT if together else Agreement.NONE
    if finer.status == "flight" and abs(_flight(finer) - _flight(coarser)) > SAME_TIME / pier.p:
        return Agreement.NONE
    if max(finer.theta_max_error or 0.0, finer.theta_res_error or 0.0) > tolerance:
        return Agreement.NONE
    if abs(finer.t_max - coarser.t_max) > SAME_TIME / pier.p:  # another peak of about the same height
        return Agreement.RESULTS
    differs = ~(change <= tolerance)
    if not differs.any():
        return Agreement.THROUGHOUT
    below = finer.theta_max - greatest[differs]
    return Agreement.APART if (FAR_BELOW * change[differs] <= below).all() else Agreement.RESULTS


def _flight(outcome: Outcome) -> float:
    return math.nan if outcome.t_flight is None else outcome.t_flight


def enough(agreements: Sequence[Agreement]) -> bool:
    """Return whether the last of ``agreements``, from one halving to the next, suffice."""
    for least, pairs in PAIRS.items():
        last = agreements[-pairs:]
        if len(last) == pairs and min(last) >= least:
            return True
    return False


def _noted(fine: Trial, coarse: Trial, extent: Agreement, tolerance: float, peak: int) -> Outcome:
    """Return the outcome with a note on what has not converged beside it; ``tolerance`` in rad, ``peak`` the window of the peak.

    If rotations before the peak have not converged, no error is claimed: the peak depends on digits that no record has, and two
    runs that agree on it agree by chance.
    """
    finer, coarser, notes = fine.outcome, coarse.outcome, list[str]()
    differs = np.abs(fine.extremes - coarse.extremes) > tolerance
    if extent < Agreement.THROUGHOUT and differs.any():
        greatest = np.nanmax(np.fmax(fine.extremes, coarse.extremes)[differs])
        notes.append(f"lesser rotations, up to {greatest:.2g} rad, have not settled")
        if differs[: peak + 1].any() and finer.status == "ok":
            finer = finer.changed(theta_max_error=None)
            notes.append("some of them before the peak, which is chaotic: no error of it is claimed")
    for name in COUNTS:
        fewer, more = sorted((getattr(coarser, name) or 0, getattr(finer, name) or 0))
        if fewer != more:
            notes.append(f"{name} not settled: {fewer} or {more}")
    if finer.status == "ok" and finer.t_flight != coarser.t_flight:
        times = [_flight(coarser), _flight(finer)]
        if not abs(times[1] - times[0]) <= 1e-3:
            moments = [f"at {t:.3f} s" if t == t else "none" for t in times]
            notes.append(f"first flight not settled: {moments[0]} or {moments[1]}")
    return finer.noted(*notes)


def _not_converged(run: Run, levels: Sequence[Trial], tolerance: float, quiet_s: float, more: str) -> Outcome:
    """Return the finest of a run's ``levels``, with its values, as failed."""
    finest, pier = levels[-1].outcome, run.pier
    if len(levels) > 1:
        finest = _with_peak_in_motion(finest, levels[-1], levels[-2], run, tolerance, quiet_s)
    if finest.status == "failed":
        return finest
    change = "the outcome"
    if len(levels) > 1:
        coarser = levels[-2].outcome
        errors = (("theta_max", finest.theta_max_error), ("theta_res", finest.theta_res_error))
        changes = [
            f"{name} by {error:.1e} rad"
            for name, error in errors
            if error is not None and error > tolerance * pier.alpha
        ]
        if finest.status == coarser.status == "overturned":
            changes = [f"the time of overturning, from {coarser.t_end:.2f} to {finest.t_end:.2f} s"]
        elif finest.status == coarser.status == "flight" and not changes:
            changes = [f"the time of flight, from {_flight(coarser):.3f} to {_flight(finest):.3f} s"]
        elif finest.status == coarser.status and not changes:
            changes = ["rotations almost as large as the peak"]
        change = " and ".join(changes) or f"the outcome, from {coarser.status} to {finest.status}"
    reason = (
        f"not settled: halving the step still changed {change}; at {finest.substeps} substeps: {finest.status}{more}"
    )
    return finest.changed(status="failed", reason=reason, note="")
