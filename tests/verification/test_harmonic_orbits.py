"""A slender block on a rigid base under harmonic shaking: its steady orbit, in closed form.

Spanos & Koh (1984) and Hogan (1989) follow the orbit that lands once in every half period. With time in 1/p, x = θ/α,
Ω = ω/p, A = a/(g tan α) and D = A/(1 + Ω²) the block obeys x″ = x − 1 − A sin(Ωτ + φ) between landings at τ = 0 and
S = π/Ω, so x = 1 + a cosh τ + b sinh τ + D sin(Ωτ + φ). The next half period is the mirror image of this one if
x(0) = x(S) = 0 and x′(0) = −e x′(S), which leaves, with T = tanh(S/2) and k = (1 + e)/((1 − e) Ω T),

    a = −1 − D sin φ,  b = T + D sin φ/T,  cos φ = −T/(ΩD) − k sin φ

and sin² φ + cos² φ = 1 is a quadratic equation. It has roots from A = (1 + Ω²) T/(Ω √(1 + k²)) on, well below 1: the block
must be set rocking first.
"""

import math

import numpy as np
import pytest
from scipy.interpolate import CubicHermiteSpline
from scipy.optimize import brentq

import rockbatch as rb

SLENDER = 1e-4
RAMP, PERIODS = 25, 150
"""Periods in which the shaking grows to its amplitude, lest it throw the block over, and all periods: what is not of the orbit
falls by e each half period."""


def least_amplitude(w: float, e: float) -> float:
    """Return the least A for which there is an orbit."""
    tanh = math.tanh(math.pi / w / 2.0)
    return (1.0 + w * w) * tanh / (w * math.hypot(1.0, (1.0 + e) / ((1.0 - e) * w * tanh)))


def orbit_peak(w: float, amplitude: float, e: float) -> float:
    """Return the greatest x of the orbit; the other root of the quadratic equation has x < 0."""
    half = math.pi / w
    tanh, forced = math.tanh(half / 2.0), amplitude / (1.0 + w * w)
    k, c = (1.0 + e) / ((1.0 - e) * w * tanh), tanh / (w * forced)
    for sine in np.roots([1.0 + k * k, 2.0 * k * c, c * c - 1.0]):
        a, b, phase = -1.0 - forced * sine, tanh + forced * sine / tanh, math.atan2(sine, -c - k * sine)

        def rate(t: float, a: float = a, b: float = b, phase: float = phase) -> float:
            return a * math.sinh(t) + b * math.cosh(t) + forced * w * math.cos(w * t + phase)

        if rate(0.0) > 0.0 > rate(half):
            t = brentq(rate, 0.0, half)
            return 1.0 + a * math.cosh(t) + b * math.sinh(t) + forced * math.sin(w * t + phase)
    raise ValueError("no such orbit")


def computed_peaks(w: float, amplitude: float, e: float, samples: int) -> list[float]:
    """Return the peaks |θ|/α of the last four half periods, with ``samples`` of the shaking in a period."""
    pier = rb.Pier(SLENDER, 1.0)
    period = 2.0 * math.pi / w
    t = np.arange(PERIODS * samples + 1) * period / samples
    shaking = amplitude * pier.gravity * math.tan(SLENDER) * np.sin(w * t) * np.minimum(t / (RAMP * period), 1.0)
    run = rb.simulate(pier, rb.RigidBase(e), rb.Motion("harmonic", t[1], shaking), substeps=1, quiet_s=0.0, wait=False)
    rows = run.history[run.t > (PERIODS - 3) * period]
    t, first = np.unique(rows.t, return_index=True)
    theta = CubicHermiteSpline(t, rows.theta.to_numpy()[first], rows.omega.to_numpy()[first])
    return [abs(float(theta(at))) / SLENDER for at in theta.derivative().roots(extrapolate=False)][-5:-1]


@pytest.mark.parametrize(
    ("w", "amplitude", "e", "peak"),
    [
        (4.0, 3.0, 0.90, 0.24778),
        (6.0, 4.0, 0.90, 0.14082),
        (8.0, 5.0, 0.92, 0.09565),
        (6.0, 3.0, 0.85, 0.11310),
        (3.0, 2.0, 0.90, 0.32133),
    ],
)
def test_harmonic_shaking_ends_in_the_steady_orbit_of_spanos_and_koh(w, amplitude, e, peak):
    """Four peaks in a row agree, on either side, and with the closed form.

    A sine that is linear between samples is off by dt², so that twice the samples leave a quarter; 2e-8 after
    extrapolation: α² = 10⁻⁸ and dt⁴.
    """
    exact = orbit_peak(w, amplitude, e)
    assert exact == pytest.approx(peak, abs=5e-6)
    coarse, fine = computed_peaks(w, amplitude, e, 200), computed_peaks(w, amplitude, e, 400)
    assert fine == pytest.approx([fine[0]] * 4, abs=1e-9)
    assert (coarse[0] - exact) / (fine[0] - exact) == pytest.approx(4.0, abs=0.05)
    assert fine[0] + (fine[0] - coarse[0]) / 3.0 == pytest.approx(exact, abs=2e-8)


@pytest.mark.parametrize(("w", "e"), [(3.0, 0.9), (4.0, 0.9), (6.0, 0.85)])
def test_weak_shaking_keeps_a_block_rocking_down_to_the_least_amplitude(w, e):
    """A = 2 sets it rocking; at 1.1 of the least one it goes on in the orbit, at 0.98 it comes to rest. 1e-3: by 200 samples."""
    pier, samples = rb.Pier(SLENDER, 1.0), 200
    t = np.arange(300 * samples + 1) * 2.0 * math.pi / w / samples
    last = []
    for share in (1.1, 0.98):
        amplitude = share * least_amplitude(w, e)
        assert amplitude < 0.25
        envelope = np.interp(t * w / (2.0 * math.pi), [0.0, 25.0, 50.0, 100.0], [0.0, 2.0, 2.0, amplitude])
        shaking = pier.gravity * math.tan(SLENDER) * envelope * np.sin(w * t)
        motion = rb.Motion("harmonic", t[1], shaking)
        run = rb.simulate(pier, rb.RigidBase(e), motion, substeps=1, quiet_s=0.0, wait=False)
        last.append(float(np.abs(run.theta[run.t > t[-5 * samples]]).max()) / SLENDER)
    assert last == [pytest.approx(orbit_peak(w, 1.1 * least_amplitude(w, e), e), rel=1e-3), 0.0]
