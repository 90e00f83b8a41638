"""A design: the values found are those of the checks' known functions, and of separate runs and studies."""

import json
import re
from itertools import pairwise
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from studies import PADS, RIGID, SINE, study_text, write_study

import rockbatch as rb
import rockbatch.batch.threads
from rockbatch.analyses.design.answer import answer
from rockbatch.analyses.design.figures import figure_of
from rockbatch.analyses.design.search import intervals, middles
from rockbatch.analyses.design.study import DesignSpec, Varied, read_design
from rockbatch.analyses.design.tables import intervals_table, values_table
from rockbatch.analyses.design.trials import Design, Judged, Trial, Written
from rockbatch.checks.coverage import stations_of
from rockbatch.checks.verdicts import FAIL, NOT_DECIDED, PASS
from rockbatch.checks.wording import SIGNS
from rockbatch.commands.cli import main
from rockbatch.common.errors import InputError
from rockbatch.common.figures.description import Area, Points, Polyline
from rockbatch.common.files import read_table

RECORDS = Path(__file__).parents[3] / "motions" / "near_fault"
PIER = {"alpha": 0.2, "p": 1.5}
WEIGHED = PIER | {"mass_t": 1000.0}
PULSE = SINE | {"amplitude_g": 1.2, "duration_s": 2.0}
STANDS = {"name": "stands", "demand": "overturned", "at_most": 0, "reason": "collapse"}
ROTATION = {"name": "rotation", "demand": "theta_max_over_alpha", "at_most": 0.5, "reason": "joints"}
STRENGTH = {"name": "strength", "demand": "yield_kN", "at_least": 12345.6, "reason": "known", "confirm": ["at_least"]}
SIZE = {"vary": "pier.p", "between": [1.0, 2.2], "find": "greatest", "points": 4, "width": 0.01}
WEIGHT = 1000.0 * 9.81


def study(design=None, *, cases=(RIGID,), check=(ROTATION,), pier=PIER, **more):
    design = SIZE | (design or {})
    return rb.Study.from_toml(study_text(pier=pier, pulses=[PULSE], cases=cases, check=check, design=design, **more))


def rows(found, *columns):
    return found.design[list(columns)].to_numpy().tolist()


def test_both_axes_of_a_pier_are_one_design():
    """A design for each value of a list, named after the case along the axis."""
    pier, case = {"width_m": 3.0, "height_m": 14.0}, PADS | {"eta": [2.0, 2.5], "other_width_m": 4.0}
    motion = rb.Motion("A", 0.01, np.sin(np.arange(50.0)), across=np.cos(np.arange(50.0)))
    search = {"vary": "pier.height_m", "between": [12.0, 15.0], "find": "greatest", "width": 0.1}
    text = study_text(pier=pier, pulses=(), cases=[case], check=[ROTATION], design=search)
    both = rb.Study.from_toml(text, motions=[motion])
    assert len(both.cases) == 4
    designs = Written(both, read_design(both)).designs
    assert designs == [Design("pads", (("eta", eta),)) for eta in (2.0, 2.5)]


@pytest.mark.parametrize("pulses", [1, 2])
def test_a_value_that_passes_under_one_motion_only_is_said_to(pulses):
    named = [PULSE | {"name": f"P{i}", "amplitude_g": 1.2 - 0.1 * i} for i in range(pulses)]
    found = rb.design(
        rb.Study.from_toml(study_text(pier=PIER, pulses=named, cases=[RIGID], check=[ROTATION], design=SIZE))
    )
    assert any("Under one motion only." in line for line in found.answer) is (pulses == 1)


# The search along a key


def searched(passes, scan, width):
    """Values by verdicts of a known function, with every change of verdict narrowed to the width."""
    verdicts = {float(value): passes(value) for value in scan}
    while new := middles(verdicts, width):
        verdicts |= {value: passes(value) for value in new}
    return verdicts


def islands(value):
    return PASS if 0.213 < value < 0.357 or 0.62 < value < 0.9 else FAIL


def test_ends_of_islands_of_a_known_function_are_found_to_the_width():
    verdicts = searched(islands, np.linspace(0.0, 1.0, 11), 1e-3)
    found = [interval for interval in intervals(verdicts) if interval.verdict == PASS]
    for interval, (low, high) in zip(found, ((0.213, 0.357), (0.62, 0.9)), strict=True):
        assert interval.below <= low <= interval.low
        assert interval.high <= high <= interval.above
        assert interval.low - interval.below <= 1e-3
        assert interval.above - interval.high <= 1e-3
        assert interval.widest <= 0.1 + 1e-9


def test_an_island_between_two_values_is_missed_and_the_widest_step_says_how_wide():
    (interval,) = intervals(searched(lambda x: FAIL if 0.52 < x < 0.58 else PASS, np.linspace(0.0, 1.0, 11), 1e-3))
    assert (interval.verdict, interval.below, interval.above) == (PASS, None, None)
    assert interval.widest == pytest.approx(0.1)  # the island is 0.06 wide


