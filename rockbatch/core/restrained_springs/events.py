"""What ends a smooth piece of the motion of a pier on springs with elements, and where in a step.

Beside what can happen to a pivot (``rockbatch.core.events``): an element's gap turns, a friction damper lets go, a tendon goes
slack or taut, or yields.
"""

import math

from rockbatch.core.equations import accelerations, along, geometry
from rockbatch.core.events import NO_ACCELERATION, NO_GAP, signals, surely
from rockbatch.core.kernel import kernel
from rockbatch.core.restrained.elements import (
    CLOSES,
    FRICTION,
    OPENS,
    SLACK,
    STICKS,
    TAUT,
    TENDON,
    YIELDING,
    mode_of,
    tension,
)
from rockbatch.core.restrained.equations import copy
from rockbatch.core.restrained.events import change_tendon, earliest, narrowed
from rockbatch.core.restrained_springs.equations import (
    NONE,
    all_rates,
    gap,
    lifted,
    step,
    sticking,
    under_elements,
)
from rockbatch.core.rigid.equations import later
from rockbatch.core.roots import BISECT_AFTER, CLOSE, TRIALS
from rockbatch.core.transitions import LAW_LEFT

OF_ELEMENTS = 4
"""Signals of the pivots; behind them three of each element: it turns, it goes slack or taut again, it yields or lets go."""

TURNS, SLACKENS, GIVES = 0, 1, 2

NEARBY = 1e-6
"""Of a step: over which the rate of a friction damper's force is taken."""

SOON = 1e-3
"""Of a step: how long after friction has let go it is looked at what goes where."""

SURE = 1e-9
"""Of a friction damper's strength: by how much rounding lets it hold more."""

WAYS = (
    (STICKS, STICKS), (OPENS, STICKS), (CLOSES, STICKS), (STICKS, OPENS), (STICKS, CLOSES),
    (OPENS, OPENS), (OPENS, CLOSES), (CLOSES, OPENS), (CLOSES, CLOSES),
)  # fmt: skip
"""What two friction dampers can do that have no velocity."""


@kernel
def _of_element(of, at, state, mode, goes, acceleration, rest, rounding, signals_of, slopes_of):
    """The three signals of an element, and their slopes, but for a friction damper that does not move."""
    signals_of[:], slopes_of[:] = 1.0, 0.0
    speed = surely(at.speed, acceleration, rest)
    if of.kind != TENDON or mode == YIELDING:
        way = OPENS if of.kind == TENDON else goes
        starts = abs(at.speed) <= rest and way * acceleration >= 0.0  # it has just turned, or is let go, to rounding
        signals_of[TURNS], slopes_of[TURNS] = rest if starts else way * at.speed, way * acceleration
        return
    pull, rate = tension(of, at.elongation, state), of.stiffness * speed
    sign, least = 1.0 if mode == TAUT else -1.0, of.stiffness * rounding
    signals_of[SLACKENS], slopes_of[SLACKENS] = sign * pull, sign * rate
    if abs(pull) <= least and sign * rate > 0.0:  # it has just changed, to rounding
        signals_of[SLACKENS] = least
    if abs(at.speed) <= rest and abs(pull) <= least:  # it hangs there, neither taut nor slack
        signals_of[SLACKENS], slopes_of[SLACKENS] = least, 0.0
    if mode == TAUT and of.strength < math.inf:
        signals_of[GIVES], slopes_of[GIVES] = of.strength - pull, -rate
        if abs(signals_of[GIVES]) <= least and rate < 0.0:
            signals_of[GIVES] = least


@kernel
def _of_friction(m, ties, y, x, contact, k, kx, ground, h, forces, work, values, slopes):
    """What friction dampers that do not move could hold more; its rate from a moment later."""
    near, later_x = NEARBY * h, work[1]
    for i in range(len(x)):
        later_x[i] = x[i] + near * kx[i]
    a, c = ground.horizontal + near * ground.horizontal_slope, ground.vertical + near * ground.vertical_slope
    _, one, two = under_elements(m, ties, along(y, k, near), later_x, contact, a, c)
    j, later_forces = NONE, (one, two)
    for number in range(2):
        j = sticking(ties, j)
        if j == NONE:
            return
        at, strength = OF_ELEMENTS + 3 * j + GIVES, ties.elements[j].strength
        values[at] = strength - abs(forces[number])
        slopes[at] = (abs(forces[number]) - abs(later_forces[number])) / near


