"""Shear, axial force and moment in sections of the shaft, from its recorded motion (THEORY.md, Forces in sections)."""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from rockbatch.core.flexure.modes import MOST_MODES
from rockbatch.core.kernel import entry
from rockbatch.core.observe.peaks import Place, RecordedRun, push_deck, push_deck_within, under_devices_within
from rockbatch.core.observe.rows import (
    begin_at,
    contact_of,
    ground_at,
    ground_within,
    remember,
    state_of,
    step_between,
    within,
    write_bending,
)
from rockbatch.core.system import rates
from rockbatch.core.table import record, with_pull
from rockbatch.core.types import LIFT_OFF, TAKE_OFF, Pull
from rockbatch.motions.motion import Samples
from rockbatch.outcome.changes import LEAST, Sized, greatest_change
from rockbatch.outcome.outcome import Section
from rockbatch.pier import Modes, Pier, bent_above
from rockbatch.pier.sections import above
from rockbatch.simulation.elements import elements
from rockbatch.simulation.models import ground_of, model
from rockbatch.simulation.recording import upright
from rockbatch.simulation.restraints import apart
from rockbatch.simulation.restraints import recorded as recorded_devices
from rockbatch.simulation.runs import Run


class Motion(NamedTuple):
    """The motion of a pier at an instant."""

    theta: float  # [rad]
    omega: float  # [rad/s]
    v_acceleration: float  # over the ground, upwards [m/s²]
    turning: float  # [rad/s²]
    side: float  # −1 or 1 for the only pivot in contact, left or right; 0 for both or none
    horizontal: float  # acceleration of the ground [m/s²]
    vertical: float


MOTION = record(Motion)

Places = npt.NDArray[np.intp]
"""Indices of rows in a history."""


class Recorded(NamedTuple):
    """A run recorded at every step, as section forces need it."""

    run: Run
    rows: np.recarray  # of its history, shape (n,)
    plain: RecordedRun
    heights: Samples  # of devices on the deck [m]; 0 of those at the base


class Bending(NamedTuple):
    """Modes of an elastic shaft and their coordinates at k instants, rates and accelerations, shape (n, k) each."""

    modes: Modes
    u: Samples  # [m]
    u_rate: Samples
    u_acceleration: Samples


class InBody(NamedTuple):
    """Accelerations of a pier at k instants, in the axes of its body, shape (k,) each."""

    across: Samples  # of its centre of mass with gravity, across the axis, to the right [m/s²]
    along: Samples  # and along it, upwards
    turning: Samples  # [rad/s²]
    speed: Samples  # θ̇ [rad/s]
    squared: Samples  # θ̇² [rad²/s²]
    sine: Samples
    cosine: Samples
    on_deck: list[tuple[float, Samples]]  # height [m] of each device there, and its push to the left [m/s²]
    bending: Bending | None  # of an elastic shaft


class InSection(NamedTuple):
    """Forces of the lower part on the upper part at a section, shape (k,) each: see :class:`Section`."""

    shear: Samples
    moment: Samples
    axial: Samples


@entry
def _follow(m, run, numbers, shares, out, pushes, bending):  # type: ignore[no-untyped-def]
    """Write to ``out`` the Motion at each of ``shares`` of the steps that end at the rows ``numbers``.

    Likewise to ``pushes`` those on the deck, shape (moments, devices), and to ``bending`` that of an elastic shaft, shape
    (moments, 3, modes). At share 1 they are those of the row itself.
    """
    rows, pulls, devices, ground, dt = run
    walked = 0
    begin_at(m, state_of(m, rows[0]))
    for j in range(len(numbers)):
        i, s = numbers[j], shares[j]
        if i - 1 < walked:
            begin_at(m, state_of(m, rows[0]))
            walked = 0
        while walked < i - 1:
            length = rows[walked + 1].t - rows[walked].t
            remember(m, state_of(m, rows[walked]), state_of(m, rows[walked + 1]), length)
            walked += 1
        pull, line = Pull(pulls[i, 0], pulls[i, 1]), out[j]
        under = with_pull(m, pull)
        t = rows[i].t
        y, contact = state_of(m, rows[i]), contact_of(m, rows[i])
        shaking = ground_at(ground, dt, 0.5 * (rows[max(i - 1, 0)].t + t), t)
        if s < 1.0:
            before = Pull(pulls[i - 1, 0], pulls[i - 1, 1])
            step = step_between(with_pull(m, before), under, rows[i - 1], rows[i], ground, dt)
            y, shaking = within(m, step, s), ground_within(step, s)
            place = Place(i, step, s)
            under = under_devices_within(devices, m, pulls, place, y)
            push_deck_within(devices, m, place, y, pushes[j])
        else:
            push_deck(devices, m, i, y, contact, pushes[j])
        k = rates(under, y, contact, shaking)
        line.theta, line.omega, line.v_acceleration, line.turning = y.theta, y.omega, k.v_rate, k.omega
        write_bending(y, k, bending[j])
        line.side, line.horizontal, line.vertical = contact.right - contact.left, shaking.horizontal, shaking.vertical


