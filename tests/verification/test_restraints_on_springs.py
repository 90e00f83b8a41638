"""Dampers and tendons of a pier on two springs (THEORY.md, Dampers and tendons) against a solver of their own, and limits."""

import math
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from core_samples import FIG5, TOWER, broadband, hard_case, pulse, steady
from restrained_reference import TiedTwoSprings
from scipy.signal import lsim
from stopped_piers import crossed

import rockbatch as rb
from rockbatch.common.units import GRAVITY
from rockbatch.motions.motion import Motion
from rockbatch.pier import Damper, DeckSpring, ElasticBase, RigidBase, Tendon, YieldingBase, places, problems
from rockbatch.simulation import Run, run_fixed, run_to_tolerance, written_run
from rockbatch.simulation.restraints import rests_at
from rockbatch.simulation.starting import start_of
from rockbatch.simulation.steps import first_substeps

ELASTIC = ElasticBase(50.0, epsilon=0.3)
DAMPED = ElasticBase(50.0, zeta=0.05)
BOUC_WEN = YieldingBase(50.0, epsilon=0.3, eta=3.0)
HARDENING = YieldingBase(50.0, epsilon=0.3, eta=3.0, spring="hardening")
FINITE = YieldingBase(60.0, eta=3.5, spring="epp", zeta=0.1, kinematics="finite", flight="guided")
BASES = [
    pytest.param(ELASTIC, id="elastic"),
    pytest.param(BOUC_WEN, id="bouc-wen"),
    pytest.param(HARDENING, id="hardening"),
    pytest.param(DAMPED, id="damped"),
    pytest.param(FINITE, id="finite"),
]
RESTRAINTS = {
    "viscous": (Damper("viscous", nu=1.0),),
    "root": (Damper("viscous", nu=0.3, exponent=0.5),),
    "hysteretic": (Damper("hysteretic", f=0.1, yield_m=0.005),),
    "prestress": (Tendon(psi=0.3),),
    "stiffness": (Tendon(psi=0.1, lam=1.0),),
    "yields": (Tendon(psi=0.1, lam=1.0, strength=0.13),),
    "pair": (Tendon(psi=0.1, lam=0.5, at=1.0), Tendon(psi=0.1, lam=0.5, at=-1.0)),
    "slack": (Tendon(lam=0.5),),
    "one side": (Damper("viscous", nu=0.5, at="left"), Damper("hysteretic", f=0.05, yield_m=0.002, at="right")),
}
FRICTION = {
    "both": (Damper("friction", f=0.1),),
    "middle": (Damper("friction", f=0.1, at=0.0),),
    "two": (Damper("friction", f=0.05, at=0.5), Damper("friction", f=0.08, at="left")),
    "mixed": (Damper("friction", f=0.06), Damper("hysteretic", f=0.05, yield_m=0.005), Tendon(psi=0.1, lam=0.5)),
}
NEAR_FAULT = Path(__file__).parents[2] / "motions" / "near_fault"
SHAKEN = pulse("sine", 0.5, 1.0, end=1.2)


def tied(base, restraints):
    return replace(base, restraints=restraints)


@pytest.mark.parametrize(("base", "restraints"), crossed(BASES, RESTRAINTS | FRICTION, "mixed", wholly=True))
def test_runs_agree_with_the_reference(base, restraints):
    vertical = 0.4 * GRAVITY * np.sin(np.arange(SHAKEN.npts) * 0.11)
    _agree(base, restraints, Motion("both", SHAKEN.dt, SHAKEN.horizontal, vertical))


@pytest.mark.parametrize(("base", "restraints"), crossed(BASES, FRICTION, "mixed"))
def test_friction_without_vertical_motion_agrees_with_the_reference(base, restraints):
    """At both pivots it then reaches its force, and comes to rest, at the same instants."""
    _agree(base, restraints, SHAKEN)


