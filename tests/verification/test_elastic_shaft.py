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
from bending_piers import DT, TOWER, G, pier_of, points_of, shaken
from core_samples import sections_at, values_of
from scipy.integrate import trapezoid
from scipy.interpolate import CubicHermiteSpline
from scipy.linalg import eigh

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
from rockbatch.pier import modes_of
from rockbatch.pier.bending import flexural_period
from rockbatch.simulation import Run, run_fixed, written_run
from rockbatch.simulation.base_forces import at_rows
from rockbatch.simulation.coarser import of_model
from rockbatch.simulation.histories import of_modes
from rockbatch.simulation.models import flexible_block

BENCHMARKS = Path(__file__).parents[2] / "benchmarks"


def compared(
    numbers, base: rb.RigidBase, motion: Motion, until: float, write=written_run, substeps=16, **numerics
) -> tuple[np.ndarray, np.ndarray, np.recarray]:
    """Return θ and the coordinates of the modes by the mass points at samples, and the rows of the core there."""
    pier = pier_of(*numbers)
    reference = points_of(*numbers, base)
    expected, _ = flexible_reference.run(
        reference, np.column_stack([motion.horizontal, motion.vertical]), DT, until=until, **numerics
    )
    found, rows = write(Run(pier, base, motion), substeps, 0.0, 400_000, wait=False)
    rows = rows[: found.rows].view(np.recarray)
    samples = rows[rows.kind == SAMPLE][: len(expected)]
    return expected[:, 2], expected[:, 3:], samples


@pytest.mark.slow
def test_a_pier_rocks_flies_and_lands_as_its_mass_points_do(uncompiled):
    """Both corners down, one, none: 10⁻⁸ of α in θ, through impacts and flights of more than a millisecond."""
    base = rb.RigidBase(shaft="elastic", flexural_damping=0.02, flexural_modes=2)
    motion = shaken(5.0, 1.4, upwards=1.3, duration=2.7)
    theta, u, rows = compared(TOWER, base, motion, 2.6, partial(uncompiled, written_run), 32, hop=1e-3)
    assert (rows.left + rows.right == 0.0).any()
    assert abs(theta).max() > 0.1 * pier_of(*TOWER).alpha
    np.testing.assert_allclose(rows.theta, theta, rtol=0.0, atol=1e-8 * pier_of(*TOWER).alpha)
    np.testing.assert_allclose(of_modes(rows)[0].T, np.pad(u, ((0, 0), (0, 2))), rtol=0.0, atol=5e-7 * abs(u).max())


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
    base = rb.RigidBase(
        shaft="elastic",
        flexural_damping=float(rng.choice([0.0, 0.02, 0.05])),
        flexural_damping_kind="stiffness" if seed % 2 else "modal",
        flexural_modes=4 - seed % 4,
    )
    upwards = rng.uniform(0.0, 1.0)
    motion = shaken(rng.uniform(1.0, 3.0) * pier.alpha * G, rng.uniform(0.5, 2.0), upwards)
    theta, u, rows = compared(numbers, base, motion, 3.0, substeps=192)
    np.testing.assert_allclose(rows.theta, theta, rtol=0.0, atol=1e-5 * max(abs(theta).max(), 1e-2 * pier.alpha))
    np.testing.assert_allclose(of_modes(rows)[0].T[:, : u.shape[1]], u, rtol=0.0, atol=1e-5 * abs(u).max())


def beams(
    heights: np.ndarray, lumps: dict[float, float], mass_per_length: np.ndarray, rigidity: np.ndarray | float = 1.0
) -> tuple[np.ndarray, np.ndarray]:
    """Return stiffness and mass of a cantilever of cubic beam elements between ``heights``, of w and w' at each."""
    n = len(heights)
    stiffness, mass = np.zeros((2 * n, 2 * n)), np.zeros((2 * n, 2 * n))
    rigid = np.broadcast_to(rigidity, mass_per_length.shape)
    for i, (length, of_length, bends) in enumerate(zip(np.diff(heights), mass_per_length, rigid, strict=True)):
        a, at = length, slice(2 * i, 2 * i + 4)
        stiffness[at, at] += bends * np.array(
            [[12, 6 * a, -12, 6 * a], [6 * a, 4 * a * a, -6 * a, 2 * a * a], [-12, -6 * a, 12, -6 * a],
             [6 * a, 2 * a * a, -6 * a, 4 * a * a]]
        ) / a**3  # fmt: skip
        mass[at, at] += of_length * a / 420 * np.array(
            [[156, 22 * a, 54, -13 * a], [22 * a, 4 * a * a, 13 * a, -3 * a * a], [54, 13 * a, 156, -22 * a],
             [-13 * a, -3 * a * a, -22 * a, 4 * a * a]]
        )  # fmt: skip
    for height, lump in lumps.items():
        k = 2 * int(np.argmin(abs(heights - height)))
        mass[k, k] += lump
    return stiffness[2:, 2:], mass[2:, 2:]


