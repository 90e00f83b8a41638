"""Chaotic results: those that a motion a hair stronger or weaker changes (THEORY.md, The error that a row reports)."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from rockbatch.outcome.changes import change_of_devices
from rockbatch.outcome.outcome import Outcome
from rockbatch.pier import Pier
from rockbatch.simulation.agreement import far_below, same_counts, windows
from rockbatch.simulation.models import fastest_rate
from rockbatch.simulation.runs import Run, Stop, Trial, try_all

CHANGES = {"stronger": 1e-8, "weaker": -1e-8}
"""Relative changes of a motion, less than a record resolves. A result that they change beyond the tolerance is chaotic."""

MARGIN = 2.0
"""Error that is claimed at least, over what one of :data:`CHANGES` or the drift between readings moves: neither is the most."""

SENSITIVE = 0.05
"""Change of the trajectory by halving the step, over α and (ω dt/k)², beyond which a run is tried under :data:`CHANGES`."""

NEARER = 4.0
"""Least factor by which halving the step brings residuals nearer that converge as the method does."""

RISES, FALLS = 300.0, 0.5
"""An extreme behind the peak is harmless if so many times its change by halving the step bring it neither to the peak nor to
this rotation over α, from which a pier may fall."""


def magnifies(run: Run, fine: Trial, coarse: Trial, outcome: Outcome, until: int) -> bool:
    """Return whether a run that claims the error of a peak magnifies the errors of steps; its motion lasts ``until`` this window.

    A chaotic peak does, as it magnifies changes of the motion (THEORY.md, The error that a row reports).
    """
    greatest, change = windows(fine, coarse)
    peak, claimed = outcome.theta_max, outcome.theta_max_error
    if claimed is None:
        peak, claimed = outcome.theta_max_in_motion, outcome.change_in_motion
        greatest, change = greatest[: until + 1], change[: until + 1]
    later = np.arange(len(greatest)) > greatest.argmax()
    change[later & (greatest + RISES * change < min(peak, FALLS * run.pier.alpha))] = 0.0
    resolved = max(fastest_rate(run.pier, run.base), run.pier.p) * run.motion.dt / outcome.substeps
    magnified = change * greatest > SENSITIVE * run.pier.alpha * peak * resolved**2
    return claimed is not None and bool(magnified.any())


def residuals_wander(levels: Sequence[Trial], tolerance: float, pier: Pier) -> bool:
    """Return whether the residuals of a run that converged may be chaotic; as sums over the motion they do not show in rotations.

    Counts of events then differ between the last two ``levels``, or residuals did not come nearer by :data:`NEARER` from one
    halving to the next.
    """
    outcomes = [trial.outcome for trial in levels]
    if outcomes[-1].theta_res_error is None:
        return False
    changes = [_residuals_apart(coarse, fine, pier) for coarse, fine in pairwise(outcomes)]
    slow = any(after > max(tolerance, before / NEARER) for before, after in pairwise(changes))
    return slow or not same_counts(outcomes[-1], outcomes[-2])


def look_for_chaos(
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
        outcome = _with_peak_of(probe, doubtful[i], outcome, tolerance, runs[i].pier, f"{abs(change):g} {words}")
        outcomes[i] = _with_residuals_of(probe.outcome, outcome, tolerance, runs[i].pier)


def _with_peak_of(probe: Trial, fine: Trial, outcome: Outcome, tolerance: float, pier: Pier, changed: str) -> Outcome:
    """Return ``outcome`` with the error of θ_max that ``probe``, under a ``changed`` motion, shows; none if it is chaotic."""
    tolerance *= pier.alpha
    if outcome.change_in_motion is not None:
        within = MARGIN * abs(probe.outcome.theta_max_in_motion - outcome.theta_max_in_motion)
        known = max(outcome.change_in_motion, within) if within <= tolerance else None
        outcome = outcome.changed(change_in_motion=known)
    ends = probe.outcome.status
    falls = ends == "overturned" and outcome.status in ("ok", "flight") and not outcome.may_overturn
    if falls:
        outcome = outcome.changed(may_overturn=True)
    if outcome.theta_max_error is None:
        return outcome.noted(f"a motion {changed} overturns the pier" if falls else "")
    moved = abs(probe.outcome.theta_max - outcome.theta_max)
    does = "overturns the pier" if falls else f"moves it by {moved:.1e} rad"
    if ends == outcome.status and MARGIN * moved <= tolerance:
        greatest, change = windows(probe, fine)
        if far_below(greatest, change, change > tolerance, outcome.theta_max):
            of_devices = change_of_devices(probe.outcome, fine.outcome, pier)
            return outcome.changed(
                theta_max_error=max(outcome.theta_max_error, MARGIN * moved),
                devices_error=of_devices and max(outcome.devices_error or 0.0, MARGIN * of_devices),
            )
        does = "brings another one as near to it"
    elif ends not in (outcome.status, "overturned"):
        does = f"ends it in {ends}" if ends == "flight" else "is not decided"
    return without_error(outcome, f"a motion {changed} {does}")


def without_error(outcome: Outcome, reason: str) -> Outcome:
    """Return ``outcome`` with a chaotic peak, of which no error is claimed, and the ``reason``."""
    if outcome.theta_max_error is None:
        return outcome
    chaos = f"the peak is chaotic, {reason}: no error of it is claimed"
    return outcome.noted(chaos, theta_max_error=None, devices_error=None, chaotic=True)


def _with_residuals_of(probe: Outcome, outcome: Outcome, tolerance: float, pier: Pier) -> Outcome:
    """Return ``outcome`` with errors of its residuals of at least what ``probe`` tells; none if they are chaotic."""
    if outcome.theta_res_error is None:
        return outcome
    if MARGIN * _residuals_apart(probe, outcome, pier) > tolerance * pier.alpha:
        chaos = (
            f"the residuals are chaotic, a motion {CHANGES['stronger']:g} off moves them: no error of them is claimed"
        )
        return outcome.noted(chaos, theta_res_error=None, settlement_error=None, chaotic=True)
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
