"""The scorecard: a table of cases by checks, with demands over limits, for page and terminal."""

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import NamedTuple

from rockbatch.checks import wording
from rockbatch.checks.answer import without_limits
from rockbatch.checks.coverage import CaseRuns
from rockbatch.checks.responses import RESPONSES, Worst
from rockbatch.checks.verdicts import DOES_NOT_APPLY, FAIL, NOT_DECIDED, PASS, Verdict
from rockbatch.common.grouping import grouped
from rockbatch.quantities.design import BOUND

MOST_CASES, OPEN_CASES = 12, 6
"""Greatest number of cases that are all shown, and number shown first of more."""
SMALL = {"m": ("mm", 1e3), "rad": ("mrad", 1e3), "m/s": ("mm/s", 1e3)}
"""Units in which limits below one are written, and factors to them."""
VERBS = {PASS: "passes", FAIL: "fails"}
_ORDER = (PASS, NOT_DECIDED, FAIL, DOES_NOT_APPLY)
"""Cases in the order of a scorecard."""


class Column(NamedTuple):
    """A check: its name, the limit with its sign and unit, and the factor from the demand's unit to that one.

    ``at`` is the height at which the demand is read, in words; empty without one, and where cases differ in it.
    """

    check: str
    limit: str
    factor: float
    at: str = ""


class Cell(NamedTuple):
    """A verdict in the scorecard: the demand in the unit of its column, and "115 %" of the limit; both empty without numbers.

    ``bounds`` of the demand, in the same unit, are empty if no digit that is shown differs. ``design_bound`` is that of a design
    with several under which the verdict is its worst; empty for the nominal design.
    """

    verdict: Verdict
    value: str
    percent: str
    bounds: str = ""
    design_bound: str = ""


class Row(NamedTuple):
    """A case: its name, the verdict on it, and a cell for each column, None for a check that is not about it.

    The verdict is the worst of its checks; "does not apply" where none does, or where they pass though no run ends standing;
    "not decided" where they pass, but responses that govern have no limit: ``unlimited``, in words, or under a ``failing_suite``,
    whose cells do not pass either.
    """

    name: str
    verdict: str
    cells: list[Cell | None]
    unlimited: Sequence[str] = ()
    failing_suite: bool = False

    def count(self, *kinds: str) -> int:
        """Return the number of its verdicts of these kinds."""
        return sum(cell is not None and cell.verdict.verdict in kinds for cell in self.cells)

    @property
    def in_words(self) -> str:
        """The verdict on the case in words: "passes 3 checks", "fails 1 check", "2 checks not decided", "no limit on drift".

        "not decided, under a suite that fails"; "not checked", or "no run ends standing" if checks pass.
        """
        if self.verdict == DOES_NOT_APPLY:
            return "not checked" if not self.count(PASS) else "no run ends standing"
        if self.unlimited:
            return f"no limit on {', '.join(dict.fromkeys(self.unlimited))}"
        if self.failing_suite:
            return "not decided, under a suite that fails"
        number = self.count(self.verdict)
        checks = f"{number} check{'s' * (number != 1)}"
        return f"{checks} not decided" if self.verdict == NOT_DECIDED else f"{VERBS[self.verdict]} {checks}"


class Scorecard(NamedTuple):
    """Columns, the worst check first, and rows, the best case first."""

    columns: list[Column]
    rows: list[Row]

    def open_columns(self, most: int) -> list[int]:
        """Return the indices of the columns to show, the worst: as many as have a failing or undecided cell, or ``most`` if more.

        They are all columns if these are fewer than ``most``.
        """
        in_columns = zip(*(row.cells for row in self.rows), strict=True)
        telling = sum(
            any(cell and cell.verdict.verdict in (FAIL, NOT_DECIDED) for cell in cells) for cells in in_columns
        )
        return list(range(max(telling, min(most, len(self.columns)))))


