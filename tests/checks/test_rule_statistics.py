"""Statistics of a suite are those of codes and of order statistics, with what few records leave open."""

import math

import numpy as np
import pytest
from check_samples import judged, runs
from hypothesis import given
from hypothesis import strategies as st
from scipy.stats import binom, nct, norm

from rockbatch.checks import Rule
from rockbatch.common.errors import InputError
from rockbatch.quantities.statistics import STATISTICS, exceedance, quantile, tolerance_rank

INF = math.inf


@pytest.mark.parametrize(
    ("values", "q", "expected"),
    [
        ([4, 1, 3, 2], 0.5, 2.5), ([4, 1, 3, 2], 0.84, 3.52),  # place 2.52 among ranks 0..3
        ([7], 0.84, 7), ([1, 2, INF], 0.5, 2), ([1, 2, INF], 0.84, INF), ([1, INF], 0.5, INF),
        ([*range(56), *[INF] * 45], 0.55, 55),  # 0.55·100 is 55 but for rounding
    ],
)  # fmt: skip
def test_a_quantile_is_linear_between_ranks_and_infinite_at_infinite_ones(values, q, expected):
    assert quantile(np.array(list(values), dtype=float), q) == pytest.approx(expected, rel=1e-12)


@given(
    st.lists(st.floats(0, 1e3), min_size=3, max_size=30),
    st.integers(0, 29),
    st.sampled_from([name for name, kind in STATISTICS.items() if kind.evaluate and not kind.interval]),
    st.floats(0, 1e3),
)
def test_no_statistic_falls_when_a_value_grows(values, index, name, more):
    """Then the bounds of the values give the bounds of the statistic."""
    before = np.array(values)
    after = before.copy()
    after[index % len(after)] += more
    of = STATISTICS[name].evaluate
    assert of(after) >= of(before) * (1 - 1e-12)


@pytest.mark.parametrize(
    ("asked", "expected"),
    [
        ({}, 0.6), ({"statistic": "max"}, 0.6), ({"statistic": "mean"}, 0.3), ({"statistic": "median"}, 0.25),
        ({"statistic": "p84"}, 0.3 + 0.52 * 0.3), ({"statistic": "count", "above": 0.2}, 2),
    ],
)  # fmt: skip
def test_a_statistic_over_the_records_is_what_a_hand_computes(asked, expected):
    assert judged(runs([0.1, 0.2, 0.6, 0.3]), **asked).value == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("least", [3, 7, 12])
def test_a_check_may_ask_for_more_records_than_its_code_does(least):
    one = Rule("tilt", "theta_max_over_alpha", at_most=0.3, statistic="en1998-1", least=least)
    assert one.least == least
    with pytest.raises(InputError, match=r"^least = 2: EN 1998-1 asks for 3; leave it out"):
        Rule("tilt", "theta_max_over_alpha", at_most=0.3, statistic="en1998-1", least=2)


@pytest.mark.parametrize(
    ("count", "value", "verdict", "note"),
    [
        (7, 0.4, "pass", ""),
        (6, 0.6, "fail", "most unfavourable of fewer than 7"),
        (2, 0.2, "not decided", "2 stations count, EN 1998-1 asks for 3"),
    ],
)
def test_en1998_takes_the_mean_of_seven_records_and_the_worst_of_fewer(count, value, verdict, note):
    """0.1, 0.2 … : the mean of seven is 0.4, the greatest of six 0.6."""
    table = runs(np.arange(1, count + 1) / 10, theta_max_error=0.0)
    found = judged(table, statistic="en1998-1")
    assert (found.value, found.verdict) == (pytest.approx(value), verdict)
    assert note in found.note
    assert bool(note) == bool(found.note)


