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


def with_unit(words: str, unit: str) -> str:
    """Return words with their unit in brackets, "drift [mm]"; the words alone if it is ""."""
    return f"{words} [{unit}]" if unit else words


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

        "must be a number above 0" if the value is not and has to be; "must be 1e+15 at most" for a greater one, if that is the
        bound; else ``why``, or "must be within 0 and 1". If the value is probably in percent, and ``why`` no function, the
        value to write follows.
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


_INCH = 0.0254  # m
_POUND = 4.4482216152605e-3  # kN, of force, as in the weights of drawings
_PSI = 1e-3 * _POUND / _INCH**2  # MPa

_SIZES = {
    **dict(m=("length", 1.0), mm=("length", 1e-3), cm=("length", 1e-2), km=("length", 1e3)),
    **{"in": ("length", _INCH), "ft": ("length", 12.0 * _INCH)},
    **dict(kN=("force", 1.0), N=("force", 1e-3), MN=("force", 1e3), kgf=("force", 9.80665e-3), tf=("force", 9.80665)),
    **dict(lb=("force", _POUND), lbf=("force", _POUND), kip=("force", 1e3 * _POUND), kips=("force", 1e3 * _POUND)),
    **dict(t=("mass", 1.0), kg=("mass", 1e-3), s=("time", 1.0), ms=("time", 1e-3)),
    **dict(rad=("angle", 1.0), mrad=("angle", 1e-3), deg=("angle", math.pi / 180.0)),
    **dict(MPa=("stress", 1.0), kPa=("stress", 1e-3), GPa=("stress", 1e3), Pa=("stress", 1e-6)),
    **dict(psi=("stress", _PSI), ksi=("stress", 1e3 * _PSI), ksf=("stress", _PSI / 0.144)),
    **dict(g=("acceleration", 1.0), gal=("acceleration", 0.01 / GRAVITY), percent=("", 0.01), pct=("", 0.01)),
}
"""Quantity and size of each unit at the end of a key, such as kN and m of stiffness_kN_m."""

_UNITS_OF = {"alpha": "rad", "axis": "deg", "azimuth": "deg", "dt": "s"}
"""Units of keys that do not end in them."""

_OTHERS = {
    "m": ("mm", "cm"),
    "mm": ("m", "cm"),
    "s": ("ms",),
    "t": ("kg", "kN"),
    "g": ("m_s2", "cm_s2", "percent"),
    "kN": ("MN", "N"),
    "kN_m": ("MN_m", "N_m"),
    "kN_s_m": ("MN_s_m", "N_s_m"),
    "rad": ("deg",),
    "": ("percent",),
}
"""Units in which numbers are written by mistake, by the unit of the key."""

_LEAST_PERCENT = 10.0  # least number that may be in percent
_MOST_SHARE = 10.0  # greatest usual value of a key without unit that may be written in percent


def unit_of(name: str) -> str:
    """Return the words of a key that are its unit: "kN_m" of "stiffness_kN_m", "rad" of "alpha"; "" if it has none."""
    words = name.split("_")
    end = len(words)
    while end > 1 and re.sub(r"\d$", "", words[end - 1]) in _SIZES:
        end -= 1
    return _UNITS_OF.get(name, "_".join(words[end:]))


def unit_in_words(unit: str) -> str:
    """Return a unit of a key as it is read: "kN_m" as "kN/m", "m_s2" as "m/s²", "t_m2", of an inertia, as "t m²"."""
    unit = re.sub(r"(?<=[tg])_(?=[cm]?m2)", " ", unit)
    return re.sub(r"_(?=mm|cm|m|s2)|(?<=m)_(?=s)", "/", unit).replace("_", " ").replace("2", "²").replace("3", "³")


def factor_between(unit: str, own: str) -> float | None:
    """Return what a number in ``unit`` is multiplied by to be in the unit ``own``, both as keys end in them.

    A weight becomes a mass, and a mass a weight, by 9.81; percent become a share or g by 0.01. None if they measure different
    things, or are not known.
    """
    given, wanted = _measured(unit), _measured(own)
    if given is None or wanted is None:
        return None
    (what, size), (own_what, own_size) = given, wanted
    if what == own_what:
        return size / own_size
    if (what, own_what) == (("force",), ("mass",)):
        return size / own_size / GRAVITY
    if (what, own_what) == (("mass",), ("force",)):
        return size / own_size * GRAVITY
    return 0.01 if unit in ("percent", "pct") and own in ("", "g") else None


