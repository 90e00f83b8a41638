"""Runs of a pier on two springs with dampers and tendons, one at a time (THEORY.md, Dampers and tendons).

What a run is while it is under way stands in the first of the lanes (``rockbatch.core.lanes``), which begin it, watch its
extremes, and decide when it is over, as they do of a pier without elements. Steps, and the search for events, are scalar.
"""

import math
from typing import NamedTuple

import numpy as np

from rockbatch.core.ending import base_of, done
from rockbatch.core.ground import ground_rows
from rockbatch.core.happening import happen, include
from rockbatch.core.kernel import entry, kernel
from rockbatch.core.lanes import contact_of, ground_of, model_of, put_state, state, supports_of, table
from rockbatch.core.outcome import fallen
from rockbatch.core.recording import LINE, RESULT, write
from rockbatch.core.restrained.elements import ELEMENT, HYSTERETIC, STICKS, TENDON, USE, VISCOUS, force, stored
from rockbatch.core.restrained_springs.equations import Ties, gap, lifted, longest, under_elements
from rockbatch.core.restrained_springs.events import (
    NONE,
    OF_ELEMENTS,
    after_contact,
    happen_to_element,
    piece,
    settle_friction,
    start_elements,
)
from rockbatch.core.roots import largest_within
from rockbatch.core.two_springs import begin, finish, put_ground, spring_run, traits_of, turn_window
from rockbatch.core.types import CHATTER, RUNNING, SAMPLE, STEP, SURVIVED, SpringRun, State

MOST_EVENTS = 20_000
"""In a sample, of elements."""

OF_A_ROW = 2
"""What a row of ``notes`` has beside x: force [m/s²] and moment [m²/s²] of all elements."""


class Course(NamedTuple):
    """What the elements of a run go through while it is under way."""

    ties: Ties
    use: np.recarray  # of Use
    x: np.ndarray  # states, energies taken, work of the ground, P–Δ of the elements
    end: np.ndarray  # the same at the end of a piece
    work: np.ndarray  # shape (2, len(x))
    marks: np.ndarray  # shape (6, signals)
    notes: np.ndarray  # shape (rows of the history, len(x) + 2)


@kernel
def _at_rest(course, level):
    """``course`` of a pier that is at rest at v = ``level`` [m]."""
    ties = course.ties
    ties = Ties(ties.elements, level, ties.modes, ties.goes)
    return Course(ties, course.use, course.x, course.end, course.work, course.marks, course.notes)


@kernel
def _note(m, course, row, y, contact, ground):
    """What the elements are at a row of the history."""
    if not 0 <= row < len(course.notes):
        return
    under, _, _ = under_elements(m, course.ties, y, course.x, contact, ground.horizontal, ground.vertical)
    line = course.notes[row]
    for i in range(len(course.x)):
        line[i] = course.x[i]
    line[len(course.x)], line[len(course.x) + 1] = under.pull.force, under.pull.moment


@kernel
def _write(lanes, m, course, history, row, t, kind, ground):
    """A row of the history with its notes, of what stands in the lane; the next row."""
    y, contact = state(lanes.now, 0), contact_of(lanes, 0)
    _note(m, course, row, y, contact, ground)
    return write(history, row, t, y, contact, kind)


@kernel
def _take_in(m, course, y, k, end, k_end, h):
    """What the elements have been through in a piece of ``h`` [s]."""
    n = len(course.ties.elements)
    for j in range(n):
        of, line = course.ties.elements[j], course.use[j]
        was, now = gap(m, of, y, course.ties.level), gap(m, of, end, course.ties.level)
        line.stroke = largest_within(was.elongation, was.speed, now.elongation, now.speed, h, line.stroke)[1]
        lift, lift_end = lifted(y, was, k.v_rate, k.omega), lifted(end, now, k_end.v_rate, k_end.omega)
        found, fastest = largest_within(was.speed, lift, now.speed, lift_end, h, line.speed)
        line.speed = fastest
        pull = force(of, now.elongation, now.speed, course.end[j], course.ties.modes[j], course.ties.goes[j])
        if of.kind == VISCOUS and found >= 0.0:
            pull = math.copysign(of.coefficient * fastest**of.exponent, course.ties.goes[j])
        line.most, line.least = max(line.most, pull), min(line.least, pull)
        line.lost = course.end[n + j]
        line.yielded = course.end[j] if of.kind == TENDON else 0.0


