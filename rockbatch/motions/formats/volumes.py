"""Volumes I and II in Caltech's layout, as CSMIP (CGS, formerly CDMG), USC, RENADIC (Universidad de Chile) and others write them.

Each channel has 13 lines of text, 7 of integers (16I5) and 7 of real numbers (8F10.3), then its samples. Volume II, which is
corrected, has a title before these lines, 11 lines on the processing after the first 13, and 13 of real numbers. Its
accelerations, velocities and displacements are eight to a line, each below a line that declares it (``declared_series``) or,
since the text has count and interval as well, without one. Volume I declares its samples, or has pairs of time and value,
digitised from film, five to a line in ten columns of 7 characters, in files of USC after a blank. ``/&`` ends a channel,
except in some files of USC. Volume III has spectra. Sources: Shakal & Huang (1985), "Standard tape format for CSMIP
strong-motion data tapes", OSMS 85-03, for Caltech's; else the agencies' own files.
"""

import math
import re
from dataclasses import replace
from functools import partial

from rockbatch.common.errors import InputError, NoRecord
from rockbatch.motions.component import Sensor
from rockbatch.motions.formats.declared_series import declared_series, declares_series, equal_columns
from rockbatch.motions.formats.fixed_width import fixed_numbers, number_in, one_after_another
from rockbatch.motions.formats.header_lines import CLOCK, layout, line_at, moment_of, past_mark, read_header
from rockbatch.motions.formats.obspy_plugin import plugin
from rockbatch.motions.formats.recording import Recording, Series
from rockbatch.motions.formats.stated import Stated
from rockbatch.motions.formats.time_steps import from_pairs
from rockbatch.motions.labels.orientation import is_clock
from rockbatch.motions.labels.origin import origin_of

_DATA = {1: 27, 2: 45}  # lines of a channel's header, by volume
_COMPONENT = 6  # line of the text that names it: "CHAN  1: 90 DEG", or USC's and Caltech's "COMP N90E"
_WIDTH, _PER_LINE = 7, 10  # of pairs
_OF_RAW = (0.05, math.inf)  # limits of the duration before the correction, which may cut and pad
_TITLE = re.compile(
    r"^\s*uncorrected accelerogram data\b|\bof uncorrected accelerogram data of volume i\b", re.IGNORECASE
)
_DAY = r"(?P<month>\d{1,2})/(?P<day>\d{1,2})/(?P<year>\d{4}|\d{2})"
_NOT_SET = re.compile(r"0?1/0?1/(?:19)?80\b")  # the date of a recorder whose clock nobody set
_TEXT = layout(  # of Volume I, which Volume II repeats
    (
        _COMPONENT,
        r"(?ai)(?:chan\s+(?P<number>\d{1,3}):|^ *comp ) *(?P<label>.*?) *(?:\bdeg(?:r|rees)?\b.*)?(?:\(|location:|  |$)",
        "Chan  1: 90 Deg",
    ),
    (4, r"(?i)station(?: +(?:no|id)\.| (?P<usc>USC)#) *(?P<station>(?!\S*\.\d)[^\s,]*)", "Station No. …"),
    (_COMPONENT, r"(?i)location: *(?P<place>\S.*?) *$", ""),
    (_COMPONENT, r"(?ai)sta +chn: *(?P<of_station>\d{1,3})", ""),
    (3, r"^(?P<record>(?=\S*[-.])\S+(?: \S+)*)", ""),
    (3, r"(?a)^\d+\.(?P<network>[A-Z0-9]{1,2})\.(?P<code>[A-Z0-9]{1,5})\.(?P<location>[A-Z0-9-]{2})\.", ""),
    (3, rf"(?ai)(?P<began>start|trigger) time: *{_DAY},? *{CLOCK} *(?:UTC|GMT|\(GPS\)|\(Q=|$)", ""),
)
_STATED = {  # statements about the samples in the text, which some files of CSMIP lack
    1: layout(
        (10, r"(?ai)no\. of points\s*=\s*(?P<npts>\d{1,9})", "NO. OF POINTS = …"),
        (10, r"(?ai)(?:duration|record length) *= *(?P<duration>[\d.]{1,12}) *sec", "DURATION = … SEC"),
        (10, r"(?ai)at +(?P<rate>[\d.]{1,12}) *samples/sec", ""),
        (11, r"(?ai)\bare sec and\s+(?P<unit>[A-Z0-9/]+)", "UNITS ARE SEC AND G/10"),
        (
            11,
            r"(?ai)max\s*=\s*(?P<peak>[-+]?\d{0,5}\.\d{1,6})\s*(?P<of_peak>g)\b(?:, *at +(?P<at>[\d.]{1,12}) *sec)?",
            "",
        ),
    ),
    2: layout(
        (15, r"(?ai)^ *(?P<npts>\d{1,9}) +(?:points of|instrument and)", "… INSTRUMENT AND BASELINE CORRECTED DATA"),
        (11, r"(?ai)(?:duration|record length) *= *(?P<duration>[\d.]{1,12}) *sec", ""),
        (16, r"(?ai)intervals of +(?P<dt>[\d.]{1,12}) *sec", "AT EQUALLY-SPACED INTERVALS OF … SEC."),
        (
            17,
            r"(?ai)peak acceleration *= *[-+]?(?P<peak>\d*\.\d+) *(?P<of_peak>[cm]ms?/sec/sec)"
            r"(?: +at +(?P<at>[\d.]{1,12}) *sec)?",
            "PEAK ACCELERATION = …",
        ),
    ),
}


