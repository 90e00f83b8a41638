"""The ends of every range: no hang, no NaN, no blow-up that looks like an answer, and each result right for a reason.

What each test compares with is named in its docstring: a closed form, a symmetry, or the second implementation in
reference_solver.py. The two studies configs/hard_cases*.toml hold all that a study file can say of this.
"""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from core_runs import run_block
from core_samples import FIG5, pulse, steady
from reference_solver import reference
from scipy.optimize import brentq

import rockbatch as rb
from rockbatch.common.errors import InputError
from rockbatch.common.units import GRAVITY
from rockbatch.motions.motion import Motion
from rockbatch.pier import ElasticBase, Pier, RigidBase, YieldingBase, problems
from rockbatch.simulation import Run, block, run_fixed, run_to_tolerance, written_run
from rockbatch.study import load_study

CONFIGS = Path(__file__).parents[2] / "configs"
INERTIA = FIG5.inertia + FIG5.height**2  # I0/M + h²
SEPARATION = (1 + FIG5.mu) / (FIG5.mu * 50.0**2 * math.sin(FIG5.alpha))  # THEORY.md, eq. 10, for β = 50
ROCKING = math.sqrt(((50.0 * FIG5.half_width) ** 2 - GRAVITY * FIG5.height) / INERTIA)  # ω_r [rad/s] for β = 50


# The studies

OVERTURNED = {
    ("full amplitude at once", "barely carried"),
    ("jumps from + to - within dt", "barely carried"),
    ("jumps from + to - within dt", "barely upright"),
    ("10 minutes of shaking", "barely carried"),
    ("rigid, less 1e-6", "all or nothing 0"),
    ("rigid, less 1e-6", "all or nothing 1"),
    ("rigid, less 1e-6", "barely carried"),
    ("rigid, less 1e-6", "barely upright"),
    ("rigid, less 1e-6", "overturns by a hair"),
    ("rigid, plus 1e-6", "rigid"),
    ("rigid, plus 1e-6", "100,000 impacts"),
    ("rigid, plus 1e-6", "all or nothing 0"),
    ("rigid, plus 1e-6", "all or nothing 1"),
    ("rigid, plus 1e-6", "barely carried"),
    ("rigid, plus 1e-6", "barely upright"),
    ("rigid, plus 1e-6", "overturns by a hair"),
    ("springs, less 1e-6", "barely carried"),
    ("springs, less 1e-6", "barely upright"),
    ("springs, plus 1e-6", "barely carried"),
    ("springs, plus 1e-6", "barely upright"),
    ("springs, plus 1e-6", "overturns by a hair"),
}
CHAOTIC = {("10 minutes of shaking", "100,000 impacts"), ("10 minutes of shaking", "all or nothing 1")}
"""They fall with every step, at another time with each."""


@pytest.mark.slow
@pytest.mark.parametrize("minutes", [0, pytest.param(10, marks=pytest.mark.thorough)])
def test_every_run_of_the_study_ends_with_the_status_that_is_right(minutes):
    """All 72 runs of configs/hard_cases.toml; those of ten minutes are thorough. Why: docs/pages/verification.md and below."""
    study = load_study(CONFIGS / "hard_cases.toml")
    chosen = [each for each in study.motions.pulses if (each.duration_s > 100) == (minutes > 0)]
    table = rb.run(replace(study, motions=replace(study.motions, pulses=chosen)), jobs=2)
    assert len(table) == 8 * len(chosen)
    for _, row in table.iterrows():
        split = f" {row['epsilon']:g}" if row["case"] == "all or nothing" else ""
        run = (row["record"], row["case"] + split)
        expected = "failed" if run in CHAOTIC else ("overturned" if run in OVERTURNED else "ok")
        assert row["status"] == expected, run
        assert (row["failure"] == "not settled") == (run in CHAOTIC), run
        assert 0 <= row["theta_max_over_alpha"] < math.pi / FIG5.alpha, run
    if minutes:
        tick = table[(table.record == "a tick, then 10 minutes") & (table.case == "100,000 impacts")]
        assert int(tick.impacts.iloc[0]) > 100_000


