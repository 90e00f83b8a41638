"""Sensors of one station that recorded the same ground motion with different gains, signs or azimuths: one of them is wrong."""

import math
from collections.abc import Iterator, Sequence
from itertools import combinations

from rockbatch.common.grouping import grouped
from rockbatch.motions.alignment import alignment
from rockbatch.motions.component import Component
from rockbatch.motions.identity.common_span import on_common_samples, overlap, too_unlike
from rockbatch.motions.labels.orientation import same_azimuth
from rockbatch.motions.motion import Finding

_ALIKE = 0.98  # correlation: sensors beside each other have more; a roof, or the bottom of a borehole, less
_FACTOR = 1.25  # of the amplitudes: calibrations agree to some percent
_ENOUGH = 100  # common samples
_SQUARE = 30.0  # degrees off a right angle up to which two azimuths seem exchanged


def with_gains_compared(components: Sequence[Component]) -> list[Component]:
    """Return the components, with a gross finding on two sensors of a station with the same motion but for a factor, or its sign.

    So are those with the same motion under azimuths at a right angle. Factors up to 1.25 are calibration. Which sensor is right
    cannot be known: both are held back until confirmed, or one is left out by ``use = false``.
    """
    compared = list(components)
    for i, j, sign in _side_by_side(components):
        ratio = _amplitude_ratio(components[i], components[j])
        if ratio is None:
            continue
        factor = ratio * (sign or 1.0)
        if sign and 1.0 / _FACTOR <= factor <= _FACTOR:
            continue
        wrong = "gains" if abs(math.log(abs(factor))) > math.log(_FACTOR) else "signs"
        what, wrong = ("gain", wrong) if sign else ("direction", "azimuths")
        for place, other, times in ((i, j, factor), (j, i, 1.0 / factor)):
            text = (
                f"{components[other].source}, of another sensor of the station, has the same motion times {times:.3g}: "
                f"one of their {wrong} is wrong, and the files do not say which; ask their network, and leave out the wrong one "
                "by use = false in motions.toml"
            )
            compared[place] = compared[place].with_findings(Finding(what, text, gross=True))
    return compared


def _side_by_side(components: Sequence[Component]) -> Iterator[tuple[int, int, float]]:
    """Yield places i < j of two components of one station that overlap in time, and 1 for equal or −1 for opposite directions.

    It is 0 for azimuths at a right angle. Both have a date, and their sensors have location codes, which differ.
    """
    coded = [(i, c) for i, c in enumerate(components) if c.sensor.number and c.sensor.location is not None and c.dated]
    for of_station in grouped(coded, lambda pair: (pair[1].sensor.network, pair[1].sensor.number)).values():
        for (i, a), (j, b) in combinations(of_station, 2):
            sign = _sign_between(a, b)
            if sign is not None and a.sensor.location != b.sensor.location and overlap(a, b):
                yield i, j, sign


def _sign_between(a: Component, b: Component) -> float | None:
    """Return 1 for equal directions, −1 for opposite ones, 0 for azimuths at a right angle; ``None`` for others."""
    mine, others = a.orientation, b.orientation
    if mine.vertical != others.vertical:
        return None
    if mine.vertical:
        return 1.0 if mine.down == others.down else -1.0
    if mine.azimuth is None or others.azimuth is None:
        return None
    if same_azimuth(mine.azimuth, others.azimuth):
        return 1.0
    if same_azimuth(mine.azimuth, others.azimuth + 180.0):
        return -1.0
    return 0.0 if abs((mine.azimuth - others.azimuth) % 180.0 - 90.0) <= _SQUARE else None


def _amplitude_ratio(a: Component, b: Component) -> float | None:
    """Return the amplitude of ``b`` over that of ``a``, negative if their motions have opposite signs.

    ``None`` for a correlation below 0.98, steps or lengths too unlike, fewer than 100 common samples, and a component at rest.
    """
    if too_unlike(a, b):
        return None
    common = on_common_samples(a, b, ("one", "other"))
    first, second = (samples - samples.mean() for samples in (common.first, common.second))
    energies = float(first @ first), float(second @ second)
    if len(first) < _ENOUGH or not all(energies):
        return None
    alike = alignment(first, second).correlation
    if abs(alike) < _ALIKE:
        return None
    return math.copysign(math.sqrt(energies[1] / energies[0]), alike)
