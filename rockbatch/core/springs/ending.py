"""End of a run on springs, and reading of its residuals, checked once a sample after the record.

See THEORY.md, When a run is over.
"""

import math
from typing import NamedTuple

from rockbatch.core import system
from rockbatch.core.clock import UNSET, ground_rests
from rockbatch.core.devices.elongation import attitude, gap_of
from rockbatch.core.devices.laws import CONTACT, HYSTERETIC, SPRING, TENDON, force, stored
from rockbatch.core.kernel import kernel
from rockbatch.core.springs.equations import geometry
from rockbatch.core.springs.free_vibration import (
    Drift,
    Load,
    further,
    growth,
    lean_on,
    peak_is_final,
    rocking_period,
    unstable_equilibrium,
)
from rockbatch.core.springs.model import SpringTraits, State, Supports
from rockbatch.core.system import pier_in
from rockbatch.core.types import GROWING, RESTLESS, RUNNING, SURVIVED, UNDECIDED, Moment

GROWTH = 1e-4
"""Growth of |θ| and of the base's tilt over α in the second half of the time after the record above which a pier counts as
leaning further."""


FORESEEN = 2.0
"""Factor by which a base on ratcheting springs may drift faster than between its readings: its lean accelerates it, and undamped
vibration comes and goes (measured: without it a pier counted as standing that overturned)."""


class Waiting(NamedTuple):
    """Numbers that decide when a run is over, and its residuals."""

    earliest: float  # first sample at which residuals may be read
    patience: float  # greatest number of further samples
    longest: float  # sample at which the run ends in any case
    read_wait: float  # samples between two readings; 0 if springs do not yield
    read_by: float  # sample from which residuals are read even if the pier still steps, or may turn further
    read: float  # sample of the first reading, UNSET before it
    read_left: (
        float  # unstressed positions of both supports then [m]; their difference is a mean up to the second reading
    )
    read_right: float
    last_read: float  # sample of the last reading, and positions then
    last_left: float
    last_right: float
    drift_left: float  # of both supports from the first reading to the second [m/s], NaN before it
    drift_right: float
    last_drift_left: float  # between the last two readings, 0 before them
    last_drift_right: float
    midway: float  # greatest |θ| halfway between tail and longest end [rad]
    midway_tilt: float  # |tilt| of the base then [rad]
    load: float  # load of the supports at rest: weight and tendons [m/s²]
    stored: float  # energy that devices may return, beyond the work of that load [J/kg]
    period: float  # of rocking in full contact [s]
    growth: float  # factor by which impacts may still raise the energy
    further_right: float  # foreseen Drift of the base's tilt
    further_left: float
    further_growth: float


@kernel
def set_deadline(lanes, i, m, run):
    """Set the sample at which the run in lane ``i`` ends at the latest, and those from which residuals may and must be read.

    Clear all readings.
    """
    waiting, last, samples = lanes.waiting, lanes.clock.npts[i] - 1.0, lanes.clock.samples[i]
    waiting.earliest[i] = last + run.read_after
    waiting.patience[i] = run.patience
    waiting.read_wait[i] = run.read_wait
    waiting.longest[i] = max(samples, waiting.earliest[i] + run.read_wait) + run.patience
    waiting.read_by[i] = waiting.earliest[i] + (run.patience if run.read_wait > 0.0 else 0.0)
    waiting.read[i], waiting.read_left[i], waiting.read_right[i] = UNSET, math.nan, math.nan
    waiting.drift_left[i], waiting.drift_right[i] = math.nan, math.nan
    waiting.last_drift_left[i], waiting.last_drift_right[i] = 0.0, 0.0
    waiting.midway[i] = waiting.midway_tilt[i] = math.inf
    waiting.load[i], waiting.stored[i] = run.gravity + run.prestress, 0.0
    waiting.period[i] = rocking_period(m)
    waiting.further_right[i] = waiting.further_left[i] = waiting.further_growth[i] = 0.0
    waiting.growth[i] = growth(m, (waiting.longest[i] - waiting.earliest[i]) * run.dt)


