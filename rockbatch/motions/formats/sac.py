"""SAC (binary): one component, in a unit that its header does not state reliably.

A header of 70 floats and 40 integers of four bytes and 24 words of eight letters, in either byte order, then the samples as
floats. Words whose value is -12345 are undefined. Source: SAC's manual, "SAC data file format".
"""

import math
from dataclasses import replace
from datetime import UTC, datetime

import numpy as np

from rockbatch.common.errors import InputError, NoUnit, Truncated
from rockbatch.common.showing import shown
from rockbatch.common.units import acceleration_factor
from rockbatch.motions.component import FIRST_YEAR, Component, Sensor
from rockbatch.motions.formats.header_lines import moment
from rockbatch.motions.formats.stated import Sampled, Stated, contradictions
from rockbatch.motions.labels.evidence import Kind, Statement, angles_statement, decided_orientation
from rockbatch.motions.labels.orientation import is_clock, not_acceleration, orientation_of
from rockbatch.motions.labels.origin import origin_of
from rockbatch.motions.motion import Samples
from rockbatch.motions.quality.places import depth_as_place
from rockbatch.motions.sources.record_file import RecordFile, no_acceleration
from rockbatch.motions.unused import Unusable

_DAY = 86400.0  # s
_STALE = (1.0, 1.0)  # limits for DEPMIN and DEPMAX, which some programs do not update: a factor of 2
_KINDS = {6: "displacements (IDEP 6)", 7: "velocities (IDEP 7)"}
_HEADER, _FLOATS, _INTEGERS, _TEXTS = 632, 70, 40, 24  # bytes; words
_VERSION_AT = 76 * 4  # bytes: NVHDR, 6 or 7
_UNDEFINED = -12345
_NUMBERS = {  # index of the word, least and largest value; floats come first
    "DELTA": (0, 1e-5, 1.0),
    "DEPMIN": (1, -math.inf, math.inf),
    "DEPMAX": (2, -math.inf, math.inf),
    "B": (5, -1e10, 1e10),  # some count from 1970
    "E": (6, -1e10, 1e10),
    "STDP": (34, -math.inf, math.inf),
    "CMPAZ": (57, -360.0, 720.0),
    "CMPINC": (58, -180.0, 180.0),
    "NZYEAR": (70, 1900, 2100),
    "NZJDAY": (71, 1, 366),
    "NZHOUR": (72, 0, 24),
    "NZMIN": (73, 0, 60),
    "NZSEC": (74, 0, 61),
    "NZMSEC": (75, 0, 1000),
    "NVHDR": (76, 6, 7),
    "NPTS": (79, 1, 2**28),
    "IFTYPE": (85, 1, 1),  # a time series; spectra and tables have other numbers
    "IDEP": (86, -(2**31), 2**31),
    "LEVEN": (105, 1, 1),  # samples at even times
}
_NEEDED = ("DELTA", "NPTS", "NVHDR")
_NAMES = {"KSTNM": (0, 1), "KEVNM": (1, 3), "KHOLE": (3, 4), "KCMPNM": (20, 21), "KNETWK": (21, 22)}  # texts


def is_sac(head: bytes) -> bool:
    """Return whether the first bytes are a binary SAC header, in either byte order."""
    return _byte_order(head) is not None


def _byte_order(data: bytes) -> str | None:
    """Return the byte order, "<" or ">", in which the header's version is 6 or 7; None if none, or if the data are short."""
    whole = len(data) >= _VERSION_AT + 4
    return next(
        (order for order in "<>" if whole and np.frombuffer(data, f"{order}i4", 1, _VERSION_AT)[0] in (6, 7)), None
    )


def read_sac(file: RecordFile) -> list[Component | Unusable]:
    """Return the component in a list, in the study's unit: data / sensitivity × unit; raise ``Unstated`` if it states neither.

    SAC's entry for the kind of data (IDEP) is no statement of the unit: files in g that claim nm/s² are common. Velocities and
    displacements are refused by it, and by the channel of a seismometer, unless a manifest states the file's unit.
    """
    options = file.options
    numbers, names, samples = _parsed(file.data)
    station, location, channel, network = (names[name] for name in ("KSTNM", "KHOLE", "KCMPNM", "KNETWK"))
    if is_clock(channel):
        return [Unusable(file.stem, (file.source,), "the recorder's clock, no ground motion", channel)]
    kind = _KINDS.get(int(numbers.get("IDEP", 0))) or not_acceleration(channel)
    if kind and "unit" not in options.instead:
        raise no_acceleration("its header says that it", kind)
    if options.unit is None and options.sensitivity is None:
        raise NoUnit(
            "SAC files do not state their unit reliably (sensitivity = … for counts per m/s² is a statement of it, too)"
        )
    start, day = _start(numbers)
    statements = _directions(channel, numbers)
    unit = options.unit or "m/s2"
    factor = acceleration_factor(unit, file.gravity) / (options.sensitivity or 1.0)
    dt = float(str(np.float32(numbers["DELTA"])))  # the shortest decimal with this float of four bytes: 0.01
    sampled = Sampled(samples, dt, unit if options.sensitivity is None else "counts", factor, samples)
    findings, differences = contradictions(_statements(numbers), sampled, file.gravity)
    return [
        Component(
            name=file.stem,
            dt=dt,
            acceleration=samples * factor,
            orientation=decided_orientation(statements, channel),
            statements=statements,
            station=".".join((network, station, location, channel[:-1])) if station else "",
            sources=(file.source,),
            start=start,
            sensor=Sensor(
                station if start >= FIRST_YEAR else "", network, location, depth_as_place(numbers.get("STDP"))
            ),
            unit=unit,
            raw=True,
            origin=origin_of(names["KEVNM"], f"{network}.{station}".strip("."), day),
            notes=(f"unit {unit} as stated", *differences),
            findings=findings,
        )
    ]


