"""One recording in several files: which of them is used.

Two components are the same recording if they are of one sensor, point the same way, and have a time in common, or, where
one of them does not say when it began, are of one event; so are those with the same samples, if nothing that they say
is against it. The parts of a long recording, which claim one time of triggering, are not: each file is a whole set of
components, processed alike, and its samples are like nothing in the other one.
"""

import hashlib
import math
from collections.abc import Sequence, Set
from pathlib import Path

import numpy as np

from rockbatch.motions.archives import bare
from rockbatch.motions.component import NOWHERE, Component, file_of
from rockbatch.motions.formats import is_usual
from rockbatch.motions.motion import LeftOut, Samples
from rockbatch.motions.orientation import UNKNOWN, same_azimuth
from rockbatch.motions.station_names import in_one_event

_CORRECTED = {True: 0, None: 1, False: 2}
_ALIKE = 0.7  # correlation: real files of one recording have 0.98 and more, other records 0.63 at most, halves 0.46
_SAME_STEP = 1e-3  # relative


def without_doubles(components: Sequence[Component]) -> tuple[list[Component], list[LeftOut]]:
    """Components without those that another one stands for, in their order, and what is left out, with the reason.

    Of several files of one recording that one is used that a manifest says to be (``use = true``; all of them, if
    there are more), else, in this order: a corrected one before one that does not say, and that before an uncorrected
    one; one of a file that has its vertical with it; one in a unit of acceleration before counts; one of the file with
    the more intense shaking; one with the suffix of a format; the one whose name is shorter, which a copy's is not; the
    first.
    """
    order = _preference(components)
    whole = _whole_files(components)
    kept: list[int] = []
    of_station: dict[str, list[int]] = {}
    of_samples: dict[bytes, list[int]] = {}
    stands_for: dict[int, int] = {}
    for i in sorted(range(len(components)), key=lambda i: order[i]):
        component = components[i]
        samples = _samples(component)
        station = of_station.setdefault(component.seat.number, []) if component.seat.number else []
        alike = of_samples.setdefault(samples, [])
        other = next((j for j in station if _same_recording(component, components[j], whole)), None)
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
            not is_usual(bare(Path(_file(component))).suffix),
            len(component.source),
            i,
        )
        for i, component in enumerate(components)
    ]


def _file(component: Component) -> str:
    """Its file, by folder and source."""
    return f"{component.folder}/{file_of(component.source)}"


def _samples(component: Component) -> bytes:
    """What components with the same samples share, whichever way is up."""
    digest = hashlib.sha256(repr(component.dt).encode())
    digest.update(np.ascontiguousarray(component.acceleration).tobytes())
    return digest.digest()


def _whole_files(components: Sequence[Component]) -> set[str]:
    """Files that hold both a vertical and a horizontal component."""
    verticals = {_file(component) for component in components if component.orientation.vertical}
    return verticals & {_file(component) for component in components if not component.orientation.vertical}


def _same_recording(a: Component, b: Component, whole: Set[str]) -> bool:
    """Whether the headers of both say so; those in one file are of different sensors.

    Two ``whole`` files of one step that are processed alike may be parts of one recording, which their samples tell.
    """
    if not a.seat.is_that_of(b.seat) or not _pointing_alike(a, b) or _file(a) == _file(b):
        return False
    if len({_rsn(a), _rsn(b)} - {""}) > 1:
        return False
    if not in_one_event(a, b):
        return False
    may_be_parts = (
        a.processed == b.processed and abs(a.dt - b.dt) <= _SAME_STEP * a.dt and whole >= {_file(a), _file(b)}
    )
    return not may_be_parts or correlation(a.acceleration, b.acceleration) >= _ALIKE


def correlation(one: Samples, two: Samples) -> float:
    """Largest correlation of two series of one step, either way up, over all shifts of one against the other; 0 to 1.

    1 where one of them never moves.
    """
    one, two = ((x - x.mean()) / (np.abs(x).max() or 1.0) for x in (one, two))
    n = len(one) + len(two)
    shifted = np.fft.irfft(np.fft.rfft(one, n) * np.conj(np.fft.rfft(two, n)), n)
    norm = float(np.linalg.norm(one) * np.linalg.norm(two))
    return float(np.abs(shifted).max()) / norm if norm > 0 else 1.0


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
