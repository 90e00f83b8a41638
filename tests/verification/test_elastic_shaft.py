"""Piers whose shaft bends (THEORY.md, A shaft that bends): against mass points by DOP853, closed forms, limits, energy.

Their kernels are the largest; fast tests run them uncompiled.
"""

import math
from dataclasses import replace
from functools import partial
from pathlib import Path

import flexible_reference
import numpy as np
import pandas as pd
import pytest
from core_samples import values_of
from scipy.interpolate import CubicHermiteSpline
from scipy.optimize import minimize_scalar

import rockbatch as rb
from rockbatch.core.block.model import Stance
from rockbatch.core.flexure.model import Flexing
from rockbatch.core.types import (
    BEFORE_EVENT,
    IMPACT_BOTH,
    IMPACT_LEFT,
    IMPACT_RIGHT,
    LIFT_OFF,
    SAMPLE,
    TAKE_OFF,
    Ground,
    Instant,
    Moment,
    Pull,
)
from rockbatch.motions.motion import Motion
from rockbatch.observers.forces.peaks import at_rows
from rockbatch.pier import mode_of, shape_at
from rockbatch.simulation import Run, run_fixed, written_run
from rockbatch.simulation.models import flexible_block

G, DT = 9.81, 0.02
BENCHMARKS = Path(__file__).parents[2] / "benchmarks"


def pier_of(
    width: float, height: float, shaft: tuple[float, float], deck: tuple[float, float], period: float
) -> rb.Pier:
    """A shaft of a mass [t] and a half distance between its legs [m], and a deck of a mass and a radius, 5 % above it."""
    (mass, spread), (above, radius) = shaft, deck
    parts = [
        rb.Part(mass, 0.5 * height, mass * (height**2 / 12.0 + spread**2), height),
        rb.Part(above, 1.05 * height, above * radius**2, 0.0),
    ]
    return replace(rb.Pier.of_parts(width, parts), flexural_period_s=period)


def points_of(
    width: float,
    height: float,
    shaft: tuple[float, float],
    deck: tuple[float, float],
    period: float,
    base: rb.RigidBase,
) -> flexible_reference.Points:
    """The same pier as mass points."""
    (mass, spread), (above, radius) = shaft, deck
    return flexible_reference.points_of(
        [(mass, 0.0, height, spread), (above, 1.05 * height, 1.05 * height, radius)],
        1.05 * height,
        half_width=0.5 * width,
        frequency=2.0 * math.pi / period,
        damping_ratio=base.flexural_damping,
        gravity=G,
    )


def shaken(amplitude: float, period: float, upwards: float = 0.0, duration: float = 4.0) -> Motion:
    """A wave packet around 1.5 s, and one up and down."""
    t = np.arange(0.0, duration, DT)
    packet = np.exp(-(((t - 1.5) / 0.9) ** 2))
    return Motion(
        "shaken", DT, amplitude * np.sin(2 * math.pi * t / period) * packet,
        upwards * G * np.sin(2 * math.pi * t / 0.37) * packet,
    )  # fmt: skip


TOWER = (8.0, 40.0, (3000.0, 2.5), (1500.0, 2.0), 0.9)


def compared(
    numbers, base: rb.RigidBase, motion: Motion, until: float, write=written_run, **numerics
) -> tuple[np.ndarray, np.ndarray, np.recarray]:
    """Return θ and u by the mass points at samples, and the rows of the core there."""
    pier = pier_of(*numbers)
    reference = points_of(*numbers, base)
    expected, _ = flexible_reference.run(
        reference, np.column_stack([motion.horizontal, motion.vertical]), DT, until=until, **numerics
    )
    found, rows = write(Run(pier, base, motion), 16, 0.0, 60_000, wait=False)
    rows = rows[: found.rows].view(np.recarray)
    samples = rows[rows.kind == SAMPLE][: len(expected)]
    return expected[:, 2], expected[:, 3], samples


def test_a_pier_rocks_flies_and_lands_as_its_mass_points_do(uncompiled):
    """Both corners down, one, none: 10⁻⁸ of α in θ, through impacts and flights of more than a millisecond."""
    motion, base = shaken(5.0, 1.4, upwards=1.3, duration=2.7), rb.RigidBase(shaft="elastic", flexural_damping=0.02)
    theta, u, rows = compared(TOWER, base, motion, 2.6, partial(uncompiled, written_run), hop=1e-3)
    assert (rows.left + rows.right == 0.0).any()
    assert abs(theta).max() > 0.1 * pier_of(*TOWER).alpha
    np.testing.assert_allclose(rows.theta, theta, rtol=0.0, atol=1e-8 * pier_of(*TOWER).alpha)
    np.testing.assert_allclose(rows.u, u, rtol=0.0, atol=5e-7 * abs(u).max())


