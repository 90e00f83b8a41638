"""Step-halving error control: smaller steps until the results converge (THEORY.md, The error that a row reports)."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from enum import IntEnum
from itertools import pairwise

import numpy as np
import numpy.typing as npt

from rockbatch.common.notes import CHAOTIC, OVERTURNS
from rockbatch.core.clock import ON_ITS_SIDE, window_of
from rockbatch.motions.motion import Motion, Samples
from rockbatch.pier import Base, Damper, Pier
from rockbatch.simulation.changes import change_of_devices
from rockbatch.simulation.models import fastest_rate, first_substeps, readings
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

CHANGES = {"stronger": 1e-8, "weaker": -1e-8}
"""Relative changes of a motion, less than a record resolves. A result that they change beyond the tolerance is chaotic."""

MARGIN = 2.0
"""Error that is claimed at least, over what one of :data:`CHANGES` or the drift between readings moves: neither is the most."""

CHANCE = 4.0
"""Error of the peak within a motion that is claimed, over what halving the step still changed: no third trial confirms it."""

SENSITIVE = 0.05
"""Change of the trajectory by halving the step, over α and (ω dt/k)², beyond which a run is tried under :data:`CHANGES`."""

COUNTS = ("impacts", "separations", "flights", "tendon_slack", "stop_blows", "deck_spring_blows")

RISES, FALLS = 300.0, 0.5
"""An extreme behind the peak is harmless if so many times its change by halving the step bring it neither to the peak nor to
this rotation over α, from which a pier may fall."""

FAR_BELOW = 3.0
"""An extreme that has not converged is harmless if it is below the peak by so many times its change."""

SAME_COURSE = 1e-3
"""In units of the peak: change of an extreme up to which two runs with different counts of events had the same course."""


class Agreement(IntEnum):
    """Extent to which two trials of a run agree."""

    NONE = 0
    RESULTS = 1  # in outcome, peak and residual rotation; its time, or other extremes near the peak, have not converged
    APART = 2  # likewise, and the extremes that have not converged are far below the peak
    THROUGHOUT = 3  # in the extremes of all windows too, and in the counts of events unless their course is the same


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
            outcomes[i] = _not_converged(runs[i].pier, levels.pop(i), tolerance, more)
        unfinished, doubtful = list(levels), dict[int, Trial]()
        substeps = [2 * levels[i][-1].outcome.substeps for i in unfinished]
        for i, fine in zip(unfinished, try_all([runs[i] for i in unfinished], substeps, quiet_s, stop), strict=True):
            if fine is None:
                del levels[i]
                continue
            pier, coarse = runs[i].pier, levels[i][-1]
            fine = Trial(_with_errors(runs[i], fine.outcome, coarse.outcome), fine.extremes)
            levels[i].append(fine)
            agreements[i].append(agreement(fine, coarse, tolerance * pier.alpha, pier))
            if extent := settled(agreements[i]):
                until = _window_at(runs[i], runs[i].motion.duration, quiet_s)
                peak = _window_at(runs[i], fine.outcome.t_max, quiet_s)
                outcome = _noted(fine, coarse, agreements[i][-1], tolerance * pier.alpha, peak)
                outcome = _with_peak_in_motion(runs[i], fine, coarse, outcome, tolerance * pier.alpha, until)
                outcome = _with_drift(runs[i], outcome)
                magnifies = _magnifies(runs[i], fine, coarse, outcome, until)
                if magnifies and extent == Agreement.RESULTS:
                    outcome = _without_error(outcome, "other peaks near it follow the step")
                if magnifies or _residuals_wander(levels[i], tolerance * pier.alpha, pier):
                    doubtful[i] = fine
                outcomes[i] = outcome
                del levels[i]
            elif len(agreements[i]) == HALVINGS:
                outcomes[i] = _not_converged(pier, levels.pop(i), tolerance, "")
        _look_for_chaos(runs, outcomes, doubtful, tolerance, quiet_s, stop)
    return outcomes


def _same_counts(fine: Outcome, coarse: Outcome) -> bool:
    """Return whether two outcomes have the same counts of events."""
    return all(getattr(fine, name) == getattr(coarse, name) for name in COUNTS)


def _window_at(run: Run, t: float, quiet_s: float) -> int:
    """Return the window of a run's extremes in which ``t`` [s] lies."""
    samples = run.motion.npts - 1 + quiet_samples(quiet_s, run.motion.dt)
    return int(window_of(t / run.motion.dt, float(samples))[0])


