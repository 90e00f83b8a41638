"""Every section has the same entry point, is in the page's list once, and is left out if it does not apply."""

import inspect
import json
import pkgutil
import re
from importlib import import_module

import pandas as pd
import pytest
from check_samples import case, folder, runs
from report_page import Page
from report_samples import FIG7, FOUNDATIONS, case_entry, write_results
from studies import study_text, write_study

import rockbatch.reporting.sections
from rockbatch.observers.forces import section as forces
from rockbatch.pier import Damper, FootingBase, Pier, RigidBase
from rockbatch.reporting import compared, write_analyses
from rockbatch.reporting.finished import read
from rockbatch.reporting.finished_analysis import Contents, FinishedAnalysis, of_analysis
from rockbatch.reporting.markup import Markup
from rockbatch.reporting.page import PARTS, PARTS_OF_TWO, page, sections
from rockbatch.reporting.sections import answer, inputs
from rockbatch.reporting.sheet import AFTER, BEFORE
from rockbatch.reporting.templates import Section, document
from rockbatch.results.run_json import describe_case, describe_study
from rockbatch.study import Case, load_study

STUDY = {"title": "Piers & pads", "notes": "First.\n\nSecond.", "text": 'title = "Piers & pads"', "sha256": "0"}


def test_every_module_of_sections_stands_in_the_list_of_the_page_or_of_the_sheet():
    package = rockbatch.reporting.sections
    modules = {module.name for module in pkgutil.iter_modules(package.__path__)} - {
        "worst"
    }  # a table of several sections
    assert len(modules) >= 7
    of_modules = [import_module(f"{package.__name__}.{name}").section for name in modules]
    of_sheet = {part.content for part in (*BEFORE, *AFTER)}
    times = [sum(part.content is section for part in PARTS) for section in of_modules]
    assert all(n == 1 or (n == 0 and section in of_sheet) for n, section in zip(times, of_modules, strict=True))


def test_every_public_function_on_two_studies_stands_in_the_list_of_their_page_once():
    functions = [function for name, function in inspect.getmembers(compared, inspect.isfunction)
                 if function.__module__ == compared.__name__ and not name.startswith("_")]  # fmt: skip
    assert len(functions) == len(PARTS_OF_TWO) == len({part.anchor for part in PARTS_OF_TWO})
    assert {part.content for part in PARTS_OF_TWO} == set(functions)


def test_sections_of_a_run_stand_in_the_order_of_the_list_under_anchors_of_their_own(tmp_path):
    write_results(tmp_path)
    contents = read(tmp_path)
    made = sections(contents)
    anchors = [one.anchor for one in made]
    assert len(set(anchors)) == len(anchors)
    assert anchors[:2] == ["answer", "peaks"]
    assert {"studied", "peaks", "suite", "distribution", "records", "reproduce"} <= set(anchors)
    asked = {"checks", "references", "design", "fragility", "spectrum", "sensitivity", "histories", "unusable"}
    assert not (asked | {"intensity", "target"}) & set(anchors)
    text = page(contents)
    places = [text.index(f'<section id="{anchor}"') for anchor in anchors]
    assert places == sorted(places)
    assert all(one.content for one in made)
    assert re.findall(r'<a href="#(\w+)"', text)[: len(anchors)] == anchors


def test_a_folder_without_a_run_has_notes_and_the_study_file_alone(tmp_path):
    shown = Page(page(Contents(tmp_path, STUDY)))
    assert shown.headings == ["Notes", "The study file"]
    assert "First." in shown.text
    assert 'title = "Piers & pads"' in shown.text
    assert Page(page(Contents(tmp_path, STUDY | {"notes": "", "title": ""}))).headings == ["The study file"]


def test_analyses_go_into_the_report_of_their_study_or_a_page_of_their_own(tmp_path):
    study = load_study(write_study(tmp_path, study_text()))
    write_results(tmp_path, study=describe_study(study))
    assert write_analyses(tmp_path, study).name == "report.html"
    (tmp_path / "peaks.csv").unlink()
    assert write_analyses(tmp_path, study).name == "analyses.html"


def test_an_analysis_with_a_table_that_cannot_be_used_says_so(tmp_path):
    """It was left out, and the readers of analyses.html missed its other tables without a word."""
    info = {"study": {"sha256": STUDY["sha256"]}, "files": ["sensitivity.csv", "sobol.csv"], "digests": {}}
    (tmp_path / "sensitivity.json").write_text(json.dumps(info), encoding="utf-8")
    (tmp_path / "sensitivity.csv").write_text("case,low\npads,1.0\n", encoding="utf-8")
    contents = Contents(tmp_path, STUDY)
    section = of_analysis("sensitivity", sensitivity=("case",), sobol=("case", "total"))(lambda *_: Markup("drawn"))
    for sobol in ("case,all\npads,0.5\n", ""):
        (tmp_path / "sobol.csv").write_text(sobol, encoding="utf-8")
        assert "sobol.csv: edited or damaged; run `rockbatch sensitivity` again." in section(contents)
    (tmp_path / "sobol.csv").write_text("case,total\npads,0.5\n", encoding="utf-8")
    assert section(contents) == "drawn"
    assert of_analysis("sensitivity", other=("case",))(lambda *_: Markup("drawn"))(contents) == ""


