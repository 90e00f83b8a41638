"""The piers stand to scale beside the scorecard, with the heights that are read and the constants of their devices."""

import math
import re

import pytest
from browser import browse, needs_chromium, tab
from check_samples import verdict
from report_samples import FIG7, FOUNDATIONS, report, three_piers, write_results

import rockbatch as rb
from rockbatch.checks import write_verdicts
from rockbatch.common.figures.description import Axis, Figure, Look, Panel, Span
from rockbatch.quantities.demands import OF_SECTIONS
from rockbatch.reporting import write_report
from rockbatch.reporting.drawings import MOST_LINES, MOST_NAMES, drawings
from rockbatch.reporting.finished import read
from rockbatch.reporting.sheet import sheet_of
from rockbatch.reporting.svg import drawn as picture_of
from rockbatch.reporting.typeset import parsed
from rockbatch.results.run_json import describe_case
from rockbatch.study import Case

TOWER = rb.Pier.with_deck(7.0, 30.0, 1800.0, 1200.0, deck_height_m=31.5, top_m=30.0)
OIL = rb.Damper.viscous(TOWER, coefficient_kN_s_m=2000.0, exponent=0.3)
STRAND = rb.Tendon.of(TOWER, prestress_kN=5000.0, stiffness_kN_m=20e3)


def case(name, *restraints, pier=TOWER, **columns):
    return describe_case(Case(name, pier, rb.RigidBase(restraints=restraints), columns))


def drawn(folder, *cases, **more):
    """Return the captions, lines by line, and the words of each drawing."""
    write_results(folder, records=FIG7[:2], cases=list(cases), **more)
    figures = list(parsed(drawings(read(folder))).iter("figure"))
    captions = [
        ["".join(line.itertext()).replace("\u00a0", " ") for caption in figure.iter("figcaption") for line in caption]
        for figure in figures
    ]
    words = [["".join(text.itertext()) for text in figure.iter("text")] for figure in figures]
    return captions, words


def test_the_piers_stand_beside_the_scorecard_and_on_paper_among_the_inputs(tmp_path):
    page = report(tmp_path)
    sections = {
        name: text for name, _, text in re.findall(r'<section id="(\w+)"([^>]*)>(.*?)</section>', page, re.DOTALL)
    }
    beside = sections["answer"].partition('<div class="beside">')[2]
    assert beside.index("<table") < beside.index('class="piers"') < beside.index('class="dots')
    assert [name for name, text in sections.items() if 'class="piers"' in text] == ["answer"]
    parts = {section.anchor: section.content for section in sheet_of(read(tmp_path)).sections}
    assert [name for name, text in parts.items() if 'class="piers"' in text] == ["inputs"]


@needs_chromium
@pytest.mark.parametrize(("width", "abreast"), [(1280, True), (480, False)])
def test_the_scorecard_stands_beside_the_pier_but_alone_on_a_narrow_screen(tmp_path, width, abreast):
    write_results(tmp_path)
    write_verdicts(tmp_path, [verdict(name, "pass") for name, _ in FOUNDATIONS])
    act = """
    const [card, piers] = [...document.querySelectorAll(".beside > *")].map((node) => node.getBoundingClientRect());
    found.abreast = piers.left >= card.right && piers.top < card.bottom;
    found.share = card.width / document.querySelector(".beside").getBoundingClientRect().width;
    """
    found = browse(write_report(tmp_path, []), act, size=(width, 900))
    assert (found["abreast"], found["share"] > 0.99, found["wide"]) == (abreast, not abreast, True)


@needs_chromium
def test_the_printed_scorecard_is_as_wide_as_the_page(tmp_path):
    """Beside the pier it had the width of a letter."""
    write_results(tmp_path)
    write_verdicts(tmp_path, [verdict(name, "pass", check=f"check {k}") for name, _ in FOUNDATIONS for k in range(7)])
    with tab(write_report(tmp_path, []), (700, 1000)) as ask:
        ask("Emulation.setEmulatedMedia", media="print")
        wide = """["#answer .card", "#answer .beside"].map((of) => document.querySelector(of).getBoundingClientRect().width)"""
        done = ask("Runtime.evaluate", expression=wide, returnByValue=True)
    card, page = done["result"]["value"]
    assert card > 0.99 * page > 500.0


