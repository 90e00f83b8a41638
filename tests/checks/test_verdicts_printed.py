"""Verdicts and the scorecard as the terminal and the report show them."""

import io
import math
import re
import sys

import pandas as pd
import pytest
from check_samples import RIGID, case, folder, runs
from report_page import Page
from rules_of_checks import CONFIGS, MARGIN, STUDY, rules_file

import rockbatch as rb
from rockbatch.checks import read_verdicts
from rockbatch.checks.rule_files import load_rules
from rockbatch.commands import check
from rockbatch.commands.cli import main
from rockbatch.reporting import write_report
from rockbatch.results.checking import verdicts
from rockbatch.results.labelled import Labelled, labelled


def table_of(out, verdicts):
    """Return the table of verdicts as the terminal shows it."""
    saved = rb.open_results(out)
    names = check.called(saved, labelled(saved.peaks, saved.info, saved.directory))
    return check.table(verdicts, names).replace("\u00a0", " ")


def test_the_table_fits_a_hundred_columns(tmp_path, capsys):
    table = pd.concat([runs([0.1, 0.4], "pads", beta=b, status=["ok", "flight"]) for b in (40.0, 50.0)])
    table["settlement_other_law_m"] = 0.01
    out = folder(tmp_path / "out", table, [case(beta=b) for b in (40.0, 50.0)])
    main(["check", str(out), "--rules", str(CONFIGS / "checks/stepping_pier.toml"), "--all"])
    lines = table_of(out, read_verdicts(out)).splitlines()
    assert "\n".join(lines) in capsys.readouterr().out
    assert max(map(len, lines)) <= 100
    assert {"β = 40", "β = 50"} <= set(lines)


def many(tmp_path, most=40):
    """A folder of cases, each with a greater peak than the one before; every other one flew."""
    betas = [float(beta) for beta in range(30, 30 + most)]
    table = pd.concat(
        runs([0.1, beta / 100], beta=beta, status=["ok", "flight" if beta % 2 else "ok"], flight_s=[math.nan, 1.0])
        for beta in betas
    )
    return folder(tmp_path / "out", table, [case(beta=beta) for beta in betas], MARGIN)


def test_a_case_is_named_once_however_many_checks_it_has(tmp_path, monkeypatch):
    out, made, named_case = many(tmp_path, most=6), [], Labelled.named_case

    def counted(self, case, columns, *rest):
        made.append(columns["beta"])
        return named_case(self, case, columns, *rest)

    monkeypatch.setattr(Labelled, "named_case", counted)
    saved = rb.open_results(out)
    check.answered(verdicts(saved, None) * 5, saved)
    assert sorted(made) == [30.0, 31.0, 32.0, 33.0, 34.0, 35.0]


@pytest.mark.slow
def test_many_verdicts_are_summed_up_and_the_worst_printed(tmp_path, capsys):
    """Those up to half of α pass or, where one run flew, are left open; there are forty of them, and ten are told."""
    out = many(tmp_path)
    assert main(["check", str(out), "--all"]) == 1
    printed = capsys.readouterr()
    lines = printed.out.splitlines()
    assert lines[0] == "40 verdicts"
    assert lines[2].split() == ["margin", "11", "19", "10", "0"]
    told = [line for line in lines if re.fullmatch(r"β = \d+", line)]
    assert told == [f"β = {beta}" for beta in range(69, 59, -1)]
    assert "checks.csv: all of them" in printed.err
    assert len(read_verdicts(out)) == 40
    (tmp_path / "few").mkdir()
    out = many(tmp_path / "few", 30)
    few = verdicts(out, load_rules(rules_file(tmp_path / "rules.toml", MARGIN)))
    assert len(re.findall("^β = ", table_of(out, few), re.MULTILINE)) == 30


def test_the_scorecard_comes_without_the_long_lists_and_of_many_cases_the_best(tmp_path, capsys):
    assert main(["check", str(many(tmp_path))]) == 1
    lines = capsys.readouterr().out.splitlines()
    assert [line.split() for line in lines[:2]] == [["margin"], ["≤", "0.5"]]
    names = [line.split("  ")[0].replace("\u00a0", " ") for line in lines[2:8]]
    assert names == [f"β = {beta}" for beta in range(30, 42, 2)]  # those that fly are left open
    assert lines[8] == "6 of 40 cases, the best first"
    assert "clause 7" not in "".join(lines)


def test_without_checks_the_greatest_responses_of_each_case_stand_in_their_order(tmp_path):
    table = pd.concat([runs([0.3, 0.6], "wide"), runs([0.1, 0.2], "pads"), runs([0.45], "other")])
    out = folder(tmp_path / "out", table, [case("wide"), case(), case("other")])
    lines = check.answered((), rb.open_results(out)).splitlines()
    first = next(i for i, line in enumerate(lines) if line.startswith("pads"))
    assert [line.split()[:2] for line in lines[first : first + 3]] == [
        ["pads", "0.2"],
        ["other", "0.45"],
        ["wide", "0.6"],
    ]


