"""Runs that flew or failed are undecided, and no result rests on how they are counted."""

import json
import math
from dataclasses import replace

import numpy as np
import pytest
from fragility_samples import IDA, STRIPES, check, made_up, of_statuses, stands_or_falls, written
from studies import SINE

import rockbatch as rb
from rockbatch.analyses.fragility.bounds import NoCurve
from rockbatch.analyses.fragility.command import table
from rockbatch.analyses.fragility.curves import Readings
from rockbatch.analyses.fragility.hazard import Hazard
from rockbatch.analyses.fragility.limit_states import EXCEEDED, UNDECIDED, applies, states
from rockbatch.analyses.fragility.lognormal import Capacities, fit
from rockbatch.analyses.fragility.risk import risk_table, risks
from rockbatch.analyses.fragility.runs import output
from rockbatch.analyses.fragility.section import section
from rockbatch.analyses.fragility.study import read_fragility
from rockbatch.analyses.fragility.tables import described, points
from rockbatch.checks import Rule
from rockbatch.commands.cli import main
from rockbatch.motions.suites.hazard import HazardCurve
from rockbatch.quantities.arrays import Rows
from rockbatch.quantities.catalogue import DEMANDS
from rockbatch.reporting.finished_analysis import Contents
from rockbatch.study import Output, load_study


@pytest.mark.parametrize("fragility", [STRIPES, IDA], ids=["stripes", "ida"])
def test_runs_that_flew_or_failed_far_below_their_capacity_do_not_move_the_headline(tmp_path, fragility):
    """Every second record fails up to 0.3 g, where most would stand: the median is as without them."""

    def status(motion, x):
        return "failed" if x < 0.3 and motion % 2 else stands_or_falls(motion, x)

    (without,), _, _ = made_up(tmp_path, fragility, stands_or_falls)
    (curve,), _, _ = made_up(tmp_path, fragility, status)
    assert without.readings is None
    assert without.undecided.words == ""
    assert curve.fitted.median == pytest.approx(without.fitted.median, rel=0.03)
    low, high = curve.readings.medians
    assert low < 0.8 * without.fitted.median
    assert high == pytest.approx(without.fitted.median, rel=0.03)
    assert high / low > np.divide(*curve.fitted.median_interval[::-1])
    assert curve.inconclusive


def test_the_readings_are_those_of_all_undecided_runs_counted_either_way(tmp_path):
    """Held against fits of the counts themselves; 12 of 120 runs, 4 of them flights."""

    def status(motion, x):
        if motion < 8 and x == 0.4:
            return "failed"
        return "flight" if motion >= 26 and x == 0.6 else stands_or_falls(motion, x)

    (curve,), spec, _ = made_up(tmp_path, STRIPES, status)
    assert curve.undecided.words == "12 of 120 runs undecided: 4 flew, 8 failed"
    levels = np.array(spec.levels)
    kinds = np.array([[status(m, x) for x in spec.levels] for m in range(30)])
    open_, within, beyond = np.isin(kinds, ["flight", "failed"]), kinds == "ok", kinds == "overturned"
    for found, expected in (
        (curve.fitted, (within, beyond)),
        (curve.readings.exceeded, (within, beyond | open_)),
        (curve.readings.withstood, (within | open_, beyond)),
    ):
        assert found.median == fit(Capacities.of_same_records(levels, *expected)).median
    assert curve.readings.exceeded.median < curve.fitted.median < curve.readings.withstood.median
    assert [stripe.undecided for stripe in curve.stripes] == [0, 8, 4, 0]


def test_without_a_curve_undecided_runs_leave_no_median_open(tmp_path):
    """All that is decided stands: only those that failed could give a curve."""
    (curve,), *_ = made_up(tmp_path, STRIPES, lambda motion, x: "failed" if motion % 3 == 0 and x > 0.4 else "ok")
    assert isinstance(curve.fitted, NoCurve)
    assert curve.readings is not None
    assert not curve.inconclusive


