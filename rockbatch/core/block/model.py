"""A pier on a rigid base, its state and its contacts (THEORY.md, Rigid base)."""

from typing import NamedTuple

from rockbatch.core.types import Pull


class Block(NamedTuple):
    """A pier on a rigid base, per unit mass, with finite kinematics."""

    half_width: float  # b [m]
    height: float  # h [m]
    inertia: float  # I0/M [m²]
    gravity: float  # g [m/s²]
    alpha: float  # α [rad]
    p: float  # [rad/s]
    restitution: float  # e, factor on the angular velocity when the block passes through θ = 0
    epsilon: float  # restitution of a pivot that lands from flight
    guided: float  # 1: flight goes on, 0: it ends the run
    quickness: float  # 1/(I0/M + R0²) [1/m²]
    rest: float  # velocity that counts as zero [m/s]
    deck: float  # γ/(1+2γ) of the equivalent block of a frame; 0 for other blocks
    pull: Pull | None = None  # of dampers and tendons; None: there are none
    finite: bool = True


class BlockTraits(NamedTuple):
    """Traits for which kernels are compiled: the type of this field of a Block."""

    pull: Pull | None = None


NUMBERS = tuple((name, float) for name in Block._fields[: Block._fields.index("pull")])
"""Fields of a Block that lanes hold."""

Numbers = NamedTuple("Numbers", NUMBERS)  # type: ignore[misc]


class Rocker(NamedTuple):
    """A block while it rocks about one pivot, for which two numbers suffice; it holds no pull."""

    half_width: float
    height: float
    gravity: float
    quickness: float  # p²/(g R0) = 1/(I0/M + R0²) [1/m²]


class Tilt(NamedTuple):
    """State of a Rocker; also its rates."""

    theta: float  # [rad]
    omega: float  # [rad/s]


class Rocking(NamedTuple):
    """State of a Block; also its rates. While it rocks, v follows from θ."""

    v: float  # height of the centre of mass above that at rest [m]
    theta: float  # rotation, positive to the right [rad]
    v_rate: float  # [m/s]
    omega: float  # [rad/s]


class Stance(NamedTuple):
    """Contacts, constant between events."""

    left: float  # 1 if the pivot is on the ground
    right: float
    bore: float  # pivot whose shear key guides the block: the last one in contact, or NEITHER after rest
    top: float  # pivot diagonally below the corner on which a frame's deck rests; without a deck as ``bore``
