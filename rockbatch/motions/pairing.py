"""From components to motions: every horizontal one with its station's vertical, on common samples."""

import re
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import PurePosixPath
from typing import Literal

import numpy as np

from rockbatch.common.errors import Contradiction, InputError, NoDirection
from rockbatch.common.grouping import distinct, grouped
from rockbatch.common.showing import shown
from rockbatch.common.units import GRAVITY
from rockbatch.motions.azimuths import rotated_to
from rockbatch.motions.common_span import on_common_samples, overlap, too_unlike
from rockbatch.motions.component import Component
from rockbatch.motions.measures import state_at
from rockbatch.motions.motion import Finding, Motion, Unusable
from rockbatch.motions.motion_set import MotionSet
from rockbatch.motions.orientation import same_azimuth
from rockbatch.motions.origin import directed
from rockbatch.motions.plausible import ANY, Judged, doubt, findings, fits
from rockbatch.motions.stations import by_station, station_names, station_of

_NO_VERTICAL = (
    "has no vertical component, and the study requires it; put it beside the record, or write vertical = true under "
    "[motions]"
)
_NEVER_MOVES = 1e-6  # of the horizontal peak: what is left of an offset that was taken off
_MOST_OF_IT = 0.95  # of the horizontal peak: what a vertical that ends early may cost


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
    """Return the motions of ``components`` in their order, then of those of a package.

    Components belong together that share folder and station by their headers, else by their names; those of a
    package (no folder) join the files of the same RSN, whose own component of that azimuth goes first. With
    ``azimuths`` [degrees] a station's horizontals are turned to each of them. Components of unknown direction, verticals
    that find no partner, or that are not the only one, what cannot be turned, motions without a vertical where it is
    required, and those that are grossly odd and whose name no pattern in ``confirmed`` fits (nor in ``confirmed_pga``,
    for their PGA), come back as unusable with the reason.
    """
    unusable = [
        Unusable(c.name, c.source, _question(c), c.orientation.label, station=station_of(c), kind=kind)
        for c in components
        if (kind := _why_held(c)) is not None
    ]
    components = _with_packaged([c for c in components if _why_held(c) is None], packaged)
    stations = by_station(components)
    number = {id(c): i for i, station in enumerate(stations) for c in station}
    known_as = station_names(stations)
    verticals = [[c for c in station if c.orientation.vertical] for station in stations]
    horizontals = [(number[id(c)], c) for c in components if not c.orientation.vertical]
    if azimuths:
        horizontals, not_turned = _turned(horizontals, azimuths, known_as)
        unusable += not_turned

    used: set[int] = set()
    motions: list[Motion] = []
    for station, component in horizontals:
        notes = [*component.notes]
        partner = None
        if vertical:
            together = [v for v in _candidates(component, station, verticals) if overlap(component, v)]
            partner, refused = _partner(component, together)
            notes += [f"no vertical: {v.source}: {obstacle}" for v, obstacle in refused]
            unusable += [
                Unusable(v.name, v.source, obstacle, station=known_as[number[id(v)]])
                for v, obstacle in refused
                if id(v) not in used
            ]
            used.update(id(v) for v in together)
        motion = _motion(component, partner, notes)
        lacking = bool(vertical) and motion.vertical is None
        motions.append(replace(motion, station=known_as[station], lacks_vertical=lacking))
    if vertical:
        reason = "a vertical component without a usable horizontal one of its station in its folder"
        unused = [v for group in verticals for v in group if id(v) not in used]
        unusable += [
            Unusable(v.name, v.source, f"{reason} ({v.station or v.site})", station=known_as[number[id(v)]])
            for v in unused
        ]
    peaks = [[(c, c.pga) for c in station if not c.orientation.vertical] for station in stations]
    named = _named(motions, [c.folder for _, c in horizontals])
    judged = [
        Judged(motion, component, peaks[station], gravity)
        for motion, (station, component) in zip(named, horizontals, strict=True)
    ]
    patterns = {"confirm": confirmed, "confirm_pga": confirmed_pga}
    paired = _believed(judged, patterns, required=vertical == "required")
    return replace(paired, unusable=sorted([*unusable, *paired.unusable], key=lambda u: u.source))


def _believed(judged: Iterable[Judged], patterns: Mapping[str, Sequence[str]], required: bool) -> MotionSet:
    """Return motions with what is odd about them in their notes; those that have to be confirmed, or to have a vertical that
    is ``required``, as unusable. ``patterns``: of the names that each key confirms."""
    motions: list[Motion] = []
    unusable: list[Unusable] = []
    for station in judged:
        motion, motion_findings = station.motion, findings(station)
        keys = {*station.component.confirmed, *(key for key, names in patterns.items() if fits(motion.name, names))}
        if motion.lacks_vertical and required:
            reason = f"{motion.label} {_NO_VERTICAL}"
            unusable.append(Unusable(motion.name, motion.files, reason, station=motion.of_station))
        elif refusal := doubt(motion.name, motion_findings, keys):
            held = replace(motion, findings=motion_findings)
            unusable.append(Unusable(motion.name, motion.files, refusal, station=motion.of_station, motion=held))
        else:
            remarks = [f"confirmed: {finding.text}" if finding.gross else finding.text for finding in motion_findings]
            motions.append(replace(motion, findings=motion_findings, notes=(*motion.notes, *remarks)))
    return MotionSet(motions, unusable)


