"""Cloud analysis: against other ways to the same line and share, closed forms, its own promises, and the mistakes of a file."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from fragility_samples import of_statuses
from report_page import Page
from scipy.integrate import quad
from scipy.optimize import brentq, minimize
from scipy.special import expit
from scipy.stats import beta, chi2, kstest, linregress, norm, t
from studies import seven_pulses, study_text, write_study

import rockbatch as rb
from rockbatch.analyses.fragility import cloud
from rockbatch.analyses.fragility.cloud import Cloud, Demands, Logistic, Regression, fit, fit_event
from rockbatch.analyses.fragility.cloud_tables import counts, note_on_cloud
from rockbatch.analyses.fragility.curves import CloudPoint, assess
from rockbatch.analyses.fragility.limit_states import EXCEEDED, LEFT_OUT, UNDECIDED, WITHSTOOD
from rockbatch.analyses.fragility.study import read_fragility
from rockbatch.common.errors import InputError
from rockbatch.motions.suites.hazard import HazardCurve
from rockbatch.study import load_study
from rockbatch.study.suite import ground_motions

LN_A, B, SIGMA, ALPHA = math.log(0.6), 1.2, 0.5, (-1.5, 3.0)
LIMIT = 0.3


def made_up(rng, records=40, sigma=SIGMA):
    """Runs of a pier of which the line and the share are known."""
    x = np.exp(rng.normal(-0.7, 0.8, records))
    overturned = rng.random(records) < 1 / (1 + np.exp(-ALPHA[0] - ALPHA[1] * np.log(x)))
    demand = np.exp(LN_A + B * np.log(x) + sigma * rng.normal(size=records))
    return Demands(x, demand, overturned, np.zeros(records, dtype=bool))


def fitted(runs, floor=1e-9, **more):
    found = fit(runs, LIMIT, floor, **more)
    assert isinstance(found, Cloud), found
    return found


# The line


def test_a_demand_on_the_line_is_no_exact_line():
    """Of five demands whose deviations from a line have neither mean nor slope, the middle one is on it."""
    log_x, apart = np.linspace(-2.0, 2.0, 5), 0.1 * np.array([1.0, -1.0, 0.0, -1.0, 1.0])
    x = np.exp(np.append(log_x, [2.5, 3.0]))
    demand = np.exp(np.append(LN_A + log_x + apart, [0.0, 0.0]))
    line = fitted(Demands(x, demand, x > np.exp(2.2), np.zeros(7, dtype=bool))).line
    assert (line.intercept, line.slope) == pytest.approx((LN_A, 1.0))


def test_without_censored_demands_the_line_is_that_of_least_squares():
    """SciPy's linregress on the logarithms, and σ² = SSE/(n − 2); to 1e-8."""
    runs = made_up(np.random.default_rng(1))
    line = fitted(runs).line
    stands = ~runs.overturned
    x, y = np.log(runs.x[stands]), np.log(runs.demand[stands])
    expected = linregress(x, y)
    residuals = y - expected.intercept - expected.slope * x
    sigma = math.sqrt(residuals @ residuals / (len(x) - 2))
    assert (line.intercept, line.slope, line.sigma) == pytest.approx(
        (expected.intercept, expected.slope, sigma), rel=1e-8
    )


def test_the_draws_of_the_line_are_students():
    """t_(n−2) about the line at both ends of it and about its slope, χ²_(n−2) about SSE/σ²; Kolmogorov–Smirnov of 1000 draws."""
    runs = made_up(np.random.default_rng(2), 12)
    line = fitted(runs).line
    stands = ~runs.overturned
    x, y = np.log(runs.x[stands]), np.log(runs.demand[stands])
    expected, free = linregress(x, y), len(x) - 2
    mean, spread = x.mean(), ((x - x.mean()) ** 2).sum()
    squares = ((y - expected.intercept - expected.slope * x) ** 2).sum()
    drawn = {"slope": (line.draws[:, 1] - expected.slope) / expected.stderr}
    for at in (x.min(), x.max() + 1.0):
        error = math.sqrt(squares / free * (1 / len(x) + (at - mean) ** 2 / spread))
        drawn[f"at {at}"] = (line.draws[:, :2] @ [1.0, at] - expected.intercept - expected.slope * at) / error
    for values in drawn.values():
        assert kstest(values, t(free).cdf).statistic < 0.06
    assert kstest(squares / line.draws[:, 2] ** 2, chi2(free).cdf).statistic < 0.06


