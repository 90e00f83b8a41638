"""Crossings and extrema inside a step: cubic Hermite to see them, regula falsi to locate them."""

import math

from rockbatch.core.kernel import kernel

TRIALS = 80  # regula falsi with Anderson and Björck's weight needs about six


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


@kernel
def secant(a, fa, b, fb):
    """Trial point between ``a`` and ``b``, whose values differ in sign."""
    return (a * fb - b * fa) / (fb - fa)


@kernel
def weight(f_new, f_old):
    """Anderson and Björck's factor on the value at the end that stays, after a trial on the other end's side."""
    m = 1.0 - f_new / f_old
    return m if m > 0.0 else 0.5


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
