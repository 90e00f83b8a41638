"""Ending of a run on a footing (THEORY.md, When a run is over), checked once a sample from the end of the record on."""

from typing import NamedTuple

from rockbatch.core import system
from rockbatch.core.block.ending import stored_by_devices
from rockbatch.core.clock import ground_rests
from rockbatch.core.footing.equations import at_rest, energies
from rockbatch.core.footing.model import FootingTraits
from rockbatch.core.footing.statics import level_at, level_energy, summit
from rockbatch.core.kernel import kernel
from rockbatch.core.system import pier_in
from rockbatch.core.types import RESTLESS, RUNNING, SURVIVED, UNDECIDED


class Ending(NamedTuple):
    """Numbers that decide when the run is over."""

    longest: float  # sample at which the run ends in any case
    load: float  # load of the bed at rest: weight and tendons [m/s²]


@kernel
def set_deadline(lanes, i, run):
    """Set the sample at which lane ``i`` ends at the latest, and the load of its bed at rest."""
    lanes.ending.longest[i] = lanes.clock.samples[i] + run.patience
    lanes.ending.load[i] = run.gravity + run.prestress


@kernel
def _kept(m, devices, y, contact):
    """Return the result of :func:`stored_by_devices`, zeros without devices."""
    if devices is None:
        return 0.0, 0.0
    return stored_by_devices(m, devices, y, contact)


@kernel
def cannot_turn_further(m, devices, now, load, peak):
    """Return whether the present energy does not suffice to turn beyond ``peak`` [rad], or beyond the summit, to either side.

    To pass a rotation takes at least the energy of the pier at rest there, on the bed as it is: yielding only costs more. Past
    its summit nothing holds the pier: the lesser of both rotations counts. False if |θ| is not below it.
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
        there, _ = _kept(m, devices, at_rest(m.shaft, m, level_at(m, theta, load), theta), now.contact)
        if not energy <= level_energy(m, theta, load) - (load - m.gravity) * level_at(m, theta, load) + there:
            return False
    return True


@system.status_at_sample.of(FootingTraits)
def status_at_sample(traits, lanes, i, devices):
    """Return the status at a sample, and the next sample to check: the end of the record, then every one.

    Once the peak is final, it is the end of the tail.
    """
    status, clock = _status(traits, lanes, i, devices), lanes.clock
    decided = lanes.peak.decided_at[i] >= 0.0
    following = max(clock.samples[i] if decided else clock.npts[i] - 1.0, clock.sample[i] + 1.0)
    return status, following


@kernel
def _status(traits, lanes, i, devices):
    """Return the status of the run in lane ``i``: RUNNING until the tail is over, and on while the peak may be exceeded.

    The sample at which the peak is final is noted. SURVIVED then. At the latest end SURVIVED if that is the end of the tail,
    RESTLESS below the summit, else UNDECIDED.
    """
    clock, peak, longest = lanes.clock, lanes.peak, lanes.ending.longest[i]
    sample, samples = clock.sample[i], clock.samples[i]
    if peak.decided_at[i] >= 0.0:
        return RUNNING if sample < samples else SURVIVED
    if not ground_rests(lanes, i) and sample < longest:
        return RUNNING
    if longest == samples:  # the run ends with its tail in any case
        return RUNNING if sample < samples else SURVIVED
    m, now = pier_in(traits, lanes, i)
    load = lanes.ending.load[i]
    if ground_rests(lanes, i) and cannot_turn_further(m, devices, now, load, peak.theta[i]):
        peak.decided_at[i] = sample
        return RUNNING if sample < samples else SURVIVED
    if sample < longest:
        return RUNNING
    return RESTLESS if abs(now.y.theta) < summit(m, load) else UNDECIDED
