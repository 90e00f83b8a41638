"""Events of devices: an elongation turns, a friction damper lets go, a tendon goes slack or taut, or yields, a stop is met.

Behind the event functions of the pier there are three of each device: it turns, it goes slack or taut again, it yields or
lets go. A stop turns while it is pressed in for the first time, is met or left, and passes the point up to which it was
pressed in before or, left, recovers.
"""

import math
from typing import NamedTuple

import numpy as np

from rockbatch.core.devices.elongation import attitude, gap, gap_of, lifted
from rockbatch.core.devices.laws import (
    CLOSES,
    CONTACT,
    FRICTION,
    MAXWELL,
    OPENS,
    SLACK,
    STICKS,
    TAUT,
    TENDON,
    YIELDING,
    mode_of,
    past_release,
    response,
    tension,
)
from rockbatch.core.devices.pull import BESIDE, START, device_rates, sticking, under_devices, way_of_opening
from rockbatch.core.ground import later
from rockbatch.core.kernel import inlined, kernel
from rockbatch.core.roots import NO_ACCELERATION, surely
from rockbatch.core.system import rates
from rockbatch.core.table import along
from rockbatch.core.types import LAW_LEFT, NO_EVENT, OF_PIER, Moment

TURNS, SLACKENS, GIVES = 0, 1, 2  # behind the first of a device's
PER_DEVICE = 3

NEARBY = 1e-6
"""Of a step: over which the rate of a friction damper's force is taken."""

SOON = 1e-3
"""Of a step: how long after friction has let go it is looked at what goes where."""

SURE = 1e-9
"""Of a friction damper's strength: by how much rounding lets it hold more."""

WAYS = (
    (STICKS, STICKS), (OPENS, STICKS), (CLOSES, STICKS), (STICKS, OPENS), (STICKS, CLOSES),
    (OPENS, OPENS), (OPENS, CLOSES), (CLOSES, OPENS), (CLOSES, CLOSES),
)  # fmt: skip
"""Directions that two friction dampers without velocity can take."""


class EventFunctions(NamedTuple):
    """Values and slopes of all event functions."""

    values: np.ndarray
    slopes: np.ndarray


class Motion(NamedTuple):
    """Motion of a device, and its state."""

    gap: np.record  # of Gap
    acceleration: float  # of its elongation [m/s²]
    state: float


class Rounding(NamedTuple):
    """Speed [m/s] and length [m] that are no more than rounding."""

    speed: float
    length: float


@inlined
def _crossing(value, slope, speed, rounding):
    """Return an event function of an elongation, and its slope: one that has just changed, or hangs on zero, is above it."""
    rest, length = rounding
    if abs(value) > length:
        return value, slope
    return (length, slope if abs(speed) > rest else 0.0) if slope > 0.0 or abs(speed) <= rest else (value, slope)


@kernel
def _of_stop(devices, j, motion, rounding, functions):
    """Write the three event functions of stop ``j``, and their slopes."""
    of, mode, at, acceleration, deepest = (
        devices.elements[j],
        devices.modes[j],
        motion.gap,
        motion.acceleration,
        motion.state,
    )
    values, slopes, rest = functions.values, functions.slopes, rounding.speed
    turns = OF_PIER + PER_DEVICE * j + TURNS
    slackens, gives = turns + SLACKENS, turns + GIVES
    rate, past = surely(at.speed, acceleration, rest), past_release(of, at.elongation, deepest)
    if mode == YIELDING:
        starts = abs(at.speed) <= rest and acceleration >= 0.0
        values[turns], slopes[turns] = rest if starts else at.speed, acceleration
    elif mode == TAUT:
        depth = at.elongation - of.start
        values[slackens], slopes[slackens] = _crossing(past, rate, at.speed, rounding)
        values[gives], slopes[gives] = _crossing(deepest - depth, -rate, at.speed, rounding)
    else:
        values[slackens], slopes[slackens] = _crossing(-past, -rate, at.speed, rounding)
        if deepest > 0.0:
            values[gives], slopes[gives] = _crossing(at.elongation - of.start, rate, at.speed, rounding)


