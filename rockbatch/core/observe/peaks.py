"""Forces of a recorded run at its rows, and their greatest values (THEORY.md, Forces).

An observer, like the ledger: other runs pay nothing for it. Forces follow from the state at any share of a step. Each step is
evaluated at its middle, too, and at the vertex of a parabola through the three values if it exceeds the peak: the force of
the state there counts, not the parabola's value, which may be too large where a law is steep.
"""

import math
from typing import NamedTuple

import numpy as np

from rockbatch.core.devices.elongation import attitude, gap_of
from rockbatch.core.devices.laws import (
    CONTACT,
    FRICTION,
    HYSTERETIC,
    MAXWELL,
    TAUT,
    TENDON,
    force,
    response,
    stop_force,
)
from rockbatch.core.kernel import entry, hook, kernel
from rockbatch.core.observe.forces import LIFTED, Body, Forces, fastest_heels, forces_at, waiting
from rockbatch.core.observe.rows import (
    Step,
    begin_at,
    contact_of,
    cubic,
    ground_at,
    ground_within,
    remember,
    state_of,
    step_between,
    within,
)
from rockbatch.core.springs.model import Supports
from rockbatch.core.system import airborne
from rockbatch.core.table import record, with_pull
from rockbatch.core.types import Ground, Moment, Pull

NEVER = -1.0
"""Time of an event that does not occur."""

BISECTIONS = 40
"""Bisections of a step in which the normal force passes its limit."""

_FRICTION, _SHEAR = Forces._fields.index("friction"), Forces._fields.index("shear")


class Limits(NamedTuple):
    """Limits with which the forces of a run are compared."""

    friction: float  # coefficient of the interface, infinite where it is not known
    normal: float  # N/M below which no friction demand is taken [m/s²]
    unstressed: float  # position of the supports of pivots that are free at the start [m]


class Noted(NamedTuple):
    """Times and impacts of a run beside its greatest forces."""

    slides: float  # when |V|/N first exceeds the friction, while N is above its limit; NEVER if it does not [s]
    pulls: float  # when N is first negative [s]
    key_shear: float  # greatest |V|/M while N is below its limit [m/s²]
    longest_flight: float  # [s]


NOTED = record(Noted)


class RecordedDevices(NamedTuple):
    """Devices of a recorded run."""

    elements: np.recarray  # of Element
    states: np.ndarray  # shape (rows, elements): as ``laws.force`` takes them
    level: float  # v of the pier at rest [m]


class RecordedRun(NamedTuple):
    """A run as it was recorded."""

    rows: np.recarray  # of recording.Row, shape (n,): the history; for the greatest forces, with every step
    pulls: np.ndarray  # shape (n, 2): force [m/s²] and moment [m²/s²] of devices at every row
    devices: RecordedDevices | None
    ground: np.ndarray  # of :func:`rockbatch.core.ground.ground_rows`, shape (npts, 4): the motion
    dt: float  # its sampling interval [s]


class Extremes(NamedTuple):
    """Greatest magnitudes of a run, and the limits that its moments are held against."""

    limits: Limits
    greatest: np.ndarray  # of each of Forces, at the rows and between; of friction while N is above its limit
    noted: np.recarray  # of Noted, shape (1,)


class Place(NamedTuple):
    """A moment within the step to a row."""

    i: int  # of the row
    step: Step
    s: float  # share of the step


@kernel
def _state_within(m, devices, j, place):
    """Return the state of device ``j`` at a Place, from its states at the ends of the step.

    It is linear between them; by a cubic for hysteretic dampers and braced viscous ones.
    """
    of, level, step, s = devices.elements[j], devices.level, place.step, place.s
    was, now = devices.states[place.i - 1, j], devices.states[place.i, j]
    if of.kind not in (HYSTERETIC, MAXWELL):
        return was + s * (now - was)
    start = gap_of(m, of, attitude(m, step.start, step.contact, level), step.start)
    end = gap_of(m, of, attitude(m, step.end, step.contact, level), step.end)
    rate = response(of, start.elongation, start.speed, was, TAUT, math.copysign(1.0, start.speed)).state_rate
    rate_end = response(of, end.elongation, end.speed, now, TAUT, math.copysign(1.0, end.speed)).state_rate
    return cubic(was, rate, now, rate_end, step.length, s)


