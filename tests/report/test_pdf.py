"""The calculation sheet as PDF says what the HTML says, on pages of the size that is asked for."""

import io
import re
import tempfile
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pypdf
import pytest
import typst
from browser import HOSTILE
from PIL import Image
from report_page import Page
from report_samples import case_entry, write_results

import rockbatch as rb
from rockbatch.commands.cli import main
from rockbatch.common.errors import InputError
from rockbatch.pier import Pier, RigidBase
from rockbatch.reporting import pdf, typeset
from rockbatch.reporting.finished import read
from rockbatch.reporting.sheet import sheet_of
from rockbatch.reporting.typeset import Setting, blocks, parsed

COMMANDS = [
    "]#panic[",
    '#read("/etc/hostname")',
    "$a_b$ *c* _d_ `e` @f <g>",
    "// h \\",
    "#let i = 1",
    '"; j',
    *HOSTILE[:5],
]
"""Names, some of which would be commands of Typst if they were no words."""


def without_spaces(text):
    """Return a text without what a line break of a page may change."""
    return re.sub(r"[\s\u00ad\u200b-\u2069\ufe0e]", "", text)


def text_of(made):
    """Return the text of each page of a PDF."""
    return [page.extract_text() for page in pypdf.PdfReader(io.BytesIO(made)).pages]


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Write the results of a study with devices, forces, histories and a check."""
    folder = tmp_path_factory.mktemp("results")
    pulse = {"name": "sine", "shape": "sine", "amplitude_g": 0.4, "period_s": 0.8, "dt_s": 0.01, "duration_s": 3.0}
    cases = [
        {"name": "rock", "base": "rigid", "damper": [{"kind": "friction", "force_kN": 300.0}]},
        {"name": "bare", "base": "rigid"},
    ]
    tables = {
        "pier": {"width_m": 4.0, "height_m": 20.0, "mass_t": 900.0},
        "motions": {"pulse": [pulse]},
        "case": cases,
        "output": {"forces": True, "histories": "all"},
        "check": [{"name": "tilt", "demand": "theta_max_rad", "at_most": 0.05, "reason": "made up"}],
    }
    rb.run(rb.Study.from_dict(tables), out=folder, jobs=1, progress=False)
    return folder


@pytest.fixture(scope="module")
def sheet(folder):
    """Read the sheet of the folder."""
    return sheet_of(read(folder))


@pytest.fixture(scope="module")
def pages(sheet):
    """Return the text of each page of the sheet's PDF."""
    return text_of(sheet.pdf())


def test_every_cell_of_every_table_stands_in_the_pdf(sheet, pages):
    whole = without_spaces("".join(pages))
    html = Page(sheet.html())
    cells = {cell for rows in html.tables.values() for row in rows for cell in row if cell}
    assert len(cells) > 100
    assert not {cell for cell in cells if without_spaces(cell) not in whole and not _is_dotted(cell)}


def _is_dotted(cell):
    """Return whether a cell has an accent, which a PDF holds as a letter and a mark of its own."""
    return bool(re.search("[\u0307\u0308]", cell))


def test_every_section_has_its_heading_in_the_order_of_the_html(sheet, pages):
    whole = without_spaces("".join(pages))
    assert len(sheet.sections) > 8
    at = 0
    for place, section in enumerate(sheet.sections, start=1):
        at = whole.find(
            f"{place}{without_spaces(section.heading)}", at
        )  # behind the last, since tables have such words, too
        assert at >= 0, section.heading


def test_each_page_has_study_version_date_and_its_number(sheet, pages):
    for place, page in enumerate(pages, start=1):
        assert f"page {place} of {len(pages)}" in page
        assert f"{sheet.title}: calculation sheet" in page
        assert sheet.version in page
        assert sheet.path in page
    assert re.search(r"rockbatch \d.*, \d{4}-\d\d-\d\d$", sheet.version)


@pytest.mark.parametrize(("paper", "size"), [("A4", (595, 842)), ("Letter", (612, 792))])
def test_pages_have_the_size_of_the_paper(sheet, paper, size):
    box = pypdf.PdfReader(io.BytesIO(sheet.pdf(paper))).pages[0].mediabox
    assert (round(box.width), round(box.height)) == size


