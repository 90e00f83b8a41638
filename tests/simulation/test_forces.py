"""[output] forces = true: columns, demands and sections that only those have who ask, and friction of the interface."""

import math

import numpy as np
import pandas as pd
import pytest
from report_page import Page
from studies import PADS, PIER, RIGID, SINE, study_text, write_study

import rockbatch as rb
from rockbatch.commands.cli import main
from rockbatch.common.errors import InputError
from rockbatch.quantities.catalogue import FIXED, TRAILING, names
from rockbatch.results.columns import columns
from rockbatch.study.suite import ground_motions

WEIGHED = {"width_m": 4.0, "height_m": 30.0, "mass_t": 2000.0, "deck_mass_t": 1000.0, "deck_height_m": 31.0}
ON_PADS = PADS | {"epsilon": 0.1}
QUIET = {"histories": "none", "both_laws": False}


def study(folder, *, forces=True, name="study.toml", output=QUIET, **more):
    more = {"pier": PIER, "cases": (RIGID, ON_PADS)} | more
    asked = output | ({"forces": True} if forces else {})
    return write_study(folder, study_text(output=asked, **more), name)


def cells(folder):
    return pd.read_csv(folder / "peaks.csv", dtype=str, keep_default_na=False)


@pytest.mark.usefixtures("pages")
def test_who_does_not_ask_has_the_same_columns_and_bytes_without_those_of_forces(tmp_path):
    for name, forces in (("with", True), ("without", False)):
        path = study(tmp_path, forces=forces, name=f"{name}.toml", motions={"polarity": ["+", "-"]})
        assert main(["run", str(path), "--out", str(tmp_path / name)]) == 0
    asked, plain = cells(tmp_path / "with"), cells(tmp_path / "without")
    assert list(plain) == [*names(FIXED), *names(TRAILING), "mirror_of"]
    assert list(plain)[-3:] == ["beyond_linearised", "still_rocks", "mirror_of"]
    pd.testing.assert_frame_equal(asked[list(plain)], plain)
    assert len(set(asked) - set(plain)) == 27
    page = (tmp_path / "without" / "report.html").read_text(encoding="utf-8")
    assert "Forces" not in Page(page).headings


def test_drift_uplift_and_pga_follow_from_rotation_geometry_and_motion(tmp_path):
    path = study(
        tmp_path,
        forces=False,
        pier=WEIGHED | {"top_m": 34.0},
        motions={"scale": [0.5]},
        cases=(RIGID,),
        output={"histories": "none"},
    )
    row, pier = rb.run(path).iloc[0], rb.load_study(path).cases[0].pier
    theta = row["theta_max_over_alpha"] * pier.alpha
    assert theta > 1e-3
    assert row["top_drift_m"] == pytest.approx(34.0 * theta, rel=1e-12)
    assert row["heel_uplift_m"] == pytest.approx(4.0 * theta, rel=1e-12)
    assert row["pga_g"] == pytest.approx(
        0.5 * math.sin(2 * math.pi * 0.12 / 0.5), rel=1e-12
    )  # the sample next to its peak


def test_forces_are_in_kilonewtons_too_where_the_mass_is_known(tmp_path):
    row = rb.run(study(tmp_path, pier=WEIGHED, cases=(RIGID,))).iloc[0]
    for name in ("base_shear", "normal_force"):
        assert row[f"{name}_kN"] == pytest.approx(3000.0 * row[f"{name}_m_s2"], rel=1e-12)
    assert row["base_moment_kNm"] == pytest.approx(3000.0 * row["base_moment_m2_s2"], rel=1e-12)
    assert row["impulse_kN_s"] == pytest.approx(3000.0 * row["impulse_m_s"], rel=1e-12)
    assert row["pivot_force_left_kN"] == pytest.approx(1500.0 * 9.81 * row["pivot_force_left"], rel=1e-12)
    without = rb.run(study(tmp_path, cases=(RIGID,))).iloc[0]
    assert np.isnan(
        without[["base_shear_kN", "normal_force_kN", "impulse_kN_s", "pivot_force_left_kN"]].astype(float)
    ).all()
    assert without["base_shear_m_s2"] > 0.0


