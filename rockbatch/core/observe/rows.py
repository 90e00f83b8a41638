"""States, contacts and ground at the rows of a history and within its steps, for observers of a recorded run."""

from typing import NamedTuple

from rockbatch.core.block.model import Block, Rocking, Stance
from rockbatch.core.flexure.equations import flexing
from rockbatch.core.flexure.model import FlexibleBlock, Flexing, Shaft
from rockbatch.core.flexure.modes import MOST_MODES, PerMode, deflection_rates, deflections
from rockbatch.core.kernel import hook, inlined, kernel, optional_hook
from rockbatch.core.springs.bending import bent_state
from rockbatch.core.springs.model import BentState, Contact, Springs, State
from rockbatch.core.system import rates, share, stage
from rockbatch.core.types import Ground


@hook
def state_of(m, row):
    """Return the state in a row."""


@hook
def _row_on_springs(shaft, row):
    """Return the state of a pier on springs in a row, with the coordinates of the modes if its ``shaft`` bends."""


@_row_on_springs.of(type(None))
def _straight_row(shaft, row):
    return State(row.v, row.theta, row.v_rate, row.omega, row.z_left, row.z_right)


@_row_on_springs.of(Shaft)
def _bent_row(shaft, row):
    u, u_rate = _modes_in(row)
    return bent_state(_row_on_springs(None, row), u, u_rate)


@state_of.of(Springs)
def _state_on_springs(m, row):
    return _row_on_springs(m.shaft, row)


@state_of.of(Block)
def _state_of_block(m, row):
    return Rocking(row.v, row.theta, row.v_rate, row.omega)


@inlined
def _modes_in(row):
    """Return the coordinates of the modes in a row, and their rates."""
    u_rate = PerMode(row.u_1_rate, row.u_2_rate, row.u_3_rate, row.u_4_rate)
    return PerMode(row.u_1, row.u_2, row.u_3, row.u_4), u_rate


@inlined
def flexing_in(row):
    """Return the Flexing in a row."""
    u, u_rate = _modes_in(row)
    return flexing(row.v, row.theta, row.v_rate, row.omega, u, u_rate)


@state_of.of(FlexibleBlock)
def _state_of_flexible_block(m, row):
    return flexing_in(row)


@hook
def contact_of(m, row):
    """Return the contact in a row: of the step that ends there, or after the event."""


@contact_of.of(Springs)
def _contact_on_springs(m, row):
    return Contact(row.left, row.right, row.left_yields, row.right_yields, row.held)


def _stance(m, row):
    return Stance(row.left, row.right, row.bore, row.top)


contact_of.of(Block)(_stance)
contact_of.of(FlexibleBlock)(_stance)


@optional_hook
def write_bending(y, k, line):
    """Write the coordinates of a shaft's modes, their rates and accelerations to the rows of ``line``; nothing if rigid."""


def _write_bending(y, k, line):
    u, u_rate, u_acceleration = deflections(y), deflection_rates(y), deflection_rates(k)
    for i in range(MOST_MODES):
        line[0, i], line[1, i], line[2, i] = u[i], u_rate[i], u_acceleration[i]


write_bending.of(Flexing)(_write_bending)
write_bending.of(BentState)(_write_bending)


@optional_hook
def begin_at(m, y):
    """Set the bed of a footing ``m`` to that at the start of a run in state ``y``; other piers remember nothing."""


@optional_hook
def remember(m, y, y_end, length):
    """Bring the plastic set of a footing ``m`` up to a step of ``length`` [s] from ``y`` to ``y_end``; other piers have none."""


@kernel
def ground_at(ground, dt, middle, t):
    """Return the Ground at ``t`` [s], linear in the sampling interval that contains ``middle``; zeros after the motion."""
    sample = int(middle / dt)
    if sample >= len(ground):
        return Ground(0.0, 0.0, 0.0, 0.0)
    after, row = t - sample * dt, ground[sample]
    return Ground(row[0] + after * row[1], row[1], row[2] + after * row[3], row[3])


class Step(NamedTuple):
    """A step between two rows of a history: states, rates and ground at its ends."""

    start: tuple
    rates: tuple
    end: tuple
    rates_end: tuple
    contact: tuple
    length: float  # [s]
    ground: Ground
    ground_end: Ground


@kernel
def step_between(under, under_end, row, row_end, ground, dt):
    """Return the Step from ``row`` to ``row_end``; ``under`` and ``under_end`` are the pier with its devices' pull there."""
    start, end, contact = state_of(under, row), state_of(under, row_end), contact_of(under, row_end)
    middle = 0.5 * (row.t + row_end.t)
    shaking, shaking_end = ground_at(ground, dt, middle, row.t), ground_at(ground, dt, middle, row_end.t)
    k, k_end = rates(under, start, contact, shaking), rates(under_end, end, contact, shaking_end)
    return Step(start, k, end, k_end, contact, row_end.t - row.t, shaking, shaking_end)


