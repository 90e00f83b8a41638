"""The independent reference on guided flight above the rigid base: closed forms, Lagrange's equations, known motions.

Values of motions and landings for α = 0.2, p = 1, μ = 3, g = 9.81 come from another event-driven solver.
"""

import importlib
import math

import numpy as np
import pytest

from rockbatch.motions import Motion
from rockbatch.pier import Pier, RigidBase

pytestmark = pytest.mark.slow  # compiled by itself
PIER = Pier(alpha=0.2, p=1.0)
G = PIER.gravity
SIDES = {"L": -1, "R": 1, "rest": 0}
FIELDS = ("t_flight", "flight_duration", "flight_height", "theta_max", "t_max")


@pytest.fixture(scope="module")
def core(outcomes):
    """Its compiled solver."""
    return importlib.import_module("independent.dop853")


@pytest.fixture(scope="module")
def par(outcomes):
    """Parameters of the block."""
    return importlib.import_module("independent.reference").parameters(PIER, RigidBase())[0]


@pytest.fixture(scope="module")
def reference(outcomes):
    return outcomes.reference


def motion(horizontal, vertical, seconds=3.0, dt=0.05):
    """Samples in g, zeros after them."""
    npts = round(seconds / dt) + 1
    u, w = (np.pad(np.array(values, float) * G, (0, npts - len(values))) for values in (horizontal, vertical))
    return Motion("given", dt, u, w)


MOTIONS = {
    "S1": motion([0], [0, -1.5, -1.5, -1.5, 0]),
    "S2": motion([0, 0.3, 0.3, 0.3, -0.1, 0], [0, -0.5, -1.3, -1.3, -0.4, 0.3, 0]),
    "S3": motion([0, 0.4, 0.8, 0.4, 0, -0.3, -0.3, 0], [0, 0, 0, -1.6, -1.6, 0, 0.5, 0]),
}


def ending_with_flight():
    """A rigid base whose ``flight`` is "stop"."""
    base = RigidBase()
    object.__setattr__(base, "flight", "stop")
    return base