def _agree(base, restraints, motion):
    expected = TiedTwoSprings(FIG5, tied(base, restraints), motion, 0.0)
    end = expected.run()
    steps = 128 if restraints == RESTRAINTS["root"] else 16  # |ė|^a with a < 1 is not smooth at ė = 0
    found, rows = written_run(Run(FIG5, tied(base, restraints), motion), steps, 0.0, 60_000, wait=False)
    last = rows[found.rows - 1]
    assert found.impacts == end.impacts
    assert found.theta_max == pytest.approx(end.theta_max, rel=2e-8)
    assert (last.t, last.theta) == pytest.approx((end.t_end, end.theta), abs=2e-8)
    assert (last.v, last.omega) == pytest.approx((end.v, end.omega), abs=2e-7)


SMOOTH = {name: each for name, each in (RESTRAINTS | FRICTION).items() if name != "root"}


@pytest.mark.parametrize(("base", "restraints"), crossed(BASES, SMOOTH, "mixed"))
def test_the_order_across_events_is_four(base, restraints):
    """The mean of two halvings, since single ones ripple. But for |ė|^a with a < 1, whose slope is infinite at ė = 0."""
    peaks = [
        written_run(Run(FIG5, tied(base, restraints), SHAKEN), steps, 0.0, 1, wait=False)[0].theta_max
        for steps in (4, 16, 64)
    ]
    first, third = (abs(each - peaks[-1]) for each in peaks[:-1])
    assert third < 1e-11 or math.log2(first / third) / 2 > 3.4


@pytest.mark.parametrize(("base", "restraints"), crossed(BASES, RESTRAINTS | FRICTION, "mixed"))
def test_the_ledger_closes(base, restraints):
    response = rb.simulate(FIG5, tied(base, restraints), SHAKEN, substeps=32, wait=False, quiet_s=0.0, ledger=True)
    ledger = response.ledger
    assert ledger.input.iloc[-1] > 0.1
    assert ledger.remainder.abs().max() < 2e-7 * ledger.input.abs().max()
    kinds = {type(each) for each in restraints}
    assert (ledger.damping.iloc[-1] > 1e-3) or kinds == {Tendon}


@pytest.mark.parametrize("base", [*BASES[1:3], pytest.param(DAMPED, id="damped", marks=pytest.mark.slow), BASES[-1]])
@pytest.mark.parametrize(
    "nothing", [Damper("viscous"), Damper("friction"), Tendon()], ids=["viscous", "friction", "tendon"]
)
def test_elements_of_no_strength_leave_the_run_as_it_is(base, nothing):
    plain, found = (run_fixed(FIG5, each, SHAKEN, 8) for each in (base, tied(base, (nothing,))))
    assert found.theta_max == pytest.approx(plain.theta_max, rel=1e-8)
    assert (found.status, found.impacts, found.separations) == (plain.status, plain.impacts, plain.separations)


@pytest.mark.parametrize(
    ("restraint", "stiffness", "damping"),
    [
        (Damper("viscous", nu=2.0), 0.0, 2.0 * 2.0 * FIG5.p),
        (Tendon(psi=2.0, lam=30.0), 30.0 * GRAVITY * FIG5.size / FIG5.half_width**2, 0.0),
    ],
    ids=["viscous", "tendon"],
)
def test_vertical_vibration_is_that_of_one_mass(restraint, stiffness, damping):
    """v̈ + 2 ν p v̇ + (ω_v² + k_t) v = −v̈_g, whose solution is exact under a ground linear between samples."""
    t = np.arange(400) * 0.005
    vertical = 0.2 * GRAVITY * np.sin(9.0 * t) * np.sin(math.pi * t / t[-1])
    base = ElasticBase(30.0, restraints=(restraint,))
    found, rows = written_run(Run(FIG5, base, Motion("up", 0.005, 0.0 * t, vertical)), 16, 0.0, 5000, wait=False)
    rows = rows[: found.rows]
    omega = 30.0 * FIG5.p
    c, k = damping, omega**2 + stiffness
    _, _, exact = lsim(([[0.0, 1.0], [-k, -c]], [[0.0], [-1.0]], [[1.0, 0.0]], [[0.0]]), vertical, t)
    exact = np.ravel(exact if exact.ndim == 1 else exact[:, 0])
    assert np.abs(rows.theta).max() == 0.0
    np.testing.assert_allclose(rows.v - rows.v[0], exact, atol=1e-7 * np.abs(exact).max())


