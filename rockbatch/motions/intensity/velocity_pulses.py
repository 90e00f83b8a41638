"""Pulse-like records: the wavelet criterion of Baker (2007) for one horizontal component.

Baker, J. W. (2007). Quantitative classification of near-fault ground motions using wavelet analysis. BSSA 97(5), 1486–1501.
The largest coefficient of the continuous transform of the ground velocity with the Daubechies wavelet of order 4 gives period
and time of the pulse. The pulse is the sum of ten such wavelets of that period, each the largest of the remainder near that
time. With the residual's peak and energy over the record's,

    PI = 1/(1 + exp(−23.3 + 14.6 (PGV ratio) + 20.5 (energy ratio))),

a record is pulse-like if PI > 0.85, PGV is 0.3 m/s or more and the pulse arrives early: 10 % of its ∫v² dt before 20 % of the
record's."""

import math
from functools import cache

import numpy as np

from rockbatch.motions.alignment import places_of_energy
from rockbatch.motions.intensity.measures import velocity
from rockbatch.motions.motion import Motion, Samples

PERIODS_OF_PULSES = (0.25, 15.0)
"""Shortest and longest pulse period that is tried [s]."""

LEAST_PGV = 0.30
"""Least PGV of a pulse-like record [m/s]."""

PULSE_LIKE = 0.85
"""Indicator PI beyond which a record is pulse-like."""

_PSEUDO_PERIOD = 1.4  # scales: 1 over the central frequency of the wavelet
_SUPPORT = 7.0  # scales
_WAVELETS = 10
_NEAR = 0.4  # scales about the first wavelet, as in the authors' program of 2014; the paper's own figure is not at hand
_SCALES, _BETWEEN = 50, 41  # over all periods, and about the best of them
_HALVINGS = 9  # of the unit grid on which the wavelet is tabulated


def pulse_period(motion: Motion) -> float | None:
    """Return the period [s] of the pulse in the horizontal component over ``factor``, as recorded; None if not pulse-like."""
    return period_of_pulse(velocity(motion.horizontal, motion.dt, motion.initial) / motion.factor, motion.dt)


def period_of_pulse(v: Samples, dt: float) -> float | None:
    """Return the period [s] of the pulse in a ground velocity [m/s], sampled every ``dt`` [s]; None if it is not pulse-like."""
    if float(np.abs(v).max()) < LEAST_PGV:
        return None
    scale, place = _largest(v, dt)
    pulse = _wavelet_sum(v, scale, place)
    is_early = bool(places_of_energy(pulse, [0.10]) < places_of_energy(v, [0.20]))
    return _PSEUDO_PERIOD * scale * dt if is_early and _indicator(v, pulse) > PULSE_LIKE else None


def _indicator(v: Samples, pulse: Samples) -> float:
    """Return the pulse indicator PI, 0 to 1, of a velocity with this pulse."""
    residual = v - pulse
    peak, energy = np.abs(residual).max() / np.abs(v).max(), residual @ residual / (v @ v)
    return 1.0 / (1.0 + math.exp(-23.3 + 14.6 * float(peak) + 20.5 * float(energy)))


def _largest(v: Samples, dt: float) -> tuple[float, int]:
    """Return scale [samples] and index of the largest coefficient, over all scales first, then around the best of them."""
    shortest, longest = (period / _PSEUDO_PERIOD / dt for period in PERIODS_OF_PULSES)
    scales = np.geomspace(shortest, longest, _SCALES)
    transform = _Transform(v, longest)
    peaks = [transform.largest(scale) for scale in scales]
    best = int(np.argmax([height for height, _ in peaks]))
    about = np.linspace(scales[max(best - 1, 0)], scales[min(best + 1, _SCALES - 1)], _BETWEEN)
    (_, place), scale = max(((transform.largest(scale), scale) for scale in about), key=lambda pair: pair[0][0])
    return float(scale), place


