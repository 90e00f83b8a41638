"""The core against formulas: free rocking, small vibrations, first separation, impact, statics, and the rigid limit."""

import math
from functools import partial

import numpy as np
import pytest
from core_runs import run_block
from core_samples import FIG5, TOWER, broadband, pulse, steady
from scipy.integrate import quad
from scipy.special import hyp2f1

import rockbatch as rb
from rockbatch.core.powers import power
from rockbatch.core.springs.equations import geometry
from rockbatch.core.springs.impact import land
from rockbatch.core.springs.laws import CODES
from rockbatch.core.springs.model import Contact, State
from rockbatch.core.system import rates
from rockbatch.core.types import BEFORE_EVENT, LEFT, Ground
from rockbatch.motions.motion import Motion
from rockbatch.pier import ElasticBase, Pier, RigidBase, YieldingBase, rocking_frequency
from rockbatch.pier.first_loading import bouc_wen
from rockbatch.simulation import Run, block, run_fixed, springs, written_run

SINE = pulse("sine", 0.5, dt=0.01, end=3.0)


# Rigid base


@pytest.mark.parametrize(("pier", "quarter"), [(FIG5, 1.31850439758), (TOWER, 1.317610874991)])
def test_quarter_period_of_free_rocking_is_housners_integral(pier, quarter):
    """p T/4 from θ0 = α/2: ∫ dθ/√(2(cos(α−θ) − cos(α−θ0))), with θ = θ0 (1 − s²) to remove its singularity."""
    theta0 = 0.5 * pier.alpha

    def integrand(s: float) -> float:
        theta = theta0 * (1.0 - s * s)
        gain = 2.0 * math.sin(pier.alpha - 0.5 * (theta + theta0)) * math.sin(0.5 * (theta0 - theta))
        return 2.0 * theta0 * s / math.sqrt(2.0 * gain)

    exact = quad(integrand, 0.0, 1.0, epsabs=1e-13, epsrel=1e-13)[0]
    assert exact == pytest.approx(quarter, rel=1e-11)
    still = np.zeros((round(200.0 * quarter / pier.p) + 1, 4))
    _, rows = run_block(block(pier, RigidBase()), theta0, 0.0, still, 0.01, 8, 400_000)
    first_impact = rows.t[rows.kind == BEFORE_EVENT][0]
    assert pier.p * first_impact == pytest.approx(quarter, rel=1e-9)  # RK4 at p h = 1e-3


def test_greatest_rotation_is_found_between_samples():
    """After one impact the peak lies inside a step; energy gives it exactly. 1e-9 α: Hermite at p h = 1e-3."""
    e = 0.9
    speed = 0.3 * FIG5.alpha * FIG5.p
    run, _ = run_block(block(FIG5, RigidBase(e)), 0.0, speed, np.zeros((101, 4)), 0.01, 8)
    exact = FIG5.alpha - math.acos(math.cos(FIG5.alpha) + 0.5 * (speed / FIG5.p) ** 2)
    assert run.theta_max == pytest.approx(exact, abs=1e-9 * FIG5.alpha)


def test_ground_just_short_of_g_tan_alpha_lifts_nothing_and_just_beyond_does():
    """West's criterion |ü_g| > (g + v̈_g) tan α, either way and with the vertical component."""
    for vertical in (0.0, 2.0, -2.0):
        limit = (FIG5.gravity + vertical) * math.tan(FIG5.alpha)
        for sign in (1.0, -1.0):
            below = run_fixed(
                FIG5, RigidBase(), steady(sign * limit * (1 - 1e-9), vertical, 0.01, 50), 1, 0.0, wait=False
            )
            above = run_fixed(
                FIG5, RigidBase(), steady(sign * limit * (1 + 1e-6), vertical, 0.01, 50), 1, 0.0, wait=False
            )
            assert (below.separations, below.theta_max) == (0, 0.0)
            assert above.separations == 1
            assert above.theta_max > 0.0


# Two springs in full contact: two linear oscillators


def full_contact_frequency(pier: Pier, beta: float) -> float:
    """ω_r [rad/s], ω_r² = [μ sin²α ω_v² − (1+μ) p² cos α]/(1 + μ cos²α)."""
    s, c = math.sin(pier.alpha), math.cos(pier.alpha)
    omega_v = beta * pier.p
    squared = (pier.mu * s * s * omega_v**2 - (1 + pier.mu) * pier.p**2 * c) / (1 + pier.mu * c * c)
    return math.sqrt(squared)


