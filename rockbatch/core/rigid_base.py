"""A run on a rigid base (Housner 1963): rocking about two corners, impacts, rest, and lift-off again."""

import math

import numpy as np

from rockbatch.core.free_vibration import reach_on_rigid_base
from rockbatch.core.ground import ground_rows
from rockbatch.core.kernel import entry, kernel
from rockbatch.core.outcome import WINDOWS, fallen, widen
from rockbatch.core.roots import BISECT_AFTER, CLOSE, TRIALS, excess, falls, largest_within
from rockbatch.core.types import (
    BEFORE_EVENT,
    CHATTER,
    FLIGHT,
    IMPACT_LEFT,
    IMPACT_RIGHT,
    LIFT_OFF,
    REST,
    RESTLESS,
    SAMPLE,
    STEP,
    SURVIVED,
    UNDECIDED,
    Block,
    Ground,
    RigidRun,
)

EVENTS_IN_A_SAMPLE = 20_000
RESULTS = len(RigidRun._fields)
HISTORY_COLUMNS = 4  # t, theta, omega, kind of row
NEGLIGIBLE = 1e-13  # of α: height of the bounces that are summed up instead of followed

_NO_HISTORY = np.empty((0, HISTORY_COLUMNS))


@kernel
def acceleration(m, theta, side, horizontal, vertical):
    """θ̈ [rad/s²] while rocking about the corner on ``side`` (−1 left, 1 right)."""
    angle = side * m.alpha - theta
    lean = (1.0 + vertical / m.gravity) * math.sin(angle) + horizontal / m.gravity * math.cos(angle)
    return -m.p * m.p * lean


@kernel
def rocking_step(m, theta, omega, k1, side, ground, h):
    """One Runge–Kutta step of order 4 over ``h`` [s]; ``k1`` is θ̈ at its start. Returns θ, θ̇."""
    half = 0.5 * h
    a_middle = ground.horizontal + half * ground.horizontal_slope
    c_middle = ground.vertical + half * ground.vertical_slope
    omega2 = omega + half * k1
    k2 = acceleration(m, theta + half * omega, side, a_middle, c_middle)
    omega3 = omega + half * k2
    k3 = acceleration(m, theta + half * omega2, side, a_middle, c_middle)
    omega4 = omega + h * k3
    a_end = ground.horizontal + h * ground.horizontal_slope
    c_end = ground.vertical + h * ground.vertical_slope
    k4 = acceleration(m, theta + h * omega3, side, a_end, c_end)
    return (
        theta + h / 6.0 * (omega + 2.0 * (omega2 + omega3) + omega4),
        omega + h / 6.0 * (k1 + 2.0 * (k2 + k3) + k4),
    )


@kernel
def lift_off(m, ground, h):
    """Time in [0, h] from which the ground overcomes |ü_g| = (g + v̈_g) tan α, −1 if it does not; and the side.

    Exact, since the ground acceleration is linear in time. A positive ü_g throws the block to the left.
    """
    tangent = math.tan(m.alpha)
    first, side = -1.0, 0.0
    for sign in (-1.0, 1.0):
        excess = sign * ground.horizontal - (m.gravity + ground.vertical) * tangent
        slope = sign * ground.horizontal_slope - ground.vertical_slope * tangent
        at = -1.0
        if excess > 0.0 or (excess == 0.0 and slope > 0.0):
            at = 0.0
        elif slope > 0.0 and excess + slope * h > 0.0:
            at = min(-excess / slope, h)
        if at >= 0.0 and (first < 0.0 or at < first):
            first, side = at, -sign
    return first, side


@kernel
def time_to_rest(m, omega, horizontal, vertical):
    """Height [rad] of the next bounce, and the time [s] of all that are left (Zeno), if the ground allows rest.

    Small bounces see constant accelerations κ± towards rest on either side, take 2 θ̇/κ± each, and shrink by e.
    Infinite where there is no rest.
    """
    speed = abs(omega)
    here = 1.0 if omega > 0.0 else -1.0
    towards = -here * acceleration(m, 0.0, here, horizontal, vertical)
    back = here * acceleration(m, 0.0, -here, horizontal, vertical)
    if towards <= 0.0 or back <= 0.0 or m.restitution == 1.0:
        return math.inf, math.inf
    total = 2.0 * speed * (1.0 / towards + m.restitution / back)
    return 0.5 * speed * speed / min(towards, back), total / (1.0 - m.restitution * m.restitution)


