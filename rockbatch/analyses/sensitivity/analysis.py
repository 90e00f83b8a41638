"""Sensitivity of the peak rotation to the inputs of a study: the analysis and its tables.

The answer is a statistic of the suite, at every point: at both ends of each input alone, and at the points of Sobol's
indices.
"""

import csv
import os
from array import array
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from rockbatch.analyses.sensitivity import sampled
from rockbatch.analyses.sensitivity.columns import SOBOL, TORNADO
from rockbatch.analyses.sensitivity.sampled import Design, Point, Points, indices
from rockbatch.analyses.sensitivity.study import Input, SensitivitySpec, Value, read_sensitivity
from rockbatch.batch.digests import digests
from rockbatch.batch.listening import Progress, count, once
from rockbatch.batch.threads import Engine
from rockbatch.common.arguments import checked
from rockbatch.common.files import opened_text
from rockbatch.common.grouping import joined
from rockbatch.common.lazy import pd
from rockbatch.common.statuses import NO_PEAK
from rockbatch.quantities.statistics import STATISTICS, Values
from rockbatch.study import Motions, Study
from rockbatch.workflow.analysis import Analysis, AnalysisFolder, run_analysis

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class Sensitivity(Analysis):
    """Sensitivity of the peak rotation; see also :class:`rockbatch.workflow.analysis.Analysis`.

    Attributes
    ----------
    sensitivity_runs : DataFrame
        All runs: record, polarity, scale, status and θ_max/α.
    sensitivity : DataFrame
        One at a time: a row for each case and input, with the answer at both ends of its range, the greatest swing first.
    sobol : DataFrame
        A row for each case and input: first-order and total indices, and their intervals.
    spec : SensitivitySpec
        The settings in [sensitivity] of the study.
    """

    NAME: ClassVar[str] = "sensitivity"
    TABLES: ClassVar[tuple[str, ...]] = ("sensitivity_runs", "sensitivity", "sobol")
    RUNS: ClassVar[tuple[str, ...]] = ("sensitivity_runs",)

    sensitivity_runs: "pd.DataFrame"
    sensitivity: "pd.DataFrame"
    sobol: "pd.DataFrame"
    spec: SensitivitySpec

    def plot(self, width_mm: float = 160.0, ax: "Axes | None" = None) -> "Figure":
        """Draw the answer over the range of each input, the greatest swing on top, and Sobol's indices: a matplotlib
        Figure, ``width_mm`` wide or in the place of ``ax``."""
        from rockbatch.analyses.sensitivity.figures import bars
        from rockbatch.common.figures.paper import drawn

        return drawn(bars(self.sensitivity, self.sobol, self.info), width_mm, ax)


@checked
def sensitivity(
    study: str | os.PathLike[str] | Study,
    out: str | os.PathLike[str] | None = None,
    *,
    motions: Motions = None,
    jobs: int | Engine | None = None,
    fresh: bool = False,
    progress: Progress = None,
) -> Sensitivity:
    """Compute the sensitivity of the peak rotation to inputs one at a time, and Sobol's indices: [sensitivity] of a study.

    Parameters
    ----------
    study, motions, jobs, fresh, progress
        As for :func:`rockbatch.run`.
    out : path, optional
        Folder for the files of ``rockbatch sensitivity``, continued if it was interrupted; without it nothing is kept on disk.

    Returns
    -------
    Sensitivity
        With the tables ``sensitivity_runs``, ``sensitivity`` and ``sobol``, as their CSV files have them.

    Raises
    ------
    InputError
        With every mistake in the study; for a folder with finished runs of another state of the study.

    Examples
    --------
    >>> result = rb.sensitivity("pier4.toml")
    >>> result
    <sensitivity of 'Pier 4'>
      tables  sensitivity_runs (72 rows), sensitivity (3 rows), sobol (3 rows)
    >>> result.sobol[["case", "parameter"]]
        case parameter
    0  rigid     alpha
    1   pads     alpha
    2   pads       eta
    """
    return run_analysis(Sensitivity, read_sensitivity, _write_tables, study, out, motions, jobs, fresh, progress)


