"""What a suite of runs comes to: mean and quantiles of what stood, how many overturned, flew or failed, and the distribution."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

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


class Records(NamedTuple):
    """Runs as records: the worst magnitude of each, infinite where the pier overturned or flew, NaN where it is unknown;
    and of which of them that is so. Shapes (n,)."""

    worst: npt.NDArray[np.float64]
    overturned: npt.NDArray[np.bool_]
    flight: npt.NDArray[np.bool_]
    failed: npt.NDArray[np.bool_]

    @property
    def known(self) -> npt.NDArray[np.float64]:
        """Of the records that have an outcome, and to which the quantity applies."""
        return self.worst[~self.failed & ~np.isnan(self.worst)]


def records(values: npt.NDArray[np.float64], status: Sequence[str], counted_as: Sequence[str] | None = None) -> Records:
    """The records of runs with ``values``, shape (n,), of which the magnitude counts, and the ``status`` of each.

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
    return Records(worst, over, flown, failed)


def suite(values: npt.NDArray[np.float64], status: Sequence[str], counted_as: Sequence[str] | None = None) -> Suite:
    """Statistics of the magnitudes of ``values``, shape (n,), over their :func:`records`; NaN does not apply."""
    of = records(values, status, counted_as)
    known = of.known
    stood = known[np.isfinite(known)]
    if len(known):
        low, median, high, largest = (quantile(known, q) for q in (0.16, 0.5, 0.84, 1.0))
    else:
        low = median = high = largest = math.nan
    mean = float(stood.mean()) if len(stood) else math.nan
    counts = (int(each.sum()) for each in (of.overturned, of.flight, of.failed))
    return Suite(len(known), len(stood), mean, low, median, high, largest, *counts)


def distribution(
    values: npt.NDArray[np.float64], status: Sequence[str], counted_as: Sequence[str] | None = None
) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
    """Empirical distribution of the magnitudes of ``values``, shape (n,), over their :func:`records`.

    Returns
    -------
    values, share : ndarray, shape (standing,)
        The value of each record that stood, in order, and the share of all records with an outcome that do not exceed it:
        those under which the pier overturned, or that were ended by flight, exceed all of them.
    """
    known = np.sort(records(values, status, counted_as).known)
    stood = known[np.isfinite(known)]
    return stood, np.arange(1, len(stood) + 1) / max(len(known), 1)
