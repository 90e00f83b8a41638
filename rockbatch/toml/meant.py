"""The key or word that was probably meant, and a value in its unit."""

import math
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import lru_cache
from typing import Any, NamedTuple

from rockbatch.common.grouping import closest
from rockbatch.common.units import GRAVITY, unit_with_exponent
from rockbatch.toml.numerals import ascii_marks, numeral

_FOOT, _POUND = 0.3048, 4.4482216e-3  # m, kN
_UNITS: dict[str, tuple[str, float]] = {
    "m": ("length", 1.0), "mm": ("length", 1e-3), "cm": ("length", 1e-2), "km": ("length", 1e3),
    "ft": ("length", _FOOT), "in": ("length", _FOOT / 12.0),
    "s": ("time", 1.0), "sec": ("time", 1.0), "ms": ("time", 1e-3),
    "rad": ("angle", 1.0), "mrad": ("angle", 1e-3), "deg": ("angle", math.pi / 180.0),
    "degrees": ("angle", math.pi / 180.0),
    "rad_s": ("angular velocity", 1.0),
    "t": ("mass", 1.0), "kg": ("mass", 1e-3), "mg": ("mass", 1.0), "tonnes": ("mass", 1.0),
    "kn": ("force", 1.0), "n": ("force", 1e-3), "mn": ("force", 1e3), "tf": ("force", GRAVITY),
    "kip": ("force", 1e3 * _POUND), "kips": ("force", 1e3 * _POUND), "lbf": ("force", _POUND),
    "kn_m": ("stiffness", 1.0), "n_m": ("stiffness", 1e-3), "mn_m": ("stiffness", 1e3), "n_mm": ("stiffness", 1.0),
    "kn_mm": ("stiffness", 1e3), "kip_in": ("stiffness", 1e3 * _POUND / (_FOOT / 12.0)),
    "kip_ft": ("stiffness", 1e3 * _POUND / _FOOT), "tf_m": ("stiffness", GRAVITY),
    "kn_s_m": ("damping", 1.0), "kns_m": ("damping", 1.0), "n_s_m": ("damping", 1e-3), "ns_m": ("damping", 1e-3),
    "mn_s_m": ("damping", 1e3), "mns_m": ("damping", 1e3),
    "m_s": ("speed", 1.0), "cm_s": ("speed", 1e-2), "mm_s": ("speed", 1e-3),
    "g": ("acceleration", 1.0), "m_s2": ("acceleration", 1.0 / GRAVITY), "cm_s2": ("acceleration", 0.01 / GRAVITY),
    "gal": ("acceleration", 0.01 / GRAVITY),
    "t_m2": ("inertia", 1.0), "m2": ("area", 1.0), "mm2": ("area", 1e-6), "cm2": ("area", 1e-4),
    "percent": ("ratio", 1e-2), "pct": ("ratio", 1e-2),
    "mpa": ("stress", 1.0), "kpa": ("stress", 1e-3), "gpa": ("stress", 1e3), "hz": ("frequency", 1.0),
    "knm": ("moment", 1.0), "kj": ("energy", 1.0),
}  # fmt: skip
"""By the ends of names, in lower case: the quantity, and the unit in that of its first line. Accelerations are in g."""

_OTHER_UNITS = {
    "length": {"mm": 1e-3, "m": 1.0, "cm": 1e-2, "km": 1e3}, "time": {"ms": 1e-3}, "mass": {"kg": 1e-3, "kt": 1e3},
    "force": {"MN": 1e3, "N": 1e-3}, "stiffness": {"MN/m": 1e3, "N/m": 1e-3}, "damping": {"MN (s/m)^a": 1e3, "N (s/m)^a": 1e-3},
    "speed": {"cm/s": 1e-2, "mm/s": 1e-3}, "acceleration": {"% of g": 1e-2, "m/s²": 1.0 / GRAVITY, "cm/s²": 0.01 / GRAVITY},
    "area": {"mm²": 1e-6, "cm²": 1e-4}, "inertia": {"kg m²": 1e-3, "kt m²": 1e3},
}  # fmt: skip
"""By quantity, units in which a value is written by mistake, likelier ones first, and their sizes as in :data:`_UNITS`."""

_LONGEST = 100  # characters of a name that are looked at

