"""The statics sheet of a pier on a base: static strength and rocking periods (THEORY.md, Statics)."""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from rockbatch.common.lazy import pd
from rockbatch.common.showing import Shown
from rockbatch.pier.bases import Base
from rockbatch.pier.bending import flexural_period
from rockbatch.pier.block import Pier
from rockbatch.pier.equilibrium import ONSET, Array, Equilibria, SlowTurn, without_dampers
from rockbatch.pier.footings import facts_of_bed, slow_turn
from rockbatch.pier.free_rocking import FreeRocking, Swings
from rockbatch.pier.frequencies import vertical_frequency
from rockbatch.pier.places import symmetric

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

AMPLITUDES = (0.02, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9)
"""Amplitudes of free rocking, over α."""

COMPARED = 0.1
"""Amplitude over α at which the flexural period is compared with that of rocking."""

MOST_FLEXURE = 1.0 / 3.0
"""Flexural over rocking period above which a pier is not rigid: bending is then a ninth of the displacement or more."""


class Fact(NamedTuple):
    """A number of the sheet: its name, which ends in its unit, its heading, its format and its meaning."""

    name: str
    heading: str
    form: str
    meaning: str

    def written(self, value: float | None) -> str:
        """Return a value as the sheet shows it; "" for None."""
        return "" if value is None else format(value, self.form)


FACTS = (
    Fact("weight_kN", "weight [kN]", ",.0f", "of all that rocks"),
    Fact("settlement_m", "settlement at rest [m]", ".3g", "of both supports, under weight and prestress"),
    Fact("safety_factor", "bearing strength over weight", ".3g", "of a footing: its FS, under pier and deck"),
    Fact(
        "rocking_stiffness_MN_m",
        "rocking stiffness of the ground [MN m/rad]",
        ",.0f",
        "of a footing in full contact, elastic",
    ),
    Fact(
        "vertical_over_formula",
        "vertical stiffness over the formula's",
        ".2f",
        "of a footing from soil: its bed keeps the rocking stiffness, and so is too stiff vertically",
    ),
    Fact(
        "ultimate_moment_kN_m",
        "ultimate moment of the ground [kN m]",
        ",.0f",
        "about the middle of a footing: W B/2 (1 − 1/FS)",
    ),
    Fact("stress_at_rest_MPa", "bearing stress at rest [MPa]", ".3g", "under each support, with the prestress"),
    Fact(
        "stress_on_one_MPa",
        "bearing stress on one support [MPa]",
        ".3g",
        "when the other lifts off; impacts come on top",
    ),
    Fact("lift_off_g", "lift-off [g]", ".4f", "steady ground acceleration that lifts the first pivot"),
    Fact("lift_off_over_alpha", "lift-off, θ/α", ".3g", "rotation at which it lifts off"),
    Fact("strength_g", "static strength [g]", ".4f", "greatest steady ground acceleration without overturning"),
    Fact("strength_over_alpha", "static strength, θ/α", ".3g", "rotation at which it is reached"),
    Fact("moment_over_weight_m", "greatest moment over weight [m]", ".4g", "about the more heavily loaded pivot"),
    Fact("moment_kN_m", "greatest moment [kN m]", ",.0f", "the same with the weight"),
    Fact("dampers_over_rest", "damper/restoring moment, 0.1 α", ".2f", "ratio of moments; below 1 the pier returns"),
    Fact("unstable_over_alpha", "unstable equilibrium, θ/α", ".4g", "without dampers"),
    Fact("vertical_period_s", "vertical period [s]", ".3g", "of both supports, elastic"),
    Fact("full_contact_period_s", "rocking period in full contact [s]", ".3g", "before lift-off, elastic"),
    Fact("period_s", "rocking period at 0.1 α [s]", ".3g", "of free rocking with that amplitude; it grows with it"),
    Fact("restitution", "restitution e", ".4f", "factor on the angular velocity at an impact on rigid ground"),
    Fact("impact_damping", "damping by impacts at 0.1 α", ".2%", "equivalent viscous ratio; rigid ground only"),
    Fact("flexural_over_rocking", "flexural over rocking period", ".2f", "fixed at its base, over that at 0.1 α"),
)
"""Numbers of the sheet, in the order in which it is read."""


