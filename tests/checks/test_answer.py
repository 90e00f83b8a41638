"""The answer to a set of checks: in order, in numbers, and never green where nothing limits what governs."""

import math
from dataclasses import replace

import pandas as pd
import pytest
from check_samples import PIER, RIGID, case, runs, verdict

from rockbatch.checks import wording
from rockbatch.checks.answer import MOST_NAMES, answer, without_limits
from rockbatch.checks.coverage import ALL_STATIONS, CaseRuns, Stations, runs_of_cases, stations_of
from rockbatch.checks.omissions import OMISSIONS
from rockbatch.checks.responses import in_words, worst_of_all, worst_of_cases
from rockbatch.checks.verdicts import DOES_NOT_APPLY, FAIL, NOT_DECIDED, PASS
from rockbatch.common.showing import MOST_LISTED, abridged
from rockbatch.pier import Damper, RigidBase

SETTLED = {"settlement_m": [0.1, 0.381, 0.0, 0.2], "base_tilt_rad": [1e-3, -4e-3, 0.0, 0.0]}
YIELDED = SETTLED | {"ductility_left": 2.0, "ductility_right": [1.0, 33.0, 1.0, 1.0]}
LIMITS = {"rotation": "theta_max_over_alpha", "shims": "settlement_m", "soil": "ductility", "tilt": "base_tilt_rad"}


def lines(verdicts, worst=(), runs=(), stations=ALL_STATIONS):
    return answer(verdicts, worst, lambda one: one.case, lambda one: f"record {one.record}", runs, stations)


def all_runs(**ended):
    """Ten runs of each case; ``ended`` are those of a case that do not end standing."""
    return [CaseRuns(name, {}, 1.0, 10, of_case) for name, of_case in ended.items()]


def worst(name="pads", **cells):
    return worst_of_cases(runs(name=name, **cells), [case(name)], at_each_scale=True)


def test_the_worst_of_every_response_is_found_whatever_is_checked():
    """Drift and uplift in closed form: |θ| times the height of the top, here of a uniform block, and the width."""
    found = worst_of_all(worst(**YIELDED))
    assert list(found) == [
        "theta_max_over_alpha", "top_drift_m", "settlement_m", "base_tilt_rad", "heel_uplift_m", "ductility",
    ]  # fmt: skip
    assert found["top_drift_m"].value == pytest.approx(0.6 * PIER.alpha * 2.0 * PIER.height)
    assert found["heel_uplift_m"].value == pytest.approx(0.6 * PIER.alpha * 2.0 * PIER.half_width)
    assert [found[name].run["record"] for name in ("theta_max_over_alpha", "settlement_m")] == ["r2", "r1"]
    assert (found["base_tilt_rad"].value, found["ductility"].value) == (4e-3, 33.0)
    assert in_words(found["settlement_m"]) == "381 mm"
    assert in_words(found["base_tilt_rad"]) == "4 mrad (0.23°)"
    assert in_words(found["top_drift_m"]) == "1.73 m (1,731 mm) at 14.422\u00a0m"


def test_a_pass_names_the_record_that_is_beyond_the_limit_by_itself():
    """By a mean below its limit, of several cases and bounds the farthest; not by a maximum, a count, or within the limit."""
    record = {"record": "A", "station": "A", "polarity": "+"}
    rows = [
        verdict("pads", PASS, governing=0.6, **record), verdict("rock", PASS, governing=0.8, **record | {"record": "B"}),
        verdict("rock", PASS, check="fall", governing=math.inf, **record), verdict("rock", PASS, check="low", governing=0.5),
        verdict("rock", PASS, check="few", governing=0.9, statistic="count"),
        verdict("rock", PASS, check="share", demand="overturned", governing=1.0, **record),
    ]  # fmt: skip
    (line,) = lines(rows)
    assert line.verdict == PASS
    told = "margin (record B (+), 0.8); fall (record A (+), beyond any limit)"
    assert f"Single records are beyond the limit: {told}." in line.details
    (line,) = lines([verdict("rock", PASS, governing=0.4, **record)])
    assert not any("Single records" in detail for detail in line.details)


