"""Hooks by which the driver calls a system: each kind of pier implements them (``springs``, ``block``, ``flexure``,
``footing``).

The first group takes a model ``m`` (Springs, Block), the second the traits that kernels are compiled for, and a lane of a
table. ``contact`` and ``supports`` are constant between events; ``devices`` are None without any. Optional hooks have a default
for systems that do not need them: nothing decays, all lanes are integrated event by event, no further results.
"""

from typing import NamedTuple

import numba
import numpy as np

from rockbatch.core.clock import EVENTFUL
from rockbatch.core.kernel import hook, optional_hook
from rockbatch.core.table import LANES
from rockbatch.core.trigonometry import sine_and_cosine

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
    passed: tuple[float, ...] = ()  # kinds of devices, but on braces, that its pass takes


@hook
def rates(m, y, contact, ground):
    """Return the rates of state ``y``: the right-hand side."""


@optional_hook
def share(m, h):
    """Return the factor that ``h`` [s] leave of variables that decay in closed form; by default 1: none decays."""
    return 1.0


@optional_hook
def stage(m, y, start, contact, remaining):
    """Return the stage ``y`` of a step from ``start``, with decaying variables set to ``remaining`` times their values there.

    By default ``y`` itself.
    """
    return y


@optional_hook
def end_step(m, y, start, contact, remaining):
    """Return the end ``y`` of a step from ``start``, projected onto its constraints, with decaying variables as in :func:`stage`.

    By default ``y`` itself.
    """
    return y


@hook
def ground_power(m, y, contact, ground):
    """Return the power of the ground's inertia forces on the pier [W/kg]."""


@optional_hook
def rates_and_power(m, y, contact, ground, at):
    """Return the rates, and the power of the ground [W/kg], in a pass of a pier with devices that is not in flight.

    ``at`` is its Attitude.
    """
    return rates(m, y, contact, ground), ground_power(m, y, contact, ground)


@optional_hook
def sines_in_pass(m, angle):
    """Return sine and cosine of a rotation [rad] in a pass."""
    return sine_and_cosine(angle)


@optional_hook
def shift(m, contact):
    """Return by how much devices are to the right of their offsets from the middle of the base [m]; by default 0."""
    return 0.0


@hook
def event_functions(m, devices, now):
    """Return the Signals of the Instant ``now``, and their slopes as Signals."""


@hook
def transition(m, devices, now, which, ground, dt):
    """Return the Transition by event ``which`` of the Moment ``now``; ``dt`` [s] is the sampling interval."""


@optional_hook
def released(m, now, ground):
    """Return the Moment ``now`` after an impact; in the air if the ground would have to pull the pier down."""
    return now


@optional_hook
def longest_step(m, start, h):
    """Return a step [s] from the Instant ``start``, at most ``h``, in which event functions show all events."""
    return h


@optional_hook
def airborne(m, contact):
    """Return True if both pivots are in the air."""
    return contact.left == 0.0 and contact.right == 0.0


@hook
def pier_in(traits, lanes, i):
    """Return the model of lane ``i``, and its Moment."""


@hook
def begin(traits, lanes, i, run):
    """Set model, initial state and deadline of a ``run`` in lane ``i``, whose clock and ground are set."""


@optional_hook
def lanes_in_pass(traits, count):
    """Return how many lanes a pass takes: ``count``, made up to whole vectors (VECTOR) by lanes of padding.

    At most FEW lanes beyond the last whole vector are taken one by one, without padding.
    """
    left_over = count % VECTOR
    return count if left_over <= FEW else count - left_over + VECTOR


@optional_hook
def one_pass(traits, lanes, count, substep, settings):
    """Integrate the first ``count`` lanes over a sub-step, from ``now`` to ``end``, and set their ``step_status``.

    A CALM lane is advanced, with its extremes. Otherwise the sub-step stands (STANDS), or has to be repeated event by event
    (EVENTFUL), by default in all lanes.
    """
    for i in range(count):
        lanes.step_status.kind[i] = EVENTFUL


@optional_hook
def pass_with_devices(traits, lanes, equipment, count, substep, settings):
    """Integrate the first ``count`` lanes as :func:`one_pass`, with their devices; by default all are EVENTFUL."""
    for i in range(count):
        lanes.step_status.kind[i] = EVENTFUL


@optional_hook
def note_devices(traits, lanes, i, devices):
    """Record in lane ``i`` what a pass needs to know of its ``devices``; return True if the pier is at rest on rigid ground.

    By default nothing is recorded, and False returned.
    """
    return False


@optional_hook
def gives_way(traits):
    """Return True if the ground gives way under a pivot: friction there that holds without a force may need one later."""
    return False


@optional_hook
def in_pass(traits, lanes, i):
    """Return the model of lane ``i``, its state, and its contact as far as a pass handles it; by default all of it.

    Lanes with other contacts are left to scalar code.
    """
    m, now = pier_in(traits, lanes, i)
    return m, now.y, now.contact


@optional_hook
def take_in_step(traits, lanes, i, substep, history):
    """Advance lane ``i`` to the end of a sub-step that stands, with extremes and reversals that the pass left out."""


@hook
def take_in_part(traits, lanes, i, m, part, after):
    """Advance lane ``i`` to the Moment ``after`` a Part and its event, with all extremes that the system keeps."""


@hook
def status_at_sample(traits, lanes, i, devices):
    """Return the status of the run in lane ``i``, RUNNING unless it ends, and the next sample at which to check it."""


@optional_hook
def finish(traits, lanes, i, t, result):
    """Write the system's own results of lane ``i`` into ``result``."""