@kernel
def _landing(m, theta, omega, k1, side, ground, h, end_theta, end_omega):
    """Time in [0, h] at which the block is back on both corners, −1 if it is not."""
    a, f_a, d_a = 0.0, side * theta, side * omega
    b, f_b, d_b = h, side * end_theta, side * end_omega
    at = falls(f_a, d_a, f_b, d_b, h)
    for trial in range(TRIALS):
        if at < 0.0 or at <= CLOSE * h:
            break
        x = a + at if trial < BISECT_AFTER or trial % 2 == 0 else 0.5 * (a + b)
        theta_x, omega_x = rocking_step(m, theta, omega, k1, side, ground, x)
        f_x, d_x = side * theta_x, side * omega_x
        if falls(f_a, d_a, f_x, d_x, x - a) >= 0.0:
            b, f_b, d_b = x, f_x, d_x
        else:
            a, f_a, d_a = x, f_x, d_x
        at = falls(f_a, d_a, f_b, d_b, b - a)
        if at >= 0.0 and abs(a + at - x) <= CLOSE * h:
            return x
    return a + at if at >= 0.0 else -1.0


@kernel
def _write(history, row, t, theta, omega, kind):
    """Row of a history, where there is room for it."""
    if row < history.shape[0]:
        line = history[row]
        line[0] = t
        line[1] = theta
        line[2] = omega
        line[3] = kind
    return row + 1


def run_line(m, theta, omega, dt, substeps, quiet_samples, first_row, npts, patience=0):
    """A run as :func:`rock_one_by_one` takes it: numbers only.

    Parameters
    ----------
    m : Block
    theta, omega : float
        Rotation [rad] and angular velocity [rad/s] at the start; 0, 0 is rest.
    dt, substeps, quiet_samples, first_row, npts, patience
        As for the pier on two springs.
    """
    return (*m, theta, omega, dt, substeps, quiet_samples, first_row, npts, patience)


def rock_one_by_one(lines, ground, stop, locate=True, every_step=False, history=_NO_HISTORY):
    """Runs of piers on a rigid base.

    Parameters
    ----------
    lines : ndarray, shape (runs, 12)
        Of :func:`run_line`.
    ground, stop, locate, every_step
        As for the pier on two springs.
    history : ndarray, shape (rows, 4)
        For a single run: filled with every sample and both sides of every event, as far as it goes.

    Returns
    -------
    ndarray, shape (runs, RESULTS + WINDOWS)
        As RigidRun has it, and the greatest |θ| in each window of the run; NaN for those that were stopped.
    """
    results = np.full((len(lines), RESULTS + WINDOWS), np.nan)
    _rock_all(lines, ground, locate, every_step, history, stop, results)
    return results


def rock_on_rigid_base(
    m, theta, omega, horizontal, vertical, dt, substeps, quiet_samples, history, locate, every_step=False
):
    """One run, of the pier ``m`` (Block) under one motion; RigidRun.

    ``horizontal`` and ``vertical`` are ground accelerations [m/s²], shape (npts,), the vertical one may be empty; for
    the others see :func:`run_line` and :func:`rock_one_by_one`.
    """
    lines = np.array([run_line(m, theta, omega, dt, substeps, quiet_samples, 0, len(horizontal))])
    ground = ground_rows(horizontal, vertical, dt)
    return rigid_run(rock_one_by_one(lines, ground, np.zeros(1, np.uint8), locate, every_step, history)[0])


def rigid_run(line):
    """RigidRun of a line of results."""
    run = RigidRun(*line[:RESULTS].tolist())
    counts = ("status", "impacts", "lift_offs", "rows")
    return run._replace(**{name: int(getattr(run, name)) for name in counts})


@entry
def _rock_all(lines, ground, locate, every_step, history, stop, results):
    for i in range(len(lines)):
        if stop[0] != 0:
            return
        line = lines[i]
        m = Block(line[0], line[1], line[2], line[3])
        first = int(line[9])
        motion = ground[first : first + int(line[10])]
        _rock(
            m, line[4], line[5], motion, line[6], int(line[7]), int(line[8]), int(line[11]), locate, every_step, history, stop,
            results[i], results[i][RESULTS:],
        )  # fmt: skip


