"""What must not matter: left or right, when the shaking starts, and the unit of time."""

import math

import numpy as np
import pytest
from core_samples import FIG5, broadband, pulse

import rockbatch as rb
from rockbatch.motions.motion import Motion
from rockbatch.pier import ElasticBase, RigidBase, YieldingBase
from rockbatch.simulation import run_fixed

SINE = pulse("sine", 0.5, dt=0.01, end=3.0)
BASES = [
    pytest.param(YieldingBase(50, 0.1, eta=2.2), id="bouc-wen"),
    pytest.param(YieldingBase(50, 0.1, "finite", "guided", eta=2.2, spring="epp"), id="epp-finite-guided"),
    pytest.param(YieldingBase(50, eta=2.2, spring="hardening", zeta=0.05), id="hardening-damped"),
    pytest.param(ElasticBase(50, 0.0, "finite"), id="elastic-epsilon0"),
    pytest.param(YieldingBase(50, eta=2.2, impact="housner"), id="housner"),
    pytest.param(
        YieldingBase(50, kinematics="finite", eta=2.2, spring="epp", impact="housner"), id="housner-epp-finite"
    ),
    pytest.param(RigidBase(), id="rigid"),
]


@pytest.mark.parametrize("base", BASES)
def test_reversed_ground_motion_mirrors_the_rotation(base):
    """To the bit but for the order of two sums, hence 1e-13 α instead of equality."""
    vertical = broadband(np.random.default_rng(1), SINE.dt, SINE.npts, 15.0 if base.name != "rigid" else 5.0)
    run = rb.simulate(FIG5, base, Motion("+", SINE.dt, SINE.horizontal, vertical), substeps=4)
    mirrored = rb.simulate(FIG5, base, Motion("-", SINE.dt, -SINE.horizontal, vertical), substeps=4)
    assert len(run.t) == len(mirrored.t)
    assert np.abs(run.theta).max() > 0.01
    np.testing.assert_allclose(mirrored.theta, -run.theta, rtol=0, atol=1e-13 * FIG5.alpha)
    if base.name != "rigid":
        np.testing.assert_allclose(mirrored.z_left, run.z_right, rtol=0, atol=1e-10)


@pytest.mark.parametrize("base", BASES)
def test_leading_zeros_delay_the_response_and_change_nothing_else(base):
    """At rest nothing moves: 1e-12 α leaves room for the rounding of a static equilibrium."""
    wait = 100
    delayed = Motion("late", SINE.dt, np.concatenate([np.zeros(wait), SINE.horizontal]))
    run, late = (run_fixed(FIG5, base, motion, 4, 0.0) for motion in (SINE, delayed))
    assert late.theta_max == pytest.approx(run.theta_max, abs=1e-12 * FIG5.alpha)
    assert late.t_max == pytest.approx(run.t_max + wait * SINE.dt, abs=1e-9)
    assert (late.impacts, late.separations) == (run.impacts, run.separations)


@pytest.mark.parametrize("c", [0.44, -0.36])
def test_constant_vertical_acceleration_rescales_time_on_the_rigid_base(c):
    """θ̈ = −(1+c) p² {sin + ü_g/((1+c) g) cos}: with ü_g times 1+c, only time shrinks, by 1/√(1+c). Rounding only."""
    slow = run_fixed(FIG5, RigidBase(), SINE, 4, 1.0)
    shrink = 1.0 / math.sqrt(1.0 + c)
    heavy = Motion(
        "heavy",
        SINE.dt * shrink,
        (1.0 + c) * SINE.horizontal,
        np.full(SINE.npts, c * FIG5.gravity),
    )
    fast = run_fixed(FIG5, RigidBase(), heavy, 4, 0.0)
    assert fast.theta_max == pytest.approx(slow.theta_max, rel=1e-12)
    assert fast.t_max == pytest.approx(slow.t_max * shrink, rel=1e-10)


@pytest.mark.parametrize("base", BASES)
def test_nothing_moves_without_shaking(base):
    """θ stays exactly 0; v drifts by less than 1e-12 of the static deflection's scale g/ω_v²."""
    quiet = Motion("quiet", 0.01, np.zeros(500), np.zeros(500))
    run = rb.simulate(FIG5, base, quiet, substeps=4)
    assert run.status == "ok"
    assert np.all(run.theta == 0.0)
    assert run.events.empty or set(run.events.kind) == {"spring"}
    if base.name != "rigid":
        assert np.ptp(run.v) < 1e-12 * FIG5.gravity / (base.beta * FIG5.p) ** 2
