"""What designers size, against closed forms, momentum, and accelerations by differences of positions; no code of the core."""

import math
from dataclasses import asdict, replace
from itertools import pairwise

import numpy as np
import pandas as pd
import pytest
from reference_forces import greatest_forces

import rockbatch as rb
from rockbatch.batch.groups import outcomes_of
from rockbatch.batch.observers import observers_of
from rockbatch.observers.forces.peaks import with_error
from rockbatch.outcome import changes
from rockbatch.pier import offsets
from rockbatch.results.columns import StudyRun
from rockbatch.simulation.error_control import CHANCE
from rockbatch.study import Case, Numerics, Output

G = 9.81
PIER = rb.Pier(0.2, 1.0)
FINE = 2e-4
"""Sampling of the histories that are differentiated [s]: at ω_v = 50 rad/s a second difference is wrong by 8·10⁻⁶ of it."""


def shaken(dt=0.01, amplitude=1.0):
    """Eight seconds with a vertical component, linear between samples of 0.01 s; ``dt`` [s] divides them."""
    t = np.arange(0.0, 8.005, 0.01)
    fades = np.sin(np.pi * np.clip(t / 4, 0, 1)) ** 2
    components = amplitude * G * np.sin(2 * np.pi * t) * fades, 2.0 * np.sin(5 * t) * fades
    finer = np.arange(800 * round(0.01 / dt) + 1) * dt
    return rb.Motion("smooth", dt, *(np.interp(finer, t, each) for each in components))


BASES = {
    "rigid": rb.RigidBase(),
    "elastic": rb.ElasticBase(50, 0.1, flight="guided"),
    "bouc-wen": rb.YieldingBase(50, 0.1, flight="guided", eta=2.2),
    "epp, finite": rb.YieldingBase(50, 0.1, flight="guided", eta=2.2, spring="epp", kinematics="finite"),
    "elastic, finite": rb.ElasticBase(50, 0.3, flight="guided", kinematics="finite"),
    "rigid, tied": rb.RigidBase(restraints=(rb.Damper("friction", f=0.03), rb.Tendon(psi=0.1, lam=0.3, at=0.4))),
    "rigid, beyond": rb.RigidBase(
        restraints=(rb.Damper("hysteretic", f=0.03, yield_m=0.01, at=-1.4 * PIER.half_width), rb.Damper("viscous", nu=0.2)),
    ),
    "bouc-wen, tied": rb.YieldingBase(
        50, 0.1, flight="guided", eta=2.2,
        restraints=(rb.Damper("hysteretic", f=0.05, yield_m=0.01), rb.Tendon(psi=0.1, lam=0.3)),
    ),
    "elastic, finite, tied": rb.ElasticBase(
        50, 0.3, flight="guided", kinematics="finite", restraints=(rb.Damper("viscous", nu=0.2), rb.Tendon(psi=0.1, lam=0.3)),
    ),
}  # fmt: skip
FINITE_TIED = pytest.param("elastic, finite, tied", marks=pytest.mark.thorough)
EVERY_BASE = pytest.mark.parametrize(
    "name", [FINITE_TIED if name == "elastic, finite, tied" else name for name in BASES]
)


def forces_of(outcome):
    return outcome.observed.get("forces")


def outcome_of(pier, base, motion, *, forces=True, **numerics):
    run = StudyRun(motion, "+", 1.0, Case("case", pier, base, {}))
    (outcome,) = outcomes_of([run], Numerics(**numerics), observers_of(Output.with_keys(forces=forces)))
    return outcome


def sized(pier, base, motion, **numerics):
    return forces_of(outcome_of(pier, base, motion, **numerics))


@pytest.fixture(scope="module")
def responses():
    """A fine history on each base, with its forces; steps between the samples keep the integrator's error out of it."""
    motion = shaken(FINE)

    class Responses(dict):
        def __missing__(self, name):
            self[name] = rb.simulate(PIER, BASES[name], motion, substeps=1, forces=True)
            return self[name]

    return Responses()


def pulls(response):
    """Sum of what dampers and tendons pull with at every row [m/s²], downwards and back across.

    On a rigid base along the chord from where an element began; on springs by ∂e/∂v: 1/cos(θ/2), or 1 in first-order
    kinematics. Not of friction that holds.
    """
    down = across = np.zeros(len(response.t))
    table, lean, rigid = response.restraints, 0.5 * response.theta, isinstance(response.base, rb.RigidBase)
    lean = lean if response.base.kinematics == "finite" else 0.0 * lean
    for name in [] if table is None else table.columns[2::2]:
        down = down + table[name] * (np.cos(lean) if rigid else 1.0 / np.cos(lean))
        across = across + table[name] * (np.sin(lean) if rigid else 0.0)
    return np.asarray(down), np.asarray(across)


# Positions and velocities of the centre of mass, and of the deck, as one would draw them


def centre(response):
    """Where the centre of mass is over the ground [m], to the right and up; not of finite springs to the right."""
    pier, theta = response.pier, response.theta
    if isinstance(response.base, rb.RigidBase):
        leans = pier.alpha - np.abs(theta)
        along = np.sign(theta) * pier.size * (math.sin(pier.alpha) - np.sin(leans))
        return along, pier.size * np.cos(leans)
    return pier.height * theta, response.v


def velocity(response):
    """Of a block's centre of mass [m/s], to the right and up."""
    pier, theta, omega = response.pier, response.theta, response.omega
    leans = np.sign(theta) * (pier.alpha - np.abs(theta))
    return pier.size * np.cos(leans) * omega, pier.size * np.sin(leans) * omega


