"""State of every run, whatever its system: time, ground, peak, windows, counts of events, flights."""

import math
from typing import NamedTuple

import numpy as np

from rockbatch.core.kernel import inlined, kernel, shared
from rockbatch.core.roots import hermite, largest_within, turning_point
from rockbatch.core.types import NOT_FINITE, OVERTURNED, SURVIVED, Ground

ON_ITS_SIDE = 0.5 * math.pi
"""Rotation [rad] at which a pier lies on its side."""

WINDOWS = 32
"""Equal windows of a run whose greatest |θ| at samples summarise its trajectory."""

UNSET = -1.0
"""Value of a time or a sample that is not known yet."""

CALM, STANDS, EVENTFUL = 0.0, 1.0, 2.0
"""Step status of a lane after a pass: calm; the sub-step stands, but may contain an extreme or a reversal to record; or it
has to be repeated event by event."""


class Timing(NamedTuple):
    """Request of a run: its motion, its steps and its length."""

    dt: float  # sampling interval [s]
    substeps: float  # steps to a sampling interval
    quiet_samples: float  # of the free-vibration tail after the record
    first_row: float  # first row of the motion in the ground
    npts: float  # samples of the motion
    patience: float  # most further samples while, by its energy, the pier could still exceed its peak


TIMING = tuple((name, float) for name in Timing._fields)


class Clock(NamedTuple):
    """Number and time of the run in a lane."""

    number: float  # of the run
    first_row: float  # of its motion among the ground's rows
    npts: float
    samples: float  # of record and free-vibration tail
    dt: float  # sampling interval [s]
    step: float  # dt/substeps [s]
    sample: float  # number of the last sample
    due: float  # number of the next sample at which windows, peaks or the end have to be checked
    alpha: float  # slenderness [rad]


class Peak(NamedTuple):
    """Greatest |θ| so far, of the run and of its present window."""

    theta: float  # [rad]
    time: float  # [s]
    window: float  # number of the present window
    next_window: float  # sample with which the next one begins
    in_window: float  # greatest |θ| at a sample of this one [rad]
    decided_at: float  # sample from which on nothing can exceed the peak, UNSET before it


class Tally(NamedTuple):
    """Counts and times of events so far."""

    impacts: float
    uplifts: float
    events: float  # in sample ``counted``
    counted: float
    flights: float
    airborne: float  # when the present flight began [s], NaN on the ground
    t_flight: float  # first time of flight [s]; NaN without one
    flight_duration: float  # of all flights [s]
    flight_height: float  # greatest, of the lower pivot [m]
    t_impact: float  # of the last impact [s]; NaN without one
    t_rest: float  # when the pier last came to rest [s]; NaN while it moves
    moved: float  # time at which a pivot last left the ground or landed [s]
    repeated: float  # sub-steps that were integrated event by event


class StepStatus(NamedTuple):
    """Outcome of the pass over a sub-step, and of the event functions at its start."""

    kind: float  # CALM, STANDS or EVENTFUL
    watched: float  # above 0 unless the sub-step before ended with all event functions clear of zero


class Clearances(NamedTuple):
    """Heights of both pivots above their landing places [m], and their rates [m/s]."""

    left: float
    right: float
    left_rate: float
    right_rate: float


COMMON = {"clock": Clock, "ground": Ground, "peak": Peak, "tally": Tally, "step_status": StepStatus}
"""Parts of every table of lanes; the ground is at the last sample."""


@kernel
def fallen(theta):
    """Return OVERTURNED from |θ| = π/2 [rad] on, NOT_FINITE from π on or if ``theta`` is NaN, else SURVIVED."""
    if abs(theta) < ON_ITS_SIDE:
        return SURVIVED
    return OVERTURNED if abs(theta) < 2.0 * ON_ITS_SIDE else NOT_FINITE


