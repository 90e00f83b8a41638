"""The driver of all runs: fixed steps of Runge–Kutta 4, side by side, with events located inside the step.

It knows no pier by name (``system``). All lanes march in step: a vector pass takes each a sub-step further, and one in which
something may happen takes that sub-step once more, event by event, in scalar code. Runs that end make room for others.
"""

import math
from typing import NamedTuple

import numba
import numpy as np

from rockbatch.core.clock import (
    CALM,
    EVENTFUL,
    WINDOWS,
    close_window,
    fallen,
    ground_at,
    ground_rests,
    include_height,
    include_peak,
    motion_due,
    note_flight,
    note_motion_over,
    read_ground,
    start_clock,
    turn_window,
)
from rockbatch.core.devices.events import after_contact, device_event, start_devices
from rockbatch.core.devices.pull import Devices, loaded, resolved
from rockbatch.core.devices.use import take_in
from rockbatch.core.history import history_of, take_back, write
from rockbatch.core.kernel import entry, inlined, inlined_once, kernel, question
from rockbatch.core.search import first_event, marks_for, start_rates
from rockbatch.core.system import (
    after_event,
    after_step,
    airborne,
    at_rest,
    attend,
    begin,
    expect,
    finish,
    include,
    longest,
    model,
    moment,
    next_due,
    one_pass,
    over,
    peak_stands,
    put_moment,
    transition,
    uplifts,
)
from rockbatch.core.table import LANES, NONE, get, move, put, record, table
from rockbatch.core.types import (
    BEFORE_EVENT,
    CHATTER,
    FLIGHT,
    IMPACT_BOTH,
    IMPACT_LEFT,
    IMPACT_RIGHT,
    LATE_FLIGHT,
    LIFT_OFF,
    NO_EVENT,
    OF_PIER,
    OVERTURNED,
    REST,
    RUNNING,
    SAMPLE,
    STEP,
    SURVIVED,
    TAKE_OFF,
    Moment,
    Pull,
    Result,
)

EVENTS_IN_A_SAMPLE = 20_000
"""More than any decaying sequence of impacts needs."""

VECTOR = 1 if numba.config.DISABLE_JIT else 8  # type: ignore[attr-defined]
"""Lanes that the widest vector instructions take at a time; uncompiled there are none, and an empty lane would divide by zero."""

FEW = 2
"""Lanes left over that are sooner taken one by one than with others that are empty."""

assert LANES % VECTOR == 0, "the pass would take lanes beyond the table"

NO_ROWS = np.zeros((0, 0, 1))

RESULT = np.dtype([*record(Result).descr, ("extremes", "f8", WINDOWS)])
"""As Result has it, and the greatest |θ| [rad] at a sample in each window of the run, NaN where it has none."""


class Settings(NamedTuple):
    """Settings of all runs of a call."""

    substeps: int  # steps to a sampling interval
    locate: bool  # events inside the step; without, they take place at its end: first order, for comparison only
    recording: bool  # histories are written


@inlined
def _commit(devices, lanes, i, k_end, which):
    """Let the devices' states go on from the end of a step, and the next step from its rates but for an event."""
    if devices is None:
        return
    put(lanes.rates, i, k_end)
    if which != NO_EVENT:
        devices.ended[0] = 0.0
    for i in range(len(devices.x)):
        devices.x[i] = devices.end[i]


@kernel
def _strongest(lanes, i, ground):
    """Return the strongest horizontal acceleration [m/s²] that the ground has or may still have."""
    strongest = 0.0
    if ground_rests(lanes, i):
        return strongest
    first = int(lanes.clock.first_row[i])
    for row in range(first, first + int(lanes.clock.npts[i])):
        strongest = max(strongest, abs(ground[row, 0]))
    return strongest


@kernel
def _in_flight(traits, lanes, i, m, y, ground):
    """Return the status of a pier that has left the ground with both pivots."""
    if m.guided != 0.0:
        return SURVIVED
    if peak_stands(traits, lanes, i):
        return LATE_FLIGHT  # what flies is undamped vibration
    beyond = abs(y.theta) - lanes.clock.alpha[i]
    # else the ground may yet turn it back
    falling = beyond >= 0.0 and y.theta * y.omega > 0.0 and m.gravity * math.tan(beyond) >= _strongest(lanes, i, ground)
    return OVERTURNED if falling else FLIGHT


@kernel
def _count(lanes, i, kind, landed, lifted, t, remaining):
    """Count an event of this ``kind`` at ``t`` [s], after which bounces go on for ``remaining`` [s] until rest."""
    tally = lanes.tally
    tally.impacts[i] += landed
    tally.uplifts[i] += lifted
    if landed > 0:
        tally.t_impact[i] = t
    if landed > 0 or lifted > 0 or kind == TAKE_OFF:
        tally.moved[i] = t
    if kind == REST:
        tally.t_rest[i] = t + remaining
    elif kind in (LIFT_OFF, TAKE_OFF):
        tally.t_rest[i] = math.nan


