"""One component of a record, before horizontals and verticals are paired."""

import re
from dataclasses import dataclass, replace

import numpy as np

from rockbatch.motions.motion import Finding, Initial, Samples
from rockbatch.motions.orientation import UNKNOWN, Orientation
from rockbatch.motions.origin import UNKNOWN_ORIGIN, Origin

FIRST_YEAR = 365 * 86400.0
"""The end of 1970 [s since it began]: no recorder began in it, but headers without a date say so."""


@dataclass(frozen=True)
class Seat:
    """Where a sensor stands, as far as the header says it.

    Attributes
    ----------
    station : str
        Code, number or name of the station; empty where it is unknown.
    network, location, place, channel : str or None
        Of the network; of the sensor in the station, as in SEED; in words ("Roof"); of the recorder. ``None`` where the
        format does not say.
    """

    station: str = ""
    network: str | None = None
    location: str | None = None
    place: str | None = None
    channel: str | None = None

    @property
    def number(self) -> str:
        """The station, without the zeros that some agencies put in front."""
        return self.station.lstrip("0")

    def is_that_of(self, other: "Seat") -> bool:
        """Whether both may be the same sensor, of a station that both name."""
        return bool(self.number) and self.number == other.number and not self._differs(other)

    def is_other(self, other: "Seat") -> bool:
        """Whether both are other sensors, of one station or of one network; stations may be called otherwise elsewhere.

        Where a channel has a number, the words for its place, which differ from format to format, do not matter.
        """
        if not self.number or not other.number:
            return False
        if self.number == other.number:
            unplaced = None not in (self.channel, other.channel) or self.channel != other.channel
            return (replace(self, place=None) if unplaced else self)._differs(other)
        return bool(self.network) and self.network == other.network

    def _differs(self, other: "Seat") -> bool:
        pairs = (
            (self.network, other.network),
            (self.location, other.location),
            (self.place, other.place),
            (self.channel, other.channel),
        )
        return not all(one is None or two is None or _bare(one) == _bare(two) for one, two in pairs)


def _bare(text: str) -> str:
    """A text without blanks and signs: "Free-field" is "FREEFIELD"."""
    return re.sub(r"[\W_]+", "", text).upper()


def file_of(source: str) -> str:
    """The file of a component's source, which has a label behind where the file holds several: "x.V1 (NS)"."""
    return re.sub(r" \([^()]*\)$", "", source)


NOWHERE = Seat()
"""Of a file that says nothing of its sensor."""


@dataclass(frozen=True)
class Component:
    """One component of a record in m/s².

    Attributes
    ----------
    name : str
        Name of the motion that it makes as a horizontal component.
    dt : float
        Sampling interval [s].
    acceleration : ndarray, shape (npts,)
        [m/s²], positive as the file has it: a DWN component is positive down.
    orientation : Orientation
        Which way it points.
    station : str
        What the components of one station in one event share; empty where the format does not say.
    folder : str
        Folder that the file lies in: components are paired within it. Empty for those of a package.
    source : str
        Where it came from, for people.
    start : float or None
        Time of the first sample [s since 1970, UTC], where the format has it.
    site : str
        What the components of one station share by the names of their files; empty where these are not to tell.
    unit : str
        Unit that the file's numbers were read in; empty where the format has a scale of its own (counts).
    raw : bool
        Whether the instrument's zero is still in it, so that an offset is to be expected (see ``baseline``).
    magnitude, distance_km : float or None
        Of the event, and the site's distance from it [km], where a manifest has them.
    confirmed : tuple of str
        What a manifest confirms: "confirm", "confirm_pga" (see ``motion.Finding``).
    wanted : bool
        Whether a manifest says that it is used, whatever else there is of the same recording.
    seat : Seat
        The sensor that it comes from.
    event : str
        What the header says of the event, to tell recordings of one sensor apart where ``start`` is not known.
    processed : bool or None
        Whether the agency has corrected it (filter, baseline, instrument); ``None`` where the file does not say.
    initial : Initial or None
        The ground's state at the first sample, where the file tells it.
    origin : Origin
        What the header calls event and station.
    notes : tuple of str
        What was done to the data.
    odd : tuple of Finding
        What its header, or copies of it which are left out, have otherwise.
    number : int
        Of the component in its file, from 1.
    """

    name: str
    dt: float
    acceleration: Samples
    orientation: Orientation = UNKNOWN
    station: str = ""
    folder: str = ""
    source: str = ""
    start: float | None = None
    site: str = ""
    unit: str = ""
    raw: bool = False
    magnitude: float | None = None
    distance_km: float | None = None
    confirmed: tuple[str, ...] = ()
    wanted: bool = False
    seat: Seat = NOWHERE
    event: str = ""
    processed: bool | None = None
    initial: Initial | None = None
    origin: Origin = UNKNOWN_ORIGIN
    notes: tuple[str, ...] = ()
    odd: tuple[Finding, ...] = ()
    number: int = 0

    @property
    def dated(self) -> bool:
        """Whether ``start`` is a date, and not only a time from which the components of one file set are counted."""
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
