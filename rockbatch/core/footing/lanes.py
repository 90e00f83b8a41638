"""Lanes of piers on a footing: their table, and the start, the steps and the results of their runs."""

import math
from typing import NamedTuple

from rockbatch.core import system
from rockbatch.core.clock import (
    CALM,
    COMMON,
    EVENTFUL,
    ON_ITS_SIDE,
    TIMING,
    Clearances,
    ground_at,
    include_height,
    include_peak,
    note_flight,
)
from rockbatch.core.flexure.displacements import Displacements
from rockbatch.core.flexure.model import LIKE, SHAFT_NUMBERS, Flexing, ShaftNumbers, shaft_numbers
from rockbatch.core.flexure.shaft import begin_displacements, begin_shaft, include_bending, write_displacements
from rockbatch.core.footing.ending import Ending, set_deadline
from rockbatch.core.footing.equations import at_rest, rates_under
from rockbatch.core.footing.model import (
    BED_OF_LANES,
    FIRST,
    NUMBERS,
    POSITION,
    SET,
    FootingTraits,
    Numbers,
    Place,
    State,
    Touch,
    model_in,
    state_in,
)
from rockbatch.core.footing.statics import lean, level_at, tilt
from rockbatch.core.footing.strips import deflection, last_node, lay, plastic_work, pressure, push, settle, sinking
from rockbatch.core.ground import later
from rockbatch.core.kernel import inlined, kernel
from rockbatch.core.rk4 import rk4
from rockbatch.core.system import System, rates
from rockbatch.core.table import LANES, get, lanes_of, put, taken, with_beds
from rockbatch.core.types import Instant, Moment, Part


class Demands(NamedTuple):
    """Greatest demands on the bed so far."""

    contact_least: float  # least share of the area that was pressed at the end of a step
    pressure: float  # greatest pressure at an edge, times the area over the mass [m/s²]
    pressure_time: float  # [s]
    pressure_side: float  # LEFT, RIGHT or NEITHER
    force: float  # greatest push [m/s²]
    force_time: float  # [s]
    yielding: float  # rocks to one side in which the ground has yielded
    yields: float  # 1 if it has in the present one
    yield_time: float  # when it first did [s]; NaN before that


LANE_PARTS = COMMON | {
    "model": Numbers,
    "now": State,
    "end": State,
    "rates": State,
    "contact": Touch,
    "bed": Place,
    "demands": Demands,
    "ending": Ending,
}

LANE = with_beds(lanes_of(LANE_PARTS), BED_OF_LANES)

BENDING_LANE = with_beds(
    lanes_of(
        LANE_PARTS
        | dict.fromkeys(("now", "end", "rates"), Flexing)
        | {"shaft": ShaftNumbers, "displaced": Displacements}
    ),
    BED_OF_LANES,
)
"""A table of piers whose shafts bend."""


LINE = (
    *NUMBERS, *TIMING,
    ("prestress", float),  # of tendons, over the mass [m/s²]
    ("theta", float),  # where the pier is held at the start [rad]
)  # fmt: skip
"""Fields of the request of a run, with their types."""

Line = NamedTuple("Line", LINE)  # type: ignore[misc]

BendingLine = NamedTuple("BendingLine", (*LINE, *SHAFT_NUMBERS))  # type: ignore[misc]


@system.pier_in.of(FootingTraits)
def pier_in(traits, lanes, i):
    """Return the Footing of lane ``i``, and its Moment; the bed is part of the pier."""
    return model_in(traits, lanes, i), Moment(state_in(traits, lanes.now, i), get(lanes.contact, i, Touch), None)


@kernel
def _free_slot(lanes, i):
    """Return the first slot of a bed that none of the lanes before ``i`` has; −1 if all are taken."""
    for slot in range(LANES):
        free = True
        for j in range(i):
            free = free and lanes.bed.slot[j] != slot
        if free:
            return float(slot)
    return -1.0


@inlined
def touch(m, d, bed):
    """Return the Touch of the foot under the Sinking ``d``, with this Push of the bed."""
    left, right = deflection(m, d, FIRST), deflection(m, d, last_node(m))
    return Touch(1.0 if left > 0.0 else 0.0, 1.0 if right > 0.0 else 0.0, 1.0 if bed.touched == 0.0 else 0.0)


