"""Two studies side by side: runs are matched by name, and those without a counterpart are listed."""

import csv
import json

import pandas as pd
import pytest
from check_samples import verdict
from report_page import Page, dot_rows
from report_samples import FIG7, FOUNDATIONS, case_entry, three_piers, write_results

import rockbatch as rb
from rockbatch.checks import write_verdicts
from rockbatch.commands.cli import main
from rockbatch.common.errors import InputError
from rockbatch.pier import Pier, RigidBase, YieldingBase
from rockbatch.reporting import compared
from rockbatch.reporting.finished import read
from rockbatch.reporting.pair import pair, paired_cases

PIER = Pier(alpha=0.13, p=0.38)


def two(tmp_path, first=None, second=None):
    folders = tmp_path / "a", tmp_path / "b"
    for folder, results in zip(folders, (first or {}, second or {}), strict=True):
        folder.mkdir()
        write_results(folder, **results)
    return folders


@pytest.fixture(scope="module")
def changed(tmp_path_factory):
    """Write the page of two studies of which one peak differs; return the first study's folder and the text."""
    a, b = two(tmp_path_factory.mktemp("two"), second={"changes": {("SYL360", "2"): {"theta_max_over_alpha": 0.5}}})
    return a, rb.report(a, b).path.read_text(encoding="utf-8")


def test_runs_of_one_record_and_case_stand_side_by_side_with_their_ratio(changed):
    a, text = changed
    page = Page(text)
    _, head, *rows = page.tables["peaks"]
    assert head[:5] == ["record", "case", "A", "B", "B / A"]
    assert len(rows) == 30
    with (a / "peaks.csv").open(encoding="utf-8", newline="") as file:
        ours = next(
            float(row["theta_max_over_alpha"])
            for row in csv.DictReader(file)
            if row["record"] == "SYL360" and row["case"] == "2"
        )
    assert rows[0][:2] == ["SYL360", "2"]  # the worst of both comes first
    assert [float(cell) for cell in rows[0][2:5]] == pytest.approx([ours, 0.5, 0.5 / ours], abs=5e-4)
    assert {row[4] for row in rows[1:]} == {"1.000"}


def test_runs_of_the_only_record_are_named_by_it_and_by_their_case(tmp_path):
    folders = two(tmp_path, *[{"records": FIG7[:1]}] * 2)
    drawn = Page(f'<section id="peaks">{compared.pairs(pair(*map(read, folders)))}</section>')
    assert drawn.tables["peaks"][1][:2] == ["record", "case"]


def test_each_study_names_its_case_without_a_check_and_its_missing_station(tmp_path):
    lost = [{"name": "ABBAR--L", "source": "ABBAR--L.AT2", "reason": "the file is cut", "station": "RSN1633"}]
    a, b = two(tmp_path, {"changes": {("SYL360", "rigid"): {"status": "overturned"}}}, {"unusable": lost})
    for folder in (a, b):
        write_verdicts(
            folder,
            [verdict("2", "pass", check=d, demand=d) for d in ("theta_max_rad", "toe_settlement_m", "ductility")],
        )
    text = Page(rb.report(a, b).path.read_text(encoding="utf-8")).text
    of_both = text[text.index("Does it pass") :]
    assert of_both.count("? 1 of 5 cases passes; 4 are not checked.") == 2
    assert "Not checked: rigid, 1 of 6 runs overturned;" in of_both
    assert "? 6 of 7 stations; RSN1633 could not be used: ABBAR--L.AT2: the file is cut." in of_both


def test_failures_of_both_studies_stand_beside_the_rotations_of_the_others(tmp_path):
    fell = {("SYL360", "rigid"): {"status": "overturned"}}
    a, b = two(tmp_path, {"changes": fell}, {"changes": fell})
    text = Page(rb.report(a, b).path.read_text(encoding="utf-8")).text
    assert (
        "Of 30 runs in common 1 of A and 1 of B do not end standing. From A to B, over 29 of 30 runs that end" in text
    )
    assert "of 29 pairs of runs (1 more have no ratio)" in text


