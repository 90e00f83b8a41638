"""Set a page of the site on paper: Markdown through HTML into Typst, which makes an accessible PDF of it (PDF/UA-1)."""

import json
import re
import tempfile
from collections.abc import Iterator, Mapping
from pathlib import Path
from xml.etree import ElementTree

import markdown
import typst

Element = ElementTree.Element

_SHEET = """
#set document(title: {title})
#set page(paper: "a4", margin: (x: 2.2cm, y: 2.4cm), numbering: "1 / 1", header: text(8pt, gray.darken(40%), {header}))
#set text(font: ("Libertinus Serif", "New Computer Modern", "DejaVu Sans Mono"), size: 10.5pt, lang: "en")
#set par(leading: 0.62em)
#set heading(numbering: "1.1")
#set table(stroke: (x, y) => if y > 1 {{ (top: 0.25pt + luma(200)) }}, inset: (x: 4pt, y: 3pt))
#show table: set text(8.5pt)
#show table.cell.where(y: 0): strong
#show figure: set block(breakable: true)
#show heading: set block(above: 1.6em, below: 0.8em)
#show raw: set text(size: 1.05em)
#show raw.where(block: true): it => block(fill: luma(245), inset: 8pt, width: 100%, it)
#show link: set text(blue.darken(30%))
#show title: set text(18pt)
#title()
#outline(depth: 2)
"""
_BREAKS = re.compile(r"(?<=[/_])(?=\w)")
_DOTTED = re.compile("θ(\N{COMBINING DOT ABOVE}|\N{COMBINING DIAERESIS})")  # the text's font puts them into the letter
_NARROW = 16  # characters: columns of no more keep their width, the others share what is left


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
    """
    html = markdown.markdown(text, extensions=["tables", "fenced_code", "sane_lists"], output_format="xhtml")
    page = ElementTree.fromstring(f"<div>{html}</div>")
    body = "".join(_block(element) for element in page if element.tag != "h1")
    sheet = _SHEET.format(title=_string(title), header=_string(header))
    with tempfile.TemporaryDirectory() as folder:
        for path, picture in pictures.items():
            target = Path(folder, path)
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_bytes(picture)
        source = Path(folder, "page.typ")
        source.write_text(sheet + body, encoding="utf-8")
        pdf: bytes = typst.compile(source, pdf_standards="ua-1", ignore_system_fonts=True)
    return pdf


def _block(element: Element) -> str:
    """Return Typst's markup for a block of HTML."""
    match element.tag:
        case "h2" | "h3" | "h4":
            return f"\n{'=' * (int(element.tag[1]) - 1)} {_inline(element)}\n"
        case "p" if len(element) == 1 and element[0].tag == "img" and not (element.text or "").strip():
            return _figure(element[0])
        case "p":
            return f"\n{_inline(element)}\n"
        case "ul" | "ol":
            kind = {"ul": "list", "ol": "enum"}[element.tag]
            return f"\n#{kind}({', '.join(f'[{_content(item)}]' for item in element)})\n"
        case "pre":
            return f"\n#raw({_string(''.join(element.itertext()).rstrip())}, block: true)\n"
        case "table":
            return _table(element)
    raise ValueError(f"a page to be printed has <{element.tag}>, which is not set yet: see docs/printing.py")


def _content(item: Element) -> str:
    """Return the content of a list's item: text, or blocks."""
    blocks = any(child.tag in ("p", "ul", "ol", "pre", "table") for child in item)
    return "".join(map(_block, item)) if blocks else _inline(item)


def _figure(image: Element) -> str:
    caption = image.get("alt", "")
    return f"\n#figure(image({_string(image.get('src', ''))}, alt: {_string(caption)}), caption: [{_text(caption)}])\n"


def _table(table: Element) -> str:
    rows = [[_inline(cell, within_table=True) for cell in row] for row in table.iter("tr")]
    widths = ", ".join(_widths([["".join(cell.itertext()) for cell in row] for row in table.iter("tr")]))
    heads, *body = (", ".join(f"[{cell}]" for cell in row) for row in rows)
    lines = ", ".join(body)
    return (
        f"\n#table(columns: ({widths},), table.hline(), table.header({heads}), table.hline(stroke: 0.5pt), "
        f"{lines}, table.hline())\n"
    )


def _widths(cells: list[list[str]]) -> Iterator[str]:
    for column in zip(*cells, strict=True):
        yield "auto" if max(map(len, column)) <= _NARROW else f"{sum(map(len, column)) ** 0.5:.0f}fr"


def _inline(element: Element, within_table: bool = False) -> str:
    return _text(element.text or "") + "".join(_spans(element, within_table))


def _spans(element: Element, within_table: bool) -> Iterator[str]:
    for child in element:
        match child.tag:
            case "code":
                code = child.text or ""
                yield f"#raw({_string(_BREAKS.sub(chr(0x200B), code) if within_table else code)})"
            case "em":
                yield f"#emph[{_inline(child, within_table)}]"
            case "strong":
                yield f"#strong[{_inline(child, within_table)}]"
            case "a":  # other pages of the site are not at hand on paper
                yield _inline(child, within_table)
            case "br":
                yield " \\ "
            case _:
                raise ValueError(f"a page to be printed has <{child.tag}>, which is not set yet: see docs/printing.py")
        yield _text(child.tail or "")


def _text(text: str) -> str:
    text = re.sub(r"([!-/:-@\[-`{-~])", r"\\\1", text)
    return _DOTTED.sub(_dotted, text)


def _dotted(letter: re.Match[str]) -> str:
    accent = "dot" if letter[1] == "\N{COMBINING DOT ABOVE}" else "dot.double"
    return f"#math.equation(alt: {_string(letter[0])}, $accent(upright(θ), {accent})$)"


def _string(text: str) -> str:
    return json.dumps(text, ensure_ascii=False)
