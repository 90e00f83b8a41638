"""Runs with given steps: piers on bases under motions, side by side, and what each comes to."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any, Final, Literal

import numpy as np

from rockbatch.core import two_springs
from rockbatch.core.outcome import ON_ITS_SIDE
from rockbatch.core.recording import NO_HISTORY, ROW
from rockbatch.core.restrained.elements import TENDON
from rockbatch.core.restrained.runs import COLUMNS, Restrained, rock_restrained
from rockbatch.core.restrained_springs.runs import RestrainedOnSprings, rock_restrained_on_springs
from rockbatch.core.rigid import runs as rigid
from rockbatch.core.types import (
    CHATTER,
    FLIGHT,
    GROWING,
    LATE_FLIGHT,
    NOT_FINITE,
    OVERTURNED,
    RESTLESS,
    RUNNING,
    SURVIVED,
    UNDECIDED,
    RigidRun,
    SpringRun,
    Traits,
)
from rockbatch.motions.motion import Motion, Samples
from rockbatch.pier import (
    Base,
    Pier,
    RigidBase,
    YieldingBase,
    tilt_over_residual,
    vertical_frequency,
    yield_deflection,
)
from rockbatch.results.outcome import Outcome
from rockbatch.simulation.flight import cause_of_flight
from rockbatch.simulation.models import (
    block,
    elements,
    first_substeps,
    ground_of,
    least_substeps,
    patience,
    prestress,
    readings,
    springs,
)
from rockbatch.simulation.restraints import rests_at

MOST_STEPS = 1e8
"""Steps that a run may take to settle, about a quarter of a minute of work."""

_STATUS = {
    SURVIVED: ("ok", ""),
    RESTLESS: ("ok", ""),
    LATE_FLIGHT: ("ok", ""),
    OVERTURNED: ("overturned", ""),
    FLIGHT: ("flight", ""),
    CHATTER: ("failed", "more than 20,000 contact events within one sample; use more substeps or another epsilon"),
    NOT_FINITE: ("failed", "the integration blew up; use more substeps, or look for a spike in the record"),
    UNDECIDED: ("failed", "left alone after the record, the pier stays where it may yet overturn"),
    GROWING: (
        "failed",
        "left alone after the record, the pier leans further and further: yielding springs ratchet on vibration that "
        'nothing damps; spring = "epp" does so least',
    ),
}

RESTRAINED: Final = "restrained"
"""Of runs on a rigid base with dampers and tendons, which go one by one."""

LEFT_ALONE = tuple(_STATUS[code][1] for code in (UNDECIDED, GROWING))
"""Reasons of runs that failed because nothing decided them for so long, which smaller steps do not change."""

TOLD = 1e-4
"""Of α: a residual rotation that dampers and tendons hold is told in a note beyond it."""

_RESTLESS = "left alone after the record for {seconds:.0f} s, the pier has still the energy for a greater rotation"
_LATE_FLIGHT = "flew at {t:.2f} s, when nothing could exceed the peak any more; the run ends there"


@dataclass(frozen=True)
class Run:
    """What is simulated: a pier on a base under a motion."""

    pier: Pier
    base: Base
    motion: Motion


@dataclass(frozen=True)
class Trial:
    """What a run with given steps came to.

    ``extremes``, shape (:data:`rockbatch.core.outcome.WINDOWS`,), holds the greatest |θ| [rad] at a sample in equal
    parts of the run, NaN for those that it did not reach: its trajectory in short.
    """

    outcome: Outcome
    extremes: Samples


class Stop:
    """Ends, in their kernels, the runs of other threads that were given it."""

    def __init__(self) -> None:
        self.flag = np.zeros(1, np.uint8)

    def set(self) -> None:
        self.flag[0] = 1

    def __bool__(self) -> bool:
        return bool(self.flag[0])


def _quiet_samples(quiet_s: float, dt: float) -> int:
    return math.ceil(quiet_s / dt - 1e-9)


def _line(run: Run, substeps: int, quiet_s: float, first_row: int, wait: bool) -> tuple[float, ...]:
    """A run as the core takes it: numbers only. Its motion begins at ``first_row`` of the ground."""
    pier, base, motion = run.pier, run.base, run.motion
    dt = float(motion.dt)
    timing = (dt, substeps, _quiet_samples(quiet_s, dt), first_row, motion.npts, patience(pier, dt) if wait else 0)
    if isinstance(base, RigidBase):
        return rigid.run_line(block(pier, base), 0.0, 0.0, *timing)
    read = readings(pier, base, dt) if wait else (0, 0)
    return two_springs.run_line(springs(pier, base), *timing, *read, prestress(pier, base))


def written_run(
    run: Run,
    substeps: int,
    quiet_s: float,
    rows: int,
    locate: bool = True,
    every_step: bool = False,
    wait: bool = True,
) -> tuple[SpringRun | RigidRun, np.recarray]:
    """One run, and its history of at most ``rows`` rows; with ``every_step`` also between samples."""
    stop = Stop()
    if run.base.restraints and isinstance(run.base, RigidBase):
        found = restrained(run, substeps, quiet_s, stop, wait, rows, every_step)
        return found.run, rows_of(found)
    if run.base.restraints:
        written = np.recarray(rows, ROW)
        on_springs = restrained_on_springs(run, substeps, quiet_s, stop, wait, written, every_step)
        assert on_springs.run is not None
        return on_springs.run, with_notes(written, on_springs)
    lines, ground = [_line(run, substeps, quiet_s, 0, wait)], ground_of(run.motion)
    if isinstance(run.base, RigidBase):
        written = np.recarray(rows, rigid.ROW)
        result = rigid.rock_side_by_side(lines, ground, stop.flag, locate, every_step, written)[0]
        return rigid.rigid_run(result), written
    m = springs(run.pier, run.base)
    written = np.recarray(rows, ROW)
    result = two_springs.rock_side_by_side(
        two_springs.traits_of(m), lines, ground, stop.flag, locate, every_step, written
    )[0]
    return two_springs.spring_run(result), written


def restrained(
    run: Run, substeps: int, quiet_s: float, stop: Stop, wait: bool, rows: int = 0, every_step: bool = False
) -> Restrained:
    """One run on a rigid base with dampers and tendons; its status is RUNNING if it was stopped."""
    pier, base, motion = run.pier, run.base, run.motion
    assert isinstance(base, RigidBase)
    dt = float(motion.dt)
    vertical = () if motion.vertical is None else motion.vertical
    return rock_restrained(
        block(pier, base),
        elements(pier, base),
        pier.inertia_about_pivot,
        (motion.horizontal, vertical, dt),
        substeps,
        _quiet_samples(quiet_s, dt),
        stop.flag,
        patience(pier, dt) if wait else 0,
        rows=rows,
        every_step=every_step,
    )


def restrained_on_springs(
    run: Run,
    substeps: int,
    quiet_s: float,
    stop: Stop,
    wait: bool,
    history: np.recarray = NO_HISTORY,
    every_step: bool = False,
) -> RestrainedOnSprings:
    """One run on springs with dampers and tendons."""
    pier, base, motion = run.pier, run.base, run.motion
    assert not isinstance(base, RigidBase)
    vertical = () if motion.vertical is None else motion.vertical
    line, ground = _line(run, substeps, quiet_s, 0, wait), (motion.horizontal, vertical, float(motion.dt))
    return rock_restrained_on_springs(
        springs(pier, base), line, elements(pier, base), ground, stop.flag, history, every_step
    )


def with_notes(rows: np.recarray, found: RestrainedOnSprings) -> np.recarray:
    """The history of a run on springs with what its elements are: as :func:`rows_of`, and their force and moment on the pier."""
    n = len(found.use)
    kind = np.dtype([
        *ROW.descr, ("state", "f8", (n,)), ("lost", "f8", (n,)), ("input", "f8"), ("p_delta", "f8"), ("pull", "f8", (2,)),
    ])  # fmt: skip
    noted = np.recarray(len(rows), kind)
    for name in ROW.names or ():
        noted[name] = rows[name]
    noted.state, noted.lost = found.notes[:, :n], found.notes[:, n : 2 * n]
    noted.input, noted.p_delta, noted.pull = found.notes[:, 2 * n], found.notes[:, 2 * n + 1], found.notes[:, -2:]
    return noted


def rows_of(found: Restrained) -> np.recarray:
    """The history of a restrained run by names: of each element its state and what it has lost, and the ground's work."""
    n = len(found.use)
    kind = np.dtype([*rigid.ROW.descr, ("state", "f8", (n,)), ("lost", "f8", (n,)), ("input", "f8")])
    rows = np.recarray(len(found.history), kind)
    rows.t, rows.theta, rows.omega, rows.kind = found.history[:, :COLUMNS].T
    rows.state, rows.lost = found.history[:, COLUMNS : COLUMNS + n], found.history[:, COLUMNS + n : COLUMNS + 2 * n]
    rows.input = found.history[:, -1]
    return rows


