"""What is said of supports with a backbone, of which η, F_y and δ_y are those of the first corner."""

from types import SimpleNamespace

import pytest
from check_samples import judged, runs

import rockbatch as rb
from rockbatch.checks.remarks import weak_supports
from rockbatch.common.figures.description import Look, Rule
from rockbatch.outcome.figures import _springs
from rockbatch.quantities.catalogue import DEMANDS
from rockbatch.quantities.labels import quantity
from rockbatch.reporting.differing import _shown
from rockbatch.reporting.sections.studied import _foundations
from rockbatch.results.labels import named
from rockbatch.results.run_json import describe_case
from rockbatch.study import Case
from rockbatch.study.inputs import varied

POINTS = [[5.0, 10e3], [12.0, 20e3], [40.0, 38e3]]
SOFTER = [[10.0, 8e3], [30.0, 16e3], [60.0, 20e3]]
TO_38_MN = [*POINTS, [60.0, 38e3]]


def case_of(points):
    pier = rb.Pier(alpha=0.26, p=0.7, mass_t=3000.0)
    return Case("pads", pier, rb.YieldingBase.from_backbone(pier, points, epsilon=0.05), {})


def entry(points):
    return describe_case(case_of(points))


def test_the_static_deflection_of_a_backbone_is_that_on_its_curve_under_the_weight():
    case = entry(SOFTER)
    value = float(DEMANDS["static_deflection_m"].evaluate(None, case).value[0])
    assert value == pytest.approx(0.03 - 0.02 * (16e3 - 0.5 * 3000.0 * 9.81) / 8e3, rel=1e-12)  # 26.8 mm
    assert case["parameters"]["delta_s_m"] == pytest.approx(0.0184, rel=1e-2)


def test_the_capacity_of_a_backbone_is_its_greatest_force_over_the_static_one():
    value = float(DEMANDS["eta"].evaluate(None, entry(TO_38_MN)).value[0])
    assert value == pytest.approx(38e3 / (0.5 * 3000.0 * 9.81), rel=1e-12)
    found = judged(runs([0.3]), one=entry(POINTS), demand="eta", at_least=2.0)
    assert (found.verdict, found.note) == ("does not apply", "the backbone of the supports has no greatest force")


def test_the_most_ductility_of_a_backbone_is_over_its_last_point():
    assert DEMANDS["ductility"].ceiling.value(entry(POINTS)) == pytest.approx(100.0 * 40.0 / 5.0)


def test_a_remark_on_weak_backbones_names_their_greatest_force():
    assert "it reaches its greatest force before the pier lifts off" in weak_supports(
        [entry([*POINTS[:2], [40.0, 20e3]])]
    )


def test_the_table_of_foundations_says_which_columns_are_those_of_a_first_corner():
    table = str(_foundations(SimpleNamespace(info={"cases": [entry(POINTS)], "varied": []})))
    assert table.count("of a backbone at its first corner") == 3  # η, F_y, δ_y
    assert "where the supports settle more" in table
    pads = describe_case(Case("pads", rb.Pier(0.2, 1.0), rb.YieldingBase(50.0, eta=2.0), {}))
    assert "backbone" not in str(_foundations(SimpleNamespace(info={"cases": [pads], "varied": []})))


def test_a_label_says_how_many_points_a_backbone_has_and_which_is_the_last():
    """Not its η: that of the first corner, 1.4 and 0.7, stood beside checks of η by the greatest force, and told no two apart."""
    base = rb.YieldingBase(beta=60.0, eta=2.5, epsilon=0.05, spring="epp")
    three, epp = entry(POINTS), describe_case(Case("stiff", case_of(POINTS).pier, base, {}))
    labels = [series.label for series in named({("pads",): [three], ("stiff",): [epp]}, (), {}).values()]
    told = "spring backbone of 3 points to 38,000\u00a0kN at 40\u00a0mm"
    assert [told in labels[0], "spring epp" in labels[1], "η" in labels[0]] == [True, True, False], labels
    unweighed = entry(POINTS)
    share = 38e3 / (0.5 * 3000.0 * 9.81)
    del unweighed["parameters"]["yield_kN"]
    words = quantity("spring", "backbone", case=unweighed)
    assert words == f"spring backbone of 3 points to {share:.4g}\u00a0M g/2 at 40\u00a0mm"


def test_a_comparison_shows_the_points_of_a_backbone_as_pairs():
    assert (
        _shown([[5, 10000], [12, 20000], [40, 38000], [60, 38000]], 6)
        == "[5, 10000], [12, 20000], [40, 38000], [60, 38000]"
    )
    assert _shown([5, 10], 6) == "5, 10"


@pytest.mark.parametrize(("eta", "reached"), [(0.6, [-1.0, -1.5]), (0.9, [-1.0])])
def test_the_loops_of_supports_have_a_line_at_each_corner_within_the_panel(uncompiled, eta, reached):
    points = ((1.0, 1.0), (2.0, 1.5), (3.0, 1.9), (4.0, 1.9))
    base = rb.YieldingBase(60.0, eta=eta, spring="backbone", backbone=points)
    still = rb.Motion.still(0.02, 0.01)
    response = uncompiled(rb.simulate, rb.Pier(0.2, 1.0), base, still, substeps=1, quiet_s=0.0, wait=False)
    for panel in _springs(response, Look("curve", 1), 50):
        (line,) = [mark for mark in panel.marks if isinstance(mark, Rule)]
        assert line.at.tolist() == reached
        assert line.label == "force at a corner of the backbone"


@pytest.mark.parametrize(
    ("values", "deflections", "forces"),
    [({"yield_kN": 2e4}, 2.0, 2.0), ({"stiffness_kN_m": 4e6}, 0.5, 1.0)],
    ids=["force", "stiffness"],
)
def test_inputs_of_an_analysis_scale_the_whole_backbone_as_the_pages_say(values, deflections, forces):
    parameters = describe_case(varied(case_of(POINTS), values))["parameters"]
    scaled = [
        [1e3 * parameters["delta_y_m"] * x, parameters["yield_kN"] * force] for x, force in parameters["backbone"]
    ]
    expected = [[deflections * x, forces * force] for x, force in POINTS]
    assert scaled == [pytest.approx(point, rel=1e-12) for point in expected]
