"""Fragility curves as they are written down: points and capacities as tables, fits and bands for fragility.json."""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from rockbatch.analysis.fragility import Curve
from rockbatch.analysis.ida import Bracket
from rockbatch.analysis.limit_states import words
from rockbatch.analysis.lognormal import Lognormal
from rockbatch.study import Study
from rockbatch.study.fragility import FragilitySpec

if TYPE_CHECKING:
    import pandas as pd

POINTS, CAPACITIES, RUNS = "fragility.csv", "fragility_capacities.csv", "fragility_runs.csv"
SAMPLES = 80
"""Of a curve and its band."""


def points(curves: Sequence[Curve], spec: FragilitySpec, varied: Sequence[str]) -> "pd.DataFrame":
    """fragility.csv: a row for each curve and level, with the counts of :class:`Stripe` as columns."""
    import pandas as pd

    rows = [
        _which(curve, varied) | {"measure": spec.label, "unit": spec.unit, **stripe._asdict()}
        for curve in curves
        for stripe in curve.stripes
    ]
    return pd.DataFrame(rows).rename(columns={"records": "n"})


def capacities(
    curves: Sequence[Curve], spec: FragilitySpec, varied: Sequence[str], names: Sequence[str], unscaled: Sequence[float]
) -> "pd.DataFrame":
    """fragility_capacities.csv: a row for each curve and record.

    A capacity is above ``above`` and at most ``at_most``, in the unit of the levels; the same as scales of the record.
    ``names`` and ``unscaled`` are those of the motions, and their intensities as they are.
    """
    import pandas as pd

    rows: list[dict[str, Any]] = []
    for curve in curves:
        for motion, one in curve.capacities:
            bounds = {"above": one.low, "at_most": math.nan if math.isinf(one.high) else one.high}
            rows.append(
                {"record": names[motion], **_which(curve, varied), "measure": spec.label, "unit": spec.unit}
                | {"found": _found(one), **bounds}
                | {f"scale_{name}": bound / unscaled[motion] for name, bound in bounds.items()}
                | {"returns": one.returns}
            )
    return pd.DataFrame(rows)


def _which(curve: Curve, varied: Sequence[str]) -> dict[str, Any]:
    columns = {name: curve.case.columns.get(name) for name in varied}
    return {"case": curve.case.name, **columns, "limit_state": curve.limit.name}


def _found(one: Bracket) -> str:
    if math.isinf(one.high):
        return "beyond the highest level"
    if one.low == 0:
        return "below the lowest level"
    return "undecided" if one.undecided else "exceeded"


def described(curves: Sequence[Curve], spec: FragilitySpec, study: Study, records: int) -> dict[str, Any]:
    """What fragility.json says: what was asked, and every curve; an open bound of an interval is null."""
    return {
        "method": spec.method,
        "measure": spec.label,
        "unit": spec.unit,
        "levels": spec.levels,
        "tolerance": spec.tolerance if spec.method == "ida" else None,
        "confidence": spec.confidence,
        "records": records,
        "polarities": study.motions.polarity,
        "curves": [_described(curve, spec) for curve in curves],
    }


def _described(curve: Curve, spec: FragilitySpec) -> dict[str, Any]:
    fitted, otherwise = curve.fitted, curve.otherwise
    told: dict[str, Any] = {
        "case": curve.case.name,
        "columns": curve.case.columns,
        "limit_state": curve.limit.name,
        "words": words(curve.limit),
        "reason": curve.limit.reason,
        "counting": curve.limit.counting,
        "median": None,
        "dispersion": None,
        "note": note(curve, spec),
        "median_undecided_withstand": otherwise.median if isinstance(otherwise, Lognormal) else None,
        "points": [stripe._asdict() for stripe in curve.stripes],
        "capacities": [_finite((one.low, one.high)) for _, one in curve.capacities],
    }
    if isinstance(fitted, Lognormal):
        x = np.linspace(0.0, 1.1 * spec.levels[-1], SAMPLES + 1)[1:]
        drawn = zip(("x", "p", "low", "high"), (x, fitted.probability(x), *fitted.band(x)), strict=True)
        told |= {
            "median": fitted.median,
            "median_interval": _finite(fitted.median_interval),
            "dispersion": fitted.dispersion,
            "dispersion_interval": _finite(fitted.dispersion_interval),
            "curve": {name: [round(float(value), 6) for value in values] for name, values in drawn},
        }
    return told


def _finite(bounds: tuple[float, float]) -> list[float | None]:
    """JSON has no infinity."""
    return [bound if math.isfinite(bound) else None for bound in bounds]


def note(curve: Curve, spec: FragilitySpec) -> str:
    """What to know about a curve, or why there is none."""
    fitted = curve.fitted
    notes = [fitted] if isinstance(fitted, str) else []
    if isinstance(fitted, Lognormal):
        if fitted.median > spec.levels[-1]:
            notes.append("the median is extrapolated beyond the highest level")
        elif fitted.median < spec.levels[0]:
            notes.append("the median is extrapolated below the lowest level")
        if any(math.isinf(bound) for bound in (*fitted.median_interval, *fitted.dispersion_interval)):
            notes.append("the records leave the intervals open: more of them, or other levels, would close them")
    if curve.otherwise is not None:
        counted = "undecided runs count as beyond the limit"
        if isinstance(curve.otherwise, Lognormal):
            counted += f"; as within it they would give a median of {curve.otherwise.median:.4g}"
        notes.append(counted)
    if returning := sum(one.returns > 0 for _, one in curve.capacities):
        notes.append(f"{returning} of {len(curve.capacities)} records withstand a level above their first exceedance")
    return "; ".join(notes)
