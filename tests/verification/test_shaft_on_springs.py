"""Piers whose shaft bends on damped supports (THEORY.md, A shaft that bends): against mass points by DOP853, energy, limits.

Fast tests run the kernels uncompiled.
"""

import math
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import supported_reference as reference
from bending_piers import DT, TOWER, G, pier_of, points_of, shaken
from core_samples import sections_at, values_of
from scipy.optimize import fsolve

import rockbatch as rb
from rockbatch.core.springs.model import BentState, Contact, Supports
from rockbatch.core.types import SAMPLE, Ground, Moment, Pull
from rockbatch.motions.motion import Motion
from rockbatch.simulation import Run, run_fixed, written_run
from rockbatch.simulation.elements import elements
from rockbatch.simulation.histories import of_modes
from rockbatch.simulation.models import springs
from rockbatch.simulation.steps import fastest_rate, first_substeps

BENDS = {"shaft": "elastic", "flexural_damping": 0.03, "kinematics": "finite", "zeta": 0.2}
LAWS = {"epp": reference.perfectly_plastic, "bouc-wen": reference.bouc_wen}
PIER, ROCK = pier_of(*TOWER), rb.RigidBase(shaft="elastic", flexural_damping=0.03)
CONTACTS = ((1.0, 1.0), (1.0, 0.0), (0.0, 1.0), (0.0, 0.0))


def base_of(law: str = "elastic", stiffness: float = 3e6, pier: rb.Pier = PIER, **more) -> rb.ElasticBase:
    """Supports of a stiffness [kN/m]; those that yield do so at 2.2 times what they bear."""
    if law == "elastic":
        return rb.ElasticBase.from_stiffness(pier, stiffness, **BENDS | more)
    return rb.YieldingBase.from_stiffness(pier, stiffness, eta=2.2, spring=law, **BENDS | more)


def supports_of(base: rb.ElasticBase, pier: rb.Pier = PIER) -> reference.Supports:
    m, law = springs(pier, base), LAWS[base.spring] if base.yields else reference.elastic
    return reference.Supports(m.yield_force, m.yield_deflection, m.damping, law)


def random_states(seed: int, count: int = 3):
    """Contacts, v, θ and the modes, their rates, z of both springs, and the ground's accelerations."""
    rng = np.random.default_rng(seed)
    for _ in range(count):
        for down in CONTACTS:
            q, rates = (rng.uniform(-1.0, 1.0, 6) * (0.3, 0.2, 1.0, 0.05, 0.01, 0.003) for _ in range(2))
            yield down, q, 3.0 * rates, -rng.uniform(0.0, 1.0, 2) * down, rng.uniform(-4.0, 4.0, 2)


def state(q, rates, z) -> BentState:
    return BentState(*map(float, (q[0], q[1], rates[0], rates[1], *z, *q[2:], *rates[2:])))


def shares(of) -> np.ndarray:
    return of.mass / of.mass.sum()


def test_accelerations_are_those_of_the_mass_points_in_all_contacts(uncompiled):
    """With what devices add: M⁻¹ of the points times their work −F δv − M δθ."""
    base, of, pull = base_of(), points_of(*TOWER, ROCK), Pull(3.0, -40.0)
    m, calls, expected = springs(PIER, base), [], []
    for down, q, rates, z, shaking in random_states(1):
        contact, ground = Contact(*down, 0.0, 0.0, 0.0), Ground(shaking[0], 0.0, shaking[1], 0.0)
        _, _, _, _, across, up = reference.places(of, down, q)
        matrix = (across * shares(of)) @ across.T + (up * shares(of)) @ up.T
        free = reference.accelerations(of, supports_of(base), down, q, rates, z, shaking)
        pulled = free + np.linalg.solve(matrix, np.array([-pull.force, -pull.moment, *np.zeros(4)]))
        for each, wanted in ((m, free), (m._replace(pull=pull), pulled)):
            calls.append(("system", "rates", each, state(q, rates, z), contact, ground))
            expected.append(wanted)
    found = np.array(uncompiled(values_of, calls))
    np.testing.assert_allclose(found[:, [2, 3, 10, 11, 12, 13]], expected, rtol=1e-8, atol=1e-9)


