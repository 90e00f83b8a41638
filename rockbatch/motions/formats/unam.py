"""Standard acceleration files of Mexico (UNAM, RA-UAM, CICESE; "Archivo estandar de aceleracion", version 2.0).

A hundred lines of Spanish text, in parts between lines of signs; values of up to six channels stand between slashes
("/N00E;/N90E;/V;+"). Then the accelerations of all channels, a line for each sample, in the Fortran format that the header
declares (3F10.4, 3E16.7), or between blanks. One or two lines more than declared occur in UNAM's own files. The layout is
that of the institutes' own files, whose names may end in a number (CANA1709.191). Blanks in keys and the spelling of dates
differ from institute to institute.
"""

import re

import numpy as np

from rockbatch.errors import InputError
from rockbatch.motions.component import Component, Seat
from rockbatch.motions.formats.fixed_width import lines_of, number_in
from rockbatch.motions.formats.header_lines import date_in, keys_of, line_with, moment
from rockbatch.motions.formats.obspy_plugin import plugin
from rockbatch.motions.formats.record_file import RecordFile
from rockbatch.motions.formats.recording import Recording, to_components
from rockbatch.motions.motion import Samples, Unusable
from rockbatch.motions.orientation import Orientation
from rockbatch.motions.origin import origin_of

SUFFIXES: frozenset[str] = frozenset()

_MOST = 200  # lines of header
_MOST_CHANNELS = 6
_MOST_MORE = 2  # lines beyond the declared ones
_TITLE = b"ARCHIVO ESTANDAR DE ACELERACION"
_DATA = re.compile(r"^\s*DATOS DE ACELERACION")
_BEHIND = 10  # lines after that one, within which the first sample stands
_FORMAT = re.compile(r"\(?(?P<per_line>[0-9]{1,2})[FEDG](?P<width>[0-9]{1,2})\.[0-9]{1,2}\)?", re.IGNORECASE)
_CLOCK = re.compile(r"(\d{1,2}):(\d{1,2}):(\d{1,2}(?:[.,]\d{1,6})?)", re.ASCII)
_DAY = 86400.0  # s


def is_unam(head: bytes) -> bool:
    """Whether the first bytes are the header of such a file."""
    return _TITLE in head[:1000]


def read_unam(file: RecordFile) -> list[Component | Unusable]:
    """Return the channels of a file in m/s², without their offsets."""
    return to_components(file, _parse(file.text))


def _parse(text: str) -> list[Recording]:
    """Return the channels; ``InputError`` with the line, or the key, where the file is not whole."""
    lines = lines_of(text)
    at, _ = line_with(_DATA, lines, _MOST, "DATOS DE ACELERACION:")
    header = {re.sub(r"\s", "", key): value for key, value in keys_of(lines[:at]).items()}
    channels = _single(header, "NUMERO DE CANALES")
    if not 1 <= channels <= _MOST_CHANNELS or channels != int(channels):
        raise InputError(f"the header says NUMERO DE CANALES : {channels:g}; expected 1 to {_MOST_CHANNELS}")
    if _get(header, "FACTOR DE DECIMACION") and _single(header, "FACTOR DE DECIMACION") != 1:
        raise InputError("the header says that samples were left out (FACTOR DE DECIMACION); expected 1")
    count = int(channels)
    ways = [way.partition(";")[::2] for way in _each(header, "ORIENTACION C1-C6", count)]
    npts, dt = (_same(header, key, count) for key in ("NUM. TOTAL DE MUESTRAS, C1-C6", "INTERVALO DE MUESTREO, C1-C6"))
    if npts != int(npts) or npts < 2 or not 0 < dt < 10:
        raise InputError(f"the header says {npts:g} samples every {dt:g} s; expected a whole number and an interval")
    first = _first(lines, at, [way.strip() for way, _ in ways])
    values, more = _values(lines, first, int(npts), count, _value(header, "FORMATO DATOS"))
    unit = _value(header, "UNIDADES DE LOS DATOS").partition("(")[0].strip()
    stated = _get(header, "ACEL. MAX.(Gal), C1-C6").strip("/ ").split("/")
    peaks = stated if len(stated) == count else [""] * count
    station, date = _value(header, "CLAVE DE LA ESTACION"), _get(header, "FECHA DEL SISMO")
    name, start = _get(header, "NOMBRE DE LA ESTACION"), _start(header)
    event = f"{date} {_get(header, 'HORA EPICENTRO')}".strip()
    notes = (f"its header says {npts:.0f} samples, and {more} more follow, which are left out",) if more else ()
    return [
        Recording(
            label=way.strip(),
            orientation=Orientation(way.strip(), vertical=True, down=True) if (way[:1], sign) == ("V", "-") else None,
            dt=dt,
            values=values[:, i],
            unit=unit,
            station=f"{station}, {event} {start}" if event else station,
            codes=("MG", station[:5], "", way.strip().upper()),
            start=start,
            uncorrected=True,
            processed=False,
            seat=Seat(station),
            event=event,
            origin=origin_of("", name or station, date),
            stated_peak=(peaks[i], "gal"),
            notes=notes,
            header={"station": name, "file": _get(header, "NOMBRE DEL ARCHIVO")},
        )
        for i, (way, sign) in enumerate(ways)
    ]


