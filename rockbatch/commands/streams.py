"""Output to the terminal.

Text may come from anybody's files, so that what a terminal would obey is written out (:func:`rockbatch.files.legible`); and a
stream that takes no more, or cannot write a letter, ends nothing: the results are on the disk.
"""

import errno
import os
import re
import sys
from contextlib import suppress
from typing import TextIO

from rockbatch.files import legible

_COLOURS = re.compile(r"(\x1b\[(?:0|31|32|33)m)")
"""Colours of verdicts, which a terminal gets as they are."""

_lost: dict[TextIO, OSError] = {}


def open_missing() -> None:
    """Open a stdout and a stderr if the program is started without: files that are opened later must not take their places."""
    for name in ("stdout", "stderr"):
        if getattr(sys, name) is None:
            setattr(sys, name, open(os.devnull, "w", encoding="utf-8"))  # noqa: SIM115


def tell(stream: TextIO | None, text: str) -> None:
    """Print ``text`` to a stream, as far as that can take it."""
    if stream is None or stream in _lost:
        return
    parts = _COLOURS.split(text) if stream.isatty() else [text]
    safe = "".join(part if i % 2 else legible(part, keep="\n") for i, part in enumerate(parts))
    encoding = stream.encoding or "utf-8"
    try:
        print(safe.encode(encoding, "backslashreplace").decode(encoding), file=stream, flush=True)
    except OSError as error:
        give_up(stream, error)


def give_up(stream: TextIO, error: OSError) -> None:
    """Write nothing more to a stream that has failed: a pipe whose reader has seen enough, a full disk."""
    _lost[stream] = error
    with suppress(OSError, ValueError):  # what is left in its buffer must not fail once more when it is closed
        os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())
    if stream is sys.stdout and error.errno != errno.EPIPE:
        tell(sys.stderr, f"what was asked for cannot be printed ({error.strerror}); the rest is done all the same")


def is_lost(stream: TextIO) -> bool:
    """Return whether something could not be printed there, and forget it."""
    return _lost.pop(stream, None) is not None
