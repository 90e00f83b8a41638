"""The statics sheet: closed forms (THEORY.md, Statics), balances of moments by other solvers, limits, and refusals."""

import dataclasses
import math
import re
from functools import partial
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from scipy.integrate import quad, solve_ivp
from scipy.optimize import brentq
from scipy.special import hyp2f1
from studies import study_text, write_study

import rockbatch as rb
from rockbatch.commands.cli import main
from rockbatch.commands.statics import rotations
from rockbatch.pier import (
    ElasticBase,
    Pier,
    RigidBase,
    YieldingBase,
    least_beta,
    problems,
    rocking_frequency,
    static_deflection,
)
from rockbatch.pier.equilibrium import Place, SlowTurn
from rockbatch.pier.first_loading import SLOW, Smooth, bouc_wen
from rockbatch.pier.free_rocking import FreeRocking
from rockbatch.pier.statics import FACTS, in_words, sheet_of

PIER = Pier(alpha=0.2, p=1.0, mu=4.0)
FRICTION, TENDON = rb.Damper("friction", f=0.05), rb.Tendon(psi=0.3, lam=0.2)
TALL = Pier.with_deck(width_m=8, height_m=30, mass_t=2000, deck_mass_t=1000)


def on_rigid(*restraints):
    return rb.statics(PIER, RigidBase(restraints=restraints))


def test_a_bare_pier_on_rigid_ground_lifts_off_at_tan_alpha_and_balances_at_alpha():
    sheet = on_rigid()
    assert sheet.lift_off_g == sheet.strength_g == pytest.approx(math.tan(0.2))
    assert sheet.lift_off_rad == sheet.strength_rad == 0.0
    assert sheet.unstable_rad == pytest.approx(0.2)
    assert sheet.moment_over_weight_m == pytest.approx(PIER.half_width)
    assert (
        sheet.settlement_m is sheet.vertical_period_s is sheet.full_contact_period_s is sheet.stress_at_rest_MPa is None
    )


def test_the_curve_of_a_bare_pier_is_tan_of_what_is_left_to_alpha():
    curve = on_rigid().curve
    assert curve["acceleration_g"].to_numpy() == pytest.approx(np.tan(0.2 - curve["theta_rad"].to_numpy()), abs=1e-9)
    assert curve["moment_over_weight_m"].to_numpy() == pytest.approx(
        PIER.size * np.sin(0.2 - curve["theta_rad"].to_numpy()), abs=1e-8
    )


def test_friction_pulls_against_the_way_since_the_pier_lifted_off():
    pull = Place(FRICTION, 0.0, math.inf).pull(np.array([0.01, 0.02, 0.03]), 0.02)
    np.testing.assert_array_equal(pull, [-0.05, 0.0, 0.05])


def test_friction_at_both_pivots_and_a_tendon_on_the_axis_raise_the_lift_off():
    """THEORY.md: tan α (1 + 2f) g, and (g + P0/M) tan α; dampers without a force at rest leave it."""
    assert on_rigid(FRICTION).lift_off_g == pytest.approx(math.tan(0.2) * 1.1)
    assert on_rigid(TENDON).lift_off_g == pytest.approx(math.tan(0.2) * 1.3)
    others = on_rigid(rb.Damper("viscous", nu=1.0), rb.Damper("hysteretic", f=0.1, yield_m=0.01))
    assert others.lift_off_g == pytest.approx(math.tan(0.2))
    assert others.strength_g > 1.1 * math.tan(0.2)  # the hysteretic one has yielded by then


@pytest.mark.parametrize("base", [RigidBase, partial(ElasticBase, 30.0, kinematics="finite")])
def test_supports_bear_the_weight_and_what_tendons_press_down(base):
    """A tendon on the axis pulls along e = u/cos(θ/2), so that it presses with P ∂e/∂u = P/cos(θ/2)."""
    turn, theta = SlowTurn(PIER, base(restraints=(TENDON,))), np.array([0.05, 0.3, 0.6])
    (place,), at = turn.places, turn.at(theta)
    pull = place.pull(turn.elongation(place, theta, at.depth), 0.0)
    assert at.toe + at.heel == pytest.approx(1.0 + pull / np.cos(0.5 * theta), rel=1e-9)


def test_dampers_are_held_against_what_rights_the_pier():
    """At 0.1 α friction at the heel has f 2b cos 0.05 α, by its chord, the weight R sin 0.9 α; viscous dampers bear nothing.

    A release from 0.1 α ends upright below 1 only.
    """
    per_force = 2.0 * PIER.half_width * math.cos(0.01) / (PIER.size * math.sin(0.18))
    assert on_rigid(FRICTION).dampers_over_rest == pytest.approx(0.05 * per_force, rel=1e-6)
    assert on_rigid(rb.Damper("viscous", nu=0.5)).dampers_over_rest is on_rigid(TENDON).dampers_over_rest is None
    still = rb.Motion("still", 0.01, np.zeros(500))
    for ratio in (0.9, 1.1):
        base = RigidBase(restraints=(rb.Damper("friction", f=ratio / per_force),))
        assert rb.statics(PIER, base).dampers_over_rest == pytest.approx(ratio, rel=1e-6)
        released = rb.simulate(dataclasses.replace(PIER, initial_rotation_rad=0.02), base, still)
        assert abs(released.history["theta"].iloc[-1]) == pytest.approx(0.02 if ratio > 1 else 0.0, abs=1e-6)


def test_of_two_directions_the_weaker_counts():
    """A tendon at the left pivot has no arm about it, and the base's width about the right one."""
    sheet = on_rigid(rb.Tendon(psi=0.3, at="left"))
    assert sheet.lift_off_g == pytest.approx(math.tan(0.2))
    assert sheet.towards == "left"
    assert sheet.swings["period_s"].isna().all()  # its swings are uneven
    assert on_rigid(TENDON).towards == "either"


