"""Texts of headers, manifests and file names, made safe to print at the door."""

from dataclasses import is_dataclass, replace
from typing import TypeVar

from rockbatch.common.files import legible

T = TypeVar("T")


def with_legible_texts(record: T) -> T:
    """Return a dataclass with every text in it ``legible``, also in tuples and dataclasses within; itself if none changes."""
    changed = {name: new for name, value in vars(record).items() if (new := _legible(value)) is not value}
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
