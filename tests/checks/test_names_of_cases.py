"""Which case a check is about, by its name or by a pattern."""

import pytest
from check_samples import case
from studies import RIGID, study_text

import rockbatch as rb
from rockbatch.checks import Rule
from rockbatch.checks.rule_choices import Available, fitted
from rockbatch.common.naming import alike, chosen
from rockbatch.pier import YieldingBase

CHECK = {"name": "upright", "reason": "test", "demand": "theta_max_over_alpha", "at_most": 0.9}


@pytest.mark.parametrize(
    ("pattern", "names", "expected"),
    [
        ("soft [1]", ["soft [1]", "soft 1"], ["soft [1]"]),
        ("soft [12]", ["soft 1", "soft 3"], ["soft 1"]),
        ("soft *", ["soft *", "soft 1"], ["soft *"]),
        ("soft *", ["soft 1", "hard", "soft 2"], ["soft 1", "soft 2"]),
        ("s?ft", ["soft", "sft"], ["soft"]),
    ],
)
def test_a_pattern_that_is_a_name_chooses_that_name_alone(pattern, names, expected):
    assert chosen(pattern, names) == expected


def test_a_limit_is_compared_with_the_piers_that_its_check_is_about_and_no_others():
    piers = [case("weak", YieldingBase(beta=40.0, eta=1.5)), case("strong", YieldingBase(beta=40.0, eta=900.0))]
    names = [pier["case"] for pier in piers]
    available = Available(names, [1.0], output=[], piers=piers)
    found = {name: fitted(Rule("a", "eta", at_least=0.02, case=(name,)), available) for name in names}
    assert {name: [problem.kind for problem in of_rule.problems] for name, of_rule in found.items()} == {
        "weak": [],
        "strong": [rb.Unusual],
    }
    assert not fitted(Rule("a", "eta", at_least=0.02), available).problems


def test_a_check_of_a_case_with_brackets_judges_that_case_alone(tmp_path):
    cases = [RIGID | {"name": name} for name in ("soft [1]", "soft 1", "soft *")]
    text = study_text(cases=cases, check=[CHECK | {"case": "soft [1]"}, CHECK | {"name": "other", "case": "soft *"}])
    path = tmp_path / "study.toml"
    path.write_text(text, encoding="utf-8")
    rb.run(path, out=tmp_path / "out")
    verdicts = rb.check(tmp_path / "out")
    assert dict(zip(verdicts["check"], verdicts["case"], strict=True)) == {"upright": "soft [1]", "other": "soft *"}
    assert len(verdicts) == 2


@pytest.mark.parametrize("name", ["soft 1 ", "soft  1", "soft\u00a01", "s\u043eft 1"])
def test_names_of_cases_that_look_alike_are_refused_with_both_written_out(tmp_path, name):
    path = tmp_path / "study.toml"
    path.write_text(study_text(cases=[RIGID | {"name": "soft 1"}, RIGID | {"name": name}]), encoding="utf-8")
    with pytest.raises(rb.InputError, match="is read as the case 'soft 1'") as refused:
        rb.load_study(path)
    assert ascii(name) in str(refused.value)


def test_composed_and_decomposed_letters_look_alike_and_other_words_do_not():
    assert alike("pfeiler u\u0308", ["pfeiler \u00fc"]) == "pfeiler \u00fc"
    assert alike("Soft", ["soft", "soft 2"]) == ""
    assert alike("A\u00b2", ["A2"]) == ""