def test_what_is_not_decided_is_an_interval_of_its_own():
    verdicts = searched(lambda x: PASS if x > 0.5 else NOT_DECIDED if x > 0.3 else FAIL, np.linspace(0.0, 1.0, 5), 0.01)
    assert [interval.verdict for interval in intervals(verdicts)] == [FAIL, NOT_DECIDED, PASS]
    assert all(high.low - low.high <= 0.01 for low, high in pairwise(intervals(verdicts)))


# Closed forms

SOFT = PADS | {"beta": 60.0, "yield_kN": 2e4, "spring": "epp"}
del SOFT["eta"]
STRONGER = {"vary": "case.yield_kN", "between": [9000.0, 15000.0], "find": "least", "points": 3, "width": 10.0}


def test_the_strength_of_pads_ends_where_the_check_and_the_static_limit_say():
    """A check on the strength itself passes from its limit on; below half the weight the pier cannot stand at all."""
    found = rb.design(
        study(STRONGER | {"between": [4000.0, 15000.0], "points": 12}, cases=[SOFT], check=[STRENGTH], pier=WEIGHED)
    )
    refused, weak, strong = found.design.to_dict("records")
    assert [row["verdict"] for row in (refused, weak, strong)] == ["refused", "fail", "pass"]
    assert refused["high"] <= 0.5 * WEIGHT <= weak["low"] <= refused["high"] + 10.0
    assert weak["high"] < 12345.6 <= strong["low"] <= weak["high"] + 10.0
    assert (strong["below_check"], strong["below_ratio"]) == ("strength", pytest.approx(12345.6 / weak["high"]))
    assert any("the study is refused; at case.yield_kN = 4,000: " in words for words in found.answer)


def test_the_prestress_of_a_tendon_ends_where_the_pads_bear_no_more():
    """Both pads bear 2 F_y, the weight and the prestress: the greatest one that is taken is 2 F_y - W."""
    tied = SOFT | {"yield_kN": 13000.0, "tendon": {"prestress_kN": 3000.0, "stiffness_kN_m": 1e4}}
    design = {"vary": "case.tendon.prestress_kN", "between": [6000.0, 26000.0], "points": 6, "width": 100.0}
    found = rb.design(study(design, cases=[tied], check=[STRENGTH], pier=WEIGHED))
    passing, refused = found.design.to_dict("records")
    assert (passing["verdict"], refused["verdict"]) == ("pass", "refused")
    assert passing["high"] <= 2 * 13000.0 - WEIGHT <= refused["low"] + 1.0
    assert refused["low"] - passing["high"] <= 100.0


@pytest.mark.slow
def test_the_islands_of_sizes_that_stand_are_those_of_single_runs():
    """A pier that overturns may stand if it is smaller: one scan finds the island, a coarser one does not, and says so."""
    fine = rb.design(study({"between": [1.5, 3.3], "points": 25, "width": 0.02}, check=[STANDS]))
    motion = rb.pulse("sine", name="s", amplitude=1.2 * 9.81, period=0.5, dt=0.01, duration=2.0)
    stands = {
        p: rb.simulate(rb.Pier(0.2, p), rb.RigidBase(), motion).status == "ok"
        for p in np.linspace(1.5, 3.3, 91).tolist()
    }
    passing = [(row["low"], row["high"]) for row in fine.design.to_dict("records") if row["verdict"] == "pass"]
    assert len(passing) == 2
    for p, standing in stands.items():
        ends = [abs(p - end) for pair in passing for end in pair]
        assert any(low <= p <= high for low, high in passing) is standing or min(ends) < 0.02, p
    coarse = rb.design(study({"between": [1.5, 3.3], "points": 4}, check=[STANDS]))
    assert rows(coarse, "verdict") == [["pass"], ["fail"]]
    words = " ".join(coarse.answer)
    assert "up to 0.6 apart, nothing was run, and a narrower interval that passes or fails may lie there" in words
    assert "Not every value below it passes: pier.p passes from 1.5 to " in " ".join(fine.answer)


# A study that is written so

BOUNDS = [{"name": "heavy", "pier.alpha": {"times": 0.97}}, {"name": "light", "pier.alpha": {"times": 1.02}}]


def test_the_value_found_gives_the_rows_of_a_study_written_with_it(tmp_path):
    of_study = study(bound=BOUNDS)
    found = rb.design(of_study)
    value = found.design.loc[found.design["verdict"] == "pass", "high"].max()
    written = of_study.with_(pier={"p": value})
    peaks = rb.run(written, tmp_path)
    own = found.design_runs[found.design_runs["pier.p"] == value].drop(columns="pier.p").reset_index(drop=True)
    pd.testing.assert_frame_equal(own, read_table(tmp_path / "peaks.csv"), check_exact=True, check_dtype=False)
    verdicts = rb.check(peaks, study=written)
    judged = found.design_checks[found.design_checks["pier.p"] == value]
    for name in ("bound", "verdict", "record"):
        assert judged[name].fillna("").tolist() == verdicts[name].tolist()
    assert set(verdicts["verdict"]) == {"pass"}
    above = found.design.loc[found.design["verdict"] == "pass"].iloc[-1]
    assert (above["above_check"], above["above_under_bound"], above["above_record"]) == (
        "rotation",
        "heavy",
        "one-sine",
    )
    beyond = of_study.with_(pier={"p": above["above"]})
    assert "fail" in set(rb.check(rb.run(beyond), study=beyond)["verdict"])