def test_steps_resolve_the_fastest_motion_and_a_damper_decays_no_faster():
    """The greatest eigenvalue of the mass points on both springs, on either, and in the air; below its linear speed the damper
    decays at this rate where it acts."""
    base, of, rest = base_of(), points_of(*TOWER, ROCK), np.zeros(6)
    supports, greatest = supports_of(base), 0.0
    _, _, _, _, across, up = reference.places(of, (1.0, 1.0), rest)
    mass = (across * shares(of)) @ across.T + (up * shares(of)) @ up.T
    pivots = np.stack([np.ones(2), reference.pivots(of, rest, rest)[2], *np.zeros((4, 2))])
    for down in CONTACTS:
        springs = (pivots * down) @ pivots.T
        stiffness = np.diag([0.0, 0.0, *of.frequency**2]) + supports.strength / supports.deflection * springs
        damping = np.diag([0.0, 0.0, *2.0 * of.damping_ratio * of.frequency]) + supports.damping * springs
        slopes = -np.linalg.solve(mass, np.hstack((stiffness, damping)))
        rates = np.linalg.eigvals(np.vstack((np.hstack((np.zeros((6, 6)), np.eye(6))), slopes)))
        greatest = max(greatest, abs(rates).max())
    assert fastest_rate(PIER, base) == pytest.approx(greatest, rel=1e-6)
    damped = replace(base, restraints=(rb.Damper("viscous", nu=3.0, exponent=0.5, at=0.0),))
    (damper,) = elements(PIER, damped)
    assert damper.slope == pytest.approx(greatest, rel=1e-6)  # a unit mass in the middle of the base
    assert fastest_rate(PIER, damped) == fastest_rate(PIER, base)


def both_of(of, supports, q, rates, z, shaking):
    """Return the accelerations with the right pivot down alone, and with both."""
    return [reference.accelerations(of, supports, down, q, rates, z, shaking) for down in ((0.0, 1.0), (1.0, 1.0))]


def test_a_grazing_pivot_stays_at_its_support_between_contact_and_none(uncompiled):
    """The rates are those share of both by which the pivot does not leave the top of the support, which rises."""
    base, of = base_of(), points_of(*TOWER, ROCK)
    m, supports, seen = springs(PIER, base), supports_of(base), 0
    relaxes = supports.strength / (supports.deflection * supports.damping)
    calls, expected = [], []
    for down, q, rates, z, shaking in random_states(3, 30):
        if down != (0.0, 1.0):
            continue
        # the left pivot moves with the top of its support
        z[0], (_, _, arms) = -0.01, reference.pivots(of, q, rates)
        top_speed = -supports.deflection * relaxes * z[0]
        rates[0] = top_speed - arms[0] * rates[1]
        both = partial(both_of, of, supports, q, rates, z)

        def leaves(k, q=q, rates=rates, z=z):
            ahead = [reference.pivots(of, q + t * rates + 0.5 * t * t * k, rates + t * k)[1][0] for t in (-1e-6, 1e-6)]
            return np.diff(ahead)[0] / 2e-6 - supports.deflection * z[0] * relaxes**2

        at_rest, shaken_once = (sum(map(leaves, both((shaking[0], up)))) for up in (0.0, 1.0))
        shaking[1] = at_rest / (at_rest - shaken_once)  # contact lifts the pivot as fast as flight lowers it
        off, on = map(leaves, both(shaking))
        if not off < 0.0 < on:
            continue
        seen += 1
        assert off == pytest.approx(-on, rel=1e-3)
        contact = Contact(0.0, 1.0, 0.0, 0.0, -1.0)
        calls.append(("system", "rates", m, state(q, rates, z), contact, Ground(shaking[0], 0.0, shaking[1], 0.0)))
        expected.append(0.5 * sum(both(shaking)))
    assert seen > 5
    found = np.array(uncompiled(values_of, calls))
    np.testing.assert_allclose(found[:, [2, 3, 10, 11, 12, 13]], expected, rtol=1e-5, atol=1e-5)


