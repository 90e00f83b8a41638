"""A step in which something happens: lift-off, landings, the end of all bounces, and the ground that falls away."""

import math

from rockbatch.core.kernel import kernel
from rockbatch.core.outcome import fallen
from rockbatch.core.rigid.equations import acceleration, carried_until, later, lift_off, rocking_step, time_to_rest
from rockbatch.core.rigid.landing import landing, stays
from rockbatch.core.rigid.lane import block_in, ground_in, motion_in, put_motion, tick
from rockbatch.core.roots import largest_within
from rockbatch.core.types import (
    BEFORE_EVENT,
    CHATTER,
    FLIGHT,
    IMPACT_LEFT,
    IMPACT_RIGHT,
    LEFT,
    LIFT_OFF,
    NEITHER,
    REST,
    RIGHT,
    STEP,
    SURVIVED,
    Rocking,
)

EVENTS_IN_A_SAMPLE = 20_000
NEGLIGIBLE = 1e-13  # of α: height of the bounces that are summed up instead of followed


@kernel
def write(history, row, t, y, kind):
    """Row of a history, where there is room for it; the next row."""
    if row < history.shape[0]:
        line = history[row]
        line.t = t
        line.theta = y.theta
        line.omega = y.omega
        line.kind = kind
    return row + 1


@kernel
def step_through(lanes, i, locate, history, row):
    """The step of lane ``i``, event by event: status, its time [s] where that ends the run, and the next row."""
    clock = lanes.clock
    m, at_sample = block_in(lanes, i), ground_in(lanes, i)
    h, start = clock.step[i], clock.substep[i] * clock.step[i]
    until = carried_until(m, at_sample, clock.dt[i])
    whole = min(h, until - start)
    done = 0.0
    while done < whole and lanes.tally.events[i] <= EVENTS_IN_A_SAMPLE:
        ground, t, left = later(at_sample, start + done), clock.time[i] + start + done, whole - done
        if lanes.now.side[i] == NEITHER:
            used, row = _rest(lanes, i, m, ground, t, left, history, row)
        else:
            used, row = _rock(lanes, i, m, ground, t, left, locate, history, row)
        done = done + used if used < left else whole
    t = clock.time[i] + start + done
    if lanes.tally.events[i] > EVENTS_IN_A_SAMPLE:
        return CHATTER, t, row
    status = fallen(lanes.now.theta[i])
    if status == SURVIVED and start + h >= until:
        lanes.tally.t_flight[i] = t
        status = FLIGHT
    if status == SURVIVED:
        tick(lanes, i, 1.0)
    elif history.shape[0] > 0:
        row = write(history, row, t, motion_in(lanes, i), STEP)
    return status, t, row


@kernel
def _rest(lanes, i, m, ground, t, left, history, row):
    """The block at rest until it lifts off, ``left`` [s] at most: how long that is, and the next row."""
    at, side = lift_off(m, ground, left)
    if at < 0.0 or at >= left:
        return left, row
    y = Rocking(0.0, 0.0, side)
    put_motion(lanes, i, y)
    lanes.tally.lift_offs[i] += 1.0
    lanes.tally.t_rest[i] = math.nan
    return at, write(history, row, t + at, y, LIFT_OFF)


@kernel
def _rock(lanes, i, m, ground, t, left, locate, history, row):
    """The block from time ``t`` [s] to its next impact, ``left`` [s] at most: how long that is, and the next row."""
    y = motion_in(lanes, i)
    k1 = acceleration(m, y.theta, y.side, ground.horizontal, ground.vertical)
    end = rocking_step(m, y, k1, ground, left)
    at = -1.0
    if not stays(y, end, left):
        if locate:
            at, end = landing(m, y, k1, ground, left, end)
        elif y.side * end.theta <= 0.0:
            at = left
    used = left if at < 0.0 else at
    found, peak = largest_within(y.theta, y.omega, end.theta, end.omega, used, lanes.peak.theta[i])
    if found >= 0.0:
        lanes.peak.theta[i] = peak
        lanes.peak.time[i] = t + found
    if lanes.ending.ground_rests[i] != 0.0 and y.omega * end.omega < 0.0:
        lanes.ending.turned[i] = 1.0
    put_motion(lanes, i, end)
    if at >= 0.0:
        row = _land(lanes, i, m, later(ground, at), t + at, history, row)
    return used, row


@kernel
def _land(lanes, i, m, ground, t, history, row):
    """Impact at ``t`` [s] (THEORY.md, eq. 16): the block goes on about its other corner, or rests; the next row."""
    came = motion_in(lanes, i)
    row = write(history, row, t, Rocking(0.0, came.omega, came.side), BEFORE_EVENT)
    omega = m.restitution * came.omega
    height, remaining = time_to_rest(m, omega, ground.horizontal, ground.vertical)
    if omega == 0.0 or (height < NEGLIGIBLE * m.alpha and remaining < lanes.clock.dt[i]):
        lanes.tally.t_rest[i] = t + (remaining if omega != 0.0 else 0.0)
        goes, kind = Rocking(0.0, 0.0, NEITHER), REST
    else:
        kind = IMPACT_LEFT if came.side == RIGHT else IMPACT_RIGHT
        goes = Rocking(0.0, omega, RIGHT if omega > 0.0 else LEFT)
    put_motion(lanes, i, goes)
    lanes.tally.impacts[i] += 1.0
    lanes.tally.events[i] += 1.0
    return write(history, row, t, goes, kind)
