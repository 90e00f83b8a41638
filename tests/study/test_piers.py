"""Piers with masses in a study: deck, parts, frame, stiffness and strength in kN, and what is refused."""

import json
from pathlib import Path

import pandas as pd
import pytest
from report_page import Page

import rockbatch as rb
from rockbatch.analyses.sensitivity.sampled import low_base_high
from rockbatch.analyses.sensitivity.study import applying, read_sensitivity
from rockbatch.analyses.spectrum.study import read_spectrum
from rockbatch.commands.cli import main
from rockbatch.common.errors import InputError
from rockbatch.pier import Part, Pier, places
from rockbatch.study import load_study
from rockbatch.study.inputs import varied

PULSE = (
    '[[motions.pulse]]\nname = "sine"\nshape = "sine"\namplitude_g = 0.2\nperiod_s = 1.0\ndt_s = 0.01\nduration_s = 2\n'
)
RIGID = '[[case]]\nname = "rigid"\nbase = "rigid"\n'
PADS = '[[case]]\nname = "pads"\nbase = "yielding"\nstiffness_kN_m = 2e6\nyield_kN = 4e4\n'
SHAFT = "width_m = 4\nheight_m = 30\nmass_t = 2000\n"
PARTS = "width_m = 4\n[[pier.part]]\nmass_t = 1\nheight_m = 2\n"
FRAME = "width_m = 1.5\nheight_m = 10\nmass_t = 35\ndeck_mass_t = 420\ncolumns = 4\n"


def written(folder: Path, pier: str, *rest: str) -> Path:
    path = folder / "study.toml"
    path.write_text("".join([f"[pier]\n{pier}", PULSE, *(rest or (RIGID,))]), encoding="utf-8")
    return path


def study_of(folder, pier, *rest):
    return load_study(written(folder, pier, *rest))


def problems_of(folder, pier, *rest):
    with pytest.raises(InputError) as caught:
        study_of(folder, pier, *rest)
    return [problem.removeprefix(f"{folder / 'study.toml'}:") for problem in caught.value.messages]


@pytest.mark.parametrize(
    ("keys", "pier"),
    [
        (SHAFT, Pier.rectangle(4.0, 30.0, mass_t=2000.0)),
        (SHAFT + "top_m = 31", Pier.rectangle(4.0, 30.0, mass_t=2000.0, top_m=31.0)),
        ("alpha = 0.13\np = 0.38\nmass_t = 3000", Pier(0.13, 0.38, mass_t=3000.0)),
        (SHAFT + "deck_mass_t = 1000", Pier.with_deck(4.0, 30.0, 2000.0, 1000.0)),
        (
            SHAFT + "deck_mass_t = 1000\ndeck_height_m = 28\ndeck_inertia_t_m2 = 5e4\ngravity = 9.8",
            Pier.with_deck(4.0, 30.0, 2000.0, 1000.0, deck_height_m=28.0, deck_inertia_t_m2=5e4, gravity=9.8),
        ),
        (
            "width_m = 6\n[[pier.part]]\nmass_t = 900\nheight_m = 10\ninertia_t_m2 = 3e4\n"
            "[[pier.part]]\nmass_t = 300\nheight_m = 25",
            Pier.of_parts(6.0, [Part(900.0, 10.0, 3e4), Part(300.0, 25.0)]),
        ),
        (
            "width_m = 6\ndeck_height_m = 24\ndeck_mass_t = 300\n[[pier.part]]\nmass_t = 900\nheight_m = 10\ninertia_t_m2 = 3e4",
            Pier.of_parts(6.0, [Part(900.0, 10.0, 3e4), Part(300.0, 24.0, length_m=0.0)], deck_height_m=24.0),
        ),
        (
            "width_m = 6\n[[pier.part]]\nmass_t = 900\nheight_m = 10\nlength_m = 20\nwidth_m = 2\napart_m = 5\n"
            "[[pier.part]]\nmass_t = 300\nheight_m = 25\nlength_m = 2\nwidth_m = 7",
            Pier.of_parts(6.0, [Part.rectangle(900.0, 10.0, 20.0, 2.0, 5.0), Part.rectangle(300.0, 25.0, 2.0, 7.0)]),
        ),
        (FRAME, Pier.frame(Pier.rectangle(1.5, 10.0, mass_t=35.0), 4, 420.0)),
        (
            "alpha = 0.15\np = 1\nmass_t = 100\ndeck_mass_t = 200\ncolumns = 2",
            Pier.frame(Pier(0.15, 1.0, mass_t=100.0), 2, 200.0),
        ),
    ],
)
def test_what_is_written_under_pier_is_the_pier(tmp_path, keys, pier):
    assert study_of(tmp_path, keys + "\n").cases[0].pier == pier