@kernel
def recorded_force(of, here, state, goes):
    """Return the force [m/s²] of an element whose Gap is ``here``, in the mode that its elongation and state ask for.

    Of friction it is the strength in the direction ``goes``.
    """
    if of.kind == CONTACT:
        return stop_force(of, here.elongation, state)
    pull = force(of, here.elongation, here.speed, state, TAUT, goes)
    return min(max(pull, 0.0), of.strength) if of.kind == TENDON else pull


@kernel
def _pull_within(m, devices, j, at, place, y):
    """Return the Gap of device ``j`` in state ``y`` at a Place, whose Attitude is ``at``, and its force [m/s²], 0 of friction."""
    of = devices.elements[j]
    here = gap_of(m, of, at, y)
    return here, recorded_force(of, here, _state_within(m, devices, j, place), 0.0)


@kernel
def _pull_by_laws(m, devices, place, y):
    """Return the Pull, in state ``y`` at a Place, of all that has a law: not of friction."""
    total, moment, at = 0.0, 0.0, attitude(m, y, place.step.contact, devices.level)
    for j in range(len(devices.elements)):
        if devices.elements[j].kind == FRICTION:
            continue
        here, pull = _pull_within(m, devices, j, at, place, y)
        total += pull * here.by_v
        moment += pull * here.arm
    return Pull(total, moment)


@hook
def under_devices_within(devices, m, pulls, place, y):
    """Return the pier under the pull of its devices in state ``y`` at a Place."""


@under_devices_within.of(type(None))
def _without_devices(devices, m, pulls, place, y):
    return with_pull(m, Pull(0.0, 0.0))


@under_devices_within.of(RecordedDevices)
def _with_devices(devices, m, pulls, place, y):
    """Use the devices' laws, and what friction adds to them at both ends, linear between."""
    i, step, s = place
    start, now, end = (
        _pull_by_laws(m, devices, Place(i, step, 0.0), step.start),
        _pull_by_laws(m, devices, place, y),
        _pull_by_laws(m, devices, Place(i, step, 1.0), step.end),
    )
    rubs, rubs_end = pulls[i - 1, 0] - start.force, pulls[i, 0] - end.force
    turns, turns_end = pulls[i - 1, 1] - start.moment, pulls[i, 1] - end.moment
    return with_pull(m, Pull(now.force + rubs + s * (rubs_end - rubs), now.moment + turns + s * (turns_end - turns)))


@kernel
def _with_across(forces, gravity, shear, moment):
    """Return the Forces of the base alone, without devices on the deck, which push it to the left by ``shear`` and ``moment``.

    The shear [m/s²] is added, the moment [m²/s²] subtracted, and the friction demand follows.
    """
    base = forces.shear + shear
    friction = abs(base) / forces.normal if forces.normal > LIFTED * gravity else math.inf
    return Forces(
        base, forces.normal, forces.moment - moment, forces.left, forces.right, forces.gap_left, forces.gap_right,
        forces.speed_left, forces.speed_right, forces.deck, forces.along, forces.up, forces.omega, friction, forces.clearance,
    )  # fmt: skip


@hook
def _at_base(devices, m, forces, i, y, contact):
    """Return the Forces at row ``i`` in state ``y`` without what devices on the deck take; unchanged if there are none."""


@_at_base.of(type(None))
def _all_at_base(devices, m, forces, i, y, contact):
    return forces


@_at_base.of(RecordedDevices)
def _less_deck(devices, m, forces, i, y, contact):
    shear, moment, at, some = 0.0, 0.0, attitude(m, y, contact, devices.level), False
    for j in range(len(devices.elements)):
        of = devices.elements[j]
        if of.height != 0.0:
            here, some = gap_of(m, of, at, y), True
            pull = recorded_force(of, here, devices.states[i, j], 0.0)
            shear, moment = shear + of.way * pull, moment + pull * here.by_theta
    return _with_across(forces, m.gravity, shear, moment) if some else forces


@hook
def _at_base_within(devices, m, forces, place, y):
    """Return the Forces in state ``y`` at a Place, without what devices on the deck take."""


@_at_base_within.of(type(None))
def _all_within(devices, m, forces, place, y):
    return forces


