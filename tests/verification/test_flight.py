"""Flight above the rigid base (THEORY.md, Rigid base): known motions and landings, order, energy, symmetry, a second solver.

Values of motions and landings come from another event-driven solver (known_flights.py).
"""

import math
import re
from dataclasses import replace

import numpy as np
import pytest
from known_flights import KNOWN_ENDS, KNOWN_LANDINGS, KNOWN_PEAKS, MOTIONS, PIER, check_ends, given

import rockbatch as rb
from rockbatch.common.units import GRAVITY
from rockbatch.core.block.equations import clearances, lever, on_pivot
from rockbatch.core.block.model import Rocking, Stance
from rockbatch.core.system import transition
from rockbatch.core.types import (
    CONTACT_LEFT,
    CONTACT_RIGHT,
    IMPACT_BOTH,
    IMPACT_LEFT,
    IMPACT_RIGHT,
    LEFT,
    RIGHT,
    TAKE_OFF,
    Ground,
    Moment,
)
from rockbatch.motions.motion import Motion
from rockbatch.outcome.outcome import RELEASED
from rockbatch.pier import ElasticBase, RigidBase, Tendon
from rockbatch.simulation import Run, block, run_fixed, run_to_tolerance, written_run
from rockbatch.simulation.recording import recorded

MODEL = block(PIER, RigidBase())
STILL = Ground(0.0, 0.0, 0.0, 0.0)
LANDINGS = (IMPACT_LEFT, IMPACT_RIGHT, IMPACT_BOTH)


def rows_of(motion: Motion, substeps: int, base: RigidBase | None = None):
    """Result and history of a run until the end of its record."""
    found, rows = written_run(Run(PIER, base or RigidBase(), motion), substeps, 0.0, 20_000, wait=False)
    return found, rows[: found.rows].view(np.recarray)


# Known motions


@KNOWN_ENDS
def test_known_flights_take_off_and_land(name, off, on):
    found, rows = rows_of(MOTIONS[name], 16)
    (left,) = np.flatnonzero(rows.kind == TAKE_OFF)
    landed = left + np.flatnonzero(np.isin(rows.kind[left:], LANDINGS))[0]
    check_ends(off, on, [(row.t, row.theta, row.omega) for row in (rows[left], rows[landed])])
    assert (found.flights, found.t_flight) == (1, rows[left].t)
    assert found.flight_duration == pytest.approx(rows[landed].t - found.t_flight, abs=1e-15)


@KNOWN_PEAKS
def test_known_flights_reach_their_height_and_rotation(name, height, theta_max, t_max):
    """Half a unit of the last digit, and 1e-10: RK4 at p h = 3e-3, whose rotations and heights are right to 1e-11."""
    found, _ = rows_of(MOTIONS[name], 16)
    assert found.flight_height == pytest.approx(height, abs=1e-10)
    assert found.theta_max / PIER.alpha == pytest.approx(theta_max, abs=6e-10)
    assert found.t_max == pytest.approx(t_max, abs=6e-7)


def test_a_block_rests_after_both_pivots_have_landed_at_one_instant():
    found, rows = rows_of(MOTIONS["S1"], 4)
    assert rows.kind[rows.kind > 0.0].tolist() == [TAKE_OFF, IMPACT_BOTH]
    assert (found.impacts, found.theta_max) == (2, 0.0)
    after = rows[rows.t > 0.36]
    assert not after.v.any()
    assert not after.v_rate.any()


@pytest.mark.parametrize("name", ["S2", "S3"])
def test_order_is_four_through_flights(name):
    """Over three halvings, from 2 to 16 steps per 0.05 s: the time in flight and the peak after it within 4 ± 0.2."""
    coarse, fine, exact = (rows_of(MOTIONS[name], substeps)[0] for substeps in (2, 16, 128))
    for field in ("flight_duration", "theta_max"):
        errors = [abs(getattr(found, field) - getattr(exact, field)) for found in (coarse, fine)]
        assert math.log2(errors[0] / errors[1]) / 3 == pytest.approx(4.0, abs=0.2)


@pytest.mark.parametrize("name", ["S2", "S3"])
def test_no_step_makes_more_of_one_flight(name):
    """A take-off that is located too early would land where it stands and take off again."""
    for substeps in (1, 2, 3, 5, 8, 12, 16, 24, 48):
        found, rows = rows_of(MOTIONS[name], substeps)
        assert (found.flights, np.count_nonzero(rows.kind == TAKE_OFF)) == (1, 1), substeps
        assert found.t_flight == pytest.approx({"S2": 0.0840626666, "S3": 0.1336854198}[name], abs=2e-10)