def test_the_energy_of_a_history_is_that_of_the_balance_of_every_step(uncompiled):
    motion, base = shaken(5.0, 1.4, upwards=2.5, duration=1.0), rb.RigidBase(shaft="elastic", flexural_damping=0.02)
    response = uncompiled(rb.simulate, pier_of(*TOWER), base, motion, substeps=4, quiet_s=0.0, wait=False, ledger=True)
    stored = response.ledger.kinetic + response.ledger.potential + response.ledger.elastic
    assert response.row.impacts > 0
    assert response.row.flight_s < 0.7
    np.testing.assert_allclose(response.energy, stored, rtol=0.0, atol=1e-15)


@pytest.mark.slow
@pytest.mark.parametrize("seed", [0, *(pytest.param(seed, marks=pytest.mark.thorough) for seed in range(1, 8))])
def test_random_piers_move_as_their_mass_points_do(seed):
    rng = np.random.default_rng([seed, 0])
    width = rng.uniform(4.0, 12.0)
    height, mass = width * rng.uniform(2.5, 5.0), 3000.0
    shaft, deck = (mass, 0.5 * width * rng.uniform(0.3, 0.6)), (mass * rng.uniform(0.1, 2.0), rng.uniform(1.0, 3.0))
    numbers = (width, height, shaft, deck, rng.uniform(0.3, 2.5))
    pier = pier_of(*numbers)
    base = rb.RigidBase(shaft="elastic", flexural_damping=float(rng.choice([0.0, 0.02, 0.05])))
    upwards = rng.uniform(0.0, 1.0)
    motion = shaken(rng.uniform(1.0, 3.0) * pier.alpha * G, rng.uniform(0.5, 2.0), upwards)
    theta, u, rows = compared(numbers, base, motion, 3.0)
    np.testing.assert_allclose(rows.theta, theta, rtol=0.0, atol=1e-5 * max(abs(theta).max(), 1e-2 * pier.alpha))
    np.testing.assert_allclose(rows.u, u, rtol=0.0, atol=1e-5 * abs(u).max())


def test_modes_have_the_integrals_of_a_beam_under_a_force_at_its_top():
    rectangle = mode_of(rb.Pier.rectangle(2.0, 30.0))
    np.testing.assert_allclose(rectangle, (3 / 8, 33 / 140, 11 / 40 * 30.0), rtol=1e-14)
    legs = rb.Part.shaft(3.0, 20.0, 1e-6)
    lumped = mode_of(rb.Pier.of_parts(6.0, [legs, rb.Part(1000.0, 20.0, 500.0, 0.0)], top_m=20.0))
    np.testing.assert_allclose(lumped, (1.0, 1.0, 20.0), rtol=1e-8)
    raised = rb.Pier.of_parts(6.0, [legs, rb.Part(1000.0, 22.0, 500.0, 0.0)], top_m=20.0)
    np.testing.assert_allclose(
        mode_of(raised), (1.0, 1.0, 22.0), rtol=1e-8
    )  # the top is the mass, whatever drift is read at
    assert shape_at(raised, 22.0) == 1.0
    assert shape_at(raised, 24.2) == pytest.approx(1.15, rel=1e-14)  # straight above it: 1 + 1.5 · 2.2/22
    whole, lower = rb.Part.shaft(2.0, 30.0, 1000.0), rb.Part.shaft(2.0, 12.0, 400.0)
    upper = rb.Part(600.0, 21.0, 600.0 * (2.0**2 + 18.0**2) / 12, 18.0)
    cut, uncut = (mode_of(rb.Pier.of_parts(6.0, parts, top_m=24.0)) for parts in ([lower, upper], [whole]))
    np.testing.assert_allclose(cut, uncut, rtol=1e-13)


def test_a_standing_pier_is_an_oscillator_that_lifts_off_at_its_weights_moment(uncompiled):
    """A sudden constant a deflects an undamped mode by 2 a Γ/ω²; it lifts off above a = g b/(h + λΓ + 2 g μ1 Γ/ω²)."""
    pier, base = pier_of(*TOWER), rb.RigidBase(shaft="elastic", flexural_damping=0.0)
    mode, frequency = mode_of(pier), 2.0 * math.pi / 0.9
    gamma = mode.first / mode.second
    lever = pier.height + mode.coupling * gamma + 2.0 * pier.gravity * mode.first * gamma / frequency**2
    least = pier.gravity * pier.half_width / lever
    for share, lifts in ((0.999, False), (1.001, True)):
        motion = Motion("step", 0.005, np.full(200, share * least))
        outcome = uncompiled(run_fixed, pier, base, motion, 4, quiet_s=0.0, wait=False)
        assert (outcome.separations > 0) == lifts
        if not lifts:
            assert outcome.deflection_max == pytest.approx(2.0 * share * least * gamma / frequency**2, rel=1e-8)
            assert outcome.top_drift_max == outcome.deflection_max  # the base stands, and the drift is read at the deck


