"""What observers of a run that was written down read: the rows of its history, its ground, and the middle of a step."""

from rockbatch.core.kernel import kernel
from rockbatch.core.types import Contact, State


@kernel
def state_of(row):
    """State of a row."""
    return State(row.v, row.theta, row.v_rate, row.omega, row.z_left, row.z_right)


@kernel
def contact_of(row):
    """Contact of a row: that of the step that ends there, or after the event."""
    return Contact(row.left, row.right, row.left_yields, row.right_yields, row.held)


@kernel
def ground_at(ground, dt, middle, t):
    """Ground accelerations, horizontal and vertical, at ``t``, in the sampling interval in which ``middle`` lies."""
    sample = int(middle / dt)
    if sample >= len(ground):
        return 0.0, 0.0
    after = t - sample * dt
    return ground[sample, 0] + after * ground[sample, 1], ground[sample, 2] + after * ground[sample, 3]


@kernel
def middle_of(y, k, y_end, k_end, h):
    """State in the middle of a step, from the cubic Hermite polynomial."""
    eighth = 0.125 * h
    return State(
        0.5 * (y.v + y_end.v) + eighth * (k.v - k_end.v),
        0.5 * (y.theta + y_end.theta) + eighth * (k.theta - k_end.theta),
        0.5 * (y.v_rate + y_end.v_rate) + eighth * (k.v_rate - k_end.v_rate),
        0.5 * (y.omega + y_end.omega) + eighth * (k.omega - k_end.omega),
        0.5 * (y.z_left + y_end.z_left) + eighth * (k.z_left - k_end.z_left),
        0.5 * (y.z_right + y_end.z_right) + eighth * (k.z_right - k_end.z_right),
    )
