"""Formats of records: which reader reads a file, by its suffix and its own header.

A format is a module with ``SUFFIXES``, a check of the first bytes and a reader that gives components; it
joins by a line in ``FORMATS``. No format is guessed from content alone, and ObsPy is never left to guess (see
``with_obspy``).
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from rockbatch.errors import InputError
from rockbatch.motions.component import Component
from rockbatch.motions.formats import at2, columns, cosmos, csmip, cwa, dyna, geonet, knet, miniseed, renadic, sac, smc
from rockbatch.motions.formats.record_file import ROLES, ReadOptions, RecordFile
from rockbatch.motions.motion import Unusable

__all__ = ["FORMATS", "ROLES", "Format", "ReadOptions", "RecordFile", "has_reader", "read_record"]

_HEAD = 4096


@dataclass(frozen=True)
class Format:
    """A format: its name, suffixes in lower case, the check of the first bytes, and the reader."""

    name: str
    suffixes: frozenset[str]
    matches: Callable[[bytes], bool]
    read: Callable[[RecordFile], Sequence[Component | Unusable]]


FORMATS = (
    Format("PEER AT2", at2.SUFFIXES | columns.SUFFIXES, at2.looks_like_at2, at2.read_component),
    Format("MiniSEED", miniseed.SUFFIXES, miniseed.is_miniseed, miniseed.read_miniseed),
    Format("SAC", sac.SUFFIXES, sac.is_sac, sac.read_sac),
    Format("K-NET/KiK-net", knet.SUFFIXES, knet.is_knet, knet.read_knet),
    Format("GeoNet V1A/V2A", geonet.SUFFIXES, geonet.is_geonet, geonet.read_geonet),
    Format("DYNA (ESM, ITACA, AFAD)", dyna.SUFFIXES, dyna.is_dyna, dyna.read_dyna),
    Format("COSMOS", cosmos.SUFFIXES, cosmos.is_cosmos, cosmos.read_cosmos),
    Format("CSMIP", csmip.SUFFIXES, csmip.is_csmip, csmip.read_csmip),
    Format("USGS SMC", smc.SUFFIXES, smc.is_smc, smc.read_smc),
    Format("RENADIC", renadic.SUFFIXES, renadic.is_renadic, renadic.read_renadic),
    Format("CWA free field", cwa.SUFFIXES, cwa.is_cwa, cwa.read_cwa),
    Format("text columns", columns.SUFFIXES, columns.is_columns, columns.read_columns),
)
"""In the order in which they are tried: an AT2 file saved as .txt is AT2, other text is columns."""


def has_reader(suffix: str) -> bool:
    """Whether files with this suffix (with its dot, any case) are records of a known format."""
    return any(suffix.lower() in known.suffixes for known in FORMATS)


def read_record(file: RecordFile) -> Sequence[Component | Unusable]:
    """Components of a file, or ``InputError`` with the reason why there are none."""
    by_suffix = [known for known in FORMATS if file.path.suffix.lower() in known.suffixes]
    for known in by_suffix:
        if known.matches(file.data[:_HEAD]):
            with np.errstate(over="ignore", invalid="ignore"):  # what becomes of absurd numbers is looked at below
                return [_usable(reading) for reading in known.read(file)]
    if not by_suffix:
        raise InputError("not a format that rockbatch reads")
    if not file.data:
        raise InputError("the file is empty")
    raise InputError(_not_recognised(file, " or ".join(known.name for known in by_suffix)))


def _usable(reading: Component | Unusable) -> Component | Unusable:
    """A component that a motion can be made of, or what it lacks."""
    if isinstance(reading, Unusable):
        return reading
    if len(reading.acceleration) < 2:
        return Unusable(reading.name, reading.source, "found one sample; expected at least two")
    if not np.isfinite(reading.acceleration).all():
        return Unusable(reading.name, reading.source, "holds values that are not finite numbers")
    return reading


def _not_recognised(file: RecordFile, names: str) -> str:
    """What to say about a file whose header is that of no format with its suffix."""
    if file.data.startswith(b"PK\x03\x04"):
        return f"not a {names} file but a zip archive, such as an Excel workbook: export it as CSV (UTF-8)"
    if b"\x00" in file.data[:_HEAD]:
        return f"not a {names} file, as its suffix {file.path.suffix} says: binary data, or text to be saved as UTF-8"
    return f"not a {names} file, as its suffix {file.path.suffix} says: its header is another one"
