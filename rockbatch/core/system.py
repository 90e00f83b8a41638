"""Hooks by which the driver calls a system: each pier implements them in its own package (``springs``, ``block``).

The first group takes a model ``m`` (Springs, Block), the second the traits that kernels are compiled for, and a lane of a
table. ``contact`` and ``supports`` hold what is constant between events; ``devices`` are None where there are none. Optional
ones do here what a system needs least: nothing decays, all lanes are taken event by event, nothing more is written.
"""

from typing import NamedTuple

import numba
import numpy as np

from rockbatch.core.clock import EVENTFUL
from rockbatch.core.kernel import hook, optional_hook
from rockbatch.core.table import LANES

VECTOR = 1 if numba.config.DISABLE_JIT else 8  # type: ignore[attr-defined]
"""Lanes that the widest vector instructions take at a time; uncompiled there are none, and an empty lane would divide by zero."""

FEW = 2
"""Lanes left over that are sooner taken one by one than with others that are empty."""

assert LANES % VECTOR == 0, "the pass would take lanes beyond the table"


class System(NamedTuple):
    """Piers of one kind, all of whose runs share one compiled driver."""

    traits: tuple  # by whose type hooks of lanes are chosen
    line: type  # named tuple of a run as it is requested
    lane: np.dtype  # of a table
    columns: tuple[str, ...]  # of state and contact in a history


@hook
def rates(m, y, contact, ground):
    """Return the rates of state ``y``: the right-hand side."""


@optional_hook
def share(m, h):
    """Return the share that remains after ``h`` [s] of what decays in closed form."""
    return 1.0


@optional_hook
def stage(m, y, start, contact, remaining):
    """Return a stage ``y`` of a step from ``start``, with the share ``remaining`` of what decays in closed form."""
    return y


@optional_hook
def end_step(m, y, start, contact, remaining):
    """Return the end ``y`` of a step from ``start``, on what constrains it."""
    return y


@hook
def ground_power(m, y, contact, ground):
    """Return the power of the ground's inertia forces on the pier [W/kg]."""


@optional_hook
def shift(m, contact):
    """Return by how far devices are right of their offsets from the middle of the base [m]."""
    return 0.0


@hook
def event_functions(m, devices, now):
    """Return Signals of the Instant ``now``, and their slopes."""


@hook
def transition(m, devices, now, which, ground, dt):
    """Return the Transition by event ``which`` of the Moment ``now``; ``dt`` [s] is the sampling interval."""


@optional_hook
def released(m, now, ground):
    """Return the Moment ``now`` behind an impact of a pier under its devices, in the air if the ground would have to hold it."""
    return now


@optional_hook
def longest_step(m, start, h):
    """Return the length [s], ``h`` at most, of a sub-step from the Instant ``start`` in which event functions show all events."""
    return h


@optional_hook
def airborne(m, contact):
    """Return whether both pivots are in the air."""
    return contact.left == 0.0 and contact.right == 0.0


@hook
def pier_in(traits, lanes, i):
    """Return the model of lane ``i``, and its Moment."""


@hook
def begin(traits, lanes, i, run):
    """Put what only this system has of a ``run`` into lane ``i``, whose clock and ground are set, and set its deadline."""


@optional_hook
def lanes_in_pass(traits, count):
    """Return how many lanes a pass takes: whole vectors of them. Those beyond ``count`` hold what nobody reads."""
    left_over = count % VECTOR
    return count if left_over <= FEW else count - left_over + VECTOR


@optional_hook
def one_pass(traits, lanes, count, substep, settings):
    """Take the first ``count`` lanes through a sub-step, from ``now`` to ``end``.

    One that is calm goes on from the end, its extremes brought up to it. Of others ``step_status`` says whether their sub-step
    stands (STANDS) or has to be taken event by event (EVENTFUL).
    """
    for i in range(count):
        lanes.step_status.kind[i] = EVENTFUL


@optional_hook
def take_in_step(traits, lanes, i, substep, history):
    """Take in what the pass could not, of a sub-step of lane ``i`` that stands, and let the lane go on from its end."""


@hook
def take_in_part(traits, lanes, i, m, part, after):
    """Bring lane ``i`` up to the Moment ``after`` a Part and its event, with all extremes and changes that the system keeps."""


@hook
def status_at_sample(traits, lanes, i, devices):
    """Return how the run in lane ``i`` has ended, RUNNING if it goes on; and the number of the next sample to look at it."""


@optional_hook
def finish(traits, lanes, i, t, result):
    """Write what only this system has of the run in lane ``i`` into its ``result``."""