@kernel
def _seen(m, ties, y, x, contact, supports, rest, ground, h, work, values, slopes):
    """Signals of a state and their slopes, at the start of ``ground``; the state's rates."""
    kx, a, c = work[0], ground.horizontal, ground.vertical
    k, under, one, two = all_rates(m, ties, y, x, contact, a, c, kx)
    f, d = signals(under, y, k, contact, supports.left, supports.right, rest, a, c)
    for i in range(OF_ELEMENTS):
        values[i], slopes[i] = f[i], d[i]
        at_once = abs(f[i]) <= (rest if i >= LAW_LEFT else NO_GAP)
        if at_once and abs(d[i]) <= NO_ACCELERATION * m.gravity:  # friction holds the pivot, on or just off its spring
            values[i], slopes[i] = 1.0, 0.0
        elif i >= LAW_LEFT and abs(f[i]) <= rest and d[i] > 0.0:  # it has just turned, to rounding
            values[i] = rest
    for j in range(len(ties.elements)):
        at, first = gap(m, ties.elements[j], y, ties.level), OF_ELEMENTS + 3 * j
        acceleration = lifted(y, at, k.v_rate, k.omega)
        if abs(acceleration) <= NO_ACCELERATION * m.gravity:
            acceleration = 0.0
        _of_element(
            ties.elements[j], at, x[j], ties.modes[j], ties.goes[j], acceleration, rest, NO_GAP * m.yield_deflection,
            values[first : first + 3], slopes[first : first + 3],
        )  # fmt: skip
        if ties.elements[j].kind == FRICTION and ties.goes[j] == STICKS:
            values[first], slopes[first] = 1.0, 0.0
    if sticking(ties, NONE) != NONE:
        _of_friction(m, ties, y, x, contact, k, kx, ground, h, (one, two), work, values, slopes)
    return k


@kernel
def piece(m, ties, y, x, contact, supports, rest, ground, h, work, marks, end_x):
    """From ``y`` and ``x`` over ``h`` [s] or to the first event before.

    ``marks``, shape (6, signals), keeps values and slopes of the signals at both ends of where the event is, and at the trial.

    Returns
    -------
    The time that it took [s]; the signal that fell, NONE without one; the State at its end, which ``end_x`` goes with; rates
    at its start and end.
    """
    early, early_slopes, late, late_slopes, now, now_slopes = marks[0], marks[1], marks[2], marks[3], marks[4], marks[5]
    a, b, t, which, last = 0.0, h, 0.0, NONE, False
    end, k, k_start = y, y, y
    for trial in range(TRIALS + 3):
        end = step(m, ties, y, x, contact, ground, t, work, end_x)
        k = _seen(m, ties, end, end_x, contact, supports, rest, later(ground, t), h, work, now, now_slopes)
        if last:
            break
        if trial == 0:
            copy(now, early)
            copy(now_slopes, early_slopes)
            k_start, t = k, h
            continue
        if trial == 1:
            copy(now, late)
            copy(now_slopes, late_slopes)
            which, at = earliest(early, early_slopes, late, late_slopes, h)
            if which == NONE:
                break
        else:
            a, b, which, at = narrowed(marks, a, t, b)
            if which != NONE and abs(a + at - t) <= CLOSE * h:
                break
        halve = trial > BISECT_AFTER and trial % 2 == 0
        t = 0.5 * (a + b) if halve else a + at
        if which == NONE or trial == TRIALS + 1:
            t, last = b, True
        elif t == a == 0.0:  # at once, and before all that comes no later
            last = True
    return t, which, end, k_start, k


