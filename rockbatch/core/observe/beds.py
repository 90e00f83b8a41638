"""A recorded run on a footing: forces, the bed at every row, and the energy balance.

The plastic set is no column of a history: it follows from the states at every step, as it did in the run.
"""

from typing import NamedTuple

from rockbatch.core.flexure.model import Shaft
from rockbatch.core.footing.equations import accelerations, bent_accelerations, energies, lever
from rockbatch.core.footing.lanes import start_on_bed
from rockbatch.core.footing.model import FIRST, Footing, State, Touch
from rockbatch.core.footing.strips import Push, deflection, last_node, push, settle, settling_work, sinking
from rockbatch.core.kernel import entry, hook, kernel
from rockbatch.core.observe.forces import (
    Foot,
    Forces,
    Inertia,
    fastest_heels,
    forces_at,
    friction_demand,
    inertia_of_bent,
    waiting,
)
from rockbatch.core.observe.ledger import power_of_damping, pulled
from rockbatch.core.observe.rows import (
    begin_at,
    contact_of,
    cubic,
    cubics,
    flexing_in,
    ground_within,
    remember,
    state_of,
    step_between,
    within,
)
from rockbatch.core.system import ground_power
from rockbatch.core.table import record
from rockbatch.core.trigonometry import sine_and_cosine


class BedState(NamedTuple):
    """The bed at one moment."""

    force: float  # push over the mass [m/s²]
    moment: float  # Σ P x over the mass [m²/s²]
    touched: float  # share of the area that is pressed
    stored: float  # kinetic, potential and elastic energy of pier and bed, relative to the first row [J/kg]


BED_STATE = record(BedState)


@hook
def _row_on_bed(shaft, row):
    """Return the state of a pier on a footing in a row, with the coordinates of the modes if its ``shaft`` bends."""


@_row_on_bed.of(type(None))
def _straight_row(shaft, row):
    return State(row.v, row.theta, row.v_rate, row.omega)


@_row_on_bed.of(Shaft)
def _bent_row(shaft, row):
    return flexing_in(row)


@state_of.of(Footing)
def _state(m, row):
    return _row_on_bed(m.shaft, row)


@contact_of.of(Footing)
def _contact(m, row):
    return Touch(row.left, row.right, row.clear)


@within.of(Footing)
def _within(m, step, s):
    return cubics(step.start, step.rates, step.end, step.rates_end, step.length, s)


@cubics.of(State)
def _cubics(y, k, end, k_end, h, s):
    return State(
        cubic(y.v, k.v, end.v, k_end.v, h, s), cubic(y.theta, k.theta, end.theta, k_end.theta, h, s),
        cubic(y.v_rate, k.v_rate, end.v_rate, k_end.v_rate, h, s), cubic(y.omega, k.omega, end.omega, k_end.omega, h, s),
    )  # fmt: skip


@begin_at.of(Footing)
def _begin(m, y):
    start_on_bed(m, y)


@remember.of(Footing)
def _remember(m, y, y_end, length):
    settle(m, sinking(m, y), sinking(m, y_end), length)


@waiting.of(Footing)
def _waiting(m, y, was, contact, supports):
    return supports


@fastest_heels.of(Footing)
def _fastest(m, step):
    return 0.0, 0.0


@hook
def _inertia_on_bed(shaft, m, deck, y, bed, ground):
    """Return the Inertia of a pier on a bed with this Push, whose ``shaft`` is None if it is rigid."""


@_inertia_on_bed.of(type(None))
def _inertia_of_rigid_shaft(shaft, m, deck, y, bed, ground):
    v_acceleration, turning = accelerations(m, y, bed, ground)
    at, squared = lever(m, y), y.omega * y.omega
    along, bend, swung = m.height * turning, 0.0, (deck - m.height) * turning
    if m.finite is not None:
        sine, cosine = sine_and_cosine(y.theta)
        along, bend = at.length * turning, at.slope * squared
        swung = (deck - m.height) * (cosine * turning - sine * squared)
    shear = ground.horizontal + along + bend
    moment = at.lean * (m.gravity + ground.vertical + v_acceleration) - at.length * shear - m.inertia * turning
    return Inertia(shear, moment, shear + swung, at.length * y.omega, y.v_rate)


@_inertia_on_bed.of(Shaft)
def _inertia_of_bending_shaft(shaft, m, deck, y, bed, ground):
    at = lever(m, y)
    return inertia_of_bent(
        m, deck, y, bent_accelerations(m, y, bed, ground), Foot(at.length, at.slope, 0.0, at.length), ground
    )


