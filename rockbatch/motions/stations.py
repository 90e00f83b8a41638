"""Which components are of one station."""

import re
from collections.abc import Iterable, Sequence

from rockbatch.motions.component import Component

_NUMBERED = re.compile(r"RSN\d+")


def by_station(components: Iterable[Component]) -> list[list[Component]]:
    """Components of one station and folder together: by header first, then by name; in order of their first ones.

    Names join what headers leave without a vertical, or without a horizontal: components of the same RSN, and those
    of which one has no header that tells its station.
    """
    by_header: dict[tuple[str, str | int], list[Component]] = {}
    for component in components:
        by_header.setdefault((component.folder, component.station or id(component)), []).append(component)
    stations: list[list[Component]] = []
    known: dict[tuple[str, str, bool], list[Component]] = {}
    for group in by_header.values():
        folder, headed = group[0].folder, bool(group[0].station)
        sites = list(dict.fromkeys(component.site for component in group if component.site))
        of_name = (known.get((folder, site, headed and not _NUMBERED.fullmatch(site))) for site in sites)
        station = next((other for other in of_name if other and not (_is_whole(other) and _is_whole(group))), None)
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


def _is_whole(station: Sequence[Component]) -> bool:
    """Whether there are both a vertical and a horizontal component."""
    return len({component.orientation.vertical for component in station}) == 2
