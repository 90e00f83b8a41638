"""Devices between a pier and the ground (THEORY.md, Dampers and tendons, Stops and deck springs).

Implausible ones, as of a wrong unit, are refused until their ``confirm`` names the value.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field, fields, replace
from typing import Any, ClassVar, Literal, NamedTuple, Self, get_args

from rockbatch.arguments import checked
from rockbatch.errors import InputError, remedy
from rockbatch.pier.block import BOUNDS as OF_PIER
from rockbatch.pier.block import HIGHEST, Pier
from rockbatch.units import LEAST, MOST, NOT_NEGATIVE, POSITIVE, Bounds

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

SPEED = 0.1
"""Speed of a viscous damper [m/s] at which it has less than the pier's weight; heels of piers that step reach 0.1 to 1 m/s."""

THINNEST, WIDEST = 2.5e-5, 0.5
"""Yield deflection of a hysteretic damper [m]; steel ones have 1 to 20 mm."""

FIRMEST = 2e-5
"""Least deflection of a stop under the weight of the whole pier [m]: a steel block of a metre gives way by a tenth of a
millimetre."""

QUICKEST = 1e4
"""Rate [1/s] at which a damper on a brace relaxes, about that force which it has at SPEED: beyond it the brace might as well be
rigid, and takes steps without number."""

MOST_LAMBDA = 100.0
"""Greatest λ of a tendon, by which it adds the pier's weight at a hundredth of α; strands have 0.1 to 10."""


@checked
@dataclass(frozen=True)
class Damper:
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
        the deck, at ``Pier.deck``, and what stands beside it and goes with the ground; not of friction.
    brace : float
        λ = k b²/(M g R0) of the stiffness k of what the damper hangs on, in series with it; infinite if that is rigid. Of a
        viscous damper whose exponent is 1 at most, or a hysteretic one.
    confirm : sequence of str
        "nu", "yield_m" or "brace", if the value is right though unusual.

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
class Tendon:
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
        "lam", or "psi" of one that has neither prestress nor stiffness, if the value is right though unusual.

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
class Stop:
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
class DeckSpring:
    """A horizontal spring between the deck and what stands beside it and goes with the ground: an abutment, a neighbouring span.

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
        """Return a spring of the stiffness k [kN/m] with a gap [mm] beside the deck of ``pier``.

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
    names = {each.name for each in fields(kind)}
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
    known = fields_of(pier)
    return {known[name][0]: value / known[name][1] for name, value in values.items()}


def holds_a_tilt(restraints: tuple[Restraint, ...]) -> bool:
    """Return whether a damper among them may hold the pier at a tilt: it keeps a force at rest, as friction does."""
    return any(isinstance(device, Damper) and device.kind != "viscous" and device.f > 0 for device in restraints)


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


class Place(NamedTuple):
    """Where a device acts: at an offset from the centre of the base [m], or at a height on the deck [m].

    ``way`` is −1 or 1 of a spring that a deck meets on its left or right, 0 of a device that acts both ways.
    """

    offset: float = 0.0
    height: float = 0.0
    way: float = 0.0


def places(pier: Pier, restraint: Restraint) -> tuple[Place, ...]:
    """Return the places at which ``restraint`` acts, those on the left before those on the right."""
    if isinstance(restraint, DeckSpring):
        height = pier.deck if restraint.height_m is None else restraint.height_m
        if restraint.linear:
            return (Place(height=height),)
        return tuple(Place(0.0, height, way) for way in _WAYS.get(restraint.side, ()))
    if restraint.at == "deck":
        return (Place(height=pier.deck),)
    b = pier.half_width
    if restraint.at is None:
        return Place(-b), Place(b)
    if isinstance(restraint.at, str):
        return (Place(-b if restraint.at == "left" else b),)
    return (Place(float(restraint.at)),)


_WAYS: dict[str, tuple[float, ...]] = {"both": (-1.0, 1.0), "left": (-1.0,), "right": (1.0,)}


def offsets(pier: Pier, restraint: Restraint) -> tuple[float, ...]:
    """Return the places at the base at which ``restraint`` acts, from its centre [m]."""
    return tuple(place.offset for place in places(pier, restraint) if place.height == 0.0)


def prestress_over_weight(pier: Pier, restraints: tuple[Restraint, ...]) -> float:
    """Return ψ of all tendons together."""
    return sum(tendon.psi * len(offsets(pier, tendon)) for tendon in restraints if isinstance(tendon, Tendon))


def wrong_on_springs(pier: Pier, restraints: tuple[Restraint, ...]) -> list[str]:
    """Return what is impossible about dampers and tendons of a pier on springs: one sentence each; empty if nothing."""
    if symmetric(pier, tuple(device for device in restraints if isinstance(device, Tendon))):
        return []
    return [
        "tendon: on springs a tendon off the axis needs its like on the other side, or it leans the pier before any "
        "earthquake; write a second one with the opposite at, or leave at out"
    ]