def test_censored_demands_make_the_line_of_a_tobit_model():
    """Densities of the demands above the floor and probabilities of the others, by Nelder–Mead over a, b, ln σ; 1e-5."""
    runs = made_up(np.random.default_rng(3), 80)
    floor = 0.15
    line = fitted(runs, floor).line
    stands = ~runs.overturned
    x, y = np.log(runs.x[stands]), np.log(runs.demand[stands])
    above = y > math.log(floor)
    assert 10 < (~above).sum() < 60

    def negative(p):
        mean, sigma = p[0] + p[1] * x, math.exp(p[2])
        seen = norm.logpdf(y[above], mean[above], sigma).sum()
        return -seen - norm.logcdf(math.log(floor), mean[~above], sigma).sum()

    searched = minimize(
        negative, [0.0, 1.0, -1.0], method="Nelder-Mead", options={"xatol": 1e-10, "fatol": 1e-13, "maxiter": 5000}
    )
    sigma = math.exp(searched.x[2]) * math.sqrt(above.sum() / (above.sum() - 2))
    assert (line.intercept, line.slope, line.sigma) == pytest.approx((*searched.x[:2], sigma), rel=1e-5)


# The share that overturns


def test_the_share_is_that_of_the_penalised_likelihood():
    """ℓ + ½ ln|I|, maximised by Nelder–Mead; 1e-5 is how far such a search goes."""
    runs = made_up(np.random.default_rng(5))
    share = fitted(runs).overturning
    x = np.column_stack((np.ones(len(runs.x)), np.log(runs.x)))

    def negative(at):
        p = 1 / (1 + np.exp(-x @ at))
        likelihood = np.log(np.where(runs.overturned, p, 1 - p)).sum()
        return -likelihood - 0.5 * math.log(np.linalg.det(x.T @ (x * (p * (1 - p))[:, None])))

    searched = minimize(negative, [-1.0, 1.0], method="Nelder-Mead", options={"xatol": 1e-10, "fatol": 1e-13})
    assert (share.intercept, share.slope) == pytest.approx(tuple(searched.x), rel=1e-5)


@pytest.mark.parametrize(("records", "overturned"), [((10, 12), (2, 9)), ((2, 3), (1, 2))])
def test_of_two_intensities_the_share_is_the_closed_form(records, overturned):
    """The penalty of a saturated model is half a record in each cell: ln((k + ½)/(n − k + ½)) at either intensity.

    Draws are those of Jeffreys' posterior, a beta distribution at either, without correlation; Kolmogorov–Smirnov of 1000.
    """
    x = np.repeat([0.5, 2.0], records)
    happened = np.concatenate([np.arange(n) < k for n, k in zip(records, overturned, strict=True)])
    found = fit_event(x, happened)
    assert (found.limit, found.line) == (1.0, None)
    share, drawn = found.overturning, []
    for intensity in (0.5, 2.0):
        k, n = happened[x == intensity].sum(), (x == intensity).sum()
        assert share.intercept + share.slope * math.log(intensity) == pytest.approx(
            math.log((k + 0.5) / (n - k + 0.5)), abs=1e-9
        )
        drawn.append(expit(share.draws @ [1.0, math.log(intensity)]))
        assert kstest(drawn[-1], beta(k + 0.5, n - k + 0.5).cdf).statistic < 0.06
    assert abs(np.corrcoef(drawn)[0, 1]) < 0.1


def test_draws_of_a_share_stay_finite_however_unlikely_many_records_are_together():
    """The likelihood of 600 tosses of a coin is 2⁻⁶⁰⁰, and its square no number."""
    x = np.column_stack((np.ones(600), np.repeat([-1.0, 1.0], 300)))
    draws = cloud._posterior(np.zeros(2), np.linalg.inv(0.25 * x.T @ x), x, np.arange(600) % 2 == 0)
    assert draws.std(axis=0) == pytest.approx(2.0 / math.sqrt(600.0), rel=0.1)


