"""When a run on springs is over, and when its residuals are read (THEORY.md, When a run is over).

Looked at once a sample, from the end of the record on.
"""

import math

from rockbatch.core.equations import geometry
from rockbatch.core.free_vibration import DECIDED, LEANS, OPEN, outlook_on_springs, rocking_period, summit
from rockbatch.core.kernel import kernel
from rockbatch.core.lanes import LOST, contact_of, model_of, state, supports_of
from rockbatch.core.outcome import GROWTH
from rockbatch.core.types import BOUC_WEN, GROWING, RESTLESS, RUNNING, SURVIVED, UNDECIDED


@kernel
def expect(lanes, i, quiet_samples, patience, read_after, read_wait):
    """Set what lane ``i`` waits for after its record; see ``recording.Line``. Its motion is known."""
    waiting, last = lanes.waiting, lanes.motion.npts[i] - 1.0
    waiting.samples[i] = last + quiet_samples
    waiting.earliest[i] = last + read_after
    waiting.patience[i] = patience
    waiting.read_wait[i] = read_wait
    waiting.longest[i] = max(waiting.samples[i], waiting.earliest[i] + read_wait) + patience
    waiting.decided_at[i] = LOST
    waiting.read[i], waiting.read_left[i], waiting.read_right[i] = LOST, math.nan, math.nan
    waiting.drift_left[i], waiting.drift_right[i] = math.nan, math.nan
    waiting.last_drift_left[i], waiting.last_drift_right[i] = 0.0, 0.0
    waiting.midway[i] = waiting.midway_tilt[i] = math.inf


@kernel
def peak_stands(lanes, i):
    """Whether it has been decided that nothing can exceed the peak, and nothing has."""
    decided_at = lanes.waiting.decided_at[i]
    return decided_at >= 0.0 and lanes.extremes.peak_time[i] <= decided_at * lanes.clock.dt[i]


@kernel
def _unstressed(m, position, z, on_spring, waiting):
    return position - m.yield_deflection * z if on_spring != 0.0 else waiting


@kernel
def base_of(lanes, i, m):
    """Unstressed positions [m] of both supports."""
    y, contact, supports = state(lanes.now, i), contact_of(lanes, i), supports_of(lanes, i)
    at = geometry(m, y.theta)
    left = _unstressed(m, y.v + at.lift_left, y.z_left, contact.left, supports.left)
    right = _unstressed(m, y.v + at.lift_right, y.z_right, contact.right, supports.right)
    return left, right


@kernel
def _tilt(lanes, i, m):
    """|Tilt| of the base [rad]."""
    left, right = base_of(lanes, i, m)
    return 0.5 * abs(left - right) / m.half_width


@kernel
def _outlook(lanes, i, m):
    """OPEN, DECIDED or LEANS (see ``free_vibration``); OPEN while the ground moves."""
    if not ground_rests(lanes, i):
        return OPEN
    waiting, dt, contact = lanes.waiting, lanes.clock.dt[i], contact_of(lanes, i)
    left, right = base_of(lanes, i, m)
    alone = lanes.clock.sample_time[i] - max(lanes.counts.moved[i], lanes.motion.npts[i] * dt)
    calm = contact.left != 0.0 and contact.right != 0.0 and alone >= rocking_period(m)
    ahead = 0.5 * waiting.patience[i] * dt
    last_left, last_right = ahead * waiting.last_drift_left[i], ahead * waiting.last_drift_right[i]
    first_left, first_right = last_left, last_right
    if not math.isnan(waiting.drift_left[i]):
        first_left, first_right = ahead * waiting.drift_left[i], ahead * waiting.drift_right[i]
    last, first = (last_left - last_right) / m.half_width, (first_left - first_right) / m.half_width
    to_right, to_left = max(0.0, first, last), max(0.0, -first, -last)
    sinking = max(0.0, -(last_left + last_right), -(first_left + first_right))
    peak = lanes.extremes.peak[i]
    return outlook_on_springs(
        m, state(lanes.now, i), contact, waiting.load[i], waiting.stored[i], left, right, peak, calm,
        to_right, to_left, sinking,
    )  # fmt: skip


