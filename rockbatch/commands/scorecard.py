"""The scorecard in the terminal: cases by checks, or the greatest responses of each case without checks."""

import textwrap
from collections import Counter
from collections.abc import Callable, Collection, Iterator, Sequence

from rockbatch.checks import Verdict
from rockbatch.checks.coverage import CaseRuns
from rockbatch.checks.responses import LOST, RESPONSES, Worst, heights_of, standing
from rockbatch.checks.scorecard import MOST_CASES, OPEN_CASES, Cell, scorecard
from rockbatch.checks.verdicts import DOES_NOT_APPLY, PASS
from rockbatch.checks.wording import SIGNS, is_alone
from rockbatch.common.grouping import grouped
from rockbatch.common.lazy import pd
from rockbatch.common.units import with_unit
from rockbatch.quantities.cases import Case
from rockbatch.quantities.rows import rows_of_cases
from rockbatch.reporting.markup import number
from rockbatch.terminal.streams import filled, in_width

MOST_COLUMNS = 5
"""Most columns of the scorecard, unless more checks fail or are undecided."""
_WRAPPED = 13  # characters per line of a head

Names = Callable[[Verdict | CaseRuns], str]


def of_checks(
    verdicts: Sequence[Verdict],
    case_of: Names,
    runs: Sequence[CaseRuns],
    worst: Sequence[Worst],
    record_of: Callable[[Verdict], str],
) -> str:
    """Return the scorecard as text: a line for each case with value, sign and share of the limit by check.

    The records that govern follow, a line for each check that has a column; ``record_of`` names that of a verdict.
    """
    card = scorecard(verdicts, case_of, runs, worst)
    columns = card.open_columns(MOST_COLUMNS)
    rest = [i for i in range(len(card.columns)) if i not in columns]
    heads = [_head(card.columns[i].check, card.columns[i].at, card.columns[i].limit) for i in columns]
    remarked = any(row.verdict == DOES_NOT_APPLY or row.unlimited for row in card.rows)
    rows = []
    for row in card.rows:
        passing = sum(cell is not None and cell.verdict.verdict == PASS for cell in (row.cells[i] for i in rest))
        cells = [_written(row.cells[i]) for i in columns]
        more = [f"{SIGNS[PASS]} {passing} more" if passing else ""] if rest else []
        rows.append([row.name, *cells, *more, *([row.in_words] if remarked else [])])
    more_heads = [[""]] * (bool(rest) + remarked)
    governing = _governing([(card.columns[i].check, [row.cells[i] for row in card.rows]) for i in columns], record_of)
    return "\n".join([_table([*heads, *more_heads], rows), *governing])


def _governing(
    columns: Sequence[tuple[str, Sequence[Cell | None]]], record_of: Callable[[Verdict], str]
) -> Iterator[str]:
    """Yield for each check with governing records a line with these, the most frequent first: "governs drift: NAME".

    "largest in drift: …" if they do not set its value, as under a mean. Several are each followed by the number of cases that
    they govern: "NAME (2 of 3 cases)".
    """
    for check, cells in columns:
        verdicts = [cell.verdict for cell in cells if cell and cell.verdict.record]
        records = Counter(map(record_of, verdicts)).most_common()
        several = len(records) > 1
        names = [f"{name} ({count} of {len(verdicts)} cases)" if several else name for name, count in records]
        if names:
            word = "governs" if all(map(is_alone, verdicts)) else "largest in"
            yield filled(f"{word} {check}: {'; '.join(names)}")


def of_responses(
    worst: Sequence[Worst], runs: "pd.DataFrame", cases: Sequence[Case], name_of: Callable[[Case], str]
) -> str:
    """Return the greatest responses of each case as text.

    Cases with the fewest runs that do not end standing come first, of these the one with the smallest rotation; cases without
    runs are left out.
    """
    heights = heights_of(worst)
    names = [name for name in RESPONSES if name in heights]
    of_cases = grouped(worst, lambda response: name_of(response.case))
    stood, rows = standing(runs), []
    for case, places in rows_of_cases(runs, cases):
        if not len(places):
            continue
        own = {response.demand: response for response in of_cases.get(name_of(case), ())}
        cells = [_response(own.get(name), heights[name]) for name in names]
        lost = int((~stood[places]).sum())
        ended = f"{lost} of {len(places)}" if lost else "none"
        rotation = own["theta_max_over_alpha"].value if "theta_max_over_alpha" in own else 0.0
        rows.append((lost, rotation, [name_of(case), *cells, ended]))
    rows.sort(key=lambda row: row[:2])
    any_lost = any(lost for lost, *_ in rows)
    heads = [
        *(_head(with_unit(RESPONSES[name].named(heights[name]), RESPONSES[name].unit)) for name in names),
        *([_head(LOST)] if any_lost else []),
    ]
    return _table(heads, [row if any_lost else row[:-1] for *_, row in rows])


def _response(response: Worst | None, heights: Collection[float]) -> str:
    """Return a response in the unit of its column, with its height if the ``heights`` of the column differ; "-" for None."""
    if response is None:
        return "-"
    return number(response.value * RESPONSES[response.demand].factor, ".3g") + response.place_among(heights)


def _head(words: str, *below: str) -> list[str]:
    """Return the lines of a head: its wrapped words, then height and limit."""
    return [*textwrap.wrap(words, _WRAPPED, break_long_words=False), *filter(None, below)]


def _written(cell: Cell | None) -> str:
    if cell is None or cell.verdict.verdict == DOES_NOT_APPLY:
        return SIGNS[DOES_NOT_APPLY]
    words = " ".join(filter(None, (cell.value, SIGNS[cell.verdict.verdict], cell.percent)))
    return f"{words} ({cell.design_bound})" if cell.design_bound else words


def _table(heads: Sequence[Sequence[str]], rows: Sequence[Sequence[str]]) -> str:
    """Return rows below heads of several lines as text, "" without heads.

    Of more than :data:`MOST_CASES` rows the first :data:`OPEN_CASES` are followed by a line with both numbers.
    """
    depth = max(map(len, heads), default=0)
    top = [["", *line] for line in zip(*([""] * (depth - len(head)) + list(head) for head in heads), strict=True)]
    kept = rows if len(rows) <= MOST_CASES else rows[:OPEN_CASES]
    lines = [*top, *kept]
    text = in_width(lines[0], lines[1:]) if top else ""
    return text if len(kept) == len(rows) else f"{text}\n{len(kept)} of {len(rows)} cases, the best first"
