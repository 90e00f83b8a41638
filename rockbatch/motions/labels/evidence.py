"""Statements of the direction of a component: by angles, channel code, header, file name or the user.

Readers collect them; ``directions.py`` judges them for a whole set.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum

from rockbatch.motions.labels.orientation import Orientation, angle_between, is_upward, same_azimuth, unknown


class Kind(Enum):
    """A kind of evidence, in the order in which it is believed."""

    USER = "motions.toml or the study"
    ANGLES = "azimuth and dip"
    CODE = "channel code"
    HEADER = "header"
    NAME = "file name"


_ORDER = list(Kind)
_EXCHANGED = 15.0  # degrees off a right angle within which a code and an angle seem exchanged
_ROUNDED = 5.0  # degrees by which two statements of one azimuth may differ


@dataclass(frozen=True)
class Statement:
    """A direction, the kind of its source, and its words: ``channel "HNZ"``."""

    kind: Kind
    words: str
    orientation: Orientation
    default: bool = False  # whether programs write it by default: azimuth 0°, dip 0°
    weak: bool = False  # whether it may mean something else, and counts only without another statement

    def contradicts(self, other: "Statement") -> bool:
        """Return whether two cannot both be right: only one vertical, opposite signs of verticals, or azimuths over 5° apart.

        False for an unknown azimuth. Sensors turned to any azimuth still have codes with N and E, so letters contradict an angle
        only if 75° to 105° apart.
        """
        mine, others = self.orientation, other.orientation
        if mine.vertical != others.vertical:
            return True
        if mine.vertical:
            return mine.down != others.down and self.states_sign and other.states_sign
        if mine.azimuth is None or others.azimuth is None:
            return False
        apart = angle_between(mine.azimuth, others.azimuth)
        one_of_angles = (self.kind is Kind.ANGLES) != (other.kind is Kind.ANGLES)
        if one_of_angles and not (self.has_number and other.has_number):
            return abs(apart - 90.0) <= _EXCHANGED
        return apart > _ROUNDED

    def differs_from(self, other: "Statement") -> bool:
        """Return whether only one is vertical, or azimuths differ by over 5°; an unknown azimuth differs from none."""
        a, b = self.orientation.azimuth, other.orientation.azimuth
        apart = 0.0 if a is None or b is None else angle_between(a, b)
        return self.orientation.vertical != other.orientation.vertical or apart > _ROUNDED

    @property
    def has_number(self) -> bool:
        """Return whether it is of angles, or its label has digits, "N35E", rather than letters alone."""
        return self.kind is Kind.ANGLES or any(c.isdecimal() for c in self.orientation.label)

    @property
    def states_sign(self) -> bool:
        """Return whether it says if a vertical component is positive up or down: by angles, "UP" or "DWN", but not by "V"."""
        return self.kind is Kind.ANGLES or self.orientation.down or is_upward(self.orientation.label)


def decided_orientation(statements: Sequence[Statement], label: str = "") -> Orientation:
    """Return the orientation of the most believed statement, by :class:`Kind`; an unknown one with ``label`` without any.

    Default and weak statements count only if there are no others. Angles without an azimuth give way to a statement of a
    horizontal component's azimuth.
    """
    ordered = sorted(statements, key=lambda s: _ORDER.index(s.kind))
    strong = [s.orientation for s in ordered if not (s.default or s.weak)] or [s.orientation for s in ordered]
    if not strong:
        return unknown(label)
    if ordered[0].kind is Kind.ANGLES and strong[0].azimuth is None:  # of which only the dip is known
        return next((o for o in strong if o.azimuth is not None and not strong[0].vertical), strong[0])
    return strong[0]


def angles_statement(label: str, words: str, azimuth: float | None, dip: float | None) -> Statement | None:
    """Return the statement of azimuth and dip [degrees, dip down from the horizontal] for a channel ``label``.

    ``None`` without either, and for an azimuth of 0° without a dip, which programs write by default. Raises ``ValueError``
    for an inclined channel, of a dip beyond 10° up to 80°, up or down.
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


_UPRIGHT, _LEVEL = 80.0, 10.0  # degrees of dip: least of a vertical channel, greatest of a horizontal one


def same_direction(a: Orientation, b: Orientation) -> bool:
    """Return whether two known orientations agree: vertical, azimuths within 1°, or equal labels without azimuths.

    False if one is unknown, or only one has an azimuth; up and down are the same.
    """
    if not (a.known and b.known) or a.vertical != b.vertical:
        return False
    if a.vertical:
        return True
    if a.azimuth is None or b.azimuth is None:
        return a.azimuth is b.azimuth and a.label.upper() == b.label.upper() != ""
    return same_azimuth(a.azimuth, b.azimuth)
