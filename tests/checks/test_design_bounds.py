"""A design passes if it does under all of its bounds; the answer and the scorecard show the worst, with its bound."""

import pandas as pd
import pytest
from check_samples import case, runs, verdict
from studies import seven_pulses, study_text, write_study

import rockbatch as rb
from rockbatch.checks import Rule, judge, read_verdicts, write_verdicts
from rockbatch.checks.answer import answer
from rockbatch.checks.coverage import runs_of_cases
from rockbatch.checks.remarks import bounds_in_words
from rockbatch.checks.scorecard import scorecard
from rockbatch.checks.verdicts import FAIL, NOT_DECIDED, PASS

LIMIT = Rule("rotation", "theta_max_over_alpha", at_most=0.5)
BOUNDS = ("", "stiff", "soft")
SPRINGS = {"base": "elastic", "beta": 50.0}


def of_designs(**designs):
    """Rotations of each design under BOUNDS, one record each: verdicts, runs of the cases."""
    cases = [case(name, bound=bound) for name in designs for bound in BOUNDS]
    table = pd.concat(
        [runs([value], name=name, bound=b) for name, v in designs.items() for b, value in zip(BOUNDS, v, strict=True)],
        ignore_index=True,
    )
    return judge([LIMIT], table, cases), runs_of_cases(table, cases, 1)


def lines(verdicts, suites=()):
    return answer(verdicts, (), lambda row: row.case, lambda row: row.record, suites)


def test_each_bound_is_judged_alone_and_the_nominal_design_is_not_mixed_with_it():
    verdicts, _ = of_designs(pads=(0.2, 0.3, 0.4))
    assert [(v.columns["bound"], v.value, v.records) for v in verdicts] == [
        ("", 0.2, 1),
        ("stiff", 0.3, 1),
        ("soft", 0.4, 1),
    ]


def test_a_design_passes_only_under_every_bound_and_designs_are_counted():
    """Of two designs one fails under one bound of three: one of two passes, not five of six."""
    (passing, failing) = lines(*of_designs(pads=(0.2, 0.3, 0.4), rock=(0.2, 0.6, 0.3)))
    assert (passing.verdict, passing.text, passing.cases) == (
        PASS,
        "1 of 2 cases passes every check under every bound",
        "pads",
    )
    assert passing.details[0] == "Closest to its limit: pads, rotation, under soft at 80\u00a0%."
    assert (failing.verdict, failing.text) == (FAIL, "1 of 2 cases fails")
    assert failing.details == (
        "Nearest to passing: rock, rotation, under stiff at 120\u00a0% of its limit.",
        "rock fails under stiff only.",
    )


def test_a_design_that_fails_nominally_is_not_said_to_fail_by_its_bounds():
    (failing,) = lines(*of_designs(pads=(0.7, 0.6, 0.3)))
    assert failing.text == "The only case fails"
    assert failing.details == ("Nearest to passing: rotation at 140\u00a0% of its limit.",)


def test_a_bound_under_which_no_run_stands_leaves_the_design_unchecked():
    verdicts, suites = of_designs(pads=(0.2, 0.3, 0.4))
    fallen = [
        suite._replace(ended={"overturned": 1}) if suite.columns["bound"] == "soft" else suite for suite in suites
    ]
    (line,) = lines(verdicts, fallen)
    assert (line.verdict, line.text) == (NOT_DECIDED, "The only case is not checked")
    assert line.cases == "pads, 1 of 3 runs overturned"


@pytest.mark.parametrize(
    ("under_bounds", "worst", "percent"),
    [((0.2, 0.3, 0.45), "soft", "90"), ((0.44, 0.3, 0.2), "", "88"), ((0.3, 0.6, 0.7), "soft", "140")],
)
def test_a_cell_has_the_worst_verdict_of_a_design_and_its_bound(under_bounds, worst, percent):
    verdicts, suites = of_designs(pads=under_bounds)
    card = scorecard(verdicts, lambda row: row.case, suites)
    (row,) = card.rows
    assert (row.cells[0].design_bound, row.cells[0].percent) == (worst, f"{percent}\u00a0%")
    assert row.verdict == (PASS if max(under_bounds) <= 0.5 else FAIL)


def test_an_undecided_bound_leaves_a_design_undecided_and_is_named():
    judged = [verdict("pads", PASS, columns={"bound": ""}), verdict("pads", NOT_DECIDED, columns={"bound": "soft"})]
    (line,) = lines([vars_with(v, remarks=("no error estimate",)) for v in judged])
    assert line.text == "The only case cannot be decided"
    assert line.details[0].startswith("margin under soft: no error estimate")


def vars_with(of_verdict, **changes):
    return type(of_verdict)(**{**vars(of_verdict), **changes})


def test_checks_csv_has_the_bound_of_each_verdict(tmp_path):
    verdicts, _ = of_designs(pads=(0.2, 0.3, 0.4))
    text = write_verdicts(tmp_path, verdicts).read_text(encoding="utf-8")
    assert text.splitlines()[0].startswith("check,case,bound,scale")
    assert [v.columns for v in read_verdicts(tmp_path)] == [{"bound": bound} for bound in BOUNDS]


def test_bounds_and_cases_that_lack_their_keys_are_said_in_words():
    lacking = [{"case": "rock", "keys": ["case.beta"]}]
    bound = {"bound": "stiff", "source": "a test", "changes": ["case.beta × 2", "case.zeta = 0.02"], "lacking": lacking}
    assert bounds_in_words({"bounds": [bound]}) == [
        "Each case ran as it is nominally and, one at a time, under these bounds: stiff: case.beta × 2, case.zeta = 0.02 "
        "(a test).",
        "rock lacks case.beta, and ran without this change under stiff.",
    ]
    assert bounds_in_words({}) == []


def test_forces_in_sections_are_judged_under_every_bound_and_nominally(tmp_path):
    """From the tables on disk, in which the nominal design has an empty bound; one of two cases lacks the key that varies."""
    pier = {"width_m": 4.0, "height_m": 15.0, "mass_t": 900.0}
    checks = [
        {"name": "V", "demand": "section_shear_kN", "at_most": 1e5},
        {
            "name": "M",
            "demand": "section_moment_over_capacity",
            "at_most": 1.0,
            "capacity": [[-1e5, 0], [0, 1e6], [1e6, 0]],
        },
    ]
    text = study_text(
        pier=pier,
        pulses=seven_pulses(0.3)[:2],
        cases=[SPRINGS | {"name": "a", "zeta": [0.05, 0.1]}, SPRINGS | {"name": "b", "epsilon": 1.0}],
        bound=[{"name": "soft", "case.beta": {"times": 0.7}}],
        check=[check | {"at_m": 5.0, "reason": "made up", "confirm": ["at_most", "capacity"]} for check in checks],
        output={"sections_m": [5.0], "interaction_m": [5.0]},
    )
    rb.run(write_study(tmp_path, text), out=tmp_path / "out")
    verdicts = rb.check(tmp_path / "out")
    assert len(verdicts) == 3 * 2 * 2
    assert {(row.bound, row.verdict) for row in verdicts.fillna({"bound": ""}).itertuples()} == {
        ("", PASS),
        ("soft", PASS),
    }
