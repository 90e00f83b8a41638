"""Release tests: the fit against a block in closed form, with errors of reading and a restitution that scatters."""

import json
import math

import numpy as np
import pandas as pd
import pytest
from figure_makers import makers
from numpy.polynomial.legendre import leggauss
from scipy.interpolate import CubicSpline
from scipy.linalg import null_space
from scipy.stats import linregress
from scipy.stats import t as student

import rockbatch as rb
from rockbatch.analyses.release.analysis import GRIDS, _Test
from rockbatch.analyses.release.fit import Fit, Passages, _evaluated, _Linear, _linear, _Posterior, fitted
from rockbatch.analyses.release.quantities import in_words
from rockbatch.analyses.release.study import ReleaseSpec
from rockbatch.common.errors import InputError
from rockbatch.common.files import read_table

BLOCK = rb.Pier.rectangle(0.3, 1.2)
START, IMPACTS = 0.1, 10
FEW = 5
"""Impacts of tests whose claim does not depend on their number: the work of a fit grows as their third power."""
GRID = np.linspace(0.05, 1.0, 39)
_NODES, _WEIGHTS = leggauss(60)


def quarter(amplitude: float) -> float:
    """Return Q(θ) of THEORY.md, eq. 28, by Gauss–Legendre in s, θ − φ = s²."""
    if amplitude <= 0.0:
        return 0.0
    end = math.sqrt(amplitude)
    s = 0.5 * end * (_NODES + 1.0)
    drop = 2.0 * np.sin(BLOCK.alpha - amplitude + 0.5 * s * s) * np.sin(0.5 * s * s)
    return float((2.0 * s / np.sqrt(2.0 * drop) / BLOCK.p) @ _WEIGHTS) * 0.5 * end


def passages(restitutions) -> Passages:
    """Return the impacts of a block with these restitutions, one for each impact (eq. 28)."""
    t, amplitude = quarter(START), START
    times, amplitudes = [], []
    for e in restitutions:
        times.append(t)
        energy = e * e * (math.cos(BLOCK.alpha - amplitude) - math.cos(BLOCK.alpha))
        amplitude = BLOCK.alpha - math.acos(math.cos(BLOCK.alpha) + energy)
        amplitudes.append(amplitude)
        t += 2.0 * quarter(amplitude)
    return Passages(np.array(times), np.array(amplitudes))


def study_of(release, case=None, **pier) -> rb.Study:
    return rb.Study.from_dict({
        "title": "Test",
        "pier": {"width_m": 0.3, "height_m": 1.2, "initial_rotation_rad": START} | pier,
        "motions": {"still_s": 5.0},
        "case": [{"name": "rigid", "base": "rigid"} if case is None else case],
        "release": release,
    })  # fmt: skip


def lists(measured: Passages) -> dict[str, list[float]]:
    return {"impact_s": measured.t.tolist(), "amplitude_rad": measured.amplitude.tolist()}


@pytest.fixture(autouse=True)
def few_values(monkeypatch):
    """Let fits begin at every third value, between the same bounds: each begins with a run of the core at all of them."""
    for parameter, values in GRIDS.items():
        monkeypatch.setitem(GRIDS, parameter, np.unique([*values[::3], values[-1]]))


@pytest.mark.parametrize(("e", "key"), [(0.75, "impact_s"), (0.98, "amplitude_rad")])
def test_exact_values_give_the_restitution_that_made_them(e, key):
    """1e-6: the runs of a fit have some 1e-8 of θ0 left."""
    (row,) = rb.release(study_of({key: lists(passages([e] * FEW))[key]})).release.to_dict("records")
    assert row["parameter"] == "restitution"
    assert row["value"] == pytest.approx(e, abs=1e-6)
    assert row["low"] <= row["value"] <= row["high"]
    assert row["over_housner"] == pytest.approx(e / BLOCK.restitution, abs=2e-6)


