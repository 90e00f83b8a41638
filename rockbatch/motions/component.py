"""One component of a record, before horizontals and verticals are paired."""

from dataclasses import dataclass

import numpy as np

from rockbatch.motions.motion import Samples
from rockbatch.motions.orientation import UNKNOWN, Orientation


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
    confirmed : bool
        Whether a manifest confirms its PGA, however unlikely.
    notes : tuple of str
        What was done to the data.
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
    confirmed: bool = False
    notes: tuple[str, ...] = ()

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
