"""The values of StationXML that turn counts into accelerations: sensitivity and orientation, with their epochs.

A channel may be described by several files, and by several epochs of one: all that cover a record are compared
(:func:`contradiction`), since none of them is more reliable than the others.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from functools import cached_property
from pathlib import Path

from rockbatch.common.errors import InputError
from rockbatch.common.grouping import grouped
from rockbatch.common.units import acceleration_factor
from rockbatch.motions.labels.orientation import same_azimuth
from rockbatch.motions.sources import archives

LARGEST = 64 * 2**20
"""Greatest size [bytes]: of a network with the responses of all its stations."""

_ROOT = "FDSNStationXML"
_LEVELS = ((_ROOT, "Network"), (_ROOT, "Network", "Station"), (_ROOT, "Network", "Station", "Channel"))
_SENSITIVITY = "Response/InstrumentSensitivity"
_TEXTS = (f"{_SENSITIVITY}/Value", f"{_SENSITIVITY}/InputUnits/Name", "Azimuth", "Dip", "Depth")  # below a channel
_PLACE = "Description"  # below a channel: "Roof, NE corner"
_SITE = "Site/Name"  # below a station
_GAIN = "Response/Stage/StageGain/Value"
_LONGEST = 200  # most characters of these texts
_DEEPEST = 50  # elements within one another; the format has 9
_SAME_GAIN = 1e-3  # relative: printed with few digits, or at another frequency
_SAME_STAGES = 0.05  # relative difference of the sensitivity from the product of the stages' gains, by filters
_LEVEL = 80.0  # degrees of dip beyond which azimuths mean nothing
_SAME_DIP = 1.0  # degrees
_DAY = 86400.0  # s
_NEVER = 2100  # year: epochs that end later are open, such as 2599-12-31


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
    depth: float | None = None  # of the sensor below the surface [m]
    stages: float | None = None  # product of the gains of all stages, if the file has them
    file: str = ""
    site: str = ""  # name of the station
    place: str = ""  # of the sensor, in words

    @property
    def named(self) -> str:
        """Return its file and epoch: "a.xml, epoch 2010-01-01 to now"."""
        first, last = (_day(time) for time in (self.start, self.end))
        return f"{self.file}, epoch {first or '…'} to {last or 'now'}"

    @property
    def gain(self) -> str:
        """Return its sensitivity, which must be known, with its unit, for people: "428000 counts per M/S**2"."""
        return f"{self.sensitivity:.10g} counts per {self.unit}"


class Inventories:
    """Channels of the StationXML files beside records, read at the first use.

    ``files`` are paths, their names for people, and why they must not be opened ("" if they may). Other .xml files have no
    channels. ``within`` are channels in the records' own files.
    """

    def __init__(self, files: Sequence[tuple[Path, str, str]] = (), within: Sequence[Channel] = ()) -> None:
        self._files, self._within = files, within

    @cached_property
    def _read(self) -> tuple[dict[str, list[Channel]], list[str]]:
        """Return the channels by id, and the files that could not be read, with reasons."""
        channels: list[Channel] = [*self._within]
        refused: list[str] = []
        for path, name, refusal in self._files:
            try:
                if refusal:
                    raise InputError(refusal)
                channels += channels_of(archives.content(path, LARGEST + 1), name)
            except InputError as error:
                refused.append(f"{name}: {error}")
            except OSError as error:
                refused.append(f"{name}: {error.strerror or error}")
        return grouped(channels, lambda channel: channel.id), refused

    @property
    def refused(self) -> list[str]:
        """Return the files that could not be read, with the reason."""
        return self._read[1]

    def with_channels(self, within: Sequence[Channel]) -> "Inventories":
        """Return an inventory with the same files, and channels from within a file of records."""
        return Inventories(self._files, within)

    def epochs_of(self, channel_id: str) -> list[Channel]:
        """Return the epochs of a channel, those in the record's own file first, then file by file; [] for an unknown channel."""
        return self._read[0].get(channel_id, [])


def contradiction(channels: Sequence[Channel]) -> str:
    """Return two statements in words that contradict each other in a channel's epochs, all with sensitivities; "" if all agree.

    A sensitivity may be 5 % off the product of the stages' gains; other epochs are compared with the first, gains to 0.1 %.
    """
    for channel in channels:
        if channel.stages and channel.sensitivity and abs(channel.stages / channel.sensitivity - 1.0) > _SAME_STAGES:
            return f"{channel.gain} ({channel.named}) and {channel.stages:.6g} as the product of its stages' gains"
    first = channels[0]
    for other in channels[1:]:
        if not _same_gain(first, other):
            return f"{first.gain} ({first.named}) and {other.gain} ({other.named})"
        if not _same_direction(first, other):
            return f"{_direction(first)} ({first.named}) and {_direction(other)} ({other.named})"
    return ""


def _same_gain(a: Channel, b: Channel) -> bool:
    """Return whether counts per m/s² of two channels agree to 0.1 %; in units of no acceleration, number and unit exactly."""
    assert a.sensitivity
    assert b.sensitivity
    try:
        first, second = (a.sensitivity / acceleration_factor(a.unit), b.sensitivity / acceleration_factor(b.unit))
    except ValueError:  # no accelerations, or in an unknown unit
        return a.unit == b.unit and a.sensitivity == b.sensitivity
    return abs(first - second) <= _SAME_GAIN * abs(first)


