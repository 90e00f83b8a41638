"""RotD50 and RotD100: against another solver of the oscillator turned by brute force, and closed forms of polarised motion."""

import itertools
import math
from dataclasses import replace

import numpy as np
import pytest
from motion_files import wiggle, write_at2
from scipy.linalg import expm
from studies import RIGID, study_text, write_study

import rockbatch as rb
from rockbatch.common.errors import InputError
from rockbatch.motions import Motion, MotionSet, read_motions
from rockbatch.motions.intensity.pairs import common_samples, station_spectra
from rockbatch.motions.spectrum import responses, spectral_acceleration
from rockbatch.motions.suites.design_spectra import TableSpectrum
from rockbatch.motions.suites.scaling import Target, at_target
from rockbatch.motions.suites.spectrum_target import PAIRS, SpectrumTarget
from rockbatch.study import load_study
from rockbatch.study.suite import ground_motions

PERIODS = np.array([0.25, 0.6, 1.3, 2.7])


def component(seed, azimuth=None, name=None, npts=1200, size=3.0, station="S", **more):
    return Motion(name or f"m{seed}", 0.01, size * wiggle(npts, seed), azimuth=azimuth, station=station, **more)


def exact_peak(acceleration, dt, period, damping):
    """ω² max|u| by the exponential of the system matrix of u, u̇, a and ȧ, which is exact for straight accelerations."""
    omega = 2.0 * math.pi / period
    system = np.zeros((4, 4))
    system[0, 1], system[1], system[2, 3] = 1.0, [-(omega**2), -2.0 * damping * omega, -1.0, 0.0], 1.0
    step = expm(system * dt)
    state, most = np.zeros((2, *acceleration.shape[1:])), 0.0
    for a, b in itertools.pairwise(acceleration):
        state = (step @ np.stack([*state, a, (b - a) / dt]))[:2]
        most = np.maximum(most, np.abs(state[0]))
    return omega**2 * most


def brute_force(first, second, dt, period, damping=0.05, angles=range(180)):
    turned = np.outer(first, np.cos(np.radians(angles))) + np.outer(second, np.sin(np.radians(angles)))
    return exact_peak(turned, dt, period, damping)


def test_rotd_is_that_of_another_solver_turned_by_brute_force():
    a, b = component(1, npts=300), component(2, npts=300)
    found = rb.pair_spectrum(a, b, [0.3, 0.8], 0.07)
    for period in (0.3, 0.8):
        peaks = brute_force(a.horizontal, b.horizontal, 0.01, period, 0.07)
        row = found.loc[period] * 9.81
        assert row["rotd50_g"] == pytest.approx(np.median(peaks), rel=1e-9)
        assert row["rotd100_g"] == pytest.approx(max(peaks), rel=1e-9)
        assert (row["first_g"], row["second_g"]) == (
            pytest.approx(peaks[0], rel=1e-9),
            pytest.approx(peaks[90], rel=1e-9),
        )
        assert row["srss_g"] == pytest.approx(math.hypot(peaks[0], peaks[90]), rel=1e-9)
        assert row["geomean_g"] == pytest.approx(math.sqrt(peaks[0] * peaks[90]), rel=1e-9)


def test_histories_have_the_peaks_of_the_spectrum_also_where_samples_are_added():
    a = component(3).horizontal
    periods = [0.03, 0.1, 0.5, 3.0]
    peaks = [np.abs(u).max() for u in responses(a, 0.01, periods)]
    np.testing.assert_allclose(peaks, spectral_acceleration(a, 0.01, periods), rtol=1e-12)


@pytest.mark.parametrize("direction", [0, 30, 73])
def test_motion_along_one_line_has_a_median_of_one_over_the_root_of_two(direction):
    line = 3.0 * wiggle(1200, 4)
    a, b = (Motion(n, 0.01, line * f(math.radians(direction))) for n, f in (("a", math.cos), ("b", math.sin)))
    found = rb.pair_spectrum(a, b, PERIODS)
    alone = Motion("line", 0.01, line).spectrum(PERIODS)
    np.testing.assert_allclose(found["rotd100_g"], alone, rtol=1e-12)
    np.testing.assert_allclose(found["rotd50_g"], alone / math.sqrt(2.0), rtol=1e-12)


