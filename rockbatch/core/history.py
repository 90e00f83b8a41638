"""Rows of a history: time, kind, state, contacts, and the states and pull of devices."""

from typing import NamedTuple

import numpy as np

from rockbatch.core.devices.pull import under_devices
from rockbatch.core.kernel import inlined, kernel

MOMENT = ("t", "kind")
"""Columns before those of state and contact; after them follow the devices' states x, and their total force and moment."""


class History(NamedTuple):
    """Buffers of the rows that each run writes."""

    rows: np.ndarray  # shape (runs, rows, columns); with 0 runs nothing is written or counted
    written: np.ndarray  # shape (runs,): numbers of rows, with those beyond the buffer
    every_step: bool  # also steps between samples, and both sides of all events of devices


def history_of(rows, runs, every_step=False):
    """Return a History by which ``runs`` runs write into ``rows``, with no row written yet."""
    return History(rows, np.zeros(runs, np.int64), bool(every_step))


class Stamp(NamedTuple):
    """First columns of a row, and the run that writes it."""

    number: int  # of the run
    t: float  # [s]
    kind: float


@inlined
def _write_devices(line, at, m, devices, now, ground):
    """Write the devices' states, then their total force and moment, into ``line`` from column ``at``; nothing without devices."""
    if devices is None:
        return
    under, _, _ = under_devices(m, devices, now, devices.x, ground)
    for j in range(len(devices.x)):
        line[at + j] = devices.x[j]
    line[at + len(devices.x)], line[at + len(devices.x) + 1] = under.pull.force, under.pull.moment


@kernel
def write(history, stamp, m, devices, now, ground):
    """Write a row of the Moment ``now``; one beyond the buffer is only counted, and without buffers nothing is.

    Its time is at least that of the row before.
    """
    if history.rows.shape[0] == 0:
        return
    number, t, y, contact = stamp.number, stamp.t, now.y, now.contact
    rows, row = history.rows[number], history.written[number]
    history.written[number] = row + 1
    if row >= rows.shape[0]:
        return
    line, at = rows[row], len(MOMENT)
    line[0] = max(t, rows[row - 1, 0]) if row > 0 else t  # sums are rounded; times must not decrease
    line[1] = stamp.kind
    for j in range(len(y)):
        line[at + j] = y[j]
    at += len(y)
    for j in range(len(contact)):
        line[at + j] = contact[j]
    _write_devices(line, at + len(contact), m, devices, now, ground)


@inlined
def take_back(history, number):
    """Remove the last row of run ``number``, if it has any, from the count."""
    history.written[number] = max(history.written[number] - 1, 0)
