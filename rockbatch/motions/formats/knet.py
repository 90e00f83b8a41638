"""K-NET and KiK-net (NIED, Japan): one component per file, counts with their scale in the header.

Seventeen lines of text, then eight counts to a line. The first sample is 15 s before the stated time, by the delay of the
recorders, which is nine hours ahead of UTC. The stated peak is without the offset.
"""

from datetime import UTC, datetime

from rockbatch.common.errors import InputError
from rockbatch.motions.component import Sensor
from rockbatch.motions.formats.fixed_width import lines_of, spaced_numbers
from rockbatch.motions.formats.header_lines import layout, moment_of, read_header
from rockbatch.motions.formats.recording import Recording
from rockbatch.motions.formats.stated import Stated
from rockbatch.motions.labels.orientation import orientation_of, unknown
from rockbatch.motions.labels.origin import origin_of

_HEADER, _PER_LINE = 17, 8
_JAPAN, _DELAY = 9 * 3600.0, 15.0  # s
_TIME = r"(?P<year>\d{4})/(?P<month>\d\d)/(?P<day>\d\d) (?P<hour>\d\d):(?P<minute>\d\d):(?P<second>\d\d)"
_EVENT = layout((0, rf"(?a)^Origin Time +{_TIME}", "Origin Time 2018/01/24 19:51:00"))
_TEXT = layout(
    (5, r"(?a)^Station Code +(?P<station>\w{1,7})\s*$", "Station Code AOM003"),
    (9, rf"(?a)^Record Time +{_TIME}", "Record Time 2018/01/24 19:51:38"),
    (10, r"(?a)^Sampling Freq\(Hz\) +(?P<rate>[1-9]\d{0,4}) *Hz", "Sampling Freq(Hz) 100Hz"),
    (11, r"(?a)^Duration Time\(s\) +(?P<seconds>\d{1,6}(?:\.\d{1,6})?)\s*$", "Duration Time(s) 128"),
    (12, r"^Dir\. +(?P<channel>\S+)", "Dir. N-S"),
    (13, r"(?a)^Scale Factor +(?P<gal>\d{1,9})\(gal\)/(?P<per>[1-9]\d{0,11})\s*$", "Scale Factor 7845(gal)/8223790"),
    (14, r"(?a)^Max\. Acc\. \(gal\) +(?P<peak>-?\d{1,6}\.\d{1,6})\s*$", "Max. Acc. (gal) 22.485"),
    (16, r"^Memo\.", "Memo."),
)
_CHANNELS = {"1": "NS1", "2": "EW1", "3": "UD1", "4": "NS2", "5": "EW2", "6": "UD2"}
_LEVELS = {"1": "KiK-net sensor 1: in the borehole", "2": "KiK-net sensor 2: at the surface"}
_PLACES = {"1": "borehole", "2": "surface"}


def is_knet(head: bytes) -> bool:
    """Return whether the first bytes are "Origin Time", with which ASCII files of K-NET and KiK-net begin."""
    return head.startswith(b"Origin Time")


def parse(text: str) -> list[Recording]:
    """Return the recording in a list; raise ``InputError`` with the line if it is incomplete."""
    lines = lines_of(text)
    quake, start = moment_of(read_header(lines, 0, _EVENT)), moment_of(header := read_header(lines, 0, _TEXT))
    day = "" if quake is None else datetime.fromtimestamp(quake - _JAPAN, UTC).strftime("%Y-%m-%d %H:%M")
    station, rate, duration = header["station"], int(header["rate"]), float(header["seconds"])
    npts = round(duration * rate)
    if npts < 2 or abs(npts - duration * rate) > 1e-6:
        raise InputError(f"line 12: found {duration:g} s at {rate} Hz; expected a whole number of samples above 1")
    scale = 0.01 * float(header["gal"]) / float(header["per"])
    channel = _CHANNELS.get(header["channel"], header["channel"].replace("-", ""))
    level = channel[2:]
    return [
        Recording(
            label=channel,
            orientation=orientation_of(channel[:2]) or unknown(channel),
            dt=1.0 / rate,
            values=spaced_numbers(lines, _HEADER, npts, _PER_LINE) * scale,
            unit="m/s2",
            counts=True,
            station=f"{station}.{level}" if level else station,
            start=None if start is None else start - _JAPAN - _DELAY,
            processed=False,
            origin=origin_of(date=day, station=station),
            sensor=Sensor(station, location=level, place=_PLACES.get(level)),
            stated=(Stated("peak", header["peak"], "gal"),),
            notes=(_LEVELS[level],) if level in _LEVELS else (),
        )
    ]
