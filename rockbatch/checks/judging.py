"""Evaluation of rules on results: pass, fail or not decided."""

import json
import math
from collections import Counter
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import replace

import numpy as np

from rockbatch.checks.bounds import SCATTER, Axis, Demanded, OfSuite, lacking, of_suite
from rockbatch.checks.capacity import used
from rockbatch.checks.endings import left_open
from rockbatch.checks.events import OfEvent, largest_event
from rockbatch.checks.omissions import DIRECTIONS, ERRORS, EVENTS, NAMED, OMISSIONS, TARGET, VERTICALS
from rockbatch.checks.rule_choices import FAR, Available, Fitted, fitted
from rockbatch.checks.rules import USUAL, Rule
from rockbatch.checks.suite import Suite
from rockbatch.checks.verdicts import DOES_NOT_APPLY, FAIL, NOT_DECIDED, PASS, Verdict
from rockbatch.common.errors import InputError
from rockbatch.common.grouping import joined
from rockbatch.common.lazy import pd
from rockbatch.common.showing import shown
from rockbatch.quantities.arrays import Rows, Texts
from rockbatch.quantities.cases import Case, is_across, names_along
from rockbatch.quantities.catalogue import BROUGHT, COLUMNS, DEMANDS
from rockbatch.quantities.demands import OF_BASE
from rockbatch.quantities.rows import NOT_RUN, complete, counts_as, rows_of_piers, simulated, with_case
from rockbatch.quantities.statistics import STATISTICS

MOST_NAMES = 5


NOT_WEIGHED = "the study does not state the pier's mass"
UNBOUNDED_FORCE = "the backbone of the supports has no greatest force"
_OTHER_ENDS = [demand.other_end for demand in DEMANDS.values() if demand.other_end]
PLANAR = "each axis of the pier is a planar model of its own"


def judge(
    rules: Sequence[Rule],
    peaks: "pd.DataFrame",
    cases: Sequence[Case],
    suite: Suite | None = None,
    count: str = "station",
    sections: "pd.DataFrame | None" = None,
    *,
    interaction: "pd.DataFrame | None" = None,
    doubted: bool = False,
) -> list[Verdict]:
    """Judge each case by every rule at the scales that the rule chooses; a case run on both axes of its pier is one.

    ``peaks`` are rows of peaks.csv; those without a case, of files that could not be used, are in no suite, and mirror images
    count once. ``cases`` are of run.json, all or some; that across the axis of a pier follows the one along it. The stations of
    the ``suite`` are those of all horizontal components, of which a missing run counts as failed; without a suite they are
    those of the column ``station``. ``count``, one of :data:`rockbatch.checks.rules.COUNTS`, applies to rules that do not say
    how they count; a code counts stations. ``sections`` and ``interaction``, rows of sections.csv and interaction.csv, are for
    rules about a section, and about its capacity. Limits that are ``doubted`` are compared with the piers; those of a study
    were when it was read.

    Returns verdicts by case, then scale, then rule. Raises ``InputError`` if there is no run, if a rule asks for a case, scale
    or column that the results lack, or for a doubted limit that decides nothing.
    """
    runs = with_case(peaks)
    if runs.empty:
        raise InputError("there is no run to check")
    with_mirrors, scales = Rows(runs), [float(scale) for scale in runs["scale"].unique()]
    suite = suite or Suite()
    stations = suite.stations or dict(zip(with_mirrors.texts("record"), with_mirrors.texts("station"), strict=True))
    at_heights = {
        needs: rows for needs, rows in (("sections", sections), ("interaction", interaction)) if rows is not None
    }
    none_read = bool((runs["status"] == "failed").all())  # tables are empty then, and no choice of theirs is wrong
    available = Available(
        cases=names_along(cases),
        scales=scales,
        output=[
            *(key for key, columns in BROUGHT.items() if _has_columns(runs, columns)),
            *(end.needs for end in _OTHER_ENDS if end.column in runs or not any(map(end.has_range, cases))),
            *([OF_BASE] if interaction is not None and (none_read or interaction["height_m"].isna().any()) else []),
        ],
        sections={
            needs: {rule.at_m or 0.0 for rule in rules} if none_read else set(rows["height_m"].dropna())
            for needs, rows in at_heights.items()
        },
        piers=cases if doubted else (),
    )
    fits = [fitted(rule, available) for rule in rules]
    wrong = [f"check {shown(fit.rule.name)}: {problem}" for fit in fits for problem in fit.problems]
    if wrong:
        raise InputError(*wrong)
    runs = simulated(runs)
    if runs.empty:
        raise InputError("the table has mirror images only, and not the runs that they mirror")
    table, scale_of = Rows(runs), runs["scale"].to_numpy(np.float64)
    polarities = [*dict.fromkeys(table.texts("polarity"))]
    if interaction is not None:
        at_heights[OF_BASE] = interaction
    tables = [
        at_section(runs, at_heights[DEMANDS[fit.rule.demand].needs], fit) if fit.sections else table for fit in fits
    ]
    verdicts = []
    for pier in rows_of_piers(runs, cases):
        name = str(pier[0][0]["case"])
        for scale in scales:
            axes = []
            for case, rows in pier:
                at_scale = table.at(rows[scale_of[rows] == scale])
                axes.append(Axis(case, complete(at_scale, stations, polarities)))
            judged = []
            for fit, own in zip(fits, tables, strict=True):
                if name in fit.cases and scale in fit.scales:
                    of_rule = [Axis(axis.case, axis.suite.same_rows_of(own)) for axis in axes]
                    judged.append(_verdict(fit.rule, of_rule, scale, fit.rule.count or count, suite))
            verdicts += left_open(judged, [axis.suite for axis in axes])
    return verdicts


