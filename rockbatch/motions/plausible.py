"""Oddities of a record: a peak that a wrong unit explains, faults of instruments, and where the sensor stood.

Each judge looks for one thing and returns a :class:`Finding`, or nothing; a further one joins by its name in ``JUDGES``.
The limits are held against real records in motions/README.md.
"""

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase

import numpy as np

from rockbatch.common.units import GRAVITY
from rockbatch.motions import measures
from rockbatch.motions.component import Component
from rockbatch.motions.motion import Finding, Motion, Samples
from rockbatch.motions.places import Stand, stand

LOWEST, HIGHEST = 0.001, 5.0
"""PGA [g] beyond which a wrong unit is likelier than the record; the largest recorded ones reach 2 to 4 g."""

STRONG = 2.0
"""PGA [g] that few records exceed, and many do whose header says g of numbers in m/s²."""

FLAT, FLATTER = 0.005, 20.0
"""Samples within this share of the PGA of an extreme are its top; it is flat if the samples beside it lie so many times further
off than those in it lie apart: of a parabola that is 4 at most."""

FARTHEST, ABSURD = 15.0, 100.0
"""PGD [m] beyond which no ground has moved (beside the ruptures of the largest earthquakes it was some 10 m), and beyond
which not even an unprocessed acceleration drifts: it may be a velocity."""

UNEQUAL = 5.0
"""Ratio of the PGAs of two horizontal components of a station beyond which one gain is likelier wrong than right."""

FAINT = 20.0
"""Ratio of the PGA of the horizontal components of a station to that of its vertical one, beyond which a gain is likelier wrong;
real records have 0.4 to 3."""

STEADY = 0.12
"""Distance of the growth of ∫a² dt from a straight line below which a vertical component is noise, if its horizontal one has
twice as much; real records have 0.24 and more, white noise of a few hundred samples some 0.05."""

ALTERNATION = 0.25
"""Share of the PGA that swings to and fro, sample by sample, eight samples long, beyond which it is an instrument's."""

FARTHEST_MEAN = 0.15
"""Mean over the peak, PGA, beyond which a series is hardly a record's: the ground would end with this share of PGA times
duration. Real records as they are used have 0.0003 at most; one cut at 1 m/s after 3 s of 3 m/s² would have 0.11."""

ANY = ("*",)
"""Confirms every record."""

_SWINGS = 7
_SAME_SHAPE = 1e-3  # of the peak: what printing a scaled copy may cost a sample
_LONG_TOP = 4  # samples of a flat top, or of several together and one more
_ENOUGH = 8  # samples: fewer tell nothing about their mean


@dataclass(frozen=True)
class Judged:
    """A motion, and what it is judged by."""

    motion: Motion
    component: Component  # its horizontal component
    peaks: Sequence[tuple[Component, float]]  # the horizontal components of its station, and their PGAs [m/s²]
    gravity: float  # [m/s²]


def unlikely_peak(judged: Judged) -> Finding | None:
    """Find a PGA that no earthquake has, so that the unit is probably wrong."""
    horizontal = judged.motion.pga / judged.gravity
    vertical = (judged.motion.pga_vertical or 0.0) / judged.gravity
    if LOWEST <= horizontal <= HIGHEST >= vertical:
        return _strong(max(horizontal, vertical)) if judged.component.unit.strip().lower() == "g" else None
    peak = f"PGA {horizontal:.3g} g"
    if vertical > HIGHEST:
        peak += f", vertical {vertical:.3g} g,"
    return Finding("PGA", f"{peak} outside {LOWEST:g}–{HIGHEST:g} g: check the unit", gross=True, key="confirm_pga")


def _strong(peak: float) -> Finding | None:
    """Find a peak [g] of a record in g that would be a usual one in m/s²."""
    if peak <= STRONG:
        return None
    text = f"PGA {peak:.3g} g, as few records have; if its numbers are in m/s², it is {peak / GRAVITY:.2g} g: check the unit"
    return Finding("PGA", text, key="confirm_pga")


