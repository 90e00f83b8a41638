"""Landing: an impulse at the pivot alone multiplies its velocity by ε (Psycharis & Jennings 1983; THEORY.md, eq. 11)."""

from rockbatch.core.kernel import kernel
from rockbatch.core.springs.equations import geometry
from rockbatch.core.springs.model import State
from rockbatch.core.types import LEFT


@kernel
def land(m, y, side):
    """Return the state after the pivot on ``side`` (LEFT or RIGHT) has met its waiting support."""
    at = geometry(m, y.theta)
    arm = at.arm_left if side == LEFT else at.arm_right
    inertia = m.inertia + at.lever * at.lever
    velocity = y.v_rate + arm * y.omega
    impulse = -(1.0 - m.epsilon) * velocity / (1.0 + arm * arm / inertia)
    return State(y.v, y.theta, y.v_rate + impulse, y.omega + impulse * arm / inertia, y.z_left, y.z_right)


@kernel
def land_flat(m, y):
    """Return the state after both pivots have landed at one instant: both velocities, hence v̇ and θ̇, are multiplied by ε."""
    return State(y.v, y.theta, m.epsilon * y.v_rate, m.epsilon * y.omega, y.z_left, y.z_right)
