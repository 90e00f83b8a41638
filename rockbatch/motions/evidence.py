"""Statements of the direction of a component: by angles, channel code, header, file name or the user.

Readers collect it; ``directions.py`` judges it for a whole set.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum

from rockbatch.motions.orientation import SAME_AZIMUTH, Orientation, is_upward, unknown


class Kind(Enum):
    """A kind of evidence, in the order in which it is believed."""

    USER = "motions.toml or the study"
    ANGLES = "azimuth and dip"
    CODE = "channel code"
    HEADER = "header"
    NAME = "file name"


_ORDER = list(Kind)
_EXCHANGED = 15.0  # degrees that a code and an angle may be off a right angle to each other where they seem exchanged
_ROUNDED = 5.0  # degrees that two statements of one azimuth may differ


@dataclass(frozen=True)
class Statement:
    """A direction, what states it, and its words: ``channel "HNZ"``."""

    kind: Kind
    words: str
    orientation: Orientation
    default: bool = False  # whether programs write it where they know nothing: azimuth 0°, dip 0°
    weak: bool = False  # whether it may mean something else, and counts only where nothing else tells

    def contradicts(self, other: "Statement") -> bool:
        """Return whether not both can be right; sensors that are turned to any azimuth still have codes with N and E."""
        mine, others = self.orientation, other.orientation
        if mine.vertical != others.vertical:
            return True
        if mine.vertical:
            return mine.down != others.down and self.states_sign and other.states_sign
        if mine.azimuth is None or others.azimuth is None:
            return False
        apart = abs((mine.azimuth - others.azimuth + 180.0) % 360.0 - 180.0)
        if self.is_angle != other.is_angle and not (self.has_number and other.has_number):
            return abs(apart - 90.0) <= _EXCHANGED
        return apart > _ROUNDED

    def differs_from(self, other: "Statement") -> bool:
        """Return whether both cannot be exact: other roles, or azimuths that are no rounding of each other."""
        a, b = self.orientation.azimuth, other.orientation.azimuth
        apart = 0.0 if a is None or b is None else abs((a - b + 180.0) % 360.0 - 180.0)
        return self.orientation.vertical != other.orientation.vertical or apart > _ROUNDED

    @property
    def is_angle(self) -> bool:
        """Return whether it is the angles of a header."""
        return self.kind is Kind.ANGLES

    @property
    def has_number(self) -> bool:
        """Return whether its azimuth is a number, and not N or E."""
        return self.is_angle or any(c.isdecimal() for c in self.orientation.label)

    @property
    def states_sign(self) -> bool:
        """Return whether it says if a vertical component is positive up or down."""
        return self.is_angle or self.orientation.down or is_upward(self.orientation.label)


def settled(statements: Sequence[Statement], label: str = "") -> Orientation:
    """Return the orientation that the first statement in the order of kinds gives; unknown of ``label`` without one.

    What programs write by default, and what may mean something else, tells nothing beside another statement; a default
    azimuth without a dip tells nothing at all.
    """
    ordered = sorted(statements, key=lambda s: _ORDER.index(s.kind))
    strong = [s.orientation for s in ordered if not (s.default or s.weak)] or [s.orientation for s in ordered]
    if not strong:
        return unknown(label)
    if ordered[0].is_angle and strong[0].azimuth is None:  # of which only the dip is known
        return next((o for o in strong if o.azimuth is not None and not strong[0].vertical), strong[0])
    return strong[0]


def by_angles(label: str, words: str, azimuth: float | None, dip: float | None) -> Statement | None:
    """Return what azimuth and dip [degrees, down from the horizontal] state of a channel ``label``; ``None`` without them.

    An azimuth alone is that of a horizontal component, but the default 0° of any; a dip between both is neither, which
    ``ValueError`` says.
    """
    default = azimuth in (None, 0.0) and dip in (None, 0.0)
    if dip is None and (azimuth is None or default):
        return None
    if dip is not None and abs(dip) > _UPRIGHT:
        return Statement(Kind.ANGLES, words, Orientation(label, vertical=True, down=dip > 0))
    if dip is not None and abs(dip) > _LEVEL:
        raise ValueError(f"inclined (dip {dip:g}°): neither horizontal nor vertical")
    orientation = Orientation(label, azimuth=None if azimuth is None else azimuth % 360.0)
    return Statement(Kind.ANGLES, words, orientation, default=default)


_UPRIGHT, _LEVEL = 80.0, 10.0  # dips of what is vertical, and of what is horizontal


def same_direction(a: Orientation, b: Orientation) -> bool:
    """Return whether two known orientations are one, by azimuths, or else by their labels."""
    if not (a.known and b.known) or a.vertical != b.vertical:
        return False
    if a.vertical:
        return True
    if a.azimuth is None or b.azimuth is None:
        return a.azimuth is b.azimuth and a.label.upper() == b.label.upper() != ""
    return abs((a.azimuth - b.azimuth + 180.0) % 360.0 - 180.0) <= SAME_AZIMUTH
