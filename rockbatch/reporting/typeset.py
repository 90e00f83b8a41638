"""Set HTML in Typst: the blocks of a calculation sheet and of a page of the documentation, with SVG as pictures."""

import json
import math
import re
from collections.abc import Iterator, Sequence
from functools import cache
from typing import NamedTuple
from xml.etree import ElementTree

from rockbatch.reporting.svg import markers
from rockbatch.reporting.table import GAP, PAPER, WRAPPED
from rockbatch.reporting.templates import styles

Element = ElementTree.Element

ACROSS = 700.0
"""Width of the text [px], 96 of them to the inch: of A4 with margins of 12 mm."""
_HIDDEN = frozenset(("filter", "copy", "choice", "scripted"))
"""Classes of elements that the style sheet hides on paper."""
_COLOURS = {"pass": "--good", "fail": "--alarm", "alarm": "--alarm", "undecided": "--amber", "muted": "--muted"}
"""Colour of the text by class, as a variable of the style sheet."""
_TINTS = {"pass": 92, "fail": 89, "undecided": 87, "na": 100, "others": 100}
"""Share of white [%] in the colour of a scorecard's cell by class."""
_BREAKS = re.compile(r"(?<=[/_])(?=\w)|(?<=\w{24})(?=\w{4})")
"""Where a long name or a digest may be broken."""
_DOTTED = re.compile(
    "θ(\N{COMBINING DOT ABOVE}|\N{COMBINING DIAERESIS})"
)  # the text's font draws the dots into the letter
_SCALE = re.compile(r"scale\(([\d.]+)\)")
_NUMBER = re.compile(r"-?\d+(\.\d+)?")
_SHRUNK = 0.82
"""Share of its width to which a panel may shrink, as on the screen."""
_NARROW = 24
"""Characters: in a wide table columns of no more keep their width, and the others share the rest."""


class Setting(NamedTuple):
    """The pictures that a text shows, by their paths: :func:`blocks` adds those that stand in the text itself."""

    pictures: dict[str, bytes]


def parsed(html: str) -> Element:
    """Return well-formed HTML without a root as the children of one element.

    Raises ``ElementTree.ParseError`` if an element is not closed or an attribute has no value.
    """
    return ElementTree.fromstring(f"<div>{html}</div>")


def string(text: str) -> str:
    """Return a text as a string of Typst's code."""
    return json.dumps(text, ensure_ascii=False)


def words(text: str) -> str:
    """Return a text as Typst's markup, with a backslash before each ASCII sign, so that it stands for itself.

    θ with one or two dots above becomes an equation, since the text's font draws the dots into the letter.
    """
    text = re.sub(r"([!-/:-@\[-`{-~])", r"\\\1", text)
    return _DOTTED.sub(_dotted, text)


def _dotted(letter: re.Match[str]) -> str:
    accent = "dot" if letter[1] == "\N{COMBINING DOT ABOVE}" else "dot.double"
    return f"#math.equation(alt: {string(letter[0])}, $accent(upright(θ), {accent})$)"


def blocks(parent: Element, setting: Setting) -> str:
    """Return the markup of an element's content: blocks, and text between them as paragraphs, without hidden ones.

    Raises ``ValueError`` for an element that is not set yet.
    """
    written, line = [], words(parent.text or "")
    for child in parent:
        if child.tag in _SPANS:
            line += _span(child)
        else:
            written += [_paragraph(line), _block(child, setting)]
            line = ""
        line += words(child.tail or "")
    return "".join([*written, _paragraph(line)])


def _paragraph(line: str) -> str:
    return f"\n{line}\n" if line.strip() else ""


def _block(element: Element, setting: Setting) -> str:
    classes = _classes(element)
    if classes & _HIDDEN:
        return ""
    for class_, set_ in _BY_CLASS.items():
        if class_ in classes:
            return set_(element, setting)
    match element.tag:
        case "h1":
            return ""
        case "h2" | "h3" | "h4":
            return f"\n{'=' * (int(element.tag[1]) - 1)} {_inline(element)}\n"
        case "p" | "ul" | "ol" | "summary" | "figcaption":
            return _of_text(element, setting)
        case "pre":
            return f"\n#raw({string(''.join(element.itertext()).rstrip())}, block: true)\n"
        case "table":
            return _table(element, setting)
        case "svg":
            return f"\n#{_picture(element, setting)}\n"
        case "div" | "section" | "figure" | "details":
            return blocks(element, setting)
    raise ValueError(f"a page to be printed has <{element.tag}>, which is not set yet: see reporting/typeset.py")