def at_section(runs: "pd.DataFrame", sections: "pd.DataFrame", fit: Fitted) -> Rows:
    """Return runs with the forces in the section or base of a rule, from the table that it needs; NaN for a run without them.

    Raises ``InputError`` if a run has two sections at the height of the rule; of a rule with a capacity the worse counts.
    """
    its = sections[sections["height_m"].isin(fit.sections)]
    if fit.rule.curve is not None:
        its = used(fit.rule.curve, its)
    keys = [name for name in its if name in runs]
    if its.duplicated(keys).any():
        raise InputError(f"a run has several sections at {fit.rule.at_m:g} m; start `rockbatch run` again")
    return Rows(runs.merge(its, how="left", on=keys))


def _has_columns(runs: "pd.DataFrame", columns: Collection[str]) -> bool:
    """Return whether results have one of the ``columns`` of a key of [output]; True also if all are of devices no pier has."""
    devices = {"", *(COLUMNS[name].device for name in runs if name in COLUMNS)}  # other devices have no columns here
    return any(name in runs for name in columns) or not any(COLUMNS[name].device in devices for name in columns)


def _verdict(rule: Rule, axes: Sequence[Axis], scale: float, count: str, suite: Suite) -> Verdict:
    """Return the verdict of a rule on a pier at one scale, on one or both ``axes``.

    If the demand is absent on one axis, the other decides alone; if on both, the verdict is "does not apply" with the reason.
    """
    absent = [_why_absent(rule, axis) for axis in axes]
    applying = [axis for axis, reason in zip(axes, absent, strict=True) if not reason]
    none = _not_applying(rule, axes, scale, count, rule.on_both_axes if len(applying) > 1 else "")
    if not applying:
        return replace(none, remarks=(absent[0],))
    per_case = DEMANDS[rule.demand].per_case
    verdict = _of_case(rule, applying, none) if per_case else _of_suite(rule, applying, none, suite)
    if len(axes) == 1 or verdict.verdict == DOES_NOT_APPLY:
        return verdict
    alone = [f"{_place(axis)} {reason}" for axis, reason in zip(axes, absent, strict=True) if reason]
    return replace(verdict, remarks=(*verdict.remarks, *alone, PLANAR))


