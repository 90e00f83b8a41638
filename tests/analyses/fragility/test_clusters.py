"""Curves of records that share stations: against Student's interval of station means, an analysis of variance, made-up suites."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
import scipy.stats

from rockbatch.analyses.fragility.cloud import _design_effect
from rockbatch.analyses.fragility.clusters import clusters
from rockbatch.analyses.fragility.statistics import capacities, cloud, stripes
from rockbatch.common.errors import InputError

STATIONS = np.repeat(np.arange(7), 2)


def correlated(rng, stations=7, components=2, rho=0.6):
    shared = np.repeat(rng.standard_normal(stations), components)
    return math.sqrt(rho) * shared + math.sqrt(1 - rho) * rng.standard_normal(stations * components)


def exactly(x, **more):
    return capacities(x * (1 - 1e-5), x * (1 + 1e-5), **more)


def test_of_a_record_a_station_median_and_dispersion_are_those_of_the_sample():
    """Student's interval of the mean of ln x, and the standard deviation with n − 1; 2e-3: the region between two of 360 rays."""
    logs = 0.4 * np.random.default_rng(1).standard_normal(8)
    curve = exactly(np.exp(logs))
    assert curve.dispersion == pytest.approx(logs.std(ddof=1), rel=1e-6)
    assert curve.most_likely_dispersion == pytest.approx(logs.std(), rel=1e-6)
    expected = scipy.stats.t.interval(0.95, 7, logs.mean(), logs.std(ddof=1) / math.sqrt(8))
    assert np.log(curve.median_interval) == pytest.approx(expected, abs=2e-3 * logs.std())


def test_of_pairs_the_interval_is_students_of_the_means_of_stations():
    logs = 0.4 * correlated(np.random.default_rng(2))
    means = logs.reshape(7, 2).mean(axis=1)
    expected = scipy.stats.t.interval(0.95, 6, means.mean(), means.std(ddof=1) / math.sqrt(7))
    found = np.log(exactly(np.exp(logs), stations=STATIONS).median_interval)
    assert found == pytest.approx(expected, abs=0.01 * means.std())


def test_of_pairs_the_square_of_the_dispersion_is_that_of_an_analysis_of_variance():
    """Half of the mean squares between stations and within them, each unbiased."""
    logs = 0.4 * correlated(np.random.default_rng(3)).reshape(7, 2)
    between = 2 * logs.mean(axis=1).var(ddof=1)
    within = ((logs - logs.mean(axis=1)[:, None]) ** 2).sum() / 7
    curve = exactly(np.exp(logs.ravel()), stations=STATIONS)
    assert curve.dispersion**2 == pytest.approx((between + within) / 2, rel=1e-6)


def test_a_line_through_pairs_has_the_scatter_of_stations():
    """Of pairs at one intensity a station, Student's slope of the line through the means, 5 degrees of freedom; 1000 draws."""
    rng = np.random.default_rng(4)
    log_x = np.repeat(rng.normal(0.0, 0.5, 7), 2)
    log_d = 1.2 * log_x + 0.4 * correlated(rng)
    means, at = log_d.reshape(7, 2).mean(axis=1), log_x[::2]
    line = scipy.stats.linregress(at, means)
    drawn = cloud(np.exp(log_x), np.exp(log_d), 1.0, stations=STATIONS).line.draws
    assert scipy.stats.kstest((drawn[:, 1] - line.slope) / line.stderr, scipy.stats.t(5).cdf).statistic < 0.06


@pytest.mark.parametrize("of_a_station", [1, 2, 5])
def test_draws_of_a_share_are_wider_by_what_records_of_a_station_have_in_common(of_a_station):
    """Of n equal records each of k stations the variance is n k/(k − 2) times that of independent ones, and of no others smaller;
    Student's quantile stands in place of the normal one, but for records that are each of a station by itself.
    """
    station = np.repeat(np.arange(7), of_a_station)
    student = (scipy.stats.t(6).ppf(0.975) / scipy.stats.norm.ppf(0.975)) ** 2
    of_stations = np.random.default_rng(3).standard_normal(7)
    equal = _design_effect(np.repeat(of_stations, of_a_station), station)
    assert equal == pytest.approx(of_a_station * 7 / 5 * student if of_a_station > 1 else 1.0, rel=1e-12)
    signs = np.resize([1.0, -1.0], of_a_station)
    opposite = _design_effect(np.outer(of_stations, signs - signs.mean()).ravel() + 1e-9, station)
    assert opposite == pytest.approx(student if of_a_station > 1 else 1.0, rel=1e-12)


