"""Cases whose shaft bends: keys of the study, their messages, columns, histories and checks of a run."""

from dataclasses import replace

import numpy as np
import pytest
from studies import study_text, write_study

import rockbatch as rb
from rockbatch.commands.cli import main

SHAFT = {"width_m": 8.0, "height_m": 40.0, "mass_t": 3000.0, "flexural_period_s": 0.9}
ROCK = {"name": "rock", "base": "rigid"}
SOFT = {"name": "soft", "base": "elastic", "beta": 60.0, "shaft": "elastic"}
BENDS = {"name": "bends", "base": "rigid", "shaft": "elastic"}


LOWER = {"mass_t": 2000.0, "height_m": 10.0, "length_m": 20.0, "width_m": 8.0, "flexural_rigidity_kNm2": 1e8}
UPPER = {"mass_t": 1000.0, "height_m": 30.0, "length_m": 20.0, "width_m": 5.0, "flexural_rigidity_kNm2": 5e7}
RIGIDITIES = {"width_m": 8.0, "part": [LOWER, UPPER]}


def test_a_study_with_rigidities_has_the_pier_of_its_parts(tmp_path):
    (case,) = rb.load_study(write_study(tmp_path, study_text(pier=RIGIDITIES, cases=[BENDS]))).cases
    assert [part.flexural_rigidity_kNm2 for part in case.pier.parts] == [1e8, 5e7]
    assert rb.statics(case.pier, case.base).flexural_over_rocking > 0.0


def messages(tmp_path, **tables):
    """Return what is said of a study that cannot be run."""
    with pytest.raises(rb.InputError) as error:
        rb.load_study(write_study(tmp_path, study_text(**{"pier": SHAFT} | tables)))
    return "\n".join(error.value.messages)


@pytest.mark.parametrize(
    ("tables", "message"),
    [
        ({"pier": {k: v for k, v in SHAFT.items() if k != "flexural_period_s"}, "cases": [BENDS]},
         'shaft = "elastic": flexural_period_s is missing'),
        ({"pier": {"alpha": 0.15, "p": 0.5, "mu": 4.0, "flexural_period_s": 0.9}, "cases": [BENDS]},
         'shaft = "elastic": mu = 4 does not say how the mass is spread'),
        ({"cases": [BENDS | {"restitution": 0.9}]}, "restitution = 0.9: the loss of a bending shaft at an impact"),
        ({"cases": [BENDS | {"flexural_impact": "rate"}]},
         'flexural_impact = "rate": to carry the rate of the deflection over would create energy'),
        ({"cases": [BENDS | {"flexural_impact": "rates"}]},
         'flexural_impact = "rates": a blow keeps the "momentum" of the mode'),
        ({"cases": [SOFT | {"kinematics": "finite"}]}, 'shaft = "elastic": a landing on undamped springs is an impulse'),
        ({"cases": [SOFT | {"zeta": 0.2}]}, 'shaft = "elastic": bending is of finite kinematics'),
        ({"cases": [SOFT | {"base": "footing"}]}, 'bending is of finite kinematics; write kinematics = "finite"'),
        ({"pier": SHAFT | {"flexural_period_s": 4.0},
          "cases": [SOFT | {"base": "footing", "beta": 10.5, "kinematics": "finite"}]},
         "and by more under a shaft, which hangs over as it leans; beta must be above 10.7"),
        ({"pier": SHAFT | {"flexural_period_s": 4.0}, "cases": [SOFT | {"beta": 6.0, "zeta": 0.2, "kinematics": "finite"}]},
         "over which its shaft hangs as it leans; beta must be above 6.1"),
        ({"cases": [ROCK | {"flexural_damping": 0.02}]}, "flexural_damping"),
        ({"cases": [BENDS | {"flexural_damping": 1.5}]}, "must be within 0..1"),
        ({"pier": RIGIDITIES | {"flexural_period_s": 0.9}, "cases": [BENDS]},
         "flexural_period_s is given, and follows from flexural_rigidity_kNm2 of the parts; leave one out"),
        ({"pier": RIGIDITIES | {"part": [LOWER, {key: UPPER[key] for key in UPPER if key[0] != "f"}]}, "cases": [BENDS]},
         "flexural_rigidity_kNm2 is missing of the part at 30 m"),
        ({"pier": RIGIDITIES | {"part": [LOWER | {"height_m": 15.0}, UPPER]}, "cases": [BENDS]},
         "no part has a rigidity between 0 m and 5 m"),
        ({"cases": [BENDS | {"flexural_modes": 5}]}, "flexural_modes = 5: expected a whole number, 1 to 4"),
        ({"cases": [BENDS | {"flexural_damping_kind": "mass"}]}, 'flexural_damping_kind = "mass"'),
        ({"cases": [ROCK | {"flexural_modes": 2}]}, "flexural_modes"),
        ({"cases": [BENDS | {"deck_spring": [{"gap_mm": 50.0, "stiffness_kN_m": 1e4}]}]}, "devices on the deck"),
    ],
)  # fmt: skip
def test_what_cannot_be_is_refused_with_a_remedy(tmp_path, tables, message):
    assert message in messages(tmp_path, **tables)