def unlikely_samples(motion: Motion, gravity: float) -> list[str]:
    """Return what is odd about the unit of a motion that was read from no file; empty if nothing, or it is confirmed."""
    peak = max(motion.pga, motion.pga_vertical or 0.0)
    judged = motion.source == "pulse" or any(finding.what == "PGA" for finding in motion.findings)
    if judged or "pga" in motion.confirm or peak <= HIGHEST * gravity:
        return []
    return [
        f'motion "{motion.name}": PGA {peak / gravity:.3g} g, where the strongest earthquakes had 2 to 4 g: samples are in m/s², '
        'and gal are 0.01 of it; if it is right, write confirm = ["pga"]'
    ]


def no_zero_line(judged: Judged) -> Finding | None:
    """Find a series that does not swing about zero: a spectrum, an envelope, an offset."""
    components = (("", judged.motion.horizontal), ("its vertical component ", judged.motion.vertical))
    moving = [(name, a) for name, a in components if a is not None and len(a) >= _ENOUGH and np.any(a)]
    for name, a in moving:
        if a.min() >= 0 or a.max() <= 0:
            return Finding("zero line", f"{name}never changes sign, as spectra do and records do not", gross=True)
    for name, a in moving:
        share = abs(float(a.mean())) / float(np.abs(a).max())
        if share > FARTHEST_MEAN:
            text = (
                f"{name}has a mean of {share:.0%} of its peak, where a record's is near 0: if an offset is in it, write "
                'offset = "mean" under [motions]'
            )
            return Finding("zero line", text, gross=True)
    return None


def alternation(judged: Judged) -> Finding | None:
    """Find samples that swing to and fro: the recorder, or its file, and not the ground."""
    for name, samples in (("", judged.motion.horizontal), ("vertical: ", judged.motion.vertical)):
        if samples is None:
            continue
        swing, peak = alternating(samples), float(np.abs(samples).max())
        if swing > ALTERNATION * peak:
            text = (
                f"{name}it alternates from sample to sample by {swing / judged.gravity:.3g} g, {swing / peak:.0%} of its "
                "PGA: check the file"
            )
            return Finding("alternates", text, gross=True)
    return None


def alternating(samples: Samples) -> float:
    """Return the largest amplitude of eight samples in a row of which every one lies on the other side of its neighbours.

    Half of the least of their seven swings, in the unit of ``samples``; 0 for fewer samples.
    """
    if len(samples) <= _SWINGS:
        return 0.0
    swings = np.diff(samples)
    swings[1::2] *= -1.0  # of one sign where samples alternate
    least, greatest = swings, swings
    for shift in (1, 2, 3):  # of two, of four, of seven in a row
        least = np.minimum(least[shift:], least[:-shift])
        greatest = np.maximum(greatest[shift:], greatest[:-shift])
    return max(0.0, float(least.max()), -float(greatest.min())) / 2.0


def clipped(judged: Judged) -> Finding | None:
    """Find flat tops: the recorder, or its digitiser, ended there, and the ground did not."""
    for name, samples in (("", judged.component.acceleration), ("vertical: ", judged.motion.vertical)):
        tops = [] if samples is None else flat_tops(samples)
        if max(tops, default=0) >= _LONG_TOP or (len(tops) > 1 and sum(tops) > _LONG_TOP):
            text = (
                f"{name}flat tops: {sum(tops)} samples at its largest value, in rows of {max(tops)} and less: clipped by the "
                "recorder, its true peak is not known"
            )
            return Finding("clipped", text, gross=True)
    return None


