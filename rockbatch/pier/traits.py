"""Traits of all bases of a pier: possible and usual values of their fields, and properties that code asks for."""

from collections.abc import Sequence
from dataclasses import fields
from typing import ClassVar, Literal, get_args

from rockbatch.common.errors import Problem, UnknownKey, WrongType, refuse
from rockbatch.common.grouping import closest
from rockbatch.common.showing import InNotebook, shown
from rockbatch.common.units import LEAST, MOST, Bounds, Usual
from rockbatch.pier.bending import MOST_MODES
from rockbatch.pier.laws import LAWS
from rockbatch.pier.places import holds_a_tilt
from rockbatch.pier.restraints import Restraint
from rockbatch.pier.sizes import unusual
from rockbatch.pier.supports import SUPPORTS

LEAST_ETA = 1.000001
"""Least η: closer to 1, Bouc–Wen and hardening springs would sink without bound to carry the weight."""

MOST_EXPONENT = 1000.0
"""Greatest n of Bouc–Wen springs: their corner is as sharp as that of elastic–perfectly plastic springs, without n."""

FLIGHT_LIMIT_MM = 5.0
"""Height of flight [mm] beyond which a run has a note, unless the base gives another."""

Kinematics = Literal["first-order", "finite"]
Flight = Literal["guided", "stop"]
Impact = Literal["landing", "housner"]
Shaft = Literal["rigid", "elastic"]
FlexuralDamping = Literal["modal", "stiffness"]

WITH_EPSILON: tuple[Impact, ...] = ("landing",)
"""Impacts with a restitution ε of the landing pivot; Housner's e follows from the pier."""

ASKING_TENSION: tuple[Impact, ...] = ("housner",)
"""Impacts that ask a support for a pull, which one without tension cannot give (THEORY.md, Impact by Housner's e)."""

EPSILON_AND_ZETA = "zeta is given too, and a damped support takes a landing without an impulse; keep one"
"""Message on a support that has both."""


_STRENGTH = (
    "the springs cannot carry the weight; eta = yield force over static force must be above 1 "
    f"(at least {LEAST_ETA:.6f})"
)

BETA = Bounds(LEAST, MOST, why="must be a number above 0")
"""Possible values of β; the least that holds a pier upright depends on the pier."""

BOUNDS = {
    "restitution": Bounds(0.0, 1.0, why="must be within 0..1 (leave it out for Housner's value)"),
    "friction": Bounds(LEAST, MOST, ", the coefficient of the interface"),
    "contact_stiffness_kN_m": Bounds(LEAST, MOST, " [kN/m], the stiffness of the ground under a foot"),
    "flight_limit_mm": Bounds(LEAST, MOST, " [mm], a height of flight"),
    "area_m2": Bounds(LEAST, MOST, " [m²], the area of one support"),
    "flexural_damping": Bounds(
        0.0, 1.0, why="damping of the shaft's first mode, as a share of critical, must be within 0..1"
    ),
    "flexural_modes": Bounds(1, MOST_MODES, why=f"must be within 1..{MOST_MODES}, the number of the shaft's modes"),
    "zeta": Bounds(0.0, 1.0, why="damping of the supports, as a share of critical, must be within 0..1"),
    "epsilon": Bounds(0.0, 1.0, why="the landing pivot's restitution must be within 0..1"),
    "eta": Bounds(LEAST_ETA, MOST, why=_STRENGTH),
    "n": Bounds(1.0, MOST_EXPONENT, why=f"the Bouc–Wen exponent must be at least 1, and {MOST_EXPONENT:g} at most"),
}
"""Possible values of the fields of bases; the least β and η depend on the pier and on tendons, too (`possible.py`)."""

ETA_OF_BACKBONE = Bounds(LEAST, MOST, ", the force at the first corner of the backbone over the static one")
"""Possible η with a backbone, whose greatest force decides whether it can carry the pier."""

WORDS: dict[str, tuple[str, ...]] = {
    "kinematics": get_args(Kinematics),
    "flight": get_args(Flight),
    "spring": tuple(LAWS),
    "shaft": get_args(Shaft),
    "flexural_damping_kind": get_args(FlexuralDamping),
    "impact": get_args(Impact),
}
"""Possible words of the fields of bases."""

USUAL = {
    "restitution": Usual(1.0, "of the angular velocity: stone and concrete were measured at 0.6 and above", 0.3),
    "beta": Usual(5000.0, 'of ω_v/p: supports have 10 to 500, and ground that does not give is base = "rigid"'),
    "eta": Usual(1000.0, 'times what they carry: supports bear 2 to 20 times that; without a limit base = "elastic"'),
    "flight_limit_mm": Usual(1e4, "mm: shear keys reach 5 to 500 mm", 0.1),
    "friction": Usual(2.0, "as a coefficient: interfaces have 0.1 to 1", 0.02),
}
"""Usual values of the fields of bases, in a study and in Python alike."""

