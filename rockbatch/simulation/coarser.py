"""What a model with fewer strips of its bed, or fewer modes of its shaft, changes: a share of every error."""

import math
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from rockbatch.core.clock import WINDOWS
from rockbatch.motions.motion import Samples
from rockbatch.outcome.outcome import BedDemands, Outcome
from rockbatch.pier import FootingBase
from rockbatch.simulation.agreement import Tolerances, windows
from rockbatch.simulation.runs import Run, Trial
from rockbatch.simulation.steps import FREQUENCY_STEP

FEWER_MODES = "with one mode of the shaft fewer it ends as {status}: no error of it is claimed"
_OF_SHAFT = ("theta_max", "deflection_max", "top_drift_max", "theta_res", "settlement")


def with_fewer_modes(run: Run) -> Run | None:
    """Return a run with the shaft in one mode fewer; None if it does not bend, or in one alone."""
    base = run.base
    if not base.bends:
        return None
    n = len(base.modes(run.pier).frequency)
    return Run(run.pier, replace(base, flexural_modes=n - 1), run.motion) if n > 1 else None


def with_modes_error(outcome: Outcome, other: Outcome, chance: float) -> Outcome:
    """Return ``outcome`` with ``chance`` times the change from the ``other`` one, by a mode fewer, in its errors.

    Unchanged unless the run ended well; without errors, and with a note, if the other ended otherwise. Modes converge at no known
    order.
    """
    if outcome.status != "ok":
        return outcome
    if other.status != outcome.status:
        unknown = {f"{name}_error": None for name in _OF_SHAFT}
        return outcome.noted(FEWER_MODES.format(status=other.status), **unknown)
    more: dict[str, Any] = {}
    for name in _OF_SHAFT:
        error = getattr(outcome, f"{name}_error")
        if error is not None:
            more[f"{name}_error"] = error + chance * _change(outcome, other, name)
    return outcome.changed(**more)


FEWER_STRIPS = "half as many strips come to another end: {status}; no error is claimed"

UNEVEN = 4.0
"""Error that is claimed on a bed over the change by twice the step, or by half as many strips: an error of order 1 is all of the
change by strips. That is the order where the ground yields in less than a strip, and where dashpots meet the edge of what is
pressed; and neither change falls evenly."""

EXTREMES = 1.5
"""Least share of the strips in the error of the peak over the change of any extreme until then: two peaks may agree by chance,
which a whole trajectory does not."""

LEAST = 2e-5
"""Least change of extremes over the peak: two runs may agree better than either is right."""

MISSED = (0.5 * FREQUENCY_STEP) ** 2 / 8.0
"""Share of a peak that readings at the ends of steps may miss: (ω h)²/8 of an oscillation, and ω h of the finer run is half of
:data:`FREQUENCY_STEP` at most."""

_OF_BED = {"force": MISSED, "pressure": MISSED, "work": 0.0}
"""Demands on a bed that have an error, with the part of them that is missed between steps."""

STEPS = 0.1
"""Share of what the strips leave of an error that the steps may add: smaller ones buy nothing."""


