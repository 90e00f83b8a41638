"""The table of verdicts, checks.csv: written, read back and replaced."""

import math
from pathlib import Path

import pandas as pd
import pytest
from check_samples import RIGID, case, folder, runs, verdict
from report_page import Page
from rules_of_checks import MARGIN, STUDY, rules_file

import rockbatch as rb
from rockbatch.checks import read_verdicts, write_verdicts
from rockbatch.checks.omissions import OMISSIONS
from rockbatch.commands.cli import main
from rockbatch.common.errors import EditedTable, InputError
from rockbatch.results.checking import verdicts


def test_checks_csv_gives_the_verdicts_back(tmp_path):
    """Infinite, missing and varied values included."""
    table = pd.concat([runs([0.1, 0.4], "pads", beta=40.0, status=["ok", "overturned"]), runs([0.2], "rigid")])
    out = folder(tmp_path / "out", table, [case(beta=40.0), RIGID])
    rules = [
        rb.Rule("margin", "theta_max_over_alpha", 0.5, least=1, reason='"quoted", and more'),
        rb.Rule("bearing", "eta", at_least=2.0),
    ]
    written = verdicts(out, rules)
    assert write_verdicts(out, written) == out / "checks.csv"
    read = read_verdicts(out)
    assert [repr(verdict) for verdict in read] == [repr(verdict) for verdict in written]  # NaN is not itself
    assert read[0].high == math.inf
    assert read[0].columns == {"beta": 40.0}
    assert read[2].columns == {}


def test_a_remark_with_a_semicolon_stays_one_remark(tmp_path):
    remarks = ("2 of 3 stations are of one event, Kaikoura; 2016", 'the "worse" of two')
    write_verdicts(tmp_path, [verdict("a", "not decided", remarks=remarks), verdict("b", "pass")])
    a, b = read_verdicts(tmp_path)
    assert (a.remarks, a.why_open, b.remarks) == (remarks, remarks[0], ())


@pytest.mark.parametrize(
    ("cell", "found"), [('"[""\\u001b[31mred""]"', (r"\x1b[31mred",)), ("[" * 100_000, None), ("5", None), ("", None)]
)
def test_remarks_of_another_hand_are_legible_or_damaged(tmp_path, cell, found):
    path = write_verdicts(tmp_path, [verdict("a", "pass", remarks=("REMARK",))])
    text = path.read_text(encoding="utf-8")
    assert '"[""REMARK""]"' in text
    path.write_text(text.replace('"[""REMARK""]"', cell), encoding="utf-8")
    if found:
        assert [each.remarks for each in read_verdicts(tmp_path)] == [found]
        return
    with pytest.raises(InputError, match=r"checks.csv: damaged"):
        read_verdicts(tmp_path)


def test_a_text_of_checks_csv_commands_no_terminal_and_no_spreadsheet(tmp_path):
    write_verdicts(
        tmp_path,
        [verdict("pads", "pass", check="=1+1", remarks=("two", "parts")), verdict("pads", "pass", check="drift")],
    )
    path = tmp_path / "checks.csv"
    assert "'=1+1" in path.read_text(encoding="utf-8")
    path.write_text(path.read_text(encoding="utf-8").replace("drift", "dri\x1bft", 1), encoding="utf-8")
    assert [each.check for each in read_verdicts(tmp_path)] == ["=1+1", r"dri\x1bft"]


def test_a_damaged_checks_csv_is_reported_and_a_missing_one_is_empty(tmp_path):
    assert read_verdicts(tmp_path) == []
    (tmp_path / "checks.csv").write_text("check,case\nmargin,pads\n", encoding="utf-8")
    with pytest.raises(InputError, match=r"checks.csv: damaged .*start `rockbatch check` again"):
        read_verdicts(tmp_path)


def test_new_results_leave_no_verdicts_of_the_old_ones(tmp_path):
    study, rules = rules_file(tmp_path / "pier.toml", STUDY), rules_file(tmp_path / "rules.toml", MARGIN)
    run = ["run", str(study), "--out", str(tmp_path / "out"), "--jobs", "1"]
    assert main(run) == 0
    assert main(["check", str(tmp_path / "out"), "--rules", str(rules)]) == 0
    assert main(run) == 0  # nothing is run again: they still hold
    assert (tmp_path / "out/checks.csv").exists()
    assert main([*run, "--fresh"]) == 0
    assert not (tmp_path / "out/checks.csv").exists()


