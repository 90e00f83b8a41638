"""Two studies are compared by their verdicts, and by what differs in their text and in the motions that were run."""

import copy
import json
import math
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from check_samples import verdict
from report_page import Page
from studies import SINE

import rockbatch as rb
from rockbatch.checks import judge, read_verdicts, write_verdicts
from rockbatch.checks.verdicts import UNWRITTEN
from rockbatch.commands.cli import main
from rockbatch.common.errors import InputError
from rockbatch.quantities.catalogue import FIXED, TRAILING, names
from rockbatch.reporting.differing import Written, _contents, differences
from rockbatch.reporting.finished import read
from rockbatch.reporting.margins import _requirement, headline
from rockbatch.reporting.pair import pair
from rockbatch.results.run_json import describe
from rockbatch.study.suite import ground_motions

PIER = {"width_m": 4.0, "height_m": 20.0, "mass_t": 900.0, "deck_mass_t": 500.0}
PULSES = [SINE | {"name": name, "period_s": period} for name, period in (("Te Mara", 0.5), ("Lyttelton", 0.7))]
SPRINGS = {"name": "springs", "base": "elastic", "stiffness_kN_m": 2.0e6, "zeta": 0.05}
DEVICES = {
    "damper": [{"kind": "friction", "force_kN": 300.0}],
    "tendon": [{"prestress_kN": 1000.0, "stiffness_kN_m": 4.0e4}],
    "stop": [{"gap_mm": 120.0, "stiffness_kN_m": 5.0e5}],
    "deck_spring": [{"stiffness_kN_m": 5.0e4, "gap_mm": 50.0}],
}
UPLIFT = {"name": "uplift", "demand": "heel_uplift_m", "at_most": 0.3, "reason": "agreed"}
ROTATION = {"name": "rotation", "demand": "theta_max_over_alpha", "at_most": 0.5, "reason": "agreed"}


def tables(**changes):
    study = {
        "pier": PIER,
        "motions": {"pulse": PULSES},
        "case": [SPRINGS | DEVICES],
        "check": [ROTATION],
        "numerics": {"tolerance": 1e-4},
    }
    return copy.deepcopy(study | changes)


def folder(path: Path, study: rb.Study, theta=0.2, **cells) -> Path:
    """Write a folder as ``rockbatch run`` leaves it, with made-up rotations: a number, or by case and bound or record."""
    motions = ground_motions(study)
    info = describe(study, motions)
    rows = []
    for motion in motions.motions:
        for case in study.cases:
            given = theta
            for key in (case.name, *case.columns.values(), motion.name):
                given = given.get(key, given.get("*", 0.2)) if isinstance(given, dict) else given
            row = {
                "record": motion.name,
                "station": motion.of_station,
                "case": case.name,
                "polarity": "+",
                "scale": 1.0,
            }
            went = {"status": "ok", "theta_max_over_alpha": given, "theta_max_error": 1e-9}
            rows.append(row | case.columns | went | cells)
    columns = [*names(FIXED), *study.varied, *names(TRAILING)]
    path.mkdir(parents=True, exist_ok=True)
    peaks = pd.DataFrame(rows).reindex(columns=columns)
    peaks.to_csv(path / "peaks.csv", index=False, float_format="%.10g")
    extra = {
        "rockbatch": rb.__version__,
        "created": "",
        "command": [],
        "versions": {},
        "machine": "",
        "runs": len(rows),
    }
    (path / "run.json").write_text(json.dumps(info | extra | {"jobs": 1, "wall_s": 1.0}), encoding="utf-8")
    saved = rb.open_results(path)
    if study.checks:
        write_verdicts(path, judge(study.checks, saved.peaks, saved.info["cases"], count=study.count))
    return path


def two(tmp_path, first, second, thetas=(0.2, 0.2)):
    sides = zip("ab", (first, second), thetas, strict=True)
    return [folder(tmp_path / side, rb.Study.from_dict(study), theta) for side, study, theta in sides]


def said(folders, asked=None):
    return headline(pair(*(read(path, ()) for path in folders), asked)).replace("\u00a0", " ")


def inputs(folders, asked=None):
    both = pair(*(read(path, ()) for path in folders), asked)
    return {row.name: (row.first, row.second) for row in differences(*both.studies, both.names)}


# The sentence


