"""Constitutive models of a spring: ż = (v̇/δ_y)(1 − |z|ⁿ) while it yields, v̇/δ_y otherwise (THEORY.md, eq. 7).

z = F/F_y is in [−1, 0]. A Bouc–Wen spring is on the inelastic branch whenever it is being compressed, an elastic one never. The
other two have a yield point, and are on that branch from there until their velocity reverses: the elastic–perfectly plastic
spring from z = −1, where the same expression gives ż = 0, the hardening one from the least z so far. So does a spring with a
backbone, which may bear more than F_y, the force at its first corner; it has an inelastic branch beyond each corner. All
differences between the laws are in the table :data:`LAWS`, whose entries kernels use. ``yields`` is the number of the inelastic
branch, 1 but with a backbone, and 0 on the elastic one; ``point`` is the yield point.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from rockbatch.core.kernel import hook, inlined, kernel, optional_hook
from rockbatch.core.powers import power
from rockbatch.core.springs.backbone import Backbone, branch_at, loss_on

# Gauss–Legendre: poles of the integrand lie on the unit circle at ±2π/n, which n = 5 keeps well away from [0, 1]
_NEARBY = 0.1  # half width up to which half of the nodes suffice: with poles 9.5 half widths away the error is 19⁻¹²
_NODES_NEARBY, _WEIGHTS_NEARBY = (tuple(map(float, column)) for column in np.polynomial.legendre.leggauss(6))
_NODES_5, _WEIGHTS_5 = (tuple(map(float, column)) for column in np.polynomial.legendre.leggauss(12))
_NODES, _WEIGHTS = (tuple(map(float, column)) for column in np.polynomial.legendre.leggauss(24))


@inlined
def bouc_wen_loss(m, x):
    """Return xⁿ, the share of the stiffness that is lost on the inelastic branch at the force ``x`` = |z|, 0 to 1."""
    return power(x, m.exponent)


@kernel
def _elastic_share(x, n):
    """Return (1 − x) xⁿ/(1 − xⁿ), smooth through x = 1, where it is 1/n; n = None stands for 5."""
    xn = power(x, n)
    if n is None:
        square = x * x
        return xn / (1.0 + x + square + square * (x + square))
    if abs(1.0 - x) < 1e-9:
        return 1.0 / n
    return (1.0 - x) * xn / (1.0 - xn)


@kernel
def _elastic_share_integral(middle, half, n):
    """Return ∫ (1 − x) xⁿ/(1 − xⁿ) dx over middle ± half, divided by ``half``; n = None stands for 5."""
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
def bouc_wen_work(m, z_from, z_to, plastic_deflection):
    """Return the work/F_y [m] dissipated in compression on the inelastic branch from ``z_from`` to ``z_to``.

    The law does not depend on the rate, so the work follows from the two ends: with x = |z| the plastic deflection
    grows by δ_y xⁿ/(1 − xⁿ) dx, and ∫ x du = Δu − δ_y ∫ (1 − x) xⁿ/(1 − xⁿ) dx, whose integrand is smooth. At
    z = −1 (elastic–perfectly plastic) the integral vanishes.
    """
    start, end = max(-z_from, 0.0), max(-z_to, 0.0)
    half = 0.5 * (end - start)
    middle = 0.5 * (end + start)
    return plastic_deflection - m.yield_deflection * half * _elastic_share_integral(middle, half, m.exponent)


@inlined
def backbone_loss(m, x):
    """Return the share of the stiffness that is lost in first loading at the force ``x`` = |z|."""
    return loss_on(m.backbone, branch_at(m.backbone, x))


@kernel
def backbone_work(m, z_from, z_to, plastic_deflection):
    """Return the work/F_y [m] dissipated on one branch: force and plastic deflection grow in proportion."""
    return -0.5 * (z_from + z_to) * plastic_deflection


class Law(NamedTuple):
    """A law of springs. No field has a default, so that a law without an entry fails on import.

    Numbers are 0 or 1. Functions take the pier ``m`` first, whose law has been chosen by its code.
    """

    limited: float  # its force is at most F_y, or the greatest of its backbone
    yields_at_first: float  # first loading is on the inelastic branch from the start
    yields_when_pressed: float  # any compression is on the inelastic branch
    has_point: float  # the elastic branch ends at a yield point
    remembers: float  # the yield point is the least z at which the spring was unloaded; else −1
    stiffness_loss: Callable  # (m, x): share of the stiffness lost on the inelastic branch, at the force x = |z|
    plastic_work: (
        Callable  # (m, z_from, z_to, plastic_deflection): work/F_y [m] dissipated from z to z on the inelastic branch
    )


LAWS = {
    "elastic": Law(
        limited=0.0,
        yields_at_first=0.0,
        yields_when_pressed=0.0,
        has_point=0.0,
        remembers=0.0,
        stiffness_loss=bouc_wen_loss,
        plastic_work=bouc_wen_work,
    ),
    "bouc-wen": Law(
        limited=1.0,
        yields_at_first=1.0,
        yields_when_pressed=1.0,
        has_point=0.0,
        remembers=0.0,
        stiffness_loss=bouc_wen_loss,
        plastic_work=bouc_wen_work,
    ),
    "epp": Law(
        limited=1.0,
        yields_at_first=0.0,
        yields_when_pressed=0.0,
        has_point=1.0,
        remembers=0.0,
        stiffness_loss=bouc_wen_loss,
        plastic_work=bouc_wen_work,
    ),
    "hardening": Law(
        limited=1.0,
        yields_at_first=1.0,
        yields_when_pressed=0.0,
        has_point=1.0,
        remembers=1.0,
        stiffness_loss=bouc_wen_loss,
        plastic_work=bouc_wen_work,
    ),
    "backbone": Law(
        limited=1.0,
        yields_at_first=0.0,
        yields_when_pressed=0.0,
        has_point=1.0,
        remembers=1.0,
        stiffness_loss=backbone_loss,
        plastic_work=backbone_work,
    ),
}
"""All laws by their names in studies, and the law of springs that do not yield."""

CODES = {name: float(code) for code, name in enumerate(LAWS)}
"""Codes of the laws in a pier's model."""

