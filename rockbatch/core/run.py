"""The driver of all runs: fixed steps of Runge–Kutta 4, side by side, with events located inside the step.

It knows no kind of pier (``system``). All lanes advance together: a vector pass integrates each over a sub-step, and a lane in
which an event may occur repeats it event by event, in scalar code. A run that ends frees its lane for another.
"""

import math
from typing import NamedTuple

import numpy as np

from rockbatch.core.clock import (
    CALM,
    EVENTFUL,
    WINDOWS,
    close_window,
    fallen,
    ground_at,
    ground_rests,
    include_peak,
    motion_due,
    note_flight,
    note_motion_over,
    peak_decided,
    read_ground,
    start_clock,
    turn_window,
)
from rockbatch.core.devices.events import device_event, reset_device_modes, start_devices
from rockbatch.core.devices.lanes import Equipment, devices_in, fetch, move_devices, stow
from rockbatch.core.devices.pull import loaded, step_resolving_devices
from rockbatch.core.devices.use import take_in
from rockbatch.core.history import History, Stamp, history_of, take_back, write
from rockbatch.core.kernel import entry, hook, inlined, inlined_once, kernel
from rockbatch.core.search import Marks, first_event, marks_for, start_rates
from rockbatch.core.system import (
    airborne,
    begin,
    finish,
    lanes_in_pass,
    longest_step,
    note_devices,
    one_pass,
    pass_with_devices,
    pier_in,
    released,
    status_at_sample,
    take_in_part,
    take_in_step,
    transition,
)
from rockbatch.core.table import LANES, ZERO, get, move, put, record, table
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
    Instant,
    Moment,
    Part,
    Pull,
    Result,
)

EVENTS_IN_A_SAMPLE = 20_000
"""Greatest number of events in a sample; decaying sequences of impacts need fewer."""

MANY_PARTS = 3
"""Parts of a sub-step after which the next one most likely has several, too: devices ask for short steps, or events crowd."""

NO_ROWS = np.zeros((0, 0, 1))

RESULT = np.dtype([*record(Result).descr, ("extremes", "f8", WINDOWS)])
"""Result, and the greatest |θ| [rad] at samples in each window of the run, NaN in those not reached."""


class Settings(NamedTuple):
    """Settings of all runs of a call."""

    substeps: int  # steps to a sampling interval
    locate: bool  # events are located inside the step; False moves them to its end (first order, for comparison only)
    recording: bool  # histories are written


class Context(NamedTuple):
    """Arguments shared by the runs of a call. Only inlined functions take it, since a call copies a hundred numbers."""

    traits: tuple  # of their System
    lanes: np.record
    equipment: Equipment | None
    marks: Marks
    settings: Settings
    ground: np.ndarray
    history: History
    results: np.recarray


@inlined
def _commit(devices, lanes, i, k_end, which):
    """Set the devices' states to the end of a step, and keep the pier's rates ``k_end`` there; nothing without devices.

    The next step begins with these rates, unless ``which`` is an event.
    """
    if devices is None:
        return
    put(lanes.rates, i, k_end)
    if which != NO_EVENT:
        devices.ended[0] = 0.0
    for i in range(len(devices.x)):
        devices.x[i] = devices.end[i]


@kernel
def _strongest(lanes, i, ground):
    """Return the greatest |horizontal acceleration| [m/s²] of the whole motion; 0 once the ground is at rest."""
    strongest = 0.0
    if ground_rests(lanes, i):
        return strongest
    first = int(lanes.clock.first_row[i])
    for row in range(first, first + int(lanes.clock.npts[i])):
        strongest = max(strongest, abs(ground[row, 0]))
    return strongest