def wrong_restraints(pier: Pier, restraints: tuple[Restraint, ...]) -> list[str]:
    """Return what is impossible about devices under ``pier``: one sentence each; empty if nothing."""
    wrong = []
    if restraints and pier.deck_over_columns is not None:
        wrong.append("columns: dampers, tendons and stops of a rocking frame are not solved; leave them or columns out")
    for each in restraints:
        wrong += wrong_device(pier, each)
    return wrong + ([] if wrong else _wrong_friction(pier, restraints))


def wrong_device(pier: Pier, device: Restraint) -> list[str]:
    """Return what is impossible about one device under ``pier``, a sentence each; empty if nothing is."""
    wrong = _wrong_place(pier, device)
    if isinstance(device, Damper) and device.kind not in DAMPERS:
        wrong.append(f'kind = "{device.kind}": must be ' + " or ".join(f'"{kind}"' for kind in get_args(DamperKind)))
    for field_ in DAMPERS.get(device.kind, ()) if isinstance(device, Damper) else FIELDS[device.what]:
        wrong += BOUNDS[field_].problems(field_.replace("lam", "lambda"), getattr(device, field_))
    if isinstance(device, Damper):
        wrong += _wrong_brace(device)
    if isinstance(device, Tendon) and not device.strength > device.psi:
        strength = f"its yield force over the weight, {device.strength:g}"
        wrong.append(f"{strength}, must be above its prestress, {device.psi:g}")
    return [f"{device.what}: {problem}" for problem in wrong]


def _wrong_brace(damper: Damper) -> list[str]:
    if damper.brace == math.inf:
        return []
    if damper.kind == "friction":
        return [
            f'brace = {damper.brace:g}: friction on a brace is a hysteretic damper; write kind = "hysteretic" with the '
            "deflection of the brace under the damper's force as yield_mm"
        ]
    if damper.kind == "viscous" and damper.exponent > 1.0:
        return [f"brace = {damper.brace:g}: with one the exponent must be 1 at most; leave the brace out"]
    return POSITIVE.problems("brace", damper.brace)


def _wrong_place(pier: Pier, device: Restraint) -> list[str]:
    if isinstance(device, DeckSpring):
        wrong = HEIGHT.problems("height_m", device.height_m)
        if device.side not in _WAYS:
            wrong.append(f'side = "{device.side}": must be ' + " or ".join(f'"{side}"' for side in _WAYS))
        return wrong
    at, on_deck = device.at, isinstance(device, Damper)
    if at == "deck" and isinstance(device, Damper) and device.kind == "friction":
        return [
            'at = "deck": friction at the deck is not solved; write kind = "hysteretic" with a small yield_mm, whose limit '
            "friction is"
        ]
    if isinstance(at, str) and at not in ("left", "right", *(("deck",) if on_deck else ())):
        return [
            f'at = "{at}": must be "left", "right"{", " + chr(34) + "deck" + chr(34) if on_deck else ""} or an offset in m'
        ]
    if isinstance(at, float | int) and not abs(at) <= 2.0 * pier.half_width:
        return [f"at = {at:g}: must be within the base's width either side, {2 * pier.half_width:.4g} m"]
    return []


def _wrong_friction(pier: Pier, restraints: tuple[Restraint, ...]) -> list[str]:
    rubbing = [damper for damper in restraints if isinstance(damper, Damper) and damper.kind == "friction"]
    if sum(len(offsets(pier, damper)) for damper in rubbing) <= 2:
        return []
    return [
        "damper: two places of friction at most can be solved, for example one damper at both pivots; join their forces, or "
        'write kind = "hysteretic" with a small yield_mm, whose limit friction is'
    ]


def recentres(pier: Pier, restraints: tuple[Restraint, ...]) -> bool:
    """Return whether weight and prestress overcome friction at small rotations, about either corner.

    That is 2 f < 1 + ψ with dampers at both. Dampers count alike with and without a yield deflection.
    """
    for corner in (-pier.half_width, pier.half_width):
        holds, rights = 0.0, 1.0
        for device in restraints:
            arms = sum(place.height or abs(place.offset - corner) for place in places(pier, device)) / pier.half_width
            holds += device.f * arms if isinstance(device, Damper) and device.kind != "viscous" else 0.0
            rights += device.psi * arms if isinstance(device, Tendon) else 0.0
        if holds >= rights:
            return False
    return True


def symmetric(pier: Pier, restraints: tuple[Restraint, ...]) -> bool:
    """Return whether each device has its like on the other side."""
    placed = [(place, _anywhere(device)) for device in restraints for place in places(pier, device)]
    return all(placed.count((_mirrored(place), device)) == placed.count((place, device)) for place, device in placed)


