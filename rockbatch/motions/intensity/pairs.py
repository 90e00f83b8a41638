"""Spectra of pairs of horizontal components: RotD50, RotD100, the geometric mean and the root of the sum of squares.

An oscillator is linear: with responses u₁(t) and u₂(t) to two components square to each other, the response to the component
along φ is u₁ cos φ + u₂ sin φ. RotDnn is the nn-th percentile over φ of ω² max_t |u(t, φ)| (Boore 2010, BSSA 100(4), 1830–1835),
independent of the orientation of the instrument: RotD50 is the median over the directions, RotD100 the maximum.
"""

import math
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from rockbatch.common.arguments import checked
from rockbatch.common.errors import InputError
from rockbatch.common.lazy import pd
from rockbatch.common.units import GRAVITY
from rockbatch.motions.labels.orientation import not_square
from rockbatch.motions.motion import Motion
from rockbatch.motions.spectrum import PERIODS, Samples, as_periods, responses

ANGLES = np.radians(np.arange(180.0))
"""Directions [rad], one degree apart over half a turn; the other half only reverses the components."""

_JITTER = 0.1  # of dt: starts that differ by less from a whole number of samples count as simultaneous


RULE_NAMES = {
    "srss": "the root of the sum of squares",
    "geomean": "the geometric mean",
    "rotd50": "RotD50",
    "rotd100": "RotD100",
}
"""Measures of a pair, in words; RotD50 and RotD100 are the median and the greatest over all directions."""

PAIR_RULES = tuple(RULE_NAMES)

TWO_COMPONENT_RULES = ("geomean", "rotd50", "rotd100")
"""Measures that need both components; the root of the sum of squares of one alone is that component."""


def pair_measures(first: Samples, second: Samples) -> dict[str, float]:
    """Return the measures by ``PAIR_RULES`` of two histories, shape (n,), in their unit."""
    a, b = _peak(first), _peak(second)
    directions = _peaks_by_direction(first, second)
    values = (math.hypot(a, b), math.sqrt(a * b), float(np.median(directions)), float(directions.max()))
    return dict(zip(PAIR_RULES, values, strict=True))


def _peak(u: Samples) -> float:
    return float(np.abs(u).max())


def _peaks_by_direction(first: Samples, second: Samples) -> Samples:
    """Return max |u₁ cos φ + u₂ sin φ| for each of the directions ``ANGLES``, shape (180,).

    Only points outside a circle can be the maximum whose radius is exceeded in every direction: mostly a hundredth of all.
    """
    radius = np.hypot(first, second)
    far = np.argpartition(radius, -min(len(radius), 64))[-64:]
    directions = np.stack((np.cos(ANGLES), np.sin(ANGLES)))
    bound = np.abs(np.column_stack((first[far], second[far])) @ directions).max(axis=0).min()
    counts = radius >= bound * (1.0 - 1e-12)
    return np.asarray(
        np.abs(np.column_stack((first[counts], second[counts])) @ directions).max(axis=0), dtype=np.float64
    )


def common_samples(first: Motion, second: Motion) -> tuple[Samples, Samples]:
    """Return the horizontal accelerations of two motions over their common time, shape (n,) each.

    Unless both have absolute times they start together, and unknown azimuths may be at a right angle. Raises ``InputError`` for
    azimuths not square to each other, different sampling intervals, starts not a whole number of samples apart, sequences with
    shocks at different times, and fewer than two samples in common.
    """
    names = f"{first.name} and {second.name}"
    if askew := not_square(first.azimuth, second.azimuth, names):
        raise InputError(askew)
    if abs(first.dt - second.dt) > 1e-6 * first.dt:
        raise InputError(f"{names} are sampled at {first.dt:g} s and {second.dt:g} s")
    late = 0.0 if first.start is None or second.start is None else (second.start - first.start) / first.dt
    shift = round(late)
    if abs(late - shift) > _JITTER:
        raise InputError(f"{names} start {abs(late):.2f} samples apart, which is no whole number")
    if any(abs(a.start - b.start) > first.dt for a, b in zip(first.shocks, second.shocks, strict=False)):
        raise InputError(f"{names} are sequences whose shocks begin at different times")
    begin, end = max(0, shift), min(first.npts, second.npts + shift)
    if end - begin < 2:
        raise InputError(f"{names} have no time in common")
    return first.horizontal[begin:end], second.horizontal[begin - shift : end - shift]


