"""SAC (binary): one component, in a unit that its header does not tell reliably."""

from typing import TYPE_CHECKING

from rockbatch.errors import UnstatedError
from rockbatch.motions.component import Component, Seat
from rockbatch.motions.formats.record_file import RecordFile
from rockbatch.motions.formats.with_obspy import read_stream
from rockbatch.motions.motion import Unusable
from rockbatch.motions.orientation import Orientation, is_clock, orientation_of, split_stem, unknown
from rockbatch.motions.origin import Origin, origin_of
from rockbatch.units import acceleration_factor

if TYPE_CHECKING:
    from obspy.core.trace import Stats

SUFFIXES = frozenset({".sac"})

_FIRST_YEAR = 365 * 86400.0  # s since 1970: no recorder began in it, but headers without a time say so
_LEVEL = 10.0  # degrees that a horizontal component may be off the horizontal
_VERSION_AT = 76 * 4  # header word NVHDR, 6 or 7


def is_sac(head: bytes) -> bool:
    """Whether the first bytes are a binary SAC header, in either byte order."""
    word = head[_VERSION_AT : _VERSION_AT + 4]
    return len(word) == 4 and any(int.from_bytes(word, order) in (6, 7) for order in ("little", "big"))


def read_sac(file: RecordFile) -> list[Component | Unusable]:
    """The component of a SAC file, in the unit that the study states: data / sensitivity × unit.

    SAC's own entry for the kind of data (IDEP) is not used: files in g that claim nm/s² are common.
    """
    options = file.options
    (trace,) = read_stream(file.data, "SAC")
    stats = trace.stats
    if is_clock(stats.channel):
        return [Unusable(file.stem, file.source, "the recorder's clock, no ground motion", stats.channel)]
    if options.unit is None and options.sensitivity is None:
        raise UnstatedError(
            'SAC files do not tell their unit reliably; state it in the study, e.g. unit = "g" '
            "(or sensitivity = … for counts per m/s²)",
            "unit",
        )
    start = stats.starttime.timestamp
    factor = acceleration_factor(options.unit or "m/s2", file.gravity) / (options.sensitivity or 1.0)
    orientation = orientation_of(stats.channel) or _by_angles(stats.sac) or split_stem(file.stem)[1]
    codes = (stats.network, stats.station, stats.location, stats.channel[:-1])
    return [
        Component(
            name=file.stem,
            dt=float(stats.delta),
            acceleration=trace.data.astype(float) * factor,
            orientation=orientation or unknown(stats.channel),
            station=".".join(codes) if stats.station else "",
            source=file.source,
            start=start,
            seat=Seat(stats.station if start >= _FIRST_YEAR else "", stats.network, stats.location),
            unit=options.unit or "m/s2",
            raw=True,
            origin=_origin(stats, start),
            notes=(f"unit {options.unit or 'm/s2'} as stated",),
        )
    ]


def _origin(stats: "Stats", start: float) -> Origin:
    """By the header's name of the event (KEVNM), or the day of the record."""
    day = stats.starttime.strftime("%Y-%m-%d") if start >= _FIRST_YEAR else ""
    return origin_of(str(stats.sac.get("kevnm", "")), f"{stats.network}.{stats.station}".strip("."), day)


def _by_angles(sac: dict[str, float]) -> Orientation | None:
    """Orientation by CMPAZ (from north) and CMPINC (from upward vertical) [degrees], where both are set and it is one."""
    if "cmpinc" not in sac or "cmpaz" not in sac:
        return None
    azimuth, inclination = float(sac["cmpaz"]), float(sac["cmpinc"])
    if inclination in (0.0, 180.0):
        return Orientation("", vertical=True, down=inclination == 180.0)
    return Orientation("", azimuth=azimuth % 360.0) if abs(inclination - 90.0) <= _LEVEL else None
