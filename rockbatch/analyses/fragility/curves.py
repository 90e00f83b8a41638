"""Fragility curves of every case: through stripes, the capacities of an incremental dynamic analysis, or a cloud of demands."""

import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from rockbatch.analyses.fragility import cloud
from rockbatch.analyses.fragility.ida import Bracket, Capacity, Looks, bisect, capacity, hunt
from rockbatch.analyses.fragility.limit_states import EXCEEDED, LEFT_OUT, UNDECIDED, WITHSTOOD, applies, threshold
from rockbatch.analyses.fragility.lognormal import Capacities, Contribution, Lognormal, Values, contribution, fit
from rockbatch.analyses.fragility.runs import LevelPlan, Point, RecordRuns, Simulate, first_intensities, level_plan
from rockbatch.analyses.fragility.study import FragilitySpec
from rockbatch.analyses.fragility.windows import Windows, windows
from rockbatch.batch.listening import count
from rockbatch.motions import Motion
from rockbatch.quantities.catalogue import DEMANDS
from rockbatch.results.run_json import describe_case
from rockbatch.study import Case, Study
from rockbatch.study.rules import Rule


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
    """Runs of a curve of which it is not known on which side of the limit they are: they flew, failed, or else.

    ``runs`` is the number of all runs of the curve; ``other`` are within their error of the limit, or overturned where the
    check counts that as unknown.
    """

    runs: int
    flight: int
    failed: int
    other: int

    @property
    def number(self) -> int:
        """Return the number of all of them."""
        return self.flight + self.failed + self.other

    @property
    def words(self) -> str:
        """Return "12 of 400 runs undecided: 10 flew, 2 failed"; empty if there are none."""
        kinds = {"flew": self.flight, "failed": self.failed, "too near to the limit, or counted as unknown": self.other}
        parts = ", ".join(f"{number} {kind}" for kind, number in kinds.items() if number)
        return f"{self.number} of {count(self.runs, 'run')} undecided: {parts}" if parts else ""


Fitted = Lognormal | cloud.Cloud
"""A fragility curve, by whatever method."""


class Readings(NamedTuple):
    """The curves with all undecided runs counted as beyond the limit, and as within it, or why there is none."""

    exceeded: Fitted | str
    withstood: Fitted | str

    @property
    def medians(self) -> tuple[float, float]:
        """Return both medians, the lower first; 0 or infinite for one without a curve."""
        low = 0.0 if isinstance(self.exceeded, str) else self.exceeded.median
        high = math.inf if isinstance(self.withstood, str) else self.withstood.median
        return min(low, high), max(low, high)

    def probability(self, x: Values) -> tuple[Values, Values]:
        """Return both P(x), the lower first, each of the shape of ``x``; 0 or 1 for one without a curve."""
        low = np.zeros(len(x)) if isinstance(self.withstood, str) else self.withstood.probability(x)
        high = np.ones(len(x)) if isinstance(self.exceeded, str) else self.exceeded.probability(x)
        return np.minimum(low, high), np.maximum(low, high)


class CloudPoint(NamedTuple):
    """A run of a cloud: number of its motion, its intensity, its demand, its status, and its state."""

    motion: int
    intensity: float
    demand: float
    status: str
    state: int


