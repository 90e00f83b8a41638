"""Lognormal fragility by maximum likelihood: against other ways to the same maximum, and against its own promises.

Whatever is compared with :func:`fit` here goes another way: the probit regression by Fisher scoring, closed forms, and
constrained optimisation for the profile likelihood.
"""

import math

import numpy as np
import pytest
from scipy.optimize import brentq, minimize, minimize_scalar
from scipy.stats import binom, norm, t

from rockbatch.analyses.fragility.bounds import NoCurve
from rockbatch.analyses.fragility.lognormal import Capacities, Lognormal, _intervals, fit

LEVELS = np.array([0.2, 0.3, 0.4, 0.6, 0.7, 0.8, 0.9, 1.0])
RECORDS = np.full(8, 40.0)
EXCEEDED = np.array([0, 0, 0, 4, 6, 13, 18, 26])


def fresh_records(levels, records, exceeded):
    """Capacities of fresh records at each level, by their number and by how many exceeded the limit."""
    low, high = np.r_[np.zeros(len(levels)), levels], np.r_[levels, np.full(len(levels), np.inf)]
    count = np.r_[exceeded, records - exceeded].astype(float)
    return Capacities(low[count > 0], high[count > 0], count[count > 0])


STRIPES = fresh_records(LEVELS, RECORDS, EXCEEDED)


def fitted(capacities, confidence=0.95):
    found = fit(capacities, confidence)
    assert isinstance(found, Lognormal), found
    return found


def bracketed(capacities, tolerance, limit=math.inf):
    """Brackets around known capacities, open above ``limit``."""
    low = np.where(capacities > limit, limit, capacities / math.sqrt(1 + tolerance))
    high = np.where(capacities > limit, np.inf, capacities * math.sqrt(1 + tolerance))
    return Capacities(low, high, np.ones(len(capacities)))


def log_likelihood(theta, beta, levels=LEVELS, records=RECORDS, exceeded=EXCEEDED):
    return binom.logpmf(exceeded, records, norm.cdf(np.log(levels / theta) / beta)).sum()


def test_stripes_are_a_probit_regression_on_ln_im():
    """Fisher scoring of the generalised linear model z = a + b ln x, to rounding: 1e-9 of θ and β."""
    design = np.column_stack([np.ones(8), np.log(LEVELS)])
    ab = np.array([0.0, 1.0])
    for _ in range(100):
        z = design @ ab
        p, slope = norm.cdf(z), norm.pdf(z)
        weight = RECORDS * slope**2 / (p * (1 - p))
        working = z + (EXCEEDED / RECORDS - p) / slope
        ab = np.linalg.solve(design.T @ (weight[:, None] * design), design.T @ (weight * working))
    found = fitted(STRIPES)
    assert found.median == pytest.approx(math.exp(-ab[0] / ab[1]), rel=1e-9)
    assert found.most_likely_dispersion == pytest.approx(1 / ab[1], rel=1e-9)


def test_records_that_never_overturned_are_censored_as_in_a_truncated_analysis():
    """The densities of the m collapses times (1 − Φ) for the others, maximised over θ and ln β; 1e-6: the search."""
    capacities = np.exp(np.random.default_rng(2).normal(0.0, 0.4, 40))
    limit = 1.1
    collapses, others = capacities[capacities <= limit], (capacities > limit).sum()

    def negative(x):
        mu, beta = x[0], math.exp(x[1])
        return -norm.logpdf(np.log(collapses), mu, beta).sum() - others * norm.logsf((math.log(limit) - mu) / beta)

    searched = minimize(negative, [0.1, -1.0], method="Nelder-Mead", options={"xatol": 1e-10, "fatol": 1e-13})
    found = fitted(bracketed(capacities, 1e-4, limit))
    assert others > 10
    assert found.median == pytest.approx(math.exp(searched.x[0]), rel=1e-6)
    assert found.most_likely_dispersion == pytest.approx(math.exp(searched.x[1]), rel=1e-6)


