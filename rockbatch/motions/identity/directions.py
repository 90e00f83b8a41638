"""Directions of the components of a set, judged by all statements of them: angles, codes, headers, file names, and people.

A set is used if its statements agree, or if the disagreeing ones are known to be void: angles of 0°, which programs write by
default, and a header that was copied to all files of the set; a finding says so. If other statements contradict each other, or
samples differ that headers call one recording, the whole set is held back until the user states the directions in
motions.toml; those are not judged.
"""

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import combinations

import numpy as np

from rockbatch.common.grouping import grouped
from rockbatch.motions.component import UNKNOWN_SENSOR, Component
from rockbatch.motions.identity.common_span import overlap
from rockbatch.motions.identity.leaving_out import Reading
from rockbatch.motions.identity.likeness import pairs_of_one_recording
from rockbatch.motions.identity.stations import by_station
from rockbatch.motions.labels.evidence import Kind, Statement, decided_orientation, same_direction
from rockbatch.motions.labels.orientation import one_of_three, split_stem, unknown
from rockbatch.motions.motion import Finding

_COPIED = (Kind.CODE, Kind.HEADER)  # statements that programs copy from the first file to the others
_SQUARE = 5.0  # degrees by which the azimuths of a pair may be off a right angle
_IN_A_PLANE = 0.7  # deviation over both its terms, of their sums of squares: 0 in a plane, 1 for independent motions
_ALONE = 1e-6  # residual of a component along an axis that no other has
_NO_PLANE = Finding(
    "direction", "one of several horizontal directions of one sensor that are no motion in a plane: is one vertical?"
)
_ASKEW = 30.0  # degrees off a right angle beyond which no sensor is built


def judge_directions(readings: Sequence[Reading]) -> list[Reading]:
    """Return the readings, each component with its decided direction, or the contradiction for which its set is held back."""
    components = [reading for reading in readings if isinstance(reading, Component)]
    results: dict[int, Component] = {}
    for station in by_station(components):
        results |= zip(map(id, station), _judge_set(station), strict=True)
    return [results.get(id(reading), reading) if isinstance(reading, Component) else reading for reading in readings]


def _judge_set(station: Sequence[Component]) -> list[Component]:
    """Return the components of a set with their decided directions, or all held back if statements or directions contradict."""
    components = _copies_as_their_originals(_with_names(station))
    # copied headers are void whatever they say; only then can the remaining statements speak for or against angles of 0°
    void = [*_copied_headers(components), *_numbered_channels(components), *_void_defaults(components)]
    for i, statement, reason in void:
        components[i] = _without_statement(components[i], statement, reason)
    components = list(map(_with_believed_defaults, components))
    contradictions = {i: text for i, c in enumerate(components) if (text := _contradiction(c))}
    for i, j, text in _impossible_pairs(components, contradictions):
        contradictions.setdefault(i, text)
        contradictions.setdefault(j, text)
    if contradictions:  # the first holds the whole set back
        first, text = next(iter(contradictions.items()))
        of_set = f"of one set with {components[first].source}, which is held back: {text}"
        held = [replace(c, contradiction=contradictions.get(i, of_set)) for i, c in enumerate(components)]
        return [
            replace(c, orientation=unknown(c.orientation.label)) if i in contradictions else c
            for i, c in enumerate(held)
        ]
    doubts = [_NO_PLANE] if _leave_a_plane(components) else []
    return [_with_remark(component).with_findings(*doubts) for component in components]


def _by_user(component: Component) -> bool:
    """Return whether the user states the component's direction, or prefers it to its copies (``use = true``)."""
    return component.preferred or any(statement.kind is Kind.USER for statement in component.statements)


def _strong_statement(component: Component, *kinds: Kind) -> Statement | None:
    """Return a component's first statement of one of ``kinds`` that is not weak; ``None`` without any."""
    return next((s for s in component.statements if s.kind in kinds and not s.weak), None)


def _same_samples(a: Component, b: Component) -> bool:
    """Return whether two components have one step and equal samples."""
    return a.dt == b.dt and np.array_equal(a.acceleration, b.acceleration)


def _with_names(station: Sequence[Component]) -> list[Component]:
    """Return the components, their file names no longer weak statements if two or more give directions, and all different ones.

    "North" or "z" alone may be the name of a place or a copy; beside "East" it is a direction.
    """
    names = {i: s for i, c in enumerate(station) for s in c.statements if s.kind is Kind.NAME}
    if len(names) < 2 or any(same_direction(a.orientation, b.orientation) for a, b in combinations(names.values(), 2)):
        return list(station)
    named = []
    for i, c in enumerate(station):
        statements = (replace(s, weak=False) if s is names.get(i) else s for s in c.statements)
        named.append(replace(c, statements=tuple(statements)))
    return named


