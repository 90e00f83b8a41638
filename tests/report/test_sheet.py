"""The calculation sheet has every value of the report in a layout for paper, and all names on it are words."""

import hashlib
import json
import re
from dataclasses import replace

import numpy as np
import pytest
from browser import HOSTILE, browse, needs_chromium
from check_samples import verdict
from report_page import Page
from report_samples import FIG7, FOUNDATIONS, case_entry, write_results

import rockbatch as rb
from rockbatch.checks import write_verdicts
from rockbatch.common.errors import InputError
from rockbatch.common.files import legible
from rockbatch.motions.description import digest
from rockbatch.pier import Damper, Pier, RigidBase, Stop, Tendon, YieldingBase
from rockbatch.reporting import write_report
from rockbatch.reporting.finished import read
from rockbatch.reporting.markup import Markup
from rockbatch.reporting.page import Part
from rockbatch.reporting.sections import assumptions, studied
from rockbatch.reporting.sheet import sheet_of as made
from rockbatch.reporting.table import PAPER, Head, on_paper, table
from rockbatch.results.run_json import describe_case
from rockbatch.study import Case

PIER = Pier(alpha=0.13, p=0.38)


def entry(name, base, mass_t=None, **parameters):
    """Return a case of run.json with the devices of its base, and with a mass if it is given."""
    case = case_entry(name, {}, PIER, base)
    if base.restraints:
        case["parameters"] |= base.parameters(PIER)
    case["parameters"] |= parameters
    case["pier"] |= {} if mass_t is None else {"mass_t": mass_t}
    return case


def bending(**parameters):
    """Return a case with a shaft that bends."""
    case = entry("a", RigidBase(), shaft="elastic", **parameters)
    case["pier"] |= {"flexural_period_s": 1.5}
    return case


def sheet_of(directory, **results):
    write_results(directory, **results)
    return made(read(directory)).html()


def assumptions_of(directory):
    finished = read(directory)
    return assumptions.lines(finished, finished.info["cases"])


def in_browser(directory, text, act=""):
    """Return what a script finds on the sheet in a browser, in a window of about the width of A4."""
    path = directory / "sheet.html"
    path.write_text(text, encoding="utf-8")
    return browse(path, act, size=(760, 1000))


def test_a_sheet_has_its_sections_in_order_and_nothing_folded(tmp_path):
    text = sheet_of(tmp_path)
    wanted = [
        "Result",
        "Inputs",
        "What is assumed",
        "Ground motions",
        "Every run",
        "Statics",
        "Digests",
        "The study file",
    ]
    headings = [re.sub(r"^\d+ ", "", heading) for heading in Page(text).headings]
    places = [headings.index(heading) for heading in wanted]
    assert places == sorted(places)
    assert not re.search(r"<details(?! open)", text)
    assert "<script" not in text


def test_every_page_has_study_version_commit_date_and_its_number(tmp_path):
    text = sheet_of(tmp_path, versions={"python": "3.11", "commit": "1f2e3d4c5b6a"})
    margins = re.search(r"@page \{\s*@top-left.*?\n\}", text, re.DOTALL)[0].replace("\\28 ", "(").replace("\\29 ", ")")
    for words in ("Stepping tower", "rockbatch 0.1.0", "1f2e3d4c5b6a", 'counter(page) " of " counter(pages)'):
        assert words in margins
    assert "2025" in margins
    assert "size:" not in margins  # the paper of the printer, A4 or Letter