@kernel
def _of_device(devices, j, motion, rounding, functions):
    """Write the three event functions of device ``j``, and their slopes, but for a friction damper that does not move."""
    of, mode, goes, at, state = devices.elements[j], devices.modes[j], devices.goes[j], motion.gap, motion.state
    values, slopes, acceleration, rest = functions.values, functions.slopes, motion.acceleration, rounding.speed
    turns = OF_PIER + PER_DEVICE * j + TURNS
    slackens, gives = turns + SLACKENS, turns + GIVES
    values[turns] = values[slackens] = values[gives] = 1.0
    slopes[turns] = slopes[slackens] = slopes[gives] = 0.0
    if of.linear_below == math.inf or (of.kind == FRICTION and goes == STICKS):
        return
    if of.kind == CONTACT:
        _of_stop(devices, j, motion, rounding, functions)
        return
    if of.kind == MAXWELL:
        rate = goes * response(of, at.elongation, at.speed, state, TAUT, goes).state_rate
        values[turns], slopes[turns] = goes * state, rate
        if abs(state) <= of.stiffness * rounding.length and rate >= 0.0:
            values[turns] = of.stiffness * rounding.length
        return
    if of.kind != TENDON or mode == YIELDING:
        way = OPENS if of.kind == TENDON else goes
        starts = abs(at.speed) <= rest and way * acceleration >= 0.0  # it has just turned, or is let go, to rounding
        values[turns], slopes[turns] = rest if starts else way * at.speed, way * acceleration
        return
    pull, rate = tension(of, at.elongation, state), of.stiffness * surely(at.speed, acceleration, rest)
    sign, least = 1.0 if mode == TAUT else -1.0, of.stiffness * rounding.length
    values[slackens], slopes[slackens] = sign * pull, sign * rate
    if abs(pull) <= least and sign * rate > 0.0:  # it has just changed, to rounding
        values[slackens] = least
    if abs(at.speed) <= rest and abs(pull) <= least:  # it hangs there, neither taut nor slack
        values[slackens], slopes[slackens] = least, 0.0
    if mode == TAUT and of.strength < math.inf:
        values[gives], slopes[gives] = of.strength - pull, -rate
        if abs(values[gives]) <= least and rate < 0.0:
            values[gives] = least


@kernel
def _of_friction(m, devices, now, place, h, functions):
    """Write what friction dampers that do not move could hold more; its rate from a moment later."""
    x, kx, near = devices.x if place == START else devices.end, devices.rates[place], NEARBY * h
    one = two = one_later = two_later = 0.0
    for ahead in (0.0, near):  # in one place, for it is much machine code
        for i in range(len(x)):
            devices.stage[i] = x[i] + ahead * kx[i]
        one, two, there = one_later, two_later, later(now.ground, ahead)
        soon = Moment(along(now.y, now.k, ahead), now.contact, now.supports)
        _, one_later, two_later = under_devices(m, devices, soon, devices.stage, there)
    j, forces, forces_later = NO_EVENT, (one, two), (one_later, two_later)
    for number in range(2):
        j = sticking(devices, j)
        if j == NO_EVENT:
            return
        at, strength = OF_PIER + PER_DEVICE * j + GIVES, devices.elements[j].strength
        functions.values[at] = strength - abs(forces[number])
        functions.slopes[at] = (abs(forces[number]) - abs(forces_later[number])) / near


@kernel
def _is_held(m, devices, now, slope, i):
    """Return whether friction holds the pivot of event function ``i`` where it is, on or just off its support."""
    least, at = NO_ACCELERATION * m.gravity, attitude(m, now.y, now.contact, devices.level[0])
    lift = lifted(gap(m, -m.half_width if i % 2 == 0 else m.half_width, at, now.y), now.k)
    return abs(slope) <= least and abs(lift) <= least


