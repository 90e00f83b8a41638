"""Checks of a pier on both axes are what a hand makes of peaks.csv, and count the pier once."""

import math
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from check_samples import PADS, PIER, case, runs

from rockbatch.checks import Rule, judge
from rockbatch.checks.answer import answer
from rockbatch.checks.bounds import Bounds, _on_both_axes
from rockbatch.checks.coverage import runs_of_cases
from rockbatch.checks.responses import worst_of_cases
from rockbatch.checks.verdicts import read_verdicts, write_verdicts
from rockbatch.checks.wording import both_axes
from rockbatch.common.errors import InputError
from rockbatch.pier import Damper, RigidBase
from rockbatch.quantities.catalogue import DEMANDS
from rockbatch.results.run_json import describe_case
from rockbatch.study import Case

OTHER = PIER.__class__(alpha=0.15, p=0.9, mass_t=3000.0)
WAYS = {
    "greater": lambda x, y: x if x > y else y,
    "srss": lambda x, y: math.sqrt(x * x + y * y),
    "100_30": lambda x, y: max(x + 0.3 * y, y + 0.3 * x),
}


def across(base=PADS):
    return describe_case(Case("pads across", OTHER, base, {}, across_of="pads"))


def both(along, other, **cells):
    """Rows of both cases, in the order of peaks.csv: those of a record beside each other."""
    table = pd.concat([runs(along, **cells), runs(other, name="pads across", **cells)])
    return table.sort_index(kind="stable").reset_index(drop=True)


def judged(table, *rules, cases=None):
    return judge(rules, table, cases or [case(), across()])


@pytest.mark.sweep(fast=15)
@pytest.mark.parametrize("seed", range(20))
@pytest.mark.parametrize("way", WAYS)
def test_the_statistic_and_its_bounds_are_of_each_stations_combined_demand(way, seed):
    """The worst direction of a station, by its combined demand, and then the mean; errors go the same way."""
    rng = np.random.default_rng(seed)
    n = int(rng.integers(2, 9))
    stations = [f"s{place}" for place in rng.integers(0, 4, n)]
    x, y, error_x, error_y = rng.uniform(0.0, 0.9, n), rng.uniform(0.0, 0.9, n), *rng.uniform(0.0, 0.05, (2, n))
    table = both(x, y)
    table["station"] = [name for name in stations for _ in range(2)]
    table["theta_max_error"] = np.column_stack((error_x, error_y)).ravel()
    demand, at = [("theta_max_over_alpha", (1.0, 1.0)), ("theta_max_rad", (0.2, 0.15))][seed % 2]
    shuffled = table.sample(frac=1.0, random_state=seed).reset_index(drop=True)
    (verdict,) = judged(shuffled, Rule("r", demand, at_most=0.5, statistic="mean", both_axes=way))

    def by_hand(share):
        worst = {}
        for i, station in enumerate(stations):
            along = at[0] * max(x[i] + share * error_x[i], 0.0)
            other = at[1] * max(y[i] + share * error_y[i], 0.0)
            worst[station] = max(worst.get(station, 0.0), WAYS[way](along, other))
        return sum(worst.values()) / len(worst)

    for value, share in ((verdict.value, 0.0), (verdict.low, -1.0), (verdict.high, 1.0)):
        assert value == pytest.approx(by_hand(share), rel=1e-12)
    assert (verdict.case, verdict.records, verdict.runs) == ("pads", len(set(stations)), 2 * n)


@pytest.mark.parametrize("way", WAYS)
def test_exchanged_axes_are_judged_alike(way):
    x, y = np.random.default_rng(5).uniform(0.0, 0.8, (2, 6))
    alike = describe_case(Case("pads across", PIER, PADS, {}, across_of="pads"))
    rule = Rule("r", "top_drift_m", at_most=1.0, both_axes=way)
    first, second = (judged(both(*pair), rule, cases=[case(), alike])[0] for pair in ((x, y), (y, x)))
    assert (first.value, first.record, first.governing) == (second.value, second.record, second.governing)
    assert first.note.split("; ")[0].split(", ")[0].split()[0] == second.note.split("; ")[0].split(", ")[1].split()[0]


