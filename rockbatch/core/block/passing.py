"""One pass over all lanes of blocks: a sub-step each, with bounds that prove that no event occurs in it.

The compiler vectorises the loops, since they have no branches and the numbers of a field are contiguous. The arithmetic of a
lane does not depend on its neighbours, so that a run gives the same bits in any company.
"""

from rockbatch.core import system
from rockbatch.core.block.equations import side_of
from rockbatch.core.block.model import BlockTraits, Rocker, Stance, Tilt
from rockbatch.core.clock import CALM, EVENTFUL, STANDS, ground_at, peak_at_end
from rockbatch.core.devices.passing import integrate, settle
from rockbatch.core.ground import later
from rockbatch.core.kernel import inlined
from rockbatch.core.rk4 import rk4
from rockbatch.core.roots import inner_points
from rockbatch.core.system import rates
from rockbatch.core.table import get, put, selected
from rockbatch.core.trigonometry import FLAT
from rockbatch.core.types import LEFT, RIGHT, Instant, Pull

NEAR_FLIGHT = 0.3
"""Normal force over M g above which contact is not lost and regained within a sub-step."""

SURELY = 1e-9
"""Resistance to uplift at rest, in units of p², that is more than rounding."""


@inlined
def _pass_over(lanes, i, substep, settings):
    """Integrate lane ``i`` over a sub-step.

    It is calm if the block certainly stays on its pivot, by the Bézier points and a bound on the normal force, does not lean
    far, and has no new peak except at the end. At rest it is calm if the ground does not lift it at either end.
    """
    model, h = lanes.model, lanes.clock.step[i]
    m = Rocker(model.half_width[i], model.height[i], model.gravity[i], model.quickness[i])
    stance = get(lanes.contact, i, Stance)
    side = side_of(stance)
    y = Tilt(lanes.now.theta[i], lanes.now.omega[i])
    ground = ground_at(lanes, i, substep * h)
    end = rk4(m, None, Instant(y, rates(m, y, side, ground), side, None, ground), h)
    lanes.end.theta[i] = end.theta
    lanes.end.omega[i] = end.omega

    horizontal_end = ground.horizontal + h * ground.horizontal_slope
    vertical_end = ground.vertical + h * ground.vertical_slope
    down = m.gravity + min(ground.vertical, vertical_end)
    strongest = max(abs(ground.horizontal), abs(horizontal_end))
    tilt, tilt_end = side * y.theta, side * end.theta
    early, late = inner_points(tilt, side * y.omega, tilt_end, side * end.omega, h)
    lowest, highest = min(early, late), max(early, late)
    stays = min(tilt_end, lowest, FLAT - max(tilt, tilt_end), 1.0 if tilt >= 0.0 else -1.0)
    # (F1) of the normal force, with φ² for sin²φ beyond 2α, ½ or |φ| for sin φ cos φ, and 1 for cos φ
    bounds, beyond = lanes.bounds, max(highest, max(tilt, tilt_end)) - model.alpha[i]
    steep, fastest = max(model.alpha[i], beyond), abs(y.omega) + abs(end.omega)
    bears = 1.0 - bounds.share[i] * max(bounds.sine_squared[i], max(beyond, 0.0) * max(beyond, 0.0))
    throws = bounds.share[i] * min(0.5, steep) * strongest + bounds.radius[i] * fastest * fastest
    # Conditions are numbers above 0, combined by min, since booleans would need vector masks of another width
    # Arguments that may be NaN come first in min, so that its result is NaN, too, and the sub-step does not stand
    moves = min(down * bears - throws, stays)
    rests = min(
        bounds.tangent[i] * (m.gravity + ground.vertical) - abs(ground.horizontal),
        bounds.tangent[i] * (m.gravity + vertical_end) - abs(horizontal_end),
        stance.left - 0.5,
    )
    eventful = CALM if min(moves if side != 0.0 else rests, 0.5 if settings.locate else -0.5) > 0.0 else EVENTFUL
    calm = max(highest - lanes.peak.theta[i] if y.omega * end.omega < 0.0 else -1.0, eventful) <= 0.0
    peak_at_end(lanes, i, tilt_end if calm else 0.0, substep)
    lanes.now.theta[i] = end.theta if calm else y.theta
    lanes.now.omega[i] = end.omega if calm else y.omega
    lanes.step_status.kind[i] = max(eventful, CALM if calm else STANDS)


@system.one_pass.of(BlockTraits)
def one_pass(traits, lanes, count, substep, settings):
    """Integrate the first ``count`` lanes over a sub-step."""
    for i in range(count):
        _pass_over(lanes, i, substep, settings)


@inlined
def _resists(m, side, held, ground):
    """Return the acceleration [rad/s²] by which a block at rest resists uplift about its pivot on ``side``, ``held`` included."""
    return m.quickness * ((m.gravity + ground.vertical) * m.half_width + side * ground.horizontal * m.height) + held


@inlined
def _judged(traits, lanes, shared, i, substep, settings):
    """Set the step status of lane ``i`` with devices, and advance the lane if its sub-step is calm.

    The normal force, known at both ends, decides as in the search for events whether the block may take off.
    """
    m, y, stance = system.in_pass(traits, lanes, i)
    h, end, side, bounds = lanes.clock.step[i], get(shared.stage, i, y), side_of(stance), lanes.bounds
    lanes.end.theta[i], lanes.end.omega[i] = end.theta, end.omega
    ground = ground_at(lanes, i, substep * h)
    ground_end = later(ground, h)
    pull, pull_end = get(shared.start_pull, i, Pull), get(shared.pull, i, Pull)
    normal = m.gravity + ground.vertical + lanes.rates.v_rate[i] + pull.force
    normal_end = m.gravity + ground_end.vertical + shared.rates.v_rate[i] + pull_end.force
    tilt, tilt_end = side * y.theta, side * end.theta
    early, late = inner_points(tilt, side * y.omega, tilt_end, side * end.omega, h)
    lowest, highest = min(early, late), max(early, late)
    stays = min(min(lowest, tilt_end), min(tilt, FLAT - max(highest, max(tilt, tilt_end))))
    presses = min(normal_end, normal) - NEAR_FLIGHT * m.gravity
    moves = min(min(stays, presses), min(0.5 - shared.verdict.doubts[i], 1.0 - lanes.step_status.watched[i]))
    left, right = bounds.held_left[i], bounds.held_right[i]
    holds = min(_resists(m, LEFT, left, ground), _resists(m, LEFT, left, ground_end))
    holds = min(holds, min(_resists(m, RIGHT, right, ground), _resists(m, RIGHT, right, ground_end)))
    rests = min(holds - SURELY * m.p * m.p, stance.left - 0.5)
    stands = min(moves if side != 0.0 else rests, 0.5 if settings.locate else -0.5) > 0.0
    eventful = CALM if stands else EVENTFUL
    calm = max(highest - lanes.peak.theta[i] if y.omega * end.omega < 0.0 else -1.0, eventful) <= 0.0
    peak_at_end(lanes, i, tilt_end if calm else 0.0, substep)
    put(lanes.now, i, selected(calm, end, y))
    lanes.step_status.kind[i] = max(eventful, CALM if calm else STANDS)


@system.pass_with_devices.of(BlockTraits)
def pass_with_devices(traits, lanes, equipment, count, substep, settings):
    """Integrate the first ``count`` lanes over a sub-step; flight is left to scalar code."""
    whole = integrate(traits, lanes, equipment, count, substep)
    for i in range(whole):
        _judged(traits, lanes, equipment.shared[0], i, substep, settings)
    settle(traits, lanes, equipment, count, whole)
