"""Separations, impacts, reversals: located to the order of the method, each once, in every awkward arrangement."""

import functools
import math
from itertools import permutations

import numpy as np
import pytest
from core_samples import EVERY_KIND, FIG5, broadband, hard_case, hard_seeds, pulse, steady, values_of
from reference_solver import reference
from scipy.interpolate import CubicHermiteSpline

import rockbatch as rb
from rockbatch import simulate
from rockbatch.core.block.equations import constrained, on_side
from rockbatch.core.block.model import Rocking, Stance
from rockbatch.core.ground import later
from rockbatch.core.kernel import entry
from rockbatch.core.rk4 import rk4
from rockbatch.core.roots import NEAR, hermite, largest_within, lowest_within, turning_point
from rockbatch.core.search import EventFunctions, _earliest, nearby
from rockbatch.core.springs.equations import holding, pivot_acceleration, touching
from rockbatch.core.springs.events import settle
from rockbatch.core.springs.model import Contact, State, Supports
from rockbatch.core.springs.reversal import Pivot
from rockbatch.core.system import rates
from rockbatch.core.types import (
    CONTACT_LEFT,
    IMPACT_BOTH,
    IMPACT_LEFT,
    LEFT,
    NO_EVENT,
    RIGHT,
    SURVIVED,
    Ground,
    Instant,
    Moment,
)
from rockbatch.motions.motion import Motion
from rockbatch.pier import ElasticBase, Pier, RigidBase, YieldingBase
from rockbatch.simulation import Run, block, least_substeps, run_fixed, springs, written_run

CONTACT_EVENTS = (1, 2, 3, 4)
COARSE_SINE = pulse("sine", 0.5, dt=0.02, end=3.0)
SHAKEN = Motion(
    "shaken",
    0.02,
    COARSE_SINE.horizontal,
    broadband(np.random.default_rng(0), 0.02, COARSE_SINE.npts, 5.0),
)
ORDER_CASES = [
    pytest.param(YieldingBase(50.0, 0.1, eta=2.2), COARSE_SINE, id="fig5"),
    pytest.param(YieldingBase(50.0, 0.1, "finite", eta=2.2, spring="epp"), COARSE_SINE, id="epp-finite"),
    pytest.param(YieldingBase(50.0, 0.1, eta=2.2, spring="hardening"), COARSE_SINE, id="hardening"),
    pytest.param(ElasticBase(50.0, 0.4), COARSE_SINE, id="elastic"),
    pytest.param(YieldingBase(50.0, 0.1, "finite", "guided", eta=5.0), SHAKEN, id="vertical-finite"),
]


@functools.cache
def expected_of(base, name):
    """The reference's run, which every number of steps is compared with."""
    return reference(FIG5, base, {"coarse": COARSE_SINE, "shaken": SHAKEN}[name])


def errors(base, motion, substeps, locate):
    """Errors of the contact events' times [s], of the rotation at the end and of the greatest one [rad]."""
    expected = expected_of(base, "coarse" if motion is COARSE_SINE else "shaken")
    times = np.array([t for t, kind, _ in expected.events if kind in ("separation", "impact")])
    run, rows = written_run(Run(FIG5, base, motion), substeps, 0.0, 400_000, locate, wait=False)
    rows = rows[: run.rows]
    found = rows.t[np.isin(rows.kind, CONTACT_EVENTS)]
    assert len(found) == len(times)
    return np.abs(found - times).max(), abs(rows[-1].omega - expected.omega), abs(run.theta_max - expected.theta_max)


@pytest.mark.parametrize(("base", "motion"), ORDER_CASES)
def test_order_is_four_across_events(base, motion):
    """Over two halvings from 16 to 64 steps per 0.02 s: event times and the peak within 4 ± 0.2.

    The angular velocity at the end passes through every event too; its error mixes signs, so only ≥ 3.5 is asked.
    """
    coarse, fine = (errors(base, motion, substeps, True) for substeps in (16, 64))
    orders = [math.log2(a / b) / 2 for a, b in zip(coarse, fine, strict=True)]
    assert orders[0] == pytest.approx(4.0, abs=0.2)
    assert orders[2] == pytest.approx(4.0, abs=0.2)
    assert orders[1] > 3.5