@kernel
def _many(lanes, i):
    """Return whether one event more is one too many in this sample."""
    tally, sample = lanes.tally, lanes.clock.sample[i]
    tally.events[i] = tally.events[i] + 1.0 if tally.counted[i] == sample else 1.0
    tally.counted[i] = sample
    return tally.events[i] > EVENTS_IN_A_SAMPLE


@inlined
def _after_contact(m, devices, y, contact, kind, rest, ground):
    """Choose the devices' directions and modes after an event at a pivot; those of lift-off and take-off have theirs."""
    if devices is not None and kind not in (LIFT_OFF, TAKE_OFF):
        after_contact(m, devices, y, contact, rest, ground)


@inlined
def _device_event(m, devices, y, contact, ground, h, rest, which):
    if devices is not None:
        device_event(m, devices, y, contact, ground, h, rest, which)


@kernel
def _happen(traits, lanes, i, m, devices, now, which, x, ground, history):
    """Let event ``which`` happen ``x`` [s] after the sample: status, and the Moment after it."""
    here, rest, dt = ground_at(lanes, i, x), lanes.clock.rest[i], lanes.clock.dt[i]
    t, y, contact, number = lanes.clock.sample[i] * dt + x, now.y, now.contact, int(lanes.clock.number[i])
    of_pier, after, supports, kind, remaining = which < OF_PIER, contact, now.supports, STEP, 0.0
    if of_pier or history.every_step:
        write(history, number, t, BEFORE_EVENT if of_pier else STEP, m, devices, y, contact, here)
    if of_pier:
        under = loaded(devices, m, y, contact, here)
        y, after, supports, kind, remaining = transition(under, devices, y, contact, supports, which, rest, here, dt)
        _after_contact(m, devices, y, after, kind, rest, here)
        if kind == LIFT_OFF:  # nothing jumps
            take_back(history, number)
    else:
        _device_event(m, devices, y, contact, here, lanes.clock.step[i], rest, which)
    if of_pier or history.every_step:
        write(history, number, t, kind, m, devices, y, after, here)
    if not of_pier:
        return SURVIVED, now
    landed = 2 if kind == IMPACT_BOTH else (1 if kind in (IMPACT_LEFT, IMPACT_RIGHT, REST) else 0)
    _count(lanes, i, kind, landed, uplifts(m, contact, after, landed), t, remaining)
    after_event(traits, lanes, i, m, contact, after, y)
    flies = airborne(m, after)
    note_flight(lanes, i, flies, t)
    return (_in_flight(traits, lanes, i, m, y, ground) if flies else SURVIVED), Moment(y, after, supports)


@inlined_once
def _through(traits, lanes, i, devices, marks, substep, settings, ground, history):
    """Take lane ``i`` through a sub-step event by event: status (SURVIVED while it goes on), and time [s]."""
    h, start, dt, rest = lanes.clock.step[i], substep * lanes.clock.step[i], lanes.clock.dt[i], lanes.clock.rest[i]
    t_sample, number = lanes.clock.sample[i] * dt, int(lanes.clock.number[i])
    m = model(traits, lanes, i)
    y, contact, supports = moment(traits, lanes, i)
    now = Moment(y, contact, supports)
    done, which, status = 0.0, NO_EVENT, SURVIVED
    while done < h and status == SURVIVED:
        here, left = ground_at(lanes, i, start + done), h - done
        k, under = start_rates(m, devices, now.y, now.contact, here, get(lanes.rates, i, now.y))
        asked = min(left, resolved(under, devices, now.y, now.contact, here, h, dt))
        most = longest(under, now.y, k, now.contact, asked)
        used, which, end, k_end = first_event(under, devices, marks, now, k, rest, here, most, settings.locate)
        include_peak(lanes, i, now.y, end, start, done, used)
        include(traits, lanes, i, m, now.y, k, end, k_end, now.contact, used)
        if airborne(m, now.contact):
            include_height(lanes, i, m, now.supports, now.y, end, used)
        take_in(devices, k, k_end, used)
        _commit(devices, lanes, i, k_end, which)
        now = Moment(end, now.contact, now.supports)
        done = done + used if used < left else h
        if which != NO_EVENT:
            status, now = _happen(traits, lanes, i, m, devices, now, which, start + done, ground, history)
            if status == SURVIVED and _many(lanes, i):
                status = CHATTER
        if status == SURVIVED and done >= h:
            status = fallen(now.y.theta)
        between = history.every_step and which == NO_EVENT and done < h
        if between or status not in (SURVIVED, FLIGHT, LATE_FLIGHT):
            here = ground_at(lanes, i, start + done)
            write(history, number, t_sample + (start + done), STEP, m, devices, now.y, now.contact, here)
    put_moment(traits, lanes, i, now.y, now.contact, now.supports)
    after_step(traits, lanes, i, marks, now.contact, which == NO_EVENT)
    return status, t_sample + (start + done)


