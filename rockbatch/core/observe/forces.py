"""Forces of the ground and the supports, and gaps under the pivots, at one moment (THEORY.md, Forces)."""

import math
from typing import NamedTuple

from rockbatch.core.block.equations import arms_about, clearances, key_of, on_side, side_of
from rockbatch.core.block.model import Block
from rockbatch.core.flexure.equations import bent_across, masses_about, rise_of_bending, velocity_of_centre
from rockbatch.core.flexure.model import FlexibleBlock, Shaft
from rockbatch.core.flexure.modes import PerMode, deflection_rates, deflections, dot
from rockbatch.core.flexure.shaft import velocity_of_centre as velocity_of_bent_centre
from rockbatch.core.kernel import hook, inlined, kernel
from rockbatch.core.springs.bending import accelerations
from rockbatch.core.springs.equations import accelerations_at, geometry
from rockbatch.core.springs.model import Springs, Supports
from rockbatch.core.springs.recovery import forces, quickness, top, velocity_of_top
from rockbatch.core.system import airborne, rates, shift
from rockbatch.core.table import along, record
from rockbatch.core.trigonometry import sine_and_cosine
from rockbatch.core.types import LEFT, RIGHT


class Forces(NamedTuple):
    """Forces on a pier at one moment, per unit of its mass, and its motion over the ground."""

    shear: float  # V/M, horizontal, of the supports on the pier, to the right [m/s²]
    normal: float  # N/M, vertical, of all supports, up [m/s²]
    moment: float  # over M, of supports and devices about the middle of the base, positive as the right one bears more [m²/s²]
    left: float  # of the left support [m/s²]
    right: float
    gap_left: float  # of the pivot above its support [m]
    gap_right: float
    speed_left: float  # at which it opens [m/s]
    speed_right: float
    deck: float  # absolute horizontal acceleration of the deck [m/s²]
    along: float  # velocity of the centre of mass over the ground, to the right, of springs as in full contact [m/s]
    up: float  # and upwards
    omega: float  # [rad/s]
    friction: float  # |V|/N; inf if N is not above 0
    clearance: float  # of the lower pivot [m]


FORCES = record(Forces)

LIFTED = 1e-9
"""Normal force over M g that is rounding."""


class Outline(NamedTuple):
    """Numbers of a block on a rigid base that Block lacks."""

    size: float  # R0 [m]
    width: float  # 2b between the corners [m]
    deck_share: float  # horizontal motion of the deck over that of the centre of mass
    deck_above: float  # height of a deck that turns with the block above the centre of mass [m]
    deck_shape: PerMode | None = None  # of the modes of an elastic shaft at the deck


class Hold(NamedTuple):
    """Resistance of friction to a block at rest that begins to turn about either pivot."""

    left_down: float  # force on the pier [m/s²]
    left_back: float  # angular deceleration [rad/s²]
    right_down: float
    right_back: float


class Body(NamedTuple):
    """Further numbers that the forces on a rigid base need."""

    outline: Outline
    hold: Hold


@kernel
def friction_demand(gravity, shear, normal):
    """Return |V|/N; inf if N/M is not above LIFTED ``gravity``, hence rounding."""
    return abs(shear) / normal if normal > LIFTED * gravity else math.inf


class Inertia(NamedTuple):
    """Forces of a pier's mass and weight on its base, and what the mass moves at."""

    shear: float  # [m/s²], as of Forces
    moment: float  # [m²/s²]
    deck: float  # [m/s²]
    along: float  # [m/s]
    up: float


class Foot(NamedTuple):
    """Lever of the ground's acceleration, and the point of the base that does not slide."""

    lever: float  # H [m]
    slope: float  # dH/dθ [m]
    side: float  # of that point: −1 or 1 for the left or right pivot alone, 0 for the middle
    middle: float  # H of the middle [m]


@hook
def _inertia_on_springs(shaft, m, deck, y, contact, ground):
    """Return the Inertia of a pier on springs, whose ``shaft`` is None if it is rigid."""


@_inertia_on_springs.of(type(None))
def _inertia_of_rigid_shaft(shaft, m, deck, y, contact, ground):
    horizontal, vertical = ground.horizontal, ground.vertical
    at = geometry(m, y.theta)
    v_acceleration, turning = accelerations_at(m, y, contact, at, ground)
    squared = y.omega * y.omega
    side = contact.right - contact.left
    ground_lever = at.lever + side * at.swing
    lever, bend, place = m.height, 0.0 * m.height, m.height * y.theta
    swung = (deck - m.height) * turning
    if m.finite is not None:
        lever, bend = ground_lever, at.lever_slope + side * at.swing_slope
        place = side * m.half_width - bend
        sine, cosine = sine_and_cosine(y.theta)
        swung = (deck - m.height) * (cosine * turning - sine * squared)
    shear = horizontal + lever * turning + bend * squared
    moment = place * (m.gravity + vertical + v_acceleration) - lever * (shear - horizontal) - m.inertia * turning
    moment -= ground_lever * horizontal
    return Inertia(shear, moment, shear + swung, at.lever * y.omega, y.v_rate)