def _magnifies(run: Run, fine: Trial, coarse: Trial, outcome: Outcome, until: int) -> bool:
    """Return whether a run that claims the error of a peak magnifies the errors of steps; its motion lasts ``until`` this window.

    A chaotic peak does, as it magnifies changes of the motion (THEORY.md, The error that a row reports).
    """
    greatest, change = _windows(fine, coarse)
    peak, claimed = outcome.theta_max, outcome.theta_max_error
    if claimed is None:
        peak, claimed = outcome.theta_max_in_motion, outcome.change_in_motion
        greatest, change = greatest[: until + 1], change[: until + 1]
    later = np.arange(len(greatest)) > greatest.argmax()
    change[later & (greatest + RISES * change < min(peak, FALLS * run.pier.alpha))] = 0.0
    resolved = max(fastest_rate(run.pier, run.base), run.pier.p) * run.motion.dt / outcome.substeps
    magnified = change * greatest > SENSITIVE * run.pier.alpha * peak * resolved**2
    return claimed is not None and bool(magnified.any())


def _residuals_wander(levels: Sequence[Trial], tolerance: float, pier: Pier) -> bool:
    """Return whether the residuals of a run that converged may be chaotic; as sums over the motion they do not show in rotations.

    Counts of events then differ between the last two ``levels``, or residuals between earlier ones.
    """
    outcomes = [trial.outcome for trial in levels]
    if outcomes[-1].theta_res_error is None:
        return False
    return not _same_counts(outcomes[-1], outcomes[-2]) or any(
        _residuals_apart(coarse, fine, pier) > tolerance for coarse, fine in pairwise(outcomes[:-1])
    )


def _look_for_chaos(
    runs: Sequence[Run],
    outcomes: list[Outcome | None],
    doubtful: Mapping[int, Trial],
    tolerance: float,
    quiet_s: float,
    stop: Stop,
) -> None:
    """Try ``doubtful`` runs under :data:`CHANGES`: their errors become no less than what these change, or are withdrawn."""
    probes = [(i, words, change) for i in doubtful for words, change in CHANGES.items()]
    changed = [replace(runs[i], motion=runs[i].motion.times(1.0 + change)) for i, _, change in probes]
    trials = try_all(changed, [doubtful[i].outcome.substeps for i, _, _ in probes], quiet_s, stop)
    for (i, words, change), probe in zip(probes, trials, strict=True):
        outcome = outcomes[i]
        if probe is None or outcome is None:
            outcomes[i] = None
            continue
        outcome = _with_peak_of(probe, doubtful[i], outcome, tolerance * runs[i].pier.alpha, f"{abs(change):g} {words}")
        outcomes[i] = _with_residuals_of(probe.outcome, outcome, tolerance, runs[i].pier)


def _with_peak_of(probe: Trial, fine: Trial, outcome: Outcome, tolerance: float, changed: str) -> Outcome:
    """Return ``outcome`` with the error of θ_max that ``probe``, under a ``changed`` motion, shows; none if it is chaotic."""
    if outcome.change_in_motion is not None:
        within = MARGIN * abs(probe.outcome.theta_max_in_motion - outcome.theta_max_in_motion)
        known = max(outcome.change_in_motion, within) if within <= tolerance else None
        outcome = outcome.changed(change_in_motion=known)
    if outcome.theta_max_error is None:
        return outcome
    moved = abs(probe.outcome.theta_max - outcome.theta_max)
    if probe.outcome.status == outcome.status and MARGIN * moved <= tolerance:
        greatest, change = _windows(probe, fine)
        if _far_below(greatest, change, change > tolerance, outcome.theta_max):
            return outcome.changed(theta_max_error=max(outcome.theta_max_error, MARGIN * moved))
        does = "brings another one as near to it"
    else:
        does = OVERTURNS if probe.outcome.status == "overturned" else f"moves it by {moved:.1e} rad"
    return _without_error(outcome, f"a motion {changed} {does}")


