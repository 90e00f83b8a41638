"""Free-field files of Taiwan's CWA (once CWB), as of its TSMIP network: ``#`` header, then time, U, N and E."""

import re

from rockbatch.common.errors import InputError
from rockbatch.motions.component import Sensor
from rockbatch.motions.formats.header_lines import keys_of, moment_in
from rockbatch.motions.formats.obspy_plugin import plugin
from rockbatch.motions.formats.recording import Recording
from rockbatch.motions.formats.stated import Stated
from rockbatch.motions.formats.table import read_table
from rockbatch.motions.formats.time_steps import on_even_steps
from rockbatch.motions.labels.origin import origin_of

_LABEL = re.compile(r"\s*(?P<label>[A-Za-z0-9]{1,8})\(\+\)\s*")
_EXTREMES = re.compile(r"\s*(-?\d{1,6}\.\d{1,6})\s*~\s*(-?\d{1,6}\.\d{1,6})\s*", re.ASCII)
_TAIPEI = 8 * 3600.0  # s ahead of UTC


def is_cwa(head: bytes) -> bool:
    """Return whether the first bytes are the header of a free-field file of CWA, with the keys #StationCode and #DataSequence."""
    return head.lstrip().startswith(b"#") and b"#StationCode:" in head and b"#DataSequence:" in head


def parse(text: str) -> list[Recording]:
    """Return a component per column after time; raise ``InputError`` if the header does not name as many, or other columns."""
    lines, table = read_table(text)
    header = keys_of(lines)
    unit, _, offset = header.get("AmplitudeUnit", "").partition(".")
    labels = _labels(header.get("DataSequence", ""))
    if len(labels) + 1 != table.shape[1]:
        raise InputError(f"found {table.shape[1]} columns; the header says time and {', '.join(labels)}")
    dt, values, notes = on_even_steps(table[:, 0], table[:, 1:])
    station = header.get("StationCode", "")
    local = header.get("StartTime(GMT+08)", "")
    began = local or header.get("StartTime", "")
    start = moment_in(began)
    recordings = []
    for i, label in enumerate(labels):
        recording = Recording(
            label=label,
            dt=dt,
            values=values[:, i],
            unit=unit.strip(),
            station=f"{station}, {began}",
            codes=("TW", station, "", label),
            start=start - _TAIPEI if start is not None and local else start,
            raw="corr" not in offset.lower(),
            processed=False,
            sensor=Sensor(station, "TW"),
            event=began,
            stated=(
                Stated("rate", header.get("SampleRate(Hz)", "")),
                Stated("duration", header.get("RecordLength(sec)", "")),
                Stated("peak", _peak(header.get(f"AmplitudeMAX. {label}", ""))),
            ),
            origin=origin_of(date=began.partition("-")[0], station=station),
            notes=notes,
            header={"start": began, "instrument": header.get("InstrumentKind", "")},
        )
        recordings.append(recording)
    return recordings


def _labels(order: str) -> list[str]:
    """Return the directions of the columns after time, all with positive sign: ["U", "N", "E"] of "Time U(+); N(+); E(+)"."""
    time, _, remainder = order[:200].strip().partition(" ")
    matches = [_LABEL.fullmatch(part) for part in remainder.split(";")]
    if time.lower() != "time" or None in matches:
        raise InputError(f'the header says DataSequence: "{order[:60]}"; expected e.g. "Time U(+); N(+); E(+)"')
    return [match["label"] for match in matches if match]


def _peak(extremes: str) -> str:
    """Return the larger of a column's extremes as written: "4.094~   -4.353" gives "-4.353"; "" for other texts."""
    match = _EXTREMES.fullmatch(extremes)
    return max(match.groups(), key=lambda extreme: abs(float(extreme))) if match else ""


is_cwa_file, read_cwa_stream = plugin("CWA", is_cwa, parse)
