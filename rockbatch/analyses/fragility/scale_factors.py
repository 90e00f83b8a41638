"""Factors on the records of a fragility: which one each record takes at each level, and which are beyond the study's limits."""

from collections.abc import Sequence

import numpy as np

from rockbatch.analyses.fragility.runs import LevelPlan
from rockbatch.analyses.fragility.study import FragilitySpec
from rockbatch.batch.listening import count
from rockbatch.common.lazy import pd
from rockbatch.study import Case

SCALES = "fragility_scales.csv"

FAR = 0.1
"""Relative distance of an intensity from its level from which a remark says so."""


def scales(
    plans: Sequence[LevelPlan], spec: FragilitySpec, names: Sequence[str], cases: Sequence[Case], varied: Sequence[str]
) -> "pd.DataFrame":
    """Return fragility_scales.csv: a row for each record and level that it is meant for, and each case where piers differ.

    ``unscaled`` is the intensity of the record as it was recorded, ``scale`` the factor on it, with that of the study's target,
    and ``intensity`` what it comes to; ``used`` is False where the factor is beyond the limits of the study.
    """
    of_cases: list[tuple[dict[str, object], LevelPlan]] = [({}, plans[0])]
    if spec.per_pier is not None:
        names_of: list[dict[str, object]] = [
            {"case": case.name, **{name: case.columns.get(name) for name in varied}} for case in cases
        ]
        of_cases = [*zip(names_of, plans, strict=True)]
    unit = {"measure": spec.label, "unit": spec.unit}
    rows = []
    for identity, plan in of_cases:
        for m, name in enumerate(names):
            record = {"record": name, **identity, **unit, "unscaled": plan.reached(m, 1.0 / plan.earlier[m])}
            for level, intensity in sorted((plan.used[m] | plan.not_used[m]).items()):
                scale, used = plan.factor(m, level), level in plan.used[m]
                rows.append(record | {"level": level, "intensity": intensity, "scale": scale, "used": used})
    return pd.DataFrame(rows)


def described_scales(plans: Sequence[LevelPlan], spec: FragilitySpec, names: Sequence[str]) -> dict[str, object]:
    """Return the factors for fragility.json: for each record those at all levels, None where it is not meant for one.

    The keys are ``records``, ``factors``, ``used``, ``limits`` and ``said``, in words; the first three are [] for a cloud, and
    for a measure relative to a pier.
    """
    if spec.method == "cloud" or spec.per_pier is not None:
        return {"records": [], "factors": [], "used": [], "limits": [None, None], "said": in_words(plans, spec)}
    plan = plans[0]
    factors, used = [], []
    for m in range(len(names)):
        intensities = plan.used[m] | plan.not_used[m]
        factors.append([plan.factor(m, x) if x in intensities else None for x in spec.levels])
        used.append([x in plan.used[m] for x in spec.levels])
    limits = [spec.least_scale or None, spec.most_scale if np.isfinite(spec.most_scale) else None]
    return {"records": list(names), "factors": factors, "used": used, "limits": limits, "said": in_words(plans, spec)}


def in_words(plans: Sequence[LevelPlan], spec: FragilitySpec) -> str:
    """Return "records are scaled by 0.5 to 4 (median 1.5)", or that they are taken as they were recorded if all factors are 1.

    With it are the levels that lose records to the limits on factors, and how many they keep, and the levels that given factors
    miss by more than FAR, a tenth.
    """
    plan = plans[0]
    factors = [each.factor(m, x) for each in plans for m, used in enumerate(each.used) for x in used]
    if min(factors) == max(factors) == 1.0:
        return "records are taken as they were recorded"
    parts = [f"records are scaled by {min(factors):.2g} to {max(factors):.2g} (median {np.median(factors):.2g})"]
    if spec.method == "cloud" and max(map(len, plan.used)) > 1:
        parts.append("each counts once at every scale")
    beyond = {x: sum(x in used for used in plan.not_used) for x in spec.levels}
    if any(beyond.values()):
        limits = f"{spec.least_scale:g} to {spec.most_scale:g}" if spec.least_scale else f"up to {spec.most_scale:g}"
        remaining = []
        for x, n in beyond.items():
            within = sum(x in used for used in plan.used)
            if n:
                remaining.append(f"{within} of {count(within + n, 'record')} at {x:g}")
        parts.append(f"factors {limits} are allowed, which leaves {', '.join(remaining)} {spec.unit}")
    far = []
    for x in () if spec.method == "cloud" else spec.levels:
        values = [by_level[x] for by_level in plan.used if x in by_level]
        if values and max(abs(y / x - 1.0) for y in values) > FAR:
            far.append(f"{min(values):.3g} to {max(values):.3g} at {x:g}")
    if far:
        parts.append(
            f"the given factors bring records to intensities away from their levels, {', '.join(far)} {spec.unit}: is "
            f"{spec.label} the measure of the selection?"
        )
    return "; ".join(parts)
