"""The search for events in a lane's piece of a step: whether it stands, and at what shorter one to look next.

The pieces themselves, trials included, are taken by the lanes' pass.
"""

from rockbatch.core.equations import geometry
from rockbatch.core.events import quiet, signals
from rockbatch.core.kernel import kernel
from rockbatch.core.lanes import (
    BEFORE,
    BEFORE_RATES,
    CONTACT,
    GROUND,
    LANES,
    LENGTH,
    NOW,
    RATES,
    SLOPES,
    START,
    STEP,
    WATCH,
    WATCHED,
    put_all,
    put_state,
    rows,
    state_of,
    watch,
)
from rockbatch.core.roots import BISECT_AFTER, CLOSE, TRIALS, falls
from rockbatch.core.transitions import Supports
from rockbatch.core.types import Contact, Ground, Signals

ACCEPT = -1.0  # verdicts on a piece, besides the number of an event
SEARCH = -2.0
HELD = rows(1)  # Contact.held
SUPPORTS = rows(2)
REST = rows(1)  # velocity that counts as none [m/s]
VERDICT = rows(1)  # on the piece that is being taken: ACCEPT or the number of an event; SEARCH: not yet known
TRIAL = rows(1)  # how many there were
EARLY = rows(9)  # latest time in the piece before the event: length, signals, slopes
LATE = rows(9)  # earliest time after it


@kernel
def contact_of(table, i):
    at = CONTACT + i
    return Contact(table[at], table[at + LANES], table[at + 2 * LANES], table[at + 3 * LANES], table[HELD + i])


@kernel
def supports_of(table, i):
    return Supports(table[SUPPORTS + i], table[SUPPORTS + LANES + i])


@kernel
def _signals_of(table, at):
    return Signals(table[at], table[at + LANES], table[at + 2 * LANES], table[at + 3 * LANES])


@kernel
def ground_of(table, i, x):
    """Ground at ``x`` [s] after the sample."""
    at = GROUND + i
    a_slope, c_slope = table[at + LANES], table[at + 3 * LANES]
    return Ground(table[at] + x * a_slope, a_slope, table[at + 2 * LANES] + x * c_slope, c_slope)


@kernel
def _signals_at(table, i, m, y, k, contact, x):
    """Signals and slopes in state ``y`` with rates ``k``, ``x`` [s] after the sample."""
    ground = ground_of(table, i, x)
    return signals(
        m, y, k, contact, table[SUPPORTS + i], table[SUPPORTS + LANES + i], table[REST + i],
        ground.horizontal, ground.vertical,
    )  # fmt: skip


@kernel
def put_contact(table, i, m, contact, supports):
    """Contacts and supports, and what the pass watches while they stay."""
    put_all(table, CONTACT + i, (contact.left, contact.right, contact.left_yields, contact.right_yields))
    table[HELD + i] = contact.held
    put_all(table, SUPPORTS + i, supports)
    put_all(table, WATCH + i, watch(m.law, contact, supports, table[REST + i]))


@kernel
def ready(table, i, m, contact, x, length):
    """The next piece: from NOW, with RATES, at ``x`` [s] after the sample, over ``length`` [s]."""
    f, d = _signals_at(table, i, m, state_of(table, NOW + i), state_of(table, RATES + i), contact, x)
    put_all(table, SLOPES + i, d)
    laws = (f.left_law > 0.0 or d.left_law > 0.0) and (f.right_law > 0.0 or d.right_law > 0.0)  # a turn leaves zero
    positive = f.left > 0.0 and f.right > 0.0 and laws
    table[WATCHED + i] = 0.0 if positive and contact.held == 0.0 else 1.0
    next_piece(table, i, x, length)


@kernel
def next_piece(table, i, x, length):
    table[START + i] = x
    table[LENGTH + i] = length
    table[VERDICT + i] = SEARCH
    table[TRIAL + i] = 0.0


@kernel
def _earliest(early, early_slopes, late, late_slopes, h):
    """Which signal falls through zero first within ``h`` [s], and when; −1 for none."""
    which, first = -1, h
    for j in range(4):
        at = falls(early[j], early_slopes[j], late[j], late_slopes[j], h)
        if at >= 0.0 and (which < 0 or at < first):
            which, first = j, at
    return which, first


