"""The bed under the foot: its push, what it stores, and its plastic set (THEORY.md, A footing).

The ground sinks under the foot by d(x) = level + slope x. Nodes lie between the strips, and the plastic set is linear between
them, so that the elastic deflection e = d − set is linear in a strip, and what is pressed of it is known in closed form.
The set is the greatest of linear functions, hence convex, and e and the pressure concave: the nodes that are pressed, or whose
ground yields, follow each other, and so the push is a difference of sums that are kept at every node. Two strips at most are
pressed in part.
"""

import math
from typing import NamedTuple

from rockbatch.core.footing.model import (
    AREA,
    ARM,
    ARMED_POSITIONS,
    ARMED_SETS,
    ARMS,
    DEEPEST,
    FIRST,
    POSITION,
    PRESSED,
    SET,
    WEIGHT,
    WEIGHTED_POSITIONS,
    WEIGHTED_SETS,
    WEIGHTS,
    YIELDING,
)
from rockbatch.core.kernel import inlined, kernel
from rockbatch.core.roots import falls, hermite, hermite_slope, inner_points, summit_within
from rockbatch.core.trigonometry import sine_and_cosine

GAUSS = math.sqrt(0.6)
"""Outer points of Gauss's rule with three, which together with the middle one integrate polynomials of degree 5 from −1 to 1."""


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


class Line(NamedTuple):
    """A concave function of the nodes: linear in their positions, less a multiple of their sets."""

    level: float
    slope: float
    sets: float


class Span(NamedTuple):
    """Nodes that follow each other; none if the last is the one before the first."""

    first: int
    last: int


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
def last_node(m):
    """Return the node at the right edge."""
    return FIRST + int(m.strips)


@inlined
def deflection(m, d, j):
    """Return the elastic deflection e at node ``j`` [m]; negative if it is clear."""
    return d.level + d.slope * m.bed[j, POSITION] - m.bed[j, SET]


@inlined
def _pressures(m, d):
    """Return the Line of pressures, spring and dashpot, as if all nodes were pressed, times the area over the mass [m/s²]."""
    return Line(
        m.stiffness * d.level + m.damping * d.level_rate, m.stiffness * d.slope + m.damping * d.slope_rate, m.stiffness
    )


@inlined
def pressure(m, d, j):
    """Return the pressure at node ``j``, as if it were pressed, times the area over the mass [m/s²]."""
    return _value(m, _pressures(m, d), j)


@inlined
def _value(m, line, j):
    return line.level + line.slope * m.bed[j, POSITION] - line.sets * m.bed[j, SET]


@inlined
def _beyond(m, line, most, near):
    """Return the Span of nodes at which a Line exceeds ``most``; if there are none, an empty one where the Line is greatest.

    The search begins at ``near``, which mostly is the result.
    """
    first = _value(m, line, near.first)
    if near.first > near.last:
        holds = first <= most and first >= max(_value(m, line, near.first - 1), _value(m, line, near.first + 1))
    else:
        holds = min(first, _value(m, line, near.last)) > most
        holds = holds and max(_value(m, line, near.first - 1), _value(m, line, near.last + 1)) <= most
    return near if holds else _found(m, line, most, near)


@kernel
def _found(m, line, most, near):
    """Return the Span that :func:`_beyond` seeks, by a walk over nodes from ``near``."""
    first, last = near.first, max(near.first, near.last)
    while first < last and not _value(m, line, first) > most:
        first += 1
    while first < last and not _value(m, line, last) > most:
        last -= 1
    if first == last and not _value(m, line, first) > most:
        here, side = _value(m, line, first), 1 if _value(m, line, first + 1) > _value(m, line, first) else -1
        while _value(m, line, first + side) > here:
            first += side
            here = _value(m, line, first)
        if not here > most:
            return Span(first, first - 1)
        last = first
    while _value(m, line, first - 1) > most:
        first -= 1
    while _value(m, line, last + 1) > most:
        last += 1
    return Span(first, last)


