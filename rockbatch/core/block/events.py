"""Events of a pier on a rigid base: lift-off, impact, rest, take-off and landing (THEORY.md, Rigid base)."""

import math

from rockbatch.core import system
from rockbatch.core.block.equations import (
    arms,
    clearances,
    constrained,
    halves,
    lever,
    lost_by_deck,
    normal_force,
    on_side,
    side_of,
)
from rockbatch.core.block.model import Block, Rocking, Stance
from rockbatch.core.block.passing import NEAR_FLIGHT
from rockbatch.core.devices.events import leave_rest
from rockbatch.core.devices.laws import CLOSES, OPENS
from rockbatch.core.devices.pull import about_to_turn, loaded_soon
from rockbatch.core.ground import later
from rockbatch.core.kernel import hook, inlined, kernel
from rockbatch.core.roots import NO_ACCELERATION, surely
from rockbatch.core.system import airborne, rates
from rockbatch.core.table import along
from rockbatch.core.types import (
    CONTACT_LEFT,
    DECK,
    IMPACT_BOTH,
    IMPACT_LEFT,
    IMPACT_RIGHT,
    LAW_LEFT,
    LEFT,
    LIFT_OFF,
    REST,
    RIGHT,
    TAKE_OFF,
    Moment,
    Signals,
    Transition,
)

NEGLIGIBLE = 1e-13
"""Height of bounces over α below which their infinite sequence is summed up."""

HOP = 1.25
"""Longest sub-step that shows the landing of a bounce, over its duration by the initial acceleration."""

NEARBY = 1e-6
"""Interval of the finite difference for the rate of the normal force, in units of 1/p."""

HARDLY = 1e-300
"""Least velocity [rad/s] that has a sign."""

RESTING = Stance(1.0, 1.0, 0.0, 0.0)


@inlined
def lifting(m, devices, y, side, ground):
    """Return the acceleration [rad/s²] towards ``side`` of a block at rest, were it to begin to rock about that pivot."""
    under = about_to_turn(devices, m, y, on_side(side), OPENS)
    return side * rates(under, y, on_side(side), ground).omega


@kernel
def resistance(m, devices, y, side):
    """Return the acceleration [rad/s²] by which devices alone keep a block at rest from rocking about its pivot on ``side``."""
    pull = about_to_turn(devices, m, y, on_side(side), OPENS).pull
    return m.quickness * (side * pull.moment + pull.force * m.half_width)


@hook
def lift_rate(m, devices, now, side):
    """Return the rate [rad/s³] of the acceleration by :func:`lifting` towards ``side``."""


@lift_rate.of(Block)
def _lift_rate(m, devices, now, side):
    ground = now.ground
    return -side * m.quickness * (ground.vertical_slope * side * m.half_width + ground.horizontal_slope * m.height)


@kernel
def _change_of_normal(m, devices, now):
    """Return the rate of N/M [m/s³] of a rocking block with its devices, by a finite difference."""
    y, k, contact, supports, ground = now
    near = NEARBY / m.p
    soon, there = Moment(constrained(m, along(y, k, near), contact), contact, supports), later(ground, near)
    under = loaded_soon(devices, m, Moment(y, contact, supports), soon, ground, near)
    k_soon = rates(under, soon.y, contact, there)
    return (normal_force(under, soon.y, k_soon, there.vertical) - normal_force(m, y, k, ground.vertical)) / near


@inlined
def _height(m, height, velocity, acceleration):
    """Return the height [m] of a pivot in flight, and its rate; made positive if, within rounding, it has just taken off."""
    rest = m.rest
    length = rest * rest / (NO_ACCELERATION * m.gravity)
    rises = velocity > rest or (velocity >= -rest and acceleration >= -1e-9 * m.gravity)
    if rises and abs(height) <= length:
        return length, max(velocity, rest)
    return height, surely(velocity, acceleration, rest)


@inlined
def _at_once(value, slope, rounding):
    """Return an event function and its slope, made falling if the value is below zero, so that the event occurs at once.

    A |value| up to ``rounding`` becomes ``rounding``.
    """
    if abs(value) <= rounding:
        return rounding, slope
    return value, (slope if value > 0.0 else min(-abs(slope), value))


