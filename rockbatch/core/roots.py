"""Zero crossings and extrema inside a step, by the cubic Hermite polynomial through its ends."""

import math

from rockbatch.core.kernel import inlined, kernel

TRIALS = 60  # greatest number of trials; a few are usual
CLOSE = 1e-12  # tolerance on the time of an event, as a share of the step
NEAR = 1e-4  # distance of a trial from its event, as a share of the step, within which a cubic is as exact as another trial
SHOWN = 1e-12  # height of a hump before a dip, over the change in the step, that is more than rounding
BISECT_AFTER = 8  # trials after which every other one bisects

NO_ACCELERATION = 1e-12
"""Acceleration over g that is rounding in the balance of a pier at rest; it must not decide how a pivot moves."""


@inlined
def surely(velocity, acceleration, rest):
    """Return ``velocity``; if |velocity| ≤ ``rest``, hence rounding, ±``rest`` by the sign of ``acceleration``, or 0."""
    if abs(velocity) > rest:
        return velocity
    return rest if acceleration > 0.0 else (-rest if acceleration < 0.0 else 0.0)


@kernel
def hermite(f0, d0, f1, d1, h, x):
    """Return the value at ``x`` of the cubic with values f0, f1 and slopes d0, d1 at the ends of a step ``h``."""
    s = x / h
    difference = f1 - f0
    a = h * d0 - difference
    b = -h * d1 + difference
    return f0 + s * (difference + (1.0 - s) * ((1.0 - s) * a + s * b))


@kernel
def hermite_slope(f0, d0, f1, d1, h, x):
    """Return the slope at ``x`` of the cubic of :func:`hermite`."""
    s, mean = x / h, (f1 - f0) / h
    return d0 + s * (2.0 * (3.0 * mean - 2.0 * d0 - d1) + s * 3.0 * (d0 + d1 - 2.0 * mean))


@kernel
def turning_point(f0, d0, f1, d1, h):
    """Return the time in the step at which the Hermite cubic has an extremum; the slopes d0 and d1 differ in sign, or d0 = 0.

    The slope is a quadratic with values d0 and d1 at the ends, and has exactly one root between them. For d0 = 0 it is the other
    root, limited to the step.
    """
    mean = (f1 - f0) / h
    curve = 3.0 * (d0 + d1 - 2.0 * mean)  # slope(s) = d0 + 2 c s + curve s²
    c = 3.0 * mean - 2.0 * d0 - d1
    discriminant = max(c * c - curve * d0, 0.0)
    q = -(c + math.copysign(math.sqrt(discriminant), c))
    s = d0 / q if q != 0.0 else 0.5
    if d0 == 0.0 or not 0.0 <= s <= 1.0:  # not the extremum at the start itself
        s = q / curve if curve != 0.0 else 0.5
    return h * min(max(s, 0.0), 1.0)


@kernel
def _root(f0, d0, f1, d1, h, start, end):
    """Return the zero in [start, end] of the cubic, positive at ``start`` and not at ``end``, by Newton's method with bisection.

    It starts from the chord's zero if [start, end] is the whole step. The next change is about the square of the last one
    times half the curvature over the slope, which is the criterion of convergence.
    """
    difference = f1 - f0
    c1 = h * d0
    c3 = c1 + h * d1 - 2.0 * difference
    c2 = difference - c1 - c3
    low, high = start / h, end / h
    s = f0 / (f0 - f1) if low == 0.0 and high == 1.0 else 0.5 * (low + high)
    for _ in range(TRIALS):
        f = f0 + s * (c1 + s * (c2 + s * c3))
        if f > 0.0:
            low = s
        else:
            high = s
        slope = c1 + s * (2.0 * c2 + s * 3.0 * c3)
        s_next = s - f / slope
        newton = low <= s_next <= high
        if not newton:
            s_next = 0.5 * (low + high)
        change = abs(s_next - s)
        close = newton and change * change * abs(c2 + 3.0 * c3 * s) <= 0.01 * CLOSE * abs(slope)
        if change <= 0.01 * CLOSE or close:
            return h * s_next
        s = s_next
    return h * s


@inlined
def excess(d0, d1, h):
    """Return a bound on how far a Hermite cubic with end slopes d0 and d1 goes beyond its end values: |s (1 − s)²| ≤ 4/27."""
    return 4.0 / 27.0 * h * (abs(d0) + abs(d1))


@inlined
def inner_points(f0, d0, f1, d1, h):
    """Return the inner two of the four Bézier points of a Hermite cubic; the least and the greatest of the four bound it."""
    third = h * (1.0 / 3.0)
    return f0 + third * d0, f1 - third * d1


@kernel
def _extremes(f0, d0, f1, d1, h):
    """Return the times in (0, h) of the Hermite cubic's maximum and of its minimum; −1 for the one that is not there."""
    mean = (f1 - f0) / h
    curve = 3.0 * (d0 + d1 - 2.0 * mean)  # slope(s) = d0 + 2 c s + curve s²
    c = 3.0 * mean - 2.0 * d0 - d1
    discriminant = c * c - curve * d0
    if not discriminant > 0.0:
        return -1.0, -1.0
    q = -(c + math.copysign(math.sqrt(discriminant), c))
    first = d0 / q if q != 0.0 else -1.0
    second = q / curve if curve != 0.0 else -1.0
    highest, lowest = (first, second) if q > 0.0 else (second, first)
    return h * highest if 0.0 < highest < 1.0 else -1.0, h * lowest if 0.0 < lowest < 1.0 else -1.0


