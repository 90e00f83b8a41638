"""Varied values of a study in words."""

from collections.abc import Iterable
from typing import Any


def named(keys: Iterable[str], values: Iterable[Any]) -> str:
    """Return keys and values as "beta=40 eta=2.5", without those that are NaN or ""."""
    pairs = [(key, value) for key, value in zip(keys, values, strict=True) if value == value and value != ""]
    return " ".join(f"{key}={value}" if isinstance(value, str) else f"{key}={value:g}" for key, value in pairs)
