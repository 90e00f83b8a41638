"""Histories of runs: rows of the core as tables, with derived quantities in SI units."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from rockbatch.common.lazy import pd
from rockbatch.common.statuses import Status
from rockbatch.core import types
from rockbatch.core.flexure.model import Flexing
from rockbatch.core.flexure.modes import MOST_MODES
from rockbatch.core.observe.beds import BED_STATE, follow_bed
from rockbatch.core.observe.ledger import energy_of_rows
from rockbatch.motions.motion import Samples
from rockbatch.outcome.half_cycles import HalfCycles, Path, half_cycles
from rockbatch.outcome.response import EVENT_TYPES, Response
from rockbatch.pier import Base, ElasticBase, FootingBase, Pier, RigidBase
from rockbatch.simulation import restraints
from rockbatch.simulation.models import acceleration_at, model, springs
from rockbatch.simulation.observing import Observer
from rockbatch.simulation.recording import Recording
from rockbatch.simulation.runs import Run

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

LANDINGS = (types.IMPACT_LEFT, types.IMPACT_RIGHT, types.IMPACT_BOTH, types.REST)
"""Kinds of events at which a pivot comes down."""


def cycles_of(base: Base, rows: np.recarray) -> HalfCycles:
    """Return the half cycles of a run on ``base`` from its history."""
    landed = None if base.on_springs else np.flatnonzero(np.isin(rows.kind, LANDINGS))
    return half_cycles(Path(rows.t, rows.theta, rows.omega), landed)


def histories(
    recording: Recording,
    status: Status,
    case: str,
    columns: dict[str, float | str],
    observers: Sequence[Observer] = (),
    *,
    polarity: str = "+",
    scale: float = 1.0,
) -> Response:
    """Return the response of a recorded run that ended with ``status``, with the tables that ``observers`` add.

    The motion of the run already has the ``polarity`` and the ``scale``, which are only stated.
    """
    run, rows = recording.run, recording.at_samples.rows
    pier, base, motion = run.pier, run.base, run.motion
    added: dict[str, Any] = dict(item for observer in observers for item in observer.histories(recording).items())
    if isinstance(base, FootingBase):
        of_bed = _footing_state(run, recording.rows)[recording.shown]
        state = {name: of_bed[name].copy() for name in of_bed.dtype.names or ()}
    else:
        state = _springs_state(pier, base, rows) if base.on_springs else _rigid_state(pier, base, rows)
    t, loops = rows.t.copy(), None
    if base.restraints:
        devices = restraints.device_histories(pier, base, rows)
        loops = restraints.loops(pier, base, t, devices)
        state["energy"] = state["energy"] + devices.stored
    vertical = np.zeros(len(t)) if motion.vertical is None else acceleration_at(motion.vertical, motion.dt, t)
    horizontal = acceleration_at(motion.horizontal, motion.dt, t)
    bent = {"deflection": _deflection(pier, base, rows)} if base.bends else {}
    history = pd.DataFrame({"t": t, **state, "ag_h": horizontal, "ag_v": vertical, **bent})
    events = pd.DataFrame(_events(rows, recording.t_flight), columns=list(EVENT_TYPES)).astype(EVENT_TYPES)
    return Response(
        motion.name,
        case,
        columns,
        pier,
        base,
        status,
        history,
        events,
        polarity=polarity,
        scale=scale,
        restraints=loops,
        **added,
    )


def _events(rows: np.recarray, t_flight: float) -> list[tuple[float, str, str, int, int]]:
    """Return time, kind and pivot of every event, and the indices of the rows before and after it, in order of time.

    Both are the same row for an event without a jump; for the first flight it is the last row until then.
    """
    kinds = rows.kind
    events = []
    for row in np.flatnonzero(kinds > 0):
        jumps = kinds[row - 1] == types.BEFORE_EVENT
        events.append((float(rows.t[row]), *_EVENTS[int(kinds[row])], int(row - jumps), int(row)))
    if not math.isnan(t_flight):
        last = int(np.searchsorted(rows.t, t_flight, side="right")) - 1
        events.append((t_flight, "flight", "", last, last))
        events.sort(key=lambda event: event[0])
    return events


def _energy(pier: Pier, base: Base, rows: np.recarray) -> Samples:
    """Return the energy [J/kg] of a pier without its devices at every row, relative to the first."""
    energy = np.empty(len(rows))
    energy_of_rows(model(pier, base), restraints.apart(base, rows)[0], energy)
    return energy


def _rigid_state(pier: Pier, base: RigidBase, rows: np.recarray) -> dict[str, Samples]:
    """Return columns of a history on rigid ground: rotation, rate, energy without devices since the start; NaN for springs'."""
    none = dict.fromkeys(
        ("v", "z_left", "z_right", "v_left", "v_right", "force_left", "force_right"), np.full(len(rows), np.nan)
    )
    return {"theta": rows.theta, "omega": rows.omega, **none, "energy": _energy(pier, base, rows)}


