"""A pier near the yield force of its springs stands only on stiff ones."""

from dataclasses import replace

import pytest
from core_samples import FIG5, steady

from rockbatch.pier import YieldingBase, least_beta, problems
from rockbatch.simulation import run_fixed


@pytest.mark.parametrize(
    ("n", "beta", "stands"), [(1, 10, False), (1, 18, False), (1, 20, True), (5, 8, False), (5, 12, True)]
)
def test_bouc_wen_springs_near_their_yield_force_need_more_stiffness(n, beta, stands):
    """Toppled by 1e-9 g below the limit (independent reference)."""
    assert (problems(FIG5, YieldingBase(beta, 0.1, eta=1.05, n=n)) == []) == stands


@pytest.mark.parametrize(
    ("spring", "n", "eta"),
    [
        ("bouc-wen", 5.0, 1.2),
        ("hardening", 5.0, 1.2),
        pytest.param("bouc-wen", 1.0, 1.05, marks=pytest.mark.thorough),  # compiled by themselves
        pytest.param("bouc-wen", 2.0, 1.1, marks=pytest.mark.thorough),
    ],
)
def test_the_limit_is_where_a_small_push_begins_to_grow(spring, n, eta):
    """A push of 1e-7 g that lasts: just above the limit the lean stays of its order, just below it runs away."""
    push = steady(1e-7 * 9.81, 0.0, 0.01, 2001)
    peaks = []
    for factor in (1.05, 0.95):
        base = YieldingBase(50.0, 0.1, eta=eta, n=n, spring=spring)
        base = replace(base, beta=factor * least_beta(FIG5, base))
        peaks.append(run_fixed(FIG5, base, push, 4, 0.0, wait=False).theta_max)
    assert peaks[0] < 1e-4
    assert peaks[1] > 30.0 * peaks[0]
