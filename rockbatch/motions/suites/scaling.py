"""Records scaled to a target: a PGA, a PGV, a spectral acceleration, or a whole spectrum."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from rockbatch.common.errors import InputError
from rockbatch.common.grouping import grouped
from rockbatch.common.naming import fits_any
from rockbatch.common.units import GRAVITY
from rockbatch.motions.intensity import measures
from rockbatch.motions.intensity.pairs import RULE_NAMES, TWO_COMPONENT_RULES, pairing_obstacle, station_spectra
from rockbatch.motions.motion import Motion, Samples
from rockbatch.motions.motion_set import MotionSet
from rockbatch.motions.spectrum import spectral_acceleration
from rockbatch.motions.suites.spectrum_target import SpectrumTarget
from rockbatch.motions.unused import Unusable


@dataclass(frozen=True)
class Target:
    """Target that the horizontal component of every record is scaled to; the vertical one goes with it.

    Attributes
    ----------
    pga_g, pgv_m_s, sa_g : float or None
        Exactly one of them: PGA [g], PGV [m/s], or pseudo-spectral acceleration [g] ...
    period_s, damping : float
        ... of an oscillator of this period [s], required with ``sa_g``, and this fraction of critical damping.
    pairs : str
        With ``sa_g``: "apart", every component is scaled to it by its own factor, or "geomean", "rotd50", "rotd100", this
        measure of a station is, by one factor of both components.
    """

    pga_g: float | None = None
    pgv_m_s: float | None = None
    sa_g: float | None = None
    period_s: float | None = None
    damping: float = 0.05
    pairs: str = "apart"

    def __post_init__(self) -> None:
        targets = [value for value in (self.pga_g, self.pgv_m_s, self.sa_g) if value is not None]
        if len(targets) != 1 or not targets[0] > 0 or (self.sa_g is None) != (self.period_s is None):
            raise InputError("a target is one of pga_g, pgv_m_s, or sa_g with period_s, above 0")
        if self.pairs != "apart" and (self.sa_g is None or self.pairs not in TWO_COMPONENT_RULES):
            raise InputError(
                f'pairs = "{self.pairs}": must be one of {", ".join(("apart", *TWO_COMPONENT_RULES))}, and is for sa_g'
            )

    def __str__(self) -> str:
        if self.sa_g is not None:
            measure = "" if self.pairs == "apart" else f" of {RULE_NAMES[self.pairs]}"
            return f"SA({self.period_s:g} s, {100 * self.damping:g} %){measure} = {self.sa_g:g} g"
        return f"PGA = {self.pga_g:g} g" if self.pga_g is not None else f"PGV = {self.pgv_m_s:g} m/s"

    def factors_of(self, motions: Sequence[Motion], gravity: float) -> list[float]:
        """Return the factor that scales each of ``motions`` to the target; infinite for motions at rest.

        Raises ``InputError`` if the rule takes pairs, and a station has none
        (:func:`rockbatch.motions.intensity.pairs.pairing_obstacle`).
        """
        if self.pairs == "apart":
            return [self._factor(motion, gravity) for motion in motions]
        assert self.sa_g is not None
        assert self.period_s is not None
        factors = {}
        for name, station in grouped(motions, lambda motion: motion.of_station).items():
            sa = float(station_spectra(station, [self.period_s], self.damping)[self.pairs][0])
            factors[name] = self.sa_g * gravity / sa if sa > 0 else math.inf
        return [factors[motion.of_station] for motion in motions]

    def _factor(self, motion: Motion, gravity: float) -> float:
        """Return the factor that scales one motion to the target; infinite if it is at rest."""
        if self.pga_g is not None:
            target, present = self.pga_g * gravity, motion.pga
        elif self.pgv_m_s is not None:
            target, present = self.pgv_m_s, measures.pgv(motion.horizontal, motion.dt, motion.initial)
        else:
            assert self.sa_g is not None
            assert self.period_s is not None
            target = self.sa_g * gravity
            present = float(spectral_acceleration(motion.horizontal, motion.dt, [self.period_s], self.damping)[0])
        return target / present if present > 0 else math.inf


MOST_FACTOR = 4.0
"""Greatest factor that scales a record to a spectrum; an amplified weak record has not the shape of a strong one."""


def at_target(
    motion_set: MotionSet, target: Target | SpectrumTarget, gravity: float = GRAVITY, confirmed: Sequence[str] = ()
) -> MotionSet:
    """Return all motions scaled to ``target``, with a note of the factor; unchanged for a factor of 1.

    Unusable are motions at rest, those of stations without the pair that the target takes, and those that need more than
    :data:`MOST_FACTOR`, 4, to meet a spectrum, unless a pattern in ``confirmed`` matches their name.
    """
    motions: list[Motion] = []
    unusable = _without_pair(motion_set.motions, target)
    lone = {file.name for file in unusable}
    paired = [motion for motion in motion_set.motions if motion.name not in lone]
    for motion, factor in zip(paired, target.factors_of(paired, gravity), strict=True):
        if refusal := _refusal(motion, factor, target, gravity, fits_any(motion.name, confirmed)):
            unusable.append(Unusable(motion.name, motion.sources, refusal))
        else:
            motions.append(motion if factor == 1.0 else _scaled(motion, factor, f"scaled by {factor:.4g} to {target}"))
    return motion_set.reduced_to(motions, unusable)


def _scaled(motion: Motion, factor: float, note: str) -> Motion:
    """Return a motion with all components times a factor, which its own factor contains, and a note of it."""
    return replace(motion.times(factor), factor=motion.factor * factor, notes=(*motion.notes, note))


def scale_as_listed(motion_set: MotionSet) -> MotionSet:
    """Return all motions scaled by their factors in PEER's lists, with a note; those without a listed factor are unusable.

    A sequence has the factor that all its records share, if there is one.
    """
    none = 'has no scale factor: scale = "list" takes those of PEER\'s _SearchResults.csv in its folder'
    several = 'has no scale factor that all its records share: scale them by its factors, and leave out scale = "list"'
    scaled, unusable = list[Motion](), list[Unusable]()
    for m in motion_set:
        if (factor := m.listed.scale) is not None:
            scaled.append(_scaled(m, factor, f"scaled by {factor:.6g}, as PEER's search lists it"))
        else:
            reason = f"{m.label} {several if len(m.records) > 1 else none}"
            unusable.append(Unusable(m.name, m.sources, reason, station=m.of_station))
    return motion_set.reduced_to(scaled, unusable)


def scale_to_targets(
    motion_set: MotionSet,
    target: Target | SpectrumTarget | None,
    vertical_target: Target | SpectrumTarget | None,
    vertical_scale: float,
    gravity: float,
    confirmed: Sequence[str] = (),
) -> MotionSet:
    """Return motions scaled to both targets; if some are unusable, the others are scaled anew until all are usable.

    A common factor is right only for the motions from which it was computed. ``vertical_scale`` multiplies the vertical
    components; without targets motions keep their scale.
    """
    recorded = {motion.name: motion.vertical for motion in motion_set}
    while True:
        scaled = motion_set if target is None else at_target(motion_set, target, gravity, confirmed)
        scaled = scale_verticals(scaled, recorded, vertical_target, vertical_scale, gravity, confirmed)
        used = {motion.name for motion in scaled}
        if len(used) == len(motion_set.motions):
            return scaled
        remaining = [motion for motion in motion_set if motion.name in used]
        motion_set = replace(motion_set, motions=remaining, unusable=scaled.unusable)


def verticals(motions: Sequence[Motion]) -> list[Motion]:
    """Return the first vertical component of each station that moves, as a motion with the station's name; [] without any."""
    moving = {motion.of_station: motion for motion in reversed(motions) if motion.pga_vertical}
    return [
        Motion(name, motion.dt, motion.vertical, source=motion.vertical_source)
        for name, motion in reversed(moving.items())
        if motion.vertical is not None
    ]


