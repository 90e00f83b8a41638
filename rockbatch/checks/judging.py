"""Evaluation of rules on results: pass, fail or not decided."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from rockbatch.checks.bounds import SCATTER, by_other_law, by_record, chaotic, counted, governing, lacking, of_runs
from rockbatch.checks.verdicts import DOES_NOT_APPLY, FAIL, NOT_DECIDED, PASS, Verdict
from rockbatch.common.errors import InputError
from rockbatch.common.lazy import pd
from rockbatch.quantities.cases import Case, creeps, has_device
from rockbatch.quantities.catalogue import BROUGHT, COLUMNS, DEMANDS, OTHER_LAW
from rockbatch.quantities.statistics import STATISTICS, Values
from rockbatch.results.rows import complete, counts_as, simulated, suites, with_case
from rockbatch.results.sections import MEANING as OF_SECTIONS
from rockbatch.study.rule_choices import FAR, chooses, has_section, limit_key, unmet
from rockbatch.study.rules import Rule
from rockbatch.toml.kinds import shown

MOST_NAMES = 5


NOT_WEIGHED = "the study does not state the pier's mass"


def judge(
    rules: Sequence[Rule],
    peaks: "pd.DataFrame",
    cases: Sequence[Case],
    records: Mapping[str, str] | None = None,
    count: str = "station",
    sections: "pd.DataFrame | None" = None,
) -> list[Verdict]:
    """Evaluate every rule for every case at every scale.

    Parameters
    ----------
    rules : sequence of Rule
    peaks : DataFrame
        Rows of peaks.csv; those without a case, of files that could not be used, are in no suite, and mirror images count
        once.
    cases : sequence of mappings
        ``cases`` of run.json, or some of them.
    records : mapping, optional
        Names of all horizontal components, each with its station, empty if it is not known; a run that is missing counts as
        failed. By default those in ``peaks``, with its column ``station``.
    count : str
        How those rules count that do not say it, one of :data:`rockbatch.study.rules.COUNTS`.
    sections : DataFrame, optional
        Rows of sections.csv, for rules about a section.

    Raises
    ------
    InputError
        Where a rule asks for a case, scale, polarity or column that the results do not have.
    """
    runs = with_case(peaks)
    if runs.empty:
        raise InputError("there is no run to check")
    stations = dict(records or _stations(runs))
    polarities, scales = list(runs["polarity"].unique()), [float(scale) for scale in runs["scale"].unique()]
    available: dict[str, Any] = {"scales": scales, "polarities": polarities}
    available["other_law"] = OTHER_LAW in runs or not any(map(creeps, cases))
    kinds = {"", *(COLUMNS[name].device for name in runs if name in COLUMNS)}  # of devices; others bring no columns
    available["output"] = [
        key
        for key, columns in BROUGHT.items()
        if any(name in runs for name in columns) or not any(COLUMNS[name].device in kinds for name in columns)
    ]
    available["sections"] = set() if sections is None else set(sections["height_m"])
    available["cases"] = list(dict.fromkeys(str(case["case"]) for case in cases))
    wrong = [f"check {shown(rule.name)}: {problem}" for rule in rules for problem in unmet(rule, **available)]
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
                    if rule.at_m is not None and sections is not None:
                        its = at_section(its, sections, rule)
                    verdicts.append(_verdict(rule, its, case, scale, rule.count or count))
    return verdicts


def at_section(runs: "pd.DataFrame", sections: "pd.DataFrame", rule: Rule) -> "pd.DataFrame":
    """Return the rows of a case with those of sections.csv at the height of the rule beside them; NaN if a run has none."""
    keys = [name for name in sections if name not in OF_SECTIONS]
    its = sections[[has_section(rule, [height]) for height in sections["height_m"]]]
    return runs.merge(its, how="left", on=keys).set_index(runs.index)


def _stations(runs: "pd.DataFrame") -> dict[str, str]:
    """Return the station of every record in a table; empty if it does not say."""
    stations = runs["station"].fillna("").astype(str) if "station" in runs else [""] * len(runs)
    return dict(zip(runs["record"], stations, strict=True))


def _verdict(rule: Rule, suite: "pd.DataFrame", case: Case, scale: float, count: str) -> Verdict:
    demand = DEMANDS[rule.demand]
    unknown: dict[str, Any] = dict.fromkeys(("value", "low", "high", "ratio", "margin"), math.nan)
    of_suite: dict[str, Any] = {"statistic": "", "runs": 0, "counted": "", "count": ""}
    if not demand.per_case:
        statistic, number = rule.statistic or "max", len(suite)
        of_suite = {"statistic": statistic, "runs": number, "counted": counted(rule, suite), "count": count}
    none = Verdict(
        check=rule.name,
        case=str(case["case"]),
        columns=dict(case["columns"]),
        scale=scale,
        **{name: getattr(rule, name) for name in ("demand", "words", "sense", "limit", "basis", "reason", "counting")},
        **of_suite,
        **unknown,
        records=0,
        verdict=DOES_NOT_APPLY,
        note=f"a {case['base']} base has no {rule.demand}",
        unit="" if rule.statistic == "count" else demand.unit,
    )
    if not demand.applies_to(case):
        return none
    if demand.device and not has_device(case, demand.device):
        return replace(none, note=f"the pier has no {demand.device}")
    if demand.weighed and "mass_t" not in case["pier"]:
        return replace(none, note=NOT_WEIGHED)
    if rule.at_m is not None and suite["height_m"].isna().all() and (suite["status"] != "failed").any():
        return replace(none, note=f"the pier has no section at {rule.at_m:g} m")
    if not demand.per_case:
        return _of_suite(rule, suite, case, none)
    value = float(demand.evaluate(suite, case).value[0])
    if math.isnan(value):
        return replace(none, note=NOT_WEIGHED)
    verdict, note = _decide(rule, value, value)
    return replace(none, **_bounded(rule, value, value, value), verdict=verdict, note=note)


def _bounded(rule: Rule, value: float, low: float, high: float) -> dict[str, Any]:
    """Return a value and its bounds, with its ratio and margin to the limit."""
    numerator, denominator, margin = value, rule.limit, rule.limit - value
    if rule.sense == "at least":
        numerator, denominator, margin = rule.limit, value, value - rule.limit
    if math.isnan(value):
        ratio = margin = math.nan
    else:
        ratio = numerator / denominator if denominator else 0.0 if numerator == 0 else math.inf
    return {"value": value, "low": low, "high": high, "ratio": ratio, "margin": margin}


def _of_suite(rule: Rule, suite: "pd.DataFrame", case: Case, none: Verdict) -> Verdict:
    """Return the verdict on a statistic of a suite; ``none`` is the verdict without its numbers."""
    runs, counting = of_runs(rule, suite, case)
    counted_as, unknown = counts_as(suite, none.count)
    bounds = by_record(runs, counting, counted_as)
    n = len(bounds.value)
    value, low, high = (_statistic(rule, values) for values in (bounds.value, bounds.low, bounds.high))
    if np.isinf(bounds.high).sum() > np.isinf(bounds.low).sum() and rule.statistic == "asce7-16":
        high = math.inf  # a response that is not known is not one of the unacceptable
    count = "component" if unknown else none.count
    verdict, reason = _decide(rule, low, high, count, n)
    remark = STATISTICS[rule.statistic or "max"].remark
    deciding = governing(runs, counting, by_bound=verdict == NOT_DECIDED and low <= rule.limit < high)
    notes = [
        reason,
        _far(rule, value) if verdict == PASS else "",
        remark(bounds.high) if remark and n else "",
        unknown,
        "" if none.count == "component" else _directions(lacking(counting, counted_as)),
        _laws(rule, suite, case, deciding),
        "" if bounds.estimated or DEMANDS[rule.demand].event else "no error estimate",
        _chaotic(rule, suite, case),
    ]
    run: dict[str, Any] = {}
    if deciding is not None:
        run = {name: str(suite[name].iloc[deciding]) for name in ("station", "record", "polarity")}
        run["governing"] = float(runs.value[deciding])
    return replace(
        none,
        **_bounded(rule, value, low, high),
        **run,
        records=n,
        verdict=verdict,
        count=count,
        note="; ".join(filter(None, notes)),
    )


def _far(rule: Rule, value: float) -> str:
    """Return the remark that no run comes near the limit, as where its unit is wrong; empty where one does or it is confirmed."""
    key = limit_key(rule)
    if rule.statistic == "count" or key in rule.confirm or not 0.0 < FAR * value < rule.limit:
        return ""
    return f"{value:.4g} is below {1 / FAR:g} of the limit; check its unit, or write confirm = [{shown(key)}]"


def _laws(rule: Rule, suite: "pd.DataFrame", case: Case, deciding: int | None) -> str:
    """Return the remark that the worse of two spring laws counts, with the demands of the run ``deciding`` by both."""
    by_other = by_other_law(rule, suite, case)
    if by_other is None:
        return ""
    remark = "the worse of two spring laws counts"
    if deciding is not None and np.isfinite(by_other[deciding]):
        of_case = float(DEMANDS[rule.demand].evaluate(suite, case).value[deciding])
        remark += f": {of_case:.4g} by that of the case, {by_other[deciding]:.4g} by the other"
    missing = int((np.isnan(by_other) & (suite["status"] == "ok").to_numpy()).sum())
    return remark + (f"; by the other {missing} of the runs did not go through" if missing else "")


def _chaotic(rule: Rule, suite: "pd.DataFrame", case: Case) -> str:
    """Return the remark on runs that claim no error because their results are chaotic."""
    if DEMANDS[rule.demand].event:
        return ""
    wild = int(chaotic(rule, suite, DEMANDS[rule.demand].evaluate(suite, case).error).sum())
    if not wild:
        return ""
    runs = "1 run is chaotic, and is" if wild == 1 else f"{wild} runs are chaotic, and are"
    return f"{runs} known to a factor of {SCATTER:g}"


def _directions(records: Mapping[str, tuple[int, int]]) -> str:
    """Return the remark on records whose worst direction may be one that does not count."""
    if not records:
        return ""
    names = [f"{name} ({used} of {total})" for name, (used, total) in records.items()]
    more = f" and {len(names) - MOST_NAMES} more" if len(names) > MOST_NAMES else ""
    return f"not every direction counts, and the worst may be another: {', '.join(names[:MOST_NAMES])}{more}"


def _statistic(rule: Rule, values: Values) -> float:
    if len(values) == 0:
        return math.nan
    statistic = STATISTICS[rule.statistic or "max"]
    return float((values > (rule.above or 0.0)).sum()) if statistic.evaluate is None else statistic.evaluate(values)


def _decide(rule: Rule, low: float, high: float, count: str = "", records: int | None = None) -> tuple[str, str]:
    """Return the verdict on a demand within these bounds, and why it is not decided; ``records`` for a statistic of some."""
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
    """Return the remark that too few records count, and the code that asks for more; empty if there are enough."""
    statistic = STATISTICS[rule.statistic or "max"]
    least, authority = statistic.least, statistic.code
    if rule.least is not None and rule.least > least:
        least, authority = rule.least, "the check"
    if records >= least:
        return ""
    counts = f"1 {count} counts" if records == 1 else f"{records} {count}s count"
    return f"{counts}, {authority} asks for {least}" if authority else counts