def test_a_bound_on_the_key_that_varies_multiplies_each_of_its_values():
    alone = rb.design(study())
    both = rb.design(study(bound=[{"name": "small", "pier.p": {"times": 1.1}}]))
    ends = [found.design.query("verdict == 'pass'")["high"].iloc[-1] for found in (alone, both)]
    assert ends[0] / ends[1] == pytest.approx(1.1, abs=0.02)


def test_other_lists_make_designs_and_a_list_of_the_key_is_replaced():
    slender = {"alpha": [0.2, 0.22], "p": [1.0, 1.1]}
    found = rb.design(study(pier=slender))
    assert found.design["alpha"].unique().tolist() == [0.2, 0.22]
    alone = rb.design(study(pier=PIER | {"alpha": 0.22}))
    columns = ["verdict", "low", "high", "below", "above"]
    second = found.design[found.design["alpha"] == 0.22][columns].reset_index(drop=True)
    pd.testing.assert_frame_equal(second, alone.design[columns])
    leading = [words.replace("\u00a0", " ").split(": ")[:2] for words in found.answer[:2]]
    assert leading == [["rigid", "α = 0.2 rad"], ["rigid", "α = 0.22 rad"]]


def test_a_case_without_the_key_is_left_out_and_named():
    held = {"name": "held", "base": "rigid", "restitution": 0.9}
    design = {"vary": "case.restitution", "between": [0.85, 0.95], "points": 2, "width": 0.05}
    found = rb.design(study(design, cases=[RIGID, held]))
    assert set(found.design["case"]) == {"held"}
    assert found.answer[-1] == "Left out, without case.restitution: rigid."


TALL = {"width_m": 4.0, "height_m": 20.0, "mass_t": 800.0}
SPRINGS = {"name": "soft", "base": "elastic", "zeta": 0.05, "stiffness_kN_m": 1e6}
MOMENT = {
    "name": "moment",
    "demand": "section_moment_kNm",
    "at_m": 10.0,
    "at_most": 1e6,
    "reason": "r",
    "confirm": ["at_most"],
}
STIFF = {"name": "stiff", "demand": "stiffness_kN_m", "at_least": 1.3e6, "reason": "r"}
OF_SPRINGS = {"vary": "case.stiffness_kN_m", "between": [1e6, 2e6], "find": "least", "points": 2, "width": 2e5}
SECTIONS = {"sections_m": [10.0]}
TO_REST = {"output": SECTIONS, "numerics": {"quiet_s": 10.0}}  # until no landing can raise a force


@pytest.mark.slow
def test_checks_of_sections_are_judged_by_the_forces_of_each_value(tmp_path):
    of_study = study(OF_SPRINGS, cases=[SPRINGS], check=[MOMENT, STIFF], pier=TALL, **TO_REST)
    found = rb.design(of_study)
    own = found.design_checks.query("check == 'moment'").set_index("case.stiffness_kN_m")["value"]
    assert len(own) == 5  # two of the scan, and three bisections
    assert own.nunique() == 5
    assert any(words.startswith("moment: bending of the shaft is left out") for words in found.answer)
    for stiffness, value in own.items():
        written = of_study.with_(case={"soft": {"stiffness_kN_m": stiffness}})
        rb.run(written, tmp_path / str(stiffness))
        (judged,) = rb.check(tmp_path / str(stiffness)).query("check == 'moment'")["value"]
        assert value == judged


SHARE = {
    "name": "share",
    "demand": "section_moment_over_capacity",
    "at_m": 10.0,
    "capacity": [[-1e5, 0.0], [0.0, 1e5], [1e5, 0.0]],
    "at_most": 0.9,
    "reason": "r",
}


JOINT = {
    "name": "joint",
    "demand": "base_shear_over_capacity",
    "capacity": {"constant": 9e3, "per_N": 0.9},
    "at_most": 1.0,
    "reason": "r",
}


def test_shares_of_a_capacity_of_the_base_are_judged_without_a_section():
    found = rb.design(study(OF_SPRINGS, cases=[SPRINGS], check=[JOINT, STIFF], pier=TALL))
    assert found.design_checks.query("check == 'joint'")["value"].nunique() == 5
    assert found.design_interaction["height_m"].isna().all()


