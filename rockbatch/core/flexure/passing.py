"""One pass over all lanes of piers on a rigid base whose shafts bend: a sub-step each, with bounds that exclude events in it.

The arithmetic is that of scalar code, to which flights are left.
"""

from typing import NamedTuple

from rockbatch.core import system
from rockbatch.core.block.equations import normal_force, side_of
from rockbatch.core.block.passing import NEAR_FLIGHT, SURELY
from rockbatch.core.clock import CALM, EVENTFUL, ON_ITS_SIDE, STANDS, ground_at, peak_at_end
from rockbatch.core.flexure.displacements import Displacements, displacements_at_end, no_greater_inside
from rockbatch.core.flexure.equations import straightening
from rockbatch.core.flexure.model import FlexibleTraits, Flexing, Grounded, model_in
from rockbatch.core.flexure.modes import deflection_rates, deflections, dot
from rockbatch.core.ground import later
from rockbatch.core.kernel import inlined
from rockbatch.core.rk4 import rk4
from rockbatch.core.roots import inner_points
from rockbatch.core.system import rates
from rockbatch.core.table import along, get, put, selected
from rockbatch.core.types import Instant


class Lift(NamedTuple):
    """Moments on a pier that stands on both feet; it lifts off neither while ``holds`` exceeds |``turns``|."""

    holds: float  # moment of the weight about a foot over the mass [m²/s²]
    holds_rate: float
    turns: float  # moment of ground and shaft about the middle of the base over the mass, to the left [m²/s²]
    turns_rate: float


@inlined
def _lift(m, y, k, ground):
    """Return the Lift of a pier that stands, in state ``y`` with rates ``k``."""
    u, u_rate, weight = deflections(y), deflection_rates(y), m.gravity + ground.vertical
    moved, speed = dot(m.share, u), dot(m.share, u_rate)
    bent = dot(m.coupling, deflection_rates(k))
    bent_rate = dot(m.coupling, along(straightening(m, k), m.share, -ground.horizontal_slope))
    turns = weight * moved - ground.horizontal * m.height - bent
    turns_rate = weight * speed + ground.vertical_slope * moved - ground.horizontal_slope * m.height - bent_rate
    return Lift(weight * m.half_width, ground.vertical_slope * m.half_width, turns, turns_rate)


@inlined
def _stays_down(lift, lift_end, h):
    """Return a number that is positive if the pier certainly stands, by cubics between two Lifts."""
    least = lift.holds - abs(lift.turns)
    for side in (-1.0, 1.0):
        start, end = lift.holds + side * lift.turns, lift_end.holds + side * lift_end.turns
        slope, slope_end = lift.holds_rate + side * lift.turns_rate, lift_end.holds_rate + side * lift_end.turns_rate
        early, late = inner_points(start, slope, end, slope_end, h)
        least = min(min(early, late), min(end, least))
    return least


@inlined
def _stepped(traits, lanes, i, substep):
    """Integrate lane ``i`` over the sub-step, as if its contacts stayed."""
    m, h = model_in(traits, lanes, i), lanes.clock.step[i]
    y, contact, ground = get(lanes.now, i, Flexing), get(lanes.contact, i, Grounded), ground_at(lanes, i, substep * h)
    k = rates(m, y, contact, ground)
    put(lanes.rates, i, k)
    put(lanes.end, i, rk4(m, None, Instant(y, k, contact, None, ground), h))


@inlined
def _judged(traits, lanes, i, substep, settings):
    """Set the step status of lane ``i``, and advance the lane if its sub-step is calm.

    While it rocks, the tilt and the normal force decide as in the search for events, and the moment that would lift a foot while
    it stands.
    """
    m, h, contact = model_in(traits, lanes, i), lanes.clock.step[i], get(lanes.contact, i, Grounded)
    y, k, end = get(lanes.now, i, Flexing), get(lanes.rates, i, Flexing), get(lanes.end, i, Flexing)
    side, ground = side_of(contact), ground_at(lanes, i, substep * h)
    ground_end = later(ground, h)
    k_end = rates(m, end, contact, ground_end)
    tilt, tilt_end = side * y.theta, side * end.theta
    early, late = inner_points(tilt, side * y.omega, tilt_end, side * end.omega, h)
    highest = max(early, late)
    presses = min(normal_force(m, end, k_end, ground_end.vertical), normal_force(m, y, k, ground.vertical))
    # Arguments that may be NaN come first in min, so that its result is NaN, too, and the sub-step does not stand
    turns = min(min(min(tilt_end, early), min(late, tilt)), presses - NEAR_FLIGHT * m.gravity)
    rests = _stays_down(_lift(m, y, k, ground), _lift(m, end, k_end, ground_end), h) - SURELY * m.gravity * m.half_width
    certain = min(turns if side != 0.0 else rests, contact.left + contact.right - 0.5)
    clear = min(certain, min(ON_ITS_SIDE - tilt_end, 0.5 - lanes.step_status.watched[i]))
    eventful = CALM if min(clear, 0.5 if settings.locate else -0.5) > 0.0 else EVENTFUL
    inside = highest - lanes.peak.theta[i] if y.omega * end.omega < 0.0 else -1.0
    displaced = get(lanes.displaced, i, Displacements)
    calm = max(max(inside, -no_greater_inside(m, y, end, h, displaced)), eventful) <= 0.0
    peak_at_end(lanes, i, tilt_end if calm else 0.0, substep)
    put(lanes.displaced, i, displacements_at_end(m, end, calm, displaced))
    put(lanes.now, i, selected(calm, end, y))
    lanes.step_status.kind[i] = max(eventful, CALM if calm else STANDS)


@system.one_pass.of(FlexibleTraits)
def one_pass(traits, lanes, count, substep, settings):
    """Integrate the first ``count`` lanes over a sub-step, in two loops, as those on springs."""
    for i in range(count):
        _stepped(traits, lanes, i, substep)
    for i in range(count):
        _judged(traits, lanes, i, substep, settings)
