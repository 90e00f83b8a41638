"""What a lane does at a sample: it reads the ground, keeps its window's peak, may be over (THEORY.md, When a run is over)."""

import math

import numpy as np

from rockbatch.core.free_vibration import reach_on_rigid_base
from rockbatch.core.kernel import inlined, kernel
from rockbatch.core.outcome import window_of
from rockbatch.core.rigid.lane import block_in
from rockbatch.core.types import NEITHER, RESTLESS, RUNNING, SURVIVED, UNDECIDED


@inlined
def read_ground(lanes, i, ground):
    """The ground of lane ``i`` at its last sample; zero after the record."""
    sample = lanes.clock.sample[i]
    recorded = sample < lanes.ending.npts[i]
    row = np.uintp(lanes.ending.first_row[i] + sample if recorded else 0.0)  # unsigned: no index from the end
    under = lanes.ground
    under.horizontal[i] = ground[row, 0] if recorded else 0.0
    under.horizontal_slope[i] = ground[row, 1] if recorded else 0.0
    under.vertical[i] = ground[row, 2] if recorded else 0.0
    under.vertical_slope[i] = ground[row, 3] if recorded else 0.0


@kernel
def keep_greatest(lanes, i, extremes):
    """|θ| of lane ``i`` at a sample into the greatest one of its window."""
    window, sample, tilt = lanes.window, lanes.clock.sample[i], abs(lanes.now.theta[i])
    if sample >= window.begin_next[i]:
        close_window(lanes, i, extremes)
        window.number[i], window.begin_next[i] = window_of(sample, lanes.ending.samples[i])
        window.greatest[i] = tilt
    if not tilt <= window.greatest[i]:  # also where there is none yet
        window.greatest[i] = tilt


@kernel
def close_window(lanes, i, extremes):
    """Write the greatest |θ| of the window that lane ``i`` is in."""
    extremes[int(lanes.report.run[i]), int(lanes.window.number[i])] = lanes.window.greatest[i]


@kernel
def arrive(lanes, i, ground, extremes):
    """Lane ``i`` at a sample: its status, RUNNING where the run goes on."""
    read_ground(lanes, i, ground)
    keep_greatest(lanes, i, extremes)
    return look_ahead(lanes, i)


@kernel
def look_ahead(lanes, i):
    """Set the next milestone of lane ``i``, at a sample; its status, RUNNING where the run goes on."""
    ending, under, sample = lanes.ending, lanes.ground, lanes.clock.sample[i]
    last = ending.npts[i] - 1.0
    still = under.horizontal[i] == 0.0 and under.vertical[i] == 0.0
    ending.ground_rests[i] = 1.0 if sample > last or (sample == last and still) else 0.0
    ahead = max(ending.samples[i], sample + 1.0)
    if sample <= last:
        ahead = min(ahead, last if sample < last else last + 1.0)
    ending.milestone[i] = min(ahead, lanes.window.begin_next[i])
    return RUNNING if sample < ending.samples[i] else _done(lanes, i)


@kernel
def _done(lanes, i):
    """Status of lane ``i`` after its quiet time.

    Each bounce loses energy: nothing that comes later can exceed the peak if free rocking cannot reach it from here, or
    once the rotation has turned, for then its extreme has been seen, and those to come are lower.
    """
    ending, now = lanes.ending, lanes.now
    if now.side[i] == NEITHER:
        return SURVIVED
    m = block_in(lanes, i)
    reach = reach_on_rigid_base(now.theta[i], now.omega[i], m.alpha, m.p)
    seen = reach <= lanes.peak.theta[i] or (ending.turned[i] != 0.0 and reach < math.inf)
    if seen and ending.ground_rests[i] != 0.0:
        return SURVIVED
    if lanes.clock.sample[i] < ending.longest[i]:
        return RUNNING
    if ending.longest[i] == ending.samples[i]:  # nothing is waited for
        return SURVIVED
    return RESTLESS if reach < math.inf else UNDECIDED
