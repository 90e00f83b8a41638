"""How well each intensity measure orders the peaks: rank correlations, and lines through logarithms."""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from rockbatch.common.lazy import pd
from rockbatch.common.statuses import NO_PEAK
from rockbatch.observers.intensity.table import measures_in

LEAST_RUNS = 3
"""Fewest runs with values for a rank correlation or a regression line."""

Array = npt.NDArray[np.float64]


class Order(NamedTuple):
    """How well a measure orders the peaks of a case at one scale."""

    # numbers of runs that count, and of those that overturned or stopped in flight, which rank above all others
    runs: int
    without_peak: int
    # Spearman's ρ of the measure and θ_max; NaN with fewer than three runs, or if all of either are equal
    rank_correlation: float
    # number of runs that stood and rocked, to which ln θ_max = a + b ln(measure) is fitted by least squares
    fitted: int
    # b, and the standard deviation of ln θ_max about the line; NaN with fewer than three runs, or if all measures are equal
    slope: float
    dispersion: float


def order_of(measure: Array, theta: Array, status: Sequence[str]) -> Order:
    """Return how well ``measure`` orders the peaks ``theta``, both shape (n,); failed runs and those with NaN are left out.

    Runs that overturned or stopped in flight count as an infinite peak, whatever their ``theta``.
    """
    kinds = np.asarray(status, dtype=object)
    overturned = np.isin(kinds, NO_PEAK)
    peaks = np.where(overturned, math.inf, theta)
    counts = (kinds != "failed") & ~np.isnan(peaks) & ~np.isnan(measure)
    peaks, measure, overturned = peaks[counts], measure[counts], overturned[counts]
    drawn = np.isfinite(peaks) & (peaks > 0) & (measure > 0)
    slope, dispersion = _line(np.log(measure[drawn]), np.log(peaks[drawn]))
    return Order(len(peaks), int(overturned.sum()), _spearman(measure, peaks), int(drawn.sum()), slope, dispersion)


def _spearman(x: Array, y: Array) -> float:
    """Return Spearman's rank correlation, equal values sharing a mean rank; NaN for fewer than three, or all x or y equal."""
    if len(x) < LEAST_RUNS:
        return math.nan
    of_x, of_y = _ranks(x), _ranks(y)
    of_x, of_y = of_x - of_x.mean(), of_y - of_y.mean()
    size = math.sqrt(float(of_x @ of_x) * float(of_y @ of_y))
    return float(of_x @ of_y) / size if size > 0 else math.nan


def _ranks(values: Array) -> Array:
    """Return ranks from 1, equal values sharing their mean rank: 1, 2.5, 2.5, 4."""
    _, places, counts = np.unique(values, return_inverse=True, return_counts=True)
    return np.asarray((np.cumsum(counts) - 0.5 * (counts - 1))[places], dtype=np.float64)


def _line(x: Array, y: Array) -> tuple[float, float]:
    """Return slope of the least-squares line and standard deviation about it (n − 2); NaN for fewer than three, or equal x."""
    if len(x) < LEAST_RUNS or np.ptp(x) == 0:
        return math.nan, math.nan
    slope, intercept = np.polyfit(x, y, 1)
    residual = y - intercept - slope * x
    return float(slope), math.sqrt(float(residual @ residual) / (len(x) - 2))


def orders(table: "pd.DataFrame", varied: Sequence[str]) -> "pd.DataFrame":
    """Return a row for each case, scale and measure of intensity.csv: keys, ``measure``, and the fields of :class:`Order`."""
    keys = ["case", *varied, "scale"]
    measures = measures_in(map(str, table))
    rows = []
    for key, group in table.groupby(keys, sort=False, dropna=False):
        theta, status = group["theta_max_over_alpha"].to_numpy(dtype=np.float64), group["status"].to_list()
        for name in measures:
            order = order_of(group[name].to_numpy(dtype=np.float64), theta, status)
            rows.append((*key, name, *order))
    return pd.DataFrame(rows, columns=[*keys, "measure", *Order._fields])
