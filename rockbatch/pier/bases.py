"""Bases of a pier: rigid, elastic and yielding (Palmeri & Makris 2007).

Impossible combinations of a pier and a base are checked in :mod:`rockbatch.pier.possible`.
"""

import math
import warnings
from collections.abc import Sequence
from dataclasses import InitVar, dataclass, field, fields, replace
from typing import Any, ClassVar, Literal, Self, get_args

import numpy as np
import numpy.typing as npt

from rockbatch.common.arguments import checked
from rockbatch.common.errors import Contradiction, MissingKey, OutOfRange, Problem, Superseded, WrongType, refuse
from rockbatch.common.showing import InNotebook, shown
from rockbatch.common.units import LEAST, MOST, POSITIVE, Bounds, Usual
from rockbatch.pier.bending import MOST_MODES, Modes, modes_of
from rockbatch.pier.block import Pier
from rockbatch.pier.first_loading import Curve, Straight
from rockbatch.pier.frequencies import rocking_frequency, static_deflection, vertical_frequency, yield_deflection
from rockbatch.pier.laws import LAWS, Law, SpringLaw
from rockbatch.pier.places import holds_a_tilt
from rockbatch.pier.restraints import Restraint, described_restraints
from rockbatch.pier.sizes import unusual
from rockbatch.pier.soil import FORMULAS, Formula, Soil, bed_stiffness, radiated
from rockbatch.pier.supports import beta_of, eta_of, unlikely_supports

LEAST_ETA = 1.000001
"""Least η: closer to 1, Bouc–Wen and hardening springs would sink without bound to carry the weight."""

MOST_EXPONENT = 1000.0
"""Greatest n of Bouc–Wen springs: their corner is as sharp as that of elastic–perfectly plastic ones, which have none."""

MOST_STRIPS = 160
"""Greatest number of strips of a footing's bed; the core has room for no more."""

MOST_NEGLECTED = 0.05
"""Share of inertia and righting moment, neglected by linearised kinematics, from which a note reports it: 0.20 rad at α = 0.2."""

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


def _strength(eta: float) -> str:
    if eta > MOST:
        return f"must be {MOST:g} at most"
    return (
        "the springs cannot carry the weight; eta = yield force over static force must be above 1 "
        f"(at least {LEAST_ETA:.6f})"
    )


BETA = Bounds(LEAST, MOST, why=lambda beta: f"must be {MOST:g} at most" if beta > MOST else "must be a number above 0")
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
    "eta": Bounds(LEAST_ETA, MOST, why=_strength),
    "n": Bounds(1.0, MOST_EXPONENT, why=f"the Bouc–Wen exponent must be at least 1, and {MOST_EXPONENT:g} at most"),
}
"""Possible values of the fields of bases; the least β and η depend on the pier and on tendons, too (`possible.py`)."""

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


def wrong_blow(flexural_impact: str) -> str:
    """Return why ``flexural_impact`` is not a rule of impacts on an elastic shaft; "" for "momentum", the only one."""
    if flexural_impact == "momentum":
        return ""
    if flexural_impact == "rate":
        return (
            "to carry the rate of the deflection over would create energy at about half of the blows; a blow keeps the momentum "
            "of the mode. Leave the key out"
        )
    return 'a blow keeps the "momentum" of the mode, the only rule; leave the key out'