@pytest.fixture(scope="module")
def block():
    """The block's impacts by its restitution: cubics through closed forms, 1e-8 s and rad near the values of these tests."""
    nodes = np.concatenate([np.linspace(0.05, 0.5, 40), np.linspace(0.5, 1.0, 201)[1:]])
    t, amplitude = (
        CubicSpline(nodes, values) for values in zip(*(passages([e] * IMPACTS) for e in nodes), strict=True)
    )
    for own, other in zip(passages([0.9123] * IMPACTS), (t(0.9123), amplitude(0.9123)), strict=True):
        np.testing.assert_allclose(own, other, atol=1e-8)
    return lambda e: Passages(t(e), amplitude(e))


def fits(block, spread: float, reading: tuple[float, float], seeds: int, confidence: float = 0.95) -> list[Fit]:
    """Return the fits to tests of a block whose mean restitution is 0.9."""
    result = []
    for seed in range(seeds):
        random = np.random.default_rng(seed)
        exact = passages(np.clip(0.9 + spread * random.standard_normal(IMPACTS), 0.0, 0.999))
        measured = Passages(
            exact.t + reading[0] * random.standard_normal(IMPACTS),
            exact.amplitude + reading[1] * random.standard_normal(IMPACTS),
        )
        result.append(fitted(measured, block, GRID, confidence))
    return result


def covered(tests: list[Fit]) -> float:
    """Return the share of the intervals that hold the mean restitution, 0.9."""
    return sum(fit.low <= 0.9 <= fit.high for fit in tests) / len(tests)


KINDS = [
    (0.0, (0.003, 1e-3)), (0.02, (1e-4, 1e-4)), (0.01, (0.002, 5e-4)), (0.005, (0.002, math.nan)), (0.02, (math.nan, 5e-4)),
]  # fmt: skip
"""Scatter of the restitution, errors of reading of times [s] and amplitudes [rad]; NaN where nothing is measured."""


@pytest.mark.parametrize(("spread", "reading"), KINDS[4:])
def test_intervals_hold_the_truth_as_often_as_they_say(block, spread, reading):
    """Of 24 tests 22.8 are expected, and fewer than 21 in one of 17 suites.

    Nor are they wider than the values scatter: Student's t of ten impacts makes 1.2 of the normal width, to 2 deviations of 15 %.
    """
    tests = fits(block, spread, reading, 24)
    assert covered(tests) >= 0.87
    (middle,) = fits(block, spread, reading, 1, confidence=1e-6)  # the median, of which the value is one
    assert (middle.low, middle.high) == pytest.approx((tests[0].value, tests[0].value), abs=1e-6)
    scatter = np.std([fit.value for fit in tests])
    assert np.mean([fit.high - fit.low for fit in tests]) / (2 * 1.96 * scatter) == pytest.approx(1.2, abs=0.3)


def test_times_with_the_error_of_the_first_are_fitted_as_a_line():
    """t_k = k θ without scatter from impact to impact: slope and standard error of least squares with a free intercept."""
    number, random = np.arange(1.0, 9.0), np.random.default_rng(5)
    misses = number + 0.3 * random.standard_normal(8) - 0.3 * random.standard_normal()
    linear = _Linear(misses, number[:, None], np.tril(np.ones((8, 8))), np.zeros(8), shared=True)
    _, centres, scales, freedom, _ = _evaluated(linear, np.zeros(1), np.array([[40.0]]))
    line = linregress([0.0, *number], [0.0, *misses])
    assert freedom == len(number) + 1 - 2
    assert centres[0, 0] == pytest.approx(line.slope, rel=1e-9)
    assert scales[0, 0] == pytest.approx(line.stderr, rel=1e-9)


@pytest.mark.thorough
@pytest.mark.parametrize(("spread", "reading"), KINDS)
def test_intervals_hold_the_truth_in_many_tests(block, spread, reading):
    """Of 400 tests 380 are expected, on the average over all ratios of the scatters; of each kind 360 at least.

    Without any scatter of the restitution all do: ten impacts cannot exclude one, and the interval allows for it.
    """
    share = covered(fits(block, spread, reading, 400))
    assert 0.90 <= share <= (0.98 if spread else 1.0)