def test_energy_momenta_and_power_are_those_of_the_mass_points(uncompiled):
    base, of = base_of(), points_of(*TOWER, ROCK)
    m, supports, calls, expected = springs(PIER, base), supports_of(base), [], []
    for down, q, rates, z, shaking in random_states(2):
        contact, y = Contact(*down, 0.0, 0.0, 0.0), state(q, rates, z)
        x, above, height, still, across, up = reference.places(of, down, q)
        moving = np.array(rates)

        def kinetic(rates, across=across, up=up):
            return 0.5 * shares(of) @ ((rates @ across) ** 2 + (rates @ up) ** 2)

        raised = q[0] + shares(of) @ (above * math.cos(q[1]) - x * math.sin(q[1]))
        elastic = 0.5 * supports.strength * supports.deflection * (z @ z)
        elastic += 0.5 * (of.frequency**2 * of.modal_mass / of.mass.sum()) @ q[2:] ** 2
        lever = height * math.cos(q[1]) + still * math.sin(q[1])
        slopes = [0.5 * (kinetic(moving + each) - kinetic(moving - each)) for each in np.eye(6)]
        calls += [
            ("observe.ledger", "_stored_on_springs", m, y, contact),
            ("springs.bending", "momenta", m, y, lever),
            ("system", "ground_power", m, y, contact, Ground(shaking[0], 0.0, shaking[1], 0.0)),
        ]
        expected += [
            (kinetic(moving), of.gravity * raised, elastic),
            (slopes[0], slopes[1], tuple(slopes[2:])),
            -shaking @ (shares(of) @ (rates @ across), shares(of) @ (rates @ up)),
        ]
    for call, found, wanted in zip(calls, uncompiled(values_of, calls), expected, strict=True):
        if call[1] == "momenta":
            found, wanted = (*found[:2], *found[2]), (*wanted[:2], *wanted[2])
        assert found == pytest.approx(wanted, rel=1e-8, abs=1e-9), call


def test_forces_at_the_base_and_at_the_deck_are_those_of_the_mass_points(uncompiled):
    """V, the moment about the middle of the base, both supports, the deck's acceleration.

    Of what the base does across the shaft V and the deck have the part that the modes follow.
    """
    base, of, deck = base_of(), points_of(*TOWER, ROCK), 41.0
    shape = ROCK.modes(PIER).at(deck)
    light = replace(
        of, mass=np.append(of.mass, 1e-9 * of.mass.sum()), x=np.append(of.x, 0.0), z=np.append(of.z, deck),
        shape=np.column_stack([of.shape, shape]),
    )  # fmt: skip
    m, calls, expected = springs(PIER, base), [], []
    m = m._replace(shaft=m.shaft._replace(deck_shape=m.shaft.deck_shape._make(map(float, shape))))
    for down, q, rates, z, shaking in random_states(5):
        contact, ground = Contact(*down, 0.0, 0.0, 0.0), Ground(shaking[0], 0.0, shaking[1], 0.0)
        k = reference.accelerations(of, supports_of(base), down, q, rates, z, shaking)
        x, above, height, still, across, up = reference.places(light, down, q)
        along, rise = reference.drift_of(light, down, q, rates)
        push_x, push_z = k @ across + along + shaking[0], k @ up + rise + of.gravity + shaking[1]
        mass, (s, c) = light.mass / light.mass.sum(), (math.sin(q[1]), math.cos(q[1]))
        of_base = (k[:2] @ across[:2]) * c - (k[:2] @ up[:2]) * s
        followed = (light.shape * light.mass) @ of_base / light.modal_mass @ light.shape
        less = mass @ (of_base - followed)
        place = still + (x - still) * c + (above + height) * s
        level = (above + height) * c - (x - still) * s
        pushes = reference.pushes(of, supports_of(base), down, q, rates, z)
        calls.append(
            ("observe.forces", "on_springs", m, deck, Moment(state(q, rates, z), contact, Supports(0.0, 0.0)), ground)
        )
        shear, shaken = mass @ push_x - less / c, push_x[-1] - (of_base - followed)[-1] * c
        expected.append((shear, mass @ (place * push_z - level * push_x), *pushes, shaken))
        assert pushes.sum() == pytest.approx(mass @ push_z, rel=1e-6, abs=1e-6)
    for found, wanted in zip(uncompiled(values_of, calls), expected, strict=True):
        assert (found.shear, found.moment, found.left, found.right, found.deck) == pytest.approx(
            wanted, rel=2e-6, abs=2e-5
        )


