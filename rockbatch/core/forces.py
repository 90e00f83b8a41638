"""What the ground, the supports and the gaps under the pivots take of a run that was written down (THEORY.md, Forces).

An observer, like the ledger: it reads the rows of a history, and the equations of motion give the forces of each. Within a
step they are looked at once more, in its middle; runs that do not ask for it pay nothing.
"""

import math
from typing import NamedTuple

from rockbatch.core.creep import forces, top, velocity_of_top
from rockbatch.core.equations import accelerations, geometry, pulled, rates
from rockbatch.core.kernel import entry, kernel
from rockbatch.core.observed import contact_of, ground_at, middle_of, state_of
from rockbatch.core.records import record
from rockbatch.core.restrained.elements import CLOSES, FRICTION, OPENS, distance, force, mode_of, state_rate
from rockbatch.core.rigid.equations import acceleration
from rockbatch.core.trigonometry import sine_and_cosine
from rockbatch.core.types import LEFT, NEITHER, RIGHT


class Forces(NamedTuple):
    """A moment of a run: forces on the pier per unit of its mass, and how it moves over the ground."""

    shear: float  # V/M, horizontal, of the supports on the pier, to the right [m/s²]
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

NEVER = -1.0
"""Time of what does not happen."""

_FRICTION = Forces._fields.index("friction")


class Outline(NamedTuple):
    """What a block on a rigid base has beside Block."""

    size: float  # R0 [m]
    width: float  # 2b between the corners [m]
    deck_share: float  # of the horizontal motion of the centre of mass that the deck makes too
    deck_above: float  # by how much the deck is higher, where it turns with the block [m]


class BlockPull(NamedTuple):
    """What dampers and tendons do to a block that rocks about a corner."""

    down: float  # force that presses it on its supports [m/s²]
    across: float  # and horizontal, towards where it came from
    back: float  # angular deceleration [rad/s²]
    aside: float  # moment about the centre of the base, of forces to the right of it [m²/s²]


@kernel
def _put(out, i, found):
    line = out[i]
    line.shear, line.normal, line.left, line.right = found.shear, found.normal, found.left, found.right
    line.gap_left, line.gap_right = found.gap_left, found.gap_right
    line.speed_left, line.speed_right = found.speed_left, found.speed_right
    line.deck, line.along, line.up, line.omega = found.deck, found.along, found.up, found.omega
    line.friction, line.clearance = found.friction, found.clearance


@kernel
def _include(greatest, firsts, start, middle, end, t, has, gravity):
    """Bring the greatest magnitudes, and the first times, up to a step that ends at ``t`` [s]: its ends, its middle, and where
    the parabola through the three turns."""
    for j in range(len(greatest)):
        slope, bend = end[j] - start[j], start[j] + end[j] - 2.0 * middle[j]
        greatest[j] = max(greatest[j], max(abs(middle[j]), abs(end[j])))
        if abs(slope) < 2.0 * abs(bend) < math.inf:
            greatest[j] = max(greatest[j], abs(middle[j] - slope * slope / (8.0 * bend)))
    if firsts[0] == NEVER and greatest[_FRICTION] > has:
        firsts[0] = t
    if firsts[1] == NEVER and min(middle.normal, end.normal) < -LIFTED * gravity:
        firsts[1] = t


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
    pull_left, pull_right = forces(m, y, contact, at)
    left, right = -pull_left, -pull_right
    free_left = 1.0 if contact.left == 0.0 and contact.held != LEFT else 0.0
    free_right = 1.0 if contact.right == 0.0 and contact.held != RIGHT else 0.0
    gap_left = free_left * (y.v + at.lift_left - top(m, waiting_left, y.z_left))
    gap_right = free_right * (y.v + at.lift_right - top(m, waiting_right, y.z_right))
    return Forces(
        shear, left + right, left, right, gap_left, gap_right,
        free_left * (y.v_rate + at.arm_left * y.omega - velocity_of_top(m, y.z_left)),
        free_right * (y.v_rate + at.arm_right * y.omega - velocity_of_top(m, y.z_right)),
        shear + swung, at.lever * y.omega, y.v_rate, y.omega,
        _friction(m.gravity, shear, left + right), min(gap_left, gap_right),
    )  # fmt: skip


