"""Equations of a block that elements tie to the ground, in the frame of the corner about which it rocks.

The numbers of a run that are integrated, y: tilt q = |θ| [rad], its rate w, the state of each element, the energy that each has
taken and not given back [J/kg], and the work of the ground [J/kg].
"""

import math

from rockbatch.core.kernel import kernel
from rockbatch.core.restrained.elements import (
    FRICTION,
    HYSTERETIC,
    STICKS,
    VISCOUS,
    distance,
    draws,
    force,
    loss_rate,
    state_rate,
)

TRAVEL = 0.5
"""Of u_y: what a hysteretic damper may be drawn out by in one step of a sample's length, and less the more steps a sample has."""

GROWTH = 0.5
"""By which share of itself the speed of a viscous damper may grow or fall in a step: |ė|^a has no Taylor series at 0."""

NEAREST = 1e-3
"""Of a step: the shortest that this asks for, from a turning or to it."""

SLOWEST = 1e-12
"""Speed [m/s] below which the slope of such a damper's force grows no more."""

PLASTIC = 1e-14
"""How near to 1 the |z| of a hysteretic damper is 1: 1 − z decays by exp(−5 e/u_y) and would take steps of u_y for ever."""


@kernel
def pull_back(elements, inertia, side, y, modes, goes):
    """Angular deceleration [rad/s²] by all elements."""
    total = 0.0
    for j in range(len(elements)):
        d = distance(elements[j], side)
        half = math.cos(0.5 * y[0])
        elongation, speed = 2.0 * d * math.sin(0.5 * y[0]), d * half * y[1]
        way = draws(elements[j], side, goes)
        total += force(elements[j], elongation, speed, y[2 + j], modes[j], way) * d * half
    return total / inertia


@kernel
def friction_bound(elements, inertia, side, tilt):
    """Angular acceleration [rad/s²] that friction can hold."""
    total = 0.0
    for j in range(len(elements)):
        if elements[j].kind == FRICTION:
            total += elements[j].strength * abs(distance(elements[j], side)) * math.cos(0.5 * tilt)
    return total / inertia


@kernel
def driven(m, side, tilt, horizontal, vertical):
    """Acceleration of the tilt [rad/s²] by weight and ground (THEORY.md, eq. 14)."""
    lean = m.alpha - tilt
    return -m.p * m.p / m.gravity * ((m.gravity + vertical) * math.sin(lean) + side * horizontal * math.cos(lean))


@kernel
def acceleration(m, elements, inertia, side, y, modes, goes, horizontal, vertical):
    """Acceleration of the tilt [rad/s²]."""
    return driven(m, side, y[0], horizontal, vertical) - pull_back(elements, inertia, side, y, modes, goes)


@kernel
def rates(m, elements, inertia, side, y, modes, goes, horizontal, vertical, k):
    """Rates of ``y`` into ``k``."""
    n = len(elements)
    half = math.cos(0.5 * y[0])
    k[0] = y[1]
    k[1] = acceleration(m, elements, inertia, side, y, modes, goes, horizontal, vertical)
    for j in range(n):
        of = elements[j]
        d = distance(of, side)
        speed, way = d * half * y[1], draws(of, side, goes)
        pull = force(of, 2.0 * d * math.sin(0.5 * y[0]), speed, y[2 + j], modes[j], way)
        k[2 + j] = state_rate(of, speed, y[2 + j], modes[j], way)
        k[2 + n + j] = loss_rate(of, speed, pull, modes[j])
    push = driven(m, side, y[0], horizontal, vertical) - driven(m, side, y[0], 0.0, 0.0)
    k[2 + 2 * n] = inertia * push * y[1]


@kernel
def step(m, elements, inertia, side, y, modes, goes, ground, h, work, end):
    """One Runge–Kutta step of order 4 from ``y`` over ``h`` [s] into ``end``; ``work`` holds four rates and a stage.

    What sticks stays as it is.
    """
    if goes == STICKS:
        copy(y, end)
        return
    k1, k2, k3, k4, stage = work[0], work[1], work[2], work[3], work[4]
    half = 0.5 * h
    a, c = ground.horizontal, ground.vertical
    a_middle, c_middle = a + half * ground.horizontal_slope, c + half * ground.vertical_slope
    rates(m, elements, inertia, side, y, modes, goes, a, c, k1)
    _along(y, k1, half, stage)
    rates(m, elements, inertia, side, stage, modes, goes, a_middle, c_middle, k2)
    _along(y, k2, half, stage)
    rates(m, elements, inertia, side, stage, modes, goes, a_middle, c_middle, k3)
    _along(y, k3, h, stage)
    a_end, c_end = a + h * ground.horizontal_slope, c + h * ground.vertical_slope
    rates(m, elements, inertia, side, stage, modes, goes, a_end, c_end, k4)
    for i in range(len(y)):
        end[i] = y[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i])
    for j in range(len(elements)):
        if elements[j].kind == HYSTERETIC and abs(end[2 + j]) > 1.0 - PLASTIC:
            end[2 + j] = math.copysign(1.0, end[2 + j])


@kernel
def longest(m, elements, inertia, side, y, modes, goes, ground, h, dt):
    """The longest step [s], ``h`` at most, that resolves the laws of dampers: of a hysteretic one that is not plastic all along
    it, and of a viscous one with an exponent that is no whole number, near a turning.

    The shorter by one and the same factor for all ``h``, so that a run with half the step halves these steps too: what it
    changes goes on telling the error.
    """
    asked = False
    for j in range(len(elements)):
        loads = draws(elements[j], side, goes) * y[2 + j]
        asked = asked or (elements[j].kind == HYSTERETIC and loads < 1.0) or _is_root(elements[j])
    if not asked:
        return h
    turn = abs(acceleration(m, elements, inertia, side, y, modes, goes, ground.horizontal, ground.vertical))
    share = 1.0
    for j in range(len(elements)):
        of, loads = elements[j], draws(elements[j], side, goes) * y[2 + j]
        if of.kind == HYSTERETIC and loads < 1.0:
            way = abs(distance(of, side)) * (abs(y[1]) + turn * h) * dt * of.stiffness
            share = min(share, TRAVEL / way) if way > 0.0 else share
        if _is_root(of):
            d = abs(distance(of, side))
            slope = of.coefficient * of.exponent * max(d * abs(y[1]), SLOWEST) ** (of.exponent - 1.0) * d * d / inertia
            grown = GROWTH * abs(y[1]) / (turn * h) if turn > 0.0 else 0.0
            share = min(share, max(min(grown, GROWTH / (slope * dt) if slope > 0.0 else 1.0), NEAREST))
    return share * h


@kernel
def _is_root(of):
    """Whether the force is no smooth function of the speed where that is 0."""
    return of.kind == VISCOUS and of.exponent != math.floor(of.exponent)


@kernel
def copy(numbers, to):
    for i in range(len(numbers)):
        to[i] = numbers[i]


@kernel
def _along(y, k, h, out):
    for i in range(len(y)):
        out[i] = y[i] + h * k[i]
