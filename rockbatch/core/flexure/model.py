"""A pier on a rigid base whose shaft bends in one mode, and its state (THEORY.md, A shaft that bends)."""

from typing import NamedTuple

from rockbatch.core.types import Pull


class FlexibleBlock(NamedTuple):
    """A pier on a rigid base whose shaft bends, per unit mass; the mode's shape φ is 1 at the top.

    The fields down to ``deck`` are those of a Block.
    """

    half_width: float  # b [m]
    height: float  # h [m]
    inertia: float  # I0/M [m²]
    gravity: float  # g [m/s²]
    alpha: float  # α [rad]
    p: float  # [rad/s]
    guided: float  # 1: flight goes on, 0: it ends the run
    rest: float  # velocity that counts as zero [m/s]
    deck: float  # 0: no frame
    first: float  # μ1 = ∫φ dm/M
    second: float  # μ2 = ∫φ² dm/M
    coupling: float  # λ = ∫φ z dm/M [m]
    frequency: float  # ω_f of the shaft on a fixed base [rad/s]
    damping: float  # 2 ζ_f ω_f [1/s]
    top: float  # height at which drift is read [m]
    top_shape: float  # φ there
    tipping: float  # rotation beyond which the pier overturns slowly, below α as its shaft leans out [rad]
    flight_step: float  # longest step in flight, when the mode vibrates fastest [s]
    pull: Pull | None = None  # of dampers and tendons; None: there are none
    finite: bool = True


class FlexibleTraits(NamedTuple):
    """Traits for which kernels are compiled: the type of this field of a FlexibleBlock."""

    pull: Pull | None = None


NUMBERS = tuple((name, float) for name in FlexibleBlock._fields[: FlexibleBlock._fields.index("pull")])
"""Fields of a FlexibleBlock that lanes hold."""

Numbers = NamedTuple("Numbers", NUMBERS)  # type: ignore[misc]


class Flexing(NamedTuple):
    """State of a FlexibleBlock; also its rates. While it rocks, v follows from θ."""

    v: float  # rise of the centre of mass of a straight shaft above rest [m]
    theta: float  # rotation of the base, positive to the right [rad]
    v_rate: float  # [m/s]
    omega: float  # [rad/s]
    u: float  # deflection of the top across the shaft [m], positive to the right
    u_rate: float  # [m/s]
