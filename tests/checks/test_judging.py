"""Design checks decide as an engineer would by hand, and nothing that went wrong passes unnoticed."""

import math
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from check_samples import ELASTIC, PADS, case, judged, runs
from hypothesis import given
from hypothesis import strategies as st
from scipy.stats import binom, nct, norm

from rockbatch.checks import Rule, judge
from rockbatch.checks.bounds import of_runs
from rockbatch.common.errors import InputError
from rockbatch.common.notes import OVERTURNS
from rockbatch.pier import ElasticBase, RigidBase, YieldingBase
from rockbatch.quantities.arrays import Rows
from rockbatch.quantities.catalogue import COLUMNS, DEMANDS, IN_MOTION, IN_MOTION_ERROR
from rockbatch.quantities.statistics import STATISTICS, exceedance, quantile, tolerance_rank
from rockbatch.results.rows import rows_of_cases

INF = math.inf


# Suites


def test_each_case_has_the_rows_with_its_values_in_their_order():
    rows = [("a", 40.0, "5"), ("b", 40.0, "finite"), ("a", 40.00000000001, "5"), ("a", math.nan, "5"), ("b", 40.0, "5")]
    table = pd.DataFrame(rows, columns=["case", "beta", "n"])[["n", "beta", "case"]].iloc[[0, 1, 2, 3, 4, 0]]
    table.index = range(6)
    asked = [
        ("a", {"beta": 40.0}),
        ("a", {"n": 5.0}),
        ("b", {"beta": 40.0, "n": "finite"}),
        ("b", {}),
        ("c", {"beta": 1.0}),
    ]
    cases = [case(name=name) | {"columns": columns} for name, columns in asked]
    chosen = [rows.tolist() for _, rows in rows_of_cases(table, cases)]
    assert chosen == [[0, 2, 5], [0, 2, 3, 5], [1], [1, 4], []]


def test_a_record_of_which_only_the_mirror_image_is_there_is_one_whose_run_is_missing():
    table = runs([0.1, 0.2, 0.3], mirror_of=["", "", "+"])
    table["polarity"] = ["+", "+", "-"]
    found = judged(table)
    assert (found.runs, found.counted, found.verdict) == (3, "1 not run (unknown)", "not decided")


@pytest.mark.parametrize(
    ("limit", "confirm", "noted"), [(20.0, (), False), (21.0, (), True), (21.0, ("at_most",), False)]
)
def test_a_limit_that_no_run_comes_near_is_noted_unless_it_is_confirmed(limit, confirm, noted):
    verdict = judged(runs([0.1, 0.2]), at_most=limit, confirm=confirm)
    assert verdict.verdict == "pass"
    assert ('0.2 is below 0.01 of the limit; check its unit, or write confirm = ["at_most"]' in verdict.note) is noted


def test_a_record_counts_once_with_the_worse_of_its_polarities():
    table = pd.concat([runs([0.1, 0.4]), runs([0.3, 0.2], polarity="-")])
    both = judged(table, statistic="mean")
    assert (both.value, both.records, both.runs) == (pytest.approx(0.35), 2, 4)


def test_of_mirror_images_each_run_counts_once():
    table = pd.concat([runs([0.1, 0.4], mirror_of=""), runs([0.1, 0.4], polarity="-", mirror_of="+")])
    found = judged(table, statistic="mean")
    assert (found.value, found.records, found.runs) == (pytest.approx(0.25), 2, 2)


def test_where_one_station_is_not_known_each_component_counts():
    found = judged(runs([0.1, 0.2, 0.3], station=["a", "", "a"]), statistic="mean")
    assert (found.records, found.count, found.value) == (3, "component", pytest.approx(0.2))
    assert "do not say which components are of one station" in found.note


def test_a_polarity_that_is_missing_for_one_record_is_a_run_that_failed():
    table = pd.concat([runs([0.1, 0.4]), runs([0.3, 0.2], polarity="-")])[:3]
    assert judged(table).counted == "1 not run (unknown)"


