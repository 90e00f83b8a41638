"""Remarks, reasons and conditions of checks, read back: each number and name in them is that of what they speak of."""

import math
from types import SimpleNamespace

import pytest
from check_samples import PADS, PIER, case, judged, runs
from messages import assert_states, said_by

from rockbatch.checks import answer, judging, remarks, suite_target
from rockbatch.checks.coverage import Stations
from rockbatch.checks.events import OfEvent
from rockbatch.checks.responses import Worst, in_words
from rockbatch.checks.rule_choices import FAR, _implausible, _no_section, _unavailable, _without_dead_load
from rockbatch.checks.rules import Rule
from rockbatch.pier import YieldingBase

AVAILABLE = SimpleNamespace(cases=["pads", "piles"], scales=[1.0, 1.5], output=set())
CURVE = ((-500.0, 0.0), (900.0, 4e3), (7000.0, 0.0))
WEAK = [case("a", YieldingBase(beta=50.0, eta=1.4)), case("b", YieldingBase(beta=50.0, eta=1.7)), case("c", PADS)]
TARGET = {
    "code": "ASCE 7-16", "stations": 9, "events": 4, "alone": 2, "pairs": "rotd100", "range_s": (0.3, 2.5), "spectrum": "ASCE 7",
    "rocking_s": (1.2, 1.7), "defined_to_s": 2.9, "at_least": 1.35, "damping": 0.05,
}  # fmt: skip


def rule(demand="theta_max_over_alpha", at_most=0.5, **asked):
    return Rule("check", demand, at_most, **asked)


def texts(problems):
    return [str(problem) for problem in problems]


def response(demand, value, **cells):
    return lambda: in_words(Worst(demand, value, case(), runs(theta=(0.1,), **cells), 0))


def conditions(scale=1.0, **changed):
    """Return the conditions on a suite by their demands, with value, limit and remarks."""
    found = suite_target._conditions(TARGET | changed, scale)
    return lambda: [f"{one.demand}: {one.value:g}, {one.limit:g}, {', '.join(one.remarks)}" for one in found]


def files(*names):
    return [{"name": name, "source": f"records/{name}.AT2", "reason": "no unit"} for name in names]


