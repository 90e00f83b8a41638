"""Studies as tables of Python: changed by name, and written as TOML."""

import datetime
import json
import os
import re
from collections.abc import Iterable, Mapping
from fnmatch import fnmatchcase
from typing import Any

from rockbatch.common.errors import InputError
from rockbatch.common.grouping import closest
from rockbatch.common.showing import shown

_BARE = re.compile(r"[A-Za-z0-9_-]+")
_DEEPEST = 32
_VALUES = (bool, int, float, str, datetime.date, datetime.time)


def plain(value: Any, *place: str) -> Any:
    """Return ``value`` as a TOML parser returns it: dicts, lists, numbers and texts.

    Tuples and arrays become lists, paths texts, and keys with None are left out. Raises ``InputError`` for what TOML has not,
    with its ``place``.
    """
    where = ".".join(place)
    if hasattr(value, "tolist"):  # NumPy's arrays and numbers
        value = value.tolist()
    if len(place) > _DEEPEST:
        raise InputError(f"{'.'.join(place[:3])}: tables or lists within one another, more than {_DEEPEST} deep")
    if isinstance(value, Mapping):
        return {str(key): plain(item, *place, str(key)) for key, item in value.items() if item is not None}
    if isinstance(value, list | tuple):
        return [plain(item, *place, str(n)) for n, item in enumerate(value)]
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if isinstance(value, int) and value.bit_length() > 64:
        raise InputError(f"{where}: a whole number of more than 64 bits, which TOML has not")
    if not isinstance(value, _VALUES):
        raise InputError(f"{where}: expected a number, a text, a list or a table, not {type(value).__name__}")
    return value


def changed(old: Any, new: Any, *place: str) -> Any:
    """Return the value ``old`` of a study with the changes ``new``; ``InputError`` for a name that is not there.

    A table is changed key by key, and None takes a key away. Of a list of tables, such as the cases, a name or a list of names
    keeps those tables, and a mapping changes some of them by their names. Anything else takes the place of ``old``.
    """
    if isinstance(old, dict) and isinstance(new, Mapping):
        result = dict(old)
        for key, item in ((str(key), item) for key, item in new.items()):
            if item is None:
                result.pop(key, None)
            else:
                result[key] = changed(old.get(key), item, *place, key)
        return result
    if are_tables(old):
        names = [new] if isinstance(new, str) else new
        if isinstance(names, Mapping) or (isinstance(names, list | tuple) and all(isinstance(n, str) for n in names)):
            return _by_name(old, names, *place)
    return plain(new, *place)


def _by_name(tables: list[dict[str, Any]], names: Any, *place: str) -> list[dict[str, Any]]:
    by_name = {name_of(table): table for table in tables}
    problems = []
    for name in names:
        if name not in by_name:
            nearest = closest(str(name), filter(None, by_name))
            names_shown = ", ".join(map(shown, filter(None, by_name))) or "none that has one; give a list of all tables"
            instead = f"did you mean {shown(nearest)}?" if nearest else f"there is {names_shown}"
            problems.append(f"{'.'.join(place)} = {shown(name)}: no table has this name; {instead}")
    if problems:
        raise InputError(*problems)
    if not isinstance(names, Mapping):
        return [by_name[name] for name in names]
    return [
        changed(table, names.get(name, {}), *place, name)
        for name, table in by_name.items()
        if names.get(name, {}) is not None
    ]


def name_of(table: Mapping[str, Any]) -> str:
    """Return the name of a table among others of its kind; a single case may be called by its base."""
    return str(table.get("name", table.get("base", "")))


def are_tables(value: Any) -> bool:
    """Return whether ``value`` is a list of tables, and not empty."""
    return isinstance(value, list) and bool(value) and all(isinstance(item, dict) for item in value)


def without_lost_cases(before: Mapping[str, Any], after: Mapping[str, Any]) -> dict[str, Any]:
    """Return the tables ``after`` a change without checks and references that are about cases alone that are gone."""
    result = dict(after)
    if not (are_tables(before.get("case")) and are_tables(after.get("case"))):
        return result
    present = [name_of(case) for case in after["case"]]
    lost = [name for name in map(name_of, before["case"]) if name not in present]
    for kind in ("reference", "check"):
        if not are_tables(result.get(kind)):
            continue
        remaining = []
        for table in result.pop(kind):
            patterns = table["case"] if isinstance(table.get("case"), list) else [table.get("case", "*")]
            about = [pattern for pattern in patterns if _fits(present, pattern) or not _fits(lost, pattern)]
            if about:
                remaining.append(table if about == patterns else table | {"case": about})
        if remaining:
            result[kind] = remaining
    return result


def _fits(names: Iterable[str], pattern: Any) -> bool:
    return any(name == pattern or fnmatchcase(name, str(pattern)) for name in names)


def as_toml(tables: Mapping[str, Any], *place: str) -> str:
    """Return tables as :func:`plain` returns them as TOML: keys first, then the tables within, each under its header."""
    lines, inner = [], []
    for key, value in tables.items():
        header = ".".join(map(_key, (*place, key)))
        if isinstance(value, dict):
            inner.append(f"\n[{header}]\n{as_toml(value, *place, key)}")
        elif are_tables(value):
            inner += [f"\n[[{header}]]\n{as_toml(item, *place, key)}" for item in value]
        else:
            lines.append(f"{_key(key)} = {_written(value)}\n")
    return "".join([*lines, *inner])


def _key(name: str) -> str:
    return name if _BARE.fullmatch(name) else _basic(name)


def _basic(text: str) -> str:
    return json.dumps(text, ensure_ascii=False).replace("\x7f", r"\u007f")  # TOML's basic strings are JSON's


def _written(value: Any) -> str:
    if isinstance(value, str) and "\n" in value:
        return '"""\n' + "\n".join(_basic(line)[1:-1] for line in value.split("\n")) + '"""'
    if isinstance(value, str):
        return _basic(value)
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{_key(key)} = {_written(item)}" for key, item in value.items()) + " }"
    if isinstance(value, list):
        return f"[{', '.join(map(_written, value))}]"
    return str(value).lower() if isinstance(value, bool) else str(value)