def test_scatter_of_the_restitution_is_distinguished_from_errors_of_reading():
    exact = passages(0.9 + 0.02 * np.array([1, -1, 0.5, -0.5, 1.5, -1.5, 0.2, -0.2]))
    (row,) = rb.release(study_of(lists(exact))).release.to_dict("records")
    assert row["scatter"] == pytest.approx(0.02, rel=0.2)


@pytest.mark.sweep(fast=1)
@pytest.mark.parametrize("clock", ["release", "first impact"])
def test_the_tables_of_exact_values_are_the_closed_form(clock):
    """Whatever time the first impact has on the clock of the laboratory."""
    exact = passages([0.9] * FEW)
    first, known = (exact.t[0], slice(1, None)) if clock == "first impact" else (0.0, slice(None))
    measured = lists(Passages(exact.t + (7.0 if first else 0.0), exact.amplitude))
    result = rb.release(study_of(measured | {"clock": clock}))
    (row,), rows = result.release.to_dict("records"), result.release_impacts
    for name in ("value", "low", "high", "by_times", "by_amplitudes", "by_times_low", "by_amplitudes_high"):
        assert row[name] == pytest.approx(0.9, abs=1e-5)
    for end in ("", "_low", "_high"):
        assert row[f"over_housner{end}"] == pytest.approx(row[end[1:] or "value"] / BLOCK.restitution, rel=1e-9)
    assert (row["impacts"], row["confidence"], row["scatter"]) == (FEW, 0.95, pytest.approx(0.0, abs=1e-5))
    assert (row["time_stretch"], row["t_rms_s"], row["amplitude_rms_rad"]) == pytest.approx((1.0, 0.0, 0.0), abs=1e-5)
    assert rows["impact"].to_list() == [*range(1, FEW + 1)]
    assert np.isnan(rows["t_measured_s"][: known.start or 0]).all()
    highest = exact.t - first + np.array(list(map(quarter, exact.amplitude)))
    for name, expected in (
        ("t_measured_s", exact.t - first), ("t_computed_s", exact.t - first), ("t_difference_s", np.zeros(FEW)),
        ("amplitude_measured_rad", exact.amplitude), ("amplitude_computed_rad", exact.amplitude),
        ("amplitude_difference_rad", np.zeros(FEW)), ("restitution_measured", np.full(FEW, 0.9)),
        ("restitution_computed", np.full(FEW, 0.9)), ("t_amplitude_computed_s", highest),
    ):  # fmt: skip
        np.testing.assert_allclose(rows[name][known], expected[known], atol=1e-5)
    t, theta = result.release_history[["t_s", "theta_rad"]].to_numpy().T
    assert (t[0], t[-1]) == pytest.approx((-first, 1.1 * (exact.t[-1] - first)), abs=0.011)
    signs = np.resize([-1.0, 1.0], FEW)  # it was let go from a rotation to the right
    ahead = highest < t[-1]
    np.testing.assert_allclose(np.interp(highest[ahead], t, theta), (signs * exact.amplitude)[ahead], atol=1e-4)


@pytest.mark.parametrize("clock", ["release", "first impact"])
@pytest.mark.parametrize("e", [0.9, 0.01])
def test_computed_times_count_from_where_the_measured_ones_do(clock, e):
    """With e = 0.01 the block is at rest before the last of the impacts that were measured: its history is all that was run."""
    study, exact = study_of(lists(passages([0.9] * FEW)) | {"clock": clock}), passages([e] * FEW)
    spec = ReleaseSpec(clock=clock)
    test = _Test(study.cases[0], "restitution", passages([0.9] * FEW), spec)
    table, history = test.laid_over(e)
    first = exact.t[0] if clock == "first impact" else 0.0
    highest = exact.t - first + np.array(list(map(quarter, exact.amplitude)))
    ahead = np.isfinite(table["t_amplitude_computed_s"])
    assert ahead.sum() >= 2
    np.testing.assert_allclose(table["t_amplitude_computed_s"][ahead], highest[ahead], atol=1e-4)
    end = 1.1 * (exact.t[-1] - first) if e == 0.9 else test.still.duration - first
    assert history["t_s"].iloc[0] == pytest.approx(-first, abs=1e-4)
    assert history["t_s"].iloc[-1] == pytest.approx(end, abs=0.011)