@pytest.mark.parametrize("deck", [0.0, 300.0, 4000.0])
def test_modes_are_those_of_a_cantilever_of_beam_elements(deck):
    """Frequencies, μ, λ and shapes of a shaft of 40 m under a deck at 42 m by eighty elements to 42 m: to 10⁻⁴ of the first."""
    heights = np.concatenate((np.linspace(0.0, 40.0, 77), np.linspace(40.0, 42.0, 5)[1:]))
    per_length = np.where(heights[1:] <= 40.0, 3000.0 / 40.0, 0.0)
    stiffness, mass = beams(heights, {42.0: deck} if deck else {}, per_length)
    softness, vectors = eigh(mass, stiffness)
    values, vectors = 1.0 / softness[:-5:-1], vectors[:, :-5:-1]
    vectors /= np.sqrt(np.einsum("ik,ij,jk->k", vectors, mass, vectors))
    parts = [rb.Part.shaft(5.0, 40.0, 3000.0), *([rb.Part(deck, 42.0, 0.0, 0.0)] if deck else [])]
    pier = replace(rb.Pier.of_parts(8.0, parts), flexural_period_s=0.9)
    modes, total = modes_of(pier), 3000.0 + deck
    np.testing.assert_allclose(modes.frequency / modes.frequency[0], np.sqrt(values / values[0]), rtol=1e-4)
    assert modes.frequency[0] == pytest.approx(2.0 * math.pi / 0.9, rel=1e-14)
    shapes = vectors[::2].T * math.sqrt(total)
    shapes *= np.sign(shapes[:, -1 if deck else 75])[:, None]
    np.testing.assert_allclose(modes.along(heights[1:]), shapes, rtol=0.0, atol=5e-4 * abs(shapes).max())
    # a moving base carries every mass along, and a turning one in proportion to its height
    ones, levels = np.zeros(len(mass)), np.zeros(len(mass))
    ones[::2], levels[::2], levels[1::2] = 1.0, heights[1:], 1.0
    moved = vectors.T @ mass
    for found, ridden in ((modes.share, ones), (modes.coupling, levels)):
        signs = np.sign(moved @ ridden) * np.sign(found)
        np.testing.assert_allclose(
            found, signs * (moved @ ridden) / math.sqrt(total), rtol=0.0, atol=2e-4 * abs(found).max()
        )


def test_rigidities_of_parts_give_the_modes_of_beam_elements_in_seconds():
    """A lower part of thrice the rigidity, a hollow upper one, and a deck on its end, by eighty elements."""
    heights = np.linspace(0.0, 40.0, 81)
    thrice = np.where(heights[1:] <= 16.0, 3.0, 1.0)
    stiffness, mass = beams(heights, {40.0: 900.0}, np.where(heights[1:] <= 16.0, 90.0, 50.0), 2.0e7 * thrice)
    softness, _ = eigh(mass, stiffness)
    lower = rb.Part.rectangle(90.0 * 16.0, 8.0, 16.0, 6.0, flexural_rigidity_kNm2=6.0e7)
    upper = rb.Part.rectangle(50.0 * 24.0, 28.0, 24.0, 4.0, flexural_rigidity_kNm2=2.0e7)
    pier = rb.Pier.of_parts(8.0, [lower, upper, rb.Part(900.0, 40.0, 0.0, 0.0)])
    np.testing.assert_allclose(modes_of(pier).frequency, 1.0 / np.sqrt(softness[:-5:-1]), rtol=2e-4)
    assert flexural_period(pier) == pytest.approx(2.0 * math.pi * math.sqrt(softness[-1]), rel=1e-5)


def test_a_mass_on_a_shaft_that_gives_by_shear_has_the_period_of_both_springs():
    """k⁻¹ = h³/(3 E I) + h/(G A_s); legs beside each other add up."""
    legs = [
        rb.Part.rectangle(1e-6, 10.0, 20.0, 1.0, flexural_rigidity_kNm2=5e6, shear_rigidity_kN=4e5) for _ in range(2)
    ]
    pier = rb.Pier.of_parts(6.0, [*legs, rb.Part(1000.0, 20.0, 500.0, 0.0)])
    gives = 20.0**3 / (3.0 * 1e7) + 20.0 / 8e5
    assert flexural_period(pier) == pytest.approx(2.0 * math.pi * math.sqrt(1000.0 * gives), rel=1e-6)


def test_all_modes_leave_the_inertia_of_sections_and_their_offset_to_a_blow():
    """J − Σ λ² tends to b² + (2b)²/12 of a rectangle: below 2 b² from two modes on, so that both feet stop."""
    pier = replace(rb.Pier.rectangle(8.0, 40.0), flexural_period_s=0.9)
    left = [pier.inertia_about_pivot - (modes_of(pier, n).coupling ** 2).sum() for n in (1, 2, 30)]
    assert left[0] > 2.0 * pier.half_width**2 > left[1]
    assert left[2] == pytest.approx(4.0 / 3.0 * pier.half_width**2, rel=1e-4)


