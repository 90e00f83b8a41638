"""States of runs with respect to a limit: a check of the study, applied to one record at a time."""

import numpy as np
import numpy.typing as npt

from rockbatch.analyses.fragility.study import OVERTURNING
from rockbatch.checks.bounds import of_runs
from rockbatch.checks.rules import Rule
from rockbatch.common.naming import chosen_by
from rockbatch.quantities.arrays import Rows
from rockbatch.quantities.cases import Case, has_device
from rockbatch.quantities.catalogue import DEMANDS

LEFT_OUT, WITHSTOOD, UNDECIDED, EXCEEDED = -1, 0, 1, 2
"""States of a run with respect to a limit.

A run is undecided if the bounds of its demand straddle the limit, by its error estimate or because it flew, failed or
overturned and the check counts that as unknown; it is left out if the check says so.
"""


def applies(rule: Rule, case: Case, names: frozenset[str]) -> bool:
    """Return whether a limit, which is of all scales, applies to a case as in run.json; ``names`` are those of all cases."""
    demand = DEMANDS[rule.demand]
    equipped = not demand.device or has_device(case, demand.device)
    about = not rule.case or case["case"] in chosen_by(tuple(rule.case), names)
    return about and demand.applies_to(case) and equipped


def threshold(rule: Rule) -> float:
    """Return what the demand of one record must not exceed; a count of records has it in ``above``."""
    return (rule.above or 0.0) if rule.statistic == "count" else rule.limit


def words(rule: Rule) -> str:
    """Return the limit of one record in words, "theta_max_over_alpha > 0.5"; empty if the name says it all."""
    if rule == OVERTURNING:
        return ""
    limit = threshold(rule)
    return rule.demand if DEMANDS[rule.demand].event and limit == 0 else f"{rule.demand} > {limit:g}"


def demands(rule: Rule, runs: Rows, case: Case) -> npt.NDArray[np.float64]:
    """Return the demand of each of the n runs of a case, shape (n,)."""
    return of_runs(rule, runs, case).bounds.value


def states(rule: Rule, runs: Rows, case: Case) -> npt.NDArray[np.int8]:
    """Return the state of each of the n runs of a case, shape (n,)."""
    demanded = of_runs(rule, runs, case)
    limit = threshold(rule)
    bounds = demanded.bounds
    state = np.where(bounds.low > limit, EXCEEDED, np.where(bounds.high > limit, UNDECIDED, WITHSTOOD))
    return np.where(demanded.counting, state, LEFT_OUT).astype(np.int8)
