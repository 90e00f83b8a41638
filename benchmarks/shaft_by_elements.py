"""The pier of configs/elastic_shaft.toml by a program of its own: beam elements, fixed steps, and no code of rockbatch's core.

    python benchmarks/shaft_by_elements.py [--modes 3 4 5] [--step 4e-5]

A cantilever of 31 elements with masses at their nodes, condensed to them, moves by its lowest modes in the frame of its base,
which stands, rocks about a corner or flies: classical Runge–Kutta steps of one length, whose ends see events. A blow keeps the
momenta about the new corner and those of the modes; where the base would not turn on about it, both corners stop. Rows: modes,
record, greatest base shear [kN] and |θ|/α, blows and flights; then the medians.
"""

import argparse
import math
from pathlib import Path
from typing import NamedTuple

import numba
import numpy as np
from scipy.linalg import eigh

from rockbatch.motions import read_motions

G, HALF_WIDTH, PERIOD, DAMPING, AFTER = 9.81, 5.35, 1.5, 0.05, 6.0
HEIGHTS = np.array([*np.arange(2.0, 61.0, 2.0), 62.0])
MASSES = np.array([40.0] * 29 + [20.0, 800.0])
MASS, ROTARY = 2000.0, 1200.0 * 10.7**2 / 12.0
"""Of pier and deck [t], and moment of inertia of the sections of the shaft about its axis [t m²]."""
NEAR_FAULT = Path(__file__).parents[1] / "motions" / "near_fault"


class Column(NamedTuple):
    """Numbers over the mass: of each mode Σ m φ, Σ m φ z, ω, 2 ζ ω; height of the centre of mass, Σ m z² and that of sections."""

    share: np.ndarray
    coupling: np.ndarray
    frequency: np.ndarray
    damping: np.ndarray
    height: float
    inertia: float


def column(modes: int) -> Column:
    """Return the Column by its lowest modes, scaled to Σ m φ² of the whole mass."""
    ends, n = np.concatenate([[0.0], HEIGHTS]), len(HEIGHTS)
    stiff = np.zeros((2 * n + 2, 2 * n + 2))
    for i, e in enumerate(np.diff(ends)):
        beam = [[12, 6 * e, -12, 6 * e], [6 * e, 4 * e * e, -6 * e, 2 * e * e]]
        beam += [[-12, -6 * e, 12, -6 * e], [6 * e, 2 * e * e, -6 * e, 4 * e * e]]
        stiff[2 * i : 2 * i + 4, 2 * i : 2 * i + 4] += np.array(beam) / e**3
    across, turns = np.arange(2, 2 * n + 2, 2), np.arange(3, 2 * n + 3, 2)
    mixed = stiff[np.ix_(turns, across)]
    held = stiff[np.ix_(across, across)] - mixed.T @ np.linalg.solve(stiff[np.ix_(turns, turns)], mixed)
    squares, shapes = eigh(held, np.diag(MASSES))
    frequency = np.sqrt(squares[:modes] / squares[0]) * 2.0 * math.pi / PERIOD
    shapes = shapes[:, :modes] * math.sqrt(MASS)
    turning = (MASSES @ HEIGHTS**2 + ROTARY) / MASS
    each = shapes.T @ MASSES / MASS, shapes.T @ (MASSES * HEIGHTS) / MASS, frequency, 2.0 * DAMPING * frequency
    return Column(*map(np.ascontiguousarray, each), MASSES @ HEIGHTS / MASS, turning)


@numba.njit
def rates(of, y, ground, key, state):
    """Return the rates of y = (corner's rise, θ, their rates, modes, their rates), V, N, and θ̈ about the corner at ``key``.

    ``state`` is 0 of a base that stands, 1 while it rocks and 2 in flight.
    """
    n = len(of.share)
    sine, cosine, omega, weight, b = math.sin(y[1]), math.cos(y[1]), y[3], G + ground[1], key * HALF_WIDTH
    u, u_rate = y[4 : 4 + n], y[4 + n :]
    apart, squared = u - b * of.share, omega * omega
    bends = apart * squared - of.frequency**2 * u - of.damping * u_rate
    bends -= of.share * (ground[0] * cosine - weight * sine)
    moved = (of.share * u).sum() - b
    speed = (of.share * u_rate).sum()
    turning = of.inertia - (of.coupling**2).sum() + (u * u).sum() - 2.0 * b * (of.share * u).sum() + b * b
    moment = sine * of.height * weight + cosine * moved * weight - (of.coupling * bends).sum()
    moment -= 2.0 * (apart * u_rate).sum() * omega + ground[0] * (cosine * of.height - sine * moved)
    about, rises = moment / turning, 0.0
    turns = about if state == 1 else 0.0
    if state == 2:
        rise = 1.0 - sine**2 * (of.share**2).sum()
        both = -sine * of.height + sine * (of.share * of.coupling).sum() - cosine * moved
        push = cosine * (of.height * squared + 2.0 * speed * omega) - weight
        push += sine * ((of.share * bends).sum() - moved * squared)
        rises = (push * turning - both * moment) / (rise * turning - both**2)
        turns = (rise * moment - both * push) / (rise * turning - both**2)
    u_second = bends - of.coupling * turns + of.share * (sine * rises)
    out = np.concatenate((np.array([y[2], omega, rises, turns]), u_rate, u_second))
    across = of.height * turns + (of.share * u_second).sum() - moved * squared
    along = of.height * squared + moved * turns + 2.0 * speed * omega
    return out, ground[0] + cosine * across - sine * along, weight + rises - sine * across - cosine * along, about