@pytest.mark.slow
def test_while_it_rocks_the_mode_vibrates_faster():
    """ω/√(1 − λ²/(μ2 J)) about its own weight, for deflections small beside b."""
    pier = replace(pier_of(*TOWER[:4], 0.2), initial_rotation_rad=0.02)
    base = rb.RigidBase(shaft="elastic", flexural_damping=0.0)
    mode = mode_of(pier)
    faster = 2.0 * math.pi / 0.2 / math.sqrt(1.0 - mode.coupling**2 / (mode.second * pier.inertia_about_pivot))
    found, rows = written_run(Run(pier, base, Motion("still", 1e-4, np.zeros(4000))), 1, 0.0, 9000, wait=False)
    rows = rows[: found.rows].view(np.recarray)
    rows = rows[rows.theta > 0.01]
    turns = np.flatnonzero((rows.u_rate[:-1] > 0.0) & (rows.u_rate[1:] <= 0.0))
    period = (rows.t[turns[-1]] - rows.t[turns[0]]) / (len(turns) - 1)
    assert len(turns) > 5
    assert period == pytest.approx(2.0 * math.pi / faster, rel=2e-3)


@pytest.mark.slow
@pytest.mark.parametrize("heavy_top", [False, True])
def test_keeping_the_momentum_tends_to_a_restitution_in_closed_form(heavy_top):
    """Housner's where J − λ²/μ2 > 2b², as if it were rigid; else both feet stop and the mode starts anew: λ²/(μ2 J)."""
    shaft, deck = ((500.0, 0.8), (9000.0, 1.0)) if heavy_top else ((3000.0, 2.5), (1500.0, 2.0))
    pier, motion = pier_of(8.0, 40.0, shaft, deck, 0.1), shaken(3.0, 1.1)
    mode, inertia = mode_of(pier), pier.inertia_about_pivot
    share = mode.coupling**2 / mode.second
    assert (inertia - share > 2.0 * pier.half_width**2) != heavy_top
    restitution = share / inertia if heavy_top else pier.restitution
    rigid = rb.simulate(pier, rb.RigidBase(restitution=restitution), motion)
    base = rb.RigidBase(shaft="elastic", flexural_damping=0.3)
    t = np.linspace(0.0, 3.0, 300)
    far = [
        abs(np.interp(t, run.t, run.theta) - np.interp(t, rigid.t, rigid.theta)).max()
        for run in (rb.simulate(replace(pier, flexural_period_s=period), base, motion) for period in (0.1, 0.05))
    ]
    assert far[0] / far[1] == pytest.approx(4.0, rel=0.1)


@pytest.mark.thorough
def test_the_energy_balance_closes_by_order_four():
    """With a damper and a tendon, through flights; no blow creates energy."""
    pier = pier_of(*TOWER)
    devices = (
        rb.Damper.viscous(pier, coefficient_kN_s_m=1500.0, at="left"),
        rb.Tendon.of(pier, prestress_kN=5000.0, stiffness_kN_m=20000.0),
    )
    base = rb.RigidBase(restraints=devices, shaft="elastic", flexural_damping=0.03)
    motion = shaken(5.0, 1.4, upwards=1.2)
    found = [rb.simulate(pier, base, motion, ledger=True, substeps=steps) for steps in (8, 16)]
    left = [abs(run.ledger.remainder).max() for run in found]
    assert left[1] < 1e-6 * found[1].ledger.input.max()
    assert left[0] / left[1] > 10.0
    assert np.diff(found[1].ledger.impact).min() > -1e-12
    assert len(found[1].events) > 10


@pytest.fixture(scope="module")
def tower(uncompiled):
    """A run of the tower, and its rows."""
    run = Run(pier_of(*TOWER), rb.RigidBase(shaft="elastic", flexural_damping=0.02), shaken(5.0, 1.4, upwards=0.5))
    found, rows = uncompiled(written_run, run, 4, 0.0, 60_000, wait=False)
    return run, rows[: found.rows].view(np.recarray), found


