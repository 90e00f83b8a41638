"""A parsed report: its tables, texts, links and pictures."""

import re
import xml.etree.ElementTree as ET
from html.parser import HTMLParser
from typing import NamedTuple

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
        if tag in ("td", "th"):
            row = self.tables[self.section][-1]
            row[-1] = row[-1].rstrip("\u2007\u2008")  # decimals that other rows have
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
    pictures, start, depth = [], 0, 0
    for tag in re.finditer(r"<(/?)svg\b", text):
        start = start if depth else tag.start()
        depth += -1 if tag[1] else 1  # a picture may hold others
        if depth == 0:
            pictures.append(ET.fromstring(text[start : tag.end() + 1]))
    return [svg for svg in pictures if "role" in svg.attrib]


class DotRow(NamedTuple):
    """A row of a picture of peaks: its words, what its marks say in each column, and what stands for runs without a peak."""

    words: str
    marks: list[list[str]]
    ends: list[str]
    role: str


def dot_rows(text: str, section: str = "answer") -> list[DotRow]:
    """Return the rows of the pictures of peaks in a section, without those that other folds hide."""
    own = text[text.index(f'<section id="{section}">') :].split("</section>")[0]
    rows = []
    for role, row in re.findall(r'<div class="row ?(\w*)"[^>]*>(.*?)</div>', own, re.DOTALL):
        strips = re.findall(r'<svg class="plot strip marks".*?</svg>', row, re.DOTALL)
        marks = [
            [re.sub(r"<[^>]+>", "", title).replace("\u00a0", " ") for title in re.findall(r"<title>(.*?)</title>", re.sub(
                r'<line[^>]*class="limit[^"]*".*?</line>', "", strip, flags=re.DOTALL), re.DOTALL)]
            for strip in strips
        ]  # fmt: skip
        words = Page(re.search(r'<span class="of".*?</span></span>|<span class="of".*?</span>', row, re.DOTALL)[0]).text
        ends = [Page(end).text for end in re.findall(r'<span class="ends">(.*?)</span>(?=<svg|$)', row, re.DOTALL)]
        rows.append(DotRow(words, marks, ends, role))
    return rows


def svg_texts(figure: ET.Element) -> list[str]:
    return ["".join(node.itertext()) for node in figure.iter() if node.tag.endswith("text")]