WEIGHTLESS = 1e-13
"""Share of gravity within which the ground falls as fast as the block: ten times the rounding of a sample."""


@inlined
def _weightless(m, ground):
    """Return True if the ground falls as fast as the block, to the rounding of a sample; False if it falls slower or faster.

    The block takes off only once the ground falls faster.
    """
    return abs(m.gravity + ground.vertical) <= WEIGHTLESS * m.gravity


def event_functions_of(m, devices, now):
    """Return Signals and their slopes: at rest the resistance of each pivot to uplift; rocking the tilt and the normal force.

    In flight the heights of both pivots, and the tilt of a frame's deck.
    """
    y, k, contact, _, ground = now
    side = side_of(contact)
    if side != 0.0:
        omega, turning = side * y.omega, side * k.omega
        if abs(omega) * m.height <= m.rest:
            least = NO_ACCELERATION * m.p * m.p
            turning = turning if abs(turning) > least else least  # it has just been lifted, within rounding
            # not ``rest`` as elsewhere: as a slope it would dwarf the tilt of a block that has just left the ground
            omega = math.copysign(max(abs(omega), HARDLY) if omega * turning > 0.0 else HARDLY, turning)
        normal, normal_rate = normal_force(m, y, k, ground.vertical), 0.0
        if normal < NEAR_FLIGHT * m.gravity:
            normal_rate = _change_of_normal(m, devices, now)
        normal, normal_rate = _at_once(normal, normal_rate, NO_ACCELERATION * m.gravity)
        if side > 0.0:
            return Signals(side * y.theta, normal, 1.0, 1.0), Signals(omega, normal_rate, 0.0, 0.0)
        return Signals(normal, side * y.theta, 1.0, 1.0), Signals(normal_rate, omega, 0.0, 0.0)
    if contact.left != 0.0:
        rounding = WEIGHTLESS * m.p * m.p if _weightless(m, ground) else 0.0
        left, left_slope = _at_once(
            -lifting(m, devices, y, RIGHT, ground), -lift_rate(m, devices, now, RIGHT), rounding
        )
        right, right_slope = _at_once(
            -lifting(m, devices, y, LEFT, ground), -lift_rate(m, devices, now, LEFT), rounding
        )
        return Signals(left, right, 1.0, 1.0), Signals(left_slope, right_slope, 0.0, 0.0)
    left, right, left_velocity, right_velocity = clearances(m, y, contact.top)
    arm_left, arm_right = arms(m, y.theta, contact.top)
    turned = y.omega * y.omega
    bend, sine = m.height * math.cos(y.theta), math.sin(y.theta)
    half_left, half_right = halves(m, contact.top)
    left_acceleration = k.v_rate + arm_left * k.omega + (bend - half_left * sine) * turned
    right_acceleration = k.v_rate + arm_right * k.omega + (bend + half_right * sine) * turned
    left, left_velocity = _height(m, left, left_velocity, left_acceleration)
    right, right_velocity = _height(m, right, right_velocity, right_acceleration)
    tilt, tilt_rate = _deck_tilt(m, y, k, contact)
    return Signals(left, right, tilt, 1.0), Signals(left_velocity, right_velocity, tilt_rate, 0.0)


system.event_functions.of(Block)(event_functions_of)


@inlined
def _deck_tilt(m, y, k, contact):
    """Return the tilt at whose zero a frame's deck changes corners in flight, and its rate; 1 and 0 if on both, or no deck."""
    if m.deck == 0.0 or contact.top == 0.0:
        return 1.0, 0.0
    rate = contact.top * y.omega
    if abs(rate) * m.height <= m.rest:
        rate = HARDLY if contact.top * k.omega >= 0.0 else -HARDLY
    return contact.top * y.theta, rate


@inlined
def within_bounce(m, start, h):
    """Return a step [s] of at most ``h``, and of HOP = 1.25 times the duration of a bounce that begins at θ = 0.

    A cubic over both ends of a longer one could hide the bounce.
    """
    y, k, contact, _, _ = start
    side = side_of(contact)
    if side == 0.0 or y.theta != 0.0:
        return h
    back = -side * k.omega
    hop = 2.0 * HOP * side * y.omega / back if back > 0.0 else math.inf
    return min(h, hop) if hop > 0.0 else h


