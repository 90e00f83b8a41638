"""Errors of residuals hold while dampers slip, or a bed yields, under what remains of a motion (THEORY.md, Results of a run)."""

import math
from dataclasses import replace

import numpy as np
import pytest
from core_samples import FIG5, pulse
from restrained_reference import TiedTwoSprings

from rockbatch.common.units import GRAVITY
from rockbatch.motions.motion import Motion
from rockbatch.pier import Damper, DeckSpring, ElasticBase, FootingBase, Pier, RigidBase, Tendon, YieldingBase
from rockbatch.simulation import Run, Stop, relaxation, run_to_tolerance, runs
from rockbatch.simulation.recording import recorded
from rockbatch.simulation.relaxation import AHEAD, add_relaxation, decay_rate, share_ahead
from rockbatch.simulation.runs import run_fixed, try_all

ROUNDING = 1e-11
"""Change over α of a pier that friction holds, by rounding in five minutes."""


def stilled(motion: Motion, seconds: float) -> Motion:
    """Return the motion with ``seconds`` of still ground behind it."""
    still = np.zeros(round(seconds / motion.dt))
    vertical = None if motion.vertical is None else np.append(motion.vertical, still)
    return replace(motion, horizontal=np.append(motion.horizontal, still), vertical=vertical)


def changes(pier, base, motion, seconds):
    """Return the error of θ_res/α, and its changes by ``seconds`` of still ground; None if chaotic, or if a pier fell."""
    outcome = run_to_tolerance(pier, base, motion, 1e-4)
    later = [run_to_tolerance(pier, base, stilled(motion, each), 1e-4) for each in seconds]
    if outcome.theta_res_error is None or {outcome.status, *(each.status for each in later)} != {"ok"}:
        return None
    return outcome.theta_res_error / pier.alpha, [
        abs(each.theta_res - outcome.theta_res) / pier.alpha for each in later
    ]


HYSTERETIC = Damper("hysteretic", f=0.1, yield_m=0.005)


@pytest.mark.parametrize(
    "base",
    [
        ElasticBase(50.0, epsilon=0.3, restraints=(HYSTERETIC,)),
        ElasticBase(50.0, epsilon=0.3, restraints=(replace(HYSTERETIC, at="left"),)),
        ElasticBase(50.0, epsilon=0.3, restraints=(Damper("friction", f=0.1),)),
        RigidBase(restraints=(replace(HYSTERETIC, f=0.7),)),
    ],
    ids=["pivots", "left", "friction", "rigid"],
)
def test_still_ground_changes_a_residual_rotation_by_no_more_than_its_error(base):
    """It changes by more than 10⁻³ α, as no halving of the step does."""
    error, later = changes(FIG5, base, pulse("sine", 0.5, 1.0, end=1.2), [40.0, 200.0])
    assert min(later) > 1e-3
    assert max(later) <= error


def test_friction_that_comes_to_hold_the_pier_bounds_nothing_but_its_change():
    """The error is twice that; after 5/p it would still slide."""
    base = ElasticBase(30.0, epsilon=0.3, restraints=(Damper("friction", f=0.03),))
    error, later = changes(FIG5, base, pulse("sine", 0.5, 1.0, end=1.2), [40.0])
    assert error == pytest.approx(2.0 * later[0], rel=1e-3)


def test_friction_that_slides_on_for_long_may_hold_the_pier_elsewhere():
    """At one pivot under undamped vibration: it gets a force after 20/p."""
    base = ElasticBase(30.0, epsilon=0.3, restraints=(Damper("friction", f=0.02, at="left"),))
    error, later = changes(FIG5, base, pulse("sine", 0.5, 1.0, end=1.2), [40.0, 200.0])
    assert min(later) > 1e-6
    assert max(later) <= error


@pytest.fixture
def gone_on(monkeypatch):
    """Return the list of the runs that go on."""
    found = []

    def trying(some, *rest, **more):
        found.extend(some)
        return try_all(some, *rest, **more)

    monkeypatch.setattr(relaxation, "try_all", trying)
    return found


