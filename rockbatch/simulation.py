"""One pier on one base under one motion: the door to the core, and error control."""

import math
from dataclasses import replace
from threading import Event
from typing import Any

import numpy as np

from rockbatch.core.outcome import ON_ITS_SIDE
from rockbatch.core.rigid_base import HISTORY_COLUMNS as RIGID_COLUMNS
from rockbatch.core.rigid_base import rock_on_rigid_base
from rockbatch.core.two_springs import HISTORY_COLUMNS as SPRINGS_COLUMNS
from rockbatch.core.two_springs import rock_on_springs
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
    CHATTER: ("failed", "more than 20,000 contact events within one step; use more substeps or another epsilon"),
    NOT_FINITE: ("failed", "the integration blew up; use more substeps, or look for a spike in the record"),
    UNDECIDED: ("failed", "left alone after the record, the pier stays at the point of overturning"),
}

_NO_SAMPLES = np.empty(0)


def springs(pier: Pier, base: ElasticBase) -> Springs:
    """What the core takes for ``pier`` on springs: plain floats, per unit mass."""
    eta, law, exponent = 1.0, ELASTIC, 1.0  # an elastic spring is measured by its static force and deflection
    if isinstance(base, YieldingBase):
        eta, exponent = base.eta, base.n
        law = BOUC_WEN if base.spring == "bouc-wen" else EPP
    omega_v = base.beta * pier.p
    return Springs(
        half_width=float(pier.half_width),
        height=float(pier.height),
        inertia=float(pier.inertia),
        gravity=float(pier.gravity),
        yield_deflection=float(eta * pier.gravity / omega_v**2),
        yield_force=float(0.5 * eta * pier.gravity),
        exponent=float(exponent),
        epsilon=float(base.epsilon),
        law=law,
        finite=base.kinematics == "finite",
        guided=base.flight == "guided",
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


def packed(motion: Motion) -> tuple[Samples, Samples, float]:
    """A motion as the core takes it: contiguous float64 arrays, the vertical one empty for none, and the interval.

    Any other type or layout would silently compile the kernels once more.
    """
    horizontal = np.ascontiguousarray(motion.horizontal, dtype=np.float64)
    vertical = _NO_SAMPLES
    if motion.vertical is not None:
        vertical = np.ascontiguousarray(motion.vertical, dtype=np.float64)
    return horizontal, vertical, float(motion.dt)


def _quiet_samples(quiet_s: float, dt: float) -> int:
    return math.ceil(quiet_s / dt - 1e-9)


def call_springs(
    pier: Pier,
    base: Any,
    motion: Motion,
    substeps: int,
    quiet_s: float,
    rows: int = 0,
    locate: bool = True,
    every_step: bool = False,
) -> tuple[SpringRun, Samples]:
    """Run on two springs, and its history of at most ``rows`` rows; with ``every_step`` also between samples."""
    horizontal, vertical, dt = packed(motion)
    quiet = _quiet_samples(quiet_s, dt)
    history = np.empty((rows, SPRINGS_COLUMNS))
    run = rock_on_springs(springs(pier, base), horizontal, vertical, dt, substeps, quiet, history, locate, every_step)
    return run, history


def call_rigid_base(
    pier: Pier,
    base: Any,
    motion: Motion,
    substeps: int,
    quiet_s: float,
    rows: int = 0,
    locate: bool = True,
    every_step: bool = False,
) -> tuple[RigidRun, Samples]:
    """Run on a rigid base from rest, and its history as :func:`call_springs` has it."""
    horizontal, vertical, dt = packed(motion)
    quiet = _quiet_samples(quiet_s, dt)
    history = np.empty((rows, RIGID_COLUMNS))
    m = block(pier, base)
    run = rock_on_rigid_base(m, 0.0, 0.0, horizontal, vertical, dt, substeps, quiet, history, locate, every_step)
    return run, history


def run_fixed(
    pier: Pier, base: Base, motion: Motion, substeps: int, quiet_s: float = 2.0, locate: bool = True
) -> Outcome:
    """Run with ``substeps`` steps per sample, without an error estimate.

    With ``locate=False`` events take place at the end of their step: first order, for comparison only. A step beyond
    the method's stability is not run; the outcome says how many it takes.
    """
    least = least_substeps(pier, base, motion.dt)
    if substeps < least:
        reason = (
            f"{substeps} substeps of a sample of {motion.dt:g} s are too few for the springs' frequency: "
            f"the integration would blow up; at least {least}, better {first_substeps(pier, base, motion.dt)}"
        )
        return _not_run(reason, substeps)
    steps = steps_of(motion, substeps, quiet_s)
    if steps > MOST_STEPS:
        return _not_run(
            f"would take {steps:.0e} steps, more than {MOST_STEPS:.0e}; shorten the record or quiet_s", substeps
        )
    if isinstance(base, RigidBase):
        rigid, _ = call_rigid_base(pier, base, motion, substeps, quiet_s, locate=locate)
        status, reason = _STATUS[rigid.status]
        return Outcome(
            status=status,
            reason=reason,
            theta_max=min(rigid.theta_max, ON_ITS_SIDE),
            t_max=rigid.t_max,
            impacts=rigid.impacts,
            separations=rigid.lift_offs,
            t_flight=_known(rigid.t_flight),
            t_end=rigid.t_end,
            substeps=substeps,
        )
    run, _ = call_springs(pier, base, motion, substeps, quiet_s, locate=locate)
    status, reason = _STATUS[run.status]
    outcome = Outcome(
        status=status,
        reason=reason,
        theta_max=min(run.theta_max, ON_ITS_SIDE),
        t_max=run.t_max,
        impacts=run.impacts,
        separations=run.separations,
        t_flight=_known(run.t_flight),
        t_end=run.t_end,
        substeps=substeps,
    )
    if run.status == SURVIVED:
        tilt = 0.5 * (run.base_left - run.base_right) / pier.half_width
        stiffness = (base.beta * pier.p * pier.half_width) ** 2
        outcome = replace(
            outcome,
            settlement=-0.5 * (run.base_left + run.base_right),
            base_tilt=tilt,
            theta_res=tilt / (1.0 - pier.gravity * pier.height / stiffness),
        )
    if isinstance(base, YieldingBase):
        yield_deflection = base.eta * pier.gravity / (base.beta * pier.p) ** 2
        outcome = replace(
            outcome,
            ductility_left=-run.deepest_left / yield_deflection,
            ductility_right=-run.deepest_right / yield_deflection,
            dissipated_left=run.dissipated_left,
            dissipated_right=run.dissipated_right,
        )
    return outcome


def _not_run(reason: str, substeps: int) -> Outcome:
    return Outcome("failed", reason, math.nan, math.nan, 0, 0, None, 0.0, substeps)


def steps_of(motion: Motion, substeps: int, quiet_s: float) -> float:
    """Number of steps of a run to the end of its quiet time."""
    return substeps * (motion.npts + quiet_s / motion.dt)


def _known(value: float) -> float | None:
    return None if math.isnan(value) else value


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


def run_to_tolerance(
    pier: Pier, base: Base, motion: Motion, tolerance: float, quiet_s: float = 2.0, stop: Event | None = None
) -> Outcome:
    """Run with ever smaller steps until two results agree to ``tolerance`` on θ_max/α and θ_res/α.

    The finer result is kept, and the difference is its estimated error: the coarser one's, hence on the safe side.
    Where no plastic base remembers every impact, on rigid and elastic bases, their counts have to agree too. The
    first step respects the springs' frequency (:data:`FREQUENCY_STEP`): two coarse runs that agree prove nothing
    otherwise. A run that has not settled after :data:`HALVINGS`, or would take more than :data:`MOST_STEPS`, keeps its
    best values and fails with the reason. Once ``stop`` is set, there is no further try, and ``InterruptedError``.
    """
    coarse = run_fixed(pier, base, motion, first_substeps(pier, base, motion.dt), quiet_s)
    for _ in range(HALVINGS):
        if stop is not None and stop.is_set():
            raise InterruptedError("stopped between two tries of a run")
        steps = steps_of(motion, 2 * coarse.substeps, quiet_s)
        if steps > MOST_STEPS:
            return _not_settled(coarse, tolerance * pier.alpha, f"; the next try would take {steps:.0e} steps")
        fine = _with_errors(run_fixed(pier, base, motion, 2 * coarse.substeps, quiet_s), coarse, pier.alpha)
        if _settled(fine, coarse, tolerance * pier.alpha):
            return fine
        coarse = fine
    return _not_settled(coarse, tolerance * pier.alpha, "")


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