@system.longest_step.of(Block)
def longest_step(m, start, h):
    """Return a step [s] of at most ``h`` that shows a bounce."""
    return within_bounce(m, start, h)


@system.transition.of(Block)
def transition(m, devices, now, which, ground, dt):
    """Return the Transition by event ``which``; landings beyond α, of a pier that topples, are not counted as impacts."""
    y, contact, supports = now
    side = side_of(contact)
    pivot = LEFT if which == CONTACT_LEFT else RIGHT
    if side != 0.0:
        if pivot == side:
            return Transition(Moment(y, Stance(0.0, 0.0, side, side), supports), TAKE_OFF, 0.0, 0.0, 0.0)
        y, contact, kind, remaining = _impact(m, devices, y, ground, dt)
        return Transition(Moment(y, contact, supports), kind, 1.0, 0.0, remaining)
    if which == LAW_LEFT:
        passed = 1.0 - lost_by_deck(m) / (m.inertia + m.height * m.height)
        y, contact = Rocking(y.v, 0.0, y.v_rate, passed * y.omega), Stance(0.0, 0.0, contact.bore, -contact.top)
        return Transition(Moment(y, contact, supports), DECK, 0.0, 0.0, 0.0)
    if airborne(m, contact):
        y, contact, kind = _landing(m, y, contact, pivot)
        topples = abs(y.theta) >= m.alpha and not airborne(m, contact)
        impacts = 0.0 if topples else (2.0 if kind == IMPACT_BOTH else 1.0)
        return Transition(Moment(y, contact, supports), kind, impacts, 0.0, 0.0)
    y, contact, kind = lift_off(m, devices, y, -pivot, ground)
    return Transition(Moment(y, contact, supports), kind, 0.0, 1.0, 0.0)


def released(m, now, ground):
    """Return the Moment ``now`` after an impact; in the air if the ground would have to pull the block down."""
    y, contact, supports = now
    side = side_of(contact)
    if side == 0.0:
        return now
    if normal_force(m, y, rates(m, y, contact, ground), ground.vertical) >= -NO_ACCELERATION * m.gravity:
        return now
    return Moment(y, Stance(0.0, 0.0, side, side), supports)


system.released.of(Block)(released)


@kernel
def lift_off(m, devices, y, side, ground):
    """Return state, stance and kind as the block lifts off about the pivot on ``side``, or takes off (THEORY.md, eq. 15).

    The directions and modes of devices are set.
    """
    other = lifting(m, devices, y, -side, ground)
    under = about_to_turn(devices, m, y, on_side(side), OPENS)
    k = rates(under, y, on_side(side), ground)
    falls_away = ground.vertical_slope < 0.0 or not _weightless(m, ground)
    unloads = normal_force(under, y, k, ground.vertical) <= NO_ACCELERATION * m.gravity
    if falls_away and (unloads or other >= -NO_ACCELERATION * m.p * m.p * m.alpha):
        pushed = ground.horizontal if ground.horizontal != 0.0 else ground.horizontal_slope
        top = -math.copysign(1.0, pushed) if m.deck > 0.0 and pushed != 0.0 else 0.0
        stance = Stance(0.0, 0.0, 0.0, top)
        leave_rest(m, devices, y, stance)
        return y, stance, TAKE_OFF
    stance = on_side(side)
    leave_rest(m, devices, y, stance)
    return y, stance, LIFT_OFF


@kernel
def _impact(m, devices, y, ground, dt):
    """Return state, stance and kind as the block passes through θ = 0, and the time [s] left to rest (THEORY.md, eq. 16).

    That is 0 unless the kind is REST.
    """
    omega = m.restitution * y.omega
    height, remaining = bounces(m, devices, Rocking(0.0, 0.0, 0.0, 0.0), omega, m.restitution, ground)
    if omega == 0.0 or (height < NEGLIGIBLE * m.alpha and remaining < dt):
        return Rocking(0.0, 0.0, 0.0, 0.0), RESTING, REST, (remaining if omega != 0.0 else 0.0)
    side = RIGHT if omega > 0.0 else LEFT
    y = Rocking(0.0, 0.0, side * m.half_width * omega, omega)
    return y, on_side(side), IMPACT_LEFT if side == LEFT else IMPACT_RIGHT, 0.0


