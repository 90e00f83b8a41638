"""CSMNC files (China Strong Motion Networks Center): one component, uncorrected or corrected.

Some sixteen lines of text ("COMP. EW", "NO. OF POINTS: … EQUALLY SPACED INTERVALS OF: … SEC"), then the accelerations,
eight to a line between blanks. The layout is that of the Center's own files, such as those of Lushan 2013, and of its
description of them; further lines of text differ from year to year.
"""

import math
import re

from rockbatch.common.errors import InputError, NoRecord
from rockbatch.motions.component import Sensor
from rockbatch.motions.formats.fixed_width import lines_of, number_in, spaced_numbers
from rockbatch.motions.formats.header_lines import line_with, search_lines
from rockbatch.motions.formats.obspy_plugin import plugin
from rockbatch.motions.formats.recording import Recording
from rockbatch.motions.formats.stated import Stated
from rockbatch.motions.labels.origin import origin_of

_MOST = 30  # lines of header
_PER_LINE = 8
_KIND = re.compile(r"^ *(?P<un>UN)?CORRECTED (?P<what>[A-Z]+) +UNIT: *(?P<unit>[A-Z0-9/*^]+)", re.IGNORECASE)
_COUNT = re.compile(
    r"NO\. OF POINTS: *(?P<npts>[0-9]{1,9}) +EQUALLY SPACED INTERVALS OF: *(?P<dt>[0-9.]{1,12}) *SEC", re.IGNORECASE
)
_COMPONENT = re.compile(r"^ *COMP\. *(?P<label>\S+)", re.IGNORECASE)
_STATION = re.compile(r"^ *STATION: *(?P<code>\S+)", re.IGNORECASE)
_POINT = re.compile(r"^ *OBSERVING POINT: *(?P<place>\S.*)", re.IGNORECASE)
_PEAK = re.compile(
    r"PEAK VALUE: *(?P<peak>[-+]?[0-9.]{1,15}(?:E[-+]?[0-9]{1,3})?)(?: *AT *(?P<at>[0-9.]{1,12}) *SEC)?", re.IGNORECASE
)
_DURATION = re.compile(r"DURATION: *(?P<duration>[0-9.]{1,12}) *SEC", re.IGNORECASE)
_WITHOUT_ENDS = (0.01, math.inf)  # the example in the Center's description has 120 s of 150 s
_NUMBERS = re.compile(r"\s*[-+]?[0-9.][-+0-9.E\s]*", re.IGNORECASE)


def is_csmnc(head: bytes) -> bool:
    """Return whether the first bytes have the lines of a CSMNC header for quantity, count and component."""
    lines = lines_of(head.decode("latin-1"))[:_MOST]
    return all(search_lines(pattern, lines) for pattern in (_KIND, _COUNT, _COMPONENT))


def parse(text: str) -> list[Recording]:
    """Return the recording in a list; raise ``InputError`` with the line that is wrong, missing or of another quantity."""
    lines = lines_of(text)
    index, kind = line_with(_KIND, lines, _MOST, "UNCORRECTED ACCELERATION UNIT: CM/SEC/SEC")
    if not kind["what"].upper().startswith("ACC"):  # the Center's own description has "ACCCELERATION"
        what = kind["what"]
        raise NoRecord(f'line {index + 1}: found "{what}"; expected accelerations: take the file that has them')
    label = line_with(_COMPONENT, lines, _MOST, "COMP. EW")[1]["label"]
    station = line_with(_STATION, lines, _MOST, "STATION: …")[1]["code"]
    index, count = line_with(_COUNT, lines, _MOST, "NO. OF POINTS: … EQUALLY SPACED INTERVALS OF: … SEC")
    npts, dt = int(count["npts"]), number_in(count["dt"], index)
    if npts < 2 or not 0 < dt < 10:
        raise InputError(f'line {index + 1}: found "{count[0].strip()}"; expected two points or more and an interval')
    first = next((i for i in range(index + 1, min(len(lines), _MOST + 1)) if _NUMBERS.fullmatch(lines[i])), index + 1)
    peak, duration = (search_lines(pattern, lines[index:first]) for pattern in (_PEAK, _DURATION))
    place = search_lines(_POINT, lines[:_MOST])
    return [
        Recording(
            label=label,
            dt=dt,
            values=spaced_numbers(lines, first, npts, _PER_LINE),
            unit=kind["unit"],
            station=f"{station}, {lines[1].strip()[:60]}, {'un' if kind['un'] else ''}corrected",
            processed=not kind["un"],
            sensor=Sensor(station, "CN", place=place["place"].strip().upper() if place else None),
            event=lines[1][:60],
            origin=origin_of(lines[2], station, lines[1]),
            stated=(
                Stated("peak", peak["peak"] if peak else ""),
                Stated("time of the peak", (peak["at"] or "") if peak else ""),
                Stated("duration", duration["duration"] if duration else "", limits=_WITHOUT_ENDS),
            ),
            header={"station": station, "event": lines[2].strip()[:60]},
        )
    ]


is_csmnc_file, read_csmnc_stream = plugin("CSMNC", is_csmnc, parse)
