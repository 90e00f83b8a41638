"""Rocking frames in flight and with devices (THEORY.md, Flight of a frame) against bodies that are followed one by one."""

import math
from dataclasses import replace

import numpy as np
import pytest
from frame_reference import Frame

import rockbatch as rb
from rockbatch.core.types import DECK, SAMPLE, TAKE_OFF
from rockbatch.motions.motion import Motion
from rockbatch.pier import Damper, Pier, RigidBase, Tendon
from rockbatch.pier.equilibrium import SlowTurn
from rockbatch.simulation import Run, run_fixed, written_run

G, DT, N = 9.81, 0.02, 100
TIME = DT * np.arange(N)
COLUMN = Pier.rectangle(1.5, 10.0, mass_t=35.0)
FRAME = replace(Pier.frame(COLUMN, 4, 420.0), initial_rotation_rad=0.02)


def shaken(upwards: float) -> Motion:
    """A sine along the frame, and one up and down by ``upwards`` [g] from 0.3 s to 1.5 s."""
    vertical = upwards * G * np.sin(2 * math.pi * TIME / 0.3) * (TIME > 0.3) * (TIME < 1.5)
    return Motion("shaken", DT, 0.25 * G * np.sin(2 * math.pi * TIME / 0.7), vertical)


def tied(pier: Pier, offset: float = 0.0) -> RigidBase:
    """A tendon and a linear damper below each of four columns; kN of all together."""
    tendon = Tendon.of(pier, prestress_kN=400.0, stiffness_kN_m=8000.0, at=offset)
    return RigidBase(restraints=(tendon, Damper.viscous(pier, coefficient_kN_s_m=240.0, at=offset)))


def reference(offset: float | None = None) -> Frame:
    """Columns and deck of FRAME, free or with what :func:`tied` has."""
    if offset is None:
        return Frame(0.75, 5.0, 35.0, 4, 420.0)
    return Frame(0.75, 5.0, 35.0, 4, 420.0, prestress=100.0, stiffness=2000.0, damper=60.0, offset=offset)


def follow(pier: Pier, base: RigidBase, motion: Motion, substeps: int = 8) -> tuple[np.ndarray, np.ndarray]:
    """Return rows at samples, and those behind events."""
    found, rows = written_run(Run(pier, base, motion), substeps, 0.0, 20_000, wait=False)
    rows = rows[: found.rows].view(np.recarray)
    return rows[rows.kind == SAMPLE], rows[rows.kind > 0.0]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("upwards", "offset"), [(1.4, None), pytest.param(2.4, 0.0, marks=pytest.mark.slow)], ids=["free", "tied"]
)
def test_a_frame_flies_as_its_columns_and_its_deck_do(upwards, offset):
    """Four flights, in the last of which the deck changes corners: 1e-8 of 0.02 rad, by DOP853 at 1e-11."""
    motion, bodies = shaken(upwards), reference(offset)
    samples, events = follow(FRAME, RigidBase() if offset is None else tied(FRAME, offset), motion)
    _, expected = bodies.run(DT, motion.horizontal, motion.vertical, FRAME.initial_rotation_rad, 1.9)
    assert [kind for kind, *_ in bodies.events].count("deck") == 1 == np.sum(events.kind == DECK)
    assert [kind for kind, *_ in bodies.events].count("take-off") == 4 == np.sum(events.kind == TAKE_OFF)
    np.testing.assert_allclose(events.t[: len(bodies.events)], [t for _, t, *_ in bodies.events], rtol=0.0, atol=1e-8)
    np.testing.assert_allclose(samples.theta[: len(expected)], expected[:, 1], rtol=0.0, atol=2e-10)
    np.testing.assert_allclose(samples.omega[: len(expected)], expected[:, 3], rtol=0.0, atol=1e-8)


