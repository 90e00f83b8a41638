"""Annual rates: against closed forms and other quadratures, intervals against what they promise, and the mistakes of a file."""

import csv
import json
import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pandas as pd
import pytest
from report_page import Page
from scipy.integrate import quad
from scipy.optimize import minimize
from scipy.stats import norm
from scipy.stats import t as student
from studies import SINE, study_text, write_study

import rockbatch as rb
from rockbatch.analyses.fragility.bounds import NoCurve
from rockbatch.analyses.fragility.command import risk_lines
from rockbatch.analyses.fragility.curves import Curve, Readings, Undecided
from rockbatch.analyses.fragility.figures import remarks
from rockbatch.analyses.fragility.hazard import Dispersion, Hazard
from rockbatch.analyses.fragility.lognormal import Capacities, Lognormal, fit
from rockbatch.analyses.fragility.risk import Risk, described, described_bound, note, risk_table, risks
from rockbatch.analyses.fragility.section import _notes, _notes_on_rates
from rockbatch.analyses.fragility.study import OVERTURNING, FragilitySpec, read_fragility
from rockbatch.commands.cli import main
from rockbatch.common.errors import InputError
from rockbatch.motions.suites.hazard import HazardCurve
from rockbatch.pier import Pier, RigidBase
from rockbatch.study import Case, load_study

POINTS = [0.05, 0.15, 0.35, 0.7], [1 / 30, 1 / 150, 1 / 700, 1 / 2500]
TABLE = HazardCurve(*POINTS)


def exactly(median, dispersion):
    """A curve without a region: only its rate is asked."""
    return Lognormal(
        median, dispersion, (0, math.inf), (0, math.inf), np.array([[-math.log(median), 1.0]]) / dispersion
    )


def rate_of(curve, hazard):
    return curve.rate(*hazard.quadrature())[0]


# The integral


@pytest.mark.parametrize(("k", "median", "dispersion"), [(3, 0.5, 0.4), (2, 1.0, 0.05), (1.5, 2.0, 0.8), (4, 0.1, 0.3)])
def test_under_a_power_law_the_rate_is_the_closed_form(k, median, dispersion):
    """λ = ν(θ) exp(k²β²/2), Cornell et al. (2002), J. Struct. Eng. 128(4):526–533; 1e-7 by the quadrature at β = 0.05."""
    hazard = HazardCurve([0.25], [1 / 475], slope=k)
    expected = 1 / 475 * (median / 0.25) ** -k * math.exp(0.5 * (k * dispersion) ** 2)
    assert rate_of(exactly(median, dispersion), hazard) == pytest.approx(expected, rel=1e-7)
    two = HazardCurve([0.25, 0.5], [1 / 475, 0.5**k / 475])
    assert rate_of(exactly(median, dispersion), two) == pytest.approx(expected, rel=1e-7)


@pytest.mark.parametrize(("median", "dispersion"), [(0.5, 0.4), (1.0, 0.1)])
def test_under_a_parabola_the_rate_is_the_closed_form(median, dispersion):
    """λ = √φ k0^(1−φ) ν(θ)^φ exp(φ k1² β²/2), φ = 1/(1 + 2 k2 β²), Vamvatsikos (2013), for ν = k0 exp(−k2 ln² x − k1 ln x)."""
    hazard = HazardCurve(*(values[1:] for values in POINTS), shape="quadratic")
    k2, k1, k0 = np.polyfit(np.log(POINTS[0][1:]), np.log(POINTS[1][1:]), 2) * (-1, -1, 1)
    share = 1 / (1 + 2 * k2 * dispersion**2)
    at_median = float(hazard.rate([median])[0])
    expected = math.sqrt(share) * math.exp(k0) ** (1 - share) * at_median**share
    expected *= math.exp(0.5 * share * (k1 * dispersion) ** 2)
    assert rate_of(exactly(median, dispersion), hazard) == pytest.approx(expected, rel=1e-9)
    assert hazard.misfit < 1e-12


def test_between_points_and_beyond_them_the_rate_is_that_of_another_quadrature():
    """∫ ν dP by SciPy over ln x, piece by piece; 1e-8 is what it is asked for."""

    def density(log_x):
        return float(TABLE.rate([math.exp(log_x)])[0]) * norm.pdf((log_x - math.log(0.5)) / 0.4) / 0.4

    edges = [-8.0, *np.log(POINTS[0]), 4.0]
    expected = sum(quad(density, a, b, epsrel=1e-10)[0] for a, b in pairwise(edges))
    assert rate_of(exactly(0.5, 0.4), TABLE) == pytest.approx(expected, rel=1e-8)


def test_added_dispersion_is_a_capacity_times_an_independent_lognormal():
    """Mean of P(x/c) over c by Gauss–Hermite; and the rate is that of the closed form with √(β² + 0.3² + 0.4²)."""
    curve, x = exactly(0.5, 0.3), np.array([0.2, 0.4, 0.9])
    places, weights = np.polynomial.hermite_e.hermegauss(60)
    mean = [(weights * curve.probability(each * np.exp(-0.5 * places))).sum() / weights.sum() for each in x]
    assert curve.widened(0.5).probability(x) == pytest.approx(mean, rel=1e-10)
    assert curve.widened(0.5).median == curve.median
    hazard = HazardCurve([0.25], [1 / 475], slope=2.0)
    expected = 1 / 475 * 2.0**-2 * math.exp(2.0 * (0.3**2 + 0.5**2))
    assert rate_of(curve.widened(0.5), hazard) == pytest.approx(expected, rel=1e-9)
    assert curve.widened(0.0) is curve


