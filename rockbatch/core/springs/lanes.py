"""Lanes of piers on springs: their table, and the start and the results of their runs."""

from typing import NamedTuple

from rockbatch.core import system
from rockbatch.core.clock import COMMON, TIMING, ground_at, include_height
from rockbatch.core.devices.laws import PASSED
from rockbatch.core.flexure.displacements import Displacements
from rockbatch.core.flexure.model import LIKE, SHAFT_NUMBERS, ShaftNumbers, shaft_numbers
from rockbatch.core.flexure.shaft import begin_displacements, begin_shaft, include_bending, write_displacements
from rockbatch.core.ground import later
from rockbatch.core.history import Stamp, write
from rockbatch.core.kernel import inlined, kernel
from rockbatch.core.rk4 import rk4
from rockbatch.core.roots import lowest_within
from rockbatch.core.springs import events  # noqa: F401  hooks of the springs
from rockbatch.core.springs.backbone import LIKE as LIKE_BACKBONE
from rockbatch.core.springs.backbone import NUMBERS as BACKBONE_NUMBERS
from rockbatch.core.springs.backbone import Backbone, begin_backbone
from rockbatch.core.springs.bending import at_start
from rockbatch.core.springs.ending import Waiting, base_of, set_deadline
from rockbatch.core.springs.equations import clearances
from rockbatch.core.springs.laws import branch_at_first, first_point, yield_point, yields_when_pressed
from rockbatch.core.springs.loading import BranchChange, Loading, branch_change, branches
from rockbatch.core.springs.model import (
    NUMBERS,
    BentState,
    Contact,
    Numbers,
    SpringTraits,
    State,
    Supports,
    model_in,
    state_in,
)
from rockbatch.core.springs.passing import Reversals
from rockbatch.core.springs.reversal import pivots
from rockbatch.core.springs.transitions import with_yield_points
from rockbatch.core.system import System, rates
from rockbatch.core.table import get, lanes_of, put, taken
from rockbatch.core.types import BEFORE_EVENT, SPRING_LEFT, SPRING_RIGHT, Instant, Moment, Part


class Lowest(NamedTuple):
    """Lowest positions of the pivots on their springs."""

    left: float  # [m]
    right: float
    plastic: float  # unstressed position of both supports at the start [m]


LANE_PARTS = COMMON | {
    "model": Numbers,
    "now": State,
    "end": State,
    "rates": State,
    "contact": Contact,
    "supports": Supports,
    "loading": Loading,
    "lowest": Lowest,
    "reversals": Reversals,
    "waiting": Waiting,
}

LANE = lanes_of(LANE_PARTS)


BENDING_LANE = lanes_of(
    LANE_PARTS | dict.fromkeys(("now", "end", "rates"), BentState) | {"shaft": ShaftNumbers, "displaced": Displacements}
)
"""A table of piers whose shafts bend."""

BACKBONE_LANE = lanes_of(COMMON | {"backbone": Backbone} | LANE_PARTS)
"""A table of piers on springs with a backbone, which is not at its end: Numba would take it for a LANE."""


LINE = (
    *NUMBERS,
    *TIMING,
    ("read_after", float),  # samples from the end of the record to the first reading of residuals
    ("read_wait", float),  # samples on to the second reading, which gives their drift; 0 if the springs do not yield
    ("prestress", float),  # of tendons, over the mass [m/s²]
    ("v", float),  # state at the start [m] of a pier that is held at a rotation
    ("theta", float),  # [rad]; 0 for the static state
    ("z_left", float),
    ("z_right", float),
)
"""Fields of the request of a run, with their types."""

Line = NamedTuple("Line", LINE)  # type: ignore[misc]

BendingLine = NamedTuple("BendingLine", (*LINE, *SHAFT_NUMBERS))  # type: ignore[misc]

BackboneLine = NamedTuple("BackboneLine", (*LINE, *BACKBONE_NUMBERS))  # type: ignore[misc]


@system.pier_in.of(SpringTraits)
def pier_in(traits, lanes, i):
    """Return the Springs of lane ``i`` and its Moment."""
    now = Moment(state_in(traits, lanes.now, i), get(lanes.contact, i, Contact), get(lanes.supports, i, Supports))
    return model_in(traits, lanes, i), now


@inlined
def _put_moment(lanes, i, now):
    put(lanes.now, i, now.y)
    put(lanes.contact, i, now.contact)
    put(lanes.supports, i, now.supports)


@kernel
def static_state(m, load):
    """Return the state at rest under the ``load`` [m/s²] of weight and tendons, z = −(1 + ψ)/η in first loading."""
    force = 0.5 * load / m.yield_force
    return State(m.level, 0.0, 0.0, 0.0, -force, -force)