def test_without_checks_a_case_with_more_overturned_runs_stands_behind(tmp_path):
    fell = {"status": ["overturned", "ok"]}
    table = pd.concat(
        [runs([9.0, 0.05], "weak", **fell), runs([0.5, 0.6], "pads"), runs([9.0, 9.0], "none", status="overturned")]
    )
    half = table.assign(scale=0.5, theta_max_over_alpha=0.01, status="ok")[table["case"] == "weak"]
    out = folder(tmp_path / "out", pd.concat([table, half]), [case("weak"), case(), case("none")])
    lines = check.answered((), rb.open_results(out)).splitlines()
    first = next(i for i, line in enumerate(lines) if line.startswith("pads"))
    told = [line.split() for line in lines[first : first + 3]]
    assert [(line[0], line[1], " ".join(line[-3:])) for line in told] == [
        ("pads", "0.6", told[0][-3] + " " + told[0][-2] + " none"), ("weak", "0.05", "1 of 4"), ("none", "-", "2 of 2"),
    ]  # fmt: skip
    assert "scaled by" not in "".join(lines[first : first + 3])  # their values are of all scales
    _, *rows = Page(write_report(out).read_text(encoding="utf-8")).tables["answer"]
    assert [(row[0], row[-1]) for row in rows[:3]] == [("pads", "none"), ("weak", "1 of 4"), ("none", "2 of 2")]


def test_the_terminal_tells_what_has_no_limit_at_the_scale_of_a_case(tmp_path):
    yielded = {"ductility_left": 3.0, "ductility_right": 2.0, "base_tilt_rad": 1e-3}
    table = pd.concat([runs([0.1], settlement_m=s, scale=scale, **yielded) for s, scale in ((0.2, 1.0), (0.7, 1.5))])
    out = folder(tmp_path / "out", table, [case()], MARGIN.replace("at_most", "scale = [1.0]\nat_most"))
    told = " ".join(check.answered(verdicts(out), rb.open_results(out)).split())
    assert "no limit on mean settlement, residual tilt, ductility" in told
    assert "mean settlement 200 mm" in told
    assert "700" not in told


@pytest.mark.parametrize("columns", [40, 80, 120])
def test_the_scorecard_fits_the_terminal(tmp_path, columns, monkeypatch):
    rules = "".join(MARGIN.replace("margin", f"a check of {i} words") for i in range(9))
    out = folder(tmp_path / "out", runs([0.1, 0.6]), [case()], rules)
    terminal = io.StringIO()
    monkeypatch.setattr(terminal, "isatty", lambda: True)
    monkeypatch.setattr(sys, "stdout", terminal)
    monkeypatch.setenv("COLUMNS", str(columns))
    monkeypatch.setenv("NO_COLOR", "1")
    assert main(["check", str(out)]) == 1
    assert max(map(len, terminal.getvalue().splitlines())) <= columns
    assert terminal.getvalue().count(" 120 %") == 9 + 1  # and in the sentence


@pytest.mark.parametrize(
    ("terminal", "asked", "colour"), [(True, {}, True), (True, {"NO_COLOR": "1"}, False), (False, {}, False)]
)
def test_verdicts_are_coloured_on_a_terminal_unless_nobody_wants_it(monkeypatch, terminal, asked, colour):
    for name in ("NO_COLOR", "TERM"):
        monkeypatch.delenv(name, raising=False)
    for name, value in asked.items():
        monkeypatch.setenv(name, value)
    monkeypatch.setattr(sys.stdout, "isatty", lambda: terminal, raising=False)
    found = [check._coloured("x", verdict) for verdict in ("pass", "fail", "not decided", "does not apply")]
    assert found == (["\x1b[32mx\x1b[0m", "\x1b[31mx\x1b[0m", "\x1b[33mx\x1b[0m", "x"] if colour else ["x"] * 4)


@pytest.mark.parametrize(
    ("encoding", "expected"),
    [
        ("utf-8", ["✓ pass", "✗ FAIL", "? NOT DECIDED", "– does not apply"]),
        ("ascii", ["+ pass", "x FAIL", "? NOT DECIDED", "- does not apply"]),
    ],
)
def test_every_verdict_has_a_sign_and_a_word_that_the_terminal_can_show(passing, encoding, expected, monkeypatch):
    terminal = io.TextIOWrapper(io.BytesIO(), encoding=encoding)
    monkeypatch.setattr(sys, "stdout", terminal)
    assert [check.mark(way) for way in ("pass", "fail", "not decided", "does not apply")] == expected
    assert main(["check", str(passing)]) == 0
    terminal.flush()
    assert f"0.4 {expected[0][0]} 80 %" in terminal.buffer.getvalue().decode(encoding)


@pytest.mark.slow
@pytest.mark.usefixtures("pages")
def test_the_verdicts_stand_in_the_report(tmp_path):
    study = rules_file(tmp_path / "pier.toml", STUDY)
    assert main(["run", str(study), "--out", str(tmp_path / "out"), "--jobs", "1"]) == 0
    report = tmp_path / "out/report.html"
    assert "clause 7" not in report.read_text(encoding="utf-8")
    rules = rules_file(tmp_path / "rules.toml", MARGIN)
    assert main(["check", str(tmp_path / "out"), "--rules", str(rules)]) == 0
    assert "clause 7" in report.read_text(encoding="utf-8")


def test_a_ratio_that_would_round_to_1_says_on_which_side_it_is(tmp_path, capsys):
    assert main(["check", str(folder(tmp_path / "out", runs([0.5001]), [case()], MARGIN))]) == 1
    assert "0.5001 ✗ 100.02 %" in capsys.readouterr().out


def test_checks_that_do_not_apply_are_counted_as_not_applicable(tmp_path, capsys):
    """One was "1 does not apply", five were "5 does not apply"."""
    rules = tmp_path / "rules.toml"
    rules.write_text(MARGIN + MARGIN.replace("theta_max_over_alpha", "ductility").replace('"margin"', '"ductility"'))
    out = folder(tmp_path / "out", runs([0.1, 0.2], "rigid"), [RIGID])
    main(["check", str(out), "--rules", str(rules)])
    assert "1 pass, 1 not applicable\n" in capsys.readouterr().err
