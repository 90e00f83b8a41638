"""End of a run of a pier with an elastic shaft, checked once a sample after the tail (THEORY.md, A shaft that bends)."""

import math

from rockbatch.core import system
from rockbatch.core.block.ending import stored_by_devices
from rockbatch.core.block.equations import key_of, on_pivot, on_side, side_of
from rockbatch.core.block.events import lifting
from rockbatch.core.clock import ground_rests
from rockbatch.core.flexure.equations import masses_about
from rockbatch.core.flexure.model import FlexibleTraits, Flexing
from rockbatch.core.kernel import inlined, kernel
from rockbatch.core.system import airborne, pier_in
from rockbatch.core.types import RESTLESS, RUNNING, SURVIVED, UNDECIDED, Ground


@inlined
def bending_energy(m, u):
    """Return the elastic energy [J/kg] of the bent shaft."""
    return 0.5 * m.second * (m.frequency * u) * (m.frequency * u)


@kernel
def kinetic_and_potential(m, y, contact):
    """Return the kinetic energy and the potential energy of the weight, 0 at rest [J/kg]."""
    side = side_of(contact)
    key = side if side != 0.0 else key_of(m, contact)
    about, sine = masses_about(m, y.u, key), math.sin(y.theta)
    kinetic = (
        0.5 * (m.second * y.u_rate * y.u_rate + about.turning * y.omega * y.omega) + m.coupling * y.u_rate * y.omega
    )
    slope = about.offset * math.cos(y.theta) - m.height * sine
    rise = y.v_rate - on_pivot(m, y.theta, key)[1] * y.omega
    kinetic += rise * (0.5 * rise + slope * y.omega - m.first * sine * y.u_rate)
    return kinetic, m.gravity * (y.v - m.first * y.u * sine)


@inlined
def _leaning(m, theta):
    """Return the least energy [J/kg] of weight and shaft at the rotation ``theta``, and the deflection there [m]."""
    side = 1.0 if theta > 0.0 else -1.0
    u = m.gravity * m.first * math.sin(theta) / (m.second * m.frequency * m.frequency)
    return m.gravity * on_pivot(m, theta, side)[0] - bending_energy(m, u), u


@kernel
def _cannot_reach(m, devices, now, limit):
    """Return True if the present energy does not suffice to reach ``limit`` [rad] on either side."""
    kinetic, potential = kinetic_and_potential(m, now.y, now.contact)
    energy, least = kinetic + potential + bending_energy(m, now.y.u), math.inf
    if devices is not None:
        kept, back = stored_by_devices(m, devices, now.y, now.contact)
        energy += kept + back
    for side in (-1.0, 1.0):
        level, u = _leaning(m, side * limit)
        if devices is not None:
            there = Flexing(on_pivot(m, side * limit, side)[0], side * limit, 0.0, 0.0, u, 0.0)
            level += stored_by_devices(m, devices, there, on_side(side))[0]
        least = min(least, level)
    return abs(now.y.theta) < m.tipping and energy <= least


@kernel
def _stands_for_good(m, devices, now):
    """Return True if both feet are down and the remaining vibration of the shaft cannot lift either of them."""
    y, contact = now.y, now.contact
    if contact.left == 0.0 or contact.right == 0.0:
        return False
    amplitude = math.hypot(y.u, y.u_rate / m.frequency)
    quick = m.coupling * m.frequency * math.hypot(m.frequency, m.damping)
    straight, still = Flexing(0.0, 0.0, 0.0, 0.0, 0.0, 0.0), Ground(0.0, 0.0, 0.0, 0.0)
    inertia = masses_about(m, 0.0, 1.0).turning - m.coupling * m.coupling / m.second
    held = -max(lifting(m, devices, straight, -1.0, still), lifting(m, devices, straight, 1.0, still)) * inertia
    return (quick + m.gravity * m.first) * amplitude < held


@system.status_at_sample.of(FlexibleTraits)
def status_at_sample(traits, lanes, i, devices):
    """Return the status at a sample, and the next sample to check: the end of the record, then every one."""
    status = _status(traits, lanes, i, devices)
    return status, max(lanes.clock.npts[i] - 1.0, lanes.clock.sample[i] + 1.0)


@kernel
def _status(traits, lanes, i, devices):
    """Return the status of the run in lane ``i``, RUNNING unless it ends."""
    sample, samples, longest = lanes.clock.sample[i], lanes.clock.samples[i], lanes.ending.longest[i]
    if sample < samples:
        return RUNNING
    m, now = pier_in(traits, lanes, i)
    grounded = not airborne(m, now.contact)
    if grounded and ground_rests(lanes, i):
        limit = min(lanes.peak.theta[i], m.tipping)
        if _stands_for_good(m, devices, now) or _cannot_reach(m, devices, now, limit):
            return SURVIVED
    if sample < longest:
        return RUNNING
    if longest == samples:  # the run ends with its tail in any case
        return SURVIVED
    return RESTLESS if _cannot_reach(m, devices, now, m.tipping) else UNDECIDED
