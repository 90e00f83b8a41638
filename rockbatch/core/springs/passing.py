"""One pass over all lanes of piers on springs: a sub-step each, and whether it stands.

The compiler turns the loops into vector instructions, several lanes at once, because nothing in them branches and nothing
sums over lanes. Each lane has its own pier, motion, step and time, and its arithmetic does not see its neighbours: a run
comes to the same bits in any company.
"""

from typing import NamedTuple

from rockbatch.core import system
from rockbatch.core.clock import ATTEND, CALM, EVENTFUL, ON_ITS_SIDE, UNSET, ground_at
from rockbatch.core.kernel import inlined
from rockbatch.core.rk4 import rk4
from rockbatch.core.roots import excess
from rockbatch.core.springs.laws import kept_sign, may_yield
from rockbatch.core.springs.model import Contact, SpringTraits, State
from rockbatch.core.springs.recovery import lag, top
from rockbatch.core.springs.reversal import corrected, pivot_accelerations, pivots, reversal
from rockbatch.core.system import model, rates
from rockbatch.core.table import get, put


class StepStatus(NamedTuple):
    """Outcome of the pass, and the velocity reversals that it has corrected: when [s], UNSET without one, and z then."""

    kind: float
    left: float
    right: float
    z_left: float
    z_right: float
    closes: float  # 1 if a reversal has ended an inelastic branch
    watched: float  # above 0 where the sub-step shall be looked at whatever the pass makes of it


@inlined
def _clear(m, on_spring, yields, support, point, start, end, z, z_end, h):
    """Return a number, positive if a pivot surely has neither separated nor landed, nor reached its yield ``point``.

    z moves no faster than the pivot's velocity/δ_y: what a cubic may go beyond its ends bounds it too.
    """
    beyond = excess(start.velocity, end.velocity, h)
    beyond_z = beyond * m.stiffness
    contact = min(-z, -z_end) - beyond_z
    if m.damped is not None:  # the dashpot pulls most where the parabola through both velocities and the way is highest
        bulge = 1.5 * abs((end.position - start.position) / h - 0.5 * (start.velocity + end.velocity))
        contact -= lag(m) * (max(start.velocity, end.velocity) + bulge)
    until_yield = (min(z, z_end) - beyond_z) - point
    gap = min(start.position, end.position) - (top(m, support, z_end) + beyond)  # a support creeps up
    contact = min(contact, until_yield) if may_yield(m.law, yields) else contact
    return contact if on_spring != 0.0 else gap


@inlined
def _not_lower(on_spring, start, end, lowest, h):
    """Return a number, negative if a pivot may have been lower on its spring inside the sub-step than before, and at its ends."""
    least = min(start.position, end.position) - excess(start.velocity, end.velocity, h)
    return least - lowest if on_spring * min(-start.velocity, end.velocity) > 0.0 else 1.0


@inlined
def _stepped(traits, lanes, i, substep):
    """Take lane ``i`` through the sub-step, on the branches that its springs are on."""
    m, h = model(traits, lanes, i), lanes.clock.step[i]
    y, contact, ground = get(lanes.now, i, State), _free(lanes, i), ground_at(lanes, i, substep * h)
    k = rates(m, y, contact, ground.horizontal, ground.vertical)
    put(lanes.rates, i, k)
    put(lanes.end, i, rk4(m, None, y, k, contact, ground, h))


@inlined
def _free(lanes, i):
    """Return contacts without a grazing one, of which the pass does not know."""
    at = lanes.contact
    return Contact(at.left[i], at.right[i], at.left_yields[i], at.right_yields[i], 0.0)


