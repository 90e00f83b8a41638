"""What the peak rotation hangs on: from the runs of a sensitivity study to its tables.

The answer is a statistic of the suite, at every point: at both ends of each input alone, and at the points of Sobol's
indices.
"""

from array import array
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from rockbatch.analysis.sampled import Point, Points
from rockbatch.analysis.sobol import COLUMNS, indices
from rockbatch.checks.statistics import STATISTICS, Values
from rockbatch.study import Study
from rockbatch.study.sensitivity import Input, SensitivitySpec, Value

if TYPE_CHECKING:
    import pandas as pd

ONE_AT_A_TIME, SOBOL = "sensitivity.csv", "sobol.csv"
TORNADO_COLUMNS = ("parameter", "low", "base", "high", "answer_low", "answer_base", "answer_high", "swing")


def counted_as(status: str, theta_max_over_alpha: float, overturned: float) -> float:
    """What a run adds to the answer: ``overturned`` at most, and that where it overturned or was ended by flight.

    A failed run counts with its best value, or as overturned where it has none.
    """
    if status in ("overturned", "flight") or np.isnan(theta_max_over_alpha):
        return overturned
    return min(theta_max_over_alpha, overturned)


def values_of(rows: Iterable[Mapping[str, str]], points: int, overturned: float) -> tuple[dict[str, int], Values]:
    """How many runs ended in which way, and what each adds to the answer, shape (members of the suite, points).

    ``rows`` are the texts of the runs' rows, in their order.
    """
    statuses: Counter[str] = Counter()
    found = array("d")
    for row in rows:
        statuses[row["status"]] += 1
        found.append(counted_as(row["status"], float(row["theta_max_over_alpha"] or "nan"), overturned))
    return dict(statuses), np.array(found).reshape(-1, points)


def answers(values: Values, statistic: str) -> Values:
    """The statistic of the suite at every point, shape (points,), of ``values``, shape (members of the suite, points)."""
    of = STATISTICS[statistic].of
    assert of is not None
    return np.array([of(at_point) for at_point in values.T])


def tornado(inputs: Sequence[Input], points: Sequence[Point], found: Values) -> list[dict[str, Any]]:
    """Rows of sensitivity.csv of a case, the greatest swing first: the answers at both ends of every input.

    ``points`` and ``found``, shape (1 + 2 inputs,), are those of :func:`low_base_high` and the answers there.
    """
    base = points[0].values
    rows = []
    for place, each in enumerate(inputs):
        low, high = found[1 + 2 * place : 3 + 2 * place]
        rows.append(
            {
                "parameter": each.name,
                "low": _written(each.levels[0]),
                "base": _written(base[each.name]),
                "high": _written(each.levels[1]),
                "answer_low": low,
                "answer_base": found[0],
                "answer_high": high,
                "swing": max(low, high, found[0]) - min(low, high, found[0]),
            }
        )
    return sorted(rows, key=lambda row: -row["swing"])


def _written(value: Value) -> float | str:
    """Choices as a study file has them."""
    return str(value).lower() if isinstance(value, bool) else value


def tables(
    study: Study, spec: SensitivitySpec, points: Points, values: Values
) -> tuple["pd.DataFrame", "pd.DataFrame"]:
    """The tables sensitivity.csv and sobol.csv of ``values``, shape (members of the suite, points)."""
    import pandas as pd

    found = answers(values, spec.statistic)
    swings: list[dict[str, Any]] = []
    shares: list[pd.DataFrame] = []
    for case, inputs, (one, many) in zip(study.cases, points.inputs, points.parts, strict=True):
        own = {"case": case.name, **case.columns}
        swings += [own | row for row in tornado(inputs, points.all[one], found[one])]
        if inputs:
            shares.append(indices(inputs, found[many], spec.confidence, spec.seed).assign(**own))
    return (
        pd.DataFrame(swings, columns=["case", *study.varied, *TORNADO_COLUMNS]),
        pd.concat(shares, ignore_index=True)[["case", *study.varied, *COLUMNS]],
    )
