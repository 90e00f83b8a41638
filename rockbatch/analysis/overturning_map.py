"""Overturning maps: which amplitudes of a pulse a pier survives, over the pulse's frequency.

A pulse overturns a block in two ways: after an impact or more (mode 1), or outright (mode 2); between them it may
survive (Zhang & Makris 2001). An amplitude above that of overturning may therefore be safe: the map is a grid of runs,
and every change of the outcome along the amplitude is bisected. What is narrower than a step of the grid, with the same
outcome on both sides, is not seen.
"""

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from itertools import groupby, pairwise
from typing import TYPE_CHECKING, Any, NamedTuple

from rockbatch.motions import Motion
from rockbatch.motions.pulses import pulse, pulse_length
from rockbatch.plan import Made, Run, scaled
from rockbatch.study import Case
from rockbatch.study.spectrum import MapSpec

if TYPE_CHECKING:
    import pandas as pd

FILE = "overturning_map.csv"
RUNS = "overturning_runs.csv"

SAFE, WITH_IMPACT, OUTRIGHT, FLIGHT, UNDECIDED = (
    "safe",
    "overturned with impact",
    "overturned without impact",
    "flight",
    "undecided",
)
"""Ends of a run; undecided is one that did not settle, near a boundary, say."""

SAMPLES = 400
"""Of a period: a sine that is linear between them moves a boundary by 2e-5 of itself (2π/SAMPLES)²/12."""

Point = tuple[int, float]
"""A column of the map, and an amplitude."""


class Region(NamedTuple):
    """Amplitudes a_p/(g tan α) with one outcome, and the errors of both ends; NaN where the map ends."""

    outcome: str
    low: float
    high: float
    low_error: float
    high_error: float


def ending(status: str, impacts: int) -> str:
    """The region to which a run belongs."""
    if status == "overturned":
        return WITH_IMPACT if impacts else OUTRIGHT
    return {"ok": SAFE, "flight": FLIGHT}.get(status, UNDECIDED)


def refine(
    ends: Callable[[Sequence[Point]], Iterable[str]], columns: int, amplitudes: Sequence[float], tolerance: float
) -> list[list[tuple[float, str]]]:
    """Amplitudes of every column, in order, with their outcomes: next to each other they differ within ``tolerance``.

    ``ends`` gives the outcomes of many points at once: first the grid, then the middles of all intervals that are wider
    and whose ends differ, and so on. What it says about a point must not depend on the others.
    """
    found: list[dict[float, str]] = [{} for _ in range(columns)]
    asked: list[Point] = [(column, amplitude) for column in range(columns) for amplitude in amplitudes]
    while asked:
        for (column, amplitude), outcome in zip(asked, ends(asked), strict=True):
            found[column][amplitude] = outcome
        asked = [
            (column, 0.5 * (low + high))
            for column, points in enumerate(found)
            for (low, below), (high, above) in pairwise(sorted(points.items()))
            if below != above and high - low > tolerance
        ]
    return [sorted(points.items()) for points in found]


def regions(points: Sequence[tuple[float, str]]) -> list[Region]:
    """Neighbours with one outcome as a region; a boundary lies in the middle between two that differ."""
    runs = [(outcome, [amplitude for amplitude, _ in same]) for outcome, same in groupby(points, key=lambda p: p[1])]
    inner = [(0.5 * (low[-1] + high[0]), 0.5 * (high[0] - low[-1])) for (_, low), (_, high) in pairwise(runs)]
    ends = [(points[0][0], math.nan), *inner, (points[-1][0], math.nan)]
    return [
        Region(outcome, low, high, low_error, high_error)
        for (outcome, _), ((low, low_error), (high, high_error)) in zip(runs, pairwise(ends), strict=True)
    ]


class Columns:
    """The columns of a map, for every case one at each frequency, and the runs in them."""

    def __init__(self, spec: MapSpec, cases: Sequence[Case]) -> None:
        self.spec = spec
        self.amplitudes = spec.grid[1]
        self.places = [(case, frequency) for case in cases for frequency in spec.grid[0]]
        self._units: dict[int, Motion] = {}

    def __len__(self) -> int:
        return len(self.places)

    def runs(self, points: Sequence[Point]) -> Made:
        """The runs at ``points``; their scale is the amplitude a_p/(g tan α)."""

        def make(index: int) -> Run:
            column, amplitude = points[index]
            unit = self._unit(column)
            return Run(scaled(unit, amplitude, "+"), "+", amplitude, self.places[column][0], unit)

        return Made(len(points), make)

    def find(self, carry_out: "Callable[[Sequence[Run]], pd.DataFrame]") -> list[list[tuple[float, str]]]:
        """Refine the map; ``carry_out`` gives the rows of peaks.csv of the runs of a wave, in their order."""

        def ends(points: Sequence[Point]) -> list[str]:
            table = carry_out(self.runs(points))
            return [ending(*each) for each in zip(table["status"], table["impacts"], strict=True)]

        return refine(ends, len(self), self.amplitudes, self.spec.tolerance)

    def _unit(self, column: int) -> Motion:
        """The pulse with an amplitude of g tan α."""
        if column not in self._units:
            case, frequency = self.places[column]
            spec, pier = self.spec, case.pier
            period = 2 * math.pi / (frequency * pier.p)
            self._units[column] = pulse(
                spec.shape,
                name=f"{spec.name}, {frequency:.6g}",
                amplitude=pier.gravity * math.tan(pier.alpha),
                period=period,
                dt=period / SAMPLES,
                duration=pulse_length(spec.shape, period, spec.gamma),
                gamma=spec.gamma,
                nu=spec.nu,
            )
        return self._units[column]

    def rows(self, found: Sequence[Sequence[tuple[float, str]]]) -> Iterator[Mapping[str, Any]]:
        """Rows of overturning_map.csv, a region each, of what :func:`refine` has found."""
        for (case, frequency), points in zip(self.places, found, strict=True):
            for region in regions(points):
                yield {
                    "map": self.spec.name,
                    "case": case.name,
                    **case.columns,
                    "omega_p_over_p": frequency,
                    **region._asdict(),
                }


def columns(varied: Sequence[str]) -> list[str]:
    """Columns of overturning_map.csv; amplitudes are a_p/(g tan α), a column of the map is told by ω_p/p."""
    return ["map", "case", *varied, "omega_p_over_p", *Region._fields]