def test_friction_holds_until_the_inertia_exceeds_it():
    """Both dampers at the pivots hold the pier where it is as long as M h |ü_g| ≤ 2 b F_d, ü_g = 2 f g tan α."""
    threshold = 2.0 * 0.1 * GRAVITY * math.tan(FIG5.alpha)
    for share, moves in ((1.0 - 1e-6, False), (1.0 + 1e-6, True)):
        motion = steady(share * threshold, 0.0, 0.01, 100)
        found = run_fixed(FIG5, tied(ELASTIC, FRICTION["both"]), motion, 4, 0.0, wait=False)
        assert (found.theta_max > 1e-12) == moves


def with_peak(motion):
    """The first 52 s of a record, in which the pier comes to its peak."""
    end = round(52.0 / motion.dt) + 1
    return replace(motion, horizontal=motion.horizontal[:end], vertical=motion.vertical[:end])


@pytest.mark.parametrize(
    "base",
    BASES[1:2] + [pytest.param(*base.values, marks=pytest.mark.thorough) for base in BASES if base.id != "bouc-wen"],
)
def test_friction_at_both_pivots_lets_go_at_one_time(base):
    """Without vertical motion both dampers reach their force at the same instant, time and again, and neither can go alone."""
    for motion in rb.read_motions(NEAR_FAULT)[:3]:
        alone = replace(with_peak(motion), vertical=None)
        coarse, fine = (run_fixed(TOWER, tied(base, FRICTION["both"]), alone, steps) for steps in (8, 64))
        assert (coarse.status, fine.status) == ("ok", "ok")
        assert coarse.theta_max == pytest.approx(fine.theta_max, abs=1e-6 * TOWER.alpha)


@pytest.mark.parametrize(
    ("base", "at"),
    [
        pytest.param(BOUC_WEN, None, id="bouc-wen, both", marks=pytest.mark.slow),
        pytest.param(ELASTIC, 0.0, id="elastic, middle"),
        pytest.param(BOUC_WEN, 0.0, id="bouc-wen, middle", marks=pytest.mark.slow),
        pytest.param(ELASTIC, None, id="elastic, both", marks=pytest.mark.slow),
    ],
)
def test_friction_beside_a_viscous_damper_lets_go(base, at):
    """Both are still until friction goes: to rounding, neither has turned then."""
    restraints = (Damper("viscous", nu=0.1, exponent=0.5, at=at), Damper("friction", f=0.06, at=at))
    (motion,) = (with_peak(m) for m in rb.read_motions(NEAR_FAULT) if m.name.endswith("PRPC_20.N00E"))
    coarse, fine = (run_fixed(rb.Pier(0.25, 2.0), tied(base, restraints), motion, steps) for steps in (8, 32))
    assert (coarse.status, fine.status) == ("ok", "ok")
    assert coarse.theta_max == pytest.approx(fine.theta_max, abs=1e-3 * 0.25)


def test_tendons_that_change_at_one_time_let_each_other():
    """Hopping, without horizontal motion: both of a pair go slack, taut again, and yield at the same instants."""
    t = np.arange(1000) * 0.01
    hops = Motion("hops", 0.01, np.zeros(1000), 14.0 * np.sin(2.0 * np.pi * 2.1 * t))
    pair = (Tendon(0.05, 0.5, 0.1, at=0.5), Tendon(0.05, 0.5, 0.1, at=-0.5))
    found = run_fixed(rb.Pier(0.2, 1.0), tied(ElasticBase(40.0, 0.3, flight="guided"), pair), hops, 4)
    assert found.status == "ok"
    assert found.tendon_slack > 10
    assert found.tendon_yield > 0.001


