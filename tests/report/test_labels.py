"""Names of foundations: by what distinguishes them, in the study's own keys and units, with no more digits than necessary."""

import math
from dataclasses import replace

import pytest
from check_samples import case
from report_samples import write_results
from studies import RIGID, study_text, write_study

import rockbatch as rb
from rockbatch.analyses.design.figures import axis_label
from rockbatch.analyses.fragility.figures import label
from rockbatch.pier import RigidBase, Tendon, YieldingBase
from rockbatch.quantities.catalogue import COLUMNS
from rockbatch.quantities.labels import distinguishing_digits, in_full, plain, quantity, record_labels
from rockbatch.reporting.finished import read
from rockbatch.reporting.finished_analysis import named as named_by
from rockbatch.reporting.labels import head
from rockbatch.results.labels import named, under_bounds
from rockbatch.workflow.analysis import AnalysisFolder

MASS = {"width_m": 4.0, "height_m": 20.0, "mass_t": 1000.0}


def labels(folder, *cases, pier=MASS):
    """Return the labels of the foundations of a study with these cases."""
    rb.run(write_study(folder, study_text(pier=pier, cases=cases, output={"histories": "none"})), out=folder / "out")
    return [series.label for series in read(folder / "out").series]


def test_digits_are_as_many_as_tell_values_apart():
    assert distinguishing_digits([40.0, 50.0, 50.0, "epp", None]) == 3
    assert distinguishing_digits([1001.0, 1002.0]) == 4
    assert distinguishing_digits([0.123456, 0.123457]) == 6
    assert distinguishing_digits([1.0, 1.0 + 1e-15]) == distinguishing_digits([1.0, 1.0 + 1e-9]) == 10


PADS = {"name": "pads", "base": "yielding"}
HELD = {"damper": [{"kind": "friction", "f": [0.01, 0.02]}]}


@pytest.mark.parametrize(
    ("cases", "names"),
    [
        ([RIGID, PADS | {"stiffness_kN_m": 1.5e6, "yield_kN": [9e3, 12.3456e3]}],
         ["rigid", "pads: Fy = 9000 kN", "pads: Fy = 12,346 kN"]),
        ([PADS | {"beta": [30.0, 40.0], "eta": 2.5}], ["β = 30", "β = 40"]),  # a name that all share tells nothing apart
        ([{"name": "one", "base": "elastic", "beta": 30.0}, {"name": "other", "base": "elastic", "stiffness_kN_m": 1.5e6}],
         ["one: β = 30", "other: K = 1.5 × 10⁶ kN/m"]),
        ([RIGID, RIGID | {"name": "held"} | HELD, {"name": "pads", "base": "elastic", "stiffness_kN_m": 1.5e6} | HELD],
         ["rigid", "held: f = 0.01", "held: f = 0.02", "pads: f = 0.01", "pads: f = 0.02"]),
        ([PADS | {"beta": [30.0, 40.0], "eta": 2.5}, PADS | {"name": "held", "beta": 40.0, "eta": 2.5},
          {"name": "soil", "base": "footing", "width_m": 4.0, "length_m": 6.0, "stiffness_MN_m3": 600.0, "bearing_MPa": 3.0}],
         ["pads: β = 30", "pads: β = 40", "held: β = 40", "soil"]),  # a footing has no spring law, which tells none apart
    ],
)  # fmt: skip
def test_a_foundation_is_called_by_the_keys_of_its_study_that_tell_it_apart(tmp_path, cases, names):
    assert [label.replace("\u00a0", " ") for label in labels(tmp_path, *cases)] == names