@kernel
def static_contact(m, y):
    """Return contacts and supports in the static state ``y``."""
    branch = branch_at_first(m, y.z_left)
    point = yield_point(m.law, first_point(m.law), y.z_left)
    return Contact(1.0, 1.0, branch, branch, 0.0), Supports(0.0, 0.0, point, point)


@kernel
def held_contact(m, y, z_static, plastic):
    """Return contacts and supports at the release in state ``y``, to which the pier was pulled from the static one.

    The lifted side is compressed next, and the compressed one unloaded; a support without its pivot is unstressed at
    ``plastic`` [m].
    """
    pressed, left, right = yields_when_pressed(m.law), y.z_left < 0.0, y.z_right < 0.0
    left_yields = pressed if left and y.theta > 0.0 else 0.0
    right_yields = pressed if right and y.theta < 0.0 else 0.0
    point = yield_point(m.law, first_point(m.law), z_static)
    supports = Supports(plastic, plastic, yield_point(m.law, point, y.z_left), yield_point(m.law, point, y.z_right))
    return Contact(1.0 if left else 0.0, 1.0 if right else 0.0, left_yields, right_yields, 0.0), supports


@system.begin.of(SpringTraits)
def begin(traits, lanes, i, run):
    """Set the model of ``run`` in lane ``i``, and its state: static, or held at a rotation."""
    put(lanes.model, i, taken(run, Numbers))
    begin_shaft(traits.shaft, lanes, i, run)
    begin_backbone(traits.backbone, lanes, i, run)
    pier = model_in(traits, lanes, i)
    y = static_state(pier, run.gravity + run.prestress)
    level, plastic = y.v, y.v - run.yield_deflection * y.z_left
    contact, supports = static_contact(pier, y)
    if run.theta != 0.0:
        z_static, y = y.z_left, State(run.v, run.theta, 0.0, 0.0, run.z_left, run.z_right)
        contact, supports = held_contact(pier, y, z_static, plastic)
    left, right = pivots(pier, y)
    unstressed_left = left.position - run.yield_deflection * y.z_left
    unstressed_right = right.position - run.yield_deflection * y.z_right
    bent = at_start(pier.shaft, pier, y)
    _put_moment(lanes, i, Moment(bent, contact, supports))
    begin_displacements(traits.shaft, lanes, i, bent)
    put(lanes.loading, i, Loading(unstressed_left, y.z_left, 0.0, unstressed_right, y.z_right, 0.0))
    put(lanes.lowest, i, Lowest(min(level, left.position), min(level, right.position), plastic))
    set_deadline(lanes, i, pier, run)


@inlined
def _include_extremes(lanes, i, m, part):
    """Include a Part in the height of flight, the lowest positions of pivots in contact, and displacements of a bent shaft."""
    (y, contact, supports), end, h = part
    include_bending(m.shaft, lanes, i, part)
    if system.airborne(m, contact):
        include_height(lanes, i, clearances(m, y, supports), clearances(m, end, supports), h)
    left, right = pivots(m, y)
    left_end, right_end = pivots(m, end)
    lowest = lanes.lowest
    if contact.left != 0.0:
        lowest.left[i] = lowest_within(
            left.position, left.velocity, left_end.position, left_end.velocity, h, lowest.left[i]
        )
    if contact.right != 0.0:
        lowest.right[i] = lowest_within(
            right.position, right.velocity, right_end.position, right_end.velocity, h, lowest.right[i]
        )


@system.take_in_part.of(SpringTraits)
def take_in_part(traits, lanes, i, m, part, after):
    """Set lane ``i`` to the Moment ``after`` a Part and its event.

    Record extremes, the starts of the springs' branches, and the plastic work of those that have ended.
    """
    _include_extremes(lanes, i, m, part)
    loading, before = get(lanes.loading, i, Loading), part.start.contact
    put(lanes.loading, i, branches(m, loading, before, after.contact, branch_change(m, after.y)))
    _put_moment(lanes, i, after)


@system.take_in_step.of(SpringTraits)
def take_in_step(traits, lanes, i, substep, history):
    """Record extremes and reversals of a sub-step of lane ``i`` that stands, and advance the lane to its end."""
    m, now = pier_in(traits, lanes, i)
    end = state_in(traits, lanes.end, i)
    _include_extremes(lanes, i, m, Part(now, end, lanes.clock.step[i]))
    if lanes.reversals.keeps[i] < 0.0:
        _change_branches(lanes, i, m, now, substep, history)
    put(lanes.now, i, end)


