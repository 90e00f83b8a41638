"""Devices between a pier and the ground (THEORY.md, Dampers and tendons, Stops and deck springs)."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field, fields
from typing import Any, ClassVar, Literal, Self

from rockbatch.common.arguments import checked
from rockbatch.common.errors import InputError
from rockbatch.common.showing import InNotebook
from rockbatch.common.units import LEAST, MOST, NOT_NEGATIVE, Bounds
from rockbatch.pier.block import Pier
from rockbatch.pier.sizes import BOUNDS as OF_PIER

DamperKind = Literal["friction", "viscous", "hysteretic"]

Side = Literal["both", "left", "right"]
"""To which side a deck moves when it meets a spring."""

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
"""Values of devices. Beyond ten times the weight a wrong unit is likelier than the device; fluid dampers have
exponents of 0.15 to 1, and one of 0 is friction."""

HEIGHT = OF_PIER["deck_height_m"]
"""Heights at which a spring may act on the deck [m]."""

DAMPERS = {"friction": ("f",), "hysteretic": ("f", "yield_m"), "viscous": ("nu", "exponent")}
"""By kind of damper, the fields that count."""

FIELDS = DAMPERS | {"tendon": ("psi", "lam"), "stop": ("gap_m", "lam", "restitution")}
FIELDS["deck_spring"] = FIELDS["stop"]
"""Of other devices too, but for a tendon's yield force."""


@checked
@dataclass(frozen=True)
class Damper(InNotebook):
    """A damper between the pier and the ground.

    Attributes
    ----------
    kind : "friction", "viscous" or "hysteretic"
        F_d sgn(ė); C |ė|^a sgn(ė); F_d z with a two-sided Bouc–Wen law, n = 5, of which friction is the limit u_y → 0.
    f : float
        F_d/(M g) of a friction or hysteretic damper.
    nu : float
        C/(M p) of a viscous damper; with an exponent a, of C in (m/s)^-a.
    yield_m : float
        u_y of a hysteretic damper [m].
    exponent : float
        a of a viscous damper, 0.1 to 2.
    at : float, "left", "right", "deck" or None
        Offset from the centre of the base [m], positive to the right; None: one at each pivot. "deck": a horizontal one between
        the deck, at ``Pier.deck``, and a structure next to it that moves with the ground; not of friction.
    brace : float
        λ = k b²/(M g R0) of the stiffness k of what the damper hangs on, in series with it; infinite if that is rigid. Of a
        viscous damper whose exponent is 1 at most, or a hysteretic one.
    confirm : sequence of str
        "f", "nu", "yield_m" or "brace", if the value is right though unusual.

    Examples
    --------
    >>> steel = rb.Damper("hysteretic", f=0.05, yield_m=0.005)
    >>> base = rb.RigidBase(restraints=(steel,))
    >>> motion = rb.pulse("sine", name="one-sine", amplitude=9.81, period=0.5, dt=0.005, duration=2.0)
    >>> response = rb.simulate(rb.Pier(alpha=0.2, p=1.0), base, motion)
    >>> response.status
    'ok'
    """

    what: ClassVar[str] = "damper"

    kind: DamperKind
    f: float = 0.0
    nu: float = 0.0
    yield_m: float = 0.0
    exponent: float = 1.0
    at: float | str | None = None
    brace: float = field(default=math.inf, kw_only=True)
    confirm: Sequence[str] = field(default=(), kw_only=True, compare=False, repr=False)

    @classmethod
    @checked
    def friction(cls, pier: Pier, force_kN: float, **rest: Any) -> Self:
        """Return a friction damper of the force F_d [kN] under ``pier``; ``rest``: ``at`` and ``confirm``.

        Here and in the other constructors from kN, raises ``InputError`` if the mass of the pier is not known, or for values that
        cannot be.
        """
        return cls("friction", **_over_weight(pier, force_kN=force_kN), **rest)

    @classmethod
    @checked
    def hysteretic(
        cls, pier: Pier, force_kN: float, yield_mm: float, *, brace_kN_m: float = math.inf, **rest: Any
    ) -> Self:
        """Return a hysteretic damper of the yield force F_d [kN] and deflection u_y [mm]; otherwise as :meth:`friction`.

        ``brace_kN_m`` is the stiffness of the brace on which it hangs.
        """
        values = {"force_kN": force_kN, "yield_mm": yield_mm} | _if_finite(brace_kN_m=brace_kN_m)
        return cls("hysteretic", **_over_weight(pier, **values), **rest)

    @classmethod
    @checked
    def viscous(
        cls, pier: Pier, coefficient_kN_s_m: float, exponent: float = 1.0, *, brace_kN_m: float = math.inf, **rest: Any
    ) -> Self:
        """Return a viscous damper of C [kN (s/m)^a] and the exponent a, on a brace of the stiffness ``brace_kN_m``.

        Otherwise as :meth:`friction`.

        Examples
        --------
        >>> tall = rb.Pier.with_deck(width_m=8, height_m=30, mass_t=2000, deck_mass_t=1000)
        >>> rb.Damper.viscous(tall, coefficient_kN_s_m=1500.0, exponent=0.3)
        Damper(kind='viscous', f=0.0, nu=0.8057089065897499, yield_m=0.0, exponent=0.3, at=None, brace=inf)
        """
        values = {"coefficient_kN_s_m": coefficient_kN_s_m, "exponent": exponent} | _if_finite(brace_kN_m=brace_kN_m)
        return cls("viscous", **_over_weight(pier, **values), **rest)


