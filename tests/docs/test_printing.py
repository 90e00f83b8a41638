"""Pages on paper, where what sets them is installed (``make docs``)."""

import importlib.util
import re
from pathlib import Path

import pytest

from rockbatch.reporting.typeset import words

pytest.importorskip("typst")
pytest.importorskip("markdown")

SPEC = importlib.util.spec_from_file_location("printing", Path(__file__).parents[2] / "docs" / "printing.py")
printing = importlib.util.module_from_spec(SPEC)
SPEC.loader.exec_module(printing)

SVG = b'<svg xmlns="http://www.w3.org/2000/svg" width="9" height="9"><circle cx="4" cy="4" r="3"/></svg>'


def printed(text, **pictures):
    return printing.as_pdf(text, "A title", "a header", {f"pictures/{name}.svg": svg for name, svg in pictures.items()})


def test_a_page_with_all_that_a_page_may_have_becomes_a_tagged_pdf():
    page = """# Left out

## Part

Words, *stress*, **more**, `code`, a [link](other.md#there) and ½ θ̇² of θ̈.

- one
- two

1. first

| what | where |
| --- | --- |
| a | `tests/test_pier.py` |

![A disc](pictures/disc.svg)

```sh
make run
```
"""
    found = printed(page, disc=SVG)
    assert found.startswith(b"%PDF")
    assert re.search(rb"/MarkInfo|pdfuaid:part", found)


def test_signs_that_mean_something_to_typst_are_only_signs():
    assert printed("a #let $ * _ b @c d < e > \\ ~ `e` [1] // f /* g = - + 1. h").startswith(b"%PDF")


def test_dots_over_theta_are_set_as_accents():
    """The text's font draws them into the letter, where nobody sees them: θ̇² would read as θ²."""
    assert "accent(upright(θ), dot)" in words("θ̇")
    assert "accent(upright(θ), dot.double)" in words("θ̈")
    assert words("v̇ θ") == "v̇ θ"


def test_what_cannot_be_set_is_refused_by_name():
    with pytest.raises(ValueError, match="<blockquote>"):
        printed("> said")
    with pytest.raises(ValueError, match="<del>"):
        printed("some <del>text</del>")
