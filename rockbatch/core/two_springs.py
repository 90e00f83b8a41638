"""Runs on two springs, side by side: fixed steps of Runge–Kutta 4, events located inside the step, the rest redone.

A step, or what an event has left of it, is a piece. The lanes' pass takes all of them at once; where it reports that
something may have happened, the piece is looked at: it stands, or a shorter one is tried until its end is the event's
time (``search``), and then the event happens here.
"""

import math

import numpy as np

from rockbatch.core.ending import (
    ALPHA,
    DRIFT,
    DT,
    MOVED,
    NPTS,
    READ,
    RUNNING,
    SAMPLE_NUMBER,
    SAMPLES,
    base_of,
    done,
    expect,
    ground_rests,
    peak_stands,
)
from rockbatch.core.equations import geometry, on_ground, rates, step
from rockbatch.core.events import at_rest
from rockbatch.core.ground import ground_rows
from rockbatch.core.kernel import entry, inlined, kernel
from rockbatch.core.lanes import (
    BEFORE,
    BEFORE_RATES,
    CALM,
    EVENTFUL,
    GROUND,
    LANES,
    LENGTH,
    LOWEST,
    MODEL,
    NEWS,
    NOW,
    PEAK,
    PEAK_TIME,
    RATES,
    SAMPLE_TIME,
    START,
    STEP,
    SUBSTEP,
    SUBSTEPS,
    TURNED,
    WATCHED,
    model_of,
    one_pass,
    put_all,
    put_state,
    rows,
    state_of,
)
from rockbatch.core.loading import Loading, branches
from rockbatch.core.outcome import WINDOWS, fallen, window_of
from rockbatch.core.roots import largest_within, lowest_within
from rockbatch.core.search import (
    ACCEPT,
    REST,
    SEARCH,
    VERDICT,
    contact_of,
    ground_of,
    judge,
    next_piece,
    put_contact,
    ready,
    seek_turn,
    supports_of,
)
from rockbatch.core.springs import static_deflection
from rockbatch.core.transitions import Supports, handle
from rockbatch.core.types import (
    BEFORE_EVENT,
    BOUC_WEN,
    CHATTER,
    FLIGHT,
    IMPACT_BOTH,
    IMPACT_LEFT,
    IMPACT_RIGHT,
    LATE_FLIGHT,
    OVERTURNED,
    SAMPLE,
    SURVIVED,
    Contact,
    SpringRun,
    State,
)
from rockbatch.core.types import STEP as BETWEEN_SAMPLES

EVENTS_IN_A_SAMPLE = 20_000  # more than any decaying sequence of impacts needs
RESULTS = len(SpringRun._fields)
HISTORY_COLUMNS = 13  # t, the six of State, the five of Contact, kind of row

NONE = np.int64(0)  # a literal 0 would have every function that it is handed to compiled twice

# What only this module needs of a lane
DONE = rows(1)  # of the step so far [s]
EVENTS = rows(1)  # since the last sample
LOADING = rows(6)
PLASTIC = rows(1)  # unstressed position of both supports at the start [m]
IMPACTS = rows(1)
SEPARATIONS = rows(1)
FLIGHT_TIME = rows(1)
IMPACT_TIME = rows(1)  # of the last impact [s]
FIRST_ROW = rows(1)  # of the motion among the ground's rows
STRONGEST = rows(1)  # horizontal acceleration of the ground [m/s²]
RUN = rows(1)  # which run is in the lane
WINDOW = rows(1)  # of the run, in which the lane is (``outcome``)
NEXT_WINDOW = rows(1)  # sample with which the next one begins
EXTREME = rows(1)  # greatest |θ| at a sample of this one so far [rad]
CELLS = rows.cells

_NO_HISTORY = np.empty((0, HISTORY_COLUMNS))


@kernel
def static_state(m):
    """Equilibrium under the weight alone: z = −1/η on the first loading of both springs."""
    force = 0.5 * m.gravity / m.yield_force
    deflection = static_deflection(force, m.exponent) if m.law == BOUC_WEN else force
    return State(-m.yield_deflection * deflection, 0.0, 0.0, 0.0, -force, -force)


@kernel
def _loading_of(table, i):
    at = LOADING + i
    return Loading(
        table[at], table[at + LANES], table[at + 2 * LANES],
        table[at + 3 * LANES], table[at + 4 * LANES], table[at + 5 * LANES],
    )  # fmt: skip


