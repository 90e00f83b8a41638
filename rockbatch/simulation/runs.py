"""Runs with given steps: piers on bases under motions, side by side, and the outcome of each."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from rockbatch.common.statuses import Status
from rockbatch.core import types
from rockbatch.core.clock import ON_ITS_SIDE
from rockbatch.core.devices.lanes import Equipment, equipment_of, signature
from rockbatch.core.devices.laws import STICKS, Element
from rockbatch.core.history import MOMENT
from rockbatch.core.run import NO_ROWS, march
from rockbatch.core.system import System
from rockbatch.core.types import Result
from rockbatch.motions.motion import Motion, Samples
from rockbatch.outcome.outcome import RELEASED, Failure, Outcome
from rockbatch.pier import (
    MOST_NEGLECTED,
    Base,
    ElasticBase,
    FootingBase,
    Pier,
    neglected,
    places,
    tilt_over_residual,
    vertical_frequency,
    yield_deflection,
)
from rockbatch.pier.laws import without_ratcheting
from rockbatch.simulation.beds import of_bed
from rockbatch.simulation.compilation import kernel_of
from rockbatch.simulation.elements import elements, prestress
from rockbatch.simulation.models import Line, acceleration_at, ground_of, line_of, model
from rockbatch.simulation.open_ends import still_rocks
from rockbatch.simulation.restraints import static_position
from rockbatch.simulation.starting import start_of
from rockbatch.simulation.steps import first_substeps, least_substeps, patience, readings

MOST_STEPS = 1e8
"""Greatest number of steps of a run, about 15 s of computing."""

_STATUS: dict[int, Status] = {
    types.SURVIVED: "ok",
    types.RESTLESS: "ok",
    types.LATE_FLIGHT: "ok",
    types.OVERTURNED: "overturned",
    types.FLIGHT: "flight",
}
"""Statuses by the statuses of the core; a run with any other status has failed."""

_FAILURES = {
    types.CHATTER: Failure.CONTACTS,
    types.NOT_FINITE: Failure.BLEW_UP,
    types.UNDECIDED: Failure.UNDECIDED,
    types.GROWING: Failure.RATCHETS,
}

_REASONS = {
    Failure.CONTACTS: "more than 20,000 contact events within one sample; use more substeps",
    Failure.BLEW_UP: "the integration blew up; use more substeps, or look for a spike in the record",
    Failure.UNDECIDED: "in free vibration after the record the pier stays where it may still overturn",
    Failure.RATCHETS: (
        "in free vibration after the record the pier leans further and further: yielding springs ratchet; "
        f"spring = {without_ratcheting('and')} ratchet least"
    ),
}

LEFT_ALONE = (Failure.UNDECIDED, Failure.RATCHETS)
"""Failures of runs that the longest tail did not decide; smaller steps do not change them."""

NOTED_TILT = 1e-4
"""Change of the residual rotation by dampers and tendons, in units of α, above which a note reports it."""

_RESTLESS = (
    "after {seconds:.0f} s of free vibration behind the record the pier still has the energy for a greater rotation"
)
_HIGH = "flew up to {height:.2g} mm, more than flight_limit_mm = {limit:g}"
_LARGE = (
    "a peak of {theta:.2g} rad by linearised kinematics, which neglect {share:.0%} of inertia and righting moment there; "
    'kinematics = "finite" does not'
)
_LATE_FLIGHT = "flew at {t:.2f} s, when nothing could exceed the peak any more; the run ends there"
_ADVICE = 'flight = "guided" goes on, for a pier whose shear keys hold it'
_DAMP = f"see zeta, the damping of the supports; or {_ADVICE}"


@dataclass(frozen=True)
class Run:
    """A pier on a base under a motion."""

    pier: Pier
    base: Base
    motion: Motion


class End(NamedTuple):
    """Pier and devices at the end of a run."""

    position: Samples  # v [m] and θ [rad]
    rest: Samples  # at which the pier comes to rest; the same without residuals
    level: float  # v of the pier at rest at the start [m]
    states: Samples  # of each device, shape (devices,)
    sticks: npt.NDArray[np.bool_]  # True for a friction damper that sticks, shape (devices,)


@dataclass(frozen=True)
class Trial:
    """Outcome of a run with given steps, and a summary of its trajectory.

    ``extremes``, shape (:data:`rockbatch.core.clock.WINDOWS`,), holds the greatest |θ| [rad] at samples in equal
    windows of the run, NaN for those that it did not reach. ``end`` is None without devices.
    """

    outcome: Outcome
    extremes: Samples
    end: End | None = None


class Stop:
    """Flag that other threads may set to end runs in their kernels."""

    def __init__(self) -> None:
        self.flag = np.zeros(1, np.uint8)

    def set(self) -> None:
        self.flag[0] = 1

    @property
    def is_set(self) -> bool:
        """True if the runs have to end."""
        return bool(self.flag[0])


def quiet_samples(quiet_s: float, dt: float) -> int:
    """Return the number of samples of ``dt`` [s] in a free-vibration tail of ``quiet_s`` [s], rounded up."""
    return math.ceil(quiet_s / dt - 1e-9)


def _line(pier: Pier, base: Base, dt: float, substeps: int, quiet_s: float, wait: bool) -> Line:
    """Return the core's line of a run; its ``first_row`` and ``npts``, which depend on the motion, are still 0."""
    timing = (dt, substeps, quiet_samples(quiet_s, dt), 0, 0, patience(pier, dt) if wait else 0)
    read = readings(pier, base, dt) if wait else (0, 0)
    return line_of(model(pier, base), timing, read, prestress(pier, base), start_of(pier, base))