def test_a_mass_on_a_light_shaft_has_a_mode_that_carries_all_of_it():
    legs = rb.Part.shaft(3.0, 20.0, 1e-6)
    lumped = modes_of(rb.Pier.of_parts(6.0, [legs, rb.Part(1000.0, 22.0, 500.0, 0.0)], top_m=20.0), 1)
    assert (lumped.share[0], lumped.coupling[0]) == pytest.approx((1.0, 22.0), rel=1e-8)
    assert lumped.at(22.0) == pytest.approx([1.0], rel=1e-8)
    assert lumped.at(24.2) == pytest.approx([1.15], rel=1e-8)  # straight above it: 1 + 1.5 · 2.2/22
    single = rb.Pier.of_parts(6.0, [rb.Part(1000.0, 22.0, 500.0, 0.0)])
    assert len(modes_of(single).frequency) == 1
    whole, lower = rb.Part.shaft(2.0, 30.0, 1000.0), rb.Part.shaft(2.0, 12.0, 400.0)
    upper = rb.Part(600.0, 21.0, 600.0 * (2.0**2 + 18.0**2) / 12, 18.0)
    cut, uncut = (modes_of(rb.Pier.of_parts(6.0, parts, top_m=24.0)) for parts in ([lower, upper], [whole]))
    np.testing.assert_allclose(cut.coupling, uncut.coupling, rtol=1e-4)


def test_a_standing_pier_is_an_oscillator_that_lifts_off_at_its_weights_moment(uncompiled):
    """A sudden constant a deflects an undamped mode by 2 a μ/ω²; it lifts off above a = g b/(h + λμ + 2 g μ²/ω²)."""
    pier, base = pier_of(*TOWER), rb.RigidBase(shaft="elastic", flexural_damping=0.0, flexural_modes=1)
    modes, frequency = base.modes(pier), 2.0 * math.pi / 0.9
    (share,), (coupling,), (end,) = modes.share, modes.coupling, modes.at(pier.highest)
    lever = pier.height + coupling * share + 2.0 * pier.gravity * share**2 / frequency**2
    least = pier.gravity * pier.half_width / lever
    for part, lifts in ((0.999, False), (1.001, True)):
        motion = Motion("step", 0.005, np.full(200, part * least))
        outcome = uncompiled(run_fixed, pier, base, motion, 4, quiet_s=0.0, wait=False)
        assert (outcome.separations > 0) == lifts
        if not lifts:
            assert outcome.deflection_max == pytest.approx(2.0 * part * least * share * end / frequency**2, rel=1e-8)
            assert outcome.top_drift_max == outcome.deflection_max  # the base stands, and the drift is read at the deck


def test_a_mass_on_a_light_shaft_vibrates_at_its_frequency_over_sin_alpha_uplifted(uncompiled):
    """ω √(1 + h²/b²): on one corner J − λ² = b² is left of h² + b². So stiff that its weight changes this by 10⁻⁴."""
    for half, height in ((2.0, 20.0), (6.0, 15.0)):
        pier = replace(rb.Pier.of_parts(2.0 * half, [rb.Part(1000.0, height, 1e-3, 0.0)]), flexural_period_s=0.02)
        m, still = flexible_block(pier, rb.RigidBase(shaft="elastic", flexural_damping=0.0)), Ground(0.0, 0.0, 0.0, 0.0)
        aside = 1e-4
        calls = []
        for side in (-1.0, 1.0):
            states = [state_at(m, side, np.array([0.0, 0.0, u, 0.0, 0.0, 0.0]), np.zeros(6)) for u in (-aside, aside)]
            calls += [("system", "rates", m, y, stance(side, side), still) for y in states]
        back = [bends_of(found)[1][0] for found in uncompiled(values_of, calls)]
        alone = (2.0 * math.pi / 0.02) ** 2
        for near, far in (back[:2], back[2:]):
            assert (near - far) / (2.0 * aside) == pytest.approx(
                alone / math.sin(math.atan2(half, height)) ** 2, rel=1e-3
            )


@pytest.mark.slow
def test_while_it_rocks_the_mode_vibrates_faster():
    """ω/√(1 − λ²/J) about its own weight, for deflections small beside b."""
    pier = replace(pier_of(*TOWER[:4], 0.2), initial_rotation_rad=0.02)
    base = rb.RigidBase(shaft="elastic", flexural_damping=0.0, flexural_modes=1)
    faster = 2.0 * math.pi / 0.2 / math.sqrt(1.0 - base.modes(pier).coupling[0] ** 2 / pier.inertia_about_pivot)
    found, rows = written_run(Run(pier, base, Motion("still", 1e-4, np.zeros(4000))), 1, 0.0, 9000, wait=False)
    rows = rows[: found.rows].view(np.recarray)
    rows = rows[rows.theta > 0.01]
    turns = np.flatnonzero((rows.u_1_rate[:-1] > 0.0) & (rows.u_1_rate[1:] <= 0.0))
    period = (rows.t[turns[-1]] - rows.t[turns[0]]) / (len(turns) - 1)
    assert len(turns) > 5
    assert period == pytest.approx(2.0 * math.pi / faster, rel=2e-3)