@inlined_once
def _flight_status(context, i, m, y):
    """Return the status of a pier with both pivots in the air: SURVIVED if flights are guided, LATE_FLIGHT if the peak is final.

    Else OVERTURNED if it falls beyond α and no later ground acceleration can turn it back, or FLIGHT.
    """
    lanes = context.lanes
    if m.guided != 0.0:
        return SURVIVED
    if peak_decided(lanes, i):
        return LATE_FLIGHT  # undamped vibration, which does not change the results
    beyond = abs(y.theta) - lanes.clock.alpha[i]
    # A pier beyond α falls if no later ground acceleration can turn it back
    strongest = _strongest(lanes, i, context.ground)
    falling = beyond >= 0.0 and y.theta * y.omega > 0.0 and m.gravity * math.tan(beyond) >= strongest
    return OVERTURNED if falling else FLIGHT


@kernel
def _count(lanes, i, event, t):
    """Add an event, a Transition at ``t`` [s], to the counts and times of lane ``i``.

    ``t_impact`` is the time of the last landing, ``moved`` that of the last landing, uplift or take-off, and ``t_rest`` that at
    which a REST is complete, NaN again after a lift-off or take-off.
    """
    tally, landed = lanes.tally, event.kind in (IMPACT_LEFT, IMPACT_RIGHT, IMPACT_BOTH, REST)
    tally.impacts[i] += event.impacts
    tally.uplifts[i] += event.uplifts
    if landed:
        tally.t_impact[i] = t
    if landed or event.uplifts > 0.0 or event.kind == TAKE_OFF:
        tally.moved[i] = t
    if event.kind == REST:
        tally.t_rest[i] = t + event.remaining
    elif event.kind in (LIFT_OFF, TAKE_OFF):
        tally.t_rest[i] = math.nan


@kernel
def _too_many_events(lanes, i):
    """Count an event in this sample; return True if it exceeds EVENTS_IN_A_SAMPLE."""
    tally, sample = lanes.tally, lanes.clock.sample[i]
    tally.events[i] = tally.events[i] + 1.0 if tally.counted[i] == sample else 1.0
    tally.counted[i] = sample
    return tally.events[i] > EVENTS_IN_A_SAMPLE


@inlined
def _is_zero(y):
    """Return True if all variables of a state are 0."""
    zero = True
    for j in range(len(y)):
        zero = zero and y[j] == 0.0
    return zero


@inlined_once
def _apply_event(context, i, m, devices, now, which, x):
    """Apply event ``which``, ``x`` [s] after the sample, to lane ``i``; return status and the Moment after it.

    The status is SURVIVED unless a flight ends the run. Rows of both sides are written, of devices only with every step.
    """
    lanes, history = context.lanes, context.history
    here, dt, number = ground_at(lanes, i, x), lanes.clock.dt[i], int(lanes.clock.number[i])
    t = lanes.clock.sample[i] * dt + x
    if which >= OF_PIER:
        if history.every_step:
            write(history, Stamp(number, t, STEP), m, devices, now, here)
        device_event(m, devices, now, here, lanes.clock.step[i], which)
        if history.every_step:
            write(history, Stamp(number, t, STEP), m, devices, now, here)
        return SURVIVED, now
    write(history, Stamp(number, t, BEFORE_EVENT), m, devices, now, here)
    event = transition(loaded(devices, m, now, here), devices, now, which, here, dt)
    after = event.now
    if event.kind not in (LIFT_OFF, TAKE_OFF):  # these set the devices' directions and modes themselves
        reset_device_modes(m, devices, after, here)
        after = released(loaded(devices, m, after, here), after, here)
    if event.kind == LIFT_OFF and _is_zero(now.y):  # the row before equals the last one
        take_back(history, number)
    write(history, Stamp(number, t, event.kind), m, devices, after, here)
    _count(lanes, i, event, t)
    flies = airborne(m, after.contact)
    note_flight(lanes, i, flies, t)
    return (_flight_status(context, i, m, after.y) if flies else SURVIVED), after


@inlined
def _clear_of_zero(functions):
    """Return True if the event functions of both contacts are above zero, and those of both laws above zero or rising."""
    clear = min(functions.values[0], functions.values[1]) > 0.0
    for j in (2, 3):
        clear = clear and (functions.values[j] > 0.0 or functions.slopes[j] > 0.0)
    return clear


