"""A run on two springs: fixed steps of Runge–Kutta 4, events located inside the step, the rest of it redone."""

import math
from typing import NamedTuple

from rockbatch.core.equations import geometry, on_ground, rates, step, touching, without
from rockbatch.core.events import at_rest, quiet, settle, signals
from rockbatch.core.impact import land, land_flat
from rockbatch.core.kernel import entry, kernel
from rockbatch.core.outcome import fallen, patience, undecided
from rockbatch.core.roots import (
    AFTER,
    BEFORE,
    CLOSE,
    LEAST,
    NEVER,
    NOW,
    TRIALS,
    Bracket,
    largest_within,
    lowest_within,
    narrowed,
    outlook,
    secant,
)
from rockbatch.core.springs import plastic_work, static_deflection
from rockbatch.core.types import (
    BEFORE_EVENT,
    BOUC_WEN,
    CHATTER,
    EPP,
    FLIGHT,
    HELD_LEFT,
    HELD_RIGHT,
    IMPACT_BOTH,
    IMPACT_LEFT,
    IMPACT_RIGHT,
    OVERTURNED,
    SAMPLE,
    SEPARATION_LEFT,
    SEPARATION_RIGHT,
    SPRING_LEFT,
    SPRING_RIGHT,
    STEP,
    SURVIVED,
    UNDECIDED,
    Contact,
    Ground,
    SpringRun,
    State,
)

EVENTS_IN_A_STEP = 20_000  # more than any decaying sequence of impacts needs
HISTORY_COLUMNS = 13  # t, the six of State, the five of Contact, kind of row


class Supports(NamedTuple):
    """Unstressed positions [m] at which the supports of free pivots wait."""

    left: float
    right: float


class Extremes(NamedTuple):
    """Greatest |θ| [rad] and when, lowest positions of the pivots on their springs [m]."""

    peak: float
    t_peak: float
    low_left: float
    low_right: float


class Loading(NamedTuple):
    """Where each spring's present branch began: unstressed position [m] and z; and the plastic work/F_y so far [m]."""

    left: float
    z_left: float
    work_left: float
    right: float
    z_right: float
    work_right: float


@kernel
def _include(extremes, y, reached, contact, at, at_end, t, h):
    """Extremes with those of the piece of a step that starts at ``t`` in state ``y`` and ends after ``h``."""
    found, peak = largest_within(y.theta, y.omega, reached.theta, reached.omega, h, extremes.peak)
    t_peak = t + found if found >= 0.0 else extremes.t_peak
    low_left, low_right = extremes.low_left, extremes.low_right
    if contact.left != 0.0:
        low_left = lowest_within(
            y.v + at.lift_left, y.v_rate + at.arm_left * y.omega,
            reached.v + at_end.lift_left, reached.v_rate + at_end.arm_left * reached.omega,
            h, low_left,
        )  # fmt: skip
    if contact.right != 0.0:
        low_right = lowest_within(
            y.v + at.lift_right, y.v_rate + at.arm_right * y.omega,
            reached.v + at_end.lift_right, reached.v_rate + at_end.arm_right * reached.omega,
            h, low_right,
        )  # fmt: skip
    return Extremes(peak, t_peak, low_left, low_right)


@kernel
def _branch(m, was, now, begun, z_begun, place, z, work):
    """Start of a spring's branch and its plastic work, brought up to an event at position ``place`` and ``z``."""
    if was == now:
        return begun, z_begun, work
    unstressed = place - m.yield_deflection * z
    if was != 0.0:
        work += plastic_work(z_begun, z, begun - unstressed, m.yield_deflection, m.exponent)
    return unstressed, z, work


@kernel
def _branches(m, loading, before, after, y):
    """Loading of both springs, brought up to an event that changed the contacts from ``before`` to ``after``."""
    at = geometry(m, y.theta)
    left, z_left, work_left = _branch(
        m, before.left_yields, after.left_yields,
        loading.left, loading.z_left, y.v + at.lift_left, y.z_left, loading.work_left,
    )  # fmt: skip
    right, z_right, work_right = _branch(
        m, before.right_yields, after.right_yields,
        loading.right, loading.z_right, y.v + at.lift_right, y.z_right, loading.work_right,
    )  # fmt: skip
    return Loading(left, z_left, work_left, right, z_right, work_right)


@kernel
def static_state(m):
    """Equilibrium under the weight alone: z = −1/η on the first loading of both springs."""
    force = 0.5 * m.gravity / m.yield_force
    deflection = static_deflection(force, m.exponent) if m.law == BOUC_WEN else force
    return State(-m.yield_deflection * deflection, 0.0, 0.0, 0.0, -force, -force)


