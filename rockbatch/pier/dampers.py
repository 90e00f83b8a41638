"""Dampers between a pier and the ground, or at its deck (THEORY.md, Dampers and tendons)."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import ClassVar, Literal, Self, Unpack

from rockbatch.common.arguments import checked
from rockbatch.common.errors import Contradiction, Problem, WrongType
from rockbatch.common.showing import shown
from rockbatch.common.units import POSITIVE
from rockbatch.pier.block import Pier
from rockbatch.pier.devices import (
    DAMPERS,
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

DamperKind = Literal["friction", "viscous", "hysteretic"]

SPEED = 0.1
"""Speed [m/s] at which a viscous damper should have less than the pier's weight; heels of rocking piers reach 0.1 to 1 m/s."""

THINNEST, WIDEST = 2.5e-5, 0.5
"""Bounds of the usual yield deflection of a hysteretic damper [m]; dampers of steel have 1 to 20 mm."""

QUICKEST = 1e4
"""Relaxation rate [1/s] of a damper on a brace, linearised about its force at SPEED, above which the brace is as good as rigid
and needs too many steps."""


@checked
@dataclass(frozen=True)
class Damper(Device):
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
        λ = k b²/(M g R0) of the stiffness k of a brace in series with the damper; infinite if it is rigid. For viscous dampers
        with an exponent of at most 1, and hysteretic ones.
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
    def friction(cls, pier: Pier, force_kN: float, **rest: Unpack[Placing]) -> Self:
        """Return a friction damper of the force F_d [kN] under ``pier``; ``rest``: ``at`` and ``confirm``.

        Here and in the other constructors from kN, raises ``InputError`` if the mass of the pier is not known, or for
        values that are impossible, or unusual and not confirmed.
        """
        return cls("friction", **over_weight(pier, force_kN=force_kN), **rest)._usual_under(pier)

    @classmethod
    @checked
    def hysteretic(
        cls, pier: Pier, force_kN: float, yield_mm: float, *, brace_kN_m: float = math.inf, **rest: Unpack[Placing]
    ) -> Self:
        """Return a hysteretic damper of the yield force F_d [kN] and deflection u_y [mm]; otherwise as :meth:`friction`.

        ``brace_kN_m`` is the stiffness of a brace in series.
        """
        values = {"force_kN": force_kN, "yield_mm": yield_mm} | if_finite(brace_kN_m=brace_kN_m)
        return cls("hysteretic", **over_weight(pier, **values), **rest)._usual_under(pier)

    @classmethod
    @checked
    def viscous(
        cls,
        pier: Pier,
        coefficient_kN_s_m: float,
        exponent: float = 1.0,
        *,
        brace_kN_m: float = math.inf,
        **rest: Unpack[Placing],
    ) -> Self:
        """Return a viscous damper of C [kN (s/m)^a] and the exponent a, on a brace of the stiffness ``brace_kN_m``.

        Otherwise as :meth:`friction`.

        Examples
        --------
        >>> tall = rb.Pier.with_deck(width_m=8, height_m=30, mass_t=2000, deck_mass_t=1000)
        >>> rb.Damper.viscous(tall, coefficient_kN_s_m=1500.0, exponent=0.3)
        Damper(kind='viscous', f=0.0, nu=0.8057089065897499, yield_m=0.0, exponent=0.3, at=None, brace=inf)
        """
        values = {"coefficient_kN_s_m": coefficient_kN_s_m, "exponent": exponent} | if_finite(brace_kN_m=brace_kN_m)
        return cls("viscous", **over_weight(pier, **values), **rest)._usual_under(pier)

    @property
    def law(self) -> str:
        return self.kind

    @property
    def words(self) -> str:
        return f"{self.kind} damper"

    def _wrong(self) -> list[Problem]:
        wrong = _wrong_place(self)
        if self.kind not in DAMPERS:
            wrong.append(Problem("kind", self.kind, f"must be {' or '.join(map(shown, DAMPERS))}", kind=WrongType))
        return wrong + super()._wrong() + _unused_fields(self) + _wrong_brace(self)

    def doubts(self, pier: Pier) -> Iterator[Doubt]:
        if self.kind == "viscous":
            share = self.nu * pier.p / pier.gravity  # of the weight, at 1 m/s
            if share * SPEED**self.exponent > 1.0:
                speed = share ** (-1.0 / self.exponent)
                yield Doubt("nu", f"at {1000.0 * speed:.2g} mm/s one damper has the force of the pier's weight already")
            elif 0.0 < share < LEAST_FORCE:
                yield Doubt("nu", f"at 1 m/s it has {100.0 * share:.2g} % of the pier's weight, practically nothing")
        elif self.f > 1.0:
            yield Doubt("f", f"one damper has {self.f:.3g} times the pier's weight")
        elif 0.0 < self.f < LEAST_FORCE:
            yield Doubt("f", f"it has {100.0 * self.f:.2g} % of the pier's weight, practically nothing")
        if self.kind == "hysteretic" and not THINNEST <= self.yield_m <= WIDEST:
            yield Doubt(
                "yield_m", f"the damper yields at {1000.0 * self.yield_m:.2g} mm, where steel ones do at 1 to 20 mm"
            )
        yield from self._brace_doubts(pier)

    def _brace_doubts(self, pier: Pier) -> Iterator[Doubt]:
        """Yield the doubt about a brace that is too stiff, too soft, or of no effect; none about a rigid one."""
        if self.brace == math.inf:
            return
        stiffness = self.brace * pier.gravity * pier.size / pier.half_width**2
        deflection = pier.gravity / stiffness
        if deflection < FIRMEST[self.what]:
            message = f"the brace gives by {1000.0 * deflection:.2g} mm under the pier's weight"
            yield Doubt("brace", f"{message}; leave out one that is rigid")
        elif 2.0 * self.brace < SOFTEST[self.what]:
            share = f"{200.0 * self.brace:.2g} % of the pier's weight"
            yield Doubt("brace", f"it bears {share} at a rotation of α, so that the damper hardly moves")
        elif self.kind == "viscous" and self.nu > 0.0:
            rate = stiffness / (self.exponent * self.nu * pier.p) * SPEED ** (1.0 - self.exponent)
            if rate > QUICKEST:
                yield Doubt(
                    "brace", f"beside this damper it is rigid, it follows within {1000.0 / rate:.2g} ms; leave it out"
                )


