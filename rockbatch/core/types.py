"""The tuples that the scalar functions pass to each other, and the codes they return."""

from typing import NamedTuple

# Spring laws
ELASTIC = 0
BOUC_WEN = 1
EPP = 2

# How a run ended
SURVIVED = 0
OVERTURNED = 1
FLIGHT = 2
CHATTER = 3
NOT_FINITE = 4
UNDECIDED = 5

# Kinds of rows in a history: a sample, the end of a step between samples, or the two sides of an event
SAMPLE = 0
BEFORE_EVENT = -1
STEP = -2
SEPARATION_LEFT = 1
SEPARATION_RIGHT = 2
IMPACT_LEFT = 3
IMPACT_RIGHT = 4
IMPACT_BOTH = 5
SPRING_LEFT = 6
SPRING_RIGHT = 7
HELD_LEFT = 8
HELD_RIGHT = 9
LIFT_OFF = 10
REST = 11


class Springs(NamedTuple):
    """A pier on two springs, per unit mass (symbols: THEORY.md)."""

    half_width: float  # b [m]
    height: float  # h [m]
    inertia: float  # I0/M [m²]
    gravity: float  # g [m/s²]
    yield_deflection: float  # δ_y [m]; the static deflection for elastic springs
    yield_force: float  # F_y/M [m/s²]
    exponent: float  # n of Bouc–Wen
    epsilon: float  # restitution of the landing pivot
    law: int  # ELASTIC, BOUC_WEN or EPP
    finite: bool  # finite kinematics, else first-order
    guided: bool  # flight goes on, else it ends the run


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


class Contact(NamedTuple):
    """What is constant between events: factors of 0 or 1 in one right-hand side."""

    left: float  # the pivot is on its spring
    right: float
    left_yields: float  # the spring is on its inelastic branch
    right_yields: float
    held: int  # pivot that is pressed down while free and lifted while in contact: −1 left, 1 right, 0 none


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
    base_left: float  # unstressed position of each support at the end
    base_right: float
    deepest_left: float  # lowest position of each support
    deepest_right: float
    dissipated_left: float  # plastic work
    dissipated_right: float
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
