"""The first sentences of a sensitivity study name the inputs that matter most, and say what puts that in doubt."""

import html
import math
import re

import pandas as pd
import pytest

from rockbatch.analyses.sensitivity.answer import answer
from rockbatch.analyses.sensitivity.quantities import of_inputs

INFO = {"varied": [], "statistic": "median", "motions": 3, "overturned": 1.0, "statuses": {"ok": 60}}


def said(cases, **more):
    """What the page says of cases of inputs (name, total, error, answers at both ends), and what of it is marked."""
    rows = [
        {"case": case, "parameter": name, "low": 0.3, "base": 0.4, "high": 0.5, "answer_low": low, "answer_base": 0.2}
        | {
            "answer_high": high,
            "swing": max(low, high, 0.2) - min(low, high, 0.2),
            "total": total,
            "total_error": error,
        }
        for case, inputs in cases.items()
        for name, total, error, low, high in inputs
    ]
    table = pd.DataFrame(rows)
    indices = ["case", "parameter", "total", "total_error"]
    page = answer(INFO | more, table.drop(columns=indices[2:]), table[indices])
    lines = re.findall(r"<p[^>]*>(.*?)</p>", page)
    marked = re.findall(r'<span class="undecided">(.*?)</span>', page)
    return [html.unescape(re.sub("<.*?>", "", line)).replace("\u00a0", " ") for line in lines], marked


def test_inputs_are_ordered_by_total_index_and_the_greatest_swing_stands_apart():
    """The order of the table is that of the swings, in which a choice comes first here."""
    (line,), marked = said(
        {
            "rock": [
                ("kinematics", 0.02, 0.01, 0.2, 0.6), ("p", 0.7, 0.1, 0.1, 0.3), ("beta", 0.2, 0.05, 0.15, 0.25),
                ("n", 0.01, 0.01, 0.2, 0.2),
            ]
        }
    )  # fmt: skip
    assert line == (
        "The median of θmax/α over 3 motions depends most on p (total Sobol index 0.70 ± 0.10), then β (0.20 ± 0.05); the other "
        "2 hardly matter (0.03 at most). Alone kinematics moves it from 0.2 at 0.3 to 0.6 at 0.5 (0.2 in the study)."
    )
    assert not marked


def test_an_input_whose_interval_reaches_far_is_not_said_to_hardly_matter():
    (line,), _ = said({"rock": [("p", 0.9, 0.1, 0.1, 0.3), ("n", 0.01, 0.2, 0.2, 0.2)]})
    assert "; n may matter, too (0.21 at most)." in line


@pytest.mark.parametrize(("inputs", "words"), [
    ([("p", 0.5, 0.2, 0.1, 0.3), ("beta", 0.4, 0.2, 0.1, 0.3)], "more samples would tell p and β apart"),
    ([("p", 0.5, 0.4, 0.1, 0.3), ("beta", 0.02, 0.01, 0.1, 0.3)], "more samples would narrow that interval"),
])  # fmt: skip
def test_indices_that_do_not_tell_the_order_are_marked_so(inputs, words):
    _, marked = said({"rock": inputs})
    assert marked == [words]


def test_an_answer_that_nothing_changes_is_attributed_to_nothing():
    """As where every run overturns and counts as 1."""
    (line, ended), marked = said(
        {"rock": [("p", math.nan, math.nan, 0.2, 0.2)]}, statuses={"overturned": 59, "flight": 1}
    )
    assert line.endswith("is 0.2 whatever the inputs are: there is nothing to attribute to any of them.")
    assert ended == "60 of 60 runs overturned or were ended by flight, and count as 1 here."
    assert len(marked) == 2


def test_an_answer_at_which_runs_are_cut_is_that_or_more():
    """Half of the runs overturn at 0.5, and at 0.3 the median is known: a swing of 0.8 is the least there is."""
    (line,), _ = said({"rock": [("p", 0.9, 0.1, 0.2, 1.0)]})
    assert line.endswith("Alone p moves it from 0.2 at 0.3 to 1 or more at 0.5 (0.2 in the study).")
    answers = [head.value for head in of_inputs(INFO) if head.group == "answer at"]
    row = {"answer_low": 0.2, "answer_base": 0.9999, "answer_high": 1.0}
    assert [answer(row) for answer in answers] == [0.2, 0.9999, "≥ 1.0000"]


def test_runs_without_a_peak_are_counted():
    lines, _ = said({"rock": [("p", 0.9, 0.1, 0.1, 0.3)]}, statuses={"ok": 50, "overturned": 7, "failed": 3})
    assert lines[1:] == [
        "7 of 60 runs overturned or were ended by flight, and count as 1 here.",
        "3 of 60 runs failed, and count with their best value.",
    ]