def test_a_pass_under_one_record_says_so():
    """A mean or a maximum of one is no statistic."""
    rows = [
        verdict("pads", PASS, records=1),
        verdict("pads", PASS, check="bearing", demand="eta", statistic="", records=0),
    ]
    (line,) = lines([replace(row, count="station" if row.statistic else "") for row in rows])
    assert "Under one motion only." in line.details
    (line,) = lines([*rows, verdict("pads", PASS, check="drift", records=2)])
    assert not any("only" in words for words in line.details)
    (line,) = lines([verdict("pads", PASS, check="bearing", demand="eta", statistic="", records=0)])
    assert not any("only" in words for words in line.details)


def test_a_pass_names_the_checks_that_apply_to_no_case():
    """Of rules for another kind of pier one applied, and "every check passes" was all that was said."""
    idle = [verdict(case, DOES_NOT_APPLY, check=check) for case in ("rock", "pads") for check in ("pressure", "tilt")]
    own = [verdict("rock", PASS), verdict("pads", PASS), verdict("rock", DOES_NOT_APPLY, check="drift")]
    (line,) = lines([*own, verdict("pads", PASS, check="drift"), *idle])
    assert line.details[-1] == "Apply to no case: pressure, tilt."
    (line,) = lines([*own, verdict("pads", PASS, check="drift")])
    assert not any("no case" in words for words in line.details)


def test_a_pass_says_that_directions_are_missing_and_that_stations_are_of_one_event():
    """Both stood in the notes of the whole list alone, and the answer was green without them."""
    (line,) = lines([verdict("pads", PASS, omits=("directions", "events")), verdict("rock", PASS, omits=("events",))])
    directions = "not every direction counts, and the worst may be another"
    events = "stations of one earthquake count as independent motions, unless per_event limits their number"
    assert line.details[1:] == (f"margin: {directions}; {events}.",)
    (line,) = lines(
        [verdict("pads", PASS, omits=("directions", "events")), verdict("pads", PASS, check="fall", omits=("events",))]
    )
    assert line.details[1:] == (f"margin: {directions}.", f"margin, fall: {events}.")


def test_an_omission_of_many_checks_does_not_list_all_of_them():
    """Six lines of names stood before each remark that is of every run."""
    six = [verdict("pads", PASS, check=f"c{i}", omits=("flights", "slides")[: 1 + (i < 5)]) for i in range(6)]
    settled = verdict("pads", PASS, check="settled", demand="failed")
    (line,) = lines([*six, settled])
    assert line.details[1:] == (
        f"c0, c1, c2, and 2 more: {OMISSIONS['slides'].remark}.", f"all checks of runs: {OMISSIONS['flights'].remark}.",
    )  # fmt: skip
    (line,) = lines(six[:3])
    assert line.details[1].startswith("c0, c1, c2: runs would slide")


def test_the_worst_at_each_scale_is_that_of_its_runs_alone():
    """Ties, values that are missing or rounding, a scale without a run that ends standing; the rows are in no order."""
    of_scales = {
        2.0: runs(**YIELDED),
        0.5: runs((0.3, 0.3, 0.1, 0.2), settlement_m=[math.nan, 0.0, 0.0, 0.0], base_tilt_rad=1e-12),
        1.0: runs((0.4, math.nan, 0.4, 0.2), **YIELDED, status=["ok", "failed", "ok", "overturned"]),
        1.5: runs(**YIELDED, status="overturned"),
        3.0: runs([1e-12]),
    }
    tables = [table.assign(scale=scale) for scale, table in of_scales.items()]
    shuffled = pd.concat(tables).sort_values(["record", "scale"], kind="stable").reset_index(drop=True)

    def found(table, **how):
        worst = worst_of_cases(table, [case()], **how)
        return [(one.demand, one.value, one.run["record"], float(one.run["scale"])) for one in worst]

    alone = [one for scale in (0.5, 1.0, 2.0, 3.0) for one in found(shuffled[shuffled["scale"] == scale])]
    assert found(shuffled, at_each_scale=True) == alone
    of_all = found(shuffled)
    assert len(of_all) == len({demand for demand, *_ in alone})
    assert {demand: value for demand, value, *_ in of_all} == {
        demand: max(value for name, value, *_ in alone if name == demand) for demand, *_ in alone
    }
    scales = [one.scale for one in worst_of_cases(shuffled, [case()], at_each_scale=True)]
    assert scales == [0.5] * 5 + [1.0] * 6 + [2.0] * 6 + [3.0] * 3
    assert {("settlement_m", 0.0, "r1", 0.5), ("base_tilt_rad", 0.0, "r0", 0.5)} < {*alone}
    assert ("theta_max_over_alpha", 1e-12, "r0", 3.0) in alone


