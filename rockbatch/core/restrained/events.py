"""What ends a smooth piece of a restrained block's motion, and where in a step: landing, turning, tendons slack or yielding."""

import math

from rockbatch.core.kernel import kernel
from rockbatch.core.restrained.elements import (
    CLOSES,
    OPENS,
    SLACK,
    STICKS,
    TAUT,
    TENDON,
    YIELDING,
    distance,
    draws,
    mode_of,
    tension,
)
from rockbatch.core.restrained.equations import acceleration, copy, friction_bound, rates, step
from rockbatch.core.roots import BISECT_AFTER, CLOSE, TRIALS, falls

LANDS = 0
TURNS = 1
OF_TENDONS = 2  # two of each element from here on: it goes slack or taut again; it yields

STILL = 1e-13
"""Of p² α: an angular acceleration that rounding makes."""


@kernel
def signals(elements, side, y, k, modes, goes, values, slopes):
    """What is positive while nothing happens, and its rates; ``k`` are those of ``y``."""
    values[LANDS], slopes[LANDS] = y[0], k[0]
    values[TURNS], slopes[TURNS] = goes * y[1], goes * k[1]
    for j in range(len(elements)):
        of, slack, limit = elements[j], OF_TENDONS + 2 * j, OF_TENDONS + 2 * j + 1
        values[slack], slopes[slack], values[limit], slopes[limit] = 1.0, 0.0, 1.0, 0.0
        if of.kind == TENDON and modes[j] != YIELDING:
            d = distance(of, side)
            pull = tension(of, 2.0 * d * math.sin(0.5 * y[0]), y[2 + j])
            rate = of.stiffness * d * math.cos(0.5 * y[0]) * y[1]
            sign = 1.0 if modes[j] == TAUT else -1.0
            values[slack], slopes[slack] = sign * pull, sign * rate
            if modes[j] == TAUT and of.strength < math.inf:
                values[limit], slopes[limit] = of.strength - pull, -rate


@kernel
def earliest(f_a, d_a, f_b, d_b, h):
    """Which signal falls through zero first within ``h`` [s], −1 for none; and when."""
    which, first = -1, h
    for i in range(len(f_a)):
        at = falls(f_a[i], d_a[i], f_b[i], d_b[i], h)
        if at >= 0.0 and (which < 0 or at < first):
            which, first = i, at
    return which, first


@kernel
def _tried(m, elements, inertia, side, y, modes, goes, ground, x, work, end, values, slopes):
    """A step over ``x`` [s] into ``end``, with its signals."""
    step(m, elements, inertia, side, y, modes, goes, ground, x, work, end)
    a, c = ground.horizontal + x * ground.horizontal_slope, ground.vertical + x * ground.vertical_slope
    rates(m, elements, inertia, side, end, modes, goes, a, c, work[5])
    signals(elements, side, end, work[5], modes, goes, values, slopes)


@kernel
def narrowed(marks, a, t, b):
    """The interval [a, b] in which the first event is, narrowed by a trial at ``t``, whose signals ``marks`` has last.

    ``marks``: values and slopes of the signals at a, at b, and at the trial. Returns a, b, which signal falls first, −1 for none,
    and when after a.
    """
    early, early_slopes, late, late_slopes, now, now_slopes = marks[0], marks[1], marks[2], marks[3], marks[4], marks[5]
    which, at = earliest(early, early_slopes, now, now_slopes, t - a)
    if which >= 0:
        copy(now, late)
        copy(now_slopes, late_slopes)
        return a, t, which, at
    copy(now, early)
    copy(now_slopes, early_slopes)
    which, at = earliest(early, early_slopes, late, late_slopes, b - t)
    return t, b, which, at


@kernel
def piece(m, elements, inertia, side, y, modes, goes, ground, h, work, marks, end):
    """From ``y`` over ``h`` [s] or to the first event before: the time that it took, and the signal that fell, −1 for none.

    ``marks``, shape (6, signals), keeps values and slopes of the signals at both ends of where the event is, and at the trial.
    """
    early, early_slopes, late, late_slopes, now, now_slopes = marks[0], marks[1], marks[2], marks[3], marks[4], marks[5]
    _tried(m, elements, inertia, side, y, modes, goes, ground, 0.0, work, end, early, early_slopes)
    if y[1] == 0.0:  # let go by an acceleration that is 0 but for rounding: it goes, and does not turn at once
        early_slopes[TURNS] = max(early_slopes[TURNS], STILL * m.p * m.p * m.alpha)
    _tried(m, elements, inertia, side, y, modes, goes, ground, h, work, end, late, late_slopes)
    a, b = 0.0, h
    which, at = earliest(early, early_slopes, late, late_slopes, h)
    if which < 0:
        return h, -1
    for trial in range(TRIALS):
        x = a + at if trial < BISECT_AFTER or trial % 2 == 0 else 0.5 * (a + b)
        _tried(m, elements, inertia, side, y, modes, goes, ground, x, work, end, now, now_slopes)
        a, b, which, at = narrowed(marks, a, x, b)
        if which < 0:
            break
        if abs(a + at - x) <= CLOSE * h:
            return x, which
    _tried(m, elements, inertia, side, y, modes, goes, ground, b, work, end, now, now_slopes)
    return b, which


@kernel
def direction(m, elements, inertia, side, y, modes, ground):
    """Whether a block without velocity opens, closes or sticks."""
    speed = y[1]
    y[1] = 0.0
    free = acceleration(m, elements, inertia, side, y, modes, STICKS, ground.horizontal, ground.vertical)
    y[1] = speed
    bound = friction_bound(elements, inertia, side, y[0])
    if abs(free) <= bound + STILL * m.p * m.p * m.alpha:
        return STICKS
    return OPENS if free > 0.0 else CLOSES


@kernel
def released(m, elements, inertia, side, y, modes, ground, h):
    """Time in [0, h] at which the ground overcomes the friction that holds the block, −1 if it does not; and where to.

    Exact but for a tendon or damper, which are at rest: the ground acceleration is linear in time.
    """
    free = acceleration(m, elements, inertia, side, y, modes, STICKS, ground.horizontal, ground.vertical)
    a, c = ground.horizontal + h * ground.horizontal_slope, ground.vertical + h * ground.vertical_slope
    change = acceleration(m, elements, inertia, side, y, modes, STICKS, a, c) - free
    bound = friction_bound(elements, inertia, side, y[0])
    first, goes = -1.0, STICKS
    for way in (OPENS, CLOSES):
        if way == CLOSES and y[0] == 0.0:
            continue
        excess = way * free - bound
        at = -1.0
        if excess > STILL * m.p * m.p * m.alpha:
            at = 0.0
        elif way * change > 0.0 and excess + way * change > 0.0:
            at = h * max(-excess / (way * change), 0.0)
        if at >= 0.0 and (first < 0.0 or at < first):
            first, goes = at, way
    return first, goes


@kernel
def set_modes(elements, side, y, modes, goes):
    """Modes of all tendons, for a block that goes on from ``y``."""
    for j in range(len(elements)):
        d, way = distance(elements[j], side), draws(elements[j], side, goes)
        modes[j] = mode_of(elements[j], 2.0 * d * math.sin(0.5 * y[0]), y[2 + j], way)


@kernel
def change_tendon(of, mode, limit):
    """Mode of a tendon whose first signal fell, or, with ``limit``, whose second did."""
    if limit:
        return YIELDING
    return SLACK if mode == TAUT else TAUT