def test_intensities_that_part_what_overturned_from_the_rest_leave_a_finite_share():
    x = np.array([0.1, 0.2, 0.3, 0.4, 0.5, 0.6])
    found = fit_event(x, x > 0.35)
    assert 0.3 < found.median < 0.4
    assert 0 < found.overturning.slope < 100


# The curve


def exactly(limit=LIMIT, share=ALPHA):
    logistic = None if share is None else Logistic(*share, np.array([share]))
    return Cloud(limit, Regression(LN_A, B, SIGMA, np.array([[LN_A, B, SIGMA]])), logistic, 0.95, 0.0)


def test_without_overturning_the_curve_is_lognormal():
    """θ = (d/a)^(1/b), β = σ/b; and its rate under a power law is the closed form of tests/analyses/fragility/test_risk.py."""
    curve = exactly(share=None)
    theta, beta = (LIMIT / 0.6) ** (1 / B), SIGMA / B
    assert curve.median == pytest.approx(theta, rel=1e-9)
    assert curve.dispersion == pytest.approx(beta, rel=1e-9)
    assert curve.probability(np.array([0.2, 0.7])) == pytest.approx(norm.cdf(np.log([0.2 / theta, 0.7 / theta]) / beta))
    wider = curve.widened(0.3)
    assert wider.median == pytest.approx(theta, rel=1e-9)
    assert wider.dispersion == pytest.approx(math.hypot(beta, 0.3), rel=1e-6)
    rate, *_ = wider.rate(*HazardCurve([0.25], [1 / 475], slope=2.0).quadrature())
    expected = 1 / 475 * (theta / 0.25) ** -2 * math.exp(2 * (beta**2 + 0.3**2))
    assert rate == pytest.approx(expected, rel=1e-5)


@pytest.mark.parametrize("added", [0.3, 1.5, 2.5])
@pytest.mark.parametrize(("sigma", "share"), [(0.5, None), (0.1, None), (0.3, (-4.0, 12.0))])
def test_an_added_dispersion_is_that_of_a_normal_ln_x_however_wide(added, sigma, share):
    """√(β² + added²) of a lognormal curve; with a share SciPy's integral over it, to 1e-7."""
    line = Regression(LN_A, B, sigma, np.array([[LN_A, B, sigma]]))
    curve = Cloud(LIMIT, line, share and Logistic(*share, np.array([share])), 0.95, 0.0)
    wider, at = curve.widened(added), 0.4
    if share is None:
        assert wider.dispersion == pytest.approx(math.hypot(sigma / B, added), rel=1e-7)
    assert wider.probability(np.array([at]))[0] == pytest.approx(
        quad(lambda z: norm.pdf(z) * curve.probability(at * np.exp(added * np.array([z])))[0], -8, 8, limit=400)[0],
        abs=1e-7,
    )


def test_intervals_are_quantiles_of_the_curves_that_are_drawn():
    """Of lognormal ones, each with the closed forms above: the third and the last but two of a hundred hold 96 %."""
    rng = np.random.default_rng(8)
    draws = np.column_stack(
        [LN_A + 0.1 * rng.normal(size=101), B + 0.2 * rng.normal(size=101), rng.uniform(0.3, 0.7, 101)]
    )
    curve = Cloud(LIMIT, Regression(LN_A, B, SIGMA, draws), None, 0.96, 0.0)
    a, b, sigma = draws.T
    x, rates = np.array([0.1, 0.4, 0.9]), np.array([0.05, 0.02, 0.001])
    shares = norm.cdf((a[:, None] + b[:, None] * np.log(x) - math.log(LIMIT)) / sigma[:, None])
    for found, drawn in (
        (curve.median_interval, np.exp((math.log(LIMIT) - a) / b)), (curve.dispersion_interval, sigma / b),
        (curve.rate(x, rates)[1:], shares @ rates), *zip(zip(*curve.band(x), strict=True), shares.T, strict=True),
    ):  # fmt: skip
        assert found == pytest.approx((np.sort(drawn)[2], np.sort(drawn)[-3]), rel=1e-6)
    draws[:3, 1] *= -1.0  # three fall with the intensity
    low, high = curve.rate(x, rates)[1:]
    assert low < math.inf == high