@kernel
def _advance(m, y, k1, contact, ground, supports, rest, x, which):
    """State after ``x`` [s] and its signal ``which``."""
    reached = step(m, y, k1, contact, ground, x)
    found, _ = signals(
        m,
        reached,
        k1,
        contact,
        supports.left,
        supports.right,
        rest,
        ground.horizontal + x * ground.horizontal_slope,
        ground.vertical + x * ground.vertical_slope,
    )
    return found[which]


@kernel
def _crossing(m, y, k1, contact, ground, supports, rest, h, which, f0, d0, f1, d1):
    """Time in [0, h] at which signal ``which`` falls through zero, −1 if it does not."""
    look, x = outlook(f0, d0, f1, d1, h)
    if look == NEVER:
        return -1.0
    if look == NOW:
        return 0.0
    bracket = Bracket(0.0, f0, h, f1)
    if look == AFTER:
        fx = _advance(m, y, k1, contact, ground, supports, rest, x, which)
        while fx <= 0.0:
            x *= 0.5
            if x < LEAST * h:
                return 0.0
            fx = _advance(m, y, k1, contact, ground, supports, rest, x, which)
        bracket = Bracket(x, fx, h, f1)
    elif look == BEFORE:
        fx = _advance(m, y, k1, contact, ground, supports, rest, x, which)
        if fx > 0.0:
            return -1.0
        bracket = Bracket(0.0, f0, x, fx)
    for _ in range(TRIALS):
        if bracket.fb == 0.0:  # else it would pass for a time before the root
            break
        x = secant(bracket)
        moved = abs(x - bracket.b)
        bracket = narrowed(bracket, x, _advance(m, y, k1, contact, ground, supports, rest, x, which))
        if moved <= CLOSE * h:
            break
    return bracket.b


@kernel
def handle(m, y, contact, supports, which, rest, horizontal, vertical):
    """What event ``which`` makes of state, contacts and supports: returns them and the kind of event."""
    side = -1 if which % 2 == 0 else 1
    at = geometry(m, y.theta)
    left = side < 0
    velocity = y.v_rate + (at.arm_left if left else at.arm_right) * y.omega
    position = y.v + (at.lift_left if left else at.lift_right)
    yields_when_loaded = 1.0 if m.law == BOUC_WEN else 0.0

    if contact.held == side:
        if which < 2:
            return y, touching(contact, side, yields_when_loaded), supports, HELD_LEFT if left else HELD_RIGHT
        freed = Supports(position, supports.right) if left else Supports(supports.left, position)
        return y, without(contact, side), freed, SEPARATION_LEFT if left else SEPARATION_RIGHT

    if which >= 2:  # the spring changes its branch
        if left:
            z = -1.0 if m.law == EPP and contact.left_yields == 0.0 else y.z_left
            changed = State(y.v, y.theta, y.v_rate, y.omega, z, y.z_right)
            return changed, touching(contact, side, 1.0 - contact.left_yields), supports, SPRING_LEFT
        z = -1.0 if m.law == EPP and contact.right_yields == 0.0 else y.z_right
        changed = State(y.v, y.theta, y.v_rate, y.omega, y.z_left, z)
        return changed, touching(contact, side, 1.0 - contact.right_yields), supports, SPRING_RIGHT

    if (contact.left if left else contact.right) != 0.0:  # separation
        if left:
            unstressed = State(y.v, y.theta, y.v_rate, y.omega, 0.0, y.z_right)
            waiting = Supports(position, supports.right)
        else:
            unstressed = State(y.v, y.theta, y.v_rate, y.omega, y.z_left, 0.0)
            waiting = Supports(supports.left, position)
        after = without(contact, side)
        kind = SEPARATION_LEFT if left else SEPARATION_RIGHT
        if velocity <= rest:
            after = settle(m, unstressed, contact, side, horizontal, vertical)
            if on_ground(after) == on_ground(contact):
                kind = HELD_LEFT if left else HELD_RIGHT
        return unstressed, after, waiting, kind

    # landing; the other pivot may land at the same instant
    other_free = contact.left == 0.0 and contact.right == 0.0 and contact.held == 0
    if other_free:
        gap = y.v + (at.lift_right - supports.right if left else at.lift_left - supports.left)
        other_velocity = y.v_rate + (at.arm_right if left else at.arm_left) * y.omega
        if abs(gap) <= 1e-10 * m.yield_deflection and other_velocity < -rest:
            landed = land_flat(m, y)
            both = Contact(1.0, 1.0, yields_when_loaded, yields_when_loaded, 0)
            if abs(m.epsilon * velocity) <= rest:
                both = settle(m, landed, both, -1, horizontal, vertical)
                both = settle(m, landed, both, 1, horizontal, vertical)
            return landed, both, supports, IMPACT_BOTH
    landed = land(m, y, side)
    if abs(m.epsilon * velocity) > rest:
        after = touching(contact, side, yields_when_loaded)
    else:
        after = settle(m, landed, contact, side, horizontal, vertical)
        supports = Supports(position, supports.right) if left else Supports(supports.left, position)
    return landed, after, supports, IMPACT_LEFT if left else IMPACT_RIGHT