@pytest.mark.slow
@pytest.mark.parametrize("heavy_top", [False, True])
def test_keeping_the_momentum_tends_to_a_restitution_in_closed_form(heavy_top):
    """Housner's where J − Σλ² > 2b², as if it were rigid; else both feet stop and the modes start anew: Σλ²/J."""
    shaft, deck = ((500.0, 0.8), (9000.0, 1.0)) if heavy_top else ((3000.0, 2.5), (1500.0, 2.0))
    pier, motion = pier_of(8.0, 40.0, shaft, deck, 0.1), shaken(3.0, 1.1)
    inertia, base = pier.inertia_about_pivot, rb.RigidBase(shaft="elastic", flexural_damping=0.3, flexural_modes=1)
    share = float((base.modes(pier).coupling ** 2).sum())
    assert (inertia - share > 2.0 * pier.half_width**2) != heavy_top
    restitution = share / inertia if heavy_top else pier.restitution
    rigid = rb.simulate(pier, rb.RigidBase(restitution=restitution), motion)
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
    found = [rb.simulate(pier, base, motion, ledger=True, substeps=steps) for steps in (16, 128)]
    left = [abs(run.ledger.remainder).max() for run in found]
    assert left[1] < 1e-9 * found[1].ledger.input.max()
    assert left[0] / left[1] > 10.0**3  # by three halvings
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
        (u,), (u_rate,) = (np.moveaxis(each, 1, 0) for each in of_modes(np.array([row], rows.dtype).view(np.recarray)))
        q, rates = np.array((0.0, row.theta, *u)), np.array((0.0, row.omega, *u_rate))
        free = of.bends if phase == "both" else [1, *of.bends]
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


def test_forces_in_sections_are_those_of_the_mass_points_above(tower, uncompiled):
    """V, N and the moment about the deflected section, by d'Alembert at samples between the foot and the deck."""
    run, rows, _ = tower
    motion, heights = run.motion, (0.0, 12.0, 29.0, 41.0)
    of = points_of(*TOWER, run.base, cuts=(0.0, 12.0, 29.0, 40.0))
    samples = np.flatnonzero((rows.kind == SAMPLE) & (rows.left != rows.right))[::5]
    samples = samples[rows.t[samples] / DT < len(motion.horizontal) - 1]
    assert len(samples) > 10
    found = uncompiled(sections_at, run, rows, samples, heights)
    largest = [max(abs(np.array(forces)).max() for forces in per_height) for per_height in zip(*found, strict=True)]
    for i, row in enumerate(rows[samples]):
        sample, side = round(row.t / DT), float(row.right - row.left)
        u, u_rate = (each[:, 0] for each in of_modes(rows[samples][i : i + 1].view(np.recarray)))
        q, rates = np.array((0.0, row.theta, *u)), np.array((0.0, row.omega, *u_rate))
        ground = (motion.horizontal[sample], motion.vertical[sample])
        accelerations, _ = flexible_reference.motion_of(of, side, [1, *of.bends], q, rates, ground)
        along, up = flexible_reference.accelerations_of(of, side, q, rates, accelerations)
        x, z = flexible_reference.places_over_ground(of, side, q)
        push_x, push_z = along + ground[0], up + G + ground[1]
        s, c = math.sin(row.theta), math.cos(row.theta)
        for k, height in enumerate(heights):
            m = of.mass * (of.z > height) / of.mass.sum()
            here = run.base.modes(run.pier).at(height) @ u
            from_foot = np.array((here, height)), np.array([[c, s], [-s, c]])
            at = np.array((side * run.pier.half_width * (1.0 - c), side * run.pier.half_width * s))
            at_x, at_z = at + from_foot[1] @ from_foot[0]
            shear, axial = m @ (push_x * c - push_z * s), m @ (push_x * s + push_z * c)
            moment = m @ ((x - at_x) * push_z - (z - at_z) * push_x)
            wanted = shear, moment, axial
            assert found[i][k] == pytest.approx(wanted, rel=2e-3, abs=1e-3 * largest[k]), (row.t, height)


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
    np.testing.assert_array_equal(of_modes(rows), -np.array(of_modes(mirrored)))
    np.testing.assert_array_equal(rows.v, mirrored.v)


@pytest.mark.slow
def test_a_run_reports_deflection_and_drift_with_errors_that_hold():
    pier, base, motion = pier_of(*TOWER), rb.RigidBase(shaft="elastic"), shaken(5.0, 1.4)
    run, fine = rb.simulate(pier, base, motion), run_fixed(pier, base, motion, 64)
    fewer = run_fixed(pier, replace(base, flexural_modes=3), motion, 64)
    assert run.row.theta_max_over_alpha > 0.05
    for column, field in (("deflection_max", "deflection_max"), ("top_drift", "top_drift_max")):
        value = getattr(fine, field)
        error = run.row[f"{column.removesuffix('_max')}_error_m"]
        by_modes = 4.0 * abs(value - getattr(fewer, field))  # of four modes, the change by the last of them
        assert 0.9 * by_modes < error < by_modes + 1e-5
        assert abs(run.row[f"{column}_m"] - value) <= error
    assert run.row.top_drift_m > pier.top * run.row.theta_max_over_alpha * pier.alpha
    assert 0.98 * run.row.deflection_max_m < abs(run.history.deflection).max() <= run.row.deflection_max_m


