"""Sentences of page, sheet and comparison, read back: each number in them is counted or computed anew from peaks.csv."""

import pandas as pd
import pytest
from messages import assert_states
from report_samples import FIG7, FOUNDATIONS, case_entry, write_results

from rockbatch.pier import Pier
from rockbatch.reporting import compared, overview
from rockbatch.reporting.finished import read
from rockbatch.reporting.pair import pair
from rockbatch.reporting.sections import answer, assumptions, studied

PIER = Pier(alpha=0.13, p=0.38)
CHANGES = {
    ("RRS228", "rigid"): {"status": "overturned", "theta_max_over_alpha": "", "t_end_s": 9.5},
    ("SYL360", "2"): {"status": "overturned", "theta_max_over_alpha": "", "t_end_s": 7.5},
    ("CPM000", "1"): {"status": "flight", "theta_max_over_alpha": "", "flight_s": 4.5},
    ("CPM000", "3"): {"status": "failed", "theta_max_over_alpha": "", "reason": "not settled"},
    ("ERZ-NS", "1"): {"flight_s": 3.5, "flight_height_m": 0.0234, "note": "flew"},
    ("SYL360", "4"): {"flight_s": 3.5, "flight_height_m": 0.0137, "theta_max_error": 7.31e-5},
    ("RRS228", "4"): {"theta_max_is": "lean", "theta_max_error": ""},
    ("RRS228", "3"): {"theta_max_is": "lean", "note": "leans"},
    ("RRS228", "2"): {"theta_max_is": "lean"},
}
UNUSABLE = [{"name": name, "source": name, "reason": "empty"} for name in ("x", "y")]


@pytest.fixture(scope="module")
def first(tmp_path_factory):
    """Return results of six records on five foundations, of which four do not end standing."""
    folder = tmp_path_factory.mktemp("first")
    return read(write_results(folder, changes=CHANGES, unusable=UNUSABLE))


@pytest.fixture(scope="module")
def second(tmp_path_factory):
    """Return other results of four of the records."""
    folder = tmp_path_factory.mktemp("second")
    changes = {("ERZ-NS", case): CHANGES["RRS228", "rigid"] for case in ("2", "3", "rigid")}
    changes["RRS228", "1"] = {"theta_max_over_alpha": 0.77}
    changes["RSN1120_KOBE_TAK000", "4"] = {"theta_max_over_alpha": 0.021}
    return read(write_results(folder, records=FIG7[:4], changes=changes))


def rows_of(finished):
    rows = pd.read_csv(finished.directory / "peaks.csv")
    return rows[rows["case"].notna()]


def test_runs_that_do_not_end_standing_are_counted_and_the_first_of_them_named(first):
    overturned, flown, lost = answer._without_a_result(first)
    assert_states(overturned, 2.0, 30.0, "SYL360", "2", "β", 40.0, "η", 3.5)
    assert_states(flown, "one run", "CPM000", "1", "β", 40.0, "η", 2.5)
    assert_states(lost, 2.0, "files", "one run failed", 1.0, "not settled")


def test_the_notes_below_the_answer_count_runs_and_name_the_greatest_error(first):
    assert_states(answer._standing(first), 26.0, 30.0)
    assert_states(answer._error(first), 0.00008, 0.0001, "one run")
    assert "2 runs have remarks" in "".join(map(str, answer._notes(first, checked=False)))


def test_the_caption_of_the_overview_counts_flights_and_leans(first):
    flown, leaning = overview._marks_in_words(first)
    assert_states(flown, 2.0, 23.4)
    assert_states(leaning, 3.0)


def test_the_line_below_the_title_counts_stations_components_and_runs(first):
    assert_states(studied.in_a_line(first), 0.13, 0.38, 6.0, 6.0, 30.0, 26.0)


def rotations_in_both(first, second):
    """Return rotations of A and of B by record and case, of all runs in common; NaN for runs that do not end standing."""
    a, b = (rows_of(one).set_index(["record", "case"]) for one in (first, second))
    common = a.index.intersection(b.index)
    return (rows.loc[common, "theta_max_over_alpha"].where(rows.loc[common, "status"] == "ok") for rows in (a, b))


def test_the_comparison_counts_pairs_and_names_the_extreme_ratios(first, second):
    a, b = rotations_in_both(first, second)
    ratio = (b / a).dropna()
    least, most = ratio.idxmin(), ratio.idxmax()
    assert_states(
        compared._pairs(pair(first, second)),
        *(1.0, len(ratio), len(a) - len(ratio), 1.0, ratio.min(), *least, ratio.max(), *most),
    )


def test_the_comparison_states_the_change_of_the_worst_over_runs_that_stand_in_both(first, second):
    a, b = rotations_in_both(first, second)
    stood = a.notna() & b.notna()
    change = 100.0 * (b[stood].max() / a[stood].max() - 1.0)
    said = str(compared.answer(pair(first, second))).partition(", mean settlement")[0]
    ends = int(a.isna().sum()), int(b.isna().sum())
    said = said[said.index("Of 20 runs") :]
    assert_states(said, 20.0, *ends, int(stood.sum()), 20.0, "rotation", change, a[stood].idxmax()[0], "RRS228")


def altered(alter):
    """Return the five foundations after each of their cases was altered."""
    cases = [case_entry(name, {}, PIER, base) for name, base in FOUNDATIONS]
    for case in cases:
        alter(case)
    return cases


def of_cases(names, **values):
    """Return a function that gives cases these parameters."""
    return lambda case: case["parameters"].update(values) if case["case"] in names else None


ASSUMED = {
    "friction": (assumptions._sliding, of_cases("34", friction=0.35), [0.35, "(3; 4)"]),
    "damping": (assumptions._damping, of_cases("12", zeta=0.07), ["ζ", 0.07, "(1; 2)"]),
    "landings": (assumptions._landings, of_cases(["rigid"], restitution=0.83), [0.83, "ε", 0.05, "(1; 2; 3; 4)"]),
    "flight": (assumptions._flight, of_cases("13", flight="stop"), ["(rigid; 2; 4)", "(1; 3)"]),
}


@pytest.mark.parametrize("name", ASSUMED)
def test_an_assumption_has_the_values_and_the_cases_of_which_it_speaks(name):
    said, alter, expected = ASSUMED[name]
    cases = altered(alter)
    names = [text for text in expected if isinstance(text, str) and text.startswith("(")]
    text = said(cases)
    for of_those in names:
        assert of_those in text
        text = text.replace(of_those, "")
    assert_states(text, *(value for value in expected if value not in names))


def test_numerics_are_those_of_the_run():
    assert_states(assumptions._numerics({"quiet_s": 2.5, "tolerance": 3e-4}, []), 2.5, 0.0003)
    assert_states(assumptions._numerics({"quiet_s": 2.5, "tolerance": None}, []), 2.5)
