"""The HTML document around the sections, with its style and script, and no address outside it."""

import base64
import hashlib
from collections.abc import Iterable
from importlib.resources import files
from typing import NamedTuple

from rockbatch.report.drawing.svg import markers
from rockbatch.report.markup import Markup, join, tag


class Section(NamedTuple):
    """A part of the page: its heading, its anchor (the ``id`` that links go to), and what stands under the heading."""

    heading: str
    anchor: str
    content: Markup


def document(kind: str, title: str, sections: Iterable[Section | None]) -> str:
    """Return the whole document as HTML; sections that are None are left out."""
    style, script = (
        files(__package__).joinpath(name).read_text(encoding="utf-8") for name in ("style.css", "script.js")
    )
    shown = [section for section in sections if section is not None]
    links = [tag("a", section.heading, href=f"#{section.anchor}") for section in shown]
    # Only the script below may run, and nothing is fetched, whatever a record is called
    digest = base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
    policy = f"default-src 'none'; style-src 'unsafe-inline'; script-src 'sha256-{digest}'; form-action 'none'; base-uri 'none'"
    head = tag(
        "head",
        Markup('<meta charset="utf-8">'),
        Markup(f'<meta http-equiv="Content-Security-Policy" content="{policy}">'),
        Markup('<meta name="viewport" content="width=device-width, initial-scale=1">'),
        Markup('<meta name="color-scheme" content="light dark">'),
        tag("title", title),
        tag("style", Markup(style)),
    )
    parts = [tag("section", tag("h2", section.heading), section.content, id=section.anchor) for section in shown]
    body = tag(
        "body",
        markers(),
        tag("header", tag("p", kind, class_="kind"), tag("h1", title)),
        tag("nav", *links, aria_label="Sections"),
        tag("main", *parts),
        tag("script", Markup(script)),
    )
    return f'<!DOCTYPE html>\n<html lang="en">\n{head}\n{body}\n</html>\n'


def paragraphs(*sentences: object) -> Markup:
    """Return one paragraph for each sentence that is not empty."""
    return join(*(tag("p", sentence) for sentence in sentences if sentence))


def figure(drawn: Markup, *caption: object) -> Markup:
    """Return a picture with its caption below."""
    return tag("figure", drawn, tag("figcaption", *caption), class_="whole")
