"""Runs on two springs, side by side: fixed steps of Runge–Kutta 4, reversals corrected, contact events located.

A step, or what an event has left of it, is a piece. The lanes' pass takes all of them at once; where it reports that
something may have happened, the piece is looked at: it stands, or a shorter one is tried until its end is the event's
time (``search``), and then the event happens (``happening``).
"""

import math

import numpy as np

from rockbatch.core.ending import base_of, done, expect, next_due
from rockbatch.core.equations import rates
from rockbatch.core.events import at_rest
from rockbatch.core.ground import ground_rows
from rockbatch.core.happening import close_turned, include, look, write_turns
from rockbatch.core.kernel import entry, inlined, kernel
from rockbatch.core.lanes import (
    CALM,
    DUE,
    EVENTFUL,
    SEARCH,
    TURNED,
    contact_of,
    ground_of,
    loading_of,
    model_of,
    move,
    put_contact,
    put_loading,
    put_state,
    state,
    table,
)
from rockbatch.core.laws import branch_when_pressed, deflection
from rockbatch.core.loading import Loading, branches
from rockbatch.core.one_pass import one_pass
from rockbatch.core.outcome import window_of
from rockbatch.core.recording import LINE, NO_HISTORY, RESULT, Line, write
from rockbatch.core.records import LANES
from rockbatch.core.search import ready, seek_turn
from rockbatch.core.transitions import Supports
from rockbatch.core.types import RUNNING, SAMPLE, SURVIVED, Contact, SpringRun, State, Traits
from rockbatch.core.types import STEP as BETWEEN_SAMPLES

NONE = np.int64(0)  # a literal 0 would have every function that it is handed to compiled twice


@kernel
def static_state(m, load):
    """Equilibrium under the ``load`` [m/s²], the weight and what tendons add to it: z = −(1 + ψ)/η on the first loading."""
    force = 0.5 * load / m.yield_force
    return State(-m.yield_deflection * deflection(m, force), 0.0, 0.0, 0.0, -force, -force)


@inlined
def put_ground(lanes, i, ground):
    """The ground at the last sample; zero after the record."""
    at, sample = lanes.ground, lanes.clock.sample[i]
    if sample < lanes.motion.npts[i]:
        row = np.uintp(lanes.motion.first_row[i] + sample)  # unsigned: no index from the end is looked for
        at.horizontal[i] = ground[row, 0]
        at.horizontal_slope[i] = ground[row, 1]
        at.vertical[i] = ground[row, 2]
        at.vertical_slope[i] = ground[row, 3]
    else:
        at.horizontal[i] = at.horizontal_slope[i] = at.vertical[i] = at.vertical_slope[i] = 0.0


@kernel
def _put_model(lanes, i, run):
    m = lanes.model
    m.half_width[i], m.height[i], m.inertia[i], m.gravity[i] = run.half_width, run.height, run.inertia, run.gravity
    m.yield_deflection[i], m.stiffness[i], m.yield_force[i] = run.yield_deflection, run.stiffness, run.yield_force
    m.epsilon[i], m.damping[i], m.law[i], m.guided[i] = run.epsilon, run.damping, run.law, run.guided
    m.exponent[i] = run.exponent


@kernel
def _put_start(lanes, i, number, run, m, y):
    """Clock, counts and extremes of run ``number`` at its start, in the static state ``y``."""
    motion, clock, extremes, counts = lanes.motion, lanes.clock, lanes.extremes, lanes.counts
    motion.number[i], motion.first_row[i], motion.npts[i] = number, run.first_row, run.npts
    motion.alpha[i] = math.atan2(m.half_width, m.height)
    motion.rest[i] = at_rest(m)
    motion.plastic[i] = y.v - m.yield_deflection * y.z_left
    clock.dt[i], clock.step[i], clock.substeps[i] = run.dt, run.dt / run.substeps, run.substeps
    clock.sample[i] = clock.sample_time[i] = clock.substep[i] = clock.done[i] = 0.0
    clock.due[i] = 1.0
    extremes.peak[i] = extremes.peak_time[i] = 0.0
    extremes.lowest_left[i] = extremes.lowest_right[i] = y.v
    extremes.window[i] = extremes.next_window[i] = extremes.in_window[i] = 0.0  # the first begins with the first sample
    counts.impacts[i] = counts.separations[i] = counts.in_sample[i] = counts.counted[i] = counts.moved[i] = 0.0
    counts.flight_time[i] = counts.impact_time[i] = math.nan