@pytest.mark.thorough
@pytest.mark.slow
@pytest.mark.parametrize("f", [0.02, 0.2])
def test_friction_at_a_pivot_that_is_held_bears_nothing(f):
    """Finite kinematics and ε = 0 hold a pivot that has landed; a damper there has nothing left to hold."""
    base = tied(ElasticBase(40.0, 0.0, "finite", "guided"), (Damper("friction", f=f, at="left"),))
    for motion in rb.read_motions(NEAR_FAULT):
        if motion.name.startswith("CHAN"):
            for pier in (rb.Pier(0.2, 1.0), rb.Pier(0.25, 2.0)):
                coarse, fine = (run_fixed(pier, base, motion, steps) for steps in (8, 64))
                assert coarse.status == fine.status in ("ok", "overturned")
                if fine.status == "ok":
                    assert coarse.theta_max == pytest.approx(fine.theta_max, abs=1e-4 * pier.alpha)


@pytest.mark.parametrize("base", [ELASTIC, BOUC_WEN], ids=["elastic", "bouc-wen"])
@pytest.mark.parametrize("at", [None, 0.0, "left"])
def test_hysteretic_dampers_tend_to_friction_as_their_yield_deflection_vanishes(base, at):
    friction = run_fixed(FIG5, tied(base, (Damper("friction", f=0.1, at=at),)), SHAKEN, 16, 0.0, wait=False).theta_max
    soft, hard = (
        abs(run_fixed(FIG5, tied(base, (damper,)), SHAKEN, 128, 0.0, wait=False).theta_max - friction)
        for damper in (Damper("hysteretic", f=0.1, yield_m=u, at=at) for u in (1e-3, 2e-6))
    )
    assert hard < 0.15 * soft
    assert hard < 0.003 * friction


@pytest.mark.thorough
@pytest.mark.slow
def test_a_tendon_on_stiff_springs_comes_to_what_it_does_on_the_rigid_base():
    """Beyond a radian, where elongations of their own kind on either base would tell: 5.33 α and 4.98 α."""
    tendon = (Tendon(psi=0.5, lam=3.0),)
    motion = rb.pulse("sine", name="s", amplitude=40.0, period=1.5, dt=0.005, duration=6.0, confirm=("amplitude",))
    rigid = run_to_tolerance(FIG5, RigidBase(restraints=tendon), motion, 1e-4)
    assert rigid.theta_max == pytest.approx(5.35 * FIG5.alpha, rel=0.01)
    for beta in (200.0, 400.0, 800.0):
        base = ElasticBase(beta, epsilon=0.0, kinematics="finite", flight="guided", restraints=tendon)
        assert run_to_tolerance(FIG5, base, motion, 1e-4).theta_max == pytest.approx(rigid.theta_max, rel=0.01)


def test_prestress_is_carried_from_the_start():
    base = tied(YieldingBase(50.0, eta=2.5, epsilon=0.0), (Tendon(psi=1.0, lam=0.5),))
    still = Motion("still", 0.01, np.zeros(100))
    found, rows = written_run(Run(FIG5, base, still), 4, 0.0, 200, wait=False)
    rows = rows[: found.rows]
    assert rows.z_left[0] == pytest.approx(-2.0 / 2.5, rel=1e-15)
    assert np.abs(rows.theta).max() == 0.0
    assert np.ptp(rows.v) < 1e-14


