"""Codes and named tuples that all systems share: ground, pull of devices, moments, transitions, results."""

from typing import NamedTuple

# Codes in lanes and histories, and those of pivots, are floats like all numbers there: kernels would be compiled again for
# integers.

# Status of a run
RUNNING = -1  # not yet over
SURVIVED = 0
OVERTURNED = 1
FLIGHT = 2
CHATTER = 3
NOT_FINITE = 4
UNDECIDED = 5  # after the record the pier stayed at a rotation from which it may still overturn
GROWING = 6  # after the record it leaned further and further
RESTLESS = 7  # survived, but by its energy later extremes could exceed the peak
LATE_FLIGHT = 8  # survived, and flew when nothing could exceed the peak any more

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
TAKE_OFF = 12.0
DECK = 13.0  # of a frame in flight changes the corners on which it rests

# Pivots
LEFT = -1.0
RIGHT = 1.0
NEITHER = 0.0

# Indices of the event functions of a pier; those of devices follow
CONTACT_LEFT = 0
CONTACT_RIGHT = 1
LAW_LEFT = 2
LAW_RIGHT = 3
OF_PIER = 4
NO_EVENT = -1


class Pull(NamedTuple):
    """Force and moment of dampers and tendons on a pier at one moment, per unit mass."""

    force: float  # Σ F ∂e/∂v /M, downwards [m/s²]
    moment: float  # Σ F ∂e/∂θ /M, to the left [m²/s²]


class Ground(NamedTuple):
    """Ground acceleration, linear in time from the start of a step."""

    horizontal: float  # [m/s²], positive to the right
    horizontal_slope: float  # [m/s³]
    vertical: float  # [m/s²], positive up
    vertical_slope: float


class Moment(NamedTuple):
    """State of a pier at one moment, with its contacts and supports, which are constant between events."""

    y: tuple  # state
    contact: tuple
    supports: tuple | None  # positions of supports without their pivots, and yield points; None without springs


class Instant(NamedTuple):
    """A Moment with the rates of its state and the ground: the arguments of a step and of event functions."""

    y: tuple
    k: tuple  # rates
    contact: tuple
    supports: tuple | None
    ground: Ground


class Part(NamedTuple):
    """A smooth part of a sub-step: up to an event, to the end of a step that devices shorten, or to that of the sub-step."""

    start: Moment
    end: tuple  # state before the event
    length: float  # [s]


class Transition(NamedTuple):
    """Result of an event of a pier."""

    now: Moment  # after it
    kind: float  # in a history
    impacts: float  # number of impacts to count
    uplifts: float
    remaining: float  # duration [s] of an infinite sequence of bounces that is summed up; else 0


class Signals(NamedTuple):
    """Event functions of a pier, each positive until its event at a pivot; or their slopes."""

    left: float
    right: float
    left_law: float
    right_law: float


class Result(NamedTuple):
    """Result of a run; SI units, per unit mass. NaN or 0 for results that a system does not have."""

    status: int
    t_end: float
    theta_max: float
    t_max: float
    theta_in_motion: float  # greatest |θ| until the record's last sample; NaN of a run that ended before it
    impacts: int
    uplifts: int  # separations of pivots, or lift-offs from rest
    t_flight: float  # first time of flight; NaN without one
    flights: int
    flight_duration: float  # of all flights [s]
    flight_height: float  # greatest, of the lower pivot above its support [m]
    t_impact: float  # of the last impact; NaN without one
    t_rest: float  # when the pier last came to rest; NaN while it moves
    base_left: float  # unstressed position of each support when residuals are read; of a footing the edges' plastic set
    base_right: float
    deepest_left: float  # lowest position of each support
    deepest_right: float
    dissipated_left: float  # plastic work
    dissipated_right: float
    t_read: float  # when residuals are read
    drift_left: float  # mean velocity of each support between both readings; NaN if unknown
    drift_right: float
    v_end: float  # [m]
    theta_end: float  # [rad]
    deflection_max: float  # greatest deflection of the top of a shaft that bends [m]
    drift_max: float  # greatest horizontal displacement of that top
    bed_tilt: float  # tilt of the plastic set of a footing's bed at the end [rad]
    lean: float  # rotation at which the pier rests on that bed [rad]
    settled: float  # by which the middle of the foot is then deeper than on an unyielded bed [m]
    contact_least: float  # least share of a footing that was pressed
    bed_pressure: float  # greatest pressure at an edge of a footing, times its area over the mass [m/s²]
    t_pressure: float
    pressure_side: float  # LEFT, RIGHT or NEITHER
    bed_force: float  # greatest push of a footing's bed [m/s²]
    t_force: float
    yielding_rocks: float  # rocks to one side in which the ground under a footing has yielded
    t_yield: float  # when it first did [s]
    repeated: int  # sub-steps integrated event by event, not by the pass
    rows: int  # rows of history that were written or would have been