@kernel
def _unstressed(m, position, z, on_spring, waiting):
    """Return the unstressed position of a support [m]: by its pivot in contact, else ``waiting``."""
    return position - m.yield_deflection * z if on_spring != 0.0 else waiting


@kernel
def base_of(m, now):
    """Return the unstressed positions [m] of both supports."""
    y, contact, supports = now
    at = geometry(m, y.theta)
    left = _unstressed(m, y.v + at.lift_left, y.z_left, contact.left, supports.left)
    right = _unstressed(m, y.v + at.lift_right, y.z_right, contact.right, supports.right)
    return left, right


@kernel
def _tilt(m, now):
    """Return the |tilt| of the base [rad]."""
    left, right = base_of(m, now)
    return 0.5 * abs(left - right) / m.half_width


@kernel
def _calm_from(lanes, i):
    """Return the time [s] one period of rocking after the last contact event, or after the record if that is later."""
    return max(lanes.tally.moved[i], lanes.clock.npts[i] * lanes.clock.dt[i]) + lanes.waiting.period[i]


@kernel
def _stands(lanes, i, contact):
    """Return True if the pier has stood on both pivots for a period of rocking with the ground at rest."""
    both = contact.left != 0.0 and contact.right != 0.0
    return both and lanes.clock.sample[i] * lanes.clock.dt[i] >= _calm_from(lanes, i)


@kernel
def _legible(lanes, i, contact):
    """Return True if residuals may be read: the pier stands, or the latest sample for it has come."""
    return lanes.clock.sample[i] >= lanes.waiting.read_by[i] or _stands(lanes, i, contact)


@kernel
def _base_and_yield_points(m, now):
    """Return the unstressed positions of both supports [m], and their yield points."""
    left, right = base_of(m, now)
    return Supports(left, right, now.supports.yield_left, now.supports.yield_right)


@kernel
def _peak_is_final(lanes, i, m, now, devices):
    """Return True if nothing can exceed the peak any more; False while the ground moves."""
    if not ground_rests(lanes, i):
        return False
    waiting = lanes.waiting
    calm = devices is None and m.shaft is None and _stands(lanes, i, now.contact)
    on_base = Moment(now.y, now.contact, _base_and_yield_points(m, now))
    drift = Drift(waiting.further_right[i], waiting.further_left[i], waiting.further_growth[i])
    load = Load(waiting.load[i], waiting.stored[i], waiting.growth[i])
    return peak_is_final(m, on_base, load, lanes.peak.theta[i], calm, drift)


@kernel
def _read_base(lanes, i, m, now):
    """Record the unstressed positions of both supports; from the second reading on, also their drift since the last.

    By that, :func:`_foresee` further drift.
    """
    waiting, sample = lanes.waiting, lanes.clock.sample[i]
    left, right = base_of(m, now)
    if waiting.read[i] < 0.0:
        waiting.read[i], waiting.read_left[i], waiting.read_right[i] = sample, left, right
    else:
        seconds = waiting.read_wait[i] * lanes.clock.dt[i]
        drift_left = (left - waiting.last_left[i]) / seconds
        drift_right = (right - waiting.last_right[i]) / seconds
        waiting.last_drift_left[i], waiting.last_drift_right[i] = drift_left, drift_right
        if waiting.last_read[i] == waiting.read[i]:
            waiting.drift_left[i], waiting.drift_right[i] = drift_left, drift_right
        _foresee(lanes, i, m)
    waiting.last_read[i], waiting.last_left[i], waiting.last_right[i] = sample, left, right