@pytest.mark.parametrize("turn", [0.002, -0.05])
def test_springs_of_a_pier_that_is_held_bear_its_weight_and_its_tendon(turn):
    """In finite kinematics, on two springs and on one; places of the base are complex numbers, turned by exp(−iθ)."""
    base = ElasticBase(50.0, kinematics="finite", restraints=(Tendon(psi=0.3, lam=1.0, at=0.4),))
    pier, h = replace(FIG5, initial_rotation_rad=turn), FIG5.height
    start = start_of(pier, base)
    left, right, place = (
        start.v + h + ((s - 1j * h) * np.exp(-1j * turn)).imag for s in (-FIG5.half_width, FIG5.half_width, 0.4)
    )
    z = [min(at - start.unstressed, 0.0) * (50.0 * FIG5.p) ** 2 / GRAVITY for at in (left, right)]
    assert (start.z_left, start.z_right) == pytest.approx(z, rel=1e-9)
    by_v = 1.0 / math.cos(0.5 * turn)
    pull = GRAVITY * (0.3 + FIG5.size / FIG5.half_width**2 * by_v * (place - start.level))
    assert -0.5 * GRAVITY * sum(z) == pytest.approx(GRAVITY + by_v * pull, rel=1e-9)


@pytest.mark.parametrize("sticks", [False, True])
def test_a_pier_rests_where_springs_and_devices_balance_wherever_its_run_has_ended(sticks):
    """Springs of any unstressed positions that carry the weight and the pulls at one rotation: a run that ends elsewhere, its
    devices elastic on the way, comes to rest there; friction that holds gives what is missing, and lets only θ + v/s change."""
    friction, b, g, h = (Damper("friction", f=0.1, at="right"),) * sticks, FIG5.half_width, GRAVITY, FIG5.height
    steel, tie = Damper("hysteretic", f=0.1, yield_m=0.005, at="left"), Tendon(psi=0.3, lam=1.0, at=0.4)
    base = tied(
        ELASTIC, (steel, tie, DeckSpring(lam=0.5), replace(tie, psi=0.1, at=-0.4), *friction)
    )  # the last one is slack
    level, v, theta, z, unit = -0.003, -0.004, 0.003, 0.4, g * FIG5.size / b**2
    stretched = 5e-4
    taut = 0.3 * g + unit * (v - level - 0.4 * theta - stretched)
    pulls = [(0.1 * g * z, -b), (taut, 0.4), (0.02 * g * sticks, b)]
    k, deck = 0.5 * (50.0 * FIG5.p) ** 2, places(FIG5, base.restraints[2])[0].height
    load = g + sum(pull for pull, _ in pulls)
    moment = 0.5 * unit * deck**2 * theta - g * h * theta - sum(pull * s for pull, s in pulls)
    for turn in (0.0, 0.002, -0.001):
        lift = b * turn if sticks else 0.3 * turn
        end = SimpleNamespace(v_end=v + lift, theta_end=theta + turn)
        end.base_left, end.base_right = (
            0.5 * (load + side * moment / b) / k + v + side * b * theta - level - 0.7 * g / k for side in (1.0, -1.0)
        )
        states = [z + (lift + b * turn) / 0.005, stretched, 0.0, 0.1, *[0.0] * sticks]
        holds = [False] * 4 + [True] * sticks
        assert rests_at(FIG5, base, end, level, states, holds)[1] == pytest.approx(theta, rel=1e-4 if sticks else 1e-9)


@pytest.mark.parametrize(
    ("base", "told"),
    [
        (YieldingBase(50.0, eta=1.5, restraints=(Tendon(psi=0.5),)), "eta must be above 1 + psi"),
        (ElasticBase(50.0, restraints=(Tendon(psi=0.5, at="left"),)), "an equal one on the other side"),
        (ElasticBase(50.0, restraints=(Damper("friction", f=0.1),) * 2), "two places of friction"),
    ],
)
def test_what_cannot_stand_is_said(base, told):
    assert any(told in problem.text for problem in problems(FIG5, base))


