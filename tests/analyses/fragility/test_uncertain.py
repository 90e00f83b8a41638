"""Drawn inputs: their distributions, what they contribute to a curve, and a limit that is lognormal in the drawn quantity."""

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.special import ndtr
from studies import PADS, RIGID, seven_pulses, study_text, write_study

import rockbatch as rb
from rockbatch.analyses.fragility.bounds import NoCurve
from rockbatch.analyses.fragility.command import added
from rockbatch.analyses.fragility.curves import assess
from rockbatch.analyses.fragility.lognormal import Capacities, contribution, fit
from rockbatch.analyses.fragility.study import read_fragility
from rockbatch.analyses.fragility.tables import _about_drawn, points
from rockbatch.analyses.fragility.uncertain import Correlation, Draws, Input, Uncertain
from rockbatch.batch.journal import Journal
from rockbatch.batch.threads import Threads
from rockbatch.batch.waves import Waves
from rockbatch.common.errors import InputError
from rockbatch.results.columns import columns
from rockbatch.study import load_study
from rockbatch.study.suite import ground_motions

ALPHA, RESTITUTION = Input("alpha", "lognormal", 0.1), Input("restitution", "uniform", (0.85, 0.95))
HEAVY = {"alpha": 0.2, "p": 2.0, "mass_t": 500.0}
LEVELS = {"measure": "PGA", "levels_g": [0.2, 0.4, 0.6, 0.8]}


def written(tmp_path, uncertain, cases=(RIGID | {"restitution": 0.9}, PADS | {"epsilon": 0.1}), **fragility):
    text = study_text(
        pier=HEAVY, pulses=seven_pulses(0.4), cases=cases, numerics={"tolerance": 1e-3},
        check=[{"name": "uplift", "demand": "heel_uplift_mm", "at_most": 60.0, "reason": "keys"}],
        fragility=LEVELS | {"uncertain": uncertain} | fragility,
    )  # fmt: skip
    return write_study(tmp_path, text)


# Draws


def test_a_draw_depends_on_seed_level_record_and_input_alone():
    alone, both = (Uncertain(inputs).scores(20, 3) for inputs in ((ALPHA,), (ALPHA, RESTITUTION)))
    assert (alone[:, 0] == both[:, 0]).all()
    assert not (both[:, 0] == both[:, 1]).any()
    assert not (alone == Uncertain((ALPHA,)).scores(20, 2)).any()
    assert not (alone == Uncertain((ALPHA,), seed=2).scores(20, 3)).any()


def test_the_records_at_a_level_share_out_the_distribution():
    """Latin hypercube: of n records one in each n-th of the probability."""
    shares = ndtr(Uncertain((ALPHA, RESTITUTION)).scores(40, 0)) * 40
    assert [sorted(column) for column in np.floor(shares).T.tolist()] == 2 * [list(range(40))]


@pytest.mark.parametrize("value", [1.0, -1.0, 0.6])
def test_correlated_inputs_have_their_correlation(value):
    pair = Correlation(("alpha", "restitution"), value)
    scores = Uncertain((ALPHA, RESTITUTION), (pair,)).scores(2000, 0)
    assert np.corrcoef(scores.T)[0, 1] == pytest.approx(value, abs=1e-12 if abs(value) == 1 else 0.03)
    assert scores.std(axis=0) == pytest.approx(1.0, abs=0.03)


def test_inputs_have_their_distributions():
    assert ALPHA.value(2.0, 0.2) == pytest.approx(0.2 * math.exp(0.2))
    assert [RESTITUTION.value(score, 0.9) for score in (-9.0, 0.0, 9.0)] == pytest.approx([0.85, 0.9, 0.95])


def test_what_cannot_be_is_drawn_again_and_the_others_stay(tmp_path):
    """e = 0.9 with a dispersion of 0.05: 1.8 % lie above 1."""
    study = load_study(written(tmp_path, {"lognormal": {"restitution": 0.05}}))
    uncertain = read_fragility(study).uncertain
    scores, draws = uncertain.scores(400, 0)[:, 0], Draws(uncertain, study.cases, 400)
    drawn = np.array([draws.at(0, record, 0).case.base.restitution for record in range(400)])
    at_once = 0.9 * np.exp(0.05 * scores)
    possible = at_once <= 1
    assert 0.98 <= possible.mean() < 1
    assert drawn[possible] == pytest.approx(at_once[possible], rel=1e-14)
    assert (drawn <= 1).all()
    assert draws.at(1, 7, 0).case == study.cases[1]  # springs have no such restitution