def test_the_first_line_says_which_passes_with_its_closest_check_and_which_fails(tmp_path):
    """By hand: 0.41/0.5 = 82 %, under the second record; 0.98/0.5 = 196 %."""
    thetas = {"springs": {"Lyttelton": 0.41}}, {"springs": {"Te Mara": 0.98}}
    folders = two(tmp_path, tables(), tables(), thetas)
    assert said(folders) == "A passes all, closest 82 % (rotation, Lyttelton); B fails rotation at 196 % (Te Mara)."


@pytest.mark.parametrize(("checks", "noted"), [(1, "rotation"), (3, "rotation, c1, c2"), (4, "4 checks")])
def test_the_first_line_says_of_a_pass_which_checks_leave_something_out(tmp_path, checks, noted):
    """Of four checks it has their number; a pier beyond its kinematics passed without a word in the first line."""
    asked = [ROTATION, *(ROTATION | {"name": f"c{i}", "at_most": 0.6} for i in range(1, checks))]
    study = rb.Study.from_dict(tables(check=asked))
    folders = [folder(tmp_path / side, study, 0.2, beyond_linearised=far) for side, far in (("a", 1.0), ("b", 0.0))]
    closest = "passes all, closest 40 % (rotation, Lyttelton)"
    assert said(folders) == f"A {closest}, with remarks on {noted}; B {closest}."


def test_a_study_that_fails_is_not_better_for_a_smaller_rotation(tmp_path):
    """B rotates less, and its limit is lower: the verdict comes first, the rotation after it."""
    strict = tables(check=[ROTATION | {"at_most": 0.1}])
    folders = two(tmp_path, tables(), strict, (0.2, 0.185))
    text = Page(rb.report(*folders).path.read_text(encoding="utf-8")).text.replace("\u00a0", " ")
    assert "A passes all, closest 40 % (rotation, Lyttelton); B fails rotation at 185 % (Lyttelton)." in text
    assert "is better" not in text
    assert "worst rotation −7.5 %" in text


def test_cases_that_only_one_study_has_do_not_change_what_the_other_comes_to(tmp_path):
    more = [SPRINGS | DEVICES, SPRINGS | {"name": "soft"}, {"name": "rock", "base": "rigid"}]
    folders = two(tmp_path, tables(), tables(case=more), (0.6, {"springs": 0.6, "*": 0.3}))
    assert said(folders) == (
        "A fails rotation at 120 % (Lyttelton); B passes all in 2 of 3 cases, closest 60 % (rotation, soft, Lyttelton), "
        "and fails rotation at 120 % (springs, Lyttelton) in 1 of 3 cases."
    )


def test_bounds_of_a_design_are_one_case_in_the_sentence_and_are_named(tmp_path):
    bounded = tables(bound=[{"name": "stiff", "case.stiffness_kN_m": {"times": 2.0}}])
    folders = two(tmp_path, bounded, tables(), ({"springs": {"stiff": 0.45, "": 0.2}}, 0.3))
    assert said(folders).startswith(
        "A passes all, closest 90 % (rotation, Lyttelton, under stiff); B passes all, closest 60 %"
    )
    matched = pair(*(read(path, ()) for path in folders))
    assert matched.runs[0]["bound"].tolist() == ["", ""]  # the nominal design is what B has


def test_a_check_that_fails_in_two_cases_is_one_check_and_another_is_one_more(tmp_path):
    """Both cases fail both limits: one check is named, and one is left."""
    cases = [SPRINGS, SPRINGS | {"name": "soft"}]
    checks = [ROTATION, ROTATION | {"name": "strict", "at_most": 0.1}]
    folders = two(tmp_path, tables(), tables(case=cases, check=checks), (0.2, 0.6))
    assert (
        said(folders)
        .split("; ")[1]
        .startswith("B fails strict at 600 % (springs, Lyttelton) and 1 more in both cases.")
    )


def test_a_check_that_an_event_never_happens_is_not_the_closest_to_its_limit(tmp_path):
    """A ban, of which the ratio is 0 or 1, is no margin, unlike the rotation's 40 %."""
    never = {"name": "stands", "demand": "overturned", "at_most": 0.9, "reason": "agreed"}
    folders = two(tmp_path, tables(check=[never]), tables(check=[ROTATION, never]))
    told = "A is not decided (no limit on rotation); B passes all, closest 40 % (rotation, Lyttelton)."
    assert said(folders) == f"{told} Their checks are not the same."


