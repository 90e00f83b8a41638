"""Ground acceleration: a row for each sample, linear in between."""

import numpy as np

from rockbatch.core.kernel import inlined
from rockbatch.core.types import Ground


def ground_rows(horizontal, vertical, dt):
    """Return accelerations [m/s²] and slopes [m/s³] from each sample to the next: horizontal, its slope, vertical, its slope.

    Linear between samples, and from the last one to zero a sample later. ``vertical`` may be empty, for zeros.

    Returns
    -------
    ndarray, shape (npts, 4)
    """
    rows = np.zeros((len(horizontal), 4))
    for column, samples in ((0, horizontal), (2, vertical)):
        if len(samples):
            rows[:, column] = samples
            with np.errstate(over="ignore"):  # a run through such a spike ends as NOT_FINITE
                rows[:, column + 1] = np.diff(samples, append=0.0) / dt
    return rows


@inlined
def later(ground, x):
    """Return the Ground ``x`` [s] later, within the same sampling interval."""
    a_slope, c_slope = ground.horizontal_slope, ground.vertical_slope
    return Ground(ground.horizontal + x * a_slope, a_slope, ground.vertical + x * c_slope, c_slope)
