"""The runs of a fragility: which intensities each record is run at, and what the runs come to with respect to limits."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from rockbatch.analyses.fragility.clusters import clusters
from rockbatch.analyses.fragility.limit_states import LEFT_OUT, UNDECIDED, demands, open_by_omission, states
from rockbatch.analyses.fragility.measures import as_they_come
from rockbatch.analyses.fragility.stripes import members
from rockbatch.analyses.fragility.study import FragilitySpec
from rockbatch.analyses.fragility.uncertain import Drawn, Draws
from rockbatch.analyses.fragility.windows import samples
from rockbatch.batch.plan import Made
from rockbatch.checks.rules import Rule
from rockbatch.common.errors import InputError
from rockbatch.common.grouping import grouped
from rockbatch.common.lazy import pd
from rockbatch.motions import Motion
from rockbatch.quantities.arrays import Rows
from rockbatch.quantities.catalogue import DEMANDS
from rockbatch.results.columns import StudyRun
from rockbatch.study import Case, Output, Study


class Point(NamedTuple):
    """A run: numbers of the motion and the case, and the intensity that the motion is scaled to."""

    motion: int
    intensity: float
    case: int


class ScaledRuns(Made):
    """The runs of some points in one polarity, scaled by the plan of the case of each."""

    def __init__(
        self,
        points: Sequence[Point],
        motions: Sequence[Motion],
        plans: "Sequence[LevelPlan]",
        case_at: Callable[[Point], Case],
        polarity: str,
    ) -> None:
        self.points = points

        def make(number: int) -> StudyRun:
            point = points[number]
            motion, intensity, case = point
            drawn = case_at(point)
            return StudyRun(drawn.motion(motions[motion]), polarity, plans[case].scale(motion, intensity), drawn)

        super().__init__(len(points), make)


class LevelPlan(NamedTuple):
    """Levels at which each motion is run.

    ``unscaled`` are the intensities of the motions without a scale, which grow with it to ``power``, and ``earlier`` the
    factors by which the study scaled them to its target. ``used`` has, by level, the intensity with which a motion is run: the
    level itself, or the result of a given factor. ``not_used`` has the levels whose factor is beyond the limits of the study.
    """

    unscaled: list[float]
    earlier: list[float]
    used: list[dict[float, float]]
    not_used: list[dict[float, float]]
    power: float = 1.0

    def scale(self, motion: int, intensity: float) -> float:
        """Return the factor that scales an unscaled motion to an intensity."""
        return float((intensity / self.unscaled[motion]) ** (1.0 / self.power))

    def reached(self, motion: int, scale: float) -> float:
        """Return the intensity of an unscaled motion times a factor."""
        return float(self.unscaled[motion] * scale**self.power)

    def factor(self, motion: int, level: float) -> float:
        """Return the factor at a level on a motion as it was recorded."""
        intensity = (self.used[motion] | self.not_used[motion])[level]
        return self.earlier[motion] * self.scale(motion, intensity)

    def number(self, motion: int, intensity: float) -> int:
        """Return the place of the level that is run with an intensity among all levels of a motion, in rising order."""
        levels = sorted(self.used[motion] | self.not_used[motion])
        return next(n for n, level in enumerate(levels) if self.used[motion].get(level) == intensity)


def level_plans(study: Study, spec: FragilitySpec, motions: Sequence[Motion]) -> list[LevelPlan]:
    """Return the levels of every motion, a plan for each case: the same plan, unless intensities are relative to its pier.

    Raises ``InputError`` if limits on factors leave a case without a run, if a stripe names no record, and for a record whose
    measure is 0 or unknown.
    """
    gravity = study.cases[0].pier.gravity
    unscaled = intensities(motions, spec, gravity)
    scales_by_level = members(study.file(), spec.stripes, [motion.name for motion in motions])
    if spec.per_pier is None:
        return [_level_plan(study, spec, motions, unscaled, scales_by_level)] * len(study.cases)
    of_axes = {tuple(motions): unscaled}
    plans = []
    for case in study.cases:
        on_axis = tuple(map(case.motion, motions))
        if on_axis not in of_axes:
            of_axes[on_axis] = intensities(on_axis, spec, gravity)
        over = spec.per_pier(case.pier)
        relative = [x * over for x in of_axes[on_axis]]
        plans.append(_level_plan(study, spec, motions, relative, scales_by_level))
    return plans


def _level_plan(
    study: Study,
    spec: FragilitySpec,
    motions: Sequence[Motion],
    unscaled: list[float],
    scales_by_level: Sequence[dict[int, float | None]],
) -> LevelPlan:
    earlier = [motion.factor for motion in motions]
    plan = LevelPlan(unscaled, earlier, [{} for _ in motions], [{} for _ in motions], spec.power)
    if spec.method == "cloud":
        for m, used in enumerate(plan.used):
            used.update({x: x for x in (plan.reached(m, scale) for scale in study.motions.scale)})
        return plan
    for i, level in enumerate(spec.levels):
        scales = scales_by_level[i] if scales_by_level else dict.fromkeys(range(len(motions)))
        for m, scale in scales.items():
            intensity = level if scale is None else plan.reached(m, scale / earlier[m])
            factor = earlier[m] * plan.scale(m, intensity)
            (plan.used if spec.allows(factor) else plan.not_used)[m][level] = intensity
    if not any(plan.used):
        limits = f"least_scale = {spec.least_scale:g} and most_scale = {spec.most_scale:g}"
        raise InputError(
            f"{study.path}: [fragility]: {limits}: no record reaches a level with such a factor; widen them"
        )
    return plan


def first_intensities(spec: FragilitySpec, plan: LevelPlan, motion: int, case: Case) -> dict[float, float]:
    """Return the intensities of a motion's runs that depend on no other run, by level.

    Those in the windows about its levels that the limits on factors allow are there, too, each by itself.
    """
    used, earlier = plan.used[motion], plan.earlier[motion]
    around = (x for level in used for x in samples(level, spec.window_on(case.base)))
    return used | {x: x for x in around if spec.allows(earlier * plan.scale(motion, x))}


Simulate = Callable[[ScaledRuns], "pd.DataFrame"]
"""From runs to their rows of peaks.csv, in their order."""


def output(spec: FragilitySpec, of_study: Output) -> Output:
    """Return the settings of [output] with only the outputs that the limits need."""
    demands = [DEMANDS[rule.demand] for rule in spec.limits]
    return of_study.only({key for demand in demands for key in (demand.needs, *demand.brings)})


def intensities(motions: Sequence[Motion], spec: FragilitySpec, gravity: float) -> list[float]:
    """Return the intensity measure of every motion as it comes, in g, m/s or the unit of an own measure.

    Raises ``InputError`` with every motion whose measure is not above 0, or of which an own measure has no value.
    """
    measures = as_they_come([*motions], spec, gravity)
    still = [motion for motion, value in zip(motions, measures, strict=True) if not value > 0]
    reason = (
        f"its horizontal component has {spec.label} = 0, and no scale brings it to a level; take it out of [motions]"
    )
    wrong = [f"{motion.name}: {reason}" for motion in still]
    if wrong:
        raise InputError(*wrong)
    return measures


class RecordRuns:
    """All runs of an analysis, each once, with their rows."""

    def __init__(
        self,
        study: Study,
        spec: FragilitySpec,
        motions: Sequence[Motion],
        plans: Sequence[LevelPlan],
        simulate: Simulate,
    ) -> None:
        self.study, self.motions, self.plans, self.simulate = study, motions, plans, simulate
        self.clusters = clusters(motions)
        self.draws = Draws(spec.uncertain, study.cases, len(motions))
        self.draws_by_level = bool(spec.uncertain.inputs) and spec.method != "ida"
        self.status: dict[Point, str] = {}
        self.omitted: dict[tuple[Rule, Point], str] = {}
        self._last: tuple[dict[Point, int], Rows]

    def execute(self, requested: Iterable[Point]) -> None:
        """Execute one wave of runs, each point in it once; keep their statuses, and their rows until the next wave."""
        points = sorted({*requested})  # what shares a motion stands together
        polarity = self.study.motions.simulated
        runs = ScaledRuns(points, self.motions, self.plans, lambda point: self.drawn(point).case, polarity)
        table = self.simulate(runs)
        self.status |= dict(zip(points, table["status"], strict=True))
        self._last = {point: i for i, point in enumerate(points)}, Rows(table)

    def drawn(self, point: Point) -> Drawn:
        """Return the case of a run, as it is drawn for its motion and level, or with method "ida" once for its motion."""
        level = self.plans[point.case].number(point.motion, point.intensity) if self.draws_by_level else 0
        return self.draws.at(point.case, point.motion, level)

    def status_at(self, motion: int, level: float, case: int) -> str:
        """Return the status of the run of a motion at a level, or at an intensity between the levels."""
        return self.status[Point(motion, self.plans[case].used[motion].get(level, level), case)]

    def demands(self, rule: Rule, points: Sequence[Point]) -> npt.NDArray[np.float64]:
        """Return the demands of runs, which are all of the last wave, shape (n,)."""
        values = np.empty(len(points))
        for drawn, numbers, runs in self._together(points):
            values[numbers] = demands(rule, runs, drawn.described)
        return values

    def states(self, requested: Sequence[tuple[Rule, Point]]) -> list[int]:
        """Return the state of each run, all of the last wave, with respect to its limit: LEFT_OUT to EXCEEDED, in this order.

        Of undecided runs that stand, keep the remark on what their demand leaves out (``omitted``), if that leaves them open.
        """
        result = np.full(len(requested), LEFT_OUT)
        for rule, numbers in grouped(range(len(requested)), lambda number: requested[number][0]).items():
            for drawn, places, runs in self._together([requested[number][1] for number in numbers]):
                of_case = np.array(numbers)[places]
                result[of_case] = states(rule, runs, drawn.described)
                is_open, remark = open_by_omission(rule, runs, drawn.described)
                is_open &= result[of_case] == UNDECIDED
                self.omitted |= {requested[number]: remark for number in of_case[is_open]}
        return result.tolist()

    def _together(self, points: Sequence[Point]) -> Iterator[tuple[Drawn, list[int], Rows]]:
        """Yield each case as it is drawn, the places of its runs among ``points``, all of the last wave, and their rows."""
        of_row, runs = self._last
        for drawn, places in grouped(range(len(points)), lambda place: self.drawn(points[place])).items():
            yield drawn, places, runs.at(np.array([of_row[points[place]] for place in places]))