def test_both_rates_that_undecided_runs_allow_are_in_the_table(tmp_path):
    """Each by the closed form ν(θ) exp(k²β²/2) under a power law; without undecided runs neither."""

    def status(motion, x):
        return "failed" if motion < 8 and x == 0.4 else stands_or_falls(motion, x)

    hazard = Hazard(HazardCurve([0.25], [1 / 475], slope=2.0), (50.0,), "made up")
    (curve,), spec, _ = made_up(tmp_path, STRIPES, status, hazard=hazard)
    (decided,), *_ = made_up(tmp_path, STRIPES, stands_or_falls, hazard=hazard)
    table = risk_table([curve, decided], *risks([curve, decided], spec), spec, ())
    row, without = table.to_dict("records")
    for name, reading in (
        ("rate_if_withstood", curve.readings.withstood),
        ("rate_if_exceeded", curve.readings.exceeded),
    ):
        expected = 1 / 475 * (0.25 / reading.median) ** 2 * math.exp(2.0 * reading.dispersion**2)
        assert row[name] == pytest.approx(expected, rel=1e-6)
        assert math.isnan(without[name])
    assert row["rate_if_withstood"] < row["rate_per_year"] < row["rate_if_exceeded"]


def test_runs_put_out_what_their_limits_need_and_no_more(tmp_path):
    spec = read_fragility(load_study(written(tmp_path, STRIPES)))
    rotation = Rule("half way", "theta_max_over_alpha", at_most=0.5)
    of_study = Output.with_keys(least_normal_share=0.2, least_stroke_mm=7.0)
    of_runs = {name: demand for name, demand in DEMANDS.items() if not demand.per_case and not demand.in_section}
    assert {demand.needs for demand in of_runs.values()} >= {"forces", "rocking", "devices_work"}
    for name, demand in of_runs.items():
        capacity = ((0.0, 100.0), (1e5, 6e4)) if demand.over_capacity else None
        asked = output(replace(spec, limits=(rotation, Rule("other", name, at_most=0.01, capacity=capacity))), of_study)
        assert asked.has("both_laws") == bool(demand.other_end)
        assert asked.has("interaction_base") == demand.over_capacity
        for need in ("forces", "rocking", "devices_work"):
            assert asked.has(need) == (demand.needs == need), name
        assert asked.histories == "none"
        assert asked.keys["least_normal_share"] == (0.2 if demand.needs == "forces" else 0.1)
        assert asked.keys["least_stroke_mm"] == (7.0 if demand.needs == "devices_work" else 10.0)
    assert output(replace(spec, limits=(Rule("settled", "settlement_m", at_most=0.01),)), Output()).has("both_laws")


def test_undecided_runs_alone_make_no_curve_but_an_open_interval(tmp_path):
    rule = Rule("half way", "theta_max_over_alpha", at_most=0.5, overturned="unknown")
    (curve,), _, _ = made_up(tmp_path, STRIPES, stands_or_falls, limits=(rule,))
    assert [stripe.exceeded for stripe in curve.stripes] == [0, 0, 0, 0]
    reason = "no record exceeds the limit up to 0.8, and stronger motions are needed"
    assert (curve.fitted, curve.readings.withstood) == (
        NoCurve(reason, 0.6),
        NoCurve(reason, 0.8),
    )  # six have a decided run
    assert curve.readings.medians == (curve.readings.exceeded.median, math.inf)
    assert curve.undecided.other == curve.undecided.number > 0
    x, beyond = np.array([0.3, 0.5]), curve.readings.exceeded
    for readings, expected in (
        (curve.readings, (np.zeros(2), beyond.probability(x))),
        (Readings(NoCurve("none"), beyond), (beyond.probability(x), np.ones(2))),
    ):
        np.testing.assert_array_equal(readings.probability(x), expected)
    assert Readings(NoCurve("none"), beyond).medians == (0.0, beyond.median)


