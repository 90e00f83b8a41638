"""What documents, docstrings and tests cite is there: files, and the sections and equations of THEORY.md.

A section is cited by its heading, ``THEORY.md, Energy ledger``, which stays when sections are numbered anew; within THEORY.md
by a link, ``[section 8](#8-energy-ledger)``. An equation is cited by its number, and :data:`EQUATIONS` says how the one begins
that each cited number is meant for.
"""

import re
from pathlib import Path

import pytest

from rockbatch import __version__

ROOT = Path(__file__).parents[1]
FOLDERS = ("rockbatch", "tests", "docs", "benchmarks", "configs", "motions")
SOURCES = {
    str(path.relative_to(ROOT)): path.read_text(encoding="utf-8")
    for path in [*ROOT.glob("*.md"), *(path for folder in FOLDERS for path in (ROOT / folder).rglob("*"))]
    if path.suffix in (".py", ".md", ".toml", ".ipynb") and path != Path(__file__)
}
THEORY = SOURCES["THEORY.md"]
FILE = re.compile(r"\b(?:tests|docs|benchmarks|configs|rockbatch)/[A-Za-z0-9_/]+\.(?:py|md|csv|toml|ipynb)\b")
STAND_INS = re.compile(r"/NAME|^rockbatch/examples/")  # of recipes, and of what only a wheel has
HEADINGS = {
    path: re.findall(r"^##+ (.+)$", re.sub(r"^```.*?^```", "", text, flags=re.DOTALL | re.MULTILINE), re.MULTILINE)
    for path, text in SOURCES.items()
    if path.endswith(".md")
}
NUMBERED = re.compile(r"^ {4,}(\S.*?) +\((\d+)\)$", re.MULTILINE)
DISPLAYED = {int(number): display for display, number in NUMBERED.findall(THEORY)}
EQUATIONS = {
    1: "p² =",
    4: "v̈ = −g",
    5: "(I0/M + h²) θ̈ =",
    6: "H = h + bθ",
    7: "ż_i =",
    8: "(I0/M + H²) θ̈ + H H′ θ̇² =",
    9: "H = h cos θ",
    10: "θ = δ_s/b",
    11: "J = −(1 − ε) v̇_i",
    12: "ω_r² =",
    13: "β² >",
    14: "θ̈ = −p² {",
    15: "lift-off from rest:",
    16: "impact at θ = 0:",
    20: "θ_res =",
    21: "V/M = ü_g + R0",
    28: "E(θ_n) = e² E(θ_n−1)",
}
"""How each equation begins that other files than THEORY.md cite by its number."""


def slug(heading):
    """The anchor of a heading, as GitHub makes it; MkDocs makes the same of those that are linked to."""
    return re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")


def name(heading):
    """What a heading is cited as: without its number, and without the keys in brackets after it."""
    return re.sub(r"^\d+\. | \(`.*", "", heading)


def citations(text):
    """What stands after each ``THEORY.md, `` of a text, be it broken into lines or comments."""
    return re.split(r"THEORY\.md,\s", re.sub(r"\s*\n[ \t]*(?:#:? )?", " ", text))[1:]


def cited_equations(cited):
    """Numbers of ``eq. 4``, ``eqs. 4 and 7`` or ``eqs. 4 to 7`` at the start of ``cited``; empty if it starts with none."""
    found = re.match(r"eqs?\. (\d+)(?: (and|to) (\d+))?", cited)
    if found is None:
        return []
    first, last = int(found[1]), int(found[3] or found[1])
    return [*range(first, last + 1)] if found[2] == "to" else sorted({first, last})


@pytest.mark.parametrize("path", [path for path, text in SOURCES.items() if FILE.search(text)])
def test_every_file_that_is_cited_exists(path):
    cited = {file for file in FILE.findall(SOURCES[path]) if not STAND_INS.search(file)}
    assert [file for file in sorted(cited) if not (ROOT / file).is_file()] == []


@pytest.mark.parametrize("path", [path for path, text in SOURCES.items() if "THEORY.md," in text])
def test_the_theory_has_every_section_and_equation_that_is_cited(path):
    """A citation by a section's number is none: it would go on when the section moves."""
    sections = [re.escape(name(heading)) for heading in HEADINGS["THEORY.md"]]
    section = re.compile(rf"(?:{'|'.join(sections)})(?=$|[).,;:\"])")
    lost = [
        cited[:40]
        for cited in citations(SOURCES[path])
        if not section.match(cited) and not set(cited_equations(cited) or [0]) <= set(DISPLAYED)
    ]
    assert lost == []


def test_equations_are_numbered_in_their_order():
    assert [int(number) for _, number in NUMBERED.findall(THEORY)] == [*range(1, len(DISPLAYED) + 1)]


def test_the_text_of_the_theory_refers_to_equations_that_it_has():
    text = NUMBERED.sub("", THEORY.partition("## Sources")[0])
    assert {int(number) for number in re.findall(r"(?<![\w)])\((\d{1,2})\)", text)} <= set(DISPLAYED)


def test_numbers_that_are_cited_elsewhere_are_still_those_of_the_equations_meant():
    """Who numbers the equations anew changes the citations, and then :data:`EQUATIONS`."""
    pages = [SOURCES["docs/pages/lanes.md"], SOURCES["docs/pages/verification.md"]]  # they say that (4) is the theory's
    cited = {int(number) for page in pages for number in re.findall(r"(?<![\w)])\((\d{1,2})\)", page)}
    for path, text in SOURCES.items():
        cited |= {number for found in citations(text) for number in cited_equations(found) if path != "THEORY.md"}
    assert cited == set(EQUATIONS)
    assert {number: DISPLAYED[number][: len(begins)] for number, begins in EQUATIONS.items()} == EQUATIONS


def test_sections_are_numbered_in_their_order():
    numbers = [int(heading.split(".")[0]) for heading in HEADINGS["THEORY.md"] if heading[0].isdigit()]
    assert numbers == [*range(1, len(numbers) + 1)]


def test_links_to_sections_lead_there():
    """In THEORY.md they say the section's number, too; every mention of a section is such a link."""
    section, within = "", {}
    for heading in HEADINGS["THEORY.md"]:
        section = heading.split(".")[0] if heading[0].isdigit() else section
        within[slug(heading)] = section
    told = re.findall(r"\[section (\d+)\]\(#([\w-]+)\)", THEORY)
    assert told
    assert [(number, anchor) for number, anchor in told if within.get(anchor) != number] == []
    assert re.findall(r"(?<!\[)\b[Ss]ections? \d+", THEORY) == []
    assert set(re.findall(r"\]\(#([\w-]+)\)", THEORY)) <= set(within)


@pytest.mark.parametrize("path", [path for path, text in SOURCES.items() if re.search(r"\]\([^)]*\.md#", text)])
def test_links_to_headings_of_documents_lead_there(path):
    """Links from a page of the site to the theory are to docs/pages/theory.md, which is made of THEORY.md."""
    lost = []
    for target, anchor in re.findall(r"\]\(([\w./-]+\.md)#([\w-]+)\)", SOURCES[path]):
        found = str((ROOT / path).parent.joinpath(target).resolve().relative_to(ROOT))
        found = {"docs/pages/theory.md": "THEORY.md"}.get(found, found)
        if found in HEADINGS and anchor not in map(slug, HEADINGS[found]):
            lost.append((target, anchor))
    assert lost == []


def test_the_citation_names_this_version():
    citation = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    assert re.search(r"^version: (.+)$", citation, re.MULTILINE).group(1) == __version__
