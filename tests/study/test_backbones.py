"""Backbones of supports in a study and in Python: what is read of the points, and what is said of wrong ones."""

import h5py
import numpy as np
import pytest
from jsonschema import Draft7Validator
from studies import SINE, study_text, write_study

import rockbatch as rb
from rockbatch.analyses.design.study import read_design
from rockbatch.analyses.sensitivity.study import read_sensitivity
from rockbatch.analyses.spectrum.study import read_spectrum
from rockbatch.checks.remarks import weak_supports
from rockbatch.pier.first_loading import Polyline
from rockbatch.pier.possible import enough_eta, least_eta, problems
from rockbatch.results.histories_file import _read, _write
from rockbatch.study.schema import STUDY, schema_of

PIER = {"width_m": 8.0, "height_m": 30.0, "mass_t": 3000.0}
POINTS = [[5.0, 10e3], [12.0, 20e3], [40.0, 38e3]]


def study_with(tmp_path, points, pier=PIER, **more):
    case = {"name": "pads", "base": "yielding", "spring": "backbone"} | (
        {} if points is None else {"backbone_mm_kN": points}
    )
    return rb.load_study(write_study(tmp_path, study_text(pier=pier, cases=[case | more])))


def test_a_study_gives_the_backbone_of_one_support_in_mm_and_kn(tmp_path):
    (case,) = study_with(tmp_path, POINTS).cases
    parameters = case.base.parameters(case.pier)
    assert parameters["stiffness_kN_m"] == pytest.approx(2e6, rel=1e-14)
    assert parameters["yield_kN"] == pytest.approx(10e3, rel=1e-14)
    assert parameters["delta_y_m"] == pytest.approx(0.005, rel=1e-14)
    assert parameters["backbone"] == [[1.0, 1.0], [2.4, 2.0], [8.0, 3.8]]
    assert case.base == rb.YieldingBase.from_backbone(case.pier, POINTS)
    at_rest = 0.5 * 3000.0 * 9.81  # 14 715 kN, between the first corner and the second
    settled = 0.005 + (at_rest - 10e3) / (10e3 / 0.007)
    assert rb.statics(case.pier, case.base).settlement_m == pytest.approx(settled, rel=1e-12)


def test_a_remark_is_made_of_supports_whose_greatest_force_is_below_the_weight(tmp_path):
    entries = []
    for points in (POINTS, [*POINTS[:2], [40.0, 20e3]], [*POINTS, [60.0, 38e3]]):  # endless; up to 20 MN; up to 38 MN
        (case,) = study_with(tmp_path, points).cases
        entries.append({"case": case.name, "columns": {}, "parameters": case.base.parameters(case.pier)})
    assert [bool(weak_supports([entry])) for entry in entries] == [False, True, False]
    assert "(68 %)" in weak_supports(entries[1:2])  # 20 MN over 29 430 kN


def test_histories_keep_the_backbone(tmp_path, uncompiled):
    base = rb.YieldingBase(60.0, eta=1.2, spring="backbone", backbone=((1.0, 1.0), (2.0, 1.5), (3.0, 1.5)))
    still = rb.Motion.still(0.02, 0.01)
    response = uncompiled(rb.simulate, rb.Pier(0.2, 1.0), base, still, substeps=1, quiet_s=0.0, wait=False)
    with h5py.File(tmp_path / "run.h5", "w") as file:
        _write(file, response)
        assert _read(file).base == base


@pytest.mark.parametrize(
    ("points", "said"),
    [
        (5.0, "expected a list of points, each [deflection in mm, force in kN]; write for example"),
        ([5.0, 10e3], "expected a list of points, each [deflection in mm, force in kN]; write for example"),
        ([[5.0, 10e3]], "a backbone has 2 to 9 points, not 1"),
        ([[1.0 * i, 10e3 * i] for i in range(1, 11)], "a backbone has 2 to 9 points, not 10"),
        ([[1.0 * i, 10e3 * i] for i in range(1, 11)], "leave out those nearest to a straight line"),
        ([POINTS, POINTS], "expected one list of points; write a [[case]] for each backbone"),
        ([POINTS[:2], POINTS[:2]], "expected one list of points; write a [[case]] for each backbone"),
        ([[5.0, 10e3], [12.0, "20e3"]], "expected a number (without quotes)"),
        ([[0.0, 0.0], *POINTS], "leave the origin out"),
        ([[-5.0, -10e3], [12.0, 20e3]], "deflection and force must be above 0"),
        ([*POINTS[:2], [10.0, 38e3]], "[10, 38000] follows [12, 20000]: each deflection must be above the one before"),
        ([*POINTS[:2], [40.0, 15e3]], "[40, 15000] follows [12, 20000]: the force falls"),
        ([*POINTS[:2], [14.0, 26e3]], "between [12, 20000] and [14, 26000] it is steeper, 3000, than before, 1429"),
        ([[0.005, 10e3], [0.012, 20e3]], "presses the supports in by 0.0074 mm only"),
        ([[5.0, 10e6], [12.0, 20e6]], "680 times what the support carries at rest"),
        ([[5.0, 10.0], [12.0, 20.0]], "it gives beta = 1.677"),
        (
            [[5.0, 10e3], [12.0, 12e3], [40.0, 12e3]],
            "write a greater force at its last corner, or a last slope above 0",
        ),
    ],
)
def test_wrong_points_are_named_with_their_line_and_the_remedy(tmp_path, points, said):
    with pytest.raises(rb.InputError) as error:
        study_with(tmp_path, points)
    assert said in str(error.value)
    assert all(problem.place and "backbone_mm_kN" in str(problem) for problem in error.value.problems)


