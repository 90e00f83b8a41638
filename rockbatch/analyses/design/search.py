"""Search along one key: which values to try next, and the intervals of equal verdicts."""

from collections.abc import Mapping
from itertools import groupby, pairwise
from typing import NamedTuple

from rockbatch.analyses.design.study import rounded
from rockbatch.checks.verdicts import FAIL, NOT_DECIDED, PASS

REFUSED = "refused"
"""Verdict on a value with which the study is refused."""
WORSE = (PASS, NOT_DECIDED, FAIL, REFUSED)
"""Verdicts on a value, each worse than the one before it."""

Verdicts = Mapping[float, str]
"""Verdicts on the values that were tried."""


def middles(verdicts: Verdicts, width: float) -> list[float]:
    """Return the middles of neighbouring values with different verdicts that are further apart than ``width``."""
    return [
        rounded(0.5 * (low + high))
        for low, high in pairwise(sorted(verdicts))
        if verdicts[low] != verdicts[high] and high - low > width
    ]


class Interval(NamedTuple):
    """Neighbouring values with one verdict."""

    verdict: str
    # the least and the greatest of them
    low: float
    high: float
    # neighbours with other verdicts; None where the scan ends
    below: float | None
    above: float | None
    values: int  # number of values that were tried in it
    widest: float  # greatest distance of two neighbours in it, between which nothing was tried


def intervals(verdicts: Verdicts) -> list[Interval]:
    """Return the intervals of equal verdicts in rising order, with the values beside them, None at an end of the scan."""
    every = sorted(verdicts)
    runs = [[*values] for _, values in groupby(every, key=lambda value: verdicts[value])]
    result = []
    for place, values in enumerate(runs):
        below = runs[place - 1][-1] if place else None
        above = runs[place + 1][0] if place + 1 < len(runs) else None
        widest = max((high - low for low, high in pairwise(values)), default=0.0)
        result.append(Interval(verdicts[values[0]], values[0], values[-1], below, above, len(values), widest))
    return result
