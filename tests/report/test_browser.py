"""The report in a real browser: nothing leaves the page, no script error, and sorting, searching and reading values work."""

import re

import pytest
from browser import browse, chromium, needs_chromium
from report_samples import FIG7, FOUNDATIONS, response, write_results

from rockbatch.reporting import write_comparison, write_report

pytestmark = needs_chromium


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    """Write a report with everything that has a tooltip."""
    directory = tmp_path_factory.mktemp("results")
    write_results(directory, changes={("RRS228", "2"): {"status": "overturned"}})
    return write_report(directory, [response("ERZ-NS", name, base) for name, base in FOUNDATIONS[1:3]])


@pytest.mark.parametrize("size", [(1200, 900), (500, 900)])
def test_nothing_is_asked_for_nothing_goes_wrong_and_nothing_sticks_out(tmp_path, page, size):
    found = browse(tmp_path, page, size=size)
    assert found == {"wrong": [], "requests": [], "wide": True}


def test_the_first_screen_holds_the_answer_and_the_figure_of_peaks(tmp_path, page):
    act = """
    const figure = document.querySelector("#answer .dots").getBoundingClientRect();
    found.answer = document.querySelector("#answer .facts").getBoundingClientRect().bottom;
    found.figure = figure.bottom;
    found.inputs = document.querySelector("#studied").getBoundingClientRect().top;
    """
    found = browse(tmp_path, page, act, size=(1400, 900))
    assert found["answer"] < found["figure"] < 900 < found["inputs"]


def test_the_policy_of_the_page_would_stop_a_request(tmp_path, page):
    # So that the test above can fail
    found = browse(tmp_path, page, 'document.body.append(Object.assign(new Image(), { src: "file:///x.png" }));')
    assert found["wrong"] or found["requests"]


def test_the_policy_of_the_page_lets_nothing_lead_its_links_or_forms_elsewhere(tmp_path, page):
    act = """
    document.head.append(Object.assign(document.createElement("base"), { href: "https://x.invalid/" }));
    found.base = document.baseURI.split(":")[0];
    """
    found = browse(tmp_path, page, act)
    assert (found["base"], found["wrong"]) == ("file", ["base-uri"])
    assert "; form-action 'none'" in page.read_text(encoding="utf-8").split("Content-Security-Policy")[1].split(">")[0]


def test_a_heading_sorts_by_value_both_ways_and_search_hides_the_rest(tmp_path, page):
    act = """
    const heads = [...document.querySelectorAll("#peaks thead button")];
    const column = heads.findIndex((head) => head.textContent === "θmax/α");
    const values = () => [...document.querySelectorAll("#peaks tbody tr")].map((row) => row.cells[column].textContent);
    heads[column].click(); found.up = values();
    heads[column].click(); found.down = values();
    const input = document.querySelector("#peaks input");
    input.value = "syl360 rigid"; input.dispatchEvent(new Event("input"));
    found.left = [...document.querySelectorAll("#peaks tbody tr")].filter((row) => !row.hidden).length;
    found.said = document.querySelector("#peaks .filter span").textContent;
    """
    found = browse(tmp_path, page, act)
    values = list(map(float, found["up"]))
    assert len(values) == 30
    assert values == sorted(values)
    assert list(map(float, found["down"])) == values[::-1]
    assert (found["left"], found["said"]) == (1, "1 of 30 rows")


def test_marks_of_the_first_screen_say_their_value_too(tmp_path, page):
    act = """
    const mark = document.querySelector("#answer .dots use.s3");
    at(mark, 0.5, 0.5); found.mark = tip();
    const rigid = document.querySelector("#answer .dots .rigid");
    at(rigid, 0.5, 0.5); found.rigid = tip();
    """
    found = browse(tmp_path, page, act)
    assert re.search(r"\n3: β = 80, η = 2.5: 0\.\d{4} ± 3e-06", found["mark"].replace("\u00a0", " "))
    assert re.search(r"\nrigid: 0\.\d{4} ± 3e-06", found["rigid"])