@pytest.mark.parametrize("restraints", (RESTRAINTS | FRICTION).values(), ids=RESTRAINTS | FRICTION)
def test_the_reversed_motion_gives_the_mirror_image(restraints):
    there = {None: None, "left": "right", "right": "left", 0.0: 0.0, 0.5: -0.5, 1.0: -1.0, -1.0: 1.0}
    mirrored = tuple(replace(each, at=there[each.at]) for each in restraints)
    reversed_motion = Motion("reversed", SHAKEN.dt, -SHAKEN.horizontal)
    for base in (ELASTIC, BOUC_WEN):
        one = run_fixed(FIG5, tied(base, restraints), SHAKEN, 4)
        two = run_fixed(FIG5, tied(base, mirrored), reversed_motion, 4)
        assert one.theta_max == pytest.approx(two.theta_max, rel=1e-11)
        assert (one.status, one.impacts) == (two.status, two.impacts)


@pytest.mark.slow
def test_friction_may_hold_a_pivot_that_its_spring_no_longer_bears():
    """It lands with ε = 0, unloads to nothing, and stands still there: at any step, without an event that repeats itself."""
    (motion,) = (m for m in rb.read_motions(NEAR_FAULT) if m.name.endswith("WTMC_20.S62W"))
    base = tied(YieldingBase(60.0, eta=3.0, epsilon=0.0), (Damper("friction", f=0.03),))
    coarse, *others = (run_fixed(TOWER, base, motion, steps) for steps in (24, 55, 56, 128, 192))
    assert {coarse.status, *(each.status for each in others)} == {"ok"}
    assert [each.theta_max for each in others] == pytest.approx([coarse.theta_max] * len(others), rel=1e-7)


KINDS = ("linear", "power", "hysteretic", "tendon", "pair")
"""Of elements that the reference knows."""


def drawn(seed, pier, kinds=KINDS):
    """One to three dampers and tendons at random."""
    rng = np.random.default_rng(seed)
    found = ()
    for kind in rng.choice(kinds, rng.integers(1, 4)):
        at = None if rng.random() < 0.5 else float(rng.uniform(-1.0, 1.0) * pier.half_width)
        if kind == "linear":
            found += (Damper("viscous", nu=float(rng.uniform(0.0, 2.0)), at=at),)
        elif kind == "power":
            nu, exponent = float(rng.uniform(0.0, 0.5)), float(rng.uniform(1.2, 2.0))
            found += (Damper("viscous", nu=nu, exponent=exponent, at=at),)
        elif kind == "root":
            nu, exponent = float(rng.uniform(0.0, 0.3)), float(rng.uniform(0.3, 0.9))
            found += (Damper("viscous", nu=nu, exponent=exponent, at=at),)
        elif kind == "friction":
            found += (Damper("friction", f=float(10.0 ** rng.uniform(-2.0, -0.7)), at=at),)
        elif kind == "hysteretic":
            f, u = float(rng.uniform(0.0, 0.3)), float(10.0 ** rng.uniform(-3.0, -1.5))
            found += (Damper("hysteretic", f=f, yield_m=u, at=at),)
        else:
            psi, lam = float(rng.uniform(0.0, 0.3)), float(rng.uniform(0.1, 1.5))
            s = float(rng.uniform(0.1, 1.0) * pier.half_width) if kind == "pair" else 0.0
            strength = psi + float(rng.uniform(0.01, 0.3)) if kind == "pair" else math.inf
            found += tuple(Tendon(psi, lam, strength, at=place) for place in ((s, -s) if s else (0.0,)))
    return found


