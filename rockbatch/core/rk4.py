"""The classical Runge–Kutta step of order 4, of any system, with or without devices."""

from rockbatch.core.devices.pull import (
    FOURTH,
    SECOND,
    START,
    THIRD,
    Devices,
    advance_states,
    device_rates,
    stage_states,
)
from rockbatch.core.kernel import inlined, question
from rockbatch.core.system import ended, rates, share, staged
from rockbatch.core.table import along, weighted


@question
def rates_with(devices, m, y, contact, horizontal, vertical, place):
    """Return the rates of ``y`` and the pier under its devices, whose states' rates in their stage go to their ``place``."""


@rates_with.of(type(None))
def _rates_alone(devices, m, y, contact, horizontal, vertical, place):
    return rates(m, y, contact, horizontal, vertical), m


@rates_with.of(Devices)
def _rates_under_devices(devices, m, y, contact, horizontal, vertical, place):
    under, _, _ = device_rates(m, devices, y, devices.stage, contact, horizontal, vertical, place)
    return rates(under, y, contact, horizontal, vertical), under


@inlined
def rk4(m, devices, y, k1, contact, ground, h):
    """Return the state ``h`` [s] after ``y``, whose rates are ``k1``; the devices' states then are in ``devices.end``."""
    half = 0.5 * h
    a_middle = ground.horizontal + half * ground.horizontal_slope
    c_middle = ground.vertical + half * ground.vertical_slope
    a_end, c_end = ground.horizontal + h * ground.horizontal_slope, ground.vertical + h * ground.vertical_slope
    left = share(m, half)
    stage_states(devices, START, half)
    k2, _ = rates_with(devices, m, staged(m, along(y, k1, half), y, contact, left), contact, a_middle, c_middle, SECOND)
    stage_states(devices, SECOND, half)
    k3, _ = rates_with(devices, m, staged(m, along(y, k2, half), y, contact, left), contact, a_middle, c_middle, THIRD)
    stage_states(devices, THIRD, h)
    k4, _ = rates_with(devices, m, staged(m, along(y, k3, h), y, contact, left * left), contact, a_end, c_end, FOURTH)
    advance_states(devices, h)
    return ended(m, along(y, weighted(k1, k2, k3, k4), h * (1.0 / 6.0)), y, contact, left * left)
