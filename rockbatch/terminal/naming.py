"""Values of the keys that a study varies, in a word each."""

from collections.abc import Iterable
from typing import Any


def named(keys: Iterable[str], values: Iterable[Any]) -> str:
    """Return ``beta=40 eta=2.5``, without keys that do not apply."""
    pairs = [(key, value) for key, value in zip(keys, values, strict=True) if value == value and value != ""]
    return " ".join(f"{key}={value}" if isinstance(value, str) else f"{key}={value:g}" for key, value in pairs)
