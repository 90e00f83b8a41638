"""Statistics of a suite of runs: mean, quantiles and distribution of those that stood, numbers of those that did not."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from rockbatch.common.lazy import pd
from rockbatch.quantities.statistics import Values, quantiles

NO_PEAK = ("overturned", "flight")
"""Outcomes without a largest rotation: they count as larger than any."""


def worst_records(runs: "pd.DataFrame", most: int) -> list[str]:
    """Return the records with the worst runs, ``most`` of them at most: those without a largest rotation first."""
    badness = runs["theta_max_over_alpha"].where(~runs["status"].isin(NO_PEAK), math.inf)
    worst = badness.groupby(runs["record"]).max().sort_values(ascending=False, kind="stable")
    return list(worst.index[:most])


def reasons_of_failure(runs: "pd.DataFrame") -> dict[str, int]:
    """Return how many runs failed for each of the two most frequent reasons, without what follows a colon in these."""
    failed = runs.loc[runs["status"] == "failed", "reason"].astype(str)
    counts = failed.str.split("[:;]", n=1).str[0].value_counts()
    return {str(reason): int(times) for reason, times in counts.head(2).items()}


@dataclass(frozen=True)
class Statistics:
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
    of which of them that is so; and the group to which each belongs, in whose order they are. Shapes (n,)."""

    worst: Values
    overturned: npt.NDArray[np.bool_]
    flight: npt.NDArray[np.bool_]
    failed: npt.NDArray[np.bool_]
    group: npt.NDArray[np.int64]

    @property
    def known(self) -> npt.NDArray[np.bool_]:
        """True for each that has an outcome to which the quantity applies."""
        return ~self.failed & ~np.isnan(self.worst)


def records(
    values: Values,
    status: Sequence[str],
    counted_as: Sequence[str] | None = None,
    group: npt.NDArray[np.int64] | None = None,
) -> Records:
    """Return the records of runs with ``values``, shape (n,), of which the magnitude counts, and the ``status`` of each.

    Runs of one ``group`` that are ``counted_as`` one record count once, with the worst of them: overturned before flight
    before any value. Where one of them failed and none is worse than any value, the record is unknown. By default every run
    is a record, and all are of group 0.
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
    """Return statistics of the magnitudes of ``values``, shape (n,), over their :func:`records`; NaN does not apply."""
    return suites(values, status, counted_as, np.zeros(len(values), dtype=np.int64), 1)[0]


def suites(
    values: Values, status: Sequence[str], counted_as: Sequence[str] | None, group: npt.NDArray[np.int64], groups: int
) -> list[Statistics]:
    """Return the statistics of each of ``groups`` groups of runs; ``group``, shape (n,), is the place of that of each run."""
    data = records(values, status, counted_as, group)
    worst, group_of = data.worst[data.known], data.group[data.known]
    ordered = worst[np.lexsort((worst, group_of))]
    n = np.bincount(group_of, minlength=groups)
    first = np.cumsum(n) - n
    stood = np.isfinite(worst)
    standing = np.bincount(group_of[stood], minlength=groups)
    total = np.bincount(group_of[stood], worst[stood], groups)
    mean = np.where(standing > 0, total / np.maximum(standing, 1), math.nan)
    fractiles = [quantiles(ordered, first, n, q) for q in (0.16, 0.5, 0.84, 1.0)]
    counts = [np.bincount(data.group[ended], minlength=groups) for ended in (data.overturned, data.flight, data.failed)]
    return [
        Statistics(*row)
        for row in zip(*(column.tolist() for column in (n, standing, mean, *fractiles, *counts)), strict=True)
    ]


def distribution(
    values: Values, status: Sequence[str], counted_as: Sequence[str] | None = None
) -> tuple[Values, Values]:
    """Return the empirical distribution of the magnitudes of ``values``, shape (n,), over their :func:`records`.

    That is the value of each record that stood, in order, and the share of all records with an outcome that do not exceed it:
    those under which the pier overturned, or that were ended by flight, exceed all of them.
    """
    data = records(values, status, counted_as)
    worst = np.sort(data.worst[data.known])
    stood = worst[np.isfinite(worst)]
    return stood, np.arange(1, len(stood) + 1) / max(len(worst), 1)