def test_a_footing_on_soil_is_called_by_its_safety_factor():
    """Not by β, which its study does not give; by β if it does."""
    ground = {"clay": {"beta": 82.0, "safety_factor": 3.0}, "sand": {"beta": 126.0, "safety_factor": 10.0}}
    cases = {(name,): [{"base": "footing", "parameters": values, "columns": {}}] for name, values in ground.items()}
    soil, beta = ({name: keys for name in ground} for keys in ({"shear_modulus_MPa"}, {"beta"}))
    spoken = [
        [series.label.replace("\u00a0", " ") for series in named(cases, (), given).values()] for given in (soil, beta)
    ]
    assert spoken[0] == ["clay: FS = 3", "sand: FS = 10"]
    assert spoken[1] == ["clay: β = 82, FS = 3", "sand: β = 126, FS = 10"]


@pytest.mark.parametrize(
    ("key", "value", "words"),
    [
        ("damper_1_coefficient_kN_s_m", 900.0, "C = 900 kN (s/m)^a"), ("damper_2_force_kN", 450.0, "damper 2: F = 450 kN"),
        ("tendon_1_psi", 0.5, "ψ = 0.5"), ("deck_spring_2_gap_mm", 20.0, "deck spring 2: gap = 20 mm"),
        ("damper_1_kind", "viscous", "kind viscous"), ("beta", 50.65704515, "β = 50.65704515"),
        ("yield_kN", 999.0, "Fy = 999 kN"), ("yield_kN", 37000.0, "Fy = 37,000 kN"),
        ("stiffness_kN_m", 2.5e6, "K = 2.5 × 10⁶ kN/m"), ("zeta", 0.00005, "ζ = 5 × 10⁻⁵"), ("zeta", 0.0001, "ζ = 0.0001"),
    ],
)  # fmt: skip
def test_varied_values_are_called_by_symbol_and_unit(key, value, words):
    assert quantity(key, value).replace("\u00a0", " ") == words


@pytest.mark.parametrize(
    ("value", "written"),
    [
        (999.7, "1000"),
        (9999.6, "10,000"),
        (99999.6, "100,000"),
        (999_999.6, "1 × 10⁶"),
        (4500.4, "4500"),
        (-3.21e-7, "-3.21 × 10⁻⁷"),
        (0.0, "0"),
    ],
)
def test_no_number_is_written_with_an_e_however_few_its_digits(value, written):
    assert plain(value, 3) == written


def test_a_case_is_called_by_its_name_and_all_its_varied_values_in_words():
    values = {
        "damper_1_f": 0.05,
        "deck_spring_2_gap_mm": 20.0,
        "beta": 80.0,
        "kinematics": "finite",
        "tendon_1_psi": math.nan,
        "bound": "stiff",
        "scale": "",
    }
    words = "pads: f = 0.05, deck spring 2: gap = 20 mm, β = 80, kinematics finite, stiff"
    assert in_full("pads", values).replace("\u00a0", " ") == words
    assert in_full("pads", {}) == "pads"


PAD, HARD, SOFT = YieldingBase(50.0, eta=2.5), RigidBase(), RigidBase(restitution=0.5)
TIED = RigidBase(restraints=(Tendon(psi=0.1, lam=0.5),))


