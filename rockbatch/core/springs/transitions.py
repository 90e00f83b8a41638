"""Transitions at events: separation, landing, change of a spring's branch, grazing contact and its end.

Written for the left pivot; at the right one, the mirror image is handled (θ → −θ, left ↔ right, ü_g → −ü_g).
"""

import math

from rockbatch.core import system
from rockbatch.core.kernel import hook, kernel
from rockbatch.core.springs.backbone import corner_beyond
from rockbatch.core.springs.equations import geometry, on_ground, touching, without
from rockbatch.core.springs.events import settle
from rockbatch.core.springs.impact import land, land_flat
from rockbatch.core.springs.laws import (
    after_switch,
    branch_after_jump,
    branch_of_landing,
    yield_point,
    yields_when_pressed,
)
from rockbatch.core.springs.model import Contact, Springs, State, Supports
from rockbatch.core.springs.recovery import lag, velocity_of_top
from rockbatch.core.table import with_pull, with_z
from rockbatch.core.types import (
    CONTACT_LEFT,
    HELD_LEFT,
    HELD_RIGHT,
    IMPACT_BOTH,
    IMPACT_LEFT,
    IMPACT_RIGHT,
    LAW_LEFT,
    LAW_RIGHT,
    LEFT,
    RIGHT,
    SEPARATION_LEFT,
    SEPARATION_RIGHT,
    SPRING_LEFT,
    SPRING_RIGHT,
    Ground,
    Moment,
    Pull,
    Transition,
)


@hook
def mirrored(y):
    """Return the mirror image of a state."""


@mirrored.of(State)
def _mirrored_state(y):
    return State(y.v, -y.theta, y.v_rate, -y.omega, y.z_right, y.z_left)


@hook
def _mirrored_pull(pull):
    """Return the mirror image of a pull of devices; None of None."""


@_mirrored_pull.of(type(None))
def _no_pull(pull):
    return None


@_mirrored_pull.of(Pull)
def _pull_to_the_other_side(pull):
    return Pull(pull.force, -pull.moment)


@kernel
def _mirrored_contact(contact):
    held = 0.0 - contact.held
    return Contact(contact.right, contact.left, contact.right_yields, contact.left_yields, held)


@kernel
def _mirrored_supports(supports):
    return Supports(supports.right, supports.left, supports.yield_right, supports.yield_left)


@kernel
def _mirrored_kind(kind):
    if kind == SEPARATION_LEFT:
        return SEPARATION_RIGHT
    if kind == IMPACT_LEFT:
        return IMPACT_RIGHT
    if kind == SPRING_LEFT:
        return SPRING_RIGHT
    return HELD_RIGHT if kind == HELD_LEFT else kind


@kernel
def _mirrored_moment(now):
    return Moment(mirrored(now.y), _mirrored_contact(now.contact), _mirrored_supports(now.supports))


@system.transition.of(Springs)
def transition(m, devices, now, which, ground, dt):
    """Return the Transition by event ``which``; a pivot may land and separate at once."""
    after, kind = handle(m, now, which, ground)
    landed = 2 if kind == IMPACT_BOTH else (1 if kind in (IMPACT_LEFT, IMPACT_RIGHT) else 0)
    uplifts = landed - on_ground(after.contact) + on_ground(now.contact)
    return Transition(after, kind, float(landed), float(uplifts), 0.0)


@kernel
def handle(m, now, which, ground):
    """Return the Moment after event ``which``, of a pivot's contact or of its spring's law, and the kind of event."""
    if which in (CONTACT_LEFT, LAW_LEFT):
        after, kind = _transition_of_left(m, now, which == LAW_LEFT, ground)
    else:
        mirrored_pier = with_pull(m, _mirrored_pull(m.pull))
        mirrored_ground = Ground(-ground.horizontal, -ground.horizontal_slope, ground.vertical, ground.vertical_slope)
        mirrored, kind = _transition_of_left(mirrored_pier, _mirrored_moment(now), which == LAW_RIGHT, mirrored_ground)
        after, kind = _mirrored_moment(mirrored), _mirrored_kind(kind)
    supports = with_yield_points(m, now.y, now.contact, after.contact, after.supports)
    return Moment(after.y, after.contact, supports), kind


@kernel
def with_yield_points(m, at, before, after, supports):
    """Return ``supports`` with new yield points of springs that left their inelastic branch at z of ``at``."""
    left, right = supports.yield_left, supports.yield_right
    if before.left_yields > after.left_yields:
        left = yield_point(m.law, left, at.z_left)
    if before.right_yields > after.right_yields:
        right = yield_point(m.law, right, at.z_right)
    return Supports(supports.left, supports.right, left, right)


@kernel
def _left_moved(supports, position):
    """Return ``supports`` with the left one unstressed at ``position`` [m]."""
    return Supports(position, supports.right, supports.yield_left, supports.yield_right)


