"""Sine and cosine by arithmetic alone, which the compiler can vectorise (docs/pages/lanes.md).

A call of the machine's ``sin`` would keep a loop over lanes scalar.
"""

import math
from fractions import Fraction

from rockbatch.core.kernel import inlined

QUARTER = 0.25 * math.pi
HALF_PI = 0.5 * math.pi
HALF_PI_REST = 6.123233995736766e-17
"""π/2 beyond its first 53 bits."""


def _interpolated(series, nodes):
    """Return coefficients, lowest power first, of the polynomial through Σ series[k] zᵏ at ``nodes``, by Newton's differences.

    They are exact until they are rounded to floats.
    """
    differences = [sum(c * z**k for k, c in enumerate(series)) for z in nodes]
    for j in range(1, len(nodes)):
        for i in range(len(nodes) - 1, j - 1, -1):
            differences[i] = (differences[i] - differences[i - 1]) / (nodes[i] - nodes[i - j])
    coefficients = [Fraction(0)]
    for difference, node in zip(reversed(differences), reversed(nodes), strict=True):
        shifted = [Fraction(0), *coefficients]
        coefficients = [up - node * c for up, c in zip(shifted, [*coefficients, Fraction(0)], strict=True)]
        coefficients[0] += difference
    return tuple(map(float, coefficients[: len(nodes)]))


def _coefficients(first):
    """Return six coefficients, lowest power first, of a polynomial that approximates Σ (−z)ᵏ/(2k + first)! for 0 ≤ z ≤ (π/4)².

    It interpolates at Chebyshev nodes, which nearly minimise the error. The nodes are rounded to 20 bits, so that the
    coefficients are the same on every machine.
    """
    series = [Fraction((-1) ** k, math.factorial(2 * k + first)) for k in range(16)]
    middle = 0.5 * QUARTER * QUARTER
    nodes = [Fraction(round(2**20 * middle * (1.0 + math.cos((k + 0.5) * math.pi / 6.0))), 2**20) for k in range(6)]
    return _interpolated(series, nodes)


_SINE = _coefficients(3)  # (r − sin r)/r³, in r²
_COSINE = _coefficients(4)  # (cos r − 1 + r²/2)/r⁴


@inlined
def _polynomial(c, z):
    """Return Σ c[k] zᵏ of six coefficients in pairs, a dependency chain half as long as Horner's."""
    square = z * z
    return (c[0] + z * c[1]) + square * ((c[2] + z * c[3]) + square * (c[4] + z * c[5]))


FLAT = 0.75
"""Angle [rad], just below π/4, up to which :func:`flat_sine_and_cosine` equals :func:`sine_and_cosine` bitwise."""


@inlined
def flat_sine_and_cosine(angle):
    """Return sine and cosine for |angle| ≤ FLAT = 0.75 rad, at half the cost of :func:`sine_and_cosine`."""
    z = angle * angle
    return angle - angle * z * _polynomial(_SINE, z), 1.0 - (0.5 * z - z * z * _polynomial(_COSINE, z))


@inlined
def sine_and_cosine(angle):
    """Return sine and cosine of ``angle`` [rad], with an error of at most 1.02 units in the last place for |angle| ≤ 3π/4.

    For |angle| > π/4 the polynomials are evaluated at r = π/2 − |angle|, in two parts, and sine and cosine are exchanged.
    Sine is odd and cosine even to the bit. Beyond 3π/4, where no pier stands any more, the error grows to 3·10⁻¹⁰ at π and
    2·10⁻⁵ at 3π/2.
    """
    size = abs(angle)
    steep = size > QUARTER
    r = HALF_PI - size if steep else size  # exact, by Sterbenz's lemma
    rest = HALF_PI_REST if steep else 0.0
    z = r * r
    odd = r + (rest - r * z * _polynomial(_SINE, z))
    even = 1.0 - (0.5 * z - (z * z * _polynomial(_COSINE, z) - r * rest))
    sine, cosine = even if steep else odd, odd if steep else even
    return -sine if angle < 0.0 else sine, cosine
