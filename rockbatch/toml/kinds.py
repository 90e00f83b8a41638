"""What a value may be: each kind returns it as the program wants it, or says what was expected."""

import difflib
import json
import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any


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
    found = difflib.get_close_matches(word.lower(), by_lower, n=1)
    return by_lower[found[0]] if found else None


def shown(value: Any, limit: int = 60) -> str:
    """The value as TOML writes it, cut where it is long."""
    if isinstance(value, bool):
        written = str(value).lower()
    elif isinstance(value, str):
        written = json.dumps(value, ensure_ascii=False)  # TOML's basic strings are JSON's
    elif isinstance(value, list):
        written = "[" + ", ".join(map(shown, value)) + "]"
    elif isinstance(value, dict):
        written = "{ " + ", ".join(f"{key} = {shown(item)}" for key, item in value.items()) + " }"
    else:
        written = str(value)
    return written if len(written) <= limit else written[: limit - 1] + "…"
