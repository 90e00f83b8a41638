"""Every peak stands in its picture and in its table, with its outcome, error and remarks."""

import re

import pytest
from report_page import Page, dot_rows
from report_samples import FIG7, FOUNDATIONS, case_entry, report, three_piers, write_results

from rockbatch.common.figures.description import COLOURS, SHAPES, marks_of
from rockbatch.pier import Pier, YieldingBase
from rockbatch.reporting.finished import read


def test_every_peak_stands_in_the_picture_and_in_the_table_once_the_worst_first(tmp_path):
    text = report(tmp_path, records=FIG7[::-1])
    finished = read(tmp_path)
    runs = finished.runs.sort_values("theta_max_over_alpha", ascending=False, kind="stable")
    head, *body = Page(text).tables["peaks"]
    column = head.index("θmax/α")
    assert [float(row[column]) for row in body] == pytest.approx(list(runs["theta_max_over_alpha"]), abs=0.5e-5)
    assert [row[0] for row in body] == list(runs["record"])
    rows = dot_rows(text)
    assert [row.words for row in rows] == list(runs["record"].drop_duplicates())
    for row in rows:
        said = {
            title.split("\n")[1].split(": ")[0]: float(title.split(": ")[-1].split(" ")[0]) for title in row.marks[0]
        }
        own = runs[runs["record"] == row.words]
        peaks = {finished.series[run.series].label.split(":")[0]: run.theta_max_over_alpha for run in own.itertuples()}
        assert said == pytest.approx(peaks, abs=0.5e-4)


def test_outcomes_other_than_ok_are_words_and_never_rotations(tmp_path):
    changes = {
        ("RRS228", "2"): {"status": "overturned", "theta_max_over_alpha": 7.7},
        ("SYL360", "3"): {"status": "flight", "flight_s": 3.214},
        ("CPM000", "rigid"): {"status": "overturned"},
        ("CPM000", "4"): {"status": "failed", "theta_max_over_alpha": "", "reason": "more than 20,000 events"},
        ("ERZ-NS", "1"): {"flight_s": 1.5},  # guided: went on, and has its peak
    }
    text = report(tmp_path, changes=changes)
    page = Page(text)
    head, *rows = page.tables["peaks"]
    assert re.findall(r'data-filter="">([^<]*)', text) == ["case", "status"]
    status = {(row[0], row[1]): row[head.index("status")] for row in rows}
    assert status["RRS228", "2"] == status["CPM000", "rigid"] == "overturned"
    assert (status["SYL360", "3"], status["CPM000", "4"], status["ERZ-NS", "1"]) == ("flight", "failed", "ok")
    in_picture = {row.words: row for row in dot_rows(text)}
    assert (len(in_picture["RRS228"].marks[0]), in_picture["RRS228"].ends) == (4, ["2"])
    assert (len(in_picture["CPM000"].marks[0]), in_picture["CPM000"].ends) == (3, ["rigid?4"])
    assert len(in_picture["ERZ-NS"].marks[0]) == 5
    assert "In one run the pier left the ground altogether; it was guided down" in page.text
    assert "The pier overturns in 2 of 30 runs, among them RRS228, case 2" in page.text
    assert "In one run both pivots leave the ground, and the analysis stops there: SYL360, case 3" in page.text
    assert [cell.replace("\u00a0", " ") for cell in page.tables["unusable"][1]] == [
        "CPM000",
        "4: β = 80, η = 3.5",
        "more than 20,000 events",
    ]
    assert {"m-overturned", "m-flight"} < {link.removeprefix("#") for link in page.links}
    assert "flight: both pivots off the ground" in page.text


def test_the_axis_is_not_stretched_by_a_pier_that_overturned(tmp_path):
    violent = {("RRS228", "2"): {"status": "overturned", "theta_max_over_alpha": 1e3}}
    texts = [report(tmp_path), report(tmp_path, changes=violent)]
    ticks = [re.findall(r">(0\.\d+)</text>", text.split('class="of axis"')[1].split("</svg>")[0]) for text in texts]
    assert ticks[0] == ticks[1] != []