def test_responses_of_two_studies_are_compared_over_the_runs_that_stand_in_both(tmp_path):
    """The worst run of A overturns in B; B, whose other runs are the same, is not the better one for it."""
    worst = ("RRS228", "2")
    a, b = two(
        tmp_path, {"changes": {worst: {"theta_max_over_alpha": 0.9}}}, {"changes": {worst: {"status": "overturned"}}}
    )
    _, head, rotation, *_ = Page(rb.report(a, b).path.read_text(encoding="utf-8")).tables["answer"]
    assert head[0] == "worst of the 29 of 30 runs that end standing in both"
    assert (rotation[1], rotation[-1]) == (rotation[3], "1.000")
    assert rotation[1].startswith("0.1338 α")


def test_studies_of_which_no_run_stands_in_both_have_no_worst_response_to_compare(tmp_path):
    fell = [
        {(row[0], name): {"status": "overturned"} for row in FIG7 for name in names}
        for names in (("rigid", "1", "2"), ("3", "4"))
    ]
    a, b = two(tmp_path, {"changes": fell[0]}, {"changes": fell[1]})
    page = Page(rb.report(a, b).path.read_text(encoding="utf-8"))
    assert "answer" not in page.tables
    assert "Of 30 runs in common 18 of A and 12 of B do not end standing. No run ends standing in both." in page.text


def test_the_picture_has_a_column_for_each_study_on_one_axis(changed):
    _, text = changed
    rows = dot_rows(text, "figure")
    assert len(rows) == len(FIG7)
    assert rows[0].words == "SYL360"
    first, second = ({title.split(": ")[-2][-1:]: title for title in marks} for marks in rows[0].marks)
    assert [len(first), len(second)] == [5, 5]
    changed = [title for title in rows[0].marks[1] if title not in rows[0].marks[0]]
    assert [title.split("\n")[1].split(" ±")[0] for title in changed] == ["2: 0.5000"]
    assert text.count('<span class="column">') == 2


def test_what_is_only_in_one_is_listed_and_not_compared(tmp_path):
    other = [case_entry("5", {}, PIER, FOUNDATIONS[1][1])]
    base = [case_entry(name, {}, PIER, foundation) for name, foundation in FOUNDATIONS]
    a, b = two(tmp_path, {"records": FIG7[:5]}, {"cases": base + other})
    page = Page(rb.report(a, b).path.read_text(encoding="utf-8"))
    rows = page.tables["only"][1:]
    assert [row[0] for row in rows] == ["B"] * 6
    assert sum(int(row[2]) for row in rows) == 5 + 6  # the sixth record in five cases, case 5 in six records
    assert len(page.tables["peaks"]) == 2 + 25


def test_values_that_both_vary_are_matched_and_those_that_one_varies_are_not_guessed(tmp_path):
    grid = [case_entry("soil", {"eta": eta}, PIER, YieldingBase(beta=40.0, eta=eta)) for eta in (2.5, 3.5)]
    lone = [case_entry("soil", {}, PIER, YieldingBase(beta=40.0, eta=2.5))]
    a, b = two(tmp_path, {"cases": grid, "varied": ("eta",)}, {"cases": grid[1:], "varied": ("eta",)})
    matched = pair(read(a), read(b))
    assert set(matched.runs[0]["eta"]) == {3.5}
    assert set(matched.only[0]["eta"]) == {2.5}
    write_results(b, cases=lone)
    matched = pair(read(a), read(b))
    assert matched.runs[0].empty  # two runs of A would fit every run of B
    assert (len(matched.only[0]), len(matched.only[1])) == (12, 6)
    assert "Every pair" not in Page(rb.report(a, b).path.read_text(encoding="utf-8")).headings


