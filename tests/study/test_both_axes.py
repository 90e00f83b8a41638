"""A case with ``other_width_m`` stands for both axes of its pier, each under its own component of every record."""

import math
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from motion_files import wiggle, write_at2
from studies import RIGID, SINE, study_text, write_study

import rockbatch as rb
from rockbatch.analyses.fragility.runs import Point, ScaledRuns, level_plans
from rockbatch.analyses.fragility.study import read_fragility
from rockbatch.batch.digests import digests
from rockbatch.batch.listening import Listener
from rockbatch.batch.plan import Plan
from rockbatch.common.errors import InputError
from rockbatch.motions import MotionSet
from rockbatch.pier import Damper, ElasticBase, Pier, Stop, Tendon
from rockbatch.results import beside_peaks
from rockbatch.study import Study, load_study
from rockbatch.study.both_axes import across
from rockbatch.study.suite import ground_motions

PIER = {"width_m": 3.0, "height_m": 20.0, "mass_t": 700.0}
BLOCK = RIGID | {"name": "rock", "other_width_m": 4.0}
PADS = {"name": "pads", "base": "yielding", "stiffness_kN_m": 9e5, "yield_kN": 9000.0, "other_width_m": 4.0}


def pair(name="A", dt=0.01, npts=600, seed=3):
    first, second = (size * wiggle(npts, seed + i) for i, size in enumerate((4.0, 3.0)))
    return rb.Motion(name, dt, first, across=second, station=name)


def study(cases=(BLOCK, PADS), pier=PIER, motions=None, **tables):
    text = study_text(pier=pier, cases=cases, motions=motions, pulses=(), **tables)
    return Study.from_toml(text, motions=[pair()] if motions is None else None)


def test_the_case_across_has_the_other_width_the_same_mass_and_the_same_springs():
    rock, rock_across, pads, pads_across = study().cases
    assert [case.name for case in (rock_across, pads_across)] == ["rock across", "pads across"]
    assert (rock_across.across_of, pads_across.across_of, rock.across_of) == ("rock", "pads", "")
    alone = Pier.rectangle(4.0, 20.0, mass_t=700.0)
    assert pads_across.pier == rock_across.pier == alone
    springs = [case.base.parameters(case.pier) for case in (pads, pads_across)]
    for name in ("stiffness_kN_m", "yield_kN", "omega_v", "delta_s_m"):
        assert springs[1][name] == pytest.approx(springs[0][name], rel=1e-12), name


@pytest.mark.parametrize(("at_most", "refused"), [(0.6, False), (0.8, True)])
def test_a_limit_is_compared_with_both_widths(at_most, refused):
    """At θ = α the heel rises 3 atan(3/20) = 0.447 m along the axis, and 4 atan(4/20) = 0.790 m across it."""
    check = {"name": "uplift", "demand": "heel_uplift_m", "at_most": at_most, "reason": "keys"}
    if refused:
        with pytest.raises(InputError, match=r"heel_uplift_m above 0\.7896 is past the edge of overturning"):
            study(check=[check])
    else:
        assert study(check=[check]).checks[0].at_most == at_most


@pytest.mark.parametrize(
    "given",
    [
        {"width_m": 3.0, "height_m": 20.0, "mass_t": 500.0, "deck_mass_t": 300.0, "deck_height_m": 22.0, "top_m": 23.0},
        {"width_m": 3.0, "height_m": 20.0, "mass_t": 500.0, "deck_mass_t": 300.0},
        {"width_m": 3.0, "height_m": 20.0, "mass_t": 500.0, "deck_mass_t": 900.0, "columns": 3},
        {"width_m": 3.0,
         "part": [{"mass_t": 300.0, "height_m": 8.0, "inertia_t_m2": 2000.0}, {"mass_t": 200.0, "height_m": 18.0}]},
    ],
)  # fmt: skip
def test_any_pier_across_is_the_one_that_another_width_gives(given):
    (_, other) = study([BLOCK], given).cases
    (alone,) = study([RIGID], given | {"width_m": 4.0}).cases
    assert other.pier == alone.pier


def test_a_flexural_period_is_along_the_axis_alone():
    along, other = study([BLOCK], PIER | {"flexural_period_s": 0.4}).cases
    assert (along.pier.flexural_period_s, other.pier.flexural_period_s) == (0.4, None)