def _not_applying(rule: Rule, axes: Sequence[Axis], scale: float, count: str, combined: str) -> Verdict:
    """Return a verdict "does not apply" of a rule, its numbers NaN; ``combined`` says how demands on two axes combine."""
    demand, case = DEMANDS[rule.demand], axes[0].case
    height = demand.height(case) if demand.height else rule.at_m
    statistic, suites = "", []
    if not demand.per_case:
        statistic, suites = rule.statistic or "max", [axis.suite for axis in axes]
        count = "station" if STATISTICS[statistic].code else count
    return Verdict(
        check=rule.name,
        case=str(case["case"]),
        columns=dict(case["columns"]),
        scale=scale,
        demand=rule.demand,
        statistic=statistic,
        words=", ".join(filter(None, (rule.words_at(height), combined))),
        records=0,
        runs=sum(map(len, suites)),
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
        counted=_counts_ended_early(rule, suites),
        remarks=(),
        count="" if demand.per_case else count,
        unit="" if rule.statistic == "count" else demand.unit,
        at_m=math.nan if height is None else height,
        axes=combined,
        capacity="" if rule.curve is None else json.dumps(rule.curve),
        least=rule.least or 0,
        per_event=rule.per_event or 0,
    )


def _counts_ended_early(rule: Rule, suites: Iterable[Rows]) -> str:
    """Return how many runs did not go through, and how each counts: "1 overturned (infinite), 2 not run (unknown)"; or "".

    How they count is left out for a demand that is not of every run, such as an event.
    """
    numbers: Counter[str] = Counter()
    for runs in suites:
        numbers.update(np.where(runs.missing, NOT_RUN, runs.texts("status")).tolist())
    parts = []
    for name in (*USUAL, NOT_RUN):
        if n := numbers[name]:
            way = rule.ways["failed" if name == NOT_RUN else name]
            parts.append(f"{n} {name} ({way})" if DEMANDS[rule.demand].per_run else f"{n} {name}")
    return ", ".join(parts)


def _of_case(rule: Rule, axes: Sequence[Axis], none: Verdict) -> Verdict:
    """Return the verdict on a property of the case, the worse of both axes; none if it needs a mass not given, or is infinite.

    ``none`` is the verdict without its numbers.
    """
    worse = max if rule.sense == "at most" else min
    value = worse(float(DEMANDS[rule.demand].evaluate(axis.suite, axis.case).value[0]) for axis in axes)
    if math.isnan(value):
        return replace(none, remarks=(NOT_WEIGHED,))
    if math.isinf(value):
        return replace(none, remarks=(UNBOUNDED_FORCE,))
    decided, _ = _decide(rule, value, value)
    return replace(_with_numbers(none, value, value, value), verdict=decided)


def _place(axis: Axis) -> str:
    """Return "across the axis" for a case across the axis of another one, else "along the axis"."""
    return "across the axis" if is_across(axis.case) else "along the axis"


def _why_absent(rule: Rule, axis: Axis) -> str:
    """Return why the demand of a rule does not apply on an axis: "the pier has no damper"; "" if it applies."""
    demand, (case, suite) = DEMANDS[rule.demand], axis
    if reason := demand.why_absent(case):
        return reason
    if (beyond := demand.ceiling) and beyond.unreachable and rule.threshold > beyond.value(case) and not rule.confirm:
        return f"{rule.demand} above {beyond.value(case):.4g} {beyond.beyond}"
    if demand.weighed and "mass_t" not in case["pier"]:
        return NOT_WEIGHED
    if (
        rule.at_m is not None
        and np.isnan(suite.numbers("height_m")).all()
        and (suite.texts("status") != "failed").any()
    ):
        return f"the pier has no section at {rule.at_m:g} m"
    if _carries_nothing(suite):
        return f"nothing of the pier is above {rule.at_m:g} m"
    return ""


