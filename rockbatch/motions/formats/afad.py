"""Text files of Türkiye's network (AFAD, once TR-NSMN): lines of ``KEY : value``, then the columns N-S, E-W and U-D.

What AFAD's database gives today (.asc) is ``dyna``; these are the .txt of the years before. Their unit stands only
beside their peaks, "RAW PGA VALUES (gal)", which the columns must bear out. The layout is that of the network's own files.
"""

import re

from rockbatch.errors import InputError
from rockbatch.motions.component import Component, Seat
from rockbatch.motions.formats.fixed_width import lines_of, spaced_numbers
from rockbatch.motions.formats.header_lines import keys_of, moment, number_of
from rockbatch.motions.formats.obspy_plugin import plugin
from rockbatch.motions.formats.record_file import RecordFile
from rockbatch.motions.formats.recording import Recording, to_components
from rockbatch.motions.motion import Unusable
from rockbatch.motions.origin import TURKISH, origin_of

SUFFIXES: frozenset[str] = frozenset()

_MOST = 40  # lines of header
_TITLE = b"STRONG GROUND MOTION RECORDS OF TURKIYE"
_PEAKS = re.compile(r"PGA VALUES *\((?P<unit>[^)]{1,20})\)", re.IGNORECASE)
_PEAK = re.compile(r"\((?P<label>[NEU]-[SWD])\) *(?P<peak>[-+]?[0-9.]{1,15})")
_MOMENT = re.compile(r"(\d{2})/(\d{2})/(\d{4}) (\d{2}):(\d{2}):(\d{2}(?:\.\d{1,6})?)", re.ASCII)


def is_afad(head: bytes) -> bool:
    """Whether the first bytes are the header of such a file."""
    return head.removeprefix(b"\xef\xbb\xbf").lstrip().startswith(_TITLE)


def read_afad(file: RecordFile) -> list[Component | Unusable]:
    """The three components of a file in m/s², without their offsets."""
    return to_components(file, _parse(file.text))


def _parse(text: str) -> list[Recording]:
    """The components; ``InputError`` with the line where the file is not whole, or its unit not borne out."""
    lines = lines_of(text)
    heads = next((i for i in range(min(_MOST, len(lines))) if _labels(lines[i])), None)
    if heads is None:
        raise InputError(f'no line of column names in the first {_MOST} lines; expected "N-S  E-W  U-D"')
    header = {key: value.translate(TURKISH) for key, value in keys_of(lines[:heads]).items()}
    labels = _labels(lines[heads])
    npts, dt = number_of(header, "NUMBER OF DATA"), number_of(header, "SAMPLING INTERVAL (sec)")
    if npts != int(npts) or npts < 2 or not 0 < dt < 10:
        raise InputError(f"the header says {npts:g} values every {dt:g} s; expected a whole number and an interval")
    values = spaced_numbers(lines, heads + 1, int(npts) * len(labels), len(labels)).reshape(-1, len(labels))
    peaks = _peaks(header, labels)
    station, began = header.get("STATION ID", ""), header.get("RECORD TIME", "")
    return [
        Recording(
            label=label.replace("-", ""),
            dt=dt,
            values=values[:, i],
            unit=peaks[label][1],
            stated_peak=peaks[label],
            station=f"{station}, {began}" if station else "",
            codes=("TK", station, "", label.replace("-", "")),
            start=_start(began),
            uncorrected=True,
            processed=False,
            seat=Seat(station, "TK"),
            event=header.get("EARTHQUAKE DATE", ""),
            origin=origin_of(date=header.get("EARTHQUAKE DATE", ""), station=header.get("PLACE") or station),
            header={"station": header.get("PLACE", ""), "event": header.get("EARTHQUAKE DATE", "")},
        )
        for i, label in enumerate(labels)
    ]


def _labels(line: str) -> list[str]:
    """The names of the columns; none where the line is another one."""
    names = line.split()
    return names if sorted(names) == ["E-W", "N-S", "U-D"] else []


def _peaks(header: dict[str, str], labels: list[str]) -> dict[str, tuple[str, str]]:
    """Return the header's peaks and their unit, which is that of the columns, too."""
    key = next((key for key in header if _PEAKS.search(key)), "")
    said = _PEAKS.search(key)
    stated = {match["label"]: match["peak"] for match in _PEAK.finditer(header.get(key, ""))}
    if said is None or set(stated) != set(labels):
        raise InputError('the header lacks "RAW PGA VALUES (gal) : (N-S) … (E-W) … (U-D) …", which tells the unit')
    return {label: (stated[label], said["unit"]) for label in labels}


def _start(text: str) -> float | None:
    """Time of the first sample [s since 1970], day first; ``None`` where it is not known."""
    match = _MOMENT.match(text)
    if match is None:
        return None
    day, month, year, hour, minute = (int(match[i]) for i in range(1, 6))
    return moment(year, month, day, hour, minute, float(match[6]))


is_afad_file, read_afad_stream = plugin("AFAD", is_afad, _parse)