def test_every_combination_of_lists_is_a_case_with_its_own_columns(tmp_path):
    keys = "width_m = 4\nheight_m = 30\nmass_t = [2000, 1500]\ndeck_mass_t = [500, 1000]\ntop_m = [30, 32]\n"
    study = study_of(tmp_path, keys, RIGID, PADS)
    assert study.varied == ("mass_t", "deck_mass_t", "top_m")
    assert len(study.cases) == 16
    for case in study.cases:
        told = case.columns
        pier = Pier.with_deck(4.0, 30.0, told["mass_t"], told["deck_mass_t"], top_m=told["top_m"])
        assert case.pier == pier
        if case.name == "pads":
            assert case.base == rb.YieldingBase.from_stiffness(pier, 2e6, 4e4)


def test_lists_of_parts_and_of_columns_are_combined_too(tmp_path):
    part = "[[pier.part]]\nmass_t = [900, 800]\nheight_m = 10\ninertia_t_m2 = [3e4, 4e4]\n"
    part += "[[pier.part]]\nmass_t = 300\nheight_m = [25, 26]\n"
    reference = (
        '[[reference]]\nrecord = "*"\ncase = "rigid"\npart_2_height_m = 26\ntheta_max_over_alpha = 0.1\nsource = "S"\n'
    )
    study = study_of(tmp_path, "width_m = 6\n" + part, RIGID, reference)
    assert study.varied == ("part_1_mass_t", "part_1_inertia_t_m2", "part_2_height_m")
    parts = [[Part(m, 10.0, i), Part(300.0, h)] for m in (900.0, 800.0) for i in (3e4, 4e4) for h in (25.0, 26.0)]
    assert [case.pier for case in study.cases] == [Pier.of_parts(6.0, each) for each in parts]
    assert study.references[0].columns == {"part_2_height_m": 26.0}

    frames = study_of(tmp_path, FRAME.replace("columns = 4", "columns = [2, 4, 8]"))
    assert [case.columns["columns"] for case in frames.cases] == [2, 4, 8]
    assert frames.cases[2].pier.deck_over_columns == pytest.approx(420 / (8 * 35))