@kernel
def start_on_bed(m, y):
    """Lay a new bed with the plastic set that a foot leaves which is pressed into it once, to state ``y``."""
    lay(m)
    d = sinking(m, y)
    settle(m, d, d, 1.0)


@system.begin.of(FootingTraits)
def begin(traits, lanes, i, run):
    """Put the model of ``run`` into lane ``i``, at rest, or held at a rotation to which it was pushed from rest."""
    put(lanes.model, i, taken(run, Numbers))
    begin_shaft(traits.shaft, lanes, i, run)
    put(lanes.bed, i, Place(_free_slot(lanes, i), 0.0))
    m, load = model_in(traits, lanes, i), run.gravity + run.prestress
    lay(m)
    y = at_rest(m.shaft, m, level_at(m, run.theta, load), run.theta)
    d = sinking(m, y)
    start_on_bed(m, y)
    put(lanes.now, i, y)
    begin_displacements(traits.shaft, lanes, i, y)
    put(lanes.contact, i, touch(m, d, push(m, d)))
    lanes.rates.omega[i] = math.nan  # unknown
    put(lanes.demands, i, Demands(1.0, 0.0, 0.0, 0.0, load, 0.0, 0.0, 0.0, math.nan))
    set_deadline(lanes, i, run)


@inlined
def _edge_pressure(m, d, j):
    """Return the pressure at node ``j``, at most the strength, times the area over the mass [m/s²]; 0 if it is not pressed."""
    return max(0.0, min(pressure(m, d, j), m.strength)) if deflection(m, d, j) > 0.0 else 0.0


@inlined
def _include_demands(lanes, i, m, d, bed, t):
    """Raise the demands on the bed to those under the Sinking ``d`` at ``t`` [s], with this Push; the least contact falls."""
    demands = lanes.demands
    demands.contact_least[i] = min(demands.contact_least[i], bed.touched)
    left, right = _edge_pressure(m, d, FIRST), _edge_pressure(m, d, last_node(m))
    most = max(left, right)
    if most > demands.pressure[i]:
        demands.pressure[i], demands.pressure_time[i] = most, t
        demands.pressure_side[i] = 1.0 if right > left else (-1.0 if left > right else 0.0)
    if bed.force > demands.force[i]:
        demands.force[i], demands.force_time[i] = bed.force, t


@inlined
def _clearances(m, d):
    """Return the Clearances of both edges under the Sinking ``d``."""
    n = last_node(m)
    return Clearances(
        -deflection(m, d, FIRST), -deflection(m, d, n),
        -(d.level_rate + d.slope_rate * m.bed[FIRST, POSITION]), -(d.level_rate + d.slope_rate * m.bed[n, POSITION]),
    )  # fmt: skip


@kernel
def take_in(lanes, i, m, part, t):
    """Advance lane ``i`` to the end of a Part at ``t`` [s], with extremes, uplifts and plastic set; return the Push there."""
    before, y, end, tally, demands = part.start.contact, part.start.y, part.end, lanes.tally, lanes.demands
    include_bending(m.shaft, lanes, i, part)
    d, d_end = sinking(m, y), sinking(m, end)
    if part.length > 0.0 and settle(m, d, d_end, part.length):
        demands.yielding[i] += 1.0 - demands.yields[i]
        demands.yields[i] = 1.0
        if not demands.yield_time[i] >= 0.0:
            demands.yield_time[i] = t
    demands.yields[i] = 0.0 if y.theta * end.theta < 0.0 else demands.yields[i]
    bed = push(m, d_end)
    after = Touch(before.left, before.right, before.clear)
    if bed.touched < 1.0 or before.clear + (1.0 - before.left) + (1.0 - before.right) > 0.0:
        after = touch(m, d_end, bed)
        tally.uplifts[i] += max(before.left - after.left, 0.0) + max(before.right - after.right, 0.0)
        note_flight(lanes, i, after.clear != 0.0, t)
        if before.clear != 0.0:
            include_height(lanes, i, _clearances(m, d), _clearances(m, d_end), part.length)
    _include_demands(lanes, i, m, d_end, bed, t)
    put(lanes.now, i, end)
    put(lanes.contact, i, after)
    lanes.bed.time[i] = t
    return bed


