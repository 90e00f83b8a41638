"""The example of code estimates: its formulas, and the peaks beside them."""

import importlib
from pathlib import Path

import numpy as np
import pytest

from rockbatch.motions import pulse
from rockbatch.motions.spectrum import spectral_acceleration
from rockbatch.pier import Pier

CONFIGS = Path(__file__).parents[2] / "configs"


@pytest.fixture
def estimates(monkeypatch):
    """Imports the script as one beside it does."""
    monkeypatch.syspath_prepend(str(CONFIGS))
    return importlib.import_module("code_estimates")


def test_the_period_of_free_rocking_is_housners(estimates):
    """Four quarters of θ̈ = p²(θ − α) from rest at φα: 1 − (1 − φ) cosh pt = 0."""
    for share in (0.01, 0.3, 0.9):
        quarter = estimates.rocking_period(share, 0.5) / 4
        assert (1 - share) * np.cosh(0.5 * quarter) == pytest.approx(1.0)


def test_the_damping_of_priestley_is_that_of_the_decay_of_free_rocking(estimates):
    """After n impacts φ_n = 1 − √(1 − rⁿ (1 − (1 − φ0)²)) (Housner 1963); a cycle has two: ζ = ln(φ0/φ_n)/(π n)."""
    damping = estimates.DAMPING
    for alpha in (0.1, 0.15, 0.2):
        restitution = Pier(alpha=alpha, p=1.0).restitution
        r = restitution**2
        for start in (0.1, 0.15, 0.2):
            left = 1 - np.sqrt(1 - r**4 * (1 - (1 - start) ** 2))
            # 0.34 is a fit; it grows with the amplitude, to 0.46 at φ0 = 0.5
            assert damping["priestley"](restitution) == pytest.approx(np.log(start / left) / (np.pi * 4), rel=0.05)
        assert damping["fema_356"](restitution) == pytest.approx(0.4 * (1 - np.sqrt(r)))


def test_the_estimates_end_at_a_fixed_point_or_say_why_not(estimates):
    assert estimates.fixed_point(lambda share: 0.1 + 0.5 * share) == pytest.approx(0.2, rel=1e-3)
    assert estimates.fixed_point(lambda share: 0.1 * share) == 0.0
    assert estimates.fixed_point(lambda share: 2.0 * share) == np.inf
    assert np.isnan(estimates.fixed_point(lambda share: 0.7 - share))  # goes to and fro between START and 0.2


def test_an_estimate_is_zero_below_uplift_and_a_fixed_point_of_the_spectrum_above(estimates):
    pier = Pier(alpha=0.2, p=1.0)
    weak, strong = (
        pulse("sine", name="p", amplitude=share * 9.81 * np.tan(0.2), period=0.8, dt=0.01, duration=3.0)
        for share in (0.99, 1.6)
    )
    assert estimates.estimate(pier, weak, "priestley") == 0.0
    share = estimates.estimate(pier, strong, "priestley")
    assert 0.0 < share < 1.0
    period, damping = estimates.rocking_period(share, pier.p), estimates.DAMPING["priestley"](pier.restitution)
    (sa,) = spectral_acceleration(strong.horizontal, strong.dt, [period], damping)
    assert sa * (period / 2 / np.pi) ** 2 / pier.size / pier.alpha == pytest.approx(share, rel=1e-3)
