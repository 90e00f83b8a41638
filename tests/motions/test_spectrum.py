"""Spectral accelerations at both ends of the periods."""

import math

import numpy as np
import pytest

import rockbatch as rb
from rockbatch.common.errors import InputError
from rockbatch.motions.intensity.measures import pgd
from rockbatch.motions.spectrum import spectral_acceleration


def test_a_stiff_oscillator_feels_ground_acceleration_and_a_soft_one_displacement():
    """An undamped oscillator overshoots a slow change by nothing: T is 1/1000 of the pulse's period, then 1000 times it."""
    motion = rb.pulse("sine", name="one-sine", amplitude=3.0, period=1.0, dt=0.01, duration=2.0)
    stiff, soft = spectral_acceleration(motion.horizontal, 0.01, [0.001, 1000.0], damping=0.0)
    assert stiff == pytest.approx(3.0, rel=1e-3)
    assert soft == pytest.approx((2 * math.pi / 1000) ** 2 * pgd(motion.horizontal, 0.01), rel=1e-3)


def test_a_period_or_damping_out_of_range_is_refused():
    with pytest.raises(InputError, match="period = 0: must be a number above 0") as caught:
        spectral_acceleration(np.ones(3), 0.01, [0.0], damping=1.0)
    assert "damping = 1: must be within 0" in str(caught.value)