@pytest.mark.parametrize(
    ("keys", "said"),
    [
        (SHAFT.replace("mass_t = 2000\n", "deck_mass_t = 9\n"), "4: [pier]: mass_t is missing beside deck_mass_t, of the pier"),
        ("alpha = 0.1\np = 1\nmass_t = 10\ndeck_mass_t = 9\n", "5: [pier]: deck_mass_t: goes with width_m and height_m"),
        (SHAFT + "deck_height_m = 31\n", "5: [pier]: deck_height_m: there is no deck; write deck_mass_t too"),
        (SHAFT + "deck_inertia_t_m2 = 31\n", "5: [pier]: deck_inertia_t_m2: there is no deck"),
        ("width_m = 4\nmass_t = 9\n[[pier.part]]\nmass_t = 1\nheight_m = 2\n", "3: [pier]: mass_t: the mass of the pier"),
        ("width_m = 4\n[[pier.part]]\nmass_t = 1\n", "3: [[pier.part]] no. 1: height_m is missing; write for example"),
        ("width_m = 4\n[[pier.part]]\nmass_t = 1\nheight_m = 2\n", "1: [pier]: parts: they have no rotary inertia"),
        ("width_m = 4\n[[pier.part]]\nmass_t = 1\nheight_m = 2\nheigth_m = 2\n", "6: [[pier.part]] no. 1: heigth_m: unknown key"),
        ("alpha = 0.1\np = 1\n[[pier.part]]\nmass_t = 1\nheight_m = 2\n", "4: [pier]: [[pier.part]]: needs width_m"),
        ("width_m = 4\ndeck_mass_t = 3\n[[pier.part]]\nmass_t = 1\nheight_m = 2\n", "3: [pier]: deck_height_m is missing"),
        (PARTS + "width_m = 2\n", "6: [[pier.part]] no. 1: length_m is missing beside width_m"),
        (PARTS + "apart_m = 2\ninertia_t_m2 = 9\n", "6: [[pier.part]] no. 1: width_m is missing beside apart_m, of each leg"),
        (PARTS + "inertia_t_m2 = 9\nlength_m = 2\nwidth_m = 2\n", "6: [[pier.part]] no. 1: inertia_t_m2 and width_m are given"),
        ("width_m = 4\npart = []\n", "3: [pier]: part = []: a pier has one part at least"),
        ("width_m = 4\n[pier.part]\nmass_t = 1\nheight_m = 2\n", "3: pier.part: expected a list of tables; write [[pier.part]]"),
        ("width_m = 4\nheight_m = 9\n[[pier.part]]\nmass_t = 1\nheight_m = 2\n", "3: [pier]: height_m: the parts say how high"),
        ("height_m = [9, 8]\nwidth_m = 4\n[[pier.part]]\nmass_t = 1\nheight_m = 2\n", "2: [pier]: height_m: the parts say how"),
        ("width_m = 4\nheight_m = 9\ndeck_mass_t = 3\ndeck_height_m = 4\n[[pier.part]]\nmass_t = 1\nheight_m = 2\n",
         "3: [pier]: height_m: the parts say how high the pier is; call it top_m if drift is to be read at this height"),
        ("alpha = 0.1\np = 1\ntop_m = 100\n", "4: [pier]: top_m = 100: 6.8 times the height of the pier, 14.6"),
        (FRAME.replace("= 4", "= 1"), "6: [pier]: columns = 1: expected a whole number, 2 or above"),
        (FRAME.replace("deck_mass_t = 420\n", ""), "5: [pier]: columns: a frame has a deck; write deck_mass_t"),
        (FRAME + "top_m = 12\n", "7: [pier]: top_m: the deck of a frame stays level"),
        (FRAME + "deck_height_m = 12\n", "7: [pier]: deck_height_m: the deck of a frame rests on its columns"),
    ],
)  # fmt: skip
def test_a_mass_is_said_once_and_where_it_is(tmp_path, keys, said):
    (problem,) = problems_of(tmp_path, keys)
    assert problem.startswith(said)


SIZES = {"p": 0.4, "size_m": 20.0, "width_m": 4.0, "height_m": 30.0, "alpha": 0.13, "mu": 1.3}


@pytest.mark.parametrize(
    ("keys", "wrong"),
    [
        ("p alpha", []), ("size_m alpha", []), ("p alpha mu", []), ("width_m height_m", []), ("p", ["alpha"]),
        ("size_m mu", ["alpha"]), ("alpha", ["its size"]), ("", ["its size", "alpha"]), ("width_m", ["height_m"]),
        ("height_m", ["width_m"]), ("width_m alpha", ["height_m", "alpha"]), ("width_m height_m mu", ["mu"]),
        ("width_m height_m alpha", ["alpha"]), ("p size_m alpha", ["p and size_m"]),
        ("width_m height_m p", ["width_m, height_m and p"]), ("height_m size_m", ["height_m and size_m"]),
        ("p size_m", ["p and size_m", "alpha"]),
    ],
)  # fmt: skip
def test_a_pier_is_given_by_one_size_and_an_angle_or_by_its_sides(keys, wrong):
    """Every message begins with what is missing, follows from others, or is given twice."""
    pier = {name: SIZES[name] for name in keys.split()}
    tables = {"pier": pier, "motions": {"still_s": 5.0}, "case": [{"name": "rock", "base": "rigid"}]}
    said = []
    try:
        rb.Study.from_dict(tables)
    except rb.InputError as error:
        said = [message.partition("[pier]: ")[2] for message in error.messages]
    assert len(said) == len(wrong)
    assert all(any(message.startswith(f"{name} ") for message in said) for name in wrong), said