@numba.njit
def struck(of, y, key, corner, flew):
    """Return the state behind a blow at ``corner``, and the key then, 0 if both corners stop."""
    n, sine, cosine = len(of.share), math.sin(y[1]), math.cos(y[1])
    u, u_rate, omega = y[4 : 4 + n], y[4 + n :], y[3]
    moved, squares, b = (of.share * u).sum(), (u * u).sum(), HALF_WIDTH
    kept = u_rate + of.coupling * omega - of.share * (sine * y[2])
    before = of.inertia + squares - (key + corner) * b * moved + key * corner * b * b
    momentum = before * omega + (of.coupling * u_rate).sum() - y[2] * (sine * of.height + cosine * (moved - corner * b))
    after = of.inertia + squares - 2.0 * corner * b * moved + b * b - (of.coupling**2).sum()
    turns = (momentum - (of.coupling * kept).sum()) / after
    if not flew and corner * turns <= 0.0:
        return np.concatenate((np.zeros(4), u, kept)), 0.0
    start = np.array([0.0, y[1] if flew else 0.0, 0.0, turns])
    return np.concatenate((start, u, kept - of.coupling * turns)), corner


@numba.njit
def landing(y, key, state):
    """Return the corner that strikes the ground, 0 for none."""
    if state == 1 and key * y[1] < 0.0 and key * y[3] < 0.0:
        return -key
    for side in (-1.0, 1.0):
        lever = (key - side) * HALF_WIDTH
        if state == 2 and y[0] + lever * math.sin(y[1]) < 0.0 and y[2] + lever * math.cos(y[1]) * y[3] < 0.0:
            return side
    return 0.0


@numba.njit
def shaken(record, place):
    """Return the ground's accelerations at a ``place`` of the record, in samples; zeros behind it."""
    i = int(place)
    return record[i] + (place - i) * (record[i + 1] - record[i]) if i + 1 < len(record) else np.zeros(2)


@numba.njit
def follow(of, record, dt, h):
    """Return the greatest |V|/M and |θ|, and the numbers of blows and flights, with steps of ``h`` [s]."""
    y, key, state, most, counts = np.zeros(4 + 2 * len(of.share)), 0.0, 0, np.zeros(2), np.zeros(2)
    for step in range(int(((len(record) - 1) * dt + AFTER) / h)):
        start, middle, end = [shaken(record, (step + part) * h / dt) for part in (0.0, 0.5, 1.0)]
        if state == 0:
            for side in (-1.0, 1.0):
                if state == 0 and side * rates(of, y, start, side, 0)[3] > 0.0:
                    key, state = side, 1
        k1, shear, normal, _ = rates(of, y, start, key, state)
        if state == 1 and normal < 0.0:
            state = 2
            counts[1] += 1
            k1, shear, _, _ = rates(of, y, start, key, state)
        most[0], most[1] = max(most[0], abs(shear)), max(most[1], abs(y[1]))
        k2 = rates(of, y + 0.5 * h * k1, middle, key, state)[0]
        k3 = rates(of, y + 0.5 * h * k2, middle, key, state)[0]
        k4 = rates(of, y + h * k3, end, key, state)[0]
        y = y + h / 6.0 * (k1 + 2.0 * (k2 + k3) + k4)
        corner = landing(y, key, state)
        if corner != 0.0:
            counts[0] += 1
            y, key = struck(of, y, key, corner, state == 2)
            state = 1 if key != 0.0 else 0
    return most, counts


def main() -> None:
    """Print the rows."""
    parser = argparse.ArgumentParser(description=str(__doc__).split("\n\n")[0])
    parser.add_argument("--modes", type=int, nargs="+", default=[3, 4, 5])
    parser.add_argument("--step", type=float, default=4e-5)
    arguments = parser.parse_args()
    alpha = math.atan2(HALF_WIDTH, MASSES @ HEIGHTS / MASS)
    for modes in arguments.modes:
        of, shears = column(modes), []
        for motion in read_motions(NEAR_FAULT).motions:
            vertical = np.zeros(motion.npts) if motion.vertical is None else motion.vertical
            most, counts = follow(of, np.column_stack([motion.horizontal, vertical]), float(motion.dt), arguments.step)
            shears.append(MASS * most[0])
            print(modes, motion.name, f"{shears[-1]:.0f} {most[1] / alpha:.4f}", *map(int, counts), flush=True)
        print(f"{modes} modes: median base shear {np.median(shears):.0f} kN")


if __name__ == "__main__":
    main()
