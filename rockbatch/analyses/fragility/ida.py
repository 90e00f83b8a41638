"""Incremental dynamic analysis: the least intensity at which a limit is exceeded (Vamvatsikos & Cornell 2002).

The hunt goes from the lowest level up: the capacity lies between the first intensity at which the limit is exceeded and the one
before, and is bisected there, geometrically. A rocking pier may overturn at one level and stand at a higher one (Zhang & Makris
2001): exceedance has islands, a percent wide and less. Where runs are cheap the hunt therefore goes on between the levels, in
small steps; elsewhere it uses the levels alone, and an island between two of them is missed. ``widest_step`` is the greatest step
between two neighbouring runs, the width below which an island may have been missed; ``returns`` is the number of levels above
the first exceedance that were withstood.

An undecided run ends no hunt: the capacity is the first exceedance of those that are decided. As it may be the first exceedance
itself, or none, both are followed up too, each to its own bracket.
"""

import math
from collections.abc import Callable, Hashable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple, TypeVar

from rockbatch.analyses.fragility.limit_states import EXCEEDED, LEFT_OUT, UNDECIDED, WITHSTOOD

K = TypeVar("K", bound=Hashable)

Looks = Mapping[float, int]
"""States of a record, by the intensities at which it was run."""


class Bracket(NamedTuple):
    """Bounds of a capacity, above ``low`` and at most ``high``: 0 if no lower run withstood, infinite if none exceeded."""

    low: float
    high: float

    @property
    def middle(self) -> float:
        """Return the geometric mean of both ends, the intensity to run next."""
        return math.sqrt(self.low * self.high)

    def is_wider(self, tolerance: float) -> bool:
        """Return whether the bracket can be bisected and is wider than ``tolerance``, relative to its lower end."""
        return self.low > 0 and math.isfinite(self.high) and self.high > self.low * (1.0 + tolerance)


@dataclass(frozen=True)
class Capacity:
    """Bounds of the intensity at which a record first exceeds a limit.

    ``decided`` ignores undecided runs, and stays open if one lies within it; the two others count all of them as exceeding and
    as withstanding the limit. All three are equal if no run below the first exceedance is undecided. ``undecided`` is the
    number of those below it, ``returns`` that of levels above it that were withstood, and ``widest_step`` the greatest relative
    step between neighbouring runs from the lowest to the first exceedance.
    """

    decided: Bracket
    if_exceeded: Bracket
    if_withstood: Bracket
    undecided: int
    returns: int
    widest_step: float


def capacity(looks: Looks, levels: Sequence[float]) -> Capacity | None:
    """Return the bounds of the first exceedance from the lowest to the highest level with a run; None if all are left out."""
    used = [x for x in levels if x in looks]
    states = sorted((x, state) for x, state in looks.items() if used[0] <= x <= used[-1] and state != LEFT_OUT)
    if not states:
        return None
    high = min((x for x, state in states if state == EXCEEDED), default=math.inf)
    below = [(x, state) for x, state in states if x < high]
    doubtful = [x for x, state in below if state == UNDECIDED]
    first = min(doubtful, default=high)
    withstood = [x for x, state in below if state == WITHSTOOD]
    decided = Bracket(max(withstood, default=0.0), high)
    if_exceeded = Bracket(max((x for x in withstood if x < first), default=0.0), first)
    if_withstood = Bracket(max((x for x, _ in below), default=0.0), high)
    returns = sum(state == WITHSTOOD and x > high and x in levels for x, state in states)
    widest = max((above / x - 1.0 for x, above in pairwise(x for x, _ in states if x <= high)), default=0.0)
    return Capacity(decided, if_exceeded, if_withstood, len(doubtful), returns, widest)


Look = Callable[[list[tuple[K, float]]], Sequence[int]]
"""From records and intensities to the states there."""


def hunt(
    on_levels: Mapping[K, Looks], levels: Sequence[float], step_of: Callable[[K], float | None], states_of: Look[K]
) -> dict[K, dict[float, int]]:
    """Return the states ``on_levels``, and those between the levels up to each record's first exceedance so far.

    The relative steps are those of ``step_of`` at most; where it is None nothing is added. All runs come in one wave; one that
    is left out counts as undecided.
    """
    states = {key: dict(looks) for key, looks in on_levels.items()}
    requested = []
    for key, looks in states.items():
        step, first = step_of(key), capacity(looks, levels)
        if step is not None and first is not None:
            used = [x for x in levels if x in looks]
            requested += [(key, x) for x in _between(levels, step) if used[0] < x < min(used[-1], first.decided.high)]
    _add_states(states, requested, states_of)
    return states


def _between(levels: Sequence[float], step: float) -> list[float]:
    """Return intensities between neighbouring levels, without these, in even relative steps of ``step`` at most."""
    intensities = []
    for low, high in pairwise(levels):
        parts = math.ceil(math.log(high / low) / math.log1p(step) - 1e-9)
        intensities += [low * (high / low) ** (i / parts) for i in range(1, parts)]
    return intensities


def _add_states(states: Mapping[K, dict[float, int]], requested: list[tuple[K, float]], states_of: Look[K]) -> None:
    """Add the ``requested`` states to ``states``; a run that would be left out counts as undecided."""
    for (key, x), state in zip(requested, states_of(requested) if requested else (), strict=True):
        states[key][x] = UNDECIDED if state == LEFT_OUT else state


def bisect(
    on_levels: Mapping[K, Looks],
    levels: Sequence[float],
    tolerance: float,
    states_of: Look[K],
) -> dict[K, dict[float, int]]:
    """Return the states of each record by intensity: those ``on_levels``, and those that bisect its first exceedance.

    It has two brackets, with undecided runs counted as exceeding and as withstanding the limit. Each is cut at its geometric
    mean until high ≤ (1 + tolerance) low; a bracket from 0 or to infinity stays. A wave has one run for every bracket that is
    still wider.
    """
    states = {key: dict(looks) for key, looks in on_levels.items()}
    while new := [(key, x) for key, looks in states.items() for x in _middles(capacity(looks, levels), tolerance)]:
        _add_states(states, new, states_of)
    return states


def _middles(cap: Capacity | None, tolerance: float) -> list[float]:
    if cap is None:
        return []
    return list(dict.fromkeys(b.middle for b in (cap.if_exceeded, cap.if_withstood) if b.is_wider(tolerance)))
