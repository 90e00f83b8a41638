"""Piers whose shaft bends on a footing (THEORY.md, A shaft that bends): against mass points by DOP853, energy, limits.

Fast tests run the kernels uncompiled.
"""

import math
from dataclasses import replace
from types import SimpleNamespace

import bending_on_bed_reference as reference
import numpy as np
import pytest
from bending_piers import DT, TOWER, G, pier_of, points_of
from core_samples import displaced_at_start, values_of
from scipy.optimize import fsolve
from supported_reference import drift_of, places

import rockbatch as rb
from rockbatch.core.flexure.model import Flexing
from rockbatch.core.footing.model import Touch
from rockbatch.core.types import SAMPLE, Ground, Moment, Pull
from rockbatch.motions.motion import Motion
from rockbatch.outcome.outcome import BedDemands
from rockbatch.pier import vertical_frequency
from rockbatch.simulation import Run, run_fixed, written_run
from rockbatch.simulation.coarser import coarser, with_modes_error, with_strips_error
from rockbatch.simulation.histories import of_modes
from rockbatch.simulation.models import footing
from rockbatch.simulation.restraints import rests_at
from rockbatch.simulation.runs import _BLANK as BLANK
from rockbatch.simulation.runs import Trial
from rockbatch.simulation.steps import fastest_rate, first_substeps

PIER, ROCK = pier_of(*TOWER), rb.RigidBase(shaft="elastic", flexural_damping=0.03)
SOME = Touch(1.0, 1.0, 0.0)
PRESSED_DEEP = Flexing(-0.030, 0.004, *[0.0] * 10)
"""State that leaves a bed with a set under its right half alone."""


def base_of(stiffness: float = 60.0, pier: rb.Pier = PIER, **more) -> rb.FootingBase:
    """A footing on 8 strips of a stiffness [MN/m³] that yield at 2.2 times the weight."""
    given = {"shaft": "elastic", "flexural_damping": 0.03, "kinematics": "finite", "zeta": 0.1, "strips": 8}
    return rb.FootingBase.from_stiffness(pier, stiffness, length_m=10.0, **{"safety_factor": 2.2} | given | more)


def foot_under(of, base: rb.FootingBase, pier: rb.Pier = PIER):
    """Return the bed of ``base`` under mass points."""
    settlement = pier.gravity / footing(pier, base).stiffness
    return reference.foot_of(of, settlement, base.safety_factor or math.inf, base.zeta, base.strips)


def random_states(seed: int, count: int = 12):
    """v, θ and the modes, their rates, and the ground's accelerations: pressed everywhere, in part, and in the air."""
    rng = np.random.default_rng(seed)
    for i in range(count):
        q, rates = (rng.uniform(-1.0, 1.0, 6) * (0.03, 0.006, 0.3, 0.05, 0.01, 0.003) for _ in range(2))
        q[0] += (-0.03, -0.01, 0.04)[i % 3]
        yield q, 3.0 * rates, rng.uniform(-4.0, 4.0, 2)


def state(q, rates) -> Flexing:
    return Flexing(*map(float, (*q[:2], *rates[:2], *q[2:], *rates[2:])))


def shares(of) -> np.ndarray:
    return of.mass / of.mass.sum()


def sets_of(foot) -> np.ndarray:
    """Return the sets of the nodes that :data:`PRESSED_DEEP` leaves."""
    return np.maximum(reference.depths(foot, PRESSED_DEEP[:2], PRESSED_DEEP[2:4])[0] - foot.most, 0.0)


@pytest.fixture(scope="module")
def laid():
    """Return a pier, its mass points and bed with the sets, and the call that leaves these on the bed of the core."""
    base, of = base_of(), points_of(*TOWER, ROCK)
    m, foot = footing(PIER, base), foot_under(of, base)
    sets = sets_of(foot)
    assert sets[0] == 0.0 < sets[-1]
    return m, of, foot, sets, ("footing.lanes", "start_on_bed", m, PRESSED_DEEP)


def pressed(foot, q, sets) -> set[bool]:
    return set(reference.depths(foot, q, np.zeros(6))[0] > sets)


