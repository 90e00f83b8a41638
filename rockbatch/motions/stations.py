"""Components of one station and recording, and those that count as one record.

:func:`by_station` finds a vertical for a horizontal within a folder. :func:`station_names` is about records: files in
several folders or formats, the parts of a long recording, and scaled copies are one record. What says nothing of its event
is a record of its own, unless a manifest's ``station`` joins it.
"""

import math
import re
from collections import Counter
from collections.abc import Hashable, Iterable, Iterator, Sequence
from itertools import combinations, pairwise

import numpy as np

from rockbatch.common.grouping import distinct, grouped
from rockbatch.motions.common_span import overlap
from rockbatch.motions.component import Component, file_of

_NUMBERED = re.compile(r"RSN\d+")
_HOUR = 3600.0  # s
_SAME_SHAPE = 1e-4  # of the peak: what printing a scaled copy may cost a sample


def is_numbered(site: str) -> bool:
    """Return whether a site is PEER's number of a record, which no other record has."""
    return _NUMBERED.fullmatch(site) is not None


def in_one_event(a: Component, b: Component) -> bool:
    """Return whether two components of one sensor or station are of one event: by their times, or by what they say of it."""
    return overlap(a, b) if a.dated and b.dated else bool(a.event) and a.event == b.event


def by_station(components: Iterable[Component]) -> list[list[Component]]:
    """Return components of one station, folder and time together, in order of their first ones: by header, then by name.

    Names join what headers leave without a vertical, or without a horizontal: components of the same RSN, and those
    of which one has no header that tells its station. Several files of one station that each hold a vertical and a
    horizontal, such as the parts of a long recording, are as many sets.
    """
    by_header = grouped(components, lambda c: (c.folder, c.station or id(c)))
    stations: list[list[Component]] = []
    by_name: dict[tuple[str, str, bool], list[Component]] = {}
    for group in (
        part
        for whole in by_header.values()
        for record in _by_time(whole)
        for of_file in _by_file(record)
        for part in _by_name(of_file)
    ):
        folder, headed = group[0].folder, bool(group[0].station)
        sites = list(dict.fromkeys(component.site for component in group if component.site))
        of_name = (by_name.get((folder, site, headed and not is_numbered(site))) for site in sites)
        station = next((candidate for candidate in of_name if candidate and _may_join(candidate, group)), None)
        if station is None:
            station = group
            stations.append(group)
        else:
            station += group
        for site in sites:
            by_name.setdefault((folder, site, False), station)
            if not headed:
                by_name.setdefault((folder, site, True), station)
    return stations


def _by_time(group: list[Component]) -> list[list[Component]]:
    """Return the records of one station: components that share time with others of theirs.

    Where times and events are not known, a direction that comes again is that of another recording: then each file, or
    each name of a station, is one.
    """
    if not all(component.dated for component in group):
        if all(component.event for component in group) or len(_directions(group)) == len(group):
            return [group]
        files = Counter(file_of(component.source) for component in group)
        return list(grouped(group, lambda c: (f, "") if files[f := file_of(c.source)] > 1 else ("", c.site)).values())
    records: dict[int, list[Component]] = {}
    end, place = -math.inf, {id(component): i for i, component in enumerate(group)}
    for component in sorted(group, key=lambda component: component.start or 0.0):
        start = component.start or 0.0
        records.setdefault(len(records) + (start >= end) - 1, []).append(component)
        end = max(end, start + component.duration)
    ordered = [sorted(record, key=lambda component: place[id(component)]) for record in records.values()]
    return sorted(ordered, key=lambda record: place[id(record[0])])


def _by_file(record: list[Component]) -> Iterator[list[Component]]:
    """Return one set for each file that holds a whole one, where several do, and one of the rest; else all together."""
    files = grouped(record, lambda c: file_of(c.source))
    whole = [components for components in files.values() if _is_whole(components)]
    if len(whole) < 2:
        yield record
        return
    yield from whole
    remainder = [component for components in files.values() if not _is_whole(components) for component in components]
    if remainder:
        yield remainder


def _by_name(record: list[Component]) -> list[list[Component]]:
    """Return one set for each name of a station, if a direction comes again and none does within a name of several; else all."""
    sites = grouped(record, lambda c: c.site)
    if len(_directions(record)) == len(record) or len(sites) < 2:
        return [record]
    whole = all(1 < len(_directions(members)) == len(members) for members in sites.values())
    return list(sites.values()) if whole else [record]


def _directions(components: Iterable[Component]) -> set[tuple[bool, float | None, str]]:
    """Return the directions of components, by azimuth and label."""
    return {(c.orientation.vertical, c.orientation.azimuth, c.orientation.label) for c in components}


def _may_join(station: Sequence[Component], group: Sequence[Component]) -> bool:
    """Return whether two sets of one name may be one recording: not if both are complete, nor if they do not overlap in time."""
    if _is_whole(station) and _is_whole(group):
        return False
    return any(overlap(member, component) for member in station for component in group)


def _is_whole(station: Sequence[Component]) -> bool:
    """Return whether there are both a vertical and a horizontal component."""
    return len({component.orientation.vertical for component in station}) == 2


