"""A page is one whole file, escapes all text, and refuses a damaged folder."""

import json
import re
import subprocess
import sys

import numpy as np
import pytest
from report_page import Page, dot_rows
from report_samples import FOUNDATIONS, case_entry, histories, report, write_results

from rockbatch.common.errors import InputError
from rockbatch.pier import Pier
from rockbatch.reporting import write_report
from rockbatch.reporting.finished import read
from rockbatch.reporting.markup import escape, tag
from rockbatch.reporting.templates import document

NASTY = ["<script>alert(1)</script>", "$x_1$ & a&b", '"><img src=x onerror=alert(1)>', r"\frac{1}{2} </title></svg>"]


def test_names_and_reasons_are_shown_as_they_are_and_never_run(tmp_path):
    text = report(
        tmp_path,
        records=[(name, 0.3 + 0.1 * i) for i, name in enumerate(NASTY)],
        unusable=[{"name": NASTY[2], "source": NASTY[0], "reason": NASTY[1]}],
        command=["rockbatch", "run", NASTY[0]],
    )
    page = Page(text)
    assert page.tags.count("script") == 1
    assert "img" not in page.tags
    assert not page.mismatched
    assert not page.open
    assert {row[0] for row in page.tables["peaks"][1:]} == {row.words for row in dot_rows(text)} == set(NASTY)
    assert page.tables["unusable"][1] == [NASTY[2], NASTY[0], NASTY[1]]
    assert "$x_1$ & a&b" in page.text
    assert "<script>alert(1)</script>" in page.text


def test_the_page_asks_for_nothing_outside_itself(drawn):
    _, text = drawn
    page = Page(text)
    assert not {"link", "img", "iframe", "object", "base"} & set(page.tags)
    assert all(link.startswith("#") or link == "peaks.csv" for link in page.links)  # which lies beside it
    assert "@import" not in text
    assert re.findall(r"url\((?!#)", text) == []


def test_every_printed_page_has_study_version_and_number(tmp_path):
    title = 'A "pier" \\ 1; } </style><b>é'
    written = document(title, "", [], version="1.2")
    style = written[written.index("<style>") : written.index("</style>")]
    assert '@bottom-right { content: counter(page) " / " counter(pages); }' in style
    top = re.search(r'@top-left \{ content: "([^"]*)" \} @top-right \{ content: "rockbatch 1\.2" \} \}', style)
    assert re.sub(r"\\([0-9a-f]+) ", lambda match: chr(int(match[1], 16)), top[1]) == title
    page = report(tmp_path, rockbatch="0.0.7")
    assert '@top-right { content: "rockbatch 0.0.7" }' in page


def test_colours_of_figures_come_from_the_page_so_that_dark_mode_reaches_them(drawn):
    _, text = drawn
    style = text[text.index("<style>") : text.index("</style>")]
    defined = set(re.findall(r"(--\w+):", style)) | {"--w", "--n", "--h", "--share"}
    assert set(re.findall(r"var\((--\w+)[,)]", style)) <= defined
    for svg in re.findall(r"<svg.*?</svg>", text, flags=re.DOTALL):
        assert not re.findall(r"#[0-9a-fA-F]{6}\b|rgb", svg)
        assert "style=" not in svg


def test_a_page_holds_the_table_once_whatever_the_number_of_runs(tmp_path):
    write_results(tmp_path)
    finished = read(tmp_path)
    table = finished.saved.peaks["theta_max_over_alpha"].to_numpy()
    ((_, runs),) = finished.groups()
    assert all(np.shares_memory(table, own["theta_max_over_alpha"].to_numpy()) for own in (finished.runs, runs))


def test_the_same_results_give_the_same_bytes(tmp_path):
    responses, results = histories()
    first = report(tmp_path, *responses, **results)
    assert write_report(tmp_path, responses).read_text(encoding="utf-8") == first


def test_fifty_records_on_five_foundations_stay_below_half_a_megabyte(tmp_path):
    records = [(f"RSN{i}_EVENT_STATION{i:03d}_WITH_A_LONG_NAME", 0.1 + 0.02 * i) for i in range(50)]
    text = report(tmp_path, records=records)
    assert len(text.encode()) < 5e5
    rows = dot_rows(text)
    assert [row.role for row in rows] == [""] * 13 + ["rest"] + ["folded"] * 37
    assert sorted(row.words for row in rows if row.role != "rest") == sorted(name for name, _ in records)
    # In the common row, marks that would lie under another are left out
    assert set(rows[13].marks[0]) <= {title for row in rows[14:] for title in row.marks[0]}


def test_a_study_without_any_usable_record_still_has_a_report(tmp_path):
    unusable = [{"name": "x", "source": "motions/x.AT2", "reason": "motions/x.AT2: empty file"}]
    page = Page(report(tmp_path, records=[], unusable=unusable))
    assert "No ground motion could be used" in page.text
    assert page.tables["unusable"][1] == ["x", "motions/x.AT2", "motions/x.AT2: empty file"]