def test_times_and_amplitudes_are_also_fitted_apart():
    each = Passages(passages([0.9] * FEW).t, passages([0.85] * FEW).amplitude)
    (row,) = rb.release(study_of(lists(each))).release.to_dict("records")
    assert (row["by_times"], row["by_amplitudes"]) == pytest.approx((0.9, 0.85), abs=1e-4)


QUIET = Fit(0.9, 0.88, 0.92, 0.0, 0.02, 0.002, False, 1.0, 0.002)
WORDS = (
    "measured values differ from computed ones by root mean square: times by 20 ms (0.05 of a mean half cycle), amplitudes by "
    "2 mrad (0.02 of the initial rotation)"
)
APART = "times and amplitudes give values that differ by more than their intervals"


@pytest.mark.parametrize(
    ("change", "apart", "begin"),
    [
        ({}, (0.88, 0.89), ""),
        ({"t_rms": 0.0799, "amplitude_rms": 0.0099}, (), ""),
        ({"t_rms": 0.0801}, (), "poor: "),
        ({"amplitude_rms": 0.0101}, (), "poor: "),
        ({"at_end": True, "stretch": 1.2, "t_rms": 0.5}, (0.7, 0.8), "the best value is at the end"),
        ({"stretch": 1.0049}, (), ""),
        ({"stretch": 0.9949}, (), "measured times are 0.995 ± 0.002 times as long"),
        ({"stretch": 1.03, "stretch_error": 0.031}, (), ""),
        ({"stretch": 1.03, "stretch_error": 0.029, "t_rms": 0.5}, (0.7, 0.8), "measured times are 1.030 ± 0.029 times as long"),
        ({"t_rms": 0.5}, (0.86, 0.9), f"{APART}, 0.86 and 0.9"),
        ({}, (0.9, 0.86), f"{APART}, 0.9 and 0.86"),
    ],
)  # fmt: skip
def test_what_describes_a_test_badly_is_said_in_the_order_of_its_weight(change, apart, begin):
    """Of a test of five impacts within two seconds, from 0.1 rad; intervals to 0.015 about what times and amplitudes ask for."""
    study, measured = study_of({"impact_s": [1.0, 1.5, 2.0]}), Passages(np.zeros(5), np.zeros(5))
    test = _Test(study.cases[0], "restitution", measured, ReleaseSpec())
    test.model = lambda _: Passages(np.linspace(0.4, 2.0, 5), np.zeros(5))
    each = [QUIET._replace(value=value, low=value - 0.015, high=value + 0.015) for value in apart] or [None, None]
    fit = QUIET._replace(**change)
    doubt = test._doubt(fit, dict(zip(("by_times", "by_amplitudes"), each, strict=True)))
    assert doubt.startswith(begin)
    assert bool(doubt) == bool(begin)
    assert change.keys() & {"t_rms", "amplitude_rms"} or test._differences(fit) == WORDS
    one = test._differences(QUIET._replace(t_rms=math.nan))
    assert one.endswith("by root mean square: amplitudes by 2 mrad (0.02 of the initial rotation)")


