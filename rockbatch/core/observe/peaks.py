"""Forces of a recorded run, at its rows and the greatest of all (THEORY.md, Forces).

An observer, like the ledger: runs that do not ask for it pay nothing. Forces follow from the state at any share of a step. Each
step is looked at in its middle too, and where a parabola through the three moments promises a greater peak: what is taken
is the force of the state there, never the parabola's own value, which may lie beyond all that occurs where a law is steep.
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
from rockbatch.core.kernel import entry, kernel, question
from rockbatch.core.observe.forces import LIFTED, Body, Forces, fastest_heels, forces_at, waiting
from rockbatch.core.observe.rows import (
    Step,
    contact_of,
    cubic,
    ground_at,
    ground_within,
    state_of,
    step_between,
    within,
)
from rockbatch.core.springs.model import Supports
from rockbatch.core.system import airborne, pulled
from rockbatch.core.table import record
from rockbatch.core.types import Pull

NEVER = -1.0
"""Time of what does not happen."""

BISECTIONS = 40
"""Of a step in which the normal force passes its limit."""

_FRICTION, _SHEAR = Forces._fields.index("friction"), Forces._fields.index("shear")


class Limits(NamedTuple):
    """Limits that the moments of a run are held against."""

    friction: float  # coefficient of the interface, infinite where it is not known
    normal: float  # N/M below which friction counts for nothing [m/s²]
    unstressed: float  # where the supports of pivots that are free at the start wait [m]


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


@kernel
def _state_within(m, of, was, now, level, step, s):
    """Return the state of an element at the share ``s`` of a step, from its states ``was`` and ``now`` at the ends."""
    if of.kind not in (HYSTERETIC, MAXWELL):
        return was + s * (now - was)
    start = gap_of(m, of, attitude(m, step.start, level), step.start)
    end = gap_of(m, of, attitude(m, step.end, level), step.end)
    rate = response(of, start.elongation, start.speed, was, TAUT, math.copysign(1.0, start.speed)).state_rate
    rate_end = response(of, end.elongation, end.speed, now, TAUT, math.copysign(1.0, end.speed)).state_rate
    return cubic(was, rate, now, rate_end, step.length, s)


@kernel
def recorded_force(of, here, state, goes):
    """Return the force [m/s²] of an element whose Gap is ``here``, in the mode that its elongation and state ask for."""
    if of.kind == CONTACT:
        return stop_force(of, here.elongation, state)
    pull = force(of, here.elongation, here.speed, state, TAUT, goes)
    return min(max(pull, 0.0), of.strength) if of.kind == TENDON else pull


@kernel
def _by_laws(m, devices, i, step, y, s):
    """Return the Pull, in state ``y`` at the share ``s`` of the step to row ``i``, of all that has a law: not of friction."""
    total, moment, at = 0.0, 0.0, attitude(m, y, devices.level)
    for j in range(len(devices.elements)):
        of = devices.elements[j]
        if of.kind == FRICTION:
            continue
        here = gap_of(m, of, at, y)
        x = _state_within(m, of, devices.states[i - 1, j], devices.states[i, j], devices.level, step, s)
        pull = recorded_force(of, here, x, 0.0)
        total += pull * here.by_v
        moment += pull * here.arm
    return Pull(total, moment)


@question
def _under_devices(devices, m, pulls, i, step, y, s):
    """Return the pier under the pull of its devices in state ``y``, at the share ``s`` of the step to row ``i``."""


@_under_devices.of(type(None))
def _without_devices(devices, m, pulls, i, step, y, s):
    return pulled(m, 0.0, 0.0)


@_under_devices.of(RecordedDevices)
def _with_devices(devices, m, pulls, i, step, y, s):
    """Use the devices' laws, and what friction adds to them at both ends, linear between."""
    start, now, end = (
        _by_laws(m, devices, i, step, step.start, 0.0),
        _by_laws(m, devices, i, step, y, s),
        _by_laws(m, devices, i, step, step.end, 1.0),
    )
    rubs, rubs_end = pulls[i - 1, 0] - start.force, pulls[i, 0] - end.force
    turns, turns_end = pulls[i - 1, 1] - start.moment, pulls[i, 1] - end.moment
    return pulled(m, now.force + rubs + s * (rubs_end - rubs), now.moment + turns + s * (turns_end - turns))