@pytest.mark.parametrize("name", list(MOTIONS))
def test_flight_ends_the_run_where_a_base_says_stop(name):
    guided = run_fixed(PIER, RigidBase(), MOTIONS[name], 8)
    stopped = run_fixed(PIER, RigidBase(flight="stop"), MOTIONS[name], 8)
    assert (guided.status, stopped.status, stopped.flights) == ("ok", "flight", 1)
    assert stopped.t_end == stopped.t_flight == guided.t_flight


@pytest.mark.parametrize("flight", ["guided", "stop"])
@pytest.mark.parametrize("substeps", [1, 3, 8])
def test_a_pier_that_the_ground_does_not_bear_and_that_gains_no_height_has_not_flown(flight, substeps):
    """N = 0 while v̈_g = −g: it stands where it stood, and flies once the ground falls faster."""
    base = RigidBase(flight=flight)
    for vertical in ([0, -1, -1, -1, -1, 0], [0, -1, 0]):
        held = run_fixed(PIER, base, given([0], vertical), substeps)
        assert (held.status, held.flights, held.t_flight, held.flight_height) == ("ok", 0, None, 0.0)
        assert (held.impacts, held.separations) == (0, 0)
    rocks = run_fixed(PIER, base, given([0, 0, 0.1, 0, 0], [0, -1, -1, -1, 0]), substeps)
    assert rocks.separations == 1
    assert rocks.t_flight is None or rocks.t_flight > 0.1  # it is turned by the ground, and does not leave it at first
    flown = run_fixed(PIER, base, given([0], [0, -1, -1, -1.2, -1, 0]), substeps)
    assert flown.flights == 1
    assert flown.t_flight == pytest.approx(0.1, abs=1e-9)
    assert flown.status == {"guided": "ok", "stop": "flight"}[flight]
    assert (flown.flight_height > 1e-3) == (flight == "guided")


# What a run says of it


@pytest.mark.parametrize("name", list(MOTIONS))
def test_a_flight_above_the_limit_of_the_base_is_noted_with_both_in_mm(name):
    height = 1e3 * run_fixed(PIER, RigidBase(flight_limit_mm=1e4), MOTIONS[name], 4).flight_height
    above, below = (
        run_fixed(PIER, RigidBase(flight_limit_mm=share * height), MOTIONS[name], 4) for share in (0.98, 1.02)
    )
    assert [float(number) for number in re.findall(r"[\d.]+", above.note)] == pytest.approx(
        [height, 0.98 * height], rel=0.05
    )
    assert below.note == ""


def test_a_peak_that_is_the_release_is_noted_of_a_run_that_went_through():
    """The one that is cut short by a flight may have turned further."""
    leaning = replace(PIER, initial_rotation_rad=0.05)
    motions = {
        "still": given([0], [0]),
        "shaken": given([0, 0.5, 0.5, 0.5], [0]),
        "falling": given([0], [0, -1.5, -1.5, -1.5]),
    }
    found = {
        (name, pier.initial_rotation_rad): run_fixed(pier, RigidBase(flight="stop"), motion, 4)
        for name, motion in motions.items()
        for pier in (PIER, leaning)
    }
    assert {run for run, outcome in found.items() if RELEASED in outcome.note} == {("still", 0.05)}
    assert found["still", 0.05].theta_max == found["falling", 0.05].theta_max == 0.05
    assert found["falling", 0.05].status == "flight"
    assert found["shaken", 0.05].theta_max > 0.05


# Landings


def in_flight(theta, omega, v_rate, pivot):
    """State of a block in flight whose ``pivot`` is on the ground."""
    v, _ = on_pivot(MODEL, theta, pivot)
    return Rocking(v, theta, v_rate, omega)


def land(m, y, bore, pivot):
    """State, stance and kind after ``pivot`` has landed from a flight for which the pivot ``bore`` has borne last."""
    which = CONTACT_LEFT if pivot == LEFT else CONTACT_RIGHT
    landed = transition(m, None, Moment(y, Stance(0.0, 0.0, bore, bore), None), which, STILL, 0.01)
    return landed.now.y, landed.now.contact, landed.kind