def test_a_case_is_named_after_the_matched_values_that_it_has(tmp_path):
    grid = [case_entry("soil", {"eta": eta}, PIER, YieldingBase(beta=40.0, eta=eta)) for eta in (2.5, 3.5)]
    grid.append(case_entry("rock", {"eta": ""}, PIER, RigidBase()))
    matched = pair(*map(read, two(tmp_path, {"cases": grid, "varied": ("eta",)}, {"cases": grid, "varied": ("eta",)})))
    labels = [series.label.replace("\u00a0", " ") for series in matched.named.series]
    assert labels == ["soil: η = 2.5", "soil: η = 3.5", "rock"]


def test_piers_of_both_are_matched_by_their_values(tmp_path):
    a, b = two(tmp_path, {"cases": three_piers(), "varied": ("p",)}, {"cases": three_piers()[10:], "varied": ("p",)})
    first, second = pair(read(a), read(b)).runs
    assert set(first["p"]) == {0.35}
    pd.testing.assert_series_equal(first["pier"], second["pier"], check_index=False)


def test_statistics_are_over_the_pairs_and_separate_by_the_vertical_component(tmp_path):
    horizontal = [
        {
            "record": name, "dt_s": 0.005, "npts": 6000, "duration_s": 29.995, "pga_g": pga, "pga_v_g": None,
            "pgv_m_s": 0.8, "pgd_m": 0.3, "source": "x", "vertical_source": "", "notes": [],
        }
        for name, pga in FIG7
    ]  # fmt: skip
    a, b = two(tmp_path)
    info = json.loads((b / "run.json").read_text(encoding="utf-8"))
    others = {"rockbatch": "0.2.0", "study": info["study"] | {"text": info["study"]["text"].replace("0.13", "0.14")}}
    (b / "run.json").write_text(json.dumps(info | {"records": horizontal} | others), encoding="utf-8")
    page = Page(rb.report(a, b).path.read_text(encoding="utf-8"))
    assert page.tables["suite"][1][1:3] == ["A, with vertical", "B, without vertical"]
    assert page.tables["inputs"][2][0] == "different motions under the same name"
    assert page.tables["inputs"][2][1].startswith("ERZ-NS (0.515 g), ")
    assert "-alpha = 0.13\n+alpha = 0.14\n" in page.text
    assert "Versions: A rockbatch 0.1.0 python 3.11.2 numpy 2.3.1 numba 0.62.0; B rockbatch 0.2.0 " in page.text


def test_a_folder_without_results_is_refused_in_words(tmp_path, capsys):
    (tmp_path / "alone").mkdir()
    assert main(["report", str(tmp_path / "alone")]) == 2
    assert "without results of `rockbatch run`; give a folder that it has written" in capsys.readouterr().err


def test_records_of_one_study_only_are_named_in_the_inputs(tmp_path):
    a, b = two(tmp_path, second={"records": FIG7[:5]})
    _, *rows = Page(rb.report(a, b).path.read_text(encoding="utf-8")).tables["inputs"]
    assert rows == [["motions in one study only", "CPM000", "–"]]


def test_inputs_that_are_the_same_are_said_to_be(changed):
    page = Page(changed[1])
    assert "What is compared" in page.headings
    assert "inputs" not in page.tables
    assert "Every key of the two studies has the same value, and their motions are the same." in page.text


def answered(folders):
    text = rb.report(*folders).path.read_text(encoding="utf-8")
    page = Page(text)
    assert page.headings[:3] == ["The answer", "Does it pass", "What differs in the inputs"]
    return Page(text.split('<section id="answer">')[1].split("</section>")[0]).text.removeprefix("The answer")


NO_LIMITS = "Neither study has limits, so that neither passes or fails."


def test_rotations_follow_by_how_much_and_in_which_record_they_change(tmp_path):
    """Compare ratio and counts by hand: the only rotation that differs is the worst of each."""
    runs = [({"changes": {("SYL360", "2"): {"theta_max_over_alpha": theta}}}) for theta in (0.8, 0.4)]
    told = answered(two(tmp_path, *runs)).removeprefix(NO_LIMITS)
    assert told.startswith("From A to B, over 30 runs: worst rotation −50 % (SYL360), mean settlement 0 % (")
    assert "smaller in 1 of 30 pairs of runs, larger in 0. B/A ranges from 0.5 (SYL360, 2) to" in told