def smooth_rows(response):
    """Rows at a sample with samples beside them and no event between."""
    t, events = response.t, response.events["t"].to_numpy()
    even = np.zeros(len(t), dtype=bool)
    even[1:-1] = (np.abs(t[1:-1] - t[:-2] - FINE) < 1e-9) & (np.abs(t[2:] - t[1:-1] - FINE) < 1e-9)
    following = np.searchsorted(events, t)
    even &= t - np.append(-np.inf, events)[following] > 1.5 * FINE
    even &= np.append(events, np.inf)[following] - t > 1.5 * FINE
    return np.flatnonzero(even)


def second_difference(x, rows):
    return (x[rows - 1] - 2.0 * x[rows] + x[rows + 1]) / FINE**2


def close(found, expected, share=1e-3):
    """Within ``share`` of the greatest; two in a thousand rows may lie beside a kink of a spring's law."""
    assert len(found) > 10_000
    off = np.abs(found - expected) > share * np.abs(found).max()
    return np.count_nonzero(off) <= 2e-3 * len(found)


# Closed forms


@pytest.mark.parametrize(("alpha", "demand"), [(0.2, 0.381245667), (0.13, 0.331249756)])
def test_friction_demand_under_a_step_of_1_g_is_that_at_its_start(alpha, demand):
    """V/N = (1 − ¾ cos α (cos α − sin α))/(1 + ¾ sin α (cos α − sin α)), and less from there to θ = α, where it overturns."""
    motion = rb.Motion("step", 0.005, np.full(3000, G))
    outcome = outcome_of(rb.Pier(alpha, 1.0), rb.RigidBase(), motion)
    assert outcome.status == "overturned"
    assert forces_of(outcome).friction_demand == pytest.approx(demand, abs=1e-9)
    c, s = math.cos(alpha), math.sin(alpha)
    assert demand == pytest.approx((1 - 0.75 * c * (c - s)) / (1 + 0.75 * s * (c - s)), abs=1e-9)


@pytest.mark.parametrize("alpha", [0.2, 0.13])
def test_friction_demand_at_the_onset_of_uplift_is_tan_alpha(alpha):
    response = rb.simulate(rb.Pier(alpha, 1.0), rb.RigidBase(), shaken(), forces=True)
    lifts = response.events.loc[response.events["kind"] == "lift-off", "after"]
    assert len(lifts) >= 1
    assert response.forces["friction"].to_numpy()[lifts] == pytest.approx(math.tan(alpha), rel=1e-12)
    forces = sized(rb.Pier(alpha, 1.0), rb.RigidBase(), replace(shaken(), vertical=None))
    assert forces.uplift_ground == pytest.approx(G * math.tan(alpha), rel=1e-12)


def test_friction_dampers_hold_a_block_beyond_the_uplift_of_a_plain_one():
    """Up to ü_g = g tan α (1 + 2f): what would lift one corner its damper holds, and the other bears that too."""
    f, tangent = 0.1, math.tan(PIER.alpha)
    base = rb.RigidBase(restraints=(rb.Damper("friction", f=f),))
    for share in (0.5, 0.999):  # of what the damper can hold
        push = G * tangent * (1.0 + 2.0 * f * share)
        forces = sized(PIER, base, rb.Motion("push", 0.01, np.linspace(0.0, push, 200)))
        assert (forces.first_uplift, forces.pivot_right) == (None, pytest.approx(1.0, rel=1e-12))
        assert forces.normal_force == pytest.approx((1.0 + share * f) * G, rel=1e-12)
        assert forces.pivot_left == pytest.approx(2.0 * (1.0 + share * f), rel=1e-12)
        assert forces.friction_demand == pytest.approx(tangent * (1 + 2 * f * share) / (1 + f * share), rel=1e-12)
    response = rb.simulate(PIER, base, replace(shaken(), vertical=None), forces=True)
    lifts = response.events.loc[response.events["kind"] == "lift-off", "after"]
    assert len(lifts) >= 1
    expected = tangent * (1.0 + 2.0 * f) / (1.0 + f)
    assert response.forces["friction"].to_numpy()[lifts] == pytest.approx(expected, rel=1e-12)


def test_a_block_that_friction_holds_at_a_tilt_rests_on_its_corner():
    """A friction damper at 2f > 1 leaves it leaning, and props it: N is the weight less what the damper bears, by moments."""
    f = 0.8
    base = rb.RigidBase(restraints=(rb.Damper("friction", f=f),))
    response = rb.simulate(PIER, base, shaken(amplitude=2.0), forces=True)
    theta, row = response.theta[-1], response.forces.iloc[-1]
    assert abs(theta) > 0.01 * PIER.alpha
    tilt = abs(theta)
    prop = G * PIER.size * math.sin(PIER.alpha - tilt) / (2.0 * PIER.half_width * math.cos(0.5 * tilt))
    assert prop < f * G
    assert row["normal_force"] == pytest.approx(G - prop * math.cos(0.5 * tilt), rel=1e-9)
    assert row["base_shear"] == pytest.approx(-math.copysign(prop * math.sin(0.5 * tilt), theta), rel=1e-9)