# What they contribute


def made_stripes(n, rng):
    """Intervals of n capacities with ln x = ln 0.5 + 0.2 s₁ − 0.1 s₂ + 0.3 ε, and the scores; drawn anew at each stripe."""
    root, effects = np.linalg.cholesky([[1.0, 0.6], [0.6, 1.0]]), np.array([0.2, -0.1])
    own, levels = 0.3 * rng.standard_normal(n), [0.2, 0.35, 0.5, 0.7, 1.0]
    scores = [rng.standard_normal((n, 2)) @ root.T for _ in levels]
    capacity = np.concatenate([0.5 * np.exp(s @ effects + own) for s in scores])
    level, of_record = np.repeat(levels, n), np.hstack([np.eye(n) for _ in levels])
    low, high = np.where(capacity <= level, 0.0, level), np.where(capacity <= level, level, np.inf)
    return Capacities(low, high, np.ones(len(low)), of_record), np.vstack(scores)


@pytest.mark.slow
def test_the_contribution_is_that_of_made_up_capacities():
    """β² = 0.3² + 0.2² − 2·0.6·0.2·0.1 + 0.1²: the second part is that of the inputs, in the mean over suites of 40 records."""
    rng, correlation = np.random.default_rng(1), np.array([[1.0, 0.6], [0.6, 1.0]])
    suites = 12
    found = [contribution(*made_stripes(40, rng), correlation) for _ in range(suites)]
    of_inputs = 0.2**2 - 2 * 0.6 * 0.2 * 0.1 + 0.1**2
    assert sum(share.interval[0] ** 2 <= of_inputs <= share.interval[1] ** 2 for share in found) >= 0.85 * suites
    squares = np.array([share.dispersion**2 for share in found])
    assert abs(squares.mean() - of_inputs) < 3 * squares.std() / math.sqrt(suites)
    errors = np.array([(np.array(share.effects) - [0.2, -0.1]) / share.errors for share in found])
    assert np.abs(errors.mean(axis=0)).max() < 3 / math.sqrt(suites)
    assert 0.7 < errors.std() < 1.4
    whole = fit(made_stripes(150, rng)[0]).dispersion
    assert whole == pytest.approx(math.sqrt(0.09 + of_inputs), rel=0.1)


def test_contributions_have_the_errors_of_another_parametrisation():
    """ln x = μ + s·c + σ ε by differences of ℓ; the covariance of the scores of the records is not below their information."""
    capacities, scores = made_stripes(60, np.random.default_rng(5))
    correlation, steps = np.array([[1.0, 0.6], [0.6, 1.0]]), 1e-4 * np.eye(4)
    with np.errstate(divide="ignore"):
        ends = np.log([capacities.low, capacities.high])

    def of_records(p):
        below, above = ndtr((ends - p[0] - scores @ p[2:]) / p[1])
        return capacities.of_record @ np.log(above - below)

    def slopes(p):
        return np.array([of_records(p + step) - of_records(p - step) for step in steps]) / 2e-4

    best = np.array([math.log(0.5), 0.4, 0.2, -0.1])
    for _ in range(20):  # Newton's method
        information = np.array([(slopes(best - h) - slopes(best + h)).sum(axis=1) for h in steps]) / 2e-4
        best = best + np.linalg.solve(information, slopes(best).sum(axis=1))
    root = np.linalg.inv(np.linalg.cholesky(information)).T
    own = root.T @ slopes(best)
    variances, axes = np.linalg.eigh(own @ own.T * 60 / 59)
    assert variances.min() < 1.0 < variances.max()
    covariance = (root @ axes * np.maximum(variances, 1.0) @ axes.T @ root.T)[2:, 2:]
    effects, share = best[2:], correlation @ covariance
    square = effects @ correlation @ effects - np.trace(share)
    reach = 1.2815515655446004 * math.sqrt(4 * effects @ share @ correlation @ effects + 2 * np.trace(share @ share))
    found = contribution(capacities, scores, correlation, 0.8)
    assert found.effects == pytest.approx(effects, rel=1e-4)
    assert found.errors == pytest.approx(np.sqrt(np.diag(covariance)), rel=1e-4)
    assert square > reach
    assert np.array([found.dispersion, *found.interval]) ** 2 == pytest.approx(
        [square, square - reach, square + reach], rel=1e-3
    )


