"""Records scaled to a target: a PGA, a PGV, a spectral acceleration, or a whole spectrum."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from rockbatch.common.errors import InputError
from rockbatch.common.grouping import grouped
from rockbatch.common.units import GRAVITY
from rockbatch.motions import measures
from rockbatch.motions.motion import Motion, Samples, Unusable
from rockbatch.motions.motion_set import MotionSet
from rockbatch.motions.pairs import DIRECTIONS, WORDS, station_spectra, unpaired
from rockbatch.motions.plausible import fits
from rockbatch.motions.spectrum import spectral_acceleration
from rockbatch.motions.spectrum_target import SpectrumTarget


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
        With ``sa_g``: "apart", every component has it, or one of :data:`rockbatch.motions.pairs.DIRECTIONS`, by which a station
        has it, whose components then have one factor.
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
        if self.pairs != "apart" and (self.sa_g is None or self.pairs not in DIRECTIONS):
            raise InputError(
                f'pairs = "{self.pairs}": must be one of {", ".join(("apart", *DIRECTIONS))}, and is for sa_g'
            )

    def __str__(self) -> str:
        if self.sa_g is not None:
            measure = "" if self.pairs == "apart" else f" of {WORDS[self.pairs]}"
            return f"SA({self.period_s:g} s, {100 * self.damping:g} %){measure} = {self.sa_g:g} g"
        return f"PGA = {self.pga_g:g} g" if self.pga_g is not None else f"PGV = {self.pgv_m_s:g} m/s"

    def factors_of(self, motions: Sequence[Motion], gravity: float) -> list[float]:
        """Return what brings each of ``motions`` to the target; infinite for one without motion.

        Raises ``InputError`` if the rule takes pairs, and a station has none (:func:`rockbatch.motions.pairs.unpaired`).
        """
        if self.pairs == "apart":
            return [self._factor(motion, gravity) for motion in motions]
        assert self.sa_g is not None
        assert self.period_s is not None
        stations = grouped(motions, lambda motion: motion.of_station)
        measured = {
            name: station_spectra(station, [self.period_s], self.damping)[self.pairs][0]
            for name, station in stations.items()
        }
        return [
            self.sa_g * gravity / float(sa) if (sa := measured[motion.of_station]) > 0 else math.inf
            for motion in motions
        ]

    def _factor(self, motion: Motion, gravity: float) -> float:
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
"""By which a record is brought to a spectrum; a weak record made strong has not the shape of a strong one."""


def at_target(
    motion_set: MotionSet, target: Target | SpectrumTarget, gravity: float = GRAVITY, confirmed: Sequence[str] = ()
) -> MotionSet:
    """Return all motions scaled to ``target``, with the factor noted; one without motion is unusable.

    So is one that takes more than :data:`MOST_FACTOR` to meet a spectrum, unless its name fits a pattern in ``confirmed``.
    """
    motions: list[Motion] = []
    unusable = _lone(motion_set.motions, target)
    lone = {file.name for file in unusable}
    paired = [motion for motion in motion_set.motions if motion.name not in lone]
    for motion, factor in zip(paired, target.factors_of(paired, gravity), strict=True):
        if math.isinf(factor):
            unusable.append(Unusable(motion.name, motion.files, f"has no motion that can be scaled to {target}"))
        elif isinstance(target, SpectrumTarget) and factor > MOST_FACTOR and not fits(motion.name, confirmed):
            unusable.append(Unusable(motion.name, motion.files, _too_weak(motion, factor, target, gravity)))
        elif factor == 1.0:
            motions.append(motion)
        else:
            notes = (*motion.notes, f"scaled by {factor:.4g} to {target}")
            motions.append(replace(motion.times(factor), factor=motion.factor * factor, notes=notes))
    return motion_set.reduced_to(motions, unusable)


def scaled_as_listed(motion_set: MotionSet) -> MotionSet:
    """Return all motions times the factors that a list beside them has, with the factor noted; those without one are unusable."""
    lacking = [motion for motion in motion_set if motion.listed.scale is None]
    reason = 'has no scale factor: scale = "list" takes those of PEER\'s _SearchResults.csv in its folder'
    unusable = [Unusable(m.name, m.files, f"{m.label} {reason}", station=m.of_station) for m in lacking]
    scaled = []
    for motion in motion_set:
        if (factor := motion.listed.scale) is not None:
            notes = (*motion.notes, f"scaled by {factor:.6g}, as PEER's search lists it")
            scaled.append(replace(motion.times(factor), factor=motion.factor * factor, notes=notes))
    return motion_set.reduced_to(scaled, unusable)


def at_targets(
    motion_set: MotionSet,
    target: Target | SpectrumTarget | None,
    vertical_target: Target | SpectrumTarget | None,
    vertical_scale: float,
    gravity: float,
    confirmed: Sequence[str] = (),
) -> MotionSet:
    """Return motions scaled by :func:`at_target` and :func:`with_vertical`, which are fitted again without those that are
    refused until none is: a common factor holds for the motions that it was found from."""
    recorded = {motion.name: motion.vertical for motion in motion_set}
    while True:
        scaled = motion_set if target is None else at_target(motion_set, target, gravity, confirmed)
        scaled = with_vertical(scaled, recorded, vertical_target, vertical_scale, gravity, confirmed)
        used = {motion.name for motion in scaled}
        if len(used) == len(motion_set.motions):
            return scaled
        remaining = [motion for motion in motion_set if motion.name in used]
        motion_set = replace(motion_set, motions=remaining, unusable=scaled.unusable)


def verticals(motions: Sequence[Motion]) -> list[Motion]:
    """Return the vertical component of each station as a motion on its own, called as the station, those that move."""
    moving = {motion.of_station: motion for motion in reversed(motions) if motion.pga_vertical}
    return [
        Motion(name, motion.dt, motion.vertical, source=motion.vertical_source)
        for name, motion in reversed(moving.items())
        if motion.vertical is not None
    ]


def with_vertical(
    motion_set: MotionSet,
    recorded: Mapping[str, Samples | None],
    target: Target | SpectrumTarget | None,
    scale: float,
    gravity: float,
    confirmed: Sequence[str] = (),
) -> MotionSet:
    """Return motions whose vertical components have a factor of their own, the same for all components of a station.

    ``recorded`` has the vertical components before they were scaled, by the motions' names. They are scaled to ``target``, if
    there is one, instead of by the factor of their horizontal ones, and by ``scale`` on top. As of :func:`at_target` a motion is
    unusable whose vertical component takes more than :data:`MOST_FACTOR` to meet a spectrum.
    """
    if target is None and scale == 1.0:
        return motion_set
    factors: dict[str, float] = {}
    reasons: dict[str, str] = {}
    if target is not None:
        as_recorded = [replace(m, vertical=recorded[m.name]) for m in motion_set.motions if m.vertical is not None]
        named = [motion.of_station for motion in motion_set.motions if fits(motion.name, confirmed)]
        scaled = at_target(MotionSet(verticals(as_recorded)), target, gravity, named)
        factors = {motion.name: motion.factor for motion in scaled}
        reasons = {file.name: file.reason for file in scaled.unusable}
    motions: list[Motion] = []
    unusable: list[Unusable] = []
    for motion in motion_set.motions:
        station, unscaled = motion.of_station, recorded[motion.name]
        if motion.vertical is None or unscaled is None:
            motions.append(motion)
        elif station in reasons:
            reason = reasons[station].replace(f'["{station}"]', f'["{motion.name}"]')
            unusable.append(Unusable(motion.name, motion.files, f"its vertical component {reason}"))
        else:
            factor = factors.get(station, motion.factor) * scale
            words = [f"vertical scaled by {factors[station]:.4g} to {target}"] if station in factors else []
            words += [f"vertical times {scale:g}"] if scale != 1.0 else []
            motions.append(replace(
                motion, vertical=unscaled * factor, vertical_factor=factor, notes=(*motion.notes, *words),
            ))  # fmt: skip
    return motion_set.reduced_to(motions, unusable)


def _lone(motions: Sequence[Motion], target: Target | SpectrumTarget) -> list[Unusable]:
    """Return what cannot be used because the target takes both horizontal components of a station."""
    if target.pairs not in DIRECTIONS or (isinstance(target, SpectrumTarget) and target.factors == "none"):
        return []
    stations, lacks = grouped(motions, lambda motion: motion.of_station), f'no pair for pairs = "{target.pairs}"'
    return [
        Unusable(
            motion.name,
            motion.files,
            f'{lacks}: {reason}; write pairs = "apart", or leave it out',
        )
        for station in stations.values()
        if (reason := unpaired(station))
        for motion in station
    ]


def _too_weak(motion: Motion, factor: float, target: SpectrumTarget, gravity: float) -> str:
    vertical = "" if motion.pga_vertical is None else f", vertical {factor * motion.pga_vertical / gravity:.2g} g"
    return (
        f"takes {factor:.3g} times its motion, PGA {factor * motion.pga / gravity:.2g} g{vertical}, to meet {target}; beyond "
        f"{MOST_FACTOR:g} times a weak record is not what a strong one would be; choose others, or, if it is right, write "
        f'confirm = ["{motion.name}"] under [motions] in the study'
    )
