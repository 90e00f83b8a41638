"""The report in a real browser: nothing leaves the page, no script error, and sorting, searching and reading values work."""

import io
import json
import math
import re
from dataclasses import replace

import pandas as pd
import pypdf
import pytest
from browser import HOSTILE, browse, needs_chromium, printed, tab
from check_samples import verdict
from report_samples import FIG7, FOUNDATIONS, case_entry, response, write_results

import rockbatch as rb
from rockbatch.checks import write_verdicts
from rockbatch.pier import Pier
from rockbatch.reporting import write_report

pytestmark = needs_chromium


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    """Write a report with everything that has a tooltip."""
    directory = tmp_path_factory.mktemp("results")
    write_results(directory, changes={("RRS228", "2"): {"status": "overturned"}})
    return write_report(directory, [response("ERZ-NS", name, base) for name, base in FOUNDATIONS[1:3]])


@pytest.mark.parametrize("width", [1200, 390])
def test_names_and_notes_of_a_hostile_folder_are_words_and_stay_on_the_page(tmp_path, width):
    """As elements and as tooltips, and after whatever can be clicked was."""
    cases = [
        case_entry(name, {}, Pier(alpha=0.13, p=0.38), base)
        for name, (_, base) in zip(HOSTILE[-9:-4], FOUNDATIONS, strict=True)
    ]
    write_results(
        tmp_path,
        records=[(name, 0.3) for name in HOSTILE],
        cases=cases,
        unusable=[{"name": text, "source": text, "reason": text} for text in HOSTILE],
        command=["rockbatch", "run", *HOSTILE],
        machine=HOSTILE[0],
    )
    info = json.loads((tmp_path / "run.json").read_text(encoding="utf-8"))
    info["study"] |= {"title": "".join(HOSTILE), "notes": "\n\n".join(HOSTILE), "path": HOSTILE[1], "text": HOSTILE[2]}
    for record, text in zip(info["records"], HOSTILE, strict=True):
        record |= {"source": text, "notes": [text], "event": text, "station_name": text}
    (tmp_path / "run.json").write_text(json.dumps(info), encoding="utf-8")
    act = """
    for (const name of ["alert", "confirm", "prompt", "open"]) window[name] = () => window.ran = name;
    for (const button of document.querySelectorAll("button, summary")) button.click();
    for (const mark of [...document.querySelectorAll(".dots use, .dots .rigid")].slice(0, 60)) at(mark, 0.5, 0.5);
    found.ran = window.ran ?? null;
    found.scripts = document.scripts.length;
    found.elements = document.querySelectorAll("img, iframe, base, link, form, [onerror], [onload], [onmouseover]").length;
    """
    found = browse(write_report(tmp_path, []), act, size=(width, 900))
    own = {"ran": None, "scripts": 1, "elements": 0}
    assert found == own | {"wrong": [], "requests": [], "wide": True}


@pytest.mark.parametrize("size", [(1200, 900), (500, 900)])
def test_nothing_is_asked_for_nothing_goes_wrong_and_nothing_sticks_out(page, size):
    found = browse(page, size=size)
    assert found == {"wrong": [], "requests": [], "wide": True}


def test_the_first_screen_holds_the_answer_and_the_figure_of_peaks(page):
    act = """
    const figure = document.querySelector("#answer .dots").getBoundingClientRect();
    found.answer = document.querySelector("#answer table").getBoundingClientRect().bottom;
    found.figure = figure.bottom;
    found.inputs = document.querySelector("#studied").getBoundingClientRect().top;
    """
    found = browse(page, act, size=(1400, 900))
    assert found["answer"] < found["figure"] < 900 < found["inputs"]


def test_the_policy_of_the_page_would_stop_a_request(page):
    # So that the test above can fail
    found = browse(page, 'document.body.append(Object.assign(new Image(), { src: "file:///x.png" }));')
    assert found["wrong"] or found["requests"]


def test_the_policy_of_the_page_lets_nothing_lead_its_links_or_forms_elsewhere(page):
    act = """
    document.head.append(Object.assign(document.createElement("base"), { href: "https://x.invalid/" }));
    found.base = document.baseURI.split(":")[0];
    """
    found = browse(page, act)
    assert (found["base"], found["wrong"]) == ("file", ["base-uri"])
    assert "; form-action 'none'" in page.read_text(encoding="utf-8").split("Content-Security-Policy")[1].split(">")[0]


