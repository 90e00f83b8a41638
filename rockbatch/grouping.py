"""Things in groups, and names that tell them apart."""

from collections import Counter
from collections.abc import Callable, Hashable, Iterable, Sequence
from typing import TypeVar

T = TypeVar("T")
K = TypeVar("K", bound=Hashable)


def grouped(items: Iterable[T], key: Callable[[T], K]) -> dict[K, list[T]]:
    """Return the things that share a key, in order, by their keys in the order of the first of each."""
    groups: dict[K, list[T]] = {}
    for item in items:
        groups.setdefault(key(item), []).append(item)
    return groups


def distinct(names: Sequence[str], *longer: Callable[[int, str], str]) -> list[str]:
    """Return names that differ: those that are there twice are made ``longer``, by one function after the other, then numbered.

    A function takes the place of a name, and the name.
    """
    names = list(names)
    for more in longer:
        count = Counter(names)
        names = [more(i, name) if count[name] > 1 else name for i, name in enumerate(names)]
    counts: Counter[str] = Counter()
    for i, name in enumerate(names):
        counts[name] += 1
        if counts[name] > 1:
            names[i] = f"{name} ({counts[name]})"
    return names
