"""Faults of recorders in a series of samples: gaps that were filled, spikes, and an end within the strong motion.

Limits stand beside what real records have: 113 components at hand (`pytest tests/motions/test_faults.py -k real`).
"""

from typing import NamedTuple

import numpy as np

from rockbatch.motions.motion import Samples

FILLED = 0.3
"""Time [s] of the longest straight line within the strong motion beyond which a gap was filled; real records have 0.07 s."""

SPIKE = 0.5
"""Share of the peak that remains without it, below which it is a spike; real records have 0.62."""

BEGINS, ENDS = 0.4, 0.25
"""Share of the peak at the first sample, and within the last half second, beyond which a part is missing.

Real records have 0.26 and 0.08."""

_STRAIGHT = 1e-3  # of the median second difference: nothing recorded is as straight, but rounding is
_FEWEST = 8  # samples of a filled gap
_LAST, _SHARE = 0.5, 0.05  # s, and greatest share of the record
_STRONG = (0.05, 0.95)  # of ∫a² dt


class Gap(NamedTuple):
    """A straight line within the strong motion."""

    begins: float  # [s] from the first sample
    lasts: float  # [s]


def filled_gap(samples: Samples, dt: float) -> Gap | None:
    """Return the longest straight line between 5 and 95 % of ∫a² dt if it is longer than :data:`FILLED`; else ``None``.

    Zeros, a held value and linear interpolation are straight. ``None`` also if half of the series is, as film read at points.
    """
    energy = np.cumsum(np.square(samples))
    if len(samples) < _FEWEST or not energy[-1] > 0.0:
        return None
    first, last = np.searchsorted(energy, np.multiply(_STRONG, energy[-1]))
    bends = np.abs(np.diff(samples[first : last + 2], 2))
    straight = np.concatenate(([0], bends < _STRAIGHT * np.median(bends), [0])) if len(bends) else np.zeros(2)
    starts, ends = np.flatnonzero(np.diff(straight) == 1), np.flatnonzero(np.diff(straight) == -1)
    if not len(starts):
        return None
    longest = int((ends - starts).argmax())
    count = int(ends[longest] - starts[longest])
    if count < _FEWEST or count * dt <= FILLED:
        return None
    return Gap(float(first + starts[longest]) * dt, count * dt)


def is_spike(samples: Samples) -> bool:
    """Return whether the peak is one of one or two samples, without which less than half of it remains; False at an end.

    The sample before or behind such a peak has less than half of it.
    """
    i = int(np.abs(samples).argmax())
    if not 1 < i < len(samples) - 2 or min(samples[[i - 1, i + 1]] / samples[i]) >= SPIKE:
        return False
    without = samples.copy()
    without[i - 1 : i + 2] = np.interp((1, 2, 3), (0, 4), samples[[i - 2, i + 2]])
    return bool(np.abs(without).max() < SPIKE * np.abs(samples[i]))


def missing_parts(samples: Samples, dt: float) -> list[str]:
    """Return "begins" and "ends" in a list for a series that does so within the strong motion; [] for others, and at rest."""
    peak = float(np.abs(samples).max(initial=0.0))
    if peak == 0.0:
        return []
    last = max(min(round(_LAST / dt), int(_SHARE * len(samples))), 1)
    shares = {"begins": abs(samples[0]), "ends": np.abs(samples[-last:]).max()}
    limits = {"begins": BEGINS, "ends": ENDS}
    return [part for part, share in shares.items() if share > limits[part] * peak]