@pytest.mark.parametrize("stations", ["ABCDEFG", range(7)])
def test_stations_are_told_apart_by_any_names(stations):
    logs = 0.4 * correlated(np.random.default_rng(5))
    named = exactly(np.exp(logs), stations=np.repeat(list(stations), 2))
    assert named.median_interval == exactly(np.exp(logs), stations=STATIONS).median_interval


def test_below_five_stations_there_is_no_interval_and_below_three_no_curve():
    x = np.exp(0.4 * correlated(np.random.default_rng(6), 4))
    for curve in (
        exactly(x, stations=[1, 1, 2, 2, 3, 3, 4, 4]),
        cloud(x, x**1.3 * x[::-1] ** 0.2, 1.0, stations=2 * [1, 2, 3, 4]),
    ):
        assert (curve.median_interval, curve.dispersion_interval, curve.band(np.array([1.0]))) == (None, None, None)
        assert np.isnan(curve.rate(np.array([1.0]), np.array([0.1]))[1:]).all()
    with pytest.raises(InputError, match="records of 2 stations: a curve takes 3, and an interval 5"):
        exactly(x, stations=4 * [1, 2])
    with pytest.raises(InputError, match="records of 1 station"):
        stripes([0.8, 1.0, 1.2], x[:, None] <= [0.8, 1.0, 1.2], stations=8 * ["A"])


@pytest.mark.slow
@pytest.mark.parametrize("rho", [pytest.param(0.0, marks=pytest.mark.thorough), 0.8])
def test_intervals_by_station_hold_the_truth_as_often_as_they_say(rho):
    """120 suites of seven pairs by brackets, stripes and a cloud: 95 % less three deviations of 2 %."""
    rng, levels = np.random.default_rng(7), np.exp(0.4 * np.linspace(-2, 2, 7))
    held, count = np.zeros(3), np.zeros(3)
    for _ in range(120):
        x, im = np.exp(0.4 * correlated(rng, rho=rho)), np.exp(0.6 * np.repeat(rng.standard_normal(7), 2))
        for n, fit in enumerate(
            (
                lambda x, im: exactly(x, stations=STATIONS),
                lambda x, im: stripes(levels, x[:, None] <= levels, stations=STATIONS),
                lambda x, im: cloud(im, (im / x) ** 1.2, 1.0, stations=STATIONS),
            )
        ):
            try:
                low, high = fit(x, im).median_interval
            except InputError:
                continue
            count[n] += 1
            held[n] += low <= 1.0 <= high
    assert (count > 110).all()
    assert (held / count > 0.89).all()


def motions(events, stations):
    return [
        SimpleNamespace(stations=(station,), origin=SimpleNamespace(event=event))
        for event, station in zip(events, stations, strict=True)
        for _ in range(2)
    ]


@pytest.mark.parametrize(
    ("events", "kind", "groups"),
    [
        ("AABBCCDDEE", "event", 5),
        ("AABBCCDDDD", "station", 10),
        ("AAAAAAAAAA", "station", 10),
        ("ABCDEFGHIJ", "station", 10),
        (["A", "A", "B", "B", "C", "C", "D", "D", "E", ""], "station", 10),
    ],
)
def test_records_count_by_earthquake_where_five_are_known_and_else_by_station(events, kind, groups):
    found = clusters(motions(events, "abcdefghij"))
    assert (found.kind, len(np.unique(found.of_motion)), found.stations) == (kind, groups, 10)
    assert found.events == (0 if "" in list(events) else len(set(events)))


def test_sequences_that_share_a_station_are_one_cluster():
    """Main shock and aftershock of two stations, in any order, are one pair of readings; a chain of three is one, too."""
    shocks = ["ab", "ba", "c", "de", "ef", "fg", "h", "c"]
    found = clusters([SimpleNamespace(stations=tuple(sorted(s)), origin=SimpleNamespace(event="")) for s in shocks])
    assert found.of_motion.tolist() == [0, 0, 1, 2, 2, 2, 3, 1]
    assert (found.kind, found.stations) == ("station", 4)