@kernel
def _consistent(m, ties, y, x, contact, horizontal, vertical, first, second):
    """Whether the friction dampers ``first`` and ``second``, without velocity, can do what ``goes`` says of them."""
    under, one, two = under_elements(m, ties, y, x, contact, horizontal, vertical)
    v_acceleration, theta_acceleration = accelerations(under, y, contact, geometry(m, y.theta), horizontal, vertical)
    holding = sticking(ties, NONE)
    for j in (first, second):
        if j == NONE:
            continue
        if ties.goes[j] == STICKS:
            if abs(one if j == holding else two) > (1.0 + SURE) * ties.elements[j].strength:
                return False
        elif (
            ties.goes[j] * lifted(y, gap(m, ties.elements[j], y, ties.level), v_acceleration, theta_acceleration) <= 0.0
        ):
            return False
    return True


@kernel
def settle_friction(m, ties, y, x, contact, horizontal, vertical):
    """What friction dampers without velocity do from here on: hold where they can, else go where the others take them."""
    first = sticking(ties, NONE)
    if first == NONE:
        return
    second = sticking(ties, first)
    for way in WAYS:
        if second == NONE and way[1] != STICKS:
            continue
        ties.goes[first] = way[0]
        if second != NONE:
            ties.goes[second] = way[1]
        if _consistent(m, ties, y, x, contact, horizontal, vertical, first, second):
            return
    ties.goes[first] = STICKS  # what rounding leaves
    if second != NONE:
        ties.goes[second] = STICKS


@kernel
def start_elements(m, ties, y, x):
    """Modes and directions at rest."""
    for j in range(len(ties.elements)):
        ties.goes[j] = STICKS if ties.elements[j].kind == FRICTION and ties.elements[j].strength > 0.0 else OPENS
        ties.modes[j] = mode_of(ties.elements[j], gap(m, ties.elements[j], y, ties.level).elongation, x[j], OPENS)


@kernel
def _let_go(m, ties, y, x, contact, ground, h, work, j):
    """Friction damper ``j`` can no longer hold, and perhaps others with it: what they do a moment later is told by then.

    Now each of them still holds to rounding, and where two reach their force at one time neither can go alone.
    """
    near, later_x = SOON * h, work[1]
    k, _, one, two = all_rates(m, ties, y, x, contact, ground.horizontal, ground.vertical, work[0])
    holds = one if sticking(ties, NONE) == j else two
    for i in range(len(x)):
        later_x[i] = x[i] + near * work[0][i]
    there = later(ground, near)
    settle_friction(m, ties, along(y, k, near), later_x, contact, there.horizontal, there.vertical)
    if ties.goes[j] == STICKS:
        ties.goes[j] = OPENS if holds > 0.0 else CLOSES
        settle_friction(m, ties, y, x, contact, ground.horizontal, ground.vertical)


@kernel
def happen_to_element(m, ties, y, x, contact, ground, h, work, signal):
    """What the fall of an element's ``signal`` makes of it; whether a tendon has gone slack."""
    j, what = (signal - OF_ELEMENTS) // 3, (signal - OF_ELEMENTS) % 3
    of = ties.elements[j]
    if of.kind == TENDON:
        ties.modes[j] = TAUT if what == TURNS else change_tendon(of, ties.modes[j], what == GIVES)
        return ties.modes[j] == SLACK
    if of.kind == FRICTION and what == GIVES:
        _let_go(m, ties, y, x, contact, ground, h, work, j)
        return False
    if of.kind == FRICTION and of.strength > 0.0:
        ties.goes[j] = STICKS
    else:
        ties.goes[j] = -ties.goes[j]
    settle_friction(m, ties, y, x, contact, ground.horizontal, ground.vertical)
    return False


@kernel
def after_contact(m, ties, y, x, contact, rest, horizontal, vertical):
    """Directions and modes once an event at a pivot may have made all velocities jump."""
    for j in range(len(ties.elements)):
        speed = gap(m, ties.elements[j], y, ties.level).speed
        if abs(speed) <= rest:
            continue
        if ties.elements[j].kind != TENDON:
            ties.goes[j] = OPENS if speed > 0.0 else CLOSES
        elif ties.modes[j] == YIELDING and speed < 0.0:
            ties.modes[j] = TAUT
        elif (
            ties.modes[j] == TAUT
            and speed > 0.0
            and tension(ties.elements[j], gap(m, ties.elements[j], y, ties.level).elongation, x[j])
            >= ties.elements[j].strength
        ):
            ties.modes[j] = YIELDING
    settle_friction(m, ties, y, x, contact, horizontal, vertical)
