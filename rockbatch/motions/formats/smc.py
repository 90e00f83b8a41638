"""USGS SMC files: one component, corrected or not, in cm/s².

Eleven lines of text, six of integers (8I10) and ten of real numbers (5E15.7), comments counted by an integer, then the
values without blanks between them: ``1.5057E+0-2.2223E+0`` (8E10.4, or 5E14.7 if integer 47 is 8). Without a sampling rate
they are pairs of time [s] and value, digitised from film, and are interpolated.
Source: USGS National Strong-Motion Program, "SMC-format data files" (2001).
"""

import re

from rockbatch.common.errors import InputError, NoRecord
from rockbatch.motions.component import Sensor
from rockbatch.motions.formats.fixed_width import fixed_numbers, lines_of, number_in, refuse_more
from rockbatch.motions.formats.header_lines import layout, line_at, moment, read_header
from rockbatch.motions.formats.obspy_plugin import plugin
from rockbatch.motions.formats.recording import Recording, letters, other_direction
from rockbatch.motions.formats.stated import Stated
from rockbatch.motions.formats.time_steps import from_pairs
from rockbatch.motions.labels.origin import origin_of
from rockbatch.motions.motion import Samples

_UNIT = "cm/s2"  # by the format
_INTEGERS, _REALS, _COMMENTS = 11, 17, 27  # lines at which these begin
_TITLE = re.compile(r"^(?:(?P<kind>[0-6]) (?P<what>[A-Z]+(?: [A-Z]+)*)|\*)\s*$")
_KINDS = {"1": "uncorrected", "2": "corrected"}
_EIGHT_INTEGERS = re.compile(r"(?:[- \d]{9}\d){8}\s*", re.ASCII)
_TEXT = layout(
    (0, _TITLE.pattern, "2 CORRECTED ACCELEROGRAM"),
    (5, r"station\s*=\s*(?P<name>.*?)\s*component\s*=\s*(?P<label>\S*)", "station = …, component= …"),
)
_VERTICAL = {0: "Up", 180: "Down"}  # degrees from the upward vertical; 90 is horizontal
_DAY = 86400.0  # s


def is_smc(head: bytes) -> bool:
    """Return whether the first bytes are the header of an SMC file, of any quantity."""
    lines = head.decode("latin-1").splitlines()
    return (
        len(lines) > _INTEGERS
        and _TITLE.match(lines[0].strip()) is not None
        and _EIGHT_INTEGERS.fullmatch(lines[_INTEGERS]) is not None
    )


def parse(text: str) -> list[Recording]:
    """Return the recording in a list; raise ``InputError`` with the line if it is incomplete, or of another quantity."""
    lines = lines_of(text)
    title = read_header(lines, 0, _TEXT[:1])
    if title["kind"] not in _KINDS:
        quantity = line_at(lines, 0).strip()
        raise NoRecord(f'line 1: found "{quantity}"; expected accelerations: take the .smc file that has them')
    fields = read_header(lines, 0, _TEXT)
    integers = [int(value) for value in fixed_numbers(lines, _INTEGERS, 48, 10, 8)[0]]
    unknown, comments, npts = integers[0], integers[15], integers[16]
    name, station_number = fields["name"], integers[29]
    number = str(station_number) if station_number not in (unknown, 0) else name.upper()
    if comments < 0 or npts < 1:
        raise InputError(f"lines 13–14: found {comments} comments and {npts} values; expected counts")
    rate = number_in(real, _REALS) if (real := _real(lines, 2)) else None
    if rate is not None and not 0.1 <= rate <= 1e5:
        raise InputError(f"line 18: found a sampling rate of {rate:g} Hz; expected 0.1 to 100000")
    numbers, end = fixed_numbers(lines, _COMMENTS + comments, npts, *((14, 5) if integers[46] == 8 else (10, 8)))
    refuse_more(lines, end, f"the {npts} values that line 14 declares")
    dt, values, notes = _from_film(numbers, number) if rate is None else (float(f"{1.0 / rate:.12g}"), numbers, ())
    year, day, hour, minute, second, ms = integers[1:7]
    start = None if unknown in (day, ms) else moment(year, 1, 1, hour, minute, second)
    extremes = [(peak, _real(lines, n - 1)) for n in (30, 32) if (peak := _real(lines, n))]
    peak, time_of_peak = max(extremes, key=lambda extreme: abs(number_in(extreme[0], 22)), default=("", ""))
    origin_line = line_at(lines, 3)
    label = _label(integers[12], integers[13], unknown, fields["label"])
    return [
        Recording(
            label=label,
            dt=dt,
            values=values,
            unit=_UNIT,
            station=f"{name} {station_number}, {year}-{day:03d} {hour}:{minute}, {_KINDS[title['kind']]}",
            codes=("", letters(line_at(lines, 2)), "", ""),
            start=None if start is None else start + _DAY * (day - 1) + ms / 1000,
            processed=title["kind"] == "2",
            sensor=Sensor(number, place=name.upper()),
            event="" if unknown in (year, day, hour, minute) else f"{year}-{day:03d} {hour}:{minute}",
            origin=origin_of(origin_line[25:], name, origin_line[:25]),
            stated=(Stated("peak", peak), Stated("time of the peak", time_of_peak)),
            as_read=numbers[1::2] if rate is None else None,
            notes=(*notes, *(["its header flags a problem: read its comments"] if integers[17] == 1 else [])),
            findings=other_direction(label, fields["label"], "in words"),
            header={"station": name, "event": origin_line[25:].strip()},
        )
    ]


def _from_film(values: Samples, number: str) -> tuple[float, Samples, tuple[str, ...]]:
    """Return interval [s], even samples and notes of pairs of time [s] and value, flattened in ``values``."""
    try:
        if len(values) % 2:
            raise InputError(f"no sampling rate, so digitised from film: found {len(values)} numbers; expected pairs")
        return from_pairs(values.reshape(-1, 2), "no sampling rate, so digitised from film")
    except InputError as error:
        raise NoRecord(
            f'{error}; or take the corrected file of this record ("2 CORRECTED ACCELEROGRAM")', station=number
        ) from None


def _real(lines: list[str], n: int) -> str:
    """Return real number ``n`` of the header, counted from 1, as written; "" if it equals the first, the mark for unknown."""
    field = line_at(lines, _REALS + (n - 1) // 5)[15 * ((n - 1) % 5) :][:15].strip()
    return "" if field == line_at(lines, _REALS)[:15].strip() else field


def _label(vertical: int, azimuth: int, unknown: int, text: str) -> str:
    """Return the direction by angles from the vertical and north [degrees]: "Up", "Down" or "90"; else that of the ``text``."""
    if vertical in _VERTICAL:
        return _VERTICAL[vertical]
    if vertical not in (90, unknown):
        raise InputError(f"line 13: inclined, {vertical}° from the vertical; expected 0, 90 or 180")
    return str(azimuth) if vertical == 90 and 0 <= azimuth <= 360 else text


is_smc_file, read_smc_stream = plugin("SMC", is_smc, parse)
