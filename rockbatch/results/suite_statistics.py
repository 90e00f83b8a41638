"""Statistics of a suite: mean, quantiles and distribution over records, and numbers of records without a peak."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from rockbatch.common.lazy import pd
from rockbatch.common.statuses import NO_PEAK
from rockbatch.quantities.statistics import FRACTILES_FROM, P84, Values, quantiles


def worst_records(runs: "pd.DataFrame", most: int) -> list[str]:
    """Return the ``most`` worst records: first those with a run in :data:`NO_PEAK`, then by decreasing rotation, then others."""
    badness = runs["theta_max_over_alpha"].where(~runs["status"].isin(NO_PEAK), math.inf)
    worst = badness.groupby(runs["record"]).max().sort_values(ascending=False, kind="stable")
    return list(worst.index[:most])


def reasons_of_failure(runs: "pd.DataFrame") -> list[str]:
    """Return the two most frequent kinds of failure, by number and the reason of the first run: "3 ×, for example: REASON"."""
    kinds = runs[runs["status"] == "failed"].groupby("failure", sort=False)["reason"].agg(["first", "size"])
    most = kinds.nlargest(2, "size").itertuples()
    return [f"{times} ×{', for example' if times > 1 else ''}: {reason}" for _, reason, times in most]


@dataclass(frozen=True)
class Statistics:
    """Statistics of one quantity over the records of a case.

    ``count`` records have an outcome, ``standing`` of them a finite value, whose ``mean`` is NaN without any. ``low``,
    ``median`` and ``high`` are the 16, 50 and 84 % quantiles over all ``count``, ``largest`` the maximum; infinite where
    they fall on a record under which the pier overturned or a run stopped in flight. ``low`` and ``high`` of fewer than
    FRACTILES_FROM, 6, are NaN.
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
    """Records, shapes (n,): the worst magnitude of each over its runs that did not fail, infinite if it overturned or flew, NaN
    without a value; flags of these outcomes, at most one True; and its group, in whose order the records are."""

    worst: Values
    overturned: npt.NDArray[np.bool_]
    flight: npt.NDArray[np.bool_]
    failed: npt.NDArray[np.bool_]
    group: npt.NDArray[np.int64]

    @property
    def known(self) -> npt.NDArray[np.bool_]:
        """True for records with an outcome to which the quantity applies."""
        return ~self.failed & ~np.isnan(self.worst)


def records(
    values: Values,
    status: Sequence[str],
    counted_as: Sequence[str] | None = None,
    group: npt.NDArray[np.int64] | None = None,
) -> Records:
    """Combine runs with ``values``, shape (n,), whose magnitudes count, and ``status`` into records.

    Runs of one ``group`` that are ``counted_as`` the same record count once, with the worst of them: overturned, then
    flight, then the largest value. If one of them failed and none overturned or flew, the record counts as failed, whatever
    its other runs. By default every run is a record of group 0.
    """
    kinds = np.asarray(status, dtype=object)
    no_peak = np.isin(kinds, NO_PEAK)
    magnitudes = np.where(no_peak, math.inf, np.where(kinds == "failed", math.nan, np.abs(values)))
    names = np.arange(len(kinds))
    if counted_as is not None:
        names = np.unique(np.asarray(counted_as, dtype=str), return_inverse=True)[1]
    if group is None:
        group = np.zeros(len(kinds), dtype=np.int64)
    pairs, record = np.unique(group * (len(names) + 1) + names, return_inverse=True)

    def any_of(runs: npt.NDArray[np.bool_]) -> npt.NDArray[np.bool_]:
        return np.bincount(record, runs, len(pairs)) > 0

    worst = np.full(len(pairs), math.nan)
    np.fmax.at(worst, record, magnitudes)
    overturned = any_of(kinds == "overturned")
    flown = any_of(kinds == "flight") & ~overturned
    failed = any_of(kinds == "failed") & ~overturned & ~flown
    return Records(worst, overturned, flown, failed, pairs // (len(names) + 1))


def suite(values: Values, status: Sequence[str], counted_as: Sequence[str] | None = None) -> Statistics:
    """Return statistics of the magnitudes of ``values``, shape (n,), over their :func:`records`; NaN is left out."""
    return suites(values, status, counted_as, np.zeros(len(values), dtype=np.int64), 1)[0]


def suites(
    values: Values, status: Sequence[str], counted_as: Sequence[str] | None, group: npt.NDArray[np.int64], groups: int
) -> list[Statistics]:
    """Return the statistics of each of ``groups`` groups; ``group``, shape (n,), is the index of each run's group."""
    data = records(values, status, counted_as, group)
    worst, group_of = data.worst[data.known], data.group[data.known]
    ordered = worst[np.lexsort((worst, group_of))]
    n = np.bincount(group_of, minlength=groups)
    first = np.cumsum(n) - n
    stood = np.isfinite(worst)
    standing = np.bincount(group_of[stood], minlength=groups)
    total = np.bincount(group_of[stood], worst[stood], groups)
    mean = np.where(standing > 0, total / np.maximum(standing, 1), math.nan)
    median, largest = (quantiles(ordered, first, n, q) for q in (0.5, 1.0))
    low, high = (np.where(n < FRACTILES_FROM, math.nan, quantiles(ordered, first, n, q)) for q in (0.16, P84))
    counts = [np.bincount(data.group[ended], minlength=groups) for ended in (data.overturned, data.flight, data.failed)]
    columns = [column.tolist() for column in (n, standing, mean, low, median, high, largest, *counts)]
    return [Statistics(*row) for row in zip(*columns, strict=True)]


def distribution(
    values: Values, status: Sequence[str], counted_as: Sequence[str] | None = None
) -> tuple[Values, Values]:
    """Return the empirical distribution of the magnitudes of ``values``, shape (n,), over their :func:`records`.

    The first array holds the values of the standing records, sorted; the second the share of all records with an outcome
    that do not exceed each. Records that overturned or stopped in flight exceed every value.
    """
    data = records(values, status, counted_as)
    worst = np.sort(data.worst[data.known])
    stood = worst[np.isfinite(worst)]
    return stood, np.arange(1, len(stood) + 1) / max(len(worst), 1)
