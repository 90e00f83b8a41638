"""Sensors of one station that recorded the same ground motion with different gains or signs: one of them is wrong."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import combinations

from rockbatch.common.grouping import grouped
from rockbatch.motions.common_span import on_common_samples, overlap, too_unlike
from rockbatch.motions.component import Component
from rockbatch.motions.likeness import alignment
from rockbatch.motions.motion import Finding
from rockbatch.motions.orientation import same_azimuth

_ALIKE = 0.98  # correlation: sensors beside each other have more; a roof, or the bottom of a borehole, less
_FACTOR = 1.25  # of the amplitudes: calibrations agree to some percent
_ENOUGH = 100  # common samples


def with_gains_compared(components: Sequence[Component]) -> list[Component]:
    """Return the components, with a gross finding on two sensors of a station whose motions differ by a factor, or in sign, only.

    Factors up to 1.25 are calibration. Which sensor is right cannot be known: both are held back until confirmed, or one is left
    out by ``use = false``.
    """
    compared = list(components)
    for i, j, sign in _side_by_side(components):
        factor = _gain_ratio(components[i], components[j], sign)
        if factor is None:
            continue
        wrong = "gains" if abs(math.log(abs(factor))) > math.log(_FACTOR) else "signs"
        for place, other, times in ((i, j, factor), (j, i, 1.0 / factor)):
            text = (
                f"{components[other].source}, of another sensor of the station, has the same motion times {times:.3g}: "
                f"one of their {wrong} is wrong, and the files do not say which; ask their network, and leave out the wrong one "
                "by use = false in motions.toml"
            )
            findings = (*compared[place].findings, Finding("gain", text, gross=True))
            compared[place] = replace(compared[place], findings=findings)
    return compared


def _side_by_side(components: Sequence[Component]) -> Iterator[tuple[int, int, float]]:
    """Yield places i < j of two dated components of one station that point along one line and overlap in time, and a sign.

    Their sensors have different location codes. The sign is that of their directions: −1 if these are opposite.
    """
    coded = [(i, c) for i, c in enumerate(components) if c.sensor.number and c.sensor.location is not None and c.dated]
    for of_station in grouped(coded, lambda pair: (pair[1].sensor.network, pair[1].sensor.number)).values():
        for (i, a), (j, b) in combinations(of_station, 2):
            sign = _sign_between(a, b)
            if sign and a.sensor.location != b.sensor.location and overlap(a, b):
                yield i, j, sign


def _sign_between(a: Component, b: Component) -> float:
    """Return 1 for equal directions of two components, −1 for opposite ones, 0 for others and unknown azimuths."""
    mine, others = a.orientation, b.orientation
    if mine.vertical or others.vertical:
        return (1.0 if mine.down == others.down else -1.0) if mine.vertical == others.vertical else 0.0
    if same_azimuth(mine.azimuth, others.azimuth):
        return 1.0
    reverse = None if others.azimuth is None else others.azimuth + 180.0
    return -1.0 if same_azimuth(mine.azimuth, reverse) else 0.0


def _gain_ratio(a: Component, b: Component, sign: float) -> float | None:
    """Return the amplitude of ``b`` over that of ``a``, negative if the signs of their motions differ from ``sign``.

    ``None`` for a correlation below 0.98, fewer than 100 common samples, a component at rest, and a ratio from 0.8 to 1.25.
    """
    if too_unlike(a, b):
        return None
    common = on_common_samples(a, b, ("one", "other"))
    first, second = (samples - samples.mean() for samples in (common.first, common.second))
    energies = float(first @ first), float(second @ second)
    if len(first) < _ENOUGH or not all(energies):
        return None
    alike = sign * alignment(first, second).correlation
    if abs(alike) < _ALIKE:
        return None
    factor = math.copysign(math.sqrt(energies[1] / energies[0]), alike)
    return None if 1.0 / _FACTOR <= factor <= _FACTOR else factor