def test_nan_in_a_backbone_is_refused(tmp_path):
    text = study_text(pier=PIER, cases=[{"base": "yielding", "spring": "backbone", "backbone_mm_kN": POINTS}])
    with pytest.raises(rb.InputError, match="expected a finite number"):
        rb.load_study(write_study(tmp_path, text.replace("38000.0", "nan")))


@pytest.mark.parametrize(
    ("more", "said"),
    [
        ({"beta": 40.0}, "beta = 40.0: the first point of backbone_mm_kN fixes the same; leave it out"),
        ({"yield_kN": 1e4}, "yield_kN = 10000.0: the first point of backbone_mm_kN fixes the same; leave it out"),
        ({"spring": "epp"}, 'does not apply to spring = "epp"'),
        ({"n": 5.0}, 'n = 5.0: does not apply to spring = "backbone"'),
    ],
)
def test_a_backbone_stands_alone(tmp_path, more, said):
    with pytest.raises(rb.InputError, match=said):
        study_with(tmp_path, POINTS, **more)


def test_a_backbone_needs_points_and_a_mass(tmp_path):
    with pytest.raises(
        rb.MissingKey, match=r"backbone_mm_kN is missing; write for example backbone_mm_kN = \[\["
    ) as error:
        study_with(tmp_path, None)
    assert len(error.value.problems) == 1
    with pytest.raises(rb.InputError, match="mass_t is missing beside backbone_mm_kN"):
        study_with(tmp_path, POINTS, pier={"width_m": 8.0, "height_m": 30.0})


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"backbone": ((1.0, 1.0), (2.0, 3.0))}, "it is steeper, 2, than before, 1"),
        ({"backbone": ()}, r"backbone is missing; write for example backbone = \(\(1, 1\), \(3, 1.75\)"),
        ({"backbone": ((1.0, 1.0), (2.0,))}, "each point is a pair of numbers"),
        ({"backbone": ((1.0, 1.0, 1.0), (2.0, 1.5, 1.0))}, "each point is a pair of numbers"),
        ({"backbone": ((1.0, 1.0), (2.0, "1.5"))}, "each point is a pair of numbers"),
        ({"backbone": ((2.0, 2.0), (3.0, 2.5))}, r"its first point must be \(1, 1\)"),
        ({"backbone": ((1.0, 1.0), (2.0, float("nan")))}, "must be finite numbers"),
        (
            {"spring": "epp", "backbone": ((1.0, 1.0), (2.0, 1.0))},
            'is of spring = "backbone", and these springs are "epp"',
        ),
    ],
)
def test_wrong_points_are_refused_in_python(given, said):
    with pytest.raises(rb.InputError, match=said):
        rb.YieldingBase(**{"beta": 40.0, "eta": 2.0, "spring": "backbone"} | given)


def test_a_pier_that_bends_or_is_too_heavy_is_refused():
    points = ((1.0, 1.0), (2.0, 1.5), (3.0, 1.5))
    base = rb.YieldingBase(60.0, eta=0.65, spring="backbone", backbone=points)
    pier = rb.Pier(0.2, 1.0, flexural_period_s=0.3)
    assert least_eta(pier, base) == pytest.approx(1.0 / 1.5, rel=1e-5)
    assert [problem.key for problem in problems(pier, base)] == ["eta"]
    bending = rb.YieldingBase(
        60.0, eta=0.7, spring="backbone", backbone=points, zeta=0.2, kinematics="finite", shaft="elastic"
    )
    (problem,) = problems(pier, bending)
    assert (
        'springs with a backbone are available for rigid shafts only; write spring = "hardening", or shaft = "rigid"'
        in str(problem)
    )


