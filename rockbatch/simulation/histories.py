"""Histories of runs: the rows that the core wrote, with names, units and derived quantities."""

import contextlib
import math
from collections.abc import Iterator, Sequence

import numpy as np

from rockbatch.common.errors import InputError
from rockbatch.common.lazy import pd
from rockbatch.common.notes import CHAOTIC
from rockbatch.core import types
from rockbatch.core.flexure.model import FlexibleBlock
from rockbatch.core.observe.beds import BED_STATE, follow_bed
from rockbatch.core.observe.ledger import LEDGER, ledger_on_rigid_base, ledger_on_springs
from rockbatch.motions.motion import Samples
from rockbatch.pier import Base, ElasticBase, FootingBase, Pier, RigidBase, YieldingBase
from rockbatch.simulation import restraints
from rockbatch.simulation.compilation import kernel_of
from rockbatch.simulation.device_work import with_work
from rockbatch.simulation.error_control import CHANCE
from rockbatch.simulation.forces import LANDINGS, at_rows, forces_table, impacts_table, peak_forces, with_error
from rockbatch.simulation.half_cycles import HalfCycles, Path, half_cycles
from rockbatch.simulation.leaning import Apart, apart, may_lean, with_error_of_rocking, with_rocking
from rockbatch.simulation.models import acceleration_at, block, flexible_block, ground_of, model, springs
from rockbatch.simulation.outcome import TERMS, Outcome, Section
from rockbatch.simulation.response import EVENT_TYPES, Response
from rockbatch.simulation.runs import Run, Stop, written_run, written_runs
from rockbatch.simulation.sections import sections_of, with_errors

_EVENTS = {
    types.SEPARATION_LEFT: ("separation", "left"),
    types.SEPARATION_RIGHT: ("separation", "right"),
    types.IMPACT_LEFT: ("impact", "left"),
    types.IMPACT_RIGHT: ("impact", "right"),
    types.IMPACT_BOTH: ("impact", "both"),
    types.SPRING_LEFT: ("spring", "left"),
    types.SPRING_RIGHT: ("spring", "right"),
    types.HELD_LEFT: ("contact", "left"),
    types.HELD_RIGHT: ("contact", "right"),
    types.LIFT_OFF: ("lift-off", ""),
    types.REST: ("rest", ""),
    types.TAKE_OFF: ("take-off", ""),
    types.DECK: ("deck impact", ""),
}


MOST_ROWS = 10_000_000
"""Greatest number of rows of a history held in memory, about a gigabyte."""

ROWS_TOGETHER = 150_000
"""Greatest number of rows of histories that are written side by side, some 16 megabytes."""

SPARE = 1.1
"""Rows for which there is room, over the steps of a run: velocity reversals of springs have rows of their own."""


def written(run: Run, outcome: Outcome, quiet_s: float, every_step: bool, wait: bool = True) -> np.recarray:
    """Return the history of a run whose outcome is known: a record for each moment (``core.history``).

    Raises ``InputError`` for more than :data:`MOST_ROWS`.
    """
    capacity = min(_room(run, outcome, every_step), MOST_ROWS)
    result, rows = written_run(run, outcome.substeps, quiet_s, capacity, every_step=every_step, wait=wait)
    if result.rows > MOST_ROWS:
        instead = "leave out the energy ledger or use fewer substeps" if every_step else "cut the record"
        raise InputError(f"{run.motion.name}: a history of {result.rows} rows, more than {MOST_ROWS}; {instead}")
    if result.rows > capacity:
        result, rows = written_run(run, outcome.substeps, quiet_s, result.rows, every_step=every_step, wait=wait)
    return rows[: result.rows].view(np.recarray)


def _room(run: Run, outcome: Outcome, every_step: bool, until: float = math.inf) -> int:
    """Return for how many rows there should be room in a run that ends by ``until`` [s]."""
    steps = min(outcome.t_end, until) / run.motion.dt * (outcome.substeps if every_step else 1)
    return int(SPARE * steps) + 64 * (outcome.impacts + outcome.separations + 64)