class _Traits(InNotebook):
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
        """Raise ``InputError`` with every field that is impossible, or unusual and not confirmed."""
        values = {attribute.name: getattr(self, attribute.name) for attribute in fields(self)}  # type: ignore[arg-type]
        wrong = []
        for name in filter(values.__contains__, BOUNDS):
            wrong += BOUNDS[name].problems(name, values[name])
        for name, words in WORDS.items():
            if name in values and values[name] not in words:
                wrong.append(Problem(name, values[name], f"must be {' or '.join(map(shown, words))}", kind=WrongType))
        wrong += self._wrong_together()
        refuse(wrong or unusual(USUAL, self.confirm, **{name: values[name] for name in USUAL if name in values}))

    def _wrong_together(self) -> list[Problem]:
        """Return a problem for each contradiction between fields."""
        return []

    @property
    def flies(self) -> bool:
        """Return True if a run continues while both pivots are in the air."""
        return self.flight == "guided"

    @property
    def has_exponent(self) -> bool:
        """Return True if the springs' law has an exponent n."""
        return False

    @property
    def has_epsilon(self) -> bool:
        """Return True if impacts have a restitution ε of the landing pivot."""
        return False

    @property
    def asks_tension(self) -> bool:
        """Return True if impacts need tension from a support, which it does not have."""
        return False

    @property
    def ratchets(self) -> bool:
        """Return True if the springs settle cyclically under vibration (ratcheting)."""
        return False

    @property
    def has_residual(self) -> bool:
        """Return True if the pier may come to rest tilted: on yielding springs, or with friction or hysteretic dampers."""
        return self.yields or holds_a_tilt(self.restraints)

    def by_other_law(self) -> Self:
        """Return the base with its springs by the other law if its own law ratchets; otherwise itself."""
        return self


@checked
@dataclass(frozen=True)
class RigidBase(_Traits):
    """Ground that neither gives nor yields (Housner 1963).

    ``restitution`` is the factor e on the angular velocity at an impact; ``None`` means :attr:`Pier.restitution`, Housner's
    e = 1 − 2μ/(1+μ) sin²α, which conserves the angular momentum about the new pivot, or 0 where that is negative.
    ``restraints`` are dampers and tendons between the pier and the ground.
    ``friction``, if known, is the coefficient of the interface: a run reports where its forces need more (THEORY.md, Forces).
    ``flight``, ``flight_limit_mm``, ``area_m2`` and ``confirm`` are as on springs (:class:`ElasticBase`).
    With ``shaft = "elastic"`` the pier bends in its ``flexural_modes`` lowest modes, by default in four or as many as its masses
    have, the first of the period :attr:`Pier.flexural_period_s`. Their damping ratio is ``flexural_damping``; of stiffness as
    ``flexural_damping_kind`` it is that of the first, and grows with the frequency. A blow keeps the momenta of the modes, from
    which all else follows, so that ``restitution`` does not apply (THEORY.md, A shaft that bends); ``flexural_impact =
    "momentum"``, which said so, has no effect.
    ``contact_stiffness_kN_m``, if given, is the stiffness of the ground under one foot [kN/m], by which the column
    ``landing_force_kN`` estimates what the hardest landing presses; it does not affect the run (THEORY.md, Forces).

    Examples
    --------
    >>> rb.RigidBase().name, rb.RigidBase(restitution=0.9).restitution
    ('rigid', 0.9)
    """

    restitution: float | None = None
    restraints: tuple[Restraint, ...] = ()
    friction: float | None = field(default=None, kw_only=True)
    flight: Flight = field(default="guided", kw_only=True)
    flight_limit_mm: float = field(default=FLIGHT_LIMIT_MM, kw_only=True)
    area_m2: float | None = field(default=None, kw_only=True)
    shaft: Shaft = field(default="rigid", kw_only=True)
    flexural_damping: float = field(default=0.05, kw_only=True)
    flexural_damping_kind: FlexuralDamping = field(default="modal", kw_only=True)
    flexural_modes: int | None = field(default=None, kw_only=True)
    flexural_impact: InitVar[str | None] = field(default=None, kw_only=True)
    contact_stiffness_kN_m: float | None = field(default=None, kw_only=True)  # noqa: N815 (the study's key)
    confirm: Sequence[str] = field(default=(), kw_only=True, compare=False, repr=False)

    name = "rigid"
    on_springs: ClassVar[Literal[False]] = False
    kinematics: ClassVar[Kinematics] = "finite"
    beta: ClassVar[float] = math.inf
    """β of ground that does not give: the limit of springs."""

    def __post_init__(self, flexural_impact: str | None) -> None:
        """Check the fields; warn if ``flexural_impact`` is given, which has no effect any more."""
        self._check()
        if flexural_impact is None:
            return
        if problem := wrong_blow(flexural_impact):
            raise WrongType(Problem("flexural_impact", flexural_impact, problem))
        message = 'flexural_impact = "momentum" has no effect, since no other rule of a blow is left; leave it out'
        warnings.warn(message, Superseded, stacklevel=4)

    @property
    def bends(self) -> bool:  # type: ignore[override]
        """Return True if the shaft is elastic."""
        return self.shaft == "elastic"

    def modes(self, pier: Pier) -> Modes:
        """Return the modes of an elastic shaft of ``pier`` that are followed."""
        return modes_of(pier, self.flexural_modes or MOST_MODES)

    def damping_ratios(self, pier: Pier) -> npt.NDArray[np.float64]:
        """Return ζ_i of these modes, shape (n,): the same of all, or in proportion to their frequencies, as of stiffness."""
        frequency = self.modes(pier).frequency
        of_first = 1.0 if self.flexural_damping_kind == "modal" else frequency / frequency[0]
        return self.flexural_damping * of_first * np.ones(len(frequency))

    def parameters(self, pier: Pier) -> dict[str, object]:
        """Return this base under ``pier`` by the keys of run.json."""
        of_frame = None if pier.deck_over_columns is None else pier.restitution  # None stands for Housner's
        values: dict[str, object] = {"restitution": of_frame if self.restitution is None else self.restitution}
        values |= {"flight": self.flight, "flight_limit_mm": self.flight_limit_mm}
        if self.bends:
            values |= {name: getattr(self, name) for name in ("shaft", "flexural_damping", "flexural_damping_kind")}
            values["flexural_modes"] = len(self.modes(pier).frequency)
        if self.contact_stiffness_kN_m is not None:
            values["contact_stiffness_kN_m"] = self.contact_stiffness_kN_m
        return values | _interface(self) | described_restraints(self.restraints)