@kernel
def _with_across(forces, gravity, shear, moment):
    """Return the Forces with a ``shear`` [m/s²] and a ``moment`` [m²/s²] that the deck's neighbours take, not the base."""
    base = forces.shear + shear
    friction = abs(base) / forces.normal if forces.normal > LIFTED * gravity else math.inf
    return Forces(
        base, forces.normal, forces.moment - moment, forces.left, forces.right, forces.gap_left, forces.gap_right,
        forces.speed_left, forces.speed_right, forces.deck, forces.along, forces.up, forces.omega, friction, forces.clearance,
    )  # fmt: skip


@question
def _at_base(devices, m, forces, i, y):
    """Return the Forces at row ``i`` in state ``y`` without what devices on the deck take."""


@_at_base.of(type(None))
def _all_at_base(devices, m, forces, i, y):
    return forces


@_at_base.of(RecordedDevices)
def _less_deck(devices, m, forces, i, y):
    shear, moment, at, some = 0.0, 0.0, attitude(m, y, devices.level), False
    for j in range(len(devices.elements)):
        of = devices.elements[j]
        if of.height != 0.0:
            here, some = gap_of(m, of, at, y), True
            pull = recorded_force(of, here, devices.states[i, j], 0.0)
            shear, moment = shear + of.way * pull, moment + pull * here.by_theta
    return _with_across(forces, m.gravity, shear, moment) if some else forces


@question
def _at_base_within(devices, m, forces, i, step, y, s):
    """Return the Forces in state ``y`` at the share ``s`` of the step to row ``i``, without what devices on the deck take."""


@_at_base_within.of(type(None))
def _all_within(devices, m, forces, i, step, y, s):
    return forces


@_at_base_within.of(RecordedDevices)
def _less_deck_within(devices, m, forces, i, step, y, s):
    shear, moment, at, some = 0.0, 0.0, attitude(m, y, devices.level), False
    for j in range(len(devices.elements)):
        of = devices.elements[j]
        if of.height != 0.0:
            here, some = gap_of(m, of, at, y), True
            x = _state_within(m, of, devices.states[i - 1, j], devices.states[i, j], devices.level, step, s)
            pull = recorded_force(of, here, x, 0.0)
            shear, moment = shear + of.way * pull, moment + pull * here.by_theta
    return _with_across(forces, m.gravity, shear, moment) if some else forces


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
    y, (horizontal, vertical) = within(of.m, of.step, s), ground_within(of.step, s)
    under = _under_devices(of.devices, of.m, of.pulls, of.i, of.step, y, s)
    forces = forces_at(under, of.body, y, of.step.contact, of.supports, horizontal, vertical)
    return _at_base_within(of.devices, of.m, forces, of.i, of.step, y, s)


@kernel
def _include(greatest, noted, moment, t, limits, gravity):
    """Bring the greatest magnitudes, and what is noted beside them, up to a moment at about ``t`` [s]."""
    line = noted[0]
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
    """Return the Forces, between the shares ``low`` and ``high`` of a Stretch, where N passes ``limit`` and is just above it."""
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
    """Return the share of a step at which the parabola through three values turns, and its value there; else 0.5, ``middle``."""
    slope, bend = end - start, start + end - 2.0 * middle
    if not abs(slope) < 2.0 * abs(bend) < math.inf:
        return 0.5, middle
    return 0.5 - slope / (4.0 * bend), middle - slope * slope / (8.0 * bend)


