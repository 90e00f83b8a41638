"""Design checks decide as an engineer would by hand, within the errors of their demands."""

import math
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from check_samples import PADS, case, judged, runs, verdict

from rockbatch.checks import Rule, wording
from rockbatch.checks.bounds import of_runs
from rockbatch.common.errors import InputError
from rockbatch.pier import ElasticBase, RigidBase
from rockbatch.quantities.arrays import Rows
from rockbatch.quantities.catalogue import COLUMNS, DEMANDS, FACTS
from rockbatch.quantities.limits import IN_MOTION, IN_MOTION_ERROR

INF = math.inf


# Errors


@pytest.mark.parametrize(
    ("theta", "error", "verdict"),
    [(0.48, 0.01, "pass"), (0.49, 0.02, "not decided"), (0.51, 0.02, "not decided"), (0.53, 0.02, "fail")],
)
def test_an_error_that_straddles_the_limit_decides_nothing(theta, error, verdict):
    found = judged(runs([0.1, theta], theta_max_error=[0.0, error]))
    assert found.verdict == verdict
    assert (found.low, found.high) == (pytest.approx(theta - error), pytest.approx(theta + error))


@pytest.mark.parametrize(("limit", "verdict", "record"), [(0.5, "not decided", "r1"), (0.6, "pass", "r0")])
def test_a_limit_between_the_bounds_is_governed_by_the_run_that_may_exceed_it(limit, verdict, record):
    found = judged(runs([0.45, 0.44], theta_max_error=[0.01, 0.08]), at_most=limit)
    assert (found.verdict, found.record) == (verdict, record)


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
    assert f"the worse of two spring laws counts: {own} by the law of the case, {other} by the other" in found.note
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
    assert "1 run did not go through by the other law" in found.note
    fell = runs([0.1, 9.0], settlement_m=0.04, settlement_other_law_m=math.nan, status=["ok", "overturned"])
    assert "1 run did not go through by the other law" in judged(fell, demand="settlement_m", at_most=0.05).note
    plastic = case(base=replace(PADS, spring="epp"))  # of one law
    assert judged(table, one=plastic, demand="settlement_m", at_most=0.05, other_law=True).verdict == "pass"


def test_results_without_the_other_law_are_refused_only_by_a_rule_that_asks_for_it():
    table = runs([0.1], settlement_m=0.04).drop(columns="settlement_other_law_m", errors="ignore")
    assert judged(table, demand="settlement_m", at_most=0.05).verdict == "pass"
    with pytest.raises(InputError, match=r"no settlement_m by the other law; write both_laws = true"):
        judged(table, demand="settlement_m", at_most=0.05, other_law=True)


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
        ({"demand": "overturned", "statistic": "median"}, 'overturned is yes or no; write "max" or "count" or "mean"'),
        ({"demand": "failed", "statistic": "p84"}, 'failed is yes or no; write "max" or "count" or "mean"'),
        ({"statistic": "asce7-16", "failed": "left out"}, "failed: is unacceptable by ASCE 7-16"),
        ({"other_law": True}, "other_law: is for settlement_m and toe_settlement_m"),
    ],
)
def test_a_rule_that_makes_no_sense_is_refused_with_what_to_write(asked, problem):
    with pytest.raises(InputError) as caught:
        Rule(**({"name": "check", "demand": "theta_max_over_alpha", "at_most": 0.5} | asked))
    assert any(problem in each for each in caught.value.messages)


def test_a_run_without_an_error_among_others_is_no_estimate():
    """As where runs of a fixed step are joined with others."""
    joined = runs([0.1, 0.2], theta_max_error=[1e-6, math.nan], chaotic=0.0)
    assert judged(joined).note == "no error estimate"
    assert judged(joined.assign(theta_max_error=1e-6)).note == ""
    assert judged(joined.assign(status=["ok", "failed"]), failed="left out", at_most=0.15).omits == ()


