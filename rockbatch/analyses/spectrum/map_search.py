"""Search of an overturning map: choice of frequencies and amplitudes to run, and the resulting regions.

A map is a row of columns, one at each frequency. Along a column every change of the outcome is bisected. Between two columns the
regions can be joined only where both have the same outcomes in the same order, and where straight lines between
their boundaries follow them: elsewhere there is another column in the middle, down to a stated width.
"""

from collections.abc import Callable, Iterable, Sequence
from itertools import groupby, pairwise
from typing import NamedTuple

Point = tuple[int, float, float]
"""Number of a map, frequency, amplitude."""


class End(NamedTuple):
    """End of a run: the region to which it belongs, and the way there.

    Between two ways to the same region there is a change, too, which may hide a narrow region: the search keeps them apart.
    """

    outcome: str
    way: int = 0


Points = list[tuple[float, End]]
"""Amplitudes of a column, in order, with their ends."""

Ends = Callable[[Sequence[Point]], Iterable[End]]
"""From many points at once to their ends; that of one must not depend on the others."""


class Region(NamedTuple):
    """Amplitudes with one outcome, and the errors of both ends; NaN where the map ends."""

    outcome: str
    low: float
    high: float
    low_error: float
    high_error: float


def regions(points: Sequence[tuple[float, End]], tolerance: float = 0.0) -> list[Region]:
    """Return neighbours with one outcome as regions; a boundary lies in the middle between two that differ.

    A region no wider than ``tolerance`` is left out, and the error of the boundary in its place spans it; if all are so narrow,
    all stay.
    """
    unmerged = _regions(points, points)
    narrow = [region for region in unmerged if region.high - region.low <= tolerance]
    if not narrow or len(narrow) == len(unmerged):
        return unmerged
    resolved = [point for point in points if not any(region.low <= point[0] <= region.high for region in narrow)]
    return _regions(resolved, points)


def _regions(points: Sequence[tuple[float, End]], whole: Sequence[tuple[float, End]]) -> list[Region]:
    runs = [
        (outcome, [amplitude for amplitude, _ in same]) for outcome, same in groupby(points, key=lambda p: p[1].outcome)
    ]
    inner = [(0.5 * (low[-1] + high[0]), 0.5 * (high[0] - low[-1])) for (_, low), (_, high) in pairwise(runs)]
    nan = float("nan")
    ends = [(whole[0][0], nan), *inner, (whole[-1][0], nan)]
    found = []
    for (outcome, _), ((low, low_error), (high, high_error)) in zip(runs, pairwise(ends), strict=True):
        found.append(Region(outcome, low, high, low_error, high_error))
    return found


class Search:
    """Search for the regions of one map, or of several of the same ranges side by side.

    ``amplitudes`` are those of the grid, run in every column; every boundary is found, and followed by straight lines, to a
    ``tolerance`` on the amplitude. Columns nearer to each other than ``width``, in frequency, get none between them.
    """

    def __init__(self, ends: Ends, amplitudes: Sequence[float], tolerance: float, width: float) -> None:
        self.ends, self.amplitudes, self.tolerance, self.width = ends, amplitudes, tolerance, width
        self._ends: dict[tuple[int, float], dict[float, End]] = {}
        self._regions: dict[tuple[int, float], list[Region]] = {}

    def find(self, maps: int, frequencies: Sequence[float]) -> list[dict[float, Points]]:
        """Return the columns of each map by their frequencies, which are rising; those of the grid are among them."""
        columns = [list(frequencies) for _ in range(maps)]
        new = [(number, frequency) for number in range(maps) for frequency in frequencies]
        while new:
            self._run([(*column, amplitude) for column in new for amplitude in self.amplitudes])
            while suggested := [point for number, fs in enumerate(columns) for point in self._suggested(number, fs)]:
                self._run(suggested)
            new = [(number, middle) for number, fs in enumerate(columns) for middle in self._middles(number, fs)]
            for number, middle in new:
                columns[number].append(middle)
            for fs in columns:
                fs.sort()
        return [{f: sorted(self._ends[number, f].items()) for f in fs} for number, fs in enumerate(columns)]

    def _run(self, points: Sequence[Point]) -> None:
        """Run ``points``, and bisect what changes in their columns."""
        columns = dict.fromkeys((number, frequency) for number, frequency, _ in points)
        while points:
            for (number, frequency, amplitude), end in zip(points, self.ends(points), strict=True):
                self._ends.setdefault((number, frequency), {})[amplitude] = end
            points = []
            for column in columns:
                for (low, below), (high, above) in pairwise(sorted(self._ends[column].items())):
                    if below != above and high - low > self.tolerance:
                        points.append((*column, 0.5 * (low + high)))
        for column in columns:
            self._regions[column] = regions(sorted(self._ends[column].items()), self.tolerance)

    def _suggested(self, number: int, frequencies: Sequence[float]) -> list[Point]:
        """Return the points of each column at which a neighbour with other outcomes has the middle of a region, if not run yet.

        The same region may be narrow, and unseen, in this column.
        """
        suggested: dict[Point, None] = {}
        for left, right in pairwise(frequencies):
            neighbours = self._regions[number, left], self._regions[number, right]
            if _outcomes(neighbours[0]) != _outcomes(neighbours[1]):
                for frequency, regions in ((left, neighbours[1]), (right, neighbours[0])):
                    for region in regions:
                        suggested[number, frequency, 0.5 * (region.low + region.high)] = None
        return [point for point in suggested if point[2] not in self._ends[point[:2]]]

    def _middles(self, number: int, frequencies: Sequence[float]) -> list[float]:
        """Return the middles between neighbours further apart than ``width`` whose boundaries straight lines do not join."""
        columns = [self._regions[number, frequency] for frequency in frequencies]
        middles = []
        for i, (left, right) in enumerate(pairwise(frequencies)):
            if right - left > self.width and not self._joined(frequencies, columns, i):
                middles.append(0.5 * (left + right))
        return middles

    def _joined(self, frequencies: Sequence[float], columns: Sequence[list[Region]], i: int) -> bool:
        """Return whether straight lines join the boundaries of columns ``i`` and ``i + 1`` to half the tolerance.

        Parabolas through a third column on either side tell it; False if there is none with the same outcomes.
        """
        outcomes = _outcomes(columns[i])
        if _outcomes(columns[i + 1]) != outcomes:
            return False
        threes = [
            range(j, j + 3)
            for j in (i - 1, i)
            if j >= 0 and j + 3 <= len(columns) and all(_outcomes(columns[k]) == outcomes for k in range(j, j + 3))
        ]
        step = frequencies[i + 1] - frequencies[i]
        return bool(threes) and all(
            abs(_curvature(*((frequencies[k], columns[k][boundary].high) for k in three))) * step**2 / 8
            <= 0.5 * self.tolerance
            for three in threes
            for boundary in range(len(outcomes) - 1)
        )


def _outcomes(column: Sequence[Region]) -> list[str]:
    return [region.outcome for region in column]


def _curvature(a: tuple[float, float], b: tuple[float, float], c: tuple[float, float]) -> float:
    """Return the second derivative of the parabola through three points."""
    (x1, y1), (x2, y2), (x3, y3) = a, b, c
    return 2 * ((y3 - y2) / (x3 - x2) - (y2 - y1) / (x2 - x1)) / (x3 - x1)
