"""One pass over all lanes: each a piece of a step further, and what may have happened on the way.

The compiler turns the loop into vector instructions, several lanes at once, because nothing in it branches and nothing
sums over lanes. Each lane has its own pier, motion, step and time, and its arithmetic does not see its neighbours: a run
comes to the same bits in any company.
"""

from rockbatch.core.creep import lag, top
from rockbatch.core.equations import rates, step
from rockbatch.core.kernel import inlined
from rockbatch.core.lanes import (
    ATTEND,
    CALM,
    DUE,
    EVENTFUL,
    LOST,
    TURNED,
    contact_of,
    ground_of,
    model_of,
    put_state,
    state,
)
from rockbatch.core.laws import kept_sign, may_yield
from rockbatch.core.outcome import ON_ITS_SIDE
from rockbatch.core.reversal import corrected, pivot_accelerations, pivots, reversal
from rockbatch.core.roots import excess
from rockbatch.core.types import Contact


@inlined
def _clear(m, on_spring, yields, support, start, end, z, z_end, h):
    """Positive where a pivot surely has neither separated nor landed nor, elastic–perfectly plastic, begun to yield.

    z moves no faster than the pivot's velocity/δ_y: what a cubic may go beyond its ends bounds it too.
    """
    beyond = excess(start.velocity, end.velocity, h)
    beyond_z = beyond * m.stiffness
    contact = min(-z, -z_end) - beyond_z
    if m.damped is not None:  # the dashpot pulls most where the parabola through both velocities and the way is highest
        bulge = 1.5 * abs((end.position - start.position) / h - 0.5 * (start.velocity + end.velocity))
        contact -= lag(m) * (max(start.velocity, end.velocity) + bulge)
    until_yield = 1.0 + (min(z, z_end) - beyond_z)
    gap = min(start.position, end.position) - (top(m, support, z_end) + beyond)  # a support creeps up
    contact = min(contact, until_yield) if may_yield(m.law, yields) else contact
    return contact if on_spring != 0.0 else gap


@inlined
def _new_low(on_spring, start, end, lowest, h):
    """Whether a pivot may have been lower on its spring inside the piece than ever before, and at its ends."""
    least = min(start.position, end.position) - excess(start.velocity, end.velocity, h)
    return on_spring != 0.0 and start.velocity < 0.0 and end.velocity > 0.0 and least < lowest


@inlined
def _stepped(lanes, i, traits):
    """Lane ``i`` over its piece of a step, on the branches that its springs are on."""
    m = model_of(lanes, i, traits)
    y, k = state(lanes.now, i), state(lanes.rates, i)
    clock = lanes.clock
    end = step(m, y, k, _free(lanes, i), ground_of(lanes, i, clock.start[i]), clock.length[i])
    put_state(lanes.before, i, y)
    put_state(lanes.before_rates, i, k)
    put_state(lanes.now, i, end)


@inlined
def _free(lanes, i):
    """Contacts without a pivot that is held, of which the pass does not know."""
    at = contact_of(lanes, i)
    return Contact(at.left, at.right, at.left_yields, at.right_yields, 0.0)


