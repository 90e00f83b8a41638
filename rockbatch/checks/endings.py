"""Runs that do not end standing: they leave a case undecided, unless its checks say how many records may have such runs.

A rank, such as the median, does not see by how much the records beyond it exceed it, and runs that are left out, or count by what
was reached, are not seen at all.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from rockbatch.checks.bounds import noted
from rockbatch.checks.verdicts import DOES_NOT_APPLY, NOT_DECIDED, PASS, Verdict
from rockbatch.common.notes import OVERTURNS
from rockbatch.quantities.arrays import Rows
from rockbatch.quantities.catalogue import DEMANDS
from rockbatch.results.rows import counts_as
from rockbatch.study.rules import USUAL, Rule


class Ending(NamedTuple):
    """What a record with such a run does, in the singular and the plural."""

    singular: str
    plural: str


ENDINGS = {
    "overturned": Ending("overturns the pier, or may", "overturn the pier, or may"),
    "flight": Ending("has a run that flight ended", "have runs that flight ended"),
    "failed": Ending("has a run that failed or is missing", "have runs that failed or are missing"),
}
"""By the statuses that checks have ways to count, which are events that checks may limit, too."""
_SAYS_ALL = "asce7-16"
"""Statistic that says of every ending how many records may have it."""


def left_open(judged: Sequence[tuple[Rule, Verdict]], suites: Sequence[Rows]) -> list[Verdict]:
    """Return the verdicts on a case at one scale, none of its records passing by runs about whose end no check says anything.

    ``suites`` are its runs, of one or both axes of its pier. What belongs to the case, and not to its runs, stays as it is.
    """
    applying = [rule for rule, verdict in judged if verdict.verdict != DOES_NOT_APPLY]
    ended = {
        status: [_ended(suite, status) & ~_allowed(suite, status, applying) for suite in suites] for status in USUAL
    }
    if not any(runs.any() for of_status in ended.values() for runs in of_status):
        return [verdict for _, verdict in judged]
    return [
        replace(
            verdict, verdict=NOT_DECIDED, note="; ".join(filter(None, (_reason(verdict, suites, ended), verdict.note)))
        )
        if verdict.verdict == PASS and verdict.statistic
        else verdict
        for _, verdict in judged
    ]


def _ended(suite: Rows, status: str) -> npt.NDArray[np.bool_]:
    """Return True for each run that ended so, shape (n,), or may under a motion a hair stronger."""
    ended = suite.texts("status") == status
    return ended | noted(suite, OVERTURNS) if status == "overturned" else ended


def _allowed(suite: Rows, status: str, rules: Sequence[Rule]) -> npt.NDArray[np.bool_]:
    """Return True for each run that a check counts which says how many records may end so, shape (n,)."""
    polarity = suite.texts("polarity")
    allowed = np.zeros(len(suite), dtype=bool)
    for rule in rules:
        if rule.demand == status or (rule.statistic == _SAYS_ALL and DEMANDS[rule.demand].per_run):
            allowed |= True if rule.polarity is None else polarity == rule.polarity
    return allowed


def _reason(verdict: Verdict, suites: Sequence[Rows], ended: Mapping[str, Sequence[npt.NDArray[np.bool_]]]) -> str:
    """Return how many records end in each such way, and the check to write."""
    names = [counts_as(suite, verdict.count)[0] for suite in suites]
    total = len({*np.concatenate(names)})
    parts = list(_numbers(ended, names))
    statuses = " or ".join(f'"{status}"' for status, _ in parts)
    words = ", ".join(
        f"{number} of {total} {verdict.count}s {ENDINGS[status].singular if number == 1 else ENDINGS[status].plural}"
        for status, number in parts
    )
    return f'{words}, and no check says how many may: demand = {statuses}, statistic = "count"'


def _numbers(
    ended: Mapping[str, Sequence[npt.NDArray[np.bool_]]], names: Sequence[npt.NDArray[np.object_]]
) -> Iterator[tuple[str, int]]:
    """Yield each status with the number of records with such runs, if there are any."""
    for status, of_suites in ended.items():
        records = {name for runs, of_runs in zip(of_suites, names, strict=True) for name in of_runs[runs]}
        if records:
            yield status, len(records)