def _carries_nothing(suite: Rows) -> bool:
    """Return whether the axial force of a section is 0 throughout all runs that have one, as at the top; False without any."""
    ends = [suite.numbers(f"section_axial_{end}_kN") for end in ("least", "greatest")]
    return bool(np.isfinite(ends).any() and np.nanmax(np.abs(ends)) == 0.0)


def _with_numbers(verdict: Verdict, value: float, low: float, high: float) -> Verdict:
    """Return the verdict with a value, its bounds, its ratio (above 1 beyond the limit) and its margin (below 0 beyond it).

    Ratio and margin of a value of NaN are NaN. Division by 0 gives infinity, 0/0 gives 0.
    """
    limit = verdict.limit
    numerator, denominator, margin = value, limit, limit - value
    if verdict.sense == "at least":
        numerator, denominator, margin = limit, value, value - limit
    if math.isnan(value):
        ratio = margin = math.nan
    else:
        ratio = numerator / denominator if denominator else 0.0 if numerator == 0 else math.inf
    return replace(verdict, value=value, low=low, high=high, ratio=ratio, margin=margin)


def _of_suite(rule: Rule, axes: Sequence[Axis], none: Verdict, motions: Suite) -> Verdict:
    """Return the verdict on a statistic of a suite; demands on two axes combine run by run: ``both_axes``, else the greater.

    Without a run that counts it is not decided, its numbers NaN. ``none`` is the verdict "does not apply", which gives the rest.
    """
    suite = axes[0].suite
    counted_as, unknown = counts_as(suite, none.count)
    demand = of_suite(rule, axes, counted_as)
    n, counting = len(demand.records.value), demand.counting
    count = "component" if unknown else none.count
    statistic = STATISTICS[none.statistic]
    records = suite.texts("record")[counting]
    of_event = largest_event(records, counted_as[counting], motions.events) if statistic.code else None
    unmet = _unmet(rule, count, n, of_event, known=bool(motions.events)) or _unmet_by_stations(
        rule, counted_as[counting], suite.texts("station")[counting], records, motions
    )
    verdict, few = _decide(rule, demand.low, demand.high, unmet)
    left_out = {name for its in demand.axes for name in its.omitted if verdict != PASS or OMISSIONS[name].decides}
    if not (demand.records.estimated or DEMANDS[rule.demand].event):
        left_out.add(ERRORS)
    if statistic.code != motions.code and statistic.code:
        left_out.add(TARGET)
    if of_event and of_event.records > 1 and rule.per_event is None:
        left_out.add(EVENTS)
    recorded = ~np.isin(suite.texts("record"), [*motions.unrecorded])  # a pulse has one direction, and lacks none
    polarities = len({*suite.texts("polarity")})
    not_selected = {name: n * polarities for name, n in motions.not_selected.items()}
    by_station = none.count != "component" and DEMANDS[rule.demand].of_motion
    lacks = lacking(counting[recorded], counted_as[recorded], not_selected) if by_station else {}
    if lacks:
        left_out.add(DIRECTIONS)
    without_vertical = np.isin(records, [*motions.without_vertical]) & DEMANDS[rule.demand].of_motion
    flat = {*counted_as[counting][without_vertical]}
    if flat:
        left_out.add(VERTICALS)
    omitted = [name for name in OMISSIONS if name in left_out]
    open_by = math.isinf(demand.high) and not all(OMISSIONS[name].decides for name in omitted)
    ends = [
        _remarks_on_ends(rule, its, axis.suite, demand.governing) for its, axis in zip(demand.axes, axes, strict=True)
    ]
    remarks = [
        few or ("" if verdict != NOT_DECIDED or open_by else _between(demand.low, demand.high)),
        _on_each(demand, axes),
        *(OMISSIONS[name].remark for name in omitted if name not in NAMED),
        _remark_if_far(rule, demand.value) if verdict == PASS else "",
        statistic.remark(demand.records.high) if statistic.remark and n else "",
        unknown,
        *(of_event.remarks if of_event else ()),
        _remark_on_directions(lacks),
        f"{len(flat)} of {n} {count}s {'lacks' if len(flat) == 1 else 'lack'} the vertical component" if flat else "",
        *dict.fromkeys(remark for of_axis in ends for remark in of_axis),
        *dict.fromkeys(_remark_on_chaos(int(its.chaotic.sum())) for its in demand.axes),
    ]
    judged = replace(
        _with_numbers(none, math.nan if demand.is_unknown else demand.value, demand.low, demand.high),
        records=n,
        verdict=verdict,
        count=count,
        remarks=tuple(filter(None, remarks)),
        omits=tuple(omitted),
    )
    if demand.governing is None:
        return judged
    station, record, polarity = (suite.texts(name)[demand.governing] for name in ("station", "record", "polarity"))
    return replace(judged, station=station, record=record, polarity=polarity, governing=demand.demanded)


