"""The scorecard: cases by checks, in an order by which they are chosen, and never another answer than the sentence above it."""

import math
import random
import re
from dataclasses import replace

import pytest
from check_samples import RIGID, runs, verdict

from rockbatch.checks import wording
from rockbatch.checks.answer import answer
from rockbatch.checks.coverage import CaseRuns
from rockbatch.checks.responses import worst_of_cases
from rockbatch.checks.scorecard import Row, scorecard
from rockbatch.checks.verdicts import DOES_NOT_APPLY, FAIL, NOT_DECIDED, PASS
from rockbatch.commands.scorecard import of_checks


def name_of(one):
    return one.case


def test_the_worst_check_is_the_first_column_and_the_best_case_the_first_row():
    card = scorecard(
        [
            verdict("a", "fail", check="drift", ratio=2.0), verdict("a", "pass", check="tilt", ratio=0.9),
            verdict("b", "fail", check="drift", ratio=1.1), verdict("b", "pass", check="tilt", ratio=0.2),
            verdict("c", "not decided", check="drift", ratio=1.0), verdict("c", "pass", check="tilt", ratio=0.1),
            verdict("d", "pass", check="drift", ratio=0.8), verdict("d", "fail", check="soil", ratio=3.0),
            verdict("e", "pass", check="drift", ratio=0.7),
        ],
        name_of,
    )  # fmt: skip
    assert [column.check for column in card.columns] == ["soil", "drift", "tilt"]
    assert [(row.name, row.verdict) for row in card.rows] == [
        ("e", PASS), ("c", NOT_DECIDED), ("b", FAIL), ("a", FAIL), ("d", FAIL),
    ]  # fmt: skip
    assert [row.in_words for row in card.rows] == [
        "passes 1 check", "1 check not decided", "fails 1 check", "fails 1 check", "fails 1 check",
    ]  # fmt: skip
    assert card.rows[0].cells[0] is None  # soil says nothing of it


def test_a_ban_that_fails_is_worse_than_any_share_of_a_limit_and_another_is_better():
    ban = {"demand": "overturned", "statistic": "max", "limit": 0.5}
    worst_first = [
        (FAIL, 2.0, ban), (FAIL, 3.0, {}), (FAIL, 1.1, {}), (NOT_DECIDED, 1.5, {}), (NOT_DECIDED, 0.4, {}),
        (NOT_DECIDED, 0.0, ban), (NOT_DECIDED, math.nan, {}), (PASS, 0.9, {}), (PASS, 0.0, {}), (PASS, 0.2, ban),
    ]  # fmt: skip
    found = [
        verdict("a", kind, check=f"c{i}", ratio=share, **more) for i, (kind, share, more) in enumerate(worst_first)
    ]
    for given in (found, found[::-1], found[::2] + found[1::2]):
        assert [column.check for column in scorecard(given, name_of).columns] == [f"c{i}" for i in range(len(found))]
    without = scorecard([verdict("a", DOES_NOT_APPLY, check="none", ratio=9.0), *found], name_of)
    assert without.columns[-1].check == "none" or without.columns[-2].check == "none"


def test_a_check_stands_where_its_worst_verdict_is_whatever_its_best_one():
    shares = {"wide": (0.1, 0.9), "narrow": (0.5, 0.6), "low": (0.3, 0.2)}
    given = [
        verdict(name, "pass", check=check, ratio=share)
        for check, own in shares.items()
        for name, share in zip("ab", own, strict=True)
    ]
    for one in (given, given[::-1]):
        assert [column.check for column in scorecard(one, name_of).columns] == ["wide", "narrow", "low"]


def test_columns_that_fail_or_are_open_always_stand_and_others_up_to_a_number():
    failing = [verdict("a", "fail", check=f"f{i}", ratio=2.0) for i in range(5)]
    passing = [verdict("a", "pass", check=f"p{i}", ratio=0.1 * i) for i in range(5)]
    card = scorecard([*passing, *failing], name_of)
    assert [card.columns[i].check for i in card.open_columns(3)] == [f"f{i}" for i in range(5)]
    assert [card.columns[i].check for i in card.open_columns(7)][5:] == ["p4", "p3"]
    assert len(card.open_columns(20)) == 10