def scale_verticals(
    motion_set: MotionSet,
    recorded: Mapping[str, Samples | None],
    target: Target | SpectrumTarget | None,
    scale: float,
    gravity: float,
    confirmed: Sequence[str] = (),
) -> MotionSet:
    """Return motions whose vertical components have their own factor, the same for all components of a station.

    ``recorded`` has the vertical components before scaling, by the motions' names. They are scaled to ``target``, or without
    one by the factor of their horizontals, and by ``scale``; without a target and with ``scale`` 1 nothing changes. As by
    :func:`at_target`, a motion is unusable if its vertical component needs more than :data:`MOST_FACTOR` to meet a spectrum.
    """
    if target is None and scale == 1.0:
        return motion_set
    factors: dict[str, float] = {}
    alone: dict[str, Motion] = {}
    if target is not None:
        as_recorded = [replace(m, vertical=recorded[m.name]) for m in motion_set.motions if m.vertical is not None]
        alone = {motion.name: motion for motion in verticals(as_recorded)}
        factors = dict(zip(alone, target.factors_of([*alone.values()], gravity), strict=True))
    named = {motion.of_station for motion in motion_set.motions if fits_any(motion.name, confirmed)}
    motions: list[Motion] = []
    unusable: list[Unusable] = []
    for motion in motion_set.motions:
        station, unscaled = motion.of_station, recorded[motion.name]
        if motion.vertical is None or unscaled is None:
            motions.append(motion)
            continue
        factor, notes = motion.factor, list(motion.notes)
        if station in alone:
            factor = factors[station]
            vertical = replace(alone[station], name=motion.name)
            if refusal := _refusal(vertical, factor, target, gravity, station in named):
                unusable.append(Unusable(motion.name, motion.sources, f"its vertical component {refusal}"))
                continue
            notes.append(f"vertical scaled by {factor:.4g} to {target}")
        if scale != 1.0:
            factor *= scale
            notes.append(f"vertical times {scale:g}")
        motions.append(replace(motion, vertical=unscaled * factor, vertical_factor=factor, notes=tuple(notes)))
    return motion_set.reduced_to(motions, unusable)