@needs_chromium
def test_a_printed_pier_is_on_the_page_of_its_caption(tmp_path):
    report(tmp_path)
    with tab(tmp_path / "report.html", (700, 1000)) as ask:
        ask("Emulation.setEmulatedMedia", media="print")
        kept = """[...document.querySelectorAll(".piers figure")].map((node) => getComputedStyle(node).breakInside)"""
        found = ask("Runtime.evaluate", expression=kept, returnByValue=True)["result"]["value"]
    assert set(found) == {"avoid"}


def test_cases_of_one_pier_share_a_drawing_without_a_caption(tmp_path):
    captions, words = drawn(tmp_path, case("a"), case("b"))
    assert captions == [[]]
    assert {"h = 21.6 m", "2b = 7 m", "α", "drift 30 m"} <= set(words[0])


def test_of_one_pier_with_different_devices_only_these_are_labelled_again(tmp_path):
    captions, words = drawn(tmp_path, case("bare"), case("oil", OIL), case("tied", OIL, STRAND))
    oil = "viscous damper at each pivot, C = 2000 kN (s/m)^0.3"
    tied = "tendon on the axis, P0 = 5000 kN, kt = 20,000 kN/m"
    assert captions == [
        ["bare"],
        ["oil", oil],
        ["tied", oil, tied],
    ]
    assert [len(own) > 0 for own in words] == [True, False, False]


def test_cases_that_are_named_stand_on_their_own_supports(tmp_path):
    """On rigid ground a pier stood on the springs of the others."""
    pads = [
        describe_case(Case(name, TOWER, rb.ElasticBase(beta=40, restraints=own), {}))
        for name, own in (("pads", ()), ("oil", (OIL,)))
    ]
    write_results(tmp_path, records=FIG7[:2], cases=[case("rock"), *pads])
    drawn_ = str(drawings(read(tmp_path)))
    assert re.findall(r"to scale on (.*?):", drawn_) == ["rigid ground", "two springs", "two springs"]
    assert drawn(tmp_path, case("rock"), pads[0])[0] == [[]]  # one picture of the pier, which names none


def test_a_device_that_some_cases_lack_is_labelled_with_the_others_names(tmp_path):
    firm = rb.Damper.viscous(TOWER, coefficient_kN_s_m=3000.0, exponent=0.3)
    captions, _ = drawn(
        tmp_path, case("soft", OIL), case("firm", firm), case("tied", OIL, STRAND), case("too", OIL, STRAND)
    )
    assert captions == [
        [
            "soft, firm",
            "soft: viscous damper at each pivot, C = 2000 kN (s/m)^0.3",
            "firm: viscous damper at each pivot, C = 3000 kN (s/m)^0.3",
        ],
        [
            "tied, too",
            "viscous damper at each pivot, C = 2000 kN (s/m)^0.3",
            "tendon on the axis, P0 = 5000 kN, kt = 20,000 kN/m",
        ],
    ]
    captions, _ = drawn(tmp_path, case("oil", OIL), case("tied", OIL, STRAND))
    assert [len(own) for own in captions] == [2, 2]
    assert captions[1][1].startswith("tendon")


def test_many_names_and_devices_are_counted(tmp_path):
    dampers = [rb.Damper.viscous(TOWER, coefficient_kN_s_m=1000.0 + n, exponent=0.3) for n in range(MOST_LINES + 3)]
    captions, _ = drawn(tmp_path, case("bare"), *(case(f"d{n}", damper) for n, damper in enumerate(dampers)))
    names, *lines = captions[1]
    assert names == ", ".join(f"d{n}" for n in range(MOST_NAMES)) + f" and {len(dampers) - MOST_NAMES} more"
    assert lines[-1] == "3 more in the table of foundations"
    assert len(lines) == MOST_LINES + 1


def test_piers_that_are_varied_are_called_by_their_values(tmp_path):
    captions, words = drawn(tmp_path, *three_piers(), varied=("p",))
    assert captions == [["p = 0.38 rad/s"], ["p = 0.36 rad/s"], ["p = 0.35 rad/s"]]
    assert all("α" in own for own in words)


