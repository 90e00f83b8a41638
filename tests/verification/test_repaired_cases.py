"""Cases that once came out wrong, with what independent solvers found to be true."""

from pathlib import Path

import numpy as np
import pytest

from rockbatch.motions.motion import Motion
from rockbatch.pier import Pier, RigidBase, YieldingBase
from rockbatch.simulation import run_fixed, run_to_tolerance

BOUNCE = (-0.34, -2.28, -0.72, 3.27, -4.17, -3.54, -2.82)
"""Horizontal acceleration [m/s²] every 0.02 s: the block bounces lower than a millionth of what follows in the same step."""

CHANCE = (
    -0.934683, 0.087772, -1.304720, 2.241867, -1.727344, -0.341460, 1.761562, 0.969533, 1.183520, -0.509516, 1.040084,
    1.092577, 1.597556, -0.444482, 0.806189, 1.382526, 0.170112, -0.704999, -1.891576, 1.295757, -1.158463,
    1.975992, -1.049430, 1.993167, -1.157913, -1.738440, 1.992521, 1.868081, 0.632761, -1.944916, 1.772503, -0.681791,
    -1.770611, -0.514533, -1.281915, -0.580455, 1.801604,
)  # fmt: skip
"""Every 0.04 s: runs with 1 and 2 steps per sample take the same sub-steps after their impacts."""


@pytest.mark.parametrize("halved", [False, True], ids=["as recorded", "interpolated"])
def test_a_low_bounce_within_a_step_is_seen(halved):
    samples, dt = np.array(BOUNCE), 0.02
    if halved:
        samples, dt = np.interp(np.arange(15) / 2, np.arange(8), np.append(samples, 0.0)), 0.01
    found = run_to_tolerance(Pier(alpha=0.211, p=1.96), RigidBase(), Motion("bounce", dt, samples), 1e-4)
    assert found.theta_max / 0.211 == pytest.approx(0.00865163, abs=1e-7)
    assert abs(found.theta_max / 0.211 - 0.00865162514) <= (found.theta_max_error or 0.0) / 0.211


def test_two_runs_with_the_same_sub_steps_prove_nothing():
    found = run_to_tolerance(
        Pier(alpha=0.17227, p=2.000381), RigidBase(), Motion("chance", 0.04, np.array(CHANCE)), 1e-4
    )
    assert found.theta_max / 0.17227 == pytest.approx(0.0209118, abs=1e-5)


@pytest.mark.parametrize("substeps", [1, 2, 3, 8])
def test_a_block_that_the_first_sample_lifts_and_the_next_pulls_back_rocks(substeps):
    found = run_fixed(Pier(alpha=0.2, p=1.0), RigidBase(), Motion("back", 0.02, np.array([-2.5, 0.0, 0.0])), substeps)
    assert found.status == "ok"
    assert 1 < found.impacts < 1000
    finer = run_fixed(Pier(alpha=0.2, p=1.0), RigidBase(), Motion("back", 0.02, np.array([-2.5, 0.0, 0.0])), 64)
    assert found.theta_max == pytest.approx(finer.theta_max, rel=1e-3)


def test_a_base_that_ratchets_on_is_not_called_over():
    """It overturns at 383 s; within 40/p after its motion, for which a run is judged, it leans further and further."""
    samples = np.loadtxt(Path(__file__).parent / "ratcheting_motion.txt")
    base = YieldingBase(beta=25.95608, eta=1.045591, epsilon=1.0, n=8.0, flight="stop")
    pier = Pier(alpha=0.082997, p=0.353807, mu=1.861922)
    found = run_to_tolerance(
        pier, base, Motion("ratchets", samples[1, 0] - samples[0, 0], samples[:, 1]), 1e-4, quiet_s=0.0
    )
    assert found.status == "failed"
    assert "further" in found.reason
