"""Types of the arguments of public functions and classes, checked by their annotations."""

import functools
import inspect
import os
import types
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import InitVar
from numbers import Integral, Real
from typing import Any, Literal, TypeVar, Union, Unpack, get_args, get_origin, get_type_hints

import numpy as np

from rockbatch.common.errors import Problem, WrongType, refuse

Door = TypeVar("Door", bound=Callable[..., Any])

MOST_WHOLE = 10**18
"""Greatest whole number, in size, that an argument may be."""

_REFUSED = object()
_AS_THEY_ARE = {float, bool, type(None)}
"""Types whose values are taken without a further look, since every record has hundreds."""
_WORDS: dict[object, str] = {
    float: "a number",
    int: "a whole number",
    str: "a text",
    bool: "True or False",
    os.PathLike: "a path",
    Callable: "a function",
    type(None): "None",
}


def checked(door: Door) -> Door:
    """Decorate a public function or dataclass so that it accepts arguments of its annotated types only.

    Numbers of other types, as NumPy's, become ``float`` and ``int``, and lists and arrays become tuples where one is meant.
    Annotations in quotes and of arrays are not checked. Raises ``InputError`` with a sentence for each argument of another type.
    """
    function: Any = vars(door)["__init__"] if isinstance(door, type) else door
    parameters = inspect.signature(function).parameters
    kinds = dict(_kinds(parameters))
    keywords = kinds.keys() - parameters.keys() if any(map(_is_unpacked, parameters.values())) else None
    kinds = {name: alternatives for name, alternatives in kinds.items() if all(map(_is_known, alternatives))}
    plain = {name: _AS_THEY_ARE.intersection(kinds[name]) for name in kinds}

    @functools.wraps(function)
    def call(*args: Any, **kwargs: Any) -> Any:
        wrong: list[Problem] = []

        def take(name: str, value: object) -> object:
            if name not in kinds or type(value) in plain[name]:
                return value
            converted = _first_taken(value, kinds[name])
            if converted is _REFUSED:
                text = f"{name} = {_shown(value)}: {_message(value, kinds[name])}"
                wrong.append(Problem(name, value, text, kind=WrongType, named=False))
            return converted

        if keywords is not None and (unknown := kwargs.keys() - parameters.keys() - keywords):
            raise TypeError(f"{function.__name__}() got an unexpected keyword argument {min(unknown)!r}")
        args = (*map(take, parameters, args), *args[len(parameters) :])
        kwargs = {name: take(name, value) for name, value in kwargs.items()}
        refuse(wrong)
        return function(*args, **kwargs)

    if not isinstance(door, type):
        return call  # type: ignore[return-value]
    door.__init__ = call  # type: ignore[misc]
    return door


def _kinds(parameters: Mapping[str, inspect.Parameter]) -> Iterator[tuple[str, tuple[object, ...]]]:
    """Yield each parameter's name and alternatives, also those of keywords whose types a TypedDict has."""
    for name, parameter in parameters.items():
        if _is_unpacked(parameter):
            yield from (
                (key, _alternatives(kind)) for key, kind in get_type_hints(get_args(parameter.annotation)[0]).items()
            )
        elif parameter.kind not in (parameter.VAR_POSITIONAL, parameter.VAR_KEYWORD):
            yield name, _alternatives(parameter.annotation)


def _is_unpacked(parameter: inspect.Parameter) -> bool:
    return get_origin(parameter.annotation) is Unpack


def _alternatives(annotation: object) -> tuple[object, ...]:
    """Return the types of a union, also within ``InitVar``; the annotation alone if it is no union."""
    if isinstance(annotation, InitVar):
        return _alternatives(annotation.type)
    if get_origin(annotation) in (Union, types.UnionType):
        return tuple(kind for part in get_args(annotation) for kind in _alternatives(part))
    return (annotation,)


def _is_known(kind: object) -> bool:
    """Return whether values can be checked against a type.

    False without annotation, and for ``Any``, ``object``, annotations in quotes, arrays, and protocols not checked at run time.
    """
    plain = get_origin(kind) or kind
    return plain is Literal or (
        isinstance(plain, type)
        and plain not in (inspect.Parameter.empty, object, Any)
        and plain.__module__ != "numpy"
        and getattr(plain, "_is_runtime_protocol", True)
    )


def _first_taken(value: object, alternatives: tuple[object, ...]) -> object:
    """Return ``value`` converted to the first of the ``alternatives`` that accepts it, or _REFUSED."""
    return next((converted for kind in alternatives if (converted := _take(value, kind)) is not _REFUSED), _REFUSED)