# The interval


def suite(rng, records=30, median=0.5, dispersion=0.4):
    return np.exp(rng.normal(math.log(median), dispersion, records))


def by_stripes(capacities, levels):
    beyond = capacities[:, None] <= levels
    return fit(Capacities.of_same_records(levels, ~beyond, beyond))


def by_bisection(capacities, limit):
    low = np.where(capacities > limit, limit, capacities / 1.005)
    high = np.where(capacities > limit, np.inf, capacities * 1.005)
    return fit(Capacities(low, high, np.ones(len(capacities))))


def test_the_interval_of_a_rate_is_that_of_its_profile_likelihood():
    """Least and greatest rate where ℓ has fallen by n/2 ln(1 + t²/n) at most, by SLSQP; 3e-4: between two of 360 rays."""
    capacities = suite(np.random.default_rng(7))
    fitted = by_bisection(capacities, 0.8)
    low = np.where(capacities > 0.8, 0.8, capacities / 1.005)
    high = np.where(capacities > 0.8, np.inf, capacities * 1.005)

    def likelihood(mu, sigma):
        brackets = norm.cdf((np.log(high) - mu) / sigma) - norm.cdf((np.log(low) - mu) / sigma)
        return np.log(np.maximum(brackets, 1e-300)).sum()

    t, n, wider = student(29).ppf(0.975), 30, fitted.dispersion / fitted.most_likely_dispersion
    least = likelihood(math.log(fitted.median), fitted.most_likely_dispersion) - 0.5 * n * math.log1p(t**2 / n)
    x, rates = TABLE.quadrature()

    def log_rate(at):
        return math.log(norm.cdf((np.log(x) - at[0]) / (wider * math.exp(at[1]))) @ rates)

    ends = []
    for sign in (1.0, -1.0):
        found = minimize(
            lambda at, sign=sign: sign * log_rate(at),
            [math.log(fitted.median), math.log(fitted.dispersion)],
            constraints={"type": "ineq", "fun": lambda at: likelihood(at[0], math.exp(at[1])) - least},
            method="SLSQP",
            options={"ftol": 1e-12, "maxiter": 300},
        )
        ends.append(math.exp(log_rate(found.x)))
    assert fitted.rate(x, rates)[1:] == pytest.approx(ends, rel=3e-4)


@pytest.mark.sweep(slow=1)
@pytest.mark.parametrize("added", [pytest.param(0.0, marks=pytest.mark.thorough), 0.4])
@pytest.mark.parametrize("through", [
    lambda capacities: by_bisection(capacities, 0.7),
    lambda capacities: by_stripes(capacities, np.geomspace(0.2, 1.1, 8)),
], ids=["ida", "stripes"])  # fmt: skip
def test_intervals_of_rates_hold_the_truth_about_as_often_as_they_say(through, added):
    """100 suites of 30 records, the same at eight stripes or bisected: 95 % within 5 % is 2.3 deviations."""
    rng = np.random.default_rng(8)
    x, rates = TABLE.quadrature()
    truth = rate_of(exactly(0.5, 0.4).widened(added), TABLE)
    held = 0
    for _ in range(100):
        fitted = through(suite(rng))
        assert isinstance(fitted, Lognormal)
        _, low, high = fitted.widened(added).rate(x, rates)
        held += low <= truth <= high
    assert held == pytest.approx(95, abs=5)


def test_where_the_dispersion_is_open_the_rate_is_too():
    beyond = np.array(
        [[False, True, True], [True, False, True], [False, True, False], [False, False, True], [True, True, False]]
    )
    fitted = fit(Capacities.of_same_records(np.array([0.1, 0.2, 0.3]), ~beyond, beyond))
    _, low, high = fitted.rate(*TABLE.quadrature())
    assert 0 <= low < high == math.inf


@pytest.mark.parametrize(("most", "said"), [(math.inf, True), (0.01, False)])
def test_an_open_upper_bound_of_a_rate_is_said(most, said):
    risk = Risk(None, exactly(0.5, 0.4), 1e-3, (1e-4, most), None, 0.0, 0.0, (1e-3, 1e-3), (0.0, 0.0), (0.2, 0.6))
    spec = FragilitySpec("ida", "PGA", (0.2, 0.4), (), hazard=Hazard(TABLE))
    assert ("leave the upper bound of the rate open" in note(risk, spec)) == said


def curve_of(fitted, readings=None):
    case = Case("rigid", Pier(0.2, 1.0), RigidBase(), {})
    return Curve(case, OVERTURNING, (), fitted, Undecided(0, 0, 0, 0), readings)


