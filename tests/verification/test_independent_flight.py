"""The independent reference on guided flight above the rigid base: closed forms, Lagrange's equations, known motions.

Values of motions and landings come from another event-driven solver (known_flights.py).
"""

import importlib
import math

import numpy as np
import pytest
from known_flights import KNOWN_ENDS, KNOWN_LANDINGS, KNOWN_PEAKS, MOTIONS, PIER, check_ends

from rockbatch.pier import RigidBase

pytestmark = pytest.mark.thorough  # compiles the reference, which hardly ever changes
G = PIER.gravity


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


@KNOWN_LANDINGS
def test_known_landings(core, par, pivot, theta, omega, v_rate, speed, after):
    landing, pivot = int(pivot), (int(pivot) + 1) // 2
    y = state(theta, omega, v_rate, par, core, landing)
    assert core.pivot_velocity(y, pivot, par) == pytest.approx(speed, abs=1e-9)
    for bore_last, expected in after.items():
        turn, up = core.rebound(y, int(bore_last), pivot, 0.0, par)
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


@pytest.mark.parametrize("epsilon", [0.3, 1.0])
def test_elastic_landings_of_the_pivot_that_bore_last_gain_no_energy(core, par, epsilon):
    """Of another pivot they may: its key stops a horizontal velocity while the vertical one is given back."""
    for y, pivot, _ in landings(core, par):
        side = 2 * pivot - 1
        turn, up = core.rebound(y, side, pivot, epsilon, par)
        before, after = kinetic(y[1], y[3], y[2], side), kinetic(y[1], turn, up, side)
        assert after <= before * (1 + 1e-9)
        assert (epsilon < 1) or after == pytest.approx(before, rel=1e-9)


@KNOWN_ENDS
def test_known_flights_take_off_and_land(reference, name, off, on):
    trace = np.zeros((2000, 7))
    found = reference(PIER, RigidBase(), MOTIONS[name], trace=trace)
    flying = np.flatnonzero((trace[:, 4] == 0) & (trace[:, 0] > 0))
    check_ends(off, on, trace[[flying[0], flying[-1] + 1]])
    assert found.flights == 1
    assert found.t_flight == trace[flying[0], 0]
    assert found.flight_duration == pytest.approx(trace[flying[-1] + 1, 0] - found.t_flight, abs=1e-15)


@KNOWN_PEAKS
def test_known_flights_reach_their_height_and_rotation(reference, name, height, theta_max, t_max):
    found = reference(PIER, RigidBase(), MOTIONS[name])
    assert found.status == "stands"
    assert found.flight_height == pytest.approx(height, abs=1e-10)
    assert found.theta_max / PIER.alpha == pytest.approx(theta_max, abs=6e-10)
    assert found.t_max == pytest.approx(t_max, abs=6e-7)
    assert abs(found.balance) < 1e-14
    assert found.forced == 0


@pytest.mark.parametrize("name", list(MOTIONS))
def test_a_base_that_stops_at_flight_ends_the_run_there(reference, name):
    guided, stopped = (reference(PIER, base, MOTIONS[name]) for base in (RigidBase(), RigidBase(flight="stop")))
    assert (stopped.status, stopped.flights) == ("flew", 1)
    assert stopped.t_end == stopped.t_flight == guided.t_flight
    assert stopped.theta_max == stopped.peak_flight == guided.peak_flight
