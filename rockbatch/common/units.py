"""Units at the border: everything inside is SI, angles are in radians."""

import math
import re
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import NamedTuple

from rockbatch.common.errors import OutOfRange, Problem, Unusual

GRAVITY = 9.81
"""Acceleration of gravity [m/s²] that the reference paper uses (its R0 = 7.36 m for p = 1 rad/s, μ = 3)."""

LEAST, MOST = 1e-15, 1e15
"""Bounds of any number that a user states, but for 0, whatever its unit: products and powers of some stay finite."""


class ColumnUnits(dict[str, str]):
    """Units of the columns of a table, for its ``attrs``.

    pandas copies ``attrs`` deeply for every column that is taken, which was a quarter of the time of a small run: texts need
    no copies.
    """

    def __deepcopy__(self, _: object) -> "ColumnUnits":
        return ColumnUnits(self)


def of_percent(value: float, low: float, high: float) -> float | None:
    """Return ``value``/100 if it is from 2 to 100 and the bounds are 0 and 1, and so probably in percent; else None."""
    return value / 100.0 if low == 0.0 and high == 1.0 and 2.0 <= value <= 100.0 else None


@dataclass(frozen=True)
class Bounds:
    """Values that a quantity can have, from ``low`` to ``high``; ``above`` and ``below`` exclude these ends.

    ``unit`` follows "a number above 0" in messages; ``why`` is what is said of any other value that is out of bounds, a text or
    a function of the value, in place of the bounds alone.
    """

    low: float
    high: float
    unit: str = ""
    why: str | Callable[[float], str] = ""
    above: bool = False
    below: bool = False

    def __contains__(self, value: float) -> bool:
        return (self.low < value if self.above else self.low <= value) and (
            value < self.high if self.below else value <= self.high
        )

    def message(self, value: float) -> str:
        """Return the message about a value that is out of bounds, to follow "name = value: ".

        "must be a number above 0" if the value is not and has to be; else ``why``, or "must be within 0 and 1", with the value to
        write if it is probably in percent.
        """
        if value <= 0.0 <= self.low and 0.0 not in self:
            return f"must be a number above 0{self.unit}"
        if value > self.high == MOST:
            return f"must be {MOST:g} at most"
        if callable(self.why):
            return self.why(value)
        share = of_percent(value, self.low, self.high)
        percent = "" if share is None else f"; if it is in percent, write {share:g}"
        return (self.why or f"must be within {self.low:g} and {self.high:g}") + percent

    def problems(self, name: str, value: float | None) -> list[Problem]:
        """Return the problem of a value of the key ``name`` that is out of bounds; [] if it is within them or None."""
        if value is None or value in self:
            return []
        problem = Problem(name, value, self.message(value), kind=OutOfRange)
        if float(f"{value:g}") not in self:
            return [problem]
        text = f"{name} = {value:.10g}: {problem.text}"  # not rounded into the bounds
        return [replace(problem, text=text, named=False)]


POSITIVE = Bounds(LEAST, MOST)
"""Any number above 0."""

NOT_NEGATIVE = Bounds(0.0, MOST, why="must be 0 or above")
"""Any number but a negative one."""


class Usual(NamedTuple):
    """The usual range of a value's size, with an explanation; values outside, except 0, have to be confirmed."""

    most: float
    words: str
    least: float = 0.0

    def holds(self, value: float) -> bool:
        """Return whether the size of a value is from ``least`` to ``most``; True for 0 and for what is no number."""
        return not isinstance(value, int | float) or value == 0 or self.least <= abs(value) <= self.most

    def doubts(self, name: str, value: float) -> list[Problem]:
        """Return the problem of a value of the key ``name`` that is unusual, and has to be confirmed; [] for a usual value."""
        if self.holds(value):
            return []
        bound = f"more than {self.most:g}" if abs(value) > self.most else f"less than {self.least:g}"
        return [Problem(name, float(value), f"{bound} {self.words}", confirm=name, kind=Unusual)]


def rounded_up(value: float, digits: int = 4) -> float:
    """Return a positive value rounded up to so many significant digits, as the least value that a message may advise."""
    unit = 10.0 ** (math.floor(math.log10(value)) + 1 - digits)
    return float(f"{math.ceil(value / unit) * unit:.{digits}g}")


_ACCELERATION_IN_M_S2 = {
    "m/s2": 1.0,
    "cm/s2": 0.01,
    "gal": 0.01,
    "mgal": 1e-5,
    "mm/s2": 1e-3,
    "um/s2": 1e-6,
    "nm/s2": 1e-9,
    "in/s2": 0.0254,
    "ft/s2": 0.3048,
}
_ACCELERATION_IN_G = {"g": 1.0, "g/10": 0.1, "0.1g": 0.1, "mg": 1e-3, "ug": 1e-6, "%g": 0.01}
_OTHER_SPELLINGS = {
    "inch": "in",
    "inches": "in",
    "feet": "ft",
    "foot": "ft",
    "milli-g": "mg",
    "millig": "mg",
    "microg": "ug",
    "gals": "gal",
    "gs": "g",
}
_PLAIN = str.maketrans({"µ": "u", "μ": "u", "²": "2", "⁻": "-", "−": "-", **dict.fromkeys("^() '’", "")})
_SECOND = re.compile("sec|seg|sek|sn")  # also Spanish, German, Turkish

_LENGTH_IN_M = {"mm": 0.001, "cm": 0.01, "m": 1.0, "in": 0.0254, "ft": 0.3048}


def length_factor(unit: str) -> float | None:
    """Return the factor that turns a length or a velocity, in "cm" or "cm/sec", into m or m/s; None for another unit.

    What follows the slash is not looked at.
    """
    return _LENGTH_IN_M.get(unit.strip().lower().partition("/")[0])


ACCELERATIONS = f"one of {', '.join(['g', 'g/10', 'mg', *_ACCELERATION_IN_M_S2])}"
"""Units of acceleration, as messages list them."""


def acceleration_factor(unit: str, gravity: float = GRAVITY) -> float:
    """Return the factor that turns an acceleration in ``unit`` into m/s².

    Spellings such as ``cm/s/s``, ``cm/s²``, ``CM/SEC**2``, ``nm/(s^2)``, ``m·s⁻²``, ``µg``, ``g's`` and ``G`` are understood; "g"
    is ``gravity`` [m/s²], the same that the pier weighs with, so that ratios ü_g/g survive. Raises ``ValueError`` for
    anything else.
    """
    key = _SECOND.sub("s", unit.strip().lower().translate(_PLAIN)).replace("**", "")
    key = re.sub(r"/s/s|[*.·⋅]?s-2", "/s2", key)
    length, slash, time = key.partition("/")
    key = _OTHER_SPELLINGS.get(length, length) + slash + time
    if key in _ACCELERATION_IN_G:
        return gravity * _ACCELERATION_IN_G[key]
    if key not in _ACCELERATION_IN_M_S2:
        raise ValueError(f'unknown acceleration unit "{unit}"; write {ACCELERATIONS}')
    return _ACCELERATION_IN_M_S2[key]
