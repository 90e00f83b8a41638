"""A rocking pier whose shaft bends, on two damped supports without tension, as mass points: Jacobians, DOP853, located events.

It shares nothing with the core but the modes' shapes and the laws of springs. The middle of the base does not slide while both
pivots are down or none is, and a pivot that is down alone does not: by that the place of the centre of mass follows θ.
"""

from dataclasses import dataclass

import numpy as np
from flexible_reference import Points
from scipy.integrate import solve_ivp

LONGEST = 0.2
"""Greatest step over the sampling interval, within which a pivot must not leave its support and land."""


STILL, SOON = 1e-9, 1e-5
"""Velocity of a pivot [m/s] that has just turned, and time [s] after which it moves."""

AT_YIELD = -1.0 + 1e-10
"""Force over its strength from which a support that yields counts as at it."""


@dataclass(frozen=True)
class Supports:
    """Both supports, per unit mass of the pier: F_y [m/s²], δ_y [m], C [1/s], and ż over the velocity/δ_y at z and velocity."""

    strength: float
    deflection: float
    damping: float
    share: object


def elastic(z, velocity):
    """Return the share of the elastic stiffness that a linear spring has."""
    return 1.0


def perfectly_plastic(z, velocity):
    """Return that of one that does not give further beyond its strength."""
    return 0.0 if z <= -1.0 and velocity < 0.0 else 1.0


def bouc_wen(z, velocity):
    """Return that of a smooth one, n = 5."""
    return 1.0 - abs(z) ** 5 if velocity < 0.0 else 1.0


def places(of: Points, down, q):
    """Return x and z of the points from the middle of the base, and Jacobians of their places over the ground by v, θ, u."""
    _, theta, *u = q
    height = of.mass @ of.z / of.mass.sum()
    x, z = of.x + np.array(u) @ of.shape, of.z - height
    s, c = np.sin(theta), np.cos(theta)
    still = (down[1] - down[0]) * of.half_width  # place of the point of the base that does not slide
    nothing = np.zeros_like(x)
    across = np.stack([nothing, height * c + still * s - x * s + z * c, *of.shape * c])
    up = np.stack([nothing + 1.0, -x * c - z * s, *-of.shape * s])
    return x, z, height, still, across, up


def drift_of(of, down, q, rates):
    """Return the accelerations of the points over the ground while those of the coordinates are 0."""
    x, z, height, still, _, _ = places(of, down, q)
    s, c, omega, bent = np.sin(q[1]), np.cos(q[1]), rates[1], rates[2:] @ of.shape
    along = omega**2 * (still * c - height * s - x * c - z * s) - 2.0 * omega * bent * s
    return along, omega**2 * (x * s - z * c) - 2.0 * omega * bent * c


def pivots(of, q, rates):
    """Return heights of both pivots, above those of an unstressed pier, their velocities, and derivatives by v and θ."""
    v, theta, *_ = q
    height, sides = of.mass @ of.z / of.mass.sum(), np.array([-1.0, 1.0])
    s, c = np.sin(theta), np.cos(theta)
    arms = height * s - sides * of.half_width * c
    return v + height * (1.0 - c) - sides * of.half_width * s, rates[0] + arms * rates[1], arms


def pushes(of, supports, down, q, rates, z):
    """Return the forces of both supports on the pier over its mass, upwards."""
    _, velocity, _ = pivots(of, q, rates)
    return -np.array(down) * (supports.strength * z + supports.damping * velocity)


def accelerations(of, supports, down, q, rates, z, ground):
    """Return the accelerations of v, θ and the modes."""
    _, _, _, _, across, up = places(of, down, q)
    along, rise = drift_of(of, down, q, rates)
    m, push, arms = of.mass / of.mass.sum(), pushes(of, supports, down, q, rates, z), pivots(of, q, rates)[2]
    matrix = (across * m) @ across.T + (up * m) @ up.T
    force = across @ (m * (-ground[0] - along)) + up @ (m * (-of.gravity - ground[1] - rise))
    force[:2] += push.sum(), push @ arms
    modal = of.modal_mass / of.mass.sum()
    force[2:] -= modal * (of.frequency**2 * q[2:] + 2.0 * of.damping_ratio * of.frequency * rates[2:])
    return np.linalg.solve(matrix, force)


