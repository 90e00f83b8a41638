"""PEER strong-motion files (.AT2): four header lines, then the values of one component.

Registered with ObsPy as waveform format "AT2". Header dialects that occur: ``NPTS= 4316, DT= .0100 SEC, …``,
the same without the comma, ``1991 0.0100 NPTS, DT``.
"""

import re
from dataclasses import replace

import numpy as np

from rockbatch.common.errors import InputError, NoRecord, NoUnit, Truncated
from rockbatch.motions.component import Component, Sensor
from rockbatch.motions.formats.column_header import believed_unit, is_acceleration, is_of_another_quantity
from rockbatch.motions.formats.fixed_width import (
    LOOKED_AT,
    aligned_numbers,
    is_cut_short,
    number_in,
    without_end_marks,
)
from rockbatch.motions.formats.obspy_plugin import plugin
from rockbatch.motions.formats.recording import Recording, to_components
from rockbatch.motions.labels.orientation import orientation_of
from rockbatch.motions.labels.origin import origin_of
from rockbatch.motions.limits import MOST_SAMPLES, STEPS, is_step
from rockbatch.motions.motion import Samples
from rockbatch.motions.sources.record_file import RecordFile, no_acceleration
from rockbatch.motions.unused import Unusable

_NUMBER = r"(?:\d+\.?\d*|\.\d+)(?:[ED][-+]?\d+)?"
_COUNT_AND_STEP = (
    re.compile(rf"\bNPTS\s*[=:]?\s*(?P<npts>\d+)\b.*?\bDT\s*[=:]?\s*(?P<dt>{_NUMBER})", re.IGNORECASE),
    re.compile(rf"^\s*(?P<npts>\d+)\s*,?\s+(?P<dt>{_NUMBER})\s*,?\s*NPTS\s*,?\s*DT\b", re.IGNORECASE),
    re.compile(rf"\bNPTS\s*,\s*DT\s*[=:]?\s*(?P<npts>\d+)[,\s]+(?P<dt>{_NUMBER})", re.IGNORECASE),
)
_UNIT = re.compile(r"\bUNITS?\s*(?:OF|[=:])\s*\(?\s*((?:[0-9.]+ )?[A-Z0-9./*^²%]+)", re.IGNORECASE)
_IN_G = re.compile(r"\(\s*(g)\s*\)", re.IGNORECASE)  # in common copies of El Centro 1940
_MONTH = r"(?:jan|feb|mar|apr|may|jun|jul|aug|sep|oct|nov|dec)[a-z]*\.?"
_DATE = re.compile(
    r"(?<!\d)(?:(?:19|20)\d\d([-/.])\d{1,2}\1\d{1,2}|(?:19|20)\d\d(?:0[1-9]|1[0-2])(?:0[1-9]|[12]\d|3[01])"
    rf"|\d{{1,2}}/\d{{1,2}}/\d{{2,4}}|\d{{1,2}}([-.])\d{{1,2}}\2(?:19|20)\d\d"
    rf"|\d{{1,2}}[- ]{_MONTH}[- ](?:19|20)\d\d|{_MONTH} +\d{{1,2}},? +(?:19|20)\d\d)(?!\d)",
    re.IGNORECASE,
)
_CLOCK = re.compile(
    r"(?:[01]?\d|2[0-4])[:h][0-5]\d(?::[0-5]\d(?:\.\d+)?)?(?: *(?:UTC?|GMT|Z|[AP]\.?M\.?|LOCAL|[A-Z]{1,3}[SD]T))?(?![\w:])|"
    r"(?:[01]\d|2[0-3])[0-5]\d$",
    re.IGNORECASE,
)
_BRACKETS = str.maketrans("[]{}", "()()")
_FIELD = re.compile(r"(?:[^,(]|\([^()]*(?:\)|$))+")  # between commas, which may stand in parentheses, too
_BARE = re.compile(r"^(?:\w{1,3}(?= - )|\(?[^(]*)")  # "000" of "000 - CDMG" and of "000 (CDMG)"
_SIGNED = re.compile(rf"[-+]?{_NUMBER}", re.IGNORECASE)
_HEADER_LINES = 10  # the count is in line 4; hand-edited headers may be longer
_HEADER_BYTES = 2048
_HEADER_CHARACTERS = 8192
_BLANK = re.compile(r"\s")
_PIECE = 2**20  # characters parsed at a time
_WIDEST = 40  # characters of a number


def looks_like_at2(head: bytes) -> bool:
    """Return whether the first bytes are an AT2 header: a unit or PEER's name, then a count with a time step."""
    lines = _first_lines(head)
    index = next((i for i, line in enumerate(lines) if _count_and_step(line)), 0)
    above = " ".join(lines[:index]).upper()
    return "UNITS OF" in above or "PEER" in above


