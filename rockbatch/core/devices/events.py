"""Events of devices: an elongation turns, a friction damper lets go, a tendon goes slack or taut, or yields.

Behind the event functions of the pier there are three of each device: it turns, it goes slack or taut again, it yields or
lets go.
"""

import math

from rockbatch.core.devices.laws import (
    CLOSES,
    FRICTION,
    OPENS,
    SLACK,
    STICKS,
    TAUT,
    TENDON,
    YIELDING,
    mode_of,
    tension,
)
from rockbatch.core.devices.pull import (
    device_rates,
    gap,
    gap_at,
    lifted,
    sticking,
    under_devices,
    way_of_opening,
)
from rockbatch.core.ground import later
from rockbatch.core.kernel import inlined, inner
from rockbatch.core.roots import NO_ACCELERATION, surely
from rockbatch.core.system import accelerations, rates
from rockbatch.core.table import along
from rockbatch.core.trigonometry import sine_and_cosine
from rockbatch.core.types import LAW_LEFT, NO_EVENT, OF_PIER

TURNS, SLACKENS, GIVES = 0, 1, 2
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


@inner
def _of_device(of, at, state, mode, goes, acceleration, rest, rounding, values, slopes, first):
    """Write the three event functions of a device, and their slopes, but for a friction damper that does not move."""
    for i in range(first, first + PER_DEVICE):
        values[i], slopes[i] = 1.0, 0.0
    turns, slackens, gives = first + TURNS, first + SLACKENS, first + GIVES
    speed = surely(at.speed, acceleration, rest)
    if of.kind != TENDON or mode == YIELDING:
        way = OPENS if of.kind == TENDON else goes
        starts = abs(at.speed) <= rest and way * acceleration >= 0.0  # it has just turned, or is let go, to rounding
        values[turns], slopes[turns] = rest if starts else way * at.speed, way * acceleration
        return
    pull, rate = tension(of, at.elongation, state), of.stiffness * speed
    sign, least = 1.0 if mode == TAUT else -1.0, of.stiffness * rounding
    values[slackens], slopes[slackens] = sign * pull, sign * rate
    if abs(pull) <= least and sign * rate > 0.0:  # it has just changed, to rounding
        values[slackens] = least
    if abs(at.speed) <= rest and abs(pull) <= least:  # it hangs there, neither taut nor slack
        values[slackens], slopes[slackens] = least, 0.0
    if mode == TAUT and of.strength < math.inf:
        values[gives], slopes[gives] = of.strength - pull, -rate
        if abs(values[gives]) <= least and rate < 0.0:
            values[gives] = least


@inner
def _of_friction(m, devices, y, x, contact, k, kx, ground, h, one, two, values, slopes):
    """Write what friction dampers that do not move could hold more; its rate from a moment later."""
    near = NEARBY * h
    for i in range(len(x)):
        devices.stage[i] = x[i] + near * kx[i]
    there = later(ground, near)
    _, one_later, two_later = under_devices(
        m, devices, along(y, k, near), devices.stage, contact, there.horizontal, there.vertical
    )
    j, forces, forces_later = NO_EVENT, (one, two), (one_later, two_later)
    for number in range(2):
        j = sticking(devices, j)
        if j == NO_EVENT:
            return
        at, strength = OF_PIER + PER_DEVICE * j + GIVES, devices.elements[j].strength
        values[at] = strength - abs(forces[number])
        slopes[at] = (abs(forces[number]) - abs(forces_later[number])) / near