@inlined
def falls(f0, d0, f1, d1, h):
    """Return the time in [0, h] at which an event function falls through zero, by the cubic through both ends; −1 if never.

    A function that starts at or below zero, by rounding, falls at 0 if its slope is negative, or is 0 and the end negative. With
    a positive slope it has to rise first; if the cubic does not show that it did and the end is not above zero, h/2 is returned
    as a trial. A function that falls and rises again within the step has fallen.
    """
    early, late = inner_points(f0, d0, f1, d1, h)
    if f0 >= 0.0 and min(early, late, f1) > 0.0:
        return -1.0
    return _falls(f0, d0, f1, d1, h)


@kernel
def _falls(f0, d0, f1, d1, h):
    """Return the result of :func:`falls` for an event function that the Bézier points do not keep above zero."""
    if f0 > 0.0 and f1 <= 0.0:
        return _root(f0, d0, f1, d1, h, 0.0, h)
    if f0 > 0.0:
        _, lowest = _extremes(f0, d0, f1, d1, h)
        if lowest > 0.0 and hermite(f0, d0, f1, d1, h, lowest) <= 0.0:
            return _root(f0, d0, f1, d1, h, 0.0, lowest)
        return -1.0
    if d0 < 0.0 or (d0 == 0.0 and f1 < 0.0):
        return 0.0
    if d0 == 0.0:
        return -1.0
    highest, lowest = _extremes(f0, d0, f1, d1, h)
    hump = hermite(f0, d0, f1, d1, h, highest) if highest > 0.0 else 0.0
    if hump > SHOWN * (abs(f1) + h * abs(d1)):
        if lowest > highest and hermite(f0, d0, f1, d1, h, lowest) <= 0.0:
            return _root(f0, d0, f1, d1, h, highest, lowest)
        if f1 <= 0.0:
            return _root(f0, d0, f1, d1, h, highest, h)
    return 0.5 * h if f1 <= 0.0 else -1.0


@kernel
def largest_within(f0, d0, f1, d1, h, best):
    """Return the time of the greatest |f| after the start of a step, and |f|; −1 and ``best`` if it does not exceed ``best``.

    It is that of the end, or of an extremum of the cubic if the slopes differ in sign or d0 = 0.
    """
    x_best = -1.0
    if max(abs(f0), abs(f1)) + excess(d0, d1, h) <= best:  # no point of the cubic lies beyond this bound
        return x_best, best
    if d0 * d1 < 0.0 or (d0 == 0.0 and d1 != 0.0):
        x = turning_point(f0, d0, f1, d1, h)
        f = abs(hermite(f0, d0, f1, d1, h, x))
        if f > best:
            best, x_best = f, x
    if abs(f1) > best:
        best, x_best = abs(f1), h
    return x_best, best


@kernel
def steepest_within(f0, d0, f1, d1, h):
    """Return the |slope| of the Hermite cubic at its inflection; 0 if it has none inside the step."""
    if h == 0.0:
        return 0.0
    mean = (f1 - f0) / h
    curve, c = 3.0 * (d0 + d1 - 2.0 * mean), 3.0 * mean - 2.0 * d0 - d1  # slope(s) = d0 + 2 c s + curve s²
    s = -c / curve if curve != 0.0 else 0.0
    return abs(d0 + c * s) if 0.0 < s < 1.0 else 0.0


@kernel
def highest_within(f0, d0, f1, d1, h):
    """Return the greatest value of the Hermite cubic at both ends, and at a maximum inside if d0 > 0 > d1."""
    inside = hermite(f0, d0, f1, d1, h, turning_point(f0, d0, f1, d1, h)) if d0 > 0.0 > d1 else f1
    return max(f0, f1, inside)


@kernel
def summit_within(f0, d0, f1, d1, h, best):
    """Return the greater of ``best`` and the Hermite cubic's maximum in the step, and the time of that maximum [s].

    It may be one of a cubic that rises, falls and rises again. The time is 0 if ``best`` is the greater.
    """
    greatest = max(max(f0, f1), max(inner_points(f0, d0, f1, d1, h)))
    if greatest <= best:
        return best, 0.0
    if greatest == f1:
        return f1, h
    highest, _ = _extremes(f0, d0, f1, d1, h)
    inside = hermite(f0, d0, f1, d1, h, highest) if highest > 0.0 else f1
    summit, at = (inside, highest) if inside > f1 else (f1, h)
    return (summit, at) if summit > max(f0, best) else (max(f0, best), 0.0)


@kernel
def lowest_within(f0, d0, f1, d1, h, best):
    """Return the least of ``best``, the value at the end of the step, and a minimum inside if d0 < 0 < d1."""
    if d0 < 0.0 and d1 > 0.0 and min(inner_points(f0, d0, f1, d1, h)) < best:
        best = min(best, hermite(f0, d0, f1, d1, h, turning_point(f0, d0, f1, d1, h)))
    return min(best, f1)
