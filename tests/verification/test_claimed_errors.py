"""Claimed errors hold under motions that differ by less than a record resolves (benchmarks/claims.py)."""

import importlib
import math
from pathlib import Path

import numpy as np
import pytest
from core_samples import has_usual_n

from rockbatch.motions import Motion
from rockbatch.simulation import run_fixed, run_to_tolerance
from rockbatch.simulation.steps import readings

BENCHMARKS = Path(__file__).parents[2] / "benchmarks"


@pytest.fixture
def benchmark(monkeypatch):
    monkeypatch.syspath_prepend(str(BENCHMARKS))
    return importlib.import_module


def moved(case, outcome, name):
    """Return the greatest change of a result by four changes of the motion."""
    values = [
        getattr(run_fixed(case.pier, case.base, case.motion.times(1.0 + change), outcome.substeps), name)
        for change in (1e-8, -1e-8, 3e-9, -3e-9)
    ]
    return max(abs(value - getattr(outcome, name)) for value in values)


@pytest.mark.sweep(fast=1)
@pytest.mark.parametrize("number", [26, 79])
def test_chaotic_peaks_on_the_rigid_base_have_no_error(benchmark, number):
    """Of the first a motion 10⁻⁸ stronger moves 3·10⁻⁵ α and one 10⁻⁸ weaker 0.13 α; the second took two trials that agreed."""
    cases = benchmark("rigid_survey").cases(3000, 101, "made noise")
    (case,) = (case for case in cases if case.id == f"made-noise-{number}")
    outcome = run_to_tolerance(case.pier, case.base, case.motion, 1e-4)
    assert (outcome.status, outcome.theta_max_error) == ("ok", None)
    assert "chaotic" in outcome.note
    assert moved(case, outcome, "theta_max") > 1e-4 * case.pier.alpha


@pytest.mark.slow
@pytest.mark.parametrize(
    ("stratum", "number", "seed"), [pytest.param("Bouc-Wen", 79, 11, marks=pytest.mark.thorough), ("epp", 26, 7)]
)
def test_chaotic_residuals_have_no_error_beside_a_peak_that_has_one(benchmark, stratum, number, seed):
    case = benchmark("independent.pool").cases(None, seed, stratum)[number]
    outcome = run_to_tolerance(case.pier, case.base, case.motion, 1e-4)
    assert outcome.status == "ok"
    assert (outcome.theta_res_error, outcome.settlement_error) == (None, None)
    assert moved(case, outcome, "theta_res") > 1e-4 * case.pier.alpha
    assert moved(case, outcome, "theta_max") <= outcome.theta_max_error


@pytest.mark.thorough  # a kernel of its own
def test_residuals_of_a_run_that_is_waited_for_to_the_end_are_read_twice(benchmark):
    """Undamped Bouc–Wen springs go on yielding: the error has their drift, so that zeros behind the motion stay within it."""
    case = benchmark("independent.pool").cases(None, 7, "Bouc-Wen")[9]
    outcome = run_to_tolerance(case.pier, case.base, case.motion, 1e-4)
    assert "still has the energy for a greater rotation" in outcome.note
    assert outcome.theta_res_drift != 0.0
    zeros = np.zeros(readings(case.pier, case.base, case.motion.dt)[1])
    vertical = None if case.motion.vertical is None else np.append(case.motion.vertical, zeros)
    longer = Motion("longer", case.motion.dt, np.append(case.motion.horizontal, zeros), vertical)
    later = run_to_tolerance(case.pier, case.base, longer, 1e-4)
    for name in ("theta_res", "settlement"):
        changed = abs(getattr(later, name) - getattr(outcome, name))
        assert 0.0 < changed <= getattr(outcome, f"{name}_error") + getattr(later, f"{name}_error")


@pytest.mark.slow
@pytest.mark.parametrize(("base", "count", "least"), [("rigid", 500, 300), ("springs", 400, 60)])
def test_of_a_pool_no_claim_is_broken_by_more_than_the_tolerance(benchmark, monkeypatch, base, count, least):
    """Of springs those with the usual n: the whole pool by ``python benchmarks/claims.py``."""
    claims = benchmark("claims")
    every = claims.cases
    monkeypatch.setattr(claims, "cases", lambda *pool: (case for case in every(*pool) if has_usual_n(case[2])))
    rows = list(claims.survey(base, count, seed=3))
    claiming = [row for row in rows if not math.isnan(row.claimed[0])]
    assert len(claiming) >= least
    assert [row.id for row in claiming if row.overturns] == []
    for result in range(len(claims.RESULTS)):
        assert [row.id for row in rows if row.beyond(result)] == []


@pytest.mark.thorough
def test_of_a_pool_on_footings_no_claim_is_broken(benchmark):
    """Against 160 strips at half the step, and against endless ones: the first cases of those of verification.md."""
    claims = benchmark("claims_on_footings")
    rows = list(claims.survey(40, 5))
    claiming = [row for row in rows if not math.isnan(row.claimed[0])]
    assert len(claiming) >= 20
    for result in range(len(claims.RESULTS)):
        assert [row.id for row in rows if row.beyond(result)] == []