@pytest.mark.parametrize("kinematics", ["first-order", "finite"])
def test_springs_let_go_at_the_rotation_of_eq_10_when_the_other_carries_all(kinematics):
    """M a h = M g (b − h θ), or M g (b cos θ − h sin θ) = M a h cos θ."""
    base = ElasticBase(beta=30.0, kinematics=kinematics)
    sheet = rb.statics(PIER, base)
    ratio = static_deflection(PIER, base) / PIER.half_width
    assert ratio == pytest.approx((1 + PIER.mu) / (PIER.mu * 30.0**2 * math.sin(0.2)))
    lean = math.asin(ratio) if kinematics == "finite" else ratio
    assert sheet.lift_off_rad == pytest.approx(lean)
    assert sheet.lift_off_g == pytest.approx(math.tan(0.2) - (math.tan(lean) if kinematics == "finite" else lean))
    assert sheet.unstable_rad == pytest.approx(0.2 if kinematics == "finite" else math.tan(0.2))
    assert sheet.settlement_m == pytest.approx(static_deflection(PIER, base))


def test_friction_and_prestress_on_springs_are_those_on_rigid_ground_less_the_lean():
    for devices, share in (((FRICTION,), 1.1), ((rb.Tendon(psi=0.3),), 1.3), ((FRICTION, rb.Tendon(psi=0.3)), 1.4)):
        sheet = rb.statics(PIER, ElasticBase(beta=30.0, restraints=devices))
        lean = sheet.lift_off_rad
        assert sheet.lift_off_g == pytest.approx(share * math.tan(0.2) - lean, rel=1e-7)
        prestress = 1.3 if len(devices) == 2 or isinstance(devices[0], rb.Tendon) else 1.0
        assert lean == pytest.approx(prestress * sheet.settlement_m / prestress / PIER.half_width, rel=1e-7)


def test_a_tendon_moves_the_unstable_equilibrium_out_and_a_stiff_one_takes_it_away():
    """Its zero of sin(α − θ) + λ sin θ + ψ sin α cos(θ/2) is found by another solver; for λ > cos α there is none."""

    def brace(theta):
        return math.sin(0.2 - theta) + 0.2 * math.sin(theta) + 0.3 * math.sin(0.2) * math.cos(theta / 2)

    assert on_rigid(TENDON).unstable_rad == pytest.approx(brentq(brace, 0.2, 1.5), abs=1e-9)
    assert on_rigid(rb.Tendon(psi=0.3, lam=1.01)).unstable_rad is None
    stiff = on_rigid(rb.Tendon(psi=0.3, lam=3.0))
    assert stiff.unstable_rad is stiff.strength_g is stiff.moment_over_weight_m is None
    assert "rises with the rotation" in repr(stiff)
    assert rb.statics(TALL, RigidBase(restraints=(rb.Tendon(psi=0.3, lam=3.0),))).row["moment_kN_m"] is None


def test_a_tendon_that_yields_rights_the_pier_by_its_strength_alone():
    weak = rb.Tendon(psi=0.3, lam=5.0, strength=0.3000001)
    level = brentq(lambda t: math.sin(0.2 - t) + 0.3 * math.sin(0.2) * math.cos(t / 2), 0.2, 1.5)
    assert on_rigid(weak).unstable_rad == pytest.approx(level, abs=1e-6)


@pytest.mark.parametrize("eta", [1.2, 1.7, 2.5])
def test_supports_that_cannot_bear_all_never_let_go_and_topple_at_the_summit(eta):
    """THEORY.md, When a run is over: tan θ = min(1, η − 1) tan α; the strength is less by the lean."""
    base = YieldingBase(beta=30.0, eta=eta, spring="epp", kinematics="finite")
    sheet, share = rb.statics(PIER, base), min(1.0, eta - 1.0)
    assert (sheet.lift_off_g is None) == (eta < 2.0)
    assert math.tan(sheet.unstable_rad) == pytest.approx(share * math.tan(0.2))
    lean = math.asin(share * sheet.settlement_m / PIER.half_width)
    assert sheet.strength_g == pytest.approx(share * math.tan(0.2) - math.tan(lean), rel=1e-5)
    assert "yields before" in repr(sheet) if eta < 2.0 else "yields" not in repr(sheet).splitlines()[2]


def weak_pairs(count, devices=lambda rng: ()):
    """Return piers on elastic–perfectly plastic supports that cannot bear them alone, at random."""
    rng = np.random.default_rng(44)
    pairs = []
    while len(pairs) < count:
        pier = Pier(alpha=rng.uniform(0.08, 0.35), p=rng.uniform(0.4, 1.5), mu=rng.uniform(1.5, 4.0))
        springs = {"spring": "epp", "kinematics": ("first-order", "finite")[len(pairs) % 2], "restraints": devices(rng)}
        base = YieldingBase(beta=rng.uniform(20.0, 80.0), eta=rng.uniform(1.2, 1.98), **springs)
        if not problems(pier, base):
            pairs.append((pier, base))
    return pairs


def test_the_curve_of_weak_supports_has_the_strength_of_its_closed_form():
    """Without a point at first yield the curve is 0.9 to 4.2 % low there."""
    for pier, base in weak_pairs(4):
        sheet = rb.statics(pier, base)
        theta = np.linspace(1e-6, sheet.unstable_rad, 20_001)[:-1]
        finite = base.kinematics == "finite"
        sine, cosine = (np.sin(theta), np.cos(theta)) if finite else (theta, np.ones_like(theta))
        b, h = pier.half_width, pier.height
        toe = np.minimum(0.5 + 0.5 * b * sine / static_deflection(pier, base), 0.5 * base.eta)
        held = (b * cosine - h * sine - (1.0 - toe) * 2.0 * b * cosine) / (h * cosine)
        curve = sheet.curve
        on_curve = np.interp(theta, curve["theta_rad"], curve["acceleration_g"])
        assert on_curve == pytest.approx(held, abs=1e-4 * sheet.strength_g)
        at_strength = np.interp(sheet.strength_rad, curve["theta_rad"], curve["acceleration_g"])
        assert at_strength == pytest.approx(sheet.strength_g, rel=1e-6)
        assert sheet.strength_g == pytest.approx(held.max(), rel=1e-3)  # the grid of the closed form misses the kink


