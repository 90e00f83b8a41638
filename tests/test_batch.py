"""The batch: every record in every case, in the order of the study, whatever the number of threads."""

import numpy as np
import pandas as pd
import pytest

import rockbatch as rb
from rockbatch.results import COLUMNS, MORE_COLUMNS

STUDY = """
title = "two pulses, three bases"

[pier]
alpha = 0.2
p = 1.0

[motions]
polarity = ["+", "-"]
scale = [0.5, 1.0]

[[motions.pulse]]
name = "one-sine"
shape = "sine"
amplitude_g = 1.0
period_s = 0.5
dt_s = 0.01
duration_s = 4.0

[[motions.pulse]]
name = "one-cosine"
shape = "cosine"
amplitude_g = 0.5
period_s = 1.0
dt_s = 0.02
duration_s = 4.0

[[case]]
name = "rigid"
base = "rigid"

[[case]]
name = "pads"
base = "yielding"
beta = [30, 50]
eta = 2.5
epsilon = 0.1
"""


@pytest.fixture
def study(tmp_path):
    path = tmp_path / "study.toml"
    path.write_text(STUDY, encoding="utf-8")
    return path


def test_rows_come_in_the_order_of_the_study(study):
    table = rb.run(study)
    assert list(table.columns) == [*COLUMNS, "beta", *MORE_COLUMNS, "settlement_other_law_m"]
    assert len(table) == 2 * 2 * 2 * 3
    first = table.loc[:5, ["record", "polarity", "scale", "case", "beta"]].astype(object).where(table.notna(), None)
    assert first.to_numpy().tolist() == [
        ["one-sine", "+", 0.5, "rigid", None],
        ["one-sine", "+", 0.5, "pads", 30.0],
        ["one-sine", "+", 0.5, "pads", 50.0],
        ["one-sine", "+", 1.0, "rigid", None],
        ["one-sine", "+", 1.0, "pads", 30.0],
        ["one-sine", "+", 1.0, "pads", 50.0],
    ]


def test_results_do_not_depend_on_the_number_of_jobs_to_the_bit(study):
    pd.testing.assert_frame_equal(rb.run(study, jobs=1), rb.run(study, jobs=5), check_exact=True)


def test_polarity_mirrors_and_changes_no_peak(study):
    """−ü_g mirrors θ: the peak is the same, the residual rotation changes its sign."""
    table = rb.run(study)
    plus, minus = (table[table["polarity"] == sign].reset_index(drop=True) for sign in "+-")
    assert plus["theta_max_over_alpha"].to_numpy() == pytest.approx(minus["theta_max_over_alpha"].to_numpy(), rel=1e-12)
    residual = plus["theta_res_over_alpha"].to_numpy()
    assert residual == pytest.approx(-minus["theta_res_over_alpha"].to_numpy(), rel=1e-9, nan_ok=True)
    assert np.nanmax(np.abs(residual)) > 1e-3


def test_every_tolerated_row_has_an_error_below_the_tolerance(study):
    table = rb.run(study)
    assert (table["status"] == "ok").all()
    assert (table["theta_max_error"] <= 1e-4).all()
    assert table["substeps"].gt(1).all()


def test_a_fixed_step_has_no_error_estimate(study):
    study.write_text(STUDY + "\n[numerics]\nsubsteps = 3\n", encoding="utf-8")
    table = rb.run(study)
    assert table["theta_max_error"].isna().all()
    assert table["substeps"].eq(3).all()


def test_a_scaled_motion_is_the_scaled_pulse(study):
    table = rb.run(study)
    row = table[(table["record"] == "one-sine") & (table["scale"] == 0.5) & (table["case"] == "rigid")].iloc[0]
    pulse = rb.pulse("sine", name="half", amplitude=0.5 * 9.81, period=0.5, dt=0.01, duration=4.0)
    pier = rb.Pier(0.2, 1.0)
    response = rb.simulate(pier, rb.RigidBase(), pulse)
    assert np.abs(response.theta).max() / pier.alpha == pytest.approx(row["theta_max_over_alpha"], rel=1e-4)


def test_a_folder_without_any_motion_is_a_mistake_that_says_so(study, tmp_path):
    (tmp_path / "empty").mkdir()
    with pytest.raises(rb.InputError, match="no ground motion"):
        rb.run(study, motions=tmp_path / "empty")
