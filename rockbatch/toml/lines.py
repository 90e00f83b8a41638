"""Lines of the keys of a TOML text."""

import re
import tomllib

KeyPath = tuple[str | int, ...]
"""Place of a value: keys and list indices from the top, such as ("case", 1, "beta", 0)."""


_DEEPEST = 32  # tables and lists within one another
_MOST_ELEMENTS = 10_000  # of a list whose lines are kept; the others are where the list begins

# A file takes time in proportion to its size, whatever it holds: characters are possessive (*+), and groups end in one way only.
# Groups are not possessive: Python 3.11.2 does not go back to where an iteration began that fails.
_STRING = "|".join(
    (
        r'"""[^"\\]*+(?:(?:\\.|"{1,2}(?!"))[^"\\]*+)*"""(?:"{0,2})',  # one or two quotes may stand before the closing three
        r"'''[^']*+(?:'{1,2}(?!')[^']*+)*'''(?:'{0,2})",
        r'"[^"\\\n]*+(?:\\.[^"\\\n]*+)*"',
        r"'[^'\n]*+'",
    )
)
_TOKENS = {
    "string": re.compile(_STRING, re.DOTALL),
    "key": re.compile(rf"[A-Za-z0-9_-]+|{_STRING}", re.DOTALL),
    "space": re.compile(r"[ \t]*"),
    "blank": re.compile(r"[ \t\r\n]*+(?:#[^\n]*+[ \t\r\n]*+)*"),
    "plain": re.compile(r"[^,\]}#\n]*"),  # a number, a boolean or a date
}


class TooDeepError(ValueError):
    """Tables or lists within one another, deeper than any study or manifest has them."""


def key_lines(text: str) -> dict[KeyPath, int]:
    """Return the line (from 1) of every table and key in ``text``, and of the first 10 000 elements of each list.

    Raises :class:`TooDeepError` for a place more than 32 deep, ``ValueError`` where the scan cannot go on; other mistakes are
    left to the parser.
    """
    scan = _Scan(text)
    scan.document()
    return scan.lines


class _Scan:
    """One pass over a text, position by position, that notes the line of every place."""

    def __init__(self, text: str) -> None:
        self.text = text
        self.here = 0
        self.counted, self.lines_above = 0, 0  # number of line ends before position `counted`
        self.lines: dict[KeyPath, int] = {}
        self.last_element: dict[KeyPath, int] = {}  # of each array of tables

    def take(self, token: str) -> str:
        """Return the text at this position that matches ``token``, a name of _TOKENS, and move behind it; else ``ValueError``."""
        match = _TOKENS[token].match(self.text, self.here)
        if match is None:
            raise ValueError(f"line {self.line()}: not valid TOML")
        self.here = match.end()
        return match.group()

    def peek(self) -> str:
        """Return the next character; empty at the end."""
        return self.text[self.here : self.here + 1]

    def line(self) -> int:
        """Return the line of this position, from 1; only the text since the last call is searched for line ends."""
        self.lines_above += self.text.count("\n", self.counted, self.here)
        self.counted = self.here
        return self.lines_above + 1

    def mark(self, key_path: KeyPath, line: int) -> None:
        """Keep the line of a place, and of the tables that a dotted key implies, unless one is kept already.

        Raises :class:`TooDeepError` for a place more than 32 deep.
        """
        if len(key_path) > _DEEPEST:
            raise TooDeepError(f"line {line}: tables or lists within one another, more than {_DEEPEST} deep")
        for depth in range(1, len(key_path) + 1):
            self.lines.setdefault(key_path[:depth], line)

    def document(self) -> None:
        """Scan the whole text, filling ``lines``.

        Raises ``ValueError`` where it cannot go on, as in an unclosed text, and :class:`TooDeepError`, a kind of it; other
        mistakes are left to the parser.
        """
        table: KeyPath = ()
        while self.take("blank") is not None and self.here < len(self.text):
            if self.peek() == "[":
                table = self.header()
            else:
                self.pair(table)

    def header(self) -> KeyPath:
        """Scan "[a.b]" or "[[a.b]]", keep its line, and return its place, with an index behind each array of tables."""
        line = self.line()
        brackets = 2 if self.text.startswith("[[", self.here) else 1
        self.here += brackets
        name = self.dotted_key()
        self.here += brackets
        key_path: KeyPath = ()
        for depth, part in enumerate(name, 1):
            key_path += (part,)
            if brackets == 2 and depth == len(name):
                self.last_element[key_path] = self.last_element.get(key_path, -1) + 1
            if key_path in self.last_element:
                key_path += (self.last_element[key_path],)
        self.mark(key_path, line)
        self.lines[key_path] = line
        return key_path

    def pair(self, table: KeyPath) -> None:
        """Scan a key of a table with its value, and keep its line."""
        line = self.line()
        key_path = table + self.dotted_key()
        self.mark(key_path, line)
        self.here += 1  # the equals sign
        self.value(key_path)

    def dotted_key(self) -> tuple[str, ...]:
        """Scan a key, and return its parts, without quotes."""
        parts = []
        while True:
            self.take("space")
            part = self.take("key")
            parts.append(tomllib.loads(f"x = {part}")["x"] if part[0] in "\"'" else part)
            self.take("space")
            if self.peek() != "." or len(parts) > _DEEPEST:
                return tuple(parts)
            self.here += 1

    def value(self, key_path: KeyPath) -> None:
        """Scan a value, and keep the lines of the places within it."""
        self.take("space")
        if self.peek() in ("[", "{"):
            self.items(key_path, inline_table=self.peek() == "{")
        else:
            self.take("string" if self.peek() in ('"', "'") else "plain")

    def items(self, key_path: KeyPath, *, inline_table: bool) -> None:
        """Scan an array, or an inline table, with its brackets; keep lines of its elements, of plain ones the first 10 000."""
        self.here += 1
        index = 0
        while self.take("blank") is not None and self.peek() not in ("]", "}"):
            if not self.peek():
                raise ValueError(f"line {self.line()}: not valid TOML")
            if inline_table:
                self.pair(key_path)
            elif index < _MOST_ELEMENTS or self.peek() in ("[", "{"):
                self.mark((*key_path, index), self.line())
                self.value((*key_path, index))
            else:
                self.value(key_path)
            index += 1
            self.take("blank")
            if self.peek() == ",":
                self.here += 1
        self.here += 1