@pytest.mark.parametrize(
    ("lost", "said"),
    [
        ({"epsilon": 0.05}, "below the limit by what is computed (the part of each landing on springs that epsilon or"),
        ({"zeta": 0.02}, ""),
    ],
)
def test_runs_left_open_by_landings_without_a_force_are_a_kind_of_their_own(lost, said):
    """The dashpots of ζ have no such landings."""
    tables = {
        "title": "forces",
        "pier": {"width_m": 4.0, "height_m": 24.0, "mass_t": 800.0},
        "motions": {"pulse": [SINE | {"name": f"{t} s", "period_s": t} for t in (0.8, 1.0, 1.2)]},
        "numerics": {"tolerance": 1e-3, "quiet_s": 10.0},
        "output": {"forces": True},
        "case": [{"name": "pads", "base": "elastic", "stiffness_kN_m": 2e6} | lost],
        "check": [check("foot", "pivot_force_kN", "bearings", at_most=30000.0)],
        "fragility": {"measure": "PGA", "levels_g": [0.25, 0.35]},
    }
    curve = rb.fragility(rb.Study.from_dict(tables)).info["curves"][-1]  # the first is overturning
    assert curve["undecided"]["other"] == 0
    assert curve["undecided"]["lower"] == (6 if said else 0)
    assert said in curve["note"]
    assert ("6 of 6 runs undecided: 6 below the limit" in curve["note"]) == bool(said)


def test_a_check_with_infinite_flights_and_failures_leaves_them_undecided(tmp_path):
    path = written(tmp_path, STRIPES)
    text = path.read_text(encoding="utf-8").replace(
        'at_most = 0.5\n', 'at_most = 0.5\nflight = "infinite"\nfailed = "value"\n'
    )  # fmt: skip
    text = text.replace("at_most = 0.005\n", 'at_most = 0.005\nfailed = "left out"\n')
    path.write_text(text, encoding="utf-8")
    _, half, settled = read_fragility(load_study(path)).limits
    path.write_text(f'{text}checks = ["set*", "half w[ab]y"]\n', encoding="utf-8")
    assert read_fragility(load_study(path)).limits[1:] == (half, settled)
    assert (half.flight, half.failed) == ("unknown", "unknown")
    assert (settled.flight, settled.failed) == ("unknown", "left out")
    runs = of_statuses(["flight", "failed"], theta=0.6)
    found = list(states(half, Rows(runs), {"base": "rigid", "parameters": {}}))
    assert found == [EXCEEDED, UNDECIDED]  # beyond the limit before it flew


def test_undecided_runs_come_first_in_the_table_the_files_and_the_report(tmp_path):
    """Every second record fails at two of four levels."""
    (curve,), spec, study = made_up(
        tmp_path, STRIPES, lambda m, x: "failed" if m % 2 and x < 0.5 else stands_or_falls(m, x)
    )
    told = described([curve], spec, study, 30)
    printed = table(told, spec)
    first, *rest = printed.splitlines()
    assert first == "Fragility for PGA, stripes; 1 of 1 curve says little: too many runs are undecided"
    assert any("says little: 30 of 120 runs undecided: 30 failed; they are left out" in line for line in rest)
    same = replace(curve, readings=Readings(NoCurve("too few"), NoCurve("too few")))
    assert str(described([same], spec, study, 30)).count("no curve (too few)") == 1
    rows = points([curve], spec, ())
    assert list(rows["undecided"]) == [15, 15, 0, 0]
    assert (rows["p_low"] <= rows["p"]).all()
    assert (rows["p"] <= rows["p_high"]).all()
    told |= {"study": {"sha256": "here"}}
    (tmp_path / "fragility.json").write_text(json.dumps(told), encoding="utf-8")
    page = section(Contents(tmp_path, told["study"]))
    first, figure = page.split("<figure", 1)
    assert first.startswith('<p class="lead">Overturning has a median of PGA')
    assert '<span class="undecided">too many runs are undecided to say much, 30 of 120 runs: with these on' in first
    assert 'class="unsure s1"' in figure
    assert "Between dotted edges: the curve with undecided runs on either side." in figure
    assert "30 of 120 runs undecided: 30 failed" in figure