def test_a_pier_that_cannot_be_read_is_not_asked_for_the_period_that_it_has(tmp_path):
    said = messages(tmp_path, pier=SHAFT | {"width_m": -8.0}, cases=[BENDS])
    assert "width_m" in said
    assert "flexural_period_s" not in said


def test_keys_of_a_shaft_that_bends_are_columns_of_those_that_do(tmp_path):
    case = BENDS | {
        "shaft": ["rigid", "elastic"],
        "flexural_damping": [0.02, 0.05],
    }
    cases = rb.load_study(write_study(tmp_path, study_text(pier=SHAFT, cases=[case]))).cases
    assert len(cases) == 4
    for each in cases:
        keys = ("shaft", "flexural_damping") if each.base.bends else ()
        assert each.columns == {key: getattr(each.base, key) for key in keys}


@pytest.mark.parametrize("impact", ["momentum", ["momentum"]])
def test_the_momentum_of_the_mode_is_accepted_with_a_remark_and_changes_nothing(tmp_path, impact):
    (plain,) = rb.load_study(write_study(tmp_path, study_text(pier=SHAFT, cases=[BENDS]))).cases
    stated = write_study(tmp_path, study_text(pier=SHAFT, cases=[BENDS | {"flexural_impact": impact}]))
    with pytest.warns(DeprecationWarning, match='flexural_impact = "momentum" has no effect.*leave it out'):
        (case,) = rb.load_study(stated).cases
    assert case == plain


def test_the_command_says_once_that_the_key_has_no_effect(tmp_path, capsys):
    cases = [
        BENDS | {"name": f"bends {zeta}", "flexural_damping": zeta, "flexural_impact": "momentum"}
        for zeta in (0.02, 0.05)
    ]
    study = write_study(tmp_path, study_text(pier=SHAFT, cases=cases))
    assert main(["statics", str(study)]) == 0
    assert capsys.readouterr().err.count('flexural_impact = "momentum" has no effect') == 1


def test_python_takes_the_rule_of_a_blow_as_a_study_does():
    with pytest.warns(DeprecationWarning, match="leave it out"):
        base = rb.RigidBase(shaft="elastic", flexural_impact="momentum")
    assert base == rb.RigidBase(shaft="elastic") == replace(base)
    with pytest.raises(
        rb.InputError, match='flexural_impact = "rate": to carry the rate of the deflection over would create'
    ):
        rb.RigidBase(shaft="elastic", flexural_impact="rate")


@pytest.mark.slow  # the kernel of an elastic shaft
def test_a_rigid_and_a_bending_shaft_are_compared_in_one_study(tmp_path):
    """Drift of the bending one is its own way, not height times rotation; its checks and histories know it."""
    rules = [
        {"name": "drift", "demand": "top_drift_mm", "at_most": 100.0, "reason": "joint"},
        {"name": "shaft", "demand": "deflection_max_m", "at_most": 0.2, "reason": "steel"},
    ]
    text = study_text(pier=SHAFT, cases=[ROCK, BENDS], check=rules, output={"histories": "all"})
    study = rb.load_study(write_study(tmp_path, text))
    rb.run(study, tmp_path / "out")
    results = rb.open_results(tmp_path / "out")
    peaks = results.peaks.set_index("case")
    rigid, bent = peaks.loc[["rock"]], peaks.loc[["bends"]]
    top = study.cases[0].pier.top
    alpha = study.cases[0].pier.alpha
    np.testing.assert_allclose(rigid.top_drift_m, top * alpha * rigid.theta_max_over_alpha, rtol=1e-9)
    assert rigid.deflection_max_m.isna().all()
    assert (bent.top_drift_m > top * alpha * bent.theta_max_over_alpha).all()
    assert (bent.deflection_error_m < 1e-3 * bent.deflection_max_m).all()
    for response in results.responses:
        if response.case == "bends":
            assert 0.9 < abs(response.history.deflection).max() / peaks.loc["bends"].deflection_max_m <= 1.0
        else:
            assert "deflection" not in response.history
    verdicts = {(verdict.case, verdict.check): verdict for verdict in rb.check(tmp_path / "out").itertuples()}
    values = {case: verdicts[case, "drift"].value for case in ("rock", "bends")}
    assert values["bends"] == pytest.approx(1000.0 * bent.top_drift_m.max())
    assert values["rock"] == pytest.approx(1000.0 * rigid.top_drift_m.max())
    shaft = verdicts["bends", "shaft"]
    assert (shaft.verdict == "pass") == (shaft.value <= 0.2)
    assert shaft.value == pytest.approx(bent.deflection_max_m.max())
    assert verdicts["rock", "shaft"].verdict == "does not apply"


def test_the_other_axis_of_a_shaft_that_bends_has_another_period(tmp_path):
    assert "a shaft that bends has another period across the axis" in messages(
        tmp_path, cases=[BENDS | {"other_width_m": 12.0}], motions={"axis_deg": 0.0}
    )