def test_forces_are_those_of_the_mass_points(tower, uncompiled):
    """V, N and the moment about the middle of the base from the points' accelerations, at every row but those of events."""
    run, rows, _ = tower
    motion, of = run.motion, points_of(*TOWER, run.base)
    forces = uncompiled(at_rows, run, rows)
    checked = {"both": 0, "one": 0}
    for row, force in zip(rows, forces, strict=True):
        sample = round(row.t / DT)
        if row.kind != SAMPLE or sample >= len(motion.horizontal) or not (row.left or row.right):
            continue
        phase = "both" if row.left and row.right else "one"
        side = float(row.right - row.left)
        ground = (motion.horizontal[sample], motion.vertical[sample])
        q, rates = (0.0, row.theta, row.u), (0.0, row.omega, row.u_rate)
        free = [2] if phase == "both" else [1, 2]
        accelerations, normal = flexible_reference.motion_of(of, side, free, q, rates, ground)
        along, up = flexible_reference.accelerations_of(of, side, q, rates, accelerations)
        x, z = flexible_reference.places_over_ground(of, side, q)
        m = of.mass / of.mass.sum()
        assert force.normal == pytest.approx(normal, rel=1e-5)
        assert force.shear == pytest.approx(np.sum(m * (along + ground[0])), abs=1e-4)
        moment = np.sum(m * (x * (up + G + ground[1]) - z * (along + ground[0])))
        assert force.moment == pytest.approx(moment, abs=2e-3)
        checked[phase] += 1
    assert min(checked.values()) > 20


@pytest.mark.slow
def test_a_pier_overturns_below_its_slenderness_as_its_shaft_leans_out():
    """Held at rest beyond the rotation at which it stands on one corner it falls, below it returns."""
    numbers = (*TOWER[:4], 2.5)
    base = rb.RigidBase(shaft="elastic", flexural_damping=0.05)
    tipping = flexible_reference.tipping(points_of(*numbers, base))
    pier, still = pier_of(*numbers), Motion("still", 0.02, np.zeros(50))
    assert tipping < 0.99 * pier.alpha
    assert flexible_block(pier, base).tipping == pytest.approx(tipping, rel=1e-5)
    for share, status in ((0.999, "ok"), (1.001, "overturned")):
        released = replace(pier, initial_rotation_rad=share * tipping)
        assert rb.simulate(released, base, still).status == status


def test_the_mirror_image_of_a_motion_gives_the_mirror_image_of_the_run(tower, uncompiled):
    run, rows, _ = tower
    back = replace(run, motion=run.motion.times(1.0, reverse=True))
    found, mirrored = uncompiled(written_run, back, 4, 0.0, 60_000, wait=False)
    mirrored = mirrored[: found.rows].view(np.recarray)
    np.testing.assert_array_equal(rows.theta, -mirrored.theta)
    np.testing.assert_array_equal(rows.u, -mirrored.u)
    np.testing.assert_array_equal(rows.v, mirrored.v)


@pytest.mark.slow
def test_a_run_reports_deflection_and_drift_with_errors_that_hold():
    pier, base, motion = pier_of(*TOWER), rb.RigidBase(shaft="elastic"), shaken(5.0, 1.4)
    run, fine = rb.simulate(pier, base, motion), run_fixed(pier, base, motion, 64)
    assert run.row.theta_max_over_alpha > 0.05
    for column, value in (("deflection_max", fine.deflection_max), ("top_drift", fine.top_drift_max)):
        error = run.row[f"{column.removesuffix('_max')}_error_m"]
        assert 0.0 < error < 1e-4
        assert abs(run.row[f"{column}_m"] - value) <= error
    assert run.row.top_drift_m > pier.top * run.row.theta_max_over_alpha * pier.alpha
    assert 0.98 * run.row.deflection_max_m < abs(run.history.deflection).max() <= run.row.deflection_max_m


def test_rows_stand_on_both_sides_of_a_lift_off_from_vibration(tower):
    _, rows, _ = tower
    lifted = np.flatnonzero(rows.kind == LIFT_OFF)
    assert len(lifted) > 0
    assert (rows.kind[lifted - 1] == BEFORE_EVENT).all()
    assert (rows.t[lifted] == rows.t[lifted - 1]).all()


OPENSEES = pd.read_csv(BENCHMARKS / "opensees_shaft.csv", index_col="case")


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "shaft", "top", "period"),
    [("tower", 3000.0, 1500.0, 0.9), ("stiff tower", 3000.0, 1500.0, 0.4), ("heavy top", 500.0, 4000.0, 1.2)],
)
def test_a_column_of_finite_elements_rotates_as_far_before_and_behind_an_impact(name, shaft, top, period):
    """benchmarks/opensees_shaft.py, with all modes: 0.5 % until the first impact, 2, 4 and 1 % in the half cycle behind it."""
    parts = [rb.Part(shaft, 20.0, shaft * 40.0**2 / 12.0, 40.0), rb.Part(top, 40.0, 1e-3 * top, 0.0)]
    pier = replace(rb.Pier.of_parts(8.0, parts, top_m=40.0), flexural_period_s=period)
    t = np.arange(0.0, 8.5, 0.005)
    motion, others = Motion("sine", 0.005, 4.0 * np.sin(math.pi * t) * (t < 2.0)), OPENSEES.loc[name]
    run = rb.simulate(pier, rb.RigidBase(shaft="elastic", flexural_damping=0.0), motion, substeps=4, wait=False)
    second = int(run.theta.argmax())
    assert -run.theta[:second].min() == pytest.approx(others.first_rad, rel=0.005)
    assert run.theta[second] == pytest.approx(others.second_rad, rel=0.05)