@kernel
def _waits(was, contact, side, waiting, position):
    """Where the support on ``side`` waits [m]: where its pivot has left it, which is at ``position`` now."""
    before, now = (was.left, contact.left) if side == LEFT else (was.right, contact.right)
    left = (before != 0.0 or was.held == side) and now == 0.0 and contact.held != side
    return position if left else waiting


@entry
def forces_on_springs(m, deck, rows, pulls, ground, dt, has, out, greatest, firsts):
    """Forces of a run on two springs: at every row, or the greatest of the whole run.

    Parameters
    ----------
    m : Springs
    deck : float
        Height of the deck above the pivots [m].
    rows : recarray of recording.Row, shape (n,)
        History as the run wrote it, with both sides of every event; for the greatest, with every step.
    pulls : ndarray, shape (n, 2)
        Force [m/s²] and moment [m²/s²] of dampers and tendons at every row.
    ground : ndarray, shape (npts, 4)
        The motion of the run, of :func:`rockbatch.core.ground.ground_rows`.
    dt : float
        Its sampling interval [s].
    has : float
        Friction of the interface.
    out : recarray of Forces, shape (n,) or (0,)
        Filled at every row.
    greatest : ndarray of zeros, shape (12 and more,) or (0,)
        Filled with the greatest magnitude of each of Forces, at the rows, in the middles of steps and between.
    firsts : ndarray of NEVER, shape (2,)
        Filled beside ``greatest``: when |V|/N first exceeds ``has``, and when N is first negative [s].
    """
    waiting_left, waiting_right = 0.0 * deck, 0.0 * deck
    was = contact_of(rows[0])
    under = pulled(m, pulls[0, 0], pulls[0, 1])
    before = on_springs(under, deck, state_of(rows[0]), was, waiting_left, waiting_right, ground[0, 0], ground[0, 2])
    for i in range(len(rows)):
        y, contact, t = state_of(rows[i]), contact_of(rows[i]), rows[i].t
        at = geometry(m, y.theta)
        # A damped support creeps back to where it is unstressed
        left_at = y.v + at.lift_left - m.yield_deflection * y.z_left
        right_at = y.v + at.lift_right - m.yield_deflection * y.z_right
        waiting_left = _waits(was, contact, LEFT, waiting_left, left_at)
        waiting_right = _waits(was, contact, RIGHT, waiting_right, right_at)
        was = contact
        t_start = rows[i - 1].t if i > 0 else t
        t_middle = 0.5 * (t_start + t)
        ah, av = ground_at(ground, dt, t_middle, t)
        under = pulled(m, pulls[i, 0], pulls[i, 1])
        found = on_springs(under, deck, y, contact, waiting_left, waiting_right, ah, av)
        if len(out) > 0:
            _put(out, i, found)
        if len(greatest) == 0:
            continue
        start, middle = found, found
        if t > t_start and rows[i].kind <= 0.0:
            y_start, start = state_of(rows[i - 1]), before
            ah_start, av_start = ground_at(ground, dt, t_middle, t_start)
            k_start = rates(pulled(m, pulls[i - 1, 0], pulls[i - 1, 1]), y_start, contact, ah_start, av_start)
            y = middle_of(y_start, k_start, y, rates(under, y, contact, ah, av), t - t_start)
            ah, av = 0.5 * (ah_start + ah), 0.5 * (av_start + av)
            under = pulled(m, 0.5 * (pulls[i - 1, 0] + pulls[i, 0]), 0.5 * (pulls[i - 1, 1] + pulls[i, 1]))
            middle = on_springs(under, deck, y, contact, waiting_left, waiting_right, ah, av)
        _include(greatest, firsts, start, middle, found, t, has, m.gravity)
        before = found


@kernel
def _way(speed):
    return 0.0 if speed == 0.0 else (OPENS if speed > 0.0 else CLOSES)


