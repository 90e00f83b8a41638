"""What the ground, the supports and the gaps under the pivots take of a run that was written down (THEORY.md, Forces).

An observer, like the ledger: it reads the rows of a history, and the equations of motion give the forces of each. Within a
step they are looked at once more, in its middle; runs that do not ask for it pay nothing.
"""

import math
from typing import NamedTuple

from rockbatch.core.block.equations import side_of
from rockbatch.core.kernel import entry, kernel
from rockbatch.core.observe.rows import block_contact, block_state, ground_at, middle_of, spring_contact, spring_state
from rockbatch.core.springs.creep import forces, top, velocity_of_top
from rockbatch.core.springs.equations import accelerations_at, geometry
from rockbatch.core.system import accelerations, airborne, clearances, pulled, rates
from rockbatch.core.table import record
from rockbatch.core.trigonometry import sine_and_cosine
from rockbatch.core.types import LEFT, RIGHT


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


class Hold(NamedTuple):
    """Friction against a block at rest that begins to turn about either pivot."""

    left_down: float  # force on the pier [m/s²]
    left_back: float  # angular deceleration [rad/s²]
    right_down: float
    right_back: float


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
    _, turning = accelerations_at(m, y, contact, at, horizontal, vertical)
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
def _halfway(rows, pulls, i, column):
    """Return a number of ``pulls`` in the middle of the step to row ``i``: of the cubic through four rows, or the mean of two.

    Steps that follow dampers' laws differ in length; a cubic does not cross an event.
    """
    mean = 0.5 * (pulls[i - 1, column] + pulls[i, column])
    if i < 2 or i + 1 >= len(rows) or max(rows[i - 1].kind, rows[i + 1].kind) > 0.0:
        return mean
    middle, total = 0.5 * (rows[i - 1].t + rows[i].t), 0.0
    for j in range(i - 2, i + 2):
        weight = 1.0
        for k in range(i - 2, i + 2):
            if k != j:
                weight *= (middle - rows[k].t) / (rows[j].t - rows[k].t)
        total += weight * pulls[j, column]
    return total if abs(total) < math.inf else mean


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
    was = spring_contact(rows[0])
    under = pulled(m, pulls[0, 0], pulls[0, 1])
    before = on_springs(
        under, deck, spring_state(rows[0]), was, waiting_left, waiting_right, ground[0, 0], ground[0, 2]
    )
    for i in range(len(rows)):
        y, contact, t = spring_state(rows[i]), spring_contact(rows[i]), rows[i].t
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
            y_start, start = spring_state(rows[i - 1]), before
            ah_start, av_start = ground_at(ground, dt, t_middle, t_start)
            k_start = rates(pulled(m, pulls[i - 1, 0], pulls[i - 1, 1]), y_start, contact, ah_start, av_start)
            y = middle_of(y_start, k_start, y, rates(under, y, contact, ah, av), t - t_start)
            ah, av = 0.5 * (ah_start + ah), 0.5 * (av_start + av)
            under = pulled(m, _halfway(rows, pulls, i, 0), _halfway(rows, pulls, i, 1))
            middle = on_springs(under, deck, y, contact, waiting_left, waiting_right, ah, av)
        _include(greatest, firsts, start, middle, found, t, has, m.gravity)
        before = found


@kernel
def _at_rest(m, outline, hold, y, horizontal, vertical):
    """Return the forces on a block at rest on both pivots, and the pivot about which it would turn, 0 if it stays.

    Both bear what moment and weight ask for; what would lift one of them friction holds, as far as it can.
    """
    b, still, gap = 0.5 * outline.width, 0.0 * outline.size * y.omega, 0.0 * outline.width
    normal = m.gravity + vertical + m.pull.force
    more = horizontal * m.height / m.half_width + m.pull.moment / b
    pressed = LEFT if more > 0.0 else RIGHT
    down, back = (hold.left_down, hold.left_back) if pressed == LEFT else (hold.right_down, hold.right_back)
    lacks = (abs(more) - normal) * b * m.quickness
    share = lacks / back if lacks > 0.0 else 0.0
    normal += share * down if lacks <= back else 0.0
    on_left, on_right = 0.5 * (normal + more), 0.5 * (normal - more)
    if lacks > 0.0:
        on_left, on_right = (normal, 0.0 * normal) if pressed == LEFT else (0.0 * normal, normal)
    found = Forces(
        horizontal, normal, on_left, on_right,
        gap, gap, still, still, horizontal, still, still, y.omega, _friction(m.gravity, horizontal, normal), gap,
    )  # fmt: skip
    return found, (pressed if lacks > back else 0.0)