def run(of, supports, ground, dt, until):
    """Return v, θ, the modes' coordinates and z of both supports at samples, from rest on springs loaded for the first time.

    ``ground`` has rows of horizontal and vertical acceleration each ``dt``.
    """
    n, steps = 2 + len(of.frequency), round(until / dt)
    ground = np.vstack([ground, np.zeros((max(0, steps + 2 - len(ground)), 2))])
    down, free = [1.0, 1.0], np.zeros(2)  # positions at which free supports are unstressed
    z = -0.5 * of.gravity / supports.strength
    sunk = supports.deflection * _first_deflection(supports, -z)
    state = np.concatenate([[-sunk, 0.0], np.zeros(2 * n - 2), [z, z]])
    relaxes = supports.strength / (supports.deflection * supports.damping)
    out = [(*state[:n], *state[2 * n :])]
    for step in range(steps):
        start, end = step * dt, (step + 1) * dt
        t = start

        def shaking(t, step=step, start=start):
            return ground[step] + (t - start) / dt * (ground[step + 1] - ground[step])

        while t < end - 1e-13:

            def slope(t, y, down=tuple(down)):
                q, rates, z = y[:n], y[n : 2 * n], y[2 * n :]
                _, velocity, _ = pivots(of, q, rates)
                k = accelerations(of, supports, down, q, rates, z, shaking(t))
                z_rates = [
                    speed / supports.deflection * supports.share(each, speed) if pressed else -relaxes * each
                    for pressed, speed, each in zip(down, velocity, z, strict=True)
                ]
                return np.concatenate([rates, k, z_rates])

            def leaves(t, y, i, down=tuple(down), free=tuple(free)):
                q, rates, z = y[:n], y[n : 2 * n], y[2 * n :]
                if down[i]:
                    return pushes(of, supports, down, q, rates, z)[i]
                return pivots(of, q, rates)[0][i] - free[i] - supports.deflection * z[i]

            events = [lambda t, y, i=i: leaves(t, y, i) for i in (0, 1)]
            moving = abs(pivots(of, state[:n], state[n : 2 * n])[1]) > STILL
            turns = [lambda t, y, i=i: pivots(of, y[:n], y[n : 2 * n])[1][i] for i in (0, 1) if moving[i]]
            until = end if moving.all() or supports.share is elastic else min(end, t + SOON)
            below = supports.share is perfectly_plastic
            yields = [lambda t, y, i=i: y[2 * n + i] + 1.0 for i in (0, 1) if below and state[2 * n + i] > -1.0]
            for event in (*events, *yields):
                event.direction = -1
            watched = events if supports.share is elastic else [*events, *turns, *yields]
            for event in watched:
                event.terminal = True
            found = solve_ivp(
                slope, (t, until), state, "DOP853", rtol=1e-10, atol=1e-13, max_step=LONGEST * dt, events=watched
            )
            t, state = found.t[-1], found.y[:, -1].copy()
            if below:
                state[2 * n :][state[2 * n :] < AT_YIELD] = -1.0
            for i in (0, 1):
                if len(found.t_events[i]):
                    if down[i]:
                        free[i] = pivots(of, state[:n], state[n : 2 * n])[0][i] - supports.deflection * state[2 * n + i]
                    down[i] = 1.0 - down[i]
        out.append((*state[:n], *state[2 * n :]))
        if abs(state[1]) > 0.5 * np.pi:
            break
    return np.array(out)


def _first_deflection(supports, force):
    """Return the deflection over δ_y at which a support bears ``force`` over its strength, loaded for the first time."""
    z = np.linspace(0.0, force, 20001)
    shares = np.array([supports.share(-each, -1.0) for each in z])
    return float(np.trapezoid(1.0 / shares, z))
