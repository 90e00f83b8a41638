"""Incremental dynamic analysis: the least intensity at which a limit is exceeded (Vamvatsikos & Cornell 2002).

The hunt goes from the lowest level up: the capacity lies between the first look at which the limit is exceeded and the one
before, and is bisected there, geometrically. A rocking pier may overturn at one level and stand at a higher one (Zhang & Makris
2001), in windows of a percent and less. Where runs are cheap the hunt therefore goes on between the levels, in small steps;
elsewhere it is the levels alone, and a window between two of them is missed. ``widest_step`` says how far apart two neighbouring
looks are at most, ``returns`` how many levels above the first exceedance were withstood.

An undecided run ends no hunt, and says nothing: the capacity is the first exceedance of those that are decided. As it may be
the first exceedance itself, or none, both are followed up too, each to its own bracket.
"""

import math
from collections.abc import Callable, Hashable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple, TypeVar

from rockbatch.analysis.limit_states import EXCEEDED, LEFT_OUT, UNDECIDED, WITHSTOOD

K = TypeVar("K", bound=Hashable)

Looks = Mapping[float, int]
"""What a record came to, by the intensities at which it was looked at."""


class Bracket(NamedTuple):
    """A capacity is above ``low`` and at most ``high``: 0 where no lower look withstood, infinite where none exceeded."""

    low: float
    high: float

    @property
    def middle(self) -> float:
        """Where to look next."""
        return math.sqrt(self.low * self.high)

    def is_wider(self, tolerance: float) -> bool:
        """Whether a bisection can narrow it, and should, to a relative width of ``tolerance``."""
        return self.low > 0 and math.isfinite(self.high) and self.high > self.low * (1.0 + tolerance)


@dataclass(frozen=True)
class Capacity:
    """What the looks at a record say about the intensity at which it first exceeds a limit.

    ``decided`` leaves the undecided looks out, and stays open where one is in between; the others hold if all of them
    exceeded the limit, and if all withstood it. The three are the same where none is undecided below the first
    exceedance. ``undecided`` is the number of those below it, ``returns`` of the levels above it that were withstood.
    ``widest_step`` is the greatest relative step from one look to the next, from the lowest to the first exceedance.
    """

    decided: Bracket
    if_exceeded: Bracket
    if_withstood: Bracket
    undecided: int
    returns: int
    widest_step: float


def capacity(looks: Looks, levels: Sequence[float]) -> Capacity | None:
    """First exceedance from below; None where every look is left out."""
    seen = sorted((x, state) for x, state in looks.items() if state != LEFT_OUT)
    if not seen:
        return None
    high = min((x for x, state in seen if state == EXCEEDED), default=math.inf)
    below = [(x, state) for x, state in seen if x < high]
    doubtful = [x for x, state in below if state == UNDECIDED]
    first = min(doubtful, default=high)
    withstood = [x for x, state in below if state == WITHSTOOD]
    decided = Bracket(max(withstood, default=0.0), high)
    if_exceeded = Bracket(max((x for x in withstood if x < first), default=0.0), first)
    if_withstood = Bracket(max((x for x, _ in below), default=0.0), high)
    returns = sum(state == WITHSTOOD and x > high and x in levels for x, state in seen)
    widest = max((above / x - 1.0 for x, above in pairwise(x for x, _ in seen if x <= high)), default=0.0)
    return Capacity(decided, if_exceeded, if_withstood, len(doubtful), returns, widest)


Look = Callable[[list[tuple[K, float]]], Sequence[int]]
"""The states of records at the intensities that are asked for."""


def hunt(
    on_levels: Mapping[K, Looks], levels: Sequence[float], step_of: Callable[[K], float | None], look: Look[K]
) -> dict[K, dict[float, int]]:
    """More looks at each record below its first exceedance on the levels, in relative steps of ``step_of`` at most.

    They come in one wave; records whose step is None keep the levels alone.
    """
    found = {key: dict(looks) for key, looks in on_levels.items()}
    wanted = []
    for key, looks in found.items():
        step, first = step_of(key), capacity(looks, levels)
        if step is not None and first is not None:
            wanted += [(key, x) for x in _between(levels, step) if x < first.decided.high]
    _take(found, wanted, look)
    return found


def _between(levels: Sequence[float], step: float) -> list[float]:
    """Intensities between neighbouring levels, in even relative steps of ``step`` at most."""
    found = []
    for low, high in pairwise(levels):
        parts = math.ceil(math.log(high / low) / math.log1p(step) - 1e-9)
        found += [low * (high / low) ** (i / parts) for i in range(1, parts)]
    return found


def _take(found: Mapping[K, dict[float, int]], wanted: list[tuple[K, float]], look: Look[K]) -> None:
    """Add to ``found`` the looks that are wanted; nothing is left out there, a run that would be is undecided."""
    for (key, x), state in zip(wanted, look(wanted) if wanted else (), strict=True):
        found[key][x] = UNDECIDED if state == LEFT_OUT else state


def bisect(
    on_levels: Mapping[K, Looks],
    levels: Sequence[float],
    tolerance: float,
    look: Look[K],
) -> dict[K, dict[float, int]]:
    """More looks at each record, until its brackets are narrowed to a relative width of ``tolerance``.

    They come in waves, one look for every bracket that is wider.
    """
    found = {key: dict(looks) for key, looks in on_levels.items()}
    while wanted := [(key, x) for key, looks in found.items() for x in _middles(capacity(looks, levels), tolerance)]:
        _take(found, wanted, look)
    return found


def _middles(one: Capacity | None, tolerance: float) -> list[float]:
    if one is None:
        return []
    return list(dict.fromkeys(each.middle for each in (one.if_exceeded, one.if_withstood) if each.is_wider(tolerance)))
