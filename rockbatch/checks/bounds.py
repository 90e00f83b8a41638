"""Bounds of demands: of each run of a case at one scale, of each record, and of their statistic."""

import math
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from rockbatch.checks.omissions import omissions, open_ends, open_landings, unconverged
from rockbatch.checks.rules import Rule
from rockbatch.quantities.arrays import Rows, Texts
from rockbatch.quantities.cases import Case
from rockbatch.quantities.catalogue import DEMANDS
from rockbatch.quantities.demands import Demand
from rockbatch.quantities.statistics import STATISTICS, Values

SCATTER = 2.0
"""Factor within which a chaotic result is known: of 41, motions 10⁻⁸ stronger or weaker moved five further (THEORY.md)."""


class Bounds(NamedTuple):
    """Demands of each record, or each run, shape (n,), and the bounds within which they lie, ``estimated`` if by errors of all.

    If the upper bound alone is infinite, ``value`` is the lower one.
    """

    value: Values
    low: Values
    high: Values
    estimated: bool


class Axis(NamedTuple):
    """A case, along or across the axis of its pier, with its runs at one scale; both axes have the same records."""

    case: Case
    suite: Rows


class Demanded(NamedTuple):
    """The demand of a rule in the n runs of a case.

    ``bounds`` of every run, and whether it is ``counting`` at all; the ``own`` demand by the model of the case, and
    ``by_other`` that by the other one of a range, NaN if that did not go through and None if it was not run; ``chaotic`` runs;
    what the demand leaves out in runs that count (``omitted``), by the names of
    :data:`rockbatch.checks.omissions.OMISSIONS`; and runs that have no upper bound for it (``unbounded``).
    """

    bounds: Bounds
    counting: npt.NDArray[np.bool_]
    own: Values
    by_other: Values | None
    chaotic: npt.NDArray[np.bool_]
    omitted: list[str]
    unbounded: npt.NDArray[np.bool_]


class OfSuite(NamedTuple):
    """The demand of a rule on a suite of n runs: ``value`` of its statistic, and the bounds within which that lies.

    ``records`` have the bounds of each record, ``axes`` the demands of runs on one or both axes of a pier, ``counting`` the runs
    that count, shape (n,). ``governing`` is the place of the run that demands most, or may where the limit is within the bounds,
    and ``demanded`` its demand; None and NaN if no run demands anything, NaN also if nothing is known of its demand.
    """

    value: float
    low: float
    high: float
    records: Bounds
    axes: Sequence[Demanded]
    counting: npt.NDArray[np.bool_]
    governing: int | None
    demanded: float

    @property
    def is_unknown(self) -> bool:
        """True if nothing is known of the demand: it may be any."""
        return math.isinf(self.high) and self.value == self.low == 0.0


_COMBINED: dict[str, Callable[[Values, Values], Values]] = {
    "greater": np.maximum,
    "srss": np.hypot,
    "100_30": lambda x, y: np.maximum(x + 0.3 * y, 0.3 * x + y),
}


def of_suite(rule: Rule, axes: Sequence[Axis], counted_as: Texts) -> OfSuite:
    """Return the demand of a rule on a suite; ``counted_as`` has the record under which each run counts, shape (n,).

    A run counts if it does so on every axis.
    """
    of_axes = [of_runs(rule, axis.suite, axis.case) for axis in axes]
    runs = _on_both_axes([its.bounds for its in of_axes], rule.both_axes or "greater")
    counting = np.logical_and.reduce([its.counting for its in of_axes])
    records = _by_record(runs, counting, counted_as)
    value, low, high = _of_records(rule, records)
    governing = _governing(runs, counting, by_bound=low <= rule.limit < high)
    demanded = math.nan
    if governing is not None and (math.isfinite(runs.high[governing]) or runs.value[governing] > 0.0):
        demanded = float(runs.value[governing])
    return OfSuite(value, low, high, records, of_axes, counting, governing, demanded)