@pytest.mark.slow
def test_errors_of_forces_have_four_times_what_the_last_mode_changes():
    pier, motion = pier_of(*TOWER), shaken(5.0, 1.4, duration=2.5)
    one, two = (
        rb.simulate(pier, rb.RigidBase(shaft="elastic", flexural_modes=n), motion, forces=True, sections=3)
        for n in (1, 2)
    )
    for column in ("base_shear_m_s2", "base_moment_m2_s2", "deck_acceleration_m_s2"):
        assert 4.0 * abs(two.row[column] / one.row[column] - 1.0) > 0.0
        assert two.row.forces_error >= 4.0 * abs(1.0 - one.row[column] / two.row[column])
    shear = "section_shear_m_s2"
    changed = abs(1.0 - one.sections[shear] / two.sections[shear])
    assert (two.sections.sections_error >= 4.0 * changed).all()
    assert one.row.forces_error < 1e-3 < two.row.forces_error  # of a single mode it is that of its steps


def test_the_damping_force_of_a_last_mode_beyond_a_tenth_of_critical_bounds_nothing():
    """2 % of the first mode are far more of the fourth in proportion to stiffness; a tenth in every mode is not beyond."""
    pier, still = pier_of(*TOWER), shaken(0.0, 1.0)
    for kind, damping, known in (
        ("modal", 0.02, True),
        ("modal", 0.1, True),
        ("modal", 0.11, False),
        ("stiffness", 0.02, False),
    ):
        base = rb.RigidBase(shaft="elastic", flexural_damping=damping, flexural_damping_kind=kind)
        found = of_model(Run(pier, base, still), 0.03, 4.0)
        assert found == 0.12 if known else math.isnan(found)


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
    """benchmarks/opensees_shaft.py, with all modes: 0.4 % until the first impact, 2 % in the half cycle behind it.

    Its period is that without weight, which softens the column by what its ends approach each other: g ∫ m(z) φ′² dz per mode.
    """
    parts = [rb.Part(shaft, 20.0, shaft * 40.0**2 / 12.0, 40.0), rb.Part(top, 40.0, 1e-3 * top, 0.0)]
    pier = replace(rb.Pier.of_parts(8.0, parts, top_m=40.0), flexural_period_s=period)
    z, (mode,) = np.linspace(0.0, 40.0, 4001), modes_of(pier, 1).along(np.linspace(0.0, 40.0, 4001))
    above = (top + shaft * (1.0 - z / 40.0)) / (top + shaft)
    softened = G * trapezoid(above * np.gradient(mode, z) ** 2, z) * (period / (2.0 * math.pi)) ** 2
    pier = replace(pier, flexural_period_s=period / math.sqrt(1.0 - softened))
    t = np.arange(0.0, 8.5, 0.005)
    motion, others = Motion("sine", 0.005, 4.0 * np.sin(math.pi * t) * (t < 2.0)), OPENSEES.loc[name]
    run = rb.simulate(pier, rb.RigidBase(shaft="elastic", flexural_damping=0.0), motion, substeps=4, wait=False)
    second = int(run.theta.argmax())
    assert -run.theta[:second].min() == pytest.approx(others.first_rad, rel=0.004)
    assert run.theta[second] == pytest.approx(others.second_rad, rel=0.02)


FORCES = pd.read_csv(BENCHMARKS / "opensees_shaft_forces.csv", index_col="case")


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "shaft", "top", "period", "shear", "moment"),
    [
        ("tower", 3000.0, 1500.0, 0.9, 0.07, 0.015),
        ("stiff tower", 3000.0, 1500.0, 0.4, 0.11, 0.20),
        ("even", 2000.0, 2000.0, 0.7, 0.05, 0.04),
        ("light deck", 3000.0, 300.0, 0.9, 0.05, 0.01),
    ],
)
def test_a_column_of_finite_elements_has_the_forces_of_three_modes(name, shaft, top, period, shear, moment):
    """benchmarks/opensees_shaft.py --forces: base shear of 3 to 7 times the rigid shaft's, and the moment at mid-height.

    Under the heavy top the damping force of the third mode, which OpenSees leaves out, is half of the shear.
    """
    parts = [rb.Part(shaft, 20.0, shaft * 40.0**2 / 12.0, 40.0), rb.Part(top, 40.0, 1e-3 * top, 0.0)]
    pier = replace(rb.Pier.of_parts(8.0, parts, top_m=40.0), flexural_period_s=period)
    t, others = np.arange(0.0, 8.5, 0.005), FORCES.loc[name]
    motion = Motion("sine", 0.005, 4.0 * np.sin(math.pi * t) * (t < 2.0))
    base = rb.RigidBase(shaft="elastic", flexural_damping=0.01, flexural_damping_kind="stiffness", flexural_modes=3)
    run = rb.simulate(pier, base, motion, forces=True, sections=3)
    assert run.row.base_shear_kN == pytest.approx(others.base_shear_kN, rel=shear)
    assert run.sections.section_moment_kNm.iloc[1] == pytest.approx(others.moment_kNm, rel=moment)


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
    (rise, theta, *u), (speed, omega, *u_rate) = q, rates
    b, s, c = key * m.half_width, math.sin(theta), math.cos(theta)
    v, slope = rise + b * s - m.height * (1.0 - c), b * c - m.height * s
    return bent(v, theta, speed + slope * omega, omega, u, u_rate)


