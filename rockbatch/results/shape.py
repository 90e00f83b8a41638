"""Shapes that untrusted JSON must have before it is used.

A shape is a type (``str``, ``bool``, ``int``, ``float`` for any finite number), a tuple of shapes of which one has to fit
(``None`` among them), ``[shape]`` for a list of such, ``{str: shape}`` for an object with any keys, or an object of the keys
that are required, or optional if the shape is :class:`Maybe`. Other keys are not looked at.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import islice
from typing import Any, NamedTuple

MOST = 1e30
"""Bound of all numbers of results; arithmetic beyond it overflows."""

_WORDS = {str: "a text", bool: "true or false", int: "a whole number", float: "a number", None: "null"}


@dataclass(frozen=True)
class Maybe:
    """The shape of a key that can be missing."""

    shape: Any


class Misfit(NamedTuple):
    """A part that does not fit: its place, and what was expected there; ``str`` says both."""

    place: str
    expected: str
    missing: bool = False

    def __str__(self) -> str:
        place = self.place or "the whole"
        return f"{place} is missing" if self.missing else f"{place}: expected {self.expected}"


def unfit(value: Any, shape: Any, most: int | None = None) -> Iterator[Misfit]:
    """Return the first ``most`` parts of ``value`` that do not fit; none if all of it does."""
    return islice(_unfit(value, shape, ""), most)


def fits(value: Any, shape: Any) -> bool:
    """Return True if all of ``value`` fits."""
    return next(unfit(value, shape), None) is None


def _unfit(value: Any, shape: Any, place: str) -> Iterator[Misfit]:
    if isinstance(shape, dict):
        yield from _unfit_object(value, shape, place)
    elif isinstance(shape, list):
        if not isinstance(value, list):
            yield Misfit(place, "a list")
            return
        for number, item in enumerate(value):
            yield from _unfit(item, shape[0], f"{place}[{number}]")
    elif isinstance(shape, tuple):
        if not any(
            fits(value, choice) if isinstance(choice, list | dict) else _is_a(value, choice) for choice in shape
        ):
            yield Misfit(place, " or ".join(map(_words, shape)))
    elif not _is_a(value, shape):
        yield Misfit(place, _words(shape))


def _unfit_object(value: Any, shape: dict[Any, Any], place: str) -> Iterator[Misfit]:
    if not isinstance(value, dict):
        yield Misfit(place, "an object")
        return
    if str in shape:
        for key, item in value.items():
            yield from _unfit(item, shape[str], f"{place}.{key[:40]}")
        return
    for key, expected in shape.items():
        if key in value:
            expected = expected.shape if isinstance(expected, Maybe) else expected
            if not _soon(value[key], expected):
                yield from _unfit(value[key], expected, f"{place}.{key}" if place else key)
        elif not isinstance(expected, Maybe):
            yield Misfit(f"{place}.{key}" if place else key, "", missing=True)


def _soon(value: Any, shape: Any) -> bool:
    """Return True if the single ``value`` fits ``kind``; fast, since there are millions."""
    if type(shape) is tuple:
        shape = shape[0]
    if shape is float:
        return type(value) is float and -MOST < value < MOST
    return shape is str and type(value) is str


def _is_a(value: Any, kind: Any) -> bool:
    if kind is None or kind is bool or kind is str:
        return value is None if kind is None else isinstance(value, kind)
    if isinstance(kind, str):
        return bool(value == kind)
    if isinstance(value, bool) or not isinstance(value, int if kind is int else int | float):
        return False
    return abs(value) < MOST and math.isfinite(value)


def _words(shape: Any) -> str:
    if isinstance(shape, list | dict):
        return "a list" if isinstance(shape, list) else "an object"
    return f'"{shape}"' if isinstance(shape, str) else _WORDS[shape]