def _of_text(element: Element, setting: Setting) -> str:
    match element.tag:
        case "p" if len(element) == 1 and element[0].tag == "img" and not (element.text or "").strip():
            return _figure(element[0])
        case "p" if _classes(element) & {"legend", "muted"}:
            line = f"text(8pt, {_colour('--muted')})[{_inline(element)}]"
            return f"\n#block(sticky: true, {line})\n" if "part" in _classes(element) else f"\n#{line}\n"
        case "p":
            return _paragraph(_inline(element))
        case "ul" | "ol":
            kind = {"ul": "list", "ol": "enum"}[element.tag]
            items = f"{kind}({', '.join(f'[{blocks(item, setting)}]' for item in element)})"
            return (
                f"\n#text(8pt, {_colour('--muted')}, {items})\n" if "legend" in _classes(element) else f"\n#{items}\n"
            )
        case "summary":
            return f"\n#strong[{_inline(element)}]\n"
    return f"\n#text(8pt)[{_inline(element)}]\n"


def _figure(image: Element) -> str:
    caption = image.get("alt", "")
    return f"\n#figure(image({string(image.get('src', ''))}, alt: {string(caption)}), caption: [{words(caption)}])\n"


def _key(element: Element, setting: Setting) -> str:
    """Return a legend: samples, each with its words, in lines; a sample is kept on the line of its first word."""
    entries = (f"#box({_picture(item[0], setting)})~{_inline(item[1])}" for item in element)
    return f"\n#text(8pt)[{' #h(8pt) '.join(entries)}]\n"


def _panels(element: Element, setting: Setting) -> str:
    """Return panels side by side, as many as the text's width takes if they shrink to 82 % of theirs, one at least."""
    widest = _length(element, "--w", "width")
    widest = widest or max((_length(panel, "width") for panel in element), default=0.0) or ACROSS
    side = max(int(ACROSS / (_SHRUNK * widest)), 1)
    cells = ", ".join(f"block(breakable: false)[{blocks(panel, setting)}]" for panel in element)
    return f"\n#grid(columns: (1fr,) * {side}, column-gutter: 8pt, row-gutter: 8pt, align: bottom, {cells})\n"


def _chosen(element: Element, setting: Setting) -> str:
    """Return the first figure, of which the page shows one at a time: histories of the worst motion, the pier of a case."""
    return blocks(next(element.iter("figure"), element), setting)


def _timed(element: Element, setting: Setting) -> str:
    """Return stacked histories, whose time axis is as wide as the text, in the first view of those that the page shows."""
    height = _length(element, "--h")
    for parent in list(element.iter()):
        for child in [child for child in parent if "v1" in _classes(child)]:
            parent.remove(child)
    return "".join(f"\n#{_picture(svg, setting, (ACROSS, height), 48.0)}\n" for svg in element)


def _dots(element: Element, setting: Setting) -> str:
    """Return rows of peaks on a common axis: in each the label, and for each column the strip and the runs without a peak.

    Rows that are folded on the screen are left out, since one row has them all.
    """
    columns = int(_style(element).get("--n", "1"))
    wide = round(0.58 * ACROSS / columns - 20.0)
    cells: list[str] = []
    for child in element:
        if "folded" in _classes(child):
            continue
        for cell in child if "row" in _classes(child) else [child]:
            strip = cell.tag == "svg"
            cells.append(
                f"[#{_picture(cell, setting, (wide, 20.0), 14.0)}]" if strip else f"[{_with_signs(cell, setting)}]"
            )
    if any("column" in _classes(cell) for cell in element):  # their heads stand over the strips only
        heads = next(place for place, cell in enumerate(element) if "row" in _classes(cell))
        cells[1:heads] = [entry for head in cells[1:heads] for entry in (head, "[]")]
    widths = "1fr, " + ", ".join(f"{0.75 * wide:.0f}pt, auto" for _ in range(columns))
    return f"\n#text(7.5pt, grid(columns: ({widths}), column-gutter: 4pt, align: horizon, {', '.join(cells)}))\n"


def _with_signs(element: Element, setting: Setting) -> str:
    """Return the Typst markup of an element's text, with its SVG pictures in the line, each in a box."""
    written = words(element.text or "")
    for child in element:
        if child.tag == "svg":
            written += f"#box({_picture(child, setting)})"
        elif child.find(".//svg") is None:
            written += _span(child)
        else:
            written += f"#box[{_with_signs(child, setting)}]"
        written += words(child.tail or "")
    return written


