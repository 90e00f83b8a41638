"""Formats of records: choice of the reader of a file by its header, whatever its name.

A format is a module with a check of the first bytes and a parser or reader, and a line in ``FORMATS``. Formats that the header
does not distinguish from all others (SAC, columns of numbers) are recognised by their suffixes, too; ObsPy never guesses the
format (see ``with_obspy``).
"""

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from rockbatch.common.errors import InputError, UnknownFormat, Unstated
from rockbatch.common.showing import shown
from rockbatch.motions.component import Component
from rockbatch.motions.formats import (
    afad,
    asdf,
    at2,
    bhrc,
    columns,
    cosmos,
    csmnc,
    cwa,
    dyna,
    emod3d,
    geonet,
    kinemetrics,
    knet,
    miniseed,
    resorce,
    sac,
    smc,
    unam,
    volumes,
)
from rockbatch.motions.formats.advice import with_advice
from rockbatch.motions.formats.obspy_plugin import HEAD, begin_of
from rockbatch.motions.formats.recording import reader
from rockbatch.motions.labels.evidence import Kind, Statement, decided_orientation
from rockbatch.motions.labels.orientation import Orientation, is_place_or_direction, split_stem
from rockbatch.motions.limits import HUGE, MOST_SAMPLES, STEPS, is_step
from rockbatch.motions.sources.record_file import ReadOptions, RecordFile
from rockbatch.motions.texts import with_legible_texts
from rockbatch.motions.unused import Unusable

_FOREIGN = {  # first bytes of files that hold records, but are not read
    b"MS\x03": "MiniSEED 3: fetch it as MiniSEED 2",
    b"MATLAB 5.0 MAT-file": "a MATLAB file",
    b"GSE2 ": "GSE2",
}
_LOCATION = 2  # characters of a location code
_INSTEAD = "write it as MiniSEED, or as text columns below a line such as # time(s) NS(cm/s2) UD(cm/s2)"


@dataclass(frozen=True)
class Format:
    """A format: its name, its own suffixes in lower case, the check of the first bytes, the reader.

    ``anywhere``: whether the check suffices for files of any name, or only for those with its suffixes. ``counts``: whether
    its numbers may be counts, so that a sensitivity can be stated.
    """

    name: str
    suffixes: tuple[str, ...]
    matches: Callable[[bytes], bool]
    read: Callable[[RecordFile], Sequence[Component | Unusable]]
    anywhere: bool = True
    counts: bool = False


FORMATS = (
    Format("PEER AT2", (".at2", ".txt", ".csv", ".dat", ".bbp", ".acc"), at2.looks_like_at2, at2.read_component),
    Format("MiniSEED", (".mseed", ".ms", ".miniseed"), miniseed.is_miniseed, miniseed.read_miniseed, counts=True),
    Format("Kinemetrics EVT", (".evt",), kinemetrics.is_evt, kinemetrics.read_evt),
    Format("ASDF", (".h5", ".asdf", ".hdf5"), asdf.is_hdf5, asdf.read_asdf, counts=True),
    Format("SAC", (".sac",), sac.is_sac, sac.read_sac, anywhere=False, counts=True),
    Format(
        "K-NET/KiK-net",
        (".ew", ".ns", ".ud", ".ew1", ".ns1", ".ud1", ".ew2", ".ns2", ".ud2"),
        knet.is_knet,
        reader(knet.parse),
    ),
    Format("GeoNet V1A/V2A", (".v1a", ".v2a"), geonet.is_geonet, reader(geonet.parse)),
    Format("DYNA (ESM, ITACA, AFAD)", (".asc",), dyna.is_dyna, reader(dyna.parse)),
    Format(
        "COSMOS", (".v0", ".v1", ".v2", ".v3", ".v0c", ".v1c", ".v2c", ".v3c"), cosmos.is_cosmos, reader(cosmos.parse)
    ),
    Format("CSMIP", (".v1", ".v2", ".v3", ".raw"), volumes.is_csmip, reader(volumes.parse)),
    Format("USGS SMC", (".smc",), smc.is_smc, reader(smc.parse)),
    Format("RENADIC", (".v1", ".raw"), volumes.is_renadic, reader(volumes.parse_pairs)),
    Format("USC", (), volumes.is_usc, reader(volumes.parse)),
    Format("BHRC Volume 1", (), bhrc.is_bhrc, reader(bhrc.parse)),
    Format("CSMNC", (), csmnc.is_csmnc, reader(csmnc.parse)),
    Format("AFAD text", (), afad.is_afad, reader(afad.parse)),
    Format("UNAM", (), unam.is_unam, reader(unam.parse)),
    Format("RESORCE", (), resorce.is_resorce, reader(resorce.parse)),
    Format("CWA free field", (".txt", ".dat", ".acc", ".asc"), cwa.is_cwa, reader(cwa.parse)),
    Format("EMOD3D", (".000", ".090", ".ver"), emod3d.is_emod3d, emod3d.read_emod3d),
    Format("PEER AT2", (".at2",), at2.has_at2_count, at2.read_component, anywhere=False),
    Format("text columns", (".at2", ".g3"), columns.holds_table, columns.read_columns, anywhere=False),
    Format(
        "text columns",
        (".txt", ".csv", ".dat", ".bbp", ".acc", ".sgs", ".tsv", ".inp", ".anc", ".cor", ".th"),
        columns.is_columns,
        columns.read_columns,
        anywhere=False,
    ),
)
"""Formats in the order of trial: an AT2 file saved as .txt is AT2, other text is columns, also a table called .AT2."""