@kernel
def _change_branches(lanes, i, m, now, substep, history):
    """Change the branches of the springs of lane ``i`` whose velocities reversed in its sub-step, and write their rows."""
    before, at, reversals = now.contact, get(lanes.reversals, i, BranchChange), lanes.reversals
    left, right = before.left_yields, before.right_yields
    left_after = 1.0 - left if reversals.left[i] >= 0.0 else left
    right_after = 1.0 - right if reversals.right[i] >= 0.0 else right
    after = Contact(before.left, before.right, left_after, right_after, 0.0)
    if history.rows.shape[0] > 0:
        _write_reversals(lanes, i, m, now, substep, after, history)
    put(lanes.contact, i, after)
    put(lanes.loading, i, branches(m, get(lanes.loading, i, Loading), before, after, at))
    put(lanes.supports, i, with_yield_points(m, at, before, after, now.supports))


@system.finish.of(SpringTraits)
def finish(traits, lanes, i, t, result):
    """Write residuals, extremes and plastic work of the run in lane ``i``; those never read are as at the end, ``t`` [s]."""
    m, now = pier_in(traits, lanes, i)
    waiting, lowest = lanes.waiting, lanes.lowest
    t_read, base_left, base_right = waiting.read[i] * lanes.clock.dt[i], waiting.read_left[i], waiting.read_right[i]
    if waiting.read[i] < 0.0:
        t_read = t
        base_left, base_right = base_of(m, now)
    on_no_branch, loading = Contact(0.0, 0.0, 0.0, 0.0, 0.0), get(lanes.loading, i, Loading)
    loading = branches(m, loading, now.contact, on_no_branch, branch_change(m, now.y))
    result.base_left = base_left - lowest.plastic[i]
    result.base_right = base_right - lowest.plastic[i]
    result.deepest_left = lowest.left[i]
    result.deepest_right = lowest.right[i]
    result.dissipated_left = m.yield_force * loading.work_left
    result.dissipated_right = m.yield_force * loading.work_right
    result.t_read = t_read
    result.drift_left = waiting.drift_left[i]
    result.drift_right = waiting.drift_right[i]
    write_displacements(traits.shaft, lanes, i, result)


@kernel
def _write_reversals(lanes, i, m, now, substep, after, history):
    """Write rows before and after each reversal that leads to the contact ``after`` the sub-step of lane ``i``."""
    start, number = substep * lanes.clock.step[i], int(lanes.clock.number[i])
    t, ground = lanes.clock.sample[i] * lanes.clock.dt[i] + start, ground_at(lanes, i, start)
    y, contact, supports = now
    left, right, at = lanes.reversals.left[i], lanes.reversals.right[i], 0.0
    for _ in range(2):
        of_left = left >= 0.0 and (right < 0.0 or left <= right)
        when = left if of_left else right
        if when < 0.0:
            return
        k = rates(m, y, contact, ground)
        y = rk4(m, None, Instant(y, k, contact, supports, ground), when - at)
        write(history, Stamp(number, t + when, BEFORE_EVENT), m, None, Moment(y, contact, supports), ground)
        if of_left:
            contact = Contact(contact.left, contact.right, after.left_yields, contact.right_yields, 0.0)
            left = -1.0
        else:
            contact = Contact(contact.left, contact.right, contact.left_yields, after.right_yields, 0.0)
            right = -1.0
        kind = SPRING_LEFT if of_left else SPRING_RIGHT
        write(history, Stamp(number, t + when, kind), m, None, Moment(y, contact, supports), ground)
        ground, at = later(ground, when - at), when


def system_of(m):
    """Return the System of the pier ``m`` (Springs): equal for piers with fields of the same types, whatever their numbers."""
    traits, columns = SpringTraits(m.exponent, m.finite, m.damped), State._fields + Contact._fields
    if m.backbone is not None:
        return System(traits._replace(backbone=LIKE_BACKBONE), BackboneLine, BACKBONE_LANE, columns, PASSED)
    if m.shaft is None:
        return System(traits, Line, LANE, columns, PASSED)
    return System(traits._replace(shaft=LIKE), BendingLine, BENDING_LANE, BentState._fields + Contact._fields, PASSED)


def line_of(m, *timing):
    """Return the Line of a run of the pier ``m`` (Springs); ``timing`` are the fields of Line from ``dt`` on."""
    exponent = 5.0 if m.exponent is None else float(m.exponent)
    numbers = *m[: m._fields.index("exponent")], exponent, *timing
    if m.backbone is not None:
        return BackboneLine(*numbers, *m.backbone)
    return Line(*numbers) if m.shaft is None else BendingLine(*numbers, *shaft_numbers(m.shaft))