@pytest.mark.parametrize("kind", ["tendon", "stop", "round"])
def test_the_curve_has_the_printed_strength_with_devices_and_round_laws(kind):
    """Kinks of tendons that yield and stops that are met, too: between its points the curve is what 4,000 points say."""
    makes = {
        "tendon": lambda rng: (rb.Tendon(psi=0.01, lam=rng.uniform(0.05, 0.5), strength=rng.uniform(0.03, 0.3)),),
        "stop": lambda rng: (rb.Stop(gap_m=rng.uniform(0.005, 0.05), lam=rng.uniform(0.1, 0.8)),),
        "round": lambda rng: (),
    }
    for pier, weak in weak_pairs(3, makes[kind]):
        base = dataclasses.replace(weak, spring="bouc-wen") if kind == "round" else weak
        sheet = sheet_of(pier, base)
        curve = sheet.equilibria
        if sheet.strength_g is not None:
            at_strength = np.interp(sheet.strength_rad, curve.theta, curve.acceleration)
            assert at_strength == pytest.approx(sheet.strength_g, rel=1e-9)
        theta = np.linspace(1e-6, curve.theta[-1], 4001)[:-1]
        fine = SlowTurn(pier, base).at(theta).acceleration
        on_curve = np.interp(theta, curve.theta, curve.acceleration)
        assert on_curve == pytest.approx(fine, abs=(2e-3 if kind == "round" else 1e-4) * fine.max())


def test_the_rotations_that_the_command_prints_are_points_of_the_curve():
    """Interpolation between others is off where the curve bends: here lift-off of one side is in the curve of the other."""
    pads = ElasticBase(30.0, restraints=(rb.DeckSpring(0.3, gap_m=0.01, side="left"),))
    for base in (pads, YieldingBase(30.0, eta=1.7), RigidBase(restraints=(TENDON,))):
        sheet = rb.statics(PIER, base)
        printed = {*sheet.swings_at.amplitude, sheet.lift_off_rad or 0.0, sheet.strength_rad}
        assert printed <= set(sheet.equilibria.theta)


@pytest.mark.parametrize("n", [1.0, 2.5, 5.0, 40.0])
def test_the_first_loading_of_bouc_wen_is_its_hypergeometric_function_both_ways(n):
    """∫ dz/(1 − zⁿ) = z ₂F₁(1, 1/n; 1 + 1/n; zⁿ), by series and table, and back to the force; 1e-13: rounding."""
    curve = bouc_wen(n)
    for force in (0.0, 0.1, 0.4, 0.8, 0.97, (1.001 * SLOW) ** (1.0 / n)):
        deflection = force * hyp2f1(1.0, 1.0 / n, 1.0 + 1.0 / n, force**n)
        assert curve.deflection(force) == pytest.approx(deflection, rel=1e-13)
        assert Smooth.deflection(curve, force) == pytest.approx(deflection, rel=1e-13)
        assert curve.force(np.array([deflection])) == pytest.approx([force], rel=1e-13)
        assert curve.tangent(np.array(force)) == pytest.approx(1.0 - force**n, rel=1e-12)
        braced = bouc_wen(n, 0.3)  # a spring of 0.3 δ_y under F_y in series
        assert braced.deflection(force) == pytest.approx(deflection + 0.3 * force, rel=1e-13)
        assert braced.force(np.array([deflection + 0.3 * force])) == pytest.approx([force], rel=1e-13)
    assert curve.force(np.array([1e3])) == pytest.approx([1.0], rel=1e-14)


@pytest.mark.parametrize("eta", [1.5, 2.5])
def test_bouc_wen_supports_are_balanced_as_another_solver_balances_them(eta):
    """Vertical balance and moments of three rotations, with SciPy's quadrature and root finding on the law."""
    base = YieldingBase(beta=30.0, eta=eta, n=5.0)
    turn, settled = SlowTurn(PIER, base), rb.statics(PIER, base).settlement_m
    delta_y, b, h = eta * static_deflection(PIER, base), PIER.half_width, PIER.height

    def deflection(z):
        return delta_y * quad(lambda s: 1.0 / (1.0 - s**5), 0.0, z, epsabs=1e-14)[0]

    assert settled == pytest.approx(deflection(1.0 / eta), rel=1e-9)
    for theta in (0.002, 0.005) if eta < 2.0 else (0.002, 0.005, 0.05):

        def excess(z, theta=theta):
            risen = settled - deflection(z) + 2.0 * b * theta
            return z + max(1.0 / eta - risen / delta_y, 0.0) - 2.0 / eta  # over F_y

        z = brentq(excess, 1.0 / eta - 1e-9, 1.0 - 1e-9)
        toe = 0.5 * eta * z
        here = turn.at(np.array([theta]))
        assert here.toe == pytest.approx([toe], rel=1e-6)
        assert here.moment == pytest.approx([toe * (b - h * theta) - (1.0 - toe) * (b + h * theta)], rel=1e-6)


@pytest.mark.parametrize("eta", [1.2, 2.0, 3.0])
def test_supports_bear_the_weight_together_at_every_rotation_however_weak_they_are(eta):
    turn = SlowTurn(PIER, YieldingBase(beta=1000.0, eta=eta))
    theta = np.linspace(0.0, turn.lift_off or PIER.alpha, 9)[1:]
    at = turn.at(theta)
    strength, stiffness = 0.5 * eta, turn.spring.stiffness
    for depth, toe, heel in zip(at.depth, at.toe, at.heel, strict=True):
        if toe < 0.999 * strength:  # first loading, by quadrature: the deflection under the toe's force
            under = quad(lambda z: 1.0 / (1.0 - z**5), 0.0, toe / strength, epsabs=0.0, epsrel=1e-12)[0]
            assert depth == pytest.approx(under * strength / stiffness, rel=1e-9)
        assert toe <= strength * (1.0 + 1e-9)
        assert toe + heel == pytest.approx(1.0, abs=1e-12)


