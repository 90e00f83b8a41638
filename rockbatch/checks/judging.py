"""Rules held against results: pass, fail or not decided."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from rockbatch.checks.choices import chooses, unmet
from rockbatch.checks.demands import BROUGHT, DEMANDS, Case, has_device
from rockbatch.checks.rules import Rule
from rockbatch.checks.statistics import STATISTICS, Values
from rockbatch.checks.suite import (
    OTHER_LAW,
    by_other_law,
    by_record,
    complete,
    counted,
    counts_as,
    creeps,
    governing,
    lacking,
    of_runs,
    simulated,
    suites,
)
from rockbatch.checks.verdicts import DOES_NOT_APPLY, FAIL, NOT_DECIDED, PASS, Verdict
from rockbatch.errors import InputError
from rockbatch.lazy import pd
from rockbatch.toml.kinds import shown

MOST_NAMES = 5


NOT_WEIGHED = "the study does not say what the pier weighs"


def judge(
    rules: Sequence[Rule],
    peaks: "pd.DataFrame",
    cases: Sequence[Case],
    records: Mapping[str, str] | None = None,
    count: str = "station",
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
    records : mapping, optional
        Names of all horizontal components, each with its station, empty where nobody knows it; a run that is missing counts as
        failed. By default those in ``peaks``, with its column ``station``.
    count : str
        How those rules count that do not say it, one of :data:`rockbatch.checks.rules.COUNTS`.

    Raises
    ------
    InputError
        Where a rule asks for a case, scale, polarity or column that the results do not have.
    """
    runs = peaks[peaks["case"] != ""]
    if runs.empty:
        raise InputError("there is no run to check")
    stations = dict(records or _stations(runs))
    polarities, scales = list(runs["polarity"].unique()), [float(scale) for scale in runs["scale"].unique()]
    there: dict[str, Any] = {"scales": scales, "polarities": polarities}
    there["other_law"] = OTHER_LAW in runs or not any(map(creeps, cases))
    there["output"] = [key for key, column in BROUGHT.items() if column in runs]
    there["cases"] = list(dict.fromkeys(str(case["case"]) for case in cases))
    wrong = [f"check {shown(rule.name)}: {problem}" for rule in rules for problem in unmet(rule, **there)]
    if wrong:
        raise InputError(*wrong)
    runs = simulated(runs)
    polarities = list(runs["polarity"].unique())
    verdicts = []
    for case, mine in suites(runs, cases):
        for scale in scales:
            suite = complete(mine[mine["scale"] == scale], stations, polarities)
            for rule in rules:
                if chooses(rule, str(case["case"]), scale):
                    # Of a mirror image the demands are the same
                    its = suite[suite["polarity"] == rule.polarity] if rule.polarity in polarities else suite
                    verdicts.append(_verdict(rule, its, case, scale, rule.count or count))
    return verdicts


def _stations(runs: "pd.DataFrame") -> dict[str, str]:
    """The station of every record in a table; empty where it does not say."""
    known = runs["station"].fillna("").astype(str) if "station" in runs else [""] * len(runs)
    return dict(zip(runs["record"], known, strict=True))


def _verdict(rule: Rule, suite: "pd.DataFrame", case: Case, scale: float, count: str) -> Verdict:
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
        count="" if demand.of_the_case else count,
        unit="" if rule.statistic == "count" else demand.unit,
    )
    if not demand.on(case):
        return none
    if demand.device and not has_device(case, demand.device):
        return replace(none, note=f"the pier has no {demand.device}")
    if demand.weighed and "mass_t" not in case["pier"]:
        return replace(none, note=NOT_WEIGHED)
    if demand.of_the_case:
        value = float(demand.of(suite, case).value[0])
        if math.isnan(value):
            return replace(none, note=NOT_WEIGHED)
        verdict, note = _decide(rule, value, value)
        ratio, margin = _against(rule, value)
        return replace(none, value=value, low=value, high=value, ratio=ratio, margin=margin, verdict=verdict, note=note)
    return _of_suite(rule, suite, case, none)


