"""Lanes of piers on a rigid base: their table, and the start of their runs."""

import math
from typing import NamedTuple

from rockbatch.core import system
from rockbatch.core.block import events, passing  # noqa: F401  hooks of the block
from rockbatch.core.block.ending import set_deadline
from rockbatch.core.block.equations import clearances, constrained, on_side
from rockbatch.core.block.events import resistance
from rockbatch.core.block.model import NUMBERS, Block, BlockTraits, Numbers, Rocking, Stance, Tilt
from rockbatch.core.clock import COMMON, TIMING, include_height
from rockbatch.core.devices.laws import PASSED
from rockbatch.core.kernel import inlined
from rockbatch.core.system import System
from rockbatch.core.table import get, lanes_of, put, taken
from rockbatch.core.types import LEFT, RIGHT, Moment


class Ending(NamedTuple):
    """Numbers that decide when the run is over."""

    longest: float  # sample at which the run ends in any case
    omega: float  # at the last sample since the ground rests, 0 before it [rad/s]
    turned: float  # 1 once the velocity has reversed since then


class Bounds(NamedTuple):
    """Numbers by which the pass bounds the normal force, and the ground acceleration that lifts a block at rest."""

    tangent: float  # tan α
    share: float  # μ/(1+μ)
    sine_squared: float  # sin² α
    radius: float  # R0 [m]
    held_left: float  # acceleration by which devices hold a block at rest on its left pivot [rad/s²], 0 without any
    held_right: float


LANE = lanes_of(
    COMMON
    | {
        "model": Numbers,
        "now": Rocking,
        "end": Tilt,
        "rates": Rocking,
        "contact": Stance,
        "ending": Ending,
        "bounds": Bounds,
    }
)


LINE = (
    *NUMBERS,
    ("theta", float),  # at the start [rad]
    ("omega", float),  # [rad/s]
    *TIMING,
)
"""Fields of the request of a run, with their types."""

Line = NamedTuple("Line", LINE)  # type: ignore[misc]


@inlined
def _model(traits, lanes, i):
    """Return the Block of lane ``i``."""
    m = get(lanes.model, i, Numbers)
    return Block(
        m.half_width,
        m.height,
        m.inertia,
        m.gravity,
        m.alpha,
        m.p,
        m.restitution,
        m.epsilon,
        m.guided,
        m.quickness,
        m.rest,
        m.deck,
        traits.pull,
        True,
    )


@system.pier_in.of(BlockTraits)
def pier_in(traits, lanes, i):
    """Return the Block of lane ``i`` and its Moment, without supports."""
    m, contact = _model(traits, lanes, i), get(lanes.contact, i, Stance)
    y = constrained(m, get(lanes.now, i, Rocking), contact)  # the pass advances θ and its rate only
    return m, Moment(y, contact, None)


@system.in_pass.of(BlockTraits)
def in_pass(traits, lanes, i):
    """Return the Block of lane ``i``, its state and its Stance for a pass with devices, which keeps v and its rate, too."""
    return _model(traits, lanes, i), get(lanes.now, i, Rocking), get(lanes.contact, i, Stance)


@system.begin.of(BlockTraits)
def begin(traits, lanes, i, run):
    """Put the model of ``run`` into lane ``i``, and its start: at rest, or about the pivot to which it leans or moves."""
    alpha, bounds = run.alpha, lanes.bounds
    put(lanes.model, i, taken(run, Numbers))
    size = math.hypot(run.half_width, run.height)
    bounds.tangent[i], bounds.share[i] = run.half_width / run.height, size * run.p * run.p / run.gravity
    bounds.sine_squared[i], bounds.radius[i] = math.sin(alpha) * math.sin(alpha), size
    bounds.held_left[i] = bounds.held_right[i] = 0.0
    at_rest = run.theta == 0.0 and run.omega == 0.0
    leans = run.theta if run.theta != 0.0 else run.omega
    side = RIGHT if leans > 0.0 else LEFT
    contact = Stance(1.0, 1.0, 0.0, 0.0) if at_rest else on_side(side)
    y = constrained(_model(traits, lanes, i), Rocking(0.0, run.theta, 0.0, run.omega), contact)
    put(lanes.now, i, y)
    put(lanes.contact, i, contact)
    set_deadline(lanes, i, run)


@system.take_in_step.of(BlockTraits)
def take_in_step(traits, lanes, i, substep, history):
    """Advance the lane to the end of its sub-step; the driver records the peak."""
    m, contact, now, end = _model(traits, lanes, i), get(lanes.contact, i, Stance), lanes.now, get(lanes.end, i, Tilt)
    put(lanes.now, i, constrained(m, Rocking(now.v[i], end.theta, now.v_rate[i], end.omega), contact))


@system.take_in_part.of(BlockTraits)
def take_in_part(traits, lanes, i, m, part, after):
    """Record the height of flight, and set the lane to the state and stance of the Moment ``after``.

    A frame's deck that lay on both corners as it took off now rests on that to which the block leans.
    """
    if system.airborne(m, part.start.contact):
        start, top = part.start, part.start.contact.top
        include_height(lanes, i, clearances(m, start.y, top), clearances(m, part.end, top), part.length)
    put(lanes.now, i, after.y)
    put(lanes.contact, i, after.contact)
    if after.contact.top == 0.0 and m.deck > 0.0 and system.airborne(m, after.contact) and after.y.theta != 0.0:
        lanes.contact.top[i] = RIGHT if after.y.theta > 0.0 else LEFT  # the deck lay on both corners


@system.note_devices.of(BlockTraits)
def note_devices(traits, lanes, i, devices):
    """Record by how much devices resist the uplift of a block at rest; return True if it is at rest."""
    m, now = pier_in(traits, lanes, i)
    rests = now.contact.left != 0.0 and now.contact.right != 0.0
    if devices is not None:
        put(lanes.now, i, now.y)
    if devices is not None and rests:
        lanes.bounds.held_left[i] = resistance(m, devices, now.y, LEFT)
        lanes.bounds.held_right[i] = resistance(m, devices, now.y, RIGHT)
    return rests


def system_of(m):
    """Return the System of all piers ``m`` (Block), the same whatever their numbers."""
    return System(BlockTraits(), Line, LANE, Rocking._fields + Stance._fields, PASSED)


def line_of(m, theta, omega, *timing):
    """Return the Line of a run of the pier ``m`` (Block); ``timing`` are the fields of Line from ``dt`` on."""
    return Line(*m[:-2], theta, omega, *timing)
