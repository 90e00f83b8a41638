"""Rules in TOML: in a study, in a file of their own, and their mistakes."""

import json
import re

import pandas as pd
import pytest
from rules_of_checks import MARGIN, STUDY, rules_file
from studies import SINE, study_text, write_study

import rockbatch as rb
from rockbatch.checks.rule_files import CHECK, load_rules
from rockbatch.commands.cli import main
from rockbatch.common.errors import InputError


def problems(path):
    with pytest.raises(InputError) as caught:
        load_rules(path)
    return caught.value.messages


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


def test_choices_of_a_check_that_the_study_lacks_are_reported_before_it_is_run(tmp_path):
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


def test_checks_after_the_last_mistake_that_is_reported_are_not_made(tmp_path):
    """So many mistakes that no more are noted: a check without its keys is then none, and no traceback either."""
    path = tmp_path / "rules.toml"
    path.write_text("[[check]]\nwrong = 1\n" * 300 + "[[check]]\n", encoding="utf-8")
    with pytest.raises(InputError) as error:
        load_rules(path)
    assert len(error.value.messages) < 300


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


def test_a_suite_holds_for_the_file_that_it_names_unless_that_says_otherwise(tmp_path):
    study = with_file(tmp_path, UPRIGHT)
    text = study.read_text(encoding="utf-8")
    study.write_text(text.replace("[suite]\n", '[suite]\ncount = "component"\n'), encoding="utf-8")
    assert [rule.count for rule in load_rules(study)] == ["component"]
    (tmp_path / "limits.toml").write_text('[suite]\ncount = "station"\n' + UPRIGHT, encoding="utf-8")
    assert [rule.count for rule in load_rules(study)] == ["station"]


def test_results_keep_the_checks_that_they_were_held_against(tmp_path):
    """Folders are moved, and files beside them change: the verdicts of a folder are those of its own run."""
    study = with_file(tmp_path, UPRIGHT)
    assert main(["run", str(study), "--out", str(tmp_path / "out")]) == 0
    first = rb.check(tmp_path / "out")
    (tmp_path / "limits.toml").write_text(UPRIGHT.replace("0.5", "1e-6"), encoding="utf-8")
    pd.testing.assert_frame_equal(rb.check(tmp_path / "out"), first)
    (tmp_path / "limits.toml").unlink()
    pd.testing.assert_frame_equal(rb.check(tmp_path / "out"), first)


def test_a_missing_file_of_checks_is_not_found(tmp_path):
    study = with_file(tmp_path, UPRIGHT)
    (tmp_path / "limits.toml").unlink()
    with pytest.raises(rb.NotFound, match=r'\[suite\]: checks = "limits.toml": .*no such file'):
        rb.load_study(study)


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
