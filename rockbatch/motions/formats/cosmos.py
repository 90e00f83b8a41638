"""COSMOS strong-motion files (text, v01.00 to v01.20): uncorrected V1 and corrected V2 accelerations.

Each channel has lines of text, then integers, real numbers and comments, each below a line with their count and Fortran
format, then its values below a line with their count, unit and format, and a line "End-of-data" (in some of CGS's files
"/&  --- End of data"). The ground's initial state follows from velocities and displacements in the same file, else from
real numbers 68 [cm/s] and 69 [cm]. The sampling interval is real number 62 [ms]; number 34 is that of the recorder. Source:
COSMOS (2001), "COSMOS strong motion data format", version 1.20; for 68 and 69 the USGS's program PRISM.
"""

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace

from rockbatch.common.errors import InputError, NoRecord
from rockbatch.common.units import acceleration_factor
from rockbatch.motions.component import Sensor
from rockbatch.motions.formats.fixed_width import fixed_numbers, lines_of, number_in
from rockbatch.motions.formats.header_lines import layout, line_at, match_line, moment, read_header, search_lines
from rockbatch.motions.formats.obspy_plugin import plugin
from rockbatch.motions.formats.recording import Recording, other_direction
from rockbatch.motions.formats.stated import Stated
from rockbatch.motions.labels.orientation import is_upward, orientation_of
from rockbatch.motions.labels.origin import origin_of
from rockbatch.motions.motion import Initial, Samples
from rockbatch.motions.quality.places import tells_place

_UNITS = {2: "g", 4: "cm/s2", 10: "gal"}  # the specification's unit codes of accelerations
_DIRECTIONS = {400: "Up", 401: "Down", 402: "Vert", 600: "Long", 601: "Tran", 700: "H1", 701: "H2"}  # else azimuths
_STRUCTURES = {10: "building", 11: "bridge", 12: "dam", 13: "wharf", 14: "tunnel", 15: "lifeline", 20: "other"}
_HEADERS = 100  # integers, and real numbers
_TITLE = re.compile(
    r"^(?P<what>\S.*?) *\(Format v(?P<version>\d\d\.\d\d) with +(?P<lines>\d{1,3}) text lines\)", re.I | re.A
)
_NUMBERS = re.compile(
    r"^ *(?P<count>\d{1,5}) +(?P<what>Integer|Real)-header values follow on +\d{1,5} +lines, *Format *= *\((?P<format>[^)]*)\)",
    re.I | re.A,
)
_COMMENTS = re.compile(r"^ *(?P<count>\d{1,5}) +Comment line", re.I | re.A)
_VALUES = re.compile(
    r"^ *(?P<npts>\d{1,9}) +(?P<what>[a-z][a-z. ]*?) +(?:pts|points|counts), *approx\.? +(?P<seconds>\d{1,9}) *secs?, *"
    r"units *= *(?P<unit>[^ ,(]*?)\.? *\( *(?P<code>\d{1,3}) *\),? *Format *= *\((?P<format>[^)]*)\)",
    re.I | re.A,
)
_END = re.compile(r"^ *(?:/&[ -]*)?End[- ]of[- ]data", re.I)
_FORMAT = re.compile(r" *(?:\dP,?)?(?P<per_line>[1-9]\d?)?[IFED](?P<width>[1-9]\d?)(?:\.\d{1,2})? *", re.I | re.A)
_UNKNOWN = re.compile(r"unspecified: *-?\d+, *(?P<real>-?[\d.]{1,12})", re.I | re.A)
_STATION, _SENSOR = 4, 8  # lines of the header's text
_TEXT = layout(
    (_STATION, r"(?i)Code: *(?P<network>[^- ]*)-(?P<code>\S*)(?P<words>.*)", ""),
    (_SENSOR, r"(?i)^Sta Chan?:? *(?P<number>[\d?]*) *: *(?P<label>.*?) *(?:deg\b[^(]*)?(?:\(|$)", ""),
    (_SENSOR, r"(?i)Location: *(?P<place>\S.*?) *$", ""),
)
_SCNL = re.compile(r"<SCNL>(?P<station>\w*)\.(?P<channel>\w*)\.(?P<network>\w*)\.(?P<location>[\w-]*)", re.A)


@dataclass(frozen=True)
class _Header:
    """The header of a channel."""

    what: str  # quantity and stage, by its title
    text: list[str]
    fields: Mapping[str, str]  # groups of _TEXT
    integers: list[int]  # counted from 1 in the specification, from 0 here
    reals: list[float]  # likewise
    comments: str
    unknown: float  # marks unknown numbers and missing values
    end: int  # index of the first line after it