def test_each_picture_that_the_html_shows_stands_in_the_pdf_in_light_colours(sheet):
    for section in sheet.sections:
        setting, content = Setting({}), parsed(section.content)
        blocks(content, setting)
        hidden = [svg for later in content.iterfind(".//*[@class='histories']/figure") for svg in later.iter("svg")]
        shown = {id(svg) for svg in content.iter("svg")} - {id(svg) for svg in hidden}
        assert len(setting.pictures) >= len(shown) - len([svg for svg in content.iter("svg") if svg.find("svg")])
        for picture in setting.pictures.values():
            text = picture.decode()
            ElementTree.fromstring(text)
            assert "var(" not in text
            used = set(re.findall(r'href="#([\w-]+)"', text))
            assert used <= set(re.findall(r'id="([\w-]+)"', text))


def test_pictures_have_the_colours_of_the_report(sheet):
    """Each rule of the style sheet for the marks of pictures holds in them; none of it is lost on the way."""
    css = (Path(typeset.__file__).parent / "style.css").read_text(encoding="utf-8")
    wanted = set(re.findall(r"^(\.plot [^:{]*?) *\{", css, re.MULTILINE)) - {".plot text[class^=s]"}
    kept = typeset._style_of_pictures()
    assert len(wanted) > 30
    assert not {rule for rule in wanted if f"{rule} {{" not in kept}
    assert ".s2 { color: #b4470c; }" in kept


def test_an_empty_part_of_a_style_is_no_declaration():
    of_one, without = parsed('<p style="width: 3px;">a</p><p>b</p>')
    assert typeset._style(of_one) == {"width": "3px"}
    assert typeset._style(without) == {}


def test_names_that_are_commands_of_typst_are_words(tmp_path):
    names = [(name, 0.4) for name in COMMANDS]
    cases = [case_entry(name, {}, Pier(alpha=0.13, p=0.38), RigidBase()) for name in COMMANDS[:3]]
    study = {"path": COMMANDS[1], "title": COMMANDS[0], "notes": COMMANDS[2], "text": COMMANDS[3], "sha256": "0"}
    write_results(tmp_path, records=names, cases=cases, study=study, created=COMMANDS[1])
    whole = without_spaces("".join(text_of(sheet_of(read(tmp_path)).pdf())))
    assert not [name for name in COMMANDS[:6] if without_spaces(name) not in whole]


def test_all_that_is_hostile_on_a_page_is_words_in_the_pdf_which_does_nothing(tmp_path):
    """Letters of every writing in the PDF's fonts, marks of direction and names of 3,000 letters among them."""
    cases = [case_entry(name, {}, Pier(alpha=0.13, p=0.38), RigidBase()) for name in HOSTILE[5:8]]
    unusable = [{"name": name, "source": name, "reason": name} for name in HOSTILE]
    write_results(
        tmp_path, records=[(name, 0.4) for name in HOSTILE], cases=cases, unusable=unusable, created=HOSTILE[0]
    )
    pdf_ = sheet_of(read(tmp_path)).pdf()
    whole = without_spaces("".join(text_of(pdf_)))
    hidden = [name for name in HOSTILE if without_spaces(name) not in whole]
    assert [ascii(name) for name in hidden if name.isascii()] == []
    reader = pypdf.PdfReader(io.BytesIO(pdf_))
    actions = {"/OpenAction", "/AA", "/AcroForm"}
    assert not actions & {key for part in (reader.trailer["/Root"], *reader.pages) for key in part}
    assert [note for page in reader.pages for note in page.get("/Annots", ())] == []


def test_a_sheet_is_written_as_html_and_pdf_and_the_command_names_both(tmp_path, capsys):
    write_results(tmp_path)
    assert main(["report", "--sheet", str(tmp_path)]) == 0
    assert capsys.readouterr().err.split() == [str(tmp_path / "sheet.html"), str(tmp_path / "sheet.pdf")]
    assert (tmp_path / "sheet.pdf").read_bytes().startswith(b"%PDF")


