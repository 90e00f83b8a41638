"""The first event in a sub-step: the earliest zero crossing of all event functions, by cubics and trial steps."""

from typing import NamedTuple

import numpy as np

from rockbatch.core.devices.events import PER_DEVICE, EventFunctions, device_functions
from rockbatch.core.devices.pull import END, START, goes_on, pulled_at_end, stage_states
from rockbatch.core.ground import later
from rockbatch.core.kernel import inlined, inlined_once, kernel
from rockbatch.core.rk4 import rates_with, rk4
from rockbatch.core.roots import BISECT_AFTER, CLOSE, NEAR, TRIALS, falls
from rockbatch.core.system import end_step, event_functions, rates, share
from rockbatch.core.table import along
from rockbatch.core.types import NO_EVENT, OF_PIER, Instant, Moment


class Marks(NamedTuple):
    """Event functions at the lower and the upper end of the bracket of the event, and at the trial."""

    early: EventFunctions
    late: EventFunctions
    now: EventFunctions


def marks_for(elements):
    """Return Marks, all zeros, for the event functions of a pier and of ``elements`` devices."""
    size = OF_PIER + PER_DEVICE * elements
    return Marks(*(EventFunctions(np.zeros(size), np.zeros(size)) for _ in Marks._fields))


@kernel
def _copy(functions, to):
    """Copy values and slopes of event ``functions`` into those of ``to``."""
    for i in range(len(functions.values)):
        to.values[i] = functions.values[i]
    for i in range(len(functions.slopes)):
        to.slopes[i] = functions.slopes[i]


@kernel
def _earliest(early, late, h):
    """Return the number of the first event function to fall through zero in ``h`` [s], and its time; else NO_EVENT and ``h``."""
    which, first = NO_EVENT, h
    for i in range(len(early.values)):
        at = falls(early.values[i], early.slopes[i], late.values[i], late.slopes[i], h)
        if at >= 0.0 and (which < 0 or at < first):
            which, first = i, at
    return which, first


@inlined
def _evaluate(m, devices, now, place, h, functions):
    """Write event functions of the Instant ``now``, at a ``place`` of a step of ``h`` [s], and their slopes into ``functions``.

    ``m`` is the pier under its devices.
    """
    f, d = event_functions(m, devices, now)
    values, slopes = functions.values, functions.slopes
    values[0], values[1], values[2], values[3] = f.left, f.right, f.left_law, f.right_law
    slopes[0], slopes[1], slopes[2], slopes[3] = d.left, d.right, d.left_law, d.right_law
    if devices is not None:
        device_functions(m, devices, now, place, h, functions)


@kernel
def _trial_step(m, devices, start, x):
    """Return the Instant at the end of a step of ``x`` [s], and the pier with the pull of its devices at that end."""
    end, there = rk4(m, devices, start, x), later(start.ground, x)
    k_end, under = rates_with(devices, m, Moment(end, start.contact, start.supports), there, END)
    return Instant(end, k_end, start.contact, start.supports, there), under


@inlined
def nearby(m, start, end, t, x):
    """Return state and rates at ``x`` [s] after ``start``, near the ``end`` of a step of ``t`` [s], by the cubic through both."""
    away = (x - t) / t
    back = along(end.y, start.y, -1.0)
    bend = along(along(start.k, end.k, 2.0), back, -3.0 / t)
    twist = along(along(start.k, end.k, 1.0), back, -2.0 / t)
    left = share(m, 0.5 * x)
    y = along(end.y, along(end.k, along(bend, twist, away), away), x - t)
    y = end_step(m, y, start.y, start.contact, left * left)
    return y, rates(m, y, start.contact, later(start.ground, x))


@kernel
def _first_below(values):
    """Return the number of the first event function ≤ 0, NO_EVENT for none."""
    for i in range(len(values)):
        if values[i] <= 0.0:
            return i
    return NO_EVENT


@kernel
def _narrow(marks, a, t, b):
    """Return the bracket [a, b] of the first event narrowed by a trial at ``t``, its function, and its time after a.

    The function is NO_EVENT if none falls in the new bracket. ``marks`` are moved to its ends.
    """
    which, at = _earliest(marks.early, marks.now, t - a)
    if which != NO_EVENT:
        _copy(marks.now, marks.late)
        return a, t, which, at
    if t == b:
        return t, b, which, at
    _copy(marks.now, marks.early)
    which, at = _earliest(marks.early, marks.late, b - t)
    return t, b, which, at


@inlined
def start_rates(m, devices, now, ground, at_end):
    """Return the rates at the start of a sub-step, and the pier under its devices; write the rates of the devices' states.

    If the step continues from the end of the last one, the rates are ``at_end``, and those of devices are copied.
    """
    if devices is not None and goes_on(devices):
        return at_end, pulled_at_end(m, devices)
    stage_states(devices, START, 0.0)
    return rates_with(devices, m, now, ground, START)


@inlined_once
def first_event(m, devices, marks, start, h, continues, locate):
    """Integrate from the Instant ``start`` over ``h`` [s], or to the first event before that.

    ``m`` is the pier under its devices at the start. If the step ``continues`` the last one of its sub-step, ``marks`` may hold
    the event functions at the start. Without ``locate`` events take place at the end of the step, which is of
    first order and for comparison only.

    Returns
    -------
    The length of the step [s]; the number of the event function that fell, NO_EVENT for none; the state then, and its rates.
    """
    if devices is not None and continues and goes_on(devices):
        _copy(marks.now, marks.early)
    else:
        _evaluate(m, devices, start, START, h, marks.early)
    a, b, t, which, last = 0.0, h, h, NO_EVENT, False
    for trial in range(TRIALS + 1):
        now, under = _trial_step(m, devices, start, t)
        if last and which != NO_EVENT:
            return t, which, now.y, now.k
        _evaluate(under, devices, now, END, h, marks.now)
        if not locate:
            return h, _first_below(marks.now.values), now.y, now.k
        if last:
            return t, which, now.y, now.k
        a, b, which, at = _narrow(marks, a, t, b)
        if (t == b) if which == NO_EVENT else (abs(a + at - t) <= CLOSE * h):
            return t, which, now.y, now.k
        if devices is None and which != NO_EVENT and abs(a + at - t) <= NEAR * t:
            y, k_there = nearby(m, start, now, t, a + at)
            return a + at, which, y, k_there
        halve = trial > BISECT_AFTER and trial % 2 == 0
        last = which == NO_EVENT or abs(a + at - t) <= NEAR * h or at <= CLOSE * h or trial == TRIALS - 1
        t = b if which == NO_EVENT else (0.5 * (a + b) if halve and not last else a + at)
    return t, which, now.y, now.k