def test_a_heading_sorts_by_value_both_ways_and_search_hides_the_rest(page):
    act = """
    const heads = [...document.querySelectorAll("#peaks thead button")];
    const column = heads.findIndex((head) => head.textContent === "θmax/α");
    const values = () => [...document.querySelectorAll("#peaks tbody tr")].map((row) => row.cells[column].textContent);
    heads[column].click(); found.up = values();
    heads[column].click(); found.down = values();
    const input = document.querySelector("#peaks input");
    input.value = "syl360 rigid"; input.dispatchEvent(new Event("input", { bubbles: true }));
    found.left = [...document.querySelectorAll("#peaks tbody tr")].filter((row) => !row.hidden).length;
    found.said = document.querySelector("#peaks .filter span").textContent;
    """
    found = browse(page, act)
    values = list(map(float, found["up"]))
    assert len(values) == 30
    assert values == sorted(values)
    assert list(map(float, found["down"])) == values[::-1]
    assert (found["left"], found["said"]) == (1, "1 of 30 rows")


def test_marks_of_the_first_screen_say_their_value_too(page):
    act = """
    const mark = document.querySelector("#answer .dots use.s3");
    at(mark, 0.5, 0.5); found.mark = tip();
    const rigid = document.querySelector("#answer .dots .rigid");
    at(rigid, 0.5, 0.5); found.rigid = tip();
    """
    found = browse(page, act)
    assert re.search(r"\n3: β = 80, η = 2.5: 0\.\d{4} ± 3e-06", found["mark"].replace("\u00a0", " "))
    assert re.search(r"\nrigid: 0\.\d{4} ± 3e-06", found["rigid"])


def test_a_table_is_copied_as_it_is_shown_and_its_file_is_linked(page):
    act = """
    const input = document.querySelector("#peaks input");
    input.value = "syl360 rigid"; input.dispatchEvent(new Event("input", { bubbles: true }));
    const copy = document.querySelector("#peaks .copy");
    copy.click(); found.text = copy.dataset.text;
    found.link = document.querySelector("#peaks a").getAttribute("href");
    """
    found = browse(page, act)
    head, row = (line.split("\t") for line in found["text"].split("\n"))
    assert head[:2] == ["record", "case"]
    assert row[:2] == ["SYL360", "rigid"]
    assert len(head) == len(row)
    assert found["link"] == "peaks.csv"


def test_marks_say_their_value_to_the_arrow_keys_and_none_after_escape(page):
    act = """
    const grid = document.querySelector(".dots");
    press(grid, "ArrowRight"); found.first = tip();
    press(grid, "ArrowRight"); found.second = tip();
    press(document.body, "Escape"); found.none = tip();
    """
    found = browse(page, act)
    assert re.match(r"\w+\n.*: 0\.\d{4} ± 3e-06", found["first"].replace("\u00a0", " "), re.DOTALL)
    assert found["first"] != found["second"]
    assert found["none"] is None


def test_entries_of_the_legend_hide_their_marks_and_rows_are_sorted_and_searched(page):
    act = """
    const grid = document.querySelector("#answer .dots");
    const marks = (place) => [...grid.querySelectorAll(`[data-case="${place}"]`)];
    const drawn = (place) => marks(place).filter((mark) => mark.getBoundingClientRect().width > 0).length;
    found.before = [...grid.querySelectorAll(".row .of")].map((node) => node.textContent);
    found.marks = drawn(2);
    const entry = document.querySelector('#answer .key [data-value="2"]');
    entry.click(); found.hidden = drawn(2); found.others = drawn(1); found.pressed = entry.getAttribute("aria-pressed");
    entry.click(); found.again = drawn(2);
    """
    found = browse(page, act)
    assert (found["marks"], found["hidden"], found["others"], found["again"]) == (5, 0, 6, 5)  # one overturned
    assert found["pressed"] == "false"
    assert sorted(found["before"]) == sorted(name for name, _ in FIG7)


