"""Kinds of values: each returns a value as the program uses it, says what it expects, and gives its JSON schema."""

import math
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, ClassVar, Protocol

from rockbatch.common.files import legible
from rockbatch.common.showing import shown
from rockbatch.common.units import LEAST, MOST, Bounds, of_percent
from rockbatch.toml.meant import words_meant

_SHORT = 100  # most characters of an expectation that is added to a suggestion

Schema = dict[str, Any]
"""A JSON schema, draft 7."""

KeyValues = dict[str, Any]
"""Values of a table by key, each as the :class:`Kind` of its key returns it."""


class KindError(ValueError):
    """A value that cannot be used: what was expected, and the value that was probably meant.

    ``whole`` marks a message that is complete as it stands and needs no "expected" before it and no example after it.
    """

    def __init__(self, expected: str, meant: str | None = None, *, whole: bool = False) -> None:
        super().__init__(expected)
        self.meant, self.whole = meant, whole

    def advice(self) -> str:
        """Return "did you mean 0.5?", then "expected …" if that is short; without a meant value "expected …" alone.

        A ``whole`` message is returned as it is.
        """
        if not self.meant or self.whole:
            return str(self) if self.whole else f"expected {self}"
        return f"did you mean {self.meant}?" + (f" expected {self}" if len(str(self)) < _SHORT else "")


class Kind(Protocol):
    """The values that a key may have, and their form in the program.

    ``numeric`` is True if each is one number, which may be multiplied.
    """

    numeric: ClassVar[bool]

    @property
    def words(self) -> str:
        """Return the expected values in words, for messages and the reference."""

    def __call__(self, value: object) -> Any:
        """Return the value as the program uses it. Raises :class:`KindError` for one that is not of this kind."""

    def schema(self) -> Schema:
        """Return the JSON schema of the values that are accepted."""


@dataclass(frozen=True)
class Number:
    """A finite number within ``low`` and ``high``, 0 or of a size from 1e-15 to 1e15; an integer will do, a boolean will not.

    ``text`` is what a message expects; ``above`` and ``below`` exclude these ends. ``bounds`` are those of the quantity, whose
    message explains itself; ``but`` is the one number that is excluded; ``endless`` accepts positive infinity, which leaves a
    range open.
    """

    text: str = "a number"
    low: float = -math.inf
    high: float = math.inf
    above: bool = False
    below: bool = False
    bounds: Bounds | None = None
    but: float | None = None
    endless: bool = False
    numeric: ClassVar[bool] = True

    @property
    def words(self) -> str:
        bounds = self.bounds
        if bounds is None or (0.0 < bounds.low <= LEAST and bounds.high >= MOST):
            return self.text
        if bounds.high >= MOST:
            return f"a number, {bounds.low:.7g} or above"
        return f"a number from {bounds.low:g} to {'below ' if bounds.below else ''}{bounds.high:g}"

    def __call__(self, value: object) -> float:
        if self.endless and isinstance(value, float) and value == math.inf:
            return value
        converted = _finite_float(value)
        if converted not in Bounds(self.low, self.high, above=self.above, below=self.below) or converted == self.but:
            share = of_percent(converted, self.low, self.high)
            raise KindError(self.text, None if share is None else f"{share:g}")
        if converted != 0 and not LEAST <= abs(converted) <= MOST:
            raise KindError(f"a number of the size {LEAST:g} to {MOST:g}")
        if self.bounds is not None and converted not in self.bounds:
            raise KindError(self.bounds.message(converted), whole=True)
        return converted

    def schema(self) -> Schema:
        limits = self.bounds or Bounds(self.low, self.high, above=self.above, below=self.below)
        form: Schema = {"type": "number"}
        if limits.low > -math.inf:
            form["exclusiveMinimum" if limits.above else "minimum"] = limits.low
        if limits.high < math.inf:
            form["exclusiveMaximum" if limits.below else "maximum"] = limits.high
        return form if self.but is None else form | {"not": {"const": self.but}}


@dataclass(frozen=True)
class Whole:
    """A whole number from ``low`` to ``high``, if there is a greatest one."""

    low: int = 1
    words: str = "a whole number, 1 or above"
    high: int | None = None
    numeric: ClassVar[bool] = True

    def __call__(self, value: object) -> int:
        if isinstance(value, bool) or not isinstance(value, int) or value < self.low:
            raise KindError(self.words)
        if self.high is not None and value > self.high:
            raise KindError(self.words)
        return value

    def schema(self) -> Schema:
        return {"type": "integer", "minimum": self.low} | ({} if self.high is None else {"maximum": self.high})


@dataclass(frozen=True)
class Text:
    """Text that is neither blank nor has control or invisible characters, but tabs and line breaks.

    ``check`` may raise :class:`KindError` for further texts, which a schema cannot express.
    """

    words: str = "text in quotes"
    check: Callable[[str], None] | None = None
    numeric: ClassVar[bool] = False

    def __call__(self, value: object) -> str:
        if not isinstance(value, str) or not value.strip():
            raise KindError("text in quotes")
        if self.check is not None:
            self.check(value)
        if legible(value, keep="\t\r\n") != value:
            raise KindError("text without control or invisible characters")
        return value

    def schema(self) -> Schema:
        return {"type": "string", "pattern": r"\S"}


