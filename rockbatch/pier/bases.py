"""Bases of a pier: rigid, elastic and yielding (Palmeri & Makris 2007).

Impossible combinations of a pier and a base are checked in :mod:`rockbatch.pier.possible`.
"""

import math
import warnings
from collections.abc import Sequence
from dataclasses import InitVar, dataclass, field
from typing import Any, ClassVar, Literal, Self

from rockbatch.common.arguments import checked
from rockbatch.common.errors import Contradiction, MissingKey, OutOfRange, Problem, Superseded, WrongType, refuse
from rockbatch.common.units import Bounds
from rockbatch.pier.backbones import first_corner, wrong_points
from rockbatch.pier.block import Pier
from rockbatch.pier.first_loading import Curve, Straight
from rockbatch.pier.footing_base import FootingBase
from rockbatch.pier.frequencies import static_deflection, vertical_frequency, yield_deflection
from rockbatch.pier.laws import LAWS, WITH_POINTS, Law, SpringLaw
from rockbatch.pier.restraints import Restraint, described_restraints
from rockbatch.pier.shafts import WithShaft
from rockbatch.pier.supports import FIXED_BY_POINTS, beta_of, eta_of, of_backbone, unlikely_supports
from rockbatch.pier.traits import (
    ASKING_TENSION,
    BETA,
    EPSILON_AND_ZETA,
    ETA_OF_BACKBONE,
    FLIGHT_LIMIT_MM,
    WITH_EPSILON,
    Flight,
    Impact,
    Kinematics,
    interface,
    wrong_blow,
)

MOST_NEGLECTED = 0.05
"""Share of inertia and righting moment, neglected by linearised kinematics, from which a note reports it: 0.20 rad at α = 0.2."""


@checked
@dataclass(frozen=True)
class RigidBase(WithShaft):
    """Ground that neither gives nor yields (Housner 1963).

    ``restitution`` is the factor e on the angular velocity at an impact; ``None`` means :attr:`Pier.restitution`, Housner's
    e = 1 − 2μ/(1+μ) sin²α, which conserves the angular momentum about the new pivot, or 0 where that is negative.
    ``restraints`` are devices between the pier and the ground: dampers, tendons, stops and deck springs.
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
    flexural_impact: InitVar[str | None] = field(default=None, kw_only=True)
    contact_stiffness_kN_m: float | None = field(default=None, kw_only=True)  # noqa: N815 (the study's key)
    confirm: Sequence[str] = field(default=(), kw_only=True, compare=False, repr=False)

    name = "rigid"
    on_springs: ClassVar[Literal[False]] = False
    kinematics: ClassVar[Kinematics] = "finite"
    beta: ClassVar[float] = math.inf
    """β of ground that does not give: the limit of springs."""

    def __post_init__(self, flexural_impact: str | None) -> None:
        """Check the fields; warn of ``flexural_impact`` "momentum", without effect; ``WrongType`` for any other than that."""
        self._check()
        if flexural_impact is None:
            return
        if problem := wrong_blow(flexural_impact):
            raise WrongType(Problem("flexural_impact", flexural_impact, problem))
        message = 'flexural_impact = "momentum" has no effect, since no other rule of a blow is left; leave it out'
        warnings.warn(message, Superseded, stacklevel=4)

    def parameters(self, pier: Pier) -> dict[str, object]:
        """Return this base under ``pier`` by the keys of run.json; ``restitution`` not given is None, or a frame's own."""
        of_frame = None if pier.deck_over_columns is None else pier.restitution  # None stands for Housner's
        values: dict[str, object] = {"restitution": of_frame if self.restitution is None else self.restitution}
        values |= {"flight": self.flight, "flight_limit_mm": self.flight_limit_mm}
        values |= self.of_shaft(pier)
        if self.contact_stiffness_kN_m is not None:
            values["contact_stiffness_kN_m"] = self.contact_stiffness_kN_m
        return values | interface(self.friction, self.area_m2) | described_restraints(self.restraints)