def test_the_mass_of_the_pier_serves_its_cases_and_is_said_once(tmp_path):
    pier = Pier.with_deck(4.0, 30.0, 2000.0, 1000.0)
    deck = SHAFT + "deck_mass_t = 1000\n"
    case = study_of(tmp_path, deck, PADS).cases[0]
    assert case.base == rb.YieldingBase.from_stiffness(pier, 2e6, 4e4)
    (twice,) = problems_of(tmp_path, deck, PADS + "mass_t = 3000\n")
    assert "mass_t = 3000: [pier] states the pier's mass already; leave it out" in twice
    (weak,) = problems_of(tmp_path, deck, PADS.replace("4e4", "1e4"))
    assert "yield_kN = 10000 with the 3000 t of [pier] means eta = 0.679579" in weak
    assert 14715.0 < float(weak.rpartition("write yield_kN above ")[2]) < 14800.0  # half the weight, and a little more


def test_a_frame_on_springs_is_refused_where_the_case_stands(tmp_path):
    (problem,) = problems_of(tmp_path, FRAME, RIGID, '[[case]]\nname = "soft"\nbase = "elastic"\nbeta = 60\n')
    assert problem.startswith('17: [[case]] "soft": columns: a rocking frame is solved on rigid ground only')


# From the study to its results


def test_drift_is_read_at_the_top_and_forces_in_kilonewtons(tmp_path):
    """θ times top_m; 2 h where no top is known; F_y and K as they were given; a rigid base has neither."""
    checks = "".join(
        f'[[check]]\nname = "{demand}"\ndemand = "{demand}"\n{sense} = {limit}\nreason = "r"\n'
        for demand, sense, limit in (
            ("top_drift_m", "at_most", 1.5),
            ("yield_kN", "at_least", 3e4),
            ("theta_max_rad", "at_most", 0.08),
        )
    )
    keys = SHAFT + "deck_mass_t = 1000\ntop_m = [31.5, 20]\n"
    path = written(tmp_path, keys, RIGID, PADS, checks)
    assert main(["run", str(path), "--out", str(tmp_path / "out")]) == 0
    table = rb.check(tmp_path / "out").set_index(["case", "top_m", "check"])["value"]
    for case in ("rigid", "pads"):
        for top in (31.5, 20.0):
            assert table[case, top, "top_drift_m"] == pytest.approx(top * table[case, top, "theta_max_rad"], rel=1e-9)
            assert table[case, top, "top_drift_m"] > 0
    assert table["pads", 20.0, "yield_kN"] == pytest.approx(4e4, rel=1e-12)
    assert pd.isna(table["rigid", 20.0, "yield_kN"])
    info = json.loads((tmp_path / "out" / "run.json").read_text())
    pads = next(case for case in info["cases"] if case["case"] == "pads")
    assert (pads["pier"]["mass_t"], pads["pier"]["top_m"]) == (3000.0, 31.5)
    assert pads["parameters"]["stiffness_kN_m"] == pytest.approx(2e6, rel=1e-12)
    response = rb.open_results(tmp_path / "out").response(case="pads", top_m=20.0)
    assert response.pier == Pier.with_deck(4.0, 30.0, 2000.0, 1000.0, top_m=20.0)


IN_PARTS = {"width_m": 4.0, "part": [{"mass_t": 1000.0, "height_m": 30.0, "length_m": 60.0, "width_m": 4.0}]}
PULSES = {
    "pulse": [{"name": "s", "shape": "sine", "amplitude_g": 0.3, "period_s": 2.0, "dt_s": 0.02, "duration_s": 4.0}]
}


def of_parts(**keys):
    return {"pier": IN_PARTS | keys, "motions": PULSES, "case": [{"name": "rigid", "base": "rigid"}]}


