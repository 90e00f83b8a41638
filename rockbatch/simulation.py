"""Piers on bases under motions: the door to the core, and error control."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

import numpy as np

from rockbatch.core import rigid_base, two_springs
from rockbatch.core.ground import ground_rows
from rockbatch.core.outcome import ON_ITS_SIDE
from rockbatch.core.types import (
    BOUC_WEN,
    CHATTER,
    ELASTIC,
    EPP,
    FLIGHT,
    NOT_FINITE,
    OVERTURNED,
    SURVIVED,
    UNDECIDED,
    Block,
    RigidRun,
    SpringRun,
    Springs,
)
from rockbatch.motions.motion import Motion, Samples
from rockbatch.outcome import Outcome
from rockbatch.structure import Base, ElasticBase, Pier, RigidBase, YieldingBase, highest_frequency

FREQUENCY_STEP = 0.2
"""Largest ω h of a first run; the second, with half the step, is then below 0.1, where outcomes were never wrong."""

STABLE_STEP = 2.0
"""Largest ω h that is run at all: Runge–Kutta 4 blows up an oscillator beyond 2√2."""

HALVINGS = 8
"""How often the step is halved before a run counts as not settled."""

MOST_STEPS = 1e8
"""Steps that a run may take to settle, about a quarter of a minute of work."""

ROUNDING = 1e-12
"""Least error of θ/α that is ever claimed."""

_STATUS = {
    SURVIVED: ("ok", ""),
    OVERTURNED: ("overturned", ""),
    FLIGHT: ("flight", ""),
    CHATTER: ("failed", "more than 20,000 contact events within one sample; use more substeps or another epsilon"),
    NOT_FINITE: ("failed", "the integration blew up; use more substeps, or look for a spike in the record"),
    UNDECIDED: ("failed", "left alone after the record, the pier stays at the point of overturning"),
}


@dataclass(frozen=True)
class Scene:
    """What is simulated: a pier on a base under a motion."""

    pier: Pier
    base: Base
    motion: Motion


class Stop:
    """Ends, in their kernels, the runs of other threads that were given it."""

    def __init__(self) -> None:
        self.flag = np.zeros(1, np.uint8)

    def set(self) -> None:
        self.flag[0] = 1

    def __bool__(self) -> bool:
        return bool(self.flag[0])


@lru_cache(maxsize=4096)
def springs(pier: Pier, base: ElasticBase) -> Springs:
    """What the core takes for ``pier`` on springs: plain floats, per unit mass."""
    eta, law, exponent = 1.0, ELASTIC, None  # an elastic spring is measured by its static force and deflection
    if isinstance(base, YieldingBase):
        eta, law = base.eta, BOUC_WEN if base.spring == "bouc-wen" else EPP
        exponent = float(base.n) if law == BOUC_WEN and base.n != 5 else None
    omega_v = base.beta * pier.p
    return Springs(
        half_width=float(pier.half_width),
        height=float(pier.height),
        inertia=float(pier.inertia),
        gravity=float(pier.gravity),
        yield_deflection=float(eta * pier.gravity / omega_v**2),
        stiffness=float(omega_v**2 / (eta * pier.gravity)),
        yield_force=float(0.5 * eta * pier.gravity),
        epsilon=float(base.epsilon),
        law=law,
        guided=float(base.flight == "guided"),
        exponent=exponent,
        finite=True if base.kinematics == "finite" else None,
    )


def housner_restitution(pier: Pier) -> float:
    """e = 1 − 2μ/(1+μ) sin²α: the angular momentum about the new pivot is conserved (Housner 1963).

    A pier so stocky that this is negative would have to turn back through the corner that it has just landed on: it
    stops, e = 0.
    """
    return max(0.0, 1.0 - 2.0 * pier.mu / (1.0 + pier.mu) * math.sin(pier.alpha) ** 2)


def block(pier: Pier, base: RigidBase) -> Block:
    """What the core takes for ``pier`` on a rigid base: plain floats."""
    restitution = housner_restitution(pier) if base.restitution is None else base.restitution
    return Block(float(pier.alpha), float(pier.p), float(pier.gravity), float(restitution))


def ground_of(motion: Motion) -> Samples:
    """A motion as the core takes it, shape (npts, 4); see :func:`rockbatch.core.ground.ground_rows`."""
    vertical = () if motion.vertical is None else motion.vertical
    return ground_rows(motion.horizontal, vertical, float(motion.dt))


def _quiet_samples(quiet_s: float, dt: float) -> int:
    return math.ceil(quiet_s / dt - 1e-9)


def _line(scene: Scene, substeps: int, quiet_s: float, first_row: int) -> tuple[float, ...]:
    """A run as the core takes it: numbers only. Its motion begins at ``first_row`` of the ground."""
    motion = scene.motion
    dt = float(motion.dt)
    timing = (dt, substeps, _quiet_samples(quiet_s, dt), first_row, motion.npts)
    if isinstance(scene.base, RigidBase):
        return rigid_base.run_line(block(scene.pier, scene.base), 0.0, 0.0, *timing)
    return two_springs.run_line(springs(scene.pier, scene.base), *timing)


def written_run(
    scene: Scene, substeps: int, quiet_s: float, rows: int, locate: bool = True, every_step: bool = False
) -> tuple[SpringRun | RigidRun, Samples]:
    """One run, and its history of at most ``rows`` rows; with ``every_step`` also between samples."""
    lines, ground, stop = np.array([_line(scene, substeps, quiet_s, 0)]), ground_of(scene.motion), Stop().flag
    if isinstance(scene.base, RigidBase):
        history = np.empty((rows, rigid_base.HISTORY_COLUMNS))
        result = rigid_base.rock_one_by_one(lines, ground, stop, locate, every_step, history)[0]
        return rigid_base.rigid_run(result), history
    m = springs(scene.pier, scene.base)
    history = np.empty((rows, two_springs.HISTORY_COLUMNS))
    result = two_springs.rock_side_by_side(m.exponent, m.finite, lines, ground, stop, locate, every_step, history)[0]
    return two_springs.spring_run(result), history


def run_fixed(
    pier: Pier, base: Base, motion: Motion, substeps: int, quiet_s: float = 2.0, locate: bool = True
) -> Outcome:
    """Run with ``substeps`` steps per sample, without an error estimate; see :func:`run_all_fixed`."""
    outcome = run_all_fixed([Scene(pier, base, motion)], [substeps], quiet_s, Stop(), locate)[0]
    assert outcome is not None
    return outcome


def run_all_fixed(
    scenes: Sequence[Scene], substeps: Sequence[int], quiet_s: float, stop: Stop, locate: bool = True
) -> list[Outcome | None]:
    """Runs with given steps per sample, side by side, in the order of ``scenes``; ``None`` for those that were stopped.

    What a run comes to does not depend on those beside it. With ``locate=False`` events take place at the end of their
    step: first order, for comparison only. A step beyond the method's stability is not run; the outcome says how many
    it takes.
    """
    outcomes: list[Outcome | None] = [
        _refused(scene, steps, quiet_s) for scene, steps in zip(scenes, substeps, strict=True)
    ]
    alike: dict[tuple[float | None, bool | None] | None, list[int]] = {}
    for i, scene in enumerate(scenes):
        if outcomes[i] is None:
            alike.setdefault(_kernel_of(scene), []).append(i)
    for kernel, which in alike.items():
        first_rows: dict[int, int] = {}
        grounds: list[Samples] = []
        lines = []
        for i in which:
            motion = scenes[i].motion
            if id(motion) not in first_rows:
                first_rows[id(motion)] = sum(map(len, grounds))
                grounds.append(ground_of(motion))
            lines.append(_line(scenes[i], substeps[i], quiet_s, first_rows[id(motion)]))
        ground = grounds[0] if len(grounds) == 1 else np.concatenate(grounds)
        if kernel is None:
            results = rigid_base.rock_one_by_one(np.array(lines), ground, stop.flag, locate)
        else:
            results = two_springs.rock_side_by_side(*kernel, np.array(lines), ground, stop.flag, locate)
        for i, result in zip(which, results.tolist(), strict=True):
            if not math.isnan(result[0]):
                outcomes[i] = _outcome(scenes[i], substeps[i], result)
    return outcomes


def _kernel_of(scene: Scene) -> tuple[float | None, bool | None] | None:
    """What runs that share compiled code have in common: types of the springs' exponent and kinematics, if any."""
    if isinstance(scene.base, RigidBase):
        return None
    m = springs(scene.pier, scene.base)
    return None if m.exponent is None else 1.0, m.finite