@pytest.mark.parametrize(("levels", "is_open"), [([0.25, 0.5], True), ([0.25], False)])
def test_an_upper_bound_above_the_rate_of_the_lowest_point_says_nothing(levels, is_open):
    """ν ∝ x⁻² either way, and a region that reaches down to a median of 0.05: ν(θ) exp(2β²)."""
    rates = [0.25**2 / 475 / x**2 for x in levels]
    hazard = HazardCurve(levels, rates, slope=None if len(levels) > 1 else 2.0)
    region = np.array([[-math.log(0.5), 1.0], [-math.log(0.05), 1.0]]) / 0.3
    spec = FragilitySpec("ida", "PGA", (0.2, 0.6), (), hazard=Hazard(hazard))
    curves = [curve_of(replace(exactly(0.5, 0.3), region=region)), curve_of(exactly(1e30, 0.3))]
    (found, never), _ = risks(curves, spec)
    assert found.interval == pytest.approx((found.rate, math.inf if is_open else 25 / 475 * math.exp(0.18)), rel=1e-6)
    assert (never.rate, np.isfinite(never.contributing).all()) == (0.0, True)
    (row,) = risk_table([never.curve], [never], [], spec, ()).to_dict("records")
    assert (row["p_in_50_years"], "density" in described(never, spec)) == (0.0, False)


def test_a_rate_above_that_of_the_weakest_motions_is_a_bound_by_what_the_hazard_has():
    """ν ∝ x⁻⁴ between 2 and 3 g, and a median of 0.5 g: 0.05 a year by the slope below 2 g, where 2 g come every 1,000 years."""
    hazard = HazardCurve([2.0, 3.0], [1e-3, 1e-3 * (2 / 3) ** 4])
    spec = FragilitySpec("ida", "PGA", (0.2, 0.6), (), hazard=Hazard(hazard))
    curves = [curve_of(exactly(0.5, 0.05)), curve_of(exactly(4.0, 0.05))]
    known, (bound,) = risks(curves, spec)
    assert [risk.curve for risk in known] == curves[1:]
    row, other = risk_table(curves, known, [bound], spec, ()).to_dict("records")
    assert (row["bound"], row["rate_least"]) == ("at least", pytest.approx(1e-3, rel=1e-3))
    assert np.isnan([row["rate_per_year"], row["p_in_50_years"]]).all()
    assert "it has to begin at weaker ones" in row["note"]
    assert other["rate_per_year"] == pytest.approx(1e-3 / 16, rel=0.05)
    assert described_bound(bound, spec)["rate_most"] is None


def test_a_bound_by_the_points_of_a_hazard_keeps_its_digits_beside_its_first_slope():
    """ν ∝ x⁻¹² between 2 and 2.1 g, so that the slope below 2 g gives 2e16 a year at a median of 0.05 g."""
    hazard = HazardCurve([2.0, 2.1], [1e-3, 1e-3 * (2.0 / 2.1) ** 12])
    spec = FragilitySpec("ida", "PGA", (0.2, 0.6), (), hazard=Hazard(hazard))
    _, (bound,) = risks([curve_of(exactly(0.05, 0.05))], spec)
    assert bound.least == pytest.approx(1e-3, rel=1e-6)


def test_a_bound_by_the_points_of_a_hazard_is_the_end_of_the_interval():
    """Medians of 0.5 and 2.5 g leave the rate of 2 g open down to that of motions of 2.5 g: 1e-3 · 0.8⁴ a year."""
    hazard = HazardCurve([2.0, 3.0], [1e-3, 1e-3 * (2 / 3) ** 4])
    spec = FragilitySpec("ida", "PGA", (0.2, 0.6), (), hazard=Hazard(hazard))
    fitted = exactly(0.5, 1e-3)
    wide = replace(fitted, region=np.vstack((fitted.region, exactly(2.5, 1e-3).region)))
    _, (bound,) = risks([curve_of(wide)], spec)
    assert bound.least == pytest.approx(1e-3 * 0.8**4, rel=1e-2)
    alone = [curve_of(replace(fitted, region=None))]
    assert risks(alone, spec) == ([], [])
    (row,) = risk_table(alone, [], [], spec, ()).to_dict("records")
    assert row["note"].startswith("no bound of the rate")


@pytest.mark.parametrize(("withstood", "least"), [
    (None, 0.5e-3), (NoCurve("", below=2.0), 0.5e-3 / 16), (NoCurve(""), None), (exactly(3.0, 0.3), None),
])  # fmt: skip
def test_an_upper_bound_of_a_median_bounds_its_rate_by_half_of_that_of_motions_there(withstood, least):
    """ν ∝ x⁻⁴ with 1e-3 a year at 1 g; undecided runs count as within the limit."""
    hazard = HazardCurve([1.0, 2.0], [1e-3, 1e-3 / 16])
    spec = FragilitySpec("stripes", "PGA", (1.0, 2.0), (), hazard=Hazard(hazard))
    curve = curve_of(NoCurve("every record", below=1.0), withstood and Readings(NoCurve(""), withstood))
    known, bounds = risks([curve], spec)
    assert (known, [bound.least for bound in bounds]) == ([], [] if least is None else [pytest.approx(least)])


