"""End of a run of a pier with an elastic shaft, checked once a sample after the tail (THEORY.md, A shaft that bends)."""

import math

from rockbatch.core import system
from rockbatch.core.block.ending import stored_by_devices
from rockbatch.core.block.equations import key_of, on_pivot, on_side, side_of
from rockbatch.core.block.events import lifting
from rockbatch.core.clock import ground_rests
from rockbatch.core.flexure.equations import flexing, masses_about
from rockbatch.core.flexure.model import FlexibleTraits
from rockbatch.core.flexure.modes import MOST_MODES, PerMode, deflection_rates, deflections, dot, scaled, times
from rockbatch.core.kernel import inlined, kernel
from rockbatch.core.system import airborne, pier_in
from rockbatch.core.types import RESTLESS, RUNNING, SURVIVED, UNDECIDED, Ground


@inlined
def bending_energy(m, u):
    """Return the elastic energy [J/kg] of a shaft with the coordinates ``u`` of its modes."""
    stretched = times(m.frequency, u)
    return 0.5 * dot(stretched, stretched)


@kernel
def kinetic_and_potential(m, y, contact):
    """Return the kinetic energy and the potential energy of the weight, 0 at rest [J/kg]."""
    side, u, u_rate = side_of(contact), deflections(y), deflection_rates(y)
    key = side if side != 0.0 else key_of(m, contact)
    about, sine = masses_about(m, u, key), math.sin(y.theta)
    kinetic = 0.5 * (dot(u_rate, u_rate) + about.turning * y.omega * y.omega) + dot(m.coupling, u_rate) * y.omega
    slope = about.offset * math.cos(y.theta) - m.height * sine
    rise = y.v_rate - on_pivot(m, y.theta, key)[1] * y.omega
    kinetic += rise * (0.5 * rise + slope * y.omega - dot(m.share, u_rate) * sine)
    return kinetic, m.gravity * (y.v - dot(m.share, u) * sine)


@inlined
def hanging(m, weight):
    """Return the coordinates of the modes [m] under the ``weight`` across the shaft [m/s²] alone, with the base held."""
    return PerMode(
        weight * m.share.first / (m.frequency.first * m.frequency.first),
        weight * m.share.second / (m.frequency.second * m.frequency.second),
        weight * m.share.third / (m.frequency.third * m.frequency.third),
        weight * m.share.fourth / (m.frequency.fourth * m.frequency.fourth),
    )


@inlined
def _leaning(m, theta):
    """Return the least energy [J/kg] of weight and shaft at the rotation ``theta``, and the modes' coordinates there [m]."""
    side = 1.0 if theta > 0.0 else -1.0
    u = hanging(m, m.gravity * math.sin(theta))
    return m.gravity * on_pivot(m, theta, side)[0] - bending_energy(m, u), u


@kernel
def _cannot_reach(m, devices, now, limit):
    """Return True if the present energy does not suffice to reach ``limit`` [rad] on either side; False beyond ``tipping``."""
    kinetic, potential = kinetic_and_potential(m, now.y, now.contact)
    energy, least = kinetic + potential + bending_energy(m, deflections(now.y)), math.inf
    if devices is not None:
        kept, back = stored_by_devices(m, devices, now.y, now.contact)
        energy += kept + back
    for side in (-1.0, 1.0):
        level, u = _leaning(m, side * limit)
        if devices is not None:
            there = flexing(on_pivot(m, side * limit, side)[0], side * limit, 0.0, 0.0, u, scaled(u, 0.0))
            level += stored_by_devices(m, devices, there, on_side(side))[0]
        least = min(least, level)
    return abs(now.y.theta) < m.tipping and energy <= least


@kernel
def _stands_for_good(m, devices, now):
    """Return True if both feet are down and the remaining vibration of the shaft cannot lift either of them."""
    y, contact = now.y, now.contact
    if contact.left == 0.0 or contact.right == 0.0:
        return False
    straight = flexing(0.0, 0.0, 0.0, 0.0, PerMode(0.0, 0.0, 0.0, 0.0), PerMode(0.0, 0.0, 0.0, 0.0))
    still, inertia = Ground(0.0, 0.0, 0.0, 0.0), masses_about(m, deflections(straight), 1.0).turning
    inertia -= dot(m.coupling, m.coupling)
    held = -max(lifting(m, devices, straight, -1.0, still), lifting(m, devices, straight, 1.0, still)) * inertia
    u, u_rate, lifts = deflections(y), deflection_rates(y), 0.0
    for i in range(MOST_MODES):
        frequency = m.frequency[i]
        quick = abs(m.coupling[i]) * frequency * math.hypot(frequency, m.damping[i])
        lifts += (quick + m.gravity * abs(m.share[i])) * math.hypot(u[i], u_rate[i] / frequency)
    return lifts < held


@system.status_at_sample.of(FlexibleTraits)
def status_at_sample(traits, lanes, i, devices):
    """Return the status at a sample, and the next sample to check: the end of the record, then every one."""
    status = _status(traits, lanes, i, devices)
    return status, max(lanes.clock.npts[i] - 1.0, lanes.clock.sample[i] + 1.0)


@kernel
def _status(traits, lanes, i, devices):
    """Return the status of the run in lane ``i``: RUNNING until the tail is over, and on while the peak may be exceeded.

    SURVIVED then. At the latest end SURVIVED if that is the end of the tail, RESTLESS if the pier cannot reach ``tipping`` by its
    energy, else UNDECIDED.
    """
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