@kernel
def _foresee(lanes, i, m):
    """Set the greatest Drift of the base within half the patience, on each side by the greater of two rates.

    They are those between the first two readings and between the last two. It is FORESEEN = 2 times as far ahead if the
    springs ratchet.
    """
    waiting = lanes.waiting
    ahead = 0.5 * waiting.patience[i] * lanes.clock.dt[i] * (FORESEEN if m.creep > 0.0 else 1.0)
    last_left, last_right = ahead * waiting.last_drift_left[i], ahead * waiting.last_drift_right[i]
    first_left, first_right = ahead * waiting.drift_left[i], ahead * waiting.drift_right[i]
    last, first = (last_left - last_right) / m.half_width, (first_left - first_right) / m.half_width
    sinking = max(0.0, -(last_left + last_right), -(first_left + first_right))
    drift = further(m, max(0.0, first, last), max(0.0, -first, -last), sinking)
    waiting.further_right[i], waiting.further_left[i], waiting.further_growth[i] = drift.right, drift.left, drift.growth


@kernel
def _include_in_mean(lanes, i, m, now):
    """Include this sample in the tilt, a mean over the time between the first two readings."""
    waiting = lanes.waiting
    left, right = base_of(m, now)
    samples = lanes.clock.sample[i] - waiting.read[i] + 1.0
    higher = 0.5 * (left - right - waiting.read_left[i] + waiting.read_right[i]) / samples
    waiting.read_left[i] += higher
    waiting.read_right[i] -= higher


@kernel
def _energy_at_deck(m, devices, y, contact):
    """Return the energy [J/kg] stored in springs and stops at the deck in state ``y``; it depends on θ alone."""
    energy, at = 0.0, attitude(m, y, contact, devices.level[0])
    for j in range(len(devices.elements)):
        of = devices.elements[j]
        if of.height != 0.0 and of.kind in (CONTACT, SPRING):
            energy += stored(of, gap_of(m, of, at, y).elongation, devices.x[j])
    return energy


@kernel
def _set_load_and_energy(lanes, i, m, devices, now):
    """Set the load of the supports at rest [m/s²], and the energy [J/kg] that devices may return beyond its work.

    Nothing without devices. A tendon's energy is convex in its elongation and lies above any tangent; that at the present
    settlement is taken. Other devices return their elastic energy, less the energy that springs and stops at the deck store at
    the peak, or at an unstable equilibrium before it, on the side where it is less. Tendons off the middle add the work of their
    moment.
    """
    if devices is None:
        return
    y, contact, (left, right) = now.y, now.contact, base_of(m, now)
    at = attitude(m, y, contact, devices.level[0])
    sunk = 0.5 * (left + right) - lanes.lowest.plastic[i]
    load, beyond, turning = m.gravity, 0.0, 0.0
    for j in range(len(devices.elements)):
        of, plastic = devices.elements[j], devices.x[j]
        if of.kind == HYSTERETIC:
            beyond += 0.5 * of.strength * plastic * plastic * (1.0 + of.give) / of.stiffness
        elif of.kind != TENDON:
            beyond += stored(of, gap_of(m, of, at, y).elongation, plastic)
        if of.kind != TENDON:
            continue
        pull = min(max(force(of, sunk, 0.0, plastic, 0.0, 0.0), 0.0), of.strength)
        now = gap_of(m, of, at, y).elongation
        beyond += stored(of, now, plastic) - stored(of, sunk, plastic) - pull * (now - sunk)
        load += pull
        turning += pull * of.offset
    lanes.waiting.load[i] = load
    limit = min(lanes.peak.theta[i], unstable_equilibrium(m, load))
    right, left = State(y.v, limit, 0.0, 0.0, 0.0, 0.0), State(y.v, -limit, 0.0, 0.0, 0.0, 0.0)
    at_limit = min(_energy_at_deck(m, devices, right, contact), _energy_at_deck(m, devices, left, contact))
    lanes.waiting.stored[i] = max(beyond, 0.0) + abs(turning) * (abs(y.theta) + lanes.peak.theta[i]) - at_limit


