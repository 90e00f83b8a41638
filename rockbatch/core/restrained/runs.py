"""Runs of a block on a rigid base with dampers and tendons, one at a time (THEORY.md, Dampers and tendons).

Simpler than the lanes, which know nothing of elements: every step is scalar, from event to event.
"""

import math
from typing import NamedTuple

import numpy as np

from rockbatch.core.ground import ground_rows
from rockbatch.core.kernel import entry, kernel
from rockbatch.core.outcome import WINDOWS, fallen, widen
from rockbatch.core.restrained.elements import (
    CLOSES,
    ELEMENT,
    OPENS,
    SLACK,
    STICKS,
    TENDON,
    USE,
    VISCOUS,
    distance,
    draws,
    force,
)
from rockbatch.core.restrained.equations import acceleration, copy, friction_bound, longest
from rockbatch.core.restrained.events import (
    LANDS,
    OF_TENDONS,
    TURNS,
    change_tendon,
    direction,
    piece,
    released,
    set_modes,
)
from rockbatch.core.rigid.equations import carried_until, later
from rockbatch.core.roots import largest_within
from rockbatch.core.types import (
    BEFORE_EVENT,
    CHATTER,
    FLIGHT,
    IMPACT_LEFT,
    IMPACT_RIGHT,
    LEFT,
    LIFT_OFF,
    NEITHER,
    REST,
    RESTLESS,
    RIGHT,
    RUNNING,
    SAMPLE,
    STEP,
    SURVIVED,
    UNDECIDED,
    Ground,
    RigidRun,
)

EVENTS_IN_A_SAMPLE = 20_000
NEGLIGIBLE = 1e-13  # of α: height of the bounces that are summed up instead of followed

TRACE = 1e-300
"""Of a velocity [rad/s], whose sign tells where a block went that is turning."""

COLUMNS = 4
"""Of a history before the states of the elements: t [s], θ [rad], θ̇ [rad/s], kind of the row (``types``); then the states, what
each element has lost [J/kg], and the work of the ground [J/kg]."""


class Timing(NamedTuple):
    """How long a run is and how fine."""

    dt: float  # sampling interval [s]
    substeps: int
    samples: int  # of record and quiet time
    longest: int  # sample at which the block is no longer waited for


class Journal(NamedTuple):
    """Numbers of a run that are written again and again, shape (1,) each."""

    side: np.ndarray
    goes: np.ndarray
    peak: np.ndarray
    t_peak: np.ndarray
    impacts: np.ndarray
    lift_offs: np.ndarray
    events: np.ndarray
    turned: np.ndarray
    t_rest: np.ndarray
    row: np.ndarray


@kernel
def _write(history, log, t, y, kind):
    row = int(log.row[0])
    log.row[0] = row + 1
    if row < len(history):
        line = history[row]
        line[0], line[1], line[2], line[3] = t, log.side[0] * y[0], log.side[0] * y[1], kind
        for i in range(2, len(y)):
            line[COLUMNS - 2 + i] = y[i]