def test_the_worst_settlement_of_springs_that_creep_is_a_range():
    found = worst_of_all(worst(**YIELDED, settlement_other_law_m=[0.01, 0.02, 0.0, 0.0]))
    assert in_words(found["settlement_m"]) == "20 to 381 mm, by both spring laws"


def test_what_has_no_limit_is_told_with_its_values_at_the_scale_of_the_case():
    others = [runs(**YIELDED | {"settlement_m": 0.9}, scale=scale) for scale in (0.5, 1.5)]
    both = worst_of_cases(pd.concat([*others, runs(**YIELDED)]), [case()], at_each_scale=True)
    passing = [verdict("pads", "pass", check=d, demand=d) for d in ("theta_max_rad", "ductility", "base_tilt_rad")]
    (line,) = lines(passing, both)
    assert "mean settlement 381 mm" in " ".join(line.details)
    assert "900" not in " ".join(line.details)


def test_a_run_that_overturned_has_no_worst_response():
    fell = worst_of_cases(runs((0.1, 40.0), name="rigid", status=["ok", "overturned"]), [RIGID], at_each_scale=True)
    assert worst_of_all(fell)["theta_max_over_alpha"].value == 0.1


def test_nothing_is_green_where_settlement_tilt_and_ductility_have_no_limit():
    (line,) = lines([verdict("pads", "pass")], worst(**YIELDED))
    assert (line.verdict, line.cases) == (NOT_DECIDED, "pads")
    assert line.text == "The only case meets the limits, but none is set on mean settlement, residual tilt, ductility"
    assert line.details == (
        "Without a limit, at most: mean settlement 381 mm, residual tilt 4 mrad (0.23°), ductility 33.",
    )


@pytest.mark.parametrize("left_out", LIMITS)
def test_each_of_what_governs_needs_a_limit(left_out):
    verdicts = [verdict("pads", "pass", check=name, demand=demand) for name, demand in LIMITS.items()]
    assert [line.verdict for line in lines(verdicts, worst(**YIELDED))] == [PASS]
    rest = [one for one in verdicts if one.check != left_out]
    assert [line.verdict for line in lines(rest, worst(**YIELDED))] == [NOT_DECIDED]


def test_a_support_that_does_not_yield_needs_no_limit_of_its_settlement():
    elastic = worst(**SETTLED, ductility_left=0.9, ductility_right=0.8)
    assert [line.verdict for line in lines([verdict("pads", "pass")], elastic)] == [PASS]


def test_a_ban_on_overturning_alone_limits_no_rotation():
    ban = verdict("rigid", "pass", demand="overturned", statistic="max", limit=0.0)
    rocking = worst_of_cases(runs(name="rigid"), [RIGID], at_each_scale=True)
    assert [line.verdict for line in lines([ban], rocking)] == [NOT_DECIDED]


def test_of_cases_that_fail_the_nearest_to_passing_is_named_with_its_worst_check():
    drift = {"check": "drift", "demand": "top_drift_m", "unit": "m", "limit": 0.5}
    failing = [
        verdict("pads", "fail", **drift, value=1.24, ratio=2.48, record="TAK000"),
        verdict("rock", "fail", **drift, value=1.0, ratio=2.0, record="CPM000"),
        verdict("rock", "fail", check="soil", value=5.0, limit=4.0, ratio=1.25, record="ERZ"),
    ]
    (line,) = lines(failing)
    assert (line.verdict, line.text, line.cases) == (FAIL, "Both cases fail", "")
    assert line.details == ("Nearest to passing: rock, drift at 200\u00a0% of its limit.",)
    (line, _) = lines([*failing, verdict("free", "pass")])
    assert (line.verdict, line.cases) == (PASS, "free")
    ban = verdict("a", "fail", check="stands", demand="overturned", statistic="max", limit=0.0, value=1.0, record="TAK")
    assert lines([ban])[0].details == ()


def test_names_of_cases_stand_in_the_sentence_while_they_are_few():
    passing = [verdict(f"c{i}", "pass") for i in range(3)]
    failing = [verdict(f"d{i}", "fail", value=0.6, ratio=1.2) for i in range(5)]
    found = [(line.text, line.cases) for line in lines([*passing, *failing])]
    assert found == [("3 of 8 cases pass every check", "c0; c1; c2"), ("5 of 8 cases fail", "")]