@pytest.mark.parametrize(("thetas", "percent"), [((0.01, 0.3), "+2900 %"), ((0.8, 0.8 * (1 - 1e-7)), "−1 × 10⁻⁵ %")])
def test_a_change_is_shown_without_an_e(tmp_path, thetas, percent):
    """By hand: 0.3 is 30 times 0.01, and 29 times 0.01 more."""
    folders = two(tmp_path)
    for path, theta in zip(folders, thetas, strict=True):
        peaks = pd.read_csv(path / "peaks.csv", dtype={"case": str})
        peaks.assign(theta_max_over_alpha=theta).to_csv(path / "peaks.csv", index=False)
    assert f"worst rotation {percent} (" in answered(folders)


def test_a_study_in_which_the_pier_overturns_is_said_to_be_first_or_second(tmp_path):
    a, b = two(tmp_path, {"changes": {("SYL360", "2"): {"status": "overturned"}}})
    assert "Of 30 runs in common 1 of A and 0 of B do not end standing." in answered((a, b))
    assert "Of 30 runs in common 0 of A and 1 of B do not end standing." in answered((b, a))
    for folders, cells in (((a, b), ["overturned", 0]), ((b, a), [0, "overturned"])):
        _, head, worst, *_ = Page(rb.report(*folders).path.read_text(encoding="utf-8")).tables["peaks"]
        assert head[:5] == ["record", "case", "A", "B", "B / A"]
        assert worst[:2] == ["SYL360", "2"]
        assert [cell == "overturned" for cell in worst[2:4]] == [cell == "overturned" for cell in cells]
        assert worst[4] == ""


@pytest.mark.slow
def test_settlement_out_of_nothing_has_no_share_and_counts(tmp_path):
    settled = {(record, case): {"settlement_m": 0.0} for record, _ in FIG7 for case in "1234"}
    first, second = {"changes": settled}, {"changes": settled | {("SYL360", "2"): {"settlement_m": 0.01}}}
    assert "mean settlement from none (" in answered(two(tmp_path, first, second))
    (tmp_path / "none").mkdir()
    assert "mean settlement 0 % (" in answered(two(tmp_path / "none", first, first))


def test_the_worst_of_both_stands_with_its_value_its_record_and_its_case(tmp_path):
    changes = {(record, case): {"settlement_m": ""} for record, _ in FIG7 for case in "1234"}
    changes["SYL360", "2"] |= {"theta_max_over_alpha": 0.9}
    a, b = two(tmp_path, second={"changes": changes})
    _, head, rotation, *others = Page(rb.report(a, b).path.read_text(encoding="utf-8")).tables["answer"]
    assert head == ["worst of the runs in common", "value", "record and case", "value", "record and case", "B / A"]
    with (a / "peaks.csv").open(encoding="utf-8", newline="") as file:
        worst = max(
            (row for row in csv.DictReader(file) if row["status"] == "ok"),
            key=lambda row: float(row["theta_max_over_alpha"]),
        )
    theta = float(worst["theta_max_over_alpha"])
    _, first, at_first, second, at_second, ratio = rotation
    assert first.startswith(f"{theta:.4g} α = ")
    assert at_first.startswith(f"{worst['record']}, {worst['case']}: ")
    assert second.startswith(f"0.9 α = {0.9 * 0.13 * 180.0 / 3.14159265:.3g}°".rstrip("0"))
    assert at_second.startswith("SYL360, 2: ")
    assert float(ratio) == pytest.approx(0.9 / theta, abs=6e-4)
    (settled,) = (row[3:] for row in others if row[0] == "mean settlement")
    assert settled == ["none", "", ""]


def test_a_case_that_is_paired_twice_is_refused(tmp_path):
    write_results(tmp_path)
    study = read(tmp_path)
    first, second, *_ = (name for name, _ in FOUNDATIONS)
    with pytest.raises(InputError, match=f'^case "{first}" of B is paired twice; pair it once$'):
        paired_cases(study, study, {first: first, second: first})
