"""Elastic response spectra of an acceleration that is linear between its samples.

The damped oscillator ü + 2ζω u̇ + ω² u = −a(t) has the characteristic roots s and s̄, s = −ζω + iω_d. With
z = u̇ − s̄u it is one complex equation, ż = sz − a(t), and u = Im z/ω_d. Over a sampling interval Δ in which a is
linear its solution is exact (Nigam & Jennings 1969, BSSA 59(2), 909–922, in complex form):

    z(t + Δ) = λ z(t) − c₀ a(t) − c₁ a(t + Δ),   λ = exp(sΔ),
    c₀ + c₁ = (λ − 1)/s,                         c₁ = (λ − 1 − sΔ)/(s²Δ).
"""

import math

import numpy as np
import numpy.typing as npt

from rockbatch.errors import InputError

Samples = npt.NDArray[np.float64]

PERIODS = np.geomspace(0.05, 5.0, 101)
"""Periods of a suite's spectra [s]: fifty a decade: a curve through them has no corners that are not its own."""

_BLOCK = 64  # samples that are gone through one after the other; the blocks side by side
_PER_PERIOD = 20  # samples a period at least, so that a peak between them is missed by less than 1.3 %


def spectral_acceleration(
    acceleration: Samples, dt: float, periods: npt.ArrayLike, damping: float = 0.05
) -> npt.NDArray[np.float64]:
    """Pseudo-spectral acceleration ω² max|u|.

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
        In m/s², the largest value until the last sample. Periods with fewer than 20 samples are given more of them,
        on the straight lines between the record's.

    Raises
    ------
    InputError
        For periods and damping that are out of range.
    """
    periods = np.asarray(periods, dtype=np.float64)
    wrong = [f"period = {period:g}: must be a number above 0 [s]" for period in periods if not 0 < period < math.inf]
    if not 0 <= damping < 1:
        wrong.append(f"damping = {damping:g}: must be within 0 ≤ damping < 1")
    if wrong:
        raise InputError(*wrong)
    parts = np.ones(len(periods), dtype=int)
    while (few := periods < _PER_PERIOD * dt / parts * (1 - 1e-9)).any():
        parts[few] *= 2
    peaks = np.empty(len(periods))
    for count in np.unique(parts):
        among = parts == count
        finer = acceleration
        if count > 1:
            at = np.arange((len(acceleration) - 1) * count + 1) / count
            finer = np.interp(at, np.arange(len(acceleration)), acceleration)
        peaks[among] = _peaks(finer, dt / count, 2.0 * math.pi / periods[among], damping)
    return peaks


def periods_over(low: float, high: float) -> npt.NDArray[np.float64]:
    """``PERIODS``, and as many a decade beyond them as it takes to reach from ``low`` to ``high`` [s]."""
    before = max(0, math.ceil(50 * math.log10(PERIODS[0] / low) - 1e-9))
    after = max(0, math.ceil(50 * math.log10(high / PERIODS[-1]) - 1e-9))
    return np.asarray(PERIODS[0] * 10.0 ** (np.arange(-before, len(PERIODS) + after) / 50.0), dtype=np.float64)


def _peaks(a: Samples, dt: float, omega: npt.NDArray[np.float64], damping: float) -> npt.NDArray[np.float64]:
    """ω² max|u| at the samples, shape (n,), of oscillators of ``omega`` [rad/s], shape (n,).

    With w = z + c₁a the recursion has one term of load, w(t + Δ) = λ w(t) − (c₀ + λc₁) a(t). It is gone through in
    blocks side by side: first what each block leaves to the next, then every block from there.
    """
    omega_d = omega * math.sqrt(1.0 - damping**2)
    s = -damping * omega + 1j * omega_d
    growth = np.expm1(s * dt)
    factor = growth + 1.0
    c1 = (growth - s * dt) / (s**2 * dt)  # loses digits as (sΔ)⁻²: ten of sixteen are left at T = 6000 Δ
    load = growth / s - c1 + factor * c1

    blocks = -(-len(a) // _BLOCK)
    in_last = len(a) - (blocks - 1) * _BLOCK
    loads = np.pad(a, (0, _BLOCK - in_last)).reshape(blocks, _BLOCK)
    left = loads @ factor ** np.arange(_BLOCK - 1, -1, -1)[:, None]
    state = np.empty((blocks, len(omega)), dtype=np.complex128)  # −w/(c₀ + λc₁)
    state[0] = -c1 * a[0] / load  # z = 0
    for block in range(1, blocks):
        state[block] = left[block - 1] + factor**_BLOCK * state[block - 1]

    largest = np.zeros(len(omega))
    for k in range(_BLOCK):
        if k == in_last:
            state, loads = state[:-1], loads[:-1]
        u = load.imag * state.real + load.real * state.imag + c1.imag * loads[:, k, None]
        np.maximum(largest, np.abs(u, out=u).max(axis=0, initial=0.0), out=largest)
        state = factor * state + loads[:, k, None]
    return largest * omega**2 / omega_d