@checked
@dataclass(frozen=True)
class ElasticBase(_Traits):
    """Two elastic springs that take no tension.

    Attributes
    ----------
    beta : float
        β = ω_v/p, vertical over rocking frequency parameter.
    epsilon : float
        Restitution ε of the landing pivot's velocity, 0..1.
    kinematics : "first-order" or "finite"
        The paper's equations, or those that hold for large rotations.
    flight : "guided" or "stop"
        What happens when both pivots are off the ground: shear keys guide the pier down, or the run ends, as in the paper.
    flight_limit_mm : float
        Height of the lower pivot in flight [mm] beyond which a run has a note: do the keys reach so far?
    zeta : float or None
        ζ, 0..1: damping ratio of the vertical vibration, by a dashpot C = ζ M ω_v parallel to each spring. It
        replaces ε: a pivot lands on a damped support without an impulse.
    friction : float, optional
        Coefficient of the interface, if known: a run reports if its forces need more, and continues (THEORY.md, Forces).
    restraints : tuple of Damper and Tendon
        Devices between the pier and the ground, other than its springs (THEORY.md, Dampers and tendons).
    area_m2 : float, optional
        Area of one support [m²], for bearing stresses (:func:`rockbatch.statics`).
    impact : "landing" or "housner"
        An impulse at the landing pivot, by ε; or Housner's e on the angular velocity, while the other pivot keeps its velocity,
        for which the supports would have to pull (THEORY.md, Impact by Housner's e). The latter has no ε.
    confirm : sequence of str
        Fields that are right though unusual: "friction", "beta", …

    Raises ``InputError`` with every value that is impossible, or unusual and not confirmed.

    Examples
    --------
    >>> rb.ElasticBase(beta=80, epsilon=0.05).kinematics
    'first-order'
    """

    beta: float
    epsilon: float = 0.0
    kinematics: Kinematics = "first-order"
    flight: Flight = "guided"
    zeta: float | None = field(default=None, kw_only=True)
    friction: float | None = field(default=None, kw_only=True)
    restraints: tuple[Restraint, ...] = field(default=(), kw_only=True)
    flight_limit_mm: float = field(default=FLIGHT_LIMIT_MM, kw_only=True)
    area_m2: float | None = field(default=None, kw_only=True)
    impact: Impact = field(default="landing", kw_only=True)
    confirm: Sequence[str] = field(default=(), kw_only=True, compare=False, repr=False)

    name = "elastic"
    on_springs: ClassVar[Literal[True]] = True
    two_springs: ClassVar[bool] = True
    rocking_share: ClassVar[float] = 1.0

    def __post_init__(self) -> None:
        self._check()

    def _wrong_together(self) -> list[Problem]:
        wrong = BETA.problems("beta", self.beta)
        given: dict[str, object] = {"epsilon": self.epsilon} if self.epsilon != 0 else {}
        text = f'has no effect with impact = "{self.impact}"; leave it out' if self.impact not in WITH_EPSILON else ""
        if self.zeta is not None:
            given |= {"impact": self.impact} if self.impact != "landing" else {}
            text = EPSILON_AND_ZETA
        return wrong + [Problem(name, value, text, kind=Contradiction) for name, value in given.items() if text]

    @property
    def reference_eta(self) -> float:
        """Return 1: forces and deflections of elastic springs are measured by their static ones."""
        return 1.0

    @property
    def first_loading(self) -> Curve:
        """Return the curve of the springs' first loading, over static force and deflection."""
        return Straight(math.inf)

    @property
    def has_epsilon(self) -> bool:
        """Return True if ``epsilon`` applies: not to damped supports, nor to impacts by Housner's e."""
        return self.zeta is None and self.impact in WITH_EPSILON

    @property
    def asks_tension(self) -> bool:
        """Return True for impacts by Housner's e, which need tension from a support."""
        return self.impact in ASKING_TENSION

    def parameters(self, pier: Pier) -> dict[str, object]:
        """Return these springs under ``pier`` by the keys of run.json."""
        landing: dict[str, object] = {"impact": self.impact} if self.zeta is None else {"zeta": self.zeta}
        if self.has_epsilon:
            landing["epsilon"] = self.epsilon
        values: dict[str, object] = {"beta": self.beta, **landing, "kinematics": self.kinematics}
        values |= {"flight": self.flight, "flight_limit_mm": self.flight_limit_mm}
        values |= {"omega_v": vertical_frequency(pier, self), "delta_s_m": static_deflection(pier, self)}
        values |= in_kilonewtons(pier, self)
        return values | _interface(self) | described_restraints(self.restraints)

    @classmethod
    @checked
    def from_stiffness(cls, pier: Pier, stiffness_kN_m: float, **rest: Any) -> Self:
        """Return a base from the stiffness K of one support [kN/m] under ``pier``, whose mass is known; ``rest`` as in the class.

        Raises ``InputError`` if the pier has no mass, or for values that are impossible, or unusual and not confirmed.
        """
        base = cls(beta_of(pier, stiffness_kN_m), **rest)
        refuse(unlikely_supports(pier, base.confirm, stiffness_kN_m=stiffness_kN_m, area_m2=base.area_m2))
        return base


