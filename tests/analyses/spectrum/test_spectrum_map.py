"""Overturning maps: every boundary within its tolerance, and those of a slender block against closed forms."""

import math
from dataclasses import replace
from itertools import pairwise

import pandas as pd
import pytest
from scipy.optimize import brentq
from slender_block import HALF_SINE, ONE_SINE, SLENDER, E, energy_after_impact, outward
from studies import RIGID, SINE, study_text, write_study

from rockbatch.analyses.spectrum.map_search import End, Search, regions
from rockbatch.analyses.spectrum.overturning_map import OUTRIGHT, SAFE, SAMPLES, UNDECIDED, WITH_IMPACT, Maps, ending
from rockbatch.analyses.spectrum.study import MapSpec
from rockbatch.batch.threads import Threads
from rockbatch.commands.cli import main
from rockbatch.pier import ElasticBase, Pier, RigidBase
from rockbatch.results.columns import as_table, row
from rockbatch.study import Case, Numerics, Output, Study
from rockbatch.study.spec import MotionSpec

TOLERANCE = 1e-3


def found(spec, pier, base):
    """Regions of each frequency of a map with one case."""
    numerics = Numerics(tolerance=1e-4, quiet_s=0.0)
    case = Case("block", pier, base, {})
    study = Study("", "", None, "", MotionSpec(), numerics, (case,), (), (), Output())

    def execute(runs):
        finished = dict(pair for group in Threads(2).outcomes(runs, numerics) for pair in group.items())
        return as_table([row(finished[i]) for i in range(len(runs))], study)

    (columns,) = Maps(spec, (case,)).find(execute)
    return {frequency: regions(points, spec.tolerance) for frequency, points in columns.items()}


def heights(column):
    return [(below.outcome, above.outcome, below.high) for below, above in pairwise(column)]


def sampled(amplitude):
    """Where a boundary lies for a sine that is linear between samples: (2π/SAMPLES)²/12 higher, as its sine is lower.

    Measured by the bisections of test_overturning.py: 0.9998 to 1.0009 of that.
    """
    return pytest.approx(amplitude * (1 + (2 * math.pi / SAMPLES) ** 2 / 12), abs=0.501 * TOLERANCE)


ONE = MapSpec("one-sine", "sine", (5.0, 6.0), (1.0, 11.0), 2, 21, TOLERANCE, width=1.0)


def test_a_one_sine_has_both_modes_of_zhang_and_makris_at_the_closed_forms():
    """Safe, overturned after an impact, safe again, overturned outright, at three amplitudes for ω_p/p = 5 and 6."""
    by_frequency = found(ONE, Pier(SLENDER, 1.0), RigidBase(E))
    exact = {
        5.0: ONE_SINE,
        6.0: (
            *(brentq(energy_after_impact, *bracket, args=(6.0,)) for bracket in ((4.5, 6.0), (7.0, 8.5))),
            brentq(outward, 8.5, 10.0, args=(2 * math.pi, 6.0)),
        ),
    }
    for frequency, column in by_frequency.items():
        assert [region.outcome for region in column] == [SAFE, WITH_IMPACT, SAFE, OUTRIGHT]
        for (_, _, height), amplitude in zip(heights(column), exact[frequency], strict=True):
            assert height == sampled(amplitude)
        assert all(region.high_error <= 0.5 * TOLERANCE for region in column[:-1])


def test_a_half_sine_overturns_a_slender_block_at_the_closed_form():
    """√(A² − 1) + A exp(−(π − asin 1/A)/W) = W, linearised (THEORY.md, Rocking spectra, overturning maps, sensitivity)."""
    spec = MapSpec("half-sine", "half-sine", (2.0, 6.0), (1.05, 6.0), 5, 12, TOLERANCE)
    by_frequency = found(spec, Pier(SLENDER, 1.0), RigidBase(E))
    assert heights(by_frequency[5.0])[0][2] == sampled(HALF_SINE)
    for w, column in by_frequency.items():
        amplitude = brentq(outward, 1.0 + 1e-9, 9.0, args=(math.pi, w))
        ((below, above, height),) = heights(column)
        assert (below, above) == (SAFE, OUTRIGHT)
        assert height == sampled(amplitude)


