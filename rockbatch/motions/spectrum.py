"""Elastic response spectra of an acceleration that is linear between its samples.

The damped oscillator ü + 2ζω u̇ + ω² u = −a(t) has the characteristic roots s and s̄, s = −ζω + iω_d. With
z = u̇ − s̄u it is one complex equation, ż = sz − a(t), and u = Im z/ω_d. Over a sampling interval Δ in which a is
linear its solution is exact (Nigam & Jennings 1969, BSSA 59(2), 909–922, in complex form):

    z(t + Δ) = λ z(t) − c₀ a(t) − c₁ a(t + Δ),   λ = exp(sΔ),
    c₀ + c₁ = (λ − 1)/s,                         c₁ = (λ − 1 − sΔ)/(s²Δ).
"""

import math
from collections.abc import Iterator

import numpy as np
import numpy.typing as npt

from rockbatch.common.errors import InputError, refuse

Samples = npt.NDArray[np.float64]

PERIODS = np.geomspace(0.05, 5.0, 101)
"""Periods of a suite's spectra [s], fifty a decade, so that a polygon through them looks smooth."""

_BLOCK = 64  # samples stepped one after the other; blocks advance side by side
_TOGETHER = 16  # oscillators whose histories are in memory at a time
_PER_PERIOD = 20  # least samples per period, so that a peak between them is missed by less than 1.3 %


def as_periods(periods: npt.ArrayLike) -> Samples:
    """Return periods as an array, shape (n,); raise ``InputError`` unless they are a sequence of numbers, of any sign."""
    try:
        values = np.asarray(periods, dtype=np.float64)
    except (TypeError, ValueError, OverflowError) as error:
        raise InputError("periods: must be a list of numbers above 0 [s]") from error
    if values.ndim != 1:
        raise InputError(f"periods: must be a list of numbers [s], not of shape {values.shape}")
    return values


def spectral_acceleration(
    acceleration: Samples, dt: float, periods: npt.ArrayLike, damping: float = 0.05
) -> npt.NDArray[np.float64]:
    """Return the pseudo-spectral acceleration ω² max|u|.

    Parameters
    ----------
    acceleration : ndarray, shape (npts,)
        Ground acceleration [m/s²].
    dt : float
        Sampling interval [s].
    periods : array_like, shape (n,)
        Undamped periods [s], above 0.
    damping : float
        Fraction of critical damping ζ, 0 ≤ ζ < 1.

    Returns
    -------
    ndarray, shape (n,)
        In m/s², the largest value at the samples, up to the last. For periods with fewer than 20 samples the record is
        interpolated linearly.

    Raises
    ------
    InputError
        For periods and damping out of range.
    """
    periods = as_periods(periods)
    peaks = np.empty(len(periods))
    for among, finer, step in _refined(acceleration, dt, periods, damping):
        peaks[among] = _peaks(finer, step, 2.0 * math.pi / periods[among], damping)
    return peaks