@checked
@dataclass(frozen=True)
class YieldingBase(ElasticBase):
    """Two yielding springs that take no tension (Palmeri & Makris 2007).

    Attributes, in addition to those of :class:`ElasticBase`
    ----------
    eta : float
        Bearing capacity index η = δ_y/δ_s > 1.
    spring : "bouc-wen", "epp" or "hardening"
        The paper's smooth law (THEORY.md, eq. 7), elastic–perfectly plastic, or Bouc–Wen's curve with elastic unloading and
        reloading up to the greatest force borne so far.
    n : float
        Bouc–Wen exponent ≥ 1 of the first and the last; 5 in the paper.

    Examples
    --------
    >>> tall = rb.Pier.with_deck(width_m=8, height_m=30, mass_t=2000, deck_mass_t=1000)
    >>> pads = rb.YieldingBase.from_stiffness(tall, stiffness_kN_m=2e6, yield_kN=40e3, epsilon=0.05)
    >>> f"beta = {pads.beta:.2f}, eta = {pads.eta:.3f}"
    'beta = 58.84, eta = 2.718'
    """

    eta: float = field(kw_only=True)
    spring: SpringLaw = "bouc-wen"
    n: float = 5.0

    name = "yielding"
    yields = True

    @property
    def reference_eta(self) -> float:
        """Return η: forces and deflections of yielding springs are measured by those at yield."""
        return self.eta

    @property
    def law(self) -> Law:
        """Return the law of these springs."""
        return LAWS[self.spring]

    @property
    def first_loading(self) -> Curve:
        """Return the curve of the springs' first loading, over force and deflection at yield."""
        return self.law.first_loading(self.n)

    @property
    def has_exponent(self) -> bool:
        """Return True if the law of these springs has the exponent ``n``."""
        return self.law.has_exponent

    @property
    def ratchets(self) -> bool:
        """Return True if these springs settle cyclically under vibration (ratcheting)."""
        return self.law.creep is not None

    def by_other_law(self) -> Self:
        """Return the base with elastic–perfectly plastic springs for Bouc–Wen ones; itself if its law does not ratchet."""
        return self if self.law.creep is None else replace(self, spring=self.law.creep.other)

    def parameters(self, pier: Pier) -> dict[str, object]:
        """Return these springs under ``pier`` by the keys of run.json."""
        values = super().parameters(pier) | {"eta": self.eta, "spring": self.spring}
        if self.has_exponent:
            values["n"] = self.n
        return values | {"delta_y_m": yield_deflection(pier, self)}

    @classmethod
    @checked
    def from_stiffness(cls, pier: Pier, stiffness_kN_m: float, yield_kN: float | None = None, **rest: Any) -> Self:
        """Return a base as :meth:`ElasticBase.from_stiffness`, with the yield force F_y of one support [kN], or with ``eta``."""
        if yield_kN is not None:
            rest["eta"] = eta_of(pier, yield_kN)
            refuse(unlikely_supports(pier, rest.get("confirm", ()), yield_kN=yield_kN))
        return super().from_stiffness(pier, stiffness_kN_m, **rest)


