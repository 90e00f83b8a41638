"""Runs side by side: a table of numbers with one column, a lane, for each run; and one pass over all of them.

The pass takes every lane a step further with the scalar functions of the core, and says in which lanes something may
have happened on the way. The compiler turns its loop into vector instructions, several lanes at once, because all that
it touches lies in one array at constant distances, nothing in it branches and nothing sums over lanes. Each lane has
its own pier, motion, step and time, and its arithmetic does not see its neighbours: a run comes to the same bits in any
company.
"""

from rockbatch.core.equations import geometry, rates, step
from rockbatch.core.kernel import inlined, kernel
from rockbatch.core.outcome import ON_ITS_SIDE
from rockbatch.core.roots import excess
from rockbatch.core.types import BOUC_WEN, ELASTIC, Contact, Ground, Springs, State

LANES = 16


class Rows:
    """Hands out rows of the table, as offsets into its cells."""

    def __init__(self):
        self.cells = 0

    def __call__(self, count):
        first = self.cells
        self.cells += count * LANES
        return first


rows = Rows()

MODEL = rows(11)  # Springs, with a number for the exponent and nothing for the kinematics
STEP = rows(1)  # h [s]
SUBSTEPS = rows(1)  # steps per sample
GROUND = rows(4)  # at the last sample: horizontal and its slope, vertical and its slope
SAMPLE_TIME = rows(1)  # of the last sample [s]
CONTACT = rows(4)  # Contact without ``held``
WATCH = rows(12)  # coefficients of the signals, see :func:`watch`
WATCHED = rows(1)  # above 0 where the lane shall be looked at whatever the signals say

NOW = rows(6)  # State
RATES = rows(6)
SLOPES = rows(4)  # of the signals
SUBSTEP = rows(1)  # steps since the last sample
START = rows(1)  # of the next piece of a step, since the last sample [s]
LENGTH = rows(1)  # of that piece [s]
PEAK = rows(1)  # greatest |θ| so far [rad]
PEAK_TIME = rows(1)
LOWEST = rows(2)  # positions of the pivots on their springs [m]

BEFORE = rows(6)  # State before the pass
BEFORE_RATES = rows(6)
NEWS = rows(1)  # what the pass has to say

CALM = 0.0  # the lane is a step further
SAMPLED = 1.0  # likewise, and at a sample
EVENTFUL = 2.0  # something may have happened: only NOW, RATES and SLOPES have been brought forward
TURNED = 3.0  # likewise, but what happened first is surely that the velocity of a spring turned


@inlined
def model_of(table, i, exponent, finite):
    """Springs of lane ``i``, of the types that ``exponent`` and ``finite`` tell (see :class:`Springs`)."""
    at = MODEL + i
    return Springs(
        table[at],
        table[at + LANES],
        table[at + 2 * LANES],
        table[at + 3 * LANES],
        table[at + 4 * LANES],
        table[at + 5 * LANES],
        table[at + 6 * LANES],
        table[at + 7 * LANES],
        table[at + 8 * LANES],
        table[at + 9 * LANES],
        _typed(exponent, table[at + 10 * LANES]),
        finite,
    )


@inlined
def _typed(exponent, value):
    return None if exponent is None else value


@inlined
def state_of(table, at):
    """The State in lane and rows that begin with cell ``at``."""
    return State(
        table[at],
        table[at + LANES],
        table[at + 2 * LANES],
        table[at + 3 * LANES],
        table[at + 4 * LANES],
        table[at + 5 * LANES],
    )


@inlined
def put_state(table, at, y):
    table[at] = y.v
    table[at + LANES] = y.theta
    table[at + 2 * LANES] = y.v_rate
    table[at + 3 * LANES] = y.omega
    table[at + 4 * LANES] = y.z_left
    table[at + 5 * LANES] = y.z_right


@kernel
def put_all(table, at, values):
    """Each of ``values`` into a row of its own, from cell ``at``."""
    for j in range(len(values)):
        table[at + j * LANES] = values[j]


