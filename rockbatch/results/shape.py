"""Check untrusted JSON against the shape that it must have.

A shape is a type (``str``, ``bool``, ``int``, ``float`` for any finite number), a tuple of alternatives (``None`` or texts among
them), ``[shape]`` for a list, ``{str: shape}`` for an object with any keys, or an object with the shapes of its keys, which
are optional if :class:`Maybe`. Further keys are ignored.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial
from itertools import islice
from typing import NamedTuple

MOST = 1e30
"""Largest number allowed; arithmetic with larger ones may overflow."""

_WORDS: dict[object, str] = {
    str: "a text",
    bool: "true or false",
    int: "a whole number",
    float: "a number",
    None: "null",
}


@dataclass(frozen=True)
class Maybe:
    """The shape of a key that may be missing."""

    shape: object


class Misfit(NamedTuple):
    """A part that does not fit: its place and the expected shape in words; ``str`` combines them."""

    place: str
    expected: str
    missing: bool = False

    def __str__(self) -> str:
        place = self.place or "the whole"
        return f"{place} is missing" if self.missing else f"{place}: expected {self.expected}"


def unfit(value: object, shape: object, most: int | None = None) -> Iterator[Misfit]:
    """Yield the parts of ``value`` that do not fit ``shape``, at most ``most``; all for None."""
    return islice(_unfit(value, shape, ""), most)


def fits(value: object, shape: object) -> bool:
    """Return whether ``value``, read from JSON, has all the parts of ``shape``, of its types."""
    return next(unfit(value, shape), None) is None


def _unfit(value: object, shape: object, place: str) -> Iterator[Misfit]:
    """Yield the parts of ``value`` that do not fit; ``place`` is its path, "" for the whole."""
    if isinstance(shape, dict):
        yield from _unfit_object(value, shape, place)
    elif isinstance(shape, list):
        if not isinstance(value, list):
            yield Misfit(place, "a list")
            return
        for number, item in enumerate(value):
            yield from _unfit(item, shape[0], f"{place}[{number}]")
    elif isinstance(shape, tuple):
        if not any(map(partial(fits, value), shape)):
            yield Misfit(place, " or ".join(map(_words, shape)))
    elif not _is_a(value, shape):
        yield Misfit(place, _words(shape))


def _unfit_object(value: object, shape: dict[object, object], place: str) -> Iterator[Misfit]:
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
            if not _fits_at_once(value[key], expected):
                yield from _unfit(value[key], expected, f"{place}.{key}" if place else str(key))
        elif not isinstance(expected, Maybe):
            yield Misfit(f"{place}.{key}" if place else str(key), "", missing=True)


def _fits_at_once(value: object, shape: object) -> bool:
    """Return True if the first alternative of ``shape`` is float and ``value`` a float below MOST, or str and a text; else
    False.

    False leaves the decision to :func:`_unfit`, also on what fits. A shortcut, since files may hold millions of numbers.
    """
    if type(shape) is tuple:
        shape = shape[0]
    if shape is float:
        return type(value) is float and -MOST < value < MOST
    return shape is str and type(value) is str


def _is_a(value: object, kind: object) -> bool:
    """Return whether ``value`` is None, of type ``kind``, or equal to the text ``kind``, as ``kind`` is one of these.

    Numbers are finite and less than :data:`MOST`; an int is a float, too, and a bool no number.
    """
    if kind is None:
        return value is None
    if kind is bool or kind is str:
        return isinstance(value, bool if kind is bool else str)
    if isinstance(kind, str):
        return value == kind
    if isinstance(value, bool) or not isinstance(value, int if kind is int else int | float):
        return False
    return abs(value) < MOST and math.isfinite(value)


def _words(shape: object) -> str:
    """Return a shape in words: "a list", "a number", or a text in quotation marks."""
    if isinstance(shape, list | dict):
        return "a list" if isinstance(shape, list) else "an object"
    return f'"{shape}"' if isinstance(shape, str) else _WORDS[shape]