@system.status_at_sample.of(SpringTraits)
def status_at_sample(traits, lanes, i, devices):
    """Return the status of the run in lane ``i``, and the next sample to check or to read residuals."""
    status = _status(traits, lanes, i, devices)
    return status, _next_due(lanes, i)


@kernel
def _status(traits, lanes, i, devices):
    """Return the status of the run in lane ``i``, RUNNING unless it ends; read residuals when due.

    SURVIVED from the end of the tail on, once the peak is final and residuals are read; :func:`_given_up` at the latest end.
    """
    waiting, sample = lanes.waiting, lanes.clock.sample[i]
    samples, longest = lanes.clock.samples[i], waiting.longest[i]
    if sample < waiting.earliest[i]:
        return RUNNING
    wait, decided = waiting.read_wait[i], lanes.peak.decided_at[i] >= 0.0
    if decided and wait == 0.0:  # nothing can change any more
        return RUNNING if sample < samples else SURVIVED
    m, now = pier_in(traits, lanes, i)
    if decided and waiting.read[i] < 0.0 and not _legible(lanes, i, now.contact):
        return RUNNING
    if wait > 0.0 and (decided or sample >= waiting.read_by[i]):
        if waiting.read[i] < 0.0 or sample == waiting.last_read[i] + wait:
            _read_base(lanes, i, m, now)
        elif sample < waiting.read[i] + wait:
            _include_in_mean(lanes, i, m, now)
    if decided and sample < max(samples, waiting.read[i] + wait):
        return RUNNING
    _set_load_and_energy(lanes, i, m, devices, now)
    final = _peak_is_final(lanes, i, m, now, devices)
    if final and not decided:
        lanes.peak.decided_at[i] = sample
        if waiting.read[i] < 0.0 and _legible(lanes, i, now.contact):
            _read_base(lanes, i, m, now)
    if final and waiting.read[i] >= 0.0 and sample >= max(samples, waiting.read[i] + wait):
        return SURVIVED
    if sample == (samples + longest) // 2:
        waiting.midway[i], waiting.midway_tilt[i] = lanes.peak.theta[i], _tilt(m, now)
    return RUNNING if sample < longest else _given_up(lanes, i, m, now)


@kernel
def _next_due(lanes, i):
    """Return the next sample at which the run may end, or residuals have to be read."""
    waiting, sample = lanes.waiting, lanes.clock.sample[i]
    if sample < waiting.earliest[i]:
        return waiting.earliest[i]
    if lanes.peak.decided_at[i] < 0.0:
        return sample + 1.0
    if waiting.read_wait[i] == 0.0:
        return max(lanes.clock.samples[i], sample + 1.0)
    if waiting.read[i] < 0.0:
        stands = math.floor(_calm_from(lanes, i) / lanes.clock.dt[i])
        return max(min(waiting.read_by[i], stands), sample + 1.0)
    if sample < waiting.read[i] + waiting.read_wait[i]:
        return sample + 1.0  # a mean is taken
    return max(min(waiting.last_read[i] + waiting.read_wait[i], lanes.clock.samples[i]), sample + 1.0)


@kernel
def _given_up(lanes, i, m, now):
    """Return the status of a run that is still undecided at its longest end; SURVIVED if it has no patience.

    UNDECIDED beyond the unstable equilibrium; GROWING if, on springs that ratchet, peak and tilt have grown by more than GROWTH α
    since midway; else RESTLESS.
    """
    if lanes.waiting.patience[i] == 0.0:
        return SURVIVED
    lean = lean_on(m, _base_and_yield_points(m, now))
    if max(abs(lean), abs(now.y.theta)) >= unstable_equilibrium(m, lanes.waiting.load[i]):
        return UNDECIDED
    least = GROWTH * lanes.clock.alpha[i]
    turned = lanes.peak.theta[i] > lanes.waiting.midway[i] + least
    tilted = _tilt(m, now) > lanes.waiting.midway_tilt[i] + least
    return GROWING if m.creep > 0.0 and turned and tilted else RESTLESS