def run_fixed(
    pier: Pier, base: Base, motion: Motion, substeps: int, quiet_s: float = 2.0, locate: bool = True, wait: bool = True
) -> Outcome:
    """Run with ``substeps`` steps per sample, without an error estimate; see :func:`run_all_fixed`."""
    outcome = run_all_fixed([Run(pier, base, motion)], [substeps], quiet_s, Stop(), locate, wait)[0]
    assert outcome is not None
    return outcome


def run_all_fixed(
    runs: Sequence[Run],
    substeps: Sequence[int],
    quiet_s: float,
    stop: Stop,
    locate: bool = True,
    wait: bool = True,
) -> list[Outcome | None]:
    """Runs with given steps per sample, side by side, in the order of ``runs``; ``None`` for those that were stopped.

    What a run comes to does not depend on those beside it. With ``locate=False`` events take place at the end of their
    step: first order, for comparison only. With ``wait=False`` a run ends ``quiet_s`` after its record, whatever the
    pier then does. A step beyond the method's stability is not run; the outcome says how many it takes.
    """
    return [None if trial is None else trial.outcome for trial in try_all(runs, substeps, quiet_s, stop, locate, wait)]


def try_all(
    runs: Sequence[Run],
    substeps: Sequence[int],
    quiet_s: float,
    stop: Stop,
    locate: bool = True,
    wait: bool = True,
) -> list[Trial | None]:
    """As :func:`run_all_fixed`, with the trajectories in short."""
    trials: list[Trial | None] = [_refused(run, steps, quiet_s) for run, steps in zip(runs, substeps, strict=True)]
    alike: dict[Traits | Literal["restrained"] | None, list[int]] = {}
    for i, run in enumerate(runs):
        if trials[i] is None:
            alike.setdefault(_kernel_of(run), []).append(i)
    for i in alike.pop(RESTRAINED, []):
        if not stop:
            trials[i] = _restrained_trial(runs[i], substeps[i], quiet_s, stop, wait)
    for kernel, which in alike.items():
        assert not isinstance(kernel, str)
        first_rows: dict[int, int] = {}
        grounds: list[Samples] = []
        lines = []
        for i in which:
            motion = runs[i].motion
            if id(motion) not in first_rows:
                first_rows[id(motion)] = sum(map(len, grounds))
                grounds.append(ground_of(motion))
            lines.append(_line(runs[i], substeps[i], quiet_s, first_rows[id(motion)], wait))
        ground = grounds[0] if len(grounds) == 1 else np.concatenate(grounds)
        for i, (found, extremes) in zip(which, _rock(kernel, lines, ground, stop, locate), strict=True):
            if found is not None:
                trials[i] = Trial(_outcome(runs[i], substeps[i], found), extremes)
    return trials


