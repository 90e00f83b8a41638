"""Springs and dampers at the deck (THEORY.md, Stops and deck springs) against closed forms and solvers of their own."""

import math
from dataclasses import replace

import numpy as np
import pytest
from core_samples import FIG5, broadband, pulse, steady
from device_checks import SEEDS, assert_agreement, assert_balance, assert_fourth_order, reference
from stopped_piers import BASES, ELASTIC, RANDOM_BASES, SHAKEN, crossed, stiffness, stopped, thrown

import rockbatch as rb
from rockbatch.motions.motion import Motion
from rockbatch.pier import Damper, DeckSpring, ElasticBase, RigidBase, YieldingBase
from rockbatch.simulation import Run, run_fixed, run_to_tolerance, written_run

HEIGHT = FIG5.deck
SPRINGS = {
    "linear": (DeckSpring(0.2),),
    "gap": (DeckSpring(0.3, gap_m=0.1, restitution=0.5),),
    "one side": (DeckSpring(0.5, side="right", height_m=0.7 * HEIGHT),),
    "abutments": (DeckSpring(2.0, 0.15, 0.4, "left"), DeckSpring(0.5, 0.05, 0.9, "right")),
    "damped": (DeckSpring(0.2, 0.05), Damper("viscous", nu=0.02, at="deck")),
}


@pytest.mark.parametrize("lam", [0.05, 1.0])
@pytest.mark.parametrize("height", [None, 5.0])
def test_a_step_turns_a_pier_on_elastic_springs_to_twice_its_static_rotation(lam, height):
    """θ = θ_s (1 − cos ωt), θ_s = −h ü_g/(ω_v² b² − g h + k h_d²) and ω² that over I0/M + h², while both pivots bear."""
    spring, beta, pier = DeckSpring(lam, height_m=height), 50.0, FIG5
    h, b, at = pier.height, pier.half_width, height or pier.deck
    rocking = (beta * pier.p) ** 2 * b**2 - pier.gravity * h + stiffness(pier, spring.lam) * at**2
    push = 0.1 * pier.gravity * math.tan(pier.alpha)
    found, rows = written_run(
        Run(pier, ElasticBase(beta, restraints=(spring,)), steady(push, 0.0, 0.005, 400)), 16, 0.0, 5000, wait=False
    )
    rows = rows[: found.rows]
    rows = rows[rows.t < 1.99]
    static, omega = -h * push / rocking, math.sqrt(rocking / (pier.inertia + h**2))
    np.testing.assert_allclose(rows.theta, static * (1.0 - np.cos(omega * rows.t)), atol=1e-7 * abs(static))
    assert found.theta_max == pytest.approx(2.0 * abs(static), rel=1e-7)


@pytest.mark.parametrize("e", [1.0, 0.3])
@pytest.mark.parametrize("gap", [0.0, 0.1])
def test_the_energy_of_a_blow_is_that_of_closed_forms(e, gap):
    """As of a stop, with δ = h_d sin θ + b (1 − cos θ) − gap."""
    alpha, inertia = FIG5.alpha, FIG5.inertia_about_pivot
    spring = DeckSpring(0.3, gap, e, "right")
    omega = 0.6 * FIG5.p * math.sqrt(2.0 * (1.0 - math.cos(alpha)))
    rows, use = thrown(FIG5, RigidBase(0.05, (spring,), confirm=("restitution",)), omega)
    upright = np.flatnonzero(rows.kind > 0.0)[0] - 1
    theta = rows.theta[: upright + 1].max()
    deflection = HEIGHT * math.sin(theta) + FIG5.half_width * (1.0 - math.cos(theta)) - gap
    climbed = math.cos(alpha - theta) - math.cos(alpha)
    stored = 0.5 * stiffness(FIG5, spring.lam) * deflection**2 / (inertia * FIG5.p**2)
    assert stored > 0.02 * climbed
    assert climbed + stored == pytest.approx(0.5 * (omega / FIG5.p) ** 2, rel=1e-9)
    back = 0.5 * (omega / FIG5.p) ** 2 - (1.0 - e**2) * stored
    assert 0.5 * (rows.omega[upright] / FIG5.p) ** 2 == pytest.approx(back, rel=1e-9)
    assert use.most[0] == pytest.approx(stiffness(FIG5, spring.lam) * deflection, rel=1e-6)