def test_many_records_are_sorted_searched_and_all_shown_on_request(tmp_path):
    write_results(tmp_path, records=[(f"R{i}", 0.5 - 0.01 * i) for i in range(30)])
    act = """
    const grid = document.querySelector("#answer .dots");
    const seen = () => [...grid.querySelectorAll(".row")].filter((row) => getComputedStyle(row).display !== "none");
    const words = () => seen().map((row) => row.querySelector(".of").textContent);
    found.first = words();
    document.querySelector("#answer .filter button").click(); found.all = words();
    const order = document.querySelector("#answer .filter select");
    order.value = "pga"; order.dispatchEvent(new Event("change")); found.sorted = words();
    const input = document.querySelector("#answer .filter input");
    input.value = "r2"; input.dispatchEvent(new Event("input")); found.searched = words();
    """
    found = browse(write_report(tmp_path, []), act)
    assert found["first"][-1] == "the other 17 records"
    assert len(found["first"]) == 14
    assert found["sorted"] == [f"R{i}" for i in range(30)]
    assert sorted(found["all"]) == sorted(found["sorted"])
    assert found["searched"] == ["R2", *(f"R{i}" for i in range(20, 30))]


def test_what_is_folded_is_unfolded_by_a_link_and_the_list_stays_in_view(page):
    act = """
    const fold = document.querySelector("#statics > details");
    found.before = fold.open;
    document.querySelector('nav a[href="#statics"]').click();
    await later();
    found.after = fold.open;
    found.nav = document.querySelector("nav").getBoundingClientRect().top;
    """
    found = browse(page, act)
    assert (found["before"], found["after"], found["nav"]) == (False, True, 0)


def test_a_table_is_filtered_by_case_and_status(page):
    act = """
    const [kind, status] = document.querySelectorAll("#peaks .filter select");
    const rows = () => [...document.querySelectorAll("#peaks tbody tr")].filter((row) => !row.hidden).length;
    found.all = rows();
    kind.value = "2"; kind.dispatchEvent(new Event("input", { bubbles: true })); found.of_case = rows();
    status.value = "overturned"; status.dispatchEvent(new Event("input", { bubbles: true })); found.of_both = rows();
    """
    found = browse(page, act)
    assert (found["all"], found["of_case"], found["of_both"]) == (30, 6, 1)


def test_a_scorecard_of_many_cases_is_unfolded_on_request(tmp_path):
    write_results(tmp_path)
    write_verdicts(tmp_path, [verdict(f"c{i}", "fail", ratio=1.0 + i / 10) for i in range(30)])
    act = """
    const rows = () => [...document.querySelectorAll(".card tbody tr")].filter((row) => row.getClientRects().length).length;
    found.first = rows();
    document.querySelector("#answer .legend.rest button").click();
    found.all = rows();
    """
    found = browse(write_report(tmp_path, []), act)
    assert (found["first"], found["all"]) == (6, 35)


def test_a_scorecard_of_seven_open_checks_is_no_wider_than_the_page(tmp_path):
    write_results(tmp_path)
    numbers = {"value": 123_456.0, "limit": 60_000.0, "ratio": 2.0576, "unit": "kN m", "high": math.inf}
    write_verdicts(
        tmp_path, [verdict(f"c{i}", "not decided", check=f"check {k}", **numbers) for i in range(3) for k in range(7)]
    )
    act = """
    const table = document.querySelector("#answer .card");
    found.cells = table.querySelectorAll("thead th").length;
    found.over = table.scrollWidth - table.parentElement.clientWidth;
    """
    found = browse(write_report(tmp_path, []), act)
    assert found["cells"] == 8
    assert found["over"] <= 8  # the margins that the spacing of the cells is drawn back by


def test_a_touch_reads_values_off_the_curves_and_they_stay_until_the_next_touch(page):
    act = """
    const svg = document.querySelector("svg.readings");
    const panel = svg.querySelector("svg:last-of-type"), axes = panel.querySelector("g.axes");
    const [left, , width] = axes.dataset.box.split(" ").map(Number), [t0, t1] = axes.dataset.x.split(" ").map(Number);
    const view = panel.viewBox.baseVal;
    // Half a second into a history of eight, where the ground still accelerates
    const fx = (left + width * (0.375 - t0) / (t1 - t0) - view.x) / view.width;
    at(panel, fx, 0.5, "pointerdown", "touch"); at(panel, fx, 0.5, "pointerleave", "touch"); found.read = tip();
    found.cursors = svg.querySelectorAll(".cursor").length;
    press(svg, "ArrowRight"); found.next = tip();
    document.body.dispatchEvent(new PointerEvent("pointerdown", { bubbles: true, pointerType: "touch" }));
    found.none = tip();
    """
    found = browse(page, act)
    lines = dict(line.split(" = ") for line in found["read"].split("\n"))
    assert list(lines) == ["t", "θ/α 1", "θ/α 2", "θ̇/(αp) 1", "θ̇/(αp) 2", "üg/g"]
    assert float(lines["t"].removesuffix(" s")) == pytest.approx(0.375, abs=0.01)
    assert float(lines["üg/g"]) == pytest.approx(-1.0, abs=0.03)  # sin(4π·0.375): the trough, as wide as a pixel
    assert found["cursors"] == 3
    assert float(found["next"].split()[2]) > float(found["read"].split()[2])
    assert found["none"] is None