MISSING = Stations(["A", "B", "C"], {"B": files("b1", "b2"), "D": files("d"), "E": files("e")})
MESSAGES = {
    "a value far below its limit": (
        lambda: judging._remark_if_far(rule(at_most=0.7), 0.0012),
        [0.0012, 1.0 / FAR, '"at_most"'],
    ),
    "chaotic runs": (lambda: judging._remark_on_chaos(3), [3.0, 2.0]),
    "directions": (
        lambda: judging._remark_on_directions({name: (n, n + 2) for n, name in enumerate("abcdefg", 1)}),
        [*(part for n, name in enumerate("abcde", 1) for part in (name, n, n + 2)), 2.0],
    ),
    "bounds": (lambda: judging._between(0.21, 0.63), [0.21, 0.63]),
    "too few stations": (
        lambda: judging._unmet(rule(statistic="mean", least=9), "station", 7, None),
        [7.0, "stations", 9.0],
    ),
    "too few stations of a code": (
        lambda: judging._unmet(rule(statistic="asce7-16", least=12), "station", 8, None),
        [8.0, "stations", "the check", 12.0],
    ),
    "stations of one event": (
        lambda: judging._unmet(rule(statistic="asce7-16", per_event=3), "station", 11, OfEvent("Kaikoura 2016", 5, 11, 0)),
        [3.0],
    ),
    "a rotation": (response("theta_max_over_alpha", 0.6), [0.6, math.degrees(0.12), 0.12]),
    "a tilt": (response("base_tilt_rad", 0.0123), [12.3, round(math.degrees(0.0123), 2)]),
    "a drift": (response("top_drift_m", 1.4863), [1.49, 1486.0, "mm", 2.0 * PIER.height]),
    "a settlement": (response("settlement_m", 0.0456), [45.6, "mm"]),
    "a settlement by two laws": (response("settlement_m", 0.0456, settlement_other_law_m=0.0123), [12.3, 45.6, "mm"]),
    "a case": (
        lambda: texts(_unavailable(rule(), {"pods": []}, AVAILABLE)),
        ["pods", '"pads"'],
    ),
    "a scale": (lambda: texts(_unavailable(rule(scale=(2.5,)), {}, AVAILABLE)), ["scale", 2.5, 1.0, 1.5]),
    "a column": (
        lambda: texts(_unavailable(rule("base_shear_over_capacity", 1.0, capacity=CURVE), {}, AVAILABLE)),
        ["base_shear_over_capacity", "interaction_base", "interaction_base"],
    ),
    "a section": (
        lambda: texts(_no_section(rule("section_shear_kN", at_m=3.5), [], [0.0, 7.25])),
        ["at_m", 3.5, 0.0, 7.25],
    ),
    "a capacity without the dead load": (
        lambda: texts(_without_dead_load(rule("section_moment_over_capacity", 1.0, at_m=0.0, capacity=CURVE), [case()])),
        ["N", -500.0, 7000.0, PIER.mass_t * PIER.gravity],
    ),
    "millimetres": (
        lambda: texts(_implausible(rule("heel_uplift_mm", 0.15), [case()])),
        ["at_most", 0.15, "heel_uplift_mm", 0.15, "m", 150.0, "mm", '"at_most"'],
    ),
    "weak supports": (lambda: remarks.weak_supports(WEAK), ["a", "b", 70.0, 85.0]),
    "stations that are missing": (
        lambda: [line := answer.missing_stations(MISSING), line.text, *line.details][1:],
        [3.0, 5.0, "D, E, 2 files of B", '"D", "E", "b1", "b2"'],
    ),
    "stations of a code": (
        conditions(),
        ["suite_stations", 9.0, 11.0, 4.0, "events", "suite_pairs", 7.0, 9.0, "suite_shortest_period", 0.3, 0.24, 0.2, 1.2, 0.1,
         "suite_longest_period", 2.5, 2.9, "spectrum ends", 2.0, 1.7, 0.1],
    ),
    "pairs of a code": (
        conditions(pairs="srss", defined_to_s=9.0),
        ["suite_stations", 9.0, 11.0, 4.0, "events", "suite_pairs", 0.0, 9.0, '"srss"', '"rotd100"',
         "suite_shortest_period", 0.3, 0.24, 0.2, 1.2, 0.1, "suite_longest_period", 2.5, 3.4, 2.0, 1.7, 0.1],
    ),
    "factors of a code": (
        conditions(1.5, code="NZS 1170.5", record_factors=(0.4, 2.6), family_factors=(0.8, 0.9)),
        ["suite_stations", 9.0, 3.0, 4.0, "suite_shortest_period", 0.3, 0.48, 0.4, 1.2, 0.1, "suite_longest_period", 2.5, 2.21,
         1.3, 1.7, 0.1, "suite_least_record_factor", 0.4, 0.33, "suite_greatest_record_factor", 2.6, 3.0,
         "suite_least_family_factor", 1.2, 1.0, "suite_greatest_family_factor", 1.35, 1.3],
    ),
    "no limit": (lambda: rule(at_most=None), ["at_most", "at_most", 0.5]),
    "a limit below": (lambda: rule(at_most=None, at_least=0.7), ["at_least", 0.7, "theta_max_over_alpha", "at_most", 0.7]),
    "least of a code": (
        lambda: rule(statistic="asce7-16", least=7),
        ["least", 7.0, "ASCE 7-16", 11.0],
    ),
    "a share of a capacity": (
        lambda: rule("heel_uplift_m", 450.0, capacity=900.0),
        ["at_most", 450.0, "at_most", 0.5],
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", MESSAGES)
def test_what_a_message_names_is_what_it_speaks_of(name):
    call, expected = MESSAGES[name]
    assert_states(said_by(call), *expected)


def test_a_verdict_that_bounds_leave_open_names_them():
    verdict = judged(runs(theta=(0.1, 0.2, 0.45, 0.3), chaotic=[False, True, True, False]), at_most=0.5)
    assert verdict.verdict == "not decided"
    bounds, _, chaotic = verdict.note.split("; ")
    assert_states(bounds, 0.3, 0.9)
    assert_states(chaotic, 2.0, "runs", 2.0)
