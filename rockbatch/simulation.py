"""One pier on one base under one motion: the door to the core, and error control."""

import math
from dataclasses import replace
from typing import Any

import numpy as np

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
from rockbatch.structure import Base, ElasticBase, Pier, RigidBase, YieldingBase

FREQUENCY_STEP = 0.2
"""Largest ω_v h of a first run; the second, with half the step, is then below 0.1, where outcomes were never wrong."""

HALVINGS = 8
"""How often the step is halved before a run counts as not settled."""

_STATUS = {
    SURVIVED: ("ok", ""),
    OVERTURNED: ("overturned", ""),
    FLIGHT: ("flight", ""),
    CHATTER: ("failed", "more than 20,000 contact events within one step; use more substeps or another epsilon"),
    NOT_FINITE: ("failed", "the integration left the range of numbers; use more substeps"),
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


def _packed(motion: Motion, quiet_s: float) -> tuple[Samples, Samples, float, int]:
    """A motion as the core takes it: contiguous float64 arrays, the interval, and the samples of rest after it.

    Any other type or layout would silently compile the kernels once more.
    """
    horizontal = np.ascontiguousarray(motion.horizontal, dtype=np.float64)
    vertical = _NO_SAMPLES
    if motion.vertical is not None:
        vertical = np.ascontiguousarray(motion.vertical, dtype=np.float64)
    return horizontal, vertical, float(motion.dt), math.ceil(quiet_s / motion.dt - 1e-9)


def call_springs(
    pier: Pier, base: Any, motion: Motion, substeps: int, quiet_s: float, rows: int = 0, locate: bool = True
) -> tuple[SpringRun, Samples]:
    """Run on two springs, and its history of at most ``rows`` rows."""
    horizontal, vertical, dt, quiet = _packed(motion, quiet_s)
    history = np.empty((rows, SPRINGS_COLUMNS))
    run = rock_on_springs(springs(pier, base), horizontal, vertical, dt, substeps, quiet, history, locate)
    return run, history


def call_rigid_base(
    pier: Pier, base: Any, motion: Motion, substeps: int, quiet_s: float, rows: int = 0, locate: bool = True
) -> tuple[RigidRun, Samples]:
    """Run on a rigid base from rest, and its history of at most ``rows`` rows."""
    horizontal, vertical, dt, quiet = _packed(motion, quiet_s)
    history = np.empty((rows, RIGID_COLUMNS))
    restitution = housner_restitution(pier) if base.restitution is None else base.restitution
    block = Block(float(pier.alpha), float(pier.p), float(pier.gravity), float(restitution))
    run = rock_on_rigid_base(block, 0.0, 0.0, horizontal, vertical, dt, substeps, quiet, history, locate)
    return run, history


def run_fixed(
    pier: Pier, base: Base, motion: Motion, substeps: int, quiet_s: float = 2.0, locate: bool = True
) -> Outcome:
    """Run with ``substeps`` steps per sample, without an error estimate.

    With ``locate=False`` events take place at the end of their step: first order, for comparison only.
    """
    if isinstance(base, RigidBase):
        rigid, _ = call_rigid_base(pier, base, motion, substeps, quiet_s, locate=locate)
        status, reason = _STATUS[rigid.status]
        return Outcome(
            status=status,
            reason=reason,
            theta_max=rigid.theta_max,
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
        theta_max=run.theta_max,
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


def _known(value: float) -> float | None:
    return None if math.isnan(value) else value


def first_substeps(pier: Pier, base: Base, dt: float) -> int:
    """Steps per sample [of ``dt`` s] that the model's highest frequency asks for."""
    if isinstance(base, RigidBase):
        return 1
    return max(1, math.ceil(base.beta * pier.p * dt / FREQUENCY_STEP))


def run_to_tolerance(pier: Pier, base: Base, motion: Motion, tolerance: float, quiet_s: float = 2.0) -> Outcome:
    """Run with ever smaller steps until two results agree to ``tolerance`` on θ_max/α; the finer one is kept.

    The first step respects ω_v (:data:`FREQUENCY_STEP`): two coarse runs that agree prove nothing otherwise. A run
    that has not settled after :data:`HALVINGS` keeps its best values and fails with the reason.
    """
    coarse = run_fixed(pier, base, motion, first_substeps(pier, base, motion.dt), quiet_s)
    error = math.inf
    for _ in range(HALVINGS):
        fine = run_fixed(pier, base, motion, 2 * coarse.substeps, quiet_s)
        error = abs(fine.theta_max - coarse.theta_max) / pier.alpha
        if fine.status != coarse.status:
            error = math.inf
        elif fine.status == "overturned":  # its greatest rotation is where the run ended
            return fine
        elif error <= tolerance:
            return replace(fine, theta_max_error=error * pier.alpha)
        coarse = fine
    if coarse.status == "failed":
        return coarse
    change = f"theta_max/alpha by {error:.1e}" if math.isfinite(error) else "its outcome"
    reason = (
        f"not settled: the last halving of the step changed {change}; at {coarse.substeps} substeps: {coarse.status}"
    )
    return replace(coarse, status="failed", reason=reason)