@kernel
def on_block(m, outline, hold, y, contact, horizontal, vertical):
    """Return the forces on a block, rocking about a pivot, in flight or at rest.

    Devices pull along the chord of the way of their places, to which cos(θ/2) of their force is vertical.
    """
    side = side_of(contact)
    flies = airborne(m, contact)
    if side == 0.0 and not flies:
        found, turns = _at_rest(m, outline, hold, y, horizontal, vertical)
        if turns == 0.0:
            return found
        side = turns
        contact = type(contact)(0.5 * (1.0 - side), 0.5 * (1.0 + side), side)
    v_acceleration, turning = accelerations(m, y, contact, horizontal, vertical)
    squared, lean = y.omega * y.omega, (side if side != 0.0 else contact.bore)
    sine, cosine = sine_and_cosine(y.theta)
    half_sine, half_cosine = sine_and_cosine(0.5 * y.theta)
    lever = m.height * cosine + lean * m.half_width * sine
    slope = lean * m.half_width * cosine - m.height * sine
    along = lever * turning + slope * squared
    pull = m.pull.force * half_cosine
    grounded = 0.0 if flies else 1.0
    normal = grounded * (m.gravity + vertical + v_acceleration + pull * half_cosine)
    shear = horizontal + along + grounded * pull * half_sine
    deck = outline.deck_share * along + outline.deck_above * (cosine * turning - sine * squared)
    on_left, on_right = contact.left, contact.right
    left, right, left_speed, right_speed = clearances(m, y, None)
    wide = (
        0.5 * outline.width / m.half_width
    )  # 1, but of a frame, whose columns are narrower than the block that stands for them
    off_left, off_right = wide * (1.0 - on_left), wide * (1.0 - on_right)
    return Forces(
        shear, normal, on_left * normal, on_right * normal,
        off_left * left, off_right * right, off_left * left_speed, off_right * right_speed,
        horizontal + deck, lever * y.omega, y.v_rate, y.omega,
        _friction(m.gravity, shear, normal), min(off_left * left, off_right * right),
    )  # fmt: skip


@entry
def forces_on_rigid_base(m, outline, hold, rows, pulls, ground, dt, has, out, greatest, firsts):
    """Forces of a run on a rigid base: ``m`` is a Block, ``outline`` an Outline, ``hold`` a Hold; as forces_on_springs."""
    under = pulled(m, pulls[0, 0], pulls[0, 1])
    before = on_block(under, outline, hold, block_state(rows[0]), block_contact(rows[0]), ground[0, 0], ground[0, 2])
    for i in range(len(rows)):
        y, contact, t = block_state(rows[i]), block_contact(rows[i]), rows[i].t
        t_start = rows[i - 1].t if i > 0 else t
        t_middle = 0.5 * (t_start + t)
        ah, av = ground_at(ground, dt, t_middle, t)
        under = pulled(m, pulls[i, 0], pulls[i, 1])
        found = on_block(under, outline, hold, y, contact, ah, av)
        if len(out) > 0:
            _put(out, i, found)
        if len(greatest) == 0:
            continue
        start, middle = found, found
        if t > t_start and rows[i].kind <= 0.0:
            y_start, start = block_state(rows[i - 1]), before
            ah_start, av_start = ground_at(ground, dt, t_middle, t_start)
            k_start = rates(pulled(m, pulls[i - 1, 0], pulls[i - 1, 1]), y_start, contact, ah_start, av_start)
            y = middle_of(y_start, k_start, y, rates(under, y, contact, ah, av), t - t_start)
            ah, av = 0.5 * (ah_start + ah), 0.5 * (av_start + av)
            under = pulled(m, _halfway(rows, pulls, i, 0), _halfway(rows, pulls, i, 1))
            middle = on_block(under, outline, hold, y, contact, ah, av)
        _include(greatest, firsts, start, middle, found, t, has, m.gravity)
        before = found