def pivot_velocity(m, y, pivot):
    return clearances(m, y, pivot)[2 if pivot == LEFT else 3]


@KNOWN_LANDINGS
def test_known_landings(pivot, theta, omega, v_rate, speed, after):
    y = in_flight(theta, omega, v_rate, pivot)
    assert pivot_velocity(MODEL, y, pivot) == pytest.approx(speed, abs=1e-9)
    for bore, expected in after.items():
        landed, stance, kind = land(MODEL, y, bore, pivot)
        assert landed.omega == pytest.approx(expected, abs=1e-9)
        assert pivot_velocity(MODEL, landed, pivot) == pytest.approx(0.0, abs=1e-15)
        assert stance == (Stance(1.0, 0.0, LEFT, LEFT) if pivot == LEFT else Stance(0.0, 1.0, RIGHT, RIGHT))
        assert kind == (IMPACT_LEFT if pivot == LEFT else IMPACT_RIGHT)


def random_landings(count=300):
    """Random states in which a pivot lands: state, pivot, and the pivot that bore last."""
    rng = np.random.default_rng(7)
    while count:
        pivot = float(rng.choice([LEFT, RIGHT]))
        y = in_flight(pivot * rng.uniform(0.0, 1.2), rng.normal(), rng.normal(), pivot)
        if pivot_velocity(MODEL, y, pivot) < 0.0:
            count -= 1
            yield y, pivot, float(rng.integers(-1, 2))


def kinetic(m, y, contact):
    arm = lever(m, y, contact)
    return 0.5 * (y.v_rate**2 + (m.inertia + arm**2) * y.omega**2)


def test_no_plastic_landing_gains_energy():
    for y, pivot, bore in random_landings():
        landed, stance, _ = land(MODEL, y, bore, pivot)
        assert kinetic(MODEL, landed, stance) <= kinetic(MODEL, y, Stance(0.0, 0.0, bore, bore)) * (1.0 + 1e-12)


@pytest.mark.parametrize("epsilon", [0.0, 0.3, 1.0])
def test_a_landing_keeps_angular_momentum_and_returns_a_share_of_its_velocity(epsilon):
    """I0/M θ̇ + z ẋ − x ż of the centre of mass: ẋ = H θ̇ with the key of the pivot that bears, before and after."""
    m = MODEL._replace(epsilon=epsilon)
    for y, pivot, bore in random_landings(100):
        landed, stance, _ = land(m, y, bore, pivot)
        z = lever(m, y, Stance(0.0, 0.0, pivot, pivot))
        x = m.height * math.sin(y.theta) - pivot * m.half_width * math.cos(y.theta)
        momenta = [
            m.inertia * each.omega + z * lever(m, each, Stance(0.0, 0.0, key, key)) * each.omega - x * each.v_rate
            for each, key in ((y, bore), (landed, pivot))
        ]
        assert momenta[1] == pytest.approx(momenta[0], rel=1e-12, abs=1e-12)
        back = -epsilon * pivot_velocity(m, y, pivot)
        assert pivot_velocity(m, landed, pivot) == pytest.approx(back, abs=1e-13)
        assert stance.left + stance.right == (1.0 if epsilon == 0.0 else 0.0)


def test_a_landing_upright_is_housners_impact():
    y = in_flight(0.0, -0.3, -0.3 * PIER.half_width, RIGHT)
    landed, _, _ = land(MODEL, y, RIGHT, LEFT)
    assert landed.omega == pytest.approx(-0.3 * PIER.restitution, rel=1e-14)


# Energy and symmetry


@pytest.mark.parametrize("name", ["S2", "S3"])
def test_the_energy_balance_closes_through_flights(name):
    """To the error of RK4 and Simpson's rule, which falls by 2⁴ a halving."""
    runs = [rb.simulate(PIER, RigidBase(), MOTIONS[name], substeps=substeps, ledger=True) for substeps in (2, 8)]
    coarse, fine = (run.ledger for run in runs)
    assert runs[0].history.energy.to_numpy() == pytest.approx(coarse.kinetic + coarse.potential, rel=1e-12, abs=1e-12)
    assert fine.remainder.abs().max() < 1e-9 * fine.input.abs().max()
    assert coarse.remainder.abs().max() > 12.0**2 * fine.remainder.abs().max()
    assert np.diff(fine.impact).min() > -1e-12


