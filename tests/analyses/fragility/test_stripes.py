"""Stripes with records of their own, and limits on the factors of records: what is run, what counts, mistakes of a file."""

import math

import numpy as np
import pytest
from report_page import Page
from scipy.optimize import minimize
from scipy.stats import binom, norm
from studies import seven_pulses, study_text, write_study

import rockbatch as rb
from rockbatch.analyses.fragility.bounds import NoCurve
from rockbatch.analyses.fragility.runs import level_plans
from rockbatch.analyses.fragility.study import read_fragility
from rockbatch.common.errors import InputError
from rockbatch.study import load_study
from rockbatch.study.suite import ground_motions

PGA = 0.4
LEVELS = {"levels_g": [0.2, 0.4, 0.6, 1.2]}
COARSE = {"method": "ida", "hunt_step": 0.1, "window": 0.01}


def study(tmp_path, fragility, motions=None):
    text = study_text(
        pier={"alpha": 0.2, "p": 2.0}, motions=motions or {}, pulses=seven_pulses(PGA),
        cases=({"name": "rigid", "base": "rigid"},), numerics={"tolerance": 1e-3}, fragility={"measure": "PGA"} | fragility,
    )  # fmt: skip
    return write_study(tmp_path, text)


def stripes(*own):
    return {"stripe": [{"level_g": level, **more} for level, more in own]}


# Limits on factors


@pytest.mark.sweep(fast=1)
@pytest.mark.parametrize("method", [{"method": "stripes"}, COARSE])
def test_records_are_not_run_with_factors_beyond_the_limits(tmp_path, method):
    limits = {"least_scale": 0.8, "most_scale": 1.6} | method
    found = rb.fragility(study(tmp_path, LEVELS | limits))
    assert found.fragility_runs["scale"].between(0.8, 1.6).all()
    ends = (0.8 - 1e-12, 1.6 + 1e-12, 0.8 - 1e-7, 1.6 + 1e-7)
    assert [found.spec.allows(factor) for factor in ends] == [True, True, False, False]
    assert found.fragility["n"].to_list() == [0, 7, 7, 0]
    assert found.fragility["not_used"].to_list() == [7, 0, 0, 7]
    factors = found.fragility_scales
    assert len(factors) == 7 * 4
    assert (factors["used"] == factors["scale"].between(0.8, 1.6)).all()
    assert factors["scale"].to_numpy() == pytest.approx(factors["level"].to_numpy() / factors["unscaled"].to_numpy())
    assert "factors 0.8 to 1.6 are allowed, which leaves 0 of 7 records at 0.2" in found.info["scales"]["said"]
    assert "counts once" not in found.info["scales"]["said"]  # as it does in a cloud


@pytest.mark.slow
def test_a_record_that_is_stopped_by_its_factor_is_censored_there(tmp_path):
    """Capacities up to the greatest level that the factor allows; above it nothing is known of the record."""
    found = rb.fragility(study(tmp_path, LEVELS | COARSE | {"most_scale": 1.6}))
    rows = found.fragility_capacities
    assert (rows["above"] <= 0.6).all()
    assert rows[rows["at_most"].isna()]["above"].to_list() == [0.6] * rows["at_most"].isna().sum() != []


def test_the_factor_is_that_on_the_record_as_it_was_recorded(tmp_path):
    """A target has halved it before: 0.4 g takes 1.0 in all, 2.0 of what comes."""
    path = study(tmp_path, LEVELS)
    motions = [
        rb.Motion("a", 0.01, PGA * 9.81 * np.sin(np.arange(100) / 15)),
        rb.Motion("b", 0.01, PGA * 9.81 * np.sin(np.arange(100) / 12)),
    ]
    halved = rb.load_study(path, motions=motions).with_(motions={"pulse": None, "target": {"pga_g": 0.2}})
    read = ground_motions(halved).motions
    assert [motion.factor for motion in read] == pytest.approx([0.5, 0.5], rel=0.01)
    plan = level_plans(halved, read_fragility(halved), read)[0]
    assert plan.factor(0, 0.4) == pytest.approx(1.0, rel=0.01)


def test_limits_that_leave_nothing_are_an_error(tmp_path):
    with pytest.raises(InputError, match="no record reaches a level with such a factor; widen them"):
        rb.fragility(study(tmp_path, LEVELS | {"least_scale": 40.0, "most_scale": 50.0}))
    with pytest.raises(InputError, match="least_scale = 3: more than most_scale"):
        read_fragility(load_study(study(tmp_path, LEVELS | {"least_scale": 3.0, "most_scale": 2.0})))


# Records of their own


OWN = stripes(
    (0.3, {"records": ["sine_*"]}),
    (0.5, {"records": ["cosine_*", "ricker_0.9"]}),
    (0.8, {"records": ["ricker_*", "sine_0.6", "sine_1.0", "cosine_0.5"]}),
)