@kernel
def _put_ground(table, i, ground, sample):
    """The ground at ``sample``; zero after the record."""
    if sample < table[NPTS + i]:
        row = np.uintp(table[FIRST_ROW + i] + sample)  # unsigned: no index from the end is looked for
        put_all(table, GROUND + i, (ground[row, 0], ground[row, 1], ground[row, 2], ground[row, 3]))
    else:
        put_all(table, GROUND + i, (0.0, 0.0, 0.0, 0.0))


@kernel
def begin(table, i, number, runs, ground, exponent, finite):
    """Run ``number`` into lane ``i``, in its static state."""
    for j in range(11):
        table[MODEL + j * LANES + i] = runs[number, j]
    dt, substeps, quiet_samples, first_row, npts = (
        runs[number, 11],
        runs[number, 12],
        runs[number, 13],
        runs[number, 14],
        runs[number, 15],
    )
    m = model_of(table, i, exponent, finite)
    y = static_state(m)
    plastic = y.v - m.yield_deflection * y.z_left
    table[RUN + i] = number
    put_all(table, WINDOW + i, (0.0, 0.0, 0.0))  # the first begins with the first sample
    table[DT + i] = dt
    table[STEP + i] = dt / substeps
    table[SUBSTEPS + i] = substeps
    table[FIRST_ROW + i] = first_row
    table[NPTS + i] = npts
    expect(table, i, quiet_samples, runs[number, 16], runs[number, 17], runs[number, 18])
    table[IMPACT_TIME + i] = math.nan
    table[ALPHA + i] = math.atan2(m.half_width, m.height)
    strongest = 0.0
    for row in range(int(first_row), int(first_row + npts)):
        strongest = max(strongest, abs(ground[row, 0]))
    table[STRONGEST + i] = strongest
    table[REST + i] = at_rest(m)
    table[SAMPLE_NUMBER + i] = 0.0
    table[SAMPLE_TIME + i] = 0.0
    table[SUBSTEP + i] = 0.0
    table[DONE + i] = 0.0
    table[EVENTS + i] = 0.0
    put_all(table, LOADING + i, (plastic, y.z_left, 0.0, plastic, y.z_right, 0.0))
    table[PLASTIC + i] = plastic
    table[PEAK + i] = 0.0
    table[PEAK_TIME + i] = 0.0
    put_all(table, LOWEST + i, (y.v, y.v))
    table[IMPACTS + i] = 0.0
    table[SEPARATIONS + i] = 0.0
    table[FLIGHT_TIME + i] = math.nan
    branch = 1.0 if m.law == BOUC_WEN else 0.0
    contact = Contact(1.0, 1.0, branch, branch, 0.0)
    put_contact(table, i, m, contact, Supports(math.nan, math.nan))
    _put_ground(table, i, ground, NONE)
    under = ground_of(table, i, 0.0)
    put_state(table, NOW + i, y)
    put_state(table, RATES + i, rates(m, y, contact, under.horizontal, under.vertical))
    ready(table, i, m, contact, 0.0, table[STEP + i])


@kernel
def _include(table, i, m, y, end, contact):
    """Bring extremes up to those of the piece from ``y`` to ``end``."""
    x, h = table[START + i], table[LENGTH + i]
    found, peak = largest_within(y.theta, y.omega, end.theta, end.omega, h, table[PEAK + i])
    if found >= 0.0:
        table[PEAK + i] = peak
        table[PEAK_TIME + i] = table[SAMPLE_TIME + i] + x + found
    at, at_end = geometry(m, y.theta), geometry(m, end.theta)
    if contact.left != 0.0:
        table[LOWEST + i] = lowest_within(
            y.v + at.lift_left, y.v_rate + at.arm_left * y.omega,
            end.v + at_end.lift_left, end.v_rate + at_end.arm_left * end.omega,
            h, table[LOWEST + i],
        )  # fmt: skip
    if contact.right != 0.0:
        table[LOWEST + LANES + i] = lowest_within(
            y.v + at.lift_right, y.v_rate + at.arm_right * y.omega,
            end.v + at_end.lift_right, end.v_rate + at_end.arm_right * end.omega,
            h, table[LOWEST + LANES + i],
        )  # fmt: skip


@kernel
def _write(history, row, t, y, contact, kind):
    """Row of a history, where there is room for it; the next row."""
    if row < history.shape[0]:
        line = history[row]
        line[0] = max(t, history[row - 1, 0]) if row > 0 else t  # sums of pieces are rounded, time does not go back
        line[1] = y.v
        line[2] = y.theta
        line[3] = y.v_rate
        line[4] = y.omega
        line[5] = y.z_left
        line[6] = y.z_right
        line[7] = contact.left
        line[8] = contact.right
        line[9] = contact.left_yields
        line[10] = contact.right_yields
        line[11] = contact.held
        line[12] = kind
    return row + 1