@dataclass(frozen=True, repr=False, eq=False)
class Statics(Shown):
    """Static strength and rocking periods of a pier on its base: quasi-static, or by the energy of free rocking.

    If devices differ from side to side, the weaker direction counts, ``towards``. Accelerations are steady and horizontal; forces
    are over the weight, and moments about the more heavily loaded pivot. Viscous dampers carry no static force.

    Attributes
    ----------
    pier, base
        The arguments of :func:`statics`.
    towards : "right", "left" or "either"
        Direction in which the pier turns; "either" if both are alike.
    lift_off_g, lift_off_rad : float or None
        Acceleration [g] and rotation [rad] at which the first pivot lifts off; None if the other support yields before.
    strength_g, strength_rad : float or None
        The greatest acceleration that does not overturn the pier [g], its static lateral strength, and the rotation there [rad].
        An earthquake may exceed it many times over for moments: it tips the pier and does not overturn it. None if tendons
        that never yield, or stops, let it rise without end.
    moment_over_weight_m : float or None
        The greatest righting moment, devices included, over the weight [m]; None likewise.
    dampers_over_rest : float or None
        Moment of friction and hysteretic dampers at θ/α = 0.1 over that of weight, supports, tendons and stops: below 1 these
        bring the pier back, from 1 on dampers can hold it there. None without such dampers.
    unstable_rad : float or None
        Unstable equilibrium of weight, supports, tendons and stops, without dampers [rad]; None if they hold the pier.
    settlement_m : float or None
        Of both supports at rest [m]; None on rigid ground.
    vertical_period_s, full_contact_period_s : float or None
        Periods of small vertical vibration and of small rocking on both supports, elastic ones [s]; None on rigid ground. Tendons
        and springs at the deck have a part in the latter.
    stress_at_rest_MPa, stress_on_one_MPa : float or None
        Bearing stress at rest, and of the support that carries everything at lift-off; None without ``area_m2`` and a mass.
    equilibria : Equilibria
        The pier rotated slowly up to overturning: :attr:`curve` as arrays.
    swings_at : Swings
        Free rocking over its amplitude: :attr:`swings` as arrays.

    Examples
    --------
    >>> tall = rb.Pier.with_deck(width_m=8, height_m=30, mass_t=2000, deck_mass_t=1000)
    >>> pads = rb.ElasticBase.from_stiffness(tall, stiffness_kN_m=2e6, zeta=0.05)
    >>> sheet = rb.statics(tall, pads)
    >>> f"{sheet.lift_off_g:.3f} g at {sheet.lift_off_rad:.5f} rad, {sheet.vertical_period_s:.3f} s"
    '0.198 g at 0.00184 rad, 0.172 s'
    """

    pier: Pier
    base: Base
    towards: str
    lift_off_g: float | None
    lift_off_rad: float | None
    strength_g: float | None
    strength_rad: float | None
    moment_over_weight_m: float | None
    unstable_rad: float | None
    settlement_m: float | None
    vertical_period_s: float | None
    full_contact_period_s: float | None
    stress_at_rest_MPa: float | None  # noqa: N815 (units as in the columns of a table)
    stress_on_one_MPa: float | None  # noqa: N815
    equilibria: Equilibria
    swings_at: Swings

    @property
    def weight_kN(self) -> float | None:  # noqa: N802
        """Return the weight [kN]; None if the mass is not known."""
        return None if self.pier.mass_t is None else self.pier.mass_t * self.pier.gravity

    @property
    def restitution(self) -> float | None:
        """Return the factor e on the angular velocity at an impact on rigid ground; None on springs."""
        if self.base.on_springs:
            return None
        return self.pier.restitution if self.base.restitution is None else self.base.restitution

    @property
    def dampers_over_rest(self) -> float | None:
        """Return the moment of dampers over all others at θ/α = 0.1; None without a damper force, or if dampers have it all."""
        curve, theta = self.equilibria, COMPARED * self.pier.alpha
        moment = float(np.interp(theta, curve.theta, curve.moment))
        of_dampers = float(np.interp(theta, curve.theta, curve.dampers))
        return of_dampers / (moment - of_dampers) if 0.0 < of_dampers < moment else None

    @property
    def flexural_over_rocking(self) -> float | None:
        """Return the flexural period over that of rocking at θ/α = 0.1; None if one of the two is not known."""
        period = self._at_amplitude(self.swings_at.period)
        own = flexural_period(self.pier)
        return None if period is None or own is None else own / period

    @property
    def row(self) -> dict[str, float | None]:
        """Return the numbers of the sheet by the names of :data:`FACTS`; None where one does not apply."""
        alpha, weight = self.pier.alpha, self.weight_kN
        mine: dict[str, float | None] = {fact.name: getattr(self, fact.name, None) for fact in FACTS}
        for name in ("lift_off", "strength", "unstable"):
            rotation = getattr(self, f"{name}_rad")
            mine[f"{name}_over_alpha"] = None if rotation is None else rotation / alpha
        moment = self.moment_over_weight_m
        mine["moment_kN_m"] = None if weight is None or moment is None else moment * weight
        mine["period_s"] = self._at_amplitude(self.swings_at.period)
        mine["impact_damping"] = self._at_amplitude(self.swings_at.impact_damping)
        return mine | facts_of_bed(self.pier, self.base)

    @property
    def contact_share(self) -> Array | None:
        """Return the share of a footing that is pressed at the rotations of :attr:`equilibria`; None on other bases."""
        return self.equilibria.heel if self.base.on_springs and not self.base.two_springs else None

    @property
    def curve(self) -> "pd.DataFrame":
        """Return the moment–rotation curve as a table, a row for each rotation up to overturning.

        ``theta_rad``, ``theta_over_alpha``; ``acceleration_g`` that holds the pier there; ``moment_over_weight_m``, and in it
        the shares of weight with supports, of tendons, of stops with deck springs, and of dampers; ``toe_over_weight`` and
        ``heel_over_weight``, the forces of the two supports, or of a footing ``edge_pressure_over_rest`` and ``contact_share``;
        ``moment_kN_m`` if the mass is known.
        """
        equilibria = self.equilibria
        columns = {
            "theta_rad": equilibria.theta,
            "theta_over_alpha": equilibria.theta / self.pier.alpha,
            "acceleration_g": equilibria.acceleration,
            "moment_over_weight_m": equilibria.moment,
            "of_weight_m": equilibria.weight,
            "of_tendons_m": equilibria.tendons,
            "of_stops_m": equilibria.stops,
            "of_dampers_m": equilibria.dampers,
        }
        of_supports = ("toe_over_weight", "heel_over_weight")
        if self.contact_share is not None:
            of_supports = ("edge_pressure_over_rest", "contact_share")
        columns |= zip(of_supports, (equilibria.toe, equilibria.heel), strict=True)
        if self.weight_kN is not None:
            columns["moment_kN_m"] = equilibria.moment * self.weight_kN
        return pd.DataFrame({name: np.round(values, 9) for name, values in columns.items()})

    @property
    def swings(self) -> "pd.DataFrame":
        """Return free rocking over its amplitude as a table.

        ``amplitude_rad``, ``amplitude_over_alpha``; ``period_s``, undamped, NaN if tendons, stops or deck springs on one side
        make the swings uneven; ``impact_damping``, the viscous damping ratio of the same decay as by impacts, NaN on springs and
        footings, where it has no closed form: landings lose energy by ε, ζ and vertical vibration.
        """
        swings = self.swings_at
        columns = {"amplitude_rad": swings.amplitude, "amplitude_over_alpha": swings.amplitude / self.pier.alpha}
        return pd.DataFrame(columns | {"period_s": swings.period, "impact_damping": swings.impact_damping})

    def plot(self, width_mm: float = 160.0, ax: "Axes | None" = None) -> "Figure":
        """Return a matplotlib figure of moment and steady acceleration over the rotation, and of the periods, ``width_mm`` wide
        or in the place of ``ax``."""
        from rockbatch.common.figures.paper import drawn
        from rockbatch.pier.figures import Sheet, statics

        return drawn(statics([Sheet("", self.pier, self.equilibria, self.swings_at, self.contact_share)]), width_mm, ax)

    def _at_amplitude(self, values: Array) -> float | None:
        """Return the value at the amplitude :data:`COMPARED`; None if it is NaN, or the pier overturns before."""
        place = AMPLITUDES.index(COMPARED)
        return float(values[place]) if len(values) > place and not math.isnan(values[place]) else None

    def _facts(self) -> tuple[str, dict[str, str]]:
        """Return the heading "statics of a pier, base rigid" and the lines of :func:`in_words`, for :class:`Shown`."""
        return f"statics of a pier, base {self.base.name}", in_words(self)