def test_intervals_end_where_the_profile_likelihood_meets_students_quantile():
    """By n/2 ln(1 + t²/n) with n = 320 records; β times that of the sample over that of the likelihood.

    The profile over the other parameter is by a bounded search, its ends by root finding; 1e-4: between two of 360 rays.
    """
    found = fitted(STRIPES)
    theta, beta, n = found.median, found.most_likely_dispersion, RECORDS.sum()
    least = log_likelihood(theta, beta) - 0.5 * n * math.log1p(t(n - 1).ppf(0.975) ** 2 / n)

    def of_median(theta):
        return -minimize_scalar(lambda b: -log_likelihood(theta, b), bounds=(0.05, 3), method="bounded").fun - least

    def of_dispersion(beta):
        return -minimize_scalar(lambda t: -log_likelihood(t, beta), bounds=(0.3, 5), method="bounded").fun - least

    assert found.median_interval == pytest.approx(
        (brentq(of_median, 0.5 * theta, theta), brentq(of_median, theta, 2 * theta)), rel=1e-4
    )
    assert found.dispersion_interval == pytest.approx(
        np.array([brentq(of_dispersion, 0.5 * beta, beta), brentq(of_dispersion, beta, 2 * beta)])
        * found.dispersion
        / beta,
        rel=1e-4,
    )


def test_the_band_leaves_one_half_where_the_interval_of_the_median_ends():
    found = fitted(STRIPES)
    low, high = found.band(np.array(found.median_interval))
    assert (high[0], low[1]) == pytest.approx((0.5, 0.5), abs=1e-9)
    assert found.probability(np.array([found.median])) == pytest.approx(0.5)


@pytest.mark.thorough
def test_intervals_hold_the_truth_about_as_often_as_they_say():
    """Suites of 30 records, by IDA up to a level that a sixth of them survives: 95 % within 5 % is 2.3 deviations of 100."""
    rng = np.random.default_rng(4)
    held = np.zeros(2)
    for _ in range(100):
        found = fitted(bracketed(np.exp(rng.normal(0.0, 0.5, 30)), 0.01, limit=1.6))
        held += [
            found.median_interval[0] <= 1.0 <= found.median_interval[1],
            found.dispersion_interval[0] <= 0.5 <= found.dispersion_interval[1],
        ]
    assert held / 100 == pytest.approx([0.95, 0.95], abs=0.05)


@pytest.mark.thorough
def test_the_same_records_at_every_level_do_not_count_as_many_suites():
    """100 suites of 30 records at 12 levels: as fresh ones they would hold the median about 60 times in 100, not 95."""
    rng = np.random.default_rng(5)
    levels = np.linspace(0.4, 1.8, 12)
    held = np.zeros(2)
    for _ in range(100):
        beyond = np.exp(rng.normal(0.0, 0.5, (30, 1))) <= levels
        fresh = fitted(fresh_records(levels, np.full(12, 30), beyond.sum(axis=0)))
        same = fitted(Capacities.of_same_records(levels, ~beyond, beyond))
        assert (same.median, same.most_likely_dispersion) == (fresh.median, fresh.most_likely_dispersion)
        held += [one.median_interval[0] <= 1.0 <= one.median_interval[1] for one in (fresh, same)]
    assert held[0] < 75
    assert held[1] == pytest.approx(95, abs=5)


def test_records_that_are_fresh_at_every_level_are_not_stretched():
    """Each of 24 000 records at one level only: its score varies as the likelihood says, and five percent is plenty."""
    rng = np.random.default_rng(6)
    beyond = rng.random((8, 3000)) < norm.cdf(np.log(LEVELS / 0.7) / 0.4)[:, None]
    own = np.repeat(np.eye(8, dtype=bool), 3000, axis=0)
    exceeded = own & beyond.reshape(-1)[:, None]
    same = fitted(Capacities.of_same_records(LEVELS, own & ~exceeded, exceeded))
    fresh = fitted(fresh_records(LEVELS, np.full(8, 3000), beyond.sum(axis=1)))
    assert np.ptp(same.median_interval) == pytest.approx(np.ptp(fresh.median_interval), rel=0.05)
    assert np.ptp(same.dispersion_interval) == pytest.approx(np.ptp(fresh.dispersion_interval), rel=0.05)


