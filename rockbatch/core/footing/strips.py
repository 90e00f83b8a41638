"""The bed under the foot: its push, what it stores, and its plastic set (THEORY.md, A footing).

The ground sinks under the foot by d(x) = level + slope x. Nodes lie between the strips, and the plastic set is linear between
them, so that the elastic deflection e = d − set is linear in a strip, and what is pressed of it is known in closed form.
The set is the greatest of linear functions, hence convex, and e concave: what is pressed is one interval, of which two strips at
most are pressed in part.
"""

import math
from typing import NamedTuple

from rockbatch.core.footing.model import AREA, ARMS, CHUNK, ORDER, POSITIONS, SET, WEIGHTS
from rockbatch.core.kernel import inlined, kernel, summing
from rockbatch.core.roots import falls, hermite, hermite_slope, summit_within
from rockbatch.core.trigonometry import sine_and_cosine

SMALLEST = 1e-300
"""Added to a divisor that is 0 where the foot does not touch."""

COUNT = 26
"""Binary digit of a sum over nodes from which on it holds how many they are; below it is the sum of their numbers."""

GAUSS = math.sqrt(0.6)
"""Outer points of Gauss's rule with three, which together with the middle one integrate polynomials of degree 5 from −1 to 1."""

UNTOUCHED = 1e200
"""Set of nodes that pad a bed [m]."""


class Sinking(NamedTuple):
    """How far the ground under the foot is pressed down, and how fast: linear in x."""

    level: float  # under the middle [m]
    slope: float  # [1]
    level_rate: float  # [m/s]
    slope_rate: float  # [1/s]


class Push(NamedTuple):
    """Push of the bed on the foot, per unit mass of the pier."""

    force: float  # Σ P, up [m/s²]
    moment: float  # Σ P x [m²/s²]
    touched: float  # share of the area that is pressed


class Sums(NamedTuple):
    """Sums over the nodes that are pressed."""

    force: float
    moment: float
    nodes: float  # how many, times 2^COUNT, and the sum of their numbers


@inlined
def sinking(m, y):
    """Return the Sinking of the ground in state ``y``."""
    if m.finite is None:
        return Sinking(-y.v, y.theta, -y.v_rate, y.omega)
    s, c = sine_and_cosine(y.theta)
    drop = m.height * s * s / (1.0 + c)  # h (1 − cos θ), without the loss of digits
    return Sinking(-y.v - drop, s, -y.v_rate - m.height * s * y.omega, c * y.omega)


@inlined
def _within(pressure, strength):
    return max(0.0, min(pressure, strength))


@inlined
def deflection(m, d, j):
    """Return the elastic deflection e at node ``j`` [m]."""
    return d.level + d.slope * m.bed[POSITIONS, j] - m.bed[SET, j]


@inlined
def pressure(m, d, j):
    """Return the pressure at node ``j``, spring and dashpot, as if it were pressed, times the area over the mass [m/s²]."""
    rate = d.level_rate + d.slope_rate * m.bed[POSITIONS, j]
    return m.stiffness * deflection(m, d, j) + m.damping * rate


@summing
def _sums(m, d):
    """Return the Sums over pressed nodes: the push itself, but for strips that are pressed in part."""
    force, moment, nodes = 0.0, 0.0, 0.0
    level, slope, stiffness, strength = d.level, d.slope, m.stiffness, m.strength
    constant, linear = stiffness * level + m.damping * d.level_rate, stiffness * slope + m.damping * d.slope_rate
    bed = m.bed
    for j in range(_padded(m.strips)):
        x, plastic = bed[POSITIONS, j], bed[SET, j]
        pressed = level + slope * x > plastic
        by = max(0.0, min(constant + linear * x - stiffness * plastic, strength))
        by = by if pressed else 0.0
        force += bed[WEIGHTS, j] * by
        moment += bed[ARMS, j] * by
        nodes += bed[ORDER, j] * (1.0 if pressed else 0.0)
    return Sums(force, moment, nodes)


