"""Curves of arrays, against SciPy's general optimiser and regression; what the arrays cannot determine is refused."""

import numpy as np
import pytest
import scipy.optimize
import scipy.stats

from rockbatch.analyses.fragility.statistics import cloud, fragility
from rockbatch.common.errors import InputError


@pytest.mark.parametrize("seed", range(2))
def test_counts_have_the_curve_of_the_binomial_likelihood(seed):
    """SciPy's Nelder–Mead on the likelihood of Baker (2015), eq. 11; 1e-5 is what it is asked for."""
    rng = np.random.default_rng(seed)
    levels = np.sort(rng.uniform(0.1, 2.0, 7))
    n = rng.integers(10, 40, 7)
    exceeded = rng.binomial(n, scipy.stats.norm.cdf(np.log(levels / 0.7) / 0.4))

    def unlikely(parameters):
        p = scipy.stats.norm.cdf(np.log(levels / np.exp(parameters[0])) / np.exp(parameters[1]))
        return -scipy.stats.binom.logpmf(exceeded, n, p).sum()

    best = scipy.optimize.minimize(
        unlikely, [-0.3, -1.0], method="Nelder-Mead", options={"xatol": 1e-8, "fatol": 1e-12}
    )
    curve = fragility(levels, exceeded, n)
    assert curve.median == pytest.approx(np.exp(best.x[0]), rel=1e-5)
    assert curve.most_likely_dispersion == pytest.approx(np.exp(best.x[1]), rel=1e-5)
    assert curve.median_interval[0] < curve.median < curve.median_interval[1]


def test_a_cloud_without_overturnings_is_a_regression_in_logarithms():
    rng = np.random.default_rng(1)
    im = rng.uniform(0.1, 1.0, 40)
    demand = 0.05 * im**1.3 * np.exp(0.3 * rng.standard_normal(40))
    line = scipy.stats.linregress(np.log(im), np.log(demand))
    curve = cloud(im, demand, limit=0.03)
    assert curve.median == pytest.approx(np.exp((np.log(0.03) - line.intercept) / line.slope), rel=1e-8)
    sigma = np.sqrt(((np.log(demand) - line.intercept - line.slope * np.log(im)) ** 2).sum() / 38)
    assert curve.dispersion == pytest.approx(sigma / line.slope, rel=1e-8)


def test_runs_that_overturned_exceed_whatever_their_demand():
    im = np.linspace(0.1, 1.0, 40)
    demand, fell = 0.01 * im * np.tile([0.8, 1.2], 20), (np.arange(40) % 5 == 0) & (im > 0.5)
    without, with_fallen = cloud(im, demand, 0.008), cloud(im, np.where(fell, np.nan, demand), 0.008, overturned=fell)
    assert with_fallen.median < without.median


@pytest.mark.parametrize(("call", "message"), [
    (lambda: fragility([0.1, 0.2], [0, 5], 4), r"exceeded\[1\]: must be from 0 to n"),
    (lambda: fragility([0.0, 0.2], [0, 3], 4), r"levels\[0\]: must be above 0"),
    (lambda: fragility([0.1, 0.2], [0, 0], 4), "no record exceeds the limit up to 0.2"),
    (lambda: fragility([0.1, 0.2], [1], 4), "as long as each other"),
    (lambda: cloud([0.1, np.nan], [1, 1], 1.0), r"im\[1\]: must be above 0"),
    (lambda: cloud([0.1, 0.2], [1, 1], 0.0), "limit = 0: must be above 0"),
    (lambda: cloud([0.1, 0.2, 0.3], [1, 1, 1], 1.0), "where a line needs 4"),
    (lambda: cloud([0.1, 0.2, 0.3, 0.4], [1, 2, 3, 4], 1.0), "all demands are on one line"),
])  # fmt: skip
def test_arrays_that_determine_no_curve_are_refused_with_the_reason(call, message):
    with pytest.raises(InputError, match=message):
        call()
