"""End of a run on a rigid base, checked once a sample after the tail (THEORY.md, When a run is over)."""

import math

from rockbatch.core import system
from rockbatch.core.block.equations import on_pivot, on_side, side_of
from rockbatch.core.block.model import BlockTraits
from rockbatch.core.clock import ground_rests
from rockbatch.core.devices.elongation import attitude, gap_of
from rockbatch.core.devices.laws import HYSTERETIC, MAXWELL, stored
from rockbatch.core.devices.pull import sticking
from rockbatch.core.kernel import inlined, kernel
from rockbatch.core.system import pier_in
from rockbatch.core.types import NO_EVENT, RESTLESS, RUNNING, SURVIVED, UNDECIDED


@kernel
def reach_of(theta, omega, alpha, p):
    """Return the greatest |θ| [rad] that the energy of a state allows in free rocking; inf if the pier may overturn."""
    tilt = abs(theta)
    level = math.cos(alpha - tilt) + 0.5 * (omega / p) * (omega / p)
    if tilt >= alpha or level >= 1.0:
        return math.inf
    return alpha - math.acos(level)


@inlined
def stored_by_devices(m, devices, y, contact):
    """Return the energies [J/kg] stored in tendons, stops and springs, and in hysteretic dampers and braces, in state ``y``."""
    kept, back, at = 0.0, 0.0, attitude(m, y, contact, devices.level[0])
    for j in range(len(devices.elements)):
        of = devices.elements[j]
        if of.kind == HYSTERETIC:
            back += 0.5 * of.strength * devices.x[j] * devices.x[j] * (1.0 + of.give) / of.stiffness
        elif of.kind == MAXWELL:
            back += stored(of, 0.0, devices.x[j])
        else:
            kept += stored(of, gap_of(m, of, at, y).elongation, devices.x[j])
    return kept, back


@inlined
def _at_rest(m, y, theta):
    """Return the state at rest at rotation ``theta``, on the pivot of that side, of the type of ``y``."""
    v, _ = on_pivot(m, theta, 1.0 if theta > 0.0 else -1.0)
    return type(y)(v, theta, 0.0, 0.0)


@kernel
def _cannot_reach(m, devices, now, peak):
    """Return True if the present energy does not suffice to exceed ``peak`` [rad], or α if less, on either side; False beyond α.

    Weight, tendons and springs have a potential, stops dissipate, and dampers return only the elastic energy of hysteretic
    ones and braces.
    """
    y, limit, inertia = now.y, min(peak, m.alpha), 1.0 / m.quickness
    level = inertia * m.p * m.p
    kept, back = stored_by_devices(m, devices, y, now.contact)
    energy = 0.5 * inertia * y.omega * y.omega + level * math.cos(m.alpha - abs(y.theta)) + kept + back
    least = math.inf
    for side in (-1.0, 1.0):
        there, _ = stored_by_devices(m, devices, _at_rest(m, y, side * limit), on_side(side))
        least = min(least, level * math.cos(m.alpha - limit) + there)
    return abs(y.theta) < m.alpha and energy <= least


@kernel
def _decided(lanes, i, m, devices, now):
    """Return True if nothing can exceed the peak any more, as energy only decreases while the ground is at rest.

    Without devices it is final, too, once the velocity has reversed, if the pier cannot overturn.
    """
    y = now.y
    if devices is None:
        reach = reach_of(y.theta, y.omega, m.alpha, m.p)
        return reach <= lanes.peak.theta[i] or (lanes.ending.turned[i] != 0.0 and reach < math.inf)
    return _cannot_reach(m, devices, now, lanes.peak.theta[i])


@kernel
def held(m, devices, y):
    """Return True if a friction damper sticks and the block's velocity is at most rounding; False without devices."""
    if devices is None:
        return False
    return sticking(devices, NO_EVENT) != NO_EVENT and abs(y.omega) * m.height <= m.rest


@kernel
def set_deadline(lanes, i, run):
    """Set the sample at which a run ends at the latest, and clear the memory of velocity reversals."""
    lanes.ending.longest[i] = lanes.clock.samples[i] + run.patience
    lanes.ending.omega[i] = lanes.ending.turned[i] = 0.0


@kernel
def _watch_reversals(lanes, i):
    """Record a velocity reversal since the last sample while the ground is at rest; in flight discard all before.

    Impacts keep the sign of the velocity; landings from flight do not.
    """
    ending, contact, omega = lanes.ending, lanes.contact, lanes.now.omega[i]
    if contact.left[i] == 0.0 and contact.right[i] == 0.0:
        ending.omega[i] = ending.turned[i] = 0.0
    elif ground_rests(lanes, i):
        ending.turned[i] = 1.0 if ending.omega[i] * omega < 0.0 else ending.turned[i]
        ending.omega[i] = omega


@system.status_at_sample.of(BlockTraits)
def status_at_sample(traits, lanes, i, devices):
    """Return the status at a sample, and the next sample to check: the end of the record, then every one."""
    status = _status(traits, lanes, i, devices)
    return status, max(lanes.clock.npts[i] - 1.0, lanes.clock.sample[i] + 1.0)


@kernel
def _status(traits, lanes, i, devices):
    """Return the status of the run in lane ``i``: RUNNING until the tail is over, and on while the peak may be exceeded.

    SURVIVED then at rest, held by friction (UNDECIDED beyond α), or with a final peak. At the latest end SURVIVED if that is the
    end of the tail, RESTLESS if the pier cannot overturn by its energy, else UNDECIDED.
    """
    sample, samples, longest = lanes.clock.sample[i], lanes.clock.samples[i], lanes.ending.longest[i]
    _watch_reversals(lanes, i)
    if sample < samples:
        return RUNNING
    m, now = pier_in(traits, lanes, i)
    y, contact = now.y, now.contact
    if contact.left != 0.0 and contact.right != 0.0:
        return SURVIVED
    on_ground = side_of(contact) != 0.0
    if on_ground and ground_rests(lanes, i):
        if held(m, devices, y):
            return SURVIVED if abs(y.theta) < m.alpha else UNDECIDED
        if _decided(lanes, i, m, devices, now):
            return SURVIVED
    if sample < longest:
        return RUNNING
    if longest == samples:  # the run ends with its tail in any case
        return SURVIVED
    return RESTLESS if reach_of(y.theta, y.omega, m.alpha, m.p) < math.inf else UNDECIDED