def test_devices_are_in_the_middle_of_the_other_width_with_their_stiffness():
    pier, other = Pier.rectangle(3.0, 20.0, mass_t=700.0), Pier.rectangle(4.0, 20.0, mass_t=700.0)
    devices = (
        Tendon.of(pier, prestress_kN=900.0, stiffness_kN_m=5e4),
        Damper.viscous(pier, coefficient_kN_s_m=800.0, brace_kN_m=1e5),
        Stop.of(pier, gap_mm=50.0, stiffness_kN_m=4e5, at="left"),
        Damper.hysteretic(pier, 300.0, 5.0, at="deck"),
        rb.DeckSpring.of(pier, stiffness_kN_m=3e4),
    )
    made = across(pier, ElasticBase(beta=60.0, restraints=devices), other)
    tendon, first, second, stop = made.restraints
    assert tendon.lam == pytest.approx(Tendon.of(other, 900.0, 5e4).lam, rel=1e-12)
    viscous = Damper.viscous(other, coefficient_kN_s_m=800.0, brace_kN_m=1e5)
    assert first == second
    assert (first.at, first.nu, first.brace) == (0.0, pytest.approx(viscous.nu), pytest.approx(viscous.brace))
    assert (stop.at, stop.gap_m, stop.lam) == (0.0, 0.05, pytest.approx(Stop.of(other, 50.0, 4e5).lam))


def test_both_components_have_one_axis_and_factor_and_are_of_turned_records(tmp_path):
    for azimuth, seed, size in (("000", 1, 4.0), ("090", 2, 2.8)):
        title = f"Made-up, 1/17/1994, Station A, {azimuth}"
        write_at2(tmp_path / "records", f"RSN1_A_{azimuth}.AT2", size * wiggle(800, seed), title=title)

    def motions(axis, cases, target=None):
        keys = {"path": "records", "axis_deg": axis} | ({"target": target} if target else {})
        text = study_text(pier=PIER, cases=cases, motions=keys, pulses=())
        return ground_motions(load_study(write_study(tmp_path, text))).motions

    (both,), (along,), (other,) = motions(30, [BLOCK]), motions(30, [RIGID]), motions(120, [RIGID])
    np.testing.assert_allclose(both.horizontal, along.horizontal)
    np.testing.assert_allclose(both.exchanged.horizontal, other.horizontal)
    assert (both.exchanged.azimuth, both.exchanged.name) == (120.0, both.name)
    spectrum = {"spectrum": [[0.1, 0.8], [3.0, 0.2]], "period_range_s": [0.2, 2.0], "factors": "each", "pairs": "srss"}
    (scaled,) = motions(30, [BLOCK], spectrum)
    np.testing.assert_allclose(scaled.across, scaled.factor * both.across, rtol=1e-9)
    fitted = np.geomspace(0.2, 2.0, 200)
    srss = rb.pair_spectrum(replace(scaled, across=None), replace(scaled.exchanged, across=None), fitted)["srss_g"]
    target = np.exp(np.interp(np.log(fitted), np.log([0.1, 3.0]), np.log([0.8, 0.2])))
    assert np.log(srss / target).mean() == pytest.approx(0.0, abs=0.02)  # by least squares, at fewer periods
    swapped = motions(120, [BLOCK], spectrum)[0]
    assert swapped.factor == pytest.approx(scaled.factor, rel=1e-9)  # of the pair, whichever way it is turned by 90°


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"pier": {"alpha": 0.2, "p": 1.0}}, '[[case]] "rock": other_width_m: needs width_m of [pier]'),
        ({"pier": PIER | {"initial_rotation_rad": 0.01}}, "a released pier rotates in one plane"),
        ({"cases": [BLOCK, RIGID | {"name": "rock across"}]}, 'the case across the axis is called "rock across"'),
        ({"cases": [BLOCK | {"other_width_m": 30.0}]}, 'other_width_m = 30: more than the height, 20 m'),
        ({"cases": [BLOCK | {"name": ["x"]}]}, "expected one value, not a list"),
        (
            {"cases": [{"name": "pads", "base": "elastic", "stiffness_kN_m": 1e5, "other_width_m": 0.5}]},
            "other_width_m = 0.5: across the axis beta = ",
        ),
    ],
)  # fmt: skip
def test_what_cannot_be_run_on_both_axes_is_said_at_the_key(change, message):
    with pytest.raises(InputError) as error:
        study(**{"cases": [BLOCK], **change})
    assert message in str(error.value)


@pytest.mark.parametrize(
    ("motions", "message"),
    [
        ({"axis_deg": 30, "still_s": 5.0}, "a released pier rotates in one plane; leave initial_rotation_rad and still_s"),
        ({}, "write axis_deg in [motions], the direction of width_m in degrees from north"),
        ({"every_deg": 30}, ", instead of every_deg"),
        ({"axis_deg": 30, "target": {"spectrum": [[0.1, 0.8], [3.0, 0.2]], "period_range_s": [0.2, 2.0]}},
         'pairs = "apart" in [motions.target], its default'),
    ],
)  # fmt: skip
def test_pairs_are_turned_and_fitted_as_pairs(tmp_path, motions, message):
    (tmp_path / "records").mkdir()
    text = study_text(pier=PIER, cases=[BLOCK], motions={"path": str(tmp_path / "records")} | motions, pulses=())
    with pytest.raises(InputError) as error:
        Study.from_toml(text)
    assert message in str(error.value)