def has_at2_count(head: bytes) -> bool:
    """Return whether the first bytes have a count with a time step; enough for files with the suffix .AT2."""
    return any(_count_and_step(line) for line in _first_lines(head))


def _first_lines(head: bytes) -> list[str]:
    return head[:_HEADER_BYTES].decode("latin-1").splitlines()[:_HEADER_LINES]


def read_component(file: RecordFile) -> list[Component | Unusable]:
    """Return the component of an AT2 file, alone in a list, in m/s²; its g is the study's gravity.

    Raises ``InputError`` for an incomplete file, one of velocities or displacements, or without a unit that is known or stated.
    """
    (recording,) = _parse(file.data.decode("latin-1"))
    unit = believed_unit(recording.unit, file.options)
    if not unit:
        raise NoUnit('no unit in the header ("… IN UNITS OF G")')
    if is_of_another_quantity(unit):
        raise no_acceleration("it, by its header,", f"numbers in {unit}")
    if not is_acceleration(unit):
        raise NoUnit(f'the unit "{unit}" of its header is not known')
    notes = (*recording.notes, *file.options.overruled(unit, recording.dt, file.gravity))
    return to_components(file, [replace(recording, unit=unit, notes=notes)])


def _parse(text: str) -> list[Recording]:
    """Return the recording of an AT2 file in a list, unit "" if unstated; PEER's records are corrected, others do not say."""
    lines = text[:_HEADER_CHARACTERS].splitlines(keepends=True)[:_HEADER_LINES]
    first = next((i for i, line in enumerate(lines) if _count_and_step(line)), None)
    fields = None if first is None else _count_and_step(lines[first])
    if first is None or fields is None:
        raise InputError(
            f"lines 1–{len(lines)}: no number of points and time step found; "
            'expected a line such as "NPTS= 4316, DT= .0100 SEC"'
        )
    npts, dt = int(fields["npts"]), float(fields["dt"].upper().replace("D", "E"))
    if not 1 <= npts <= MOST_SAMPLES or not is_step(dt):
        raise InputError(
            f'line {first + 1}: found "{lines[first].strip()[:80]}"; expected a count from 1 to {MOST_SAMPLES:,}, and a time '
            f"step of {STEPS}"
        )
    header = " ".join(lines[:first])
    if quantity := re.search(r"\b(?:VELOCITY|DISPLACEMENT) TIME\b", header, re.IGNORECASE):
        raise NoRecord(f'header: found "{quantity[0]}…"; expected accelerations: take the .AT2 file of this record')
    unit = _UNIT.search(header) or _IN_G.search(" ".join(lines[: first + 1]))
    event, date, station, component = _title(lines[1].strip()) if first > 1 else ("", "", "", "")
    return [
        Recording(
            label=component,
            dt=dt,
            values=_values(without_end_marks(text), sum(map(len, lines[: first + 1])), npts),
            unit=unit[1].rstrip(".") if unit else "",
            station=", ".join(part.upper() for part in (event, date, station)) if station and date else "",
            sensor=Sensor(station.upper()),
            event=f"{event} {date}" if date else "",
            processed="PEER" in header.upper() or None,
            origin=origin_of(event, station, date),
            header={"event": event, "date": date, "station": station},
        )
    ]


def _count_and_step(line: str) -> re.Match[str] | None:
    """Return the match with ``npts`` and ``dt`` of a header line, in any dialect; None for other lines."""
    return next((match for pattern in _COUNT_AND_STEP if (match := pattern.search(line[:200]))), None)


def _title(line: str) -> tuple[str, str, str, str]:
    """Return event, date, station and component of header line 2; "" for those that are missing.

    "Duzce Turkey, 11/12/1999, Lamont 362, E" and "CAPE MENDOCINO 04/25/92 1806, CAPE MENDOCINO, 000 (CDMG …)". The text
    after the component is of the agency; parentheses before it are of the station: "Pacoima Dam (upper left), 104". Other
    brackets count as parentheses.
    """
    line = line.translate(_BRACKETS)
    date = _DATE.search(line)
    if date is None:
        fields = _fields(line)
        place = _component_of(fields)
        return ("", "", "", _bare(fields[place]) if place > 0 else "")
    event = ", ".join(_fields(line[: date.start()]))
    behind = line[date.end() :]
    same_field = re.match(r"[^,(]*(?:\([^()]*\))?", behind)
    assert same_field is not None  # a pattern that an empty text matches
    day = (date[0] + same_field[0]).strip()
    fields = _fields(behind[same_field.end() :])
    while (
        len(fields) > 1
        and (clock := _CLOCK.match(fields[0]))
        and not (clock[0].isdigit() and _component_of(fields) == 1)
    ):
        rest = fields[0][clock.end() :].strip(" ,-")
        day, fields = f"{day} {clock[0]}", ([rest] if rest else []) + fields[1:]
    place = _component_of(fields)
    if place < 0:
        return event, day, ", ".join(fields), ""
    return event, day, ", ".join(fields[:place]), _bare(fields[place])