@kernel
def _write(history, row, t, y, contact, kind):
    """Row of a history, where there is room for it."""
    if row < history.shape[0]:
        line = history[row]
        line[0] = t
        line[1] = y.v
        line[2] = y.theta
        line[3] = y.v_rate
        line[4] = y.omega
        line[5] = y.z_left
        line[6] = y.z_right
        line[7] = contact.left
        line[8] = contact.right
        line[9] = contact.left_yields
        line[10] = contact.right_yields
        line[11] = contact.held
        line[12] = kind
    return row + 1


@kernel
def _unstressed(m, position, z, on_spring, waiting):
    return position - m.yield_deflection * z if on_spring != 0.0 else waiting


def rock_on_springs(m, horizontal, vertical, dt, substeps, quiet_samples, history, locate, every_step=False):
    """Run of the pier ``m`` (Springs) under one motion.

    Parameters
    ----------
    horizontal, vertical : ndarray, shape (npts,)
        Ground accelerations [m/s²], linear between samples, zero from the sample after the last; ``vertical`` may be
        empty.
    dt : float
        Sampling interval [s]; each is ``substeps`` steps.
    quiet_samples : int
        Samples after the record. The run goes on while the pier, left alone, might still overturn.
    history : ndarray, shape (rows, 13)
        Filled with every sample and both sides of every event, as far as it goes; empty for none.
    locate : bool
        Locate events inside the step. Without, they take place at its end (first order; for comparison only).
    every_step : bool
        Also write the steps between samples.

    Returns
    -------
    SpringRun
    """
    # A compiled function hands out plain tuples only: making a named one runs Python code, where Ctrl-C may strike.
    return SpringRun(*_run(m, horizontal, vertical, dt, substeps, quiet_samples, history, locate, every_step))


