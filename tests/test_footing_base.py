"""A footing from its keys to its bed: stiffness, strength, refusals, statics."""

import math

import numpy as np
import pytest
from footing_runs import closed_form

import rockbatch as rb
from rockbatch.pier.soil import Soil, bed_stiffness, gazetas, pais_kausel
from rockbatch.study.footing_keys import at_pivots

TALL = rb.Pier.with_deck(width_m=8, height_m=30, mass_t=2000, deck_mass_t=1000)
WEIGHT = 3000.0 * TALL.gravity
PULSE = 'name = "one-sine"\nshape = "sine"\namplitude_g = 0.3\nperiod_s = 1.0\ndt_s = 0.01\nduration_s = 2.0'


@pytest.fixture
def study(tmp_path):
    """Load a study with a [[case]] of these keys."""

    def load(**keys):
        lines = "\n".join(f"{key} = {value}" for key, value in {"base": '"footing"', **keys}.items())
        pier = "[pier]\nwidth_m = 8.0\nheight_m = 30.0\nmass_t = 2000.0\ndeck_mass_t = 1000.0\n"
        path = tmp_path / "study.toml"
        path.write_text(f"{pier}[[motions.pulse]]\n{PULSE}\n[[case]]\n{lines}\n")
        return rb.load_study(path)

    return load


def test_stiffness_of_a_square_and_of_a_long_footing_is_that_of_the_formulas():
    """By hand: K_z = G L/(1−ν)·2.27 of a square, K_θ in the short plane with I = L B³/12 and L/B = 4."""
    soil = Soil(50.0, 0.25)
    assert gazetas(4.0, 4.0, soil).vertical == pytest.approx(50.0 * 4.0 / 0.75 * 2.27)
    inertia = 12.0 * 3.0**3 / 12.0
    by_hand = 50.0 / 0.75 * inertia**0.75 * 4.0**0.25 * (2.4 + 0.5 * 0.25)
    assert gazetas(3.0, 12.0, soil).rocking == pytest.approx(by_hand)
    assert pais_kausel(4.0, 4.0, soil).vertical == pytest.approx(50.0 * 2.0 / 0.75 * 4.7)
    assert pais_kausel(4.0, 4.0, soil).rocking == pytest.approx(50.0 * 8.0 / 0.75 * 4.0)


@pytest.mark.parametrize(("width", "length"), [(6.0, 6.0), (5.0, 10.0), (10.0, 5.0)])
def test_both_formulas_agree_within_an_eighth(width, length):
    soil = Soil(60.0, 0.4)
    ours, theirs = gazetas(width, length, soil), pais_kausel(width, length, soil)
    assert ours.vertical == pytest.approx(theirs.vertical, rel=0.125)
    assert ours.rocking == pytest.approx(theirs.rocking, rel=0.125)


def test_bed_keeps_the_rocking_stiffness_and_says_what_the_vertical_one_is():
    base = rb.FootingBase.from_soil(TALL, 60.0, 0.45, length_m=8.0)
    formula = gazetas(8.0, 8.0, Soil(60.0, 0.45))
    bed = 3.0 * (base.beta * TALL.p) ** 2  # MN/m of 3000 t
    assert bed * 8.0**2 / 12.0 == pytest.approx(formula.rocking, rel=1e-12)
    assert base.vertical_over_formula == pytest.approx(bed / formula.vertical, rel=1e-12)
    assert base.vertical_over_formula == pytest.approx(2.4, abs=0.05)  # of a square footing
    assert bed_stiffness(8.0, 8.0, formula.rocking) == pytest.approx(bed / 64.0)


def test_toe_of_concrete_has_the_bed_of_its_depth(study):
    toe = study(length_m=2.0, young_GPa=30.0, depth_m=0.5, bearing_MPa=40.0).cases[0].base
    same = rb.FootingBase.from_stiffness(TALL, 60_000.0, length_m=2.0, bearing_MPa=40.0)
    assert toe.beta == pytest.approx(same.beta)
    assert toe.safety_factor == pytest.approx(1000.0 * 40.0 * 16.0 / WEIGHT)