@kernel
def _begin(traits, lanes, i, number, runs, devices, ground, history, results):
    """Let run ``number`` begin in lane ``i``: its status."""
    run = runs[number]
    begin(traits, lanes, i, run)
    m = model(traits, lanes, i)
    y, contact, _ = moment(traits, lanes, i)
    start_clock(lanes, i, number, run, at_rest(m), math.atan2(m.half_width, m.height), y.theta)
    read_ground(lanes, i, ground)
    expect(traits, lanes, i, run)
    note_motion_over(lanes, i, results)
    here = ground_at(lanes, i, 0.0)
    start_devices(m, devices, y, contact, lanes.clock.rest[i], here)
    write(history, number, 0.0, SAMPLE, m, devices, y, contact, here)
    return over(traits, lanes, i, devices)


@kernel
def _finish(traits, lanes, i, status, t, history, results):
    """Write what the run in lane ``i`` has come to."""
    close_window(lanes, i, results)
    peak, tally = lanes.peak, lanes.tally
    note_flight(lanes, i, False, t)
    number = int(lanes.clock.number[i])
    result = results[number]
    result.status, result.t_end, result.rows = status, t, history.written[number]
    result.theta_max, result.t_max = peak.theta[i], peak.time[i]
    result.impacts, result.uplifts, result.flights = int(tally.impacts[i]), int(tally.uplifts[i]), int(tally.flights[i])
    result.t_flight, result.flight_duration = tally.t_flight[i], tally.flight_duration[i]
    result.flight_height, result.t_impact, result.t_rest = tally.flight_height[i], tally.t_impact[i], tally.t_rest[i]
    finish(traits, lanes, i, t, result)


@question
def _stands(devices, traits, lanes, i, substep, history):
    """Return whether the sub-step of lane ``i`` stands as the pass took it, and take in what the pass could not."""


@_stands.of(Devices)
def _stands_with_devices(devices, traits, lanes, i, substep, history):
    return False


@_stands.of(type(None))
def _stands_alone(devices, traits, lanes, i, substep, history):
    if lanes.step_status.kind[i] >= EVENTFUL:
        return False
    _include_peak_of_lane(lanes, i, substep)
    attend(traits, lanes, i, substep, history)
    return True


@inlined
def _include_peak_of_lane(lanes, i, substep):
    """Bring the peak of lane ``i`` up to that inside its sub-step."""
    now, end, h = lanes.now, lanes.end, lanes.clock.step[i]
    y, y_end = Turn(now.theta[i], now.omega[i]), Turn(end.theta[i], end.omega[i])
    include_peak(lanes, i, y, y_end, substep * h, 0.0, h)


class Turn(NamedTuple):
    """Rotation [rad] and its rate [rad/s]."""

    theta: float
    omega: float


@inlined
def _to_samples(lanes, count, ground):
    """Bring all lanes to the next sample; return how many have more due there than the next step."""
    clock, peak, due = lanes.clock, lanes.peak, 0
    for i in range(count):
        clock.sample[i] += 1.0
        read_ground(lanes, i, ground)
        goes_on = clock.sample[i] < clock.due[i]
        peak.in_window[i] = max(peak.in_window[i], abs(lanes.now.theta[i])) if goes_on else peak.in_window[i]
        due += 0 if goes_on else 1
    return due


@kernel
def _at_sample(traits, lanes, i, devices, results):
    """Do what is due at the sample that lane ``i`` has come to: its status, RUNNING while it goes on."""
    clock, peak = lanes.clock, lanes.peak
    theta = lanes.now.theta[i]
    if clock.sample[i] < clock.due[i]:
        return RUNNING
    turn_window(lanes, i, theta, results)
    peak.in_window[i] = max(peak.in_window[i], abs(theta))
    note_motion_over(lanes, i, results)
    status = over(traits, lanes, i, devices)
    clock.due[i] = min(peak.next_window[i], next_due(traits, lanes, i), motion_due(lanes, i))
    return status


@question
def _pass(devices, traits, lanes, count, substep, settings):
    """Take all lanes a sub-step further; return how many are not calm."""


@_pass.of(Devices)
def _pass_with_devices(devices, traits, lanes, count, substep, settings):
    lanes.step_status.kind[0] = EVENTFUL  # a lane with devices is taken event by event
    return count