def test_each_value_of_a_pier_key_has_its_own_column_on_one_axis(tmp_path):
    text = report(tmp_path, cases=three_piers(), varied=("p",))
    assert re.findall(r'<span class="column">(.*?)</span>', text.replace("\u00a0", " ")) == [
        "p = 0.38 rad/s", "p = 0.36 rad/s", "p = 0.35 rad/s",
    ]  # fmt: skip
    rows = dot_rows(text)
    assert len(rows) == len(FIG7)
    # foundations are the same on the three piers: five marks each, not fifteen
    assert {len(marks) for row in rows for marks in row.marks} == {5}
    assert {len(row.marks) for row in rows} == {3}


def test_values_of_a_list_become_labels_and_foundations_differ_in_shape_and_colour(tmp_path):
    pier = Pier(alpha=0.13, p=0.38)
    grid = [(beta, eta) for beta in (40.0, 80.0) for eta in (2.5, 3.5)]
    cases = [
        case_entry("soil", {"beta": beta, "eta": eta}, pier, YieldingBase(beta=beta, eta=eta)) for beta, eta in grid
    ]
    text = report(tmp_path, cases=cases, varied=("beta", "eta"))
    entries = re.findall(r'<li data-of="case"[^>]*>.*?<span>(.*?)</span>', text.replace("\u00a0", " "))
    assert [entry.split(" – ")[1] for entry in entries] == [f"β = {beta:g}, η = {eta:g}" for beta, eta in grid]
    looks = [marks_of(index) for index in range(len(SHAPES) * COLOURS)]
    assert len(set(looks)) == len(looks)
    assert len({look.shape for look in looks[:7]}) == len({look.colour for look in looks[:7]}) == 7


def test_beta_of_a_given_stiffness_is_not_taken_for_a_constant_of_the_foundation(tmp_path):
    # springs of ω_v = 20 and 30 rad/s are β = 40 and 60 under one pier, 50 and 75 under the other
    cases = [
        case_entry(name, {"p": p}, Pier(alpha=0.13, p=p), YieldingBase(beta=omega_v / p, eta=eta))
        for p in (0.5, 0.4)
        for name, omega_v, eta in (("1", 20.0, 2.5), ("2", 30.0, 3.5))
    ]
    write_results(tmp_path, cases=cases, varied=("p",))
    assert {series.label.replace("\u00a0", " ") for series in read(tmp_path).series} == {"1: η = 2.5", "2: η = 3.5"}


@pytest.mark.slow
def test_references_are_compared_with_every_run_they_fit(tmp_path):
    changes = {("RSN779_LOMAP_LGP000", "rigid"): {"theta_max_over_alpha": 0.12}}
    reference = {"columns": {}, "theta_max_over_alpha": 0.1, "source": "Palmeri & Makris (2007)"}
    references = [
        reference | {"record": "*LGP*", "case": "rigid"},
        reference | {"record": "*LGP*", "case": "rigid", "columns": {"p": 0.35}},
        reference | {"record": "*TCU*", "case": "rigid"},
        reference | {"record": "CPM*", "case": "4", "columns": {"p": 0.36}},
    ]
    changes["CPM000", "4"] = {"status": "overturned", "theta_max_over_alpha": 2.0}
    text = report(tmp_path, cases=three_piers(), varied=("p",), changes=changes, references=references)
    _, *rows = Page(text).tables["references"]
    run = ["RSN779_LOMAP_LGP000", "rigid"]
    agreement = ["0.1200", "0.1", "+20.0", "Palmeri & Makris (2007)"]
    assert rows == [
        *([*run, p, *agreement] for p in ("0.38", "0.36", "0.35")),
        [*run, "0.35", *agreement],
        ["*TCU*", "rigid", "", "no such run", "0.1", "", "Palmeri & Makris (2007)"],
        ["CPM000", "4", "0.36", "overturned", "0.1", "", "Palmeri & Makris (2007)"],
    ]