@kernel
def _happen(table, i, m, y, contact, which, t, x, history, row):
    """Event ``which`` at ``t`` [s], ``x`` [s] after the sample: status, new contacts and next row of the history."""
    under = ground_of(table, i, x)
    if history.shape[0] > 0:
        row = _write(history, row, t, y, contact, BEFORE_EVENT)
    y, after, supports, kind = handle(
        m, y, contact, supports_of(table, i), which, table[REST + i], under.horizontal, under.vertical
    )
    if history.shape[0] > 0:
        row = _write(history, row, t, y, after, kind)
    landed = 2 if kind == IMPACT_BOTH else (1 if kind in (IMPACT_LEFT, IMPACT_RIGHT) else 0)
    table[IMPACTS + i] += landed
    if landed > 0:
        table[IMPACT_TIME + i] = t
    if after.left != contact.left or after.right != contact.right or landed > 0:
        table[MOVED + i] = t
    # a pivot may land and be lifted at once
    table[SEPARATIONS + i] += landed - on_ground(after) + on_ground(contact)
    put_all(table, LOADING + i, branches(m, _loading_of(table, i), contact, after, y))
    put_contact(table, i, m, after, supports)
    put_state(table, NOW + i, y)
    put_state(table, RATES + i, rates(m, y, after, under.horizontal, under.vertical))
    if after.left == 0.0 and after.right == 0.0 and after.held == 0.0:
        if math.isnan(table[FLIGHT_TIME + i]):
            table[FLIGHT_TIME + i] = t
        if m.guided == 0.0:
            beyond = abs(y.theta) - table[ALPHA + i]
            strongest = 0.0 if ground_rests(table, i) else table[STRONGEST + i]
            # else the ground may yet turn it back
            falling = beyond >= 0.0 and y.theta * y.omega > 0.0 and m.gravity * math.tan(beyond) >= strongest
            if peak_stands(table, i):
                return LATE_FLIGHT, after, row  # the peak stands: what flies is undamped vibration
            return (OVERTURNED if falling else FLIGHT), after, row
    table[EVENTS + i] += 1.0
    return (CHATTER if table[EVENTS + i] > EVENTS_IN_A_SAMPLE else SURVIVED), after, row


@kernel
def _look(table, i, exponent, finite, locate, history, row):
    """The piece in which something may have happened: status (RUNNING while the step is not done), time, next row."""
    m = model_of(table, i, exponent, finite)
    contact = contact_of(table, i)
    y = state_of(table, BEFORE + i)
    x, length, h = table[START + i], table[LENGTH + i], table[STEP + i]
    if contact.held != 0.0:  # which the pass does not know
        ground, under = ground_of(table, i, x), ground_of(table, i, x + length)
        end = step(m, y, state_of(table, BEFORE_RATES + i), contact, ground, length)
        k_end = rates(m, end, contact, under.horizontal, under.vertical)
        put_state(table, NOW + i, end)
        put_state(table, RATES + i, k_end)
    else:
        end, k_end = state_of(table, NOW + i), state_of(table, RATES + i)

    t = table[SAMPLE_TIME + i] + x + length
    verdict = table[VERDICT + i]
    if verdict == SEARCH:
        verdict = judge(table, i, m, y, end, k_end, contact, locate)
        if verdict == SEARCH:
            put_state(table, NOW + i, y)
            put_state(table, RATES + i, state_of(table, BEFORE_RATES + i))
            table[WATCHED + i] = 1.0
            return RUNNING, t, row
    _include(table, i, m, y, end, contact)
    substep = table[SUBSTEP + i]
    done = table[DONE + i] if x != substep * h else 0.0  # the pass leaves DONE as it was
    whole = length == h - done
    done += length
    if verdict != ACCEPT:
        whole = False
        status, contact, row = _happen(table, i, m, end, contact, int(verdict), t, x + length, history, row)
        if status != SURVIVED:
            return status, t, row
    if not whole and done < h:
        table[DONE + i] = done
        ready(table, i, m, contact, substep * h + done, h - done)
        return RUNNING, t, row
    substep += 1.0
    table[SUBSTEP + i] = substep
    if whole and contact.held == 0.0:
        # all signals are positive, and the pass has left their slopes
        table[WATCHED + i] = 0.0
        next_piece(table, i, substep * h, h)
    else:
        ready(table, i, m, contact, substep * h, h)
    t = table[SAMPLE_TIME + i] + substep * h
    status = fallen(table[NOW + LANES + i])
    if status != SURVIVED and history.shape[0] > 0:
        row = _write(history, row, t, state_of(table, NOW + i), contact, BETWEEN_SAMPLES)
    return status, t, row


