"""Runs that do not end standing: they leave a case undecided, unless its checks say how many records may have such runs.

A rank, such as the median, does not see by how much the records beyond it exceed it, and runs that are left out, or count by what
was reached, are not seen at all.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from rockbatch.checks.verdicts import DOES_NOT_APPLY, NOT_DECIDED, PASS, Verdict
from rockbatch.quantities.arrays import Rows
from rockbatch.quantities.rows import counts_as
from rockbatch.quantities.statistics import STATISTICS


class Ending(NamedTuple):
    """Verb phrases for a record that ends so, singular and plural, and the demand of a check on their number."""

    singular: str
    plural: str
    event: str


MAY_OVERTURN = "may overturn"
ENDINGS = {
    "overturned": Ending("overturns the pier", "overturn the pier", "overturned"),
    MAY_OVERTURN: Ending("may overturn the pier", "may overturn the pier", "overturned"),
    "flight": Ending("has a run that flight ended", "have runs that flight ended", "flight"),
    "failed": Ending("has a run that failed or is missing", "have runs that failed or are missing", "failed"),
}
"""Statuses of runs that do not end standing, and :data:`MAY_OVERTURN` for runs that overturn if the motion is a hair stronger."""


def left_open(verdicts: Sequence[Verdict], suites: Sequence[Rows]) -> list[Verdict]:
    """Return the verdicts on a case at one scale; passes become undecided if an ending of its runs is in no check.

    ``suites`` are its runs, on one or both axes of its pier. Verdicts on properties of the case stay.
    """
    applying = [verdict for verdict in verdicts if verdict.verdict != DOES_NOT_APPLY]
    unchecked = [name for name, ending in ENDINGS.items() if not _allowed(ending.event, applying)]
    ended = {name: [_ended(suite, name) for suite in suites] for name in unchecked}
    if not any(runs.any() for of_status in ended.values() for runs in of_status):
        return [*verdicts]
    return [_undecided(verdict, suites, ended) for verdict in verdicts]


def _undecided(
    verdict: Verdict, suites: Sequence[Rows], ended: Mapping[str, Sequence[npt.NDArray[np.bool_]]]
) -> Verdict:
    """Return a pass on a statistic as not decided, with the reason first; other verdicts as they are."""
    if verdict.verdict != PASS or not verdict.statistic:
        return verdict
    return replace(verdict, verdict=NOT_DECIDED, remarks=(_reason(verdict, suites, ended), *verdict.remarks))


def _ended(suite: Rows, ending: str) -> npt.NDArray[np.bool_]:
    """Return True for each run with this ending of :data:`ENDINGS`, shape (n,); "may overturn" leaves out those that did."""
    status = suite.texts("status")
    return suite.facts("may_overturn") & (status != "overturned") if ending == MAY_OVERTURN else status == ending


def _allowed(event: str, verdicts: Sequence[Verdict]) -> bool:
    """Return whether a verdict is on the number of records with this event: by its demand, or by the code of its statistic."""
    return any(
        verdict.demand == event or (verdict.statistic and STATISTICS[verdict.statistic].counts_unacceptable)
        for verdict in verdicts
    )


def _reason(verdict: Verdict, suites: Sequence[Rows], ended: Mapping[str, Sequence[npt.NDArray[np.bool_]]]) -> str:
    """Return how many records have these endings, and the check to write: "1 of 8 stations overturns the pier, and no …"."""
    names = [counts_as(suite, verdict.count)[0] for suite in suites]
    total = len({*np.concatenate(names)})
    parts = list(_numbers(ended, names))
    events = " and ".join(dict.fromkeys(f'"{ENDINGS[name].event}"' for name, _ in parts))
    words = ", ".join(
        f"{number} of {total} {verdict.count}s {ENDINGS[name].singular if number == 1 else ENDINGS[name].plural}"
        for name, number in parts
    )
    remedy = f'add a [[check]] with demand = {events} and statistic = "count"'
    return f"{words}, and no check says how many may: {remedy}"


def _numbers(
    ended: Mapping[str, Sequence[npt.NDArray[np.bool_]]], names: Sequence[npt.NDArray[np.object_]]
) -> Iterator[tuple[str, int]]:
    """Yield each ending that occurs, "flight", with the number of records that have such runs, on either axis."""
    for name, of_suites in ended.items():
        records = {*np.concatenate([of_runs[runs] for runs, of_runs in zip(of_suites, names, strict=True)])}
        if records:
            yield name, len(records)