def test_order_is_four_across_the_impacts_of_a_rigid_block():
    """Lift-off, impacts and the peak of Fig. 5's rigid block, for 1 to 4 steps per 0.02 s: beyond, rounding rules."""
    expected = reference(FIG5, RigidBase(), COARSE_SINE)
    gaps = [
        abs(run_fixed(FIG5, RigidBase(), COARSE_SINE, k, 0.0, wait=False).theta_max - expected.theta_max)
        for k in (1, 4)
    ]
    assert math.log2(gaps[0] / gaps[1]) / 2 == pytest.approx(4.0, abs=0.2)


@pytest.mark.parametrize("kinematics", ["first-order", "finite"])
def test_order_is_four_in_full_contact(kinematics):
    """A pulse too weak to lift a pivot: no events, the smooth equations alone, against 64 times finer steps."""
    weak = Motion("weak", 0.02, 0.02 * COARSE_SINE.horizontal)
    base = ElasticBase(50.0, 0.4, kinematics)
    ends = [simulate(FIG5, base, weak, substeps=k, quiet_s=0.0, wait=False).history.iloc[-1] for k in (4, 16, 256)]
    gaps = [abs(end["theta"] - ends[-1]["theta"]) for end in ends[:2]]
    assert run_fixed(FIG5, base, weak, 4, 0.0, wait=False).separations == 0
    assert math.log2(gaps[0] / gaps[1]) / 2 == pytest.approx(4.0, abs=0.2)


@pytest.mark.parametrize(("base", "motion"), ORDER_CASES[:3])
def test_order_is_about_one_when_events_are_not_located(base, motion):
    """The error then depends on where in its step an event falls, so the slope over four halvings is 1 ± 0.7."""
    coarse, fine = (errors(base, motion, substeps, False)[0] for substeps in (8, 128))
    assert math.log2(coarse / fine) / 4 == pytest.approx(1.0, abs=0.7)
    assert fine > 1e4 * errors(base, motion, 128, True)[0]


@entry
def taken(m, now, ground, x):
    """Start and end of a step over ``x``."""
    start, there = (
        Instant(now.y, rates(m, now.y, now.contact, ground), now.contact, now.supports, ground),
        later(ground, x),
    )
    end = rk4(m, None, start, x)
    return start, Instant(end, rates(m, end, now.contact, there), now.contact, now.supports, there)


@entry
def near_an_end(m, now, ground, t, x):
    start, end = taken(m, now, ground, t)
    return nearby(m, start, end, t, x)


def random_moment(rng, m):
    theta, omega, v_rate = rng.normal(0.0, (0.1, 0.3, 0.3))
    if not hasattr(m, "stiffness"):
        contact = on_side(math.copysign(1.0, theta))
        return Moment(constrained(m, Rocking(0.0, theta, 0.0, omega), contact), contact, None), 0.02 / m.p
    left, right = rng.integers(0, 2, 2) * 1.0
    y = State(0.0, theta, v_rate, omega, *-rng.uniform(0.1, 0.8, 2))
    period = math.sqrt(m.yield_deflection / m.yield_force)
    return Moment(y, Contact(left, right, left, right, 0.0), Supports(0.0, 0.0, -1.0, -1.0)), 0.2 * period


@pytest.mark.parametrize(
    "m",
    [block(FIG5, RigidBase()), *(springs(FIG5, YieldingBase(50.0, eta=3.0, zeta=zeta)) for zeta in (None, 0.2))],
    ids=["rigid", "bouc-wen", "damped"],
)
def test_a_state_near_the_end_of_a_step_is_that_of_a_step_to_there(m):
    """To within a thousandth of that step's own error and 1e-9 of its way.

    Farther away, what is not in closed form is on the cubic.
    """
    rng = np.random.default_rng(0)
    for _ in range(100):
        now, h = random_moment(rng, m)
        t, ground = h * rng.uniform(0.01, 1.0), Ground(*rng.normal(0.0, (5.0, 100.0, 5.0, 100.0)))
        x, far = t * (1.0 + NEAR * rng.uniform(-1.0, 1.0)), t * rng.uniform(0.5, 1.5)
        (_, k, *_), (end, k_end, *_) = taken(m, now, ground, t)
        middle = taken(m, now, ground, 0.5 * t)[1].y
        twice = taken(m, Moment(middle, *now[1:]), later(ground, 0.5 * t), 0.5 * t)[1].y
        error = 1e-3 * np.abs(np.subtract(end, twice)).max() + 1e-9 * np.abs(t * np.array(k)).max()
        (near, k_near), there = near_an_end(m, now, ground, t, x), taken(m, now, ground, x)[1]
        assert np.abs(np.subtract(near, there.y)).max() <= error
        assert t * np.abs(np.subtract(k_near, there.k)).max() <= error
        cubic = CubicHermiteSpline([0.0, t], [now.y, end], [k, k_end])(far)
        beyond, _ = near_an_end(m, now, ground, t, far)
        for name in ("theta", "omega"):
            expected = cubic[now.y._fields.index(name)]
            assert getattr(beyond, name) == pytest.approx(expected, abs=1e-13)