@pytest.mark.parametrize("median", [0.5, 2.0])
def test_the_steepest_hazard_that_is_taken_has_the_closed_form_without_an_overflow(median):
    """Curves above some 1/x^70 overflowed far below their points, and a convex parabola counted the rates of its rising side."""
    steep, beta = HazardCurve([0.2], [1e-3], slope=30.0), 0.1
    assert rate_of(exactly(median, beta), steep) == pytest.approx(1e-3 * (0.2 / median) ** 30 * math.exp(4.5), rel=1e-6)
    levels, rates = [0.1, 0.2, 0.4], [1e-2, 1.2e-3, 1.6e-4]  # convex, with its bottom beyond all motions
    convex, straight = HazardCurve(levels, rates, shape="quadratic"), HazardCurve(levels, rates)
    assert rate_of(exactly(0.2, beta), convex) == pytest.approx(rate_of(exactly(0.2, beta), straight), rel=0.05)
    assert (np.diff(convex.rate(np.geomspace(0.1, 0.4 * math.exp(10.0), 100))) < 0).all()


def test_beyond_its_bottom_a_parabola_keeps_the_rate_of_the_bottom():
    convex = HazardCurve([0.1, 0.2, 0.4], [1e-2, 1e-3, 1.6e-4], shape="quadratic")
    assert (np.diff(convex.rate(np.geomspace(0.1, 4.2, 100))) < 0).all()
    assert convex.rate([4.3, 40.0, 4e3]) == pytest.approx([convex.rate([4.22])[0]] * 3, rel=1e-6)
    assert rate_of(exactly(0.2, 0.1), convex) == pytest.approx(1.05e-3, rel=0.05)


def test_a_tail_of_a_hazard_that_is_cut_by_truncation_is_taken():
    levels, rates = [0.5, 1.0, 1.5, 1.6], [1e-4, 1e-6, 1.5e-9, 1e-14]
    whole, cut = HazardCurve(levels, rates), HazardCurve(levels[:-1], rates[:-1])
    assert rate_of(exactly(1.0, 0.2), whole) == pytest.approx(rate_of(exactly(1.0, 0.2), cut), rel=1e-3)


def test_rates_are_integrated_once_for_each_curve(tmp_path, monkeypatch):
    """For a cloud that takes seconds."""
    integrated = []
    rate = Lognormal.rate
    monkeypatch.setattr(Lognormal, "rate", lambda self, *at: integrated.append(self) or rate(self, *at))
    found = rb.fragility(study(tmp_path, HAZARD))
    assert len(integrated) == len(found.curves) == 1


def test_the_row_of_a_rate_is_what_sums_over_fine_steps_of_intensity_say():
    """400 000 steps over eight decades; 3e-4, and 0.02 where one of our steps of 5 % is cut."""
    fitted, total = exactly(0.4, 0.3), math.hypot(0.3, 1.2)
    levels, years = (0.2, 0.6), (50.0, 10.0)
    spec = FragilitySpec("ida", "PGA", levels, (), hazard=Hazard(TABLE, years), dispersions=(Dispersion("a", 1.2),))
    curve = curve_of(fitted, Readings(exactly(0.35, 0.3), NoCurve("none")))
    edges = np.geomspace(1e-5, 1e3, 400_001)
    x, rare = np.sqrt(edges[1:] * edges[:-1]), TABLE.rate([0.7])[0]
    parts = norm.cdf(np.log(x / 0.4) / total) * -np.diff(TABLE.rate(edges))
    rate, above = parts.sum(), parts[x > 0.7].sum()
    of_others = (norm.cdf(np.log(x / 0.35) / total) * -np.diff(TABLE.rate(edges))).sum()
    expected = {
        "median": 0.4, "dispersion": 0.3, "dispersion_added": 1.2, "dispersion_total": total, "rate_per_year": rate,
        "rate_low": rate, "rate_high": rate, "rate_if_withstood": 0.0, "rate_if_exceeded": of_others,
        "rate_below_points": parts[x < 0.05].sum(), "rate_above_points": above,
        "rate_least": rate - above + rare * norm.cdf(math.log(0.7 / 0.4) / total), "rate_most": rate - above + rare,
    }  # fmt: skip
    of_steps = {"rate_below_levels": parts[x < 0.2].sum(), "rate_above_levels": parts[x > 0.6].sum()}
    for time in years:
        expected |= {f"p_in_{time:g}_years{end}": 1.0 - math.exp(-time * rate) for end in ("", "_low", "_high")}
    (found,), _ = risks([curve], spec)
    (row,) = risk_table([curve], [found], [], spec, ()).to_dict("records")
    assert {name: row[name] for name in expected} == pytest.approx(expected, rel=3e-4)
    assert {name: row[name] for name in of_steps} == pytest.approx(of_steps, rel=0.02)
    contributing = x[np.searchsorted(np.cumsum(parts) / rate, (0.05, 0.95))].tolist()
    assert [row["contributing_from"], row["contributing_to"]] == pytest.approx(contributing, rel=2e-3)
    assert {name: row[name] for name in ("case", "limit_state", "measure", "unit")} == {
        "case": "rigid", "limit_state": "overturning", "measure": "PGA", "unit": "g",
    }  # fmt: skip
    density = described(found, spec)["density"]
    low, high = density["x"][0], density["x"][-1]
    assert [low, high] == pytest.approx([0.5 * row["contributing_from"], 2.0 * row["contributing_to"]])
    drawn = np.trapezoid(density["share"], np.log(density["x"]))
    assert drawn == pytest.approx(parts[(low < x) & (x < high)].sum() / rate, rel=0.01)


