"""Polynomials of degree 5 that replace power series, in arithmetic that the compiler can vectorise (docs/pages/lanes.md)."""

import math
from fractions import Fraction

from rockbatch.core.kernel import inlined

TERMS = 6


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


def coefficients(series, low, high, terms=TERMS):
    """Return the coefficients, lowest power first, of a polynomial that approximates Σ series[k] zᵏ for ``low`` ≤ z ≤ ``high``.

    It interpolates at Chebyshev nodes, which nearly minimise the error. The nodes are rounded to 20 bits, so that the
    coefficients are the same on every machine.
    """
    middle, half = 0.5 * (low + high), 0.5 * (high - low)
    angles = [(k + 0.5) * math.pi / terms for k in range(terms)]
    return _interpolated(series, [Fraction(round(2**20 * (middle + half * math.cos(a))), 2**20) for a in angles])


@inlined
def polynomial(c, z):
    """Return Σ c[k] zᵏ of six coefficients in pairs, a dependency chain half as long as Horner's."""
    square = z * z
    return (c[0] + z * c[1]) + square * ((c[2] + z * c[3]) + square * (c[4] + z * c[5]))
