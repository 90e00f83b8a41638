"""Reading of TOML tables by their sections; every mistake is kept and reported with its line."""

import io
import tomllib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple

from rockbatch.common.errors import (
    BadSyntax,
    Contradiction,
    InputError,
    MissingKey,
    OutOfRange,
    Problem,
    UnknownKey,
    Unusual,
    WrongType,
    refuse,
)
from rockbatch.common.files import opened_input
from rockbatch.common.showing import shown
from rockbatch.common.units import factor_between, is_weight_of, number_in_unit_of, unit_in_words, unit_of
from rockbatch.toml.files_meant import unreadable
from rockbatch.toml.kinds import Choice, KeyValues, Kind, KindError, Number, Other, Points
from rockbatch.toml.lines import KeyPath, TooDeepError, key_lines
from rockbatch.toml.section import CONFIRM, Key, Section, home, options
from rockbatch.toml.slips import syntax_error

LARGEST = 4 * 2**20
"""Bytes of a study, a manifest or a table of a spectrum: ten thousand records with all that can be said of them."""

_LONGEST = 200  # characters of a name that is shown as it is

MOST_REPORTED = 100
"""Mistakes of a file that are reported at once."""


class Setting(NamedTuple):
    """One value of a key, and its place in the file."""

    value: Any
    key_path: KeyPath