@forces_at.of(Footing)
def forces_on_footing(m, deck, now, ground):
    """Return the Forces in the Moment ``now``; left and right are forces at the edges equivalent to the push."""
    y, d = now.y, sinking(m, now.y)
    bed = push(m, d)
    of = _inertia_on_bed(m.shaft, m, deck, y, bed, ground)
    of_edges = bed.moment / m.half_width
    left, right = deflection(m, d, FIRST), deflection(m, d, last_node(m))
    free_left, free_right = 1.0 if left < 0.0 else 0.0, 1.0 if right < 0.0 else 0.0
    gap_left, gap_right = -free_left * left, -free_right * right
    b = m.half_width
    return Forces(
        of.shear, bed.force, of.moment, 0.5 * (bed.force - of_edges), 0.5 * (bed.force + of_edges), gap_left, gap_right,
        -free_left * (d.level_rate - b * d.slope_rate), -free_right * (d.level_rate + b * d.slope_rate),
        of.deck, of.along, of.up, y.omega,
        friction_demand(m.gravity, of.shear, bed.force), min(gap_left, gap_right),
    )  # fmt: skip


class Powers(NamedTuple):
    """Powers of the energy balance [W/kg]."""

    input: float
    p_delta: float
    damping: float


@kernel
def _powers(m, y, contact, ground):
    d = sinking(m, y)
    bed = push(m, d)
    spring = push(_undamped(m), d)
    more = Push(bed.force - spring.force, bed.moment - spring.moment, 0.0)
    p_delta = m.height * y.theta * bed.force * y.omega if m.finite is None else 0.0
    damping = more.force * d.level_rate + more.moment * d.slope_rate
    return Powers(ground_power(m, y, contact, ground), p_delta, damping + power_of_damping(y, m.shaft))


@kernel
def _undamped(m):
    return Footing(
        m.half_width, m.height, m.inertia, m.gravity, m.stiffness, m.strength, 0.0, m.strips, m.gap, m.guided, m.rest, m.finite,
        m.shifting, m.bed, m.pull, m.shaft,
    )  # fmt: skip


@entry
def follow_bed(m, rows, out):
    """Compute the bed at every row of a run on a footing.

    Parameters
    ----------
    m : Footing
        With a bed that is laid here.
    rows : recarray, shape (n,)
        History as the run wrote it, every step.
    out : recarray of BedState, shape (n,)
        Filled at every row.
    """
    y = state_of(m, rows[0])
    start_on_bed(m, y)
    kinetic0, potential0, elastic0 = energies(m, y)
    for i in range(len(rows)):
        y_end = state_of(m, rows[i])
        d = sinking(m, y_end)
        if i > 0 and rows[i].t > rows[i - 1].t:
            settle(m, sinking(m, y), d, rows[i].t - rows[i - 1].t)
        kinetic, potential, elastic = energies(m, y_end)
        bed, at = push(m, d), out[i]
        at.force, at.moment, at.touched = bed.force, bed.moment, bed.touched
        at.stored = (kinetic - kinetic0) + (potential - potential0) + (elastic - elastic0)
        y = y_end


@entry
def ledger_on_footing(m, rows, pulls, ground, dt, out):
    """Compute the energy balance of a run on a footing ``m``, whose bed is laid here; without terms of impact and constraint.

    Otherwise as :func:`rockbatch.core.observe.ledger.ledger_on_springs`.
    """
    y = state_of(m, rows[0])
    start_on_bed(m, y)
    kinetic0, potential0, elastic0 = energies(m, y)
    shaken, plastic, p_delta, damping = 0.0, 0.0, 0.0, 0.0
    for i in range(len(rows)):
        y_end, contact = state_of(m, rows[i]), contact_of(m, rows[i])
        if i > 0 and rows[i].t > rows[i - 1].t:
            start, half_way, stop = pulled(m, pulls, i)
            step = step_between(start, stop, rows[i - 1], rows[i], ground, dt)
            first = _powers(m, y, contact, step.ground)
            middle = _powers(m, within(half_way, step, 0.5), contact, ground_within(step, 0.5))
            last = _powers(m, y_end, contact, step.ground_end)
            sixth = step.length * (1.0 / 6.0)
            shaken += sixth * (first.input + 4.0 * middle.input + last.input)
            p_delta += sixth * (first.p_delta + 4.0 * middle.p_delta + last.p_delta)
            damping += sixth * (first.damping + 4.0 * middle.damping + last.damping)
            d, d_end = sinking(m, y), sinking(m, y_end)
            plastic += settling_work(m, d, d_end, step.length)
            settle(m, d, d_end, step.length)
        kinetic, potential, elastic = energies(m, y_end)
        line = out[i]
        line.kinetic, line.potential, line.elastic = kinetic - kinetic0, potential - potential0, elastic - elastic0
        line.input, line.plastic, line.p_delta, line.damping = shaken, plastic, p_delta, damping
        line.remainder = line.kinetic + line.potential + line.elastic - shaken + plastic - p_delta + damping
        y = y_end
