"""A rocking pier whose shaft bends, as mass points: Jacobians of their places, DOP853 and located events.

It shares nothing with the core but the modes' shapes: no integral of them, no mass matrix in closed form. In each phase (both
corners down, one down, none) the equations are Jᵀ m (J q̈ + γ) = Jᵀ f with the Jacobian J of the places in the coordinates that
are free; a blow projects the velocities of all points on those that the new corner allows.
"""

from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

STILL = 1e-7
"""Angular velocity [rad/s] behind an impact that counts as none."""


HOP = 3e-5
"""Longest step in flight [s], within which a pivot must not leave the ground and land, however short it hops."""

LEVELS, SHARES = np.polynomial.legendre.leggauss(40)
"""Of the mass of a uniform part."""


@dataclass(frozen=True)
class Points:
    """Mass points of a pier: masses, places from the middle of the base, and by modes: shapes there, ω_i and ζ_i."""

    mass: np.ndarray
    x: np.ndarray
    z: np.ndarray
    shape: np.ndarray
    half_width: float
    frequency: np.ndarray
    damping_ratio: np.ndarray
    gravity: float

    @property
    def modal_mass(self):
        """∫φ_i² dm of each mode."""
        return self.shape**2 @ self.mass

    @property
    def bends(self):
        """Numbers of the coordinates that bend."""
        return list(range(2, 2 + len(self.frequency)))


def points_of(parts, shape_at, **numbers):
    """Return Points of ``parts``, each (mass, low, high, half of the distance between two columns of points), with the modes'
    shapes ``shape_at(z)``, shape (n, k).
    """
    mass, x, z = [], [], []
    for total, low, high, spread in parts:
        for level, share in zip(LEVELS, SHARES, strict=True):
            mass += [0.25 * total * share] * 2
            x += [-spread, spread]
            z += [0.5 * (low + high) + 0.5 * (high - low) * level] * 2
    return Points(np.array(mass), np.array(x), np.array(z), shape_at(np.array(z)), **numbers)


def _places(of, key, q):
    _, theta, *u = q
    x = of.x - key * of.half_width + u @ of.shape
    s, c = np.sin(theta), np.cos(theta)
    nothing = np.zeros_like(x)
    across = np.stack([nothing, -x * s + of.z * c, *of.shape * c])
    up = np.stack([nothing + 1, -x * c - of.z * s, *-of.shape * s])
    return x, s, c, across, up


def motion_of(of, key, free, q, rates, ground):
    """Return the accelerations of the coordinates, of which only ``free`` ones move, and N/M."""
    x, s, c, across, up = _places(of, key, q)
    _, omega, *u_rate = rates
    bent = u_rate @ of.shape
    bend_x = omega**2 * (-x * c - of.z * s) + 2 * omega * bent * -s
    bend_z = omega**2 * (x * s - of.z * c) + 2 * omega * bent * -c
    m, across, up = of.mass, across[free], up[free]
    matrix = (across * m) @ across.T + (up * m) @ up.T
    force = across @ (m * (-ground[0] - bend_x)) + up @ (m * (-of.gravity - ground[1] - bend_z))
    modal = of.modal_mass * (of.frequency**2 * q[2:] + 2 * of.damping_ratio * of.frequency * np.array(u_rate))
    force[-len(modal) :] -= modal
    accelerations = np.zeros(len(q))
    accelerations[free] = np.linalg.solve(matrix, force)
    rise = accelerations[free] @ up + bend_z
    return accelerations, np.sum(m * (of.gravity + ground[1] + rise)) / m.sum()


def accelerations_of(of, key, q, rates, accelerations):
    """Return the accelerations of all points over the ground, to the right and up."""
    x, s, c, across, up = _places(of, key, q)
    _, omega, *u_rate = rates
    bent = u_rate @ of.shape
    along = accelerations @ across - omega**2 * (x * c + of.z * s) - 2 * omega * bent * s
    return along, accelerations @ up + omega**2 * (x * s - of.z * c) - 2 * omega * bent * c


def places_over_ground(of, key, q):
    """Return the places of all points from where the middle of the base is at rest; the corner at ``key`` is on the ground."""
    x, s, c, _, _ = _places(of, key, q)
    return key * of.half_width + x * c + of.z * s, -x * s + of.z * c


def _moment(of, side, q, rates, ground):
    """Return the moment over M that turns a pier with both corners down about the corner on ``side``, towards it."""
    accelerations, _ = motion_of(of, side, of.bends, q, rates, ground)
    _, _, _, across, up = _places(of, side, q)
    m = of.mass
    inertial = m * (-ground[0] - accelerations[2:] @ of.shape)
    return side * (across[1] @ inertial + up[1] @ (m * (-of.gravity - ground[1]))) / m.sum()


def _blow(of, key, corner, q, rates):
    """Return θ̇ and the rates of the modes behind a blow at ``corner``."""
    _, _, _, across, up = _places(of, key, q)
    along, rise = rates @ across, rates @ up
    _, _, _, across, up = _places(of, corner, q)
    m, across, up = of.mass, across[1:], up[1:]
    matrix, momentum = (across * m) @ across.T + (up * m) @ up.T, across @ (m * along) + up @ (m * rise)
    return np.linalg.solve(matrix, momentum)


