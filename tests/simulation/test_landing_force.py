"""The force of a landing foot by a contact stiffness: by hand, beside two springs of another solver, and only on request."""

import math

import numpy as np
import pandas as pd
import pytest
from studies import PADS, RIGID, study_text, write_study

import rockbatch as rb
from rockbatch.commands.cli import main
from rockbatch.common.errors import InputError
from rockbatch.pier import landing_force
from rockbatch.quantities.catalogue import DEMANDS

WEIGHED = {"width_m": 4.0, "height_m": 30.0, "mass_t": 2000.0, "deck_mass_t": 1000.0, "deck_height_m": 31.0}
PIER = rb.Pier.with_deck(width_m=4.0, height_m=30.0, mass_t=2000.0, deck_mass_t=1000.0, deck_height_m=31.0)
QUIET = {"histories": "none", "forces": True}
K = 5.0e6


def on_two_springs(pier, stiffness_kN_m, speed):
    """The greatest force of a foot over M that lands beside one that carries the weight: two linear springs, by Runge–Kutta 4."""
    k, b, inertia = stiffness_kN_m / pier.mass_t, pier.half_width, pier.inertia + pier.height**2
    pressed = pier.gravity / k
    y = np.array([-0.5 * pressed, 0.5 * pressed / b, -0.5 * speed, -0.5 * speed / b])

    def rates(y):
        left, right = min(y[0] + b * y[1], 0.0), min(y[0] - b * y[1], 0.0)
        return np.array([y[2], y[3], -pier.gravity - k * (left + right), -b * k * (left - right) / inertia])

    h, most = 0.01 / math.sqrt(k), 0.0
    for _ in range(600):
        a = rates(y)
        c = rates(y + 0.5 * h * a)
        d = rates(y + 0.5 * h * c)
        y = y + h / 6.0 * (a + 2.0 * c + 2.0 * d + rates(y + h * d))
        most = max(most, -k * (y[0] + b * y[1]))
    return most


def test_the_force_is_that_of_the_mass_that_it_moves_on_a_spring():
    """Half of the weight and M_s at the speed v do the work of the spring: K x²/2 = M_s v²/2 + M_s g x/2."""
    force = PIER.mass_t * landing_force(PIER, K, 0.4)
    moved = PIER.mass_t / (1.0 + PIER.half_width**2 / (PIER.inertia + PIER.height**2))
    x = force / K
    assert 0.5 * K * x * x == pytest.approx(0.5 * moved * 0.4**2 + 0.5 * moved * PIER.gravity * x)
    assert landing_force(PIER, 4e12, 0.4) / landing_force(PIER, 1e12, 0.4) == pytest.approx(2.0, rel=1e-3)


@pytest.mark.parametrize("seed", range(20))
def test_the_force_is_near_that_on_two_springs_one_of_which_carries_the_pier(seed):
    rng = np.random.default_rng(seed)
    width, share = rng.uniform(3.0, 10.0), rng.uniform(0.1, 1.0)
    height = width * rng.uniform(3.0, 8.0)
    shaft = 0.5 * width * width * height
    pier = rb.Pier.with_deck(width, height, shaft, share * shaft, confirm=("mass_t", "deck_mass_t"))
    stiffness, speed = 0.5 * pier.mass_t * pier.gravity / rng.uniform(2e-4, 1e-2), rng.uniform(0.05, 0.8)
    assert 0.7 < on_two_springs(pier, stiffness, speed) / landing_force(pier, stiffness, speed) < 1.3


def test_a_run_that_asks_has_its_landing_force_and_no_other_number_changes():
    motion = rb.pulse("sine", name="sine", amplitude=3.0, period=1.0, dt=0.01, duration=4.0)
    asked, plain = (
        rb.simulate(PIER, rb.RigidBase(contact_stiffness_kN_m=stiffness), motion, forces=True, substeps=4)
        for stiffness in (K, None)
    )
    force, speed = asked.row["landing_force_kN"], asked.row["landing_velocity_m_s"]
    assert force == PIER.mass_t * landing_force(PIER, K, speed) > asked.row["pivot_force_left_kN"]
    pd.testing.assert_series_equal(asked.row.drop("landing_force_kN"), plain.row)
    at_rest = rb.simulate(PIER, rb.RigidBase(contact_stiffness_kN_m=K), rb.Motion.still(1.0), forces=True, substeps=4)
    assert "landing_force_kN" not in at_rest.row


def test_the_column_is_of_cases_with_the_key_and_no_check_takes_it(tmp_path):
    stiffnesses = [0.5 * K, K, 2.0 * K]
    cases = ({"base": "rigid", "name": "rock", "contact_stiffness_kN_m": stiffnesses}, PADS | {"zeta": 0.05})
    path = write_study(tmp_path, study_text(pier=WEIGHED, cases=cases, output=QUIET))
    assert main(["run", str(path), "--out", str(tmp_path / "out")]) == 0
    rows = pd.read_csv(tmp_path / "out" / "peaks.csv")
    rock, pads = rows[rows["case"] == "rock"], rows[rows["case"] != "rock"]
    speeds = rock["landing_velocity_m_s"]
    assert rock["landing_force_kN"].tolist() == [
        pytest.approx(3000.0 * landing_force(PIER, k, speed), rel=1e-6)
        for k, speed in zip(rock["contact_stiffness_kN_m"], speeds, strict=True)
    ]
    assert len(set(rock["landing_force_kN"])) == len(rock)
    assert pads["landing_force_kN"].isna().all()
    assert not any("landing_force" in name for name in DEMANDS)
    plain = write_study(tmp_path, study_text(pier=WEIGHED, cases=(RIGID,), output=QUIET), "plain.toml")
    assert main(["run", str(plain), "--out", str(tmp_path / "plain")]) == 0
    assert "landing_force_kN" not in pd.read_csv(tmp_path / "plain" / "peaks.csv")


@pytest.mark.parametrize(
    ("pier", "case", "output", "words"),
    [
        (WEIGHED, {"base": "rigid"}, {"histories": "none"}, "write forces = true under"),
        ({"alpha": 0.2, "p": 1.0}, {"base": "rigid"}, QUIET, "is of a pier whose mass is known"),
        (WEIGHED, {"base": "elastic", "beta": 60.0}, QUIET, "contact_stiffness_kN_m"),
        (WEIGHED | {"flexural_period_s": 0.4}, {"base": "rigid", "shaft": "elastic"}, QUIET, "is of a rigid shaft"),
        ({"width_m": 1.6, "height_m": 9.6, "mass_t": 60.0, "columns": 3, "deck_mass_t": 300.0}, {"base": "rigid"}, QUIET,
         "how the columns of a frame share a landing"),
        (WEIGHED, {"base": "rigid", "contact_stiffness_kN_m": 1e12}, QUIET, "presses the ground in by"),
        (WEIGHED, {"base": "rigid", "contact_stiffness_kN_m": -1.0}, QUIET, "contact_stiffness_kN_m = -1"),
    ],
)  # fmt: skip
def test_the_key_is_used_or_refused(pier, case, output, words):
    text = study_text(pier=pier, cases=({"contact_stiffness_kN_m": K} | case,), output=output)
    with pytest.raises(InputError, match=words):
        rb.Study.from_toml(text)