def test_records_that_are_all_the_same_leave_no_less_open_than_fresh_ones():
    levels, beyond = np.array([0.1, 0.2, 0.3, 0.4]), np.array(5 * [[False, True, False, True]])
    same = fitted(Capacities.of_same_records(levels, ~beyond, beyond))
    fresh = fitted(fresh_records(levels, np.full(4, 5), np.array([0, 5, 0, 5])))
    assert same.median_interval[0] < fresh.median_interval[0] < fresh.median_interval[1] < same.median_interval[1]
    assert same.dispersion_interval[1] > fresh.dispersion_interval[1]


@pytest.mark.parametrize(("exceeded", "words"), [
    ([0, 0, 0], "no record exceeds the limit up to 0.3, and stronger motions"),
    ([5, 5, 5], "every record exceeds the limit from 0.1 on, and weaker motions"),
    ([0, 0, 5], "no record exceeds the limit at 0.2, every one at 0.3, and motions between"),
    ([0, 2, 5], "0.2 is the only level at which some records exceed the limit and others do not"),
    ([3, 2, 1], "does not grow with the intensity"),
    ([2, 2, 2], "does not grow with the intensity"),
    ([5, 0, 0], "does not grow with the intensity"),
])  # fmt: skip
def test_data_without_a_maximum_give_the_reason(exceeded, words):
    found = fit(fresh_records(np.array([0.1, 0.2, 0.3]), np.full(3, 5), np.array(exceeded)))
    assert isinstance(found, NoCurve)
    assert words in found.reason


@pytest.mark.parametrize("confidence", [0.8, 0.9, 0.95, 0.99])
@pytest.mark.parametrize("stations", range(3, 10))
def test_all_on_one_side_of_the_median_bound_it_as_rarely_wrong_as_an_interval(stations, confidence):
    """At the median all 2ⁿ outcomes are as likely; the one with all on a side is either rarer than that, or bounds nothing."""
    x, run = np.array([1.0]), np.ones((stations, 1))
    none = fit(Capacities.of_same_records(x, run, 0 * run), confidence)
    every = fit(Capacities.of_same_records(x, 0 * run, run), confidence)
    rare = 0.5**stations <= 0.5 - 0.5 * confidence
    assert (none.above, every.below) == ((1.0, 1.0) if rare else (0.0, math.inf))
    assert (none.is_bound, "a bound of the median takes" in none.reason) == (rare, not rare)
    fresh = fit(fresh_records(x, np.array([stations]), np.array([0])), confidence)
    brackets = fit(Capacities.of_brackets(np.ones(stations), np.full(stations, np.inf)), confidence)
    assert fresh == brackets == none


def test_a_bound_is_where_six_stations_are_though_fewer_records_were_run_beyond():
    """Nine records at 0.5 g, four of them at 1 g; two of the others are of one station."""
    low, high = np.r_[np.ones(4), np.full(5, 0.5)], np.full(9, np.inf)
    assert fit(Capacities.of_brackets(low, high)).above == 0.5
    assert not fit(Capacities.of_brackets(low, high, np.array([0, 0, 1, 1, 2, 2, 3, 3, 4]))).is_bound
    assert fit(Capacities.of_brackets(0.0 * low, 1.0 / low)).below == 2.0
    between = fit(Capacities.of_brackets(low, 4.0 - low))
    assert (between.above, between.below) == (0.5, 3.5)


