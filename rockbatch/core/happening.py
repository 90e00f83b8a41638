"""What happens in one lane between two passes: events, reversals that the pass has corrected, extremes inside a step."""

import math

from rockbatch.core.ending import ground_rests, peak_stands
from rockbatch.core.equations import on_ground, rates, step
from rockbatch.core.kernel import kernel
from rockbatch.core.lanes import (
    ACCEPT,
    SEARCH,
    contact_of,
    ground_of,
    loading_of,
    model_of,
    put_contact,
    put_loading,
    put_state,
    state,
    supports_of,
)
from rockbatch.core.loading import branches, close_left, close_right
from rockbatch.core.outcome import fallen
from rockbatch.core.recording import write
from rockbatch.core.reversal import pivots
from rockbatch.core.roots import largest_within, lowest_within
from rockbatch.core.search import again, judge, next_piece, ready
from rockbatch.core.transitions import handle
from rockbatch.core.types import (
    BEFORE_EVENT,
    CHATTER,
    FLIGHT,
    IMPACT_BOTH,
    IMPACT_LEFT,
    IMPACT_RIGHT,
    LATE_FLIGHT,
    OVERTURNED,
    RUNNING,
    SPRING_LEFT,
    SPRING_RIGHT,
    STEP,
    SURVIVED,
    Contact,
    Ground,
)

EVENTS_IN_A_SAMPLE = 20_000  # more than any decaying sequence of impacts needs


@kernel
def include(lanes, i, m, y, end, contact, t, h):
    """Bring extremes up to those of the piece of ``h`` [s] from ``y``, at ``t`` [s], to ``end``."""
    extremes = lanes.extremes
    found, peak = largest_within(y.theta, y.omega, end.theta, end.omega, h, extremes.peak[i])
    if found >= 0.0:
        extremes.peak[i] = peak
        extremes.peak_time[i] = t + found
    left, right = pivots(m, y)
    left_end, right_end = pivots(m, end)
    if contact.left != 0.0:
        extremes.lowest_left[i] = lowest_within(
            left.position, left.velocity, left_end.position, left_end.velocity, h, extremes.lowest_left[i]
        )
    if contact.right != 0.0:
        extremes.lowest_right[i] = lowest_within(
            right.position, right.velocity, right_end.position, right_end.velocity, h, extremes.lowest_right[i]
        )


@kernel
def close_turned(lanes, i, m):
    """Plastic work of the branches that the last step's corrected reversals have ended."""
    y, contact, turns = state(lanes.now, i), contact_of(lanes, i), lanes.turns
    left, right = pivots(m, y)
    loading = loading_of(lanes, i)
    if turns.left[i] >= 0.0 and contact.left_yields == 0.0:
        loading = close_left(m, loading, left.position - m.yield_deflection * y.z_left, turns.z_left[i])
    if turns.right[i] >= 0.0 and contact.right_yields == 0.0:
        loading = close_right(m, loading, right.position - m.yield_deflection * y.z_right, turns.z_right[i])
    put_loading(lanes, i, loading)


@kernel
def write_turns(lanes, i, m, t, ground, history, row):
    """Rows of the reversals that the pass has corrected in a step that began at ``t`` [s] over ``ground``: next row."""
    if history.shape[0] == 0:
        return row
    turns, after = lanes.turns, contact_of(lanes, i)
    left, right = turns.left[i], turns.right[i]
    y, k = state(lanes.before, i), state(lanes.before_rates, i)
    was_left = after.left_yields if left < 0.0 else 1.0 - after.left_yields
    was_right = after.right_yields if right < 0.0 else 1.0 - after.right_yields
    contact = Contact(after.left, after.right, was_left, was_right, 0.0)
    at = 0.0
    for _ in range(2):
        of_left = left >= 0.0 and (right < 0.0 or left <= right)
        when = left if of_left else right
        if when < 0.0:
            return row
        y = step(m, y, k, contact, ground, when - at)
        row = write(history, row, t + when, y, contact, BEFORE_EVENT)
        if of_left:
            contact = Contact(contact.left, contact.right, after.left_yields, contact.right_yields, 0.0)
            left = -1.0
        else:
            contact = Contact(contact.left, contact.right, contact.left_yields, after.right_yields, 0.0)
            right = -1.0
        row = write(history, row, t + when, y, contact, SPRING_LEFT if of_left else SPRING_RIGHT)
        ground = later(ground, when - at)
        k = rates(m, y, contact, ground.horizontal, ground.vertical)
        at = when
    return row


@kernel
def later(ground, x):
    return Ground(
        ground.horizontal + x * ground.horizontal_slope, ground.horizontal_slope,
        ground.vertical + x * ground.vertical_slope, ground.vertical_slope,
    )  # fmt: skip