@pytest.mark.parametrize(("share", "said"), [(0.049, False), (0.051, True)])
def test_a_part_of_a_rate_is_worth_a_word_from_a_twentieth_on(share, said):
    spec = FragilitySpec("stripes", "PGA", (0.2, 0.6), (), hazard=Hazard(TABLE, (10.0, 50.0)))
    quiet = Risk(None, exactly(0.5, 0.4), 0.05, (0.04, 0.06), None, 0.0, 0.0, (0.03, 0.07), (0.0, 0.0), (0.2, 0.6))
    part = share * quiet.rate
    for change, words in (
        ({"below": part}, "below its lowest point"), ({"above": part}, "between 0.03 and 0.07"),
        ({"beyond_levels": (part, 0.0)}, "run, 0.2 g"), ({"beyond_levels": (0.0, part)}, "run, 0.6 g"),
    ):  # fmt: skip
        text = note(replace(quiet, **change), spec)
        assert (words in text, text.startswith("5 %")) == (said, said)
    often = note(replace(quiet, rate=1.2 * share), spec)  # three in 50 years are 0.06
    assert often.startswith("several exceedances in the longest") == said


def test_every_remark_on_a_curve_or_a_rate_stands_behind_its_limit_and_case():
    spec = FragilitySpec("stripes", "PGA", (0.2, 0.6), (), hazard=Hazard(TABLE, (10.0, 50.0)))
    curve = Curve(Case("a", Pier(0.2, 1.0), RigidBase(), {}), OVERTURNING, (), exactly(0.5, 0.4), Undecided(9, 0, 0, 0))
    found = Risk(curve, curve.fitted, 0.05, (0.04, 0.06), None, 0.0, 0.0, (0.03, 0.07), (0.0, 0.0), (0.2, 0.6))
    entries = {"turns": described(replace(found, below=0.02), spec), "quiet": described(found, spec),
               "falls": described(replace(found, above=0.03), spec)}  # fmt: skip
    curves = [
        {
            "limit_state": limit,
            "case": f"on {limit}",
            "columns": {},
            "risk": risk,
            "note": "" if limit == "falls" else f"its {limit}",
        }
        for limit, risk in entries.items()
    ]
    info = {
        "curves": curves,
        "hazard": {"years": [10.0, 50.0]},
        "unit": "g",
        "confidence": 0.9,
        "varied": [],
        "cases": [],
    }
    notes = [f"{limit}, on {limit}: {risk['note']}" for limit, risk in entries.items() if risk["note"]]
    assert [note[:5] for note in notes] == ["turns", "falls"]
    assert risk_lines(info).splitlines()[-2:] == notes
    assert Page(str(_notes_on_rates(info, curves))).text == "".join(f"{note}." for note in notes)
    listed = Page(str(_notes(info, curves))).text.removeprefix("Notes on the curves")
    assert listed == "turns, on turns: its turns.quiet, on quiet: its quiet."
    assert _notes(info, curves[2:]) == ""


def test_a_remark_on_several_curves_stands_once_behind_all_their_names():
    named = [
        ("tilt", "rock", "open"),
        ("tilt", "pads", "open"),
        ("heel", "rock", ""),
        ("heel", "pads", "open"),
        ("heel", "mud", "few"),
    ]
    curves = [{"limit_state": limit, "case": case, "columns": {}, "note": note} for limit, case, note in named]
    said = remarks({"varied": [], "cases": []}, curves, lambda curve: curve["note"])
    assert said == ["tilt, rock, pads; heel, pads: open", "heel, mud: few"]


# The study


def study(tmp_path, hazard, fragility=None, name="study.toml", **more):
    levels = {"measure": "PGA", "levels_g": [0.2, 0.3, 0.4, 0.6, 0.8, 1.2]}
    shapes = [("sine", 0.4), ("sine", 0.6), ("sine", 1.0), ("cosine", 0.5), ("cosine", 0.8), ("ricker", 0.9)]
    text = study_text(
        title="Rates of a small pier", pier={"alpha": 0.2, "p": 2.0}, motions={},
        pulses=[
            SINE | {"name": f"{shape} {t} s", "shape": shape, "amplitude_g": 0.4, "period_s": t, "duration_s": 4.0}
            for shape, t in shapes
        ],
        cases=({"name": "rigid", "base": "rigid"},), numerics={"tolerance": 1e-3},
        fragility=(fragility or levels) | ({} if hazard is None else {"hazard": hazard}) | more,
    )  # fmt: skip
    return write_study(tmp_path, text, name)


HAZARD = {"levels_g": [0.05, 0.2, 0.5], "return_period_years": [50, 475, 2475], "years": [50, 100], "source": "made up"}
ADDED = [{"name": "modelling", "value": 0.3, "source": "judgement"}, {"name": "limit", "value": 0.4}]