@_at_base_within.of(RecordedDevices)
def _less_deck_within(devices, m, forces, place, y):
    shear, moment, at, some = 0.0, 0.0, attitude(m, y, place.step.contact, devices.level), False
    for j in range(len(devices.elements)):
        of = devices.elements[j]
        if of.height != 0.0:
            (here, pull), some = _pull_within(m, devices, j, at, place, y), True
            shear, moment = shear + of.way * pull, moment + pull * here.by_theta
    return _with_across(forces, m.gravity, shear, moment) if some else forces


@hook
def push_deck(devices, m, i, y, contact, out):
    """Write the force to the left [m/s²] of each device on the deck, in state ``y`` at row ``i``; no other entry of ``out``."""


@push_deck.of(type(None))
def _no_push(devices, m, i, y, contact, out):
    pass


@push_deck.of(RecordedDevices)
def _push_at_row(devices, m, i, y, contact, out):
    at = attitude(m, y, contact, devices.level)
    for j in range(len(devices.elements)):
        of = devices.elements[j]
        if of.height != 0.0:
            out[j] = of.way * recorded_force(of, gap_of(m, of, at, y), devices.states[i, j], 0.0)


@hook
def push_deck_within(devices, m, place, y, out):
    """Write the force to the left [m/s²] of each device on the deck, in state ``y`` at a Place; no other entry of ``out``."""


@push_deck_within.of(type(None))
def _no_push_within(devices, m, place, y, out):
    pass


@push_deck_within.of(RecordedDevices)
def _push_within(devices, m, place, y, out):
    at = attitude(m, y, place.step.contact, devices.level)
    for j in range(len(devices.elements)):
        of = devices.elements[j]
        if of.height != 0.0:
            out[j] = of.way * _pull_within(m, devices, j, at, place, y)[1]


class Stretch(NamedTuple):
    """All that the forces within the step to row ``i`` follow from."""

    m: tuple
    body: Body | float
    pulls: np.ndarray
    devices: RecordedDevices | None
    i: int
    step: Step
    supports: Supports


@kernel
def _moment(of, s):
    """Return the Forces at the share ``s`` of a Stretch."""
    y, ground, place = within(of.m, of.step, s), ground_within(of.step, s), Place(of.i, of.step, s)
    under = under_devices_within(of.devices, of.m, of.pulls, place, y)
    forces = forces_at(under, of.body, Moment(y, of.step.contact, of.supports), ground)
    return _at_base_within(of.devices, of.m, forces, place, y)


@kernel
def _include(extremes, moment, t, gravity):
    """Raise the Extremes to the magnitudes of the Forces of a ``moment`` at about ``t`` [s].

    While N is below its limit the shear counts for the keys, too, and no friction demand is taken. Note when friction first
    exceeds its limit, and when N is first negative.
    """
    limits, greatest, line = extremes.limits, extremes.greatest, extremes.noted[0]
    for j in range(len(greatest)):
        if j != _FRICTION:
            greatest[j] = max(greatest[j], abs(moment[j]))
    if moment.normal < limits.normal:
        line.key_shear = max(line.key_shear, abs(moment.shear))
    else:
        greatest[_FRICTION] = max(greatest[_FRICTION], moment.friction)
        if line.slides == NEVER and moment.friction > limits.friction:
            line.slides = t
    if line.pulls == NEVER and moment.normal < -LIFTED * gravity:
        line.pulls = t


@kernel
def _passes(of, low, high, limit):
    """Return the Forces, between the shares ``low`` and ``high`` of a Stretch, where N passes ``limit``, on its upper side."""
    above_limit = _moment(of, high)
    rises = above_limit.normal >= limit
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        there = _moment(of, middle)
        above = there.normal >= limit
        if above:
            above_limit = there
        low, high = (low, middle) if above == rises else (middle, high)
    return above_limit


@kernel
def _turning(start, middle, end):
    """Return the share of a step at which the parabola through three values turns inside it, and its value there.

    Else 0.5 and ``middle``.
    """
    slope, bend = end - start, start + end - 2.0 * middle
    if not abs(slope) < 2.0 * abs(bend) < math.inf:
        return 0.5, middle
    return 0.5 - slope / (4.0 * bend), middle - slope * slope / (8.0 * bend)