@pytest.mark.slow
def test_several_events_in_one_step_are_taken_in_their_order():
    """ω_v h = 0.5 and a strong vertical motion: events share steps, yet their sequence is the reference's.

    Times within 2 % of a step: RK4 leaves 0.7 % of it here.
    """
    rng = np.random.default_rng(10)
    dt = 0.05
    vertical = broadband(rng, dt, 81, 9.0)
    motion = Motion("coarse", dt, pulse("sine", 1.0, 0.6, dt=dt, end=4.0).horizontal, vertical)
    base = YieldingBase(20.0, 0.3, "finite", "guided", eta=3.0)
    expected = reference(FIG5, base, motion)
    run, rows = written_run(Run(FIG5, base, motion), 2, 0.0, 2000, wait=False)
    rows = rows[: run.rows]
    found = rows[np.isin(rows.kind, CONTACT_EVENTS)]
    steps = np.floor(found.t / (dt / 2))
    assert np.bincount(steps.astype(int)).max() >= 2  # two contact events among them
    kinds = {"separation": {"left": 1, "right": 2}, "impact": {"left": 3, "right": 4}}
    events = [(t, kinds[kind][pivot]) for t, kind, pivot in expected.events if kind in kinds]
    assert [int(kind) for kind in found.kind] == [kind for _, kind in events]
    np.testing.assert_allclose(found.t, [t for t, _ in events], rtol=0, atol=0.02 * dt / 2)


PUSH = -0.7 * FIG5.gravity * math.tan(FIG5.alpha)


def first_lift(base, dt: float, samples: int) -> float:
    """Time of the first separation under a steady push."""
    motion = steady(PUSH, 0.0, dt, samples)
    run = rb.simulate(FIG5, base, motion, substeps=1, quiet_s=0.0, wait=False)
    return float(run.events.loc[run.events.kind == "separation", "t"].iloc[0])


@functools.cache
def tuned(base) -> float:
    """The sampling interval at which the first separation falls on the 40th sample."""
    dt = 0.004
    for _ in range(5):  # the event's time depends on dt only by the integrator's error
        dt = first_lift(base, dt, 120) / 40
    return dt


@pytest.mark.parametrize("nudge", [-1e-9, -2e-16, 0.0, 2e-16, 1e-9])
@pytest.mark.parametrize(
    "base",
    [
        ElasticBase(50.0, 0.1, flight="guided"),
        YieldingBase(50.0, 0.1, "finite", "guided", eta=4.0),
        YieldingBase(50.0, 0.0, flight="guided", eta=2.0, spring="epp"),
    ],
    ids=["elastic", "bouc-wen", "epp"],
)
def test_an_event_at_a_sample_is_like_any_other(base, nudge):
    """dt is tuned until a separation falls on the 40th sample, just before it, or just after it: same response.

    A separation that was missed, doubled or moved to the far end of its step would change the rotation by the order
    of the step, 1e-3; neighbouring dt change it by their own RK4 error, below 1e-7.
    """
    samples = 160
    dt = tuned(base) * (1.0 + nudge)
    motion = steady(PUSH, 0.0, dt, samples)
    run = rb.simulate(FIG5, base, motion, substeps=1, quiet_s=0.0, wait=False)
    neighbour = steady(motion.horizontal[0], 0.0, dt * 1.01, samples)
    other = rb.simulate(FIG5, base, neighbour, substeps=1, quiet_s=0.0, wait=False)
    assert list(run.events.loc[run.events.kind != "spring", "pivot"])[:1] == ["left"]
    lifts = run.events[run.events.kind == "separation"]
    assert abs(lifts.t.iloc[0] - 40 * dt) < 1e-8 * dt + abs(nudge) * 50 * dt
    expected = reference(FIG5, base, motion)
    assert run.theta[-1] == pytest.approx(expected.theta, abs=1e-7)
    assert len(lifts) == len(other.events[other.events.kind == "separation"])