def written_side_by_side(
    runs: Sequence[Run], outcomes: Sequence[Outcome], quiet_s: float, wait: bool = True, stop: Stop | None = None
) -> Iterator[tuple[int, np.recarray]]:
    """Yield the number and the history, at samples and events, of each run that is not too long to be held in memory."""
    ends = [math.inf if wait else run.motion.duration + quiet_s for run in runs]
    room = [_room(run, o, False, end) for run, o, end in zip(runs, outcomes, ends, strict=True)]
    alike: dict[object, list[int]] = {}
    for i in sorted(range(len(runs)), key=room.__getitem__):
        steps = outcomes[i].substeps
        alike.setdefault(i if runs[i].base.restraints else (kernel_of(runs[i].pier, runs[i].base), steps), []).append(i)
    for members in alike.values():
        first = 0
        for n, i in enumerate(members, 1):
            if n == len(members) or (n + 1 - first) * room[members[n]] > ROWS_TOGETHER:
                if stop is not None and stop.is_set:
                    return
                yield from _written_together(runs, outcomes, members[first:n], quiet_s, room[i], wait)
                first = n


def _written_together(
    runs: Sequence[Run], outcomes: Sequence[Outcome], numbers: Sequence[int], quiet_s: float, room: int, wait: bool
) -> Iterator[tuple[int, np.recarray]]:
    """Yield the histories of the runs with these ``numbers``, of one kind and step, for which there should be ``room``."""
    if len(numbers) == 1:
        with contextlib.suppress(InputError):
            yield numbers[0], written(runs[numbers[0]], outcomes[numbers[0]], quiet_s, False, wait)
        return
    found = written_runs([runs[i] for i in numbers], outcomes[numbers[0]].substeps, quiet_s, room, wait=wait)
    for i, (result, rows) in zip(numbers, found, strict=True):
        if result.rows > room:
            with contextlib.suppress(InputError):
                yield i, written(runs[i], outcomes[i], quiet_s, False, wait)
        else:
            yield i, rows[: result.rows].view(np.recarray)


def cycles_of(base: Base, rows: np.recarray) -> HalfCycles:
    """Return the half cycles of a run on ``base`` from its history."""
    landed = None if base.on_springs else np.flatnonzero(np.isin(rows.kind, LANDINGS))
    return half_cycles(Path(rows.t, rows.theta, rows.omega), landed)


def energies(run: Run, rows: np.recarray) -> Samples:
    """Return the energy balance [J/kg] at every row of a run: :data:`rockbatch.simulation.outcome.TERMS`, shape (n, 10)."""
    pier, base = run.pier, run.base
    ground, dt = ground_of(run.motion), float(run.motion.dt)
    terms = np.zeros((len(rows), len(TERMS)))
    balance = terms.view(LEDGER)[:, 0].view(np.recarray)  # the same memory, by names
    plain, pulls = restraints.apart(base, rows)
    if isinstance(base, FootingBase):
        follow_bed(model(pier, base), plain, pulls, ground, dt, balance, np.recarray(len(rows), BED_STATE))
    elif base.on_springs:
        ledger_on_springs(springs(pier, base), plain, pulls, ground, dt, balance)
    else:
        ledger_on_rigid_base(model(pier, base), plain, pulls, ground, dt, balance)
    return restraints.with_devices(pier, base, rows, terms) if base.restraints else terms