@pytest.mark.slow
def test_the_map_of_a_rigid_base_does_not_depend_on_the_size_of_the_pier():
    """Dimensionless: α, ω_p/p and a_p/(g tan α) say all; the same runs but for rounding."""
    small, large = (found(replace(ONE, frequencies=2), Pier(0.15, p), RigidBase()) for p in (4.0, 0.5))
    for frequency in small:
        assert [each[:2] for each in heights(small[frequency])] == [each[:2] for each in heights(large[frequency])]
        assert [each[2] for each in heights(small[frequency])] == pytest.approx(
            [each[2] for each in heights(large[frequency])], abs=1e-12
        )


# The search itself


def searched(ends, amplitudes, tolerance, *, frequencies=(0.0,), width=1.0):
    """The columns that a search finds; outcomes are as ``ends`` has them of a frequency and an amplitude."""
    waves = []

    def at(points):
        waves.append(len(points))
        return [End(ends(frequency, amplitude)) for _, frequency, amplitude in points]

    (columns,) = Search(at, amplitudes, tolerance, width).find(1, frequencies)
    return columns, waves


def outcomes(points):
    return [each.outcome for each in regions(points)]


def test_every_change_is_bisected_to_the_tolerance_and_no_more_runs_are_made():
    """Within 2⁻⁹ of steps of 1 it takes nine waves after the grid."""
    grid = [float(a) for a in range(11)]
    columns, waves = searched(lambda _, a: "up" if math.pi < a < 5.123 else "down", grid, 2.0**-9)
    assert outcomes(columns[0.0]) == ["down", "up", "down"]
    assert [each.high for each in regions(columns[0.0])[:2]] == pytest.approx([math.pi, 5.123], abs=2.0**-10)
    assert waves == [11] + 9 * [2]
    columns, waves = searched(lambda _, a: "down", grid, 2.0**-9)
    assert (outcomes(columns[0.0]), waves) == (["down"], [11])


def test_a_third_outcome_on_the_way_gets_boundaries_of_its_own():
    """A band that the grid does not see appears when a bisection falls into it."""
    columns, _ = searched(lambda _, a: "a" if a < 0.4 else "b" if a < 0.6 else "c", [0.0, 1.0], 1e-6)
    assert outcomes(columns[0.0]) == ["a", "b", "c"]
    assert [each.high for each in regions(columns[0.0])] == pytest.approx([0.4, 0.6, 1.0], abs=1e-6)


def test_a_window_between_two_ways_of_overturning_is_found():
    def ends(points):
        return [End("stands") if 0.50 < a < 0.51 else End("falls", 1 if a < 0.505 else 2) for _, _, a in points]

    (columns,) = Search(ends, [0.0, 1.0], 1e-4, 1.0).find(1, [0.0])
    assert outcomes(columns[0.0]) == ["falls", "stands", "falls"]


def test_islands_below_the_tolerance_belong_to_the_boundary_and_its_error():
    points = [(a, End(outcome)) for a, outcome in [(0.0, "a"), (0.4, "a"), (0.401, "b"), (0.402, "c"), (1.0, "c")]]
    assert outcomes(points) == ["a", "b", "c"]
    below, above = regions(points, 0.002)
    assert (below.outcome, above.outcome) == ("a", "c")
    assert below.high == above.low == pytest.approx(0.401)
    assert below.high_error == above.low_error == pytest.approx(0.001)
    (only,) = regions([(0.0, End("a")), (0.4, End("a")), (0.401, End("b")), (0.402, End("a")), (1.0, End("a"))], 0.002)
    assert (only.low, only.high) == (0.0, 1.0)
    exactly = [(n / 8, End(outcome)) for n, outcome in enumerate("aaabbccc")]
    assert [(each.outcome, each.high) for each in regions(exactly, 0.25)] == [("a", 0.4375), ("c", 0.875)]
    assert [each.high for each in regions(exactly, 2.0)] == [0.3125, 0.5625, 0.875]  # where all are narrow