def test_full_contact_rocking_frequency_is_the_closed_form():
    """Constant ü_g = a from rest: θ = −(h a/(I ω_r²)) (1 − cos ω_r t). RK4 at ω_v h = 0.03: 1e-6 of the amplitude."""
    omega_r = full_contact_frequency(FIG5, 50.0)
    assert omega_r == pytest.approx(8.67484279, abs=1e-8)
    for pier in (FIG5, Pier(0.2, 0.02, confirm=("p",))):
        assert rocking_frequency(pier, ElasticBase(50.0)) == pytest.approx(
            full_contact_frequency(pier, 50.0), rel=1e-12
        )
    a = 0.01
    run = rb.simulate(FIG5, ElasticBase(50.0), steady(a, 0.0, 0.01, 201), substeps=16, quiet_s=0.0, wait=False)
    amplitude = FIG5.height * a / ((FIG5.inertia + FIG5.height**2) * omega_r**2)
    exact = -amplitude * (1.0 - np.cos(omega_r * run.t))
    assert run.events.empty
    np.testing.assert_allclose(run.theta, exact, rtol=0, atol=1e-6 * amplitude)


@pytest.mark.parametrize("kinematics", ["first-order", "finite"])
def test_full_contact_vertical_motion_oscillates_at_omega_v(kinematics):
    """Constant v̈_g = a: v = v0 − (a/ω_v²)(1 − cos ω_v t), θ = 0. RK4 at ω_v h = 0.03: 1e-5 of the amplitude."""
    a, omega_v = 0.5, 50.0
    base = ElasticBase(50.0, kinematics=kinematics)
    run = rb.simulate(FIG5, base, steady(0.0, a, 0.01, 101), substeps=16, quiet_s=0.0, wait=False)
    exact = -(FIG5.gravity + a) / omega_v**2 + a / omega_v**2 * np.cos(omega_v * run.t)
    np.testing.assert_allclose(run.v, exact, rtol=0, atol=1e-5 * a / omega_v**2)
    assert np.all(run.theta == 0.0)


def test_first_separation_is_where_the_paper_has_it():
    """θ = (1+μ)/(μ β² sin α) (THEORY.md, eq. 10) in first-order kinematics; 1e-10 rad: RK4's v stays static."""
    rows, kind = first_separation("first-order")
    s = FIG5.mu * 50.0**2 * math.sin(FIG5.alpha)
    assert kind == "left"  # θ < 0 lifts the right pivot, θ > 0 the left one
    assert abs(rows["theta"]) == pytest.approx((1 + FIG5.mu) / s, abs=1e-10)


def test_first_separation_in_finite_kinematics_is_where_the_spring_is_unstressed(uncompiled):
    """v + b sin θ + h (1 − cos θ) = 0 there; near the paper's arcsin form, from which v's motion, hθ²/2, parts it."""
    rows, _ = first_separation("finite", partial(uncompiled, rb.simulate))
    lifted = FIG5.half_width * math.sin(rows["theta"]) + FIG5.height * (1 - math.cos(rows["theta"]))
    assert rows["v"] + lifted == pytest.approx(0.0, abs=1e-10)
    paper = math.asin((1 + FIG5.mu) / (FIG5.mu * 50.0**2 * math.sin(FIG5.alpha)))
    assert rows["theta"] == pytest.approx(paper, rel=5e-3)


def first_separation(kinematics, simulate=rb.simulate):
    """Row of the history at the first separation under a steady push to the left, and the pivot that lifts."""
    motion = steady(-0.6 * FIG5.gravity * math.tan(FIG5.alpha), 0.0, 0.01, 31)
    run = simulate(FIG5, ElasticBase(50.0, 0.1, kinematics), motion, substeps=16, quiet_s=0.0, wait=False)
    event = run.events[run.events.kind == "separation"].iloc[0]
    return run.history[run.history.t == event.t].iloc[0], event["pivot"]


# Impact


