"""USC files (University of Southern California, Los Angeles network), Volume I: uncorrected, digitised from film.

Each channel has 13 lines of text, 7 of integers and 7 of real numbers, then pairs of time and value, five to a line
of a blank and ten columns of 7 characters. The layout is that of the network's own files.
"""

import re

from rockbatch.errors import InputError
from rockbatch.motions.component import Seat
from rockbatch.motions.formats.fixed_width import fixed_numbers, number_in, one_after_another
from rockbatch.motions.formats.header_lines import layout, line_at, read_header
from rockbatch.motions.formats.obspy_plugin import plugin
from rockbatch.motions.formats.recording import Recording
from rockbatch.motions.formats.time_steps import from_pairs
from rockbatch.motions.motion import Samples
from rockbatch.motions.origin import origin_of

_HEADER = 27  # lines
_WIDTH, _PER_LINE = 7, 10
_LATE = 0.05  # s: what the stated duration may differ from the last time
_TITLE = re.compile(r"OF UNCORRECTED ACCELEROGRAM DATA OF VOLUME I:")
_CORRECTED = re.compile(r"(?<!UN)CORRECTED ACCELEROGRAM")
_DURATION = r"DURATION *= *(?P<duration>[0-9.]{1,12}) *SEC"
_TEXT = layout(
    (0, _TITLE.pattern, "FILE … OF UNCORRECTED ACCELEROGRAM DATA OF VOLUME I:, after the last declared value"),
    (6, r"^ *COMP +(?P<label>\S+)", "COMP N90E"),
    (4, r"STATION USC# *(?P<station>\S+?),*(?:\s|$)", "STATION USC# …"),
    (10, rf"NO\. OF POINTS *= *(?P<npts>[0-9]{{1,9}}) +{_DURATION}", "NO. OF POINTS = … DURATION = … SEC"),
    (11, r"UNITS ARE SEC AND +(?P<unit>[A-Z0-9/]+)", "UNITS ARE SEC AND G/10"),
)


def is_usc(head: bytes) -> bool:
    """Return whether the first bytes are the header of a file of either volume."""
    title = head[:100].decode("latin-1")
    return _TITLE.search(title) is not None or (_CORRECTED.search(title) is not None and b"STATION USC#" in head[:800])


def parse(text: str) -> list[Recording]:
    """Return the channels, one after the other, on even steps; ``InputError`` with the line where the file is not whole."""
    if _TITLE.search(text[:100]) is None and _CORRECTED.search(text[:100]):
        raise InputError(
            "line 1: Volume II, of whose layout no description is at hand; take Volume I of this record, or copy its "
            'accelerations into a .txt file and write layout = "wrapped", unit and dt for it in motions.toml'
        )
    return one_after_another(text, _channel)


def _channel(lines: list[str], at: int) -> tuple[Recording, int]:
    """Return the channel whose title is ``lines[at]``, and where the next one begins."""
    said = read_header(lines, at, _TEXT)
    label, npts, duration = said["label"], int(said["npts"]), number_in(said["duration"], at + 10)
    if npts < 2:
        raise InputError(f"line {at + 11}: found {npts} points; expected at least two")
    pairs, end = _pairs(lines, at + _HEADER, npts)
    if abs(pairs[-1, 0] - duration) > _LATE:
        raise InputError(f"line {at + 11} says {duration:g} s, but the last time is {pairs[-1, 0]:g} s")
    dt, values, notes = from_pairs(pairs, f"channel {label} from line {at + 1} on")
    event, date, name = (line_at(lines, at + i)[:70].strip() for i in (1, 2, 5))
    recording = Recording(
        label=label,
        dt=dt,
        values=values,
        unit=said["unit"],
        station=f"{said['station']}, {event}, {date}",
        codes=("LA", said["station"][:5], "", label.upper()),
        processed=False,
        seat=Seat(said["station"]),
        event=f"{event}, {date}",
        origin=origin_of(event, line_at(lines, at + 5)[:70], date),
        notes=notes,
        header={"station": name, "event": event},
    )
    return recording, end


def _pairs(lines: list[str], first: int, npts: int) -> tuple[Samples, int]:
    """Return times [s] and values, shape (npts, 2), and where the next channel begins: some files have a line in between."""
    end = first - -2 * npts // _PER_LINE
    indented = next((i for i in range(first, min(end, len(lines))) if not lines[i].startswith(" ")), None)
    if indented is not None:
        raise InputError(f'line {indented + 1}: found "{lines[indented][:40]}"; expected a blank and ten columns')
    numbers, end = fixed_numbers(
        [""] * first + [line[1:] for line in lines[first:end]], first, 2 * npts, _WIDTH, _PER_LINE
    )
    return numbers.reshape(npts, 2), end + line_at(lines, end).startswith("/&")


is_usc_file, read_usc_stream = plugin("USC", is_usc, parse)
