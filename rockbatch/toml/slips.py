"""The message about a text that is not TOML."""

import re
from pathlib import Path

from rockbatch.common.files import legible

_LONGEST = 80  # characters of a reason, and of a line, that are shown

_RULES = "texts stand in quotes, decimals behind a point, and a number alone; [[…]] above each of several tables"


def syntax_error(path: Path, text: str, error: str) -> str:
    """Return the message about a text that the parser refuses with ``error``: the line, its text, and the rules of TOML."""
    place = re.search(r" *\(at (?:line (\d+), column \d+|end of document)\)", error)
    reason = error[: place.start()] if place else error
    lines = text.split("\n")
    number = int(place[1]) if place and place[1] else max(1, len(text.rstrip().split("\n")))
    because = legible(f"{reason[:1].lower()}{reason[1:_LONGEST]}")
    return f"{path}:{number}: not valid TOML: {because}: {legible(lines[number - 1].strip()[:_LONGEST])}; {_RULES}"
