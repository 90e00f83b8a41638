"""The law of one spring: ż = (v̇/δ_y)(1 − |z|ⁿ) while it yields, v̇/δ_y otherwise (paper, eqs. 8 and 9).

z = F/F_y is in [−1, 0]. Bouc–Wen is on the inelastic branch whenever it is being compressed; the elastic–perfectly
plastic spring only once z = −1, where the same expression gives ż = 0; the elastic spring never.
"""

import numpy as np

from rockbatch.core.kernel import inlined, kernel

LARGEST_WHOLE = 10
"""Exponents up to here that are whole numbers need no pow."""

# Gauss–Legendre: poles of the integrand lie on the unit circle at ±2π/n, which n = 5 keeps well away from [0, 1]
_NODES_5, _WEIGHTS_5 = (tuple(map(float, column)) for column in np.polynomial.legendre.leggauss(12))
_NODES, _WEIGHTS = (tuple(map(float, column)) for column in np.polynomial.legendre.leggauss(24))


@inlined
def power(x, n):
    """xⁿ for x ≥ 0, by the type of n: None is the paper's 5, a whole number up to 10 is a product of squares.

    Neither costs a call to pow, which would keep a loop over lanes from being turned into vector instructions.
    """
    if n is None:
        square = x * x
        return square * square * x
    if isinstance(n, int):
        square = x * x
        fourth = square * square
        low = (x if n & 1 else 1.0) * (square if n & 2 else 1.0)
        return low * ((fourth if n & 4 else 1.0) * (fourth * fourth if n & 8 else 1.0))
    return x**n


@inlined
def z_rate(z, velocity, yields, stiffness, exponent):
    """Rate of z [1/s] of a spring in contact, from its velocity [m/s] and 1/δ_y [1/m].

    A step too long for a hard landing may try z < −1: the law ends at −1 (see :func:`within_yield`), for beyond it
    would throw z back with all the more force and let a pressed spring separate.
    """
    rate = velocity * stiffness
    if yields != 0.0:
        rate *= 1.0 - power(min(max(-z, 0.0), 1.0), exponent)
    return rate


@inlined
def within_yield(z, yields):
    """z, no lower than −1 on the inelastic branch; a step that resolves the law never gets there."""
    return max(z, -1.0) if yields != 0.0 else z


@kernel
def _number(n):
    return 5.0 if n is None else n


@kernel
def static_deflection(force, exponent):
    """Deflection/δ_y of a Bouc–Wen spring first loaded to ``force``/F_y < 1: ∫ ds/(1 − sⁿ) from 0, by its series."""
    ratio = power(force, exponent)
    n = _number(exponent)
    term = force
    total = 0.0
    k = 0
    while term > 1e-17 * total:
        total += term / (1.0 + k * n)
        term *= ratio
        k += 1
    return total


@kernel
def _elastic_share(x, n):
    """(1 − x) xⁿ/(1 − xⁿ), smooth through x = 1, where it is 1/n."""
    xn = power(x, n)
    if n is None:
        square = x * x
        return xn / (1.0 + x + square + square * (x + square))
    if abs(1.0 - x) < 1e-9:
        return 1.0 / n
    return (1.0 - x) * xn / (1.0 - xn)


@kernel
def _integral(middle, half, n):
    """∫ of the elastic share over middle ± half, over ``half``."""
    total = 0.0
    if n is None:
        for i in range(len(_NODES_5)):
            total += _WEIGHTS_5[i] * _elastic_share(middle + half * _NODES_5[i], n)
        return total
    for i in range(len(_NODES)):
        total += _WEIGHTS[i] * _elastic_share(middle + half * _NODES[i], n)
    return total


@kernel
def plastic_work(z_from, z_to, plastic_deflection, yield_deflection, exponent):
    """Work/F_y [m] dissipated while a spring is compressed on its inelastic branch from ``z_from`` to ``z_to``.

    The law does not depend on the rate, so the work follows from the two ends: with x = |z| the plastic deflection
    grows by δ_y xⁿ/(1 − xⁿ) dx, and ∫ x du = Δu − δ_y ∫ (1 − x) xⁿ/(1 − xⁿ) dx, whose integrand is smooth. At
    z = −1 (elastic–perfectly plastic) the integral vanishes.
    """
    start, end = max(-z_from, 0.0), max(-z_to, 0.0)
    half = 0.5 * (end - start)
    middle = 0.5 * (end + start)
    return plastic_deflection - yield_deflection * half * _integral(middle, half, exponent)
