"""Whether a run ended before landings that may raise its demands."""

from rockbatch.core.types import Result
from rockbatch.pier import Base, FootingBase, Pier, YieldingBase, block_period

LONGEST = 30.0
"""Longest period of free rocking after a peak, in 1/p, about that at 0.999 α: at α it is infinite."""


def still_rocks(pier: Pier, base: Base, result: Result) -> bool:
    """Return True if a pier that stands may land harder, or load its devices more, after the end of its run than in it.

    A rigid block on bare rigid ground has not landed since its peak. Else its run ended within a period of free rocking of such
    a block from there: devices may be on the other side, a landing loads springs, and bends a shaft, after it, and with vertical
    vibration the next one may be harder. False for a pier that rests; for one that never left its ground, but not on a bed, of
    which a part bears while the pier rocks; and on yielding springs, where a run lasts until the pier stays down.
    """
    stays_down = result.uplifts + result.impacts == 0 and not isinstance(base, FootingBase)
    rests = stays_down if base.on_springs or base.bends else result.theta_end == 0.0
    if rests or isinstance(base, YieldingBase):
        return False
    if not (base.on_springs or base.restraints or base.bends):
        return not result.t_impact > result.t_max
    return result.t_end - result.t_max < swing_after_peak(pier, result.theta_max)


def swing_after_peak(pier: Pier, theta_max: float) -> float:
    """Return the period [s] of free rocking from a peak of ``theta_max`` [rad], :data:`LONGEST`/p at most."""
    return min(block_period(pier, theta_max), LONGEST / pier.p)