def test_each_stripe_runs_its_own_records_and_the_curve_is_the_binomial_one(tmp_path):
    """Baker's likelihood (2015) of the counts in the table, by Nelder–Mead; 1e-4 is how far such a search goes."""
    found = rb.fragility(study(tmp_path, OWN))
    assert found.fragility["n"].to_list() == [3, 3, 5]
    ran = found.fragility_scales.groupby("level")["record"].agg(set).to_dict()
    assert ran[0.5] == {"cosine_0.5", "cosine_0.8", "ricker_0.9"}
    assert len(found.fragility_runs) == 11
    levels, n, k = (found.fragility[name].to_numpy(float) for name in ("level", "n", "exceeded"))
    assert 0 < k.sum() < n.sum()

    def negative(x):
        return -binom.logpmf(k, n, norm.cdf(np.log(levels / x[0]) / x[1])).sum()

    searched = minimize(negative, [0.5, 0.4], method="Nelder-Mead", options={"xatol": 1e-9, "fatol": 1e-12})
    (curve,) = found.curves
    assert (curve.fitted.median, curve.fitted.most_likely_dispersion) == pytest.approx(tuple(searched.x), rel=1e-4)


@pytest.mark.usefixtures("pages")
def test_given_factors_are_taken_as_they_are(tmp_path):
    (tmp_path / "selection.csv").write_text("record,scale\nsine_0.4,1.5\nricker_1.3,2.5\n", encoding="utf-8")
    own = stripes(
        (0.5, {"records": ["sine_0.4", "cosine_0.5"], "scales": [1.2, 1.3]}), (0.6, {"file": "selection.csv"})
    )
    found = rb.fragility(study(tmp_path, own))
    assert found.fragility_runs["scale"].to_list() == pytest.approx([1.2, 1.5, 1.3, 2.5])
    rows = found.fragility_scales.set_index(["record", "level"])
    assert rows.loc[("ricker_1.3", 0.6), "intensity"] == pytest.approx(PGA * 2.5, rel=0.01)
    of_levels = [(one.scale_least, one.scale_median, one.scale_most) for one in found.curves[0].stripes]
    assert of_levels == [pytest.approx((1.2, 1.25, 1.3)), pytest.approx((1.5, 2.0, 2.5))]
    assert (
        "to intensities away from their levels, 0.6 to 1 at 0.6 g: is PGA the measure" in found.info["scales"]["said"]
    )
    page = Page(saved(found, tmp_path))
    assert "each level with its own records" in page.text
    assert "Factors on the records as they were recorded" in page.text


def saved(found, tmp_path):
    return next(path for path in found.save(tmp_path / "out") if path.suffix == ".html").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("fragility", "message"),
    [
        (stripes((0.5, {"records": ["sin_0.4"]}), (0.6, {"records": ["sine_*"]})), 'did you mean "sine_0.4"?'),
        (stripes((0.5, {"records": ["sine_*"], "scales": [2.0]})), "3 records have such names, and there is one factor"),
        (stripes((0.5, {"records": ["sine_*", "sine_0.4"]})), "its record is in this stripe already; name it once"),
        (stripes((0.5, {"records": ["sine_0.4"], "scales": [2.0, 1.0]})), "1 records and 2 scales"),
        (stripes((0.5, {"records": ["sine_*"]}), (0.4, {"records": ["sine_*"]})), "after 0.5; write them in rising order"),
        (stripes((0.5, {})), "it has no records; write records ="),
        (stripes((0.5, {"scales": [1.0]})), "scales: write records, too"),
        (stripes((0.5, {"file": "nowhere.csv"})), "nowhere.csv: no such file"),
        (stripes((0.5, {"records": ["sine_*"]})) | LEVELS, "levels_g: each [[fragility.stripe]] has its level"),
        (stripes((0.5, {"records": ["sine_*"]})) | {"method": "ida"}, 'records of their own are for "stripes"'),
        ({"stripe": [{"level_m_s": 0.5, "records": ["sine_*"]}]}, "the measure of [fragility] has level_g"),
        ({}, "levels_g is missing; write for example levels_g = "),
    ],
)  # fmt: skip
def test_mistakes_of_stripes_are_named_with_their_line(tmp_path, fragility, message):
    with pytest.raises(InputError) as caught:
        rb.fragility(study(tmp_path, fragility))
    assert message in "\n".join(caught.value.messages)
    assert all("study.toml:" in problem for problem in caught.value.messages)


def test_one_stripe_tells_no_dispersion(tmp_path):
    (curve,) = rb.fragility(study(tmp_path, stripes((0.5, {"records": ["sine_*", "cosine_*"]})))).curves
    assert isinstance(curve.fitted, NoCurve)
    assert math.isfinite(curve.stripes[0].scale_most)