@pytest.mark.parametrize(
    ("other", "kinds"),
    [
        ({"motions": {"pulse": PULSES[:1]}}, "motions"),
        ({"motions": {"pulse": [PULSES[0], PULSES[1] | {"amplitude_g": 0.5}]}}, "motions"),
        ({"check": [ROTATION | {"at_most": 0.6}]}, "checks"),
        ({"check": [ROTATION | {"overturned": "left out"}]}, "checks"),
        ({"check": [ROTATION | {"least": 2}]}, "checks"),
        (
            {"check": [ROTATION | {"statistic": "mean"}], "motions": {"pulse": PULSES[1:]}},
            "motions and checks",
        ),
        (
            {"case": [SPRINGS | {"zeta": 0.1}], "numerics": {"substeps": 4}, "check": [ROTATION | {"reason": "code"}]},
            "",
        ),
    ],
)
def test_the_first_line_says_if_shares_are_of_other_motions_or_limits(tmp_path, other, kinds):
    """Half the motion, or a limit twice as high, looked like a better pier."""
    text = said(two(tmp_path, tables(), tables(**other)))
    assert text.endswith(f". Their {kinds} are not the same." if kinds else "closest 40 % (rotation, Lyttelton).")


def test_a_capacity_a_height_and_what_counts_are_part_of_what_a_check_asks():
    """Of two checks with the same name, demand and limit."""
    asked = (
        verdict("springs", "pass"),
        *(
            verdict("springs", "pass", **other)
            for other in (
                *({"capacity": "[[0, 1]]"}, {"words": "largest of section_shear_kN at 10 m"}, {"words": "SRSS"}),
                *({"least": 7}, {"per_event": 2}, {"count": "component"}, {"counting": "overturned: left out"}),
            )
        ),
    )
    assert len({_requirement(one, numbers=True) for one in asked}) == len(asked)


def test_checks_of_an_earlier_version_are_no_others_for_the_numbers_it_did_not_write(tmp_path):
    """Its checks.csv had no columns for the least number of records, nor for that of one event."""
    folders = two(tmp_path, *(tables(check=[ROTATION | {"least": 2}]),) * 2)
    pd.read_csv(folders[0] / "checks.csv").drop(columns=["least", "per_event"]).to_csv(
        folders[0] / "checks.csv", index=False
    )
    assert [one.least for one in read_verdicts(folders[0])] == [UNWRITTEN]
    assert "not the same" not in said(folders)


def test_a_record_without_a_run_in_one_study_ends_no_comparison(tmp_path):
    """It ended in a KeyError where the other study does not have the record."""
    folders = two(tmp_path, tables(), tables())
    info = json.loads((folders[0] / "run.json").read_text(encoding="utf-8"))
    info["records"].append(info["records"][0] | {"record": "Kaikoura"})
    (folders[0] / "run.json").write_text(json.dumps(info), encoding="utf-8")
    assert said(folders).startswith("A passes all")
    assert inputs(folders) == {"motions in one study only": ("Kaikoura", "–")}


def test_a_suite_that_fails_its_own_checks_is_said_beside_what_passes(tmp_path):
    folders = two(tmp_path, tables(), tables())
    write_verdicts(folders[1], [*read_verdicts(folders[1]), verdict("", "fail", check="spectrum")])
    line = said(folders)
    assert line.startswith("A passes all, closest 40 % (rotation, Lyttelton); B ")
    assert line.endswith(", under a suite that fails its own checks.")


@pytest.mark.parametrize(("files", "words"), [(1, "1 file"), (2, "2 files")])
def test_a_pass_without_all_of_its_files_says_so(tmp_path, files, words):
    """One that fails does so whatever they hold."""
    folders = two(tmp_path, tables(), tables(), (0.2, 0.9))
    for path in folders:
        info = json.loads((path / "run.json").read_text(encoding="utf-8"))
        unusable = {"name": "WTMC.N", "source": "WTMC.V2A", "reason": "no unit", "station": "WTMC"}
        (path / "run.json").write_text(json.dumps(info | {"unusable": [unusable] * files}), encoding="utf-8")
    passing, failing = said(folders).split("; ")
    assert passing.endswith(f", without {words} that could not be used")
    assert failing.startswith("B fails")
    assert "could not be used" not in failing