def _wavelet_sum(v: Samples, scale: float, place: int) -> Samples:
    """Return the pulse, shape (npts,): ten wavelets of one scale, each the largest of the remainder near index ``place``."""
    near = math.ceil(_NEAR * scale)
    window = slice(max(place - near, 0), place + near + 1)
    wavelet = _wavelet(scale)
    half, norm = len(wavelet) // 2, wavelet @ wavelet
    pulse = np.zeros(len(v) + 2 * half)
    inside = pulse[half : half + len(v)]
    for _ in range(_WAVELETS):
        coefficients = _Transform(v - inside, scale).coefficients(scale)[window]
        k = int(np.argmax(np.abs(coefficients)))
        first = window.start + k
        pulse[first : first + len(wavelet)] += coefficients[k] / norm * wavelet
    return inside


class _Transform:
    """Continuous wavelet transform of a signal at its samples, by Fourier transforms."""

    def __init__(self, signal: Samples, largest_scale: float) -> None:
        self.length = len(signal)
        self.padded = 1 << (self.length + len(_wavelet(largest_scale)) - 1).bit_length()
        self.spectrum = np.fft.rfft(signal, self.padded)

    def coefficients(self, scale: float) -> Samples:
        """Return the coefficients, shape (npts,), of wavelets of a scale [samples] centred on each sample."""
        wavelet = _wavelet(scale)
        product = self.spectrum * np.conj(np.fft.rfft(wavelet, self.padded))
        return np.roll(np.fft.irfft(product, self.padded), len(wavelet) // 2)[: self.length]

    def largest(self, scale: float) -> tuple[float, int]:
        """Return the largest absolute coefficient of a scale, and its index."""
        coefficients = np.abs(self.coefficients(scale))
        place = int(np.argmax(coefficients))
        return float(coefficients[place]), place


def _wavelet(scale: float) -> Samples:
    """Return the wavelet of a scale [samples], at an odd number of samples centred on the middle of its support."""
    half = math.ceil(0.5 * _SUPPORT * scale)
    x, psi = _daubechies()
    places = np.arange(-half, half + 1) / scale + 0.5 * _SUPPORT
    return np.asarray(np.interp(places, x, psi, left=0.0, right=0.0) / math.sqrt(scale))


@cache
def _daubechies() -> tuple[Samples, Samples]:
    """Return the Daubechies wavelet of order 4, ∫ψ² dx = 1, tabulated on its support 0..7.

    The scaling function φ(x) = √2 Σ h_k φ(2x − k) is known at the whole numbers as an eigenvector, and with every use of that
    equation on a grid of half the step; then ψ(x) = √2 Σ (−1)^k h_{7−k} φ(2x − k) (Daubechies 1992, 5.1 and 6.5).
    """
    h = _filter()
    n = len(h)
    at_whole = np.array([[h[2 * i - j] if 0 <= 2 * i - j < n else 0.0 for j in range(n)] for i in range(n)])
    values, vectors = np.linalg.eig(math.sqrt(2.0) * at_whole)
    phi = np.real(vectors[:, np.argmin(np.abs(values - 1.0))])
    phi /= phi.sum()
    for halving in range(_HALVINGS):
        phi = _on_finer_grid(h, phi, 1 << halving)
    mirrored = h[::-1] * (-1.0) ** np.arange(n)
    psi = _on_finer_grid(mirrored, phi, 1 << _HALVINGS)
    return np.arange(len(psi)) / (1 << (_HALVINGS + 1)), psi


def _on_finer_grid(coefficients: Samples, phi: Samples, per_unit: int) -> Samples:
    """Return √2 Σ c_k φ(2x − k) on a grid of half the step of φ, which has ``per_unit`` steps per unit of x."""
    finer = np.zeros(2 * len(phi) - 1)
    for k, coefficient in enumerate(coefficients):
        finer[k * per_unit : k * per_unit + len(phi)] += math.sqrt(2.0) * coefficient * phi
    return finer


def _filter() -> Samples:
    """Return the low-pass filter with four vanishing moments, shape (8,): the minimum-phase factor (Daubechies 1992, 6.1)."""
    order = 4
    y = np.roots([math.comb(order - 1 + k, k) for k in reversed(range(order))])
    pairs = [np.roots([1.0, 4.0 * root - 2.0, 1.0]) for root in y]
    inner = [root for pair in pairs for root in pair if abs(root) < 1.0]
    h = np.real(np.poly([*([-1.0] * order), *inner]))
    return np.asarray(h / h.sum() * math.sqrt(2.0))
