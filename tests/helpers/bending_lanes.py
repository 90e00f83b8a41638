"""Random sub-steps of piers whose shafts bend, by the pass over lanes and by the search for events, both uncompiled."""

from typing import NamedTuple

import numpy as np
from bending_piers import DT, TOWER, pier_of

import rockbatch as rb
from rockbatch.core.block.equations import constrained, on_side
from rockbatch.core.block.model import Stance
from rockbatch.core.clock import CALM, EVENTFUL, STANDS, ground_at, read_ground, start_clock
from rockbatch.core.flexure.displacements import Displacements, displacements_within
from rockbatch.core.flexure.model import Flexing
from rockbatch.core.roots import largest_within
from rockbatch.core.run import Settings
from rockbatch.core.search import first_event, marks_for
from rockbatch.core.springs.laws import CODES
from rockbatch.core.springs.model import BentState, Contact, Supports
from rockbatch.core.springs.reversal import pivots
from rockbatch.core.system import begin, longest_step, one_pass, pier_in, rates, take_in_step
from rockbatch.core.table import LANES, get, put, record, table
from rockbatch.core.types import NO_EVENT, Ground, Instant, Part
from rockbatch.simulation.models import line_of, model, system_of
from rockbatch.simulation.starting import start_of

PIER = pier_of(*TOWER)
STILL = np.zeros((2, 4))
SUBSTEP = 3
WAYS, SPEEDS = (0.002, 6e-5, 6e-6, 2e-6), (0.02, 0.004, 0.001, 0.0005)
"""Of the modes of a pier that often stands [m, m/s]."""


class Judged(NamedTuple):
    """What a pass made of sub-steps, and whether each agrees with scalar code to the bit; arrays of one for each."""

    kind: np.ndarray  # the step status
    watched: np.ndarray  # whether the sub-step before ended with an event function at zero
    event: np.ndarray  # whether the search finds an event
    ends: np.ndarray  # whether the state at the end is that of a scalar step without events
    taken: (
        np.ndarray
    )  # whether the lane is where it should be: at the end, if it stands once it is taken in, else where it was
    displaced: np.ndarray  # whether one that stands has the greatest displacements of scalar code, another those before
    peak: np.ndarray  # and one that is calm the peak


def _on_rock(rng, m):
    """Return a random state of a pier on rigid ground, its stance and no supports; one of eight flies."""
    flies, side = rng.random() < 0.125, float(rng.integers(-1, 2))
    stance = Stance(0.0, 0.0, side, side) if flies else (on_side(side) if side else Stance(1.0, 1.0, 0.0, 0.0))
    theta, omega = side * abs(rng.normal(0.0, 3e-4)), rng.normal(0.0, 0.1)
    moves = theta, 0.0, omega if side else 0.0
    numbers = (0.05 if flies else 0.0, *moves, *rng.normal(0.0, WAYS), *rng.normal(0.0, SPEEDS))
    return constrained(m, Flexing(*map(float, numbers)), stance), stance, None


def _on_springs(rng, m):
    """Return a random state of a pier on springs, its contact and supports."""
    down, z = rng.random(2) < 0.7, -abs(rng.normal(0.0, 0.3, 2))
    moves = *rng.normal(0.0, 0.003, 2), *rng.normal(0.0, (0.02, 0.005))
    y = BentState(*map(float, (*moves, *z, *rng.normal(0.0, WAYS), *rng.normal(0.0, SPEEDS))))
    goes_down = np.array([pivot.velocity < 0.0 for pivot in pivots(m, y)])
    yields = down * (goes_down ^ (rng.random(2) < 0.05)) * (m.law == CODES["bouc-wen"])
    contact = Contact(*map(float, (*down, *yields)), 0.0)
    return y, contact, Supports(*map(float, -abs(rng.normal(0.0, 0.003, 2))))


def _start(rng, m, lanes, i, run):
    """Put a random moment of a pier, its ground and what it has been through into lane ``i``."""
    start_clock(lanes, i, i, run)
    read_ground(lanes, i, STILL)
    begin(system_of(m).traits, lanes, i, run)
    springs = hasattr(m, "shaft")
    y, contact, supports = (_on_springs if springs else _on_rock)(rng, m)
    put(lanes.now, i, y)
    put(lanes.contact, i, contact)
    if supports is not None:
        put(lanes.supports, i, supports)
        lanes.lowest.left[i] = lanes.lowest.right[i] = -1.0
    put(lanes.ground, i, Ground(*map(float, rng.normal((0.0, 0.0, 5.0, 0.0), (0.7, 1e3, 2.0, 1e3)))))
    put(lanes.displaced, i, Displacements(*map(float, rng.choice((0.0, 0.01, 0.5), 2))))
    lanes.peak.theta[i], lanes.step_status.watched[i] = (
        rng.choice((abs(y.theta), 3e-4, 0.1)),
        float(rng.random() < 0.05),
    )


def judged(base: rb.RigidBase | rb.ElasticBase, seed: int, tables: int, h: float) -> Judged:
    """Return what a pass over sub-steps of ``h`` [s] comes to in so many ``tables`` of random lanes."""
    rng, m, rows = np.random.default_rng(seed), model(PIER, base), []
    system, marks = system_of(m), marks_for(0)
    line = line_of(m, (h, 1, 0, 0, 2, 0), (0, 0), 0.0, start_of(PIER, base))
    runs = np.array([line] * LANES, record(system.line)).view(np.recarray)
    for _ in range(tables):
        lanes = table(system.lane)[0][0]
        for i in range(LANES):
            _start(rng, m, lanes, i, runs[i])
        starts = [pier_in(system.traits, lanes, i) for i in range(LANES)]
        before = [(get(lanes.displaced, i, Displacements), float(lanes.peak.theta[i])) for i in range(LANES)]
        one_pass(system.traits, lanes, LANES, SUBSTEP, Settings(2 * SUBSTEP, True, False))
        rows += [_compared(m, lanes, i, starts[i], before[i], h, marks) for i in range(LANES)]
    return Judged(*map(np.array, zip(*rows, strict=True)))


def _compared(m, lanes, i, start, before, h, marks):
    """Return the fields of Judged of lane ``i``, which began at ``start`` with the extremes ``before``."""
    pier, now = start
    displaced, peak = before
    ground = ground_at(lanes, i, SUBSTEP * h)
    instant = Instant(now.y, rates(pier, now.y, now.contact, ground), now.contact, now.supports, ground)
    _, which, end, _ = first_event(pier, None, marks, instant, longest_step(pier, instant, h), False, True)
    kind, kinds = lanes.step_status.kind[i], type(now.y)
    taken = get(lanes.now, i, kinds) == (end if kind == CALM else now.y)
    if kind == STANDS:
        take_in_step(system_of(m).traits, lanes, i, SUBSTEP, None)
        taken = taken and get(lanes.now, i, kinds) == end
    if kind < EVENTFUL:
        displaced = displacements_within(getattr(pier, "shaft", pier), Part(now, end, h), displaced)
    if kind == CALM:
        peak = largest_within(now.y.theta, now.y.omega, end.theta, end.omega, h, peak)[1]
    return (
        kind,
        lanes.step_status.watched[i] > 0.0,
        which != NO_EVENT,
        kind >= EVENTFUL or get(lanes.end, i, kinds) == end,
        taken,
        get(lanes.displaced, i, Displacements) == displaced,
        float(lanes.peak.theta[i]) == peak,
    )


STEPS = DT / 128, DT / 32, DT / 8
"""Sub-steps [s] in which few, some and many lanes have an event."""