@pytest.mark.parametrize("base", BASES)
def test_a_spring_that_is_not_met_or_not_stiff_leaves_the_run_as_it_is(base):
    plain = run_fixed(FIG5, base, SHAKEN, 8)
    for spring in (DeckSpring(1.0, 3.0, 0.5, confirm=("gap_m",)), DeckSpring(1e-10), DeckSpring(1e-10, 0.01)):
        other = run_fixed(FIG5, stopped(base, (spring,)), SHAKEN, 8)
        assert other.theta_max == pytest.approx(plain.theta_max, rel=1e-7)
        assert (other.status, other.impacts, other.separations) == (plain.status, plain.impacts, plain.separations)


@pytest.mark.parametrize("base", BASES)
def test_a_linear_spring_is_two_without_a_gap(base):
    both, pair = (
        run_fixed(FIG5, stopped(base, springs), SHAKEN, 16, 0.0, wait=False)
        for springs in ((DeckSpring(0.2),), (DeckSpring(0.2, side="left"), DeckSpring(0.2, side="right")))
    )
    assert both.theta_max == pytest.approx(pair.theta_max, rel=1e-8)
    assert both.deck_spring_force == pytest.approx(pair.deck_spring_force, rel=1e-7)


@pytest.mark.parametrize(("base", "springs"), crossed(BASES, SPRINGS, "abutments", wholly=True))
def test_runs_agree_with_the_reference(base, springs):
    base = stopped(base, springs)
    end = reference(FIG5, base, SHAKEN).run()
    outcome = run_fixed(FIG5, base, SHAKEN, 32, 0.0, wait=False)
    assert outcome.impacts == end.impacts
    assert outcome.theta_max == pytest.approx(end.theta_max, rel=2e-8)


def drawn(seed):
    """One or two springs at the deck and a strong motion, at random."""
    rng = np.random.default_rng([29, seed])
    springs = ()
    for side in rng.permutation(["both", "left", "right"])[: rng.integers(1, 3)]:
        gap = 0.0 if rng.random() < 0.3 else float(FIG5.alpha * HEIGHT * 10.0 ** rng.uniform(-2.0, -0.3))
        springs += (
            DeckSpring(
                float(10.0 ** rng.uniform(-2.0, 1.0)), gap, float(rng.choice([1.0, rng.uniform(0.1, 1.0)])), str(side)
            ),
        )
    shaken = broadband(rng, 0.01, 300, FIG5.gravity * math.tan(FIG5.alpha) * rng.uniform(1.5, 4.0))
    one_sine = pulse("sine", rng.uniform(0.4, 0.7), rng.uniform(3.0, 6.0) * math.tan(FIG5.alpha), 0.01, 2.99)
    return springs, Motion(f"seed {seed}", 0.01, shaken + one_sine.horizontal)


@pytest.mark.parametrize("seeds", SEEDS)
@pytest.mark.parametrize("base", RANDOM_BASES)
def test_random_springs_agree_with_the_reference_within_the_reported_error(base, seeds):
    assert_agreement([drawn(seed) for seed in seeds], base, 1e-10)


@pytest.mark.parametrize(("base", "springs"), crossed(BASES, SPRINGS, "abutments"))
def test_the_order_is_four_and_the_ledger_closes(base, springs):
    tied = stopped(base, springs)
    assert_fourth_order(tied, 1e-11)
    assert_balance(tied)


@pytest.mark.parametrize("base", BASES)
def test_the_reversed_motion_gives_the_mirror_image(base):
    reversed_motion = Motion("reversed", SHAKEN.dt, -SHAKEN.horizontal)
    other = {"left": "right", "right": "left", "both": "both"}
    for name in ("gap", "one side", "abutments"):
        mirrored = tuple(replace(each, side=other[each.side]) for each in SPRINGS[name])
        one = run_fixed(FIG5, stopped(base, SPRINGS[name]), SHAKEN, 4)
        two = run_fixed(FIG5, stopped(base, mirrored), reversed_motion, 4)
        assert one.theta_max == pytest.approx(two.theta_max, rel=1e-11)
        assert (one.status, one.impacts, one.deck_spring_blows) == (two.status, two.impacts, two.deck_spring_blows)