@pytest.mark.parametrize(("alpha", "demand"), [(0.2, 0.150486602), (0.13, 0.097635785)])
def test_friction_demand_at_an_impact_is_a_matter_of_alpha_alone(alpha, demand):
    """¾ sin α cos α/(1 − ¾ sin²α) for μ = 3."""
    forces = sized(rb.Pier(alpha, 1.0), rb.RigidBase(), shaken(amplitude=0.5))
    assert forces.impact_friction_demand == pytest.approx(demand, abs=1e-9)
    response = rb.simulate(rb.Pier(alpha, 1.0), rb.RigidBase(), shaken(amplitude=0.5), forces=True)
    shares = response.impacts["impulse_horizontal"].abs() / response.impacts["impulse_vertical"]
    assert len(shares) > 3
    assert shares.to_numpy() == pytest.approx(demand, abs=1e-9)


@pytest.mark.parametrize("restraints", [(), (rb.Damper("friction", f=0.1),)], ids=["free", "damped"])
def test_a_pier_that_comes_to_rest_asks_no_more_friction_than_its_last_bounces(restraints):
    """A stop at once would ask cot α = 6.6, which is right of e = 0 only."""
    motion = rb.pulse("sine", name="sine", amplitude=6.0, period=0.5, dt=0.005, duration=20.0)
    pier, k = rb.Pier(0.15, 1.0), 0.75
    response = rb.simulate(pier, rb.RigidBase(restraints=restraints), motion, quiet_s=30.0, forces=True)
    assert "rest" in set(response.events["kind"])
    demand = k * math.sin(0.15) * math.cos(0.15) / (1 - k * math.sin(0.15) ** 2)
    assert response.row["impact_friction_demand"] == pytest.approx(demand, rel=1e-9)
    stops = rb.RigidBase(restraints=restraints, restitution=0.0)
    row = rb.simulate(pier, stops, motion, forces=True).row
    assert row["impact_friction_demand"] == pytest.approx(1.0 / math.tan(0.15), rel=1e-9)


@EVERY_BASE
def test_a_pier_at_rest_bears_its_weight_and_half_of_it_on_each_support(name):
    """And so of the prestress, which a tendon off the axis puts on the nearer support."""
    still = rb.Motion("still", 0.01, np.zeros(100))
    base = BASES[name]
    tendons = [each for each in base.restraints if isinstance(each, rb.Tendon)]
    more, aside = sum(each.psi for each in tendons), sum(each.psi * each.at for each in tendons) / PIER.half_width
    forces = sized(PIER, base, still)
    assert (forces.base_shear, forces.friction_demand) == (0.0, 0.0)
    assert forces.normal_force == pytest.approx((1.0 + more) * G, rel=1e-12)
    assert forces.pivot_left == pytest.approx(1.0 + more - aside, rel=1e-12)
    assert forces.pivot_right == pytest.approx(1.0 + more + aside, rel=1e-12)
    assert (forces.heel_gap_left, forces.deck_acceleration, forces.omega_over_p) == (0.0, 0.0, 0.0)
    assert forces.base_moment == pytest.approx(0.0, abs=1e-11)  # what presses it aside its tendon holds
    assert (forces.landing_velocity, forces.first_uplift) == (None, None)


def test_a_block_at_rest_that_is_shaken_below_uplift_leans_on_one_corner():
    """½ ± ü_g h/(2 b g) of the weight; at the onset of uplift one corner bears it all, and twice the half of it."""
    almost = 0.999 * G * math.tan(PIER.alpha)
    forces = sized(PIER, rb.RigidBase(), rb.Motion("push", 0.01, np.linspace(0.0, almost, 200)))
    assert forces.pivot_left == pytest.approx(1.999, rel=1e-12)
    assert (forces.pivot_right, forces.first_uplift) == (pytest.approx(1.0, rel=1e-12), None)
    assert forces.friction_demand == pytest.approx(0.999 * math.tan(PIER.alpha), rel=1e-12)
    assert forces.base_moment == pytest.approx(0.999 * G * PIER.half_width, rel=1e-12)  # at the onset M g b


# Newton's laws


def test_forces_on_finite_springs_are_those_of_the_motion_uncompiled(uncompiled):
    """N by differences of v, V by those of H θ̇ with H = h cos θ + b sin θ (c_R − c_L), but beside events and kinks of the law."""
    dt, base = 2e-3, replace(BASES["epp, finite"], beta=30.0)
    t = np.arange(450) * dt
    motion = rb.Motion("short", dt, 0.8 * G * np.sin(2 * np.pi * t / 0.6), 2.0 * np.sin(5 * t))
    response = uncompiled(rb.simulate, PIER, base, motion, substeps=1, quiet_s=0.0, wait=False, forces=True)
    forces, theta, events = response.forces, response.theta, response.events["t"].to_numpy()
    side = np.sign(forces["pivot_right"].to_numpy()) - np.sign(forces["pivot_left"].to_numpy())
    speed = (PIER.height * np.cos(theta) + PIER.half_width * np.sin(theta) * side) * response.omega
    rows = np.array([i for i in range(1, len(theta) - 1) if np.abs(events - response.t[i]).min() > 2.5 * dt])
    assert min(np.count_nonzero(side[rows]), np.count_nonzero(side[rows] == 0.0)) > 100
    second = (response.v[rows - 1] - 2.0 * response.v[rows] + response.v[rows + 1]) / dt**2
    normal = G + response.history["ag_v"].to_numpy()[rows] + second
    shear = response.history["ag_h"].to_numpy()[rows] + (speed[rows + 1] - speed[rows - 1]) / (2.0 * dt)
    for name, expected in (("normal_force", normal), ("base_shear", shear)):
        off = np.abs(forces[name].to_numpy()[rows] - expected)
        assert np.quantile(off, 0.98) < 2e-3 * np.abs(expected).max(), name