def _copies_as_their_originals(station: Sequence[Component]) -> list[Component]:
    """Return components, each contradictory one with the statements of a sound one of the same samples, if there is any."""
    components = list(station)
    for i, component in enumerate(station):
        if _contradiction(component):
            sound = (c for c in station if c is not component and not _contradiction(c) and _same_samples(c, component))
            if original := next(sound, None):
                components[i] = replace(component, statements=original.statements, orientation=original.orientation)
    return components


def _contradiction(component: Component) -> str:
    """Return the first two contradictory statements of a component in words; "" for none, or if :func:`_by_user`."""
    if _by_user(component):
        return ""
    pairs = combinations((s for s in component.statements if not (s.default or s.weak)), 2)
    first = next(((a, b) for a, b in pairs if a.contradicts(b)), None)
    return f"{first[0].words}, but {first[1].words}" if first else ""


def _copied_headers(components: Sequence[Component]) -> Iterator[tuple[int, Statement, str]]:
    """Yield place, statement and reason of codes or headers that give one direction for two or more components of a set.

    Their file names must all give directions, each another one; none is yielded if two components have the same samples. That
    verticals are positive down remains stated for one that is vertical by its name.
    """
    for kind in _COPIED:
        of_kind = [(i, s) for i, c in enumerate(components) if (s := _strong_statement(c, kind)) and not _by_user(c)]
        names = [name.orientation for i, _ in of_kind if (name := _strong_statement(components[i], Kind.NAME))]
        if len(of_kind) < 2 or len(names) < len(of_kind):
            continue
        alike = all(same_direction(s.orientation, of_kind[0][1].orientation) for _, s in of_kind)
        apart = not any(same_direction(a, b) for a, b in combinations(names, 2))
        copies = any(_same_samples(*pair) for pair in combinations([components[i] for i, _ in of_kind], 2))
        if alike and apart and not copies:
            for (i, statement), named in zip(of_kind, names, strict=True):
                if not (statement.orientation.down and named.vertical):  # whose sign may be stated by it alone
                    yield i, statement, "all files of its set have it"


def _numbered_channels(components: Sequence[Component]) -> Iterator[tuple[int, Statement, str]]:
    """Yield place, statement and reason of codes and headers without azimuth that number three components of a sensor.

    Of HN1, HN2 and HN3 the vertical one may be any, unless another component of the sensor is vertical.
    """
    of_sensors = grouped(components, lambda c: c.sensor)
    labels_of = {sensor: {c.orientation.label.upper() for c in alike} for sensor, alike in of_sensors.items()}
    verticals = Counter(c.sensor for c in components if c.orientation.vertical)
    for i, component in enumerate(components):
        if _by_user(component) or verticals[component.sensor] > component.orientation.vertical:
            continue
        labels = labels_of[component.sensor]
        for statement in component.statements:
            label = statement.orientation.label.upper()
            if statement.kind in _COPIED and statement.orientation.without_azimuth and one_of_three(label, labels):
                yield i, statement, f"beside {label[:-1]}3, which may be horizontal, it may be vertical"


def _void_defaults(components: Sequence[Component]) -> Iterator[tuple[int, Statement, str]]:
    """Yield place, statement and reason of angles of 0° that are void: other statements contradict them, or other components do.

    Other components of the sensor do if no other statement agrees, and one of them has the same angle, or one has an angle other
    than 0° and none has 90° or 270°, to 5°.
    """
    angles = [(i, s) for i, c in enumerate(components) if (s := _strong_statement(c, Kind.ANGLES)) and not _by_user(c)]
    for i, statement in (pair for pair in angles if pair[1].default):
        others = [s for s in components[i].statements if s is not statement and not s.weak]
        peers = [s.orientation for k, s in angles if k != i and components[k].sensor == components[i].sensor]
        if any(statement.differs_from(s) for s in others):
            void = True
        elif any(same_direction(statement.orientation, s.orientation) for s in others):
            void = False
        else:
            nonzero = [peer.azimuth for peer in peers if peer.azimuth]
            square = any(abs(azimuth % 180.0 - 90.0) <= _SQUARE for azimuth in nonzero)
            repeated = any(same_direction(statement.orientation, peer) for peer in peers)
            void = repeated or (bool(nonzero) and not square)
        if void:
            yield i, statement, "programs write 0° where they know no angle"


def _without_statement(component: Component, void: Statement, reason: str) -> Component:
    """Return a component without a ``void`` statement, its direction decided by the others, with a finding."""
    remaining = tuple(s for s in component.statements if s is not void)
    orientation = decided_orientation(remaining, component.orientation.label)
    believed = next((s for s in remaining if s.orientation is orientation), None)
    instead = f"decided by: {believed.words}" if believed else "its azimuth is stated nowhere else"
    finding = Finding("direction", f"{void.words}, which tells nothing ({reason}); {instead}")
    return replace(component, statements=remaining, orientation=orientation).with_findings(finding)