@inlined
def _padded(strips):
    """Return the number of nodes of a bed, with those that pad it."""
    return (int(strips) // CHUNK + 1) * CHUNK


@inlined
def _in_part(m, d, near, far):
    """Return by how much the Push of the strip between a pressed node ``near`` and a clear one ``far`` exceeds the Sums.

    The pressure is linear in the part that is pressed, between 0 and the strength, dashpots included.
    """
    e_near, e_far, x = deflection(m, d, near), deflection(m, d, far), m.bed[POSITIONS, near]
    by_near, by_far, way = pressure(m, d, near), pressure(m, d, far), m.bed[POSITIONS, far] - x
    share, area = _within(e_near / (e_near - e_far + SMALLEST), 1.0), m.bed[AREA, min(near, far)]
    inner, outer = _within(by_near, m.strength), _within(by_near + share * (by_far - by_near), m.strength)
    force, lumped = share * 0.5 * (inner + outer), 0.5 * inner
    moment = force * x + share * share * way * (inner + 2.0 * outer) * (1.0 / 6.0)
    return Push(area * (force - lumped), area * (moment - lumped * (x + way * (1.0 / 3.0))), area * (share - 0.5))


@inlined
def _first(beyond, count, most):
    """Return the number of the first of ``count`` nodes whose numbers exceed those from 0 on by ``beyond``; ``most`` at most."""
    if beyond == 0:
        return 0
    return most if beyond == count * most else int(beyond / count + 0.5)


@inlined
def push(m, d):
    """Return the Push of the bed under the Sinking ``d``."""
    sums, strips = _sums(m, d), int(m.strips)
    nodes = int(sums.nodes)
    count = nodes >> COUNT
    if count == 0:
        return Push(0.0, 0.0, 0.0)
    if count > strips:
        return Push(sums.force, sums.moment, 1.0)
    beyond = nodes - (count << COUNT) - (count * (count - 1) >> 1)  # of the numbers from 0 on
    first = _first(beyond, count, strips + 1 - count)
    last = first + count - 1
    force, moment = sums.force, sums.moment
    touched = m.bed[AREA, 0] * (count - (0.5 if first == 0 else 0.0) - (0.5 if last == strips else 0.0))
    if first > 0:
        more = _in_part(m, d, first, first - 1)
        force, moment, touched = force + more.force, moment + more.moment, touched + more.touched
    if last < strips:
        more = _in_part(m, d, last, last + 1)
        force, moment, touched = force + more.force, moment + more.moment, touched + more.touched
    return Push(force, moment, touched)


@kernel
def pressed_middle(m, d):
    """Return the mean position of the nodes that push, 0 if none does [m].

    A pivot on a damped spring leaves it when its push is 0, 2ζ/ω_v before its deflection is.
    """
    total, area = 0.0, 0.0
    for j in range(int(m.strips) + 1):
        if deflection(m, d, j) > 0.0 and pressure(m, d, j) > 0.0:
            total, area = total + m.bed[WEIGHTS, j] * m.bed[POSITIONS, j], area + m.bed[WEIGHTS, j]
    return total / area if area > 0.0 else 0.0


@kernel
def stored(m, d):
    """Return the elastic energy of the bed [J/kg]: beyond the strength, with the work of the set that takes it there."""
    energy, most = 0.0, m.strength / m.stiffness
    for j in range(int(m.strips)):
        left, right = deflection(m, d, j), deflection(m, d, j + 1)
        deep = max(max(left, right), 0.0)
        share = deep / (deep - min(min(left, right), 0.0) + SMALLEST)
        a, b = max(left, 0.0), max(right, 0.0)
        simpson = _energy_at(a, most) + 4.0 * _energy_at(0.5 * (a + b), most) + _energy_at(b, most)
        energy += m.bed[AREA, j] * share * simpson * (1.0 / 6.0)
    return m.stiffness * energy


@inlined
def _energy_at(e, most):
    return 0.5 * e * e if e <= most else most * (e - 0.5 * most)


@summing
def _beyond(m, d, d_end, h):
    """Return a number above 0 if the ground under some node may have yielded in a step of ``h`` [s]: by Bézier points."""
    total, most, third = 0.0, m.strength / m.stiffness, h * (1.0 / 3.0)
    first, first_slope = d.level + third * d.level_rate, d.slope + third * d.slope_rate
    last, last_slope = d_end.level - third * d_end.level_rate, d_end.slope - third * d_end.slope_rate
    bed, level, slope, level_end, slope_end = m.bed, d.level, d.slope, d_end.level, d_end.slope
    for j in range(_padded(m.strips)):
        x = bed[POSITIONS, j]
        deepest = max(
            max(level + slope * x, level_end + slope_end * x), max(first + first_slope * x, last + last_slope * x)
        )
        total += max(deepest - (bed[SET, j] + most), 0.0)
    return total


@inlined
def _deepest(m, d, h):
    """Return a bound on the depth under the foot [m], of a Sinking and its rate for ``h`` [s] from it."""
    along = d.slope + h * d.slope_rate
    return max(
        d.level + abs(d.slope) * m.bed[POSITIONS, int(m.strips)],
        d.level + h * d.level_rate + abs(along) * m.bed[POSITIONS, int(m.strips)],
    )


@kernel
def settle(m, d, d_end, h):
    """Bring the plastic set up to a step of ``h`` [s] between two Sinkings: a running maximum. Return whether any has grown."""
    most, yields, third = m.strength / m.stiffness, False, h * (1.0 / 3.0)
    if max(_deepest(m, d, third), _deepest(m, d_end, -third)) <= most:
        return False
    if not _beyond(m, d, d_end, h) > 0.0:
        return False
    for j in range(int(m.strips) + 1):
        growth, _ = _growth(m, d, d_end, h, j)
        if growth > 0.0:
            m.bed[SET, j] += growth
            yields = True
    return yields


@inlined
def _depths(m, d, d_end, j):
    """Return the depth at node ``j`` [m] and its rate [m/s] under two Sinkings."""
    x = m.bed[POSITIONS, j]
    start, end = d.level + d.slope * x, d_end.level + d_end.slope * x
    return start, d.level_rate + d.slope_rate * x, end, d_end.level_rate + d_end.slope_rate * x


@inlined
def _growth(m, d, d_end, h, j):
    """Return by how much the set at node ``j`` grows in a step of ``h`` [s] between two Sinkings, and until when."""
    start, rate, end, rate_end = _depths(m, d, d_end, j)
    before = m.bed[SET, j] + m.strength / m.stiffness
    deepest, until = summit_within(start, rate, end, rate_end, h, before)
    return deepest - before, until


@kernel
def settling_work(m, d, d_end, h):
    """Return the plastic work [J/kg] of a step that ``settle`` has not brought the set up to.

    In a strip of which one end yields the push on that end depends on the other one, so that no function of the set is its work.
    It is integrated over the time in which the node yields, by three points of Gauss.
    """
    work = 0.0
    for j in range(int(m.strips) + 1):
        growth, until = _growth(m, d, d_end, h, j)
        if growth > 0.0:
            start, rate, end, rate_end = _depths(m, d, d_end, j)
            before = m.bed[SET, j] + m.strength / m.stiffness
            since = falls(before - start, -rate, before - end, -rate_end, h) if start < before else 0.0
            middle, half = 0.5 * (until + since), 0.5 * (until - since)
            for shift, share in ((-GAUSS, 5.0 / 9.0), (0.0, 8.0 / 9.0), (GAUSS, 5.0 / 9.0)):
                x = middle + shift * half
                at = _sinking_at(d, d_end, h, x)
                force = _push_at(m, at, j, j - 1) + _push_at(m, at, j, j + 1)
                work += share * half * force * hermite_slope(start, rate, end, rate_end, h, x)
    return work


@inlined
def _sinking_at(d, d_end, h, x):
    """Return the Sinking ``x`` [s] after the start of a step of ``h`` [s]; its rates are those at the start."""
    level = hermite(d.level, d.level_rate, d_end.level, d_end.level_rate, h, x)
    slope = hermite(d.slope, d.slope_rate, d_end.slope, d_end.slope_rate, h, x)
    return Sinking(level, slope, d.level_rate, d.slope_rate)


@inlined
def _push_at(m, d, j, k):
    """Return the push of the springs of the strip between nodes ``j`` and ``k`` that acts at ``j`` [m/s²]."""
    if k < 0 or k > int(m.strips):
        return 0.0
    most, area = m.strength / m.stiffness, m.bed[AREA, min(j, k)]
    near, far = min(deflection(m, d, j), most), min(deflection(m, d, k), most)
    share = near / (near - far) if far < 0.0 else 1.0
    return (
        area * m.stiffness * share * (0.5 * (near + max(far, 0.0)) - share * (near + 2.0 * max(far, 0.0)) * (1.0 / 6.0))
    )


@kernel
def lay(m):
    """Lay an unyielded bed of equal strips, or two narrow ones at the edges."""
    n, b = int(m.strips), m.half_width
    for j in range(m.bed.shape[1]):
        m.bed[POSITIONS, j] = b * (2.0 * min(j, n) / n - 1.0)
        m.bed[AREA, j] = 1.0 / n if j < n else 0.0
        m.bed[WEIGHTS, j] = m.bed[ARMS, j] = 0.0
        m.bed[ORDER, j], m.bed[SET, j] = float((1 << COUNT) + j), 0.0 if j <= n else UNTOUCHED
    if m.gap > 0.0:  # of three strips the one in the middle is a gap
        m.bed[POSITIONS, 0], m.bed[POSITIONS, 1] = -b * (1.0 + m.gap), -b * (1.0 - m.gap)
        m.bed[POSITIONS, 2], m.bed[POSITIONS, 3] = b * (1.0 - m.gap), b * (1.0 + m.gap)
        m.bed[AREA, 0], m.bed[AREA, 1], m.bed[AREA, 2] = 0.5, 0.0, 0.5
    for j in range(n):
        half, third, left, right = (
            0.5 * m.bed[AREA, j],
            m.bed[AREA, j] * (1.0 / 6.0),
            m.bed[POSITIONS, j],
            m.bed[POSITIONS, j + 1],
        )
        m.bed[WEIGHTS, j] += half
        m.bed[WEIGHTS, j + 1] += half
        m.bed[ARMS, j] += third * (2.0 * left + right)
        m.bed[ARMS, j + 1] += third * (left + 2.0 * right)


@kernel
def plastic_work(m):
    """Return the plastic work of the bed [J/kg], from its set."""
    work = 0.0
    for j in range(int(m.strips) + 1):
        work += m.bed[WEIGHTS, j] * m.bed[SET, j]
    return m.strength * work if work > 0.0 else 0.0