@kernel
def ground_within(step, s):
    """Return the Ground at the share ``s`` of a step."""
    start, end = step.ground, step.ground_end
    horizontal = start.horizontal + s * (end.horizontal - start.horizontal)
    vertical = start.vertical + s * (end.vertical - start.vertical)
    return Ground(horizontal, start.horizontal_slope, vertical, start.vertical_slope)


@kernel
def cubic(start, rate, end, rate_end, h, s):
    """Return the cubic Hermite polynomial at the share ``s`` of a step of ``h`` [s].

    It is limited to the values at its ends unless the rates there differ in sign, since a steep end would make it overshoot.
    """
    way = end - start
    value = start + s * (way + (1.0 - s) * ((1.0 - s) * (h * rate - way) - s * (h * rate_end - way)))
    if rate * rate_end < 0.0:
        return value
    return min(max(value, min(start, end)), max(start, end))


@hook
def within(m, step, s):
    """Return the state at the share ``s`` of a step by cubics, with decaying variables in closed form."""


@within.of(Springs)
def _within_on_springs(m, step, s):
    y, k, end, k_end, h = step.start, step.rates, step.end, step.rates_end, step.length
    return stage(m, cubics(y, k, end, k_end, h, s), y, step.contact, share(m, s * h))


@hook
def cubics(y, k, end, k_end, h, s):
    """Return :func:`cubic` of each variable of a state."""


@cubics.of(State)
def _straight_cubics(y, k, end, k_end, h, s):
    return State(
        cubic(y.v, k.v, end.v, k_end.v, h, s),
        cubic(y.theta, k.theta, end.theta, k_end.theta, h, s),
        cubic(y.v_rate, k.v_rate, end.v_rate, k_end.v_rate, h, s),
        cubic(y.omega, k.omega, end.omega, k_end.omega, h, s),
        cubic(y.z_left, k.z_left, end.z_left, k_end.z_left, h, s),
        cubic(y.z_right, k.z_right, end.z_right, k_end.z_right, h, s),
    )


@cubics.of(BentState)
def _bent_cubics(y, k, end, k_end, h, s):
    straight = State(
        cubic(y.v, k.v, end.v, k_end.v, h, s),
        cubic(y.theta, k.theta, end.theta, k_end.theta, h, s),
        cubic(y.v_rate, k.v_rate, end.v_rate, k_end.v_rate, h, s),
        cubic(y.omega, k.omega, end.omega, k_end.omega, h, s),
        cubic(y.z_left, k.z_left, end.z_left, k_end.z_left, h, s),
        cubic(y.z_right, k.z_right, end.z_right, k_end.z_right, h, s),
    )
    u, u_rate = _cubics_of_modes(y, k, end, k_end, h, s)
    return bent_state(straight, u, u_rate)


@within.of(Block)
def _within_of_block(m, step, s):
    y, k, end, k_end, h = step.start, step.rates, step.end, step.rates_end, step.length
    return Rocking(
        cubic(y.v, k.v, end.v, k_end.v, h, s),
        cubic(y.theta, k.theta, end.theta, k_end.theta, h, s),
        cubic(y.v_rate, k.v_rate, end.v_rate, k_end.v_rate, h, s),
        cubic(y.omega, k.omega, end.omega, k_end.omega, h, s),
    )


@cubics.of(Flexing)
def _flexing_cubics(y, k, end, k_end, h, s):
    u, u_rate = _cubics_of_modes(y, k, end, k_end, h, s)
    return flexing(
        cubic(y.v, k.v, end.v, k_end.v, h, s),
        cubic(y.theta, k.theta, end.theta, k_end.theta, h, s),
        cubic(y.v_rate, k.v_rate, end.v_rate, k_end.v_rate, h, s),
        cubic(y.omega, k.omega, end.omega, k_end.omega, h, s),
        u,
        u_rate,
    )


@within.of(FlexibleBlock)
def _within_of_flexible_block(m, step, s):
    return cubics(step.start, step.rates, step.end, step.rates_end, step.length, s)


@inlined
def _cubics_of_modes(y, k, end, k_end, h, s):
    """Return :func:`cubic` of the coordinates of the modes, and of their rates."""
    u = _cubic_of_modes(deflections(y), deflections(k), deflections(end), deflections(k_end), h, s)
    rates, changes = (deflection_rates(y), deflection_rates(end)), (deflection_rates(k), deflection_rates(k_end))
    return u, _cubic_of_modes(rates[0], changes[0], rates[1], changes[1], h, s)


@kernel
def _cubic_of_modes(start, rate, end, rate_end, h, s):
    """Return :func:`cubic` of each mode."""
    return PerMode(
        cubic(start.first, rate.first, end.first, rate_end.first, h, s),
        cubic(start.second, rate.second, end.second, rate_end.second, h, s),
        cubic(start.third, rate.third, end.third, rate_end.third, h, s),
        cubic(start.fourth, rate.fourth, end.fourth, rate_end.fourth, h, s),
    )