def test_a_section_that_does_not_apply_has_no_heading_and_no_link():
    there, nothing = Section("Peaks", "peaks", Markup("<p>high</p>")), Section("None", "none", Markup(""))
    shown = Page(document("title", "", [nothing, there, nothing]))
    assert shown.headings == ["Peaks"]
    assert shown.links == {"#peaks"}


def test_histories_verdicts_and_analyses_come_from_the_same_folder(tmp_path):
    write_results(tmp_path)
    contents = read(tmp_path, ())
    assert contents.directory == tmp_path
    assert contents.study["sha256"] == contents.info["study"]["sha256"]
    assert list(contents.responses) == list(contents.verdicts) == []
    assert contents.analysis("fragility") is None
    (tmp_path / "fragility.json").write_text(
        f'{{"study": {{"sha256": "{contents.study["sha256"]}"}}, "curves": []}}', encoding="utf-8"
    )
    assert contents.analysis("fragility").info["curves"] == []
    assert "fragility" not in [made.anchor for made in sections(contents)]


@pytest.mark.parametrize("run", [(0.38, 0.35), (0.35,)])
def test_the_answer_says_how_far_the_worst_pier_rotates_and_how_high_its_heel_rises(tmp_path, run):
    # Also where run.json lists a pier that has no runs yet
    piers = [case_entry("rigid", {"p": p}, Pier(alpha=0.13, p=p), RigidBase()) for p in (0.38, 0.35)]
    write_results(tmp_path, cases=piers, varied=("p",))
    peaks = pd.read_csv(tmp_path / "peaks.csv")
    peaks["theta_max_over_alpha"] = 0.01
    worst = (peaks["record"] == "SYL360") & (peaks["p"] == 0.35)
    peaks.loc[worst, "theta_max_over_alpha"] = 0.1
    peaks[peaks["p"].isin(run)].to_csv(tmp_path / "peaks.csv", index=False)
    markup = section_of(tmp_path, answer)
    own = {row[0].split("p = ")[-1]: row[1:] for row in table_of(markup)[1:]}
    pier = Pier(alpha=0.13, p=0.35)
    at = f" at {2 * pier.height:.5g} m"  # in the head, unless the piers differ in it
    head, place = (f"drift{at} [mm]", "") if len(run) == 1 else ("drift [mm]", at)
    assert table_of(markup)[0] == ["case", "rotation [θ/α]", head, "uplift of the heel [mm]"]
    own = {name: [cells[0], cells[1].removesuffix(place), *cells[2:]] for name, cells in own.items()}
    uplift, drift = 2 * pier.half_width * 0.1 * 0.13, 2 * pier.height * 0.1 * 0.13  # of the top of a uniform block
    assert [float(cell.replace(",", "")) for cell in own["0.35 rad/s"]] == pytest.approx(
        [0.1, 1000 * drift, 1000 * uplift], rel=5e-3
    )
    assert set(own) == {f"{p} rad/s" for p in run}
    assert re.search(r'title="0.1 α = 0.745° \(0.013 rad\): SYL360, case rigid', markup)
    told = Page(markup).text
    assert "θ/α = 1: the pier alone stands on its edge on rigid ground." in told
    assert "No settlement: the ground is rigid." in told