def bent(v, theta, v_rate, omega, u, u_rate) -> Flexing:
    """A state, or its rates."""
    return Flexing(*map(float, (v, theta, v_rate, omega, *u, *u_rate)))


def bends_of(y: Flexing) -> tuple[np.ndarray, np.ndarray]:
    """The coordinates of the modes in a state, and their rates."""
    return np.array(y[4:8]), np.array(y[8:])


def random_states(seed: int, count: int = 12):
    """Key, whether on the ground, q, its rates and the ground's accelerations: half of them in flight."""
    rng = np.random.default_rng(seed)
    for number in range(count):
        key, on_ground = float(rng.choice([-1.0, 1.0])), number % 2 == 0
        q, rates = (rng.uniform(-1.0, 1.0, 6) * (0.5, 0.3, 1.0, 0.05, 0.01, 0.003) for _ in range(2))
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
        q_change, normal = flexible_reference.motion_of(
            of, key, [1, *of.bends] if on_ground else [0, 1, *of.bends], q, rates, shaking
        )
        b, s, c = key * m.half_width, math.sin(y.theta), math.cos(y.theta)
        v_change = q_change[0] + (b * c - m.height * s) * q_change[1] - (m.height * c + b * s) * y.omega**2
        u, u_rate = bends_of(y)
        k = bent(y.v_rate, y.omega, v_change, q_change[1], u_rate, q_change[2:])
        along, up = velocities(of, key, q, rates)
        _, z = flexible_reference.places_over_ground(of, key, q)
        kinetic, potential = 0.5 * share @ (along**2 + up**2), G * share @ (q[0] + z - of.z)
        resting = bent(0.0, 0.0, 0.0, 0.0, u, u_rate)
        spring = of.frequency**2 * u + 2.0 * of.damping_ratio * of.frequency * u_rate
        gamma = of.shape @ of.mass / of.modal_mass
        over = base.modes(pier_of(*TOWER)).at(42.0)
        calls += [
            ("system", "rates", m, y, contact, ground),
            ("block.equations", "normal_force", m, y, k, shaking[1]),
            ("system", "ground_power", m, y, contact, ground),
            ("flexure.equations", "velocity_of_centre", m, y, contact),
            ("flexure.ending", "kinetic_and_potential", m, y, contact),
            ("flexure.displacements", "_drift", m, y),
            ("system", "end_step", m, y._replace(v=9.0, v_rate=9.0), y, contact, 0.0),
            ("system", "rates", m, resting, BOTH, ground),
            ("flexure.ending", "kinetic_and_potential", m, resting, BOTH),
        ]
        top = m.top * s + over @ u * c
        expected += [
            k, normal, -shaking @ (share @ along, share @ up), (share @ along, share @ up), (kinetic, potential),
            (top, (m.top * c - over @ u * s) * y.omega + over @ u_rate * c),
            y if on_ground else y._replace(v=9.0, v_rate=9.0),
            (0.0, 0.0, 0.0, 0.0, *u_rate, *(-spring - shaking[0] * gamma)),
            (0.5 * share @ (u_rate @ of.shape) ** 2, 0.0),
        ]  # fmt: skip
        assert on_ground or abs(normal) < 1e-9
    for call, found, wanted in zip(calls, uncompiled(values_of, calls), expected, strict=True):
        assert found == pytest.approx(wanted, rel=1e-9, abs=1e-11), call


@pytest.mark.parametrize("damping", [0.0, 0.05])
def test_steps_in_flight_resolve_the_mode(damping, uncompiled):
    """A tenth of a radian of the fastest vibration that the mass points have in the air."""
    base = rb.RigidBase(shaft="elastic", flexural_damping=damping)
    m, of, n = flexible_block(pier_of(*TOWER), base), points_of(*TOWER, base), 6
    columns = []
    for number in range(1, n):  # the height of a corner acts on nothing
        for of_rate in (False, True):
            shift = np.zeros((2, n))
            shift[int(of_rate), number] = 1e-6
            columns.append(
                [
                    flexible_reference.motion_of(of, 1.0, list(range(n)), *(way * shift), (0.0, 0.0))[0]
                    for way in (1.0, -1.0)
                ]
            )
    slopes = np.array([(up - down)[1:] / 2e-6 for up, down in columns])  # of θ and θ̇, u_1 and so on, in turns
    system = np.block([[np.zeros((n - 1, n - 1)), np.eye(n - 1)], [slopes[::2].T, slopes[1::2].T]])
    system[n - 1 :, 0] = 0.0  # the weight, which lets a pier fall slowly
    fastest = abs(np.linalg.eigvals(system)).max()
    y = state_at(m, 1.0, np.array((0.5, *np.zeros(5))), np.zeros(6))
    start = Instant(y, y, Stance(0.0, 0.0, 1.0, 1.0), None, STILL)
    (longest,) = uncompiled(values_of, [("flexure.events", "longest_step", m, start, 1.0)])
    assert longest * fastest == pytest.approx(0.1, rel=1e-2)