def with_fewer_strips(run: Run) -> Run | None:
    """Return a run on half as many strips of its bed, rounded down to an even number; None if it has none."""
    if not isinstance(run.base, FootingBase):
        return None
    return Run(run.pier, replace(run.base, strips=2 * (run.base.strips // 4)), run.motion)


def coarser(run: Run) -> list[Run]:
    """Return the runs of coarser models, of one mode fewer and of half as many strips; [] if there is none."""
    return [other for other in (with_fewer_modes(run), with_fewer_strips(run)) if other is not None]


class StripsShare(NamedTuple):
    """Share of the number of strips in errors of a run."""

    peak: float  # [rad]
    residual: float  # [rad]
    settlement: float  # [m]
    extremes: Samples  # of each window [rad]
    deflection: float  # of the top of a shaft that bends [m]
    drift: float  # [m]


def share_of_strips(own: Trial, fewer: Trial, half_width: float) -> StripsShare | None:
    """Return the StripsShare by a trial and one on half as many strips at the same step; None unless both end standing.

    After the peak, an extreme that its error may raise above the peak counts with what it then exceeds it by.
    The settlement, and the residual rotation of a foot that is ``half_width`` [m] wide to each side, come of the same sets.
    """
    ends = own.outcome, fewer.outcome
    if not ends[0].status == ends[1].status == "ok":
        return None
    greatest, change = windows(own, fewer)
    until = 1 + max(int(np.nanargmax(trial.extremes)) for trial in (own, fewer))
    before = max(float(change[:until].max()), LEAST * ends[0].theta_max)
    may_rise = np.where(np.isfinite(change), greatest + UNEVEN * change, 0.0)[until:].max(initial=0.0)
    sinks = _change(*ends, "settlement")
    return StripsShare(
        peak=max(UNEVEN * _change(*ends, "theta_max"), EXTREMES * before, float(may_rise) - ends[0].theta_max),
        residual=max(UNEVEN * _change(*ends, "theta_res"), EXTREMES * sinks / half_width),
        settlement=UNEVEN * sinks,
        extremes=EXTREMES * change,
        deflection=UNEVEN * _change(*ends, "deflection_max"),
        drift=UNEVEN * _change(*ends, "top_drift_max"),
    )


def _change(one: Outcome | BedDemands, other: Outcome | BedDemands, name: str) -> float:
    """Return the change of a result that both or none of two outcomes, or demands on a bed, have; 0 for none."""
    return abs((getattr(one, name) or 0.0) - (getattr(other, name) or 0.0))


def tolerances_beside(tolerance: float, share: StripsShare | None) -> Tolerances:
    """Return the Tolerances of a run: ``tolerance`` [rad], or a tenth (:data:`STEPS`) of the ``share`` of its strips if more."""
    if share is None:
        return Tolerances(tolerance, tolerance, np.full(WINDOWS, tolerance))
    return Tolerances(
        max(tolerance, STEPS * share.peak),
        max(tolerance, STEPS * share.residual),
        np.maximum(tolerance, STEPS * share.extremes),
    )


def with_strips_error(outcome: Outcome, own: Trial, fewer: Trial, half_width: float) -> Outcome:
    """Return ``outcome`` with errors by steps and strips, of trials on its ``own`` strips and ``fewer`` at the same step.

    An error is :data:`UNEVEN` times that by steps, and the share of the strips. Without errors, and with a note, if the trials
    end differently; one that did not end well has that of its peak within the motion only.
    """
    outcome = _with_strips_in_motion(outcome, own.outcome, fewer.outcome)
    if outcome.status != "ok" or outcome.bed is None:
        return outcome
    share = share_of_strips(own, fewer, half_width)
    if share is None:
        unknown = {f"{name}_error": None for name in _OF_SHAFT}
        return outcome.noted(FEWER_STRIPS.format(status=fewer.outcome.status), **unknown)
    more: dict[str, Any] = {"bed": _with_errors(outcome.bed, own.outcome.bed, fewer.outcome.bed, share.peak)}
    for name, of_strips in (
        ("theta_max_error", share.peak),
        ("theta_res_error", share.residual),
        ("settlement_error", share.settlement),
        ("deflection_max_error", share.deflection),
        ("top_drift_max_error", share.drift),
    ):
        error = getattr(outcome, name)
        more[name] = None if error is None else UNEVEN * error + of_strips
    return outcome.changed(**more)


def _with_errors(bed: BedDemands, own: BedDemands | None, fewer: BedDemands | None, of_peak: float) -> BedDemands:
    """Return the demands on a ``bed`` with errors, by those of twice the step on its ``own`` strips and on ``fewer``.

    ``of_peak`` is the share of the strips in the error of the greatest rotation [rad].
    """
    assert own is not None
    assert fewer is not None
    errors = {
        f"{name}_error": UNEVEN * (_change(bed, own, name) + _change(own, fewer, name)) + missed * getattr(bed, name)
        for name, missed in _OF_BED.items()
        if getattr(bed, name) is not None
    }
    return replace(bed, strips_error=of_peak, **errors)


def _with_strips_in_motion(outcome: Outcome, own: Outcome, fewer: Outcome) -> Outcome:
    """Return ``outcome`` with the share of the strips in the error of its peak within the motion, if that has one."""
    if outcome.change_in_motion is None:
        return outcome
    least = EXTREMES * LEAST * own.theta_max_in_motion
    of_strips = max(UNEVEN * _change(own, fewer, "theta_max_in_motion"), least)
    return outcome.changed(change_in_motion=UNEVEN * outcome.change_in_motion + of_strips)


MOST_DAMPING = 0.1
"""Damping ratio of the last mode beyond which its forces at a blow say nothing of those of further modes."""


def of_model(run: Run, change: float, chance: float) -> float:
    """Return the part of a force's error by modes or strips, from the relative ``change`` with fewer; NaN if that says nothing.

    A blow stops the base at once, which the damping force 2 ζ_i ω_i u̇_i of every mode meets: where ζ_i grows with ω_i, the sum
    has no limit.
    """
    base = run.base
    if base.bends and base.damping_ratios(run.pier)[-1] > MOST_DAMPING:
        return math.nan
    return chance * change