def test_shares_of_a_capacity_are_judged_by_the_forces_of_each_value(tmp_path):
    """Of the same moment, as a study written with the value has them; read again from a finished folder."""
    of_study = study(OF_SPRINGS, cases=[SPRINGS], check=[SHARE, STIFF], pier=TALL, output={"interaction_m": [10.0]})
    found = rb.design(of_study, tmp_path / "found")
    own = found.design_checks.query("check == 'share'").set_index("case.stiffness_kN_m")["value"]
    assert own.nunique() == len(own) == 5  # two of the scan, and three bisections
    for stiffness, value in own.items():
        written = of_study.with_(case={"soft": {"stiffness_kN_m": stiffness}})
        rb.run(written, tmp_path / str(stiffness))
        (judged,) = rb.check(tmp_path / str(stiffness)).query("check == 'share'")["value"]
        assert value == float(f"{judged:.10g}")  # as design_checks.csv has it
    again = rb.design(of_study, tmp_path / "found")
    pd.testing.assert_frame_equal(again.design_checks, found.design_checks, check_exact=True)
    assert set(again.design_interaction["height_m"]) == {10.0}


def test_a_check_of_one_case_is_not_one_of_another():
    soft = MOMENT | {"case": "soft"}
    of_study = study(OF_SPRINGS, cases=[SPRINGS, SPRINGS | {"name": "other"}], check=[soft], pier=TALL, **TO_REST)
    found = rb.design(of_study)
    assert dict(rows(found, "case", "verdict")) == {"soft": "pass", "other": "not decided"}  # no check is about it
    alone = rb.design(study(OF_SPRINGS, cases=[SPRINGS], check=[soft], pier=TALL, **TO_REST))
    np.testing.assert_array_equal(alone.design_checks["value"], found.design_checks["value"])


# What an answer must not hide


def test_an_end_of_the_scan_is_not_called_the_greatest_value_that_passes():
    found = rb.design(study({"between": [1.0, 1.2], "points": 2, "width": 0.1}))
    (words,) = [words for words in found.answer if "upper end of the scan" in words]
    assert words.startswith(
        "With pier.p = 1.2, the upper end of the scan, every check passes (closest to its limit: rotation at "
    )
    assert words.endswith(
        "That is where the scan ends, and not the greatest value that passes: no value above it was run."
    )


def test_where_nothing_passes_the_nearest_value_is_named():
    found = rb.design(study({"between": [1.8, 2.2]}))
    assert found.answer[0].startswith(
        "No value of pier.p that was run from 1.8 to 2.2 passes every check; nearest is 1.8"
    )
    assert "rotation at 178 %" in found.answer[0]


@pytest.mark.usefixtures("pages")
def test_what_is_not_decided_is_no_pass(tmp_path):
    few = ROTATION | {"statistic": "mean", "least": 7}
    found = rb.design(study(check=[few]))
    assert rows(found, "verdict") == [["not decided"], ["fail"]]
    assert found.answer[0].startswith("No value of pier.p that was run")
    assert found.answer[0].endswith(
        ", in one-sine: 1 station counts, the check asks for 7."
    )  # a share alone looks like a pass
    found.save(tmp_path / "out")
    page = (tmp_path / "out/analyses.html").read_text(encoding="utf-8")
    assert f"{SIGNS[NOT_DECIDED]} No value of pier.p that was run" in page
    pair = {"vary": ["pier.p", "pier.alpha"], "between": [[1.0, 2.2], [0.2, 0.25]], "points": [2, 2], "width": 1.0}
    found = rb.design(study(pair, check=[few]))
    told = "No pair of values that was run passes every check; nearest is 1, 0."
    assert found.answer[0].startswith(told)
    assert "1 station counts, the check asks for 7" in found.answer[0]


def test_a_value_that_passes_with_runs_that_fall_says_so():
    """By a median, and a check that lets one of three fall: both were said of a run of this value, and not here."""
    median, may_fall = (
        ROTATION | {"statistic": "median"},
        STANDS | {"statistic": "count", "at_most": 1, "confirm": ["at_most"]},
    )
    strong = PULSE | {"name": "strong", "amplitude_g": 2.0, "period_s": 1.5}
    pulses = [PULSE | {"name": name, "amplitude_g": 0.3} for name in "ab"] + [strong]
    text = study_text(
        pier=PIER, pulses=pulses, cases=[RIGID], check=[median, may_fall], design=SIZE | {"points": 2, "width": 1.0}
    )
    found = rb.design(rb.Study.from_toml(text))
    assert "Single records are beyond the limit, with values that pass: rotation." in found.answer
    assert "Not every run ends standing, with 2 of 2 values that pass." in found.answer
    assert not any("Single records" in words or "ends standing" in words for words in rb.design(study()).answer)


def test_under_a_suite_that_fails_its_target_nothing_passes():
    """A mean spectrum that falls short of the target leaves open what the checks say."""
    target = {"spectrum": [[0.1, 9.0], [2.0, 9.0]], "period_range_s": [0.2, 1.5], "factors": "none", "at_least": 0.9}
    text = study_text(
        pier=PIER, pulses=[PULSE], cases=[RIGID], check=[ROTATION], motions={"target": target}, design=SIZE
    )
    found = rb.design(rb.Study.from_toml(text))
    assert [row["verdict"] for row in found.design.to_dict("records")] == ["not decided", "fail"]
    assert "suite to target" in found.answer[0]


