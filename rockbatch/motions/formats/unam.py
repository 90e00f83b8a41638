"""Standard acceleration files of Mexico (UNAM, RA-UAM, CICESE; "Archivo estandar de aceleracion", version 2.0).

A hundred lines of Spanish text, in parts between lines of signs; values of up to six channels stand between slashes
("/N00E;/N90E;/V;+"). Then the accelerations of all channels, a line for each sample, in the Fortran format that the header
declares (3F10.4, 3E16.7), or between blanks. One or two lines more than declared occur in UNAM's own files. The layout is
that of the institutes' own files, whose names may end in a number (CANA1709.191). Blanks in keys and the spelling of dates
differ from institute to institute.
"""

import re

import numpy as np

from rockbatch.common.errors import InputError, Truncated
from rockbatch.motions.component import Sensor
from rockbatch.motions.formats.fixed_width import lines_of, number_in
from rockbatch.motions.formats.header_lines import (
    count_and_step,
    date_in,
    keys_of,
    line_with,
    moment,
    number_of,
    require,
)
from rockbatch.motions.formats.obspy_plugin import plugin
from rockbatch.motions.formats.recording import Recording
from rockbatch.motions.formats.stated import Stated
from rockbatch.motions.labels.orientation import Orientation
from rockbatch.motions.labels.origin import origin_of
from rockbatch.motions.motion import Samples

_MOST = 200  # lines of header
_MOST_CHANNELS = 6
_MOST_MORE = 2  # lines beyond the declared ones
_TITLE = b"ARCHIVO ESTANDAR DE ACELERACION"
_DATA = re.compile(r"^\s*DATOS DE ACELERACION")
_BEHIND = 10  # most lines from that line to the first sample
_FORMAT = re.compile(r"\(?(?P<per_line>[0-9]{1,2})[FEDG](?P<width>[0-9]{1,2})\.[0-9]{1,2}\)?", re.IGNORECASE)
_CLOCK = re.compile(r"(\d{1,2}):(\d{1,2}):(\d{1,2}(?:[.,]\d{1,6})?)", re.ASCII)
_DAY = 86400.0  # s
_COUNT, _STEP, _DECIMATION = "NUM. TOTAL DE MUESTRAS, C1-C6", "INTERVALO DE MUESTREO, C1-C6", "FACTOR DE DECIMACION"
_RATE, _PEAK, _PEAK_SAMPLE = "VEL. DE MUESTREO, C1-C6", "ACEL. MAX.(Gal), C1-C6", "ACEL. MAX., C1-C6, EN LA MUESTRA"
_CHANNELS, _DIRECTIONS, _LAYOUT = "NUMERO DE CANALES", "ORIENTACION C1-C6", "FORMATO DATOS"
_UNIT, _STATION, _NAME, _FILE = (
    "UNIDADES DE LOS DATOS",
    "CLAVE DE LA ESTACION",
    "NOMBRE DE LA ESTACION",
    "NOMBRE DEL ARCHIVO",
)
_DATE, _QUAKE, _BEGAN = "FECHA DEL SISMO", "HORA EPICENTRO", "HORA DE LA PRIMERA MUESTRA"
_NEEDED = (_CHANNELS, _DIRECTIONS, _COUNT, _STEP, _LAYOUT, _UNIT, _STATION)
_OPTIONAL = (_DECIMATION, _RATE, _PEAK, _PEAK_SAMPLE, _DATE, _QUAKE, _BEGAN, _NAME, _FILE)


def is_unam(head: bytes) -> bool:
    """Return whether the first bytes have the title of a file of UNAM, "ARCHIVO ESTANDAR DE ACELERACION"."""
    return _TITLE in head[:1000]


def parse(text: str) -> list[Recording]:
    """Return the channels; raise ``InputError`` with the line or the missing key if the file is incomplete."""
    lines = lines_of(text)
    index, _ = line_with(_DATA, lines, _MOST, "DATOS DE ACELERACION:")
    header = _header(lines[:index])
    channels = number_of(header, _CHANNELS)
    if not 1 <= channels <= _MOST_CHANNELS or channels != int(channels):
        raise InputError(f"the header says {_CHANNELS}: {channels:g}; expected 1 to {_MOST_CHANNELS}")
    if header[_DECIMATION] and number_of(header, _DECIMATION) != 1:
        raise InputError(f"the header says that samples were left out ({_DECIMATION}); expected 1")
    count = int(channels)
    directions = [text.partition(";")[::2] for text in _value_of_each(header, _DIRECTIONS, count)]
    labels = [label.strip() for label, _ in directions]
    npts, dt = count_and_step({key: _common_value(header, key, count) for key in (_COUNT, _STEP)}, _COUNT, _STEP)
    first = _first_sample_line(lines, index, labels)
    values, more = _values(lines, first, npts, count, header[_LAYOUT])
    rates, peaks, peak_samples = (_texts_of(header[key], count) for key in (_RATE, _PEAK, _PEAK_SAMPLE))
    station, date, name = header[_STATION], header[_DATE], header[_NAME]
    start, event = _start(header), f"{date} {header[_QUAKE]}".strip()
    notes = (f"its header says {npts} samples, and {more} more follow, which are left out",) if more else ()
    recordings = []
    for i, label in enumerate(labels):
        down = label[:1] == "V" and directions[i][1] == "-"
        sample = peak_samples[i] if re.fullmatch("[0-9]{1,9}", peak_samples[i]) else None  # counted from 1
        recording = Recording(
            label=label,
            orientation=Orientation(label, vertical=True, down=True) if down else None,
            dt=dt,
            values=values[:, i],
            unit=header[_UNIT].partition("(")[0].strip(),
            station=f"{station}, {event} {start}" if event else station,
            codes=("MG", station[:5], "", label.upper()),
            start=start,
            processed=False,
            sensor=Sensor(station),
            event=event,
            origin=origin_of("", name or station, date),
            stated=(
                Stated("rate", rates[i]),
                Stated("peak", peaks[i], "gal"),
                Stated("time of the peak", f"{(int(sample) - 1) * dt:.6f}" if sample else ""),
            ),
            notes=notes,
            header={"station": name, "file": header[_FILE]},
        )
        recordings.append(recording)
    return recordings


