"""How far dampers on supports, or a bed that yields, still let a pier turn while it comes to rest: a share of residuals' errors.

See THEORY.md, Results of a run.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from rockbatch.core.devices.laws import FRICTION, HYSTERETIC, MAXWELL, VISCOUS, Element
from rockbatch.motions.motion import Samples
from rockbatch.outcome.outcome import Outcome
from rockbatch.pier import FootingBase
from rockbatch.pier.places import holds_a_tilt
from rockbatch.simulation.chaos import MARGIN
from rockbatch.simulation.elements import elements
from rockbatch.simulation.open_ends import swing_after_peak
from rockbatch.simulation.restraints import at_rest, reach_at_rest, stiffness_at_rest, stiffness_of_supports
from rockbatch.simulation.runs import End, Run, Stop, Trial, try_all
from rockbatch.simulation.steps import fastest_rate

FURTHER, FURTHER_WITH_FRICTION = 5.0, 20.0
"""Time in 1/p for which a run goes on: with friction dampers until most of them hold."""

SWINGS, LASTING = 4.0, 40.0
"""Periods of free rocking from its peak within which a pier on a footing may still yield it, and time in 1/p for which it goes
on then, as long as one on yielding springs is waited for."""

AHEAD = 1000.0
"""Most such times that are counted after it, some hours: without damping, vibration would last for ever."""


def add_relaxation(
    runs: Sequence[Run], outcomes: list[Outcome | None], trials: Mapping[int, Trial], stop: Stop
) -> None:
    """Add to the errors of residual rotations in ``outcomes``, in place, what dampers may still change as they slip or stick.

    Of each run ``trials`` has one, which goes on for :func:`further` if there is an error, and dampers that keep a force at rest;
    not if the pier stands upright on rigid ground, or friction holds it. The outcome of a run that is stopped becomes None.
    """
    moving = [i for i, trial in trials.items() if _may_turn(runs[i], outcomes[i], trial)]
    tails = [trials[i].outcome.t_end - runs[i].motion.duration + further(runs[i]) for i in moving]
    substeps = [trials[i].outcome.substeps for i in moving]
    for i, later in zip(moving, try_all([runs[i] for i in moving], substeps, tails, stop, wait=False), strict=True):
        outcome = outcomes[i]
        outcomes[i] = None if outcome is None or later is None else _with_relaxation(runs[i], outcome, trials[i], later)


def add_later_yield(
    runs: Sequence[Run], outcomes: list[Outcome | None], trials: Mapping[int, Trial], stop: Stop
) -> None:
    """Add to the errors of residuals and of plastic work in ``outcomes``, in place, what a footing's bed yields after the run.

    Each run that ends soon after its peak goes on for :data:`LASTING`/p, with the steps of its trial in ``trials``; twice
    (:data:`MARGIN`) the change is added. The outcome of a run that is stopped becomes None.
    """
    yielding = [i for i in trials if _may_yield(runs[i], outcomes[i])]
    tails = [trials[i].outcome.t_end - runs[i].motion.duration + LASTING / runs[i].pier.p for i in yielding]
    substeps = [trials[i].outcome.substeps for i in yielding]
    for i, later in zip(yielding, try_all([runs[i] for i in yielding], substeps, tails, stop, wait=False), strict=True):
        outcome, before = outcomes[i], trials[i].outcome
        if outcome is None or later is None:
            outcomes[i] = None
            continue
        changes: dict[str, object] = {}
        for name in ("theta_res", "settlement"):
            after, known = getattr(later.outcome, name), getattr(outcome, f"{name}_error")
            if after is not None and known is not None:
                changes[f"{name}_error"] = known + MARGIN * abs(after - getattr(before, name))
        bed, ahead = outcome.bed, later.outcome.bed
        if bed is not None and bed.work_error is not None and ahead is not None and before.bed is not None:
            changes["bed"] = replace(bed, work_error=bed.work_error + MARGIN * abs(ahead.work - before.bed.work))
        outcomes[i] = outcome.changed(**changes)


def _may_yield(run: Run, outcome: Outcome | None) -> bool:
    """Return True if ``outcome`` has errors of residuals on a footing whose bed may yield further after the end of the run.

    That is within :data:`SWINGS` periods of free rocking from the peak.
    """
    if (
        outcome is None
        or outcome.theta_res_error is None
        or not (isinstance(run.base, FootingBase) and run.base.yields)
    ):
        return False
    return outcome.t_end - outcome.t_max < SWINGS * swing_after_peak(run.pier, outcome.theta_max)


def further(run: Run) -> float:
    """Return the time [s] for which a run goes on."""
    rubs = any(law.kind == FRICTION for law in elements(run.pier, run.base))
    return (FURTHER_WITH_FRICTION if rubs else FURTHER) / run.pier.p


def _may_turn(run: Run, outcome: Outcome | None, trial: Trial) -> bool:
    """Return True if ``outcome`` has the error of a residual rotation that dampers may change after the end of ``trial``."""
    base, end = run.base, trial.end
    if outcome is None or outcome.theta_res_error is None or not holds_a_tilt(base.restraints):
        return False
    if end is None or (outcome.theta_res == 0.0 and not base.on_springs):
        return False
    laws = elements(run.pier, base)
    if base.bends or any(law.kind == MAXWELL for law in laws):  # the force on friction that sticks still changes
        return True
    freedoms = 2 if base.on_springs else 1
    return int(np.linalg.matrix_rank(_reaches(run, laws, end.position[1])[end.sticks])) < freedoms


def _with_relaxation(run: Run, outcome: Outcome, trial: Trial, later: Trial) -> Outcome:
    """Return ``outcome`` with twice (:data:`MARGIN`) the change from ``trial`` to a ``later`` one, and a bound of that after it.

    After it each hysteretic damper slips by at most twice the :func:`share_ahead` of its slip between both ends, or all lose all
    of their force; friction that slides at the later end may get its whole force as it sticks. On rigid ground the pier can at
    most stand up.
    """
    assert trial.end is not None
    laws, end = elements(run.pier, run.base), later.end or trial.end  # the later trial may take too many steps
    reaches = _reaches(run, laws, end.position[1])
    by_slip, by_force = _turns(run, laws, reaches, end)
    yields, rubs = (np.array([law.kind == kind for law in laws]) for kind in (HYSTERETIC, FRICTION))
    soft = np.array(
        [(1.0 + law.give) / law.stiffness for law in laws if law.kind == HYSTERETIC]
    )  # ∂e/∂z [m] without slip
    ends = [trial.end, end]
    moving = [each.states[yields] for each in ends]
    resting = [z + reaches[yields] @ (e.rest - e.position) / soft for z, e in zip(moving, ends, strict=True)]
    bound, change = float(by_force[yields] @ np.abs([*moving, *resting]).max(axis=0)), 0.0
    went_on = later.outcome.t_end - trial.outcome.t_end
    if went_on > 0.0 and later.outcome.theta_res is not None:  # it went on, and no late flight ended it
        change = abs(later.outcome.theta_res - (trial.outcome.theta_res or 0.0))
        slip = np.abs(reaches[yields] @ (end.rest - trial.end.rest) - soft * (resting[1] - resting[0]))
        ahead = MARGIN * share_ahead(decay_rate(run, trial.outcome) * went_on)
        bound = min(ahead * float(by_slip[yields] @ slip), bound)
    bound += float(by_force[rubs & ~end.sticks].sum())
    if not run.base.on_springs:
        bound = min(bound, abs(float(end.rest[1])))
    return outcome.changed(theta_res_error=(outcome.theta_res_error or 0.0) + MARGIN * change + bound)


def share_ahead(exponent: float) -> float:
    """Return what comes after an interval over what came in it, of what falls by exp(−``exponent``) in each interval."""
    return 1.0 / max(math.expm1(exponent), 1.0 / AHEAD)


def decay_rate(run: Run, outcome: Outcome) -> float:
    """Return the least decay rate [1/s] of rocking about its rest by dashpots, and by viscous dampers at speeds of ``outcome``.

    0 without either, or with dampers of exponent > 1 alone: they damp ever less, as hysteresis does.
    """
    pier, base, speed = run.pier, run.base, outcome.damper_speed or 0.0
    laws = elements(pier, base)
    inertia = pier.inertia + pier.height**2 if base.on_springs else pier.inertia_about_pivot
    damping = 0.0
    if base.on_springs and base.zeta:
        whole, rocking = stiffness_of_supports(pier, base)
        damping = 2.0 * base.zeta * rocking / math.sqrt(whole)
    for law, reach in zip(laws, _reaches(run, laws, outcome.theta_res or 0.0), strict=True):
        if law.kind == VISCOUS and law.exponent <= 1.0 and speed > 0.0:
            damping += min(law.coefficient * speed ** (law.exponent - 1.0), law.slope) * reach[1] ** 2
        elif law.kind == MAXWELL and law.exponent == 1.0:
            damping += law.coefficient / (1.0 + (fastest_rate(pier, base) / law.quickest) ** 2) * reach[1] ** 2
    return 0.5 * damping / inertia


def _reaches(run: Run, laws: Sequence[Element], theta: float) -> Samples:
    """Return ∂e/∂v and ∂e/∂θ [m] of devices at rest at ``theta`` [rad], shape (devices, 2)."""
    return np.array([reach_at_rest(run.pier, run.base, law, theta) for law in laws])


def _turns(run: Run, laws: Sequence[Element], reaches: Samples, end: End) -> tuple[Samples, Samples]:
    """Return the |rotation| at rest by a unit of slip of each hysteretic damper [1/m], and by the whole force of each one [rad].

    Both have a number for each device; friction has a force alone, with which no hysteretic damper has stiffness. Tendons and
    stops bear as at the ``end``.
    """
    extended = reaches @ (end.position - (end.level, 0.0))
    stiff = np.array([at_rest(law, u, z, 0.0)[1] for law, u, z in zip(laws, extended, end.states, strict=True)])
    forces = np.array([law.strength if law.kind in (HYSTERETIC, FRICTION) else 0.0 for law in laws])
    lasting = np.where([law.kind == HYSTERETIC for law in laws], 0.0, stiff)
    supports = stiffness_at_rest(run.pier, run.base, end.position[1])
    by_slip, by_force = (
        np.abs(np.linalg.solve(supports + (reaches.T * each) @ reaches, reaches.T)[1]) for each in (stiff, lasting)
    )
    return by_slip * stiff, by_force * forces