def bounce() -> Motion:
    """The ground drops away at 2 g for 0.1 s and comes back: flight without rotation."""
    t = np.arange(201) * 0.01
    return Motion("drop", 0.01, np.zeros(201), np.where(t < 0.1, -2.0 * FIG5.gravity, 0.0))


@pytest.mark.parametrize("kinematics", ["first-order", "finite"])
@pytest.mark.parametrize("epsilon", [0.0, 0.3, 1.0])
def test_both_pivots_landing_at_one_instant_keep_the_pier_upright(kinematics, epsilon):
    """Symmetry: θ stays 0, but for squares of rounding; landings come in pairs; v is the reference's."""
    base = YieldingBase(20.0, epsilon, kinematics, "guided", eta=3.0)
    run, rows = written_run(Run(FIG5, base, bounce()), 8, 0.0, 5000, wait=False)
    expected = reference(FIG5, base, bounce())
    assert run.status == SURVIVED
    assert run.impacts >= 2
    assert run.impacts % 2 == 0
    assert np.abs(rows.theta[: run.rows]).max() < 1e-25
    assert run.impacts == expected.impacts
    assert run.t_flight == pytest.approx(expected.t_flight, abs=1e-6)
    assert rows[run.rows - 1].v == pytest.approx(expected.v, abs=1e-6)


@pytest.mark.parametrize(("velocity", "kind"), [(-0.2, IMPACT_BOTH), (0.0, IMPACT_LEFT), (0.2, IMPACT_LEFT)])
def test_a_pivot_lands_with_the_other_only_if_both_fall(velocity, kind, uncompiled):
    """An upright pier in flight, both pivots on their supports; landed together both keep a share ε of their velocities."""
    m = springs(FIG5, YieldingBase(20.0, 0.3, flight="guided", eta=3.0))
    b, left = m.half_width, -0.5
    falls = State(0.0, 0.0, 0.5 * (left + velocity), 0.5 * (left - velocity) / b, 0.0, 0.0)
    now, still = (
        Moment(falls, Contact(0.0, 0.0, 0.0, 0.0, 0.0), Supports(0.0, 0.0, 0.0, 0.0)),
        Ground(0.0, 0.0, 0.0, 0.0),
    )
    ((after, found),) = uncompiled(values_of, [("springs.transitions", "handle", m, now, CONTACT_LEFT, still)])
    speeds = after.y.v_rate + b * after.y.omega, after.y.v_rate - b * after.y.omega
    assert found == kind
    assert speeds[0] == pytest.approx(0.3 * left, rel=1e-9)
    assert (speeds[1] == pytest.approx(0.3 * velocity, rel=1e-9)) == (kind == IMPACT_BOTH)


def test_a_gap_within_rounding_is_open_unless_the_pivot_moves_or_falls(uncompiled):
    m = springs(FIG5, ElasticBase(50.0))
    tiny, g = 1e-13 * m.yield_deflection, m.gravity
    cases = [
        (0.0, 0.0, 0.0),
        (-tiny, 0.0, 0.0),
        (-tiny, 0.0, g),
        (-tiny, 0.0, -g),
        (-tiny, 1.0, g),
        (-20.0 * tiny, 0.0, g),
    ]
    found = uncompiled(values_of, [("springs.events", "_gap", m, *case) for case in cases])
    opened = 10.0 * tiny
    assert found == pytest.approx([opened, opened, opened, -tiny, -tiny, -20.0 * tiny], rel=1e-9, abs=0.0)


def test_a_spring_pressed_beyond_its_strength_is_no_softer_than_at_it(uncompiled):
    """δ_y dz/dv = 1 − |z|ⁿ on the inelastic branch: half at z = −0.5 for n = 1, none from −1 on."""
    m = springs(FIG5, YieldingBase(50.0, 0.1, eta=2.3, n=1.0))
    pressed = Pivot(-1.0, -0.5)
    calls = [("springs.reversal", "reversal", m, -1.0, pressed, 0.0, pressed, z, 0.01) for z in (-0.5, -1.0, -1.05)]
    assert [found.softness for found in uncompiled(values_of, calls)] == pytest.approx([0.5, 0.0, 0.0], abs=1e-12)