BY_TYPE = "backbone"
"""The law of piers with a Backbone, by which type its functions are chosen: the vector loops of others know nothing of them."""


def _flag(codes):
    """Return a kernel that returns 1 for a law with one of ``codes``, else 0."""
    if not codes:
        return _never
    code, others = codes[0], _flag(codes[1:])

    @inlined
    def flag(law):
        return 1.0 if law == code else others(law)

    return flag


@inlined
def _never(law):
    return 0.0


def _flag_of(name):
    """Return a kernel that returns the entry ``name``, 0 or 1, of a law by its code."""
    return _flag([CODES[law] for law, entries in LAWS.items() if getattr(entries, name) != 0.0])


def _choice(functions):
    """Return a kernel that calls the function of the pier's law, from pairs of code and function.

    A function that all laws share is returned itself, so that nothing is added to the vector loops that call it.
    """
    (code, function), *others = functions
    if all(other is function for _, other in others):
        return function
    of_others = _choice(others)

    @inlined
    def chosen(m, *rest):
        return function(m, *rest) if m.law == code else of_others(m, *rest)

    return chosen


def _function_of(name):
    """Return a kernel that calls the entry ``name`` of the law of a pier without a backbone."""
    functions = [(CODES[law], getattr(entries, name)) for law, entries in LAWS.items() if law != BY_TYPE]
    return _choice(functions[::-1])


limited, has_point = _flag_of("limited"), _flag_of("has_point")
yields_at_first, yields_when_pressed = _flag_of("yields_at_first"), _flag_of("yields_when_pressed")
remembers = _flag_of("remembers")
stiffness_loss, _work_by_law = _function_of("stiffness_loss"), _function_of("plastic_work")


@hook
def _loss(backbone, m, z, yields):
    """Return the share of the stiffness that a spring has lost at z on an inelastic branch."""


@_loss.of(type(None))
def _loss_by_law(backbone, m, z, yields):
    return stiffness_loss(m, min(max(-z, 0.0), 1.0))


@_loss.of(Backbone)
def _loss_on_backbone(backbone, m, z, yields):
    return loss_on(backbone, yields)


@hook
def _work(backbone, m, z_from, z_to, plastic_deflection):
    """Return the work/F_y [m] dissipated on the inelastic branch from ``z_from`` to ``z_to``."""


@_work.of(type(None))
def _work_without_backbone(backbone, m, z_from, z_to, plastic_deflection):
    return _work_by_law(m, z_from, z_to, plastic_deflection)


@_work.of(Backbone)
def _work_on_backbone(backbone, m, z_from, z_to, plastic_deflection):
    return backbone_work(m, z_from, z_to, plastic_deflection)


@kernel
def plastic_work(m, z_from, z_to, plastic_deflection):
    """Return the work/F_y [m] dissipated in compression on an inelastic branch from ``z_from`` to ``z_to``."""
    return _work(m.backbone, m, z_from, z_to, plastic_deflection)


