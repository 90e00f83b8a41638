"""Faults of recorders in a series of samples: gaps that were filled, spikes, and an end within the strong motion.

Limits stand beside what real records have: 113 components at hand (`pytest tests/motions/test_faults.py -k real`).
"""

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from rockbatch.motions.alignment import places_of_energy
from rockbatch.motions.motion import Samples

FILLED = 0.3
"""Time [s] of the longest straight line within the strong motion beyond which a gap was filled; real records have 0.07 s."""

SPIKE = 0.5
"""Share of the peak that remains without it, below which it is a spike; real records have 0.62."""

BEGINS, ENDS = 0.4, 0.25
"""Share of the peak at the first sample, and within the last half second, beyond which a part is missing.

Real records have 0.26 and 0.08."""

_FADED = 0.1  # greatest share of the peak within a second before, and at the first sample behind, the zeros between two shocks
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

    Zeros, a held value and linear interpolation are straight. ``None`` also if half of the series is, as film read at points, and
    for a line between two shocks, before which the motion has faded and behind which it begins from rest.
    """
    if len(samples) < _FEWEST or not samples.any():
        return None
    first, last = places_of_energy(samples, _STRONG)
    bends = np.abs(np.diff(samples[first : last + 2], 2))
    straight = bends < _STRAIGHT * np.median(bends) if len(bends) else bends > 0.0
    rest, second = _FADED * np.abs(samples).max(), round(1.0 / dt)
    gaps = [
        (end - start, start)
        for start, end in (first + runs(straight)).tolist()
        if end - start >= _FEWEST and np.abs(samples[max(start - second, 0) : end + 3]).max() > rest
    ]
    count, start = max(gaps, default=(0, 0))
    return Gap(start * dt, count * dt) if count * dt > FILLED else None


def runs(mask: npt.NDArray[np.bool_]) -> npt.NDArray[np.int64]:
    """Return where each run of True begins, and ends before, shape (runs, 2)."""
    edges = np.diff(np.concatenate(([0], mask, [0])))
    return np.column_stack([np.flatnonzero(edges == step) for step in (1, -1)])


def is_spike(samples: Samples) -> bool:
    """Return True for a spike: a peak of one or two samples whose removal leaves less than half of it; False at an end.

    The sample before or behind such a peak has less than half of it.
    """
    i = int(np.abs(samples).argmax())
    if not 1 < i < len(samples) - 2 or min(samples[[i - 1, i + 1]] / samples[i]) >= SPIKE:
        return False
    without = samples.copy()
    without[i - 1 : i + 2] = np.interp((1, 2, 3), (0, 4), samples[[i - 2, i + 2]])
    return bool(np.abs(without).max() < SPIKE * np.abs(samples[i]))


def parts_missing(samples: Samples, dt: float) -> list[str]:
    """Return "begin" and "end", where a series has large samples beside its peak: within the strong motion, and not at rest."""
    peak = float(np.abs(samples).max(initial=0.0))
    last = max(min(round(_LAST / dt), int(_SHARE * len(samples))), 1)
    large = {"begin": abs(samples[0]) > BEGINS * peak, "end": np.abs(samples[-last:]).max() > ENDS * peak}
    return [part for part, is_large in large.items() if is_large]