FRICTION = Damper("friction", f=0.3)


@pytest.mark.parametrize(
    ("base", "count"),
    [
        (ElasticBase(50.0, epsilon=0.3, restraints=(HYSTERETIC,)), 1),
        (ElasticBase(50.0, epsilon=0.3, restraints=(Damper("viscous", nu=0.1),)), 0),
        (RigidBase(restraints=(HYSTERETIC,)), 0),
        (ElasticBase(50.0, epsilon=0.3, restraints=(FRICTION,)), 0),
        (ElasticBase(50.0, epsilon=0.3, restraints=(replace(FRICTION, at="left", f=0.5),)), 1),
        (ElasticBase(50.0, epsilon=0.3, restraints=(FRICTION, Damper("viscous", nu=0.1, brace=5.0))), 1),
        (RigidBase(restraints=(replace(FRICTION, f=0.7),)), 0),
    ],
    ids=[
        "hysteretic",
        "viscous",
        "upright",
        "held",
        "held at one pivot",
        "held against a brace",
        "held on rigid ground",
    ],
)
def test_a_run_goes_on_unless_it_stands_upright_or_is_held_or_nothing_keeps_a_force(base, count, gone_on):
    assert run_to_tolerance(FIG5, base, pulse("sine", 0.5, 1.0, end=1.2), 1e-4).status == "ok"
    assert len(gone_on) == count


@pytest.mark.parametrize("base", [ElasticBase(50.0, epsilon=0.3), RigidBase()], ids=["springs", "rigid"])
def test_a_pier_that_friction_holds_stays_where_it_is(base):
    base = replace(base, restraints=(replace(FRICTION, f=0.3 if base.on_springs else 0.7),))
    _, later = changes(FIG5, base, pulse("sine", 0.5, 1.0, end=1.2), [60.0])
    assert later[0] <= ROUNDING


