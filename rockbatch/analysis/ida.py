"""Incremental dynamic analysis: the least intensity at which a limit is exceeded (Vamvatsikos & Cornell 2002).

The levels of the study are the hunt: the capacity lies between the first level, from below, at which the limit is exceeded
and the one before, and is bisected there, geometrically. A rocking pier may overturn at one level and stand at a higher one
(Zhang & Makris 2001): a window of overturning that is narrower than the levels can be missed, and what is found is the first
exceedance on the stated levels. ``returns`` counts the levels above it that were withstood.
"""

import math
from collections.abc import Callable, Hashable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TypeVar

from rockbatch.analysis.limit_states import LEFT_OUT, UNDECIDED, WITHSTOOD

K = TypeVar("K", bound=Hashable)


@dataclass(frozen=True)
class Bracket:
    """A capacity is above ``low``, where the limit is withstood, and at most ``high``, where it is exceeded or undecided.

    ``low`` is 0 where the limit is exceeded at the lowest level, ``high`` infinite where it is withstood at the highest.
    ``undecided``: whether it is at ``high``. ``returns``: number of levels above ``high`` that were withstood.
    """

    low: float
    high: float
    undecided: bool = False
    returns: int = 0

    @property
    def middle(self) -> float:
        """Where to look next."""
        return math.sqrt(self.low * self.high)

    def is_wider(self, tolerance: float) -> bool:
        """Whether a bisection can narrow it, and should, to a relative width of ``tolerance``."""
        return self.low > 0 and math.isfinite(self.high) and self.high > self.low * (1.0 + tolerance)

    def narrowed(self, state: int) -> "Bracket":
        """After a look at the middle; one that tells nothing counts as exceeded, on the safe side."""
        if state == WITHSTOOD:
            return replace(self, low=self.middle)
        return replace(self, high=self.middle, undecided=state in (UNDECIDED, LEFT_OUT))


def bracket(levels: Sequence[float], states: Sequence[int]) -> Bracket | None:
    """First exceedance from below on rising levels; None where all of them are left out."""
    known = [(level, state) for level, state in zip(levels, states, strict=True) if state != LEFT_OUT]
    if not known:
        return None
    low = 0.0
    for i, (level, state) in enumerate(known):
        if state != WITHSTOOD:
            returns = sum(later == WITHSTOOD for _, later in known[i + 1 :])
            return Bracket(low, level, state == UNDECIDED, returns)
        low = level
    return Bracket(low, math.inf)


def bisect(
    brackets: Mapping[K, Bracket], tolerance: float, look: Callable[[dict[K, float]], Mapping[K, int]]
) -> dict[K, Bracket]:
    """All brackets narrowed to a relative width of ``tolerance``, in waves: one look for all that are wider.

    ``look`` gives the states at the intensities that it is asked about.
    """
    found = dict(brackets)
    while wider := {key: one.middle for key, one in found.items() if one.is_wider(tolerance)}:
        states = look(wider)
        found |= {key: found[key].narrowed(states[key]) for key in wider}
    return found