@kernel
def _in_elements(lanes, m, course, y):
    """The load [m/s²] that supports carry at rest, and the energy [J/kg] that elements may give back beyond its work.

    A tendon's force falls with its elongation or stays: its energy lies above the tangent at any elongation, and that where
    the base has come to is as good as any. Hysteretic dampers give back what they have stored elastically.
    """
    left, right = base_of(lanes, 0, m)
    sunk = 0.5 * (left + right) - lanes.motion.plastic[0]
    load, beyond, turning = m.gravity, 0.0, 0.0
    for j in range(len(course.ties.elements)):
        of, plastic = course.ties.elements[j], course.x[j]
        if of.kind == HYSTERETIC:
            beyond += 0.5 * of.strength * plastic * plastic / of.stiffness
        if of.kind != TENDON:
            continue
        resting = gap(m, of, State(course.ties.level + sunk, 0.0, 0.0, 0.0, 0.0, 0.0), course.ties.level).elongation
        pull = force(of, resting, 0.0, plastic, 0.0, 0.0)
        pull = min(max(pull, 0.0), of.strength)
        now = gap(m, of, y, course.ties.level).elongation
        beyond += stored(of, now, plastic) - stored(of, resting, plastic) - pull * (now - resting)
        load += pull
        turning += pull * of.offset
    return load, max(beyond, 0.0) + abs(turning) * (abs(y.theta) + lanes.extremes.peak[0])


