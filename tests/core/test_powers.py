"""Powers with real exponents by polynomials: to the last bits, the same alone and in vector instructions."""

import math
import platform
import re
from decimal import Decimal, localcontext

import numba
import numpy as np
import pytest

from rockbatch.core.powers import power

NUMBERS = 16
TABLE = np.dtype([(name, "f8", NUMBERS) for name in ("x", "exponent", "power")])


@numba.njit(error_model="numpy", _nrt=False)
def side_by_side(table, count):
    for i in range(count):
        table.power[i] = power(table.x[i], table.exponent[i])


def numbers() -> list[float]:
    """From 10⁻³⁰⁰ to 10⁸, many close to 1 and to the limits of the mantissa, √½ 2ᵏ."""
    rng = np.random.default_rng(6)
    limits = [math.sqrt(0.5) * 2.0**k for k in (-30, -1, 0, 1, 9)]
    limits = [near for limit in limits for near in (math.nextafter(limit, 0.0), limit, math.nextafter(limit, 9e9))]
    spread = [*10.0 ** rng.uniform(-12.0, 3.0, 400), *10.0 ** rng.uniform(-300.0, 8.0, 100)]
    return [float(x) for x in (*spread, *(1.0 - 2.0 ** -rng.uniform(1.0, 53.0, 100)), *limits)]


def units_in_the_last_place(x: float, n: float) -> float:
    with localcontext() as context:
        context.prec = 50
        true = (Decimal(x).ln() * Decimal(n)).exp()
        return float(abs(Decimal(power(x, n)) - true) / Decimal(math.ulp(float(true))))


@pytest.mark.parametrize(("n", "most"), [(0.1, 3.0), (0.3, 3.0), (0.999999, 3.0), (1.5, 8.0), (2.9, 8.0), (9.9, 25.0)])
def test_powers_are_right_to_the_last_bits(n, most):
    """By Python's decimals of 50 digits."""
    normal = [x for x in numbers() if n * math.log2(x) > -1022.0]
    assert max(units_in_the_last_place(x, n) for x in normal) < most


@pytest.mark.parametrize("n", [0.05, 0.3, 1.5, 9.9])
def test_powers_of_0_and_1_are_exact_and_tiny_ones_are_0(n):
    """Of 0 with exponents below 1, too, by which 2⁻¹⁰²³, the exponent of the float 0, would not vanish."""
    assert (power(0.0, n), power(1.0, n)) == (0.0, 1.0)
    assert power(10.0 ** (-309.0 / max(n, 1.03)), max(n, 1.03)) == 0.0


@pytest.mark.parametrize(("x", "n"), [(2.1, 1000.0), (1e200, 1.9), (1e300, 9.9), (1e308, 1000.0)])
def test_powers_beyond_the_largest_float_are_infinite(x, n):
    """As in Python, where they are an error: a step far too long ends in no number instead of in any."""
    with pytest.raises(OverflowError):
        math.pow(x, n)
    assert power(x, n) == math.inf
    assert power(x**0.5, 1.99999) == pytest.approx(x**0.999995, rel=1e-12)


@pytest.mark.parametrize("n", [0.3, 2.5, 9.9])
def test_what_is_no_number_stays_none(n):
    """A run that has none fails; its bits would make a finite force."""
    table = lanes()
    table.x[:2], table.exponent[:] = (math.nan, math.inf), n
    side_by_side(table, NUMBERS)
    assert np.isnan(table.power).tolist() == [True, True, *[False] * (NUMBERS - 2)]
    assert math.isnan(power(math.nan, n))


def lanes() -> np.record:
    table, rng = np.zeros(1, TABLE).view(np.recarray)[0], np.random.default_rng(7)
    table.x[:], table.exponent[:] = 10.0 ** rng.uniform(-6.0, 1.0, NUMBERS), rng.uniform(0.1, 2.0, NUMBERS)
    table.x[3] = 0.0
    return table


@pytest.mark.parametrize("count", [NUMBERS, 7])
def test_side_by_side_they_have_the_bits_that_they_have_alone(count):
    table = lanes()
    side_by_side(table, count)
    alone = [power(float(x), float(n)) for x, n in zip(table.x[:count], table.exponent, strict=False)]
    assert list(table.power[:count]) == alone


@pytest.mark.skipif(platform.machine() not in ("x86_64", "AMD64"), reason="looks for the instructions of x86-64")
def test_side_by_side_they_are_vector_instructions():
    """Products of several numbers at once, of both polynomials and their arguments; none would be one call per number."""
    side_by_side(lanes(), NUMBERS)
    (code,) = side_by_side.inspect_asm().values()
    assert len(re.findall(r"\bv?mulpd\b", code)) >= 24
    assert not re.findall(r"\bcall\w*\b.*\bpow\b", code)