POISSON = Bounds(0.0, 0.5, why="Poisson's ratio of the soil must be within 0..0.5")
"""Possible values of ν."""

DEPTH = Bounds(0.0, MOST, " [m], a depth")
"""Possible depths of a footing."""

STRIPS = 40
"""Strips of a footing's bed, unless its base says otherwise."""


@checked
@dataclass(frozen=True)
class FootingBase(_Traits):
    """A rigid foot on a bed of strips that push and never pull, elastic, then yielding (THEORY.md, A footing).

    The foot is as wide as the pier: ``Pier`` takes its width from it.

    Attributes
    ----------
    beta : float
        β = ω_v/p of the whole bed, vertical over rocking frequency parameter.
    safety_factor : float, optional
        FS > 1: strength of the bed over the weight; without it the bed is elastic.
    zeta : float
        ζ, 0..1: damping ratio of the vertical vibration in full contact, by dashpots that act while pressed.
    kinematics : "first-order" or "finite"
        As on springs (:class:`ElasticBase`).
    length_m : float, optional
        Length of the foot across the plane of rocking [m], for pressures.
    strips : int
        An even number of them.
    vertical_over_formula : float, optional
        Vertical stiffness of the bed over that of the soil's formula, whose rocking stiffness it has.
    friction, restraints, flight_limit_mm, confirm
        As on springs. The run goes on while all strips are clear.

    Examples
    --------
    >>> tall = rb.Pier.with_deck(width_m=8, height_m=30, mass_t=2000, deck_mass_t=1000)
    >>> clay = rb.FootingBase.from_soil(tall, shear_modulus_MPa=60, poisson=0.45, length_m=10, bearing_MPa=1.1)
    >>> f"FS = {clay.safety_factor:.2f}, {clay.vertical_over_formula:.2f} of the vertical stiffness"
    'FS = 2.99, 2.56 of the vertical stiffness'
    """

    beta: float
    safety_factor: float | None = None
    zeta: float = 0.05
    kinematics: Kinematics = "first-order"
    length_m: float | None = field(default=None, kw_only=True)
    strips: int = field(default=STRIPS, kw_only=True)
    vertical_over_formula: float | None = field(default=None, kw_only=True)
    friction: float | None = field(default=None, kw_only=True)
    restraints: tuple[Restraint, ...] = field(default=(), kw_only=True)
    flight_limit_mm: float = field(default=FLIGHT_LIMIT_MM, kw_only=True)
    confirm: Sequence[str] = field(default=(), kw_only=True, compare=False, repr=False)

    name = "footing"
    on_springs: ClassVar[Literal[True]] = True
    remembers: ClassVar[bool] = True
    flight: ClassVar[Flight] = "guided"  # type: ignore[misc]
    area_m2: ClassVar[None] = None
    rocking_share: ClassVar[float] = 1.0 / 3.0
    """Share of the rocking stiffness of the same springs at both edges."""
    reference_eta: ClassVar[float] = 1.0

    def __post_init__(self) -> None:
        self._check()

    def _wrong_together(self) -> list[Problem]:
        wrong = BETA.problems("beta", self.beta)
        if self.strips < 2 or self.strips > MOST_STRIPS or self.strips % 2:
            text = f"must be an even number from 2 to {MOST_STRIPS}; half as many give the error"
            wrong.append(Problem("strips", self.strips, text, kind=OutOfRange))
        return wrong

    @property
    def yields(self) -> bool:  # type: ignore[override]
        """Return whether the bed has a strength."""
        return self.safety_factor is not None

    def zeta_rocking(self, pier: Pier) -> float:
        """Return the damping ratio of rocking in full contact, as the dashpots of the bed give it."""
        omega_v, omega_r = vertical_frequency(pier, self), rocking_frequency(pier, self)
        share = (omega_v * pier.half_width) ** 2 * self.rocking_share / (pier.inertia + pier.height**2)
        return self.zeta * share / (omega_v * omega_r)

    def parameters(self, pier: Pier) -> dict[str, Any]:
        """Return this footing under ``pier`` by the keys of run.json."""
        values: dict[str, Any] = {"beta": self.beta, "zeta": self.zeta, "zeta_rocking": self.zeta_rocking(pier)}
        given = ("safety_factor", "length_m", "vertical_over_formula")
        values |= {name: getattr(self, name) for name in given if getattr(self, name) is not None}
        values |= {"kinematics": self.kinematics, "strips": self.strips, "flight_limit_mm": self.flight_limit_mm}
        values |= {"omega_v": vertical_frequency(pier, self), "delta_s_m": static_deflection(pier, self)}
        return values | _interface(self) | described_restraints(self.restraints)

    @classmethod
    @checked
    def from_stiffness(
        cls, pier: Pier, stiffness_MN_m3: float, *, length_m: float, bearing_MPa: float | None = None, **rest: Any
    ) -> Self:
        """Return a footing from the stiffness of the bed [MN/m³], or E/depth of a toe, and its bearing strength [MPa], or with
        ``safety_factor``, under ``pier``, whose mass is known; ``rest`` as in the class.

        Raises ``InputError`` if the pier has no mass, or for values that are impossible, or unusual and not confirmed.
        """
        area = 2.0 * pier.half_width * length_m
        wrong = POSITIVE.problems("stiffness_MN_m3", stiffness_MN_m3) + POSITIVE.problems("length_m", length_m)
        wrong += [] if bearing_MPa is None else POSITIVE.problems("bearing_MPa", bearing_MPa)
        if pier.mass_t is None:
            text = "is missing: MPa and MN/m³ are of a pier whose mass is known"
            wrong.append(Problem("mass_t", None, text, kind=MissingKey))
        if bearing_MPa is not None and rest.get("safety_factor") is not None:
            text = "safety_factor is given, too, which fixes the same; keep one"
            wrong.append(Problem("bearing_MPa", bearing_MPa, text, kind=Contradiction))
        refuse(wrong)
        assert pier.mass_t is not None
        if bearing_MPa is not None:
            rest["safety_factor"] = 1000.0 * bearing_MPa * area / (pier.mass_t * pier.gravity)
        return cls(math.sqrt(1000.0 * stiffness_MN_m3 * area / pier.mass_t) / pier.p, length_m=length_m, **rest)

    @classmethod
    @checked
    def from_soil(
        cls,
        pier: Pier,
        shear_modulus_MPa: float,
        poisson: float,
        *,
        length_m: float,
        embedment_m: float = 0.0,
        formula: Formula = "gazetas",
        density_t_m3: float | None = None,
        **rest: Any,
    ) -> Self:
        """Return a footing from G [MPa] and ν of the soil: its bed has the rocking stiffness of the ``formula``.

        With ``density_t_m3`` radiation damping joins ``zeta``. ``rest`` as in :meth:`from_stiffness`.
        Raises ``InputError`` as that does.
        """
        soil, width = Soil(shear_modulus_MPa, poisson, embedment_m), 2.0 * pier.half_width
        known = [] if formula in FORMULAS else [f"must be {' or '.join(map(shown, FORMULAS))}"]
        wrong = [Problem("formula", formula, text, kind=WrongType) for text in known]
        refuse(wrong + wrong_soil(soil, length_m, density_t_m3))
        stiffness = FORMULAS[formula](width, length_m, soil)
        bed = bed_stiffness(width, length_m, stiffness.rocking)
        rest["vertical_over_formula"] = bed * width * length_m / stiffness.vertical
        base = cls.from_stiffness(pier, bed, length_m=length_m, **rest)
        if density_t_m3 is None or pier.mass_t is None:
            return base
        dashpot = 1000.0 * radiated(width, length_m, soil, density_t_m3)
        return replace(base, zeta=base.zeta + 0.5 * dashpot / (pier.mass_t * vertical_frequency(pier, base)))