def test_sections_come_in_the_order_in_which_they_are_asked_for(drawn):
    page = Page(drawn[1])
    assert page.headings == [
        "Scorecard", "Every run", "Compared with published values", "Histories", "Statistics of the suite",
        "One record and the suite", "What was studied", "What is assumed", "Statics", "Ground motions", "Not used", "Notes",
        "How to reproduce",
    ]  # fmt: skip
    assert "rockbatch run configs/fig7.toml --jobs 2" in page.text
    assert '[[case]]\nname = "rigid"' in page.text


def test_all_that_is_wrong_with_a_folder_is_said_at_once(tmp_path):
    with pytest.raises(InputError) as caught:
        write_report(tmp_path)
    assert [problem.split(":")[0] for problem in caught.value.messages] == [str(tmp_path)]

    write_results(tmp_path, changes={("ERZ-NS", "1"): {"t_max_s": "soon"}})
    document = json.loads((tmp_path / "run.json").read_text(encoding="utf-8"))
    del document["machine"]
    (tmp_path / "run.json").write_text(json.dumps(document), encoding="utf-8")
    with pytest.raises(InputError) as caught:
        write_report(tmp_path)
    missing, cell = caught.value.messages
    assert "has no machine" in missing
    assert cell == f'{tmp_path / "peaks.csv"}:3: t_max_s = "soon": expected a number or nothing'


def test_files_of_different_runs_are_refused(tmp_path):
    pier = Pier(alpha=0.13, p=0.38)
    write_results(tmp_path, cases=[case_entry("other", {}, pier, FOUNDATIONS[1][1])])
    other = (tmp_path / "run.json").read_text(encoding="utf-8")
    write_results(tmp_path)
    (tmp_path / "run.json").write_text(other, encoding="utf-8")
    with pytest.raises(InputError, match="belong to different runs"):
        write_report(tmp_path)


def test_a_report_that_fails_leaves_the_earlier_one_and_no_litter(tmp_path, monkeypatch):
    earlier = report(tmp_path)

    def no_space(*_):
        raise OSError("no space left on device")

    monkeypatch.setattr("rockbatch.common.files.os.replace", no_space)
    with pytest.raises(OSError, match="no space"):
        write_report(tmp_path)
    assert (tmp_path / "report.html").read_text(encoding="utf-8") == earlier
    assert sorted(path.name for path in tmp_path.iterdir()) == ["peaks.csv", "report.html", "run.json"]


def test_a_record_called_na_keeps_its_name(tmp_path):
    text = report(tmp_path, records=[("NA", 0.3), ("nan", 0.4)])
    assert {row[0] for row in Page(text).tables["peaks"][1:]} == {row.words for row in dot_rows(text)} == {"NA", "nan"}


@pytest.mark.slow
def test_neither_report_nor_comparison_loads_the_compiler_nor_what_it_does_not_need(tmp_path):
    folder = str(write_results(tmp_path))
    code = (
        "import sys; from rockbatch.commands.cli import main;"
        f"main(['report', {folder!r}]); main(['report', {folder!r}, {folder!r}, '--out', {str(tmp_path / 'c.html')!r}]);"
        "print([m for m in ('numba', 'rockbatch.core', 'matplotlib', 'scipy', 'obspy', 'h5py') if m in sys.modules]"
        " + [m for m in sys.modules if m.startswith('rockbatch.analyses.') and m.endswith('section')])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[-1] == "[]"
    assert (tmp_path / "report.html").exists()
    assert (tmp_path / "c.html").exists()


def test_markup_escapes_all_but_markup():
    assert tag("p", "<b>", tag("i", "a & b"), title='"') == '<p title="&quot;">&lt;b&gt;<i>a &amp; b</i></p>'
    assert tag("td", class_="n", hidden=False, open=True) == '<td class="n" open=""></td>'
    assert escape(1.5) == "1.5"


def test_every_line_of_a_damaged_table_is_reported_at_once(tmp_path):
    changes = {("ERZ-NS", "1"): {"impacts": "2.5"}, ("SYL360", "2"): {"settlement_m": "x"}}
    write_results(tmp_path, changes=changes)
    path = tmp_path / "peaks.csv"
    with path.open("a", encoding="utf-8") as file:
        file.write("cut,short\n")
    with pytest.raises(InputError) as caught:
        write_report(tmp_path)
    columns = len(path.read_text(encoding="utf-8").split("\n", 1)[0].split(","))
    assert list(caught.value.messages) == [
        f'{path}:3: impacts = "2.5": expected a whole number or nothing',
        f'{path}:24: settlement_m = "x": expected a number or nothing',
        f"{path}:32: 2 cells: expected {columns}, as in the first line",
    ]
