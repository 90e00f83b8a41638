"""A parsed report: its tables, texts, links and pictures."""

import re
import xml.etree.ElementTree as ET
from html.parser import HTMLParser

VOID = {"meta", "br", "img", "input", "link"}


class Page(HTMLParser):
    """Parser of a page: every table as rows of texts, and elements that are not closed in order."""

    def __init__(self, text: str) -> None:
        super().__init__(convert_charrefs=True)
        self.tags: list[str] = []
        self.attributes: list[tuple[str, str | None]] = []
        self.open: list[str] = []
        self.mismatched: list[str] = []
        self.tables: dict[str, list[list[str]]] = {}
        self.headings: list[str] = []
        self.words: list[str] = []
        self.section = ""
        self.feed(text)
        self.close()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        self.attributes += attrs
        if tag not in VOID:
            self.open.append(tag)
        if tag == "section":
            self.section = dict(attrs)["id"] or ""
        if tag == "h2":
            self.headings.append("")
        if tag == "tr":
            self.tables.setdefault(self.section, []).append([])
        if tag in ("td", "th"):
            self.tables[self.section][-1].append("")

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        self.attributes += attrs

    def handle_endtag(self, tag: str) -> None:
        if not self.open or self.open.pop() != tag:
            self.mismatched.append(tag)

    def handle_data(self, data: str) -> None:
        if "pre" not in self.open:
            data = re.sub(r" *\n *", " ", data)
        if "style" not in self.open and "script" not in self.open:
            self.words.append(data)
        if "td" in self.open or "th" in self.open:
            self.tables[self.section][-1][-1] += data
        if "h2" in self.open:
            self.headings[-1] += data

    @property
    def links(self) -> set[str]:
        return {value or "" for name, value in self.attributes if name in ("src", "href", "xlink:href")}

    @property
    def text(self) -> str:
        return "".join(self.words).replace("\u00a0", " ")


def figures(text: str) -> list[ET.Element]:
    """Return the inline pictures, but for those of legends; raises if one is not well-formed XML."""
    return [
        svg for svg in map(ET.fromstring, re.findall(r"<svg.*?</svg>", text, flags=re.DOTALL)) if "role" in svg.attrib
    ]


def panels(text: str) -> list[ET.Element]:
    """Return the pictures of peak rotations, one for each ground motion, scale and pier."""
    return [svg for svg in figures(text) if {"marks", "strip"} & set(svg.attrib["class"].split()) == {"marks"}]


def svg_texts(figure: ET.Element) -> list[str]:
    return ["".join(node.itertext()) for node in figure.iter() if node.tag.endswith("text")]