def _refused(scene: Scene, substeps: int, quiet_s: float) -> Outcome | None:
    """Outcome of a run that is not to be run, else ``None``."""
    pier, base, motion = scene.pier, scene.base, scene.motion
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


def _outcome(scene: Scene, substeps: int, result: Sequence[float]) -> Outcome:
    """Outcome of a line of results."""
    pier, base = scene.pier, scene.base
    code, t_end, theta_max, t_max, impacts, separations, t_flight = result[:7]
    status, reason = _STATUS[int(code)]
    more: dict[str, Any] = {}
    if not isinstance(base, RigidBase):
        base_left, base_right, deepest_left, deepest_right, dissipated_left, dissipated_right = result[7:13]
        if code == SURVIVED:
            tilt = 0.5 * (base_left - base_right) / pier.half_width
            stiffness = (base.beta * pier.p * pier.half_width) ** 2
            more["settlement"] = -0.5 * (base_left + base_right)
            more["base_tilt"] = tilt
            more["theta_res"] = tilt / (1.0 - pier.gravity * pier.height / stiffness)
        if isinstance(base, YieldingBase):
            yield_deflection = base.eta * pier.gravity / (base.beta * pier.p) ** 2
            more["ductility_left"] = -deepest_left / yield_deflection
            more["ductility_right"] = -deepest_right / yield_deflection
            more["dissipated_left"] = dissipated_left
            more["dissipated_right"] = dissipated_right
    return Outcome(
        status=status,
        reason=reason,
        theta_max=min(theta_max, ON_ITS_SIDE),
        t_max=t_max,
        impacts=int(impacts),
        separations=int(separations),
        t_flight=None if math.isnan(t_flight) else t_flight,
        t_end=t_end,
        substeps=substeps,
        **more,
    )


