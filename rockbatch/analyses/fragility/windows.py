"""Windows about the levels: the share of the scales there that exceed a limit, and the curve through these shares.

A first exceedance depends on how finely it is hunted for, as islands of exceedance may be narrower than any step. The share of a
window does not: an island counts with its width. The two are medians of different things (THEORY.md, Fragility).
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from rockbatch.analyses.fragility.bounds import NoCurve, Numbers
from rockbatch.analyses.fragility.ida import Looks
from rockbatch.analyses.fragility.limit_states import EXCEEDED, LEFT_OUT, UNDECIDED, WITHSTOOD
from rockbatch.analyses.fragility.lognormal import Capacities, Lognormal, fit

SAMPLES = 20
"""Runs of a record in a window, one in the middle of each of as many equal parts."""


class Windows(NamedTuple):
    """Shares of the scales within ``width`` of each level at which records exceed a limit.

    ``shares`` and ``records`` have, for each level, the mean of the shares of the records and their number: those with a decided
    run there, NaN and 0 if none has. ``undecided`` is the number of runs that are in no share. ``fitted`` is the curve, or why
    there is none.
    """

    width: float
    shares: tuple[float, ...]
    records: tuple[int, ...]
    undecided: tuple[int, ...]
    fitted: Lognormal | NoCurve

    def above(self, other: object) -> float | None:
        """Return the relative difference of the median from that of the ``other`` curve; None without both."""
        if isinstance(self.fitted, Lognormal) and isinstance(other, Lognormal):
            return self.fitted.median / other.median - 1.0
        return None


def samples(level: float, width: float | None) -> list[float]:
    """Return SAMPLES, 20, intensities, the middles of equal parts of level (1 ± width); [] without a ``width``."""
    if width is None:
        return []
    return [level * (1.0 + width * ((2 * i + 1) / SAMPLES - 1.0)) for i in range(SAMPLES)]


def windows(
    looks: Sequence[Looks], levels: Sequence[float], width: float, station: Numbers, confidence: float
) -> Windows:
    """Return the shares of the windows of all ``levels`` by the states of every record, and the curve through them.

    The likelihood is the binomial one of stripes, in which a record counts with its share as beyond the limit and with the
    remainder as within it.
    """
    states = np.array(
        [[[of_record.get(x, LEFT_OUT) for x in samples(level, width)] for level in levels] for of_record in looks]
    )
    exceeded, withstood, undecided = ((states == state).sum(axis=2) for state in (EXCEEDED, WITHSTOOD, UNDECIDED))
    decided = exceeded + withstood
    beyond, within = (number / np.maximum(decided, 1) for number in (exceeded, withstood))
    records = (decided > 0).sum(axis=0)
    fitted = fit(Capacities.of_same_records(np.array(levels), within, beyond, station), confidence)
    shares = np.where(records > 0, beyond.sum(axis=0) / np.maximum(records, 1), np.nan)
    left = undecided.sum(axis=0)
    return Windows(width, tuple(shares.tolist()), tuple(records.tolist()), tuple(left.tolist()), fitted)