def test_a_median_beyond_the_levels_is_bounded_by_its_interval():
    """Few exceed the limit at the highest level: the median by the fit is above, and its interval begins below it."""
    levels, records = np.array([0.2, 0.4, 0.8]), np.full(3, 20)
    found = fit(fresh_records(levels, records, np.array([0, 1, 8])))
    more = fitted(fresh_records(np.r_[levels, 8.0], np.r_[records, 1], np.array([0, 1, 8, 1])))
    assert found.reason.startswith("the median by the fit is above all intensities, which end at 0.8")
    assert more.median > 0.8
    assert found.above == pytest.approx(more.median_interval[0], rel=0.05)
    assert fit(fresh_records(levels, np.full(3, 1), np.array([0, 0, 1]))).above == 0.0


def test_capacities_in_one_bracket_give_the_reason():
    found = fit(Capacities(np.array([1.0, 1.0, 0.0]), np.array([1.01, 1.01, 1.2]), np.ones(3)))
    assert isinstance(found, NoCurve)
    assert "no record exceeds the limit at 1, every one at 1.01" in found.reason
    assert fit(Capacities(np.array([]), np.array([]), np.array([]))).reason == "no record counts"


def test_intervals_that_the_data_leave_open_are_infinite():
    """Six exceedances of 15, hardly more at the highest level: β, and with it θ, may be as large as one likes."""
    found = fitted(fresh_records(np.array([0.1, 0.2, 0.3]), np.full(3, 5), np.array([1, 2, 3])))
    assert found.median_interval[1] == found.dispersion_interval[1] == math.inf


@pytest.mark.parametrize(("slope", "rises"), [(3e-3, True), (3e-4, False)])
def test_a_share_that_hardly_grows_has_a_median_up_to_a_thousand_times_the_levels(slope, rises):
    """Two levels are fitted exactly: z = ±slope at one deviation of ln x to either side of its mean."""
    levels, records = np.array([0.5, 2.0]), np.full(2, 1e9)
    found = fit(fresh_records(levels, records, np.round(records * norm.cdf([-slope, slope]))))
    if rises:
        assert isinstance(found, Lognormal)
        assert (found.median, found.dispersion) == (
            pytest.approx(1.0, rel=1e-3),
            pytest.approx(math.log(2) / slope, rel=1e-3),
        )
    else:
        assert "does not grow" in found.reason


@pytest.mark.parametrize(
    ("crossing", "bounded"), [((0.2, 0.8), (False, True)), ((-0.8, -0.2), (True, False)), ((-0.4, 0.4), (False, False))]
)
def test_a_region_that_crosses_no_slope_bounds_the_median_on_one_side_at_most(crossing, bounded):
    """θ = exp(−a/b): near b = 0 it is 0 with a > 0, and infinite with a < 0; β = 1/b is infinite."""
    left, right = crossing
    (low, high), (least, most) = _intervals(np.array([(left, -1.0), (right, -1.0), (right, 2.0), (left, 2.0)]))
    assert (low > 0.0, high < math.inf) == bounded
    assert (least, most) == (0.5, math.inf)
    assert not bounded[0] or low == pytest.approx(math.exp(-right / 2.0))
    assert not bounded[1] or high == pytest.approx(math.exp(-left / 2.0))


@pytest.mark.filterwarnings("error")
def test_narrow_brackets_beside_open_ones_are_fitted():
    """Of two of seven records: a step of the search leads where a bracket of 0.3 % has no probability."""
    low, high = np.array([1.6605, 1.5802, 0, 2, 2, 0, 0]), np.array([1.6647, 1.5841, 1.5, math.inf, math.inf, 1.5, 1.5])
    found = fit(Capacities.of_brackets(low, high, np.arange(7)))

    def less(point):
        with np.errstate(divide="ignore"):
            z1, z2 = ((np.log(ends) - point[0]) / math.exp(point[1]) for ends in (low, high))
        return -np.log(norm.cdf(z2) - norm.cdf(z1)).sum()

    mu, ln_beta = minimize(less, [0.4, -1.0], method="Nelder-Mead", options={"xatol": 1e-9, "fatol": 1e-12}).x
    assert (found.median, found.most_likely_dispersion) == pytest.approx((math.exp(mu), math.exp(ln_beta)), rel=1e-6)
