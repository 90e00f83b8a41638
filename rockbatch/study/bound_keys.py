"""The tables [[bound]] of a study file."""

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

from rockbatch.common.errors import MissingKey, Problem
from rockbatch.common.grouping import closest
from rockbatch.common.naming import alike
from rockbatch.common.showing import shown
from rockbatch.quantities.design import BOUND
from rockbatch.study.case_keys import CASE
from rockbatch.study.design_bounds import Change, DesignBound, parted
from rockbatch.study.piers import PART, PIER
from rockbatch.study.restraint_keys import DEVICES
from rockbatch.toml.kinds import KindError, Points, Text, choice, text
from rockbatch.toml.reader import Table, TomlFile
from rockbatch.toml.section import Clash, Key, Section

_FIXED = ("name", "base", "kind", "confirm", "at", "side", "other_width_m")
"""Keys that make another design, and no bound of one."""
_TABLES: Mapping[str, Mapping[str, Key]] = {
    "pier": PIER,
    "pier.part": PART,
    "case": CASE,
    **{f"case.{kind}": keys for kind, keys in DEVICES.items()},
}
"""Keys that bounds may change, by the paths of their tables."""
_MOST = 1e6


class Preset(NamedTuple):
    """Bounds by a code: the clause with their factors, and for each bound factors on the keys at these paths."""

    source: str
    bounds: Mapping[str, Mapping[str, float]]


_EXAMPLE = '"case.stiffness_kN_m" = { times = 2.0 }'


_SUPPLY = ("case.damper.coefficient_kN_s_m", "case.damper.nu")
PRESETS: Mapping[str, Preset] = {
    "NTC 2018 viscous": Preset(
        "DM 17 January 2018 (NTC 2018), 11.9.6, table 11.9.III: F_max within 15 % as supplied; not for ageing, temperature, rate",
        {"low": dict.fromkeys(_SUPPLY, 0.85), "high": dict.fromkeys(_SUPPLY, 1.15)},
    ),
}
"""Presets by name: factors that were read in the text of a code, or in a transcription of it (docs/pages/questions/bounds.md)."""


def _check_name(name: str) -> None:
    """Raise :class:`KindError` if the name of a bound reads as a number ("1.15", "nan"); return None for others."""
    try:
        float(name)
    except ValueError:
        return
    raise KindError(f"a name that is no number in tables, such as {shown(f'times {name}')}")


BOUNDS = Section(
    (BOUND,),
    "A bound of the design: changes that apply to every case. The nominal design always runs, and each bound beside it, one at "
    "a time; a case passes if all of them do. The keys of a bound are the full paths of keys of [pier] and [[case]], in quotes: "
    f'`{_EXAMPLE}`, `"case.damper.f" = {{ times = 1.15 }}` for all dampers, `"case.damper_2.f"` for the second, '
    '`"pier.deck_mass_t" = 950.0`.',
    {
        "name": Key(
            Text(check=_check_name),
            '"stiff ground"',
            "Its name in tables and in the column `bound` of peaks.csv; required without a preset.",
        ),
        "preset": Key(
            choice(*PRESETS),
            '"NTC 2018 viscous"',
            "Bounds with the factors of a code, in place of a name, a source and changes; the report prints them.",
        ),
        "source": Key(text, '"EN 15129, test of 2024"', "Where its factors come from, for the report."),
        "confirm": Key(
            text, '["stiffness_kN_m"]', "Keys whose values under this bound are unusual, and correct.", many=True
        ),
    },
    many=True,
    clashes=(
        Clash(("preset", "name"), "a preset names its bounds; leave name out", at="name"),
        Clash(("preset", "source"), "a preset has its source; leave source out", at="source"),
    ),
    free=r"^(pier|case)\..+$",
    free_schema={
        "anyOf": [
            {"type": ["number", "string"]},
            CASE["backbone_mm_kN"].kind.schema(),
            {"type": "object", "properties": {"times": {"type": "number"}}, "required": ["times"]},
        ]
    },
)


def read_bounds(file: TomlFile) -> list[DesignBound]:
    """Return every [[bound]] of a study, for a preset each of its bounds; mistakes become problems of ``file``.

    A mistaken change is left out of its bound, a table with an unknown preset wholly.
    Whether the pier or any case gives the keys that it changes is checked by :func:`placed`.
    """
    bounds: list[DesignBound] = []
    for place, table in enumerate(file.tables(BOUND, title="name")):
        flat = replace(table, data=dict(_flat(table.data)))
        paths = [name for name in flat.data if name.startswith(("pier.", "case."))]
        read = flat.read(BOUNDS, other=paths)
        changes = tuple(change for path in paths if (change := _read_change(flat, path)) is not None)
        for name in flat.confirmed:
            if not any(name in keys for keys in _TABLES.values()):
                table.complain(f"confirm = {shown(name)}: there is no such key; leave it out", "confirm")
        preset, names = read.get("preset"), [bound.name for bound in bounds]
        if preset is not None:
            bounds += _of_preset(flat, preset, place)
            if bounds[-1].name in names:
                table.complain(f"preset = {shown(preset)}: given twice; write it once", "preset")
        elif not table.has("preset"):
            _note_mistakes(flat, paths, names)
            name, source = (str(read.get(key, "")) for key in ("name", "source"))
            bounds.append(DesignBound(name, changes, source, (), flat.confirmed, place))
    return bounds