@pytest.mark.slow
def test_slenderness_from_mast_to_slab_ends_with_a_status_and_a_peak_that_falls():
    """configs/hard_cases_slenderness.toml: the stockier the pier, the smaller θ_max/α.

    0.05 g stays below g tan α for all but the mast, so on the rigid base the others rest, exactly. The slab's Housner
    restitution is negative, which means that it stops at its first impact; what has been lifted lands, and what has flown.
    """
    table = rb.run(CONFIGS / "hard_cases_slenderness.toml", jobs=2)
    assert set(table.status) == {"ok", "overturned", "flight"}
    assert np.isfinite(table.theta_max_over_alpha).all()
    strong = table[table.record == "6 g"]
    mast = strong[strong.alpha == 0.02]  # falls, or is thrown into the air beyond alpha while the ground still moves
    assert set(mast.status) == {"overturned", "flight"}
    assert (mast.theta_max_over_alpha > 1.0).all()
    assert set(strong[strong.alpha > 0.02].status) == {"ok", "flight"}
    for _, group in strong[strong.case != "yielding"].groupby(["case", "kinematics"], dropna=False):
        assert group.sort_values("alpha").theta_max_over_alpha.is_monotonic_decreasing
    weak = table[(table.record == "0.05 g") & (table.case == "rigid")]
    assert (weak.theta_max_over_alpha == 0.0).tolist() == [False] + 5 * [True]
    slab = strong[(strong.alpha == 1.2) & (strong.case == "rigid")].iloc[0]
    assert (slab.status, slab.impacts) == ("ok", slab.separations + slab.flights)


def until_the_end(pier, base, motion):
    """The run until the end of the record, with the steps that a tolerance of 1e-6 α takes."""
    settled = run_to_tolerance(pier, base, motion, 1e-6, 0.0)
    return run_fixed(pier, base, motion, settled.substeps, 0.0, wait=False)


@pytest.mark.sweep(slow=3)
@pytest.mark.slow
@pytest.mark.parametrize("alpha", [0.02, 0.05, 0.4, 0.8, 1.2])
def test_slenderness_from_mast_to_slab_follows_the_reference(alpha):
    """One-sine of 2 tan α g and 0.2 s, 1.5 s long; the peak within twice the tolerance of 1e-6 α, and all counts."""
    pier = Pier(alpha, 1.0)
    base = YieldingBase(max(1.1 * pier.least_beta, 40.0), 0.1, "finite", "guided", eta=3.0)
    motion = pulse("sine", 0.2, 2.0 * math.tan(alpha), dt=0.01, end=1.5)
    found, expected = until_the_end(pier, base, motion), reference(pier, base, motion)
    assert (found.status, expected.status) == ("ok", "ok")
    assert found.theta_max == pytest.approx(expected.theta_max, abs=2e-6 * alpha)
    assert (found.impacts, found.separations) == (expected.impacts, expected.separations)


# Restitution, jumps


def jumps() -> Motion:
    """+2 g, −2 g, +2 g from one sample to the next, then nothing."""
    samples = np.zeros(41)
    samples[:3] = 2.0 * GRAVITY, -2.0 * GRAVITY, 2.0 * GRAVITY
    return Motion("jumps", 0.05, samples)


@pytest.mark.slow
@pytest.mark.parametrize("epsilon", [0.0, 1.0])
@pytest.mark.parametrize("motion", [pulse("cosine", 1.0, dt=0.01, end=2.0), jumps()], ids=["full", "jumps"])
def test_impacts_that_lose_all_or_nothing_follow_the_reference(motion, epsilon):
    """A start at full amplitude is a kick, a jump within dt a steep line: both are linear between samples.

    No step straddles a sample, so the peak meets twice the tolerance of 1e-6 α as under any other motion.
    """
    base = ElasticBase(50.0, epsilon, "finite", "guided")
    found, expected = until_the_end(FIG5, base, motion), reference(FIG5, base, motion)
    assert found.status == expected.status == "ok"
    assert found.impacts == expected.impacts > 0
    assert found.theta_max == pytest.approx(expected.theta_max, abs=2e-6 * FIG5.alpha)


# Strength and stiffness at their limits