def test_motion_in_a_circle_has_the_steady_state_in_all_directions():
    t = np.arange(16000) * 0.01
    rising = 0.5 - 0.5 * np.cos(np.pi * np.clip(t / 100.0, 0.0, 1.0))  # slowly: no transient is above the steady state
    a, b = (Motion(n, 0.01, rising * f(2.0 * math.pi * t)) for n, f in (("a", np.cos), ("b", np.sin)))
    found = rb.pair_spectrum(a, b, [1.4], 0.05)
    r, zeta = 1.4, 0.05  # forcing over natural frequency
    steady = 1.0 / math.sqrt((1.0 - r**2) ** 2 + (2.0 * zeta * r) ** 2) / 9.81
    assert float(found["rotd100_g"].iloc[0]) == pytest.approx(steady, rel=2e-3)
    assert float((found["rotd100_g"] / found["rotd50_g"]).iloc[0]) == pytest.approx(1.0, abs=1e-3)
    assert float((found["srss_g"] / found["rotd100_g"]).iloc[0]) == pytest.approx(math.sqrt(2.0), rel=1e-3)


@pytest.mark.parametrize("angle", [37.0, 12.3])
def test_turning_the_instrument_changes_neither(angle):
    """Exactly so by whole degrees; by others directions lie within half a degree of each other."""
    first, second = real_pair()
    a, b = common_samples(first, second)
    c, s = math.cos(math.radians(angle)), math.sin(math.radians(angle))
    turned = [Motion("t", first.dt, c * a + s * b), Motion("u", first.dt, c * b - s * a)]
    before, after = rb.pair_spectrum(first, second, PERIODS), rb.pair_spectrum(*turned, PERIODS)
    half = 0.0 if angle.is_integer() else math.radians(0.5)
    np.testing.assert_allclose(after["rotd100_g"], before["rotd100_g"], rtol=half**2 / 2.0 + 1e-10)
    np.testing.assert_allclose(after["rotd50_g"], before["rotd50_g"], rtol=half + 1e-10)
    assert not np.allclose(after["geomean_g"], before["geomean_g"], rtol=1e-2)


def real_pair():
    motions = read_motions("motions/near_fault")
    return motions["CHAN15"], motions["CHAN24"]


def test_the_measures_stand_in_their_order():
    found = rb.pair_spectrum(*real_pair())
    assert len(found) == 101
    assert (found["rotd50_g"] <= found["rotd100_g"]).all()
    assert (found[["first_g", "second_g"]].max(axis=1) <= found["rotd100_g"] * (1 + 1e-12)).all()
    assert (found["rotd100_g"] <= found["srss_g"] * (1 + 1e-12)).all()


# What is a pair


def test_pairs_are_brought_to_their_common_time():
    a, b = component(1, 0.0, start=100.0), component(2, 90.0, npts=1150, start=100.3)
    first, second = common_samples(a, b)
    np.testing.assert_array_equal(first, a.horizontal[30:1180])
    np.testing.assert_array_equal(second, b.horizontal)
    first, second = common_samples(replace(a, start=None), b)
    assert len(first) == len(second) == 1150
    np.testing.assert_array_equal(first, a.horizontal[:1150])


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"azimuth": 40.0}, "m1 and m2 are 40° apart, not square to each other"),
        ({"azimuth": 91.5}, "are 91.5° apart"),
        ({"dt": 0.02}, "are sampled at 0.01 s and 0.02 s"),
        ({"dt": 0.0100005}, "are sampled at 0.01 s and 0.0100005 s"),
        ({"start": 100.005}, "start 0.50 samples apart"),
        ({"start": 500.0}, "have no time in common"),
    ],
)
def test_what_is_no_pair_is_refused_with_the_reason(change, said):
    a, b = component(1, 0.0, start=100.0), component(2, 90.0, start=100.0)
    with pytest.raises(InputError, match=said):
        rb.pair_spectrum(a, replace(b, **change))


def test_bad_arguments_are_answered():
    a, b = component(1), component(2)
    with pytest.raises(InputError, match="second = 3: must be a Motion"):
        rb.pair_spectrum(a, 3)
    with pytest.raises(InputError, match="period = -1: must be a number above 0"):
        rb.pair_spectrum(a, b, [-1.0])
    with pytest.raises(InputError, match="damping = 1: must be within"):
        rb.pair_spectrum(a, b, [1.0], 1.0)


