"""PEER strong-motion files (.AT2): four header lines, then the values of one component.

Registered with ObsPy as waveform format "AT2". Header dialects that occur: ``NPTS= 4316, DT= .0100 SEC, …``,
the same without the comma, ``1991 0.0100 NPTS, DT``.
"""

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from rockbatch.errors import InputError, NoRecordError, UnstatedError
from rockbatch.motions.component import Component, Seat
from rockbatch.motions.formats.fixed_width import LOOKED_AT, is_cut_short
from rockbatch.motions.formats.obspy_plugin import FileLike, first_bytes, name_and_bytes
from rockbatch.motions.formats.record_file import RecordFile
from rockbatch.motions.limits import MOST_SAMPLES, STEPS, is_step
from rockbatch.motions.motion import Samples
from rockbatch.motions.orientation import UNKNOWN, orientation_of, split_stem
from rockbatch.motions.origin import origin_of
from rockbatch.units import acceleration_factor

if TYPE_CHECKING:
    from obspy import Stream

SUFFIXES = frozenset({".at2"})

_NUMBER = r"(?:\d+\.?\d*|\.\d+)(?:[ED][-+]?\d+)?"
_COUNT_AND_STEP = tuple(
    re.compile(pattern, re.IGNORECASE)
    for pattern in (
        rf"\bNPTS\s*[=:]?\s*(?P<npts>\d+)\b.*?\bDT\s*[=:]?\s*(?P<dt>{_NUMBER})",
        rf"^\s*(?P<npts>\d+)\s*,?\s+(?P<dt>{_NUMBER})\s*,?\s*NPTS\s*,?\s*DT\b",
        rf"\bNPTS\s*,\s*DT\s*[=:]?\s*(?P<npts>\d+)[,\s]+(?P<dt>{_NUMBER})",
    )
)
_UNIT = re.compile(r"\bUNITS?\s*(?:OF|[=:])\s*\(?\s*([A-Z0-9/*^²]+)", re.IGNORECASE)
_IN_G = re.compile(r"\(\s*(g)\s*\)", re.IGNORECASE)  # of El Centro 1940 as it goes from hand to hand
_DATE = re.compile(r"\d{1,2}/\d{1,2}/\d{2,4}|\d{4}-\d{2}-\d{2}")
_SIGNED = re.compile(rf"[-+]?{_NUMBER}", re.IGNORECASE)
_HEADER_LINES = 10  # the count stands in line 4; a few lines of grace for hand-edited headers
_HEADER_BYTES = 2048
_HEADER_CHARACTERS = 8192
_BLANK = re.compile(r"\s")
_PIECE = 2**20  # characters that are looked at together
_WIDEST = 40  # characters of a number; longer ones are no numbers, and would cost the patterns long


@dataclass(frozen=True)
class _At2:
    """The contents of an AT2 file; ``values`` in its own ``unit``, shape (npts,). PEER's own records are corrected ones."""

    event: str
    date: str
    station: str
    component: str
    unit: str | None
    dt: float
    values: Samples
    by_peer: bool


def is_at2(filename: Any) -> bool:
    """Whether a path or a file-like object holds a PEER AT2 file; never raises."""
    return looks_like_at2(first_bytes(filename))


def looks_like_at2(head: bytes) -> bool:
    """Whether the first bytes are an AT2 header: a count with a time step, below a unit or PEER's name."""
    lines = head[:_HEADER_BYTES].decode("latin-1").splitlines()[:_HEADER_LINES]
    for i, line in enumerate(lines):
        if _count_and_step(line):
            above = " ".join(lines[:i]).upper()
            return i > 0 and ("UNITS OF" in above or "PEER" in above)
    return False


def has_at2_count(head: bytes) -> bool:
    """Whether the first bytes have a count with a time step, as the header of an AT2 file: for files of that suffix."""
    lines = head[:_HEADER_BYTES].decode("latin-1").splitlines()[:_HEADER_LINES]
    return any(_count_and_step(line) for line in lines)