@pytest.mark.usefixtures("pages")
def test_the_command_writes_rates_and_what_they_come_from(tmp_path, capsys):
    out = tmp_path / "results"
    assert main(["fragility", str(study(tmp_path, HAZARD, dispersion=ADDED)), "--out", str(out)]) == 0
    printed = capsys.readouterr().out
    with (out / "fragility_risk.csv").open(encoding="utf-8", newline="") as file:
        (row,) = csv.DictReader(file)
    info = json.loads((out / "fragility.json").read_text(encoding="utf-8"))
    (curve,) = info["curves"]
    hazard = HazardCurve(HAZARD["levels_g"], [1 / years for years in HAZARD["return_period_years"]])
    total = exactly(curve["median"], math.hypot(curve["dispersion"], 0.5))
    rate = rate_of(total, hazard)
    assert float(row["rate_per_year"]) == pytest.approx(rate, rel=1e-8)
    assert "of the rate comes from above the hazard's highest point" in row["note"]
    bins = pd.read_csv(out / "fragility_deaggregation.csv")
    assert bins["rate_per_year"].sum() == pytest.approx(rate, rel=1e-8)
    assert bins["share"].sum() == pytest.approx(1.0)
    for low, high, part in zip(bins["above"], bins["up_to"], bins["rate_per_year"], strict=True):
        x = np.geomspace(low, high, 500)
        own = float((total.probability(np.sqrt(x[1:] * x[:-1])) * -np.diff(hazard.rate(x))).sum())
        ends = 1e-3 * rate * ((low == bins["above"].min()) + (high == bins["up_to"].max()))  # what is joined there
        assert own * (1.0 - 1e-3) < part < own * (1.0 + 1e-3) + 1.1 * ends
    for where, name in (("above", "rate_above_points"), ("below", "rate_below_points")):
        assert bins[bins["hazard"] == where]["rate_per_year"].sum() == pytest.approx(float(row[name]), rel=0.02)
    points = pd.read_csv(out / "fragility.csv")
    assert points["p_total"].to_numpy() == pytest.approx(total.probability(points["level"].to_numpy()))
    assert "modelling 0.3, limit 0.4; together 0.5" in printed
    page = Page((out / "analyses.html").read_text(encoding="utf-8"))
    assert page.headings[:2] == ["Fragility", "Annual rates"]
    assert "made up" in page.text
    assert "\\u" not in page.text  # nothing of our own is shown as an escape


def test_without_a_hazard_there_are_no_rates_and_the_points_are_as_they_were(tmp_path):
    found = rb.fragility(study(tmp_path, None))
    assert found.fragility_risk is None
    assert found.fragility_deaggregation is None
    assert "p_total" not in found.fragility
    assert {curve["risk"] for curve in found.info["curves"]} == {None}
    with pytest.raises(InputError, match="no hazard"):
        found.risk()


def test_a_limit_that_all_exceed_has_at_least_half_the_rate_of_the_lowest_level(tmp_path, capsys):
    """Six stations bound the median, five do not: at the median all of five are on one side in 3.1 % of suites."""
    levels = {"measure": "PGA", "levels_g": [20.0, 30.0], "confirm": "levels_g"}
    path = study(tmp_path, HAZARD, fragility=levels)
    assert main(["fragility", str(path), "--out", str(tmp_path / "out")]) == 0
    printed = " ".join(capsys.readouterr().out.split())
    row = pd.read_csv(tmp_path / "out" / "fragility_risk.csv").iloc[0]
    least = 0.5 / 2475 * (0.5 / 20.0) ** (math.log(2475 / 475) / math.log(0.5 / 0.2))
    assert (row["bound"], row["rate_least"]) == ("at least", pytest.approx(least, rel=1e-6))
    chance = -math.expm1(-50 * least)
    assert f"at least {least:.2e} (95 %) at least {100 * chance:.2g} % (95 %)" in printed
    assert "the median is below PGA 20 g (95 %): every record exceeds the limit from 20 on" in printed
    five = path.read_text(encoding="utf-8").split("[[motions.pulse]]")
    path.write_text("[[motions.pulse]]".join([five[0], *five[2:]]), encoding="utf-8")
    found = rb.fragility(path)
    assert (found.info["curves"][0]["median_bound"], found.info["curves"][0]["risk"]) == (None, None)
    assert found.fragility_risk["note"][0].endswith("a bound of the median takes 6 stations")


def test_a_limit_that_no_record_exceeds_has_no_rate(tmp_path):
    """None of six records exceeds it; of all motions of 0.01 g, one of a hundred may, ten times as often as one of 0.02 g."""
    levels = {"measure": "PGA", "levels_g": [0.01, 0.02]}
    found = rb.fragility(study(tmp_path, HAZARD, fragility=levels))
    (row,) = found.fragility_risk.to_dict("records")
    assert row["note"].startswith("no record exceeds the limit up to 0.02")
    assert not {"bound", "rate_per_year", "rate_most"} & row.keys()
    assert found.info["curves"][0]["risk"] is None
    assert found.fragility_deaggregation is None