@kernel
def _finish(table, i, exponent, finite, status, t, row, results):
    """What the run in lane ``i`` comes to: its line of ``results``, as SpringRun has it."""
    m = model_of(table, i, exponent, finite)
    y, contact = state_of(table, NOW + i), contact_of(table, i)
    t_read, base_left, base_right = (
        table[READ + i] * table[DT + i],
        table[READ + LANES + i],
        table[READ + 2 * LANES + i],
    )
    if table[READ + i] < 0.0:
        t_read = t
        base_left, base_right = base_of(table, i, m)
    loading = branches(m, _loading_of(table, i), contact, Contact(0.0, 0.0, 0.0, 0.0, 0.0), y)
    line = results[int(table[RUN + i])]
    line[RESULTS + int(table[WINDOW + i])] = table[EXTREME + i]
    line[0] = status
    line[1] = t
    line[2] = table[PEAK + i]
    line[3] = table[PEAK_TIME + i]
    line[4] = table[IMPACTS + i]
    line[5] = table[SEPARATIONS + i]
    line[6] = table[FLIGHT_TIME + i]
    line[7] = base_left - table[PLASTIC + i]
    line[8] = base_right - table[PLASTIC + i]
    line[9] = table[LOWEST + i]
    line[10] = table[LOWEST + LANES + i]
    line[11] = m.yield_force * loading.work_left
    line[12] = m.yield_force * loading.work_right
    line[13] = t_read
    line[14] = table[DRIFT + i]
    line[15] = table[DRIFT + LANES + i]
    line[16] = table[IMPACT_TIME + i]
    line[17] = row


@entry
def _rock(exponent, finite, runs, ground, locate, every_step, history, stop, table, results):
    """All ``runs``, as :func:`rock_side_by_side` has them; lines of ``results`` stay as they are after a stop."""
    recording = history.shape[0] > 0
    waiting, lanes, row = NONE, NONE, NONE
    while True:
        while lanes < LANES and waiting < len(runs):
            begin(table, lanes, waiting, runs, ground, exponent, finite)
            waiting += 1
            if recording:
                row = _write(history, row, 0.0, state_of(table, NOW + lanes), contact_of(table, lanes), SAMPLE)
            status = done(table, lanes, exponent, finite)
            if status == RUNNING:
                lanes += 1
            else:
                _finish(table, lanes, exponent, finite, status, 0.0, row, results)
        if lanes == 0 or stop[0] != 0:
            return
        while lanes == LANES or (lanes > 0 and waiting == len(runs)):
            one_pass(table, lanes, exponent, finite)
            lane = NONE
            while lane < lanes:
                status, t = RUNNING, 0.0
                if table[NEWS + lane] != CALM or recording:
                    status, t, row = _attend(
                        table, lane, exponent, finite, ground, locate, every_step, history, row, results
                    )
                if status == RUNNING:
                    lane += 1
                else:
                    _finish(table, lane, exponent, finite, status, t, row, results)
                    lanes -= 1
                    _move(table, lanes, lane)
            if stop[0] != 0:
                return


@inlined
def _attend(table, i, exponent, finite, ground, locate, every_step, history, row, results):
    """What the pass has left to do in lane ``i``: status, time, next row."""
    news = table[NEWS + i]
    status, t = SURVIVED, table[SAMPLE_TIME + i] + table[START + i]
    if news >= EVENTFUL:
        turned = news == TURNED and locate and table[VERDICT + i] == SEARCH
        if turned and seek_turn(table, i, model_of(table, i, exponent, finite)):
            return RUNNING, t, row
        status, t, row = _look(table, i, exponent, finite, locate, history, row)
        if status != SURVIVED:
            return status, t, row
    sampled = table[SUBSTEP + i] == table[SUBSTEPS + i]
    if sampled:
        t = _next_sample(table, i, ground)
        if table[SAMPLE_NUMBER + i] >= table[NEXT_WINDOW + i]:
            _close_window(table, i, results)
        table[EXTREME + i] = max(table[EXTREME + i], abs(table[NOW + LANES + i]))
    if history.shape[0] > 0 and (sampled or every_step):
        kind = SAMPLE if sampled else BETWEEN_SAMPLES
        row = _write(history, row, t, state_of(table, NOW + i), contact_of(table, i), kind)
    return (done(table, i, exponent, finite) if sampled else RUNNING), t, row


