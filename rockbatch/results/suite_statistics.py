"""What a suite of runs comes to: mean and quantiles of what stood, and how many overturned, flew or failed."""

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
