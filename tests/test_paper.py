"""The paper's table is what paper/figures.py makes; its citations have sources, and CITATION.cff names it as it is."""

import re
import runpy
from pathlib import Path

ROOT = Path(__file__).parents[1]
PAPER = (ROOT / "paper" / "paper.md").read_text(encoding="utf-8")
SOURCES = (ROOT / "paper" / "paper.bib").read_text(encoding="utf-8")


def test_the_table_is_what_the_script_makes():
    script = runpy.run_path(str(ROOT / "paper" / "figures.py"))
    assert script["TABLE"].search(PAPER).group() == script["verification"]()
    assert (ROOT / "paper" / re.search(r"\((\w+\.png)\)", PAPER).group(1)).is_file()


def test_every_citation_has_a_source_and_every_source_is_cited():
    assert set(re.findall(r"(?<!\w)@(\w+)", PAPER)) == set(re.findall(r"^@\w+\{(\w+),", SOURCES, re.MULTILINE))


def test_title_and_authors_are_those_of_the_citation_file():
    citation = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    title, cited = (re.search(r"^title: ['\"](.+)['\"]$", text, re.MULTILINE).group(1) for text in (PAPER, citation))
    assert title == cited
    authors = citation.split("authors:\n")[1].split("version:")[0]
    assert re.findall(r"- name: (.+)", authors) == re.findall(r"- name: (.+)\n    affiliation", PAPER)
    assert 250 <= len(PAPER.split("---\n", 2)[2].split()) <= 1000  # words, as the journal asks
