"""The points of a sensitivity study, and the runs at them."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

from rockbatch.analysis.sobol import design
from rockbatch.batch.plan import Made, PlannedRun, scaled
from rockbatch.motions import Motion
from rockbatch.simulation.outcome import Outcome
from rockbatch.study import Case, Study
from rockbatch.study.sensitivity import Input, SensitivitySpec, Value, applying, own_values, varied

RUNS = "sensitivity_runs.csv"
COLUMNS = ("record", "polarity", "scale", "status", "theta_max_over_alpha", "reason")
"""Columns of :data:`RUNS`."""


@dataclass(frozen=True)
class Point:
    """A case, with values of its inputs in place of its own."""

    case: int
    values: Mapping[str, Value]


def low_base_high(inputs: Sequence[Input], study: Study, case: Case) -> list[dict[str, Value]]:
    """Return the study's own values; then, for each input, its low end and its high one with all others as they are.

    A restitution that is an input and that the study does not give is Housner's of its own pier.
    """
    own = own_values(study, case)
    if own.get("restitution", 0.0) is None:
        own["restitution"] = case.pier.restitution
    base = {parameter.name: own[parameter.name] for parameter in inputs}
    return [base, *(base | {parameter.name: level} for parameter in inputs for level in parameter.levels)]


class Points:
    """All points of a sensitivity study: for each case those one at a time, then those of Sobol's indices.

    ``inputs`` are those of each case, ``parts`` the places of its two kinds of points.
    """

    def __init__(self, study: Study, spec: SensitivitySpec) -> None:
        self.inputs = [applying(spec.inputs, case) for case in study.cases]
        self.parts: list[tuple[slice, slice]] = []
        self.all: list[Point] = []
        for place, (case, inputs) in enumerate(zip(study.cases, self.inputs, strict=True)):
            ends = [len(self.all)]
            many = design(inputs, spec.samples, spec.seed) if inputs else []  # a rigid base may have none of them
            for group in (low_base_high(inputs, study, case), many):
                self.all += [Point(place, values) for values in group]
                ends.append(len(self.all))
            self.parts.append((slice(*ends[:2]), slice(*ends[1:])))

    def __len__(self) -> int:
        return len(self.all)


class Suite:
    """The motions that count at every point: all of the study, in its scales, and in one polarity unless it is an input."""

    def __init__(self, study: Study, points: Points, motions: Sequence[Motion]) -> None:
        self.cases, self.points = study.cases, points
        turned = any(parameter.name == "polarity" for inputs in points.inputs for parameter in inputs)
        polarity = "+" if turned else study.motions.simulated
        self.members = [(number, polarity, scale) for number in range(len(motions)) for scale in study.motions.scale]
        self._motions = {True: motions, False: [replace(motion, vertical=None) for motion in motions]}
        self._moved = lru_cache(maxsize=8)(
            lambda number, polarity, scale, vertical: scaled(self._motions[vertical][number], scale, polarity)
        )

    def runs(self) -> Made:
        """Return every motion at every point, the points running fastest: neighbours share their motion."""
        return Made(len(self.members) * len(self.points), self._run)

    def _run(self, index: int) -> PlannedRun:
        member, place = divmod(index, len(self.points))
        point = self.points.all[place]
        number, polarity, scale = self.members[member]
        polarity = str(point.values.get("polarity", polarity))
        vertical = bool(point.values.get("vertical", True))
        motion = self._moved(number, polarity, scale, vertical)
        return PlannedRun(motion, polarity, scale, self.case(point), self._motions[vertical][number])

    def case(self, point: Point) -> Case:
        """Return the case at a point."""
        return varied(self.cases[point.case], point.values)

    def some_cases(self) -> tuple[Case, ...]:
        """Return cases all over the design, which between them need every kernel that the others need."""
        return tuple(map(self.case, self.points.all[:: 1 + len(self.points) // 64]))


def row_of(run: PlannedRun, outcome: Outcome) -> dict[str, Any]:
    """Return what is kept of a run."""
    return {
        "record": run.motion.name,
        "polarity": run.polarity,
        "scale": run.scale,
        "status": outcome.status,
        "theta_max_over_alpha": outcome.theta_max / run.case.pier.alpha,
        "reason": outcome.reason,
    }