@kernel
def _transition_of_left(m, now, of_law, ground):
    """Return Moment and kind after an event of the left pivot, of its spring's law if ``of_law``, else of its contact."""
    y, contact, supports = now
    if contact.held == LEFT:
        at = geometry(m, y.theta)
        if not of_law:
            yields = branch_of_landing(m, y.v_rate + at.arm_left * y.omega)
            return Moment(y, touching(contact, LEFT, yields), supports), HELD_LEFT
        waiting = _left_moved(supports, y.v + at.lift_left - m.yield_deflection * y.z_left)
        return Moment(y, without(contact, LEFT), waiting), SEPARATION_LEFT
    if of_law:  # the spring changes to or from its elastic branch
        yields, z = after_switch(m, contact.left_yields, supports.yield_left, y.z_left)
        return Moment(with_z(y, z, y.z_right), touching(contact, LEFT, yields), supports), SPRING_LEFT
    if contact.left_yields != 0.0 and corner_beyond(m.backbone, contact.left_yields) < math.inf:
        at_corner = with_z(y, -corner_beyond(m.backbone, contact.left_yields), y.z_right)
        return Moment(at_corner, touching(contact, LEFT, contact.left_yields + 1.0), supports), SPRING_LEFT
    if contact.left != 0.0:
        return _separation(m, now, ground)
    return _landing(m, now, ground)


@kernel
def _separation(m, now, ground):
    """Return Moment and kind as the left pivot separates; HELD_LEFT if accelerations keep it in contact or grazing.

    A damped support begins to recover as fast as the pivot rises.
    """
    y, contact, supports = now
    at = geometry(m, y.theta)
    velocity = y.v_rate + at.arm_left * y.omega
    z = 0.0 if m.damped is None else -lag(m) * max(velocity, 0.0)
    unborne = with_z(y, z, y.z_right)
    waiting = _left_moved(supports, y.v + at.lift_left - m.yield_deflection * z)
    if m.damped is None and velocity > m.rest:
        return Moment(unborne, without(contact, LEFT), waiting), SEPARATION_LEFT
    after = settle(m, unborne, contact, LEFT, ground)
    kind = HELD_LEFT if on_ground(after) == on_ground(contact) else SEPARATION_LEFT
    return Moment(unborne, after, waiting), kind


@kernel
def _landing(m, now, ground):
    """Return Moment and kind as the left pivot lands on its support; the right one may land at the same instant."""
    y, contact, supports = now
    if m.damped is not None:
        return _damped_landing(m, now, ground)
    at = geometry(m, y.theta)
    loaded = yields_when_pressed(m.law)
    other_free = contact.left == 0.0 and contact.right == 0.0 and contact.held == 0.0
    if other_free:
        gap = y.v + (at.lift_right - supports.right)
        if abs(gap) <= 1e-10 * m.yield_deflection and y.v_rate + at.arm_right * y.omega < -m.rest:
            landed = land_flat(m, y)
            both = Contact(1.0, 1.0, loaded, loaded, 0.0)
            if abs(landed.v_rate + at.arm_left * landed.omega) <= m.rest:
                both = settle(m, landed, both, LEFT, ground)
            if abs(landed.v_rate + at.arm_right * landed.omega) <= m.rest:
                both = settle(m, landed, both, RIGHT, ground)
            return Moment(landed, both, supports), IMPACT_BOTH
    landed, velocity = land(m, y, LEFT, contact)
    contact, supports = _right_after_impulse(m, landed, contact, supports, at)
    if velocity < -m.rest:
        return Moment(landed, touching(contact, LEFT, loaded), supports), IMPACT_LEFT
    if velocity > m.rest:  # Housner's e has lifted it again
        return Moment(landed, contact, _left_moved(supports, y.v + at.lift_left)), IMPACT_LEFT
    after = settle(m, landed, contact, LEFT, ground)
    return Moment(landed, after, _left_moved(supports, y.v + at.lift_left)), IMPACT_LEFT


@kernel
def _damped_landing(m, now, ground):
    """Return Moment and kind as the left pivot lands on its damped support, without an impulse."""
    y, contact, supports = now
    velocity = y.v_rate + geometry(m, y.theta).arm_left * y.omega
    if abs(velocity - velocity_of_top(m, y.z_left)) <= m.rest:
        return Moment(y, settle(m, y, contact, LEFT, ground), supports), IMPACT_LEFT
    return Moment(y, touching(contact, LEFT, branch_of_landing(m, velocity)), supports), IMPACT_LEFT


@kernel
def _right_after_impulse(m, y, contact, supports, at):
    """Return contacts and supports after an impulse at the left pivot, by which the velocity of the right one jumps, too.

    Its spring may change its branch, and a grazing contact may end.
    """
    velocity = y.v_rate + at.arm_right * y.omega
    if contact.held == RIGHT and abs(velocity) > m.rest:
        if velocity < 0.0:
            return touching(contact, RIGHT, yields_when_pressed(m.law)), supports
        moved = Supports(supports.left, y.v + at.lift_right, supports.yield_left, supports.yield_right)
        return without(contact, RIGHT), moved
    if contact.right == 0.0:
        return contact, supports
    yields = branch_after_jump(m, contact.right_yields, supports.yield_right, y.z_right, velocity)
    return touching(contact, RIGHT, yields), supports