@pytest.mark.parametrize("height", [60.0, [50.0, 60.0]])
def test_a_height_beside_parts_is_refused_by_every_door(height):
    said = r"height_m: the parts say how high the pier is; call it top_m"
    with pytest.raises(InputError, match=said):
        rb.Study.from_dict(of_parts(height_m=height))
    with pytest.raises(InputError, match=said):
        rb.Study.from_dict(of_parts()).with_(pier={"height_m": height})
    across = of_parts(height_m=height) | {"case": [{"name": "r", "base": "rigid", "other_width_m": 6.0}]}
    across["motions"] = PULSES | {"axis_deg": 0.0}
    with pytest.raises(InputError, match=said):
        rb.Study.from_dict(across)


def test_the_advice_about_a_height_beside_parts_reads_the_drift_there():
    drift = rb.run(rb.Study.from_dict(of_parts(top_m=[30.0, 60.0])))["top_drift_m"]
    assert drift[0] == pytest.approx(0.5 * drift[1], rel=1e-12)
    (ended,) = rb.run(rb.Study.from_dict(of_parts()))["top_drift_m"]
    assert ended == drift[1] > 0.0


def test_a_pier_of_one_part_drifts_as_the_same_pier_by_width_and_height():
    whole = of_parts() | {"pier": {"width_m": 4.0, "height_m": 60.0, "mass_t": 1000.0}}
    row, same = (rb.run(rb.Study.from_dict(tables)).iloc[0] for tables in (of_parts(), whole))
    for name in ("theta_max_over_alpha", "top_drift_m", "heel_uplift_m", "drift_height_m"):
        assert row[name] == pytest.approx(same[name], rel=1e-9), name


def test_every_drift_of_a_folder_says_its_own_height(tmp_path, capsys):
    """Two piers, whose drift is read at different heights: the heights are numbers, by which all words are made."""
    check = '[[check]]\nname = "joint"\ndemand = "top_drift_m"\nat_most = 1.0\nreason = "r"\n'
    path = written(tmp_path, SHAFT + "top_m = [28.5, 15]\n", RIGID, check)
    main(["run", str(path), "--out", str(tmp_path / "out")])
    told = capsys.readouterr().out
    results = rb.open_results(tmp_path / "out")
    assert [case["pier"]["top_m"] for case in results.info["cases"]] == [28.5, 15.0]
    assert results.peaks["drift_height_m"].tolist() == [28.5, 15.0]
    verdicts = rb.check(tmp_path / "out")
    assert verdicts["at_m"].tolist() == [28.5, 15.0]
    for value, height in zip(verdicts["value"], ("28.5", "15"), strict=True):
        assert f"{value:.3g} at {height} m ✓" in told
    assert verdicts["words"].tolist() == [f"maximum of top_drift_m at {height} m" for height in ("28.5", "15")]
    main(["check", str(tmp_path / "out"), "--all"])
    told = " ".join(capsys.readouterr().out.split())
    assert "joint: maximum of top_drift_m at 28.5 m at most 1 m; maximum of top_drift_m at 15 m at most 1 m" in told
    page = Page((rb.report(tmp_path / "out").path).read_text(encoding="utf-8")).text
    for height in ("28.5", "15"):
        assert f"drift is read at {height} m" in page
        assert f" at {height} m" in page.partition("drift is read at")[0]


def test_the_head_of_a_column_has_the_height_that_all_share(tmp_path, capsys):
    path = written(tmp_path, SHAFT + "top_m = 28.5\n", RIGID)
    main(["run", str(path), "--out", str(tmp_path / "out")])
    told = capsys.readouterr().out
    assert "drift at" in told
    assert "28.5 m [mm]" in told
    check = '[[check]]\nname = "joint"\ndemand = "top_drift_mm"\nat_most = 900\nreason = "r"\n'
    path = written(tmp_path, SHAFT + "top_m = 28.5\n", RIGID, check)
    main(["run", str(path), "--out", str(tmp_path / "checked")])
    assert "joint at 28.5 m ≤ 900 mm" in " ".join(capsys.readouterr().out.split())
    page = Page(rb.report(tmp_path / "checked").path.read_text(encoding="utf-8")).text
    assert "at 28.5 m, ≤ 900 mm" in page