@EVERY_BASE
def test_normal_force_is_that_of_the_centre_of_mass_by_differences_of_its_height(name, responses):
    response = responses[name]
    rows = smooth_rows(response)
    rows = rows[(response.omega[rows] != 0.0) | (name != "rigid, tied")]
    expected = G + response.history["ag_v"].to_numpy()[rows] + second_difference(centre(response)[1], rows)
    expected += pulls(response)[0][rows]
    assert close(response.forces["normal_force"].to_numpy()[rows], expected)


@pytest.mark.sweep(fast=1)
@pytest.mark.parametrize("name", ["rigid", "elastic", "bouc-wen", "rigid, tied", "rigid, beyond", "bouc-wen, tied"])
def test_base_shear_is_that_of_the_centre_of_mass_by_differences_of_its_place(name, responses):
    response = responses[name]
    rows = smooth_rows(response)
    expected = response.history["ag_h"].to_numpy()[rows] + second_difference(centre(response)[0], rows)
    expected += pulls(response)[1][rows]
    assert close(response.forces["base_shear"].to_numpy()[rows], expected)


@pytest.mark.parametrize("name", ["epp, finite", "elastic, finite", FINITE_TIED])
def test_base_shear_of_finite_springs_is_that_of_the_horizontal_velocity(name, responses):
    """H θ̇ with H = h cos θ + b sin θ (c_R − c_L), by central differences; contact is where a support presses."""
    response = responses[name]
    theta, pressed = response.theta, [response.forces[f"pivot_{side}"].to_numpy() > 0.0 for side in ("right", "left")]
    side = pressed[0].astype(float) - pressed[1]
    rows = smooth_rows(response)
    rows = rows[(side[rows] == side[rows - 1]) & (side[rows] == side[rows + 1])]
    lever = PIER.height * np.cos(theta) + PIER.half_width * np.sin(theta) * side
    speed = lever * response.omega
    expected = response.history["ag_h"].to_numpy()[rows] + (speed[rows + 1] - speed[rows - 1]) / (2 * FINE)
    assert close(response.forces["base_shear"].to_numpy()[rows], expected)


@pytest.mark.parametrize("name", ["rigid", "elastic", "bouc-wen", "rigid, tied", "rigid, beyond", "bouc-wen, tied"])
def test_base_moment_is_that_of_the_motion_by_differences(name, responses):
    """About the middle of the base, of all that acts on the pier there: x (g + v̈_g + ÿ) − y (ü_g + ẍ) − (I0/M) θ̈.

    On springs in first-order kinematics the ground acts at H = h + b θ (c_R − c_L) (THEORY.md, eq. 6).
    """
    response = responses[name]
    rows = smooth_rows(response)
    (x, y), at = centre(response), response.history.iloc[rows]
    left, right = (response.forces[f"pivot_{side}"].to_numpy()[rows] > 0.0 for side in ("left", "right"))
    lever = above = y[rows]
    if not isinstance(response.base, rb.RigidBase):
        lever, above = PIER.height + PIER.half_width * response.theta[rows] * (1.0 * right - left), PIER.height
    expected = x[rows] * (G + at["ag_v"].to_numpy() + second_difference(y, rows))
    expected -= lever * at["ag_h"].to_numpy() + above * second_difference(x, rows)
    expected -= PIER.inertia * second_difference(response.theta, rows)
    assert close(response.forces["base_moment"].to_numpy()[rows], expected)


def ties_about_the_middle(response):
    """Moment of the pulls of dampers and tendons on the base, at their places [m²/s²]; not of friction that holds."""
    table, pier, lean = response.restraints, response.pier, 0.5 * response.theta
    total = np.zeros(len(response.t))
    if table is None:
        return total
    along = np.cos(lean) if isinstance(response.base, rb.RigidBase) else 1.0 / np.cos(lean)
    along = along if response.base.kinematics == "finite" else 1.0
    places = [s for each in response.base.restraints for s in offsets(pier, each)]
    for name, s in zip(table.columns[2::2], places, strict=True):
        total = total + table[name].to_numpy() * along * s
    return total


@EVERY_BASE
def test_base_moment_is_that_of_the_supports_and_ties_at_their_places(name, responses):
    """b (N_R − N_L) − Σ F s; of finite springs but for θ², by which places of a leaning base move."""
    response = responses[name]
    rows = smooth_rows(response)
    rows = rows[(response.omega[rows] != 0.0) | (name != "rigid, tied")]
    forces, half = response.forces.iloc[rows], 0.5 * G * PIER.half_width
    expected = half * (forces["pivot_right"] - forces["pivot_left"]).to_numpy() - ties_about_the_middle(response)[rows]
    finite_springs = response.base.on_springs and response.base.kinematics == "finite"
    allowed = 0.5 * np.abs(response.theta).max() ** 2 if finite_springs else 1e-3
    assert close(forces["base_moment"].to_numpy(), expected, allowed)


@pytest.mark.parametrize("name", ["rigid", "elastic"])
def test_the_deck_accelerates_as_a_point_at_its_height_does(name):
    pier = rb.Pier.with_deck(4.0, 30.0, 2000.0, 1000.0, deck_height_m=33.0, top_m=36.0)
    assert pier.deck == 33.0
    motion = shaken(FINE, amplitude=0.5)
    response = rb.simulate(pier, BASES[name], motion, substeps=1, forces=True)
    rows = smooth_rows(response)
    place = centre(response)[0] + (33.0 - pier.height) * (np.sin(response.theta) if name == "rigid" else response.theta)
    expected = response.history["ag_h"].to_numpy()[rows] + second_difference(place, rows)
    assert np.abs(expected).max() > 1.0
    assert close(response.forces["deck_acceleration"].to_numpy()[rows], expected)