@kernel
def _rock(
    m, theta, omega, motion, dt, substeps, quiet_samples, patience, locate, every_step, history, stop, result, extremes
):  # fmt: skip
    """One run; ``result`` stays as it is after a stop, but for the ``extremes`` of its windows."""
    h = dt / substeps
    recording = history.shape[0] > 0
    npts = len(motion)
    samples = npts - 1 + quiet_samples
    longest = samples + patience
    resting = theta == 0.0 and omega == 0.0
    side = 1.0 if theta > 0.0 or (theta == 0.0 and omega > 0.0) else -1.0
    peak, t_peak = abs(theta), 0.0
    impacts, lift_offs = 0, 0
    t_flight = math.nan
    t_rest = 0.0 if resting else math.nan
    status = SURVIVED
    t = 0.0
    rows = 0
    if recording:
        rows = _write(history, rows, t, theta, omega, SAMPLE)

    sample = 0
    turned = False  # since the ground came to rest
    while True:
        at_rest = sample >= npts or (sample == npts - 1 and motion[sample, 0] == 0.0 and motion[sample, 2] == 0.0)
        over = resting or (at_rest and _decided(m, theta, omega, peak, turned))
        if sample >= samples and (over or sample >= longest):
            break
        if stop[0] != 0:
            return
        events = 0
        a0, a_slope, c0, c_slope = 0.0, 0.0, 0.0, 0.0
        if sample < npts:
            a0, a_slope, c0, c_slope = motion[sample, 0], motion[sample, 1], motion[sample, 2], motion[sample, 3]
        until = dt
        drops = min(c0, c0 + c_slope * dt) <= -m.gravity  # the ground, from under the block
        if drops:
            until = 0.0 if c0 <= -m.gravity else (-m.gravity - c0) / c_slope
        if resting and not drops and lift_off(m, Ground(a0, a_slope, c0, c_slope), dt)[0] < 0.0:
            sample += 1
            widen(extremes, sample, samples, theta)
            t = sample * dt
            if recording:
                rows = _write(history, rows, t, theta, omega, SAMPLE)
            continue
        for substep in range(substeps):
            start = substep * h
            whole = min(h, until - start)
            done = 0.0
            while done < whole:
                x = start + done
                left = whole - done
                ground = Ground(a0 + x * a_slope, a_slope, c0 + x * c_slope, c_slope)
                if resting:
                    at, side_up = lift_off(m, ground, left)
                    if at < 0.0 or at >= left:
                        break
                    side = side_up
                    resting = False
                    t_rest = math.nan
                    lift_offs += 1
                    done += at
                    if recording:
                        rows = _write(history, rows, sample * dt + start + done, theta, omega, LIFT_OFF)
                    continue
                k1 = acceleration(m, theta, side, ground.horizontal, ground.vertical)
                end_theta, end_omega = rocking_step(m, theta, omega, k1, side, ground, left)
                landed = False
                # also where it may have been back in between, and gone again
                if min(side * theta, side * end_theta) <= excess(omega, end_omega, left):
                    if locate:
                        at = _landing(m, theta, omega, k1, side, ground, left, end_theta, end_omega)
                    else:
                        at = left if side * end_theta <= 0.0 else -1.0
                    if at >= 0.0:
                        landed = True
                        if at < left:
                            left = at
                            end_theta, end_omega = rocking_step(m, theta, omega, k1, side, ground, left)
                found, peak = largest_within(theta, omega, end_theta, end_omega, left, peak)
                if found >= 0.0:
                    t_peak = sample * dt + x + found
                turned = turned or (at_rest and omega * end_omega < 0.0)
                theta, omega = end_theta, end_omega
                done = done + left if landed else whole
                if not landed:
                    continue

                impacts += 1
                t = sample * dt + start + done
                theta = 0.0
                if recording:
                    rows = _write(history, rows, t, theta, omega, BEFORE_EVENT)
                omega *= m.restitution
                kind = IMPACT_LEFT if side > 0.0 else IMPACT_RIGHT
                height, remaining = time_to_rest(
                    m,
                    omega,
                    ground.horizontal + left * a_slope,
                    ground.vertical + left * c_slope,
                )
                if omega == 0.0 or (height < NEGLIGIBLE * m.alpha and remaining < dt):
                    t_rest = t + (remaining if omega != 0.0 else 0.0)
                    omega = 0.0
                    resting = True
                    kind = REST
                else:
                    side = 1.0 if omega > 0.0 else -1.0
                if recording:
                    rows = _write(history, rows, t, theta, omega, kind)
                events += 1
                if events > EVENTS_IN_A_SAMPLE:
                    status = CHATTER
                    break
            if status == SURVIVED:
                t = sample * dt + start + whole
                status = fallen(theta)
                if status == SURVIVED and drops and start + h >= until:
                    t_flight = t
                    status = FLIGHT
                if recording and (status != SURVIVED or (every_step and substep < substeps - 1)):
                    rows = _write(history, rows, t, theta, omega, STEP)
            if status != SURVIVED:
                break
        if status != SURVIVED:
            break
        sample += 1
        t = sample * dt
        widen(extremes, sample, samples, theta)
        if recording:
            rows = _write(history, rows, t, theta, omega, SAMPLE)

    if status == SURVIVED and not over and patience > 0:
        status = RESTLESS if reach_on_rigid_base(theta, omega, m.alpha, m.p) < math.inf else UNDECIDED
    result[0] = status
    result[1] = t
    result[2] = peak
    result[3] = t_peak
    result[4] = impacts
    result[5] = lift_offs
    result[6] = t_flight
    result[7] = t_rest
    result[8] = rows


@kernel
def _decided(m, theta, omega, peak, turned):
    """Whether nothing that comes later can exceed ``peak``, with the ground at rest: each bounce loses energy.

    Once the rotation has ``turned``, its extreme has been seen, and those to come are lower.
    """
    reach = reach_on_rigid_base(theta, omega, m.alpha, m.p)
    return reach <= peak or (turned and reach < math.inf)
