"""States of runs with respect to a limit: a check of the study, applied to one record at a time."""

import numpy as np
import numpy.typing as npt

from rockbatch.analyses.fragility.study import OVERTURNING
from rockbatch.checks.bounds import of_runs
from rockbatch.checks.omissions import OMISSIONS
from rockbatch.checks.rules import Rule
from rockbatch.common.naming import chosen_by
from rockbatch.quantities.arrays import Rows
from rockbatch.quantities.cases import Case
from rockbatch.quantities.catalogue import DEMANDS

LEFT_OUT, WITHSTOOD, UNDECIDED, EXCEEDED = -1, 0, 1, 2
"""States of a run with respect to a limit.

A run is undecided if the bounds of its demand straddle the limit, by its error estimate or because it flew, failed or
overturned and the check counts that as unknown; it is left out if the check says so.
"""


def applies(rule: Rule, case: Case, names: frozenset[str]) -> bool:
    """Return whether a limit applies to a case (as in run.json): by the names or patterns in ``rule.case``, with ``names`` those
    of all cases, and by its demand.
    """
    about = not rule.case or case["case"] in chosen_by(tuple(rule.case), names)
    return about and DEMANDS[rule.demand].applies_to(case)


def words(rule: Rule) -> str:
    """Return the limit of one record in words, "theta_max_over_alpha > 0.5", only the demand of an event with a limit of 0;
    empty for OVERTURNING itself.
    """
    if rule == OVERTURNING:
        return ""
    limit = rule.threshold
    return rule.demand if DEMANDS[rule.demand].event and limit == 0 else f"{rule.demand} > {limit:g}"


def demands(rule: Rule, runs: Rows, case: Case) -> npt.NDArray[np.float64]:
    """Return the demand of each of the n runs of a case, shape (n,)."""
    return of_runs(rule, runs, case).bounds.value


def open_by_omission(rule: Rule, runs: Rows, case: Case) -> tuple[npt.NDArray[np.bool_], str]:
    """Return which of n runs of a case have no upper bound for what their demand leaves out, shape (n,), and that in words."""
    demanded = of_runs(rule, runs, case)
    remarks = [OMISSIONS[name].remark for name in demanded.omitted if not OMISSIONS[name].decides]
    return demanded.unbounded & (runs.texts("status") == "ok"), "; ".join(remarks)


def states(rule: Rule, runs: Rows, case: Case) -> npt.NDArray[np.int8]:
    """Return the state of each of the n runs of a case, LEFT_OUT to EXCEEDED, shape (n,); one at the limit withstood."""
    demanded = of_runs(rule, runs, case)
    limit = rule.threshold
    bounds = demanded.bounds
    state = np.where(bounds.low > limit, EXCEEDED, np.where(bounds.high > limit, UNDECIDED, WITHSTOOD))
    return np.where(demanded.counting, state, LEFT_OUT).astype(np.int8)