def test_every_scale_is_a_suite_of_its_own():
    table = pd.concat([runs([0.1, 0.3]), runs([0.5, 0.7], scale=1.5)])
    found = judge([Rule("check", "theta_max_over_alpha", 0.5, statistic="mean")], table, [case()])
    assert [(each.scale, each.value, each.verdict) for each in found] == [
        (1.0, pytest.approx(0.2), "pass"),
        (1.5, pytest.approx(0.6), "fail"),
    ]
    assert judged(table, scale=(1.5,)).scale == 1.5


def test_cases_of_one_name_are_distinguished_by_their_varied_values_as_peaks_csv_writes_them():
    """Ten digits of a number; and a word."""
    thirds = [
        case(base=YieldingBase(beta=b, eta=2.5), beta=b, spring=s)
        for b in (100 / 3, 200 / 3)
        for s in ("bouc-wen", "epp")
    ]
    table = pd.concat(
        runs([theta], beta=beta, spring=spring)
        for theta, beta, spring in (
            (0.1, 33.33333333, "bouc-wen"),
            (0.2, 33.33333333, "epp"),
            (0.3, 66.66666667, "bouc-wen"),
            (0.4, 66.66666667, "epp"),
        )
    )
    found = judge([Rule("check", "theta_max_over_alpha", 0.5)], table, thirds)
    assert [each.value for each in found] == [0.1, 0.2, 0.3, 0.4]


def test_a_rule_can_choose_its_cases_by_name_or_pattern():
    names = ["soft", "stiff 1", "stiff 2", "pads [2]"]
    table = pd.concat(runs([0.1], name) for name in names)
    rules = [Rule("some", "theta_max_over_alpha", 0.5, case=("stiff*", "pads [2]"))]
    assert [each.case for each in judge(rules, table, [case(name) for name in names])] == names[1:]


def test_rows_of_files_that_could_not_be_used_are_in_no_suite():
    unusable = runs([math.nan], "", record="notes", status="failed")
    assert judged(pd.concat([runs([0.1]), unusable])).counted == ""


def test_what_a_rule_chooses_and_the_results_do_not_have_is_reported_at_once():
    rules = [
        Rule("a", "theta_max_over_alpha", 0.5, case=("pad",), scale=(2.0,)),
        Rule("b", "settlement_m", 0.5, other_law=True),
    ]
    with pytest.raises(InputError) as caught:
        judge(rules, runs(), [case()])
    case_, scale, law = caught.value.messages
    assert 'check "a": case = "pad"' in case_
    assert 'did you mean "pads"?' in case_
    assert "scale = 2: the motions are scaled by 1 only" in scale
    assert "both_laws = true" in law


def test_a_table_without_runs_is_refused():
    with pytest.raises(InputError, match="no run to check"):
        judge([Rule("a", "theta_max_over_alpha", 0.5)], runs()[:0], [case()])


# Statistics


@pytest.mark.parametrize(
    ("values", "q", "expected"),
    [
        ([4, 1, 3, 2], 0.5, 2.5), ([4, 1, 3, 2], 0.84, 3.52),  # place 2.52 among ranks 0..3
        ([7], 0.84, 7), ([1, 2, INF], 0.5, 2), ([1, 2, INF], 0.84, INF), ([1, INF], 0.5, INF),
        ([*range(56), *[INF] * 45], 0.55, 55),  # 0.55·100 is 55 but for rounding
    ],
)  # fmt: skip
def test_a_quantile_is_linear_between_ranks_and_infinite_where_it_needs_an_infinite_rank(values, q, expected):
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


# Quantiles of few records


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
def test_the_interval_of_a_lognormal_quantile_holds_for_all_values_between_the_bounds(listed, error, random):
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
    assert one.counted == f"1 {status} (infinite)"
    two = judged(eleven(status=[status, status, *["ok"] * 9]), statistic="asce7-16", at_most=1e6)
    assert (two.value, two.verdict) == (INF, "fail")
    assert "2 unacceptable responses" in two.note


