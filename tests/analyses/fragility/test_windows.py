"""Shares of the scales about the levels that exceed a limit: known islands, the curve through them, and the hunt."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import minimize
from scipy.special import ndtri
from scipy.stats import norm
from studies import PADS, RIGID, SINE, study_text, write_study

import rockbatch as rb
from rockbatch.analyses.fragility.curves import assess
from rockbatch.analyses.fragility.limit_states import EXCEEDED, LEFT_OUT, UNDECIDED, WITHSTOOD
from rockbatch.analyses.fragility.runs import LevelPlan
from rockbatch.analyses.fragility.study import read_fragility
from rockbatch.analyses.fragility.tables import _described, capacities, points
from rockbatch.analyses.fragility.windows import SAMPLES, samples, windows
from rockbatch.study import load_study
from rockbatch.study.suite import ground_motions

LEVELS = [0.4, 0.6, 0.8, 1.0, 1.2]
IDA = {"method": "ida", "measure": "PGA", "levels_g": LEVELS}


def looks_of(exceeds, levels=LEVELS, width=0.02):
    return {x: EXCEEDED if exceeds(x) else WITHSTOOD for level in levels for x in samples(level, width)}


def test_a_share_is_the_part_of_the_window_that_is_in_an_island():
    """Islands that begin and end where two of the twenty parts of a window meet, so that the share is exact."""

    def exceeds(x):
        return 0.99 < x < 1.0 or 1.01 < x < 1.1 or x > 1.19

    assert [x for x in samples(1.0, 0.02) if 0.996 < x < 1.004] == pytest.approx([0.997, 0.999, 1.001, 1.003])
    found = windows([looks_of(exceeds), looks_of(lambda x: x > 1.1)], LEVELS, 0.02, np.arange(2), 0.95)
    ninths = (1.2 * 1.02 - 1.19) / (1.2 * 0.04)
    assert found.shares == pytest.approx([0, 0, 0, 0.5 * (0.25 + 0.25), 0.5 * (1 + ninths)], abs=0.5 / SAMPLES)
    assert found.shares[:4] == (0, 0, 0, 0.25)
    assert found.records == (2, 2, 2, 2, 2)
    assert found.undecided == (0, 0, 0, 0, 0)


def test_the_curve_has_the_greatest_binomial_likelihood_of_its_counts():
    """Nelder–Mead over θ and β; 1e-5: how far such a search goes."""
    rng = np.random.default_rng(1)
    edges = np.exp(rng.normal(-0.2, 0.3, 12))
    looks = [looks_of(lambda x, edge=edge: x > edge and int(x / edge * 400) % 3 > 0) for edge in edges]
    found = windows(looks, LEVELS, 0.02, np.arange(12), 0.95)
    shares, records = np.array(found.shares), np.array(found.records)
    assert ((shares > 0) & (shares < 1)).sum() >= 3

    def negative(x):
        z = np.log(np.array(LEVELS) / x[0]) / x[1]
        return -(records * (shares * norm.logcdf(z) + (1 - shares) * norm.logsf(z))).sum()

    searched = minimize(negative, [0.9, 0.4], method="Nelder-Mead", options={"xatol": 1e-9, "fatol": 1e-12})
    assert (found.fitted.median, found.fitted.most_likely_dispersion) == pytest.approx(tuple(searched.x), rel=1e-5)


def test_undecided_runs_are_in_no_share_nor_records_without_a_decided_one():
    one, other, out = (looks_of(lambda x: x > 0.7) for _ in range(3))
    for i, x in enumerate(samples(1.0, 0.02)):
        one[x] = UNDECIDED if i < 5 else EXCEEDED if i < 10 else WITHSTOOD
        other[x] = UNDECIDED
        out[x] = LEFT_OUT
    found = windows([one, other, out], LEVELS, 0.02, np.arange(3), 0.95)
    assert found.shares == pytest.approx([0, 0, 1, 5 / 15, 1])
    assert found.records == (3, 3, 3, 1, 3)
    assert found.undecided == (0, 0, 0, 5 + SAMPLES, 0)


# In an analysis

CAPACITIES = 0.8 * np.exp(0.35 * ndtri((np.arange(30) + 0.5) / 30))


def overturns(motion, x):
    """Return whether a made-up record overturns: from its capacity on, and below on an island of 0.3 % at 0.9 of it."""
    capacity = CAPACITIES[motion]
    return bool(x >= capacity or 0.9 * capacity < x < 0.903 * capacity)


def made_up(tmp_path, **settings):
    """The curve of the rigid case through :func:`overturns`, with its spec, and the intensities that were run by motion."""
    import pandas as pd

    text = study_text(pulses=[SINE], cases=(RIGID,), fragility=IDA | settings)
    study = load_study(write_study(tmp_path, text))
    spec = read_fragility(study)
    (one,) = ground_motions(study).motions
    motions = [replace(one, name=f"motion {m}") for m in range(len(CAPACITIES))]
    seen = []

    def simulate(runs):
        seen.extend(runs.points)
        statuses = ["overturned" if overturns(point.motion, point.intensity) else "ok" for point in runs.points]
        return pd.DataFrame({"status": statuses, "polarity": "+", "theta_max_over_alpha": 0.1, "theta_max_error": 1e-6})

    (curve,) = assess(study, spec, motions, simulate)
    return curve, spec, seen


@pytest.mark.slow
def test_a_finer_hunt_lowers_the_first_exceedances_and_leaves_the_shares(tmp_path):
    """All of the islands are wider than 0.25 %, and a few are met by 5 %: the median of first exceedances falls to 0.9 of it."""
    by_step = {step: made_up(tmp_path, hunt_step=step, tolerance=1e-3)[0] for step in (0.05, 0.0025)}
    coarse, fine = by_step[0.05], by_step[0.0025]
    assert fine.fitted.median == pytest.approx(0.9 * 0.8, rel=0.01)
    assert coarse.fitted.median > 1.05 * fine.fitted.median
    assert coarse.windows[:-1] == fine.windows[:-1]
    assert coarse.windows.fitted.median == fine.windows.fitted.median
    assert fine.windows.fitted.median == pytest.approx(0.8, rel=0.02)
    assert fine.windows.above(fine.fitted) == pytest.approx(1 / 0.9 - 1, abs=0.03)


def test_the_default_hunt_has_steps_of_a_quarter_percent_and_says_so(tmp_path):
    curve, spec, _ = made_up(tmp_path)
    shares = [cap.decided.high / CAPACITIES[m] for (_, m), cap in curve.capacities if 0.4 < 0.9 * CAPACITIES[m] < 1.19]
    assert 15 < len(shares) < 30
    assert 0.9 < min(shares) <= max(shares) < 0.903
    plan = LevelPlan([1.0] * 30, [1.0] * 30, [{}] * 30, [{}] * 30)
    rows = capacities([curve], spec, (), [str(m) for m in range(30)], [plan], [curve.case])
    assert 0.9 * 0.0025 < rows["widest_step"].max() <= 0.0025 + 1e-12


def test_the_table_has_the_shares_of_every_level(tmp_path):
    curve, spec, _ = made_up(tmp_path)
    rows = points([curve], spec, ())
    assert tuple(rows["window_share"]) == curve.windows.shares
    assert list(rows["window_n"]) == [30] * 5
    assert rows["window_p"].to_numpy() == pytest.approx(curve.windows.fitted.probability(np.array(LEVELS)))
    content = _described(curve, spec)
    assert "open" not in content  # no run is undecided
    assert content["windows"]["shares"] == list(curve.windows.shares)
    assert content["windows"]["width"] == curve.windows.width
    assert content["windows"]["median"] == curve.windows.fitted.median


def test_windows_keep_to_the_limits_on_factors_and_to_the_levels_of_each_record(tmp_path):
    """The one motion has 1 g: with factors up to 1.01 the window about 1.0 g ends there, and about 1.2 g there is none."""
    curve, _, seen = made_up(tmp_path, most_scale=1.01, window=0.1)
    assert 1.0 < max(point.intensity for point in seen) <= 1.01
    assert curve.windows.records == (30, 30, 30, 30, 0)
    assert np.isnan(curve.windows.shares[-1])


def study(tmp_path, name, settings, cases=(RIGID,)):
    pulses = [SINE | {"name": f"sine {t}", "period_s": t, "amplitude_g": 0.5, "duration_s": 3.0} for t in (0.6, 0.9)]
    text = study_text(
        pier={"alpha": 0.2, "p": 2.0}, pulses=pulses, cases=cases, numerics={"tolerance": 1e-3},
        fragility={key: value for key, value in (IDA | {"levels_g": [0.4, 0.8]} | settings).items() if value},
    )  # fmt: skip
    folder = tmp_path / name
    folder.mkdir()
    return write_study(folder, text)


@pytest.mark.slow
def test_windows_are_run_on_springs_only_where_the_study_asks_for_them(tmp_path):
    cases = (RIGID, PADS | {"beta": 60, "eta": 3.0, "epsilon": 0.1, "flight": "guided"})
    plain, asked = (
        rb.fragility(study(tmp_path, name, settings, cases))
        for name, settings in (("plain", {"hunt_step": 0.05}), ("asked", {"hunt_step": 0.05, "window": 0.05}))
    )
    assert [bool(curve.windows) for curve in plain.curves] == [True, False]
    assert [curve.windows.width for curve in asked.curves] == [0.05, 0.05]
    of_pads = plain.fragility["case"] == "pads"
    assert plain.fragility.loc[of_pads, "window_share"].isna().all()
    assert plain.fragility.loc[~of_pads, "window_n"].eq(2).all()
