"""Events of devices: velocity reversal, slip of friction, slack, taut and yielding tendons, closing and opening stops.

After the event functions of the pier each device has three: TURNS, its velocity reverses; SLACKENS, it goes slack or taut;
GIVES, it yields or slips. A stop TURNS in first compression, SLACKENS as it closes or opens, and GIVES as it passes its
greatest compression or, open, recovers.
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

TURNS, SLACKENS, GIVES = 0, 1, 2  # offsets among the event functions of a device
PER_DEVICE = 3

NEARBY = 1e-6
"""Interval of the finite difference for the rate of a sticking force, over the step."""

SOON = 1e-3
"""Time after a slip, over the step, at which directions are decided."""

SURE = 1e-9
"""Relative excess of a sticking force over the strength that is rounding."""

WAYS = (
    (STICKS, STICKS),
    (OPENS, STICKS),
    (CLOSES, STICKS),
    (STICKS, OPENS),
    (STICKS, CLOSES),
    (OPENS, OPENS),
    (OPENS, CLOSES),
    (CLOSES, OPENS),
    (CLOSES, CLOSES),
)
"""Directions that two friction dampers without velocity can take, in the order in which they are tried."""


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
    """Speed [m/s] and length [m] that are rounding."""

    speed: float
    length: float


@inlined
def _crossing(value, slope, speed, rounding):
    """Return an event function of an elongation and its slope; made positive within rounding if it rises or is at rest."""
    rest, length = rounding
    if abs(value) > length:
        return value, slope
    return (length, slope if abs(speed) > rest else 0.0) if slope > 0.0 or abs(speed) <= rest else (value, slope)


@kernel
def _stop_functions(devices, j, motion, rounding, functions):
    """Write the event functions of stop ``j`` that its mode needs, and their slopes; the others stay as they are."""
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
def _write_functions(devices, j, motion, rounding, functions):
    """Write the three event functions of device ``j`` and their slopes, 1 and 0 for events that cannot occur.

    None can occur to a spring, a linear viscous damper or, here, a sticking friction damper.
    """
    of, mode, goes, at, state = devices.elements[j], devices.modes[j], devices.goes[j], motion.gap, motion.state
    values, slopes, acceleration, rest = functions.values, functions.slopes, motion.acceleration, rounding.speed
    turns = OF_PIER + PER_DEVICE * j + TURNS
    slackens, gives = turns + SLACKENS, turns + GIVES
    values[turns] = values[slackens] = values[gives] = 1.0
    slopes[turns] = slopes[slackens] = slopes[gives] = 0.0
    if of.linear_below == math.inf or (of.kind == FRICTION and goes == STICKS):
        return
    if of.kind == CONTACT:
        _stop_functions(devices, j, motion, rounding, functions)
        return
    if of.kind == MAXWELL:
        rate = goes * response(of, at.elongation, at.speed, state, TAUT, goes).state_rate
        values[turns], slopes[turns] = goes * state, rate
        if abs(state) <= of.stiffness * rounding.length and rate >= 0.0:
            values[turns] = of.stiffness * rounding.length
        return
    if of.kind != TENDON or mode == YIELDING:
        way = OPENS if of.kind == TENDON else goes
        starts = (
            abs(at.speed) <= rest and way * acceleration >= 0.0
        )  # it has just reversed, or is released, within rounding
        values[turns], slopes[turns] = rest if starts else way * at.speed, way * acceleration
        return
    pull, rate = tension(of, at.elongation, state), of.stiffness * surely(at.speed, acceleration, rest)
    sign, least = 1.0 if mode == TAUT else -1.0, of.stiffness * rounding.length
    values[slackens], slopes[slackens] = sign * pull, sign * rate
    if abs(pull) <= least and sign * rate > 0.0:  # it has just changed, within rounding
        values[slackens] = least
    if abs(at.speed) <= rest and abs(pull) <= least:  # at rest between taut and slack
        values[slackens], slopes[slackens] = least, 0.0
    if mode == TAUT and of.strength < math.inf:
        values[gives], slopes[gives] = of.strength - pull, -rate
        if abs(values[gives]) <= least and rate < 0.0:
            values[gives] = least


@kernel
def _sticking_functions(m, devices, now, place, h, functions):
    """Write the reserve of strength of up to two sticking friction dampers, and its slope by a finite difference."""
    x, kx, near = devices.x if place == START else devices.end, devices.rates[place], NEARBY * h
    for i in range(len(x)):
        devices.stage[i] = x[i] + near * kx[i]
    soon = Moment(along(now.y, now.k, near), now.contact, now.supports)
    _, one_later, two_later = under_devices(m, devices, soon, devices.stage, later(now.ground, near))
    j, forces, forces_later = NO_EVENT, devices.held[place], (one_later, two_later)
    for number in range(2):
        j = sticking(devices, j)
        if j == NO_EVENT:
            return
        at, strength = OF_PIER + PER_DEVICE * j + GIVES, devices.elements[j].strength
        functions.values[at] = strength - abs(forces[number])
        functions.slopes[at] = (abs(forces[number]) - abs(forces_later[number])) / near


@kernel
def _is_held(m, devices, now, slope, i):
    """Return True if friction holds the pivot of event function ``i`` in place, on or just above its support."""
    least, at = NO_ACCELERATION * m.gravity, attitude(m, now.y, now.contact, devices.level[0])
    lift = lifted(gap(m, -m.half_width if i % 2 == 0 else m.half_width, at, now.y), now.k)
    return abs(slope) <= least and abs(lift) <= least


@kernel
def device_functions(m, devices, now, place, h, functions):
    """Write the event functions of all devices and their slopes after those of the pier, of the Instant ``now``.

    Rates and gaps of the devices are in their row ``place``. A pivot that friction holds, within rounding, has no event.
    """
    x, least, rest = devices.x if place == START else devices.end, NO_ACCELERATION * m.gravity, m.rest
    length, holds = rest * rest / least, sticking(devices, NO_EVENT) != NO_EVENT
    values, slopes = functions.values, functions.slopes
    for i in range(OF_PIER):
        rounding = rest if i >= LAW_LEFT else length
        if holds and abs(values[i]) <= rounding and _is_held(m, devices, now, slopes[i], i):
            values[i], slopes[i] = 1.0, 0.0
        elif i >= LAW_LEFT and abs(values[i]) <= rest and slopes[i] > 0.0:  # it has just reversed, within rounding
            values[i] = rest
    for j in range(len(devices.elements)):
        here = devices.gaps[place, j]
        acceleration = lifted(here, now.k)
        if abs(acceleration) <= least:
            acceleration = 0.0
        _write_functions(devices, j, Motion(here, acceleration, x[j]), Rounding(rest, length), functions)
    if holds:
        _sticking_functions(m, devices, now, place, h, functions)


@kernel
def _consistent(m, devices, now, x, ground, pair):
    """Return True if the directions in ``goes`` of a ``pair`` of friction dampers without velocity are consistent.

    Those that stick need at most their strength, the others accelerate in their direction; the second may be NO_EVENT.
    """
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
    """Set the directions of up to two friction dampers without velocity: STICKS if they can hold, else a consistent pair."""
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
    devices.goes[first] = STICKS  # by rounding no combination is consistent
    if second != NO_EVENT:
        devices.goes[second] = STICKS


@kernel
def change_tendon(mode, limit):
    """Return YIELDING for a tendon at its strength (``limit``); for one whose force is 0, SLACK if it was TAUT, else TAUT."""
    if limit:
        return YIELDING
    return SLACK if mode == TAUT else TAUT


@kernel
def _stop_event(devices, j, depth, what):
    """Change mode and state of stop ``j`` at compression ``depth`` [m]; open, it recovers at the point of first contact.

    It is counted as it closes, unless it has not recovered since.
    """
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
    """Apply the event ``which`` of a device in the Moment ``now``: change its mode or direction.

    For friction that slips the directions are decided by the state a moment later: now each damper still sticks within
    rounding, and if two reach their strength at once, neither can slip alone.
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
    for i in range(len(devices.elements)):  # another damper that comes to rest at the same time may stick, too
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
def reset_device_modes(m, devices, now, ground):
    """Set directions and modes of devices from the velocities after an event at a pivot, where these may have jumped.

    Devices without velocity keep theirs, but for friction, which sticks or begins to slip.
    """
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
    """Set directions and modes of devices at the start; a level of NaN becomes that at which the lower pivot rests."""
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
    reset_device_modes(m, devices, now, ground)


@kernel
def leave_rest(m, devices, y, contact):
    """Set directions and modes of devices as the pier leaves rest for ``contact``: about a pivot, or rising."""
    if devices is None:
        return
    at = attitude(m, y, contact, devices.level[0])
    for j in range(len(devices.elements)):
        of, way = devices.elements[j], way_of_opening(m, devices.elements[j], contact)
        devices.goes[j] = way if way != STICKS or of.kind == FRICTION else OPENS
        devices.modes[j] = mode_of(of, gap_of(m, of, at, y).elongation, devices.x[j], way)
