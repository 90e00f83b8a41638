"""The page of a folder of records: sorted, searched, and words that stay words."""

import re

import numpy as np
import pytest
from browser import HOSTILE, browse, needs_chromium
from motion_files import wiggle, write_at2
from report_page import Page, figures

import rockbatch as rb
from rockbatch.commands.cli import main
from rockbatch.motions import LeftOut, MotionSet, Unusable
from rockbatch.motions.labels.origin import Origin
from rockbatch.motions.motion import Finding
from rockbatch.workflow.records import page, write_records


def motion(name, pga_g, **values):
    return rb.Motion(name, 0.01, 9.81 * pga_g * np.sin(np.arange(300) / 10.0), **values)


def test_a_page_has_a_trace_and_a_spectrum_of_each_record():
    text = page(MotionSet([motion("weak", 0.1), motion("strong", 0.5)]), "Records", "2 files")
    parsed = Page(text)
    assert parsed.mismatched == []
    head, *rows = parsed.tables["records"]
    assert [row[0] for row in rows] == ["strong", "weak"]
    assert [row[head.index("PGA [g]")] for row in rows] == ["0.500", "0.100"]
    assert [svg.attrib["aria-label"] for svg in figures(text)] == [
        f"{words} {name}{end}"
        for name, pga in (("strong", "0.5"), ("weak", "0.1"))
        for words, end in (("Acceleration of", f", {pga} g at most"), ("Response spectrum of", ""))
    ]


@pytest.mark.parametrize("count", [0, 1])
def test_a_folder_of_no_record_or_one_has_a_page(tmp_path, count):
    folder = tmp_path / "in"
    folder.mkdir()
    (folder / "readme.txt").write_text("Nothing here yet.\nand it was cold.\n")
    for i in range(count):
        write_at2(folder, "a.AT2", wiggle(300, i), title="Made-up, 1/17/1994, A, 000")
    assert main(["motions", str(folder), "--html", str(tmp_path / "p.html")]) == (0 if count else 1)
    parsed = Page((tmp_path / "p.html").read_text(encoding="utf-8"))
    assert len(parsed.tables.get("records", [[]])) == 1 + count
    assert ("No record was found." in parsed.text) == (count == 0)


def test_more_records_than_a_table_shows_are_counted():
    text = page(MotionSet([motion(f"m{i}", 0.1, findings=()) for i in range(3)]), "t", "a")
    assert "rows are shown" not in Page(text).text
    many = MotionSet([], [Unusable(f"u{i}", (f"u{i}.txt",), "cut") for i in range(1003)])
    assert "1,000 of 1,003 rows are shown" in Page(page(many, "t", "a")).text


@needs_chromium
def test_the_page_is_sorted_by_value_and_filtered_by_use(tmp_path):
    values = [0.2, 0.9, 0.05, 0.4, 0.1, 0.3, 0.7, 0.6, 0.15]
    held = [Unusable("h", ("h.txt",), "no unit", lacks=("unit",))]
    path = tmp_path / "p.html"
    write_records(path, MotionSet([motion(f"m{i}", pga) for i, pga in enumerate(values)], held), "Records", "ten")
    act = """
    const heads = [...document.querySelectorAll("#records thead button")];
    const column = heads.findIndex((head) => head.textContent.startsWith("PGA"));
    const rows = () => [...document.querySelectorAll("#records tbody tr")].filter((row) => !row.hidden);
    const values = () => rows().map((row) => row.cells[column].textContent);
    found.first = values();
    heads[column].click(); found.up = values();
    heads[column].click(); found.down = values();
    const use = document.querySelector("#records select");
    use.value = "held back"; use.dispatchEvent(new Event("input", { bubbles: true }));
    found.held = rows().map((row) => row.cells[0].textContent);
    """
    found = browse(path, act)
    strongest = [f"{pga:.3f}" for pga in sorted(values, reverse=True)]
    assert found["first"] == ["", *strongest]
    assert found["up"] == [*strongest[::-1], ""]
    assert found["down"] == [*strongest, ""]
    assert found["held"] == ["h"]
    assert (found["wrong"], found["requests"], found["wide"]) == ([], [], True)


@needs_chromium
@pytest.mark.parametrize("width", [1280, 390])
def test_hostile_names_are_words_on_the_page_of_records(tmp_path, width):
    motions = [
        motion(text[:200], 0.1, source=text, origin=Origin(text, text, text), findings=(Finding(text, text),))
        for text in HOSTILE
    ]
    unusable = [Unusable(text, (text,), text, lacks=(text,)) for text in HOSTILE]
    left_out = [LeftOut(text, (text,), text, of=text) for text in HOSTILE]
    path = tmp_path / "p.html"
    write_records(path, MotionSet(motions, unusable, left_out), HOSTILE[0], HOSTILE[1])
    act = """
    for (const name of ["alert", "confirm", "prompt", "open"]) window[name] = () => window.ran = name;
    for (const button of document.querySelectorAll("button, summary")) button.click();
    found.ran = window.ran ?? null;
    found.scripts = document.scripts.length;
    found.elements = document.querySelectorAll("img, iframe, base, link, form, [onerror], [onload], [onmouseover]").length;
    """
    own = {"ran": None, "scripts": 1, "elements": 0}
    assert browse(path, act, size=(width, 900)) == own | {"wrong": [], "requests": [], "wide": True}


@pytest.mark.slow
def test_a_page_of_many_records_stays_small():
    samples = np.random.default_rng(2).normal(size=20_000)
    text = page(MotionSet([rb.Motion(f"m{i}", 0.005, samples * (1 + i)) for i in range(4)]), "t", "a")
    empty = page(MotionSet(), "t", "a")
    assert (len(text) - len(empty)) / 4 < 8_000
    assert len(re.findall("<svg class=.plot", text)) == 8