@pytest.mark.parametrize(("stations", "said"), [(30, False), (15, True)])
def test_intervals_by_station_are_said_to_be_so(tmp_path, stations, said):
    (curve,), spec, study = made_up(tmp_path, STRIPES, stands_or_falls)
    told = described([curve], spec, study, 30) | {"stations": stations, "study": {"sha256": "here"}}
    (tmp_path / "fragility.json").write_text(json.dumps(told), encoding="utf-8")
    page = section(Contents(tmp_path, told["study"]))
    words = "Intervals are by station: the 30 records are components of 15 stations."
    first, figure = page.split("<figure", 1)
    assert (words in first) == said
    for shown in (
        "Between dotted edges",
        "Strips above",
        "by shares",
        "Dashed",
        "Demand of every record",
        "records of its own",
    ):
        assert shown not in figure


@pytest.mark.parametrize(("fragility", "words"), [
    ("", ["measure is missing"]),
    ('measure = "PGD"', ['measure = "PGD": expected one of "PGA", "PGV", "Sa", ']),
    ('measure = "PGA"', ["levels_g is missing"]),
    ('measure = "PGA"\nlevels_m_s = [0.2, 0.4]',
     ['levels_m_s = [0.2, 0.4]: does not apply to measure = "PGA"', "levels_g is missing"]),
    ('measure = "Sa"\nlevels_g = [0.2, 0.4]', ["period_s is missing"]),
    ('measure = "PGA"\nperiod_s = 1.0\nlevels_g = [0.2]',
     ['period_s = 1.0: does not apply to measure = "PGA"; leave it out, or write measure = "Sa"', "one level does not deter"]),
    ('measure = "PGA"\nlevels_g = [0.4, 0.2]', ["levels_g = 0.2: after 0.4; write them in rising order"]),
    (f"{STRIPES}\ntolerance = 0.1", ['tolerance = 0.1: is for method = "ida"; write that too']),
    (f"{STRIPES}\nhunt_step = 0.1", ['hunt_step = 0.1: is for method = "ida"']),
    (f"{IDA}\nhunt_step = 1e-4", ["hunt_step = 0.0001: expected a number from 0.001 to 1"]),
    (f"{STRIPES}\nwindow = 0.02", ['window = 0.02: is for method = "ida"']),
    (f"{IDA}\nwindow = 2", ["window = 2: expected a number from 0.001 to 0.2"]),
    (f'{STRIPES}\nmethod = "IDA"', ['did you mean "ida"?']),
    (f'{STRIPES}\nchecks = ["half-way"]', ['checks = "half-way": no [[check]] has this name; did you mean "half way"?']),
    (f'{STRIPES}\nchecks = ["zzz"]', ['checks = "zzz": no [[check]] has this name; there is "half way"']),
    (f"{STRIPES}\nconfidence = 1.0", ["confidence = 1.0: expected a number, 0 or above and below 1"]),
])  # fmt: skip
def test_mistakes_in_the_settings_are_reported_with_their_line(tmp_path, capsys, fragility, words):
    path = written(tmp_path, fragility)
    assert main(["fragility", str(path), "--out", str(tmp_path / "out")]) == 2
    told = capsys.readouterr().err
    for word in words:
        line = next(line for line in told.splitlines() if word in line)
        assert f"{path}:" in line
        assert "[fragility]" in line
    assert not (tmp_path / "out").exists()


def test_a_limit_state_is_of_the_cases_that_its_check_chooses():
    case, names = {"case": "pads", "base": "elastic", "pier": {}, "parameters": {}}, frozenset({"pads", "rigid"})
    of_case, of_others = ((), ("pads",), ("p*", "rigid")), (("rigid",), ("r*",))
    for patterns, expected in ((of_case, True), (of_others, False)):
        for chosen in patterns:
            rule = Rule("a", "theta_max_over_alpha", 0.5, case=chosen)
            assert applies(rule, case, names) is expected