@kernel
def begin(lanes, i, number, runs, ground, traits, locate):
    """Run ``number`` into lane ``i``, in its static state."""
    run = runs[number]
    _put_model(lanes, i, run)
    m = model_of(lanes, i, traits)
    y = static_state(m, m.gravity + run.prestress)
    _put_start(lanes, i, number, run, m, y)
    expect(lanes, i, run.quiet_samples, run.patience, run.read_after, run.read_wait)
    lanes.waiting.load[i], lanes.waiting.stored[i] = m.gravity + run.prestress, 0.0
    plastic = lanes.motion.plastic[i]
    put_loading(lanes, i, Loading(plastic, y.z_left, 0.0, plastic, y.z_right, 0.0))
    branch = branch_when_pressed(m.law)
    contact = Contact(1.0, 1.0, branch, branch, 0.0)
    put_contact(lanes, i, contact, Supports(0.0, 0.0))
    put_ground(lanes, i, ground)
    under = ground_of(lanes, i, 0.0)
    put_state(lanes.now, i, y)
    put_state(lanes.rates, i, rates(m, y, contact, under.horizontal, under.vertical))
    ready(lanes, i, m, contact, 0.0, lanes.clock.step[i], locate)


@kernel
def finish(lanes, i, traits, status, t, row, results):
    """What the run in lane ``i`` comes to, into ``results``."""
    m = model_of(lanes, i, traits)
    y, contact = state(lanes.now, i), contact_of(lanes, i)
    waiting, extremes, counts, plastic = lanes.waiting, lanes.extremes, lanes.counts, lanes.motion.plastic[i]
    t_read, base_left, base_right = waiting.read[i] * lanes.clock.dt[i], waiting.read_left[i], waiting.read_right[i]
    if waiting.read[i] < 0.0:
        t_read = t
        base_left, base_right = base_of(lanes, i, m)
    loading = branches(m, loading_of(lanes, i), contact, Contact(0.0, 0.0, 0.0, 0.0, 0.0), y)
    run = results[int(lanes.motion.number[i])]
    run.extremes[int(extremes.window[i])] = extremes.in_window[i]
    run.status = status
    run.t_end = t
    run.theta_max = extremes.peak[i]
    run.t_max = extremes.peak_time[i]
    run.impacts = int(counts.impacts[i])
    run.separations = int(counts.separations[i])
    run.t_flight = counts.flight_time[i]
    run.base_left = base_left - plastic
    run.base_right = base_right - plastic
    run.deepest_left = extremes.lowest_left[i]
    run.deepest_right = extremes.lowest_right[i]
    run.dissipated_left = m.yield_force * loading.work_left
    run.dissipated_right = m.yield_force * loading.work_right
    run.t_read = t_read
    run.drift_left = waiting.drift_left[i]
    run.drift_right = waiting.drift_right[i]
    run.t_impact = counts.impact_time[i]
    run.rows = row


@entry
def _rock(traits, runs, ground, locate, every_step, history, stop, lanes_table, cells, results):
    """All ``runs``, as :func:`rock_side_by_side` has them; ``results`` of those that are stopped stay as they are."""
    lanes, recording = lanes_table[0], history.shape[0] > 0
    waiting, count, row = NONE, NONE, NONE
    while True:
        while count < LANES and waiting < len(runs):
            begin(lanes, count, waiting, runs, ground, traits, locate)
            waiting += 1
            row = write(history, row, 0.0, state(lanes.now, count), contact_of(lanes, count), SAMPLE)
            status = done(lanes, count, traits)
            if status == RUNNING:
                count += 1
            else:
                finish(lanes, count, traits, status, 0.0, row, results)
        if count == 0 or stop[0] != 0:
            return
        while count == LANES or (count > 0 and waiting == len(runs)):
            one_pass(lanes, count, traits)
            i = NONE
            while i < count:
                news, status, t = lanes.news[i], SURVIVED, 0.0
                if news >= EVENTFUL:
                    status, t, row = _eventful(lanes, i, traits, locate, ground, history, row)
                elif news != CALM or recording:
                    row = _stood(lanes, i, traits, history, row)
                if status == SURVIVED:  # and the step is done
                    if lanes.clock.substep[i] == 0.0:
                        put_ground(lanes, i, ground)
                    status = RUNNING
                    if news >= DUE or recording:
                        status, t, row = _step_done(lanes, i, traits, every_step, history, row, results)
                if status == RUNNING:
                    i += 1
                else:
                    finish(lanes, i, traits, status, t, row, results)
                    count -= 1
                    move(cells, count, i)
            if stop[0] != 0:
                return


@kernel
def _eventful(lanes, i, traits, locate, ground, history, row):
    """The piece of lane ``i`` in which something may have happened; see :func:`rockbatch.core.happening.look`."""
    clock = lanes.clock
    turned = lanes.news[i] == TURNED and lanes.verdict[i] == SEARCH
    if turned and seek_turn(lanes, i, model_of(lanes, i, traits)):
        return RUNNING, 0.0, row
    status, t, row = look(lanes, i, traits, locate, ground, history, row)
    if status == SURVIVED and clock.substep[i] == clock.substeps[i]:
        clock.sample[i] += 1.0
        clock.sample_time[i] = clock.sample[i] * clock.dt[i]
        clock.substep[i] = clock.start[i] = 0.0
        if clock.sample[i] < clock.due[i]:
            lanes.extremes.in_window[i] = max(lanes.extremes.in_window[i], abs(lanes.now.theta[i]))
    return status, t, row


