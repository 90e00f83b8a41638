"""Forces of a recorded run at its base: at its rows, or the greatest of the whole run."""

import math

import numpy as np

from rockbatch.core.devices.laws import FRICTION
from rockbatch.core.observe.forces import FORCES, Body, Hold, Outline
from rockbatch.core.observe.peaks import NEVER, NOTED, Extremes, Limits, RecordedRun, forces_of_run
from rockbatch.motions.motion import Samples
from rockbatch.pier import Pier, RigidBase
from rockbatch.simulation.elements import elements
from rockbatch.simulation.models import ground_of, model, per_mode
from rockbatch.simulation.restraints import apart, recorded
from rockbatch.simulation.runs import Run
from rockbatch.simulation.starting import start_of


def at_rows(run: Run, rows: np.recarray) -> np.recarray:
    """Return the forces (core.observe.forces.Forces) at ``rows`` that include both sides of every event."""
    forces = np.recarray(len(rows), FORCES)
    observed(run, rows, 0.0, forces, np.zeros(0))
    return forces


def observed(run: Run, rows: np.recarray, least_normal: float, forces: np.recarray, extremes: Samples) -> np.record:
    """Fill ``forces`` at the rows, or ``extremes`` over ``rows`` at every step; return the record Noted.

    An empty array is not filled; without rows nothing is. The friction demand is taken where N > ``least_normal`` M g.
    """
    noted = np.zeros(1, NOTED).view(np.recarray)
    noted.slides = noted.pulls = NEVER
    if len(rows) == 0:
        return noted[0]
    pier, base = run.pier, run.base
    most = math.inf if base.friction is None else float(base.friction)
    limits = Limits(most, least_normal * float(pier.gravity), start_of(pier, base).unstressed)
    body = float(pier.deck) if base.on_springs else Body(_outline(pier, base), _friction_hold(pier, base))
    plain, pulls = apart(base, rows)
    devices = recorded(pier, base, rows) if base.restraints else None
    recording = RecordedRun(plain, pulls, devices, ground_of(run.motion), float(run.motion.dt))
    forces_of_run(model(pier, base), body, recording, Extremes(limits, extremes, noted), forces)
    return noted[0]


def _friction_hold(pier: Pier, base: RigidBase) -> Hold:
    """Return the resistance of friction dampers to a pier that begins to turn about its left or right pivot."""
    numbers = []
    for side in (-1.0, 1.0):
        rubs = [
            (law.strength, pier.half_width - side * law.offset) for law in elements(pier, base) if law.kind == FRICTION
        ]
        numbers.append(sum(math.copysign(strength, d) for strength, d in rubs if d != 0.0))
        numbers.append(sum(strength * abs(d) for strength, d in rubs) / pier.inertia_about_pivot)
    return Hold(*map(float, numbers))


def _outline(pier: Pier, base: RigidBase) -> Outline:
    """Return the outline of a pier: size, width, and the place of its deck.

    The deck of a frame rests on corners of its columns, twice as far from their pivots as their centres of mass are.
    """
    size, width = float(pier.size), 2.0 * float(pier.half_width)
    if pier.deck_over_columns is not None:
        return Outline(size, width, width / math.sin(pier.alpha) / size, 0.0)
    bent = per_mode(base.modes(pier).at(pier.deck)) if base.bends else None
    return Outline(size, width, 1.0, float(pier.deck - pier.height), bent)