def _same_direction(a: Channel, b: Channel) -> bool:
    """Return whether dip and azimuth agree within 1°, what is unknown with anything; an upright channel has no azimuth."""
    if a.dip is None or b.dip is None:
        return True
    if abs(a.dip - b.dip) > _SAME_DIP:
        return False
    return None in (a.azimuth, b.azimuth) or abs(a.dip) > _LEVEL or same_azimuth(a.azimuth, b.azimuth)


def _direction(channel: Channel) -> str:
    """Return a channel's azimuth, if known, and its dip, which must be known, in words: "azimuth 90°, dip 0°"."""
    azimuth = "" if channel.azimuth is None else f"azimuth {channel.azimuth:g}°, "
    return f"{azimuth}dip {channel.dip:g}°"


def _day(time: float) -> str:
    """Return a time [s since 1970] in ISO format, without the clock at midnight; empty for open epochs."""
    try:
        moment = datetime.fromtimestamp(time, UTC)
    except (ValueError, OverflowError, OSError):
        return ""
    if moment.year >= _NEVER:
        return ""
    return moment.strftime("%Y-%m-%d" if time % _DAY == 0.0 else "%Y-%m-%dT%H:%M:%S")


def channels_of(data: bytes, name: str) -> list[Channel]:
    """Return the channels of a StationXML file called ``name``; [] for other XML.

    Raises ``InputError`` for a file that is too large, damaged, or in an unknown encoding.
    """
    from xml.etree.ElementTree import XMLParser

    if len(data) > LARGEST:
        raise InputError(f"larger than {LARGEST // 2**20} MiB")
    reader = _Reader(name)
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
    """An XML file of another kind."""


class _Reader:
    """Parser target that collects channels without building a tree."""

    def __init__(self, file: str) -> None:
        self.file = file
        self.channels: list[Channel] = []
        self.above: list[str] = []
        self.attributes: dict[str, dict[str, str]] = {}
        self.site = ""
        self.texts: dict[str, str] = {}
        self.gains: list[float | None] = []

    def start(self, tag: str, attributes: dict[str, str]) -> None:
        """Enter an element; keep attributes of networks, stations and channels."""
        name = tag.rpartition("}")[2]
        if (not self.above and name != _ROOT) or len(self.above) > _DEEPEST:
            raise _NoStationXML
        self.above.append(name)
        if tuple(self.above) in _LEVELS:
            self.attributes[name] = attributes
            self.texts, self.gains = {}, []
            self.site = "" if tuple(self.above) != _LEVELS[-1] else self.site

    def data(self, text: str) -> None:
        """Keep the text of the elements of a channel that are read."""
        key = self._key
        if (key in (*_TEXTS, _PLACE, _GAIN)) and len(self.texts.get(key, "")) < _LONGEST:
            self.texts[key] = self.texts.get(key, "") + text[:_LONGEST]
        elif tuple(self.above) == (*_LEVELS[1], *_SITE.split("/")) and len(self.site) < _LONGEST:
            self.site += text[:_LONGEST]

    def end(self, tag: str) -> None:
        """Leave an element, and add the channel if it is one."""
        if tuple(self.above) == _LEVELS[-1]:
            self.channels.append(self._channel())
        elif self._key == _GAIN:
            self.gains.append(_number(self.texts.pop(_GAIN, "")))
        self.above.pop()

    @property
    def _key(self) -> str:
        """Return the path of the current element below its channel: "Response/InstrumentSensitivity/Value"."""
        return "/".join(self.above[len(_LEVELS[-1]) :])

    def _channel(self) -> Channel:
        """Return the channel whose element ends, with the epoch of the innermost element that has dates."""
        levels = [self.attributes[level[-1]] for level in _LEVELS]
        network, station, channel = levels
        dated = next((level for level in reversed(levels) if level.keys() & {"startDate", "endDate"}), {})
        gains = [gain for gain in self.gains if gain is not None]
        location = channel.get("locationCode", "").strip()
        value, unit, azimuth, dip, depth = (self.texts.get(key, "") for key in _TEXTS)
        return Channel(
            id=".".join((network.get("code", ""), station.get("code", ""), location, channel.get("code", ""))),
            start=_time(dated.get("startDate"), -math.inf),
            end=_time(dated.get("endDate"), math.inf),
            sensitivity=_number(value),
            unit=unit.partition(" - ")[0].strip(),  # old dataless files: "M/S**2 - Acceleration in meters per …"
            azimuth=_number(azimuth),
            dip=_number(dip),
            depth=_number(depth),
            stages=math.prod(gains) or None if gains and len(gains) == len(self.gains) else None,
            file=self.file,
            site=self.site.strip(),
            place=self.texts.get(_PLACE, "").strip(),
        )


def _number(text: str) -> float | None:
    """Return the finite number of a text; None for other texts."""
    try:
        value = float(text)
    except ValueError:
        return None
    return value if math.isfinite(value) else None


def _time(text: str | None, otherwise: float) -> float:
    """Return an ISO time [s since 1970], in UTC without a zone; ``otherwise`` for other texts."""
    try:
        moment = datetime.fromisoformat(text or "")
        return (moment if moment.tzinfo else moment.replace(tzinfo=UTC)).timestamp()
    except (ValueError, OverflowError):
        return otherwise