def test_values_may_be_missing_and_of_a_file_with_other_units(tmp_path):
    exact = passages([0.9] * FEW)
    rows = ["impact_ms;amplitude_deg"]
    for n, (t, amplitude) in enumerate(zip(*exact, strict=True)):
        cells = f"{1000 * t:.9g}", "" if n == 2 else f"{math.degrees(amplitude):.9g}"
        rows.append(";".join(cells).replace(".", ","))
    (tmp_path / "test.csv").write_text("\n".join(rows) + "\n", encoding="utf-8")
    text = rb.Study.from_dict(tomllike(measured="test.csv")).text
    result = rb.release(rb.Study.from_toml(text, tmp_path / "study.toml"))
    assert result.release["value"].iloc[0] == pytest.approx(0.9, abs=1e-6)
    assert math.isnan(result.release_impacts["amplitude_measured_rad"].iloc[2])


def tomllike(**release):
    pier = {"width_m": 0.3, "height_m": 1.2, "initial_rotation_rad": START}
    case = [{"name": "rigid", "base": "rigid"}]
    return {"title": "Test", "pier": pier, "motions": {"still_s": 5.0}, "case": case, "release": release}


@pytest.mark.slow
@pytest.mark.parametrize("case", [
    pytest.param({"name": "pads", "base": "elastic", "beta": 60, "zeta": 0.3}, marks=pytest.mark.slow),
    {"name": "soil", "base": "yielding", "beta": 60, "eta": 4, "zeta": 0.3},
], ids=["elastic", "yielding"])  # fmt: skip
def test_damping_of_springs_is_found_again(case):
    """Values of a run with ζ = 0.1, to its own steps; 2e-3: the time step of the fit is another one."""
    base = rb.ElasticBase(60, zeta=0.1) if case["base"] == "elastic" else rb.YieldingBase(60, zeta=0.1, eta=4)
    cycles = rb.simulate(BLOCK, base, rb.Motion.still(5.0), initial_rotation_rad=START).half_cycles.iloc[1:5]
    (row,) = rb.release(
        study_of({"impact_s": cycles.t.tolist(), "amplitude_rad": cycles.amplitude.tolist()}, case)
    ).release.to_dict("records")
    assert row["parameter"] == "zeta"
    assert row["value"] == pytest.approx(0.1, abs=2e-3)


@pytest.mark.slow
@pytest.mark.parametrize("factor", [1.03, pytest.param(0.97, marks=pytest.mark.slow)])
def test_times_of_another_pier_are_distinguished_from_losses(factor):
    """All times longer by 3 %, as of a pier that is larger by 6 %, with errors of reading of 1 ms and 0.2 mrad."""
    random, exact = np.random.default_rng(4), passages([0.9] * IMPACTS)
    measured = Passages(
        factor * exact.t + 1e-3 * random.standard_normal(IMPACTS),
        exact.amplitude + 2e-4 * random.standard_normal(IMPACTS),
    )
    (row,) = rb.release(study_of(lists(measured))).release.to_dict("records")
    assert row["time_stretch"] == pytest.approx(factor, abs=0.005)
    assert abs(row["time_stretch"] - factor) < row["time_stretch_error"]
    assert f"with p = {BLOCK.p / factor:.2g}"[:10] in row["remark"]


def test_a_value_at_the_end_of_what_can_be_is_named():
    """Half cycles that are longer than those without any loss."""
    (row,) = rb.release(study_of({"impact_s": (1.02 * passages([1.0] * 4).t).tolist()})).release.to_dict("records")
    assert (row["value"], row["high"]) == (1.0, 1.0)
    assert row["remark"].startswith("the best value is at the end")
    near = fitted(passages([0.06] * 3), lambda e: passages([e] * 3), GRID, 0.95)
    assert (near.value, near.at_end) == (pytest.approx(0.06, abs=1e-6), False)  # between the first two of the grid


@pytest.mark.parametrize(("share", "said"), [(0.99e-3, False), (1.01e-3, True)])
def test_a_scatter_from_a_thousandth_on_is_said(share, said):
    fit = {"parameter": "zeta", "value": 0.2, "low": 0.1, "high": 0.3, "confidence": 0.9, "over_housner": math.nan}
    assert in_words(fit | {"scatter": 0.2 * share}).endswith("from impact to impact") == said


