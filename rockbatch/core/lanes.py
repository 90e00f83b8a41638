"""A lane: all that a run on springs is while it is under way, by names; and a table of them, side by side.

The table is one record. Each of its fields holds one number for each lane, so that what a loop over lanes touches lies
side by side and at constant distances: the compiler can take several lanes with one instruction.
"""

from typing import NamedTuple

import numpy as np

from rockbatch.core.kernel import inlined, kernel
from rockbatch.core.loading import Loading
from rockbatch.core.records import LANES
from rockbatch.core.transitions import Supports
from rockbatch.core.types import Contact, Ground, Signals, Springs, State

# What may be new in a lane after a pass
CALM = 0  # a step further, and nothing else
ATTEND = 1  # a step further; the work of a branch or an extreme inside the step is to be looked at
DUE = 2  # likewise, and at a sample at which more is due
EVENTFUL = 3  # something may have happened: the piece ends in ``now``, but has not been accepted
TURNED = 4  # likewise, and what happened first is surely that a spring's velocity turned, too sharply to be corrected

# Verdicts on a piece of a step, besides the numbers of events (``transitions``)
ACCEPT = -1
SEARCH = -2

LOST = -1.0  # of a time in a piece or a sample: there is none


class Turns(NamedTuple):
    """Reversals in the last step that the pass has corrected: when [s] in it, LOST without one, and z then."""

    left: float
    right: float
    z_left: float
    z_right: float


class Clock(NamedTuple):
    """Where a run is: samples, steps of a sample, and pieces of a step if an event has cut it."""

    dt: float  # sampling interval [s]
    step: float  # h [s]
    substeps: float  # steps per sample
    sample: float  # number of the last sample
    sample_time: float  # of the last sample [s]
    substep: float  # steps since the last sample
    start: float  # of the present piece, since the last sample [s]
    length: float  # of the present piece [s]
    done: float  # of the step, when the present piece is what an event has left of it [s]
    began: float  # start and length of the piece that was taken last
    took: float
    due: float  # number of the sample at which something else than the next step is due


class Extremes(NamedTuple):
    """What has been reached so far."""

    peak: float  # greatest |θ| [rad]
    peak_time: float  # [s]
    lowest_left: float  # positions of the pivots on their springs [m]
    lowest_right: float
    window: float  # of the run, in which it is (``outcome``)
    next_window: float  # sample with which the next one begins
    in_window: float  # greatest |θ| at a sample of this one [rad]
    new: float  # 1: the last piece may hold a new one between its ends


class Counts(NamedTuple):
    """What has happened so far."""

    impacts: float
    separations: float
    in_sample: float  # events since sample ``counted``
    counted: float
    flight_time: float  # first time of flight [s]; NaN without one
    impact_time: float  # of the last impact [s]; NaN without one
    moved: float  # time at which a pivot last left the ground or landed [s]


class Motion(NamedTuple):
    """Where a run comes from, and what is constant in it besides its model."""

    number: float  # of the run
    first_row: float  # of the motion among the ground's rows
    npts: float
    alpha: float  # slenderness [rad]
    rest: float  # velocity that counts as none [m/s]
    plastic: float  # unstressed position of both supports at the start [m]


class Waiting(NamedTuple):
    """When a run is over (``ending``)."""

    samples: float  # of record and quiet time
    earliest: float  # sample from which on residuals may be read
    patience: float  # samples that a pier is waited for at most
    longest: float  # sample at which waiting ends
    read_wait: float  # samples between two readings; 0 where there is nothing to read twice
    decided_at: float  # sample from which on nothing can exceed the peak, LOST before it
    read: float  # sample of the first reading, LOST before it
    read_left: float  # unstressed positions of both supports then [m]
    read_right: float
    last_read: float  # likewise, of the last one
    last_left: float
    last_right: float
    drift_left: float  # of both supports from the first reading to the second [m/s], NaN before it
    drift_right: float
    last_drift_left: float  # likewise, between the last two, 0 before them
    last_drift_right: float
    midway: float  # greatest |θ| when half of the waiting is over [rad]
    midway_tilt: float  # |tilt| of the base then [rad]
    load: float  # what the supports carry at rest, the weight and what tendons add to it [m/s²]
    stored: float  # energy that tendons may give back, beyond what they do at that load [J/kg]


def _lanes(tuple_type, without=()):
    """A record with a field of LANES numbers for each field of ``tuple_type``."""
    return np.dtype([(name, "f8", LANES) for name in tuple_type._fields if name not in without])


_MOMENT = np.dtype([("at", "f8", LANES), ("values", _lanes(Signals)), ("slopes", _lanes(Signals))])

