"""Fragility curves of every case: through stripes, the capacities of an incremental dynamic analysis, or a cloud of demands."""

import math
from collections import Counter
from collections.abc import Hashable, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from rockbatch.analyses.fragility import cloud
from rockbatch.analyses.fragility.bounds import NoCurve, Numbers, Values
from rockbatch.analyses.fragility.ida import Bracket, Capacity, Looks, bisect, capacity, hunt
from rockbatch.analyses.fragility.limit_states import EXCEEDED, LEFT_OUT, UNDECIDED, WITHSTOOD, applies
from rockbatch.analyses.fragility.lognormal import Capacities, Contribution, Lognormal, contribution, fit
from rockbatch.analyses.fragility.runs import LevelPlan, Point, RecordRuns, Simulate, first_intensities, level_plans
from rockbatch.analyses.fragility.study import FragilitySpec
from rockbatch.analyses.fragility.windows import Windows, windows
from rockbatch.batch.listening import count
from rockbatch.checks.rules import Rule
from rockbatch.common.grouping import grouped
from rockbatch.common.statuses import NOT_STANDING
from rockbatch.motions import Motion
from rockbatch.quantities.catalogue import DEMANDS
from rockbatch.results.run_json import describe_case
from rockbatch.study import PIER_KEYS, Case, Study


class Stripe(NamedTuple):
    """All records at one level: how many count, exceed the limit, or are undecided; overturn, fly or fail.

    ``not_used`` are those whose factor would be beyond the limits of the study; the others are scaled by factors from
    ``scale_least`` to ``scale_most``.
    """

    level: float
    records: int
    exceeded: int
    undecided: int
    collapsed: int
    flight: int
    failed: int
    not_used: int = 0
    scale_least: float = math.nan
    scale_median: float = math.nan
    scale_most: float = math.nan


class Undecided(NamedTuple):
    """Runs of a curve that are on an unknown side of the limit, because they flew, failed, or for another reason.

    ``runs`` is the number of all runs of the curve; ``other`` are within their error of the limit, or overturned where the
    check counts that as unknown; ``lower`` have only a lower bound, for what the demand leaves out (``remark``).
    """

    runs: int
    flight: int
    failed: int
    other: int
    lower: int = 0
    remark: str = ""

    @property
    def number(self) -> int:
        """Return the total number of undecided runs."""
        return self.flight + self.failed + self.other + self.lower

    @property
    def words(self) -> str:
        """Return "12 of 400 runs undecided: 10 flew, 2 failed"; empty if there are none."""
        kinds = {
            "flew": self.flight,
            "failed": self.failed,
            "too near to the limit, or counted as unknown": self.other,
            f"below the limit by what is computed ({self.remark})": self.lower,
        }
        parts = ", ".join(f"{number} {kind}" for kind, number in kinds.items() if number)
        return f"{self.number} of {count(self.runs, 'run')} undecided: {parts}" if parts else ""


Fitted = Lognormal | cloud.Cloud
"""A fragility curve, by whatever method."""


class Readings(NamedTuple):
    """Two curves with all undecided runs counted beyond the limit, and within it, or the reasons why there is none."""

    exceeded: Fitted | NoCurve
    withstood: Fitted | NoCurve

    @property
    def medians(self) -> tuple[float, float]:
        """Return both medians, the lower first.

        A missing curve counts as its bound: the lower one of ``exceeded``, 0 without it, and the upper one of ``withstood``,
        infinite without it.
        """
        low = self.exceeded.above if isinstance(self.exceeded, NoCurve) else self.exceeded.median
        high = self.withstood.below if isinstance(self.withstood, NoCurve) else self.withstood.median
        return min(low, high), max(low, high)

    def probability(self, x: Values) -> tuple[Values, Values]:
        """Return both P(x), the lower first, each of the shape of ``x``; 0 or 1 for one without a curve."""
        low = np.zeros(len(x)) if isinstance(self.withstood, NoCurve) else self.withstood.probability(x)
        high = np.ones(len(x)) if isinstance(self.exceeded, NoCurve) else self.exceeded.probability(x)
        return np.minimum(low, high), np.maximum(low, high)


