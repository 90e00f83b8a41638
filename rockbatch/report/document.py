"""The HTML document around the sections, with its style and script, and no address outside it."""

import base64
import hashlib
from collections.abc import Iterable
from importlib.resources import files
from typing import NamedTuple

from rockbatch._version import __version__
from rockbatch.report.drawing.svg import markers
from rockbatch.report.markup import Markup, join, tag
from rockbatch.report.templates import render


class Section(NamedTuple):
    """A part of the page: its heading, its anchor (the ``id`` that links go to), and what stands under the heading."""

    heading: str
    anchor: str
    content: Markup


def document(kind: str, title: str, sections: Iterable[Section | None], version: str = __version__) -> str:
    """Return the whole document as HTML; sections that are None or empty are left out.

    On paper each page has the title and ``version``, that of the rockbatch that made the results.
    """
    style, script = (
        files(__package__).joinpath(name).read_text(encoding="utf-8") for name in ("style.css", "script.js")
    )
    shown = [section for section in sections if section is not None and section.content]
    digest = base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
    return render(
        "page.html", kind=kind, title=title, sections=shown, version=f"rockbatch {version}", digest=digest,
        markers=markers(), style=Markup(style), script=Markup(script),
    )  # fmt: skip


def paragraphs(*sentences: object) -> Markup:
    """Return one paragraph for each sentence that is not empty."""
    return join(*(tag("p", sentence) for sentence in sentences if sentence))


def figure(drawn: Markup, *caption: object) -> Markup:
    """Return a picture with its caption below."""
    return tag("figure", drawn, tag("figcaption", *caption), class_="whole")