def test_a_record_without_a_second_component_is_named_with_the_remedy():
    lone = rb.Motion("lone", 0.01, 3.0 * wiggle(300, 9))
    made = study().with_(motions=[pair(), lone])
    found = ground_motions(made)
    assert [motion.name for motion in found] == ["A"]
    (unusable,) = found.unusable
    assert "lone has no horizontal component at right angles" in unusable.reason
    assert "leave it out (leave_out under [motions]), or run it in a study without other_width_m" in unusable.reason
    with pytest.raises(InputError, match="one-sine has no horizontal component at right angles"):
        ground_motions(Study.from_toml(study_text(pier=PIER, cases=[BLOCK], motions={"axis_deg": 0}, pulses=[SINE])))


def test_one_way_to_combine_holds_for_every_check_where_demands_add_up():
    check = {"name": "r", "demand": "theta_max_over_alpha", "at_most": 0.5, "reason": "agreed"}
    fall = {"name": "f", "demand": "overturned", "at_most": 0, "reason": "agreed"}
    made = study(suite={"both_axes": "100_30"}, check=[check, check | {"name": "s", "both_axes": "srss"}, fall])
    assert [rule.both_axes for rule in made.checks] == ["100_30", "srss", None]


def test_finished_runs_count_only_under_the_same_second_component():
    first, other = pair(), replace(pair(), across=pair(seed=8).across)
    assert digests([first])["motions"] != digests([other])["motions"] == digests([other])["motions"]


class Said(Listener):
    """A listener that keeps what it is told."""

    def __init__(self):
        self.words = []

    def say(self, words):
        self.words.append(words)


@pytest.mark.slow
def test_analyses_take_the_axis_and_say_so():
    made, said = study([BLOCK], fragility={"measure": "PGA", "levels_g": [0.2, 0.4]}), Said()
    result = rb.fragility(made, progress=said)
    assert set(result.fragility["case"]) == {"rock"}
    assert "other_width_m: this analysis takes the cases along the axis of the pier only" in said.words


def test_runs_beside_peaks_and_in_plans_are_under_the_component_of_their_axis():
    made, motion = study([BLOCK]), pair()
    assert [case.name_along for case in made.cases] == ["rock", "rock"]
    ordered = [("rock", motion), ("rock across", motion.exchanged)]
    assert [(run.case.name, run.record) for run in Plan(made, MotionSet([motion]))] == ordered
    rows = [
        {"record": "A", "case": name, "polarity": "+", "scale": 1.0, "status": "ok", "theta_max_over_alpha": 0.1}
        for name, _ in ordered
    ]
    beside = beside_peaks.runs(pd.DataFrame(rows), made, [motion])
    assert [(run.row["case"], run.motion, run.pier) for run in beside] == [
        (name, record, case.pier) for (name, record), case in zip(ordered, made.cases, strict=True)
    ]
    spec = read_fragility(study([BLOCK], fragility={"measure": "PGA/(g tan alpha)", "levels": [0.5, 1.0]}))
    plans = level_plans(made, spec, [motion])
    assert [plan.unscaled for plan in plans] == [
        [pytest.approx(record.pga / (case.pier.gravity * math.tan(case.pier.alpha)))]
        for (_, record), case in zip(ordered, made.cases, strict=True)
    ]
    points = [Point(0, 1.0, case) for case in range(2)]
    scaled = ScaledRuns(points, [motion], plans, lambda point: made.cases[point.case], "+")
    assert [(run.case.name, run.record) for run in scaled] == ordered


@pytest.mark.slow
def test_exchanged_widths_and_components_give_exchanged_rows():
    """And each row is that of an ordinary study of its axis, to the bit."""
    cases = [PADS, BLOCK]
    motion = pair()
    table = rb.run(study(cases).with_(motions=[motion]))
    swapped = rb.run(
        study([case | {"other_width_m": 3.0} for case in cases], PIER | {"width_m": 4.0}).with_(
            motions=[motion.exchanged]
        )
    )
    numbers = [name for name in table.select_dtypes("number") if name in swapped]
    for case, twin in (("rock", "rock across"), ("pads", "pads across")):
        for first, second in ((case, twin), (twin, case)):
            mine = table.loc[table["case"] == first, numbers].to_numpy(float)
            np.testing.assert_allclose(
                mine, swapped.loc[swapped["case"] == second, numbers].to_numpy(float), rtol=1e-6, atol=1e-9
            )
    measured = [
        (run.row["case"], run.motion.pga, run.pier.half_width)
        for run in beside_peaks.runs(table, study(cases), [motion])
    ]
    assert measured[2:] == [
        ("rock", motion.pga, pytest.approx(1.5)),
        ("rock across", motion.exchanged.pga, pytest.approx(2.0)),
    ]
    alone = rb.run(study([RIGID], PIER | {"width_m": 4.0}).with_(motions=[motion.exchanged]))
    across_rock = table[table["case"] == "rock across"]
    assert alone["theta_max_over_alpha"].item() == across_rock["theta_max_over_alpha"].item()
    assert across_rock["pga_g"].item() == pytest.approx(np.abs(motion.across).max() / 9.81)
    assert math.isfinite(table["theta_max_over_alpha"].min())