@dataclass
class TomlFile:
    """A TOML file, its values, their lines, and its mistakes so far."""

    path: Path
    text: str
    data: dict[str, Any]
    lines: dict[KeyPath, int]
    sections: Sequence[Section] = ()
    """Tables that the file may have, outer ones before inner, by which messages say where a misplaced key belongs."""
    misspelt: set[KeyPath] = field(default_factory=set)
    """Keys and tables that are probably there under a name that is not known."""
    problems: list[tuple[int, Problem]] = field(default_factory=list)
    """The first ones, ``MOST_REPORTED`` at most, with their lines."""

    @classmethod
    def read(cls, path: Path, sections: Sequence[Section] = ()) -> "TomlFile":
        """Return a file, read and parsed. Raises :class:`InputError` if it cannot be read, with the line if it is no TOML."""
        text = cls.text_of(path, sections)
        return cls.parse(path, text, sections)

    @staticmethod
    def text_of(path: Path, sections: Sequence[Section] = ()) -> str:
        """Return the text of a file of ``sections``. Raises :class:`InputError` if it is unreadable, too large or no UTF-8."""
        try:
            with io.BufferedReader(opened_input(path)) as opened:
                content = opened.read(LARGEST + 1)
        except OSError as error:
            raise unreadable(path, error, sections) from None
        if len(content) > LARGEST:
            raise InputError(
                f"{path}: larger than {LARGEST // 2**20} MiB, which no study, manifest or table of a spectrum is"
            )
        try:
            return content.decode("utf-8-sig")
        except UnicodeDecodeError as error:
            line = content.count(b"\n", 0, error.start) + 1
            raise BadSyntax(f"{path}:{line}: not UTF-8 text; save the file in the encoding UTF-8") from None

    @classmethod
    def parse(cls, path: Path, text: str, sections: Sequence[Section] = (), *, lined: bool = True) -> "TomlFile":
        """Return the file of a text, which need not be on the disk. Raises :class:`InputError` with the line that is no TOML.

        A text that is not ``lined`` was not written by its user: messages do not give its lines.
        """
        lines: dict[KeyPath, int] = {}
        try:
            lines = key_lines(text) if lined else {}
        except TooDeepError as error:
            raise BadSyntax(f"{path}: {error}") from None
        except ValueError:
            pass  # the parser below fails too, with a better message
        try:
            return cls(path, text, tomllib.loads(text), lines, sections)
        except (ValueError, RecursionError) as error:
            raise BadSyntax(syntax_error(path, text, str(error), sections)) from None

    def complain(self, key_path: KeyPath, message: str | Problem, label: str = "") -> None:
        """Add a mistake about the value at ``key_path`` to the problems, once; a missing value has the line of its table.

        ``label`` names the table. A ``message`` that is a problem keeps its kind. A full file takes no more.
        """
        if self.is_full:
            return
        places = (key_path[:n] for n in range(len(key_path), 0, -1))
        line = next((self.lines[place] for place in places if place in self.lines), 0)
        place = f"{self.path}:{line}" if line else f"{self.path}"
        text, key = f"{label}: {message}" if label else str(message), ".".join(map(str, key_path))
        kind = message.kind if isinstance(message, Problem) else None
        problem = (line, Problem(key, self.value(key_path), text, place, kind=kind, named=False))
        if problem not in self.problems:
            self.problems.append(problem)

    def adopt(self, other: "TomlFile", key_path: KeyPath) -> None:
        """Add the mistakes of another file, in its order, to the problems, at the line of the ``key_path`` that names it.

        They are cut off at :data:`MOST_REPORTED` problems in all.
        """
        line = self.lines.get(key_path, 0)
        in_order = sorted(other.problems, key=lambda problem: (problem[0], str(problem[1])))
        self.problems += [(line, problem) for _, problem in in_order][: MOST_REPORTED - len(self.problems)]

    @property
    def is_full(self) -> bool:
        """Return whether there are :data:`MOST_REPORTED` problems, so that reading may stop."""
        return len(self.problems) >= MOST_REPORTED

    def is_sound_since(self, before: int) -> bool:
        """Return whether there are no problems after the first ``before``; False for a full file, which takes no more."""
        return len(self.problems) == before and not self.is_full

    def finish(self) -> None:
        """Raise :class:`InputError` with all mistakes, in the order of the file; return if there are none.

        The last one of a full file says that there may be more.
        """
        in_order = [problem for _, problem in sorted(self.problems, key=lambda problem: problem[0])]
        if self.is_full:
            more = f"{MOST_REPORTED} mistakes are reported at once; there may be more"
            in_order.append(Problem("", None, more, f"{self.path}"))
        refuse(in_order)

    def table(self, *key_path: str | int, required: str = "") -> "Table | None":
        """Return the table ``[key_path]``, or None.

        A value that is no table becomes a problem, and so does a table that is missing, not misspelt, if ``required`` gives an
        example of one.
        """
        name = ".".join(map(str, key_path))
        value = self.value(key_path)
        if isinstance(value, dict):
            return Table(self, key_path, f"[{name}]", value)
        if value is not None:
            self.complain(key_path, f"{name}: expected one table; write [{name}], once")
        elif required and key_path not in self.misspelt:
            self.complain(key_path, _problem(MissingKey, f"[{name}] is missing; write {required}"))
        return None

    def has(self, key_path: KeyPath) -> bool:
        """Return whether there is a value at ``key_path``, or one whose key is probably misspelt."""
        return self.value(key_path) is not None or key_path in self.misspelt

    def tables(self, *key_path: str | int, title: str) -> list["Table"]:
        """Return the tables ``[[key_path]]``, [] if missing, or with a problem for another value.

        The key ``title`` of each names it in messages, or else its number.
        """
        name = ".".join(part for part in key_path if isinstance(part, str))
        value = self.value(key_path)
        if value is None:
            return []
        if not (isinstance(value, list) and all(isinstance(item, dict) for item in value)):
            self.complain(key_path, f"{name}: expected a list of tables; write [[{name}]] above each one")
            return []
        labels = [shown(item[title]) if title in item else f"no. {n}" for n, item in enumerate(value, 1)]
        return [
            Table(self, (*key_path, n), f"[[{name}]] {label}", item)
            for n, (label, item) in enumerate(zip(labels, value, strict=True))
        ]

    def value(self, key_path: KeyPath) -> Any:
        """Return the value at ``key_path``, whose parts are keys and list indices; None if there is none."""
        node: object = self.data
        for part in key_path:
            if isinstance(node, dict):
                node = node.get(str(part))
            else:
                node = node[part] if isinstance(node, list) and isinstance(part, int) and part < len(node) else None
        return node


