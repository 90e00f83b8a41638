"""Sensors of one station that recorded the same ground motion with different gains: one sensitivity is wrong."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import combinations

from rockbatch.common.grouping import grouped
from rockbatch.motions.common_span import on_common_samples, overlap, too_unlike
from rockbatch.motions.component import Component
from rockbatch.motions.likeness import correlation
from rockbatch.motions.motion import Finding
from rockbatch.motions.orientation import same_azimuth

_ALIKE = 0.98  # correlation: sensors beside each other have more; a roof, or the bottom of a borehole, less
_FACTOR = 1.25  # of the amplitudes: calibrations agree to some percent
_ENOUGH = 100  # common samples


def with_gains_compared(components: Sequence[Component]) -> list[Component]:
    """Return the components, with a finding on two sensors of a station whose motions differ by a factor only.

    Which gain is right cannot be known: both are held back until confirmed, or one is left out by ``use = false``.
    """
    compared = list(components)
    for i, j in _side_by_side(components):
        factor = _gain_ratio(components[i], components[j])
        if factor is None:
            continue
        for place, other, times in ((i, j, factor), (j, i, 1.0 / factor)):
            text = (
                f"{components[other].source}, of another sensor of the station, has the same motion times {times:.3g}: "
                "one of their gains is wrong, and the files do not say which; ask their network, and leave out the wrong one by "
                "use = false in motions.toml"
            )
            findings = (*compared[place].findings, Finding("gain", text, gross=True))
            compared[place] = replace(compared[place], findings=findings)
    return compared


def _side_by_side(components: Sequence[Component]) -> Iterator[tuple[int, int]]:
    """Yield places of two components of one direction, time and station, from sensors with different location codes."""
    coded = [(i, c) for i, c in enumerate(components) if c.sensor.number and c.sensor.location is not None and c.dated]
    for of_station in grouped(coded, lambda pair: (pair[1].sensor.network, pair[1].sensor.number)).values():
        for (i, a), (j, b) in combinations(of_station, 2):
            if a.sensor.location != b.sensor.location and _point_alike(a, b) and overlap(a, b):
                yield i, j


def _point_alike(a: Component, b: Component) -> bool:
    if a.orientation.vertical or b.orientation.vertical:
        return a.orientation.vertical == b.orientation.vertical
    return same_azimuth(a.orientation.azimuth, b.orientation.azimuth)


def _gain_ratio(a: Component, b: Component) -> float | None:
    """Return the amplitude of ``b`` over that of ``a`` if their motions are alike but for it; ``None`` for ratios near 1."""
    if too_unlike(a, b):
        return None
    common = on_common_samples(a, b, ("one", "other"))
    first, second = (samples - samples.mean() for samples in (common.first, common.second))
    energies = float(first @ first), float(second @ second)
    if len(first) < _ENOUGH or not all(energies) or correlation(first, second) < _ALIKE:
        return None
    factor = math.sqrt(energies[1] / energies[0])
    return factor if abs(math.log(factor)) > math.log(_FACTOR) else None