@kernel
def _event(lanes, m, course, which, t, x, ground, every_step, history, row):
    """Event ``which`` at ``t`` [s], ``x`` [s] after the sample, in the state that stands in the lane: status and next row."""
    y, contact, rest = state(lanes.now, 0), contact_of(lanes, 0), lanes.motion.rest[0]
    here = ground_of(lanes, 0, x)
    a, c = here.horizontal, here.vertical
    if which >= OF_ELEMENTS:
        if every_step:
            row = _write(lanes, m, course, history, row, t, STEP, here)
        h = lanes.clock.step[0]
        slack = happen_to_element(m, course.ties, y, course.x, contact, here, h, course.work, which)
        course.use[(which - OF_ELEMENTS) // 3].slack += 1.0 if slack else 0.0
        if every_step:
            row = _write(lanes, m, course, history, row, t, STEP, here)
        return SURVIVED, row
    under, _, _ = under_elements(m, course.ties, y, course.x, contact, a, c)
    _note(m, course, row, y, contact, here)
    status, after, row = happen(lanes, 0, under, y, contact, which, t, x, ground, history, row)
    y = state(lanes.now, 0)
    after_contact(m, course.ties, y, course.x, after, rest, a, c)
    _note(m, course, row - 1, y, after, here)
    return status, row


@kernel
def _step(lanes, m, course, ground, sub, every_step, history, row):
    """A step of the run, piece by piece: status (SURVIVED while it goes on), time [s] and next row of the history."""
    h, t_sample = lanes.clock.step[0], lanes.clock.sample_time[0]
    start, done_so_far, events = sub * h, 0.0, 0
    while done_so_far < h:
        y, contact, supports = state(lanes.now, 0), contact_of(lanes, 0), supports_of(lanes, 0)
        x, left = start + done_so_far, h - done_so_far
        here, dt = ground_of(lanes, 0, x), lanes.clock.dt[0]
        most = min(left, longest(m, course.ties, y, course.x, contact, here, h, dt))
        used, which, end, k, k_end = piece(
            m, course.ties, y, course.x, contact, supports, lanes.motion.rest[0], here, most,
            course.work, course.marks, course.end,
        )  # fmt: skip
        include(lanes, 0, m, y, end, contact, t_sample + x, used)
        _take_in(m, course, y, k, end, k_end, used)
        for i in range(len(course.x)):
            course.x[i] = course.end[i]
        put_state(lanes.now, 0, end)
        done_so_far = done_so_far + used if used < left else h
        if which != NONE:
            t = t_sample + start + done_so_far
            status, row = _event(lanes, m, course, which, t, start + done_so_far, ground, every_step, history, row)
            events += 1
            if status == SURVIVED and events > MOST_EVENTS:
                status = CHATTER
            if status != SURVIVED:
                return status, t, row
        elif every_step and done_so_far < h:
            x = start + done_so_far
            row = _write(lanes, m, course, history, row, t_sample + x, STEP, ground_of(lanes, 0, x))
    return fallen(lanes.now.theta[0]), t_sample + start + h, row


@entry
def _rock(traits, runs, course, ground, stop, every_step, history, lanes_table, results):
    """The run, as :func:`rock_restrained_on_springs` has it."""
    lanes = lanes_table[0]
    begin(lanes, 0, np.int64(0), runs, ground, traits, True)
    m = model_of(lanes, 0, traits)
    y, contact = state(lanes.now, 0), contact_of(lanes, 0)
    course, under = _at_rest(course, y.v), ground_of(lanes, 0, 0.0)
    start_elements(m, course.ties, y, course.x)
    settle_friction(m, course.ties, y, course.x, contact, under.horizontal, under.vertical)
    lanes.counts.moved[0] = math.inf  # what rocks and what vibrates are not told apart where elements couple them
    row = _write(lanes, m, course, history, np.int64(0), 0.0, SAMPLE, under)
    status, t = done(lanes, 0, traits), 0.0
    while status == RUNNING and stop[0] == 0:
        substeps = int(lanes.clock.substeps[0])
        for sub in range(substeps):
            status, t, row = _step(lanes, m, course, ground, sub, every_step, history, row)
            if status != SURVIVED or (every_step and sub < substeps - 1):
                here = ground_of(lanes, 0, (sub + 1) * lanes.clock.step[0])
                row = _write(lanes, m, course, history, row, t, STEP, here)
            if status != SURVIVED:
                break
        if status == SURVIVED:
            lanes.clock.sample[0] += 1.0
            t = lanes.clock.sample_time[0] = lanes.clock.sample[0] * lanes.clock.dt[0]
            put_ground(lanes, 0, ground)
            here = ground_of(lanes, 0, 0.0)
            y, contact = state(lanes.now, 0), contact_of(lanes, 0)
            settle_friction(m, course.ties, y, course.x, contact, here.horizontal, here.vertical)
            row = _write(lanes, m, course, history, row, t, SAMPLE, here)
            turn_window(lanes, 0, results)
            lanes.counts.moved[0] = math.inf
            lanes.waiting.load[0], lanes.waiting.stored[0] = _in_elements(lanes, m, course, y)
            status = done(lanes, 0, traits)
    if stop[0] == 0:
        finish(lanes, 0, traits, status, t, row, results)


class RestrainedOnSprings(NamedTuple):
    """What a run comes to."""

    run: SpringRun | None  # None where it was stopped
    extremes: np.ndarray  # shape (WINDOWS,), greatest |θ| at a sample in each part of the run
    use: np.recarray  # of Use, one of each element
    notes: np.ndarray  # of the history's rows: x (``equations``), then force [m/s²] and moment [m²/s²] of all elements
    end: State
    contact: tuple  # of both pivots at the end
    states: np.ndarray  # of the elements at the end
    holds: np.ndarray  # whether each is a friction damper that does not move then
    level: float  # v at rest at the start [m]


def rock_restrained_on_springs(m, line, elements, motion, stop, history, every_step=False):
    """One run of the pier ``m`` (Springs) with ``elements``.

    Parameters
    ----------
    line : tuple
        Of :func:`rockbatch.core.two_springs.run_line`, with the prestress.
    elements : sequence of Element
    motion : (horizontal, vertical, dt)
        Ground accelerations [m/s²], shape (npts,), the vertical ones may be empty; sampling interval [s].
    stop : ndarray of one uint8
        Ends it at once when another thread sets it.
    history : recarray of Row
        Filled with every sample and both sides of every event at a pivot, as far as it goes.
    every_step : bool
        Also write the steps between samples.
    """
    horizontal, vertical, dt = motion
    n = len(elements)
    size = 2 * n + 2
    results = np.recarray(1, RESULT)
    results.status, results.extremes = RUNNING, np.nan
    lanes, _ = table()
    ties = Ties(np.array([tuple(each) for each in elements], ELEMENT).view(np.recarray), 0.0, np.zeros(n), np.zeros(n))
    course = Course(
        ties,
        use=np.zeros(n, USE).view(np.recarray),
        x=np.zeros(size),
        end=np.zeros(size),
        work=np.zeros((2, size)),
        marks=np.zeros((6, OF_ELEMENTS + 3 * n)),
        notes=np.zeros((len(history), size + OF_A_ROW)),
    )
    lines = np.array([line], LINE).view(np.recarray)
    ground = ground_rows(horizontal, vertical, dt)
    _rock(traits_of(m), lines, course, ground, stop, every_step, history, lanes, results)
    run = None if results[0].status == RUNNING else spring_run(results[0])
    now, contact = lanes[0].now, lanes[0].contact
    return RestrainedOnSprings(
        run,
        results[0].extremes,
        course.use,
        course.notes,
        State(*(float(now[name][0]) for name in State._fields)),
        (float(contact.left[0]), float(contact.right[0])),
        course.x[:n].copy(),
        ties.goes == STICKS,
        float(lanes[0].motion.plastic[0] - 0.5 * m.yield_deflection * (m.gravity + line.prestress) / m.yield_force),
    )