@dataclass(frozen=True)
class Choice:
    """One of a few words, numbers or truth values; ``also`` is a kind whose values are accepted beside them.

    ``called`` has other names of the words, letters and digits in lower case, as :func:`rockbatch.toml.meant.words_meant`
    takes them. ``listed_by`` is the command that lists many options, in place of the list in messages.
    """

    options: tuple[object, ...]
    own_words: str = ""
    also: Number | None = None
    called: Mapping[str, object] = field(default_factory=dict)
    listed_by: str = ""
    numeric: ClassVar[bool] = False

    @property
    def words(self) -> str:
        return self.own_words or "one of " + ", ".join(map(shown, self.options))

    def __call__(self, value: object) -> object:
        for option in self.options:
            if value == option and isinstance(value, bool) == isinstance(option, bool):
                return option
        if self.also is not None and not isinstance(value, str):
            return self.also(value)
        words = f"one that `{self.listed_by}` lists" if self.listed_by else self.words
        raise KindError(words, " or ".join(map(shown, self._meant(value))))

    def _meant(self, value: object) -> list[object]:
        """Return the options that a wrong ``value`` may stand for; [] for none.

        These are numbers and truth values that its last word spells, a single letter that is its last word, or else the words
        of :func:`rockbatch.toml.meant.words_meant`.
        """
        last = str(value).strip().split(" ")[-1]
        if same := [option for option in self.options if not isinstance(option, str) and _is_spelt(option, last)]:
            return same
        if letter := [option for option in self.options if len(str(option)) == 1 and option == last]:
            return list(letter)
        if isinstance(value, int):
            value = str(value)
        words = [option for option in self.options if isinstance(option, str)]
        return words_meant(value, words, self.called) if isinstance(value, str) else []

    def schema(self) -> Schema:
        if self.options == (True, False):
            return {"type": "boolean"}
        enum: Schema = {"enum": list(self.options)}
        return enum if self.also is None else {"anyOf": [self.also.schema(), enum]}


@dataclass(frozen=True)
class Points:
    """A list of points, each a pair of numbers, at most ``most`` of them; ``wrong`` returns what is wrong about them, or "".

    ``instead`` is what to write instead of several lists.
    """

    words: str
    most: int
    wrong: Callable[[tuple[tuple[float, float], ...]], str]
    instead: str
    numeric: ClassVar[bool] = False

    def __call__(self, value: object) -> tuple[tuple[float, float], ...]:
        if isinstance(value, list) and any(isinstance(point, list) and list in map(type, point) for point in value):
            raise KindError(f"expected one list of points; {self.instead}", whole=True)
        if not isinstance(value, list) or not all(isinstance(point, list) and len(point) == 2 for point in value):
            raise KindError(self.words)
        points = tuple((_finite_float(x), _finite_float(y)) for x, y in value)
        if text := self.wrong(points):
            raise KindError(text, whole=True)
        return points

    def schema(self) -> Schema:
        point = {"type": "array", "items": {"type": "number", "minimum": 0}, "minItems": 2, "maxItems": 2}
        return {"type": "array", "items": point, "minItems": 2, "maxItems": self.most}


@dataclass(frozen=True)
class Other:
    """Values that ``read`` converts, or refuses with :class:`KindError`; ``form`` is their schema."""

    words: str
    read: Callable[[object], object]
    form: Schema
    numeric: ClassVar[bool] = False

    def __call__(self, value: object) -> object:
        return self.read(value)

    def schema(self) -> Schema:
        return dict(self.form)


def _is_spelt(option: object, word: str) -> bool:
    """Return whether a ``word`` says the truth value or number ``option``: "yes", "1" or "true" for True."""
    spelt = {True: ("true", "yes", "on", "1"), False: ("false", "no", "off", "0")}
    return word.lower() in spelt[option] if isinstance(option, bool) else word == str(option)


_NUMBER = re.compile(r"[-+]?\d+(\.\d+)?([eE][-+]?\d+)?")


def _finite_float(value: object) -> float:
    """Return a number as a float. Raises :class:`KindError` for anything else, text and booleans too, NaN and infinity."""
    if isinstance(value, str):
        raise KindError("a number (without quotes)", value.strip() if _NUMBER.fullmatch(value.strip()) else None)
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise KindError("a number")
    try:
        converted = float(value)
    except OverflowError:
        converted = math.inf
    if not math.isfinite(converted):
        raise KindError("a finite number")
    return converted


def choice(*options: str, called: Mapping[str, object] | None = None) -> Choice:
    """Return the kind of a word, one of ``options``; ``called`` maps other names to them."""
    return Choice(options, called=called or {})


def within(bounds: Bounds) -> Number:
    """Return the kind of a number within ``bounds``; bounds that exclude 0 refuse 0 and below with "a number above 0"."""
    return replace(positive, bounds=bounds) if bounds.low > 0 or bounds.above else Number(bounds=bounds)


number = Number()
positive = Number("a number above 0", low=0.0, above=True)
not_negative = Number("0 or a number above it", low=0.0)
nonzero = Number("a number other than 0", but=0.0)
share = Number("a number above 0 and below 1", low=0.0, high=1.0, above=True, below=True)
count = Whole()
boolean = Choice((True, False), "true or false (without quotes)")
text = Text()