def test_one_point_and_a_slope_are_said_to_be_that_and_no_curve_no_table(tmp_path, capsys):
    one = {"levels_g": [0.25], "return_period_years": [475], "slope": 3.0}
    found = rb.fragility(study(tmp_path, one))
    assert "all of the rate rests on the slope through one point" in found.fragility_risk["note"].iloc[0]
    assert "est point" not in found.fragility_risk["note"].iloc[0]  # neither the highest nor the lowest
    weak = study(tmp_path, one, fragility={"measure": "PGA", "levels_g": [0.01, 0.02]}, name="weak.toml")
    assert main(["fragility", str(weak), "--out", str(tmp_path / "weak")]) == 0
    assert "No annual rates: they need a curve" in capsys.readouterr().out


def test_rates_under_another_hazard_need_no_run(tmp_path):
    """Twice the hazard is twice the rate, and the study's own hazard gives the table of the command."""
    found = rb.fragility(study(tmp_path, HAZARD, dispersion=ADDED))
    pd.testing.assert_frame_equal(found.risk(), found.fragility_risk, rtol=1e-9, check_dtype=False)
    twice = HazardCurve(HAZARD["levels_g"], [2 / years for years in HAZARD["return_period_years"]])
    doubled = found.risk(twice, years=[0.5, 10])
    assert doubled["rate_per_year"].to_numpy() == pytest.approx(2 * found.fragility_risk["rate_per_year"].to_numpy())
    assert "p_in_10_years" in doubled
    half_a_year = -np.expm1(-0.5 * doubled["rate_per_year"].to_numpy())
    assert doubled["p_in_0.5_years"].to_numpy() == pytest.approx(half_a_year)
    alone = found.risk(added=0.0)
    assert alone["dispersion_total"].to_numpy() == pytest.approx(alone["dispersion"].to_numpy())


def test_a_hazard_in_a_file_is_that_of_its_points(tmp_path):
    (tmp_path / "hazard.csv").write_text(
        "# made up\nlevels_g;return_period_years\n0,05;50\n0,2;475\n0,5;2475\n", encoding="utf-8"
    )
    spec = read_fragility(load_study(study(tmp_path, {"file": "hazard.csv"})))
    assert spec.hazard.curve.levels == (0.05, 0.2, 0.5)
    assert spec.hazard.curve.rates == pytest.approx((1 / 50, 1 / 475, 1 / 2475))
    assert spec.hazard.years == (50.0,)


@pytest.mark.parametrize(
    ("hazard", "message"),
    [
        ({}, "it has no points; write for example levels_g = "),
        ({"levels_g": [0.1, 0.2], "rate_per_year": [475, 2475]}, "return periods are return_period_years"),
        ({"levels_g": [0.1, 0.2], "rate_per_year": [0.01, 0.02]}, "0.02 per year at 0.2 after 0.01 at 0.1: a stronger motion"),
        ({"levels_g": [0.2, 0.1], "rate_per_year": [0.02, 0.01]}, "level 0.1 after 0.2: write them in rising order"),
        ({"levels_g": [0.2, 0.1, 0.3], "rate_per_year": [0.02, 0.01]}, "levels and rates: 3 and 2; write"),
        ({"levels_g": [0.2], "rate_per_year": [0.02]}, "one point says no slope: write a second one, or slope"),
        ({"levels_g": [0.1, 0.2], "rate_per_year": [0.02, 0.01], "slope": 3.0}, "slope and 2 points"),
        ({"levels_g": [0.1, 0.2], "rate_per_year": [0.02, 0.01], "shape": "quadratic"}, "a parabola needs three points"),
        ({"levels_m_s": [0.1, 0.2], "rate_per_year": [0.02, 0.01]}, "levels_m_s: the levels of [fragility] are levels_g"),
        ({"levels_g": [0.1], "rate_per_year": [0.02], "return_period_years": [50]}, "are given; keep one"),
        ({"file": "not_there.csv"}, "not_there.csv: no such file"),
        ({"file": "hazard.csv", "levels_g": [0.1]}, "file and levels_g are given; keep one"),
        ({"levels_g": [0.1, 0.2, 0.4], "rate_per_year": [0.1, 0.09, 0.0001], "shape": "quadratic"}, "does not fall all over"),
        ({"levels_g": [0.2], "rate_per_year": [0.02], "slope": 30.1}, "slope = 30.1: steeper than 1/x^30"),
        ({"levels_g": [0.2, 0.202], "rate_per_year": [0.02, 0.0148]}, "between 0.2 and 0.202, steeper than 1/x^30"),
    ],
)  # fmt: skip
def test_mistakes_of_a_hazard_are_named_with_their_line(tmp_path, hazard, message):
    with pytest.raises(InputError) as caught:
        read_fragility(load_study(study(tmp_path, hazard or {"years": [50]})))
    told = "\n".join(caught.value.messages)
    assert message in told
    assert all("study.toml:" in problem for problem in caught.value.messages)


