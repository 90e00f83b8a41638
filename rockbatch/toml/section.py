"""Declarations of tables: for each key its kind, an example, its meaning and when it applies.

From them follow the reader (:mod:`reader`), the JSON schemas, the reference in the documentation and the messages.
"""

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import MISSING, dataclass, field, fields
from typing import Any, NamedTuple

from rockbatch.toml.kinds import Choice, Kind, KindError, Number, text
from rockbatch.toml.meant import Also, Meant, in_another_unit, known_as, plain, quantity_of


class Usual(NamedTuple):
    """The largest and the least size of a value that are usual, and a word on them; others, but for 0, have to be confirmed."""

    most: float
    words: str
    least: float = 0.0

    def holds(self, value: float) -> bool:
        """Return whether a value is usual."""
        return not isinstance(value, int | float) or value == 0 or self.least <= abs(value) <= self.most

    def doubt(self, name: str, value: float) -> str:
        """Return what is odd about a value of the key ``name``, and in which unit it would be usual; empty if nothing is."""
        if self.holds(value):
            return ""
        bound = f"more than {self.most:g}" if abs(value) > self.most else f"less than {self.least:g}"
        other = in_another_unit(name, value, self.holds)
        return f"{name} = {value:g}: {bound} {self.words}{other}"


@dataclass(frozen=True)
class Key:
    """A key of a table.

    Attributes
    ----------
    kind : Kind
        Its values.
    example : str
        A value as TOML writes it, for messages.
    words : str
        What it means, in a sentence.
    required : bool
        Whether it has to be written, where it applies.
    many : bool
        Whether a list is welcome; the value read is then a tuple, also for a single value.
    distinct : bool
        Whether the values of a list must differ.
    pair : bool
        Whether it is a range, [low, high]; the value read is then a tuple.
    usual : Usual, optional
    default : object
        The value that counts if the key is not written, where no dataclass of the section has it.
    only : mapping of str to tuple
        Another key of the table, and its values with which this key applies.
    """

    kind: Kind
    example: str
    words: str = ""
    required: bool = False
    many: bool = False
    distinct: bool = True
    pair: bool = False
    usual: Usual | None = None
    default: Any = None
    only: Mapping[str, tuple[Any, ...]] = field(default_factory=dict)

    @property
    def always_required(self) -> bool:
        """Return whether it has to be written whatever the other keys are."""
        return self.required and not self.only

    @property
    def unit(self) -> str:
        """Return the unit of its value as names of keys have it, "rad_s", if its kind says it; else empty."""
        bounds = self.kind.bounds if isinstance(self.kind, Number) else None
        written = re.match(r" \[(.+?)\]", bounds.unit) if bounds else None
        return written[1].replace("/", "_").replace("²", "2") if written else ""

    def doubt(self, name: str, value: Any) -> str:
        """Return what is odd about a value, with its ``name``; empty if nothing is."""
        return self.usual.doubt(name, value) if self.usual else ""

    def accepts(self, value: Any) -> bool:
        """Return whether it takes the value, or one of a list."""
        try:
            self.kind(value[0] if isinstance(value, list) and value and (self.many or self.pair) else value)
        except KindError:
            return False
        return True


def options(key: Key) -> tuple[Any, ...]:
    """Return the values that a key may have, if they are a few."""
    return key.kind.options if isinstance(key.kind, Choice) else ()


class Clash(NamedTuple):
    """Keys that do not go together: wrong where all of ``given`` are written and none of ``lacking`` is.

    ``message`` may show the value of the first key as {value}; it stands at the key ``at``, or at that first one.
    """

    given: tuple[str, ...]
    message: str
    lacking: tuple[str, ...] = ()
    at: str = ""


CONFIRM = {
    "confirm": Key(text, '["height_m"]', "Keys of this table with unusual values that are correct.", many=True)
}  # fmt: skip
"""The key by which a table confirms its values."""


