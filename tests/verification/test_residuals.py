"""Residual tilt and settlement are those of a pier at rest, whenever its record ends: it may rock on long after that."""

import numpy as np
import pytest
from core_samples import FIG5, pulse
from reference_solver import reference

from rockbatch.motions.motion import Motion
from rockbatch.pier import Pier, YieldingBase
from rockbatch.simulation import run_to_tolerance

TOWER = Pier(alpha=0.26, p=0.47)
DT, TAIL = 0.005, 200.0


def random_case(seed: int) -> tuple[YieldingBase, Motion, Motion]:
    """Return pads, and a burst of 3 cycles, half a second and :data:`TAIL` longer."""
    random = np.random.default_rng(seed)
    law = ("epp", "hardening")[seed % 2]
    base = YieldingBase(random.uniform(60.0, 90.0), zeta=0.05, eta=random.uniform(1.2, 2.7), spring=law)
    peak, period = random.uniform(2.0, 8.0), random.uniform(0.4, 1.5)
    t = np.arange(0.0, 3.0 * period, DT)
    burst = peak * np.sin(2.0 * np.pi * t / period) * np.hanning(len(t))
    short, long = (
        Motion(f"burst {seed}", DT, np.concatenate([burst, np.zeros(int(tail / DT))]), None) for tail in (0.5, TAIL)
    )
    return base, short, long


def check(seeds: range) -> None:
    """Hold what is read behind a short record against a long one: 1e-6 α beyond the errors stated, and 1e-9 m.

    Seven of ten piers at least stay upright, and one at least rocks on for more than 10 s.
    """
    waits = []
    for seed in seeds:
        base, *motions = random_case(seed)
        early, late = (run_to_tolerance(TOWER, base, motion, 1e-4 * TOWER.alpha) for motion in motions)
        if (early.status, late.status) != ("ok", "ok"):
            continue
        waits.append(early.t_read - motions[0].duration)
        error = early.theta_res_error + late.theta_res_error
        assert abs(early.theta_res - late.theta_res) < error + 1e-6 * TOWER.alpha, seed
        assert early.settlement == pytest.approx(late.settlement, abs=1e-9), seed
    assert len(waits) >= 0.7 * len(seeds)
    assert max(waits) > 10.0


def test_residuals_do_not_depend_on_the_end_of_the_record():
    check(range(10))


@pytest.mark.slow
def test_residuals_of_many_bursts_do_not_depend_on_the_end_of_the_record():
    check(range(10, 100))


@pytest.mark.slow
@pytest.mark.parametrize("law", ["epp", pytest.param("hardening", marks=pytest.mark.thorough)])
@pytest.mark.parametrize("period", [0.5, pytest.param(0.8, marks=pytest.mark.thorough)])
def test_residuals_are_where_the_reference_comes_to_rest(law, period):
    base = YieldingBase(50.0, zeta=0.1, eta=2.0, spring=law)
    motion = pulse("sine", period, dt=0.01, end=2.0)
    outcome = run_to_tolerance(FIG5, base, motion, 1e-7)
    true = reference(FIG5, base, motion, quiet_s=60.0)
    start = reference(FIG5, base, Motion("still", 0.01, np.zeros(2)))
    assert (outcome.status, true.status) == ("ok", "ok")
    assert outcome.t_read > 10.0
    assert outcome.base_tilt == pytest.approx(0.5 * (true.base_left - true.base_right) / FIG5.half_width, abs=1e-8)
    sunk = start.base_left - 0.5 * (true.base_left + true.base_right)
    assert outcome.settlement == pytest.approx(sunk, abs=1e-8)
