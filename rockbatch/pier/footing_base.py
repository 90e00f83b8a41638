"""A base with a length: a rigid foot on a bed of strips (THEORY.md, A footing)."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any, ClassVar, Literal, Self

from rockbatch.common.arguments import checked
from rockbatch.common.errors import Contradiction, MissingKey, OutOfRange, Problem, Unusual, WrongType, refuse
from rockbatch.common.showing import shown
from rockbatch.common.units import MOST, POSITIVE, Bounds
from rockbatch.pier.block import Pier
from rockbatch.pier.frequencies import rocking_frequency, static_deflection, vertical_frequency
from rockbatch.pier.restraints import Restraint, described_restraints
from rockbatch.pier.shafts import WithShaft
from rockbatch.pier.soil import FORMULAS, Formula, Soil, bed_stiffness, radiated
from rockbatch.pier.traits import BETA, FLIGHT_LIMIT_MM, Flight, Kinematics, interface

MOST_STRIPS = 160
"""Greatest number of strips of a footing's bed; the core has room for no more."""

POISSON = Bounds(0.0, 0.5, why="Poisson's ratio of the soil must be within 0..0.5")
"""Possible values of ν."""

DEPTH = Bounds(0.0, MOST, " [m], a depth")
"""Possible depths of a footing."""

STIFFEST_MPA = 30e3
"""Shear modulus [MPa] above which a wrong unit is likelier than the ground: sound rock has some 10 to 30 GPa."""

STRIPS = 40
"""Strips of a footing's bed, unless its base says otherwise."""


@checked
@dataclass(frozen=True)
class FootingBase(WithShaft):
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
    shaft, flexural_damping, flexural_damping_kind, flexural_modes
        Of a pier that bends, as on a rigid base (:class:`RigidBase`); it takes finite kinematics.
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
        """Return this footing under ``pier`` by the keys of run.json, without what is not given."""
        values: dict[str, Any] = {"beta": self.beta, "zeta": self.zeta, "zeta_rocking": self.zeta_rocking(pier)}
        given = ("safety_factor", "length_m", "vertical_over_formula")
        values |= {name: getattr(self, name) for name in given if getattr(self, name) is not None}
        values |= {"kinematics": self.kinematics, "strips": self.strips, "flight_limit_mm": self.flight_limit_mm}
        values |= {"omega_v": vertical_frequency(pier, self), "delta_s_m": static_deflection(pier, self)}
        values |= self.of_shaft(pier)
        return values | interface(self.friction, self.area_m2) | described_restraints(self.restraints)

    @classmethod
    @checked
    def from_stiffness(
        cls, pier: Pier, stiffness_MN_m3: float, *, length_m: float, bearing_MPa: float | None = None, **rest: Any
    ) -> Self:
        """Return a footing under ``pier``, whose mass is known, from the stiffness of its bed [MN/m³], E/depth under a toe.

        Its bearing strength [MPa], or ``safety_factor`` in ``rest``, makes it yield; with neither it is elastic. ``rest`` as in
        the class.

        Raises ``InputError`` if the pier has no mass, or for values that are impossible, or unusual and not confirmed.
        """
        area = 2.0 * pier.half_width * length_m
        wrong = POSITIVE.problems("stiffness_MN_m3", stiffness_MN_m3) + POSITIVE.problems("length_m", length_m)
        wrong += [] if bearing_MPa is None else POSITIVE.problems("bearing_MPa", bearing_MPa)
        if pier.mass_t is None:
            text = "is missing: MPa and MN/m³ are of a pier whose mass is known"
            wrong.append(Problem("mass_t", None, text, kind=MissingKey))
        if bearing_MPa is not None and rest.get("safety_factor") is not None:
            text = "safety_factor is given, too, which sets the same quantity; keep one"
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

        With ``density_t_m3`` radiation damping joins ``zeta``. ``rest`` as in :meth:`from_stiffness`. Raises ``InputError``
        as that method does, and for an unknown formula or impossible soil.
        """
        soil, width = Soil(shear_modulus_MPa, poisson, embedment_m), 2.0 * pier.half_width
        known = [] if formula in FORMULAS else [f"must be {' or '.join(map(shown, FORMULAS))}"]
        wrong = [Problem("formula", formula, text, kind=WrongType) for text in known]
        refuse(wrong + wrong_soil(soil, length_m, density_t_m3))
        stiffness = FORMULAS[formula](width, length_m, soil)
        bed = bed_stiffness(width, length_m, stiffness.rocking)
        rest["vertical_over_formula"] = bed * width * length_m / stiffness.vertical
        base = cls.from_stiffness(pier, bed, length_m=length_m, **rest)
        refuse(_unlikely_ground(shear_modulus_MPa, base.confirm))
        if density_t_m3 is None or pier.mass_t is None:
            return base
        dashpot = 1000.0 * radiated(width, length_m, soil, density_t_m3)
        return replace(base, zeta=base.zeta + 0.5 * dashpot / (pier.mass_t * vertical_frequency(pier, base)))


def _unlikely_ground(shear_modulus_MPa: float, confirm: Sequence[str]) -> list[Problem]:
    """Return the problem of a shear modulus above :data:`STIFFEST_MPA`; [] if it is not, or confirmed."""
    name = "shear_modulus_MPa"
    if shear_modulus_MPa <= STIFFEST_MPA or name in confirm:
        return []
    text = "stiffer than the ground is, of which sound rock has some 10 to 30 GPa"
    return [Problem(name, shear_modulus_MPa, text, confirm=name, kind=Unusual)]


def wrong_soil(soil: Soil, length_m: float, density_t_m3: float | None = None) -> list[Problem]:
    """Return a problem for each impossible value of the soil, the length of a footing, and a density that is given."""
    wrong = POSITIVE.problems("shear_modulus_MPa", soil.shear_modulus_MPa) + POSITIVE.problems("length_m", length_m)
    wrong += POISSON.problems("poisson", soil.poisson) + DEPTH.problems("embedment_m", soil.embedment_m)
    return wrong + POSITIVE.problems("density_t_m3", density_t_m3)