def test_a_hysteretic_damper_between_middle_and_toe_unloads_at_lift_off():
    """It is pushed in before lift-off and drawn out after it: F follows Bouc–Wen's law along that way (DOP853)."""
    place, f, u = 1.0, 0.1, 0.002
    base = ElasticBase(beta=30.0, restraints=(rb.Damper("hysteretic", f=f, yield_m=u, at=place),))
    turn = SlowTurn(PIER, base)
    thetas = np.unique([*np.linspace(1e-4, 0.05, 40), turn.lift_off])
    here = turn.at(thetas)
    rises = turn.settled - here.depth + (PIER.half_width - place) * thetas

    def law(e, z, way):
        return [way / u * (1.0 - (abs(z[0]) ** 5 if z[0] * way > 0.0 else 0.0))]

    z, e, forces = 0.0, 0.0, []
    for goal in rises:
        way = math.copysign(1.0, goal - e)
        if goal != e:
            z = solve_ivp(lambda s, y, way=way: law(s, y, way), (0.0, abs(goal - e)), [z], rtol=1e-10, atol=1e-12).y[
                0, -1
            ]
        e = goal
        forces.append(f * z)
    assert rises.min() < -0.5 * u < 0.0 < rises[-1]
    assert here.dampers == pytest.approx(np.array(forces) * (PIER.half_width - place), abs=2e-3 * f)


def test_stiff_springs_are_rigid_ground():
    for devices in ((), (FRICTION, TENDON), (rb.Damper("hysteretic", f=0.1, yield_m=0.01),)):
        rigid, stiff = (
            rb.statics(PIER, base)
            for base in (
                RigidBase(restraints=devices),
                ElasticBase(beta=3e4, kinematics="finite", restraints=devices, confirm=("beta",)),
            )
        )
        for name in ("lift_off_g", "strength_g", "moment_over_weight_m", "unstable_rad"):
            assert getattr(stiff, name) == pytest.approx(getattr(rigid, name), rel=1e-5), name
        assert stiff.swings["period_s"].to_numpy() == pytest.approx(rigid.swings["period_s"].to_numpy(), rel=1e-4)


def test_small_swings_on_springs_have_the_linear_period_and_slender_housners():
    base = ElasticBase(beta=20.0, kinematics="finite")
    linear = 2.0 * math.pi / rocking_frequency(PIER, base)
    assert rb.statics(PIER, base).full_contact_period_s == pytest.approx(linear, rel=1e-6)
    tied = dataclasses.replace(base, kinematics="first-order", restraints=(rb.DeckSpring(0.3),))
    of_spring = 0.3 * PIER.size / PIER.half_width**2 * PIER.gravity * PIER.deck**2 / (PIER.inertia + PIER.height**2)
    stiffer = 2.0 * math.pi / math.sqrt(rocking_frequency(PIER, base) ** 2 + of_spring)
    assert rb.statics(PIER, tied).full_contact_period_s == pytest.approx(stiffer, rel=1e-6)
    assert FreeRocking(PIER, base).periods(np.array([1e-4])) == pytest.approx([linear], rel=1e-6)
    slender = Pier(alpha=1e-3, p=2.0)
    swings = rb.statics(slender, RigidBase()).swings
    share = swings["amplitude_over_alpha"].to_numpy()
    assert swings["period_s"].to_numpy() == pytest.approx(2.0 * np.arccosh(1.0 / (1.0 - share)), rel=1e-6)


@pytest.mark.parametrize("share", [0.1, 0.4, 0.9], ids=["in full contact", "beyond", "almost over"])
@pytest.mark.parametrize("kinematics", ["finite", "first-order"])
def test_a_swing_on_springs_takes_as_long_as_its_energy_says(kinematics, share):
    """Each pad has k = ½ β² p² per mass and yields g/(2k); on one pad alone its toe does not move."""
    base = ElasticBase(beta=15.0, kinematics=kinematics)
    b, h, g, inertia = PIER.half_width, PIER.height, PIER.gravity, PIER.inertia
    k, finite = 0.5 * (15.0 * PIER.p) ** 2, kinematics == "finite"
    arm = math.sin if finite else lambda theta: theta
    lift_off = math.asin(g / (2.0 * k * b)) if finite else g / (2.0 * k * b)
    unstable = brentq(lambda theta: b - h * (math.tan(theta) if finite else theta), 0.0, 0.5)
    start = {0.1: 0.7 * lift_off, 0.4: 0.4 * unstable, 0.9: 0.9 * unstable}[share]
    assert (start < lift_off) == (share == 0.1)

    def potential(theta):
        v = -g / (2.0 * k) if theta <= lift_off else b * arm(theta) - g / k
        depths = (min(v - b * arm(theta), 0.0), min(v + b * arm(theta), 0.0))
        lowered = h * math.cos(theta) - h
        return g * (v + lowered) + 0.5 * k * sum(depth * depth for depth in depths)

    def kinetic(theta):
        apart = theta > lift_off
        across = h * math.cos(theta) + apart * b * math.sin(theta)
        return inertia + across**2 + (apart * b * math.cos(theta) - h * math.sin(theta)) ** 2

    def slowness(x):  # θ = start (1 − x²)
        theta = start * (1.0 - x * x)
        return 2.0 * start * x * math.sqrt(kinetic(theta) / (2.0 * (potential(start) - potential(theta))))

    def moment_first_order(_, y):
        theta = abs(y[0])
        if theta <= lift_off:
            return [y[1], -math.copysign((2.0 * k * b * b - g * h) * theta / (inertia + h * h), y[0])]
        return [y[1], -math.copysign(g * (b - h * theta) / (inertia + h * h + b * (b - h * theta)), y[0])]

    upright = lambda t, y: y[0]  # noqa: E731
    upright.terminal = True
    if finite:
        bends = [math.sqrt(1.0 - lift_off / start)] if start > lift_off else None
        quarter = quad(slowness, 1e-7, 1.0, points=bends, limit=200, epsabs=1e-11)[0]
    else:
        swing = solve_ivp(
            moment_first_order,
            (0.0, 50.0),
            [start, 0.0],
            method="DOP853",
            rtol=1e-11,
            atol=1e-14,
            events=upright,
            max_step=0.01,
        )
        quarter = swing.t_events[0][0]
    free = FreeRocking(PIER, base)
    assert free.periods(np.array([start])) == pytest.approx([4.0 * quarter], rel=1e-6)
    linear = 2.0 * math.pi * math.sqrt((inertia + h * h) / (2.0 * k * b * b - g * h))
    assert free.in_full_contact == pytest.approx(linear, rel=1e-6)