def _rock(
    kernel: Traits | None,
    lines: Sequence[tuple[float, ...]],
    ground: Samples,
    stop: Stop,
    locate: bool,
) -> Iterator[tuple[SpringRun | RigidRun | None, Samples]]:
    """What runs alike come to, ``None`` for those that were stopped, and the greatest |θ| in each of their windows."""
    if kernel is None:
        for result in rigid.rock_side_by_side(lines, ground, stop.flag, locate):
            yield None if result.status == RUNNING else rigid.rigid_run(result), result.extremes
        return
    for result in two_springs.rock_side_by_side(kernel, lines, ground, stop.flag, locate):
        yield None if result.status == RUNNING else two_springs.spring_run(result), result.extremes


def _restrained_trial(run: Run, substeps: int, quiet_s: float, stop: Stop, wait: bool) -> Trial | None:
    """One run with dampers and tendons, with what they have been through; ``None`` if it was stopped."""
    if not isinstance(run.base, RigidBase):
        on_springs = restrained_on_springs(run, substeps, quiet_s, stop, wait)
        if on_springs.run is None:
            return None
        outcome = _at_rest(run, on_springs, _outcome(run, substeps, on_springs.run))
        return Trial(replace(outcome, **_use(run, on_springs.use)), on_springs.extremes)
    found = restrained(run, substeps, quiet_s, stop, wait)
    if found.run.status == RUNNING:
        return None
    outcome = _outcome(run, substeps, found.run)
    if outcome.status == "ok" and found.theta_end != 0.0 and math.isnan(found.run.t_rest) and found.sticks:
        note = f"dampers hold the pier at a rotation of {found.theta_end:.3g} rad"
        outcome = replace(outcome, note="; ".join(filter(None, (outcome.note, note))))
    return Trial(replace(outcome, **_use(run, found.use)), found.extremes)


