"""Kinemetrics .evt files (K2, Etna), read by ObsPy, in m/s² by the full scale and sensitivity in their header."""

import numpy as np

from rockbatch.motions.component import Component, Sensor
from rockbatch.motions.formats.recording import Recording, to_components
from rockbatch.motions.formats.with_obspy import is_evt, read_stream
from rockbatch.motions.labels.orientation import unknown
from rockbatch.motions.labels.origin import origin_of
from rockbatch.motions.sources.record_file import RecordFile
from rockbatch.motions.unused import Unusable

__all__ = ["is_evt", "read_evt"]


def read_evt(file: RecordFile) -> list[Component | Unusable]:
    """Return a component in m/s² per channel of a file, each of unknown direction."""
    stream = read_stream(file.data, "KINEMETRICS_EVT")
    recordings = []
    for number, trace in enumerate(stream, start=1):
        start = trace.stats.starttime.timestamp
        recordings.append(
            Recording(
                label=f"channel {number}",
                orientation=unknown(f"channel {number}"),
                dt=float(trace.stats.delta),
                values=np.asarray(trace.data, dtype=float) * trace.stats.calib,
                unit="m/s2",
                station=f"{trace.stats.station} {start:.0f}",
                start=start,
                processed=False,
                counts=True,
                sensor=Sensor(trace.stats.station, channel=str(number)),
                origin=origin_of(date=trace.stats.starttime.strftime("%Y-%m-%d"), station=trace.stats.station),
                notes=(f"sensitivity {1.0 / trace.stats.calib:g} counts per m/s² by its header",),
            )
        )
    return to_components(file, recordings)
