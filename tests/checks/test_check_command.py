"""``rockbatch check`` and ``rb.check``: what is judged, and the exit code."""

import math
from pathlib import Path

import pandas as pd
import pytest
from check_samples import RECORD, RIGID, case, folder, runs
from messages import assert_states
from rules_of_checks import FLIGHT, MARGIN, STUDY, rules_file

import rockbatch as rb
from rockbatch.checks import read_verdicts
from rockbatch.commands.check import answered
from rockbatch.commands.cli import main
from rockbatch.common.errors import InputError
from rockbatch.results.reading import read_saved


def test_all_passing_exits_with_0_and_writes_the_table(passing, capsys):
    assert main(["check", str(passing), "--all"]) == 0
    printed = capsys.readouterr()
    margin, governs, flight = (line.split() for line in printed.out.splitlines()[2:5])
    assert margin == ["margin", "2", "0.4", "<=", "0.5", "0.80", "0.1", "✓", "pass"]
    assert governs == ["governs:", "r1", "(+),", "0.4"]
    assert flight == ["no", "flight", "2", "none", "none", "✓", "pass"]
    assert "margin: maximum of theta_max_over_alpha at most 0.5 [code] clause 7" in printed.out
    counting = "margin: runs that do not end standing count as follows: overturned: infinite; flight, failed: unknown."
    assert counting in printed.out.replace("\n      ", " ")
    assert "2 pass" in printed.err
    table = pd.read_csv(passing / "checks.csv")
    assert list(table["verdict"]) == ["pass", "pass"]
    assert list(table["reason"]) == ["clause 7", "no keys"]


def test_without_limits_the_largest_values_are_said_to_be_of_the_runs_that_stand(tmp_path):
    table = runs([0.1, 0.2, 0.3, 0.4, 0.5], status=["ok", "overturned", "ok", "flight", "ok"])
    said = answered([], read_saved(folder(tmp_path / "out", table, [case()])))
    (line,) = (line for line in said.splitlines() if line.startswith("Largest values"))
    assert_states(line, 3.0, 5.0, "runs")


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


def test_a_study_edited_since_its_run_is_named_with_the_command_that_applies_it(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    folder(tmp_path / "out", runs([0.4]), [case()], MARGIN)
    for text, told in ((MARGIN, ""), (MARGIN.replace("0.5", "0.3"), "rockbatch run pier.toml --out out")):
        Path("pier.toml").write_text(text, encoding="utf-8")
        assert main(["check", "out"]) == 0
        assert told in (said := capsys.readouterr().err)
        assert ("edited" in said) == bool(told)
        assert main(["check", "out", "--rules", "pier.toml"]) == bool(told)
        assert "edited" not in capsys.readouterr().err
    (tmp_path / "other").mkdir()
    monkeypatch.chdir(tmp_path / "other")  # with a study of its own, of the same name
    Path("pier.toml").write_text(MARGIN.replace("0.5", "0.2"), encoding="utf-8")
    assert main(["check", "../out"]) == 0
    assert "edited" not in capsys.readouterr().err


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["nowhere"], "nowhere: not there, or without results of `rockbatch run`"),
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


def test_a_case_is_one_row_with_its_worst_bound_and_each_bound_has_its_numbers(tmp_path, capsys):
    bounds = {"": 0.2, "stiff": 0.3, "soft": 0.4}
    table = pd.concat([runs([value], bound=bound) for bound, value in bounds.items()])
    out = folder(tmp_path / "out", table, [case(bound=bound) for bound in bounds], MARGIN)
    assert main(["check", str(out)]) == 0
    rows = [line.split() for line in capsys.readouterr().out.splitlines()]
    assert [row for row in rows if row[:1] == ["pads"]] == [["pads", "0.4", "✓", "80", "%", "(soft)"]]
    assert main(["check", str(out), "--all"]) == 0
    rows = [line.split() for line in capsys.readouterr().out.splitlines()]
    assert [row[2] for row in rows if row[:1] == ["margin"] and row[-1] == "pass"] == ["0.2", "0.3", "0.4"]
    heads = [" ".join(row) for row in rows if row[:1] in (["pads"], ["pads,"], ["pads:"])]
    assert len(heads) == 4
    assert [bound for bound in ("stiff", "soft") for head in heads[:3] if bound in head] == ["stiff", "soft"]


def test_without_checks_the_greatest_responses_at_any_scale_are_one_row_a_case(tmp_path):
    table = pd.concat([runs([0.4, 0.3], scale=1.0), runs([0.2, 0.1], scale=2.0)], ignore_index=True)
    printed = answered([], rb.open_results(folder(tmp_path / "out", table, [case()])))
    (row,) = (line.split() for line in printed.splitlines() if line.startswith("pads"))
    assert row[1] == "0.4"


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
