"""CSMIP files (California Geological Survey, formerly CDMG): Volume 1 uncorrected, Volume 2 corrected.

Each channel has 13 (25) lines of text, 7 of integers (16I5) and 7 (13) of real numbers (8F10.3), a line that
declares count, interval and unit, and the accelerations, eight to a line; Volume 2 goes on with velocities and
displacements. ``/&`` ends a channel. Volume 3 has spectra. Source: Shakal & Huang (1985), "Standard tape format
for CSMIP strong-motion data tapes", OSMS 85-03; later files as CGS writes them, with the format in the line
that declares the data. Pairs of time and value, as digitised from film, are read by ``renadic``.
"""

import re
from dataclasses import dataclass

from rockbatch.errors import InputError, NoRecordError
from rockbatch.motions.component import Component, Seat
from rockbatch.motions.formats.fixed_width import fixed_numbers, one_after_another
from rockbatch.motions.formats.header_lines import found, line_at, moment, number
from rockbatch.motions.formats.obspy_plugin import plugin
from rockbatch.motions.formats.record_file import RecordFile
from rockbatch.motions.formats.recording import Recording, Series, to_components
from rockbatch.motions.formats.renadic import is_renadic
from rockbatch.motions.motion import Samples, Unusable
from rockbatch.motions.origin import Origin, origin_of

SUFFIXES = frozenset({".v1", ".v2", ".v3", ".raw"})

_DATA = {1: 27, 2: 45}  # lines of a channel's header, by volume
_PER_LINE = 8
_TITLE = re.compile(r"\s*uncorrected accelerogram data\b", re.IGNORECASE)
_SPACING = re.compile(
    r"\s*(?P<npts>[0-9]{1,9}) +"
    r"(?:points of (?P<what>accel|veloc|displ)[a-z]*\.? data equally spaced at +(?P<dt>[0-9.]{1,12}) *sec"
    r"|accelerogram points at +(?P<rate>[0-9.]{1,12}) *pts/sec)\b(?P<rest>.*)",
    re.IGNORECASE,
)
_UNIT = re.compile(r"(?:\(units:|in units of|, *in) *(?P<unit>[a-z0-9/*^]+)", re.IGNORECASE)
_FORMAT = re.compile(r"\((?P<per_line>[0-9]{1,2})f(?P<width>[0-9]{1,2})\.[0-9]{1,2}\)", re.IGNORECASE)
_CHANNEL = re.compile(
    r"chan +(?P<number>[0-9]{1,3}): *(?P<label>.*?) *(?:deg(?:r|rees)?\b.*)?(?:\(|location:|$)", re.IGNORECASE
)
_OF_STATION = re.compile(r"sta +chn: *(?P<number>[0-9]{1,3})", re.IGNORECASE)
_LOCATION = re.compile(r"location: *(?P<place>\S.*?) *$", re.IGNORECASE)
_STATION = re.compile(r"station +(?:no|id)\. +(?P<code>\S+)", re.IGNORECASE)
_CODES = re.compile(r"[0-9]+\.(?P<network>[A-Z0-9]{1,2})\.(?P<station>[A-Z0-9]{1,5})\.(?P<location>[A-Z0-9-]{2})\.")
_START = re.compile(
    r"start time: *([0-9]{1,2})/([0-9]{1,2})/([0-9]{4}|[0-9]{2}),? *([0-9]{1,2}):([0-9]{2}):([0-9]{2}(?:\.[0-9]{1,6})?) *"
    r"(?:UTC|GMT|\(GPS\)|\(Q=|$)",
    re.IGNORECASE,
)
_AGAIN = {  # where a header says once more what declares the data: line, and what it says
    1: (
        (10, re.compile(r"no\. of points *= *(?P<npts>[0-9]{1,9})", re.IGNORECASE)),
        (10, re.compile(r"at +(?P<rate>[0-9.]{1,12}) *samples/sec", re.IGNORECASE)),
    ),
    2: (
        (15, re.compile(r"^ *(?P<npts>[0-9]{1,9}) +points of", re.IGNORECASE)),
        (16, re.compile(r"intervals of +(?P<dt>[0-9.]{1,12}) *sec", re.IGNORECASE)),
    ),
}
_PEAK = {
    1: (11, re.compile(r"max *= *[-+]?(?P<peak>[0-9]*\.[0-9]+) *g\b", re.IGNORECASE), "g"),
    2: (17, re.compile(r"peak acceleration *= *[-+]?(?P<peak>[0-9]*\.[0-9]+) *cm/sec/sec", re.IGNORECASE), "cm/s2"),
}


