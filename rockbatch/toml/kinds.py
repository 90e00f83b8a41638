"""What a value may be: each kind returns it as the program wants it, or says what was expected."""

import difflib
import json
import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from itertools import islice
from typing import Any

from rockbatch.files import legible
from rockbatch.units import LEAST, MOST

_LONGEST = 100  # characters of a word that others are compared with


class KindError(ValueError):
    """A value that cannot be used: what was expected, and the value that was probably meant."""

    def __init__(self, expected: str, meant: str | None = None) -> None:
        super().__init__(expected)
        self.meant = meant


Kind = Callable[[Any], Any]
"""Returns the value as the program wants it, or raises :class:`KindError`."""


def number(value: Any) -> float:
    """Any finite number; an integer will do, a boolean will not."""
    if isinstance(value, str):
        raise KindError("a number (without quotes)")
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise KindError("a number")
    try:
        converted = float(value)
    except OverflowError:
        converted = math.inf
    if not math.isfinite(converted):
        raise KindError("a finite number")
    if converted != 0 and not LEAST <= abs(converted) <= MOST:
        raise KindError(f"a number of the size {LEAST:g} to {MOST:g}")
    return converted


def positive(value: Any) -> float:
    """A number above 0."""
    if number(value) <= 0:
        raise KindError("a number above 0")
    return float(value)


def not_negative(value: Any) -> float:
    """A number, 0 or above."""
    if number(value) < 0:
        raise KindError("0 or a number above it")
    return float(value)


def nonzero(value: Any) -> float:
    """A number other than 0."""
    if number(value) == 0:
        raise KindError("a number other than 0")
    return float(value)


def count(value: Any) -> int:
    """A whole number from 1."""
    if isinstance(value, bool) or not isinstance(value, int) or value < 1:
        raise KindError("a whole number, 1 or above")
    return value


def boolean(value: Any) -> bool:
    """True or false."""
    if not isinstance(value, bool):
        raise KindError("true or false (without quotes)")
    return value


def text(value: Any) -> str:
    """Text that is not empty."""
    if not isinstance(value, str) or not value.strip():
        raise KindError("text in quotes")
    if legible(value, keep="\t\r\n") != value:
        raise KindError("text without control characters")
    return value


@dataclass(frozen=True)
class Choice:
    """One of a few words."""

    options: tuple[str, ...]

    def __call__(self, value: Any) -> str:
        if value not in self.options:
            meant = closest(value, self.options) if isinstance(value, str) else None
            raise KindError("one of " + ", ".join(map(shown, self.options)), meant and shown(meant))
        return str(value)


def choice(*options: str) -> Choice:
    """The kind of one of ``options``."""
    return Choice(options)


def closest(word: str, known: Iterable[str]) -> str | None:
    """The known word that ``word`` was probably meant to be, whatever its case."""
    by_lower = {name.lower(): name for name in known}
    found = difflib.get_close_matches(word[:_LONGEST].lower(), by_lower, n=1)
    return by_lower[found[0]] if found else None


def shown(value: Any, limit: int = 60) -> str:
    """The value as TOML writes it, cut where it is long, and legible whatever it holds."""
    if isinstance(value, bool):
        written = str(value).lower()
    elif isinstance(value, str):
        written = json.dumps(value[: limit + 1], ensure_ascii=False)  # TOML's basic strings are JSON's
    elif isinstance(value, list):
        written = "[" + ", ".join(map(shown, value[:limit])) + "]"
    elif isinstance(value, dict):
        written = "{ " + ", ".join(f"{key} = {shown(item)}" for key, item in islice(value.items(), limit)) + " }"
    elif isinstance(value, int) and value.bit_length() > 64:
        written = hex(value)  # Python refuses to write thousands of digits
    else:
        written = str(value)
    written = legible(written)
    return written if len(written) <= limit else written[: limit - 1] + "…"