def test_radiation_adds_its_dashpot_and_reports_both_damping_ratios(study):
    keys = {"length_m": 12.0, "shear_modulus_MPa": 60.0, "poisson": 0.4, "safety_factor": 3.0}
    plain, radiating = (study(**keys, **more).cases[0] for more in ({}, {"radiation": "true", "density_t_m3": 1.9}))
    speed = 3.4 * math.sqrt(60e3 / 1.9) / (math.pi * 0.6)
    omega_v = plain.base.beta * plain.pier.p
    added = 1.9 * speed * 96.0 / (2.0 * 3000.0 * omega_v)
    assert radiating.base.zeta == pytest.approx(plain.base.zeta + added)
    ratios = [case.base.parameters(case.pier) for case in (plain, radiating)]
    assert ratios[0]["zeta"] == 0.05
    assert 0.0 < ratios[0]["zeta_rocking"] < ratios[1]["zeta_rocking"] < ratios[1]["zeta"]


def test_no_embedment_may_be_written_as_what_it_is(study):
    keys = {"length_m": 12.0, "shear_modulus_MPa": 60.0, "poisson": 0.4, "safety_factor": 3.0}
    without, written = (study(**keys, **more).cases[0].base for more in ({}, {"embedment_m": 0.0}))
    assert written == without


def test_slenderness_of_a_case_is_that_of_its_foot_and_devices_stay_at_the_pivots(study):
    case = study(width_m=11.0, length_m=12.0, stiffness_MN_m3=60.0).cases[0]
    assert case.pier.alpha == pytest.approx(math.atan(5.5 / TALL.height))
    assert case.pier.height == pytest.approx(TALL.height)
    assert case.pier.inertia == pytest.approx(TALL.inertia)
    damper, tendon = rb.Damper("viscous", nu=1.0), rb.Tendon(psi=0.1, lam=0.5)
    placed = at_pivots((damper, tendon), TALL)
    assert [device.at for device in placed] == pytest.approx([-4.0, 4.0, 0.0])


@pytest.mark.parametrize(("keys", "words"), [
    ({"length_m": 12.0}, "the stiffness of the bed is missing; write shear_modulus_MPa and poisson"),
    ({"length_m": 12.0, "stiffness_MN_m3": 60.0, "shear_modulus_MPa": 60.0, "poisson": 0.4}, "which fix the same; keep one"),
    ({"length_m": 12.0, "shear_modulus_MPa": 60.0}, "poisson is missing beside it"),
    ({"stiffness_MN_m3": 60.0}, "length_m is missing beside it"),
    ({"length_m": 12.0, "stiffness_MN_m3": 60.0, "bearing_MPa": 1.0, "safety_factor": 3.0}, "keep one"),
    ({"length_m": 12.0, "stiffness_MN_m3": 60.0, "bearing_MPa": 0.2}, "the bed cannot carry the weight"),
    ({"length_m": 12.0, "stiffness_MN_m3": 1.0}, "too soft to hold the pier upright"),
    ({"length_m": 12.0, "shear_modulus_MPa": 60e3, "poisson": 0.4}, "than the ground is, .*confirm = ..shear_modulus_MPa"),
    ({"length_m": 12.0, "stiffness_MN_m3": 60.0, "width_m": 2.0}, "narrower than the pier on it, 8 m wide"),
    ({"length_m": 12.0, "stiffness_MN_m3": 60.0, "strips": 7}, "must be an even number"),
    ({"length_m": 12.0, "stiffness_MN_m3": 60.0, "epsilon": 0.1}, "epsilon"),
])  # fmt: skip
def test_what_cannot_be_is_refused_with_a_remedy(study, keys, words):
    with pytest.raises(rb.InputError, match=words):
        study(**keys)


@pytest.mark.parametrize(
    ("confirm", "keys"),
    [
        ("shear_modulus_MPa", {"shear_modulus_MPa": 60e3, "poisson": 0.4}),
        ("width_m", {"stiffness_MN_m3": 60.0, "width_m": 6.0}),
    ],
)
def test_what_is_unusual_about_a_footing_is_taken_once_confirmed(study, confirm, keys):
    (case,) = study(length_m=12.0, confirm=f'["{confirm}"]', **keys).cases
    assert 2.0 * case.pier.half_width == pytest.approx(keys.get("width_m", 8.0))