def _fields(text: str) -> list[str]:
    """Return the fields of a title between commas outside of parentheses, stripped; empty ones are skipped."""
    return [field for match in _FIELD.finditer(text) if (field := match[0].strip())]


def _bare(field: str) -> str:
    """Return a field of a title that is no direction without what is behind it: "000 (CDMG STATION 89005)" gives "000"."""
    return field if orientation_of(field) else _BARE.findall(field)[0].strip()


def _component_of(fields: list[str]) -> int:
    """Return the index of the last field that is a direction; -1 without one."""
    return next((i for i in reversed(range(len(fields))) if orientation_of(_bare(fields[i]))), -1)


def _values(text: str, start: int, npts: int) -> Samples:
    """Return the ``npts`` finite numbers from the character ``start`` on, shape (npts,).

    Raises ``InputError`` for more or fewer, for a word that is no number, and if the last one is cut short.
    """
    try:
        values, last = _between_blanks(text, start)
    except ValueError:
        values, last = _touching_or_double(text, start, npts)
    if len(values) != npts:
        raise Truncated(f"the header says NPTS = {npts}, but the file holds {len(values)} values; fetch it again")
    if not np.isfinite(values).all():
        i = int(np.flatnonzero(~np.isfinite(values))[0])
        raise InputError(f'value {i + 1} of {npts} is "{values[i]}"; expected finite numbers')
    if is_cut_short(reversed(last)):
        raise Truncated(f'the last value is "{last[-1]}", shorter than all others: the file is cut; fetch it again')
    return values


def _between_blanks(text: str, start: int) -> tuple[Samples, list[str]]:
    """Return the numbers from ``start`` on, and the last of them as written; raise ``ValueError`` for words that are none.

    In pieces, because all words of a file as Python objects would take thirty times its size.
    """
    end = len(text.rstrip("\x00\x1a"))
    values, last = [np.empty(0)], list[str]()
    while start < end:
        blank = _BLANK.search(text, start + _PIECE, end)
        stop = blank.end() if blank else end
        if "_" in (piece := text[start:stop]):  # Python would read 1_0 as ten
            raise ValueError
        lines = piece.splitlines()
        aligned = aligned_numbers(lines, len(lines[0]) // max(len(lines[0].split()), 1))
        tokens = (piece if aligned is None else piece[-_WIDEST * LOOKED_AT :]).split()
        values.append(np.array(list(map(float, tokens))) if aligned is None else aligned)
        last = [*last, *tokens][-LOOKED_AT:]
        start = stop
    return np.concatenate(values), last


def _touching_or_double(text: str, start: int, npts: int) -> tuple[Samples, list[str]]:
    """Return numbers from ``start`` on in touching Fortran columns or with D exponents, and the last of them as written.

    Raises ``InputError`` with the line of a word that is no number.
    """
    lines = [line.rstrip() for line in text[start:].rstrip("\x00\x1a").splitlines()]
    body = [line for line in lines if line]
    width = _width(body, npts)
    first = text.count("\n", 0, start)

    def fields(line: str) -> list[str]:
        if width is None:
            return line.split()
        return [line[column : column + width].strip() for column in range(0, len(line), width)]

    values = (number_in(field, first + i) for i, line in enumerate(lines) for field in fields(line))
    return np.fromiter(values, float), [field for line in body[-LOOKED_AT:] for field in fields(line)][-LOOKED_AT:]


def _width(lines: list[str], npts: int) -> int | None:
    """Return the width of touching Fortran columns, such as 15 of 5E15.7; ``None`` unless they give ``npts`` numbers."""
    longest = max(map(len, lines), default=0)
    full = len(lines) - 1
    for width in range(1, _WIDEST + 1):
        per_line = longest // width
        if longest % width or not per_line * full < npts <= per_line * (full + 1):
            continue
        fields = [line[i : i + width].strip() for line in lines for i in range(0, len(line), width)]
        if len(fields) == npts and all(map(_SIGNED.fullmatch, fields)):
            return width
    return None


is_at2, read_at2 = plugin("AT2", looks_like_at2, _parse)
