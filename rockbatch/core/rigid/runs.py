"""Runs on a rigid base, side by side: fixed steps of Runge–Kutta 4, events located inside the step, the rest redone.

The pass takes all lanes a step further. Where it reports that something may have happened, the step is taken again,
event by event; a lane at rest goes on by itself until the ground lifts it; and one that is over makes room for the next.
"""

import math

import numpy as np

from rockbatch.core.ground import ground_rows
from rockbatch.core.kernel import entry, kernel
from rockbatch.core.outcome import WINDOWS
from rockbatch.core.records import LANES, numbers, table
from rockbatch.core.rigid.ending import arrive, close_window, look_ahead, read_ground
from rockbatch.core.rigid.equations import carried_until, lift_off
from rockbatch.core.rigid.events import step_through, write
from rockbatch.core.rigid.lane import (
    CALM,
    EVENTFUL,
    LANE,
    LINE,
    RESULT,
    ROW,
    RUN,
    SAMPLED,
    Line,
    block_in,
    ground_in,
    motion_in,
    tick,
)
from rockbatch.core.rigid.passing import one_pass
from rockbatch.core.types import NEITHER, RUNNING, SAMPLE, STEP, SURVIVED, RigidRun

NONE = np.int64(0)  # a literal 0 would have every function that it is handed to compiled twice
NO_HISTORY = np.recarray(0, ROW)


@kernel
def after_step(lanes, i, ground, every_step, history, row, extremes):
    """Lane ``i`` at the end of a step, which may be a sample: status and next row."""
    clock = lanes.clock
    sampled = clock.substep[i] == 0.0
    status = arrive(lanes, i, ground, extremes) if sampled else RUNNING
    if history.shape[0] > 0 and (sampled or every_step):
        t = clock.time[i] + clock.substep[i] * clock.step[i]
        row = write(history, row, t, motion_in(lanes, i), SAMPLE if sampled else STEP)
    return status, row


@kernel
def _rests_on(lanes, i):
    """Whether lane ``i`` is at a sample, and rests until the next one."""
    if lanes.now.side[i] != NEITHER or lanes.clock.substep[i] != 0.0:
        return False
    m, under, dt = block_in(lanes, i), ground_in(lanes, i), lanes.clock.dt[i]
    return lift_off(m, under, dt)[0] < 0.0 and carried_until(m, under, dt) == math.inf


@kernel
def attend(lanes, i, ground, locate, every_step, history, row, extremes):
    """What the pass has left to do in lane ``i``, until it rocks or is over: status, time and next row."""
    clock, eventful = lanes.clock, lanes.report.news[i] == EVENTFUL
    while True:
        if eventful and _rests_on(lanes, i):
            tick(lanes, i, clock.substeps[i])
        elif eventful:
            status, t, row = step_through(lanes, i, locate, history, row)
            if status != SURVIVED:
                return status, t, row
        status, row = after_step(lanes, i, ground, every_step, history, row, extremes)
        if status != RUNNING or lanes.now.side[i] != NEITHER:
            return status, clock.time[i], row
        eventful = True


@kernel
def move(cells, i, j):
    """What is in lane ``i`` into lane ``j``."""
    for k in range(len(cells)):
        cells[k, j] = cells[k, i]


@kernel
def begin(lanes, cells, i, run, ground):
    """A ``run``'s numbers into lane ``i``: its status."""
    for k in range(len(cells)):
        cells[k, i] = run[k]
    read_ground(lanes, i, ground)
    return look_ahead(lanes, i)


@kernel
def finish(lanes, cells, i, status, t, row, runs, extremes):
    """The run in lane ``i`` is over: its numbers back to those of all ``runs``."""
    close_window(lanes, i, extremes)
    report = lanes.report
    report.status[i], report.t_end[i], report.rows[i] = status, t, row
    run = runs[int(report.run[i])]
    for k in range(len(cells)):
        run[k] = cells[k, i]


