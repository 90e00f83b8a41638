"""The first event in a sub-step: the earliest zero crossing of all event functions, by cubics and ever closer trials."""

from typing import NamedTuple

import numpy as np

from rockbatch.core.devices.events import PER_DEVICE, device_functions
from rockbatch.core.devices.pull import END, START, goes_on, pulled_at_end, stage_states
from rockbatch.core.ground import later
from rockbatch.core.kernel import inlined, inlined_once, kernel
from rockbatch.core.rk4 import rates_with, rk4
from rockbatch.core.roots import BISECT_AFTER, CLOSE, NEAR, TRIALS, falls
from rockbatch.core.system import ended, event_functions, rates, share
from rockbatch.core.table import along
from rockbatch.core.types import NO_EVENT, OF_PIER, Moment


class Marks(NamedTuple):
    """Values and slopes of all event functions: at the latest moment before the event, at the earliest after it, at the trial."""

    early: np.ndarray
    early_slopes: np.ndarray
    late: np.ndarray
    late_slopes: np.ndarray
    now: np.ndarray
    now_slopes: np.ndarray


def marks_for(elements):
    """Return Marks for the event functions of a pier with so many ``elements``."""
    return Marks(*(np.zeros(OF_PIER + PER_DEVICE * elements) for _ in Marks._fields))


@kernel
def _copy(numbers, to):
    for i in range(len(numbers)):
        to[i] = numbers[i]


@kernel
def _earliest(early, early_slopes, late, late_slopes, h):
    """Return which event function falls through zero first within ``h`` [s], NO_EVENT for none; and when."""
    which, first = NO_EVENT, h
    for i in range(len(early)):
        at = falls(early[i], early_slopes[i], late[i], late_slopes[i], h)
        if at >= 0.0 and (which < 0 or at < first):
            which, first = i, at
    return which, first


@inlined
def _evaluate(m, devices, now, k, rest, ground, h, place, values, slopes):
    """Write all event functions of the Moment ``now`` at one ``place`` of a step; ``m`` is the pier under its devices."""
    f, d = event_functions(m, devices, now.y, k, now.contact, now.supports, rest, ground)
    values[0], values[1], values[2], values[3] = f.left, f.right, f.left_law, f.right_law
    slopes[0], slopes[1], slopes[2], slopes[3] = d.left, d.right, d.left_law, d.right_law
    if devices is not None:
        device_functions(m, devices, now, k, place, rest, ground, h, values, slopes)


@kernel
def _try(m, devices, start, k, ground, x):
    """Take a step over ``x`` [s]: the state at its end, its rates, and the pier under its devices there."""
    end = rk4(m, devices, start.y, k, start.contact, ground, x)
    there = later(ground, x)
    k_end, under = rates_with(devices, m, end, start.contact, there.horizontal, there.vertical, END)
    return end, k_end, under


@inlined
def nearby(m, start, k, end, k_end, ground, t, x):
    """Return the state at ``x`` [s] and its rates, so near to ``end``, that of a step over ``t``, that a cubic is as good."""
    away = (x - t) / t
    back = along(end, start.y, -1.0)
    bend, twist = along(along(k, k_end, 2.0), back, -3.0 / t), along(along(k, k_end, 1.0), back, -2.0 / t)
    left = share(m, 0.5 * x)
    y = along(end, along(k_end, along(bend, twist, away), away), x - t)
    y, there = ended(m, y, start.y, start.contact, left * left), later(ground, x)
    return y, rates(m, y, start.contact, there.horizontal, there.vertical)


@kernel
def _first_below(values):
    """Return the number of the first event function that is not above zero, NO_EVENT for none."""
    for i in range(len(values)):
        if values[i] <= 0.0:
            return i
    return NO_EVENT


@kernel
def _narrow(marks, a, t, b):
    """Narrow the interval [a, b] of the first event by a trial at ``t``: a, b, which function falls first, and when after a.

    There is none if no function falls on the way to a trial at ``b``.
    """
    which, at = _earliest(marks.early, marks.early_slopes, marks.now, marks.now_slopes, t - a)
    if which != NO_EVENT:
        _copy(marks.now, marks.late)
        _copy(marks.now_slopes, marks.late_slopes)
        return a, t, which, at
    if t == b:
        return t, b, which, at
    _copy(marks.now, marks.early)
    _copy(marks.now_slopes, marks.early_slopes)
    which, at = _earliest(marks.early, marks.early_slopes, marks.late, marks.late_slopes, b - t)
    return t, b, which, at


@inlined
def start_rates(m, devices, y, contact, ground, at_end):
    """Return the rates at the start of a sub-step, and the pier under its devices, whose states' rates are written.

    A sub-step that goes on from the end of the last one begins with the rates ``at_end``.
    """
    if devices is not None and goes_on(devices):
        return at_end, pulled_at_end(m, devices)
    stage_states(devices, START, 0.0)
    return rates_with(devices, m, y, contact, ground.horizontal, ground.vertical, START)


@inlined_once
def first_event(m, devices, marks, start, k, rest, ground, h, locate):
    """Take a step of ``h`` [s] from the Moment ``start``, whose rates are ``k``, or to the first event before its end.

    ``m`` is the pier under its devices at the start.
    Without ``locate`` events take place at the end of the step: first order, for comparison only.

    Returns
    -------
    The time that it took [s]; the number of the event function that fell, NO_EVENT for none; the state then, and its rates.
    """
    if devices is not None and goes_on(devices):
        _copy(marks.now, marks.early)
        _copy(marks.now_slopes, marks.early_slopes)
    else:
        _evaluate(m, devices, start, k, rest, ground, h, START, marks.early, marks.early_slopes)
    a, b, t, which, last = 0.0, h, h, NO_EVENT, False
    for trial in range(TRIALS + 1):
        end, k_end, under = _try(m, devices, start, k, ground, t)
        if last and which != NO_EVENT:
            return t, which, end, k_end
        now, there = Moment(end, start.contact, start.supports), later(ground, t)
        _evaluate(under, devices, now, k_end, rest, there, h, END, marks.now, marks.now_slopes)
        if not locate:
            return h, _first_below(marks.now), end, k_end
        if last:
            return t, which, end, k_end
        a, b, which, at = _narrow(marks, a, t, b)
        if (t == b) if which == NO_EVENT else (abs(a + at - t) <= CLOSE * h):
            return t, which, end, k_end
        if devices is None and which != NO_EVENT and abs(a + at - t) <= NEAR * t:
            y, k_there = nearby(m, start, k, end, k_end, ground, t, a + at)
            return a + at, which, y, k_there
        halve = trial > BISECT_AFTER and trial % 2 == 0
        last = which == NO_EVENT or abs(a + at - t) <= NEAR * h or at <= CLOSE * h or trial == TRIALS - 1
        t = b if which == NO_EVENT else (0.5 * (a + b) if halve and not last else a + at)
    return t, which, end, k_end