def _on_each(demand: OfSuite, axes: Sequence[Axis]) -> str:
    """Return the demands of the governing run on two axes: "0.2 along the axis, 0.3 across the axis"; "" on one or without it."""
    run = demand.governing
    if len(axes) == 1 or run is None:
        return ""
    of_axes = zip(demand.axes, axes, strict=True)
    return ", ".join(f"{its.bounds.value[run]:.4g} {_place(axis)}" for its, axis in of_axes)


def _remark_if_far(rule: Rule, value: float) -> str:
    """Return the remark that the value is below a hundredth of the limit; "" if it is not, is 0 or confirmed, or for a count."""
    key = rule.limit_key
    if rule.statistic == "count" or key in rule.confirm or not 0.0 < FAR * value < rule.limit:
        return ""
    return f"{value:.4g} is below {1 / FAR:g} of the limit: check its unit, or write confirm = [{shown(key)}]"


def _remarks_on_ends(rule: Rule, demanded: Demanded, suite: Rows, deciding: int | None) -> list[str]:
    """Return remarks that the worse end of a range counts, with both ends of run ``deciding``; [] if one model was run.

    A second remark has the number of runs that went through by the model of the case alone.
    """
    by_other, end = demanded.by_other, DEMANDS[rule.demand].other_end
    if by_other is None or end is None:
        return []
    remarks = [f"the worse of two {end.models} counts"]
    if deciding is not None and np.isfinite(by_other[deciding]):
        own, other = demanded.own[deciding], by_other[deciding]
        remarks[0] += f": {own:.4g} by the {end.model} of the case, {other:.4g} by the other"
    missing = int((np.isnan(by_other) & (suite.texts("status") == "ok")).sum())
    runs = "1 run" if missing == 1 else f"{missing} runs"
    return [*remarks, f"{runs} did not go through by the other {end.model}"] if missing else remarks


def _remark_on_chaos(runs: int) -> str:
    """Return the remark on this number of chaotic runs: "2 runs are chaotic, and are known to a factor of 2"; empty for 0."""
    if not runs:
        return ""
    words = "1 run is chaotic, and is" if runs == 1 else f"{runs} runs are chaotic, and are"
    return f"{words} known to a factor of {SCATTER:g}"


def _remark_on_directions(records: Mapping[str, tuple[int, int]]) -> str:
    """Return the remark on records of which only some runs count: "not every direction counts, …: WTMC (3 of 4)"; "" for none."""
    if not records:
        return ""
    names = [f"{name} ({used} of {total})" for name, (used, total) in records.items()]
    more = f" and {len(names) - MOST_NAMES} more" if len(names) > MOST_NAMES else ""
    return f"{OMISSIONS[DIRECTIONS].remark}: {', '.join(names[:MOST_NAMES])}{more}"