def _table(table: Element, setting: Setting) -> str:
    rows = list(table.iter("tr"))
    card = "card" in _classes(table)
    across = max(sum(int(cell.get("colspan", "1")) for cell in row) for row in rows)
    heads = [row for row in rows if _of_heads(row)]
    body = ", ".join(_cell(cell, setting, card) for row in rows if not _of_heads(row) for cell in row)
    above = ", ".join(_cell(cell, setting, card) for row in heads for cell in row)
    texts = [["".join(cell.itertext()) for cell in row] for row in rows if len(row) == across]
    widths = ", ".join(["1.4fr"] + ["1fr"] * (across - 1) if card else _widths(texts))
    return f"\n#table(columns: ({widths},), table.header({above}), {body})\n"


def _of_heads(row: Element) -> bool:
    return all(cell.tag == "th" and cell.get("scope") != "row" for cell in row)


def _widths(cells: Sequence[Sequence[str]]) -> Iterator[str]:
    """Yield the width of each column by its texts, heads included: "auto" for short ones, else a share such as "7fr".

    Short are texts of up to ``WRAPPED`` characters, or ``_NARROW`` if the table would not fit on the paper then. The share is the
    fourth root of the sum of squared lengths, so that a long text counts more than many short ones.
    """
    columns = [[len(text) for text in column] for column in zip(*cells, strict=True)]
    fits = sum(GAP + min(max(lengths), WRAPPED) for lengths in columns) <= PAPER
    for lengths in columns:
        short = max(lengths) <= (WRAPPED if fits else _NARROW)
        yield "auto" if short else f"{sum(n * n for n in lengths) ** 0.25:.0f}fr"


def _cell(cell: Element, setting: Setting, card: bool) -> str:
    classes = _classes(cell)
    options = [f"colspan: {cell.get('colspan')}"] if cell.get("colspan") else []
    options += [f"align: {'right' if 'n' in classes else 'left'} + {'bottom' if cell.get('scope') == 'col' else 'top'}"]
    tint = next((tint for name, tint in _TINTS.items() if name in classes), None) if card else None
    if tint is not None:
        colour = next((_COLOURS[name] for name in _COLOURS if name in classes), "--paper")
        options.append(f"fill: {_colour(colour)}.lighten({tint}%)")
    plain = all(child.tag in _SPANS for child in cell)
    text = _inline(cell, within_table=True) if plain else blocks(cell, setting)
    return f"table.cell({', '.join(options)})[{_shaded(classes, text)}]"


def _inline(element: Element, within_table: bool = False) -> str:
    text = element.text or ""
    written = words(_broken(text) if within_table else text)
    for child in element:
        tail = child.tail or ""
        written += _span(child, within_table) + words(_broken(tail) if within_table else tail)
    return written


def _broken(text: str) -> str:
    return _BREAKS.sub("\N{ZERO WIDTH SPACE}", text)


_SPANS = frozenset(("code", "em", "strong", "a", "br", "span", "small", "sub", "b"))


def _span(element: Element, within_table: bool = False) -> str:
    classes = _classes(element)
    if classes & _HIDDEN:
        return ""
    if element.tag == "br":
        return " \\ "
    if element.tag == "code":
        code = element.text or ""
        return f"#raw({string(_broken(code) if within_table else code)})"
    text = _shaded(classes, _inline(element, within_table))
    match element.tag:
        case "em":
            return f"#emph[{text}]"
        case "strong" | "b":
            return f"#strong[{text}]"
        case "small":
            return f" \\ #text(0.85em, {_colour('--muted')})[{text}]"
        case "sub":
            return f"#sub[{text}]"
        case "span" if "bar" in classes:
            return f"#bar({_style(element)['--share']})"
        case "span" if "top" in classes:  # its parts stand apart on the screen
            return f"#text({_colour('--ink')})[{'~'.join(_span(part, within_table) for part in element)}]"
        case "span" if "unit" in classes and within_table:
            return f" \\ {text}"
        case "span" | "a":  # other pages are not at hand on paper
            return text
    raise ValueError(f"a page to be printed has <{element.tag}>, which is not set yet: see reporting/typeset.py")


