"""Bouc–Wen springs ratchet: with β = γ = ½ they yield in every reloading, however far below the yield force; the others do not.

In a cycle of the force between |z| = z₁ and z₂ the support sinks for good by δ_y ∫ (1/(1 − zⁿ) − 1) dz: the path of
the loading, less that of the linear unloading. For cycles of ±30 % about the weight, z = (1 ± 0.3)/η; in units of
δ_s = δ_y/η that is 0.821 % a cycle for η = 2.5 and 0.326 % for η = 3 (n = 5).
"""

import math

import numpy as np
import pytest
from core_samples import FIG5
from scipy.integrate import quad

import rockbatch as rb
from rockbatch.motions.motion import Motion
from rockbatch.pier import YieldingBase
from rockbatch.simulation import run_fixed

BETA = 50.0
SWING = 0.3
OMEGA_V = BETA * FIG5.p
SAMPLES = 10  # per natural period 2π/ω_v
SUBSTEPS = 7  # ω_v h < 0.1


def force_cycles(cycles: int, slowness: int) -> Motion:
    """Vertical shaking that unloads the supports to 70 %, loads them ``cycles`` times to 130 % and back, ends at 100 %.

    A cycle takes ``slowness`` natural periods. Starting without a jump of the rate matters: the free vibration it
    would leave is as fast as the slow motion, at any slowness, and ratchets by itself (36 % more settlement).
    """
    per_cycle = slowness * SAMPLES
    t = np.arange((cycles + 1) * per_cycle + 1) / per_cycle
    wave = np.cos(2 * math.pi * t)
    to_and_from = (t < 0.5) | (t > cycles + 0.5)
    vertical = SWING * FIG5.gravity * np.where(to_and_from, 0.5 * (wave - 1.0), wave)
    return Motion("cycles", 2 * math.pi / OMEGA_V / SAMPLES, np.zeros(len(t)), vertical)


def settlement(base: YieldingBase, cycles: int, slowness: int) -> float:
    """Settlement over δ_s."""
    outcome = run_fixed(FIG5, base, force_cycles(cycles, slowness), SUBSTEPS, 0.0, wait=False)
    assert (outcome.status, outcome.theta_max, outcome.separations) == ("ok", 0.0, 0)
    return outcome.settlement * OMEGA_V**2 / FIG5.gravity


def ratchet(eta: float, n: float, low: float, high: float) -> float:
    """Settlement over δ_s while the force is raised from ``low`` to ``high`` times the weight."""
    return eta * quad(lambda z: z**n / (1 - z**n), low / eta, high / eta, epsabs=1e-15, epsrel=1e-12)[0]


@pytest.mark.parametrize(("eta", "percent"), [(2.5, 0.821), (3.0, 0.326)])
def test_settlement_per_cycle_is_the_known_number(eta, percent):
    """n = 5. Half a unit of the last digit; inertia adds 4e-5 of it at this slowness."""
    base = YieldingBase(BETA, eta=eta, n=5.0)
    per_cycle = (settlement(base, 6, 200) - settlement(base, 1, 200)) / 5
    assert 100 * per_cycle == pytest.approx(percent, abs=0.0005)
    assert 100 * ratchet(eta, 5.0, 0.7, 1.3) == pytest.approx(percent, abs=0.0005)


@pytest.mark.parametrize(
    ("eta", "n", "kinematics"),
    [
        (2.5, 5.0, "first-order"),
        (3.0, 5.0, "finite"),
        pytest.param(2.5, 1.0, "first-order", marks=pytest.mark.thorough),  # compiled by itself, like those below
        pytest.param(2.5, 1.0, "finite", marks=pytest.mark.thorough),
    ],
)
@pytest.mark.parametrize("cycles", [1, 5])
def test_settlement_converges_to_the_integral_as_the_cycles_slow_down(eta, n, kinematics, cycles):
    """Inertia adds to the force with the square of cycle frequency over ω_v: 4 times as slow, a sixteenth of the gap.

    At least a tenth, for what is left of the free vibration at each reversal has any phase. The last way back to the
    weight, from 70 to 100 %, belongs to the sum.
    """
    base = YieldingBase(BETA, 0.1, kinematics, eta=eta, n=n)
    exact = cycles * ratchet(eta, n, 0.7, 1.3) + ratchet(eta, n, 0.7, 1.0)
    fast, slow = (abs(settlement(base, cycles, slowness) / exact - 1) for slowness in (50, 200))
    assert 10 * slow < fast < 1e-3
    assert slow < 1e-4


def test_an_elastic_plastic_spring_does_not_ratchet():
    """130 % of the weight is below its yield force: nothing but the rounding of the position, 1e-12 δ_s."""
    for eta in (1.5, 2.5):
        assert settlement(YieldingBase(BETA, eta=eta, spring="epp"), 10, 50) == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize(
    ("eta", "n", "kinematics"),
    [
        (2.5, 5.0, "first-order"),
        (1.5, 5.0, "finite"),
        pytest.param(1.5, 2.0, "first-order", marks=pytest.mark.thorough),
        pytest.param(1.5, 2.0, "finite", marks=pytest.mark.thorough),
    ],
)
def test_a_hardening_spring_yields_in_its_first_loading_only(eta, n, kinematics):
    """Loaded to 130 % of the weight it sinks by the integral from 100 to 130 %, as a Bouc–Wen spring does then; the cycles after
    it add the rounding of the position. Inertia overshoots by 4e-5 of the force's change at this slowness."""
    base = YieldingBase(BETA, kinematics=kinematics, eta=eta, n=n, spring="hardening")
    first, after = settlement(base, 1, 200), settlement(base, 6, 200)
    assert first == pytest.approx(ratchet(eta, n, 1.0, 1.3), rel=1e-3)
    assert after == pytest.approx(first, abs=1e-9)


def test_a_hardening_spring_follows_bouc_wens_curve_as_long_as_it_is_loaded():
    """A push down that grows all the time, to 180 % of the weight: the same motion, to rounding."""
    t = np.arange(601) / 600
    push = Motion("push", 0.01, np.zeros(601), 0.8 * FIG5.gravity * np.sin(0.5 * math.pi * t) ** 2)
    runs = [
        rb.simulate(FIG5, YieldingBase(BETA, eta=2.5, spring=spring), push, substeps=8, quiet_s=0.0, wait=False)
        for spring in ("bouc-wen", "hardening")
    ]
    bouc_wen, hardening = (run.history.groupby("t").last() for run in runs)
    common = bouc_wen.index.intersection(hardening.index)
    assert len(common) >= len(t)
    assert hardening.z_left.min() == pytest.approx(-1.8 / 2.5, rel=1e-3)
    for name in ("v", "z_left"):
        np.testing.assert_allclose(hardening[name][common], bouc_wen[name][common], rtol=0, atol=1e-12)
