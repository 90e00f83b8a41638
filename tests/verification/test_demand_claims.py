"""Errors of forces, devices and sections against far smaller steps (benchmarks/demand_claims.py has the whole pool)."""

import importlib
from pathlib import Path

import pytest

BENCHMARKS = Path(__file__).parents[2] / "benchmarks"
SEED = 67


@pytest.fixture(scope="module")
def pool():
    """The benchmark, imported as a script beside it would be."""
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(BENCHMARKS))
        yield importlib.import_module("demand_claims")


@pytest.mark.slow
@pytest.mark.parametrize(("base", "number"), [("rigid", 4), pytest.param("springs", 0, marks=pytest.mark.thorough)])
def test_demands_between_rows_are_those_of_finer_steps_within_their_errors(pool, base, number):
    """Of cases whose forces in sections were beyond their errors as long as devices pulled linearly within a step."""
    claims = pool.judge(pool.case(base, number, SEED, tiny=False))
    assert len(claims) > 25
    assert [str(claim) for claim in claims if claim.verdict != "holds"] == []
