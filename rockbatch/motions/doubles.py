"""One recording in several files: which of them is used.

Two components are the same recording if they are of one sensor, point the same way, and have a time in common, or, where
one of them does not say when it began, are of one event; so are those with the same samples, if nothing that they say
is against it.
"""

import hashlib
import math
import re
from collections.abc import Sequence

import numpy as np

from rockbatch.motions.common_span import overlap
from rockbatch.motions.component import NOWHERE, Component
from rockbatch.motions.motion import LeftOut
from rockbatch.motions.orientation import UNKNOWN, same_azimuth

_CORRECTED = {True: 0, None: 1, False: 2}


def without_doubles(components: Sequence[Component]) -> tuple[list[Component], list[LeftOut]]:
    """Components without those that another one stands for, in their order, and what is left out, with the reason.

    Of several files of one recording that one is used that a manifest says to be (``use = true``; all of them, if
    there are more), else, in this order: a corrected one before one that does not say, and that before an uncorrected
    one; one of a file that has its vertical with it; one in a unit of acceleration before counts; one of the file with
    the more intense shaking; the one whose name is shorter, which a copy's is not; the first.
    """
    order = _preference(components)
    kept: list[int] = []
    of_station: dict[str, list[int]] = {}
    of_samples: dict[bytes, list[int]] = {}
    stands_for: dict[int, int] = {}
    for i in sorted(range(len(components)), key=lambda i: order[i]):
        component = components[i]
        samples = _samples(component)
        station = of_station.setdefault(component.seat.number, []) if component.seat.number else []
        alike = of_samples.setdefault(samples, [])
        other = next((j for j in station if _same_recording(component, components[j])), None)
        if other is None:
            other = next((j for j in alike if _may_be_copies(component, components[j])), None)
        if other is not None and not component.wanted:
            stands_for[i] = other
            continue
        kept.append(i)
        station.append(i)
        alike.append(i)
    left_out = [
        LeftOut(components[i].name, components[i].source, _reason(components[i], components[j]))
        for i, j in sorted(stands_for.items())
    ]
    return [components[i] for i in sorted(kept)], left_out


def _preference(components: Sequence[Component]) -> list[tuple[object, ...]]:
    """What components are sorted by, the one to use first; shaking counts by powers of two, so that a file's agree."""
    intensity: dict[str, float] = {}
    whole: set[tuple[str, str, bool | None]] = set()
    for component in components:
        energy = float(component.acceleration @ component.acceleration) * component.dt
        file = _file(component)
        intensity[file] = intensity.get(file, 0.0) + energy
        if component.orientation.vertical:
            whole.add((component.folder, component.seat.station or component.site, component.processed))
    return [
        (
            not component.wanted,
            _CORRECTED[component.processed],
            (component.folder, component.seat.station or component.site, component.processed) not in whole,
            not component.unit,
            -round(math.log2(intensity[_file(component)] or 1e-300)),
            len(component.source),
            i,
        )
        for i, component in enumerate(components)
    ]


def _file(component: Component) -> str:
    """Its file: what a source has before the label of one of several components."""
    return component.folder + "/" + re.sub(r" \([^()]*\)$", "", component.source)


def _samples(component: Component) -> bytes:
    """What components with the same samples share, whichever way is up."""
    digest = hashlib.sha256(repr(component.dt).encode())
    digest.update(np.ascontiguousarray(component.acceleration).tobytes())
    return digest.digest()


def _same_recording(a: Component, b: Component) -> bool:
    """Whether the headers of both say so; those in one file are of different sensors."""
    if not a.seat.is_that_of(b.seat) or not _pointing_alike(a, b) or _file(a) == _file(b):
        return False
    if len({_rsn(a), _rsn(b)} - {""}) > 1:
        return False
    if a.start is None or b.start is None:
        return bool(a.event) and a.event == b.event
    return overlap(a, b)


def _rsn(component: Component) -> str:
    """PEER's number of the record, which tells apart what headers do not."""
    return component.site if component.site.startswith("RSN") else ""


def _pointing_alike(a: Component, b: Component) -> bool:
    """Whether both point the same way, by azimuths, or else by their labels."""
    one, two = a.orientation, b.orientation
    if one.vertical or two.vertical:
        return one.vertical and two.vertical
    if one.azimuth is None or two.azimuth is None:
        return one.azimuth is None and two.azimuth is None and one.label.upper() == two.label.upper()
    return same_azimuth(one.azimuth, two.azimuth)


def _may_be_copies(a: Component, b: Component) -> bool:
    """Whether components with the same samples do not say that they are of other sensors, events or directions."""
    if NOWHERE not in (a.seat, b.seat) and not a.seat.is_that_of(b.seat):
        return False
    if a.event and b.event and a.event != b.event:
        return False
    return UNKNOWN in (a.orientation, b.orientation) or _pointing_alike(a, b)


def _reason(component: Component, used: Component) -> str:
    """Why ``component`` is left out: which other one is used, and what it has that this one does not."""
    if _samples(component) == _samples(used):
        why = "a copy of"
    elif _CORRECTED[used.processed] < _CORRECTED[component.processed]:
        why = "the same recording, less corrected, as"
    else:
        why = "the same recording as"
    return f"{why} {used.source}, which is used; write use = true in motions.toml to use this one"