def _without_error(outcome: Outcome, reason: str) -> Outcome:
    """Return ``outcome`` with a chaotic peak, of which no error is claimed, and the ``reason``."""
    if outcome.theta_max_error is None:
        return outcome
    chaos = f"the peak is {CHAOTIC}, {reason}: no error of it is claimed"
    return outcome.noted(chaos, theta_max_error=None, devices_error=None)


def _with_residuals_of(probe: Outcome, outcome: Outcome, tolerance: float, pier: Pier) -> Outcome:
    """Return ``outcome`` with errors of its residuals of at least what ``probe`` tells; none if they are chaotic."""
    if outcome.theta_res_error is None:
        return outcome
    if MARGIN * _residuals_apart(probe, outcome, pier) > tolerance * pier.alpha:
        chaos = (
            f"the residuals are {CHAOTIC}, a motion {CHANGES['stronger']:g} off moves them: no error of them is claimed"
        )
        return outcome.noted(chaos, theta_res_error=None, settlement_error=None)
    tilted, sunk = (MARGIN * _apart(probe, outcome, name) for name in ("theta_res", "settlement"))
    settlement_error = None if outcome.settlement_error is None else max(outcome.settlement_error, sunk)
    return outcome.changed(theta_res_error=max(outcome.theta_res_error, tilted), settlement_error=settlement_error)


def _residuals_apart(one: Outcome, other: Outcome, pier: Pier) -> float:
    """Return how far the residuals of two outcomes lie apart, the settlements over half the width [rad]."""
    return max(_apart(one, other, "theta_res"), _apart(one, other, "settlement") / pier.half_width)


def _apart(one: Outcome, other: Outcome, name: str) -> float:
    """Return how far a result of two outcomes lies apart: 0 where neither has one, infinite where one alone has it."""
    first, second = getattr(one, name), getattr(other, name)
    if first is None or second is None:
        return 0.0 if first is second else math.inf
    return float(abs(first - second))


def _steps_of_next(run: Run, levels: Sequence[Trial], quiet_s: float) -> float:
    return steps_of(run.motion, 2 * levels[-1].outcome.substeps, quiet_s)


def _least_error(base: Base) -> float:
    """Return the least error of θ/α that is claimed on ``base``."""
    rough = any(isinstance(d, Damper) and d.kind == "viscous" and d.exponent < 1.0 for d in base.restraints)
    return ROUGH if rough else ROUNDING


def _with_errors(run: Run, fine: Outcome, coarse: Outcome) -> Outcome:
    """Return ``fine`` with its differences from ``coarse`` as errors."""
    if fine.status != coarse.status or fine.status in ("overturned", "failed"):  # θ_max is where the run ended
        return fine
    least = _least_error(run.base) * run.pier.alpha
    errors = {"theta_max_error": max(abs(fine.theta_max - coarse.theta_max), least)}
    if fine.theta_res is not None and coarse.theta_res is not None:
        errors["theta_res_error"] = max(abs(fine.theta_res - coarse.theta_res), least)
    if run.base.yields and fine.settlement is not None and coarse.settlement is not None:
        errors["settlement_error"] = max(abs(fine.settlement - coarse.settlement), least * run.pier.half_width)
    return fine.changed(devices_error=change_of_devices(fine, coarse, run.pier), **errors)


def _with_peak_in_motion(
    run: Run, fine: Trial, coarse: Trial, outcome: Outcome, tolerance: float, until: int
) -> Outcome:
    """Return ``outcome``, that of ``fine``, with the error of the peak within the motion, whose last window is ``until``.

    It is :data:`CHANCE` times the greatest change of any extreme until then from ``coarse``, of twice the step. It has none if
    that is above the ``tolerance`` [rad].
    """
    peaks = abs(fine.outcome.theta_max_in_motion - coarse.outcome.theta_max_in_motion)
    change = CHANCE * max(peaks, float(_windows(fine, coarse)[1][:until].max(initial=0.0)))
    if outcome.theta_max_in_motion == ON_ITS_SIDE or not change <= tolerance:
        return outcome
    return outcome.changed(change_in_motion=max(change, _least_error(run.base) * run.pier.alpha))