@pytest.mark.parametrize(("deck", "height"), [({}, 31.0), ({"top_m": 36.0}, 31.0), (None, 30.0)])
def test_the_deck_accelerates_at_its_own_height_whatever_drift_is_read_at(tmp_path, deck, height):
    """Without one it is the top: of a shaft of 4 m × 30 m its own."""
    pier = {"width_m": 4.0, "height_m": 30.0} if deck is None else WEIGHED | deck
    assert rb.load_study(study(tmp_path, pier=pier)).cases[0].pier.deck == pytest.approx(height, rel=1e-12)
    parts = {"width_m": 4.0, "deck_mass_t": 1000.0, "deck_height_m": 31.0}
    parts["part"] = [{"mass_t": 2000.0, "height_m": 33.0, "inertia_t_m2": 1e4}]
    assert rb.load_study(study(tmp_path, pier=parts)).cases[0].pier.deck == 31.0


def test_friction_without_forces_says_what_to_write(tmp_path):
    path = study(tmp_path, forces=False, cases=(RIGID | {"friction": 0.5}, ON_PADS))
    with pytest.raises(InputError, match="friction: is compared only with the friction demand; write forces") as error:
        rb.load_study(path)
    assert f"{path}:{path.read_text().splitlines().index('friction = 0.5') + 1}" in error.value.messages[0]


@pytest.mark.parametrize("share", [0, 1, -0.1])
def test_a_share_of_the_weight_lies_between_none_and_all_of_it(tmp_path, share):
    with pytest.raises(InputError, match=r"least_normal_share = .*: expected a number above 0 and below 1"):
        rb.load_study(study(tmp_path, output=QUIET | {"least_normal_share": share}))


def test_a_share_of_the_weight_without_forces_says_what_to_write(tmp_path):
    with pytest.raises(
        InputError, match=r"least_normal_share = 0\.2: is for forces = true; write that too, or leave it out"
    ):
        rb.load_study(study(tmp_path, forces=False, output=QUIET | {"least_normal_share": 0.2}))


def test_friction_counts_from_the_share_that_python_names_as_from_that_of_a_study(tmp_path):
    asked = rb.load_study(study(tmp_path, cases=(ON_PADS,), output=QUIET | {"least_normal_share": 0.99}))
    of_default = study(tmp_path, cases=(ON_PADS,), output=QUIET | {"least_normal_share": 0.1}, name="default.toml")
    (motion,), (case,) = ground_motions(asked).motions, asked.cases
    for share, of_study in ((0.99, asked), (0.1, rb.load_study(of_default))):
        row = rb.simulate(case.pier, case.base, motion, forces=True, least_normal_share=share).row
        assert row["friction_demand"] == rb.run(of_study)["friction_demand"][0]
    assert row["friction_demand"] > rb.run(asked)["friction_demand"][0]
    for share in (0.0, 1.0, math.nan):
        with pytest.raises(
            InputError, match=r"least_normal_share = .*: must be above 0 and below 1, a share of the weight"
        ):
            rb.simulate(case.pier, case.base, motion, forces=True, least_normal_share=share)


@pytest.mark.parametrize("friction", [0, -0.5])
def test_no_interface_has_less_than_no_friction(tmp_path, friction):
    with pytest.raises(InputError, match="friction"):
        rb.load_study(study(tmp_path, cases=(RIGID | {"friction": friction},)))
    with pytest.raises(InputError, match=r"friction = .*: must be a number above 0, the coefficient of the interface"):
        rb.simulate(rb.Pier(0.2, 1.0), rb.RigidBase(friction=friction), rb.Motion("still", 0.01, np.zeros(9)))