def test_a_pier_held_upright_swings_beyond_its_slenderness_as_on_rigid_ground():
    held, far = (rb.Tendon(psi=0.3, lam=2.0),), np.array([0.2, 0.5, 0.9])
    stiff = FreeRocking(PIER, ElasticBase(beta=500.0, kinematics="finite", restraints=held))
    assert stiff.turn.unstable is None
    assert stiff.periods(far) == pytest.approx(FreeRocking(PIER, RigidBase(restraints=held)).periods(far), rel=2e-3)


def test_damping_by_impacts_of_large_swings_is_that_of_their_energy():
    """The centre of mass is R (cos(α − θ) − cos α) above its place, and two impacts leave e⁴ of that."""
    base, start = RigidBase(restitution=0.85), np.array([0.3, 0.6, 0.95]) * PIER.alpha
    height = lambda theta: math.cos(PIER.alpha - theta) - math.cos(PIER.alpha)  # noqa: E731
    after = [brentq(lambda theta, start=first: height(theta) - 0.85**4 * height(start), 0.0, first) for first in start]
    measured = FreeRocking(PIER, base).impact_damping(start, 0.85)
    assert measured == pytest.approx(np.log(start / after) / (2.0 * math.pi), rel=1e-6)
    assert FreeRocking(PIER, base).in_full_contact is None


def test_damping_by_impacts_is_the_decrement_of_housners_decay():
    """1 − √(1 − r² (1 − (1 − φ)²)) after two impacts (Housner 1963, slender), and −ln(r)/π for small amplitudes."""
    slender, e = Pier(alpha=1e-3, p=2.0), 0.9
    swings = rb.statics(slender, RigidBase(restitution=e)).swings
    share = swings["amplitude_over_alpha"].to_numpy()
    after = 1.0 - np.sqrt(1.0 - e**4 * (1.0 - (1.0 - share) ** 2))
    assert swings["impact_damping"].to_numpy() == pytest.approx(np.log(share / after) / (2.0 * math.pi), rel=1e-5)
    small = FreeRocking(slender, RigidBase()).impact_damping(np.array([1e-6]), e)
    assert small == pytest.approx([-math.log(e**2) / math.pi], rel=1e-3)
    assert np.isinf(rb.statics(PIER, RigidBase(restitution=0.0)).swings["impact_damping"]).all()
    assert rb.statics(PIER, ElasticBase(beta=30.0)).swings["impact_damping"].isna().all()


def test_a_frame_lifts_off_as_its_columns_do_and_swings_with_its_own_p():
    frame = Pier.frame(Pier.rectangle(1.0, 7.0, mass_t=20.0), 4, 200.0)
    sheet = rb.statics(frame, RigidBase())
    assert sheet.strength_g == pytest.approx(math.tan(frame.alpha))
    assert sheet.swings["period_s"][2] == pytest.approx(4.0 / frame.p * math.acosh(1.0 / 0.9), rel=2e-3)


def test_stresses_are_the_weight_over_the_areas_and_need_a_mass():
    base = ElasticBase.from_stiffness(TALL, 2e6, area_m2=6.0, restraints=(rb.Tendon.of(TALL, prestress_kN=3000.0),))
    sheet = rb.statics(TALL, base)
    total = 3000.0 * 9.81 + 3000.0
    assert sheet.weight_kN == pytest.approx(3000.0 * 9.81)
    assert sheet.stress_at_rest_MPa == pytest.approx(total / 2.0 / 6.0 / 1000.0)
    assert sheet.stress_on_one_MPa == pytest.approx(total / 6.0 / 1000.0, rel=1e-6)
    assert sheet.vertical_period_s == pytest.approx(2.0 * math.pi * math.sqrt(3000.0 / 4e6))
    assert rb.statics(PIER, RigidBase(area_m2=6.0)).stress_at_rest_MPa is None


def test_the_flexural_period_is_held_against_rocking_and_nothing_else_changes():
    """T_f/T above a third: the bending of a series of springs has more than a ninth of the drift."""
    base = RigidBase()
    period = rb.statics(TALL, base).row["period_s"]
    for share, words in ((0.2, "4%"), (0.5, "not rigid")):
        sheet = rb.statics(dataclasses.replace(TALL, flexural_period_s=share * period), base)
        assert sheet.flexural_over_rocking == pytest.approx(share)
        assert words in repr(sheet)
    assert "fixed at its base" not in repr(rb.statics(TALL, base))


@pytest.mark.parametrize("phi", [0.1, 0.3])
@pytest.mark.parametrize("ratio", [0.1, 1.0 / 3.0, 0.5])
def test_bending_has_the_square_of_the_ratio_of_periods_of_the_drift_by_rocking(phi, ratio):
    """THEORY.md, Statics: a mass on an elastic column on a block without mass, let go at φ α; small rotations (DOP853)."""
    g, h, b = 9.81, 20.0, 20.0 * math.tan(0.15)
    quarter = math.acosh(1.0 / (1.0 - phi)) * math.sqrt(math.hypot(b, h) / g)
    stiffness, tilt = (2.0 * math.pi / (ratio * 4.0 * quarter)) ** 2, phi * 0.15
    bent = (g * (b - h * tilt) / h + g * tilt) / (stiffness + g / h)

    def rates(_t, y):
        u, theta, u_rate, theta_rate = y
        mass = -stiffness * u - 0.04 * math.sqrt(stiffness) * u_rate + g * theta  # its horizontal acceleration
        turn = (-g * b + g * (u + h * theta) - h * mass) / b**2
        return [u_rate, theta_rate, mass - h * turn, turn]

    def upright(_t, y):
        return y[1]

    upright.terminal = True
    swing = solve_ivp(
        rates, (0.0, 60.0), [bent, tilt, 0.0, 0.0], method="DOP853", events=upright, rtol=1e-8, atol=1e-11
    )
    assert bent / (h * tilt) == pytest.approx(ratio**2, rel=0.13)
    assert 1.0 < swing.t_events[0][0] / quarter < (1.03 if ratio < 0.4 else 1.06)


