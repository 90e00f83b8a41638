"""Free rocking of a slender block on a rigid base: how long it rocks, and its period.

For α → 0 Housner's equation becomes linear in x = 1 − |θ|/α: x″ = p² x. Let go at θ0 it lands after acosh(1/x0)/p with
θ̇ = α p s, s = √(1 − x0²); leaving again with s it is in the air for 2 atanh(s)/p. Finite α adds a term in α².
"""

import math

import numpy as np
import pytest
from core_runs import run_block

from rockbatch.core.types import BEFORE_EVENT, REST
from rockbatch.pier import Pier, RigidBase
from rockbatch.simulation import block

P = 2.0
DT = 0.005


def let_go(alpha: float, start: float, e: float, duration: float):
    """Run and history rows of a block with p = 2 rad/s let go at ``start`` α, for ``duration``/p [s]."""
    still = np.zeros((round(duration / P / DT) + 1, 4))
    return run_block(
        block(Pier(alpha, P), RigidBase(e, confirm=("restitution",))), start * alpha, 0.0, still, DT, 4, 100_000
    )


def time_to_rest(start: float, e: float) -> float:
    """p t∞ in the slender limit: acosh(1/x0) + 2 Σ atanh(eⁿ s), the sum of all bounces."""
    x = 1.0 - start
    s = math.sqrt(1.0 - x * x)
    terms = math.ceil(40.0 / -math.log(e))  # the rest is below e⁻⁴⁰
    return math.acosh(1.0 / x) + 2.0 * math.fsum(math.atanh(e**n * s) for n in range(1, terms))


def test_a_block_comes_to_rest_when_the_sum_of_its_infinitely_many_bounces_says():
    """p t∞ = 18.518961010828 for e = 0.9 from α/2. 2 · 10⁻⁸: 1.6 α² (next test), and RK4 adds 10⁻¹¹."""
    exact = time_to_rest(0.5, 0.9)
    assert exact == pytest.approx(18.518961010828, abs=1e-12)
    run, rows = let_go(1e-4, 0.5, 0.9, 20.0)
    assert P * run.t_rest == pytest.approx(exact, abs=2e-8)
    assert run.impacts > 100  # bounces are followed, not cut off
    at_rest = rows[rows.t > run.t_rest]
    assert rows.t[-1] == pytest.approx(20.0 / P)
    assert len(at_rest) > 100
    assert not at_rest.theta.any()
    assert not at_rest.omega.any()
    assert np.count_nonzero(rows.kind == REST) == 1


def test_time_to_rest_approaches_the_slender_limit_as_alpha_squared():
    """Halving α from 0.1 quarters the difference; 0.02: the term in α⁴."""
    exact = time_to_rest(0.5, 0.9)
    differences = [P * let_go(alpha, 0.5, 0.9, 20.0)[0].t_rest - exact for alpha in (0.1, 0.05, 0.025)]
    assert differences[0] / differences[1] == pytest.approx(4.0, abs=0.02)
    assert differences[1] / differences[2] == pytest.approx(4.0, abs=0.02)


@pytest.mark.parametrize(("start", "e"), [(0.1, 0.9), (0.99, 0.9), (0.5, 0.5), (0.5, 0.97), (0.5, 0.05)])
def test_rest_comes_in_time_from_any_height_and_with_any_restitution(start, e):
    """1e-7: α = 10⁻⁴ leaves α² times some 10 near the summit, where time is most sensitive; RK4 adds 10⁻⁹ there."""
    exact = time_to_rest(start, e)
    run, _ = let_go(1e-4, start, e, exact + 1.0)
    assert P * run.t_rest == pytest.approx(exact, abs=1e-7)


@pytest.mark.parametrize("start", [0.05, 0.3, 0.6, 0.9, 0.999])
def test_period_is_housners(start):
    """T = (4/p) acosh(1/(1 − θ0/α)) (Housner 1963) while nothing is lost; 1e-7: α² = 10⁻⁸, and RK4 as before."""
    period = 4.0 * math.acosh(1.0 / (1.0 - start))
    _, rows = let_go(1e-4, start, 1.0, 3.0 * period)
    impacts = rows.t[rows.kind == BEFORE_EVENT]
    assert len(impacts) == 6
    assert P * impacts == pytest.approx(period * (0.25 + 0.5 * np.arange(6)), rel=1e-7)