def is_cosmos(head: bytes) -> bool:
    """Return whether the first bytes are the first line of a COSMOS file, of any quantity."""
    return _TITLE.match(line_at(lines_of(head.decode("latin-1")), 0)) is not None


def parse(text: str) -> list[Recording]:
    """Return the channels of acceleration, with velocities and displacements of the same sensor that follow them.

    Raises ``InputError`` with the line if the file is incomplete, and if it holds no accelerations.
    """
    lines = lines_of(text)
    recordings: list[tuple[Recording, _Header]] = []
    quantities: list[str] = []
    header: _Header | None = None
    index = 0
    while index < len(lines):
        if not lines[index].strip():
            index += 1
            continue
        if header is None or _TITLE.match(line_at(lines, index)):
            header = _header(lines, index)
            index = header.end
        series = match_line(
            _VALUES, lines, index, "… acceleration pts, approx … secs, units=cm/sec2(04),Format=(8F10.5)"
        )
        values, end = _values(lines, index, series)
        if series["what"].lower().startswith("accel"):
            recordings.append((_recording(header, series, values, index), header))
        else:
            quantities.append(series["what"])
            if recordings and _sensor_lines(recordings[-1][1]) == _sensor_lines(header):
                recordings[-1] = (_with_series(recordings[-1][0], series, values), header)
        index = end
    if not recordings:
        raise NoRecord(
            f"holds {' and '.join(quantities) or 'nothing'}; expected accelerations: take the file that has them"
        )
    return [recording for recording, _ in recordings]


def _sensor_lines(header: _Header) -> list[str]:
    """Return the lines of a header's text for station and sensor."""
    return [line_at(header.text, i) for i in (_STATION, _SENSOR)]


def _with_series(recording: Recording, series: re.Match[str], values: Samples) -> Recording:
    """Return a recording with the velocities or displacements of a further series; itself for other quantities."""
    quantity, samples = series["what"].lower(), (values, series["unit"])
    if quantity.startswith("vel"):
        return replace(recording, velocities=samples)
    return replace(recording, displacements=samples) if quantity.startswith("dis") else recording


def _header(lines: list[str], start: int) -> _Header:
    """Return the header that begins at ``lines[start]``; raise ``InputError`` with the line if it is incomplete or of spectra."""
    title = match_line(_TITLE, lines, start, "Corrected acceleration    (Format v01.20 with 13 text lines)")
    if "spectr" in title["what"].lower():
        raise NoRecord(f"line {start + 1}: spectra; expected accelerations: take the V2 file of this record")
    end = start + int(title["lines"])
    text = [line_at(lines, i) for i in range(start, end)]
    numbers = []
    for kind in ("Integer", "Real"):
        fields = match_line(_NUMBERS, lines, end, f"100 {kind}-header values follow on … lines, Format= …")
        count = int(fields["count"])
        if fields["what"].lower() != kind.lower() or count < _HEADERS:
            raise InputError(f'line {end + 1}: found "{fields[0].strip()}"; expected {_HEADERS} {kind}-header values')
        values, end = fixed_numbers(lines, end + 1, count, *_width_and_count(fields["format"], end))
        numbers.append(values)
    comments = int(match_line(_COMMENTS, lines, end, "… Comment line(s) follow")["count"])
    unknown = search_lines(_UNKNOWN, text)
    return _Header(
        what=title["what"],
        text=text,
        fields=read_header(text, 0, _TEXT),
        integers=[int(value) for value in numbers[0]],
        reals=[float(value) for value in numbers[1]],
        comments="\n".join(lines[end + 1 : end + 1 + comments]),
        unknown=number_in(unknown["real"], start + len(text) - 1) if unknown else -999.0,
        end=end + 1 + comments,
    )


def _width_and_count(text: str, index: int) -> tuple[int, int]:
    """Return width and numbers per line of a Fortran format: (10, 8) of 8F10.5. Raises ``InputError`` for other texts."""
    match = _FORMAT.fullmatch(text)
    if match is None:
        raise InputError(f'line {index + 1}: found the format "({text[:20]})"; expected one such as (8F10.5)')
    return int(match["width"]), int(match["per_line"] or 1)


def _values(lines: list[str], index: int, series: re.Match[str]) -> tuple[Samples, int]:
    """Return the values declared by ``lines[index]``, shape (npts,), and the index of the line after their end mark."""
    npts = int(series["npts"])
    if npts < 1:
        raise InputError(f"line {index + 1}: found {npts} values; expected some")
    values, end = fixed_numbers(lines, index + 1, npts, *_width_and_count(series["format"], index))
    match_line(_END, lines, end, f"End-of-data … after {npts} values; fetch it again")
    return values, end + 1