def test_a_wide_table_is_in_parts_that_repeat_its_first_columns(tmp_path):
    heads = [Head("record"), Head("case", filter=True), *(Head(f"quantity {i}", ".2f", unit="kN m") for i in range(40))]
    rows = [[f"r{row}", "pads", *(row + i / 7 for i in range(40))] for row in range(3)]
    with on_paper():
        parts = Page(f'<section id="x">{table(heads, rows, name="Runs")}</section>')
    heads_of_parts = [row for row in parts.tables["x"] if row[0] == "record"]
    assert len(heads_of_parts) > 2
    assert all(row[:2] == ["record", "case"] for row in heads_of_parts)
    assert [name for row in heads_of_parts for name in row[2:]] == [head.words for head in heads[2:]]
    assert sum(row[0] == "r0" for row in parts.tables["x"]) == len(heads_of_parts)
    assert f"Runs, part 2 of {len(heads_of_parts)}" in parts.text
    assert all(sum(len(cell) for cell in row) <= PAPER for row in parts.tables["x"] if row[0] == "r0")
    off = Page(f'<section id="x">{table(heads, rows, name="Runs")}</section>')
    assert [len(row) for row in off.tables["x"]] == [42] * 4


def test_every_part_of_the_verdicts_names_check_and_case(tmp_path, monkeypatch):
    """The second part had the checks alone: three rows "tilt" for three cases."""
    monkeypatch.setattr("rockbatch.reporting.table.PAPER", 80)
    write_results(tmp_path)
    write_verdicts(tmp_path, [verdict(name, "pass", counted="a remark") for name, _ in FOUNDATIONS[:3]])
    rows = Page(made(read(tmp_path)).html()).tables["checks"]
    heads = [row[:2] for row in rows if row[0] == "check" and "requirement" not in row]
    assert len(heads) > 1
    assert heads == [["check", "case"]] * len(heads)


def test_each_constant_of_each_device_and_part_is_among_the_inputs(tmp_path):
    devices = (
        Damper("viscous", nu=0.8, exponent=0.37, at="left"),
        Tendon(psi=0.2345, lam=0.6, strength=0.9),
        Stop(gap_m=0.123, lam=21.0, restitution=0.66),
    )
    base = replace(YieldingBase(beta=40.0, eta=2.5, epsilon=0.05), restraints=devices)
    text = '[pier]\nwidth_m = 8.125\n[[pier.part]]\nmass_t = 777.5\nheight_m = 11.25\n[[case]]\nname = "a"\nbase = "yielding"\n'
    study = {"path": "a.toml", "title": "a", "notes": "", "text": text, "sha256": "0" * 64}
    page = Page(sheet_of(tmp_path, cases=[entry("a", base, mass_t=2000.0)], study=study))
    cells = {cell for row in page.tables["inputs"] for cell in row}
    assert {"8.125", "777.5", "11.25", "40", "2.5", "0.05", "0.37", "0.2345", "0.9", "0.123", "21", "0.66"} <= cells
    in_words = next(row for row in page.tables["inputs"] if any("tendon" in cell for cell in row))
    assert any(f"P0 = {0.2345 * 2000.0 * 9.81:.0f} kN" in cell.replace("\u00a0", " ") for cell in in_words)


@pytest.mark.parametrize(
    ("case", "words", "absent"),
    [
        (entry("a", RigidBase()), "Housner's factor", "two vertical supports"),
        (entry("a", RigidBase(restitution=0.9)), "the given factor 0.9", "Housner's factor"),
        (entry("a", YieldingBase(beta=40.0, eta=2.5, epsilon=0.05)), "keeps ε = 0.05 of its speed", "rigid ground"),
        (entry("a", YieldingBase(beta=40.0, eta=2.5), zeta=0.04), "ζ = 0.04 of critical", "Nothing but landings"),
        (entry("a", RigidBase(), friction=0.45), "at a friction of 0.45", "whatever friction this requires"),
        (entry("a", RigidBase()), "whatever friction this requires", "are marked"),
        (entry("a", RigidBase(), flight="stop"), "A run ends when both pivots leave", "shear keys guide"),
        (
            entry("a", replace(RigidBase(), restraints=(Tendon(psi=0.2),))),
            "they do not degrade, break or reach",
            "are marked",
        ),
        (entry("a", RigidBase()), "Nothing but landings", "they do not degrade, break or reach"),
        (bending(flexural_modes=3), "The shaft bends in 3 modes, the first of 1.5 s; higher ones", "one rigid body"),
        (bending(), "bends in one mode, the first of 1.5 s", "Housner's factor"),
        (bending(), "the momenta of the modes of a shaft that bends are kept", "the given factor"),
        (entry("soft, weak", YieldingBase(beta=40.0, eta=2.5), zeta=0.04), "stand", "(soft, weak"),
        (entry("a", RigidBase()) | {"across_of": "b"}, "Two planar models", "one vertical plane"),
    ],
)
def test_the_values_of_a_study_decide_its_assumptions(tmp_path, case, words, absent):
    write_results(tmp_path, cases=[case])
    said = " ".join(assumptions_of(tmp_path))
    assert words in said
    assert absent not in said


