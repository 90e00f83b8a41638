"""Questions that the driver asks of a system: each pier answers these questions in its own package (``springs``, ``block``).

The first group is asked of a model ``m`` (Springs, Block), the second of the traits that kernels are compiled for, about a lane
of a table. ``contact`` and ``supports`` hold what is constant between events; ``horizontal`` and ``vertical`` are ground
accelerations [m/s²]; ``rest`` is the velocity that counts as none [m/s]; ``devices`` are None where there are none.
"""

from typing import NamedTuple

import numpy as np

from rockbatch.core.kernel import question


class Kind(NamedTuple):
    """A kind of pier, all of whose runs share one compiled driver."""

    traits: tuple  # by whose type questions about lanes are answered
    line: type  # named tuple of a run as it is asked for
    lane: np.dtype  # of a table
    columns: tuple[str, ...]  # of state and contact in a history


@question
def rates(m, y, contact, horizontal, vertical):
    """Return the rates of state ``y``: the right-hand side."""


@question
def accelerations(m, y, contact, horizontal, vertical):
    """Return v̈ [m/s²] and θ̈ [rad/s²] of state ``y``."""


@question
def pulled(m, force, moment):
    """Return the pier under a force [m/s²] and a moment [m²/s²] of devices."""


@question
def share(m, h):
    """Return the share that is left after ``h`` [s] of what decays in closed form."""


@question
def staged(m, y, start, contact, left):
    """Return a stage ``y`` of a step from ``start``, with the share ``left`` of what decays in closed form."""


@question
def ended(m, y, start, contact, left):
    """Return the end ``y`` of a step from ``start``, on what constrains it."""


@question
def lever(m, y, contact):
    """Return H [m], by which the ground's horizontal acceleration turns the pier."""


@question
def at_rest(m):
    """Return the velocity [m/s] below which a pivot counts as having none: rounding."""


@question
def event_functions(m, devices, y, k, contact, supports, rest, ground):
    """Return Signals of state ``y`` with rates ``k``, and their slopes."""


@question
def transition(m, devices, y, contact, supports, which, rest, ground, dt):
    """Return state, contact and supports after event ``which``, its kind in a history, and the time [s] that is left to rest.

    The last is 0 but where an infinite sequence of ever lower bounces ends in rest: they are summed up.
    """


@question
def longest(m, y, k, contact, h):
    """Return the length [s], ``h`` at most, of a sub-step in which event functions show what happens."""


@question
def airborne(m, contact):
    """Return whether both pivots are in the air."""


@question
def uplifts(m, before, after, landed):
    """Return how many uplifts an event with ``landed`` landings makes of the contacts ``before`` and ``after`` it."""


@question
def clearances(m, y, supports):
    """Return the height [m] of both pivots above where they would land, and the rates [m/s]: left, right, left, right."""


@question
def model(traits, lanes, i):
    """Return the model of lane ``i``."""


@question
def moment(traits, lanes, i):
    """Return state, contact and supports of lane ``i``."""


@question
def put_moment(traits, lanes, i, y, contact, supports):
    """Write state, contact and supports of lane ``i``."""


@question
def begin(traits, lanes, i, run):
    """Put what only this system has of a ``run`` into lane ``i``, as it begins."""


@question
def one_pass(traits, lanes, count, substep, settings):
    """Take the first ``count`` lanes through a sub-step, from ``now`` to ``end``.

    One that is calm goes on from the end, its extremes brought up to it. Of others ``step_status`` says whether their sub-step
    stands (ATTEND) or has to be taken event by event (EVENTFUL).
    """


@question
def attend(traits, lanes, i, substep, history):
    """Take in what the pass could not, of a sub-step of lane ``i`` that stands, and let the lane go on from its end."""


@question
def include(traits, lanes, i, m, y, k, end, k_end, contact, h):
    """Bring the system's own extremes up to a smooth part of a sub-step of lane ``i``."""


@question
def after_event(traits, lanes, i, m, before, after, y):
    """Keep what the system keeps of an event that changed the contacts of lane ``i``."""


@question
def after_step(traits, lanes, i, marks, contact, whole):
    """Note how a sub-step of lane ``i`` ended that was taken event by event: ``whole``, its last part without an event."""


@question
def peak_stands(traits, lanes, i):
    """Return whether it has been decided that nothing can exceed the peak of lane ``i``, and nothing has."""


@question
def expect(traits, lanes, i, run):
    """Set what lane ``i`` waits for after its record."""


@question
def over(traits, lanes, i, devices):
    """Return how the run in lane ``i`` ended if it is over at this sample, RUNNING if it goes on."""


@question
def next_due(traits, lanes, i):
    """Return the number of the next sample at which :func:`over` has to be asked."""


@question
def finish(traits, lanes, i, t, result):
    """Write what only this system has of the run in lane ``i`` into its ``result``."""