@pytest.mark.slow
def test_the_answer_has_what_dampers_bear_and_that_they_hold_the_pier_at_a_tilt(tmp_path):
    """Rigid ground has no tilt of its own; friction may leave the pier at one."""
    pier, base = Pier(alpha=0.13, p=0.38, mass_t=2000.0), RigidBase(restraints=(Damper("friction", f=0.3),))
    write_results(
        tmp_path,
        cases=[describe_case(Case(name, pier, each, {})) for name, each in (("free", RigidBase()), ("damped", base))],
    )
    peaks = pd.read_csv(tmp_path / "peaks.csv")
    damped = peaks["case"] == "damped"
    peaks["theta_max_over_alpha"] = 0.2
    peaks.loc[damped, ["theta_max_over_alpha", "theta_res_over_alpha"]] = 0.1, -0.02
    peaks.loc[damped, ["damper_force_over_weight", "damper_force_kN", "damper_stroke_m"]] = 0.3, 5886.0, 0.04
    peaks.loc[damped & (peaks["record"] == "ERZ-NS"), "damper_stroke_m"] = 0.0512
    peaks.to_csv(tmp_path / "peaks.csv", index=False)
    head, free, *rest = table_of(section_of(tmp_path, answer))
    drift = f"drift at {2 * pier.height:.5g} m [mm]"
    assert head[1:] == [
        "rotation [θ/α]", drift, "residual rotation [mrad]", "uplift of the heel [mm]", "damper force [kN]", "stroke [mm]",
    ]  # fmt: skip
    (damped,) = [row for row in (free, *rest) if row[0].startswith("damped")]
    (free,) = [row for row in (free, *rest) if row[0].startswith("free")]
    assert (damped[1], damped[3], damped[5], damped[6]) == ("0.100", "2.60", "5890", "51.2")
    assert (free[1], free[3], free[5], free[6]) == ("0.200", "–", "–", "–")
    assert re.search(r'title="ERZ-NS, case damped[^"]*">51.2<', section_of(tmp_path, answer))
    peaks.drop(columns="damper_force_kN").to_csv(tmp_path / "peaks.csv", index=False)
    head, *rest = table_of(section_of(tmp_path, answer))
    assert head[5] == "damper force [of the weight]"
    assert {row[5] for row in rest} == {"0.300", "–"}
    peaks.drop(columns=["damper_force_kN", "damper_force_over_weight"]).to_csv(tmp_path / "peaks.csv", index=False)
    _, *rest = table_of(section_of(tmp_path, answer))
    assert [row[5:] for row in rest if row[0].startswith("damped")] == [["–", "51.2"]]  # a table that somebody edited
    peaks.loc[damped_rows := peaks["case"] == "damped", "status"] = "overturned"  # none of them stands
    assert damped_rows.any()
    peaks.to_csv(tmp_path / "peaks.csv", index=False)
    shown = [(row[0], row[-1]) for row in table_of(section_of(tmp_path, answer))[1:]]
    assert shown == [("free", "none"), ("damped", "6 of 6")]


@pytest.mark.parametrize(("error", "said"), [(2.1e-5, "0.00003"), (7e-4, "0.0007"), (3e-9, "0.000001")])
def test_the_error_of_the_answer_is_a_plain_number_that_no_run_exceeds(tmp_path, error, said):
    write_results(tmp_path, changes={("ERZ-NS", "1"): {"theta_max_error": error}})
    peaks = pd.read_csv(tmp_path / "peaks.csv")
    peaks["theta_max_error"] = peaks["theta_max_error"].clip(upper=error)
    peaks.to_csv(tmp_path / "peaks.csv", index=False)
    told = Page(section_of(tmp_path, answer)).text
    assert f"Error of rotations: at most {said} α (0.0001 α allowed)." in told


def test_on_a_footing_the_answer_says_that_strips_leave_more_than_the_steps(tmp_path):
    """A claimed error above the tolerance is no run that has not converged."""
    foot = case("foot", FootingBase(30.0, 3.0))
    results = folder(tmp_path / "out", runs((0.1, 0.2), "foot", theta_max_error=7e-4), [foot])
    assert (
        "0.0007 α (0.0001 α allowed, besides the error of a footing's strips)."
        in Page(section_of(results, answer)).text
    )
    said = "is at most 0.0001, or on a footing a tenth of the error of its strips."
    assert said in Page(page(read(results, ()))).text


def test_the_answer_says_which_peaks_have_errors_and_which_runs_remarks(tmp_path):
    noted = {("ERZ-NS", "1"): {"note": "impacts not settled: 8 or 9"}, ("RRS228", "2"): {"note": "flew up to 9 mm"}}
    write_results(tmp_path, changes=noted)
    assert "2 runs have remarks." in Page(section_of(tmp_path, answer)).text
    (tmp_path / "one").mkdir()
    write_results(tmp_path / "one", changes={("ERZ-NS", "1"): {"note": "flew up to 9 mm"}})
    assert ". One run has remarks." in Page(section_of(tmp_path / "one", answer)).text
    assert "30 runs, all end standing" in page(read(tmp_path, ()))
    write_results(tmp_path, changes={("SYL360", "1"): {"theta_max_error": ""}})
    told = Page(section_of(tmp_path, answer)).text
    assert "(0.0001 α allowed); unknown in one run." in told
    assert "remarks" not in told
    write_results(tmp_path, numerics={"tolerance": None, "substeps": 4, "quiet_s": 2.0})
    assert (
        "Every sampling interval was integrated in 4 steps; the error was not estimated."
        in Page(section_of(tmp_path, answer)).text
    )


