"""shocks.csv: effects of each shock of a sequence on a pier, a row for each shock of each run."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from rockbatch.common.lazy import pd
from rockbatch.motions import Motion
from rockbatch.observers.shocks import TABLE
from rockbatch.observers.shocks.outcome import ShockOutcome
from rockbatch.outcome.outcome import Outcome
from rockbatch.pier import Pier
from rockbatch.results.beside_peaks import present, read_beside

MEANING = {
    "shock": "its place in the sequence, from 1",
    "shock_record": "the record that it is",
    "start_s": "time of its first sample in the sequence [s]",
    "end_s": "time of its last sample [s]; the next shock begins a pause later",
    "shock_pga_g": "its peak horizontal acceleration as it was run, over g",
    "shock_status": "ok; overturned, or flight, if the run ended so before the next shock began; not reached; or failed",
    "theta_max_over_alpha": "greatest rotation over α from its first sample until the next shock begins, or the run ends",
    "theta_max_error": "estimated error of it over α: what halving the step still changed; empty with a fixed step",
    "t_max_s": "time of it [s]",
    "theta_res_over_alpha": "rotation over α at which the pier would rest when the next shock begins, or a pause after the last",
    "settlement_m": "mean settlement of the supports since the start, likewise [m]; peaks.csv has it at rest (residual_s)",
    "moving_over_alpha": "half the range of the rotation over α in the last quarter of the pause: 0 where the pier is at rest",
}
"""Columns behind those that name the run."""

_TEXTS = ("shock_record", "shock_status")


def shock_rows(motion: Motion, pier: Pier, outcomes: Sequence[ShockOutcome]) -> list[dict[str, Any]]:
    """Return a row for each shock of ``motion``, which has the scale of the run, by the columns of :data:`MEANING`."""
    rows = []
    for place, (shock, outcome) in enumerate(zip(motion.shocks, outcomes, strict=True), 1):
        first, last = round(shock.start / motion.dt), round(shock.end / motion.dt)
        pga = float(abs(motion.horizontal[first : last + 1]).max()) / pier.gravity
        alpha = pier.alpha
        rotation = outcome.theta_max / alpha, outcome.theta_max_error / alpha, outcome.t_max
        rest = outcome.theta_res / alpha, outcome.settlement, outcome.moving / alpha
        values = place, shock.name, shock.start, shock.end, pga, outcome.status, *rotation, *rest
        rows.append(dict(zip(MEANING, values, strict=True)))
    return rows


def of_run(motion: Motion, outcome: Outcome) -> "pd.DataFrame | None":
    """Return the rows of a run, in the columns of :data:`MEANING`; None unless its motion is a sequence."""
    return pd.DataFrame(list(outcome.tables.get(TABLE, ())), columns=list(MEANING)) if motion.shocks else None


OF_RESPONSE = ("shocks", of_run)
"""Field of :class:`rockbatch.Response`, and the function from the motion and outcome of a run to its table."""


def read(directory: Path, varied: Sequence[str]) -> "pd.DataFrame":
    """Return the table of a study that varies these keys; ``InputError`` without it, or if it is not as it was written."""
    return read_beside(present(directory / TABLE, "a [[motions.sequence]]"), varied, MEANING, _TEXTS)
