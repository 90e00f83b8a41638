"""Cases that once came out wrong, with what independent solvers found to be true."""

from pathlib import Path

import numpy as np
import pytest

from rockbatch.motions.motion import Motion
from rockbatch.pier import Pier, RigidBase, YieldingBase
from rockbatch.simulation import run_fixed, run_to_tolerance
from rockbatch.simulation.runs import Run, written_run

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


@pytest.mark.parametrize("restitution", [None, 0.0, 0.9])
@pytest.mark.parametrize("excess", [1e-6, 1e-5, 1e-4])
def test_a_lift_off_by_a_hair_is_one_hop(excess, restitution):
    """The ground passes g tan α for a moment. Weight does not change over so small a tilt: the hop is an arc of two cubics."""
    pier, dt = Pier(0.25, 0.5), 0.002
    motion = Motion("hair", dt, pier.gravity * np.tan(pier.alpha) * np.array([0.6, 1.0 + excess, 0.9, 0.5]))
    most = pier.p**2 * np.sin(pier.alpha) * excess  # θ̈ at the sample; from there on it falls
    before, fall = excess / (0.4 + excess) * dt, most / excess * (0.1 + excess) / dt
    omega, theta = 0.5 * most * before, most * before**2 / 6
    t = (most + np.sqrt(most**2 + 2 * fall * omega)) / fall
    found = run_fixed(pier, RigidBase(restitution, confirm=("restitution",)), motion, 1)
    assert (found.status, found.impacts, found.separations) == ("ok", 1, 1)
    assert found.theta_max == pytest.approx(theta + omega * t + most * t**2 / 2 - fall * t**3 / 6, rel=1e-6)


def test_a_first_sample_that_lifts_both_pivots_lets_no_key_lead():
    """Out of rest H = h cos θ; under a steady ground ½ (I0/M + H²) θ̇² = −ü_g h sin θ then."""
    pier, across = Pier(0.12, 0.8), 18.0
    motion = Motion("thrown", 0.01, np.full(20, across), np.full(20, -4.0 * pier.gravity))
    _, rows = written_run(Run(pier, RigidBase(), motion), 4, 0.0, 200)
    flying = rows[(rows.t > 0.0) & (rows.t < 0.15) & (rows.left == 0.0) & (rows.right == 0.0)]
    inertia = pier.size**2 / pier.mu + (pier.height * np.cos(flying.theta)) ** 2
    assert len(flying) > 10
    np.testing.assert_allclose(0.5 * inertia * flying.omega**2, -across * pier.height * np.sin(flying.theta), rtol=1e-6)


def test_a_landing_is_no_reversal_after_which_only_lesser_rotations_come():
    """The block lands after its motion, and turns further than before. The peak is that of a solver that shares no code."""
    across, up = (
        (-2.3, 0.0, -0.4, 3.1, -1.6, -2.3, 0.0, 0.4, 0.8),
        (6.3, -14.6, -8.3, -16.7, -10.4, -14.6, -18.8, -14.6, 8.3),
    )
    motion = Motion("thrown", 0.02, 9.81 * np.array(across), 9.81 * np.array(up))
    found = run_to_tolerance(Pier(0.1, 0.8), RigidBase(), motion, 1e-4)
    assert found.theta_max == pytest.approx(0.09584490611, abs=1e-7)
    assert found.t_end > 8.99


@pytest.mark.thorough  # another n
def test_a_base_that_ratchets_on_is_not_called_over():
    """It overturns at 383 s; within 40/p after its motion, for which a run is judged, it leans further and further."""
    samples = np.loadtxt(Path(__file__).parent / "ratcheting_motion.txt")
    base = YieldingBase(beta=25.95608, eta=1.045591, epsilon=1.0, n=8.0, flight="stop")
    pier = Pier(alpha=0.082997, p=0.353807, mu=1.861922)
    found = run_to_tolerance(
        pier, base, Motion("ratchets", samples[1, 0] - samples[0, 0], samples[:, 1]), 1e-4, quiet_s=0.0
    )
    assert found.status == "failed"
    assert found.failure == "ratchets"