def _with_believed_defaults(component: Component) -> Component:
    """Return a component whose angles of 0° count as any others, since :func:`_void_defaults` did not find them void."""
    if not any(s.default for s in component.statements):
        return component
    statements = tuple(replace(s, default=False) for s in component.statements)
    return replace(
        component, statements=statements, orientation=decided_orientation(statements, component.orientation.label)
    )


def _with_remark(component: Component) -> Component:
    """Return a component with a finding if its channel code and its angles, which are believed, differ."""
    code, angles = _strong_statement(component, Kind.CODE), _strong_statement(component, Kind.ANGLES)
    if _by_user(component) or code is None or angles is None or not angles.differs_from(code):
        return component
    return component.with_findings(Finding("direction", f"{code.words}, but {angles.words}; decided by: these angles"))


def _impossible_pairs(
    components: Sequence[Component], contradictions: dict[int, str]
) -> Iterator[tuple[int, int, str]]:
    """Yield places of two components whose directions cannot both be right, and why: equal with other samples, or skew.

    Two components that the user states, and most with ``contradictions`` of their own, are not compared.
    """
    places = [i for i in range(len(components)) if i not in contradictions]
    pairs = {pair for pair in combinations(places, 2) if not all(_by_user(components[i]) for i in pair)}
    alike = [(i, j) for i, j in sorted(pairs) if same_direction(components[i].orientation, components[j].orientation)]
    for i, j in alike:
        if _of_one_sensor(components[i], components[j]) and not _same_samples(components[i], components[j]):
            yield i, j, f"{_components_and_statements(components[i], components[j])}: one direction, but other samples"
    horizontals = [i for i, c in enumerate(components) if not c.orientation.vertical]
    if len(horizontals) == 2 and tuple(horizontals) in pairs:
        i, j = horizontals
        if why := _skew_pair(components[i], components[j]):
            yield i, j, why
    if all(components[i].file == components[j].file for i, j in alike):
        return
    for a, b in pairs_of_one_recording([components[i] for i in places]).denied:
        if (pair := (places[a], places[b])) in pairs:
            said = _components_and_statements(*(components[i] for i in pair))
            yield *pair, f"{said}: one sensor, event and direction, but other samples"


def _of_one_sensor(a: Component, b: Component) -> bool:
    """Return whether two components are of one file, time and sensor; False for a sensor in the header unless both have angles.

    Such a file may hold the channels of a building.
    """
    if a.file != b.file or a.sensor != b.sensor or not overlap(a, b):
        return False
    return a.sensor == UNKNOWN_SENSOR or all(_strong_statement(c, Kind.ANGLES) for c in (a, b))


def _skew_pair(a: Component, b: Component) -> str:
    """Return a message on horizontals of one sensor over 30° off a right angle; "" for others, and equal or unknown azimuths."""
    first, second = a.orientation.azimuth, b.orientation.azimuth
    if a.sensor != b.sensor or first is None or second is None or same_direction(a.orientation, b.orientation):
        return ""
    if abs((first - second) % 180.0 - 90.0) <= _ASKEW:
        return ""
    return f"{_components_and_statements(a, b)} are {abs(first - second):g}° apart, and no sensor's horizontal components are"


def _leave_a_plane(components: Sequence[Component]) -> bool:
    """Return whether a set is horizontals of one sensor, not all stated by the user, that are no motion in a plane.

    Then one of them is not what the least squares of the others, turned to two axes, give in its direction. False for several
    sensors, columns whose labels differ in more than the direction, files of different steps or starts, and unknown azimuths.
    """
    azimuths = [c.orientation.azimuth for c in components if c.orientation.azimuth is not None]
    if not len(components) == len(azimuths) > 2 or all(map(_by_user, components)):
        return False
    sites = {site for site, way in (split_stem(c.orientation.label) for c in components) if way}
    if len({(c.sensor, c.start, c.dt) for c in components}) > 1 or len(sites) > 1:
        return False
    phi = np.radians(azimuths)
    shortest = min(len(c.acceleration) for c in components)
    samples = np.array([c.acceleration[:shortest] for c in components])
    axes = np.column_stack([np.cos(phi), np.sin(phi)])
    residual = np.eye(len(phi)) - axes @ np.linalg.pinv(axes)  # of the fit to all
    checked = residual.diagonal() > _ALONE
    deviations = (residual @ samples)[checked] / residual.diagonal()[checked, None]  # from the fit to all others
    energies = (samples[checked] ** 2 + (samples[checked] - deviations) ** 2).sum(axis=1)
    return bool(((deviations**2).sum(axis=1) > _IN_A_PLANE**2 * energies).any())


def _components_and_statements(*components: Component) -> str:
    """Return the sources of components, each with the statement that decides its direction, joined by "and"."""
    names = []
    for c in components:
        words = next((statement.words for statement in c.statements if statement.orientation is c.orientation), "")
        names.append(f"{c.source} ({words})" if words else c.source)
    return " and ".join(names)
