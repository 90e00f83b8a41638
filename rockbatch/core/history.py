"""Rows of a history: time, kind, state and contacts, and what devices are at that moment."""

from rockbatch.core.devices.pull import under_devices
from rockbatch.core.kernel import inlined, inner

MOMENT = ("t", "kind")
"""Columns before those of state and contact; behind them, of devices: their states x, and the force and moment of all."""


@inlined
def _write_devices(line, at, m, devices, y, contact, ground):
    if devices is None:
        return
    under, _, _ = under_devices(m, devices, y, devices.x, contact, ground.horizontal, ground.vertical)
    for j in range(len(devices.x)):
        line[at + j] = devices.x[j]
    line[at + len(devices.x)], line[at + len(devices.x) + 1] = under.pull.force, under.pull.moment


@inner
def write(history, row, t, kind, m, devices, y, contact, ground):
    """Write a row of a history, if there is room for it, and return the next; without a history rows are not counted."""
    if history.shape[0] == 0:
        return row
    if row < history.shape[0]:
        line = history[row]
        line[0] = max(t, history[row - 1, 0]) if row > 0 else t  # sums of parts are rounded, time does not go back
        line[1] = kind
        at = len(MOMENT)
        for j in range(len(y)):
            line[at + j] = y[j]
        at += len(y)
        for j in range(len(contact)):
            line[at + j] = contact[j]
        _write_devices(line, at + len(contact), m, devices, y, contact, ground)
    return row + 1