def _without_pair(motions: Sequence[Motion], target: Target | SpectrumTarget) -> list[Unusable]:
    """Return the motions of stations without a pair as unusable, for a target that takes both components; [] for others."""
    if target.pairs not in TWO_COMPONENT_RULES or (isinstance(target, SpectrumTarget) and target.factors == "none"):
        return []
    unusable = []
    for station in grouped(motions, lambda motion: motion.of_station).values():
        if obstacle := pairing_obstacle(station):
            reason = f'no pair for pairs = "{target.pairs}": {obstacle}; write pairs = "apart", or leave it out'
            unusable += [Unusable(motion.name, motion.sources, reason) for motion in station]
    return unusable


def _refusal(
    motion: Motion, factor: float, target: Target | SpectrumTarget | None, gravity: float, confirmed: bool
) -> str:
    """Return why a motion at rest, or, unless ``confirmed``, one that needs more than ``MOST_FACTOR``, is refused; else ""."""
    if math.isinf(factor):
        return f"has no motion that can be scaled to {target}"
    if confirmed or factor <= MOST_FACTOR or not isinstance(target, SpectrumTarget):
        return ""
    vertical = "" if motion.pga_vertical is None else f", vertical {factor * motion.pga_vertical / gravity:.2g} g"
    return (
        f"takes {factor:.3g} times its motion, PGA {factor * motion.pga / gravity:.2g} g{vertical}, to meet {target}; a weak "
        f"record times more than {MOST_FACTOR:g} does not represent a strong one; choose others, or, if it is right, write "
        f'confirm = ["{motion.name}"] under [motions] in the study'
    )