@pytest.mark.parametrize("kinematics", ["first-order", "finite"])
@pytest.mark.parametrize("epsilon", [0.0, 0.1, 0.7, 1.0])
def test_impact_scales_the_landing_velocity_and_keeps_angular_momentum(kinematics, epsilon):
    """On every impact of a run: v̇_i times ε; ½(1−ε²) v̇_i²/(1+a²/I) lost; I θ̇ − a v̇ about the landing pivot kept."""
    base = YieldingBase(50.0, epsilon, kinematics, "guided", eta=3.0)
    vertical = broadband(np.random.default_rng(2), SINE.dt, SINE.npts, 20.0)
    motion = Motion("shaken", SINE.dt, SINE.horizontal, vertical)
    run, rows = written_run(Run(FIG5, base, motion), 4, 0.0, 5000)
    rows = rows[: run.rows]
    m = springs(FIG5, base)
    landings = np.flatnonzero(np.isin(rows.kind, (3, 4)))
    assert len(landings) >= 5
    for i in landings:
        at = geometry(m, rows[i].theta)
        arm = at.arm_left if rows[i].kind == 3 else at.arm_right
        inertia = m.inertia + at.lever**2
        (v_before, w_before), (v_after, w_after) = ((row.v_rate, row.omega) for row in rows[i - 1 : i + 1])
        landing = v_before + arm * w_before
        scale = abs(v_before) + abs(arm * w_before)
        assert landing < 0.0
        assert v_after + arm * w_after == pytest.approx(epsilon * landing, abs=1e-13 * scale)
        lost = 0.5 * (v_before**2 - v_after**2) + 0.5 * inertia * (w_before**2 - w_after**2)
        expected = 0.5 * (1 - epsilon**2) * landing**2 / (1 + arm**2 / inertia)
        assert lost == pytest.approx(expected, abs=1e-12 * (scale**2 + inertia * w_before**2))
        before, after = inertia * w_before - arm * v_before, inertia * w_after - arm * v_after
        assert after == pytest.approx(before, abs=1e-12 * (abs(inertia * w_before) + abs(arm * v_before)))


def test_landing_impulse_of_the_rigid_limit_is_housners_restitution():
    """Rotating about the right pivot, landing on the left with ε = 0: θ̇⁺/θ̇⁻ = 1 − 2μ/(1+μ) sin²α. Algebra: 1e-14."""
    m = springs(FIG5, ElasticBase(50.0, 0.0, "finite", "guided"))
    before = State(0.0, 0.0, m.half_width * -0.3, -0.3, 0.0, 0.0)  # v̇_R = v̇ − b θ̇ = 0
    after, _ = land(m, before, LEFT, Contact(0.0, 1.0, 0.0, 0.0, 0.0))
    assert before.v_rate - m.half_width * before.omega == 0.0
    assert after.omega / before.omega == pytest.approx(FIG5.restitution, rel=1e-14)


@pytest.mark.parametrize("theta", [0.03, 0.15, -0.03, -0.15])
def test_finite_kinematics_on_one_immovable_pivot_is_housners_equation(theta):
    """With z such that the pivot in contact does not accelerate, θ̈ = −p²[(1+v̈_g/g) sin(α sgn θ − θ) + ü_g/g cos(…)]."""
    m = springs(FIG5, YieldingBase(50.0, 0.0, "finite", "guided", eta=5.0))
    right = theta > 0.0
    contact = Contact(0.0, 1.0, 0.0, 0.0, 0.0) if right else Contact(1.0, 0.0, 0.0, 0.0, 0.0)
    at = geometry(m, theta)
    arm, bend = (at.arm_right, at.bend_right) if right else (at.arm_left, at.bend_left)
    omega, horizontal, vertical = 0.2, 2.0, -1.5

    def response(z: float) -> tuple[float, float]:
        y = State(0.0, theta, -arm * omega, omega, 0.0 if right else z, z if right else 0.0)
        k = rates(m, y, contact, Ground(horizontal, 0.0, vertical, 0.0))
        return k.v_rate + arm * k.omega + bend * omega**2, k.omega

    (free, _), (loaded, _) = response(0.0), response(-0.5)
    _, acceleration = response(0.5 * free / (loaded - free))  # the pivot's acceleration is linear in z
    angle = math.copysign(FIG5.alpha, theta) - theta
    housner = (1 + vertical / FIG5.gravity) * math.sin(angle) + horizontal / FIG5.gravity * math.cos(angle)
    assert acceleration == pytest.approx(-(FIG5.p**2) * housner, rel=1e-11)


# Statics and dissipation


@pytest.mark.parametrize("n", [1.0, 2.0, 2.5, 5.0, 20.0, 50.0])
@pytest.mark.parametrize("eta", [1.01, 1.5, 2.2, 5.0, 10.0])
def test_static_deflection_is_the_integral_of_the_law(n, eta):
    """∫ ds/(1 − sⁿ) from 0 to x = 1/η, which is x ₂F₁(1, 1/n; 1+1/n; xⁿ)."""
    x = 1.0 / eta
    found = bouc_wen(n).deflection(x)
    assert found == pytest.approx(quad(lambda s: 1.0 / (1.0 - s**n), 0.0, x, epsrel=1e-12)[0], rel=1e-11)
    assert found == pytest.approx(x * hyp2f1(1.0, 1.0 / n, 1.0 + 1.0 / n, x**n), rel=1e-11)