@checked
@dataclass(frozen=True)
class Tendon(InNotebook):
    """An unbonded tendon between the pier and the ground that takes tension only.

    Attributes
    ----------
    psi : float
        ψ = P0/(M g), its prestress.
    lam : float
        λ = k_t b²/(M g R0), its stiffness.
    strength : float
        T_y/(M g) at which it yields, and stays longer; infinite if it does not yield.
    at : float, "left" or "right"
        Offset from the centre of the base [m], positive to the right.
    confirm : sequence of str
        "lam", "psi" or "strength", if the value is right though unusual.

    Examples
    --------
    >>> base = rb.RigidBase(restraints=(rb.Tendon(psi=0.5, lam=0.3),))
    >>> motion = rb.pulse("sine", name="one-sine", amplitude=9.81, period=0.5, dt=0.005, duration=2.0)
    >>> response = rb.simulate(rb.Pier(alpha=0.2, p=1.0), base, motion)
    >>> list(response.restraints)[1:]
    ['tendon 1 elongation', 'tendon 1 force']
    """

    what: ClassVar[str] = "tendon"

    psi: float = 0.0
    lam: float = 0.0
    strength: float = math.inf
    at: float | str = 0.0
    confirm: Sequence[str] = field(default=(), kw_only=True, compare=False, repr=False)

    @classmethod
    @checked
    def of(
        cls, pier: Pier, prestress_kN: float = 0.0, stiffness_kN_m: float = 0.0, yield_kN: float = math.inf, **rest: Any
    ) -> Self:
        """Return a tendon of the prestress P0 [kN], the stiffness k_t [kN/m] and the yield force T_y [kN] under ``pier``.

        ``rest``: ``at`` and ``confirm``. Raises ``InputError`` as :meth:`Damper.friction`.
        """
        values = {"prestress_kN": prestress_kN, "stiffness_kN_m": stiffness_kN_m} | _if_finite(yield_kN=yield_kN)
        return cls(**_over_weight(pier, **values), **rest)


@checked
@dataclass(frozen=True)
class Stop(InNotebook):
    """A stop that limits how far the base may lift: a spring that is met when its place has risen by a gap.

    While it is pressed in for the first time it takes F = k δ; on its way back, and pressed in again up to the greatest δ of the
    blow, it follows a line of the slope k/e². So it gives back e² of what it has taken, and a mass that hits nothing else leaves
    it at e times its speed. Before the next blow it has its shape back.

    Attributes
    ----------
    gap_m : float
        By how much its place rises until it is met [m].
    lam : float
        λ = k b²/(M g R0), its stiffness.
    restitution : float
        e, 0.1 to 1; 1 takes no energy.
    at : float, "left", "right" or None
        Offset from the centre of the base [m], positive to the right; None: one at each pivot.
    confirm : sequence of str
        "gap_m" or "lam", if the value is right though unusual.

    Examples
    --------
    >>> base = rb.RigidBase(restraints=(rb.Stop(gap_m=0.1, lam=20.0, restitution=0.6),))
    >>> motion = rb.pulse("sine", name="one-sine", amplitude=9.81, period=0.5, dt=0.005, duration=2.0)
    >>> free, stopped = (rb.simulate(rb.Pier(alpha=0.2, p=1.0), each, motion) for each in (rb.RigidBase(), base))
    >>> stopped.theta_max < free.theta_max
    True
    """

    what: ClassVar[str] = "stop"

    gap_m: float
    lam: float = 0.0
    restitution: float = 1.0
    at: float | str | None = None
    confirm: Sequence[str] = field(default=(), kw_only=True, compare=False, repr=False)

    @classmethod
    @checked
    def of(cls, pier: Pier, gap_mm: float, stiffness_kN_m: float, restitution: float = 1.0, **rest: Any) -> Self:
        """Return a stop with a gap [mm] and the stiffness k [kN/m] under ``pier``; ``rest``: ``at`` and ``confirm``.

        Raises ``InputError`` as :meth:`Damper.friction`.
        """
        values = {"gap_mm": gap_mm, "stiffness_kN_m": stiffness_kN_m, "restitution": restitution}
        return cls(**_over_weight(pier, **values), **rest)


