"""Lines of the keys of a TOML text."""

import re
import tomllib

At = tuple[str | int, ...]
"""Place of a value: keys and list indices from the top, such as ("case", 1, "beta", 0)."""


_DEEPEST = 32  # tables and lists within one another
_MOST_ELEMENTS = 10_000  # of a list whose lines are kept; the others are where the list begins

# possessive throughout (++, *+): a file takes time in proportion to its size, whatever it holds
_STRING = "|".join(
    (
        r'"""(?:[^"\\]++|\\.|"{1,2}(?!"))*+"""(?:"{0,2})',  # one or two quotes may stand before the closing three
        r"'''(?:[^']++|'{1,2}(?!'))*+'''(?:'{0,2})",
        r'"(?:[^"\\\n]++|\\.)*+"',
        r"'[^'\n]*+'",
    )
)
_TOKENS = {
    "string": re.compile(_STRING, re.DOTALL),
    "key": re.compile(rf"[A-Za-z0-9_-]+|{_STRING}", re.DOTALL),
    "space": re.compile(r"[ \t]*"),
    "blank": re.compile(r"(?:[ \t\r\n]++|#[^\n]*+)*+"),
    "plain": re.compile(r"[^,\]}#\n]*"),  # a number, a boolean or a date
}


class TooDeepError(ValueError):
    """Tables or lists within one another, deeper than any study or manifest has them."""


def key_lines(text: str) -> dict[At, int]:
    """Return the line (from 1) of every table, key and list element in ``text``.

    Raises :class:`TooDeepError` before a parser would be long over it, ``ValueError`` where the text is no TOML.
    """
    scan = _Scan(text)
    scan.document()
    return scan.lines


class _Scan:
    def __init__(self, text: str) -> None:
        self.text = text
        self.here = 0
        self.counted, self.lines_above = 0, 0  # up to here there are so many line ends
        self.lines: dict[At, int] = {}
        self.last_element: dict[At, int] = {}  # of each array of tables

    def take(self, token: str) -> str:
        match = _TOKENS[token].match(self.text, self.here)
        if match is None:
            raise ValueError(f"line {self.line()}: not valid TOML")
        self.here = match.end()
        return match.group()

    def peek(self) -> str:
        return self.text[self.here : self.here + 1]

    def line(self) -> int:
        self.lines_above += self.text.count("\n", self.counted, self.here)
        self.counted = self.here
        return self.lines_above + 1

    def mark(self, at: At, line: int) -> None:
        """Note the line of a place, and of the tables on the way that dotted keys imply."""
        if len(at) > _DEEPEST:
            raise TooDeepError(f"line {line}: tables or lists within one another, more than {_DEEPEST} deep")
        for depth in range(1, len(at) + 1):
            self.lines.setdefault(at[:depth], line)

    def document(self) -> None:
        table: At = ()
        while self.take("blank") is not None and self.here < len(self.text):
            if self.peek() == "[":
                table = self.header()
            else:
                self.pair(table)

    def header(self) -> At:
        line = self.line()
        brackets = 2 if self.text.startswith("[[", self.here) else 1
        self.here += brackets
        name = self.dotted_key()
        self.here += brackets
        at: At = ()
        for depth, part in enumerate(name, 1):
            at += (part,)
            if brackets == 2 and depth == len(name):
                self.last_element[at] = self.last_element.get(at, -1) + 1
            if at in self.last_element:
                at += (self.last_element[at],)
        self.mark(at, line)
        self.lines[at] = line
        return at

    def pair(self, table: At) -> None:
        line = self.line()
        at = table + self.dotted_key()
        self.mark(at, line)
        self.here += 1  # the equals sign
        self.value(at)

    def dotted_key(self) -> tuple[str, ...]:
        parts = []
        while True:
            self.take("space")
            part = self.take("key")
            parts.append(tomllib.loads(f"x = {part}")["x"] if part[0] in "\"'" else part)
            self.take("space")
            if self.peek() != "." or len(parts) > _DEEPEST:
                return tuple(parts)
            self.here += 1

    def value(self, at: At) -> None:
        self.take("space")
        if self.peek() in ("[", "{"):
            self.items(at, inline_table=self.peek() == "{")
        else:
            self.take("string" if self.peek() in ('"', "'") else "plain")

    def items(self, at: At, *, inline_table: bool) -> None:
        self.here += 1
        index = 0
        while self.take("blank") is not None and self.peek() not in ("]", "}"):
            if not self.peek():
                raise ValueError(f"line {self.line()}: not valid TOML")
            if inline_table:
                self.pair(at)
            elif index < _MOST_ELEMENTS or self.peek() in ("[", "{"):
                self.mark((*at, index), self.line())
                self.value((*at, index))
            else:
                self.value(at)
            index += 1
            self.take("blank")
            if self.peek() == ",":
                self.here += 1
        self.here += 1