def _of_suite(rule: Rule, suite: "pd.DataFrame", case: Case, none: Verdict) -> Verdict:
    """The verdict on a statistic of a suite; ``none`` is what is known of it before."""
    runs, kept = of_runs(rule, suite, case)
    counted_as, unknown = counts_as(suite, none.count)
    bounds = by_record(runs, kept, counted_as)
    n = len(bounds.value)
    value, low, high = (_statistic(rule, each) for each in (bounds.value, bounds.low, bounds.high))
    if np.isinf(bounds.high).sum() > np.isinf(bounds.low).sum() and rule.statistic == "asce7-16":
        high = math.inf  # a response that is not known is not one of the unacceptable
    verdict, why = _decide(rule, low, high, "component" if unknown else none.count, n)
    remark = STATISTICS[rule.statistic or "max"].remark
    at = governing(runs, kept, by_bound=verdict == NOT_DECIDED and low <= rule.limit < high)
    notes = [
        why,
        remark(bounds.high) if remark and n else "",
        unknown,
        "" if none.count == "component" else _told_lacking(lacking(kept, counted_as)),
        _told_laws(rule, suite, case, at),
        "" if bounds.estimated or DEMANDS[rule.demand].event else "no error estimate",
    ]
    ratio, margin = _against(rule, value)
    found = replace(
        none,
        records=n,
        value=value,
        low=low,
        high=high,
        ratio=ratio,
        margin=margin,
        verdict=verdict,
        count="component" if unknown else none.count,
        note="; ".join(filter(None, notes)),
    )
    if at is None:
        return found
    run = suite.iloc[at]
    station, record, polarity = (str(run[name]) for name in ("station", "record", "polarity"))
    return replace(found, station=station, record=record, polarity=polarity, governing=float(runs.value[at]))


def _told_laws(rule: Rule, suite: "pd.DataFrame", case: Case, at: int | None) -> str:
    """That the worse of two spring laws counts, what the run ``at`` comes to by both, and how many did not go through."""
    other = by_other_law(rule, suite, case)
    if other is None:
        return ""
    told = "the worse of two spring laws counts"
    if at is not None and np.isfinite(other[at]):
        own = float(DEMANDS[rule.demand].of(suite, case).value[at])
        told += f": {own:.4g} by that of the case, {other[at]:.4g} by the other"
    missing = int((np.isnan(other) & (suite["status"] == "ok").to_numpy()).sum())
    return told + (f"; by the other {missing} of the runs did not go through" if missing else "")


def _told_lacking(records: Mapping[str, tuple[int, int]]) -> str:
    """Records whose worst direction may be one that does not count."""
    if not records:
        return ""
    told = [f"{name} ({some} of {all_})" for name, (some, all_) in records.items()]
    more = f" and {len(told) - MOST_NAMES} more" if len(told) > MOST_NAMES else ""
    return f"not every direction counts, and the worst may be another: {', '.join(told[:MOST_NAMES])}{more}"


def _statistic(rule: Rule, values: Values) -> float:
    if len(values) == 0:
        return math.nan
    statistic = STATISTICS[rule.statistic or "max"]
    return float((values > (rule.above or 0.0)).sum()) if statistic.of is None else statistic.of(values)


def _decide(rule: Rule, low: float, high: float, count: str = "", records: int | None = None) -> tuple[str, str]:
    """The verdict on a demand within these bounds, and why there is none; ``records`` where it is a statistic of some."""
    within, beyond = high <= rule.limit, low > rule.limit
    if rule.sense == "at least":
        within, beyond = low >= rule.limit, high < rule.limit
    few = "" if records is None else _too_few(rule, count, records)
    if beyond:
        return FAIL, few
    if few:
        return NOT_DECIDED, few
    if within:
        return PASS, ""
    return NOT_DECIDED, f"between {low:.4g} and {'any value' if math.isinf(high) else f'{high:.4g}'}"


def _too_few(rule: Rule, count: str, records: int) -> str:
    """That fewer records count than have to, and who asks for more; empty where there are enough."""
    statistic = STATISTICS[rule.statistic or "max"]
    least, who = statistic.least, statistic.code
    if rule.least is not None and rule.least > least:
        least, who = rule.least, "the check"
    if records >= least:
        return ""
    told = f"1 {count} counts" if records == 1 else f"{records} {count}s count"
    return f"{told}, {who} asks for {least}" if who else told


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