def is_weight_of(unit: str, own: str) -> bool:
    """Return whether a number in ``unit`` is a weight, and one in ``own`` a mass."""
    measured = [what for what, _ in filter(None, map(_measured, (unit, own)))]
    return measured == [("force",), ("mass",)]


def _measured(unit: str) -> tuple[tuple[str, ...], float] | None:
    """Return what a unit measures, word by word, and its size in the units that keys have; None if a word is not known.

    Lengths and times behind the first word divide, but for the areas behind a mass.
    """
    if unit.endswith("_s2"):
        length = _SIZES.get(unit.removesuffix("_s2"), ("", 0.0))
        return (("acceleration",), length[1] / GRAVITY) if length[0] == "length" else None
    what: list[str] = []
    size = 1.0
    for word in unit.split("_") if unit else ():
        plain, power = (word[:-1], int(word[-1])) if word[-1:].isdigit() else (word, 1)
        if plain not in _SIZES:
            return None
        quantity, own_size = _SIZES[plain]
        divides = what and what[0] != "mass"
        size *= own_size ** (-power if divides else power)
        what.append(quantity + (str(power) if power > 1 else ""))
    return tuple(what), size


def number_in_unit_of(name: str, text: str) -> str:
    """Return a number with a unit, such as "1500 MN/m" or "7 %", as the key ``name`` has it; "" for another text or unit."""
    match = re.fullmatch(rf"({NUMBER})\s*\[?([^\d\s\].,][^\]]*?)\]?", text.strip())
    if match is None:
        return ""
    unit = match[2].replace("%", "percent").replace("°", "deg").translate(_POWERS)
    unit = re.sub(r"[ /·*]+", "_", unit)
    own = unit_of(name)
    factor = 1.0 if unit.lower() == own.lower() else factor_between(unit, own)
    if factor is None:
        return ""
    return match[1] if factor == 1.0 else f"{float(match[1]) * factor:.10g}"


NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
"""Pattern of a number as people write it."""

_POWERS = str.maketrans({"²": "2", "³": "3", "^": ""})

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
        """Return whether the size of a value is from ``least`` to ``most``; True for 0 and for texts and None, False for NaN."""
        return not isinstance(value, int | float) or value == 0 or self.least <= abs(value) <= self.most

    def doubts(self, name: str, value: float) -> list[Problem]:
        """Return the problem of a value of the key ``name`` that is unusual, and has to be confirmed; [] for a usual value."""
        if self.holds(value):
            return []
        bound = f"more than {self.most:g}" if abs(value) > self.most else f"less than {self.least:g}"
        text = f"{bound} {self.words}{in_other_units(name, value, self.holds, self.most)}"
        return [Problem(name, float(value), text, confirm=name, kind=Unusual)]


def in_other_units(name: str, value: float, holds: Callable[[float], bool], most: float = 0.0) -> str:
    """Return "; if it is in mm, write width_m = 4" for each unit of _OTHERS if ``value``, converted, ``holds``; "" for none.

    A value of 10 or above may be in percent, if the key has the unit g, or none and usual values to 10, its ``most``.
    """
    own = unit_of(name)
    others = [
        unit
        for unit in _OTHERS.get(own, ())
        if unit != "percent" or (abs(value) >= _LEAST_PERCENT and (own or most <= _MOST_SHARE))
    ]
    factors = {unit: factor_between(unit, own) or 1.0 for unit in others}
    return "".join(
        f"; if it is in {unit_in_words(unit)}, write {name} = {value * factor:.5g}"
        for unit, factor in factors.items()
        if holds(value * factor)
    )


def rounded_up(value: float, digits: int = 4) -> float:
    """Return a positive value rounded up to so many significant digits, as the least that a message may advise; inf is inf."""
    if math.isinf(value):
        return value
    nearest, unit = float(f"{value:.{digits}g}"), 10.0 ** (math.floor(math.log10(value)) + 1 - digits)
    return nearest if nearest >= value else float(f"{nearest + unit:.{digits}g}")


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
_ACCELERATION_IN_G = {"g": 1.0, "mg": 1e-3, "ug": 1e-6, "%g": 0.01}
_SHARE_OF_G = re.compile(r"(?P<times>\d*\.?\d+)[x*]?g|g/(?P<over>\d+)")  # 0.001 g, g/10
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
    if (share := _SHARE_OF_G.fullmatch(key)) and (size := float(share["times"] or share["over"])) > 0.0:
        return gravity * size if share["times"] else gravity / size
    if key not in _ACCELERATION_IN_M_S2:
        raise ValueError(f'unknown acceleration unit "{unit}"; write {ACCELERATIONS}')
    return _ACCELERATION_IN_M_S2[key]