def test_each_of_a_few_cases_has_its_sentence_in_the_order_of_the_study():
    lines, _ = said({"rock": [("p", 0.6, 0.1, 0.1, 0.3)], "pads": [("beta", 0.9, 0.1, 0.1, 0.3)]})
    assert [line.split(" (")[0] for line in lines] == [
        f"{case}: the median of θmax/α over 3 motions depends most on {name}"
        for case, name in (("rock", "p"), ("pads", "β"))
    ]


def test_of_many_cases_it_is_said_in_how_many_an_input_comes_first():
    cases = {f"case {n}": [("p", 0.5 + 0.1 * n, 0.1, 0.1, 0.3), ("n", 0.75, 0.1, 0.1, 0.3)] for n in range(5)}
    cases["stiff"] = [("p", math.nan, math.nan, 0.2, 0.2)]
    (line,), _ = said(cases)
    assert line == (
        "The median of θmax/α over 3 motions depends most, in 6 cases, on n in 3 (total Sobol index 0.75 to 0.75), on p in 2 "
        "(total Sobol index 0.80 to 0.90), on none of the inputs in 1."
    )


def test_up_to_four_inputs_that_matter_are_named():
    inputs = [(name, 0.2, 0.01, 0.1, 0.3) for name in ("p", "beta", "eta", "epsilon", "alpha")]
    (line,), _ = said({"rock": inputs})
    assert line.count(" ± ") == 4
    assert "the other" not in line
    assert "; α may matter, too (0.21 at most)" in line
    (line,), _ = said({"rock": [("p", 0.9, 0.0, 0.1, 0.3), ("beta", 0.05, 0.0, 0.2, 0.2), ("n", 0.049, 0.0, 0.2, 0.2)]})
    assert "then β (0.05 ± 0.00); n hardly matters (0.05 at most)." in line
    (line,), _ = said({"rock": [("p", 0.9, 0.0, 0.1, 0.3), ("n", 0.04, 0.01, 0.2, 0.2)]})
    assert "n may matter, too (0.05 at most)" in line


def test_intervals_that_touch_do_not_tell_inputs_apart():
    apart = [("p", 0.5, 0.125, 0.1, 0.3), ("beta", 0.25, 0.125, 0.1, 0.3)]
    assert said({"rock": apart})[1] == ["more samples would tell p and β apart"]
    assert said({"rock": [apart[0], ("beta", 0.25, 0.0625, 0.1, 0.3)]})[1] == []
    assert said({"rock": [("p", 0.5, 0.25, 0.1, 0.3)]})[1] == []


def test_three_cases_have_their_sentences_and_four_share_one_and_one_motion_is_one():
    cases = {f"case {n}": [("p", 0.9, 0.1, 0.1, 0.3)] for n in range(4)}
    assert len(said(dict(list(cases.items())[:3]))[0]) == 3
    ((line,), _) = said(cases, motions=1, statistic="max")
    assert line.startswith("The maximum of θmax/α over one motion depends most, in 4 cases, on p in 4 (total")
    assert "none" not in line


def test_only_an_input_that_moves_the_answer_alone_has_a_sentence():
    (line,), _ = said({"rock": [("p", 0.9, 0.1, 0.2, 0.2)]})
    assert line.endswith("(total Sobol index 0.90 ± 0.10).")
    (line,), _ = said({"rock": [("p", 0.9, 0.1, 0.3, 0.1), ("n", 0.1, 0.1, 0.25, 0.2)]})
    assert line.endswith(" Alone p moves it from 0.3 at 0.3 to 0.1 at 0.5 (0.2 in the study).")


def test_runs_that_only_flew_or_only_overturned_count():
    for status in ("overturned", "flight"):
        lines, _ = said({"rock": [("p", 0.9, 0.1, 0.1, 0.3)]}, statuses={"ok": 59, status: 1}, overturned=0.5)
        assert lines[1:] == ["1 of 60 runs overturned or were ended by flight, and count as 0.5 here."]
    assert len(said({"rock": [("p", 0.9, 0.1, 0.1, 0.3)]})[0]) == 1


def test_a_quantile_of_few_motions_is_said_to_cover_less_than_its_name():
    """Rank 0.84 · 2 + 1 of three, below which 2.68/4 of all values are expected."""
    (_, remark), _ = said({"rock": [("p", 0.9, 0.1, 0.1, 0.3)]}, statistic="p84", stations=3)
    assert remark == (
        "The 84 % quantile is by interpolation between the ranks of 3, which 33 % of further records exceed."
    )
    (_, of_two), _ = said({"rock": [("p", 0.9, 0.1, 0.1, 0.3)]}, statistic="p84", stations=2)
    assert of_two == "The 84 % quantile is of 3 motions of 2 stations, which are not independent."
    assert len(said({"rock": [("p", 0.9, 0.1, 0.1, 0.3)]}, statistic="p84")[0]) == 1  # of an earlier version