@kernel
def _flight(lanes, i, m, y, t, ground):
    """What becomes of a pier that leaves the ground with both pivots at ``t`` [s]: status."""
    counts = lanes.counts
    if math.isnan(counts.flight_time[i]):
        counts.flight_time[i] = t
    if m.guided != 0.0:
        return SURVIVED
    if peak_stands(lanes, i):
        return LATE_FLIGHT  # the peak stands: what flies is undamped vibration
    beyond = abs(y.theta) - lanes.motion.alpha[i]
    # else the ground may yet turn it back
    falling = beyond >= 0.0 and y.theta * y.omega > 0.0 and m.gravity * math.tan(beyond) >= _strongest(lanes, i, ground)
    return OVERTURNED if falling else FLIGHT


@kernel
def _strongest(lanes, i, ground):
    """Strongest horizontal acceleration [m/s²] that the ground has or may still have."""
    strongest = 0.0
    if ground_rests(lanes, i):
        return strongest
    first = int(lanes.motion.first_row[i])
    for row in range(first, first + int(lanes.motion.npts[i])):
        strongest = max(strongest, abs(ground[row, 0]))
    return strongest


@kernel
def happen(lanes, i, m, y, contact, which, t, x, ground, history, row):
    """Event ``which`` at ``t`` [s], ``x`` [s] after the sample: status, new contacts and next row of the history."""
    under, counts = ground_of(lanes, i, x), lanes.counts
    row = write(history, row, t, y, contact, BEFORE_EVENT)
    y, after, supports, kind = handle(
        m, y, contact, supports_of(lanes, i), which, lanes.motion.rest[i], under.horizontal, under.vertical
    )
    row = write(history, row, t, y, after, kind)
    landed = 2 if kind == IMPACT_BOTH else (1 if kind in (IMPACT_LEFT, IMPACT_RIGHT) else 0)
    counts.impacts[i] += landed
    if landed > 0:
        counts.impact_time[i] = t
    if after.left != contact.left or after.right != contact.right or landed > 0:
        counts.moved[i] = t
    # a pivot may land and be lifted at once
    counts.separations[i] += landed - on_ground(after) + on_ground(contact)
    put_loading(lanes, i, branches(m, loading_of(lanes, i), contact, after, y))
    put_contact(lanes, i, after, supports)
    put_state(lanes.now, i, y)
    put_state(lanes.rates, i, rates(m, y, after, under.horizontal, under.vertical))
    if after.left == 0.0 and after.right == 0.0 and after.held == 0.0:
        status = _flight(lanes, i, m, y, t, ground)
        if status != SURVIVED:
            return status, after, row
    sample = lanes.clock.sample[i]
    counts.in_sample[i] = counts.in_sample[i] + 1.0 if counts.counted[i] == sample else 1.0
    counts.counted[i] = sample
    return (CHATTER if counts.in_sample[i] > EVENTS_IN_A_SAMPLE else SURVIVED), after, row


@kernel
def _held_step(lanes, i, m, contact, x, length):
    """The piece once more, with one pivot held, of which the pass does not know."""
    ground, under = ground_of(lanes, i, x), ground_of(lanes, i, x + length)
    end = step(m, state(lanes.before, i), state(lanes.before_rates, i), contact, ground, length)
    put_state(lanes.now, i, end)
    put_state(lanes.rates, i, rates(m, end, contact, under.horizontal, under.vertical))


@kernel
def look(lanes, i, traits, locate, ground, history, row):
    """The piece in which something may have happened.

    Returns
    -------
    status : int
        RUNNING while the step is not done, SURVIVED where it is, else how the run has ended.
    t : float
        Time [s] at which it is.
    row : int
        Next row of the history.
    """
    m, contact, clock = model_of(lanes, i, traits), contact_of(lanes, i), lanes.clock
    x, length, h = clock.start[i], clock.length[i], clock.step[i]
    if contact.held != 0.0:
        _held_step(lanes, i, m, contact, x, length)
    y, end = state(lanes.before, i), state(lanes.now, i)
    t = clock.sample_time[i] + x + length
    verdict = lanes.verdict[i]
    if verdict == SEARCH:
        verdict, shorter = judge(lanes, i, m, y, end, state(lanes.rates, i), contact, locate)
        if verdict == SEARCH:
            again(lanes, i, shorter)
            return RUNNING, t, row
    include(lanes, i, m, y, end, contact, clock.sample_time[i] + x, length)
    substep = clock.substep[i]
    done = clock.done[i] if x != substep * h else 0.0  # the pass leaves it as it was
    whole = length == h - done
    done += length
    if verdict != ACCEPT:
        whole = False
        status, contact, row = happen(lanes, i, m, end, contact, verdict, t, x + length, ground, history, row)
        if status != SURVIVED:
            return status, t, row
    if not whole and done < h:
        clock.done[i] = done
        ready(lanes, i, m, contact, substep * h + done, h - done, locate)
        return RUNNING, t, row
    substep += 1.0
    clock.substep[i] = substep
    if whole and contact.held == 0.0 and locate:  # all signals are positive
        lanes.watched[i] = 0.0
        next_piece(lanes, i, substep * h, h)
    else:
        ready(lanes, i, m, contact, substep * h, h, locate)
    t = clock.sample_time[i] + substep * h
    status = fallen(lanes.now.theta[i])
    if status != SURVIVED:
        row = write(history, row, t, state(lanes.now, i), contact, STEP)
    return status, t, row