def _write_tables(results: AnalysisFolder, spec: SensitivitySpec) -> dict[str, object]:
    """Write the runs at all points, unless they exist already, and the tables."""
    study = with_vertical = results.study
    if any(parameter.name == "vertical" for parameter in spec.inputs):  # read it, whatever the study does with it
        with_vertical = replace(study, motions=replace(study.motions, vertical=study.motions.vertical or True))
    motions, points = results.read_motions(with_vertical), Points(study, spec)
    results.info |= {
        "varied": list(study.varied),
        **{name: value for name, value in asdict(spec).items() if name != "inputs"},
        "inputs": [asdict(parameter) for parameter in spec.inputs],
    }
    suite = Design(study, points, motions.motions)
    runs = suite.runs()
    digest = digests(
        motions.motions,
        cases=study.cases,
        inputs=[(point.case, sorted(point.values.items())) for point in points.all],
        scales=(study.motions.vertical, study.motions.polarity, study.motions.scale),
        numerics=study.numerics,
    )
    results.info["motions"] = len(suite.members)
    results.info["stations"] = len({*joined([motion.stations for motion in motions.motions])})
    many = f"{count(len(points), 'point')} × {count(len(suite.members), 'motion')} = {len(runs)} runs{once(study)}"
    results.listener.say(f"{many} on {results.engine}")
    results.execute_runs(sampled.RUNS, sampled.COLUMNS, digest, runs, suite.some_cases(), sampled.row_of)
    with opened_text(results.directory / sampled.RUNS) as rows:
        results.info["statuses"], values = values_of(csv.DictReader(rows), len(points), spec.overturned)
    swings, shares = tables(study, spec, points, values)
    results.keep_table("sensitivity.csv", swings)
    results.keep_table("sobol.csv", shares)
    results.info["engine"] = str(results.engine)
    return {"spec": spec}


def counted_as(status: str, theta_max_over_alpha: float, overturned: float) -> float:
    """Return what a run adds to the answer, at most ``overturned``, that of a run that overturned or was ended by flight.

    A failed run counts with its best value, or as overturned if it has none.
    """
    if status in NO_PEAK or np.isnan(theta_max_over_alpha):
        return overturned
    return min(theta_max_over_alpha, overturned)


def values_of(rows: Iterable[Mapping[str, str]], points: int, overturned: float) -> tuple[dict[str, int], Values]:
    """Return the numbers of runs by how they ended, and what each run adds to the answer, shape (members of the suite, points).

    ``rows`` are the texts of the runs' rows, in their order.
    """
    statuses: Counter[str] = Counter()
    values = array("d")
    for row in rows:
        statuses[row["status"]] += 1
        values.append(counted_as(row["status"], float(row["theta_max_over_alpha"] or "nan"), overturned))
    return dict(statuses), np.array(values).reshape(-1, points)


def answers(values: Values, statistic: str) -> Values:
    """Return the statistic of the suite at every point, shape (points,), of ``values``, shape (members of the suite, points)."""
    statistic_of = STATISTICS[statistic].evaluate
    assert statistic_of is not None
    return np.array([statistic_of(at_point) for at_point in values.T])


def tornado(inputs: Sequence[Input], points: Sequence[Point], results: Values) -> list[dict[str, object]]:
    """Return the rows of sensitivity.csv of a case, the greatest swing first: the answers at both ends of every input.

    ``points`` and ``results``, shape (1 + 2 inputs,), are those of :func:`low_base_high` and the answers there.
    """
    base = points[0].values
    rows = []
    for place, parameter in enumerate(inputs):
        low, high = results[1 + 2 * place : 3 + 2 * place]
        rows.append(
            {
                "parameter": parameter.name,
                "low": _written(parameter.levels[0]),
                "base": _written(base[parameter.name]),
                "high": _written(parameter.levels[1]),
                "answer_low": low,
                "answer_base": results[0],
                "answer_high": high,
                "swing": max(low, high, results[0]) - min(low, high, results[0]),
            }
        )
    return sorted(rows, key=lambda row: -row["swing"])


def _written(value: Value) -> float | str:
    """Return a value as a study file has it: True as "true", False as "false", others as they are."""
    return str(value).lower() if isinstance(value, bool) else value


def tables(
    study: Study, spec: SensitivitySpec, points: Points, values: Values
) -> tuple["pd.DataFrame", "pd.DataFrame"]:
    """Return the tables sensitivity.csv and sobol.csv of ``values``, shape (members of the suite, points)."""
    results = answers(values, spec.statistic)
    swings: list[dict[str, object]] = []
    shares: list[pd.DataFrame] = []
    for case, inputs, (ends, many) in zip(study.cases, points.inputs, points.parts, strict=True):
        identity = {"case": case.name, **case.columns}
        swings += [identity | row for row in tornado(inputs, points.all[ends], results[ends])]
        if inputs:
            shares.append(indices(inputs, results[many], spec.confidence, spec.seed).assign(**identity))
    return (
        pd.DataFrame(swings, columns=["case", *study.varied, *TORNADO]),
        pd.concat(shares)[["case", *study.varied, *SOBOL]],
    )