def _note_mistakes(table: Table, paths: Sequence[str], names: Collection[str]) -> None:
    """Note that a bound changes nothing, or lacks a name that differs from ``names``."""
    if not paths:
        table.complain(f"it changes nothing; write for example {_EXAMPLE}")
    if not table.has("name"):
        text = f"name is missing; write for example name = {BOUNDS['name'].example}"
        table.complain(Problem("name", None, text, kind=MissingKey, named=False))
        return
    name = str(table.data["name"])
    if name in names or (other := alike(name, sorted(names))):
        like = "given twice" if name in names else f"is read as the bound {shown(other)}"
        table.complain(f"name = {shown(name)}: {like}; give each bound its own name", "name")


def _of_preset(table: Table, name: str, place: int) -> Iterator[DesignBound]:
    """Yield the bounds of a preset, "NTC 2018 viscous low" and so on, with a change of each of their keys; a case needs one.

    Changes that the table gives beside the preset become problems of it.
    """
    source, bounds = PRESETS[name]
    for path in table.data:
        if path.startswith(("pier.", "case.")):
            table.complain(f"{shown(path)}: a preset has its changes; write it in a [[bound]] of its own", path)
    for which, factors in bounds.items():
        keys = [(path, key, times) for path, times in factors.items() if (key := key_at(path)) is not None]
        changes = tuple(Change(path, key, times=times) for path, key, times in keys)
        yield DesignBound(f"{name} {which}", changes, source, (), table.confirmed, place, any_of_these=True)


def _flat(data: Mapping[str, Any], prefix: str = "") -> Iterator[tuple[str, Any]]:
    """Yield keys and values of a [[bound]]: {"case": {"eta": 2}} gives ("case.eta", 2), as TOML reads paths without quotes.

    Tables within pier and case are walked so; one at the path of a known key, such as { times = 1.2 }, is a value, as is an empty
    one.
    """
    for name, value in data.items():
        path = prefix + name
        is_table = isinstance(value, dict) and path.split(".")[0] in ("pier", "case") and key_at(path) is None
        yield from _flat(value, f"{path}.") if is_table and value else [(path, value)]


def key_at(path: str) -> Key | None:
    """Return the key at a path such as "pier.mass_t" or "case.damper_2.f"; None for an unknown table or key."""
    *tables, name = path.split(".")
    of = ".".join(parted(table)[0] for table in tables)
    return _TABLES[of].get(name) if of in _TABLES else None


def why_fixed(path: str, example: str) -> str:
    """Return why bounds and designs cannot change the key at ``path``: it is unknown, or makes another design; "" if they can.

    ``example`` is a path to write instead.
    """
    if key_at(path) is None:
        near = closest(path, [f"{of}.{name}" for of, names in _TABLES.items() for name in names if name not in _FIXED])
        instead = f"did you mean {near}?" if near else f"write a key of [pier] or [[case]], such as {example}"
        return f"{shown(path)}: no such key; {instead}"
    if path.rpartition(".")[2] in _FIXED:
        return f"{shown(path)}: another value makes another design; write another [[case]]"
    return ""


def _read_change(table: Table, path: str) -> Change | None:
    """Return the change at one path; None for an unknown or fixed key or a wrong value, with the problem added to ``table``."""
    written, key = table.data[path], key_at(path)
    if key is None or path.rpartition(".")[2] in _FIXED:
        table.complain(why_fixed(path, _EXAMPLE), path)
        return None
    if not isinstance(written, dict):
        try:
            return Change(path, key, key.kind(written))
        except KindError as wrong:
            table.complain(f"{shown(path)} = {shown(written)}: {wrong.advice()}", path)
            return None
    times = _factor(written)
    if times is None:
        example = f"{shown(path)} = {{ times = 1.2 }}"
        table.complain(
            f"{shown(path)} = {shown(written)}: expected a factor above 0; write for example {example}", path
        )
        return None
    if not key.kind.numeric:
        value = f"the points of the bound, {shown(path)} = [[…]]" if isinstance(key.kind, Points) else "a value"
        table.complain(f"{shown(path)}: times is for numbers, and this is {key.kind.words}; write {value}", path)
        return None
    return Change(path, key, times=times)


def _factor(written: Mapping[str, Any]) -> float | None:
    """Return the factor of a table { times = 1.2 }, above 1e-6 and below 1e6; None for another table or another factor."""
    times = written.get("times")
    if set(written) != {"times"} or isinstance(times, bool) or not isinstance(times, float | int):
        return None
    return float(times) if 1.0 / _MOST < times < _MOST else None