@entry
def _rock(runs, ground, locate, every_step, history, stop, lanes, cells, extremes):
    """All ``runs``, rows of the numbers of RUN: as they begin, and then as they end, but for a stop."""
    recording = history.shape[0] > 0
    waiting, count, row = NONE, NONE, NONE
    while True:
        while count < LANES and waiting < len(runs):
            status = begin(lanes, cells, count, runs[waiting], ground)
            waiting += 1
            if recording:
                row = write(history, row, 0.0, motion_in(lanes, count), SAMPLE)
            if status == RUNNING:
                count += 1
            else:
                finish(lanes, cells, count, status, 0.0, row, runs, extremes)
        if count == 0 or stop[0] != 0:
            return
        while count == LANES or (count > 0 and waiting == len(runs)):
            one_pass(lanes, count)
            i = NONE
            while i < count:
                status, t, news = RUNNING, 0.0, lanes.report.news[i]
                if news == SAMPLED and not recording:
                    read_ground(lanes, i, ground)
                elif news != CALM or recording:
                    status, t, row = attend(lanes, i, ground, locate, every_step, history, row, extremes)
                if status == RUNNING:
                    i += 1
                else:
                    finish(lanes, cells, i, status, t, row, runs, extremes)
                    count -= 1
                    move(cells, count, i)
            if stop[0] != 0:
                return


def run_line(m, theta, omega, dt, substeps, quiet_samples, first_row, npts, patience=0):
    """A run of the pier ``m`` (Block) as :func:`rock_side_by_side` takes it; the others as Line has them."""
    return Line(*m, theta, omega, dt, substeps, quiet_samples, first_row, npts, patience)


def rock_side_by_side(lines, ground, stop, locate=True, every_step=False, history=NO_HISTORY):
    """Runs of piers on a rigid base, as many at a time as there are lanes.

    Parameters
    ----------
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
        RigidRun's fields and ``extremes``, the greatest |θ| in each window of the run, NaN for those that it did not
        reach. The status of those that were stopped is RUNNING.
    """
    runs = _begun(np.array(lines, LINE).view(np.recarray))
    extremes = np.full((len(runs), WINDOWS), math.nan)
    _rock(numbers(runs), ground, locate, every_step, history, stop, *table(LANE), extremes)
    return _ended(runs, extremes)


def _begun(lines):
    """Runs as they begin, shape (runs,) of RUN, by their ``lines``."""
    runs = np.zeros(len(lines), RUN).view(np.recarray)
    block, now, clock, window, ending, tally = (
        runs.block, runs.now, runs.clock, runs.window, runs.ending, runs.tally,
    )  # fmt: skip
    block.alpha, block.p, block.gravity, block.restitution = (
        lines.alpha, lines.p, lines.gravity, lines.restitution,
    )  # fmt: skip
    now.theta, now.omega = lines.theta, lines.omega
    now.side = np.sign(np.where(lines.theta != 0.0, lines.theta, lines.omega))
    clock.dt, clock.step, clock.substeps = lines.dt, lines.dt / lines.substeps, lines.substeps
    runs.peak.theta = np.abs(lines.theta)
    ending.first_row, ending.npts = lines.first_row, lines.npts
    ending.samples = lines.npts - 1 + lines.quiet_samples
    ending.longest = ending.samples + lines.patience
    window.begin_next = 1.0  # the first is that of the first sample
    window.greatest = math.nan
    tally.t_flight = math.nan
    tally.t_rest = np.where(now.side == NEITHER, 0.0, math.nan)
    runs.report.run = np.arange(len(lines))
    runs.report.status = RUNNING
    return runs


def _ended(runs, extremes):
    """What :func:`rock_side_by_side` returns of ``runs`` as they ended."""
    results = np.recarray(len(runs), RESULT)
    report, tally, peak = runs.report, runs.tally, runs.peak
    results.status, results.t_end, results.rows = report.status, report.t_end, report.rows
    results.theta_max, results.t_max = peak.theta, peak.time
    results.impacts, results.lift_offs = tally.impacts, tally.lift_offs
    results.t_flight, results.t_rest = tally.t_flight, tally.t_rest
    results.extremes = extremes
    return results


def rock_on_rigid_base(
    m,
    theta,
    omega,
    horizontal,
    vertical,
    dt,
    substeps,
    quiet_samples,
    history=NO_HISTORY,
    locate=True,
    every_step=False,
):
    """One run, of the pier ``m`` (Block) under one motion; RigidRun.

    ``horizontal`` and ``vertical`` are ground accelerations [m/s²], shape (npts,), the vertical one may be empty; for
    the others see Line and :func:`rock_side_by_side`.
    """
    lines = [run_line(m, theta, omega, dt, substeps, quiet_samples, 0, len(horizontal))]
    ground = ground_rows(horizontal, vertical, dt)
    return rigid_run(rock_side_by_side(lines, ground, np.zeros(1, np.uint8), locate, every_step, history)[0])


def rigid_run(result):
    """RigidRun of one of the results."""
    return RigidRun(*result.tolist()[: len(RigidRun._fields)])
