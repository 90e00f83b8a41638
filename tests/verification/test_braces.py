"""Dampers on a brace (THEORY.md, Dampers and tendons): relaxation, vibration and limits in closed form, and another solver."""

import math
from dataclasses import replace

import numpy as np
import pytest
from core_samples import FIG5, broadband, pulse
from device_checks import SEEDS, assert_agreement, assert_balance, assert_fourth_order
from restrained_reference import TiedTwoSprings
from scipy.signal import lsim
from stopped_piers import BASES, ELASTIC, RANDOM_BASES, SHAKEN, crossed, stiffness, stopped

import rockbatch as rb
from rockbatch.common.units import GRAVITY
from rockbatch.motions.motion import Motion
from rockbatch.pier import Damper, ElasticBase, RigidBase
from rockbatch.simulation import Run, run_fixed, written_run
from rockbatch.simulation.steps import first_substeps

BRACED = {
    "linear": (Damper("viscous", nu=1.0, brace=2.0),),
    "root": (Damper("viscous", nu=0.3, exponent=0.5, brace=2.0),),
    "steel": (Damper("hysteretic", f=0.1, yield_m=0.005, brace=5.0),),
    "deck": (
        Damper("viscous", nu=0.05, brace=0.2, at="deck"),
        Damper("hysteretic", f=0.02, yield_m=0.01, brace=1.0, at="deck"),
    ),
}


@pytest.mark.parametrize("exponent", [1.0, 0.5, 0.3])
def test_what_is_left_in_the_brace_relaxes_in_closed_form(exponent):
    """A block that stops dead, e = 0: F = F_0 exp(−k t/C), or F^(1 − 1/a) grows by (1/a − 1) k t/C^(1/a)."""
    damper = Damper("viscous", nu=0.3, exponent=exponent, brace=3.0)
    base, motion = RigidBase(0.0, (damper,)), pulse("sine", 0.5, 1.0, dt=0.005, end=4.0)
    found, rows = written_run(Run(FIG5, base, motion), 64 if exponent == 1.0 else 16, 0.0, 50_000, wait=False)
    rows = rows[: found.rows]
    rests = (rows.left != 0.0) & (rows.right != 0.0) & (rows.t > 0.6)
    rows = rows[rests]
    assert len(rows) > 100
    pull, t = np.abs(rows.state[:, np.argmax(np.abs(rows.state[0]))]), rows.t - rows.t[0]
    assert pull[0] > 0.01
    k, c = stiffness(FIG5, damper.brace), damper.nu * FIG5.p
    if exponent == 1.0:
        expected = pull[0] * np.exp(-k * t / c)
    else:
        power = 1.0 - 1.0 / exponent
        expected = (pull[0] ** power - power * k * t / c ** (1.0 / exponent)) ** (1.0 / power)
    np.testing.assert_allclose(pull, expected, rtol=1e-7, atol=1e-10)


def test_vertical_vibration_is_that_of_one_mass_and_a_maxwell_element():
    """v̈ + ω_v² v + F = −v̈_g, Ḟ = k (v̇ − F/C), whose solution is exact under a ground linear between samples."""
    t = np.arange(400) * 0.005
    vertical = 0.2 * GRAVITY * np.sin(9.0 * t) * np.sin(math.pi * t / t[-1])
    damper = Damper("viscous", nu=20.0, brace=20.0, at=0.0)
    base = ElasticBase(30.0, restraints=(damper,))
    found, rows = written_run(Run(FIG5, base, Motion("up", 0.005, 0.0 * t, vertical)), 32, 0.0, 5000, wait=False)
    rows = rows[: found.rows]
    k, c, omega = stiffness(FIG5, damper.brace), damper.nu * FIG5.p, 30.0 * FIG5.p
    system = [[0.0, 1.0, 0.0], [-(omega**2), 0.0, -1.0], [0.0, k, -k / c]]
    _, _, exact = lsim((system, [[0.0], [-1.0], [0.0]], [[1.0, 0.0, 0.0]], [[0.0]]), vertical, t)
    assert np.abs(rows.theta).max() == 0.0
    np.testing.assert_allclose(rows.v - rows.v[0], exact[:, 0], atol=1e-7 * np.abs(exact[:, 0]).max())
    np.testing.assert_allclose(rows.state[:, 0], exact[:, 2], atol=1e-6 * np.abs(exact[:, 2]).max())


@pytest.mark.parametrize(
    ("base", "devices"),
    crossed(BASES, {name: BRACED[name] for name in ("linear", "root", "steel")}, "steel", once="root"),
)
def test_a_rigid_brace_is_none(base, devices):
    """The difference falls with the brace's give: a tenth at ten times the stiffness."""
    (damper,) = devices
    without = run_fixed(FIG5, stopped(base, (replace(damper, brace=math.inf),)), SHAKEN, 8, 0.0, wait=False)
    bases = [stopped(base, (replace(damper, brace=brace),)) for brace in (20.0, 200.0)]
    soft, hard = (
        run_fixed(FIG5, each, SHAKEN, max(4, first_substeps(FIG5, each, SHAKEN.dt)), 0.0, wait=False) for each in bases
    )
    differences = [abs(each.theta_max - without.theta_max) for each in (soft, hard)]
    assert differences[1] < 0.3 * differences[0] < 0.03 * without.theta_max
    assert hard.damper_stroke == pytest.approx(without.damper_stroke, rel=0.02)