def _at_rest(run: Run, found: RestrainedOnSprings, outcome: Outcome) -> Outcome:
    """With the residual rotation at which dampers and tendons let the pier rest."""
    assert not isinstance(run.base, RigidBase)
    assert found.run is not None
    if outcome.theta_res is None:
        return outcome
    rests = rests_at(run.pier, run.base, found, found.run.base_left, found.run.base_right)
    note = outcome.note
    if abs(rests - outcome.theta_res) > TOLD * run.pier.alpha:
        told = f"dampers and tendons hold the pier at {rests:.3g} rad, its supports would at {outcome.theta_res:.3g}"
        note = "; ".join(filter(None, (note, told)))
    return replace(outcome, theta_res=rests, note=note)


def _use(run: Run, use: np.recarray) -> dict[str, Any]:
    """What dampers and tendons have been through, by the fields of Outcome; None of what there is not."""
    kinds = np.array([each.kind for each in elements(run.pier, run.base)])
    dampers, tendons = use[kinds != TENDON].view(np.recarray), use[kinds == TENDON].view(np.recarray)
    found: dict[str, Any] = {}
    if len(dampers):
        found["damper_force"] = float(np.maximum(dampers.most, -dampers.least).max()) / run.pier.gravity
        found["damper_stroke"] = float(dampers.stroke.max())
        found["damper_speed"] = float(dampers.speed.max())
        found["damper_energy"] = float(dampers.lost.sum())
    if len(tendons):
        found["tendon_force"] = float(tendons.most.max()) / run.pier.gravity
        found["tendon_yield"] = float(tendons.yielded.max())
        found["tendon_slack"] = int(tendons.slack.sum())
    return found


def _kernel_of(run: Run) -> Traits | Literal["restrained"] | None:
    """What runs that share compiled code have in common: the types of springs; whether dampers and tendons restrain them."""
    if run.base.restraints:
        return RESTRAINED
    if isinstance(run.base, RigidBase):
        return None
    traits = two_springs.traits_of(springs(run.pier, run.base))
    if traits.exponent is None:
        return traits
    return traits._replace(exponent=1 if isinstance(traits.exponent, int) else 0.5)  # numbers that differ: 1 == 1.0