@pytest.mark.parametrize(("share", "status"), [(0.45, "ok"), (1.5, "overturned")])
def test_springs_that_barely_carry_the_weight_bear_no_more_than_their_capacity(share, status):
    """η = 1.001: the spring forces cannot oppose more than the moment b (η − 1) g, that is a push of (η − 1) g tan α.

    A push that comes at once counts twice: 0.45 of the capacity leaves the springs elastic; 1.5 topples the pier with
    both pivots on the ground, though a rigid block would need 667 times as much to lift. Springs of η = 3 do not even yield.
    """
    push = steady(share * 0.001 * GRAVITY * math.tan(FIG5.alpha), 0.0, 0.02, 1001)
    found = run_to_tolerance(FIG5, YieldingBase(50.0, 0.1, eta=1.001, spring="epp"), push, 1e-6, 0.0)
    strong = run_to_tolerance(FIG5, YieldingBase(50.0, 0.1, eta=3.0, spring="epp"), push, 1e-6, 0.0)
    assert (found.status, found.separations) == (status, 0)
    assert strong.status == "ok"
    if status == "ok":
        assert found.theta_max == pytest.approx(strong.theta_max, abs=1e-6 * FIG5.alpha)


def ground_displacement(motion: Motion) -> np.ndarray:
    """Displacement [m] at each sample, exact for acceleration that is linear in between."""
    a, dt = motion.horizontal, motion.dt
    velocity = np.concatenate([[0.0], np.cumsum(0.5 * dt * (a[1:] + a[:-1]))])
    return np.concatenate([[0.0], np.cumsum(dt * velocity[:-1] + dt * dt * (2.0 * a[:-1] + a[1:]) / 6.0)])


def test_a_pier_that_is_barely_upright_stays_where_the_ground_has_left_it():
    """β = least_beta (1 + 10⁻⁹): neutral equilibrium, so (I0/M + h²) θ = −h u_g, with no tendency either way.

    A millionth of the peak: the stiffness left, 10⁻⁹ of a spring's, acts for 4 s. Just below it is refused.
    """
    motion = pulse("sine", 0.5, 1.0, dt=0.005, end=4.0)
    base = ElasticBase(FIG5.least_beta * (1 + 1e-9))
    response = rb.simulate(FIG5, base, motion, substeps=8, quiet_s=0.0, wait=False)
    expected = -FIG5.height * ground_displacement(motion) / INERTIA
    assert response.events.empty
    np.testing.assert_allclose(response.theta, expected, rtol=0, atol=1e-6 * np.abs(expected).max())
    assert problems(FIG5, ElasticBase(FIG5.least_beta * (1 - 1e-9)))


def test_steps_become_short_enough_for_the_stiffest_springs_by_themselves():
    """β = 5000, dt = 0.05 s: ω_v dt = 250, where Runge–Kutta 4 is stable to 2√2. Full contact: θ_max = 2 h a/(I ω_r²).

    The tolerance, 10⁻¹⁰ α, is 10⁻⁴ of this tiny peak. One step per sample ends as "failed", never as an answer.
    """
    base = ElasticBase(5000.0)
    stiffness = (5000.0 * FIG5.half_width) ** 2 - GRAVITY * FIG5.height
    lifting = stiffness * (1 + FIG5.mu) / (FIG5.mu * 5000.0**2 * math.sin(FIG5.alpha)) / (2.0 * FIG5.height)
    push = steady(0.9 * lifting, 0.0, 0.05, 21)
    found = run_to_tolerance(FIG5, base, push, 1e-10, 0.0)
    assert (found.status, found.separations) == ("ok", 0)
    assert found.substeps > 250 / (2 * math.sqrt(2))
    assert found.theta_max == pytest.approx(2.0 * FIG5.height * 0.9 * lifting / stiffness, rel=1e-4)
    assert run_fixed(FIG5, base, push, 1, 0.0, wait=False).status == "failed"


@pytest.mark.slow
def test_the_stiffest_springs_are_close_to_the_rigid_base():
    """β = 5000 under Fig. 5's pulse: within 1 % of Housner's block, whose impacts lose a little more."""
    motion = pulse("sine", 0.5, dt=0.005, end=3.0)
    stiff = run_to_tolerance(FIG5, YieldingBase(5000.0, 0.1, "finite", eta=3.0), motion, 1e-4, 0.0)
    rigid = run_to_tolerance(FIG5, RigidBase(), motion, 1e-4, 0.0)
    assert (stiff.status, stiff.substeps >= 125) == ("ok", True)
    assert stiff.theta_max == pytest.approx(rigid.theta_max, rel=0.01)