def test_the_curve_of_first_loading_is_the_polyline():
    curve = Polyline(((1.0, 1.0), (3.0, 2.0), (5.0, 2.5)))
    depths = np.array([0.0, 0.5, 1.0, 2.0, 3.0, 5.0, 7.0])
    forces = np.array([0.0, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0])
    np.testing.assert_allclose(curve.force(depths), forces, rtol=1e-15)
    assert [curve.deflection(force) for force in forces] == pytest.approx(depths, rel=1e-15)
    np.testing.assert_allclose(curve.tangent(np.array([0.5, 1.0, 1.9, 2.0, 9.0])), [1.0, 0.5, 0.5, 0.25, 0.25])
    assert curve.most == np.inf
    plastic = Polyline(((1.0, 1.0), (3.0, 2.0), (5.0, 2.0)))
    assert (plastic.most, plastic.deflection(2.0), float(plastic.tangent(np.array(2.0)))) == (2.0, 3.0, 0.0)


def test_the_force_to_write_for_one_that_falls_has_all_its_digits(tmp_path):
    points = [[5.0, 20e3], [12.0, 35123.44], [20.0, 35e3]]
    with pytest.raises(rb.InputError, match=r"\[20, 35000\] follows \[12, 35123.44\].*write 35123.44 there"):
        study_with(tmp_path, points)
    points[2][1] = 35123.44
    (case,) = study_with(tmp_path, points).cases
    assert case.base.first_loading.most == pytest.approx(35123.44 / 20e3, rel=1e-15)


def test_a_last_slope_of_the_size_of_rounding_is_plastic():
    rounded = ((1.0, 1.0), (2.0, 1.5), (3.0, 1.5 + 1e-12))
    assert Polyline(rounded).most == 1.5
    assert Polyline(rounded).tangents.tolist() == [1.0, 0.5, 0.0]
    assert Polyline(((1.0, 1.0), (2.0, 1.5), (3.0, 1.5 + 1e-8))).most == np.inf


def test_points_may_be_an_array_in_python(tmp_path):
    (case,) = study_with(tmp_path, POINTS).cases
    of_array = rb.YieldingBase.from_backbone(case.pier, np.array(POINTS))
    assert of_array == case.base
    over_first = np.array(of_array.backbone)
    again = rb.YieldingBase(of_array.beta, eta=of_array.eta, spring="backbone", backbone=over_first)
    assert again == of_array
    assert hash(again) == hash(of_array)
    with pytest.raises(rb.InputError, match="each point is a pair of numbers"):
        rb.YieldingBase.from_backbone(case.pier, np.array([[10.0, 20e3, 3.0], [30.0, 35e3, 1.0]]))


@pytest.mark.parametrize(
    "more",
    [{"yield_kN": 3.0}, {"eta": 2.0}, {"beta": 40.0}, {"stiffness_kN_m": 2e6}, {"spring": "epp"}, {"backbone": ()}],
)
def test_what_points_fix_is_refused_beside_them_in_python(more):
    pier = rb.Pier.with_deck(width_m=8, height_m=30, mass_t=2000, deck_mass_t=1000)
    with pytest.raises(rb.Contradiction, match="the points fix the same; leave it out") as error:
        rb.YieldingBase.from_backbone(pier, POINTS, **more)
    assert [problem.key for problem in error.value.problems] == list(more)


BACKBONE = {"name": "pads", "base": "yielding", "spring": "backbone", "backbone_mm_kN": POINTS}


def with_tables(tmp_path, case=BACKBONE, pier=PIER, **tables):
    return rb.load_study(write_study(tmp_path, study_text(pier=pier, cases=[case], **tables)))