def integral(response, values):
    """By the trapezoidal rule; both sides of an event are rows, at one time."""
    return float(np.trapezoid(values, response.t))


@EVERY_BASE
def test_forces_and_impulses_together_change_the_momentum(name, responses):
    """From rest: ∫(N/M − g − v̈_g) dt + Σ J = v̇; and ∫(V/M − ü_g) dt + Σ J = ẋ, but for finite springs, whose H jumps."""
    base, response = BASES[name], responses[name]
    history, forces, impacts = response.history, response.forces, response.impacts
    rigid = isinstance(base, rb.RigidBase)
    down, across = pulls(response)
    moves = (response.omega != 0.0) | (name != "rigid, tied")
    lifts = moves * (forces["normal_force"] - down - G - history["ag_v"])
    gained = integral(response, lifts) + impacts["impulse_vertical"].sum()
    up = velocity(response)[1][-1] if rigid else (response.v[-1] - response.v[-2]) / (response.t[-1] - response.t[-2])
    passed = impacts["impulse_vertical"].sum()
    assert passed > 0.5
    assert gained == pytest.approx(up, abs=2e-4 * passed)
    if rigid or base.kinematics == "first-order":
        gained = (
            integral(response, forces["base_shear"] - across - history["ag_h"]) + impacts["impulse_horizontal"].sum()
        )
        along = velocity(response)[0][-1] if rigid else PIER.height * response.omega[-1]
        assert gained == pytest.approx(along, abs=2e-4 * impacts["impulse_horizontal"].abs().sum())


@EVERY_BASE
def test_an_impulse_changes_the_spin_by_its_moment(name, responses):
    """(I0/M) Δθ̇ = ±a J_v − H J_h about the centre of mass: it acts at the pivot that lands and nowhere else."""
    base, response = BASES[name], responses[name]
    impacts = response.impacts
    events = response.events[response.events["t"].isin(impacts["t"])]
    events = events[events["kind"].isin(["impact", "rest"])]
    assert len(events) == len(impacts) > 3
    theta, omega = response.theta, response.omega
    for (_, impact), before, after in zip(impacts.iterrows(), events["before"], events["after"], strict=True):
        side = {"left": 1.0, "right": -1.0}[impact["pivot"]]
        arm, lever = side * PIER.half_width, PIER.height
        if not isinstance(base, rb.RigidBase) and base.kinematics == "finite":
            c, s = math.cos(theta[after]), math.sin(theta[after])
            arm, lever = arm * c + lever * s, lever * c
        moment = arm * impact["impulse_vertical"] - lever * impact["impulse_horizontal"]
        assert moment == pytest.approx(PIER.inertia * (omega[after] - omega[before]), abs=1e-9)


@pytest.mark.sweep(fast=2)
@EVERY_BASE
def test_gaps_are_the_pivots_above_where_they_left_their_supports(name, responses):
    base, response = BASES[name], responses[name]
    forces, t = response.forces, response.t
    for side in ("left", "right"):
        gap, speed = forces[f"heel_gap_{side}"].to_numpy(), forces[f"heel_speed_{side}"].to_numpy()
        if isinstance(base, rb.RigidBase):
            sign = 1.0 if side == "left" else -1.0
            expected = 2 * PIER.half_width * np.sin(np.clip(sign * response.theta, 0.0, None))
            np.testing.assert_allclose(gap, expected, rtol=0.0, atol=1e-12)
        else:
            own = response.events[response.events["pivot"].isin([side, "both"])]
            leaves = own[own["kind"] == "separation"]
            assert len(leaves) > 1
            for leave, back in pairwise([*leaves["after"], len(t)]):
                free = np.arange(leave, back)
                free = free[: np.argmax(forces[f"pivot_{side}"].to_numpy()[free] > 0.0) or len(free)]
                position = response.history[f"v_{side}"].to_numpy()
                np.testing.assert_allclose(gap[free], position[free] - position[leave], rtol=0.0, atol=1e-12)
        rows = smooth_rows(response)
        assert close(speed[rows], (gap[rows + 1] - gap[rows - 1]) / (2 * FINE))
        assert np.abs(gap).max() > 0.01


# Peaks


LEAST = 0.1 * G
"""N/M above which friction counts."""


def friction_while_pressed(table):
    """The greatest |V|/N of a history where N is above its limit, where it passes it in a line between two rows."""
    shear, normal, t = (table[name].to_numpy() for name in ("base_shear", "normal_force", "t"))
    above = normal > LEAST
    most = np.abs(shear[above] / normal[above]).max()
    last = np.flatnonzero((above[1:] != above[:-1]) & (np.diff(t) > 0.0))
    part = (LEAST - normal[last]) / (normal[last + 1] - normal[last])
    passing = np.abs(shear[last] + part * (shear[last + 1] - shear[last])) / LEAST
    return max(most, passing.max(initial=0.0))


def before_turnings(response):
    """Forces just before the pier turns, where friction jumps between two samples: in a line through those before."""
    omega, table = response.omega, response.forces.to_numpy()
    last = np.flatnonzero((omega[1:-1] * omega[2:] < 0.0) & (omega[:-2] * omega[1:-1] > 0.0)) + 1
    last = last[np.isin(last, smooth_rows(response))]
    ahead = omega[last] / (omega[last] - omega[last + 1])
    return pd.DataFrame(table[last] + ahead[:, None] * (table[last] - table[last - 1]), columns=response.forces.columns)