def said_of(verdicts, **more):
    """The answer about a key "pier.p" of one design, by the verdicts on its values."""
    design = Design("rigid", ())
    judged = {Trial(design, (value,)): Judged(verdict, None, "as it is") for value, verdict in verdicts.items()}
    vary = Varied("pier.p", min(verdicts), max(verdicts), 3)
    spec = DesignSpec((vary,), "least", 0.1, ("rigid",), ())
    info = {
        "vary": [{"path": "pier.p", "low": vary.low, "high": vary.high, "step": vary.step}],
        "find": "least",
        "width": 0.1,
    }
    info |= {
        "varied": [],
        "designs": [{"case": "rigid", "columns": {}}],
        "lacking": [],
        "bounds": [],
        "without_limit": [],
        "omitted": [],
        "beyond": [],
        "cut_short": 0,
        "of_one_motion": False,
    }
    info |= {"unusable": 0, "not_selected": [], "refused": [], "tried": len(verdicts), "under": []} | more
    return [
        words for _, words in answer(info, intervals_table(judged, spec, [], [design]), values_table(judged, spec, []))
    ]


def test_where_what_is_not_decided_adjoins_the_value_found_the_answer_says_how_far():
    first, beyond, _ = said_of({1.0: FAIL, 1.9: FAIL, 2.0: NOT_DECIDED, 2.9: NOT_DECIDED, 3.0: PASS, 4.0: PASS})
    assert first == "The least pier.p found that passes every check is 3. At 2.9 it is not decided: as it is."
    assert beyond == "From 2 to 2.9 nothing is decided, so that the least value that passes may be as low as 2."


@pytest.mark.parametrize(("find", "side"), [("least", "above it"), ("greatest", "below it")])
@pytest.mark.parametrize("number", [1, 2, 5, 6, 9])
def test_values_that_pass_with_gaps_between_are_listed_up_to_five_intervals(number, find, side):
    """Odd numbers pass, even ones fail."""
    verdicts = {float(n): PASS if n % 2 else FAIL for n in range(2 * number + 1)}
    found, gaps = said_of(verdicts, find=find, width=2.0)
    end, beyond = (1, 0) if find == "least" else (2 * number - 1, 2 * number)
    assert found == f"The {find} pier.p found that passes every check is {end}. At {beyond} it fails: as it is."
    start, _, listed = gaps.partition(" passes from ")
    assert start == f"Not every value {side} passes: pier.p"
    fails = " (below it fails: as it is; above it fails: as it is)"
    more = f" and {number - 5} more" if number > 5 else ""
    assert listed == "; from ".join(f"{n} to {n}{fails}" for n in range(1, 2 * min(number, 5), 2)) + f"{more}."


def test_a_file_of_the_suite_that_cannot_be_used_is_told():
    assert "2 files of the suite could not be used: what passes does so without these." in said_of(
        {1.0: PASS}, unusable=2
    )


def test_stations_of_which_no_record_is_selected_are_listed_as_a_run_lists_them(tmp_path):
    chosen = {"path": str(RECORDS), "select": {"pga_g": [0.1, 0.3]}}
    search = SIZE | {"vary": "pier.width_m", "between": [4.0, 5.0], "points": 2, "width": 0.5}
    of_pier = {"pier": {"width_m": 4.0, "height_m": 24.0}, "motions": chosen, "cases": [RIGID], "check": [STANDS]}
    of_study = rb.Study.from_toml(study_text(pulses=(), design=search, **of_pier))
    rb.run(of_study, out=tmp_path / "out")
    unused = stations_of(rb.open_results(tmp_path / "out").info).not_selected
    assert unused
    listed = ", ".join(unused)
    assert f"Not selected: {listed}." in rb.design(of_study).answer


def test_a_response_without_a_limit_is_named():
    assert "No limit is set on rotation, of designs that pass." in rb.design(study(check=[STANDS])).answer


def test_a_study_that_is_refused_with_every_value_is_refused_with_the_reason():
    with pytest.raises(
        InputError, match=r"refused with every value; with case.yield_kN = 1000: .*cannot carry the weight"
    ):
        rb.design(study(STRONGER | {"between": [1000.0, 2000.0]}, cases=[SOFT], check=[STRENGTH], pier=WEIGHED))


# Two keys


@pytest.mark.slow
def test_of_two_keys_the_first_is_searched_at_each_value_of_the_second():
    design = {"vary": ["pier.p", "pier.alpha"], "between": [[1.0, 2.2], [0.19, 0.23]], "points": [4, 3]}
    found = rb.design(study(design))
    assert found.design["pier.alpha"].unique().tolist() == [0.19, 0.21, 0.23]
    alone = rb.design(study(pier=PIER | {"alpha": 0.21}))
    columns = ["verdict", "low", "high", "above"]
    middle = found.design[found.design["pier.alpha"] == 0.21][columns].reset_index(drop=True)
    pd.testing.assert_frame_equal(middle, alone.design[columns])
    best = found.design.query("verdict == 'pass'")["high"].max()
    assert found.answer[0].startswith(
        f"The greatest pier.p found that passes every check is {best:.10g}, with pier.alpha = "
    )
    (panel,) = found.plot().axes[:1]
    assert panel.get_xlabel()


# Figures