def test_asce7_never_falls_below_the_mean_of_the_acceptable():
    """Nine of 0.1, one of 2 and one overturned: 1.2 · median is 0.12, the mean of the ten 0.29."""
    table = runs([*[0.1] * 9, 2.0, 0.1], status=[*["ok"] * 10, "overturned"])
    assert judged(table, statistic="asce7-16").value == pytest.approx(0.29)


def test_a_response_that_is_unknown_does_not_pass_for_an_unacceptable_one_under_asce7():
    """The settlement by the other law is missing in one run: nothing is decided. The mean is 0.21/11 at least."""
    table = runs([0.1] * 11, settlement_m=0.01, settlement_other_law_m=[math.nan, *[0.02] * 10])
    found = judged(table, demand="settlement_m", statistic="asce7-16", other_law=True, at_most=1.0)
    assert (found.verdict, found.low, found.high) == ("not decided", pytest.approx(0.21 / 11), INF)


# Runs that did not go through


@pytest.mark.parametrize(
    ("status", "way", "value", "verdict", "records"),
    [
        ("overturned", "infinite", INF, "fail", 3), ("overturned", "unknown", 0.4, "not decided", 3),
        ("overturned", "value", 0.4, "not decided", 3),
        ("overturned", "left out", 0.2, "not decided", 2),
        ("flight", "infinite", INF, "fail", 3), ("flight", "unknown", 0.4, "not decided", 3),
        ("flight", "value", 0.4, "not decided", 3),
        ("flight", "left out", 0.2, "not decided", 2), ("failed", "infinite", INF, "fail", 3),
        ("failed", "unknown", 0.2, "not decided", 3),  # what has not settled is no lower bound
        ("failed", "value", 0.4, "not decided", 3), ("failed", "left out", 0.2, "not decided", 2),
    ],
)  # fmt: skip
def test_a_run_that_did_not_go_through_counts_as_the_rule_says_and_is_reported(status, way, value, verdict, records):
    table = runs([0.1, 0.2, 0.4], status=["ok", "ok", status])
    found = judged(table, **{status: way})
    assert (found.value, found.verdict, found.records, found.runs) == (value, verdict, records, 3)
    assert found.counted == f"1 {status} ({way})"
    assert f"{status}: {way}" in found.counting or way in found.counting


@pytest.mark.parametrize(
    ("status", "verdict"), [("overturned", "fail"), ("flight", "not decided"), ("failed", "not decided")]
)
def test_by_default_nothing_that_went_wrong_can_pass(status, verdict):
    for statistic in ("max", "mean", "p84"):
        found = judged(runs([0.1, 0.2, 0.1], status=["ok", "ok", status]), statistic=statistic, at_most=1e9)
        assert found.verdict == verdict


ENDS = {
    "overturned": "1 of 3 stations overturns the pier",
    "flight": "1 of 3 stations has a run that flight ended",
    "failed": "1 of 3 stations has a run that failed or is missing",
}


def with_count(table, *rules, at_most=1, **more):
    """Return the verdicts of ``rules`` and of a check on how many records may overturn the pier, or whatever its demand is."""
    asked = {"demand": "overturned", "statistic": "count", "at_most": at_most} | more
    return [found.verdict for found in judge([*rules, Rule("how many", **asked)], table, [case()])]


@pytest.mark.parametrize("status", ENDS)
def test_a_median_says_nothing_of_the_records_beyond_it_unless_a_check_says_how_many_may_be(status):
    table = runs([0.1, 0.2, 0.3], status=["ok", "ok", status], flight_s=[math.nan, math.nan, 3.0])
    found = judged(table, statistic="median")
    known = 0.1 if status == "failed" else 0.2  # what has not settled may be anything
    assert (found.value, found.low, found.high, found.verdict) == (known, known, 0.2, "not decided")
    told = f'{ENDS[status]}, and no check says how many may: add a [[check]] with demand = "{status}" and statistic = "count"'
    assert found.note.startswith(told)
    median = Rule("median", "theta_max_over_alpha", 0.5, statistic="median")
    assert with_count(table, median, demand=status) == ["pass", "pass"]
    assert with_count(table, median, demand=status, at_most=0) == ["pass", "fail"]
    other = "failed" if status == "overturned" else "overturned"
    assert with_count(table, median, demand=other)[0] == "not decided"
    assert with_count(table, median, demand=status, scale=(1.0,)) == ["pass", "pass"]