@inlined
def _span(m, line, most, place):
    """Return the Span of nodes at which a Line exceeds ``most``, sought from the one kept at ``place``, and keep it there."""
    near = Span(int(m.bed[-1, place]), int(m.bed[-1, place + 1]))
    span = _beyond(m, line, most, near)
    m.bed[-1, place], m.bed[-1, place + 1] = float(span.first), float(span.last)
    return span


@inlined
def _total(m, column, first, last):
    """Return the sum over the nodes ``first`` to ``last`` of the quantity whose running sums are in ``column`` of the bed."""
    return m.bed[last + 1, column] - m.bed[first, column]


@inlined
def _sums(m, line, most, first, last):
    """Return force and moment of the pressures of a Line less ``most``, over the nodes ``first`` to ``last``."""
    level, slope, sets = line.level - most, line.slope, line.sets
    force, moment = level * _total(m, WEIGHTS, first, last), level * _total(m, ARMS, first, last)
    force += slope * _total(m, WEIGHTED_POSITIONS, first, last) - sets * _total(m, WEIGHTED_SETS, first, last)
    moment += slope * _total(m, ARMED_POSITIONS, first, last) - sets * _total(m, ARMED_SETS, first, last)
    return force, moment


@inlined
def _in_part(m, d, p, near, far):
    """Return the Push of the strip between a pressed node ``near`` and a clear one ``far``, less its part of the sum over nodes.

    ``p`` is the Line of pressures. The pressure is linear in the pressed part, between 0 and the strength, dashpots included.
    """
    e_near, e_far, x = deflection(m, d, near), deflection(m, d, far), m.bed[near, POSITION]
    by_near, by_far, way = _value(m, p, near), _value(m, p, far), m.bed[far, POSITION] - x
    share, area = e_near / (e_near - e_far), m.bed[min(near, far), AREA]
    inner, outer = _within(by_near, m.strength), _within(by_near + share * (by_far - by_near), m.strength)
    force, lumped = share * 0.5 * (inner + outer), 0.5 * inner
    moment = force * x + share * share * way * (inner + 2.0 * outer) * (1.0 / 6.0)
    return Push(area * (force - lumped), area * (moment - lumped * (x + way * (1.0 / 3.0))), area * share)


@inlined
def push(m, d):
    """Return the Push of the bed, springs and dashpots, under the Sinking ``d``; zeros if the foot is clear."""
    p, pressed = _pressures(m, d), _span(m, Line(d.level, d.slope, 1.0), 0.0, PRESSED)
    first, last = pressed
    if last < first:
        return Push(0.0, 0.0, 0.0)
    while first <= last and not _value(m, p, first) > 0.0:
        first += 1
    while first <= last and not _value(m, p, last) > 0.0:
        last -= 1
    force, moment = _sums(m, p, 0.0, first, last)
    if m.strength < math.inf:
        yielding = _span(m, p, m.strength, YIELDING)
        from_node, to_node = max(yielding.first, first), min(yielding.last, last)
        if from_node <= to_node:
            more_force, more_moment = _sums(m, p, m.strength, from_node, to_node)
            force, moment = force - more_force, moment - more_moment
    strips = pressed.last - pressed.first
    touched = m.bed[FIRST, AREA] * strips if strips < m.strips else 1.0
    if pressed.first > FIRST:
        more = _in_part(m, d, p, pressed.first, pressed.first - 1)
        force, moment, touched = force + more.force, moment + more.moment, touched + more.touched
    if pressed.last < last_node(m):
        more = _in_part(m, d, p, pressed.last, pressed.last + 1)
        force, moment, touched = force + more.force, moment + more.moment, touched + more.touched
    return Push(force, moment, touched)


@kernel
def pressed_middle(m, d):
    """Return the mean position of the nodes that push, weighted by area, 0 if none does [m].

    A pivot on a damped spring leaves it when its push is 0, 2ζ/ω_v before its deflection is.
    """
    total, area = 0.0, 0.0
    for j in range(FIRST, last_node(m) + 1):
        if deflection(m, d, j) > 0.0 and pressure(m, d, j) > 0.0:
            total, area = total + m.bed[j, WEIGHT] * m.bed[j, POSITION], area + m.bed[j, WEIGHT]
    return total / area if area > 0.0 else 0.0