@_pass.of(type(None))
def _pass_alone(devices, traits, lanes, count, substep, settings):
    left_over = count % VECTOR
    # Lanes beyond ``count`` hold what nobody reads
    lanes_taken = count if left_over <= FEW else count - left_over + VECTOR
    one_pass(traits, lanes, lanes_taken, substep, settings)
    busy = 0
    for i in range(count):
        busy += 1 if lanes.step_status.kind[i] != CALM else 0
    return busy


@kernel
def _write_now(traits, lanes, count, devices, kind, steps, history):
    """Write a row of each lane as it is now, so many ``steps`` after its sample."""
    clock = lanes.clock
    for i in range(count):
        y, contact, _ = moment(traits, lanes, i)
        x, m = steps * clock.step[i], model(traits, lanes, i)
        t, here = clock.sample[i] * clock.dt[i] + x, ground_at(lanes, i, x)
        write(history, int(clock.number[i]), t, kind, m, devices, y, contact, here)


@entry
def _march(traits, runs, ground, settings, devices, marks, history, stop, memory, results):
    """Take all ``runs`` to their ends; ``results`` of those that are stopped stay as they are."""
    lanes, cells = memory[0][0], memory[1]
    waiting, count = NONE, NONE
    while True:
        while count < LANES and waiting < len(runs):
            status = _begin(traits, lanes, count, waiting, runs, devices, ground, history, results)
            waiting += 1
            if status == RUNNING:
                count += 1
            else:
                _finish(traits, lanes, count, status, 0.0, history, results)
        if count == 0 or stop[0] != 0:
            return
        for substep in range(settings.substeps):
            busy = _pass(devices, traits, lanes, count, substep, settings)
            i = NONE if busy > 0 else count
            while i < count:
                status, t = SURVIVED, 0.0
                if lanes.step_status.kind[i] != CALM and not _stands(devices, traits, lanes, i, substep, history):
                    status, t = _through(traits, lanes, i, devices, marks, substep, settings, ground, history)
                if status == SURVIVED:
                    i += 1
                else:
                    _finish(traits, lanes, i, status, t, history, results)
                    count -= 1
                    move(cells, count, i)
            if history.every_step and substep < settings.substeps - 1:
                _write_now(traits, lanes, count, devices, STEP, substep + 1.0, history)
        due = _to_samples(lanes, count, ground)
        if settings.recording:
            _write_now(traits, lanes, count, devices, SAMPLE, 0.0, history)
        i = NONE if due > 0 else count
        while i < count:
            status = _at_sample(traits, lanes, i, devices, results)
            if status == RUNNING:
                i += 1
            else:
                _finish(traits, lanes, i, status, lanes.clock.sample[i] * lanes.clock.dt[i], history, results)
                count -= 1
                move(cells, count, i)


def march(kind, lines, ground, stop, substeps, locate=True, every_step=False, history=NO_ROWS, devices=None):
    """Take runs of piers of one kind to their ends, as many at a time as there are lanes, or one with devices.

    Parameters
    ----------
    kind : Kind
        Of all their piers.
    lines : sequence of kind.line
    ground : ndarray, shape (rows, 4)
        Of :func:`rockbatch.core.ground.ground_rows`, of all their motions.
    stop : ndarray of one uint8
        Ends them within a sample when another thread sets it.
    substeps : int
        Steps to a sampling interval, of all of them.
    locate : bool
        Locate events inside the step. Without, they take place at its end (first order; for comparison only).
    every_step : bool
        Also write the steps between samples, and both sides of all events of devices.
    history : ndarray, shape (runs, rows, columns)
        Filled with each run's samples and both sides of its events, as far as it goes (``history``).
    devices : Devices or None
        Of a single run.

    Returns
    -------
    recarray, shape (runs,)
        Result's fields and ``extremes``. The status of those that were stopped is RUNNING.
    """
    # A compiled function hands out nothing: making a tuple runs Python code, where Ctrl-C may strike.
    runs = np.array(lines, record(kind.line)).view(np.recarray)
    results = np.recarray(len(runs), RESULT)
    for name in RESULT.names:
        results[name] = np.nan if RESULT[name].kind != "i" else 0
    results.status = RUNNING
    settings = Settings(int(substeps), bool(locate), len(history) > 0)
    marks = marks_for(0 if devices is None else len(devices.elements))
    _march(
        kind.traits if devices is None else kind.traits._replace(pull=Pull(0.0, 0.0)),
        runs,
        ground,
        settings,
        devices,
        marks,
        history_of(history, len(runs), every_step),
        stop,
        table(kind.lane),
        results,
    )
    return results