@EVERY_BASE
def test_peaks_are_those_of_a_history_that_is_many_times_finer(name, responses):
    """Those of an ordinary run, to 10⁻⁵ (ω_v h ≤ 0.1)."""
    base, response = BASES[name], responses[name]
    outcome = outcome_of(PIER, base, shaken())
    assert outcome.substeps <= 6
    found = asdict(forces_of(outcome))
    fine = response.forces.abs().max()
    if name == "rigid, tied":
        fine = np.fmax(fine, before_turnings(response).abs().max())
    names = {name: name for name in ("base_shear", "normal_force", "base_moment", "deck_acceleration")}
    names |= {name: name for name in fine.index if name.startswith(("pivot_", "heel_"))}
    for column, of_history in names.items():
        assert found[column] == pytest.approx(fine[of_history], rel=2e-5), column
    assert found["friction_demand"] == pytest.approx(friction_while_pressed(response.forces), rel=1e-4)
    assert found["error"] < CHANCE * 1e-4  # of which the change is below 10⁻⁴
    hardest = response.impacts.loc[response.impacts["landing_velocity"].idxmax()]
    assert found["landing_velocity"] == pytest.approx(hardest["landing_velocity"], rel=2e-5)
    assert found["impulse"] == pytest.approx(hardest["impulse_vertical"], rel=2e-5)
    assert found["omega_over_p"] == pytest.approx(np.abs(response.omega).max() / PIER.p, rel=2e-5)
    lifts = response.events[response.events["kind"].isin(["separation", "lift-off"])]
    assert found["first_uplift"] == pytest.approx(lifts["t"].iloc[0], abs=1e-6)


def test_flight_is_as_long_and_as_high_as_both_gaps_say(responses):
    response, forces = responses["elastic"], responses["elastic"].forces
    outcome = outcome_of(PIER, BASES["elastic"], shaken())
    flying = (forces["pivot_left"] <= 0.0) & (forces["pivot_right"] <= 0.0)
    assert outcome.flight_duration == pytest.approx(integral(response, flying.astype(float)), rel=0.02)
    lower = np.minimum(forces["heel_gap_left"], forces["heel_gap_right"])
    assert outcome.flight_height == pytest.approx(lower.max(), rel=1e-4)
    lands = np.flatnonzero(np.diff(np.concatenate([[0], flying.astype(int), [0]])))
    longest = max(response.t[min(end, len(flying) - 1)] - response.t[start] for start, end in lands.reshape(-1, 2))
    assert forces_of(outcome).flight_longest == pytest.approx(longest, abs=2 * FINE)
    shear = response.forces["base_shear"].abs()[response.forces["normal_force"] < LEAST].max()
    assert forces_of(outcome).key_shear == pytest.approx(shear, rel=5e-3)
    assert forces_of(outcome).key_shear >= shear * (1.0 - 1e-6)


HARD = {
    "little damping": rb.ElasticBase(40, zeta=1.2e-4),
    "dashpots that bear more than the springs": rb.YieldingBase(50, eta=2.5, zeta=0.5),
    "a hysteretic damper that yields at once": rb.ElasticBase(
        50, 0.1, restraints=(rb.Damper("hysteretic", f=0.3, yield_m=31e-6),)
    ),
    "a root of the speed": rb.ElasticBase(50, 0.1, restraints=(rb.Damper("viscous", nu=0.3, exponent=0.5),)),
}


@pytest.mark.slow
@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=pytest.mark.thorough) if name == "little damping" else name for name in HARD]
)
def test_peaks_are_those_of_another_solver_where_a_law_is_steep(name):
    """DOP853 from event to event; the error of a run bounds what it differs by, and no parabola adds to a peak."""
    t = np.arange(0.0, 1.505, 0.01)
    fades = np.sin(np.pi * t / 1.5) ** 2
    motion = rb.Motion("shaking", 0.01, 6.0 * np.sin(11.0 * t) * fades, 3.0 * np.sin(20.0 * t) * fades)
    response = rb.simulate(PIER, HARD[name], motion, forces=True)
    run, expected = greatest_forces(PIER, HARD[name], motion)
    cut = rb.simulate(
        PIER, HARD[name], motion, substeps=int(response.row["substeps"]), quiet_s=0.0, wait=False, forces=True
    )
    assert cut.row["impacts"] == run.impacts > 0
    columns = {each: f"{each}_m_s2" for each in ("base_shear", "normal_force", "deck_acceleration", "key_shear")}
    columns["base_moment"] = "base_moment_m2_s2"
    columns |= {f"pivot_{side}": f"pivot_force_{side}" for side in ("left", "right")}
    columns |= {f"heel_gap_{side}": f"heel_gap_{side}_m" for side in ("left", "right")}
    columns |= {f"heel_speed_{side}": f"heel_speed_{side}_m_s" for side in ("left", "right")}
    assert {"friction_demand", "base_shear", "base_moment"} <= set(expected)
    for each, value in expected.items():
        share = 2e-5 + response.row["forces_error"]
        assert cut.row.get(columns.get(each, each), 0.0) == pytest.approx(value, rel=share, abs=1e-9), each


def test_a_yielding_support_bears_no_more_than_it_can():
    forces = sized(PIER, rb.YieldingBase(50, eta=1.5, spring="epp", flight="guided"), shaken())
    assert max(forces.pivot_left, forces.pivot_right) == 1.5


