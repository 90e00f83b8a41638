"""Rules held against results: pass, fail or not decided."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from rockbatch.checks.choices import chooses, unmet
from rockbatch.checks.demands import DEMANDS, FORCES, Case
from rockbatch.checks.rules import Rule
from rockbatch.checks.statistics import STATISTICS, Values
from rockbatch.checks.suite import OTHER_LAW, by_record, complete, counted, simulated, without_other_law
from rockbatch.checks.verdicts import DOES_NOT_APPLY, FAIL, NOT_DECIDED, PASS, Verdict
from rockbatch.errors import InputError
from rockbatch.toml.kinds import shown

if TYPE_CHECKING:
    import pandas as pd


NOT_WEIGHED = "the study does not say what the pier weighs"


def judge(
    rules: Sequence[Rule], peaks: "pd.DataFrame", cases: Sequence[Case], records: Sequence[str] = ()
) -> list[Verdict]:
    """Hold every rule against every case at every scale.

    Parameters
    ----------
    rules : sequence of Rule
    peaks : DataFrame
        Rows of peaks.csv; those without a case, of files that could not be used, are in no suite, and mirror images count
        once.
    cases : sequence of mappings
        ``cases`` of run.json, or some of them.
    records : sequence of str, optional
        Names of all records; a run that is missing counts as failed. By default those in ``peaks``.

    Raises
    ------
    InputError
        Where a rule asks for a case, scale, polarity or column that the results do not have.
    """
    runs = peaks[peaks["case"] != ""]
    if runs.empty:
        raise InputError("there is no run to check")
    planned = list(records) or list(runs["record"].unique())
    polarities, scales = list(runs["polarity"].unique()), [float(scale) for scale in runs["scale"].unique()]
    there: dict[str, Any] = {"scales": scales, "polarities": polarities, "other_law": OTHER_LAW in runs}
    there["forces"] = FORCES in runs
    there["cases"] = list(dict.fromkeys(str(case["case"]) for case in cases))
    wrong = [f"check {shown(rule.name)}: {problem}" for rule in rules for problem in unmet(rule, **there)]
    if wrong:
        raise InputError(*wrong)
    runs = simulated(runs)
    polarities = list(runs["polarity"].unique())
    by_name = dict(iter(runs.groupby("case", sort=False)))
    verdicts = []
    for case in cases:
        mine = by_name.get(case["case"], runs[:0])
        mine = mine[_has(mine, case["columns"])]
        for scale in scales:
            suite = complete(mine[mine["scale"] == scale], planned, polarities)
            for rule in rules:
                if chooses(rule, str(case["case"]), scale):
                    # Of a mirror image the demands are the same
                    its = suite[suite["polarity"] == rule.polarity] if rule.polarity in polarities else suite
                    verdicts.append(_verdict(rule, its, case, scale))
    return verdicts


def _has(runs: "pd.DataFrame", columns: Mapping[str, float | str]) -> npt.NDArray[np.bool_]:
    """Which runs have these values of the varied keys, shape (n,)."""
    found = np.ones(len(runs), dtype=bool)
    for name, value in columns.items():
        if isinstance(value, str):
            found &= (runs[name] == value).to_numpy()
        else:  # peaks.csv has ten digits of it
            found &= np.isclose(runs[name].to_numpy(np.float64, na_value=np.nan), value, rtol=1e-9, atol=0.0)
    return found


def _verdict(rule: Rule, suite: "pd.DataFrame", case: Case, scale: float) -> Verdict:
    demand = DEMANDS[rule.demand]
    none = Verdict(
        check=rule.name,
        case=str(case["case"]),
        columns=dict(case["columns"]),
        scale=scale,
        demand=rule.demand,
        statistic="" if demand.of_the_case else rule.statistic or "max",
        words=rule.words,
        records=0,
        runs=0 if demand.of_the_case else len(suite),
        value=math.nan,
        low=math.nan,
        high=math.nan,
        sense=rule.sense,
        limit=rule.limit,
        ratio=math.nan,
        margin=math.nan,
        verdict=DOES_NOT_APPLY,
        basis=rule.basis,
        reason=rule.reason,
        counting=rule.counting,
        counted="" if demand.of_the_case else counted(rule, suite),
        note=f"a {case['base']} base has no {rule.demand}",
    )
    if case["base"] not in demand.bases:
        return none
    if demand.weighed and "mass_t" not in case["pier"]:
        return replace(none, note=NOT_WEIGHED)
    if demand.of_the_case:
        value = float(demand.of(suite, case).value[0])
        if math.isnan(value):
            return replace(none, note=NOT_WEIGHED)
        verdict, note = _decide(rule, value, value)
        ratio, margin = _against(rule, value)
        return replace(none, value=value, low=value, high=value, ratio=ratio, margin=margin, verdict=verdict, note=note)
    bounds = by_record(rule, suite, case)
    n = len(bounds.value)
    value, low, high = (_statistic(rule, each) for each in (bounds.value, bounds.low, bounds.high))
    if np.isinf(bounds.high).sum() > np.isinf(bounds.low).sum() and rule.statistic == "asce7-16":
        high = math.inf  # a response that is not known is not one of the unacceptable
    verdict, why = _decide(rule, low, high, n)
    remark = STATISTICS[rule.statistic or "max"].remark
    missing = without_other_law(rule, suite, case)
    notes = [
        why,
        remark(bounds.high) if remark and n else "",
        f"by the other spring law {missing} of the runs did not go through" if missing else "",
        "" if bounds.estimated or demand.event else "no error estimate",
    ]
    note = "; ".join(filter(None, notes))
    ratio, margin = _against(rule, value)
    return replace(
        none, records=n, value=value, low=low, high=high, ratio=ratio, margin=margin, verdict=verdict, note=note
    )


def _statistic(rule: Rule, values: Values) -> float:
    if len(values) == 0:
        return math.nan
    statistic = STATISTICS[rule.statistic or "max"]
    return float((values > (rule.above or 0.0)).sum()) if statistic.of is None else statistic.of(values)


def _decide(rule: Rule, low: float, high: float, records: int | None = None) -> tuple[str, str]:
    """The verdict on a demand within these bounds, and why there is none; ``records`` where it is a statistic of some."""
    within, beyond = high <= rule.limit, low > rule.limit
    if rule.sense == "at least":
        within, beyond = low >= rule.limit, high < rule.limit
    if beyond:
        return FAIL, ""
    statistic = STATISTICS[rule.statistic or "max"]
    if records is not None and records < statistic.least:
        told = "1 record counts" if records == 1 else f"{records} records count"
        return NOT_DECIDED, f"{told}; {statistic.source} asks for {statistic.least}" if statistic.source else told
    if within:
        return PASS, ""
    return NOT_DECIDED, f"between {low:.4g} and {'any value' if math.isinf(high) else f'{high:.4g}'}"


def _against(rule: Rule, value: float) -> tuple[float, float]:
    """Ratio and margin of a value to the limit."""
    over, under, margin = value, rule.limit, rule.limit - value
    if rule.sense == "at least":
        over, under, margin = rule.limit, value, value - rule.limit
    if math.isnan(value):
        return math.nan, math.nan
    if under == 0:
        return (0.0 if over == 0 else math.inf), margin
    return over / under, margin