@_inertia_on_springs.of(Shaft)
def _inertia_of_bending_shaft(shaft, m, deck, y, contact, ground):
    at, side = geometry(m, y.theta), contact.right - contact.left
    lever, bend = at.lever + side * at.swing, at.lever_slope + side * at.swing_slope
    return inertia_of_bent(
        m, deck, y, accelerations(m, y, contact, at, ground), Foot(lever, bend, side, at.lever), ground
    )


@inlined
def inertia_of_bent(m, deck, y, k, foot, ground):
    """Return the Inertia of a pier whose shaft bends, with the Accelerations ``k``, and its deck ``deck`` [m] above its base."""
    shaft, squared, lever, bend = m.shaft, y.omega * y.omega, foot.lever, foot.slope
    sine, cosine = sine_and_cosine(y.theta)
    weight, u, u_rate = m.gravity + ground.vertical, deflections(y), deflection_rates(y)
    to_right, up = ground.horizontal + lever * k.theta + bend * squared, weight + k.v
    moved, speed, pushed = dot(shaft.share, u), dot(shaft.share, u_rate), dot(shaft.share, k.u)
    shear = to_right + cosine * pushed - 2.0 * sine * y.omega * speed - moved * (sine * k.theta + cosine * squared)
    normal = up - sine * pushed - 2.0 * cosine * y.omega * speed - moved * (cosine * k.theta - sine * squared)
    spun = (m.inertia + dot(u, u)) * k.theta + dot(shaft.lever, k.u) + 2.0 * dot(u, u_rate) * y.omega
    spun -= moved * (sine * to_right + cosine * up)
    moment = (foot.side * m.half_width - bend) * normal - lever * shear - spun
    # What the base does in an instant reaches the shaft by its modes alone
    followed = along(along(k.u, shaft.share, cosine * lever * k.theta - sine * k.v), shaft.lever, k.theta)
    steady = cosine * (ground.horizontal + bend * squared)
    across = steady - sine * weight + dot(shaft.share, followed) - moved * squared
    bent, bent_rate = dot(shaft.deck_shape, u), dot(shaft.deck_shape, u_rate)
    deck_across = steady - sine * ground.vertical + dot(shaft.deck_shape, followed) - bent * squared
    deck_along = sine * to_right + cosine * (up - m.gravity) - (deck - m.height) * squared
    deck_along -= 2.0 * bent_rate * y.omega + bent * k.theta
    moves = velocity_of_bent_centre(m, y, foot.middle)
    shaken = cosine * deck_across + sine * deck_along
    return Inertia((across + sine * normal) / cosine, moment, shaken, moves[0], moves[1])


@kernel
def on_springs(m, deck, now, ground):
    """Return the Forces in the Moment ``now`` on a pier on springs, whose deck is ``deck`` [m] above its base."""
    y, contact, supports = now
    at, of = geometry(m, y.theta), _inertia_on_springs(m.shaft, m, deck, y, contact, ground)
    pull_left, pull_right = forces(m, y, contact, at)
    left, right = -pull_left, -pull_right
    free_left = 1.0 if contact.left == 0.0 and contact.held != LEFT else 0.0
    free_right = 1.0 if contact.right == 0.0 and contact.held != RIGHT else 0.0
    gap_left = free_left * (y.v + at.lift_left - top(m, supports.left, y.z_left))
    gap_right = free_right * (y.v + at.lift_right - top(m, supports.right, y.z_right))
    return Forces(
        of.shear, left + right, of.moment, left, right, gap_left, gap_right,
        free_left * (y.v_rate + at.arm_left * y.omega - velocity_of_top(m, y.z_left)),
        free_right * (y.v_rate + at.arm_right * y.omega - velocity_of_top(m, y.z_right)),
        of.deck, of.along, of.up, y.omega,
        friction_demand(m.gravity, of.shear, left + right), min(gap_left, gap_right),
    )  # fmt: skip


@kernel
def _waits(was, contact, side, waiting, position):
    """Return the position [m] of the free support on ``side``: ``position`` if its pivot has just separated, else ``waiting``."""
    before, now = (was.left, contact.left) if side == LEFT else (was.right, contact.right)
    left = (before != 0.0 or was.held == side) and now == 0.0 and contact.held != side
    return position if left else waiting


