"""Studies from tables and texts of Python, changed studies, and motions in place of a study's own."""

import numpy as np
import pandas as pd
import pytest
from studies import PADS, PIER, RIGID, SINE, study_text, write_study

import rockbatch as rb
from rockbatch.study.suite import ground_motions
from rockbatch.study.tables import changed

TABLES = {
    "title": "Pier 4",
    "notes": 'Soil class "C".\n\nA backslash \\n stays one.',
    "pier": {"width_m": 4.0, "height_m": np.float64(30.0), "mass_t": 2000},
    "motions": {"pulse": [SINE], "scale": (1.0, 1.5), "target": {"pga_g": 0.4}},
    "case": [RIGID | {"name": "rock"}, PADS | {"beta": np.array([40.0, 80.0]), "damper": [{"kind": "friction", "f": 0.1}]}],
    "reference": [{"record": "*", "case": "rock", "theta_max_over_alpha": 0.1, "source": "a paper"}],
    "check": [
        {"name": name, "demand": "theta_max_over_alpha", "at_most": 0.5, "reason": "agreed", **about}
        for name, about in {"of rock": {"case": "rock"}, "of both": {"case": ["r*", "pads"]}, "of all": {}}.items()
    ],
}  # fmt: skip


@pytest.fixture
def pier4():
    return rb.Study.from_dict(TABLES)


def problems(change, *args, **more):
    with pytest.raises(rb.InputError) as caught:
        change(*args, **more)
    return list(caught.value.messages)


def facts(study):
    return {
        name: getattr(study, name)
        for name in ("title", "notes", "motions", "numerics", "cases", "references", "checks")
    }


def test_tables_text_and_file_make_the_same_study(tmp_path, pier4):
    of_file = rb.load_study(write_study(tmp_path, pier4.text))
    of_text = rb.Study.from_toml(pier4.text, tmp_path / "study.toml")
    assert of_file == of_text
    assert facts(pier4) == facts(of_file)
    assert pier4.notes == TABLES["notes"]
    assert "\n[pier]\nwidth_m = 4.0\n" in pier4.text
    assert pier4.text.splitlines()[1:5] == ['notes = """', 'Soil class \\"C\\".', "", 'A backslash \\\\n stays one."""']
    assert [case.name for case in pier4.cases] == ["rock", "pads", "pads"]
    assert pier4.motions.scale == (1.0, 1.5)


def test_mistakes_of_tables_name_table_and_key_and_those_of_a_text_its_line():
    wrong = TABLES | {"pier": {"width_m": 4.0, "height_m": -30.0}, "case": [RIGID | {"frction": 0.5}]}
    assert problems(rb.Study.from_dict, wrong | {"reference": [], "check": []}, "towers/pier4.toml") == [
        "towers/pier4.toml: [pier]: height_m = -30.0: expected a number above 0; write for example height_m = 30.0",
        'towers/pier4.toml: [[case]] "rigid": frction: unknown key; did you mean friction?',
    ]
    (problem,) = problems(rb.Study.from_toml, study_text().replace("alpha", "alhpa"), "towers/pier4.toml")
    assert problem == "towers/pier4.toml:3: [pier]: alhpa: unknown key; did you mean alpha?"
    assert problems(rb.Study.from_dict, {"pier": {"alpha": object()}}) == [
        "pier.alpha: expected a number, a text, a list or a table, not object"
    ]
    assert problems(rb.Study.from_dict, {"title": 10**5000}) == [
        "title: a whole number of more than 64 bits, which TOML does not have"
    ]
    assert 'study.toml: "a\\n\\"": unknown key' in "".join(problems(rb.Study.from_dict, TABLES | {'a\n"': 3}))
    assert all(len(problem) < 500 for problem in problems(rb.Study.from_dict, TABLES | {"x" * 600: 3}))
    nested = {}
    nested["pier"] = nested
    assert problems(rb.Study.from_dict, nested) == [
        "pier.pier.pier: tables or lists within one another, more than 32 deep"
    ]


def test_a_path_in_tables_is_relative_to_the_folder_of_the_study(tmp_path):
    (tmp_path / "records").mkdir()
    tables = {"pier": PIER, "case": [RIGID], "motions": {"path": "records"}}
    assert rb.Study.from_dict(tables, tmp_path / "x.toml").motions.paths == (tmp_path / "records",)
    assert "no such file or folder" in problems(rb.Study.from_dict, tables, tmp_path / "elsewhere" / "x.toml")[0]