@pytest.mark.usefixtures("pages")
def test_a_list_of_frictions_is_a_case_each_and_those_that_slide_are_named(tmp_path, capsys):
    cases = (RIGID | {"friction": [0.1, 0.9]}, ON_PADS | {"friction": 0.9, "flight": "guided"})
    check = [{"name": "keys", "demand": "friction_demand", "at_most": 0.3, "reason": "r", "case": "rigid"}]
    path = study(tmp_path, cases=cases, check=check)
    assert main(["run", str(path), "--out", str(tmp_path / "out")]) == 1
    told = capsys.readouterr().err
    results = rb.open_results(tmp_path / "out")
    rigid = results.peaks[results.peaks["case"] == "rigid"].set_index("friction")
    assert rigid["slides"].to_dict() == {0.1: 1, 0.9: 0}
    assert "would slide" in rigid.loc[0.1, "note"]
    assert rigid.loc[0.1, "friction_demand"] == rigid.loc[0.9, "friction_demand"] > 0.3
    assert [case["parameters"].get("friction") for case in results.info["cases"]] == [0.1, 0.9, 0.9]
    assert results.info["units"]["base_shear_m_s2"] == "m/s^2"
    page = Page((tmp_path / "out" / "report.html").read_text(encoding="utf-8"))
    assert page.headings.index("Forces") > page.headings.index("Every run")
    slides = (results.peaks["friction_demand"] > results.peaks["friction"]).sum()
    assert slides == 1
    assert "1 run demands more friction than the interface has: the pier would slide" in told
    assert "one run of 3: the friction demand is greater" in page.text
    assert "The pier would slide there, which the model does not follow" in page.text
    head, *rows = page.tables["forces"]
    shown = {row[0]: row[head.index("V/N")] for row in rows[: len(results.info["cases"])]}
    assert float(shown["rigid: friction\u00a0=\u00a00.1"]) == pytest.approx(rigid.loc[0.1, "friction_demand"], abs=1e-4)


def test_a_fragility_of_a_demand_of_forces_asks_for_them(tmp_path):
    more = {
        "check": [{"name": "shear", "demand": "base_shear_m_s2", "at_most": 2.5, "reason": "r"}],
        "fragility": {"measure": "PGA", "levels_g": [0.3, 1.0]},
    }
    path = study(tmp_path, cases=(RIGID,), **more)
    found = rb.fragility(path).fragility
    shear = found[found["limit_state"] == "shear"].set_index("level")
    assert list(shear["undecided"]) == [
        1,
        0,
    ]  # below the limit without its landings, which have no force on rigid ground
    assert list(shear["exceeded"]) == [0, 1]


def test_shares_with_forces_are_merged_to_the_bytes_of_one_run(tmp_path):
    path = str(study(tmp_path, motions={"polarity": ["+", "-"], "scale": [0.5, 1.0]}))
    assert main(["run", path, "--out", str(tmp_path / "whole")]) == 0
    shares = [str(tmp_path / n) for n in "12"]
    for n, share in enumerate(shares, 1):
        assert main(["run", path, "--shard", f"{n}/2", "--out", share]) == 0
    assert main(["merge", path, "--out", str(tmp_path / "merged"), *shares]) == 0
    assert (tmp_path / "merged" / "peaks.csv").read_bytes() == (tmp_path / "whole" / "peaks.csv").read_bytes()
    assert (cells(tmp_path / "merged")["base_shear_m_s2"] != "").all()


def test_finished_runs_without_forces_do_not_pass_for_those_with(tmp_path, capsys):
    share = ["--shard", "1/2", "--out", str(tmp_path / "out")]
    assert main(["run", str(study(tmp_path, forces=False)), *share]) == 0
    assert main(["run", str(study(tmp_path)), *share]) == 2
    assert "something has changed since (numerics)" in capsys.readouterr().err


def test_a_run_that_is_too_long_to_be_written_down_has_no_forces(tmp_path, monkeypatch):
    monkeypatch.setattr("rockbatch.simulation.observing.Observer.most_steps", 100)
    row = rb.run(study(tmp_path, cases=(RIGID,))).iloc[0]
    assert row["status"] == "ok"
    assert math.isnan(row["base_shear_m_s2"])


def test_the_columns_of_forces_are_asked_for_by_one_key(tmp_path):
    plain, asked = (columns(rb.load_study(study(tmp_path, forces=forces))) for forces in (False, True))
    assert asked[: len(plain)] == plain
    assert SINE["name"] in set(rb.run(study(tmp_path, cases=(RIGID,)))["record"])