@pytest.mark.parametrize(("n", "percent"), [(5, 27), (7, 24), (11, 22), (100, 17)])
def test_a_quantile_between_ranks_says_how_many_further_records_exceed_it(n, percent):
    """Uniform values: the k-th of n is k/(n + 1) in the mean, 0.84 (n − 1) + 1 the rank between them."""
    drawn = np.sort(np.random.default_rng(n).random((200_000, n)), axis=1)
    place = 0.84 * (n - 1)
    k = min(int(place), n - 2)
    quantiles = drawn[:, k] + (place - k) * (drawn[:, k + 1] - drawn[:, k])
    assert exceedance(0.84, n) == pytest.approx(1.0 - quantiles.mean(), abs=2e-3)
    found = judged(runs(np.linspace(0.1, 0.2, n), theta_max_error=0.0), statistic="p84")
    assert found.verdict == ("not decided" if n < 6 else "pass")
    assert f"between the ranks of {n}, which {percent} % of further records exceed" in found.note
    assert ("5 stations count, the 84 % quantile asks for 6" in found.note) is (n == 5)


def test_a_quantile_of_few_records_that_is_beyond_the_limit_has_failed():
    assert judged(runs([0.6] * 5), statistic="p84").verdict == "fail"


def test_the_rank_that_holds_a_quantile_is_that_of_the_binomial_distribution():
    """1 − 0.84^n of the greatest; of 30 and 100, scipy's distribution."""
    assert (tolerance_rank(17), tolerance_rank(18)) == (None, 18)
    assert 1.0 - 0.84**17 < 0.95 <= 1.0 - 0.84**18
    for n in (18, 29, 30, 59, 100):
        (least,) = [k for k in range(1, n + 1) if binom.cdf(k - 1, n, 0.84) >= 0.95 > binom.cdf(k - 2, n, 0.84)]
        assert tolerance_rank(n) == least
    values = np.random.default_rng(0).permutation(np.arange(1, 31)) / 100
    found = judged(runs(values, theta_max_error=0.0), statistic="p84_95")
    assert (found.value, found.note) == (tolerance_rank(30) / 100, f"rank {tolerance_rank(30)} of 30")
    few = judged(runs(values[:17]), statistic="p84_95")
    assert (few.verdict, few.note.split("; ")[0]) == (
        "not decided",
        "17 stations count, the 84 % quantile with 95 % confidence asks for 18",
    )


def test_the_rank_is_below_the_quantile_in_one_of_twenty_suites_at_most():
    rng, n = np.random.default_rng(5), 25
    ranked = np.sort(rng.random((100_000, n)), axis=1)[:, tolerance_rank(n) - 1]
    held = binom.cdf(tolerance_rank(n) - 1, n, 0.84)
    assert (ranked >= 0.84).mean() == pytest.approx(held, abs=3e-3)
    assert held >= 0.95


def test_a_lognormal_quantile_has_the_interval_of_a_normal_tolerance_limit():
    """m + z s with z = 0.994458, and (m + z σ − x̄) √n/s of a non-central t distribution."""
    theta = np.array([0.1, 0.13, 0.12, 0.2, 0.17, 0.09, 0.15])
    logs, n = np.log(theta), len(theta)
    found = judged(runs(theta, theta_max_error=0.0), statistic="p84_lognormal")
    m, s = logs.mean(), logs.std(ddof=1)
    assert found.value == pytest.approx(math.exp(m + norm.ppf(0.84) * s), rel=1e-9)
    ends = nct.ppf([0.025, 0.975], n - 1, norm.ppf(0.84) * math.sqrt(n)) / math.sqrt(n)
    assert (found.low, found.high) == pytest.approx(tuple(np.exp(m + ends * s)), rel=1e-6)
    for limit, verdict in ((found.high, "pass"), (found.value, "not decided"), (0.99 * found.low, "fail")):
        assert judged(runs(theta, theta_max_error=0.0), statistic="p84_lognormal", at_most=limit).verdict == verdict


def test_the_interval_of_a_lognormal_quantile_covers_it_in_95_of_100_suites():
    rng, n = np.random.default_rng(7), 7
    interval = STATISTICS["p84_lognormal"].interval
    suites = np.exp(rng.normal(-1.0, 0.5, (2000, n)))
    truth = math.exp(-1.0 + norm.ppf(0.84) * 0.5)
    covered = np.mean([low <= truth <= high for low, high in (interval(v, v, v) for v in suites)])
    assert covered == pytest.approx(0.95, abs=0.015)  # three standard errors


