"""What a suite of runs comes to: mean and quantiles of what stood, how many overturned, flew or failed, and the distribution."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from rockbatch.checks.statistics import quantile

NO_PEAK = ("overturned", "flight")
"""Outcomes without a largest rotation: they count as larger than any."""


@dataclass(frozen=True)
class Suite:
    """Statistics of one quantity over the runs of a case.

    ``count`` runs have an outcome, ``standing`` of them a value; ``mean`` is over those, NaN without any. ``low``,
    ``median`` and ``high`` are the 16, 50 and 84 % quantiles of all ``count``, ``largest`` the greatest: infinite
    where they fall on runs that overturned or were ended by flight.
    """

    count: int
    standing: int
    mean: float
    low: float
    median: float
    high: float
    largest: float
    overturned: int
    flight: int
    failed: int


def suite(values: npt.NDArray[np.float64], status: Sequence[str]) -> Suite:
    """Statistics of the magnitudes of ``values``, shape (n,), with the ``status`` of each run; NaN does not apply."""
    kinds = np.asarray(status, dtype=object)
    over, flown, failed = (kinds == kind for kind in (*NO_PEAK, "failed"))
    gone = over | flown
    magnitudes = np.where(gone, math.inf, np.abs(values))[~failed]
    magnitudes = magnitudes[~np.isnan(magnitudes)]
    stood = magnitudes[np.isfinite(magnitudes)]
    if len(magnitudes):
        low, median, high, largest = (quantile(magnitudes, q) for q in (0.16, 0.5, 0.84, 1.0))
    else:
        low = median = high = largest = math.nan
    mean = float(stood.mean()) if len(stood) else math.nan
    counts = (int(each.sum()) for each in (over, flown, failed))
    return Suite(len(magnitudes), len(stood), mean, low, median, high, largest, *counts)


def distribution(
    values: npt.NDArray[np.float64], status: Sequence[str]
) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
    """Empirical distribution of the magnitudes of ``values``, shape (n,), with the ``status`` of each run.

    Returns
    -------
    values, share : ndarray, shape (standing,)
        Each value of a run that stood, in order, and the share of all runs with an outcome that do not exceed it: runs that
        overturned, or were ended by flight, exceed all of them. Failed runs do not count.
    """
    kinds = np.asarray(status, dtype=object)
    gone = np.isin(kinds, NO_PEAK)
    stood = np.sort(np.abs(values[~gone & (kinds != "failed") & ~np.isnan(values)]))
    return stood, np.arange(1, len(stood) + 1) / max(len(stood) + int(gone.sum()), 1)