def test_both_directions_and_scales_are_distinguished(tmp_path):
    text = report(tmp_path, polarities=("+", "-"), scales=(1.0, 2.0))
    page = Page(text)
    rows = {row.words: row for row in dot_rows(text)}
    assert {len(row.marks) for row in rows.values()} == {2}
    assert {title.split(": ")[-2][-3:] for title in rows["ERZ-NS"].marks[0]} == {"(+)", "(-)"}
    assert "in both polarities, scaled by 1, 2: 120 runs." in page.text
    assert re.findall(r'data-filter="">([^<]*)', text) == ["case", "polarity", "scale"]
    # PGA is that of the scaled motion
    head, *body = page.tables["peaks"]
    own = [dict(zip(head, row, strict=True)) for row in body if row[0] == "ERZ-NS"]
    assert {row["scale"] for row in own} == {"1", "2"}
    assert re.search(r'data-pga="1.03"><span class="of" title="ERZ-NS">', text)


def test_of_a_big_study_the_worst_is_shown_and_the_page_says_so(tmp_path, monkeypatch):
    monkeypatch.setattr("rockbatch.reporting.sections.peaks.MOST_ROWS", 20)
    worst = {("SYL360", name): {"theta_max_over_alpha": 0.9} for name, _ in FOUNDATIONS}
    text = report(tmp_path, changes=worst)
    page = Page(text)
    assert len(page.tables["peaks"]) == 1 + 20
    assert [row[0] for row in page.tables["peaks"][1:7]].count("SYL360") == 5
    assert "The worst 20 of 30 rows are shown." in page.text
    assert [row.words for row in dot_rows(text)][:1] == ["SYL360"]


def test_errors_are_rounded_up_to_the_digits_of_the_peaks(tmp_path):
    changes = {("SYL360", "2"): {"theta_max_error": 2.1e-5}, ("ERZ-NS", "1"): {"theta_max_error": 3e-9}}
    head, *rows = Page(report(tmp_path, changes=changes)).tables["peaks"]
    errors = {tuple(row[:2]): row[head.index("±")] for row in rows}
    assert (errors["SYL360", "2"], errors["ERZ-NS", "1"]) == ("0.00003", "0.00001")


def test_a_remark_stands_once_below_the_table_under_the_number_that_its_runs_have(tmp_path):
    notes = {("SYL360", "2"): "first", ("ERZ-NS", "1"): "second", ("RRS228", "3"): "first"}
    text = report(tmp_path, changes={run: {"note": note} for run, note in notes.items()})
    listed = re.findall(r"<li>(.*?)</li>", text.split('<ol class="remarks">')[1].split("</ol>")[0])
    assert sorted(listed) == ["first", "second"]
    head, *rows = Page(text).tables["peaks"]
    found = {tuple(row[:2]): row[head.index("remark")] for row in rows}
    assert {run: listed[int(number) - 1] for run, number in found.items() if number} == notes


def test_the_worst_comes_first_overturned_flight_failed_then_rotation(tmp_path):
    changes = {
        ("CPM000", "4"): {"status": "failed", "theta_max_over_alpha": ""},
        ("SYL360", "3"): {"status": "flight", "theta_max_over_alpha": 0.001, "flight_s": 2.0},
        ("RRS228", "1"): {"status": "overturned", "theta_max_over_alpha": 0.002},
        ("ERZ-NS", "2"): {"theta_max_over_alpha": 0.8},
    }
    head, *rows = Page(report(tmp_path, changes=changes)).tables["peaks"]
    order = [tuple(row[:2]) for row in rows]
    assert order[:4] == [("RRS228", "1"), ("SYL360", "3"), ("CPM000", "4"), ("ERZ-NS", "2")]
    rotations = [float(row[head.index("θmax/α")]) for row in rows[3:]]
    assert rotations == sorted(rotations, reverse=True)


def test_runs_of_the_nominal_design_are_called_so_where_others_have_their_bound(tmp_path):
    cases = [
        case_entry("pads", {"bound": bound}, Pier(alpha=0.13, p=0.38), FOUNDATIONS[1][1]) for bound in ("", "stiff")
    ]
    head, *rows = Page(report(tmp_path, cases=cases, varied=("bound",))).tables["peaks"]
    assert {row[head.index("bound")] for row in rows} == {"nominal", "stiff"}