@kernel
def device_functions(m, devices, now, place, h, functions):
    """Write the event functions of all devices and their slopes behind those of the pier, of the Instant ``now``.

    Rates and gaps of the devices are in their ``place``. What friction holds at a pivot, to rounding, is no event of it.
    """
    x, least, rest = devices.x if place == START else devices.end, NO_ACCELERATION * m.gravity, m.rest
    length, holds = rest * rest / least, sticking(devices, NO_EVENT) != NO_EVENT
    values, slopes = functions.values, functions.slopes
    for i in range(OF_PIER):
        rounding = rest if i >= LAW_LEFT else length
        if holds and abs(values[i]) <= rounding and _is_held(m, devices, now, slopes[i], i):
            values[i], slopes[i] = 1.0, 0.0
        elif i >= LAW_LEFT and abs(values[i]) <= rest and slopes[i] > 0.0:  # it has just turned, to rounding
            values[i] = rest
    for j in range(len(devices.elements)):
        here = devices.gaps[place, j]
        acceleration = lifted(here, now.k)
        if abs(acceleration) <= least:
            acceleration = 0.0
        _of_device(devices, j, Motion(here, acceleration, x[j]), Rounding(rest, length), functions)
    if holds:
        _of_friction(m, devices, now, place, h, functions)


@kernel
def _consistent(m, devices, now, x, ground, pair):
    """Return whether a ``pair`` of friction dampers without velocity can do what ``goes`` says of them."""
    under, one, two = under_devices(m, devices, now, x, ground)
    k = rates(under, now.y, now.contact, ground)
    holding = sticking(devices, NO_EVENT)
    for j in pair:
        if j == NO_EVENT:
            continue
        of = devices.elements[j]
        if devices.goes[j] == STICKS:
            if abs(one if j == holding else two) > (1.0 + SURE) * of.strength:
                return False
        elif devices.goes[j] * lifted(devices.gaps[BESIDE, j], k) <= 0.0:
            return False
    return True


@kernel
def settle_friction(m, devices, now, x, ground):
    """Decide what friction dampers without velocity do from here on: hold if they can, else go where the others take them."""
    first = sticking(devices, NO_EVENT)
    if first == NO_EVENT:
        return
    second = sticking(devices, first)
    for way in WAYS:
        if second == NO_EVENT and way[1] != STICKS:
            continue
        devices.goes[first] = way[0]
        if second != NO_EVENT:
            devices.goes[second] = way[1]
        if _consistent(m, devices, now, x, ground, (first, second)):
            return
    devices.goes[first] = STICKS  # what rounding leaves
    if second != NO_EVENT:
        devices.goes[second] = STICKS


@kernel
def change_tendon(mode, limit):
    """Return the mode of a tendon whose force has fallen to 0 or, slack, risen to it; with ``limit``, come to its strength."""
    if limit:
        return YIELDING
    return SLACK if mode == TAUT else TAUT


@kernel
def _stop_event(devices, j, depth, what):
    """Change the mode of stop ``j``, pressed in by ``depth`` [m]; left, it recovers when the pier is where it first met it."""
    mode = devices.modes[j]
    if mode == YIELDING:
        devices.modes[j], devices.x[j] = TAUT, depth
    elif mode == TAUT:
        devices.modes[j] = SLACK if what == SLACKENS else YIELDING
        if what == SLACKENS and devices.elements[j].returned == 1.0:
            devices.x[j] = 0.0
    elif what == GIVES:
        devices.x[j] = 0.0
    else:
        devices.modes[j] = TAUT if devices.x[j] > 0.0 else YIELDING
        devices.use[j].times += 1.0 if devices.x[j] == 0.0 else 0.0


