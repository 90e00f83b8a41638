"""The few values of a StationXML file that turn counts into accelerations: sensitivity and orientation."""

import math
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass
from datetime import UTC, datetime
from functools import lru_cache
from pathlib import Path

from rockbatch.errors import InputError
from rockbatch.motions import archives


@dataclass(frozen=True)
class Channel:
    """One channel in one of its epochs.

    ``sensitivity`` is in counts per ``unit`` (as the file writes it, such as "M/S**2"); ``azimuth`` in
    degrees from north, ``dip`` in degrees down from the horizontal (−90: positive up); ``start`` and ``end``
    in s since 1970.
    """

    id: str
    start: float
    end: float
    sensitivity: float | None
    unit: str
    azimuth: float | None
    dip: float | None


def channels_beside(folder: Path) -> list[Channel]:
    """Channels of all StationXML files in ``folder``, of the disk or of an archive; other .xml files have none."""
    found: list[Channel] = []
    for path in archives.files_in(folder):
        if path.suffix.lower() == ".xml":
            found += _channels(path, (archives.archive_of(path) or path).stat().st_mtime_ns)
    return found


@lru_cache(maxsize=64)
def _channels(path: Path, mtime_ns: int) -> list[Channel]:
    """Channels of one file; ``mtime_ns`` keeps an edited file from being taken for the old one."""
    try:
        root = ElementTree.fromstring(archives.content(path))
    except (ElementTree.ParseError, InputError, OSError, ValueError):
        return []
    channels = []
    for network in root.findall("{*}Network"):
        for station in network.findall("{*}Station"):
            for channel in station.findall("{*}Channel"):
                location = (channel.get("locationCode") or "").strip()
                codes = (network.get("code"), station.get("code"), location, channel.get("code"))
                channels.append(
                    Channel(
                        id=".".join(code or "" for code in codes),
                        start=_time(channel.get("startDate"), -math.inf),
                        end=_time(channel.get("endDate"), math.inf),
                        sensitivity=_number(channel.findtext("{*}Response/{*}InstrumentSensitivity/{*}Value")),
                        unit=_unit(channel.findtext("{*}Response/{*}InstrumentSensitivity/{*}InputUnits/{*}Name")),
                        azimuth=_number(channel.findtext("{*}Azimuth")),
                        dip=_number(channel.findtext("{*}Dip")),
                    )
                )
    return channels


def _unit(text: str | None) -> str:
    """The unit of "M/S**2 - Acceleration in meters per second per second", as old dataless files have it."""
    return (text or "").partition(" - ")[0].strip()


def _number(text: str | None) -> float | None:
    try:
        value = float(text or "")
    except ValueError:
        return None
    return value if math.isfinite(value) else None


def _time(text: str | None, otherwise: float) -> float:
    try:
        moment = datetime.fromisoformat(text or "")
    except ValueError:
        return otherwise
    return (moment if moment.tzinfo else moment.replace(tzinfo=UTC)).timestamp()