def made_capacities(n, rng, effects=(0.6, -0.2)):
    """Capacities of n records with ln x = ln 0.5 + effects · s + 0.3 ε, known to 1e-4, and the scores s."""
    scores = rng.standard_normal((n, 2))
    capacity = 0.5 * np.exp(scores @ effects + 0.3 * rng.standard_normal(n))
    return Capacities(capacity / 1.0001, capacity * 1.0001, np.ones(n), np.eye(n)), scores


def test_effects_on_capacities_that_are_known_are_those_of_a_regression():
    """Least squares of ln x over the scores; 0.1 of a deviation: the stretch to the covariance of 800 records' own scores."""
    capacities, scores = made_capacities(800, np.random.default_rng(3))
    log_x, design = np.log(capacities.low), np.column_stack([np.ones(800), scores])
    found = contribution(capacities, scores, np.eye(2))
    coefficients, (squares,), *_ = np.linalg.lstsq(design, log_x)
    covariance = np.linalg.inv(design.T @ design)[1:, 1:] * squares / 800
    assert found.effects == pytest.approx(tuple(coefficients[1:]), rel=1e-4)
    assert found.errors == pytest.approx(tuple(np.sqrt(np.diag(covariance))), rel=0.1)
    square = coefficients[1:] @ coefficients[1:]
    reach = 1.96 * math.sqrt(4.0 * coefficients[1:] @ covariance @ coefficients[1:])
    assert found.dispersion**2 == pytest.approx(square - np.trace(covariance), rel=1e-3)
    assert np.diff(np.square(found.interval)) == pytest.approx(2.0 * reach, rel=0.1)
    assert np.mean(np.square(found.interval)) == pytest.approx(found.dispersion**2, rel=1e-6)


def test_two_inputs_that_go_together_contribute_what_they_do_as_one():
    capacities, scores = made_capacities(200, np.random.default_rng(1))
    one = contribution(capacities, scores[:, :1], np.eye(1))
    both = contribution(capacities, scores[:, [0, 0]], np.ones((2, 2)))
    assert both.dispersion == pytest.approx(one.dispersion, rel=1e-3)
    assert sum(both.effects) == pytest.approx(one.effects[0], rel=1e-6)


@pytest.mark.parametrize("known", [20, 19])
def test_inputs_without_chance_have_no_error_if_enough_capacities_are_known(known):
    scores = np.random.default_rng(1).standard_normal((25, 2))
    x, correlation = 0.5 * np.exp(scores @ [0.6, -0.2]), np.array([[1.0, 0.5], [0.5, 1.0]])
    low, high = x / 1.01, np.where(np.arange(25) < known, 1.01 * x, np.inf)
    low[24], high[24] = 0.0, 1.01 * x[24]  # exceeded at its lowest intensity: no more known than those that never were
    found = contribution(Capacities(low, high, np.ones(25), np.eye(25)), scores, correlation)
    if known < 20:
        assert (
            found.reason == "with them the runs beyond the limit are separated from the others: more of both are needed"
        )
        return
    assert found.effects == pytest.approx((0.6, -0.2), abs=0.01)
    assert found.errors == (0.0, 0.0)
    whole = math.sqrt(found.effects @ correlation @ found.effects)
    assert (found.dispersion, *found.interval) == pytest.approx(3 * (whole,), rel=1e-12)


def test_a_reason_for_no_curve_is_given_once():
    few, flat = NoCurve("no record counts"), NoCurve("too few runs")
    assert _about_drawn(SimpleNamespace(drawn_share=few, fitted=few)) == ""
    assert _about_drawn(SimpleNamespace(drawn_share=flat, fitted=few)).endswith("is not known: too few runs")