def _of_records(rule: Rule, records: Bounds) -> tuple[float, float, float]:
    """Return the statistic of the demands of all records, and its bounds; NaN without a record.

    By ASCE 7-16 the upper bound is infinite if the upper bounds of more records are infinite than the lower ones.
    """
    interval = STATISTICS[rule.statistic or "max"].interval
    value, low, high = (_statistic(rule, values) for values in records[:3])
    if interval is not None and len(records.value):
        low, high = interval(*records[:3])
    if rule.counts_unacceptable and np.isinf(records.high).sum() > np.isinf(records.low).sum():
        high = math.inf  # an unknown response does not count as an unacceptable one
    return value, low, high


def _statistic(rule: Rule, values: Values) -> float:
    """Return the statistic of values, shape (n,), or with "count" the number above the rule's ``above``, or 0; NaN for n = 0."""
    if len(values) == 0:
        return math.nan
    statistic = STATISTICS[rule.statistic or "max"]
    return float((values > (rule.above or 0.0)).sum()) if statistic.evaluate is None else statistic.evaluate(values)


def _on_both_axes(axes: Sequence[Bounds], how: str) -> Bounds:
    """Return the demands of runs on one or both axes of a pier, combined by ``how`` of :data:`rockbatch.checks.rules.BOTH_AXES`.

    Every way grows with both demands, so that bounds combine to bounds.
    """
    if len(axes) == 1:
        return axes[0]
    values, lows, highs, estimated = zip(*axes, strict=True)
    combined = _COMBINED[how]
    return Bounds(combined(*values), combined(*lows), combined(*highs), all(estimated))


def _by_record(runs: Bounds, counting: npt.NDArray[np.bool_], counted_as: Texts) -> Bounds:
    """Return the demand of each record, by sorted names: the worst of its ``counting`` runs. Empty if every run is left out."""
    names, record = np.unique(counted_as[counting], return_inverse=True)

    def worst(of_runs: Values) -> Values:
        of_records = np.zeros(len(names))  # no demand is negative
        np.maximum.at(of_records, record, of_runs[counting])
        return of_records

    return Bounds(worst(runs.value), worst(runs.low), worst(runs.high), runs.estimated)


def _governing(runs: Bounds, counting: npt.NDArray[np.bool_], *, by_bound: bool) -> int | None:
    """Return the index of the counting run that demands most, by upper bounds if ``by_bound``; None if no demand is above 0."""
    first, second = (runs.high, runs.value) if by_bound else (runs.value, runs.high)
    order = [i for i in np.lexsort((-second, -first)) if counting[i]]  # a stable sort: of equal ones the first
    return int(order[0]) if order and first[order[0]] > 0 else None


def lacking(
    counting: npt.NDArray[np.bool_], counted_as: Texts, not_selected: Mapping[str, int]
) -> dict[str, tuple[int, int]]:
    """Return (runs that count, runs expected) of each record of which some runs count, but fewer than expected; {} if none.

    Expected are all runs of the record, counting or not, with those of its components that are ``not_selected``, or the commonest
    number of a record if that is more. The missing direction may be the worst.
    """
    planned, remaining = Counter(counted_as), Counter(counted_as[counting])
    planned.update({name: not_selected.get(name, 0) for name in planned})
    usual = max(Counter(planned.values()).items(), key=lambda item: (item[1], item[0]))[0] if planned else 0
    expected = {name: max(n, usual) for name, n in planned.items()}
    return {name: (remaining[name], n) for name, n in expected.items() if 0 < remaining[name] < n}


