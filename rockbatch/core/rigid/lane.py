"""What a run on a rigid base is: its line, its results, the rows of its history; and what a lane holds of it."""

from typing import NamedTuple

import numpy as np

from rockbatch.core.kernel import inlined, kernel
from rockbatch.core.outcome import WINDOWS
from rockbatch.core.records import record, side_by_side
from rockbatch.core.types import Block, Ground, RigidRun, Rocking


class Line(NamedTuple):
    """A run as it is asked for."""

    alpha: float  # of the Block
    p: float
    gravity: float
    restitution: float
    theta: float  # at the start [rad]; 0 with no velocity is rest
    omega: float  # [rad/s]
    dt: float  # sampling interval [s]
    substeps: int  # steps to a sampling interval
    quiet_samples: int  # after the record
    first_row: int  # where among the rows of the ground the motion begins
    npts: int  # and how many it has
    patience: int  # samples that the run goes on at most, while by its energy the block could still turn further


class Row(NamedTuple):
    """A moment of a history."""

    t: float  # [s]
    theta: float  # [rad]
    omega: float  # [rad/s]
    kind: float  # a sample, a step or an event (``types``)


class Clock(NamedTuple):
    """Where a lane is in time."""

    dt: float  # sampling interval [s]
    step: float  # dt/substeps [s]
    substeps: float
    sample: float  # the last one
    time: float  # of it [s]
    substep: float  # steps since then


class Peak(NamedTuple):
    """Greatest |θ| so far."""

    theta: float  # [rad]
    time: float  # [s]


class Window(NamedTuple):
    """The part of the run in which the lane is (``outcome``)."""

    number: float
    begin_next: float  # sample with which the next one begins
    greatest: float  # |θ| at a sample of it [rad]; NaN before the first


class Ending(NamedTuple):
    """What decides when the run is over."""

    first_row: float  # of the motion, among the rows of the ground
    npts: float
    samples: float  # of record and quiet time
    longest: float  # sample at which a block is no longer waited for
    ground_rests: float  # 1 from the sample on from which the ground does, for good
    turned: float  # 1 once the block has turned since then
    milestone: float  # next sample at which there is more to do than to read the ground


class Tally(NamedTuple):
    """What has happened so far."""

    impacts: float
    lift_offs: float
    events: float  # impacts since the last sample
    t_flight: float  # NaN without
    t_rest: float  # when it last came to rest [s]; NaN while it rocks


class Report(NamedTuple):
    """What a lane has to say."""

    run: float  # which one is in it
    news: float  # of the pass
    status: float  # of the run, how it ended
    t_end: float  # [s]
    rows: float  # of the history


LINE = record(Line)
ROW = record(Row)
RESULT = np.dtype([*record(RigidRun).descr, ("extremes", "f8", WINDOWS)])
"""As RigidRun has it, and the greatest |θ| [rad] at a sample in each window of the run, NaN where it has none."""

RUN, LANE = side_by_side(
    {
        "block": Block,
        "ground": Ground,  # at the last sample
        "now": Rocking,
        "clock": Clock,
        "peak": Peak,
        "window": Window,
        "ending": Ending,
        "tally": Tally,
        "report": Report,
    }
)

CALM = 0.0  # the lane is a step further
SAMPLED = 1.0  # likewise, and at a sample
ARRIVED = 2.0  # likewise, and at its milestone
EVENTFUL = 3.0  # something may have happened on the way: the step is still to be taken


@inlined
def block_in(lanes, i):
    """The Block in lane ``i``."""
    block = lanes.block
    return Block(block.alpha[i], block.p[i], block.gravity[i], block.restitution[i])


@inlined
def ground_in(lanes, i):
    """The Ground of lane ``i`` at its last sample."""
    ground = lanes.ground
    return Ground(ground.horizontal[i], ground.horizontal_slope[i], ground.vertical[i], ground.vertical_slope[i])


@inlined
def motion_in(lanes, i):
    """How the block in lane ``i`` rocks."""
    return Rocking(lanes.now.theta[i], lanes.now.omega[i], lanes.now.side[i])


@kernel
def tick(lanes, i, steps):
    """Lane ``i`` is ``steps`` steps further, the last of which may end at a sample."""
    clock = lanes.clock
    clock.substep[i] += steps
    if clock.substep[i] == clock.substeps[i]:
        clock.sample[i] += 1.0
        clock.time[i] = clock.sample[i] * clock.dt[i]
        clock.substep[i] = 0.0
        lanes.tally.events[i] = 0.0


@inlined
def put_motion(lanes, i, y):
    """Let the block in lane ``i`` rock as ``y``, a Rocking, says."""
    lanes.now.theta[i] = y.theta
    lanes.now.omega[i] = y.omega
    lanes.now.side[i] = y.side
