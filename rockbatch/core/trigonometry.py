"""Sine and cosine by arithmetic alone, which the compiler can vectorise (docs/pages/lanes.md).

A call of the machine's ``sin`` would keep a loop over lanes scalar.
"""

import math
from fractions import Fraction

from rockbatch.core.kernel import inlined
from rockbatch.core.polynomials import coefficients, polynomial

QUARTER = 0.25 * math.pi
HALF_PI = 0.5 * math.pi
HALF_PI_REST = 6.123233995736766e-17
"""π/2 beyond its first 53 bits."""


def _coefficients(first):
    """Return the coefficients of the polynomial that replaces Σ (−z)ᵏ/(2k + first)! for 0 ≤ z ≤ (π/4)²."""
    return coefficients([Fraction((-1) ** k, math.factorial(2 * k + first)) for k in range(16)], 0.0, QUARTER * QUARTER)


_SINE = _coefficients(3)  # (r − sin r)/r³, in r²
_COSINE = _coefficients(4)  # (cos r − 1 + r²/2)/r⁴


FLAT = 0.75
"""Angle [rad], just below π/4, up to which :func:`flat_sine_and_cosine` equals :func:`sine_and_cosine` bitwise."""


@inlined
def flat_sine_and_cosine(angle):
    """Return sine and cosine for |angle| ≤ FLAT = 0.75 rad, at half the cost of :func:`sine_and_cosine`."""
    z = angle * angle
    return angle - angle * z * polynomial(_SINE, z), 1.0 - (0.5 * z - z * z * polynomial(_COSINE, z))


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
    odd = r + (rest - r * z * polynomial(_SINE, z))
    even = 1.0 - (0.5 * z - (z * z * polynomial(_COSINE, z) - r * rest))
    sine, cosine = even if steep else odd, odd if steep else even
    return -sine if angle < 0.0 else sine, cosine