@dataclass(frozen=True)
class _Block:
    """One declared series: accelerations, velocities or displacements, and where the lines after it begin."""

    what: str
    dt: float
    unit: str
    values: Samples
    end: int


def is_csmip(head: bytes) -> bool:
    """Whether the first bytes are the header of a Volume 1, 2 or 3 file, but not of pairs of time and value."""
    return _volume(head.decode("latin-1").splitlines(), 0) is not None and not is_renadic(head)


def read_csmip(file: RecordFile) -> list[Component | Unusable]:
    """The channels of a file in m/s², those of Volume 1 without offset."""
    return to_components(file, _parse(file.text))


def _parse(text: str) -> list[Recording]:
    """The channels, one after the other; ``InputError`` with the line where the file is not whole."""
    return one_after_another(text, _channel)


def _volume(lines: list[str], at: int) -> int | None:
    """Volume of the channel that begins at ``lines[at]``: each has one title more above that of Volume 1."""
    return next((i + 1 for i in range(3) if _TITLE.match(line_at(lines, at + i))), None)


def _channel(lines: list[str], at: int) -> tuple[Recording, int]:
    """The channel whose title is ``lines[at]``, and where the next one begins."""
    volume = _volume(lines, at)
    if volume is None:
        raise InputError(f'line {at + 1}: found "{lines[at].strip()[:60]}"; expected "Uncorrected accelerogram data"')
    if volume == 3:
        raise NoRecordError(
            f"line {at + 1}: Volume 3, spectra; expected accelerations: take the .V2 file of this record"
        )
    header = at + volume - 1  # the lines that Volumes 1 and 2 have in common
    channel = found(_CHANNEL, lines, header + 6, "Chan  1: 90 Deg")
    station = found(_STATION, lines, header + 4, "Station No. …")["code"]
    place = _LOCATION.search(line_at(lines, header + 6))
    peak = _PEAK[volume][1].search(line_at(lines, at + _PEAK[volume][0]))
    record = line_at(lines, header + 3).split("  ")[0].strip()
    codes = _CODES.match(record)
    accelerations = _block(lines, at + _DATA[volume], ("accel",))
    _check_again(lines, at, volume, accelerations)
    end = accelerations.end
    others: dict[str, Series] = {}
    while volume == 2 and _SPACING.match(line_at(lines, end)):
        block = _block(lines, end, ("veloc", "displ"))
        others[block.what] = (block.values, block.unit)
        end = block.end
    if not line_at(lines, end).startswith("/&"):
        ends = f'"{lines[end].strip()[:40]}"' if end < len(lines) else "the end of the file"
        raise InputError(f'line {end + 1}: found {ends}; expected "/&" after the declared values; fetch it again')
    return (
        Recording(
            label=channel["label"],
            dt=accelerations.dt,
            values=accelerations.values,
            unit=accelerations.unit,
            station=", ".join(filter(None, [station, record, place["place"] if place else "", f"Volume {volume}"])),
            codes=(
                codes["network"] if codes else "",
                codes["station"] if codes else station[:5],
                codes["location"].strip("-") if codes else "",
                channel["label"].upper(),
            ),
            start=_start(line_at(lines, header + 3)),
            uncorrected=volume == 1,
            processed=volume == 2,
            seat=_seat(lines, header, station, codes, place),
            event=f"{line_at(lines, header + 1)} {line_at(lines, header + 2).partition('(')[0]}",
            origin=_origin(lines, header, station),
            velocities=others.get("veloc"),  # the header's initial velocity has the wrong sign in files of the USGS
            displacements=others.get("displ"),
            stated_peak=(peak["peak"] if peak else "", _PEAK[volume][2]),
            notes=(f"channel {channel['number']}: {place['place']}",) if place else (),
            header={"station": line_at(lines, header + 5).strip(), "record": record},
        ),
        end + 1,
    )


