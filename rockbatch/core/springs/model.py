"""A pier on two springs, its state and its contacts (THEORY.md, Symbols)."""

from typing import NamedTuple

from rockbatch.core.flexure.model import Shaft, either_in, shaft_in
from rockbatch.core.kernel import inlined
from rockbatch.core.springs.backbone import Backbone, backbone_in
from rockbatch.core.table import get
from rockbatch.core.types import Pull

# Rules of impact
LANDING = 0.0
HOUSNER = 1.0

IMPACTS = {"landing": LANDING, "housner": HOUSNER}
"""Rules of impact by the names in studies."""


class Springs(NamedTuple):
    """A pier on two springs, per unit mass.

    The types of the last six select code when kernels are compiled: what an unused branch
    computes would slow down the common model, n = 5, first-order and undamped.
    """

    half_width: float  # b [m]
    height: float  # h [m]
    inertia: float  # I0/M [m²]
    gravity: float  # g [m/s²]
    yield_deflection: float  # δ_y [m]; the static deflection of elastic springs, that at the first corner of a backbone
    stiffness: float  # K/F_y = 1/δ_y [1/m]
    yield_force: float  # F_y/M [m/s²]
    epsilon: float  # restitution of the landing pivot; 1 for damped supports, whose dashpots lose the energy
    impact: float  # LANDING, by epsilon, or HOUSNER, by restitution
    restitution: float  # Housner's e, by which θ̇ is multiplied
    damping: float  # C/M = ζ ω_v of each support's dashpot [1/s]
    law: float  # one of CODES in laws.py
    level: float  # v at rest, under the weight and tendons, on first loading [m]
    creep: float  # power of the load with which a spring settles in every small cycle; 0 if it does not ratchet
    guided: float  # 1: flight goes on, 0: it ends the run
    rest: float  # velocity that counts as zero [m/s]
    exponent: float | int | None  # n of Bouc–Wen; None for the paper's 5, int for other whole numbers up to 10
    finite: bool | None  # True: finite kinematics; None: first-order
    damped: bool | None = None  # True: a dashpot beside each spring; None: none
    pull: Pull | None = None  # of dampers and tendons; None: there are none
    shaft: Shaft | None = None  # one that bends, in finite kinematics on damped supports; None: it is rigid
    backbone: Backbone | None = None  # of springs that are given by points; None: the law has none


class SpringTraits(NamedTuple):
    """Traits for which kernels are compiled: the types of these fields of Springs; their values do not matter."""

    exponent: float | int | None
    finite: bool | None
    damped: bool | None
    shaft: Shaft | None = None
    pull: Pull | None = None
    backbone: Backbone | None = None


NUMBERS = tuple((name, float) for name in Springs._fields[: Springs._fields.index("finite")])
"""Fields of Springs that lanes hold."""

Numbers = NamedTuple("Numbers", NUMBERS)  # type: ignore[misc]


@inlined
def _typed(exponent, value):
    """Return ``value`` in the type of ``exponent``: int, float or None."""
    if isinstance(exponent, int):
        return int(value)
    if isinstance(exponent, float):
        return value
    return None


@inlined
def model_in(traits, lanes, i):
    """Return the Springs of lane ``i``, with the types of ``traits``."""
    m = get(lanes.model, i, Numbers)
    return Springs(
        m.half_width,
        m.height,
        m.inertia,
        m.gravity,
        m.yield_deflection,
        m.stiffness,
        m.yield_force,
        m.epsilon,
        m.impact,
        m.restitution,
        m.damping,
        m.law,
        m.level,
        m.creep,
        m.guided,
        m.rest,
        _typed(traits.exponent, m.exponent),
        traits.finite,
        traits.damped,
        traits.pull,
        shaft_in(traits.shaft, lanes, i),
        backbone_in(traits.backbone, lanes, i),
    )


class State(NamedTuple):
    """State that the equations integrate; also its rates."""

    v: float  # vertical displacement of the centre of mass from unstressed springs, up [m]
    theta: float  # rotation, positive to the right [rad]
    v_rate: float  # [m/s]
    omega: float  # [rad/s]
    z_left: float  # F_L/F_y, −1..0, and below with a backbone
    z_right: float


class BentState(NamedTuple):
    """State of a pier whose shaft bends: that of the straight one, v of its centre of mass, and the coordinates of modes."""

    v: float
    theta: float
    v_rate: float
    omega: float
    z_left: float
    z_right: float
    u_1: float  # coordinate of a mode [m]
    u_2: float
    u_3: float
    u_4: float
    u_1_rate: float  # [m/s]
    u_2_rate: float
    u_3_rate: float
    u_4_rate: float


@inlined
def state_in(traits, part, i):
    """Return the state in lane ``i`` of a part of the table: a State, or a BentState if the shaft bends."""
    return either_in(traits.shaft, part, i, State, BentState)


class Contact(NamedTuple):
    """Contacts, constant between events: factors of 0 or 1 in one right-hand side."""

    left: float  # the pivot is on its spring
    right: float
    left_yields: float  # 1 if the spring is on its inelastic branch; with a backbone the number of that branch
    right_yields: float
    held: (
        float  # pivot in grazing contact, pressed down while free and lifted while in contact: −1 left, 1 right, 0 none
    )


class Supports(NamedTuple):
    """State of the supports that is constant between events."""

    left: float  # unstressed position of the support of a free pivot [m]; without meaning in contact
    right: float
    yield_left: float = -1.0  # yield point: z at which the elastic branch ends, if the law has one
    yield_right: float = -1.0


class Geometry(NamedTuple):
    """The pivots at a rotation θ. Index i is left or right; v_i is a pivot's vertical displacement."""

    lift_left: float  # v_i − v [m]
    lift_right: float
    arm_left: float  # ∂v_i/∂θ [m]
    arm_right: float
    bend_left: float  # ∂²v_i/∂θ² [m]
    bend_right: float
    moment_left: float  # arm of the spring force about the centre of mass [m]
    moment_right: float
    lever: float  # H in full contact [m]
    lever_slope: float  # dH/dθ [m]
    swing: float  # increase of H with only the right pivot in contact, decrease with only the left [m]
    swing_slope: float