WRONG = [
    ({"impact_s": [0.3, 0.8]}, "2 values were measured"),
    ({"impact_s": [0.3, 0.9, 0.8]}, "times have to rise"),
    ({"impact_s": [0.3, 0.9, 0.9]}, "times have to rise"),
    ({"amplitude_rad": [0.1, 0.08, 0.07]}, "the first amplitude is the one after the first impact"),
    ({"impact_s": [0.3, 0.8, 1.3], "fit": "zeta"}, 'case "rigid" has restitution instead'),
    ({"impact_s": [0.3, 0.8, 1.3], "measured": "a.csv"}, "keep one"),
    ({"measured": "nowhere.csv"}, "no such file"),
    ({"impact_s": [0.3, -0.8, 1.3]}, "impact_s = -0.8"),
    ({"impact_s": [0.3, 0.8, 1.3], "confidence": 95}, "above 0 and below 1"),
]


@pytest.mark.parametrize(("release", "words"), WRONG, ids=[words for _, words in WRONG])
def test_what_cannot_be_is_refused_with_what_to_write_instead(release, words):
    with pytest.raises(InputError) as error:
        rb.release(study_of(release))
    assert any(words in problem for problem in error.value.messages), error.value.messages


def test_a_pier_that_was_not_pulled_is_refused():
    with pytest.raises(InputError, match="from where was the pier let go"):
        rb.release(study_of({"impact_s": [0.3, 0.8, 1.3]}, initial_rotation_rad=0.0))


@pytest.mark.parametrize(
    ("base", "fit"),
    [({"base": "elastic"}, None), ({"base": "elastic"}, "zeta"), ({"base": "yielding", "eta": 4}, "epsilon")],
)
def test_an_impact_whose_loss_follows_from_the_pier_is_refused_and_named(base, fit):
    """Housner's e leaves nothing to be fitted, whatever the study wants to fit; an impact by epsilon is not refused so."""
    soil = {"name": "soil", "beta": 60, **base, "impact": ["landing", "housner"]}
    release = {"impact_s": [0.3, 0.8, 1.3]} | ({} if fit is None else {"fit": fit})
    with pytest.raises(InputError) as error:
        rb.release(study_of(release, soil))
    (problem,) = [each for each in error.value.messages if "housner" in each]
    assert 'case "soil" has impact = "housner", whose e follows from the pier' in problem
    assert 'write impact = "landing" or zeta' in problem


@pytest.mark.parametrize(("content", "words"), [
    ("time,amplitude_rad\n0.3,0.1\n", 'a.csv:1: "time": unknown column; write one of impact_s'),
    ("impact_s,impact_ms\n0.3,300\n", "are given by two columns"),
    ("impact_s,amplitude_rad\n0.3,soft\n", "a.csv:2: amplitude_rad = \"soft\""),
    ("impact_s\n-0.3\n", "a.csv:2: impact_s"), ("impact_s\nnan\ninf\n", "a.csv:3"),
])  # fmt: skip
def test_a_file_of_measured_values_is_refused_with_its_line(tmp_path, content, words):
    (tmp_path / "a.csv").write_text(content, encoding="utf-8")
    study = rb.Study.from_toml(rb.Study.from_dict(tomllike(measured="a.csv")).text, tmp_path / "study.toml")
    with pytest.raises(InputError) as error:
        rb.release(study)
    assert any(words in problem for problem in error.value.messages), error.value.messages


def test_an_impossible_amplitude_in_a_file_is_reported_where_it_is_named(tmp_path):
    (tmp_path / "a.csv").write_text(f"impact_s,amplitude_rad\n0.3,{START}\n", encoding="utf-8")
    study = rb.Study.from_toml(rb.Study.from_dict(tomllike(measured="a.csv")).text, tmp_path / "study.toml")
    (line,) = [number for number, text in enumerate(study.text.splitlines(), 1) if text.startswith("measured")]
    with pytest.raises(InputError, match=rf"study.toml:{line}: .*amplitude 1 is {START:g} rad, not below"):
        rb.release(study)