def test_a_table_is_copied_as_it_is_shown_and_its_file_is_linked(tmp_path, page):
    act = """
    const input = document.querySelector("#peaks input");
    input.value = "syl360 rigid"; input.dispatchEvent(new Event("input"));
    const copy = document.querySelector("#peaks .copy");
    copy.click(); found.text = copy.dataset.text;
    found.link = document.querySelector("#peaks a").getAttribute("href");
    """
    found = browse(tmp_path, page, act)
    head, row = (line.split("\t") for line in found["text"].split("\n"))
    assert head[:2] == ["record", "case"]
    assert row[:2] == ["SYL360", "rigid"]
    assert len(head) == len(row)
    assert found["link"] == "peaks.csv"


def test_markers_say_their_value_to_the_pointer_and_to_the_arrow_keys(tmp_path, page):
    act = """
    const mark = document.querySelector(".panels use.s3");
    at(mark, 0.5, 0.5); found.pointed = tip();
    const grid = document.querySelector(".panels");
    press(grid, "ArrowRight"); found.first = tip();
    press(grid, "ArrowRight"); found.second = tip();
    press(document.body, "Escape"); found.none = tip();
    """
    found = browse(tmp_path, page, act)
    assert re.fullmatch(r"3: β = 80, η = 2.5: 0\.\d{4} ± 3e-06", found["pointed"].replace("\u00a0", " "))
    assert found["first"].replace("\u00a0", " ").startswith(f"{FIG7[0][0]} PGA = 0.515 g\nrigid: 0.")
    assert "\n1: β" in found["second"]
    assert found["none"] is None


def test_a_touch_reads_values_off_the_curves_and_they_stay_until_the_next_touch(tmp_path, page):
    act = """
    const svg = document.querySelector("svg.readings");
    const box = svg.querySelector("g.axes").dataset.box.split(" ").map(Number);
    const view = svg.viewBox.baseVal;
    // Half a second into a history of eight, where the ground still accelerates
    const fx = (box[0] + box[2] * 0.375 / 8) / view.width, fy = (box[1] + box[3] / 2) / view.height;
    at(svg, fx, fy, "pointerdown", "touch"); at(svg, fx, fy, "pointerleave", "touch"); found.read = tip();
    found.cursors = svg.querySelectorAll(".cursor").length;
    press(svg, "ArrowRight"); found.next = tip();
    document.body.dispatchEvent(new PointerEvent("pointerdown", { bubbles: true, pointerType: "touch" }));
    found.none = tip();
    """
    found = browse(tmp_path, page, act)
    lines = dict(line.split(" = ") for line in found["read"].split("\n"))
    assert list(lines) == ["t", "θ/α", "θ̇/(αp)", "E/M [J/kg]", "üg/g"]
    assert float(lines["t"].removesuffix(" s")) == pytest.approx(0.375, abs=0.01)
    assert float(lines["üg/g"]) == pytest.approx(-1.0, abs=0.03)  # sin(4π·0.375): the trough, as wide as a pixel
    assert found["cursors"] == 4
    assert float(found["next"].split()[2]) > float(found["read"].split()[2])
    assert found["none"] is None


def test_loops_give_force_and_deflection(tmp_path, page):
    act = """
    const group = document.querySelector("g.axes[data-kind=plane]");
    at(group, 0.5, 0.5); found.read = tip();
    """
    found = browse(tmp_path, page, act)
    assert re.fullmatch(r"v/δy = -?\d+\.\d+\nF/Fy = -?\d\.\d+", found["read"])


def test_a_comparison_works_in_the_browser_too(tmp_path):
    for name in ("a", "b"):
        (tmp_path / name).mkdir()
        write_results(tmp_path / name)
    found = browse(tmp_path, write_comparison(tmp_path / "a", tmp_path / "b"))
    assert found == {"wrong": [], "requests": [], "wide": True}


def test_it_prints(tmp_path, page):
    chromium(tmp_path, f"--print-to-pdf={tmp_path / 'report.pdf'}", "--no-pdf-header-footer", page.as_uri())
    printed = (tmp_path / "report.pdf").read_bytes()
    boxes = re.findall(rb"/MediaBox \[0 0 ([\d.]+) ([\d.]+)\]", printed)
    assert {float(width) > float(height) for width, height in boxes} == {False}  # wide tables go on below