def test_what_holds_for_some_cases_only_names_them(tmp_path):
    write_results(tmp_path, cases=[entry("rock", RigidBase()), entry("pads", YieldingBase(beta=40.0, eta=2.5))])
    said = " ".join(assumptions_of(tmp_path))
    assert "two pivots that keep their place: no crushing of edges (rock)" in said
    assert "two vertical supports that push and never pull, one at each pivot (pads)" in said
    assert "breaks" not in said


@pytest.mark.parametrize(
    ("verticals", "words"),
    [
        ([None] * 3, "The ground moves horizontally and alike"),
        ([0.2] * 3, "The ground moves horizontally and vertically and alike"),
        ([0.2, None, None], "The ground moves horizontally (vertically, too, in 1 of 3 records) and alike"),
    ],
)
def test_the_number_of_records_with_a_vertical_is_said(tmp_path, verticals, words):
    write_results(tmp_path, records=FIG7[:3])
    file = tmp_path / "run.json"
    info = json.loads(file.read_text(encoding="utf-8"))
    for record, vertical in zip(info["records"], verticals, strict=True):
        record["pga_v_g"] = vertical
    file.write_text(json.dumps(info), encoding="utf-8")
    assert words in " ".join(assumptions_of(tmp_path))


def test_devices_of_one_case_of_two_have_their_assumption(tmp_path):
    held = entry("held", replace(RigidBase(), restraints=(Tendon(psi=0.2),)))
    write_results(tmp_path, cases=[entry("rock", RigidBase()), held])
    assert "they do not degrade, break or reach" in " ".join(assumptions_of(tmp_path))


def test_constants_stand_below_their_own_heads(tmp_path):
    """The yield deflection of springs with η = 2.5 is more than their deflection under the weight."""
    devices = (Damper("viscous", nu=0.8, exponent=0.37, at="left"), Tendon(psi=0.2345, lam=0.6, strength=0.9))
    base = replace(YieldingBase(beta=40.0, eta=2.5, epsilon=0.05), restraints=devices)
    rows = Page(sheet_of(tmp_path, cases=[entry("a", base, mass_t=2000.0)])).tables["inputs"]
    found = {}
    heads = ()
    for row in rows:
        heads = row if "case" in row else heads
        for head, cell in zip(heads, row, strict=False):
            if re.fullmatch(r"[\d.]+", cell):
                found.setdefault(head, set()).add(float(cell))
    for head, value in (("P0/(M g)", 0.2345), ("Ty/(M g)", 0.9), ("C/(M p)", 0.8), ("exponent", 0.37)):
        assert found[head] == {value}, head
    assert max(found["static deflection [m]"]) < min(found["yield deflection [m]"])