@pytest.mark.slow
def test_impacts_of_a_frame_take_what_those_of_its_bodies_take():
    """Kinetic energies of all bodies before and behind every impact, that of the deck in flight too, over the whole mass."""
    motion, bodies = shaken(1.4), reference()
    bodies.run(DT, motion.horizontal, motion.vertical, FRAME.initial_rotation_rad, 1.7)
    response = rb.simulate(FRAME, RigidBase(), motion, substeps=8, ledger=True)
    lost = sum(before - after for _, _, before, after in bodies.events) / FRAME.mass_t
    at_end = np.searchsorted(response.ledger["t"], 1.69)
    assert response.ledger["impact"].iloc[at_end] == pytest.approx(lost, rel=1e-7)
    assert (response.events["kind"] == "deck impact").sum() == 1


@pytest.mark.parametrize("restrained", [False, True])
def test_the_energy_balance_of_a_frame_closes_in_flight(restrained):
    """Simpson's rule of the power at 16 steps a sample: 1e-7 of what the ground puts in."""
    base = tied(FRAME, 0.3) if restrained else RigidBase()
    response = rb.simulate(FRAME, base, shaken(2.4), substeps=16, ledger=True)
    assert (response.events["kind"] == "take-off").sum() >= 4
    assert np.abs(response.ledger["remainder"]).max() < 1e-7 * response.ledger["input"].abs().max()


@pytest.mark.parametrize("offset", [None, 0.4])
def test_forces_of_a_frame_in_flight_and_on_the_ground(offset):
    """V, N, M_b and the deck's acceleration at samples from the accelerations of bodies in the same state."""
    base, motion, bodies = RigidBase() if offset is None else tied(FRAME, offset), shaken(2.0), reference(offset)
    response = rb.simulate(FRAME, base, motion, substeps=8, forces=True)
    samples, _ = follow(FRAME, base, motion)
    found, flown = response.forces, 0
    for i in range(3, 90):
        row = samples[i]
        at = np.searchsorted(response.history["t"], row.t - 1e-9)
        aloft = row.left == row.right == 0.0
        key, top = (row.bore, row.top) if aloft else (row.right - row.left,) * 2
        arm = bodies.at(row.theta, -top * bodies.b, bodies.h)
        share = FRAME.deck_over_columns / (1.0 + FRAME.deck_over_columns)
        z = row.v - share * (arm[1] - bodies.h) + bodies.h
        up = row.v_rate + share * arm[0] * row.omega
        q = np.array([z, row.theta, up, row.omega])
        ground = (motion.horizontal[i], motion.vertical[i])
        z_acceleration, turning, foot = bodies.accelerations(q, key, top, not aloft, ground)
        shear = 0.0
        moved = []
        for mass, jacobian, bend in bodies.jacobians(row.theta, key, top):
            if len(bend) == 2:
                moved.append((jacobian @ (z_acceleration, turning) + bend * row.omega**2)[0] + ground[0])
                shear += mass * moved[-1]
        pull = -bodies.devices(q)[0][0]  # ∂e/∂v is 1/cos(θ/2)
        down, along = pull * math.cos(0.5 * row.theta) ** 2, pull * 0.5 * math.sin(row.theta)
        moment = key * bodies.b * foot - (offset or 0.0) * down
        expected = np.array([shear + (0.0 if aloft else along), foot + (0.0 if aloft else down - pull), moment])
        names = ["base_shear", "normal_force"]
        np.testing.assert_allclose(found[names].iloc[at], expected[:2] / FRAME.mass_t, rtol=0.0, atol=1e-6)
        assert found["deck_acceleration"].iloc[at] == pytest.approx(moved[-1], abs=1e-6)
        flown += aloft
    assert flown > 10


def test_a_frame_with_a_deck_of_no_weight_flies_as_one_of_its_columns():
    """γ = 1e-9: what is left is of its order."""
    frame = replace(Pier.frame(COLUMN, 2, 7e-8, confirm=("deck_mass_t",)), initial_rotation_rad=0.02)
    column = replace(COLUMN, initial_rotation_rad=0.02)
    (one, events), (other, _) = (follow(pier, RigidBase(), shaken(1.4)) for pier in (frame, column))
    assert TAKE_OFF in events.kind
    np.testing.assert_allclose(one.theta, other.theta, rtol=0.0, atol=1e-10)


