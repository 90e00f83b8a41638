"""GeoNet strong-motion files (New Zealand): uncorrected V1A and corrected V2A, three components in a file.

Each component has 16 lines of text, 4 of integers and 6 of real numbers, then its accelerations, in V2A also
its velocities and displacements, ten to a line of 8 characters each. The layout is that of GeoNet's own files.
"""

import re

from rockbatch.errors import InputError
from rockbatch.motions.component import Component, Seat
from rockbatch.motions.formats.fixed_width import fixed_numbers, one_after_another
from rockbatch.motions.formats.header_lines import found, line_at, moment, number
from rockbatch.motions.formats.obspy_plugin import plugin
from rockbatch.motions.formats.record_file import RecordFile
from rockbatch.motions.formats.recording import Recording, Series, to_components
from rockbatch.motions.motion import Samples, Unusable
from rockbatch.motions.origin import origin_of

SUFFIXES = frozenset({".v1a", ".v2a"})

_WIDTH, _PER_LINE = 8, 10
_INTEGERS, _REALS, _DATA = 16, 20, 26  # lines of a component's header at which these begin
_TITLE = re.compile(r"(?P<un>un)?corrected accelerogram\s+(?P<id>\S+)", re.IGNORECASE)
_COUNT = re.compile(
    r"number of points\s+(?P<npts>[0-9]{1,9})\s+duration\s+(?P<duration>[0-9.]{1,15})\s*s", re.IGNORECASE
)
_RAW = re.compile(r"raw readings in units of\s+(?P<factor>[0-9.]{1,15})\s+(?P<unit>\S+)", re.IGNORECASE)
_PEAK = re.compile(r"acceleration:\s+peak\s+(?P<peak>[-0-9.]{1,15})\s+(?P<unit>\S+)", re.IGNORECASE)
_UNIT = re.compile(r"(?:velocity|displacement):\s+peak\s+[-0-9.]{1,15}\s+(?P<unit>\S+)", re.IGNORECASE)
_SITE = re.compile(r"site\s+(?P<code>\S+)", re.IGNORECASE)
_COMPONENT = re.compile(r"component\s+(?P<label>\S+)", re.IGNORECASE)


def is_geonet(head: bytes) -> bool:
    """Whether the first bytes are the header of a V1A or V2A file."""
    lines = head.decode("latin-1").splitlines()[:16]
    text = "\n".join(lines[9:12]).lower()
    return (
        len(lines) > 11
        and _TITLE.match(lines[0].strip()) is not None
        and ("raw readings in units of" in text or "instrument corrected data" in text)
    )


def read_geonet(file: RecordFile) -> list[Component | Unusable]:
    """The components of a V1A or V2A file in m/s²; the instrument's zero is still in those of V1A."""
    return to_components(file, _parse(file.text))


def _parse(text: str) -> list[Recording]:
    """The components, one after the other; ``InputError`` with the line where the file is not whole."""
    return one_after_another(text, _component)


def _component(lines: list[str], at: int) -> tuple[Recording, int]:
    """The component whose title is ``lines[at]``, and where the next one begins."""
    title = found(_TITLE, lines, at, "(Un)corrected accelerogram …, after the last declared value")
    count = found(_COUNT, lines, at + 9, "Number of points … Duration … s")
    label = found(_COMPONENT, lines, at + 12, "Component …")["label"]
    peak = found(_PEAK, lines, at + 13, "Acceleration: peak … mm/s/s")
    site = found(_SITE, lines, at + 1, "Site …")["code"]
    integers = fixed_numbers(lines, at + _INTEGERS, 40, _WIDTH, _PER_LINE)
    reals = fixed_numbers(lines, at + _REALS + 2, 10, _WIDTH, _PER_LINE)
    npts, duration, padding, dt = int(count["npts"]), number(count["duration"], at + 9), reals[1], float(reals[5])
    counts = [int(n) for n in integers[33:36]]
    if npts < 1 or counts[0] != npts or min(counts) < 0:
        raise InputError(
            f"line {at + 10} says {npts} points, line {at + _INTEGERS + 4} {counts} accelerations, velocities and "
            "displacements; expected the same number above 0"
        )
    if not dt > 0 or abs(npts * dt - duration) > dt + 0.01:
        raise InputError(
            f"line {at + 10} says {npts} points in {duration:g} s, line {at + _REALS + 3} an interval of {dt:g} s"
        )
    factor, unit = 1.0, peak["unit"]
    if title["un"]:
        raw = found(_RAW, lines, at + 10, "Raw readings in units of 1.00 mm/s/s at intervals of … s")
        factor, unit = number(raw["factor"], at + 10), raw["unit"]
    blocks = []
    end = at + _DATA
    for n in counts:
        blocks.append(fixed_numbers(lines, end, n, _WIDTH, _PER_LINE))
        end += -(-n // _PER_LINE)
    recording = Recording(
        label=label,
        dt=dt,
        values=blocks[0] * factor,
        unit=unit,
        station=f"{site} {title['id']}, {'uncorrected' if title['un'] else 'corrected'}",
        codes=("NZ", site, title["id"].rpartition("_")[2][:2], label.upper()),
        start=_start(integers, float(padding)),
        uncorrected=bool(title["un"]),
        processed=not title["un"],
        seat=Seat(site, "NZ", title["id"].rpartition("_")[2][:2]),
        event=title["id"],
        origin=origin_of(line_at(lines, at + 6), lines[at + 2] or site, line_at(lines, at + 7)),
        velocities=_series(blocks[1], line_at(lines, at + 14)),
        displacements=_series(blocks[2], line_at(lines, at + 15)),
        stated_peak=(peak["peak"], peak["unit"]),
        header={"accelerogram": title["id"], "site": lines[at + 2].strip()},
    )
    return recording, end


def _series(values: Samples, line: str) -> Series | None:
    """Velocities or displacements, with the unit of the header's ``line`` that has their peak."""
    said = _UNIT.match(line.strip())
    return (values, said["unit"]) if said and len(values) else None


def _start(integers: Samples, padding: float) -> float | None:
    """Time of the first sample [s since 1970]; ``None`` where the clock was not set.

    The header has the time of the recorder's first sample, the year to the hour at the end of its first two
    lines of integers, minute and ms at the end of the fourth. Corrected data begin ``padding`` s earlier.
    """
    year, month, day, hour, minute, ms = (int(integers[i]) for i in (8, 9, 18, 19, 38, 39))
    start = moment(year, month, day, hour, minute, ms / 1000)
    return None if start is None else start - padding


is_geonet_file, read_geonet_stream = plugin("GEONET", is_geonet, _parse)