def test_a_name_that_ends_in_pdf_asks_for_the_pdf_alone(tmp_path):
    write_results(tmp_path)
    out = tmp_path / "Pier 4.PDF"
    written = rb.report(tmp_path, sheet=True, out=out, paper="Letter")
    assert (written.path, written.pdf) == (out, out)
    box = pypdf.PdfReader(written.save(tmp_path / "mail")).pages[0].mediabox
    assert round(box.width) == 612
    assert not (tmp_path / "sheet.html").exists()


def test_without_typst_the_html_is_written_and_a_pdf_is_refused_with_the_remedy(tmp_path, monkeypatch, capsys):
    write_results(tmp_path)
    monkeypatch.setattr("rockbatch.reporting.installed", lambda: False)
    monkeypatch.setattr(pdf, "installed", lambda: False)
    written = rb.report(tmp_path, sheet=True)
    assert (written.path.name, written.pdf, (tmp_path / "sheet.pdf").exists()) == ("sheet.html", None, False)
    with pytest.raises(InputError, match=r'pip install "rockbatch\[pdf\]"'):
        rb.report(tmp_path, sheet=True, out=tmp_path / "sheet.pdf")
    for options, told in ((("--sheet",), True), (("--sheet", "--out", str(tmp_path / "a.html")), False), ((), False)):
        assert main(["report", str(tmp_path), *options]) == 0
        assert ('pip install "rockbatch[pdf]"' in capsys.readouterr().err) == told


def test_a_page_on_standard_output_stands_there_alone(tmp_path, capfd):
    write_results(tmp_path)
    assert main(["report", "--sheet", str(tmp_path), "--out", "-"]) == 0
    said = capfd.readouterr()
    assert said.out.rstrip().endswith("</html>")
    assert said.err == ""


def test_an_element_that_is_not_set_yet_is_refused_by_name():
    for html, name in (("<blockquote>said</blockquote>", "blockquote"), ("<p>some <del>text</del></p>", "del")):
        with pytest.raises(ValueError, match=f"<{name}>"):
            blocks(parsed(html), Setting({}))


def test_text_before_between_and_after_blocks_is_set_in_its_order():
    html = "before<ul><li>item<p>within</p>later</li></ul>between<div>part</div><strong>a</strong>fter<br></br>end"
    set_ = re.sub(r"#\w+|[\[\]()\\\n]", " ", blocks(parsed(html), Setting({})))
    assert set_.split() == ["before", "item", "within", "later", "between", "part", "a", "fter", "end"]


def test_the_number_of_a_part_of_a_table_stays_with_it():
    numbered, other = (blocks(parsed(f'<p class="legend{more}">x</p>'), Setting({})) for more in (" part", ""))
    assert ("sticky: true" in numbered, "sticky" in other) == (True, False)


def test_a_sample_of_a_legend_stays_with_the_first_of_its_words():
    key = '<ul class="key"><li><svg viewBox="0 0 9 9" /><span>a long name</span></li></ul>'
    assert re.search(r"\)~a long name", blocks(parsed(key), Setting({})))


def test_a_span_in_a_cell_keeps_what_its_class_says():
    """Verdict and colour, the share of a limit, the unit below its head, and a subscript."""
    cell = (
        '<td class="fail"><span class="top"><strong>1.2</strong><span class="fail">122 %</span></span>'
        '<span class="bar" style="--share:61%"></span><small>governs</small></td>'
    )
    head = '<th class="n" scope="col">θ<sub>max</sub> <span class="unit">[m]</span></th>'
    table = f'<table class="card"><thead><tr>{head}</tr></thead><tbody><tr>{cell}</tr></tbody></table>'
    set_ = blocks(parsed(table), Setting({}))
    alarm = '"#b3261e"'
    for wanted in (
        f"fill: rgb({alarm}).lighten(89%)",
        "#bar(61%)",
        "#sub[max]",
        "align: right + bottom",
        "align: left + top",
    ):
        assert wanted in set_
    assert f"#text(rgb({alarm}))[122 \\%]" in set_
    assert r"  \ \[m\]" in set_