@pytest.mark.slow
@pytest.mark.parametrize("damping", [0.0, 0.05])
def test_a_pier_that_only_vibrates_is_not_waited_for(damping):
    """Its run ends with the quiet time; one that may still lift off goes on."""
    base, pier = rb.RigidBase(shaft="elastic", flexural_damping=damping), pier_of(*TOWER)
    run = rb.simulate(pier, base, shaken(0.2, 0.9))
    assert run.row.theta_max_over_alpha == 0.0 < run.row.deflection_max_m
    assert run.row.note == ""
    assert run.t[-1] == pytest.approx(shaken(0.2, 0.9).duration + 2.0, abs=2 * DT)


# Equations, blows and ending, at single states

BOTH, STILL = Stance(1.0, 1.0, 0.0, 0.0), Ground(0.0, 0.0, 0.0, 0.0)


def stance(side: float, key: float) -> Stance:
    """On the pivot on ``side``, or in flight with the key of the pivot that bore last."""
    return Stance(float(side < 0.0), float(side > 0.0), key, key)


def state_at(m, key, q, rates) -> Flexing:
    """The core's state where the corner at ``key`` is at a height, with the rotation and deflection ``q``, and their rates."""
    (rise, theta, u), (speed, omega, u_rate) = q, rates
    b, s, c = key * m.half_width, math.sin(theta), math.cos(theta)
    v, slope = rise + b * s - m.height * (1.0 - c), b * c - m.height * s
    return Flexing(v, theta, speed + slope * omega, omega, u, u_rate)


def random_states(seed: int, count: int = 12):
    """Key, whether on the ground, q, its rates and the ground's accelerations: half of them in flight."""
    rng = np.random.default_rng(seed)
    for number in range(count):
        key, on_ground = float(rng.choice([-1.0, 1.0])), number % 2 == 0
        q, rates = (rng.uniform(-1.0, 1.0, 3) * (0.5, 0.3, 1.0) for _ in range(2))
        if on_ground:
            q[0] = rates[0] = 0.0
        yield key, on_ground, q, 3.0 * rates, rng.uniform(-4.0, 4.0, 2)


def velocities(of, key, q, rates):
    _, _, _, across, up = flexible_reference._places(of, key, q)
    return rates @ across, rates @ up


def test_rates_power_and_energy_are_those_of_the_mass_points(uncompiled):
    base = rb.RigidBase(shaft="elastic", flexural_damping=0.04)
    m, of = flexible_block(pier_of(*TOWER), base), points_of(*TOWER, base)
    share = of.mass / of.mass.sum()
    calls, expected = [], []
    for key, on_ground, q, rates, shaking in random_states(1):
        y, contact, ground = (
            state_at(m, key, q, rates),
            stance(key * on_ground, key),
            Ground(shaking[0], 0.0, shaking[1], 0.0),
        )
        q_change, normal = flexible_reference.motion_of(of, key, [1, 2] if on_ground else [0, 1, 2], q, rates, shaking)
        b, s, c = key * m.half_width, math.sin(y.theta), math.cos(y.theta)
        v_change = q_change[0] + (b * c - m.height * s) * q_change[1] - (m.height * c + b * s) * y.omega**2
        k = Flexing(y.v_rate, y.omega, v_change, q_change[1], y.u_rate, q_change[2])
        along, up = velocities(of, key, q, rates)
        _, z = flexible_reference.places_over_ground(of, key, q)
        kinetic, potential = 0.5 * share @ (along**2 + up**2), G * share @ (q[0] + z - of.z)
        resting = Flexing(0.0, 0.0, 0.0, 0.0, y.u, y.u_rate)
        spring = of.frequency**2 * y.u + 2.0 * of.damping_ratio * of.frequency * y.u_rate
        gamma = share @ of.shape / (share @ of.shape**2)
        calls += [
            ("system", "rates", m, y, contact, ground),
            ("block.equations", "normal_force", m, y, k, shaking[1]),
            ("system", "ground_power", m, y, contact, ground),
            ("flexure.equations", "velocity_of_centre", m, y, contact),
            ("flexure.ending", "kinetic_and_potential", m, y, contact),
            ("flexure.lanes", "_drift", m, y),
            ("system", "end_step", m, y._replace(v=9.0, v_rate=9.0), y, contact, 0.0),
            ("system", "rates", m, resting, BOTH, ground),
            ("flexure.ending", "kinetic_and_potential", m, resting, BOTH),
        ]
        top = m.top * s + y.u * c
        expected += [
            k, normal, -shaking @ (share @ along, share @ up), (share @ along, share @ up), (kinetic, potential),
            (top, (m.top * c - y.u * s) * y.omega + y.u_rate * c),
            y if on_ground else y._replace(v=9.0, v_rate=9.0),
            (0.0, 0.0, 0.0, 0.0, y.u_rate, -spring - shaking[0] * gamma),
            (0.5 * share @ of.shape**2 * y.u_rate**2, 0.0),
        ]  # fmt: skip
        assert on_ground or abs(normal) < 1e-9
    for call, found, wanted in zip(calls, uncompiled(values_of, calls), expected, strict=True):
        assert found == pytest.approx(wanted, rel=1e-9, abs=1e-11), call


