"""What goes into a run on springs and what comes out of it, by names: its line, its result, the rows of its history."""

from typing import NamedTuple

import numpy as np

from rockbatch.core.kernel import kernel
from rockbatch.core.outcome import WINDOWS
from rockbatch.core.records import record
from rockbatch.core.types import SpringRun


class Line(NamedTuple):
    """A run as it is asked for: the model as Springs has it, and the rest."""

    half_width: float
    height: float
    inertia: float
    gravity: float
    yield_deflection: float
    stiffness: float
    yield_force: float
    epsilon: float
    damping: float
    law: float
    guided: float
    exponent: float
    dt: float  # sampling interval [s]
    substeps: float  # steps to a sampling interval
    quiet_samples: float  # after the record
    first_row: float  # where among the rows of the ground the motion begins
    npts: float  # and how many it has
    patience: float = (
        0.0  # samples that the run goes on at most while, by its energy, the pier could still turn further
    )
    read_after: float = 0.0  # samples from the end of the record to the earliest moment at which residuals are read
    read_wait: float = 0.0  # from there to the second reading, which tells how they drift; 0: once the peak is decided
    prestress: float = 0.0  # of tendons, over the mass [m/s²]


class Row(NamedTuple):
    """A moment of a history: the time [s], State, Contact, and what kind of row it is (``types``)."""

    t: float
    v: float
    theta: float
    v_rate: float
    omega: float
    z_left: float
    z_right: float
    left: float
    right: float
    left_yields: float
    right_yields: float
    held: float
    kind: float


LINE = record(Line)
ROW = record(Row)
RESULT = np.dtype([*record(SpringRun).descr, ("extremes", "f8", WINDOWS)])
"""SpringRun, and the greatest |θ| at a sample in each window of the run."""

NO_HISTORY = np.recarray(0, ROW)


@kernel
def write(history, row, t, y, contact, kind):
    """Row of a history, where there is room for it; the next row. Where there is no history, rows are not counted."""
    if history.shape[0] == 0:
        return row
    if row < history.shape[0]:
        line = history[row]
        line.t = max(t, history[row - 1].t) if row > 0 else t  # sums of pieces are rounded, time does not go back
        line.v = y.v
        line.theta = y.theta
        line.v_rate = y.v_rate
        line.omega = y.omega
        line.z_left = y.z_left
        line.z_right = y.z_right
        line.left = contact.left
        line.right = contact.right
        line.left_yields = contact.left_yields
        line.right_yields = contact.right_yields
        line.held = contact.held
        line.kind = kind
    return row + 1
