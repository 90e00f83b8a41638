"""ASDF, the Adaptable Seismic Data Format (HDF5): waveforms in counts, with the StationXML of each station beside them.

Read by h5py as plain numbers: groups "Waveforms/NET.STA", in them "StationXML" and data sets "NET.STA.LOC.CHA__begins__ends__tag"
with the attributes ``starttime`` [ns since 1970] and ``sampling_rate`` [Hz]. Source: https://asdf-definition.readthedocs.io.
"""

import io
import re
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np

from rockbatch.common.errors import InputError
from rockbatch.common.lazy import h5py, obspy
from rockbatch.motions import stationxml
from rockbatch.motions.component import Component
from rockbatch.motions.formats.miniseed import of_traces
from rockbatch.motions.limits import MOST_SAMPLES, STEPS, is_step
from rockbatch.motions.motion import Unusable
from rockbatch.motions.record_file import RecordFile

_MAGIC = b"\x89HDF\r\n\x1a\n"
_NAME = re.compile(r"(?P<network>\w{0,8})\.(?P<station>\w{1,8})\.(?P<location>\w{0,8})\.(?P<channel>\w{1,8})__.*")
_MOST_TRACES = 1000
_LATEST = 4102444800.0  # s since 1970: 2100


def is_hdf5(head: bytes) -> bool:
    """Return whether the first bytes are those of an HDF5 file."""
    return head.startswith(_MAGIC)


def read_asdf(file: RecordFile) -> list[Component | Unusable]:
    """Return one component per channel and event of an ASDF file; ``InputError`` for another HDF5 file, or a damaged one."""
    try:
        with h5py.File(io.BytesIO(file.data), "r") as store:
            waveforms = _group(store, "Waveforms")
            if waveforms is None:
                raise InputError(
                    "an HDF5 file without the group Waveforms of ASDF; write it as MiniSEED, or as text columns"
                )
            stations = [station for name in waveforms if (station := _group(waveforms, name)) is not None]
            channels = [channel for station in stations for channel in _channels(station)]
            traces = [trace for station in stations for trace in _traces(station)]
    except (OSError, KeyError, OverflowError, RuntimeError, TypeError, ValueError) as error:
        if isinstance(error, InputError):
            raise
        raise InputError(f"not an HDF5 file that can be read ({type(error).__name__}); fetch it again") from None
    if not traces:
        raise InputError("holds no waveforms")
    return of_traces(replace(file, inventories=file.inventories.also(channels)), traces)


def _own(group: Any, name: str) -> Any:
    """Return what a group holds itself under a name; ``None`` for links, which may lead into other files."""
    return group.get(name) if isinstance(group.get(name, getlink=True), h5py.HardLink) else None


def _group(group: Any, name: str) -> Any:
    own = _own(group, name)
    return own if isinstance(own, h5py.Group) else None


def _channels(station: Any) -> list[stationxml.Channel]:
    """Return the channels of a station's StationXML, if it has one."""
    own = _own(station, "StationXML")
    if not isinstance(own, h5py.Dataset) or own.external or own.size > stationxml.LARGEST:
        return []
    name = f"StationXML of {station.name.rpartition('/')[2]}"
    return stationxml.channels_of(np.asarray(own[()]).tobytes(), name)


def _traces(station: Any) -> "Iterator[obspy.Trace]":
    """Yield the waveforms of a station."""
    for number, name in enumerate(station):
        own, match = _own(station, name), _NAME.fullmatch(name)
        if match is None or not isinstance(own, h5py.Dataset):
            continue
        is_series = own.ndim == 1 and own.dtype.kind in "iuf" and not own.external
        if number > _MOST_TRACES or not is_series or not 0 < own.size <= MOST_SAMPLES:
            raise InputError(f"{name}: no series of numbers, or too long; at most {MOST_SAMPLES:,} samples are read")
        rate, start = float(own.attrs["sampling_rate"]), float(own.attrs["starttime"]) * 1e-9
        if not (rate > 0 and is_step(1.0 / rate)) or not 0.0 <= start < _LATEST:
            raise InputError(f"{name}: sampling_rate = {rate:g}, starttime = {start:g} s; expected steps of {STEPS}")
        header = {
            **match.groupdict(),
            "sampling_rate": rate,
            "starttime": obspy.UTCDateTime(ns=int(own.attrs["starttime"])),
        }
        yield obspy.Trace(np.asarray(own[()], dtype=float), header)