def test_a_pier_that_cannot_be_drawn_leaves_the_captions_of_the_others(tmp_path):
    cases = three_piers()
    for entry in cases[:5]:
        entry["pier"] = entry["pier"] | {"height_m": -1.0}
    assert drawn(tmp_path, *cases, varied=("p",))[0] == [["p = 0.36 rad/s"], ["p = 0.35 rad/s"]]


def test_heights_of_sections_are_those_of_the_table_and_of_the_checks_of_the_case(tmp_path):
    write_results(tmp_path, records=FIG7[:1], cases=[case("a", pier=TOWER), case("b", STRAND)])
    head = ",".join(["record", "case", "polarity", "scale", *OF_SECTIONS])
    empty = "," * (len(OF_SECTIONS) - 1)
    rows = [f"{FIG7[0][0]},{name},+,1.0,{height}{empty}" for name, height in (("a", 0.0), ("a", 15.0), ("b", 7.0))]
    (tmp_path / "sections.csv").write_text("\n".join([head, *rows]) + "\n", encoding="utf-8")
    write_verdicts(tmp_path, [verdict("b", "pass", at_m=12.5), verdict("a", "pass", at_m=math.nan)])
    finished = read(tmp_path)
    a, b = finished.info["cases"]
    assert finished.section_heights(a) == (0.0, 15.0)
    assert finished.section_heights(b) == (7.0, 12.5)
    words = [
        ["".join(text.itertext()) for text in figure.iter("text")]
        for figure in parsed(drawings(finished)).iter("figure")
    ]
    assert {"section 0 m", "section 15 m", "drift 30 m"} <= set(words[0])
    assert {"section 7 m", "section 12.5 m"} <= set(words[1])


def test_a_bound_is_named_where_its_device_or_its_pier_is_not_that_of_the_design(tmp_path):
    """The caption of a design is short, however many bounds leave its devices as they are."""
    weak = rb.Damper.viscous(TOWER, coefficient_kN_s_m=1700.0, exponent=0.3)
    heavy = rb.Pier.with_deck(7.0, 30.0, 1800.0, 1400.0, deck_height_m=31.5, top_m=30.0)
    oil = rb.Damper.viscous(heavy, coefficient_kN_s_m=2000.0, exponent=0.3)
    cases = [case("oil", OIL, bound=""), case("oil", weak, bound="weak"), case("oil", OIL, bound="soft")]
    firm = rb.Damper.viscous(TOWER, coefficient_kN_s_m=3000.0, exponent=0.3)
    cases += [case("firm", firm, bound=""), case("firm", firm, bound="soft")]
    captions, _ = drawn(tmp_path, *cases, case("oil", oil, pier=heavy, bound="traffic"), varied=("bound",))
    damper = "viscous damper at each pivot, C = {} kN (s/m)^0.3"
    assert captions == [
        [
            "oil, firm",
            f"oil: {damper.format(2000)}",
            f"oil: weak: {damper.format(1700)}",
            f"firm: {damper.format(3000)}",
        ],
        ["oil: traffic", damper.format(2000)],
    ]


@pytest.mark.parametrize(("axis", "shares"), [("x", (0.3, 1.0)), ("y", (1.0, 0.25))])
def test_a_band_covers_its_values_on_its_axis_and_all_of_the_other(axis, shares):
    """From 1 to 4 of 10 across, and from 1 to 2 of 4 upwards."""
    whole, part = (
        Span("x", 0.0, 10.0, look=Look("band")),
        Span(axis, 1.0, 4.0 if axis == "x" else 2.0, look=Look("band")),
    )
    panel = Panel(Axis("", 0.0, 10.0), Axis("", 0.0, 4.0), [whole, part], width=400.0, height=200.0)
    sizes = re.findall(
        r'<rect[^>]* width="([\d.]+)" height="([\d.]+)" class="[^"]*band', picture_of(Figure([panel], "bands"))
    )
    (across, down), (own_across, own_down) = ((float(a), float(b)) for a, b in sizes)
    assert (own_across / across, own_down / down) == pytest.approx(shares, abs=0.01)
