"""Components of one station and recording, and those that count as one record.

:func:`by_station` groups horizontals with their vertical within a folder. :func:`station_names` groups records: files in several
folders or formats, the parts of a long recording, and scaled copies are one record. A component without an event is a record by
itself, unless a manifest's ``station`` joins it to others.
"""

import math
import re
from collections import Counter
from collections.abc import Hashable, Iterable, Iterator, Sequence
from datetime import UTC, datetime
from itertools import combinations, pairwise

import numpy as np

from rockbatch.common.grouping import distinct, grouped
from rockbatch.motions.component import Component
from rockbatch.motions.identity.common_span import overlap
from rockbatch.motions.identity.planes import in_one_plane

_NUMBERED = re.compile(r"RSN\d+")
_HOUR = 3600.0  # s
_SAME_SHAPE = 1e-4  # of the peak: rounding of a sample in a printed, scaled copy


def is_numbered(site: str) -> bool:
    """Return whether a site is PEER's unique number of a record: "RSN779"."""
    return _NUMBERED.fullmatch(site) is not None


def in_one_event(a: Component, b: Component) -> bool:
    """Return whether two components of one station are of one event, by their dates, else by their headers' event.

    False without either.
    """
    return overlap(a, b) if a.dated and b.dated else bool(a.event) and a.event == b.event


def by_station(components: Iterable[Component]) -> list[list[Component]]:
    """Return components grouped by station, folder and time, in order of first ones: by header, then by file name.

    Names join groups that lack a vertical or a horizontal: those of one RSN, and those of which one has no station in its
    header. Files of one station that each hold a vertical and a horizontal, such as the parts of a long recording, are
    groups of their own.
    """
    stations: list[list[Component]] = []
    by_name: dict[tuple[str, str, bool], list[Component]] = {}
    for group in _by_header(components):
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


def _by_header(components: Iterable[Component]) -> Iterator[list[Component]]:
    """Yield components of one folder and one station by their headers, split by number, time, file and name."""
    for station in grouped(components, lambda c: (c.folder, c.station or id(c))).values():
        for of_number in _by_number(station):
            for record in _by_time(of_number):
                for of_file in _by_file(record):
                    yield from _by_name(of_file)


def _by_number(station: list[Component]) -> list[list[Component]]:
    """Return the components of a station by PEER's number, those without one apart; all if there is one at most."""
    numbers = {c.site for c in station if is_numbered(c.site)}
    if len(numbers) < 2:
        return [station]
    return list(grouped(station, lambda c: c.site if c.site in numbers else "").values())


def _by_time(group: list[Component]) -> list[list[Component]]:
    """Return the components of a station by record: each overlaps in time with others of its record.

    If some have no time, all are one record, unless a direction repeats and an event is missing: then each file of several
    components is one, and of the other components each site.
    """
    if not all(component.dated for component in group):
        if all(component.event for component in group) or len(_directions(group)) == len(group):
            return [group]
        files = Counter(component.file for component in group)
        return list(grouped(group, lambda c: (f, "") if files[f := c.file] > 1 else ("", c.site)).values())
    records: dict[int, list[Component]] = {}
    end, place = -math.inf, {id(component): i for i, component in enumerate(group)}
    for component in sorted(group, key=lambda component: component.start or 0.0):
        start = component.start or 0.0
        records.setdefault(len(records) + (start >= end) - 1, []).append(component)
        end = max(end, start + component.duration)
    ordered = [sorted(record, key=lambda component: place[id(component)]) for record in records.values()]
    return sorted(ordered, key=lambda record: place[id(record[0])])


def _by_file(record: list[Component]) -> Iterator[list[Component]]:
    """Yield the components of each complete file, then the rest, if two files or more are complete; else all together."""
    files = grouped(record, lambda c: c.file)
    whole = [components for components in files.values() if _is_whole(components)]
    if len(whole) < 2:
        yield record
        return
    yield from whole
    remainder = [component for components in files.values() if not _is_whole(components) for component in components]
    if remainder:
        yield remainder


def _by_name(record: list[Component]) -> list[list[Component]]:
    """Return the components by site if directions repeat, but not within any site, and none has just one; else all together."""
    sites = grouped(record, lambda c: c.site)
    if len(_directions(record)) == len(record) or len(sites) < 2:
        return [record]
    whole = all(1 < len(_directions(members)) == len(members) for members in sites.values())
    return list(sites.values()) if whole else [record]


def _directions(components: Iterable[Component]) -> set[tuple[bool, float | None, str]]:
    """Return the directions of components, by azimuth and label."""
    return {(c.orientation.vertical, c.orientation.azimuth, c.orientation.label) for c in components}


def _may_join(station: Sequence[Component], group: Sequence[Component]) -> bool:
    """Return whether two groups of one name may be one recording: not both are complete, and some components overlap."""
    if _is_whole(station) and _is_whole(group):
        return False
    return any(overlap(member, component) for member in station for component in group)


def _is_whole(station: Sequence[Component]) -> bool:
    """Return whether components include a vertical and a horizontal one."""
    return len({component.orientation.vertical for component in station}) == 2