def _equipment(runs: Sequence[Run]) -> Equipment | None:
    """Return the devices of runs that are :func:`alike`, in their initial states; None without any."""
    starts = []
    for pier, base in ((run.pier, run.base) for run in runs):
        start = start_of(pier, base)
        starts.append((elements(pier, base), start.states, start.level))
    return equipment_of(kernel_of(runs[0].pier, runs[0].base)[0], starts)


def alike(run: Run) -> tuple[object, ...]:
    """Return a key equal for runs that can be computed side by side at one step: their system, and kinds of devices."""
    return (*kernel_of(run.pier, run.base), signature(elements(run.pier, run.base)))


def written_run(
    run: Run,
    substeps: int,
    quiet_s: float,
    rows: int,
    locate: bool = True,
    every_step: bool = False,
    wait: bool = True,
) -> tuple[Result, np.recarray]:
    """Return result and history of a run, as :func:`written_runs`."""
    return written_runs([run], substeps, quiet_s, rows, locate, every_step, wait)[0]


def written_runs(
    runs: Sequence[Run],
    substeps: int,
    quiet_s: float,
    rows: int,
    locate: bool = True,
    every_step: bool = False,
    wait: bool = True,
) -> list[tuple[Result, np.recarray]]:
    """Return the results of runs of one system, and their histories of ``rows`` rows each, the first ``Result.rows`` filled.

    A run that has more rows than that fills all, and has its number in ``Result.rows``. With ``every_step`` the history has rows
    between samples, too. All runs must be :func:`alike`.
    """
    system, equipment = kernel_of(runs[0].pier, runs[0].base)[0], _equipment(runs)
    columns = _row_type(system, 0 if equipment is None else len(equipment.lanes))
    written = np.zeros((len(runs), rows, columns.itemsize // 8))
    lines, ground = _lines(runs, substeps, [quiet_s] * len(runs), wait)
    records = march(system, lines, ground, Stop().flag, substeps, locate, every_step, written, equipment)
    histories = written.view(columns)[:, :, 0]
    return [(result, rows.view(np.recarray)) for result, rows in zip(_results(records), histories, strict=True)]


def _lines(runs: Sequence[Run], substeps: int, tails: Sequence[float], wait: bool) -> tuple[list[Line], Samples]:
    """Return the core's lines of runs with ``tails`` [s], and the ground rows of all their motions, each motion once."""
    first_rows: dict[int, int] = {}
    grounds: list[Samples] = []
    of_piers: dict[tuple[int, int, float, float], Line] = {}
    lines = []
    for run, tail in zip(runs, tails, strict=True):
        motion, pier = run.motion, (id(run.pier), id(run.base), run.motion.dt, tail)
        if id(motion) not in first_rows:
            first_rows[id(motion)] = sum(map(len, grounds))
            grounds.append(ground_of(motion))
        if pier not in of_piers:
            of_piers[pier] = _line(run.pier, run.base, float(motion.dt), substeps, tail, wait)
        lines.append(of_piers[pier]._replace(first_row=first_rows[id(motion)], npts=motion.npts))
    return lines, grounds[0] if len(grounds) == 1 else np.concatenate(grounds)


def _row_type(system: System, devices: int) -> np.dtype:
    """Return the dtype of a history's row, as ``core.history`` writes it; ``devices``, if any, add their columns."""
    names = [(name, "f8") for name in (*MOMENT, *system.columns)]
    if not devices:
        return np.dtype(names)
    per_device = [("state", "f8", (devices,)), ("lost", "f8", (devices,))]
    return np.dtype([*names, *per_device, ("input", "f8"), ("p_delta", "f8"), ("pull", "f8", (2,))])


def _results(records: np.recarray) -> list[Result]:
    return [Result(*values) for values in records[list(Result._fields)].tolist()]


def run_fixed(
    pier: Pier, base: Base, motion: Motion, substeps: int, quiet_s: float = 2.0, locate: bool = True, wait: bool = True
) -> Outcome:
    """Return the outcome of one run with ``substeps`` steps per sample, without an error estimate; see :func:`run_all_fixed`."""
    outcome = run_all_fixed([Run(pier, base, motion)], [substeps], quiet_s, Stop(), locate, wait)[0]
    assert outcome is not None
    return outcome


def run_all_fixed(
    runs: Sequence[Run], substeps: Sequence[int], quiet_s: float, stop: Stop, locate: bool = True, wait: bool = True
) -> list[Outcome | None]:
    """Return the outcomes of ``runs`` with given steps per sample, in their order; ``None`` for stopped ones.

    An outcome does not depend on the runs beside it. With ``locate=False`` events take place at the end of their step, which
    is of first order and for comparison only. With ``wait=False`` a run ends ``quiet_s`` after its record, whatever the pier
    does. A step beyond the method's stability is refused; the reason gives the number of steps that is needed.
    """
    return [None if trial is None else trial.outcome for trial in try_all(runs, substeps, quiet_s, stop, locate, wait)]


def try_all(
    runs: Sequence[Run],
    substeps: Sequence[int],
    quiet_s: float | Sequence[float],
    stop: Stop,
    locate: bool = True,
    wait: bool = True,
) -> list[Trial | None]:
    """Return trials as :func:`run_all_fixed` returns outcomes: with summaries of the trajectories.

    ``quiet_s`` [s] is that of all runs, or of each.
    """
    tails = np.broadcast_to(quiet_s, len(runs)).tolist()
    trials: list[Trial | None] = list(map(_refusal, runs, substeps, tails))
    groups: dict[tuple[object, ...], list[int]] = {}
    for i, run in enumerate(runs):
        if trials[i] is None:
            groups.setdefault((substeps[i], *alike(run)), []).append(i)
    for members in groups.values():
        if stop.is_set:
            break
        some, steps = [runs[i] for i in members], substeps[members[0]]
        lines, ground = _lines(some, steps, [tails[i] for i in members], wait)
        equipment, system = _equipment(some), kernel_of(some[0].pier, some[0].base)[0]
        records = march(system, lines, ground, stop.flag, steps, locate, False, NO_ROWS, equipment)
        for number, (i, result, extremes) in enumerate(zip(members, _results(records), records.extremes, strict=True)):
            if result.status != types.RUNNING:
                outcome, end = _outcome(runs[i], steps, result), None
                if equipment is not None:
                    end = _end(runs[i], result, equipment, number)
                    outcome = _with_static_rotation(runs[i], end, outcome)
                    outcome = outcome.changed(**_device_demands(runs[i], equipment.use[number]))
                trials[i] = Trial(outcome, extremes, end)
    return trials


def _end(run: Run, result: Result, equipment: Equipment, number: int) -> End:
    """Return the End of the run ``number``."""
    level, states = float(equipment.level[number, 0]), equipment.x[number, : len(equipment.lanes)]
    sticks = equipment.goes[number] == STICKS
    position = np.array([result.v_end, result.theta_end])
    rests = _STATUS.get(result.status) == "ok" and run.base.has_residual
    rest = static_position(run.pier, run.base, result, level, states, sticks) if rests else position
    return End(position, rest, level, states, sticks)


def _with_static_rotation(run: Run, end: End, outcome: Outcome) -> Outcome:
    """Return ``outcome`` with its static residual rotation under devices; unchanged without residuals.

    A note says so if devices change it by more than :data:`NOTED_TILT` α.
    """
    pier, base, rotation = run.pier, run.base, float(end.rest[1])
    if outcome.status != "ok" or not base.has_residual:
        return outcome
    remark = f"dampers hold the pier at a rotation of {rotation:.3g} rad"
    if not base.on_springs and rotation != 0.0:  # held, it does not land
        outcome = outcome.changed(still_rocks=False)
    if base.on_springs:
        remark = f"dampers and tendons hold the pier at {rotation:.3g} rad, its supports would at {outcome.theta_res or 0.0:.3g}"
    changed = abs(rotation - (outcome.theta_res or 0.0)) > NOTED_TILT * pier.alpha
    return outcome.noted(remark if changed else "", theta_res=rotation)


def _device_demands(run: Run, use: np.recarray) -> dict[str, float]:
    """Return the demands on the kinds of devices of a base by the fields of Outcome, forces over the weight; {} without devices.

    They are the greatest of each kind; energies and counts are sums.
    """
    kinds = np.array([device.what for device in run.base.restraints for _ in places(run.pier, device)])
    dampers, tendons = (use[kinds == stop_kind].view(np.recarray) for stop_kind in ("damper", "tendon"))
    demands: dict[str, float] = {}
    if len(dampers):
        demands["damper_force"] = float(dampers.most.max()) / run.pier.gravity
        demands["damper_stroke"] = float(dampers.stroke.max())
        demands["damper_speed"] = float(dampers.speed.max())
        demands["damper_energy"] = float(dampers.lost.sum())
    if len(tendons):
        demands["tendon_force"] = float(tendons.most.max()) / run.pier.gravity
        demands["tendon_yield"] = float(tendons.yielded.max())
        demands["tendon_slack"] = int(tendons.times.sum())
    for stop_kind in ("stop", "deck_spring"):
        if (kinds == stop_kind).any():
            laws = [law for law, kind in zip(elements(run.pier, run.base), kinds, strict=True) if kind == stop_kind]
            demands |= _contact_demands(laws, use[kinds == stop_kind].view(np.recarray), stop_kind, run.pier.gravity)
    return demands


def _contact_demands(laws: list[Element], use: np.recarray, name: str, gravity: float) -> dict[str, float]:
    """Return the demands on stops or deck springs, whose depth is force over stiffness, since first loading is linear."""
    stiffness = np.array([law.stiffness for law in laws])
    return {
        f"{name}_force": float(use.most.max()) / gravity,
        f"{name}_depth": float((use.most / stiffness).max()),
        f"{name}_blows": int(use.times.sum()),
        f"{name}_energy": float(use.lost.sum()),
    }


def _refusal(run: Run, substeps: int, quiet_s: float) -> Trial | None:
    """Return the failed trial of a run with too large or too many steps; ``None`` if it can be run."""
    pier, base, motion = run.pier, run.base, run.motion
    least = least_substeps(pier, base, motion.dt)
    if substeps < least:
        return _not_run(
            Failure.LARGE_STEP,
            f"{substeps} substeps of a sample of {motion.dt:g} s are too few for the springs' frequency: "
            f"the integration would blow up; at least {least}, better {first_substeps(pier, base, motion.dt)}",
            substeps,
        )
    steps = steps_of(motion, substeps, quiet_s)
    if steps > MOST_STEPS:
        return _not_run(
            Failure.MANY_STEPS,
            f"would take {steps:.0e} steps, more than {MOST_STEPS:.0e}; shorten the record or quiet_s",
            substeps,
        )
    return None


_UNCHANGED = ("t_max", "impacts", "flights", "flight_duration", "flight_height", "t_end")
"""Fields of the core's Result that an Outcome has, too."""

_BLANK = Outcome("failed", "", math.nan, math.nan, 0, 0, None, 0.0, 0)
"""Outcome that every run copies with changes, in a quarter of the time of a new one."""


def _outcome(run: Run, substeps: int, result: Result) -> Outcome:
    """Return the Outcome of a run from the core's ``result``."""
    pier, base = run.pier, run.base
    failure = _FAILURES.get(result.status)
    status, reason = _STATUS.get(result.status, "failed"), "" if failure is None else _REASONS[failure]
    more: Mapping[str, object] = {}
    if isinstance(base, FootingBase):
        more = of_bed(pier, base, result, survived=status == "ok")
    elif base.on_springs:
        more = _spring_results(pier, base, result, survived=status == "ok")
    if base.bends:
        more = {**more, "deflection_max": result.deflection_max, "top_drift_max": result.drift_max}
    if result.status == types.FLIGHT:
        omega_v, zeta = (vertical_frequency(pier, base), base.zeta or 0.0) if base.on_springs else (None, 0.0)
        reason = cause_of_flight(run.motion, omega_v, pier.gravity, result.t_flight, result.t_impact, zeta)
    in_motion = result.theta_max if math.isnan(result.theta_in_motion) else result.theta_in_motion
    notes = []
    if result.status == types.RESTLESS:
        notes.append(_RESTLESS.format(seconds=result.t_end - run.motion.duration))
    elif result.status == types.LATE_FLIGHT:
        notes.append(_LATE_FLIGHT.format(t=result.t_end))
    beyond_linearised = None
    if base.kinematics == "first-order":
        share = neglected(pier, result.theta_max)
        beyond_linearised = bool(share > MOST_NEGLECTED) and status != "overturned"
        if beyond_linearised:
            notes.append(_LARGE.format(theta=result.theta_max, share=share))
    if pier.initial_rotation_rad and result.t_max == 0.0 and status == "ok":
        notes.append(RELEASED)
    if 1000.0 * result.flight_height > base.flight_limit_mm:
        notes.append(_HIGH.format(height=1000.0 * result.flight_height, limit=base.flight_limit_mm))
    return _BLANK.changed(
        status=status,
        reason=reason,
        failure=failure,
        beyond_linearised=beyond_linearised,
        still_rocks=still_rocks(pier, base, result) if status == "ok" else None,
        theta_max=min(result.theta_max, ON_ITS_SIDE),
        theta_max_in_motion=min(in_motion, ON_ITS_SIDE),
        separations=result.uplifts,
        t_flight=None if math.isnan(result.t_flight) else result.t_flight,
        substeps=substeps,
        note="; ".join(notes),
        **{name: getattr(result, name) for name in _UNCHANGED},
        **more,
    )


def cause_of_flight(
    motion: Motion, omega_v: float | None, gravity: float, t_flight: float, t_impact: float, zeta: float = 0.0
) -> str:
    """Return a sentence on why a pier left the ground at ``t_flight`` [s], with advice.

    ``omega_v`` [rad/s] is the frequency of vertical vibration, None on a rigid base, and ``zeta`` its damping ratio; the last
    impact before was at ``t_impact`` [s], NaN without one.
    """
    opening = f"both pivots left the ground at {t_flight:.3f} s: "
    peak, down = 0.0, 0.0
    if motion.vertical is not None:
        down = float(acceleration_at(motion.vertical, motion.dt, t_flight)) / gravity
        peak = float(np.abs(motion.vertical[: math.floor(t_flight / motion.dt) + 1]).max()) / gravity
    if omega_v is None or down <= -1.0 + 1e-9:
        return f"{opening}the ground fell away under the pier, with a vertical acceleration of {down:.2f} g"
    if t_flight - t_impact <= math.pi / omega_v:
        return f"{opening}thrown up {1000 * (t_flight - t_impact):.0f} ms after an impact; {_ADVICE}"
    oscillator = f"vertical oscillator of {omega_v / (2.0 * math.pi):.3g} Hz, damping {100.0 * zeta:.3g} %"
    if peak == 0.0:
        return f"{opening}{oscillator}, excited by rocking; {_DAMP}"
    times = f"{1.0 / peak:.1f} times the ground's {peak:.2f} g until then"
    return f"{opening}{oscillator}, reached 1 g, {times}; {_DAMP}"


def _spring_results(pier: Pier, base: ElasticBase, result: Result, survived: bool) -> dict[str, float]:
    """Return fields of Outcome on springs: residuals if the pier ``survived``, demands if they yield; {} for neither."""
    more: dict[str, float] = {}
    if survived:
        # From the base's tilt to the rotation, static on the deformed base (THEORY.md, eq. 20)
        half_width = pier.half_width
        leaning = base.leaning_height(pier)
        lean = 1.0 / tilt_over_residual(pier.gravity, leaning, half_width, vertical_frequency(pier, base))
        tilt = 0.5 * (result.base_left - result.base_right) / half_width
        more |= {
            "settlement": -0.5 * (result.base_left + result.base_right),
            "base_tilt": tilt,
            "theta_res": lean * tilt,
        }
        if base.yields:
            more["t_read"] = result.t_read
            if not math.isnan(result.drift_left):
                more["settlement_drift"] = -0.5 * (result.drift_left + result.drift_right)
                more["theta_res_drift"] = 0.5 * lean * (result.drift_left - result.drift_right) / half_width
    if base.yields:
        deflection = yield_deflection(pier, base)
        more["ductility_left"] = -result.deepest_left / deflection
        more["ductility_right"] = -result.deepest_right / deflection
        more["dissipated_left"] = result.dissipated_left
        more["dissipated_right"] = result.dissipated_right
    return more


def _not_run(failure: Failure, reason: str, substeps: int) -> Trial:
    """Return the failed trial of a run that was refused; its rotations are NaN, and it has no extremes."""
    return Trial(_BLANK.changed(failure=failure, reason=reason, substeps=substeps), np.empty(0))


def steps_of(motion: Motion, substeps: int, quiet_s: float) -> float:
    """Return the number of steps of a run to the end of its tail of ``quiet_s`` [s], with a sample to spare."""
    return substeps * (motion.npts + quiet_s / motion.dt)
