"""What an event makes of the pier: separation, landing, a spring's new branch, a pivot held or let go."""

from typing import NamedTuple

from rockbatch.core.equations import geometry, on_ground, touching, without
from rockbatch.core.events import settle
from rockbatch.core.impact import land, land_flat
from rockbatch.core.kernel import kernel
from rockbatch.core.types import (
    BOUC_WEN,
    ELASTIC,
    EPP,
    HELD_LEFT,
    HELD_RIGHT,
    IMPACT_BOTH,
    IMPACT_LEFT,
    IMPACT_RIGHT,
    LEFT,
    RIGHT,
    SEPARATION_LEFT,
    SEPARATION_RIGHT,
    SPRING_LEFT,
    SPRING_RIGHT,
    Contact,
    State,
)


class Supports(NamedTuple):
    """Unstressed positions [m] at which the supports of free pivots wait."""

    left: float
    right: float


@kernel
def handle(m, y, contact, supports, which, rest, horizontal, vertical):
    """What event ``which`` makes of state, contacts and supports: returns them and the kind of event."""
    side = LEFT if which % 2 == 0 else RIGHT
    at = geometry(m, y.theta)
    left = side == LEFT
    velocity = y.v_rate + (at.arm_left if left else at.arm_right) * y.omega
    position = y.v + (at.lift_left if left else at.lift_right)
    yields_when_loaded = 1.0 if m.law == BOUC_WEN else 0.0

    if contact.held == side:
        if which < 2:
            return y, touching(contact, side, yields_when_loaded), supports, HELD_LEFT if left else HELD_RIGHT
        freed = Supports(position, supports.right) if left else Supports(supports.left, position)
        return y, without(contact, side), freed, SEPARATION_LEFT if left else SEPARATION_RIGHT

    if which >= 2:  # the spring changes its branch
        if left:
            z = -1.0 if m.law == EPP and contact.left_yields == 0.0 else y.z_left
            changed = State(y.v, y.theta, y.v_rate, y.omega, z, y.z_right)
            return changed, touching(contact, side, 1.0 - contact.left_yields), supports, SPRING_LEFT
        z = -1.0 if m.law == EPP and contact.right_yields == 0.0 else y.z_right
        changed = State(y.v, y.theta, y.v_rate, y.omega, y.z_left, z)
        return changed, touching(contact, side, 1.0 - contact.right_yields), supports, SPRING_RIGHT

    if (contact.left if left else contact.right) != 0.0:  # separation
        if left:
            unstressed = State(y.v, y.theta, y.v_rate, y.omega, 0.0, y.z_right)
            waiting = Supports(position, supports.right)
        else:
            unstressed = State(y.v, y.theta, y.v_rate, y.omega, y.z_left, 0.0)
            waiting = Supports(supports.left, position)
        after = without(contact, side)
        kind = SEPARATION_LEFT if left else SEPARATION_RIGHT
        if velocity <= rest:
            after = settle(m, unstressed, contact, side, horizontal, vertical)
            if on_ground(after) == on_ground(contact):
                kind = HELD_LEFT if left else HELD_RIGHT
        return unstressed, after, waiting, kind

    # landing; the other pivot may land at the same instant
    other_free = contact.left == 0.0 and contact.right == 0.0 and contact.held == 0.0
    if other_free:
        gap = y.v + (at.lift_right - supports.right if left else at.lift_left - supports.left)
        other_velocity = y.v_rate + (at.arm_right if left else at.arm_left) * y.omega
        if abs(gap) <= 1e-10 * m.yield_deflection and other_velocity < -rest:
            landed = land_flat(m, y)
            both = Contact(1.0, 1.0, yields_when_loaded, yields_when_loaded, 0.0)
            if abs(m.epsilon * velocity) <= rest:
                both = settle(m, landed, both, LEFT, horizontal, vertical)
                both = settle(m, landed, both, RIGHT, horizontal, vertical)
            return landed, both, supports, IMPACT_BOTH
    landed = land(m, y, side)
    contact, supports = _other_after_impulse(m, landed, contact, supports, -side, at, rest)
    if abs(m.epsilon * velocity) > rest:
        after = touching(contact, side, yields_when_loaded)
    else:
        after = settle(m, landed, contact, side, horizontal, vertical)
        supports = Supports(position, supports.right) if left else Supports(supports.left, position)
    return landed, after, supports, IMPACT_LEFT if left else IMPACT_RIGHT


@kernel
def _other_after_impulse(m, y, contact, supports, side, at, rest):
    """Contacts and supports once an impulse at one pivot has made the velocity of the other, on ``side``, jump too.

    Its spring may have to change its branch, and a pivot that was held moves.
    """
    left = side == LEFT
    velocity = y.v_rate + (at.arm_left if left else at.arm_right) * y.omega
    if contact.held == side and abs(velocity) > rest:
        if velocity < 0.0:
            return touching(contact, side, 1.0 if m.law == BOUC_WEN else 0.0), supports
        position = y.v + (at.lift_left if left else at.lift_right)
        freed = Supports(position, supports.right) if left else Supports(supports.left, position)
        return without(contact, side), freed
    if m.law == ELASTIC or (contact.left if left else contact.right) == 0.0:
        return contact, supports
    yields = contact.left_yields if left else contact.right_yields
    if velocity > rest:
        yields = 0.0
    elif velocity < -rest and (m.law == BOUC_WEN or (y.z_left if left else y.z_right) <= -1.0):
        yields = 1.0
    return touching(contact, side, yields), supports
