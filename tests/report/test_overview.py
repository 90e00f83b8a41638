"""The first screen is the answer, for any number of cases and records: the rest is summed up, or folded."""

import json
import re
import xml.etree.ElementTree as ET
from dataclasses import replace
from pathlib import Path

import pandas as pd
import pytest
from browser import browse, needs_chromium
from check_samples import verdict
from report_page import Page, dot_rows
from report_samples import FIG7, case_entry, write_results

import rockbatch.reporting
from rockbatch.checks import write_verdicts
from rockbatch.pier import Pier, RigidBase, YieldingBase
from rockbatch.reporting import write_report

PIER = Pier(alpha=0.13, p=0.38)
BETAS, ETAS = range(20, 120, 10), (1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 4.5, 5.0, 5.5, 6.0)
GRID = [(float(beta), eta) for beta in BETAS for eta in ETAS]


FAILING = [verdict(f"c{i}", "fail", ratio=1.1 + i / 10, check="drift") for i in range(40)]


@pytest.fixture(scope="module")
def hundred(tmp_path_factory):
    """Write a report of a hundred cases, which all fail under one record and overturn under another."""
    folder = tmp_path_factory.mktemp("hundred")
    cases = [case_entry("pads", {"beta": b, "eta": e}, PIER, YieldingBase(beta=b, eta=e)) for b, e in GRID]
    changes = {("ERZ-NS", "pads"): {"status": "failed", "theta_max_over_alpha": "", "reason": "not settled: of many"},
               ("RRS228", "pads"): {"status": "overturned"}}  # fmt: skip
    write_results(folder, cases=cases, varied=("beta", "eta"), changes=changes)
    write_verdicts(folder, FAILING)
    return write_report(folder, [])


@pytest.fixture(scope="module")
def hundreds(tmp_path_factory):
    """Write a report of three hundred records."""
    folder = tmp_path_factory.mktemp("hundreds")
    records = [(f"R{i}", 0.1 + 0.001 * i) for i in range(300)]
    worst = {("R7", "rigid"): {"status": "overturned"}, ("R9", "2"): {"theta_max_over_alpha": 0.9}}
    write_results(folder, records=records, changes=worst)
    write_verdicts(folder, FAILING)
    return write_report(folder, [])


def rows(text, section):
    """Return the words of each row of the pictures in a section, without the folded ones."""
    own = text[text.index(f'<section id="{section}">') :].split("</section>")[0]
    own = re.sub(r"<details>.*?</details>", "", own, flags=re.DOTALL)
    return [
        Page(words).text.replace("\u00a0", " ")
        for words in re.findall(r'<span class="words">.*?</span>', own, re.DOTALL)
    ]


def test_a_strip_has_every_peak_at_its_place_and_says_its_ends(tmp_path):
    """Places in percent grow with θ_max/α, from the grid's first line at zero, its marks between the others."""
    changes = {("ERZ-NS", case): {"status": "overturned"} for case in ("rigid", "1", "2", "3", "4")}
    changes |= {("RRS228", case): {"status": "failed", "theta_max_over_alpha": ""} for case in ("rigid", "1", "2", "3")}
    write_results(tmp_path, changes=changes)
    text = write_report(tmp_path).read_text(encoding="utf-8")
    peaks = pd.read_csv(tmp_path / "peaks.csv")
    own = text[text.index('<section id="answer">') :].split("</section>")[0]
    places = []
    for pga, row in re.findall(r'<div class="row" data-pga="([^"]*)">(.*?)</div>', own, re.DOTALL):
        (strip,) = (svg for svg in ET.fromstring(f"<div>{row}</div>").iter("svg") if "strip" in svg.get("class"))
        record = strip.get("data-of")
        stood = peaks[(peaks["record"] == record) & (peaks["status"] == "ok")].sort_values("theta_max_over_alpha")
        thetas = stood["theta_max_over_alpha"].tolist()[::-1]
        ends = {0: "no peak", 1: "θmax/α {0:.4f}"}.get(len(thetas), "θmax/α {1:.4f} to {0:.4f}")
        assert strip.get("aria-label") == f"{record}: {ends.format(*thetas[:1], *thetas[-1:])}"
        assert float(pga) == dict(FIG7)[record]
        marks = [mark for mark in strip if mark.get("class") != "grid"]
        assert [float(mark.find("title").text.split(": ")[-1].split(" ")[0]) for mark in marks] == pytest.approx(
            thetas, abs=6e-5
        )
        for mark, theta in zip(marks, thetas, strict=True):
            places.append((theta, float((mark.get("x") or mark.get("x1")).removesuffix("%"))))
            middle = (
                0.5 * (float(mark.get("y1")) + float(mark.get("y2"))) if mark.tag == "line" else float(mark.get("y"))
            )
            assert middle == 10.0
        zero = min(float(line.get("x1").removesuffix("%")) for line in strip if line.get("class") == "grid")
        assert all(line.get("y1") == "0" for line in strip if line.get("class") == "grid")
    assert len(places) == len(peaks) - 9
    (theta, place) = max(places)
    assert 50.0 < place < 100.0
    assert [x for _, x in places] == pytest.approx(
        [zero + (place - zero) * each / theta for each, _ in places], abs=0.11
    )