@pytest.mark.usefixtures("pages")
def test_the_folder_has_the_tables_that_python_returns(tmp_path):
    study = study_of(lists(passages([0.9] * FEW)))
    path = tmp_path / "study.toml"
    path.write_text(study.text, encoding="utf-8")
    result = rb.release(path, tmp_path / "out")
    info = json.loads((tmp_path / "out/release.json").read_text(encoding="utf-8"))
    assert [info[name] for name in ("confidence", "clock", "varied")] == [0.95, "release", []]
    assert not {"impact_s", "amplitude_rad"} & info.keys()  # the table has them
    for name, table in result.tables.items():
        pd.testing.assert_frame_equal(table, read_table(tmp_path / "out" / f"{name}.csv"), check_exact=True)
    assert makers(result.plot) == makers(lambda: result.save(tmp_path / "again")) != set()
    assert result.plot().get_size_inches()[0] == pytest.approx(160.0 / 25.4)


def test_half_cycles_of_a_block_are_those_in_closed_form():
    """1e-7 s: RK4 at the steps of the tolerance."""
    response = rb.simulate(BLOCK, rb.RigidBase(0.9), rb.Motion.still(5.0), initial_rotation_rad=-START, tolerance=1e-8)
    cycles, exact = response.half_cycles, passages([0.9] * IMPACTS)
    np.testing.assert_allclose(cycles.t[1 : IMPACTS + 1], exact.t, atol=1e-7)
    np.testing.assert_allclose(cycles.amplitude[1 : IMPACTS + 1], exact.amplitude, atol=1e-8)
    np.testing.assert_allclose(cycles.apparent_restitution[1:20], 0.9, atol=1e-6)
    np.testing.assert_allclose(cycles.omega_after[1:20] / cycles.omega_before[1:20], 0.9, rtol=1e-12)


@pytest.mark.slow  # the kernel of finite kinematics
def test_half_cycles_on_stiff_springs_tend_to_those_of_the_block():
    stiff = rb.simulate(
        BLOCK, rb.ElasticBase(400, kinematics="finite"), rb.Motion.still(1.0), initial_rotation_rad=START
    ).half_cycles
    assert stiff.t[1] == pytest.approx(quarter(START), abs=2e-3)
    assert (np.sign(stiff.omega_before[1:4]) == [-1.0, 1.0, -1.0][: len(stiff) - 1]).all()


@pytest.mark.usefixtures("pages")
def test_the_page_opens_with_the_value_and_marks_what_puts_it_in_doubt(tmp_path):
    """A test that no value describes, beside one that the model made."""
    exact, wild = lists(passages([0.9] * FEW)), {"amplitude_rad": [0.09, 0.02, 0.07, 0.01, 0.06, 0.005]}
    for name, measured, doubt in (
        ("exact", exact, ""),
        ("wild", wild, "poor: no value describes the test; check size, "),
    ):
        result = rb.release(study_of(measured), tmp_path / name)
        (row,) = result.release.to_dict("records")
        page = (tmp_path / name / "analyses.html").read_text(encoding="utf-8")
        first = page.split('<section id="release">')[1].split("<figure", 1)[0]
        ends = f"(95 %: {row['low']:.4g} to {row['high']:.4g})"
        assert f'<p class="lead">rigid: restitution = {row["value"]:.4g} {ends}, ' in first
        assert ('<span class="undecided">' + doubt in first) == bool(doubt)
        assert ("undecided" in first) == bool(doubt)