@kernel
def _take_in(m, elements, inertia, y, end, modes, log, ground, h, t, use, work):
    """The peak and what the elements have been through in a piece of ``h`` [s] from ``y``, at ``t`` [s], to ``end``."""
    side, goes = log.side[0], log.goes[0]
    found, peak = largest_within(y[0], y[1], end[0], end[1], h, log.peak[0])
    if found >= 0.0:
        log.peak[0], log.t_peak[0] = peak, t + found
    later_on = later(ground, h)
    turn = acceleration(m, elements, inertia, side, y, modes, goes, ground.horizontal, ground.vertical)
    turn_end = acceleration(m, elements, inertia, side, end, modes, goes, later_on.horizontal, later_on.vertical)
    for j in range(len(elements)):
        of, line = elements[j], use[j]
        d = distance(of, side)
        speeds = d * math.cos(0.5 * y[0]) * y[1], d * math.cos(0.5 * end[0]) * end[1]
        bends = (
            d * (math.cos(0.5 * y[0]) * turn - 0.5 * math.sin(0.5 * y[0]) * y[1] * y[1]),
            d * (math.cos(0.5 * end[0]) * turn_end - 0.5 * math.sin(0.5 * end[0]) * end[1] * end[1]),
        )
        line.speed = largest_within(speeds[0], bends[0], speeds[1], bends[1], h, max(line.speed, abs(speeds[0])))[1]
        elongation = 2.0 * d * math.sin(0.5 * end[0])
        line.stroke = max(line.stroke, abs(elongation))
        way = draws(of, side, goes)
        pull = force(of, elongation, speeds[1], end[2 + j], modes[j], way)
        if of.kind == VISCOUS:
            fastest = of.coefficient * line.speed**of.exponent
            line.most = max(line.most, fastest if way == OPENS else 0.0)
            line.least = min(line.least, -fastest if way == CLOSES else 0.0)
        line.most, line.least = max(line.most, pull), min(line.least, pull)
        line.lost = end[2 + len(elements) + j]
        line.yielded = end[2 + j] if of.kind == TENDON else 0.0


@kernel
def _rest(m, elements, inertia, y, modes, log, ground, t, left, history):
    """The block on both corners until it lifts off, ``left`` [s] at most: how long that is."""
    first, corner = -1.0, RIGHT
    for side in (RIGHT, LEFT):
        set_modes(elements, side, y, modes, OPENS)
        at, _ = released(m, elements, inertia, side, y, modes, ground, left)
        if at >= 0.0 and (first < 0.0 or at < first):
            first, corner = at, side
    if first < 0.0 or first >= left:
        return left
    log.side[0], log.goes[0] = corner, OPENS
    log.lift_offs[0] += 1.0
    log.t_rest[0] = math.nan
    set_modes(elements, corner, y, modes, OPENS)
    _write(history, log, t + first, y, LIFT_OFF)
    return first


@kernel
def _bounces(m, elements, inertia, y, modes, side, speed, e, ground):
    """Height [rad] of the next bounce, and the time [s] of all that are left, if the ground allows rest; infinite if not.

    Small bounces see a constant acceleration towards rest, friction added while they open and taken off while they close.
    """
    ways = (side, -side)
    times, ratios, height = 0.0, 1.0, 0.0
    v = speed
    for corner in ways:
        free = -acceleration(m, elements, inertia, corner, y, modes, STICKS, ground.horizontal, ground.vertical)
        bound = friction_bound(elements, inertia, corner, 0.0)
        if free - bound <= 0.0 or e == 1.0:
            return math.inf, math.inf
        height = max(height, 0.5 * v * v / (free + bound))
        back = v * math.sqrt((free - bound) / (free + bound))
        times += v / (free + bound) + back / (free - bound)
        ratios *= e * back / v
        v = e * back
    return height, times / (1.0 - ratios)


@kernel
def _land(m, elements, inertia, y, modes, log, ground, t, dt, history):
    """Impact at ``t`` [s]: the block goes on about its other corner, or rests."""
    y[0] = 0.0
    _write(history, log, t, y, BEFORE_EVENT)
    came, speed = log.side[0], -m.restitution * y[1]
    log.impacts[0] += 1.0
    side, kind = -came, IMPACT_LEFT if came == RIGHT else IMPACT_RIGHT
    y[1] = 0.0
    set_modes(elements, side, y, modes, OPENS)
    height, remaining = 0.0, 0.0
    if speed > 0.0:
        height, remaining = _bounces(m, elements, inertia, y, modes, side, speed, m.restitution, ground)
    if speed <= 0.0 or (height < NEGLIGIBLE * m.alpha and remaining < dt):
        log.t_rest[0] = t + remaining
        log.side[0], log.goes[0], kind = NEITHER, STICKS, REST
    else:
        y[1] = speed
        log.side[0], log.goes[0] = side, OPENS
    _write(history, log, t, y, kind)


