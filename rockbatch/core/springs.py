"""The law of one spring: ż = (v̇/δ_y)(1 − |z|ⁿ) while it yields, v̇/δ_y otherwise (paper, eqs. 8 and 9).

z = F/F_y is in [−1, 0]. Bouc–Wen is on the inelastic branch whenever it is being compressed; the elastic–perfectly
plastic spring only once z = −1, where the same expression gives ż = 0; the elastic spring never.
"""

import numpy as np

from rockbatch.core.kernel import kernel

_NODES, _WEIGHTS = (tuple(float(x) for x in column) for column in np.polynomial.legendre.leggauss(24))


@kernel
def power(x, n):
    """xⁿ for x ≥ 0; the paper's n = 5 without a call to pow."""
    if n == 5.0:
        square = x * x
        return square * square * x
    return x**n


@kernel
def z_rate(z, velocity, yields, yield_deflection, exponent):
    """Rate of z [1/s] of a spring in contact, from its velocity [m/s].

    A step too long for a hard landing may try z < −1: the law ends at −1 (see :func:`within_yield`), for beyond it
    would throw z back with all the more force and let a pressed spring separate.
    """
    rate = velocity / yield_deflection
    if yields != 0.0:
        rate *= 1.0 - power(min(max(-z, 0.0), 1.0), exponent)
    return rate


@kernel
def within_yield(z, yields):
    """z, no lower than −1 on the inelastic branch; a step that resolves the law never gets there."""
    return max(z, -1.0) if yields != 0.0 else z


@kernel
def static_deflection(force, exponent):
    """Deflection/δ_y of a Bouc–Wen spring first loaded to ``force``/F_y < 1: ∫ ds/(1 − sⁿ) from 0, by its series."""
    ratio = force**exponent
    term = force
    total = 0.0
    k = 0
    while term > 1e-17 * total:
        total += term / (1.0 + k * exponent)
        term *= ratio
        k += 1
    return total


@kernel
def _elastic_share(x, n):
    """(1 − x) xⁿ/(1 − xⁿ), smooth through x = 1, where it is 1/n."""
    if abs(1.0 - x) < 1e-9:
        return 1.0 / n
    return (1.0 - x) * x**n / (1.0 - x**n)


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
    integral = 0.0
    for i in range(len(_NODES)):
        integral += _WEIGHTS[i] * _elastic_share(middle + half * _NODES[i], exponent)
    return plastic_deflection - yield_deflection * half * integral