def test_accelerations_on_a_bed_are_those_of_the_mass_points(laid, uncompiled):
    """With what devices add: M⁻¹ of the points times their work −F δv − M δθ."""
    m, of, foot, sets, lay = laid
    pull, calls, expected, seen = Pull(3.0, -40.0), [lay], [], []
    for q, rates, shaking in random_states(1):
        _, _, _, _, across, up = places(of, reference.SLIDES_NOWHERE, q)
        matrix = (across * shares(of)) @ across.T + (up * shares(of)) @ up.T
        free = reference.accelerations(of, foot, q, rates, sets, shaking)
        pulled = free + np.linalg.solve(matrix, np.array([-pull.force, -pull.moment, *np.zeros(4)]))
        ground = Ground(shaking[0], 0.0, shaking[1], 0.0)
        calls += [("system", "rates", each, state(q, rates), SOME, ground) for each in (m, m._replace(pull=pull))]
        expected += [np.concatenate([rates[:2], each[:2], rates[2:], each[2:]]) for each in (free, pulled)]
        seen.append(pressed(foot, q, sets))
    found = np.array(uncompiled(values_of, calls)[1:])
    np.testing.assert_allclose(found, expected, rtol=1e-8, atol=1e-9)
    assert all(each in seen for each in ({True}, {False}, {True, False}))


def test_energies_and_the_power_of_the_ground_are_those_of_the_mass_points(laid, uncompiled):
    m, of, _, _, lay = laid
    rigid, calls, expected = footing(PIER, replace(base_of(), shaft="rigid")), [lay], []
    calls.append(("footing.lanes", "start_on_bed", rigid, PRESSED_DEEP))
    for q, rates, shaking in random_states(2):
        x, above, _, _, across, up = places(of, reference.SLIDES_NOWHERE, q)
        speed, rise = rates @ across, rates @ up
        raised = q[0] + shares(of) @ (above * math.cos(q[1]) - x * math.sin(q[1]))
        bent = 0.5 * (of.frequency**2 * of.modal_mass / of.mass.sum()) @ q[2:] ** 2
        calls += [
            ("footing.equations", "energies", m, state(q, rates)),
            ("footing.equations", "energies", rigid, state(q, rates)),
            ("system", "ground_power", m, state(q, rates), SOME, Ground(shaking[0], 0.0, shaking[1], 0.0)),
        ]
        kinetic = 0.5 * shares(of) @ (speed**2 + rise**2)
        expected.append((kinetic, G * raised, bent, -shaking @ (shares(of) @ speed, shares(of) @ rise)))
    found = uncompiled(values_of, calls)[2:]
    for i, wanted in enumerate(expected):
        bending, straight, power = found[3 * i : 3 * i + 3]
        of_shaft = bending[2] - straight[2]  # the bed stores the same
        assert (*bending[:2], of_shaft, power) == pytest.approx(wanted, rel=1e-8, abs=1e-9)


def test_forces_at_base_and_deck_on_a_bed_are_those_of_the_mass_points(laid, uncompiled):
    """V, moment about the middle of the foot, acceleration of the deck: of v̈ and θ̈ across the shaft as far as modes follow."""
    m, of, foot, sets, lay = laid
    deck, calls, expected = 41.0, [lay], []
    shape = ROCK.modes(PIER).at(deck)
    light = replace(
        of, mass=np.append(of.mass, 1e-9 * of.mass.sum()), x=np.append(of.x, 0.0), z=np.append(of.z, deck),
        shape=np.column_stack([of.shape, shape]),
    )  # fmt: skip
    m = m._replace(shaft=m.shaft._replace(deck_shape=m.shaft.deck_shape._make(map(float, shape))))
    for q, rates, shaking in random_states(5):
        k = reference.accelerations(of, foot, q, rates, sets, shaking)
        x, above, height, _, across, up = places(light, reference.SLIDES_NOWHERE, q)
        along, rise = drift_of(light, reference.SLIDES_NOWHERE, q, rates)
        push_x, push_z = k @ across + along + shaking[0], k @ up + rise + G + shaking[1]
        mass, (s, c) = light.mass / light.mass.sum(), (math.sin(q[1]), math.cos(q[1]))
        of_base = (k[:2] @ across[:2]) * c - (k[:2] @ up[:2]) * s
        followed = (light.shape * light.mass) @ of_base / light.modal_mass @ light.shape
        less = mass @ (of_base - followed)
        place, level = x * c + (above + height) * s, (above + height) * c - x * s
        moment = mass @ (place * push_z - level * push_x)
        force, _ = reference.pushed(foot, q, rates, sets)
        calls.append(
            (
                "observe.beds",
                "forces_on_footing",
                m,
                deck,
                Moment(state(q, rates), SOME, None),
                Ground(shaking[0], 0.0, shaking[1], 0.0),
            )
        )
        shaken_deck = push_x[-1] - (of_base - followed)[-1] * c
        moving = mass @ (rates @ across), mass @ (rates @ up)
        expected.append((mass @ push_x - less / c, force, moment, shaken_deck, *moving))
        assert force == pytest.approx(mass @ push_z, rel=1e-6, abs=1e-6)
    for found, wanted in zip(uncompiled(values_of, calls)[1:], expected, strict=True):
        values = found.shear, found.normal, found.moment, found.deck, found.along, found.up
        assert values == pytest.approx(wanted, rel=2e-6, abs=2e-5)


