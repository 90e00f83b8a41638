"""What the compiled core is given of a pier on springs."""

import math

import pytest
from core_samples import FIG5

from rockbatch.pier import Damper, ElasticBase, Pier, RigidBase, Tendon, YieldingBase
from rockbatch.simulation.elements import elements
from rockbatch.simulation.models import model
from rockbatch.simulation.restraints import at_rest

UNITS = {
    "half_width": (1, 0), "height": (1, 0), "inertia": (2, 0), "gravity": (1, -2), "yield_deflection": (1, 0),
    "stiffness": (-1, 0), "yield_force": (1, -2), "damping": (0, -1), "level": (1, 0), "rest": (1, -1),
}  # fmt: skip
"""Powers of length and time of the numbers that have a unit, per unit mass."""


@pytest.mark.parametrize(
    "base", [YieldingBase(60.0, 0.2, eta=2.5), ElasticBase(60.0, zeta=0.05)], ids=["yielding", "damped"]
)
def test_every_number_has_its_unit(base):
    """Lengths of 8 m and times of 2 s instead of one: the same pier in other units."""
    pier = Pier(alpha=0.2, p=1.0)
    other = Pier(alpha=0.2, p=0.5, gravity=pier.gravity * 8.0 / 4.0)
    first, second = model(pier, base), model(other, base)
    assert (second.half_width, second.height) == pytest.approx((8.0 * first.half_width, 8.0 * first.height), rel=1e-14)
    for name, (length, time) in UNITS.items():
        assert getattr(second, name) == pytest.approx(
            getattr(first, name) * 8.0**length * 2.0**time, rel=1e-14, abs=0.0
        ), name
    others = [name for name in first._fields if name not in UNITS]
    assert [getattr(second, name) for name in others] == [getattr(first, name) for name in others]


def test_a_tendon_at_rest_pulls_between_nothing_and_its_strength():
    (law,) = elements(FIG5, RigidBase(restraints=(Tendon(psi=0.1, lam=2.0, strength=0.13),)))
    longest = (law.strength - law.prestress) / law.stiffness
    for elongation, force, stiffness in (
        (0.0, law.prestress, law.stiffness), (0.5 * longest, 0.5 * (law.prestress + law.strength), law.stiffness),
        (2.0 * longest, law.strength, 0.0), (-2.0 * law.prestress / law.stiffness, 0.0, 0.0),
    ):  # fmt: skip
        assert at_rest(law, elongation, 0.0, 0.0) == pytest.approx((force, stiffness), abs=0.0)


@pytest.mark.parametrize(("exponent", "nu", "speed"), [(0.5, 0.3, None), (0.999, 0.3, 0.0), (0.999, 2000.0, math.inf)])
def test_a_viscous_damper_is_linear_where_its_power_law_would_be_too_steep(exponent, nu, speed):
    """At 100 p, about the farther pivot; with an exponent near 1 that is nowhere, or everywhere, beyond what a float holds."""
    damper = Damper("viscous", nu=nu, exponent=exponent, at="left", confirm=("nu",))
    (oil,) = elements(FIG5, RigidBase(restraints=(damper,)))
    steepest = 100.0 * FIG5.p * FIG5.inertia_about_pivot / (2.0 * FIG5.half_width) ** 2
    assert oil.slope == pytest.approx(steepest, rel=1e-12)
    if speed is None:
        assert oil.coefficient * oil.linear_below**exponent == pytest.approx(steepest * oil.linear_below, rel=1e-12)
    else:
        assert oil.linear_below == speed