def test_rows_have_every_fact_and_the_tables_their_columns():
    sheet = rb.statics(TALL, ElasticBase.from_stiffness(TALL, 2e6))
    assert list(sheet.row) == [fact.name for fact in FACTS]
    assert sheet.row["moment_kN_m"] == pytest.approx(sheet.moment_over_weight_m * sheet.weight_kN)
    assert sheet.curve["theta_rad"].is_monotonic_increasing
    assert sheet.curve["theta_rad"][0] == 0.0
    assert sheet.curve["toe_over_weight"][0] == pytest.approx(0.5)
    assert "moment_kN_m" in sheet.curve
    assert "moment_kN_m" not in on_rigid().curve
    assert sheet.plot(88.0).axes[0].get_ylabel() == "moment [MN m]"
    assert "<table>" in sheet._repr_html_()


def test_the_sheet_of_a_footing_has_its_ground_by_the_formulas_and_its_share_pressed():
    """Gazetas (1991) for 8 m in the plane of rocking by 10 m, worked out here."""
    g, nu, width, length = 45.0, 0.45, 8.0, 10.0  # MPa, m
    pier = Pier.with_deck(width_m=width, height_m=22, mass_t=1100, deck_mass_t=900)
    sheet = rb.statics(pier, rb.FootingBase.from_soil(pier, g, nu, length_m=length, safety_factor=3.2))
    rocking = (
        g / (1.0 - nu) * (length * width**3 / 12.0) ** 0.75 * (length / width) ** 0.25 * (2.4 + 0.5 * width / length)
    )
    vertical = g * length / (1.0 - nu) * (0.73 + 1.54 * (width / length) ** 0.75)
    assert sheet.row["rocking_stiffness_MN_m"] == pytest.approx(rocking, rel=1e-9)
    assert sheet.row["vertical_over_formula"] == pytest.approx(12.0 * rocking / width**2 / vertical, rel=1e-9)
    assert sheet.row["ultimate_moment_kN_m"] == pytest.approx(2000.0 * 9.81 * 4.0 * (1.0 - 1.0 / 3.2))
    assert sheet.row["moment_kN_m"] < sheet.row["ultimate_moment_kN_m"]
    lifted = sheet.curve["theta_rad"] > sheet.lift_off_rad
    assert ((sheet.curve["contact_share"] < 1.0 - 1e-6) == lifted).all()
    assert [axes.get_ylabel() for axes in sheet.plot(88.0).axes][-1] == "share pressed"
    assert re.search(r"held by \[g\] +moment \[kN m\] +pressed .*\n0 +0 +0.0000 +0 +100%", rotations(sheet))
    springs = rb.statics(TALL, ElasticBase.from_stiffness(TALL, 2e6))
    assert [springs.row[name] for name in ("rocking_stiffness_MN_m", "ultimate_moment_kN_m", "safety_factor")] == [
        None
    ] * 3
    assert springs.contact_share is None


def test_a_study_or_its_path_gives_the_sheet_of_every_case(tmp_path):
    path = write_study(tmp_path, study_text(pier=BRIDGE, pulses=(), motions={"path": "nowhere"}, cases=(PADS,)))
    expected = [
        rb.statics(TALL, ElasticBase.from_stiffness(TALL, k, zeta=0.05, area_m2=6.0)).row
        for k in PADS["stiffness_kN_m"]
    ]
    from_file, from_study = rb.statics(path), rb.statics(rb.load_study(path, motions=rb.Motion.still(2.0)))
    assert list(from_file) == list(from_study) == ["K = 1 × 10⁶ kN/m", "K = 2 × 10⁶ kN/m"]
    assert [sheet.row for sheet in from_file.values()] == [sheet.row for sheet in from_study.values()] == expected
    with pytest.raises(rb.InputError, match="foundation: a study has its own"):
        rb.statics(path, RigidBase())
    with pytest.raises(rb.MissingKey, match="foundation: a pier needs one"):
        rb.statics(PIER)


def test_impossible_piers_are_refused_with_the_limit():
    soft = ElasticBase(beta=0.9 * least_beta(PIER, ElasticBase(beta=30.0)))
    with pytest.raises(rb.InputError, match="beta must be above"):
        rb.statics(PIER, soft)
    with pytest.raises(rb.InputError, match="foundation"):
        rb.statics(PIER, "rigid")
    with pytest.raises(rb.InputError, match=r"yield_m .* write confirm"):
        rb.statics(PIER, RigidBase(restraints=(rb.Damper("hysteretic", f=0.1, yield_m=1e-6),)))
    with pytest.raises(rb.InputError, match="flexural_period_s = -1"):
        dataclasses.replace(PIER, flexural_period_s=-1.0)
    with pytest.raises(rb.InputError, match=r"area_m2 = 0: .*m²"):
        rb.statics(PIER, RigidBase(area_m2=0.0))


ROOT = Path(__file__).parents[1]
BRIDGE = {"width_m": 8.0, "height_m": 30.0, "mass_t": 2000.0, "deck_mass_t": 1000.0}
PADS = {"name": "pads", "base": "elastic", "stiffness_kN_m": [1e6, 2e6], "zeta": 0.05, "area_m2": 6.0}


@pytest.mark.parametrize(
    ("pier", "base", "heads"),
    [
        (PIER, RigidBase(restraints=(TENDON, rb.Stop(gap_m=0.1, lam=0.1), FRICTION)),
         ["moment [m]", "of tendons", "of stops, springs", "of dampers", "period [s]", "damping"]),
        (TALL, ElasticBase.from_stiffness(TALL, 2e6), ["moment [kN m]", "period [s]"]),
    ],
)  # fmt: skip
def test_the_command_prints_the_curve_and_the_swings_at_their_rotations(pier, base, heads):
    sheet = rb.statics(pier, base)
    head, *lines = ([*re.split(r"\s{2,}", line.strip())] for line in rotations(sheet).splitlines())
    assert head == ["theta/alpha", "theta [rad]", "held by [g]", *heads]
    curve, scale = sheet.curve, sheet.weight_kN or 1.0
    swings = dict(zip(sheet.swings_at.amplitude, sheet.swings_at.period, strict=True))
    printed = {float(line[1]): [float(cell.replace(",", "").rstrip("%")) for cell in line] for line in lines}
    for theta in (0.0, curve["theta_rad"].iloc[-1], sheet.strength_rad, *swings):
        assert any(theta == pytest.approx(each, rel=1e-3) for each in printed)
    for theta, (share, _, held, *cells) in printed.items():
        assert share == pytest.approx(theta / pier.alpha, rel=2e-3)
        assert held == pytest.approx(np.interp(theta, curve["theta_rad"], curve["acceleration_g"]), abs=2e-4)
        for title, cell in zip(heads, cells, strict=False):
            column = {"mo": "moment_over_weight_m"}.get(title[:2], f"of_{title[3:].split(',')[0]}_m")
            if column in curve:
                there = scale * np.interp(theta, curve["theta_rad"], curve[column])
                assert cell == pytest.approx(there, rel=2e-3, abs=2e-4 * scale)
    with_period = [line for line in lines if len(line) == len(head)]
    assert [float(line[head.index("period [s]")]) for line in with_period] == pytest.approx(
        list(swings.values()), rel=5e-3
    )