def test_few_runs_do_not_tell_what_inputs_contribute():
    capacities, scores = made_capacities(19, np.random.default_rng(1))
    assert contribution(capacities, scores, np.eye(2)).reason == "19 runs or capacities are too few to fit 4 parameters"
    assert contribution(*made_capacities(20, np.random.default_rng(1)), np.eye(2)).dispersion > 0.0


@pytest.mark.slow
def test_overturning_in_proportion_to_a_lognormal_slenderness_is_lognormal(tmp_path):
    """Slender block under a half-sine, e = 0.9, ω_p/p = 5: it overturns from 3.289147 α g on (test_overturning).

    With α lognormal each capacity is that with its own α, all of the dispersion is that of α, and the fit is that of the drawn
    sample; tolerance 1e-4 of the bisection, and as much for the pulse that is linear between 400 samples a period.
    """
    period = 2 * math.pi / 5
    text = study_text(
        pier={"alpha": 1e-3, "p": 1.0},
        pulses=[
            {"name": "pulse", "shape": "half-sine", "amplitude_g": 1e-3}
            | {"period_s": period, "dt_s": period / 400, "duration_s": period}
        ],
        cases=({"base": "rigid", "restitution": 0.9},),
        numerics={"substeps": 1, "quiet_s": 0.0},
        fragility={"method": "ida", "measure": "PGA", "levels_g": [2.0e-3, 6.0e-3], "tolerance": 1e-4}
        | {"hunt_step": 1.0, "window": 0.001, "uncertain": {"lognormal": {"alpha": 0.1}}},
    )  # fmt: skip
    study = load_study(write_study(tmp_path, text))
    spec = read_fragility(study)
    motions = [replace(ground_motions(study).motions[0], name=f"pulse {n}") for n in range(16)]
    of_runs = replace(study, varied=spec.uncertain.columns)
    with Journal(tmp_path / "runs.csv.part", columns(of_runs), {}) as journal:
        (curve,) = assess(study, spec, motions, Waves(of_runs, journal, Threads(1)))
        rows = [row for _, row in journal.rows()]
    alpha = {row["record"]: float(row["drawn_alpha"]) for row in rows}
    assert len({(row["record"], row["drawn_alpha"]) for row in rows}) == 16  # the same at all intensities of a record
    drawn = np.array([alpha[motions[m].name] for (_, m), _ in curve.capacities])
    capacity = np.array([cap.decided.high for _, cap in curve.capacities])
    assert capacity / drawn == pytest.approx(3.289147, rel=2e-4)
    logarithms = np.log(drawn)
    assert logarithms.std() == pytest.approx(0.1, rel=0.1)
    assert curve.fitted.median == pytest.approx(3.289147 * math.exp(logarithms.mean()), rel=2e-4)
    assert curve.fitted.dispersion == pytest.approx(logarithms.std(ddof=1), rel=2e-3)
    assert curve.drawn == ("alpha",)
    assert (curve.drawn_share.dispersion, *curve.drawn_share.effects) == pytest.approx((0.1, 0.1), rel=2e-3)


# Runs


def read_all(folder):
    return {path.name: path.read_bytes() for path in sorted(folder.glob("*.csv"))}


class Interrupted(Threads):
    """Breaks off after its first group of runs."""

    def outcomes(self, runs, numerics, output):
        yield next(iter(super().outcomes(runs, numerics, output)))
        raise KeyboardInterrupt