def test_loops_give_force_and_deflection_to_the_pointer_and_to_the_arrow_keys(page):
    act = """
    const svg = document.querySelector("svg.readings:has(g.axes[data-kind=plane])");
    at(svg.querySelector("g.axes"), 0.5, 0.5); found.pointed = tip();
    press(svg, "ArrowRight"); found.first = tip();
    press(svg, "ArrowRight"); found.second = tip();
    """
    found = browse(page, act)
    assert all(
        re.fullmatch(r"v/δy = -?\d+\.\d+\nF/Fy = -?\d\.\d+", found[name]) for name in ("pointed", "first", "second")
    )
    assert found["first"] != found["second"]
    assert found["wrong"] == []


def test_one_motion_is_shown_at_a_time_and_a_record_is_whole_on_request(tmp_path):
    write_results(tmp_path)
    still = [replace(each, history=with_rest(each.history)) for each in (response("SYL360", "1", FOUNDATIONS[1][1]),)]
    page = write_report(tmp_path, [response("ERZ-NS", *FOUNDATIONS[1]), *still])
    act = """
    const figures = [...document.querySelectorAll(".histories > figure")];
    const select = document.querySelector(".choice select"), box = document.querySelector(".choice input");
    const shown = () => figures.filter((figure) => figure.getBoundingClientRect().height > 0).length;
    found.options = [...select.options].map((option) => option.textContent);
    found.before = shown();
    select.selectedIndex = found.options.findIndex((words) => words.includes("SYL360"));
    select.dispatchEvent(new Event("change"));
    found.after = shown();
    const chosen = document.querySelector(".histories > figure.chosen");
    const last = () => {
      const svg = chosen.querySelector("svg.readings");
      at(svg, 49 / svg.getBoundingClientRect().width, 0.2);
      const numbers = [...svg.querySelectorAll("text.m")].filter((node) => node.getBoundingClientRect().width > 0);
      return [tip().split("\\n")[0], numbers.map((node) => node.textContent).slice(-2, -1)[0]];
    };
    found.cut = last();
    box.click();
    found.whole = last();
    """
    found = browse(page, act)
    assert len(found["options"]) == 2
    assert (found["before"], found["after"]) == (1, 1)
    begins = [float(found[name][0].split()[2]) for name in ("cut", "whole")]
    assert begins[0] > 15.0
    assert begins[1] < 0.5
    assert [float(found[name][1]) for name in ("cut", "whole")] == [28.0, 60.0]


def with_rest(history):
    """Return a history with 20 s of rest before it, and 40 s after."""
    rest = history.iloc[[0]].assign(theta=0.0, omega=0.0, ag_h=0.0)
    moved = history.assign(t=history["t"] + 20.0)
    return pd.concat([rest, rest.assign(t=19.99), moved, rest.assign(t=28.01), rest.assign(t=68.0)], ignore_index=True)


def test_a_comparison_works_in_the_browser_too(tmp_path):
    for name in ("a", "b"):
        (tmp_path / name).mkdir()
        write_results(tmp_path / name)
    found = browse(rb.report(tmp_path / "a", tmp_path / "b").path)
    assert found == {"wrong": [], "requests": [], "wide": True}


def test_it_prints(page):
    boxes = re.findall(rb"/MediaBox \[0 0 ([\d.]+) ([\d.]+)\]", printed(page))
    assert boxes
    assert {float(width) > float(height) for width, height in boxes} == {False}  # wide tables go on below


