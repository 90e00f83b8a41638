"""Why data have no curve, and the bounds of the median that they have, alike for stripes, capacities and clouds.

Records are a sample of the motions at a site: if all of a few withstand an intensity, half of the others may not. So a bound has
a confidence, that of an end of an interval. It is an end of the interval of a fitted curve or, without a curve, follows from the
sign test: a motion at the median is on either side of the limit as often as a coin (Conover 1999, Practical Nonparametric
Statistics, 3.4).
"""

import math
from dataclasses import dataclass
from typing import Protocol

import numpy as np
import numpy.typing as npt

from rockbatch.batch.listening import count as counted

Values = npt.NDArray[np.float64]
Numbers = npt.NDArray[np.int64]
Interval = tuple[float, float]

STATIONS_OF_CURVE, STATIONS_OF_INTERVAL = 3, 5
"""Stations whose records a curve, and its intervals, take at least: of fewer, chance says more than they do."""

ROUNDING = 1e-9
"""Share of an intensity by which a median may be beyond it."""


@dataclass(frozen=True)
class NoCurve:
    """The reason why data have no curve, and bounds of the median with the confidence: above ``above``, below ``below``."""

    reason: str
    above: float = 0.0
    below: float = math.inf

    @property
    def is_bound(self) -> bool:
        """Return whether the data bound the median."""
        return self.above > 0 or math.isfinite(self.below)


class HasMedian(Protocol):
    """A fitted curve; its interval is None with fewer than STATIONS_OF_INTERVAL, 5, stations."""

    @property
    def median(self) -> float: ...

    @property
    def median_interval(self) -> Interval | None: ...


def too_few(stations: int) -> NoCurve | None:
    """Return why records of one or two ``stations`` have no curve; None for more of them, or none."""
    if not 0 < stations < STATIONS_OF_CURVE:
        return None
    return NoCurve(
        f"records of {counted(stations, 'station')}: a curve takes {STATIONS_OF_CURVE}, and an interval {STATIONS_OF_INTERVAL}"
    )


def by_station(low: Values, high: Values, station: Numbers) -> tuple[Values, Values]:
    """Return the greatest of ``low`` and the least of ``high`` of each station, shape (stations,) each.

    Of each record they are the greatest intensity that it withstands, 0 if none, and the least at which it exceeds the limit,
    infinite if none, shape (m,), as is the number of its ``station``.
    """
    _, places = np.unique(station, return_inverse=True)
    stations = int(places.max(initial=-1)) + 1
    greatest, least = np.zeros(stations), np.full(stations, np.inf)
    np.maximum.at(greatest, places, low)
    np.minimum.at(least, places, high)
    return greatest, least


def separated(low: Values, high: Values, confidence: float, count: Values | None = None) -> NoCurve | None:
    """Return ``NoCurve``, with its bounds, if no intensity that a station withstands reaches one at which any exceeds the limit.

    ``low`` and ``high``, shape (n,), are those of :func:`by_station`, each of one station or of ``count`` stations.
    """
    if len(low) == 0:
        return NoCurve("no record counts")
    highest, lowest = float(low.max()), float(high.min())
    if highest >= lowest:
        return None
    if math.isinf(lowest):
        reason = f"no record exceeds the limit up to {highest:.4g}, and stronger motions are needed"
    elif highest == 0:
        reason = f"every record exceeds the limit from {lowest:.4g} on, and weaker motions are needed"
    else:
        reason = f"no record exceeds the limit at {highest:.4g}, every one at {lowest:.4g}, and motions between them are needed"
    stations, least = np.ones(len(low)) if count is None else count, stations_of_bound(confidence)
    bounds = NoCurve(reason, max(_reached(low, stations, least), 0.0), -_reached(-high, stations, least))
    return bounds if bounds.is_bound else NoCurve(f"{reason}: a bound of the median takes {least} stations")


def stations_of_bound(confidence: float) -> int:
    """Return the least number of stations that bound a median if all are on one side: 6 for 95 %.

    At the median, all are on that side by chance no more often than a median is beyond one end of its interval.
    """
    return math.ceil(-math.log2(0.5 - 0.5 * confidence))


def _reached(intensity: Values, stations: Values, least: int) -> float:
    """Return the greatest intensity that as many as ``least`` of the ``stations`` reach; −∞ if they are fewer."""
    order = np.argsort(-intensity)
    place = int(np.searchsorted(np.cumsum(stations[order]), least))
    return float(intensity[order[place]]) if place < len(order) else -math.inf


def is_among(median: float, least: float, most: float) -> bool:
    """Return whether a median is among the intensities, ``least`` to ``most``, or beyond an end by no more than ROUNDING."""
    return least * (1.0 - ROUNDING) <= median <= most * (1.0 + ROUNDING)


def outside(curve: HasMedian, least: float, most: float) -> NoCurve | None:
    """Return ``NoCurve`` for a median below or above all intensities, ``least`` to ``most``; None for one among them.

    Its bound is the end of its interval, or the nearest intensity if that is beyond it; without an end among the intensities it
    has none.
    """
    if is_among(curve.median, least, most):
        return None
    low, high = curve.median_interval or (0.0, math.inf)
    unbounded = "its interval has no end among them" if curve.median_interval else "there is no interval"
    unbounded += ", and nothing bounds it"
    if curve.median < least:
        reason = f"the median by the fit is below all intensities, which begin at {least:.4g}"
        return NoCurve(reason, below=max(high, least)) if high <= most else NoCurve(f"{reason}: {unbounded}")
    reason = f"the median by the fit is above all intensities, which end at {most:.4g}"
    return NoCurve(reason, above=min(low, most)) if low >= least else NoCurve(f"{reason}: {unbounded}")