def test_the_density_of_ratios_is_that_of_residuals_without_parameters():
    """Given the ratios, whitened least squares; their density is that of contrasts to which the parameters do not matter, times
    the root of its Fisher information (Jeffreys)."""
    random = np.random.default_rng(2)
    kinds, shared = np.repeat([0, 1], 5), True
    by_impact, slopes = random.standard_normal((10, 5)), random.standard_normal((10, 2))
    misses = random.standard_normal(10)
    ratios = np.array([[-3.0, 2.0], [0.5, 0.0], [4.0, -1.0]])
    linear = _Linear(misses, slopes, by_impact, kinds, shared)
    found, centres, scales, freedom, spread = _evaluated(linear, np.array([0, 1]), ratios)
    of_impacts = by_impact @ by_impact.T
    times, contrasts = (kinds == 0).astype(float), null_space(slopes.T)
    read = [np.diag(times) + np.outer(times, times), np.diag(1.0 - times)]
    read = [own * np.diag(of_impacts)[kinds == kind].mean() for kind, own in enumerate(read)]
    logs = []
    for i, ratio in enumerate(ratios):
        parts = [of_impacts, *(math.exp(r) * own for r, own in zip(ratio, read, strict=True))]
        root = np.linalg.cholesky(sum(parts))
        white, seen = np.linalg.solve(root, slopes), np.linalg.solve(root, misses)
        value, (squares,), *_ = np.linalg.lstsq(white, seen, rcond=None)
        assert centres[i] == pytest.approx(value, rel=1e-9)
        errors = np.sqrt(np.diag(np.linalg.inv(white.T @ white)) * squares / 8)
        assert scales[i] == pytest.approx(errors, rel=1e-9)
        assert spread[i] == pytest.approx(math.sqrt(squares / 8), rel=1e-9)  # of the impacts, whose share is 1
        inner = [contrasts.T @ part @ contrasts for part in parts]
        each = [np.linalg.solve(sum(inner), part) for part in inner]
        information = np.array([[np.trace(a @ b) for b in each] for a in each])
        likelihood = -0.5 * np.linalg.slogdet(sum(inner))[1] - 4.0 * math.log(squares)
        logs.append(likelihood + 0.5 * np.linalg.slogdet(information)[1])
    assert freedom == 8
    assert np.diff(found) == pytest.approx(np.diff(logs), rel=1e-8)


def test_each_impact_changes_what_follows_it_as_in_the_closed_form():
    """Central differences over the restitution of one impact at a time; of what was not measured there is no row."""
    each, step, known = np.full(FEW, 0.9), 1e-5, np.arange(2 * FEW) != FEW + 1
    measured = passages(each + 0.01)
    measured.amplitude[1] = math.nan
    linear = _linear(measured, lambda e: passages([e] * FEW), 0.9, (0.05, 1.0))
    ends = [[np.concatenate(passages(each + way * step * unit)) for way in (-1, 1)] for unit in np.eye(FEW)]
    columns = np.column_stack([(after - before)[known] / (2.0 * step) for before, after in ends])
    np.testing.assert_allclose(linear.by_impact, columns, rtol=1e-4, atol=1e-6)
    np.testing.assert_allclose(linear.slopes[:, 0], columns.sum(axis=1), rtol=1e-4, atol=1e-6)
    np.testing.assert_allclose(linear.misses, (np.concatenate(measured) - np.concatenate(passages(each)))[known])
    assert linear.kinds.tolist() == [0] * FEW + [1] * (FEW - 1)


def test_a_quantile_is_that_of_the_mixture():
    posterior = _Posterior(
        np.array([0.3, 0.7]), np.array([[0.0, 5.0], [1.0, -5.0]]), np.array([[0.5, 0.1], [0.2, 3.0]]), 7, np.zeros(2)
    )
    for parameter in (0, 1):
        for share in (0.001, 0.025, 0.5, 0.9, 0.999):
            at = posterior.quantile(share, parameter)
            parts = (at - posterior.centres[:, parameter]) / posterior.scales[:, parameter]
            assert posterior.weights @ student.cdf(parts, 7) == pytest.approx(share, abs=1e-6)