def _why_held(component: Component) -> type[InputError] | None:
    """Return the kind of what somebody has to say about a component before it is used; ``None`` if nothing."""
    if component.contradiction:
        return Contradiction
    return None if component.orientation.known else NoDirection


def _question(component: Component) -> str:
    """Return which statement a component of unknown direction lacks, or which contradict each other, and where to write it."""
    if component.contradiction:
        return (
            f"{component.contradiction}; in motions.toml, which `rockbatch motions FOLDER --write-manifest` drafts, write what "
            'is right of each that contradicts itself: role = "horizontal" or "vertical", azimuth = …, or use = false'
        )
    label = component.orientation.label
    one_of_several = bool(label) and component.source.endswith(f"({label})")
    place = f"component = {shown(label)}" if one_of_several else "it"
    return (
        f"direction not known{f' from {shown(label)}' if label else ''}: in motions.toml, which `rockbatch motions FOLDER "
        f'--write-manifest` drafts, write role = "horizontal" or "vertical", or azimuth = …, for {place}; where none of '
        'those that do not say is vertical, role = "horizontal" under [motions] in the study, or --role horizontal'
    )


def _with_packaged(files: Sequence[Component], packaged: Sequence[Component]) -> list[Component]:
    """Return components of files, and those of a package that no file has; files say in whose place they are used."""
    components, added = list(files), []
    for component in packaged:
        azimuth = component.orientation.azimuth
        replaced = [
            i for i, file in enumerate(components)
            if file.site == component.site and same_azimuth(file.orientation.azimuth, azimuth)
        ]  # fmt: skip
        added += [] if replaced else [component]
        for i in replaced:
            note = f"used instead of {component.name} of {component.source}"
            components[i] = replace(components[i], notes=(*components[i].notes, note))
    return components + added


def _turned(
    horizontals: Sequence[tuple[int, Component]], azimuths: Sequence[float], known_as: Sequence[str]
) -> tuple[list[tuple[int, Component]], list[Unusable]]:
    """Return horizontals of files with the numbers of their stations, turned; a package's are as they were asked for.

    ``known_as`` has the names of the stations.
    """
    turned: list[tuple[int, Component]] = []
    unusable: list[Unusable] = []
    for station, group in grouped([pair for pair in horizontals if pair[1].folder], lambda pair: pair[0]).items():
        along, refused = rotated_to([component for _, component in group], azimuths)
        turned += [(station, component) for component in along]
        unusable += [replace(component, station=known_as[station]) for component in refused]
    return turned + [pair for pair in horizontals if not pair[1].folder], unusable


def _candidates(horizontal: Component, station: int, verticals: Sequence[Sequence[Component]]) -> Sequence[Component]:
    """Return vertical components of the horizontal one's station; a package's takes those of the first folder with its RSN."""
    if horizontal.folder or not horizontal.site:
        return verticals[station]
    of_site = [v for group in verticals for v in group if v.site == horizontal.site]
    first = min((v.folder for v in of_site), default="")
    return [v for v in of_site if v.folder == first]


def _partner(h: Component, together: Sequence[Component]) -> tuple[Component | None, list[tuple[Component, str]]]:
    """Return which of the vertical components of its station and time goes with a horizontal one; the others, and why not."""
    judged = [(v, _dead(h, v) or too_unlike(h, v)) for v in together]
    refused, fitting = [pair for pair in judged if pair[1]], [v for v, obstacle in judged if not obstacle]
    if len(fitting) < 2:
        return (fitting[0] if fitting else None), refused
    names = ", ".join(v.source for v in fitting)
    reason = f"several vertical components of one station ({names}): keep one of them"
    return None, [*refused, *((v, reason) for v in fitting)]


def _dead(h: Component, v: Component) -> str:
    """Return that a vertical component never moves, while the horizontal one does; empty where it does."""
    still = float(np.ptp(v.acceleration)) <= _NEVER_MOVES * h.pga
    return "it never moves: a dead channel" if still and h.pga > 0.0 else ""


def _motion(h: Component, v: Component | None, notes: Iterable[str]) -> Motion:
    """Return the motion of a horizontal component and its vertical one."""
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
        source=h.source,
        vertical_source=v.source if v is not None else "",
        notes=tuple(remarks),
        azimuth=h.orientation.azimuth,
        magnitude=h.magnitude,
        distance_km=h.distance_km,
        initial=initial,
        processed=h.processed,
        findings=gross,
        origin=directed(h.origin, h.orientation),
        start=start,
        confirm=("dt",),  # recorders and their formats have limits of their own
        listed=h.listed,
    )


def _named(motions: Sequence[Motion], folders: Sequence[str]) -> list[Motion]:
    """Return motions of which those of one name get the suffix of their files, then their folder, then a number."""
    in_folder = Counter((folder, motion.name) for folder, motion in zip(folders, motions, strict=True))

    def with_suffix(i: int, name: str) -> str:
        first = motions[i].source.partition(" + ")[0]  # of a pair that was turned
        file = PurePosixPath(re.sub(r"(?i)(\.gz)?( \(.*\))?$", "", first))
        clashes = in_folder[folders[i], name] > 1 and name.startswith(file.stem)
        return file.name + name[len(file.stem) :] if clashes else name

    def with_folder(i: int, name: str) -> str:
        return f"{folders[i].rsplit('/', 1)[-1]}/{name}" if folders[i] else name

    names = distinct([motion.name for motion in motions], with_suffix, with_folder)
    pairs = zip(motions, names, strict=True)
    return [motion if motion.name == name else replace(motion, name=name) for motion, name in pairs]
