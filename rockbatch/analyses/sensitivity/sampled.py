"""Points of a sensitivity study, the runs at them, and Sobol's indices of the answers, by SALib.

Of the variance of the answer, while all inputs vary at once over their ranges, the first-order index of an input is
the share that goes with it alone, and the total index the share that would be left if only it were unknown (Saltelli et al. 2010,
Comput. Phys. Commun. 181, 259–270).
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from rockbatch.analyses.sensitivity.columns import SOBOL
from rockbatch.analyses.sensitivity.study import OF_MOTION, Input, SensitivitySpec, Value, applying, own_values
from rockbatch.batch.plan import Made
from rockbatch.common.lazy import pd
from rockbatch.motions import Motion
from rockbatch.results.columns import StudyRun
from rockbatch.study import Case, Study
from rockbatch.study.inputs import varied

RUNS = "sensitivity_runs.csv"
COLUMNS = ("record", "polarity", "scale", "status", "theta_max_over_alpha", "reason")
"""Columns of :data:`RUNS`."""

RESAMPLES = 1000
"""Resamples of the bootstrap that gives the intervals."""


@dataclass(frozen=True)
class Point:
    """A case, with values of its inputs in place of its own."""

    case: int
    values: Mapping[str, Value]


def low_base_high(inputs: Sequence[Input], study: Study, case: Case) -> list[dict[str, Value]]:
    """Return the study's own values of the inputs, then these with each input in turn at its low and at its high end.

    A restitution that the study does not give is Housner's for its own pier.
    """
    values_of_study = own_values(study, case)
    if values_of_study.get("restitution", 0.0) is None:
        values_of_study["restitution"] = case.pier.restitution
    base = {parameter.name: values_of_study[parameter.name] for parameter in inputs}
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


class Design:
    """The motions that count at every point: all of the study, in its scales, and in one polarity unless it is an input."""

    def __init__(self, study: Study, points: Points, motions: Sequence[Motion]) -> None:
        self.cases, self.points = study.cases, points
        polarity = study.motions.simulated
        self.members = [(number, polarity, scale) for number in range(len(motions)) for scale in study.motions.scale]
        self._motions = {True: motions, False: [replace(motion, vertical=None) for motion in motions]}

    def runs(self) -> Made:
        """Return every motion at every point, the points running fastest: neighbours share their motion."""
        return Made(len(self.members) * len(self.points), self._run)

    def _run(self, index: int) -> StudyRun:
        member, place = divmod(index, len(self.points))
        point = self.points.all[place]
        number, polarity, scale = self.members[member]
        polarity = str(point.values.get("polarity", polarity))
        vertical = bool(point.values.get("vertical", True))
        return StudyRun(self._motions[vertical][number], polarity, scale, self.case(point))

    def case(self, point: Point) -> Case:
        """Return the case at a point."""
        values = {name: value for name, value in point.values.items() if name not in OF_MOTION}
        return varied(self.cases[point.case], values)

    def some_cases(self) -> tuple[Case, ...]:
        """Return up to 64 cases spread evenly over the points, to compile the kernels that the others need."""
        return tuple(map(self.case, self.points.all[:: 1 + len(self.points) // 64]))


def row_of(run: StudyRun) -> dict[str, object]:
    """Return the row of a finished run in the table of runs, by :data:`COLUMNS`, from record to reason."""
    outcome = run.outcome
    assert outcome is not None
    return {
        "record": run.record.name,
        "polarity": run.polarity,
        "scale": run.scale,
        "status": outcome.status,
        "theta_max_over_alpha": outcome.theta_max / run.case.pier.alpha,
        "reason": outcome.reason,
    }


def problem(inputs: Sequence[Input]) -> dict[str, object]:
    """Return SALib's problem of the inputs, in which a choice is uniform from 0 to 1."""
    distributions = {"uniform": "unif", "log_uniform": "logunif", "choice": "unif"}
    return {
        "num_vars": len(inputs),
        "names": [parameter.name for parameter in inputs],
        "bounds": [[0.0, 1.0] if parameter.spread == "choice" else list(parameter.levels) for parameter in inputs],
        "dists": [distributions[parameter.spread] for parameter in inputs],
    }


def design(inputs: Sequence[Input], samples: int, seed: int) -> list[dict[str, Value]]:
    """Return Saltelli's design on a scrambled Sobol sequence: ``samples`` × (inputs + 2) points, the values of each by name."""
    from SALib.sample import sobol

    drawn = sobol.sample(problem(inputs), samples, calc_second_order=False, seed=seed)
    names = [parameter.name for parameter in inputs]
    return [dict(zip(names, map(_sampled_value, inputs, point), strict=True)) for point in drawn]


def _sampled_value(parameter: Input, x: float) -> Value:
    """Return an input at a coordinate of SALib's design, for a choice the second value from 0.5 on."""
    return parameter.levels[int(x >= 0.5)] if parameter.spread == "choice" else float(x)


def indices(inputs: Sequence[Input], answers: npt.NDArray[np.float64], confidence: float, seed: int) -> "pd.DataFrame":
    """Return the first-order and total index of each input, from the ``answers`` at the points of :func:`design`.

    A row has the input as ``parameter``, ``first``, ``total`` and the half widths of their intervals by a bootstrap,
    ``first_error`` and ``total_error``; NaN if all answers are the same.
    """
    from SALib.analyze import sobol

    table = pd.DataFrame({"parameter": [parameter.name for parameter in inputs]}, columns=list(SOBOL), dtype=object)
    names = {"first": "S1", "first_error": "S1_conf", "total": "ST", "total_error": "ST_conf"}
    if np.ptp(answers) == 0:
        return table.astype(dict.fromkeys(names, float))
    estimates = sobol.analyze(
        problem(inputs), answers, calc_second_order=False, num_resamples=RESAMPLES, conf_level=confidence, seed=seed
    )
    return table.assign(**{name: estimates[theirs] for name, theirs in names.items()})