@pytest.mark.parametrize("top", [-1.0, 0.0, 1.0])
def test_the_deck_of_a_frame_in_flight_changes_corners_at_no_tilt(top, uncompiled):
    frame = block(Pier.frame(Pier.rectangle(2.0, 12.0, mass_t=60.0), 4, 180.0), RigidBase())
    y, k = Rocking(0.3, 0.1, 0.0, -0.4), Rocking(0.0, -0.4, 0.0, 0.0)
    calls = [
        ("block.events", "_deck_tilt", m, y, k, Stance(0.0, 0.0, top, top)) for m in (frame, block(FIG5, RigidBase()))
    ]
    of_frame, of_block = uncompiled(values_of, calls)
    assert of_frame == ((0.1 * top, -0.4 * top) if top else (1.0, 0.0))
    assert of_block == (1.0, 0.0)


def test_a_brief_separation_inside_one_large_step_is_seen():
    """A vertical push that unloads both springs for less than a step: −z crosses zero twice between the ends.

    Sinking onset is swept, so that some runs have both crossings inside one step; all must count as the fine run does.
    """
    base = ElasticBase(10.0, 0.5, flight="guided")
    inside = 0
    for amplitude in np.linspace(0.5003, 0.52, 12):
        motion = steady(0.0, -amplitude * FIG5.gravity, 0.04, 26)  # v overshoots by twice the static change
        coarse, rows = written_run(Run(FIG5, base, motion), 1, 0.0, 500)
        fine = run_fixed(FIG5, base, motion, 32, 0.0, wait=False)
        if fine.separations == 0:
            continue
        events = rows[: coarse.rows]
        events = events[events.kind > 0]
        assert coarse.uplifts > 0, amplitude
        inside += int(math.floor(events[0].t / 0.04) == math.floor(events[2].t / 0.04))
    assert inside >= 1


