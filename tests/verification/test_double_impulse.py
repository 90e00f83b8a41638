"""The rigid block under a double impulse: the ground jumps to a velocity V, and back when the block lands.

Nabeshima, Taniguchi, Kojima & Takewaki (2016), Front. Built Environ. 2:9, doi 10.3389/fbuil.2016.00009, take it for a
near-fault pulse, because momentum and energy give the velocity that overturns the block in closed form. Derived here for
large rotations: a jump V of the ground changes θ̇ by V p² cos α/g, for it has the lever R0 cos α about the pivot and
(I0/M + R0²) p² = g R0. The second one, of the other sign, adds as much to e θ̇ just after the landing, and the block stays at
its unstable equilibrium if ½ θ̇² = p² (1 − cos α):

    V = (g/p) √(2 (1 − cos α))/((1 + e) cos α)
"""

import math

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import minimize_scalar

import rockbatch as rb
from rockbatch.simulation import run_fixed

BLOCKS = [(1e-3, 2.0), (0.1, 2.0), (0.2, 2.0), (math.atan(1 / 3), 1.0)]
"""α and p [rad/s]."""


def critical_velocity(pier: rb.Pier) -> float:
    """Return V [m/s] of the double impulse that just overturns the block."""
    top = 2.0 * math.sin(pier.alpha / 2)
    return pier.gravity / pier.p * top / ((1.0 + pier.restitution) * math.cos(pier.alpha))


def first_swing(pier: rb.Pier, velocity: float) -> float:
    """Return the time [s] from one jump of the ground to the landing: twice Housner's quarter period."""
    speed = velocity * pier.p * math.cos(pier.alpha) / pier.gravity
    top = pier.alpha - math.acos(math.cos(pier.alpha) + 0.5 * speed**2)

    def integrand(s: float) -> float:
        theta = top * (1.0 - s * s)
        gain = 2.0 * math.sin(pier.alpha - 0.5 * (theta + top)) * math.sin(0.5 * (top - theta))
        return 2.0 * top * s / math.sqrt(2.0 * gain)

    return 2.0 * quad(integrand, 0.0, 1.0, epsabs=1e-12, epsrel=1e-12)[0] / pier.p


def double_impulse(pier: rb.Pier, velocity: float, samples: int) -> rb.Motion:
    """Return two triangles of the area ``velocity`` over two samples each; the second begins when the block has landed."""
    dt = first_swing(pier, velocity) / samples
    acceleration = np.zeros(samples + 6)
    acceleration[[1, samples + 3]] = velocity / dt, -velocity / dt
    return rb.Motion("double impulse", dt, acceleration)


def overturns(pier: rb.Pier, motion: rb.Motion) -> bool:
    """Return whether the block overturns, on the rigid base with Housner's restitution."""
    outcome = run_fixed(pier, rb.RigidBase(), motion, 1, 0.0)
    assert outcome.status in ("ok", "overturned")
    return outcome.status == "overturned"


def bisected(overturned, low: float, high: float) -> float:
    """Return where ``overturned`` changes, to 1e-10."""
    assert (overturned(low), overturned(high)) == (False, True)
    while high - low > 1e-10 * high:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if overturned(middle) else (middle, high)
    return low


@pytest.mark.parametrize(("alpha", "p"), BLOCKS)
def test_double_impulse_overturns_at_the_closed_form(alpha, p):
    """Triangles become impulses as dt → 0: first order, then second, extrapolated; 1e-5 is left of the third."""
    pier = rb.Pier(alpha, p)
    exact = critical_velocity(pier)
    gaps = [
        bisected(lambda v, n=n: overturns(pier, double_impulse(pier, v, n)), 0.9 * exact, 1.1 * exact) / exact - 1.0
        for n in (200, 400, 800)
    ]
    assert gaps[0] / gaps[1] == pytest.approx(2.0, abs=0.05)
    assert gaps[1] / gaps[2] == pytest.approx(2.0, abs=0.03)
    first = 2.0 * gaps[1] - gaps[0], 2.0 * gaps[2] - gaps[1]
    assert (4.0 * first[1] - first[0]) / 3.0 == pytest.approx(0.0, abs=1e-5)


def test_velocity_of_overturning_grows_with_the_square_root_of_the_size():
    """The scale effect in the paper's abstract: V ∝ 1/p ∝ √R0."""
    small, large = (rb.Pier.from_size(0.2, size) for size in (2.0, 32.0))
    assert critical_velocity(large) / critical_velocity(small) == pytest.approx(4.0, rel=1e-12)


@pytest.mark.parametrize(("alpha", "p"), BLOCKS)
def test_equivalent_one_sine_overturns_when_magnified_by_the_published_factor(alpha, p):
    """ "About 1.53–1.54" (Nabeshima et al. 2016, by Fig. 9.11 of a later book's chapter); 1.533 to 1.541 here, rounded.

    The equivalent one-sine has the period 2 t0, t0 between the impulses, and the same greatest Fourier amplitude of its
    acceleration: 2 V = κ a/ω with κ = max 2 sin(πx)/(1 − x²) = 3.2728. So its peak velocity is 4 V/κ = 1.222 V.
    """
    kappa = -minimize_scalar(lambda x: -2.0 * math.sin(math.pi * x) / (1.0 - x * x), bounds=(0.6, 0.95)).fun
    assert 4.0 / kappa == pytest.approx(1.222, abs=5e-4)
    pier = rb.Pier(alpha, p)
    velocity = critical_velocity(pier)
    period = 2.0 * first_swing(pier, velocity)
    omega, t = 2.0 * math.pi / period, np.arange(801) * period / 800

    def overturned(factor: float) -> bool:
        shaking = factor * 2.0 * velocity * omega / kappa * np.sin(omega * t)
        return overturns(pier, rb.Motion("one-sine", t[1], shaking))

    assert 1.525 < bisected(overturned, 1.4, 1.7) < 1.545