def test_devices_pull_a_pier_that_bends_as_their_work_along_its_motion_says(uncompiled):
    """What a force F and a moment M add is J⁻¹ of the points times their work −F δv − M δθ."""
    base, pull = rb.RigidBase(shaft="elastic"), Pull(3.0, -40.0)
    m, of = flexible_block(pier_of(*TOWER), base), points_of(*TOWER, base)
    calls, expected = [], []
    for key, on_ground, q, rates, _ in random_states(5):
        y, contact = state_at(m, key, q, rates), stance(key * on_ground, key)
        free = [1, *of.bends] if on_ground else [0, 1, *of.bends]
        _, s, c, across, up = flexible_reference._places(of, key, q)
        slope = key * m.half_width * c - m.height * s
        mass, work = of.mass / of.mass.sum(), np.array([-pull.force, -pull.force * slope - pull.moment, *np.zeros(4)])
        added = np.zeros(6)
        matrix = (across[free] * mass) @ across[free].T + (up[free] * mass) @ up[free].T
        added[free] = np.linalg.solve(matrix, work[free])
        calls += [("system", "rates", each, y, contact, STILL) for each in (m, m._replace(pull=pull))]
        expected.append((added[0] + slope * added[1], *added[1:]))
    found = np.array(uncompiled(values_of, calls))
    loads = [("block.equations", "normal_force", each, y, y, 0.3) for each in (m, m._replace(pull=pull))]
    assert np.diff(uncompiled(values_of, loads)) == pytest.approx(pull.force, rel=1e-9)
    assert (found[1::2] - found[::2])[:, [2, 3, 8, 9, 10, 11]] == pytest.approx(np.array(expected), rel=1e-7, abs=1e-10)


def test_the_rate_at_which_a_pier_comes_to_lift_off_is_that_of_the_mass_points(uncompiled):
    """The acceleration to either side that standing points would begin to turn with, a moment before and after."""
    base = rb.RigidBase(shaft="elastic", flexural_damping=0.04)
    m, of, short = flexible_block(pier_of(*TOWER), base), points_of(*TOWER, base), 1e-6
    calls, expected = [], []
    for key, _, (_, _, *u), (_, _, *u_rate), shaking in random_states(4):
        u, u_rate = np.array(u), np.array(u_rate)
        ground = Ground(shaking[0], 3.0 * shaking[1], shaking[1], 2.0 * shaking[0])
        forward = flexible_reference.motion_of(
            of, key, of.bends, np.array((0.0, 0.0, *u)), (0.0, 0.0, *u_rate), shaking
        )[0][2:]
        near = [
            key * flexible_reference.motion_of(
                of, key, [1, *of.bends], np.array((0.0, 0.0, *(u + t * u_rate + 0.5 * t * t * forward))),
                (0.0, 0.0, *(u_rate + t * forward)),
                (ground.horizontal + t * ground.horizontal_slope, ground.vertical + t * ground.vertical_slope),
            )[0][1]
            for t in (-short, 0.0, short)
        ]  # fmt: skip
        y, k = bent(0.0, 0.0, 0.0, 0.0, u, u_rate), bent(0.0, 0.0, 0.0, 0.0, u_rate, forward)
        calls += [
            ("block.events", "lift_rate", m, None, Instant(y, k, BOTH, None, ground), key),
            ("block.events", "lifting", m, None, y, key, ground),
        ]
        expected += [(near[2] - near[0]) / (2.0 * short), near[1]]
    found = uncompiled(values_of, calls)
    assert found[1::2] == pytest.approx(expected[1::2], rel=1e-9)
    assert found[::2] == pytest.approx(expected[::2], rel=1e-5, abs=1e-5)


