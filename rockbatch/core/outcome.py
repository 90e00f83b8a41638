"""When a run may end: the pier lies on its side, or can no longer get there."""

import math

from rockbatch.core.kernel import kernel
from rockbatch.core.types import NOT_FINITE, OVERTURNED, SURVIVED

ON_ITS_SIDE = 0.5 * math.pi


@kernel
def fallen(theta):
    """OVERTURNED once the pier lies on its side, NOT_FINITE for what no pier turns within a step, else SURVIVED."""
    if abs(theta) < ON_ITS_SIDE:
        return SURVIVED
    return OVERTURNED if abs(theta) < 2.0 * ON_ITS_SIDE else NOT_FINITE


@kernel
def undecided(theta, omega, alpha, p):
    """Whether a pier that is left alone might still overturn.

    In free rocking it does if its kinetic energy exceeds what is left to climb, ½ θ̇² > p² (1 − cos(α − |θ|)) for a
    rigid base; springs lower the summit a little, hence the second condition.
    """
    tilt = abs(theta)
    if 0.5 * omega * omega >= p * p * (1.0 - math.cos(alpha - tilt)):
        return True
    return tilt >= alpha or (tilt >= 0.5 * alpha and theta * omega > 0.0)


@kernel
def patience(p, dt):
    """Number of samples after which a pier left alone has left any unstable equilibrium that rounding can hold."""
    return int(40.0 / (p * dt)) + 1
