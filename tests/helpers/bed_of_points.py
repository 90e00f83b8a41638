"""A pier on a bed of many points, by (B1) to (B4) of THEORY.md as they stand: Runge–Kutta at tiny steps, no strips, no events.

Each point pushes as a spring with a dashpot within its strength, and its set is the deepest that its ground was pressed. It
shares no code with the product; per unit mass of the pier.
"""

import math
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq


class Bed(NamedTuple):
    """Half the width and height of the centre [m], I0/M [m²], g, ω_v [1/s], FS, ζ, and whether rotations are large."""

    half_width: float
    height: float
    inertia: float
    gravity: float
    omega_v: float
    safety: float
    zeta: float
    finite: bool
    points: int = 240

    @property
    def places(self):
        """Places of the points to the right of the middle [m], and those of both edges, which bear nothing."""
        x = (np.arange(self.points) + 0.5) / self.points
        return np.concatenate([(2.0 * x - 1.0) * self.half_width, [-self.half_width, self.half_width]])


def sunk(bed, v, theta):
    """Return how far the ground is pressed at the places [m], and its derivatives by v and θ."""
    x, h = bed.places, bed.height
    if bed.finite:
        s, c = math.sin(theta), math.cos(theta)
        return -v + x * s - h * (1.0 - c), x * c - h * s
    return -v + x * theta, x


def pushes(bed, y, sets):
    """Return the push of every place, as of one that bore all of the foot [m/s²]; 0 where the ground is clear."""
    v, theta, v_rate, omega = y
    depth, arms = sunk(bed, v, theta)
    strength, k = bed.safety * bed.gravity, bed.omega_v**2
    elastic = depth - np.maximum(sets, depth - strength / k)
    force = k * elastic + 2.0 * bed.zeta * bed.omega_v * (arms * omega - v_rate)
    return np.where(elastic > 0.0, np.clip(force, 0.0, strength), 0.0)


def accelerations(bed, y, sets, ground):
    """Return v̈, θ̈ and the horizontal acceleration of the centre of mass over that of the ground."""
    theta, omega, h = y[1], y[3], bed.height
    push = pushes(bed, y, sets)[:-2] / bed.points
    x = bed.places[:-2]
    lever, slope, arms = (
        (h * math.cos(theta), -h * math.sin(theta), sunk(bed, y[0], theta)[1][:-2]) if bed.finite else (h, 0.0, x)
    )
    moment = -push @ arms if bed.finite else push @ (h * theta - x)
    turning = (moment - lever * slope * omega**2 - lever * ground[0]) / (bed.inertia + lever**2)
    return push.sum() - bed.gravity - ground[1], turning, lever * turning + slope * omega**2


def follow(bed, horizontal, vertical, dt, substeps):
    """Return the greatest demands of a run to the end of its samples by names of columns, and the sets of all places."""
    y, sets, h = np.array([-bed.gravity / bed.omega_v**2, 0.0, 0.0, 0.0]), np.zeros(bed.points + 2), dt / substeps
    give, found, yielded, leans = bed.safety * bed.gravity / bed.omega_v**2, {"contact_least": 1.0}, False, 0.0
    most = dict.fromkeys(("theta_max", "push", "edge", "shear", "work", "half_cycles"), 0.0)

    def rates(y, t, i):
        ground = [each[i] + t / dt * (each[i + 1] - each[i]) for each in (horizontal, vertical)]
        v, turning, sideways = accelerations(bed, y, sets, ground)
        return np.array([y[2], y[3], v, turning]), sideways + ground[0]

    for i in range(len(horizontal) - 1):
        for j in range(substeps):
            t = j * h
            k1, _ = rates(y, t, i)
            k2, _ = rates(y + 0.5 * h * k1, t + 0.5 * h, i)
            k3, _ = rates(y + 0.5 * h * k2, t + 0.5 * h, i)
            k4, _ = rates(y + h * k3, t + h, i)
            y = y + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
            deeper = np.maximum(sunk(bed, y[0], y[1])[0] - give - sets, 0.0)
            sets = sets + deeper
            push = pushes(bed, y, sets)
            most["work"] += bed.safety * bed.gravity * deeper[:-2].mean()
            yielded = yielded and y[1] * leans > 0.0
            if deeper.any() and not yielded:
                yielded = True
                most["half_cycles"] += 1
            leans = y[1]
            pressed = (sunk(bed, y[0], y[1])[0] > sets)[:-2]
            found["contact_least"] = min(found["contact_least"], float(pressed.mean()))
            now = {
                "theta_max": abs(y[1]),
                "push": push[:-2].mean(),
                "edge": push[-2:].max(),
                "shear": abs(rates(y, t + h, i)[1]),
            }
            most |= {name: max(most[name], float(value)) for name, value in now.items()}
    return found | most, sets


def at_rest(bed, sets, tilt):
    """Return θ and v at which the bed with these ``sets`` carries the pier, the stable equilibrium next to ``tilt`` [rad]."""

    def height(theta):
        def unbalanced(v):
            return pushes(bed._replace(zeta=0.0), (v, theta, 0.0, 0.0), sets)[:-2].mean() - bed.gravity

        return brentq(unbalanced, -sets.max() - 2.0 * bed.half_width, 2.0 * bed.half_width, xtol=1e-15)

    def turned(theta):
        return accelerations(bed._replace(zeta=0.0), (height(theta), theta, 0.0, 0.0), sets, (0.0, 0.0))[1]

    theta = brentq(turned, tilt - 0.02, tilt + 0.02, xtol=1e-14)
    return theta, height(theta)