@dataclass(frozen=True)
class Table:
    """One table of a file, with the name that messages give it."""

    file: TomlFile
    key_path: KeyPath
    label: str
    data: dict[str, Any]

    def complain(self, message: str | Problem, *key: str | int) -> None:
        """Add a mistake about this table, or a key or list element of it, to the problems of the file."""
        self.file.complain((*self.key_path, *key), message, self.label)

    def complain_about(self, setting: Setting, message: str | Problem) -> None:
        """Add a mistake about one value to the problems of the file."""
        self.complain(message, *setting.key_path[len(self.key_path) :])

    @contextmanager
    def noting(self, *key: str | int, before: str = "") -> Iterator[None]:
        """Context manager: turn an ``InputError`` in the block into mistakes about a key; messages begin with ``before``."""
        try:
            yield
        except InputError as error:
            for problem in error.problems:
                self.complain(Problem("", None, f"{before}{problem}", kind=problem.kind, named=False), *key)

    @property
    def names(self) -> list[str]:
        """Return the keys that are written, in the order of the file, and then those that are probably misspelt."""
        return [*self.data, *(str(key_path[-1]) for key_path in self.file.misspelt if key_path[:-1] == self.key_path)]

    def has(self, name: str) -> bool:
        """Return whether the key ``name`` is written, or probably misspelt."""
        return name in self.data or (*self.key_path, name) in self.file.misspelt

    @property
    def confirmed(self) -> frozenset[str]:
        """Return the names in the key ``confirm``, whether the table has keys of these names or not; empty without it."""
        written = self.data.get("confirm", ())
        return frozenset(
            name for name in (written if isinstance(written, list) else [written]) if isinstance(name, str)
        )

    def read(
        self,
        keys: Mapping[str, Key],
        *,
        unfit: Mapping[str, str] | None = None,
        other: Iterable[str] = (),
        places: bool = False,
    ) -> KeyValues:
        """Return the usable values by key, in the order of the file; what is unusable, unknown or missing becomes a problem.

        A caller may go on checking with what is left: :meth:`TomlFile.finish` raises in the end. ``unfit`` gives reasons why keys
        of other tables do not apply here; ``other`` keys are read elsewhere. The value of a key that takes a list or a
        range is a tuple, or with ``places`` a list of :class:`Setting`. ``confirm`` is left to :attr:`confirmed`.
        """
        unfit = unfit or {}
        usable: dict[str, list[Setting]] = {}
        for name, value in self.data.items():
            if self.file.is_full:
                break
            if name not in keys:
                if name in unfit:
                    self.complain(_problem(Contradiction, f"{name} = {shown(value)}: {unfit[name]}"), name)
                elif name not in other:
                    self._unknown(name, keys, other)
            elif reason := self._not_applying(keys, name):
                self.complain(_problem(Contradiction, f"{name} = {shown(value)}: {reason}"), name)
            elif settings := self._usable(name, keys[name], value):
                usable[name] = settings
        self._check_missing(keys)
        self._note_doubts(keys, usable)
        read: KeyValues = {}
        for name, settings in usable.items():
            values = tuple(setting.value for setting in settings)
            several = settings if places else values
            read[name] = several if keys[name].many or keys[name].pair else values[0]
        return read

    def requires(self, keys: Mapping[str, Key], name: str) -> bool:
        """Return whether a key has to be written, given the keys on which it depends; False if one of these is not
        written, or has a value for which the key is not meant."""
        return keys[name].required and all(self.data.get(other) in values for other, values in keys[name].only.items())

    def _check_missing(self, keys: Mapping[str, Key]) -> None:
        """Add to the problems the required keys that are missing, and keys that contradict each other."""
        for name, key in keys.items():
            if self.requires(keys, name) and not self.has(name):
                few = isinstance(key.kind, Choice) and not key.kind.listed_by
                choices = f"; {name} is {key.kind.words}" if few else ""
                message = f"{name} is missing; write for example {name} = {key.example}{choices}"
                self.complain(_problem(MissingKey, message))
        for clash in keys.clashes if isinstance(keys, Section) else ():
            if all(map(self.has, clash.given)) and not any(map(self.has, clash.lacking)):
                first = clash.given[0]
                named = f"{first} = {shown(self.data.get(first))}: " if clash.shown else ""
                self.complain(_problem(Contradiction, f"{named}{clash.message}"), clash.at or first)

    def _not_applying(self, keys: Mapping[str, Key], name: str) -> str:
        """Return why the key ``name`` does not apply beside the values of other keys; "" if it does.

        A key that is not written has its default; one that is required, or has an unknown value, is a mistake by itself.
        """
        for other, values in keys[name].only.items():
            instead = " or ".join(f"{other} = {shown(value)}" for value in values)
            if other not in self.data:
                default = keys.default(other) if isinstance(keys, Section) else keys[other].default
                if default in values or keys[other].required or self.has(other):
                    continue
                return f"is for {instead}; write that too, or leave it out"
            written = self.data[other]
            written_values = written if isinstance(written, list) else [written]
            if written_values and not any(
                value in values or value not in options(keys[other]) for value in written_values
            ):
                return f"does not apply to {other} = {' or '.join(map(shown, written_values))}; leave it out, or write {instead}"
        return ""

    def _note_doubts(self, keys: Mapping[str, Key], usable: dict[str, list[Setting]]) -> None:
        """Add problems of confirmed keys that the table lacks, and of unusual values that are not confirmed.

        ``confirm`` is taken out of ``usable``.
        """
        if keys.get("confirm") is CONFIRM["confirm"]:
            present = [shown(name) for name in self.data if name in keys and name != "confirm"]
            for setting in usable.pop("confirm", ()):
                if shown(setting.value) not in present:
                    instead = f"write one of {', '.join(present)}" if present else "leave it out"
                    message = f"confirm = {shown(setting.value)}: this table has no such key; {instead}"
                    self.complain_about(setting, _problem(UnknownKey, message))
        for name in (name for name in usable if name not in self.confirmed):
            for setting in usable[name]:
                for problem in keys[name].doubts(name, setting.value):
                    self.complain_about(setting, in_table(problem))

    def _usable(self, name: str, key: Key, value: object) -> list[Setting]:
        """Return the usable values of a key with their places, of a range both ends or none; others become problems.

        So does a repeated value of a list that has to be distinct, which is returned nevertheless.
        """
        whole = Setting(value, (*self.key_path, name))
        items = [whole]
        if isinstance(value, list) and not isinstance(key.kind, Points):
            items = [Setting(item, (*whole.key_path, n)) for n, item in enumerate(value)]
            if not (key.many or key.pair):
                self._not_one(name, key, whole)
                return []
            if key.many and not items:
                self._wrong(name, key, whole, KindError("at least one value"))
        usable: list[Setting] = []
        visited: set[str] = set()
        for item in items:
            converted = self._converted(name, key, item)
            if self.file.is_full:
                break
            if converted is None:
                continue
            if key.many and key.distinct and repr(converted) in visited:
                self.complain_about(item, f"{name} = {shown(item.value)}: given twice; write it once")
            visited.add(repr(converted))
            usable.append(Setting(converted, item.key_path))
        if not key.pair:
            return usable
        ends = [end.value for end in usable]
        if len(ends) < len(items):
            return []
        if len(ends) == 2 and ends[0] < ends[1]:
            return usable
        example = shown([min(ends), max(ends)]) if ends and min(ends) < max(ends) else key.example
        self.complain(f"{name} = {shown(value)}: expected a range; write for example {name} = {example}", name)
        return []

    def _converted(self, name: str, key: Key, setting: Setting) -> object:
        """Return a value as its kind converts it; None if its kind refuses it, with the problem added."""
        try:
            return key.kind(setting.value)
        except KindError as wrong:
            self._wrong(name, key, setting, wrong)
            return None

    def _not_one(self, name: str, key: Key, whole: Setting) -> None:
        """Add the problem of a list, or of several tables, where the key takes a single value or table."""
        if isinstance(key.kind, Other) and all(isinstance(item, dict) for item in whole.value):
            header = ".".join(part for part in whole.key_path if isinstance(part, str))
            self.complain(f"{name}: expected one table; write [{header}], once", name)
        else:
            meant = shown(whole.value[0]) if len(whole.value) == 1 and _is_fit(key.kind, whole.value[0]) else None
            self._wrong(name, key, whole, KindError("one value, not a list", meant))

    def _wrong(self, name: str, key: Key, setting: Setting, wrong: KindError) -> None:
        """Add the problem of a value that its kind refuses, with an example unless the message has one."""
        if isinstance(key.kind, Number) and isinstance(setting.value, str) and not wrong.meant:
            wrong = KindError(str(wrong), number_in_unit_of(name, setting.value), whole=wrong.whole)
        example = "" if wrong.meant or wrong.whole or options(key) else f"; write for example {name} = {key.example}"
        message = f"{name} = {shown(setting.value)}: {wrong.advice()}{example}"
        self.complain_about(setting, _problem(OutOfRange if wrong.whole else WrongType, message))

    def _unknown(self, name: str, keys: Mapping[str, Key], other: Iterable[str]) -> None:
        """Add the problem of a key or table that is not known here, with the one that may be meant."""
        section = not self.key_path and isinstance(self.data[name], dict | list)
        complaint = "unknown section" if section else "unknown key"
        written = name if name.isidentifier() and len(name) <= _LONGEST else shown(name)
        self.complain(_problem(UnknownKey, f"{written}: {complaint}; {self._instead(name, keys, other)}"), name)

    def _instead(self, name: str, keys: Mapping[str, Key], other: Iterable[str]) -> str:
        """Return what to write instead of an unknown key: another of this table, the table where it belongs, or all keys.

        A key that is probably meant counts as misspelt from then on, so that it is not reported as missing.
        """
        place = tuple(part for part in self.key_path if isinstance(part, str))
        own = next((section for section in self.file.sections if section.at == place), Section(place, "", keys))
        own = keys if isinstance(keys, Section) else own
        known = [key for key in keys if not self._not_applying(keys, key)]  # advice must not lead to the next mistake
        if place or not isinstance(self.data[name], dict | list):
            known += other if place else ()
        else:
            known = list(other)
        meant, advice = own.advice(name)
        if not advice:
            meant = own.known_as(name, [key for key in known if key not in self.data]) or own.known_as(name, known)
        if meant and meant not in self.data:
            self.file.misspelt.add((*self.key_path, meant))
        if advice or meant:
            return _with_value(name, self.data[name], meant, advice)
        if not isinstance(self.data[name], dict | list) and (belongs := home(self.file.sections, name, place)):
            return f"it belongs under {belongs}"
        inner = {section.at[-1]: section.header for section in self.file.sections if len(section.at) > 1}
        if not place and (nested := own.known_as(name, inner)):
            return f"write {inner[nested]}"
        return f"write one of {', '.join(known)}"