def test_a_bed_of_soil_too_stiff_for_any_ground_is_refused_in_python_too():
    values = {"shear_modulus_MPa": 60e3, "poisson": 0.4, "length_m": 12.0}
    with pytest.raises(rb.InputError, match="stiffer than the ground is") as refusal:
        rb.FootingBase.from_soil(TALL, **values)
    assert [problem.key for problem in refusal.value.problems] == ["shear_modulus_MPa"]
    assert rb.FootingBase.from_soil(TALL, **values, confirm=("shear_modulus_MPa",)).beta > 0.0


def test_a_block_of_a_laboratory_on_soft_soil_is_no_footing_on_rock():
    """Its weight presses it in by micrometres, whatever the ground is."""
    block = rb.Pier.rectangle(0.06, 0.3, mass_t=0.005, confirm=("width_m", "height_m", "mass_t"))
    soft = rb.FootingBase.from_soil(block, shear_modulus_MPa=60.0, poisson=0.3, length_m=0.1)
    with pytest.raises(rb.InputError, match="stiffer than the ground is"):
        rb.FootingBase.from_soil(block, shear_modulus_MPa=60e3, poisson=0.3, length_m=0.1, confirm=("beta",))
    stiffness = (soft.beta * block.p) ** 2 * block.mass_t / 1000.0 / (0.06 * 0.1)
    assert rb.FootingBase.from_stiffness(block, stiffness, length_m=0.1).beta == pytest.approx(soft.beta)


@pytest.mark.parametrize("safety", [1.5, 2.0, 3.0, None])
def test_curve_of_the_statics_sheet_is_the_closed_form(safety):
    base = rb.FootingBase(60.0, safety)
    curve, delta = rb.statics(TALL, base).curve, TALL.gravity / (60.0 * TALL.p) ** 2
    theta = curve["theta_rad"].to_numpy()[1:]
    strength = math.inf if safety is None else safety
    exact = np.array([closed_form(t, 8.0, 1.0 / delta, strength, 1.0) for t in theta]) - TALL.height * theta
    assert np.abs(curve["moment_over_weight_m"].to_numpy()[1:] - exact).max() < 1e-6


def test_sheet_of_a_footing_states_uplift_period_and_summit():
    base = rb.FootingBase(60.0, 3.0, kinematics="finite")
    sheet, omega_v = rb.statics(TALL, base), 60.0 * TALL.p
    delta = TALL.gravity / omega_v**2
    assert sheet.settlement_m == pytest.approx(delta)
    assert sheet.lift_off_rad == pytest.approx(2.0 * delta / 8.0, rel=1e-4)
    assert sheet.vertical_period_s == pytest.approx(2.0 * math.pi / omega_v)
    rocking = (omega_v**2 * 64.0 / 12.0 - TALL.gravity * TALL.height) / (TALL.inertia + TALL.height**2)
    assert sheet.full_contact_period_s == pytest.approx(2.0 * math.pi / math.sqrt(rocking), rel=1e-4)
    assert sheet.moment_over_weight_m < 4.0 * (1.0 - 1.0 / 3.0)
    assert sheet.unstable_rad < math.atan(4.0 / TALL.height * (1.0 - 1.0 / 3.0))
    assert sheet.unstable_rad == pytest.approx(math.atan(4.0 / TALL.height * (1.0 - 1.0 / 3.0)), rel=0.03)


def test_error_of_an_edge_is_that_of_the_middle_and_of_the_rotation_at_rest(study):
    loaded = study(length_m=10.0, stiffness_MN_m3=50.0, safety_factor=1.5)
    row = rb.run(loaded).iloc[0]
    b = loaded.cases[0].pier.half_width
    rotation = row["theta_res_error"] * loaded.cases[0].pier.alpha
    assert row["edge_settlement_error_m"] == pytest.approx(row["settlement_error_m"] + b * rotation, rel=1e-9)
    assert row["settlement_error_m"] > 0.0