def test_a_check_of_other_cases_or_scales_says_nothing_of_this_one():
    median = Rule("median", "theta_max_over_alpha", 0.5, statistic="median")
    fallen = runs([0.1, 0.2, 0.3], status=["ok", "ok", "overturned"])
    scales = pd.concat([runs([0.1, 0.2, 0.3]), fallen.assign(scale=2.0)])
    assert with_count(scales, median, scale=(2.0,)) == ["pass", "pass", "pass"]
    assert with_count(scales, median, scale=(1.0,)) == ["pass", "pass", "not decided"]


def test_the_one_unacceptable_response_that_asce_allows_is_allowed_to_the_other_checks_too():
    table = runs([0.1] * 11, status=["overturned", *["ok"] * 10])
    rules = [Rule(name, "theta_max_over_alpha", 0.5, statistic=name) for name in ("asce7-16", "median")]
    assert [found.verdict for found in judge(rules, table, [case()])] == ["pass", "pass"]
    assert judge(rules[1:], table, [case()])[0].verdict == "not decided"
    no_settlement = Rule("s", "settlement_m", 0.5, statistic="asce7-16")
    rigid = [found.verdict for found in judge([no_settlement, rules[1]], table, [case(base=RigidBase())])]
    assert rigid == ["does not apply", "not decided"]


def test_a_run_that_a_stronger_motion_would_overturn_is_one_that_may_overturn():
    table = runs([0.1, 0.2, 0.3], note=["", "", f"chaotic: a motion a hair stronger {OVERTURNS}"])
    found = judged(table, statistic="median")
    assert (found.verdict, found.note.partition(",")[0]) == ("not decided", "1 of 3 stations may overturn the pier")
    median = Rule("median", "theta_max_over_alpha", 0.5, statistic="median")
    assert with_count(table, median) == ["pass", "pass"]


def test_what_belongs_to_the_case_is_decided_whatever_its_runs_come_to():
    table = runs([0.1, 0.2, 0.3], status=["ok", "ok", "overturned"])
    rules = [Rule("eta", "eta", at_least=2.0), Rule("median", "theta_max_over_alpha", 0.5, statistic="median")]
    assert [found.verdict for found in judge(rules, table, [case()])] == ["pass", "not decided"]


def test_what_flew_beyond_the_limit_has_failed_whatever_came_after():
    table = runs([0.1, 0.6], status=["ok", "flight"])
    assert judged(table).verdict == "fail"
    assert judged(table.assign(status=["ok", "failed"])).verdict == "not decided"


def test_a_residual_says_nothing_before_the_end_of_a_run():
    """Unlike a peak, it is no lower bound; and a run that flew has none."""
    table = runs([0.1, 0.1], status=["ok", "flight"], theta_res_over_alpha=[0.01, math.nan])
    found = judged(table, demand="theta_res_over_alpha")
    assert (found.value, found.high, found.verdict) == (0.01, INF, "not decided")
    assert judged(table, demand="theta_res_over_alpha", flight="value").verdict == "not decided"
    assert judged(table, demand="theta_res_over_alpha", flight="infinite").verdict == "fail"


def test_a_count_of_records_is_bounded_by_those_that_are_unknown():
    table = runs([0.1, 0.6, 0.1], status=["ok", "ok", "flight"])
    found = judged(table, statistic="count", above=0.5, at_most=1)
    assert (found.low, found.high, found.verdict) == (1, 2, "not decided")
    exceeding = Rule("check", "theta_max_over_alpha", 2, statistic="count", above=0.5)
    assert with_count(table, exceeding, demand="flight") == ["pass", "pass"]
    sunk = judged(runs([0.1], settlement_m=0.02), demand="settlement_m", statistic="count", above=0.01, at_most=2)
    assert (sunk.value, sunk.unit) == (1.0, "")


