"""One pass over all lanes of piers on springs: a sub-step each, and whether it stands.

The compiler vectorises the first and the last loop, since they have no branches and no sums over lanes. Each lane has its own
pier, motion, step and time, and its arithmetic does not depend on its neighbours: a run gives the same bits in any company.
"""

import math
from typing import NamedTuple

from rockbatch.core import system
from rockbatch.core.clock import CALM, EVENTFUL, ON_ITS_SIDE, STANDS, UNSET, ground_at, peak_at_end
from rockbatch.core.devices.passing import integrate, settle
from rockbatch.core.kernel import hook, inlined, kernel, optional_hook
from rockbatch.core.rk4 import rk4
from rockbatch.core.roots import excess
from rockbatch.core.springs.backbone import Backbone, corner_beyond
from rockbatch.core.springs.laws import kept_sign, may_yield
from rockbatch.core.springs.model import Contact, SpringTraits, State, model_in, state_in
from rockbatch.core.springs.recovery import lag, top
from rockbatch.core.springs.reversal import corrected, once, pivot_accelerations, pivots, reversal
from rockbatch.core.system import rates
from rockbatch.core.table import ZERO, get, put, selected
from rockbatch.core.types import Instant


class Reversals(NamedTuple):
    """Reversals that the pass has corrected; valid for the sub-step only if ``keeps`` is negative."""

    keeps: float  # negative if a spring's velocity has lost the sign of its branch [m/s]
    surely: float  # positive unless there may be two reversals of a spring, or one that is too sharp for a correction
    left: float  # time of the left reversal [s], UNSET without one
    right: float
    z_left: float  # z then
    z_right: float
    unstressed_left: float  # unstressed position then [m]
    unstressed_right: float


class Range(NamedTuple):
    """Bounds on a pivot within a sub-step, by the Bézier points of the cubic through its ends."""

    lowest: float  # position [m]
    rise: float  # bound on z above its start
    rise_end: float  # bound on z above its end
    fall: float  # bounds on z below them
    fall_end: float


@inlined
def _range(m, start, end, h):
    """Return the Range of a pivot; z changes no faster than the pivot's velocity/δ_y, and in its direction."""
    third = h * (1.0 / 3.0)
    third_of_z = third * m.stiffness
    down, down_end = max(-start.velocity, 0.0), max(end.velocity, 0.0)
    lowest = min(end.position - third * down_end, start.position - third * down)
    rise, rise_end = third_of_z * max(start.velocity, 0.0), third_of_z * max(-end.velocity, 0.0)
    return Range(lowest, rise, rise_end, third_of_z * down, third_of_z * down_end)


class Support(NamedTuple):
    """Support of a pivot in a sub-step."""

    on_spring: float  # 1 if the pivot is on it
    yields: float  # inelastic branch of the spring, 0 on the elastic one
    unstressed: float  # position at which it is unstressed without its pivot [m]
    point: float  # yield point
    z: float
    z_end: float


@optional_hook
def short_of_corner(backbone, yields, least, clear):
    """Return the lesser of ``clear`` and a bound on what is left to the next corner of a ``backbone``, by the ``least`` z."""
    return clear


@short_of_corner.of(Backbone)
def _short_of_corner(backbone, yields, least, clear):
    return min(clear, least + corner_beyond(backbone, yields)) if yields != 0.0 else clear


@inlined
def _clear(m, support, start, end, within, h):
    """Return a number that is positive if a pivot has certainly neither separated nor landed, nor its spring changed its branch.

    Arguments that may be NaN come first in max and min, so that the result is NaN, too.
    """
    on_spring, yields, unstressed, point, z, z_end = support
    contact = -max(z_end + within.rise_end, z + within.rise)
    if m.damped is not None:  # greatest velocity by the parabola through both velocities and the displacement
        bulge = 1.5 * abs((end.position - start.position) / h - 0.5 * (start.velocity + end.velocity))
        contact -= lag(m) * (max(start.velocity, end.velocity) + bulge)
    least = min(z_end - within.fall_end, z - within.fall)
    gap = within.lowest - top(m, unstressed, z_end)  # without its pivot a damped support rises
    contact = min(contact, least - point) if may_yield(m.law, yields) else contact
    contact = short_of_corner(m.backbone, yields, least, contact)
    return contact if on_spring != 0.0 else gap


@inlined
def _not_lower(on_spring, start, end, within, lowest):
    """Return a number that is negative if a pivot may have its lowest position so far inside the sub-step."""
    return within.lowest - lowest if on_spring * min(-start.velocity, end.velocity) > 0.0 else 1.0


@inlined
def _free(lanes, i):
    """Return the contacts of lane ``i`` without a grazing one, which the pass does not handle."""
    at = lanes.contact
    return Contact(at.left[i], at.right[i], at.left_yields[i], at.right_yields[i], 0.0)


