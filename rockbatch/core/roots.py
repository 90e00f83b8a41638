"""Crossings and extrema inside a step: cubic Hermite to see them, regula falsi to locate them."""

import math
from typing import NamedTuple

from rockbatch.core.kernel import kernel

TRIALS = 80  # regula falsi needs about six
LEAST = 1e-12  # of a step: a signal that has not left its surface by then has not left it
CLOSE = 1e-14  # of a step: how far apart the last two trials may be

NEVER = 0
NOW = 1
WITHIN = 2
AFTER = 3
BEFORE = 4


@kernel
def hermite(f0, d0, f1, d1, h, x):
    """Cubic through values f0, f1 with slopes d0, d1 at the ends of a step ``h``, at ``x`` within it."""
    s = x / h
    difference = f1 - f0
    a = h * d0 - difference
    b = -h * d1 + difference
    return f0 + s * (difference + (1.0 - s) * ((1.0 - s) * a + s * b))


@kernel
def turning_point(f0, d0, f1, d1, h):
    """Where, within the step, the Hermite cubic turns, when the slopes d0 and d1 differ in sign.

    The slope is a quadratic with values d0 and d1 at the ends: exactly one root lies between.
    """
    mean = (f1 - f0) / h
    curve = 3.0 * (d0 + d1 - 2.0 * mean)  # slope(s) = d0 + 2 c s + curve s²
    c = 3.0 * mean - 2.0 * d0 - d1
    discriminant = max(c * c - curve * d0, 0.0)
    q = -(c + math.copysign(math.sqrt(discriminant), c))
    s = d0 / q if q != 0.0 else 0.5
    if not 0.0 <= s <= 1.0:
        s = q / curve if curve != 0.0 else 0.5
    return h * min(max(s, 0.0), 1.0)


class Bracket(NamedTuple):
    """Two times whose signals differ in sign; ``b`` is the latest trial."""

    a: float
    fa: float
    b: float
    fb: float


@kernel
def secant(bracket):
    """Trial time within the bracket."""
    return (bracket.a * bracket.fb - bracket.b * bracket.fa) / (bracket.fb - bracket.fa)


@kernel
def narrowed(bracket, x, fx):
    """Bracket after the trial ``x``: regula falsi with the weight of Anderson and Björck (1973)."""
    if fx * bracket.fb < 0.0:
        return Bracket(bracket.b, bracket.fb, x, fx)
    weight = 1.0 - fx / bracket.fb
    return Bracket(bracket.a, bracket.fa * (weight if weight > 0.0 else 0.5), x, fx)


@kernel
def outlook(f0, d0, f1, d1, h):
    """What values and slopes at the ends of a step say about a signal that was positive: a code and a time.

    NEVER: it does not fall through zero. NOW: it does at the very start. WITHIN: between start and end. AFTER: it
    starts on its own surface, which counts only once it has left it; that may be at the time given or, halving it,
    earlier. BEFORE: it is positive at both ends and may dip below zero at the time given.
    """
    if f0 <= 0.0:
        if d0 < 0.0 or (d0 == 0.0 and f1 < 0.0):
            return NOW, 0.0
        if d0 == 0.0 or f1 > 0.0:
            return NEVER, 0.0
        return AFTER, 0.5 * h
    if f1 <= 0.0:
        return WITHIN, h
    if d0 < 0.0 and d1 > 0.0:
        x = turning_point(f0, d0, f1, d1, h)
        if hermite(f0, d0, f1, d1, h, x) <= 0.0:
            return BEFORE, x
    return NEVER, 0.0


@kernel
def largest_within(f0, d0, f1, d1, h, best):
    """Greatest |f| so far, and where in this step it is attained; −1 if ``best`` stands."""
    x_best = -1.0
    if d0 * d1 < 0.0:
        x = turning_point(f0, d0, f1, d1, h)
        f = abs(hermite(f0, d0, f1, d1, h, x))
        if f > best:
            best, x_best = f, x
    if abs(f1) > best:
        best, x_best = abs(f1), h
    return x_best, best


@kernel
def lowest_within(f0, d0, f1, d1, h, best):
    """Least f so far, with the minimum inside this step if there is one."""
    if d0 < 0.0 and d1 > 0.0:
        best = min(best, hermite(f0, d0, f1, d1, h, turning_point(f0, d0, f1, d1, h)))
    return min(best, f1)