@checked
@dataclass(frozen=True)
class DeckSpring(InNotebook):
    """A horizontal spring between the deck and a structure that moves with the ground: an abutment, a neighbouring span.

    With a gap, or on one side, the deck meets it as the base does a :class:`Stop`, and it follows the same law. On both sides
    and without a gap and a loss it is linear.

    Attributes
    ----------
    lam : float
        λ = k b²/(M g R0), its stiffness.
    gap_m : float
        By how much the deck moves until it is met [m].
    restitution : float
        e, 0.1 to 1; 1 takes no energy.
    side : "both", "left" or "right"
        To which side the deck moves when it is met; both: one on each.
    height_m : float or None
        Height above the pivots at which it acts [m]; that of the deck, ``Pier.deck``, by default.
    confirm : sequence of str
        "lam", "gap_m" or "height_m", if the value is right though unusual.

    Examples
    --------
    >>> base = rb.RigidBase(restraints=(rb.DeckSpring(lam=0.2, gap_m=0.05, side="right"),))
    >>> motion = rb.pulse("sine", name="one-sine", amplitude=9.81, period=0.5, dt=0.005, duration=2.0)
    >>> response = rb.simulate(rb.Pier(alpha=0.2, p=1.0), base, motion)
    >>> list(response.restraints)[1:]
    ['deck spring 1 elongation', 'deck spring 1 force']
    """

    what: ClassVar[str] = "deck_spring"

    lam: float
    gap_m: float = 0.0
    restitution: float = 1.0
    side: Side = "both"
    height_m: float | None = None
    confirm: Sequence[str] = field(default=(), kw_only=True, compare=False, repr=False)

    @classmethod
    @checked
    def of(cls, pier: Pier, stiffness_kN_m: float, gap_mm: float = 0.0, restitution: float = 1.0, **rest: Any) -> Self:
        """Return a spring of the stiffness k [kN/m] with a gap [mm] at the deck of ``pier``.

        ``rest``: ``side``, ``height_m`` and ``confirm``. Raises ``InputError`` as :meth:`Damper.friction`.
        """
        values = {"stiffness_kN_m": stiffness_kN_m, "gap_mm": gap_mm, "restitution": restitution}
        return cls(**_over_weight(pier, **values), **rest)

    @property
    def linear(self) -> bool:
        """Whether it pulls and pushes alike."""
        return self.side == "both" and self.gap_m == 0.0 and self.restitution == 1.0


Restraint = Damper | Tendon | Stop | DeckSpring

KINDS: dict[str, type[Restraint]] = {kind.what: kind for kind in (Damper, Tendon, Stop, DeckSpring)}
"""Devices by the names of their tables in a study."""


def what_of(values: Mapping[str, Any]) -> str:
    """Return the kind of device, one of :data:`KINDS`, that has these fields in run.json."""
    if "side" in values:
        return "deck_spring"
    return "damper" if "kind" in values else "stop" if "gap_m" in values else "tendon"


def restraint_of(values: Mapping[str, Any]) -> Restraint:
    """Return the device with these fields, as run.json and histories have them; None is a value that is not given."""
    kind = KINDS[what_of(values)]
    names = {attribute.name for attribute in fields(kind)}
    return kind(**{name: value for name, value in values.items() if name in names and value is not None})


def fields_of(pier: Pier) -> dict[str, tuple[str, float]]:
    """Return by a study's key the field of a device, and the key's value over the field's; those in kN if the mass is known."""
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


def _if_finite(**values: float) -> dict[str, float]:
    """Return those values that are not infinite, which stands for what is not there."""
    return {name: value for name, value in values.items() if value != math.inf}


def _over_weight(pier: Pier, **values: float) -> dict[str, Any]:
    """Return the fields of a device from the keys of a study."""
    if pier.mass_t is None:
        raise InputError("mass_t is missing: kN are of a pier whose mass is known")
    wrong = [problem for name, value in values.items() for problem in NOT_NEGATIVE.problems(name, value)]
    if wrong:
        raise InputError(*wrong)
    factors = fields_of(pier)
    return {factors[name][0]: value / factors[name][1] for name, value in values.items()}


def described_restraints(restraints: tuple[Restraint, ...]) -> dict[str, Any]:
    """Return devices by the keys of run.json; empty without any."""
    devices = [
        {
            name: None if value == math.inf else value
            for name, value in asdict(device).items()
            if value is not None and name != "confirm"
        }
        for device in restraints
    ]
    return {"restraints": devices} if devices else {}