def test_the_verdict_says_what_is_combined():
    (verdict,) = judged(both([0.3], [0.4]), Rule("rotation", "theta_max_over_alpha", at_most=0.6, both_axes="srss"))
    assert verdict.words == "maximum of theta_max_over_alpha, SRSS of both axes"
    assert verdict.value == pytest.approx(0.5)
    assert "0.3 along the axis, 0.4 across the axis" in verdict.note
    assert "each axis of the pier is a planar model of its own" in verdict.note
    assert both_axes([verdict]) == (
        "Two planar models of each pier, one for each axis, combined: SRSS of both axes (rotation)."
    )


def test_remarks_and_the_way_of_both_axes_are_read_back_from_the_file_as_written(tmp_path):
    rule = Rule("rotation", "theta_max_over_alpha", at_most=60.0, statistic="p84_95", both_axes="srss")
    (written,) = judged(both([0.3], [0.4]), rule)
    write_verdicts(tmp_path, [written])
    (read,) = read_verdicts(tmp_path)
    assert len(written.remarks) >= 3
    assert (read.remarks, read.axes) == (written.remarks, written.axes)
    assert both_axes([replace(read, words="reworded")]) == both_axes([written])


@pytest.mark.parametrize("without", [[], ["pads"], ["pads across"], ["pads", "pads across"]])
def test_an_axis_without_error_estimates_leaves_the_combined_demand_without(without):
    table = both([0.3], [0.4])
    table["theta_max_error"] = 1e-3
    table.loc[table["case"].isin(without), "theta_max_error"] = math.nan
    (verdict,) = judged(table, Rule("r", "theta_max_over_alpha", at_most=0.6, both_axes="srss"))
    assert ("no error estimate" in verdict.note) == bool(without)


@pytest.mark.parametrize("fallen", ["pads", "pads across"])
def test_a_pier_that_overturns_on_either_axis_fails(fallen):
    table = both([0.1, 0.2], [0.1, 0.2])
    table.loc[(table["case"] == fallen) & (table["record"] == "r1"), "status"] = "overturned"
    rules = [
        Rule("fall", "overturned", at_most=0),
        Rule("rotation", "theta_max_over_alpha", at_most=0.5, both_axes="srss"),
        Rule("count", "overturned", at_most=0.5, statistic="count"),
    ]
    fall, rotation, count = judged(table, *rules)
    assert {verdict.verdict for verdict in (fall, rotation, count)} == {"fail"}
    assert fall.words.endswith(", on either axis")
    assert (count.value, rotation.value, rotation.counted) == (1.0, math.inf, "1 overturned (infinite)")


def test_a_run_that_is_missing_on_one_axis_leaves_the_record_open():
    table = both([0.1, 0.2], [0.1, 0.2]).iloc[:-1]
    (verdict,) = judged(table, Rule("r", "theta_max_over_alpha", at_most=0.5, both_axes="srss"))
    assert (verdict.verdict, verdict.high) == ("not decided", math.inf)
    assert "not run" in verdict.counted
    (out,) = judged(table, Rule("r", "theta_max_over_alpha", at_most=0.5, failed="left out"))
    assert (out.records, out.value) == (1, 0.1)


def test_moments_in_a_section_combine_and_axial_forces_do_not():
    table = both([0.1, 0.2], [0.1, 0.2], impacts=0)
    names = table[["record", "case", "polarity", "scale"]]
    forces = {"section_moment_kNm": [30.0, 40.0, 50.0, 10.0], "section_axial_greatest_kN": [9.0, 7.0, 6.0, 8.0]}
    sections = names.assign(height_m=7.5, section_axial_least_kN=0.0, sections_error=0.1, **forces)
    rules = [
        Rule("moment", "section_moment_kNm", at_most=60.0, at_m=7.5, both_axes="srss"),
        Rule("axial", "section_axial_kN", at_most=60.0, at_m=7.5),
    ]
    moment, axial = judge(rules, table, [case(), across()], sections=sections)
    assert (moment.value, axial.value) == (pytest.approx(math.hypot(50.0, 10.0)), 9.0)
    assert moment.high == pytest.approx(1.1 * moment.value)