def _not_run(reason: str, substeps: int) -> Outcome:
    return Outcome("failed", reason, math.nan, math.nan, 0, 0, None, 0.0, substeps)


def steps_of(motion: Motion, substeps: int, quiet_s: float) -> float:
    """Number of steps of a run to the end of its quiet time."""
    return substeps * (motion.npts + quiet_s / motion.dt)


def first_substeps(pier: Pier, base: Base, dt: float) -> int:
    """Steps per sample [of ``dt`` s] that the model's highest frequency asks for."""
    return _substeps_for(FREQUENCY_STEP, pier, base, dt)


def least_substeps(pier: Pier, base: Base, dt: float) -> int:
    """Steps per sample [of ``dt`` s] below which the integration would blow up."""
    return _substeps_for(STABLE_STEP, pier, base, dt)


def _substeps_for(largest: float, pier: Pier, base: Base, dt: float) -> int:
    if isinstance(base, RigidBase):
        return 1
    return max(1, math.ceil(highest_frequency(pier, base) * dt / largest - 1e-9))


def run_to_tolerance(pier: Pier, base: Base, motion: Motion, tolerance: float, quiet_s: float = 2.0) -> Outcome:
    """Run with ever smaller steps; see :func:`run_all_to_tolerance`."""
    outcome = run_all_to_tolerance([Scene(pier, base, motion)], tolerance, quiet_s, Stop())[0]
    assert outcome is not None
    return outcome