def test_a_run_that_is_missing_is_one_that_failed():
    """As after an interrupt: the record is planned, and its row is not there."""
    found = judged(runs([0.1, 0.2]), records=["r0", "r1", "r2"])
    assert (found.verdict, found.records, found.counted) == ("not decided", 3, "1 not run (unknown)")
    left_out = judged(runs([0.1, 0.2]), records=["r0", "r1", "r2"], failed="left out")
    assert (left_out.verdict, left_out.records, left_out.value) == ("not decided", 2, 0.2)


def test_a_case_of_which_nothing_was_run_is_not_decided():
    first, second = judge([Rule("check", "theta_max_over_alpha", 0.5)], runs(), [case(), case("other")])
    assert (first.verdict, second.verdict) == ("fail", "not decided")
    assert second.counted == "4 not run (unknown)"


def test_nothing_is_decided_where_all_is_left_out():
    found = judged(runs([0.1], status="failed"), failed="left out")
    assert (found.verdict, found.records, found.note) == ("not decided", 0, "0 stations count; no error estimate")


# Errors


@pytest.mark.parametrize(
    ("theta", "error", "verdict"),
    [(0.48, 0.01, "pass"), (0.49, 0.02, "not decided"), (0.51, 0.02, "not decided"), (0.53, 0.02, "fail")],
)
def test_an_error_that_straddles_the_limit_decides_nothing(theta, error, verdict):
    found = judged(runs([0.1, theta], theta_max_error=[0.0, error]))
    assert found.verdict == verdict
    assert (found.low, found.high) == (pytest.approx(theta - error), pytest.approx(theta + error))


def test_the_error_of_a_mean_is_the_mean_of_the_errors():
    found = judged(runs([0.2, 0.4], theta_max_error=[0.01, 0.03]), statistic="mean")
    assert (found.low, found.value, found.high) == tuple(map(pytest.approx, (0.28, 0.3, 0.32)))


def test_a_demand_without_an_error_estimate_says_so():
    assert judged(runs([0.1])).note == "no error estimate"
    assert judged(runs([0.1], theta_max_error=1e-6)).note == ""


@pytest.mark.parametrize(("own", "other"), [(0.04, 0.06), (0.06, 0.04)])
def test_of_two_spring_laws_a_check_takes_the_worse_and_says_so(own, other):
    table = runs([0.1], settlement_m=own, settlement_other_law_m=other)
    found = judged(table, demand="settlement_m", at_most=0.05)
    assert (found.verdict, found.low, found.value, found.high, found.governing) == ("fail", 0.06, 0.06, 0.06, 0.06)
    assert f"the worse of two spring laws counts: {own} by that of the case, {other} by the other" in found.note
    assert judged(table, demand="settlement_m", at_most=0.06, other_law=True).verdict == "pass"


def test_springs_that_do_not_creep_have_one_settlement():
    """An earlier version ran Bouc–Wen springs beside them."""
    table = runs([0.1], settlement_m=0.01, settlement_other_law_m=0.06)
    found = judged(table, one=case(base=replace(PADS, spring="epp")), demand="settlement_m", at_most=0.05)
    assert (found.verdict, found.value, "two spring laws" in found.note) == ("pass", 0.01, False)
    without = table.drop(columns="settlement_other_law_m")
    asked = judged(
        without, one=case(base=replace(PADS, spring="epp")), demand="settlement_m", at_most=0.05, other_law=True
    )
    assert asked.verdict == "pass"


