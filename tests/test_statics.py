"""What a pier bears before it moves, against the closed forms of THEORY.md and a balance of moments."""

import math

import pytest
from scipy.optimize import brentq

from rockbatch.pier import Damper, ElasticBase, Pier, Tendon, static_deflection
from rockbatch.pier.statics import lift_off_acceleration, lift_off_rotation, unstable_equilibrium

PIER = Pier(alpha=0.2, p=1.0, mu=4.0)
FRICTION, TENDON = Damper("friction", f=0.05), Tendon(psi=0.3, lam=0.2)


def test_a_bare_pier_on_rigid_ground_lifts_off_at_tan_alpha_and_balances_at_alpha():
    assert lift_off_acceleration(PIER) == pytest.approx(math.tan(0.2))
    assert lift_off_rotation(PIER, (), 0.0) == 0.0
    assert unstable_equilibrium(PIER) == pytest.approx(0.2)


def test_friction_at_both_pivots_and_a_tendon_on_the_axis_raise_the_lift_off():
    """THEORY.md: tan α (1 + 2f) g, and (g + P0/M) tan α."""
    assert lift_off_acceleration(PIER, (FRICTION,)) == pytest.approx(math.tan(0.2) * 1.1)
    assert lift_off_acceleration(PIER, (TENDON,)) == pytest.approx(math.tan(0.2) * 1.3)
    assert lift_off_acceleration(PIER, (Damper("viscous", nu=1.0), Damper("hysteretic", f=0.1, yield_m=0.01))) == (
        lift_off_acceleration(PIER)
    )


def test_of_two_directions_the_weaker_counts():
    """A tendon at the left pivot has no arm about it, and the base's width about the right one."""
    assert lift_off_acceleration(PIER, (Tendon(psi=0.3, at="left"),)) == pytest.approx(math.tan(0.2))


def test_springs_let_go_at_the_rotation_of_eq_10_when_the_other_carries_all():
    base = ElasticBase(beta=30.0)
    deflection = static_deflection(PIER, base)
    lean = (1 + PIER.mu) / (PIER.mu * 30.0**2 * math.sin(0.2))
    assert lift_off_rotation(PIER, (), deflection) == pytest.approx(lean)
    # All the weight on one pivot: M a h = M g (b - h θ)
    held = (PIER.half_width - PIER.height * lean) / PIER.height
    assert lift_off_acceleration(PIER, (), deflection) == pytest.approx(held)


def test_a_tendon_moves_the_unstable_equilibrium_out_and_a_stiff_one_takes_it_away():
    """Its zero of sin(α − θ) + λ sin θ + ψ sin α cos(θ/2) is found by another solver; for λ > cos α there is none."""

    def brace(theta):
        return math.sin(0.2 - theta) + 0.2 * math.sin(theta) + 0.3 * math.sin(0.2) * math.cos(theta / 2)

    assert unstable_equilibrium(PIER, (TENDON,)) == pytest.approx(brentq(brace, 0.2, 1.5), abs=1e-9)
    assert unstable_equilibrium(PIER, (Tendon(psi=0.3, lam=1.01),)) is None


def test_a_tendon_that_yields_rights_the_pier_by_its_strength_alone():
    weak = Tendon(psi=0.3, lam=5.0, strength=0.3000001)
    level = brentq(lambda t: math.sin(0.2 - t) + 0.3 * math.sin(0.2) * math.cos(t / 2), 0.2, 1.5)
    assert unstable_equilibrium(PIER, (weak,)) == pytest.approx(level, abs=1e-6)