class CloudPoint(NamedTuple):
    """A run of a cloud: number of its motion, its intensity, demand, status and state, and the number of its case."""

    motion: int
    intensity: float
    demand: float
    status: str
    state: int
    case: int = 0


@dataclass(frozen=True)
class Curve:
    """Fragility of one case for one limit."""

    case: Case
    limit: Rule
    stripes: tuple[Stripe, ...]  # counts at every level
    fitted: Fitted | NoCurve  # the curve, to which undecided runs add nothing, or why there is none
    undecided: Undecided  # number of undecided runs
    # the curves between which it lies, whatever undecided runs would have come to; None without any
    readings: Readings | None = None
    # numbers of the case and motion of each record that counts, and its capacity; of incremental dynamic analysis only
    capacities: "tuple[tuple[Member, Capacity], ...]" = ()
    # shares of the scales about the levels that exceed the limit, and the curve through them; of incremental dynamic analysis
    # only, where the case has windows
    windows: Windows | None = None
    # what each run came to; of cloud analysis only, whose ``stripes`` are these runs one by one
    cloud: tuple[CloudPoint, ...] = ()
    drawn: tuple[str, ...] = ()  # names of the inputs that are drawn for its case
    # what these contribute to its dispersion, or why that is not known; None if nothing is drawn
    drawn_share: Contribution | NoCurve | None = None
    cases: int = 1  # number of the cases that share it: piers, and both axes of one

    @property
    def inconclusive(self) -> bool:
        """Return whether undecided runs open the median, upper over lower, more than its confidence interval does.

        Without an interval, whether they leave it without a bound; False if no run is undecided, or without a curve.
        """
        if self.readings is None or isinstance(self.fitted, NoCurve):
            return False
        ratio, interval = _ratio(self.readings.medians), self.fitted.median_interval
        return math.isinf(ratio) if interval is None else ratio > _ratio(interval)

    def identity(self, varied: Sequence[str]) -> dict[str, object]:
        """Return the columns that identify it in tables: ``case``, the ``varied`` values or None, and ``limit_state``."""
        columns = {name: self.case.columns.get(name) for name in varied}
        return {"case": self.case.name, **columns, "limit_state": self.limit.name}


def _ratio(bounds: tuple[float, float]) -> float:
    low, high = bounds
    return high / low if low > 0 else math.inf


def assess(
    study: Study,
    spec: FragilitySpec,
    motions: Sequence[Motion],
    simulate: Simulate,
    plans: Sequence[LevelPlan] | None = None,
) -> list[Curve]:
    """Return the fragility curves of every case for every limit that applies to it.

    Every record is run at the levels of ``plans``, one for each case (:func:`level_plans` if they are not given). With method
    "ida" it is also run in windows about the levels and, in one wave, between the levels below its first exceedance so far,
    both on rigid ground or if the study asks for it; several waves then bisect the first exceedance. Piers share a curve if the
    measure is relative to them (:func:`_shared_by`).

    ``simulate`` is called once for the levels and windows, and once for every further wave.
    """
    plans = plans or level_plans(study, spec, motions)
    runs = RecordRuns(study, spec, motions, plans, simulate)
    cases = [describe_case(case) for case in study.cases]
    names = frozenset(case.name for case in study.cases)
    pairs = [(c, rule) for rule in spec.limits for c, case in enumerate(cases) if applies(rule, case, names)]
    first = {
        (c, m): first_intensities(spec, plans[c], m, case)
        for c, case in enumerate(study.cases)
        for m in range(len(motions))
    }
    runs.execute(Point(m, x, c) for (c, m), intensities in first.items() for x in intensities.values())

    def states_of(looked_for: Sequence[tuple[_Key, float]]) -> list[int]:
        points = [(rule, Point(m, x, c)) for (c, rule, m), x in looked_for]
        runs.execute(point for _, point in points)
        return runs.states(points)

    keys = [(c, rule, m) for c, rule in pairs for m in range(len(motions))]
    states = iter(runs.states([(rule, Point(m, x, c)) for c, rule, m in keys for x in first[c, m].values()]))
    looks = {(c, rule, m): {x: next(states) for x in first[c, m]} for c, rule, m in keys}
    shared = grouped(pairs, lambda pair: (_shared_by(study.cases[pair[0]], spec), pair[1]))
    if spec.method == "cloud":
        return [_of_cloud(runs, spec, [c for c, _ in group], rule) for (_, rule), group in shared.items()]
    if spec.method == "ida":
        looks = hunt(looks, spec.levels, lambda key: spec.step_on(study.cases[key[0]].base), states_of)
        looks = bisect(looks, spec.levels, spec.tolerance, states_of)
    curves = []
    for (_, rule), group in shared.items():
        members = [Member(c, m) for c, _ in group for m in range(len(motions))]
        curves.append(_curve(runs, spec, rule, members, [looks[c, rule, m] for c, m in members]))
    return curves


