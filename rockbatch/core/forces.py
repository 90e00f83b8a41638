"""What the ground, the supports and the gaps under the pivots take of a run that was written down (THEORY.md, 7).

An observer, like the ledger: it reads the rows of a history, and the equations of motion give the forces of each. Within a
step they are looked at once more, in its middle; runs that do not ask for it pay nothing.
"""

import math
from typing import NamedTuple

from rockbatch.core.equations import accelerations, geometry, rates
from rockbatch.core.kernel import entry, kernel
from rockbatch.core.observed import contact_of, ground_at, middle_of, state_of
from rockbatch.core.records import record
from rockbatch.core.rigid.equations import acceleration, lift_off
from rockbatch.core.trigonometry import sine_and_cosine
from rockbatch.core.types import LEFT, NEITHER, RIGHT, Ground


class Forces(NamedTuple):
    """A moment of a run: forces on the pier per unit of its mass, and how it moves over the ground."""

    shear: float  # V/M, horizontal, of the ground on the pier, to the right [m/s²]
    normal: float  # N/M, vertical, of all supports, up [m/s²]
    left: float  # of the left support [m/s²]
    right: float
    gap_left: float  # of the pivot above where its support waits [m]
    gap_right: float
    speed_left: float  # at which it opens [m/s]
    speed_right: float
    deck: float  # absolute horizontal acceleration of the deck [m/s²]
    along: float  # velocity of the centre of mass over the ground, to the right, of springs as in full contact [m/s]
    up: float  # and upwards
    omega: float  # [rad/s]
    friction: float  # |V|/N; infinite where nothing presses the pier down
    clearance: float  # of the lower pivot [m]


FORCES = record(Forces)

LIFTED = 1e-9
"""Of g: a normal force that is no more than rounding."""


class Outline(NamedTuple):
    """What a block on a rigid base has beside Block."""

    size: float  # R0 [m]
    width: float  # 2b between the corners [m]
    deck_share: float  # of the horizontal motion of the centre of mass that the deck makes too
    deck_above: float  # by how much the deck is higher, where it turns with the block [m]


@kernel
def _put(out, i, found):
    line = out[i]
    line.shear, line.normal, line.left, line.right = found.shear, found.normal, found.left, found.right
    line.gap_left, line.gap_right = found.gap_left, found.gap_right
    line.speed_left, line.speed_right = found.speed_left, found.speed_right
    line.deck, line.along, line.up, line.omega = found.deck, found.along, found.up, found.omega
    line.friction, line.clearance = found.friction, found.clearance


@kernel
def _friction(gravity, shear, normal):
    return abs(shear) / normal if normal > LIFTED * gravity else math.inf


@kernel
def on_springs(m, deck, y, contact, waiting_left, waiting_right, horizontal, vertical):
    """Forces in state ``y``; the supports of free pivots wait at ``waiting_…`` [m], the deck is at the height ``deck`` [m]."""
    at = geometry(m, y.theta)
    _, turning = accelerations(m, y, contact, at, horizontal, vertical)
    squared = y.omega * y.omega
    lever, bend = m.height, 0.0 * m.height
    swung = (deck - m.height) * turning
    if m.finite is not None:
        side = contact.right - contact.left
        lever, bend = at.lever + side * at.swing, at.lever_slope + side * at.swing_slope
        sine, cosine = sine_and_cosine(y.theta)
        swung = (deck - m.height) * (cosine * turning - sine * squared)
    shear = horizontal + lever * turning + bend * squared
    left, right = -m.yield_force * y.z_left, -m.yield_force * y.z_right
    free_left = 1.0 if contact.left == 0.0 and contact.held != LEFT else 0.0
    free_right = 1.0 if contact.right == 0.0 and contact.held != RIGHT else 0.0
    gap_left = free_left * (y.v + at.lift_left - waiting_left)
    gap_right = free_right * (y.v + at.lift_right - waiting_right)
    return Forces(
        shear, left + right, left, right, gap_left, gap_right,
        free_left * (y.v_rate + at.arm_left * y.omega), free_right * (y.v_rate + at.arm_right * y.omega),
        shear + swung, at.lever * y.omega, y.v_rate, y.omega,
        _friction(m.gravity, shear, left + right), min(gap_left, gap_right),
    )  # fmt: skip


@entry
def forces_on_springs(m, deck, rows, ground, dt, out, middles):
    """Forces of a run on two springs.

    Parameters
    ----------
    m : Springs
    deck : float
        Height of the deck above the pivots [m].
    rows : recarray of recording.Row, shape (n,)
        History as the run wrote it, with both sides of every event.
    ground : ndarray, shape (npts, 4)
        The motion of the run, of :func:`rockbatch.core.ground.ground_rows`.
    dt : float
        Its sampling interval [s].
    out : recarray of Forces, shape (n,)
        Filled at every row.
    middles : recarray of Forces, shape (n,) or (0,)
        Filled in the middle of the step that ends at a row; at the other side of an event, as ``out``. Only of a history
        that has every step.
    """
    waiting_left, waiting_right = 0.0 * deck, 0.0 * deck
    was = contact_of(rows[0])
    for i in range(len(rows)):
        y, contact, t = state_of(rows[i]), contact_of(rows[i]), rows[i].t
        at = geometry(m, y.theta)
        # A support waits where its pivot has left it
        if (was.left != 0.0 or was.held == LEFT) and contact.left == 0.0 and contact.held != LEFT:
            waiting_left = y.v + at.lift_left
        if (was.right != 0.0 or was.held == RIGHT) and contact.right == 0.0 and contact.held != RIGHT:
            waiting_right = y.v + at.lift_right
        was = contact
        before = rows[i - 1].t if i > 0 else t
        middle = 0.5 * (before + t)
        ah, av = ground_at(ground, dt, middle, t)
        _put(out, i, on_springs(m, deck, y, contact, waiting_left, waiting_right, ah, av))
        if len(middles) == 0:
            continue
        if i > 0 and rows[i].kind <= 0.0:
            start = state_of(rows[i - 1])
            ah_start, av_start = ground_at(ground, dt, middle, before)
            ah_middle, av_middle = 0.5 * (ah_start + ah), 0.5 * (av_start + av)
            k_start, k_end = rates(m, start, contact, ah_start, av_start), rates(m, y, contact, ah, av)
            y = middle_of(start, k_start, y, k_end, t - before)
            ah, av = ah_middle, av_middle
        _put(middles, i, on_springs(m, deck, y, contact, waiting_left, waiting_right, ah, av))