def test_the_command_prints_and_writes_what_python_has_without_records(tmp_path, capsys, monkeypatch):
    motions = {"path": "nowhere"}
    study = write_study(
        tmp_path, study_text(pier=BRIDGE, motions=motions, pulses=(), cases=({"name": "rock", "base": "rigid"}, PADS))
    )
    sheet, curves = tmp_path / "sheet.csv", tmp_path / "curves.csv"
    assert main(["statics", str(study), "--csv", str(sheet), "--curves", str(curves)]) == 0
    printed = capsys.readouterr().out
    assert "static strength [g]" in printed
    assert "\n\npads: K = 2 × 10⁶ kN/m\ntheta/alpha" in printed
    monkeypatch.setattr("rockbatch.commands.statics.MOST_CASES", 2)
    assert main(["statics", str(study)]) == 0
    fewer = capsys.readouterr()
    assert (fewer.out.rstrip(), fewer.err) == (
        printed.split("\n\n")[0],
        "3 cases: use --curves FILE for their curves\n",
    )
    table = pd.read_csv(sheet)
    assert list(table)[:2] == ["case", "stiffness_kN_m"]
    for row, base in zip(
        table.to_dict("records"),
        (RigidBase(), *(ElasticBase.from_stiffness(TALL, k, zeta=0.05, area_m2=6.0) for k in PADS["stiffness_kN_m"])),
        strict=True,
    ):
        mine = rb.statics(TALL, base).row
        assert [row[name] for name in mine] == pytest.approx(
            [np.nan if v is None else v for v in mine.values()], rel=1e-9, nan_ok=True
        )
    points = pd.read_csv(curves)
    last = points[points["stiffness_kN_m"] == 2e6]
    assert last["moment_kN_m"].max() == pytest.approx(table["moment_kN_m"].iloc[-1])


def test_cases_of_one_curve_share_it(tmp_path, capsys):
    """A viscous damper has no static force."""
    rigid, viscous = {"base": "rigid"}, [{"kind": "viscous", "coefficient_kN_s_m": 900.0}]
    cases = [rigid | {"name": "rock"}, PADS | {"stiffness_kN_m": 2e6}, rigid | {"name": "damped", "damper": viscous}]
    study = write_study(tmp_path, study_text(pier=BRIDGE, pulses=(), motions={"path": "nowhere"}, cases=cases))
    assert main(["statics", str(study)]) == 0
    assert re.findall(r"\n\n(.*)\ntheta/alpha", capsys.readouterr().out) == ["rock, damped", "pads"]


def test_a_pier_that_is_not_rigid_is_warned_of_by_the_sheet_and_by_a_run(tmp_path, capsys):
    pier = BRIDGE | {"flexural_period_s": [0.3, 2.0]}
    study = write_study(tmp_path, study_text(pier=pier, cases=({"name": "rock", "base": "rigid"},)))
    for command in (["statics", str(study)], ["run", str(study), "--out", str(tmp_path / "out")]):
        assert main(command) == 0
        warned = [line for line in capsys.readouterr().err.splitlines() if "fixed at its base" in line]
        assert len(warned) == 1  # not of the stiff one
        assert warned[0].startswith("rock: flexural period = 2 s: fixed at its base the pier has 0.66 of")


@pytest.mark.parametrize(
    ("pier", "case", "words"),
    [
        (BRIDGE | {"flexural_period_s": 600.0}, {}, "have 0.1 to 3; if it is in ms, write flexural_period_s = 0.6; check"),
        (BRIDGE | {"flexural_period_s": 0.0}, {}, "flexural_period_s = 0"),
        (BRIDGE, {"area_m2": 60000.0}, "area_m2 = 60000"),
        (BRIDGE, {"area_m2": -6.0}, "area_m2 = -6"),
        ({"alpha": 0.2, "p": 1.0}, {"area_m2": 6.0}, "stresses are of a pier whose mass is known; write mass_t in [pier]"),
    ],
)  # fmt: skip
def test_wrong_areas_and_periods_are_refused_with_line_and_remedy(tmp_path, capsys, pier, case, words):
    study = write_study(tmp_path, study_text(pier=pier, cases=({"base": "rigid", **case},)))
    assert main(["statics", str(study)]) == 2
    message = capsys.readouterr().err
    assert words in message
    assert re.search(r"study\.toml:\d+", message)


def test_a_sheet_that_cannot_be_written_is_an_input_error(tmp_path, capsys):
    study = write_study(tmp_path, study_text())
    assert main(["statics", str(study), "--csv", str(tmp_path / "no" / "sheet.csv")]) == 2
    assert "cannot be written" in capsys.readouterr().err