def test_frequencies_are_bisected_only_where_outcomes_change():
    """A slit that ends at a frequency of π: straight boundaries elsewhere need no column."""
    columns, _ = searched(
        lambda f, a: "falls" if a > 1.0 + 0.1 * f and not (f < math.pi and 1.9 < a < 2.2) else "stands",
        [0.25 * i for i in range(13)], 1e-6, frequencies=[float(f) for f in range(9)], width=0.01,
    )  # fmt: skip
    changes = [(f, g) for (f, one), (g, other) in pairwise(columns.items()) if outcomes(one) != outcomes(other)]
    ((before, after),) = changes
    assert before < math.pi <= after <= before + 0.01
    assert [f for f in columns if not 2.0 <= f <= 4.0] == [0.0, 1.0, 5.0, 6.0, 7.0, 8.0]


def test_an_island_is_followed_to_its_end_where_it_is_narrower_than_the_grid():
    """A tongue 0.3 wide at a frequency of 0 and none at 3; the grid of 0.25 sees it down to 0.25 only."""
    columns, _ = searched(
        lambda f, a: "stands" if abs(a - 2.1 - 0.05 * f) < 0.15 - 0.05 * f else "falls",
        [0.25 * i for i in range(17)], 1e-4, frequencies=[0.0, 1.0, 2.0, 3.0, 4.0], width=0.01,
    )  # fmt: skip
    seen = [f for f, points in columns.items() if "stands" in outcomes(points)]
    assert max(seen) == pytest.approx(3.0, abs=0.015)
    assert seen == [f for f in columns if f <= max(seen)]


def test_lines_between_columns_follow_a_curved_boundary_within_the_tolerance():
    def height(f):
        return 1.0 + 0.3 * f**2

    columns, _ = searched(
        lambda f, a: "falls" if a > height(f) else "stands", [0.5 * i for i in range(15)], 1e-3,
        frequencies=[float(f) for f in range(5)], width=1e-3,
    )  # fmt: skip
    boundary = {f: regions(points)[0].high for f, points in columns.items()}
    for (f, low), (g, high) in pairwise(boundary.items()):
        assert 0.5 * (low + high) == pytest.approx(height(0.5 * (f + g)), abs=1e-3)
    assert len(columns) < 100


def test_two_columns_alone_are_not_joined_however_alike_they_are():
    columns, _ = searched(
        lambda f, a: "falls" if a > 1.0 + f * (1.0 - f) else "stands",
        [0.0, 2.0],
        1e-3,
        frequencies=[0.0, 1.0],
        width=0.5,
    )
    assert [*columns] == [0.0, 0.5, 1.0]
    assert regions(columns[0.5])[0].high == pytest.approx(1.25, abs=1e-3)


def test_the_ends_of_a_map_are_no_boundaries():
    (only,) = regions([(1.0, End(SAFE)), (2.0, End(SAFE))])
    assert (only.low, only.high) == (1.0, 2.0)
    assert math.isnan(only.low_error)
    assert math.isnan(only.high_error)


@pytest.mark.parametrize(
    ("status", "impacts", "outcome"),
    [("ok", 3, SAFE), ("overturned", 0, OUTRIGHT), ("overturned", 2, WITH_IMPACT), ("failed", 0, UNDECIDED)],
)
def test_runs_belong_to_the_region_of_their_outcome(status, impacts, outcome):
    assert ending(status, impacts, RigidBase()).outcome == outcome
    assert ending(status, impacts, ElasticBase(beta=40.0)).outcome == outcome


def test_impacts_tell_the_ways_to_overturn_on_a_rigid_base_only():
    assert ending("overturned", 2, RigidBase()) != ending("overturned", 3, RigidBase())
    assert ending("overturned", 2, ElasticBase(beta=40.0)) == ending("overturned", 3, ElasticBase(beta=40.0))


# The command

STUDY = study_text(
    pier={"alpha": [0.1, 0.2], "p": 2.0}, pulses=(SINE | {"name": "not used"},), cases=(RIGID,),
    spectrum={"map": [
        {"name": "one", "shape": "sine", "frequency": [3.0, 5.0], "frequencies": 3, "amplitude": [1.0, 8.0]}
        | {"amplitudes": 8, "tolerance": 0.05, "width": 0.5},
        {"name": "near-fault", "shape": "mavroeidis-papageorgiou", "gamma": 1.05, "nu": 0.0, "frequency": [3.0, 5.0]}
        | {"frequencies": 2, "amplitude": [1.0, 4.0], "amplitudes": 4, "width": 0.5},
    ]},
)  # fmt: skip


