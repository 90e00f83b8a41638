"""Ending of a run on a footing (THEORY.md, When a run is over). Looked at once a sample, from the end of the record on."""

from typing import NamedTuple

from rockbatch.core import system
from rockbatch.core.block.ending import stored_by_devices
from rockbatch.core.clock import ground_rests
from rockbatch.core.footing.equations import energies
from rockbatch.core.footing.model import FootingTraits, State
from rockbatch.core.footing.statics import level_at, level_energy, summit
from rockbatch.core.kernel import kernel
from rockbatch.core.system import pier_in
from rockbatch.core.types import RESTLESS, RUNNING, SURVIVED, UNDECIDED


class Ending(NamedTuple):
    """Numbers that decide when the run is over."""

    longest: float  # sample at which the pier is no longer waited for
    load: float  # what the bed carries at rest, the weight and what tendons add to it [m/s²]


@kernel
def set_deadline(lanes, i, run):
    """Set how long lane ``i`` goes on after its record at most."""
    lanes.ending.longest[i] = lanes.clock.samples[i] + run.patience
    lanes.ending.load[i] = run.gravity + run.prestress


@kernel
def _kept(m, devices, y, contact):
    """Return the energy [J/kg] that devices store in state ``y``, and what they may give back."""
    if devices is None:
        return 0.0, 0.0
    return stored_by_devices(m, devices, y, contact)


@kernel
def cannot_turn_further(m, devices, now, load, peak):
    """Return whether the energy of this moment does not suffice to turn beyond ``peak`` [rad] to either side.

    To pass a rotation takes at least the energy of the pier at rest there, on the bed as it is: yielding only costs more. Past
    its summit nothing holds the pier, so that it is the lesser rotation that counts.
    """
    y, limit = now.y, min(peak, summit(m, load))
    if not abs(y.theta) < limit:
        return False
    kinetic, potential, elastic = energies(m, y)
    kept, back = _kept(m, devices, y, now.contact)
    energy = kinetic + potential + elastic + kept + back
    if m.finite is None:
        energy -= 0.5 * load * m.height * y.theta * y.theta
    for side in (-1.0, 1.0):
        theta = side * limit
        there, _ = _kept(m, devices, State(level_at(m, theta, load), theta, 0.0, 0.0), now.contact)
        if not energy <= level_energy(m, theta, load) - (load - m.gravity) * level_at(m, theta, load) + there:
            return False
    return True


@system.status_at_sample.of(FootingTraits)
def status_at_sample(traits, lanes, i, devices):
    """Return the status at a sample, and the next one to look at it: the end of the record, and every one from there on."""
    status, clock = _status(traits, lanes, i, devices), lanes.clock
    decided = lanes.peak.decided_at[i] >= 0.0
    following = max(clock.samples[i] if decided else clock.npts[i] - 1.0, clock.sample[i] + 1.0)
    return status, following


@kernel
def _status(traits, lanes, i, devices):
    """Return how the run in lane ``i`` has ended, RUNNING if it goes on."""
    clock, peak, longest = lanes.clock, lanes.peak, lanes.ending.longest[i]
    sample, samples = clock.sample[i], clock.samples[i]
    if peak.decided_at[i] >= 0.0:
        return RUNNING if sample < samples else SURVIVED
    if not ground_rests(lanes, i) and sample < longest:
        return RUNNING
    if longest == samples:  # nothing is waited for
        return RUNNING if sample < samples else SURVIVED
    m, now = pier_in(traits, lanes, i)
    load = lanes.ending.load[i]
    if ground_rests(lanes, i) and cannot_turn_further(m, devices, now, load, peak.theta[i]):
        peak.decided_at[i] = sample
        return RUNNING if sample < samples else SURVIVED
    if sample < longest:
        return RUNNING
    return RESTLESS if abs(now.y.theta) < summit(m, load) else UNDECIDED
