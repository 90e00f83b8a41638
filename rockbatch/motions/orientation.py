"""Which way a component points, from the many labels that agencies give it."""

import re
from dataclasses import dataclass


@dataclass(frozen=True)
class Orientation:
    """Direction of a component.

    Attributes
    ----------
    label : str
        As the file has it: "228", "NS", "DWN", "HNZ"; empty where it says nothing.
    vertical : bool
        Whether it is the vertical component.
    azimuth : float or None
        Of a horizontal component [degrees clockwise from north, 0 ≤ azimuth < 360]; ``None`` where unknown.
    down : bool
        Whether a vertical component is positive down.
    """

    label: str
    vertical: bool = False
    azimuth: float | None = None
    down: bool = False


UNKNOWN = Orientation("")
"""Of a file that does not say: taken as horizontal."""

_UP = {"UP", "UD", "U", "V", "Z", "VER", "VERT", "VERTICAL", "UPDOWN", "UPWARD", "AZ"}
_DOWN = {"DWN", "DN", "DOWN", "DOWNWARD"}
_AZIMUTHS = {
    **dict.fromkeys(("N", "NS", "NORTH", "NORTHSOUTH", "NORTHWARD"), 0.0),
    **dict.fromkeys(("E", "EW", "EAST", "EASTWEST", "EASTWARD"), 90.0),
    **dict.fromkeys(("S", "SOUTH"), 180.0),
    **dict.fromkeys(("W", "WEST"), 270.0),
}
_HORIZONTAL = {
    "L",
    "T",
    "LN",
    "TR",
    "LONG",
    "TRAN",
    "TRANS",
    "H",
    "H1",
    "H2",
    "X",
    "Y",
    "AX",
    "AY",
    "FN",
    "FP",
    "R",
}

# SEED channel codes: band, instrument (N, L, G: accelerometers; H: seismometers), orientation.
_CHANNEL = re.compile(r"[A-Z][NLGH]([ZUNE12RT])")
_QUADRANT = re.compile(r"([NS])(\d{1,2})([EW])")
_NOISE = re.compile(r"ACCELERATION|ACCEL|ACC|COMPONENT|COMP|DEG(?:REES)?|[^A-Z0-9]")


def orientation_of(label: str) -> Orientation | None:
    """Orientation that ``label`` stands for: "UP", "DWN", "S62W", "21", "N-S", "HNZ"; ``None`` if none."""
    label = label.strip()
    key = _NOISE.sub("", label.upper())
    if key in _UP:
        return Orientation(label, vertical=True)
    if key in _DOWN:
        return Orientation(label, vertical=True, down=True)
    if key in _AZIMUTHS:
        return Orientation(label, azimuth=_AZIMUTHS[key])
    if key in _HORIZONTAL:
        return Orientation(label)
    if re.fullmatch(r"\d{1,3}", key) and int(key) <= 360:
        return Orientation(label, azimuth=float(int(key) % 360))
    if quadrant := _QUADRANT.fullmatch(key):
        pole, angle, side = quadrant[1], float(quadrant[2]), quadrant[3]
        azimuth = (0.0 if pole == "N" else 180.0) + (angle if (pole == "N") == (side == "E") else -angle)
        return Orientation(label, azimuth=azimuth % 360.0)
    if channel := _CHANNEL.fullmatch(key):
        if channel[1] in "ZU":
            return Orientation(label, vertical=True)
        return Orientation(label, azimuth=_AZIMUTHS.get(channel[1]))
    return None


def split_stem(stem: str) -> tuple[str, Orientation | None]:
    """The station's part of a file's stem and the orientation at its end.

    "RSN1063_NORTHR_RRS228" gives "RSN1063_NORTHR_RRS" and 228°, "ABBAR--V" gives "ABBAR" and vertical.
    Numbers count as azimuths only with three digits.
    """
    apart = re.fullmatch(r"(.*[^-_. ])[-_. ]+([A-Za-z]+|\d{3}|[A-Za-z]+\d+[A-Za-z]*)", stem)
    if apart and (found := orientation_of(apart[2])):
        return apart[1], found
    glued = re.fullmatch(r"(.*[A-Za-z0-9])(\d{3}|DWN|UP|UD|EW|NS|VER)", stem)
    if glued and (found := orientation_of(glued[2])):
        return glued[1], found
    return stem, None


def same_azimuth(a: float | None, b: float | None, within: float = 1.0) -> bool:
    """Whether two azimuths [degrees] agree ``within`` a degree; 360 and 0 are the same."""
    if a is None or b is None:
        return False
    return abs((a - b + 180.0) % 360.0 - 180.0) <= within


_CLOCKS = re.compile(r"(?:INT|EXT)(?:T?C|CLOCK|CLK)|TCG?|CLOCK|CLK|TIME(?:CODE|MARKS?)|IRIG[A-Z]?|WWVB?|DCF|[ALV]C[EQ]")


def is_clock(label: str) -> bool:
    """Whether a channel's label is that of the recorder's clock, such as "INTC", or SEED's "LCQ": no ground motion."""
    return _CLOCKS.fullmatch(re.sub(r"[^A-Z]", "", label.upper())) is not None