def flat_tops(samples: Samples) -> list[int]:
    """Return how many samples each flat stretch at the largest and at the smallest value has; natural peaks have none."""
    peak = float(np.abs(samples).max(initial=0.0))
    values = np.unique(samples)
    if peak == 0.0 or len(values) < _ENOUGH:
        return []
    resolution = float(np.diff(values).min())
    tops: list[int] = []
    for upright in (samples, -samples):
        top = float(upright.max())
        at_top = np.concatenate(([0], upright >= top - FLAT * peak, [0]))
        starts, ends = np.flatnonzero(np.diff(at_top) == 1), np.flatnonzero(np.diff(at_top) == -1)
        for start, end in zip(starts, ends, strict=True):
            if end - start < 2 or start == 0 or end == len(samples) or top <= 0.0:
                continue
            spread = max(float(np.ptp(upright[start:end])), resolution)
            if top - max(upright[start - 1], upright[end]) > FLATTER * spread:
                tops.append(int(end - start))
    return tops


def displacement(judged: Judged) -> Finding | None:
    """Find a displacement that no ground has, gross for a corrected record, or beyond ``ABSURD``; or one that runs away."""
    motion = judged.motion
    pgd = measures.pgd(motion.horizontal, motion.dt, motion.initial)
    if pgd > FARTHEST:
        text = f"its displacement reaches {pgd:.3g} m, more than {FARTHEST:g} m: check its baseline"
        return Finding("PGD", text, gross=motion.processed is True or pgd > ABSURD)
    if measures.believable_pgd(motion) is not None:
        return None
    text = (
        f"no PGD: from rest its displacement runs away, to {pgd:.3g} m; it is unprocessed, or its file does not tell "
        "the velocity that it begins with"
    )
    return Finding("no PGD", text)


def unequal_horizontals(judged: Judged) -> Finding | None:
    """Find a horizontal component many times the other one of its station."""
    if len(judged.peaks) != 2:
        return None
    (low, least), (high, most) = sorted(judged.peaks, key=lambda peak: peak[1])
    if not most > UNEQUAL * least:
        return None
    text = f"PGA of {high.name} is {most / max(least, 1e-300):.3g} times that of {low.name}: check their gains"
    return Finding("unequal", text)


def copied_horizontal(judged: Judged) -> Finding | None:
    """Find a horizontal component with the samples of the other one of its station."""
    others = [c for c, _ in judged.peaks if c is not judged.component and len(judged.peaks) == 2]
    copied = [c.name for c in others if _factor(judged.component.acceleration, c.acceleration)]
    text = f"it has the samples of {', '.join(copied)}, square to it: check their files"
    return Finding("copy", text) if copied else None


def unlike_vertical(judged: Judged) -> Finding | None:
    """Find a vertical component that is none of this ground: a copy of a horizontal one, noise, or of another gain."""
    motion = judged.motion
    if motion.vertical is None or not np.any(motion.vertical):
        return None
    peers = {c.name: c.acceleration for c, _ in judged.peaks} | {motion.name: motion.horizontal}
    factors = ((name, factor) for name, a in peers.items() if (factor := _factor(motion.vertical, a)))
    if copied := next(factors, None):
        name, factor = copied
        times = "" if (same := abs(abs(factor) - 1.0) <= _SAME_SHAPE) else f" times {abs(factor):.3g}"
        text = f"its vertical component has the samples of the horizontal one {name}{times}: check the file"
        return Finding("vertical", text, gross=same)
    most = max([motion.pga, *(peak for _, peak in judged.peaks)])
    ratio = np.abs(motion.vertical).max() / max(most, 1e-300)
    if not 1.0 / FAINT <= ratio <= UNEQUAL:
        text = f"PGA of its vertical component is {ratio:.3g} times that of the horizontal ones: check their gains"
        return Finding("vertical", text, gross=True)
    if _growth_apart(motion.vertical) < STEADY and _growth_apart(motion.horizontal) > 2.0 * STEADY:
        text = "its vertical component shakes alike from the first to the last sample, and the ground does not: noise"
        return Finding("vertical", text, gross=True)
    return None