def _with_value(name: str, value: Any, meant: str, advice: str) -> str:
    """Return what to write for an unknown key: the key ``meant``, with its value if the units differ, and the ``advice``.

    width_mm = 4000 gives "write width_m = 4, in m", and widht_m "did you mean width_m?"; with advice there is a value only if a
    weight is written for a mass.
    """
    if not meant:
        return advice
    unit, own = unit_of(name), unit_of(meant)
    factor = factor_between(unit, own) if unit and (not advice or is_weight_of(unit, own)) else None
    numbers = value if isinstance(value, list) else [value]
    if factor is not None and factor != 1.0 and all(type(number) in (int, float) for number in numbers):
        converted = [f"{number * factor:.10g}" for number in numbers]
        written = f"[{', '.join(converted)}]" if isinstance(value, list) else converted[0]
        return f"write {meant} = {written}, {advice or (f'in {unit_in_words(own)}' if own else 'as a share of 1')}"
    differs = f" it is in {unit_in_words(own)}" if unit and own and unit != own else ""
    return f"write {meant}, {advice}" if advice else f"did you mean {meant}?{differs}"


def _is_fit(kind: Kind, value: object) -> bool:
    """Return whether a value is of a kind."""
    try:
        kind(value)
    except KindError:
        return False
    return True


def _problem(kind: type[InputError], message: str) -> Problem:
    """Return a message as a problem of a kind, without a place, which the file adds."""
    return Problem("", None, message, kind=kind)


def in_table(problem: Problem, table: str = "this table") -> Problem:
    """Return a problem whose sentence ends with "in" and the ``table`` in which to confirm it.

    A problem that cannot be confirmed is returned unchanged.
    """
    return _problem(Unusual, f"{problem} in {table}") if problem.confirm else problem