def test_of_many_directions_the_first_two_that_are_square_make_the_pair():
    a, b = real_pair()
    whole = common_samples(a, b)
    many = [
        Motion(
            f"az{k}",
            a.dt,
            math.cos(math.radians(k)) * whole[0] + math.sin(math.radians(k)) * whole[1],
            azimuth=float(k),
        )
        for k in range(0, 180, 30)
    ]
    found = station_spectra(many, PERIODS, 0.05)["rotd100"]
    np.testing.assert_allclose(found, rb.pair_spectrum(a, b, PERIODS)["rotd100_g"] * 9.81, rtol=1e-9)


def test_the_step_of_the_pair_counts_not_that_of_the_first_motion():
    a, b = component(1, 0.0), component(2, 90.0)
    other = Motion("coarse", 0.02, a.horizontal[::2], azimuth=0.0, station="S")
    found = station_spectra([other, a, b], PERIODS, 0.05)
    for rule, values in station_spectra([a, b], PERIODS, 0.05).items():
        np.testing.assert_array_equal(found[rule], values)


# Targets of pairs

TABLE = TableSpectrum((0.1, 0.5, 2.0, 6.0), (0.8, 0.9, 0.3, 0.05))


def suite():
    pairs = [component(seed, 90.0 * (seed % 2), size=100.0) for seed in range(2, 8)]
    return [replace(motion, station=f"S{i // 2}") for i, motion in enumerate(pairs)]


@pytest.mark.sweep(fast=1)
@pytest.mark.parametrize("rule", ["geomean", "rotd50", "rotd100"])
def test_a_suite_is_fitted_by_the_spectra_of_its_pairs(rule):
    target = SpectrumTarget(TABLE, (0.3, 3.0), "each", rule)
    scaled = at_target(MotionSet(suite()), target, 9.81).motions
    means = []
    for first, second in zip(scaled[::2], scaled[1::2], strict=True):
        assert first.factor == second.factor
        found = rb.pair_spectrum(first, second, target.periods)[f"{rule}_g"].to_numpy()
        assert np.log(found / TABLE.at(target.periods)).mean() == pytest.approx(0.0, abs=1e-10)
        means.append(found)
    described = target.run_json_entry(scaled, 9.81)
    np.testing.assert_allclose(described["mean_sa_g"], np.mean(means, axis=0), rtol=1e-4)
    assert (described["pairs"], described["alone"]) == (rule, 0)
    third = component(9, 45.0, size=100.0, station="S0")
    assert target.run_json_entry([*scaled, third], 9.81)["alone"] == 0  # two of the three are square to each other
    np.testing.assert_allclose(TABLE.at(np.array([0.1, 6.0, 0.09, 6.1])), [0.8, 0.05, np.nan, np.nan], rtol=1e-12)
    whole = at_target(MotionSet(suite()), replace(target, factors="suite", at_least=0.9), 9.81).motions
    mean = target.mean(whole, target.periods, 9.81)
    assert (mean / TABLE.at(target.periods)).min() == pytest.approx(0.9)


def test_maximum_directions_ask_for_lesser_factors_than_medians():
    factors = {
        rule: SpectrumTarget(TABLE, (0.3, 3.0), "each", rule).factors_of(suite(), 9.81)[0]
        for rule in ("rotd50", "rotd100", "srss")
    }
    assert factors["srss"] < factors["rotd100"] < factors["rotd50"]
    assert SpectrumTarget(TABLE, (0.3, 3.0), pairs="rotd100").share == 0.9


def test_a_component_without_its_other_one_is_unusable_and_says_what_to_write():
    lone = [*suite(), component(9, size=100.0, station="T")]
    target = SpectrumTarget(TABLE, (0.3, 3.0), "each", "rotd100")
    found = at_target(MotionSet(lone), target, 9.81)
    assert len(found.motions) == 6
    (reason,) = [each.reason for each in found.unusable]
    assert reason.startswith(
        'no pair for pairs = "rotd100": its station has one horizontal component, and two are needed'
    )
    assert 'write pairs = "apart"' in reason
    assert found.motions[0].factor == pytest.approx(target.factors_of(suite(), 9.81)[0])