def test_a_pier_rests_on_a_tilted_bed_where_its_mass_points_do(uncompiled):
    """A soft shaft hangs over; the equilibrium is that of the points, and its energy the least at this rotation."""
    soft = (*TOWER[:4], 2.5)
    pier, of = pier_of(*soft), points_of(*soft, ROCK)
    base = base_of(pier=pier)
    m, foot = footing(pier, base), foot_under(of, base, pier)
    sets, still = sets_of(foot), np.zeros(6)

    def unbalanced(q):
        return reference.accelerations(of, foot, q, still, sets, (0.0, 0.0))

    q = fsolve(unbalanced, np.array([-foot.settlement, 0.001, *np.zeros(4)]), xtol=1e-13)
    assert abs(unbalanced(q)).max() < 1e-7
    rigid = footing(pier, replace(base, shaft="rigid"))
    calls = [("footing.lanes", "start_on_bed", each, PRESSED_DEEP) for each in (m, rigid)]
    calls += [("footing.statics", "lean", each, G) for each in (m, rigid)]
    *_, lean, stiff = uncompiled(values_of, calls)
    assert lean == pytest.approx(q[1], rel=1e-7)
    assert lean > 1.001 * stiff


def test_the_least_energy_at_a_rotation_is_that_of_the_pier_held_there(uncompiled):
    """Work of the moment that holds it, from one rotation to the next, on a bed as it is."""
    soft = (*TOWER[:4], 2.5)
    m = footing(pier_of(*soft), base_of(pier=pier_of(*soft)))
    turns = np.linspace(0.0005, 0.0045, 9)
    calls = [("footing.lanes", "start_on_bed", m, PRESSED_DEEP)]
    calls += [
        ("footing.statics", name, m, float(t), G) for name in ("level_energy", "righting", "level_at") for t in turns
    ]
    energy, moment, level = np.array(uncompiled(values_of, calls)[1:]).reshape(3, -1)
    work = (turns[2:] - turns[:-2]) / 6.0 * (moment[:-2] + 4.0 * moment[1:-1] + moment[2:])
    np.testing.assert_allclose((energy[2:] - energy[:-2])[::2], work[::2], rtol=1e-3)
    held = [("footing.equations", "at_rest", m.shaft, m, float(v), float(t)) for v, t in zip(level, turns, strict=True)]
    calls = [calls[0], *held]
    states = uncompiled(values_of, calls)[1:]
    calls = [calls[0], *(("footing.equations", "energies", m, y) for y in states)]
    of_states = [sum(each) for each in uncompiled(values_of, calls)[1:]]
    np.testing.assert_allclose(of_states, energy, rtol=1e-12)


def test_beyond_its_summit_no_bed_holds_a_pier_whose_shaft_hangs_over(uncompiled):
    """A stiff bed still rights it where a run takes its summit to be, and no longer at that of a rigid one."""
    soft = pier_of(*TOWER[:4], 2.5)
    base = base_of(pier=soft, stiffness=6e5, safety_factor=None, confirm=("beta",))
    m, rigid = footing(soft, base), footing(soft, replace(base, shaft="rigid"))
    level = [("footing.strips", "lay", each) for each in (m, rigid)]
    calls = [*level, *(("footing.statics", "summit", each, G) for each in (m, rigid))]
    own, straight = uncompiled(values_of, calls)[2:]
    assert straight == pytest.approx(soft.alpha, rel=1e-3)
    short = 0.995  # the bed bears on more than its edge
    calls = [*level, *(("footing.statics", "righting", m, short * theta, G) for theta in (own, straight))]
    held, lost = uncompiled(values_of, calls)[2:]
    assert lost < 0.0 < held < 0.02 * G * soft.half_width


