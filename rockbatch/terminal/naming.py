"""Varied values of a study in words."""

from collections.abc import Iterable
from typing import Any

from rockbatch.results.labels import of_device


def named(keys: Iterable[str], values: Iterable[Any]) -> str:
    """Return keys and values as "beta=40 damper 2 f=0.05", without those that are NaN or ""."""
    pairs = [(_words(key), value) for key, value in zip(keys, values, strict=True) if value == value and value != ""]
    return " ".join(f"{key}={value}" if isinstance(value, str) else f"{key}={value:g}" for key, value in pairs)


def _words(key: str) -> str:
    """Return a key in words, behind the device that has it: "damper 2 f"; a key of no device as it is."""
    device = of_device(key)
    return key if device is None else f"{device.words} {device.key}"
