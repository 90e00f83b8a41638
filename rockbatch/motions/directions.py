"""Directions of the components of a set, judged by all that states them: angles, codes, headers, names of files, and people.

A set is used where its evidence agrees, or where what disagrees is known to tell nothing: angles of 0°, which programs write
where they know none, and a header that was copied to all files of the set. It says so then. Where other statements contradict
each other, or the samples contradict what headers say is one recording, the whole set is held back until somebody says what
is right, in motions.toml; what is stated there is not judged.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import combinations

import numpy as np

from rockbatch.motions.common_span import overlap
from rockbatch.motions.component import UNKNOWN_SENSOR, Component, file_of
from rockbatch.motions.evidence import Kind, Statement, same_direction, settled
from rockbatch.motions.leaving_out import Reading
from rockbatch.motions.likeness import pairs_of_one_recording
from rockbatch.motions.motion import Finding
from rockbatch.motions.orientation import unknown
from rockbatch.motions.stations import by_station

_COPIED = (Kind.CODE, Kind.HEADER)  # what programs copy from the first file to the others
_SQUARE = 5.0  # degrees that the azimuths of a pair may be off a right angle
_ASKEW = 30.0  # degrees off a right angle that no sensor's components are


def judged(readings: Sequence[Reading]) -> list[Reading]:
    """Return the readings with the directions of their components judged, and with what each set is held back for."""
    components = [reading for reading in readings if isinstance(reading, Component)]
    results: dict[int, Component] = {}
    for station in by_station(components):
        results |= zip(map(id, station), _judged(station), strict=True)
    return [results.get(id(reading), reading) if isinstance(reading, Component) else reading for reading in readings]


def _judged(station: Sequence[Component]) -> list[Component]:
    """Return the components of a set, judged."""
    components = _copies_as_their_originals(_with_names(station))
    for i, statement, reason in [*_copied_headers(components), *_defaults(components)]:
        components[i] = _without(components[i], statement, reason)
    components = list(map(_with_believed_defaults, components))
    contradictions = {i: text for i, c in enumerate(components) if (text := _contradiction(c))}
    for i, j, text in _twice(components, contradictions):
        contradictions.setdefault(i, text)
        contradictions.setdefault(j, text)
    if contradictions:
        return [_held(c, contradictions.get(i, ""), components, contradictions) for i, c in enumerate(components)]
    return [_with_remark(component) for component in components]


def _held(
    component: Component, contradiction: str, components: Sequence[Component], contradictions: dict[int, str]
) -> Component:
    """Return a component of a set as it is held back, if any of the set contradicts itself."""
    if contradiction:
        return replace(component, contradiction=contradiction, orientation=unknown(component.orientation.label))
    first, text = next(iter(contradictions.items()))
    return replace(component, contradiction=f"of one set with {components[first].source}, which is held back: {text}")


def _by_user(component: Component) -> bool:
    return component.preferred or any(statement.kind is Kind.USER for statement in component.statements)


def _stated(component: Component, *kinds: Kind) -> Statement | None:
    """Return what one of these kinds states of a component; ``None`` where it does not, or may mean something else."""
    return next((s for s in component.statements if s.kind in kinds and not s.weak), None)


def _same_samples(a: Component, b: Component) -> bool:
    return a.dt == b.dt and np.array_equal(a.acceleration, b.acceleration)


def _with_names(station: Sequence[Component]) -> list[Component]:
    """Return components whose files' names count: North and z may mean something else, but not if they tell a set apart."""
    names = {i: s for i, c in enumerate(station) for s in c.statements if s.kind is Kind.NAME}
    if len(names) < 2 or any(same_direction(a.orientation, b.orientation) for a, b in combinations(names.values(), 2)):
        return list(station)
    return [
        replace(c, statements=tuple(replace(s, weak=False) if s is names.get(i) else s for s in c.statements))
        for i, c in enumerate(station)
    ]


def _copies_as_their_originals(station: Sequence[Component]) -> list[Component]:
    """Return components, of which a copy whose file's name contradicts its header has the statements of its original."""
    components = list(station)
    for i, component in enumerate(station):
        if _contradiction(component):
            sound = (c for c in station if c is not component and not _contradiction(c) and _same_samples(c, component))
            if original := next(sound, None):
                components[i] = replace(component, statements=original.statements, orientation=original.orientation)
    return components


def _contradiction(component: Component) -> str:
    """Return the two statements on a component that contradict each other; empty where none do, or a person states it."""
    if _by_user(component):
        return ""
    pairs = combinations((s for s in component.statements if not (s.default or s.weak)), 2)
    first = next(((a, b) for a, b in pairs if a.contradicts(b)), None)
    return f"{first[0].words}, but {first[1].words}" if first else ""


def _copied_headers(components: Sequence[Component]) -> Iterator[tuple[int, Statement, str]]:
    """Yield the codes or headers that say the same of all files of a set, which their names tell apart."""
    for kind in _COPIED:
        of_kind = [(i, s) for i, c in enumerate(components) if (s := _stated(c, kind)) and not _by_user(c)]
        names = [name.orientation for i, _ in of_kind if (name := _stated(components[i], Kind.NAME))]
        if len(of_kind) < 2 or len(names) < len(of_kind):
            continue
        alike = all(same_direction(s.orientation, of_kind[0][1].orientation) for _, s in of_kind)
        apart = not any(same_direction(a, b) for a, b in combinations(names, 2))
        copies = any(_same_samples(*pair) for pair in combinations([components[i] for i, _ in of_kind], 2))
        if alike and apart and not copies:
            yield from ((i, statement, "all files of its set have it") for i, statement in of_kind)