def test_the_base_shear_is_what_stiffness_and_damping_of_the_modes_bear(uncompiled):
    """(E10): beside the steady push on the masses that no mode follows; nothing of a foot that turns at once is in it."""
    base, calls, expected = base_of(), [], []
    m = springs(PIER, base)
    share, frequency, damping = (np.array(getattr(m.shaft, name)) for name in ("share", "frequency", "damping"))
    for down, q, rates, z, shaking in random_states(7):
        contact, ground = Contact(*down, 0.0, 0.0, 0.0), Ground(shaking[0], 0.0, shaking[1], 0.0)
        y, supports = state(q, rates, z), Supports(0.0, 0.0)
        calls.append(("observe.forces", "on_springs", m, 40.0, Moment(y, contact, supports), ground))
        s, c, side = math.sin(q[1]), math.cos(q[1]), down[1] - down[0]
        turned = shaking[0] + (side * m.half_width * c - m.height * s) * rates[1] ** 2
        steady = c * turned - s * (m.gravity + shaking[1])
        expected.append((1.0 - share @ share) * steady - share @ (frequency**2 * q[2:] + damping * np.array(rates[2:])))
    for found, wanted, call in zip(uncompiled(values_of, calls), expected, calls, strict=True):
        theta = call[4].y.theta
        assert found.shear * math.cos(theta) - found.normal * math.sin(theta) == pytest.approx(
            wanted, rel=1e-9, abs=1e-9
        )


def test_forces_in_sections_are_those_of_the_mass_points_above(uncompiled):
    """V, N and the moment about the deflected section, of v̈ and θ̈ across the shaft as far as modes follow."""
    run, heights, cuts = Run(PIER, base_of(), shaken(5.0, 1.4, duration=2.2)), (0.0, 12.0, 29.0, 41.0), (0, 12, 29, 40)
    found, rows = uncompiled(written_run, run, 26, 0.0, 60_000, wait=False)
    rows = rows[: found.rows].view(np.recarray)
    samples = np.flatnonzero((rows.kind == SAMPLE) & (abs(rows.theta) > 1e-3) & (rows.t < 2.1))[::6]
    of, supports = points_of(*TOWER, ROCK, cuts=cuts), supports_of(run.base)
    modes, m = run.base.modes(PIER), of.mass / of.mass.sum()
    sections = np.array(uncompiled(sections_at, run, rows, samples, heights))
    expected = np.zeros_like(sections)
    for i, row in enumerate(rows[samples]):
        down, sample = (row.left, row.right), round(row.t / DT)
        u, u_rate = (each[:, 0] for each in of_modes(rows[samples][i : i + 1].view(np.recarray)))
        q, rates = np.array((row.v, row.theta, *u)), np.array((row.v_rate, row.omega, *u_rate))
        shaking = run.motion.horizontal[sample], run.motion.vertical[sample]
        k = reference.accelerations(of, supports, down, q, rates, np.array((row.z_left, row.z_right)), shaking)
        x, _, _, _, across, up = reference.places(of, down, q)
        along, rise = reference.drift_of(of, down, q, rates)
        push_x, push_z = k @ across + along + shaking[0], k @ up + rise + G + shaking[1]
        s, c = math.sin(row.theta), math.cos(row.theta)
        of_base = (k[:2] @ across[:2]) * c - (k[:2] @ up[:2]) * s
        followed = (of.shape * of.mass) @ of_base / of.modal_mass @ of.shape
        to_side, to_top = push_x * c - push_z * s - of_base + followed, push_x * s + push_z * c + k[1] * x
        for j, height in enumerate(heights):
            above, here = m * (of.z > height), modes.at(height) @ u
            aside = of.x + u @ of.shape - here
            expected[i, j] = (
                above @ to_side, -above @ (to_side * (of.z - height)) + above @ (aside * to_top), above @ to_top
            )  # fmt: skip
    assert {(row.left, row.right) for row in rows[samples]} >= {(1.0, 0.0), (0.0, 1.0)}
    np.testing.assert_allclose(sections, expected, rtol=2e-3, atol=2e-3 * abs(sections).max(axis=(0, 1)).min())