def _wrong_place(damper: Damper) -> list[Problem]:
    if damper.at == "deck" and damper.kind == "friction":
        text = 'friction at the deck is not solved; write kind = "hysteretic" with a small yield_mm, whose limit friction is'
        return [Problem("at", "deck", text, kind=Contradiction)]
    return wrong_words(damper.at, "left", "right", "deck")


def _unused_fields(damper: Damper) -> list[Problem]:
    """Return a problem for each given field that only other kinds of damper use."""
    own = DAMPERS.get(damper.kind, ())
    others = {name for names in DAMPERS.values() for name in names if own and name not in own}
    given = {name: value for name in sorted(others) if (value := getattr(damper, name)) != getattr(Damper, name)}
    text = f"is not of a {damper.kind} damper; leave it out"
    return [Problem(name, value, text, kind=Contradiction) for name, value in given.items()]


def _wrong_brace(damper: Damper) -> list[Problem]:
    if damper.brace == math.inf:
        return []
    text = ""
    if damper.kind == "friction":
        text = (
            'friction on a brace is a hysteretic damper; write kind = "hysteretic" with the deflection of the brace under '
            "the damper's force as yield_mm"
        )
    elif damper.kind == "viscous" and damper.exponent > 1.0:
        text = "with one the exponent must be 1 at most; leave the brace out"
    if text:
        return [Problem("brace", damper.brace, text, kind=Contradiction)]
    return POSITIVE.problems("brace", damper.brace)
