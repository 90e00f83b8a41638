"""Things in groups, a few of many, names that tell them apart, and the name that was meant."""

import difflib
from collections import Counter
from collections.abc import Callable, Hashable, Iterable, Sequence
from typing import TypeVar

T = TypeVar("T")
K = TypeVar("K", bound=Hashable)

_LONGEST = 100  # characters of a word that others are compared with


def grouped(items: Iterable[T], key: Callable[[T], K]) -> dict[K, list[T]]:
    """Return lists of items by key, both in order of first occurrence."""
    groups: dict[K, list[T]] = {}
    for item in items:
        groups.setdefault(key(item), []).append(item)
    return groups


def joined(sets: Iterable[Sequence[str]]) -> list[str]:
    """Return a name for each set, the same for all that common members connect; it is the first member of one of them."""
    parents: dict[str, str] = {}

    def root(name: str) -> str:
        while (parent := parents.setdefault(name, name)) != name:
            name = parent
        return name

    sets = list(sets)
    for members in sets:
        common = root(members[0])
        parents |= {root(member): common for member in members}
    return [root(members[0]) for members in sets]


def spread(items: Sequence[T], most: int) -> list[T]:
    """Return at most ``most`` of ``items``, evenly over all, with the first and the last; the first alone if ``most`` is 1."""
    if len(items) <= most:
        return list(items)
    step = (len(items) - 1) / (most - 1) if most > 1 else 0.0
    return [items[round(i * step)] for i in range(most)]


def distinct(names: Sequence[str], *longer: Callable[[int, str], str]) -> list[str]:
    """Return ``names`` made to differ: repeated ones made ``longer``, by one function after the other, then numbered, "a (2)".

    A function takes the place of a name, and the name. The first of several that are numbered stays, and a number that gives
    another of the names is passed over.
    """
    names = list(names)
    for more in longer:
        count = Counter(names)
        names = [more(i, name) if count[name] > 1 else name for i, name in enumerate(names)]
    counts: Counter[str] = Counter()
    taken = set(names)
    for i, name in enumerate(names):
        counts[name] += 1
        if counts[name] > 1:
            while (numbered := f"{name} ({counts[name]})") in taken:
                counts[name] += 1
            names[i] = numbered
    return names


def closest(word: str, known: Iterable[str], alike: float = 0.6) -> str | None:
    """Return the known word most similar to ``word``, ignoring case; None if none reaches the similarity ``alike``."""
    by_lower = {name.lower(): name for name in known}
    matches = difflib.get_close_matches(word[:_LONGEST].lower(), by_lower, n=1, cutoff=alike)
    return by_lower[matches[0]] if matches else None
