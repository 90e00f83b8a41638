"""Two series of samples compared: their best alignment, correlation by chance, and the factor and delay of a copy."""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from rockbatch.motions.motion import Samples

_COPIED = 0.98  # correlation of a component with a copy of it in another direction; real ones have 0.54 at most
_SIGNIFICANT = (
    4.0  # standard deviations of Fisher's transform: random walks have 3 at most, real files of one recording 27
)
_SAME_STEP = 1e-3  # relative
_SAME_SHAPE = 1e-3  # of the peak: rounding of a sample in a printed, scaled copy


def same_step(a: float, b: float) -> bool:
    """Return whether two sampling intervals [s] are equal to 0.1 %, since they may be rounded in print."""
    return abs(a - b) <= _SAME_STEP * b


class Alignment(NamedTuple):
    """Two series at the shift of their largest absolute correlation."""

    correlation: float  # with its sign
    delay: float  # of the first, in steps


def alignment(first: Samples, second: Samples, parts: int = 4) -> Alignment:
    """Return the correlation of largest absolute value, with sign and delay, over all shifts by 1/``parts`` of a step.

    Correlation 1 and delay 0 if either series is constant.
    """
    first, second = ((x - x.mean()) / (np.abs(x).max() or 1.0) for x in (first, second))
    n = 1 << (len(first) + len(second) - 1).bit_length()
    shifted = parts * np.fft.irfft(np.fft.rfft(first, n) * np.conj(np.fft.rfft(second, n)), parts * n)
    norm = float(np.linalg.norm(first) * np.linalg.norm(second))
    if norm <= 0:
        return Alignment(1.0, 0.0)
    best = int(np.abs(shifted).argmax())
    return Alignment(float(shifted[best]) / norm, best / parts - (n if best >= parts * len(first) else 0))


def correlation(first: Samples, second: Samples) -> float:
    """Return the largest absolute correlation of two series over all shifts by quarters of their step; 1 if one is constant."""
    return abs(alignment(first, second).correlation)


class Copy(NamedTuple):
    """Factor and delay by which a series is a copy of another."""

    factor: float
    delay: float  # in steps


def copy_between(first: Samples, second: Samples) -> Copy | None:
    """Return factor and delay in whole steps by which ``first`` is a copy of ``second``, perhaps filtered; else ``None``.

    ``None`` also if one is constant.
    """
    if not (np.ptp(first) and np.ptp(second)):
        return None
    if factor := common_factor(first, second):
        return Copy(factor, 0.0)
    r, delay = alignment(first, second, parts=1)
    if abs(r) < _COPIED or not is_significant(abs(r), first, second):
        return None
    return Copy(r * float(np.linalg.norm(first - first.mean()) / np.linalg.norm(second - second.mean())), delay)


def common_factor(first: Samples, second: Samples) -> float:
    """Return the factor that makes the ``second`` series the ``first``, to 0.1 % of its peak; 0 if there is none."""
    if len(first) != len(second) or not second.any():
        return 0.0
    factor = float(first @ second) / float(second @ second)
    return factor if np.abs(first - factor * second).max() <= _SAME_SHAPE * np.abs(first).max() else 0.0


def is_significant(r: float, first: Samples, second: Samples) -> bool:
    """Return whether an absolute correlation of two series of one step is four standard deviations or more above chance.

    A few waves of one period look alike in any two records: the inverse hyperbolic tangent of a correlation by chance, of n
    independent values, has a standard deviation of 1/√(n − 3) (Fisher).
    """
    n = _independent_values(first, second)
    return n > 3.0 and math.atanh(min(r, 1.0 - 1e-12)) * math.sqrt(n - 3.0) >= _SIGNIFICANT


def _independent_values(a: Samples, b: Samples) -> float:
    """Return the number of independent values, 2BT, common to two series of one step.

    B is the bandwidth of their power spectra S₁ and S₂, ∫S₁df ∫S₂df / ∫S₁S₂df; T is the shorter of the times in which 5 to
    95% of ∫a² dt grow, over 0.9.
    """
    n = 1 << (len(a) + len(b)).bit_length()
    first, second = (np.square(np.abs(np.fft.rfft(x - x.mean(), n))) for x in (a, b))
    bandwidth = float(first.sum() * second.sum()) / (float(first @ second) or 1.0) / n
    strong = min(int(np.diff(places_of_energy(x, (0.05, 0.95)))[0]) for x in (a, b))
    return 2.0 * bandwidth * strong / 0.9


def places_of_energy(samples: Samples, shares: Sequence[float]) -> npt.NDArray[np.int64]:
    """Return the index of the first sample at which the sum of squares reaches each of ``shares`` of its final value."""
    energy = np.cumsum(np.square(samples))
    return np.searchsorted(energy, np.multiply(shares, energy[-1]))