@dataclass(frozen=True)
class Curve:
    """Fragility of one case for one limit.

    Attributes
    ----------
    case, limit
        Its case and its limit.
    stripes : tuple of Stripe
        Counts at every level.
    fitted : Lognormal, Cloud or str
        The curve, to which undecided runs add nothing, or why there is none.
    undecided : Undecided
        Number of undecided runs.
    readings : Readings or None
        The curves between which it lies, whatever undecided runs would have come to; None without any.
    capacities : tuple of (int, Capacity)
        Number of each motion that counts, and its capacity; of incremental dynamic analysis only.
    windows : Windows or None
        Shares of the scales about the levels that exceed the limit, and the curve through them; of incremental dynamic
        analysis only, where the case has windows.
    cloud : tuple of CloudPoint
        What each run came to; of cloud analysis only, whose ``stripes`` are these runs one by one.
    drawn : tuple of str
        Names of the inputs that are drawn for its case.
    drawn_share : Contribution, str or None
        What these contribute to its dispersion, or why that is not known; None if nothing is drawn.
    """

    case: Case
    limit: Rule
    stripes: tuple[Stripe, ...]
    fitted: Fitted | str
    undecided: Undecided
    readings: Readings | None = None
    capacities: tuple[tuple[int, Capacity], ...] = ()
    windows: Windows | None = None
    cloud: tuple[CloudPoint, ...] = ()
    drawn: tuple[str, ...] = ()
    drawn_share: Contribution | str | None = None

    @property
    def inconclusive(self) -> bool:
        """Return whether undecided runs leave the median more open than the number of records does."""
        if self.readings is None or isinstance(self.fitted, str):
            return False
        return _ratio(self.readings.medians) > _ratio(self.fitted.median_interval)

    def identity(self, varied: Sequence[str]) -> dict[str, Any]:
        """Return the columns that name it in tables: its case, the ``varied`` values of that, and its limit."""
        columns = {name: self.case.columns.get(name) for name in varied}
        return {"case": self.case.name, **columns, "limit_state": self.limit.name}


def _ratio(bounds: tuple[float, float]) -> float:
    low, high = bounds
    return high / low if low > 0 else math.inf