def _parsed(data: bytes) -> tuple[dict[str, float], dict[str, str], Samples]:
    """Return the header's defined numbers and its texts ("" if undefined) by name, and the samples, shape (npts,)."""
    if len(data) < _HEADER:
        raise Truncated(f"holds {len(data)} bytes; a SAC header alone has {_HEADER}: the file is cut")
    order = _byte_order(data)
    words = (*np.frombuffer(data, f"{order}f4", _FLOATS), *np.frombuffer(data, f"{order}i4", _INTEGERS, 4 * _FLOATS))
    numbers = {}
    for name, (word, least, largest) in _NUMBERS.items():
        value = float(words[word])
        if value == _UNDEFINED and name not in _NEEDED:
            continue
        if not least <= float(f"{value:.7g}") <= largest:
            raise InputError(f"SAC header: {name} = {value:g}; expected {least:g} to {largest:g}: it is damaged")
        numbers[name] = value
    npts = int(numbers["NPTS"])
    if len(data) != _HEADER + 4 * npts:
        raise Truncated(
            f"holds {(len(data) - _HEADER) / 4:.10g} samples behind its header, which says {npts}: the file is cut, or damaged"
        )
    text = data[4 * (_FLOATS + _INTEGERS) : _HEADER].decode("latin-1")
    names = {name: text[8 * first : 8 * end].partition("\0")[0].strip() for name, (first, end) in _NAMES.items()}
    names = {name: "" if value.startswith(str(_UNDEFINED)) else value for name, value in names.items()}
    return numbers, names, np.frombuffer(data, f"{order}f4", npts, _HEADER).astype(float)


def _statements(numbers: dict[str, float]) -> list[Stated]:
    """Return the header's statements about its samples: the duration from B to E, and the range from DEPMIN to DEPMAX."""
    statements = []
    if "B" in numbers and "E" in numbers:
        begins, ends = numbers["B"], numbers["E"]
        rounded = float(np.spacing(np.float32(begins)) + np.spacing(np.float32(ends)))  # of floats of four bytes
        statements.append(Stated("duration", f"{ends - begins:.6g}", within=abs(rounded)))
    if "DEPMIN" in numbers and "DEPMAX" in numbers and numbers["DEPMAX"] > numbers["DEPMIN"]:
        statements.append(Stated("range", f"{numbers['DEPMAX'] - numbers['DEPMIN']:.6g}", limits=_STALE))
    return statements


def _start(numbers: dict[str, float]) -> tuple[float, str]:
    """Return the time of the first sample [s since 1970] and its day "2016-02-14"; B and "" without a date."""
    begins = numbers.get("B", 0.0)
    try:
        year, day, hour, minute, second, ms = (
            numbers[f"NZ{part}"] for part in ("YEAR", "JDAY", "HOUR", "MIN", "SEC", "MSEC")
        )
    except KeyError:
        return begins, ""
    midnight = moment(int(year), 1, 1, int(hour), int(minute), second)
    if midnight is None:
        return begins, ""
    start = midnight + _DAY * (day - 1) + (ms / 1000 + begins)
    return start, datetime.fromtimestamp(start, UTC).strftime("%Y-%m-%d") if start >= FIRST_YEAR else ""


def _directions(channel: str, numbers: dict[str, float]) -> tuple[Statement, ...]:
    """Return the statements of direction: the channel, and CMPAZ (from north) with CMPINC (from upward vertical) [degrees].

    If both angles are 0°, the component is upward, or its program did not set them, so the statement is a default. Inclined
    components have no statement by angles.
    """
    code = orientation_of(channel)
    by_code = (Statement(Kind.CODE, f"channel {shown(channel)}", code),) if code else ()
    azimuth, inclination = numbers.get("CMPAZ"), numbers.get("CMPINC")
    words = ", ".join(f"{name} {numbers[name]:g}" for name in ("CMPAZ", "CMPINC") if name in numbers)
    try:
        angles = angles_statement(channel, words, azimuth, None if inclination is None else inclination - 90.0)
    except ValueError:
        return by_code
    if angles is None:
        return by_code
    unset = azimuth in (None, 0.0) and inclination in (None, 0.0)
    return (*by_code, replace(angles, default=angles.default or unset))