CONFIRMED = frozenset((*USUAL, *SUPPORTS, "shear_modulus_MPa"))
"""Names that ``confirm`` may have beside those of fields, on every base."""


def _unknown(name: str) -> Problem:
    """Return the problem of a name in ``confirm`` that is none of :data:`CONFIRMED`, with the one that is probably meant."""
    meant = closest(name, CONFIRMED)
    hint = f"; did you mean {shown(meant)}?" if meant else f"; it may name {', '.join(sorted(CONFIRMED))}"
    return Problem("confirm", name, f"a base has no value of this name{hint}", kind=UnknownKey)


def wrong_blow(flexural_impact: str) -> str:
    """Return the problem text of a ``flexural_impact`` other than "momentum", the only rule of a blow; "" for that."""
    if flexural_impact == "momentum":
        return ""
    if flexural_impact == "rate":
        return (
            "to carry the rate of the deflection over would create energy at about half of the blows; a blow keeps the momentum "
            "of the mode. Leave the key out"
        )
    return 'a blow keeps the "momentum" of the mode, the only rule; leave the key out'


class Traits(InNotebook):
    """Properties of a base that code asks for instead of its class; each class overrides those that differ."""

    on_springs: ClassVar[bool]
    """True if the ground deforms: springs or a bed; a literal in each class, by which type checkers narrow unions of bases."""

    two_springs: ClassVar[bool] = False
    """True if these are two springs under the pivots."""

    remembers: ClassVar[bool] = False
    """True if the ground's state follows from every step of a history, and is no column of it."""

    yields: ClassVar[bool] = False
    """True if these springs yield, so that the pier may settle."""

    bends: bool = False
    """True if the shaft bends."""

    flight: Flight
    flight_limit_mm: float
    restraints: tuple[Restraint, ...]
    confirm: Sequence[str]

    def _check(self) -> None:
        """Raise ``InputError`` with every field that is impossible; if none is, with those unusual and not confirmed."""
        values = {attribute.name: getattr(self, attribute.name) for attribute in fields(self)}  # type: ignore[arg-type]
        wrong = []
        for name in filter(values.__contains__, BOUNDS):
            wrong += self._bounds(name).problems(name, values[name])
        for name, words in WORDS.items():
            if name in values and values[name] not in words:
                wrong.append(Problem(name, values[name], f"must be {' or '.join(map(shown, words))}", kind=WrongType))
        wrong += [_unknown(name) for name in self.confirm if name not in values.keys() | CONFIRMED]
        wrong += self._wrong_together()
        refuse(wrong or unusual(USUAL, self.confirm, **{name: values[name] for name in USUAL if name in values}))

    def _bounds(self, name: str) -> Bounds:
        """Return the possible values of a field of :data:`BOUNDS`; a class overrides it where others apply."""
        return BOUNDS[name]

    def _wrong_together(self) -> list[Problem]:
        """Return a problem for each contradiction between fields; none unless a class overrides it."""
        return []

    @property
    def flies(self) -> bool:
        """Return True if a run continues while both pivots are in the air."""
        return self.flight == "guided"

    @property
    def has_exponent(self) -> bool:
        """Return whether the springs' law has an exponent n: False unless a class overrides it."""
        return False

    @property
    def has_points(self) -> bool:
        """Return whether the springs' law has its curve by points: False unless a class overrides it."""
        return False

    @property
    def has_epsilon(self) -> bool:
        """Return whether impacts have a restitution ε of the landing pivot: False unless a class overrides it."""
        return False

    @property
    def asks_tension(self) -> bool:
        """Return whether impacts need tension from a support, which it has not: False unless a class overrides it."""
        return False

    @property
    def ratchets(self) -> bool:
        """Return whether the springs settle cyclically under vibration (ratcheting): False unless a class overrides it."""
        return False

    @property
    def has_residual(self) -> bool:
        """Return True if the pier may come to rest tilted: on a base that yields, or with dampers that :func:`holds_a_tilt`."""
        return self.yields or holds_a_tilt(self.restraints)


def interface(friction: float | None, area_m2: float | None) -> dict[str, float]:
    """Return friction and area of the interface by the keys of run.json; those not given are left out."""
    values = {"friction": friction, "area_m2": area_m2}
    return {name: value for name, value in values.items() if value is not None}
