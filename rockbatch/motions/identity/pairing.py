"""From components to motions: every horizontal one with its station's vertical, on common samples."""

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Literal

import numpy as np

from rockbatch.common.errors import Contradiction, NoDirection
from rockbatch.common.grouping import distinct, grouped
from rockbatch.common.naming import fits_any
from rockbatch.common.showing import shown
from rockbatch.common.units import GRAVITY
from rockbatch.motions.alignment import same_step
from rockbatch.motions.component import Component
from rockbatch.motions.identity.azimuths import components_along
from rockbatch.motions.identity.common_span import on_common_samples, overlap, too_unlike
from rockbatch.motions.identity.stations import by_station, is_numbered, station_names, station_of
from rockbatch.motions.intensity.measures import state_at
from rockbatch.motions.labels.orientation import same_azimuth
from rockbatch.motions.labels.origin import with_direction
from rockbatch.motions.motion import Finding, Motion
from rockbatch.motions.motion_set import MotionSet
from rockbatch.motions.quality.plausible import ANY, Candidate, confirmation_request, findings, in_a_borehole
from rockbatch.motions.sources.archives import bare
from rockbatch.motions.sources.source import Source, file_of
from rockbatch.motions.unused import Unusable

_NO_VERTICAL = (
    "has no vertical component, and the study requires it; put it beside the record, or write vertical = true under "
    "[motions]"
)
_NEVER_MOVES = 1e-6  # of the horizontal peak: rounding left by the removal of an offset
_MOST_OF_IT = 0.95  # of the horizontal peak, which must remain within a shorter vertical's time


def to_motions(
    components: Sequence[Component],
    packaged: Sequence[Component] = (),
    *,
    vertical: bool | Literal["required"] = True,
    gravity: float = GRAVITY,
    azimuths: Sequence[float] = (),
    confirmed: Sequence[str] = ANY,
    confirmed_pga: Sequence[str] = (),
) -> MotionSet:
    """Return a motion for each horizontal of ``components`` in their order, then of a package's, with its vertical.

    Components belong together that share folder and station by their headers, else by their names; a package's (without
    folder) join the files of the same RSN, whose own component of that azimuth is preferred. With ``azimuths`` [degrees] a
    station's horizontals are rotated to each of them. Unusable, with the reason, are components of unknown direction,
    verticals without a horizontal or beside another vertical, horizontals that cannot be rotated, motions without a required
    vertical, and grossly odd ones unless a pattern in ``confirmed`` matches their name, or in ``confirmed_pga`` for their PGA.
    """
    unusable: list[Unusable] = []
    sound: list[Component] = []
    for c in components:
        if c.orientation.known and not c.contradiction:
            sound.append(c)
        else:
            kind = Contradiction if c.contradiction else NoDirection
            question, label = _direction_question(c), c.orientation.label
            unusable.append(Unusable(c.name, c.sources, question, label, station=station_of(c), kind=kind))
    components = _with_steps_compared(_with_packaged(sound, packaged))
    stations = by_station(components)
    number = {id(c): i for i, station in enumerate(stations) for c in station}
    known_as = station_names(stations)
    verticals = [[c for c in station if c.orientation.vertical] for station in stations]
    horizontals = [(number[id(c)], c) for c in components if not c.orientation.vertical]
    if azimuths:
        horizontals, not_turned = _rotate_horizontals(horizontals, azimuths, known_as)
        unusable += not_turned

    used: set[int] = set()
    motions: list[Motion] = []
    for station, component in horizontals:
        notes = [*component.notes]
        partner = None
        if vertical:
            below = in_a_borehole(component)  # whose vertical is there, too
            at_place = [v for v in _candidates(component, station, verticals) if in_a_borehole(v) is below]
            together = [v for v in at_place if overlap(component, v)]
            partner, refused = _partner(component, together)
            for v, obstacle in refused:
                notes.append(f"no vertical: {v.source}: {obstacle}")
                if id(v) not in used:  # else it was listed with its station's other horizontal
                    unusable.append(Unusable(v.name, v.sources, obstacle, station=known_as[number[id(v)]]))
            used.update(id(v) for v in together)
        motions.append(_motion(component, partner, notes, known_as[station], requested=bool(vertical)))
    if vertical:
        for v in (v for group in verticals for v in group if id(v) not in used):
            others = [c for c in components if number[id(c)] != number[id(v)]]
            unusable.append(Unusable(v.name, v.sources, _why_alone(v, others), station=known_as[number[id(v)]]))
    peaks = [[(c, c.pga) for c in station if not c.orientation.vertical] for station in stations]
    named = _with_unique_names(motions, [c.own_folder or c.folder for _, c in horizontals])
    pairs = zip(named, horizontals, strict=True)
    candidates = [Candidate(motion, component, peaks[station], gravity) for motion, (station, component) in pairs]
    patterns = {"confirm": confirmed, "confirm_pga": confirmed_pga}
    paired = _confirmed_motions(candidates, patterns, required=vertical == "required")
    return replace(paired, unusable=sorted([*unusable, *paired.unusable], key=lambda u: u.source))


