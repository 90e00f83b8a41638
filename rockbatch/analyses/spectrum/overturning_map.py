"""Overturning maps: which amplitudes of a pulse a pier survives, over the pulse's frequency.

A pulse overturns a block in two ways: after an impact or more (mode 1), or outright (mode 2); between them it may
survive (Zhang & Makris 2001). An amplitude above that of overturning may therefore be safe, and the regions change with the
frequency in number and order: :mod:`rockbatch.analyses.spectrum.map_search` finds them.
"""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence

from rockbatch.analyses.spectrum.map_regions import FLIGHT, OUTRIGHT, SAFE, UNDECIDED, WITH_IMPACT
from rockbatch.analyses.spectrum.map_search import End, Point, Points, Region, Search, regions
from rockbatch.analyses.spectrum.study import MapSpec
from rockbatch.batch.plan import Made
from rockbatch.common.analyses import Entry
from rockbatch.common.lazy import pd
from rockbatch.motions import Motion
from rockbatch.motions.suites.pulses import pulse, pulse_length
from rockbatch.pier import Base
from rockbatch.results.columns import StudyRun
from rockbatch.study import Case

FILE = "overturning_map.csv"
RUNS = "overturning_runs.csv"

SAMPLES = 400
"""Samples of a period: a sine that is linear between them moves a boundary by 2e-5 of itself (2π/SAMPLES)²/12."""


def ending(status: str, impacts: int, base: Base) -> End:
    """Return the region to which a run belongs, and the way there; a status such as "failed" is UNDECIDED.

    Of a rigid block that overturns the way is the number of impacts. Between two ways is a boundary on which the block would
    stay at the unstable equilibrium: near it there may be a window of safe amplitudes, however narrow. On springs the impacts
    change with every amplitude, and say nothing.
    """
    if status == "overturned":
        return End(WITH_IMPACT if impacts else OUTRIGHT, 0 if base.on_springs else impacts)
    return End({"ok": SAFE, "flight": FLIGHT}.get(status, UNDECIDED))


class Maps:
    """The map of one pulse for every case, and the runs in it."""

    def __init__(self, spec: MapSpec, cases: Sequence[Case]) -> None:
        self.spec, self.cases = spec, cases
        self._units: dict[tuple[int, float], Motion] = {}

    def runs(self, points: Sequence[Point]) -> Made:
        """Return the runs at ``points``, (number of the case, ω_p/p, amplitude); their scale is the amplitude a_p/(g tan α)."""

        def make(index: int) -> StudyRun:
            case, frequency, amplitude = points[index]
            return StudyRun(self._unit(case, frequency), "+", amplitude, self.cases[case])

        return Made(len(points), make)

    def find(self, execute: "Callable[[Made], pd.DataFrame]") -> list[dict[float, Points]]:
        """Return the columns of each case's map; ``execute`` returns the rows of peaks.csv for the runs of a wave, in order."""

        def ends(points: Sequence[Point]) -> list[End]:
            table = execute(self.runs(points))
            return [
                ending(status, impacts, self.cases[case].base)
                for (case, _, _), status, impacts in zip(points, table["status"], table["impacts"], strict=True)
            ]

        frequencies, amplitudes = self.spec.grid
        return Search(ends, amplitudes, self.spec.tolerance, self.spec.width).find(len(self.cases), frequencies)

    def _unit(self, number: int, frequency: float) -> Motion:
        """Return the pulse of the map at ω_p/p = ``frequency`` of a case, with an amplitude of g tan α."""
        if (number, frequency) not in self._units:
            spec, pier = self.spec, self.cases[number].pier
            period = 2 * math.pi / (frequency * pier.p)
            self._units[number, frequency] = pulse(
                spec.shape,
                name=f"{spec.name}, {frequency:.6g}",
                amplitude=pier.gravity * math.tan(pier.alpha),
                period=period,
                dt=period / SAMPLES,
                duration=pulse_length(spec.shape, period, spec.gamma),
                gamma=spec.gamma,
                nu=spec.nu,
            )
        return self._units[number, frequency]

    def rows(self, by_case: Sequence[Mapping[float, Points]]) -> Iterator[Entry]:
        """Yield the rows of overturning_map.csv, a region each, from the columns of each case."""
        for case, columns in zip(self.cases, by_case, strict=True):
            for frequency, points in columns.items():
                for region in regions(points, self.spec.tolerance):
                    yield {
                        "map": self.spec.name,
                        "case": case.name,
                        **case.columns,
                        "omega_p_over_p": frequency,
                        **region._asdict(),
                    }


def columns(varied: Sequence[str]) -> list[str]:
    """Return the columns of overturning_map.csv; amplitudes are a_p/(g tan α), a column of the map is identified by ω_p/p."""
    return ["map", "case", *varied, "omega_p_over_p", *Region._fields]