@kernel
def ground_rests(lanes, i):
    """Whether the ground is at rest from the last sample on, for good."""
    over = lanes.clock.sample[i] >= lanes.motion.npts[i] - 1.0
    return over and lanes.ground.horizontal[i] == 0.0 and lanes.ground.vertical[i] == 0.0


@kernel
def _read_base(lanes, i, m):
    """Read the residuals: the positions of the supports, and how they have drifted since the last reading."""
    waiting, sample = lanes.waiting, lanes.clock.sample[i]
    left, right = base_of(lanes, i, m)
    if waiting.read[i] < 0.0:
        waiting.read[i], waiting.read_left[i], waiting.read_right[i] = sample, left, right
    else:
        seconds = waiting.read_wait[i] * lanes.clock.dt[i]
        drift_left = (left - waiting.last_left[i]) / seconds
        drift_right = (right - waiting.last_right[i]) / seconds
        waiting.last_drift_left[i], waiting.last_drift_right[i] = drift_left, drift_right
        if waiting.last_read[i] == waiting.read[i]:
            waiting.drift_left[i], waiting.drift_right[i] = drift_left, drift_right
    waiting.last_read[i], waiting.last_left[i], waiting.last_right[i] = sample, left, right


@kernel
def done(lanes, i, traits):
    """How the run in lane ``i`` ended if it is over at this sample, RUNNING where it goes on; residuals are read."""
    waiting, sample = lanes.waiting, lanes.clock.sample[i]
    samples, longest = waiting.samples[i], waiting.longest[i]
    if sample < waiting.earliest[i]:
        return RUNNING
    wait, decided = waiting.read_wait[i], waiting.decided_at[i] >= 0.0
    if decided and wait == 0.0:  # nothing can change any more
        return RUNNING if sample < samples else SURVIVED
    m = model_of(lanes, i, traits)
    if decided:
        if sample == waiting.last_read[i] + wait:
            _read_base(lanes, i, m)
        if sample < max(samples, waiting.read[i] + wait):
            return RUNNING
    outlook = _outlook(lanes, i, m)
    if outlook == DECIDED and not decided:
        waiting.decided_at[i] = sample
        _read_base(lanes, i, m)
    if outlook == DECIDED and sample >= max(samples, waiting.read[i] + wait):
        return SURVIVED
    if sample == (samples + longest) // 2:
        waiting.midway[i], waiting.midway_tilt[i] = lanes.extremes.peak[i], _tilt(lanes, i, m)
    return RUNNING if sample < longest else _given_up(lanes, i, m, outlook)


@kernel
def next_due(lanes, i):
    """Number of the next sample at which the run may be over, or something has to be read."""
    waiting, sample = lanes.waiting, lanes.clock.sample[i]
    if sample < waiting.earliest[i]:
        return waiting.earliest[i]
    if waiting.decided_at[i] < 0.0:
        return sample + 1.0
    if waiting.read_wait[i] == 0.0:
        return max(waiting.samples[i], sample + 1.0)
    return sample + 1.0


@kernel
def _given_up(lanes, i, m, outlook):
    """How a run ends that nothing has decided for so long; one that is not waited for is cut off as it is."""
    if lanes.waiting.patience[i] == 0.0:
        return SURVIVED
    if outlook == LEANS or abs(lanes.now.theta[i]) >= summit(m, lanes.waiting.load[i]):
        return UNDECIDED
    least = GROWTH * lanes.motion.alpha[i]
    turned = lanes.extremes.peak[i] > lanes.waiting.midway[i] + least
    tilted = _tilt(lanes, i, m) > lanes.waiting.midway_tilt[i] + least
    return GROWING if m.law == BOUC_WEN and turned and tilted else RESTLESS
