"""Elongations of devices and their derivatives, by closed forms and differences."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from core_samples import gaps_of, held_motion, held_pivots

from rockbatch.core.devices.laws import FRICTION
from rockbatch.core.springs.model import Contact, State
from rockbatch.core.types import Ground
from rockbatch.pier import ElasticBase, Pier
from rockbatch.simulation.elements import IDLE
from rockbatch.simulation.models import springs
from rockbatch.simulation.starting import _deck_elongation

PIER = Pier(0.3, 1.2)
AT_FOOT, AT_DECK = IDLE._replace(offset=0.7), IDLE._replace(height=9.0, swing=1.5, way=-1.0)


def elongation(m, of, theta, v):
    """Return e [m] of THEORY.md: u/cos(θ/2) at the foot, the way of the deck over the ground above."""
    if of.height:
        return of.way * (of.height * math.sin(theta) + math.copysign(of.swing, theta) * (1.0 - math.cos(theta)))
    rise = v + m.height * (1.0 - math.cos(theta)) - of.offset * math.sin(theta)
    return rise / math.cos(0.5 * theta)


LOW, HIGH = (-0.5, -1.0, -0.2, -1.0), (0.5, 1.0, 0.2, 1.0)
STATES = [
    SimpleNamespace(theta=theta, omega=omega, v=v, v_rate=v_rate)
    for theta, omega, v, v_rate in np.random.default_rng(5).uniform(LOW, HIGH, (20, 4)).tolist()
]


def test_finite_elongations_and_their_derivatives_are_those_of_the_motion(uncompiled):
    base, short = ElasticBase(50.0, kinematics="finite"), 1e-4
    m, found = springs(PIER, base), uncompiled(gaps_of, PIER, base, (AT_FOOT, AT_DECK), STATES)
    for of, each in zip((AT_FOOT, AT_DECK), found, strict=True):
        for y, gap in zip(STATES, each, strict=True):
            by_theta, by_v, along = (
                [elongation(m, of, y.theta + t * theta, y.v + t * v) for t in (-short, 0.0, short)]
                for theta, v in ((1.0, 0.0), (0.0, 1.0), (y.omega, y.v_rate))
            )
            assert gap.elongation == pytest.approx(along[1], rel=1e-12)
            assert of is AT_FOOT or _deck_elongation(of, y.theta, True) == pytest.approx(along[1], rel=1e-12)
            assert gap.by_theta == gap.arm == pytest.approx((by_theta[2] - by_theta[0]) / (2.0 * short), rel=1e-6)
            assert gap.by_v == pytest.approx((by_v[2] - by_v[0]) / (2.0 * short), abs=1e-9)
            assert gap.speed == pytest.approx((along[2] - along[0]) / (2.0 * short), abs=1e-7)
            assert gap.bend == pytest.approx((along[0] - 2.0 * along[1] + along[2]) / short**2, abs=1e-5)


def test_in_first_order_kinematics_an_elongation_is_linear_and_arms_keep_p_delta(uncompiled):
    base = ElasticBase(50.0)
    m, found = springs(PIER, base), uncompiled(gaps_of, PIER, base, (AT_FOOT, AT_DECK), STATES)
    for y, foot, deck in zip(STATES, *found, strict=True):
        assert foot[:5] == pytest.approx((y.v - 0.7 * y.theta, y.v_rate - 0.7 * y.omega, 1.0, -0.7, 0.0), rel=1e-12)
        assert foot.arm == pytest.approx(m.height * y.theta - 0.7, rel=1e-12)
        assert deck == pytest.approx((-9.0 * y.theta, -9.0 * y.omega, 0.0, -9.0, 0.0, -9.0), rel=1e-12)
        assert _deck_elongation(AT_DECK, y.theta, False) == deck.elongation


def test_friction_holds_the_pivot_that_does_not_accelerate(uncompiled):
    """v̈ ± b θ̈ is 0 there; in full contact at rest both are. Contact and law of a pivot wait together."""
    base, b = ElasticBase(50.0), PIER.half_width
    moved = [(y, SimpleNamespace(v_rate=sign * b * 0.3, omega=0.3)) for y in STATES for sign in (-1.0, 1.0)]
    still = [(y, SimpleNamespace(v_rate=0.0, omega=0.0)) for y in STATES]
    found = uncompiled(held_pivots, PIER, base, moved + still)
    assert found == [(True, False) * 2, (False, True) * 2] * len(STATES) + [(True, True) * 2] * len(STATES)


@pytest.mark.parametrize("kinematics", ["first-order", "finite"])
@pytest.mark.parametrize("offsets", [(0.7,), (-0.4, 0.9), (0.7, 0.7)])
def test_an_elongation_that_friction_holds_does_not_accelerate(offsets, kinematics, uncompiled):
    """By the second difference of its closed form along the motion on springs, to 1e-5 of some m/s² without friction."""
    m, short, contact = springs(PIER, ElasticBase(50.0, kinematics=kinematics)), 1e-4, Contact(1.0, 1.0, 0.0, 0.0, 0.0)
    rubs = [IDLE._replace(kind=FRICTION, strength=2.0 + i, offset=s) for i, s in enumerate(offsets)]

    def acceleration(of, y, k):
        moved = [
            (y.theta + t * y.omega + 0.5 * t * t * k.omega, y.v + t * y.v_rate + 0.5 * t * t * k.v_rate)
            for t in (-short, 0.0, short)
        ]
        finite = kinematics == "finite"
        e = [elongation(m, of, *each) if finite else each[1] - of.offset * each[0] for each in moved]
        return (e[0] - 2.0 * e[1] + e[2]) / short**2

    for at in STATES[:5]:
        y = State(theta=at.theta, v=at.v, omega=at.omega, v_rate=at.v_rate, z_left=-0.4, z_right=-0.9)
        motion = uncompiled(held_motion, m, y, contact, Ground(3.0, 0.0, 0.5, 0.0), rubs)
        for of in rubs:
            assert abs(acceleration(of, y, motion.free)) > 0.1
            assert acceleration(of, y, motion.held) == pytest.approx(0.0, abs=1e-5)
