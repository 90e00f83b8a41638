"""Statistics over a suite of records.

Every statistic grows with each of its values as long as they are finite, so that it maps bounds to bounds. A code's own are by
what is commonly said of it: ``unchecked`` says what each rests on, as no clause's own text was at hand.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

Values = npt.NDArray[np.float64]

MEAN_FROM = 7
"""Number of records from which the mean counts in bridge codes and in EN 1998-1, and the greatest of fewer."""


def quantile(values: Values, q: float) -> float:
    """Return the quantile of ``values``, shape (n,), linear between ranks; infinite if a rank that it needs is infinite."""
    return float(quantiles(np.sort(values), np.array([0]), np.array([len(values)]), q)[0])


def quantiles(ordered: Values, first: npt.NDArray[np.int64], n: npt.NDArray[np.int64], q: float) -> Values:
    """Return a quantile of each of several groups, of ``n`` values each, in order, from ``first`` on; NaN for an empty one."""
    of_groups = np.full(len(n), math.nan)
    filled = n > 0
    last = n[filled] - 1
    below = np.floor(q * last).astype(np.int64)
    share = q * last - below
    low, high = ordered[first[filled] + below], ordered[first[filled] + np.minimum(below + 1, last)]
    between = share >= 1e-9  # else rounding, no reason to look at the next rank
    with np.errstate(invalid="ignore"):
        of_groups[filled] = np.where(between, np.where(np.isinf(high), math.inf, low + share * (high - low)), low)
    return of_groups


def _mean(values: Values) -> float:
    return float(values.mean())


def _max(values: Values) -> float:
    return float(values.max())


def _asce7_16(values: Values) -> float:
    """Return the mean by ASCE 7-16; infinite values are the unacceptable responses."""
    acceptable = values[np.isfinite(values)]
    if len(acceptable) == len(values):
        return _mean(values)
    if len(values) - len(acceptable) > 1 or len(acceptable) == 0:
        return math.inf
    return max(1.2 * quantile(values, 0.5), _mean(acceptable))


def _asce7_16_remark(values: Values) -> str:
    n = int(np.isinf(values).sum())
    if n == 1:
        return "1 unacceptable response: 120 % of the median, or the mean of the others if greater"
    return f"{n} unacceptable responses: more than 1" if n else ""


def _mean_or_worst(values: Values) -> float:
    return _mean(values) if len(values) >= MEAN_FROM else _max(values)


def _mean_or_worst_remark(values: Values) -> str:
    return "" if len(values) >= MEAN_FROM else f"the most unfavourable of fewer than {MEAN_FROM} records"


@dataclass(frozen=True)
class Statistic:
    """A function of the values of all records, shape (n,), at least one of them.

    Attributes
    ----------
    words : str
        What it is called in a sentence: "mean of …".
    evaluate : function
        Of finite or infinite values; ``None`` for the count of those above a threshold, which the rule gives.
    least : int
        Number of records below which nothing can pass.
    code : str
        The code whose own it is; empty for a plain statistic.
    unchecked : str
        Of a code's own: what it rests on, and what it was not held against.
    remark : function or None
        Of the values: what to know about the way taken, in words, or nothing.
    """

    words: str
    evaluate: Callable[[Values], float] | None
    least: int = 1
    code: str = ""
    unchecked: str = ""
    remark: Callable[[Values], str] | None = None


STATISTICS = {
    "max": Statistic("maximum", _max),
    "mean": Statistic("mean", _mean),
    "median": Statistic("median", lambda values: quantile(values, 0.5)),
    "p84": Statistic("84 % quantile", lambda values: quantile(values, 0.84)),
    "count": Statistic("number of records", None),
    "asce7-16": Statistic(
        "mean by ASCE 7-16", _asce7_16, 11, "ASCE 7-16",
        "eleven motions, their mean, and one unacceptable response at most, as Hamburger (2014) presented the proposed chapter "
        "16; neither the 120 % of the median nor the clauses' own text (look into 16.2.2 and 16.4.1.1) could be checked",
        _asce7_16_remark,
    ),
    "en1998-1": Statistic(
        "design value by EN 1998-1", _mean_or_worst, 3, "EN 1998-1",
        "at least three records, the mean from seven on, as EN 1998 is commonly cited; the clauses' own text (look into "
        "EN 1998-1:2004, 3.2.3.1.2 and 4.3.3.4.3) could not be checked",
        _mean_or_worst_remark,
    ),
    "en1998-2": Statistic(
        "design value by EN 1998-2", _mean_or_worst, 3, "EN 1998-2",
        "at least three recordings, the mean from seven on, as Iervolino, Maddaloni & Cosenza (2009, Journal of Earthquake "
        "Engineering 13, 1125–1152) report of EN 1998-2; the standard's own text could not be checked. It takes pairs of "
        "horizontal components at once: a planar model takes the worse of them alone",
        _mean_or_worst_remark,
    ),
    "aashto": Statistic(
        "design value by AASHTO", _mean_or_worst, 3, "AASHTO",
        "the maximum of three to six records, the mean from seven on, as AASHTO's specifications for bridges are commonly "
        "cited; neither their own text nor a report of it could be checked. They take all components at once: a planar model "
        "takes the worse horizontal one alone, with the vertical",
        _mean_or_worst_remark,
    ),
    "nzs1170.5": Statistic(
        "maximum by NZS 1170.5", _max, 3, "NZS 1170.5",
        "the maximum of a family of at least three records, as NZS 1170.5 is commonly cited; neither the standard's own text "
        "nor a report of it could be checked, nor how it chooses and scales the family, which is left to the study",
    ),
}  # fmt: skip
"""Statistics by the name that a rule gives them.

asce7-16
    Mean of at least 11 records. At most one of them may respond unacceptably (Risk Categories I and II only), and 120 % of the
    median then takes the place of the mean, but no less than the mean of the others.
en1998-1, en1998-2, aashto
    Mean of at least 7 records, the most unfavourable of fewer; at least 3.
nzs1170.5
    The most unfavourable of at least 3 records.
"""