def state(theta, omega, v_rate, par, core, side):
    """y of a block in flight whose pivot on ``side`` is on the ground."""
    y = np.zeros(core.SIZE)
    y[1], y[2], y[3] = theta, v_rate, omega
    y[0] = -core.pivots(y, par)[(side + 1) // 2]
    return y


def centre(theta, side):
    """Centre of mass over the pivot on ``side`` (0: the middle of the base seen from above): horizontal, vertical."""
    b, h = PIER.half_width, PIER.height
    return h * math.sin(theta) - side * b * math.cos(theta), h * math.cos(theta) + side * b * math.sin(theta)


def slope(function, x, step=1e-5):
    """Derivative by central differences of fourth order."""
    differences = [function(x + k * step) - function(x - k * step) for k in (1, 2)]
    return (8 * differences[0] - differences[1]) / (12 * step)


def kinetic(theta, omega, v_rate, side):
    """Kinetic energy per unit mass of a block whose pivot on ``side`` stays in its place horizontally."""
    inertia = PIER.half_width**2 + PIER.height**2
    across = slope(lambda angle: centre(angle, side)[0], theta)
    return 0.5 * (across * omega) ** 2 + 0.5 * v_rate**2 + 0.5 * inertia / PIER.mu * omega**2


def test_normal_force_is_what_the_centre_of_mass_asks_for(core, par):
    """N/M = g + v̈_g + d²/dt² of its height over the pivot, θ̈ being that of rocking; and its rate along the motion."""
    rng = np.random.default_rng(1)
    for _ in range(20):
        side, ground = int(rng.choice([-1, 1])), rng.normal(size=4) * G
        y, f = np.zeros(core.SIZE), np.zeros(core.SIZE)
        y[1], y[3] = side * rng.uniform(0, 0.6), rng.normal()
        core.rhs(y, f, 0.0, ground, np.array([core.CONTACT, core.CONTACT, 0, 0, side]), par)

        def height(t, y=y, f=f, side=side):
            return centre(y[1] + y[3] * t + 0.5 * f[3] * t**2, side)[1]

        def force(t, y=y, f=f, ground=ground, side=side):
            return core.normal_force(y + f * t, side, ground, t, par)[0]

        upward = slope(lambda t, height=height: slope(height, t, 1e-3), 0.0, 1e-3)
        assert force(0.0) == pytest.approx(G + ground[2] + upward, abs=1e-8)
        assert core.normal_force(y, side, ground, 0.0, par)[1] == pytest.approx(slope(force, 0.0), rel=1e-8, abs=1e-7)


@pytest.mark.parametrize("side", [-1, 0, 1])
def test_flight_obeys_lagrange(core, par, side):
    """d/dt ∂T/∂θ̇ − ∂T/∂θ = −H ü_g, with H from where the key puts the centre of mass; v̈ = −g − v̈_g."""
    theta, omega, u, w = -0.07, 0.4, 0.3 * G, -1.2 * G
    y, f = state(theta, omega, -0.2, par, core, -1), np.zeros(core.SIZE)
    core.rhs(y, f, 0.0, np.array([u, 0.0, w, 0.0]), np.array([core.FREE, core.FREE, 0, 0, side]), par)

    def momentum(t):
        return slope(lambda rate: kinetic(theta + omega * t, rate, 0.0, side), omega + f[3] * t, 1e-3)

    force = slope(momentum, 0.0, 1e-3) - slope(lambda angle: kinetic(angle, omega, 0.0, side), theta, 1e-3)
    H = slope(lambda angle: centre(angle, side)[0], theta)
    assert force == pytest.approx(-H * u, rel=1e-7)
    assert f[2] == -G - w


@pytest.mark.parametrize(
    ("landing", "theta", "omega", "v_rate", "speed", "after"),
    [
        ("R", 0.02, 0.1, -0.5, -0.631721009, {"R": 0.088471280, "L": 0.087884940, "rest": 0.088178110}),
        ("R", 0.02, -0.1, -0.5, -0.368278991, {"R": -0.106720982, "L": -0.106134642, "rest": -0.106427812}),
        ("L", -0.03, 0.05, -0.8, -0.737762043, {"R": 0.062282879, "L": 0.062723376, "rest": 0.062503128}),
    ],
)
def test_known_landings(core, par, landing, theta, omega, v_rate, speed, after):
    """Printed to nine decimals."""
    pivot = (SIDES[landing] + 1) // 2
    y = state(theta, omega, v_rate, par, core, SIDES[landing])
    assert core.pivot_velocity(y, pivot, par) == pytest.approx(speed, abs=1e-9)
    for bore_last, expected in after.items():
        turn, up = core.rebound(y, SIDES[bore_last], pivot, 0.0, par)
        assert turn == pytest.approx(expected, abs=1e-9)
        y_after = y.copy()
        y_after[2], y_after[3] = up, turn
        assert core.pivot_velocity(y_after, pivot, par) == pytest.approx(0, abs=1e-15)


def landings(core, par, count=300):
    """Random states at which a pivot lands: (y, pivot, side that bore last)."""
    rng = np.random.default_rng(7)
    while count:
        pivot = int(rng.integers(2))
        y = state((2 * pivot - 1) * rng.uniform(0, 1.2), rng.normal(), rng.normal(), par, core, 2 * pivot - 1)
        if core.pivot_velocity(y, pivot, par) < 0:
            count -= 1
            yield y, pivot, int(rng.integers(-1, 2))


@pytest.mark.parametrize("epsilon", [0.0, 0.6])
def test_landings_keep_angular_momentum_about_the_pivot_that_lands(core, par, epsilon):
    inertia = (PIER.half_width**2 + PIER.height**2) / PIER.mu
    for y, pivot, side in landings(core, par):
        landing = 2 * pivot - 1
        x, z = centre(y[1], landing)

        def momentum(turn, up, key, x=x, z=z, theta=y[1]):
            return inertia * turn + z * slope(lambda angle: centre(angle, key)[0], theta) * turn - x * up

        turn, up = core.rebound(y, side, pivot, epsilon, par)
        assert momentum(turn, up, landing) == pytest.approx(momentum(y[3], y[2], side), rel=1e-9, abs=1e-9)


def test_plastic_landings_gain_no_energy(core, par):
    for y, pivot, side in landings(core, par):
        turn, up = core.rebound(y, side, pivot, 0.0, par)
        before, after = kinetic(y[1], y[3], y[2], side), kinetic(y[1], turn, up, 2 * pivot - 1)
        assert after <= before * (1 + 1e-9)


@pytest.mark.parametrize("epsilon", [0.3, 1.0])
def test_elastic_landings_of_the_pivot_that_bore_last_gain_no_energy(core, par, epsilon):
    """Of another pivot they may: its key stops a horizontal velocity while the vertical one is given back."""
    for y, pivot, _ in landings(core, par):
        side = 2 * pivot - 1
        turn, up = core.rebound(y, side, pivot, epsilon, par)
        before, after = kinetic(y[1], y[3], y[2], side), kinetic(y[1], turn, up, side)
        assert after <= before * (1 + 1e-9)
        assert (epsilon < 1) or after == pytest.approx(before, rel=1e-9)


def test_landing_upright_is_housners_impact(core, par):
    """θ falls to 0 about R: L lands."""
    y = state(0.0, -0.3, -0.3 * PIER.half_width, par, core, 1)
    turn, _ = core.rebound(y, SIDES["R"], 0, 0.0, par)
    assert turn == pytest.approx(-0.3 * PIER.restitution, rel=1e-14)


@pytest.mark.parametrize(
    ("name", "off", "on"),
    [
        ("S1", (0.033333333, 0, 0), (0.355826237, 0, 0)),
        ("S2", (0.0840627, -2.35821e-4, -0.0108852), (0.2595392, -5.39385e-3, -0.0231916)),
        ("S3", (0.1336854, -1.60352e-3, -0.0407583), (0.3401056, -0.01131013, -0.0121420)),
    ],
)
def test_known_flights_take_off_and_land(reference, name, off, on):
    """Time, θ and θ̇, printed to six to nine digits; after the landing for θ̇."""
    trace = np.zeros((2000, 7))
    found = reference(PIER, RigidBase(), MOTIONS[name], trace=trace)
    flying = np.flatnonzero((trace[:, 4] == 0) & (trace[:, 0] > 0))
    for row, expected in ((trace[flying[0]], off), (trace[flying[-1] + 1], on)):
        assert row[0] == pytest.approx(expected[0], abs=6e-8)
        assert row[1] == pytest.approx(expected[1], rel=3e-6)
        assert row[2] == pytest.approx(expected[2], rel=5e-6)
    assert found.flights == 1
    assert found.t_flight == trace[flying[0], 0]
    assert found.flight_duration == pytest.approx(trace[flying[-1] + 1, 0] - found.t_flight, abs=1e-15)


@pytest.mark.parametrize(
    ("name", "height", "theta_max", "t_max"),
    [
        ("S1", 0.063923950, 0.0, 0.0),
        ("S2", 0.01154271, 0.033450660, 0.375071),
        ("S3", 0.02934590, 0.058402522, 0.402892),
    ],
)
def test_known_flights_reach_their_height_and_rotation(reference, name, height, theta_max, t_max):
    """The heights that are known are of the highest of many samples: too low by up to 1.4e-8 m (S1 has a closed form)."""
    found = reference(PIER, RigidBase(), MOTIONS[name])
    assert found.status == "stands"
    assert height < found.flight_height < height + 2e-8
    assert found.theta_max / PIER.alpha == pytest.approx(theta_max, abs=6e-10)
    assert found.t_max == pytest.approx(t_max, abs=6e-7)
    assert abs(found.balance) < 1e-14
    assert found.forced == 0


def test_falls_and_flies_as_a_stone_does(reference):
    """S1: −v̈_g passes g at 1/30 s, stays at 1.5 g for 0.1 s and falls to nothing within 0.05 s; then free fall."""
    found = reference(PIER, RigidBase(), MOTIONS["S1"])
    slope_up, extra = 30 * G, 0.5 * G
    speed, height, t = slope_up / 2 / 60**2, slope_up / 6 / 60**3, 0.15
    height += 0.1 * speed + extra * 0.1**2 / 2
    speed += 0.1 * extra
    height += 0.05 * speed + extra * 0.05**2 / 2 - slope_up * 0.05**3 / 6
    speed += 0.05 * extra - slope_up * 0.05**2 / 2
    t = 0.2 + (speed + math.sqrt(speed**2 + 2 * G * height)) / G
    assert found.flight_height == pytest.approx(height + speed**2 / (2 * G), rel=1e-13)
    assert found.t_flight + found.flight_duration == pytest.approx(t, rel=1e-14)
    assert (found.theta_max, found.impacts) == (0.0, 2)


@pytest.mark.parametrize("name", ["S2", "S3"])
def test_the_mirror_image_flies_alike(reference, name):
    given = MOTIONS[name]
    mirrored = Motion("mirrored", given.dt, -given.horizontal, given.vertical)
    found, other = (reference(PIER, RigidBase(), each) for each in (given, mirrored))
    for field in FIELDS:
        assert getattr(other, field) == pytest.approx(getattr(found, field), rel=1e-12)
    assert (other.flights, other.impacts) == (found.flights, found.impacts)


@pytest.mark.parametrize("name", list(MOTIONS))
def test_a_base_that_stops_at_flight_ends_the_run_there(reference, name):
    guided, stopped = (reference(PIER, base, MOTIONS[name]) for base in (RigidBase(), ending_with_flight()))
    assert (stopped.status, stopped.flights) == ("flew", 1)
    assert stopped.t_end == stopped.t_flight == guided.t_flight
    assert stopped.theta_max == stopped.peak_flight == guided.peak_flight


def test_a_slender_block_leaves_the_ground_before_it_lies_on_it(reference):
    """Toppling from rest N/M = g (1 − 3 cos φ)²/4 for μ = 3: any more energy lifts it near φ = −arccos ⅓. It has overturned."""
    push = motion([0.0, 0.6, 0.6, 0.6, 0.6, 0.6, 0.6, 0.6, 0.6, 0.6, 0.6, 0.6, 0.6], [0.0])
    for base in (RigidBase(), ending_with_flight()):
        found = reference(PIER, base, push)
        assert (found.status, found.flights, found.theta_max) == ("overturned", 1, pytest.approx(math.pi / 2))
        assert abs(found.theta_flight) == pytest.approx(PIER.alpha + math.acos(1 / 3), abs=0.2)


def test_flight_out_of_rest_turns_about_the_middle(reference):
    """Pushed only once it is in the air, the block keeps the middle of its base in place, H = h cos θ."""
    drop = motion([0, 0, 0, 0.5, 0.5, 0], [0, -1.5, -1.5, -1.5, -1.5, -1, 0])
    trace = np.zeros((2000, 7))
    found = reference(PIER, RigidBase(), drop, trace=trace)
    row = trace[np.argmin(np.abs(trace[:, 0] - 0.15))]
    assert (row[0], row[4]) == (pytest.approx(0.15, abs=1e-15), 0)  # half a push of 0.05 s, hardly any rotation
    inertia = (PIER.half_width**2 + PIER.height**2) / PIER.mu + PIER.height**2
    assert row[2] == pytest.approx(-PIER.height * 0.5 * G * 0.025 / inertia, rel=1e-5)
    assert abs(found.balance) < 1e-13


def test_a_block_that_lands_while_the_ground_falls_faster_leaves_it_again(reference):
    """Thrown up, caught by ground that falls at 1.3 g: two flights with nothing between them."""
    throw = motion([0], [0, -1.5, -1.5, 1, -1.2, -1.5, -1.5, 0])
    trace = np.zeros((2000, 7))
    found = reference(PIER, RigidBase(), throw, trace=trace)
    assert (found.theta_max, found.flights, found.impacts) == (0.0, 2, 4)
    flying = np.flatnonzero((trace[:, 4] == 0) & (trace[:, 0] > 0))
    assert np.all(np.diff(flying) == 1)
    assert found.flight_duration == pytest.approx(trace[flying[-1] + 1, 0] - found.t_flight, abs=1e-15)
