"""Rows of a history: time, kind, state and contacts, and what devices are at that moment."""

from typing import NamedTuple

import numpy as np

from rockbatch.core.devices.pull import under_devices
from rockbatch.core.kernel import inlined, kernel

MOMENT = ("t", "kind")
"""Columns before those of state and contact; behind them, of devices: their states x, and the force and moment of all."""


class History(NamedTuple):
    """Rows that each run writes."""

    rows: np.ndarray  # shape (runs, rows, columns); of no runs nothing is written, nor counted
    written: np.ndarray  # shape (runs,): how many, also of those that found no room
    every_step: bool  # steps between samples, too, and both sides of all events of devices


def history_of(rows, runs, every_step=False):
    """Return the History of so many ``runs`` that is written into ``rows``."""
    return History(rows, np.zeros(runs, np.int64), bool(every_step))


class Stamp(NamedTuple):
    """First columns of a row, and the run that writes it."""

    number: int  # of the run
    t: float  # [s]
    kind: float


@inlined
def _write_devices(line, at, m, devices, now, ground):
    if devices is None:
        return
    under, _, _ = under_devices(m, devices, now, devices.x, ground)
    for j in range(len(devices.x)):
        line[at + j] = devices.x[j]
    line[at + len(devices.x)], line[at + len(devices.x) + 1] = under.pull.force, under.pull.moment


@kernel
def write(history, stamp, m, devices, now, ground):
    """Write a row of the Moment ``now`` with this ``stamp``, if there is room for it."""
    if history.rows.shape[0] == 0:
        return
    number, t, y, contact = stamp.number, stamp.t, now.y, now.contact
    rows, row = history.rows[number], history.written[number]
    history.written[number] = row + 1
    if row >= rows.shape[0]:
        return
    line, at = rows[row], len(MOMENT)
    line[0] = max(t, rows[row - 1, 0]) if row > 0 else t  # sums of parts are rounded, time does not go back
    line[1] = stamp.kind
    for j in range(len(y)):
        line[at + j] = y[j]
    at += len(y)
    for j in range(len(contact)):
        line[at + j] = contact[j]
    _write_devices(line, at + len(contact), m, devices, now, ground)


@inlined
def take_back(history, number):
    """Take the last row of run ``number`` back."""
    history.written[number] = max(history.written[number] - 1, 0)