def station_names(stations: Sequence[Sequence[Component]]) -> list[str]:
    """Return a name for each of ``stations``, from ``by_station``; those of one record share their name.

    It is PEER's number, the header's station, or the site by the file's name; records of one name get the network, the
    event, the time, the folder or a number added.
    """
    root = list(range(len(stations)))

    def first_of(i: int) -> int:  # union–find with path compression
        while root[i] != i:
            root[i] = i = root[root[i]]
        return i

    keyed = [(key, (i, c)) for i, station in enumerate(stations) for c in station for key in _keys(c)]
    for group in grouped(keyed, lambda pair: pair[0]).values():
        namesakes = [of_station for _, of_station in group]
        for pairs in (pairwise(namesakes), combinations(namesakes, 2)):  # comparing neighbours mostly joins all of them
            if len({first_of(i) for i, _ in namesakes}) > 1:
                for (i, a), (j, b) in pairs:
                    low, high = sorted((first_of(i), first_of(j)))
                    if low != high and (_share_record(a, b) or _are_copies(a, b)):
                        root[high] = low
    for triple in _turned_triples(stations):
        low = min(map(first_of, triple))
        for station in triple:
            root[first_of(station)] = low
    records = list(dict.fromkeys(map(first_of, root)))
    firsts = [stations[i][0] for i in records]
    names = distinct(
        list(map(station_of, firsts)),
        lambda i, name: f"{firsts[i].sensor.network or ''}.{name}".strip("."),
        lambda i, name: f"{name} {firsts[i].event}".strip(),
        lambda i, name: f"{name} {_minute(firsts[i])}".strip(),
        lambda i, name: f"{name} {next((p for p in reversed(firsts[i].folder.split('/')) if p != name), '')}".strip(),
    )
    name_of = dict(zip(records, names, strict=True))
    return [name_of[first_of(i)] for i in range(len(stations))]


def _minute(component: Component) -> str:
    """Return day and minute of the first sample, in UTC: "2019-07-06 03:19"; "" without a date."""
    if not component.dated or component.start is None:
        return ""
    return f"{datetime.fromtimestamp(component.start, UTC):%Y-%m-%d %H:%M}"


def station_of(component: Component) -> str:
    """Return the name of a component's station: PEER's number, else by its header, else by its file, else its own name."""
    if is_numbered(component.site):
        return component.site
    return component.sensor.station.strip() or component.site or component.station or component.name


def _keys(component: Component) -> Iterator[Hashable]:
    """Yield keys of which components of one record share at least one, so that only those have to be compared.

    They are a station with an event, an hour of recording, or a file; PEER's number; and the shape of the samples.
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
            yield place, component.folder, component.file
    if is_numbered(component.site):
        yield component.site
    peak = int(np.abs(component.acceleration).argmax())
    if component.acceleration[peak]:
        mean = float(np.square(component.acceleration / component.acceleration[peak]).mean())
        for half in (0.0, 0.5):  # close values share one of two staggered bins, whatever their rounding
            yield len(component.acceleration), peak, half, math.floor(mean / (10.0 * _SAME_SHAPE) + half)


def _share_record(a: Component, b: Component) -> bool:
    """Return whether two components are of one station and earthquake by PEER's numbers, else by headers."""
    if is_numbered(a.site) and is_numbered(b.site):
        return a.site == b.site
    if a.station and (a.folder, a.station) == (b.folder, b.station):
        return in_one_event(a, b) or (bool(a.source) and a.file == b.file)
    first, second = a.sensor, b.sensor
    if not first.number or first.number.upper() != second.number.upper():
        return False
    return not (first.network and second.network and first.network != second.network) and in_one_event(a, b)


def _are_copies(a: Component, b: Component) -> bool:
    """Return whether samples of two components are equal but for a factor; False for another length or step, or one at rest."""
    first, second = a.acceleration, b.acceleration
    if len(first) != len(second) or abs(a.dt - b.dt) > 1e-6 * a.dt:
        return False
    i = int(np.abs(first).argmax())
    if first[i] == 0 or second[i] == 0:
        return False
    return bool(np.abs(first / first[i] - second / second[i]).max() <= _SAME_SHAPE)


def _turned_triples(stations: Sequence[Sequence[Component]]) -> Iterator[tuple[int, int, int]]:
    """Yield the indices of three stations, not all equal, whose horizontals are one pair rotated to three directions.

    One of three such components is a combination of the others.
    """
    members = [(i, c) for i, station in enumerate(stations) for c in station]
    horizontals = [(i, c) for i, c in members if not c.orientation.vertical and c.pga]
    for alike in grouped(horizontals, lambda pair: (len(pair[1].acceleration), round(pair[1].dt, 9))).values():
        if len({i for i, _ in alike}) < 2 or len(alike) < 3 or len(alike[0][1].acceleration) < 3:
            continue  # any two samples lie in one plane
        samples = np.array([c.acceleration / np.linalg.norm(c.acceleration) for _, c in alike])
        for triple in in_one_plane(samples, _SAME_SHAPE):
            of_station = [alike[row][0] for row in triple]
            if len({*of_station}) > 1:
                yield of_station[0], of_station[1], of_station[2]