LANE = np.dtype([
    ("model", _lanes(Springs, without=("finite", "damped", "pull"))),
    ("motion", _lanes(Motion)),
    ("clock", _lanes(Clock)),
    ("now", _lanes(State)),
    ("rates", _lanes(State)),
    ("before", _lanes(State)),  # at the start of the last piece
    ("before_rates", _lanes(State)),
    ("contact", _lanes(Contact)),
    ("supports", _lanes(Supports)),
    ("loading", _lanes(Loading)),
    ("turns", _lanes(Turns)),
    ("ground", _lanes(Ground)),  # at the last sample
    ("extremes", _lanes(Extremes)),
    ("counts", _lanes(Counts)),
    ("waiting", _lanes(Waiting)),
    ("watched", "f8", LANES),  # above 0 where the piece shall be looked at whatever the pass makes of it
    ("news", "i8", LANES),  # what the pass has to say
    ("verdict", "i8", LANES),  # on the piece that is being taken: SEARCH, ACCEPT, or the number of the event at its end
    ("trial", "i8", LANES),  # how many pieces were tried in a search
    ("early", _MOMENT),  # latest moment of the piece before the event, [s] since its start
    ("late", _MOMENT),  # earliest moment after it
])  # fmt: skip


def table():
    """An empty table of lanes, and the same memory as cells that a lane's number takes every LANES-th of."""
    made = np.zeros(1, LANE).view(np.recarray)
    return made, made.view(np.ndarray).view(np.float64)


@kernel
def move(cells, i, j):
    """What is in lane ``i`` into lane ``j``."""
    for at in range(0, len(cells), LANES):
        cells[at + j] = cells[at + i]


@inlined
def model_of(lanes, i, traits):
    """Springs of lane ``i``, of the types that ``traits`` tell (see :class:`Springs`)."""
    m = lanes.model
    return Springs(
        m.half_width[i], m.height[i], m.inertia[i], m.gravity[i], m.yield_deflection[i], m.stiffness[i],
        m.yield_force[i], m.epsilon[i], m.damping[i], m.law[i], m.guided[i], _typed(traits.exponent, m.exponent[i]),
        traits.finite, traits.damped, None,
    )  # fmt: skip


@inlined
def _typed(exponent, value):
    if isinstance(exponent, int):
        return int(value)
    if isinstance(exponent, float):
        return value
    return None


@inlined
def state(of, i):
    """The State in lane ``i`` of a record of states, such as ``lanes.now``."""
    return State(of.v[i], of.theta[i], of.v_rate[i], of.omega[i], of.z_left[i], of.z_right[i])


@inlined
def put_state(of, i, y):
    of.v[i] = y.v
    of.theta[i] = y.theta
    of.v_rate[i] = y.v_rate
    of.omega[i] = y.omega
    of.z_left[i] = y.z_left
    of.z_right[i] = y.z_right


@inlined
def contact_of(lanes, i):
    at = lanes.contact
    return Contact(at.left[i], at.right[i], at.left_yields[i], at.right_yields[i], at.held[i])


@kernel
def put_contact(lanes, i, contact, supports):
    at = lanes.contact
    at.left[i] = contact.left
    at.right[i] = contact.right
    at.left_yields[i] = contact.left_yields
    at.right_yields[i] = contact.right_yields
    at.held[i] = contact.held
    lanes.supports.left[i] = supports.left
    lanes.supports.right[i] = supports.right


@kernel
def supports_of(lanes, i):
    return Supports(lanes.supports.left[i], lanes.supports.right[i])


@kernel
def loading_of(lanes, i):
    at = lanes.loading
    return Loading(at.left[i], at.z_left[i], at.work_left[i], at.right[i], at.z_right[i], at.work_right[i])


@kernel
def put_loading(lanes, i, loading):
    at = lanes.loading
    at.left[i] = loading.left
    at.z_left[i] = loading.z_left
    at.work_left[i] = loading.work_left
    at.right[i] = loading.right
    at.z_right[i] = loading.z_right
    at.work_right[i] = loading.work_right


@inlined
def ground_of(lanes, i, x):
    """Ground at ``x`` [s] after the sample."""
    at = lanes.ground
    a_slope, c_slope = at.horizontal_slope[i], at.vertical_slope[i]
    return Ground(at.horizontal[i] + x * a_slope, a_slope, at.vertical[i] + x * c_slope, c_slope)


@kernel
def signals_in(moment, i):
    """Values and slopes of the signals at the moment that a search keeps in lane ``i``."""
    v, s = moment.values, moment.slopes
    return Signals(v.left[i], v.right[i], v.left_law[i], v.right_law[i]), Signals(
        s.left[i], s.right[i], s.left_law[i], s.right_law[i]
    )


@kernel
def put_signals(moment, i, at, values, slopes):
    moment.at[i] = at
    v, s = moment.values, moment.slopes
    v.left[i], v.right[i], v.left_law[i], v.right_law[i] = values.left, values.right, values.left_law, values.right_law
    s.left[i], s.right[i], s.left_law[i], s.right_law[i] = slopes.left, slopes.right, slopes.left_law, slopes.right_law