# Flight


def dropping_ground(g_down: float, until: float, end: float) -> Motion:
    """Ground that accelerates downwards at ``g_down`` g up to the sample before ``until`` [s], no longer at it."""
    t = np.arange(round(end / 0.01) + 1) * 0.01
    return Motion("drop", 0.01, np.zeros(len(t)), np.where(t < until - 1e-9, -g_down * GRAVITY, 0.0))


@pytest.mark.parametrize("kinematics", ["first-order", "finite"])
def test_a_flight_of_five_seconds_is_ballistic_and_ends_on_both_pivots(kinematics):
    """v̈_g = −2 g for 1.5 s. Elastic springs let go at cos ω_v t = ½, with √3 g/ω_v; then polynomials: 22 m, 5.12 s.

    By symmetry the pier stays upright, and both pivots separate and land together. RK4 at ω_v h = 0.016: the separation
    to 1e-9 s; the polynomials it integrates exactly.
    """
    omega_v, g = 50.0, GRAVITY
    motion = dropping_ground(2.0, 1.5, 6.0)
    separation, speed = math.pi / (3 * omega_v), math.sqrt(3) * g / omega_v
    rising = 1.49 - separation
    height, speed = speed * rising + 0.5 * g * rising**2, speed + g * rising
    height += speed * 0.01 + g * 0.01**2 * (0.5 - 1.0 / 3.0)  # v̈ falls from g to −g within one sample
    top = height + speed**2 / (2 * g)
    landing = 1.5 + (speed + math.sqrt(2 * g * top)) / g
    response = rb.simulate(
        FIG5, ElasticBase(omega_v, 0.0, kinematics, "guided"), motion, substeps=32, quiet_s=0.0, wait=False
    )
    times = {(event["kind"], event["pivot"]): event["t"] for _, event in response.events.iterrows()}
    left, right, landed = (times[key] for key in (("separation", "left"), ("separation", "right"), ("impact", "both")))
    assert landing - separation > 5.0
    assert left == right == pytest.approx(separation, abs=1e-9)
    assert landed == pytest.approx(landing, abs=1e-7)
    assert np.abs(response.theta).max() < 1e-25
    assert response.v.max() == pytest.approx(top, abs=g * 0.005**2)  # the sample nearest the top


def test_where_flight_ends_the_run_it_says_when():
    """Without guidance at the separation, cos ω_v t = ½; on a rigid base when v̈_g reaches −g, since it cannot pull."""
    stopped = run_to_tolerance(FIG5, ElasticBase(50.0, flight="stop"), dropping_ground(2.0, 1.5, 6.0), 1e-4)
    assert stopped.status == "flight"
    assert stopped.t_flight == pytest.approx(math.pi / 150.0, abs=1e-7)
    slope = Motion("slope", 0.1, np.zeros(31), -GRAVITY * np.linspace(0.0, 1.5, 31))
    rigid = run_to_tolerance(FIG5, RigidBase(flight="stop"), slope, 1e-4)
    assert (rigid.status, rigid.theta_max) == ("flight", 0.0)
    assert rigid.t_end == rigid.t_flight == pytest.approx(2.0, abs=1e-12)


@pytest.mark.parametrize("steps", [160.0, 160.5], ids=["on-a-sample", "within-a-step"])
@pytest.mark.parametrize(("excess", "status"), [(-1e-6, "ok"), (1e-6, "flight")])
def test_flight_by_a_hair_is_distinguished_from_none(excess, status, steps):
    """Elastic springs under a constant v̈_g = −c g from rest just unload at c = ½: v = −(g/ω_v²)(1 − c (1 − cos ω_v t)).

    The minimum of −z sits on a sample, or in the middle of a step, of which the flight lasts a third. RK4 at
    ω_v h = 0.02 errs by 1e-9 of the amplitude.
    """
    motion = steady(0.0, -(0.5 + excess) * GRAVITY, 4.0 * math.pi / 50.0 / steps, 121)
    assert run_fixed(FIG5, ElasticBase(50.0, flight="stop"), motion, 4, 0.0, wait=False).status == status
    guided = run_fixed(FIG5, ElasticBase(50.0, 0.5, flight="guided"), motion, 4, 0.0, wait=False)
    assert (guided.status, guided.theta_max < 1e-25) == ("ok", True)