def test_a_rule_says_in_words_what_it_asks_and_how_it_counts():
    rule = Rule("a", "theta_max_over_alpha", 1, statistic="count", above=0.5, failed="left out")
    assert rule.words == "number of records with theta_max_over_alpha above 0.5"
    assert rule.counting == "overturned: infinite; flight: unknown; failed: left out"
    assert Rule("a", "flight", 0, statistic="count").words == "number of records with flight"
    assert (Rule("a", "eta", at_least=2).words, Rule("a", "eta", at_least=2).counting) == ("eta", "")


@pytest.mark.parametrize(
    ("theta", "verdict"), [(0.2, "pass"), (0.3, "not decided"), (0.9, "not decided"), (1.1, "fail")]
)
def test_a_chaotic_peak_is_known_to_a_factor_of_2_and_is_said(theta, verdict):
    """0.3 α may be 0.6 α under a motion that no record tells from this one, and 0.9 α 0.45 α; the limit is 0.5 α."""
    found = judged(runs([0.1, theta], theta_max_error=[1e-6, None], chaotic=[0, 1]))
    assert (found.verdict, found.low, found.high) == (verdict, pytest.approx(theta / 2), pytest.approx(2 * theta))
    assert "1 run is chaotic, and is known to a factor of 2" in found.note


def test_an_event_of_a_chaotic_run_is_one_and_not_known_to_a_factor():
    table = runs([0.1, 0.3], theta_max_error=None, chaotic=1, flight_s=[math.nan, 2.0])
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
    cells |= {name: rng.choice([0.0, 1.0, np.nan], n) for name in FACTS}
    plain = runs(rng.uniform(0.0, 1.2, n)).drop(columns=cells, errors="ignore")
    suite = Rows(pd.concat([plain, pd.DataFrame(cells)], axis=1))
    for name, demand in DEMANDS.items():
        if demand.per_case or demand.in_section or (demand.bases and base.name not in demand.bases):
            continue
        rule = Rule("check", name, 0.5, capacity=9e3 if demand.over_capacity else None)
        bounds, counting, *_ = of_runs(rule, suite, case(base=base))
        value, low, high = (part[counting] for part in bounds[:3])
        assert (low <= value).all(), name
        assert (value <= high).all(), name
        assert not demand.event or set(low) | set(value) | set(high) <= {0.0, 1.0}, name


def test_chaotic_residuals_leave_the_demands_on_a_peak_that_converged_as_they_are():
    table = runs([0.1], theta_max_error=1e-6, ductility_left=2.0, ductility_right=1.0, settlement_m=0.02, chaotic=1)
    pads = case(base=replace(PADS, spring="epp"))
    found = judged(table, one=pads, demand="ductility", at_most=3.0)
    assert (found.verdict, found.high) == ("pass", 2.0)
    assert (settled := judged(table, one=pads, demand="settlement_m", at_most=0.03)).verdict == "not decided"
    assert settled.high == 0.04


@pytest.mark.parametrize(("demand", "limit"), [("overturned", 0.0), ("theta_max_over_alpha", 0.85)])
def test_a_pier_that_overturns_under_a_motion_a_hair_weaker_passes_nothing(demand, limit):
    table = runs([0.1, 0.3], theta_max_error=[1e-6, None], chaotic=[0, 1], may_overturn=[0, 1])
    found = judged(table, demand=demand, at_most=limit)
    assert found.verdict == "not decided"
    assert judged(runs([0.1, 0.3], theta_max_error=1e-6), demand=demand, at_most=limit).verdict == "pass"


@pytest.mark.parametrize(
    ("sense", "low", "high", "is_open"),
    [
        ("at most", 0.5, 0.6, True),
        ("at most", 0.4, 0.5, False),
        ("at least", 0.4, 0.5, True),
        ("at least", 0.5, 0.6, False),
        ("at least", 0.4, 0.6, True),
        ("at least", 0.2, 0.3, False),
    ],
)
def test_bounds_leave_open_what_they_do_not_decide_also_where_one_equals_the_limit(sense, low, high, is_open):
    one = verdict("pads", "not decided", sense=sense, low=low, high=high, limit=0.5)
    assert wording.is_left_open(one) is is_open
    assert not wording.is_left_open(verdict("pads", "pass", sense=sense, low=low, high=high, limit=0.5))