def run_all_to_tolerance(scenes: Sequence[Scene], tolerance: float, quiet_s: float, stop: Stop) -> list[Outcome | None]:
    """Run each with ever smaller steps until two results agree to ``tolerance`` on θ_max/α and θ_res/α.

    The finer result is kept, and the difference is its estimated error: the coarser one's, hence on the safe side.
    Where no plastic base remembers every impact, on rigid and elastic bases, their counts have to agree too. The
    first step respects the springs' frequency (:data:`FREQUENCY_STEP`): two coarse runs that agree prove nothing
    otherwise. A run that has not settled after :data:`HALVINGS`, or would take more than :data:`MOST_STEPS`, keeps its
    best values and fails with the reason. ``None`` for those that were stopped.
    """
    settled: list[Outcome | None] = [None] * len(scenes)
    first = [first_substeps(scene.pier, scene.base, scene.motion.dt) for scene in scenes]
    coarse = dict(enumerate(run_all_fixed(scenes, first, quiet_s, stop)))
    for _ in range(HALVINGS):
        again: dict[int, Outcome] = {}
        for i, outcome in coarse.items():
            if outcome is None:
                continue
            steps = steps_of(scenes[i].motion, 2 * outcome.substeps, quiet_s)
            if steps > MOST_STEPS:
                more = f"; the next try would take {steps:.0e} steps"
                settled[i] = _not_settled(outcome, tolerance * scenes[i].pier.alpha, more)
            else:
                again[i] = outcome
        chosen = [scenes[i] for i in again]
        finer = run_all_fixed(chosen, [2 * outcome.substeps for outcome in again.values()], quiet_s, stop)
        coarse = {}
        for (i, before), fine in zip(again.items(), finer, strict=True):
            if fine is None:
                continue
            alpha = scenes[i].pier.alpha
            fine = _with_errors(fine, before, alpha)
            if _settled(fine, before, tolerance * alpha):
                settled[i] = fine
            else:
                coarse[i] = fine
        if not coarse:
            return settled
    for i, outcome in coarse.items():
        assert outcome is not None
        settled[i] = _not_settled(outcome, tolerance * scenes[i].pier.alpha, "")
    return settled


def _not_settled(finest: Outcome, tolerance: float, more: str) -> Outcome:
    """The finest run that there is, with its values, as one that failed; ``tolerance`` in rad."""
    if finest.status == "failed":
        return finest
    errors = (("theta_max", finest.theta_max_error), ("theta_res", finest.theta_res_error))
    changes = [f"{name} by {error:.1e} rad" for name, error in errors if error is not None and error > tolerance]
    what = " and ".join(changes) or "the outcome"
    reason = f"not settled: halving the step still changed {what}; at {finest.substeps} substeps: {finest.status}{more}"
    return replace(finest, status="failed", reason=reason)


def _with_errors(fine: Outcome, coarse: Outcome, alpha: float) -> Outcome:
    """``fine`` with what it changed against ``coarse``; rounding is the least that it can be wrong by."""
    if fine.status != coarse.status or fine.status in ("overturned", "failed"):  # θ_max is where the run ended
        return fine
    least = ROUNDING * alpha
    residual = None
    if fine.theta_res is not None and coarse.theta_res is not None:
        residual = max(abs(fine.theta_res - coarse.theta_res), least)
    return replace(fine, theta_max_error=max(abs(fine.theta_max - coarse.theta_max), least), theta_res_error=residual)


def _settled(fine: Outcome, coarse: Outcome, tolerance: float) -> bool:
    if fine.status != coarse.status or fine.status == "failed":
        return False
    forgets = fine.status == "ok" and fine.ductility_left is None  # an early peak tells nothing of what came after it
    if forgets and (fine.impacts, fine.separations) != (coarse.impacts, coarse.separations):
        return False
    return max(fine.theta_max_error or 0.0, fine.theta_res_error or 0.0) <= tolerance