def test_a_pier_that_leans_on_tilted_supports_hangs_over_with_its_shaft(uncompiled):
    """To the second order of the lean: the equilibrium of the points, by which rests and peaks that are final are judged."""
    soft, tilt = (*TOWER[:4], 2.5), 1e-4
    base, of = base_of(stiffness=8e4), points_of(*soft, ROCK)
    m, supports = springs(pier_of(*soft), base), supports_of(base)
    waiting = np.array([1.0, -1.0]) * tilt * PIER.half_width

    def unbalanced(q):
        z = np.minimum((reference.pivots(of, q, np.zeros(6))[0] - waiting) / supports.deflection, 0.0)
        return reference.accelerations(of, supports, (1.0, 1.0), q, np.zeros(6), z, (0.0, 0.0))

    q = fsolve(unbalanced, np.array([-supports.deflection * 0.5, tilt, *np.zeros(4)]), xtol=1e-12)
    (lean,) = uncompiled(values_of, [("springs.free_vibration", "lean_on", m, Supports(*map(float, waiting)))])
    rigid = springs(PIER, replace(base, shaft="rigid"))
    (stiff,) = uncompiled(values_of, [("springs.free_vibration", "lean_on", rigid, Supports(*map(float, waiting)))])
    assert abs(unbalanced(q)).max() < 1e-9
    assert lean == pytest.approx(q[1], rel=1e-4)
    assert lean > 1.02 * stiff


def test_the_mirror_image_of_a_motion_gives_that_of_the_run_on_springs(uncompiled):
    run = Run(PIER, base_of("epp"), shaken(5.0, 1.4, upwards=0.5, duration=2.0))
    found, rows = uncompiled(written_run, run, 8, 0.0, 60_000, wait=False)
    back = replace(run, motion=run.motion.times(1.0, reverse=True))
    _, mirrored = uncompiled(written_run, back, 8, 0.0, 60_000, wait=False)
    rows, mirrored = (each[: found.rows].view(np.recarray) for each in (rows, mirrored))
    assert found.impacts > 0 < found.dissipated_left
    np.testing.assert_allclose(rows.theta, -mirrored.theta, rtol=0.0, atol=1e-14)
    np.testing.assert_allclose(of_modes(rows), -np.array(of_modes(mirrored)), rtol=0.0, atol=1e-12)
    np.testing.assert_allclose(rows.z_left, mirrored.z_right, rtol=0.0, atol=1e-10)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("law", "upwards"),
    [
        ("elastic", 0.9),
        *(pytest.param(law, up, marks=pytest.mark.thorough) for law in LAWS for up in (0.0, 0.9)),
    ],
)
def test_a_pier_on_supports_moves_as_its_mass_points_do(law, upwards):
    """Through lift-off, landing, yielding and flight, with three modes."""
    base, motion = base_of(law, flexural_modes=3), shaken(5.0, 1.4, upwards=upwards)
    of = points_of(*TOWER, replace(ROCK, flexural_modes=3))
    shaking = np.column_stack([motion.horizontal, motion.vertical])
    expected = reference.run(of, supports_of(base), shaking, DT, 2.2)
    found, rows = written_run(Run(PIER, base, motion), 64, 0.0, 400_000, wait=False)
    rows = rows[: found.rows].view(np.recarray)
    samples = rows[rows.kind == SAMPLE][: len(expected)]
    assert found.impacts > 1
    assert (found.flights > 0) == (upwards > 0.0)
    np.testing.assert_allclose(samples.theta, expected[:, 1], rtol=0.0, atol=1e-8 * PIER.alpha)
    np.testing.assert_allclose(samples.v, expected[:, 0], rtol=0.0, atol=1e-8)
    np.testing.assert_allclose(of_modes(samples)[0][:3].T, expected[:, 2:5], rtol=0.0, atol=1e-7)
    np.testing.assert_allclose(samples.z_left, expected[:, 5], rtol=0.0, atol=1e-6)


