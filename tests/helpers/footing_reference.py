"""An independent solver of a pier on a footing: SciPy's DOP853, sample by sample, with the yielding of every node located.

It shares no code with the product: masks say which nodes yield, and their set follows the ground.
"""

import math
from typing import NamedTuple

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

GRAVITY = 9.81


class Foot(NamedTuple):
    """A pier on a footing per unit mass: width B, height h and settlement at rest δ_s [m], I0/M [m²], FS, ζ, strips."""

    width: float = 6.0
    height: float = 15.0
    inertia: float = 80.0
    settlement: float = 0.005
    safety: float = 3.0
    zeta: float = 0.05
    strips: int = 8
    finite: bool = False

    @property
    def stiffness(self):
        return GRAVITY / self.settlement

    @property
    def most(self):
        """Deflection at which the ground yields [m]."""
        return self.safety * self.settlement

    @property
    def nodes(self):
        return np.linspace(-0.5 * self.width, 0.5 * self.width, self.strips + 1)


def sunk(foot, y):
    """Depth of the ground under each node, and its rate."""
    v, theta, v_rate, omega = y
    x, h = foot.nodes, foot.height
    if not foot.finite:
        return -v + x * theta, -v_rate + x * omega
    return (
        -v + x * math.sin(theta) - h * (1.0 - math.cos(theta)),
        -v_rate + (x * math.cos(theta) - h * math.sin(theta)) * omega,
    )


def bed(foot, e, e_rate):
    """Force and moment about the middle, of pressures linear over what is pressed of each strip."""
    x, k, q = foot.nodes, foot.stiffness, foot.safety * GRAVITY
    c = 2.0 * foot.zeta * math.sqrt(k)
    force = moment = 0.0
    for j in range(foot.strips):
        ends = [(x[j], e[j], e_rate[j]), (x[j + 1], e[j + 1], e_rate[j + 1])]
        if max(ends[0][1], ends[1][1]) <= 0.0:
            continue
        low, high = np.array(ends[0]), np.array(ends[1])
        if low[1] < 0.0:
            low = low + (high - low) * low[1] / (low[1] - high[1])
        elif high[1] < 0.0:
            high = high + (low - high) * high[1] / (high[1] - low[1])
        a, b = (min(max(k * end[1] + c * end[2], 0.0), q) for end in (low, high))
        length, middle = (high[0] - low[0]) / foot.width, 0.5 * (low[0] + high[0])
        force += length * 0.5 * (a + b)
        moment += length * (0.5 * (a + b) * middle + (b - a) * (high[0] - low[0]) / 12.0)
    return force, moment


def _rates(foot, y, plastic, yields, ground):
    _, theta, v_rate, omega = y
    d, rate = sunk(foot, y)
    force, moment = bed(foot, d - np.where(yields, d - foot.most, plastic), rate)
    h = foot.height
    v_acceleration = force - GRAVITY - ground[1]
    if foot.finite:
        lever, slope = h * math.cos(theta), -h * math.sin(theta)
        turning = force * h * math.sin(theta) - moment * math.cos(theta) - lever * ground[0] - lever * slope * omega**2
        return [v_rate, omega, v_acceleration, turning / (foot.inertia + lever**2)]
    turning = force * h * theta - moment - h * ground[0]
    return [v_rate, omega, v_acceleration, turning / (foot.inertia + h**2)]


class Course(NamedTuple):
    """What a run came to."""

    theta_max: float
    y: np.ndarray
    plastic: np.ndarray
    force_max: float
    overturned: bool


def solve(foot, horizontal, vertical, dt, rtol=1e-10):
    """Integrate a run to the end of its samples, or until the pier lies on its side."""
    y, plastic = np.array([-foot.settlement, 0.0, 0.0, 0.0]), np.zeros(foot.strips + 1)
    yields, most, force_max = np.zeros(foot.strips + 1, bool), 0.0, 0.0
    for i in range(len(horizontal) - 1):
        t = 0.0
        here, slope = np.array([horizontal[i], vertical[i]]), np.array([horizontal[i + 1], vertical[i + 1]])
        slope = (slope - here) / dt
        while t < dt:
            events = _events(foot, plastic, yields)
            part = solve_ivp(
                lambda s, z, p=plastic, m=yields, a=here, b=slope: _rates(foot, z, p, m, a + s * b), (t, dt), y,
                method="DOP853", rtol=rtol, atol=1e-13, events=events, dense_output=True,
            )  # fmt: skip
            for a, b in zip(part.t[:-1], part.t[1:], strict=True):
                if part.sol(a)[3] * part.sol(b)[3] < 0.0:
                    turn = brentq(lambda s, sol=part.sol: sol(s)[3], a, b, xtol=1e-15)
                    most = max(most, abs(part.sol(turn)[1]))
            y, t = part.y[:, -1], part.t[-1]
            most = max(most, abs(y[1]))
            d, _ = sunk(foot, y)
            plastic = np.where(yields, d - foot.most, plastic)
            for z in part.y.T:
                d_z, rate_z = sunk(foot, z)
                set_z = np.where(yields, d_z - foot.most, plastic)
                force_max = max(force_max, bed(foot, d_z - set_z, rate_z)[0])
            fired = [j for j, times in enumerate(part.t_events) if len(times)]
            for j in fired:
                yields[j] = not yields[j]
            if abs(y[1]) > 0.5 * math.pi:
                return Course(most, y, plastic, force_max, True)
    return Course(most, y, plastic, force_max, False)


def _events(foot, plastic, yields):
    """Events of every node: those that yield stop when the ground goes back, others begin at the greatest deflection."""

    def of(j):
        def reached(_, y):
            d, rate = sunk(foot, y)
            return rate[j] if yields[j] else d[j] - plastic[j] - foot.most

        reached.terminal, reached.direction = True, -1.0 if yields[j] else 1.0
        return reached

    return [of(j) for j in range(foot.strips + 1)]
