"""SAC (binary): one component, in a unit that its header does not tell reliably."""

from typing import Literal

import numpy as np

from rockbatch.common.lazy import obspy
from rockbatch.common.units import acceleration_factor
from rockbatch.motions.component import FIRST_YEAR, Component, Sensor
from rockbatch.motions.formats.record_file import RecordFile, no_acceleration, unstated
from rockbatch.motions.formats.with_obspy import read_stream
from rockbatch.motions.motion import Unusable
from rockbatch.motions.orientation import Orientation, is_clock, not_acceleration, orientation_of, split_stem, unknown
from rockbatch.motions.origin import Origin, origin_of

_LEVEL = 10.0  # degrees that a horizontal component may be off the horizontal
_KIND_AT = 86 * 4  # header word IDEP
_KINDS = {6: "displacements (IDEP 6)", 7: "velocities (IDEP 7)"}
_VERSION_AT = 76 * 4  # header word NVHDR, 6 or 7


def is_sac(head: bytes) -> bool:
    """Return whether the first bytes are a binary SAC header, in either byte order."""
    word = head[_VERSION_AT : _VERSION_AT + 4]
    return len(word) == 4 and any(int.from_bytes(word, order) in (6, 7) for order in ("little", "big"))


def read_sac(file: RecordFile) -> list[Component | Unusable]:
    """Return the component of a SAC file, in the unit that the study states: data / sensitivity × unit.

    SAC's own entry for the kind of data (IDEP) says no unit: files in g that claim nm/s² are common. Velocities and
    displacements are refused by it, and by the channel of a seismometer, unless a manifest states the file's unit.
    """
    options = file.options
    (trace,) = read_stream(file.data, "SAC")
    stats = trace.stats
    if is_clock(stats.channel):
        return [Unusable(file.stem, file.source, "the recorder's clock, no ground motion", stats.channel)]
    if (kind := _KINDS.get(_kind(file.data)) or not_acceleration(stats.channel)) and "unit" not in options.instead:
        raise no_acceleration("its header says that it", kind)
    if options.unit is None and options.sensitivity is None:
        raise unstated(
            "SAC files do not tell their unit reliably", 'unit = "g" (or sensitivity = … for counts per m/s²)', "unit"
        )
    start = stats.starttime.timestamp
    factor = acceleration_factor(options.unit or "m/s2", file.gravity) / (options.sensitivity or 1.0)
    orientation = orientation_of(stats.channel) or _by_angles(stats.sac) or split_stem(file.stem)[1]
    codes = (stats.network, stats.station, stats.location, stats.channel[:-1])
    return [
        Component(
            name=file.stem,
            dt=float(str(np.float32(stats.delta))),  # the shortest decimal that a header of four bytes may mean
            acceleration=trace.data.astype(float) * factor,
            orientation=orientation or unknown(stats.channel),
            station=".".join(codes) if stats.station else "",
            source=file.source,
            start=start,
            sensor=Sensor(stats.station if start >= FIRST_YEAR else "", stats.network, stats.location),
            unit=options.unit or "m/s2",
            raw=True,
            origin=_origin(stats, start),
            notes=(f"unit {options.unit or 'm/s2'} as stated",),
        )
    ]


def _kind(data: bytes) -> int:
    """Return the header's kind of data (IDEP), in the byte order of its version."""
    order: Literal["little", "big"] = (
        "little" if int.from_bytes(data[_VERSION_AT : _VERSION_AT + 4], "little") in (6, 7) else "big"
    )
    return int.from_bytes(data[_KIND_AT : _KIND_AT + 4], order, signed=True)


def _origin(stats: "obspy.core.trace.Stats", start: float) -> Origin:
    """Return the origin by the header's name of the event (KEVNM), or the day of the record."""
    day = stats.starttime.strftime("%Y-%m-%d") if start >= FIRST_YEAR else ""
    return origin_of(str(stats.sac.get("kevnm", "")), f"{stats.network}.{stats.station}".strip("."), day)


def _by_angles(sac: dict[str, float]) -> Orientation | None:
    """Return the orientation by CMPAZ (from north) and CMPINC (from upward vertical) [degrees], if both are set and it is one."""
    if "cmpinc" not in sac or "cmpaz" not in sac:
        return None
    azimuth, inclination = float(sac["cmpaz"]), float(sac["cmpinc"])
    if inclination in (0.0, 180.0):
        return Orientation("", vertical=True, down=inclination == 180.0)
    return Orientation("", azimuth=azimuth % 360.0) if abs(inclination - 90.0) <= _LEVEL else None
