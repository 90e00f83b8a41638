"""Events of a pier with an elastic shaft; those without jumps are a rigid block's (THEORY.md, A shaft that bends)."""

from rockbatch.core import system
from rockbatch.core.block.equations import clearances, constrained, key_of, on_pivot, on_side, side_of
from rockbatch.core.block.events import (
    NEARBY,
    RESTING,
    event_functions_of,
    lift_off,
    lift_rate,
    released,
    within_bounce,
)
from rockbatch.core.block.model import Stance
from rockbatch.core.devices.laws import OPENS
from rockbatch.core.devices.pull import about_to_turn
from rockbatch.core.flexure.equations import flexing, masses_about
from rockbatch.core.flexure.model import FlexibleBlock
from rockbatch.core.flexure.modes import deflection_rates, deflections, dot
from rockbatch.core.ground import later
from rockbatch.core.kernel import kernel
from rockbatch.core.roots import NO_ACCELERATION
from rockbatch.core.system import airborne, rates
from rockbatch.core.table import along
from rockbatch.core.trigonometry import sine_and_cosine
from rockbatch.core.types import (
    CONTACT_LEFT,
    IMPACT_BOTH,
    IMPACT_LEFT,
    IMPACT_RIGHT,
    LEFT,
    RIGHT,
    TAKE_OFF,
    Moment,
    Transition,
)

system.event_functions.of(FlexibleBlock)(event_functions_of)
system.released.of(FlexibleBlock)(released)


@system.longest_step.of(FlexibleBlock)
def longest_step(m, start, h):
    """Return a step [s] of at most ``h`` that shows a bounce, or in flight resolves the modes."""
    return min(h, m.flight_step) if airborne(m, start.contact) else within_bounce(m, start, h)


@lift_rate.of(FlexibleBlock)
def _lift_rate(m, devices, now, side):
    near, stance = NEARBY / m.frequency.fourth, on_side(side)
    under = about_to_turn(devices, m, now.y, stance, OPENS)
    soon = along(now.y, now.k, near)
    change = rates(under, soon, stance, later(now.ground, near)).omega - rates(under, now.y, stance, now.ground).omega
    return side * change / near


@system.transition.of(FlexibleBlock)
def transition(m, devices, now, which, ground, dt):
    """Return the Transition by event ``which``; landings beyond α, of a pier that topples, are not counted as impacts."""
    y, contact, supports = now
    side = side_of(contact)
    pivot = LEFT if which == CONTACT_LEFT else RIGHT
    if side == pivot:
        return Transition(Moment(y, Stance(0.0, 0.0, side, side), supports), TAKE_OFF, 0.0, 0.0, 0.0)
    if side != 0.0:
        y, contact, kind = _impact(m, y, side)
        return Transition(Moment(y, contact, supports), kind, 1.0, 0.0, 0.0)
    if airborne(m, contact):
        y, contact, kind = _landing(m, y, contact, pivot)
        topples = abs(y.theta) >= m.alpha and kind != IMPACT_BOTH
        impacts = 0.0 if topples else (2.0 if kind == IMPACT_BOTH else 1.0)
        return Transition(Moment(y, contact, supports), kind, impacts, 0.0, 0.0)
    y, contact, kind = lift_off(m, devices, y, -pivot, ground)
    return Transition(Moment(y, contact, supports), kind, 0.0, 1.0, 0.0)


@kernel
def _after_blow(m, y, key, rise, pivot):
    """Return θ̇ and the rates of the modes after an impact at ``pivot``.

    Before it the base turned about ``key``, which rose at ``rise`` [m/s]. The impulse has no moment about the pivot and does no
    work on the modes, so that all these momenta are conserved.
    """
    sine, cosine = sine_and_cosine(y.theta)
    u, u_rate, b = deflections(y), deflection_rates(y), m.half_width
    about, moved = masses_about(m, u, pivot), dot(m.share, u)
    across = m.inertia + m.height * m.height + key * pivot * b * b + dot(u, u) - moved * (key + pivot) * b
    bending = along(along(u_rate, m.coupling, y.omega), m.share, -sine * rise)
    turning = dot(m.coupling, u_rate) + across * y.omega - rise * (m.height * sine - about.offset * cosine)
    inertia = about.turning - dot(m.coupling, m.coupling)
    omega = (turning - dot(m.coupling, bending)) / inertia
    return omega, along(bending, m.coupling, -omega)


@kernel
def _flat(m, y):
    """Return the state after both pivots stop at once: only the modes move on, with their momenta."""
    return flexing(0.0, 0.0, 0.0, 0.0, deflections(y), along(deflection_rates(y), m.coupling, y.omega))


@kernel
def _impact(m, y, side):
    """Return state, stance and kind as the base passes through θ = 0.

    If the pier would not continue to turn about the new pivot, both pivots stay down.
    """
    y = flexing(0.0, 0.0, y.v_rate, y.omega, deflections(y), deflection_rates(y))
    omega, u_rate = _after_blow(m, y, side, 0.0, -side)
    if -side * omega <= 0.0:
        return _flat(m, y), RESTING, IMPACT_BOTH
    stance = on_side(-side)
    landed = constrained(m, flexing(0.0, 0.0, 0.0, omega, deflections(y), u_rate), stance)
    return landed, stance, IMPACT_LEFT if side == RIGHT else IMPACT_RIGHT


@kernel
def _landing(m, y, contact, pivot):
    """Return state, stance and kind as ``pivot`` lands from flight, without rebound; at rest on both if the other lands, too."""
    left, right, left_velocity, right_velocity = clearances(m, y, contact.top)
    other, other_velocity = (right, right_velocity) if pivot == LEFT else (left, left_velocity)
    key = key_of(m, contact)
    rise = y.v_rate - on_pivot(m, y.theta, key)[1] * y.omega
    if abs(other) <= m.rest * m.rest / (NO_ACCELERATION * m.gravity) and other_velocity < -m.rest:
        return _flat(m, y), RESTING, IMPACT_BOTH
    omega, u_rate = _after_blow(m, y, key, rise, pivot)
    stance = on_side(pivot)
    landed = constrained(m, flexing(y.v, y.theta, 0.0, omega, deflections(y), u_rate), stance)
    return landed, stance, IMPACT_LEFT if pivot == LEFT else IMPACT_RIGHT