@entry
def _run(m, horizontal, vertical, dt, substeps, quiet_samples, history, locate, every_step):
    nan = math.nan
    h = dt / substeps
    recording = history.shape[0] > 0
    has_vertical = len(vertical) > 0
    npts = len(horizontal)
    samples = npts - 1 + quiet_samples
    rest = at_rest(m)
    alpha = math.atan2(m.half_width, m.height)
    size2 = m.half_width * m.half_width + m.height * m.height
    p = math.sqrt(m.gravity * math.sqrt(size2) / (m.inertia + size2))
    longest = samples + patience(p, dt)

    y = static_state(m)
    branch = 1.0 if m.law == BOUC_WEN else 0.0
    contact = Contact(1.0, 1.0, branch, branch, 0)
    supports = Supports(nan, nan)
    plastic = y.v - m.yield_deflection * y.z_left  # of both supports, in the static state
    loading = Loading(plastic, y.z_left, 0.0, plastic, y.z_right, 0.0)
    extremes = Extremes(0.0, 0.0, y.v, y.v)
    impacts, separations = 0, 0
    t_flight = nan
    status = SURVIVED
    t = 0.0
    rows = 0
    if recording:
        rows = _write(history, rows, t, y, contact, SAMPLE)

    vertical_now = vertical[0] if has_vertical else 0.0
    k1 = rates(m, y, contact, horizontal[0], vertical_now)
    f0, d0 = signals(m, y, k1, contact, nan, nan, rest, horizontal[0], vertical_now)

    sample = 0
    while sample < samples or (sample < longest and undecided(y.theta, y.omega, alpha, p)):
        a0 = horizontal[sample] if sample < npts else 0.0
        a1 = horizontal[sample + 1] if sample + 1 < npts else 0.0
        a_slope = (a1 - a0) / dt
        c0, c_slope = 0.0, 0.0
        if has_vertical:
            c0 = vertical[sample] if sample < npts else 0.0
            c1 = vertical[sample + 1] if sample + 1 < npts else 0.0
            c_slope = (c1 - c0) / dt
        for substep in range(substeps):
            start = substep * h  # since the sample
            done = 0.0  # since the start of the step
            events = 0
            while done < h:
                x = start + done
                ground = Ground(a0 + x * a_slope, a_slope, c0 + x * c_slope, c_slope)
                left = h - done
                reached = step(m, y, k1, contact, ground, left)
                a_end = a0 + (x + left) * a_slope
                c_end = c0 + (x + left) * c_slope
                k_end = rates(m, reached, contact, a_end, c_end)
                f1, d1 = signals(m, reached, k_end, contact, supports.left, supports.right, rest, a_end, c_end)
                which = -1
                if not (
                    quiet(f0.left, d0.left, f1.left, d1.left)
                    and quiet(f0.right, d0.right, f1.right, d1.right)
                    and quiet(f0.left_law, d0.left_law, f1.left_law, d1.left_law)
                    and quiet(f0.right_law, d0.right_law, f1.right_law, d1.right_law)
                ):
                    earliest = left
                    for i in range(4):
                        if locate:
                            after = _crossing(
                                m, y, k1, contact, ground, supports, rest, left, i, f0[i], d0[i], f1[i], d1[i]
                            )
                        else:
                            after = left if f1[i] <= 0.0 else -1.0
                        if after >= 0.0 and (which < 0 or after < earliest):
                            which, earliest = i, after
                    if which >= 0 and earliest < left:
                        left = earliest
                        a_end = a0 + (x + left) * a_slope
                        c_end = c0 + (x + left) * c_slope
                        reached = step(m, y, k1, contact, ground, left)
                        k_end = rates(m, reached, contact, a_end, c_end)

                at, at_end = geometry(m, y.theta), geometry(m, reached.theta)
                extremes = _include(extremes, y, reached, contact, at, at_end, sample * dt + x, left)
                y, k1 = reached, k_end
                if which < 0:
                    f0, d0 = f1, d1
                    break

                done += left
                t = sample * dt + start + done
                before = contact
                if recording:
                    rows = _write(history, rows, t, y, contact, BEFORE_EVENT)
                y, contact, supports, kind = handle(m, y, contact, supports, which, rest, a_end, c_end)
                if recording:
                    rows = _write(history, rows, t, y, contact, kind)
                landed = 0
                if kind == IMPACT_BOTH:
                    landed = 2
                elif kind in (IMPACT_LEFT, IMPACT_RIGHT):
                    landed = 1
                impacts += landed
                separations += landed - on_ground(contact) + on_ground(before)  # a pivot may land and be lifted at once
                loading = _branches(m, loading, before, contact, y)
                k1 = rates(m, y, contact, a_end, c_end)
                f0, d0 = signals(m, y, k1, contact, supports.left, supports.right, rest, a_end, c_end)
                if contact.left == 0.0 and contact.right == 0.0 and contact.held == 0:
                    if math.isnan(t_flight):
                        t_flight = t
                    if not m.guided:
                        beyond = abs(y.theta) >= alpha and y.theta * y.omega > 0.0
                        status = OVERTURNED if beyond else FLIGHT
                        break
                events += 1
                if events > EVENTS_IN_A_STEP:
                    status = CHATTER
                    break
            if status == SURVIVED:
                t = sample * dt + start + h
                status = fallen(y.theta)
                if recording and (status != SURVIVED or (every_step and substep < substeps - 1)):
                    rows = _write(history, rows, t, y, contact, STEP)
            if status != SURVIVED:
                break
        if status != SURVIVED:
            break
        sample += 1
        t = sample * dt
        if recording:
            rows = _write(history, rows, t, y, contact, SAMPLE)

    if status == SURVIVED and sample >= longest and undecided(y.theta, y.omega, alpha, p):
        status = UNDECIDED
    at_end = geometry(m, y.theta)
    base_left = _unstressed(m, y.v + at_end.lift_left, y.z_left, contact.left, supports.left)
    base_right = _unstressed(m, y.v + at_end.lift_right, y.z_right, contact.right, supports.right)
    loading = _branches(m, loading, contact, Contact(0.0, 0.0, 0.0, 0.0, 0), y)
    return (
        status,
        t,
        extremes.peak,
        extremes.t_peak,
        impacts,
        separations,
        t_flight,
        base_left - plastic,
        base_right - plastic,
        extremes.low_left,
        extremes.low_right,
        m.yield_force * loading.work_left,
        m.yield_force * loading.work_right,
        rows,
    )