@kernel
def device_event(m, devices, now, ground, h, which):
    """Let the event ``which`` of a device happen in the Moment ``now``: its mode or direction changes.

    Of friction that lets go, and perhaps others with it, what they do a moment later decides: now each of them still holds
    to rounding, and where two reach their force at one time neither can go alone.
    """
    if devices is None:
        return
    j, what = (which - OF_PIER) // PER_DEVICE, (which - OF_PIER) % PER_DEVICE
    of, y = devices.elements[j], now.y
    if of.kind == CONTACT:
        at = attitude(m, y, now.contact, devices.level[0])
        _stop_event(devices, j, gap_of(m, of, at, y).elongation - of.start, what)
        return
    if of.kind == TENDON:
        devices.modes[j] = TAUT if what == TURNS else change_tendon(devices.modes[j], what == GIVES)
        if devices.modes[j] == SLACK and (of.prestress > 0.0 or devices.x[j] > 0.0):
            devices.use[j].times += 1.0
        return
    lets_go = of.kind == FRICTION and what == GIVES
    if not lets_go and (of.kind != FRICTION or of.strength == 0.0):
        devices.goes[j] = -devices.goes[j]
        if of.kind == MAXWELL:
            return
    under, one, two = device_rates(m, devices, now, devices.x, ground, START)
    holds = one if sticking(devices, NO_EVENT) == j else two
    k = rates(under, y, now.contact, ground)
    for i in range(len(devices.elements)):  # friction that comes to rest at the same time may hold, too
        other, here = devices.elements[i], devices.gaps[START, i]
        stops = i == j or (abs(here.speed) <= m.rest and devices.goes[i] * lifted(here, k) < 0.0)
        if stops and not lets_go and other.kind == FRICTION and other.strength > 0.0:
            devices.goes[i] = STICKS
    for ahead in (SOON * h, 0.0):
        if ahead > 0.0 and not lets_go:
            continue
        if lets_go and ahead == 0.0:
            devices.goes[j] = OPENS if holds > 0.0 else CLOSES
        for i in range(len(devices.x)):
            devices.stage[i] = devices.x[i] + ahead * devices.rates[START, i]
        soon = Moment(along(y, k, ahead), now.contact, now.supports)
        settle_friction(m, devices, soon, devices.stage, later(ground, ahead))
        if devices.goes[j] != STICKS:
            return


@kernel
def after_contact(m, devices, now, ground):
    """Choose directions and modes once an event at a pivot may have made all velocities jump."""
    if devices is None:
        return
    y, at = now.y, attitude(m, now.y, now.contact, devices.level[0])
    for j in range(len(devices.elements)):
        of = devices.elements[j]
        here = gap_of(m, of, at, y)
        if abs(here.speed) <= m.rest:
            if of.kind == FRICTION and of.strength > 0.0:
                devices.goes[j] = STICKS
            continue
        if of.kind == CONTACT:
            depth = here.elongation - of.start
            if devices.modes[j] == YIELDING and here.speed < 0.0:
                devices.modes[j], devices.x[j] = TAUT, depth
            elif devices.modes[j] == TAUT and here.speed > 0.0 and depth >= devices.x[j]:
                devices.modes[j] = YIELDING
        elif of.kind == MAXWELL:
            continue
        elif of.kind != TENDON:
            devices.goes[j] = OPENS if here.speed > 0.0 else CLOSES
        elif devices.modes[j] == YIELDING and here.speed < 0.0:
            devices.modes[j] = TAUT
        elif (
            devices.modes[j] == TAUT and here.speed > 0.0 and tension(of, here.elongation, devices.x[j]) >= of.strength
        ):
            devices.modes[j] = YIELDING
    settle_friction(m, devices, now, devices.x, ground)


@inlined
def start_devices(m, devices, now, ground):
    """Choose directions and modes of devices at the start; unless the level is known, the lower pivot is where it rests."""
    if devices is None:
        return
    y = now.y
    if math.isnan(devices.level[0]):
        lies = attitude(m, y, now.contact, 0.0)
        devices.level[0] = lies.rise - m.half_width * abs(lies.sine)
    at = attitude(m, y, now.contact, devices.level[0])
    for j in range(len(devices.elements)):
        of = devices.elements[j]
        devices.goes[j] = STICKS if of.kind == FRICTION and of.strength > 0.0 else OPENS
        devices.modes[j] = mode_of(of, gap_of(m, of, at, y).elongation, devices.x[j], OPENS)
    after_contact(m, devices, now, ground)


@kernel
def leave_rest(m, devices, y, contact):
    """Let devices go as the pier leaves rest for ``contact``: to turn about its pivot, or to rise without one."""
    if devices is None:
        return
    at = attitude(m, y, contact, devices.level[0])
    for j in range(len(devices.elements)):
        of, way = devices.elements[j], way_of_opening(m, devices.elements[j], contact)
        devices.goes[j] = way if way != STICKS or of.kind == FRICTION else OPENS
        devices.modes[j] = mode_of(of, gap_of(m, of, at, y).elongation, devices.x[j], way)