@pytest.mark.parametrize(
    ("unit", "limit", "sense", "shown"),
    [("m", 0.05, "at most", "≤ 50 mm"), ("m", 1.5, "at most", "≤ 1.5 m"), ("m", 1.0, "at most", "≤ 1 m"),
     ("m/s", 0.25, "at most", "≤ 250 mm/s"), ("m/s", 2.5, "at most", "≤ 2.5 m/s"), ("kN", 0.5, "at most", "≤ 0.5 kN"),
     ("rad", 0.01, "at most", "≤ 10 mrad"),
     ("", 2.0, "at least", "≥ 2"), ("kN", 300_000.0, "at most", "≤ 300,000 kN")],
)  # fmt: skip
def test_limits_stand_in_units_of_their_size(unit, limit, sense, shown):
    card = scorecard([verdict("a", "pass", unit=unit, limit=limit, sense=sense, value=0.5 * limit)], name_of)
    assert card.columns[0].limit.replace("\u00a0", " ") == shown
    assert float(card.rows[0].cells[0].value.replace(",", "")) == pytest.approx(0.5 * limit * card.columns[0].factor)


@pytest.mark.parametrize(
    ("value", "ratio", "high", "cell"),
    [(0.025, 0.5, 0.025, ("25", "50 %")), (0.0500001, 1.000002, 0.05, ("50.0001", "100.000 %")),
     (0.05, 1.0, 0.05, ("50", "100 %")),
     (math.inf, math.inf, math.inf, ("∞", "∞")), (0.04, 0.8, math.inf, ("≥ 40", "≥ 80 %")), (1e-16, 2e-15, 1e-16, ("0", "0 %")),
     (math.nan, math.nan, math.nan, ("", ""))],
)  # fmt: skip
def test_a_cell_never_shows_a_demand_on_the_other_side_of_its_limit(value, ratio, high, cell):
    one = verdict("a", "fail", unit="m", limit=0.05, value=value, ratio=ratio, high=high)
    shown = scorecard([one], name_of).rows[0].cells[0]
    assert (shown.value.replace("\u00a0", " "), shown.percent.replace("\u00a0", " ")) == cell


@pytest.mark.parametrize(
    ("low", "high", "shown"),
    [(0.02, 0.03, "20 – 30"), (0.025, 0.03, "25 – 30"), (0.0, 0.025, "0 – 25"), (0.025, 0.025, ""), (0.025 - 1e-9, 0.025, ""),
     (0.02, math.inf, "")],
)  # fmt: skip
def test_a_cell_has_the_bounds_of_a_demand_where_digits_that_are_shown_differ(low, high, shown):
    one = verdict("a", "pass", unit="m", limit=0.05, value=0.025, low=low, high=high)
    assert scorecard([one], name_of).rows[0].cells[0].bounds == shown


@pytest.mark.parametrize(("heights", "shared"), [((7.5, 7.5), True), ((7.5, 9.0), False), ((7.5, math.nan), True)])
def test_a_height_is_in_the_head_if_all_have_it_and_else_in_their_cells(heights, shared):
    found = [verdict(name, "pass", at_m=at) for name, at in zip("ab", heights, strict=True)]
    card = scorecard(found, name_of)
    assert ("7.5\u00a0m" in card.columns[0].at) == shared
    assert {row.name: "7.5\u00a0m" in row.cells[0].value for row in card.rows} == {"a": not shared, "b": False}
    assert shared or {row.name: "9\u00a0m" in row.cells[0].value for row in card.rows} == {"a": False, "b": True}
    assert scorecard([verdict("a", "pass")], name_of).columns[0].at == ""


@pytest.mark.parametrize("event", [{}, {"demand": "overturned", "statistic": "max", "limit": 0.0, "value": 1.0}])
def test_a_cell_names_the_bound_of_the_design_under_which_it_is_worst(event):
    kinds = (("", PASS, 0.9), ("soft", FAIL, 1.5))
    under = [verdict("a", kind, ratio=ratio, columns={"bound": name}, **event) for name, kind, ratio in kinds]
    assert scorecard(under, name_of).rows[0].cells[0].design_bound == "soft"
    assert scorecard(under[:1], name_of).rows[0].cells[0].design_bound == ""
    alike = [replace(under[0], columns={"bound": name}) for name in ("", "soft")]  # it fails as it is nominally, too
    assert scorecard(alike, name_of).rows[0].cells[0].design_bound == ""


def test_a_case_of_which_no_run_stands_is_told_from_one_without_checks():
    fallen = [CaseRuns(name, {}, 1.0, 4, {"overturned": 4}) for name in ("a", "b")]
    a, b = sorted(scorecard([verdict("a", PASS)], name_of, fallen).rows)
    assert (a.verdict, b.verdict) == (DOES_NOT_APPLY, DOES_NOT_APPLY)
    assert a.in_words != b.in_words
    none = Row("c", DOES_NOT_APPLY, [None])
    assert b.in_words == none.in_words