def kept_as_both_stop(of):
    """Return what the rates of the modes gain of θ̇ as both corners stop, so that their momenta are kept."""
    return (of.mass * of.shape) @ of.z / of.modal_mass


def run(of, ground, dt, theta=0.0, until=None, hop=HOP):
    """Return times, heights of the corner, θ and the modes' coordinates, and the greatest of these from θ on.

    ``ground`` has rows of horizontal and vertical acceleration each ``dt``.
    """
    steps = len(ground) - 1 if until is None else round(until / dt)
    ground = np.vstack([ground, np.zeros((max(0, steps + 2 - len(ground)), 2))])
    key, down = (0.0, "both") if theta == 0 else (np.sign(theta), "one")
    n = 2 + len(of.frequency)
    state = np.zeros(2 * n)
    state[1] = theta
    if theta:
        state[2:n] = of.gravity * (of.shape @ of.mass) * np.sin(theta) / of.modal_mass / of.frequency**2
    out = [(0.0, *state[:n])]
    peaks = np.abs(state[1:n])
    for step in range(steps):
        start, end = step * dt, (step + 1) * dt

        def shaking(t, step=step, start=start):
            return ground[step] + (t - start) / dt * (ground[step + 1] - ground[step])

        t = start
        while t < end:
            free = {"both": of.bends, "one": [1, *of.bends], "none": [0, 1, *of.bends]}[down]

            def slope(t, y, free=free, key=key):
                return np.concatenate([y[n:], motion_of(of, key, free, y[:n], y[n:], shaking(t))[0]])

            def corner(y, side, key=key):
                return y[0] + (key - side) * of.half_width * np.sin(y[1])  # height above the ground

            if down == "both":
                events = [
                    lambda t, y: -_moment(of, 1, y[:n], y[n:], shaking(t)),
                    lambda t, y: -_moment(of, -1, y[:n], y[n:], shaking(t)),
                ]
            elif down == "one":
                events = [
                    lambda t, y, key=key: key * y[1],
                    lambda t, y, key=key: motion_of(of, key, [1, *of.bends], y[:n], y[n:], shaking(t))[1],
                ]
            else:
                events = [lambda t, y: corner(y, -1), lambda t, y: corner(y, 1)]
            happened, at_once = None, [event(t, state) for event in events]
            if down == "both" and min(at_once) < 0:
                happened = int(np.argmin(at_once))
            elif down == "one" and at_once[1] < 0:
                happened = 1
            else:
                for event in events:
                    event.terminal, event.direction = True, -1
                length, longest = end, hop if down == "none" else dt / 3
                if down == "one" and state[1] == 0.0:  # a bounce must not begin and end within one step
                    back, speed = -key * slope(t, state)[n + 1], key * state[n + 1]
                    length = min(end, t + 0.5 * speed / back) if speed > 0 < back else end
                found = solve_ivp(
                    slope,
                    (t, length),
                    state,
                    "DOP853",
                    rtol=1e-10,
                    atol=1e-13,
                    max_step=longest,
                    events=events,
                    dense_output=True,
                )
                inside = found.sol(np.linspace(t, found.t[-1], 9))
                peaks = np.maximum(peaks, np.abs(inside[1:n]).max(axis=1))
                t, state = found.t[-1], found.y[:, -1].copy()
                if found.status == 1:
                    happened = next(i for i, times in enumerate(found.t_events) if len(times))
            if happened is None:
                continue
            if down == "both":
                key, down = (1.0, "one") if happened == 0 else (-1.0, "one")
            elif down == "one" and happened == 1:
                down = "none"
            else:
                landing = -key if down == "one" else (-1.0 if happened == 0 else 1.0)
                omega, *u_rate = _blow(of, key, landing, state[:n], state[n:])
                if down == "one":
                    state[1] = 0.0
                height = state[1]
                key, down = landing, "one"
                state = np.array([0.0, height, *state[2:n], 0.0, omega, *u_rate])
                if height == 0.0 and landing * omega <= STILL:
                    before = found.y[:, -1]
                    kept = before[n + 2 :] + kept_as_both_stop(of) * before[n + 1]
                    state = np.array([0.0, 0.0, *before[2:n], 0.0, 0.0, *kept])
                    key, down = 0.0, "both"
        out.append((end, *state[:n]))
        if abs(state[1]) > np.pi / 2:
            break
    return np.array(out), peaks


def tipping(of):
    """Return the rotation at which the pier stands on a corner with its shaft bent by the weight."""
    softness = of.gravity * (of.shape @ of.mass) / of.modal_mass / of.frequency**2

    def back(theta):
        _, _, _, _, up = _places(of, 1.0, (0.0, theta, *softness * np.sin(theta)))
        return -(up[1] @ of.mass)

    return brentq(back, 0.0, 1.0)
