"""USC files (University of Southern California, Los Angeles network), digitised from film; Volume II is corrected.

Each channel of Volume I has 13 lines of text, 7 of integers and 7 of real numbers, then pairs of time and value, five to a
line of a blank and ten columns of 7 characters. Volume II has a title before these 13 lines, 11 on what was done after them,
7 of integers and 13 of real numbers, then accelerations, velocities and displacements on even steps. The layouts are those of
the network's own files.
"""

import re
from typing import Any

from rockbatch.common.errors import InputError
from rockbatch.motions.component import Sensor
from rockbatch.motions.formats.declared_series import declared_series
from rockbatch.motions.formats.fixed_width import fixed_numbers, number_in, one_after_another
from rockbatch.motions.formats.header_lines import layout, line_at, read_header
from rockbatch.motions.formats.obspy_plugin import plugin
from rockbatch.motions.formats.recording import Recording
from rockbatch.motions.formats.time_steps import from_pairs
from rockbatch.motions.motion import Samples
from rockbatch.motions.origin import origin_of

_HEADER = {1: 27, 2: 45}  # lines, by volume
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
_AGAIN = layout(  # what Volume II says of its own series
    (15, r"^ *(?P<npts>[0-9]{1,9}) +INSTRUMENT AND BASELINE CORRECTED", "… INSTRUMENT AND BASELINE CORRECTED DATA"),
    (16, r"INTERVALS OF +(?P<dt>[0-9.]{1,12}) *SEC", "AT EQUALLY-SPACED INTERVALS OF … SEC."),
    (
        17,
        r"PEAK ACCELERATION *= *[-+]?(?P<peak>[0-9]*\.[0-9]+) +(?P<unit>CMS?/SEC/SEC)",
        "PEAK ACCELERATION = … CMS/SEC/SEC",
    ),
)


def is_usc(head: bytes) -> bool:
    """Return whether the first bytes are the header of a file of either volume."""
    title = head[:100].decode("latin-1")
    return _TITLE.search(title) is not None or (_CORRECTED.search(title) is not None and b"STATION USC#" in head[:800])


def parse(text: str) -> list[Recording]:
    """Return the channels, one after the other, on even steps; ``InputError`` with the line where the file is not whole."""
    return one_after_another(text, _channel)


def _channel(lines: list[str], start: int) -> tuple[Recording, int]:
    """Return the channel whose title is ``lines[start]``, and where the next one begins."""
    corrected = _CORRECTED.search(line_at(lines, start)) is not None
    header = start + corrected
    fields = read_header(lines, header, _TEXT)
    series, end = (_corrected if corrected else _uncorrected)(lines, start, fields)
    event, date, name = (line_at(lines, header + i)[:70].strip() for i in (1, 2, 5))
    recording = Recording(
        label=fields["label"],
        station=", ".join([fields["station"], event, date, *(["Volume II"] if corrected else [])]),
        codes=("LA", fields["station"][:5], "", fields["label"].upper()),
        processed=corrected,
        sensor=Sensor(fields["station"]),
        event=f"{event}, {date}",
        origin=origin_of(event, name, date),
        header={"station": name, "event": event},
        **series,
    )
    return recording, end + line_at(lines, end).startswith("/&")


def _uncorrected(lines: list[str], start: int, fields: dict[str, str]) -> tuple[dict[str, Any], int]:
    """Return the samples of a channel of Volume I as fields of its recording, and where they end."""
    npts, duration = int(fields["npts"]), number_in(fields["duration"], start + 10)
    if npts < 2:
        raise InputError(f"line {start + 11}: found {npts} points; expected at least two")
    pairs, end = _pairs(lines, start + _HEADER[1], npts)
    if abs(pairs[-1, 0] - duration) > _LATE:
        raise InputError(f"line {start + 11} says {duration:g} s, but the last time is {pairs[-1, 0]:g} s")
    dt, values, notes = from_pairs(pairs, f"channel {fields['label']} from line {start + 1} on")
    return {"dt": dt, "values": values, "unit": fields["unit"], "notes": notes}, end


def _corrected(lines: list[str], start: int, _fields: dict[str, str]) -> tuple[dict[str, Any], int]:
    """Return likewise those of Volume II, which its text has to agree with."""
    repeated = read_header(lines, start, _AGAIN)
    dt, series, end = declared_series(lines, start + _HEADER[2])
    values, unit = series["acc"]
    if int(repeated["npts"]) != len(values) or abs(number_in(repeated["dt"], start + 16) - dt) > 1e-6 * dt:
        raise InputError(
            f"lines {start + 16} and {start + 17} say {repeated['npts']} points at {repeated['dt']} s, "
            f"but line {start + _HEADER[2] + 1} {len(values)} at {dt:g} s"
        )
    velocities, displacements = series.get("vel"), series.get("dis")
    peak = (repeated["peak"], repeated["unit"].replace("CMS", "CM"))
    fields = {"velocities": velocities, "displacements": displacements, "stated_peak": peak}
    return {"dt": dt, "values": values, "unit": unit} | fields, end


def _pairs(lines: list[str], first: int, npts: int) -> tuple[Samples, int]:
    """Return times [s] and values, shape (npts, 2), and where the next channel begins: some files have a line in between."""
    end = first - -2 * npts // _PER_LINE
    indented = next((i for i in range(first, min(end, len(lines))) if not lines[i].startswith(" ")), None)
    if indented is not None:
        raise InputError(f'line {indented + 1}: found "{lines[indented][:40]}"; expected a blank and ten columns')
    numbers, end = fixed_numbers(
        [""] * first + [line[1:] for line in lines[first:end]], first, 2 * npts, _WIDTH, _PER_LINE
    )
    return numbers.reshape(npts, 2), end


is_usc_file, read_usc_stream = plugin("USC", is_usc, parse)