@pytest.mark.parametrize("base", [RigidBase(), ELASTIC], ids=["rigid", "elastic"])
def test_the_base_bears_what_the_deck_springs_do_not(base):
    """The moment is that of the supports, b (N_R − N_L), by itself; V is M times the acceleration less what the springs push."""
    pier, springs = FIG5, SPRINGS["gap"]
    motion = pulse("sine", 0.5, 1.0, end=1.0)
    response = rb.simulate(pier, stopped(base, springs), motion, substeps=16, wait=False, quiet_s=0.0, forces=True)
    forces, table = response.forces, response.restraints
    push = table["deck spring 1 right force"] - table["deck spring 1 left force"]
    assert push.abs().max() > 0.1 * pier.gravity
    rocks = np.abs(response.theta) > 1e-4
    by_supports = 0.5 * pier.gravity * pier.half_width * (forces.pivot_right - forces.pivot_left)
    assert forces.base_moment[rocks].to_numpy() == pytest.approx(by_supports[rocks].to_numpy(), abs=1e-6 * pier.gravity)
    if base.on_springs:
        return
    theta, t = response.theta, response.t
    x = np.sign(theta) * (pier.half_width - pier.size * np.sin(pier.alpha - np.abs(theta)))
    even = (np.abs(np.diff(t, 2)) < 1e-12) & (np.diff(t)[1:] > 4e-3)  # three samples without an event between
    ground = np.interp(t, np.arange(motion.npts) * motion.dt, motion.horizontal)
    compared = 0
    for i in np.flatnonzero(even & rocks[1:-1]) + 1:
        if 0 < np.count_nonzero(push[i - 1 : i + 2]) < 3:  # a gap closes
            continue
        moved = (x[i + 1] - 2.0 * x[i] + x[i - 1]) / (t[i + 1] - t[i]) ** 2
        assert forces.base_shear[i] == pytest.approx(ground[i] + moved + push[i], abs=0.02 * pier.gravity)
        compared += push[i] != 0.0
    assert compared > 20


@pytest.mark.thorough
def test_the_residual_rotation_is_where_the_pier_comes_to_rest_against_the_spring():
    """Of a record that goes on until the pier rests: read before, as after 2 s, it is known to its error only."""
    base = YieldingBase(50.0, eta=2.0, zeta=0.1, spring="epp", restraints=(DeckSpring(0.5),))
    early, late = (
        run_to_tolerance(FIG5, base, pulse("sine", 0.6, 0.8, dt=0.005, end=end), 1e-6) for end in (2.0, 120.0)
    )
    assert (early.status, late.status) == ("ok", "ok")
    motion = pulse("sine", 0.6, 0.8, dt=0.005, end=120.0)
    found, rows = written_run(Run(FIG5, base, motion), 4, 40.0, 60_000)
    rest = rows[found.rows - 1].theta
    assert late.theta_res == pytest.approx(rest, rel=1e-3, abs=1e-7)
    assert abs(late.theta_res) > 5e-5
    assert abs(early.theta_res - rest) < early.theta_res_error


@pytest.mark.parametrize(
    ("made", "told"),
    [
        (lambda: DeckSpring(-1.0), "deck_spring: lambda = -1: must be 0 or above"),
        (lambda: DeckSpring(1.0, -0.1), "deck_spring: gap_m = -0.1"),
        (lambda: DeckSpring(1.0, restitution=2.0), "deck_spring: restitution = 2: must be within 0.1 and 1"),
        (lambda: DeckSpring(1.0, side="top"), 'deck_spring: side = "top": must be "both" or "left" or "right"'),
        (lambda: DeckSpring(1.0, height_m=-3.0), "deck_spring: height_m = -3"),
        (
            lambda: Damper("friction", f=0.1, at="deck"),
            'damper: at = "deck": friction at the deck is not solved; write kind = "hyst',
        ),
    ],
)
def test_what_cannot_be_is_said_where_it_is_made(made, told):
    with pytest.raises(rb.InputError) as caught:
        made()
    (problem,) = caught.value.messages
    assert problem.startswith(told)
