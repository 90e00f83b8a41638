"""Statistics over a suite of records.

Every statistic grows with each of its values as long as they are finite, so that it maps bounds to bounds; one that does not has
an ``interval``. Statistics of codes follow common descriptions of the clauses, whose text could not be checked: ``unchecked``
has their sources.
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
    """Return the quantile of ``values``, shape (n,), linear between ranks; infinite if a rank it needs is, NaN for n = 0."""
    return float(quantiles(np.sort(values), np.array([0]), np.array([len(values)]), q)[0])


def quantiles(ordered: Values, first: npt.NDArray[np.int64], n: npt.NDArray[np.int64], q: float) -> Values:
    """Return the quantile of each group ``ordered[first : first + n]`` of ascending values; NaN for an empty group.

    It is linear between ranks, and infinite if a rank that it needs is.
    """
    of_groups = np.full(len(n), math.nan)
    filled = n > 0
    last = n[filled] - 1
    below = np.floor(q * last).astype(np.int64)
    share = q * last - below
    low, high = ordered[first[filled] + below], ordered[first[filled] + np.minimum(below + 1, last)]
    between = share >= 1e-9  # a smaller share is rounding: the next rank, perhaps infinite, has no part
    with np.errstate(invalid="ignore"):
        of_groups[filled] = np.where(between, np.where(np.isinf(high), math.inf, low + share * (high - low)), low)
    return of_groups


P84, CONFIDENCE = 0.84, 0.95
"""The high quantile of checks, and the confidence of its bound by few records."""

FRACTILES_FROM = 6
"""Number of records from which the 16 and 84 % quantiles are stated: of fewer, more than a quarter of further ones are beyond."""


def exceedance(q: float, n: int) -> float:
    """Return the expected share of further records that exceed the quantile ``q``, interpolated between the ranks of ``n``.

    1 − (q (n − 1) + 1)/(n + 1): its rank is q (n − 1) + 1, and k/(n + 1) of all values are expected below the k-th
    (Gumbel 1958).
    """
    return 1.0 - (q * (n - 1) + 1.0) / (n + 1)


def tolerance_rank(n: int) -> int | None:
    """Return the least rank, from 1, whose value among ``n`` bounds the 84 % quantile with 95 % confidence, for any
    distribution; None if not even the greatest value does.

    The k-th is below the quantile if k or more values are: P(X_(k) ≥ x_q) = P(Bin(n, 0.84) < k) (Wilks 1941).
    """
    below = 0.0
    for k in range(1, n + 1):
        below += math.comb(n, k - 1) * P84 ** (k - 1) * (1.0 - P84) ** (n - k + 1)
        if below >= CONFIDENCE:
            return k
    return None


def _between_ranks(n: int) -> str:
    """Return "by interpolation between the ranks of 7, which 24 % of further records exceed", for ``n`` records."""
    return (
        f"by interpolation between the ranks of {n}, which {100.0 * exceedance(P84, n):.0f} % of further records exceed"
    )


def _p84_95(values: Values) -> float:
    """Return the value at :func:`tolerance_rank`, or the greatest if there are too few for a rank."""
    rank = tolerance_rank(len(values))
    return float(np.sort(values)[(rank or len(values)) - 1])


def _p84_95_remark(values: Values) -> str:
    """Return the rank that bounds the quantile: "rank 18 of 18"; empty if there are too few for a rank."""
    rank = tolerance_rank(len(values))
    return f"rank {rank} of {len(values)}" if rank else ""


def _lognormal(values: Values) -> float:
    """Return exp(m + z s), with mean m and sample deviation s of the logarithms, z of 84 %; infinite if a value is.

    NaN for a single value, and if one is 0.
    """
    if np.isinf(values).any():
        return math.inf
    if len(values) < 2 or (values <= 0.0).any():
        return math.nan
    from scipy.special import ndtri

    logs = np.log(values)
    return math.exp(float(logs.mean()) + float(ndtri(P84)) * float(logs.std(ddof=1)))


def _lognormal_interval(value: Values, low: Values, high: Values) -> tuple[float, float]:
    """Return the 95 % interval of the lognormal quantile, for all values between ``low`` and ``high``.

    (m + z σ − x̄)/s √n has a non-central t distribution of ν = n − 1 and δ = z √n. The standard deviation of values that
    change by d changes by no more than |d|/√(n − 1). Both ends are infinite if a ``low`` is; 0 and infinity for a single
    value, a ``low`` of 0, or an infinite ``high``.
    """
    n = len(value)
    if np.isinf(low).any():
        return math.inf, math.inf
    if n < 2 or (low <= 0.0).any() or np.isinf(high).any():
        return 0.0, math.inf
    from scipy.special import nctdtrit, ndtri

    logs, lows, highs = (np.log(values) for values in (value, low, high))
    noncentral = float(ndtri(P84)) * math.sqrt(n)
    ends = [float(nctdtrit(n - 1, noncentral, p)) / math.sqrt(n) for p in (0.5 - CONFIDENCE / 2, 0.5 + CONFIDENCE / 2)]
    change = float(np.linalg.norm(np.maximum(highs - logs, logs - lows))) / math.sqrt(n - 1)
    spreads = [max(float(logs.std(ddof=1)) + sign * change, 0.0) for sign in (-1.0, 1.0)]
    return (
        math.exp(float(lows.mean()) + min(ends[0] * spread for spread in spreads)),
        math.exp(float(highs.mean()) + max(ends[1] * spread for spread in spreads)),
    )


def _lognormal_remark(values: Values) -> str:
    """Return the remark that the 95 % interval decides, or that a value of 0 has no lognormal distribution."""
    if (values <= 0.0).any():
        return "a record demands nothing, which no lognormal distribution has"
    return "its 95 % interval decides, as if the records were of a lognormal distribution"


def _mean(values: Values) -> float:
    return float(values.mean())


def _max(values: Values) -> float:
    return float(values.max())


def _asce7_16(values: Values) -> float:
    """Return the mean by ASCE 7-16; infinite values are unacceptable responses, of which two or more give infinity.

    One alone gives 120 % of the median of all values, or the mean of the others if that is greater; infinity without others.
    """
    acceptable = values[np.isfinite(values)]
    if len(acceptable) == len(values):
        return _mean(values)
    if len(values) - len(acceptable) > 1 or len(acceptable) == 0:
        return math.inf
    return max(1.2 * quantile(values, 0.5), _mean(acceptable))


def _asce7_16_remark(values: Values) -> str:
    """Return the number of unacceptable responses and its consequence, in words; empty for 0."""
    n = int(np.isinf(values).sum())
    if n == 1:
        return (
            "1 unacceptable response, which Risk Categories I and II alone may have: 120 % of the median, or the mean of the "
            "others if greater"
        )
    return f"{n} unacceptable responses: more than 1" if n else ""


def _mean_or_worst(values: Values) -> float:
    """Return the mean of :data:`MEAN_FROM` values or more, the greatest of fewer."""
    return _mean(values) if len(values) >= MEAN_FROM else _max(values)


def _mean_or_worst_remark(values: Values) -> str:
    """Return the remark that the greatest of few values counts; empty if the mean does."""
    return "" if len(values) >= MEAN_FROM else f"the most unfavourable of fewer than {MEAN_FROM} records"


@dataclass(frozen=True)
class Statistic:
    """A function of the values of all records, shape (n,), at least one of them."""

    words: str  # name in a sentence: "mean of …"
    # of finite or infinite values; ``None`` for the count of those above a threshold, which the rule gives
    evaluate: Callable[[Values], float] | None
    least: int = 1  # number of records below which no check passes
    code: str = ""  # the code that prescribes it; empty for a plain statistic
    unchecked: str = ""  # sources of a code's statistic, and texts that could not be checked
    remark: Callable[[Values], str] | None = None  # of the values: a remark on how they were evaluated, or ""
    # of the values and of their bounds: the bounds of the statistic, where those are not the statistics of the bounds
    interval: Callable[[Values, Values, Values], tuple[float, float]] | None = None
    # of the number of records: what share of further ones exceeds the value, in words, without which a check that passes by it
    # would promise more than it holds
    coverage: Callable[[int], str] | None = None
    # whether its code says how many records may respond unacceptably, by overturning, flight or failure: these are infinite
    counts_unacceptable: bool = False


STATISTICS = {
    "max": Statistic("maximum", _max),
    "mean": Statistic("mean", _mean),
    "median": Statistic("median", lambda values: quantile(values, 0.5)),
    "p84": Statistic(
        "84 % quantile",
        lambda values: quantile(values, P84),
        FRACTILES_FROM,
        remark=lambda values: _between_ranks(len(values)),
        coverage=_between_ranks,
    ),
    "p84_95": Statistic("84 % quantile with 95 % confidence", _p84_95, 18, remark=_p84_95_remark),
    "p84_lognormal": Statistic(
        "84 % quantile of a lognormal distribution",
        _lognormal,
        3,
        remark=_lognormal_remark,
        interval=_lognormal_interval,
    ),
    "count": Statistic("number of records", None),
    "asce7-16": Statistic(
        "mean by ASCE 7-16",
        _asce7_16,
        11,
        "ASCE 7-16",
        "eleven motions, their mean, and one unacceptable response at most, as Hamburger (2014) presented the proposed chapter "
        "16, and 120 % of the median in its place, as a public program has 16.4 of ASCE 7-22; the clauses' own text (look into "
        "16.2.2 and 16.4.1.1) could not be checked. The suite has to be of MCE_R, and motions matched to a spectrum may have no "
        "unacceptable response",
        _asce7_16_remark,
        counts_unacceptable=True,
    ),
    "en1998-1": Statistic(
        "design value by EN 1998-1",
        _mean_or_worst,
        3,
        "EN 1998-1",
        "at least three records, the mean from seven on, as two public programs have EN 1998-1:2004, 3.2.3.1.2 and "
        "4.3.3.4.3; the clauses' own text could not be checked",
        _mean_or_worst_remark,
    ),
    "en1998-2": Statistic(
        "design value by EN 1998-2",
        _mean_or_worst,
        3,
        "EN 1998-2",
        "at least three recordings, the mean from seven on, as Iervolino, Maddaloni & Cosenza (2009, Journal of Earthquake "
        "Engineering 13, 1125–1152) report of EN 1998-2; the standard's own text could not be checked. It takes pairs of "
        "horizontal components at once: a planar model takes the worse of them alone",
        _mean_or_worst_remark,
    ),
    "aashto": Statistic(
        "design value by AASHTO",
        _mean_or_worst,
        3,
        "AASHTO",
        "the maximum of three to six records, the mean from seven on, as AASHTO's specifications for bridges are commonly "
        "cited; neither their own text nor a report of it could be checked. They take all components at once: a planar model "
        "takes the worse horizontal one alone, with the vertical",
        _mean_or_worst_remark,
    ),
    "nzs1170.5": Statistic(
        "maximum by NZS 1170.5",
        _max,
        3,
        "NZS 1170.5",
        "the maximum of a family of at least three records, as NZS 1170.5 is commonly cited; neither the standard's own text "
        "nor a report of it could be checked, nor how it chooses and scales the family, which is left to the study",
    ),
}
"""Statistics by the name that a rule gives them.

p84
    Between ranks; nothing passes by fewer than 6, FRACTILES_FROM, as more than a quarter of further records exceed it.
p84_95
    The rank that is no less than the 84 % quantile with 95 % confidence; the greatest of 18, and of fewer none is.
p84_lognormal
    By mean and standard deviation of the logarithms, with its 95 % interval.
asce7-16
    Mean of at least 11 records. At most one of them may respond unacceptably (Risk Categories I and II only), and 120 % of the
    median then takes the place of the mean, but no less than the mean of the others.
en1998-1, en1998-2, aashto
    Mean of at least 7 records, the most unfavourable of fewer; at least 3.
nzs1170.5
    The most unfavourable of at least 3 records.
"""