def scorecard(
    verdicts: Sequence[Verdict],
    case_of: Callable[[Verdict | CaseRuns], str],
    runs: Sequence[CaseRuns] = (),
    worst: Sequence[Worst] = (),
    beside: Sequence[Verdict] = (),
) -> Scorecard:
    """Return the scorecard of verdicts on cases, and of cases with ``runs`` but without any.

    ``case_of`` names a case, and ``worst`` are the worst responses of all cases at each scale, checked or not. Of cases with one
    name, as those under the bounds of a design may have, each cell has the worst verdict. Units suit the limits of verdicts
    ``beside`` these, too.
    """
    of_cases = [verdict for verdict in verdicts if verdict.case]
    by_check = grouped(of_cases, lambda verdict: verdict.check)
    checks = sorted(by_check, key=lambda name: max(map(badness, by_check[name])), reverse=True)
    columns = [_column([*by_check[name], *(verdict for verdict in beside if verdict.check == name)]) for name in checks]
    fallen = {case_of(case) for case in runs if case.none_stands}
    rows: list[tuple[tuple[int, float], Row]] = []
    by_case = grouped(of_cases, case_of)
    failing = {verdict.scale for verdict in verdicts if not verdict.case and verdict.verdict == FAIL}
    free = without_limits({name: of_case for name, of_case in by_case.items() if _worst(of_case) == PASS}, worst)
    for name, of_case in by_case.items():
        under = of_case[0].scale in failing
        worst_last = sorted(reversed(of_case), key=badness)  # of equals the nominal one, which is first
        own = {verdict.check: _under_failing_suite(verdict) if under else verdict for verdict in worst_last}
        cells = [_cell(own[column.check], column) if column.check in own else None for column in columns]
        kind = DOES_NOT_APPLY if name in fallen and _worst(of_case) == PASS else _worst(of_case)
        words = [RESPONSES[response.demand].words for response in free.get(name, ())] if kind == PASS else []
        verdict = NOT_DECIDED if kind == PASS and (words or under) else kind
        rows.append(
            (max(map(badness, of_case)), Row(name, verdict, cells, words, under and kind == PASS and not words))
        )
    named = {row.name for _, row in rows}
    rows += [
        ((0, 0.0), Row(name, DOES_NOT_APPLY, [None] * len(columns)))
        for name in dict.fromkeys(map(case_of, runs))
        if name not in named
    ]
    rows.sort(key=lambda row: (_ORDER.index(row[1].verdict), row[0]))
    return Scorecard(columns, [row for _, row in rows])


def _under_failing_suite(verdict: Verdict) -> Verdict:
    """Return the verdict under a suite that fails its own check: a pass becomes undecided, and nothing else changes."""
    return replace(verdict, verdict=NOT_DECIDED) if verdict.verdict == PASS else verdict


def _worst(verdicts: Sequence[Verdict]) -> str:
    """Return the verdict on a case: that of the worst of its checks, "does not apply" only if none applies."""
    kinds = {verdict.verdict for verdict in verdicts}
    return next(kind for kind in (FAIL, NOT_DECIDED, PASS, DOES_NOT_APPLY) if kind in kinds)


def badness(verdict: Verdict) -> tuple[int, float]:
    """Return a sort key that grows with badness: pass or not applying, undecided, fail; within each the share of the limit.

    That is −1 for NaN, for a check that does not apply and for a ban that is met, and infinite for a ban that fails.
    """
    kind = (DOES_NOT_APPLY, PASS, NOT_DECIDED, FAIL).index(verdict.verdict)
    ratio = -1.0 if math.isnan(verdict.ratio) else math.inf if verdict.is_ban and kind == 3 else verdict.ratio
    return max(kind, 1), -1.0 if kind == 0 or (verdict.is_ban and kind == 1) else ratio


def _column(verdicts: Sequence[Verdict]) -> Column:
    """Return the column of one check, with its limit in the unit that suits its size: "≤ 50 mm"; "none" for a ban."""
    first, heights = verdicts[0], {verdict.at_m for verdict in verdicts if not math.isnan(verdict.at_m)}
    if first.is_ban:
        return Column(first.check, "none", 1.0)
    small = first.unit in SMALL and any(abs(verdict.limit) < 1.0 for verdict in verdicts if verdict.unit == first.unit)
    unit, factor = SMALL[first.unit] if small else (first.unit, 1.0)
    sign = "≤" if first.sense == "at most" else "≥"
    limit = f"{sign}\u00a0{wording.number(first.limit * factor, least=3)}\u00a0{unit}".rstrip("\u00a0")
    return Column(first.check, limit, factor, wording.at(heights.pop()).strip() if len(heights) == 1 else "")


def _cell(verdict: Verdict, column: Column) -> Cell:
    """Return a verdict in a column, without numbers if it does not apply or its value is NaN.

    Of a ban "none", "some" or "not known" in place of the value, and no share of the limit.
    """
    named = str(verdict.columns.get(BOUND, ""))
    if verdict.verdict == DOES_NOT_APPLY or math.isnan(verdict.value):
        return Cell(verdict, "", "")
    if verdict.is_ban:
        return Cell(verdict, wording.demanded(verdict), "", design_bound=named)
    bound = "≥\u00a0" if verdict.is_lower_bound else ""
    limit = verdict.limit * column.factor
    value = wording.compared(verdict.value * column.factor, limit, 3)
    place = "" if column.at else wording.at(verdict.at_m)
    low, high = (wording.compared(end * column.factor, limit, 3) for end in (verdict.low, verdict.high))
    bounds = f"{low} – {high}" if low != high and not verdict.is_lower_bound else ""
    return Cell(verdict, bound + value + place, f"{bound}{wording.percent(verdict.ratio)}", bounds, named)
