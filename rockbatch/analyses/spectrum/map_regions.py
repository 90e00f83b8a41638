"""Regions of overturning maps over the frequency and amplitude of a pulse, as they were computed.

Straight lines join the boundaries of neighbouring columns with the same outcomes in the same order. Where these differ each
column reaches halfway to the next: a boundary that both have continues, and at the others the picture has a step.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from rockbatch.common.figures.description import Array
from rockbatch.common.lazy import pd

SAFE, FLIGHT, UNDECIDED = "safe", "flight", "undecided"
WITH_IMPACT, OUTRIGHT = OVERTURNED = ("overturned with impact", "overturned without impact")
"""Ends of a run, those by overturning together; undecided is one that did not converge, e.g. near a boundary."""

Outline = tuple[Array, Array]
"""Frequencies and amplitudes of a line."""


@dataclass(frozen=True, eq=False)
class Strip:
    """Neighbouring columns with the same outcomes, from the lowest amplitude to the highest.

    ``frequencies``, shape (n,), are those of the columns and of both ends; ``edges``, shape (n, outcomes + 1), are the amplitudes
    that bound each outcome there, joined by straight lines.
    """

    outcomes: tuple[str, ...]
    frequencies: Array
    edges: Array

    def outcome(self, frequency: float, amplitude: float) -> str:
        """Return the outcome at a point of the strip; on a boundary the one below it."""
        tops = [float(np.interp(frequency, self.frequencies, top)) for top in self.edges.T[1:-1]]
        return self.outcomes[int(np.searchsorted(tops, amplitude))]


def strips(regions: "pd.DataFrame") -> list[Strip]:
    """Return the strips of one map, rows of overturning_map.csv, by frequency, without gaps or overlaps."""
    columns: list[Strip] = []
    for frequency, rows in regions.groupby("omega_p_over_p"):
        edges = np.append(rows["low"].to_numpy(float), float(rows["high"].iloc[-1]))
        columns.append(Strip(tuple(rows["outcome"]), np.array([float(str(frequency))]), edges[None]))
    joined = columns[:1]
    for column in columns[1:]:
        previous = joined.pop()
        if column.outcomes != previous.outcomes:
            middle = 0.5 * (previous.frequencies[-1:] + column.frequencies)
            at_end, at_start = _meeting(previous, column)
            joined.append(_joined(previous, Strip(previous.outcomes, middle, at_end[None])))
            previous = Strip(column.outcomes, middle, at_start[None])
        joined.append(_joined(previous, column))
    return joined


def _joined(left: Strip, right: Strip) -> Strip:
    return Strip(
        left.outcomes,
        np.concatenate((left.frequencies, right.frequencies)),
        np.concatenate((left.edges, right.edges)),
    )


def _meeting(left: Strip, right: Strip) -> tuple[Array, Array]:
    """Return the edges of two strips with other outcomes halfway between the last column and the first.

    A boundary continues if it and its counterpart between the same two outcomes are each other's nearest.
    Others stay, unless they have to give way to those.
    """
    ends = left.edges[-1], right.edges[0]
    through: list[tuple[int, int]] = [(0, 0)]
    for i in range(1, len(left.outcomes)):
        j = _nearest(ends[0][i], _kind(left, i), right, ends[1])
        if j > through[-1][1] and _nearest(ends[1][j], _kind(right, j), left, ends[0]) == i:
            through.append((i, j))
    through.append((-1, -1))
    middles = [0.5 * (ends[0][i] + ends[1][j]) for i, j in through]
    at_end, at_start = (
        _giving_way(end, list(places), middles) for end, places in zip(ends, zip(*through, strict=True), strict=True)
    )
    return at_end, at_start


def _giving_way(edges: Array, places: list[int], heights: list[float]) -> Array:
    """Return edges, those at ``places`` moved to ``heights`` and the others kept between them."""
    low, high = np.full(len(edges), -np.inf), np.full(len(edges), np.inf)
    low[places] = high[places] = heights
    return np.clip(edges, np.maximum.accumulate(low), np.minimum.accumulate(high[::-1])[::-1])


def _kind(strip: Strip, edge: int) -> tuple[str, ...]:
    """Return the outcomes below and above an edge."""
    return strip.outcomes[edge - 1 : edge + 1]


def _nearest(height: float, kind: tuple[str, ...], strip: Strip, edges: Array) -> int:
    """Return the index of the edge of another ``strip`` that has the outcomes ``kind`` and is nearest in height; 0 for none."""
    candidates = [i for i in range(1, len(strip.outcomes)) if _kind(strip, i) == kind]
    return min(candidates, key=lambda i: abs(edges[i] - height), default=0)


def areas(drawn: Sequence[Strip], outcome: str) -> Iterator[Outline]:
    """Yield the outlines of all regions with an outcome."""
    for strip in drawn:
        x = np.concatenate((strip.frequencies, strip.frequencies[::-1]))
        for place, region in enumerate(strip.outcomes):
            if region == outcome:
                yield x, np.concatenate((strip.edges[:, place], strip.edges[::-1, place + 1]))


def inside(drawn: Sequence[Strip]) -> Iterator[Outline]:
    """Return the boundaries along each strip."""
    return ((strip.frequencies, edge) for strip in drawn for edge in strip.edges.T[1:-1])


def between(drawn: Sequence[Strip]) -> Iterator[Outline]:
    """Yield the lines at which the outcome changes from a strip to the next."""
    for left, right in pairwise(drawn):
        x = left.frequencies[-1]
        heights = np.union1d(left.edges[-1], right.edges[0])
        for low, high in pairwise(heights):
            middle = 0.5 * (low + high)
            if left.outcome(x, middle) != right.outcome(x, middle):
                yield np.array([x, x]), np.array([low, high])