@kernel
def _turn(m, elements, inertia, y, modes, log, ground):
    """The block has no velocity: it goes on or back, or friction holds it."""
    y[1] = 0.0
    log.turned[0] += 1.0
    log.goes[0] = direction(m, elements, inertia, log.side[0], y, modes, ground)
    if log.goes[0] != STICKS:
        set_modes(elements, log.side[0], y, modes, log.goes[0])


@kernel
def _move(m, elements, inertia, y, end, modes, log, ground, t, left, h, dt, every_step, history, use, work, marks):
    """The block off its rest for ``left`` [s], or until something happens: how long that is.

    With ``every_step`` both sides of what changes forces at once are written.
    """
    side = log.side[0]
    if log.goes[0] == STICKS:
        at, goes = released(m, elements, inertia, side, y, modes, ground, left)
        if at < 0.0 or at >= left:
            return left
        log.goes[0] = goes
        set_modes(elements, side, y, modes, goes)
        return at
    most = min(left, longest(m, elements, inertia, side, y, modes, log.goes[0], ground, h, dt))
    used, which = piece(m, elements, inertia, side, y, modes, log.goes[0], ground, most, work, marks, end)
    _take_in(m, elements, inertia, y, end, modes, log, ground, used, t, use, work)
    copy(end, y)
    there = later(ground, used)
    if every_step and which >= TURNS:
        if which == TURNS:
            y[1] = log.goes[0] * TRACE
        _write(history, log, t + used, y, STEP)
    if which == LANDS:
        _land(m, elements, inertia, y, modes, log, there, t + used, dt, history)
    elif which == TURNS:
        _turn(m, elements, inertia, y, modes, log, there)
    elif which >= OF_TENDONS:
        j = (which - OF_TENDONS) // 2
        modes[j] = change_tendon(elements[j], modes[j], (which - OF_TENDONS) % 2 == 1)
        use[j].slack += 1.0 if modes[j] == SLACK else 0.0
    if every_step and which >= TURNS:
        _write(history, log, t + used, y, STEP)
    if which >= 0:
        log.events[0] += 1.0
    return used


@kernel
def _over(log, sample, rests, timing):
    """Status at a sample: over once nothing that comes later can exceed the peak.

    Energy is only lost when the ground rests, so that later extremes are lower than the last ones on either side.
    """
    if sample < timing.samples:
        return RUNNING
    if rests and (log.side[0] == NEITHER or log.goes[0] == STICKS or log.turned[0] >= 2.0):
        return SURVIVED
    if sample < timing.longest:
        return RUNNING
    if timing.longest == timing.samples:  # nothing is waited for
        return SURVIVED
    return RESTLESS if log.turned[0] > 0.0 else UNDECIDED


@entry
def _rock(
    m,
    elements,
    inertia,
    theta,
    ground,
    timing,
    every_step,
    stop,
    history,
    log,
    use,
    y,
    end,
    modes,
    work,
    marks,
    extremes,
):
    """Status, end [s] and time of flight [s] of a run from rest at ``theta`` = y[0], or from there without velocity."""
    dt, h = timing.dt, timing.dt / timing.substeps
    still = Ground(0.0, 0.0, 0.0, 0.0)
    npts, sample = len(ground), 0
    rested = False
    while True:
        under = still
        if sample < npts:
            row = ground[sample]
            under = Ground(row[0], row[1], row[2], row[3])
        rests = sample >= npts or (sample == npts - 1 and row[0] == 0.0 and row[2] == 0.0)
        if sample == 0 and theta != 0.0:
            _turn(m, elements, inertia, y, modes, log, under)
        if rests and not rested:
            log.turned[0], rested = 0.0, True
        t_sample = sample * dt
        _write(history, log, t_sample, y, SAMPLE)
        widen(extremes, sample, timing.samples, y[0])
        status = _over(log, sample, rests, timing)
        if status != RUNNING or stop[0] != 0:
            return status, t_sample, math.nan
        until = carried_until(m, under, dt)
        log.events[0] = 0.0
        for sub in range(timing.substeps):
            start = sub * h
            whole, done = min(h, until - start), 0.0
            while done < whole and log.events[0] <= EVENTS_IN_A_SAMPLE:
                here, t, left = later(under, start + done), t_sample + start + done, whole - done
                if log.side[0] == NEITHER:
                    used = _rest(m, elements, inertia, y, modes, log, here, t, left, history)
                else:
                    used = _move(
                        m,
                        elements,
                        inertia,
                        y,
                        end,
                        modes,
                        log,
                        here,
                        t,
                        left,
                        h,
                        dt,
                        every_step,
                        history,
                        use,
                        work,
                        marks,
                    )
                done = done + used if used < left else whole
            t = t_sample + start + done
            status = fallen(y[0])
            if log.events[0] > EVENTS_IN_A_SAMPLE:
                status = CHATTER
            t_flight = math.nan
            if status == SURVIVED and start + h >= until:
                status, t_flight = FLIGHT, t
            if status != SURVIVED:
                _write(history, log, t, y, STEP)
                return status, t, t_flight
            if every_step and sub < timing.substeps - 1:
                _write(history, log, t, y, STEP)
        sample += 1