@pytest.mark.thorough
@pytest.mark.parametrize("number", range(6))
def test_random_piers_on_supports_move_as_their_mass_points_do(number):
    """Course, modes and plastic deflection, relative to the peak of each, under a sine, every other pier with a vertical one."""
    rng = np.random.default_rng([97, number])
    width, law = rng.uniform(4.0, 12.0), ("elastic", *LAWS)[number % 3]
    height, shaft, deck = width / rng.uniform(0.2, 0.4), rng.uniform(1000.0, 4000.0), rng.uniform(200.0, 3000.0)
    numbers = width, height, (shaft, 0.3 * width), (deck, rng.uniform(0.5, 3.0)), rng.uniform(0.3, 1.2)
    pier, beta = pier_of(*numbers), rng.uniform(4.0, 12.0)
    given = BENDS | {"zeta": rng.uniform(0.05, 0.4), "flexural_modes": int(rng.integers(1, 4)), "confirm": ("beta",)}
    base = rb.ElasticBase(beta * pier.least_beta, **given)
    if law != "elastic":
        base = rb.YieldingBase(base.beta, eta=rng.uniform(2.0, 3.5), spring=law, **given)
    t, period = np.arange(0.0, 1.6, DT), rng.uniform(0.4, 1.0)
    wave, rises = (np.sin(2.0 * math.pi * t / each) * (t < period) for each in (period, 0.3 * period))
    motion = Motion("one sine", DT, G * width / height * rng.uniform(1.0, 5.0) * wave, 9.0 * (number % 2) * rises)
    of, shaking = (
        points_of(*numbers, replace(ROCK, flexural_modes=base.flexural_modes)),
        np.column_stack([motion.horizontal, motion.vertical]),
    )
    expected = reference.run(of, supports_of(base, pier), shaking, DT, 1.5)
    steps = max(8, math.ceil(fastest_rate(pier, base) * DT / 0.02))
    found, rows = written_run(Run(pier, base, motion), steps, 0.0, 400_000, wait=False)
    rows = rows[: found.rows].view(np.recarray)
    samples = rows[rows.kind == SAMPLE][: len(expected)]
    peak, bent = abs(expected[:, 1]).max(), abs(expected[:, 2:-2]).max()
    np.testing.assert_allclose(samples.theta, expected[:, 1], rtol=0.0, atol=1e-7 * peak)
    np.testing.assert_allclose(samples.v, expected[:, 0], rtol=0.0, atol=1e-7 * abs(expected[:, 0]).max())
    np.testing.assert_allclose(
        of_modes(samples)[0][: base.flexural_modes].T, expected[:, 2:-2], rtol=0.0, atol=1e-6 * bent
    )
    np.testing.assert_allclose(samples.z_left, expected[:, -2], rtol=0.0, atol=1e-7)


