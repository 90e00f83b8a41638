"""The classical Runge–Kutta step of order 4, for any system, with or without devices."""

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
from rockbatch.core.ground import later
from rockbatch.core.kernel import hook, inlined
from rockbatch.core.system import end_step, rates, share, stage
from rockbatch.core.table import along, weighted
from rockbatch.core.types import Moment


@hook
def rates_with(devices, m, now, ground, place):
    """Return the rates of the Moment ``now``, and the pier ``m`` under its devices.

    Write the rates of the devices' staged states to their row ``place``.
    """


@rates_with.of(type(None))
def _rates_alone(devices, m, now, ground, place):
    return rates(m, now.y, now.contact, ground), m


@rates_with.of(Devices)
def _rates_under_devices(devices, m, now, ground, place):
    under, _, _ = device_rates(m, devices, now, devices.stage, ground, place)
    return rates(under, now.y, now.contact, ground), under


@inlined
def rk4(m, devices, start, h):
    """Return the state ``h`` [s] after the Instant ``start``; write the states of devices, if any, to ``devices.end``."""
    half = 0.5 * h
    y, k1, contact, supports, ground = start
    middle, end = later(ground, half), later(ground, h)
    left = share(m, half)
    stage_states(devices, START, half)
    second = Moment(stage(m, along(y, k1, half), y, contact, left), contact, supports)
    k2, _ = rates_with(devices, m, second, middle, SECOND)
    stage_states(devices, SECOND, half)
    third = Moment(stage(m, along(y, k2, half), y, contact, left), contact, supports)
    k3, _ = rates_with(devices, m, third, middle, THIRD)
    stage_states(devices, THIRD, h)
    fourth = Moment(stage(m, along(y, k3, h), y, contact, left * left), contact, supports)
    k4, _ = rates_with(devices, m, fourth, end, FOURTH)
    advance_states(devices, h)
    return end_step(m, along(y, weighted(k1, k2, k3, k4), h * (1.0 / 6.0)), y, contact, left * left)
