"""ASDF, the Adaptable Seismic Data Format (HDF5): waveforms in counts, with the StationXML of each station beside them.

Read by h5py as plain numbers: groups "Waveforms/NET.STA", in them "StationXML" and data sets "NET.STA.LOC.CHA__begins__ends__tag"
with the attributes ``starttime`` [ns since 1970] and ``sampling_rate`` [Hz]. Source: https://asdf-definition.readthedocs.io.
"""

import io
import re
from collections.abc import Container, Iterator
from dataclasses import replace
from typing import TypeVar

import numpy as np

from rockbatch.common.errors import InputError
from rockbatch.common.grouping import grouped
from rockbatch.common.lazy import h5py, obspy
from rockbatch.motions.component import Component
from rockbatch.motions.formats.miniseed import components_of_traces
from rockbatch.motions.limits import MOST_SAMPLES, STEPS, is_step
from rockbatch.motions.sources import stationxml
from rockbatch.motions.sources.record_file import RecordFile
from rockbatch.motions.unused import Unusable

T = TypeVar("T")
_MAGIC = b"\x89HDF\r\n\x1a\n"
_NAME = re.compile(
    r"(?P<network>\w{0,8})\.(?P<station>\w{1,8})\.(?P<location>\w{0,8})\.(?P<channel>\w{1,8})__(?:.*__)?(?P<tag>.*)"
)
_RAW = "raw"  # begins the tag of recordings in counts, by the definition of the format
_MOST_TRACES = 1000
_ADJACENT = -1  # ObsPy's method to join pieces that follow one another without a gap
_LATEST = 4102444800.0  # s since 1970: 2100


def is_hdf5(head: bytes) -> bool:
    """Return whether the first bytes are those of an HDF5 file."""
    return head.startswith(_MAGIC)


def read_asdf(file: RecordFile) -> list[Component | Unusable]:
    """Return a component per channel and event of an ASDF file; if some waveforms have a tag "raw…", of these only, with a note.

    Raises ``InputError`` for other HDF5 files, and for damaged ones.
    """
    try:
        with h5py.File(io.BytesIO(file.data), "r") as store:
            waveforms = _own_member(store, "Waveforms", h5py.Group)
            if waveforms is None:
                raise InputError(
                    "an HDF5 file without the group Waveforms of ASDF; write it as MiniSEED, or as text columns"
                )
            stations = [s for name in waveforms if (s := _own_member(waveforms, name, h5py.Group)) is not None]
            channels = [channel for station in stations for channel in _channels(station)]
            tags = {match["tag"] for station in stations for name in station if (match := _NAME.fullmatch(name))}
            used = {tag for tag in tags if tag.startswith(_RAW)} or tags
            traces = [trace for station in stations for trace in _traces(station, used)]
    except InputError:
        raise
    except (OSError, KeyError, OverflowError, RuntimeError, TypeError, ValueError) as error:
        raise InputError(f"not an HDF5 file that can be read ({type(error).__name__}); fetch it again") from None
    if not traces:
        raise InputError("holds no waveforms")
    with_channels = replace(file, inventories=file.inventories.with_channels(channels))
    pieces = grouped(traces, lambda trace: (trace.id, trace.stats.sampling_rate)).values()
    joined = [trace for of_channel in pieces for trace in obspy.Stream(of_channel).merge(method=_ADJACENT)]
    readings = components_of_traces(with_channels, joined)
    if not (others := tags - used):
        return readings
    note = f"waveforms with the tag {' or '.join(sorted(others))} left out: ASDF states no unit of what was processed"
    return [replace(r, notes=(*r.notes, note)) if isinstance(r, Component) else r for r in readings]


def _own_member(group: "h5py.Group", name: str, kind: type[T]) -> T | None:
    """Return a member of a ``kind`` stored in the group itself; ``None`` without one: a link may lead into another file."""
    member = group.get(name) if isinstance(group.get(name, getlink=True), h5py.HardLink) else None
    return member if isinstance(member, kind) else None


def _channels(station: "h5py.Group") -> list[stationxml.Channel]:
    """Return the channels of a station's StationXML; [] without one, or if it is too large."""
    member = _own_member(station, "StationXML", h5py.Dataset)
    if member is None or member.external or member.size > stationxml.LARGEST:
        return []
    name = f"StationXML of {station.name.rpartition('/')[2]}"
    return stationxml.channels_of(np.asarray(member[()]).tobytes(), name)


def _traces(station: "h5py.Group", tags: Container[str]) -> "Iterator[obspy.Trace]":
    """Yield a station's waveforms with one of the ``tags``; raise ``InputError`` for no even series, too long or too many."""
    for number, name in enumerate(station):
        member, match = _own_member(station, name, h5py.Dataset), _NAME.fullmatch(name)
        if match is None or match["tag"] not in tags or member is None:
            continue
        is_series = member.ndim == 1 and member.dtype.kind in "iuf" and not member.external
        if number > _MOST_TRACES or not is_series or not 0 < member.size <= MOST_SAMPLES:
            raise InputError(f"{name}: no series of numbers, or too long; at most {MOST_SAMPLES:,} samples are read")
        rate, start = float(member.attrs["sampling_rate"]), float(member.attrs["starttime"]) * 1e-9
        if not (rate > 0 and is_step(1.0 / rate)) or not 0.0 <= start < _LATEST:
            raise InputError(f"{name}: sampling_rate = {rate:g}, starttime = {start:g} s; expected steps of {STEPS}")
        header = {
            **{key: value for key, value in match.groupdict().items() if key != "tag"},
            "sampling_rate": rate,
            "starttime": obspy.UTCDateTime(ns=int(member.attrs["starttime"])),
        }
        yield obspy.Trace(np.asarray(member[()], dtype=float), header)
