"""Differences between two studies: every key that either gives, by value, and the motions that were run."""

import tomllib
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

from rockbatch.common.showing import shown
from rockbatch.quantities.labels import distinguishing_digits, plain
from rockbatch.quantities.rows import as_in_peaks
from rockbatch.reporting.finished import Finished
from rockbatch.reporting.labels import counted
from rockbatch.study.load import SECTIONS
from rockbatch.toml.section import Section

MOST_VALUES = 6
"""Most values or names of one input that are shown."""
_SECTIONS = {section.at: section for section in SECTIONS}
_NAMES = {("title",), ("notes",)}
"""Keys that name a study and decide nothing; they are in the head of the page."""

Place = tuple[str, ...]
"""Place of a value in a study: tables, names or numbers of tables in a list, and the key."""


class Difference(NamedTuple):
    """An input that differs: its name, and its values in words."""

    name: str
    first: str
    second: str


class Written(NamedTuple):
    """A study as it is written: values by place, and the tables in which they are, by place."""

    values: dict[Place, object]
    tables: dict[Place, Place]
    """Keys of :data:`_SECTIONS`, by the places of the tables."""
    listed: set[Place]
    """Places of tables in a list, which another study may lack."""

    def value(self, place: Place) -> object:
        """Return the value at a place, or the default of a key that is not written; None for neither."""
        if place in self.values:
            return self.values[place]
        *table, key = place
        section = _SECTIONS.get(self.tables.get(tuple(table), tuple(table)), _NO_SECTION)
        return _alone(section.default(key)) if key in section else None


_NO_SECTION = Section((), "", {})


def differences(a: Finished, b: Finished, names: Mapping[str, str]) -> list[Difference]:
    """Return the inputs that differ between two studies; ``names`` are cases of A by those of B with which they are paired.

    A table of a list that only one of them has, such as a case or a damper, is a single input: its keys and values against "–".
    """
    sides = written(a.study), written(b.study, names)
    places = dict.fromkeys(place for side in sides for place in side.values)
    only = [sides[0].listed - sides[1].listed, sides[1].listed - sides[0].listed]
    rows = [Difference(_named(table), content, "–") for table, content in _contents(sides[0], _outermost(only[0]))]
    rows += [Difference(_named(table), "–", content) for table, content in _contents(sides[1], _outermost(only[1]))]
    in_one = only[0] | only[1]
    for place in places:
        if place in _NAMES or any(place[:n] in in_one for n in range(1, len(place))):
            continue
        values = [side.value(place) for side in sides]
        if _as_compared(values[0]) != _as_compared(values[1]):
            digits = distinguishing_digits([value for value in values if isinstance(value, float | int)], least=4)
            rows.append(Difference(_named(place), *(_shown(value, digits) for value in values)))
    return rows + _of_motions(a, b)


def written(study: Mapping[str, Any], names: Mapping[str, str] | None = None) -> Written:
    """Return the study of run.json as it is written, with the checks of the files that it names.

    Texts that are no TOML are skipped. Cases are renamed by ``names``, those with which they are paired.
    """
    result = Written({}, {}, set())
    texts = [study["text"], *(file["text"] for file in study.get("checks", ()))]
    for text in texts:
        try:
            tables = tomllib.loads(text)
        except tomllib.TOMLDecodeError:
            continue
        _add(result, tables, (), (), names or {})
    return result


def case_values(study: Mapping[str, Any], name: str) -> dict[Place, object]:
    """Return the values of a case, without its name, by their places in its table and as :func:`_as_compared` has them.

    {} if the study has no such case.
    """
    whole = written(study)
    own = {place[2:]: value for place, value in whole.values.items() if place[:2] == ("case", name)}
    return {place: _as_compared(value) for place, value in own.items() if place != ("name",)}


def _add(result: Written, table: Mapping[str, Any], place: Place, at: Place, names: Mapping[str, str]) -> None:
    """Add the values of a table to ``result``; ``at`` is its place without names and numbers of tables."""
    for key, value in table.items():
        inner = (*at, key)
        section = _SECTIONS.get(inner)
        tables = [value] if isinstance(value, dict) and section is not None and section.many else value
        if isinstance(tables, dict):
            result.tables[(*place, key)] = inner
            _add(result, tables, (*place, key), inner, names)
        elif isinstance(tables, list) and tables and all(isinstance(item, dict) for item in tables):
            for label, item in zip(_labels(tables, key, names if not at else {}), tables, strict=True):
                result.tables[(*place, key, label)] = inner
                result.listed.add((*place, key, label))
                _add(result, item, (*place, key, label), inner, names)
        else:
            is_name = at == ("case",) and key == "name"
            of_case = is_name or (at in (("check",), ("reference",)) and key == "case")
            result.values[(*place, key)] = _renamed(value, names) if of_case else value


def _labels(tables: Sequence[Mapping[str, Any]], key: str, names: Mapping[str, str]) -> Iterator[str]:
    """Yield a label for each table in a list: its name (of a case its base without one), or else its number from 1.

    A case of B that is paired has the name of its pair.
    """
    for number, table in enumerate(tables, 1):
        name = table.get("name", table.get("base", str(number)) if key == "case" else str(number))
        yield names.get(str(name), str(name)) if key == "case" else str(name)


def _renamed(value: object, names: Mapping[str, str]) -> object:
    if isinstance(value, list):
        return [_renamed(item, names) for item in value]
    return names.get(value, value) if isinstance(value, str) else value


def _alone(value: object) -> object:
    """Return the only item of a list or tuple, which a key reads likewise; other values unchanged."""
    return value[0] if isinstance(value, list | tuple) and len(value) == 1 else value


