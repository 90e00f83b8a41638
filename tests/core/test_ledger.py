"""The energy ledger: it closes to the integrator's error, and its parts are what they are called."""

import functools
from dataclasses import replace

import numpy as np
import pytest
from studies import PADS, RIGID, study_text, write_study

import rockbatch as rb
from rockbatch.core.observe.ledger import Energies
from rockbatch.observers.other_law.quantities import OTHER_LAW
from rockbatch.outcome.outcome import TERMS

PIER = rb.Pier(0.2, 1.0)
T = np.arange(0, 8.001, 0.01)
SMOOTH = rb.Motion(
    "smooth",
    0.01,
    9.81 * np.sin(2 * np.pi * T) * np.sin(np.pi * np.clip(T / 4, 0, 1)) ** 2,
    2.0 * np.sin(5 * T) * np.sin(np.pi * np.clip(T / 4, 0, 1)) ** 2,
)
BASES = {
    "rigid": rb.RigidBase(),
    "elastic": rb.ElasticBase(50, 0.1, flight="guided"),
    "bouc-wen": rb.YieldingBase(50, 0.1, flight="guided", eta=2.2),
    "epp, finite": rb.YieldingBase(50, 0.1, flight="guided", eta=2.2, spring="epp", kinematics="finite"),
    "hardening": rb.YieldingBase(50, 0.1, flight="guided", eta=2.2, spring="hardening"),
    "bouc-wen, housner": rb.YieldingBase(50, flight="guided", eta=2.2, impact="housner"),
    "bouc-wen, finite, epsilon 0": rb.YieldingBase(50, 0.0, flight="guided", eta=2.2, kinematics="finite"),
}


@functools.cache
def ledger(base, substeps):
    return rb.simulate(PIER, base, SMOOTH, substeps=substeps, ledger=True).ledger


@pytest.mark.parametrize("name", BASES)
def test_the_remainder_falls_with_the_fourth_power_of_the_step(name):
    """Runge–Kutta 4 and Simpson's rule: 2⁴ = 16 a halving, at least 12 as measured over two halvings."""
    coarse, fine = (ledger(BASES[name], substeps)["remainder"].abs().max() for substeps in (2, 8))
    assert fine > 0.0
    assert coarse / fine > 12.0**2


@pytest.mark.parametrize("name", BASES)
def test_the_remainder_falls_below_1e_10_of_the_input_on_smooth_input(name):
    terms = ledger(BASES[name], 96)
    assert terms["input"].abs().max() > 0.1
    assert terms["remainder"].abs().max() < 1e-10 * terms["input"].abs().max()


@pytest.mark.parametrize("name", BASES)
def test_what_is_lost_is_only_ever_lost(name):
    """Plastic work and impacts never give energy back; 1e-9 J/kg is the quadrature's error at this step."""
    terms = ledger(BASES[name], 16)
    for term in ("plastic", "impact"):
        assert np.diff(terms[term]).min() > -1e-9
    assert terms["impact"].iloc[-1] > 0.1
    assert (terms["plastic"].iloc[-1] > 0.1) == isinstance(BASES[name], rb.YieldingBase)


@pytest.mark.parametrize(
    ("name", "present", "absent"), [("bouc-wen", "p_delta", "constraint"), ("epp, finite", "constraint", "p_delta")]
)
def test_p_delta_belongs_to_first_order_and_constraint_to_finite_kinematics(name, present, absent):
    terms = ledger(BASES[name], 4)
    assert terms[absent].abs().max() == 0.0
    assert terms[present].abs().max() > 1e-3


@pytest.mark.parametrize("name", ["bouc-wen", "epp, finite", "hardening"])
def test_plastic_work_is_that_of_the_outcome(name):
    """The outcome has it from the ends of each loading in closed form, the ledger from the power of the forces."""
    from rockbatch.simulation import run_fixed

    outcome = run_fixed(PIER, BASES[name], SMOOTH, 64)
    closed_form = outcome.dissipated_left + outcome.dissipated_right
    assert ledger(BASES[name], 64)["plastic"].iloc[-1] == pytest.approx(closed_form, rel=1e-8)


DEVICES = (rb.Damper("hysteretic", f=0.05, yield_m=0.002), rb.Tendon(0.1, 2.0), rb.Stop(0.02, 0.5, 0.6))


@pytest.mark.parametrize("devices", [(), pytest.param(DEVICES, marks=pytest.mark.slow)], ids=["bare", "devices"])
@pytest.mark.parametrize("name", ["rigid", "elastic", "bouc-wen", "epp, finite"])
def test_energy_of_a_history_is_that_of_the_ledger(name, devices):
    base = replace(BASES[name], restraints=devices)
    response = rb.simulate(PIER, base, SMOOTH, substeps=4, ledger=True)
    stored = response.ledger[["kinetic", "potential", "elastic"]].sum(axis=1)
    assert np.abs(response.energy).max() > 0.1
    assert response.energy[0] == 0.0
    np.testing.assert_allclose(response.energy, stored, rtol=0.0, atol=1e-15 * np.abs(response.energy).max())


STUDY = study_text(cases=(RIGID, PADS | {"eta": 2.2, "epsilon": 0.1}))


def test_a_study_that_asks_gets_the_ledger_and_the_other_law_as_columns(tmp_path):
    path = write_study(tmp_path, STUDY + "[output]\nledger = true\nboth_laws = true\n")
    table = rb.run(path).set_index("case")
    pads = table.loc["pads"]
    assert pads["energy_plastic_J_kg"] == pytest.approx(
        pads["dissipated_left_J_kg"] + pads["dissipated_right_J_kg"], rel=1e-6
    )
    assert 0 < pads["energy_remainder_J_kg"] < 1e-4 * pads["energy_input_J_kg"]
    assert np.isnan(table.loc["rigid", "settlement_other_law_m"])
    epp = tmp_path / "epp.toml"
    epp.write_text(STUDY.replace("epsilon = 0.1", 'epsilon = 0.1\nspring = "epp"'), encoding="utf-8")
    beside = rb.run(epp).set_index("case")
    assert OTHER_LAW not in beside  # nothing else is run beside springs that do not creep
    other = beside.loc["pads", "settlement_m"]
    assert pads["settlement_other_law_m"] == pytest.approx(other, rel=1e-12)  # to its own tolerance, at its own steps
    assert pads["settlement_m"] > 1.02 * other  # Bouc–Wen springs ratchet


def test_a_study_that_does_without_has_no_such_columns(tmp_path):
    path = write_study(tmp_path, STUDY)
    assert not [name for name in rb.run(path).columns if "energy" in name or "other_law" in name]


def test_the_columns_of_the_ledger_are_the_terms_of_the_core_in_their_order():
    assert Energies._fields == TERMS
