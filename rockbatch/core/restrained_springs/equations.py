"""Equations of a pier on two springs that elements tie to the ground (THEORY.md, Dampers and tendons).

At one moment the elements are a force and a moment on the pier (``Pull``), and all that is known of a pier on springs holds
with them. What is integrated beside its State, x: the state of each element, the energy that each has taken and not given back
[J/kg], the work of the ground [J/kg], and what the elements' P–Δ moments have put in [J/kg].
"""

import math
from typing import NamedTuple

import numpy as np

from rockbatch.core.creep import share_left, with_creep
from rockbatch.core.equations import accelerations, along, geometry, pulled, rates
from rockbatch.core.kernel import kernel
from rockbatch.core.laws import within_yield
from rockbatch.core.restrained.elements import FRICTION, HYSTERETIC, STICKS, VISCOUS, force, loss_rate, state_rate
from rockbatch.core.restrained.equations import GROWTH, NEAREST, PLASTIC, TRAVEL
from rockbatch.core.trigonometry import sine_and_cosine
from rockbatch.core.types import State

NONE = -1

STAYS = 1e-9
"""Acceleration of a place by a unit force there, below which it does not move: a pivot that is held, to rounding."""


class Ties(NamedTuple):
    """The elements of a run, and what of them is constant between events."""

    elements: np.recarray  # of Element
    level: float  # v of the pier at rest [m]
    modes: np.ndarray  # of tendons: TAUT, SLACK or YIELDING
    goes: np.ndarray  # OPENS, CLOSES or, of friction, STICKS


class Gap(NamedTuple):
    """The place of an element on the base, as it rises from where it is at rest."""

    elongation: float  # [m]
    speed: float  # [m/s]
    arm: float  # of its force about the centre of mass [m]
    slope: float  # of the elongation with the rotation [m]
    bend: float  # and of that slope [m]


@kernel
def gap(m, of, y, level):
    """Gap of an element in state ``y``; at rest the pier is at v = ``level`` [m]."""
    s, h = of.offset, m.height
    if m.finite is not None:
        sine, cosine = sine_and_cosine(y.theta)
        arm = h * sine - s * cosine
        up = y.v - level - s * sine + h * sine * sine / (1.0 + cosine)
        return Gap(up, y.v_rate + arm * y.omega, arm, arm, s * sine + h * cosine)
    return Gap(y.v - level - s * y.theta, y.v_rate - s * y.omega, h * y.theta - s, -s, 0.0)


@kernel
def lifted(y, at, v_acceleration, theta_acceleration):
    """Acceleration [m/s²] of the place of an element, whose Gap is ``at``."""
    return v_acceleration + at.slope * theta_acceleration + at.bend * y.omega * y.omega


@kernel
def sticking(ties, after):
    """Number of the next friction damper behind ``after`` that does not move, NONE without one."""
    for j in range(after + 1, len(ties.elements)):
        if ties.elements[j].kind == FRICTION and ties.goes[j] == STICKS:
            return j
    return NONE


@kernel
def _held_by_friction(m, first, second, y, contact, horizontal, vertical):
    """Forces [m/s²] at two places, whose Gaps are given, by which they do not move; the second is 0 where both are one.

    ``m`` is the pier under all else. Accelerations are linear in the forces. At a pivot that is held friction bears nothing.
    """
    geometric = geometry(m, y.theta)
    free, free_other, own, other_by_own, by_other, own_other = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for unit in range(3):  # none, one at the first place, one at the second
        arm = first.arm if unit == 1 else (second.arm if unit == 2 else 0.0)
        under = pulled(m, m.pull.force + min(unit, 1), m.pull.moment + arm)
        v_acceleration, theta_acceleration = accelerations(under, y, contact, geometric, horizontal, vertical)
        here = lifted(y, first, v_acceleration, theta_acceleration)
        there = lifted(y, second, v_acceleration, theta_acceleration)
        if unit == 0:
            free, free_other = here, there
        elif unit == 1:
            own, other_by_own = here - free, there - free_other
        else:
            by_other, own_other = here - free, there - free_other
    if abs(own) <= STAYS:
        return 0.0, (0.0 if abs(own_other) <= STAYS else -free_other / own_other)
    if abs(own_other) <= STAYS or first.slope == second.slope:
        return -free / own, 0.0
    determinant = own * own_other - by_other * other_by_own
    return (by_other * free_other - own_other * free) / determinant, (
        other_by_own * free - own * free_other
    ) / determinant


@kernel
def under_elements(m, ties, y, x, contact, horizontal, vertical):
    """The pier ``m`` under all elements, and the forces [m/s²] of the first two friction dampers that do not move."""
    total, moment = 0.0, 0.0
    for j in range(len(ties.elements)):
        if ties.elements[j].kind == FRICTION and ties.goes[j] == STICKS:
            continue
        at = gap(m, ties.elements[j], y, ties.level)
        one = force(ties.elements[j], at.elongation, at.speed, x[j], ties.modes[j], ties.goes[j])
        total += one
        moment += one * at.arm
    first = sticking(ties, NONE)
    if first == NONE:
        return pulled(m, total, moment), 0.0, 0.0
    second = sticking(ties, first)
    here = gap(m, ties.elements[first], y, ties.level)
    there = gap(m, ties.elements[second], y, ties.level) if second != NONE else here
    one, two = _held_by_friction(pulled(m, total, moment), here, there, y, contact, horizontal, vertical)
    return pulled(m, total + one + two, moment + one * here.arm + two * there.arm), one, two


