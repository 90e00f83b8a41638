"""Rocking and lean of a pier: rotation about its rest position, and that rest position (THEORY.md, Results of a run)."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from rockbatch.motions.motion import Samples
from rockbatch.outcome.outcome import LEANS, Outcome
from rockbatch.pier import ElasticBase, Pier, YieldingBase, tilt_over_residual, vertical_frequency, yield_deflection
from rockbatch.simulation.recording import recorded_side_by_side
from rockbatch.simulation.runs import Run, Stop
from rockbatch.simulation.starting import unstressed_at_rest

MOSTLY = 0.5
"""Least lean over θ_max, and greatest rocking at the peak over the greatest rocking, for a peak to count as lean."""

PARTS = 8
"""Parts of the interval between two rows in the search for the greatest rocking."""


class Apart(NamedTuple):
    """Rocking and lean of a run [rad].

    ``rocking`` is the greatest |θ − lean|, at ``t`` [s]; ``lean`` is the lean at the peak of |θ|, positive to its side, and
    ``rocking_then`` the remainder of the peak.
    """

    rocking: float
    t: float
    lean: float
    rocking_then: float

    @property
    def leans(self) -> bool:
        """Return True if lean is MOSTLY, half, of the peak or more, and its rocking less than half of the greatest."""
        return self.lean >= MOSTLY * (self.lean + self.rocking_then) and self.rocking_then < MOSTLY * self.rocking


class Path(NamedTuple):
    """Columns of a history, of a pier on springs, from which its lean follows."""

    t: Samples
    theta: Samples
    omega: Samples
    v: Samples
    z_left: Samples
    z_right: Samples
    left: Samples
    right: Samples


def may_lean(outcome: Outcome) -> bool:
    """Return True if the greatest rotation may be mostly lean: the pier stands, and rests at half of it or more."""
    return outcome.status == "ok" and abs(outcome.theta_res or 0.0) >= MOSTLY * outcome.theta_max > 0.0


def apart(pier: Pier, base: ElasticBase, rows: np.recarray) -> Apart:
    """Return the greatest swing about the lean of a yielded base, and lean and swing at the peak, from ``rows`` of a run."""
    path = Path(*(np.ascontiguousarray(rows[name]) for name in Path._fields))  # columns are read many times
    theta, lean, t = path.theta, lean_of(pier, base, path), path.t
    swing = theta - lean
    peak = int(np.abs(theta).argmax())
    side = np.sign(theta[peak])
    return Apart(*greatest_swing(t, theta, path.omega, swing), float(side * lean[peak]), float(side * swing[peak]))


def greatest_swing(t: Samples, theta: Samples, omega: Samples, swing: Samples) -> tuple[float, float]:
    """Return the greatest |``swing``| [rad] and its time [s], also between rows; θ − ``swing`` is taken as linear there."""
    h, size = np.diff(t), np.abs(swing)
    greatest = size.argmax()
    most, instant = float(size[greatest]), float(t[greatest])
    turned = np.diff(theta)
    first, last = (h * rate - turned for rate in (omega[:-1], omega[1:]))
    near = np.flatnonzero(np.maximum(size[:-1], size[1:]) + np.maximum(np.abs(first), np.abs(last)) > most)
    for s in np.arange(1, PARTS) / PARTS:  # θ is cubic between rows
        between = (1.0 - s) * swing[near] + s * swing[near + 1]
        rocking = np.abs(between + s * (1.0 - s) * ((1.0 - s) * first[near] - s * last[near]))
        if len(rocking) and rocking.max() > most:
            most, instant = float(rocking.max()), float(t[near[rocking.argmax()]] + s * h[near[rocking.argmax()]])
    return most, instant


def lean_of(pier: Pier, base: ElasticBase, rows: np.recarray | Path) -> Samples:
    """Return the static rest rotation [rad] on the base as deformed at every row (THEORY.md, eq. 20)."""
    left, right = unstressed(pier, base, rows)
    b = pier.half_width
    return (
        0.5
        * (left - right)
        / b
        / tilt_over_residual(pier.gravity, base.leaning_height(pier), b, vertical_frequency(pier, base))
    )


def unstressed(pier: Pier, base: ElasticBase, rows: np.recarray | Path) -> tuple[Samples, Samples]:
    """Return the unstressed positions of the left and the right support at every row [m], up from those at rest."""
    b, h, theta = pier.half_width, pier.height, rows.theta
    rise: Samples = b * theta
    drop: float | Samples = 0.0
    if base.kinematics == "finite":
        rise, drop = b * np.sin(theta), h * (1.0 - np.cos(theta))
    deflection = yield_deflection(pier, base)
    at_first = unstressed_at_rest(pier, base)  # what the first loading leaves under the weight is no effect of the run
    left = _last_borne(rows.v + rise + drop - deflection * rows.z_left, rows.left != 0.0, at_first) - at_first
    right = _last_borne(rows.v - rise + drop - deflection * rows.z_right, rows.right != 0.0, at_first) - at_first
    return left, right


def _last_borne(unstressed: Samples, borne: Samples, at_first: float) -> Samples:
    """Return the unstressed position of a support [m]; without contact it keeps the last one, or ``at_first``."""
    if borne.all():
        return unstressed
    last = np.maximum.accumulate(np.where(borne, np.arange(len(borne)), -1))
    return np.where(last < 0, at_first, unstressed[last])


def noted_lean(outcome: Outcome, parts: Apart, alpha: float) -> Outcome:
    """Return ``outcome`` with a note, and ``theta_max_is``, if its peak is mostly lean; else unchanged. ``alpha`` is α [rad]."""
    if outcome.status != "ok" or not parts.leans:
        return outcome
    remark = (
        f"theta_max is mostly lean: the base leaned by {parts.lean / alpha:.4f} alpha then; the pier rocked about it by "
        f"{parts.rocking_then / alpha:.4f} alpha, and by {parts.rocking / alpha:.4f} alpha at most, at {parts.t:.2f} s"
    )
    return outcome.noted(remark, theta_max_is=LEANS)


def with_lean(
    runs: Sequence[Run], outcomes: Sequence[Outcome], quiet_s: float, wait: bool = True, stop: Stop | None = None
) -> list[Outcome]:
    """Return ``outcomes`` with a note on those on yielding springs whose peak is mostly lean.

    After the record the rocking does not grow, so that a run to the end of its quiet time, a quarter of the whole, rules most
    candidates out. Runs that are too long to be recorded are not changed, nor those that come after ``stop``.
    """
    noted = list(outcomes)
    mixed = [i for i, run in enumerate(runs) if isinstance(run.base, YieldingBase) and may_lean(outcomes[i])]
    early = [i for i in mixed if noted[i].t_max <= runs[i].motion.duration + quiet_s]
    of_record = _lean_of_runs(runs, noted, early, quiet_s, False, stop)
    mixed = [i for i in mixed if i not in early or (i in of_record and of_record[i].leans)]
    for i, parts in _lean_of_runs(runs, noted, mixed, quiet_s, wait, stop).items():
        noted[i] = noted_lean(noted[i], parts, runs[i].pier.alpha)
    return noted


def _lean_of_runs(
    runs: Sequence[Run],
    outcomes: Sequence[Outcome],
    numbers: Sequence[int],
    quiet_s: float,
    wait: bool,
    stop: Stop | None,
) -> dict[int, Apart]:
    """Return rocking and lean by the ``numbers`` of runs on springs, those too long to be recorded left out."""
    chosen, their = [runs[i] for i in numbers], [outcomes[i] for i in numbers]
    parts = {}
    for j, recording in recorded_side_by_side(chosen, their, quiet_s, wait, stop):
        base = chosen[j].base
        assert isinstance(base, ElasticBase)
        parts[numbers[j]] = apart(chosen[j].pier, base, recording.rows)
    return parts
