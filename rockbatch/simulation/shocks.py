"""Effects of each shock of a sequence on a pier, read from the history of the run."""

import math
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from rockbatch.motions.motion import Motion, Samples
from rockbatch.outcome.outcome import Outcome, ShockOutcome
from rockbatch.pier import ElasticBase
from rockbatch.simulation.leaning import greatest_swing, lean_of, unstressed
from rockbatch.simulation.runs import Run

LAST_PART = 0.25
"""Share of a pause, at its end, in which it is seen whether the pier still moves."""

NOT_REACHED = "not reached"
"""Status of a shock before which the run ended."""


_AT_ONCE = 1e-9  # s: times of samples are sums, and rounded


class OfShocks(NamedTuple):
    """What each shock of a run does, without errors, and the greatest |θ| [rad] and its time [s] of each by the rows alone."""

    outcomes: list[ShockOutcome]
    peaks: list[tuple[float, float]]


def of_shocks(run: Run, outcome: Outcome, rows: np.recarray) -> OfShocks:
    """Return what each shock of a run does by its ``rows``, which go on until a pause after the last."""
    peaks = _peaks(run.motion, rows)
    return OfShocks(_read(run, outcome, rows, list(peaks)), peaks)


def with_error(fine: OfShocks, coarse: OfShocks) -> list[ShockOutcome]:
    """Return what each shock does with errors, by what halving the step from ``coarse`` changed."""
    return [
        replace(finer, theta_max_error=abs(finer.theta_max - theta) if finer.status == "ok" else math.nan)
        for finer, (theta, _) in zip(fine.outcomes, coarse.peaks, strict=True)
    ]


def _peaks(motion: Motion, rows: np.recarray) -> list[tuple[float, float]]:
    """Return the greatest |θ| [rad] from each shock to the next, and its time [s]; NaN for those that the run does not reach."""
    ends = [*(shock.until for shock in motion.shocks[:-1]), math.inf]
    return [_peak(rows, shock.start, end) for shock, end in zip(motion.shocks, ends, strict=True)]


def _peak(rows: np.recarray, start: float, end: float) -> tuple[float, float]:
    """Return the greatest |θ| between two times, at rows and between them, where θ is cubic."""
    inside = rows[(rows.t >= start - _AT_ONCE) & (rows.t <= end + _AT_ONCE)]
    if len(inside) == 0:
        return math.nan, math.nan
    return greatest_swing(inside.t, inside.theta, inside.omega, inside.theta)


def _read(run: Run, outcome: Outcome, rows: np.recarray, peaks: list[tuple[float, float]]) -> list[ShockOutcome]:
    """Return what each shock does, without errors, by the ``rows`` of the run, and the ``peaks`` in them."""
    shocks = run.motion.shocks
    of_run = max(i for i, shock in enumerate(shocks) if shock.start <= outcome.t_max + _AT_ONCE)
    peaks[of_run] = outcome.theta_max, outcome.t_max  # of all steps, not only of rows
    ended = outcome.t_end if outcome.status in ("overturned", "flight") else math.inf
    lean, settlement = _base(run, rows)
    outcomes = []
    for shock, (theta, t) in zip(shocks, peaks, strict=True):
        if ended < shock.start - _AT_ONCE:
            outcomes.append(ShockOutcome(NOT_REACHED))
        elif ended < shock.until or (ended < math.inf and shock is shocks[-1]):
            outcomes.append(ShockOutcome(outcome.status, theta, t))
        else:
            quiet = (rows.t >= shock.until - LAST_PART * (shock.until - shock.end)) & (rows.t <= shock.until + _AT_ONCE)
            rotations = rows.theta[quiet] if quiet.any() else rows.theta[-1:]
            high, low = float(rotations.max()), float(rotations.min())
            last = int(np.searchsorted(rows.t, shock.until - _AT_ONCE)) - 1
            residual = 0.5 * (high + low) if run.base.has_residual else math.nan
            outcomes.append(ShockOutcome(
                "ok", theta, t, theta_res=residual if lean is None else float(lean[last]),
                settlement=math.nan if settlement is None else float(settlement[last]), moving=0.5 * (high - low),
            ))  # fmt: skip
    return outcomes


def _base(run: Run, rows: np.recarray) -> tuple[Samples | None, Samples | None]:
    """Return the rotation at which the pier would rest [rad], and the mean settlement of its supports [m], at every row; ``None``
    where dampers or tendons have a say in it, or on a rigid base."""
    pier, base = run.pier, run.base
    if not isinstance(base, ElasticBase):  # a history does not hold the set of a bed
        return None, None
    if not base.yields:
        return np.zeros(len(rows)) if not base.has_residual else None, np.zeros(len(rows))
    left, right = unstressed(pier, base, rows)
    return None if base.restraints else lean_of(pier, base, rows), -0.5 * (left + right)