@kernel
def _pull(m, elements, states, inertia, theta, omega, side):
    """Pull of all ``elements`` but of friction dampers that do not move; ``states`` are theirs, shape (elements,)."""
    down, across = 0.0 * m.gravity, 0.0 * m.gravity
    back, aside = 0.0 * m.p * m.p, 0.0 * m.p * m.p * inertia
    half_sine, half_cosine = sine_and_cosine(0.5 * abs(theta))
    for j in range(len(elements)):
        of = elements[j]
        d = distance(of, side)
        elongation, speed = 2.0 * d * half_sine, d * half_cosine * side * omega
        goes = _way(speed)
        one = force(of, elongation, speed, states[j], mode_of(of, elongation, states[j], goes), goes)
        down, across = down + one * half_cosine, across + one * half_sine
        back, aside = back + one * d * half_cosine / inertia, aside + one * of.offset
    return BlockPull(down, across, back, aside)


@kernel
def _state_rate(of, state, theta, omega, side):
    """Rate of an element's state [1/s or m/s]."""
    half_sine, half_cosine = sine_and_cosine(0.5 * abs(theta))
    d = distance(of, side)
    speed = d * half_cosine * side * omega
    goes = _way(speed)
    return state_rate(of, speed, state, mode_of(of, 2.0 * d * half_sine, state, goes), goes)


@kernel
def _friction_pull(m, elements, inertia, theta, side):
    """Pull of friction dampers that are about to give way; of one in the corner nothing is known, and nothing depends on it."""
    down, across, back = 0.0 * m.gravity, 0.0 * m.gravity, 0.0 * m.p * m.p
    half_sine, half_cosine = sine_and_cosine(0.5 * abs(theta))
    for j in range(len(elements)):
        d = distance(elements[j], side)
        if elements[j].kind == FRICTION and d != 0.0:
            one = elements[j].strength if d > 0.0 else -elements[j].strength
            down, across = down + one * half_cosine, across + one * half_sine
            back += one * d * half_cosine / inertia
    return BlockPull(down, across, back, 0.0 * back * inertia)