@pytest.mark.sweep(fast=1)
@pytest.mark.parametrize(("base", "devices"), crossed(BASES[1:], BRACED, "deck", wholly=True))
def test_runs_agree_with_the_reference(base, devices):
    base = stopped(base, devices)
    end = TiedTwoSprings(FIG5, base, SHAKEN, 0.0).run()
    outcome = run_fixed(FIG5, base, SHAKEN, 32, 0.0, wait=False)
    assert outcome.impacts == end.impacts
    assert outcome.theta_max == pytest.approx(end.theta_max, rel=1e-7)


def drawn(seed):
    """A damper on a brace and a strong motion, at random."""
    rng = np.random.default_rng([30, seed])
    brace, at = float(10.0 ** rng.uniform(-1.0, 1.0)), rng.choice([None, 0.0, 0.7, "deck"])
    viscous = Damper(
        "viscous", nu=float(rng.uniform(0.05, 1.0)), exponent=float(rng.uniform(0.3, 1.0)), at=at, brace=brace
    )
    steel = Damper("hysteretic", f=float(rng.uniform(0.02, 0.2)), yield_m=0.005, at=at, brace=brace)
    damper = viscous if rng.random() < 0.6 else steel
    shaken = broadband(rng, 0.01, 300, FIG5.gravity * math.tan(FIG5.alpha) * rng.uniform(1.5, 4.0))
    return (damper,), Motion(f"seed {seed}", 0.01, shaken + pulse("sine", 0.5, 0.8, 0.01, 2.99).horizontal)


@pytest.mark.parametrize("seeds", SEEDS)
@pytest.mark.parametrize("base", RANDOM_BASES[1:])
def test_random_braces_agree_with_the_reference_within_the_reported_error(base, seeds):
    assert_agreement([drawn(seed) for seed in seeds], base, 1e-8)


@pytest.mark.parametrize(("base", "devices"), crossed(BASES, BRACED, "deck", once="root"))
def test_the_order_is_four_and_the_ledger_closes(base, devices):
    """But for the root, whose force has no Taylor series where it vanishes."""
    tied = stopped(base, devices)
    assert_fourth_order(tied, 1e-10)
    ledger = assert_balance(tied)
    assert ledger.damping.iloc[-1] > 1e-3


def test_stroke_and_speed_are_those_of_the_damper_itself():
    """Elongation less F/k, which the brace gives; the energy is that of the damper's own loop."""
    (damper,) = BRACED["linear"]
    tied, k, c = stopped(RigidBase(), (damper,)), stiffness(FIG5, damper.brace), damper.nu * FIG5.p
    outcome = run_fixed(FIG5, tied, SHAKEN, 32, 0.0, wait=False)
    response = rb.simulate(FIG5, tied, SHAKEN, substeps=32, wait=False, quiet_s=0.0)
    own, speed = 0.0, 0.0
    for side in ("left", "right"):
        pull, way = (response.restraints[f"damper 1 {side} {what}"].to_numpy() for what in ("force", "elongation"))
        own, speed = max(own, np.abs(way - pull / k).max()), max(speed, np.abs(pull).max() / c)
    assert outcome.damper_stroke == pytest.approx(own, rel=1e-4)
    assert outcome.damper_speed == pytest.approx(speed, rel=1e-3)
    assert outcome.damper_force * FIG5.gravity == pytest.approx(c * outcome.damper_speed, rel=1e-9)


def test_a_soft_brace_on_steel_is_a_spring_until_it_yields():
    """Its first stiffness is 1/(1/k + u_y/F_d), and its force F_d at most."""
    soft = Damper("hysteretic", f=0.1, yield_m=0.005, brace=0.05)
    outcome = run_fixed(FIG5, stopped(ELASTIC, (soft,)), SHAKEN, 16, 0.0, wait=False)
    reached = outcome.damper_force * FIG5.gravity
    assert reached <= 0.1 * FIG5.gravity * (1.0 + 1e-12)
    assert outcome.damper_stroke < 0.2 * 0.1 * FIG5.gravity / stiffness(FIG5, soft.brace)


@pytest.mark.parametrize("base", [RigidBase(), ELASTIC], ids=["rigid", "elastic"])
def test_the_reversed_motion_gives_the_mirror_image(base):
    reversed_motion = Motion("reversed", SHAKEN.dt, -SHAKEN.horizontal)
    for devices in BRACED.values():
        one, two = (run_fixed(FIG5, stopped(base, devices), motion, 4) for motion in (SHAKEN, reversed_motion))
        assert one.theta_max == pytest.approx(two.theta_max, rel=1e-11)


@pytest.mark.parametrize(
    ("made", "told"),
    [
        (lambda: Damper("viscous", nu=0.1, brace=0.0), "damper: brace = 0: must be a number above 0"),
        (
            lambda: Damper("viscous", nu=0.1, exponent=1.5, brace=1.0),
            "damper: brace = 1: with one the exponent must be 1 at most",
        ),
        (
            lambda: Damper("friction", f=0.1, brace=1.0),
            'damper: brace = 1: friction on a brace is a hysteretic damper; write kind = "h',
        ),
        (lambda: Damper("viscous", nu=0.1, f=0.1), "damper: f = 0.1: is not of a viscous damper; leave it out"),
        (
            lambda: Damper("friction", f=0.1, exponent=0.5),
            "damper: exponent = 0.5: is not of a friction damper; leave it out",
        ),
    ],
)
def test_what_cannot_be_is_said_where_it_is_made(made, told):
    with pytest.raises(rb.InputError) as caught:
        made()
    (problem,) = caught.value.messages
    assert problem.startswith(told)