@pytest.mark.parametrize(
    ("bases", "keyed", "ticks", "lines"),
    [
        ({"rigid": HARD, "1": PAD, "2": replace(PAD, eta=3.5)}, ["rigid", "1: η = 2.5", "2: η = 3.5"], ["rigid", "1", "2"], [0]),
        ({"1": PAD, "2": replace(PAD, epsilon=0.1)}, ["1: ε = 0", "2: ε = 0.1"], ["1", "2"], []),
        ({"rigid": HARD, "pads": PAD, "soft": replace(PAD, eta=3.5)}, ["rigid", "a – pads: η = 2.5", "b – soft: η = 3.5"],
         ["a", "a", "b"], [0]),
        ({"hard": HARD, "soft": SOFT}, ["a – hard", "b – soft: e = 0.5"], ["a", "b"], []),  # none to compare with
        ({"hard": HARD}, ["hard"], ["hard"], [0]),
        ({"hard": HARD, "tied": TIED}, ["hard", "a – tied"], ["a", "a"], [0]),
        ({"tied": TIED, "held": TIED, "pads": PAD}, ["a – tied", "b – held", "c – pads"], ["a", "b", "c"], []),
        ({f"pads {k}": replace(PAD, eta=2.0 + k) for k in range(28)}, None, [*"abcdefghijklmnopqrstuvwxyz", "27", "28"], []),
    ],
)  # fmt: skip
def test_foundations_have_short_names_or_letters_and_rigid_ground_is_a_line(bases, keyed, ticks, lines):
    """Rigid ground is a line that others are compared with: not if there is nothing else, and not with devices."""
    found = [*named({(name,): [case(name, base)] for name, base in bases.items()}, (), {}).values()]
    assert keyed is None or [one.keyed.replace("\u00a0", " ") for one in found] == keyed
    assert [one.tick for one in found] == ticks
    assert [place for place, one in enumerate(found) if one.rigid] == lines
    for rigid in (True, False):
        own = [one.index for one in found if one.rigid is rigid]
        assert own == [*range(len(own))]


def test_foundations_under_bounds_have_their_own_letters_and_the_bound_in_labels():
    bases = {"rigid": HARD, "1": PAD, "2": replace(PAD, eta=3.5)}
    nominal = named({(name,): [case(name, base)] for name, base in bases.items()}, (), {})
    designs = {(*key, ""): one for key, one in nominal.items()}
    found = under_bounds(designs, [(name, bound) for name in bases for bound in ("", "stiff", "soft")])
    of = {key: (one.label.replace("\u00a0", " "), one.tick, one.rigid, one.index) for key, one in found.items()}
    assert of == {
        ("rigid", ""): ("rigid", "a", True, 0), ("rigid", "stiff"): ("rigid: stiff", "b", True, 1),
        ("rigid", "soft"): ("rigid: soft", "c", True, 2), ("1", ""): ("1: η = 2.5", "a", False, 0),
        ("1", "stiff"): ("1: η = 2.5, stiff", "b", False, 1), ("1", "soft"): ("1: η = 2.5, soft", "c", False, 2),
        ("2", ""): ("2: η = 3.5", "d", False, 3), ("2", "stiff"): ("2: η = 3.5, stiff", "e", False, 4),
        ("2", "soft"): ("2: η = 3.5, soft", "f", False, 5),
    }  # fmt: skip


def test_a_run_says_what_else_than_its_foundation_tells_it_from_others_of_its_record(tmp_path):
    write_results(tmp_path, scales=(1.0, 2.0))
    finished = read(tmp_path)
    run = finished.runs[finished.runs["scale"] == 2.0].iloc[0].to_dict()
    turned = finished.case_of(run | {"polarity": "-"})
    assert finished.case_of(run | {"polarity": "+"}) == turned.replace(", reversed", "")
    assert "motions scaled by 2, reversed" in turned


@pytest.mark.parametrize(
    ("key", "unit"),
    [
        ("damper_1_coefficient_kN_s_m", "C = 900 kN s/m"),
        ("damper_2_coefficient_kN_s_m", "damper 2: C = 900 kN (s/m)^0.3"),
        ("tendon_1_stiffness_kN_m", "kt = 900 kN/m"),
    ],
)
def test_the_unit_of_a_viscous_coefficient_has_the_exponent_of_its_own_damper(key, unit):
    oil = {"device": "damper", "kind": "viscous"}
    devices = [oil | {"exponent": 1.0}, {"device": "tendon", "psi": 0.2}, oil | {"exponent": 0.3}]
    case = {"columns": {}, "parameters": {"restraints": devices}}
    assert quantity(key, 900.0, case=case).replace("\u00a0", " ") == unit


def test_legends_name_a_viscous_coefficient_with_the_unit_of_its_exponent(tmp_path):
    oil = {"kind": "viscous", "coefficient_kN_s_m": [500.0, 900.0], "exponent": 0.3}
    names = [label.replace("\u00a0", " ") for label in labels(tmp_path, RIGID | {"damper": [oil]})]
    assert names == ["C = 500 kN (s/m)^0.3", "C = 900 kN (s/m)^0.3"]