def test_a_limit_that_is_lacking_is_found_case_by_case():
    """What governs a case is bounded by its own checks, whatever is asked of others."""
    both = [*worst(**YIELDED), *worst_of_cases(runs(name="rigid"), [RIGID], at_each_scale=True)]
    checks = [verdict("pads", "pass"), verdict("rigid", "pass")]
    found = without_limits({one.case: [one] for one in checks}, both)
    assert {name: [response.demand for response in responses] for name, responses in found.items()} == {
        "pads": ["settlement_m", "base_tilt_rad", "ductility"]
    }


def test_of_cases_that_pass_the_closest_to_its_limit_is_named():
    none = [verdict("rock", "does not apply", check=name) for name in ("settlement", "ductility")]
    (line,) = lines([verdict("rock", "pass"), *none, verdict("pads", "pass", value=0.45, ratio=0.9)])
    told = "Closest to its limit: pads, margin at 90\u00a0%.", "Apply to no case: settlement, ductility."
    assert line.details == told


def test_a_residual_rotation_that_dampers_hold_on_rigid_ground_needs_a_limit():
    held = case("rigid", base=RigidBase(restraints=(Damper("friction", f=0.6),)))
    leans = worst_of_cases(
        runs((0.3, 0.2), name="rigid", theta_res_over_alpha=[0.0, -0.05]), [held], at_each_scale=True
    )
    assert (
        in_words(worst_of_all(leans)["theta_res_rad"])
        == f"{50 * PIER.alpha:.3g} mrad ({math.degrees(0.05 * PIER.alpha):.2g}°)"
    )
    rotation, residual = (
        verdict("rigid", "pass", demand="theta_max_over_alpha"),
        verdict("rigid", "pass", demand="theta_res_rad"),
    )
    assert [line.verdict for line in lines([rotation], leans)] == [NOT_DECIDED]
    assert [line.verdict for line in lines([rotation, residual], leans)] == [PASS]
    back = worst_of_cases(runs((0.3, 0.2), name="rigid", theta_res_over_alpha=0.0), [held], at_each_scale=True)
    assert [line.verdict for line in lines([rotation], back)] == [PASS]


def test_a_case_that_no_check_chooses_is_counted_and_never_green():
    (line,) = lines([verdict("a", "pass")], runs=all_runs(a={}, b={}, c={"overturned": 4, "failed": 1}))
    assert (line.verdict, line.text, line.cases) == (NOT_DECIDED, "1 of 3 cases passes; 2 are not checked", "")
    assert line.details[0] == "Not checked: c, 4 of 10 runs overturned, 1 failed; b."
    assert line.details[1] == "Passes: a."
    (line,) = lines([verdict("a", "pass")], runs=all_runs(a={}))
    assert (line.verdict, line.text) == (PASS, "Every check passes in the only case")


def test_a_case_to_which_no_check_applies_is_not_checked():
    some = [verdict("a", "pass"), verdict("b", "does not apply", check="settlement")]
    assert lines(some)[0].text == "1 of 2 cases passes; 1 is not checked"


def test_a_case_that_is_not_checked_is_reported_where_another_fails():
    failed = verdict("a", "fail", value=0.6, ratio=1.2)
    first, last = lines([failed], runs=all_runs(a={}, b={"flight": 2}))
    assert (first.verdict, first.text) == (FAIL, "1 of 2 cases fails")
    assert first.details == ("Nearest to passing: a, margin at 120\u00a0% of its limit.",)
    assert (last.text, last.cases) == ("1 of 2 cases is not checked", "b, 2 of 10 runs ended by flight")


def test_of_a_hundred_cases_those_that_overturn_are_named_first_and_all_counted():
    """Those that overturn come last in the study."""
    fallen = {f"c{i}": {"overturned": 1 + i % 2} for i in range(90, 100)}
    (line,) = lines([verdict("c0", "pass")], runs=all_runs(**{f"c{i}": {} for i in range(90)}, **fallen))
    assert line.text == "1 of 100 cases passes; 99 are not checked"
    assert line.details[0].count("2 of 10 runs overturned") == MOST_NAMES
    rest = len(fallen) - MOST_NAMES
    assert line.details[0].endswith(f"and {99 - MOST_NAMES} more, {rest} of them with runs that do not end standing.")