def test_a_pier_that_is_let_go_begins_with_its_own_displacements(uncompiled):
    """Its shaft hangs over, and what another run left in its lane is gone."""
    held = replace(PIER, initial_rotation_rad=0.01)
    run = Run(held, base_of(), Motion("still", DT, np.zeros(3)))
    modes, s = run.base.modes(held), math.sin(0.01)
    u = G * s * modes.share / modes.frequency**2
    bent, way = (float(modes.at(height) @ u) for height in (held.highest, held.top))
    found = uncompiled(displaced_at_start, run, 9.0)
    assert found == pytest.approx((bent, held.top * s + way * math.cos(0.01)), rel=1e-9)


@pytest.mark.parametrize("zeta", [0.0, 0.3])
def test_steps_on_a_bed_resolve_the_fastest_motion_of_the_mass_points(zeta):
    """Pressed everywhere, in part, and in the air."""
    base, of = base_of(safety_factor=None, zeta=zeta), points_of(*TOWER, ROCK)
    foot, still = foot_under(of, base), np.zeros(4)
    states = [(-foot.settlement, 0.0), (0.0, 0.001), (0.002, 0.001), (0.05, 0.0)]
    rates = [reference.fastest(of, foot, np.array([*state, *still])) for state in states]
    assert 0.99 * max(rates) < fastest_rate(PIER, base) < 1.1 * max(rates)


@pytest.mark.parametrize("kind", ["bed", "springs"])
def test_devices_hold_a_pier_that_hangs_over_with_its_shaft(kind):
    """Without any it rests at K tilt = (K − g h′) θ, h′ with the shaft's overhang."""
    soft = pier_of(*TOWER[:4], 2.5)
    beds = base_of(pier=soft)
    two = rb.YieldingBase.from_stiffness(soft, 1e6, zeta=0.2, eta=2.2, kinematics="finite", shaft="elastic")
    base = beds if kind == "bed" else two
    tilt, omega_v, b = 1e-4, vertical_frequency(soft, base), soft.half_width
    ends = {
        "v_end": 0.0,
        "theta_end": 0.0,
        "settled": 0.0,
        "bed_tilt": tilt,
        "base_left": tilt * b,
        "base_right": -tilt * b,
    }
    rocking = omega_v**2 * b**2 * base.rocking_share
    rest = rests_at(soft, base, SimpleNamespace(**ends), 0.0, np.zeros(0), np.zeros(0, bool))[1]
    assert rest == pytest.approx(tilt * rocking / (rocking - G * base.leaning_height(soft)), rel=1e-9)


def hard(seconds: float = 1.0, amplitude: float = 5.0, upwards: float = 0.0) -> Motion:
    """One cycle of a sine of 0.9 s, with one of 0.37 s up and down."""
    t = np.arange(0.0, seconds, DT)
    wave, up = (np.sin(2.0 * math.pi * t / period) * (t < 0.9) for period in (0.9, 0.37))
    return Motion("hard", DT, amplitude * wave, upwards * up)


def written(run: Run, steps: int, call) -> tuple:
    """Return the result and the rows at samples of a run with so many steps per sample."""
    found, rows = call(written_run, run, steps, 0.0, 400_000, wait=False)
    rows = rows[: found.rows].view(np.recarray)
    return found, rows[rows.kind == SAMPLE].view(np.recarray)


def test_the_mirror_image_of_a_motion_gives_that_of_the_run_on_a_bed(uncompiled):
    run = Run(PIER, base_of(strips=4), hard(0.8))
    found, rows = written(run, 4, uncompiled)
    mirrored, back = written(replace(run, motion=run.motion.times(1.0, reverse=True)), 4, uncompiled)
    assert found.uplifts > 0.0 < max(found.base_left, found.base_right)
    assert (found.base_left, found.base_right) == pytest.approx((mirrored.base_right, mirrored.base_left), rel=1e-9)
    assert (found.deflection_max, found.drift_max) == pytest.approx(
        (mirrored.deflection_max, mirrored.drift_max), rel=1e-9
    )
    np.testing.assert_allclose(rows.theta, -back.theta, rtol=0.0, atol=1e-13)
    np.testing.assert_allclose(of_modes(rows), -np.array(of_modes(back)), rtol=0.0, atol=1e-11)