def read_at2(filename: FileLike, headonly: bool = False, **kwargs: Any) -> "Stream":
    """Read an AT2 file into an ObsPy Stream of one Trace: ObsPy calls this for ``obspy.read("x.AT2")``.

    The data stay in the file's unit; ``stats.at2`` has ``event``, ``date``, ``station``, ``component`` and
    ``unit``. Raises ``InputError`` for a file that cannot be used, with the line, what was found and what was
    expected.
    """
    from obspy import Stream, Trace
    from obspy.core import AttribDict

    place, data = name_and_bytes(filename)
    try:
        record = _parse(data.decode("latin-1"))
    except InputError as error:
        raise InputError(*(f"{place}: {problem}" for problem in error.problems)) from None
    header = {
        "delta": record.dt,
        "station": "".join(c for c in record.station.upper() if c.isalnum())[:5],
        "channel": record.component.upper(),
        "at2": AttribDict(
            event=record.event,
            date=record.date,
            station=record.station,
            component=record.component,
            unit=record.unit or "",
        ),
    }
    if headonly:
        return Stream([Trace(header={**header, "npts": len(record.values)})])
    return Stream([Trace(data=record.values, header=header)])


def read_component(file: RecordFile) -> list[Component]:
    """The component of an AT2 file, in m/s²; its g is the study's gravity."""
    record = _parse(file.data.decode("latin-1"))
    unit = record.unit or file.options.unit
    if unit is None:
        raise UnstatedError('no unit in the header ("… IN UNITS OF G"); state it in the study, e.g. unit = "g"', "unit")
    try:
        factor = acceleration_factor(unit, file.gravity)
    except ValueError as error:
        raise InputError(f"header: {error}") from None
    file.options.hold_against(unit, record.dt, file.gravity)
    orientation = orientation_of(record.component) or split_stem(file.stem)[1] or UNKNOWN
    parts = (record.event, record.date, record.station)
    return [
        Component(
            name=file.stem,
            dt=record.dt,
            acceleration=record.values * factor,
            orientation=orientation,
            station=", ".join(part.upper() for part in parts) if record.station and record.date else "",
            source=file.source,
            unit=unit,
            seat=Seat(record.station.upper()),
            event=f"{record.event} {record.date}".strip().upper() if record.date else "",
            processed=record.by_peer or None,
            origin=origin_of(record.event, record.station, record.date),
        )
    ]


def _parse(text: str) -> _At2:
    """Return the contents of an AT2 file; ``InputError`` with the line where it cannot be used."""
    lines = text[:_HEADER_CHARACTERS].splitlines(keepends=True)[:_HEADER_LINES]
    at = next((i for i, line in enumerate(lines) if _count_and_step(line)), None)
    found = None if at is None else _count_and_step(lines[at])
    if at is None or found is None:
        raise InputError(
            f"lines 1–{len(lines)}: no number of points and time step found; "
            'expected a line such as "NPTS= 4316, DT= .0100 SEC"'
        )
    npts, dt = int(found["npts"]), float(found["dt"].upper().replace("D", "E"))
    if not 1 <= npts <= MOST_SAMPLES or not is_step(dt):
        raise InputError(
            f'line {at + 1}: found "{lines[at].strip()[:80]}"; expected a count from 1 to {MOST_SAMPLES:,}, and a time step of '
            f"{STEPS}"
        )
    header = " ".join(lines[:at])
    if quantity := re.search(r"\b(?:VELOCITY|DISPLACEMENT) TIME\b", header, re.IGNORECASE):
        raise NoRecordError(
            f'header: found "{quantity[0]}…"; expected accelerations: take the .AT2 file of this record'
        )
    unit = _UNIT.search(header) or _IN_G.search(" ".join(lines[: at + 1]))
    event, date, station, component = _title(lines[1].strip()) if at > 1 else ("", "", "", "")
    values = _values(text, sum(map(len, lines[: at + 1])), npts)
    return _At2(event, date, station, component, unit[1] if unit else None, dt, values, "PEER" in header.upper())


def _count_and_step(line: str) -> re.Match[str] | None:
    """The groups ``npts`` and ``dt`` of a header line, in any dialect."""
    return next((match for pattern in _COUNT_AND_STEP if (match := pattern.search(line[:200]))), None)