def test_every_foundation_and_every_listed_value_is_among_the_inputs(tmp_path):
    cases = [entry("rock", RigidBase(restitution=0.91)), entry("pads", YieldingBase(beta=41.5, eta=2.25))]
    text = '[pier]\nwidth_m = 8.0\nheight_m = [30.0, 33.0]\nmass_t = 700.0\n[[case]]\nname = "a"\nbase = "rigid"\n'
    study = {"path": "a.toml", "title": "a", "notes": "", "text": text, "sha256": "0" * 64}
    rows = Page(sheet_of(tmp_path, cases=cases, study=study)).tables["inputs"]
    cells = {cell for row in rows for cell in row}
    assert {"0.91", "41.5", "2.25", "30, 33"} <= cells


def test_a_pier_that_a_bound_changes_has_the_name_of_the_bound_among_the_inputs(tmp_path):
    heavy = replace(PIER, p=0.37)
    cases = [describe_case(Case("foot", pier, RigidBase(), {"bound": bound})) for pier, bound in
             ((PIER, ""), (PIER, "soft"), (heavy, "traffic"), (heavy, "more traffic"))]  # fmt: skip
    rows = Page(sheet_of(tmp_path, cases=cases, varied=("bound",))).tables["inputs"]
    piers = [row for row in rows if row[1:2] == ["0.13"]]
    assert [row[0] for row in piers] == ["foot", "foot: traffic, more traffic"]
    alone = Page(sheet_of(tmp_path, cases=cases[:2], varied=("bound",))).tables["inputs"]
    assert [row[0] for row in (*rows, *alone) if "R0 [m]" in row] == ["case", "α [rad]"]  # one pier needs no name


def test_the_numbers_of_the_ground_are_among_the_inputs_as_they_were_given(tmp_path):
    keys = 'name = "clay"\nbase = "footing"\nshear_modulus_MPa = 101.5\npoisson = [0.31, 0.49]\n'
    text = f'[[case]]\n{keys}[[case.damper]]\nkind = "x"'
    study = {"path": "a.toml", "title": "a", "notes": "", "text": text, "sha256": "0" * 64}
    rows = Page(sheet_of(tmp_path, study=study)).tables["inputs"]
    assert ["clay", "footing", "101.5", "0.31, 0.49"] in rows
    (head,) = [row for row in rows if row[:1] == ["case"] and len(row) == 4 and row[2].startswith("shear")]
    assert head[2] == "shear modulus [MPa]"


def test_no_two_different_foundations_have_the_same_row(tmp_path):
    cases = [
        entry("slender", RigidBase(), friction=0.4),
        entry("slender", RigidBase(), friction=0.5),
        entry("slender", replace(RigidBase(), restraints=(Tendon(psi=0.2),)), friction=0.5),
        entry("slender", replace(RigidBase(), restraints=(Tendon(psi=0.3),)), friction=0.5),
    ]
    for place, case in enumerate(cases):
        case["case"] = f"{case['case']}{place}"
    write_results(tmp_path, cases=cases)
    page = Page(f'<section id="x">{studied.section(read(tmp_path))}</section>')
    rows = [tuple(row[1:]) for row in page.tables["x"] if row[0].startswith("slender")]
    assert len(set(rows)) == len(rows) == 4
    head = next(row for row in page.tables["x"] if row[0] == "case")
    assert "friction" in head


def test_the_governing_record_of_a_cell_is_seen_without_a_mouse(tmp_path):
    text = sheet_of(tmp_path)
    rule = re.search(r"\.card small\.governs \{([^}]*)\}", text)[1]
    assert "display: none" not in rule


def test_the_digest_of_a_record_is_that_of_its_samples():
    motion = rb.Motion.from_array([0.0, 0.5, -0.25], 0.02, name="a", unit="m/s2")
    by_hand = hashlib.sha256(np.array([0.02, *motion.horizontal]).astype("<f8").tobytes()).hexdigest()
    assert digest(motion) == by_hand
    other = rb.Motion.from_array([0.0, 0.5, -0.2500001], 0.02, name="a", unit="m/s2")
    assert digest(other) != by_hand
    with_vertical = rb.Motion.from_array([0.0, 0.5, -0.25], 0.02, name="a", unit="m/s2", vertical=[0.0, 0.0, 0.0])
    assert digest(with_vertical) != by_hand
    assert digest(replace(motion, across=motion.horizontal)) not in (by_hand, digest(with_vertical))