@inner
def device_functions(m, devices, y, x, contact, k, kx, rest, ground, h, values, slopes):
    """Write the event functions of all devices and their slopes behind those of the pier, in state ``y`` with rates ``k``.

    ``x`` are the devices' states and ``kx`` their rates. What friction holds at a pivot, to rounding, is no event of it.
    """
    length = rest * rest / (NO_ACCELERATION * m.gravity)
    holds = sticking(devices, NO_EVENT) != NO_EVENT
    for i in range(OF_PIER):
        offset = -m.half_width if i % 2 == 0 else m.half_width
        lift = lifted(gap_at(m, offset, y, devices.level[0]), k.v_rate, k.omega)
        at_once = (
            holds and abs(lift) <= NO_ACCELERATION * m.gravity and abs(values[i]) <= (rest if i >= LAW_LEFT else length)
        )
        if (
            at_once and abs(slopes[i]) <= NO_ACCELERATION * m.gravity
        ):  # friction holds the pivot, on or just off its support
            values[i], slopes[i] = 1.0, 0.0
        elif i >= LAW_LEFT and abs(values[i]) <= rest and slopes[i] > 0.0:  # it has just turned, to rounding
            values[i] = rest
    for j in range(len(devices.elements)):
        of, first = devices.elements[j], OF_PIER + PER_DEVICE * j
        at = gap(m, of, y, devices.level[0])
        acceleration = lifted(at, k.v_rate, k.omega)
        if abs(acceleration) <= NO_ACCELERATION * m.gravity:
            acceleration = 0.0
        _of_device(of, at, x[j], devices.modes[j], devices.goes[j], acceleration, rest, length, values, slopes, first)
        if of.kind == FRICTION and devices.goes[j] == STICKS:
            values[first + TURNS], slopes[first + TURNS] = 1.0, 0.0
    if sticking(devices, NO_EVENT) != NO_EVENT:
        a, c = ground.horizontal, ground.vertical
        _, one, two = under_devices(m, devices, y, x, contact, a, c)
        _of_friction(m, devices, y, x, contact, k, kx, ground, h, one, two, values, slopes)


@inner
def _consistent(m, devices, y, x, contact, horizontal, vertical, first, second):
    """Return whether friction dampers ``first`` and ``second``, without velocity, can do what ``goes`` says of them."""
    under, one, two = under_devices(m, devices, y, x, contact, horizontal, vertical)
    v_acceleration, theta_acceleration = accelerations(under, y, contact, horizontal, vertical)
    holding = sticking(devices, NO_EVENT)
    for j in (first, second):
        if j == NO_EVENT:
            continue
        of = devices.elements[j]
        if devices.goes[j] == STICKS:
            if abs(one if j == holding else two) > (1.0 + SURE) * of.strength:
                return False
        elif devices.goes[j] * lifted(gap(m, of, y, devices.level[0]), v_acceleration, theta_acceleration) <= 0.0:
            return False
    return True


@inner
def settle_friction(m, devices, y, x, contact, horizontal, vertical):
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
        if _consistent(m, devices, y, x, contact, horizontal, vertical, first, second):
            return
    devices.goes[first] = STICKS  # what rounding leaves
    if second != NO_EVENT:
        devices.goes[second] = STICKS


@inner
def change_tendon(mode, limit):
    """Return the mode of a tendon whose force has fallen to 0 or, slack, risen to it; with ``limit``, come to its strength."""
    if limit:
        return YIELDING
    return SLACK if mode == TAUT else TAUT


@inner
def _let_go(m, devices, y, contact, ground, h, j):
    """Let friction damper ``j`` go, and perhaps others with it: what they do a moment later decides.

    Now each of them still holds to rounding, and where two reach their force at one time neither can go alone.
    """
    near, a, c = SOON * h, ground.horizontal, ground.vertical
    under = device_rates(m, devices, y, devices.x, contact, a, c, devices.rates[0])
    _, one, two = under_devices(m, devices, y, devices.x, contact, a, c)
    holds = one if sticking(devices, NO_EVENT) == j else two
    k = rates(under, y, contact, a, c)
    for i in range(len(devices.x)):
        devices.stage[i] = devices.x[i] + near * devices.rates[0, i]
    there = later(ground, near)
    settle_friction(m, devices, along(y, k, near), devices.stage, contact, there.horizontal, there.vertical)
    if devices.goes[j] == STICKS:
        devices.goes[j] = OPENS if holds > 0.0 else CLOSES
        settle_friction(m, devices, y, devices.x, contact, a, c)