@pytest.mark.parametrize(
    ("spring", "n"),
    [("bouc-wen", 5.0), ("epp", 5.0), ("hardening", 5.0), pytest.param("bouc-wen", 1.0, marks=pytest.mark.thorough)],
)
def test_dissipated_energy_is_the_area_of_the_hysteresis_loops(spring, n):
    """∮ F dv by the trapezoidal rule, less what the spring stores elastically; 1e-4: the rule's error at these rows."""
    motion = pulse("sine", 0.5, dt=0.0005, end=2.0)
    base = YieldingBase(50.0, 0.1, eta=2.2, spring=spring, n=n)
    run = rb.simulate(FIG5, base, motion, substeps=1, quiet_s=0.0, wait=False)
    outcome = run_fixed(FIG5, base, motion, 1, 0.0, wait=False)
    m = springs(FIG5, base)
    for side in ("left", "right"):
        z, position = run.history[f"z_{side}"].to_numpy(), run.history[f"v_{side}"].to_numpy()
        work = m.yield_force * np.sum(0.5 * (z[1:] + z[:-1]) * np.diff(position))
        stored = 0.5 * m.yield_force * m.yield_deflection * (z[-1] ** 2 - z[0] ** 2)
        assert getattr(outcome, f"dissipated_{side}") == pytest.approx(work - stored, rel=1e-4)
        assert work - stored > 0.01


def test_energy_is_conserved_by_elastic_springs_without_impacts_or_shaking():
    """After a pulse too weak to lift a pivot: stored energy plus the work of the P–Δ arms, −½ g h θ² while v is static.

    First-order kinematics keep those arms without a potential; with the springs' total force at −g the work is exact.
    """
    motion = pulse("sine", 0.5, 0.02, dt=0.01, end=0.5)
    run = rb.simulate(FIG5, ElasticBase(50.0, 0.1), motion, substeps=16, quiet_s=3.0)
    free = run.t > 0.52
    total = run.energy - 0.5 * FIG5.gravity * FIG5.height * run.theta**2
    assert run.events.empty
    assert np.ptp(total[free]) < 1e-5 * total[free].mean()


# Limits


@pytest.mark.slow
def test_stiff_strong_springs_without_restitution_converge_to_the_rigid_base():
    """One-sine 0.5 g × 1 s at dt = 0.01 s: 0.40168 α at β = 3200 against 0.401675 α; the gap falls with β."""
    motion = pulse("sine", 1.0, 0.5, dt=0.01, end=3.0)
    rigid = run_fixed(FIG5, RigidBase(), motion, 8, 0.0, wait=False).theta_max / FIG5.alpha
    gaps = []
    for beta in (200.0, 800.0, 3200.0):
        base = YieldingBase(beta, 0.0, "finite", "guided", eta=1000.0)
        substeps = math.ceil(beta * motion.dt / 0.1)
        gaps.append(abs(run_fixed(FIG5, base, motion, substeps, 0.0, wait=False).theta_max / FIG5.alpha - rigid))
    assert rigid == pytest.approx(0.401675, abs=1e-6)
    assert gaps[2] < 1e-5
    assert gaps[0] > 3.0 * gaps[1] > 9.0 * gaps[2]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("amplitude_g", "status"), [(0.9, "ok"), (1.2, "overturned"), (2.0, "ok"), (2.5, "overturned")]
)
def test_stiff_strong_springs_end_as_the_rigid_base_does(amplitude_g, status):
    """One-sine 1 s: survival and both modes of overturning, and the safe amplitudes between them, at β = 1600, where
    peaks are still 0.002 α from those of the limit."""
    motion = pulse("sine", 1.0, amplitude_g, dt=0.01, end=6.0)
    base = YieldingBase(1600.0, 0.0, "finite", "guided", eta=1000.0)
    rigid = run_fixed(FIG5, RigidBase(), motion, 8)
    springs_too = run_fixed(FIG5, base, motion, math.ceil(1600.0 * motion.dt / 0.1))
    assert rigid.status == springs_too.status == status
    if status == "overturned":
        assert springs_too.t_end == pytest.approx(rigid.t_end, abs=0.05)
    else:
        assert springs_too.t_max == pytest.approx(rigid.t_max, abs=0.01)
        assert springs_too.theta_max == pytest.approx(rigid.theta_max, abs=0.002 * FIG5.alpha)