def square_pair(motions: Sequence[Motion]) -> tuple[Motion, Motion]:
    """Return the first two of a station's motions with common samples, at a right angle or one azimuth unknown.

    Raises ``InputError`` for a station without such a pair, with the reason of its first two motions.
    """
    if len(motions) < 2:
        raise InputError("its station has one horizontal component, and two are needed")
    problems: tuple[str, ...] = ()
    for i, first in enumerate(motions):
        for second in motions[i + 1 :]:
            try:
                common_samples(first, second)
            except InputError as error:
                problems = problems or error.messages
            else:
                return first, second
    raise InputError(*problems)


def pairing_obstacle(motions: Sequence[Motion]) -> str:
    """Return why :func:`pair_of` finds no pair in a station's motions; "" if it does."""
    try:
        pair_of(motions)
    except InputError as error:
        return "; ".join(error.messages)
    return ""


def pair_of(motions: Sequence[Motion]) -> tuple[Samples, Samples, float]:
    """Return the accelerations of a station's pair, at a right angle, over their common time, shape (n,), and their step [s].

    They are those of the first motion with an ``across``, else of the :func:`square_pair`. Measures of them do not depend on
    the directions to which ``motions`` are rotated. Raises ``InputError`` as :func:`square_pair` if none has an ``across``.
    """
    for motion in motions:
        if motion.across is not None:
            return motion.horizontal, motion.across, motion.dt
    first, second = square_pair(motions)
    return *common_samples(first, second), first.dt


def srss_components(motions: Sequence[Motion]) -> list[tuple[Samples, float]]:
    """Return a station's accelerations for SRSS, with their sampling intervals [s]: the first two square to each other.

    A motion and its ``across`` are a pair, too. They need no common time; unknown azimuths may be at a right angle. Without such
    a pair, the first motion alone.
    """
    first = motions[0]
    for i, motion in enumerate(motions):
        if motion.across is not None:
            return [(motion.horizontal, motion.dt), (motion.across, motion.dt)]
        for other in motions[i + 1 :]:
            if not not_square(motion.azimuth, other.azimuth, ""):
                return [(motion.horizontal, motion.dt), (other.horizontal, other.dt)]
    return [(first.horizontal, first.dt)]


def station_spectra(motions: Sequence[Motion], periods: npt.ArrayLike, damping: float) -> dict[str, Samples]:
    """Return the spectral accelerations [m/s²] of a station by ``PAIR_RULES``, shape (periods,) each.

    Raises ``InputError`` as :func:`pair_of`, and for periods and damping out of range.
    """
    *pair, dt = pair_of(motions)
    histories = (responses(a, dt, periods, damping) for a in pair)
    rows = [pair_measures(u, v) for u, v in zip(*histories, strict=True)]
    return {rule: np.array([row[rule] for row in rows]) for rule in PAIR_RULES}


@checked
def pair_spectrum(
    first: Motion, second: Motion, periods: Samples | Sequence[float] | None = None, damping: float = 0.05
) -> "pd.DataFrame":
    """Return elastic response spectra of the horizontal components of two motions that are square to each other.

    Parameters
    ----------
    first, second : Motion
        Both components of a station. Their azimuths, where both are known, have to be square to each other within a degree.
    periods : array_like, shape (n,), optional
        Undamped periods [s]; 101 from 0.05 to 5 s by default.
    damping : float
        Fraction of critical damping.

    Returns
    -------
    DataFrame, shape (n, 6)
        Pseudo-spectral accelerations, in g of 9.81 m/s², by ``period_s``: ``first_g``, ``second_g``, the components; ``srss_g``,
        the root of the sum of their squares; ``geomean_g``, their geometric mean; ``rotd50_g`` and ``rotd100_g``, the median and
        the maximum over all directions (Boore 2010).

    Raises ``InputError`` for components that are not at a right angle or have no common samples, and for impossible periods and
    damping.

    Examples
    --------
    >>> motions = rb.read_motions("motions/near_fault")
    >>> rb.pair_spectrum(motions["CHAN15"], motions["CHAN24"], [0.5, 1.0]).round(3)
              first_g  second_g  srss_g  geomean_g  rotd50_g  rotd100_g
    period_s
    0.5         0.589     0.641   0.871      0.615     0.666      0.763
    1.0         0.419     0.365   0.556      0.391     0.392      0.547
    """
    undamped = PERIODS if periods is None else as_periods(periods)
    histories = [responses(a, first.dt, undamped, damping) for a in common_samples(first, second)]
    rows = [[_peak(u), _peak(v), *pair_measures(u, v).values()] for u, v in zip(*histories, strict=True)]
    names = [f"{name}_g" for name in ("first", "second", *PAIR_RULES)]
    sa = np.array(rows).reshape(-1, len(names)) / GRAVITY
    return pd.DataFrame(sa, columns=names, index=pd.Index(undamped, name="period_s"))
