"""RENADIC (Universidad de Chile): uncorrected records in the layout of the CDMG's Volume 1, as pairs of time and value.

Each channel has 13 lines of text, 7 of integers and 7 of real numbers; then its pairs, five to a line, in
columns of 7 characters (F7.3), and a line that begins with ``/&``. Volume 1 files of other agencies with the
same words in line 12, digitised from film at uneven times, are read as well.
"""

from rockbatch.common.errors import InputError
from rockbatch.motions.component import Sensor
from rockbatch.motions.formats.fixed_width import fixed_numbers, one_after_another
from rockbatch.motions.formats.header_lines import CLOCK, layout, moment_of, past_mark, read_header
from rockbatch.motions.formats.obspy_plugin import plugin
from rockbatch.motions.formats.recording import Recording
from rockbatch.motions.formats.time_steps import from_pairs
from rockbatch.motions.orientation import is_clock
from rockbatch.motions.origin import origin_of

_HEADER = 27  # lines
_WIDTH, _PER_LINE = 7, 10
_PAIRS = "UNITS OF UNCOR ACCEL ARE SEC AND"
_LENGTH = r"RECORD LENGTH\s*=\s*(?P<length>[0-9.]{1,12})"
_MAX = r"(?:.*?MAX\s*=\s*(?P<peak>[-+]?[0-9]{0,5}\.[0-9]{1,6})\s+G\b)?"
_DAY = r"(?P<month>\d{1,2})/(?P<day>\d{1,2})/(?P<year>\d{4})"
_TEXT = layout(
    (0, r"UNCORRECTED ACCELEROGRAM DATA", "UNCORRECTED ACCELEROGRAM DATA, after the last declared value"),
    (6, r"CHAN\s+[0-9]{1,3}:\s*(?P<label>[^(]*?)\s*(?:\(|$)", "CHAN  1: L"),
    (10, rf"NO\. OF POINTS\s*=\s*(?P<npts>[0-9]{{1,9}})\s+{_LENGTH}", "NO. OF POINTS = … RECORD LENGTH = … SEC"),
    (11, rf"{_PAIRS}\s+(?P<unit>[A-Z0-9/]+){_MAX}", f"{_PAIRS} G/10"),
    (3, rf"(?a)TRIGGER TIME:\s*{_DAY}\s+{CLOCK}", ""),
)
_NOT_SET = "1980-1-1"  # the date of a recorder whose clock nobody set


def is_renadic(head: bytes) -> bool:
    """Return whether the first bytes are a Volume 1 header whose data are pairs of time and value."""
    return head.lstrip().startswith(b"UNCORRECTED ACCELEROGRAM DATA") and _PAIRS.encode() in head


def parse(text: str) -> list[Recording]:
    """Return the channels, one after the other, on even steps; ``InputError`` with the line where the file is not whole."""
    channels = one_after_another(text, _channel)
    recordings = [recording for recording, _ in channels]
    begins = [first for recording, first in channels if not is_clock(recording.label)] or [0.0]
    if recordings[0].start is None and max(begins) - min(begins) > 0.5 * recordings[0].dt:
        raise InputError(
            f"its channels begin at different times ({', '.join(f'{t:g}' for t in begins)} s) and no trigger time is "
            "set; cut them to a common one"
        )
    return recordings


def _channel(lines: list[str], start: int) -> tuple[tuple[Recording, float], int]:
    """Return the channel whose title is ``lines[start]``, its first time [s], and where the next one begins."""
    fields = read_header(lines, start, _TEXT)
    npts, label = int(fields["npts"]), fields["label"]
    if npts < 2:
        raise InputError(f"line {start + 11}: found {npts} points; expected at least two")
    numbers, end = fixed_numbers(lines, start + _HEADER, 2 * npts, _WIDTH, _PER_LINE)
    end, pairs = past_mark(lines, end, f"{npts} pairs"), numbers.reshape(npts, 2)
    dt, values, notes = from_pairs(pairs, f"channel {label} from line {start + 1} on")
    first, trigger = float(pairs[0, 0]), moment_of(fields)
    dated = trigger is not None and "-".join(fields[part].lstrip("0") for part in ("year", "month", "day")) != _NOT_SET
    event, station = lines[start + 1], lines[start + 5].strip()
    recording = Recording(
        label=label,
        dt=dt,
        values=values,
        unit=fields["unit"],
        station=f"{station}, {event.strip()}, uncorrected",
        start=trigger + first if trigger is not None and dated else None,
        processed=False,
        sensor=Sensor(station.upper()),
        event=event,
        origin=origin_of(event, lines[start + 5]),
        stated_peak=(fields["peak"], "g"),
        as_read=pairs[:, 1],
        notes=notes,
        header={"station": station, "event": event.strip()},
    )
    return (recording, first), end


is_renadic_file, read_renadic_stream = plugin("RENADIC", is_renadic, parse)