@kernel
def _at_rest(m, body, y, ground):
    """Return the Forces on a block at rest on both pivots, and the pivot about which it would turn, 0 if it stays.

    The pivots carry weight and moment; friction resists the uplift of one of them as far as it can.
    """
    (outline, hold), horizontal, vertical = body, ground.horizontal, ground.vertical
    b, still, gap = 0.5 * outline.width, 0.0 * outline.size * y.omega, 0.0 * outline.width
    normal = m.gravity + vertical + m.pull.force
    more = horizontal * m.height / m.half_width + m.pull.moment / b
    pressed = LEFT if more > 0.0 else RIGHT
    down, back = (hold.left_down, hold.left_back) if pressed == LEFT else (hold.right_down, hold.right_back)
    lacks = (abs(more) - normal) * b * m.quickness
    wider = m.half_width - b  # 0, except for a frame, whose equivalent block is wider than a column
    lacks += wider * (abs(horizontal) * m.height / m.half_width - m.gravity - vertical) * m.quickness
    share = lacks / back if lacks > 0.0 else 0.0
    normal += share * down if lacks <= back else 0.0
    on_left, on_right = 0.5 * (normal + more), 0.5 * (normal - more)
    if lacks > 0.0:
        on_left, on_right = (normal, 0.0 * normal) if pressed == LEFT else (0.0 * normal, normal)
    forces = Forces(
        horizontal, normal, -0.5 * outline.width * m.height / m.half_width * horizontal, on_left, on_right,
        gap, gap, still, still, horizontal, still, still, y.omega, friction_demand(m.gravity, horizontal, normal), gap,
    )  # fmt: skip
    return forces, (pressed if lacks > back else 0.0)


@kernel
def on_block(m, body, now, ground):
    """Return the Forces on a block, rocking about a pivot, in flight or at rest.

    Devices pull along the chord of the arc of their places: cos(θ/2) of their force is vertical.
    """
    (y, contact, _), outline, horizontal, vertical = now, body.outline, ground.horizontal, ground.vertical
    side = side_of(contact)
    flies = airborne(m, contact)
    if side == 0.0 and not flies:
        forces, turns = _at_rest(m, body, y, ground)
        if turns == 0.0:
            return forces
        side = turns
        contact = on_side(side)
    k = rates(m, y, contact, ground)
    v_acceleration, turning = k.v_rate, k.omega
    squared, lean = y.omega * y.omega, (side if side != 0.0 else key_of(m, contact))
    sine, cosine = sine_and_cosine(y.theta)
    half_sine, half_cosine = sine_and_cosine(0.5 * y.theta)
    lever = m.height * cosine + lean * m.half_width * sine
    slope = lean * m.half_width * cosine - m.height * sine
    along = lever * turning + slope * squared
    pull = m.pull.force * half_cosine
    grounded = 0.0 if flies else 1.0
    lifted = m.gravity + vertical + v_acceleration
    normal = grounded * (lifted + pull * half_cosine)
    shear = horizontal + along + grounded * pull * half_sine
    place = lean * m.half_width - slope
    moment = place * lifted - lever * (horizontal + along) - m.inertia * turning - shift(m, contact) * lifted
    held = (
        0.5 * (contact.bore + contact.top) - lean
    )  # position of the deck's key relative to the mean of all keys, for a frame in flight
    swung = held * m.half_width * (sine * turning + cosine * squared)
    deck = outline.deck_share * (along + swung) + outline.deck_above * (cosine * turning - sine * squared)
    on_left, on_right = contact.left, contact.right
    left, right, left_speed, right_speed = clearances(m, y, contact.top)
    off_left, off_right = 1.0 - on_left, 1.0 - on_right
    return Forces(
        shear, normal, moment, on_left * normal, on_right * normal,
        off_left * left, off_right * right, off_left * left_speed, off_right * right_speed,
        horizontal + deck, lever * y.omega, y.v_rate, y.omega,
        friction_demand(m.gravity, shear, normal), min(off_left * left, off_right * right),
    )  # fmt: skip


