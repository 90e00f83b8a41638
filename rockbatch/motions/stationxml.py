"""The few values of StationXML files that turn counts into accelerations: sensitivity and orientation, with their epochs.

A channel may be described by several files, and by several epochs of one: all that cover a record are asked
(:func:`contradiction`), since the first of them is not more right than the others.
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
from rockbatch.motions import archives
from rockbatch.motions.orientation import same_azimuth

LARGEST = 64 * 2**20
"""Bytes: a network with the responses of all its stations."""

_ROOT = "FDSNStationXML"
_LEVELS = ((_ROOT, "Network"), (_ROOT, "Network", "Station"), (_ROOT, "Network", "Station", "Channel"))
_SENSITIVITY = "Response/InstrumentSensitivity"
_TEXTS = (f"{_SENSITIVITY}/Value", f"{_SENSITIVITY}/InputUnits/Name", "Azimuth", "Dip", "Depth")  # below a channel
_GAIN = "Response/Stage/StageGain/Value"
_LONGEST = 200  # characters of these
_DEEPEST = 50  # elements within one another; the format has 9
_SAME_GAIN = 1e-3  # relative: printed with few digits, or at another frequency
_SAME_STAGES = 0.05  # relative: what filters may add to the product of the stages' gains
_LEVEL = 80.0  # degrees of dip beyond which azimuths mean nothing
_SAME_DIP = 1.0  # degrees
_DAY = 86400.0  # s
_NEVER = 2100  # the year from which on an epoch is open: 2599-12-31 and the like


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
    stages: float | None = None  # product of the gains of all stages, where the file has them
    file: str = ""

    @property
    def named(self) -> str:
        """Return its file and epoch, for people."""
        first, last = (_day(time) for time in (self.start, self.end))
        return f"{self.file}, epoch {first or '…'} to {last or 'now'}"

    @property
    def gain(self) -> str:
        """Return its sensitivity with its unit, for people."""
        return f"{self.sensitivity:.10g} counts per {self.unit}"


class Inventories:
    """Channels of the StationXML files beside records, which are read once, when the first record asks for one.

    ``files`` are paths, their names for people, and why they are not to be opened, "" where they may be. Other .xml files
    have no channels. ``within`` are channels that come with the records.
    """

    def __init__(self, files: Sequence[tuple[Path, str, str]] = (), within: Sequence[Channel] = ()) -> None:
        self._files, self._within = files, within

    @cached_property
    def _read(self) -> tuple[dict[str, list[Channel]], list[str]]:
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
        """Return the files that were not read, with the reason."""
        return self._read[1]

    def also(self, within: Sequence[Channel]) -> "Inventories":
        """Return these, with the channels that a file of records has itself."""
        return Inventories(self._files, within)

    def of(self, channel_id: str) -> list[Channel]:
        """Return the epochs of a channel in all files, in their order."""
        return self._read[0].get(channel_id, [])


def contradiction(channels: Sequence[Channel]) -> str:
    """Return the two statements in which epochs of one channel contradict each other, or one itself; empty where all agree."""
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
    """Return whether both mean the same accelerations."""
    assert a.sensitivity
    assert b.sensitivity
    try:
        factors = [acceleration_factor(channel.unit) for channel in (a, b)]
    except ValueError:  # no accelerations, or in a unit that is not understood
        return a.unit == b.unit and a.sensitivity == b.sensitivity
    per_m_s2 = [
        channel.sensitivity / factor for channel, factor in zip((a, b), factors, strict=True) if channel.sensitivity
    ]
    return abs(per_m_s2[0] - per_m_s2[1]) <= _SAME_GAIN * abs(per_m_s2[0])


def _same_direction(a: Channel, b: Channel) -> bool:
    """Return whether dip and azimuth agree, as far as both have them."""
    if a.dip is None or b.dip is None:
        return True
    if abs(a.dip - b.dip) > _SAME_DIP:
        return False
    return None in (a.azimuth, b.azimuth) or abs(a.dip) > _LEVEL or same_azimuth(a.azimuth, b.azimuth)


def _direction(channel: Channel) -> str:
    azimuth = "" if channel.azimuth is None else f"azimuth {channel.azimuth:g}°, "
    return f"{azimuth}dip {channel.dip:g}°"


def _day(time: float) -> str:
    """Return a time as people write it, without a clock at midnight; empty where it has no end, or a far one."""
    try:
        moment = datetime.fromtimestamp(time, UTC)
    except (ValueError, OverflowError, OSError):
        return ""
    if moment.year >= _NEVER:
        return ""
    return moment.strftime("%Y-%m-%d" if time % _DAY == 0.0 else "%Y-%m-%dT%H:%M:%S")


def channels_of(data: bytes, name: str) -> list[Channel]:
    """Return the channels of a StationXML file, which ``name`` is for people; none of other XML.

    Raises ``InputError`` for a file that is too large, damaged, or in an encoding that nobody knows.
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
    """Another XML file, which is no concern of a record's."""


class _Reader:
    """Takes the channels out of what the parser finds, and keeps nothing else: no tree is built."""

    def __init__(self, file: str) -> None:
        self.file = file
        self.channels: list[Channel] = []
        self.above: list[str] = []
        self.attributes: dict[str, dict[str, str]] = {}
        self.texts: dict[str, str] = {}
        self.gains: list[float | None] = []

    def start(self, tag: str, attributes: dict[str, str]) -> None:
        name = tag.rpartition("}")[2]
        if (not self.above and name != _ROOT) or len(self.above) > _DEEPEST:
            raise _NoStationXML
        self.above.append(name)
        if tuple(self.above) in _LEVELS:
            self.attributes[name] = attributes
            self.texts, self.gains = {}, []

    def data(self, text: str) -> None:
        key = self._key
        if (key in _TEXTS or key == _GAIN) and len(self.texts.get(key, "")) < _LONGEST:
            self.texts[key] = self.texts.get(key, "") + text[:_LONGEST]

    def end(self, tag: str) -> None:
        if tuple(self.above) == _LEVELS[-1]:
            self.channels.append(self._channel())
        elif self._key == _GAIN:
            self.gains.append(_number(self.texts.pop(_GAIN, "")))
        self.above.pop()

    @property
    def _key(self) -> str:
        """Return the place of the present element below its channel."""
        return "/".join(self.above[len(_LEVELS[-1]) :])

    def _channel(self) -> Channel:
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