@kernel
def _look_within(of, t, before, now, limits, greatest, noted):
    """Bring the greatest up to the inside of a Stretch until ``t``, with the forces ``before`` and ``now`` at its ends."""
    gravity = of.m.gravity
    middle = _moment(of, 0.5)
    _include(greatest, noted, middle, t, limits, gravity)
    for s in fastest_heels(of.m, of.step):
        if s != 0.0:
            _include(greatest, noted, _moment(of, s), t, limits, gravity)
    for j in range(len(greatest)):
        s, promised = _turning(before[j], middle[j], now[j])
        keys = j == _SHEAR and middle.normal < limits.normal
        if s != 0.5 and abs(promised) > (noted[0].key_shear if keys else greatest[j]):
            turns = _moment(of, s)
            _include(greatest, noted, turns, t, limits, gravity)
    half, (s, promised) = 0.5, _turning(before.normal, middle.normal, now.normal)
    if promised < min(limits.normal, middle.normal):  # N dips below its limit between the ends
        half, middle = s, _moment(of, s)
        _include(greatest, noted, middle, t, limits, gravity)
    for low, high, first, last in ((0.0, half, before, middle), (half, 1.0, middle, now)):
        if (first.normal < limits.normal) != (last.normal < limits.normal):
            passes = _passes(of, low, high, limits.normal)
            _include(greatest, noted, passes, t, limits, gravity)
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
def forces_of_run(m, body, run, ground, dt, limits, out, greatest, noted):
    """Compute the forces of a run at every row, or the greatest of the whole run.

    Parameters
    ----------
    m : Springs or Block
    body : float or Body
        Of Springs the height of the deck above the pivots [m].
    run : RecordedRun
        With both sides of every event.
    ground : ndarray, shape (npts, 4)
        The motion of the run, of :func:`rockbatch.core.ground.ground_rows`.
    dt : float
        Its sampling interval [s].
    limits : Limits
    out : recarray of Forces, shape (n,) or (0,)
        Filled at every row.
    greatest : ndarray of zeros, shape (fields of Forces,) or (0,)
        Filled with the greatest magnitude of each of Forces, at the rows and between; of friction while N is above its limit.
    noted : recarray of Noted, shape (1,)
        Filled beside ``greatest``.
    """
    rows, pulls, devices = run.rows, run.pulls, run.devices
    supports, aloft = Supports(limits.unstressed, limits.unstressed, -1.0, -1.0), 0.0
    was = contact_of(m, rows[0])
    under = pulled(m, pulls[0, 0], pulls[0, 1])
    before = forces_at(under, body, state_of(m, rows[0]), was, supports, ground[0, 0], ground[0, 2])
    before = _at_base(devices, m, before, 0, state_of(m, rows[0]))
    for i in range(len(rows)):
        y, contact, t = state_of(m, rows[i]), contact_of(m, rows[i]), rows[i].t
        supports = waiting(m, y, was, contact, supports)
        was = contact
        t_start = rows[i - 1].t if i > 0 else t
        ah, av = ground_at(ground, dt, 0.5 * (t_start + t), t)
        under_start, under = under, pulled(m, pulls[i, 0], pulls[i, 1])
        now = _at_base(devices, m, forces_at(under, body, y, contact, supports, ah, av), i, y)
        if len(out) > 0:
            _put(out, i, now)
        if len(greatest) == 0:
            continue
        _include(greatest, noted, now, t, limits, m.gravity)
        if t > t_start and rows[i].kind <= 0.0:
            step = step_between(under_start, under, rows[i - 1], rows[i], ground, dt)
            of = Stretch(m, body, pulls, devices, i, step, supports)
            _look_within(of, t, before, now, limits, greatest, noted)
        aloft = aloft + (t - t_start) if airborne(m, contact) else 0.0
        noted[0].longest_flight = max(noted[0].longest_flight, aloft)
        before = now