@system.take_in_part.of(FootingTraits)
def take_in_part(traits, lanes, i, m, part, after):
    """Advance lane ``i`` to the end of a Part, with extremes, uplifts and plastic set; ``after`` is not read: nothing jumps."""
    take_in(lanes, i, m, part, lanes.bed.time[i] + part.length)


@system.lanes_in_pass.of(FootingTraits)
def lanes_in_pass(traits, count):
    """Return ``count``: lanes are taken one by one, without padding."""
    return count


@system.one_pass.of(FootingTraits)
def one_pass(traits, lanes, count, substep, settings):
    """Integrate the first ``count`` lanes over a sub-step, one by one, and advance them.

    A run in any company comes to the same bits. One that falls (|θ| ≥ π/2) or becomes NaN is EVENTFUL, left to the driver.
    """
    for i in range(count):
        m, now = pier_in(traits, lanes, i)
        h, ground = lanes.clock.step[i], ground_at(lanes, i, substep * lanes.clock.step[i])
        k = state_in(traits, lanes.rates, i)
        if not abs(k.omega) < math.inf:
            k = rates(m, now.y, now.contact, ground)
        end = rk4(m, None, Instant(now.y, k, now.contact, None, ground), h)
        if not abs(end.theta) < ON_ITS_SIDE:
            lanes.step_status.kind[i] = EVENTFUL
            continue
        part = Part(now, end, h)
        include_peak(lanes, i, part, substep * h, 0.0)
        t = lanes.clock.sample[i] * lanes.clock.dt[i] + (substep + 1.0) * h
        bed = take_in(lanes, i, m, part, t)
        put(lanes.rates, i, rates_under(m.shaft, m, end, bed, later(ground, h)))
        lanes.step_status.kind[i] = CALM


@system.finish.of(FootingTraits)
def finish(traits, lanes, i, t, result):
    """Write the residuals, and the demands on the bed, of the run in lane ``i``; residuals are 0 if nothing has yielded.

    Lean and settlement are NaN if the pier has no rest on its bed.
    """
    m, _ = pier_in(traits, lanes, i)
    demands, load = lanes.demands, lanes.ending.load[i]
    result.base_left, result.base_right = m.bed[FIRST, SET], m.bed[last_node(m), SET]
    result.dissipated_left = plastic_work(m)
    result.bed_tilt = result.lean = result.settled = 0.0
    if result.dissipated_left > 0.0:
        result.bed_tilt, result.lean = tilt(m), lean(m, load)
        at_rest = sinking(m, State(level_at(m, result.lean, load), result.lean, 0.0, 0.0))
        result.settled = at_rest.level - load / m.stiffness
    result.contact_least, result.bed_pressure, result.t_pressure = (
        demands.contact_least[i], demands.pressure[i], demands.pressure_time[i],
    )  # fmt: skip
    result.pressure_side = demands.pressure_side[i]
    result.bed_force, result.t_force = demands.force[i], demands.force_time[i]
    result.yielding_rocks, result.t_yield = demands.yielding[i], demands.yield_time[i]
    write_displacements(traits.shaft, lanes, i, result)


def system_of(m):
    """Return the System of the pier ``m`` (Footing): equal for piers with fields of the same types, whatever their numbers."""
    if m.shaft is None:
        return System(FootingTraits(m.finite, m.shifting), Line, LANE, State._fields + Touch._fields)
    traits = FootingTraits(m.finite, m.shifting, LIKE)
    return System(traits, BendingLine, BENDING_LANE, Flexing._fields + Touch._fields)


def line_of(m, prestress, theta, *timing):
    """Return the Line of a run of the pier ``m`` (Footing); ``timing`` is what Line has from ``dt`` on."""
    numbers = *m[: len(NUMBERS)], *timing, prestress, theta
    return Line(*numbers) if m.shaft is None else BendingLine(*numbers, *shaft_numbers(m.shaft))
