"""Declarations of tables: for each key its kind, an example, its meaning and when it applies.

From them follow the reader (:mod:`reader`), the JSON schemas, the reference in the documentation and the messages.
"""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import MISSING, dataclass, field, fields, replace
from typing import Any, NamedTuple

from rockbatch.common.errors import Problem
from rockbatch.common.units import Usual, unit_of
from rockbatch.toml.kinds import Choice, Kind, text
from rockbatch.toml.meant import Also, known_as, plain


@dataclass(frozen=True)
class Key:
    """A key of a table."""

    kind: Kind
    example: str  # a value as TOML writes it, for messages
    words: str = ""  # what it means, in a sentence
    required: bool = False  # whether it has to be written, where it applies
    many: bool = False  # whether a list is welcome; the value read is then a tuple, also for a single value
    distinct: bool = True  # whether the values of a list must differ
    pair: bool = False  # whether it is a range, [low, high]; the value read is then a tuple
    usual: Usual | None = None
    default: object = None  # the value that counts if the key is not written, where no dataclass of the section has it
    # another key of the table, and its values with which this key applies
    only: Mapping[str, tuple[Any, ...]] = field(default_factory=dict)

    @property
    def always_required(self) -> bool:
        """Return whether it has to be written whatever the other keys are."""
        return self.required and not self.only

    def doubts(self, name: str, value: float) -> list[Problem]:
        """Return the problem of an unusual value of the key ``name``, to be confirmed; empty for a usual one."""
        return [] if self.usual is None else self.usual.doubts(name, value)


def options(key: Key) -> tuple[object, ...]:
    """Return the values between which a key chooses, without those of ``also``; () for a key that is no choice."""
    return key.kind.options if isinstance(key.kind, Choice) else ()


class Clash(NamedTuple):
    """Keys that contradict each other: a mistake if all of ``given`` are written and none of ``lacking`` is.

    ``message`` stands at the key ``at``, or at the first one, which is ``shown`` before it, with its value.
    """

    given: tuple[str, ...]
    message: str
    lacking: tuple[str, ...] = ()
    at: str = ""
    shown: bool = False


def fix_the_same(*names: str) -> str:
    """Return the message on keys that fix the same."""
    return f"{' and '.join(names)} are given, which fix the same; keep one"


def either(first: str, second: str) -> Clash:
    """Return the contradiction between two keys that fix the same, noted at the second."""
    return Clash((first, second), fix_the_same(first, second), at=second)


def beside(key: str, missing: str, example: str, words: str = "") -> Clash:
    """Return the mistake of a ``key`` without another beside it, of which ``words`` and an ``example`` follow."""
    message = f"{missing} is missing beside {key}{words}; write for example {missing} = {example}"
    return Clash((key,), message, lacking=(missing,))


CONFIRM = {"confirm": Key(text, '["height_m"]', "Keys of this table with unusual values that are correct.", many=True)}
"""The key by which a table confirms its values."""


@dataclass(frozen=True)
class Section(Mapping[str, Key]):
    """A table of a TOML file: a mapping of its keys."""

    at: tuple[str, ...]  # its name, such as ("motions", "pulse"); empty for the keys at the top of the file
    about: str  # what it is for
    keys_read: Mapping[str, Key]
    many: bool = False  # whether there may be several, under double brackets
    required: bool = False
    homes: tuple[type, ...] = ()  # dataclasses whose fields have the defaults of keys
    single: bool = False  # whether one of several may also stand under single brackets
    clashes: tuple[Clash, ...] = ()
    free: str = ""  # pattern of further keys that the section cannot list because a study makes their names
    free_schema: Mapping[str, Any] = field(default_factory=lambda: {"type": "number"})  # JSON schema of their values
    numbered: bool = False  # whether the same table may go with a number, too: damper_2
    # other names of its keys, letters and digits in lower case; a unit may follow them in a file
    also: Mapping[str, Also] = field(default_factory=dict)
    # names in the same form for which there is no key, and what to write; or the key of which the value has to change, and how
    instead: Mapping[str, str | tuple[str, str]] = field(default_factory=dict)

    def __getitem__(self, name: str) -> Key:
        return self.keys_read[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self.keys_read)

    def __len__(self) -> int:
        return len(self.keys_read)

    @property
    def header(self) -> str:
        """Return its header in the file: "[pier]", "[[motions.pulse]]"; "" for the top."""
        name = ".".join(self.at)
        return (f"[[{name}]]" if self.many else f"[{name}]") if name else ""

    def known_as(self, name: str, names: Iterable[str]) -> str:
        """Return which of ``names`` a name means, as :func:`rockbatch.toml.meant.known_as` does; empty if none."""
        return known_as(name, names, self.also, self.at[-1] if self.at else "")

    def advice(self, name: str) -> tuple[str, str]:
        """Return the key to write in place of an unknown name, and what to say of it, each "" if there is none.

        weight_kN gives ("mass_t", "the weight in kN over 9.81"). Without a key the words are the whole advice.
        """
        names = dict.fromkeys((plain(name), plain(name.removesuffix(f"_{unit_of(name)}"))))
        advice = next(filter(None, map(self.instead.get, names)), "")
        return ("", advice) if isinstance(advice, str) else (advice[0], advice[1])

    def default(self, name: str) -> object:
        """Return the value of a key that is not written; None if there is none, or it follows from others.

        It does where its ``homes`` differ in it; a key that is required where it applies has none.
        """
        of_homes = {field.default for home in self.homes for field in fields(home) if field.name == name}
        default = of_homes.pop() if len(of_homes) == 1 and not self[name].required else None
        return self[name].default if default in (MISSING, None, (), "") else default


def joined(section: Section, *more: Section) -> Section:
    """Return ``section`` with the keys, homes, names in ``also`` and clashes of all sections; the rest stays its own.

    Of a key or name in several sections the last counts.
    """
    sections = (section, *more)
    return replace(
        section,
        keys_read={name: key for part in sections for name, key in part.items()},
        homes=tuple(home for part in sections for home in part.homes),
        also={name: words for part in sections for name, words in part.also.items()},
        clashes=tuple(clash for part in sections for clash in part.clashes),
    )


_GENERAL = {
    "at",
    "columns",
    "confirm",
    "count",
    "damping",
    "dt",
    "f",
    "file",
    "gamma",
    "kind",
    "n",
    "name",
    "nu",
    "offset",
    "path",
    "period_s",
    "polarity",
    "reason",
    "records",
    "scale",
    "side",
    "source",
    "type",
    "unit",
}
"""Names that mean something else in tables that do not belong together."""


def home(sections: Iterable[Section], name: str, place: tuple[str, ...]) -> str:
    """Return the headers of tables but that at ``place`` that list a key ``name``: "[pier] or [[case]]"; "" for none.

    "" also for names that mean something else in other tables, such as "file". Tables with free keys do not count.
    """
    others = (section for section in sections if section.at and section.at != place)
    headers = dict.fromkeys(section.header for section in others if name in section and not section.free)
    return "" if name in _GENERAL else " or ".join(headers)
