"""A rocking pier whose shaft bends, on a footing, as mass points over the nodes of a bed: Jacobians, DOP853, located yielding.

It shares nothing with the core but the modes' shapes: the points are those of a pier on supports, the bed that of a rigid pier.
"""

import math
from typing import NamedTuple

import numpy as np
from flexible_reference import Points
from footing_reference import Foot, bed
from scipy.integrate import solve_ivp
from supported_reference import drift_of, places

SLIDES_NOWHERE = (1.0, 1.0)
"""Pivots that are down, as places() takes them: the middle of the base does not slide."""


def foot_of(of: Points, settlement: float, safety: float, zeta: float, strips: int) -> Foot:
    """The bed under the points, which its weight presses by ``settlement`` [m]."""
    height = of.mass @ of.z / of.mass.sum()
    return Foot(2.0 * of.half_width, height, math.nan, settlement, safety, zeta, strips, True)


def depths(foot, q, rates):
    """Return the depth of the ground under each node, its rate, and its derivatives by v and θ."""
    s, c, x = math.sin(q[1]), math.cos(q[1]), foot.nodes
    arm = x * c - foot.height * s
    return -q[0] + x * s - foot.height * (1.0 - c), -rates[0] + arm * rates[1], arm


def pushed(foot, q, rates, sets):
    """Return the generalised forces of the bed on v and θ, over the mass."""
    d, rate, _ = depths(foot, q, rates)
    force, moment = bed(foot, d - sets, rate)
    return force, force * foot.height * math.sin(q[1]) - moment * math.cos(q[1])


def accelerations(of, foot, q, rates, sets, ground):
    """Return the accelerations of v, θ and the modes."""
    _, _, _, _, across, up = places(of, SLIDES_NOWHERE, q)
    along, rise = drift_of(of, SLIDES_NOWHERE, q, rates)
    m = of.mass / of.mass.sum()
    force = across @ (m * (-ground[0] - along)) + up @ (m * (-of.gravity - ground[1] - rise))
    force[:2] += pushed(foot, q, rates, sets)
    modal = of.modal_mass / of.mass.sum()
    force[2:] -= modal * (of.frequency**2 * q[2:] + 2.0 * of.damping_ratio * of.frequency * rates[2:])
    return np.linalg.solve((across * m) @ across.T + (up * m) @ up.T, force)


class Course(NamedTuple):
    """v, θ and the modes' coordinates at samples, the sets of the nodes at the end, and whether any part was in the air."""

    at_samples: np.ndarray
    sets: np.ndarray
    flew: bool


def run(of, foot, ground, dt, until, rtol=1e-10):
    """Return the Course from rest, of a motion with rows of horizontal and vertical acceleration each ``dt``."""
    n, steps = 2 + len(of.frequency), round(until / dt)
    ground = np.vstack([ground, np.zeros((max(0, steps + 2 - len(ground)), 2))])
    sets, yields = np.zeros(foot.strips + 1), np.zeros(foot.strips + 1, bool)
    y, flew = np.concatenate([[-foot.settlement], np.zeros(2 * n - 1)]), False
    out = [y[:n]]
    for step in range(steps):
        t = 0.0
        while t < dt:

            def set_at(y, sets=sets, yields=yields):
                return np.where(yields, depths(foot, y[:n], y[n:])[0] - foot.most, sets)

            def slope(t, y, step=step, set_at=set_at):
                shaking = ground[step] + t / dt * (ground[step + 1] - ground[step])
                return np.concatenate([y[n:], accelerations(of, foot, y[:n], y[n:], set_at(y), shaking)])

            def turns(j, sets=sets, yields=yields):
                def reached(_, now):
                    d, rate, _ = depths(foot, now[:n], now[n:])
                    return rate[j] if yields[j] else d[j] - sets[j] - foot.most

                reached.terminal, reached.direction = True, -1.0 if yields[j] else 1.0
                return reached

            events = [turns(j) for j in range(foot.strips + 1)]
            part = solve_ivp(slope, (t, dt), y, "DOP853", rtol=rtol, atol=1e-13, events=events)
            t, y, sets = part.t[-1], part.y[:, -1].copy(), set_at(part.y[:, -1])
            for j, times in enumerate(part.t_events):
                yields[j] = yields[j] != (len(times) > 0)
            flew = flew or bool((depths(foot, y[:n], y[n:])[0] <= sets).all())
        out.append(y[:n])
        if abs(y[1]) > 0.5 * math.pi:
            break
    return Course(np.array(out), sets, flew)