def test_a_bound_may_have_points_of_its_own_valid_in_editors_too(tmp_path):
    softer = [[2.0 * x, force] for x, force in POINTS]
    bound = {"name": "soft", "case.backbone_mm_kN": softer}
    nominal, soft = rb.Study.from_dict(
        {
            "pier": PIER,
            "motions": {"pulse": [SINE]},
            "case": [BACKBONE],
            "bound": [bound],
        }
    ).cases
    assert soft.base == rb.YieldingBase.from_backbone(nominal.pier, softer)
    validator = Draft7Validator(schema_of(STUDY, "study")["properties"]["bound"])
    assert not list(validator.iter_errors([bound]))
    assert list(validator.iter_errors([bound | {"case.backbone_mm_kN": [[1.0]]}]))


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (
            {"case.backbone_mm_kN": {"times": 1.5}},
            'write the points of the bound, "case.backbone_mm_kN" = [[…]]',
        ),
        ({"case.yield_kN": 2e4}, 'write the points in the bound, "case.backbone_mm_kN" = [[…]]'),
        (
            {"case.stiffness_kN_m": {"times": 2.0}},
            'write the points in the bound, "case.backbone_mm_kN" = [[…]]',
        ),
        ({"case.spring": "epp"}, 'spring = "epp": has no points, and backbone_mm_kN is given; write a [[case]]'),
    ],
)
def test_a_bound_of_what_points_fix_is_sent_to_points(change, said):
    tables = {"pier": PIER, "motions": {"pulse": [SINE]}, "case": [BACKBONE], "bound": [{"name": "b", **change}]}
    with pytest.raises(rb.InputError) as error:
        rb.Study.from_dict(tables)
    assert said in str(error.value)
    assert len(error.value.problems) == 1


@pytest.mark.parametrize("first_corner", [10e3, 16e3])  # below and above the static force, 14 715 kN
def test_a_law_without_points_is_refused_beside_a_backbone(tmp_path, first_corner):
    points = [[5.0, first_corner], [12.0, 24e3], [40.0, 38e3]]
    with pytest.raises(rb.InputError) as error:
        study_with(tmp_path, points, spring=["epp", "backbone"])
    (problem,) = error.value.problems
    assert 'spring = "epp": has no points, and backbone_mm_kN is given; write a [[case]] of its own' in str(problem)


@pytest.mark.parametrize("path", ["case.yield_kN", "case.backbone_mm_kN"])
def test_a_design_does_not_vary_points(tmp_path, path):
    design = {"vary": path, "between": [1e4, 2e4], "find": "least", "width": 100.0}
    check = {"name": "rotation", "demand": "theta_max_over_alpha", "at_most": 0.5, "reason": "agreed"}
    study = with_tables(tmp_path, design=design, check=[check])
    with pytest.raises(rb.InputError, match="not varied; vary another key") as error:
        read_design(study)
    assert len(error.value.problems) == 1


def test_eta_below_one_is_an_input_of_analyses_where_points_bear_the_weight(tmp_path):
    study = with_tables(tmp_path, sensitivity={"uniform": {"eta": [0.6, 0.8]}})
    assert read_sensitivity(study).inputs[0].levels == (0.6, 0.8)
    pads = {"name": "pads", "base": "yielding", "beta": 50.0, "eta": 2.5}
    study = with_tables(tmp_path, case=pads, sensitivity={"uniform": {"eta": [0.6, 3.0]}})
    with pytest.raises(rb.InputError, match="the springs cannot carry the weight"):
        read_sensitivity(study)


def test_a_reference_may_have_eta_below_one(tmp_path):
    reference = {
        "record": "*",
        "case": "pads",
        "theta_max_over_alpha": 0.1,
        "eta": 0.6795786612300374,
        "source": "a test",
    }
    assert len(with_tables(tmp_path, reference=[reference]).references) == 1


def test_laws_of_points_are_no_choice_of_a_sensitivity(tmp_path):
    pads = {"name": "pads", "base": "yielding", "beta": 50.0, "eta": 2.5}
    choice = {"choice": {"spring": ["hardening", "backbone"]}}
    with pytest.raises(rb.InputError, match='expected one of "bouc-wen", "epp", "hardening"'):
        read_sensitivity(with_tables(tmp_path, case=pads, sensitivity=choice))
    with pytest.raises(rb.InputError, match='is of spring = "backbone", and these springs are'):
        read_sensitivity(with_tables(tmp_path, sensitivity={"choice": {"spring": ["hardening", "epp"]}}))


def test_a_self_similar_spectrum_has_no_backbone(tmp_path):
    spectrum = {"alpha": [0.2], "omega_g_over_p": [1.0, 4.0], "pga_over_g_tan_alpha": [1.5]}
    pier = {"alpha": 0.2, "p": 0.5, "mass_t": 3000.0}
    study = with_tables(tmp_path, pier=pier, spectrum=spectrum)
    with pytest.raises(rb.InputError, match="its points are in mm and kN of one size; leave the case out"):
        read_spectrum(study)


def test_enough_eta_is_of_springs_without_points():
    base = rb.YieldingBase(60.0, eta=0.7, spring="backbone", backbone=((1.0, 1.0), (2.0, 1.5), (3.0, 1.5)))
    with pytest.raises(AssertionError):
        enough_eta(rb.Pier(0.2, 1.0), base)
