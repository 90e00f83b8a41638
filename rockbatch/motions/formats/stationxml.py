"""The few values of a StationXML file that turn counts into accelerations: sensitivity and orientation."""

import math
import os
from dataclasses import dataclass
from datetime import UTC, datetime
from functools import lru_cache
from pathlib import Path

from rockbatch.common.errors import InputError
from rockbatch.common.files import state_of
from rockbatch.motions import archives

LARGEST = 64 * 2**20
"""Bytes: a network with the responses of all its stations."""

_ROOT = "FDSNStationXML"
_LEVELS = ((_ROOT, "Network"), (_ROOT, "Network", "Station"), (_ROOT, "Network", "Station", "Channel"))
_SENSITIVITY = "Response/InstrumentSensitivity"
_TEXTS = (f"{_SENSITIVITY}/Value", f"{_SENSITIVITY}/InputUnits/Name", "Azimuth", "Dip")  # below a channel
_LONGEST = 200  # characters of these
_DEEPEST = 50  # elements within one another; the format has 9


@dataclass(frozen=True)
class Channel:
    """One channel in one of its epochs."""

    id: str
    start: float  # [s since 1970]
    end: float
    sensitivity: float | None  # counts per unit
    unit: str  # as the file writes it, such as "M/S**2"
    azimuth: float | None  # degrees from north
    dip: float | None  # degrees down from the horizontal (−90: positive up)


def channels_beside(folder: Path, root: Path | None = None) -> tuple[list[Channel], list[str]]:
    """Return the channels of all StationXML files in ``folder``, of the disk or of an archive, and those that were not read, why.

    Links are followed that stay within ``root``, or within the folder. Other .xml files have no channels.
    """
    channels: list[Channel] = []
    refused: list[str] = []
    inside = Path(os.path.realpath(root or folder))
    for path in _files(folder, archives.state(folder)):
        real = Path(os.path.realpath(archives.archive_of(path) or path))
        try:
            if not real.is_relative_to(inside):
                raise InputError("a link that leads out of the folder")
            channels += _channels(path, state_of(real.stat()))
        except InputError as error:
            refused.append(f"{path.name}: {error}")
        except OSError as error:
            refused.append(f"{path.name}: {error.strerror or error}")
    return channels, refused


@lru_cache(maxsize=64)
def _files(folder: Path, state: tuple[int, ...]) -> list[Path]:
    """Return the .xml files in a folder, whose ``state`` tells that others are in it now."""
    return [path for path in archives.files_in(folder) if path.suffix.lower() == ".xml"]


@lru_cache(maxsize=64)
def _channels(path: Path, state: tuple[int, ...]) -> list[Channel]:
    """Return the channels of one file; its ``state`` keeps an edited file from being taken for the old one.

    Raises ``InputError`` for a file that is too large, damaged, or in an encoding that nobody knows.
    """
    from xml.etree.ElementTree import XMLParser

    data = archives.content(path, LARGEST + 1)
    if len(data) > LARGEST:
        raise InputError(f"larger than {LARGEST // 2**20} MiB")
    reader = _Reader()
    parser = XMLParser(target=reader)
    try:
        parser.feed(data)
        parser.close()
    except _NoStationXML:
        return []
    except Exception as error:  # the parser's own, and those of codecs for unknown encodings
        raise InputError(f"not XML that can be read ({type(error).__name__})") from None
    return reader.channels


class _NoStationXML(Exception):  # noqa: N818
    """Another XML file, which is no concern of a record's."""


class _Reader:
    """Takes the channels out of what the parser finds, and keeps nothing else: no tree is built."""

    def __init__(self) -> None:
        self.channels: list[Channel] = []
        self.above: list[str] = []
        self.attributes: dict[str, dict[str, str]] = {}
        self.texts: dict[str, str] = {}

    def start(self, tag: str, attributes: dict[str, str]) -> None:
        name = tag.rpartition("}")[2]
        if (not self.above and name != _ROOT) or len(self.above) > _DEEPEST:
            raise _NoStationXML
        self.above.append(name)
        if tuple(self.above) in _LEVELS:
            self.attributes[name] = attributes
            self.texts = {}

    def data(self, text: str) -> None:
        key = "/".join(self.above[len(_LEVELS[-1]) :])
        if key in _TEXTS and len(self.texts.get(key, "")) < _LONGEST:
            self.texts[key] = self.texts.get(key, "") + text[:_LONGEST]

    def end(self, tag: str) -> None:
        if tuple(self.above) == _LEVELS[-1]:
            self.channels.append(self._channel())
        self.above.pop()

    def _channel(self) -> Channel:
        network, station, channel = (self.attributes[level[-1]] for level in _LEVELS)
        location = channel.get("locationCode", "").strip()
        value, unit, azimuth, dip = (self.texts.get(key, "") for key in _TEXTS)
        return Channel(
            id=".".join((network.get("code", ""), station.get("code", ""), location, channel.get("code", ""))),
            start=_time(channel.get("startDate"), -math.inf),
            end=_time(channel.get("endDate"), math.inf),
            sensitivity=_number(value),
            unit=unit.partition(" - ")[0].strip(),  # old dataless files: "M/S**2 - Acceleration in meters per …"
            azimuth=_number(azimuth),
            dip=_number(dip),
        )


def _number(text: str) -> float | None:
    try:
        value = float(text)
    except ValueError:
        return None
    return value if math.isfinite(value) else None


def _time(text: str | None, otherwise: float) -> float:
    try:
        moment = datetime.fromisoformat(text or "")
        return (moment if moment.tzinfo else moment.replace(tzinfo=UTC)).timestamp()
    except (ValueError, OverflowError):
        return otherwise
