"""Sobol's indices of any answer, by SALib: a design of points, and the shares of the variance of the answers there.

Of the variance of the answer, while all inputs vary at once over their ranges, the first-order index of an input is
the share that goes with it alone, and the total index the share that would be left if only it were unknown (Saltelli et al. 2010,
Comput. Phys. Commun. 181, 259–270).
"""

from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from rockbatch.lazy import pd
from rockbatch.study.sensitivity import Input, Value

COLUMNS = ("parameter", "first", "first_error", "total", "total_error")
RESAMPLES = 1000
"""Resamples of the bootstrap that gives the intervals."""


def problem(inputs: Sequence[Input]) -> dict[str, Any]:
    """Return the inputs as SALib takes them; a choice is a coin."""
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
    return [
        {
            parameter.name: parameter.levels[int(x >= 0.5)] if parameter.spread == "choice" else float(x)
            for parameter, x in zip(inputs, point, strict=True)
        }
        for point in drawn
    ]


def indices(inputs: Sequence[Input], answers: npt.NDArray[np.float64], confidence: float, seed: int) -> "pd.DataFrame":
    """Return the first-order and total index of each input.

    Parameters
    ----------
    inputs : sequence of Input
    answers : ndarray, shape (samples × (inputs + 2),)
        Answers at the points of :func:`design`.
    confidence : float
        Level of the intervals.
    seed : int
        Seed of the bootstrap.

    Returns
    -------
    DataFrame
        A row for each input: its name as ``parameter``, and ``first``, ``total`` with the half widths of their intervals,
        ``first_error`` and ``total_error``; NaN if all answers are the same.
    """
    from SALib.analyze import sobol

    table = pd.DataFrame({"parameter": [parameter.name for parameter in inputs]}, columns=list(COLUMNS), dtype=object)
    names = {"first": "S1", "first_error": "S1_conf", "total": "ST", "total_error": "ST_conf"}
    if np.ptp(answers) == 0:
        return table.astype(dict.fromkeys(names, float))
    estimates = sobol.analyze(
        problem(inputs), answers, calc_second_order=False, num_resamples=RESAMPLES, conf_level=confidence, seed=seed
    )
    return table.assign(**{name: estimates[theirs] for name, theirs in names.items()})