@pytest.mark.slow
@pytest.mark.usefixtures("pages")
def test_runs_have_the_drawn_values_and_a_search_that_was_interrupted_the_same(tmp_path):
    uncertain = {
        "lognormal": {"alpha": 0.1, "stiffness_kN_m": 0.3, "eta": 0.1},
        "uniform": {"restitution": [0.85, 0.95]},
        "correlation": [{"between": ["eta", "stiffness_kN_m"], "value": 1.0}],
    }
    path = written(tmp_path, uncertain)
    result = rb.fragility(path, tmp_path / "straight", jobs=1)
    with pytest.raises(KeyboardInterrupt):
        rb.fragility(path, tmp_path / "resumed", jobs=Interrupted(1))
    rb.fragility(path, tmp_path / "resumed", jobs=2)
    assert read_all(tmp_path / "straight") == read_all(tmp_path / "resumed")

    runs = result.fragility_runs
    rigid, pads = (runs[runs["case"] == name] for name in ("rigid", "pads"))
    assert pads["drawn_restitution"].isna().all()
    assert rigid["drawn_eta"].isna().all()
    assert (rigid["drawn_alpha"].to_numpy() == pads["drawn_alpha"].to_numpy()).all()  # the same deviates for all cases
    assert len(set(rigid["drawn_alpha"])) == len(rigid) == 7 * 4
    stiffness = result.study.cases[1].base.beta ** 2 * 2.0**2 * 500.0 / 2
    ratios = [np.log(pads["drawn_stiffness_kN_m"] / stiffness) / 0.3, np.log(pads["drawn_eta"] / 2.5) / 0.1]
    assert ratios[0].to_numpy() == pytest.approx(ratios[1].to_numpy(), abs=1e-6)

    row = next(row for _, row in pads.iterrows() if row["status"] == "ok")
    pier = rb.Pier(alpha=row["drawn_alpha"], p=2.0, mass_t=500.0)
    base = rb.YieldingBase.from_stiffness(pier, row["drawn_stiffness_kN_m"], eta=row["drawn_eta"], epsilon=0.1)
    motion = next(motion for motion in ground_motions(result.study).motions if motion.name == row["record"])
    alone = rb.simulate(pier, base, motion.times(row["scale"]), tolerance=1e-3)
    assert alone.theta_max / pier.alpha == pytest.approx(row["theta_max_over_alpha"], rel=1e-6)

    # A limit in mm is that of the pier as it was drawn: 2 R0 sin(α) θ
    uplift = 1000 * 2 * result.study.cases[0].pier.size * np.sin(rigid["drawn_alpha"]) * rigid["drawn_alpha"]
    beyond = (rigid["status"] == "overturned") | (uplift * rigid["theta_max_over_alpha"] > 60.0)
    curve = next(curve for curve in result.curves if (curve.case.name, curve.limit.name) == ("rigid", "uplift"))
    assert 0 < sum(beyond) == sum(stripe.exceeded for stripe in curve.stripes) < 28
    assert "drawn once for each record and level: alpha lognormal 0.1" in result.info["drawn"]
    page = (tmp_path / "straight" / "analyses.html").read_text(encoding="utf-8")
    assert f"Inputs are {result.info['drawn']}" in page


def test_a_cloud_draws_once_for_each_run_also_of_the_same_intensity(tmp_path):
    text = study_text(
        pier=HEAVY, motions={"scale": [0.5, 1.0, 2.0]}, pulses=seven_pulses(0.4), cases=(RIGID,),
        numerics={"tolerance": 1e-3},
        fragility={"method": "cloud", "measure": "PGA", "uncertain": {"lognormal": {"alpha": 0.1}}},
    )  # fmt: skip
    result = rb.fragility(write_study(tmp_path, text))
    assert len(set(result.fragility_runs["drawn_alpha"])) == 7 * 3
    (curve,) = result.info["curves"]
    assert len(result.fragility) == 7 * 3
    assert curve["drawn"]["inputs"].keys() == {"alpha"}