def recorded(run: Run, rows: np.recarray) -> Recorded:
    """Return a run with its history at every step, ``rows``, prepared for section forces."""
    plain, pulls = apart(run.base, rows)
    devices = recorded_devices(run.pier, run.base, rows) if run.base.restraints else None
    whole = RecordedRun(plain, pulls, devices, ground_of(run.motion), float(run.motion.dt))
    return Recorded(run, rows, whole, np.array([law.height for law in elements(run.pier, run.base)]))


def in_body(of: Recorded, numbers: Places, shares: Samples) -> InBody:
    """Return the accelerations within each step before the rows ``numbers``, at the ``shares`` of it: 1 is at the row itself.

    Within a step devices pull by their laws.
    """
    pier, base = of.run.pier, of.run.base
    motion, pushes = np.recarray(len(numbers), MOTION), np.zeros((len(numbers), len(of.heights)))
    bending = np.zeros((len(numbers), 3, MOST_MODES))
    _follow(model(pier, base), of.plain, numbers, shares, motion, pushes, bending)
    # In flight the shear key of a block holds the pivot that was last in contact
    side = (
        motion.side * base.two_springs
        if base.on_springs
        else np.where(motion.side != 0.0, motion.side, of.rows.bore[numbers])
    )
    sine, cosine, squared = np.sin(motion.theta), np.cos(motion.theta), motion.omega**2
    b, h = side * pier.half_width, pier.height
    sideways = (h * cosine + b * sine) * motion.turning + (b * cosine - h * sine) * squared
    if base.kinematics == "first-order":
        sine, cosine, sideways = motion.theta, np.ones(len(numbers)), h * motion.turning
    horizontal, vertical = motion.horizontal + sideways, pier.gravity + motion.vertical + motion.v_acceleration
    across, along = horizontal * cosine - vertical * sine, vertical * cosine + horizontal * sine
    on_deck = [(float(height), push) for height, push in zip(of.heights, pushes.T, strict=True) if height != 0.0]
    body = InBody(across, along, motion.turning, motion.omega, squared, sine, cosine, on_deck, None)
    if not base.bends:
        return body
    modes = base.modes(pier)
    body = body._replace(bending=Bending(modes, *np.moveaxis(bending, 0, 2)[:, : len(modes.frequency)]))
    at_once = (h * cosine + b * sine) * motion.turning * cosine - motion.v_acceleration * sine
    return _by_modes_alone(pier, body, at_once) if base.on_springs else body


def _by_modes_alone(pier: Pier, body: InBody, across: Samples) -> InBody:
    """Return ``body`` without its base's acceleration ``across`` the axis and in rotation, which its modes take over as they can.

    The modes that are left out would give way to what a dashpot does in an instant, where a stiff shaft would follow.
    """
    assert body.bending is not None
    modes = body.bending.modes
    lever = modes.coupling - pier.height * modes.share
    followed = body.bending.u_acceleration + np.outer(modes.share, across) + np.outer(lever, body.turning)
    bending = body.bending._replace(u_acceleration=followed)
    return body._replace(across=body.across - across, turning=np.zeros_like(across), bending=bending)


def in_section(pier: Pier, body: InBody, height: float) -> InSection:
    """Return the forces in the section at ``height`` [m] (THEORY.md, Forces in sections)."""
    part = above(pier, height)
    centre = height + part.rise - pier.height  # from the centre of mass of the pier
    shear = part.share * (body.across + centre * body.turning)
    axial = part.share * (body.along - centre * body.squared)
    moment = -part.rise * shear - part.inertia * body.turning
    if body.bending is not None:
        shear, moment, axial = _bent(pier, body, body.bending, height, InSection(shear, moment, axial))
    for place, push in body.on_deck:
        if place >= height:
            shear, axial = shear + push * body.cosine, axial + push * body.sine
            moment = moment - (place - height) * push * body.cosine
    return InSection(shear, moment, axial)


def _bent(pier: Pier, body: InBody, bending: Bending, height: float, straight: InSection) -> InSection:
    """Return the forces in a section of a shaft that bends; ``straight`` are those by the motion of its base.

    A mass at the height z with the deflection w = Σ φ_i u_i has ẅ − w θ̇² across and −2 ẇ θ̇ − w θ̈ along the axis besides, and what
    it pulls along the axis turns about the section, which is deflected itself.
    """
    of = bent_above(pier, bending.modes, height)
    across = bending.u_acceleration - bending.u * body.squared
    along = 2.0 * bending.u_rate * body.speed + bending.u * body.turning
    at_base = body.along + pier.height * body.squared
    shear, axial = straight.shear + of.share @ across, straight.axial - of.share @ along
    pulled = np.outer(of.offset, at_base) - np.outer(of.turning, body.squared) - of.both @ along
    moment = straight.moment - of.lever @ across + (bending.u * pulled).sum(axis=0)
    return InSection(shear, moment, axial)