@pytest.mark.parametrize("damping", [0.0, 0.05])
def test_steps_in_flight_resolve_the_mode(damping, uncompiled):
    """A tenth of a radian of the vibration that the mass points have in the air."""
    base = rb.RigidBase(shaft="elastic", flexural_damping=damping)
    m, of, shift = flexible_block(pier_of(*TOWER), base), points_of(*TOWER, base), 1e-4
    bent, straight = (
        flexible_reference.motion_of(of, 1.0, [0, 1, 2], np.array([0.5, 0.0, u]), np.zeros(3), (0.0, 0.0))[0][2]
        for u in (shift, 0.0)
    )
    y = state_at(m, 1.0, (0.5, 0.0, shift), (0.0, 0.0, 0.0))
    start = Instant(y, y, Stance(0.0, 0.0, 1.0, 1.0), None, STILL)
    (longest,) = uncompiled(values_of, [("flexure.events", "longest_step", m, start, 1.0)])
    assert longest * math.sqrt((straight - bent) / shift) == pytest.approx(0.1, rel=1e-6)


def test_devices_pull_a_pier_that_bends_as_their_work_along_its_motion_says(uncompiled):
    """What a force F and a moment M add is J⁻¹ of the points times their work −F δv − M δθ."""
    base, pull = rb.RigidBase(shaft="elastic"), Pull(3.0, -40.0)
    m, of = flexible_block(pier_of(*TOWER), base), points_of(*TOWER, base)
    calls, expected = [], []
    for key, on_ground, q, rates, _ in random_states(5):
        y, contact, free = state_at(m, key, q, rates), stance(key * on_ground, key), [1, 2] if on_ground else [0, 1, 2]
        _, s, c, across, up = flexible_reference._places(of, key, q)
        slope = key * m.half_width * c - m.height * s
        mass, work = of.mass / of.mass.sum(), np.array([-pull.force, -pull.force * slope - pull.moment, 0.0])
        added = np.zeros(3)
        matrix = (across[free] * mass) @ across[free].T + (up[free] * mass) @ up[free].T
        added[free] = np.linalg.solve(matrix, work[free])
        calls += [("system", "rates", each, y, contact, STILL) for each in (m, m._replace(pull=pull))]
        expected.append((added[0] + slope * added[1], added[1], added[2]))
    found = np.array(uncompiled(values_of, calls))
    loads = [("block.equations", "normal_force", each, y, y, 0.3) for each in (m, m._replace(pull=pull))]
    assert np.diff(uncompiled(values_of, loads)) == pytest.approx(pull.force, rel=1e-9)
    assert (found[1::2] - found[::2])[:, [2, 3, 5]] == pytest.approx(np.array(expected), rel=1e-7, abs=1e-10)