@checked
@dataclass(frozen=True)
class ElasticBase(WithShaft):
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
    shaft, flexural_damping, flexural_damping_kind, flexural_modes
        Of a pier that bends, as on a rigid base (:class:`RigidBase`); it takes ``zeta`` and finite kinematics.
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
        """Return the curve of the springs' first loading, over static force and deflection: straight, without end."""
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
        """Return these springs under ``pier`` by the keys of run.json, without what is not given or has no effect."""
        landing: dict[str, object] = {"impact": self.impact} if self.zeta is None else {"zeta": self.zeta}
        if self.has_epsilon:
            landing["epsilon"] = self.epsilon
        values: dict[str, object] = {"beta": self.beta, **landing, "kinematics": self.kinematics}
        values |= {"flight": self.flight, "flight_limit_mm": self.flight_limit_mm}
        values |= {"omega_v": vertical_frequency(pier, self), "delta_s_m": static_deflection(pier, self)}
        values |= in_kilonewtons(pier, self) | self.of_shaft(pier)
        return values | interface(self.friction, self.area_m2) | described_restraints(self.restraints)

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
        Bearing capacity index η = δ_y/δ_s > 1; of a backbone, whose greatest force carries the pier, > 0.
    spring : "bouc-wen", "epp", "hardening" or "backbone"
        The paper's smooth law (THEORY.md, eq. 7), elastic–perfectly plastic, or Bouc–Wen's curve with elastic unloading and
        reloading up to the greatest force borne so far; or the same rule with a curve of its own (THEORY.md, A backbone).
    n : float
        Bouc–Wen exponent ≥ 1 of the first and the third; 5 in the paper.
    backbone : tuple of (float, float)
        Points of the last one's curve, deflection over δ_y and force over F_y: a concave polyline whose first corner is (1, 1)
        and whose last slope goes on. δ_y and F_y are those of that corner, so that η may be below 1 (:meth:`from_backbone`).

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
    backbone: tuple[tuple[float, float], ...] = field(default=(), kw_only=True)

    name = "yielding"
    yields = True

    def _bounds(self, name: str) -> Bounds:
        return ETA_OF_BACKBONE if name == "eta" and self.has_points else super()._bounds(name)

    def _wrong_together(self) -> list[Problem]:
        wrong = super()._wrong_together()
        if self.backbone and not self.has_points:
            text = f'is of spring = "backbone", and these springs are "{self.spring}"; change one'
            wrong.append(Problem("backbone", None, text, kind=Contradiction))
        elif self.has_points and not self.backbone:
            text = (
                "backbone is missing; write for example backbone = ((1, 1), (3, 1.75), (6, 2)), or take from_backbone"
            )
            wrong.append(Problem("backbone", None, text, kind=MissingKey, named=False))
        elif self.has_points and (text := wrong_points(self.backbone)):
            wrong.append(Problem("backbone", None, text, kind=OutOfRange))
        elif self.backbone and self.backbone[0] != (1.0, 1.0):
            text = "its first point must be (1, 1), since all are over its deflection and force; or take from_backbone"
            wrong.append(Problem("backbone", None, text, kind=OutOfRange))
        return wrong

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
        return self.law.first_loading(self.n, self.backbone)

    @property
    def has_exponent(self) -> bool:
        """Return True if the law of these springs has the exponent ``n``."""
        return self.law.has_exponent

    @property
    def has_points(self) -> bool:
        """Return True if the curve of these springs is given by points; False for an unknown law, which is refused."""
        return self.spring in WITH_POINTS

    @property
    def ratchets(self) -> bool:
        """Return True if these springs settle cyclically under vibration (ratcheting)."""
        return self.law.creep is not None

    def parameters(self, pier: Pier) -> dict[str, object]:
        """Return these springs as :meth:`ElasticBase.parameters` does, with η, the law, ``n`` if the law has it, and δ_y."""
        values = super().parameters(pier) | {"eta": self.eta, "spring": self.spring}
        if self.has_exponent:
            values["n"] = self.n
        if self.backbone:
            values["backbone"] = [list(point) for point in self.backbone]
        return values | {"delta_y_m": yield_deflection(pier, self)}

    @classmethod
    @checked
    def from_stiffness(cls, pier: Pier, stiffness_kN_m: float, yield_kN: float | None = None, **rest: Any) -> Self:
        """Return a base as :meth:`ElasticBase.from_stiffness`, with the yield force F_y of one support [kN], or with ``eta``.

        Raises ``InputError`` if both are given.
        """
        if yield_kN is not None:
            if "eta" in rest:
                text = "eta is given, too, which sets the same quantity; keep one"
                refuse([Problem("yield_kN", yield_kN, text, kind=Contradiction)])
            rest["eta"] = eta_of(pier, yield_kN)
            refuse(unlikely_supports(pier, rest.get("confirm", ()), yield_kN=yield_kN))
        return super().from_stiffness(pier, stiffness_kN_m, **rest)

    @classmethod
    @checked
    def from_backbone(cls, pier: Pier, points_mm_kN: tuple[tuple[float, float], ...], **rest: Any) -> Self:
        """Return a base from the backbone of one support, points of deflection [mm] and force [kN]; ``rest`` as in the class.

        ``pier`` must have a mass; an array of the points has the shape (n, 2). The first point is the first corner, and the
        last slope goes on. Raises ``InputError`` for points that are no concave polyline, for ``rest`` that they fix, or values
        that are impossible, or unusual and not confirmed.

        Examples
        --------
        >>> tall = rb.Pier.with_deck(width_m=8, height_m=30, mass_t=2000, deck_mass_t=1000)
        >>> pads = rb.YieldingBase.from_backbone(tall, [(10, 20e3), (30, 35e3), (60, 40e3)], epsilon=0.05)
        >>> pads.backbone
        ((1.0, 1.0), (3.0, 1.75), (6.0, 2.0))
        """
        if text := wrong_points(points_mm_kN):
            refuse([Problem("points_mm_kN", None, text, kind=OutOfRange)])
        text = "the points fix the same; leave it out"
        fixed = rest.keys() & {*FIXED_BY_POINTS, "spring", "backbone"}
        refuse([Problem(name, rest[name], text, kind=Contradiction) for name in sorted(fixed)])
        stiffness, force = first_corner(points_mm_kN)
        base = cls(**of_backbone(pier, points_mm_kN), spring="backbone", **rest)
        refuse(unlikely_supports(pier, base.confirm, stiffness_kN_m=stiffness, yield_kN=force, area_m2=base.area_m2))
        return base


Base = RigidBase | ElasticBase | YieldingBase | FootingBase

BASES: dict[str, type[Base]] = {base.name: base for base in (RigidBase, ElasticBase, YieldingBase, FootingBase)}
"""Bases by the names that users write."""

IMPULSIVE = (RigidBase.name,)
"""Bases that do not give, on which every landing is an impulse."""


def in_kilonewtons(pier: Pier, base: Base) -> dict[str, float]:
    """Return K = β² p² M/2 [kN/m], and F_y = η M g/2 [kN] if it yields, by study key; {} without mass or two springs."""
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