@kernel
def _next_sample(table, i, ground):
    """Lane ``i`` at its next sample; the time [s]."""
    sample = int(table[SAMPLE_NUMBER + i]) + 1
    t = sample * table[DT + i]
    table[SAMPLE_NUMBER + i] = sample
    table[SAMPLE_TIME + i] = t
    table[SUBSTEP + i] = 0.0
    table[START + i] = 0.0
    table[EVENTS + i] = 0.0
    _put_ground(table, i, ground, sample)
    return t


@kernel
def _close_window(table, i, results):
    """Keep the greatest |θ| of the window that lane ``i`` has left, and begin the one that it is in."""
    results[int(table[RUN + i]), RESULTS + int(table[WINDOW + i])] = table[EXTREME + i]
    window, begin_next = window_of(table[SAMPLE_NUMBER + i], table[SAMPLES + i])
    put_all(table, WINDOW + i, (window, begin_next, 0.0))


@kernel
def _move(table, i, j):
    """What is in lane ``i`` into lane ``j``."""
    for at in range(0, CELLS, LANES):
        table[at + j] = table[at + i]


def run_line(m, dt, substeps, quiet_samples, first_row, npts, patience=0, read_after=0, read_wait=0):
    """A run as :func:`rock_side_by_side` takes it: numbers only.

    Parameters
    ----------
    m : Springs
    dt : float
        Sampling interval [s]; each is ``substeps`` steps.
    quiet_samples : int
        Samples after the record.
    first_row, npts : int
        Where among the rows of the ground the motion begins, and how many it has.
    patience : int
        Samples that the run goes on at most, while by its energy the pier could still turn further than it has.
    read_after, read_wait : int
        Samples from the end of the record to the earliest moment at which residuals are read, and from there to the
        second reading, which tells how they drift; 0: they are read once, when the peak is decided.
    """
    exponent = 5.0 if m.exponent is None else m.exponent
    return (*m[:-2], exponent, dt, substeps, quiet_samples, first_row, npts, patience, read_after, read_wait)


def rock_side_by_side(exponent, finite, lines, ground, stop, locate=True, every_step=False, history=_NO_HISTORY):
    """Runs of piers on two springs, as many at a time as there are lanes.

    Parameters
    ----------
    exponent, finite
        Of all their Springs: what their types tell, a number or None, True or None.
    lines : ndarray, shape (runs, 19)
        Of :func:`run_line`.
    ground : ndarray, shape (rows, 4)
        Of :func:`rockbatch.core.ground.ground_rows`, of all their motions.
    stop : ndarray of one uint8
        Ends it at once when another thread sets it.
    locate : bool
        Locate events inside the step. Without, they take place at its end (first order; for comparison only).
    history : ndarray, shape (rows, 13)
        For a single run: filled with every sample and both sides of every event, as far as it goes.
    every_step : bool
        Also write the steps between samples.

    Returns
    -------
    ndarray, shape (runs, RESULTS + WINDOWS)
        As SpringRun has it, and the greatest |θ| in each window of the run; NaN for those that were stopped, and for
        windows that the run did not reach.
    """
    # A compiled function hands out nothing: making a tuple runs Python code, where Ctrl-C may strike.
    results = np.full((len(lines), RESULTS + WINDOWS), np.nan)
    _rock(exponent, finite, lines, ground, locate, every_step, history, stop, np.zeros(CELLS), results)
    return results


def rock_on_springs(m, horizontal, vertical, dt, substeps, quiet_samples, history, locate, every_step=False):
    """One run, of the pier ``m`` (Springs) under one motion; SpringRun.

    ``horizontal`` and ``vertical`` are ground accelerations [m/s²], shape (npts,), the vertical one may be empty; for
    the others see :func:`rock_side_by_side`.
    """
    lines = np.array([run_line(m, dt, substeps, quiet_samples, 0, len(horizontal))])
    ground = ground_rows(horizontal, vertical, dt)
    never = np.zeros(1, np.uint8)
    return spring_run(rock_side_by_side(m.exponent, m.finite, lines, ground, never, locate, every_step, history)[0])


def spring_run(line):
    """SpringRun of a line of results."""
    run = SpringRun(*line[:RESULTS].tolist())
    counts = ("status", "impacts", "separations", "rows")
    return run._replace(**{name: int(getattr(run, name)) for name in counts})