def test_studies_without_limits_are_said_to_have_none(tmp_path):
    free = tables()
    del free["check"]
    assert said(two(tmp_path, free, tables())) == "A has no limits; B passes all, closest 40 % (rotation, Lyttelton)."


def test_a_check_that_is_not_decided_is_named(tmp_path):
    checks = [ROTATION, {"name": "settling", "demand": "settlement_m", "at_most": 0.1, "reason": "agreed"}]
    folders = two(tmp_path, tables(), tables(check=checks))
    line = said(folders)
    assert line.split("; ")[1].startswith(("B is not decided", "B passes all"))


def test_margins_stand_side_by_side_check_by_check(tmp_path):
    """0.2/0.5 = 40 % and 0.3/0.4 = 75 %: 35 points more."""
    folders = two(tmp_path, tables(), tables(check=[ROTATION | {"at_most": 0.4}]), (0.2, 0.3))
    page = Page(rb.report(*folders).path.read_text(encoding="utf-8"))
    row = [cell.replace("\u00a0", " ") for cell in page.tables["answer"][2]]
    assert row[:2] == ["springs", "rotation ≤ 0.5, in B ≤ 0.4"]
    assert (row[2], row[5]) == ("0.2", "0.3")
    assert row[3].endswith("40 %")
    assert row[6].endswith("75 %")
    assert row[-1] == "+35 %"


def test_demands_of_one_check_stand_in_one_unit_whatever_the_limits(tmp_path):
    """Beside 300 mm a limit of 1.2 m is in mm, too."""
    wide = UPLIFT | {"at_most": 1.2, "confirm": ["at_most"]}
    folders = two(tmp_path, tables(check=[UPLIFT]), tables(check=[wide]))
    row = [
        cell.replace("\u00a0", " ")
        for cell in Page(rb.report(*folders).path.read_text(encoding="utf-8")).tables["answer"][2]
    ]
    assert row[1] == "uplift ≤ 300 mm, in B ≤ 1,200 mm"
    assert row[2] == row[5]
    assert float(row[2]) > 100.0


@pytest.mark.parametrize(("other", "words"), [
    ({"statistic": "mean"}, "in B mean of theta_max_over_alpha at most 0.5 over stations"),
    ({"count": "component"}, "in B maximum of theta_max_over_alpha at most 0.5 over components"),
    ({"demand": "theta_max_rad", "at_most": 0.05}, "in B maximum of theta_max_rad at most 0.05 rad over stations"),
])  # fmt: skip
def test_checks_of_one_name_that_compare_other_things_have_no_difference(tmp_path, other, words):
    """Means and maxima of the same runs differ without any change of the pier."""
    folders = two(tmp_path, tables(), tables(check=[ROTATION | other]), ({"Te Mara": 0.1, "*": 0.3},) * 2)
    row = Page(rb.report(*folders).path.read_text(encoding="utf-8")).tables["answer"][2]
    assert row[1] == f"rotation: in A maximum of theta_max_over_alpha at most 0.5 over stations, {words}"
    assert row[-1] == "Lyttelton"  # what governs B: the difference behind it is empty


def test_the_difference_of_two_shares_of_a_limit_says_of_what(tmp_path):
    """From 0.2 to 0.3 of 0.5 a rotation is half as large again; of the limit it is 20 %."""
    page = rb.report(*two(tmp_path, tables(), tables(), (0.2, 0.3))).path
    margins = Page(page.read_text(encoding="utf-8")).tables["answer"]
    assert (margins[1][-1], margins[2][-1]) == ("B − A, of the limit", "+20 %")


def test_long_names_of_stations_break_into_lines(tmp_path):
    """A name of one line would push what stands behind it off the page."""
    name = "recorded at the north abutment of the old railway bridge over the river"
    one = tables(motions={"pulse": [PULSES[0] | {"name": name}]})
    text = rb.report(*two(tmp_path, one, one)).path.read_text(encoding="utf-8").replace("\u00a0", " ")
    drawn = re.findall(r'<div class="wide([^"]*)"[^>]*aria-label="([^"]*)"[^>]*><table>(.*?)</table>', text)
    named = {title: kind for kind, title, body in drawn if re.search(rf"<td[^>]*>(<span[^>]*>)?{name}", body)}
    assert "Margins" in named
    assert set(named.values()) == {" prose"}


