"""Constitutive models of a spring: ż = (v̇/δ_y)(1 − |z|ⁿ) while it yields, v̇/δ_y otherwise (THEORY.md, eq. 7).

z = F/F_y is in [−1, 0]. Bouc–Wen is on the inelastic branch whenever it is being compressed, the elastic spring never. The
two others have a yield point, and are on it from there on until their velocity reverses: the elastic–perfectly plastic spring
from z = −1, where the same expression gives ż = 0, the hardening one from the least z that it has had. What distinguishes the
laws is here: their branches and the switching points between them, deflection and plastic work. ``yields`` is 1 on the
inelastic branch, 0 on the elastic one; ``point`` is the yield point.
"""

import numpy as np

from rockbatch.core.kernel import inlined, kernel
from rockbatch.core.powers import power
from rockbatch.core.springs.model import BOUC_WEN, ELASTIC, EPP, HARDENING

# Gauss–Legendre: poles of the integrand lie on the unit circle at ±2π/n, which n = 5 keeps well away from [0, 1]
_NEARBY = 0.1  # half of a way over which half of the nodes suffice: 19⁻¹² is left, the poles being 9.5 such halves away
_NODES_NEARBY, _WEIGHTS_NEARBY = (tuple(map(float, column)) for column in np.polynomial.legendre.leggauss(6))
_NODES_5, _WEIGHTS_5 = (tuple(map(float, column)) for column in np.polynomial.legendre.leggauss(12))
_NODES, _WEIGHTS = (tuple(map(float, column)) for column in np.polynomial.legendre.leggauss(24))


@inlined
def stiffness_loss(m, x):
    """Return the share of a spring's stiffness that is lost on the inelastic branch, at the force ``x`` = |z| from 0 to 1: xⁿ."""
    return power(x, m.exponent)


@inlined
def z_rate(m, z, velocity, yields):
    """Return the rate of z [1/s] of a spring in contact, from its velocity [m/s].

    A step too long for a hard landing may try z < −1: the law ends at −1 (see :func:`within_yield`), for beyond it
    would throw z back with all the more force and let a pressed spring separate.
    """
    rate = velocity * m.stiffness
    if yields != 0.0:
        rate *= 1.0 - stiffness_loss(m, min(max(-z, 0.0), 1.0))
    return rate


@inlined
def within_yield(z, yields):
    """Return z, no lower than −1 on the inelastic branch; a step that resolves the law never gets there."""
    return max(z, -1.0) if yields != 0.0 else z


@inlined
def branch_when_pressed(law):
    """Return the branch of a spring that is loaded from a state without velocity."""
    return 1.0 if law == BOUC_WEN else 0.0


@inlined
def curved(law):
    """Return whether the first loading follows Bouc–Wen's curve, on the inelastic branch from the start."""
    return law in (BOUC_WEN, HARDENING)


@inlined
def ratchets(law):
    """Return whether a spring sinks with every small cycle of its load, be it below any that it has borne."""
    return law == BOUC_WEN


@inlined
def kept_sign(law, on_spring, yields):
    """Return the sign that a spring's velocity keeps while it stays on its branch; 0 where the branch does not depend on it."""
    reloads = branch_when_pressed(law)
    return on_spring * (reloads - (reloads + 1.0) * yields)


@inlined
def may_yield(law, yields):
    """Return whether the spring leaves its branch at a yield point."""
    return law >= EPP and yields == 0.0


@inlined
def yield_point(law, point, z):
    """Return the yield point of a spring, so far at ``point``, whose velocity reverses at ``z`` on its inelastic branch."""
    return min(point, z) if law == HARDENING else -1.0


@inlined
def switching_point(law, side, z_rate, acceleration):
    """Return the event function of a switching point, positive while the spring of a Side stays on its branch, and its rate."""
    sign = kept_sign(law, 1.0, side.yields)
    if may_yield(law, side.yields):
        return side.z - side.point, z_rate
    return (1.0, 0.0) if sign == 0.0 else (sign * side.velocity, sign * acceleration)


