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
    """Statistics of one quantity over the records of a case.

    ``count`` records have an outcome, ``standing`` of them a value; ``mean`` is over those, NaN without any. ``low``,
    ``median`` and ``high`` are the 16, 50 and 84 % quantiles of all ``count``, ``largest`` the greatest: infinite
    where they fall on records under which the pier overturned or that were ended by flight.
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


def suite(values: npt.NDArray[np.float64], status: Sequence[str], counted_as: Sequence[str] | None = None) -> Suite:
    """Statistics of the magnitudes of ``values``, shape (n,), with the ``status`` of each run; NaN does not apply.

    Runs that are ``counted_as`` one record count once, with the worst of them: overturned before flight before any value.
    Where one of them failed and none is worse than any value, the record is unknown. By default every run is a record.
    """
    kinds = np.asarray(status, dtype=object)
    gone = np.isin(kinds, NO_PEAK)
    magnitudes = np.where(gone, math.inf, np.where(kinds == "failed", math.nan, np.abs(values)))
    names = np.arange(len(kinds)) if counted_as is None else np.asarray(counted_as, dtype=str)
    found, record = np.unique(names, return_inverse=True)

    def any_of(runs: npt.NDArray[np.bool_]) -> npt.NDArray[np.bool_]:
        return np.bincount(record, runs, len(found)) > 0

    worst = np.full(len(found), math.nan)
    np.fmax.at(worst, record, magnitudes)
    over = any_of(kinds == "overturned")
    flown = any_of(kinds == "flight") & ~over
    failed = any_of(kinds == "failed") & ~over & ~flown
    known = worst[~failed & ~np.isnan(worst)]
    stood = known[np.isfinite(known)]
    if len(known):
        low, median, high, largest = (quantile(known, q) for q in (0.16, 0.5, 0.84, 1.0))
    else:
        low = median = high = largest = math.nan
    mean = float(stood.mean()) if len(stood) else math.nan
    counts = (int(each.sum()) for each in (over, flown, failed))
    return Suite(len(known), len(stood), mean, low, median, high, largest, *counts)