def test_a_run_goes_on_with_the_step_of_its_last_trial_but_one(monkeypatch):
    """Half as many steps tell the change: those of both ends are the same."""
    steps = []

    def trying(some, substeps, *rest, **more):
        steps.extend(substeps)
        return try_all(some, substeps, *rest, **more)

    monkeypatch.setattr(relaxation, "try_all", trying)
    base = ElasticBase(50.0, epsilon=0.3, restraints=(HYSTERETIC,))
    outcome = run_to_tolerance(FIG5, base, pulse("sine", 0.5, 1.0, end=1.2), 1e-4)
    assert steps == [outcome.substeps // 2]


def test_a_run_that_may_not_go_on_may_lose_the_rotation_by_its_dampers(monkeypatch):
    """The rotation with and without the force of the dampers at the end, 10⁻² α, is then its error."""
    base, motion = ElasticBase(50.0, epsilon=0.3, restraints=(HYSTERETIC,)), pulse("sine", 0.5, 1.0, end=1.2)
    known = run_to_tolerance(FIG5, base, motion, 1e-4)
    monkeypatch.setattr(runs, "MOST_STEPS", 1.1 * runs.steps_of(motion, known.substeps, 2.0))
    refused = run_to_tolerance(FIG5, base, motion, 1e-4)
    assert refused.theta_res == known.theta_res
    assert abs(refused.theta_res) <= refused.theta_res_error


def test_on_rigid_ground_a_pier_can_at_most_stand_up():
    """From where it rests later; there the weight helps, and the dampers' force may turn it by much more."""
    base, motion = RigidBase(restraints=(replace(HYSTERETIC, f=0.7),)), pulse("sine", 0.5, 1.0, end=1.2)
    outcome = run_to_tolerance(FIG5, base, motion, 1e-4)
    assert 0.0 < abs(outcome.theta_res) <= outcome.theta_res_error <= 1.5 * abs(outcome.theta_res)


def test_an_outcome_whose_later_trial_is_stopped_is_lost():
    run = Run(FIG5, ElasticBase(50.0, epsilon=0.3, restraints=(HYSTERETIC,)), pulse("sine", 0.5, 1.0, end=1.2))
    (trial,) = try_all([run], [16], 2.0, Stop())
    outcomes, stop = [trial.outcome.changed(theta_res_error=1e-6)], Stop()
    stop.set()
    add_relaxation([run], outcomes, {0: trial}, stop)
    assert outcomes == [None]


def test_later_slip_is_the_sum_of_a_geometric_series():
    assert share_ahead(0.3) == pytest.approx(sum(math.exp(-0.3 * n) for n in range(1, 200)), rel=1e-12)


def test_a_vibration_that_need_not_decay_lasts_for_a_thousand_intervals():
    assert share_ahead(0.0) == share_ahead(1e-9) == AHEAD == 1000.0


def decrement(base):
    """Return the decay rate [1/s] of rocking in full contact after a release from a small rotation."""
    run = Run(replace(FIG5, initial_rotation_rad=2e-4), base, Motion.still(16.0, 0.002))
    outcome = run_fixed(run.pier, base, run.motion, 4, 0.0, wait=False)
    rows = recorded(run, outcome, 0.0, every_step=False, wait=False).rows
    peaks = [window[np.abs(window.theta).argmax()] for window in (rows[1000:3000], rows[6000:8000])]
    return math.log(abs(peaks[0].theta / peaks[1].theta)) / (peaks[1].t - peaks[0].t)


@pytest.mark.parametrize(
    ("base", "share"),
    [
        (ElasticBase(50.0, zeta=0.05), 1.0),
        pytest.param(FootingBase(50.0, None, zeta=0.05), 1.0, marks=pytest.mark.slow),
        (ElasticBase(50.0, epsilon=0.3, restraints=(Damper("viscous", nu=0.1),)), 1.0),
        (ElasticBase(50.0, epsilon=0.3, restraints=(Damper("viscous", nu=0.02, at="deck"),)), 1.0),
        pytest.param(
            ElasticBase(50.0, zeta=0.05, restraints=(Damper("viscous", nu=0.1), DeckSpring(0.1))),
            1.0,
            marks=pytest.mark.slow,
        ),
        (ElasticBase(50.0, epsilon=0.3, restraints=(Damper("viscous", nu=0.1, brace=0.1, confirm=("brace",)),)), 0.3),
    ],
    ids=["dashpots", "footing", "viscous", "deck", "both", "brace"],
)
def test_the_decay_rate_is_that_of_free_vibration(base, share):
    """On a brace it is no more than that."""
    outcome = run_fixed(FIG5, base, pulse("sine", 0.5, 0.1, end=1.0), 16)
    rate = decay_rate(Run(FIG5, base, Motion.still(1.0)), outcome)
    assert share * decrement(base) * 0.97 <= rate <= 1.03 * decrement(base)


@pytest.mark.parametrize(
    "base",
    [
        ElasticBase(50.0, epsilon=0.3, restraints=(HYSTERETIC,)),
        ElasticBase(50.0, epsilon=0.3, restraints=(Damper("viscous", nu=0.1, at=0.0),)),
        ElasticBase(50.0, epsilon=0.3, restraints=(Damper("viscous", nu=0.1, exponent=2.0),)),
        ElasticBase(50.0, epsilon=0.3, restraints=(Damper("viscous", nu=0.1, exponent=0.5, brace=5.0),)),
        RigidBase(restraints=(HYSTERETIC,)),
    ],
)
def test_no_decay_is_sure_where_no_damper_of_rocking_is_linear_at_low_speed(base):
    outcome = run_fixed(FIG5, base, pulse("sine", 0.5, 1.0, end=1.2), 16)
    assert decay_rate(Run(FIG5, base, Motion.still(1.0)), outcome) == 0.0


def test_a_root_of_the_speed_damps_as_at_the_greatest_speed():
    """F = C |w|^a is at least C |w_max|^(a−1) |w|."""
    base = ElasticBase(50.0, epsilon=0.3, restraints=(Damper("viscous", nu=0.1, exponent=0.5),))
    outcome = run_fixed(FIG5, base, pulse("sine", 0.5, 1.0, end=1.2), 32)
    linear = replace(base, restraints=(Damper("viscous", nu=0.1 / math.sqrt(outcome.damper_speed)),))
    rates = [decay_rate(Run(FIG5, each, Motion.still(1.0)), outcome) for each in (base, linear)]
    assert rates[0] == pytest.approx(rates[1], rel=1e-12)


def burst(random, alpha):
    """Return a random burst of 2 to 5 s, half of them with a vertical one."""
    dt = random.choice([0.005, 0.01, 0.02])
    t = np.arange(0.0, random.uniform(2.0, 5.0), dt)

    def noise(peak, highest):
        waves = np.sin(
            2.0 * np.pi * random.uniform(0.3, highest, (12, 1)) * t + random.uniform(0.0, 2.0 * np.pi, (12, 1))
        )
        return peak * GRAVITY * waves.sum(axis=0) / 4.0 * np.hanning(len(t))

    vertical = noise(random.uniform(0.1, 0.5), 10.0) if random.random() < 0.5 else None
    return Motion("burst", dt, noise(math.tan(alpha) * random.uniform(0.8, 4.0), 6.0), vertical)


BESIDE = {
    "alone": (),
    "viscous": (Damper("viscous", nu=0.05),),
    "tendon": (Tendon(psi=0.15, lam=0.5, strength=0.5),),
    "deck": (DeckSpring(0.1),),
    "friction": (Damper("friction", f=0.05),),
}


def hard(number, beside, kinematics):
    """Return a random pier with hysteretic dampers on springs, elastic, yielding or damped, or on a footing, and a burst."""
    random = np.random.default_rng([number, len(beside), len(kinematics)])
    alpha = random.uniform(0.08, 0.3)
    pier = Pier(alpha, random.uniform(0.5, 2.0), random.uniform(2.0, 5.0), confirm=("alpha", "mu", "p"))
    steel = Damper(
        "hysteretic", f=random.uniform(0.02, 0.2), yield_m=10 ** random.uniform(-3.0, -2.0), confirm=("f", "yield_m")
    )
    place = random.choice(["pivots", "left", "deck"], p=[0.7, 0.15, 0.15])
    steel = replace(steel, at=None if place == "pivots" else str(place), f=steel.f * (0.2 if place == "deck" else 1.0))
    devices = (steel, *BESIDE[beside])
    beta, damped = max(1.3 * pier.least_beta, random.uniform(20.0, 80.0)), {"zeta": 10 ** random.uniform(-2.0, -0.3)}
    support = damped if number % 3 else {"epsilon": random.choice([0.0, 0.3, 0.9])}
    shared = {"kinematics": kinematics, "restraints": devices}
    if number % 4 == 0:
        base = FootingBase(2.0 * beta, random.uniform(2.0, 8.0), **damped, **shared, confirm=("zeta", "safety_factor"))
    elif number % 4 == 1:
        base = YieldingBase(beta, eta=random.uniform(2.0, 5.0), spring="epp", **support, **shared)
    else:
        base = ElasticBase(beta, **support, **shared)
    return pier, base, burst(random, alpha)


@pytest.mark.thorough
@pytest.mark.parametrize("kinematics", ["first-order", "finite"])
@pytest.mark.parametrize("beside", BESIDE)
def test_of_random_hard_cases_still_ground_changes_none_by_more_than_its_error(beside, kinematics):
    """By a minute and by five; the median of the errors is at most 15 times the greater change where that is no rounding."""
    ratios = []
    for number in range(24):
        found = changes(*hard(number, beside, kinematics), [60.0, 300.0])
        if found is None:
            continue
        error, later = found
        assert max(later) <= error + ROUNDING, number
        ratios += [error / max(later)] if max(later) > 1e-8 else []
    assert len(ratios) >= 5
    assert np.median(ratios) <= 15.0


@pytest.mark.thorough
@pytest.mark.parametrize("beside", ["alone", "viscous", "tendon"])
@pytest.mark.parametrize("kinematics", ["first-order", "finite"])
def test_the_reference_comes_to_rest_within_the_error(beside, kinematics):
    """A minute after the motion, on damped springs, by a solver of its own; it rests elsewhere than the last forces say."""
    base = ElasticBase(50.0, zeta=0.1, kinematics=kinematics, restraints=(HYSTERETIC, *BESIDE[beside]))
    motion = pulse("sine", 0.5, 1.0, dt=0.01, end=1.2)
    outcome = run_to_tolerance(FIG5, base, motion, 1e-5)
    rest = TiedTwoSprings(FIG5, base, motion, 60.0).run()
    assert abs(rest.omega) < 1e-5
    assert 4e-4 < abs(rest.theta - outcome.theta_res) <= outcome.theta_res_error


def on_bed(number):
    """Return a random pier on a footing that yields, and a pulse or a burst behind which the ground is still at once."""
    random = np.random.default_rng([number, 77])
    pier = Pier(alpha=random.uniform(0.1, 0.25), p=random.uniform(0.4, 1.4))
    if random.random() < 0.5:
        period = random.uniform(0.5, 4.0)
        t = np.arange(0.0, period, 0.01)
        wave = np.sin(2.0 * np.pi * t / period * random.choice([0.5, 1.0, 2.0]))
    else:
        t = np.arange(0.0, random.uniform(4.0, 15.0), 0.01)
        waves = np.sin(2.0 * np.pi * random.uniform(0.3, 3.0, (10, 1)) * t + random.uniform(0.0, 6.28, (10, 1)))
        wave = waves.sum(axis=0) / 3.0 * np.hanning(len(t))
    motion = Motion("at once", 0.01, GRAVITY * np.tan(pier.alpha) * random.uniform(0.6, 2.0) * wave)
    beta, damped = max(3.0 * pier.least_beta, 10.0 ** random.uniform(1.5, 1.9)), 10.0 ** random.uniform(-2.0, -0.7)
    return (
        pier,
        FootingBase(beta, float(random.choice([1.5, 2.0, 3.0, 5.0])), damped, confirm=("safety_factor", "zeta")),
        motion,
    )


@pytest.mark.slow
def test_still_ground_changes_the_plastic_work_of_a_bed_by_no_more_than_its_error():
    """By a third of what it is at the end of the run, as no halving of the steps or strips does."""
    pier, base, motion = on_bed(4)
    soon, late = (run_to_tolerance(pier, base, motion, 1e-4, tail).bed for tail in (2.0, 60.0 / pier.p))
    assert 0.3 * soon.work < late.work - soon.work <= soon.work_error


@pytest.mark.thorough
def test_still_ground_changes_no_residual_on_a_bed_by_more_than_its_error():
    """The bed yields on while the pier still rocks; six of 28 by more than the errors of steps and strips."""
    compared, shares = 0, []
    for number in range(40):
        pier, base, motion = on_bed(number)
        soon, late = (run_to_tolerance(pier, base, motion, 1e-4, tail) for tail in (2.0, 60.0 / pier.p))
        if {soon.status, late.status} != {"ok"} or soon.theta_res_error is None:
            continue
        compared += 1
        for name, size in (("theta_res", pier.alpha), ("settlement", pier.alpha * pier.half_width)):
            change, error = abs(getattr(late, name) - getattr(soon, name)), getattr(soon, f"{name}_error")
            assert change <= error + 1e-9 * size, (number, name)
            shares.append(change / size)
    assert compared >= 20
    assert sum(share > 1e-3 for share in shares) >= 4
