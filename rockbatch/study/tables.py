"""Studies as tables of Python: changed by name, and written as TOML."""

import datetime
import json
import os
import re
from collections.abc import Iterable, Mapping
from typing import TypeAlias, TypeGuard

from rockbatch.common.errors import InputError
from rockbatch.common.grouping import closest, grouped
from rockbatch.common.naming import chosen
from rockbatch.common.showing import shown

TomlValue: TypeAlias = (
    bool | int | float | str | datetime.date | datetime.time | list["TomlValue"] | dict[str, "TomlValue"]
)
TomlTable = dict[str, TomlValue]

_BARE = re.compile(r"[A-Za-z0-9_-]+")
_DEEPEST = 32


def plain(value: object, *place: str) -> TomlValue:
    """Return ``value`` as a TOML parser returns it: dicts, lists, numbers, texts, dates.

    Tuples and arrays become lists, paths texts, and keys with None are left out. Raises ``InputError`` with its ``place`` for
    a value that TOML does not have.
    """
    where = ".".join(place)
    if hasattr(value, "tolist"):  # NumPy's arrays and numbers
        value = value.tolist()
    if len(place) > _DEEPEST:
        raise InputError(f"{'.'.join(place[:3])}: tables or lists within one another, more than {_DEEPEST} deep")
    if isinstance(value, Mapping):
        return plain_table(value, *place)
    if isinstance(value, list | tuple):
        return [plain(item, *place, str(n)) for n, item in enumerate(value)]
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if isinstance(value, int) and value.bit_length() > 64:
        raise InputError(f"{where}: a whole number of more than 64 bits, which TOML does not have")
    if isinstance(value, bool | int | float | str | datetime.date | datetime.time):
        return value
    raise InputError(f"{where}: expected a number, a text, a list or a table, not {type(value).__name__}")


def plain_table(table: Mapping[str, object], *place: str) -> TomlTable:
    """Return a table with its values as :func:`plain` returns them, without keys that have None."""
    return {str(key): plain(item, *place, str(key)) for key, item in table.items() if item is not None}


def changed(table: TomlTable, changes: Mapping[str, object], *place: str) -> TomlTable:
    """Return a table of a study with ``changes`` key by key; None takes a key away, and a new key is added.

    Of a list of tables, such as the cases, a name or a list of names keeps those tables, and a mapping changes some of them by
    their names: ``InputError`` for a name that none of them has.
    """
    result = dict(table)
    for key, change in changes.items():
        if change is None:
            result.pop(str(key), None)
        else:
            result[str(key)] = _changed_value(result.get(str(key)), change, *place, str(key))
    return result


def _changed_value(old: TomlValue | None, new: object, *place: str) -> TomlValue:
    """Return a value with its change: tables merged, tables of a list chosen or changed by name, others replaced."""
    if isinstance(old, dict) and isinstance(new, Mapping):
        return changed(old, new, *place)
    if are_tables(old):
        if isinstance(new, Mapping):
            return _changed_by_name(old, new, *place)
        names = [new] if isinstance(new, str) else new
        if isinstance(names, list | tuple) and all(isinstance(name, str) for name in names):
            _check_names(old, names, *place)
            of_name = grouped(old, name_of)
            return [table for name in names for table in of_name[name]]
    return plain(new, *place)


def _changed_by_name(tables: list[TomlTable], changes: Mapping[str, object], *place: str) -> list[TomlValue]:
    """Return all tables in their order, with the changes of those that are named, without those whose change is None."""
    _check_names(tables, changes, *place)
    named = [(name_of(table), table) for table in tables]
    changed_tables = [(name, table, changes.get(name, {})) for name, table in named]
    return [_changed_value(table, new, *place, name) for name, table, new in changed_tables if new is not None]


def _check_names(tables: list[TomlTable], names: Iterable[str], *place: str) -> None:
    """Raise ``InputError`` with all of ``names`` that none of the ``tables`` has."""
    known = dict.fromkeys(map(name_of, tables))
    problems = []
    for name in names:
        if name not in known:
            nearest = closest(str(name), filter(None, known))
            names_shown = ", ".join(map(shown, filter(None, known))) or "none that has one; give a list of all tables"
            instead = f"did you mean {shown(nearest)}?" if nearest else f"there is {names_shown}"
            problems.append(f"{'.'.join(place)} = {shown(name)}: no table has this name; {instead}")
    if problems:
        raise InputError(*problems)


def name_of(table: Mapping[str, TomlValue]) -> str:
    """Return the name of a table, else its preset, or its base, by which a single case may be called, else ""."""
    return str(next((table[key] for key in ("name", "preset", "base") if key in table), ""))


def are_tables(value: TomlValue | None) -> TypeGuard[list[TomlTable]]:
    """Return whether ``value`` is a list of tables; False for []."""
    return isinstance(value, list) and bool(value) and all(isinstance(item, dict) for item in value)


def without_lost_cases(before: Mapping[str, TomlValue], after: Mapping[str, TomlValue]) -> TomlTable:
    """Return the tables ``after`` a change, without what checks and references say of removed cases.

    Those about removed cases alone go; of others, the patterns that choose removed cases only. Nothing goes if either has no list
    of cases.
    """
    result = dict(after)
    cases_before, cases = before.get("case"), after.get("case")
    if not (are_tables(cases_before) and are_tables(cases)):
        return result
    present = [name_of(case) for case in cases]
    lost = [name for name in map(name_of, cases_before) if name not in present]
    for kind in ("reference", "check"):
        tables = result.get(kind)
        if not are_tables(tables):
            continue
        remaining: list[TomlValue] = []
        for table in tables:
            written = table.get("case", "*")
            patterns = written if isinstance(written, list) else [written]
            about = [p for p in patterns if chosen(str(p), present) or not chosen(str(p), lost)]
            if about:
                remaining.append(table if about == patterns else table | {"case": about})
        del result[kind]
        if remaining:
            result[kind] = remaining
    return result


def as_toml(tables: Mapping[str, TomlValue], *place: str) -> str:
    """Return tables of :func:`plain` values as TOML: keys first, then the tables within, each under its header."""
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
    """Return a key as TOML writes it, in quotes if it is not a bare one."""
    return name if _BARE.fullmatch(name) else _basic(name)


def _basic(text: str) -> str:
    """Return a basic string of TOML: one of JSON, but for the control character DEL, which TOML escapes."""
    return json.dumps(text, ensure_ascii=False).replace("\x7f", r"\u007f")


def _written(value: TomlValue) -> str:
    """Return a value as TOML writes it: true, 0.5, "text" (several lines in triple quotes), [1, 2], { a = 1 }."""
    if isinstance(value, str) and "\n" in value:
        return '"""\n' + "\n".join(_basic(line)[1:-1] for line in value.split("\n")) + '"""'
    if isinstance(value, str):
        return _basic(value)
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{_key(key)} = {_written(item)}" for key, item in value.items()) + " }"
    if isinstance(value, list):
        return f"[{', '.join(map(_written, value))}]"
    return str(value).lower() if isinstance(value, bool) else str(value)