def _decide(rule: Rule, low: float, high: float, unmet: str = "") -> tuple[str, str]:
    """Return (verdict, ``unmet``) on a demand within these bounds: with an unmet condition it can fail, but not pass."""
    within, beyond = high <= rule.limit, low > rule.limit
    if rule.sense == "at least":
        within, beyond = low >= rule.limit, high < rule.limit
    if beyond:
        return FAIL, unmet
    if unmet:
        return NOT_DECIDED, unmet
    return (PASS if within else NOT_DECIDED), ""


def _between(low: float, high: float) -> str:
    """Return the bounds of a demand in words: "between 0.2 and any value"."""
    return f"between {low:.4g} and {'any value' if math.isinf(high) else f'{high:.4g}'}"


def _unmet(rule: Rule, count: str, records: int, of_event: OfEvent | None, *, known: bool = True) -> str:
    """Return the first unmet condition on the records: "5 stations count, EN 1998-1 asks for 7"; "" if all are met.

    These are the least number, which the rule's ``least`` replaces, stations for a code, ``per_event``, and a limit of "count"
    below the number of records. ``known`` is False of a table alone, which has no events.
    """
    statistic = STATISTICS[rule.statistic or "max"]
    least, authority = statistic.least, statistic.code or (f"the {statistic.words}" if statistic.least > 1 else "")
    if rule.least is not None:
        least, authority = rule.least, "the check"
    counts = f"1 {count} counts" if records == 1 else f"{records} {count}s count"
    if records < least:
        return f"{counts}, {authority} asks for {least}" if authority else counts
    if statistic.code and count != "station":
        return f"{statistic.code} counts stations"
    if of_event is not None and rule.per_event is not None and of_event.records + of_event.unknown > rule.per_event:
        unknown = f", and of {of_event.unknown} it is not known" if of_event.unknown else ""
        unknown += "" if known else ": pass the motions of the table, too"
        return f"the check allows {rule.per_event} of one event{unknown}"
    if rule.statistic == "count" and rule.limit >= records:
        return f"{counts}, and the check allows {rule.limit:g}, so that it decides nothing"
    return ""


def _unmet_by_stations(rule: Rule, counted_as: Texts, stations: Texts, records: Texts, motions: Suite) -> str:
    """Return the first unmet condition on stations: "12 components of 1 station count, …"; "" if all are met.

    Components of one station are not independent, nor are sequences with shocks of one station, and codes require recorded
    motions. All arrays describe the runs that count, shape (n,). An unknown station is ""; its record counts as a station.
    Stations whose shocks one sequence joins count as one.
    """
    statistic = STATISTICS[rule.statistic or "max"]
    own = np.where(stations == "", counted_as, stations)
    shocks = {name: motions.shocks.get(record) or (name,) for name, record in zip(own, records, strict=True)}
    motions_of = Counter(station for name in shocks for station in shocks[name])
    n, known = len({*counted_as}), len({*joined(shocks.values())})
    if known < statistic.least <= n:
        words = "1 station" if known == 1 else f"{known} stations"
        return f"{n} components of {words} count, the {statistic.words} asks for {statistic.least} stations"
    unrecorded = np.isin(records, [*motions.unrecorded])
    if statistic.code and unrecorded.any():
        return f"{len({*counted_as[unrecorded]})} of {n} stations are pulses, and {statistic.code} asks for records"
    if statistic.code and any(motions.shocks.get(record) == () for record in records):
        return "the stations of a sequence are not known: pass the motions of the table, too"
    (shared, most), *_ = motions_of.most_common(1) or [("", 0)]
    if statistic.code and most > 1:
        return (
            f"{most} of {n} motions have a record of {shared} in them, and {statistic.code} asks for independent ones"
        )
    return ""