@pytest.mark.slow
def test_the_energy_balance_of_a_shaft_on_yielding_supports_closes_by_order_four():
    base, motion = base_of("bouc-wen"), shaken(5.0, 1.4, upwards=0.9)
    found = [rb.simulate(PIER, base, motion, ledger=True, substeps=steps, wait=False) for steps in (32, 128)]
    left = [abs(run.ledger.remainder).max() for run in found]
    assert left[1] < 1e-8 * found[1].ledger.input.max()
    assert left[0] / left[1] > 100.0  # by two halvings, 256 of order four
    assert found[1].ledger.plastic.max() > 0.01 * found[1].ledger.input.max()
    assert len(found[1].events) > 10
    stored = found[1].ledger.kinetic + found[1].ledger.potential + found[1].ledger.elastic
    np.testing.assert_allclose(found[1].energy, stored, rtol=0.0, atol=1e-15)


@pytest.mark.slow
def test_stiff_supports_tend_to_a_rigid_base_and_a_stiff_shaft_to_a_rigid_one():
    pier, motion = PIER, Motion("wave", 0.005, np.interp(np.arange(0.0, 4.0, 0.005), *_packet()))
    rock = run_fixed(pier, replace(ROCK, flexural_modes=2), motion, 8)
    far = [
        abs(run_fixed(pier, base_of(stiffness=k, zeta=0.7, flexural_modes=2), motion, 64).theta_max - rock.theta_max)
        for k in (1e7, 1e8)
    ]
    assert far[1] < 0.3 * far[0]
    assert far[1] < 0.02 * rock.theta_max
    stiff = replace(pier, flexural_period_s=0.02)
    rigid = run_fixed(stiff, replace(base_of(), shaft="rigid"), motion, 64)
    near = run_fixed(stiff, base_of(flexural_modes=1), motion, 64)
    assert near.theta_max == pytest.approx(rigid.theta_max, rel=2e-3)


def _packet() -> tuple[np.ndarray, np.ndarray]:
    motion = shaken(5.0, 1.4)
    return np.arange(len(motion.horizontal)) * DT, motion.horizontal


OPENSEES = pd.read_csv(Path(__file__).parents[2] / "benchmarks" / "opensees_shaft_on_springs.csv", index_col="case")


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "shaft", "top", "period"),
    [
        ("tower", 3000.0, 1500.0, 0.9),
        ("light deck", 3000.0, 300.0, 0.9),
        ("even", 2000.0, 2000.0, 0.7),
        pytest.param("heavy top", 500.0, 4000.0, 1.2, marks=pytest.mark.thorough),
        ("stiff tower", 3000.0, 1500.0, 0.4),
    ],
)
def test_finite_elements_on_springs_turn_as_far_and_bear_as_much(name, shaft, top, period):
    """benchmarks/opensees_shaft.py --springs: both half cycles to 1 %, with three modes V at the foot to 5 and M at mid-height.

    What parts the shears, by up to 4 %, is damping forces, which OpenSees leaves out of its elements' forces, and higher modes.
    """
    parts = [rb.Part(shaft, 20.0, shaft * 40.0**2 / 12.0, 40.0), rb.Part(top, 40.0, 1e-3 * top, 0.0)]
    pier, others = replace(rb.Pier.of_parts(8.0, parts, top_m=40.0), flexural_period_s=period), OPENSEES.loc[name]
    t = np.arange(0.0, 8.5, 0.005)
    motion = Motion("sine", 0.005, 4.0 * np.sin(math.pi * t) * (t < 2.0))
    like = {"flexural_damping": 0.01, "flexural_damping_kind": "stiffness", "flexural_modes": 3, "zeta": 0.3}
    base = base_of(pier=pier, **like)
    steps = 2 * first_substeps(pier, base, motion.dt)
    run = rb.simulate(pier, base, motion, forces=True, sections=3, wait=False, substeps=steps)
    second = int(run.theta.argmax())
    assert -run.theta[:second].min() == pytest.approx(others.first_rad, rel=0.004)
    assert run.theta[second] == pytest.approx(others.second_rad, rel=0.01)
    assert run.row.base_shear_kN == pytest.approx(others.base_shear_kN, rel=0.05)
    assert run.sections.section_moment_kNm.iloc[1] == pytest.approx(others.moment_kNm, rel=0.01)