def test_the_greatest_displacements_on_a_bed_are_those_of_its_rows(uncompiled):
    found, rows = written(Run(PIER, base_of(strips=4, flexural_modes=2), hard(0.8)), 8, uncompiled)
    modes = ROCK.modes(PIER)
    u = of_modes(rows)[0][:2]
    bent, drift = (modes.at(height)[:2] @ u for height in (PIER.highest, PIER.top))
    assert found.deflection_max == pytest.approx(abs(bent).max(), rel=2e-3)
    drifts = PIER.top * np.sin(rows.theta) + drift * np.cos(rows.theta)
    assert found.drift_max == pytest.approx(abs(drifts).max(), rel=2e-3)
    assert found.drift_max >= abs(drifts).max() > PIER.top * abs(rows.theta).max()


def test_the_energy_balance_of_a_shaft_on_a_yielding_bed_closes(uncompiled):
    """With what the shaft's damping takes; what remains falls with the step, and what is stored is that of the history."""
    left = []
    for steps in (4, 8):
        run = uncompiled(rb.simulate, PIER, base_of(strips=4), hard(0.8), ledger=True, wait=False, substeps=steps)
        left.append(abs(run.ledger.remainder).max() / run.ledger.kinetic.max())
    assert left[1] < 1e-6
    assert left[1] < 0.6 * left[0]
    assert run.ledger.plastic.max() > 0.1 * run.ledger.input.max()
    stored = run.ledger.kinetic + run.ledger.potential + run.ledger.elastic
    np.testing.assert_allclose(run.energy, stored, rtol=0.0, atol=1e-14)


@pytest.mark.slow
def test_a_stiff_shaft_on_a_bed_tends_to_a_rigid_one(uncompiled):
    """As T_f², with one mode."""
    base, off = base_of(strips=4, flexural_modes=1), []
    motion = hard(0.8)
    rigid = uncompiled(run_fixed, PIER, replace(base, shaft="rigid"), motion, 16, quiet_s=0.0, wait=False)
    for period in (0.12, 0.06):
        stiff = uncompiled(
            run_fixed, replace(PIER, flexural_period_s=period), base, motion, 16, quiet_s=0.0, wait=False
        )
        off.append(abs(stiff.theta_max / rigid.theta_max - 1.0))
    assert off[1] < 2e-3
    assert off[1] < 0.4 * off[0]


def test_errors_on_a_bed_have_the_shares_of_modes_and_of_strips():
    """Of the peak, the residual rotation, the settlement, the deflection and the drift."""
    names = ("theta_max", "theta_res", "settlement", "deflection_max", "top_drift_max")
    of = BLANK.changed(status="ok", **dict.fromkeys(names, 1.0), **{f"{name}_error": 0.01 for name in names})
    other = of.changed(**dict.fromkeys(names, 1.1))
    modes = with_modes_error(of, other, 4.0)
    assert [getattr(modes, f"{name}_error") for name in names] == pytest.approx([0.41] * 5)
    bed = BedDemands(
        contact_least=0.5,
        force=1.0,
        t_force=0.0,
        pressure=None,
        t_pressure=0.0,
        pressure_at=0.0,
        yielding_rocks=0,
        work=0.0,
    )
    own, fewer = (Trial(each.changed(bed=bed), np.array([0.5, each.theta_max])) for each in (of, other))
    strips = with_strips_error(own.outcome, own, fewer, 1.0)
    assert [getattr(strips, f"{name}_error") for name in names] == pytest.approx([0.44] * 5)


def test_runs_of_a_shaft_on_a_bed_are_repeated_with_fewer_modes_and_strips():
    run = Run(PIER, base_of(), hard())
    fewer = [(other.base.strips, len(other.base.modes(PIER).frequency)) for other in coarser(run)]
    assert fewer == [(8, 3), (4, 4)]
    assert [other.base.strips for other in coarser(replace(run, base=replace(run.base, shaft="rigid")))] == [4]
    assert coarser(replace(run, base=rb.RigidBase())) == []
    ten = replace(run, base=replace(run.base, shaft="rigid", strips=10))
    assert [other.base.strips for other in coarser(ten)] == [4]  # five would be refused


