"""Equilibria of a pier on its bed as it is (THEORY.md, A footing): the level at a rotation, its energy, where the pier rests."""

import math
from typing import NamedTuple

from rockbatch.core.flexure.shaft import leaning_height, overhang
from rockbatch.core.footing.model import FIRST, POSITION, SET, State
from rockbatch.core.footing.strips import last_node, push, sinking, stored
from rockbatch.core.kernel import inlined, kernel

TRIALS = 60
"""Greatest number of trials for an equilibrium; ten are usual, to rounding."""

FIRST_STEP, LONGER = 0.02, 1.25
"""First step of the search for a stable equilibrium, over the rotation of uplift, and the factor from each to the next."""


class Bracket(NamedTuple):
    """Interval in which a function falls through zero, with its values at both ends, of which one may be weighted."""

    low: float
    above: float
    high: float
    below: float
    side: float  # of the last trial: 1 if it became the low end, −1 the high one


@inlined
def _trial(bracket):
    """Return the zero of the chord through both ends."""
    return bracket.low + (bracket.high - bracket.low) * bracket.above / (bracket.above - bracket.below)


@inlined
def _narrowed(bracket, x, value):
    """Return the Bracket with a trial ``x`` as its low end if ``value`` > 0, else as its high end.

    The value at the other end counts half if that end has stayed before (Illinois method).
    """
    if value > 0.0:
        below = bracket.below * (0.5 if bracket.side == 1.0 else 1.0)
        return Bracket(x, value, bracket.high, below, 1.0)
    above = bracket.above * (0.5 if bracket.side == -1.0 else 1.0)
    return Bracket(bracket.low, above, x, value, -1.0)


@kernel
def _surplus(m, theta, v, load):
    """Return the bed's force less the ``load`` [m/s²] at rotation ``theta`` [rad] and level ``v`` [m], at rest."""
    return push(m, sinking(m, State(v, theta, 0.0, 0.0))).force - load


@kernel
def level_at(m, theta, load):
    """Return v [m] at which the bed carries the ``load`` [m/s²] at rotation ``theta`` [rad]."""
    deepest = load / m.stiffness
    for j in range(FIRST, last_node(m) + 1):
        deepest = max(deepest, m.bed[j, SET] + load / m.stiffness)
    reach = m.half_width * (1.0 + m.gap) * abs(theta) + m.height * theta * theta
    low, v = -deepest - reach - load / m.stiffness, reach
    bracket = Bracket(low, _surplus(m, theta, low, load), v, -load, 0.0)
    for _ in range(TRIALS):
        v = _trial(bracket)
        if not bracket.low < v < bracket.high:
            break
        bracket = _narrowed(bracket, v, _surplus(m, theta, v, load))
    return v


@kernel
def righting(m, theta, load):
    """Return the moment to the left [m²/s²] on the pier at rest under ``load`` [m/s²] at rotation ``theta`` [rad].

    It is that of the bed less that of the load: positive, it rights a pier that leans to the right. A bending shaft hangs over.
    """
    bed = push(m, sinking(m, State(level_at(m, theta, load), theta, 0.0, 0.0)))
    if m.finite is None:
        return bed.moment - m.height * theta * load
    sine, cosine = math.sin(theta), math.cos(theta)
    return bed.moment * cosine - m.height * sine * load - m.gravity * overhang(m.shaft, m) * sine * cosine


@kernel
def level_energy(m, theta, load):
    """Return the least energy [J/kg] of the pier at rotation ``theta`` [rad]: of bed and shaft, and of ``load`` [m/s²] at v.

    In first-order kinematics it is less by ½ ``load`` h θ².
    """
    v = level_at(m, theta, load)
    energy = load * v + stored(m, sinking(m, State(v, theta, 0.0, 0.0)))
    if m.finite is None:
        return energy - 0.5 * load * m.height * theta * theta
    sine = math.sin(theta)
    return energy - 0.5 * m.gravity * overhang(m.shaft, m) * sine * sine


@kernel
def summit(m, load):
    """Return the rotation [rad] beyond which no bed holds the pier: arctan((b/h)(1 − load/Q)), arctan(b/h) if elastic.

    Of a pier whose shaft bends a lesser one, which the bed holds.
    """
    share = 1.0 - load / m.strength
    return math.atan(m.half_width / leaning_height(m) * share)


@kernel
def tilt(m):
    """Return the tilt [rad] of the straight line nearest to the plastic set of all nodes, by least squares."""
    across, square = 0.0, 0.0
    for j in range(FIRST, last_node(m) + 1):
        across += m.bed[j, SET] * m.bed[j, POSITION]
        square += m.bed[j, POSITION] * m.bed[j, POSITION]
    return across / square


@kernel
def lean(m, load):
    """Return the rotation [rad] at which the pier rests on its bed; NaN if there is none up to π/2.

    It is the first equilibrium from the bed's tilt on, in the direction in which the pier leans there.
    """
    here = tilt(m)
    back = righting(m, here, load)
    if back == 0.0:
        return here
    way = -1.0 if back > 0.0 else 1.0  # in which the pier leans
    step = FIRST_STEP * load / (m.stiffness * m.half_width)
    while abs(here) < 0.5 * math.pi:
        further = here + way * step
        ahead = righting(m, further, load)
        if (ahead > 0.0) != (back > 0.0):
            return _between(m, way, Bracket(way * here, abs(back), way * further, -abs(ahead), 0.0), load)
        here, back, step = further, ahead, step * LONGER
    return math.nan


@kernel
def _between(m, way, bracket, load):
    """Return the equilibrium [rad] in the Bracket of rotations to the side ``way`` (±1)."""
    theta = bracket.high
    for _ in range(TRIALS):
        theta = _trial(bracket)
        if not bracket.low < theta < bracket.high:
            break
        bracket = _narrowed(bracket, theta, -way * righting(m, way * theta, load))
    return way * theta
