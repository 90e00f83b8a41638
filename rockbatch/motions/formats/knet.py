"""K-NET and KiK-net (NIED): one component per file, counts with their scale in the header."""

from rockbatch.errors import InputError
from rockbatch.motions.component import Component, Seat
from rockbatch.motions.formats.record_file import RecordFile
from rockbatch.motions.formats.with_obspy import read_stream
from rockbatch.motions.orientation import orientation_of, unknown
from rockbatch.motions.origin import origin_of

SUFFIXES = frozenset({".ew", ".ns", ".ud", ".ew1", ".ns1", ".ud1", ".ew2", ".ns2", ".ud2"})

_LEVELS = {"1": "KiK-net sensor 1: in the borehole", "2": "KiK-net sensor 2: at the surface"}
_PLACES = {"1": "borehole", "2": "surface"}


def is_knet(head: bytes) -> bool:
    """Whether the first bytes are those of a K-NET or KiK-net ASCII file."""
    return head.startswith(b"Origin Time")


def read_knet(file: RecordFile) -> list[Component]:
    """The component of a file in m/s²; KiK-net's borehole and surface are two stations."""
    (trace,) = read_stream(file.data, "KNET")
    stats = trace.stats
    if "knet" not in stats or not stats.npts:
        raise InputError("the header or the data are missing; fetch it again")
    expected = stats.knet.duration * stats.sampling_rate
    if abs(stats.npts - expected) >= stats.sampling_rate:  # the header's duration is in whole seconds
        raise InputError(
            f"the header says {stats.knet.duration:g} s at {stats.sampling_rate:g} Hz, {expected:g} values, "
            f"but the file holds {stats.npts}; fetch it again"
        )
    level = stats.channel[2:]
    return [
        Component(
            name=file.stem,
            dt=float(stats.delta),
            acceleration=trace.data * stats.calib,
            orientation=orientation_of(stats.channel[:2]) or unknown(stats.channel),
            station=f"{stats.station}.{level}" if level else stats.station,
            source=file.source,
            start=stats.starttime.timestamp,
            raw=True,
            processed=False,
            origin=origin_of(date=stats.knet.evot.strftime("%Y-%m-%d %H:%M"), station=stats.station),
            seat=Seat(stats.station, location=level, place=_PLACES.get(level)),
            notes=(_LEVELS[level],) if level in _LEVELS else (),
        )
    ]