def _get(header: dict[str, str], key: str) -> str:
    """Return the value of the key that begins so (what stands behind differs: "(s)", "(Hz)"); empty if there is none."""
    begins = re.sub(r"\s", "", key)
    return next((value for name, value in header.items() if name.startswith(begins)), "")


def _value(header: dict[str, str], key: str) -> str:
    """Return the value of a key; ``InputError`` where it has none."""
    value = _get(header, key)
    if not value:
        raise InputError(f"the header lacks {key}")
    return value


def _each(header: dict[str, str], key: str, count: int) -> list[str]:
    """Return the values of all channels, between slashes."""
    values = [part.strip() for part in _value(header, key).strip("/ ").split("/")]
    if len(values) != count:
        raise InputError(f"the header says {count} channels, but {key} : {_value(header, key)[:60]}")
    return values


def _single(header: dict[str, str], key: str) -> float:
    text = _value(header, key)
    try:
        return number_in(text, 0)
    except InputError:
        raise InputError(f'the header says {key} : "{text[:40]}"; expected a number') from None


def _same(header: dict[str, str], key: str, count: int) -> float:
    """Return the number that is the same for all channels; ``InputError`` where it is not."""
    texts = set(_each(header, key, count))
    if len(texts) > 1:
        raise InputError(f"the header says {key} : {', '.join(sorted(texts))[:60]}; expected the same for all channels")
    return _single({re.sub(r"\s", "", key): texts.pop()}, key)


def _first(lines: list[str], at: int, ways: list[str]) -> int:
    """Return the index of the first sample's line, behind rulers and the directions, which must be those of the header."""
    named = False
    for i in range(at + 1, min(at + _BEHIND, len(lines))):
        words = [word.partition(";")[0] for word in lines[i].split()]
        if words == ways:
            named = True
        elif named and words and lines[i].strip("-+= "):
            return i
    raise InputError(f"line {at + 4}: expected the directions {' '.join(ways)}, as the header has them, and samples")


def _values(lines: list[str], first: int, npts: int, channels: int, layout: str) -> tuple[Samples, int]:
    """Return the samples, shape (npts, channels), and how many lines follow them: two at most."""
    form = _FORMAT.fullmatch(layout.replace(" ", ""))
    if form is None or int(form["per_line"]) != channels or int(form["width"]) < 2:
        raise InputError(f'the header says FORMATO DATOS : "{layout[:20]}"; expected one such as {channels}F10.4')
    width = int(form["width"])
    rows = [i for i in range(first, len(lines)) if lines[i].strip()]
    if len(rows) < npts:
        raise InputError(
            f"{npts} samples from line {first + 1} on, but the file ends with line {len(lines)}: it is cut; fetch it again"
        )
    if len(rows) > npts + _MOST_MORE:
        at = rows[npts]
        raise InputError(f'line {at + 1}: found "{lines[at][:40]}" after the {npts} declared samples')
    values = [_row(lines[i].rstrip(), i, width, channels) for i in rows]
    return np.array(values[:npts]), len(rows) - npts


def _row(line: str, at: int, width: int, channels: int) -> list[float]:
    """Return the numbers of a line, in columns of the declared width, or else between blanks."""
    in_columns = len(line) == width * channels
    fields = [line[k : k + width] for k in range(0, len(line), width)] if in_columns else line.split()
    if len(fields) != channels:
        raise InputError(f'line {at + 1}: found "{line[:40]}"; expected {channels} values of {width} characters each')
    return [number_in(field, at) for field in fields]


def _start(header: dict[str, str]) -> float | None:
    """Return the time of the first sample [s since 1970]: its date is that of the earthquake, or the day before or after."""
    date = date_in(_get(header, "FECHA DEL SISMO"))
    origin, first = (_CLOCK.match(_get(header, key)) for key in ("HORA EPICENTRO", "HORA DE LA PRIMERA MUESTRA"))
    if date is None or first is None:
        return None
    began, quake = (
        moment(*date, int(clock[1]), int(clock[2]), float(clock[3].replace(",", ".")))
        for clock in (first, origin or first)
    )
    if began is None or quake is None:
        return None
    return began + _DAY * round((quake - began) / _DAY)


is_unam_file, read_unam_stream = plugin("UNAM", is_unam, _parse)