@kernel
def on_rigid_base(m, outline, theta, omega, side, horizontal, vertical):
    """Forces on a block about its corner on ``side``, or NEITHER: at rest on both.

    At rest both corners bear what moment and weight ask for. A block that the ground lifts at this moment is no longer at rest.
    """
    if side == NEITHER:
        side = lift_off(m, Ground(horizontal, 0.0 * horizontal, vertical, 0.0 * vertical), 0.0)[1]
    if side == NEITHER:
        sine, cosine = sine_and_cosine(m.alpha)
        normal, more = m.gravity + vertical, horizontal * cosine / sine
        still = 0.0 * outline.size * omega
        gap = 0.0 * outline.width
        return Forces(
            horizontal, normal, 0.5 * (normal + more), 0.5 * (normal - more),
            gap, gap, still, still, horizontal, still, still, omega, _friction(m.gravity, horizontal, normal), gap,
        )  # fmt: skip
    turning, squared = acceleration(m, theta, side, horizontal, vertical), omega * omega
    sine, cosine = sine_and_cosine(side * m.alpha - theta)
    along = outline.size * (cosine * turning + sine * squared)
    normal = m.gravity + vertical + outline.size * (sine * turning - cosine * squared)
    tilt_sine, tilt_cosine = sine_and_cosine(theta)
    deck = outline.deck_share * along + outline.deck_above * (tilt_cosine * turning - tilt_sine * squared)
    on_left, on_right = (1.0, 0.0) if side == LEFT else (0.0, 1.0)
    gap, speed = side * outline.width * tilt_sine, side * outline.width * tilt_cosine * omega
    return Forces(
        horizontal + along, normal, on_left * normal, on_right * normal,
        on_right * gap, on_left * gap, on_right * speed, on_left * speed,
        horizontal + deck, outline.size * cosine * omega, outline.size * sine * omega, omega,
        _friction(m.gravity, horizontal + along, normal), 0.0 * outline.width,
    )  # fmt: skip


@kernel
def _corner(row):
    """The corner about which the block of a row rocks; where both touch, that which it comes from or goes to."""
    if row.theta != 0.0:
        return RIGHT if row.theta > 0.0 else LEFT
    if row.omega == 0.0:
        return NEITHER
    goes_right = row.omega > 0.0
    if row.kind <= 0.0:  # before an impact
        goes_right = not goes_right
    return RIGHT if goes_right else LEFT


@entry
def forces_on_rigid_base(m, outline, rows, ground, dt, out, middles):
    """Forces of a run on a rigid base: ``m`` is a Block, ``outline`` an Outline, ``rows`` (rigid.lane.Row) its history;
    otherwise as :func:`forces_on_springs`."""
    for i in range(len(rows)):
        theta, omega, side, t = rows[i].theta, rows[i].omega, _corner(rows[i]), rows[i].t
        before = rows[i - 1].t if i > 0 else t
        middle = 0.5 * (before + t)
        ah, av = ground_at(ground, dt, middle, t)
        _put(out, i, on_rigid_base(m, outline, theta, omega, side, ah, av))
        if len(middles) == 0:
            continue
        if i > 0 and rows[i].kind <= 0.0:
            start_theta, start_omega = rows[i - 1].theta, rows[i - 1].omega
            ah_start, av_start = ground_at(ground, dt, middle, before)
            h = t - before
            leaning = 0.5 * (start_theta + theta) + 0.125 * h * (start_omega - omega)
            side = NEITHER if leaning == 0.0 else (RIGHT if leaning > 0.0 else LEFT)
            if side != NEITHER:
                k_start = acceleration(m, start_theta, side, ah_start, av_start)
                k_end = acceleration(m, theta, side, ah, av)
                theta, omega = leaning, 0.5 * (start_omega + omega) + 0.125 * h * (k_start - k_end)
            ah, av = 0.5 * (ah_start + ah), 0.5 * (av_start + av)
        _put(middles, i, on_rigid_base(m, outline, theta, omega, side, ah, av))


@entry
def greatest(kinds, at_rows, in_middles, out):
    """Greatest magnitudes of a run: at its rows, in the middles of its steps, and between, where the parabola through the
    middle and both ends of a step turns.

    Parameters
    ----------
    kinds : ndarray, shape (n,)
        Of the rows.
    at_rows, in_middles : ndarray, shape (n, k)
        The numbers of Forces, or others alike.
    out : ndarray of zeros, shape (k,)
        Filled.
    """
    for i in range(len(kinds)):
        for j in range(len(out)):
            end = at_rows[i, j]
            out[j] = max(out[j], abs(end))
            if i == 0 or kinds[i] > 0.0:
                continue
            start, middle = at_rows[i - 1, j], in_middles[i, j]
            out[j] = max(out[j], abs(middle))
            slope, bend = end - start, start + end - 2.0 * middle
            if abs(slope) < 2.0 * abs(bend) < math.inf:
                out[j] = max(out[j], abs(middle - slope * slope / (8.0 * bend)))
