"""When a run may end: the pier lies on its side, or has been waited for long enough."""

import math

from rockbatch.core.kernel import kernel
from rockbatch.core.types import NOT_FINITE, OVERTURNED, SURVIVED

ON_ITS_SIDE = 0.5 * math.pi

WINDOWS = 32
"""Parts of a run, equal in time, in each of which its greatest |θ| at a sample is kept: its trajectory in short."""

GROWTH = 1e-4
"""Of α: by how much |θ| and the base's tilt may grow in the second half of the waiting without the pier counting as
leaning further."""


@kernel
def fallen(theta):
    """OVERTURNED once the pier lies on its side, NOT_FINITE for what no pier turns within a step, else SURVIVED."""
    if abs(theta) < ON_ITS_SIDE:
        return SURVIVED
    return OVERTURNED if abs(theta) < 2.0 * ON_ITS_SIDE else NOT_FINITE


@kernel
def window_of(sample, samples):
    """Window of a run of ``samples`` in which ``sample`` lies, and the sample with which the next one begins.

    The last window lasts to the end of the run, however long it is waited for.
    """
    window = min(int(sample * WINDOWS / max(samples, 1.0)), WINDOWS - 1)
    begin_next = float(math.ceil((window + 1) * samples / WINDOWS)) if window < WINDOWS - 1 else math.inf
    return float(window), begin_next


@kernel
def widen(extremes, sample, samples, theta):
    """Take |θ| at ``sample`` into the greatest one of its window."""
    window = int(window_of(sample, samples)[0])
    if not abs(theta) <= extremes[window]:  # also where there is none yet
        extremes[window] = abs(theta)
