"""USC files (University of Southern California, Los Angeles network), Volume I: uncorrected, digitised from film.

Each channel has 13 lines of text, 7 of integers and 7 of real numbers, then pairs of time and value, five to a line
of a blank and ten columns of 7 characters. The layout is that of the network's own files.
"""

import re

from rockbatch.errors import InputError
from rockbatch.motions.component import Component, Seat
from rockbatch.motions.formats.fixed_width import fixed_numbers, one_after_another
from rockbatch.motions.formats.header_lines import found, line_at, number
from rockbatch.motions.formats.obspy_plugin import plugin
from rockbatch.motions.formats.record_file import RecordFile
from rockbatch.motions.formats.recording import Recording, to_components
from rockbatch.motions.formats.time_steps import from_pairs
from rockbatch.motions.motion import Samples, Unusable
from rockbatch.motions.origin import origin_of

SUFFIXES: frozenset[str] = frozenset()

_HEADER = 27  # lines
_WIDTH, _PER_LINE = 7, 10
_LATE = 0.05  # s: what the stated duration may differ from the last time
_TITLE = re.compile(r"OF UNCORRECTED ACCELEROGRAM DATA OF VOLUME I:")
_CORRECTED = re.compile(r"(?<!UN)CORRECTED ACCELEROGRAM")
_COMPONENT = re.compile(r"^ *COMP +(?P<label>\S+)")
_STATION = re.compile(r"STATION USC# *(?P<code>\S+)")
_COUNT = re.compile(r"NO\. OF POINTS *= *(?P<npts>[0-9]{1,9}) +DURATION *= *(?P<duration>[0-9.]{1,12}) *SEC")
_UNIT = re.compile(r"UNITS ARE SEC AND +(?P<unit>[A-Z0-9/]+)")


def is_usc(head: bytes) -> bool:
    """Return whether the first bytes are the header of a file of either volume."""
    title = head[:100].decode("latin-1")
    return _TITLE.search(title) is not None or (_CORRECTED.search(title) is not None and b"STATION USC#" in head[:800])


def read_usc(file: RecordFile) -> list[Component | Unusable]:
    """The channels of a file in m/s², without their offsets; uneven times are interpolated."""
    return to_components(file, _parse(file.text))


def _parse(text: str) -> list[Recording]:
    """The channels, one after the other; ``InputError`` with the line where the file is not whole."""
    if _TITLE.search(text[:100]) is None and _CORRECTED.search(text[:100]):
        raise InputError(
            "line 1: Volume II, of whose layout no description is at hand; take Volume I of this record, or copy its "
            'accelerations into a .txt file and write layout = "wrapped", unit and dt for it in motions.toml'
        )
    return one_after_another(text, _channel)


def _channel(lines: list[str], at: int) -> tuple[Recording, int]:
    """The channel whose title is ``lines[at]``, and where the next one begins."""
    found(_TITLE, lines, at, "FILE … OF UNCORRECTED ACCELEROGRAM DATA OF VOLUME I:, after the last declared value")
    label = found(_COMPONENT, lines, at + 6, "COMP N90E")["label"]
    station = found(_STATION, lines, at + 4, "STATION USC# …")["code"].rstrip(",")
    count = found(_COUNT, lines, at + 10, "NO. OF POINTS = … DURATION = … SEC")
    unit = found(_UNIT, lines, at + 11, "UNITS ARE SEC AND G/10")["unit"]
    npts, duration = int(count["npts"]), number(count["duration"], at + 10)
    if npts < 2:
        raise InputError(f"line {at + 11}: found {npts} points; expected at least two")
    pairs, end = _pairs(lines, at + _HEADER, npts)
    if abs(pairs[-1, 0] - duration) > _LATE:
        raise InputError(f"line {at + 11} says {duration:g} s, but the last time is {pairs[-1, 0]:g} s")
    dt, values, notes = from_pairs(pairs, f"channel {label} from line {at + 1} on")
    event, date = (line_at(lines, at + i)[:70].strip() for i in (1, 2))
    recording = Recording(
        label=label,
        dt=dt,
        values=values,
        unit=unit,
        station=f"{station}, {event}, {date}",
        codes=("LA", station[:5], "", label.upper()),
        uncorrected=True,
        processed=False,
        seat=Seat(station),
        event=f"{event}, {date}",
        origin=origin_of(event, line_at(lines, at + 5)[:70], date),
        notes=notes,
        header={"station": line_at(lines, at + 5)[:70].strip(), "event": event},
    )
    return recording, end


def _pairs(lines: list[str], first: int, npts: int) -> tuple[Samples, int]:
    """Times [s] and values, shape (npts, 2), and where the next channel begins: some files have a line in between."""
    end = first - -2 * npts // _PER_LINE
    indented = next((i for i in range(first, min(end, len(lines))) if not lines[i].startswith(" ")), None)
    if indented is not None:
        raise InputError(f'line {indented + 1}: found "{lines[indented][:40]}"; expected a blank and ten columns')
    body = [""] * first + [line[1:] for line in lines[first:end]]
    pairs = fixed_numbers(body, first, 2 * npts, _WIDTH, _PER_LINE).reshape(npts, 2)
    return pairs, end + line_at(lines, end).startswith("/&")


is_usc_file, read_usc_stream = plugin("USC", is_usc, _parse)
