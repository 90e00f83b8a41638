"""Documents that cite a test name one that is there."""

import re
from pathlib import Path

import pytest

from rockbatch import __version__

ROOT = Path(__file__).parents[1]
DOCUMENTS = [*ROOT.glob("*.md"), *ROOT.glob("*/*.md"), *ROOT.glob("docs/pages/**/*.md"), *ROOT.glob("configs/*.toml")]
CITED = {
    str(document.relative_to(ROOT)): re.findall(r"tests/[\w/]+\.py", document.read_text(encoding="utf-8"))
    for document in DOCUMENTS
}


@pytest.mark.parametrize("document", [document for document, paths in CITED.items() if paths])
def test_every_test_that_a_document_cites_exists(document):
    assert [path for path in CITED[document] if not (ROOT / path).is_file()] == []


def test_the_theory_cites_tests():
    """So that the search above is known to find citations."""
    assert len(CITED["THEORY.md"]) > 20


def test_the_citation_names_this_version():
    citation = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    assert re.search(r"^version: (.+)$", citation, re.MULTILINE).group(1) == __version__
