"""Oddities of a record: a peak that suggests a wrong unit, faults of instruments, and the location of the sensor.

Each judge looks for one oddity and returns a :class:`Finding` or None; a new one is added to ``JUDGES``. The limits are
compared with real records in motions/README.md.
"""

import re
from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from rockbatch.common.units import GRAVITY
from rockbatch.motions.alignment import Copy, copy_between, same_step
from rockbatch.motions.component import Component
from rockbatch.motions.intensity import measures
from rockbatch.motions.labels.orientation import KIK_NET, same_azimuth
from rockbatch.motions.motion import Finding, Motion, Samples
from rockbatch.motions.quality.faults import filled_gap, is_spike, parts_missing, runs
from rockbatch.motions.quality.places import Stand, stand

LOWEST, HIGHEST = 0.001, 5.0
"""PGA [g] beyond which a wrong unit is likelier than the record; the largest recorded ones reach 2 to 4 g."""

STRONG = 2.0
"""PGA [g] that few records exceed, but many with numbers in m/s² and a header of g."""

FLAT, FLATTER = 0.005, 20.0
"""Samples within this share of the PGA of an extreme form its top; it is flat if the samples beside it are so many times further
below than the spread within it: 4 at most for a parabola."""

FARTHEST, ABSURD = 15.0, 100.0
"""PGD [m] beyond which no ground has moved (some 10 m beside the ruptures of the largest earthquakes), and beyond which not even
an unprocessed acceleration drifts: it may be a velocity."""

UNEQUAL = 5.0
"""Ratio of the PGAs of two horizontal components of a station beyond which a wrong gain is likelier."""

FAINT = 20.0
"""Ratio of the PGA of a station's horizontal components to that of its vertical one, beyond which a wrong gain is likelier;
real records have 0.4 to 3."""

SELDOM_BELOW, SELDOM_ABOVE = 1.0 / 8.0, 3.0
"""The same ratio, vertical over horizontal, beyond which a unit is in doubt: some three standard deviations (ln 0.5) off the
usual 0.55."""

STEADY = 0.12
"""Distance of the growth of ∫a² dt from a straight line below which a vertical component is noise, if the horizontal has twice
as much; real records have 0.24 and more, white noise of a few hundred samples some 0.05."""

ALTERNATION = 0.25
"""Amplitude over the PGA of an alternation from sample to sample over eight samples, beyond which it is the recorder's."""

FARTHEST_MEAN = 0.15
"""Mean over the PGA beyond which a series is hardly a record: the ground would end with a velocity of this share of PGA times
duration. Real records as they are used have 0.0003 at most; one cut at 1 m/s after 3 s of 3 m/s² would have 0.11."""

ANY = ("*",)
"""Confirms every record."""

_SWINGS = 7
_SAME_SHAPE = 1e-3  # of a factor: rounding of a printed copy
_SAME_SIZE = 0.02  # of a factor: copies that were not scaled on purpose
_FIRST_SENSOR = re.compile(r"(?:NS|EW|UD)1")
_LONG_TOP = 4  # samples: least length of one flat top; several together must have one more
_ENOUGH = 8  # samples: the mean of fewer says nothing


@dataclass(frozen=True)
class Candidate:
    """A motion to be judged, with the components of its station."""

    motion: Motion
    component: Component  # its horizontal component
    peaks: Sequence[tuple[Component, float]]  # the horizontal components of its station, and their PGAs [m/s²]
    gravity: float  # [m/s²]

    @property
    def series(self) -> Iterator[tuple[str, Samples]]:
        """Yield the samples of its motion, each behind the beginning of a sentence on them: "", or "vertical: "."""
        yield "", self.motion.horizontal
        if self.motion.vertical is not None:
            yield "vertical: ", self.motion.vertical


def unlikely_peak(candidate: Candidate) -> Finding | None:
    """Return a gross finding on a horizontal PGA outside 0.001–5 g, or a vertical one above 5 g; probably the unit is wrong.

    From 2 to 5 g in a file in g it is not gross; None for any other PGA, and a dead channel.
    """
    if not _moves(candidate.component):
        return None
    horizontal = candidate.motion.pga / candidate.gravity
    vertical = (candidate.motion.pga_vertical or 0.0) / candidate.gravity
    peak = max(horizontal, vertical)
    if not LOWEST <= horizontal <= HIGHEST >= vertical:
        size = f"PGA {horizontal:.3g} g" + (f", vertical {vertical:.3g} g," if vertical > HIGHEST else "")
        text = f"{size} outside {LOWEST:g}–{HIGHEST:g} g: check the unit"
        return Finding("PGA", text, gross=True, key="confirm_pga")
    if peak <= STRONG or candidate.component.unit.strip().lower() != "g":
        return None
    text = f"PGA {peak:.3g} g, as few records have; if its numbers are in m/s², it is {peak / GRAVITY:.2g} g: check the unit"
    return Finding("PGA", text, key="confirm_pga")