def test_a_listed_value_of_zero_stays_with_its_verdict(tmp_path):
    """It was lost with the empty cells of other cases, so that a verdict was on no case of run.json."""
    write_verdicts(tmp_path, [verdict("a", "pass", columns={"epsilon": value}) for value in (0.0, 0.1)])
    assert [one.columns for one in read_verdicts(tmp_path)] == [{"epsilon": 0.0}, {"epsilon": 0.1}]


def test_a_line_break_in_the_name_of_a_case_stays_as_run_json_has_it(tmp_path):
    write_verdicts(tmp_path, [verdict("a\nb\tc", "pass")])
    assert [one.case for one in read_verdicts(tmp_path)] == ["a\nb\tc"]


def test_verdicts_on_another_table_than_is_there_now_are_shown_by_no_page(tmp_path):
    """A report, a sheet or a comparison took the verdicts on all rows beside the figures of those that were left."""
    out = tmp_path / "out"
    rb.run(rules_file(tmp_path / "pier.toml", STUDY), out=out)
    write_verdicts(out, verdicts(out, [rb.Rule("margin", "theta_max_over_alpha", 0.5)]))
    rb.report(out, out)
    lines = (out / "peaks.csv").read_text(encoding="utf-8").splitlines(keepends=True)
    (out / "peaks.csv").write_text("".join(lines[:-1]), encoding="utf-8")
    assert read_verdicts(out) is None
    for shows in (rb.report, lambda folder: rb.report(folder, sheet=True), lambda folder: rb.report(folder, folder)):
        with pytest.warns(EditedTable):
            written = shows(out)
        page = Page(written.path.with_suffix(".html").read_text(encoding="utf-8")).text
        assert "The verdicts of checks.csv are on another peaks.csv than is there now, and are not shown." in page
        assert written.checks.empty
    assert written.answer.startswith("A has verdicts on another peaks.csv than its own; B has verdicts on another")
    with pytest.warns(EditedTable):
        assert "not checked: the verdicts are on another peaks.csv than is there now." in rb.statement(out)
    with pytest.warns(EditedTable):
        write_verdicts(out, verdicts(out, [rb.Rule("margin", "theta_max_over_alpha", 0.5)]))
    with pytest.warns(EditedTable):
        written = rb.report(out)
    assert "not decided" in set(written.checks["verdict"])


@pytest.mark.parametrize("ending", ["\n", "\r\n"])
def test_verdicts_stay_with_their_table_with_any_line_endings(tmp_path, ending):
    (tmp_path / "peaks.csv").write_bytes(b"record,case\nr0,pads\n")
    write_verdicts(tmp_path, [verdict("pads", "pass")])
    (tmp_path / "peaks.csv").write_text(f"record,case{ending}r0,pads{ending}", encoding="utf-8", newline="")
    assert [one.case for one in read_verdicts(tmp_path)] == ["pads"]
    (tmp_path / "peaks.csv").write_text(f"record,case{ending}r1,pads{ending}", encoding="utf-8", newline="")
    assert read_verdicts(tmp_path) is None


def test_every_column_of_checks_csv_and_every_omission_is_on_the_page_of_columns(tmp_path):
    """To put it right: write what is missing into docs/columns.md."""
    out = folder(tmp_path / "out", runs([0.1]), [case()])
    columns = write_verdicts(out, verdicts(out, [rb.Rule("margin", "theta_max_over_alpha", 0.5)])).read_text(
        encoding="utf-8"
    )
    page = (Path(rb.__file__).parents[1] / "docs/columns.md").read_text(encoding="utf-8").split("{ #checks }")[1]
    rows = [row.strip("| ").split(" | ") for row in page.splitlines() if row.startswith("| ")][2:]
    assert sorted(name for row in rows for name in row[0].split(", ")) == sorted(columns.splitlines()[0].split(","))
    (omits,) = (meaning for name, meaning in rows if name == "omits")
    assert omits.split("Names: ")[1].split(", ") == [*OMISSIONS]