@kernel
def on_flexible_block(m, body, now, ground):
    """Return the Forces on a pier with an elastic shaft, by the motion of its mass; otherwise as :func:`on_block`."""
    (y, contact, _), outline, horizontal, vertical = now, body.outline, ground.horizontal, ground.vertical
    side, flies = side_of(contact), airborne(m, contact)
    k, key = rates(m, y, contact, ground), side if side != 0.0 else key_of(m, contact)
    sine, cosine = sine_and_cosine(y.theta)
    half_sine, half_cosine = sine_and_cosine(0.5 * y.theta)
    about, squared, b = masses_about(m, deflections(y), key), y.omega * y.omega, m.half_width
    slope, arm = about.offset * cosine - m.height * sine, about.offset * sine + m.height * cosine
    u_rate = deflection_rates(y)
    to_side = arm * k.omega + slope * squared + bent_across(m.share, y, k)
    pull, grounded = m.pull.force * half_cosine, 0.0 if flies else 1.0
    lifted = m.gravity + vertical + k.v_rate + rise_of_bending(m, y, k)
    normal, shear = grounded * (lifted + pull * half_cosine), horizontal + to_side + grounded * pull * half_sine
    straight_slope, straight_arm = arms_about(m, y.theta, key)
    key_rise = k.v_rate - straight_slope * k.omega + straight_arm * squared
    spun = dot(m.coupling, deflection_rates(k)) + about.turning * k.omega + 2.0 * dot(about.spread, u_rate) * y.omega
    moment = key * b * lifted - slope * (m.gravity + vertical + key_rise) - arm * horizontal - spun
    left, right = contact.left * normal, contact.right * normal
    if side == 0.0 and not flies:
        more = (m.pull.moment - moment) / b
        left, right = 0.5 * (normal + more), 0.5 * (normal - more)
        lacks = max(-left, -right, 0.0)  # tension of a foot, which friction of dampers carries
        left, right = max(left, 0.0) - (lacks if right < 0.0 else 0.0), max(right, 0.0) - (lacks if left < 0.0 else 0.0)
    high, to_deck = m.height + outline.deck_above, bent_across(outline.deck_shape, y, k)
    place = key * b - dot(outline.deck_shape, deflections(y))
    to_deck += (high * cosine + place * sine) * k.omega + (place * cosine - high * sine) * squared
    gap_left, gap_right, speed_left, speed_right = clearances(m, y, contact.top)
    off_left, off_right = 1.0 - contact.left, 1.0 - contact.right
    to_right, up = velocity_of_centre(m, y, contact)
    return Forces(
        shear, normal, moment, left, right,
        off_left * gap_left, off_right * gap_right, off_left * speed_left, off_right * speed_right,
        horizontal + to_deck, to_right, up, y.omega,
        friction_demand(m.gravity, shear, normal), min(off_left * gap_left, off_right * gap_right),
    )  # fmt: skip


@hook
def waiting(m, y, was, contact, supports):
    """Return the Supports in state ``y``, as the contact changes from ``was`` to ``contact``.

    The unstressed positions of pivots that have just separated are new; without springs there are none.
    """


@waiting.of(Springs)
def _waiting_springs(m, y, was, contact, supports):
    at = geometry(m, y.theta)
    # A damped support recovers to its unstressed position
    left = y.v + at.lift_left - m.yield_deflection * y.z_left
    right = y.v + at.lift_right - m.yield_deflection * y.z_right
    left, right = _waits(was, contact, LEFT, supports.left, left), _waits(was, contact, RIGHT, supports.right, right)
    return Supports(left, right, supports.yield_left, supports.yield_right)


def _waiting_ground(m, y, was, contact, supports):
    return supports


waiting.of(Block)(_waiting_ground)
waiting.of(FlexibleBlock)(_waiting_ground)


@hook
def forces_at(m, body, now, ground):
    """Return the Forces in the Moment ``now``.

    ``body`` is the height of the deck above the base [m] on springs and on a footing, a Body on a rigid base.
    """


@forces_at.of(Springs)
def _forces_on_springs(m, body, now, ground):
    return on_springs(m, body, now, ground)


@forces_at.of(Block)
def _forces_on_block(m, body, now, ground):
    return on_block(m, body, now, ground)


@forces_at.of(FlexibleBlock)
def _forces_on_flexible_block(m, body, now, ground):
    return on_flexible_block(m, body, now, ground)


@hook
def fastest_heels(m, step):
    """Return the shares of a step at which the gaps of the left and the right heel may open fastest; 0 for an end of it."""


@kernel
def _fastest(m, on_spring, z, acceleration, length):
    """Return the share of a step at which the gap above a recovering support opens fastest; 0 if not inside.

    The support moves at w exp(−t/τ), its pivot at a steady acceleration a: that is where a + (w/τ) exp(−t/τ) = 0.
    """
    if m.damped is None or on_spring != 0.0 or z == 0.0:
        return 0.0
    quick = quickness(m)
    ratio = -acceleration / (velocity_of_top(m, z) * quick)
    share = -math.log(ratio) / (quick * length) if 0.0 < ratio < 1.0 else 0.0
    return share if share < 1.0 else 0.0


@fastest_heels.of(Springs)
def _fastest_on_springs(m, step):
    at, k, contact = geometry(m, step.start.theta), step.rates, step.contact
    left, right = k.v_rate + at.arm_left * k.omega, k.v_rate + at.arm_right * k.omega
    return (
        _fastest(m, contact.left, step.start.z_left, left, step.length),
        _fastest(m, contact.right, step.start.z_right, right, step.length),
    )


def _fastest_on_ground(m, step):
    return 0.0, 0.0


fastest_heels.of(Block)(_fastest_on_ground)
fastest_heels.of(FlexibleBlock)(_fastest_on_ground)