def station_names(stations: Sequence[Sequence[Component]]) -> list[str]:
    """Return a name for each of ``stations``, as ``by_station`` has them; those of one record share theirs.

    It is PEER's number, the station by its header, or what the names of its files share; of several records of that name
    with the event, the folder or a number behind it.
    """
    root = list(range(len(stations)))

    def first_of(i: int) -> int:
        while root[i] != i:
            root[i] = i = root[root[i]]
        return i

    keyed = [(key, (i, c)) for i, station in enumerate(stations) for c in station for key in _keys(c)]
    for group in grouped(keyed, lambda pair: pair[0]).values():
        namesakes = [of_station for _, of_station in group]
        for pairs in (pairwise(namesakes), combinations(namesakes, 2)):  # neighbours first: mostly, that is all
            if len({first_of(i) for i, _ in namesakes}) > 1:
                for (i, a), (j, b) in pairs:
                    low, high = sorted((first_of(i), first_of(j)))
                    if low != high and (_together(a, b) or _copies(a, b)):
                        root[high] = low
    for i, j, k in _turned(stations):
        low = min(map(first_of, (i, j, k)))
        for station in (i, j, k):
            root[first_of(station)] = low
    records = list(dict.fromkeys(map(first_of, root)))
    firsts = [stations[i][0] for i in records]
    names = distinct(
        list(map(station_of, firsts)),
        lambda i, name: f"{firsts[i].sensor.network or ''}.{name}".strip("."),
        lambda i, name: f"{name} {firsts[i].event}".strip(),
        lambda i, name: f"{name} {firsts[i].folder.rsplit('/', 1)[-1]}".strip(),
    )
    name_of = dict(zip(records, names, strict=True))
    return [name_of[first_of(i)] for i in range(len(stations))]


def station_of(component: Component) -> str:
    """Return the name of a component's station: PEER's number, that of its header, or that of its file."""
    if is_numbered(component.site):
        return component.site
    return component.sensor.station.strip() or component.site or component.station or component.name


def _keys(component: Component) -> Iterator[Hashable]:
    """Return what components of one record may have in common: those that share nothing of it need not be compared.

    At a station that is an event, or an hour, in which both recorded, or their file.
    """
    places: list[Hashable] = [(component.folder, component.station)] if component.station else []
    places += [component.sensor.number.upper()] if component.sensor.number else []
    for place in places:
        if component.event:
            yield place, component.event
        if component.dated and component.start is not None:
            hours = (component.start // _HOUR, (component.start + component.duration) // _HOUR)
            yield from ((place, hour) for hour in range(int(hours[0]), int(hours[1]) + 1))
        if component.source:
            yield place, component.folder, file_of(component.source)
    if is_numbered(component.site):
        yield component.site
    peak = int(np.abs(component.acceleration).argmax())
    if component.acceleration[peak]:
        mean = float(np.square(component.acceleration / component.acceleration[peak]).mean())
        for half in (0.0, 0.5):  # what lies close together shares one of the two, whatever the rounding
            yield len(component.acceleration), peak, half, math.floor(mean / (10.0 * _SAME_SHAPE) + half)


def _together(a: Component, b: Component) -> bool:
    """Return whether headers, or PEER's numbers, say that both are of one station and earthquake, whatever sensor and stage."""
    if is_numbered(a.site) and is_numbered(b.site):
        return a.site == b.site
    if a.station and (a.folder, a.station) == (b.folder, b.station):
        return in_one_event(a, b) or (bool(a.source) and file_of(a.source) == file_of(b.source))
    first, second = a.sensor, b.sensor
    if not first.number or first.number.upper() != second.number.upper():
        return False
    return not (first.network and second.network and first.network != second.network) and in_one_event(a, b)


def _copies(a: Component, b: Component) -> bool:
    """Return whether the samples of both are the same but for a factor."""
    first, second = a.acceleration, b.acceleration
    if len(first) != len(second) or abs(a.dt - b.dt) > 1e-6 * a.dt:
        return False
    i = int(np.abs(first).argmax())
    if first[i] == 0 or second[i] == 0:
        return False
    return bool(np.abs(first / first[i] - second / second[i]).max() <= _SAME_SHAPE)


def _turned(stations: Sequence[Sequence[Component]]) -> Iterator[tuple[int, int, int]]:
    """Yield the places of three stations, some of which may be one, with horizontal components that are one pair turned to three
    directions: one of them is a combination of the others.

    Of three lines in a plane two are 60° apart at most, and their samples have a correlation of a half or more.
    """
    horizontals = [
        (i, c) for i, station in enumerate(stations) for c in station if not c.orientation.vertical and c.pga
    ]
    for alike in grouped(horizontals, lambda pair: (len(pair[1].acceleration), round(pair[1].dt, 9))).values():
        if len({i for i, _ in alike}) < 2 or len(alike) < 3:
            continue
        places = [i for i, _ in alike]
        samples = np.array([c.acceleration / np.linalg.norm(c.acceleration) for _, c in alike])
        cosines = samples @ samples.T
        close = (np.abs(cosines) >= 0.499) & (np.abs(cosines) < 1.0 - _SAME_SHAPE)
        for a, b in zip(*np.nonzero(np.triu(close, 1)), strict=True):
            g = cosines[a, b]
            in_plane = (cosines[a] ** 2 + cosines[b] ** 2 - 2.0 * g * cosines[a] * cosines[b]) / (1.0 - g**2)
            for c in np.flatnonzero(in_plane > 1.0 - _SAME_SHAPE**2 / (1.0 - g**2)):
                if c not in (a, b) and len({places[a], places[b], places[c]}) > 1:
                    yield places[a], places[b], places[int(c)]
