"""Half cycles of rocking on springs, from the rows of a history in closed form."""

import math

import numpy as np
import pytest

from rockbatch.outcome.half_cycles import Path, _peak, half_cycles


def test_an_oscillation_passes_upright_and_turns_where_its_cosine_does():
    """θ = A e^(−λt) cos ωt at rows of different distances, up to ω h = 0.4: a cubic errs by (ω h)⁴/384."""
    decay, omega = 0.3, 2.0
    t = np.cumsum(np.random.default_rng(1).uniform(0.05, 0.2, 60))
    theta = 0.02 * np.exp(-decay * t) * np.cos(omega * t)
    rate = -decay * theta - 0.02 * omega * np.exp(-decay * t) * np.sin(omega * t)
    found = half_cycles(Path(t, theta, rate), None)
    upright = np.arange(0.5 * math.pi, omega * t[-1], math.pi) / omega
    turns = (np.arange(math.pi, omega * t[-1], math.pi) - math.atan(decay / omega)) / omega
    assert found.t[1:] == pytest.approx(upright, abs=1e-4)
    speeds = 0.02 * omega * np.exp(-decay * upright)
    for side in (found.omega_before, found.omega_after):
        assert np.abs(side[1:]) == pytest.approx(speeds, rel=1e-3)
        assert (np.sign(side[1:]) == -np.sign(np.cos(omega * upright - 0.5 * math.pi))).all()
    count = len(turns)
    assert found.t_amplitude[1 : count + 1] == pytest.approx(turns, abs=1e-3)
    heights = 0.02 * np.exp(-decay * turns) * math.cos(math.atan(decay / omega))
    assert found.amplitude[1 : count + 1] == pytest.approx(heights, rel=2e-4)


@pytest.mark.parametrize("before", [0.1, 0.4])
def test_between_two_rows_it_turns_where_their_cubic_does_and_without_a_turn_nowhere(before):
    """θ = cos t, by rows that are 0.5 apart, of which the first two are on both sides of the top."""
    t = np.array([0.0, 0.5, 1.0]) - before
    path = Path(t, np.cos(t), -np.sin(t))
    assert _peak(path, 0, 3) == (pytest.approx(1.0, abs=2e-4), pytest.approx(0.0, abs=2e-3))
    assert _peak(path, 0, 2) == _peak(path, 0, 3)
    assert np.isnan(_peak(path, 1, 3)).all()
    at_rest = Path(t + before, np.cos(t + before), -np.sin(t + before))
    assert _peak(at_rest, 0, 3) == (1.0, 0.0)