def forces_in_sections(run: Run, rows: np.recarray, heights: Sequence[float]) -> Iterator[InSection]:
    """Yield the forces in sections at ``heights`` [m] of a run recorded at every step, at all instants that are evaluated.

    They are taken until the pier leans beyond α for good, at the ends and the middle of each step, and at the vertex of a
    parabola through these if it may exceed them (THEORY.md, Forces).
    """
    rows = upright(rows, run.pier.alpha)
    of, ends = recorded(run, rows), np.arange(len(rows))
    steps = ends[1:][(rows.t[1:] > rows.t[:-1]) & (rows.kind[1:] <= 0.0)]
    at_ends = in_body(of, ends, np.ones(len(ends)))
    middles = in_body(of, steps, np.full(len(steps), 0.5))
    for height in heights:
        yield _at_instants(of, at_ends, middles, steps, height)


def sections_of(run: Run, rows: np.recarray, heights: Sequence[float]) -> list[Section]:
    """Return the greatest forces in sections at ``heights`` [m] of a run recorded at every step.

    They are the greatest |V| and |M|, the least and the greatest N, and N at the greatest |M|.
    """
    sections = []
    for height, (shear, moment, axial) in zip(heights, forces_in_sections(run, rows, heights), strict=True):
        bent = int(np.abs(moment).argmax())
        forces = np.abs(shear).max(), np.abs(moment).max(), axial.min(), axial.max(), axial[bent]
        sections.append(Section(height, *map(float, forces)))
    return sections


def _at_instants(of: Recorded, at_ends: InBody, middles: InBody, steps: Places, height: float) -> InSection:
    """Return the forces in the section at ``height`` [m]; ``middles`` are accelerations amid the ``steps``."""
    pier = of.run.pier
    ends, halves = in_section(pier, at_ends, height), in_section(pier, middles, height)
    _let_go(of.rows, ends)
    turns = in_section(pier, in_body(of, *_promising(ends, halves, steps)), height)
    return InSection(*map(np.concatenate, zip(ends, halves, turns, strict=True)))


def _let_go(rows: np.recarray, forces: InSection) -> None:
    """Set the forces in all rows of each instant at which a block lifts off, or takes off, to those after it.

    They differ if a motion begins with a jump, against which the ground cannot hold the block.
    """
    for row in np.flatnonzero((rows.kind == LIFT_OFF) | (rows.kind == TAKE_OFF)):
        first = int(np.searchsorted(rows.t, rows.t[row]))
        for values in forces:
            values[first:row] = values[row]


def _promising(ends: InSection, middles: InSection, steps: Places) -> tuple[Places, Samples]:
    """Return steps and shares of them at which a parabola through ends and middle exceeds the extremes of any force.

    Of each extreme the :data:`MOST_TURNS` highest are taken.
    """
    places: set[tuple[int, float]] = set()
    for values, half in zip(ends, middles, strict=True):
        slope, bend = values[steps] - values[steps - 1], values[steps - 1] + values[steps] - 2.0 * half
        turns = np.flatnonzero(np.abs(slope) < 2.0 * np.abs(bend))
        slope, bend, half = slope[turns], bend[turns], half[turns]
        share, promised = 0.5 - slope / (4.0 * bend), half - slope**2 / (8.0 * bend)
        for beyond in (values.min() - promised, promised - values.max()):
            more = np.flatnonzero(beyond > 0.0)
            best = more[np.argsort(-beyond[more], kind="stable")[:MOST_TURNS]]
            places.update(zip(steps[turns][best].tolist(), share[best].tolist(), strict=True))
    ordered = sorted(places)
    return np.array([i for i, _ in ordered], np.intp), np.array([s for _, s in ordered])


MOST_TURNS = 20
"""Greatest number of such vertices that are evaluated for each extreme of a force."""

_SIZED = {
    "shear": Sized(("shear",), "force"),
    "moment": Sized(("moment",), "moment"),
    "least axial force": Sized(("axial_least",), "force"),
    "greatest axial force": Sized(("axial_greatest",), "force"),
}


def with_errors(fine: Sequence[Section], coarse: Sequence[Section], pier: Pier, chance: float) -> list[Section]:
    """Return ``fine`` with ``chance`` times the greatest relative change from ``coarse``, LEAST at least, added to its errors."""
    pairs = zip(fine, coarse, strict=True)
    changes = [max(greatest_change(_SIZED, section, other, pier)[1], LEAST) for section, other in pairs]
    return [
        section._replace(error=(section.error or 0.0) + chance * change)
        for section, change in zip(fine, changes, strict=True)
    ]
