"""Chaotic results: those changed by a tiny change of the motion (THEORY.md, The error that a row reports)."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import lru_cache
from itertools import pairwise

import numpy as np

from rockbatch.outcome.changes import change_of_devices
from rockbatch.outcome.outcome import Outcome
from rockbatch.pier import Base, Pier
from rockbatch.pier.equilibrium import without_dampers
from rockbatch.pier.footings import slow_turn
from rockbatch.simulation.agreement import far_below, same_counts, windows
from rockbatch.simulation.runs import Run, Stop, Trial, try_all
from rockbatch.simulation.steps import fastest_rate

CHANGES = {"stronger": 1e-8, "weaker": -1e-8}
"""Relative changes of a motion, less than a record resolves. A result that they change beyond the tolerance is chaotic."""

MARGIN = 2.0
"""Least claimed error over the change by one of :data:`CHANGES`, or by drift between readings, which are not the worst."""

SENSITIVE = 0.05
"""Change of the trajectory by halving the step, over α and (ω dt/k)², above which a run is repeated under :data:`CHANGES`."""

NEARER = 4.0
"""Least factor by which halving the step reduces the changes of residuals that converge."""

RISES, FALLS = 300.0, 0.5
"""An extreme after the peak is harmless if RISES times its change by halving the step brings it neither to the peak nor to the
rotation FALLS α, from which a pier may overturn."""

NEAR, SWIFT = 0.2, 6.0
"""Distance from its unstable equilibrium, over it, of a pier that may linger, and the time there, times p, above which a run is
repeated: energies that differ by 10⁻⁸ are told apart after about 2 ln(0.2/10⁻⁴) = 15."""


def magnifies(run: Run, fine: Trial, coarse: Trial, outcome: Outcome, until: int) -> bool:
    """Return True if a run that claims the error of its peak magnifies errors of steps; ``until`` is the motion's last window.

    Without that error its peak within the motion is looked at; False if neither has an error. A chaotic peak magnifies them, as
    it does changes of the motion (THEORY.md, The error that a row reports).
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


def lingers(run: Run, fine: Trial, quiet_s: float) -> bool:
    """Return True if a pier that stays upright may lean near its unstable equilibrium for longer than :data:`SWIFT`/p.

    There the least change may overturn it, which a peak before it does not show. Windows count whole, if the pier leans that far
    in them or farther: it may linger on its way back. The last one extends to the end of the run, beyond the tail of ``quiet_s``
    [s].
    """
    outcome = fine.outcome
    near = fine.extremes > (1.0 - NEAR) * _unstable_equilibrium(run.pier, run.base)
    tail_s = run.motion.duration + quiet_s
    lingered = near.sum() * tail_s / len(near) + near[-1] * max(outcome.t_end - tail_s, 0.0)
    return outcome.status == "ok" and bool(lingered * run.pier.p > SWIFT)


@lru_cache(maxsize=256)
def _unstable_equilibrium(pier: Pier, base: Base) -> float:
    """Return the unstable equilibrium of a pier that is turned slowly [rad]; inf if it has none up to π/2."""
    unstable = slow_turn(pier, base, without_dampers(base.restraints)).unstable
    return math.inf if unstable is None else unstable


def residuals_wander(levels: Sequence[Trial], tolerance: float, pier: Pier) -> bool:
    """Return True if the residuals of a converged run may be chaotic, which rotations do not show; False without residuals.

    Then counts of events differ between the last two ``levels``, or a halving changed residuals by more than the ``tolerance``
    [rad] and than 1/:data:`NEARER` of what the halving before did.
    """
    outcomes = [trial.outcome for trial in levels]
    if outcomes[-1].theta_res_error is None:
        return False
    changes = [_residual_difference(coarse, fine, pier) for coarse, fine in pairwise(outcomes)]
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
    """Repeat ``doubtful`` runs under :data:`CHANGES`, and raise or withdraw their errors in ``outcomes``, in place.

    The outcome of a run whose repetition was stopped becomes None.
    """
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
    """Return ``outcome`` with the error of θ_max raised by ``probe``, a run under a motion ``changed`` as in "1e-08 weaker".

    It is withdrawn if :data:`MARGIN` times the change exceeds the ``tolerance`` of θ/α, if another extreme comes as near, or if
    ``probe`` ends otherwise; so is that within the motion by its change. ``may_overturn`` is set if only ``probe`` overturns.
    """
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
    """Return ``outcome`` with its peak marked as chaotic for ``reason``, without errors of the peak and of devices.

    Unchanged if its peak has no error.
    """
    if outcome.theta_max_error is None:
        return outcome
    chaos = f"the peak is chaotic, {reason}: no error of it is claimed"
    return outcome.noted(chaos, theta_max_error=None, devices_error=None, chaotic=True)


def _with_residuals_of(probe: Outcome, outcome: Outcome, tolerance: float, pier: Pier) -> Outcome:
    """Return ``outcome`` with errors of its residuals of at least :data:`MARGIN` times their change by ``probe``.

    They are withdrawn, as chaotic, if that exceeds the ``tolerance`` of θ/α; without them ``outcome`` is unchanged.
    """
    if outcome.theta_res_error is None:
        return outcome
    if MARGIN * _residual_difference(probe, outcome, pier) > tolerance * pier.alpha:
        chaos = (
            f"the residuals are chaotic, a motion {CHANGES['stronger']:g} off moves them: no error of them is claimed"
        )
        return outcome.noted(chaos, theta_res_error=None, settlement_error=None, chaotic=True)
    tilted, sunk = (MARGIN * _difference(probe, outcome, name) for name in ("theta_res", "settlement"))
    settlement_error = None if outcome.settlement_error is None else max(outcome.settlement_error, sunk)
    return outcome.changed(theta_res_error=max(outcome.theta_res_error, tilted), settlement_error=settlement_error)


def _residual_difference(one: Outcome, other: Outcome, pier: Pier) -> float:
    """Return how far two outcomes differ in residual rotation [rad] or settlement over half the width, whichever is more."""
    return max(_difference(one, other, "theta_res"), _difference(one, other, "settlement") / pier.half_width)


def _difference(one: Outcome, other: Outcome, name: str) -> float:
    """Return the difference of a result of two outcomes: 0 if neither has it, inf if only one has."""
    first, second = getattr(one, name), getattr(other, name)
    if first is None or second is None:
        return 0.0 if first is second else math.inf
    return float(abs(first - second))