def _recording(header: _Header, series: re.Match[str], values: Samples, index: int) -> Recording:
    """Return the recording of accelerations declared by ``lines[index]``; raise ``InputError`` if values are missing."""
    interval, length, peak, time_of_peak = header.reals[61:65]
    if not 0 < interval < 1e5:
        raise InputError(f"real number 62 of the header says an interval of {interval:g} ms; expected a number above 0")
    missing = int((values == header.unknown).sum())
    if missing and (peak == header.unknown or abs(peak) < abs(header.unknown)):
        raise InputError(
            f"{missing} of {len(values)} values are {header.unknown:g}, which marks those that are missing"
        )
    fields, seed = header.fields, _SCNL.search(header.comments)
    network, station, place = fields["network"], fields["code"], _place(header)
    location, channel = (seed["location"].strip("-"), seed["channel"]) if seed else ("", "")
    corrected = not header.what.lower().startswith(("raw", "uncorr"))
    description = ", ".join(filter(None, [location, place, "corrected" if corrected else "uncorrected"]))
    event = line_at(header.text, 1)
    # "USGS  AK:Anchorage;R B Atwood Bld"
    name = re.sub(r"^[A-Z]{2}:", "", re.split(r" {2,}", fields["words"].strip())[-1])
    year, month, day, hour, minute = (header.integers[i] for i in (39, 41, 42, 43, 44))
    stated = [Stated("duration", series["seconds"])]
    for quantity, value in (("duration", length), ("peak", peak), ("time of the peak", time_of_peak)):
        if value != header.unknown:
            stated.append(Stated(quantity, f"{value:.5f}"))
    label, code = _label(header, channel), header.integers[53]
    velocity, moved = (None if value == header.unknown else value / 100 for value in header.reals[67:69])
    return Recording(
        label=label,
        dt=float(f"{interval / 1000:.12g}"),
        values=values,
        unit=_unit(header, series, index),
        station=f"{network}-{station}, {description}" if station else "",
        codes=(network, station, location, channel),
        start=moment(year, month, day, hour, minute, header.reals[29]),
        processed=corrected,
        sensor=Sensor(
            station, network, location if seed else None, place.upper() or None, fields["number"].strip("?") or None
        ),
        event=event,
        initial=Initial(velocity, moved or 0.0) if corrected and velocity is not None else None,
        origin=origin_of(event, name or station, line_at(header.text, 3)),
        stated=tuple(stated),
        notes=(f"location: {place}",) if place else (),
        findings=other_direction(label, str(code) if 1 <= code <= 360 else "", "as integer 54"),
        header={"station": line_at(header.text, _STATION).strip(), "event": event.strip()},
    )


def _place(header: _Header) -> str:
    """Return the location in words; with the station's type (integer 19), if that is a structure and the words tell no place."""
    words, structure = header.fields["place"], _STRUCTURES.get(header.integers[18])
    if structure is None or tells_place(words):
        return words
    return f"{words} (structure type: {structure})".strip()


def _unit(header: _Header, series: re.Match[str], index: int) -> str:
    """Return the unit of the accelerations by its code; raise ``InputError`` unless it is known, and header and text agree."""
    code, text = int(series["code"]), series["unit"]
    unit = _UNITS.get(code)
    if unit is None:
        raise InputError(
            f'line {index + 1}: found the unit "{text}({code:02d})"; expected cm/sec2(04), g(02) or gal(10): '
            "take the V1 or V2 file of this record"
        )
    try:
        confirmed = acceleration_factor(text or unit) == acceleration_factor(unit)
    except ValueError:
        confirmed = False
    if not confirmed or header.integers[2] not in (code, int(header.unknown)):
        raise InputError(
            f'line {index + 1}: found the unit "{text}({code:02d})", and code {header.integers[2]} as integer 3 of the '
            "header; expected them to agree"
        )
    return unit


def _label(header: _Header, channel: str) -> str:
    """Return the direction by the header's text, else by its code (integer 54), else by the SEED channel.

    It is the one that says up or down, if the others say vertical; the text, perhaps "", if none of them is known.
    """
    code, stated = header.integers[53], header.fields["label"]
    by_code = _DIRECTIONS.get(code, str(code) if 1 <= code <= 360 else "")
    directions = {label: way for label in (stated, by_code, channel) if (way := orientation_of(label))}
    signed = {label: way.down for label, way in directions.items() if way.down or is_upward(label)}
    if len({way.vertical for way in directions.values()}) > 1 or len(set(signed.values())) > 1:
        raise InputError(f"directions contradict each other: {' and '.join(directions)}; repair the header")
    return next(iter((*signed, *directions)), stated)


is_cosmos_file, read_cosmos_stream = plugin("COSMOS", is_cosmos, parse)