def test_of_a_value_of_the_foundation_the_one_nearer_to_its_limit_counts():
    rules = Rule("most", "eta", at_most=5.0), Rule("least", "eta", at_least=2.0)
    found = judged(both([0.1], [0.1]), *rules, cases=[case(), across(replace(PADS, eta=4.0))])
    assert [verdict.value for verdict in found] == [4.0, 2.5]


def test_of_what_is_the_whole_pier_s_the_greater_counts():
    table = both([0.1], [0.1])
    table["settlement_m"], table["settlement_error_m"] = [0.03, 0.04], 0.0
    (verdict,) = judged(table, Rule("r", "settlement_m", at_most=0.1))
    assert (verdict.value, verdict.words) == (0.04, "maximum of settlement_m, the greater of both axes")
    with pytest.raises(
        InputError, match="both_axes: settlement_m does not add up over the axes, and the greater counts"
    ):
        Rule("r", "settlement_m", at_most=0.1, both_axes="srss")


def test_a_property_of_the_case_is_the_worse_of_both():
    cases = [case(), across(PADS.__class__(beta=50.0, eta=2.2))]
    (least,) = judged(both([0.1], [0.1]), Rule("r", "eta", at_least=2.3), cases=cases)
    assert (least.value, least.verdict, least.words) == (2.2, "fail", "eta, the lesser of both axes")


def test_a_demand_of_one_axis_alone_says_so():
    base = RigidBase(restraints=(Damper("viscous", nu=0.1, at="deck"),))
    cases = [describe_case(Case("pads", PIER, base, {})), across(RigidBase())]
    table = both([0.1], [0.1], damper_force_over_weight=[0.2])
    (verdict,) = judged(table, Rule("r", "damper_force_over_weight", at_most=0.5), cases=cases)
    assert (verdict.value, verdict.runs) == (0.2, 2)
    assert "across the axis the pier has no damper" in verdict.note
    assert "both axes" not in verdict.words


def test_rules_name_the_case_and_not_its_other_axis():
    table = both([0.1], [0.1])
    assert len(judged(table, Rule("r", "theta_max_over_alpha", at_most=0.5, case=("pads*",)))) == 1
    with pytest.raises(InputError, match="there is no such case"):
        judged(table, Rule("r", "theta_max_over_alpha", at_most=0.5, case=("pads across",)))


def test_the_answer_counts_the_pier_once():
    """And what governs across the axis has to have a limit too."""
    table, cases = both([0.1, 0.2], [0.1, 0.2], ductility_left=1.0, ductility_right=1.0), [case(), across()]
    table.loc[table["case"] == "pads across", "ductility_right"] = 3.0
    suites = runs_of_cases(table, cases, 2)
    assert [(suite.case, suite.runs) for suite in suites] == [("pads", 4)]
    verdicts = judged(table, Rule("r", "theta_max_over_alpha", at_most=0.5))
    (line,) = answer(
        verdicts, worst_of_cases(table, cases, at_each_scale=True), lambda row: row.case, lambda row: row.record, suites
    )
    assert line.text.startswith("The only case meets the limits, but none is set on")
    assert "ductility" in line.text


def test_no_directed_demand_is_an_event_or_of_the_case_or_of_a_device():
    directed = [demand for demand in DEMANDS.values() if demand.directed]
    assert len(directed) == 30
    assert not any(demand.event or demand.per_case or demand.device for demand in directed)


@pytest.mark.parametrize(("first", "second"), [(True, True), (True, False), (False, True), (False, False)])
def test_a_demand_of_both_axes_is_estimated_if_both_are(first, second):
    numbers = np.array([0.3]), np.array([0.2]), np.array([0.4])
    found = _on_both_axes([Bounds(*numbers, first), Bounds(*(0.5 * each for each in numbers), second)], "100_30")
    assert found.estimated == (first and second)
    assert [each.item() for each in found[:3]] == pytest.approx([0.345, 0.23, 0.46])