def _confirmed_motions(
    candidates: Iterable[Candidate], patterns: Mapping[str, Sequence[str]], required: bool
) -> MotionSet:
    """Return the motions with findings, as notes too; as unusable those to be confirmed, or without a ``required`` vertical."""
    motions: list[Motion] = []
    unusable: list[Unusable] = []
    for candidate in candidates:
        motion, motion_findings = candidate.motion, findings(candidate)
        by_study = {key for key, names in patterns.items() if fits_any(motion.name, names)}
        keys = by_study.union(candidate.component.confirmed)
        if motion.lacks_vertical and required:
            reason = f"{motion.label} {_NO_VERTICAL}"
            unusable.append(Unusable(motion.name, motion.sources, reason, station=motion.of_station))
        elif refusal := confirmation_request(motion.name, motion_findings, keys):
            held = replace(motion, findings=motion_findings)
            unusable.append(Unusable(motion.name, motion.sources, refusal, station=motion.of_station, motion=held))
        else:
            remarks = [f"confirmed: {finding.text}" if finding.gross else finding.text for finding in motion_findings]
            notes = (*motion.notes, *remarks)
            motions.append(replace(motion, findings=motion_findings, notes=notes) if remarks else motion)
    return MotionSet(motions, unusable)


def _direction_question(component: Component) -> str:
    """Return the request to state the direction of a component, unknown or contradictory, in motions.toml."""
    if component.contradiction:
        return (
            f"{component.contradiction}; in motions.toml, which `rockbatch motions FOLDER --write-manifest` drafts, write for "
            'each file in contradiction what is right: role = "horizontal" or "vertical", azimuth = …, or use = false'
        )
    label = component.orientation.label
    one_of_several = bool(label) and Source(component.file, label) in component.sources
    place = f"component = {shown(label)}" if one_of_several else "it"
    return (
        f"direction not known{f' from {shown(label)}' if label else ''}: in motions.toml, which `rockbatch motions FOLDER "
        f'--write-manifest` drafts, write role = "horizontal" or "vertical", or azimuth = …, for {place}; if no component of '
        'unknown direction is vertical, role = "horizontal" under [motions] in the study, or --role horizontal'
    )


def _why_alone(v: Component, others: Sequence[Component]) -> str:
    """Return why a vertical has no horizontal, by the components of ``others`` than its own record.

    Its station has none, several of PEER's records, of which it names none, or several sets without dates.
    """
    of_station = [c for c in others if v.station and (c.folder, c.station) == (v.folder, v.station)]
    of_station = [c for c in of_station if not c.orientation.vertical]
    records = sorted({c.site for c in of_station if is_numbered(c.site)})
    if len(records) > 1 and not is_numbered(v.site):
        return f"a vertical component of {' or '.join(records)}: begin its name with the number"
    if of_station and not is_numbered(v.site) and not (v.dated and all(c.dated for c in of_station)):
        return "a vertical component of one of several sets that state one station: give each set a folder of its own"
    return f"a vertical component without a usable horizontal one of its station in its folder ({station_of(v)})"


def _with_packaged(files: Sequence[Component], packaged: Sequence[Component]) -> list[Component]:
    """Return the components of files, with a note if used for a package's of this site and azimuth, then the package's others."""
    components, added = list(files), []
    for component in packaged:
        azimuth, found = component.orientation.azimuth, False
        note = f"used instead of {component.name} of {component.source}"
        for i, file in enumerate(components):
            if file.site == component.site and same_azimuth(file.orientation.azimuth, azimuth):
                components[i] = replace(file, notes=(*file.notes, note))
                found = True
        if not found:
            added.append(component)
    return components + added


def _with_steps_compared(components: Sequence[Component]) -> list[Component]:
    """Return the components, with a finding on those with as many samples as most of their set at another step.

    Copies whose steps differ have one already.
    """
    findings: dict[int, Finding] = {}
    for station in by_station(components):
        for alike in grouped(station, lambda c: len(c.acceleration)).values():
            usual = Counter(c.dt for c in alike).most_common(1)[0][0]
            first = next(c for c in alike if c.dt == usual)
            for c in alike:
                if not (same_step(c.dt, usual) or any(finding.what == "step" for finding in c.findings)):
                    said = f"{first.source} has as many samples with a step of {usual:g} s, not {c.dt:g} s"
                    findings[id(c)] = Finding("step", f"{said}: check which step is right")
    return [c.with_findings(*filter(None, [findings.get(id(c))])) for c in components]


def _rotate_horizontals(
    horizontals: Sequence[tuple[int, Component]], azimuths: Sequence[float], known_as: Sequence[str]
) -> tuple[list[tuple[int, Component]], list[Unusable]]:
    """Return horizontals with their stations' numbers, those of files rotated to ``azimuths``, and those that cannot be."""
    turned: list[tuple[int, Component]] = []
    unusable: list[Unusable] = []
    for station, group in grouped([pair for pair in horizontals if pair[1].folder], lambda pair: pair[0]).items():
        along, refused = components_along([component for _, component in group], azimuths)
        turned += [(station, component) for component in along]
        unusable += [replace(component, station=known_as[station]) for component in refused]
    return turned + [pair for pair in horizontals if not pair[1].folder], unusable