def test_the_answer_counts_runs_that_flew_apart_from_those_that_ended_so(tmp_path):
    guided = {
        ("ERZ-NS", "1"): {"flight_s": 3.0, "flight_height_m": 0.0021},
        ("RRS228", "3"): {"flight_s": 4.0, "flight_height_m": 0.0004},
    }
    write_results(tmp_path, changes=guided | {("CPM000", "2"): {"status": "flight", "flight_s": 2.5}})
    told = Page(section_of(tmp_path, answer)).text
    assert "In 2 runs the pier left the ground altogether, by up to 2.1 mm; it was guided down." in told
    assert "In one run both pivots leave the ground, and the analysis stops there: CPM000, case 2" in told


@pytest.mark.parametrize(("status", "words"), [
    ("ok", "No run demands more friction than its interface has, of 30 runs."),
    ("overturned", "No run demands more friction than its interface has, of 30 runs."),
    ("flight", "Of 30 runs, 2 stopped early; none of the other 28 demands more friction than its interface has."),
    ("failed", "Of 30 runs, 2 stopped early; none of the other 28 demands more friction than its interface has."),
])  # fmt: skip
def test_the_friction_of_all_runs_is_claimed_of_those_that_were_seen_through(tmp_path, status, words):
    pier = Pier(alpha=0.13, p=0.38)
    cases = [case_entry(name, {}, pier, base) for name, base in FOUNDATIONS]
    cases = [entry | {"parameters": entry["parameters"] | {"friction": 0.5}} for entry in cases]
    write_results(tmp_path, cases=cases, changes={(record, "1"): {"status": status} for record in ("ERZ-NS", "SYL360")})
    pd.read_csv(tmp_path / "peaks.csv").assign(friction_demand=0.2).to_csv(tmp_path / "peaks.csv", index=False)
    assert words in Page(section_of(tmp_path, forces)).text


@pytest.mark.parametrize(("impacts", "said"), [(3, True), (0, False)])
def test_forces_on_rigid_ground_are_said_to_leave_landings_out_where_a_run_lands(tmp_path, impacts, said):
    """Of springs, whose runs land in any case, nothing is said."""
    write_results(tmp_path, changes={(record, "rigid"): {"impacts": impacts} for record, _ in FIG7})
    pd.read_csv(tmp_path / "peaks.csv").assign(base_shear_m_s2=0.2).to_csv(tmp_path / "peaks.csv", index=False)
    text = Page(section_of(tmp_path, forces)).text
    assert ("On rigid ground a landing is an impulse without a force" in text) == said
    assert "single mode" not in text


def test_the_greatest_is_claimed_of_the_runs_that_end_standing(tmp_path):
    write_results(tmp_path, changes={("ERZ-NS", "1"): {"status": "failed"}, ("SYL360", "1"): {"status": "overturned"}})
    assert "Largest value over 28 of 30 runs that end standing" in Page(section_of(tmp_path, answer)).text
    assert "30 runs, 28 end standing" in page(read(tmp_path, ()))
    write_results(tmp_path)
    peaks = pd.read_csv(tmp_path / "peaks.csv")
    peaks.iloc[:-3].to_csv(tmp_path / "peaks.csv", index=False)
    told = Page(section_of(tmp_path, answer)).text
    assert "Largest value over 27 of 30 runs that end standing" in told
    assert "3 runs not run" in told
    assert "30 runs, 27 end standing" in page(read(tmp_path, ()))


def section_of(directory, module):
    return module.section(read(directory, ()))


def table_of(markup):
    """Return the rows of the one table of a section as texts."""
    (rows,) = Page(f'<section id="x">{markup}</section>').tables.values()
    return [[cell.replace("\u00a0", " ").strip() for cell in row] for row in rows]


@pytest.mark.parametrize(("text", "whole"), [("a,b,c\n1,2,3\n", True), ("a,c\n1,3\n", False), ("a,b\n", False)])
def test_a_table_of_an_analysis_that_is_empty_or_lacks_a_column_is_left_out(tmp_path, text, whole):
    (tmp_path / "x.csv").write_text(text, encoding="utf-8")
    analysis = FinishedAnalysis(tmp_path, {"files": ["x.csv"]})
    assert (analysis.table("x.csv", ("a", "b")) is not None) == whole
    assert analysis.table("y.csv", ()) is None


@pytest.mark.parametrize(
    ("key", "symbol", "unit"),
    [
        ("toe_level_m", "toe level", "m"),
        ("impulse_kN_s", "impulse", "kN s"),
        ("spring_kN_m", "spring", "kN/m"),
        ("bed_stiffness_MN_m3", "bed stiffness", "MN/m³"),
        ("speed_m_s", "speed", "m/s"),
        ("push_m_s2", "push", "m/s²"),
        ("colour", "colour", ""),
    ],
)
def test_keys_without_a_symbol_have_their_unit_as_people_write_it(key, symbol, unit):
    assert inputs.symbol_and_unit(key) == (symbol, unit)
