"""Peak ground velocity and displacement are exact integrals of the piecewise linear acceleration."""

import numpy as np
import pytest

from rockbatch.motions import measures


def test_constant_acceleration_gives_a_t_and_half_a_t_squared():
    a = np.full(101, 2.0)
    t = np.arange(101) * 0.01
    np.testing.assert_allclose(measures.velocity(a, 0.01), 2 * t, atol=1e-14)
    np.testing.assert_allclose(measures.displacement(a, 0.01), t**2, atol=1e-14)


def test_a_ramp_is_integrated_exactly_however_coarse_the_samples():
    for dt in (0.5, 0.1):
        t = np.arange(round(2 / dt) + 1) * dt
        np.testing.assert_allclose(measures.velocity(t, dt), t**2 / 2, atol=1e-14)
        np.testing.assert_allclose(measures.displacement(t, dt), t**3 / 6, atol=1e-14)


def test_samples_put_between_change_nothing():
    a = np.random.default_rng(5).normal(size=300)
    fine = np.interp(np.arange(299 * 7 + 1) / 7, np.arange(300), a)
    # the same polynomial, added up in another order: rounding of 2000 terms
    np.testing.assert_allclose(measures.displacement(fine, 0.02 / 7)[::7], measures.displacement(a, 0.02), atol=1e-12)


def test_peaks_are_absolute_values():
    a = np.array([0.0, -3.0, 0.0])
    assert measures.pga(a) == 3.0
    assert measures.pgv(a, 1.0) == 3.0
    assert measures.pgd(a, 1.0) == pytest.approx(3.0 / 6.0 + 3.0 - 3.0 / 6.0)


def test_a_baseline_is_left_alone():
    a = np.full(11, 0.1)
    assert measures.pgv(a, 1.0) == pytest.approx(1.0)
