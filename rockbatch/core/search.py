"""The search for events in a lane's piece of a step: whether it stands, and at what shorter one to look next.

The pieces themselves, trials included, are taken by the lanes' pass.
"""

from rockbatch.core.equations import geometry
from rockbatch.core.events import quiet, signals
from rockbatch.core.kernel import kernel
from rockbatch.core.lanes import (
    ACCEPT,
    SEARCH,
    contact_of,
    ground_of,
    put_signals,
    put_state,
    signals_in,
    state,
)
from rockbatch.core.laws import kept_sign
from rockbatch.core.roots import BISECT_AFTER, CLOSE, NEAR, TRIALS, falls
from rockbatch.core.transitions import LAW_LEFT, LAW_RIGHT


@kernel
def _signals_at(lanes, i, m, y, k, contact, x):
    """Signals and slopes in state ``y`` with rates ``k``, ``x`` [s] after the sample."""
    ground = ground_of(lanes, i, x)
    return signals(
        m, y, k, contact, lanes.supports.left[i], lanes.supports.right[i], lanes.motion.rest[i],
        ground.horizontal, ground.vertical,
    )  # fmt: skip


@kernel
def ready(lanes, i, m, contact, x, length, locate):
    """The next piece: from ``now``, with ``rates``, at ``x`` [s] after the sample, over ``length`` [s]."""
    f, d = _signals_at(lanes, i, m, state(lanes.now, i), state(lanes.rates, i), contact, x)
    laws = (f.left_law > 0.0 or d.left_law > 0.0) and (f.right_law > 0.0 or d.right_law > 0.0)  # a turn leaves zero
    free = f.left > 0.0 and f.right > 0.0 and laws and contact.held == 0.0 and locate
    lanes.watched[i] = 0.0 if free else 1.0
    next_piece(lanes, i, x, length)


@kernel
def next_piece(lanes, i, x, length):
    lanes.clock.start[i] = x
    lanes.clock.length[i] = length
    lanes.verdict[i] = SEARCH
    lanes.trial[i] = 0


@kernel
def again(lanes, i, length):
    """The piece that was taken once more, over ``length`` [s]: without corrections, and looked at whatever comes."""
    put_state(lanes.now, i, state(lanes.before, i))
    put_state(lanes.rates, i, state(lanes.before_rates, i))
    lanes.clock.length[i] = length
    lanes.watched[i] = 1.0


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
def judge(lanes, i, m, y, end, k_end, contact, locate):
    """Verdict on the piece from ``y`` to ``end``, where the rates are ``k_end``.

    Returns
    -------
    verdict : int
        ACCEPT, the number of the event at its end, or SEARCH: a shorter one is to be taken.
    length : float
        Of that one [s].
    """
    x, length = lanes.clock.start[i], lanes.clock.length[i]
    f1, d1 = _signals_at(lanes, i, m, end, k_end, contact, x + length)
    trial = lanes.trial[i]
    if trial == 0:
        f0, d0 = _signals_at(lanes, i, m, y, state(lanes.before_rates, i), contact, x)
        if (
            quiet(f0.left, d0.left, f1.left, d1.left, length)
            and quiet(f0.right, d0.right, f1.right, d1.right, length)
            and quiet(f0.left_law, d0.left_law, f1.left_law, d1.left_law, length)
            and quiet(f0.right_law, d0.right_law, f1.right_law, d1.right_law, length)
        ):
            return ACCEPT, length
        if not locate:
            for j in range(4):
                if f1[j] <= 0.0:
                    return j, length
            return ACCEPT, length
        a, b = 0.0, length
        which, at = _earliest(f0, d0, f1, d1, length)
        f_a, d_a, f_b, d_b = f0, d0, f1, d1
    else:
        a, b = lanes.early.at[i], lanes.late.at[i]
        f_a, d_a = signals_in(lanes.early, i)
        f_b, d_b = signals_in(lanes.late, i)
        which, at = _earliest(f_a, d_a, f1, d1, length - a)
        if which >= 0:
            b, f_b, d_b = length, f1, d1
        else:
            a, f_a, d_a = length, f1, d1
            which, at = _earliest(f_a, d_a, f_b, d_b, b - a)
    if which < 0:  # nothing falls after all
        if length == b:
            return ACCEPT, length
        lanes.verdict[i] = ACCEPT
        return SEARCH, b
    at += a
    step = lanes.clock.step[i]
    if abs(at - length) <= CLOSE * step:
        return which, length
    if abs(at - length) <= NEAR * step or at - a <= CLOSE * step or trial > TRIALS:
        lanes.verdict[i] = which
    elif trial > BISECT_AFTER and trial % 2 == 0:
        at = 0.5 * (a + b)
    lanes.trial[i] = trial + 1
    put_signals(lanes.early, i, a, f_a, d_a)
    put_signals(lanes.late, i, b, f_b, d_b)
    return SEARCH, at


@kernel
def _turns(sign, rest, f0, d0, f1, d1, h):
    """When, in [0, h], a velocity turns whose sign is to be kept, by its values and accelerations; h if never."""
    if sign == 0.0 or sign * f1 > rest:
        return h
    return falls(sign * f0, sign * d0, sign * f1, sign * d1, h) if sign * f0 > rest else -1.0


@kernel
def seek_turn(lanes, i, m):
    """Shorten the piece to the moment when the velocity of a spring turns; False where the cubic does not know.

    Both branches of the spring have the same rate then: an error δt of the time makes one of order δt² in z, and the
    guess of the cubic, wrong by some 1e-4 of a step that resolves the springs, is as good as the time itself.
    """
    contact, rest, h = contact_of(lanes, i), lanes.motion.rest[i], lanes.clock.length[i]
    y, k1 = state(lanes.before, i), state(lanes.before_rates, i)
    end, k_end = state(lanes.now, i), state(lanes.rates, i)
    at, at_end = geometry(m, y.theta), geometry(m, end.theta)
    left = _turns(
        kept_sign(m.law, contact.left, contact.left_yields), rest,
        y.v_rate + at.arm_left * y.omega,
        k1.v_rate + at.arm_left * k1.omega + at.bend_left * y.omega * y.omega,
        end.v_rate + at_end.arm_left * end.omega,
        k_end.v_rate + at_end.arm_left * k_end.omega + at_end.bend_left * end.omega * end.omega,
        h,
    )  # fmt: skip
    right = _turns(
        kept_sign(m.law, contact.right, contact.right_yields), rest,
        y.v_rate + at.arm_right * y.omega,
        k1.v_rate + at.arm_right * k1.omega + at.bend_right * y.omega * y.omega,
        end.v_rate + at_end.arm_right * end.omega,
        k_end.v_rate + at_end.arm_right * k_end.omega + at_end.bend_right * end.omega * end.omega,
        h,
    )  # fmt: skip
    first = min(left, right)
    if not 0.0 < first < h:
        return False
    again(lanes, i, first)
    lanes.verdict[i] = LAW_LEFT if left <= right else LAW_RIGHT
    return True