@kernel
def start_clock(lanes, i, number, run):
    """Set clock, counts and peaks of run ``number`` at its start."""
    clock, peak, tally, theta = lanes.clock, lanes.peak, lanes.tally, run.theta
    clock.number[i], clock.first_row[i], clock.npts[i] = number, run.first_row, run.npts
    clock.samples[i] = run.npts - 1.0 + run.quiet_samples
    clock.dt[i], clock.step[i] = run.dt, run.dt / run.substeps
    clock.sample[i], clock.due[i], clock.alpha[i] = 0.0, 1.0, math.atan2(run.half_width, run.height)
    lanes.step_status.watched[i] = 1.0
    peak.theta[i], peak.time[i], peak.decided_at[i] = abs(theta), 0.0, UNSET
    peak.window[i], peak.next_window[i], peak.in_window[i] = 0.0, 1.0, abs(theta)  # the first one is the first sample
    tally.impacts[i] = tally.uplifts[i] = tally.events[i] = tally.counted[i] = tally.flights[i] = 0.0
    tally.flight_duration[i] = tally.flight_height[i] = tally.moved[i] = tally.repeated[i] = 0.0
    tally.airborne[i] = tally.t_flight[i] = tally.t_impact[i] = math.nan
    tally.t_rest[i] = 0.0 if theta == 0.0 else math.nan


@inlined
def read_ground(lanes, i, ground):
    """Copy accelerations and slopes at the last sample of lane ``i`` into ``lanes.ground``; zeros after the record."""
    at, sample = lanes.ground, lanes.clock.sample[i]
    moves = sample < lanes.clock.npts[i]
    # Conversion to a signed integer is one instruction; an unsigned index needs no check for counting from the end
    row = np.uintp(np.intp(lanes.clock.first_row[i] + (sample if moves else 0.0)))
    horizontal, horizontal_slope = ground[row, 0], ground[row, 1]
    vertical, vertical_slope = ground[row, 2], ground[row, 3]
    at.horizontal[i], at.horizontal_slope[i] = horizontal if moves else 0.0, horizontal_slope if moves else 0.0
    at.vertical[i], at.vertical_slope[i] = vertical if moves else 0.0, vertical_slope if moves else 0.0


@inlined
def ground_at(lanes, i, x):
    """Return the Ground of lane ``i`` at ``x`` [s] after its last sample."""
    at = lanes.ground
    a_slope, c_slope = at.horizontal_slope[i], at.vertical_slope[i]
    return Ground(at.horizontal[i] + x * a_slope, a_slope, at.vertical[i] + x * c_slope, c_slope)


@kernel
def ground_rests(lanes, i):
    """Return True once the record has no acceleration left: at its last sample if both components are 0 there, else one later."""
    over = lanes.clock.sample[i] >= lanes.clock.npts[i] - 1.0
    return over and lanes.ground.horizontal[i] == 0.0 and lanes.ground.vertical[i] == 0.0


@shared
def window_of(sample, samples):
    """Return the window (from 0) of a run of ``samples`` that contains ``sample``, and the first sample of the next one.

    The last of WINDOWS windows extends to the end of the run: its next sample is inf.
    """
    window = min(int(sample * WINDOWS / max(samples, 1.0)), WINDOWS - 1)
    begin_next = float(math.ceil((window + 1) * samples / WINDOWS)) if window < WINDOWS - 1 else math.inf
    return float(window), begin_next


@kernel
def close_window(lanes, i, results):
    """Write the greatest |θ| at samples of the present window to the results."""
    results[int(lanes.clock.number[i])].extremes[int(lanes.peak.window[i])] = lanes.peak.in_window[i]


@kernel
def turn_window(lanes, i, theta, results):
    """Write the present window's greatest |θ| and begin the next window at ``theta`` [rad], if the sample belongs to that."""
    peak, sample = lanes.peak, lanes.clock.sample[i]
    if sample >= peak.next_window[i]:
        close_window(lanes, i, results)
        peak.window[i], peak.next_window[i] = window_of(sample, lanes.clock.samples[i])
        peak.in_window[i] = abs(theta)