def test_the_figure_has_the_worst_ratio_of_each_check_over_strips_that_pass():
    found = rb.design(study(bound=BOUNDS, check=[ROTATION, STANDS]))
    (panel,) = figure_of(found.info, found.design, found.design_values, found.design_checks).panels
    lines = {mark.label: mark for mark in panel.marks if isinstance(mark, Polyline)}
    ratios = found.design_checks.groupby(["check", "pier.p"])["ratio"].max()
    for check in ("rotation", "stands"):
        worst = ratios[check]
        np.testing.assert_array_equal(lines[check].x, worst.index)
        shown = np.where(worst <= panel.y.last, worst, np.nan)  # what overturns is marked above the axis
        np.testing.assert_array_equal(lines[check].y, shown)
    strips = [(mark.x.min(), mark.x.max()) for mark in panel.marks if isinstance(mark, Area)]
    passing = found.design[found.design["verdict"] == "pass"]
    assert strips == list(zip(passing["low"], passing["high"], strict=True))
    above = [mark for mark in panel.marks if isinstance(mark, Points) and (mark.y > panel.y.last).any()]
    assert [mark.label for mark in above] == ["rotation", "stands"]


def test_a_design_without_a_check_has_a_panel_with_the_limit_alone():
    design = {"between": [1.0, 1.2], "points": 2, "width": 0.1}
    found = rb.design(study(design, cases=[RIGID, PADS], check=[ROTATION | {"case": RIGID["name"]}]))
    panels = figure_of(found.info, found.design, found.design_values, found.design_checks).panels
    lines = {panel.caption: [mark.label for mark in panel.marks if isinstance(mark, Polyline)] for panel in panels}
    assert lines == {RIGID["name"]: ["rotation"], PADS["name"]: []}


def test_the_map_fills_what_fails_and_marks_what_passes_by_the_check_that_governs():
    design = {
        "vary": ["pier.p", "case.restitution"],
        "between": [[1.0, 3.0], [0.8, 0.9]],
        "points": [3, 2],
        "width": 0.3,
    }
    found = rb.design(study(design, cases=[RIGID | {"restitution": 0.9}], check=[STANDS, ROTATION]))
    (panel,) = figure_of(found.info, found.design, found.design_values, found.design_checks).panels
    values = found.design_values
    filled = {mark.label: np.isnan(mark.x).sum() for mark in panel.marks if isinstance(mark, Area)}
    assert filled == {
        f"{check} fails": n for check, n in values.query("verdict == 'fail'")["check"].value_counts().items()
    }
    marked = {mark.label: len(mark.x) for mark in panel.marks if isinstance(mark, Points)}
    passing = values.query("verdict == 'pass'")["check"].value_counts()
    assert marked == {f"passes, closest: {check}": n for check, n in passing.items()}
    colours = {mark.label.split()[0]: mark.look.colour for mark in panel.marks if isinstance(mark, Area)}
    assert colours["rotation"] != colours["stands"]


# Folders


@pytest.mark.slow
def test_an_interrupted_search_runs_only_what_is_missing(tmp_path, monkeypatch):
    path = write_study(tmp_path, study_text(pier=PIER, pulses=[PULSE], cases=[RIGID], check=[ROTATION], design=SIZE))
    real, simulated, out = rockbatch.batch.threads.outcomes_of, [], tmp_path / "out"

    def counted(runs, *more):
        simulated.append(len(runs))
        return real(runs, *more)

    def interrupted(runs, *more):
        if simulated:
            raise KeyboardInterrupt
        return counted(runs, *more)

    with monkeypatch.context() as patch:
        patch.setattr(rockbatch.batch.threads, "outcomes_of", interrupted)
        with pytest.raises(KeyboardInterrupt):
            rb.design(path, out, jobs=1)
    first = sum(simulated)
    monkeypatch.setattr(rockbatch.batch.threads, "outcomes_of", counted)
    found = rb.design(path, out, jobs=1)
    assert first == 4
    assert sum(simulated) == len(found.design_runs) > first
    in_memory = rb.design(path, jobs=1)
    pd.testing.assert_frame_equal(found.design_runs, in_memory.design_runs, check_exact=True)
    simulated.clear()
    again = rb.design(path, out, jobs=1)
    assert simulated == []
    pd.testing.assert_frame_equal(again.design, found.design, check_exact=True)


def test_a_finished_search_with_sections_is_read_again(tmp_path, monkeypatch):
    of_study = study(OF_SPRINGS, cases=[SPRINGS], check=[MOMENT, STIFF], pier=TALL, output=SECTIONS)
    found = rb.design(of_study, tmp_path)
    monkeypatch.setattr(rockbatch.batch.threads, "outcomes_of", None)
    again = rb.design(of_study, tmp_path)
    pd.testing.assert_frame_equal(again.design_checks, found.design_checks, check_exact=True)


@pytest.fixture
def simulated(monkeypatch):
    """The number of runs in each group that was carried out."""
    real, numbers = rockbatch.batch.threads.outcomes_of, []

    def counted(runs, *more):
        numbers.append(len(runs))
        return real(runs, *more)

    monkeypatch.setattr(rockbatch.batch.threads, "outcomes_of", counted)
    return numbers