def in_words(sheet: Statics) -> dict[str, str]:
    """Return the sheet as lines of text by their headings: "lift-off", "strength", …; "" for those that do not apply."""
    alpha, weight, swings = sheet.pier.alpha, sheet.weight_kN, sheet.swings_at

    def acceleration(value: float | None, rotation: float | None, otherwise: str) -> str:
        if value is None or rotation is None:
            return otherwise
        return f"{value:.4g} g, at θ/α = {rotation / alpha:.3g}"

    at_rest = [f"weighs {weight:,.0f} kN" if weight else ""]
    at_rest += [f"settles {1000.0 * sheet.settlement_m:.3g} mm" if sheet.settlement_m else ""]
    if sheet.stress_at_rest_MPa is not None:
        at_rest.append(
            f"{sheet.stress_at_rest_MPa:.3g} MPa on each support, {sheet.stress_on_one_MPa:.3g} MPa on one alone"
        )
    moment = "" if sheet.moment_over_weight_m is None else f"{sheet.moment_over_weight_m:.4g} m × weight"
    if weight and sheet.moment_over_weight_m is not None:
        moment += f" = {sheet.moment_over_weight_m * weight:,.0f} kN m"
    small = {"vertical": sheet.vertical_period_s, "rocking in full contact": sheet.full_contact_period_s}
    periods = [f"{name} {period:.3g} s" for name, period in small.items() if period is not None]
    shown = [i for i, share in enumerate(swings.amplitude / alpha) if np.isclose(share, (0.1, 0.5, 0.9)).any()]
    shares = [f"{swings.amplitude[i] / alpha:.1f} α" for i in shown]
    periods += [f"{share} {t:.3g} s" for share, t in zip(shares, swings.period[shown], strict=True) if t > 0.0]
    damping = [f"{share} {z:.2%}" for share, z in zip(shares, swings.impact_damping[shown], strict=True) if z >= 0.0]
    if np.isinf(swings.impact_damping).any():
        damping = ["without end: the pier stops at the first one"]
    balance = "none: tendons or stops hold the pier at any rotation"
    return {
        "at rest": ", ".join(filter(None, at_rest)),
        "lift-off": acceleration(
            sheet.lift_off_g, sheet.lift_off_rad, "never: the more heavily loaded support yields before"
        ),
        "strength": acceleration(
            sheet.strength_g, sheet.strength_rad, "rises with the rotation, as tendons or stops hold the pier"
        ),
        "moment": moment,
        "balance": balance if sheet.unstable_rad is None else f"θ/α = {sheet.unstable_rad / alpha:.4g}",
        "direction": "" if sheet.towards == "either" else f"to the {sheet.towards}, the weaker one",
        "periods": ", ".join(periods),
        "impacts": f"as viscous damping {', '.join(damping)}" if damping else "",
        "flexure": flexure(sheet),
    }