@inlined_once
def _step_by_events(context, i, substep):
    """Integrate lane ``i`` over a sub-step event by event; return status, SURVIVED unless the run ends, and time reached [s]."""
    traits, lanes, history, marks = context.traits, context.lanes, context.history, context.marks
    devices = devices_in(context.equipment, lanes, i)
    fetch(context.equipment, devices, i)
    h, start, dt = lanes.clock.step[i], substep * lanes.clock.step[i], lanes.clock.dt[i]
    t_sample, number = lanes.clock.sample[i] * dt, int(lanes.clock.number[i])
    m, now = pier_in(traits, lanes, i)
    lanes.tally.repeated[i] += 1.0
    done, which, status, parts = 0.0, NO_EVENT, SURVIVED, 0
    while done < h and status == SURVIVED:
        parts += 1
        here, left = ground_at(lanes, i, start + done), h - done
        k, under = start_rates(m, devices, now, here, get(lanes.rates, i, now.y))
        at_start = Instant(now.y, k, now.contact, now.supports, here)
        most = longest_step(m, at_start, min(left, step_resolving_devices(under, devices, at_start, h, dt)))
        used, which, end, k_end = first_event(
            under, devices, marks, at_start, most, done > 0.0, context.settings.locate
        )
        part, now = Part(now, end, used), Moment(end, now.contact, now.supports)
        include_peak(lanes, i, part, start, done)
        take_in(devices, k, k_end, used)
        _commit(devices, lanes, i, k_end, which)
        done = done + used if used < left else h
        if which != NO_EVENT:
            status, now = _apply_event(context, i, m, devices, now, which, start + done)
            if status == SURVIVED and _too_many_events(lanes, i):
                status = CHATTER
        take_in_part(traits, lanes, i, m, part, now)
        if status == SURVIVED and done >= h:
            status = fallen(now.y.theta)
        between = history.every_step and which == NO_EVENT and done < h
        if between or status not in (SURVIVED, FLIGHT, LATE_FLIGHT):
            stamp = Stamp(number, t_sample + (start + done), STEP)
            write(history, stamp, m, devices, now, ground_at(lanes, i, start + done))
    rests = note_devices(traits, lanes, i, devices)
    stow(context.equipment, devices, i, rests or parts < MANY_PARTS, which != NO_EVENT)
    lanes.step_status.watched[i] = 0.0 if which == NO_EVENT and _clear_of_zero(marks.now) else 1.0
    return status, t_sample + (start + done)


@inlined_once
def _start_lane(context, i, number, run):
    """Start the ``run`` with ``number`` in lane ``i``; return its status, RUNNING unless it ends at once."""
    traits, lanes = context.traits, context.lanes
    start_clock(lanes, i, number, run)
    devices = devices_in(context.equipment, lanes, i)
    read_ground(lanes, i, context.ground)
    begin(traits, lanes, i, run)
    note_motion_over(lanes, i, context.results)
    m, now = pier_in(traits, lanes, i)
    here = ground_at(lanes, i, 0.0)
    start_devices(m, devices, now, here)
    write(context.history, Stamp(number, 0.0, SAMPLE), m, devices, now, here)
    note_devices(traits, lanes, i, devices)
    stow(context.equipment, devices, i, True, True)
    status, _ = status_at_sample(traits, lanes, i, devices)
    return status


@kernel
def _finish(traits, lanes, i, status, t, rows, results):
    """Write the results of the run in lane ``i``, which ends at ``t`` [s]; ``rows`` are the lengths of the histories."""
    close_window(lanes, i, results)
    peak, tally = lanes.peak, lanes.tally
    note_flight(lanes, i, False, t)
    number = int(lanes.clock.number[i])
    result = results[number]
    result.status, result.t_end, result.rows = status, t, rows[number]
    result.theta_max, result.t_max = peak.theta[i], peak.time[i]
    result.impacts, result.uplifts, result.flights = int(tally.impacts[i]), int(tally.uplifts[i]), int(tally.flights[i])
    result.repeated = int(tally.repeated[i])
    result.t_flight, result.flight_duration = tally.t_flight[i], tally.flight_duration[i]
    result.flight_height, result.t_impact, result.t_rest = tally.flight_height[i], tally.t_impact[i], tally.t_rest[i]
    result.v_end, result.theta_end = lanes.now.v[i], lanes.now.theta[i]
    finish(traits, lanes, i, t, result)