class Member(NamedTuple):
    """A record of a curve: number of its case and of its motion; several cases share a curve over what lifts their piers off."""

    case: int
    motion: int


def _shared_by(case: Case, spec: FragilitySpec) -> Hashable:
    """Return a key that cases with one curve share: name and values that are not the pier's, if the measure is relative to piers.

    With another measure each case has its own.
    """
    if spec.per_pier is None:
        return id(case)
    return case.name_along, *((name, each) for name, each in case.columns.items() if name not in PIER_KEYS)


def _common(cases: Sequence[Case]) -> Case:
    """Return the first of the cases of a curve, with only the columns that have the same values in all."""
    first = cases[0]
    if len(cases) == 1:
        return first
    same = {k: v for k, v in first.columns.items() if all(case.columns.get(k) == v for case in cases)}
    return replace(first, columns=same)


_Key = tuple[int, Rule, int]
"""Number of a case, a limit, and number of a motion."""


def _curve(
    runs: RecordRuns, spec: FragilitySpec, rule: Rule, members: Sequence[Member], looks: Sequence[Looks]
) -> Curve:
    """Return the curve fitted to the states (``looks``) of every member: to brackets with method "ida", else to stripes.

    It has the windows, if the base of the first case has some, and the contribution of drawn inputs.
    """
    on_levels = np.array([[states.get(x, LEFT_OUT) for x in spec.levels] for states in looks], dtype=np.int8)
    counted = [
        (Point(m, runs.plans[c].used[m].get(x, x), c), state)
        for (c, m), of_record in zip(members, looks, strict=True)
        for x, state in of_record.items()
        if state != LEFT_OUT
    ]
    undecided = _undecided(runs, rule, len(counted), [point for point, state in counted if state == UNDECIDED])
    station = _stations(runs, members)
    capacities: tuple[tuple[Member, Capacity], ...] = ()
    if spec.method == "ida":
        found = [capacity(states, spec.levels) for states in looks]
        capacities = tuple((member, cap) for member, cap in zip(members, found, strict=True) if cap is not None)
        fits = _through_brackets(
            [cap for _, cap in capacities], spec, _stations(runs, [member for member, _ in capacities])
        )
    else:
        fits = _through_stripes(on_levels, spec, station)
    stripes, windowed = _stripes(on_levels, spec.levels, runs, members), None
    cases = [runs.study.cases[c] for c in dict.fromkeys(c for c, _ in members)]
    if (width := spec.window_on(cases[0].base)) is not None:
        windowed = windows(looks, spec.levels, width, station, spec.confidence)
    if spec.method == "ida":
        intervals = [(Point(m, 0.0, c), *cap.decided) for (c, m), cap in capacities]
    else:
        intervals = [
            _one_sided(Point(m, runs.plans[c].used[m][x], c), state)
            for (c, m), of_record in zip(members, looks, strict=True)
            for x, state in of_record.items()
        ]
    curve = Curve(_common(cases), rule, stripes, fits[0], undecided, fits[1], capacities, windowed, cases=len(cases))
    return _with_share(curve, runs, intervals, spec.confidence)


def _stations(runs: RecordRuns, members: Sequence[Member]) -> Numbers:
    """Return the number of the cluster, a station or an earthquake, of each member."""
    return runs.clusters.of_motion[np.array([m for _, m in members], dtype=np.int64)]