@kernel
def bounces(m, devices, still, omega, share, ground):
    """Return the greater height [rad] of the next two bounces, and the duration [s] of their whole sequence (Zeno).

    The duration is inf if they do not decay, both are inf if the block does not turn back or does not move. ``still`` is the
    state of the block with its base at rest; each impact leaves a ``share`` of the angular velocity. Small bounces have a
    constant acceleration towards rest, to which friction adds while they open, and opposes while they close.
    """
    here = RIGHT if omega > 0.0 else LEFT
    speed, times, ratio, height = abs(omega), 0.0, 1.0, 0.0
    if speed == 0.0:
        return math.inf, math.inf
    for side in (here, -here):
        slows = -lifting(m, devices, still, side, ground)
        speeds = -side * _closing(m, devices, still, side, ground)
        if slows <= 0.0 or speeds <= 0.0:
            return math.inf, math.inf
        height = max(height, 0.5 * speed * speed / slows)
        back = speed * math.sqrt(speeds / slows)
        times += speed / slows + back / speeds
        ratio *= share * back / speed
        speed = share * back
    return height, times / (1.0 - ratio) if ratio < 1.0 else math.inf


@kernel
def _closing(m, devices, y, side, ground):
    """Return θ̈ [rad/s²], positive to the right, of a block about to land at θ = 0 from its pivot on ``side``, with devices."""
    under = about_to_turn(devices, m, y, on_side(side), CLOSES)
    return rates(under, y, on_side(side), ground).omega


@kernel
def _landing(m, y, contact, pivot):
    """Return state, stance and kind as ``pivot`` lands from flight; the other may land at the same instant.

    The impulse at the pivot has a horizontal part, as its key takes over from that of the pivot last in contact. The angular
    momentum about it is conserved, and its velocity multiplied by −ε (THEORY.md, Flight on the rigid base), or by 0 if the
    rebound would be below NEGLIGIBLE; after a rebound the block is in flight. If both land, velocities are multiplied by −ε, or
    the block rests if that rebound is negligible.
    """
    left, right, left_velocity, right_velocity = clearances(m, y, contact.top)
    arm_left, arm_right = arms(m, y.theta, pivot)
    arm, velocity, other, other_velocity = arm_left, left_velocity, right, right_velocity
    if pivot == RIGHT:
        arm, velocity, other, other_velocity = arm_right, right_velocity, left, left_velocity
    bounce = m.epsilon * velocity
    rebounds = 0.5 * bounce * bounce / m.gravity > NEGLIGIBLE * m.alpha * m.half_width
    bounce = bounce if rebounds else 0.0
    if abs(other) <= m.rest * m.rest / (NO_ACCELERATION * m.gravity) and other_velocity < -m.rest:
        if rebounds:
            thrown = Rocking(0.0, 0.0, -m.epsilon * y.v_rate, -m.epsilon * y.omega)
            return thrown, Stance(0.0, 0.0, pivot, pivot), IMPACT_BOTH
        return Rocking(0.0, 0.0, 0.0, 0.0), RESTING, IMPACT_BOTH
    stance = on_side(pivot)
    levers = lever(m, y, stance) * lever(m, y, contact)
    inertia = m.inertia + levers - (lost_by_deck(m) if contact.top * pivot < 0.0 else 0.0)
    omega = (inertia * y.omega - arm * (y.v_rate + bounce)) * m.quickness
    landed = Rocking(y.v, y.theta, -bounce - arm * omega, omega)
    kind = IMPACT_LEFT if pivot == LEFT else IMPACT_RIGHT
    if rebounds:
        return landed, Stance(0.0, 0.0, pivot, pivot), kind
    if pivot * y.theta < 0.0:  # both are down, within rounding
        landed = Rocking(0.0, 0.0, landed.v_rate, omega)
    return constrained(m, landed, stance), stance, kind