_FILLING = {
    "a", "an", "and", "base", "bearing", "block", "coeff", "coefficient", "column", "damper", "factor", "foundation", "ground",
    "of", "own", "pier", "pulse", "ratio", "shaft", "spring", "stop", "support", "supports", "tendon", "the", "total", "value",
}  # fmt: skip
"""Words that say no more about a quantity than its table does."""

_GREATEST = {"max", "maximum", "peak", "greatest"}

_ALIKE = 0.75
"""Least similarity of a misspelt name: that of letters exchanged in a word of four."""


class Times(NamedTuple):
    """A key whose value is that under another name times a factor, and why, in words.

    ``quantity`` is that of the other name, such as the force of a weight; the key's own if it is empty.
    """

    key: str
    factor: float
    words: str
    quantity: str = ""


Also = str | tuple[str, ...] | Times
"""What another name stands for: a key, keys of which the first that applies counts, or a key with another value."""

WEIGHT, OF_WEIGHT = 1.0 / GRAVITY, "the weight in kN over 9.81"


class Meant(NamedTuple):
    """A key that was probably meant, the factor on its value, and why."""

    key: str
    factor: float = 1.0
    words: str = ""


def names(listed: Mapping[Any, str]) -> dict[str, Any]:
    """Return by each of the names that are ``listed`` with a key, word or sentence, apart by blanks, what it means."""
    return {name: meant for meant, several in listed.items() for name in several.split()}


def plain(name: str) -> str:
    """Return the letters and digits of a name, in lower case."""
    return _plain(name[:_LONGEST])


@lru_cache(maxsize=4096)  # a name that is not known is held against every key of the file
def _plain(name: str) -> str:
    return "".join(filter(str.isalnum, ascii_marks(name).lower()))


def quantity_of(name: str) -> tuple[str, str, float]:
    """Return a name without its unit, the quantity that the unit is of (empty without one), and its size."""
    name = name.lower().replace("-", "_").replace("_per_", "_")
    for place in re.finditer("_", name):
        unit = name[place.end() :]
        if place.start() and unit in _UNITS:
            return name[: place.start()], *_UNITS[unit]
    return name, "", 1.0


def in_another_unit(
    name: str, value: float, fits: Callable[[float], bool], key: str = "", exponent: float = 1.0
) -> str:
    """Return in which other unit a value of ``name`` would fit, and what to write at the ``key`` then; empty if in none.

    ``exponent`` is that of the speed, of which a damping coefficient is a multiple.
    """
    _, quantity, its_size = quantity_of(name)
    for unit, size in _OTHER_UNITS.get(quantity, {}).items():
        if size != its_size and fits(converted := value * size / its_size):
            return f"; {value:g} {unit_with_exponent(unit, exponent)} are {key or name} = {converted:.6g}"
    return ""


def words_meant(word: str, options: Iterable[str], called: Mapping[str, Any]) -> list[Any]:
    """Return the options that a word probably means: those that are ``called`` so, hold all of it, or are spelled alike.

    A tuple in ``called`` has several; anything else is the value itself.
    """
    options = list(options)
    if meant := _same_words(word, options, called):
        return meant
    if nearest := closest(word, options, _ALIKE):
        return [nearest]
    less = "_".join(token for token in re.split(r"[\s_-]+", word) if token.lower() not in _FILLING | _GREATEST)
    return _same_words(less, options, called)


def _same_words(word: str, options: Sequence[str], called: Mapping[str, Any]) -> list[Any]:
    """Return the options that a word is but for case and signs, that are ``called`` so, hold all of it, or begin with it."""
    same = [option for option in options if (plain(option) or option) == (plain(word) or ascii_marks(word))]
    if same or not plain(word):
        return same
    stem, quantity, _ = quantity_of(word)
    meant = called.get(plain(word), called.get(plain(stem)))
    if meant is not None:
        several = list(meant) if isinstance(meant, tuple) else [meant]
        return [option for option in several if quantity and quantity_of(str(option))[1] == quantity] or several
    tokens, unit = _tokens(stem), word[len(stem) :] if quantity else ""
    lengths = {
        option: len(its)
        for option in options
        if tokens <= (its := _tokens(quantity_of(option)[0])) and option.lower().endswith(unit.lower())
    }
    if lengths and any(len(token) > 2 for token in tokens):
        return [option for option, length in lengths.items() if length == min(lengths.values())]
    return [option for option in options if len(plain(word)) > 2 and plain(option).startswith(plain(word))]