@EVERY_BASE
@pytest.mark.parametrize("amplitude", [1.0, *(pytest.param(each, marks=pytest.mark.slow) for each in (0.6, 3.0))])
def test_the_reversed_motion_exchanges_left_and_right_and_keeps_the_rest(name, amplitude):
    base = BASES[name]
    motion = shaken(amplitude=amplitude)
    there = outcome_of(PIER, base, motion)
    other_side = tuple(replace(each, at=each.at and -each.at) for each in base.restraints)
    reversed_motion = replace(motion, horizontal=-motion.horizontal)
    back = outcome_of(PIER, replace(base, restraints=other_side), reversed_motion)
    mirrored, expected = asdict(forces_of(there.mirrored())), asdict(forces_of(back))
    for field, value in expected.items():
        assert mirrored[field] == (value if value is None else pytest.approx(value, rel=1e-8, abs=1e-12)), field
    assert there.mirrored().mirrored() == there


@EVERY_BASE
@pytest.mark.parametrize("numerics", [{}, {"tolerance": None, "substeps": 8}], ids=["tolerance", "substeps"])
def test_who_asks_for_forces_gets_the_same_run(name, numerics):
    base = BASES[name]
    for amplitude in (1.0, 3.0):
        motion = shaken(amplitude=amplitude)
        without = outcome_of(PIER, base, motion, forces=False, **numerics)
        assert without.observed == {}
        assert replace(outcome_of(PIER, base, motion, **numerics), observed={}) == without


def test_a_fixed_step_has_no_error_of_its_forces():
    assert forces_of(outcome_of(PIER, rb.RigidBase(), shaken(), tolerance=None, substeps=4)).error is None


def test_forces_that_halving_the_step_still_changes_have_an_error_and_a_note():
    fine = replace(forces_of(outcome_of(PIER, BASES["elastic"], shaken())), error=None)
    same, note = with_error(fine, fine, PIER, CHANCE)
    assert (same.error, note) == (CHANCE * changes.LEAST, "")
    coarse = replace(fine, base_shear=fine.base_shear * 0.996, heel_speed_right=fine.heel_speed_right * 1.03)
    found, note = with_error(fine, coarse, PIER, CHANCE)
    speed = max(fine.heel_speed_left, fine.heel_speed_right)
    assert found.error == pytest.approx(CHANCE * 0.03 * fine.heel_speed_right / speed, rel=1e-9)
    assert note.startswith("forces not settled: halving the step still changed the heel speed by ")


@pytest.mark.parametrize(("change", "noted"), [(0.0099, False), (0.0101, True)])
def test_a_change_of_forces_is_noted_from_1_percent_on(change, noted):
    fine = replace(forces_of(outcome_of(PIER, BASES["elastic"], shaken())), error=None)
    _, note = with_error(fine, replace(fine, base_shear=fine.base_shear * (1.0 - change)), PIER, CHANCE)
    assert note.endswith("base shear by 1.0%") == noted


@pytest.mark.parametrize("share", [0.05, 0.5])
def test_friction_counts_from_a_normal_force_that_the_study_chooses(share):
    """The less has to press, the more is asked, and |V| there is the demand times that share of the weight at most."""
    run = StudyRun(shaken(), "+", 1.0, Case("case", PIER, BASES["elastic"], {}))
    observers = observers_of(Output.with_keys(forces=True, least_normal_share=share))
    (outcome,) = outcomes_of([run], Numerics(), observers)
    usual = forces_of(outcome_of(PIER, BASES["elastic"], shaken()))
    less, more = (forces_of(outcome), usual) if share < 0.1 else (usual, forces_of(outcome))
    assert less.friction_demand > more.friction_demand
    assert less.key_shear <= more.key_shear
    assert forces_of(outcome).friction_demand * share * G <= forces_of(outcome).base_shear * (1 + 1e-9)


@pytest.mark.parametrize(("rotation", "side", "sign"), [(0.1, "left", 1.0), (-0.1, "right", -1.0)])
def test_a_pier_that_stays_down_has_landed_on_the_pivot_that_was_up(rotation, side, sign):
    """With e = 0 its first impact is its last; the ground stops H θ̇, h forward and 2 b up of the landing pivot."""
    still = rb.Motion.still(3.0)
    response = rb.simulate(
        rb.Pier(0.2, 1.0, initial_rotation_rad=rotation), rb.RigidBase(restitution=0.0), still, forces=True
    )
    (landing,) = response.impacts.to_dict("records")
    assert (landing["pivot"], landing["t"]) == (side, response.events.query("kind == 'rest'")["t"].item())
    rate = landing["landing_velocity"] / (2.0 * PIER.half_width)
    assert landing["impulse_horizontal"] == pytest.approx(sign * rate * PIER.height, rel=1e-9)
    assert landing["impulse_vertical"] == pytest.approx(rate * PIER.half_width, rel=1e-9)


def test_what_could_not_be_run_is_not_run_for_its_forces_either():
    outcome = outcome_of(PIER, rb.ElasticBase(beta=4000.0), shaken(), substeps=1)
    assert (outcome.status, outcome.was_run, forces_of(outcome)) == ("failed", False, None)
    assert "too few for the springs' frequency" in outcome.reason


# What the model does not follow


def test_an_overturning_pier_counts_until_it_leans_beyond_alpha_for_good():
    """Falling on, it would press ever less and shear ever more: without the cut the demand had no limit."""
    motion = rb.Motion("push", 0.01, np.full(300, 0.3 * G))
    outcome = outcome_of(PIER, rb.RigidBase(), motion)
    assert outcome.status == "overturned"
    forces = forces_of(outcome)
    assert forces.heel_gap_right == pytest.approx(2 * PIER.half_width * math.sin(PIER.alpha), rel=1e-6)
    assert forces.friction_demand < 0.5


