"""Sine and cosine by polynomials: to the last bit, the same alone and in vector instructions."""

import math
import platform
import re
from decimal import Decimal, localcontext

import numba
import numpy as np
import pytest

from rockbatch.core.trigonometry import sine_and_cosine

ANGLES = 16
TABLE = np.dtype([(name, "f8", ANGLES) for name in ("angle", "sine", "cosine")])


@numba.njit(error_model="numpy", _nrt=False)
def side_by_side(table, count):
    for i in range(count):
        table.sine[i], table.cosine[i] = sine_and_cosine(table.angle[i])


def exact(angle: float) -> tuple[Decimal, Decimal]:
    """Sine and cosine of a double, by their series with 60 digits."""
    with localcontext() as context:
        context.prec = 60
        x = Decimal(angle)
        sums, term = [Decimal(0), Decimal(0)], Decimal(1)
        for k in range(64):
            sums[k % 2] += term * (-1) ** (k // 2)
            term *= x / (k + 1)
    return sums[1], sums[0]


def units_in_the_last_place(found: float, true: Decimal) -> float:
    return float(abs(Decimal(found) - true) / Decimal(math.ulp(float(true))))


def angles() -> list[float]:
    rng = np.random.default_rng(4)
    spread = [*rng.uniform(0.0, 0.75 * math.pi, 3000), *10.0 ** rng.uniform(-300.0, 0.0, 300)]
    corners = [0.0, 5e-324, 1e-8, 2.0**-27]
    for turns in (0.25, 0.5, 0.75):
        near = turns * math.pi
        for _ in range(4):
            corners.append(near)
            near = math.nextafter(near, 0.0)
        corners += [turns * math.pi - 10.0**-k for k in range(4, 16)]
    return [float(angle) for angle in spread + corners]


def test_sine_and_cosine_are_right_to_the_last_bit_up_to_three_quarters_of_pi():
    """The relative error too, of small angles and of the cosine next to the right angle."""
    worst = [0.0, 0.0]
    for angle in angles():
        for which, (found, true) in enumerate(zip(sine_and_cosine(angle), exact(angle), strict=True)):
            worst[which] = max(worst[which], units_in_the_last_place(found, true))
    assert max(worst) < 1.02
    assert sine_and_cosine(0.0) == (0.0, 1.0)


def test_sine_is_odd_and_cosine_even_to_the_bit():
    for angle in angles():
        sine, cosine = sine_and_cosine(angle)
        assert sine_and_cosine(-angle) == (-sine, cosine)


@pytest.mark.parametrize(("angle", "error"), [(2.5, 1e-13), (math.pi, 1e-9), (1.5 * math.pi, 1e-4)])
def test_beyond_three_quarters_of_pi_the_error_grows_as_documented(angle, error):
    found = sine_and_cosine(angle)
    apart = max(abs(found[0] - math.sin(angle)), abs(found[1] - math.cos(angle)))
    assert 0.01 * error < apart < error


def test_what_is_no_number_has_no_sine():
    assert all(map(math.isnan, sine_and_cosine(math.nan)))


def lanes() -> np.record:
    table = np.zeros(1, TABLE).view(np.recarray)[0]
    table.angle[:] = np.random.default_rng(5).uniform(-2.0, 2.0, ANGLES)
    return table


@pytest.mark.parametrize("count", [ANGLES, 7])
def test_side_by_side_they_have_the_bits_that_they_have_alone(count):
    table = lanes()
    side_by_side(table, count)
    for angle, *found in zip(table.angle[:count], table.sine, table.cosine, strict=False):
        assert tuple(found) == sine_and_cosine(angle)


@pytest.mark.skipif(platform.machine() not in ("x86_64", "AMD64"), reason="looks for the instructions of x86-64")
def test_side_by_side_they_are_vector_instructions():
    """Products of several numbers at once, as many as a polynomial of each takes; none would be one call per angle."""
    side_by_side(lanes(), ANGLES)
    (code,) = side_by_side.inspect_asm().values()
    assert len(re.findall(r"\bv?mulpd\b", code)) >= 12
    assert not re.findall(r"\bcall\w*\b.*\b(sin|cos)\b", code)
