"""Nothing that went wrong passes unnoticed: runs that overturned, flew, failed or were never run."""

import math

import pandas as pd
import pytest
from check_samples import case, judged, runs
from studies import study_text, write_study

from rockbatch.checks import Rule, judge
from rockbatch.common.errors import InputError
from rockbatch.pier import RigidBase
from rockbatch.study import load_study

INF = math.inf


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
def test_a_median_says_nothing_of_records_beyond_it_unless_a_check_does(status):
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


@pytest.mark.parametrize(("at_most", "verdicts"), [(2, ["pass", "pass"]), (3, ["pass", "not decided"])])
def test_a_number_that_all_records_may_have_decides_nothing(at_most, verdicts):
    table = runs([0.1, 0.2, 0.3], status=["ok", "ok", "overturned"])
    median = Rule("median", "theta_max_over_alpha", 0.5, statistic="median")
    assert with_count(table, median, at_most=at_most) == verdicts
    found = judged(table, demand="overturned", statistic="count", at_most=3)
    assert found.note == "3 stations count, and the check allows 3, so that it decides nothing"
    twice = judged(runs([0.6, 0.7]), statistic="count", above=0.5, at_most=2)
    assert (twice.value, twice.verdict) == (2, "not decided")


@pytest.mark.parametrize("asked", [
    {"at_most": 1}, {"at_most": 1, "statistic": "mean"}, {"at_most": 0, "above": 1, "statistic": "count"},
])  # fmt: skip
def test_a_limit_of_an_event_that_nothing_exceeds_is_refused_until_it_is_confirmed(tmp_path, asked):
    table = runs([0.1, 0.2, 0.3], status="overturned")
    key = "above" if "above" in asked else "at_most"
    with pytest.raises(
        InputError, match=f'is 0 or 1 for every record, so that nothing exceeds 1; .* confirm = \\["{key}"'
    ):
        judge([Rule("none", "overturned", **asked)], table, [case()], doubted=True)
    assert judge([Rule("none", "overturned", **asked, confirm=(key,))], table, [case()], doubted=True)
    with pytest.raises(InputError, match="nothing exceeds 1"):
        load_study(
            write_study(tmp_path, study_text(check=[{"name": "x", "demand": "overturned", "reason": "r"} | asked]))
        )


def test_a_check_of_other_cases_or_scales_says_nothing_of_this_one():
    median = Rule("median", "theta_max_over_alpha", 0.5, statistic="median")
    fallen = runs([0.1, 0.2, 0.3], status=["ok", "ok", "overturned"])
    scales = pd.concat([runs([0.1, 0.2, 0.3]), fallen.assign(scale=2.0)])
    assert with_count(scales, median, scale=(2.0,)) == ["pass", "pass", "pass"]
    assert with_count(scales, median, scale=(1.0,)) == ["pass", "pass", "not decided"]


def test_the_one_response_that_asce_allows_is_allowed_to_other_checks_too():
    table = runs([0.1] * 11, status=["overturned", *["ok"] * 10])
    rules = [Rule(name, "theta_max_over_alpha", 0.5, statistic=name) for name in ("asce7-16", "median")]
    assert [found.verdict for found in judge(rules, table, [case()])] == ["pass", "pass"]
    assert judge(rules[1:], table, [case()])[0].verdict == "not decided"
    no_settlement = Rule("s", "settlement_m", 0.5, statistic="asce7-16")
    rigid = [found.verdict for found in judge([no_settlement, rules[1]], table, [case(base=RigidBase())])]
    assert rigid == ["does not apply", "not decided"]


def test_a_run_that_a_stronger_motion_would_overturn_is_one_that_may_overturn():
    table = runs([0.1, 0.2, 0.3], may_overturn=[0, 0, 1])
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