@kernel
def judge(table, i, m, y, end, k_end, contact, locate):
    """Verdict on the piece from ``y`` to ``end``: ACCEPT, the number of the event at its end, or SEARCH for a shorter
    one, whose length is set."""
    x, length = table[START + i], table[LENGTH + i]
    f1, d1 = _signals_at(table, i, m, end, k_end, contact, x + length)
    trial = table[TRIAL + i]
    if trial == 0.0:
        f0, d0 = _signals_at(table, i, m, y, state_of(table, BEFORE_RATES + i), contact, x)
        if (
            quiet(f0.left, d0.left, f1.left, d1.left, length)
            and quiet(f0.right, d0.right, f1.right, d1.right, length)
            and quiet(f0.left_law, d0.left_law, f1.left_law, d1.left_law, length)
            and quiet(f0.right_law, d0.right_law, f1.right_law, d1.right_law, length)
        ):
            return ACCEPT
        if not locate:
            for j in range(4):
                if f1[j] <= 0.0:
                    return float(j)
            return ACCEPT
        a, b = 0.0, length
        which, at = _earliest(f0, d0, f1, d1, length)
        f_a, d_a, f_b, d_b = f0, d0, f1, d1
    else:
        a, b = table[EARLY + i], table[LATE + i]
        f_a, d_a = _signals_of(table, EARLY + LANES + i), _signals_of(table, EARLY + 5 * LANES + i)
        f_b, d_b = _signals_of(table, LATE + LANES + i), _signals_of(table, LATE + 5 * LANES + i)
        which, at = _earliest(f_a, d_a, f1, d1, length - a)
        if which >= 0:
            b, f_b, d_b = length, f1, d1
        else:
            a, f_a, d_a = length, f1, d1
            which, at = _earliest(f_a, d_a, f_b, d_b, b - a)
    if which < 0:  # nothing falls after all
        if length == b:
            return ACCEPT
        table[VERDICT + i] = ACCEPT
        table[LENGTH + i] = b
        return SEARCH
    at += a
    close = CLOSE * table[STEP + i]
    if abs(at - length) <= close:
        return float(which)
    if at - a <= close or trial > TRIALS:
        table[VERDICT + i] = which
    elif trial > BISECT_AFTER and trial % 2 == 0:
        at = 0.5 * (a + b)
    table[LENGTH + i] = at
    table[TRIAL + i] = trial + 1.0
    table[EARLY + i], table[LATE + i] = a, b
    put_all(table, EARLY + LANES + i, f_a)
    put_all(table, EARLY + 5 * LANES + i, d_a)
    put_all(table, LATE + LANES + i, f_b)
    put_all(table, LATE + 5 * LANES + i, d_b)
    return SEARCH


@kernel
def _turns(table, i, w, f0, d0, f1, d1, h):
    """When, in [0, h], the velocity turns that coefficient ``w`` watches, by its values and accelerations; h if never."""
    sign = table[w]
    if sign == 0.0 or sign * f1 > table[REST + i]:
        return h
    return falls(sign * f0, sign * d0, sign * f1, sign * d1, h) if sign * f0 > table[REST + i] else -1.0


@kernel
def seek_turn(table, i, m):
    """Shorten the piece to the moment when the velocity of a spring turns; False where the cubic does not know.

    Both branches of the spring have the same rate then: an error δt of the time makes one of order δt² in z, and the
    guess of the cubic, wrong by some 1e-4 of a step that resolves the springs, is as good as the time itself.
    """
    y, k1 = state_of(table, BEFORE + i), state_of(table, BEFORE_RATES + i)
    end, k_end = state_of(table, NOW + i), state_of(table, RATES + i)
    at, at_end = geometry(m, y.theta), geometry(m, end.theta)
    h = table[LENGTH + i]
    left = _turns(
        table, i, WATCH + 4 * LANES + i,
        y.v_rate + at.arm_left * y.omega,
        k1.v_rate + at.arm_left * k1.omega + at.bend_left * y.omega * y.omega,
        end.v_rate + at_end.arm_left * end.omega,
        k_end.v_rate + at_end.arm_left * k_end.omega + at_end.bend_left * end.omega * end.omega,
        h,
    )  # fmt: skip
    right = _turns(
        table, i, WATCH + 10 * LANES + i,
        y.v_rate + at.arm_right * y.omega,
        k1.v_rate + at.arm_right * k1.omega + at.bend_right * y.omega * y.omega,
        end.v_rate + at_end.arm_right * end.omega,
        k_end.v_rate + at_end.arm_right * k_end.omega + at_end.bend_right * end.omega * end.omega,
        h,
    )  # fmt: skip
    first = min(left, right)
    if not 0.0 < first < h:
        return False
    table[LENGTH + i] = first
    table[VERDICT + i] = 2.0 if left <= right else 3.0
    table[WATCHED + i] = 1.0
    put_state(table, NOW + i, y)
    put_state(table, RATES + i, k1)
    return True