def _refused(run: Run, substeps: int, quiet_s: float) -> Trial | None:
    """What a run comes to that is not to be run, else ``None``."""
    pier, base, motion = run.pier, run.base, run.motion
    least = least_substeps(pier, base, motion.dt)
    if substeps < least:
        return _not_run(
            f"{substeps} substeps of a sample of {motion.dt:g} s are too few for the springs' frequency: "
            f"the integration would blow up; at least {least}, better {first_substeps(pier, base, motion.dt)}",
            substeps,
        )
    steps = steps_of(motion, substeps, quiet_s)
    if steps > MOST_STEPS:
        return _not_run(
            f"would take {steps:.0e} steps, more than {MOST_STEPS:.0e}; shorten the record or quiet_s", substeps
        )
    return None


def _outcome(run: Run, substeps: int, found: SpringRun | RigidRun) -> Outcome:
    """Outcome of what a run came to, as it was found."""
    pier, omega_v, t_impact, zeta = run.pier, None, math.nan, 0.0
    status, reason = _STATUS[found.status]
    more: dict[str, Any] = {}
    if isinstance(found, SpringRun):
        assert not isinstance(run.base, RigidBase)
        more = _of_springs(run, found, survived=status == "ok")
        omega_v, t_impact, zeta = vertical_frequency(pier, run.base), found.t_impact, run.base.zeta or 0.0
    if found.status == FLIGHT:
        reason = cause_of_flight(run.motion, omega_v, pier.gravity, found.t_flight, t_impact, zeta)
    note = ""
    if found.status == RESTLESS:
        note = _RESTLESS.format(seconds=found.t_end - run.motion.duration)
    elif found.status == LATE_FLIGHT:
        note = _LATE_FLIGHT.format(t=found.t_end)
    return Outcome(
        status=status,
        reason=reason,
        theta_max=min(found.theta_max, ON_ITS_SIDE),
        t_max=found.t_max,
        impacts=found.impacts,
        separations=found.separations if isinstance(found, SpringRun) else found.lift_offs,
        t_flight=None if math.isnan(found.t_flight) else found.t_flight,
        t_end=found.t_end,
        substeps=substeps,
        note=note,
        **more,
    )


def _of_springs(run: Run, found: SpringRun, survived: bool) -> dict[str, Any]:
    """What only piers on springs have: residuals where the pier ``survived``, and what became of yielding springs."""
    pier, base = run.pier, run.base
    assert not isinstance(base, RigidBase)
    more: dict[str, Any] = {}
    if survived:
        # From the base's tilt to the rotation, static on the deformed base (THEORY.md, eq. 20)
        omega_v = vertical_frequency(pier, base)
        lean = 1.0 / tilt_over_residual(pier.gravity, pier.height, pier.half_width, omega_v)
        tilt = 0.5 * (found.base_left - found.base_right) / pier.half_width
        more |= {"settlement": -0.5 * (found.base_left + found.base_right), "base_tilt": tilt, "theta_res": lean * tilt}
        if isinstance(base, YieldingBase):
            more["t_read"] = found.t_read
            if not math.isnan(found.drift_left):
                more["settlement_drift"] = -0.5 * (found.drift_left + found.drift_right)
                more["theta_res_drift"] = 0.5 * lean * (found.drift_left - found.drift_right) / pier.half_width
    if isinstance(base, YieldingBase):
        deflection = yield_deflection(pier, base)
        more["ductility_left"] = -found.deepest_left / deflection
        more["ductility_right"] = -found.deepest_right / deflection
        more["dissipated_left"] = found.dissipated_left
        more["dissipated_right"] = found.dissipated_right
    return more


def _not_run(reason: str, substeps: int) -> Trial:
    return Trial(Outcome("failed", reason, math.nan, math.nan, 0, 0, None, 0.0, substeps), np.empty(0))


def steps_of(motion: Motion, substeps: int, quiet_s: float) -> float:
    """Number of steps of a run to the end of its quiet time."""
    return substeps * (motion.npts + quiet_s / motion.dt)