@kernel
def all_rates(m, ties, y, x, contact, horizontal, vertical, k):
    """Rates of the State ``y``, and of ``x`` into ``k``; then what :func:`under_elements` has."""
    n = len(ties.elements)
    under, one, two = under_elements(m, ties, y, x, contact, horizontal, vertical)
    for j in range(n):
        of = ties.elements[j]
        at = gap(m, of, y, ties.level)
        k[j], k[n + j] = 0.0, 0.0
        if of.kind == FRICTION and ties.goes[j] == STICKS:
            continue
        pull = force(of, at.elongation, at.speed, x[j], ties.modes[j], ties.goes[j])
        k[j] = state_rate(of, at.speed, x[j], ties.modes[j], ties.goes[j])
        k[n + j] = loss_rate(of, at.speed, pull, ties.modes[j])
    at = geometry(m, y.theta)
    lever = at.lever + (contact.right - contact.left) * at.swing
    k[2 * n] = -horizontal * lever * y.omega - vertical * y.v_rate
    k[2 * n + 1] = 0.0 if m.finite is not None else -m.height * y.theta * under.pull.force * y.omega
    return rates(under, y, contact, horizontal, vertical), under, one, two


@kernel
def _is_steep(of):
    """Whether the force's slope knows no bound where the speed is 0, but for what ``linear_below`` sets."""
    return of.kind == VISCOUS and of.exponent < 1.0


@kernel
def longest(m, ties, y, x, contact, ground, h, dt):
    """The longest step [s], ``h`` at most, that resolves dampers, as ``restrained.equations.longest`` has it."""
    share, asked = 1.0, False
    for j in range(len(ties.elements)):
        of = ties.elements[j]
        asked = asked or (of.kind == HYSTERETIC and ties.goes[j] * x[j] < 1.0) or _is_steep(of)
    if not asked:
        return h
    a, c = ground.horizontal, ground.vertical
    under, _, _ = under_elements(m, ties, y, x, contact, a, c)
    v_acceleration, theta_acceleration = accelerations(under, y, contact, geometry(m, y.theta), a, c)
    for j in range(len(ties.elements)):
        of = ties.elements[j]
        if of.kind == HYSTERETIC and ties.goes[j] * x[j] < 1.0:
            at = gap(m, of, y, ties.level)
            way = (abs(at.speed) + abs(lifted(y, at, v_acceleration, theta_acceleration)) * h) * dt * of.stiffness
            share = min(share, TRAVEL / way) if way > 0.0 else share
        if _is_steep(of):
            at = gap(m, of, y, ties.level)
            change = abs(lifted(y, at, v_acceleration, theta_acceleration)) * h
            speed = max(abs(at.speed), of.linear_below)
            share = min(share, max(GROWTH * speed / change, NEAREST)) if change > 0.0 else share
    return share * h


@kernel
def step(m, ties, y, x, contact, ground, h, work, end_x):
    """One Runge–Kutta step of order 4 over ``h`` [s]: the State, and ``x`` into ``end_x``. ``work``: rates and a stage."""
    kx, stage = work[0], work[1]
    middle = share_left(m, 0.5 * h)
    total, now = State(0.0, 0.0, 0.0, 0.0, 0.0, 0.0), y
    for i in range(len(x)):
        stage[i], end_x[i] = x[i], x[i]
    for part in range(4):
        t = 0.0 if part == 0 else (h if part == 3 else 0.5 * h)
        a, c = ground.horizontal + t * ground.horizontal_slope, ground.vertical + t * ground.vertical_slope
        k, _, _, _ = all_rates(m, ties, now, stage, contact, a, c, kx)
        weight = h / 6.0 if part in (0, 3) else h / 3.0
        total = along(total, k, weight)
        ahead = h if part == 2 else 0.5 * h
        now = with_creep(m, along(y, k, ahead), y, contact, middle * middle if part == 2 else middle)
        for i in range(len(x)):
            end_x[i] += weight * kx[i]
            stage[i] = x[i] + ahead * kx[i]
    for j in range(len(ties.elements)):
        if ties.elements[j].kind == HYSTERETIC and abs(end_x[j]) > 1.0 - PLASTIC:
            end_x[j] = math.copysign(1.0, end_x[j])
    end = along(y, total, 1.0)
    left, right = within_yield(end.z_left, contact.left_yields), within_yield(end.z_right, contact.right_yields)
    end = State(end.v, end.theta, end.v_rate, end.omega, left, right)
    return with_creep(m, end, y, contact, middle * middle)