@pytest.mark.slow
def test_a_hundred_cases_fit_the_first_screen_and_the_best_have_a_picture(
    hundred,
):
    text = hundred.read_text(encoding="utf-8")
    assert sorted(rows(text, "answer")) == sorted(name for name, _ in FIG7)
    best = rows(text, "figure")
    assert len(best) == 14
    assert best[-1] == "the other 87 foundations"
    assert "All 100 foundations, in the order of the study" in text


@pytest.mark.slow
def test_of_hundreds_of_records_the_worst_have_a_row_and_the_others_share_one(hundreds):
    text = hundreds.read_text(encoding="utf-8")
    shown = rows(text, "answer")
    assert shown[:2] == ["R7", "R9"]
    assert shown[13] == "the other 287 records"
    assert len(shown) == 14 + 287  # on request
    assert hundreds.stat().st_size < 3e6


def test_runs_without_a_peak_are_named_by_foundation_or_counted(tmp_path, hundred):
    changes = {("RRS228", "2"): {"status": "overturned"}, ("RRS228", "rigid"): {"status": "overturned"},
               ("RRS228", "3"): {"status": "failed", "theta_max_over_alpha": ""}}  # fmt: skip
    write_results(tmp_path, changes=changes)
    few = write_report(tmp_path, []).read_text(encoding="utf-8")
    ends = [Page(end).text for end in re.findall(r'<span class="ends">(.*?)</span></span>', few, re.DOTALL)]
    assert ends[0].replace("?", "") == "rigid, 23"
    assert few.index("RRS228") < few.index("ERZ-NS")
    assert "100 × overturned" in hundred.read_text(encoding="utf-8")


@needs_chromium
@pytest.mark.parametrize("many", ["hundred", "hundreds"])
def test_the_whole_answer_is_on_the_first_screen(many, request):
    page = request.getfixturevalue(many)
    act = """
    found.answer = document.querySelector("#answer .lead").getBoundingClientRect().bottom;
    found.card = document.querySelector("#answer .card").getBoundingClientRect().bottom;
    found.figure = document.querySelector("#answer .dots .row svg").getBoundingClientRect().bottom;
    """
    found = browse(page, act, size=(1400, 900))
    assert 0 < found["answer"] < found["card"] < found["figure"] < 900


def test_long_names_of_what_has_no_peak_leave_the_figure_its_room(tmp_path):
    names = ["a foundation with a long name", "another one with a long name"]
    cases = [case_entry(name, {}, PIER, RigidBase()) for name in names]
    cases.append(case_entry("pads", {}, PIER, YieldingBase(beta=40.0, eta=2.5)))
    write_results(tmp_path, cases=cases, changes={("RRS228", name): {"status": "overturned"} for name in names})
    text = write_report(tmp_path, []).read_text(encoding="utf-8")
    worst = re.search(r'<span class="ends">(.*?)</span></span>', text, re.DOTALL)[1]
    assert Page(worst).text == "2"


def drift(limit, case="rigid"):
    return verdict(case, "pass", check="bearings", demand="top_drift_m", unit="m", limit=limit, statistic="median")


def of_the_answer(path):
    return path.read_text(encoding="utf-8").split('<section id="answer">')[1].split("</section>")[0]