@pytest.mark.slow
@pytest.mark.parametrize(
    "seeds", [range(2, 5), pytest.param([0, 1, *range(5, 40)], marks=pytest.mark.thorough)], ids=["few", "most"]
)
def test_random_elements_on_real_records_settle(seeds):
    """With friction and roots too, with vertical motion and without: none fails, and none is wrong by more than it says."""
    motions, bases, piers = rb.read_motions(NEAR_FAULT), (ELASTIC, BOUC_WEN), (TOWER, FIG5, rb.Pier(0.25, 2.0))
    runs = 0
    for seed in seeds:
        rng = np.random.default_rng([7, seed])
        pier, motion = piers[rng.integers(3)], motions[int(rng.integers(len(motions)))]
        motion = motion if rng.random() < 0.5 else replace(motion, vertical=None)
        base = tied(bases[rng.integers(2)], drawn([8, seed], pier, (*KINDS, "root", "friction", "friction")))
        if problems(pier, base):
            continue
        outcome = run_to_tolerance(pier, base, motion, 1e-4)
        assert outcome.status != "failed", (seed, outcome.reason)
        runs += 1
        if outcome.status == "ok":
            finer = run_fixed(pier, base, motion, 4 * outcome.substeps)
            assert abs(finer.theta_max - outcome.theta_max) <= outcome.theta_max_error, seed
    assert runs > len(seeds) / 2


@pytest.mark.thorough  # finite kinematics or another n, with devices: kernels of their own
@pytest.mark.parametrize(
    ("seed", "kinds"),
    [
        *((seed, KINDS) for seed in (33, 47, 49, 52)),
        *((seed, ("linear", "hysteretic", "friction")) for seed in (1, 38)),
    ],
)
def test_random_hard_cases_agree_with_the_reference(seed, kinds):
    """Within what half the step changes; of 60 seeds that were drawn so, those that have told most."""
    pier, base, motion = hard_case(seed)
    base = tied(base, drawn(seed, pier, kinds))
    if problems(pier, base):
        base = replace(base, restraints=tuple(each for each in base.restraints if isinstance(each, Damper)))
    expected = TiedTwoSprings(pier, base, motion, 0.0).run()
    steps = 4 * first_substeps(pier, base, motion.dt)
    found, fine = (run_fixed(pier, base, motion, k, 0.0, wait=False) for k in (steps, 2 * steps))
    assert found.status == expected.status
    if found.status == "ok":
        change = abs(found.theta_max - fine.theta_max)
        assert abs(found.theta_max - expected.theta_max) <= 2.0 * change + 1e-10 * pier.alpha


HARD = {
    "undamped": tied(ElasticBase(80.0), (Damper("hysteretic", f=0.2, yield_m=0.002),)),
    "critical": tied(ElasticBase(80.0, zeta=1.0), (Damper("friction", f=0.2),)),
    "edge of recentring": tied(ElasticBase(80.0, zeta=0.05), (Damper("friction", f=0.5),)),
    "slack at landing": tied(ElasticBase(80.0, zeta=0.05), (Tendon(lam=0.4),)),
    "hardens": tied(ElasticBase(80.0, zeta=0.05, kinematics="finite"), (Tendon(psi=0.2, lam=math.cos(0.13)),)),
    "prestress at eta": tied(YieldingBase(80.0, eta=1.55, zeta=0.05, spring="epp"), (Tendon(psi=0.5),)),
    "all": tied(
        YieldingBase(80.0, eta=3.0, zeta=0.05),
        (
            Damper("hysteretic", f=0.05, yield_m=0.01),
            Damper("viscous", nu=0.2, exponent=0.3, at=0.0),
            Tendon(psi=0.2, lam=0.2),
        ),
    ),
}


@pytest.mark.slow
@pytest.mark.parametrize("base", [pytest.param(base, id=name) for name, base in HARD.items()])
def test_hard_cases_end_and_their_errors_are_within_those_reported(base):
    for seed in range(3):
        rng = np.random.default_rng(seed)
        motion = Motion("hard", 0.01, broadband(rng, 0.01, 800, 4.0), broadband(rng, 0.01, 800, 3.0))
        found = run_to_tolerance(TOWER, base, motion, 1e-4)
        assert found.status in ("ok", "overturned"), found.reason
        if found.status == "ok":
            fine = run_fixed(TOWER, base, motion, 8 * found.substeps)
            assert abs(found.theta_max - fine.theta_max) <= found.theta_max_error + 1e-9 * TOWER.alpha