def test_words_on_drift_follow_the_number_in_the_results(tmp_path):
    path = written(tmp_path, SHAFT, RIGID)
    main(["run", str(path), "--out", str(tmp_path / "out")])
    file = tmp_path / "out" / "run.json"
    assert '"top_m": 30.0' in file.read_text(encoding="utf-8").replace("30.000000000000004", "30.0")
    info = json.loads(file.read_text(encoding="utf-8"))
    info["cases"][0]["pier"]["top_m"] = 12.5
    file.write_text(json.dumps(info), encoding="utf-8")
    page = Page(rb.report(tmp_path / "out").path.read_text(encoding="utf-8")).text
    assert "drift at 12.5 m [mm]" in page


def test_a_spectrum_of_piers_of_parts_does_not_read_drift_at_their_ends(tmp_path):
    """Its piers have sizes of their own, and the parts are those of the study's."""
    tables = of_parts(top_m=20.0) | {"spectrum": {"alpha": [0.1], "size_m": [5.0, 50.0]}}
    tables["pier"] |= {"deck_mass_t": 500.0, "deck_height_m": 61.0}
    spectrum, _ = read_spectrum(rb.Study.from_dict(tables))
    for case in spectrum.cases:
        assert case.pier.top == case.pier.deck == 2.0 * case.pier.height


def test_a_study_without_masses_tells_of_none(tmp_path):
    study = study_of(tmp_path, "alpha = 0.13\np = 0.38\n")
    assert main(["run", str(study.path), "--out", str(tmp_path / "out")]) == 0
    (case,) = json.loads((tmp_path / "out" / "run.json").read_text())["cases"]
    assert list(case["pier"]) == [
        "alpha",
        "p",
        "mu",
        "gravity",
        "size_m",
        "half_width_m",
        "height_m",
        "highest_m",
        "top_m",
    ]
    assert case["parameters"] == {"restitution": None, "flight": "guided", "flight_limit_mm": 5.0}


def test_the_restitution_of_a_frame_is_in_the_results(tmp_path):
    study = study_of(tmp_path, FRAME)
    assert main(["run", str(study.path), "--out", str(tmp_path / "out")]) == 0
    (case,) = json.loads((tmp_path / "out" / "run.json").read_text())["cases"]
    assert case["parameters"]["restitution"] == study.cases[0].pier.restitution
    assert case["pier"]["deck_over_columns"] == 3.0


def test_devices_of_a_frame_are_those_of_all_its_columns(tmp_path):
    """kN over the weight of columns and deck; at the right edge of each column."""
    case = RIGID + '[[case.tendon]]\nprestress_kN = 400\nstiffness_kN_m = 8000\nat = "right"\n'
    (found,) = study_of(tmp_path, FRAME, case).cases
    tendon = found.base.restraints[0]
    assert tendon.psi == pytest.approx(400 / (560 * 9.81), rel=1e-12)
    assert [place.offset for place in places(found.pier, tendon)] == [pytest.approx(0.75)]
    (problem,) = problems_of(tmp_path, FRAME, RIGID + "[[case.deck_spring]]\nstiffness_kN_m = 8000\n")
    assert "columns: devices at the deck of a rocking frame are not solved" in problem


# Stiffness and strength in the analyses

RANGES = "[sensitivity]\nsamples = 8\n[sensitivity.uniform]\nstiffness_kN_m = [2e6, 3e6]\nyield_kN = [3e4, 4e4]\np = [0.5, 0.7]\n"


@pytest.mark.parametrize(
    ("pier", "pads"), [(SHAFT, PADS), (SHAFT.replace("mass_t = 2000\n", ""), PADS + "mass_t = 2000\n")]
)
def test_a_sensitivity_study_varies_stiffness_and_strength_in_kilonewtons(tmp_path, pier, pads):
    study = study_of(tmp_path, pier, RIGID, pads, RANGES)
    spec = read_sensitivity(study)
    rigid, soft = study.cases
    assert [each.name for each in applying(spec.inputs, rigid)] == ["p"]
    points = low_base_high(applying(spec.inputs, soft), study, soft)
    assert points[0] == {"stiffness_kN_m": 2e6, "yield_kN": 4e4, "p": soft.pier.p}
    there = varied(soft, {"stiffness_kN_m": 2.5e6, "yield_kN": 3e4, "p": 0.6})
    assert there.base == rb.YieldingBase.from_stiffness(there.pier, 2.5e6, 3e4)
    assert (there.base.beta * 0.6) ** 2 == pytest.approx(2 * 2.5e6 / 2000, rel=1e-14)
    assert varied(soft, points[0]).base.beta == pytest.approx(soft.base.beta, rel=1e-12)