def test_the_heads_of_a_table_are_repeated_and_its_rows_are_not():
    """Typst repeats what is in the header of a table on each page; the head of a row stays in it."""
    heads = '<tr><th colspan="2">over</th></tr><tr><th scope="col">name</th><th scope="col">value</th></tr>'
    rows = "".join(f'<tr><th scope="row">r{n}</th><td>v{n}</td></tr>' for n in range(2))
    set_ = blocks(parsed(f"<table><thead>{heads}</thead><tbody>{rows}</tbody></table>"), Setting({}))
    header, body = set_.split("table.header(")[1].split("]), ")
    cells = [re.findall(r"\)\[(\w+)", part) for part in (header + "]", body)]
    assert cells == [["over", "name", "value"], ["r0", "v0", "r1", "v1"]]
    assert "columns: (auto, auto,)" in set_


def test_strips_of_two_columns_share_the_width_and_have_their_heads_above():
    strip = '<svg class="plot strip"></svg><span class="ends"></span>'
    row = f'<div class="row"><span class="of">r1</span>{strip}{strip}</div>'
    heads = '<span class="of"></span><span class="column">left</span><span class="column">right</span>'
    setting = Setting({})
    set_ = blocks(parsed(f'<div class="dots" style="--n:2">{heads}{row}</div>'), setting)
    cells = re.findall(r"(?<=, )\[(.*?)\](?=, \[|\))", set_.replace("\n", ""))
    assert [cell for cell in cells if cell in ("left", "right", "")][:5] == ["", "left", "", "right", ""]
    widths = [float(re.search(r' width="([\d.]+)"', picture.decode())[1]) for picture in setting.pictures.values()]
    assert len(widths) == 2
    assert sum(widths) < 0.6 * typeset.ACROSS


def test_records_that_share_a_row_have_none_of_their_own():
    row = '<div class="row {}"><span class="of">{}</span></div>'
    rows = row.format("", "worst") + row.format("rest", "remaining") + row.format("folded", "second")
    assert re.findall(r"\[(\w+)\]", blocks(parsed(f'<div class="dots">{rows}</div>'), Setting({}))) == [
        "worst",
        "remaining",
    ]


def test_histories_keep_the_room_for_the_labels_of_their_axis():
    setting = Setting({})
    blocks(parsed('<div class="timed" style="--h:100px"><svg class="plot"><text x="-34">a</text></svg></div>'), setting)
    (picture,) = setting.pictures.values()
    assert b'<svg x="48" width="638" height="100" overflow="visible">' in picture


def test_long_names_and_digests_may_be_broken_in_a_cell():
    cell = "a" * 40 + " records/RSN821_ERZINCAN"
    set_ = blocks(parsed(f"<table><tbody><tr><td>{cell}</td></tr></tbody></table>"), Setting({}))
    assert "[" + "a" * 24 + "\u200ba" in set_
    assert "/\u200bRSN821" in set_


def test_words_of_folds_code_and_pictures_of_histories_are_kept():
    """The summary of a fold, code to its last letter, a break between lines, and the first motion's histories alone."""
    setting = Setting({})
    two = "".join(f'<figure><figcaption>{name}</figcaption><svg viewBox="0 0 9 9"></svg></figure>' for name in "ab")
    fold = "<details><summary>All files</summary><p>a <code>peaks.csv</code><br></br>b</p></details>"
    html = f'{fold}<div class="histories">{two}</div>'
    set_ = blocks(parsed(html), setting)
    assert "#strong[All files]" in set_
    assert '#raw("peaks.csv") \\ b' in set_
    assert "[a]" in set_
    assert "[b]" not in set_
    assert len(setting.pictures) == 1


def test_marks_of_verdicts_have_the_colours_of_the_style_sheet():
    for name, colour in {"pass": "#1a6b3a", "fail": "#b3261e", "undecided": "#8a5a00"}.items():
        table = (
            f'<table class="card"><tbody><tr><td class="{name}"><span class="{name}">x</span></td></tr></tbody></table>'
        )
        set_ = blocks(parsed(table), Setting({}))
        assert set_.count(f'rgb("{colour}")') == 3


CURVES = """<svg class="plot" viewBox="0 0 100 60"><path class="curve ink" transform="scale(0.1)" d="M0 100l1000 0"></path>
<path class="curve ink" d="M0 30H100"></path><use class="ink" href="#m-square" x="50" y="50"></use></svg>"""


