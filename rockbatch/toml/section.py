"""Declarations of tables: for each key its kind, an example, its meaning and when it applies.

From them follow the reader (:mod:`reader`), the JSON schemas, the reference in the documentation and the messages.
"""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import MISSING, dataclass, field, fields
from typing import Any, NamedTuple

from rockbatch.toml.kinds import Choice, Kind, text


class Usual(NamedTuple):
    """The largest value that is usual, and a word on it; larger ones have to be confirmed."""

    most: float
    words: str


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
    "confirm": Key(text, '["height_m"]', "Keys of this table whose values are far from usual and right all the same.", many=True)
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

    def default(self, name: str) -> Any:
        """Return the value of a key that is not written; None if there is none, or it follows from others."""
        for home in self.homes:
            for attribute in fields(home):
                if attribute.name == name and attribute.default not in (MISSING, None, (), ""):
                    return attribute.default
        return self[name].default


def homes(sections: Iterable[Section]) -> dict[str, str]:
    """Return by the name of a key or of an inner table, where it belongs."""
    headers: dict[str, dict[str, None]] = {}
    outer: dict[tuple[str, ...], Section] = {}
    for section in sections:
        outer[section.at] = section
        if len(section.at) > 1:
            above = outer[section.at[:-1]]
            headers[section.at[-1]] = {f"{'its ' if above.many else ''}{above.header}: write {section.header}": None}
        for name in section if section.at else ():
            if not (section.free and name in headers):  # a reference repeats the keys of cases
                headers.setdefault(name, {})[section.header] = None
    tables = {section.at[0] for section in outer.values() if section.at}
    return {name: " or ".join(places) for name, places in headers.items() if name not in ("name", "confirm", *tables)}
