"""One component of a record, before horizontals and verticals are paired."""

import re
from dataclasses import dataclass, replace

import numpy as np

from rockbatch.motions.evidence import Statement
from rockbatch.motions.listed import NOTHING, Listed
from rockbatch.motions.motion import Finding, Initial, Samples
from rockbatch.motions.orientation import UNKNOWN, Orientation
from rockbatch.motions.origin import UNKNOWN_ORIGIN, Origin

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
        """The station, without the zeros that some agencies put in front."""
        return self.station.lstrip("0")

    def may_be_same_as(self, other: "Sensor") -> bool:
        """Return whether both may be one sensor, of a station that both name."""
        return bool(self.number) and self.number == other.number and not self._codes_differ(other)

    def is_distinct_from(self, other: "Sensor") -> bool:
        """Return whether both are known to be distinct sensors, of one station or of one network; names differ between networks.

        Where a channel has a number, the words for its place, which differ from format to format, do not matter.
        """
        if not self.number or not other.number:
            return False
        if self.number == other.number:
            unplaced = None not in (self.channel, other.channel) or self.channel != other.channel
            return (replace(self, place=None) if unplaced else self)._codes_differ(other)
        return bool(self.network) and self.network == other.network

    def _codes_differ(self, other: "Sensor") -> bool:
        mine, others = ((sensor.network, sensor.location, sensor.place, sensor.channel) for sensor in (self, other))
        return any(None not in (a, b) and _bare(str(a)) != _bare(str(b)) for a, b in zip(mine, others, strict=True))


def _bare(text: str) -> str:
    """Return a text without blanks and signs: "Free-field" is "FREEFIELD"."""
    return re.sub(r"[\W_]+", "", text).upper()


def file_of(source: str) -> str:
    """Return the file of a component's source, which has a label behind where the file holds several: "x.V1 (NS)"."""
    return re.sub(r" \([^()]*\)$", "", source)


UNKNOWN_SENSOR = Sensor()
"""The sensor of a file that does not state it."""


@dataclass(frozen=True)
class Component:
    """One component of a record in m/s²."""

    name: str  # of the motion that it makes as a horizontal component
    dt: float  # sampling interval [s]
    acceleration: Samples  # [m/s²], shape (npts,), positive as the file has it: a DWN component is positive down
    orientation: Orientation = UNKNOWN
    station: str = ""  # what the components of one station in one event share; empty where the format does not say
    folder: str = ""  # that the file lies in, within which components are paired; empty for those of a package
    source: str = ""  # where it came from, for people
    start: float | None = None  # time of the first sample [s since 1970, UTC], where the format has it
    site: str = (
        ""  # what the components of one station share by the names of their files; empty where these do not tell
    )
    unit: str = ""  # that the file's numbers were read in; empty where the format has a scale of its own (counts)
    raw: bool = (
        False  # whether the instrument's zero is still in it, so that an offset is to be expected (see baseline)
    )
    magnitude: float | None = None  # of the event, where a manifest has it
    distance_km: float | None = None  # of the site from the event, likewise
    confirmed: tuple[str, ...] = ()  # what a manifest confirms: "confirm", "confirm_pga" (see motion.Finding)
    preferred: bool = False  # whether a manifest says that it is used, whatever other copies of the recording there are
    sensor: Sensor = UNKNOWN_SENSOR
    event: str = ""  # what the header says of it, to tell recordings of one sensor apart where start is not known
    processed: bool | None = None  # whether the agency has corrected it; None where the file does not say
    initial: Initial | None = None  # the ground's state at the first sample, where the file has it
    origin: Origin = UNKNOWN_ORIGIN
    notes: tuple[str, ...] = ()  # what was done to the data
    findings: tuple[Finding, ...] = ()  # contradictions of its header, or of copies of it that are left out
    number: int = 0  # of the component in its file, from 1
    statements: tuple[Statement, ...] = ()  # of its direction, whatever states it
    contradiction: str = ""  # of statements in its set, for which it is held back; empty where they agree
    listed: Listed = NOTHING  # what PEER's search says of the record

    @property
    def dated(self) -> bool:
        """Return whether ``start`` is a date, and not only a time from which the components of one file set are counted."""
        return self.start is not None and self.start >= FIRST_YEAR

    @property
    def duration(self) -> float:
        """Time from the first to the last sample [s]."""
        return (len(self.acceleration) - 1) * self.dt

    @property
    def pga(self) -> float:
        """Peak absolute acceleration [m/s²]."""
        return float(np.abs(self.acceleration).max())

    @property
    def upward(self) -> Samples:
        """Acceleration of a vertical component [m/s²], positive up, shape (npts,)."""
        return -self.acceleration if self.orientation.down else self.acceleration