def _as_compared(value: object) -> object:
    """Return a value as it is compared: numbers as floats of ten digits, lists as tuples, a list of one as its item."""
    value = _alone(value)
    if isinstance(value, list | tuple):
        return tuple(map(_as_compared, value))
    return value if isinstance(value, bool) else as_in_peaks(value) if isinstance(value, float | int) else value


def _outermost(tables: set[Place]) -> list[Place]:
    """Return the tables that are in none of the others, in order of their names."""
    return sorted(table for table in tables if not any(table[:n] in tables for n in range(1, len(table))))


def _named(place: Place) -> str:
    """Return the name of an input: "case pads, damper 1, force_kN"; keys of a table at the top follow a dot: "pier.alpha"."""
    if len(place) == 2 and (section := _SECTIONS.get(place[:1])) is not None and not section.many:
        return ".".join(place)
    return ", ".join(_words(place))


def _words(place: Place) -> list[str]:
    """Return the words of a place, a table in a list with its label: ["case pads", "damper 1", "force_kN"]."""
    words: list[str] = []
    at: Place = ()
    is_label = False
    for part in place:
        if is_label:
            words[-1] += f" {part}"
            is_label = False
            continue
        at = (*at, part)
        words.append(part)
        is_label = at in _SECTIONS and _SECTIONS[at].many
    return words


def _contents(study: Written, tables: Sequence[Place]) -> Iterator[tuple[Place, str]]:
    """Yield each of ``tables``, none of which is in another, with its keys and values but its name: "beta = [30, 40]; h = 2".

    Of more than :data:`MOST_VALUES` keys the first are shown; "given" stands for no key but the name.
    """
    inner: dict[Place, list[Place]] = {table: [] for table in tables}
    for place in study.values:
        for n in range(1, len(place)):
            if place[:n] in inner and place[n:] != ("name",):
                inner[place[:n]].append(place)
    for table, places in inner.items():
        names = [", ".join(_words(place)[len(_words(table)) :]) for place in places]
        values = [study.values[place] for place in places]
        words = [f"{name} = {_bracketed(value)}" for name, value in zip(names, values, strict=True)]
        yield table, _first(words, "; ") or "given"


def _bracketed(value: object) -> str:
    """Return a value in words, a list in brackets."""
    return f"[{_shown(value, 4)}]" if isinstance(value, list) else _shown(value, 4)


def _first(words: Sequence[str], between: str = ", ") -> str:
    """Return up to :data:`MOST_VALUES` words with ``between`` them, and "…" for the rest."""
    return between.join([*words[:MOST_VALUES], *(["…"] if len(words) > MOST_VALUES else [])])


def _shown(value: object, digits: int) -> str:
    """Return a value in words, a number with so many ``digits``; "–" for None, a key not written and without a default.

    Of a list the first :data:`MOST_VALUES` values are shown, then "…"; its numbers always have ten digits.
    """
    if value is None:
        return "–"
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, float | int):
        return plain(value, digits)
    if isinstance(value, list | tuple):
        if all(isinstance(item, list | tuple) for item in value):  # points of a backbone, nine at most
            return ", ".join(f"[{', '.join(map(shown, item))}]" for item in value)
        return _first([_shown(item, 10) for item in value])
    return value if isinstance(value, str) else shown(value)


def _of_motions(a: Finished, b: Finished) -> list[Difference]:
    """Return the differences between the motions; [] without any.

    They are motions in one study only, motions that differ under one name, files that could not be used, and files left out.
    """
    only = [[name for name in x.records if name not in y.records] for x, y in ((a, b), (b, a))]
    rows = [Difference("motions in one study only", *(_listed(names, "motion") for names in only))] if any(only) else []
    if other := _unlike(a, b):
        sides = ([f"{name} ({x.records[name]['pga_g']:.4g} g)" for name in other] for x in (a, b))
        rows.append(Difference("different motions under the same name", *(_listed(names, "motion") for names in sides)))
    for key, words in (("unusable", "files that could not be used"), ("left_out", "files left out")):
        names = [[str(file["name"]) for file in x.info.get(key, ())] for x in (a, b)]
        if names[0] != names[1]:
            rows.append(Difference(words, *(_listed(side, "file") for side in names)))
    return rows


def other_motions(a: Finished, b: Finished) -> bool:
    """Return whether two studies ran other motions, or the same at other scales or polarities."""
    requested = [{*zip(x.runs["record"], x.runs["scale"], x.runs["polarity"], strict=True)} for x in (a, b)]
    return requested[0] != requested[1] or bool(_unlike(a, b))


def _unlike(a: Finished, b: Finished) -> list[str]:
    """Return the names of records that are different motions in two studies that have both."""
    return [name for name in a.records if name in b.records and _differ(a.records[name], b.records[name])]


def _differ(first: Mapping[str, Any], second: Mapping[str, Any]) -> bool:
    """Return whether two records are different motions, by their digests, or by their numbers if an earlier version wrote one."""
    if "digest" in first and "digest" in second:
        return bool(first["digest"] != second["digest"])
    keys = ("pga_g", "pga_v_g", "npts", "dt_s")
    return any(as_in_peaks(first[key]) != as_in_peaks(second[key]) for key in keys)


def _listed(names: Sequence[str], noun: str) -> str:
    """Return names separated by commas, "–" for none; of more than six their number before the first: "9 files: a, …"."""
    if len(names) <= MOST_VALUES:
        return ", ".join(names) or "–"
    return f"{counted(len(names), noun)}: {', '.join(names[:MOST_VALUES])}, …"
