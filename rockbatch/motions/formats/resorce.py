"""RESORCE files (.cor.acc), the reference database of European records: one corrected component in m/s².

Nine lines of ``KEY : value`` and one with the unit, then the accelerations, five to a line of 14 characters each, without
blanks between them. The layout is that of the database's own files.
"""

import re

from rockbatch.motions.component import Sensor
from rockbatch.motions.formats.fixed_width import fixed_numbers, lines_of, refuse_more
from rockbatch.motions.formats.header_lines import count_and_step, keys_of, line_with
from rockbatch.motions.formats.recording import Recording
from rockbatch.motions.formats.stated import Stated
from rockbatch.motions.labels.origin import origin_of

_WIDTH, _PER_LINE = 14, 5
_UNIT = re.compile(r"acc\w* time series in +(?P<unit>\S+)", re.IGNORECASE)
_NEEDED = ("Number of Data", "Time Increment (s)", "Orientation")


def is_resorce(head: bytes) -> bool:
    """Return whether the first bytes are a RESORCE header: "Event Date & Time", and keys of count, interval and orientation."""
    keys = {line.partition(b":")[0].strip() for line in head.splitlines()}
    return head.startswith(b"Event Date & Time") and keys.issuperset(key.encode() for key in _NEEDED)


def parse(text: str) -> list[Recording]:
    """Return the recording in a list; raise ``InputError`` with the line or the missing key if it is incomplete."""
    lines = lines_of(text)
    index, unit = line_with(_UNIT, lines, 20, "Acceleration time series in m/s/s")
    header = keys_of(lines[:index], *_NEEDED)
    npts, dt = count_and_step(header, *_NEEDED[:2])
    values, end = fixed_numbers(lines, index + 1, npts, _WIDTH, _PER_LINE)
    refuse_more(lines, end, f"the {npts} declared values")
    code, _, name = (part.strip() for part in header.get("Station Code / Name", "").partition("/"))
    event = header.get("Event Date & Time", "")
    return [
        Recording(
            label=header["Orientation"],
            dt=dt,
            values=values,
            unit=unit["unit"],
            station=f"{code}, {event}" if code else "",
            processed=True,
            stated=(Stated("peak", header.get("PGA (m/s/s)", ""), "m/s/s"),),
            sensor=Sensor(code),
            event=event,
            origin=origin_of(date=event, station=name or code),
        )
    ]