@inlined
def _signs(m, contact):
    """Return the signs of the velocities of both springs on their branches."""
    left = kept_sign(m.law, contact.left, contact.left_yields)
    return left, kept_sign(m.law, contact.right, contact.right_yields)


@inlined
def _stepped(traits, lanes, i, substep):
    """Integrate lane ``i`` over the sub-step into ``end``, on the present branches of its springs.

    Set ``keeps``, negative if the velocity of a spring has reversed.
    """
    m, h = model_in(traits, lanes, i), lanes.clock.step[i]
    y, contact, ground = state_in(traits, lanes.now, i), _free(lanes, i), ground_at(lanes, i, substep * h)
    k = rates(m, y, contact, ground)
    lanes.rates.v_rate[i], lanes.rates.omega[i] = k.v_rate, k.omega  # corrections need only these
    end = rk4(m, None, Instant(y, k, contact, None, ground), h)
    put(lanes.end, i, end)
    (left, right), (sign_left, sign_right) = pivots(m, end), _signs(m, contact)
    lanes.reversals.keeps[i] = lanes.model.rest[i] + min(sign_left * left.velocity, sign_right * right.velocity)


@inlined
def _next_turned(lanes, i, count):
    """Return the first lane from ``i`` on with a velocity reversal; ``count`` without one."""
    while i < count and not lanes.reversals.keeps[i] < 0.0:  # NaN in empty lanes
        i += 1
    return i


@kernel
def correct_lane(traits, lanes, i):
    """Correct the end of the sub-step of lane ``i`` for the velocity reversals in it."""
    m, h, reversals = model_in(traits, lanes, i), lanes.clock.step[i], lanes.reversals
    y, end, contact = get(lanes.now, i, State), get(lanes.end, i, State), _free(lanes, i)
    (left, right), (left_end, right_end), (sign_left, sign_right) = pivots(m, y), pivots(m, end), _signs(m, contact)
    acceleration_left, acceleration_right = pivot_accelerations(m, y, get(lanes.rates, i, State))
    turn_left = reversal(m, sign_left, left, acceleration_left, left_end, end.z_left, h)
    turn_right = reversal(m, sign_right, right, acceleration_right, right_end, end.z_right, h)
    put(lanes.end, i, corrected(m, contact, end, turn_left, turn_right))
    reversals.surely[i] = min(turn_left.surely, turn_right.surely)
    reversals.left[i] = h - turn_left.after if turn_left.after > 0.0 else UNSET
    reversals.right[i] = h - turn_right.after if turn_right.after > 0.0 else UNSET
    reversals.z_left[i], reversals.z_right[i] = turn_left.z, turn_right.z
    reversals.unstressed_left[i], reversals.unstressed_right[i] = turn_left.unstressed, turn_right.unstressed


@optional_hook
def nothing_new_of_shaft(shaft, lanes, i, y, end, h):
    """Return a number that is negative if a ``shaft`` that bends may have a greatest displacement inside the sub-step."""
    return 1.0


@optional_hook
def take_in_end(shaft, lanes, i, end, calm):
    """Raise the greatest displacements of a ``shaft`` that bends to those at the end of a sub-step, if it is ``calm``."""