def test_a_stop_holds_the_pier_beyond_its_gap_and_quickens_its_swings():
    """Beyond the gap the moment has k (e − gap) d cos(θ/2) more, e = 2 d sin(θ/2); a quarter swing by DOP853."""
    gap, base = 0.1, RigidBase(restraints=(rb.Stop(gap_m=0.1, lam=2.0),))
    sheet, reach, k = rb.statics(PIER, base), 2.0 * PIER.half_width, 2.0 * PIER.size / PIER.half_width**2

    def moment(theta):
        held = k * max(2.0 * reach * math.sin(theta / 2.0) - gap, 0.0) * reach * math.cos(theta / 2.0)
        return PIER.size * math.sin(PIER.alpha - theta) + held

    curve = sheet.equilibria
    assert curve.moment == pytest.approx(list(map(moment, curve.theta)), abs=1e-9)
    assert sheet.curve["of_stops_m"].max() > 0.0 == sheet.curve["of_tendons_m"].abs().max()
    assert sheet.unstable_rad is None
    start = 0.5 * PIER.alpha
    upright = lambda t, y: y[0]  # noqa: E731
    upright.terminal = True
    fall = solve_ivp(
        lambda t, y: [y[1], -PIER.gravity * moment(y[0]) / PIER.inertia_about_pivot], (0.0, 20.0), [start, 0.0],
        method="DOP853", rtol=1e-10, atol=1e-12, events=upright, max_step=0.01,
    )  # fmt: skip
    assert FreeRocking(PIER, base).periods(np.array([start])) == pytest.approx([4.0 * fall.t_events[0][0]], rel=1e-5)


@pytest.mark.parametrize("spring", [rb.DeckSpring(0.1), rb.DeckSpring(0.4, gap_m=0.3)], ids=["linear", "gap"])
def test_a_spring_beside_the_deck_rights_the_pier_and_quickens_its_swings(spring):
    """The deck goes X = h_d sin θ + b (1 − cos θ); the moment has k (X − gap) dX/dθ more."""
    base, k, b = RigidBase(restraints=(spring,)), spring.lam * PIER.size / PIER.half_width**2, PIER.half_width

    def moment(theta):
        way = PIER.deck * math.sin(theta) + b * (1.0 - math.cos(theta))
        held = k * max(way - spring.gap_m, 0.0) * (PIER.deck * math.cos(theta) + b * math.sin(theta))
        return PIER.size * math.sin(PIER.alpha - theta) + held

    sheet = rb.statics(PIER, base)
    theta = sheet.curve["theta_rad"].to_numpy()
    assert sheet.curve["moment_over_weight_m"].to_numpy() == pytest.approx(list(map(moment, theta)), abs=1e-8)
    start = 0.6 * PIER.alpha
    work = [quad(moment, theta, start, points=[spring.gap_m / PIER.deck])[0] for theta in (0.0, 0.5 * start)]
    assert work[0] > work[1] > 0.0
    slowness = lambda x: (  # noqa: E731  # θ = start (1 − x²)
        2.0 * start * x
        / math.sqrt(2.0 * PIER.gravity / PIER.inertia_about_pivot * quad(moment, start * (1.0 - x * x), start, limit=200)[0])
    )  # fmt: skip
    quarter = quad(slowness, 1e-6, 1.0, limit=200)[0]
    assert FreeRocking(PIER, base).periods(np.array([start])) == pytest.approx([4.0 * quarter], rel=1e-3)


def test_a_linear_spring_beside_the_deck_stiffens_a_pier_on_elastic_springs():
    """Up to lift-off M = (ω_v² b² − g h + k h_d²) θ/g, and none of the spring's force presses the supports."""
    spring, base = rb.DeckSpring(0.3), ElasticBase(60.0)
    held = dataclasses.replace(base, restraints=(spring,))
    bare, tied = (SlowTurn(PIER, each) for each in (base, held))
    theta = np.array([0.5 * bare.lift_off])
    k = spring.lam * PIER.size / PIER.half_width**2
    assert tied.at(theta).moment - bare.at(theta).moment == pytest.approx(k * PIER.deck**2 * theta, rel=1e-9)
    assert tied.at(theta).toe == pytest.approx(bare.at(theta).toe, rel=1e-9)
    assert tied.lift_off == pytest.approx(bare.lift_off, rel=1e-7)


def test_the_page_shows_the_sheet_of_its_study(capsys):
    page = (ROOT / "docs/pages/statics.md").read_text(encoding="utf-8")
    assert main(["statics", str(ROOT / "configs/pier_with_dampers.toml")]) == 0
    sheet = capsys.readouterr().out.split("\n\n")[0]
    assert "\n".join(f"    {line}" for line in sheet.splitlines()) in page


RUBBING = rb.Damper("friction", f=10.0)


@pytest.mark.parametrize(
    ("pier", "base"),
    [
        (Pier(0.01, 0.3), ElasticBase(1e6, confirm=("beta",))),
        (Pier(1.57, 2.0, 1e6), ElasticBase(0.03, restraints=(rb.Stop(gap_m=100.0, lam=0.1), FRICTION))),
        (Pier(1.0, 0.3, 1e6), YieldingBase(0.88, eta=2.5, n=1000.0, restraints=(rb.Tendon(psi=0.3, lam=0.3), FRICTION))),
        (Pier(0.2, 1.0), YieldingBase(30.0, eta=1.000001, n=1.0)),
        (Pier(0.2, 1.0), YieldingBase(30.0, eta=1e6, kinematics="finite", restraints=(RUBBING,), confirm=("eta",))),
        (Pier(1e-4, 1e3, 1e-3, confirm=("p",)), RigidBase(restraints=(rb.Tendon(psi=10.0, lam=1e6),))),
    ],
)  # fmt: skip
def test_the_sheet_of_any_pier_that_stands_has_finite_numbers(pier, base):
    """Warnings are errors here: nothing overflows or divides by 0 on the way."""
    sheet = sheet_of(pier, base)
    assert all(value is None or math.isfinite(value) for value in sheet.row.values())
    assert np.isfinite(sheet.curve.to_numpy()).all()
    assert repr(sheet).startswith("<statics")


def test_a_pier_at_rest_settles_by_its_weight_and_prestress_over_both_springs():
    """g/ω_v² each, and (1 + ψ) times that with a tendon; rigid ground does not give."""
    of_weight = 9.81 / 30.0**2
    for base, settled in (
        (ElasticBase(30.0), of_weight),
        (ElasticBase(30.0, restraints=(rb.Tendon(psi=0.5),)), 1.5 * of_weight),
    ):
        assert in_words(rb.statics(PIER, base))["at rest"] == f"settles {1000 * settled:.3g} mm"
    assert in_words(rb.statics(PIER, RigidBase()))["at rest"] == ""