def test_margins_at_each_scale_stand_in_rows_of_their_own(tmp_path):
    """0.2/0.5 = 40 % in A at either scale, 0.3/0.5 = 60 % and 0.45/0.5 = 90 % in B."""
    scaled = tables(motions={"pulse": PULSES[:1], "scale": [1.0, 1.5]})
    folders = two(tmp_path, scaled, scaled)
    for path, thetas in zip(folders, ((0.2, 0.2), (0.3, 0.45)), strict=True):
        peaks = pd.read_csv(path / "peaks.csv")
        pd.concat(
            [
                peaks.assign(scale=scale, theta_max_over_alpha=theta)
                for scale, theta in zip((1.0, 1.5), thetas, strict=True)
            ]
        ).to_csv(path / "peaks.csv", index=False)
        saved = rb.open_results(path)
        rules = rb.Study.from_dict(scaled).checks
        write_verdicts(path, judge(rules, saved.peaks, saved.info["cases"], count="station"))
    rows = Page(rb.report(*folders).path.read_text(encoding="utf-8")).tables["answer"]
    assert [row[-1] for row in rows if row[-1].endswith("%")] == ["+20 %", "+50 %"]


def test_a_check_of_one_study_only_is_not_checked_in_the_other(tmp_path):
    folders = two(tmp_path, tables(), tables(check=[ROTATION, ROTATION | {"name": "more", "at_most": 0.9}]))
    rows = Page(rb.report(*folders).path.read_text(encoding="utf-8")).tables["answer"]
    (only,) = (row for row in rows if len(row) > 3 and row[1].startswith("more"))
    assert "not checked" in only[3]


# Pairs of cases


def test_cases_of_other_names_are_paired_by_the_inputs_that_differ_least(tmp_path):
    stiff, soft = SPRINGS | {"name": "x", "stiffness_kN_m": 4.0e6}, SPRINGS | {"name": "y", "zeta": 0.1}
    first = [SPRINGS | {"name": "p", "stiffness_kN_m": 4.0e6, "zeta": 0.02}, SPRINGS | {"name": "q", "zeta": 0.11}]
    both = pair(*(read(path, ()) for path in two(tmp_path, tables(case=first), tables(case=[soft, stiff]))))
    assert both.names == {"x": "p", "y": "q"}
    assert len(both.runs[0]) == 4
    assert set(zip(both.runs[0]["case"], both.runs[1]["case"], strict=True)) == {("p", "x"), ("q", "y")}


def test_cases_across_are_paired_as_their_cases_along_are(tmp_path):
    motions = {"motions": {"path": "motions/near_fault", "axis_deg": 0.0}}
    sides = [tables(case=[{"name": name, "base": "rigid", "other_width_m": 6.0}], **motions) for name in "pq"]
    both = pair(*(read(path, ()) for path in two(tmp_path, *sides)))
    assert both.names == {"q": "p", "q across": "p across"}
    assert set(both.runs[1]["case"]) == {"q", "q across"}


def test_a_name_in_both_comes_before_inputs_and_what_is_asked_before_both(tmp_path):
    other = SPRINGS | {"name": "other"}
    first, second = [SPRINGS, other | {"zeta": 0.1}], [SPRINGS | {"zeta": 0.1}, other]
    studies = [read(path, ()) for path in two(tmp_path, tables(case=first), tables(case=second))]
    assert pair(*studies).names == {"springs": "springs", "other": "other"}
    assert pair(*studies, {"springs": "other"}).names == {"other": "springs", "springs": "other"}


def test_pairs_are_asked_for_on_the_command_line(tmp_path, capsys):
    folders = two(tmp_path, tables(), tables(case=[SPRINGS | {"name": "x"}, SPRINGS | {"name": "y", "zeta": 0.1}]))
    assert main(["report", *map(str, folders), "--pair", "springs=y"]) == 0
    assert capsys.readouterr().out.startswith(
        "A passes all, closest 40 % (rotation, Lyttelton); B passes all in both cases"
    )
    assert "springs with y" in (folders[0] / "compare-b.html").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("asked", "words"),
    [
        ({"spring": "springs"}, 'A has no case "spring"; did you mean "springs"?'),
        ({"springs": "rock"}, 'B has no case "rock"; there is "springs"'),
    ],
)
def test_a_pair_of_cases_that_are_not_there_is_refused(tmp_path, asked, words):
    with pytest.raises(InputError, match=words.replace("?", r"\?")):
        rb.report(*two(tmp_path, tables(), tables()), pairs=asked)