def is_usual(suffix: str) -> bool:
    """Return whether a suffix (with its dot, any case) is usual for some format."""
    return any(suffix.lower() in form.suffixes for form in FORMATS)


def format_of(suffix: str, head: bytes) -> Format | None:
    """Return the first of ``FORMATS`` for a suffix (with its dot, any case) and the first bytes of a file; ``None`` if none."""
    begin = begin_of(head)
    return next(
        (form for form in FORMATS if (form.anywhere or suffix.lower() in form.suffixes) and form.matches(begin)),
        None,
    )


def read_record(file: RecordFile) -> Sequence[Component | Unusable]:
    """Return the components of a file, usable or not, with legible texts; raise ``InputError`` with the reason if it has none."""
    form = format_of(file.path.suffix, file.data)
    if form is None:
        raise UnknownFormat(_not_recognised(file))
    if "sensitivity" in file.options.instead and not form.counts:
        raise InputError(f"{form.name} is no format of counts: in motions.toml write scale = … instead of sensitivity")
    read = form.read

    def readings(options: ReadOptions) -> list[Component | Unusable]:
        raw = [with_legible_texts(reading) for reading in read(replace(file, options=options))]
        if len(raw) == 1 and isinstance(only := raw[0], Component):
            raw = [add_name_statement(only, file.path.name, split_stem(file.stem)[1])]
        return [checked_reading(reading) for reading in raw]

    with np.errstate(over="ignore", invalid="ignore"):  # checked_reading refuses infinite samples
        try:
            return readings(file.options)
        except Unstated as error:
            raise with_advice(error, readings, file.options, file.gravity) from None


def add_name_statement(component: Component, name: str, orientation: Orientation | None) -> Component:
    """Return the only component of a file, its direction decided with the statement of the file's ``name`` among others.

    Digits of the station's name or of a location code are no azimuth. An earlier statement by a name is replaced.
    """
    statements = tuple(s for s in component.statements if s.kind is not Kind.NAME)
    if orientation and not _is_of_sensor(orientation.label, component):
        weak = is_place_or_direction(orientation.label) or len(Path(name).stem) == 1
        statements += (Statement(Kind.NAME, f"its file is called {shown(name)}", orientation, weak=weak),)
    if statements == component.statements:
        return component
    orientation = decided_orientation(statements, component.orientation.label)
    return replace(component, statements=statements, orientation=orientation)


def _is_of_sensor(label: str, component: Component) -> bool:
    """Return whether ``label`` is digits that end its station, its location code, or two digits beside a channel code."""
    if not label.isdigit():
        return False
    station = re.sub(r"[\W_]", "", component.sensor.station or component.origin.station)
    has_channel = any(statement.kind is Kind.CODE for statement in component.statements)
    return station.endswith(label) or label == component.sensor.location or (has_channel and len(label) == _LOCATION)


def checked_reading(reading: Component | Unusable) -> Component | Unusable:
    """Return a component that can become a motion, else an ``Unusable`` with the reason; an ``Unusable`` is returned as is."""
    if isinstance(reading, Unusable):
        return reading
    if len(reading.acceleration) < 2:
        refusal = "found one sample; expected at least two"
    elif not (np.abs(reading.acceleration) <= HUGE).all():
        refusal = f"holds values that are not finite numbers, or beyond {HUGE:g} m/s²"
    elif not is_step(reading.dt):
        refusal = f"found a sampling interval of {reading.dt:g} s; expected {STEPS}"
    elif len(reading.acceleration) > MOST_SAMPLES:
        refusal = f"found {len(reading.acceleration)} samples; {MOST_SAMPLES:,} are the most, more than a day: cut the event out"
    else:
        return reading
    return Unusable(reading.name, reading.sources, refusal, reading.orientation.label)


def _not_recognised(file: RecordFile) -> str:
    """Return the message about a file of no known format, with a remedy."""
    suffix = file.path.suffix
    names = " or ".join(dict.fromkeys(form.name for form in FORMATS if suffix.lower() in form.suffixes))
    foreign = next((words for magic, words in _FOREIGN.items() if file.data.startswith(magic)), "")
    if foreign:
        return f"not a format that rockbatch reads, but {foreign}; {_INSTEAD}"
    if names and not file.data:
        return "the file is empty"
    if names and file.data.startswith(b"PK\x03\x04"):
        return f"no {names} file but a zip archive, such as an Excel workbook: export it as CSV (UTF-8)"
    if names and b"\x00" in file.data[:HEAD]:
        return f"its suffix {suffix} says {names}, but it holds binary data, or text to be saved as UTF-8"
    kind = f"its suffix {suffix} says {names}" if names else "not a format that rockbatch reads"
    if columns.holds_table(file.data[:HEAD]):
        return f"{kind}, but it is a table: read it as text columns: call it .txt, and state unit and columns as of any table"
    return f"{kind}, but its header is another one" if names else f"{kind}; {_INSTEAD}"