@pytest.mark.parametrize(
    ("pier", "ranges", "said"),
    [
        (SHAFT, RANGES + "beta = [40, 90]\n", "beta and stiffness_kN_m are given, which fix the same; keep one"),
        (SHAFT, RANGES.replace("3e4", "9.8e3"), "yield_kN = 9800 means eta = 0.99898"),
        ("alpha = 0.13\np = 0.6\n", RANGES, "stiffness_kN_m: it goes with a pier of known mass (mass_t) on springs"),
        (SHAFT, RANGES.replace("2e6, 3e6", "25e5, 3e6"), 'does not hold the 2e+06 of case "pads"'),
    ],
)  # fmt: skip
def test_ranges_in_kilonewtons_are_held_against_the_pier(tmp_path, pier, ranges, said):
    ratios = PADS.replace("stiffness_kN_m = 2e6", "beta = 60").replace("yield_kN = 4e4", "eta = 3")
    pads = PADS if "mass_t" in pier else ratios
    study = study_of(tmp_path, pier, RIGID, pads, ranges)
    with pytest.raises(InputError) as caught:
        read_sensitivity(study)
    assert any(said in problem for problem in caught.value.messages), caught.value.messages


def test_spectra_keep_stiffness_and_mass_on_piers_of_every_size(tmp_path):
    study = study_of(
        tmp_path, SHAFT + "deck_mass_t = 1000\n", PADS, "[spectrum]\nalpha = [0.1, 0.15]\np = [0.5, 1.0]\npoints = 3\n"
    )
    spectrum, _ = read_spectrum(study)
    assert spectrum.varied == ("alpha", "p")
    assert len(spectrum.cases) == 6
    for case in spectrum.cases:
        assert case.pier.mass_t == 3000.0
        assert case.base == rb.YieldingBase.from_stiffness(case.pier, 2e6, 4e4)


def test_spectra_of_a_frame_are_of_frames(tmp_path):
    study = study_of(tmp_path, FRAME, RIGID, "[spectrum]\nalpha = [0.1, 0.15]\nsize_m = [5, 10]\npoints = 2\n")
    spectrum, _ = read_spectrum(study)
    for case in spectrum.cases:
        assert case.pier.deck_over_columns == 3.0
        assert case.pier.size == pytest.approx(case.columns["size_m"], rel=1e-12)


@pytest.mark.parametrize("prestress", [3e3, 2e4, 29999.9])
@pytest.mark.parametrize(
    "places", ["", 'at = "left"\n[[case.tendon]]\nprestress_kN = {0}\nlambda = 0.1\nat = "right"\n']
)
@pytest.mark.parametrize(("spring", "more"), [("epp", 1.0), ("bouc-wen", 1.003), ("hardening", 1.003)])
def test_the_yield_force_that_is_advised_carries_the_prestress_too(tmp_path, prestress, places, spring, more):
    """The advice is followed to the letter; the least is half of weight and prestress, on both supports alike.

    Smooth springs need a little more: near their yield force they would be too soft to hold the pier upright.
    """
    tendon = f"[[case.tendon]]\nprestress_kN = {prestress}\nlambda = 0.1\n{places.format(prestress)}"
    pads = PADS.replace("4e4", f'1e4\nspring = "{spring}"')
    (problem,) = problems_of(tmp_path, SHAFT, pads + tendon)
    advised = float(problem.rsplit("write yield_kN above ", 1)[1])
    tendons = 2 if places else 1
    least = 0.5 * (2000 * 9.81 + tendons * prestress)
    assert least <= advised <= 1.001 * more * least
    assert study_of(tmp_path, SHAFT, pads.replace("1e4", repr(advised)) + tendon).cases
    assert problems_of(tmp_path, SHAFT, pads.replace("1e4", repr(0.999 * advised)) + tendon)