def known_as(name: str, keys: Mapping[str, str], also: Mapping[str, Also]) -> Meant | None:
    """Return the key that has the name ``name`` but for its unit, or is ``also`` called so; None if there is none.

    ``keys`` are those that apply, each with the unit of its value, "" if it has none or its name says it.
    """
    same = next((key for key in keys if plain(key) == plain(name)), "")
    if same:
        return Meant(same)
    stem, quantity, size = quantity_of(name)
    short = "_".join(token for token in stem.split("_") if token not in _FILLING)
    for written, of_name, its_size in ((name, "", 1.0), (stem, quantity, size), (short, quantity, size)):
        listed = also.get(plain(written), ())
        for meant in (listed,) if isinstance(listed, str | Times) else listed:
            if key := _by_name(meant, keys, of_name, its_size):
                return key
    alike = (key for key in keys if plain(quantity_of(key)[0]) in (plain(stem), plain(short)))
    return next(filter(None, (_in_unit_of(key, keys[key], quantity, size) for key in alike)), None)


def _by_name(meant: Also, keys: Mapping[str, str], quantity: str, size: float) -> Meant | None:
    """Return what another name stands for, for a value of a ``quantity`` in a unit of this size; None if it cannot be."""
    if isinstance(meant, Times):
        fits = meant.key in keys and quantity in ("", meant.quantity or quantity_of(meant.key)[1])
        if fits:
            return Meant(meant.key, meant.factor * size, meant.words)
        meant = meant.key
    key = str(meant)
    return _in_unit_of(key, keys[key], quantity, size) if key in keys else None


def _in_unit_of(key: str, unit: str, quantity: str, size: float) -> Meant | None:
    """Return the key with the factor on a value of a ``quantity``; None if it is of another one."""
    _, key_quantity, its_size = quantity_of(key)
    if not key_quantity and unit:
        _, key_quantity, its_size = quantity_of(f"x_{unit}")
    if quantity == "ratio" and not key_quantity:
        return Meant(key, size)
    if not key_quantity:
        return Meant(key) if not quantity or quantity == "angle" or (quantity == "time" and size == 1.0) else None
    if not quantity:
        return Meant(key)
    return Meant(key, size / its_size) if quantity == key_quantity else None


def number_meant(key: str, unit: str, text: str) -> list[str]:
    """Return the values of a key that a text means, as TOML writes them, in the unit of the key; none if it is no number."""
    values, written = numeral(text)
    behind = re.sub(r"[/*·]|(?<=\w) (?=\w)", "_", written.strip().lower().replace("%", "percent").replace("°", "deg"))
    if not behind:
        return values
    _, key_quantity, its_size = quantity_of(f"x_{unit}" if unit and not quantity_of(key)[1] else key)
    text_quantity, size = _UNITS.get(behind, ("", 0.0))
    if (not key_quantity and text_quantity == "angle") or size == (1.0 if not key_quantity else its_size):
        return values if text_quantity == key_quantity or not key_quantity else []
    same = text_quantity == (key_quantity or "ratio")
    return [f"{size / its_size * float(value):.6g}" for value in values] if same else []


def similar(name: str, keys: Mapping[str, str]) -> list[str]:
    """Return keys of the same quantity that ``name`` says in more or fewer words, or that are spelled alike; best first."""
    stem, quantity, _ = quantity_of(name)
    fitting = [key for key, unit in keys.items() if _in_unit_of(key, unit, quantity, 1.0)]
    tokens = _tokens(stem)
    by_key = {key: _tokens(quantity_of(key)[0]) for key in fitting}
    longer = [key for key in fitting if len(key) > 2 and by_key[key] <= tokens and tokens - by_key[key] <= _FILLING]
    if longer:
        return [max(longer, key=lambda key: len(by_key[key]))]
    holding = [key for key in fitting if tokens < by_key[key] and len(stem) > 2]
    if holding:
        return holding
    nearest = closest(name, fitting, _ALIKE)
    return [nearest] if nearest else []


def _tokens(name: str) -> frozenset[str]:
    return frozenset(filter(None, re.split(r"[^a-z0-9]+", name.lower())))