@kernel
def stored(m, d):
    """Return the elastic energy of the bed [J/kg].

    Where the deflection exceeds that at the strength, the plastic work on the way from there is included.
    """
    energy, most = 0.0, m.strength / m.stiffness
    for j in range(FIRST, last_node(m)):
        left, right = deflection(m, d, j), deflection(m, d, j + 1)
        deep = max(left, right)
        if deep > 0.0:
            share = deep / (deep - min(min(left, right), 0.0))
            a, b = max(left, 0.0), max(right, 0.0)
            simpson = _energy_at(a, most) + 4.0 * _energy_at(0.5 * (a + b), most) + _energy_at(b, most)
            energy += m.bed[j, AREA] * share * simpson * (1.0 / 6.0)
    return m.stiffness * energy


@inlined
def _energy_at(e, most):
    return 0.5 * e * e if e <= most else most * (e - 0.5 * most)


@inlined
def _deepest(m, slope, near):
    """Return the node at which slope x − set is greatest, sought from ``near``."""
    return _beyond(m, Line(0.0, slope, 1.0), math.inf, Span(near, near - 1)).first


@inlined
def settle(m, d, d_end, h):
    """Raise each node's plastic set to the greatest of d less the yield deflection in a step of ``h`` [s] between two Sinkings.

    Return whether any has grown, False for an elastic bed. The deepest node lies between those for the least and the greatest
    slope in the step, and what yields lies around it.
    """
    if m.strength == math.inf:
        return False
    third = h * (1.0 / 3.0)
    first, last = d.slope + third * d.slope_rate, d_end.slope - third * d_end.slope_rate
    left = _deepest(m, min(min(d.slope, d_end.slope), min(first, last)), int(m.bed[-1, DEEPEST]))
    right = _deepest(m, max(max(d.slope, d_end.slope), max(first, last)), left)
    m.bed[-1, DEEPEST] = float(right)
    if left == right:
        start, rate, end, rate_end = _depths(m, d, d_end, left)
        inner, outer = inner_points(start, rate, end, rate_end, h)
        if max(max(start, end), max(inner, outer)) <= m.bed[left, SET] + m.strength / m.stiffness:
            return False
    return _settle_around(m, d, d_end, h, left, right)


@kernel
def _settle_around(m, d, d_end, h, left, right):
    """Raise the set to that of a step, from the nodes ``left`` to ``right`` outwards. Return whether any has grown."""
    first, j, grows = last_node(m) + 1, right, False
    while grows or j >= left:
        grows = _grows(m, d, d_end, h, j)
        first = j if grows else first
        j -= 1
    j = right + 1
    while _grows(m, d, d_end, h, j):
        first = min(first, j)
        j += 1
    sum_sets(m, first)
    return first <= last_node(m)


@kernel
def _grows(m, d, d_end, h, j):
    """Raise the set of node ``j`` to its greatest in a step. Return whether it has grown."""
    growth, _ = _growth(m, d, d_end, h, j)
    if growth > 0.0:
        m.bed[j, SET] += growth
    return growth > 0.0


@kernel
def sum_sets(m, first):
    """Update the running sums of sets at all nodes to the right of ``first``, the leftmost node whose set has changed."""
    for j in range(first, last_node(m) + 1):
        m.bed[j + 1, WEIGHTED_SETS] = m.bed[j, WEIGHTED_SETS] + m.bed[j, WEIGHT] * m.bed[j, SET]
        m.bed[j + 1, ARMED_SETS] = m.bed[j, ARMED_SETS] + m.bed[j, ARM] * m.bed[j, SET]


@inlined
def _depths(m, d, d_end, j):
    """Return the depth at node ``j`` [m] and its rate [m/s] under the Sinking ``d``, then both under ``d_end``."""
    x = m.bed[j, POSITION]
    start, end = d.level + d.slope * x, d_end.level + d_end.slope * x
    return start, d.level_rate + d.slope_rate * x, end, d_end.level_rate + d_end.slope_rate * x


