"""DYNA files (.ASC): one component in the format of the ESM, ITACA and AFAD databases (Italy, Europe, Türkiye).

Lines of ``KEY: value`` (64 of them in DYNA 1.2), then one value per line. The keys are those of the format's own
files; empty ones are unknown.
"""

import re

import numpy as np

from rockbatch.errors import InputError, NoRecordError
from rockbatch.motions.component import Seat
from rockbatch.motions.formats.fixed_width import LOOKED_AT, is_cut_short, lines_of, number_in
from rockbatch.motions.formats.header_lines import moment_in
from rockbatch.motions.formats.obspy_plugin import plugin
from rockbatch.motions.formats.recording import Recording
from rockbatch.motions.motion import Samples
from rockbatch.motions.origin import TURKISH, origin_of

SUFFIXES = frozenset({".asc"})

_MOST_KEYS = 200
_TURKISH = ("TK", "TU", "KO")  # networks whose texts are in Windows-1254
_ROUGHLY = 0.01  # relative: what the stated duration, rounded or off by a sample, may differ
_MOMENT = re.compile(
    r"(?P<year>\d{4})/?(?P<month>\d\d)/?(?P<day>\d\d)[_ T]"
    r"(?P<hour>\d\d):?(?P<minute>\d\d):?(?P<second>\d\d(?:\.\d{1,6})?)",
    re.ASCII,
)


def is_dyna(head: bytes) -> bool:
    """Whether the first bytes are a DYNA header."""
    return head.removeprefix(b"\xef\xbb\xbf").startswith(b"EVENT_NAME:") and b"SAMPLING_INTERVAL_S:" in head


def parse(text: str) -> list[Recording]:
    """The component, as a list of one; ``InputError`` with all that is wrong with the header, or the line."""
    lines = lines_of(text)
    header = _header(lines)
    if header.get("NETWORK") in _TURKISH:
        header = {key: value.translate(TURKISH) for key, value in header.items()}
    npts, dt = _count_and_step(header)
    values = _values(lines, len(header), npts)
    unit = header["UNITS"]
    codes = tuple(header.get(key, "") for key in ("NETWORK", "STATION_CODE", "LOCATION"))
    stream = header["STREAM"]
    year = header.get("EVENT_DATE_YYYYMMDD", "")[:4]
    event = header.get("EVENT_ID") or header["EVENT_NAME"]
    return [
        Recording(
            label=stream,
            dt=dt,
            values=values,
            unit=unit,
            station=", ".join([".".join((*codes, stream[:-1])), event, header.get("PROCESSING", "")]),
            start=moment_in(_MOMENT, header.get("DATE_TIME_FIRST_SAMPLE_YYYYMMDD_HHMMSS", "")),
            raw="NOT REMOVED" in header.get("BASELINE_CORRECTION", "").upper(),
            processed=_processed(header),
            seat=Seat(codes[1], codes[0], codes[2]),
            event=event,
            origin=origin_of(header["EVENT_NAME"], header.get("STATION_NAME") or codes[1], year),
            stated_peak=(header.get("PGA_CM/S^2", ""), "cm/s^2"),
            header={key.lower(): value for key, value in header.items() if value},
        )
    ]


def _processed(header: dict[str, str]) -> bool | None:
    """Whether it was filtered; ``None`` where the header does not tell."""
    said = header.get("PROCESSING") or header.get("LOW_CUT_FREQUENCY_HZ", "")
    return said.upper() != "NONE" if said else None


def _header(lines: list[str]) -> dict[str, str]:
    """The keys before the first line that has none, each with its value."""
    header: dict[str, str] = {}
    for number, line in enumerate(lines[:_MOST_KEYS], start=1):
        key, colon, value = line.partition(":")
        if not colon:
            break
        if key.strip() in header:
            raise InputError(f'line {number}: "{key.strip()[:40]}" a second time; expected the values of one component')
        header[key.strip()] = value.strip()
    lacking = [key for key in ("SAMPLING_INTERVAL_S", "NDATA", "UNITS", "STREAM") if not header.get(key)]
    if lacking:
        raise InputError(f"the header lacks {', '.join(lacking)}")
    kind = header.get("DATA_TYPE", "ACCELERATION")
    if kind.upper() != "ACCELERATION":
        raise NoRecordError(
            f"the header says DATA_TYPE: {kind[:40]}; expected ACCELERATION: take that file of this record"
        )
    return header


def _count_and_step(header: dict[str, str]) -> tuple[int, float]:
    """Number of values and sampling interval [s], which must agree with the stated duration."""
    npts, dt, duration = (_positive(header, key) for key in ("NDATA", "SAMPLING_INTERVAL_S", "DURATION_S"))
    if npts is None or dt is None or npts != int(npts):
        raise InputError(
            f"the header says NDATA: {header['NDATA'][:40]}, SAMPLING_INTERVAL_S: "
            f"{header['SAMPLING_INTERVAL_S'][:40]}; expected a whole number and a time above 0"
        )
    if duration is not None and abs(npts * dt - duration) > max(2 * dt, _ROUGHLY * duration):
        raise InputError(f"the header says {npts:.0f} values every {dt:g} s, but also {duration:g} s in all")
    return int(npts), dt


def _positive(header: dict[str, str], key: str) -> float | None:
    """The value of ``key`` as a number above 0; ``None`` where it is none."""
    try:
        value = number_in(header.get(key, ""), 0)
    except InputError:
        return None
    return value if value > 0 else None


def _values(lines: list[str], first: int, npts: int) -> Samples:
    """The values from line ``first`` on, ``npts`` lines with one each, shape (npts,)."""
    end = next((i for i in range(len(lines), first, -1) if lines[i - 1].strip()), first)
    if end - first != npts:
        raise InputError(
            f"the header says NDATA: {npts}, but {end - first} lines follow it, from line {first + 1} on; "
            "fetch the file again"
        )
    if is_cut_short([line.strip() for line in lines[max(first, end - LOOKED_AT) : end]]):
        raise InputError(f'line {end}: found "{lines[end - 1][:40]}", shorter than all others: the file is cut')
    return np.array([number_in(lines[i], i) for i in range(first, end)])


is_dyna_file, read_dyna_stream = plugin("DYNA", is_dyna, parse)