def test_overturning_that_checks_leave_out_is_reported_beside_the_green():
    eta = verdict("a", "pass", check="capacity", demand="eta")
    (line,) = lines([eta], runs=all_runs(a={"overturned": 3}))
    assert line.details[-1] == "Not every run ends standing: a, 3 of 10 runs overturned."
    (line,) = lines([eta], runs=all_runs(a={"overturned": 10}))
    assert (line.verdict, line.text) == (NOT_DECIDED, "The only case is not checked")


def test_a_case_at_a_scale_that_no_check_chooses_is_not_checked():
    table = pd.concat([runs((0.1, 0.2), scale=scale) for scale in (1.0, 1.5)])
    counted = runs_of_cases(table, [case()], records=3)
    assert [(one.scale, one.runs, one.ended) for one in counted] == [
        (1.0, 3, {"not run": 1}), (1.5, 3, {"not run": 1}),
    ]  # fmt: skip
    found = answer([verdict("pads", "pass")], (), lambda one: f"{one.case} {one.scale:g}", str, counted)
    assert found[0].text == "1 of 2 cases passes; 1 is not checked"


LOST = {"name": "ABBAR--L", "source": "ABBAR--L.AT2", "reason": "the file is cut", "station": "RSN1633"}


def test_missing_stations_come_first_and_take_the_green_from_what_passes():
    stations = Stations([f"s{i}" for i in range(6)], {"RSN1633": [LOST]})
    first, second = lines([verdict("a", "pass")], stations=stations)
    assert (first.verdict, first.text) == (NOT_DECIDED, "6 of 7 stations; RSN1633 could not be used")
    assert first.cases == "ABBAR--L.AT2: the file is cut"
    assert 'leave_out = ["RSN1633"]' in first.details[-1]
    assert (second.verdict, second.text) == (NOT_DECIDED, "Every check passes in the only case")


def test_a_file_is_named_though_letters_of_its_name_are_in_the_reason():
    lost = LOST | {"name": "a", "source": "x/a.AT2"}
    (line,) = lines([], stations=Stations(["s"], {"A": [lost]}))
    assert line.cases == "x/a.AT2: the file is cut"


def test_missing_stations_come_last_and_are_reported_without_checks_too():
    stations = Stations(["s"], {"RSN1633": [LOST]})
    failed = verdict("a", "fail", value=0.6, ratio=1.2)
    assert [line.verdict for line in lines([failed], stations=stations)] == [FAIL, NOT_DECIDED]
    assert [line.text for line in lines([], stations=stations)] == ["1 of 2 stations; RSN1633 could not be used"]


@pytest.mark.parametrize("more", [0, 3])
def test_of_many_missing_stations_the_first_are_named_and_the_others_counted(more):
    stations = Stations([], {f"S{i}": [LOST] for i in range(MOST_LISTED + more)})
    names = [f"S{i}" for i in range(MOST_LISTED)]
    (line,) = lines([], stations=stations)
    listed = ", ".join([*names, *["and 3 more"] * bool(more)])
    assert line.text == f"0 of {MOST_LISTED + more} stations; {listed} could not be used"
    listed = ", ".join([*(f'"{name}"' for name in names), *["…"] * bool(more)])
    assert line.details == (f"To leave them out on purpose: leave_out = [{listed}] under [motions].",)


def test_a_component_of_a_station_that_is_used_is_reported_by_its_files():
    other = LOST | {"name": "cut", "station": "s", "reason": "no numbers"}
    (line, _) = lines([verdict("a", "pass")], stations=Stations(["s"], {"RSN1633": [LOST], "s": [other]}))
    assert line.text == "1 of 2 stations; RSN1633, 1 file of s could not be used"
    assert line.details[:2] == ("RSN1633: ABBAR--L.AT2: the file is cut.", "s: ABBAR--L.AT2: no numbers.")
    assert 'leave_out = ["RSN1633", "cut"]' in line.details[2]


def test_stations_that_are_left_out_by_name_stay_green_and_are_listed():
    (line,) = lines([verdict("a", "pass")], stations=Stations(["s"], {}, {"RSN1633": [LOST]}))
    assert (line.verdict, line.details[-1]) == (PASS, "Left out by name: RSN1633.")


