"""Set a page of the site on paper: Markdown through HTML into Typst, which makes an accessible PDF of it (PDF/UA-1)."""

from collections.abc import Mapping

import markdown

from rockbatch.reporting.pdf import compiled, frame
from rockbatch.reporting.typeset import Setting, blocks, parsed

_STYLE = """
#set heading(numbering: "1.1")
#set table(stroke: (x, y) => if y > 1 { (top: 0.25pt + luma(200)) }, inset: (x: 4pt, y: 3pt))
#show table: set text(8.5pt)
#show table.cell.where(y: 0): strong
#show figure: set block(breakable: true)
#show raw: set text(size: 1.05em)
#show raw.where(block: true): it => block(fill: luma(245), inset: 8pt, width: 100%, it)
#title()
#outline(depth: 2)
"""


def as_pdf(text: str, title: str, header: str, pictures: Mapping[str, bytes]) -> bytes:
    """Return the PDF of a page.

    Parameters
    ----------
    text : str
        Markdown of the page; its first heading is left out for ``title``.
    title, header : str
        Of the document, and the text at the top of its sheets.
    pictures : mapping of str to bytes
        SVG by the path under which the page shows it.

    Raises
    ------
    ValueError
        If the page has an element that is not set yet.
    """
    html = markdown.markdown(text, extensions=["tables", "fenced_code", "sane_lists"], output_format="xhtml")
    start = frame(title, (header, ""), "", "10.5pt", margin="2.2cm") + _STYLE
    return compiled(start + blocks(parsed(html), Setting({})), pictures)