def _anywhere(device: Restraint) -> Restraint:
    """Return the device without its place."""
    return replace(device, side="both") if isinstance(device, DeckSpring) else replace(device, at=0.0)


def _mirrored(place: Place) -> Place:
    return Place(-place.offset, place.height, -place.way)


class Doubt(NamedTuple):
    """A value of the field ``name`` that is probably wrong, and what it would mean."""

    name: str
    meaning: str


def doubt(pier: Pier, device: Restraint) -> Doubt | None:
    """Return what is odd about a device of ``pier``; None if nothing is, or if it is confirmed."""
    if isinstance(device, Damper):
        odd = _of_damper(pier, device)
    else:
        odd = _of_tendon(pier, device) if isinstance(device, Tendon) else _of_contact(pier, device)
    return None if odd is None or odd.name in device.confirm else odd


def unlikely_devices(pier: Pier, devices: tuple[Restraint, ...]) -> list[str]:
    """Return what is odd about devices of ``pier``, a sentence each, except what they confirm."""
    doubts = [(device, doubt(pier, device)) for device in devices]
    return [
        f"{device.what}: {odd.name} = {getattr(device, odd.name):g}: {odd.meaning}; {remedy(odd.name)}"
        for device, odd in doubts
        if odd is not None
    ]


def _of_brace(pier: Pier, damper: Damper) -> Doubt | None:
    if damper.brace == math.inf:
        return None
    stiffness = damper.brace * pier.gravity * pier.size / pier.half_width**2
    deflection = pier.gravity / stiffness
    if deflection < FIRMEST:
        gives = f"the brace gives by {1000.0 * deflection:.2g} mm under the pier's weight"
        return Doubt("brace", f"{gives}; leave out one that is rigid")
    if damper.kind == "viscous" and damper.nu > 0.0:
        rate = stiffness / (damper.exponent * damper.nu * pier.p) * SPEED ** (1.0 - damper.exponent)
        if rate > QUICKEST:
            return Doubt(
                "brace", f"beside this damper it is rigid, it follows within {1000.0 / rate:.2g} ms; leave it out"
            )
    return None


def _of_damper(pier: Pier, damper: Damper) -> Doubt | None:
    if odd := _of_brace(pier, damper):
        return odd
    if damper.kind == "viscous":
        share = damper.nu * pier.p / pier.gravity  # of the weight, at 1 m/s
        if share * SPEED**damper.exponent > 1.0:
            speed = share ** (-1.0 / damper.exponent)
            return Doubt("nu", f"at {1000.0 * speed:.2g} mm/s one damper has the force of the pier's weight already")
    elif damper.kind == "hysteretic" and not THINNEST <= damper.yield_m <= WIDEST:
        return Doubt(
            "yield_m", f"the damper yields at {1000.0 * damper.yield_m:.2g} mm, where steel ones do at 1 to 20 mm"
        )
    return None


def _of_tendon(pier: Pier, tendon: Tendon) -> Doubt | None:
    if tendon.lam > MOST_LAMBDA:
        arm = pier.half_width  # a tendon on the axis: its force over the weight is λ R0 θ/b
        share = tendon.lam * pier.size * 0.01 * pier.alpha / arm
        return Doubt("lam", f"it adds {share:.3g} times the pier's weight at a rotation of 0.01 α already")
    if tendon.psi == 0.0 == tendon.lam:
        return Doubt(
            "psi", "with no prestress and no stiffness the tendon is not there; give one, or leave the tendon out"
        )
    return None


def _of_contact(pier: Pier, stop: Stop | DeckSpring) -> Doubt | None:
    name = "stop" if isinstance(stop, Stop) else "spring"
    if stop.lam == 0.0:
        return Doubt("lam", f"with no stiffness the {name} is not there; give one, or leave the {name} out")
    deflection = pier.half_width**2 / (stop.lam * pier.size)  # under the weight
    if deflection < FIRMEST:
        return Doubt("lam", f"it bears the pier's weight at a deflection of {1000.0 * deflection:.2g} mm")
    if 0.0 < stop.gap_m < 5e-4:
        return Doubt("gap_m", f"it is met after {1000.0 * stop.gap_m:.2g} mm already")
    if isinstance(stop, Stop):
        if stop.gap_m > 2.0 * pier.half_width:
            return Doubt("gap_m", f"it is met at a rise of {stop.gap_m:.3g} m, more than the pier is wide")
        return None
    height = pier.deck if stop.height_m is None else stop.height_m
    if height > HIGHEST * 2.0 * pier.height:
        return Doubt(
            "height_m", f"{0.5 * height / pier.height:.3g} times the height of the pier, {2 * pier.height:.3g} m"
        )
    if stop.gap_m > height * math.tan(pier.alpha):
        return Doubt(
            "gap_m", f"the deck is only there, {stop.gap_m:.3g} m away, when the pier leans by more than alpha"
        )
    return None
