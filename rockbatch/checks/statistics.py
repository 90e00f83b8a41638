"""What a suite of records comes to.

Every statistic grows with each of its values as long as they are finite, so that it maps bounds to bounds.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

Values = npt.NDArray[np.float64]

EN_MEAN = 7
"""Number of records from which EN 1998-1 takes the mean."""


def quantile(values: Values, q: float) -> float:
    """Quantile of ``values``, shape (n,), linear between ranks; infinite where a rank that it needs is infinite."""
    ordered = np.sort(values)
    place = q * (len(ordered) - 1)
    below = math.floor(place)
    share = place - below
    if share < 1e-9:  # rounding, no reason to look at the next rank
        return float(ordered[below])
    low, high = ordered[below : below + 2]
    return math.inf if math.isinf(high) else float(low + share * (high - low))


def _mean(values: Values) -> float:
    return float(values.mean())


def _asce7_16(values: Values) -> float:
    """Infinite values are the unacceptable responses."""
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


def _en1998_1(values: Values) -> float:
    return _mean(values) if len(values) >= EN_MEAN else float(values.max())


def _en1998_1_remark(values: Values) -> str:
    return "" if len(values) >= EN_MEAN else f"the most unfavourable of fewer than {EN_MEAN} records"


@dataclass(frozen=True)
class Statistic:
    """A function of the values of all records, shape (n,), at least one of them.

    Attributes
    ----------
    words : str
        What it is called in a sentence: "mean of …".
    of : function
        Of finite or infinite values; ``None`` for the count of those above a threshold, which the rule gives.
    least : int
        Number of records below which nothing can pass.
    source : str
        Clause that asks for this number.
    remark : function or None
        Of the values: what to know about the way taken, in words, or nothing.
    """

    words: str
    of: Callable[[Values], float] | None
    least: int = 1
    source: str = ""
    remark: Callable[[Values], str] | None = None


STATISTICS = {
    "max": Statistic("maximum", lambda values: float(values.max())),
    "mean": Statistic("mean", _mean),
    "median": Statistic("median", lambda values: quantile(values, 0.5)),
    "p84": Statistic("84 % quantile", lambda values: quantile(values, 0.84)),
    "count": Statistic("number of records", None),
    "asce7-16": Statistic("mean by ASCE 7-16", _asce7_16, 11, "ASCE 7-16, 16.2.2", _asce7_16_remark),
    "en1998-1": Statistic("design value by EN 1998-1", _en1998_1, 3, "EN 1998-1, 3.2.3.1.2(4)", _en1998_1_remark),
}
"""Statistics by the name that a rule gives them.

asce7-16
    ASCE 7-16, ch. 16: mean of at least 11 records. At most one of them may respond unacceptably (Risk Categories I and II
    only), and 120 % of the median then takes the place of the mean, but no less than the mean of the others (16.4.1.1).
en1998-1
    EN 1998-1:2004, 4.3.3.4.3(3): mean of at least 7 records, the most unfavourable of fewer.
"""
