"""Even sampling intervals from printed times: rounding counts as even; uneven steps are interpolated, with a note."""

import math

import numpy as np

from rockbatch.common.errors import InputError
from rockbatch.common.showing import several
from rockbatch.motions.motion import Samples

_EVEN = 0.05  # of the step: deviation of clocks and printing from an even grid; a lost sample deviates by 1
_COARSEST = 0.4  # of the step: coarser printing hides a lost sample, which deviates by 0.5 at least
_MOST_DIGITS = 9  # decimals of seconds that are tried
_FINEST = 10  # parts of the usual step that are tried as the grid of uneven times
_SPREAD = 20.0  # longest, and inverse of the shortest, over the usual step: beyond, samples are missing
_WHOLE = 2.0**53  # greatest whole number up to which floats have all whole numbers
_GROWTH = 20  # greatest ratio of the samples of an even grid to those read


def grows_evenly(t: Samples) -> bool:
    """Return whether two times or more, shape (npts,), rise in even steps, to 5 % of a step or the rounding of their printing."""
    return _is_growing(t) and _on_grid(t, np.arange(len(t), dtype=float)) is not None


def on_even_steps(t: Samples, values: Samples) -> tuple[float, Samples, tuple[str, ...]]:
    """Return the sampling interval, in the unit of ``t``, values at even times, and notes on interpolation.

    ``t`` has shape (npts,), ``values`` shape (npts, channels). Uneven times get an even grid that keeps every sample, of a
    part of their usual step (lost samples), or of their greatest common step (film, digitised in whole ms), or else of their
    shortest step. Interpolation is linear, as a motion is between its samples. Raises ``InputError`` for times that do not
    rise, and for gaps.
    """
    if not _is_growing(t):
        still = int(np.argmin(np.diff(t) > 0)) if len(t) > 1 else 0
        raise InputError(f"time does not grow after sample {still + 1} (t = {t[still]:g}); repair the record")
    steps = np.diff(t)
    usual, shortest, longest = float(np.median(steps)), float(steps.min()), float(steps.max())
    if longest > _SPREAD * usual or shortest * _SPREAD < usual:
        uneven = int(steps.argmax() if longest > _SPREAD * usual else steps.argmin())
        raise InputError(
            f"time does not grow evenly: by {usual:g} as a rule, by {steps[uneven]:g} after sample {uneven + 1} "
            f"(t = {t[uneven]:g}); a gap is not filled, cut the record there or repair it"
        )
    decimals = math.floor(-math.log10(float(np.spacing(np.abs(t).max()))))
    if decimals <= _MOST_DIGITS:  # floats lose digits of seconds since 1970
        t = np.round(t - t[0], decimals)
    for step in _candidates(t, usual):
        counts = np.concatenate([[0.0], np.cumsum(np.rint(steps / step))])
        if counts[-1] > _GROWTH * len(t) or np.diff(counts).min() < 1:
            continue
        dt = _on_grid(t, counts)
        if dt is not None and len(counts) == counts[-1] + 1:
            return dt, values, ()
        if dt is not None:
            added = int(counts[-1]) + 1 - len(t)
            even = _interpolated(np.arange(counts[-1] + 1), counts, values)
            return dt, even, (_note(shortest, longest, dt, f"{several(added, 'sample')} put between, none lost"),)
    count = int(np.ceil((t[-1] - t[0]) / shortest * (1 - 1e-9)))
    if count > _GROWTH * len(t):
        raise InputError(
            f"time does not grow evenly: steps of {shortest:g} to {longest:g} would take {count} samples "
            f"for {len(t)}; resample the record"
        )
    dt = float(t[-1] - t[0]) / count
    even = _interpolated(t[0] + dt * np.arange(count + 1), t, values)
    peaks, even_peaks = np.abs(values).max(axis=0), np.abs(even).max(axis=0)
    lost = float(((peaks - even_peaks) / np.where(peaks > 0, peaks, 1.0)).max())
    return dt, even, (_note(shortest, longest, dt, f"its peak is lower by {lost:.1%}"),)


def from_pairs(pairs: Samples, channel: str) -> tuple[float, Samples, tuple[str, ...]]:
    """Return the sampling interval, even samples, shape (npts,), and notes for pairs of time and value, shape (npts, 2).

    Raises ``InputError``, beginning with the ``channel``, as :func:`on_even_steps` does.
    """
    try:
        dt, values, notes = on_even_steps(pairs[:, 0], pairs[:, 1:])
    except InputError as error:
        raise InputError(f"{channel}: {error}") from None
    return dt, values[:, 0], notes


def _is_growing(t: Samples) -> bool:
    """Return whether there are two times or more, each later than the one before."""
    return len(t) > 1 and bool((np.diff(t) > 0).all())


def _candidates(t: Samples, usual: float) -> list[float]:
    """Return possible steps of an even grid: parts of the ``usual`` one, from coarse to fine, then the greatest common step."""
    steps = [usual / parts for parts in range(1, _FINEST + 1)]
    printed = _resolution(t)
    if printed > 0 and np.abs(t).max() < _WHOLE * printed:
        steps.append(printed * float(np.gcd.reduce(np.rint((t - t[0]) / printed).astype(np.int64))))
    return steps


def _on_grid(t: Samples, counts: Samples) -> float | None:
    """Return the step of the even grid in which sample i is number counts[i]; ``None`` if the times deviate from it."""
    dt = float(t[-1] - t[0]) / float(counts[-1])
    printed = _resolution(t)
    allowed = _EVEN * dt if printed > _COARSEST * dt else max(_EVEN * dt, printed)
    deviation = float(np.abs(t - (t[0] + dt * counts)).max())
    return float(f"{dt:.12g}") if deviation <= allowed else None


def _resolution(t: Samples) -> float:
    """Return the unit of the last printed decimal of times, in their unit; 0 for more than nine decimals."""
    shortest = float(np.diff(t).min())
    for digits in range(_MOST_DIGITS + 1):
        scaled = t * 10.0**digits
        if shortest * 10.0**digits > 0.999 and np.abs(scaled - np.rint(scaled)).max() < 1e-3:
            return 10.0**-digits
    return 0.0


def _interpolated(places: Samples, counts: Samples, values: Samples) -> Samples:
    """Return ``values``, which are given at ``counts``, interpolated linearly at ``places``, shape (places, channels)."""
    return np.column_stack([np.interp(places, counts, channel) for channel in values.T])


def _note(shortest: float, longest: float, dt: float, effect: str) -> str:
    """Return the note on uneven times, with the ``effect`` of interpolation."""
    return f"uneven times (steps of {shortest:g} to {longest:g}) interpolated linearly to dt = {dt:g}; {effect}"