def test_the_head_of_a_long_table_is_printed_on_each_of_its_pages(tmp_path):
    """Heads are buttons, which Chromium draws on the first page alone."""
    write_results(tmp_path, records=[(f"R{i:03}", 0.5) for i in range(12)])
    pages = [sheet.extract_text() for sheet in pypdf.PdfReader(io.BytesIO(printed(write_report(tmp_path, [])))).pages]
    of_runs = [text for text in pages if re.search(r"R\d{3} \d \d\.\d", text.replace("\n", " "))]
    assert len(of_runs) > 1
    assert all("ductility L" in text for text in of_runs)


def test_the_table_of_ground_motions_is_printed_as_wide_as_the_paper(tmp_path):
    """A record is named by event, station and direction, which did not wrap, beside its name in peaks.csv."""
    write_results(tmp_path, records=[(f"20160214_001345_{i:06}_20.N90W", 0.5) for i in range(9)])
    info = json.loads((tmp_path / "run.json").read_text(encoding="utf-8"))
    for i, record in enumerate(info["records"]):
        record |= {"label": f"Imperial Valley 1979, El Centro - Meloland Overpass, N{i}W", "station": f"MEL{i}"}
        record |= {"event": f"Imperial Valley 197{i}", "station_name": f"El Centro - Meloland Overpass {i}"}
        record |= {name: 0.1 + i for name in ("pgv_m_s", "pgd_m", "pga_v_g", "arias_m_s", "d5_95_s")}
    (tmp_path / "run.json").write_text(json.dumps(info), encoding="utf-8")
    wide = """(({scrollWidth, clientWidth}) => scrollWidth - clientWidth)(document.querySelector("#records .wide"))"""
    with tab(write_report(tmp_path, []), (688, 1000)) as ask:  # A4 less its margins
        ask("Emulation.setEmulatedMedia", media="print")
        assert ask("Runtime.evaluate", expression=wide, returnByValue=True)["result"]["value"] == 0


def test_words_of_a_printed_scorecard_of_seven_checks_are_whole(tmp_path):
    write_results(tmp_path)
    names = ["overturning margin", "settlement of the toe", "flight within the keys", *(f"check {i}" for i in range(4))]
    verdicts = [verdict("c", "fail", check=name) for name in names]
    write_verdicts(tmp_path, [*verdicts, *(verdict("c", "pass", check=f"more {i}") for i in range(2))])
    lines = """(() => {
      const head = [...document.querySelectorAll("#answer .card th")].find((th) => th.textContent.startsWith("overturning"));
      const word = document.createRange();
      word.setStart(head.firstChild, 0); word.setEnd(head.firstChild, "overturning".length);
      return new Set([...word.getClientRects()].map((box) => box.top)).size;
    })()"""
    with tab(write_report(tmp_path, []), (688, 1000)) as ask:  # A4 less its margins
        ask("Emulation.setEmulatedMedia", media="print")
        assert ask("Runtime.evaluate", expression=lines, returnByValue=True)["result"]["value"] == 1


def test_on_paper_stands_the_motion_that_is_shown_and_every_one_if_all_is_asked_for(tmp_path):
    write_results(tmp_path)
    page = write_report(
        tmp_path, [response(record, *FOUNDATIONS[1]) for record in ("ERZ-NS", "RRS228", "SYL360", "CPM000")]
    )
    sheets = []
    for words in ('<html lang="en">', '<html lang="en" class="whole">'):
        page.write_text(page.read_text(encoding="utf-8").replace('<html lang="en">', words), encoding="utf-8")
        sheets.append(printed(page).count(b"/MediaBox"))
    assert sheets[1] >= sheets[0] + 1


def test_value_and_share_of_seven_checks_stand_in_one_line_at_1280_px(tmp_path):
    write_results(tmp_path)
    values = [(0.692, 0.77), (0.0909, 0.02), (19.2, 2.4), (0.389, 0.43), (1060.0, 0.53), (273.0, 5.46), (2.04, 0.98)]
    numbers = [{"value": value, "limit": value / ratio, "ratio": ratio, "unit": "t"} for value, ratio in values]
    write_verdicts(
        tmp_path, [verdict("c", "not decided", check=f"foot of the shaft {k}", **of) for k, of in enumerate(numbers)]
    )
    act = """
    found.apart = [...document.querySelectorAll("#answer .card .top")].map((top) => {
      const [value, share] = [...top.children].map((node) => node.getBoundingClientRect());
      return share.top < value.bottom && share.left >= value.right;
    });
    """
    assert browse(write_report(tmp_path, []), act, size=(1280, 900))["apart"] == 7 * [True]
