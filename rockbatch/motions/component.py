"""One component of a record, before horizontals and verticals are paired."""

import re
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from rockbatch.motions.labels.evidence import Statement
from rockbatch.motions.labels.orientation import UNKNOWN, Orientation
from rockbatch.motions.labels.origin import UNKNOWN_ORIGIN, Origin
from rockbatch.motions.motion import Finding, Initial, Samples, frozen
from rockbatch.motions.sources.archives import bare
from rockbatch.motions.sources.listed import NOT_LISTED, Listed
from rockbatch.motions.sources.source import Sourced

FIRST_YEAR = 365 * 86400.0
"""The end of 1970 [s since it began]: no recorder began in it, but headers without a date say so."""


@dataclass(frozen=True)
class Sensor:
    """A sensor and its place, as far as the header states them; empty or None where it does not."""

    station: str = ""  # code, number or name
    network: str | None = None
    location: str | None = None  # of the sensor in the station, as in SEED
    place: str | None = None  # in words: "Roof"
    channel: str | None = None  # of the recorder

    @property
    def number(self) -> str:
        """Return the station without leading zeros, which some agencies add: "12" of "0012"; "" if unknown."""
        return self.station.lstrip("0")

    def may_be_same_as(self, other: "Sensor") -> bool:
        """Return whether both may be one sensor: same station number and no differing codes; False without a station."""
        return bool(self.number) and self.number == other.number and not self._codes_differ(other)

    def is_distinct_from(self, other: "Sensor") -> bool:
        """Return whether headers tell two sensors apart: by codes that differ in one station, or by two stations of one network.

        False without both stations, and for stations of two networks. If a channel number is known, the place in words, which
        differs between formats, is ignored.
        """
        if not self.number or not other.number:
            return False
        if self.number == other.number:
            unplaced = None not in (self.channel, other.channel) or self.channel != other.channel
            return (replace(self, place=None) if unplaced else self)._codes_differ(other)
        return bool(self.network) and self.network == other.network

    def _codes_differ(self, other: "Sensor") -> bool:
        """Return whether network, location, place or channel differ in letters or digits, where both sensors have them."""
        mine, others = ((sensor.network, sensor.location, sensor.place, sensor.channel) for sensor in (self, other))
        return any(None not in (a, b) and _bare(str(a)) != _bare(str(b)) for a, b in zip(mine, others, strict=True))


def _bare(text: str) -> str:
    """Return a text in capitals without blanks and signs: "Free-field" gives "FREEFIELD"."""
    return re.sub(r"[\W_]+", "", text).upper()


UNKNOWN_SENSOR = Sensor()
"""For a file that does not state its sensor."""


@dataclass(frozen=True)
class Component(Sourced):
    """One component of a record in m/s²; its samples cannot be changed, so that its motion shares them."""

    name: str  # of the motion that a horizontal component becomes
    dt: float  # sampling interval [s]
    acceleration: Samples  # [m/s²], shape (npts,), positive as in the file: a DWN component is positive down
    orientation: Orientation = UNKNOWN
    station: str = ""  # by the header: a key shared by the components of one station in one event
    folder: str = ""  # of the file, within which components are paired; empty for a package's
    sources: tuple[str, ...] = ()  # its file, for people; of a component turned from two, both files
    start: float | None = None  # time of the first sample [s since 1970, UTC]
    site: str = ""  # by the file's name: a key shared by the components of one station
    unit: str = ""  # in which the file's numbers were read; empty for counts, whose scale the format has
    raw: bool = False  # whether the instrument's zero offset may still be in it (see baseline)
    magnitude: float | None = None  # of the event, from a manifest
    distance_km: float | None = None  # of the site from the event, from a manifest
    confirmed: tuple[str, ...] = ()  # keys that a manifest confirms: "confirm", "confirm_pga" (see motion.Finding)
    preferred: bool = False  # whether a manifest chooses it before other copies of the recording
    sensor: Sensor = UNKNOWN_SENSOR
    event: str = ""  # by the header, to tell recordings of one sensor apart without a start time
    processed: bool | None = None  # whether the agency has corrected it; None if the file does not say
    initial: Initial | None = None  # the ground's state at the first sample, if the file has it
    origin: Origin = UNKNOWN_ORIGIN
    notes: tuple[str, ...] = ()  # on processing
    findings: tuple[Finding, ...] = ()  # contradictions of its header, or with copies that are left out
    number: int = 0  # of the component in its file, from 1
    statements: tuple[Statement, ...] = ()  # of its direction, from all sources
    contradiction: str = ""  # between statements in its set, for which it is held back
    listed: Listed = NOT_LISTED  # PEER's search results
    turned: bool = False  # whether it is made of two, turned to a direction
    own_folder: str = ""  # of the file, if called after its direction: it is then paired in the folder above

    def __post_init__(self) -> None:
        object.__setattr__(self, "acceleration", frozen(self.acceleration))

    def with_findings(self, *findings: Finding) -> "Component":
        """Return the component with further findings behind its own."""
        return replace(self, findings=(*self.findings, *findings)) if findings else self

    @property
    def path(self) -> str:
        """Return the path of its file, by folder and source."""
        return f"{self.folder}/{self.file}"

    @property
    def suffix(self) -> str:
        """Return the suffix of its file, without .gz, in lower case."""
        return bare(Path(self.file)).suffix.lower()

    @property
    def dated(self) -> bool:
        """Return whether ``start`` is a date rather than a time relative to the other components of the file."""
        return self.start is not None and self.start >= FIRST_YEAR

    @property
    def duration(self) -> float:
        """Return the time from the first to the last sample [s]."""
        return (len(self.acceleration) - 1) * self.dt

    @property
    def pga(self) -> float:
        """Return the peak absolute acceleration [m/s²]."""
        return float(np.abs(self.acceleration).max())

    @property
    def upward(self) -> Samples:
        """Return the acceleration of a vertical component [m/s²], shape (npts,), positive up whatever it is in the file."""
        return -self.acceleration if self.orientation.down else self.acceleration