def _moves(component: Component) -> bool:
    """Return whether the samples of a component differ."""
    return bool(np.ptp(component.acceleration) > 0.0)


def dead_channel(candidate: Candidate) -> Finding | None:
    """Return a gross finding on a horizontal component whose samples are all equal; else None."""
    if _moves(candidate.component):
        return None
    return Finding("dead", "it never moves: a dead channel; leave it out by use = false in motions.toml", gross=True)


def unlikely_samples(motion: Motion, gravity: float) -> list[str]:
    """Return a message in a list on an unconfirmed PGA above 5 g; [] for others, pulses, and motions with a finding on PGA."""
    peak = max(motion.pga, motion.pga_vertical or 0.0)
    candidate = not motion.recorded or any(finding.key == "confirm_pga" for finding in motion.findings)
    if candidate or "pga" in motion.confirm or peak <= HIGHEST * gravity:
        return []
    return [
        f'motion "{motion.name}": PGA {peak / gravity:.3g} g, where the strongest earthquakes had 2 to 4 g: samples are in m/s², '
        'and gal are 0.01 of it; if it is right, write confirm = ["pga"]'
    ]


def no_zero_line(candidate: Candidate) -> Finding | None:
    """Return a gross finding on samples of one sign, as of a spectrum, or with a mean above 15 % of their peak; else None.

    Components at rest, or of fewer than eight samples, are not judged.
    """
    components = (("", candidate.motion.horizontal), ("its vertical component ", candidate.motion.vertical))
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


def alternation(candidate: Candidate) -> Finding | None:
    """Return a gross finding on samples that alternate from one to the next by over 25 % of their peak; else None."""
    for name, samples in candidate.series:
        swing, peak = alternating(samples), float(np.abs(samples).max())
        if swing > ALTERNATION * peak:
            text = (
                f"{name}it alternates from sample to sample by {swing / candidate.gravity:.3g} g, {swing / peak:.0%} of its "
                "PGA: check the file"
            )
            return Finding("alternates", text, gross=True)
    return None


def alternating(samples: Samples) -> float:
    """Return the largest amplitude by which eight successive samples alternate, each swing against the last, in their unit.

    It is half the least of the seven swings; 0 without an alternation, or for fewer than eight samples.
    """
    if len(samples) <= _SWINGS:
        return 0.0
    swings = np.diff(samples)
    swings[1::2] *= -1.0  # so that alternating samples have swings of one sign
    least, greatest = swings, swings
    for shift in (1, 2, 3):  # extremes over two, four, seven swings in a row
        least = np.minimum(least[shift:], least[:-shift])
        greatest = np.maximum(greatest[shift:], greatest[:-shift])
    return max(0.0, float(least.max()), -float(greatest.min())) / 2.0


def flat_top(candidate: Candidate) -> Finding | None:
    """Return a gross finding on a flat top of four samples or more at the peak, or several of five in all: clipped; else None."""
    for name, samples in (("", candidate.component.acceleration), ("vertical: ", candidate.motion.vertical)):
        tops = [] if samples is None else flat_tops(samples)
        if max(tops, default=0) >= _LONG_TOP or sum(tops) > _LONG_TOP:
            text = (
                f"{name}flat tops: {sum(tops)} samples at its largest value, in rows of {max(tops)} and less: clipped by the "
                "recorder, its true peak is not known"
            )
            return Finding("clipped", text, gross=True)
    return None


def flat_tops(samples: Samples) -> list[int]:
    """Return the number of samples of each flat top (:data:`FLATTER`) at the largest and smallest value; [] for natural peaks."""
    peak = float(np.abs(samples).max(initial=0.0))
    values = np.unique(samples)
    if peak == 0.0 or len(values) < _ENOUGH:
        return []
    resolution = float(np.diff(values).min())
    tops: list[int] = []
    for upright in (samples, -samples):
        top = float(upright.max())
        for start, end in runs(upright >= top - FLAT * peak).tolist():
            if end - start < 2 or start == 0 or end == len(samples) or top <= 0.0:
                continue
            spread = max(float(np.ptp(upright[start:end])), resolution)
            if top - max(upright[start - 1], upright[end]) > FLATTER * spread:
                tops.append(end - start)
    return tops


def displacement(candidate: Candidate) -> Finding | None:
    """Return a finding on a PGD above 15 m, gross if the record is corrected or the PGD above 100 m, or on a drift; else None."""
    motion = candidate.motion
    pgd = measures.pgd(motion.horizontal, motion.dt, motion.initial)
    if pgd > FARTHEST:
        text = f"its displacement reaches {pgd:.3g} m, more than {FARTHEST:g} m: check its baseline"
        return Finding("PGD", text, gross=motion.processed is True or pgd > ABSURD)
    if measures.believable_pgd(motion) is not None:
        return None
    text = (
        f"no PGD: integrated displacement drifts to {pgd:.3g} m; the record is unprocessed, or its initial velocity is "
        "missing"
    )
    return Finding("no PGD", text)