def test_a_ban_stands_in_words():
    ban = {"demand": "overturned", "statistic": "max", "limit": 0.0, "check": "stands"}
    card = scorecard([verdict("a", "fail", **ban, value=1.0, high=1.0, ratio=math.inf),
                      verdict("b", "pass", **ban, value=0.0, high=0.0, ratio=0.0)], name_of)  # fmt: skip
    assert card.columns[0].limit == "none"
    assert [(row.name, row.cells[0].value, row.cells[0].percent) for row in card.rows] == [
        ("b", "none", ""),
        ("a", "some", ""),
    ]


def test_a_case_without_a_limit_on_what_governs_says_so_instead_of_passing():
    worst = worst_of_cases(runs(name="rigid"), [RIGID], at_each_scale=True)
    (row,) = scorecard([verdict("rigid", "pass", demand="static_deflection_m")], name_of, (), worst).rows
    assert (row.verdict, row.in_words) == (NOT_DECIDED, "no limit on rotation")
    (row,) = scorecard([verdict("rigid", "pass", demand="theta_max_over_alpha")], name_of, (), worst).rows
    assert (row.verdict, row.in_words) == (PASS, "passes 1 check")


def test_sentence_and_scorecard_count_the_same_on_random_verdicts():
    """Of some hundred made-up studies: what the lines say of cases is what the rows are."""
    chance = random.Random(46)
    kinds = [PASS, FAIL, NOT_DECIDED, DOES_NOT_APPLY]
    for _ in range(300):
        cases = [f"c{i}" for i in range(chance.randint(1, 6))]
        found = [
            verdict(name, chance.choice(kinds), check=f"k{k}", ratio=chance.uniform(0.1, 3.0), remarks=("few",))
            for name in cases
            for k in range(chance.randint(0, 3))
        ]
        counted = [CaseRuns(name, {}, 1.0, 4, {"overturned": 4} if chance.random() < 0.2 else {}) for name in cases]
        rows = scorecard(found, name_of, counted).rows
        assert sorted(row.name for row in rows) == cases
        if not found:
            continue
        said = {kind: 0 for kind in (PASS, FAIL, NOT_DECIDED, DOES_NOT_APPLY)}
        for line in answer(found, (), name_of, str, counted):
            total = len(cases)
            among = {"the only case": 1, "both cases": 2, f"all {total} cases": total}
            number = next((n for words, n in among.items() if words in line.text.lower()), None)
            number = int(re.match(r"(\d+) of", line.text)[1]) if number is None and line.text[0].isdigit() else number
            if "pass" in line.text:
                said[PASS] += number
                if unchecked := re.search(r"; (\d+) (?:is|are) not checked", line.text):
                    said[DOES_NOT_APPLY] += int(unchecked[1])
            elif "fail" in line.text and "Left" not in line.text:
                said[FAIL] += number
            elif "cannot be decided" in line.text:
                said[NOT_DECIDED] += number
            elif "not checked" in line.text:
                said[DOES_NOT_APPLY] += number
        assert said == {kind: sum(row.verdict == kind for row in rows) for kind in said}
    assert wording.percent(1.0).startswith("100")


def test_the_text_counts_columns_left_out_and_names_unchecked_cases():
    found = [verdict("a", PASS, check=f"p{i}") for i in range(8)]
    found += [verdict("b", DOES_NOT_APPLY, check=f"p{i}") for i in range(8)]
    a, b = scorecard(found, name_of).rows
    lines = of_checks(found, name_of, (), (), str).splitlines()
    assert [line.split()[0] for line in lines[-2:]] == ["a", "b"]
    assert "3 more" in lines[-2]
    assert lines[-2].endswith(a.in_words)
    assert lines[-1].endswith(b.in_words)


def test_the_text_names_the_records_that_govern_each_check_the_most_frequent_first():
    rows = zip("abc", ("r2", "r1", "r1"), strict=True)
    found = [verdict(case, PASS, record=record, value=0.3, governing=0.3) for case, record in rows]
    found += [verdict(case, FAIL, check="q", record="r3", value=0.6, governing=0.6) for case in "ab"]
    found += [verdict("a", PASS, check="mean", record="r4", value=0.2, governing=math.inf)]  # sets no mean
    text = of_checks(found, name_of, (), (), lambda verdict: verdict.record.upper())
    said = [line for line in text.splitlines() if line.startswith("governs ")]
    assert said == ["governs q: R3", f"governs {found[0].check}: R1 (2 of 3 cases); R2 (1 of 3 cases)"]
    assert "largest in mean: R4" in text.splitlines()


def test_a_response_without_a_limit_on_both_axes_is_named_once():
    row = Row("rock", NOT_DECIDED, [], ("rotation", "rotation", "drift"))
    assert row.in_words == "no limit on rotation, drift"