def test_pairs_without_a_second_folder_are_refused(tmp_path):
    with pytest.raises(InputError, match="give the second one, too"):
        rb.report(folder(tmp_path / "a", rb.Study.from_dict(tables())), pairs={"springs": "springs"})


# Inputs


def changed(path, value):
    """Return the tables with another value at a path."""
    study = tables()
    *outer, key = path
    inner = study
    for step in outer:
        inner = inner[step]
    inner[key] = value
    return study


CASE = ("case", 0)
ONE_CHANGE = {
    "pier.deck_mass_t": (("pier", "deck_mass_t"), 600.0, ("500", "600")),
    "pier.height_m": (("pier", "height_m"), 20.00001, ("20", "20.00001")),
    "pier.top_m": (("pier", "top_m"), 22.0, ("–", "22")),
    "case springs, stiffness_kN_m": ((*CASE, "stiffness_kN_m"), 2.2e6, ("2 × 10⁶", "2.2 × 10⁶")),
    "case springs, zeta": ((*CASE, "zeta"), 0.02, ("0.05", "0.02")),
    "case springs, kinematics": ((*CASE, "kinematics"), "finite", ("first-order", "finite")),
    "case springs, flight_limit_mm": ((*CASE, "flight_limit_mm"), 9.0, ("5", "9")),
    "case springs, damper 1, force_kN": ((*CASE, "damper", 0, "force_kN"), 330.0, ("300", "330")),
    "case springs, tendon 1, prestress_kN": ((*CASE, "tendon", 0, "prestress_kN"), 900.0, ("1000", "900")),
    "case springs, stop 1, gap_mm": ((*CASE, "stop", 0, "gap_mm"), 100.0, ("120", "100")),
    "case springs, deck_spring 1, gap_mm": ((*CASE, "deck_spring", 0, "gap_mm"), 60.0, ("50", "60")),
    "motions.scale": (("motions", "scale"), 1.2, ("–", "1.2")),
    "motions.polarity": (("motions", "polarity"), "-", ("+", "-")),
    "motions, pulse Te Mara, amplitude_g": (("motions", "pulse", 0, "amplitude_g"), 0.9, ("1", "0.9")),
    "numerics.tolerance": (("numerics", "tolerance"), 1e-5, ("0.0001", "1 × 10⁻⁵")),
    "numerics.quiet_s": (("numerics", "quiet_s"), 3.0, ("2", "3")),
    "output.ledger": (("output",), {"ledger": True}, ("false", "true")),
    "check rotation, at_most": (("check", 0, "at_most"), 0.6, ("0.5", "0.6")),
    "suite.count": (("suite",), {"count": "component"}, ("station", "component")),
    "bound stiff": (("bound",), [{"name": "stiff", "case.zeta": 0.1}], ("–", "case.zeta = 0.1")),
}


@pytest.mark.parametrize("name", ONE_CHANGE)
def test_another_value_of_one_key_is_the_one_row_that_differs(tmp_path, name):
    """The dampers, tendon, stops, springs at the deck, zeta and scale were once "the same in both"."""
    path, value, shown = ONE_CHANGE[name]
    rows = inputs(two(tmp_path, tables(), changed(path, value)))
    own = {key: values for key, values in rows.items() if not key.startswith("different motions")}
    assert own.keys() == {name}
    if name in ("motions.scale", "output.ledger", "suite.count", "motions.polarity", "case springs, kinematics"):
        assert own[name][1] == shown[1]  # the default of A follows from the section of the key
    else:
        assert own[name] == shown


@pytest.mark.parametrize(
    ("path", "value"),
    [
        (("numerics", "quiet_s"), 2.0),
        ((*CASE, "kinematics"), "first-order"),
        ((*CASE, "stiffness_kN_m"), [2_000_000]),
        ((*CASE, "damper"), {"kind": "friction", "force_kN": 300}),
        (("title",), "another name"),
    ],
)
def test_the_same_value_in_other_words_is_no_difference(tmp_path, path, value):
    assert inputs(two(tmp_path, tables(), changed(path, value))) == {}


