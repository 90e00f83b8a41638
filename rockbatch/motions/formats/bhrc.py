"""BHRC files of Iran's network (ISMN), Volume 1: three uncorrected components of digital recorders.

Each channel has 13 lines of text, 7 of integers and 7 of real numbers (13 characters each, the second line beginning
with the sampling rate), then its accelerations, ten to a line of 13 characters each, and a line "/&". The layout is
that of the Center's own files. What is corrected, or pairs of time and value as digitised from film, is refused.
"""

import re

from rockbatch.errors import InputError
from rockbatch.motions.component import Component, Seat
from rockbatch.motions.formats.fixed_width import fixed_numbers, number_in, one_after_another
from rockbatch.motions.formats.header_lines import found, line_at, number
from rockbatch.motions.formats.obspy_plugin import plugin
from rockbatch.motions.formats.record_file import RecordFile
from rockbatch.motions.formats.recording import Recording, to_components
from rockbatch.motions.motion import Unusable
from rockbatch.motions.orientation import Orientation
from rockbatch.motions.origin import origin_of

SUFFIXES: frozenset[str] = frozenset()

_HEADER = 27  # lines
_RATE = 21  # line of the header at which it begins
_WIDTH, _PER_LINE = 13, 10
_TITLE = re.compile(r"^\* *VOL(?P<volume>[0-9])DS +FILE: *(?P<file>\S+)")
_LABEL = re.compile(r"^COMP +(?P<label>[LVT])")
_PLACE = re.compile(r"^(?P<name>.*?) *Station\b")
_AZIMUTHS = re.compile(r"Azimuth +L +(?P<L>[0-9]{1,3}) +T +(?P<T>[0-9]{1,3})")
_COUNT = re.compile(r"NO\. OF POINTS *= *(?P<npts>[0-9]{1,9}) +DURATION *= *(?P<duration>[0-9.]{1,12})")
_UNIT = re.compile(r"UNITS ARE SEC(?:ONDS)? AND +(?P<unit>[A-Z0-9/]+)")


def is_bhrc(head: bytes) -> bool:
    """Whether the first bytes are the header of such a file, of whatever volume."""
    return _TITLE.match(head[:100].decode("latin-1")) is not None


def read_bhrc(file: RecordFile) -> list[Component | Unusable]:
    """The components of a file in m/s², without their offsets."""
    return to_components(file, _parse(file.text))


def _parse(text: str) -> list[Recording]:
    """The channels, one after the other; ``InputError`` with the line where the file is not whole."""
    return one_after_another(text, _channel)


def _channel(lines: list[str], at: int) -> tuple[Recording, int]:
    """The channel whose title is ``lines[at]``, and where the next one begins."""
    title = found(_TITLE, lines, at, "* VOL1DS FILE: …, after the last declared value")
    if title["volume"] != "1":
        raise InputError(f"line {at + 1}: Volume {title['volume']}, whose layout is not known; take the .V1 file")
    label = found(_LABEL, lines, at + 6, "COMP L1")["label"]
    place = found(_PLACE, lines, at + 7, "… Station … Azimuth L 324 T 54")["name"]
    azimuths = _AZIMUTHS.search(line_at(lines, at + 7))
    count = found(_COUNT, lines, at + 10, "NO. OF POINTS = … DURATION = …")
    unit = found(_UNIT, lines, at + 11, "UNITS ARE SECONDS AND G/10")["unit"]
    npts, duration = int(count["npts"]), number(count["duration"], at + 10)
    rate = number_in(line_at(lines, at + _RATE)[:_WIDTH], at + _RATE)
    if npts < 2 or not 0.1 <= rate <= 1e5 or abs(npts / rate - duration) > 2 / rate:
        raise InputError(
            f"line {at + 11} says {npts} points in {duration:g} s, line {at + _RATE + 1} {rate:g} samples per second; "
            "expected them to agree"
        )
    values = fixed_numbers(lines, at + _HEADER, npts, _WIDTH, _PER_LINE)
    end = at + _HEADER - -npts // _PER_LINE
    found(re.compile(r"^/&"), lines, end, f"/& after {npts} values; fetch it again")
    station, event = place.strip(), line_at(lines, at + 2).strip()
    recording = Recording(
        label=label,
        orientation=_orientation(label, azimuths),
        dt=float(f"{1.0 / rate:.12g}"),
        values=values,
        unit=unit,
        station=f"{title['file']}, {station}, {event}",
        codes=("I1", title["file"].partition("/")[0][:5], "", label),
        uncorrected=True,
        processed=False,
        seat=Seat(station.upper()),
        event=title["file"],
        origin=origin_of(date=event.removeprefix("Origin Time :"), station=station),
        header={"station": station, "event": event},
    )
    return recording, end + 1


def _orientation(label: str, azimuths: re.Match[str] | None) -> Orientation:
    """Up, or along the azimuth that the header has for L and T."""
    if label == "V":
        return Orientation(label, vertical=True)
    return Orientation(label, azimuth=None if azimuths is None else float(azimuths[label]) % 360.0)


is_bhrc_file, read_bhrc_stream = plugin("BHRC", is_bhrc, _parse)
