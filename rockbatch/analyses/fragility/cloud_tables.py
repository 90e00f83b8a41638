"""Output of a cloud analysis: the result of each run, and the line and the logistic part of each curve."""

from collections.abc import Sequence

import numpy as np

from rockbatch.analyses.fragility.cloud import Cloud
from rockbatch.analyses.fragility.curves import CloudPoint, Curve
from rockbatch.analyses.fragility.limit_states import EXCEEDED, LEFT_OUT, UNDECIDED
from rockbatch.analyses.fragility.quantities import FEW
from rockbatch.analyses.fragility.study import FragilitySpec
from rockbatch.batch.listening import count
from rockbatch.common.lazy import pd
from rockbatch.quantities.catalogue import DEMANDS

CLOUD = "fragility_cloud.csv"


def cloud_table(
    curves: Sequence[Curve], spec: FragilitySpec, varied: Sequence[str], names: Sequence[str]
) -> "pd.DataFrame":
    """Return fragility_cloud.csv: a row for each curve and run, with its ``demand`` and the ``limit``.

    The column ``counts`` says how it counts, as :func:`counts` does.
    """
    rows: list[dict[str, object]] = []
    for curve in curves:
        constants = curve.identity(varied) | {
            "measure": spec.label,
            "unit": spec.unit,
            "limit": curve.limit.threshold,
        }
        for run in curve.cloud:
            result = {"intensity": run.intensity, "demand": run.demand, "status": run.status}
            rows.append({"record": names[run.motion]} | constants | result | {"counts": counts(run, curve, spec)})
    return pd.DataFrame(rows)


def counts(run: CloudPoint, curve: Curve, spec: FragilitySpec) -> str:
    """Return how a run counts: "line", "overturned", "undecided", "left out" or "below"; for an event "exceeds" or "within".

    "below" is a demand below the share of the limit at which demands are censored. A run that ended normally counts as decided,
    even within its error of the limit.
    """
    if run.state == LEFT_OUT:
        return "left out"
    if run.state == UNDECIDED and run.status != "ok":
        return "undecided"
    if DEMANDS[curve.limit.demand].event:
        return "exceeds" if run.state == EXCEEDED else "within"
    if run.state == EXCEEDED and run.status == "overturned":
        return "overturned"
    return "line" if run.demand > spec.censored_below * curve.limit.threshold else "below"


def described_cloud(curve: Curve, spec: FragilitySpec) -> dict[str, object]:
    """Return the entry of a curve's cloud in fragility.json: limit, floor, demand, line, logistic and runs.

    Line and logistic part are None if the curve lacks them, the floor for an event.
    """
    fitted = curve.fitted
    line = fitted.line if isinstance(fitted, Cloud) else None
    share = fitted.overturning if isinstance(fitted, Cloud) else None
    event = DEMANDS[curve.limit.demand].event
    return {
        "limit": curve.limit.threshold,
        "floor": None if event else spec.censored_below * curve.limit.threshold,
        "demand": "" if event else curve.limit.demand,
        "line": None if line is None else {"ln_a": line.intercept, "b": line.slope, "sigma": line.sigma},
        "logistic": None if share is None else {"alpha_0": share.intercept, "alpha_1": share.slope},
        "runs": [_described_run(run, curve, spec) for run in curve.cloud],
    }


def _described_run(run: CloudPoint, curve: Curve, spec: FragilitySpec) -> dict[str, object]:
    """Return the entry of a run in fragility.json; its demand is None unless finite."""
    demand = run.demand if np.isfinite(run.demand) else None
    return {"x": run.intensity, "demand": demand, "counts": counts(run, curve, spec)}


def note_on_cloud(curve: Curve, spec: FragilitySpec) -> list[str]:
    """Return remarks on a cloud's curve, if fewer than FEW, 3, records exceed the limit, none overturns, some count as small."""
    notes = []
    beyond = sum(run.state == EXCEEDED for run in curve.cloud)
    if beyond < FEW:
        extrapolated = (
            f"{count(beyond, 'record')} of {len(curve.cloud)} exceed" if beyond != 1 else "one record exceeds"
        )
        notes.append(
            f"only {extrapolated} the limit: the curve extrapolates; add stronger records, or scale in [motions]"
        )
    if isinstance(curve.fitted, Cloud) and curve.fitted.overturning is None:
        notes.append("no record overturns: their share counts as 0 at every intensity")
    below = sum(counts(run, curve, spec) == "below" for run in curve.cloud)
    if below:
        notes.append(
            f"{count(below, 'record')} below {100 * spec.censored_below:g} % of the limit are censored: they count as small"
        )
    return notes
