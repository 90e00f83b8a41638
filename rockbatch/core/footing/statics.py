"""Equilibria of a pier on its bed as it is (THEORY.md, A footing): the level at a rotation, its energy, where the pier rests."""

import math

from rockbatch.core.footing.model import POSITIONS, SET, State
from rockbatch.core.footing.strips import push, sinking, stored
from rockbatch.core.kernel import kernel

HALVINGS = 60
"""Of an interval that holds an equilibrium: to rounding."""

FIRST_STEP, LONGER = 0.02, 1.25
"""First step of the search for a stable equilibrium, over the rotation of uplift, and the factor from each to the next."""


@kernel
def level_at(m, theta, load):
    """Return v [m] at which the bed carries the ``load`` [m/s²] at rotation ``theta`` [rad]."""
    deepest = load / m.stiffness
    for j in range(int(m.strips) + 1):
        deepest = max(deepest, m.bed[SET, j] + load / m.stiffness)
    reach = m.half_width * (1.0 + m.gap) * abs(theta) + m.height * theta * theta
    low, high = -deepest - reach - load / m.stiffness, reach
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        bears = push(m, sinking(m, State(middle, theta, 0.0, 0.0))).force >= load
        low, high = (middle, high) if bears else (low, middle)
    return 0.5 * (low + high)


@kernel
def righting(m, theta, load):
    """Return the moment [m²/s²] that rights the pier at rest under ``load`` [m/s²] at rotation ``theta`` [rad] to the left."""
    bed = push(m, sinking(m, State(level_at(m, theta, load), theta, 0.0, 0.0)))
    if m.finite is None:
        return bed.moment - m.height * theta * load
    return bed.moment * math.cos(theta) - m.height * math.sin(theta) * load


@kernel
def level_energy(m, theta, load):
    """Return the least energy [J/kg] that the pier has at rotation ``theta`` [rad], of weight and bed."""
    v = level_at(m, theta, load)
    energy = load * v + stored(m, sinking(m, State(v, theta, 0.0, 0.0)))
    return energy - 0.5 * load * m.height * theta * theta if m.finite is None else energy


@kernel
def summit(m, load):
    """Return the rotation [rad] beyond which no bed holds the pier, (B/2h)(1 − W/Q) or less by as much as the foot sinks."""
    share = 1.0 - load / m.strength
    return math.atan(m.half_width / m.height * share)


@kernel
def tilt(m):
    """Return the tilt [rad] of the line that is next to the plastic set."""
    across, square = 0.0, 0.0
    for j in range(int(m.strips) + 1):
        across += m.bed[SET, j] * m.bed[POSITIONS, j]
        square += m.bed[POSITIONS, j] * m.bed[POSITIONS, j]
    return across / square


@kernel
def lean(m, load):
    """Return the rotation [rad] at which the pier rests on its bed, from the bed's tilt to where it leans; NaN for none."""
    theta = tilt(m)
    back = righting(m, theta, load)
    if back == 0.0:
        return theta
    step = FIRST_STEP * load / (m.stiffness * m.half_width) * (-1.0 if back > 0.0 else 1.0)
    here = theta
    while abs(here) < 0.5 * math.pi:
        further = here + step
        if (righting(m, further, load) > 0.0) != (back > 0.0):
            return _between(m, here, further, load)
        here, step = further, step * LONGER
    return math.nan


@kernel
def _between(m, start, end, load):
    """Return the equilibrium between two rotations [rad] at which the pier goes to either side."""
    low, high = min(start, end), max(start, end)
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if righting(m, middle, load) > 0.0 else (middle, high)
    return 0.5 * (low + high)