def test_the_curve_is_that_of_total_probability_and_rises_to_one():
    x = np.geomspace(0.05, 5, 9)
    share = 1 / (1 + np.exp(-ALPHA[0] - ALPHA[1] * np.log(x)))
    line = norm.cdf((LN_A + B * np.log(x) - math.log(LIMIT)) / SIGMA)
    curve = exactly()
    assert curve.probability(x) == pytest.approx(line * (1 - share) + share)
    median = brentq(lambda at: curve.probability(np.array([at]))[0] - 0.5, 0.1, 2)
    assert curve.median == pytest.approx(median, rel=1e-9)


@pytest.mark.slow
def test_intervals_hold_the_truth_about_as_often_as_they_say():
    """60 clouds of 40 records: medians and rates 95 %, less 3 deviations of 2.8 %; and the medians scatter as widely as their
    intervals say, to 3 deviations of 9 %: wider ones would hold the truth, too."""
    rng = np.random.default_rng(7)
    x, rates = HazardCurve([0.05, 0.15, 0.35, 0.7], [1 / 30, 1 / 150, 1 / 700, 1 / 2500]).quadrature()
    kept = slice(300, 1000, 4)  # where the rate comes from, enough for a count
    x, rates = x[kept], rates[kept]
    truth = exactly()
    held, medians, widths = np.zeros(2), list[float](), list[float]()
    for _ in range(60):
        found = fitted(made_up(rng), 0.05)
        _, low, high = found.rate(x, rates)
        least, most = found.median_interval
        held += [low <= truth.rate(x, rates)[0] <= high, least <= truth.median <= most]
        medians.append(math.log(found.median))
        widths.append(math.log(most / least) if least > 0 else math.inf)
    assert (held / 60 >= 0.87).all()
    assert np.median(widths) / (2 * norm.ppf(0.975) * np.std(medians)) == pytest.approx(1.0, abs=0.3)


@pytest.mark.parametrize(
    ("runs", "words"),
    [
        (Demands(np.full(6, 0.5), np.linspace(0.1, 0.5, 6), np.zeros(6, bool), np.zeros(6, bool)), "have the same intensity"),
        (Demands(np.linspace(1, 2, 6), np.linspace(0.5, 0.1, 6), np.zeros(6, bool), np.zeros(6, bool)), "does not grow"),
        (Demands(np.linspace(1, 2, 6), np.zeros(6), np.zeros(6, bool), np.zeros(6, bool)), "0 records stand with a demand"),
        (Demands(np.linspace(1, 2, 6), np.zeros(6), np.ones(6, bool), np.zeros(6, bool)), "every record exceeds the limit"),
        (Demands(np.linspace(1, 2, 6), np.linspace(0.1, 0.5, 6), np.arange(6) < 2, np.zeros(6, bool)), "overturn does not grow"),
    ],
)  # fmt: skip
def test_clouds_without_a_curve_say_why(runs, words):
    assert words in fit(runs, LIMIT, 1e-3).reason


def test_events_without_a_curve_say_why():
    x = np.linspace(0.1, 0.5, 5)
    assert "no record exceeds the limit up to 0.5" in fit_event(x, np.zeros(5, bool)).reason
    assert "every record exceeds the limit from 0.1 on" in fit_event(x, np.ones(5, bool)).reason
    assert fit_event(np.array([]), np.array([], dtype=bool)).reason == "no record counts"


def test_the_share_of_an_event_has_no_median_where_no_record_was_run():
    """All but the second record fall, and in the reciprocals only it does: the share leads its median far from the records."""
    x = np.array([0.4, 0.72, 0.78, 1.02, 1.44, 1.46, 1.74, 2.95])
    fell = np.arange(8) != 1
    below, above = fit_event(x, fell), fit_event(1.0 / x, ~fell)
    assert below.reason == "the median by the fit is below all intensities, which begin at 0.4"
    assert above.reason.startswith("the median by the fit is above all intensities, which end at 2.5")
    assert 0.4 < fit_event(x, np.arange(8) > 3).median < 2.95