Interval = tuple[Point, float, float]
"""A run, or one of a record, with the interval of its capacity."""


def _one_sided(point: Point, state: int) -> Interval:
    """Return the interval of the capacity by the state of a run: 0 to its intensity if it exceeded the limit, from there to
    infinity if it withstood, else 0 to infinity.
    """
    low, high = point.intensity if state == WITHSTOOD else 0.0, point.intensity if state == EXCEEDED else math.inf
    return point, low, high


def _with_share(curve: Curve, runs: RecordRuns, intervals: Sequence[Interval], confidence: float) -> Curve:
    """Return the curve with the contribution of drawn inputs to its dispersion; unchanged if none is drawn, or all are open."""
    informative = [interval for interval in intervals if interval[1] > 0 or math.isfinite(interval[2])]
    scores = [runs.drawn(point).scores for point, _, _ in informative]
    if not scores or not scores[0]:
        return curve
    names, uncertain = tuple(scores[0]), runs.draws.uncertain
    low, high = np.array([interval[1:] for interval in informative]).T
    motion = np.array([point.motion for point, _, _ in informative])
    station = runs.clusters.of_motion[motion]
    of_scores = np.array([list(of_run.values()) for of_run in scores])
    places = [uncertain.names.index(name) for name in names]
    capacities = Capacities(low, high, np.ones(len(low)), station=station)
    share = contribution(capacities, of_scores, uncertain.matrix[np.ix_(places, places)], confidence)
    return replace(curve, drawn=names, drawn_share=share)


def _of_cloud(runs: RecordRuns, spec: FragilitySpec, numbers: Sequence[int], rule: Rule) -> Curve:
    """Return the curve through the demands of the runs of the cases ``numbers``, without those left out or doubtful.

    If some are doubtful, its ``readings`` are the curves with these counted as overturned, and as within the limit.
    """
    points = sorted(
        (Point(m, x, c) for c in numbers for m, used in enumerate(runs.plans[c].used) for x in used),
        key=lambda run: run.intensity,
    )
    values, states = runs.demands(rule, points), runs.states([(rule, point) for point in points])
    cloud_points = tuple(
        CloudPoint(point.motion, point.intensity, float(value), runs.status[point], state, point.case)
        for point, value, state in zip(points, values, states, strict=True)
    )
    counting = [run for run in cloud_points if run.state != LEFT_OUT]
    doubtful = [run for run in counting if _is_doubtful(run)]
    undecided = _undecided(runs, rule, len(counting), [Point(run.motion, run.intensity, run.case) for run in doubtful])

    def through(points: Sequence[CloudPoint]) -> Fitted | NoCurve:
        return _through_cloud(points, rule, spec, runs.clusters.of_motion)

    fitted = through([run for run in counting if not _is_doubtful(run)])
    readings = None
    if doubtful:
        beyond = [run._replace(status="overturned", state=EXCEEDED) if _is_doubtful(run) else run for run in counting]
        within = [run._replace(demand=math.nan, state=WITHSTOOD) if _is_doubtful(run) else run for run in counting]
        readings = Readings(through(beyond), through(within))
    stripes = tuple(_stripe_of_one(run, runs.plans[run.case]) for run in cloud_points)
    cases = [runs.study.cases[c] for c in numbers]
    curve = Curve(_common(cases), rule, stripes, fitted, undecided, readings, cloud=cloud_points, cases=len(cases))
    intervals = [_one_sided(point, state) for point, state in zip(points, states, strict=True)]
    return _with_share(curve, runs, intervals, spec.confidence)


def _is_doubtful(run: CloudPoint) -> bool:
    """Return whether a run is undecided as it overturned, flew or failed; the error of a demand does not affect a line."""
    return run.state == UNDECIDED and run.status != "ok"


def _stripe_of_one(run: CloudPoint, plan: LevelPlan) -> Stripe:
    ends = (int(run.status == status) for status in NOT_STANDING)
    counts = (int(run.state != LEFT_OUT), int(run.state == EXCEEDED), int(run.state == UNDECIDED))
    factor = plan.factor(run.motion, run.intensity)
    return Stripe(run.intensity, *counts, *ends)._replace(scale_least=factor, scale_median=factor, scale_most=factor)


