"""A study written with other values: the text of its file with a key changed, read again."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from rockbatch.study.design_bounds import parted
from rockbatch.study.tables import name_of

Tables = Mapping[str, Any]


def with_value(tables: Tables, path: str, case: str, value: float) -> Tables | None:
    """Return the tables of a study with the key at a path changed; None if it is not written.

    A path in "case" changes each [[case]] of the name ``case`` alone; another, such as one in "pier", changes the study.
    """
    top, *rest = path.split(".")
    if top != "case":
        return _changed(tables, [top, *rest], value)
    changed = [_changed(table, rest, value) if name_of(table) == case else table for table in tables["case"]]
    return None if None in changed else {**tables, "case": changed}


def _changed(table: Tables, path: Sequence[str], value: float) -> Tables | None:
    """Return a table with the key at a path within it changed; None if the key is not written.

    The path "damper.f" changes each damper that has f, "damper_2.f" the second alone.
    """
    name, *rest = path
    if not rest:
        return {**table, name: value} if name in table else None
    kind, number = parted(name)
    written = table.get(kind, ())
    inner = [written] if isinstance(written, dict) else written
    changed = [_changed(part, rest, value) if number in ("", str(n)) else None for n, part in enumerate(inner, 1)]
    if all(part is None for part in changed):
        return None
    parts = [old if new is None else new for old, new in zip(inner, changed, strict=True)]
    return {**table, kind: parts[0] if isinstance(written, dict) else parts}


def paths_in(tables: Tables) -> Iterator[str]:
    """Yield the paths of all numbers, or lists, in the pier, the cases and tables one level within; some may come twice."""
    for top in ("pier", "case"):
        for table in _listed(tables.get(top, ())):
            for name, value in table.items():
                inner = [(key, number) for part in _listed(value) for key, number in part.items()]
                named = [(f"{name}.{key}", number) for key, number in inner] or [(name, value)]
                yield from (f"{top}.{key}" for key, number in named if not isinstance(number, str | bool))


def _listed(value: Any) -> list[Tables]:
    """Return the tables of a list, or a single one; none for another value."""
    return (
        [value]
        if isinstance(value, dict)
        else [part for part in value if isinstance(part, dict)]
        if isinstance(value, list)
        else []
    )
