"""DYNA files (.ASC): one component in the format of the ESM, ITACA and AFAD databases (Italy, Europe, Türkiye).

Lines of ``KEY: value`` (64 of them in DYNA 1.2), then one value per line. The keys are those of the format's own
files; empty ones are unknown.
"""

from rockbatch.common.errors import NoRecord
from rockbatch.motions.component import Sensor
from rockbatch.motions.formats.fixed_width import lines_of, spaced_numbers
from rockbatch.motions.formats.header_lines import count_and_step, keys_of, moment_in
from rockbatch.motions.formats.obspy_plugin import plugin
from rockbatch.motions.formats.recording import Recording
from rockbatch.motions.formats.stated import Stated
from rockbatch.motions.labels.origin import TURKISH, origin_of

_MOST_KEYS = 200
_TURKISH = ("TK", "TU", "KO")  # networks whose texts are in Windows-1254


def is_dyna(head: bytes) -> bool:
    """Return whether the first bytes are a DYNA header: they begin with "EVENT_NAME:", and have the key SAMPLING_INTERVAL_S."""
    return head.startswith(b"EVENT_NAME:") and b"SAMPLING_INTERVAL_S:" in head


def parse(text: str) -> list[Recording]:
    """Return the recording in a list; raise ``InputError`` with the missing keys, or the line that is wrong."""
    lines = lines_of(text)
    header = _header(lines)
    if header.get("NETWORK") in _TURKISH:
        header = {key: value.translate(TURKISH) for key, value in header.items()}
    npts, dt = count_and_step(header, "NDATA", "SAMPLING_INTERVAL_S")
    codes = tuple(header.get(key, "") for key in ("NETWORK", "STATION_CODE", "LOCATION"))
    stream = header["STREAM"]
    year = header.get("EVENT_DATE_YYYYMMDD", "")[:4]
    filtered = header.get("PROCESSING") or header.get("LOW_CUT_FREQUENCY_HZ", "")
    event = header.get("EVENT_ID") or header["EVENT_NAME"]
    return [
        Recording(
            label=stream,
            dt=dt,
            values=spaced_numbers(lines, len(header), npts, 1),
            unit=header["UNITS"],
            station=", ".join([".".join((*codes, stream[:-1])), event, header.get("PROCESSING", "")]),
            start=moment_in(header.get("DATE_TIME_FIRST_SAMPLE_YYYYMMDD_HHMMSS", "")),
            raw="NOT REMOVED" in header.get("BASELINE_CORRECTION", "").upper(),
            processed=filtered.upper() != "NONE" if filtered else None,
            sensor=Sensor(codes[1], codes[0], codes[2]),
            event=event,
            origin=origin_of(header["EVENT_NAME"], header.get("STATION_NAME") or codes[1], year),
            stated=(
                Stated("duration", header.get("DURATION_S", "")),
                Stated("peak", header.get("PGA_CM/S^2", ""), "cm/s^2"),
                Stated("time of the peak", header.get("TIME_PGA_S", "")),
            ),
            header={key.lower(): value for key, value in header.items() if value},
        )
    ]


def _header(lines: list[str]) -> dict[str, str]:
    """Return the values by keys of the lines before the first without a colon."""
    end = next((i for i, line in enumerate(lines[:_MOST_KEYS]) if ":" not in line), len(lines))
    header = keys_of(lines[:end], "SAMPLING_INTERVAL_S", "NDATA", "UNITS", "STREAM", once=True)
    kind = header.get("DATA_TYPE", "ACCELERATION")
    if kind.upper() != "ACCELERATION":
        raise NoRecord(f"the header says DATA_TYPE: {kind[:40]}; expected ACCELERATION: take that file of this record")
    return header


is_dyna_file, read_dyna_stream = plugin("DYNA", is_dyna, parse)
