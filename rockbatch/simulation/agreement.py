"""Agreement of two trials of a run: in outcome, peak, residual rotation, trajectory and counts of events."""

import math
from collections.abc import Sequence
from enum import IntEnum
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from rockbatch.motions.motion import Samples
from rockbatch.outcome.outcome import Outcome
from rockbatch.pier import Pier
from rockbatch.simulation.runs import LEFT_ALONE, Trial

SAME_TIME = 0.01
"""Tolerance on the times of overturning, flight and peak, in units of 1/p."""

SAME_FALL = 0.02
"""Tolerance on the rotations before overturning, in units of α."""

COUNTS = ("impacts", "separations", "flights", "tendon_slack", "stop_blows", "deck_spring_blows")

FAR_BELOW = 3.0
"""Least distance of an extreme below the peak, over its change, at which it need not have converged."""

SAME_COURSE = 1e-3
"""Greatest change of an extreme, over the peak, at which runs with different counts of events count as the same."""


class Agreement(IntEnum):
    """Extent to which two trials of a run agree."""

    NONE = 0
    RESULTS = 1  # in outcome, peak and residual rotation; its time, or other extremes near the peak, have not converged
    APART = 2  # as RESULTS, and the extremes that have not converged are far below the peak
    THROUGHOUT = 3  # in the extremes of all windows too, and in the counts of events unless their course is the same


PAIRS = {Agreement.THROUGHOUT: 1, Agreement.APART: 2, Agreement.RESULTS: 4}
"""Consecutive halvings that must agree to at least this extent: the weaker the agreement, the more are needed."""


class Tolerances(NamedTuple):
    """Changes of rotations [rad] by a smaller step that count as none."""

    peak: float
    residual: float
    extremes: Samples  # of each window


def agreement(fine: Trial, coarse: Trial, tolerances: Tolerances, pier: Pier) -> Agreement:
    """Return the extent to which two trials agree within ``tolerances``; NONE if their statuses differ.

    Failed runs agree only in a failure that smaller steps do not change (:data:`rockbatch.simulation.runs.LEFT_ALONE`).
    """
    finer, coarser = fine.outcome, coarse.outcome
    if finer.status != coarser.status:
        return Agreement.NONE
    if finer.status == "failed":
        moved = abs(
            finer.theta_max_in_motion - coarser.theta_max_in_motion
        )  # later motion of a failed run is no result
        alike = finer.failure == coarser.failure and moved <= tolerances.peak
        return Agreement.THROUGHOUT if alike and finer.failure in LEFT_ALONE else Agreement.NONE
    greatest, change = windows(fine, coarse)
    if finer.status == "overturned":
        standing = greatest < pier.alpha
        fell_together = abs(finer.t_end - coarser.t_end) <= SAME_TIME / pier.p
        differs = change > np.maximum(tolerances.extremes, SAME_FALL * pier.alpha)
        together = fell_together and not (differs & standing).any()
        return Agreement.THROUGHOUT if together else Agreement.NONE
    if finer.status == "flight" and abs(flight_of(finer) - flight_of(coarser)) > SAME_TIME / pier.p:
        return Agreement.NONE
    if (finer.theta_max_error or 0.0) > tolerances.peak or (finer.theta_res_error or 0.0) > tolerances.residual:
        return Agreement.NONE
    if abs(finer.t_max - coarser.t_max) > SAME_TIME / pier.p:  # another peak of about the same height
        return Agreement.RESULTS
    differs = change > tolerances.extremes
    if not differs.any():
        same = same_counts(finer, coarser) or not (change > SAME_COURSE * finer.theta_max).any()
        return Agreement.THROUGHOUT if same else Agreement.APART
    return Agreement.APART if far_below(greatest, change, differs, finer.theta_max) else Agreement.RESULTS


def converged_extent(agreements: Sequence[Agreement]) -> Agreement:
    """Return the greatest extent that the last of a run's ``agreements``, as many as :data:`PAIRS` asks for, all reach.

    There is an agreement for each halving; NONE if the run has not converged.
    """
    for least, pairs in PAIRS.items():
        last = agreements[-pairs:]
        if len(last) == pairs and min(last) >= least:
            return least
    return Agreement.NONE


def same_counts(fine: Outcome, coarse: Outcome) -> bool:
    """Return True if two outcomes have the same counts of events."""
    return all(getattr(fine, name) == getattr(coarse, name) for name in COUNTS)


def windows(fine: Trial, coarse: Trial) -> tuple[Samples, Samples]:
    """Return the greater of two runs' extremes and their difference, per window [rad].

    Both are 0 in a window that neither run reached; the difference is infinite if one alone did.
    """
    greatest, change = np.fmax(fine.extremes, coarse.extremes), np.abs(fine.extremes - coarse.extremes)
    change[np.isnan(change)] = math.inf  # a window that only one of the two runs has reached
    reached = ~np.isnan(greatest)
    return np.where(reached, greatest, 0.0), np.where(reached, change, 0.0)


def far_below(greatest: Samples, change: Samples, differs: npt.NDArray[np.bool_], peak: float) -> bool:
    """Return True if all extremes that differ are below the ``peak`` by :data:`FAR_BELOW` times their change or more."""
    return bool((FAR_BELOW * change[differs] <= peak - greatest[differs]).all())


def flight_of(outcome: Outcome) -> float:
    """Return the time of the first flight [s]; NaN without one."""
    return math.nan if outcome.t_flight is None else outcome.t_flight
