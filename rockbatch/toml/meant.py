"""The key or word that was probably meant: by another name of it, or by its spelling."""

from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from rockbatch.common.grouping import closest
from rockbatch.common.units import unit_of

_LONGEST = 100  # characters of a name that are looked at

_ALIKE, _VERY_ALIKE = 0.75, 0.85
"""Least similarities of a misspelt name: of one with its unit left out, and of one that is looked for first."""

Also = str | tuple[str, ...]
"""What another name stands for: a key, or keys of which the first that applies counts."""


def names(listed: Mapping[Any, str]) -> dict[str, Any]:
    """Return the meaning of each name: ``{"alpha": "slope angle"}`` gives ``{"slope": "alpha", "angle": "alpha"}``."""
    return {name: meant for meant, several in listed.items() for name in several.split()}


def plain(name: str) -> str:
    """Return the letters and digits of a name's first 100 characters, in lower case."""
    return "".join(filter(str.isalnum, name[:_LONGEST].lower()))


def without_unit(name: str) -> Iterator[str]:
    """Yield the plain name, then without its last word, its last two, and so on.

    "height_kN_m" gives "heightknm", "heightkn" and "height".
    """
    words = name[:_LONGEST].replace("-", "_").split("_")
    return (plain("_".join(words[:n])) for n in range(len(words), 0, -1))


def _stem(key: str) -> str:
    """Return the plain key without its unit or "years": "stiffness_kN_m" gives "stiffness"."""
    stem = key.removesuffix("_years")
    return plain(stem.removesuffix(f"_{unit_of(stem)}"))


def known_as(name: str, keys: Iterable[str], also: Mapping[str, Also], table: str = "") -> str:
    """Return the key that ``name`` means; "" if none is similar.

    It is the same key but for case and signs, else a very similar one (0.85), else the same without its unit or that of
    ``also``, else a similar one (0.75). The name of its ``table`` may stand before a key: "pier_height_m" is height_m in
    [pier], and not deck_height_m.
    """
    keys = list(keys)
    if same := next((key for key in keys if plain(key) == plain(name)), ""):
        return same
    first, _, rest = name.partition("_")
    if rest and table and plain(first) == plain(table) and (meant := _same_key(rest, keys, also)):
        return meant
    return closest(name, keys, _VERY_ALIKE) or _same_key(name, keys, also) or closest(name, keys, _ALIKE) or ""


def _same_key(name: str, keys: Iterable[str], also: Mapping[str, Also]) -> str:
    """Return the key that ``name`` is but for capitals, signs and last words such as a unit, or that ``also`` gives for it.

    "" if that is none of ``keys``.
    """
    keys = list(keys)
    stems = {_stem(key): key for key in reversed(keys)}
    for word in without_unit(name):
        meant = also.get(word, ())
        for key in (stems.get(word), *((meant,) if isinstance(meant, str) else meant)):
            if key in keys:
                return key
    return ""


def words_meant(word: str, options: Iterable[str], called: Mapping[str, object]) -> list[object]:
    """Return the options that ``word`` may stand for: the same but for case and signs, by ``called``, or the most similar one.

    A tuple in ``called`` has several; anything else is the value itself. Empty if none is similar.
    """
    options = list(options)
    if same := [option for option in options if plain(word) and plain(option) == plain(word)]:
        return list[object](same)
    meant = called.get(word, called.get(plain(word)))
    if meant is not None:
        return list(meant) if isinstance(meant, tuple) else [meant]
    nearest = closest(word, options, _ALIKE)
    return [nearest] if nearest else []