def _factor(a: Samples, b: Samples) -> float:
    """Return the factor by which samples are those of ``b``; 0 if they are others."""
    if len(a) != len(b) or not b.any():
        return 0.0
    factor = float(a @ b) / float(b @ b)
    return factor if np.abs(a - factor * b).max() <= _SAME_SHAPE * np.abs(a).max() else 0.0


def _growth_apart(samples: Samples) -> float:
    """Return how far the share of ∫a² dt that has grown is apart from that of the time, at most."""
    energy = np.cumsum(np.square(samples))
    return float(np.abs(energy / (energy[-1] or 1.0) - np.arange(1, len(energy) + 1) / len(energy)).max())


def in_a_structure(judged: Judged) -> Finding | None:
    """Return that a sensor is on a structure, or in a borehole, by its place or its station's name."""
    where, text = _stand(judged.component)
    if where is Stand.BOREHOLE:
        return Finding("borehole", f'"{text}" is in a borehole, and not at the surface', gross=True)
    if where is Stand.STRUCTURE:
        return Finding("structure", f'"{text}" is in a structure, and not on the ground', gross=True)
    return None


def in_a_borehole(component: Component) -> bool:
    """Return whether a sensor is in a borehole, by its place or its station's name."""
    return _stand(component)[0] is Stand.BOREHOLE


def _stand(component: Component) -> tuple[Stand, str]:
    return stand(component.sensor.place or "", component.origin.station)


def unprocessed(judged: Judged) -> Finding | None:
    """Find a record as the instrument left it."""
    if judged.motion.processed is not False:
        return None
    return Finding("unprocessed", "unprocessed: as recorded, with what the instrument adds at long periods")


def differing_copies(judged: Judged) -> Finding | None:
    """Return how its header, or copies of it that are left out, differ; those of its vertical component too."""
    both = (*judged.component.findings, *judged.motion.findings)
    if not both:
        return None
    return Finding(both[0].what, "; ".join(finding.text for finding in both), any(finding.gross for finding in both))


JUDGES: tuple[Callable[[Judged], Finding | None], ...] = (
    unlikely_peak,
    no_zero_line,
    alternation,
    clipped,
    displacement,
    unequal_horizontals,
    copied_horizontal,
    unlike_vertical,
    in_a_structure,
    differing_copies,
    unprocessed,
)


def findings(judged: Judged) -> tuple[Finding, ...]:
    """Return all that is odd about a motion."""
    findings_or_none = (check(judged) for check in JUDGES)
    return tuple(finding for finding in findings_or_none if finding is not None)


def gross_findings(component: Component) -> list[Finding]:
    """Return what is grossly odd about a component alone, and neither it nor a manifest confirms."""
    alone = Motion(
        component.name, component.dt, component.acceleration, initial=component.initial, processed=component.processed
    )
    all_findings = findings(Judged(alone, component, (), GRAVITY))
    return [
        finding
        for finding in all_findings
        if finding.gross and not {"confirm", finding.key}.intersection(component.confirmed)
    ]


def doubt(name: str, findings: Sequence[Finding], confirmed: Collection[str]) -> str:
    """Return why the motion ``name`` has to be confirmed, and how; empty where it need not be, or ``confirmed`` has the key."""
    unconfirmed = [f for f in findings if f.gross and not {"confirm", f.key}.intersection(confirmed)]
    if not unconfirmed:
        return ""
    key = unconfirmed[0].key if len(unconfirmed) == 1 else "confirm"
    return (
        f'{"; ".join(finding.text for finding in unconfirmed)}; if it is right, write {key} = ["{name}"] under [motions] '
        f"in the study, or {key} = true in motions.toml"
    )


def fits(name: str, patterns: Sequence[str]) -> bool:
    """Return whether a record's name is one of ``patterns``, or matches one with ``*`` and ``?``."""
    return any(name == pattern or fnmatchcase(name, pattern) for pattern in patterns)