def random_pier(number: int):
    """A pier of :func:`pier_of`, its footing, and a motion, some of them up and down as well."""
    rng = np.random.default_rng(number)
    height = rng.uniform(20.0, 45.0)
    width, shaft, deck = height * rng.uniform(0.2, 0.35), rng.uniform(1000.0, 4000.0), rng.uniform(200.0, 3000.0)
    of = width, height, (shaft, 0.3 * width), (deck, rng.uniform(0.5, 3.0)), rng.uniform(0.3, 1.2)
    pier = pier_of(*of)
    base = rb.FootingBase(
        1.8 * pier.least_beta * rng.uniform(1.5, 4.0), rng.choice([1.5, 2.2, 4.0, None]), rng.choice([0.0, 0.05, 0.2]), "finite",
        strips=6, shaft="elastic", flexural_damping=0.03, flexural_modes=int(rng.integers(1, 4)), confirm=("beta",),
    )  # fmt: skip
    t, period = np.arange(0.0, 1.6, DT), rng.uniform(0.4, 1.0)
    wave = np.sin(2.0 * math.pi * t / period) * (t < period)
    up = rng.choice([0.0, 0.0, 6.0]) * np.sin(2.0 * math.pi * t / (0.3 * period)) * (t < period)
    return of, pier, base, Motion("one sine", DT, G * width / height * rng.uniform(0.8, 3.0) * wave, up)


@pytest.mark.thorough
@pytest.mark.parametrize("number", range(20))
def test_random_piers_on_yielding_beds_move_as_their_mass_points_do(number):
    """Peak, course, modes and sets: relative to the peak, the deflection and the settlement, by small steps without events."""
    of, pier, base, motion = random_pier(number)
    points = points_of(*of, replace(ROCK, flexural_modes=base.flexural_modes))
    foot = foot_under(points, base, pier)
    course = reference.run(points, foot, np.column_stack([motion.horizontal, motion.vertical]), DT, 1.5, rtol=1e-9)
    steps = max(8, math.ceil(fastest_rate(pier, base) * DT / 0.02))
    found, rows = written(Run(pier, base, motion), steps, lambda function, *given, **named: function(*given, **named))
    rows, expected = rows[: len(course.at_samples)].view(np.recarray), course.at_samples
    peak, bent = abs(expected[:, 1]).max(), abs(expected[:, 2:]).max()
    np.testing.assert_allclose(rows.theta, expected[:, 1], rtol=0.0, atol=1e-4 * peak)
    np.testing.assert_allclose(of_modes(rows)[0][: base.flexural_modes].T, expected[:, 2:], rtol=0.0, atol=1e-3 * bent)
    for edge, plastic in ((found.base_left, course.sets[0]), (found.base_right, course.sets[-1])):
        assert edge == pytest.approx(plastic, abs=2e-4 * max(foot.settlement, plastic))


@pytest.mark.thorough
def test_the_shear_of_a_shaft_on_a_bed_is_that_of_a_column_of_elements():
    """A stiff tower on a bed that its weight presses by 7 mm, by one to four modes of twenty elements, by (E9)."""
    parts = [rb.Part(3000.0, 20.0, 3000.0 * 40.0**2 / 12.0, 40.0), rb.Part(1500.0, 40.0, 1.5, 0.0)]
    pier = replace(rb.Pier.of_parts(8.0, parts, top_m=40.0), flexural_period_s=0.4)
    t, beta = np.arange(0.0, 3.6, 0.005), math.sqrt(G / 0.007) / pier.p
    motion = Motion("sine", 0.005, 4.0 * np.sin(math.pi * t) * (t < 2.0))
    for modes, shear in ((1, 7.8), (2, 7.2), (3, 7.09), (4, 7.05)):
        base = rb.FootingBase(beta, None, 0.3, "finite", strips=20, shaft="elastic", flexural_modes=modes)
        steps = 2 * first_substeps(pier, base, motion.dt)
        run = rb.simulate(pier, base, motion, forces=True, wait=False, substeps=steps)
        assert run.row.base_shear_kN == pytest.approx(1000.0 * shear, rel=0.01)