@pytest.mark.parametrize("name", ["rigid", "elastic", "bouc-wen", pytest.param("epp, finite", marks=pytest.mark.slow)])
def test_demands_of_an_overturning_pier_are_those_of_far_smaller_steps(name):
    """Without the part of the step until α gaps and speeds were up to 1 % short."""
    motion = rb.Motion("push", 0.02, np.full(200, 0.3 * G))
    coarse, fine = (sized(PIER, BASES[name], motion, substeps=steps) for steps in (4, 256))
    for field in ("heel_gap_right", "heel_speed_right", "omega_over_p", "base_shear", "friction_demand"):
        assert getattr(coarse, field) == pytest.approx(getattr(fine, field), rel=2e-4), field


def test_a_run_says_where_it_would_slide():
    motion, friction = shaken(), 0.25
    least = sized(PIER, rb.RigidBase(), motion).friction_demand
    assert least > friction
    slid = outcome_of(PIER, rb.RigidBase(friction=friction), motion)
    note = slid.note
    response = rb.simulate(PIER, rb.RigidBase(), motion, forces=True)
    first = response.t[np.argmax(response.forces["friction"].to_numpy() > friction)]
    assert note.startswith("would slide at ")
    assert float(note.split()[3]) == pytest.approx(first, abs=0.011)
    assert f"the friction demand reaches {least:.3g}, the interface has 0.25; sliding is not followed" in note
    assert forces_of(slid).slides
    held = outcome_of(PIER, rb.RigidBase(friction=2 * least), motion)
    assert (forces_of(held).slides, held.note) == (False, "")
    hops = outcome_of(PIER, replace(BASES["elastic"], friction=5.0, confirm=("friction",)), motion)
    assert forces_of(hops).friction_demand < 5.0
    carried = f"keys have to carry a base shear of up to {forces_of(hops).key_shear / G:.3g} of the weight"
    assert hops.note == f"where the normal force is below 0.1 of the weight, friction holds little: {carried}"
    weighed = outcome_of(
        replace(PIER, mass_t=3000.0), replace(BASES["elastic"], friction=5.0, confirm=("friction",)), motion
    )
    assert weighed.note == f"{hops.note}, {3000.0 * forces_of(hops).key_shear:,.0f} kN"
    hard = outcome_of(
        PIER, rb.RigidBase(restitution=0.1, friction=2.0, confirm=("restitution",)), replace(motion, vertical=None)
    )
    assert forces_of(hard).friction_demand < 2.0 < forces_of(hard).impact_friction_demand
    assert forces_of(hard).slides
    assert "would slide at an impact" in hard.note


def test_a_rigid_base_does_not_pull():
    """The ground falls at 0.97 g under a block that rocks: the corner is lifted by the rotation, and the block flies."""
    t = np.arange(0, 2.001, 0.005)
    falls = -0.97 * G * np.clip((t - 1.0) / 0.05, 0, 1)
    motion = rb.Motion("drop", 0.005, 0.8 * G * np.sin(2 * np.pi * t), falls)
    outcome = outcome_of(PIER, rb.RigidBase(), motion)
    assert outcome.flights == 1
    assert outcome.t_flight > 1.0
    assert "the ground would have to hold the pier down" not in outcome.note
    response = rb.simulate(PIER, rb.RigidBase(), motion, forces=True)
    assert math.isinf(response.forces["friction"].max())
    assert forces_of(outcome).friction_demand < abs(forces_of(outcome).base_shear) / LEAST
    assert response.forces["normal_force"].min() > -1e-9 * G


def test_a_frame_has_the_shear_and_the_weight_of_its_columns_and_its_deck():
    """Columns turn about their pivots, the deck moves as their tops do, twice as far; all over M = N m_c + m_d."""
    column = rb.Pier.rectangle(2.0, 10.0, mass_t=100.0)
    frame = rb.Pier.frame(column, 4, 600.0)
    response = rb.simulate(frame, rb.RigidBase(), shaken(FINE, amplitude=0.6), substeps=1, forces=True)
    rows, theta = smooth_rows(response), response.theta
    leans = column.alpha - np.abs(theta)
    along = np.sign(theta) * column.size * (math.sin(column.alpha) - np.sin(leans))
    up = column.size * np.cos(leans)
    for name, place, given in (("base_shear", along, "ag_h"), ("normal_force", up, "ag_v")):
        moved = (400.0 * second_difference(place, rows) + 600.0 * second_difference(2 * place, rows)) / 1000.0
        expected = moved + response.history[given].to_numpy()[rows] + (G if name == "normal_force" else 0.0)
        assert close(response.forces[name].to_numpy()[rows], expected)
    deck = response.history["ag_h"].to_numpy()[rows] + second_difference(2 * along, rows)
    assert close(response.forces["deck_acceleration"].to_numpy()[rows], deck)
    gap = response.forces[["heel_gap_left", "heel_gap_right"]].max(axis=1).to_numpy()
    np.testing.assert_allclose(gap, 2 * column.half_width * np.sin(np.abs(theta)), rtol=0.0, atol=1e-12)
    bears = 0.5 * G * (response.forces["pivot_right"] - response.forces["pivot_left"]).to_numpy()
    np.testing.assert_allclose(response.forces["base_moment"], column.half_width * bears, rtol=0.0, atol=1e-9)