@inlined
def _turned(traits, lanes, i, settings):
    """Correct reversals in the sub-step of lane ``i``, and say whether it stands."""
    m = model(traits, lanes, i)
    y, end, contact, h = get(lanes.now, i, State), get(lanes.end, i, State), _free(lanes, i), lanes.clock.step[i]
    supports, rest, step_status = lanes.supports, lanes.clock.rest[i], lanes.step_status
    (left, right), (left_end, right_end) = pivots(m, y), pivots(m, end)
    sign_left = kept_sign(m.law, contact.left, contact.left_yields)
    sign_right = kept_sign(m.law, contact.right, contact.right_yields)
    acceleration_left, acceleration_right = pivot_accelerations(m, y, get(lanes.rates, i, State))
    turn_left = reversal(m, sign_left, rest, left, acceleration_left, left_end, end.z_left, h)
    turn_right = reversal(m, sign_right, rest, right, acceleration_right, right_end, end.z_right, h)
    clear_left = _clear(
        m, contact.left, contact.left_yields, supports.left[i], supports.yield_left[i],
        left, left_end, y.z_left, end.z_left + turn_left.added, h,
    )  # fmt: skip
    clear_right = _clear(
        m, contact.right, contact.right_yields, supports.right[i], supports.yield_right[i],
        right, right_end, y.z_right, end.z_right + turn_right.added, h,
    )  # fmt: skip
    clear = min(clear_left, clear_right, turn_left.surely, turn_right.surely, ON_ITS_SIDE - abs(end.theta))
    stands = min(clear, (0.5 if settings.locate else -0.5) - step_status.watched[i]) > 0.0  # never of what is no number
    after_left, after_right = turn_left.after if stands else 0.0, turn_right.after if stands else 0.0
    turned_left, turned_right = after_left > 0.0, after_right > 0.0
    put(lanes.end, i, corrected(m, contact, end, turn_left, turn_right))  # without a reversal, by nothing
    at, loading = lanes.contact, lanes.loading
    at.left_yields[i] = abs((1.0 if turned_left else 0.0) - contact.left_yields)
    at.right_yields[i] = abs((1.0 if turned_right else 0.0) - contact.right_yields)
    step_status.left[i] = h - after_left if turned_left else UNSET
    step_status.right[i] = h - after_right if turned_right else UNSET
    step_status.z_left[i] = turn_left.z
    step_status.z_right[i] = turn_right.z
    begins_left, begins_right = sign_left * after_left, sign_right * after_right  # above 0 if an inelastic branch does
    loads_left, loads_right = begins_left > 0.0, begins_right > 0.0
    loading.left[i] = left_end.position - m.yield_deflection * end.z_left if loads_left else loading.left[i]
    loading.right[i] = right_end.position - m.yield_deflection * end.z_right if loads_right else loading.right[i]
    loading.z_left[i] = turn_left.z if loads_left else loading.z_left[i]
    loading.z_right[i] = turn_right.z if loads_right else loading.z_right[i]
    step_status.closes[i] = 1.0 if min(begins_left, begins_right) < 0.0 else 0.0
    step_status.kind[i] = CALM if stands else EVENTFUL


@inlined
def _closed(traits, lanes, i, substep, settings):
    """Let lane ``i`` go on from the end of its sub-step if it is calm.

    Extremes at the end are taken here; a sub-step that may hold one between its ends is not calm.
    """
    m, step_status = model(traits, lanes, i), lanes.step_status
    clock, peak, lowest = lanes.clock, lanes.peak, lanes.lowest
    y, end, h = get(lanes.now, i, State), get(lanes.end, i, State), clock.step[i]
    (left, right), (left_end, right_end) = pivots(m, y), pivots(m, end)
    on_left, on_right = lanes.contact.left[i], lanes.contact.right[i]
    low_left, low_right = lowest.left[i], lowest.right[i]
    tilt_end = abs(end.theta)
    beyond = max(abs(y.theta), tilt_end) + excess(y.omega, end.omega, h)
    nothing_new = min(
        peak.theta[i] - beyond if y.omega * end.omega < 0.0 else 1.0,
        _not_lower(on_left, left, left_end, low_left, h),
        _not_lower(on_right, right, right_end, low_right, h),
    )
    written = max(step_status.left[i], step_status.right[i]) if settings.recording else UNSET
    shown = 1.0 if written >= 0.0 else 0.0
    to_attend = max(-nothing_new, step_status.closes[i], shown, 0.5 - on_left - on_right)
    calm = max(to_attend, step_status.kind[i]) <= 0.0
    reached = tilt_end if calm else 0.0
    peak.time[i] = clock.sample[i] * clock.dt[i] + (substep + 1.0) * h if reached > peak.theta[i] else peak.time[i]
    peak.theta[i] = max(peak.theta[i], reached)
    lowest.left[i] = min(low_left, left_end.position) if calm and on_left != 0.0 else low_left
    lowest.right[i] = min(low_right, right_end.position) if calm and on_right != 0.0 else low_right
    put(lanes.now, i, State(
        end.v if calm else y.v,
        end.theta if calm else y.theta,
        end.v_rate if calm else y.v_rate,
        end.omega if calm else y.omega,
        end.z_left if calm else y.z_left,
        end.z_right if calm else y.z_right,
    ))  # fmt: skip
    step_status.kind[i] = max(step_status.kind[i], CALM if calm else ATTEND)


@system.one_pass.of(SpringTraits)
def one_pass(traits, lanes, count, substep, settings):
    """Take the first ``count`` lanes a sub-step further.

    Three loops, for what depends on each other within one is too long a chain for a processor to overlap two of them.
    """
    for i in range(count):
        _stepped(traits, lanes, i, substep)
    for i in range(count):
        _turned(traits, lanes, i, settings)
    for i in range(count):
        _closed(traits, lanes, i, substep, settings)