def is_too_soft(sheet: Statics) -> bool:
    """Return True if the flexural period is over a third of that of rocking at 0.1 α; False if unknown, or if the shaft bends."""
    return (sheet.flexural_over_rocking or 0.0) > MOST_FLEXURE and not sheet.base.bends


def flexure(sheet: Statics) -> str:
    """Return a sentence that compares the flexural period with that of rocking; "" if it is not known."""
    ratio = sheet.flexural_over_rocking
    if ratio is None:
        return ""
    words = f"fixed at its base the pier has {ratio:.2f} of the period of rocking at {COMPARED:g} α"
    return (
        f"{words}: {'not rigid, ' if ratio > MOST_FLEXURE else ''}bending adds some {ratio**2:.0%} to the drift there"
    )


def sheet_of(pier: Pier, foundation: Base) -> Statics:
    """Return the statics sheet of a pier on a foundation; whether the pier can stand on it is not checked."""
    even = symmetric(pier, foundation.restraints)
    sides = [_Side.of(pier, foundation, side) for side in ((1.0,) if even else (1.0, -1.0))]
    weaker, first = min(sides, key=lambda side: side.strength[0]), min(sides, key=lambda side: side.lift_off[0])
    balance = min(side.unstable for side in sides)
    springs = foundation if foundation.on_springs else None
    stress = math.nan
    if foundation.area_m2 is not None and pier.mass_t is not None:
        stress = pier.mass_t * pier.gravity / foundation.area_m2 / 1000.0
    amplitudes = pier.alpha * np.array(AMPLITUDES)
    amplitudes = amplitudes[amplitudes < 0.999 * balance]
    free = FreeRocking(pier, foundation)
    shown = np.array([*amplitudes, *(side.lift_off[1] for side in sides)])
    return Statics(
        pier,
        foundation,
        "either" if even else "right" if weaker is sides[0] else "left",
        lift_off_g=_finite(first.lift_off[0]),
        lift_off_rad=_finite(first.lift_off[1]),
        strength_g=_finite(weaker.strength[0]),
        strength_rad=_finite(weaker.strength[1]),
        moment_over_weight_m=_finite(weaker.moment),
        unstable_rad=_finite(balance),
        settlement_m=None if springs is None else weaker.turn.settled,
        vertical_period_s=None if springs is None else 2.0 * math.pi / vertical_frequency(pier, springs),
        full_contact_period_s=free.in_full_contact,
        stress_at_rest_MPa=_finite(stress * weaker.turn.at_rest),
        stress_on_one_MPa=_finite(stress * weaker.borne_alone),
        equilibria=weaker.turn.with_rotations(weaker.curve, shown),
        swings_at=free.swings(amplitudes),
    )