@inlined
def _turned(lanes, i, traits):
    """Whether the piece of lane ``i`` stands, and its end as reversals have made it."""
    m = model_of(lanes, i, traits)
    y, end, contact, h = state(lanes.before, i), state(lanes.now, i), _free(lanes, i), lanes.clock.length[i]
    supports, rest = lanes.supports, lanes.motion.rest[i]
    (left, right), (left_end, right_end) = pivots(m, y), pivots(m, end)
    sign_left = kept_sign(m.law, contact.left, contact.left_yields)
    sign_right = kept_sign(m.law, contact.right, contact.right_yields)
    acceleration_left, acceleration_right = pivot_accelerations(m, y, state(lanes.before_rates, i))
    turn_left = reversal(m, sign_left, rest, left, acceleration_left, left_end, end.z_left, h)
    turn_right = reversal(m, sign_right, rest, right, acceleration_right, right_end, end.z_right, h)
    clear = min(
        _clear(
            m, contact.left, contact.left_yields, supports.left[i],
            left, left_end, y.z_left, end.z_left + turn_left.added, h,
        ),
        _clear(
            m, contact.right, contact.right_yields, supports.right[i],
            right, right_end, y.z_right, end.z_right + turn_right.added, h,
        ),
    )  # fmt: skip
    surely = clear > 0.0 and abs(end.theta) < ON_ITS_SIDE  # never of what is no number
    nothing_else = surely and not lanes.watched[i] > 0.0
    stands = nothing_else and not turn_left.doubts and not turn_right.doubts
    turned_left, turned_right = stands and turn_left.happened, stands and turn_right.happened
    turned = turned_left or turned_right
    other = corrected(m, contact, end, turn_left, turn_right)
    now = lanes.now
    now.v[i] = other.v if turned else end.v
    now.theta[i] = other.theta if turned else end.theta
    now.v_rate[i] = other.v_rate if turned else end.v_rate
    now.omega[i] = other.omega if turned else end.omega
    now.z_left[i] = other.z_left if turned else end.z_left
    now.z_right[i] = other.z_right if turned else end.z_right
    at, turns, loading = lanes.contact, lanes.turns, lanes.loading
    at.left_yields[i] = 1.0 - contact.left_yields if turned_left else contact.left_yields
    at.right_yields[i] = 1.0 - contact.right_yields if turned_right else contact.right_yields
    turns.left[i] = h - turn_left.after if turned_left else LOST
    turns.right[i] = h - turn_right.after if turned_right else LOST
    turns.z_left[i] = turn_left.z
    turns.z_right[i] = turn_right.z
    loads_left, loads_right = turned_left and sign_left > 0.0, turned_right and sign_right > 0.0
    loading.left[i] = left_end.position - m.yield_deflection * end.z_left if loads_left else loading.left[i]
    loading.right[i] = right_end.position - m.yield_deflection * end.z_right if loads_right else loading.right[i]
    loading.z_left[i] = turn_left.z if loads_left else loading.z_left[i]
    loading.z_right[i] = turn_right.z if loads_right else loading.z_right[i]
    closes = (turned_left and sign_left < 0.0) or (turned_right and sign_right < 0.0)
    standing = ATTEND if closes else CALM
    doubtful = TURNED if nothing_else else EVENTFUL
    lanes.news[i] = standing if stands else doubtful


@inlined
def _closed(lanes, i, traits):
    """Rates at the end of the piece of lane ``i``; extremes and the clock, where it stands."""
    m = model_of(lanes, i, traits)
    clock, extremes, news = lanes.clock, lanes.extremes, lanes.news[i]
    y, end, contact = state(lanes.before, i), state(lanes.now, i), _free(lanes, i)
    x, h, stands = clock.start[i], clock.length[i], news < EVENTFUL
    under = ground_of(lanes, i, x + h)
    put_state(lanes.rates, i, rates(m, end, contact, under.horizontal, under.vertical))

    # Extremes at the end of the piece are taken here, those inside it left to be looked at
    (left, right), (left_end, right_end) = pivots(m, y), pivots(m, end)
    tilt, tilt_end = abs(y.theta), abs(end.theta)
    peak, low_left, low_right = extremes.peak[i], extremes.lowest_left[i], extremes.lowest_right[i]
    new = (
        (y.omega * end.omega < 0.0 and max(tilt, tilt_end) + excess(y.omega, end.omega, h) > peak)
        or _new_low(contact.left, left, left_end, low_left, h)
        or _new_low(contact.right, right, right_end, low_right, h)
    )
    higher = stands and tilt_end > peak
    extremes.new[i] = 1.0 if new else 0.0
    extremes.peak[i] = tilt_end if higher else peak
    extremes.peak_time[i] = clock.sample_time[i] + x + h if higher else extremes.peak_time[i]
    extremes.lowest_left[i] = min(low_left, left_end.position) if stands and contact.left != 0.0 else low_left
    extremes.lowest_right[i] = min(low_right, right_end.position) if stands and contact.right != 0.0 else low_right

    substep = clock.substep[i] + (1.0 if stands else 0.0)
    sampled = substep == clock.substeps[i]
    sample = clock.sample[i] + (1.0 if sampled else 0.0)
    substep = 0.0 if sampled else substep
    clock.began[i] = x
    clock.took[i] = h
    clock.substep[i] = substep
    clock.start[i] = substep * clock.step[i] if stands else x
    clock.length[i] = clock.step[i] if stands else h
    clock.sample[i] = sample
    clock.sample_time[i] = sample * clock.dt[i]
    due = sampled and sample >= clock.due[i]
    in_window = extremes.in_window[i]
    extremes.in_window[i] = max(in_window, tilt_end) if sampled and not due else in_window
    news = ATTEND if stands and new else news
    lanes.news[i] = DUE if stands and due else news


@inlined
def one_pass(lanes, count, traits):
    """The first ``count`` lanes over their pieces of a step.

    Three loops, for what depends on each other within one is too long a chain for a processor to overlap two of them.
    """
    for i in range(count):
        _stepped(lanes, i, traits)
    for i in range(count):
        _turned(lanes, i, traits)
    for i in range(count):
        _closed(lanes, i, traits)