@pytest.mark.sweep(fast=1)
@pytest.mark.parametrize("method", ["stripes", "ida", "cloud"])
def test_without_scatter_everything_is_as_without_the_table(tmp_path, method):
    levels = {} if method == "cloud" else {"levels_g": [0.3, 0.5]}
    coarse = {"hunt_step": 0.1, "window": 0.01} if method == "ida" else {}
    text = study_text(
        pier={"alpha": 0.2, "p": 2.0}, pulses=seven_pulses(0.4)[::3], numerics={"tolerance": 1e-3},
        fragility={"method": method, "measure": "PGA"} | levels | coarse,
    )  # fmt: skip
    study = load_study(write_study(tmp_path, text))
    spec, motions = read_fragility(study), ground_motions(study).motions
    names = ("alpha", "restitution", "epsilon", "beta", "eta")
    nothing = Uncertain(tuple(Input(name, "lognormal", 0.0) for name in names))
    found = []
    for each in (spec, replace(spec, uncertain=nothing)):
        levels_run = each if method != "cloud" else replace(each, levels=(0.4,))
        with Journal(tmp_path / f"{len(found)}.csv.part", columns(study), {}) as journal:
            curves = assess(study, each, motions, Waves(study, journal, Threads(1)))
            rows = [row for _, row in journal.rows()]
        table = "" if method == "cloud" else points(curves, levels_run, ()).to_csv()
        found.append((rows, table, [curve.capacities for curve in curves]))
    assert found[0] == found[1]


# Messages


@pytest.mark.parametrize(("uncertain", "message"), [
    ({"seed": 2}, "nothing is drawn; write [fragility.uncertain.lognormal] and under it alpha = 0.1"),
    ({"lognormal": {"alpha": 0.1}, "uniform": {"alpha": [0.1, 0.3]}}, "alpha is given under lognormal and uniform"),
    ({"lognormal": {"eta": 0.1, "yield_kN": 0.1}}, "eta and yield_kN are given, which fix the same; keep one"),
    ({"lognormal": {"zeta": 0.1}}, "zeta: it goes with springs that have one; write zeta in the case; leave it out"),
    ({"lognormal": {"p": 0.1}}, "p: unknown key"),
    ({"uniform": {"restitution": [0.92, 0.95]}}, 'does not hold the 0.9 of case "rigid"'),
    ({"lognormal": {"restitution": 0.1}}, 'case "rigid" cannot be with 15 % of what is drawn, where 3 % are allowed'),
    ({"lognormal": {"restitution": 0.1}}, "must be within 0..1"),
    ({"lognormal": {"eta": 0.6}}, "the springs cannot carry the weight"),
    ({"lognormal": {"alpha": 0.1}, "correlation": [{"between": ["alpha", "eta"], "value": 0.5}]},
     "between: eta is not drawn; give its scatter, or leave this out"),
    ({"lognormal": {"alpha": 0.1}, "correlation": [{"between": "alpha", "value": 0.5}]}, "between: expected two inputs"),
    ({"lognormal": {"alpha": 0.1, "eta": 0.1, "beta": 0.1}, "correlation": [{"between": ["alpha", "eta"], "value": 0.9},
     {"between": ["eta", "beta"], "value": 0.9}, {"between": ["beta", "alpha"], "value": -0.9}]},
     "value = -0.9: impossible beside the correlations above it"),
])  # fmt: skip
def test_mistakes_are_named(tmp_path, uncertain, message):
    with pytest.raises(InputError) as error:
        read_fragility(load_study(written(tmp_path, uncertain)))
    assert message in str(error.value)


def test_nothing_is_lognormal_about_zero(tmp_path):
    path = written(tmp_path, {"lognormal": {"epsilon": 0.1}}, cases=(PADS,))
    with pytest.raises(InputError, match='epsilon = 0 in case "pads", about which nothing is lognormal'):
        read_fragility(load_study(path))


@pytest.mark.slow
def test_what_is_drawn_is_not_added_a_second_time(tmp_path):
    """A dispersion says which drawn inputs it leaves out: all of them."""
    uncertain, modelling = {"lognormal": {"alpha": 0.1, "eta": 0.1}}, {"name": "supports", "value": 0.2}

    def read(**more):
        return read_fragility(load_study(written(tmp_path, uncertain, dispersion=[modelling | more])))

    for more in ({}, {"without": ["alpha"]}):
        with pytest.raises(
            InputError, match=r'"supports": the scatter of .*eta is drawn .* write without = \["alpha", "eta"\]'
        ):
            read(**more)
    with pytest.raises(InputError, match=r"zeta.*does not draw it"):
        read(without=["alpha", "eta", "zeta"])
    spec = read(without=["alpha", "eta"])
    assert spec.added == 0.2
    assert added(spec).endswith("supports 0.2; together 0.2, not counting alpha, eta, which are drawn")
