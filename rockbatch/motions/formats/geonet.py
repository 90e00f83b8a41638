"""GeoNet strong-motion files (New Zealand): uncorrected V1A and corrected V2A, three components in a file.

Each component has 16 lines of text, 4 of integers and 6 of real numbers, then its accelerations, in V2A also
its velocities and displacements, ten to a line of 8 characters each. The layout is that of GeoNet's own files.
"""

import re

from rockbatch.common.errors import InputError
from rockbatch.motions.component import Sensor
from rockbatch.motions.formats.fixed_width import fixed_numbers, number_in, one_after_another
from rockbatch.motions.formats.header_lines import layout, line_at, moment, read_header
from rockbatch.motions.formats.obspy_plugin import plugin
from rockbatch.motions.formats.recording import Recording
from rockbatch.motions.formats.stated import Stated
from rockbatch.motions.labels.origin import origin_of

_WIDTH, _PER_LINE = 8, 10
_INTEGERS, _REALS, _DATA = 16, 20, 26  # lines of a component's header at which these begin
_TITLE = re.compile(r"(?P<un>un)?corrected accelerogram\s+(?P<id>\S+)", re.IGNORECASE)
_COUNT = r"(?i)number of points\s+(?P<npts>[0-9]{1,9})\s+duration\s+(?P<duration>[0-9.]{1,15})\s*s"
_PEAK = r"(?i)acceleration:\s+peak\s+(?P<peak>[-0-9.]{1,15})\s+(?P<of_peak>\S+)(?:\s+at\s+(?P<at>[0-9.]{1,15})\s*s)?"
_OF_PEAK = r"peak\s+[-0-9.]{1,15}\s+"
_TEXT = layout(
    (0, rf"(?i){_TITLE.pattern}", "(Un)corrected accelerogram …, after the last declared value"),
    (9, _COUNT, "Number of points … Duration … s"),
    (12, r"(?i)component\s+(?P<label>\S+)", "Component …"),
    (13, _PEAK, "Acceleration: peak … mm/s/s"),
    (1, r"(?i)site\s+(?P<site>\S+)", "Site …"),
    (14, rf"(?i)^\s*velocity:\s+{_OF_PEAK}(?P<velocity>\S+)", ""),
    (15, rf"(?i)^\s*displacement:\s+{_OF_PEAK}(?P<displacement>\S+)", ""),
)
_RAW = r"(?i)raw readings in units of\s+(?P<factor>[0-9.]{1,15})\s+(?P<unit>\S+)"
_OF_RAW = layout((10, _RAW, "Raw readings in units of 1.00 mm/s/s at intervals of … s"))


def is_geonet(head: bytes) -> bool:
    """Return whether the first bytes are the header of a V1A or V2A file."""
    lines = head.decode("latin-1").splitlines()[:16]
    text = "\n".join(lines[9:12]).lower()
    return (
        len(lines) > 11
        and _TITLE.match(lines[0].strip()) is not None
        and ("raw readings in units of" in text or "instrument corrected data" in text)
    )


def parse(text: str) -> list[Recording]:
    """Return the components, one after the other; raise ``InputError`` with the line if the file is incomplete."""
    return one_after_another(text, _component)


def _component(lines: list[str], first_line: int) -> tuple[Recording, int]:
    """Return the component whose title is ``lines[first_line]``, and the index of the line after it.

    The header has the time of the recorder's first sample: year and month end its first line of integers, day and hour the
    second, minute and ms the fourth. Corrected data begin some seconds of padding earlier.
    """
    fields = read_header(lines, first_line, _TEXT)
    integers = [int(n) for n in fixed_numbers(lines, first_line + _INTEGERS, 40, _WIDTH, _PER_LINE)[0]]
    reals, _ = fixed_numbers(lines, first_line + _REALS + 2, 10, _WIDTH, _PER_LINE)
    npts, dt = int(fields["npts"]), float(reals[5])
    counts = integers[33:36]
    if npts < 1 or counts[0] != npts or min(counts) < 0:
        raise InputError(
            f"line {first_line + 10} says {npts} points, line {first_line + _INTEGERS + 4} {counts} accelerations, velocities "
            "and displacements; expected the same number above 0"
        )
    if not dt > 0:
        raise InputError(f"line {first_line + _REALS + 3} says an interval of {dt:g} s; expected a number above 0")
    factor, unit = 1.0, fields["of_peak"]
    if fields["un"]:
        raw = read_header(lines, first_line, _OF_RAW)
        factor, unit = number_in(raw["factor"], first_line + 10), raw["unit"]
    blocks, end = [], first_line + _DATA
    for n in counts:
        block, end = fixed_numbers(lines, end, n, _WIDTH, _PER_LINE)
        blocks.append(block)
    year, month, day, hour, minute, ms = (integers[i] for i in (8, 9, 18, 19, 38, 39))
    start, site = moment(year, month, day, hour, minute, ms / 1000), fields["site"]
    recording = Recording(
        label=fields["label"],
        dt=dt,
        values=blocks[0] * factor,
        unit=unit,
        station=f"{site} {fields['id']}, {'uncorrected' if fields['un'] else 'corrected'}",
        start=None if start is None else start - float(reals[1]),
        processed=not fields["un"],
        sensor=Sensor(site, "NZ", fields["id"].rpartition("_")[2][:2]),
        event=fields["id"],
        origin=origin_of(line_at(lines, first_line + 6), lines[first_line + 2] or site, line_at(lines, first_line + 7)),
        velocities=(blocks[1], fields["velocity"]) if fields["velocity"] and len(blocks[1]) else None,
        displacements=(blocks[2], fields["displacement"]) if fields["displacement"] and len(blocks[2]) else None,
        stated=(
            Stated("duration", fields["duration"]),
            Stated("peak", fields["peak"], fields["of_peak"]),
            Stated("time of the peak", fields["at"], begins=-float(reals[1])),  # from the recorder's first sample
        ),
        header={"accelerogram": fields["id"], "site": lines[first_line + 2].strip()},
    )
    return recording, end


is_geonet_file, read_geonet_stream = plugin("GEONET", is_geonet, parse)