def _through_cloud(points: Sequence[CloudPoint], rule: Rule, spec: FragilitySpec, station: Numbers) -> Fitted | NoCurve:
    of_run = station[np.array([run.motion for run in points], dtype=np.int64)]
    x = np.array([run.intensity for run in points], dtype=np.float64)
    demand = np.array([run.demand for run in points], dtype=np.float64)
    exceeded = np.array([run.state == EXCEEDED for run in points], dtype=np.bool_)
    if DEMANDS[rule.demand].event:
        return cloud.fit_event(x, exceeded, spec.confidence, of_run)
    limit = rule.threshold
    if not limit > 0:
        return NoCurve(f"a limit of {limit:g} has no logarithm: a cloud needs one above 0")
    overturned = exceeded & np.array([run.status == "overturned" for run in points], dtype=np.bool_)
    within = ~overturned & np.isnan(demand)
    runs = cloud.Demands(x, np.where(within, 0.0, demand), overturned, within, of_run)
    return cloud.fit(runs, limit, spec.censored_below * limit, spec.confidence)


def _undecided(runs: RecordRuns, rule: Rule, counting: int, points: Sequence[Point]) -> Undecided:
    """Return the undecided runs of a curve, at ``points``, among all that are ``counting``, by what leaves them open."""
    remarks = [runs.omitted[rule, point] for point in points if (rule, point) in runs.omitted]
    status = Counter(runs.status[point] for point in points)
    flight, failed, lower = status.pop("flight", 0), status.pop("failed", 0), len(remarks)
    return Undecided(counting, flight, failed, status.total() - lower, lower, "; ".join(dict.fromkeys(remarks)))


def _stripes(
    observed: npt.NDArray[np.int8], levels: Sequence[float], runs: RecordRuns, members: Sequence[Member]
) -> tuple[Stripe, ...]:
    stripes, plans = [], runs.plans
    for x, row in zip(levels, observed.T, strict=True):
        used = [(c, m) for c, m in members if x in plans[c].used[m]]
        ended = Counter(runs.status_at(m, x, c) for c, m in used)
        counts = [int(np.count_nonzero(chosen)) for chosen in (row != LEFT_OUT, row == EXCEEDED, row == UNDECIDED)]
        ends = [ended[status] for status in NOT_STANDING]
        factors = [plans[c].factor(m, x) for c, m in used]
        least, middle, most = np.quantile(factors, [0.0, 0.5, 1.0]).tolist() if factors else 3 * [math.nan]
        not_used = sum(x in plans[c].not_used[m] for c, m in members)
        stripe = Stripe(x, *counts, *ends)
        stripes.append(stripe._replace(not_used=not_used, scale_least=least, scale_median=middle, scale_most=most))
    return tuple(stripes)


Fits = tuple[Lognormal | NoCurve, Readings | None]


def _through_stripes(observed: npt.NDArray[np.int8], spec: FragilitySpec, station: Numbers) -> Fits:
    levels = np.array(spec.levels)
    within, undecided, beyond = ((observed == state).astype(float) for state in (WITHSTOOD, UNDECIDED, EXCEEDED))

    def through(within: Values, beyond: Values) -> Lognormal | NoCurve:
        return fit(Capacities.of_same_records(levels, within, beyond, station), spec.confidence)

    fitted = through(within, beyond)
    if not undecided.any():
        return fitted, None
    return fitted, Readings(through(within, beyond + undecided), through(within + undecided, beyond))


def _through_brackets(brackets: Sequence[Capacity], spec: FragilitySpec, station: Numbers) -> Fits:
    def through(ends: Sequence[Bracket]) -> Lognormal | NoCurve:
        low, high = np.array(ends, dtype=np.float64).reshape(-1, 2).T
        return fit(Capacities.of_brackets(low, high, station), spec.confidence)

    fitted = through([bracket.decided for bracket in brackets])
    if not any(bracket.undecided for bracket in brackets):
        return fitted, None
    return fitted, Readings(
        *(through([getattr(bracket, name) for bracket in brackets]) for name in ("if_exceeded", "if_withstood"))
    )