def test_a_component_that_is_left_out_of_a_station_in_use_is_listed_too():
    dropped = {"name": "CHAN24", "station": "1336", "reason": "left out", "named": True}
    found = stations_of({"records": [{"record": "CHAN15", "station": "1336"}], "unusable": [], "left_out": [dropped]})
    (line,) = lines([verdict("a", "pass")], stations=found)
    assert (line.verdict, line.details[-1]) == (PASS, "Left out by name: 1 file of 1336.")


def test_stations_of_which_no_record_is_selected_are_listed_beside_a_pass():
    """One of which another record is used, or that is left out by name besides, is not among them."""
    weak = {
        "name": "B1",
        "source": "B1.AT2",
        "reason": "not selected: pga_g = 0.4 is not within 0..0.3",
        "named": False,
        "of": "",
    }
    files = [weak | {"station": station} for station in ("B", "B", "C", "A", "D")]
    files += [weak | {"station": "D", "named": True}, weak | {"station": "E", "of": "A1.AT2"}]
    found = stations_of({"records": [{"record": "A1", "station": "A"}], "unusable": [], "left_out": files})
    (line,) = lines([verdict("a", "pass")], stations=found)
    assert (line.verdict, line.details[-2:]) == (PASS, ("Left out by name: D.", "Not selected: B, C."))


def test_what_passes_comes_first_then_what_fails_then_what_is_open():
    some = [
        verdict("a", "not decided", remarks=("2 stations count",)),
        verdict("b", "fail", value=0.6, ratio=1.2),
        verdict("c", "pass"),
    ]
    assert [(line.verdict, line.cases) for line in lines(some)] == [(PASS, "c"), (FAIL, "b"), (NOT_DECIDED, "a")]


def test_a_check_of_several_cases_names_its_case_and_a_ban_has_no_limit():
    ban = {"demand": "overturned", "statistic": "max", "limit": 0.0, "check": "stands"}
    for more, of in (((), ""), ((verdict("b", "does not apply"),), "a, ")):
        (failed, *_) = lines([verdict("a", "fail", ratio=1.2), *more])
        assert failed.details == (f"Nearest to passing: {of}margin at 120\u00a0% of its limit.",)
        passed = next(
            line for line in lines([verdict("a", "pass", ratio=0.5), verdict("a", "pass", ratio=0.0, **ban), *more])
        )
        assert f"Closest to its limit: {of}margin at 50\u00a0%." in passed.details
    opened = [verdict("a", "not decided", remarks=("open",), **(ban | {"check": f"c{i}"})) for i in range(5)]
    assert lines(opened[:3])[0].details == tuple(f"c{i}: open." for i in range(3))
    assert lines(opened)[0].details == (*(f"c{i}: open." for i in range(3)), "and 2 more.")
    (banned,) = lines([verdict("a", "pass", ratio=0.0, **ban)])
    assert not banned.details


def test_unchecked_cases_stand_in_the_order_of_runs_that_did_not_end_standing():
    ended = {
        "a": {},
        "b": {"overturned": 2},
        "c": {"failed": 1},
        "d": {"overturned": 3, "flight": 1},
        "e": {"flight": 1},
    }
    (*_, line) = lines([verdict("a", "does not apply")], runs=all_runs(**ended))
    assert line.cases == (
        "d, 3 of 10 runs overturned, 1 ended by flight; b, 2 of 10 runs overturned; c, 1 of 10 runs failed; and 2 more, "
        "1 of them with runs that do not end standing"
    )


def test_what_is_open_says_why_and_that_it_does_not_matter_where_a_case_fails():
    open_ = verdict("a", "not decided", check="tilt", remarks=("between 0.2 and 0.6",), record="ERZ", high=0.6)
    assert lines([open_])[0].details == ("tilt: between 0.2 and 0.6, limit 0.5, left open by record ERZ.",)
    few = verdict("a", "not decided", remarks=("2 stations count, EN 1998-1 asks for 3",), record="ERZ")
    assert lines([few])[0].details == ("margin: 2 stations count, EN 1998-1 asks for 3.",)
    failed = verdict("a", "fail", value=0.6, ratio=1.2)
    assert lines([open_, failed])[-1].cases == "tilt, in cases that fail anyway"