def test_the_bound_of_a_median_is_the_end_of_its_interval():
    """It was the nearest intensity, of a fit that leaves a median twice as far among the records open, or any."""
    x = np.array([0.4, 0.72, 0.78, 1.02, 1.44, 1.46, 1.74, 2.95])
    fell = np.arange(8) != 1
    below, above = fit_event(x, fell), fit_event(1.0 / x, ~fell)
    share = cloud._share(np.log(x), fell, np.arange(8))
    fitted_share = Cloud(1.0, None, share, 0.95, float(np.log(x).mean()), 8)
    assert fitted_share.median < 0.4 < 0.8 < fitted_share.median_interval[1]
    assert below.below == fitted_share.median_interval[1]
    assert (above.is_bound, above.reason.split(": ")[1]) == (
        False,
        "its interval has no end among them, and nothing bounds it",
    )
    of_four = fit_event(x, fell, station=np.arange(8) // 2)
    assert (of_four.is_bound, of_four.reason.split(": ")[1]) == (False, "there is no interval, and nothing bounds it")


def test_where_no_record_exceeds_a_limit_the_line_bounds_the_median_by_its_interval():
    rng = np.random.default_rng(1)
    x = np.exp(rng.normal(0.0, 0.5, 12))
    demand = 0.6 * x * np.exp(rng.normal(0.0, 0.3, 12))
    runs = Demands(x, demand, np.zeros(12, bool), np.zeros(12, bool))
    near, far = (fit(runs, times * demand.max(), 1e-3) for times in (1.01, 9.0))
    draws = cloud._line(np.log(x), np.log(demand), np.array([]), np.array([]), np.arange(12)).draws
    low = np.quantile((np.log(1.01 * demand.max()) - draws[:, 0]) / draws[:, 1], 0.025)
    assert (near.above, far.above) == (pytest.approx(min(np.exp(low), x.max()), rel=0.02), pytest.approx(x.max()))


@pytest.mark.parametrize(
    ("stations", "expected"), [(range(12), 6), (np.arange(12) // 2, 1), (np.arange(12) // 3, None)]
)
def test_records_on_one_side_bound_a_median_by_the_sixth_station(stations, expected):
    """Six on one side of their median have a chance of 1.6 %, five of 3.1 %, where an interval of 95 % leaves 2.5 % out."""
    x = np.linspace(0.1, 1.2, 12)
    stronger = fit_event(x, np.zeros(12, bool), station=np.array(stations))
    weaker = fit_event(1.0 / x, np.ones(12, bool), station=np.array(stations))
    if expected is None:
        assert stronger.reason.endswith("stronger motions are needed: a bound of the median takes 6 stations")
        assert weaker.reason.endswith("weaker motions are needed: a bound of the median takes 6 stations")
    found = (stronger.above, 1.0 / weaker.below)
    assert found == pytest.approx((x[expected], x[expected]) if expected is not None else (0.0, 0.0))


# The study


def study(tmp_path, fragility=None, motions=None, check=0.5, **more):
    text = study_text(
        pier={"alpha": 0.2, "p": 2.0}, motions=motions or {"scale": [0.6, 1.0, 1.7, 2.6]}, pulses=seven_pulses(0.3),
        cases=({"name": "rigid", "base": "rigid"},), numerics={"tolerance": 1e-3},
        check=[{"name": "rotation", "demand": "theta_max_over_alpha", "at_most": check, "reason": "margin"}],
        fragility={"method": "cloud", "measure": "PGV"} | (fragility or {}), **more,
    )  # fmt: skip
    return write_study(tmp_path, text)


@pytest.mark.usefixtures("pages")
def test_the_command_runs_every_record_as_it_is_and_fits_what_its_table_shows(tmp_path):
    """The line again from the points of the CSV."""
    found = rb.fragility(study(tmp_path))
    assert sorted(found.fragility_runs["scale"].unique()) == [0.6, 1.0, 1.7, 2.6]
    assert len(found.fragility_runs) == 7 * 4
    rows = found.fragility_cloud
    of_rotation = rows[rows["limit_state"] == "rotation"]
    runs = found.fragility_runs.set_index(["record", "scale"])["theta_max_over_alpha"]
    factors = found.fragility_scales.set_index(["record", "level"])["scale"]
    for _, row in of_rotation[of_rotation["counts"] == "line"].iterrows():
        scale = factors[row["record"]].iloc[(factors[row["record"]].index - row["intensity"]).map(abs).argmin()]
        assert row["demand"] == pytest.approx(runs[row["record"], round(scale, 6)], rel=1e-8)
    curve = next(curve for curve in found.curves if curve.limit.name == "rotation")
    expected = fit(
        Demands(of_rotation["intensity"].to_numpy(), of_rotation["demand"].to_numpy(),
        (of_rotation["counts"] == "overturned").to_numpy(), np.zeros(len(of_rotation), dtype=bool),
        of_rotation["record"].factorize()[0]), 0.5, 0.005,
    )  # fmt: skip
    assert curve.fitted.median == pytest.approx(expected.median, rel=1e-8)
    overturning = next(curve for curve in found.curves if curve.limit.name == "overturning")
    assert overturning.fitted.line is None
    assert overturning.fitted.median > curve.fitted.median
    html = next(path for path in found.save(tmp_path / "out") if path.suffix == ".html").read_text(encoding="utf-8")
    assert "Cloud analysis of records as they are: a line through the logarithms" in Page(html).text
    assert "each counts once at every scale" in found.info["scales"]["said"]
    levels = list(found.info["levels"])
    assert levels == sorted(levels)
    assert levels == pytest.approx(sorted(of_rotation["intensity"].unique()), rel=1e-9)


def test_the_readings_are_those_of_all_doubtful_runs_counted_either_way(tmp_path):
    """Of 28 runs of 7 records five overturned, one flew and one failed."""
    loaded = load_study(study(tmp_path))
    ended = dict.fromkeys([(n, 3) for n in (0, 1, 4, 5, 6)], "overturned") | {(2, 3): "flight", (3, 2): "failed"}
    noise = np.random.default_rng(7).normal(0.0, 0.3, (7, 4))
    seen = []

    def simulate(runs):
        of_record = [sorted(point.intensity for point in runs.points if point.motion == m) for m in range(7)]
        places = [(point.motion, of_record[point.motion].index(point.intensity)) for point in runs.points]
        x = np.array([point.intensity for point in runs.points])
        status = np.array([ended.get(place, "ok") for place in places])
        demand = np.where(status == "ok", 0.5 * x * np.exp([noise[place] for place in places]), math.nan)
        seen.append((x, demand, status, np.array([point.motion for point in runs.points])))
        return of_statuses(list(status)).assign(theta_max_over_alpha=demand)

    curves = {
        curve.limit.name: curve
        for curve in assess(loaded, read_fragility(loaded), ground_motions(loaded).motions, simulate)
    }
    ((x, demand, status, record),) = seen
    fell, open_, none, every = status == "overturned", np.isin(status, ["flight", "failed"]), status == "", status != ""
    counted = [(~open_, fell, none), (every, fell | open_, none), (every, fell, open_)]
    of_demands = [
        fit(Demands(x[of], demand[of], over[of], within[of], record[of]), 0.5, 0.005) for of, over, within in counted
    ]
    of_events = [fit_event(x[of], over[of], 0.95, record[of]) for of, over, _ in counted]
    for name, expected in (("rotation", of_demands), ("overturning", of_events)):
        curve = curves[name]
        found = (curve.fitted, curve.readings.exceeded, curve.readings.withstood)
        medians = [one.median for one in expected]
        assert [one.median for one in found] == pytest.approx(medians, rel=1e-9), name
        assert len({round(median, 2) for median in medians}) == 3
        assert curve.undecided.words == "2 of 28 runs undecided: 1 flew, 1 failed"


@pytest.mark.parametrize(("beyond", "words"), [
    (0, "only 0 records of 9 exceed the limit: the curve extrapolates"), (1, "only one record exceeds the limit"),
    (2, "only 2 records of 9 exceed the limit"), (3, ""),
])  # fmt: skip
def test_what_a_curve_rests_on_is_said(tmp_path, beyond, words):
    """Nine records, of which two are below a hundredth of the limit, 0.5; and one overturned, or none."""
    spec = read_fragility(load_study(study(tmp_path)))
    runs = [
        CloudPoint(n, 0.3, 0.7 if n < beyond else 0.1, "ok", EXCEEDED if n < beyond else WITHSTOOD) for n in range(7)
    ]
    runs += 2 * [CloudPoint(8, 0.3, 0.004, "ok", WITHSTOOD)]
    for curve in (exactly(), exactly(share=None)):
        said = note_on_cloud(SimpleNamespace(limit=spec.limits[1], cloud=runs, fitted=curve), spec)
        assert said.pop() == "2 records below 1 % of the limit are censored: they count as small"
        assert (curve.overturning is None) == (
            "no record overturns: their share counts as 0 at every intensity" in said
        )
        assert said[0].startswith(words) if words else len(said) == (curve.overturning is None)


@pytest.mark.parametrize(("fragility", "message"), [
    ({"levels_m_s": [0.2, 0.4]}, 'levels_m_s = [0.2, 0.4]: does not apply to method = "cloud"'),
    ({"most_scale": 4.0}, 'most_scale = 4.0: does not apply to method = "cloud"'),
    ({"censored_below": 1.5}, "censored_below = 1.5: expected a number above 0 and below 1"),
    ({"method": "stripes", "levels_m_s": [0.2, 0.4], "censored_below": 0.1}, 'does not apply to method = "stripes"'),
])  # fmt: skip
def test_keys_of_other_methods_are_named(tmp_path, fragility, message):
    with pytest.raises(InputError) as caught:
        read_fragility(load_study(study(tmp_path, fragility)))
    assert message in "\n".join(caught.value.messages)


@pytest.mark.parametrize("intercept", [1.0, -1.0])
def test_a_share_that_is_never_small_or_never_large_has_no_bounded_dispersion(intercept):
    """P is between 0.48 and 0.88, or between 0.12 and 0.52, however weak or strong the motion: x16 is 0, or x84 infinite."""
    share = Logistic(intercept, 1.0 / cloud._WIDEST, np.array([[intercept, 1.0 / cloud._WIDEST]]))
    curve = Cloud(1.0, None, share, 0.95, 0.0)
    assert curve.dispersion == math.inf
    assert curve.dispersion_interval == (math.inf, math.inf)


@pytest.mark.parametrize(("demand", "state", "status", "counted", "of_an_event"), [
    (0.2, WITHSTOOD, "ok", "line", "within"),
    (0.0051, WITHSTOOD, "ok", "line", "within"),
    (0.0049, WITHSTOOD, "ok", "below", "within"),
    (0.7, EXCEEDED, "ok", "line", "exceeds"),
    (0.51, UNDECIDED, "ok", "line", "within"),
    (math.inf, EXCEEDED, "overturned", "overturned", "exceeds"),
    (math.nan, UNDECIDED, "failed", "undecided", "undecided"),
    (math.nan, UNDECIDED, "flight", "undecided", "undecided"),
    (0.2, LEFT_OUT, "ok", "left out", "left out"),
])  # fmt: skip
def test_how_a_run_counts_is_said_in_a_word(tmp_path, demand, state, status, counted, of_an_event):
    """A limit of 0.5, of which demands up to a hundredth are censored; and an event, to which no demand matters."""
    loaded = load_study(study(tmp_path))
    spec = read_fragility(loaded)
    run = CloudPoint(0, 0.3, demand, status, state)
    found = {rule.name: counts(run, SimpleNamespace(limit=rule), spec) for rule in spec.limits}
    assert found == {"overturning": of_an_event, "rotation": counted}


def test_a_cloud_without_exceedances_has_a_bound_with_its_confidence_and_no_rate(tmp_path):
    """One record stands at each intensity: its share, 0, was the bound of a rate as if all motions had it."""
    hazard = {"hazard": {"levels_m_s": [0.1, 0.3, 1.0], "return_period_years": [30, 150, 2500]}}
    found = rb.fragility(study(tmp_path, check=0.9, motions={"scale": [0.5]}, fragility=hazard))
    curve = next(curve for curve in found.info["curves"] if curve["limit_state"] == "overturning")
    bound = curve["median_bound"]
    assert (bound["is"], bound["confidence"]) == ("above", 0.95)
    assert bound["above"] == pytest.approx(sorted(point["level"] for point in curve["points"])[1], rel=1e-9)
    assert "(95 %): no record exceeds the limit" in curve["note"]
    assert curve["risk"] is None
    row = found.fragility_risk.set_index("limit_state").loc["overturning"]
    assert row["note"].startswith("no record exceeds the limit up to ")
