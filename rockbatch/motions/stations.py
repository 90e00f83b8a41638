"""Which components are of one station."""

import math
import re
from collections.abc import Iterable, Iterator, Sequence

from rockbatch.motions.common_span import overlap
from rockbatch.motions.component import Component, file_of

_NUMBERED = re.compile(r"RSN\d+")


def is_numbered(site: str) -> bool:
    """Whether a site is PEER's number of a record, which no other record has."""
    return _NUMBERED.fullmatch(site) is not None


def by_station(components: Iterable[Component]) -> list[list[Component]]:
    """Components of one station, folder and time together: by header first, then by name; in order of their first ones.

    Names join what headers leave without a vertical, or without a horizontal: components of the same RSN, and those
    of which one has no header that tells its station. Several files of one station that each hold a vertical and a
    horizontal, such as the parts of a long recording, are as many sets.
    """
    by_header: dict[tuple[str, str | int], list[Component]] = {}
    for component in components:
        by_header.setdefault((component.folder, component.station or id(component)), []).append(component)
    stations: list[list[Component]] = []
    known: dict[tuple[str, str, bool], list[Component]] = {}
    for group in (part for whole in by_header.values() for record in _by_time(whole) for part in _by_file(record)):
        folder, headed = group[0].folder, bool(group[0].station)
        sites = list(dict.fromkeys(component.site for component in group if component.site))
        of_name = (known.get((folder, site, headed and not is_numbered(site))) for site in sites)
        station = next((other for other in of_name if other and _may_join(other, group)), None)
        if station is None:
            station = group
            stations.append(group)
        else:
            station += group
        for site in sites:
            known.setdefault((folder, site, False), station)
            if not headed:
                known.setdefault((folder, site, True), station)
    return stations


def _by_time(group: list[Component]) -> list[list[Component]]:
    """The records of one station: components that share time with others of theirs; one where a time is not known."""
    if any(component.start is None for component in group):
        return [group]
    order = {id(component): i for i, component in enumerate(group)}
    records: list[list[Component]] = []
    end = -math.inf
    for component in sorted(group, key=lambda component: component.start or 0.0):
        start = component.start or 0.0
        if start >= end:
            records.append([])
        records[-1].append(component)
        end = max(end, start + component.duration)
    ordered = [sorted(record, key=lambda component: order[id(component)]) for record in records]
    return sorted(ordered, key=lambda record: order[id(record[0])])


def _by_file(record: list[Component]) -> Iterator[list[Component]]:
    """One set for each file that holds a whole one, where several do, and one of the rest; else all together."""
    files: dict[str, list[Component]] = {}
    for component in record:
        files.setdefault(file_of(component.source), []).append(component)
    whole = [components for components in files.values() if _is_whole(components)]
    if len(whole) < 2:
        yield record
        return
    yield from whole
    rest = [component for components in files.values() if not _is_whole(components) for component in components]
    if rest:
        yield rest


def _may_join(station: Sequence[Component], group: Sequence[Component]) -> bool:
    """Whether two sets of one name may be one: not if both are whole, nor if they share no time."""
    if _is_whole(station) and _is_whole(group):
        return False
    return any(overlap(one, other) for one in station for other in group)


def _is_whole(station: Sequence[Component]) -> bool:
    """Whether there are both a vertical and a horizontal component."""
    return len({component.orientation.vertical for component in station}) == 2
