"""A pier on a rigid base whose shaft bends in up to four modes, its state, and a shaft on ground that gives (THEORY.md)."""

from itertools import repeat
from typing import NamedTuple

from rockbatch.core.flexure.modes import PerMode
from rockbatch.core.kernel import hook, inlined
from rockbatch.core.table import get
from rockbatch.core.types import Pull


class FlexibleBlock(NamedTuple):
    """A pier on a rigid base whose shaft bends, per unit mass; ∫φ_i φ_j dm/M of its modes is 1 or 0.

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
    top: float  # height at which drift is read [m]
    tipping: float  # rotation beyond which the pier overturns slowly, below α as its shaft leans out [rad]
    flight_step: float  # longest step in flight, when the modes vibrate fastest [s]
    share: PerMode  # μ_i = ∫φ_i dm/M
    coupling: PerMode  # λ_i = ∫φ_i z dm/M [m]
    frequency: PerMode  # ω_i of the shaft on a fixed base [rad/s]
    damping: PerMode  # 2 ζ_i ω_i [1/s]
    end_shape: PerMode  # φ_i at the highest point
    top_shape: PerMode  # and where drift is read
    pull: Pull | None = None  # of dampers and tendons; None: there are none
    finite: bool = True


class FlexibleTraits(NamedTuple):
    """Traits for which kernels are compiled: the type of this field of a FlexibleBlock."""

    pull: Pull | None = None


SINGLE = FlexibleBlock._fields[: FlexibleBlock._fields.index("share")]
"""Fields of a FlexibleBlock that are one number; those after it, down to ``pull``, have one of each mode."""

PER_MODE = FlexibleBlock._fields[len(SINGLE) : FlexibleBlock._fields.index("pull")]

NUMBERS = tuple(
    (name, float)
    for name in (
        *SINGLE,
        *(f"{name}_{mode}" for name in PER_MODE for mode in PerMode._fields),
    )
)
"""Numbers of a FlexibleBlock that lanes hold."""

Numbers = NamedTuple("Numbers", NUMBERS)  # type: ignore[misc]


@inlined
def model_in(traits, lanes, i):
    """Return the FlexibleBlock of lane ``i``."""
    m = get(lanes.model, i, Numbers)
    return FlexibleBlock(
        m.half_width,
        m.height,
        m.inertia,
        m.gravity,
        m.alpha,
        m.p,
        m.guided,
        m.rest,
        m.deck,
        m.top,
        m.tipping,
        m.flight_step,
        PerMode(m.share_first, m.share_second, m.share_third, m.share_fourth),
        PerMode(m.coupling_first, m.coupling_second, m.coupling_third, m.coupling_fourth),
        PerMode(m.frequency_first, m.frequency_second, m.frequency_third, m.frequency_fourth),
        PerMode(m.damping_first, m.damping_second, m.damping_third, m.damping_fourth),
        PerMode(m.end_shape_first, m.end_shape_second, m.end_shape_third, m.end_shape_fourth),
        PerMode(m.top_shape_first, m.top_shape_second, m.top_shape_third, m.top_shape_fourth),
        traits.pull,
        True,
    )


def numbers_of(m: FlexibleBlock) -> tuple[float, ...]:
    """Return the numbers of ``m`` in the order of :data:`NUMBERS`."""
    values = m._asdict()
    each = [values[name] for name in SINGLE]
    return *each, *(number for name in PER_MODE for number in values[name])


class Flexing(NamedTuple):
    """State of a FlexibleBlock, or of a pier on a footing whose shaft bends; also its rates.

    While a FlexibleBlock rocks, v follows from θ.
    """

    v: float  # rise of the centre of mass of a straight shaft above rest, or above an unstressed bed [m]
    theta: float  # rotation of the base, positive to the right [rad]
    v_rate: float  # [m/s]
    omega: float  # [rad/s]
    u_1: float  # coordinate of a mode [m]
    u_2: float
    u_3: float
    u_4: float
    u_1_rate: float  # [m/s]
    u_2_rate: float
    u_3_rate: float
    u_4_rate: float


class Grounded(NamedTuple):
    """A Stance in a pass, whose piers do not fly."""

    left: float
    right: float
    bore: float
    top: float


class Shaft(NamedTuple):
    """Modes of a shaft that bends on ground that gives, of the pier fixed at its foot; ∫φ_i φ_j dm/M is 1 or 0."""

    share: PerMode  # μ_i = ∫φ_i dm/M
    lever: PerMode  # λ_i − h μ_i = ∫φ_i (z − h) dm/M [m]
    frequency: PerMode  # ω_i [rad/s]
    damping: PerMode  # 2 ζ_i ω_i [1/s]
    end_shape: PerMode  # φ_i at the highest point
    top_shape: PerMode  # where drift is read
    deck_shape: PerMode  # and at the deck
    top: float  # height at which drift is read [m]


OF_MODES = Shaft._fields[: Shaft._fields.index("top")]
"""Fields of a Shaft that have a number of each mode."""

SHAFT_NUMBERS = (*((f"{name}_{mode}", float) for name in OF_MODES for mode in PerMode._fields), ("top", float))

ShaftNumbers = NamedTuple("ShaftNumbers", SHAFT_NUMBERS)  # type: ignore[misc]
"""Numbers of a Shaft that lanes hold."""


def shaft_numbers(shaft: Shaft) -> tuple[float, ...]:
    """Return the numbers of ``shaft`` in the order of ShaftNumbers."""
    return *(number for name in OF_MODES for number in getattr(shaft, name)), shaft.top


LIKE = Shaft(*repeat(PerMode(0.0, 0.0, 0.0, 0.0), len(OF_MODES)), top=0.0)  # type: ignore[arg-type, misc]
"""Trait of all piers whose shafts bend on ground that gives: its value does not matter."""


@hook
def shaft_in(shaft, lanes, i):
    """Return the Shaft of lane ``i``, of the type of ``shaft`` in the traits; None for a rigid one."""


@shaft_in.of(type(None))
def _rigid_shaft(shaft, lanes, i):
    return None


@shaft_in.of(Shaft)
def _bending_shaft(shaft, lanes, i):
    m = get(lanes.shaft, i, ShaftNumbers)
    return Shaft(
        PerMode(m.share_first, m.share_second, m.share_third, m.share_fourth),
        PerMode(m.lever_first, m.lever_second, m.lever_third, m.lever_fourth),
        PerMode(m.frequency_first, m.frequency_second, m.frequency_third, m.frequency_fourth),
        PerMode(m.damping_first, m.damping_second, m.damping_third, m.damping_fourth),
        PerMode(m.end_shape_first, m.end_shape_second, m.end_shape_third, m.end_shape_fourth),
        PerMode(m.top_shape_first, m.top_shape_second, m.top_shape_third, m.top_shape_fourth),
        PerMode(m.deck_shape_first, m.deck_shape_second, m.deck_shape_third, m.deck_shape_fourth),
        m.top,
    )


@hook
def either_in(shaft, part, i, straight, bent):
    """Return lane ``i`` of a part of the table as the named tuple ``straight``, or as ``bent`` if the ``shaft`` bends."""


@either_in.of(type(None))
def _straight_in(shaft, part, i, straight, bent):
    return get(part, i, straight)


@either_in.of(Shaft)
def _bent_in(shaft, part, i, straight, bent):
    return get(part, i, bent)