def test_digests_of_study_results_program_and_records_are_on_the_sheet(tmp_path):
    write_results(tmp_path, digest={"program": "af72ea222bd896a1"})
    results = read(tmp_path)
    of_peaks = hashlib.sha256((tmp_path / "peaks.csv").read_bytes()).hexdigest()
    results.info["peaks"] = {"rows": 30, "sha256": of_peaks}
    for place, record in enumerate(results.info["records"]):
        record["digest"] = f"{place:064d}"
    rows = Page(made(results).html()).tables["digests"]
    assert [row[2] for row in rows if row[0] == "record"] == [f"{place:064d}" for place in range(len(FIG7))]
    found = {row[0]: row[2] for row in rows}
    assert found["study file"] == results.info["study"]["sha256"]
    assert found["results"] == of_peaks
    assert found["program"] == "af72ea222bd896a1…"
    computed = (
        "Computed with python 3.11.2, numpy 2.3.1, numba 0.62.0 on Linux x86_64, 2 cores, 2025-11-21T10:00:00+00:00."
    )
    assert computed in Page(made(results).html()).text


def test_digests_that_are_not_known_are_said_not_to_be_noted(tmp_path):
    """Those of results that an earlier version wrote."""
    rows = Page(sheet_of(tmp_path)).tables["digests"]
    assert {row[0]: row[2] for row in rows if row[0] in ("results", "program", "record")} == dict.fromkeys(
        ("results", "program", "record"), "not noted"
    )


def test_rows_beyond_what_is_printed_are_counted(tmp_path):
    records = [(f"r{place}", 0.3) for place in range(30)]
    page = Page(sheet_of(tmp_path, records=records))
    assert "The worst 100 of 150 rows are shown." in page.text


def test_python_writes_the_sheet_beside_the_report_and_refuses_one_of_two_studies(tmp_path):
    write_results(tmp_path)
    written = rb.report(tmp_path, sheet=True)
    assert written.path == tmp_path / "sheet.html"
    assert written.path.read_text(encoding="utf-8") == made(read(tmp_path)).html()
    assert not (tmp_path / "report.html").exists()
    assert written.save(tmp_path / "mail").read_bytes() == written.path.read_bytes()
    with pytest.raises(InputError, match="a calculation sheet is of one study"):
        rb.report(tmp_path, tmp_path, sheet=True)


def hostile(directory):
    """Write results whose every name is hostile, and return their sheet."""
    names = [(name, 0.4) for name in HOSTILE]
    cases = [entry(name, base) for name, base in zip(HOSTILE, [RigidBase()] * 3, strict=False)]
    study = {"path": HOSTILE[4], "title": HOSTILE[2], "notes": HOSTILE[0], "text": HOSTILE[4], "sha256": HOSTILE[1]}
    unusable = [{"name": name, "source": name, "reason": name} for name in HOSTILE]
    versions = {"commit": HOSTILE[4], HOSTILE[0]: HOSTILE[1]}
    return sheet_of(
        directory, records=names, cases=cases, study=study, unusable=unusable, versions=versions, created=HOSTILE[4]
    )


def test_hostile_names_are_words_on_the_sheet(tmp_path):
    text = hostile(tmp_path)
    page = Page(text)
    assert page.mismatched == []
    assert {"script", "img", "iframe", "base", "form", "link"}.isdisjoint(page.tags)
    assert text.count("</style>") == 1
    assert page.text.count(HOSTILE[0]) > 2


