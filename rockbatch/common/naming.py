"""Names that a pattern chooses, and names that look alike."""

import unicodedata
from collections.abc import Collection, Iterable
from fnmatch import fnmatchcase
from functools import lru_cache

_LIKE_LATIN = str.maketrans(  # Cyrillic and Greek letters that most fonts draw as Latin ones (Unicode, confusables.txt)
    "асеорхуіјѕһԁԛԝАВЕКМНОРСТХІЈЅΑΒΕΖΗΙΚΜΝΟΡΤΥΧονρ", "aceopxyijshdqwABEKMHOPCTXIJSABEZHIKMNOPTYXovp"
)


def fits(name: str, pattern: str) -> bool:
    """Return whether a name is ``pattern``, which may have brackets of its own, or matches it as a glob."""
    return name == pattern or fnmatchcase(name, pattern)


def fits_any(name: str, patterns: Iterable[str]) -> bool:
    """Return whether a name is one of ``patterns``, or matches one as a glob; False without any."""
    return any(fits(name, pattern) for pattern in patterns)


def chosen(pattern: str, names: Iterable[str]) -> list[str]:
    """Return the names that ``pattern`` chooses: the one that equals it, else those that it matches as a glob, or []."""
    names = list(names)
    return [pattern] if pattern in names else [name for name in names if fits(name, pattern)]


@lru_cache(maxsize=1000)
def chosen_by(patterns: tuple[str, ...], names: frozenset[str]) -> frozenset[str]:
    """Return the names that any of the patterns chooses."""
    return frozenset(name for pattern in patterns for name in chosen(pattern, names))


def alike(name: str, others: Collection[str]) -> str:
    """Return the first of the ``others`` that is read as ``name`` though it is another text; empty if none is.

    Unicode composes some letters in two ways, other alphabets have letters of the same look, and spaces are not seen.
    """
    look = _look(name)
    return next((other for other in others if other != name and _look(other) == look), "")


def _look(name: str) -> str:
    """Return a name with letters that look Latin as Latin ones, composed in one way, and single blanks."""
    return " ".join(unicodedata.normalize("NFC", name).translate(_LIKE_LATIN).split())