def test_springs_without_a_damping_ratio_differ_from_those_with_that_of_a_footing(tmp_path):
    """Which value an unwritten key has may depend on the base."""
    bare = {key: value for key, value in SPRINGS.items() if key != "zeta"}
    rows = inputs(two(tmp_path, tables(case=[bare]), tables(case=[SPRINGS])))
    assert rows == {"case springs, zeta": ("–", "0.05")}


def test_stronger_motions_under_the_same_names_differ_by_their_digests(tmp_path):
    study = rb.Study.from_dict(tables())
    motions = ground_motions(study)
    stronger = [motion.scaled(1.6) for motion in motions.motions]
    first = folder(tmp_path / "a", study.with_(motions=list(motions.motions)))
    second = folder(tmp_path / "b", study.with_(motions=stronger))
    rows = inputs([first, second])
    assert rows.keys() == {"different motions under the same name"}
    first_pga, second_pga = (
        [f"{motion.name} ({motion.pga / 9.81:.4g} g)" for motion in of_study]
        for of_study in (motions.motions, stronger)
    )
    assert rows["different motions under the same name"] == (", ".join(first_pga), ", ".join(second_pga))


def test_a_motion_of_another_shape_and_the_same_peak_differs(tmp_path):
    study = rb.Study.from_dict(tables())
    first, *others = ground_motions(study).motions
    late = first.horizontal.copy()
    late[-1] = 1e-3
    moved = rb.Motion(first.name, first.dt, late)
    sides = [[first, *others], [moved, *others]]
    folders = [folder(tmp_path / side, study.with_(motions=m)) for side, m in zip("ab", sides, strict=True)]
    assert list(inputs(folders)) == ["different motions under the same name"]


def test_many_motions_of_one_study_only_are_counted_as_motions(tmp_path):
    pulses = [PULSES[0] | {"name": f"n{i:02}"} for i in range(12)]
    rows = inputs(two(tmp_path, tables(), tables(motions={"pulse": [*PULSES, *pulses]})))
    assert rows["motions in one study only"][1].startswith("12 motions: n00, n01")


def test_motions_of_one_study_only_are_named(tmp_path):
    rows = inputs(two(tmp_path, tables(), tables(motions={"pulse": PULSES[:1]})))
    assert rows["motions in one study only"] == ("Lyttelton", "–")
    assert rows["motions, pulse Lyttelton"] == (
        "shape = sine; amplitude_g = 1; period_s = 0.7; dt_s = 0.01; duration_s = 4",
        "–",
    )


def test_files_left_out_or_unusable_of_one_study_are_named_by_their_kind(tmp_path):
    folders = two(tmp_path, tables(), tables())
    for path, left_out, unusable in zip(folders, ("ONE", "TWO"), ("BAD", "CUT"), strict=True):
        file = path / "run.json"
        info = json.loads(file.read_text(encoding="utf-8"))
        info["left_out"] = [{"name": left_out, "source": left_out, "reason": "excluded", "station": left_out}]
        info["unusable"] = [{"name": unusable, "source": unusable, "reason": "the file is cut", "station": unusable}]
        file.write_text(json.dumps(info), encoding="utf-8")
    assert inputs(folders) == {"files left out": ("ONE", "TWO"), "files that could not be used": ("BAD", "CUT")}


def test_checks_of_a_file_beside_the_study_are_compared_too(tmp_path):
    folders = []
    for side, limit in zip("ab", (0.5, 0.6), strict=True):
        rules = f'[[check]]\nname = "rotation"\ndemand = "theta_max_over_alpha"\nat_most = {limit}\nreason = "agreed"\n'
        study = rb.Study.from_dict({name: table for name, table in tables().items() if name != "check"})
        of_file = replace(study, check_files=((Path("checks.toml"), rules),))
        folders.append(folder(tmp_path / side, of_file))
    assert inputs(folders) == {"check rotation, at_most": ("0.5", "0.6")}


def test_cases_paired_by_inputs_differ_in_values_only(tmp_path):
    rows = inputs(two(tmp_path, tables(), tables(case=[SPRINGS | DEVICES | {"name": "x", "zeta": 0.1}])))
    assert rows == {"case springs, zeta": ("0.05", "0.1")}