def _finite(value: float) -> float | None:
    """Return ``value``; None if it is infinite or NaN."""
    return value if math.isfinite(value) else None


class _Side(NamedTuple):
    """A pier turned slowly to one side; rotations and strengths that are never reached are inf."""

    turn: SlowTurn
    curve: Equilibria
    unstable: float
    lift_off: tuple[float, float]  # acceleration [g] and rotation [rad]
    strength: tuple[float, float]
    moment: float
    borne_alone: float  # force of the toe over the weight at lift-off; the greatest along the curve without lift-off

    @classmethod
    def of(cls, pier: Pier, base: Base, side: float) -> "_Side":
        turn = slow_turn(pier, base, side=side)
        unstable = slow_turn(pier, base, without_dampers(base.restraints), side).unstable
        curve = turn.curve(min(2.0 * pier.alpha, 0.5 * math.pi) if unstable is None else unstable)
        kinks = turn.kinks(curve)
        curve = turn.with_rotations(curve, kinks)
        lift_off, alone = (math.inf, math.inf), float(curve.toe.max())
        if turn.lift_off is not None:
            at_lift_off = turn.at(np.array([max(turn.lift_off, ONSET)]))
            lift_off, alone = (float(at_lift_off.acceleration[0]), turn.lift_off), float(at_lift_off.toe[0])
        strength, moment = (turn.strongest(quantity, curve, kinks) for quantity in ("acceleration", "moment"))
        curve = turn.with_rotations(curve, np.array([strength[1], moment[1]]))
        if unstable is None:  # a quantity that still rises at the end of the curve has no greatest value
            unbounded = (math.inf, math.inf)
            strength, moment = (unbounded if best[1] == curve.theta[-1] else best for best in (strength, moment))
        return cls(turn, curve, math.inf if unstable is None else unstable, lift_off, strength, moment[0], alone)