def test_without_the_other_spring_law_nothing_passes_where_the_rule_asks_for_it():
    table = runs([0.1], settlement_m=0.04, settlement_other_law_m=math.nan)
    assert judged(table, demand="settlement_m", at_most=0.05).verdict == "pass"
    found = judged(table, demand="settlement_m", at_most=0.05, other_law=True)
    assert (found.verdict, found.low, found.high) == ("not decided", 0.04, INF)
    assert "by the other 1 of the runs did not go through" in found.note
    fell = runs([0.1, 9.0], settlement_m=0.04, settlement_other_law_m=math.nan, status=["ok", "overturned"])
    assert "by the other 1 of the runs did not" in judged(fell, demand="settlement_m", at_most=0.05).note
    elastic = runs([0.1], "elastic", settlement_m=0.0, settlement_other_law_m=math.nan)
    assert judged(elastic, one=ELASTIC, demand="settlement_m", at_most=0.05, other_law=True).verdict == "pass"


def test_ratio_and_margin_are_the_distance_to_the_limit():
    found = judged(runs([0.6]))
    assert (found.ratio, found.margin) == (pytest.approx(1.2), pytest.approx(-0.1))
    found = judged(runs([0.6]), demand="eta", at_least=2.0)
    assert (found.ratio, found.margin) == (pytest.approx(0.8), pytest.approx(0.5))
    none, one = (judged(runs([0.6], flight_s=t), demand="flight", at_most=0) for t in (math.nan, 3.0))
    assert (none.ratio, one.ratio, one.margin) == (0.0, INF, -1.0)


# Rules


@pytest.mark.parametrize(
    ("asked", "problem"),
    [
        ({"demand": "theta_max"}, 'demand = "theta_max": did you mean "theta_max_rad" or "theta_max_over_alpha"?'),
        ({"demand": "curvature"}, 'demand = "curvature": expected one that `rockbatch check --list` lists'),
        ({"statistic": "average"}, 'statistic = "average": did you mean "mean"?'),
        ({"flight": "ignore"}, 'flight = "ignore": expected one of "infinite"'),
        ({"at_most": None}, "at_most is missing"),
        ({"at_least": 0.1}, "at_least: given beside at_most"),
        ({"at_most": None, "at_least": 0.1}, "at_least = 0.1: more of theta_max_over_alpha is worse; write at_most"),
        ({"at_most": math.nan}, "at_most = nan: must be a finite number"),
        ({"statistic": "count"}, "above is missing"),
        ({"above": 0.1}, 'above: is for statistic = "count"'),
        ({"demand": "eta", "statistic": "mean"}, "statistic: eta is the same for all records"),
        ({"demand": "flight", "overturned": "unknown"}, "overturned: says nothing about flight"),
        ({"demand": "flight", "statistic": "asce7-16"}, "flight is yes or no"),
        ({"statistic": "asce7-16", "failed": "left out"}, "failed: is unacceptable by ASCE 7-16"),
        ({"other_law": True}, "other_law: is for settlement_m and toe_settlement_m"),
    ],
)
def test_a_rule_that_makes_no_sense_is_refused_with_what_to_write(asked, problem):
    with pytest.raises(InputError) as caught:
        Rule(**({"name": "check", "demand": "theta_max_over_alpha", "at_most": 0.5} | asked))
    assert any(problem in each for each in caught.value.messages)


def test_a_rule_says_in_words_what_it_asks_and_how_it_counts():
    rule = Rule("a", "theta_max_over_alpha", 1, statistic="count", above=0.5, failed="left out")
    assert rule.words == "number of records with theta_max_over_alpha above 0.5"
    assert rule.counting == "overturned: infinite; flight: unknown; failed: left out"
    assert Rule("a", "flight", 0, statistic="count").words == "number of records with flight"
    assert (Rule("a", "eta", at_least=2).words, Rule("a", "eta", at_least=2).counting) == ("eta", "")


CHAOTIC = "the peak is chaotic, a motion 1e-08 weaker moves it by 2.4e-03 rad: no error of it is claimed"
FALLS = "the peak is chaotic, a motion 1e-08 weaker overturns the pier: no error of it is claimed"