def _is_dialect(name: str, head: bytes) -> bool:
    """Return whether the first bytes are a header in the dialect ``name``, "CSMIP", "RENADIC" or "USC", and in no other."""
    lines = head.decode("latin-1").splitlines()
    volume = _volume(lines, 0)
    if volume is None:
        return False
    if volume < 3 and re.match(" *COMP ", line_at(lines, volume - 1 + _COMPONENT)):
        return name == "USC"
    in_pairs = volume == 1 and b" ARE SEC AND" in head and not declares_series(lines, _DATA[1])
    return name == ("RENADIC" if in_pairs else "CSMIP")


def _volume(lines: list[str], first: int) -> int | None:
    """Return the volume, 1 to 3, of the channel that begins at ``lines[first]``; None for other lines.

    Volume II has one line above the title of Volume I, Volume III has two.
    """
    return next((i + 1 for i in range(3) if _TITLE.search(line_at(lines, first + i))), None)


def parse(text: str) -> list[Recording]:
    """Return the channels, one after the other; raise ``InputError`` with the line if the file is incomplete."""
    return [recording for recording, _ in one_after_another(text, _channel)]


def parse_pairs(text: str) -> list[Recording]:
    """Return the channels of a RENADIC file; raise ``InputError`` if they begin at different times, and no clock was set."""
    channels = one_after_another(text, _channel)
    recordings = [recording for recording, _ in channels]
    begins = [first or 0.0 for recording, first in channels if not is_clock(recording.label)] or [0.0]
    if recordings[0].start is None and max(begins) - min(begins) > 0.5 * recordings[0].dt:
        raise InputError(
            f"its channels begin at different times ({', '.join(f'{t:g}' for t in begins)} s) and no trigger time is "
            "set; cut them to a common one"
        )
    return recordings


def _channel(lines: list[str], first: int) -> tuple[tuple[Recording, float | None], int]:
    """Return the channel whose title is ``lines[first]`` with the first time of its pairs [s], and the index after it."""
    volume = _volume(lines, first)
    if volume is None:
        raise InputError(
            f'line {first + 1}: found "{lines[first].strip()[:60]}"; expected "Uncorrected accelerogram data"'
        )
    if volume == 3:
        raise NoRecord(f"line {first + 1}: Volume 3, spectra; expected accelerations: take the .V2 file of this record")
    header = first + volume - 1
    fields = read_header(lines, header, _TEXT)
    needed = not fields["number"]  # by USC and Caltech
    fields |= read_header(lines, first, [(i, said, needed * example) for i, said, example in _STATED[volume]])
    fields["of_peak"] = fields["of_peak"].upper().replace("MS/", "M/")  # of Caltech: CMS/SEC/SEC
    samples, begins, end = _samples(lines, first, volume, fields)
    place = fields["place"]
    notes = (*samples.notes, *([f"channel {fields['number']}: {place}"] if place else []))
    # the right half is about the recorder in some files
    event, date, name = (re.split(r"   |\(", line_at(lines, header + i))[0].strip() for i in (1, 2, 5))
    date = "" if _NOT_SET.match(date) else date
    record = fields["record"] or " ".join(filter(None, [event, date]))
    number, location = fields["station"], fields["location"].strip("-")
    recording = replace(
        samples,
        station=", ".join(filter(None, [number or name, record, place, f"Volume {volume}"])),
        start=_start(fields, begins),
        processed=volume == 2,
        sensor=Sensor(
            station=fields["code"] or number or name.upper(),
            network=fields["network"] or ("LA" if fields["usc"] else None),
            location=location if fields["code"] else None,
            place=place.upper() or None,
            channel=fields["of_station"] or fields["number"] or None,  # of the station, which other recorders may share
        ),
        event=f"{event} {date}",
        origin=origin_of(event, name or number, date),
        stated=_statements(fields, begins, volume),
        notes=notes,
        header={"station": name, "event": event, "record": fields["record"]},
    )
    if fields["number"]:
        return (recording, begins), past_mark(lines, end, "the declared values")
    return (recording, begins), end + line_at(lines, end).startswith("/&")