def test_one_period_of_pairs_is_met_by_both_components_together():
    target = Target(sa_g=0.5, period_s=1.0, pairs="rotd50")
    scaled = at_target(MotionSet(suite()), target, 9.81).motions
    for first, second in zip(scaled[::2], scaled[1::2], strict=True):
        assert float(rb.pair_spectrum(first, second, [1.0])["rotd50_g"].iloc[0]) == pytest.approx(0.5)
    assert "of RotD50 = 0.5 g" in str(target)
    with pytest.raises(InputError, match=r'pairs = "rotd50": must be one of .* and is for sa_g'):
        Target(pga_g=0.5, pairs="rotd50")


# From the study file


def study(folder, target, **motions):
    for name, seed, size in (
        ("RSN1_A_000", 1, 1.0),
        ("RSN1_A_090", 2, 0.7),
        ("RSN2_B_000", 3, 1.4),
        ("RSN2_B_090", 4, 1.0),
    ):
        _, station, azimuth = name.split("_")
        title = f"Made-up, 1/17/1994, Station {station}, {azimuth}"
        write_at2(folder / "records", f"{name}.AT2", 4.0 * size * wiggle(800, seed), title=title)
    text = study_text(motions={"path": "records", "target": target, **motions}, pulses=(), cases=[RIGID])
    return load_study(write_study(folder, text))


SPECTRUM = {"spectrum": [[0.1, 0.8], [3.0, 0.2]], "period_range_s": [0.2, 2.0], "factors": "each", "pairs": "rotd100"}


def test_turned_to_the_axis_a_record_has_the_factor_of_its_pair(tmp_path):
    as_recorded = ground_motions(study(tmp_path, SPECTRUM))
    made = study(tmp_path, SPECTRUM, axis_deg=33)
    turned = ground_motions(made)
    assert [motion.name for motion in turned.motions] == ["RSN1_A_az033", "RSN2_B_az033"]
    for motion, other in zip(turned.motions, as_recorded.motions[::2], strict=True):
        assert motion.factor == pytest.approx(other.factor, rel=1e-9)
        assert motion.npts == other.npts
    first, second = (target.run_json_entry(turned.motions, 9.81)["mean_sa_g"] for target in [made.motions.target] * 2)
    assert first == second
    assert np.isfinite(first).all()
    assert turned.motions[0].times(2.0).across == pytest.approx(2.0 * turned.motions[0].across)


SETTINGS = [
    {},
    {"axis_deg": 0},
    {"axis_deg": 30},
    {"every_deg": 90},
    {"every_deg": 30},
    {"every_deg": 15},
    {"every_deg": 20},
]
"""Directions to which records are turned; none of those of the last are square to each other."""


def by_hand(rule, peaks, axis_deg=None, every_deg=None):
    """Return the spectral accelerations that count of a station by those in all directions, a degree apart from 0 on."""
    directions = [0, 90] if every_deg is None else range(0, 180, every_deg)
    first = 0
    if axis_deg is not None:
        directions, first = [axis_deg], axis_deg
    if rule == "apart":
        return [peaks[direction] for direction in directions]
    pair = peaks[first], peaks[first + 90]
    of_pair = {"srss": math.hypot(*pair), "geomean": math.sqrt(pair[0] * pair[1])}
    return [{**of_pair, "rotd50": np.median(peaks), "rotd100": peaks.max()}[rule]]


@pytest.mark.sweep(fast=2)
@pytest.mark.parametrize("setting", SETTINGS, ids=str)
def test_what_a_pair_is_does_not_depend_on_the_directions_that_are_run(tmp_path, setting):
    """Each rule against a solver of another kind that turns the recorded components, the factor of the suite being
    max(at_least · target/mean)."""
    recorded = ground_motions(study(tmp_path, SPECTRUM | {"factors": "none"})).motions
    periods = np.geomspace(0.5, 0.54, 5)  # a hundred a decade
    stations = [
        np.array([brute_force(a.horizontal, b.horizontal, a.dt, period) for period in periods])
        for a, b in zip(recorded[::2], recorded[1::2], strict=True)
    ]
    for rule, share in PAIRS.items():
        keys = SPECTRUM | {"factors": "suite", "pairs": rule, "period_range_s": [0.5, 0.54]}
        made = study(tmp_path, keys, **setting)
        found = ground_motions(made)
        counted = np.concatenate([np.transpose([by_hand(rule, row, **setting) for row in peaks]) for peaks in stations])
        target = np.exp(np.interp(np.log(periods), np.log([0.1, 3.0]), np.log([0.8, 0.2])))
        factor = (share * target / (np.mean(counted, axis=0) / 9.81)).max()
        assert (found.unusable, {motion.station for motion in found.motions}) == ([], {"RSN1", "RSN2"})
        np.testing.assert_allclose([motion.factor for motion in found.motions], factor, rtol=1e-9)
        assert rule == "apart" or made.motions.target.run_json_entry(found.motions, 9.81)["alone"] == 0
        directions = {"axis_deg": 1, "every_deg": len(range(0, 180, setting.get("every_deg", 90)))}
        assert len(found.motions) == 2 * directions.get(next(iter(setting), ""), 2)  # no more than are asked for


