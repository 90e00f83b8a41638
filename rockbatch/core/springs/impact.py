"""Landings: an impulse at the pivot alone (Psycharis & Jennings 1983), or Housner's e on θ̇ (THEORY.md, eqs. 11 and 11a)."""

from rockbatch.core.kernel import kernel
from rockbatch.core.springs.equations import geometry
from rockbatch.core.springs.model import HOUSNER
from rockbatch.core.table import with_rates
from rockbatch.core.types import IMPACT_BOTH, IMPACT_LEFT, LEFT, RIGHT


@kernel
def supported(contact, side):
    """Return True if the pivot on ``side`` is on its support, or grazes it."""
    return (contact.left if side == LEFT else contact.right) != 0.0 or contact.held == side


@kernel
def _arms(m, theta, side):
    """Return the signed arms ∂v/∂θ [m] of the pivot on ``side`` (LEFT, RIGHT) and of the other one, and the moment of inertia.

    At θ = 0 the left arm is b and the right one −b. The moment of inertia over the mass is that in full contact [m²].
    """
    at = geometry(m, theta)
    inertia = m.inertia + at.lever * at.lever
    if side == LEFT:
        return at.arm_left, at.arm_right, inertia
    return at.arm_right, at.arm_left, inertia


@kernel
def land(m, y, side, contact):
    """Return the state after the pivot on ``side`` (LEFT or RIGHT) has landed on its support, and the pivot's velocity then.

    By Housner's e the other pivot keeps its velocity if it is ``supported``; otherwise the centre of mass does.
    """
    arm, other, inertia = _arms(m, y.theta, side)
    if m.impact == HOUSNER:
        v_rate, omega = y.v_rate, m.restitution * y.omega
        if supported(contact, -side):
            v_rate += other * (y.omega - omega)
        return with_rates(y, v_rate, omega), v_rate + arm * omega
    velocity = y.v_rate + arm * y.omega
    impulse = -(1.0 - m.epsilon) * velocity / (1.0 + arm * arm / inertia)
    landed = with_rates(y, y.v_rate + impulse, y.omega + impulse * arm / inertia)
    return landed, m.epsilon * velocity


@kernel
def land_flat(m, y):
    """Return the state after both pivots have landed at one instant: both velocities, hence v̇ and θ̇, are multiplied by ε.

    By Housner's e θ̇ is multiplied by e, and v̇ is kept.
    """
    if m.impact == HOUSNER:
        return with_rates(y, y.v_rate, m.restitution * y.omega)
    return with_rates(y, m.epsilon * y.v_rate, m.epsilon * y.omega)


@kernel
def loss(m, y, contact, kind):
    """Return the energy [J/kg] lost in an impact of ``kind`` from state ``y``, with the contacts before it.

    By the landing pivot's ε it is never negative; by Housner's e it is negative if the supporting pivot moves fast enough
    (THEORY.md, eq. 11b).
    """
    side = LEFT if kind == IMPACT_LEFT else RIGHT
    arm, other, inertia = _arms(m, y.theta, side)
    if m.impact == HOUSNER:
        e = m.restitution
        if kind == IMPACT_BOTH or not supported(contact, -side):
            return 0.5 * (1.0 - e * e) * inertia * y.omega * y.omega
        velocity = y.v_rate + other * y.omega
        return (1.0 - e) * y.omega * (0.5 * (1.0 + e) * (inertia + other * other) * y.omega - other * velocity)
    lost = 0.5 * (1.0 - m.epsilon * m.epsilon)
    if kind == IMPACT_BOTH:
        return lost * (y.v_rate * y.v_rate + inertia * y.omega * y.omega)
    velocity = y.v_rate + arm * y.omega
    return lost * velocity * velocity / (1.0 + arm * arm / inertia)
