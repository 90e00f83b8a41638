"""Standard acceleration files of Mexico (UNAM, "Archivo estandar de aceleracion", version 2.0): all channels of a record.

A hundred lines of Spanish text, in parts between lines of signs; values of up to six channels stand between slashes
("/N00E/N90E/V"). Then the accelerations, a line for each sample, in the Fortran format that the header declares
(3F10.4). The layout is that of the Instituto de Ingeniería's own files, whose names end in a number (CANA1709.191).
"""

import re

from rockbatch.errors import InputError
from rockbatch.motions.component import Component, Seat
from rockbatch.motions.formats.fixed_width import fixed_numbers, lines_of, number_in
from rockbatch.motions.formats.header_lines import keys_of, line_with, moment
from rockbatch.motions.formats.obspy_plugin import plugin
from rockbatch.motions.formats.record_file import RecordFile
from rockbatch.motions.formats.recording import Recording, to_components
from rockbatch.motions.motion import Samples, Unusable
from rockbatch.motions.origin import origin_of

SUFFIXES: frozenset[str] = frozenset()

_MOST = 200  # lines of header
_MOST_CHANNELS = 6
_TITLE = b"ARCHIVO ESTANDAR DE ACELERACION"
_DATA = re.compile(r"^DATOS DE ACELERACION")
_COLUMNS, _FIRST = 3, 5  # lines after that one: directions of the columns, first sample
_FORMAT = re.compile(r"(?P<per_line>[0-9]{1,2})F(?P<width>[0-9]{1,2})\.[0-9]{1,2}", re.IGNORECASE)
_DATE = re.compile(r"(\d{4})/(\d{1,2})/(\d{1,2})", re.ASCII)
_CLOCK = re.compile(r"(\d{1,2}):(\d{2}):(\d{2}(?:\.\d{1,6})?)", re.ASCII)
_DAY = 86400.0  # s


def is_unam(head: bytes) -> bool:
    """Whether the first bytes are the header of such a file."""
    return _TITLE in head[:1000]


def read_unam(file: RecordFile) -> list[Component | Unusable]:
    """The channels of a file in m/s², without their offsets."""
    return to_components(file, _parse(file.text))


def _parse(text: str) -> list[Recording]:
    """The channels; ``InputError`` with the line, or the key, where the file is not whole."""
    lines = lines_of(text)
    at, _ = line_with(_DATA, lines, _MOST, "DATOS DE ACELERACION:")
    header = keys_of(lines[:at])
    channels = _single(header, "NUMERO DE CANALES")
    if not 1 <= channels <= _MOST_CHANNELS or channels != int(channels):
        raise InputError(f"the header says NUMERO DE CANALES : {channels:g}; expected 1 to {_MOST_CHANNELS}")
    if _single(header, "FACTOR DE DECIMACION") != 1:
        raise InputError("the header says that samples were left out (FACTOR DE DECIMACION); expected 1")
    count = int(channels)
    ways = [way.partition(";")[0].strip() for way in _each(header, "ORIENTACION C1-C6", count)]
    npts, dt = (_same(header, key, count) for key in ("NUM. TOTAL DE MUESTRAS, C1-C6", "INTERVALO DE MUESTREO, C1-C6"))
    if npts != int(npts) or npts < 2 or not 0 < dt < 10:
        raise InputError(f"the header says {npts:g} samples every {dt:g} s; expected a whole number and an interval")
    if len(lines) <= at + _COLUMNS or lines[at + _COLUMNS].split() != ways:
        raise InputError(f"line {at + _COLUMNS + 1}: expected the directions {' '.join(ways)}, as the header has them")
    values = _values(lines, at + _FIRST, int(npts), count, _value(header, "FORMATO DATOS"))
    peaks = [number_in(peak, 0) for peak in _each(header, "ACEL. MAX.(Gal), C1-C6", count)]
    unit = _value(header, "UNIDADES DE LOS DATOS").partition("(")[0].strip()
    station = _value(header, "CLAVE DE LA ESTACION")
    start = _start(header)
    origin = origin_of("", header.get("NOMBRE DE LA ESTACION") or station, header.get("FECHA DEL SISMO [GMT]", ""))
    return [
        Recording(
            label=way,
            dt=dt,
            values=values[:, i],
            unit=unit,
            station=f"{station}, {header.get('FECHA DEL SISMO [GMT]', '')} {start}",
            codes=("MG", station[:5], "", way.upper()),
            start=start,
            uncorrected=True,
            processed=False,
            seat=Seat(station),
            event=f"{header.get('FECHA DEL SISMO [GMT]', '')} {header.get('HORA EPICENTRO (GMT)', '')}",
            origin=origin,
            stated_peak=peaks[i] if unit.lower() == "gal" else None,
            header={"station": header.get("NOMBRE DE LA ESTACION", ""), "file": header.get("NOMBRE DEL ARCHIVO", "")},
        )
        for i, way in enumerate(ways)
    ]


def _value(header: dict[str, str], key: str) -> str:
    """The value of the key that begins so: what stands behind differs ("(s)", "(Hz)")."""
    found = next((value for name, value in header.items() if name.startswith(key)), "")
    if not found:
        raise InputError(f"the header lacks {key}")
    return found


def _each(header: dict[str, str], key: str, count: int) -> list[str]:
    """The values of all channels, between slashes."""
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
    """The number that is the same for all channels; ``InputError`` where it is not."""
    texts = set(_each(header, key, count))
    if len(texts) > 1:
        raise InputError(f"the header says {key} : {', '.join(sorted(texts))[:60]}; expected the same for all channels")
    return _single({key: texts.pop()}, key)


def _values(lines: list[str], first: int, npts: int, channels: int, layout: str) -> Samples:
    """The samples, shape (npts, channels), and nothing after them."""
    form = _FORMAT.fullmatch(layout)
    if form is None or int(form["per_line"]) != channels or int(form["width"]) < 2:
        raise InputError(f'the header says FORMATO DATOS : "{layout[:20]}"; expected one such as {channels}F10.4')
    values = fixed_numbers(lines, first, npts * channels, int(form["width"]), channels)
    after = next((i for i in range(first + npts, len(lines)) if lines[i].strip()), None)
    if after is not None:
        raise InputError(f'line {after + 1}: found "{lines[after][:40]}" after the {npts} declared samples')
    return values.reshape(npts, channels)


def _start(header: dict[str, str]) -> float | None:
    """Time of the first sample [s since 1970]: its date is that of the earthquake, or the day before or after."""
    date = _DATE.match(header.get("FECHA DEL SISMO [GMT]", ""))
    origin, first = (
        _CLOCK.match(header.get(key, "")) for key in ("HORA EPICENTRO (GMT)", "HORA DE LA PRIMERA MUESTRA (GMT)")
    )
    if date is None or origin is None or first is None:
        return None
    year, month, day = (int(date[i]) for i in (1, 2, 3))
    began, quake = (
        moment(year, month, day, int(clock[1]), int(clock[2]), float(clock[3])) for clock in (first, origin)
    )
    if began is None or quake is None:
        return None
    return began + _DAY * round((quake - began) / _DAY)


is_unam_file, read_unam_stream = plugin("UNAM", is_unam, _parse)