def _take(value: Any, kind: Any) -> object:
    """Return ``value`` converted to the type ``kind``, or itself if it is of this type; else _REFUSED.

    A boolean is no number; a ``timedelta64``, a whole number beyond ±10¹⁸, and a text that no file can have as its name are
    refused. Of a ``Literal`` any value of the type of one of its values is accepted.
    """
    plain = get_origin(kind) or kind
    fits = False
    if plain in (int, float):
        if (
            isinstance(value, Integral if plain is int else Real)
            and not isinstance(value, bool)
            and not _is_duration(value)
            and not _is_endless(value)
        ):
            return plain(value)
    elif plain in (tuple, Sequence) and isinstance(value, tuple | list | np.ndarray):
        return _members(value.tolist() if isinstance(value, np.ndarray) else value, get_args(kind))
    elif plain is Literal:
        fits = type(value) in map(type, get_args(kind))  # which words there are is said where they are read
    elif isinstance(value, str):
        fits = plain is str and not _unfit_for_a_name(value)
    else:
        fits = isinstance(value, plain) and not isinstance(value, bytes) and not _unfit_for_a_name(value)
    return value if fits else _REFUSED


def _is_endless(value: object) -> bool:
    """Return whether a value is a whole number beyond ±10¹⁸, which floats or integers of 64 bits may not hold."""
    return isinstance(value, Integral) and not _is_duration(value) and not -MOST_WHOLE <= int(value) <= MOST_WHOLE


def _is_duration(value: object) -> bool:
    """Return whether a value is NumPy's ``timedelta64``, which counts as a whole number though its unit is its own."""
    return getattr(getattr(value, "dtype", None), "kind", "") == "m"


def _unfit_for_a_name(value: object) -> str:
    """Return why a text or path cannot be the name of a file: a NUL, or half of a surrogate pair; "" if it can, or is neither.

    Whether the file system of this machine has its letters is found where the file is written.
    """
    name = os.fspath(value) if isinstance(value, os.PathLike) else value
    if not isinstance(name, str):
        return ""
    if "\0" in name:
        return "has a NUL character"
    try:
        name.encode(errors="surrogateescape")
    except UnicodeEncodeError as error:
        return f"has {name[error.start]!a}, half of a character, which no file's name has"
    return ""


def _members(values: Sequence[object], inner: tuple[object, ...]) -> object:
    """Return a tuple of ``values`` converted to the ``inner`` type; _REFUSED if one is unfit.

    If ``inner`` has two types, as of a pair, the values are neither checked nor converted.
    """
    if len(inner) == 2 and inner[1] is not ...:
        return tuple(values)
    converted = tuple(_first_taken(value, _alternatives(inner[0])) for value in values)
    return _REFUSED if any(member is _REFUSED for member in converted) else converted


def _shown(value: object) -> str:
    """Return the value as Python writes it, on one line of 60 characters at most."""
    try:
        text = " ".join(repr(value).split())
    except ValueError:  # more digits than Python writes
        text = f"a {type(value).__name__} of thousands of digits"
    return text if len(text) <= 60 else f"{text[:57]}…"


def _message(value: object, alternatives: tuple[object, ...]) -> str:
    """Return which types an argument must have, or for a fitting type why this value will not do."""
    if unfit := _unfit_for_a_name(value):
        return unfit
    if _is_endless(value):
        return f"must be within −{MOST_WHOLE:.0e} and {MOST_WHOLE:.0e}"
    *others, last = dict.fromkeys(map(_words, alternatives))
    must = f"must be {', '.join(others) + ' or ' if others else ''}{last}"
    return f"is a class; {must}, such as {value.__name__}(…)" if isinstance(value, type) else must


def _words(kind: object) -> str:
    plain = get_origin(kind) or kind
    if plain is Literal:
        return "one of " + ", ".join(map(repr, get_args(kind)))
    if plain in (tuple, Sequence):
        inner = (
            " or ".join(_words(part).split(" ", 1)[1] for part in _alternatives(get_args(kind)[0]))
            if get_args(kind)
            else ""
        )
        return f"a {'tuple' if plain is tuple else 'list'}" + (f" of {inner}" if inner else "")
    name = getattr(plain, "__name__", str(plain))
    return _WORDS.get(plain) or f"{'an' if name[0] in 'AEIOU' else 'a'} {name}"
