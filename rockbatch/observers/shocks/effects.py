"""Effects of each shock of a sequence on a pier, from the history of the run."""

import math
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from rockbatch.common.statuses import NO_PEAK
from rockbatch.motions.motion import Motion, Samples
from rockbatch.observers.shocks.outcome import ShockOutcome
from rockbatch.outcome.outcome import Outcome
from rockbatch.pier import ElasticBase
from rockbatch.simulation.leaning import greatest_swing, lean_of, unstressed
from rockbatch.simulation.runs import Run

LAST_PART = 0.25
"""Final share of a pause in which the remaining motion is measured."""


_AT_ONCE = 1e-9  # s: times of samples are sums, and rounded


class OfShocks(NamedTuple):
    """Effects of each shock of a run, without errors, and its greatest |θ| [rad] with its time [s] by the rows alone."""

    outcomes: list[ShockOutcome]
    peaks: list[tuple[float, float]]


def of_shocks(run: Run, outcome: Outcome, rows: np.recarray) -> OfShocks:
    """Return the effects of each shock from the ``rows`` of a run, which include a pause after the last one."""
    peaks = _peaks(run.motion, rows)
    return OfShocks(_effects(run, outcome, rows, list(peaks)), peaks)


def with_error(fine: OfShocks, coarse: OfShocks) -> list[ShockOutcome]:
    """Return the ``fine`` effects of each shock; the error of an "ok" one is the change of θ_max from ``coarse``, else NaN."""
    pairs = zip(fine.outcomes, coarse.peaks, strict=True)
    errors = [abs(finer.theta_max - theta) if finer.status == "ok" else math.nan for finer, (theta, _) in pairs]
    return [replace(finer, theta_max_error=error) for finer, error in zip(fine.outcomes, errors, strict=True)]


def _peaks(motion: Motion, rows: np.recarray) -> list[tuple[float, float]]:
    """Return the greatest |θ| [rad] and its time [s] from each shock to the next; NaN if the run does not reach it."""
    ends = [*(shock.until for shock in motion.shocks[:-1]), math.inf]
    return [_peak(rows, shock.start, end) for shock, end in zip(motion.shocks, ends, strict=True)]


def _peak(rows: np.recarray, start: float, end: float) -> tuple[float, float]:
    """Return the greatest |θ| [rad] and its time [s] between two times, also between rows; NaN without rows."""
    inside = rows[(rows.t >= start - _AT_ONCE) & (rows.t <= end + _AT_ONCE)]
    if len(inside) == 0:
        return math.nan, math.nan
    return greatest_swing(inside.t, inside.theta, inside.omega, inside.theta)


def _effects(run: Run, outcome: Outcome, rows: np.recarray, peaks: list[tuple[float, float]]) -> list[ShockOutcome]:
    """Return the effects of each shock, without errors, from the ``rows`` and ``peaks`` of a run with an ``outcome``.

    A shock in which the run ends has its status and peak only, each later one "not reached" alone. ``peaks`` are changed in
    place: the shock of the run's greatest rotation gets that, found over all steps.
    """
    shocks = run.motion.shocks
    of_run = max(i for i, shock in enumerate(shocks) if shock.start <= outcome.t_max + _AT_ONCE)
    peaks[of_run] = outcome.theta_max, outcome.t_max  # the run's peak over all steps, not only rows
    ended = outcome.t_end if outcome.status in NO_PEAK else math.inf
    lean, settlement = _rest_state(run, rows)
    outcomes = []
    for shock, (theta, t) in zip(shocks, peaks, strict=True):
        if ended < shock.start - _AT_ONCE:
            outcomes.append(ShockOutcome("not reached"))
        elif ended < shock.until or (ended < math.inf and shock is shocks[-1]):
            outcomes.append(ShockOutcome(outcome.status, theta, t))
        else:
            quiet = (rows.t >= shock.until - LAST_PART * (shock.until - shock.end)) & (rows.t <= shock.until + _AT_ONCE)
            rotations = rows.theta[quiet] if quiet.any() else rows.theta[-1:]
            high, low = float(rotations.max()), float(rotations.min())
            last = int(np.searchsorted(rows.t, shock.until - _AT_ONCE)) - 1
            residual = 0.5 * (high + low) if run.base.has_residual else math.nan
            theta_res = residual if lean is None else float(lean[last])
            sunk = math.nan if settlement is None else float(settlement[last])
            outcomes.append(ShockOutcome("ok", theta, t, math.nan, theta_res, sunk, 0.5 * (high - low)))
    return outcomes


def _rest_state(run: Run, rows: np.recarray) -> tuple[Samples | None, Samples | None]:
    """Return the static rest rotation [rad] and the mean settlement of the supports [m] at every row.

    Both are 0 on springs that do not yield, and ``None`` on a rigid base and a footing; the rotation is ``None`` if devices
    affect it.
    """
    pier, base = run.pier, run.base
    if not isinstance(base, ElasticBase):  # a history does not hold the set of a bed
        return None, None
    if not base.yields:
        return np.zeros(len(rows)) if not base.has_residual else None, np.zeros(len(rows))
    left, right = unstressed(pier, base, rows)
    return None if base.restraints else lean_of(pier, base, rows), -0.5 * (left + right)
