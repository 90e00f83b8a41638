"""Each run of a suite counts once, in the suite of its case and scale, and what is missing is said."""

import math

import pandas as pd
import pytest
from check_samples import case, judged, runs

from rockbatch.checks import Rule, judge
from rockbatch.common.errors import InputError
from rockbatch.pier import YieldingBase
from rockbatch.quantities.rows import rows_of_cases

INF = math.inf


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
    assert ('0.2 is below 0.01 of the limit: check its unit, or write confirm = ["at_most"]' in verdict.note) is noted


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