@pytest.mark.slow
def test_a_large_exponent_approaches_the_elastic_plastic_spring(uncompiled):
    """The Bouc–Wen law's corner has width 1/n: at n = 400 the peak is within 1 % and nearer than at n = 50."""

    def peak(**law):
        return uncompiled(run_fixed, FIG5, YieldingBase(50.0, 0.1, eta=3.0, **law), SINE, 2, 0.0, wait=False).theta_max

    gaps = [abs(peak(n=n) / peak(spring="epp") - 1.0) for n in (5.0, 50.0, 400.0)]
    assert gaps == sorted(gaps, reverse=True)
    assert gaps[-1] < 0.01


def test_springs_that_never_yield_are_elastic():
    """η = 10⁴, n = 5: plasticity of order (1/η)⁵, so the elastic result to rounding, events and all."""
    assert springs(FIG5, YieldingBase(50.0, eta=3.0)).law == CODES["bouc-wen"]
    strong = run_fixed(FIG5, YieldingBase(50.0, 0.4, eta=1e4, confirm=("eta",)), SINE, 8, 0.0, wait=False)
    elastic = run_fixed(FIG5, ElasticBase(50.0, 0.4), SINE, 8, 0.0, wait=False)
    assert strong.theta_max == pytest.approx(elastic.theta_max, abs=1e-8 * FIG5.alpha)
    assert (strong.impacts, strong.separations) == (elastic.impacts, elastic.separations)


@pytest.mark.parametrize(("alpha", "theta", "lost"), [(0.2, 0.0, 0.0), (0.2, 0.02, 0.00289), (0.3, 0.1, 0.01946)])
def test_finite_kinematics_keep_the_angular_momentum_of_an_impact_only_upright(alpha, theta, lost):
    """The left pivot lands without restitution while the pier rocks about the right one, leaning by θ.

    About the landing pivot, L/M = I0/M θ̇ + y ẋ − x ẏ of the centre of mass, ẋ = H θ̇: H jumps by b sin θ with the
    contact, and the impulse, which takes the H of both pivots in contact, does not know it (THEORY.md, eq. 11).
    """
    pier = Pier(alpha, 1.0)
    m = springs(pier, ElasticBase(50.0, 0.0, "finite"))
    b, h = m.half_width, m.height
    x, y = b * math.cos(theta) + h * math.sin(theta), h * math.cos(theta) - b * math.sin(theta)
    omega = -1.0
    v_rate = (b * math.cos(theta) - h * math.sin(theta)) * omega  # the right pivot stays
    after, _ = land(m, State(0.0, theta, v_rate, omega, 0.0, -1.0), LEFT, Contact(0.0, 1.0, 0.0, 0.0, 0.0))
    one, both = h * math.cos(theta) + b * math.sin(theta), h * math.cos(theta)
    before = (m.inertia + y * one) * omega - x * v_rate
    kept = (m.inertia + y * both) * after.omega - x * after.v_rate
    assert 1.0 - kept / before == pytest.approx(lost, abs=1e-5)


@pytest.mark.parametrize("n", range(1, 11))
def test_whole_exponents_by_products_are_powers(n):
    """To three roundings; the largest z is 1, at which nothing may be added."""
    for x in (0.0, 1e-3, 0.3, 0.7, 0.999999, 1.0):
        assert power(x, n) == pytest.approx(x**n, rel=8e-16, abs=0.0)
    assert power(0.7, None) == power(0.7, 5)
    assert power(1.0, n) == 1.0


def test_a_whole_exponent_gives_what_a_real_one_next_to_it_gives(uncompiled):
    """Runs with n = 2 by products and with 2 + 1e-13 by the power of a real exponent."""
    motion = pulse("sine", 0.5, dt=0.02, end=1.5)
    whole, near = (
        uncompiled(run_fixed, FIG5, YieldingBase(50.0, 0.1, eta=2.2, n=n), motion, 4, 0.0, wait=False)
        for n in (2.0, 2.0 + 1e-13)
    )
    assert isinstance(springs(FIG5, YieldingBase(50.0, 0.1, eta=2.2, n=2.0)).exponent, int)
    assert whole.theta_max == pytest.approx(near.theta_max, rel=1e-10)
    assert whole.dissipated_left == pytest.approx(near.dissipated_left, rel=1e-9)
    assert (whole.impacts, whole.separations) == (near.impacts, near.separations)