def responses(acceleration: Samples, dt: float, periods: npt.ArrayLike, damping: float = 0.05) -> list[Samples]:
    """Return the history ω² u(t) [m/s²] of an oscillator of each period; its peak is the :func:`spectral_acceleration`.

    Its sampling interval is ``dt``, for periods below 20 ``dt`` halved until it is a twentieth of the period or less.
    """
    periods = as_periods(periods)
    by_place: dict[int, Samples] = {}
    for among, finer, step in _refined(acceleration, dt, periods, damping):
        places = np.flatnonzero(among)
        for block in np.array_split(places, -(-len(places) // _TOGETHER)):
            omega = 2.0 * math.pi / periods[block]
            blocks = np.stack(list(_march(finer, step, omega, damping, whole=True)), axis=1)
            histories = blocks.reshape(-1, len(block))[: len(finer)] * (omega / math.sqrt(1.0 - damping**2))
            by_place |= zip(map(int, block), np.ascontiguousarray(histories.T), strict=True)
    return [by_place[i] for i in range(len(periods))]


def _refined(
    acceleration: Samples, dt: float, periods: npt.NDArray[np.float64], damping: float
) -> Iterator[tuple[npt.NDArray[np.bool_], Samples, float]]:
    """Yield a mask of periods, and for these the acceleration refined to 20 samples a period at least, and its dt [s]."""
    wrong = [f"period = {period:g}: must be a number above 0 [s]" for period in periods if not 0 < period < math.inf]
    if not 0 <= damping < 1:
        wrong.append(f"damping = {damping:g}: must be within 0 ≤ damping < 1")
    refuse(wrong)
    parts = np.ones(len(periods), dtype=int)
    while (few := periods < _PER_PERIOD * dt / parts * (1 - 1e-9)).any():
        parts[few] *= 2
    for count in np.unique(parts):
        finer = acceleration
        if count > 1:
            positions = np.arange((len(acceleration) - 1) * count + 1) / count
            finer = np.interp(positions, np.arange(len(acceleration)), acceleration)
        yield parts == count, finer, dt / count


def periods_over(low: float, high: float) -> npt.NDArray[np.float64]:
    """Return all ``PERIODS``, extended at fifty a decade as far as needed to reach from ``low`` to ``high`` [s]."""
    below = max(0, math.ceil(50 * math.log10(PERIODS[0] / low) - 1e-9))
    above = max(0, math.ceil(50 * math.log10(high / PERIODS[-1]) - 1e-9))
    return np.asarray(PERIODS[0] * 10.0 ** (np.arange(-below, len(PERIODS) + above) / 50.0), dtype=np.float64)


def _peaks(a: Samples, dt: float, omega: npt.NDArray[np.float64], damping: float) -> npt.NDArray[np.float64]:
    """Return ω² max|u| at the samples, shape (n,), of oscillators of ``omega`` [rad/s], shape (n,)."""
    largest = np.zeros(len(omega))
    for u in _march(a, dt, omega, damping):
        np.maximum(largest, np.abs(u, out=u).max(axis=0, initial=0.0), out=largest)
    return largest * omega**2 / (omega * math.sqrt(1.0 - damping**2))


def _march(
    a: Samples, dt: float, omega: npt.NDArray[np.float64], damping: float, whole: bool = False
) -> Iterator[npt.NDArray[np.float64]]:
    """Yield ω_d u at the k-th sample of every block, shape (blocks, n), for k from 0 on.

    The last block ends with the last sample, or goes on over zeros if ``whole``. With w = z + c₁a the recursion has one load
    term, w(t + Δ) = λ w(t) − (c₀ + λc₁) a(t). First the state at the start of each block is found, then all blocks advance
    side by side.
    """
    omega_d = omega * math.sqrt(1.0 - damping**2)
    s = -damping * omega + 1j * omega_d
    growth = np.expm1(s * dt)
    factor = growth + 1.0
    c1 = (growth - s * dt) / (s**2 * dt)  # cancellation grows as (sΔ)⁻²: ten of sixteen digits are left at T = 6000 Δ
    load = growth / s - c1 + factor * c1

    blocks = -(-len(a) // _BLOCK)
    in_last = len(a) - (blocks - 1) * _BLOCK
    loads = np.pad(a, (0, _BLOCK - in_last)).reshape(blocks, _BLOCK)
    carried = loads @ factor ** np.arange(_BLOCK - 1, -1, -1)[:, None]
    state = np.empty((blocks, len(omega)), dtype=np.complex128)  # −w/(c₀ + λc₁)
    state[0] = -c1 * a[0] / load  # z = 0
    for block in range(1, blocks):
        state[block] = carried[block - 1] + factor**_BLOCK * state[block - 1]

    for k in range(_BLOCK):
        if k == in_last and not whole:
            state, loads = state[:-1], loads[:-1]
        yield load.imag * state.real + load.real * state.imag + c1.imag * loads[:, k, None]
        state = factor * state + loads[:, k, None]
