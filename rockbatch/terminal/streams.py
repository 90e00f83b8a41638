"""Print to the terminal.

Text may come from untrusted files, so control characters are escaped (:func:`rockbatch.common.files.legible`). A stream that
fails, or cannot encode a character, does not stop a command: results are on disk.
"""

import errno
import os
import re
import shutil
import sys
import textwrap
from collections.abc import Collection, Sequence
from contextlib import suppress
from typing import TextIO

from rockbatch.common.files import legible
from rockbatch.common.grouping import grouped

_COLOURS = re.compile(r"(\x1b\[(?:0|31|32|33)m)")
"""ANSI escape sequences of the colours of verdicts."""

WIDTH = 100
"""Characters in a line of prose: the number outside a terminal, and the maximum in one."""

_GREEK = "alpha beta epsilon zeta eta theta lambda mu nu psi omega"
PLAIN = dict(zip("αβεζηθλμνψω", _GREEK.split(), strict=True)) | {
    "✓": "+",
    "✗": "x",
    "–": "-",
    "≤": "<=",
    "≥": ">=",
    "∞": "inf",
    "…": "...",
    "·": "*",
    "×": "x",
    "²": "2",
    "³": "3",
}
"""ASCII replacements for characters that a terminal cannot show: signs, and the letters of the field."""

_lost: dict[TextIO, OSError] = {}


def open_missing() -> None:
    """Open stdout and stderr on the null device if missing, so that files opened later do not take their descriptors."""
    for name in ("stdout", "stderr"):
        if getattr(sys, name) is None:
            setattr(sys, name, open(os.devnull, "w", encoding="utf-8"))  # noqa: SIM115


def say(text: str) -> None:
    """Print a message on stderr, separate from the output of a command."""
    tell(sys.stderr, text)


def show(text: str) -> None:
    """Print the output of a command on stdout."""
    tell(sys.stdout, text)


def tell(stream: TextIO | None, text: str) -> None:
    """Print ``text`` and a line break to a stream; give the stream up if it fails.

    Escapes stand for control characters and those it cannot encode; lines are wrapped to the width of a terminal. A stream that
    is None, or was given up, gets nothing.
    """
    if stream is None or stream in _lost:
        return
    terminal = stream.isatty()
    parts = _COLOURS.split(_wrapped(text, shutil.get_terminal_size().columns)) if terminal else [text]
    safe = "".join(part if i % 2 else legible(part, keep="\n") for i, part in enumerate(parts)).replace("\u00a0", " ")
    encoding = stream.encoding or "utf-8"
    try:
        print(safe.encode(encoding, "backslashreplace").decode(encoding), file=stream, flush=True)
    except OSError as error:
        give_up(stream, error)


def give_up(stream: TextIO, error: OSError) -> None:
    """Stop writing to a stream that failed, as a pipe closed by its reader; say so of stdout if it failed otherwise."""
    _lost[stream] = error
    with suppress(OSError, ValueError):  # its remaining buffer must not fail again on closing
        os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())
    if stream is sys.stdout and error.errno != errno.EPIPE:
        tell(sys.stderr, f"the output cannot be printed ({error.strerror}); the command continues")


def is_lost(stream: TextIO) -> bool:
    """Return whether a stream was given up after it failed, and forget that."""
    return _lost.pop(stream, None) is not None


def shown(text: str, instead: str) -> str:
    """Return ``text``, or ``instead`` if stdout cannot show it."""
    try:
        text.encode(sys.stdout.encoding or "ascii")
    except (UnicodeEncodeError, LookupError):
        return instead
    return text


def showable(text: str) -> str:
    """Return ``text`` with plain spaces, and :data:`PLAIN` words for those of their characters that stdout cannot show."""
    for sign, plain in PLAIN.items():
        text = text.replace(sign, shown(sign, plain)) if sign in text else text
    return text.replace("\u00a0", " ")


def coloured(text: str, colour: str | None) -> str:
    """Return ``text`` in an ANSI ``colour`` such as "31"; plain for None, NO_COLOR, TERM=dumb, or if stdout is no terminal."""
    plain = "NO_COLOR" in os.environ or os.environ.get("TERM") == "dumb" or not sys.stdout.isatty()
    return text if plain or colour is None else f"\x1b[{colour}m{text}\x1b[0m"


def width() -> int | None:
    """Return the number of columns of the terminal; None if stdout is not a terminal."""
    return shutil.get_terminal_size().columns if sys.stdout.isatty() else None


