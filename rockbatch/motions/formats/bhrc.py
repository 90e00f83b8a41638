"""BHRC files of Iran's network (ISMN), Volume 1: three uncorrected components of digital recorders.

Each channel has 13 lines of text, 7 of integers and 7 of real numbers (13 characters each, the second line beginning
with the sampling rate), then its accelerations, ten to a line of 13 characters each, and a line "/&". The layout is
that of the Center's own files. Corrected files, and pairs of time and value digitised from film, are refused.
"""

import re

from rockbatch.common.errors import InputError
from rockbatch.motions.component import Sensor
from rockbatch.motions.formats.fixed_width import fixed_numbers, number_in, one_after_another
from rockbatch.motions.formats.header_lines import layout, line_at, past_mark, read_header
from rockbatch.motions.formats.obspy_plugin import plugin
from rockbatch.motions.formats.recording import Recording
from rockbatch.motions.formats.stated import Stated
from rockbatch.motions.labels.orientation import Orientation
from rockbatch.motions.labels.origin import origin_of

_HEADER = 27  # lines
_RATE = 21  # line of the header that begins with the sampling rate
_WIDTH, _PER_LINE = 13, 10
_TITLE = re.compile(r"^\* *VOL(?P<volume>[0-9])DS +FILE: *(?P<file>\S+)")
_DURATION = r"DURATION *= *(?P<duration>[0-9.]{1,12})"
_TEXT = layout(
    (6, r"^COMP +(?P<label>[LVT])", "COMP L1"),
    (7, r"^(?P<name>.*?) *Station\b", "… Station … Azimuth L 324 T 54"),
    (7, r"Azimuth +L +(?P<L>[0-9]{1,3}) +T +(?P<T>[0-9]{1,3})", ""),
    (10, rf"NO\. OF POINTS *= *(?P<npts>[0-9]{{1,9}}) +{_DURATION}", "NO. OF POINTS = … DURATION = …"),
    (11, r"UNITS ARE SEC(?:ONDS)? AND +(?P<unit>[A-Z0-9/]+)", "UNITS ARE SECONDS AND G/10"),
)


def is_bhrc(head: bytes) -> bool:
    """Return whether the first bytes are the title of a BHRC file, "* VOL1DS FILE: …", of whatever volume."""
    return _TITLE.match(head[:100].decode("latin-1")) is not None


def parse(text: str) -> list[Recording]:
    """Return the channels, one after the other; raise ``InputError`` with the line if the file is incomplete."""
    return one_after_another(text, _channel)


def _channel(lines: list[str], start: int) -> tuple[Recording, int]:
    """Return the channel whose title is ``lines[start]``, and the index of the line after it."""
    title = read_header(lines, start, [(0, _TITLE, "* VOL1DS FILE: …, after the last declared value")])
    if title["volume"] != "1":
        raise InputError(f"line {start + 1}: Volume {title['volume']}, whose layout is not known; take the .V1 file")
    fields = read_header(lines, start, _TEXT)
    label, npts = fields["label"], int(fields["npts"])
    rate = number_in(line_at(lines, start + _RATE)[:_WIDTH], start + _RATE)
    if npts < 2 or not 0.1 <= rate <= 1e5:
        raise InputError(
            f"line {start + 11} says {npts} points, line {start + _RATE + 1} {rate:g} samples per second; expected two or more, "
            "and a rate"
        )
    values, end = fixed_numbers(lines, start + _HEADER, npts, _WIDTH, _PER_LINE)
    station, event = fields["name"].strip(), line_at(lines, start + 2).strip()
    azimuth = float(fields[label]) % 360.0 if fields.get(label) else None
    recording = Recording(
        label=label,
        orientation=Orientation(label, vertical=label == "V", azimuth=azimuth),
        dt=float(f"{1.0 / rate:.12g}"),
        values=values,
        unit=fields["unit"],
        station=f"{title['file']}, {station}, {event}",
        codes=("I1", title["file"].partition("/")[0][:5], "", label),
        processed=False,
        sensor=Sensor(station.upper()),
        event=title["file"],
        stated=(Stated("duration", fields["duration"]),),
        origin=origin_of(date=event.removeprefix("Origin Time :"), station=station),
        header={"station": station, "event": event},
    )
    return recording, past_mark(lines, end, f"{npts} values")


is_bhrc_file, read_bhrc_stream = plugin("BHRC", is_bhrc, parse)
