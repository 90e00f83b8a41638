"""Output to the terminal.

Text may come from untrusted files: control characters are escaped (:func:`rockbatch.common.files.legible`). A stream that fails
or cannot encode a letter, stops nothing: the results are on disk.
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

_COLOURS = re.compile(r"(\x1b\[(?:0|31|32|33)m)")
"""Colours of verdicts, by their ANSI numbers."""

WIDTH = 100
"""Letters of a line of prose where the output goes to no terminal, and the most on one."""

_lost: dict[TextIO, OSError] = {}


def open_missing() -> None:
    """Open a stdout and a stderr if the program is started without: files that are opened later must not take their places."""
    for name in ("stdout", "stderr"):
        if getattr(sys, name) is None:
            setattr(sys, name, open(os.devnull, "w", encoding="utf-8"))  # noqa: SIM115


def say(text: str) -> None:
    """Print a message on stderr, apart from the output of a command."""
    tell(sys.stderr, text)


def show(text: str) -> None:
    """Print the output of a command on stdout."""
    tell(sys.stdout, text)


def tell(stream: TextIO | None, text: str) -> None:
    """Print ``text`` to a stream, as far as it can be written."""
    if stream is None or stream in _lost:
        return
    terminal = stream.isatty()
    parts = _COLOURS.split(_wrapped(text, shutil.get_terminal_size().columns)) if terminal else [text]
    safe = "".join(part if i % 2 else legible(part, keep="\n") for i, part in enumerate(parts))
    encoding = stream.encoding or "utf-8"
    try:
        print(safe.encode(encoding, "backslashreplace").decode(encoding), file=stream, flush=True)
    except OSError as error:
        give_up(stream, error)


def give_up(stream: TextIO, error: OSError) -> None:
    """Write nothing more to a stream that has failed: a pipe that its reader closed, a full disk."""
    _lost[stream] = error
    with suppress(OSError, ValueError):  # what is left in its buffer must not fail once more when it is closed
        os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())
    if stream is sys.stdout and error.errno != errno.EPIPE:
        tell(sys.stderr, f"the output cannot be printed ({error.strerror}); all else is still done")


def is_lost(stream: TextIO) -> bool:
    """Return whether something could not be printed there, and forget it."""
    return _lost.pop(stream, None) is not None


def shown(text: str, instead: str) -> str:
    """Return ``text``, or ``instead`` if stdout cannot show it."""
    try:
        text.encode(sys.stdout.encoding or "ascii")
    except (UnicodeEncodeError, LookupError):
        return instead
    return text


def coloured(text: str, colour: str | None) -> str:
    """Return ``text`` in a colour, by its number, if stdout is a terminal and colours are not declined (NO_COLOR, TERM=dumb)."""
    plain = "NO_COLOR" in os.environ or os.environ.get("TERM") == "dumb" or not sys.stdout.isatty()
    return text if plain or colour is None else f"\x1b[{colour}m{text}\x1b[0m"


def width() -> int | None:
    """Return the number of columns of the terminal; None if stdout is none."""
    return shutil.get_terminal_size().columns if sys.stdout.isatty() else None


def filled(text: str, first: int = 0, rest: int = 2) -> str:
    """Return prose in lines of the terminal's width, the first indented by ``first`` columns, all others by ``rest``."""
    lines = _in_lines(text, min(WIDTH, width() or WIDTH), " " * first, " " * rest)
    return shown(lines, lines.encode("ascii", "replace").decode())


def _in_lines(text: str, most: int, first: str, rest: str) -> str:
    """Return prose in lines of at most so many letters, if its words are not longer: these stay whole, for who copies a path."""
    return textwrap.fill(
        text, most, initial_indent=first, subsequent_indent=rest, break_long_words=False, break_on_hyphens=False
    )


def _wrapped(text: str, most: int) -> str:
    """Return text whose lines are no longer than ``most``, so that the terminal breaks no word; further lines are indented."""
    lines = []
    for line in text.split("\n"):
        indent = " " * (len(line) - len(line.lstrip(" ")))
        long = len(_COLOURS.sub("", line)) > most
        lines.append(_in_lines(line.lstrip(" "), most, indent, f"{indent}  ") if long else line)
    return "\n".join(lines)


def aligned(lines: Sequence[Sequence[str]], left: Collection[int] = (0,)) -> list[str]:
    """Return lines of cells as text, in columns of equal width: those at ``left`` flush left, the others right."""
    widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
    return [
        "  ".join(cell.ljust(w) if i in left else cell.rjust(w) for i, (cell, w) in enumerate(zip(line, widths, strict=True)))
        for line in lines
    ]  # fmt: skip


def in_width(
    head: Sequence[str],
    rows: Sequence[Sequence[str]],
    names: int = 1,
    left: Collection[int] = (),
    most: int = sys.maxsize,
) -> str:
    """Return a table as text: ``rows`` of cells below their heads.

    The first ``names`` columns, which name a row, and those at ``left`` are flush left, all others right. On a terminal,
    columns that do not fit stand below the others, beside the names again; these take at most half of its width. Elsewhere a line
    has ``most`` letters.
    """
    edge, left = width() or most, {*range(names), *left}
    lines = [
        [*(shortened(cell, edge // (2 * names)) for cell in line[:names]), *line[names:]] for line in (head, *rows)
    ]
    widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
    blocks = [list(range(names))]
    for place in range(names, len(head)):
        if len(blocks[-1]) > names and sum(widths[i] + 2 for i in blocks[-1]) + widths[place] > edge:
            blocks.append(list(range(names)))
        blocks[-1].append(place)
    tables = [
        aligned([[line[i] for i in block] for line in lines], [block.index(i) for i in block if i in left])
        for block in blocks
    ]
    return "\n\n".join("\n".join(line.rstrip() for line in table) for table in tables)


def shortened(text: str, room: int) -> str:
    """Return ``text`` with its middle left out if it is longer than ``room``; names differ at their ends."""
    return text if len(text) <= room else f"{text[: room // 4]}…{text[room // 4 + 1 - room :]}"