def wrong_soil(soil: Soil, length_m: float, density_t_m3: float | None = None) -> list[Problem]:
    """Return what is impossible about soil and length of a footing."""
    wrong = POSITIVE.problems("shear_modulus_MPa", soil.shear_modulus_MPa) + POSITIVE.problems("length_m", length_m)
    wrong += POISSON.problems("poisson", soil.poisson) + DEPTH.problems("embedment_m", soil.embedment_m)
    return wrong + POSITIVE.problems("density_t_m3", density_t_m3)


Base = RigidBase | ElasticBase | YieldingBase | FootingBase

BASES: dict[str, type[Base]] = {base.name: base for base in (RigidBase, ElasticBase, YieldingBase, FootingBase)}
"""Bases by the names that users write."""

IMPULSIVE = (RigidBase.name,)
"""Bases that do not give, on which every landing is an impulse."""


def _interface(base: Base) -> dict[str, float]:
    """Return friction and area of the interface by the keys of run.json; those not given are left out."""
    values = {"friction": base.friction, "area_m2": base.area_m2}
    return {name: value for name, value in values.items() if value is not None}


def in_kilonewtons(pier: Pier, base: Base) -> dict[str, float]:
    """Return K = β² p² M/2 [kN/m] and F_y = η M g/2 [kN] by study key; empty without a mass, or without two springs."""
    if pier.mass_t is None or not base.two_springs:
        return {}
    values = {"stiffness_kN_m": 0.5 * pier.mass_t * vertical_frequency(pier, base) ** 2}
    if isinstance(base, YieldingBase):
        values["yield_kN"] = 0.5 * base.eta * pier.mass_t * pier.gravity
    return values


def neglected(pier: Pier, theta: float) -> float:
    """Return the share of inertia and righting moment that linearised kinematics neglects at the rotation ``theta`` [rad].

    μ/(1+μ) sin α cos α |θ| of the inertia about a pivot and θ²/2 of the moment M g b (THEORY.md, Two springs, finite kinematics).
    """
    inertia = pier.mu / (1 + pier.mu) * math.sin(pier.alpha) * math.cos(pier.alpha) * abs(theta)
    return inertia + 0.5 * theta * theta