def test_limits_of_rotations_are_drawn_where_they_are_and_named_in_the_legend(tmp_path):
    """Compute the limit by hand: a drift of the top d allows θ/α = d/(2 h α) on a uniform block; known dots give the axis."""
    write_results(tmp_path, changes={("ERZ-NS", "rigid"): {"theta_max_over_alpha": 0.1}})
    theta = 0.05
    write_verdicts(tmp_path, [drift(theta * PIER.alpha * 2.0 * PIER.height)])
    text = of_the_answer(write_report(tmp_path, []))
    limits = {float(x) for x in re.findall(r'<line x1="([\d.]+)%"[^>]*class="limit"', text)}
    (row,) = (strip for strip in re.findall(r"<svg.*?</svg>", text, re.DOTALL) if 'data-of="ERZ-NS"' in strip)
    dot = float(re.search(r'<line x1="([\d.]+)%"[^>]*class="rigid"', row)[1])
    (limit,) = limits
    assert limit == pytest.approx(1.5 + (dot - 1.5) * theta / 0.1, abs=0.2)
    assert f"limit of bearings, {theta * PIER.alpha * 2 * PIER.height:.4g} m (median) (rigid)" in Page(text).text


def test_a_limit_far_above_all_peaks_does_not_crowd_them(tmp_path):
    write_results(tmp_path)
    before = of_the_answer(write_report(tmp_path, []))
    write_verdicts(tmp_path, [drift(100.0)])
    after = of_the_answer(write_report(tmp_path, []))
    dots = [re.findall(r'<use [^>]*x="([\d.]+)%"', text) for text in (before, after)]
    assert dots[0] == dots[1] != []
    assert 0.0 < min(map(float, dots[0])) < 80.0 < max(map(float, dots[0])) < 97.0  # of the width, the axis ends at 97
    theta = 100.0 / (PIER.alpha * 2.0 * PIER.height)
    assert f"limit of bearings, 100 m (median) (rigid): beyond the axis, at θ/α = {theta:.3g}" in Page(after).text


def test_each_scale_has_its_own_limits_and_records_stand_by_the_worst_of_all(tmp_path):
    """ERZ-NS is the weaker of two as recorded and the stronger at twice that, where alone a limit is; a count has none."""
    changes = {(name, "rigid"): {"theta_max_over_alpha": theta} for name, theta in (("ERZ-NS", 0.1), ("SYL360", 0.2))}
    cases = [case_entry("rigid", {}, PIER, RigidBase())]
    write_results(tmp_path, records=[("ERZ-NS", 0.5), ("SYL360", 0.8)], cases=cases, scales=(1.0, 2.0), changes=changes)
    peaks = pd.read_csv(tmp_path / "peaks.csv", keep_default_na=False)
    worst = (peaks["record"] == "ERZ-NS") & (peaks["scale"] == 2.0)
    peaks.assign(theta_max_over_alpha=peaks["theta_max_over_alpha"].mask(worst, 0.4)).to_csv(
        tmp_path / "peaks.csv", index=False
    )
    drifts = [0.3 * PIER.alpha * 2.0 * PIER.height, 0.15 * PIER.alpha * 2.0 * PIER.height]
    judged = [replace(drift(drifts[0]), scale=2.0), replace(drift(drifts[1]), scale=2.0, statistic="count")]
    write_verdicts(tmp_path, judged)
    text = write_report(tmp_path, []).read_text(encoding="utf-8")
    assert [row.words.split()[0] for row in dot_rows(text)] == ["ERZ-NS", "SYL360"]
    own = of_the_answer(tmp_path / "report.html")
    strips = [
        re.findall(r"<svg.*?</svg>", row, re.DOTALL) for row in re.findall(r'<div class="row.*?</div>', own, re.DOTALL)
    ]
    assert [[strip.count('class="limit') for strip in row] for row in strips] == [[0, 1]] * 2


