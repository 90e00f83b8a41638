"""Devices between a pier and the ground (THEORY.md, Dampers and tendons, Stops and deck springs)."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field, fields
from typing import Any, ClassVar, Literal, Self, TypedDict, Unpack, get_args

from rockbatch.common.arguments import checked
from rockbatch.common.errors import OutOfRange, Problem, WrongType
from rockbatch.common.showing import shown
from rockbatch.pier.block import Pier
from rockbatch.pier.dampers import Damper
from rockbatch.pier.devices import (
    FIRMEST,
    LEAST_FORCE,
    SOFTEST,
    Device,
    Doubt,
    Placing,
    if_finite,
    over_weight,
    wrong_words,
)
from rockbatch.pier.sizes import BOUNDS as OF_PIER
from rockbatch.pier.sizes import HIGHEST, LOWEST

Side = Literal["both", "left", "right"]
"""Direction in which the deck moves when it meets a spring."""

HEIGHT = OF_PIER["deck_height_m"]
"""Heights at which a spring may act on the deck [m]."""

YIELDING_TENDON = "yielding tendon"

MOST_STRENGTH = 10.0
"""Greatest yield force of a tendon over the weight."""

MOST_LAMBDA = 100.0
"""Greatest λ of a tendon, by which it adds the pier's weight at a hundredth of α; strands have 0.03 to 10."""


class OnBase(TypedDict, total=False):
    """Further keywords of :meth:`Tendon.of`."""

    at: float | str
    confirm: Sequence[str]


class OnDeck(TypedDict, total=False):
    """Further keywords of :meth:`DeckSpring.of`."""

    side: Side
    height_m: float | None
    confirm: Sequence[str]


@checked
@dataclass(frozen=True)
class Tendon(Device):
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
        cls,
        pier: Pier,
        prestress_kN: float = 0.0,
        stiffness_kN_m: float = 0.0,
        yield_kN: float = math.inf,
        **rest: Unpack[OnBase],
    ) -> Self:
        """Return a tendon of the prestress P0 [kN], the stiffness k_t [kN/m] and the yield force T_y [kN] under ``pier``.

        ``rest``: ``at`` and ``confirm``. Raises ``InputError`` as :meth:`Damper.friction`.
        """
        values = {"prestress_kN": prestress_kN, "stiffness_kN_m": stiffness_kN_m} | if_finite(yield_kN=yield_kN)
        return cls(**over_weight(pier, **values), **rest)._usual_under(pier)

    @property
    def kinds(self) -> tuple[str, ...]:
        return (self.what, YIELDING_TENDON) if self.strength < math.inf else (self.what,)

    def _wrong(self) -> list[Problem]:
        wrong = wrong_words(self.at, "left", "right") + super()._wrong()
        if self.strength <= self.psi:
            text = f"its yield force over the weight must be above its prestress, {self.psi:g}"
            wrong.append(Problem("strength", self.strength, text, kind=OutOfRange))
        return wrong

    def doubts(self, pier: Pier) -> Iterator[Doubt]:
        for name, force, words in (("psi", self.psi, "its prestress is"), ("strength", self.strength, "it yields at")):
            if 0.0 < force < LEAST_FORCE:
                yield Doubt(name, f"{words} {100.0 * force:.2g} % of the pier's weight, practically nothing")
        if MOST_STRENGTH < self.strength < math.inf:
            yield Doubt("strength", f"it yields at {self.strength:.3g} times the pier's weight")
        if self.lam > MOST_LAMBDA:
            arm = pier.half_width  # a tendon on the axis: its force over the weight is λ R0 θ/b
            share = self.lam * pier.size * 0.01 * pier.alpha / arm
            yield Doubt("lam", f"it adds {share:.3g} times the pier's weight at a rotation of 0.01 α already")
        elif 0.0 < self.lam < SOFTEST[self.what]:
            yield Doubt(
                "lam", f"it adds {100.0 * self.lam:.2g} % of the pier's weight at a rotation of α, practically nothing"
            )
        if self.psi == 0.0 == self.lam:
            yield Doubt(
                "psi", "with no prestress and no stiffness the tendon is not there; give one, or leave the tendon out"
            )


