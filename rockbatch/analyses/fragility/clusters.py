"""Clusters of records, by station or by earthquake: intervals count clusters, since records of one are not independent."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rockbatch.analyses.fragility.bounds import STATIONS_OF_INTERVAL, Numbers
from rockbatch.common.grouping import joined
from rockbatch.motions import Motion


@dataclass(frozen=True, eq=False)
class Clusters:
    """Groups of records that are independent of each other."""

    of_motion: Numbers  # number of the group of each motion, shape (n,)
    kind: str  # "station" or "event"
    # Number of stations, and of earthquakes among them, 0 if that of some record is unknown. Stations whose shocks one sequence
    # joins count as one.
    stations: int
    events: int


def clusters(motions: Sequence[Motion]) -> Clusters:
    """Return the earthquakes of the records if all are known, five or more, and fewer than the stations; else the stations."""
    by_station = joined([motion.stations for motion in motions])
    by_event = [motion.origin.event for motion in motions]
    stations, events = len(set(by_station)), len(set(by_event)) if all(by_event) else 0
    of_events = STATIONS_OF_INTERVAL <= events < stations
    shared = by_event if of_events else by_station
    _, numbers = np.unique(shared, return_inverse=True)
    return Clusters(numbers.astype(np.int64), "event" if of_events else "station", stations, events)