def test_a_change_of_a_table_keeps_its_other_keys(tmp_path, pier4):
    of_file = rb.load_study(write_study(tmp_path, "# a comment\n" + pier4.text, "pier4.toml"))
    for study in (pier4, of_file):
        higher = study.with_(pier={"height_m": 32}, numerics={"substeps": 4}, motions={"target": None})
        assert {round(case.pier.half_width, 9) for case in higher.cases} == {2.0}
        assert higher.cases[0].pier.alpha == pytest.approx(np.arctan(4 / 32))
        assert (higher.numerics.substeps, higher.motions.target, higher.motions.scale) == (4, None, (1.0, 1.5))
        assert higher.path == study.path
        assert study.cases[0].pier.alpha == pytest.approx(np.arctan(4 / 30))
    assert rb.Study.from_toml(higher.text, of_file.path).cases == higher.cases
    other_size = pier4.with_(pier={"width_m": None, "height_m": None, "alpha": 0.2, "p": 1.0})
    assert (other_size.cases[0].pier.alpha, other_size.cases[0].pier.p) == (0.2, 1.0)


def test_named_cases_are_kept_with_what_is_about_them(pier4):
    pads = pier4.with_(case="pads")
    assert {case.name for case in pads.cases} == {"pads"}
    assert pads.references == ()
    assert [(rule.name, rule.case) for rule in pads.checks] == [("of both", ("pads",)), ("of all", ())]
    assert [case.name for case in pier4.with_(case=["pads", "rock"]).cases] == ["pads", "pads", "rock"]
    assert len(pier4.with_(case=["pads", "rock"]).checks) == 3


def test_one_case_is_changed_by_its_name_and_a_list_replaces_all(pier4):
    softer = pier4.with_(case={"pads": {"beta": 30, "damper": None}})
    assert [case.name for case in softer.cases] == ["rock", "pads"]
    assert (softer.cases[1].base.beta, softer.cases[1].base.restraints) == (30, ())
    assert [case.name for case in pier4.with_(case={"rock": None}).cases] == ["pads", "pads"]
    assert [case.name for case in pier4.with_(case=[RIGID], reference=None, check=None).cases] == ["rigid"]


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"pier": {"height_m": 4e4}}, "study.toml: [pier]: height_m = 40000: more than 400 m"),
        ({"case": "pad"}, 'case = "pad": no table has this name; did you mean "pads"?'),
        ({"case": {"tower": {}}}, 'case = "tower": no table has this name; there is "rock", "pads"'),
        ({"case": {"pads": {"damper": {"first": {}}}}}, 'case.pads.damper = "first": no table has this name; there is none'),
        ({"case": {"pads": {"bta": 3}}}, 'study.toml: [[case]] "pads": bta: unknown key; did you mean beta?'),
        ({"case": 3}, "study.toml: case: expected a list of tables"),
        ({"pier": {1: 2}}, 'study.toml: [pier]: "1": unknown key'),
        ({"motions": "\0"}, "has a NUL character"),
        ({"peir": {"height_m": 3}}, "study.toml: peir: unknown section; did you mean pier?"),
        ({"motions": []}, "motions: there are none; write for example motions = rb.read_motions(folder)"),
        ({"motions": 3}, "motions = 3: must be"),
    ],
)  # fmt: skip
def test_a_change_is_checked_as_a_file_is(pier4, change, message):
    assert message in problems(pier4.with_, **change)[0]


def test_motions_of_python_take_the_place_of_all_sources_and_stay_through_changes(tmp_path, pier4):
    wave = np.sin(np.arange(400) * 0.1)
    motions = [rb.Motion(name, 0.01, k * wave, wave) for k, name in enumerate(("a", "b"), 2)]
    study = write_study(tmp_path, pier4.text)
    for given in (motions, rb.MotionSet(motions)):
        replaced = rb.load_study(study, motions=given).with_(case="pads", motions={"select": {"pga_g": [0.25, 1]}})
        used = ground_motions(replaced)
        assert [motion.name for motion in used] == ["b"]  # selected, then brought to the study's target
        assert used[0].pga == pytest.approx(0.4 * 9.81)
        assert used[0].vertical is not None
        assert ground_motions(replaced.with_(motions={"vertical": False}))[0].vertical is None
    plain = replaced.with_(motions=rb.Motion("c", 0.01, wave))
    assert [motion.name for motion in ground_motions(plain.with_(motions={"select": None}))] == ["c"]
    assert "c has no vertical" in problems(ground_motions, plain.with_(motions={"vertical": "required"}))[0]
    assert problems(rb.load_study, study, motions=[motions[0], motions[0]]) == [
        'motions: 2 are called "a"; give each its own name'
    ]