def _shaded(classes: frozenset[str], text: str) -> str:
    colour = next((_COLOURS[name] for name in _COLOURS if name in classes), None)
    return f"#text({_colour(colour)})[{text}]" if colour and text else text


_BY_CLASS = {
    "key": _key,
    "panels": _panels,
    "piers": _panels,
    "histories": _chosen,
    "player": _chosen,
    "timed": _timed,
    "dots": _dots,
}
"""Functions that set elements whose layout is that of their class."""


def _picture(svg: Element, setting: Setting, size: tuple[float, float] | None = None, left: float = 0.0) -> str:
    """Return the code that shows an SVG, which is added to the pictures as a file that stands for itself.

    It has the style sheet's colours and the markers. ``size`` [px] is that of a picture without a view box, in which positions
    are shares of the width; there ``left`` [px] stay free for labels, and 14 at the right. One with a view box is as wide as
    that, but at most as its column. Typst scales the width of a line with its path, and markers are no part of a plot: so
    coordinates are scaled here.
    """
    for line in svg.iter("path"):
        if scale := _SCALE.fullmatch(line.get("transform", "")):
            del line.attrib["transform"]
            line.set("d", _NUMBER.sub(lambda number: f"{float(number[0]) * float(scale[1]):g} ", line.get("d", "")))
    box = [float(value) for value in svg.get("viewBox", "").split()]
    if size is None:
        size = (float(svg.get("width", box[2])), float(svg.get("height", box[3])))
    view = svg.get("viewBox") or f"0 0 {size[0]:g} {size[1]:g}"
    inner = "".join(ElementTree.tostring(child, encoding="unicode") for child in svg)
    if left:
        inner = (
            f'<svg x="{left:g}" width="{size[0] - left - 14.0:g}" height="{size[1]:g}" overflow="visible">{inner}</svg>'
        )
    colour = next((f"color:{_colours()[f'--{name}']}" for name in _classes(svg) if f"--{name}" in _colours()), "")
    whole = (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="{view}" width="{size[0]:g}" height="{size[1]:g}" '
        f'font-family="Libertinus Serif" font-size="11.5" fill="currentColor" style="{colour}">'
        f'<style>{_style_of_pictures()}</style>{_markers()}<g class="plot">{inner}</g></svg>'
    )
    path = f"picture-{len(setting.pictures)}.svg"
    setting.pictures[path] = whole.encode()
    alt = svg.get("aria-label", "sample of the legend")
    return f"shown({string(path)}, {0.75 * min(size[0], ACROSS):.1f}pt, {string(alt)})"


@cache
def _markers() -> str:
    """Return the definitions of the markers, which each picture needs."""
    defined = parsed(markers()).find("svg/defs")
    return "" if defined is None else ElementTree.tostring(defined, encoding="unicode")


@cache
def _colours() -> dict[str, str]:
    """Return the style sheet's variables for light paper, by names such as "--good"."""
    first = styles("style.css").partition("}")[0]
    return {name: value.strip() for name, value in re.findall(r"(--[\w-]+):([^;]+);", first)}


def _colour(name: str) -> str:
    return f"rgb({string(_colours()[name])})"


@cache
def _style_of_pictures() -> str:
    """Return the rules of the style sheet for pictures, with the colours for light paper in place of variables."""
    rules = re.findall(r"^((?:\.plot|\.s\d|\.ink)[^{}:]*)\{([^{}]*)\}", _in_lines(styles("style.css")), re.MULTILINE)
    text = "".join(f"{selector}{{{declared}}}" for selector, declared in rules)
    return re.sub(r"var\((--[\w-]+)\)", lambda name: _colours()[name[1]], text)


def _in_lines(css: str) -> str:
    return css.replace("} ", "}\n")


def _classes(element: Element) -> frozenset[str]:
    return frozenset(element.get("class", "").split())


def _style(element: Element) -> dict[str, str]:
    """Return the declarations in an element's own style: {"width": "460px"}; {} without one."""
    pairs = (part.partition(":") for part in element.get("style", "").split(";") if part.strip())
    return {name.strip(): value.strip() for name, _, value in pairs}


def _length(element: Element, *names: str) -> float:
    """Return the first of these lengths [px] that an element's own style declares; 0 for none, or if it is infinite or NaN."""
    style = _style(element)
    found = (float(style[name].removesuffix("px")) for name in names if style.get(name, "").endswith("px"))
    value = next(found, 0.0)
    return value if math.isfinite(value) else 0.0