def test_the_rate_at_which_a_pier_comes_to_lift_off_is_that_of_the_mass_points(uncompiled):
    """The acceleration to either side that standing points would begin to turn with, a moment before and after."""
    base = rb.RigidBase(shaft="elastic", flexural_damping=0.04)
    m, of, short = flexible_block(pier_of(*TOWER), base), points_of(*TOWER, base), 1e-4
    calls, expected = [], []
    for key, _, (_, _, u), (*_, u_rate), shaking in random_states(4):
        ground = Ground(shaking[0], 3.0 * shaking[1], shaking[1], 2.0 * shaking[0])
        forward = flexible_reference.motion_of(of, key, [2], (0.0, 0.0, u), (0.0, 0.0, u_rate), shaking)[0][2]
        near = [
            key * flexible_reference.motion_of(
                of, key, [1, 2], (0.0, 0.0, u + t * u_rate + 0.5 * t * t * forward), (0.0, 0.0, u_rate + t * forward),
                (ground.horizontal + t * ground.horizontal_slope, ground.vertical + t * ground.vertical_slope),
            )[0][1]
            for t in (-short, 0.0, short)
        ]  # fmt: skip
        y, k = Flexing(0.0, 0.0, 0.0, 0.0, u, u_rate), Flexing(0.0, 0.0, 0.0, 0.0, u_rate, forward)
        calls += [
            ("block.events", "lift_rate", m, None, Instant(y, k, BOTH, None, ground), key),
            ("block.events", "lifting", m, None, y, key, ground),
        ]
        expected += [(near[2] - near[0]) / (2.0 * short), near[1]]
    found = uncompiled(values_of, calls)
    assert found[1::2] == pytest.approx(expected[1::2], rel=1e-9)
    assert found[::2] == pytest.approx(expected[::2], rel=1e-5, abs=1e-5)


def test_the_greatest_displacements_are_those_of_cubics_between_the_rows(tower):
    """The top of the tower, its deck, is 42 m above its base, and the mode 1 there; rows are four steps apart."""
    run, rows, found = tower
    sine, cosine = np.sin(rows.theta), np.cos(rows.theta)
    ways = {
        "deflection_max": (rows.u, rows.u_rate),
        "drift_max": (
            42.0 * sine + rows.u * cosine,
            (42.0 * cosine - rows.u * sine) * rows.omega + rows.u_rate * cosine,
        ),
    }
    for name, (way, rate) in ways.items():
        greatest = max(
            abs(
                CubicHermiteSpline(rows.t[i : i + 2], way[i : i + 2], rate[i : i + 2])(np.linspace(*rows.t[i : i + 2]))
            ).max()
            for i in np.flatnonzero(np.diff(rows.t) > 1e-9)
        )
        assert getattr(found, name) == pytest.approx(greatest, rel=5e-3)
    flying, b = rows.left + rows.right == 0.0, run.pier.half_width
    s, drop = np.sin(rows.theta), run.pier.height * (1.0 - np.cos(rows.theta))
    lower = rows.v + drop - b * abs(s)
    assert flying.any() == (found.flights > 0)
    assert found.flight_height == pytest.approx(lower[flying].max(initial=0.0), rel=0.02, abs=1e-12)


def test_states_behind_events_are_those_of_the_mass_points(uncompiled):
    """Impacts at θ = 0, landings from flight on one corner and on both, take-off and lift-off: state, stance, kind and counts."""
    base = rb.RigidBase(shaft="elastic")
    m, of = flexible_block(pier_of(*TOWER), base), points_of(*TOWER, base)
    calls, expected = [], []
    impacts = {-1.0: IMPACT_LEFT, 1.0: IMPACT_RIGHT}

    def event(y, contact, pivot, *wanted):
        calls.append(("system", "transition", m, None, Moment(y, contact, None), int(pivot > 0.0), STILL, 0.01))
        expected.append(wanted)

    def landed(side, q, rates):
        return state_at(m, side, (0.0, *q[1:]), (0.0, *rates))

    for key, on_ground, q, rates, _ in random_states(2, 40):
        y, before = state_at(m, key, q, rates), stance(key * on_ground, key)
        if on_ground:
            event(y, before, key, y, stance(0.0, key), TAKE_OFF, 0.0, 0.0)
            q[1], rates[1] = 0.0, -key * abs(rates[1])
            y = state_at(m, key, q, rates)
            behind = flexible_reference._blow(of, key, -key, q, rates)
            if -key * behind[0] > 0.0:
                event(y, before, -key, landed(-key, q, behind), stance(-key, -key), impacts[-key], 1.0, 0.0)
            else:
                kept = flexible_reference.kept_as_both_stop(of)
                flat = Flexing(0.0, 0.0, 0.0, 0.0, y.u, y.u_rate + kept * y.omega)
                event(y, before, -key, flat, BOTH, IMPACT_BOTH, 1.0, 0.0)
            resting = Flexing(0.0, 0.0, 0.0, 0.0, 0.01 * y.u, 0.01 * y.u_rate)
            event(resting, BOTH, -key, resting, stance(key, key), LIFT_OFF, 0.0, 1.0)
        else:
            q[1] = math.copysign(min(abs(q[1]), 0.9 * m.alpha), q[1])
            for pivot in (-key, key):
                q[0] = (pivot - key) * m.half_width * math.sin(q[1])
                behind = flexible_reference._blow(of, key, pivot, q, rates)
                wanted = landed(pivot, q, behind), stance(pivot, pivot), impacts[pivot]
                event(state_at(m, key, q, rates), before, pivot, *wanted, 1.0, 0.0)
            topples = (0.0, math.copysign(1.1 * m.alpha, q[1]), q[2])  # and lands beyond α, which is no impact to count
            behind = flexible_reference._blow(of, key, key, topples, rates)
            event(
                state_at(m, key, topples, rates),
                before,
                key,
                landed(key, topples, behind),
                stance(key, key),
                impacts[key],
                0.0,
                0.0,
            )
            q, rates = np.array((0.0, 0.0, q[2])), np.array((-0.3, 0.01, rates[2]))
            y, kept = state_at(m, key, q, rates), flexible_reference.kept_as_both_stop(of)
            flat = Flexing(0.0, 0.0, 0.0, 0.0, y.u, y.u_rate + 0.01 * kept)
            event(y, before, key, flat, BOTH, IMPACT_BOTH, 2.0, 0.0)
    for call, found, (y, contact, *rest) in zip(calls, uncompiled(values_of, calls), expected, strict=True):
        assert found.now.y == pytest.approx(y, rel=1e-9, abs=1e-10), call
        assert (found.now.contact, *found[1:]) == (contact, *rest, 0.0), call
        assert found.now.supports is None
    assert {rest[1] for _, *rest in expected} == {TAKE_OFF, LIFT_OFF, IMPACT_BOTH, *impacts.values()}