def _with_drift(run: Run, outcome: Outcome) -> Outcome:
    """Return ``outcome`` with twice the drift of its residuals between their readings as a part of their errors.

    The residuals depend by as much on when the record ends: vibration that nothing damps comes and goes.
    """
    if outcome.theta_res_error is None or outcome.settlement_error is None or outcome.theta_res_drift is None:
        return outcome
    seconds = MARGIN * readings(run.pier, run.base, run.motion.dt)[1] * run.motion.dt
    return outcome.changed(
        theta_res_error=outcome.theta_res_error + abs(outcome.theta_res_drift) * seconds,
        settlement_error=outcome.settlement_error + abs(outcome.settlement_drift or 0.0) * seconds,
    )


def agreement(fine: Trial, coarse: Trial, tolerance: float, pier: Pier) -> Agreement:
    """Return how far two runs agree; ``tolerance`` on rotations [rad]."""
    finer, coarser = fine.outcome, coarse.outcome
    if finer.status != coarser.status:
        return Agreement.NONE
    if finer.status == "failed":
        moved = abs(finer.theta_max_in_motion - coarser.theta_max_in_motion)  # what comes after it is no result
        alike = finer.reason == coarser.reason and moved <= tolerance
        return Agreement.THROUGHOUT if alike and finer.reason in LEFT_ALONE else Agreement.NONE
    greatest, change = _windows(fine, coarse)
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
    differs = change > tolerance
    if not differs.any():
        same = _same_counts(finer, coarser) or not (change > SAME_COURSE * finer.theta_max).any()
        return Agreement.THROUGHOUT if same else Agreement.APART
    return Agreement.APART if _far_below(greatest, change, differs, finer.theta_max) else Agreement.RESULTS


def _windows(fine: Trial, coarse: Trial) -> tuple[Samples, Samples]:
    """Return the greater of two runs' extremes in each window, and how far they lie apart [rad]; 0 where neither has one."""
    greatest, change = np.fmax(fine.extremes, coarse.extremes), np.abs(fine.extremes - coarse.extremes)
    change[np.isnan(change)] = math.inf  # a window that one of them has not reached
    reached = ~np.isnan(greatest)
    return np.where(reached, greatest, 0.0), np.where(reached, change, 0.0)


def _far_below(greatest: Samples, change: Samples, differs: npt.NDArray[np.bool_], peak: float) -> bool:
    """Return whether the extremes that differ are below the ``peak`` by several times their change."""
    return bool((FAR_BELOW * change[differs] <= peak - greatest[differs]).all())


def _flight(outcome: Outcome) -> float:
    return math.nan if outcome.t_flight is None else outcome.t_flight


def settled(agreements: Sequence[Agreement]) -> Agreement:
    """Return the extent to which the last of ``agreements``, from one halving to the next, suffice; NONE if they do not."""
    for least, pairs in PAIRS.items():
        last = agreements[-pairs:]
        if len(last) == pairs and min(last) >= least:
            return least
    return Agreement.NONE


def _noted(fine: Trial, coarse: Trial, extent: Agreement, tolerance: float, peak: int) -> Outcome:
    """Return the outcome with a note on what has not converged beside it; ``tolerance`` in rad, ``peak`` the window of the peak.

    If rotations before the peak have not converged, no error is claimed: the peak depends on digits that no record has, and two
    runs that agree on it agree by chance.
    """
    finer, coarser, notes = fine.outcome, coarse.outcome, list[str]()
    greatest, change = _windows(fine, coarse)
    differs = change > tolerance
    if extent < Agreement.THROUGHOUT and differs.any():
        notes.append(f"lesser rotations, up to {greatest[differs].max():.2g} rad, have not settled")
        if differs[: peak + 1].any() and finer.status == "ok":
            finer = finer.changed(theta_max_error=None, devices_error=None)
            notes.append(f"some of them before the peak, which is {CHAOTIC}: no error of it is claimed")
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


def _not_converged(pier: Pier, levels: Sequence[Trial], tolerance: float, more: str) -> Outcome:
    """Return the finest of a run's ``levels``, with its values, as failed."""
    finest = levels[-1].outcome
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