@pytest.mark.parametrize(
    ("value", "limit", "words"),
    [(48123.4, 50000.0, "48,120"), (50003.0, 50000.0, "50,003"), (50000.0, 50000.0, "50,000"), (3e-6, 1.0, "3 × 10⁻⁶"),
     (math.inf, 1.0, "∞"), (0.0, 0.5, "0"), (2e6, 3e6, "2 × 10⁶"), (999_999.6, 5e6, "1 × 10⁶")],
)  # fmt: skip
def test_a_demand_is_written_without_an_e_and_distinguished_from_its_limit(value, limit, words):
    assert wording.number(value, limit) == words


@pytest.mark.parametrize(
    ("ratio", "words"),
    [(1.15, "115 %"), (1.0, "100 %"), (0.9999, "99.99 %"), (1.0 - 1e-9, "100.000 %"), (12.0, "1,200 %"), (math.inf, "∞"),
     (math.nan, "")],
)  # fmt: skip
def test_a_share_of_a_limit_that_is_not_known_has_no_words(ratio, words):
    assert wording.percent(ratio).replace("\u00a0", " ") == words


@pytest.mark.parametrize(
    ("value", "more", "words"),
    [
        (0.25, {}, ("0.25 ≤ 0.5", "≤ 0.5", "0.50", "0.25")),
        (0.5, {}, ("0.5 ≤ 0.5", "≤ 0.5", "1.00", "0")),
        (0.6, {"unit": "m"}, ("0.6 m > 0.5 m", "≤ 0.5", "1.20", "-0.1")),
        (0.4999, {}, ("0.4999 ≤ 0.5", "≤ 0.5", "0.9998", "0.0001")),
        (0.75, {"sense": "at least"}, ("0.75 ≥ 0.5", "≥ 0.5", "0.67", "0.25")),
        (0.5, {"sense": "at least"}, ("0.5 ≥ 0.5", "≥ 0.5", "1.00", "0")),
        (0.4, {"sense": "at least"}, ("0.4 < 0.5", "≥ 0.5", "1.25", "-0.1")),
        (math.inf, {}, ("∞ > 0.5", "≤ 0.5", "∞", "-∞")),
        (0.25, {"high": math.inf}, ("≥ 0.25 ≤ 0.5", "≤ 0.5", "≥ 0.50", "≤ 0.25")),
    ],
)
def test_a_verdict_has_its_sign_and_digits_that_tell_it_from_its_limit(value, more, words):
    at_most = "sense" not in more
    ratio, margin = (value / 0.5, 0.5 - value) if at_most else (0.5 / value, value - 0.5)
    one = verdict("a", "pass", **({"value": value, "high": value, "ratio": ratio, "margin": margin} | more))
    found = (
        words_of(one).replace("\u00a0", " ")
        for words_of in (wording.against, wording.limit, wording.ratio, wording.margin)
    )
    assert tuple(found) == words


def test_a_sentence_that_holds_for_several_verdicts_is_said_once():
    few, open_ = "the most unfavourable of fewer than 7 records", "no error estimate"
    some = [verdict(name, "pass", check=check, remarks=(few,)) for name in "abc" for check in ("drift", "uplift")]
    some += [verdict("a", "pass", check="soil", remarks=(open_,)), verdict("b", "pass", check="soil")]
    some.append(verdict("c", "does not apply", check="drift", remarks=("the pier has no damper",)))
    notes = wording.Notes(some)
    assert [notes.about(one) for one in some] == [*[""] * 6, open_, "", "the pier has no damper"]
    assert notes.common() == [
        f"drift, uplift: {few}.",
        "drift, uplift, soil: runs that do not end standing count as follows: overturned: infinite.",
    ]


def test_a_quantile_that_passes_says_how_many_further_records_exceed_it():
    """As of eight records, (0.84 · 7 + 1)/9 = 0.764; nothing is said of a mean, nor of a quantile that fails."""
    tilt = {"check": "tilt", "statistic": "p84", "records": 8}
    (passing,) = lines([verdict("pads", PASS, **tilt), verdict("pads", PASS, check="uplift", statistic="mean")])
    (said,) = [detail for detail in passing.details if "further records" in detail]
    assert said == "tilt: by interpolation between the ranks of 8, which 24 % of further records exceed."
    assert "further" not in " ".join(lines([verdict("pads", FAIL, **tilt)])[0].details)


@pytest.mark.parametrize(("number", "words"), [(2, "a; b"), (3, "a; b; and 1 more"), (5, "a; b; and 3 more")])
def test_names_that_are_not_listed_are_counted(number, words):
    assert abridged(list("abcde")[:number], most=2) == words