def faulty_samples(candidate: Candidate) -> Finding | None:
    """Return a gross finding on a filled gap within the strong motion, or on a peak that is a spike; else None."""
    component, motion = candidate.component, candidate.motion
    for name, samples, dt in (("", component.acceleration, component.dt), ("vertical: ", motion.vertical, motion.dt)):
        if samples is None:
            continue
        if gap := filled_gap(samples, dt):
            text = (
                f"{name}a straight line of {gap.lasts:.3g} s from {gap.begins:.4g} s on, within the strong motion: a gap was "
                "filled, and what happened in it is not known"
            )
            return Finding("gap", text, gross=True)
        if is_spike(samples):
            text = f"{name}its peak is a spike: without it, less than half of it remains; repair the record"
            return Finding("spike", text, gross=True)
    return None


def incomplete_record(candidate: Candidate) -> Finding | None:
    """Return a finding on a horizontal component that does not begin or end at rest; else None."""
    parts = parts_missing(candidate.component.acceleration, candidate.component.dt)
    if not parts or not _moves(candidate.component):
        return None
    return Finding("cut", f"it does not {' or '.join(parts)} at rest: if it was recorded, a part is missing")


def unequal_horizontals(candidate: Candidate) -> Finding | None:
    """Return a finding on two horizontals of a station whose PGAs differ by a factor above 5; None else, or for one or three.

    It is gross above 20 unless they are parallel, and for the weaker one alone if that is noise. A dead channel is not compared.
    """
    if len(candidate.peaks) != 2 or not all(_moves(component) for component, _ in candidate.peaks):
        return None
    (low, least), (high, most) = sorted(candidate.peaks, key=lambda peak: peak[1])
    if not most > UNEQUAL * least:
        return None
    text = f"PGA of {high.name} is {most / least:.3g} times that of {low.name}"
    if _is_noise(low.acceleration, high.acceleration):
        text = f"{text}, which shakes alike from the first to the last sample: noise"
        return Finding("unequal", text, gross=candidate.component is low)
    parallel = same_azimuth(low.orientation.azimuth, high.orientation.azimuth)  # and so of two records
    return Finding("unequal", f"{text}: check their gains", gross=most > FAINT * least and not parallel)


def copied_horizontal(candidate: Candidate) -> Finding | None:
    """Return a finding on a horizontal that is a copy of the station's other one, perhaps scaled and shifted; else None.

    None for a station with one or three horizontals, too, and for different sampling intervals.
    """
    this, others = candidate.component, [c for c, _ in candidate.peaks if c is not candidate.component]
    if len(candidate.peaks) != 2 or not others or not same_step(this.dt, others[0].dt):
        return None
    copy = copy_between(this.acceleration, others[0].acceleration)
    if copy is None:
        return None
    return Finding(
        "copy", f"it has the samples of {others[0].name}{_changes(copy, this.dt)}, square to it: check their files"
    )


def unlike_vertical(candidate: Candidate) -> Finding | None:
    """Return a finding on a vertical that is a copy of a horizontal, noise, or of another gain or unit; else None."""
    motion = candidate.motion
    if motion.vertical is None or not np.any(motion.vertical):
        return None
    most = max([motion.pga, *(peak for _, peak in candidate.peaks)])
    ratio = float(np.abs(motion.vertical).max() / max(most, 1e-300))
    faulty = not 1.0 / FAINT <= ratio <= UNEQUAL
    peers = {c.name: c.acceleration for c, _ in candidate.peaks if same_step(c.dt, motion.dt)}
    copies = (
        (name, copy_between(motion.vertical, a)) for name, a in (peers | {motion.name: motion.horizontal}).items()
    )
    if copied := next(((name, copy) for name, copy in copies if copy), None):
        name, copy = copied
        text = f"its vertical component has the samples of the horizontal one {name}{_changes(copy, motion.dt)}: check the file"
        return Finding("vertical", text, gross=faulty or abs(abs(copy.factor) - 1.0) <= _SAME_SIZE)
    size = f"PGA of its vertical component is {ratio:.3g} times that of the horizontal ones"
    if faulty:
        return Finding("vertical", f"{size}: check their gains", gross=True)
    if _is_noise(motion.vertical, motion.horizontal):
        text = "its vertical component shakes alike from the first to the last sample, and the ground does not: noise"
        return Finding("vertical", text, gross=True)
    if SELDOM_BELOW <= ratio <= SELDOM_ABOVE:
        return None
    return Finding(
        "vertical", f"{size}, as in few records; m/s² under a header of g make it 9.81 times: check its unit"
    )


