"""The ground under a run: one row for each sample, as both integrators read it."""

import numpy as np


def ground_rows(horizontal, vertical, dt):
    """Accelerations [m/s²] and slopes [m/s³] from each sample to the next: horizontal, its slope, vertical, its slope.

    Linear between samples, and from the last one to zero a sample later. ``vertical`` may be empty.

    Returns
    -------
    ndarray, shape (npts, 4)
    """
    rows = np.zeros((len(horizontal), 4))
    for column, samples in ((0, horizontal), (2, vertical)):
        if len(samples):
            rows[:, column] = samples
            with np.errstate(over="ignore"):  # a run through such a spike ends as not finite, and says so
                rows[:, column + 1] = np.diff(samples, append=0.0) / dt
    return rows