def test_components_that_have_no_time_in_common_have_a_root_of_the_sum_of_squares():
    """Of three of a station, the first two that are square to each other; two that are not make no pair."""
    a, b = component(1, 0.0, start=0.0), component(2, 90.0, start=1e4)
    target = SpectrumTarget(TABLE, (0.3, 3.0), "none", "srss")
    own = [spectral_acceleration(motion.horizontal, 0.01, target.periods) / 9.81 for motion in (a, b)]
    np.testing.assert_allclose(target.mean([a, b], target.periods, 9.81), np.hypot(*own), rtol=1e-12)
    between = component(3, 45.0)
    np.testing.assert_allclose(target.mean([a, between, b], target.periods, 9.81), np.hypot(*own), rtol=1e-12)
    np.testing.assert_allclose(target.mean([a, between], target.periods, 9.81), own[0], rtol=1e-12)
    assert [target.run_json_entry(motions, 9.81)["alone"] for motions in ([a, b], [a, between])] == [0, 1]


@pytest.mark.parametrize(("file", "table"), [("study.toml", "motions.sequence"), ("records/motions.toml", "sequence")])
def test_a_sequence_that_is_turned_keeps_its_pair(tmp_path, file, table):
    folder = study(tmp_path, SPECTRUM, axis_deg=33).motions.paths[0].parent
    with (folder / file).open("a") as written:
        written.write(
            f'\n[[{table}]]\nname = "both"\nrecords = ["RSN1_A_az033", "RSN2_B_az033"]\npause_s = 10.0\nalone = true\n'
        )
    motions = ground_motions(load_study(folder / "study.toml"))
    (joined,) = [motion for motion in motions if motion.name == "both"]
    single = {motion.name: motion for motion in motions}["RSN2_B_az033"]
    end = joined.across[-single.npts :]
    np.testing.assert_allclose(end, single.across / single.factor * joined.factor, rtol=1e-9, atol=1e-12)
    assert joined.npts == len(joined.across)


def test_a_sequence_named_as_a_turned_record_stays(tmp_path):
    folder = study(tmp_path, {"pga_g": 0.3}, axis_deg=33).motions.paths[0]
    with (tmp_path / "study.toml").open("a") as file:
        file.write('\n[output]\nintensity = true\nsa_periods_s = [0.3]\nsa_pairs = ["rotd50"]\n')
    (folder / "motions.toml").write_text(
        '[[sequence]]\nname = "both_az123"\nrecords = ["RSN1_A_az033", "RSN2_B_az033"]\npause_s = 10.0\nalone = true\n'
    )
    motions = ground_motions(load_study(tmp_path / "study.toml"))
    lacking = {motion.name: motion.across is None for motion in motions}
    assert lacking == {"RSN1_A_az033": False, "RSN2_B_az033": False, "both_az123": False}


def test_the_single_measure_takes_pairs_too(tmp_path):
    found = ground_motions(study(tmp_path, {"sa_g": 0.4, "period_s": 0.5, "pairs": "rotd100"}))
    a, b = found.motions[:2]
    assert float(rb.pair_spectrum(a, b, [0.5])["rotd100_g"].iloc[0]) == pytest.approx(0.4, rel=1e-3)


@pytest.mark.parametrize(
    ("target", "said"),
    [
        ({"pga_g": 0.4, "pairs": "rotd50"}, "pairs: is for sa_g only; leave it out"),
        ({"sa_g": 0.4, "period_s": 1.0, "pairs": "srss"}, 'pairs = "srss": expected one of'),
        (SPECTRUM | {"pairs": "rotd"}, 'pairs = "rotd": did you mean "rotd50"'),
    ],
)
def test_mistakes_about_pairs_are_answered(tmp_path, target, said):
    with pytest.raises(InputError, match=said):
        study(tmp_path, target)
