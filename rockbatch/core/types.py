"""The tuples that the scalar functions pass to each other, and the codes they return."""

from typing import NamedTuple

# Codes that lanes and histories hold, and those that select a pivot, are floats like all else there: an integer would
# have kernels compiled once more for each type.

# Spring laws
ELASTIC = 0.0
BOUC_WEN = 1.0
EPP = 2.0

# How a run ended
RUNNING = -1  # not yet
SURVIVED = 0
OVERTURNED = 1
FLIGHT = 2
CHATTER = 3
NOT_FINITE = 4
UNDECIDED = 5  # left alone, the pier has stayed where it may yet overturn
GROWING = 6  # left alone, it leans further and further
RESTLESS = 7  # survived, but by its energy later extremes could exceed the peak
LATE_FLIGHT = 8  # survived, and flew when nothing that comes later could exceed the peak

# Kinds of rows in a history: a sample, the end of a step between samples, or the two sides of an event
SAMPLE = 0.0
BEFORE_EVENT = -1.0
STEP = -2.0
SEPARATION_LEFT = 1.0
SEPARATION_RIGHT = 2.0
IMPACT_LEFT = 3.0
IMPACT_RIGHT = 4.0
IMPACT_BOTH = 5.0
SPRING_LEFT = 6.0
SPRING_RIGHT = 7.0
HELD_LEFT = 8.0
HELD_RIGHT = 9.0
LIFT_OFF = 10.0
REST = 11.0

# Pivots
LEFT = -1.0
RIGHT = 1.0
NEITHER = 0.0  # of the corners about which a block could rock: it rests on both


class Pull(NamedTuple):
    """What dampers and tendons do to a pier at one moment, per unit mass."""

    force: float  # Σ F/M, downwards [m/s²]
    moment: float  # Σ F a/M about the centre of mass, to the left [m²/s²]


class Springs(NamedTuple):
    """A pier on two springs, per unit mass (THEORY.md, Symbols).

    The last four are told apart by their types, hence when kernels are compiled: a call of ``pow``, ``sin`` or ``cos``
    in an unused branch would cost the common model, n = 5, first-order and undamped, its vector instructions.
    """

    half_width: float  # b [m]
    height: float  # h [m]
    inertia: float  # I0/M [m²]
    gravity: float  # g [m/s²]
    yield_deflection: float  # δ_y [m]; the static deflection for elastic springs
    stiffness: float  # K/F_y = 1/δ_y [1/m]
    yield_force: float  # F_y/M [m/s²]
    epsilon: float  # restitution of the landing pivot; 1 for damped supports, whose dashpots lose the energy
    damping: float  # C/M = ζ ω_v of each support's dashpot [1/s]
    law: float  # ELASTIC, BOUC_WEN or EPP
    guided: float  # 1: flight goes on, 0: it ends the run
    exponent: float | int | None  # n of Bouc–Wen; None for the paper's 5, int for other whole numbers up to 10
    finite: bool | None  # True: finite kinematics; None: first-order
    damped: bool | None = None  # True: a dashpot beside each spring; None: none
    pull: Pull | None = None  # of dampers and tendons; None: there are none


class Traits(NamedTuple):
    """What kernels are compiled for: the types of these fields of Springs; their values do not matter."""

    exponent: float | int | None
    finite: bool | None
    damped: bool | None


class Block(NamedTuple):
    """A pier on a rigid base."""

    alpha: float  # α [rad]
    p: float  # [rad/s]
    gravity: float  # g [m/s²]
    restitution: float  # e, factor on the angular velocity at an impact


class State(NamedTuple):
    """What the equations integrate; also its rates."""

    v: float  # vertical displacement of the centre of mass from unstressed springs, up [m]
    theta: float  # rotation, positive to the right [rad]
    v_rate: float  # [m/s]
    omega: float  # [rad/s]
    z_left: float  # F_L/F_y, −1..0
    z_right: float


class Rocking(NamedTuple):
    """A block on a rigid base."""

    theta: float  # rotation, positive to the right [rad]
    omega: float  # [rad/s]
    side: float  # corner about which it rocks: LEFT or RIGHT, or NEITHER


class Contact(NamedTuple):
    """What is constant between events: factors of 0 or 1 in one right-hand side."""

    left: float  # the pivot is on its spring
    right: float
    left_yields: float  # the spring is on its inelastic branch
    right_yields: float
    held: float  # pivot that is pressed down while free and lifted while in contact: −1 left, 1 right, 0 none


class Signals(NamedTuple):
    """Four numbers, positive until something happens to a pivot (see ``events``): contacts first, then spring laws."""

    left: float
    right: float
    left_law: float
    right_law: float


class Ground(NamedTuple):
    """Ground acceleration, linear in time from the start of a step."""

    horizontal: float  # [m/s²], positive to the right
    horizontal_slope: float  # [m/s³]
    vertical: float  # [m/s²], positive up
    vertical_slope: float


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
    swing: float  # what H gains when only the right pivot is in contact, and loses when only the left is [m]
    swing_slope: float


class SpringRun(NamedTuple):
    """What a run on springs comes to; SI units, per unit mass."""

    status: int
    t_end: float
    theta_max: float
    t_max: float
    impacts: int
    separations: int
    t_flight: float  # first time of flight; NaN without one
    base_left: float  # unstressed position of each support when residuals are read
    base_right: float
    deepest_left: float  # lowest position of each support
    deepest_right: float
    dissipated_left: float  # plastic work
    dissipated_right: float
    t_read: float  # when residuals are read
    drift_left: float  # by how much each support has moved over the periods that follow, per second; NaN if unknown
    drift_right: float
    t_impact: float  # the last one; NaN without one
    rows: int  # rows of history that were written or would have been


class RigidRun(NamedTuple):
    """What a run on a rigid base comes to."""

    status: int
    t_end: float
    theta_max: float
    t_max: float
    impacts: int
    lift_offs: int
    t_flight: float
    t_rest: float  # when it last came to rest; NaN while it rocks
    rows: int
