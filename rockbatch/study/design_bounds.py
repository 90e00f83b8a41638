"""Bounds of a design: changes of keys, by their full paths, that apply to every case, one bound at a time."""

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from rockbatch.common.grouping import closest
from rockbatch.common.showing import shown
from rockbatch.pier.supports import FIXED_BY_POINTS
from rockbatch.quantities.design import BOUND
from rockbatch.study.lists import Chosen
from rockbatch.toml.kinds import KindError
from rockbatch.toml.reader import Table, TomlFile, in_table
from rockbatch.toml.section import Key

_NUMBERED = re.compile(r"(.+?)(?:_([1-9][0-9]*))?")
_OF_TABLE = re.compile(r"(.+?)_[1-9][0-9]*_(.+)")


@dataclass(frozen=True)
class Change:
    """A change of one key: its path, and a value or a factor on that of the nominal design."""

    path: str
    key: Key = field(repr=False)
    value: Any = None
    times: float | None = None

    @property
    def of_pier(self) -> bool:
        """Return whether the change is of a key of [pier] or of its parts, not of a case."""
        return self.path.startswith("pier.")

    @property
    def words(self) -> str:
        """Return the change in words: "case.damper.f × 1.2", "pier.deck_mass_t = 950"."""
        if self.times is not None:
            return f"{self.path} × {self.times:.10g}"
        return f"{self.path} = {f'{self.value:.10g}' if isinstance(self.value, float) else shown(self.value)}"

    def among(self, names: Iterable[str]) -> list[str]:
        """Return those of ``names`` that are values of its key: "damper_1_f" and "damper_2_f" of "case.damper.f"; [] if none.

        Of "case.damper_2.f" it is "damper_2_f" alone.
        """
        _, *table, name = self.path.split(".")
        pattern = re.escape(name)
        if table:
            what, number = parted(table[0])
            pattern = rf"{what}_{number or '[0-9]+'}_{pattern}"
        return [name for name in names if re.fullmatch(pattern, name)]

    def of(self, value: Any) -> Any:
        """Return the changed value of its key, nominally ``value``: a value of its own, or ``value`` times its factor.

        Raises :class:`KindError` for an impossible product.
        """
        if self.times is None:
            return self.value
        changed = value * self.times
        return self.key.kind(int(changed) if isinstance(value, int) and changed == int(changed) else changed)


@dataclass(frozen=True)
class DesignBound:
    """A bound of a design: its name, its changes and their source.

    ``lacking`` has the names of cases that lack keys of it, and run with these unchanged, with the paths of the keys. Of a bound
    with ``any_of_these`` a case needs one key only, as of two units of one quantity.
    """

    name: str
    changes: tuple[Change, ...]
    source: str = ""
    lacking: tuple[tuple[str, tuple[str, ...]], ...] = ()
    confirmed: frozenset[str] = frozenset()
    place: int = 0
    any_of_these: bool = False

    def changed(self, chosen: Chosen, table: Table, *, of_pier: bool) -> Chosen:
        """Return the chosen values of a pier, or of a case, under this bound.

        An impossible value stays nominal; the problem, or that of an unusual value, is added to ``table``.
        """
        result = dict(chosen)
        for change in (change for change in self.changes if change.of_pier == of_pier):
            for name in change.among(chosen):
                try:
                    value = change.of(chosen[name].value)
                except KindError as wrong:
                    table.complain(f"{change.words}, from {shown(chosen[name].value)}: {wrong.advice()}")
                    continue
                result[name] = chosen[name]._replace(value=value)
                key = change.path.rpartition(".")[2]
                if isinstance(value, float | int) and key not in table.confirmed:
                    for problem in change.key.doubts(key, value):
                        table.complain(in_table(problem))
        return result

    def without_mistakes(self, file: TomlFile) -> TomlFile:
        """Return a copy of ``file`` without its problems, to gather those that a design has under this bound."""
        return replace(file, problems=[], misspelt=set(file.misspelt))

    def table(self, table: Table, file: TomlFile) -> Table:
        """Return a table of the study whose problems are added to ``file``, with the keys that the bound confirms confirmed."""
        return replace(table, file=file, data=table.data | {"confirm": [*table.confirmed, *self.confirmed]})

    def note(self, file: TomlFile, gathered: TomlFile) -> None:
        """Add the problems that were ``gathered`` under this bound to those of ``file``, at this bound."""
        for _, problem in gathered.problems:
            file.complain((BOUND, self.place), replace(problem, place="", key=""), self.label)

    @property
    def label(self) -> str:
        """Return the words by which messages name it: '[[bound]] "stiff ground"'."""
        return f"[[{BOUND}]] {shown(self.name)}"

    def as_in_run_json(self) -> dict[str, Any]:
        """Return its entry in run.json: name, source, changes in words, and the cases that lack keys of it."""
        return {
            "bound": self.name,
            "source": self.source,
            "changes": [change.words for change in self.changes],
            "lacking": [{"case": case, "keys": list(paths)} for case, paths in self.lacking],
        }