@pytest.mark.parametrize("share", [0.98, 1.02])
def test_restrainers_make_the_stiffness_of_a_frame_positive_above_the_threshold(share):
    """λ = cos α, or N k_t = N m_c g R (1 + 2γ) cos α/b² of columns of the size R: the potential of bodies has that curvature."""
    gamma, b = FRAME.deck_over_columns, COLUMN.half_width
    stiffness = share * 4 * 35.0 * G * COLUMN.size * (1 + 2 * gamma) * math.cos(FRAME.alpha) / b**2
    tendon = Tendon.of(FRAME, stiffness_kN_m=stiffness)
    assert tendon.lam == pytest.approx(share * math.cos(FRAME.alpha), rel=1e-12)
    theta, bodies = np.array([1e-4, 2e-4, 3e-4]), reference()
    bodies.stiffness = stiffness / 4
    moment = SlowTurn(FRAME, RigidBase(restraints=(tendon,))).at(theta).moment * FRAME.mass_t * G
    near = 1e-6

    def potential(leans):
        return bodies.energy(np.array([-bodies.at(leans, bodies.b, -bodies.h)[1], leans, 0.0, 0.0]), 1.0, 1.0)

    righting = [(potential(each + near) - potential(each - near)) / (2 * near) for each in theta]
    np.testing.assert_allclose(moment, righting, rtol=1e-6)
    assert math.copysign(1.0, moment[-1] - moment[0]) == math.copysign(1.0, share - 1.0)


@pytest.mark.parametrize(("share", "moves"), [(0.999, False), (1.001, True)])
def test_friction_at_all_feet_holds_a_frame_until_its_lift_off(share, moves):
    """M ü ĥ = M g b̂ + 2b F with F at either foot of all columns; M ĥ = (N m_c + 2 m_d) h and b̂ likewise."""
    pier = replace(FRAME, initial_rotation_rad=0.0)
    h, b, weighs = 5.0, 0.75, 4 * 35.0 + 2 * 420.0
    needed = (G * weighs * b + 2 * b * 200.0) / (weighs * h)
    base = RigidBase(restraints=(Damper.friction(pier, 200.0),))
    motion = Motion("push", DT, share * needed * np.minimum(np.arange(60) / 30, 1.0))
    assert (run_fixed(pier, base, motion, 4, 0.0).theta_max > 0.0) == moves


@pytest.mark.sweep(slow=3)
@pytest.mark.slow
@pytest.mark.parametrize("seed", range(6))
def test_random_frames_in_random_ground(seed):
    """1e-7 of α over 1.5 s; all fly."""
    draws = np.random.default_rng(5000 + seed)
    b, h, columns = draws.uniform(0.3, 1.2), draws.uniform(2.0, 8.0), int(draws.integers(2, 5))
    deck = columns * 40.0 * 10.0 ** draws.uniform(-1.0, 0.8)
    column = Pier.rectangle(2 * b, 2 * h, mass_t=40.0)
    start = draws.uniform(0.02, 0.15) * column.alpha
    pier = replace(Pier.frame(column, columns, deck), initial_rotation_rad=start)
    waves = [
        amplitude * np.minimum(TIME / 0.2, 1.0) * np.convolve(draws.normal(size=N + 8), np.ones(9) / 3.0, "valid")
        for amplitude in (0.2 * G, draws.uniform(0.9, 1.5) * G)
    ]
    motion = Motion("random", DT, *waves)
    samples, events = follow(pier, RigidBase(), motion, 16)
    assert TAKE_OFF in events.kind
    bodies = Frame(b, h, 40.0, columns, deck)
    _, expected = bodies.run(DT, *waves, start, 1.5)
    np.testing.assert_allclose(samples.theta[: len(expected)], expected[:, 1], rtol=0.0, atol=1e-7 * pier.alpha)