@dataclass(frozen=True)
class Section(Mapping[str, Key]):
    """A table of a TOML file: a mapping of its keys.

    Attributes
    ----------
    at : tuple of str
        Its name, such as ("motions", "pulse"); empty for the keys at the top of the file.
    about : str
        What it is for.
    keys_read : mapping of Key
    many : bool
        Whether there may be several, under double brackets.
    required : bool
    homes : tuple of type
        Dataclasses whose fields have the defaults of keys.
    single : bool
        Whether one of several may also stand under single brackets.
    clashes : tuple of Clash
    free : str
        Pattern of further keys, numbers that the section cannot list because a study makes their names.
    numbered : bool
        Whether the same table may go with a number, too: damper_2.
    also : mapping of str to Also
        Other names of its keys, letters and digits in lower case; a unit may follow them in a file.
    instead : mapping of str to str
        Names in the same form for which there is no key, or for which the value has to change, and what to write.
    """

    at: tuple[str, ...]
    about: str
    keys_read: Mapping[str, Key]
    many: bool = False
    required: bool = False
    homes: tuple[type, ...] = ()
    single: bool = False
    clashes: tuple[Clash, ...] = ()
    free: str = ""
    numbered: bool = False
    also: Mapping[str, Also] = field(default_factory=dict)
    instead: Mapping[str, str] = field(default_factory=dict)

    def __getitem__(self, name: str) -> Key:
        return self.keys_read[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self.keys_read)

    def __len__(self) -> int:
        return len(self.keys_read)

    @property
    def header(self) -> str:
        """Its header in the file: "[pier]", "[[motions.pulse]]"; empty for the top."""
        name = ".".join(self.at)
        return (f"[[{name}]]" if self.many else f"[{name}]") if name else ""

    def known_as(self, name: str, names: Iterable[str]) -> Meant | None:
        """Return which of ``names``, keys of it or of other tables, a name means; see :func:`rockbatch.toml.meant.known_as`."""
        return known_as(name, {key: self[key].unit if key in self else "" for key in names}, self.also)

    def advice(self, name: str) -> str:
        """Return what to write instead of a name for which there is no key; empty if nothing is known about it."""
        stem, _, _ = quantity_of(name)
        return self.instead.get(plain(name)) or self.instead.get(plain(stem), "")

    def default(self, name: str) -> Any:
        """Return the value of a key that is not written; None if there is none, or it follows from others."""
        for home in self.homes:
            for attribute in fields(home):
                if attribute.name == name and attribute.default not in (MISSING, None, (), ""):
                    return attribute.default
        return self[name].default


_GENERAL = {
    "at", "columns", "count", "damping", "dt", "f", "file", "gamma", "kind", "n", "nu", "offset", "path", "period_s", "polarity",
    "records", "reason", "scale", "side", "source", "type", "unit",
}  # fmt: skip
"""Names that mean something else in tables that do not belong together."""


def home(sections: Iterable[Section], name: str, value: Any, place: tuple[str, ...]) -> str:
    """Return where a key or an inner table of this name belongs that takes the value, for one at ``place``; else empty."""
    headers: dict[str, None] = {}
    outer: dict[tuple[str, ...], Section] = {}
    for section in sections:
        outer[section.at] = section
        if len(section.at) > 1 and section.at[-1] == name and isinstance(value, dict | list):
            above = outer[section.at[:-1]]
            return f"{'its ' if above.many else ''}{above.header}: write {section.header}"
        related = section.at[: len(place)] == place[: len(section.at)]
        repeated = section.free and headers  # a reference repeats the keys of cases
        known = section.at and name in section and not repeated and name not in ("name", "confirm")
        if known and (related or name not in _GENERAL) and section[name].accepts(value):
            headers[section.header] = None
    return " or ".join(headers)


def elsewhere(sections: Iterable[Section], name: str, value: Any, place: tuple[str, ...]) -> str:
    """Return the key, and its table, that is also called ``name`` and takes the value, for one at ``place``; else empty."""
    for section in sections:
        key = section.known_as(name, section) if section.at and section.at != place else None
        if key and plain(key.key) != plain(name) and section[key.key].accepts(value):
            return f"{key.key}, under {section.header}"
    return ""