def dark_rows(picture, x):
    """Return the darkness of each pixel of a column of a picture of 100 by 60 px, drawn by Typst with 10 dots a px."""
    with tempfile.TemporaryDirectory() as folder:
        Path(folder, "a.svg").write_bytes(picture)
        page = '#set page(width: 75pt, height: 45pt, margin: 0pt)\n#image("a.svg", width: 75pt)'
        Path(folder, "a.typ").write_text(page, encoding="utf-8")
        drawn = typst.compile(Path(folder, "a.typ"), format="png", ppi=960.0)
    return 1.0 - np.asarray(Image.open(io.BytesIO(drawn)).convert("L"))[:, round(10 * x)] / 255.0


def test_curves_are_as_thick_as_on_the_screen_and_markers_are_filled():
    """A line of 1.3 px at 10 px and at 30 px, as thick, and a square of 6.6 px by 6.6 px about (50, 50)."""
    setting = Setting({})
    blocks(parsed(CURVES), setting)
    (picture,) = setting.pictures.values()
    column = dark_rows(picture, 20.0)
    first, second = (column[10 * (y - 5) : 10 * (y + 5)].sum() / column.max() / 10 for y in (10, 30))
    assert first == pytest.approx(second, rel=0.02) == pytest.approx(1.3, rel=0.1)
    square = dark_rows(picture, 50.0)[400:]
    assert square.sum() / square.max() / 10 == pytest.approx(6.6, abs=0.7)


def test_histories_are_drawn_in_one_of_their_views():
    views = '<g class="v0"><text>a</text></g><g class="v1"><text>b</text></g>'
    html = f'<div class="timed" style="--h:9px"><svg class="plot">{views}</svg></div>'
    setting = Setting({})
    blocks(parsed(html), setting)
    (picture,) = setting.pictures.values()
    assert re.findall(r"<text>(.)</text>", picture.decode()) == ["a"]


def test_the_first_number_of_an_axis_of_peaks_is_not_cut_off():
    setting = Setting({})
    row = '<span class="of"></span><svg class="plot strip"><text x="0%">0.00</text></svg><span class="ends"></span>'
    blocks(parsed(f'<div class="dots" style="--n:1"><div class="row">{row}</div></div>'), setting)
    (picture,) = setting.pictures.values()
    left = float(re.search(r'<svg x="([\d.]+)"', picture.decode())[1])
    assert left > 0.5 * 4 * 6.0  # half of four digits


def widths_of(*rows, heads=()):
    """Return the widths of the columns of a table as it is set."""
    head = "<tr>" + "".join(f"<th>{name}</th>" for name in heads) + "</tr>" if heads else ""
    cells = head + "".join(f"<tr>{''.join(f'<td>{cell}</td>' for cell in row)}</tr>" for row in rows)
    set_ = blocks(parsed(f'<table class="sortable"><tbody>{cells}</tbody></table>'), Setting({}))
    return re.search(r"columns: \((.*?),?\), table", set_)[1].split(", ")


def test_columns_keep_their_width_if_the_paper_has_it_and_share_it_if_not():
    name, remark = "n" * 40, "r" * 200
    assert widths_of([name, "1", name]) == ["auto"] * 3
    wide = widths_of(*10 * [[name, name, name, "1", ""]], [name, name, name, "1", remark])
    assert wide[3] == "auto"
    shares = [float(width.removesuffix("fr")) for width in (*wide[:3], wide[4])]
    assert max(shares) < 1.5 * min(shares)  # one long remark has the room of names


def test_long_heads_leave_the_notes_of_a_table_their_room():
    """Of a statics table of six cases with long names, whose notes had the width of a word."""
    case, note = "soft, weak: β = 40, η = 2.5, p = 0.58 rad/s", "rotation at which it is reached, of the " * 2
    widths = widths_of(["lift-off [g]", *6 * ["0.1234"], note], heads=["", *6 * [case], ""])
    assert widths[0] == "auto"
    assert float(widths[-1].removesuffix("fr")) > 0.5 * float(widths[1].removesuffix("fr"))


def test_a_list_in_a_legend_is_as_small_as_the_legend():
    assert blocks(parsed('<ul class="legend"><li>a</li></ul>'), Setting({})).startswith("\n#text(8pt, ")