def test_runs_of_motions_from_python_are_those_of_their_files(tmp_path):
    folder, study = tmp_path / "records", write_study(tmp_path, study_text(cases=[RIGID]))
    folder.mkdir()
    wave = 3.0 * np.sin(np.arange(400) * 0.05)
    (folder / "wave.csv").write_text(
        "\n".join(["time,000", *(f"{0.01 * n:.2f},{a!r}" for n, a in enumerate(wave.tolist()))])
    )
    motions = rb.read_motions(folder, options=rb.ReadOptions("m/s2", role="horizontal"))
    of_python = rb.run(study, motions=motions)
    changed = rb.load_study(study).with_(motions={"unit": "m/s2", "role": "horizontal"})
    pd.testing.assert_frame_equal(of_python, rb.run(changed, motions=folder))
    kept = rb.run(rb.load_study(study), tmp_path / "out", motions=motions)
    assert list(kept["record"]) == ["wave"]
    assert rb.open_results(tmp_path / "out").info["command"][-2:] == ["--motions", "(motions from Python)"]
    for given in (folder, str(folder)):
        rb.run(changed, tmp_path / "again", motions=given, fresh=True)
        assert rb.open_results(tmp_path / "again").info["command"][-2:] == ["--motions", str(folder)]


@pytest.mark.sweep(fast=1)
@pytest.mark.parametrize("way", ["tables", "changed"])
@pytest.mark.usefixtures("pages")
def test_a_study_that_no_file_holds_names_none_in_what_repeats_it(tmp_path, way):
    """A file of that name may be another study; the report says how to have more histories without a command."""
    path = write_study(tmp_path, study_text(cases=[RIGID]))
    study = rb.load_study(path)
    rb.run(study, tmp_path / "file")
    other = study.with_(title="Other", output={"histories": "worst"})
    if way == "tables":
        other = rb.Study.from_toml(other.text, tmp_path / "gone.toml")
    rb.run(other, tmp_path / "out")
    assert rb.open_results(tmp_path / "file").info["command"][:3] == ["rockbatch", "run", str(path)]
    assert rb.open_results(tmp_path / "out").info["command"][:3] == ["rockbatch", "run", "(study from Python)"]
    page = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    assert "Histories of the runs under another record" in page
    assert "--history" not in page


def test_a_study_is_shown_in_a_few_lines(tmp_path, pier4):
    assert repr(pier4).splitlines() == [
        "<study 'Pier 4'>",
        "  pier      alpha 0.1326 rad, R0 15.13 m",
        "  motions   1 pulse",
        "  cases     rock, pads (2)",
        "  varied    beta",
        "  checks    of rock, of both, of all",
        "  numerics  error of theta_max/alpha below 0.0001",
    ]
    several = pier4.with_(
        pier={"height_m": [30.0, 32.0]}, numerics={"substeps": 2}, motions=rb.Motion("c", 0.01, np.ones(9))
    )
    assert "motions   still ground for 5 s\n" in repr(
        pier4.with_(motions={"pulse": None, "target": None, "scale": None, "still_s": 5.0})
    )
    told = repr(several)
    assert "2 piers" in told
    assert "1 motion\n" in told
    assert "2 steps per sample" in told


def test_an_analysis_of_a_study_from_tables_reports_its_mistakes_without_lines(pier4):
    study = pier4.with_(fragility={"measure": "PGA", "levels_g": [0.2]}, motions={"scale": None, "target": None})
    assert problems(rb.fragility, study) == [
        "study.toml: [fragility]: levels_g = [0.2]: one level does not determine a dispersion; write at least two"
    ]


def test_tables_of_one_name_are_changed_and_kept_alike():
    tables = {"reference": [{"base": "rigid", "x": 1}, {"base": "rigid", "x": 2}, {"name": "a", "x": 3}]}
    other = changed(tables, {"reference": {"a": {"x": 4}}})["reference"]
    assert [table["x"] for table in other] == [1, 2, 4]
    assert [table["x"] for table in changed(tables, {"reference": {"rigid": {"x": 5}}})["reference"]] == [5, 5, 3]
    assert [table["x"] for table in changed(tables, {"reference": {"rigid": None}})["reference"]] == [3]
    assert [table["x"] for table in changed(tables, {"reference": ["a", "rigid"]})["reference"]] == [3, 1, 2]