class Restrained(NamedTuple):
    """What a run comes to."""

    run: RigidRun
    extremes: np.ndarray  # shape (WINDOWS,), greatest |θ| at a sample in each part of the run
    use: np.recarray  # of Use, one of each element
    history: np.ndarray  # shape (rows, COLUMNS + 2 n + 1)
    theta_end: float  # [rad]
    sticks: bool  # friction holds the block there


def rock_restrained(
    m, elements, inertia, motion, substeps, quiet_samples, stop, patience=0, theta=0.0, rows=0, every_step=False
):
    """One run of the block ``m`` (Block) with ``elements``.

    Parameters
    ----------
    elements : sequence of Element
    inertia : float
        About a corner, over the mass: I0/M + R0² [m²].
    motion : (horizontal, vertical, dt)
        Ground accelerations [m/s²], shape (npts,), the vertical ones may be empty; sampling interval [s].
    stop : ndarray of one uint8
        Ends it within a sample when another thread sets it; the status is then RUNNING.
    theta : float
        At the start [rad]; without velocity.
    rows : int
        How many of the history are kept.
    every_step : bool
        Also write the steps between samples.
    """
    horizontal, vertical, dt = motion
    n = len(elements)
    ground = ground_rows(horizontal, vertical, dt)
    samples = len(horizontal) - 1 + quiet_samples
    timing = Timing(float(dt), int(substeps), int(samples), int(samples + patience))
    log = Journal(*(np.zeros(1) for _ in Journal._fields))
    log.side[0], log.goes[0] = np.sign(theta), STICKS
    log.peak[0], log.t_rest[0] = abs(theta), 0.0 if theta == 0.0 else math.nan
    size = 2 + 2 * n + 1
    y, use = np.zeros(size), np.zeros(n, USE).view(np.recarray)
    y[0] = abs(theta)
    extremes = np.full(WINDOWS, math.nan)
    history = np.zeros((rows, COLUMNS + size - 2))
    table = np.array([tuple(each) for each in elements], ELEMENT).view(np.recarray)
    status, t_end, t_flight = _rock(
        m, table, float(inertia), float(theta), ground, timing, bool(every_step), stop, history, log, use, y, np.zeros(size),
        np.zeros(n), np.zeros((6, size)), np.zeros((6, 2 + 2 * n)), extremes,
    )  # fmt: skip
    run = RigidRun(
        status, t_end, float(log.peak[0]), float(log.t_peak[0]), int(log.impacts[0]), int(log.lift_offs[0]), t_flight,
        float(log.t_rest[0]), int(log.row[0]),
    )  # fmt: skip
    return Restrained(run, extremes, use, history, float(log.side[0] * y[0]), bool(log.goes[0] == STICKS))