@needs_chromium
def test_a_sheet_runs_and_fetches_nothing_and_is_as_wide_as_its_paper(tmp_path):
    found = in_browser(tmp_path, hostile(tmp_path), "found.ran = window.ran;")
    assert (found.get("ran"), found["wrong"], found["requests"], found["wide"]) == (None, [], [], True)
    assert in_browser(tmp_path, sheet_of(tmp_path))["wide"]


@needs_chromium
@pytest.mark.parametrize("pier", [PIER, Pier.with_deck(7.9, 29.9, 3000.0, 1000.0)])
def test_no_table_of_a_sheet_is_wider_than_the_sheet(tmp_path, pier):
    """The heads of a pier with a deck stood in one line each, beyond the edge of the paper."""
    case = describe_case(Case("rigid", pier, RigidBase(), {}))
    act = """
    const main = document.querySelector("main").getBoundingClientRect().right;
    found.beyond = [...document.querySelectorAll("table")].map((node) => node.getBoundingClientRect().right - main);
    """
    found = in_browser(tmp_path, sheet_of(tmp_path, cases=[case]), act)
    assert len(found["beyond"]) > 8
    assert max(found["beyond"]) < 2


def test_devices_observers_and_analyses_of_a_folder_have_their_sections_on_the_sheet(tmp_path, monkeypatch):
    """Whatever the report has of them, paper has too."""
    pulse = {"name": "sine", "shape": "sine", "amplitude_g": 0.4, "period_s": 0.8, "dt_s": 0.01, "duration_s": 3.0}
    case = {"name": "rock", "base": "rigid", "damper": [{"kind": "friction", "force_kN": 300.0}]}
    pier = {"width_m": 4.0, "height_m": 20.0, "mass_t": 900.0}
    tables = {"pier": pier, "motions": {"pulse": [pulse]}, "case": [case], "output": {"forces": True}}
    rb.run(rb.Study.from_dict(tables), out=tmp_path, jobs=1, progress=False)
    drawn = [Part("Free rocking", "release", lambda contents: Markup("<p>θ</p>"))]
    monkeypatch.setattr("rockbatch.reporting.sheet.of_analyses", lambda: drawn)
    headings = {re.sub(r"^\d+ ", "", heading) for heading in Page(made(read(tmp_path)).html()).headings}
    assert {"Devices", "Forces", "Free rocking"} <= headings


@needs_chromium
@pytest.mark.parametrize("written", ["page", "sheet"])
def test_hostile_bounds_checks_and_reasons_are_words_on_page_and_sheet(tmp_path, written):
    """Each drawn pier, each cell and each sentence has one of them: none runs, none is an element, all can be read."""
    pier = Pier(alpha=0.13, p=0.38)
    damped = RigidBase(restraints=(Damper(kind="friction", f=0.05),))
    cases = [entry("design", RigidBase(), bound="")]
    cases += [describe_case(Case("design", pier, damped, {"bound": name})) for name in HOSTILE]
    write_results(tmp_path, records=[("r", 0.3)], cases=cases, varied=("bound",))
    verdicts = [
        verdict(
            "design", "fail", columns={"bound": bound}, check=name, reason=name, words=name, remarks=(name,), record="r"
        )
        for bound in ("", *HOSTILE[:3])
        for name in HOSTILE
    ]
    write_verdicts(tmp_path, verdicts)
    path = write_report(tmp_path, [])
    if written == "sheet":
        path.write_text(made(read(tmp_path)).html(), encoding="utf-8")
    act = """
    for (const node of document.querySelectorAll("button, summary")) node.click();
    found.ran = window.ran ?? null;
    found.elements = document.querySelectorAll("img, iframe, base, link, form, [onerror], [onload], [onmouseover]").length;
    found.text = document.body.textContent;
    """
    found = browse(path, act)
    assert (found["wrong"], found["requests"], found["ran"], found["elements"], found["wide"]) == (
        [],
        [],
        None,
        0,
        True,
    )
    text = "".join(found["text"].split())
    assert not [name for name in HOSTILE if "".join(legible(name).split()) not in text]