@kernel
def _stood(lanes, i, traits, history, row):
    """What a step that stands has left to do in lane ``i``: next row of the history."""
    m, clock = model_of(lanes, i, traits), lanes.clock
    sample_time = (clock.sample[i] - 1.0) * clock.dt[i] if clock.substep[i] == 0.0 else clock.sample_time[i]
    t = sample_time + clock.began[i]
    if lanes.extremes.new[i] > 0.0:
        y, end = state(lanes.before, i), state(lanes.now, i)
        include(lanes, i, m, y, end, contact_of(lanes, i), t, clock.took[i])
    if lanes.turns.left[i] >= 0.0 or lanes.turns.right[i] >= 0.0:
        close_turned(lanes, i, m)
        row = write_turns(lanes, i, m, t, ground_of(lanes, i, clock.began[i]), history, row)
    return row


@kernel
def _step_done(lanes, i, traits, every_step, history, row, results):
    """A row of the history, and what is due at a sample: status (RUNNING while the run goes on), time, next row."""
    clock = lanes.clock
    sampled, t = clock.substep[i] == 0.0, clock.sample_time[i] + clock.start[i]
    if sampled or every_step:
        kind = SAMPLE if sampled else BETWEEN_SAMPLES
        row = write(history, row, t, state(lanes.now, i), contact_of(lanes, i), kind)
    if not sampled or clock.sample[i] < clock.due[i]:
        return RUNNING, t, row
    turn_window(lanes, i, results)
    status = done(lanes, i, traits)
    clock.due[i] = min(lanes.extremes.next_window[i], next_due(lanes, i))
    return status, t, row


@kernel
def turn_window(lanes, i, results):
    """At a sample at which something is due: keep the greatest |θ| of a window that is over, begin the next."""
    extremes, sample = lanes.extremes, lanes.clock.sample[i]
    if sample >= extremes.next_window[i]:
        results[int(lanes.motion.number[i])].extremes[int(extremes.window[i])] = extremes.in_window[i]
        window, begin_next = window_of(sample, lanes.waiting.samples[i])
        extremes.window[i], extremes.next_window[i], extremes.in_window[i] = window, begin_next, 0.0
    extremes.in_window[i] = max(extremes.in_window[i], abs(lanes.now.theta[i]))


def run_line(m, *timing):
    """Line of a run of the pier ``m`` (Springs); ``timing`` is what Line has from ``dt`` on."""
    exponent = 5.0 if m.exponent is None else float(m.exponent)
    return Line(*m[:-4], exponent, *timing)


def traits_of(m):
    """Traits of the pier ``m`` (Springs)."""
    return Traits(m.exponent, m.finite, m.damped)


def rock_side_by_side(traits, lines, ground, stop, locate=True, every_step=False, history=NO_HISTORY):
    """Runs of piers on two springs, as many at a time as there are lanes.

    Parameters
    ----------
    traits : Traits
        Of all their Springs, by type.
    lines : sequence of Line
    ground : ndarray, shape (rows, 4)
        Of :func:`rockbatch.core.ground.ground_rows`, of all their motions.
    stop : ndarray of one uint8
        Ends it at once when another thread sets it.
    locate : bool
        Locate events inside the step. Without, they take place at its end (first order; for comparison only).
    history : recarray of Row
        For a single run: filled with every sample and both sides of every event, as far as it goes.
    every_step : bool
        Also write the steps between samples.

    Returns
    -------
    recarray, shape (runs,)
        SpringRun's fields and ``extremes``, the greatest |θ| in each window of the run, NaN for those that it did not
        reach. The status of those that were stopped is RUNNING.
    """
    # A compiled function hands out nothing: making a tuple runs Python code, where Ctrl-C may strike.
    lines = np.array(lines, LINE).view(np.recarray)
    results = np.recarray(len(lines), RESULT)
    results.status, results.extremes = RUNNING, np.nan
    lanes, cells = table()
    _rock(traits, lines, ground, locate, every_step, history, stop, lanes, cells, results)
    return results


def rock_on_springs(m, horizontal, vertical, dt, substeps, quiet_samples, history, locate, every_step=False):
    """One run, of the pier ``m`` (Springs) under one motion; SpringRun.

    ``horizontal`` and ``vertical`` are ground accelerations [m/s²], shape (npts,), the vertical one may be empty; for
    the others see Line and :func:`rock_side_by_side`.
    """
    lines = [run_line(m, dt, substeps, quiet_samples, 0, len(horizontal))]
    ground = ground_rows(horizontal, vertical, dt)
    never = np.zeros(1, np.uint8)
    return spring_run(rock_side_by_side(traits_of(m), lines, ground, never, locate, every_step, history)[0])


def spring_run(result):
    """SpringRun of one of the results."""
    return SpringRun(*result.tolist()[: len(SpringRun._fields)])
