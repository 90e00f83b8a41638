"""Texts of headers, manifests and names of files, which go no further than the reader as they are."""

from dataclasses import is_dataclass, replace
from typing import Any, TypeVar, cast

from rockbatch.common.files import legible

T = TypeVar("T")


def with_legible_texts(record: T) -> T:
    """Return a dataclass with every text in it ``legible``, also those of tuples and of dataclasses within."""
    changed = {name: new for name, value in vars(record).items() if (new := _legible(value)) is not value}
    return cast(T, replace(cast(Any, record), **changed)) if changed else record


def _legible(value: Any) -> Any:
    """Return the value itself where nothing in it had to be changed."""
    if isinstance(value, str):
        shown = legible(value)
        return value if shown == value else shown
    if type(value) is tuple:
        shown_each = tuple(map(_legible, value))
        return value if all(new is old for new, old in zip(shown_each, value, strict=True)) else shown_each
    return with_legible_texts(value) if is_dataclass(value) else value
