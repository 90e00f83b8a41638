"""RENADIC (Universidad de Chile): uncorrected records in the layout of the CDMG's Volume 1, as pairs of time and value.

Each channel has 13 lines of text, 7 of integers and 7 of real numbers; then its pairs, five to a line, in
columns of 7 characters (F7.3), and a line that begins with ``/&``. Volume 1 files of other agencies with the
same words in line 12, digitised from film at uneven times, are read as well.
"""

import re

from rockbatch.errors import InputError
from rockbatch.motions.component import Component, Seat
from rockbatch.motions.formats.fixed_width import fixed_numbers, one_after_another
from rockbatch.motions.formats.header_lines import found, moment
from rockbatch.motions.formats.obspy_plugin import plugin
from rockbatch.motions.formats.record_file import RecordFile
from rockbatch.motions.formats.recording import Recording, to_components
from rockbatch.motions.formats.time_steps import from_pairs
from rockbatch.motions.motion import Unusable
from rockbatch.motions.orientation import is_clock
from rockbatch.motions.origin import origin_of

SUFFIXES = frozenset({".v1", ".raw"})

_HEADER = 27  # lines
_WIDTH, _PER_LINE = 7, 10
_PAIRS = "UNITS OF UNCOR ACCEL ARE SEC AND"
_TITLE = re.compile(r"UNCORRECTED ACCELEROGRAM DATA")
_CHANNEL = re.compile(r"CHAN\s+[0-9]{1,3}:\s*(?P<label>[^(]*?)\s*(?:\(|$)")
_COUNT = re.compile(r"NO\. OF POINTS\s*=\s*(?P<npts>[0-9]{1,9})\s+RECORD LENGTH\s*=\s*(?P<length>[0-9.]{1,12})")
_UNIT = re.compile(_PAIRS + r"\s+(?P<unit>[A-Z0-9/]+)(?:.*?MAX\s*=\s*(?P<peak>[-+]?[0-9]{0,5}\.[0-9]{1,6})\s+G\b)?")
_TRIGGER = re.compile(
    r"TRIGGER TIME:\s*(\d{1,2})/(\d{1,2})/(\d{4})\s+(\d{1,2}):(\d{2}):(\d{2}(?:\.\d{1,6})?)", re.ASCII
)
_NOT_SET = (1980, 1, 1)  # the date of a recorder whose clock nobody set


def is_renadic(head: bytes) -> bool:
    """Whether the first bytes are a Volume 1 header whose data are pairs of time and value."""
    return head.lstrip().startswith(b"UNCORRECTED ACCELEROGRAM DATA") and _PAIRS.encode() in head


def read_renadic(file: RecordFile) -> list[Component | Unusable]:
    """The channels of a file in m/s², the instrument's zero still in them; uneven times are interpolated."""
    return to_components(file, _parse(file.text))


def _parse(text: str) -> list[Recording]:
    """The channels, one after the other; ``InputError`` with the line where the file is not whole."""
    channels = one_after_another(text, _channel)
    recordings = [recording for recording, _ in channels]
    begins = [first for recording, first in channels if not is_clock(recording.label)] or [0.0]
    if recordings[0].start is None and max(begins) - min(begins) > 0.5 * recordings[0].dt:
        raise InputError(
            f"its channels begin at different times ({', '.join(f'{t:g}' for t in begins)} s) and no trigger time is "
            "set; cut them to a common one"
        )
    return recordings


def _channel(lines: list[str], at: int) -> tuple[tuple[Recording, float], int]:
    """The channel whose title is ``lines[at]``, its first time [s], and where the next one begins."""
    found(_TITLE, lines, at, "UNCORRECTED ACCELEROGRAM DATA, after the last declared value")
    label = found(_CHANNEL, lines, at + 6, "CHAN  1: L")["label"]
    count = found(_COUNT, lines, at + 10, "NO. OF POINTS = … RECORD LENGTH = … SEC")
    units = found(_UNIT, lines, at + 11, f"{_PAIRS} G/10")
    npts = int(count["npts"])
    if npts < 2:
        raise InputError(f"line {at + 11}: found {npts} points; expected at least two")
    pairs = fixed_numbers(lines, at + _HEADER, 2 * npts, _WIDTH, _PER_LINE).reshape(npts, 2)
    end = at + _HEADER + -(-2 * npts // _PER_LINE)
    if end >= len(lines) or not lines[end].startswith("/&"):
        line = lines[end][:60] if end < len(lines) else "(end of file)"
        raise InputError(f'line {end + 1}: found "{line}"; expected "/&" after {npts} pairs; fetch it again')
    dt, values, notes = from_pairs(pairs, f"channel {label} from line {at + 1} on")
    first = float(pairs[0, 0])
    trigger = _trigger(lines[at + 3])
    unit = units["unit"]
    recording = Recording(
        label=label,
        dt=dt,
        values=values,
        unit=unit,
        station=f"{lines[at + 5].strip()}, {lines[at + 1].strip()}, uncorrected",
        codes=("", "".join(c for c in lines[at + 5].upper() if c.isascii() and c.isalnum())[:5], "", label.upper()),
        start=None if trigger is None else trigger + first,
        uncorrected=True,
        processed=False,
        seat=Seat(lines[at + 5].strip().upper()),
        event=lines[at + 1],
        origin=origin_of(lines[at + 1], lines[at + 5]),
        stated_peak=(units["peak"] or "", "g"),
        as_read=pairs[:, 1],
        notes=notes,
        header={"station": lines[at + 5].strip(), "event": lines[at + 1].strip()},
    )
    return (recording, first), end + 1


def _trigger(line: str) -> float | None:
    """Trigger time [s since 1970], month first; ``None`` where the clock was not set."""
    match = _TRIGGER.search(line[:200])
    if match is None:
        return None
    month, day, year, hour, minute = (int(match[i]) for i in range(1, 6))
    return None if (year, month, day) == _NOT_SET else moment(year, month, day, hour, minute, float(match[6]))


is_renadic_file, read_renadic_stream = plugin("RENADIC", is_renadic, _parse)