def _candidates(horizontal: Component, station: int, verticals: Sequence[Sequence[Component]]) -> Sequence[Component]:
    """Return the verticals of a horizontal component's station; for a package's, those of its RSN in the first folder."""
    if horizontal.folder or not horizontal.site:
        return verticals[station]
    of_site = [v for group in verticals for v in group if v.site == horizontal.site]
    first = min((v.folder for v in of_site), default="")
    return [v for v in of_site if v.folder == first]


def _partner(h: Component, together: Sequence[Component]) -> tuple[Component | None, list[tuple[Component, str]]]:
    """Return the only suitable vertical of those ``together`` with a horizontal component, and the refused ones with reasons."""
    obstacles = []
    for v in together:
        dead = h.pga > 0.0 and float(np.ptp(v.acceleration)) <= _NEVER_MOVES * h.pga
        obstacles.append((v, "it never moves: a dead channel" if dead else too_unlike(h, v)))
    refused, suitable = [pair for pair in obstacles if pair[1]], [v for v, obstacle in obstacles if not obstacle]
    if len(suitable) < 2:
        return (suitable[0] if suitable else None), refused
    names = ", ".join(v.source for v in suitable)
    reason = f"several vertical components of one station ({names}): keep one of them"
    return None, [*refused, *((v, reason) for v in suitable)]


def _motion(h: Component, v: Component | None, notes: Iterable[str], station: str, requested: bool) -> Motion:
    """Return the motion of a horizontal and its vertical component over their common time; of ``h`` alone if that lacks its peak.

    It lacks the peak if less than 95 % of it remains. ``notes`` come before those on this; ``requested`` is whether a vertical
    component is asked for.
    """
    remarks = list(notes)
    dt, horizontal, vertical, initial, start = h.dt, h.acceleration, None, h.initial, h.start
    if v is not None:
        common = on_common_samples(h, replace(v, acceleration=v.upward), ("horizontal", "vertical"))
        if len(common.first) < 2 or np.abs(common.first).max() < _MOST_OF_IT * h.pga:
            remarks.append(f"no vertical: {v.source} does not last over the horizontal peak")
            v = None
        else:
            dt, horizontal, vertical = common.dt, common.first, common.second
            initial = h.initial and state_at(h.acceleration, h.dt, h.initial, common.begins[0])
            start = h.start if h.start is None else h.start + common.begins[0]
            remarks += common.notes
    gross: tuple[Finding, ...] = ()
    if v is not None:
        gross = tuple(
            replace(f, text=f"vertical: {f.text}") for f in v.findings if f.gross and "confirm" not in v.confirmed
        )
        remarks += [f"vertical: {note}" for note in (*v.notes, *(f.text for f in v.findings if not f.gross))]
        if v.orientation.down:
            remarks.append(f"vertical: {v.orientation.label or 'component'} is positive down, sign reversed")
    return Motion(
        name=h.name,
        dt=dt,
        horizontal=horizontal,
        vertical=vertical,
        source=h.sources[0] if len(h.sources) == 1 else h.source,
        vertical_source=v.sources[0] if v is not None and v.sources else "",
        component_sources=(*h.sources, *(() if v is None else v.sources)) if len(h.sources) > 1 else (),
        notes=tuple(remarks),
        azimuth=h.orientation.azimuth,
        magnitude=h.magnitude,
        distance_km=h.distance_km,
        initial=initial,
        processed=h.processed,
        findings=gross,
        origin=with_direction(h.origin, h.orientation),
        lacks_vertical=requested and vertical is None,
        station=station,
        start=start,
        confirm=("dt",),  # a file's step was checked against the limits of recorders (limits.py)
        listed=h.listed,
        turned=h.turned,
    )


def _with_unique_names(motions: Sequence[Motion], folders: Sequence[str]) -> list[Motion]:
    """Return the motions with unique names: equal ones get suffixes of files in one folder, then two folders, then numbers."""
    in_folder = Counter((folder, motion.name) for folder, motion in zip(folders, motions, strict=True))

    def with_suffix(i: int, name: str) -> str:
        file = bare(Path(file_of(*motions[i].sources)))
        clashes = in_folder[folders[i], name] > 1 and name.startswith(file.stem)
        return file.name + name[len(file.stem) :] if clashes else name

    def with_folder(i: int, name: str) -> str:
        return f"{Path(folders[i]).name}/{name}" if folders[i] else name

    def with_folder_above(i: int, name: str) -> str:
        alike = in_folder[folders[i], motions[i].name] > 1  # which no folder tells apart
        return name if alike or not folders[i] else f"{Path(folders[i]).parent.name}/{name}"

    names = distinct([motion.name for motion in motions], with_suffix, with_folder, with_folder_above)
    pairs = zip(motions, names, strict=True)
    return [motion if motion.name == name else replace(motion, name=name) for motion, name in pairs]