def _title(line: str) -> tuple[str, str, str, str]:
    """Event, date, station and component of header line 2; empty where it does not say.

    "Duzce Turkey, 11/12/1999, Lamont 362, E" and "CAPE MENDOCINO 04/25/92 1806, CAPE MENDOCINO, 000 (CDMG
    …)".
    """
    fields = [field.strip() for field in re.sub(r"\(.*", "", line).split(",")]
    at = next((i for i, field in enumerate(fields) if _DATE.search(field)), None)
    if at is None:
        return ("", "", "", fields[-1] if len(fields) > 1 and orientation_of(fields[-1]) else "")
    start = _DATE.search(fields[at])
    assert start is not None
    event = ", ".join(filter(None, [*fields[:at], fields[at][: start.start()].strip()]))
    component = fields[-1] if len(fields) > at + 1 and orientation_of(fields[-1]) else ""
    station = ", ".join(fields[at + 1 : -1] if component else fields[at + 1 :])
    return event, fields[at][start.start() :], station, component


def _values(text: str, start: int, npts: int) -> Samples:
    """The ``npts`` numbers from the character ``start`` on, or ``InputError``: never one more or less."""
    try:
        values, last = _between_blanks(text, start)
    except ValueError:
        values, last = _touching_or_double(text, start, npts)
    if len(values) != npts:
        raise InputError(f"the header says NPTS = {npts}, but the file holds {len(values)} values; fetch it again")
    if not np.isfinite(values).all():
        i = int(np.flatnonzero(~np.isfinite(values))[0])
        raise InputError(f'value {i + 1} of {npts} is "{values[i]}"; expected finite numbers')
    if is_cut_short(last):
        raise InputError(f'the last value is "{last[-1]}", shorter than all others: the file is cut; fetch it again')
    return values


def _between_blanks(text: str, start: int) -> tuple[Samples, list[str]]:
    """The numbers from ``start`` on, and the last of them as they are written; ``ValueError`` where one is none.

    A piece of the file after the other: its words as Python's objects would take thirty times its size.
    """
    end = len(text.rstrip("\x00\x1a"))
    values, last = [np.empty(0)], list[str]()
    while start < end:
        blank = _BLANK.search(text, start + _PIECE, end)
        stop = blank.end() if blank else end
        tokens = text[start:stop].split()
        if any("_" in token for token in tokens):  # Python would read 1_0 as ten
            raise ValueError
        values.append(np.array([float(token) for token in tokens]))
        last = [*last, *tokens][-LOOKED_AT:]
        start = stop
    return np.concatenate(values), last


def _touching_or_double(text: str, start: int, npts: int) -> tuple[Samples, list[str]]:
    """Likewise, of Fortran's columns that touch, or numbers in double precision; ``InputError`` with the line."""
    lines = text[start:].rstrip("\x00\x1a").splitlines()
    body = [line.rstrip() for line in lines if line.strip()]
    width = _width(body, npts)
    if width is None:
        first = text.count("\n", 0, start)
        fields = ((token, first + i) for i, line in enumerate(lines) for token in line.split())
        values = np.fromiter((_number(token, at) for token, at in fields), float)
        return values, [token for line in body[-LOOKED_AT:] for token in line.split()][-LOOKED_AT:]
    cells = (line[at : at + width] for line in body for at in range(0, len(line), width))
    values = np.fromiter((float(_plain(cell)) for cell in cells), float)
    return values, [line[at : at + width].strip() for line in body[-LOOKED_AT:] for at in range(0, len(line), width)][
        -LOOKED_AT:
    ]


def _plain(number: str) -> str:
    """A number of Fortran's as Python reads it."""
    return number.strip().upper().replace("D", "E")


def _number(token: str, at: int) -> float:
    """``token`` of the line with index ``at`` as a number, or ``InputError``."""
    if (len(token) <= _WIDEST and _SIGNED.fullmatch(token)) or token.lower().lstrip("+-") in (
        "nan",
        "inf",
        "infinity",
    ):
        return float(_plain(token))
    raise InputError(f'line {at + 1}: found "{token[:40]}"; expected numbers separated by blanks, or in equal columns')


def _width(lines: list[str], npts: int) -> int | None:
    """Width of Fortran columns whose values touch, such as 5E15.7; ``None`` unless they come to ``npts`` numbers.

    The count tells how many fields a full line has, and so how wide they are.
    """
    longest = max(map(len, lines), default=0)
    full = len(lines) - 1
    for width in range(1, _WIDEST + 1):
        per_line = longest // width
        if longest % width or not per_line * full < npts <= per_line * (full + 1):
            continue
        if sum(-(-len(line) // width) for line in lines) == npts and all(
            _SIGNED.fullmatch(line[at : at + width].strip()) for line in lines for at in range(0, len(line), width)
        ):
            return width
    return None