def parted(table: str) -> tuple[str, str]:
    """Return the name of a table and its number, empty without one: ("damper", "2") of "damper_2"."""
    match = _NUMBERED.fullmatch(table)
    return (match[1], match[2] or "") if match else (table, "")


def placed(
    file: TomlFile, bounds: Sequence[DesignBound], of_pier: Sequence[str], cases: Mapping[str, Sequence[str]]
) -> tuple[DesignBound, ...]:
    """Return the bounds with their ``lacking`` cases; keys that [pier], or every case, lacks become problems of ``file`` instead.

    ``of_pier`` are the names of the chosen values of the pier, and ``cases`` those of each case.
    """
    result = []
    for bound in bounds:
        if bound.any_of_these:
            result.append(_placed_in_any(file, bound, cases))
            continue
        lacking: dict[str, list[str]] = {}
        for change in bound.changes:
            having = {"[pier]": of_pier} if change.of_pier else cases
            without = [name for name, keys in having.items() if not change.among(keys)]
            if any(having.values()) and len(without) == len(having):
                file.complain((BOUND, bound.place, change.path), _why_none(change, having.values()), bound.label)
                continue
            for name in without:
                lacking.setdefault(name, []).append(change.path)
        result.append(replace(bound, lacking=tuple((name, tuple(paths)) for name, paths in lacking.items())))
    return tuple(result)


def _placed_in_any(file: TomlFile, bound: DesignBound, cases: Mapping[str, Sequence[str]]) -> DesignBound:
    """Return a bound with the changes whose keys cases have, and the cases that have none; note it if no case has any."""
    found = [change for change in bound.changes if any(map(change.among, cases.values()))]
    paths = tuple(change.path for change in bound.changes)
    if any(cases.values()) and not found:
        text = f"no case has one of the keys that it changes: {', '.join(paths)}; leave it out"
        file.complain((BOUND, bound.place, "preset"), text, bound.label)
    lacking = tuple((name, paths) for name, keys in cases.items() if not any(change.among(keys) for change in found))
    return replace(bound, changes=tuple(found), lacking=lacking)


def _why_none(change: Change, having: Iterable[Iterable[str]]) -> str:
    """Return the message on a change of a key that [pier], or every case, lacks; ``having`` are the names of the given keys."""
    where = "[pier]" if change.of_pier else "a [[case]]"
    state = f"{where} has no such key" if change.of_pier else "no case has this key"
    if change.times is not None:
        state += ", so that there is nothing to multiply"
    top, *_, key = change.path.split(".")
    if key in FIXED_BY_POINTS and any("backbone_mm_kN" in names for names in having):
        return f'{change.words}: {state}; write the points in the bound, "case.backbone_mm_kN" = [[…]]'
    near = closest(change.path, sorted({_path(top, name) for names in having for name in names}))
    hint = f", or did you mean {shown(near)}?" if near else ""
    return f"{change.words}: {state}; write its nominal value in {where}{hint}"


def _path(top: str, name: str) -> str:
    """Return the path of the key of a chosen value: "case.damper.f" of "damper_1_f"."""
    match = _OF_TABLE.fullmatch(name)
    return f"{top}.{match[1]}.{match[2]}" if match else f"{top}.{name}"