@kernel
def _watch_pivot(law, on_spring, yields, waiting, rest):
    if on_spring == 0.0:
        return 0.0, 1.0, -waiting, 0.0, 0.0, 1.0
    if law == ELASTIC:
        return -1.0, 0.0, 0.0, 0.0, 0.0, 1.0
    if yields != 0.0:
        return -1.0, 0.0, 0.0, 0.0, -1.0, -rest
    if law == BOUC_WEN:
        return -1.0, 0.0, 0.0, 0.0, 1.0, -rest
    return -1.0, 0.0, 0.0, 1.0, 0.0, 1.0


@kernel
def watch(law, contact, supports, rest):
    """Coefficients of the four signals (``events.signals``), linear as long as the contacts stay as they are.

    Contact: on its spring −z, else the gap to the support: (of z, of the pivot's position, constant). Law: the pivot's
    velocity up or down, or what is left until yield: (of z, of the pivot's velocity, constant). Velocities that are but
    rounding count as negative here: the scalar code knows what to make of them.
    """
    left = _watch_pivot(law, contact.left, contact.left_yields, supports.left, rest)
    right = _watch_pivot(law, contact.right, contact.right_yields, supports.right, rest)
    return left + right


@inlined
def _dips(f0, d0, f1, d1, h):
    """Above 0 where a Hermite cubic may fall through zero and rise again between its ends."""
    return min(min(-d0, d1), excess(d0, d1, h) - min(f0, f1))


