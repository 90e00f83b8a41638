"""When a run on springs is over, and when its residuals are read (THEORY.md, 6 and 7).

Looked at once a sample, from the end of the record on.
"""

import math

from rockbatch.core.equations import geometry
from rockbatch.core.free_vibration import DECIDED, LEANS, OPEN, outlook_on_springs, rocking_period, summit
from rockbatch.core.kernel import kernel
from rockbatch.core.lanes import GROUND, LANES, NOW, PEAK, PEAK_TIME, SAMPLE_TIME, model_of, put_all, rows, state_of
from rockbatch.core.outcome import GROWTH
from rockbatch.core.search import contact_of, supports_of
from rockbatch.core.types import BOUC_WEN, GROWING, RESTLESS, SURVIVED, UNDECIDED

RUNNING = -1  # of a status: the run goes on

DT = rows(1)
NPTS = rows(1)
ALPHA = rows(1)
SAMPLE_NUMBER = rows(1)  # of the last sample
SAMPLES = rows(1)  # of record and quiet time
EARLIEST = rows(1)  # sample from which on residuals may be read
PATIENCE = rows(1)  # samples that a pier is waited for at most
LONGEST = rows(1)  # sample at which waiting ends
READ_WAIT = rows(1)  # samples between two readings; 0 where there is nothing to read twice
DECIDED_AT = rows(1)  # sample from which on nothing can exceed the peak, −1 before it
READ = rows(3)  # sample of the first reading, −1 before it; unstressed positions of both supports then [m]
LAST_READ = rows(3)  # likewise, of the last one
DRIFT = rows(2)  # of both supports from the first reading to the second [m/s], NaN before it
LAST_DRIFT = rows(2)  # likewise, between the last two, 0 before them
MOVED = rows(1)  # time at which a pivot last left the ground or landed [s]
MIDWAY = rows(1)  # greatest |θ| when half of the waiting is over [rad]


@kernel
def expect(table, i, quiet_samples, patience, read_after, read_wait):
    """Set what lane ``i`` waits for after its record; see ``two_springs.run_line``. NPTS is known."""
    last = table[NPTS + i] - 1.0
    table[SAMPLES + i] = last + quiet_samples
    table[EARLIEST + i] = last + read_after
    table[PATIENCE + i] = patience
    table[READ_WAIT + i] = read_wait
    table[LONGEST + i] = max(table[SAMPLES + i], table[EARLIEST + i] + read_wait) + patience
    table[DECIDED_AT + i] = -1.0
    put_all(table, READ + i, (-1.0, math.nan, math.nan))
    put_all(table, DRIFT + i, (math.nan, math.nan))
    put_all(table, LAST_DRIFT + i, (0.0, 0.0))
    table[MOVED + i] = 0.0
    table[MIDWAY + i] = math.inf


@kernel
def peak_stands(table, i):
    """Whether it has been decided that nothing can exceed the peak, and nothing has."""
    decided_at = table[DECIDED_AT + i]
    return decided_at >= 0.0 and table[PEAK_TIME + i] <= decided_at * table[DT + i]


@kernel
def _unstressed(m, position, z, on_spring, waiting):
    return position - m.yield_deflection * z if on_spring != 0.0 else waiting


@kernel
def base_of(table, i, m):
    """Unstressed positions [m] of both supports."""
    y, contact, supports = state_of(table, NOW + i), contact_of(table, i), supports_of(table, i)
    at = geometry(m, y.theta)
    left = _unstressed(m, y.v + at.lift_left, y.z_left, contact.left, supports.left)
    right = _unstressed(m, y.v + at.lift_right, y.z_right, contact.right, supports.right)
    return left, right


