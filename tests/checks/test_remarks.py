"""Remarks on supports: those that cannot carry the pier alone, and settlement that nothing damps; first, and once."""

import re

import pytest
from check_samples import ELASTIC, PIER, RIGID, case, folder, runs
from report_page import Page
from studies import study_text, write_study

import rockbatch as rb
from rockbatch.checks.remarks import pulled_supports, undamped_settlement, weak_supports
from rockbatch.checks.responses import in_words, worst_of_all, worst_of_cases
from rockbatch.commands.cli import main
from rockbatch.pier import YieldingBase
from rockbatch.reporting import write_report

WEAK = YieldingBase(beta=50.0, eta=1.7, spring="epp", zeta=0.05)
SETTLED = {"settlement_m": [0.1, 0.381, 0.0, 0.2], "base_tilt_rad": 1e-3}


@pytest.mark.parametrize("eta", [1.2, 1.95, 2.05, 3.0])
@pytest.mark.parametrize("psi", [0.0, 0.3])
def test_supports_are_weak_where_the_statics_never_lift_off(eta, psi):
    tendon = (rb.Tendon(psi=psi),) if psi else ()
    if eta <= 1.0 + psi:
        return
    base = YieldingBase(beta=50.0, eta=eta, spring="epp", restraints=tendon)
    weak = weak_supports([case(base=base)])
    assert bool(weak) == (rb.statics(PIER, base).lift_off_g is None)
    if weak:
        assert f"({50.0 * eta / (1.0 + psi):.3g} %)" in weak


def test_weak_cases_are_named_once_with_the_values_that_tell_them_apart():
    pads = [case("pads", YieldingBase(beta=50.0, eta=eta), eta=eta) for eta in (1.5, 1.8, 2.5)]
    sentence = weak_supports([RIGID, ELASTIC, *pads, case("weak", WEAK, eta=1.7)])
    assert sentence.replace("\u00a0", " ").startswith(
        "pads: η = 1.5; pads: η = 1.8; weak: one support cannot carry the full "
    )
    assert "(75 to 90 %)" in sentence
    assert "before the pier lifts off" in sentence
    assert weak_supports([RIGID, ELASTIC, pads[-1]]) == ""
    many = [case("pads", YieldingBase(beta=50.0, eta=1.5), k=k) for k in range(40)]
    assert weak_supports(many).startswith("pads: ")
    assert "40 of 41 cases: one support cannot carry" in weak_supports([*many, case(eta=2.5)])
    named = [case(name, YieldingBase(beta=50.0, eta=1.5), k=k) for name in ("a", "b", "c", "d") for k in range(2)]
    assert weak_supports([*named, RIGID]).startswith("8 of 9 cases: ")


def test_cases_whose_impacts_pull_at_a_support_are_named_and_only_they(tmp_path, capsys):
    pulls, pushes = (case(impact, rb.ElasticBase(50.0, impact=impact)) for impact in ("housner", "landing"))
    assert pulled_supports([RIGID, pushes, case("damped", WEAK)]) == ""
    sentence = pulled_supports([pushes, pulls])
    assert sentence.startswith("housner: ")
    assert "a support would have to pull at every impact" in sentence
    saved = folder(tmp_path / "out", runs(name="housner"), [pulls])
    assert sentence in Page(write_report(saved, []).read_text(encoding="utf-8")).text
    bare = {"name": "housner", "base": "elastic", "beta": 50, "impact": "housner"}
    study = write_study(tmp_path, study_text(cases=(bare,)))
    for command in (["statics", str(study)], ["run", str(study), "--out", str(tmp_path / "run")]):
        assert main(command) == 0
        assert sentence in re.sub(r"\s+", " ", capsys.readouterr().out)


def test_settlement_without_damping_is_qualified_and_only_that():
    def of(base, **cells):
        return undamped_settlement(worst_of_cases(runs(**cells), [case(base=base)]))

    bare = YieldingBase(beta=50.0, eta=2.5)
    assert of(bare, **SETTLED).startswith("pads: without zeta nothing damps the vertical vibration")
    assert of(bare, settlement_m=1e-16) == ""
    assert of(YieldingBase(beta=50.0, eta=2.5, zeta=0.05), **SETTLED) == ""
    damped = YieldingBase(beta=50.0, eta=2.5, restraints=(rb.Damper("viscous", nu=0.1),))
    assert of(damped, **SETTLED) == ""
    assert of(YieldingBase(beta=50.0, eta=2.5, zeta=0.0), **SETTLED)


def test_supports_that_did_not_yield_have_no_settlement_beyond_rounding():
    rounding = {"settlement_m": 6.53e-16, "base_tilt_rad": 1e-17}
    elastic = worst_of_all(worst_of_cases(runs(name="elastic", **rounding), [ELASTIC]))
    assert list(elastic) == ["theta_max_over_alpha", "top_drift_m", "heel_uplift_m"]
    pads = worst_of_all(worst_of_cases(runs(**rounding), [case()]))
    assert in_words(pads["settlement_m"]) == "0 mm"
    assert in_words(pads["base_tilt_rad"]) == "0 mrad (0°)"


def test_the_page_says_so_first(tmp_path):
    table = runs(name="weak", **SETTLED)
    write = folder(tmp_path / "weak", table, [case("weak", YieldingBase(beta=50.0, eta=1.7))])
    text = Page(write_report(write, []).read_text(encoding="utf-8")).text
    weak, answer = text.index("weak: one support cannot"), text.index("No limits were set")
    assert weak < answer < text.index("weak: without zeta nothing damps")
    elastic = folder(tmp_path / "elastic", runs(name="elastic", settlement_m=6.53e-16, base_tilt_rad=1e-17), [ELASTIC])
    text = Page(write_report(elastic, []).read_text(encoding="utf-8")).text
    assert "No settlement: the supports are elastic." in text
    assert "mean settlement" not in text[: text.index("Worst runs first")]


def test_the_terminal_says_so_first(tmp_path, capsys):
    pads = {"name": "pads", "base": "yielding", "beta": 50, "eta": 1.7}
    study = write_study(tmp_path, study_text(cases=(pads,)))
    assert main(["statics", str(study)]) == 0
    assert capsys.readouterr().out.startswith("pads: one support cannot carry the full ")
    assert main(["run", str(study), "--out", str(tmp_path / "out")]) == 0
    printed = re.sub(r"\s+", " ", capsys.readouterr().out)
    weak, answer = printed.index("pads: one support cannot"), printed.index("No limits were set")
    assert weak < answer < printed.index("pads: without zeta nothing damps")


def test_a_rotation_is_in_shares_of_alpha_degrees_and_radians():
    """Half of 0.2 rad is 0.1 rad, 5.73°."""
    worst = worst_of_all(worst_of_cases(runs([0.5]), [case()], at_each_scale=True))
    assert in_words(worst["theta_max_over_alpha"]) == "0.5 α = 5.73° (0.1 rad)"