def rocking_from_lean(
    runs: Sequence[Run],
    outcomes: Sequence[Outcome],
    quiet_s: float,
    requested: bool = False,
    wait: bool = True,
    stop: Stop | None = None,
) -> list[Outcome]:
    """Return ``outcomes`` with rocking and lean apart, if ``requested`` or where the peak may be lean; on yielding springs by one
    more run, and if ``requested`` and the step was chosen by a tolerance by one of twice the step, which gives their error.

    After the record nothing shakes the pier, and it swings no further about its rest: a run to the end of its quiet time, a
    quarter of the whole, tells most peaks from lean. Runs that are too long to be written down stay as they are, and all that
    come after ``stop``.
    """
    found, mixed = list(outcomes), list[int]()
    for i, (run, outcome) in enumerate(zip(runs, outcomes, strict=True)):
        if not outcome.was_run or not (requested or may_lean(outcome)):
            continue
        if isinstance(run.base, YieldingBase) and outcome.status != "overturned":
            mixed.append(i)
        elif requested:
            found[i] = outcome.changed(theta_rocking=outcome.theta_max, theta_rocking_error=outcome.theta_max_error)
    if not requested:
        early = [i for i in mixed if found[i].t_max <= runs[i].motion.duration + quiet_s]
        of_record = _apart(runs, found, early, quiet_s, False, stop)
        mixed = [i for i in mixed if i not in early or (i in of_record and of_record[i].leans)]
    for i, parts in (fine := _apart(runs, found, mixed, quiet_s, wait, stop)).items():
        found[i] = with_rocking(found[i], parts, runs[i].pier.alpha)
    if requested:
        estimated = [i for i in fine if found[i].theta_max_error is not None and found[i].substeps % 2 == 0]
        halved = [outcome.changed(substeps=outcome.substeps // 2) for outcome in found]
        for i, parts in _apart(runs, halved, estimated, quiet_s, wait, stop).items():
            found[i] = with_error_of_rocking(found[i], fine[i], parts)
    return found


def _apart(
    runs: Sequence[Run],
    outcomes: Sequence[Outcome],
    numbers: Sequence[int],
    quiet_s: float,
    wait: bool,
    stop: Stop | None,
) -> dict[int, Apart]:
    """Return rocking and lean of the runs with these ``numbers``, which are on springs."""
    chosen, their = [runs[i] for i in numbers], [outcomes[i] for i in numbers]
    parts = {}
    for j, rows in written_side_by_side(chosen, their, quiet_s, wait, stop):
        base = chosen[j].base
        assert base.on_springs
        parts[numbers[j]] = apart(chosen[j].pier, base, rows)
    return parts


def with_observed(
    run: Run,
    outcome: Outcome,
    quiet_s: float,
    *,
    ledger: bool,
    least_normal: float | None,
    error: bool,
    least_stroke: float | None = None,
    wait: bool = True,
) -> Outcome:
    """Return ``outcome`` with what observers make of the run, recorded at every step.

    These are, if ``ledger``, the energy balance at its end, with the greatest residual on the way; and the greatest forces,
    friction counted while N is above the share ``least_normal`` of the weight, and the work of devices, half cycles from
    ``least_stroke`` [m] up, unless these are None; with their ``error`` by a run of twice the step unless the run failed or is
    chaotic.
    """
    if not run.base.restraints:
        least_stroke = None
    if not ledger and least_normal is None and least_stroke is None:
        return outcome
    rows = written(run, outcome, quiet_s, every_step=True, wait=wait)
    if ledger:
        terms = energies(run, rows)
        at_end = dict(zip(TERMS, map(float, terms[-1]), strict=True))
        outcome = outcome.changed(energies=at_end | {"remainder": float(abs(terms[:, -1]).max())})
    peaks, note = (None, "") if least_normal is None else peak_forces(run, rows, least_normal)
    work = None if least_stroke is None else restraints.device_work(run.pier, run.base, rows, least_stroke)
    outcome, coarse_work = outcome.noted(note), None
    halves = error and _claims_errors(outcome)
    if halves and (peaks or work):
        del rows  # a history of every step may be large
        rows = written(run, outcome.changed(substeps=outcome.substeps // 2), quiet_s, every_step=True, wait=wait)
        if peaks and least_normal is not None:
            peaks, note = with_error(peaks, peak_forces(run, rows, least_normal)[0], run.pier)
            outcome = outcome.noted(note)
        if least_stroke is not None:
            coarse_work = restraints.device_work(run.pier, run.base, rows, least_stroke)
    if work:
        outcome = with_work(outcome, work, coarse_work, run.pier, CHANCE)
    return outcome.changed(forces=peaks)


def _claims_errors(outcome: Outcome) -> bool:
    """Return whether what is observed of a run may claim an error, by a run of twice its step."""
    return outcome.status != "failed" and outcome.substeps % 2 == 0 and CHAOTIC not in outcome.note


def forces_in_sections(
    run: Run, outcome: Outcome, quiet_s: float, heights: Sequence[float], *, error: bool, wait: bool = True
) -> list[Section]:
    """Return the greatest forces in sections of a run whose outcome is known, with their ``error`` as other forces have it."""
    rows = written(run, outcome, quiet_s, every_step=True, wait=wait)
    sections = sections_of(run, rows, heights)
    if not (error and _claims_errors(outcome)):
        return sections
    del rows  # a history of every step may be large
    rows = written(run, outcome.changed(substeps=outcome.substeps // 2), quiet_s, every_step=True, wait=wait)
    return with_errors(sections, sections_of(run, rows, heights), run.pier, CHANCE)


def histories(
    run: Run,
    outcome: Outcome,
    quiet_s: float,
    case: str,
    columns: dict[str, float | str],
    *,
    ledger: bool = False,
    forces: bool = False,
    polarity: str = "+",
    scale: float = 1.0,
    wait: bool = True,
) -> Response:
    """Return the histories of a run whose outcome is known, by repeating it with the same steps.

    The motion of ``run`` is scaled and turned already; ``polarity`` and ``scale`` say how.
    """
    pier, base, motion = run.pier, run.base, run.motion
    on_bed = isinstance(base, FootingBase)  # whose plastic set follows from every step
    rows = written(run, outcome, quiet_s, every_step=ledger or on_bed, wait=wait)
    shown = rows.kind != types.STEP
    shown[-1] = True  # an overturned pier may fall between samples
    table = None
    if ledger:
        table = pd.DataFrame(energies(run, rows)[shown], columns=list(TERMS))
        table.insert(0, "t", rows.t[shown])
    moments = at_rows(run, rows)[shown] if forces and on_bed else None
    bed_state = _footing_state(run, rows)[shown] if on_bed else None
    rows = rows[shown]
    demands = impacts = None
    if forces:
        moments = at_rows(run, rows) if moments is None else moments
        demands, impacts = forces_table(rows.t, moments, pier.gravity), impacts_table(rows, moments)
    devices = restraints.loops(pier, base, rows) if base.restraints else None
    if bed_state is not None:
        state = {name: bed_state[name].copy() for name in bed_state.dtype.names or ()}
    else:
        state = _springs_state(pier, base, rows) if base.on_springs else _rigid_state(pier, base, rows)
    t = rows.t.copy()
    vertical = np.zeros(len(t)) if motion.vertical is None else acceleration_at(motion.vertical, motion.dt, t)
    horizontal = acceleration_at(motion.horizontal, motion.dt, t)
    bent = {"deflection": state.pop("deflection")} if base.bends else {}
    history = pd.DataFrame({"t": t, **state, "ag_h": horizontal, "ag_v": vertical, **bent})
    events = pd.DataFrame(_events(rows, outcome.t_flight), columns=list(EVENT_TYPES)).astype(EVENT_TYPES)
    return Response(
        motion.name, case, columns, pier, base, outcome.status, history, events, table, polarity, scale, demands, impacts,
        devices,
    )  # fmt: skip


def _events(rows: np.recarray, t_flight: float | None) -> list[tuple[float, str, str, int, int]]:
    """Return the time, kind and pivot of every event, and the rows before and after it."""
    kinds = rows.kind
    events = []
    for row in np.flatnonzero(kinds > 0):
        jumps = kinds[row - 1] == types.BEFORE_EVENT
        events.append((float(rows.t[row]), *_EVENTS[int(kinds[row])], int(row - jumps), int(row)))
    if t_flight is not None:
        last = int(np.searchsorted(rows.t, t_flight, side="right")) - 1
        events.append((t_flight, "flight", "", last, last))
        events.sort(key=lambda event: event[0])
    return events


def _rigid_state(pier: Pier, base: RigidBase, rows: np.recarray) -> dict[str, Samples]:
    """Return rotation and rate, deflection of a shaft that bends, and the energy stored since the start."""
    m, theta, v = block(pier, base), rows.theta, rows.v
    side = np.where(rows.left != rows.right, rows.right - rows.left, (1.0 - m.deck) * rows.bore + m.deck * rows.top)
    lever = m.height * np.cos(theta) + side * m.half_width * np.sin(theta)
    energy = 0.5 * rows.v_rate**2 + 0.5 * (pier.inertia + lever**2) * rows.omega**2 + pier.gravity * (v - v[0])
    bent = {}
    if base.bends:
        energy = _energy_of_bending(flexible_block(pier, base), rows, side)
        energy, bent = energy - energy[0], {"deflection": rows.u}
    if base.restraints:
        energy = energy + restraints.stored(pier, base, rows)
    none = dict.fromkeys(
        ("v", "z_left", "z_right", "v_left", "v_right", "force_left", "force_right"), np.full(len(rows), np.nan)
    )
    return {"theta": theta, "omega": rows.omega, **none, "energy": energy, **bent}


def _energy_of_bending(m: FlexibleBlock, rows: np.recarray, key: Samples) -> Samples:
    """Return kinetic, potential and elastic energy [J/kg] of a pier whose shaft bends, about the base's point at ``key``."""
    b, sine, cosine, u = key * m.half_width, np.sin(rows.theta), np.cos(rows.theta), rows.u
    turning = m.inertia + m.height**2 + b**2 + u * (m.second * u - 2.0 * m.first * b)
    slope, rise = (
        (b - m.first * u) * cosine - m.height * sine,
        rows.v_rate - (b * cosine - m.height * sine) * rows.omega,
    )
    kinetic = (
        0.5 * (m.second * rows.u_rate**2 + turning * rows.omega**2 + rise**2) + m.coupling * rows.u_rate * rows.omega
    )
    kinetic += rise * (slope * rows.omega - m.first * sine * rows.u_rate)
    return kinetic + m.gravity * (rows.v - m.first * u * sine) + 0.5 * m.second * (m.frequency * u) ** 2


def _footing_state(run: Run, rows: np.recarray) -> np.recarray:
    """Return state, edges of the foot, forces at them that are equal to the push, and stored energy, at every step."""
    pier, base, nothing = run.pier, run.base, np.full(len(rows), np.nan)
    plain, pulls = restraints.apart(base, rows)
    bed = np.recarray(len(rows), BED_STATE)
    balance = np.zeros(len(rows), LEDGER).view(np.recarray)
    follow_bed(model(pier, base), plain, pulls, ground_of(run.motion), float(run.motion.dt), balance, bed)
    finite = base.kinematics == "finite"
    rise = pier.half_width * (np.sin(rows.theta) if finite else rows.theta)
    middle = rows.v + (pier.height * (1.0 - np.cos(rows.theta)) if finite else 0.0)
    energy, of_edges = bed.stored, bed.moment / pier.half_width
    if base.restraints:
        energy = energy + restraints.stored(pier, base, rows)
    columns = {
        "theta": rows.theta, "omega": rows.omega, "v": rows.v, "z_left": nothing, "z_right": nothing, "v_left": middle + rise,
        "v_right": middle - rise, "force_left": -0.5 * (bed.force - of_edges), "force_right": -0.5 * (bed.force + of_edges),
        "energy": energy,
    }  # fmt: skip
    return np.rec.fromarrays(list(columns.values()), names=list(columns))


def _springs_state(pier: Pier, base: ElasticBase, rows: np.recarray) -> dict[str, Samples]:
    """Return state, pivots and stored energy since the start: kinetic, potential and elastic (THEORY.md, Results of a run)."""
    m = springs(pier, base)
    v, theta, z_left, z_right = rows.v, rows.theta, rows.z_left, rows.z_right
    b, h = m.half_width, m.height
    rise, drop, lever = b * theta, np.zeros(len(rows)), np.full(len(rows), h)
    arm, middle = np.full(len(rows), b), np.zeros(len(rows))
    if m.finite is not None:
        rise, drop = b * np.sin(theta), h * (1.0 - np.cos(theta))
        arm, middle = b * np.cos(theta), h * np.sin(theta)
        lever = h * np.cos(theta) + (rows.right - rows.left) * rise
    elastic = z_left**2 + z_right**2
    energy = (
        0.5 * rows.v_rate**2
        + 0.5 * (m.inertia + lever**2) * rows.omega**2
        + m.gravity * (v - v[0])
        + 0.5 * m.yield_force * m.yield_deflection * (elastic - elastic[0])
    )
    if base.restraints:
        energy = energy + restraints.stored(pier, base, rows)
    return {
        "theta": theta,
        "omega": rows.omega,
        "v": v,
        "z_left": z_left,
        "z_right": z_right,
        "v_left": v + rise + drop,
        "v_right": v - rise + drop,
        "force_left": rows.left * (m.yield_force * z_left + m.damping * (rows.v_rate + (middle + arm) * rows.omega)),
        "force_right": rows.right * (m.yield_force * z_right + m.damping * (rows.v_rate + (middle - arm) * rows.omega)),
        "energy": energy,
    }