# Impacts without number, and without velocity


@pytest.mark.slow
def test_a_hundred_thousand_impacts_of_an_endless_bounce_keep_their_time():
    """ε = 1 on elastic springs of β = 5000 under a steady −0.6 g: nothing is lost, each bounce takes the same 1.37 ms.

    With 0.4 g left, flight lasts 2 v̇/(0.4 g), v̇ = √0.2 g/ω_v; contact turns by 2 (π − arccos ⅔). RK4 at ω_v h = 0.025
    loses (ω_v h)⁵/144 of the energy per radian, 2·10⁻⁵ in all: the count is exact but for one landing of both.
    """
    omega_v, duration = 5000.0, 70.0
    speed = math.sqrt(0.2) * GRAVITY / omega_v
    contact = 2.0 * (math.pi - math.acos(2.0 / 3.0)) / omega_v
    bounce = 2.0 * speed / (0.4 * GRAVITY) + contact
    first = (math.pi - math.acos(2.0 / 3.0)) / omega_v
    motion = steady(0.0, -0.6 * GRAVITY, 0.001, round(duration / 0.001) + 1)
    run = run_fixed(FIG5, ElasticBase(omega_v, 1.0, flight="guided"), motion, 200, 0.0, wait=False)
    landings = 1 + (duration - first - 2.0 * speed / (0.4 * GRAVITY)) / bounce
    assert run.impacts > 100_000
    assert run.impacts == pytest.approx(2 * landings, abs=2)
    assert run.theta_max < 1e-20
    assert 0 <= run.separations - run.impacts <= 2


def test_a_hundred_thousand_impacts_on_a_rigid_base_end_when_their_series_does():
    """e = 0.99995: bounces of 2 θ̇/(p² sin α), each e times as long as the last: rest after 2 θ̇0/(p² sin α (1 − e)).

    A millionth: rotations of 10⁻⁸ rad bend the restoring moment by that much over tan α.
    """
    restitution, omega = 0.99995, 1e-4
    expected = 2.0 * omega / (FIG5.p**2 * math.sin(FIG5.alpha) * (1.0 - restitution))
    run, _ = run_block(
        block(FIG5, RigidBase(restitution, confirm=("restitution",))), 0.0, omega, np.zeros((3001, 4)), 0.01, 2
    )
    assert run.impacts > 100_000
    assert run.t_rest == pytest.approx(expected, rel=1e-6)


def test_a_block_that_lands_without_velocity_rests_there():
    """Time reversal: a push, a pull and the same push again, the pull such that θ̇ = 0 in the middle.

    The second half is then the first one backwards, and the block, lifted from rest, is put down without velocity when
    the push falls to g tan α: at the mirror of its lift-off. It comes down like the cube of the time left, so a pull
    that is off by δ moves the touch-down by some δ^(1/3): 1e-4 s for rounding, 5 δ^(1/3) for a nudge.
    """
    dt, middle = 0.005, 80

    def motion(pull: float) -> Motion:
        s = np.arange(2 * middle + 1) / middle - 1.0  # −1..1
        shape = np.where(np.abs(s) > 0.5, np.sin(2 * math.pi * (np.abs(s) - 0.5)), -pull * np.cos(math.pi * s))
        return Motion("mirror", dt, 0.5 * (shape + shape[::-1]) * GRAVITY)

    def speed_in_the_middle(pull: float) -> float:
        half = Motion("half", dt, motion(pull).horizontal[: middle + 1])
        run, rows = written_run(Run(FIG5, RigidBase(), half), 8, 0.0, 5000, wait=False)
        return float(rows[run.rows - 1].omega)

    pull = brentq(speed_in_the_middle, 0.1, 1.5, xtol=1e-15, rtol=1e-15)
    lift_off = rb.simulate(FIG5, RigidBase(), motion(pull), substeps=8, quiet_s=0.0, wait=False).events.t.iloc[0]
    for nudge in (-1e-9, -1e-12, 0.0, 1e-12, 1e-9):
        run, _ = written_run(Run(FIG5, RigidBase(), motion(pull * (1 + nudge))), 8, 1.0, 0)
        assert (run.impacts >= 1, run.uplifts) == (True, 1)
        assert run.t_rest == pytest.approx(2 * middle * dt - lift_off, abs=1e-4 + 5.0 * abs(nudge) ** (1 / 3))
        assert run.theta_max > 1e-3 * FIG5.alpha