@inlined
def z_rate(m, z, velocity, yields):
    """Return the rate of z [1/s] of a spring in contact, from its velocity [m/s].

    A step too long for a hard landing may try z < −1: without a backbone the force is limited to −1 (see :func:`within_yield`),
    since beyond it the law would throw z back and let a compressed spring separate.
    """
    rate = velocity * m.stiffness
    if yields != 0.0:
        rate *= 1.0 - _loss(m.backbone, m, z, yields)
    return rate


@optional_hook
def within_yield(backbone, z, yields):
    """Return z, without a ``backbone`` at least −1 on the inelastic branch, which a step that resolves the law never passes."""
    return max(z, -1.0) if yields != 0.0 else z


@within_yield.of(Backbone)
def _any_z(backbone, z, yields):
    return z


@inlined
def kept_sign(law, on_spring, yields):
    """Return the sign of a spring's velocity on its branch; 0 if the branch does not depend on it, or without contact.

    On the later branches of a backbone it is −2, −3, …, a number with that sign.
    """
    reloads = yields_when_pressed(law)
    return on_spring * (reloads - (reloads + 1.0) * yields)


@inlined
def may_yield(law, yields):
    """Return True if the spring leaves its branch at a yield point."""
    return has_point(law) != 0.0 and yields == 0.0


@inlined
def first_point(law):
    """Return the yield point of a spring that has borne nothing."""
    return yields_at_first(law) - 1.0


@inlined
def yield_point(law, point, z):
    """Return the yield point after a velocity reversal at ``z`` on the inelastic branch; it was at ``point`` before.

    It is the lesser of both if the law remembers, else −1.
    """
    return min(point, z) if remembers(law) != 0.0 else -1.0


@inlined
def branch_at_first(m, z):
    """Return the branch of a spring in first loading to ``z``."""
    if has_point(m.law) != 0.0 and z <= first_point(m.law):
        return branch_at(m.backbone, -z)
    return yields_at_first(m.law)


@inlined
def switching_point(law, side, z_rate, acceleration):
    """Return the event function of a Side's change of branch, positive before it, and its rate; 1 and 0 if it never changes."""
    sign = kept_sign(law, 1.0, side.yields)
    if may_yield(law, side.yields):
        return side.z - side.point, z_rate
    return (1.0, 0.0) if sign == 0.0 else (sign * side.velocity, sign * acceleration)


@inlined
def after_switch(m, yields, point, z):
    """Return the branch after a change, and z, set exactly to the yield point if the spring yields there."""
    if may_yield(m.law, yields):
        return branch_at(m.backbone, -point), point
    return 1.0 - min(yields, 1.0), z


@inlined
def branch_after_jump(m, yields, point, z, velocity):
    """Return the branch of a spring after a jump to ``velocity`` [m/s]; unchanged if that counts as zero.

    Upwards the elastic one (0); downwards an inelastic one by a law without elastic compression or from the yield point on, else
    unchanged.
    """
    if abs(velocity) <= m.rest:
        return yields
    if velocity > 0.0:
        return 0.0
    if has_point(m.law) != 0.0 and z <= point:
        return branch_at(m.backbone, -z)
    return 1.0 if yields_when_pressed(m.law) != 0.0 else yields


@inlined
def branch_of_landing(m, velocity):
    """Return the branch (0 elastic, 1 inelastic) of a spring on which a pivot lands at ``velocity`` [m/s].

    Elastic if upwards, as a damped support rises, and for a spring with a yield point, which has been unloaded since; else that
    of the law when pressed.
    """
    return 0.0 if m.damped is not None and velocity > 0.0 else yields_when_pressed(m.law)


@hook
def _compliance(backbone, m, force):
    """Return the tangent compliance over the elastic one of a spring in first loading to a ``force``/F_y."""


@_compliance.of(type(None))
def _compliance_by_law(backbone, m, force):
    return 1.0 / (1.0 - stiffness_loss(m, min(max(force, 0.0), 1.0 - 1e-12)))


@_compliance.of(Backbone)
def _compliance_of_backbone(backbone, m, force):
    return 1.0 / max(1.0 - backbone_loss(m, force), 1e-12)


@kernel
def give(m, force, point):
    """Return the tangent compliance over the elastic one of a spring in loading, at least 1; ``force`` ≥ 0 is over F_y.

    1 for elastic springs, and up to the yield ``point`` of laws that have one.
    """
    if yields_when_pressed(m.law) == 0.0 and (has_point(m.law) == 0.0 or force < -point):
        return 1.0
    return _compliance(m.backbone, m, force)
