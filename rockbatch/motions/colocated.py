"""Sensors of one station that recorded the same ground with another gain: one of the two sensitivities is wrong."""

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
    """Return the components, those with a finding that another sensor of their station has in the same time times a factor.

    Which of the two is right cannot be known: both wait to be confirmed, or for ``use = false`` of one.
    """
    findings: dict[int, list[Finding]] = {}
    for i, j in _side_by_side(components):
        factor = _factor(components[i], components[j])
        for place, other, times in ((i, j, factor), (j, i, 1.0 / factor)) if factor else ():
            text = (
                f"{components[other].source}, of another sensor of the station, has the same motion times {times:.3g}: "
                "one of their gains is wrong, and the files do not say which; ask their network, and leave out the wrong one by "
                "use = false in motions.toml"
            )
            findings.setdefault(place, []).append(Finding("gain", text, gross=True))
    return [
        replace(component, findings=(*component.findings, *findings[i])) if i in findings else component
        for i, component in enumerate(components)
    ]


def _side_by_side(components: Sequence[Component]) -> Iterator[tuple[int, int]]:
    """Yield pairs that point alike and recorded at one time, of sensors that one station tells apart by their location code."""
    coded = [(i, c) for i, c in enumerate(components) if c.sensor.number and c.sensor.location is not None and c.dated]
    for of_station in grouped(coded, lambda pair: (pair[1].sensor.network, pair[1].sensor.number)).values():
        for (i, a), (j, b) in combinations(of_station, 2):
            if a.sensor.location != b.sensor.location and _point_alike(a, b) and overlap(a, b):
                yield i, j


def _point_alike(a: Component, b: Component) -> bool:
    if a.orientation.vertical or b.orientation.vertical:
        return a.orientation.vertical == b.orientation.vertical
    return same_azimuth(a.orientation.azimuth, b.orientation.azimuth)


def _factor(a: Component, b: Component) -> float | None:
    """Return how many times the motion of ``a`` that of ``b`` is, if both are alike but for that; ``None`` if not."""
    if too_unlike(a, b):
        return None
    common = on_common_samples(a, b, ("one", "other"))
    first, second = (samples - samples.mean() for samples in (common.first, common.second))
    energies = float(first @ first), float(second @ second)
    if len(first) < _ENOUGH or not all(energies) or correlation(first, second) < _ALIKE:
        return None
    factor = math.sqrt(energies[1] / energies[0])
    return factor if abs(math.log(factor)) > math.log(_FACTOR) else None
