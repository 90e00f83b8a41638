"""What observers of a run that was written down read: the rows of its history, its ground, and the middle of a step."""

from rockbatch.core.block.model import Rocking, Stance
from rockbatch.core.kernel import kernel
from rockbatch.core.springs.model import Contact, State
from rockbatch.core.table import along


@kernel
def spring_state(row):
    """Return the State of a row."""
    return State(row.v, row.theta, row.v_rate, row.omega, row.z_left, row.z_right)


@kernel
def spring_contact(row):
    """Return the Contact of a row: that of the step that ends there, or after the event."""
    return Contact(row.left, row.right, row.left_yields, row.right_yields, row.held)


@kernel
def block_state(row):
    """Return the state of a row, Rocking."""
    return Rocking(row.v, row.theta, row.v_rate, row.omega)


@kernel
def block_contact(row):
    """Return the Stance of a row: that of the step that ends there, or after the event."""
    return Stance(row.left, row.right, row.bore)


@kernel
def ground_at(ground, dt, middle, t):
    """Return ground accelerations, horizontal and vertical, at ``t``, in the sampling interval in which ``middle`` lies."""
    sample = int(middle / dt)
    if sample >= len(ground):
        return 0.0, 0.0
    after = t - sample * dt
    return ground[sample, 0] + after * ground[sample, 1], ground[sample, 2] + after * ground[sample, 3]


@kernel
def middle_of(y, k, y_end, k_end, h):
    """Return the state in the middle of a step, from the cubic Hermite polynomial."""
    middle = along(y, along(y_end, y, -1.0), 0.5)
    return along(middle, along(k, k_end, -1.0), 0.125 * h)