@inner
def device_event(m, devices, y, contact, ground, h, rest, which):
    """Let the event ``which`` of a device happen in state ``y``: its mode or direction changes."""
    j, what = (which - OF_PIER) // PER_DEVICE, (which - OF_PIER) % PER_DEVICE
    of = devices.elements[j]
    if of.kind == TENDON:
        devices.modes[j] = TAUT if what == TURNS else change_tendon(devices.modes[j], what == GIVES)
        if devices.modes[j] == SLACK and (of.prestress > 0.0 or devices.x[j] > 0.0):
            devices.use[j].slack += 1.0
        return
    if of.kind == FRICTION and what == GIVES:
        _let_go(m, devices, y, contact, ground, h, j)
        return
    if of.kind != FRICTION or of.strength == 0.0:
        devices.goes[j] = -devices.goes[j]
    under, _, _ = under_devices(m, devices, y, devices.x, contact, ground.horizontal, ground.vertical)
    v_acceleration, theta_acceleration = accelerations(under, y, contact, ground.horizontal, ground.vertical)
    for i in range(len(devices.elements)):  # friction that comes to rest at the same time may hold, too
        other, at = devices.elements[i], gap(m, devices.elements[i], y, devices.level[0])
        stops = abs(at.speed) <= rest and devices.goes[i] * lifted(at, v_acceleration, theta_acceleration) < 0.0
        if other.kind == FRICTION and other.strength > 0.0 and (i == j or stops):
            devices.goes[i] = STICKS
    settle_friction(m, devices, y, devices.x, contact, ground.horizontal, ground.vertical)


@inner
def after_contact(m, devices, y, contact, rest, ground):
    """Choose directions and modes once an event at a pivot may have made all velocities jump."""
    for j in range(len(devices.elements)):
        of, at = devices.elements[j], gap(m, devices.elements[j], y, devices.level[0])
        if abs(at.speed) <= rest:
            if of.kind == FRICTION and of.strength > 0.0:
                devices.goes[j] = STICKS
            continue
        if of.kind != TENDON:
            devices.goes[j] = OPENS if at.speed > 0.0 else CLOSES
        elif devices.modes[j] == YIELDING and at.speed < 0.0:
            devices.modes[j] = TAUT
        elif devices.modes[j] == TAUT and at.speed > 0.0 and tension(of, at.elongation, devices.x[j]) >= of.strength:
            devices.modes[j] = YIELDING
    settle_friction(m, devices, y, devices.x, contact, ground.horizontal, ground.vertical)


@inlined
def start_devices(m, devices, y, contact, rest, ground):
    """Put devices without permanent elongation in state ``y``, its lower pivot where it rests: level, directions and modes."""
    if devices is None:
        return
    sine, cosine = sine_and_cosine(y.theta)
    drop = m.height * sine * sine / (1.0 + cosine) if m.finite is not None else 0.0
    devices.level[0] = y.v - m.half_width * abs(sine) + drop
    for j in range(len(devices.elements)):
        of, at = devices.elements[j], gap(m, devices.elements[j], y, devices.level[0])
        devices.goes[j] = STICKS if of.kind == FRICTION and of.strength > 0.0 else OPENS
        devices.modes[j] = mode_of(of, at.elongation, devices.x[j], OPENS)
    after_contact(m, devices, y, contact, rest, ground)


@inner
def leave_rest(m, devices, y, side):
    """Let devices go as the pier at rest begins to turn about its pivot on ``side``, or to rise on NEITHER."""
    if devices is None:
        return
    for j in range(len(devices.elements)):
        of, way = devices.elements[j], way_of_opening(m, devices.elements[j], side)
        devices.goes[j] = way if way != STICKS or of.kind == FRICTION else OPENS
        devices.modes[j] = mode_of(of, gap(m, of, y, devices.level[0]).elongation, devices.x[j], way)