@pytest.mark.parametrize(("number", "single"), [(14, 14), (15, 13)])
def test_of_more_than_fourteen_records_the_worst_thirteen_have_a_row_each(tmp_path, number, single):
    records = [(f"R{i:02d}", 0.5) for i in range(number)]
    changes = {(name, "rigid"): {"theta_max_over_alpha": 0.5 - 0.01 * i} for i, (name, _) in enumerate(records)}
    write_results(tmp_path, records=records, cases=[case_entry("rigid", {}, PIER, RigidBase())], changes=changes)
    found = [
        row.words for row in dot_rows(write_report(tmp_path, []).read_text(encoding="utf-8")) if row.role != "folded"
    ]
    assert [words[:3] for words in found[:single]] == [f"R{i:02d}" for i in range(single)]
    assert found[single:] == ([f"the other {number - single} records"] if number > single else [])


def test_flights_in_the_picture_are_counted_with_the_highest_of_them(tmp_path):
    heights = {("ERZ-NS", "1"): 0.005, ("SYL360", "1"): 0.0123, ("SYL360", "2"): 0.001}
    write_results(tmp_path, changes={at: {"flight_s": 1.0, "flight_height_m": h} for at, h in heights.items()})
    said = Page(of_the_answer(write_report(tmp_path, []))).text
    assert "In 3 runs the pier left the ground altogether, by up to 12.3 mm; it was guided down." in said


@pytest.mark.parametrize(
    ("direction", "words", "end"),
    [("", "Kobe 1995, Port Island, bottom", ""), ("N, E", "Kobe 1995, Port Island", ", N, E"), ("up", "RRS228", "")],
)
def test_the_direction_alone_is_never_cut_off(tmp_path, direction, words, end):
    write_results(tmp_path, records=[("RRS228", 0.5)])
    info = json.loads((tmp_path / "run.json").read_text(encoding="utf-8"))
    info["records"][0] |= {"label": words + end, "direction": direction}
    (tmp_path / "run.json").write_text(json.dumps(info), encoding="utf-8")
    text = of_the_answer(write_report(tmp_path, []))
    (row,) = re.findall(r'<span class="words">([^<]*)</span>(?:<span class="end">([^<]*)</span>)?', text)
    assert tuple(part.replace("\u00a0", " ") for part in row) == (words, end)


def test_cases_that_differ_by_dampers_differ_in_mark_and_colour(tmp_path):
    """Check rigid ground, too, where the pier without dampers is the line to compare with."""
    names = ["bare", "steel", "oil"]
    cases = [case_entry(name, {}, PIER, RigidBase()) for name in names]
    for damped, kind in zip(cases[1:], ("hysteretic", "viscous"), strict=True):
        damped["parameters"]["restraints"] = [
            {"device": "damper", "kind": kind, "f": 0.02, "nu": 0.1, "yield_m": 0.005, "exponent": 1.0}
        ]
    write_results(tmp_path, cases=cases)
    legend = re.findall(r"<li[^>]*>(.*?)</li>", of_the_answer(write_report(tmp_path, [])).split('class="key">')[1])
    drawn = [re.search(r'class="(rigid|s\d)"', entry)[1] for entry in legend]
    shapes = [re.search(r"#m-(\w+)|<line", entry)[0] for entry in legend]
    assert len(set(drawn)) == len(set(shapes)) == 3
    assert (drawn[0], shapes[0]) == ("rigid", "<line")


@needs_chromium
def test_the_legend_stands_above_the_fold(tmp_path):
    write_results(tmp_path, changes={("ERZ-NS", "1"): {"flight_s": 3.0, "flight_height_m": 0.0021}})
    failing = [
        verdict(case, "fail", check=f"check {i}", value=0.6, ratio=1.2, record="ERZ-NS")
        for case in "123"
        for i in range(5)
    ]
    write_verdicts(
        tmp_path, [*failing, verdict("4", "not decided", remarks=("2 stations count", "the check asks for 3"))]
    )
    act = 'found.legend = document.querySelector("#answer ul.key").getBoundingClientRect().bottom;'
    assert 0 < browse(write_report(tmp_path, []), act, size=(1280, 800))["legend"] < 800


def test_the_picture_is_not_parted_from_its_axis_or_legend_on_paper():
    style = (Path(rockbatch.reporting.__file__).parent / "style.css").read_text(encoding="utf-8")
    printed = style[style.index("@media print") :]
    whole = next(line for line in printed.splitlines() if line.endswith("{ break-inside: avoid; }"))
    assert "figure:has(> .dots)" in whole