def csv_files(folder):
    return {path.name: path.read_bytes() for path in folder.glob("*.csv")}


def test_another_limit_or_another_scan_runs_only_values_that_were_not_run(tmp_path, simulated):
    """Its files are those of a search of its own, also when a scan shrinks and grows again; the journal only ever grows."""
    first, changed = study(), study({"points": 7}, check=[ROTATION | {"at_most": 0.4}])
    run, lines = set(), 1
    for of_study in (first, changed, first, changed):
        simulated.clear()
        found = rb.design(of_study, tmp_path / "out", jobs=1)
        made = sum(simulated)
        rb.design(of_study, tmp_path / "alone", jobs=1, fresh=True)
        assert csv_files(tmp_path / "out") == csv_files(tmp_path / "alone")
        values = set(found.design_runs["pier.p"])
        assert made == len(values - run)
        assert not run or values & run
        run |= values
        lines += made
        assert len((tmp_path / "out/design_runs.csv.part").read_bytes().splitlines()) == lines


def test_runs_of_a_finished_search_are_replaced_when_the_pier_changes(tmp_path, simulated):
    rb.design(study(), tmp_path / "out", jobs=1)
    other = study(pier=PIER | {"alpha": 0.19})
    for folder in ("out", "alone"):
        simulated.clear()
        found = rb.design(other, tmp_path / folder, jobs=1)
        assert sum(simulated) == len(found.design_runs)
    assert csv_files(tmp_path / "out") == csv_files(tmp_path / "alone")


def test_finished_runs_stay_until_the_first_run_of_a_changed_pier_ends(tmp_path, simulated, monkeypatch):
    rb.design(study(), tmp_path / "out", jobs=1)
    before = csv_files(tmp_path / "out")
    with monkeypatch.context() as patched:
        patched.setattr("rockbatch.analyses.design.analysis.make_ready", lambda *_: interrupt())
        with pytest.raises(KeyboardInterrupt):
            rb.design(study(pier=PIER | {"alpha": 0.19}), tmp_path / "out", jobs=1)
    simulated.clear()
    rb.design(study(), tmp_path / "out", jobs=1)
    assert sum(simulated) == 0
    assert csv_files(tmp_path / "out") == before


def interrupt():
    """Stop as Ctrl-C does."""
    raise KeyboardInterrupt


def test_edited_runs_of_a_search_are_refused_and_stay(tmp_path, simulated):
    rb.design(study(), tmp_path / "out", jobs=1)
    path = tmp_path / "out/design_runs.csv"
    edited = path.read_text().replace("ok", "failed", 1)
    path.write_text(edited)
    with pytest.raises(InputError, match="edited or damaged"):
        rb.design(study(), tmp_path / "out", jobs=1)
    assert path.read_text() == edited


def test_another_limit_keeps_the_forces_in_sections_of_finished_runs(tmp_path, simulated):
    stiffer = STIFF | {"at_least": 1.6e6}
    for check in ([MOMENT, STIFF], [MOMENT, stiffer]):
        of_study = study(OF_SPRINGS, cases=[SPRINGS], check=check, pier=TALL, output=SECTIONS)
        before = len(simulated)
        rb.design(of_study, tmp_path / "out", jobs=1)
    made = sum(simulated[before:])
    rb.design(of_study, tmp_path / "alone", jobs=1)
    assert made == 2 < sum(simulated[before:]) - made
    assert csv_files(tmp_path / "out") == csv_files(tmp_path / "alone")


def test_an_interrupted_search_goes_on_with_another_limit_but_not_with_another_pier(tmp_path, monkeypatch):
    out, real, calls = tmp_path / "out", rockbatch.batch.threads.outcomes_of, []

    def interrupted(runs, *more):
        calls.append(len(runs))
        if len(calls) > 1:
            raise KeyboardInterrupt
        return real(runs, *more)

    with monkeypatch.context() as patch:
        patch.setattr(rockbatch.batch.threads, "outcomes_of", interrupted)
        with pytest.raises(KeyboardInterrupt):
            rb.design(study(), out, jobs=1)
    with pytest.raises(InputError, match=r"finished runs, but something has changed since \(studies, cases\)"):
        rb.design(study(pier=PIER | {"alpha": 0.19}), out, jobs=1)
    found = rb.design(study(check=[ROTATION | {"at_most": 0.4}]), out, jobs=1)
    alone = rb.design(study(check=[ROTATION | {"at_most": 0.4}]), jobs=1)
    pd.testing.assert_frame_equal(found.design_runs, alone.design_runs, check_exact=True)