def test_a_run_is_over_where_energy_or_moment_no_longer_suffice(uncompiled):
    """By a thousandth: to turn as far as a rotation at which the points have their least energy, or to lift a foot."""
    base = rb.RigidBase(shaft="elastic", flexural_damping=0.04)
    m, of = flexible_block(pier_of(*TOWER), base), points_of(*TOWER, base)
    share, stiffness = of.mass / of.mass.sum(), 0.5 * of.frequency**2 * (of.mass @ of.shape**2) / of.mass.sum()
    calls, expected = [], []

    def level(key, theta, u):
        return (
            G * share @ (flexible_reference.places_over_ground(of, key, (0.0, theta, u))[1] - of.z) + stiffness * u**2
        )

    rng = np.random.default_rng(3)
    for side in (-1.0, 1.0):
        for limit in rng.uniform(0.1, 0.7, 4) * m.tipping:
            least = minimize_scalar(lambda u, side=side, limit=limit: level(side, side * limit, u), tol=1e-12).fun
            theta, u, u_rate = side * rng.uniform(0.0, 0.3) * limit, rng.choice([-0.08, 0.08]), 0.01
            for factor in (0.999, 1.001):

                def excess(omega, theta=theta, u=u, u_rate=u_rate, wanted=factor * least, side=side):
                    along, up = velocities(of, side, (0.0, theta, u), (0.0, omega, u_rate))
                    return 0.5 * share @ (along**2 + up**2) + level(side, theta, u) - wanted

                # a parabola in ω through three of its points
                omega = np.roots(
                    np.polyfit([-1.0, 0.0, 1.0], [excess(each) for each in (-1.0, 0.0, 1.0)], 2)
                ).real.max()
                now = Moment(state_at(m, side, (0.0, theta, u), (0.0, omega, u_rate)), stance(side, side), None)
                calls.append(("flexure.ending", "_cannot_reach", m, None, now, limit))
                expected.append(factor < 1.0)
    far = 1.3 * m.tipping
    leans = minimize_scalar(lambda u: level(1.0, far, u), tol=1e-12).x
    assert level(1.0, far, leans) < level(1.0, m.tipping, leans)
    beyond = Moment(state_at(m, 1.0, (0.0, far, leans), (0.0, 0.0, 0.0)), stance(1.0, 1.0), None)
    calls.append(("flexure.ending", "_cannot_reach", m, None, beyond, m.tipping))
    expected.append(False)
    phases = np.linspace(0.0, 2.0 * math.pi, 20001)
    spring = of.frequency**2 * (np.cos(phases) + 2.0 * of.damping_ratio * np.sin(phases))
    moment = share @ (of.shape * of.z) * spring.max() + G * share @ of.shape
    for factor in (0.999, 1.001):
        for phase in (0.0, 0.5, 0.5 * math.pi, 2.0, 4.0):
            size = factor * G * m.half_width / moment
            y = Flexing(0.0, 0.0, 0.0, 0.0, size * math.cos(phase), size * of.frequency * math.sin(phase))
            for contact in (BOTH, stance(1.0, 1.0), stance(-1.0, -1.0)):
                calls.append(("flexure.ending", "_stands_for_good", m, None, Moment(y, contact, None)))
                expected.append(factor < 1.0 and contact == BOTH)
    for call, found, wanted in zip(calls, uncompiled(values_of, calls), expected, strict=True):
        assert found == wanted, call
