"""Verdicts in the terminal: a sign and a word for each, and a colour if the terminal has colours."""

import os
import sys

from rockbatch.checks.verdicts import DOES_NOT_APPLY, FAIL, NOT_DECIDED, PASS
from rockbatch.checks.wording import SIGNS

_COLOURS = {PASS: "32", FAIL: "31", NOT_DECIDED: "33"}  # green, red, amber
_LOUD = {FAIL: "FAIL", NOT_DECIDED: "NOT DECIDED"}
_PLAIN = {PASS: "+", FAIL: "x", NOT_DECIDED: "?", DOES_NOT_APPLY: "-"}


def mark(verdict: str) -> str:
    """Return sign and word of a verdict: "✗ FAIL"; the signs are plain ones if the terminal cannot show the others."""
    return f"{shown(SIGNS[verdict], _PLAIN[verdict])} {_LOUD.get(verdict, verdict)}"


def shown(text: str, instead: str) -> str:
    """Return ``text``, or ``instead`` if stdout cannot show it."""
    try:
        text.encode(sys.stdout.encoding or "ascii")
    except (UnicodeEncodeError, LookupError):
        return instead
    return text


def coloured(text: str, verdict: str) -> str:
    """Return ``text`` in the colour of a verdict, if stdout is a terminal and colours are not declined (NO_COLOR, TERM=dumb)."""
    plain = "NO_COLOR" in os.environ or os.environ.get("TERM") == "dumb" or not sys.stdout.isatty()
    return text if plain or verdict not in _COLOURS else f"\x1b[{_COLOURS[verdict]}m{text}\x1b[0m"