@kernel
def on_rigid_base(m, outline, elements, states, theta, omega, side, horizontal, vertical):
    """Forces on a block about its corner on ``side``, or NEITHER: at rest on both.

    At rest both corners bear what moment and weight ask for; what would lift one of them friction dampers hold, as far as they
    can. A block that the ground lifts at this moment is no longer at rest.
    """
    inertia = m.gravity * outline.size / (m.p * m.p)  # I0/M + R0²
    pull = _pull(m, elements, states, inertia, theta, omega, side)
    if side == NEITHER:
        sine, cosine = sine_and_cosine(m.alpha)
        b = 0.5 * outline.width
        normal, more = m.gravity + vertical + pull.down, horizontal * cosine / sine - pull.aside / b
        pressed = LEFT if more > 0.0 else RIGHT
        hold = _friction_pull(m, elements, inertia, theta, pressed)
        lacks = (abs(more) - normal) * b / inertia
        if lacks <= hold.back:
            share = lacks / hold.back if lacks > 0.0 else 0.0
            normal += share * hold.down
            on_left, on_right = 0.5 * (normal + more), 0.5 * (normal - more)
            if lacks > 0.0:
                on_left, on_right = (normal, 0.0 * normal) if pressed == LEFT else (0.0 * normal, normal)
            still = 0.0 * outline.size * omega
            gap = 0.0 * outline.width
            return Forces(
                horizontal, normal, on_left, on_right,
                gap, gap, still, still, horizontal, still, still, omega, _friction(m.gravity, horizontal, normal), gap,
            )  # fmt: skip
        side = pressed
        pull = _pull(m, elements, states, inertia, theta, omega, side)
    turning, squared = acceleration(m, theta, side, horizontal, vertical) - side * pull.back, omega * omega
    share = 0.0
    hold = _friction_pull(m, elements, inertia, theta, side)
    if omega == 0.0 and hold.back > 0.0:
        share = min(max(side * turning / hold.back, -1.0), 1.0)
        turning -= side * share * hold.back
    down, across = pull.down + share * hold.down, pull.across + share * hold.across
    sine, cosine = sine_and_cosine(side * m.alpha - theta)
    along = outline.size * (cosine * turning + sine * squared)
    normal = m.gravity + vertical + outline.size * (sine * turning - cosine * squared) + down
    shear = horizontal + along + side * across
    tilt_sine, tilt_cosine = sine_and_cosine(theta)
    deck = outline.deck_share * along + outline.deck_above * (tilt_cosine * turning - tilt_sine * squared)
    on_left, on_right = (1.0, 0.0) if side == LEFT else (0.0, 1.0)
    gap, speed = side * outline.width * tilt_sine, side * outline.width * tilt_cosine * omega
    return Forces(
        shear, normal, on_left * normal, on_right * normal,
        on_right * gap, on_left * gap, on_right * speed, on_left * speed,
        horizontal + deck, outline.size * cosine * omega, outline.size * sine * omega, omega,
        _friction(m.gravity, shear, normal), 0.0 * outline.width,
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
def forces_on_rigid_base(m, outline, elements, rows, states, halfway, ground, dt, has, out, greatest, firsts):
    """Forces of a run on a rigid base: ``m`` is a Block, ``outline`` an Outline, ``rows`` (rigid.lane.Row) its history,
    ``elements`` a recarray of Element and ``states`` theirs at every row, shape (n, elements), with room for one more in
    ``halfway``; otherwise as :func:`forces_on_springs`."""
    side = _corner(rows[0])
    theta, omega, ah, av = rows[0].theta, rows[0].omega, ground[0, 0], ground[0, 2]
    before = on_rigid_base(m, outline, elements, states[0], theta, omega, side, ah, av)
    inertia = m.gravity * outline.size / (m.p * m.p)
    for i in range(len(rows)):
        theta, omega, side, t = rows[i].theta, rows[i].omega, _corner(rows[i]), rows[i].t
        t_start = rows[i - 1].t if i > 0 else t
        t_middle = 0.5 * (t_start + t)
        ah, av = ground_at(ground, dt, t_middle, t)
        found = on_rigid_base(m, outline, elements, states[i], theta, omega, side, ah, av)
        if len(out) > 0:
            _put(out, i, found)
        if len(greatest) == 0:
            continue
        start, middle = found, found
        if t > t_start and rows[i].kind <= 0.0:
            theta_start, omega_start, start = rows[i - 1].theta, rows[i - 1].omega, before
            ah_start, av_start = ground_at(ground, dt, t_middle, t_start)
            h = t - t_start
            leaning = 0.5 * (theta_start + theta) + 0.125 * h * (omega_start - omega)
            side = NEITHER if leaning == 0.0 else (RIGHT if leaning > 0.0 else LEFT)
            for j in range(len(elements)):
                halfway[j] = states[i, j]
            if side != NEITHER:
                k_start = acceleration(m, theta_start, side, ah_start, av_start)
                k_end = acceleration(m, theta, side, ah, av)
                k_start -= side * _pull(m, elements, states[i - 1], inertia, theta_start, omega_start, side).back
                k_end -= side * _pull(m, elements, states[i], inertia, theta, omega, side).back
                for j in range(len(elements)):
                    of, z_start, z = elements[j], states[i - 1, j], states[i, j]
                    bend = _state_rate(of, z_start, theta_start, omega_start, side) - _state_rate(
                        of, z, theta, omega, side
                    )
                    halfway[j] = 0.5 * (z_start + z) + 0.125 * h * bend
                theta, omega = leaning, 0.5 * (omega_start + omega) + 0.125 * h * (k_start - k_end)
            ah, av = 0.5 * (ah_start + ah), 0.5 * (av_start + av)
            middle = on_rigid_base(m, outline, elements, halfway, theta, omega, side, ah, av)
        _include(greatest, firsts, start, middle, found, t, has, m.gravity)
        before = found
