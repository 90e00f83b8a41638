"""Change of results by fewer strips of a bed, or fewer modes of a shaft: a share of every error."""

import math
from dataclasses import replace
from typing import Any

from rockbatch.outcome.outcome import Outcome
from rockbatch.pier import FootingBase, WithShaft
from rockbatch.simulation.beds import with_fewer_strips, with_strips_error
from rockbatch.simulation.runs import Run

FEWER_MODES = "with one mode of the shaft fewer it ends as {status}: no error of it is claimed"
_OF_SHAFT = ("theta_max", "deflection_max", "top_drift_max")


def with_fewer_modes(run: Run) -> Run | None:
    """Return a run with the shaft in one mode fewer; None if it does not bend, or in one alone."""
    base = run.base
    if not (isinstance(base, WithShaft) and base.bends):
        return None
    n = len(base.modes(run.pier).frequency)
    return Run(run.pier, replace(base, flexural_modes=n - 1), run.motion) if n > 1 else None


def coarser(run: Run) -> Run | None:
    """Return the run of a coarser model at the same step, of half as many strips or one mode fewer; None if there is none."""
    if isinstance(run.base, FootingBase):
        return Run(run.pier, with_fewer_strips(run.base), run.motion)
    return with_fewer_modes(run)


def with_model_error(outcome: Outcome, other: Outcome, chance: float) -> Outcome:
    """Return ``outcome`` with errors raised by the change from the coarser model's outcome ``other``.

    Of strips by a third of the change; of modes, which converge at no known order, by ``chance`` times the change.
    """
    return with_strips_error(outcome, other) if outcome.bed is not None else _with_modes_error(outcome, other, chance)


def _with_modes_error(outcome: Outcome, other: Outcome, chance: float) -> Outcome:
    if outcome.status != "ok":
        return outcome
    if other.status != outcome.status:
        unknown = {f"{name}_error": None for name in _OF_SHAFT}
        return outcome.noted(FEWER_MODES.format(status=other.status), **unknown)
    more: dict[str, Any] = {}
    for name in _OF_SHAFT:
        own, others, error = getattr(outcome, name), getattr(other, name), getattr(outcome, f"{name}_error")
        if error is not None:
            more[f"{name}_error"] = error + chance * abs(own - others)
    return outcome.changed(**more)


MOST_DAMPING = 0.1
"""Damping ratio of the last mode beyond which its forces at a blow give no bound for further modes."""


def of_last_mode(run: Run, change: float, chance: float) -> float:
    """Return the error of a force by the modes left out: ``chance`` times the relative ``change`` with one mode fewer.

    NaN if the last mode has more than :data:`MOST_DAMPING`: a blow stops the base at once, which the damping force 2 ζ_i ω_i
    u̇_i of every mode meets, and where ζ_i grows with ω_i, the sum has no limit.
    """
    base = run.base
    assert isinstance(base, WithShaft)
    return chance * change if base.damping_ratios(run.pier)[-1] <= MOST_DAMPING else math.nan