@inlined
def _growth(m, d, d_end, h, j):
    """Return the growth [m] of the set at node ``j`` in a step of ``h`` [s] between two Sinkings, and the time of its end [s].

    Zeros if it does not grow.
    """
    start, rate, end, rate_end = _depths(m, d, d_end, j)
    before = m.bed[j, SET] + m.strength / m.stiffness
    deepest, until = summit_within(start, rate, end, rate_end, h, before)
    return deepest - before if deepest > before else 0.0, until  # no difference of the infinite sets beside the bed


@kernel
def settling_work(m, d, d_end, h):
    """Return the plastic work [J/kg] of a step, before ``settle`` brings the set up to it.

    In a strip of which one end yields the push on that end depends on the other one, so that no function of the set is its work.
    It is integrated over the time in which the node yields, by three points of Gauss.
    """
    work = 0.0
    for j in range(FIRST, last_node(m) + 1):
        growth, until = _growth(m, d, d_end, h, j)
        if growth > 0.0:
            start, rate, end, rate_end = _depths(m, d, d_end, j)
            before = m.bed[j, SET] + m.strength / m.stiffness
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
    """Return the push [m/s²] at node ``j`` of the springs, at most their strength, of the strip to node ``k``, 0 without one."""
    if k < FIRST or k > last_node(m):
        return 0.0
    most, area = m.strength / m.stiffness, m.bed[min(j, k), AREA]
    near, far = min(deflection(m, d, j), most), min(deflection(m, d, k), most)
    share = near / (near - far) if far < 0.0 else 1.0
    return (
        area * m.stiffness * share * (0.5 * (near + max(far, 0.0)) - share * (near + 2.0 * max(far, 0.0)) * (1.0 / 6.0))
    )


@kernel
def lay(m):
    """Lay an unyielded bed of equal strips or, if ``gap`` is above 0, of two narrow ones about the edges."""
    n, b, last, bed = int(m.strips), m.half_width, last_node(m), m.bed
    for j in range(len(bed)):
        bed[j, POSITION] = b * (2.0 * min(max(j - FIRST, 0), n) / n - 1.0)
        bed[j, AREA] = 1.0 / n if FIRST <= j < last else 0.0
        bed[j, WEIGHT] = bed[j, ARM] = 0.0
        bed[j, SET] = 0.0 if FIRST <= j <= last else math.inf
    if m.gap > 0.0:  # of three strips the one in the middle is a gap
        for j, x, area in (
            (1, -1.0 - m.gap, 0.5),
            (2, -1.0 + m.gap, 0.0),
            (3, 1.0 - m.gap, 0.5),
            (4, 1.0 + m.gap, 0.0),
        ):
            bed[j, POSITION], bed[j, AREA] = b * x, area
    for j in range(FIRST, last):
        half, third = 0.5 * bed[j, AREA], bed[j, AREA] * (1.0 / 6.0)
        left, right = bed[j, POSITION], bed[j + 1, POSITION]
        bed[j, WEIGHT] += half
        bed[j + 1, WEIGHT] += half
        bed[j, ARM] += third * (2.0 * left + right)
        bed[j + 1, ARM] += third * (left + 2.0 * right)
    bed[FIRST, WEIGHTS:] = 0.0
    for j in range(FIRST, last + 1):
        bed[j + 1, WEIGHTS] = bed[j, WEIGHTS] + bed[j, WEIGHT]
        bed[j + 1, WEIGHTED_POSITIONS] = bed[j, WEIGHTED_POSITIONS] + bed[j, WEIGHT] * bed[j, POSITION]
        bed[j + 1, ARMS] = bed[j, ARMS] + bed[j, ARM]
        bed[j + 1, ARMED_POSITIONS] = bed[j, ARMED_POSITIONS] + bed[j, ARM] * bed[j, POSITION]
    sum_sets(m, FIRST)
    bed[-1, PRESSED], bed[-1, PRESSED + 1] = FIRST, last
    bed[-1, YIELDING], bed[-1, YIELDING + 1], bed[-1, DEEPEST] = FIRST, FIRST - 1, FIRST


@kernel
def plastic_work(m):
    """Return the plastic work of the bed [J/kg], its strength times the mean of its set; 0 if it is elastic."""
    work = m.bed[last_node(m) + 1, WEIGHTED_SETS]
    return m.strength * work if work > 0.0 else 0.0