@inlined_once
def _accept_step(context, i, substep):
    """Return False if the sub-step of lane ``i`` is EVENTFUL; else record peak and extremes, advance the lane, return True."""
    lanes = context.lanes
    if lanes.step_status.kind[i] >= EVENTFUL:
        return False
    h, start = lanes.clock.step[i], Moment(get(lanes.now, i, Turn), None, None)
    include_peak(lanes, i, Part(start, get(lanes.end, i, Turn), h), substep * h, 0.0)
    take_in_step(context.traits, lanes, i, substep, context.history)
    return True


class Turn(NamedTuple):
    """Rotation [rad] and its rate [rad/s]."""

    theta: float
    omega: float


@inlined
def _advance_to_samples(lanes, count, ground):
    """Advance all lanes to the next sample; return how many have something due there.

    The others include the sample in their windows.
    """
    clock, peak, due = lanes.clock, lanes.peak, 0
    for i in range(count):
        clock.sample[i] += 1.0
        read_ground(lanes, i, ground)
        goes_on = clock.sample[i] < clock.due[i]
        peak.in_window[i] = max(peak.in_window[i], abs(lanes.now.theta[i])) if goes_on else peak.in_window[i]
        due += 0 if goes_on else 1
    return due


@inlined_once
def _update_at_sample(context, i):
    """Update window, peak and status of lane ``i`` if due at its sample; return its status, RUNNING unless it ends."""
    lanes, clock, peak = context.lanes, context.lanes.clock, context.lanes.peak
    theta = lanes.now.theta[i]
    if clock.sample[i] < clock.due[i]:
        return RUNNING
    turn_window(lanes, i, theta, context.results)
    peak.in_window[i] = max(peak.in_window[i], abs(theta))
    note_motion_over(lanes, i, context.results)
    devices = devices_in(context.equipment, lanes, i)
    fetch(context.equipment, devices, i)
    status, next_due = status_at_sample(context.traits, lanes, i, devices)
    clock.due[i] = min(peak.next_window[i], next_due, motion_due(lanes, i))
    return status


@hook
def _pass(equipment, context, count, substep):
    """Integrate the first ``count`` lanes over a sub-step.

    With devices all are EVENTFUL instead if none may be smooth, or the pass does not take these devices.
    """


@_pass.of(Equipment)
def _pass_with_devices(equipment, context, count, substep):
    smooth = -1.0
    for i in range(count):
        smooth = max(smooth, equipment.shared[0].verdict.smooth[i])
    if equipment.passes and smooth > 0.0:
        pass_with_devices(context.traits, context.lanes, equipment, count, substep, context.settings)
    else:
        for i in range(count):
            context.lanes.step_status.kind[i] = EVENTFUL


@_pass.of(type(None))
def _pass_alone(equipment, context, count, substep):
    one_pass(context.traits, context.lanes, lanes_in_pass(context.traits, count), substep, context.settings)


@inlined
def _busy_lanes(lanes, count):
    """Return how many lanes are not calm after a pass."""
    busy = 0
    for i in range(count):
        busy += 1 if lanes.step_status.kind[i] != CALM else 0
    return busy


@kernel
def _write_now(context, count, kind, steps):
    """Write a row of the present state of each lane, ``steps`` steps after its sample."""
    lanes, clock = context.lanes, context.lanes.clock
    for i in range(count):
        m, now = pier_in(context.traits, lanes, i)
        devices = devices_in(context.equipment, lanes, i)
        fetch(context.equipment, devices, i)
        x = steps * clock.step[i]
        stamp = Stamp(int(clock.number[i]), clock.sample[i] * clock.dt[i] + x, kind)
        write(context.history, stamp, m, devices, now, ground_at(lanes, i, x))