def _defaults(components: Sequence[Component]) -> Iterator[tuple[int, Statement, str]]:
    """Yield the angles of 0° that tell nothing: another statement says otherwise, or several components have them."""
    angles = [(i, s) for i, c in enumerate(components) if (s := _stated(c, Kind.ANGLES)) and not _by_user(c)]
    for i, statement in (pair for pair in angles if pair[1].default):
        others = [s for s in components[i].statements if s is not statement and not s.weak]
        peers = [s.orientation for k, s in angles if k != i and components[k].sensor == components[i].sensor]
        if any(statement.differs_from(s) for s in others):
            tells_nothing = True
        elif any(same_direction(statement.orientation, s.orientation) for s in others):
            tells_nothing = False
        else:
            real = [peer.azimuth for peer in peers if peer.azimuth]
            square = any(abs(azimuth % 180.0 - 90.0) <= _SQUARE for azimuth in real)
            twice = any(same_direction(statement.orientation, peer) for peer in peers)
            tells_nothing = twice or (bool(real) and not square)
        if tells_nothing:
            yield i, statement, "programs write 0° where they know no angle"


def _without(component: Component, void: Statement, reason: str) -> Component:
    """Return a component whose direction does not follow from a statement that tells nothing, and which says so."""
    remaining = tuple(s for s in component.statements if s is not void)
    orientation = settled(remaining, component.orientation.label)
    believed = next((s for s in remaining if s.orientation is orientation), None)
    instead = f"decided by: {believed.words}" if believed else "nothing else tells its azimuth"
    finding = Finding("direction", f"{void.words}, which tells nothing ({reason}); {instead}")
    findings = (*component.findings, finding)
    return replace(component, statements=remaining, orientation=orientation, findings=findings)


def _with_believed_defaults(component: Component) -> Component:
    """Return a component whose angles of 0° count as others do, since nothing in its set is against them."""
    if not any(s.default for s in component.statements):
        return component
    statements = tuple(replace(s, default=False) for s in component.statements)
    return replace(component, statements=statements, orientation=settled(statements, component.orientation.label))


def _with_remark(component: Component) -> Component:
    """Return a component which says that its channel's code is that of another azimuth than its angles, which are believed."""
    code, angles = _stated(component, Kind.CODE), _stated(component, Kind.ANGLES)
    if _by_user(component) or code is None or angles is None or not angles.differs_from(code):
        return component
    finding = Finding("direction", f"{code.words}, but {angles.words}; decided by: these angles")
    return replace(component, findings=(*component.findings, finding))


def _twice(components: Sequence[Component], contradictions: dict[int, str]) -> Iterator[tuple[int, int, str]]:
    """Yield components that cannot both point as is stated, and why: two series of one sensor along one direction, or askew."""
    places = [i for i in range(len(components)) if i not in contradictions]
    pairs = {pair for pair in combinations(places, 2) if not all(_by_user(components[i]) for i in pair)}
    alike = [(i, j) for i, j in sorted(pairs) if same_direction(components[i].orientation, components[j].orientation)]
    for i, j in alike:
        if _of_one_sensor(components[i], components[j]) and not _same_samples(components[i], components[j]):
            yield i, j, f"{_said(components[i], components[j])}: one direction, but other samples"
    across = [i for i, c in enumerate(components) if not c.orientation.vertical]
    if len(across) == 2 and tuple(across) in pairs and (why := _askew(*(components[i] for i in across))):
        yield across[0], across[1], why
    if all(file_of(components[i].source) == file_of(components[j].source) for i, j in alike):
        return
    for a, b in pairs_of_one_recording([components[i] for i in places]).denied:
        if (pair := (places[a], places[b])) in pairs:
            said = _said(*(components[i] for i in pair))
            yield *pair, f"{said}: one sensor, event and direction, but other samples"


def _of_one_sensor(a: Component, b: Component) -> bool:
    """Return whether components of one file are of one table, or of one sensor: other files may have those of a building."""
    if file_of(a.source) != file_of(b.source) or a.sensor != b.sensor or not overlap(a, b):
        return False
    return a.sensor == UNKNOWN_SENSOR or all(_stated(c, Kind.ANGLES) for c in (a, b))


def _askew(a: Component, b: Component) -> str:
    """Return that the horizontal components of one sensor are far from square to each other; empty where they are not."""
    first, second = a.orientation.azimuth, b.orientation.azimuth
    if a.sensor != b.sensor or first is None or second is None or same_direction(a.orientation, b.orientation):
        return ""
    if abs((first - second) % 180.0 - 90.0) <= _ASKEW:
        return ""
    return f"{_said(a, b)} are {abs(first - second):g}° apart, and no sensor's horizontal components are"


def _said(*components: Component) -> str:
    """Return the files of components, each with what states its direction."""
    words = [
        [statement.words for statement in c.statements if statement.orientation is c.orientation] for c in components
    ]
    return " and ".join(
        f"{c.source} ({said[0]})" if said else c.source for c, said in zip(components, words, strict=True)
    )