@pytest.mark.parametrize(
    ("measure", "levels", "points", "most"),
    [
        ("PGA", "levels_g", {"rate_per_year": [2.0, 0.1]}, 10.0), ("PGV", "levels_m_s", {"rate_per_year": [2.0, 0.1]}, 10.0),
        ("PGV", "levels_m_s", {"return_period_years": [0.5, 10.0]}, 10.0),
        ("PGA", "levels_g", {"rate_per_year": [2.001, 0.1]}, None),
        ("PGA", "levels_g", {"return_period_years": [0.499, 10.0]}, None),
        ("PGA", "levels_g", {"rate_per_year": [2.0, 0.1]}, 10.01), ("PGV", "levels_m_s", {"rate_per_year": [2.0, 0.1]}, 10.01),
    ],
)  # fmt: skip
def test_a_hazard_is_read_as_it_is_written_up_to_what_is_usual(tmp_path, measure, levels, points, most):
    hazard = {levels: [0.5, most or 10.0], **points, "years": [5, 50], "source": "made up"}
    file = study(tmp_path, hazard, fragility={"measure": measure, levels: [0.2, 0.4]})
    if most == 10.0:
        expected = Hazard(HazardCurve((0.5, 10.0), (2.0, 0.1)), (5, 50), "made up")
        assert read_fragility(load_study(file)).hazard == expected
        return
    with pytest.raises(InputError, match="write confirm = ") as caught:
        read_fragility(load_study(file))
    (problem,) = caught.value.messages
    name, value = (levels, most) if most else next((name, values[0]) for name, values in points.items())
    assert f"{name} = {value:g}" in problem


@pytest.mark.parametrize(("content", "message"), [
    ("levels_g,rate_per_yr\n0.1,0.01\n", '"rate_per_yr": unknown column; did you mean rate_per_year?'),
    ("levels_g,rate_per_year\n0.1,often\n", 'hazard.csv:2: rate_per_year = "often": expected a number'),
    ("levels_g,rate_per_year\n0.1\n", "hazard.csv:2: 1 cells below 2 column names"),
    ("levels_g,rate_per_year\n", "expected a line of column names, and a line for each row"),
    ("levels_g,rate_per_year\n0.1,nan\n0.2,0.001\n", 'hazard.csv:2: rate_per_year = "nan": expected a finite number'),
    ("levels_g,rate_per_year\n1_0.1,0.01\n0.2,0.001\n", 'hazard.csv:2: levels_g = "1_0.1": expected'),
    ("rate_per_year,return_period_years\n0.1,10\n", "it needs levels_g and one of rate_per_year"),
])  # fmt: skip
def test_mistakes_in_a_file_of_a_hazard_are_named_with_its_line(tmp_path, content, message):
    (tmp_path / "hazard.csv").write_text(content, encoding="utf-8")
    with pytest.raises(InputError) as caught:
        read_fragility(load_study(study(tmp_path, {"file": "hazard.csv"})))
    assert message in "\n".join(caught.value.messages)


@pytest.mark.parametrize("points", ["0.1,0.01\n0.2,0.02", "0.2,0.02\n0.1,0.01", "0.2,0.02"])
def test_mistakes_in_the_points_of_a_file_stand_at_the_line_that_names_it(tmp_path, points):
    (tmp_path / "hazard.csv").write_text(f"levels_g,rate_per_year\n{points}\n", encoding="utf-8")
    path = study(tmp_path, {"years": [50], "file": "hazard.csv"})
    line = path.read_text(encoding="utf-8").splitlines().index('file = "hazard.csv"') + 1
    with pytest.raises(InputError) as caught:
        read_fragility(load_study(path))
    (problem,) = caught.value.messages
    assert problem.startswith(f"{path}:{line}: [fragility.hazard]: ")


def test_mistakes_of_added_dispersions_are_named(tmp_path):
    wrong = [{"name": "a", "value": 0.3}, {"name": "a", "value": 30}, {"value": 0.1}]
    with pytest.raises(InputError) as caught:
        read_fragility(load_study(study(tmp_path, HAZARD, dispersion=wrong)))
    told = "\n".join(caught.value.messages)
    for message in ("above 0 and at most 2", "its name is given twice", "name is missing"):
        assert message in told


def test_what_several_exceedances_and_tails_mean_is_said(tmp_path):
    """A site where the pier overturns every few years, by intensities far below those that were run."""
    often = {"levels_g": [0.02, 0.05, 0.5], "rate_per_year": [20.0, 5.0, 0.2], "confirm": "rate_per_year"}
    found = rb.fragility(study(tmp_path, often, dispersion=[{"name": "modelling", "value": 0.8}]))
    said = found.fragility_risk["note"].iloc[0]
    assert "several exceedances in the longest of the periods" in said
    assert "comes from below the lowest intensity that was run, 0.2 g" in said


def test_of_a_file_of_doubtful_values_the_first_is_asked_about(tmp_path):
    (tmp_path / "hazard.csv").write_text("levels_g,rate_per_year\n0.1,50\n20,40\n30,30\n")
    file = study(tmp_path, {"file": "hazard.csv", "years": [50]}, fragility={"measure": "PGA", "levels_g": [0.2, 0.4]})
    with pytest.raises(InputError) as caught:
        read_fragility(load_study(file))
    (problem,) = caught.value.messages
    assert "levels_g = 20" in problem


def test_a_study_without_a_fragility_table_is_told_what_to_write():
    with pytest.raises(InputError, match=r"\[fragility\] is missing; write \[fragility\] with measure"):
        rb.fragility(rb.Study.from_toml(study_text()))
