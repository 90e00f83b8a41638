"""Make accessible PDF (PDF/UA-1) of text that is set in Typst, where it is installed."""

import importlib.util
import tempfile
from collections.abc import Mapping
from pathlib import Path

from rockbatch.common.errors import InputError
from rockbatch.reporting.typeset import string

PAPERS = {"A4": "a4", "Letter": "us-letter"}
"""Papers by their usual names, and what Typst calls them."""

_FRAME = """
#set document(title: {title})
#let beside(..parts) = text(8pt, gray.darken(40%), grid(columns: (1fr, auto), ..parts))
#set page(
  paper: {paper}, margin: (x: {margin}, y: 2cm), header: beside({top}),
  footer: context beside({bottom}, [page #counter(page).display("1 of 1", both: true)]),
)
#set text(font: ("Libertinus Serif", "New Computer Modern", "DejaVu Sans Mono"), size: {size}, lang: "en")
#set par(leading: 0.6em)
#show heading: set block(above: 1.5em, below: 0.8em, sticky: true)
#show link: set text(blue.darken(30%))
#show title: set text(18pt)
#let shown(path, width, alt) = layout(room => image(path, width: calc.min(width, room.width), alt: alt))
#let bar(share) = block(width: 100%, height: 2pt, above: 3pt, below: 3pt, fill: luma(215), context {{
  place(rect(width: share, height: 2pt, fill: text.fill))
  place(dx: 50%, dy: -1pt, rect(width: 1pt, height: 4pt, fill: black))
}})
"""


def installed() -> bool:
    """Return whether Typst is installed, which makes the PDF."""
    return importlib.util.find_spec("typst") is not None


def frame(title: str, top: tuple[str, str], bottom: str, size: str, margin: str = "1.2cm", paper: str = "A4") -> str:
    """Return the rules in Typst's markup that a document begins with.

    ``top`` are the texts at the head of each page, left and right, and ``bottom`` the one at its foot, beside its number.
    ``size`` of the text and ``margin`` on its left and right are lengths of Typst; ``paper`` is one of :data:`PAPERS`.
    """
    return _FRAME.format(
        title=string(title),
        paper=string(PAPERS[paper]),
        margin=margin,
        size=size,
        top=", ".join(map(string, top)),
        bottom=string(bottom),
    )


def compiled(source: str, pictures: Mapping[str, bytes]) -> bytes:
    """Return the PDF of a document in Typst's markup, which begins with a :func:`frame`; ``InputError`` without Typst.

    ``pictures`` are SVG by the path under which the document shows each.
    """
    if not installed():
        raise InputError('a PDF needs typst: pip install "rockbatch[pdf]", or print the HTML from a browser')
    import typst

    with tempfile.TemporaryDirectory() as folder:
        for path, picture in pictures.items():
            target = Path(folder, path)
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_bytes(picture)
        document = Path(folder, "page.typ")
        document.write_bytes(source.encode())
        pdf: bytes = typst.compile(document, pdf_standards="ua-1", ignore_system_fonts=True)
    return pdf
