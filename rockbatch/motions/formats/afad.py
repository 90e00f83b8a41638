"""Text files of Türkiye's network (AFAD, once TR-NSMN): lines of ``KEY : value``, then the columns N-S, E-W and U-D.

AFAD's database now gives .asc files (``dyna``); these are the earlier .txt. Their unit is stated only beside their peaks, "RAW
PGA VALUES (gal)", with which the columns are compared. The layout is that of the network's own files.
"""

import re

from rockbatch.common.errors import InputError
from rockbatch.motions.component import Sensor
from rockbatch.motions.formats.fixed_width import lines_of, spaced_numbers
from rockbatch.motions.formats.header_lines import count_and_step, keys_of, moment_in
from rockbatch.motions.formats.obspy_plugin import plugin
from rockbatch.motions.formats.recording import Recording
from rockbatch.motions.formats.stated import Stated
from rockbatch.motions.labels.origin import TURKISH, origin_of

_MOST = 40  # lines of header
_TITLE = b"STRONG GROUND MOTION RECORDS OF TURKIYE"
_PEAKS = re.compile(r"PGA VALUES *\((?P<unit>[^)]{1,20})\)", re.IGNORECASE)
_PEAK = re.compile(r"\((?P<label>[NEU]-[SWD])\) *(?P<peak>[-+]?[0-9.]{1,15})")


def is_afad(head: bytes) -> bool:
    """Return whether the first bytes are those of a text file of AFAD, by its title."""
    return head.lstrip().startswith(_TITLE)


def parse(text: str) -> list[Recording]:
    """Return the components N-S, E-W and U-D; raise ``InputError`` if the file is incomplete, or does not state its unit."""
    lines = lines_of(text)
    heads = next((i for i in range(min(_MOST, len(lines))) if _labels(lines[i])), None)
    if heads is None:
        raise InputError(f'no line of column names in the first {_MOST} lines; expected "N-S  E-W  U-D"')
    header = {key: value.translate(TURKISH) for key, value in keys_of(lines[:heads]).items()}
    labels = _labels(lines[heads])
    npts, dt = count_and_step(header, "NUMBER OF DATA", "SAMPLING INTERVAL (sec)")
    values = spaced_numbers(lines, heads + 1, npts * len(labels), len(labels)).reshape(-1, len(labels))
    key = next((key for key in header if _PEAKS.search(key)), "")
    fields, peaks = _PEAKS.search(key), {match["label"]: match["peak"] for match in _PEAK.finditer(header.get(key, ""))}
    if fields is None or set(peaks) != set(labels):
        raise InputError('the header lacks "RAW PGA VALUES (gal) : (N-S) … (E-W) … (U-D) …", which states the unit')
    station, began = header.get("STATION ID", ""), header.get("RECORD TIME", "")
    place, event = header.get("PLACE", ""), header.get("EARTHQUAKE DATE", "")
    recordings = []
    for i, label in enumerate(labels):
        recording = Recording(
            label=label.replace("-", ""),
            dt=dt,
            values=values[:, i],
            unit=fields["unit"],
            station=f"{station}, {began}" if station else "",
            start=moment_in(began),
            processed=False,
            sensor=Sensor(station, "TK"),
            event=event,
            origin=origin_of(date=event, station=place or station),
            stated=(Stated("peak", peaks[label], fields["unit"]),),
            header={"station": place, "event": event},
        )
        recordings.append(recording)
    return recordings


def _labels(line: str) -> list[str]:
    """Return the names of the columns in a line; [] for any other line."""
    names = line.split()
    return names if sorted(names) == ["E-W", "N-S", "U-D"] else []


is_afad_file, read_afad_stream = plugin("AFAD", is_afad, parse)