@pytest.mark.parametrize("epsilon", [0.0, 0.5, 1.0])
def test_a_pivot_that_is_lifted_by_a_hair_lands_without_changing_anything(epsilon):
    """A steady push tilts the pier by 2 h a/(I ω_r²); at (1+μ)/(μ β² sin α) it lifts a pivot, without velocity.

    10⁻⁶ below that push nothing separates. 10⁻⁶ above it a pivot is lifted and lands at every cycle with next to no
    velocity, whatever ε: the peak is the closed form's to 10⁻⁶ and RK4's 10⁻⁸.
    """
    lifting = 0.5 * SEPARATION * INERTIA * ROCKING**2 / FIG5.height
    dt = math.pi / ROCKING / 40
    base = ElasticBase(50.0, epsilon)
    below = run_fixed(FIG5, base, steady((1 - 1e-6) * lifting, 0.0, dt, 161), 8, 0.0, wait=False)
    above = run_fixed(FIG5, base, steady((1 + 1e-6) * lifting, 0.0, dt, 161), 8, 0.0, wait=False)
    assert (below.status, below.separations) == ("ok", 0)
    assert above.status == "ok"
    assert above.separations == above.impacts > 0
    assert above.theta_max == pytest.approx(SEPARATION, rel=3e-6)


@pytest.mark.parametrize("nudge", [-1e-9, -2e-16, 0.0, 2e-16, 1e-9])
def test_a_peak_on_a_sample_is_like_any_other(nudge):
    """Under a steady push too weak to lift a pivot the peak, 2 h a/(I ω_r²), comes at π/ω_r: here on the 40th sample.

    Peak and time as in the closed form, to RK4's error at ω_v h = 0.06, 1e-7 of both.
    """
    a = 0.01
    dt = math.pi / ROCKING / 40 * (1.0 + nudge)
    found = run_fixed(FIG5, ElasticBase(50.0), steady(a, 0.0, dt, 61), 16, 0.0, wait=False)
    assert found.theta_max == pytest.approx(2.0 * FIG5.height * a / (INERTIA * ROCKING**2), rel=1e-7)
    assert found.t_max == pytest.approx(math.pi / ROCKING, rel=1e-7)


# Records


def test_a_pulse_after_ten_minutes_of_silence_does_what_it_does_at_once():
    """The pier at rest does not drift: 59,000 zeros change θ_max by less than 1e-9 α, and its time by 590 s."""
    base = YieldingBase(50.0, 0.1, eta=3.0)
    early = pulse("sine", 0.5, 1.0, dt=0.01, end=10.0)
    late = replace(early, horizontal=np.concatenate([np.zeros(59_000), early.horizontal]))
    now, then = (run_to_tolerance(FIG5, base, motion, 1e-4) for motion in (early, late))
    assert (now.status, then.status) == ("ok", "ok")
    assert then.theta_max == pytest.approx(now.theta_max, abs=1e-9 * FIG5.alpha)
    assert then.t_max - 590.0 == pytest.approx(now.t_max, abs=1e-6)


@pytest.mark.parametrize(
    "base",
    [
        RigidBase(),
        ElasticBase(FIG5.least_beta * (1 + 1e-6)),
        YieldingBase(5000.0, 0.0, "finite", eta=1.001),
        YieldingBase(50.0, 1.0, eta=1.000001, spring="epp"),
    ],
    ids=["rigid", "barely-upright", "stiff", "barely-carried"],
)
def test_zeros_move_nothing(base):
    """By symmetry θ stays 0, exactly, and nothing separates, even where the least push would topple the pier."""
    found = run_to_tolerance(FIG5, base, Motion("zeros", 0.01, np.zeros(501), np.zeros(501)), 1e-4)
    assert (found.status, found.theta_max, found.separations, found.impacts) == ("ok", 0.0, 0, 0)


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
@pytest.mark.parametrize("component", ["horizontal", "vertical"])
def test_a_motion_with_a_sample_that_is_no_number_is_refused_with_its_place(component, bad):
    """It cannot even be made: NaN compares false, and "not lifted", "not fallen" would look like an answer."""
    samples = {"horizontal": np.zeros(100), "vertical": np.zeros(100)}
    samples[component][37] = bad
    with pytest.raises(InputError, match=rf"{component} sample 37 \(t = 0\.37 s\)"):
        Motion("spoilt", 0.01, samples["horizontal"], samples["vertical"])


