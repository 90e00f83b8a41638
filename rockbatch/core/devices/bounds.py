"""Bounds of a device in a sub-step of the pass: that it surely has no event, and its greatest force, stroke and speed.

They take the elongation of the device as the cubic of its values and speeds at both ends of the sub-step.
"""

import math
from typing import NamedTuple

from rockbatch.core.devices.elongation import Gap, lifted
from rockbatch.core.devices.laws import SPRING, STICKS, TAUT, TENDON, YIELDING, Use, tension
from rockbatch.core.devices.pull import TRAVEL, share_near_reversal
from rockbatch.core.kernel import inlined
from rockbatch.core.roots import NO_ACCELERATION, excess, inner_points
from rockbatch.core.system import in_pass
from rockbatch.core.table import get


class Course(NamedTuple):
    """A device in a sub-step."""

    start: Gap
    end: Gap
    lift: float  # acceleration of its elongation at the start [m/s²]
    lift_end: float
    steepest: float  # greatest |acceleration| at the start, by the ground motion at either end of the sub-step
    state: float
    state_end: float
    h: float  # [s]
    dt: float  # sampling interval [s]
    speed: float  # that is rounding [m/s]
    acceleration: float
    length: float


@inlined
def _keeps_direction(goes, c):
    """Return a number that is positive if the speed of a device certainly keeps its direction, or is never more than rounding."""
    early, late = inner_points(c.start.speed, c.lift, c.end.speed, c.lift_end, c.h)
    fastest, keenest = max(abs(c.start.speed), abs(c.end.speed)), max(abs(c.lift), abs(c.lift_end))
    still = min(c.speed - fastest, c.acceleration - keenest) >= 0.0  # at the pivot about which a block rocks
    keeps = min(min(goes * early, goes * late), min(goes * c.start.speed, goes * c.end.speed)) - c.speed
    return 1.0 if still else keeps


@inlined
def _keeps_mode(of, mode, c):
    """Return a number that is positive if a tendon certainly keeps its mode, taut or slack; −1 for a yielding one."""
    pull, pull_end = tension(of, c.start.elongation, c.state), tension(of, c.end.elongation, c.state)
    early, late = inner_points(pull, of.stiffness * c.start.speed, pull_end, of.stiffness * c.end.speed, c.h)
    least, most = min(min(early, late), min(pull, pull_end)), max(max(early, late), max(pull, pull_end))
    rounding = of.stiffness * (c.length + c.h * c.speed)
    kept = min(least, of.strength - most) if mode == TAUT else -most
    return -1.0 if mode == YIELDING else kept - rounding


@inlined
def no_event(of, mode, c):
    """Return a positive number: a linear device has no event."""
    return 1.0


@inlined
def keeps_mode_of(of, mode, c):
    """Return a number that is positive if a tendon keeps its mode; a spring does."""
    return 1.0 if of.linear_below == math.inf else _keeps_mode(of, mode.mode, c)


@inlined
def keeps_way(of, mode, c):
    """Return a number that is positive if a friction damper keeps its direction; for one that sticks ``judge_grip`` decides."""
    return 1.0 if mode.goes == STICKS else _keeps_direction(mode.goes, c)


@inlined
def keeps_steep(of, mode, c):
    """Return a number that is positive if a viscous damper keeps its direction, and, of exponent < 1, needs no shorter step."""
    near = share_near_reversal(of, c.start.speed, c.steepest * c.dt)
    return -1.0 if of.exponent < 1.0 and near < 1.0 else _keeps_direction(mode.goes, c)


@inlined
def keeps_branch(of, mode, c):
    """Return a number that is positive if a hysteretic damper keeps its direction, and, unless plastic, its step obeys TRAVEL."""
    way = (abs(c.start.speed) + c.steepest * c.h) * c.dt * of.stiffness
    return -1.0 if mode.goes * c.state < 1.0 and TRAVEL / way < 1.0 else _keeps_direction(mode.goes, c)


@inlined
def _greatest(f0, d0, f1, d1, h, best):
    """Return the greater of ``best`` and |f| at both ends, and a number that is positive if |f| may be greater inside."""
    best = max(best, abs(f0))
    beyond = max(abs(f0), abs(f1)) + excess(d0, d1, h) - best
    return max(best, abs(f1)), beyond if d0 * d1 <= 0.0 else -1.0


@inlined
def most_of_linear(of, mode, c, use, before):
    """Return the greatest |force| [m/s²] of a linear damper so far, by its speed in ``use``, and −1: it is not exceeded."""
    return max(use.most, of.slope * use.speed), -1.0


@inlined
def most_of_powers(of, mode, c, use, before):
    """Return ``most`` unchanged, and a number that is positive if scalar code has to raise it, since the greatest speed rose."""
    return use.most, use.speed - before.speed


@inlined
def most_of_friction(of, mode, c, use, before):
    """Return the greatest |force| [m/s²] so far: the strength once a friction damper has slipped; and −1."""
    return max(use.most, abs(of.strength * mode.goes)), -1.0


@inlined
def most_of_hysteretic(of, mode, c, use, before):
    """Return the greatest |force| [m/s²] of a hysteretic damper so far, and −1."""
    return max(use.most, of.strength * max(abs(c.state), abs(c.state_end))), -1.0


@inlined
def most_of_tendon(of, mode, c, use, before):
    """Return the greatest |force| [m/s²] of a tendon or a spring so far, and a number positive if it may be exceeded inside.

    A tendon that is not taut adds nothing.
    """
    longest = max(c.start.elongation, c.end.elongation)
    early, late = inner_points(c.start.elongation, c.start.speed, c.end.elongation, c.end.speed, c.h)
    taut, turns = mode.mode == TAUT, min(c.start.speed, -c.end.speed) > 0.0
    pull, bound = abs(tension(of, longest, c.state_end)), tension(of, max(longest, max(early, late)), c.state_end)
    spring = of.kind == SPRING
    most = max(use.most, of.stiffness * use.stroke if spring else (pull if taut else 0.0))
    return most, -1.0 if spring else (bound if taut and turns else 0.0) - most


@inlined
def course(traits, lanes, line, shared, i):
    """Return the Course of a device of lane ``i``."""
    now, start, end = in_pass(traits, lanes, i)[1], get(line.start_gap, i, Gap), get(line.gap, i, Gap)
    lift, lift_end = lifted(start, get(lanes.rates, i, now)), lifted(end, get(shared.rates, i, now))
    steepest = max(abs(lift), abs(lifted(start, get(shared.ahead, i, now))))
    rest, state, state_end = lanes.model.rest[i], line.now.state[i], line.end.state[i]
    least, step, dt = NO_ACCELERATION * lanes.model.gravity[i], lanes.clock.step[i], lanes.clock.dt[i]
    return Course(start, end, lift, lift_end, steepest, state, state_end, step, dt, rest, least, rest * rest / least)


@inlined
def travelled(line, i, c):
    """Return the Use of a device after a sub-step but for its force, and a number positive if an extreme may be inside."""
    use, yielded = get(line.use, i, Use), c.state_end if line.element.kind[i] == TENDON else 0.0
    stroke, more = _greatest(c.start.elongation, c.start.speed, c.end.elongation, c.end.speed, c.h, use.stroke)
    speed, faster = _greatest(c.start.speed, c.lift, c.end.speed, c.lift_end, c.h, use.speed)
    return Use(use.most, stroke, speed, line.end.lost[i], yielded, use.times), max(more, faster)