def test_the_greatest_displacements_are_those_of_cubics_between_the_rows(tower):
    """The top of the tower, its deck, is 42 m above its base; rows are as many steps apart as a sample has."""
    run, rows, found = tower
    over = run.base.modes(run.pier).at(42.0)
    u, u_rate = (over @ each for each in of_modes(rows))
    sine, cosine = np.sin(rows.theta), np.cos(rows.theta)
    ways = {
        "deflection_max": (u, u_rate),
        "drift_max": (
            42.0 * sine + u * cosine,
            (42.0 * cosine - u * sine) * rows.omega + u_rate * cosine,
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
                flat = bent(0.0, 0.0, 0.0, 0.0, bends_of(y)[0], bends_of(y)[1] + kept * y.omega)
                event(y, before, -key, flat, BOTH, IMPACT_BOTH, 1.0, 0.0)
            resting = bent(0.0, 0.0, 0.0, 0.0, *(0.001 * each for each in bends_of(y)))
            event(resting, BOTH, -key, resting, stance(key, key), LIFT_OFF, 0.0, 1.0)
        else:
            q[1] = math.copysign(min(abs(q[1]), 0.9 * m.alpha), q[1])
            for pivot in (-key, key):
                q[0] = (pivot - key) * m.half_width * math.sin(q[1])
                behind = flexible_reference._blow(of, key, pivot, q, rates)
                wanted = landed(pivot, q, behind), stance(pivot, pivot), impacts[pivot]
                event(state_at(m, key, q, rates), before, pivot, *wanted, 1.0, 0.0)
            topples = np.array(
                (0.0, math.copysign(1.1 * m.alpha, q[1]), *q[2:])
            )  # and lands beyond α, which is no impact to count
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
            q, rates = np.array((0.0, 0.0, *q[2:])), np.array((-0.3, 0.01, *rates[2:]))
            y, kept = state_at(m, key, q, rates), flexible_reference.kept_as_both_stop(of)
            flat = bent(0.0, 0.0, 0.0, 0.0, bends_of(y)[0], bends_of(y)[1] + 0.01 * kept)
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
    share, stiffness = of.mass / of.mass.sum(), 0.5 * of.frequency**2 * of.modal_mass / of.mass.sum()
    calls, expected, n = [], [], len(of.frequency)

    def level(key, theta, u):
        _, z = flexible_reference.places_over_ground(of, key, (0.0, theta, *u))
        return G * share @ (z - of.z) + stiffness @ u**2

    def leaning(key, theta):
        """Deflections of the least energy, which is quadratic in each."""
        falls = [level(key, theta, each) - level(key, theta, -each) for each in np.eye(n)]
        return -np.array(falls) / (4.0 * stiffness)

    rng = np.random.default_rng(3)
    for side in (-1.0, 1.0):
        for limit in rng.uniform(0.1, 0.7, 4) * m.tipping:
            least = level(side, side * limit, leaning(side, side * limit))
            theta, u = side * rng.uniform(0.0, 0.3) * limit, rng.choice([-1.0, 1.0], n) * (0.08, 4e-3, 1e-3, 3e-4)
            u_rate = 0.01 * rng.uniform(-1.0, 1.0, n)
            for factor in (0.999, 1.001):

                def excess(omega, theta=theta, u=u, u_rate=u_rate, wanted=factor * least, side=side):
                    along, up = velocities(of, side, (0.0, theta, *u), np.array((0.0, omega, *u_rate)))
                    return 0.5 * share @ (along**2 + up**2) + level(side, theta, u) - wanted

                # a parabola in ω through three of its points
                omega = np.roots(
                    np.polyfit([-1.0, 0.0, 1.0], [excess(each) for each in (-1.0, 0.0, 1.0)], 2)
                ).real.max()
                now = Moment(state_at(m, side, (0.0, theta, *u), (0.0, omega, *u_rate)), stance(side, side), None)
                calls.append(("flexure.ending", "_cannot_reach", m, None, now, limit))
                expected.append(factor < 1.0)
    far = 1.3 * m.tipping
    leans = leaning(1.0, far)
    assert level(1.0, far, leans) < level(1.0, m.tipping, leaning(1.0, m.tipping))
    beyond = Moment(state_at(m, 1.0, (0.0, far, *leans), np.zeros(2 + n)), stance(1.0, 1.0), None)
    calls.append(("flexure.ending", "_cannot_reach", m, None, beyond, m.tipping))
    expected.append(False)
    for side in (-1.0, 1.0):  # at rest close to the summit, on either side of it: the levels beyond it fall again
        least, limit = 0.98 * side * m.tipping, 0.99 * m.tipping
        at_rest = state_at(m, side, (0.0, least, *leaning(side, least)), np.zeros(2 + n))
        calls.append(("flexure.ending", "_cannot_reach", m, None, Moment(at_rest, stance(side, side), None), limit))
        expected.append(True)
    phases = np.linspace(0.0, 2.0 * math.pi, 20001)[:, None]
    spring = of.frequency**2 * (np.cos(phases) + 2.0 * of.damping_ratio * np.sin(phases))
    moments = abs((of.shape * of.z) @ share) * spring.max(axis=0) + G * abs(of.shape @ share)
    for factor in (0.999, 1.001):
        for phase in (0.0, 0.5, 0.5 * math.pi, 2.0, 4.0):
            parts = rng.dirichlet(np.ones(n)) * factor * G * m.half_width / moments
            y = bent(0.0, 0.0, 0.0, 0.0, parts * math.cos(phase), parts * of.frequency * math.sin(phase))
            for contact in (BOTH, stance(1.0, 1.0), stance(-1.0, -1.0)):
                calls.append(("flexure.ending", "_stands_for_good", m, None, Moment(y, contact, None)))
                expected.append(factor < 1.0 and contact == BOTH)
    for call, found, wanted in zip(calls, uncompiled(values_of, calls), expected, strict=True):
        assert found == wanted, call
