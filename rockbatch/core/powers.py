"""Powers by arithmetic alone, which the compiler can vectorise (docs/pages/lanes.md); a call of pow would keep a loop scalar."""

import math
from fractions import Fraction

import numpy as np

from rockbatch.core.kernel import inlined
from rockbatch.core.polynomials import TERMS, coefficients, polynomial

LARGEST_WHOLE = 10
"""Greatest whole exponent that is computed by products."""

# log₂ m = ℓ + ℓ s² L(s²) with s = (m − 1)/(m + 1), ℓ = 2 s/ln 2, for √½ ≤ m < √2; eᵘ = 1 + u E(u) for |u| ≤ ½ ln 2
_LN_2 = 0.6931471805599453
_LOGARITHM = coefficients([Fraction(1, 2 * k + 3) for k in range(12)], 0.0, (3.0 - 2.0 * math.sqrt(2.0)) ** 2)
_EXPONENTIAL = coefficients(
    [Fraction(1, math.factorial(k + 1)) for k in range(18)], -0.5 * _LN_2, 0.5 * _LN_2, 2 * TERMS
)
_LOW, _HIGH = _EXPONENTIAL[:TERMS], _EXPONENTIAL[TERMS:]

# A float has 52 bits of mantissa below its exponent, which is stored with 1023 added
_MANTISSA, _BIAS = np.uint64(52), np.uint64(1023)
_ONE = np.uint64(0x3FF0000000000000)
_FROM_ROOT = np.uint64(0x3FF0000000000000 - 0x3FE6A09E667F3BCD)  # bits of 1 less those of √½
_WHOLE = np.uint64(0x4330000000000000)  # bits of 2⁵²: or'ed to a small whole number they give 2⁵² more, as a float
_SHORT = np.uint64(2**64 - 2**12)  # mask of an exponent whose product with a whole number of 11 bits is exact
_ROUND = 1.5 * 2.0**52  # added, it leaves a whole number in the last bits


@inlined
def _bits(x):
    return np.float64(x).view(np.uint64)


@inlined
def _float(bits):
    return np.uint64(bits).view(np.float64)


@inlined
def _real_power(x, a):
    """Return xᵃ for a > 0 and x = 0 or 2⁻¹⁰²² ≤ x < ∞; 0 instead of powers below 2⁻¹⁰²², and inf of those above 2¹⁰²⁴."""
    bits = _bits(x)
    exponent = (bits + _FROM_ROOT) >> _MANTISSA
    m = _float(bits + _ONE - (exponent << _MANTISSA))
    whole = _float(exponent | _WHOLE) - (2.0**52 + 1023.0)
    s = (m - 1.0) / (m + 1.0)
    log = 2.0 / _LN_2 * s
    log += log * (s * s) * polynomial(_LOGARITHM, s * s)
    short = _float(_bits(a) & _SHORT)
    product, rest = short * whole, (a - short) * whole + a * log
    log = product + rest
    rounded = min(log, 1023.0) + _ROUND
    u = _LN_2 * ((product - (rounded - _ROUND)) + rest)
    cube = u * u * u
    root = 1.0 + u * (polynomial(_LOW, u) + cube * cube * polynomial(_HIGH, u))
    result = 0.0 if min(x, log + 1022.0) <= 0.0 else root * _float((_bits(rounded) + _BIAS) << _MANTISSA)
    return result + 0.0 * x  # NaN for NaN and inf, whose bits would make a number


@inlined
def power(x, n):
    """Return xⁿ for x ≥ 0; ``n`` None stands for 5, an int is at most LARGEST_WHOLE = 10, and a float greater than 0.

    Whole exponents are products of squares. The error with a float is at most 3 units in the last place for n ≤ 1, 8 for n ≤ 3,
    and 25 for n ≤ 10, if x is 0 or at least 2⁻¹⁰²²; of NaN and inf it is NaN.
    """
    if n is None:
        square = x * x
        return square * square * x
    if isinstance(n, int):
        square = x * x
        fourth = square * square
        low = (x if n & 1 else 1.0) * (square if n & 2 else 1.0)
        return low * ((fourth if n & 4 else 1.0) * (fourth * fourth if n & 8 else 1.0))
    return _real_power(x, n)
