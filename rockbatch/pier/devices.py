"""Base class of the devices between a pier and the ground, their bounds, and their fields from values in kN."""

import math
from abc import ABC, abstractmethod
from collections.abc import Iterator, Sequence
from typing import ClassVar, NamedTuple, Self, TypedDict

from rockbatch.common.errors import Problem, Unusual, WrongType, placed, refuse
from rockbatch.common.showing import InNotebook, shown
from rockbatch.common.units import LEAST, MOST, NOT_NEGATIVE, Bounds
from rockbatch.pier.block import Pier
from rockbatch.pier.supports import NO_MASS

BOUNDS = {
    "f": Bounds(0.0, 10.0, why="its force over the weight must be within 0..10"),
    "nu": Bounds(0.0, MOST, why="must be 0 or above"),
    "exponent": Bounds(0.1, 2.0, why="must be within 0.1..2"),
    "yield_m": Bounds(LEAST, MOST, why="a hysteretic damper yields at a deflection above 0 m"),
    "psi": Bounds(0.0, 10.0, why="its prestress over the weight must be within 0..10"),
    "lam": Bounds(0.0, MOST, why="must be 0 or above"),
    "gap_m": Bounds(0.0, MOST, why="must be 0 or above"),
    "restitution": Bounds(0.1, 1.0, why="must be within 0.1 and 1, the speed after a blow over that before"),
}
"""Possible values of devices. Forces above ten times the weight suggest a wrong unit; fluid dampers have exponents of
0.15 to 1, and an exponent of 0 is friction."""

DAMPERS = {"friction": ("f",), "hysteretic": ("f", "yield_m"), "viscous": ("nu", "exponent")}
"""Names of the fields that each kind of damper uses."""

FIELDS = DAMPERS | {"tendon": ("psi", "lam"), "stop": ("gap_m", "lam", "restitution")}
FIELDS["deck_spring"] = FIELDS["stop"]
"""Names of the bounded fields by law of device; a tendon's yield force is checked apart."""

FIRMEST = {"stop": 1e-4, "deck_spring": 1e-3, "damper": 1e-3}
"""Least deflection under the weight of the whole pier [m] of a stop, deck spring or damper's brace: a steel block of a
metre gives way by a tenth of a millimetre, abutments and braces by 5 to 500 mm."""

LEAST_FORCE = 1e-3
"""Force over the weight below which a damper (at 1 m/s if viscous) or a tendon has no noticeable effect."""

SOFTEST = {"tendon": 0.01, "stop": 0.05, "deck_spring": 0.05, "damper": 0.05}
"""Least force over the weight of a device, or of a damper's brace, at its deflection under a rotation of α."""


class Doubt(NamedTuple):
    """A value of the field ``name`` that is probably wrong, with its physical ``meaning``."""

    name: str
    meaning: str


class Placing(TypedDict, total=False):
    """Keywords of all constructors of dampers and stops from values in kN."""

    at: float | str | None
    confirm: Sequence[str]


class Device(InNotebook, ABC):
    """A device between the pier and the ground; each class checks its own fields, and their plausibility under a pier."""

    what: ClassVar[str]
    """Name of the device's table in a study."""

    confirm: Sequence[str]

    @property
    def kinds(self) -> tuple[str, ...]:
        """Names by which the catalogue selects quantities: that of the device's table, and of a yielding tendon a second one."""
        return (self.what,)

    @property
    def law(self) -> str:
        """Name of its law, by which :data:`FIELDS` has the fields that it uses: that of its table, or the kind of a damper."""
        return self.what

    @property
    def words(self) -> str:
        """Its kind in words: "friction damper", "deck spring"."""
        return self.what.replace("_", " ")

    def __post_init__(self) -> None:
        refuse(placed(self._wrong(), self.what))

    def _wrong(self) -> list[Problem]:
        """Return a problem for each field that is impossible under any pier."""
        wrong = []
        for name in FIELDS.get(self.law, ()):
            wrong += BOUNDS[name].problems(name.replace("lam", "lambda"), getattr(self, name))
        return wrong

    @abstractmethod
    def doubts(self, pier: Pier) -> Iterator[Doubt]:
        """Yield each implausible value under ``pier``, whether confirmed or not."""

    def _usual_under(self, pier: Pier) -> Self:
        """Return the device itself; raise ``InputError`` if a value is implausible under ``pier`` and not confirmed."""
        refuse(unlikely_devices(pier, (self,)))
        return self


def wrong_words(place: float | str | None, *words: str) -> list[Problem]:
    """Return the problem of a ``place`` that is text other than ``words``; empty for one of these, a number (offset) or None."""
    if not isinstance(place, str) or place in words:
        return []
    text = f"must be {', '.join(map(shown, words))} or an offset in m"
    return [Problem("at", place, text, kind=WrongType)]


def doubt(pier: Pier, device: Device) -> Doubt | None:
    """Return the first implausible, unconfirmed value of a device of ``pier``; None if there is none."""
    return next((doubt for doubt in device.doubts(pier) if doubt.name not in device.confirm), None)


def unlikely_devices(pier: Pier, devices: Sequence[Device]) -> list[Problem]:
    """Return a problem for each device of ``pier`` with implausible, unconfirmed values, about the first of them."""
    return [_unusual(device, odd) for device in devices if (odd := doubt(pier, device))]


def _unusual(device: Device, odd: Doubt) -> Problem:
    return Problem(odd.name, getattr(device, odd.name), odd.meaning, device.what, odd.name, Unusual)


def fields_of(pier: Pier) -> dict[str, tuple[str, float]]:
    """Return, by study key, a device's field and the factor from its value to the key's; keys in kN only with a known mass."""
    fields = {name: (name, 1.0) for name in ("f", "nu", "exponent", "psi", "restitution", "brace")}
    fields |= {"yield_mm": ("yield_m", 1000.0), "lambda": ("lam", 1.0), "gap_mm": ("gap_m", 1000.0)}
    if pier.mass_t is not None:
        weight = pier.mass_t * pier.gravity
        fields |= {
            "force_kN": ("f", weight),
            "coefficient_kN_s_m": ("nu", weight * pier.p / pier.gravity),
            "prestress_kN": ("psi", weight),
            "stiffness_kN_m": ("lam", weight * pier.size / pier.half_width**2),
            "brace_kN_m": ("brace", weight * pier.size / pier.half_width**2),
            "yield_kN": ("strength", weight),
        }
    return fields


def if_finite(**values: float) -> dict[str, float]:
    """Return the ``values`` that are not inf, the default of yield forces and braces that are not given."""
    return {name: value for name, value in values.items() if value != math.inf}


def over_weight(pier: Pier, **values: float) -> dict[str, float]:
    """Return a device's dimensionless fields from study keys such as ``force_kN``.

    Raises ``InputError`` if the mass of ``pier`` is not known, or for a negative value.
    """
    if pier.mass_t is None:
        refuse([NO_MASS])
    refuse([problem for name, value in values.items() for problem in NOT_NEGATIVE.problems(name, value)])
    factors = fields_of(pier)
    return {factors[name][0]: value / factors[name][1] for name, value in values.items()}
