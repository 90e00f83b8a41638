"""Which recordings are of one station in one earthquake, so that suites count them once, and what such a record is called.

Stricter than :mod:`rockbatch.motions.stations`, which finds a vertical for a horizontal within a folder: here files in several
folders or formats, the parts of a long recording, and scaled copies are one record. Where nothing says that two components
belong together, they are records of their own: a manifest's ``station`` can say it.
"""

from collections import Counter
from collections.abc import Hashable, Iterator, Sequence
from itertools import combinations

import numpy as np

from rockbatch.motions.common_span import overlap
from rockbatch.motions.component import Component
from rockbatch.motions.stations import is_numbered

_SAME_SHAPE = 1e-4  # of the peak: what printing a scaled copy may cost a sample


def station_names(stations: Sequence[Sequence[Component]]) -> list[str]:
    """A name for each of ``stations``, as ``by_station`` has them; those of one record share theirs.

    It is PEER's number, the station by its header, or what the names of its files share; of several records of that name
    with the event, the folder or a number behind it.
    """
    root = list(range(len(stations)))

    def first_of(i: int) -> int:
        while root[i] != i:
            i = root[i]
        return i

    alike: dict[Hashable, list[tuple[int, Component]]] = {}
    for i, station in enumerate(stations):
        for component in station:
            for key in _keys(component):
                alike.setdefault(key, []).append((i, component))
    for same in alike.values():
        for (i, a), (j, b) in combinations(same, 2):
            low, high = sorted((first_of(i), first_of(j)))
            if low != high and (_together(a, b) or _copies(a, b)):
                root[high] = low
    firsts = dict.fromkeys(first_of(i) for i in range(len(stations)))
    names = dict(zip(firsts, _told_apart([stations[i] for i in firsts]), strict=True))
    return [names[first_of(i)] for i in range(len(stations))]


def _keys(component: Component) -> Iterator[Hashable]:
    """What components of one record may have in common: those that share nothing of it need not be compared."""
    if is_numbered(component.site):
        yield component.site
    if component.station:
        yield component.folder, component.station
    if component.seat.number:
        yield "seat", component.seat.number.upper()
    yield len(component.acceleration), int(np.abs(component.acceleration).argmax())


def _together(a: Component, b: Component) -> bool:
    """Whether headers, or PEER's numbers, say that both are of one station in one earthquake; sensor and stage do not matter."""
    if is_numbered(a.site) and is_numbered(b.site):
        return a.site == b.site
    if a.station and (a.folder, a.station) == (b.folder, b.station):
        return overlap(a, b)
    one, two = a.seat, b.seat
    if not one.number or one.number.upper() != two.number.upper():
        return False
    if one.network and two.network and one.network != two.network:
        return False
    return in_one_event(a, b)


def in_one_event(a: Component, b: Component) -> bool:
    """Whether two components of one sensor or station are of one event: by their times, or by what they say of it."""
    unknown_time = a.start is None or b.start is None
    return bool(a.event) and a.event == b.event if unknown_time else overlap(a, b)


def _copies(a: Component, b: Component) -> bool:
    """Whether the samples of both are the same but for a factor."""
    one, two = a.acceleration, b.acceleration
    if len(one) != len(two) or abs(a.dt - b.dt) > 1e-6 * a.dt:
        return False
    i = int(np.abs(one).argmax())
    if one[i] == 0 or two[i] == 0:
        return False
    return bool(np.abs(one / one[i] - two / two[i]).max() <= _SAME_SHAPE)


def _told_apart(records: Sequence[Sequence[Component]]) -> list[str]:
    """A name for each record: that of its station, and of several of one station what tells them apart."""
    names = [_name(record[0]) for record in records]
    for more in (lambda c: c.event, lambda c: c.folder.rsplit("/", 1)[-1]):
        count = Counter(names)
        names = [
            f"{name} {more(record[0])}".strip() if count[name] > 1 else name
            for name, record in zip(names, records, strict=True)
        ]
    seen: Counter[str] = Counter()
    for i, name in enumerate(names):
        seen[name] += 1
        if seen[name] > 1:
            names[i] = f"{name} ({seen[name]})"
    return names


def _name(component: Component) -> str:
    if is_numbered(component.site):
        return component.site
    return component.seat.station.strip() or component.site or component.station or component.name
