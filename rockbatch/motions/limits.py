"""Limits of records: beyond them a header is damaged or the file is no record, and its arrays would not fit into memory."""

from rockbatch.common.units import Usual

SHORTEST_STEP, LONGEST_STEP = 1e-5, 1.0
"""Sampling interval [s]: recorders take 20 to 1000 samples a second; digitised film and simulations stay within, too."""

USUAL_STEP = Usual(0.2, "s: records have 0.002 to 0.05 s from sample to sample", 1e-5)
"""Sampling interval of a motion from Python or a pulse."""

SAME_STEP = 0.01
"""Relative difference below which two intervals are taken as one, printed with few decimals (1/256 s as .0039)."""

MOST_STEPS = 20
"""Greatest ratio of the sampling intervals of two components of a record."""

MOST_SAMPLES = 2 * 10**7
"""Greatest number of samples of a component, also after resampling to even steps: a day at 200 Hz has 17 million."""

HUGE = 1e30
"""A bound that no acceleration reaches in any unit; its powers and sums stay within the range of floats."""


def is_step(dt: float) -> bool:
    """Return whether ``dt`` [s] may be the sampling interval of a record: from 1e-5 to 1 s, both included."""
    return SHORTEST_STEP <= dt <= LONGEST_STEP


STEPS = f"{SHORTEST_STEP:g} to {LONGEST_STEP:g} s"
"""The interval's limits in words."""