@pytest.mark.usefixtures("pages")
def test_the_command_counts_its_runs_beforehand_and_prints_the_answer(tmp_path, capsys):
    text = study_text(pier=PIER, pulses=[PULSE], cases=[RIGID], check=[ROTATION], design=SIZE)
    assert main(["design", str(write_study(tmp_path, text)), "--out", str(tmp_path / "out")]) == 0
    said, printed = (getattr(captured, name) for captured in [capsys.readouterr()] for name in ("err", "out"))
    assert "4 values of pier.p × 1 design: 4 runs on " in said
    assert "then each change of verdict is narrowed from 0.4 to 0.01, up to 6 runs each" in said
    info = json.loads((tmp_path / "out/design.json").read_text(encoding="utf-8"))
    assert info["runs"] == info["tried"] == 4 + 6
    assert "✓ The greatest pier.p found that passes every check is " in printed
    ends = [
        re.findall(r"[\d.]+: rotation at [\d.]+ %", line) for line in printed.splitlines() if "end of the scan" in line
    ]
    assert len(ends[0]) == 1
    assert ends[0] == ends[1]  # of the value that fails, whether it lies within the interval or beyond it
    page = (tmp_path / "out/analyses.html").read_text(encoding="utf-8")
    assert "✓ The greatest pier.p found that passes every check is " in page
    assert "demand over limit" in page
    worse = text.replace("0.5\nreason", "0.01\nreason")
    assert main(["design", str(write_study(tmp_path, worse, "worse.toml")), "--out", str(tmp_path / "worse")]) == 1


@pytest.mark.usefixtures("pages")
def test_the_command_counts_only_runs_that_are_not_finished(tmp_path, capsys):
    for design, runs in ((SIZE, 4), (SIZE | {"between": [1.0, 2.6], "points": 5}, 1)):
        text = study_text(pier=PIER, pulses=[PULSE], cases=[RIGID], check=[ROTATION], design=design)
        assert main(["design", str(write_study(tmp_path, text)), "--out", str(tmp_path / "out")]) == 0
        assert f"values of pier.p × 1 design: {runs} run" in capsys.readouterr().err


# Mistakes


@pytest.mark.parametrize(
    ("design", "words"),
    [
        ({"vary": "case.zeta", "between": [0.01, 0.1]}, '"case.zeta": no case has this key; write its value there'),
        ({"vary": "case.damper.force_kN"}, '"case.damper.force_kN": no case has this key'),
        (
            {"vary": "pier.height_m", "between": [10.0, 20.0]},
            '"pier.height_m": [pier] has no such key; write its value there, or vary "pier.alpha" or "pier.p"',
        ),
        ({"vary": "pier.pp"}, '"pier.pp": no such key; did you mean pier.p?'),
        ({"vary": "case.base"}, '"case.base": another value makes another design'),
        ({"vary": "pier.gravity"}, '"pier.gravity": motions that are given in g would change with it'),
        ({"vary": "case.kinematics"}, "case.kinematics = 1: "),
        ({"vary": ["pier.p", "pier.p"]}, 'vary = "pier.p": given twice; write it once'),
        ({"vary": ["pier.p", "pier.alpha", "pier.mass_t"]}, "vary: expected one key or two"),
        ({"vary": ["pier.p", "pier.alpha"]}, "between: expected a range for each key of vary"),
        ({"between": [2.0, 1.0]}, "between: 2 is not below 1; write [1, 2]"),
        ({"between": [1.0, 1.0]}, "between: 1 is not below 1"),
        ({"between": 1.0}, "between: expected a range for each key of vary; write for example between = [0.02, 0.2]"),
        ({"between": [-1.0, 2.0]}, "pier.p = -1: "),
        ({"width": 0.0}, "width = 0.0: expected a number above 0"),
        ({"width": -0.1}, "width = -0.1: expected a number above 0"),
        ({"width": 0.5}, "width = 0.5: the values of the scan are 0.4 apart, and a width is less"),
        ({"width": 1e-9}, "width = 1e-09: must be 2.2e-06 or above"),
        ({"points": 1}, "points = 1: expected a whole number from 2 to 1000"),
        ({"points": [4, 3]}, "points: expected one number for each key of vary, or one for all"),
        ({"find": "best"}, 'find = "best": '),
        ({"find": "smallest"}, 'find = "smallest": did you mean "least"?'),
        ({"steps": 4}, "steps: unknown key"),
    ],
)
def test_a_mistake_in_what_is_varied_is_refused_with_the_remedy(design, words):
    with pytest.raises(InputError) as raised:
        read_design(study(design))
    assert words in str(raised.value)
    assert "[design]" in str(raised.value)


def test_without_a_width_a_change_of_verdict_is_narrowed_to_an_eighth_of_the_step():
    read = read_design(rb.Study.from_toml(study_text(
        pier=PIER, pulses=[PULSE], cases=[RIGID], check=[ROTATION], design={k: SIZE[k] for k in SIZE if k != "width"}
    )))  # fmt: skip
    assert (read.vary[0].step, read.width) == (pytest.approx(0.4), 0.05)


def test_without_checks_or_table_there_is_nothing_to_find():
    with pytest.raises(InputError, match=r"there is no \[\[check\]\], so that every value would pass; write one"):
        read_design(study(check=()))
    with pytest.raises(InputError, match=r'\[design\] is missing; write \[design\] with vary = "case.damper.f"'):
        read_design(rb.Study.from_toml(study_text()))
