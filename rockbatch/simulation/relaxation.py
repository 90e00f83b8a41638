"""How far dampers on supports still let a pier turn while its vibration dies away: a share of the error of θ_res.

See THEORY.md, Results of a run.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from rockbatch.core.devices.laws import FRICTION, HYSTERETIC, MAXWELL, Element
from rockbatch.motions.motion import Samples
from rockbatch.outcome.outcome import Outcome
from rockbatch.pier.places import holds_a_tilt
from rockbatch.simulation.chaos import MARGIN
from rockbatch.simulation.elements import elements
from rockbatch.simulation.recording import recorded
from rockbatch.simulation.restraints import (
    AT_REST,
    at_rest,
    level_at_rest,
    reach_at_rest,
    static_rotation,
    stiffness_at_rest,
)
from rockbatch.simulation.runs import Run

FURTHER = 20.0
"""Time in 1/p for which a run goes on."""

PARTS = 4
"""Equal parts of that time, by which the decay of the vibration is measured."""

AHEAD = 1000
"""Number of such parts for which the vibration is extrapolated, some hours: without damping it would last for ever."""


class Slipping(NamedTuple):
    """Hysteretic dampers after the end of a run: time [s] since then, shape (rows,), and of shape (rows, dampers) slip [m],
    |speed| [m/s] and |z|.
    """

    t: Samples
    slip: Samples
    speed: Samples
    force: Samples


def with_relaxation(run: Run, outcome: Outcome) -> Outcome:
    """Return ``outcome`` with the further change of the residual rotation in its error, as dampers slip or stick.

    The run goes on for 20/p (:data:`FURTHER`). Twice the change until then is taken (:data:`MARGIN`), and a bound of that later:
    by :func:`further_slip`, or by the loss of all force that hysteretic dampers have left. Unchanged without an error, without
    dampers that keep a force at rest, and of a pier that came to rest upright on rigid ground.
    """
    pier, base = run.pier, run.base
    if outcome.theta_res_error is None or outcome.theta_res is None or not holds_a_tilt(base.restraints):
        return outcome
    if outcome.theta_res == 0.0 and not base.on_springs:
        return outcome
    t_end = outcome.t_end + FURTHER / pier.p
    longer = recorded(run, outcome.changed(t_end=t_end), t_end - run.motion.duration, every_step=False)
    rows, level = longer.rows, level_at_rest(pier, base, longer.rows)
    rest = static_rotation(pier, base, longer.result, level, rows.state[-1], _sticks(run, rows[-1]))
    slipping = _slipping(run, rows[rows.t >= outcome.t_end])
    by_slip, by_force = _turns(run, level, rows[-1])
    greatest = slipping.force[slipping.t >= 0.5 * slipping.t[-1]].max(axis=0)
    left = float(by_force @ greatest) if base.on_springs else abs(rest)
    if slipping.t[-1] > 0.0:  # no late flight has stopped the run
        left = min(float(by_slip @ further_slip(slipping, decays(run))), left)
    return outcome.changed(theta_res_error=outcome.theta_res_error + MARGIN * abs(rest - outcome.theta_res) + left)


def further_slip(during: Slipping, damped: bool) -> Samples:
    """Return a bound of the slip [m] of each damper after the last row, shape (dampers,).

    If the vibration is ``damped``, travel in equal times falls geometrically, by the greatest ratio of two of the :data:`PARTS`
    that follow each other; else it does not fall. Slip over travel is at most that in the last part, since force and vibration
    decrease; :data:`MARGIN` times that is taken.
    """
    part = np.minimum(during.t / during.t[-1] * PARTS, PARTS - 1).astype(int)
    steps = 0.5 * np.diff(during.t)[:, None] * (during.speed[1:] + during.speed[:-1])
    travel = np.array([steps[part[1:] == number].sum(axis=0) for number in range(PARTS)])
    ratios = np.divide(travel[1:], travel[:-1], out=np.ones_like(travel[1:]), where=travel[:-1] > 0.0)
    falls = np.minimum(ratios.max(axis=0), 1.0) if damped else np.ones(travel.shape[1])
    ahead = (falls ** np.arange(1, AHEAD + 1)[:, None]).sum(axis=0)  # over the last part
    return MARGIN * ahead * np.ptp(during.slip[part == PARTS - 1], axis=0)


def decays(run: Run) -> bool:
    """Return True if rocking decays geometrically in the end: by dashpots, or by viscous dampers that are linear at low speed.

    Hysteresis alone damps ever less.
    """
    if run.base.on_springs and run.base.zeta:
        return True
    laws = elements(run.pier, run.base)
    linear = [law for law in laws if law.slope > 0.0 or (law.kind == MAXWELL and law.exponent == 1.0)]
    return any(law.height != 0.0 or law.offset != 0.0 or not run.base.on_springs for law in linear)


def _hysteretic(run: Run) -> tuple[list[int], list[Element]]:
    """Return the numbers of hysteretic dampers among the devices, and their Elements."""
    laws = elements(run.pier, run.base)
    numbers = [j for j, law in enumerate(laws) if law.kind == HYSTERETIC]
    return numbers, [laws[j] for j in numbers]


def _reaches(run: Run, laws: Sequence[Element], theta: float) -> Samples:
    """Return ∂e/∂v and ∂e/∂θ [m] of devices at rest at ``theta`` [rad], shape (devices, 2)."""
    return np.array([reach_at_rest(run.pier, run.base, law, theta) for law in laws]).reshape(-1, 2)


def _sticks(run: Run, row: np.record) -> np.ndarray:
    """Return True for each friction damper that sticks in a ``row``, shape (devices,)."""
    laws, moves = elements(run.pier, run.base), AT_REST * run.pier.size * run.pier.alpha * run.pier.p
    rubs = np.array([law.kind == FRICTION for law in laws])
    return rubs & (np.abs(_reaches(run, laws, row.theta) @ (row.v_rate, row.omega)) <= moves)


def _slipping(run: Run, rows: np.recarray) -> Slipping:
    """Return the hysteretic dampers in ``rows``; their elongations are linear, as at rest."""
    numbers, laws = _hysteretic(run)
    reaches = _reaches(run, laws, rows["theta"][-1]).T
    soft = np.array([(1.0 + law.give) / law.stiffness for law in laws])  # elastic elongation at z = 1 [m]
    z = rows["state"][:, numbers]
    slip = np.column_stack((rows["v"], rows["theta"])) @ reaches - soft * z
    speed = np.column_stack((rows["v_rate"], rows["omega"])) @ reaches
    return Slipping(rows["t"] - rows["t"][0], slip, np.abs(speed), np.abs(z))


def _turns(run: Run, level: float, row: np.record) -> tuple[Samples, Samples]:
    """Return the |rotation| at rest by a unit of slip of each hysteretic damper [1/m], and by all of its force [rad].

    In the latter no hysteretic damper has stiffness. Tendons and stops bear as in the ``row``; ``level`` is v at rest [m].
    """
    laws = elements(run.pier, run.base)
    reaches = _reaches(run, laws, row.theta)
    extended = reaches @ (row.v - level, row.theta)
    stiff = np.array([at_rest(law, u, z, 0.0)[1] for law, u, z in zip(laws, extended, row.state, strict=True)])
    yields = np.array([law.kind == HYSTERETIC for law in laws])
    bare = stiffness_at_rest(run.pier, run.base, row.theta) + (reaches[~yields].T * stiff[~yields]) @ reaches[~yields]
    dampers, tangents = reaches[yields].T, stiff[yields]
    strengths = np.array([law.strength for law in _hysteretic(run)[1]])
    by_slip = np.linalg.solve(bare + (dampers * tangents) @ dampers.T, dampers)[1] * tangents
    return np.abs(by_slip), np.abs(np.linalg.solve(bare, dampers)[1] * strengths)