@kernel
def note_motion_over(lanes, i, results):
    """Write the greatest |θ| so far to the results if this is the record's last sample."""
    if lanes.clock.sample[i] == lanes.clock.npts[i] - 1.0:
        results[int(lanes.clock.number[i])].theta_in_motion = lanes.peak.theta[i]


@inlined
def motion_due(lanes, i):
    """Return the number of the record's last sample; inf from that sample on."""
    last = lanes.clock.npts[i] - 1.0
    return last if lanes.clock.sample[i] < last else math.inf


@kernel
def peak_decided(lanes, i):
    """Return True if the peak was decided to be final and has not been exceeded since."""
    decided_at = lanes.peak.decided_at[i]
    return decided_at >= 0.0 and lanes.peak.time[i] <= decided_at * lanes.clock.dt[i]


@kernel
def include_peak(lanes, i, part, start, done):
    """Raise the peak of lane ``i`` to the greatest |θ| in a Part, if that is greater.

    The Part begins ``done`` [s] after the start of the sub-step, and that ``start`` [s] after the last sample; the times are
    added in the same order as those of events, to give the same bits.
    """
    y, end = part.start.y, part.end
    at, peak = largest_within(y.theta, y.omega, end.theta, end.omega, part.length, lanes.peak.theta[i])
    if at >= 0.0:
        lanes.peak.theta[i] = peak
        lanes.peak.time[i] = lanes.clock.sample[i] * lanes.clock.dt[i] + (start + (done + at))


@inlined
def peak_at_end(lanes, i, tilt, substep):
    """Raise the peak of lane ``i`` to ``tilt`` = |θ| at the end of its sub-step, if that is greater."""
    clock, peak = lanes.clock, lanes.peak
    # abs changes nothing, but keeps the compiler from a slow masked store of the number that is there already
    theta, time = abs(peak.theta[i]), abs(peak.time[i])
    peak.theta[i] = max(theta, tilt)
    peak.time[i] = clock.sample[i] * clock.dt[i] + (substep + 1.0) * clock.step[i] if tilt > theta else time


@kernel
def include_height(lanes, i, start, end, h):
    """Raise the flight height to the greatest of the lower pivot in a smooth part of ``h`` [s] between two Clearances.

    The lower of two cubics is highest at an end, at its own maximum, or where both intersect.
    """
    if h == 0.0:
        return
    left, right, left_rate, right_rate = start
    left_end, right_end, left_end_rate, right_end_rate = end
    highest = max(min(left, right), min(left_end, right_end))
    gap, gap_end = left - right, left_end - right_end
    meet = h * gap / (gap - gap_end) if gap * gap_end < 0.0 else 0.0
    for _ in range(4):  # from the intersection of the chords to that of the cubics, by chord slopes
        value = hermite(gap, left_rate - right_rate, gap_end, left_end_rate - right_end_rate, h, meet)
        meet = min(max(meet - value * h / (gap_end - gap), 0.0), h) if gap * gap_end < 0.0 else 0.0
    for x in (
        turning_point(left, left_rate, left_end, left_end_rate, h) if left_rate * left_end_rate < 0.0 else 0.0,
        turning_point(right, right_rate, right_end, right_end_rate, h) if right_rate * right_end_rate < 0.0 else 0.0,
        meet,
    ):
        lower = min(
            hermite(left, left_rate, left_end, left_end_rate, h, x),
            hermite(right, right_rate, right_end, right_end_rate, h, x),
        )
        highest = max(highest, lower)
    lanes.tally.flight_height[i] = max(lanes.tally.flight_height[i], highest)


@kernel
def note_flight(lanes, i, flies, t):
    """Begin a flight at ``t`` [s] if the pier ``flies`` and did not before, or end it if it no longer does."""
    tally = lanes.tally
    began = tally.airborne[i]
    if flies and math.isnan(began):
        tally.flights[i] += 1.0
        tally.airborne[i] = t
        if math.isnan(tally.t_flight[i]):
            tally.t_flight[i] = t
    elif not flies and not math.isnan(began):
        tally.flight_duration[i] += t - began
        tally.airborne[i] = math.nan