def test_a_stone_keeps_its_energy_in_the_air():
    """S1 from 0.2 s on, when the ground rests: what is stored is constant until the landing, which takes all that moves."""
    rows = rb.simulate(PIER, RigidBase(), MOTIONS["S1"], substeps=4, ledger=True).ledger
    stored = (rows.kinetic + rows.potential)[(rows.t > 0.2) & (rows.t < 0.3558)]
    assert np.ptp(stored) < 1e-14 * stored.max()
    assert rows.impact.iloc[-1] == pytest.approx(stored.iloc[0], rel=1e-12)


@pytest.mark.parametrize("name", ["S2", "S3"])
@pytest.mark.parametrize("substeps", [1, 3])
def test_the_mirror_image_flies_alike_to_the_bit(name, substeps):
    motion = MOTIONS[name]
    found, rows = rows_of(motion, substeps)
    other, mirrored = rows_of(replace(motion, horizontal=-motion.horizontal), substeps)
    for field in ("theta_max", "t_max", "flights", "t_flight", "flight_duration", "flight_height", "impacts", "rows"):
        assert getattr(other, field) == getattr(found, field)
    for field, sign in (("t", 1.0), ("v", 1.0), ("v_rate", 1.0), ("theta", -1.0), ("omega", -1.0), ("bore", -1.0)):
        assert (mirrored[field] == sign * rows[field]).all()
    assert (mirrored.left == rows.right).all()


# A second solver


@pytest.mark.slow
def test_random_flights_are_those_of_the_independent_reference(outcomes, references):
    """Counts, times, heights and peaks of cases that stand, with the steps that a tolerance of 1e-6 α takes.

    The reference counts a flight anew at each landing behind which the ground would have to hold the pier; it is one flight.
    """
    compared = 0
    for case in outcomes.cases(30, only="flight"):
        case, expected, _ = references.get(case)
        if expected.status != "stands" or expected.flights == 0:
            continue
        found = run_to_tolerance(case.pier, case.base, case.motion, 1e-6)
        assert found.status == "ok"
        rows = recorded(Run(case.pier, case.base, case.motion), found, 2.0, every_step=False).rows
        aloft = rows.left + rows.right == 0.0
        goes_on = np.isin(rows.kind[1:], (IMPACT_LEFT, IMPACT_RIGHT)) & aloft[1:] & aloft[:-1]
        assert found.flights + goes_on.sum() == expected.flights
        assert found.flight_duration == pytest.approx(expected.flight_duration, abs=1e-6 / case.pier.p)
        assert found.flight_height == pytest.approx(expected.flight_height, abs=1e-6 * case.pier.half_width)
        assert found.theta_max == pytest.approx(expected.theta_max, abs=1e-6 * case.pier.alpha)
        compared += 1
    assert compared >= 12


# Tendons


@pytest.mark.parametrize(
    "base",
    [
        pytest.param(RigidBase(), id="rigid"),
        pytest.param(
            ElasticBase(400.0, zeta=0.1, kinematics="finite"), id="elastic", marks=pytest.mark.slow
        ),  # compiled by itself
    ],
)
def test_a_tendon_of_twice_the_weight_keeps_a_pier_on_ground_that_falls_away(base):
    """−1.05 g for 0.2 s: it presses with 1.95 times the weight, and tendons are shorter on springs that unload."""
    motion = rb.pulse("sine", name="sine", amplitude=4.0, period=1.0, dt=0.005, duration=6.0)
    vertical = np.zeros(motion.npts)
    vertical[100:140] = -1.05 * GRAVITY
    motion = replace(motion, vertical=vertical)
    tied = replace(base, restraints=(Tendon(psi=2.0, lam=0.5),))
    free, held = (run_to_tolerance(PIER, each, motion, 1e-4) for each in (base, tied))
    assert free.flights > 0
    assert (held.status, held.flights, held.t_flight) == ("ok", 0, None)


def test_a_tendon_less_strong_than_the_fall_lets_the_pier_fly():
    """ψ = 0.2 without stiffness: flight where v̈_g = −1.2 g, 0.08 s into a ramp of −1.5 g in 0.1 s."""
    ramp = Motion("ramp", 0.1, np.zeros(21), -1.5 * GRAVITY * np.minimum(np.arange(21), 1.0))
    outcome = run_fixed(PIER, RigidBase(flight="stop", restraints=(Tendon(psi=0.2),)), ramp, 4)
    assert (outcome.status, outcome.t_flight) == ("flight", pytest.approx(0.08, abs=1e-12))