def _origin(lines: list[str], header: int, station: str) -> Origin:
    """Event and station by their lines, of which the right half is about the recorder in some files."""
    event, date, name = (re.split(r"   |\(", line_at(lines, header + i))[0] for i in (1, 2, 5))
    return origin_of(event, name or station, date)


def _seat(
    lines: list[str], header: int, station: str, codes: re.Match[str] | None, place: re.Match[str] | None
) -> Seat:
    """The sensor, by the record's codes, the place, and the channel of the station, which other recorders may share."""
    channel = _OF_STATION.search(line_at(lines, header + 6)) or _CHANNEL.search(line_at(lines, header + 6))
    return Seat(
        station=codes["station"] if codes else station,
        network=codes["network"] if codes else None,
        location=codes["location"].strip("-") if codes else None,
        place=place["place"].upper() if place else None,
        channel=channel["number"] if channel else None,
    )


def _block(lines: list[str], at: int, expected: tuple[str, ...]) -> _Block:
    """The series that ``lines[at]`` declares; ``InputError`` where it is not one of those expected."""
    line = found(_SPACING, lines, at, "… points of accel data equally spaced at … sec. (units: …)")
    what = (line["what"] or "accel").lower()
    unit, layout = _UNIT.search(line["rest"]), _FORMAT.search(line["rest"])
    npts = int(line["npts"])
    step = number(line["rate"] or line["dt"], at)
    if what not in expected or unit is None or npts < 1 or not 1e-6 < step < 1e6:
        raise InputError(
            f'line {at + 1}: found "{line[0].strip()[:75]}"; expected a count, an interval and a unit of '
            f"{' or '.join(expected)}"
        )
    if layout:
        per_line, width = int(layout["per_line"]), int(layout["width"])
    else:  # before formats were declared: 8F9.6 or 8F10.3, which the first line tells
        per_line, width = _PER_LINE, len(line_at(lines, at + 1).rstrip()) // min(_PER_LINE, npts)
    if per_line < 1 or width < 2:
        raise InputError(f'line {at + 2}: found "{line_at(lines, at + 1)[:40]}"; expected numbers in equal columns')
    values = fixed_numbers(lines, at + 1, npts, width, per_line)
    dt = float(f"{1.0 / step:.12g}") if line["rate"] else step
    return _Block(what, dt, unit["unit"], values, at + 1 - -npts // per_line)


def _check_again(lines: list[str], at: int, volume: int, block: _Block) -> None:
    """``InputError`` where the header's text contradicts the line that declares the data."""
    for offset, pattern in _AGAIN[volume]:
        said = pattern.search(line_at(lines, at + offset))
        if said is None:
            continue
        key, text = next(iter(said.groupdict().items()))
        declared = {"npts": len(block.values), "rate": 1.0 / block.dt, "dt": block.dt}[key]
        if abs(number(text, at + offset) - declared) > 1e-6 * declared:
            raise InputError(
                f'line {at + offset + 1}: "{said[0].strip()}" contradicts line {at + _DATA[volume] + 1}: '
                f"{len(block.values)} points at intervals of {block.dt:g} s"
            )


def _start(line: str) -> float | None:
    """Time of the first sample [s since 1970]; ``None`` for older files, which have the time of triggering."""
    said = _START.search(line)
    if said is None:
        return None
    month, day, year, hour, minute = (int(said[i]) for i in range(1, 6))
    century = 0 if year > 99 else 1900 if year >= 30 else 2000
    return moment(year + century, month, day, hour, minute, float(said[6]))


is_csmip_file, read_csmip_stream = plugin("CSMIP", is_csmip, _parse)