def _deflection(pier: Pier, base: Base, rows: np.recarray) -> Samples:
    """Return the deflection of the highest point of an elastic shaft across its axis [m], at every row."""
    shapes = base.modes(pier).at(pier.highest)
    deflection: Samples = shapes @ of_modes(rows)[0][: len(shapes)]
    return deflection


def of_modes(rows: np.recarray) -> tuple[Samples, Samples]:
    """Return the coordinates [m] of all modes of a shaft at ``rows``, and their rates [m/s], shape (modes, rows) each.

    Modes that the run does not follow are included, and stay 0.
    """
    first = Flexing._fields.index("u_1")
    names, rates = Flexing._fields[first : first + MOST_MODES], Flexing._fields[first + MOST_MODES :]
    return np.array([rows[name] for name in names]), np.array([rows[name] for name in rates])


def _footing_state(run: Run, rows: np.recarray) -> np.recarray:
    """Return columns of a history on a footing at every step: state, edges of the foot, two forces there, energy.

    The two forces, below 0 when pressed, are equivalent to the bed's push and its moment; the energy is without devices, and from
    the start.
    """
    pier, base, nothing = run.pier, run.base, np.full(len(rows), np.nan)
    bed = np.recarray(len(rows), BED_STATE)
    follow_bed(model(pier, base), restraints.apart(base, rows)[0], bed)
    finite = base.kinematics == "finite"
    rise = pier.half_width * (np.sin(rows.theta) if finite else rows.theta)
    middle = rows.v + (pier.height * (1.0 - np.cos(rows.theta)) if finite else 0.0)
    of_edges = bed.moment / pier.half_width
    columns = {
        "theta": rows.theta,
        "omega": rows.omega,
        "v": rows.v,
        "z_left": nothing,
        "z_right": nothing,
        "v_left": middle + rise,
        "v_right": middle - rise,
        "force_left": -0.5 * (bed.force - of_edges),
        "force_right": -0.5 * (bed.force + of_edges),
        "energy": bed.stored,
    }
    state = np.recarray(len(rows), np.dtype([(name, "f8") for name in columns]))
    for name, values in columns.items():
        state[name] = values
    return state


def _springs_state(pier: Pier, base: ElasticBase, rows: np.recarray) -> dict[str, Samples]:
    """Return columns of a history on springs: state, pivots, support forces, energy without devices since the start.

    Forces are per unit mass [N/kg], and below 0 when pressed.
    """
    m = springs(pier, base)
    v, theta, z_left, z_right = rows.v, rows.theta, rows.z_left, rows.z_right
    b, h = m.half_width, m.height
    rise, drop = b * theta, np.zeros(len(rows))
    arm, middle = np.full(len(rows), b), np.zeros(len(rows))
    if m.finite is not None:
        rise, drop = b * np.sin(theta), h * (1.0 - np.cos(theta))
        arm, middle = b * np.cos(theta), h * np.sin(theta)
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
        "energy": _energy(pier, base, rows),
    }
