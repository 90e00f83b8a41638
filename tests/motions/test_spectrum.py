"""Spectral accelerations: against another integration, and at both ends of the periods."""

import itertools
import math

import numpy as np
import pytest

import rockbatch as rb
from rockbatch.common.errors import InputError
from rockbatch.motions.measures import pgd
from rockbatch.motions.spectrum import spectral_acceleration


def oscillator(acceleration, dt, period, damping):
    """u'' + 2ζω u' + ω² u = −a by the trapezoidal rule with 40 steps per sample."""
    omega = 2 * math.pi / period
    fine = np.interp(np.arange(0, len(acceleration) - 1, 1 / 40), np.arange(len(acceleration)), acceleration)
    h = dt / 40
    step = np.array([[0, 1], [-(omega**2), -2 * damping * omega]])
    forward = np.linalg.inv(np.eye(2) - h / 2 * step)
    state, most = np.zeros(2), 0.0
    for a, b in itertools.pairwise(fine):
        state = forward @ ((np.eye(2) + h / 2 * step) @ state + np.array([0, -h * (a + b) / 2]))
        most = max(most, abs(state[0]))
    return omega**2 * most


@pytest.mark.parametrize("period", [0.05, 0.4, 2.0])
def test_spectral_acceleration_is_that_of_an_oscillator_integrated_otherwise(period):
    """A peak between samples Δ apart is missed by up to (πΔ/T)²/2, of which there are 20 a period at least; the
    trapezoidal rule is off by less than 1e-3."""
    motion = np.concatenate((np.random.default_rng(1).normal(0, 1, 200), np.zeros(300)))
    found = spectral_acceleration(motion, 0.01, [period])[0]
    missed = (math.pi * min(0.01 / period, 1 / 20)) ** 2 / 2
    assert found == pytest.approx(oscillator(motion, 0.01, period, 0.05), rel=missed + 1e-3)


def test_a_stiff_oscillator_feels_the_peak_of_the_ground_and_a_soft_one_its_displacement():
    """An undamped oscillator overshoots a slow change by nothing: T is 1/1000 of the pulse's period, then 1000 times it."""
    motion = rb.pulse("sine", name="one-sine", amplitude=3.0, period=1.0, dt=0.01, duration=2.0)
    stiff, soft = spectral_acceleration(motion.horizontal, 0.01, [0.001, 1000.0], damping=0.0)
    assert stiff == pytest.approx(3.0, rel=1e-3)
    assert soft == pytest.approx((2 * math.pi / 1000) ** 2 * pgd(motion.horizontal, 0.01), rel=1e-3)


def test_a_period_or_damping_out_of_range_is_refused():
    with pytest.raises(InputError, match="period = 0: must be a number above 0") as caught:
        spectral_acceleration(np.ones(3), 0.01, [0.0], damping=1.0)
    assert "damping = 1: must be within 0" in str(caught.value)