@inlined
def _judged(traits, lanes, i, substep, settings, sure):
    """Set the step status of lane ``i``, and advance the lane if its sub-step is calm.

    Extremes at the end are recorded here; a sub-step that may contain one between its ends is not calm. One in which something
    else may occur is eventful: ``sure`` is positive otherwise.
    """
    m, h, step_status = model_in(traits, lanes, i), lanes.clock.step[i], lanes.step_status
    lowest, supports, low_left, low_right = lanes.lowest, lanes.supports, lanes.lowest.left[i], lanes.lowest.right[i]
    y, end, contact = state_in(traits, lanes.now, i), state_in(traits, lanes.end, i), _free(lanes, i)
    (left, right), (left_end, right_end), (sign_left, sign_right) = pivots(m, y), pivots(m, end), _signs(m, contact)
    in_left, in_right = _range(m, left, left_end, h), _range(m, right, right_end, h)
    on_left = Support(contact.left, contact.left_yields, supports.left[i], supports.yield_left[i], y.z_left, end.z_left)
    on_right = Support(
        contact.right, contact.right_yields, supports.right[i], supports.yield_right[i], y.z_right, end.z_right
    )
    clear_left, clear_right = (
        _clear(m, on_left, left, left_end, in_left, h),
        _clear(m, on_right, right, right_end, in_right, h),
    )
    turned = lanes.reversals.keeps[i] < 0.0
    once_left, once_right = once(m, sign_left, left, left_end, h), once(m, sign_right, right, right_end, h)
    surely = lanes.reversals.surely[i] if turned else min(once_left, once_right)
    tilt_end = abs(end.theta)
    clear = min(clear_left, clear_right, surely, ON_ITS_SIDE - tilt_end, sure)
    watched = max(step_status.watched[i], abs(lanes.contact.held[i]))
    stands = min(clear, (0.5 if settings.locate else -0.5) - watched) > 0.0  # False for NaN
    eventful = CALM if stands else EVENTFUL
    beyond = max(abs(y.theta), tilt_end) + excess(y.omega, end.omega, h)
    nothing_new = min(
        lanes.peak.theta[i] - beyond if y.omega * end.omega < 0.0 else 1.0,
        _not_lower(contact.left, left, left_end, in_left, low_left),
        _not_lower(contact.right, right, right_end, in_right, low_right),
        nothing_new_of_shaft(m.shaft, lanes, i, y, end, h),
    )
    to_take_in = max(-nothing_new, 1.0 if turned else 0.0, 0.5 - contact.left - contact.right)
    calm = max(to_take_in, eventful) <= 0.0
    stays = 1.0 if calm else 0.0
    peak_at_end(lanes, i, tilt_end if calm else 0.0, substep)
    lowest.left[i] = min(low_left, left_end.position if min(contact.left, stays) > 0.0 else math.inf)
    lowest.right[i] = min(low_right, right_end.position if min(contact.right, stays) > 0.0 else math.inf)
    take_in_end(m.shaft, lanes, i, end, calm)
    put(lanes.now, i, selected(calm, end, y))
    step_status.kind[i] = max(eventful, CALM if calm else STANDS)


@hook
def correct_reversals(shaft, traits, lanes, count):
    """Correct lanes with velocity reversals of springs; those of a ``shaft`` that bends are left to scalar code."""


@correct_reversals.of(type(None))
def _under_rigid_shaft(shaft, traits, lanes, count):
    _correct_by_law(traits.backbone, traits, lanes, count)


@hook
def _correct_by_law(backbone, traits, lanes, count):
    """Correct lanes with velocity reversals of springs; those of springs with a ``backbone`` are left to scalar code."""


@_correct_by_law.of(type(None))
def _correct(backbone, traits, lanes, count):
    i = _next_turned(lanes, ZERO, count)
    while i < count:
        correct_lane(traits, lanes, i)
        i = _next_turned(lanes, i + 1, count)


@_correct_by_law.of(Backbone)
def _leave_backbone(backbone, traits, lanes, count):
    leave_reversals(lanes, count)


@inlined
def leave_reversals(lanes, count):
    """Leave sub-steps with velocity reversals of springs to scalar code."""
    for i in range(count):
        lanes.reversals.surely[i] = -1.0


@system.one_pass.of(SpringTraits)
def one_pass(traits, lanes, count, substep, settings):
    """Integrate the first ``count`` lanes over a sub-step.

    Two loops, since the dependency chain of one would be too long for a processor to overlap two lanes. Lanes with reversals
    of springs, a few in a hundred, are corrected one by one.
    """
    for i in range(count):
        _stepped(traits, lanes, i, substep)
    correct_reversals(traits.shaft, traits, lanes, count)
    for i in range(count):
        _judged(traits, lanes, i, substep, settings, 1.0)


@system.in_pass.of(SpringTraits)
def in_pass(traits, lanes, i):
    """Return model, state and contact of lane ``i``; a grazing contact is left out."""
    return model_in(traits, lanes, i), state_in(traits, lanes.now, i), _free(lanes, i)


@system.gives_way.of(SpringTraits)
def gives_way(traits):
    """Return True."""
    return True


@system.pass_with_devices.of(SpringTraits)
def pass_with_devices(traits, lanes, equipment, count, substep, settings):
    """Integrate the first ``count`` lanes over a sub-step; one in which a spring's velocity reverses is eventful."""
    shared = equipment.shared[0]
    whole = integrate(traits, lanes, equipment, count, substep)
    for i in range(whole):
        m, contact, end = model_in(traits, lanes, i), _free(lanes, i), state_in(traits, shared.stage, i)
        put(lanes.end, i, end)
        (left, right), (sign_left, sign_right) = pivots(m, end), _signs(m, contact)
        # Without an allowance for rounding: friction that sticks holds a pivot but for a motion as small as that
        keeps = 1.0 if min(sign_left * left.velocity, sign_right * right.velocity) >= 0.0 else -1.0
        lanes.reversals.keeps[i] = 0.0
        _judged(traits, lanes, i, substep, settings, min(keeps, 0.5 - shared.verdict.doubts[i]))
    settle(traits, lanes, equipment, count, whole)