@checked
@dataclass(frozen=True)
class Stop(Device):
    """A stop that limits the uplift of the base: a spring that engages when its place has risen by a gap.

    In first compression F = k δ; unloading, and reloading up to the greatest δ of the blow, follow a line of the slope k/e².
    So the stop returns e² of the energy, and a mass that hits nothing else rebounds at e times its speed. Before the next blow
    the stop has recovered its shape.

    Attributes
    ----------
    gap_m : float
        Rise of its place at which the stop engages [m].
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
    def of(
        cls, pier: Pier, gap_mm: float, stiffness_kN_m: float, restitution: float = 1.0, **rest: Unpack[Placing]
    ) -> Self:
        """Return a stop with a gap [mm] and the stiffness k [kN/m] under ``pier``; ``rest``: ``at`` and ``confirm``.

        Raises ``InputError`` as :meth:`Damper.friction`.
        """
        values = {"gap_mm": gap_mm, "stiffness_kN_m": stiffness_kN_m, "restitution": restitution}
        return cls(**over_weight(pier, **values), **rest)._usual_under(pier)

    def _wrong(self) -> list[Problem]:
        return wrong_words(self.at, "left", "right") + super()._wrong()

    def doubts(self, pier: Pier) -> Iterator[Doubt]:
        """Yield doubts about a gap below 0.5 mm or wider than the pier, and about a stiffness that is odd under ``pier``."""
        yield from _gap_doubts(self)
        if self.gap_m > 2.0 * pier.half_width:
            yield Doubt("gap_m", f"it is met at a rise of {self.gap_m:.3g} m, more than the pier is wide")
        yield from _stiffness_doubts(pier, self, 2.0 * pier.half_width)


@checked
@dataclass(frozen=True)
class DeckSpring(Device):
    """A horizontal spring between the deck and a structure that moves with the ground: an abutment, a neighbouring span.

    With a gap, on one side only, or with a restitution below 1 it follows the law of a :class:`Stop`; otherwise it is linear.

    Attributes
    ----------
    lam : float
        λ = k b²/(M g R0), its stiffness.
    gap_m : float
        Travel of the deck at which the spring engages [m].
    restitution : float
        e, 0.1 to 1; 1 takes no energy.
    side : "both", "left" or "right"
        Direction in which the deck moves when it meets the spring; both: one spring on each side.
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
    def of(
        cls, pier: Pier, stiffness_kN_m: float, gap_mm: float = 0.0, restitution: float = 1.0, **rest: Unpack[OnDeck]
    ) -> Self:
        """Return a spring of the stiffness k [kN/m] with a gap [mm] at the deck of ``pier``.

        ``rest``: ``side``, ``height_m`` and ``confirm``. Raises ``InputError`` as :meth:`Damper.friction`.
        """
        values = {"stiffness_kN_m": stiffness_kN_m, "gap_mm": gap_mm, "restitution": restitution}
        return cls(**over_weight(pier, **values), **rest)._usual_under(pier)

    @property
    def linear(self) -> bool:
        """True if the spring acts in tension and compression alike, without gap and loss."""
        return self.side == "both" and self.gap_m == 0.0 and self.restitution == 1.0

    def _wrong(self) -> list[Problem]:
        wrong = HEIGHT.problems("height_m", self.height_m)
        if self.side not in get_args(Side):
            wrong.append(
                Problem("side", self.side, f"must be {' or '.join(map(shown, get_args(Side)))}", kind=WrongType)
            )
        return wrong + super()._wrong()

    def doubts(self, pier: Pier) -> Iterator[Doubt]:
        """Yield doubts about a height far from the pier's, a gap below 0.5 mm or met beyond α, and an odd stiffness."""
        height = pier.deck if self.height_m is None else self.height_m
        yield from _gap_doubts(self)
        if not LOWEST * 2.0 * pier.height <= height <= HIGHEST * 2.0 * pier.height:
            yield Doubt(
                "height_m", f"{0.5 * height / pier.height:.3g} times the height of the pier, {2 * pier.height:.3g} m"
            )
        elif self.gap_m > height * math.tan(pier.alpha):
            yield Doubt(
                "gap_m", f"the deck is only there, {self.gap_m:.3g} m away, when the pier leans by more than alpha"
            )
        yield from _stiffness_doubts(pier, self, height)


def _gap_doubts(device: Stop | DeckSpring) -> Iterator[Doubt]:
    """Yield the doubt about a gap above 0 and below 0.5 mm."""
    if 0.0 < device.gap_m < 5e-4:
        yield Doubt("gap_m", f"it is met after {1000.0 * device.gap_m:.2g} mm already")


def _stiffness_doubts(pier: Pier, device: Stop | DeckSpring, travel: float) -> Iterator[Doubt]:
    """Yield doubts about the stiffness of a device that deflects by ``travel`` [m] per radian of rotation."""
    name = "stop" if isinstance(device, Stop) else "spring"
    if device.lam == 0.0:
        yield Doubt("lam", f"with no stiffness the {name} is not there; give one, or leave the {name} out")
        return
    stiffness = device.lam * pier.size / pier.half_width**2  # over the weight [1/m]
    if 1.0 / stiffness < FIRMEST[device.what]:
        yield Doubt("lam", f"it bears the pier's weight at a deflection of {1000.0 / stiffness:.2g} mm")
    if (share := stiffness * travel * pier.alpha) < SOFTEST[device.what]:
        yield Doubt(
            "lam", f"it bears {100.0 * share:.2g} % of the pier's weight at a rotation of α, practically nothing"
        )


Restraint = Damper | Tendon | Stop | DeckSpring

KINDS: dict[str, type[Restraint]] = {kind.what: kind for kind in (Damper, Tendon, Stop, DeckSpring)}
"""Devices by the names of their tables in a study."""

DEVICE = "device"
"""Key of run.json and histories with the kind of a device, a key of :data:`KINDS`."""


def kinds_of(values: Mapping[str, Any]) -> tuple[str, ...]:
    """Return :attr:`Device.kinds` of a device by its fields in run.json; a tendon that yields has "yielding tendon", too."""
    yields = values.get("strength") is not None and values["strength"] < math.inf
    return (values[DEVICE], YIELDING_TENDON) if yields else (values[DEVICE],)


def restraint_of(values: Mapping[str, Any]) -> Restraint:
    """Return the device with the fields of run.json or a history; other names are left out, None stands for the default."""
    kind = KINDS[values[DEVICE]]
    names = {attribute.name for attribute in fields(kind)}
    return kind(**{name: value for name, value in values.items() if name in names and value is not None})


def described_restraints(restraints: tuple[Restraint, ...]) -> dict[str, object]:
    """Return the key ``restraints`` of run.json with the fields of each device; empty without devices."""
    return {"restraints": [_fields_given(device) for device in restraints]} if restraints else {}


def _fields_given(device: Restraint) -> dict[str, object]:
    """Return kind and fields of a device that are not None, but for ``confirm``; None for infinite ones, which JSON lacks."""
    given = {name: value for name, value in asdict(device).items() if value is not None and name != "confirm"}
    return {DEVICE: device.what} | {name: None if value == math.inf else value for name, value in given.items()}