def _changes(copy: Copy, dt: float) -> str:
    """Return in words how a copy differs from its original: " times 0.667, 0.05 s later"; "" for an equal copy."""
    times = "" if abs(copy.factor - 1.0) <= _SAME_SHAPE else f" times {copy.factor:.3g}"
    return times + (f", {abs(copy.delay) * dt:g} s {'later' if copy.delay > 0 else 'earlier'}" if copy.delay else "")


def _is_noise(samples: Samples, other: Samples) -> bool:
    """Return whether a series shakes alike from end to end, and the ``other`` one of its station does not."""
    return _growth_apart(samples) < STEADY and _growth_apart(other) > 2.0 * STEADY


def _growth_apart(samples: Samples) -> float:
    """Return the greatest distance of the normalised ∫a² dt from its straight line in time, 0 to 1."""
    energy = np.cumsum(np.square(samples))
    return float(np.abs(energy / (energy[-1] or 1.0) - np.arange(1, len(energy) + 1) / len(energy)).max())


def in_a_structure(candidate: Candidate) -> Finding | None:
    """Return a gross finding on a sensor on a structure or in a borehole, by its place or its station's name; else None."""
    where, text = _stand(candidate.component)
    if where is Stand.BOREHOLE:
        return Finding("borehole", f'"{text}" is in a borehole, and not at the surface', gross=True)
    if where is Stand.STRUCTURE:
        return Finding("structure", f'"{text}" is in a structure, and not on the ground', gross=True)
    return None


def in_a_borehole(component: Component) -> bool:
    """Return whether a sensor is in a borehole, by its place or its station's name."""
    return _stand(component)[0] is Stand.BOREHOLE


def _stand(component: Component) -> tuple[Stand, str]:
    """Return the location of a component's sensor, and the words that state it; KiK-net's first sensor is in a borehole."""
    if KIK_NET.match(component.name) and _FIRST_SENSOR.fullmatch(component.orientation.label.upper()):
        return Stand.BOREHOLE, component.name
    return stand(component.sensor.place or "", component.origin.station)


def lack_of_processing(candidate: Candidate) -> Finding | None:
    """Return a finding on an uncorrected record, not gross; None if corrected or unknown."""
    if candidate.motion.processed is not False:
        return None
    return Finding("unprocessed", "unprocessed: long-period noise not removed")


def findings_of_readers(candidate: Candidate) -> Finding | None:
    """Return the readers' findings on both components as one, named as the first and gross if any is; None without findings."""
    both = (*candidate.component.findings, *candidate.motion.findings)
    if not both:
        return None
    return Finding(both[0].what, "; ".join(finding.text for finding in both), any(finding.gross for finding in both))


JUDGES: tuple[Callable[[Candidate], Finding | None], ...] = (
    dead_channel,
    unlikely_peak,
    no_zero_line,
    alternation,
    flat_top,
    faulty_samples,
    incomplete_record,
    displacement,
    unequal_horizontals,
    copied_horizontal,
    unlike_vertical,
    in_a_structure,
    findings_of_readers,
    lack_of_processing,
)


def findings(candidate: Candidate) -> tuple[Finding, ...]:
    """Return the findings of all ``JUDGES`` on a motion, in their order; () if it has no oddity."""
    return tuple(finding for judge in JUDGES if (finding := judge(candidate)) is not None)


def gross_findings(component: Component) -> list[Finding]:
    """Return the gross findings on a component by itself, without those that a manifest confirms."""
    alone = Motion(
        component.name,
        component.dt,
        component.acceleration,
        initial=component.initial,
        processed=component.processed,
        confirm=("dt",),  # checked against the limits of recorders when it was read
    )
    return _unconfirmed(findings(Candidate(alone, component, (), GRAVITY)), component.confirmed)


def _unconfirmed(findings: Sequence[Finding], confirmed: Collection[str]) -> list[Finding]:
    """Return the gross findings that no key in ``confirmed`` confirms."""
    return [f for f in findings if f.gross and not {"confirm", f.key}.intersection(confirmed)]


def confirmation_request(name: str, findings: Sequence[Finding], confirmed: Collection[str]) -> str:
    """Return the gross findings on the motion ``name`` and how to confirm them; "" if all are confirmed, or there are none."""
    unconfirmed = _unconfirmed(findings, confirmed)
    if not unconfirmed:
        return ""
    key = unconfirmed[0].key if len(unconfirmed) == 1 else "confirm"
    return (
        f'{"; ".join(finding.text for finding in unconfirmed)}; if it is right, write {key} = ["{name}"] under [motions] '
        f"in the study, or {key} = true in motions.toml"
    )