@pytest.mark.parametrize("base", [RigidBase(), ElasticBase(50.0, flight="guided"), YieldingBase(50.0, eta=3.0)])
@pytest.mark.parametrize("spike", [1e200, 1e308])
def test_a_spike_beyond_all_reason_fails_and_does_not_overturn(base, spike):
    """No pier turns by 90° within a step: a rotation of 10¹⁹³ is a broken record, not an overturning."""
    samples = pulse("sine", 0.5, dt=0.01, end=2.0).horizontal.copy()
    samples[10] = spike
    found = run_to_tolerance(FIG5, base, Motion("spike", 0.01, samples), 1e-4)
    assert found.status == "failed"
    assert found.reason
    assert math.isfinite(found.theta_max)


# Overturning by a hair


def half_sine(amplitude_g: float) -> Motion:
    return rb.pulse("half-sine", name="half-sine", amplitude=amplitude_g * GRAVITY, period=1.0, dt=0.01, duration=1.0)


def critical_amplitude(base, low: float, high: float) -> tuple[float, float]:
    """Amplitudes [g] within 1e-9 of each other, of which the lower leaves the pier standing and the higher does not."""
    while high / low - 1.0 > 1e-9:
        middle = 0.5 * (low + high)
        found = run_to_tolerance(FIG5, base, half_sine(middle), 1e-4)
        assert found.status in ("ok", "overturned")
        low, high = (low, middle) if found.status == "overturned" else (middle, high)
    return low, high


def test_a_rigid_block_overturns_where_its_energy_reaches_the_summit():
    """After the pulse ½ θ̇² = p² (1 − cos(α − |θ|)): the amplitude at which the reference meets that, to 1e-8.

    The bracket of 1e-9 is there, and the two pulses of configs/hard_cases.toml, 1e-6 either way, enclose it. Below it
    the block climbs to 0.9984 α and comes back; above it lingers there and falls.
    """

    def surplus(amplitude_g: float) -> float:
        end = reference(FIG5, RigidBase(), half_sine(amplitude_g))
        return 0.5 * end.omega**2 - FIG5.p**2 * (1.0 - math.cos(FIG5.alpha - abs(end.theta)))

    exact = brentq(surplus, 0.7, 0.9, xtol=1e-12)
    low, high = critical_amplitude(RigidBase(), 0.7, 0.9)
    assert (low, high) == pytest.approx((exact, exact), rel=1e-8)
    assert 0.798731361 < exact < 0.798732958
    standing = run_to_tolerance(FIG5, RigidBase(), half_sine(0.798731361), 1e-4)
    fallen = run_to_tolerance(FIG5, RigidBase(), half_sine(0.798732958), 1e-4)
    assert (standing.status, fallen.status) == ("ok", "overturned")
    assert standing.theta_max / FIG5.alpha == pytest.approx(0.9984, abs=1e-4)


@pytest.mark.slow
def test_a_pier_on_springs_overturns_on_the_side_of_the_reference():
    """Bracket of 1e-9, then 1e-6 either way (the pulses of configs/hard_cases.toml): standing at 0.9985 α, and fallen.

    Near the summit a difference grows by e^(t p), so the standing peak is right to the error control's 1e-4.
    """
    base = YieldingBase(50.0, 0.1, "finite", "guided", eta=3.0)
    low, high = critical_amplitude(base, 0.724, 0.725)
    assert 0.724374138 < low < high < 0.724375586
    for amplitude, status in ((0.724374138, "ok"), (0.724375586, "overturned")):
        found = run_to_tolerance(FIG5, base, half_sine(amplitude), 1e-4, 18.0)
        expected = reference(FIG5, base, half_sine(amplitude), 18.0)
        assert found.status == expected.status == status
        if status == "ok":
            assert found.theta_max == pytest.approx(expected.theta_max, abs=1e-4 * FIG5.alpha)
