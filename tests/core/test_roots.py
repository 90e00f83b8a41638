"""Crossings and extremes of cubics within a step, against NumPy's roots of their polynomials."""

from itertools import pairwise

import numpy as np
import pytest
from numpy.polynomial import Polynomial

from rockbatch.core.roots import (
    _extremes,
    _root,
    excess,
    falls,
    highest_within,
    inner_points,
    steepest_within,
    surely,
    turning_point,
)

STEPS = (0.02, 1.0, 3.0)


def cubics(number, seed=1):
    """Random cubics of a step of 1, and each with what a step ``h`` has at its ends: values, and slopes."""
    rng = np.random.default_rng(seed)
    for _ in range(number):
        f = Polynomial.fromroots(rng.uniform(-0.5, 1.5, 3)) * rng.choice([-2.3, 0.7]) + rng.choice([0.0, 0.05])
        h, slope = rng.choice(STEPS), f.deriv()
        yield f, h, (f(0.0), slope(0.0) / h, f(1.0), slope(1.0) / h, h)


def inside(f):
    return sorted(root.real for root in f.roots() if abs(root.imag) < 1e-12 and 0.0 < root.real < 1.0)


@pytest.mark.parametrize(
    ("velocity", "acceleration", "sure"),
    [(0.3, -1.0, 0.3), (-0.3, 1.0, -0.3), (1e-13, -1.0, -1e-12), (-1e-13, 0.5, 1e-12), (0.0, 0.0, 0.0), (1e-13, 0.0, 0.0),
     (1e-12, -0.5, -1e-12), (0.0, 2.0, 1e-12), (0.0, -0.5, -1e-12)],
)  # fmt: skip
def test_a_velocity_that_is_rounding_goes_where_the_acceleration_does(velocity, acceleration, sure):
    assert surely(velocity, acceleration, 1e-12) == sure


def test_a_cubic_crosses_zero_between_two_points_of_other_signs_to_the_last_digits():
    found = 0
    for f, h, ends in cubics(400):
        marks = [0.0, *inside(f.deriv()), 1.0]
        for low, high in pairwise(marks):
            if f(low) > 0.0 > f(high):
                (exact,) = (root for root in inside(f) if low < root < high)
                if abs(f.deriv()(exact)) > 1e-2:
                    start, end = (exact + share * (mark - exact) for share, mark in ((0.9, low), (0.7, high)))
                    assert _root(*ends, h * start, h * end) == pytest.approx(h * exact, rel=1e-11, abs=1e-13 * h)
                    found += 1
    assert found > 100


def test_extremes_are_where_the_slope_is_zero():
    for f, h, ends in cubics(300, 2):
        turns = inside(f.deriv())
        tops, bottoms = ([h * t for t in turns if sign * f.deriv(2)(t) < 0.0] for sign in (1.0, -1.0))
        assert _extremes(*ends) == pytest.approx((*(tops or [-1.0]), *(bottoms or [-1.0])), rel=1e-9)
        if ends[1] * ends[3] < 0.0:
            assert turning_point(*ends) == pytest.approx(h * turns[0], rel=1e-9)
        top = max(f(0.0), f(1.0), *(f(t) for t in turns if f.deriv()(0.0) > 0.0 > f.deriv()(1.0)))
        assert highest_within(*ends) == pytest.approx(top, rel=1e-9, abs=1e-12)
        bends = inside(f.deriv(2))
        assert steepest_within(*ends) == pytest.approx(abs(f.deriv()(bends[0])) / h if bends else 0.0, rel=1e-9)
    assert steepest_within(1.0, 2.0, 3.0, 4.0, 0.0) == 0.0


def test_bounds_of_a_cubic_hold_all_of_it_and_touch_the_steepest():
    """|s (1 − s)²| is 4/27 at most, so that a slope d at one end goes 4/27 h d beyond; Bézier's hull holds it all."""
    at = np.linspace(0.0, 1.0, 1001)
    for f, h, ends in cubics(100, 3):
        f0, d0, f1, d1, _ = ends
        values, points = f(at), (f0, *inner_points(*ends), f1)
        assert min(points) - 1e-12 <= values.min() <= values.max() <= max(points) + 1e-12
        assert np.abs(values).max() <= max(abs(f0), abs(f1)) + excess(d0, d1, h) + 1e-12
    assert excess(3.0, 0.0, 0.5) == pytest.approx(highest_within(0.0, 3.0, 0.0, -1e-9, 0.5), rel=1e-3)
    assert inner_points(1.0, 3.0, 2.0, 6.0, 0.5) == pytest.approx((1.5, 1.0))