@pytest.mark.parametrize(
    ("theta", "verdict"), [(0.2, "pass"), (0.3, "not decided"), (0.9, "not decided"), (1.1, "fail")]
)
def test_a_chaotic_peak_is_known_to_a_factor_of_2_and_is_said(theta, verdict):
    """0.3 α may be 0.6 α under a motion that no record tells from this one, and 0.9 α 0.45 α; the limit is 0.5 α."""
    found = judged(runs([0.1, theta], theta_max_error=[1e-6, None], note=["", CHAOTIC]))
    assert (found.verdict, found.low, found.high) == (verdict, pytest.approx(theta / 2), pytest.approx(2 * theta))
    assert "1 run is chaotic, and is known to a factor of 2" in found.note


def test_an_event_of_a_chaotic_run_is_one_and_not_known_to_a_factor():
    table = runs([0.1, 0.3], theta_max_error=None, note=CHAOTIC, flight_s=[math.nan, 2.0])
    found = judged(table, demand="flight", statistic="mean", at_most=0.5)
    assert (found.verdict, found.low, found.high) == ("pass", 0.5, 0.5)


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize(
    "base", [PADS, replace(PADS, spring="epp"), ElasticBase(50.0), RigidBase()], ids=lambda b: b.name
)
def test_the_bounds_of_any_demand_hold_its_value_and_those_of_an_event_are_yes_or_no(base, seed):
    rng, n = np.random.default_rng(seed), 40
    cells = {
        name: rng.choice([1.0, np.nan], n, p=[0.7, 0.3]) * rng.uniform(0.0, 0.01 if "error" in name else 1.0, n)
        for name, column in COLUMNS.items()
        if column.kind != "text"
    }
    cells[IN_MOTION] = np.where(np.isnan(cells[IN_MOTION_ERROR]), np.nan, rng.uniform(0.0, 1.0, n))
    cells["status"] = rng.choice(["ok", "ok", "overturned", "flight", "failed"], n)
    cells["note"] = rng.choice(["", CHAOTIC, FALLS, "the residuals are chaotic"], n)
    plain = runs(rng.uniform(0.0, 1.2, n)).drop(columns=cells, errors="ignore")
    suite = Rows(pd.concat([plain, pd.DataFrame(cells)], axis=1))
    for name, demand in DEMANDS.items():
        if demand.per_case or demand.needs == "sections" or (demand.bases and base.name not in demand.bases):
            continue
        bounds, counting = of_runs(Rule("check", name, 0.5), suite, case(base=base))
        value, low, high = (part[counting] for part in bounds[:3])
        assert (low <= value).all(), name
        assert (value <= high).all(), name
        assert not demand.event or set(low) | set(value) | set(high) <= {0.0, 1.0}, name


def test_chaotic_residuals_leave_the_demands_on_a_peak_that_converged_as_they_are():
    table = runs([0.1], theta_max_error=1e-6, ductility_left=2.0, ductility_right=1.0, settlement_m=0.02,
                 note="the residuals are chaotic, a motion 1e-08 off moves them: no error of them is claimed")  # fmt: skip
    pads = case(base=replace(PADS, spring="epp"))
    found = judged(table, one=pads, demand="ductility", at_most=3.0)
    assert (found.verdict, found.high) == ("pass", 2.0)
    assert (settled := judged(table, one=pads, demand="settlement_m", at_most=0.03)).verdict == "not decided"
    assert settled.high == 0.04


@pytest.mark.parametrize(("demand", "limit"), [("overturned", 0.0), ("theta_max_over_alpha", 0.85)])
def test_a_pier_that_overturns_under_a_motion_a_hair_weaker_passes_nothing(demand, limit):
    found = judged(runs([0.1, 0.3], theta_max_error=[1e-6, None], note=["", FALLS]), demand=demand, at_most=limit)
    assert found.verdict == "not decided"
    assert judged(runs([0.1, 0.3], theta_max_error=1e-6), demand=demand, at_most=limit).verdict == "pass"