@kernel
def _look_within(of, t, before, now, extremes):
    """Raise the Extremes to the inside of a Stretch until ``t`` [s], with the Forces ``before`` and ``now`` at its ends."""
    gravity, (limits, greatest, noted) = of.m.gravity, extremes
    middle = _moment(of, 0.5)
    _include(extremes, middle, t, gravity)
    for s in fastest_heels(of.m, of.step):
        if s != 0.0:
            _include(extremes, _moment(of, s), t, gravity)
    for j in range(len(greatest)):
        s, promised = _turning(before[j], middle[j], now[j])
        keys = j == _SHEAR and middle.normal < limits.normal
        if s != 0.5 and abs(promised) > (noted[0].key_shear if keys else greatest[j]):
            turns = _moment(of, s)
            _include(extremes, turns, t, gravity)
    half, (s, promised) = 0.5, _turning(before.normal, middle.normal, now.normal)
    if promised < min(limits.normal, middle.normal):  # N dips below its limit between the ends
        half, middle = s, _moment(of, s)
        _include(extremes, middle, t, gravity)
    for low, high, first, last in ((0.0, half, before, middle), (half, 1.0, middle, now)):
        if (first.normal < limits.normal) != (last.normal < limits.normal):
            passes = _passes(of, low, high, limits.normal)
            _include(extremes, passes, t, gravity)
            noted[0].key_shear = max(noted[0].key_shear, abs(passes.shear))  # a moment before or after it, N is below


@kernel
def _put(out, i, forces):
    line = out[i]
    line.shear, line.normal, line.moment = forces.shear, forces.normal, forces.moment
    line.left, line.right = forces.left, forces.right
    line.gap_left, line.gap_right = forces.gap_left, forces.gap_right
    line.speed_left, line.speed_right = forces.speed_left, forces.speed_right
    line.deck, line.along, line.up, line.omega = forces.deck, forces.along, forces.up, forces.omega
    line.friction, line.clearance = forces.friction, forces.clearance


@entry
def forces_of_run(m, body, run, extremes, out):
    """Compute the forces of a run at every row, or the greatest of the whole run.

    Parameters
    ----------
    m : Springs, Footing, Block or FlexibleBlock
    body : float or Body
        Of Springs and Footing the height of the deck above the base [m].
    run : RecordedRun
        With both sides of every event.
    extremes : Extremes
        Filled unless its ``greatest`` has no room.
    out : recarray of Forces, shape (n,) or (0,)
        Filled at every row, unless it has none.
    """
    rows, pulls, devices, ground, dt = run
    limits, greatest, noted = extremes
    supports, aloft = Supports(limits.unstressed, limits.unstressed, -1.0, -1.0), 0.0
    was = contact_of(m, rows[0])
    begin_at(m, state_of(m, rows[0]))
    under, first = with_pull(m, Pull(pulls[0, 0], pulls[0, 1])), state_of(m, rows[0])
    shaking = Ground(ground[0, 0], ground[0, 1], ground[0, 2], ground[0, 3])
    before = forces_at(under, body, Moment(first, was, supports), shaking)
    before = _at_base(devices, m, before, 0, first, was)
    for i in range(len(rows)):
        y, contact, t = state_of(m, rows[i]), contact_of(m, rows[i]), rows[i].t
        supports = waiting(m, y, was, contact, supports)
        was = contact
        t_start = rows[i - 1].t if i > 0 else t
        under_start, under = under, with_pull(m, Pull(pulls[i, 0], pulls[i, 1]))
        shaking = ground_at(ground, dt, 0.5 * (t_start + t), t)
        now = _at_base(devices, m, forces_at(under, body, Moment(y, contact, supports), shaking), i, y, contact)
        if len(out) > 0:
            _put(out, i, now)
        if len(greatest) == 0:
            if i > 0:
                remember(m, state_of(m, rows[i - 1]), y, t - t_start)
            continue
        _include(extremes, now, t, m.gravity)
        if t > t_start and rows[i].kind <= 0.0:
            step = step_between(under_start, under, rows[i - 1], rows[i], ground, dt)
            of = Stretch(m, body, pulls, devices, i, step, supports)
            _look_within(of, t, before, now, extremes)
            remember(m, step.start, y, step.length)
        aloft = aloft + (t - t_start) if airborne(m, contact) else 0.0
        noted[0].longest_flight = max(noted[0].longest_flight, aloft)
        before = now