@pytest.mark.parametrize("exponent", [0.3, [0.3, 1.0]])
def test_analyses_name_a_viscous_coefficient_with_the_unit_of_its_exponent(tmp_path, exponent):
    oil = {"kind": "viscous", "coefficient_kN_s_m": [500.0, 900.0], "exponent": exponent}
    cases = [RIGID, RIGID | {"name": "oil", "damper": [oil]}]
    study = rb.load_study(write_study(tmp_path, study_text(pier=MASS, cases=cases)))
    info = AnalysisFolder(tmp_path, "fragility", study).info
    names = [label(info, {"case": case.name, "columns": case.columns}).replace("\u00a0", " ") for case in study.cases]
    if exponent == 0.3:
        assert names == ["rigid", "oil: C = 500 kN (s/m)^0.3", "oil: C = 900 kN (s/m)^0.3"]
    else:
        units = "kN (s/m)^0.3, a = 0.3", "kN s/m, a = 1"
        assert names == ["rigid", *(f"oil: C = {value} {unit}" for value in (500, 900) for unit in units)]
    (_, entry, *_) = info["cases"]
    assert axis_label("case.damper.coefficient_kN_s_m", entry) == "damper: C [kN (s/m)^0.3]"


SCAN = {"vary": "case.restitution", "between": [0.8, 0.9], "find": "least", "points": 3, "width": 0.04}
PEAK = {"name": "peak", "demand": "theta_max_over_alpha", "at_most": 0.9, "reason": "made up"}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("analysis", "tables"),
    [
        (rb.spectrum, {"spectrum": {"alpha": [0.2], "p": [1.0, 2.0], "points": 3}}),
        (rb.sensitivity, {"sensitivity": {"statistic": "max", "samples": 4, "uniform": {"restitution": [0.85, 0.9]}}}),
        (rb.release, {"release": {"impact_s": [0.3, 0.8, 1.3]}}),
        (rb.design, {"design": SCAN, "check": [PEAK]}),
    ],
)
def test_every_analysis_names_its_panels_with_the_unit_of_a_viscous_exponent(tmp_path, analysis, tables):
    oil = {"kind": "viscous", "coefficient_kN_s_m": [500.0, 900.0], "exponent": 0.3}
    case = {"name": "oil", "base": "rigid", "restitution": 0.9, "damper": [oil]}
    pier = MASS | ({"initial_rotation_rad": 0.1} if "release" in tables else {})
    study = rb.load_study(write_study(tmp_path, study_text(pier=pier, cases=[case], **tables)))
    titles = {axes.get_title().replace("\u00a0", " ") for axes in analysis(study).plot().axes}
    for coefficient in (500, 900):
        assert any(f"C = {coefficient} kN (s/m)^0.3" in title for title in titles)


def test_without_its_case_a_viscous_coefficient_keeps_the_letter_of_its_exponent():
    key = "damper_1_coefficient_kN_s_m"  # an analysis of an earlier version does not list its cases
    assert named_by({}, {"case": "oil", key: 900.0}, [key]).replace("\u00a0", " ") == "oil: C = 900 kN (s/m)^a"


def test_a_record_without_a_label_is_called_by_its_name():
    records = [{"record": "a", "label": "Town Hall NS"}, {"record": "b", "label": None}, {"record": "c"}]
    assert record_labels({"records": records}) == {"a": "Town Hall NS", "b": "b", "c": "c"}


def test_a_heading_names_its_column_and_the_factor_only_if_the_page_has_one():
    for column in COLUMNS.values():
        if column.page is not None:
            factor = f" × {column.page.factor}" if column.page.factor != 1.0 else ""
            assert head(column).note == f"{column.name}{factor}: {column.meaning}"