def _header(lines: list[str]) -> dict[str, str]:
    """Return the values of the keys ``_NEEDED`` and ``_OPTIONAL``, "" for missing ones; raise ``InputError`` if a needed one is.

    Keys are compared without blanks and by their beginnings, since institutes add units such as "(s)".
    """
    entries = {re.sub(r"\s", "", key): value for key, value in keys_of(lines).items()}
    header = {}
    for name in (*_NEEDED, *_OPTIONAL):
        begins = re.sub(r"\s", "", name)
        header[name] = next((value for key, value in entries.items() if key.startswith(begins)), "")
    require(header, *_NEEDED)
    return header


def _value_of_each(header: dict[str, str], key: str, count: int) -> list[str]:
    """Return the texts between slashes under ``key``, one per channel; raise ``InputError`` unless there are ``count``."""
    values = [part.strip() for part in header[key].strip("/ ").split("/")]
    if len(values) != count:
        raise InputError(f"the header says {count} channels, but {key}: {header[key][:60]}")
    return values


def _texts_of(text: str, count: int) -> list[str]:
    """Return the texts between slashes, perhaps "", one per channel; ``count`` times "" if there is another number of them."""
    texts = [part.strip() for part in text.strip().removeprefix("/").removesuffix("/").split("/")]
    return texts if len(texts) == count else [""] * count


def _common_value(header: dict[str, str], key: str, count: int) -> str:
    """Return the common value of all channels; raise ``InputError`` if they differ."""
    texts = set(_value_of_each(header, key, count))
    if len(texts) > 1:
        raise InputError(f"the header says {key}: {', '.join(sorted(texts))[:60]}; expected the same for all channels")
    return texts.pop()


def _first_sample_line(lines: list[str], start: int, labels: list[str]) -> int:
    """Return the index of the first sample's line, after rulers and ``labels``; raise ``InputError`` if it is not found."""
    named = False
    for i in range(start + 1, min(start + _BEHIND, len(lines))):
        words = [word.partition(";")[0] for word in lines[i].split()]
        if named and words and lines[i].strip("-+= ") and words != labels:
            return i
        named = named or words == labels
    raise InputError(
        f"line {start + 4}: expected the directions {' '.join(labels)}, as the header has them, and samples"
    )


def _values(lines: list[str], first: int, npts: int, channels: int, layout: str) -> tuple[Samples, int]:
    """Return the samples, shape (npts, channels), and the number of further lines, two at most."""
    form = _FORMAT.fullmatch(layout.replace(" ", ""))
    if form is None or int(form["per_line"]) != channels or int(form["width"]) < 2:
        raise InputError(f'the header says FORMATO DATOS : "{layout[:20]}"; expected one such as {channels}F10.4')
    width = int(form["width"])
    rows = [i for i in range(first, len(lines)) if lines[i].strip()]
    if len(rows) < npts:
        raise Truncated(
            f"{npts} samples from line {first + 1} on, but the file ends with line {len(lines)}: it is cut; fetch it again"
        )
    if len(rows) > npts + _MOST_MORE:
        index = rows[npts]
        raise InputError(f'line {index + 1}: found "{lines[index][:40]}" after the {npts} declared samples')
    values = [_row(lines[i].rstrip(), i, width, channels) for i in rows]
    return np.array(values[:npts]), len(rows) - npts


def _row(line: str, index: int, width: int, channels: int) -> list[float]:
    """Return the numbers of a line, in columns of the declared width, else between blanks; raise ``InputError`` for others."""
    in_columns = len(line) == width * channels
    fields = [line[k : k + width] for k in range(0, len(line), width)] if in_columns else line.split()
    if len(fields) != channels:
        raise InputError(
            f'line {index + 1}: found "{line[:40]}"; expected {channels} values of {width} characters each'
        )
    return [number_in(field, index) for field in fields]


def _start(header: dict[str, str]) -> float | None:
    """Return the time of the first sample [s since 1970]; ``None`` without date or clock.

    Only the earthquake's date is stated: the sample may be of the day before or after.
    """
    date, first = date_in(header[_DATE]), _CLOCK.match(header[_BEGAN])
    if date is None or first is None:
        return None
    began, quake = _moment(date, first), _moment(date, _CLOCK.match(header[_QUAKE]) or first)
    return None if began is None or quake is None else began + _DAY * round((quake - began) / _DAY)


def _moment(date: tuple[int, int, int], clock: re.Match[str]) -> float | None:
    """Return the time [s since 1970] of a clock on a date; ``None`` for an impossible one."""
    return moment(*date, int(clock[1]), int(clock[2]), float(clock[3].replace(",", ".")))


is_unam_file, read_unam_stream = plugin("UNAM", is_unam, parse)