def filled(text: str, first: int = 0, rest: int = 2) -> str:
    """Return prose wrapped to the terminal's width, 100 columns at most.

    The first line is indented by ``first`` columns, the others by ``rest``. If stdout cannot show a character, all beyond ASCII
    become "?".
    """
    lines = _in_lines(text, min(WIDTH, width() or WIDTH), " " * first, " " * rest)
    return shown(lines, lines.encode("ascii", "replace").decode())


def _in_lines(text: str, most: int, first: str, rest: str) -> str:
    """Return prose, its line breaks as blanks, wrapped to lines of at most ``most`` characters; longer words stay whole."""
    return textwrap.fill(
        text, most, initial_indent=first, subsequent_indent=rest, break_long_words=False, break_on_hyphens=False
    )


def _wrapped(text: str, most: int) -> str:
    """Return text with lines longer than ``most`` wrapped at words, continuation lines indented by two more columns."""
    lines = []
    for line in text.split("\n"):
        indent = " " * (len(line) - len(line.lstrip(" ")))
        long = len(_COLOURS.sub("", line)) > most
        lines.append(_in_lines(line.lstrip(" "), most, indent, f"{indent}  ") if long else line)
    return "\n".join(lines)


def aligned(lines: Sequence[Sequence[str]], left: Collection[int] = (0,)) -> list[str]:
    """Return lines of cells as text in columns two blanks apart, those at ``left`` flush left, the others flush right.

    Cells are made :func:`showable`.
    """
    lines = [list(map(showable, line)) for line in lines]
    widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
    pads = [str.ljust if i in left else str.rjust for i in range(len(widths))]
    return ["  ".join(pad(cell, w) for pad, cell, w in zip(pads, line, widths, strict=True)) for line in lines]


def in_width(
    head: Sequence[str],
    rows: Sequence[Sequence[str]],
    names: int = 1,
    left: Collection[int] = (),
) -> str:
    """Return a table as text: ``rows`` of cells below their heads.

    The first ``names`` columns, which identify a row, and those at ``left`` are flush left, the others flush right. Columns
    beyond the terminal's width follow in a further table, with the names repeated; names take at most half of the width.
    Outside a terminal lines have any length.
    """
    edge, left = width() or sys.maxsize, {*range(names), *left}
    lines = [list(map(showable, line)) for line in (head, *rows)]
    for place in range(names):
        for line, cell in zip(lines, shortened([line[place] for line in lines], edge // (2 * names)), strict=True):
            line[place] = cell
    widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
    blocks = [list(range(names))]
    for place in range(names, len(head)):
        if len(blocks[-1]) > names and sum(widths[i] + 2 for i in blocks[-1]) + widths[place] > edge:
            blocks.append(list(range(names)))
        blocks[-1].append(place)
    tables = []
    for block in blocks:
        flush_left = [block.index(i) for i in block if i in left]
        tables.append(aligned([[line[i] for i in block] for line in lines], flush_left))
    return "\n\n".join("\n".join(line.rstrip() for line in table) for table in tables)


def shortened(texts: Sequence[str], room: int) -> list[str]:
    """Return texts of at most ``room`` characters, so far as texts that differ still do: "…" replaces what is left out.

    Of a longer one the middle goes, since names differ at their ends; of several that would then read alike, the parts between
    commas that all of them have. If neither tells them apart, the room grows.
    """
    while True:
        short = {text: _cut(text, room) for text in texts}
        for alike in grouped(short, short.__getitem__).values():
            if len(alike) > 1:
                short |= {text: _cut(apart, room) for text, apart in zip(alike, _parts_apart(alike), strict=True)}
        if len(set(short.values())) == len(short):
            return [short[text] for text in texts]
        room += 1


def _cut(text: str, room: int) -> str:
    """Return ``text`` with its middle replaced by "…" if it is longer than ``room``."""
    return text if len(text) <= room else f"{text[: room // 4]}…{text[room // 4 + 1 - room :]}"


def _parts_apart(texts: Sequence[str]) -> list[str]:
    """Return each text without the parts between commas that all ``texts`` have, each run of them replaced by "…"."""
    parts = [text.split(", ") for text in texts]
    shared = set(parts[0]).intersection(*parts[1:])
    own = [["…" if part in shared else part for part in of_text] for of_text in parts]
    return [
        ", ".join(part for i, part in enumerate(of_text) if part != "…" or of_text[i - 1 : i] != ["…"])
        for of_text in own
    ]