def _start(fields: dict[str, str], begins: float | None) -> float | None:
    """Return the time of the first sample [s since 1970]; ``None`` if unknown.

    Times of pairs count from the trigger time, if it has a year of four digits and the recorder's clock was set. A start time
    may have two digits, 1930 to 2029.
    """
    year = fields["year"]
    if fields["began"].lower() != "trigger":
        return moment_of(fields | ({"year": f"{19 if year >= '30' else 20}{year}"} if len(year) == 2 else {}))
    trigger = moment_of(fields) if len(year) == 4 and begins is not None else None
    unset = _NOT_SET.match(f"{fields['month']}/{fields['day']}/{year}")
    return None if trigger is None or begins is None or unset else trigger + begins


def _samples(lines: list[str], first: int, volume: int, fields: dict[str, str]) -> tuple[Recording, float | None, int]:
    """Return a recording of label and samples, the time of the first pair [s] (None without pairs), and the next index."""
    start = first + _DATA[volume]
    declared = declares_series(lines, start)
    if volume == 1 and not declared and fields["npts"] and fields["unit"]:
        return _pairs(lines, first, fields)
    if volume == 2 and not declared and not fields["number"] and not line_at(lines, start).strip("-+. 0123456789"):
        dt, series, end = _undeclared(lines, start, fields)
    else:
        dt, series, end = declared_series(lines, start)
    values, unit = series["acc"]
    # the initial state is computed from these: the header's initial velocity has the wrong sign in files of the USGS
    velocities, displacements = series.get("vel"), series.get("dis")
    recording = Recording(fields["label"], dt, values, unit, velocities=velocities, displacements=displacements)
    return recording, None, end


def _pairs(lines: list[str], first: int, fields: dict[str, str]) -> tuple[Recording, float, int]:
    """Return a recording of pairs of time and value at even steps, their first time [s], and the index after them."""
    npts, start = int(fields["npts"]), first + _DATA[1]
    if npts < 2:
        raise InputError(f"line {first + 11}: found {npts} points; expected at least two")
    end = start - -2 * npts // _PER_LINE
    indent = not fields["number"]  # of USC
    shifted = next((i for i in range(start, min(end, len(lines))) if indent and not lines[i].startswith(" ")), None)
    if shifted is not None:
        raise InputError(f'line {shifted + 1}: found "{lines[shifted][:40]}"; expected a blank and ten columns')
    block = lines[:start] + [line[indent:] for line in lines[start:end]]
    pairs = fixed_numbers(block, start, 2 * npts, _WIDTH, _PER_LINE)[0].reshape(npts, 2)
    dt, values, notes = from_pairs(pairs, f"channel {fields['label']} from line {first + 1} on")
    recording = Recording(fields["label"], dt, values, fields["unit"], notes=notes, as_read=pairs[:, 1])
    return recording, float(pairs[0, 0]), end


def _undeclared(lines: list[str], start: int, fields: dict[str, str]) -> tuple[float, dict[str, Series], int]:
    """Return interval [s], series by kind and end of undeclared samples of Volume II, in the unit of the stated peak."""
    npts, series, end = int(fields["npts"]), {}, start
    if npts < 2:
        raise InputError(f"line {start - _DATA[2] + 16}: found {npts} points; expected at least two")
    for kind, per in (("acc", "/SEC/SEC"), ("vel", "/SEC"), ("dis", "")):
        if kind == "acc" or line_at(lines, end)[:1].isspace():
            values, end = equal_columns(lines, end, npts)
            series[kind] = (values, fields["of_peak"].replace("/SEC/SEC", per))
    return number_in(fields["dt"], start), series, end


def _statements(fields: dict[str, str], begins: float | None, volume: int) -> tuple[Stated, ...]:
    """Return the statements of the header's text about the samples, whose times of pairs begin at ``begins`` [s]."""
    start = begins or 0.0
    return (
        Stated("count", fields["npts"]),
        Stated("rate", fields.get("rate", "")),
        Stated("step", fields.get("dt", "")),
        Stated("duration", fields["duration"], begins=start, limits=_OF_RAW if volume == 2 else None),
        Stated("peak", fields["peak"], fields["of_peak"]),
        Stated("time of the peak", fields["at"], begins=start),
    )


is_csmip, is_renadic, is_usc = (partial(_is_dialect, name) for name in ("CSMIP", "RENADIC", "USC"))
is_csmip_file, read_csmip_stream = plugin("CSMIP", is_csmip, parse)
is_renadic_file, read_renadic_stream = plugin("RENADIC", is_renadic, parse_pairs)
is_usc_file, read_usc_stream = plugin("USC", is_usc, parse)