@kernel
def _outlook(table, i, m):
    """OPEN, DECIDED or LEANS (see ``free_vibration``); OPEN while the ground moves."""
    if not ground_rests(table, i):
        return OPEN
    contact = contact_of(table, i)
    left, right = base_of(table, i, m)
    alone = table[SAMPLE_TIME + i] - max(table[MOVED + i], table[NPTS + i] * table[DT + i])
    calm = contact.left != 0.0 and contact.right != 0.0 and alone >= rocking_period(m)
    ahead = 0.5 * table[PATIENCE + i] * table[DT + i]
    last_left, last_right = ahead * table[LAST_DRIFT + i], ahead * table[LAST_DRIFT + LANES + i]
    first_left, first_right = last_left, last_right
    if not math.isnan(table[DRIFT + i]):
        first_left, first_right = ahead * table[DRIFT + i], ahead * table[DRIFT + LANES + i]
    last, first = (last_left - last_right) / m.half_width, (first_left - first_right) / m.half_width
    to_right, to_left = max(0.0, first, last), max(0.0, -first, -last)
    sinking = max(0.0, -(last_left + last_right), -(first_left + first_right))
    return outlook_on_springs(
        m, state_of(table, NOW + i), contact, left, right, table[PEAK + i], calm, to_right, to_left, sinking
    )


@kernel
def ground_rests(table, i):
    """Whether the ground is at rest from the last sample on, for good."""
    over = table[SAMPLE_NUMBER + i] >= table[NPTS + i] - 1.0
    return over and table[GROUND + i] == 0.0 and table[GROUND + 2 * LANES + i] == 0.0


@kernel
def _read_base(table, i, m):
    """Read the residuals: the positions of the supports, and how they have drifted since the last reading."""
    sample, wait = table[SAMPLE_NUMBER + i], table[READ_WAIT + i]
    left, right = base_of(table, i, m)
    if table[READ + i] < 0.0:
        put_all(table, READ + i, (sample, left, right))
    else:
        seconds = wait * table[DT + i]
        last_left, last_right = table[LAST_READ + LANES + i], table[LAST_READ + 2 * LANES + i]
        drift = ((left - last_left) / seconds, (right - last_right) / seconds)
        put_all(table, LAST_DRIFT + i, drift)
        if table[LAST_READ + i] == table[READ + i]:
            put_all(table, DRIFT + i, drift)
    put_all(table, LAST_READ + i, (sample, left, right))


@kernel
def done(table, i, exponent, finite):
    """How the run in lane ``i`` ended if it is over at this sample, RUNNING where it goes on; residuals are read."""
    sample, samples, longest = table[SAMPLE_NUMBER + i], table[SAMPLES + i], table[LONGEST + i]
    if sample < table[EARLIEST + i]:
        return RUNNING
    wait, decided = table[READ_WAIT + i], table[DECIDED_AT + i] >= 0.0
    if decided and wait == 0.0:  # nothing can change any more
        return RUNNING if sample < samples else SURVIVED
    m = model_of(table, i, exponent, finite)
    if decided:
        if sample == table[LAST_READ + i] + wait:
            _read_base(table, i, m)
        if sample < max(samples, table[READ + i] + wait):
            return RUNNING
    outlook = _outlook(table, i, m)
    if outlook == DECIDED and not decided:
        table[DECIDED_AT + i] = sample
        _read_base(table, i, m)
    if outlook == DECIDED and sample >= max(samples, table[READ + i] + wait):
        return SURVIVED
    if sample == (samples + longest) // 2:
        table[MIDWAY + i] = table[PEAK + i]
    return RUNNING if sample < longest else _given_up(table, i, m, outlook)


@kernel
def _given_up(table, i, m, outlook):
    """How a run ends that nothing has decided for so long; one that is not waited for is cut off as it is."""
    if table[PATIENCE + i] == 0.0:
        return SURVIVED
    if outlook == LEANS or abs(table[NOW + LANES + i]) >= summit(m):
        return UNDECIDED
    ratchets = m.law == BOUC_WEN
    return GROWING if ratchets and table[PEAK + i] > table[MIDWAY + i] + GROWTH * table[ALPHA + i] else RESTLESS
