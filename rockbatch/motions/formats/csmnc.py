"""CSMNC files (China Strong Motion Networks Center): one component, uncorrected or corrected.

Some sixteen lines of text ("COMP. EW", "NO. OF POINTS: … EQUALLY SPACED INTERVALS OF: … SEC"), then the accelerations,
eight to a line between blanks. The layout is that of the Center's own files, such as those of Lushan 2013, and of its
description of them; lines in between differ from year to year.
"""

import re

from rockbatch.errors import InputError, NoRecordError
from rockbatch.motions.component import Component, Seat
from rockbatch.motions.formats.fixed_width import lines_of, spaced_numbers
from rockbatch.motions.formats.header_lines import line_with, number
from rockbatch.motions.formats.obspy_plugin import plugin
from rockbatch.motions.formats.record_file import RecordFile
from rockbatch.motions.formats.recording import Recording, to_components
from rockbatch.motions.motion import Unusable
from rockbatch.motions.origin import origin_of

SUFFIXES: frozenset[str] = frozenset()

_MOST = 30  # lines of header
_PER_LINE = 8
_KIND = re.compile(r"^ *(?P<un>UN)?CORRECTED (?P<what>[A-Z]+) +UNIT: *(?P<unit>[A-Z0-9/*^]+)", re.IGNORECASE)
_COUNT = re.compile(
    r"NO\. OF POINTS: *(?P<npts>[0-9]{1,9}) +EQUALLY SPACED INTERVALS OF: *(?P<dt>[0-9.]{1,12}) *SEC", re.IGNORECASE
)
_COMPONENT = re.compile(r"^ *COMP\. *(?P<label>\S+)", re.IGNORECASE)
_STATION = re.compile(r"^ *STATION: *(?P<code>\S+)", re.IGNORECASE)
_POINT = re.compile(r"^ *OBSERVING POINT: *(?P<place>\S.*)", re.IGNORECASE)
_PEAK = re.compile(r"PEAK VALUE: *(?P<peak>[-+]?[0-9.]{1,15}(?:E[-+]?[0-9]{1,3})?)", re.IGNORECASE)


def is_csmnc(head: bytes) -> bool:
    """Whether the first bytes are the header of such a file."""
    lines = lines_of(head.decode("latin-1"))[:_MOST]
    return all(any(pattern.search(line[:200]) for line in lines) for pattern in (_KIND, _COUNT, _COMPONENT))


def read_csmnc(file: RecordFile) -> list[Component | Unusable]:
    """The component of a file in m/s², an uncorrected one without offset."""
    return to_components(file, _parse(file.text))


def _parse(text: str) -> list[Recording]:
    """The recording of a file; ``InputError`` with the line where it is not whole."""
    lines = lines_of(text)
    _, kind = line_with(_KIND, lines, _MOST, "UNCORRECTED ACCELERATION UNIT: CM/SEC/SEC")
    if not kind["what"].upper().startswith("ACC"):  # the Center's own description has "ACCCELERATION"
        raise NoRecordError(f'found "{kind["what"]}"; expected accelerations: take the file that has them')
    label = line_with(_COMPONENT, lines, _MOST, "COMP. EW")[1]["label"]
    station = line_with(_STATION, lines, _MOST, "STATION: …")[1]["code"]
    at, count = line_with(_COUNT, lines, _MOST, "NO. OF POINTS: … EQUALLY SPACED INTERVALS OF: … SEC")
    npts, dt = int(count["npts"]), number(count["dt"], at)
    if npts < 2 or not 0 < dt < 10:
        raise InputError(f'line {at + 1}: found "{count[0].strip()}"; expected two points or more and an interval')
    first = next((i for i in range(at + 1, min(len(lines), _MOST + 1)) if _is_data(lines[i])), at + 1)
    peak = next((match for line in lines[at:first] if (match := _PEAK.search(line[:200]))), None)
    return [
        Recording(
            label=label,
            dt=dt,
            values=spaced_numbers(lines, first, npts, _PER_LINE),
            unit=kind["unit"],
            station=f"{station}, {lines[1].strip()[:60]}, {'un' if kind['un'] else ''}corrected",
            codes=("CN", "".join(c for c in station if c.isascii() and c.isalnum())[:5], "", label.upper()),
            uncorrected=bool(kind["un"]),
            processed=not kind["un"],
            seat=Seat(station, "CN", place=_place(lines)),
            event=lines[1][:60],
            origin=origin_of(lines[2], station, lines[1]),
            stated_peak=(peak["peak"] if peak else "", ""),
            header={"station": station, "event": lines[2].strip()[:60]},
        )
    ]


def _place(lines: list[str]) -> str | None:
    """Where the sensor stands ("GROUND"); ``None`` where the header does not say."""
    said = next((match for line in lines[:_MOST] if (match := _POINT.search(line[:200]))), None)
    return said["place"].strip().upper() if said else None


def _is_data(line: str) -> bool:
    """Whether a line holds a full line of numbers, and nothing else."""
    fields = line.split()
    try:
        [float(field) for field in fields]
    except ValueError:
        return False
    return bool(fields)


is_csmnc_file, read_csmnc_stream = plugin("CSMNC", is_csmnc, _parse)