@pytest.mark.slow
@pytest.mark.usefixtures("pages")
def test_the_command_writes_regions_and_goes_on_after_a_kill(tmp_path, monkeypatch, capsys):
    """Ctrl-C in the third wave; undisturbed and interrupted tables have the same bytes."""
    write_study(tmp_path, STUDY)
    command = ["spectrum", str(tmp_path / "study.toml"), "--jobs", "1", "--out"]
    assert main([*command, str(tmp_path / "whole")]) == 0
    printed = capsys.readouterr()
    assert "0.1" in printed.out
    assert "map one: 3 frequencies × 8 amplitudes × 2 cases on 1 thread" in printed.err

    outcomes, waves = Threads.outcomes, []

    def interrupted(self, runs, *more):
        waves.append(len(runs))
        if len(waves) == 3:
            raise KeyboardInterrupt
        yield from outcomes(self, runs, *more)

    monkeypatch.setattr(Threads, "outcomes", interrupted)
    assert main([*command, str(tmp_path / "killed")]) == 130
    assert main([*command, str(tmp_path / "killed")]) == 0
    assert waves[3:5] == [0, 0]  # the waves that were finished
    for name in ("overturning_map.csv", "overturning_runs.csv"):
        assert (tmp_path / "killed" / name).read_bytes() == (tmp_path / "whole" / name).read_bytes()

    table = pd.read_csv(tmp_path / "whole" / "overturning_map.csv")
    assert set(table["map"]) == {"one", "near-fault"}
    assert set(table["alpha"]) == {0.1, 0.2}
    for _, column in table.groupby(["map", "alpha", "omega_p_over_p"]):
        assert (column["high"].iloc[:-1].to_numpy() == column["low"].iloc[1:].to_numpy()).all()
        assert (column["outcome"].iloc[:-1].to_numpy() != column["outcome"].iloc[1:].to_numpy()).all()
    report = (tmp_path / "whole" / "analyses.html").read_text(encoding="utf-8")
    assert "overturns after an impact or more (mode 1)" in report
    assert "overturns without impact (mode 2)" in report


def test_a_pulse_needs_the_parameters_of_its_shape_and_no_others(tmp_path, capsys):
    text = STUDY.replace("gamma = 1.05\nnu = 0.0\n", "gamma = 1.0\n").replace(
        'shape = "sine"\nfreq', 'shape = "sine"\nnu = 1.0\nfreq'
    )
    text = text.replace('"near-fault"', '"one"')
    write_study(tmp_path, text)
    assert main(["spectrum", str(tmp_path / "study.toml"), "--out", str(tmp_path / "out")]) == 2
    told = capsys.readouterr().err
    for words in (
        '21: [[spectrum.map]] "one": nu = 1.0: does not apply',
        "gamma = 1.0: expected a number above 1",
        "nu is missing",
        'name = "one": given twice',
    ):
        assert words in told
    assert not (tmp_path / "out").exists()


@pytest.mark.slow
@pytest.mark.usefixtures("pages")
def test_spectra_that_are_finished_are_not_run_again_when_a_map_was_interrupted(tmp_path, monkeypatch, capsys):
    text = STUDY + "\n[spectrum]\nalpha = 0.1\np = [1, 2]\npoints = 2\n"
    write_study(tmp_path, text)
    command = ["spectrum", str(tmp_path / "study.toml"), "--out", str(tmp_path / "out")]
    outcomes, batches = Threads.outcomes, []

    def interrupted(self, runs, *more):
        batches.append(len(runs))
        if len(batches) == 2:
            raise KeyboardInterrupt
        yield from outcomes(self, runs, *more)

    monkeypatch.setattr(Threads, "outcomes", interrupted)
    assert main(command) == 130
    assert capsys.readouterr().err.endswith("rockbatch: interrupted\n")
    assert main(command) == 0
    assert batches[:3] == [2, 48, 48]  # the spectra, the grid of the first map twice
    report = (tmp_path / "out" / "analyses.html").read_text(encoding="utf-8")
    assert "Largest rotation over slenderness" in report
    assert "overturns without impact (mode 2)" in report
