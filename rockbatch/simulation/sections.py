"""Shear, axial force and moment in sections of a rigid shaft, from its recorded motion (THEORY.md, Forces in sections)."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from rockbatch.core.kernel import entry
from rockbatch.core.observe.peaks import RecordedRun
from rockbatch.core.observe.rows import contact_of, ground_at, ground_within, state_of, step_between, within
from rockbatch.core.system import rates
from rockbatch.core.table import record, with_pull
from rockbatch.core.types import LIFT_OFF, TAKE_OFF, Pull
from rockbatch.motions.motion import Samples
from rockbatch.pier import Pier
from rockbatch.pier.sections import above
from rockbatch.simulation.changes import Sized, greatest_change
from rockbatch.simulation.models import ground_of, model
from rockbatch.simulation.outcome import Section
from rockbatch.simulation.restraints import apart, deck_pulls
from rockbatch.simulation.runs import Run


class Motion(NamedTuple):
    """The motion of a pier at one moment."""

    theta: float  # [rad]
    omega: float  # [rad/s]
    v_acceleration: float  # over the ground, upwards [m/s²]
    turning: float  # [rad/s²]
    side: float  # pivot about which the centre of mass moves horizontally: of springs the only one in contact
    horizontal: float  # acceleration of the ground [m/s²]
    vertical: float


MOTION = record(Motion)


class InSections(NamedTuple):
    """Forces of the part below each section on that above, shape (sections, moments) each: see :class:`Section`."""

    shear: Samples
    moment: Samples
    axial: Samples


@entry
def _follow(m, run, numbers, shares, out):  # type: ignore[no-untyped-def]
    """Write the Motion at each share of the step to the row of this number; at share 1 that of the row itself."""
    rows, pulls, _, ground, dt = run
    for j in range(len(numbers)):
        i, s = numbers[j], shares[j]
        pull, line = Pull(pulls[i, 0], pulls[i, 1]), out[j]
        under = with_pull(m, pull)
        t = rows[i].t
        y, contact = state_of(m, rows[i]), contact_of(m, rows[i])
        shaking = ground_at(ground, dt, 0.5 * (rows[max(i - 1, 0)].t + t), t)
        if s < 1.0:
            before = Pull(pulls[i - 1, 0], pulls[i - 1, 1])
            step = step_between(with_pull(m, before), under, rows[i - 1], rows[i], ground, dt)
            y, shaking = within(m, step, s), ground_within(step, s)
            force, moment = pull.force - before.force, pull.moment - before.moment
            under = with_pull(m, Pull(before.force + s * force, before.moment + s * moment))
        k = rates(under, y, contact, shaking)
        line.theta, line.omega, line.v_acceleration, line.turning = y.theta, y.omega, k.v_rate, k.omega
        line.side, line.horizontal, line.vertical = contact.right - contact.left, shaking.horizontal, shaking.vertical


def _motion(run: Run, rows: np.recarray, numbers: np.ndarray, shares: Samples) -> np.recarray:
    """Return the Motion of a recorded run at these places; see :func:`_follow`."""
    plain, pulls = apart(run.base, rows)
    recorded = RecordedRun(plain, pulls, None, ground_of(run.motion), float(run.motion.dt))
    motion = np.recarray(len(numbers), MOTION)
    _follow(model(run.pier, run.base), recorded, numbers, shares, motion)
    if not run.base.on_springs:  # in flight its shear key holds the pivot that bore last
        motion.side = np.where(motion.side != 0.0, motion.side, rows.bore[numbers])
    return motion


def in_sections(
    run: Run, rows: np.recarray, heights: Sequence[float], numbers: np.ndarray, shares: Samples
) -> InSections:
    """Return the forces in sections at ``heights`` [m], at each of ``shares`` of the step to the row of this number.

    Forces of devices on the deck are linear within a step.
    """
    pier, motion = run.pier, _motion(run, rows, numbers, shares)
    sine, cosine, squared = np.sin(motion.theta), np.cos(motion.theta), motion.omega**2
    b, h = motion.side * pier.half_width, pier.height
    across = (h * cosine + b * sine) * motion.turning + (b * cosine - h * sine) * squared
    if run.base.kinematics == "first-order":
        sine, cosine, across = motion.theta, np.ones(len(numbers)), h * motion.turning
    horizontal, vertical = motion.horizontal + across, pier.gravity + motion.vertical + motion.v_acceleration
    shear, axial = horizontal * cosine - vertical * sine, vertical * cosine + horizontal * sine
    result = InSections(*np.empty((3, len(heights), len(numbers))))
    on_deck = [
        (height, pull[numbers - 1] + shares * (pull[numbers] - pull[numbers - 1]))
        for height, pull in deck_pulls(pier, run.base, rows)
    ]
    for i, height in enumerate(heights):
        part = above(pier, height)
        centre = height + part.rise - h  # from the centre of mass of the pier
        result.shear[i] = part.share * (shear + centre * motion.turning)
        result.axial[i] = part.share * (axial - centre * squared)
        result.moment[i] = -part.rise * result.shear[i] - part.inertia * motion.turning
        for place, pull in on_deck:
            if place >= height:
                result.shear[i] += pull * cosine
                result.axial[i] += pull * sine
                result.moment[i] -= (place - height) * pull * cosine
    return result


def sections_of(run: Run, rows: np.recarray, heights: Sequence[float]) -> list[Section]:
    """Return the greatest forces in sections at ``heights`` [m] of a run recorded at every step.

    As other forces they count until the pier leans beyond α for good, at the ends of each step, in its middle, and where a
    parabola through these promises more (THEORY.md, Forces).
    """
    standing = np.flatnonzero(np.abs(rows.theta) <= run.pier.alpha)
    rows = rows[: standing[-1] + 1].view(np.recarray)
    ends = np.arange(len(rows))
    steps = ends[1:][(rows.t[1:] > rows.t[:-1]) & (rows.kind[1:] <= 0.0)]
    at_ends, between = in_sections(run, rows, heights, ends, np.ones(len(ends))), None
    _let_go(rows, at_ends)
    numbers, shares = steps, np.full(len(steps), 0.5)
    if len(steps):
        between = in_sections(run, rows, heights, numbers, shares)
        numbers, shares = _promising(at_ends, between, steps)
    whole = [at_ends] if between is None else [at_ends, between, in_sections(run, rows, heights, numbers, shares)]
    shear, moment, axial = (np.concatenate(values, axis=1) for values in zip(*whole, strict=True))
    bent = np.abs(moment).argmax(axis=1)
    columns = (
        heights, np.abs(shear).max(axis=1), np.abs(moment).max(axis=1), axial.min(axis=1), axial.max(axis=1),
        axial[np.arange(len(heights)), bent],
    )  # fmt: skip
    return [Section(*map(float, values)) for values in zip(*columns, strict=True)]


def _let_go(rows: np.recarray, forces: InSections) -> None:
    """Give all rows of the instant at which a block leaves its rest the forces after it.

    They differ where a motion begins with a jump, which the ground cannot hold the block against.
    """
    for row in np.flatnonzero((rows.kind == LIFT_OFF) | (rows.kind == TAKE_OFF)):
        first = int(np.searchsorted(rows.t, rows.t[row]))
        for values in forces:
            values[:, first:row] = values[:, row : row + 1]


def _promising(ends: InSections, middles: InSections, steps: np.ndarray) -> tuple[np.ndarray, Samples]:
    """Return the steps, and the share of each, at which a parabola through its ends and middle promises a new extreme."""
    places: set[tuple[int, float]] = set()
    for at_ends, middle in zip(ends, middles, strict=True):
        for values, half in zip(at_ends, middle, strict=True):
            slope, bend = values[steps] - values[steps - 1], values[steps - 1] + values[steps] - 2.0 * half
            turns = np.abs(slope) < 2.0 * np.abs(bend)
            share = 0.5 - slope[turns] / (4.0 * bend[turns])
            promised = half[turns] - slope[turns] ** 2 / (8.0 * bend[turns])
            least, most = min(values.min(), half.min()), max(values.max(), half.max())
            for chosen in (promised < least, promised > most):
                numbers = np.flatnonzero(chosen)
                best = numbers[np.argsort(-np.abs(promised[numbers]), kind="stable")[:MOST_TURNS]]
                places.update(zip(steps[turns][best].tolist(), share[best].tolist(), strict=True))
    ordered = sorted(places)
    return np.array([i for i, _ in ordered], np.intp), np.array([s for _, s in ordered])


MOST_TURNS = 20
"""Greatest number of promised extremes of a force in a section that are looked at."""

_SIZED = {
    "shear": Sized(("shear",), "force"),
    "moment": Sized(("moment",), "moment"),
    "axial force": Sized(("axial_least", "axial_greatest"), "force"),
}


def with_errors(fine: Sequence[Section], coarse: Sequence[Section], pier: Pier) -> list[Section]:
    """Return ``fine`` with errors, from the forces with twice the step."""
    pairs = zip(fine, coarse, strict=True)
    return [section._replace(error=greatest_change(_SIZED, section, other, pier)[1]) for section, other in pairs]
