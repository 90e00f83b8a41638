"""Small functions under every run: powers, the ground between its samples, and springs that recover without their pivots."""

import math

import numpy as np
import pytest
from core_samples import FIG5, values_of

from rockbatch.core.ground import ground_rows, later
from rockbatch.core.observe.rows import cubic, ground_at
from rockbatch.core.powers import power
from rockbatch.core.springs import recovery
from rockbatch.core.springs.equations import geometry
from rockbatch.core.springs.model import Contact, State
from rockbatch.core.types import Ground
from rockbatch.pier import ElasticBase
from rockbatch.simulation import springs


@pytest.mark.parametrize("n", [None, *range(1, 11), 2.5, 0.3])
def test_powers_are_those_of_their_exponent(n):
    for x in (0.0, 0.3, 1.0, 1.7):
        assert power(x, n) == pytest.approx(x ** (5 if n is None else n), rel=1e-14)


def test_the_ground_is_linear_between_samples_and_rests_after_the_last():
    horizontal, vertical = np.array([0.5, -1.0, 2.0]), np.array([0.0, 0.4, 0.1])
    rows = ground_rows(horizontal, vertical, 0.02)
    at = np.arange(4) * 0.02
    for t in (0.0, 0.013, 0.02, 0.035, 0.059):
        number = int(t / 0.02 + 1e-9)
        ground = ground_at(rows, 0.02, 0.02 * number + 0.01, t)
        expected = [np.interp(t, at, np.append(samples, 0.0)) for samples in (horizontal, vertical)]
        assert (ground.horizontal, ground.vertical) == pytest.approx(tuple(expected), abs=1e-14)
        slopes = [np.diff(np.append(samples, 0.0))[number] / 0.02 for samples in (horizontal, vertical)]
        assert (ground.horizontal_slope, ground.vertical_slope) == pytest.approx(tuple(slopes))
    assert ground_at(rows, 0.02, 0.065, 0.065) == Ground(0.0, 0.0, 0.0, 0.0)
    assert not ground_rows(horizontal, (), 0.02)[:, 2:].any()
    assert later(Ground(1.0, 2.0, 3.0, -4.0), 0.5) == Ground(2.0, 2.0, 1.0, -4.0)


def test_a_cubic_between_rows_has_their_values_and_slopes_and_stays_monotonic():
    start, rate, end, rate_end, h = 1.0, 3.0, 2.0, -4.0, 0.5
    assert [cubic(start, rate, end, rate_end, h, s) for s in (0.0, 1.0)] == pytest.approx([start, end])
    for s, slope in ((0.0, rate), (1.0, rate_end)):
        ends = [cubic(start, rate, end, rate_end, h, s + way) for way in (-1e-6, 1e-6)]
        assert (ends[1] - ends[0]) / (2e-6 * h) == pytest.approx(slope, rel=1e-5)
    steep = [cubic(0.0, 0.0, 1.0, 30.0, 1.0, s) for s in np.linspace(0.0, 1.0, 21)]
    assert min(steep) == 0.0
    assert max(steep) == 1.0


def test_a_damped_spring_without_its_pivot_recovers_as_an_exponential():
    """F_y z + C ẇ = 0: z falls as e^(−t K/C), and so do the top of the support, its velocity and its acceleration."""
    for x in (0.0, 1e-3, 0.7, 5.0, 38.0):
        assert recovery.decay(x) == pytest.approx(math.exp(-x), rel=1e-14, abs=1e-16)
    m = springs(FIG5, ElasticBase(50.0, zeta=0.05))
    rate, z, short = m.yield_force * m.stiffness / m.damping, -0.6, 1e-5
    assert recovery.quickness(m) == pytest.approx(rate)
    assert recovery.lag(m) == pytest.approx(m.damping / m.yield_force)
    tops = [recovery.top(m, 0.01, z * math.exp(-t * rate)) for t in (-short, 0.0, short)]
    assert tops[1] == pytest.approx(0.01 + m.yield_deflection * z)
    assert recovery.velocity_of_top(m, z) == pytest.approx((tops[2] - tops[0]) / (2.0 * short), rel=1e-3)
    assert recovery.acceleration_of_top(m, z) == pytest.approx((tops[0] - 2.0 * tops[1] + tops[2]) / short**2, rel=1e-2)
    assert recovery.recovery_rate(m, 7.0, z, 0.0) == pytest.approx(-z * rate)
    assert recovery.recovery_rate(m, 7.0, z, 1.0) == 7.0
    assert recovery.share_left(m, 0.01) == pytest.approx(math.exp(-0.01 * rate))
    y, start = State(0.1, 0.2, 0.3, 0.4, -0.5, -0.6), State(0.0, 0.0, 0.0, 0.0, -0.8, -0.9)
    for left, right in ((1.0, 0.0), (0.0, 1.0), (0.0, 0.0)):
        found = recovery.with_recovery(m, y, start, Contact(left, right, 0.0, 0.0, 0.0), 0.25)
        assert found[:4] == y[:4]
        assert found[4:] == pytest.approx((-0.5 if left else -0.2, -0.6 if right else -0.225))
    plain = springs(FIG5, ElasticBase(50.0))
    assert recovery.top(plain, 0.01, z) == 0.01
    assert recovery.velocity_of_top(plain, z) == recovery.acceleration_of_top(plain, z) == 0.0
    assert recovery.recovery_rate(plain, 7.0, z, 0.0) == 7.0
    assert recovery.share_left(plain, 0.3) == 1.0
    assert recovery.with_recovery(plain, y, start, Contact(0.0, 0.0, 0.0, 0.0, 0.0), 0.25) == y


def test_a_support_bears_what_its_spring_and_its_dashpot_do_while_its_pivot_is_there():
    """F = F_y z + C v̇ of each pivot, which moves at v̇ ± b θ̇; without a dashpot z alone says it."""
    y, b = State(0.0, 0.0, 0.03, 0.02, -0.5, -0.6), FIG5.half_width
    for zeta, left, right in ((None, 1.0, 1.0), (0.05, 1.0, 1.0), (0.05, 0.0, 1.0), (0.05, 1.0, 0.0)):
        m = springs(FIG5, ElasticBase(50.0, zeta=zeta))
        found = recovery.forces(m, y, Contact(left, right, 0.0, 0.0, 0.0), geometry(m, 0.0))
        expected = [m.yield_force * z + m.damping * (0.03 + way * b * 0.02) for z, way in ((-0.5, 1.0), (-0.6, -1.0))]
        assert found == pytest.approx((left * expected[0], right * expected[1]), rel=1e-12)


def test_a_row_has_the_ground_of_the_interval_in_which_its_step_lies(uncompiled):
    """Linear from the sample before, from both sides of a sample; at rest behind the last."""
    ground = np.array([[1.0, 10.0, -3.0, 4.0], [2.0, -20.0, 0.5, -6.0]])
    calls = [
        ("observe.rows", "ground_at", ground, 0.1, middle, t)
        for middle, t in ((0.03, 0.1), (0.12, 0.1), (0.15, 0.17), (0.2, 0.2), (0.35, 0.3))
    ]
    still = 0.0, 0.0, 0.0, 0.0
    expected = (2.0, 10.0, -2.6, 4.0), (2.0, -20.0, 0.5, -6.0), (0.6, -20.0, 0.08, -6.0), still, still
    np.testing.assert_allclose(uncompiled(values_of, calls), expected, atol=1e-12)
