"""Texts of headers, manifests and file names, made safe to print at the door."""

from dataclasses import is_dataclass, replace
from typing import TypeVar

import numpy as np

from rockbatch.common.files import legible

T = TypeVar("T")

_WITHOUT_TEXT = {float, int, bool, type(None), np.ndarray}
"""Types that are passed over first, since every component has a dozen such values."""


def with_legible_texts(record: T) -> T:
    """Return a dataclass with every text in it ``legible``, also in tuples and dataclasses within; itself if none changes."""
    values = ((name, value) for name, value in vars(record).items() if type(value) not in _WITHOUT_TEXT)
    changed = {name: new for name, value in values if (new := _legible(value)) is not value}
    return replace(record, **changed) if changed else record  # type: ignore[type-var]


def _legible(value: object) -> object:
    """Return a field's value with its texts ``legible``; the same object if none changes."""
    if isinstance(value, str):
        shown = legible(value)
        return value if shown == value else shown
    if type(value) is tuple:
        members = tuple(map(_legible, value))
        return value if all(new is old for new, old in zip(members, value, strict=True)) else members
    return with_legible_texts(value) if is_dataclass(value) else value