@entry
def _march(traits, runs, ground, settings, equipment, marks, history, stop, memory, results):
    """Integrate all ``runs`` to their ends; those that ``stop`` interrupts keep the status RUNNING in ``results``."""
    lanes, cells = memory[0][0], memory[1]
    context = Context(traits, lanes, equipment, marks, settings, ground, history, results)
    waiting, count = ZERO, ZERO
    while True:
        while count < LANES and waiting < len(runs):
            status = _start_lane(context, count, waiting, runs[waiting])
            waiting += 1
            if status == RUNNING:
                count += 1
            else:
                _finish(traits, lanes, count, status, 0.0, history.written, results)
        if count == 0 or stop[0] != 0:
            return
        for substep in range(settings.substeps):
            _pass(equipment, context, count, substep)
            i = ZERO if _busy_lanes(lanes, count) > 0 else count
            while i < count:
                status, t = SURVIVED, 0.0
                if lanes.step_status.kind[i] != CALM and not _accept_step(context, i, substep):
                    status, t = _step_by_events(context, i, substep)
                if status == SURVIVED:
                    i += 1
                else:
                    _finish(traits, lanes, i, status, t, history.written, results)
                    count -= 1
                    move(cells, count, i)
                    move_devices(equipment, count, i)
            if history.every_step and substep < settings.substeps - 1:
                _write_now(context, count, STEP, substep + 1.0)
        due = _advance_to_samples(lanes, count, ground)
        if settings.recording:
            _write_now(context, count, SAMPLE, 0.0)
        i = ZERO if due > 0 else count
        while i < count:
            status = _update_at_sample(context, i)
            if status == RUNNING:
                i += 1
            else:
                t = lanes.clock.sample[i] * lanes.clock.dt[i]
                _finish(traits, lanes, i, status, t, history.written, results)
                count -= 1
                move(cells, count, i)
                move_devices(equipment, count, i)


def march(system, lines, ground, stop, substeps, locate=True, every_step=False, history=NO_ROWS, devices=None):
    """Integrate runs of one system to their ends, side by side in lanes.

    Parameters
    ----------
    system : System
        The system of all runs.
    lines : sequence of system.line
        Requests of the runs.
    ground : ndarray, shape (rows, 4)
        Rows of all motions, by :func:`rockbatch.core.ground.ground_rows`.
    stop : ndarray of one uint8
        Ends the runs within a sample when another thread sets it.
    substeps : int
        Steps to a sampling interval of all runs.
    locate : bool
        Locate events inside the step. Without, they take place at its end (first order; for comparison only).
    every_step : bool
        Also write the steps between samples, and both sides of all events of devices.
    history : ndarray, shape (runs, rows, columns)
        Filled with each run's samples and both sides of its events, as far as it has room (``history``).
    devices : Equipment or None
        Devices of all runs.

    Returns
    -------
    recarray, shape (runs,)
        Result's fields and ``extremes``. The status of stopped runs is RUNNING.
    """
    # The compiled function returns nothing: making a tuple would run Python code, which Ctrl-C may interrupt
    runs = np.array(lines, record(system.line)).view(np.recarray)
    results = np.recarray(len(runs), RESULT)
    for name in RESULT.names:
        results[name] = np.nan if RESULT[name].kind != "i" else 0
    results.status = RUNNING
    settings = Settings(int(substeps), bool(locate), len(history) > 0)
    marks = marks_for(0 if devices is None else len(devices.lanes))
    _march(
        system.traits if devices is None else system.traits._replace(pull=Pull(0.0, 0.0)),
        runs,
        ground,
        settings,
        devices,
        marks,
        history_of(history, len(runs), every_step),
        stop,
        table(system.lane),
        results,
    )
    return results
