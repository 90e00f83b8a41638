"""The check that a target spectrum asks of a suite: the mean over the target, everywhere in its range."""

import math
from collections.abc import Iterable, Mapping
from typing import Any

from rockbatch.checks.verdicts import FAIL, MEAN_OVER_TARGET, PASS, Verdict

NAMES = {"target": "suite to target", "vertical_target": "suite to vertical target"}
"""Names of the checks, by the entries of run.json on both targets."""

_ROUNDING = 1e-4  # relative: run.json has five digits of either spectrum


def suite_verdicts(info: Mapping[str, Any], scales: Iterable[float]) -> list[Verdict]:
    """Return whether the suite reaches its targets, those that ask it to, as run.json (``info``) has them.

    It is judged as it was fitted if that was run; else with the greatest of ``scales``, the factors that the study puts on top.
    There is no verdict on a suite without a record that is fitted.
    """
    factors = sorted(set(scales)) or [1.0]
    factor = 1.0 if 1.0 in factors else factors[-1]
    note = "" if factors == [1.0] else "as fitted, at scale 1" if factor == 1.0 else f"at scale {factor:g}"
    targets = {name: info.get(key) for key, name in NAMES.items()}
    return [
        _verdict(name, target, factor, note)
        for name, target in targets.items()
        if target is not None and target.get("required", target["factors"] != "none") and any(target["mean_sa_g"])
    ]


def _verdict(name: str, target: Mapping[str, Any], factor: float, note: str) -> Verdict:
    least, period = least_over_target(target)
    value = factor * least
    limit = float(target["at_least"])
    if math.isclose(value, limit, rel_tol=_ROUNDING):
        value = limit
    low, high = target["range_s"]
    return Verdict(
        check=name,
        case="",
        columns={},
        scale=1.0,
        demand=MEAN_OVER_TARGET,
        statistic="",
        words="mean spectrum of the suite over its target",
        records=0,
        runs=0,
        value=value,
        low=value,
        high=value,
        sense="at least",
        limit=limit,
        ratio=limit / value if value > 0.0 else math.inf,
        margin=value - limit,
        verdict=PASS if value >= limit else FAIL,
        basis="study",
        reason=f"{target['spectrum']}, between {low:g} s and {high:g} s",
        counting="",
        counted="",
        note="; ".join(filter(None, (f"least at T = {period:.3g} s", note))),
    )


def least_over_target(target: Mapping[str, Any]) -> tuple[float, float]:
    """Return the least ratio of the mean spectrum to the target, and its period [s]."""
    rows = zip(target["period_s"], target["sa_g"], target["mean_sa_g"], strict=False)
    return min(((mean / sa, period) for period, sa, mean in rows if sa > 0.0), default=(0.0, math.nan))