def of_runs(rule: Rule, runs: Rows, case: Case) -> Demanded:
    """Return the demand of a rule in the runs of a case, with its bounds, chaotic runs and omissions.

    Bounds are value ∓ error, not below 0; the value itself where the error is NaN; from the value up to infinite where the error
    is infinite; from 0 up to infinite where the value is NaN; a factor of :data:`SCATTER` for chaotic runs. Of two models the
    worse counts. Runs cut short count by the rule's ``ways``. An event is 0 or 1; its upper bound is 1 if it may have followed.
    """
    demand = DEMANDS[rule.demand]
    value, error = demand.evaluate(runs, case)
    status = runs.texts("status")
    counting, own = np.ones(len(runs), dtype=bool), value
    if demand.event:
        open_ = runs.facts("may_overturn") & (rule.demand == "overturned")
        if demand.of_motion:  # the event might have followed in a run that was cut short
            open_ |= (status == "failed") | (status == "flight")
        bounds = Bounds(value, value, np.where(open_, 1.0, value), False)
        none = np.zeros(len(runs), dtype=bool)
        return Demanded(bounds, counting, own, None, none, omissions(demand, runs, error, case), none)

    at_least = np.isinf(error)  # the value is a lower bound, and nothing bounds it from above
    margin, wild = np.where(at_least, 0.0, np.nan_to_num(error)), _chaotic(demand, runs, error)
    without = np.isnan(error) & ~wild & np.isfinite(value) & (status == "ok")
    estimated = bool(np.isfinite(error).any() and not without.any())
    low = np.where(wild, value / SCATTER, np.maximum(value - margin, 0.0))
    high = np.where(wild, value * SCATTER, value + margin)
    by_other = None
    if (end := demand.other_end) and end.column in runs and end.has_range(case):  # the worse end counts
        by_other = end.evaluate(runs, case)
        high = np.where(np.isnan(by_other) & getattr(rule, end.asked_by), np.inf, np.fmax(high, by_other))
        value, low = (np.where(np.isnan(value), np.nan, np.fmax(bound, by_other)) for bound in (value, low))
    if rule.ways["overturned"] == "infinite":
        high = np.where(runs.facts("may_overturn"), np.inf, high)
    lower = (open_landings(demand, runs, case) | open_ends(demand, runs, case)) & np.isfinite(value)
    unknown = at_least | lower
    for name, way in rule.ways.items():
        ended = status == name
        if way == "infinite":
            value, low, high = (np.where(ended, np.inf, bound) for bound in (value, low, high))
        elif way == "unknown":
            unknown |= ended
        elif way == "left out":
            counting &= ~ended
    missing = np.isnan(value)  # as the residual of a run that was cut short is
    unknown |= missing
    # A peak or a count is at least its value when the run was cut short; the value of an unsettled run bounds nothing
    nothing = missing | (unknown & (status == "failed"))
    low = np.where(nothing, 0.0, low)
    if demand.reached:  # a peak until the motion ended, before the run failed
        reached, error = demand.reached(runs, case)
        known = unknown & (status == "failed") & ~np.isnan(error)
        low, estimated = np.where(known, np.maximum(reached - error, 0.0), low), estimated or bool(known.any())
    value, high = np.where(unknown, low, value), np.where(unknown, np.inf, high)
    free = unconverged(demand, error, case)
    low, high = np.where(free & np.isfinite(low), 0.0, low), np.where(free, np.inf, high)
    omitted = omissions(demand, runs.where(counting), error[counting], case)
    return Demanded(Bounds(value, low, high, estimated), counting, own, by_other, wild, omitted, lower | free)


def _chaotic(demand: Demand, runs: Rows, error: Values) -> npt.NDArray[np.bool_]:
    """Return True for each chaotic run without an ``error`` of the demand and, but for a residual, of its peak, shape (n,).

    An earlier version did not write the column ``chaotic``: then a run that ended well without an error of its peak counts as
    chaotic, if other runs have one.
    """
    of_peak, ended_well = runs.numbers("theta_max_error"), np.isin(runs.texts("status"), ("ok", "flight"))
    withheld = np.isnan(of_peak) & ended_well & bool(np.isfinite(of_peak).any())
    chaotic = np.where(np.isnan(runs.numbers("chaotic")), withheld, runs.facts("chaotic"))
    return np.isnan(error) & (np.isnan(of_peak) | demand.residual) & chaotic
