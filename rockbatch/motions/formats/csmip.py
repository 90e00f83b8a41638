"""CSMIP files (California Geological Survey, formerly CDMG): Volume 1 uncorrected, Volume 2 corrected.

Each channel has 13 (25) lines of text, 7 of integers (16I5) and 7 (13) of real numbers (8F10.3), a line that
declares count, interval and unit, and the accelerations, eight to a line; Volume 2 goes on with velocities and
displacements. ``/&`` ends a channel. Volume 3 has spectra. Source: Shakal & Huang (1985), "Standard tape format
for CSMIP strong-motion data tapes", OSMS 85-03; later files as CGS writes them, with the format in the line
that declares the data. Pairs of time and value, as digitised from film, are read by ``renadic``.
"""

import re

from rockbatch.common.errors import InputError, NoRecordError
from rockbatch.motions.component import Sensor
from rockbatch.motions.formats.declared_series import declared_series
from rockbatch.motions.formats.fixed_width import number_in, one_after_another
from rockbatch.motions.formats.header_lines import CLOCK, layout, line_at, moment_of, past_mark, read_header
from rockbatch.motions.formats.obspy_plugin import plugin
from rockbatch.motions.formats.recording import Recording
from rockbatch.motions.formats.renadic import is_renadic
from rockbatch.motions.origin import origin_of

_DATA = {1: 27, 2: 45}  # lines of a channel's header, by volume
_TITLE = re.compile(r"\s*uncorrected accelerogram data\b", re.IGNORECASE)
_DAY = r"(?P<month>\d{1,2})/(?P<day>\d{1,2})/(?P<year>\d{4}|\d{2})"
_CLOCK = rf"{CLOCK} *(?:UTC|GMT|\(GPS\)|\(Q=|$)"
_TEXT = layout(  # in the lines that Volumes 1 and 2 have in common
    (
        6,
        r"(?ai)chan +(?P<number>\d{1,3}): *(?P<label>.*?) *(?:deg(?:r|rees)?\b.*)?(?:\(|location:|$)",
        "Chan  1: 90 Deg",
    ),
    (4, r"(?i)station +(?:no|id)\. +(?P<station>\S+)", "Station No. …"),
    (6, r"(?i)location: *(?P<place>\S.*?) *$", ""),
    (6, r"(?ai)sta +chn: *(?P<of_station>\d{1,3})", ""),
    (3, r"(?a)^\d+\.(?P<network>[A-Z0-9]{1,2})\.(?P<code>[A-Z0-9]{1,5})\.(?P<location>[A-Z0-9-]{2})\.", ""),
    (3, rf"(?ai)start time: *{_DAY},? *{_CLOCK}", ""),
)
_AGAIN = {  # where a header says once more what declares the data
    1: layout(
        (10, r"(?ai)no\. of points *= *(?P<npts>\d{1,9})", ""), (10, r"(?ai)at +(?P<rate>[\d.]{1,12}) *samples/sec", "")
    ),
    2: layout(
        (15, r"(?ai)^ *(?P<npts>\d{1,9}) +points of", ""), (16, r"(?ai)intervals of +(?P<dt>[\d.]{1,12}) *sec", "")
    ),
}
_PEAK = {  # and the peak, with its unit
    1: layout((11, r"(?ai)max *= *[-+]?(?P<peak>\d*\.\d+) *(?P<unit>g)\b", "")),
    2: layout((17, r"(?ai)peak acceleration *= *[-+]?(?P<peak>\d*\.\d+) *(?P<unit>cm/sec/sec)", "")),
}


def is_csmip(head: bytes) -> bool:
    """Return whether the first bytes are the header of a Volume 1, 2 or 3 file, but not of pairs of time and value."""
    return _volume(head.decode("latin-1").splitlines(), 0) is not None and not is_renadic(head)


def parse(text: str) -> list[Recording]:
    """Return the channels, one after the other; ``InputError`` with the line where the file is not whole."""
    return one_after_another(text, _channel)


def _volume(lines: list[str], first: int) -> int | None:
    """Return the volume of the channel that begins at ``lines[first]``: each has one title more above that of Volume 1."""
    return next((i + 1 for i in range(3) if _TITLE.match(line_at(lines, first + i))), None)


def _channel(lines: list[str], first: int) -> tuple[Recording, int]:
    """Return the channel whose title is ``lines[first]``, and where the next one begins."""
    volume = _volume(lines, first)
    if volume is None:
        raise InputError(
            f'line {first + 1}: found "{lines[first].strip()[:60]}"; expected "Uncorrected accelerogram data"'
        )
    if volume == 3:
        raise NoRecordError(
            f"line {first + 1}: Volume 3, spectra; expected accelerations: take the .V2 file of this record"
        )
    header = first + volume - 1
    fields, peak = read_header(lines, header, _TEXT), read_header(lines, first, _PEAK[volume])
    station, place, coded = fields["station"], fields["place"], bool(fields["code"])
    location = fields["location"].strip("-")
    record = line_at(lines, header + 3).split("  ")[0].strip()
    dt, series, end = declared_series(lines, first + _DATA[volume])
    values, unit = series["acc"]
    _check_again(lines, first, volume, len(values), dt)
    event, date, name = (line_at(lines, header + i) for i in (1, 2, 5))
    return (
        Recording(
            label=fields["label"],
            dt=dt,
            values=values,
            unit=unit,
            station=", ".join(filter(None, [station, record, place, f"Volume {volume}"])),
            codes=(fields["network"], fields["code"] or station[:5], location, fields["label"].upper()),
            start=_start(fields),
            processed=volume == 2,
            sensor=Sensor(
                station=fields["code"] or station,
                network=fields["network"] if coded else None,
                location=location if coded else None,
                place=place.upper() if place else None,
                channel=fields["of_station"] or fields["number"],  # of the station, which other recorders may share
            ),
            event=f"{event} {date.partition('(')[0]}",
            origin=origin_of(_left_half(event), _left_half(name) or station, _left_half(date)),
            velocities=series.get("vel"),  # the header's initial velocity has the wrong sign in files of the USGS
            displacements=series.get("dis"),
            stated_peak=(peak["peak"], peak["unit"]),
            notes=(f"channel {fields['number']}: {place}",) if place else (),
            header={"station": name.strip(), "record": record},
        ),
        past_mark(lines, end, "the declared values"),
    )


def _left_half(line: str) -> str:
    """Return the left half of a line, whose right half is about the recorder in some files."""
    return re.split(r"   |\(", line)[0]


def _check_again(lines: list[str], first: int, volume: int, npts: int, dt: float) -> None:
    """Raise ``InputError`` where the header's text contradicts the line that declares the data."""
    for offset, pattern, _ in _AGAIN[volume]:
        match = pattern.search(line_at(lines, first + offset))
        if match is None:
            continue
        key, text = next(iter(match.groupdict().items()))
        declared = {"npts": npts, "rate": 1.0 / dt, "dt": dt}[key]
        if abs(number_in(text, first + offset) - declared) > 1e-6 * declared:
            raise InputError(
                f'line {first + offset + 1}: "{match[0].strip()}" contradicts line {first + _DATA[volume] + 1}: '
                f"{npts} points at intervals of {dt:g} s"
            )


def _start(fields: dict[str, str]) -> float | None:
    """Return the time of the first sample [s since 1970]; ``None`` for older files, which have the time of triggering."""
    if len(fields["year"]) == 2:
        fields = {**fields, "year": f"{19 if int(fields['year']) >= 30 else 20}{fields['year']}"}
    return moment_of(fields)


is_csmip_file, read_csmip_stream = plugin("CSMIP", is_csmip, parse)