def test_a_case_without_a_name_has_that_of_its_base_and_other_tables_their_number(tmp_path):
    def unnamed(stiffness, force):
        dampers = [{"kind": "viscous", "nu": 0.1, "exponent": 1.0}, {"kind": "friction", "force_kN": force}]
        return tables(case=[{"base": "elastic", "stiffness_kN_m": stiffness, "zeta": 0.05, "damper": dampers}])

    assert inputs(two(tmp_path, unnamed(2e6, 100.0), unnamed(3e6, 200.0))) == {
        "case elastic, stiffness_kN_m": ("2 × 10⁶", "3 × 10⁶"),
        "case elastic, damper 2, force_kN": ("100", "200"),
    }


def test_what_one_study_has_is_shown_with_lists_in_brackets_and_names_of_tables(tmp_path):
    soft = {"name": "soft", "base": "elastic", "stiffness_kN_m": [3e5, 4e5], "zeta": [0.02, 0.05]}
    soft["damper"] = [{"kind": "friction", "force_kN": 300.0}]
    rows = inputs(two(tmp_path, tables(), tables(case=[SPRINGS | DEVICES, soft])))
    values = "base = elastic; stiffness_kN_m = [300,000, 400,000]; zeta = [0.02, 0.05]"
    assert rows == {"case soft": ("–", f"{values}; damper 1, kind = friction; damper 1, force_kN = 300")}


def test_the_values_of_a_study_are_gone_through_once_for_all_tables_that_only_it_has():
    """Each table went through all: 3 s for 3,000 pulses with five keys."""

    class Counted(dict):
        times = 0

        def __iter__(self):
            self.times += 1
            return super().__iter__()

    pulses = [("motions", "pulse", f"p{i}") for i in range(300)]
    values = Counted({(*pulse, key): i for i, pulse in enumerate(pulses) for key in ("name", "period_s")})
    shown = list(_contents(Written(values, {}, {*pulses}), pulses))
    assert shown == [(pulse, f"period_s = {i}") for i, pulse in enumerate(pulses)]
    assert values.times == 1


@pytest.mark.sweep(fast=6, slow=12)
@pytest.mark.parametrize("seed", [*range(6), *(pytest.param(seed, marks=pytest.mark.slow) for seed in range(6, 40))])
def test_every_key_that_was_changed_at_random_differs_and_no_other(tmp_path, seed):
    rng = np.random.default_rng(seed)
    apart = ("bound stiff", "output.ledger", "suite.count", "motions.scale", "motions.polarity")
    candidates = [name for name in ONE_CHANGE if name not in apart and name != "motions, pulse Te Mara, amplitude_g"]
    chosen = rng.choice(candidates, size=int(rng.integers(1, 8)), replace=False)
    study = tables()
    for name in chosen:
        path, value, _ = ONE_CHANGE[name]
        inner = study
        for step in path[:-1]:
            inner = inner[step]
        inner[path[-1]] = value
    renamed = rng.random() < 0.5
    if renamed:
        study["case"][0]["name"] = "another"
    theta = [float(value) for value in rng.uniform(0.1, 0.9, 2)]
    folders = two(tmp_path, tables(), study, theta)
    assert inputs(folders).keys() == {*chosen}
    limits = [0.5, study["check"][0]["at_most"]]
    line = said(folders).split("; ")
    for words, value, limit in zip(line, theta, limits, strict=True):
        assert ("passes all" in words) == (value <= limit)
        percent = int(words.split(" %")[0].rsplit(" ", 1)[1].split(".")[0])
        assert math.isclose(percent, 100 * value / limit, abs_tol=1.0)


def test_a_ban_is_its_name_and_what_does_not_apply_is_one_dash(tmp_path):
    never = {"name": "stands", "demand": "overturned", "at_most": 0.9, "reason": "agreed"}
    ductile = {"name": "ductile", "demand": "ductility", "at_most": 3.0, "reason": "agreed"}
    folders = two(tmp_path, tables(), tables(check=[never, ductile], case=[{"name": "springs", "base": "rigid"}]))
    rows = Page(rb.report(*folders).path.read_text(encoding="utf-8")).tables["answer"]
    cells = {row[1].replace("\u00a0", " "): row for row in rows if len(row) > 5}
    assert cells["stands"][-3:-1] == ["none", "✓"]
    assert cells["ductile ≤ 3"][-2] == "–"
