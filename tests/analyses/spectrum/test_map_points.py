"""What an overturning map shows at points where nothing was computed, held against simulations at these points."""

import math
import random
from dataclasses import dataclass
from functools import cache

import pandas as pd
import pytest

import rockbatch as rb
from rockbatch.analyses.spectrum.map_regions import strips
from rockbatch.analyses.spectrum.overturning_map import SAMPLES, Maps, columns, ending
from rockbatch.analyses.spectrum.study import MapSpec
from rockbatch.batch.plan import Made
from rockbatch.batch.threads import Threads
from rockbatch.motions.suites.pulses import pulse_length
from rockbatch.pier import Pier, RigidBase
from rockbatch.results.columns import StudyRun, as_table, row
from rockbatch.study import Case, Numerics, Output, Study
from rockbatch.study.spec import MotionSpec

PIER = Pier(0.15, 1.0)
CASE = Case("rigid", PIER, RigidBase(), {})
NUMERICS = Numerics(tolerance=1e-4, quiet_s=2.0)
STUDY = Study("", "", None, "", MotionSpec(), NUMERICS, (CASE,), (), (), Output())


def whole(shape, **parameters):
    """The ranges and the grid of configs/spectrum.toml."""
    return MapSpec(shape, shape, (1.0, 7.0), (1.0, 10.0), 25, 37, **parameters)


@dataclass
class Shown:
    """A map as it is drawn."""

    spec: MapSpec

    def __post_init__(self):
        def execute(runs):
            return as_table(map(row, finished(runs)), STUDY)

        maps = Maps(self.spec, (CASE,))
        self.strips = strips(pd.DataFrame(maps.rows(maps.find(execute)), columns=columns(())))

    def at(self, point):
        own = next((strip for strip in self.strips if point[0] <= strip.frequencies[-1]), self.strips[-1])
        return own.outcome(*point)


def finished(runs):
    by_index = dict(pair for group in Threads(2).outcomes(runs, NUMERICS) for pair in group.items())
    return [by_index[i] for i in range(len(runs))]


def simulated(spec, points):
    """The region of each point (ω_p/p, a_p/(g tan α)), by a run of its own pulse."""

    def run(i):
        frequency, amplitude = points[i]
        period = 2 * math.pi / (frequency * PIER.p)
        motion = rb.pulse(
            spec.shape, name="pulse", amplitude=amplitude * PIER.gravity * math.tan(PIER.alpha), period=period,
            dt=period / SAMPLES, duration=pulse_length(spec.shape, period, spec.gamma), gamma=spec.gamma, nu=spec.nu,
        )  # fmt: skip
        return StudyRun(motion, "+", 1.0, CASE)

    outcomes = [one.outcome for one in finished(Made(len(points), run))]
    return [ending(outcome.status, outcome.impacts, CASE.base).outcome for outcome in outcomes]


def wrong(shown, points):
    """Points at which the picture shows something else, and those of them that no boundary is near.

    One is near where a run no farther than the map's width and tolerance comes to something else.
    """
    spec = shown.spec
    differ = [p for p, truth in zip(points, simulated(spec, points), strict=True) if shown.at(p) != truth]
    steps = [(i * spec.width, j * spec.tolerance) for i in (-1, -0.5, 0, 0.5, 1) for j in (-1, 0, 1)]
    far = [p for p in differ if len(set(simulated(spec, [(p[0] + df, p[1] + da) for df, da in steps]))) == 1]
    return differ, far


def scattered(spec, number, seed=1):
    drawn = random.Random(seed)
    return [(drawn.uniform(*spec.frequency), drawn.uniform(*spec.amplitude)) for _ in range(number)]


PARTS = {
    "sine": MapSpec("one-sine", "sine", (5.75, 6.75), (8.0, 10.0), 5, 9),
    "half-sine": MapSpec("half-sine", "half-sine", (1.0, 4.0), (1.0, 10.0), 7, 37),
    "ricker": MapSpec("ricker", "ricker", (1.5, 2.5), (1.0, 10.0), 6, 37),
}


@cache
def part(shape):
    return Shown(PARTS[shape])


@pytest.mark.slow
@pytest.mark.parametrize(
    ("shape", "number"),
    [
        ("sine", 40),
        *(pytest.param(shape, 50, marks=pytest.mark.slow) for shape in ("sine", "half-sine")),
        pytest.param("ricker", 50, marks=pytest.mark.thorough),
    ],
)
def test_a_map_shows_at_random_points_what_their_simulation_says(shape, number):
    shown = part(shape)
    differ, far = wrong(shown, scattered(shown.spec, number))
    assert far == []
    assert len(differ) <= 1


@pytest.mark.thorough
@pytest.mark.slow
def test_a_ricker_pulse_that_overturns_everywhere_is_not_shown_as_safe():
    """21 frequencies; between two of them the pier overturns from 6.5 to 8.5 g tan α, whatever the neighbours do."""
    shown = Shown(MapSpec("ricker", "ricker", (1.0, 3.0), (1.0, 10.0), 21, 37))
    points = [(2.05, 6.5 + 0.02 * i) for i in range(101)]
    assert {outcome.split()[0] for outcome in simulated(shown.spec, points)} == {"overturned"}
    assert {shown.at(point).split()[0] for point in points} == {"overturned"}


@pytest.mark.slow
@pytest.mark.parametrize(
    "spec",
    [
        whole("half-sine"),
        *(
            pytest.param(spec, marks=pytest.mark.thorough)
            for spec in (whole("sine"), whole("cosine"), whole("ricker"), whole("mavroeidis-papageorgiou", gamma=1.5, nu=0.0))
        ),
    ],
    ids=lambda spec: spec.shape,
)  # fmt: skip
def test_whole_maps_show_at_2000_random_points_what_their_simulation_says(spec):
    """Which differ, and how far from a boundary, is in THEORY.md, Rocking spectra, overturning maps, sensitivity."""
    shown = Shown(spec)
    differ, far = wrong(shown, scattered(spec, 2000))
    assert far == []
    assert len(differ) <= 2


@pytest.mark.slow
def test_a_map_is_covered_once_by_its_strips_however_its_columns_differ():
    """Every strip starts where the one before ends, and in it each region where the one below ends, over the whole range."""
    shown = part("half-sine")
    ends = [(float(strip.frequencies[0]), float(strip.frequencies[-1])) for strip in shown.strips]
    assert [left for left, _ in ends[1:]] == [right for _, right in ends[:-1]]
    assert (ends[0][0], ends[-1][1]) == shown.spec.frequency
    for strip in shown.strips:
        assert (strip.edges[:, 0] == shown.spec.amplitude[0]).all()
        assert (strip.edges[:, -1] == shown.spec.amplitude[1]).all()
        assert (strip.edges[:, 1:] >= strip.edges[:, :-1]).all()