def test_a_signal_falls_at_its_first_crossing_from_above_wherever_it_starts():
    for f, h, ends in cubics(400, 4):
        first = [root for root in inside(f) if f.deriv()(root) < -1e-2]
        near = [abs(f.deriv()(root)) < 1e-2 for root in inside(f)]
        if ends[0] > 1e-3 and not any(near) and len(near) < 3:
            assert falls(*ends) == pytest.approx(h * first[0] if first else -1.0, rel=1e-9)
    for start, expected in (((0.0, -1.0, -1.0, -1.0), 0.0), ((-1e-15, -1.0, -1.0, -1.0), 0.0), ((0.0, 0.0, -1.0, -2.0), 0.0),
                            ((0.0, 0.0, 1.0, 2.0), -1.0), ((0.0, 1.0, 1.0, 1.0), -1.0)):  # fmt: skip
        assert falls(*start, 1.0) == expected
    hump = Polynomial.fromroots([0.0, 0.4, 3.0])  # it starts on its surface, leaves it and falls back
    ends = (0.0, hump.deriv()(0.0) / 0.02, hump(1.0), hump.deriv()(1.0) / 0.02, 0.02)
    assert falls(*ends) == pytest.approx(0.4 * 0.02, rel=1e-9)
    within = Polynomial.fromroots([0.0, 0.4, 0.8])
    ends = (0.0, within.deriv()(0.0), within(1.0), within.deriv()(1.0), 1.0)
    assert falls(*ends) == pytest.approx(0.4, rel=1e-9)
    assert falls(0.0, 1e-13, -1.0, -3.0, 1.0) == 0.5  # a hump that is rounding shows no time


def test_a_signal_that_falls_and_rises_again_within_a_step_has_fallen():
    """f = s (s − 0.3)(s − 0.6) leaves zero at the start, falls through it at 0.3 and is positive again at the end."""
    f = Polynomial.fromroots([0.0, 0.3, 0.6])
    d = f.deriv()
    assert falls(0.0, d(0.0), f(1.0), d(1.0), 1.0) == pytest.approx(0.3, abs=1e-12)
    above = Polynomial.fromroots([-0.05, 0.3, 0.6])
    slope = above.deriv()
    assert falls(above(0.0), slope(0.0), above(1.0), slope(1.0), 1.0) == pytest.approx(0.3, abs=1e-12)
    assert falls(1e-3, d(0.0), f(1.0) + 0.1, d(1.0), 1.0) == -1.0


def test_the_time_at_which_a_signal_falls_is_the_first_root_of_its_cubic():
    """Against NumPy's roots, of cubics with one or two in the step, many of them nearly flat beside it."""
    rng, counts = np.random.default_rng(1), [0, 0, 0]
    for flat in rng.choice([1e-6, 1e-3, 0.1, 1.0], 1500):
        at, more, h = rng.uniform(0.01, 0.99), rng.uniform(-1.0, 1.0), rng.uniform(1e-3, 1.0)
        pair = Polynomial([at * at + flat * more, -2.0 * at, 1.0])  # two roots near the third, or none
        f = Polynomial([-at + rng.normal() * rng.choice([0.0, 0.1]), 1.0]) * pair
        f, d = (-f, -f.deriv()) if f(0.0) < 0.0 else (f, f.deriv())
        roots = [root.real for root in f.roots() if abs(root.imag) < 1e-9 and 0.0 < root.real < 1.0]
        if len(roots) < 3 and (len(roots) < 2 or abs(roots[0] - roots[1]) > 1e-3):
            found = falls(f(0.0), d(0.0) / h, f(1.0), d(1.0) / h, h)
            assert found == pytest.approx(h * min(roots) if roots else -1.0, abs=1e-5 * h)
            counts[len(roots)] += 1
    assert min(counts) > 30
