"""Lanes of piers with an elastic shaft: their table, and the start and the results of their runs."""

import math
from typing import NamedTuple

from rockbatch.core import system
from rockbatch.core.block.equations import clearances, constrained, on_side
from rockbatch.core.block.model import Stance
from rockbatch.core.clock import COMMON, TIMING, include_height
from rockbatch.core.flexure import ending, events, passing  # noqa: F401  hooks of the flexible block
from rockbatch.core.flexure.displacements import Displacements, displacements_in, displacements_within
from rockbatch.core.flexure.ending import hanging
from rockbatch.core.flexure.equations import flexing
from rockbatch.core.flexure.model import NUMBERS, FlexibleTraits, Flexing, Numbers, model_in, numbers_of
from rockbatch.core.flexure.modes import PerMode
from rockbatch.core.kernel import inlined
from rockbatch.core.system import System
from rockbatch.core.table import get, lanes_of, put, taken
from rockbatch.core.types import LEFT, RIGHT, Moment, Part


class Ending(NamedTuple):
    """Number that decides when the run is over."""

    longest: float  # sample at which the run ends in any case


LANE = lanes_of(
    COMMON
    | {
        "model": Numbers,
        "now": Flexing,
        "end": Flexing,
        "rates": Flexing,
        "contact": Stance,
        "ending": Ending,
        "displaced": Displacements,
    }
)


LINE = (
    *NUMBERS,
    ("theta", float),  # at the start [rad]
    *TIMING,
)
"""Fields of the request of a run, with their types."""

Line = NamedTuple("Line", LINE)  # type: ignore[misc]


@system.pier_in.of(FlexibleTraits)
def pier_in(traits, lanes, i):
    """Return the FlexibleBlock of lane ``i`` and its Moment, without supports."""
    return model_in(traits, lanes, i), Moment(get(lanes.now, i, Flexing), get(lanes.contact, i, Stance), None)


@system.begin.of(FlexibleTraits)
def begin(traits, lanes, i, run):
    """Put the model of ``run`` into lane ``i``, and its start: at rest, or leaning on a pivot, bent by its weight."""
    put(lanes.model, i, taken(run, Numbers))
    contact = Stance(1.0, 1.0, 0.0, 0.0) if run.theta == 0.0 else on_side(RIGHT if run.theta > 0.0 else LEFT)
    m = model_in(traits, lanes, i)
    u = hanging(m, m.gravity * math.sin(run.theta))
    y = constrained(m, flexing(0.0, run.theta, 0.0, 0.0, u, PerMode(0.0, 0.0, 0.0, 0.0)), contact)
    put(lanes.now, i, y)
    put(lanes.contact, i, contact)
    lanes.ending.longest[i] = lanes.clock.samples[i] + run.patience
    put(lanes.displaced, i, displacements_in(m, y))


@inlined
def _include_displacements(lanes, i, m, part):
    """Raise the greatest displacements of lane ``i`` to those of a Part."""
    put(lanes.displaced, i, displacements_within(m, part, get(lanes.displaced, i, Displacements)))


@system.take_in_step.of(FlexibleTraits)
def take_in_step(traits, lanes, i, substep, history):
    """Record displacements of a sub-step of lane ``i`` that stands, and advance the lane to its end."""
    m, now = pier_in(traits, lanes, i)
    end = get(lanes.end, i, Flexing)
    _include_displacements(lanes, i, m, Part(now, end, lanes.clock.step[i]))
    put(lanes.now, i, end)


@system.take_in_part.of(FlexibleTraits)
def take_in_part(traits, lanes, i, m, part, after):
    """Record displacements and the height of flight, and set state and stance."""
    _include_displacements(lanes, i, m, part)
    if system.airborne(m, part.start.contact):
        start, top = part.start, part.start.contact.top
        include_height(lanes, i, clearances(m, start.y, top), clearances(m, part.end, top), part.length)
    put(lanes.now, i, after.y)
    put(lanes.contact, i, after.contact)


@system.finish.of(FlexibleTraits)
def finish(traits, lanes, i, t, result):
    """Write the greatest displacements of the top of lane ``i`` into its ``result``."""
    result.deflection_max, result.drift_max = lanes.displaced.deflection[i], lanes.displaced.drift[i]


def system_of(m):
    """Return the System of all piers ``m`` (FlexibleBlock), the same whatever their numbers; its pass takes no devices."""
    return System(FlexibleTraits(), Line, LANE, Flexing._fields + Stance._fields)


def line_of(m, theta, *timing):
    """Return the Line of a run of the pier ``m`` (FlexibleBlock); ``timing`` are the fields of Line from ``dt`` on."""
    return Line(*numbers_of(m), theta, *timing)