@inlined
def after_switch(law, yields, point, z):
    """Return the other branch, and z, which is exactly the yield point where it is there that the branch changes."""
    return 1.0 - yields, point if may_yield(law, yields) else z


@inlined
def branch_after_jump(law, yields, point, z, velocity, rest):
    """Return the branch of a spring whose velocity has jumped to ``velocity`` [m/s], which counts as none up to ``rest``."""
    if law == ELASTIC or abs(velocity) <= rest:
        return yields
    if velocity > 0.0:
        return 0.0
    return 1.0 if law == BOUC_WEN or z <= point else yields


@inlined
def branch_of_landing(m, velocity):
    """Return the branch of a spring that a pivot meets at ``velocity`` [m/s]; a damped support may be met on its way up.

    It has been unloaded since it reached its yield point, if it has one.
    """
    return 0.0 if m.damped is not None and velocity > 0.0 else branch_when_pressed(m.law)


@kernel
def number(n):
    """Return the exponent as a number; None stands for 5."""
    return 5.0 if n is None else n


@kernel
def static_deflection(force, exponent):
    """Return the deflection/δ_y of a Bouc–Wen spring first loaded to ``force``/F_y < 1: ∫ ds/(1 − sⁿ) from 0, by its series."""
    ratio = power(force, exponent)
    n = number(exponent)
    term = force
    total = 0.0
    k = 0
    while term > 1e-17 * total:
        total += term / (1.0 + k * n)
        term *= ratio
        k += 1
    return total


@kernel
def deflection(m, force):
    """Return the deflection/δ_y of a spring of any law that is first loaded to ``force``/F_y < 1."""
    return static_deflection(force, m.exponent) if curved(m.law) else force


@kernel
def give(m, force, point):
    """Return δ_y/F_y times the rate of deflection with force, of a spring that is loaded with ``force``/F_y up to 1."""
    if not curved(m.law) or (m.law == HARDENING and force < -point):
        return 1.0
    return 1.0 / (1.0 - stiffness_loss(m, min(max(force, 0.0), 1.0 - 1e-12)))


@kernel
def _elastic_share(x, n):
    """Return (1 − x) xⁿ/(1 − xⁿ), smooth through x = 1, where it is 1/n."""
    xn = power(x, n)
    if n is None:
        square = x * x
        return xn / (1.0 + x + square + square * (x + square))
    if abs(1.0 - x) < 1e-9:
        return 1.0 / n
    return (1.0 - x) * xn / (1.0 - xn)


@kernel
def _integral(middle, half, n):
    """Integrate the elastic share over middle ± half; return the integral over ``half``."""
    total = 0.0
    if n is None and half <= _NEARBY:
        for i in range(len(_NODES_NEARBY)):
            total += _WEIGHTS_NEARBY[i] * _elastic_share(middle + half * _NODES_NEARBY[i], n)
        return total
    if n is None:
        for i in range(len(_NODES_5)):
            total += _WEIGHTS_5[i] * _elastic_share(middle + half * _NODES_5[i], n)
        return total
    for i in range(len(_NODES)):
        total += _WEIGHTS[i] * _elastic_share(middle + half * _NODES[i], n)
    return total


@kernel
def plastic_work(m, z_from, z_to, plastic_deflection):
    """Return the work/F_y [m] dissipated while a spring is compressed on its inelastic branch from ``z_from`` to ``z_to``.

    The law does not depend on the rate, so the work follows from the two ends: with x = |z| the plastic deflection
    grows by δ_y xⁿ/(1 − xⁿ) dx, and ∫ x du = Δu − δ_y ∫ (1 − x) xⁿ/(1 − xⁿ) dx, whose integrand is smooth. At
    z = −1 (elastic–perfectly plastic) the integral vanishes.
    """
    start, end = max(-z_from, 0.0), max(-z_to, 0.0)
    half = 0.5 * (end - start)
    middle = 0.5 * (end + start)
    return plastic_deflection - m.yield_deflection * half * _integral(middle, half, m.exponent)