@given(st.lists(st.floats(0.01, 10), min_size=3, max_size=12), st.floats(0, 0.3), st.randoms(use_true_random=False))
def test_the_interval_of_a_lognormal_quantile_holds_between_the_bounds(listed, error, random):
    values = np.array(listed)
    interval = STATISTICS["p84_lognormal"].interval
    low, high = interval(values, values * (1 - error), values * (1 + error))
    within = values * np.array([1 + error * random.choice((-1, 0, 1)) for _ in listed])
    inner_low, inner_high = interval(within, within, within)
    assert low <= inner_low * (1 + 1e-9)
    assert inner_high <= high * (1 + 1e-9)


def test_no_lognormal_distribution_has_records_that_demand_nothing():
    found = judged(runs([0.0, 0.1, 0.2, 0.3]), statistic="p84_lognormal")
    assert (found.verdict, math.isnan(found.value)) == ("not decided", True)
    assert "a record demands nothing, which no lognormal distribution has" in found.note
    fallen = judged(runs([0.1, 0.2, 0.3], status=["ok", "ok", "overturned"]), statistic="p84_lognormal")
    assert (fallen.verdict, fallen.value) == ("fail", INF)
    unknown = judged(runs([0.1, 0.2, 0.3], status=["ok", "ok", "failed"]), statistic="p84_lognormal")
    assert (unknown.verdict, unknown.high) == ("not decided", INF)


def eleven(**cells):
    """0.1 … 1.1: mean and median 0.6."""
    return runs(np.arange(1, 12) / 10, **cells)


def test_asce7_takes_the_mean_of_eleven_records_and_decides_nothing_on_ten():
    assert judged(eleven(), statistic="asce7-16", at_most=0.61).value == pytest.approx(0.6)
    assert judged(eleven(), statistic="asce7-16", at_most=0.61).verdict == "pass"
    ten = judged(eleven()[:10], statistic="asce7-16", at_most=10.0)
    assert ten.verdict == "not decided"
    assert "10 stations count, ASCE 7-16 asks for 11" in ten.note
    assert judged(eleven()[:10], statistic="asce7-16", at_most=0.5).verdict == "fail"  # 0.55


@pytest.mark.parametrize("status", ["overturned", "flight", "failed"])
def test_asce7_replaces_the_mean_when_one_response_is_unacceptable_and_fails_on_two(status):
    """Without the smallest, 0.1, the median of eleven rises from 0.6 to 0.7, and 1.2 · 0.7 exceeds the mean 0.65."""
    one = judged(eleven(status=[status, *["ok"] * 10]), statistic="asce7-16", at_most=1.0)
    assert one.value == pytest.approx(0.84)
    assert one.verdict == "pass"
    assert "120 % of the median" in one.note
    assert "which Risk Categories I and II alone may have" in one.note
    assert one.counted == f"1 {status} (infinite)"
    two = judged(eleven(status=[status, status, *["ok"] * 9]), statistic="asce7-16", at_most=1e6)
    assert (two.value, two.verdict) == (INF, "fail")
    assert "2 unacceptable responses" in two.note


def test_asce7_never_falls_below_the_mean_of_the_acceptable():
    """Nine of 0.1, one of 2 and one overturned: 1.2 · median is 0.12, the mean of the ten 0.29."""
    table = runs([*[0.1] * 9, 2.0, 0.1], status=[*["ok"] * 10, "overturned"])
    assert judged(table, statistic="asce7-16").value == pytest.approx(0.29)


def test_an_unknown_response_is_no_unacceptable_one_under_asce7():
    """The settlement by the other law is missing in one run: nothing is decided. The mean is 0.21/11 at least."""
    table = runs([0.1] * 11, settlement_m=0.01, settlement_other_law_m=[math.nan, *[0.02] * 10])
    found = judged(table, demand="settlement_m", statistic="asce7-16", other_law=True, at_most=1.0)
    assert (found.verdict, found.low, found.high) == ("not decided", pytest.approx(0.21 / 11), INF)