@inlined
def _passed_over(table, i, exponent, finite):
    """Lane ``i`` over its piece of a step."""
    m = model_of(table, i, exponent, finite)
    y, k1 = state_of(table, NOW + i), state_of(table, RATES + i)
    on_left, on_right = table[CONTACT + i], table[CONTACT + LANES + i]
    contact = Contact(on_left, on_right, table[CONTACT + 2 * LANES + i], table[CONTACT + 3 * LANES + i], 0.0)
    a0, a_slope = table[GROUND + i], table[GROUND + LANES + i]
    c0, c_slope = table[GROUND + 2 * LANES + i], table[GROUND + 3 * LANES + i]
    x, length = table[START + i], table[LENGTH + i]
    ground = Ground(a0 + x * a_slope, a_slope, c0 + x * c_slope, c_slope)
    end = step(m, y, k1, contact, ground, length)
    k_end = rates(m, end, contact, a0 + (x + length) * a_slope, c0 + (x + length) * c_slope)

    # The signals, as far as they tell that nothing can have happened; they were positive at the start of the piece
    at, at_end = geometry(m, y.theta), geometry(m, end.theta)
    turning = end.omega * end.omega
    left, left_end = y.v + at.lift_left, end.v + at_end.lift_left
    right, right_end = y.v + at.lift_right, end.v + at_end.lift_right
    left_rate, left_rate_end = y.v_rate + at.arm_left * y.omega, end.v_rate + at_end.arm_left * end.omega
    right_rate, right_rate_end = y.v_rate + at.arm_right * y.omega, end.v_rate + at_end.arm_right * end.omega
    left_accel = k_end.v_rate + at_end.arm_left * k_end.omega + at_end.bend_left * turning
    right_accel = k_end.v_rate + at_end.arm_right * k_end.omega + at_end.bend_right * turning

    w = WATCH + i
    contact_left = table[w] * end.z_left + table[w + LANES] * left_end + table[w + 2 * LANES]
    contact_left_slope = table[w] * k_end.z_left + table[w + LANES] * left_rate_end
    law_left = table[w + 3 * LANES] * end.z_left + table[w + 4 * LANES] * left_rate_end + table[w + 5 * LANES]
    law_left_slope = table[w + 3 * LANES] * k_end.z_left + table[w + 4 * LANES] * left_accel
    turns_left = table[w + 4 * LANES] != 0.0
    w += 6 * LANES
    turns_right = table[w + 4 * LANES] != 0.0
    contact_right = table[w] * end.z_right + table[w + LANES] * right_end + table[w + 2 * LANES]
    contact_right_slope = table[w] * k_end.z_right + table[w + LANES] * right_rate_end
    law_right = table[w + 3 * LANES] * end.z_right + table[w + 4 * LANES] * right_rate_end + table[w + 5 * LANES]
    law_right_slope = table[w + 3 * LANES] * k_end.z_right + table[w + 4 * LANES] * right_accel

    # A contact may have ended or begun by the end or, as far as a cubic goes beyond its ends, on the way; a spring's
    # velocity may have turned by the end, or on the way and back
    w = WATCH + i
    before_left = table[w] * y.z_left + table[w + LANES] * left + table[w + 2 * LANES]
    beyond_left = excess(table[SLOPES + i], contact_left_slope, length)
    law = table[w + 3 * LANES] * y.z_left + table[w + 4 * LANES] * left_rate + table[w + 5 * LANES]
    back_left = _dips(law, table[SLOPES + 2 * LANES + i], law_left, law_left_slope, length)
    w += 6 * LANES
    before_right = table[w] * y.z_right + table[w + LANES] * right + table[w + 2 * LANES]
    beyond_right = excess(table[SLOPES + LANES + i], contact_right_slope, length)
    law = table[w + 3 * LANES] * y.z_right + table[w + 4 * LANES] * right_rate + table[w + 5 * LANES]
    back_right = _dips(law, table[SLOPES + 3 * LANES + i], law_right, law_right_slope, length)
    gap = min(min(before_left, contact_left) - beyond_left, min(before_right, contact_right) - beyond_right)
    back = max(back_left, back_right)
    # An extreme inside the piece may be a new one
    peak = table[PEAK + i]
    tilt, tilt_end = abs(y.theta), abs(end.theta)
    new_peak = min(-y.omega * end.omega, max(tilt, tilt_end) + excess(y.omega, end.omega, length) - peak)
    low_left, low_right = table[LOWEST + i], table[LOWEST + LANES + i]
    least_left = min(left, left_end) - excess(left_rate, left_rate_end, length)
    least_right = min(right, right_end) - excess(right_rate, right_rate_end, length)
    new_left = min(on_left * min(-left_rate, left_rate_end), low_left - least_left)
    new_right = min(on_right * min(-right_rate, right_rate_end), low_right - least_right)
    law = min(law_left, law_right)
    no_contact = (
        max(table[WATCHED + i], back) <= 0.0 and gap > 0.0 and tilt_end < ON_ITS_SIDE
    )  # never of what is no number
    calm = no_contact and law > 0.0 and max(new_peak, max(new_left, new_right)) <= 0.0
    turned = no_contact and (law_left > 0.0 or turns_left) and (law_right > 0.0 or turns_right) and law <= 0.0

    put_state(table, BEFORE + i, y)
    put_state(table, BEFORE_RATES + i, k1)
    put_state(table, NOW + i, end)
    put_state(table, RATES + i, k_end)
    table[SLOPES + i] = contact_left_slope
    table[SLOPES + LANES + i] = contact_right_slope
    table[SLOPES + 2 * LANES + i] = law_left_slope
    table[SLOPES + 3 * LANES + i] = law_right_slope
    higher = calm and tilt_end > peak
    table[PEAK + i] = tilt_end if higher else peak
    table[PEAK_TIME + i] = table[SAMPLE_TIME + i] + x + length if higher else table[PEAK_TIME + i]
    table[LOWEST + i] = left_end if calm and on_left != 0.0 and left_end < low_left else low_left
    table[LOWEST + LANES + i] = right_end if calm and on_right != 0.0 and right_end < low_right else low_right
    substep = table[SUBSTEP + i] + (1.0 if calm else 0.0)
    h = table[STEP + i]
    table[SUBSTEP + i] = substep
    table[START + i] = substep * h if calm else x
    table[LENGTH + i] = h if calm else length
    stepped = SAMPLED if substep == table[SUBSTEPS + i] else CALM
    table[NEWS + i] = stepped if calm else (TURNED if turned else EVENTFUL)


@inlined
def one_pass(table, lanes, exponent, finite):
    """The first ``lanes`` lanes over their pieces of a step."""
    for i in range(lanes):
        _passed_over(table, i, exponent, finite)