def assess(
    study: Study, spec: FragilitySpec, motions: Sequence[Motion], simulate: Simulate, plan: LevelPlan | None = None
) -> list[Curve]:
    """Return the fragility curves of every case for every limit that applies to it.

    Every record is run at the levels of ``plan``, at all of them if it is not given, and with method "ida" in the windows about
    them; the first exceedance of every record is then sought below that so far, in one wave, and bisected, in more of them.

    ``simulate`` is called once for the levels and windows and once for every wave, each depending on the rows before.
    """
    plan = plan or level_plan(study, spec, motions)
    runs = RecordRuns(study, spec, motions, plan, simulate)
    cases = [describe_case(case) for case in study.cases]
    pairs = [(c, rule) for rule in spec.limits for c, case in enumerate(cases) if applies(rule, case)]
    first = {
        (c, m): first_intensities(spec, plan, m, case)
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
    if spec.method == "cloud":
        return [_of_cloud(runs, spec, c, rule) for c, rule in pairs]
    if spec.method == "ida":
        looks = hunt(looks, spec.levels, lambda key: spec.step_on(study.cases[key[0]].base), states_of)
        looks = bisect(looks, spec.levels, spec.tolerance, states_of)
    return [_curve(runs, spec, c, rule, [looks[c, rule, m] for m in range(len(motions))]) for c, rule in pairs]


_Key = tuple[int, Rule, int]
"""Number of a case, a limit, and number of a motion."""


def _curve(runs: RecordRuns, spec: FragilitySpec, case: int, rule: Rule, looks: Sequence[Looks]) -> Curve:
    """Return the curve through the states of every motion."""
    on_levels = np.array([[states.get(x, LEFT_OUT) for x in spec.levels] for states in looks], dtype=np.int8)
    undecided = _undecided(runs, case, looks)
    capacities: tuple[tuple[int, Capacity], ...] = ()
    if spec.method == "ida":
        by_motion = ((m, capacity(states, spec.levels)) for m, states in enumerate(looks))
        capacities = tuple((m, found_capacity) for m, found_capacity in by_motion if found_capacity is not None)
        fits = _through_brackets([found_capacity for _, found_capacity in capacities], spec)
    else:
        fits = _through_stripes(on_levels, spec)
    stripes, of_case, windowed = _stripes(on_levels, spec.levels, runs, case), runs.study.cases[case], None
    if (width := spec.window_on(of_case.base)) is not None:
        windowed = windows(looks, spec.levels, width, spec.confidence)
    if spec.method == "ida":
        intervals = [(Point(m, 0.0, case), *cap.decided) for m, cap in capacities]
    else:
        used = runs.plan.used
        intervals = [
            _one_sided(Point(m, used[m][x], case), state)
            for m, of_record in enumerate(looks)
            for x, state in of_record.items()
        ]
    curve = Curve(of_case, rule, stripes, fits[0], undecided, fits[1], capacities, windowed)
    return _with_share(curve, runs, intervals, spec.confidence)


Interval = tuple[Point, float, float]
"""A run, or one of a record, with the interval of its capacity."""


def _one_sided(point: Point, state: int) -> Interval:
    """Return the interval that the state of a run gives: any capacity if it is not decided."""
    low, high = point.intensity if state == WITHSTOOD else 0.0, point.intensity if state == EXCEEDED else math.inf
    return point, low, high


def _with_share(curve: Curve, runs: RecordRuns, intervals: Sequence[Interval], confidence: float) -> Curve:
    """Return the curve with what drawn inputs contribute to its dispersion, by the intervals of capacities."""
    informative = [interval for interval in intervals if interval[1] > 0 or math.isfinite(interval[2])]
    scores = [runs.drawn(point).scores for point, _, _ in informative]
    if not scores or not scores[0]:
        return curve
    names, uncertain = tuple(scores[0]), runs.draws.uncertain
    low, high = np.array([interval[1:] for interval in informative]).T
    motion = np.array([point.motion for point, _, _ in informative])
    of_record = (motion == np.unique(motion)[:, None]).astype(np.float64)
    of_scores = np.array([list(of_run.values()) for of_run in scores])
    places = [uncertain.names.index(name) for name in names]
    capacities = Capacities(low, high, np.ones(len(low)), of_record)
    share = contribution(capacities, of_scores, uncertain.matrix[np.ix_(places, places)], confidence)
    return replace(curve, drawn=names, drawn_share=share)


def _of_cloud(runs: RecordRuns, spec: FragilitySpec, case: int, rule: Rule) -> Curve:
    """Return the curve through the demands of all runs."""
    points = sorted(
        (Point(m, x, case) for m, used in enumerate(runs.plan.used) for x in used), key=lambda run: run.intensity
    )
    values, states = runs.demands(rule, points), runs.states([(rule, point) for point in points])
    cloud_points = tuple(
        CloudPoint(point.motion, point.intensity, float(value), runs.status[point], state)
        for point, value, state in zip(points, values, states, strict=True)
    )
    counting = [run for run in cloud_points if run.state != LEFT_OUT]
    doubtful = [run for run in counting if _is_doubtful(run)]
    ended = Counter(run.status for run in doubtful)
    not_converged = len(doubtful) - ended["flight"] - ended["failed"]
    undecided = Undecided(len(counting), ended["flight"], ended["failed"], not_converged)
    fitted = _through_cloud([run for run in counting if not _is_doubtful(run)], rule, spec)
    readings = None
    if doubtful:
        beyond = [run._replace(status="overturned", state=EXCEEDED) if _is_doubtful(run) else run for run in counting]
        within = [run._replace(demand=math.nan, state=WITHSTOOD) if _is_doubtful(run) else run for run in counting]
        readings = Readings(_through_cloud(beyond, rule, spec), _through_cloud(within, rule, spec))
    stripes = tuple(_stripe_of_one(run, runs.plan) for run in cloud_points)
    curve = Curve(runs.study.cases[case], rule, stripes, fitted, undecided, readings, cloud=cloud_points)
    intervals = [_one_sided(point, state) for point, state in zip(points, states, strict=True)]
    return _with_share(curve, runs, intervals, spec.confidence)


def _is_doubtful(run: CloudPoint) -> bool:
    """Return whether a run is undecided for another reason than the error of its demand, which a line does not mind."""
    return run.state == UNDECIDED and run.status != "ok"


def _stripe_of_one(run: CloudPoint, plan: LevelPlan) -> Stripe:
    ends = (int(run.status == status) for status in ("overturned", "flight", "failed"))
    counts = (int(run.state != LEFT_OUT), int(run.state == EXCEEDED), int(run.state == UNDECIDED))
    factor = plan.factor(run.motion, run.intensity)
    return Stripe(run.intensity, *counts, *ends)._replace(scale_least=factor, scale_median=factor, scale_most=factor)


def _through_cloud(points: Sequence[CloudPoint], rule: Rule, spec: FragilitySpec) -> Fitted | str:
    x = np.array([run.intensity for run in points], dtype=np.float64)
    demand = np.array([run.demand for run in points], dtype=np.float64)
    exceeded = np.array([run.state == EXCEEDED for run in points], dtype=np.bool_)
    if DEMANDS[rule.demand].event:
        return cloud.fit_event(x, exceeded, spec.confidence)
    limit = threshold(rule)
    if not limit > 0:
        return f"a limit of {limit:g} has no logarithm: a cloud needs one above 0"
    overturned = exceeded & np.array([run.status == "overturned" for run in points], dtype=np.bool_)
    within = ~overturned & np.isnan(demand)
    runs = cloud.Demands(x, np.where(within, 0.0, demand), overturned, within)
    return cloud.fit(runs, limit, spec.censored_below * limit, spec.confidence)


def _undecided(runs: RecordRuns, case: int, looks: Sequence[Looks]) -> Undecided:
    counted = [(m, x, state) for m, states in enumerate(looks) for x, state in states.items()]
    status = Counter(runs.status_at(m, x, case) for m, x, state in counted if state == UNDECIDED)
    flight, failed = status.pop("flight", 0), status.pop("failed", 0)
    return Undecided(sum(state != LEFT_OUT for _, _, state in counted), flight, failed, status.total())


def _stripes(
    observed: npt.NDArray[np.int8], levels: Sequence[float], runs: RecordRuns, case: int
) -> tuple[Stripe, ...]:
    stripes, plan = [], runs.plan
    for x, row in zip(levels, observed.T, strict=True):
        used = [m for m, intensities in enumerate(plan.used) if x in intensities]
        ended = Counter(runs.status_at(m, x, case) for m in used)
        counts = [int(np.count_nonzero(members)) for members in (row != LEFT_OUT, row == EXCEEDED, row == UNDECIDED)]
        ends = [ended[status] for status in ("overturned", "flight", "failed")]
        factors = [plan.factor(m, x) for m in used]
        least, middle, most = np.quantile(factors, [0.0, 0.5, 1.0]).tolist() if factors else 3 * [math.nan]
        not_used = sum(x in intensities for intensities in plan.not_used)
        stripe = Stripe(x, *counts, *ends)
        stripes.append(stripe._replace(not_used=not_used, scale_least=least, scale_median=middle, scale_most=most))
    return tuple(stripes)


Fits = tuple[Lognormal | str, Readings | None]


def _through_stripes(observed: npt.NDArray[np.int8], spec: FragilitySpec) -> Fits:
    levels = np.array(spec.levels)
    within, undecided, beyond = ((observed == state).astype(float) for state in (WITHSTOOD, UNDECIDED, EXCEEDED))

    def through(within: Values, beyond: Values) -> Lognormal | str:
        return fit(Capacities.of_same_records(levels, within, beyond), spec.confidence)

    fitted = through(within, beyond)
    if not undecided.any():
        return fitted, None
    return fitted, Readings(through(within, beyond + undecided), through(within + undecided, beyond))


def _through_brackets(capacities: Sequence[Capacity], spec: FragilitySpec) -> Fits:
    def through(brackets: Sequence[Bracket]) -> Lognormal | str:
        low, high = np.array(brackets, dtype=np.float64).reshape(-1, 2).T
        informative = (low > 0) | np.isfinite(high)
        return fit(Capacities(low[informative], high[informative], np.ones(informative.sum())), spec.confidence)

    fitted = through([bracket.decided for bracket in capacities])
    if not any(bracket.undecided for bracket in capacities):
        return fitted, None
    return fitted, Readings(
        *(through([getattr(bracket, name) for bracket in capacities]) for name in ("if_exceeded", "if_withstood"))
    )