@EVERY_KIND
def test_no_event_fires_twice(kinds):
    """On each pivot separation and impact alternate, through random hard cases with ε > 0."""
    checked = 0
    for seed in hard_seeds(range(60), kinds):
        pier, base, motion = hard_case(seed)
        if base.epsilon == 0.0:
            continue
        run, rows = written_run(Run(pier, base, motion), 8, 0.5, 400_000)
        rows = rows[: min(run.rows, len(rows))]
        for left in (True, False):
            own = {1: 1, 3: -1, 5: -1} if left else {2: 1, 4: -1, 5: -1}
            turns = [own[int(kind)] for kind in rows.kind if int(kind) in own]
            assert turns == [1, -1] * (len(turns) // 2) + [1] * (len(turns) % 2), seed
            checked += len(turns)
    assert checked > 500


@pytest.mark.parametrize(
    ("alpha", "beta", "frequency", "peak", "when"),
    [(0.74, 7.2, 1.18, 20.550216029658475, 0.98), (0.86, 10.9, 1.98, 27.55362726555261, 0.55)],
)
def test_a_pivot_that_contact_lifts_and_freedom_presses_is_held(alpha, beta, frequency, peak, when):
    """ε = 0 (Filippov's sliding mode): the run neither loops nor fails, and follows the reference, which holds it."""
    pier = Pier(alpha, 1.0)
    ground = np.sin(2 * math.pi * frequency * np.arange(150) * 0.02)
    motion = Motion("sine", 0.02, peak * ground)
    base = ElasticBase(beta, 0.0, flight="guided")
    expected = reference(pier, base, motion)
    held = [t for t, kind, _ in expected.events if kind == "held"]
    assert held[0] == pytest.approx(when, abs=0.01)
    outcome = run_fixed(pier, base, motion, 40, 0.0, wait=False)
    assert outcome.status == "ok"
    assert outcome.theta_max == pytest.approx(expected.theta_max, abs=1e-8 * alpha)
    end = rb.simulate(pier, base, motion, substeps=40, quiet_s=0.0, wait=False).history.iloc[-1]
    assert end["theta"] == pytest.approx(expected.theta, abs=1e-7 * alpha)


def test_impacts_of_a_rigid_block_accumulate_to_rest_in_finite_time():
    """Zeno: with e = 0.5 the block rests, exactly, within a second of the pulse, after a finite count of impacts."""
    run = rb.simulate(FIG5, RigidBase(restitution=0.5), COARSE_SINE, substeps=4)
    assert run.events.kind.iloc[-1] == "rest"
    assert run.theta[-1] == run.omega[-1] == 0.0
    assert len(run.events) < 100


@pytest.mark.parametrize("kinematics", ["first-order", "finite"])
def test_a_run_from_rest_does_not_chatter_on_the_rounding_of_its_equilibrium(kinematics):
    """The static balance leaves accelerations of 1e-15 m/s²; their sign must not fight that of the coming shaking."""
    failed = []
    rng = np.random.default_rng(0)
    motion = Motion("ramp", 0.01, np.arange(10) * 0.01)
    for _ in range(150):
        pier = Pier(0.2, round(rng.uniform(0.5, 4.0), 1))
        eta, beta = round(1.05 + 9.0 * rng.uniform(), 2), float(round(rng.uniform(20.0, 100.0)))
        base = YieldingBase(beta, 0.1, kinematics, eta=eta)
        if run_fixed(pier, base, motion, least_substeps(pier, base, motion.dt), 0.0, wait=False).status != "ok":
            failed.append((pier.p, beta, eta))
    known = run_fixed(Pier(0.2, 1.6), YieldingBase(34.0, 0.1, eta=7.32), motion, 1, 0.0, wait=False)
    assert (known.status, failed) == ("ok", [])


@EVERY_KIND
@pytest.mark.parametrize("block", range(3))
def test_random_hard_cases_end_with_a_sane_result(block, kinds):
    """No hang, no NaN, no failure, counts that can be: 300 cases from the corners of what the input checks let through.

    A pivot can land only after it has left, so separations − impacts is the number of pivots in the air at the end.
    """
    for seed in hard_seeds(range(100 * block, 100 * block + 100), kinds):
        pier, base, motion = hard_case(seed)
        substeps = max(1, math.ceil(base.beta * pier.p * motion.dt / 0.2))
        outcome = run_fixed(pier, base, motion, substeps, 0.5, wait=False)
        assert outcome.status in ("ok", "overturned", "flight"), (seed, outcome.reason)
        assert math.isfinite(outcome.theta_max), seed
        assert 0.0 <= outcome.t_max <= outcome.t_end + 1e-12, seed
        assert 0 <= outcome.separations - outcome.impacts <= 2, seed
        if base.flight == "stop" and outcome.t_flight is not None:
            assert outcome.status in ("flight", "overturned"), seed
        if outcome.status == "ok":
            assert abs(outcome.theta_max) < 0.5 * math.pi, seed
            assert math.isfinite(outcome.settlement), seed
        if isinstance(base, YieldingBase):
            yield_energy = 0.5 * base.eta**2 * pier.gravity**2 / (base.beta * pier.p) ** 2
            assert outcome.dissipated_left > -1e-7 * yield_energy, seed  # RK4: 1e-9 at k = 1, gone at 2
            assert outcome.dissipated_right > -1e-7 * yield_energy, seed
            assert outcome.ductility_left >= 1.0 / base.eta - 1e-9, seed


# Inside one step


def test_hermite_cubic_and_its_turning_point_reproduce_a_cubic():
    """f = x³ − x on [0, 1]: exact but for rounding, with its minimum at 1/√3."""
    f0, d0, f1, d1 = 0.0, -1.0, 0.0, 2.0
    for x in (0.1, 0.5, 0.9):
        assert hermite(f0, d0, f1, d1, 1.0, x) == pytest.approx(x**3 - x, abs=1e-15)
    assert turning_point(f0, d0, f1, d1, 1.0) == pytest.approx(1.0 / math.sqrt(3.0), abs=1e-15)
    where, value = largest_within(f0, d0, f1, d1, 1.0, 0.0)
    assert (where, value) == pytest.approx((1.0 / math.sqrt(3.0), 2.0 / (3.0 * math.sqrt(3.0))), abs=1e-15)


def test_the_greatest_of_random_cubics_is_that_of_a_grid():
    """NumPy's polynomials through both ends, at 4,001 points: the slope changes its sign once, or is 0 at the start."""
    rng = np.random.default_rng(5)
    x = np.linspace(0.0, 1.0, 4001)
    basis = np.linalg.inv([[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [1.0, 1.0, 1.0, 1.0], [0.0, 1.0, 2.0, 3.0]])
    for _ in range(300):
        h = 10.0 ** rng.uniform(-3.0, 1.0)
        f0, d0, f1, d1 = rng.normal(size=4) * (1.0, 20.0 ** rng.uniform(-1.0, 1.0), 1.0, 20.0 ** rng.uniform(-1.0, 1.0))
        d0, d1 = d0 * (rng.random() > 0.1), -math.copysign(d1, d0)
        values = abs(np.polynomial.polynomial.polyval(x, basis @ (f0, d0, f1, d1)))
        for before in (0.5, 0.999, 1.001, 2.0):
            best = max(before * values.max(), abs(f0))  # the start is the end of the step before
            at, found = largest_within(f0, d0 / h, f1, d1 / h, h, best)
            if values.max() > best:
                assert found == pytest.approx(values.max(), rel=1e-5)
                assert 0.0 < at <= h
                assert abs(hermite(f0, d0 / h, f1, d1 / h, h, at)) == pytest.approx(found, rel=1e-12)
            else:
                assert (at, found) == (-1.0, best)


def test_the_least_of_random_cubics_is_that_of_a_grid_whatever_was_least_before():
    """Of those that fall at the start and rise at the end, and of monotonic ones."""
    rng = np.random.default_rng(6)
    x = np.linspace(0.0, 1.0, 2001)
    for _ in range(300):
        h = 10.0 ** rng.uniform(-3.0, 1.0)
        f0, f1 = rng.normal(size=2)
        d0, d1 = (f1 - f0, f1 - f0) if rng.random() < 0.2 else abs(rng.normal(size=2)) * (-5.0, 5.0)
        least = CubicHermiteSpline([0.0, 1.0], [f0, f1], [d0, d1])(x).min()
        for above in (-1.0, -1e-3, 1e-3, 1.0):
            best = min(least + above, f0)  # the start is the end of the step before
            assert lowest_within(f0, d0 / h, f1, d1 / h, h, best) == pytest.approx(min(best, least), abs=1e-5)


@pytest.mark.parametrize("side", [LEFT, RIGHT])
@pytest.mark.parametrize("yields", [0.0, 1.0])
def test_a_pivot_that_grazes_its_support_leaves_the_other_on_its_branch(side, yields):
    """In contact before, with a spring that yields or not, or grazing itself: then it is in contact, on the branch asked for."""
    pressed = touching(touching(Contact(0.0, 0.0, 0.0, 0.0, 0.0), side, 1.0 - yields), -side, yields)
    grazing = Contact(0.0, 0.0, 0.0, 0.0, float(-side))
    for before in (pressed, grazing):
        after = holding(before, side, yields)
        branches = {LEFT: (after.left, after.left_yields), RIGHT: (after.right, after.right_yields)}
        assert branches == {side: (0.0, 0.0), -side: (1.0, yields)}
        assert after.held == side


@pytest.mark.parametrize("shares", [*permutations((0.2, 0.5, 0.7, math.inf))])
def test_of_event_functions_that_fall_in_a_step_the_first_to_reach_zero_is_the_event(shares):
    """Straight lines from 1 that reach zero at these shares of the step."""
    h, falling = 0.1, np.divide(1.0, shares)
    early, late = (EventFunctions(1.0 - at * falling, -falling / h) for at in (0.0, 1.0))
    which, first = _earliest(early, late, h)
    assert (which, first) == (np.argmin(shares), pytest.approx(0.02, rel=1e-12))
    assert _earliest(early, early, h)[0] == NO_EVENT


@pytest.mark.parametrize("side", [LEFT, RIGHT])
@pytest.mark.parametrize("kinematics", ["first-order", "finite"])
def test_a_pivot_at_its_support_stays_if_pressed_and_goes_if_lifted(kinematics, side):
    """The ground falls away at an acceleration by which the pivot in contact rises by 0.5 m/s², or is pressed down by it."""
    m = springs(FIG5, ElasticBase(50.0, 0.1, kinematics))
    y = State(0.0, 0.01 * side, 0.0, 0.0, -0.4, -0.4)
    both = Contact(1.0, 1.0, 0.0, 0.0, 0.0)
    level = pivot_acceleration(m, y, both, side, Ground(0.0, 0.0, 0.0, 0.0))
    for rises in (0.5, -0.5):
        ground = Ground(0.0, 0.0, level - rises, 0.0)
        assert pivot_acceleration(m, y, both, side, ground) == pytest.approx(rises, rel=1e-9)
        after = settle(m, y, both, side, ground)
        assert (after.left if side == LEFT else after.right, after.held) == (float(rises < 0.0), 0.0)
        assert (after.right if side == LEFT else after.left) == 1.0
