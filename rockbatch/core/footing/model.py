"""A pier on a footing, its state and its bed (THEORY.md, A footing)."""

from typing import NamedTuple

import numpy as np

from rockbatch.core.flexure.model import Flexing, Shaft, either_in, shaft_in
from rockbatch.core.kernel import inlined
from rockbatch.core.table import LANES, get
from rockbatch.core.types import Pull

MOST_STRIPS = 160
"""Greatest number of strips of a bed."""

FIRST = 1
"""Row of the node at the left edge: nodes that nothing touches stand on both sides, so that a walk over nodes ends there."""

# Columns of a bed, with a row for each node between strips; sums are those over all nodes to the left of a node
POSITION = 0  # to the right of the middle [m]
SET = 1  # plastic set of the ground under the node [m]
WEIGHT = 2  # share of the area that the pressure at the node stands for
ARM = 3  # and of its static moment [m]
AREA = 4  # share of the area of the strip to the right of the node
WEIGHTS, WEIGHTED_POSITIONS, WEIGHTED_SETS = 5, 6, 7
ARMS, ARMED_POSITIONS, ARMED_SETS = 8, 9, 10

# Columns of the last row, which is no node: first and last node of the Spans found last, from which the next search begins
PRESSED = 0
YIELDING = 2
DEEPEST = 4  # node that was pressed deepest

BEDS = (MOST_STRIPS + FIRST + 3, 11)
"""Shape of a bed."""

BED_OF_LANES = np.dtype(("f8", (LANES, *BEDS)))


class Footing(NamedTuple):
    """A pier on a footing, per unit mass.

    Lanes hold the numbers; the types of the fields after them select code when kernels are compiled.
    """

    half_width: float  # b = B/2 [m]
    height: float  # h [m]
    inertia: float  # I0/M [m²]
    gravity: float  # g [m/s²]
    stiffness: float  # K/M = ω_v², of the whole bed [1/s²]
    strength: float  # Q/M [m/s²]; infinite if the bed is elastic
    damping: float  # C/M = 2ζ ω_v [1/s]
    strips: float  # number of them
    gap: float  # 0 of a bed; above 0 of two separate strips, the share of the width that they have: for tests
    guided: float  # 1: flight goes on, as always on a bed
    rest: float  # velocity that counts as zero [m/s]
    finite: bool | None  # True: finite kinematics; None: first-order
    shifting: (
        bool | None
    )  # True: the lever follows the pressed part, as on two springs, for tests; None: one for all contacts
    bed: np.ndarray  # shape BEDS
    pull: Pull | None = None  # of dampers and tendons; None: there are none
    shaft: Shaft | None = None  # one that bends, in finite kinematics; None: it is rigid


class FootingTraits(NamedTuple):
    """Traits that kernels are compiled for: the types of these fields of Footing; their values do not matter."""

    finite: bool | None
    shifting: bool | None
    shaft: Shaft | None = None
    pull: Pull | None = None


NUMBERS = tuple((name, float) for name in Footing._fields[: Footing._fields.index("finite")])
"""Fields of Footing that lanes hold."""

Numbers = NamedTuple("Numbers", NUMBERS)  # type: ignore[misc]


class State(NamedTuple):
    """State that the equations integrate; also its rates."""

    v: float  # vertical displacement of the centre of mass from an unstressed bed, up [m]
    theta: float  # rotation, positive to the right [rad]
    v_rate: float  # [m/s]
    omega: float  # [rad/s]


@inlined
def state_in(traits, part, i):
    """Return the state in lane ``i`` of a part of the table: a State, or a Flexing if the shaft bends."""
    return either_in(traits.shaft, part, i, State, Flexing)


class Touch(NamedTuple):
    """Contact of the foot at the end of a step; the rates do not depend on it."""

    left: float  # 1 if the left edge is pressed
    right: float
    clear: float  # 1 if the foot is in the air


class Place(NamedTuple):
    """Slot of a lane's bed among those of all lanes, and the time up to which its set is known."""

    slot: float
    time: float  # [s]


@inlined
def model_in(traits, lanes, i):
    """Return the Footing of lane ``i``, with the types of ``traits``, and its bed."""
    m, bed = get(lanes.model, i, Numbers), lanes.beds[int(lanes.bed.slot[i])]
    return Footing(
        m.half_width, m.height, m.inertia, m.gravity, m.stiffness, m.strength, m.damping, m.strips, m.gap, m.guided, m.rest,
        traits.finite, traits.shifting, bed, traits.pull, shaft_in(traits.shaft, lanes, i),
    )  # fmt: skip
